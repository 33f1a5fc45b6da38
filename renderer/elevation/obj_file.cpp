// SPDX-License-Identifier: MIT
#include "renderer/elevation/obj_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <unordered_map>
#include <utility>

#include "atmosphere/base/error.h"
#include "renderer/elevation/mesh.h"
#include "renderer/elevation/obj_text.h"
#include "renderer/elevation/polygon_triangles.h"

namespace alpenglow::renderer {
namespace {

std::string ReadObjText(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  std::ifstream stream(file, std::ios::binary);
  if (!std::filesystem::is_regular_file(file, error) || !stream)
    RefuseFile(file, "there is no such file");
  std::string text(size, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(size));
  if (!stream) RefuseFile(file, "cannot be read");
  return text;
}

/// Rotates a vector by a quarter turn about x, from y up to z up.
template <typename Number>
std::array<Number, 3> TurnedUp(const std::array<Number, 3>& v) {
  return {v[0], -v[2], v[1]};
}

void TurnUp(ObjText& text) {
  for (auto& position : text.positions) position = TurnedUp(position);
  for (auto& normal : text.normals) normal = TurnedUp(normal);
}

/// Returns the vector scaled to length 1, or 0 if it has no direction.
glm::dvec3 UnitOrZero(const std::array<double, 3>& v) {
  const double largest = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
  const bool is_finite = std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
  if (!is_finite || !(largest > 0.0)) return glm::dvec3(0.0);
  return glm::normalize(glm::dvec3(v[0], v[1], v[2]) / largest);
}

/// Number of faces of one kind, and the line of the first.
struct FaceCount {
  std::size_t count = 0;
  std::size_t first_line = 0;

  void Add(std::size_t line) {
    if (count++ == 0) first_line = line;
  }
};

/// Vertices of the mesh. Corners of faces at one position share a vertex if they also have one
/// normal. The first vertex of a position has the position's index.
class VertexSplitter {
 public:
  /// The source of a corner's normal.
  struct Source {
    enum class Kind : std::uint32_t { kFile, kGroup } kind;
    std::uint32_t number;  // index of the normal in the file, or of the smoothing group
  };

  explicit VertexSplitter(std::size_t positions) : first_(positions, kUnused) {
    for (std::uint32_t i = 0; i < positions; ++i) position_of_.push_back(i);
  }

  [[nodiscard]] const std::vector<std::uint32_t>& position_of() const { return position_of_; }

  [[nodiscard]] std::uint32_t VertexAt(std::uint32_t position, const Source& source) {
    const std::uint64_t key = KeyOf(source);
    if (first_[position] == kUnused) first_[position] = key;
    if (first_[position] == key) return position;
    const auto [found, is_new] = others_.try_emplace({position, key}, 0);
    if (is_new) found->second = Append(position);
    return found->second;
  }
  /// Returns a vertex that no other face uses.
  [[nodiscard]] std::uint32_t OwnVertexAt(std::uint32_t position) {
    if (first_[position] != kUnused) return Append(position);
    first_[position] = kOwn;
    return position;
  }

 private:
  struct Corner {
    std::uint32_t position;
    std::uint64_t key;
    bool operator==(const Corner&) const = default;
  };
  struct HashOfCorner {
    std::size_t operator()(const Corner& corner) const {
      constexpr std::uint64_t kOdd = 0x9e3779b97f4a7c15U;  // spreads neighbouring numbers
      return static_cast<std::size_t>((corner.key * kOdd + corner.position) * kOdd >> 16U);
    }
  };
  static constexpr std::uint64_t kUnused = std::numeric_limits<std::uint64_t>::max();
  static constexpr std::uint64_t kOwn = kUnused - 1;

  static std::uint64_t KeyOf(const Source& source) {
    return (std::uint64_t{source.kind == Source::Kind::kGroup} << 32U) | source.number;
  }
  std::uint32_t Append(std::uint32_t position) {
    if (position_of_.size() >= std::numeric_limits<std::uint32_t>::max())
      throw InputError("a mesh has more vertices than 32 bits count");
    position_of_.push_back(position);
    return static_cast<std::uint32_t>(position_of_.size() - 1);
  }

