// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_light.h"

#include <algorithm>
#include <cstdint>
#include <mutex>
#include <optional>
#include <utility>

#include "atmosphere/base/names.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "renderer/cloud_light/plane_parallel_light.h"

namespace alpenglow::renderer {
namespace {

constexpr EnumNames kCloudLightMethods{{std::pair{CloudLightMethod::kFast, "fast"},
                                        {CloudLightMethod::kHybrid, "hybrid"},
                                        {CloudLightMethod::kTraced, "traced"}}};

/// Throws InputError of the path tracer.
const CloudSurroundings& CheckedSurroundings(const CloudField& field,
                                             const CloudScatterers& scatterers,
                                             const CloudSurroundings& surroundings) {
  static_cast<void>(CloudPathTracer(field, scatterers, surroundings));
  return surroundings;
}

/// Scattered light of a ray over black ground.
struct ScatteredByPart {
  double sun, sky, ground;
};

/// Returns traced light without that of sky or ground behind the clouds which their forward peak
/// turns a little: the scaled transmittance has it.
ScatteredByPart BesidePeak(const CloudScattered& traced, const CloudRay& ray,
                           double scaled_transmittance) {
  const double turned = std::max(scaled_transmittance - traced.transmittance, 0.0);
  ScatteredByPart light{traced.sun.value, traced.sky.value, traced.ground.value};
  double& behind = ray.direction.z >= 0.0 ? light.sky : light.ground;
  double& before = ray.direction.z >= 0.0 ? light.ground : light.sky;
  behind -= turned;
  // Noise of few paths must not make light negative; the sum of both parts is kept.
  before = std::max(before + std::min(behind, 0.0), 0.0);
  behind = std::max(behind, 0.0);
  return light;
}

/// Returns the irradiance of ground below a field, and releases the light of which it is made.
CloudFloor FloorBelow(const CloudField& field, const CloudCells& cells, double ground_altitude_m,
                      SolvedCloudMoments& solved) {
  const std::vector<CloudBaseLight> light = std::exchange(solved.through_base, {});
  return {{{cells.count()[0], cells.count()[1]},
           glm::dvec2(field.lattice().origin_m),
           glm::dvec2(cells.cell_m())},
          light,
          field.base_altitude_m() - ground_altitude_m};
}

/// Returns a seed that differs between rays.
std::uint64_t SeedOf(const CloudRay& ray, double length_m) {
  Fnv1a hash;
  for (const double value : {ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x,
                             ray.direction.y, ray.direction.z, length_m}) {
    hash.Add(value);
  }
  return hash.hash();
}

}  // namespace

std::vector<std::string> CloudLightMethodNames() { return kCloudLightMethods.All(); }

CloudLightMethod CloudLightMethodFromName(std::string_view name) {
  return kCloudLightMethods.Named(name, "method of light in clouds \"{}\" is not one of {}");
}

std::string NameOf(CloudLightMethod method) { return kCloudLightMethods.Of(method); }

/// The parts that all suns share.
struct CloudLight::FieldLight {
  FieldLight(const CloudField& of, const CloudScatterers& by, const CloudSurroundings& surroundings,
             const CloudLightOptions& with)
      : field(&of),
        scatterers(by),
        ground_albedo(surroundings.ground_albedo),
        ground_altitude_m(surroundings.ground_altitude_m),
        options(with),
        optics(std::make_shared<const CloudOptics>(of, by)),
        solver(of, optics, with.moments),
        sky(solver.Sky()),
        floor(FloorBelow(of, solver.cells(), ground_altitude_m, sky)) {
    if (optics->albedo() < 1.0) ground.emplace(solver.Ground());
    if (IsPlaneParallel(of)) {
      plane_parallel = std::make_shared<const PlaneParallelCloud>(of, *optics);
      sky.up_at_top = plane_parallel->SkyAtTop().up;
      sky.down_at_base = plane_parallel->SkyAtBase().down;
      if (ground) ground->down_at_base = sky.up_at_top;  // reciprocity
    }
  }

  /// Returns the fraction of light from below that comes back down through the base.
  [[nodiscard]] double ReturnedToGround() const {
    if (!field->lattice().is_periodic) return 0.0;
    return ground ? ground->down_at_base / kPi : 1.0 - sky.down_at_base / kPi;
  }

