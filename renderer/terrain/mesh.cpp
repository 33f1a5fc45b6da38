// SPDX-License-Identifier: MIT
#include "renderer/terrain/mesh.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>

#include "atmosphere/number/constants.h"
#include "atmosphere/text/error.h"
#include "renderer/terrain/cell_diagonal.h"
#include "renderer/terrain/smooth_normals.h"

namespace alpenglow::renderer {
namespace {

constexpr std::uint32_t kNoVertex = std::numeric_limits<std::uint32_t>::max();

class MeshBuilder {
 public:
  MeshBuilder(const ElevationGrid& grid, const LocalFrame& frame)
      : grid_(grid),
        frame_(frame),
        closes_(grid.ClosesAroundTheEarth()),
        vertex_of_sample_(grid.height_m.size(), kNoVertex) {}

  TriangleMesh Build() {
    AddVertices();
    AddCells();
    if (closes_) {
      AddPole(0, 0.5 * kPi);
      AddPole(grid_.rows - 1, -0.5 * kPi);
    }
    mesh_.normals = SmoothNormals(position_m_, mesh_.triangles);
    mesh_.positions.reserve(position_m_.size());
    for (const glm::dvec3& position : position_m_) {
      mesh_.positions.push_back({static_cast<float>(position.x), static_cast<float>(position.y),
                                 static_cast<float>(position.z)});
    }
    return std::move(mesh_);
  }

 private:
  using Triangles = std::vector<std::array<std::uint32_t, 3>>;

  [[nodiscard]] glm::dvec3 PositionOf(double latitude_rad, double longitude_rad,
                                      double height_m) const {
    return frame_.EnuFromGeodetic({latitude_rad, longitude_rad, height_m}).xyz;
  }

  void AddVertices() {
    ALPENGLOW_ENSURE(grid_.height_m.size(), <, std::size_t{kNoVertex} - 2);
    std::uint32_t vertices = 0;
    for (std::size_t i = 0; i < grid_.height_m.size(); ++i)
      if (!std::isnan(grid_.height_m[i])) vertex_of_sample_[i] = vertices++;
    position_m_.resize(vertices);
    tbb::parallel_for(0, grid_.rows, [&](int row) {
      for (int column = 0; column < grid_.columns; ++column) {
        const std::uint32_t vertex = vertex_of_sample_[grid_.index(row, column)];
        if (vertex == kNoVertex) continue;
        position_m_[vertex] = PositionOf(grid_.LatitudeOfRow(row), grid_.LongitudeOfColumn(column),
                                         static_cast<double>(grid_.at(row, column)));
      }
    });
  }

  // Every row by itself, and then one after the other.
  void AddCells() {
    std::vector<Triangles> of_row(static_cast<std::size_t>(std::max(grid_.rows - 1, 0)));
    const int last_column = closes_ ? grid_.columns : grid_.columns - 1;
    tbb::parallel_for(std::size_t{0}, of_row.size(), [&](std::size_t row) {
      of_row[row].reserve(2 * static_cast<std::size_t>(grid_.columns));
      for (int column = 0; column < last_column; ++column)
        AddCell(static_cast<int>(row), column, of_row[row]);
    });
    std::size_t count = 0;
    for (const Triangles& triangles : of_row) count += triangles.size();
    mesh_.triangles.reserve(count + 2 * static_cast<std::size_t>(grid_.columns));  // poles
    for (const Triangles& triangles : of_row)
      mesh_.triangles.insert(mesh_.triangles.end(), triangles.begin(), triangles.end());
  }

  [[nodiscard]] std::uint32_t VertexAt(int row, int column) const {
    return vertex_of_sample_[grid_.index(row, column % grid_.columns)];
  }

  // Two triangles along the diagonal that fits the surface better, so that crests and gullies that
  // run diagonally stay whole; one where a corner is a void.
  void AddCell(int row, int column, Triangles& into) const {
    const std::uint32_t nw = VertexAt(row, column);
    const std::uint32_t ne = VertexAt(row, column + 1);
    const std::uint32_t sw = VertexAt(row + 1, column);
    const std::uint32_t se = VertexAt(row + 1, column + 1);
    const bool void_off_falling = ne == kNoVertex || sw == kNoVertex;
    const bool void_off_rising = nw == kNoVertex || se == kNoVertex;
    if (void_off_falling || (!void_off_rising && FallingDiagonalFits(row, column))) {
      AddTriangle(nw, sw, se, into);
      AddTriangle(nw, se, ne, into);
    } else {
      AddTriangle(nw, sw, ne, into);
      AddTriangle(ne, sw, se, into);
    }
  }

  [[nodiscard]] double HeightNear(int row, int column) const {
    const int within_row = std::clamp(row, 0, grid_.rows - 1);
    const int within_column = closes_ ? (column + grid_.columns) % grid_.columns
                                      : std::clamp(column, 0, grid_.columns - 1);
    return static_cast<double>(grid_.at(within_row, within_column));
  }

  [[nodiscard]] bool FallingDiagonalFits(int row, int column) const {
    CellHeights around{};
    for (int r = 0; r < 4; ++r) {
      for (int c = 0; c < 4; ++c)
        around[static_cast<std::size_t>(4 * r + c)] = HeightNear(row + r - 1, column + c - 1);
    }
    return renderer::FallingDiagonalFits(around);
  }

  // Left out: triangles at a void, and those that a row of samples at the pole has shrunk.
  void AddTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, Triangles& into) const {
    if (a == kNoVertex || b == kNoVertex || c == kNoVertex) return;
    const glm::dvec3& corner = position_m_[a];
    const glm::dvec3 normal = glm::cross(position_m_[b] - corner, position_m_[c] - corner);
    constexpr double kLeastDoubleArea_m2 = 1e-6;
    if (!(glm::length(normal) > kLeastDoubleArea_m2)) return;
    into.push_back({a, b, c});
  }

  // A fan from the ring next to a pole to a vertex at the pole, of the ring's mean height.
  void AddPole(int row, double pole_rad) {
    const double gap = std::abs(pole_rad - grid_.LatitudeOfRow(row));
    if (gap > 1.001 * grid_.step_lat_rad || gap < 1e-12) return;
    double sum = 0.0;
    for (int column = 0; column < grid_.columns; ++column) {
      sum += static_cast<double>(grid_.at(row, column));
    }
    if (std::isnan(sum)) return;
    const auto pole = static_cast<std::uint32_t>(position_m_.size());
    position_m_.push_back(PositionOf(pole_rad, 0.0, sum / grid_.columns));
    for (int column = 0; column < grid_.columns; ++column) {
      const std::uint32_t west = VertexAt(row, column);
      const std::uint32_t east = VertexAt(row, column + 1);
      if (pole_rad > 0.0) {
        AddTriangle(pole, west, east, mesh_.triangles);
      } else {
        AddTriangle(pole, east, west, mesh_.triangles);
      }
    }
  }

  const ElevationGrid& grid_;
  const LocalFrame& frame_;
  bool closes_;  // around the earth
  std::vector<std::uint32_t> vertex_of_sample_;
  std::vector<glm::dvec3> position_m_;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh MeshFromElevation(const ElevationGrid& grid, const LocalFrame& frame) {
  ALPENGLOW_ENSURE(grid.height_m.size(), ==,
                   static_cast<std::size_t>(grid.rows) * static_cast<std::size_t>(grid.columns));
  return MeshBuilder(grid, frame).Build();
}

}  // namespace alpenglow::renderer
