// SPDX-License-Identifier: MIT
#pragma once

namespace alpenglow::renderer {

/// The axis of a mesh's file that points up. Wavefront OBJ has no rule.
enum class UpAxis {
  kZ,  // x east, y north, z up
  kY,  // x east, y up, z south
};

}  // namespace alpenglow::renderer
