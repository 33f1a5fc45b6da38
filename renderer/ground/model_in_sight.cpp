// SPDX-License-Identifier: MIT
#include "renderer/ground/model_in_sight.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "atmosphere/number/constants.h"
#include "atmosphere/text/error.h"

namespace alpenglow::renderer {
namespace {

constexpr double kEarth_m = 6.371e6;

// The distance from which ground of any height may be seen [radians of the earth's curve]. Refraction
// carries light a tenth farther at most.
double Sight(double eye_m) {
  constexpr double kHighestGround_m = 9000.0, kRefraction = 1.1;
  return kRefraction * (HorizonDip(eye_m) + HorizonDip(kHighestGround_m));
}

struct Span {
  int first, count;
};

// Two samples or more of an axis, from half a width before a place to half a width after it.
Span Within(double middle, double half, int all) {
  const double first = std::clamp(std::floor(middle - half), 0.0, all - 2.0);
  const double last = std::clamp(std::ceil(middle + half), first + 1.0, all - 1.0);
  return {static_cast<int>(first), static_cast<int>(last - first) + 1};
}

// A circle on the sphere is widest in longitude off its middle's latitude; over a pole it has all.
Span ColumnsAround(const ElevationGrid& grid, const GeodeticPosition& place, double distance_rad) {
  const bool is_over_pole = distance_rad + std::abs(place.latitude_rad) >= 0.5 * kPi;
  const double half_rad =
      is_over_pole ? kPi : std::asin(std::sin(distance_rad) / std::cos(place.latitude_rad));
  const double half = half_rad / grid.step_lon_rad;
  const double centre_rad = grid.west_rad + 0.5 * (grid.columns - 1) * grid.step_lon_rad;
  const double middle =
      0.5 * (grid.columns - 1) +
      std::remainder(place.longitude_rad - centre_rad, 2.0 * kPi) / grid.step_lon_rad;
  if (!grid.ClosesAroundTheEarth()) return Within(middle, half, grid.columns);
  const double first = std::floor(middle - half);
  const double count = std::max(std::ceil(middle + half) - first, 1.0) + 1.0;
  if (count >= grid.columns) return {0, grid.columns};
  const int column = static_cast<int>(first) % grid.columns;
  return {column < 0 ? column + grid.columns : column, static_cast<int>(count)};
}

// Height of the eye over the ellipsoid.
double EyeHeight(const Scene& scene, const ElevationGrid& grid) {
  const Height& height = scene.camera.height;
  if (!height.above_ground) return height.value_m;
  const ElevationModel there =
      ReadElevation(scene.terrain.file, scene.terrain.voids, WindowAround(grid, scene.place, 0.0));
  return height.value_m +
         there.grid.HeightAt(scene.place.latitude_rad, scene.place.longitude_rad).value_or(0.0);
}

}  // namespace

double HorizonDip(double height_m) {
  return std::acos(kEarth_m / (kEarth_m + std::max(height_m, 0.0)));
}

GridWindow WindowAround(const ElevationGrid& grid, const GeodeticPosition& place,
                        double distance_rad) {
  const Span rows = Within((grid.north_rad - place.latitude_rad) / grid.step_lat_rad,
                           distance_rad / grid.step_lat_rad, grid.rows);
  const Span columns = ColumnsAround(grid, place, distance_rad);
  return {columns.first, rows.first, columns.count, rows.count};
}

ModelInSight ReadModelInSight(const Scene& scene) {
  constexpr double kManySamples = 1 << 25;
  const std::filesystem::path& file = scene.terrain.file;
  ElevationGrid all = ReadElevationExtent(file);
  const double samples = static_cast<double>(all.columns) * static_cast<double>(all.rows);
  if (samples <= kManySamples || !CanBeCut(file)) {
    return {ReadElevation(file, scene.terrain.voids), std::move(all), ""};
  }
  const double sight = Sight(EyeHeight(scene, all));
  const GridWindow window = WindowAround(all, scene.place, sight);
  ModelInSight loaded{ReadElevation(file, scene.terrain.voids, window), all, ""};
  if (loaded.model.voids == loaded.model.grid.height_m.size()) {
    throw InputError(fmt::format("{}: has no valid sample within {:.0f} km of the camera",
                                 file.string(), 1e-3 * kEarth_m * sight));
  }
  if (window.columns < all.columns || window.rows < all.rows) {
    loaded.message = fmt::format(
        "{}: of {} x {} samples {} x {} are read, those within {:.0f} km of "
        "the camera",
        file.string(), all.columns, all.rows, window.columns, window.rows, 1e-3 * kEarth_m * sight);
  }
  return loaded;
}

}  // namespace alpenglow::renderer
