// SPDX-License-Identifier: MIT
// Reads grids of floats from OpenVDB files (https://www.openvdb.org; Museth 2013, ACM Trans. Graph. 32,
// 27), of the file versions 222 to 224: trees of the usual form (Tree_float_5_4_3), also with values
// of 16 bits, stored as they are or compressed by zlib or Blosc.
//
// A file has metadata, then one descriptor per grid that says where the grid is. A grid has metadata,
// a transform from indices to space, and a tree: a root, nodes of 32^3 and of 16^3 children, and
// leaves of 8^3 values. The values of nodes come first and those of leaves last. Inactive values
// may be left out, and are then the background or one or two others that the node names.
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
/// Throws InputError "FILE: ..." for files that are damaged or cut off, other versions, files without
/// a grid of floats or without active values, unknown compressions, and transforms that turn or shear.
[[nodiscard]] VdbGrid ReadVdb(const std::filesystem::path& file, std::string_view grid_name,
                              double most_values);

}  // namespace alpenglow::renderer
