// SPDX-License-Identifier: MIT
#include "renderer/terrain/height_raster.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

namespace alpenglow::renderer {
namespace {

struct Corner {
  double x, y, z;  // x and y in cells
};

// The largest value wins in whatever order threads come.
void Raise(float& cell, float value) {
  std::atomic_ref<float> shared(cell);
  float known = shared.load(std::memory_order_relaxed);
  while (known < value && !shared.compare_exchange_weak(known, value, std::memory_order_relaxed)) {
  }
}

HeightRaster EmptyRaster(const TriangleMesh& mesh, std::size_t most_nodes) {
  constexpr double kFewestNodes = 512.0;  // a side
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

// Heights at the nodes that a triangle covers, seen from above.
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

}  // namespace alpenglow::renderer
