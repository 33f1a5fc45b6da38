// SPDX-License-Identifier: MIT
#include "renderer/procedural_mountains/procedural_mountains.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "renderer/elevation/mesh.h"
#include "renderer/procedural_mountains/erosion.h"
#include "renderer/procedural_mountains/land.h"
#include "renderer/procedural_mountains/lattice_noise.h"

namespace alpenglow::renderer {
namespace {

// U / K [m^(2 m)] of a main chain: the slope is 1 where the drained area to the power 3/8 has this
// value.
constexpr double kUpliftOverErodibility = 98.0;
constexpr double kUpliftPerStep_m = 250.0;

// Returns one value per sample, a function of its place. The function is called from many threads.
template <typename Function>
std::vector<float> Everywhere(const Land& grid, const Function& value_at) {
  std::vector<float> values(grid.index(grid.size, 0));
  tbb::parallel_for(0, grid.size, [&](int row) {
    for (int column = 0; column < grid.size; ++column) {
      const auto [x_km, y_km] = grid.PlaceOf(row, column);
      values[grid.index(row, column)] = static_cast<float>(value_at(x_km, y_km));
    }
  });
  return values;
}

// Returns the grid of the range with `size` samples per side, without heights.
Land GridOf(int size) { return {size, 1e3 * kRangeSpacing_km * kRangeSize / size, {}}; }

Rock RockOf(const Land& grid, std::uint32_t seed) {
  const std::size_t samples = grid.index(grid.size, 0);
  Rock rock{std::vector<float>(samples), std::vector<float>(samples), std::vector<float>(samples)};
  tbb::parallel_for(0, grid.size, [&](int row) {
    for (int column = 0; column < grid.size; ++column) {
      const auto [x, y] = grid.PlaceOf(row, column);
      const std::size_t i = grid.index(row, column);
      const double uplift = RelativeUplift(x, y, seed);
      rock.uplift_m_per_step[i] = static_cast<float>(kUpliftPerStep_m * uplift);
      rock.erodibility_per_step[i] = static_cast<float>(kUpliftPerStep_m / kUpliftOverErodibility *
                                                        RelativeErodibility(x, y, seed));
      rock.steepest_slope[i] = static_cast<float>(SteepestSlope(x, y, uplift, seed));
    }
  });
  return rock;
}

// Returns the initial land: a plain with less than a metre of roughness.
Land Plain(int size) {
  Land land = GridOf(size);
  for (int row = 0; row < size; ++row) {
    for (int column = 0; column < size; ++column) {
      land.height_m.push_back(static_cast<float>(LatticeUniform(column, row, 7)));
    }
  }
  return land;
}

// A value that other threads compute while this thread continues. Rivers are cut one after the
// other, but the rock does not depend on them.
template <typename Value>
class Ahead {
 public:
  template <typename Function>
  explicit Ahead(const Function& make) {
    group_.run([this, make] { value_ = make(); });
  }
  [[nodiscard]] const Value& Get() {
    group_.wait();
    return value_;
  }

