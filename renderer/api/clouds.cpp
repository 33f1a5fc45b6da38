// SPDX-License-Identifier: MIT
#include <alpenglow/clouds.h>

#include <alpenglow/errors.h>
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "lut/api/conversions.h"
#include "renderer/cloud_light/cloud_light.h"
#include "renderer/cloud_light/cloud_light_fluxes.h"
#include "renderer/cloud_light/cloud_path_tracer.h"
#include "renderer/cloud_light/cloud_sun_depths.h"
#include "renderer/cloud_phase/droplet_phase.h"
#include "renderer/cloud_phase/ice_phase.h"
#include "renderer/clouds/cloud_field.h"
#include "renderer/clouds/cloud_generator.h"
#include "renderer/clouds/cloud_options.h"
#include "renderer/lit_clouds/cloud_layers.h"
#include "renderer/scene/cloud_file.h"
#include "renderer/scene/scene_clouds.h"

namespace alpenglow {

using atmosphere::kPi;
using atmosphere::kRadiansPerDegree;
using atmosphere::RequireInRange;

struct CloudField::State {
  renderer::CloudField field;
  CloudParticles particles;
  double g = 0.0;  // of one Henyey-Greenstein phase function
};

namespace {

constexpr double kFarthestPoint_m = 1e8;

void RequireIn(double value, const std::pair<double, double>& range, std::string_view name) {
  RequireInRange(value, range.first, range.second, name);
}

glm::dvec3 CheckedPoint(const LocalPoint& point, const std::string& name) {
  const auto check = [&](double value, const char* member) {
    return RequireInRange(value, -kFarthestPoint_m, kFarthestPoint_m,
                          fmt::format("{}.{}", name, member));
  };
  return {check(point.east_m, "east_m"), check(point.north_m, "north_m"),
          check(point.up_m, "up_m")};
}

void RequireMemory(double needed, std::string_view what) {
  const double memory = renderer::MemoryOfMachine();
  if (needed <= memory) return;
  throw InputError(fmt::format("{} may need {:.1f} GB; this machine has {:.1f} GB", what,
                               1e-9 * needed, 1e-9 * memory));
}

renderer::CloudGenus GenusOf(CloudGenus genus) {
  switch (genus) {
    case CloudGenus::kCumulus:
      return renderer::CloudGenus::kCumulus;
    case CloudGenus::kStratocumulus:
      return renderer::CloudGenus::kStratocumulus;
    case CloudGenus::kAltocumulus:
      return renderer::CloudGenus::kAltocumulus;
    case CloudGenus::kCirrus:
      return renderer::CloudGenus::kCirrus;
    case CloudGenus::kStratus:
      return renderer::CloudGenus::kStratus;
    case CloudGenus::kCirrostratus:
      return renderer::CloudGenus::kCirrostratus;
  }
  throw InputError("layer.genus is no CloudGenus");
}

void RefuseIf(bool is_wrong, const char* member, const char* genera) {
  if (!is_wrong) return;
  throw InputError(fmt::format("layer.{} is given; only {} has it", member, genera));
}

void CheckLayer(const renderer::CloudOptions& layer) {
  using Ranges = renderer::CloudRanges;
  const bool is_of_ice = renderer::IsOfIce(layer.genus);
  const auto check = [](double value, const std::pair<double, double>& range, const char* member) {
    RequireIn(value, range, fmt::format("layer.{}", member));
  };
  check(layer.cover, renderer::CoversOf(layer.genus), "cover");
  check(layer.base_altitude_m,
        {0.0, is_of_ice ? Ranges::kBase_m.second : renderer::kHighestWaterBase_m}, "base_m");
  check(layer.depth_m, Ranges::kDepth_m, "depth_m");
  if (is_of_ice) {
    check(layer.ice_mg_per_m3, Ranges::kIce_mg_per_m3, "ice_mg_per_m3");
    check(layer.crystal_radius_um, Ranges::kCrystalRadius_um, "crystal_radius_um");
  } else {
    check(layer.droplet_number_per_cm3, Ranges::kDroplets_per_cm3, "droplets_per_cm3");
  }
  if (layer.optical_depth) check(*layer.optical_depth, Ranges::kOpticalDepth, "optical_depth");
  check(layer.wind_m_per_s.x, Ranges::kWind_m_per_s, "wind_east_m_per_s");
  check(layer.wind_m_per_s.y, Ranges::kWind_m_per_s, "wind_north_m_per_s");
  check(layer.period_m, Ranges::kPeriod_m, "period_m");
}

/// Returns the options of the layer below, which checks them, too. Faults have public names here.
renderer::CloudOptions OptionsOf(const CloudLayer& layer) {
  renderer::CloudOptions options = renderer::DefaultCloudOptions(GenusOf(layer.genus));
  const bool is_of_ice = renderer::IsOfIce(options.genus);
  RefuseIf(is_of_ice && layer.droplets_per_cm3, "droplets_per_cm3", "a genus of droplets");
  RefuseIf(!is_of_ice && layer.ice_mg_per_m3, "ice_mg_per_m3", "a genus of ice");
  RefuseIf(!is_of_ice && layer.crystal_radius_um, "crystal_radius_um", "a genus of ice");
  RefuseIf(!renderer::IsPlaneParallel(options.genus) && layer.optical_depth, "optical_depth",
           "stratus and cirrostratus");
  options.cover = layer.cover.value_or(options.cover);
  options.base_altitude_m = layer.base_m.value_or(options.base_altitude_m);
  options.depth_m = layer.depth_m.value_or(options.depth_m);
  options.droplet_number_per_cm3 = layer.droplets_per_cm3.value_or(options.droplet_number_per_cm3);
  options.ice_mg_per_m3 = layer.ice_mg_per_m3.value_or(options.ice_mg_per_m3);
  options.crystal_radius_um = layer.crystal_radius_um.value_or(options.crystal_radius_um);
  options.optical_depth = layer.optical_depth;
  options.seed = layer.seed;
  options.wind_m_per_s = {layer.wind_east_m_per_s.value_or(options.wind_m_per_s.x),
                          layer.wind_north_m_per_s};
  options.period_m = layer.period_m;
  CheckLayer(options);
  renderer::CheckCloudOptions(options);
  return options;
}

renderer::CloudField FieldOf(const renderer::CloudOptions& options, double time_s) {
  RequireInRange(time_s, 0.0, 1e7, "time_s");
  RequireMemory(
      renderer::CloudField::MostBytes(renderer::LatticeOf(options)),
      fmt::format("a layer with period_m {} and depth_m {}", options.period_m, options.depth_m));
  return renderer::MakeCloudField(options, time_s);
}

/// Checks the numbers of samples of a grid and returns their product.
std::size_t CheckedSamples(const std::array<int, 3>& samples) {
  std::size_t count = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    RequireInRange(samples[axis], 2.0, 8192.0, fmt::format("grid.samples[{}]", axis));
    count *= static_cast<std::size_t>(samples[axis]);
  }
  const std::string text =
      fmt::format("a grid with samples {} x {} x {}", samples[0], samples[1], samples[2]);
  if (static_cast<double>(count) > renderer::kMostCloudSamples) {
    throw InputError(
        fmt::format("{} has {}; there may be {:.0f}", text, count, renderer::kMostCloudSamples));
  }
  RequireMemory(kCloudGridBytes * static_cast<double>(count), text);
  return count;
}

void CheckValues(const std::vector<float>& values, std::size_t count, double low, double high,
                 const char* member) {
  if (values.size() != count) {
    throw InputError(
        fmt::format("grid.{} has {} values; grid.samples need {}", member, values.size(), count));
  }
  for (std::size_t i = 0; i < count; ++i) {
    const auto value = static_cast<double>(values[i]);
    if (!(value >= low && value <= high)) {
      RequireInRange(value, low, high, fmt::format("grid.{}[{}]", member, i));
    }
  }
}

void CheckGrid(const CloudGrid& grid) {
  const std::size_t count = CheckedSamples(grid.samples);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    RequireIn(grid.spacing_m[axis], renderer::CloudFileRanges::kSpacing_m,
              fmt::format("grid.spacing_m[{}]", axis));
  }
  static_cast<void>(CheckedPoint(grid.first, "grid.first"));
  CheckValues(grid.extinction_per_m, count, 0.0, 1e6, "extinction_per_m");
  constexpr double kLeastRadius_um = 1e-6;
  if (!grid.effective_radius_um.empty()) {
    CheckValues(grid.effective_radius_um, count, kLeastRadius_um, 1e4, "effective_radius_um");
  }
  RequireInRange(grid.single_scattering_albedo, 0.0, 1.0, "grid.single_scattering_albedo");
  if (grid.particles == CloudParticles::kHenyeyGreenstein) {
    RequireInRange(grid.g, 0.001, 0.99, "grid.g");
  } else if (grid.particles != CloudParticles::kDroplets &&
             grid.particles != CloudParticles::kIce) {
    throw InputError("grid.particles is no CloudParticles");
  }
}

