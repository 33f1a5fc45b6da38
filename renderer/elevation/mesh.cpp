// SPDX-License-Identifier: MIT
#include "renderer/elevation/mesh.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>
#include <limits>
#include <optional>

#include "atmosphere/base/error.h"
#include "atmosphere/base/file_format.h"
#include "atmosphere/base/parsing.h"
#include "atmosphere/math/constants.h"
#include "renderer/elevation/obj_file.h"

namespace alpenglow::renderer {
namespace {

/// A format of mesh files and its reader.
struct MeshFormat {
  const char* extension;
  MeshModel (*read)(const std::filesystem::path& file, UpAxis up);
};

// The first format is also that of files with an unknown extension.
constexpr MeshFormat kMeshFormats[] = {{".obj", ReadObj}};

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
    return frame_.EnuFromGeodetic(PlaceFromRadians(latitude_rad, longitude_rad, height_m)).xyz;
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

  // Makes the triangles of every row in parallel, then appends the rows in order.
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
    mesh_.triangles.reserve(count + 2 * static_cast<std::size_t>(grid_.columns));  // and the poles
    for (const Triangles& triangles : of_row)
      mesh_.triangles.insert(mesh_.triangles.end(), triangles.begin(), triangles.end());
  }

  [[nodiscard]] std::uint32_t VertexAt(int row, int column) const {
    return vertex_of_sample_[grid_.index(row, column % grid_.columns)];
  }

  // Adds two triangles, split along the diagonal that fits the surface better, so that crests and
  // gullies that run diagonally are preserved; one triangle if a corner is a void.
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

  // Adds a triangle, except at a void and where a row of samples at the pole makes it degenerate.
  void AddTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, Triangles& into) const {
    if (a == kNoVertex || b == kNoVertex || c == kNoVertex) return;
    const glm::dvec3& corner = position_m_[a];
    const glm::dvec3 normal = glm::cross(position_m_[b] - corner, position_m_[c] - corner);
    constexpr double kLeastDoubleArea_m2 = 1e-6;
    if (!(glm::length(normal) > kLeastDoubleArea_m2)) return;
    into.push_back({a, b, c});
  }

  // Adds a fan from the ring next to a pole to a vertex at the pole, which has the ring's mean
  // height.
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
  bool closes_;  // whether the grid closes around the earth
  std::vector<std::uint32_t> vertex_of_sample_;
  std::vector<glm::dvec3> position_m_;
  TriangleMesh mesh_;
};

struct Corner {
  double x, y, z;  // x and y in cells
};

// Raises a cell to a value. The result does not depend on the order of threads.
void Raise(float& cell, float value) {
  std::atomic_ref<float> shared(cell);
  float known = shared.load(std::memory_order_relaxed);
  while (known < value && !shared.compare_exchange_weak(known, value, std::memory_order_relaxed)) {
  }
}

HeightRaster EmptyRaster(const TriangleMesh& mesh, std::size_t most_nodes) {
  constexpr double kFewestNodes = 512.0;  // per side
  std::array<double, 2> low, high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  for (const auto& position : mesh.positions) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      low[axis] = std::min(low[axis], static_cast<double>(position[axis]));
      high[axis] = std::max(high[axis], static_cast<double>(position[axis]));
    }
  }
  const double width = std::max(high[0] - low[0], 1e-3);
  const double depth = std::max(high[1] - low[1], 1e-3);
  const double spacing =
      std::sqrt(2.0 * width * depth / static_cast<double>(mesh.triangles.size()));
  HeightRaster raster;
  raster.cell_m = std::max(std::min(spacing, std::max(width, depth) / kFewestNodes),
                           std::sqrt(width * depth / static_cast<double>(most_nodes)));
  raster.first_x_m = low[0];
  raster.first_y_m = low[1];
  const auto nodes_along = [&](double length) {
    return std::max(static_cast<int>(length / raster.cell_m) + 1, 2);
  };
  const auto nodes = [&] {
    return static_cast<double>(nodes_along(width)) * static_cast<double>(nodes_along(depth));
  };
  while (nodes() > static_cast<double>(most_nodes)) raster.cell_m *= 1.01;
  raster.columns = nodes_along(width);
  raster.rows = nodes_along(depth);
  raster.z_m.assign(raster.index(0, raster.rows), HeightRaster::kNothing);
  return raster;
}