 private:
  Value value_;
  tbb::task_group group_;
};

void Erode(Land& land, const Rock& rock, int steps, std::uint32_t seed) {
  constexpr int kStepsAlike = 4;
  std::optional<ScatteredSamples> scattered;
  for (int step = 0; step < steps; ++step) {
    if (step % kStepsAlike == 0)
      scattered.emplace(land.size, seed + static_cast<std::uint32_t>(step / kStepsAlike));
    ErodeOnce(land, rock, *scattered);
  }
}

// Rivers form on a coarse grid, where each step reaches far, and are then cut on finer and finer
// grids.
Land ErodedLand(std::uint32_t seed) {
  const auto rock_of = [&](int size) { return [=] { return RockOf(GridOf(size), seed); }; };
  Ahead<Rock> first(rock_of(kRangeSize / 8)), second(rock_of(kRangeSize / 4)),
      third(rock_of(kRangeSize / 2)), last(rock_of(kRangeSize));
  Land land = Plain(kRangeSize / 8);
  Erode(land, first.Get(), 80, 1000);
  land = Refined(land, 60.0, 11);
  Erode(land, second.Get(), 40, 2000);
  land = Refined(land, 30.0, 12);
  Erode(land, third.Get(), 20, 3000);
  land = WithRibs(Bent(Refined(land, 15.0, 13), 5.0, 1.9, 40), 160.0, 0.7, 60);
  Erode(land, last.Get(), 8, 4000);
  return land;
}

// Applies the effects of ice, gravel and soil after the rivers: ribs on the faces, soft foreland,
// level valleys.
Land Finished(Land land, std::uint32_t seed) {
  const std::vector<float> alpine =
      Everywhere(land, [&](double x_km, double y_km) { return Alpine(x_km, y_km, seed); });
  std::vector<float> soil;
  std::vector<float> gravel_m;
  for (const float value : alpine) {
    soil.push_back(1.0F - value);
    gravel_m.push_back(130.0F * value);
  }
  land = WithRibs(land, 90.0, 0.5, 70);
  for (int pass = 0; pass < 3; ++pass) land = Softened(land, soil);
  FillValleys(land, 0.018F, gravel_m, ScatteredSamples(land.size, 5));
  land = Softened(land, std::vector<float>(soil.size(), 0.25F));
  for (int pass = 0; pass < 3; ++pass) land = Softened(land, soil);
  return land;
}

// Returns the height on the triangles at the position of the view.
double GroundUnderView(const Land& land) {
  const double row = 0.5 * (land.size - 1) - kRangeViewNorth_m / land.spacing_m;
  const double column = 0.5 * (land.size - 1) + kRangeViewEast_m / land.spacing_m;
  const int first_row = static_cast<int>(row), first_column = static_cast<int>(column);
  CellHeights around;
  for (int i = 0; i < 16; ++i) {
    around[static_cast<std::size_t>(i)] =
        static_cast<double>(land.at(first_row + i / 4 - 1, first_column + i % 4 - 1));
  }
  return HeightOnTriangles(around, column - first_column, row - first_row).value();
}

// Raises the crest of the foothills until the view is as high as that of seed 0.
void RaiseView(Land& land) {
  const double missing_m = kRangeViewGround_m - GroundUnderView(land);
  const std::vector<float> raised_m = Everywhere(
      land, [&](double x_km, double y_km) { return missing_m * CrestUnderView(x_km, y_km); });
  for (std::size_t i = 0; i < raised_m.size(); ++i) land.height_m[i] += raised_m[i];
}

// Returns the whole range with its foreland, which falls to 0 at the rim.
Land RangeLand(std::uint32_t seed) {
  Land land = Finished(ErodedLand(seed), seed);
  const std::vector<float> base_m = Everywhere(land, BaseHeight);
  for (std::size_t i = 0; i < base_m.size(); ++i) land.height_m[i] += base_m[i];
  if (seed != 0) RaiseView(land);
  static_cast<void>(
      DrainAndFill(land, ScatteredSamples(land.size, 6)));  // fills pits left by ribs and bends
  return land;
}

// The task is isolated, so that a thread that waits for its subtasks does not start another task
// that waits for the land.
Land MadeOrKept(std::uint32_t seed) {
  return tbb::this_task_arena::isolate([&] {
    if (seed != 0) return RangeLand(seed);
    Land land = GridOf(kRangeSize);
    land.height_m =
        HeightCache({"range", kProceduralMountainsFingerprint, land.index(land.size, 0)},
                    [] { return MadeRangeHeights(0); });
    return land;
  });
}

// The land of seed 0 and of the last other seed stay in memory: the heights do not depend on the
// centre.
std::shared_ptr<const Land> LandOf(std::uint32_t seed) {
  static std::mutex mutex;
  static std::array<std::pair<std::uint32_t, std::shared_ptr<const Land>>, 2> kept;
  const std::scoped_lock lock(mutex);
  auto& [of, land] = kept[seed == 0 ? 0 : 1];
  if (!land || of != seed) {
    land = std::make_shared<const Land>(MadeOrKept(seed));
    of = seed;
  }
  return land;
}

// Beyond this latitude a box of longitudes and latitudes is too wedge-shaped: the grid goes around
// the pole instead.
constexpr double kPolarLatitude_rad = 89.3 * kRadiansPerDegree;

bool IsPolar(const Place& centre) { return std::abs(centre.latitude_rad()) > kPolarLatitude_rad; }

// Return the radii of curvature along the meridian and across it [m].
double MeridianRadius(double latitude_rad) {
  const double e2 = kWgs84.flattening * (2.0 - kWgs84.flattening);
  const double sine = std::sin(latitude_rad);
  const double w = 1.0 - e2 * sine * sine;
  return kWgs84.equatorial_radius_m * (1.0 - e2) / (w * std::sqrt(w));
}
double ParallelRadius(double latitude_rad) {
  const double e2 = kWgs84.flattening * (2.0 - kWgs84.flattening);
  const double sine = std::sin(latitude_rad);
  return kWgs84.equatorial_radius_m * std::cos(latitude_rad) / std::sqrt(1.0 - e2 * sine * sine);
}

// Map between east and north of the centre [m] and latitude and longitude, away from the poles:
// true lengths along the centre's meridian and parallel.
class BoxMap {
 public:
  explicit BoxMap(const Place& centre)
      : centre_(centre),
        rad_per_east_m_(1.0 / ParallelRadius(centre.latitude_rad())),
        rad_per_north_m_(1.0 / MeridianRadius(centre.latitude_rad())) {}