renderer::CloudField FieldOf(const CloudGrid& grid) {
  CheckGrid(grid);
  const int ends = grid.is_periodic ? 0 : 1;
  renderer::CloudLattice lattice;
  lattice.voxels = {grid.samples[0] - ends, grid.samples[1] - ends, grid.samples[2] - 1};
  lattice.voxel_m = {grid.spacing_m[0], grid.spacing_m[1], grid.spacing_m[2]};
  lattice.origin_m = {grid.first.east_m, grid.first.north_m, grid.first.up_m};
  lattice.is_periodic = grid.is_periodic;
  return {lattice,
          {grid.extinction_per_m, grid.effective_radius_um, grid.single_scattering_albedo}};
}

renderer::CloudPhases PhasesOf(CloudParticles particles, double g, double wavelength_nm) {
  switch (particles) {
    case CloudParticles::kDroplets:
      return renderer::DropletPhases(wavelength_nm);
    case CloudParticles::kIce:
      return renderer::IcePhases(wavelength_nm);
    case CloudParticles::kHenyeyGreenstein:
      break;
  }
  return renderer::CloudPhases({.kind = atmosphere::PhaseKind::kHenyeyGreenstein, .g = g});
}

void RequireElevation(const glm::dvec3& unit, double lowest_deg, std::string_view name) {
  const double elevation_deg = std::asin(std::clamp(unit.z, -1.0, 1.0)) / kRadiansPerDegree;
  // Angles that come from degrees may be lower by rounding.
  RequireInRange(std::round(1e9 * elevation_deg) / 1e9, lowest_deg, 90.0, name);
}