  std::vector<std::uint64_t> first_;  // keys of the positions' first vertices
  std::unordered_map<Corner, std::uint32_t, HashOfCorner> others_;
  std::vector<std::uint32_t> position_of_;  // one per vertex
};

/// Extent of a mesh on the map, and its smallest distance from the place of the scene [m].
struct MapExtent {
  glm::dvec2 low{std::numeric_limits<double>::infinity()};
  glm::dvec2 high{-std::numeric_limits<double>::infinity()};
  double nearest_m = std::numeric_limits<double>::infinity();

  explicit MapExtent(const TriangleMesh& mesh) {
    for (const auto& triangle : mesh.triangles) {
      glm::dvec2 least(ToDouble(mesh.positions[triangle[0]])), most = least;
      for (const std::uint32_t corner : triangle) {
        least = glm::min(least, glm::dvec2(ToDouble(mesh.positions[corner])));
        most = glm::max(most, glm::dvec2(ToDouble(mesh.positions[corner])));
      }
      low = glm::min(low, least);
      high = glm::max(high, most);
      nearest_m = std::min(nearest_m, glm::length(glm::clamp(glm::dvec2(0.0), least, most)));
    }
  }

  /// Returns whether the mesh is invisible: farther than mountains are visible, or under half a
  /// degree wide.
  [[nodiscard]] bool IsFar() const {
    constexpr double kFarthestSeen_m = 200e3, kNear_m = 10e3, kWidths = 100.0;
    return nearest_m > kFarthestSeen_m ||
           (nearest_m > kNear_m && nearest_m > kWidths * glm::length(high - low));
  }
};

/// Returns a warning if a mesh lies far from the place; empty otherwise.
std::string TextOnFar(const TriangleMesh& mesh) {
  const MapExtent extent(mesh);
  if (!extent.IsFar()) return "";
  return fmt::format(
      "the mesh lies {:.0f} to {:.0f} m east and {:.0f} to {:.0f} m north, {:.0f} km from the "
      "place "
      "at least; its coordinates must be metres from the place of the scene, not those of a map",
      extent.low.x, extent.high.x, extent.low.y, extent.high.y, 1e-3 * extent.nearest_m);
}

class ObjMesher {
 public:
  ObjMesher(const ObjText& text, std::string name)
      : text_(text), name_(std::move(name)), vertices_(text.positions.size()) {
    for (const auto& normal : text.normals) normals_.push_back(UnitOrZero(normal));
    from_file_.assign(text.positions.size(), ObjText::kNone);
  }

  MeshModel Mesh() {
    for (const ObjText::Face& face : text_.faces) AddFace(face);
    if (mesh_.triangles.empty()) {
      throw InputError(fmt::format("{}: has no triangles{}{}", name_,
                                   without_area_.count > 0 ? "; no face has an area" : "",
                                   text_.other_statements > 0 ? "; " + NoteOnOthers() : ""));
    }
    AddVertices();
    std::string message = Message();
    return {std::move(mesh_), std::move(message)};
  }

 private:
  void AddFace(const ObjText::Face& face) {
    std::vector<glm::dvec3> corners_m;
    for (std::size_t i = 0; i < face.corners; ++i)
      corners_m.push_back(ToDouble(text_.positions[CornerOf(face, i).position]));
    const PolygonTriangles cut = TrianglesOfPolygon(corners_m);
    if (cut.crosses_itself) crossing_.Add(face.line);
    if (cut.triangles.empty()) return without_area_.Add(face.line);
    const std::vector<std::uint32_t> vertices = VerticesOf(face);
    for (const auto& [a, b, c] : cut.triangles) {
      std::array<std::uint32_t, 3> triangle{vertices[a], vertices[b], vertices[c]};
      const glm::dvec3 front = glm::cross(corners_m[b] - corners_m[a], corners_m[c] - corners_m[a]);
      if (glm::dot(front, NormalGiven(face, a) + NormalGiven(face, b) + NormalGiven(face, c)) < 0.0)
        std::swap(triangle[1], triangle[2]);
      mesh_.triangles.push_back(triangle);
    }
  }

  [[nodiscard]] const ObjText::Corner& CornerOf(const ObjText::Face& face, std::size_t i) const {
    return text_.corners[face.first + i];
  }