  [[nodiscard]] Place At(double east_m, double north_m) const {
    return PlaceFromRadians(centre_.latitude_rad() + north_m * rad_per_north_m_,
                            centre_.longitude_rad() + east_m * rad_per_east_m_, 0.0);
  }
  // Returns the centre of the map for which `place` lies east_m east and north_m north of it. Each
  // pass reduces the error by the relative change of the meridian's radius over that distance:
  // under 1e-4.
  [[nodiscard]] static Place CentreSeenFrom(const Place& place, double east_m, double north_m) {
    constexpr int kPasses = 5;
    double latitude = place.latitude_rad();
    for (int pass = 0; pass < kPasses; ++pass)
      latitude = place.latitude_rad() - north_m / MeridianRadius(latitude);
    const double longitude = place.longitude_rad() - east_m / ParallelRadius(latitude);
    return WithWrappedLongitude(PlaceFromRadians(latitude, longitude, 0.0));
  }

 private:
  Place centre_;
  double rad_per_east_m_;
  double rad_per_north_m_;
};

// Map between east and north of the centre and latitude and longitude around a pole: azimuthal
// equidistant, its plane seen from above, x to longitude 90.
class PolarMap {
 public:
  explicit PolarMap(const Place& centre)
      : hemisphere_(centre.latitude_rad() > 0.0 ? 1.0 : -1.0),
        longitude_rad_(centre.longitude_rad()),
        radius_m_(MeridianRadius(0.5 * kPi)),
        centre_(PlaneOf(centre)) {}

  [[nodiscard]] Place At(double east_m, double north_m) const {
    const glm::dvec2 plane = centre_ + east_m * East() + north_m * North();
    const double latitude = hemisphere_ * (0.5 * kPi - glm::length(plane) / radius_m_);
    return PlaceFromRadians(latitude, std::atan2(plane.x, -hemisphere_ * plane.y), 0.0);
  }
  // Returns the position of a place east and north of the centre [m].
  [[nodiscard]] glm::dvec2 From(const Place& place) const {
    const glm::dvec2 step = PlaneOf(place) - centre_;
    return {glm::dot(step, East()), glm::dot(step, North())};
  }
  // Returns the centre of the map for which `place` lies east_m east and north_m north of it.
  [[nodiscard]] static Place CentreSeenFrom(const Place& place, double east_m, double north_m) {
    const double hemisphere = place.latitude_rad() > 0.0 ? 1.0 : -1.0;
    const double radius_m = MeridianRadius(0.5 * kPi);
    const double from_pole_m = (0.5 * kPi - std::abs(place.latitude_rad())) * radius_m;
    const double square_m2 = from_pole_m * from_pole_m - east_m * east_m;
    const double along_m = std::sqrt(std::max(square_m2, 0.0));
    const double centre_from_pole_m = along_m + hemisphere * north_m;
    return WithWrappedLongitude(
        PlaceFromRadians(hemisphere * (0.5 * kPi - centre_from_pole_m / radius_m),
                         place.longitude_rad() - std::atan2(east_m, along_m), 0.0));
  }
  // Returns the clockwise angle from the centre's meridian to a place's meridian.
  [[nodiscard]] double Convergence(const Place& place) const {
    return -hemisphere_ * (place.longitude_rad() - longitude_rad_);
  }

 private:
  [[nodiscard]] glm::dvec2 PlaneOf(const Place& place) const {
    const double from_pole = (0.5 * kPi - hemisphere_ * place.latitude_rad()) * radius_m_;
    return {from_pole * std::sin(place.longitude_rad()),
            -hemisphere_ * from_pole * std::cos(place.longitude_rad())};
  }
  [[nodiscard]] glm::dvec2 East() const {
    return {std::cos(longitude_rad_), hemisphere_ * std::sin(longitude_rad_)};
  }
  [[nodiscard]] glm::dvec2 North() const {
    return {-hemisphere_ * std::sin(longitude_rad_), std::cos(longitude_rad_)};
  }