// Writes heights at the nodes that a triangle covers, seen from above.
void Deposit(const std::array<Corner, 3>& corner, HeightRaster& raster) {
  const auto [x_low, x_high] = std::minmax({corner[0].x, corner[1].x, corner[2].x});
  const auto [y_low, y_high] = std::minmax({corner[0].y, corner[1].y, corner[2].y});
  constexpr double kRounding = 1e-6;  // a node on an edge belongs to both triangles
  const int first_column = std::max(static_cast<int>(std::ceil(x_low - kRounding)), 0);
  const int last_column =
      std::min(static_cast<int>(std::floor(x_high + kRounding)), raster.columns - 1);
  const int first_row = std::max(static_cast<int>(std::ceil(y_low - kRounding)), 0);
  const int last_row = std::min(static_cast<int>(std::floor(y_high + kRounding)), raster.rows - 1);
  if (first_column > last_column || first_row > last_row) return;
  const double ux = corner[1].x - corner[0].x, uy = corner[1].y - corner[0].y;
  const double vx = corner[2].x - corner[0].x, vy = corner[2].y - corner[0].y;
  const double area = ux * vy - uy * vx;
  if (area == 0.0) return;
  for (int row = first_row; row <= last_row; ++row) {
    for (int column = first_column; column <= last_column; ++column) {
      const double x = column - corner[0].x, y = row - corner[0].y;
      const double b = (x * vy - y * vx) / area;
      const double c = (ux * y - uy * x) / area;
      if (std::min({b, c, 1.0 - b - c}) < -kRounding) continue;
      const double z =
          corner[0].z + b * (corner[1].z - corner[0].z) + c * (corner[2].z - corner[0].z);
      Raise(raster.z_m[raster.index(column, row)], static_cast<float>(z));
    }
  }
}

}  // namespace

MeshModel ReadMesh(const std::filesystem::path& file, UpAxis up) {
  RefuseKnownFormats(file, "meshes are read as Wavefront OBJ");
  const auto* const format =
      std::find_if(std::begin(kMeshFormats), std::end(kMeshFormats),
                   [&](const MeshFormat& known) { return HasExtension(file, known.extension); });
  return (format == std::end(kMeshFormats) ? kMeshFormats[0] : *format).read(file, up);
}

std::vector<std::array<float, 3>> SmoothNormals(
    const std::vector<glm::dvec3>& positions,
    const std::vector<std::array<std::uint32_t, 3>>& triangles) {
  std::vector<glm::dvec3> sums(positions.size(), glm::dvec3(0.0));
  for (const auto& [a, b, c] : triangles) {
    const glm::dvec3 twice_area =
        glm::cross(positions[b] - positions[a], positions[c] - positions[a]);
    sums[a] += twice_area;
    sums[b] += twice_area;
    sums[c] += twice_area;
  }
  std::vector<std::array<float, 3>> normals;
  normals.reserve(sums.size());
  for (const glm::dvec3& sum : sums) {
    const double length = glm::length(sum);
    const glm::dvec3 normal = length > 0.0 ? sum / length : glm::dvec3(0.0, 0.0, 1.0);
    normals.push_back(
        {static_cast<float>(normal.x), static_cast<float>(normal.y), static_cast<float>(normal.z)});
  }
  return normals;
}

TriangleMesh MeshFromElevation(const ElevationGrid& grid, const LocalFrame& frame) {
  ALPENGLOW_ENSURE(grid.height_m.size(), ==,
                   static_cast<std::size_t>(grid.rows) * static_cast<std::size_t>(grid.columns));
  return MeshBuilder(grid, frame).Build();
}

GridCell CellAt(const HeightRaster& raster, double x_m, double y_m) {
  const double x = std::clamp((x_m - raster.first_x_m) / raster.cell_m, 0.0,
                              static_cast<double>(raster.columns - 1));
  const double y = std::clamp((y_m - raster.first_y_m) / raster.cell_m, 0.0,
                              static_cast<double>(raster.rows - 1));
  const int column = std::min(static_cast<int>(x), raster.columns - 2);
  const int row = std::min(static_cast<int>(y), raster.rows - 2);
  return {column, row, static_cast<float>(x - column), static_cast<float>(y - row)};
}

HeightRaster RasterOf(const TriangleMesh& mesh, std::size_t most_nodes) {
  HeightRaster raster = EmptyRaster(mesh, most_nodes);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, mesh.triangles.size(), 4096),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i) {
                        std::array<Corner, 3> corner;
                        for (std::size_t k = 0; k < 3; ++k) {
                          const auto& p = mesh.positions[mesh.triangles[i][k]];
                          corner[k] = {
                              (static_cast<double>(p[0]) - raster.first_x_m) / raster.cell_m,
                              (static_cast<double>(p[1]) - raster.first_y_m) / raster.cell_m,
                              static_cast<double>(p[2])};
                        }
                        Deposit(corner, raster);
                      }
                    });
  return raster;
}

