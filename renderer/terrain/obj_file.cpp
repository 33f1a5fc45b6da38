// SPDX-License-Identifier: MIT
// Wavefront OBJ. tinyobjloader cuts the polygons; it takes wrong numbers and indices as they come,
// so every v and f line is judged here first.
#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include "atmosphere/text/error.h"
#include "renderer/terrain/mesh.h"
#include "renderer/terrain/smooth_normals.h"

namespace alpenglow {
namespace {

constexpr double kFarthest_m = 1e7;
constexpr std::string_view kBlanks = " \t\r";

std::string ReadText(const std::filesystem::path& file) {
  std::error_code ignored;
  std::ifstream stream(file, std::ios::binary);
  if (!std::filesystem::is_regular_file(file, ignored) || !stream) {
    throw InputError(file.string() + ": there is no such file");
  }
  std::ostringstream text;
  text << stream.rdbuf();
  return std::move(text).str();
}

std::vector<std::string_view> Words(std::string_view line) {
  std::vector<std::string_view> words;
  std::size_t begin = line.find_first_not_of(kBlanks);
  while (begin != std::string_view::npos) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kBlanks, end);
  }
  return words;
}

// Judges the lines of a file one by one.
class ObjJudge {
 public:
  explicit ObjJudge(const std::filesystem::path& file) : file_(file) {}

  void Judge(std::string_view text) {
    std::size_t begin = 0;
    while (begin < text.size()) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      ++line_;
      JudgeLine(Words(text.substr(begin, end - begin)));
      begin = end + 1;
    }
    // A face may come before its vertices.
    if (highest_index_ > vertices_) {
      line_ = highest_index_line_;
      Refuse(fmt::format("vertex {}; there are {}", highest_index_, vertices_));
    }
  }

 private:
  void JudgeLine(const std::vector<std::string_view>& words) {
    if (words.empty()) return;
    if (words[0] == "v") JudgeVertex(words);
    if (words[0] == "f") JudgeFace(words);
  }

  void JudgeVertex(const std::vector<std::string_view>& words) {
    if (words.size() < 4) Refuse("a vertex of fewer than 3 coordinates");
    for (std::size_t i = 1; i <= 3; ++i) {
      double value = 0.0;
      const char* end = words[i].data() + words[i].size();
      const auto [stop, fault] = std::from_chars(words[i].data(), end, value);
      if (fault != std::errc() || stop != end || !(std::abs(value) <= kFarthest_m)) {
        Refuse(fmt::format("coordinate '{}'; it must be a number in [{}, {}]", words[i],
                           -kFarthest_m, kFarthest_m));
      }
    }
    ++vertices_;
  }

  void JudgeFace(const std::vector<std::string_view>& words) {
    if (words.size() < 4) Refuse("a face of fewer than 3 corners");
    for (std::size_t i = 1; i < words.size(); ++i) {
      const std::string_view number = words[i].substr(0, words[i].find('/'));
      long long index = 0;
      const char* end = number.data() + number.size();
      const auto [stop, fault] = std::from_chars(number.data(), end, index);
      if (fault != std::errc() || stop != end) {
        Refuse(fmt::format("corner '{}'; it must be an index", words[i]));
      }
      if (index == 0 || index < -vertices_) {
        Refuse(fmt::format("vertex {}; indices count from 1, or from -1 back to {}", index,
                           -vertices_));
      }
      if (index > highest_index_) {
        highest_index_ = index;
        highest_index_line_ = line_;
      }
    }
  }

  [[noreturn]] void Refuse(const std::string& fault) const {
    throw InputError(fmt::format("{}:{}: {}", file_.string(), line_, fault));
  }

  const std::filesystem::path& file_;
  long long line_ = 0;
  long long vertices_ = 0;
  long long highest_index_ = 0;
  long long highest_index_line_ = 0;
};

struct ParsedObj {
  tinyobj::attrib_t attributes;
  std::vector<tinyobj::shape_t> shapes;
};

ParsedObj Parse(const std::filesystem::path& file, const std::string& text) {
  ParsedObj parsed;
  std::vector<tinyobj::material_t> materials;
  std::string warning;
  std::string error;
  std::istringstream stream(text);
  if (!tinyobj::LoadObj(&parsed.attributes, &parsed.shapes, &materials, &warning, &error,
                        &stream)) {
    std::replace(error.begin(), error.end(), '\n', ' ');
    throw InputError(file.string() + ": " + error);
  }
  return parsed;
}

std::vector<std::array<std::uint32_t, 3>> TrianglesOf(const std::filesystem::path& file,
                                                      const ParsedObj& parsed,
                                                      std::size_t vertices) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const tinyobj::shape_t& shape : parsed.shapes) {
    const std::vector<tinyobj::index_t>& indices = shape.mesh.indices;
    for (std::size_t corner = 0; corner + 2 < indices.size(); corner += 3) {
      std::array<std::uint32_t, 3> triangle{};
      for (std::size_t k = 0; k < 3; ++k) {
        const int index = indices[corner + k].vertex_index;
        if (index < 0 || static_cast<std::size_t>(index) >= vertices) {
          throw InputError(fmt::format("{}: triangle {} has vertex {}; there are {}", file.string(),
                                       triangles.size() + 1, index + 1, vertices));
        }
        triangle[k] = static_cast<std::uint32_t>(index);
      }
      triangles.push_back(triangle);
    }
  }
  return triangles;
}

void RefuseDegenerate(const std::filesystem::path& file, const TriangleMesh& mesh) {
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    const glm::dvec3 u = ToDouble(mesh.positions[b]) - ToDouble(mesh.positions[a]);
    const glm::dvec3 v = ToDouble(mesh.positions[c]) - ToDouble(mesh.positions[a]);
    // Relative to its edges, so that small models are as good as large ones.
    const double area = glm::length(glm::cross(u, v));
    if (!(area > 1e-9 * (glm::dot(u, u) + glm::dot(v, v)))) {
      throw InputError(fmt::format("{}: triangle {} of {} (vertices {}, {}, {}) is degenerate",
                                   file.string(), i + 1, mesh.triangles.size(), a + 1, b + 1,
                                   c + 1));
    }
  }
}

}  // namespace

TriangleMesh ReadObj(const std::filesystem::path& file) {
  const std::string text = ReadText(file);
  ObjJudge(file).Judge(text);
  const ParsedObj parsed = Parse(file, text);
  TriangleMesh mesh;
  std::vector<glm::dvec3> positions;
  const std::vector<tinyobj::real_t>& numbers = parsed.attributes.vertices;
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
    mesh.positions.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
    positions.push_back(ToDouble(mesh.positions.back()));
  }
  mesh.triangles = TrianglesOf(file, parsed, mesh.positions.size());
  if (mesh.triangles.empty()) throw InputError(file.string() + ": has no triangles");
  RefuseDegenerate(file, mesh);
  mesh.normals = SmoothNormals(positions, mesh.triangles);
  return mesh;
}

}  // namespace alpenglow