  double hemisphere_;
  double longitude_rad_;
  double radius_m_;
  glm::dvec2 centre_;
};

// BoxGrid and PolarGrid return a grid without heights if the land has none.
ElevationGrid BoxGrid(const Land& land, const Place& centre) {
  const BoxMap map(centre);
  const double half_m = 0.5 * land.spacing_m * (land.size - 1);
  const Place north_west = map.At(-half_m, half_m);
  const Place south_east = map.At(half_m, -half_m);
  ElevationGrid grid;
  grid.west_rad = north_west.longitude_rad();
  grid.north_rad = north_west.latitude_rad();
  grid.step_lon_rad = (south_east.longitude_rad() - north_west.longitude_rad()) / (land.size - 1);
  grid.step_lat_rad = (north_west.latitude_rad() - south_east.latitude_rad()) / (land.size - 1);
  grid.columns = land.size;
  grid.rows = land.size;
  grid.height_m = land.height_m;
  return grid;
}

// Returns a grid of all longitudes from the pole to beyond the range, without ground outside of the
// range.
ElevationGrid PolarGrid(const Land& land, const Place& centre) {
  constexpr double kRowSpacing_m = 100.0;
  constexpr int kColumns = 2048;
  const PolarMap map(centre);
  const double half_m = 0.5 * land.spacing_m * (land.size - 1);
  const double radius_m = MeridianRadius(0.5 * kPi);
  const double to_pole_m = std::abs(0.5 * kPi - std::abs(centre.latitude_rad())) * radius_m;
  ElevationGrid grid;
  grid.columns = kColumns;
  grid.rows = static_cast<int>(std::ceil((to_pole_m + std::sqrt(2.0) * half_m) / kRowSpacing_m));
  grid.step_lon_rad = 2.0 * kPi / kColumns;
  grid.step_lat_rad = kRowSpacing_m / radius_m;
  grid.west_rad = -kPi;
  const double first = 0.5 * kPi - 0.5 * grid.step_lat_rad;  // half a step from the pole
  grid.north_rad =
      centre.latitude_rad() > 0.0 ? first : -first + (grid.rows - 1) * grid.step_lat_rad;
  if (land.height_m.empty()) return grid;
  grid.height_m.reserve(static_cast<std::size_t>(grid.rows) * kColumns);
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const glm::dvec2 at =
          map.From(PlaceFromRadians(grid.LatitudeOfRow(row), grid.LongitudeOfColumn(column), 0.0));
      const bool inside = std::abs(at.x) <= half_m && std::abs(at.y) <= half_m;
      grid.height_m.push_back(inside ? CubicHeight(land, (half_m - at.y) / land.spacing_m,
                                                   (half_m + at.x) / land.spacing_m)
                                     : std::numeric_limits<float>::quiet_NaN());
    }
  }
  return grid;
}

ElevationGrid GridAt(const Place& centre, const Land& land) {
  const double most = 0.5 * kPi + kRangeViewNorth_m / MeridianRadius(0.5 * kPi);
  RequireInRange(centre.latitude_rad(), -most, most, "latitude_rad");
  const Place wrapped = WithWrappedLongitude(centre);
  return IsPolar(wrapped) ? PolarGrid(land, wrapped) : BoxGrid(land, wrapped);
}

}  // namespace

std::vector<float> MadeRangeHeights(std::uint32_t seed) { return RangeLand(seed).height_m; }

ElevationGrid ProceduralMountains(const Place& centre, std::uint32_t seed) {
  return GridAt(centre, *LandOf(seed));
}

ElevationGrid ProceduralMountainsExtent(const Place& centre) {
  return GridAt(centre, GridOf(kRangeSize));
}

CameraPose ProceduralMountainsViewAboveGround(const Place& centre) {
  constexpr double kAboveGround_m = 60.0;
  constexpr double kHeading_deg = 161.0;
  CameraPose view{.place = {},
                  .heading_rad = kHeading_deg * kRadiansPerDegree,
                  .pitch_rad = 0.5 * kRadiansPerDegree,
                  .fov_rad = 50.0 * kRadiansPerDegree};
  if (IsPolar(centre)) {
    const PolarMap map(centre);
    view.place = map.At(kRangeViewEast_m, kRangeViewNorth_m);
    const double heading = kHeading_deg - map.Convergence(view.place) / kRadiansPerDegree;
    view.heading_rad = (heading - 360.0 * std::floor(heading / 360.0)) * kRadiansPerDegree;
  } else {
    view.place = BoxMap(centre).At(kRangeViewEast_m, kRangeViewNorth_m);
  }
  view.place.height_m = kAboveGround_m;
  return view;
}

Place CentreOfRangeSeenFrom(const Place& place) {
  const Place centre = BoxMap::CentreSeenFrom(place, kRangeViewEast_m, kRangeViewNorth_m);
  return IsPolar(centre) ? PolarMap::CentreSeenFrom(place, kRangeViewEast_m, kRangeViewNorth_m)
                         : centre;
}

CameraPose ProceduralMountainsView(const Place& centre, const ElevationGrid& range) {
  CameraPose view = ProceduralMountainsViewAboveGround(centre);
  const std::optional<double> ground =
      range.HeightAt(view.place.latitude_rad(), view.place.longitude_rad());
  if (!ground)
    throw InternalError("the built-in view lies outside the range that it was asked for");
  view.place.height_m += *ground;
  return view;
}

}  // namespace alpenglow::renderer
