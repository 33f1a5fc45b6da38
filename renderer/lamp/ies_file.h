// SPDX-License-Identifier: MIT
// Measured lamps: files in the format of ANSI/IES LM-63 (1986 to 2019).
//
// Read are absolute and relative files of photometric type C, with any number of vertical angles
// from 0 (the lamp's axis, straight down as it was measured) to 90 or 180 degrees and horizontal
// angles from 0 to 0, 90, 180 or 360 degrees (missing quadrants are mirrored, as the standard
// says). Horizontal angles go counterclockwise around a lamp that shines down and is seen from
// above (LM-63-2002, section 3; types A and B go clockwise). TILT=NONE only. Sizes, watts and
// keywords are not used.
#pragma once

#include <filesystem>
#include <string_view>

#include "atmosphere/lamp/lamp.h"

namespace alpenglow {

struct IesLamp {
  LampTable table;            // relative to the largest intensity
  double intensity_cd = 0.0;  // the largest
};

/// Throws InputError "file:line: ..." for what is not such a file: no TILT line, tilt data,
/// photometric types A and B, counts that do not fit the numbers, angles that do not ascend or do
/// not begin and end as said above, values that are negative or not finite, no light at all.
[[nodiscard]] IesLamp ReadIes(const std::filesystem::path& file);

/// As ReadIes, from text; `origin` stands in messages where the file's name would.
[[nodiscard]] IesLamp IesFromText(std::string_view text, const std::string& origin);

}  // namespace alpenglow
