// SPDX-License-Identifier: MIT
#include "viewer/land/mesh_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "atmosphere/number/constants.h"
#include "renderer/ground/ground_heights.h"
#include "viewer/land/loaded_heights.h"

namespace alpenglow::viewer {
namespace {

/// A range to the east or to the north of a place [m].
struct Span {
  double low_m = std::numeric_limits<double>::infinity();
  double high_m = -std::numeric_limits<double>::infinity();

  void Add(double metres) {
    low_m = std::min(low_m, metres);
    high_m = std::max(high_m, metres);
  }
  [[nodiscard]] double width_m() const { return high_m - low_m; }

  /// The part of the range that is nearest to the place and at most so wide.
  [[nodiscard]] Span Nearest(double half_width_m) const {
    if (width_m() <= 2.0 * half_width_m) return *this;
    const double middle_m = std::clamp(0.0, low_m + half_width_m, high_m - half_width_m);
    return {middle_m - half_width_m, middle_m + half_width_m};
  }
};

/// Metres of a radian at a latitude.
SampleSize MetresOfRadian(double latitude_rad) {
  LandLattice one_radian;
  one_radian.step_lon_rad = 1.0;
  one_radian.step_lat_rad = 1.0;
  one_radian.north_rad = latitude_rad;
  return SampleSizeAt(one_radian, latitude_rad);
}

struct Extent {
  Span east, north;
};

/// The box around a mesh. Its edges may be curved in latitude and longitude: their middles count.
Extent ExtentOf(const Terrain& terrain, const LocalFrame& frame, const GeodeticPosition& place,
                const SampleSize& radian) {
  const auto [low, high] = terrain.Bounds();
  Extent extent;
  for (const double x : {0.0, 0.5, 1.0}) {
    for (const double y : {0.0, 0.5, 1.0}) {
      const glm::dvec3 point = low + glm::dvec3(x, y, 0.5) * (high - low);
      const GeodeticPosition at = frame.GeodeticFromEnu({point});
      const double turn = std::remainder(at.longitude_rad - place.longitude_rad, 2.0 * kPi);
      extent.east.Add(turn * radian.column_m);
      extent.north.Add((at.latitude_rad - place.latitude_rad) * radian.row_m);
    }
  }
  return extent;
}

}  // namespace

std::optional<ElevationGrid> GridOverMesh(const Terrain& terrain, const LocalFrame& frame,
                                          const GeodeticPosition& place, double half_width_m,
                                          int most_samples) {
  if (most_samples < 2 || terrain.mesh().triangles.empty()) return std::nullopt;
  const SampleSize radian = MetresOfRadian(place.latitude_rad);
  const Extent all = ExtentOf(terrain, frame, place, radian);
  const Span east = all.east.Nearest(half_width_m), north = all.north.Nearest(half_width_m);
  constexpr double kFinest_m = 0.01;
  const double step_m =
      std::max(std::max(east.width_m(), north.width_m()) / (most_samples - 1), kFinest_m);
  const auto samples = [&](const Span& span) {
    const double steps = std::ceil(span.width_m() / step_m - 1e-6);
    return std::clamp(static_cast<int>(steps) + 1, 2, most_samples);
  };
  ElevationGrid grid;
  grid.columns = samples(east);
  grid.rows = samples(north);
  grid.step_lon_rad = step_m / radian.column_m;
  grid.step_lat_rad = step_m / radian.row_m;
  grid.west_rad = place.longitude_rad + east.low_m / radian.column_m;
  grid.north_rad = place.latitude_rad + north.high_m / radian.row_m;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const auto ground = GroundHeightsAt(
          terrain, frame, {grid.LatitudeOfRow(row), grid.LongitudeOfColumn(column), 0.0});
      grid.height_m.push_back(ground ? static_cast<float>(ground->highest_m)
                                     : std::numeric_limits<float>::quiet_NaN());
    }
  }
  return grid;
}

}  // namespace alpenglow::viewer
