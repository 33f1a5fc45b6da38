// SPDX-License-Identifier: MIT
// This header reads measured lamps: files in the format of ANSI/IES LM-63 (1986 to 2019), which use
// three systems of angles.
//
// A direction has the components (d, a, l) in the lamp's frame: d along photometric zero (straight
// down in the measured attitude), a along photometric horizontal, l to the left of a as seen from
// above. Planes of types A and C share the axis d, planes of type B the horizontal axis l. Seen
// from above, horizontal angles H increase counterclockwise in type C and clockwise in types A and
// B (ANSI/IESNA LM-63-2002, section 3):
//
//   C   (cos V,          sin V cos H,   sin V sin H)    V from 0 to 180
//   B   (cos H cos V,    cos H sin V,  -sin H)          V and H from -90 to 90
//   A   (-sin V,         cos V cos H,  -cos V sin H)    V and H from -90 to 90
//
// LampTable stores type C around the whole turn. Files of types A and B are resampled to type C,
// within the error of this sampling.
//
// Vertical angles may begin and end anywhere; the intensity beyond them is 0. Candela values are
// multiplied by the candela multiplier and the ballast factor. In files of 1986 (which have no line
// with the edition) and of 1991 (IESNA91), they are also multiplied by the ballast-lamp photometric
// factor; later editions use that field for other purposes. TILT=INCLUDE gives factors for a tilted
// lamp; TILT=FILE is rejected. Sizes, watts and keywords are not used.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/lamp/lamp.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

enum class PhotometricType { kC = 1, kB = 2, kA = 3 };

/// Measured intensities, as stored in a file.
struct MeasuredAngles {
  PhotometricType type = PhotometricType::kC;
  std::vector<double> vertical_deg;    // ascending, at least 2
  std::vector<double> horizontal_deg;  // ascending; the range must pass HasWholeTurn
  std::vector<double> intensity;       // [horizontal * vertical_deg.size() + vertical]
};

/// Returns whether the horizontal angles define all directions around the lamp. In type C they
/// range from 0 to 0, 90, 180 or 360 or from 90 to 270 degrees, in types A and B from 0 or from -x
/// to x <= 90. Directions that were not measured mirror the measured ones.
[[nodiscard]] bool HasWholeTurn(PhotometricType type, const std::vector<double>& horizontal_deg);

/// Returns the table of measured intensities. Type C is copied. Types A and B, which are linear
/// between their angles and 0 beyond them, are sampled at steps of half their smallest step, from
/// 0.25 to 2.5 degrees.
[[nodiscard]] LampTable TableOf(const MeasuredAngles& measured);

/// Factor on a lamp's intensity when the luminaire is tilted from its measured attitude.
struct LampTilt {
  std::vector<double> angle_deg;  // ascending in [0, 180]; empty: the factor is 1
  std::vector<double> factor;     // one for each angle
  bool stays_level = false;       // the lamp stays horizontal when the luminaire is tilted

  /// Interpolates linearly between the angles. Throws InputError for a tilt outside of them.
  [[nodiscard]] double FactorAt(double tilt_deg) const;
};

struct IesLamp {
  LampTable table;            // relative to the largest intensity
  double intensity_cd = 0.0;  // largest intensity in the measured attitude
  LampTilt tilt;
};

/// Reads a lamp. Throws InputError "file:line: ..." for a file that is not valid: no TILT line,
/// tilt data in a separate file, counts that do not match the numbers, anything but white space and
/// Ctrl-Z after the last number, angles that do not ascend or that HasWholeTurn rejects, values
/// that are negative or not finite, or no light at all.
[[nodiscard]] IesLamp ReadIes(const std::filesystem::path& file);

/// Reads a lamp from text, with the errors of ReadIes; messages name `origin` instead of the file.
[[nodiscard]] IesLamp IesFromText(std::string_view text, const std::string& origin);

}  // namespace alpenglow::renderer
