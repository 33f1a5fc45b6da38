// SPDX-License-Identifier: MIT
// Land for tests: meshes of a height function, and mountains of noise.
#pragma once

#include <cstdint>
#include <glm/geometric.hpp>

#include "renderer/lattice_noise.h"
#include "renderer/mesh.h"

namespace alpenglow {

/// Mountains: 1 km of noise over 3 km and its octaves, about 30 degrees steep.
inline double RoughLand(double x_m, double y_m) {
  double height = 0.0, amplitude = 1000.0, wavelength = 3000.0;
  for (std::uint32_t octave = 0; octave < 4; ++octave, amplitude *= 0.45, wavelength *= 0.5)
    height += amplitude * GradientNoise(x_m / wavelength, y_m / wavelength, 7U + octave);
  return 1500.0 + height;
}

/// A square mesh of side x side vertices around the origin, of a height function of (x, y).
template <typename HeightOf>
[[nodiscard]] TriangleMesh LandMesh(const HeightOf& height, int side, double spacing_m) {
  TriangleMesh mesh;
  const auto at = [&](int i) { return spacing_m * (i - 0.5 * (side - 1)); };
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const double x = at(column), y = at(row), step = 0.5 * spacing_m;
      mesh.positions.push_back(
          {static_cast<float>(x), static_cast<float>(y), static_cast<float>(height(x, y))});
      const glm::dvec3 normal =
          glm::normalize(glm::dvec3((height(x - step, y) - height(x + step, y)) / spacing_m,
                                    (height(x, y - step) - height(x, y + step)) / spacing_m, 1.0));
      mesh.normals.push_back({static_cast<float>(normal.x), static_cast<float>(normal.y),
                              static_cast<float>(normal.z)});
    }
  }
  const auto vertex = [&](int column, int row) {
    return static_cast<std::uint32_t>(row * side + column);
  };
  for (int row = 0; row + 1 < side; ++row) {
    for (int column = 0; column + 1 < side; ++column) {
      mesh.triangles.push_back(
          {vertex(column, row), vertex(column + 1, row), vertex(column + 1, row + 1)});
      mesh.triangles.push_back(
          {vertex(column, row), vertex(column + 1, row + 1), vertex(column, row + 1)});
    }
  }
  return mesh;
}

}  // namespace alpenglow
