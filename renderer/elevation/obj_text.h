// SPDX-License-Identifier: MIT
// This header parses the text of a Wavefront OBJ file.
//
// ParseObj parses the statements that describe polygons. Supported: v, vn, f, s; lines continued by
// a backslash; comments anywhere; any line ends; a byte-order mark of UTF-8. Names, materials,
// texture coordinates, points and lines do not describe surfaces and are skipped. Other statements,
// such as free-form surfaces, are counted.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/layer.h"

namespace alpenglow::renderer {

struct ObjText {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  struct Corner {
    std::uint32_t position;
    std::uint32_t normal;  // or kNone
  };
  struct Face {
    std::size_t first;  // index of its first corner
    std::uint32_t corners;
    std::uint32_t smoothing;  // group; 0 after "s off"; kNone before any s
    std::size_t line;
  };

  std::vector<std::array<float, 3>> positions;
  std::vector<std::array<double, 3>> normals;  // of any length, finite or not
  std::vector<Corner> corners;
  std::vector<Face> faces;  // with 3 corners or more

  std::size_t other_statements = 0;  // number of unknown statements
  std::size_t first_other_line = 0;
  std::string first_other;  // its keyword
};

/// Parses the text. Throws InputError, naming file and line, for invalid numbers, coordinates
/// beyond 10,000 km, indices out of range, and faces of more than kMostPolygonCorners.
/// @param name  name of the file, for messages.
[[nodiscard]] ObjText ParseObj(std::string_view text, const std::string& name);

}  // namespace alpenglow::renderer
