// SPDX-License-Identifier: MIT
// Measured lamps: files in the format of ANSI/IES LM-63 (1986 to 2019).
//
// Files of photometric types A, B and C are read (ies_angles.h); type A and B end up within the
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
