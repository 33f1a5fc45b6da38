// SPDX-License-Identifier: MIT
// Where what programs of a picture read is bound: one number each, so that passes do not take each
// other's places.
#pragma once

#include "viewer/air/air_textures.h"
#include "viewer/lamps/fog_painter.h"
#include "viewer/lamps/lamp_painter.h"

namespace alpenglow::viewer {

/// Of uniform blocks.
enum PictureBinding : GLuint {
  kAirBinding,
  kViewBinding,
  kGroundBinding,
  kGroundLightBinding,
  kGroundSurfaceBinding,
  kSkyByPixelBinding,
  kTablesBinding,
  kLampsBinding,
  kFogBinding
};

/// Of textures.
enum PictureUnit {
  kSurfaceUnit,
  kSkyOnSurfaceUnit,
  kShaftUnit,
  kFogShaftUnit,
  kShadeUnit,
  kUploadUnit,
  kAirUnit,
  kGroundUnit = kAirUnit + AirTextures::kUnits,
  kLampUnit = kGroundUnit + 3,
  kFogUnit = kLampUnit + 6,
  kNightUnit = kFogUnit + 2,
  kSkyByPixelUnit = kNightUnit + 1,
};

inline constexpr LampUnits kLampUnits{kLampsBinding, kViewBinding, kSurfaceUnit, kLampUnit};
inline constexpr FogUnits kFogUnits{kFogBinding, kFogUnit};

}  // namespace alpenglow::viewer