  /// Returns the normal of a corner; 0 if the file gives none.
  [[nodiscard]] glm::dvec3 NormalGiven(const ObjText::Face& face, std::size_t i) const {
    const std::uint32_t normal = CornerOf(face, i).normal;
    return normal == ObjText::kNone ? glm::dvec3(0.0) : normals_[normal];
  }

  std::vector<std::uint32_t> VerticesOf(const ObjText::Face& face) {
    std::vector<std::uint32_t> vertices;
    for (std::size_t i = 0; i < face.corners; ++i) vertices.push_back(VertexOf(face, i));
    return vertices;
  }

  std::uint32_t VertexOf(const ObjText::Face& face, std::size_t i) {
    using Kind = VertexSplitter::Source::Kind;
    const auto [position, normal] = CornerOf(face, i);
    if (NormalGiven(face, i) != glm::dvec3(0.0)) {
      const std::uint32_t vertex = vertices_.VertexAt(position, {Kind::kFile, normal});
      from_file_.resize(vertices_.position_of().size(), ObjText::kNone);
      from_file_[vertex] = normal;
      return vertex;
    }
    const bool is_flat = face.smoothing == 0;
    return is_flat ? vertices_.OwnVertexAt(position)
                   : vertices_.VertexAt(position, {Kind::kGroup, face.smoothing});
  }

  void AddVertices() {
    std::vector<glm::dvec3> positions_m;
    for (const std::uint32_t position : vertices_.position_of()) {
      mesh_.positions.push_back(text_.positions[position]);
      positions_m.push_back(ToDouble(mesh_.positions.back()));
    }
    mesh_.normals = SmoothNormals(positions_m, mesh_.triangles);
    for (std::size_t vertex = 0; vertex < from_file_.size(); ++vertex) {
      if (from_file_[vertex] == ObjText::kNone) continue;
      const glm::dvec3& normal = normals_[from_file_[vertex]];
      mesh_.normals[vertex] = {static_cast<float>(normal.x), static_cast<float>(normal.y),
                               static_cast<float>(normal.z)};
    }
  }

  [[nodiscard]] std::string Message() const {
    std::vector<std::string> parts;
    if (without_area_.count > 0) {
      parts.push_back(fmt::format("{} without area left out (the first in line {})",
                                  Faces(without_area_.count), without_area_.first_line));
    }
    if (crossing_.count > 0) {
      parts.push_back(
          fmt::format("{} whose edges cross, so that the area is ambiguous (the first "
                      "in line {})",
                      Faces(crossing_.count), crossing_.first_line));
    }
    const auto pointless = std::count(normals_.begin(), normals_.end(), glm::dvec3(0.0));
    if (pointless > 0) {
      parts.push_back(
          fmt::format("{} normal{} without direction, for which those of the triangles stand",
                      pointless, pointless == 1 ? "" : "s"));
    }
    if (text_.other_statements > 0) parts.push_back(NoteOnOthers());
    if (const std::string far = TextOnFar(mesh_); !far.empty()) parts.push_back(far);
    return parts.empty() ? "" : fmt::format("{}: {}", name_, fmt::join(parts, "; "));
  }

  [[nodiscard]] std::string NoteOnOthers() const {
    return fmt::format("{} statement{} not read (the first, \"{}\", in line {})",
                       text_.other_statements, text_.other_statements == 1 ? "" : "s",
                       text_.first_other, text_.first_other_line);
  }
  static std::string Faces(std::size_t count) {
    return fmt::format("{} face{}", count, count == 1 ? "" : "s");
  }

  const ObjText& text_;
  std::string name_;
  std::vector<glm::dvec3> normals_;  // normals of the file, unit or 0
  VertexSplitter vertices_;
  std::vector<std::uint32_t> from_file_;  // index of the normal of a vertex, or kNone
  TriangleMesh mesh_;
  FaceCount without_area_, crossing_;
};

}  // namespace

MeshModel ReadObj(const std::filesystem::path& file, UpAxis up) {
  ObjText text = ParseObj(ReadObjText(file), file.string());
  if (up == UpAxis::kY) TurnUp(text);
  return ObjMesher(text, file.string()).Mesh();
}

}  // namespace alpenglow::renderer
