// SPDX-License-Identifier: MIT
// This header provides terrain from a Wavefront OBJ file: the file, the statements of its text, and
// the triangles of its polygons.
//
// TrianglesOfPolygon keeps the total area of a polygon in space. The polygon is projected along the
// axis nearest to its normal, which changes no coordinate, and triangles are cut off at its corners
// (Meisters 1975, "Polygons have ears"). Signs of areas are exact for corners in single precision.
//
// ParseObj parses the statements that describe polygons. Supported: v, vn, f, s; lines continued by
// a backslash; comments anywhere; any line ends; a byte-order mark of UTF-8. Names, materials,
// texture coordinates, points and lines do not describe surfaces and are skipped. Other statements,
// such as free-form surfaces, are counted.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/elevation/mesh.h"

namespace alpenglow::renderer {

struct PolygonTriangles {
  /// Indices of corners, wound like the polygon. Triangles without area are omitted; if all are,
  /// the polygon has no area.
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// Two edges cross. The area of the polygon is then ambiguous and no triangulation reproduces it.
  /// The returned triangles use all of its corners and may overlap.
  bool crosses_itself = false;
};

/// Largest number of corners: a second of work.
inline constexpr std::size_t kMostPolygonCorners = 10000;

/// Cuts a polygon of 3 or more corners, which may be concave, may lie in any plane and only
/// approximately in one, and may have collinear or repeated corners. The time is quadratic in the
/// number of corners.
/// @param corners  in order [m]; their coordinates are single precision numbers.
[[nodiscard]] PolygonTriangles TrianglesOfPolygon(const std::vector<glm::dvec3>& corners);

/// Returns whether a triangle has no area: it is thin relative to the length of its edges,
/// independent of scale.
[[nodiscard]] bool IsWithoutArea(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

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

/// Reads a file whose coordinates are metres from the place of the scene. Polygons are cut into
/// triangles of equal total area. Normals are those of the file (vn) where it has any. Otherwise
/// they are averaged over the triangles of a smoothing group, or of all triangles if there are no
/// groups; after "s off" they are the normals of the faces. A triangle whose normals point to its
/// back is reversed. Faces without area are omitted. The message counts these, normals without a
/// direction, self-intersecting polygons and unknown statements, and states whether the mesh is so
/// far from the place that its coordinates cannot be metres from there. Throws InputError, naming
/// the file, if there are no triangles, and the errors of ParseObj.
[[nodiscard]] MeshModel ReadObj(const std::filesystem::path& file, UpAxis up = UpAxis::kZ);

}  // namespace alpenglow::renderer
