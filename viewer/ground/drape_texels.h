// SPDX-License-Identifier: MIT
// A ColourDrape resampled over a rectangle of the frame's plane, as a texture has it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "renderer/ground/colour_drape.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// East and north in the frame of the ground [m].
struct FlatRectangle {
  double west_m, south_m, width_m, depth_m;
};

/// Around all vertices.
[[nodiscard]] FlatRectangle RectangleOf(const TriangleMesh& mesh);

/// What of a rectangle a picture covers, to a hundredth of its sides; all of it where that is
/// nothing.
[[nodiscard]] FlatRectangle CoveredPart(const ColourDrape& drape, const FlatRectangle& of);

/// Row 0 is the southernmost; linear sRGB in 16 bits, and 65535 where there is a picture.
struct DrapeTexels {
  FlatRectangle place;
  std::size_t columns, rows;
  std::vector<std::array<std::uint16_t, 4>> rgba;

  /// @param most  texels a side.
  DrapeTexels(const ColourDrape& drape, const FlatRectangle& over, std::size_t most);
};

}  // namespace alpenglow::viewer