glm::dvec3 CheckedSun(const Direction& to_sun) {
  const glm::dvec3 unit = UnitVectorOf(to_sun);
  RequireElevation(unit, renderer::kLowestCloudLight_deg, "the elevation of to_sun [degrees]");
  return unit;
}

/// Fluxes are relative to that of the sun through a plane.
void RequireSunOfFluxes(const glm::dvec3& to_sun) {
  RequireElevation(to_sun, renderer::kLowestCloudSun_deg,
                   "the elevation of to_sun for fluxes [degrees]");
}

const CloudSurroundings& Checked(const CloudSurroundings& surroundings, double base_m) {
  RequireInRange(surroundings.wavelength_nm, 300.0, 1000.0, "surroundings.wavelength_nm");
  RequireInRange(surroundings.ground_albedo, 0.0, 1.0, "surroundings.ground_albedo");
  RequireInRange(surroundings.ground_m, -1e5, base_m, "surroundings.ground_m");
  RequireInRange(surroundings.planet_radius_m, 1e5, 1e9, "surroundings.planet_radius_m");
  return surroundings;
}

/// A ray of the layer below and its length.
struct CheckedRay {
  renderer::CloudRay ray;
  double length_m;
};

CheckedRay Checked(const CloudRay& ray, double ground_m) {
  const glm::dvec3 eye = CheckedPoint(ray.eye, "ray.eye");
  RequireInRange(eye.z, ground_m, kFarthestPoint_m, "ray.eye.up_m");
  RequireInRange(ray.length_m, 0.0, std::numeric_limits<double>::infinity(), "ray.length_m");
  return {{eye, UnitVectorOf(ray.view)}, ray.length_m};
}

renderer::CloudRay CheckedToItsEnd(const CloudRay& ray, double ground_m) {
  const CheckedRay checked = Checked(ray, ground_m);
  if (std::isfinite(ray.length_m)) {
    throw InputError(fmt::format("ray.length_m is {}; it must be infinite", ray.length_m));
  }
  return checked.ray;
}

/// Returns options of the map of sunlight: its cells need not be smaller than those of a grid.
renderer::CloudSunMapOptions SunMapFor(const renderer::CloudField& field) {
  const glm::dvec3 voxel_m = field.lattice().voxel_m;
  renderer::CloudSunMapOptions options;
  options.cell_m = std::clamp(std::min(voxel_m.x, voxel_m.y), options.cell_m, 1000.0);
  options.step_m = std::clamp(std::min({voxel_m.x, voxel_m.y, voxel_m.z}), options.step_m, 100.0);
  return options;
}

