// SPDX-License-Identifier: MIT
// Grids of floats from OpenVDB files (https://www.openvdb.org; Museth 2013, ACM Trans. Graph. 32, 27).
#pragma once

#include <array>
#include <filesystem>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::renderer {

/// A grid in the box of its active values.
struct VdbGrid {
  std::string name;
  std::array<int, 3> size{};  // values along x, y, z
  glm::dvec3 origin{0.0};     // place of the first value, in units of the file
  glm::dvec3 spacing{1.0};    // between values; may be negative
  float background = 0.0F;    // outside of the box
  std::vector<float> values;  // x fastest, z slowest

  [[nodiscard]] float At(int x, int y, int z) const {
    return values[(static_cast<std::size_t>(z) * static_cast<std::size_t>(size[1]) +
                   static_cast<std::size_t>(y)) *
                      static_cast<std::size_t>(size[0]) +
                  static_cast<std::size_t>(x)];
  }
};

/// Returns a grid of a file.
/// @param grid_name  empty: the grid "density", or else the first grid of floats.
/// @param most_values  a box with more values is refused.
/// Throws InputError "FILE: ..." for files that OpenVDB cannot read, files without a grid of floats or
/// without active values, and transforms that turn or shear.
[[nodiscard]] VdbGrid ReadVdb(const std::filesystem::path& file, std::string_view grid_name,
                              double most_values);

}  // namespace alpenglow::renderer