FlatRectangle RectangleOf(const TriangleMesh& mesh) {
  double west = std::numeric_limits<double>::infinity(), south = west, east = -west, north = -west;
  for (const auto& position : mesh.positions) {
    west = std::min(west, static_cast<double>(position[0]));
    east = std::max(east, static_cast<double>(position[0]));
    south = std::min(south, static_cast<double>(position[1]));
    north = std::max(north, static_cast<double>(position[1]));
  }
  return {west, south, east - west, north - south};
}

template <typename Visit>
void MeshHeights::VisitCells(const Visit& visit) const {
  for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i) {
    const Cells under = Under(mesh_.triangles[i]);
    for (std::size_t row = under.first_row; row <= under.last_row; ++row) {
      for (std::size_t column = under.first_column; column <= under.last_column; ++column)
        visit(row * columns_ + column, i);
    }
  }
}

// A cell has two triangles on average.
MeshHeights::MeshHeights(const TriangleMesh& mesh) : mesh_(mesh) {
  if (mesh.triangles.empty()) return;
  const FlatRectangle all = RectangleOf(mesh);
  west_m_ = all.west_m;
  south_m_ = all.south_m;
  const double area_m2 = std::max(all.width_m * all.depth_m, 1e-6);
  cell_m_ = std::sqrt(2.0 * area_m2 / static_cast<double>(mesh.triangles.size()));
  cell_m_ = std::max(cell_m_, 1e-6 * std::max(all.width_m, all.depth_m));
  columns_ = static_cast<std::size_t>(all.width_m / cell_m_) + 1;
  rows_ = static_cast<std::size_t>(all.depth_m / cell_m_) + 1;
  first_.assign(columns_ * rows_ + 1, 0);
  VisitCells([&](std::size_t cell, std::uint32_t) { ++first_[cell + 1]; });
  for (std::size_t cell = 0; cell < columns_ * rows_; ++cell) first_[cell + 1] += first_[cell];
  triangles_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  VisitCells([&](std::size_t cell, std::uint32_t i) { triangles_[next[cell]++] = i; });
}

MeshHeights::Cells MeshHeights::Under(const std::array<std::uint32_t, 3>& triangle) const {
  const auto cell = [&](double metres, double first_m, std::size_t cells) {
    return std::min(static_cast<std::size_t>((metres - first_m) / cell_m_), cells - 1);
  };
  float west = mesh_.positions[triangle[0]][0], east = west;
  float south = mesh_.positions[triangle[0]][1], north = south;
  for (const std::uint32_t corner : {triangle[1], triangle[2]}) {
    west = std::min(west, mesh_.positions[corner][0]);
    east = std::max(east, mesh_.positions[corner][0]);
    south = std::min(south, mesh_.positions[corner][1]);
    north = std::max(north, mesh_.positions[corner][1]);
  }
  return {cell(static_cast<double>(west), west_m_, columns_),
          cell(static_cast<double>(east), west_m_, columns_),
          cell(static_cast<double>(south), south_m_, rows_),
          cell(static_cast<double>(north), south_m_, rows_)};
}

std::optional<double> MeshHeights::At(double x_m, double y_m) const {
  const double column = (x_m - west_m_) / cell_m_, row = (y_m - south_m_) / cell_m_;
  if (!(column >= 0.0 && row >= 0.0 && column < static_cast<double>(columns_) &&
        row < static_cast<double>(rows_)))
    return std::nullopt;
  const std::size_t cell =
      static_cast<std::size_t>(row) * columns_ + static_cast<std::size_t>(column);
  for (std::uint32_t i = first_[cell]; i < first_[cell + 1]; ++i) {
    const auto& triangle = mesh_.triangles[triangles_[i]];
    const auto corner = [&](std::size_t k, std::size_t axis) {
      return static_cast<double>(mesh_.positions[triangle[k]][axis]);
    };
    const double ax = corner(1, 0) - corner(0, 0), ay = corner(1, 1) - corner(0, 1);
    const double bx = corner(2, 0) - corner(0, 0), by = corner(2, 1) - corner(0, 1);
    const double px = x_m - corner(0, 0), py = y_m - corner(0, 1);
    const double area = ax * by - ay * bx;
    if (area == 0.0) continue;
    const double b = (px * by - py * bx) / area, c = (ax * py - ay * px) / area;
    constexpr double kRounding = 1e-6;
    if (b < -kRounding || c < -kRounding || b + c > 1.0 + kRounding) continue;
    const double z = corner(0, 2);
    return z + b * (corner(1, 2) - z) + c * (corner(2, 2) - z);
  }
  return std::nullopt;
}

}  // namespace alpenglow::renderer
