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
//
// Measured lamps: files in the format of ANSI/IES LM-63 (1986 to 2019).
//
// Files of photometric types A, B and C are read (ies_file.h); type A and B end up within the
// error of their sampling in type C. Vertical angles may begin and end anywhere: nothing shines
// beyond them. Candela values are multiplied by the candela multiplier, by the ballast factor and,
// in files of 1986 (which have no line with the edition) and of 1991 (IESNA91), by the ballast-lamp
// photometric factor; later editions use that field for something else. TILT=INCLUDE gives factors
// for a lamp that is tilted; TILT=FILE is refused. Sizes, watts and keywords are not used.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
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

/// The change of a lamp's intensity while the luminaire is tilted from the attitude in which it was
/// measured.
struct LampTilt {
  std::vector<double> angle_deg;  // ascending in [0, 180]; empty: it does not change
  std::vector<double> factor;     // one for each angle
  bool stays_level = false;       // the lamp lies level however the luminaire is tilted

  /// Linear between the angles. Throws InputError for a tilt outside of them.
  [[nodiscard]] double FactorAt(double tilt_deg) const;
};

struct IesLamp {
  LampTable table;            // relative to the largest intensity
  double intensity_cd = 0.0;  // the largest, in the attitude in which the lamp was measured
  LampTilt tilt;
};

/// Throws InputError "file:line: ..." for what is not such a file: no TILT line, tilt data in a
/// file of their own, counts that do not fit the numbers, anything but white space and Ctrl-Z
/// after the last number, angles that do not ascend or that HasWholeTurn does not accept, values
/// that are negative or not finite, no light at all.
[[nodiscard]] IesLamp ReadIes(const std::filesystem::path& file);

/// As ReadIes, from text; `origin` stands in messages where the file's name would.
[[nodiscard]] IesLamp IesFromText(std::string_view text, const std::string& origin);

}  // namespace alpenglow::renderer
