// SPDX-License-Identifier: MIT
// Reads fields of clouds of others from text, in the arrangement of the radiative transfer codes of
// the I3RC comparison (Cahalan et al. 2005, Bull. Amer. Meteor. Soc. 86, 1275) and of SHDOM (Evans
// 1998, J. Atmos. Sci. 55, 429):
//
//   nx ny nz                                numbers of points along x, y, z
//   dx dy                                   spacing [km]
//   z_1 z_2 ... z_nz                        ascending altitudes [km]
//   i j k extinction [effective radius]     one line per point, i, j, k from 1; [1/km], [um]
//
// Line ends in the first three parts do not matter. Points without a line have no cloud. Text after
// # or ! is a comment. Altitudes need not be equidistant: values are interpolated linearly to levels
// as far apart as the nearest two altitudes.
#pragma once

#include <filesystem>

#include "renderer/clouds/cloud_field.h"

namespace alpenglow::renderer {

/// Returns the field of a file, with its first point at x = y = 0.
/// @param is_periodic  the field repeats after nx dx and ny dy; otherwise it ends at its last points.
/// Throws InputError "FILE:LINE: ..." with the name, the value and the range of what is wrong:
/// numbers that are missing or not numbers, points outside of the grid or given twice, NaN, negative
/// extinction, radii not above 0 where there is extinction, altitudes that do not ascend, more than
/// 2e8 points.
[[nodiscard]] CloudField ReadCloudGrid(const std::filesystem::path& file, bool is_periodic);

}  // namespace alpenglow::renderer