  const CloudField* field;
  CloudScatterers scatterers;
  double ground_albedo, ground_altitude_m;
  CloudLightOptions options;
  std::shared_ptr<const CloudOptics> optics;
  CloudMomentSolver solver;
  SolvedCloudMoments sky;
  CloudFloor floor;  // of the sky
  std::optional<SolvedCloudMoments> ground;
  std::shared_ptr<const PlaneParallelCloud> plane_parallel;  // null for other fields
};

struct CloudLight::SunLight {
  /// @param to_sun  nothing: no sun is solved for.
  SunLight(const FieldLight& light, const std::optional<glm::dvec3>& to_sun)
      : depths(DepthsOf(light, to_sun)),
        moments(to_sun ? light.solver.Sun(depths) : light.solver.None()),
        floor(FloorBelow(*light.field, light.solver.cells(), light.ground_altitude_m, moments)),
        gather(*light.field, *light.optics, depths, moments.moments, light.sky.moments,
               light.ground ? &light.ground->moments : nullptr, light.options.gather),
        layer(light.plane_parallel) {
    if (to_sun) FindSunlight(light);
    const bool is_periodic = light.field->lattice().is_periodic;
    const double repeated = 1.0 / (1.0 - light.ground_albedo * light.ReturnedToGround());
    if (to_sun) {
      irradiance.direct =
          std::max(to_sun->z, 0.0) * (is_periodic ? depths.MeanTransmittance() : 1.0);
    }
    const double sun = irradiance.direct + (is_periodic ? moments.down_at_base : 0.0);
    irradiance.diffuse = repeated * sun - irradiance.direct;
    irradiance.sky = repeated * (is_periodic ? light.sky.down_at_base : kPi);
    irradiance.ground = repeated * kPi * light.ReturnedToGround();
  }
  SunLight(const SunLight&) = delete;
  SunLight& operator=(const SunLight&) = delete;

  static CloudSunDepths DepthsOf(const FieldLight& light, const std::optional<glm::dvec3>& to_sun) {
    if (!to_sun) return CloudSunDepths(*light.field);
    return {*light.field, *to_sun, light.options.sun_map, light.options.low_sun};
  }
  /// Finds the light of a plane-parallel field or the factor of any other one.
  void FindSunlight(const FieldLight& light) {
    if (light.plane_parallel) {
      plane_parallel.emplace(light.plane_parallel, depths);
      moments.up_at_top = plane_parallel->UpAtTop();
      moments.down_at_base = plane_parallel->DownAtBase();
    } else {
      factor = FactorAfter(light, 0);
    }
    if (!plane_parallel && light.options.factor.rays > 0 && depths.map() &&
        light.field->lattice().is_periodic) {
      const CloudLattice& lattice = light.field->lattice();
      factor = WithFlux(factor, gather,
                        {*light.field, glm::dvec2(lattice.origin_m), glm::dvec2(lattice.size_m()),
                         depths.to_sun(), light.optics->phase()},
                        moments.up_at_top + moments.down_at_base);
    }
  }

  /// Returns the light of the fast method.
  [[nodiscard]] CloudRayParts Along(const CloudRay& ray, double length_m) const {
    if (plane_parallel) return plane_parallel->Along(ray, length_m);
    if (layer) return layer->UnlitAlong(ray, length_m);
    CloudRayParts parts = gather.Along(ray, length_m);
    if (depths.IsUnlit()) {
      parts.first = 0.0;
      parts.once = {};
    }
    return parts;
  }
  /// Returns the factor for rays that begin after some collisions.
  [[nodiscard]] CloudFactor FactorAfter(const FieldLight& light, int collisions) const {
    CloudFactorOptions options = light.options.factor;
    if (options.rays == 0 || depths.IsUnlit()) return {};
    options.collisions = collisions;
    const CloudPathTracer tracer(*light.field, light.scatterers,
                                 {.to_sun = depths.to_sun(),
                                  .ground_altitude_m = light.ground_altitude_m,
                                  .low_sun = depths.low_sun()},
                                 light.options.gather.uses_detail);
    return FitCloudFactor(*light.field, gather, tracer, options);
  }
  /// Returns the factor for the hybrid method, which is fitted on first use.
  [[nodiscard]] const CloudFactor& HybridFactor(const FieldLight& light) const {
    std::call_once(hybrid_asked, [&] {
      hybrid_factor = FactorAfter(light, light.options.paths.collisions.value_or(0));
    });
    return hybrid_factor;
  }

