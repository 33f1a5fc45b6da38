// SPDX-License-Identifier: MIT
// The binding points of all uniform blocks. Each block has its own, so that no pass reads the block
// of another one.
#pragma once

#include "viewer/gl/gl_context.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

enum BlockBinding : GLuint {
  kAirBinding,
  kViewBinding,
  kGroundBinding,
  kGroundLightBinding,
  kGroundSurfaceBinding,
  kSkyByPixelBinding,
  kTablesBinding,
  kLampsBinding,
  kMediaBinding,
  kOtherTablesBinding,
  kOtherGroundLightBinding,
  kLandBinding,
  kCloudsBinding,
};

}  // namespace alpenglow::viewer
