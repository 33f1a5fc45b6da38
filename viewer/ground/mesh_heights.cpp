// SPDX-License-Identifier: MIT
#include "viewer/ground/mesh_heights.h"

#include <algorithm>
#include <cmath>

#include "viewer/ground/drape_texels.h"

namespace alpenglow::viewer {

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

// Two triangles a cell in the mean.
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

}  // namespace alpenglow::viewer