  CloudSunDepths depths;
  SolvedCloudMoments moments;
  CloudFloor floor;
  CloudGather gather;                               // refers to depths and moments
  std::shared_ptr<const PlaneParallelCloud> layer;  // null for other fields
  std::optional<PlaneParallelSun> plane_parallel;
  CloudFactor factor;
  CloudGroundIrradiance irradiance;
  mutable std::once_flag hybrid_asked;
  mutable CloudFactor hybrid_factor;
};

CloudLight::CloudLight(const CloudField& field, const CloudScatterers& scatterers,
                       const CloudSurroundings& surroundings, const CloudLightOptions& options)
    : field_light_(std::make_shared<const FieldLight>(
          field, scatterers, CheckedSurroundings(field, scatterers, surroundings), options)),
      sun_light_(std::make_shared<const SunLight>(*field_light_, surroundings.to_sun)) {
  *this = WithMethod(options.method);
}

CloudLight CloudLight::Unlit(const CloudField& field, const CloudScatterers& scatterers,
                             const CloudSurroundings& surroundings,
                             const CloudLightOptions& options) {
  CloudLight light;
  light.field_light_ = std::make_shared<const FieldLight>(
      field, scatterers, CheckedSurroundings(field, scatterers, surroundings), options);
  light.sun_light_ = std::make_shared<const SunLight>(*light.field_light_, std::nullopt);
  return light.WithMethod(options.method);
}

CloudLight CloudLight::WithSun(const std::optional<glm::dvec3>& to_sun) const {
  CloudLight moved = *this;
  moved.sun_light_ = std::make_shared<const SunLight>(*field_light_, to_sun);
  return moved.WithMethod(method_);
}

CloudLight CloudLight::WithMethod(CloudLightMethod method, std::optional<int> of_ray) const {
  const FieldLight& light = *field_light_;
  CloudHybridOptions paths = light.options.paths;
  paths.paths = of_ray.value_or(paths.paths);
  if (method == CloudLightMethod::kTraced) paths.collisions.reset();
  CloudLight same = *this;
  same.method_ = method;
  const bool is_hybrid = method == CloudLightMethod::kHybrid;
  // Options out of range are refused for every method.
  same.paths_ = std::make_shared<const CloudHybrid>(
      *light.field, light.scatterers,
      SolvedCloudLight{*light.optics, sun_light_->depths, sun_light_->moments.moments,
                       light.sky.moments, light.ground ? &light.ground->moments : nullptr,
                       is_hybrid ? sun_light_->HybridFactor(light) : CloudFactor{}},
      paths, light.options.gather.uses_detail);
  return same;
}

CloudRayLights CloudLight::RadianceByBoth(const CloudRay& ray, double length_m) const {
  const CloudRayParts parts = sun_light_->Along(ray, length_m);
  const auto over_ground = [&](const ScatteredByPart& light) {
    const CloudGroundIrradiance& irradiance = sun_light_->irradiance;
    const double reflected = light.ground * field_light_->ground_albedo / kPi;
    return CloudRayLight{.sun = light.sun + reflected * (irradiance.direct + irradiance.diffuse),
                         .sky = light.sky + reflected * irradiance.sky,
                         .ground = light.ground + reflected * irradiance.ground,
                         .transmittance = parts.transmittance,
                         .scaled_transmittance = parts.scaled_transmittance,
                         .mean_distance_m = parts.mean_distance_m,
                         .once = parts.once};
  };
  const CloudRayLight fast = over_ground({sun_light_->factor.Sun(parts), parts.sky, parts.ground});
  if (method_ == CloudLightMethod::kFast || parts.transmittance >= 1.0) return {fast, fast};
  CloudScattered traced = paths_->Radiance(ray, length_m, SeedOf(ray, length_m));
  if (sun().IsUnlit()) traced.sun = {};
  return {fast, over_ground(BesidePeak(traced, ray, parts.scaled_transmittance))};
}

CloudGroundDifference CloudLight::GroundDifferenceAt(const glm::dvec3& point) const {
  if (!field_light_->field->lattice().is_periodic || field_light_->plane_parallel) return {};
  const glm::dvec2 place(point);
  const CloudFloor &of_sun = sun_light_->floor, &of_sky = field_light_->floor;
  return {of_sun.At(place) - of_sun.mean(), of_sky.At(place) - of_sky.mean()};
}

const CloudGroundIrradiance& CloudLight::ground_irradiance() const {
  return sun_light_->irradiance;
}
const CloudField& CloudLight::field() const { return *field_light_->field; }
const CloudOptics& CloudLight::optics() const { return *field_light_->optics; }
const PlaneParallelCloud* CloudLight::plane_parallel() const {
  return field_light_->plane_parallel.get();
}
const CloudSunDepths& CloudLight::sun() const { return sun_light_->depths; }
const CloudFactor& CloudLight::factor() const { return sun_light_->factor; }
double CloudLight::ground_albedo() const { return field_light_->ground_albedo; }
const SolvedCloudMoments& CloudLight::sun_moments() const { return sun_light_->moments; }
const SolvedCloudMoments& CloudLight::sky_moments() const { return field_light_->sky; }

std::size_t CloudLight::bytes() const {
  const std::size_t ground = field_light_->ground ? field_light_->ground->moments.bytes() : 0;
  return sun_light_->depths.bytes() + sun_light_->moments.moments.bytes() +
         field_light_->sky.moments.bytes() + ground + field_light_->solver.bytes() +
         sun_light_->floor.bytes() + field_light_->floor.bytes();
}

}  // namespace alpenglow::renderer