/// Returns the fraction of a field's bricks that are stored, at least.
double ShareWithCloud(const renderer::CloudField& field) {
  constexpr int kBrickSide = 8;
  constexpr double kBytesOfBrick = 738.0;  // with its index; those of a grid have more
  double bricks = 1.0;
  for (const int voxels : field.lattice().voxels) bricks *= (voxels + kBrickSide - 1) / kBrickSide;
  return std::min(1.0, static_cast<double>(field.bytes()) / (kBytesOfBrick * bricks));
}

/// Returns the memory that the map of sunlight may need [bytes]. A node of that of a high sun takes up
/// to 2 bytes for each of its levels.
double SunMapBytes(const renderer::CloudField& field, const glm::dvec3& to_sun,
                   const renderer::CloudLowSunOptions& low_sun) {
  if (renderer::IsLowCloudSun(to_sun)) {
    return renderer::CloudLowSunMap::BytesFor(field, renderer::CloudLowSun(field, to_sun, low_sun));
  }
  constexpr double kNode = 12.0, kCellsAlongBeam = 4.0;
  const double cell_m = SunMapFor(field).cell_m;
  const glm::dvec3 size_m = field.lattice().size_m();
  const double depth_m = field.top_altitude_m() - field.base_altitude_m();
  const double levels = depth_m / (kCellsAlongBeam * cell_m * to_sun.z);
  return std::max(1.0, size_m.x / cell_m) * std::max(1.0, size_m.y / cell_m) *
         (kNode + 2.0 * levels);
}

/// Returns the memory that the moments of a field may need [bytes]. Solving takes some 20 vectors of
/// moments of full cells.
double MomentBytes(const renderer::CloudField& field, double cell_m) {
  constexpr double kClearCell = 9.0, kFullCell = 2000.0;
  const glm::dvec3 size_m = field.lattice().size_m();
  const double depth_m = field.top_altitude_m() - field.base_altitude_m();
  const double columns = std::max(1.0, size_m.x / cell_m) * std::max(1.0, size_m.y / cell_m);
  return columns * std::max(6.0, depth_m / cell_m) *
         (kClearCell + kFullCell * ShareWithCloud(field));
}

CloudRayLight LightOf(const renderer::CloudRayLight& light) {
  return {.sun = light.sun,
          .sky = light.sky,
          .ground = light.ground,
          .transmittance = light.transmittance,
          .wide_transmittance = light.scaled_transmittance,
          .mean_distance_m = light.mean_distance_m};
}

CloudEstimate EstimateOf(const renderer::CloudEstimate& estimate) {
  return {estimate.value, estimate.standard_error};
}

TracedCloudFluxes FluxesOf(const renderer::CloudColumnFluxes& column) {
  return {EstimateOf(column.up_at_top), EstimateOf(column.direct_at_base),
          EstimateOf(column.down_at_base)};
}

void CheckColumns(const std::array<int, 2>& columns, double most) {
  for (std::size_t axis = 0; axis < 2; ++axis) {
    RequireInRange(columns[axis], 1.0, 4096.0, fmt::format("columns[{}]", axis));
  }
  RequireInRange(static_cast<double>(columns[0]) * columns[1], 1.0, most,
                 "the number of all columns");
}

renderer::CloudPathOptions OptionsOf(const CloudPathOptions& options) {
  RequireInRange(static_cast<double>(options.paths), 1.0, 1e10, "options.paths");
  if (options.max_order) {
    RequireInRange(*options.max_order, 1.0, std::numeric_limits<int>::max(), "options.max_order");
  }
  return {.seed = options.seed,
          .paths = options.paths,
          .max_order = options.max_order.value_or(std::numeric_limits<int>::max())};
}

}  // namespace

CloudField::CloudField(const CloudLayer& layer, double time_s) {
  const renderer::CloudOptions options = OptionsOf(layer);
  state_ = std::make_shared<const State>(
      State{FieldOf(options, time_s),
            renderer::IsOfIce(options.genus) ? CloudParticles::kIce : CloudParticles::kDroplets});
}

CloudField::CloudField(const CloudGrid& grid)
    : state_(std::make_shared<const State>(State{FieldOf(grid), grid.particles, grid.g})) {}

bool CloudField::is_periodic() const { return state_->field.lattice().is_periodic; }

