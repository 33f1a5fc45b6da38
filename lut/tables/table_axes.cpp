// SPDX-License-Identifier: MIT
#include "lut/tables/table_axes.h"

#include <fmt/format.h>

#include <string>

#include "atmosphere/base/error.h"
#include "atmosphere/ray/single_scattering.h"

namespace alpenglow::lut {

std::uint64_t RequireTableSize(std::string_view table, const std::vector<TableAxis>& axes,
                               std::size_t values_per_texel, const Medium& medium) {
  if (medium.wavelengths_nm.size() > kMaxBands) {
    throw InputError(
        fmt::format("spectrum.wavelengths_nm has {} values; a {} table holds at most {}",
                    medium.wavelengths_nm.size(), table, kMaxBands));
  }
  constexpr std::size_t kLongestAxis = 1U << 16U;
  double bytes = sizeof(float) * static_cast<double>(values_per_texel);
  std::string sizes;
  for (const TableAxis& axis : axes) {
    if (axis.texels < axis.fewest || axis.texels > kLongestAxis) {
      throw InputError(fmt::format("{} table: axis {} has {} texels; it must have {} to {}", table,
                                   axis.name, axis.texels, axis.fewest, kLongestAxis));
    }
    bytes *= static_cast<double>(axis.texels);
    sizes += fmt::format("{}{}", sizes.empty() ? "" : " x ", axis.texels);
  }
  if (bytes > static_cast<double>(kLargestTable_bytes)) {
    throw InputError(
        fmt::format("{} table: {} texels of {} values are {:.0f} bytes; at most {} "
                    "are allowed",
                    table, sizes, values_per_texel, bytes, kLargestTable_bytes));
  }
  return static_cast<std::uint64_t>(bytes);
}

}  // namespace alpenglow::lut
