// SPDX-License-Identifier: MIT
// The three systems of angles in which lamps are measured, and the one in which they are kept.
//
// A direction has the components (d, a, l) in the lamp's frame: d along photometric zero (straight
// down as the lamp was measured), a along photometric horizontal, l to the left of a as seen from
// above. Planes of types A and C share the axis d, those of type B the level axis l. Horizontal
// angles H go counterclockwise seen from above in type C and clockwise in types A and B
// (ANSI/IESNA LM-63-2002, section 3):
//
//   C   (cos V,          sin V cos H,   sin V sin H)    V from 0 to 180
//   B   (cos H cos V,    cos H sin V,  -sin H)          V and H from -90 to 90
//   A   (-sin V,         cos V cos H,  -cos V sin H)    V and H from -90 to 90
//
// LampTable holds type C around the whole turn.
#pragma once

#include <vector>

#include "atmosphere/lamp/lamp.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

enum class PhotometricType { kC = 1, kB = 2, kA = 3 };

/// Measured intensities, as they stand in a file.
struct MeasuredAngles {
  PhotometricType type = PhotometricType::kC;
  std::vector<double> vertical_deg;    // ascending, at least 2
  std::vector<double> horizontal_deg;  // ascending, from and to angles that HasWholeTurn accepts
  std::vector<double> intensity;       // [horizontal * vertical_deg.size() + vertical]
};

/// Says whether the horizontal angles give all directions around the lamp. In type C they go from 0 to
/// 0, 90, 180 or 360 or from 90 to 270 degrees, in types A and B from 0 or from -x to x <= 90. The
/// directions that were not measured mirror those that were.
[[nodiscard]] bool HasWholeTurn(PhotometricType type, const std::vector<double>& horizontal_deg);

/// Type C is taken over as it is. Types A and B, linear between their angles and 0 beyond them,
/// are sampled at steps of half their smallest, from 0.25 to 2.5 degrees.
[[nodiscard]] LampTable TableOf(const MeasuredAngles& measured);

}  // namespace alpenglow::renderer