std::array<double, 2> CloudField::size_m() const {
  const glm::dvec3 size_m = state_->field.lattice().size_m();
  return {size_m.x, size_m.y};
}

double CloudField::base_m() const { return state_->field.base_altitude_m(); }
double CloudField::top_m() const { return state_->field.top_altitude_m(); }

double CloudField::Extinction_per_m(const LocalPoint& point) const {
  return state_->field.Extinction_per_m(CheckedPoint(point, "point"));
}

double CloudField::EffectiveRadius_um(const LocalPoint& point) const {
  return state_->field.EffectiveRadius_um(CheckedPoint(point, "point"));
}

std::size_t CloudField::bytes() const { return state_->field.bytes(); }

struct CloudLight::State {
  std::shared_ptr<const CloudField::State> field;  // the light refers to it
  CloudSurroundings surroundings;
  double cell_m;
  renderer::CloudLight light;

  void RequireMemoryFor(const glm::dvec3& to_sun) const {
    RequireMemoryFor(field->field, cell_m, to_sun,
                     renderer::LowSunOver(field->field, surroundings.planet_radius_m));
  }
  static void RequireMemoryFor(const renderer::CloudField& field, double cell_m,
                               const glm::dvec3& to_sun,
                               const renderer::CloudLowSunOptions& low_sun) {
    const glm::dvec3 size_m = field.lattice().size_m();
    RequireMemory(MomentBytes(field, cell_m) + SunMapBytes(field, to_sun, low_sun),
                  fmt::format("light with options.cell_m {} in a field of {} x {} m", cell_m,
                              size_m.x, size_m.y));
  }
};

CloudLight::CloudLight(const CloudField& field, const Direction& to_sun,
                       const CloudLightOptions& options) {
  const renderer::CloudField& clouds = field.state_->field;
  const CloudSurroundings& around = Checked(options.surroundings, clouds.base_altitude_m());
  const double cell_m = RequireInRange(options.cell_m.value_or(renderer::UsualCloudCell_m(clouds)),
                                       20.0, 2500.0, "options.cell_m");
  const glm::dvec3 sun = CheckedSun(to_sun);
  State::RequireMemoryFor(clouds, cell_m, sun,
                          renderer::LowSunOver(clouds, around.planet_radius_m));
  renderer::CloudLightOptions with;
  with.low_sun = renderer::LowSunOver(clouds, around.planet_radius_m);
  with.moments.cell_m = cell_m;
  with.sun_map = SunMapFor(clouds);
  if (!options.has_fitted_factor) with.factor.rays = 0;
  const renderer::CloudScatterers scatterers{
      PhasesOf(field.state_->particles, field.state_->g, around.wavelength_nm)};
  const renderer::CloudSurroundings surroundings{sun, around.ground_albedo, around.ground_m};
  state_ = std::make_shared<const State>(State{
      field.state_, around, cell_m, renderer::CloudLight(clouds, scatterers, surroundings, with)});
}

CloudLight::CloudLight(std::shared_ptr<const State> state) : state_(std::move(state)) {}

CloudLight CloudLight::WithSun(const Direction& to_sun) const {
  const glm::dvec3 sun = CheckedSun(to_sun);
  state_->RequireMemoryFor(sun);
  return CloudLight(std::make_shared<const State>(
      State{state_->field, state_->surroundings, state_->cell_m, state_->light.WithSun(sun)}));
}

CloudRayLight CloudLight::Scattered(const CloudRay& ray) const {
  const CheckedRay checked = Checked(ray, state_->surroundings.ground_m);
  return LightOf(state_->light.Radiance(checked.ray, checked.length_m));
}

std::vector<CloudRayLight> CloudLight::Scattered(std::span<const CloudRay> rays) const {
  std::vector<CloudRayLight> light(rays.size());
  tbb::parallel_for(std::size_t{0}, rays.size(),
                    [&](std::size_t i) { light[i] = Scattered(rays[i]); });
  return light;
}

CloudRadiance CloudLight::Radiance(const CloudRay& ray) const {
  const CloudSurroundings& around = state_->surroundings;
  const renderer::CloudRay checked = CheckedToItsEnd(ray, around.ground_m);
  const double down = -checked.direction.z;
  if (!(down > 0.0)) {
    const renderer::CloudRayLight light = state_->light.Radiance(checked);
    return {light.sun, light.sky + light.scaled_transmittance, light.ground};
  }
  const double to_ground_m = (checked.origin.z - around.ground_m) / down;
  const renderer::CloudRayLight light = state_->light.Radiance(checked, to_ground_m);
  const renderer::CloudGroundIrradiance& irradiance = state_->light.ground_irradiance();
  const glm::dvec3 ground = checked.At(to_ground_m);
  const double direct =
      std::max(state_->light.sun().ToSunAt(ground).z, 0.0) * state_->light.SunTransmittance(ground);
  const double reflected = light.scaled_transmittance * around.ground_albedo / kPi;
  return {light.sun + reflected * (direct + irradiance.diffuse),
          light.sky + reflected * irradiance.sky,
          light.ground + light.scaled_transmittance + reflected * irradiance.ground};
}

double CloudLight::SunTransmittance(const LocalPoint& point) const {
  return state_->light.SunTransmittance(CheckedPoint(point, "point"));
}

std::vector<CloudFluxes> CloudLight::Fluxes(const std::array<int, 2>& columns,
                                            int rays_per_column) const {
  CheckColumns(columns, 4096.0 * 4096.0);
  RequireSunOfFluxes(state_->light.sun().to_sun());
  RequireInRange(rays_per_column, 1.0, 1e7, "rays_per_column");
  std::vector<CloudFluxes> fluxes;
  for (const renderer::CloudLightFluxes& column :
       renderer::GatheredFluxes(state_->light, {columns, rays_per_column})) {
    fluxes.push_back({column.up_at_top, column.direct_at_base, column.down_at_base});
  }
  return fluxes;
}

std::size_t CloudLight::bytes() const { return state_->light.bytes(); }

struct CloudPaths::State {
  std::shared_ptr<const CloudField::State> field;  // the tracer refers to it
  glm::dvec3 to_sun;
  double ground_m;
  std::shared_ptr<const renderer::CloudLowSun> low_sun;  // likewise; null for a high sun
  renderer::CloudPathTracer tracer;
};

CloudPaths::CloudPaths(const CloudField& field, const Direction& to_sun,
                       const CloudSurroundings& surroundings) {
  const renderer::CloudField& clouds = field.state_->field;
  const CloudSurroundings& around = Checked(surroundings, clouds.base_altitude_m());
  const glm::dvec3 sun = CheckedSun(to_sun);
  std::shared_ptr<const renderer::CloudLowSun> low_sun;
  if (renderer::IsLowCloudSun(sun))
    low_sun = std::make_shared<const renderer::CloudLowSun>(
        clouds, sun, renderer::LowSunOver(clouds, around.planet_radius_m));
  renderer::CloudPathTracer tracer(
      clouds, {PhasesOf(field.state_->particles, field.state_->g, around.wavelength_nm)},
      {sun, around.ground_albedo, around.ground_m, low_sun.get()});
  state_ = std::make_shared<const State>(
      State{field.state_, sun, around.ground_m, low_sun, std::move(tracer)});
}

CloudPaths::CloudPaths(std::shared_ptr<const State> state) : state_(std::move(state)) {}

CloudPaths CloudPaths::WithSimilarity(int collisions) const {
  RequireInRange(collisions, 1.0, 1000.0, "collisions");
  State other = *state_;
  other.tracer = state_->tracer.WithSimilarity(collisions);
  return CloudPaths(std::make_shared<const State>(std::move(other)));
}

TracedCloudRadiance CloudPaths::Radiance(const CloudRay& ray,
                                         const CloudPathOptions& options) const {
  const renderer::CloudRadiance light =
      state_->tracer.Radiance(CheckedToItsEnd(ray, state_->ground_m), OptionsOf(options));
  return {EstimateOf(light.sun), EstimateOf(light.sky), EstimateOf(light.ground),
          EstimateOf(light.transmittance), light.paths};
}

CloudColumns CloudPaths::Fluxes(const std::array<int, 2>& columns,
                                const CloudPathOptions& options) const {
  CheckColumns(columns, 262144.0);
  RequireSunOfFluxes(state_->to_sun);
  const renderer::CloudFluxes found =
      state_->tracer.Fluxes(renderer::CloudSource::kSun, {OptionsOf(options), columns});
  CloudColumns all{.column = {}, .mean = FluxesOf(found.mean), .photons = found.photons};
  for (const renderer::CloudColumnFluxes& column : found.column) {
    all.column.push_back(FluxesOf(column));
  }
  return all;
}

}  // namespace alpenglow
