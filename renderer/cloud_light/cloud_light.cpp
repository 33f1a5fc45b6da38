// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_light.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "atmosphere/math/constants.h"

namespace alpenglow::renderer {
namespace {

/// Throws InputError of the path tracer.
const CloudSurroundings& CheckedSurroundings(const CloudField& field,
                                             const CloudScatterers& scatterers,
                                             const CloudSurroundings& surroundings) {
  static_cast<void>(CloudPathTracer(field, scatterers, surroundings));
  return surroundings;
}

}  // namespace

/// The parts that all suns share.
struct CloudLight::FieldLight {
  FieldLight(const CloudField& of, const CloudScatterers& by, const CloudSurroundings& surroundings,
             const CloudLightOptions& with)
      : field(&of),
        scatterers(by),
        ground_albedo(surroundings.ground_albedo),
        options(with),
        optics(std::make_shared<const CloudOptics>(of, by)),
        solver(of, optics, with.moments),
        sky(solver.Sky()) {
    if (optics->albedo() < 1.0) ground.emplace(solver.Ground());
  }

  /// Returns the fraction of light from below that comes back down through the base.
  [[nodiscard]] double ReturnedToGround() const {
    if (!field->lattice().is_periodic) return 0.0;
    return ground ? ground->down_at_base / kPi : 1.0 - sky.down_at_base / kPi;
  }

  const CloudField* field;
  CloudScatterers scatterers;
  double ground_albedo;
  CloudLightOptions options;
  std::shared_ptr<const CloudOptics> optics;
  CloudMomentSolver solver;
  SolvedCloudMoments sky;
  std::optional<SolvedCloudMoments> ground;
};

struct CloudLight::SunLight {
  SunLight(const FieldLight& light, const glm::dvec3& to_sun)
      : depths(*light.field, to_sun, light.options.sun_map, light.options.low_sun),
        moments(light.solver.Sun(depths)),
        gather(*light.field, *light.optics, depths, moments.moments, light.sky.moments,
               light.ground ? &light.ground->moments : nullptr, light.options.gather) {
    if (light.options.factor.rays > 0) {
      const CloudPathTracer tracer(*light.field, light.scatterers,
                                   {.to_sun = to_sun, .low_sun = depths.low_sun()},
                                   light.options.gather.uses_detail);
      factor = FitCloudFactor(*light.field, gather, tracer, light.options.factor);
    }
    const bool is_periodic = light.field->lattice().is_periodic;
    const double repeated = 1.0 / (1.0 - light.ground_albedo * light.ReturnedToGround());
    irradiance.direct = std::max(to_sun.z, 0.0) * (is_periodic ? depths.MeanTransmittance() : 1.0);
    const double sun = irradiance.direct + (is_periodic ? moments.down_at_base : 0.0);
    irradiance.diffuse = repeated * sun - irradiance.direct;
    irradiance.sky = repeated * (is_periodic ? light.sky.down_at_base : kPi);
    irradiance.ground = repeated * kPi * light.ReturnedToGround();
  }
  SunLight(const SunLight&) = delete;
  SunLight& operator=(const SunLight&) = delete;

  CloudSunDepths depths;
  SolvedCloudMoments moments;
  CloudGather gather;  // refers to depths and moments
  CloudFactor factor;
  CloudGroundIrradiance irradiance;
};

CloudLight::CloudLight(const CloudField& field, const CloudScatterers& scatterers,
                       const CloudSurroundings& surroundings, const CloudLightOptions& options)
    : CloudLight(
          std::make_shared<const FieldLight>(
              field, scatterers, CheckedSurroundings(field, scatterers, surroundings), options),
          surroundings.to_sun) {}

CloudLight::CloudLight(std::shared_ptr<const FieldLight> field_light, const glm::dvec3& to_sun)
    : field_light_(std::move(field_light)),
      sun_light_(std::make_shared<const SunLight>(*field_light_, to_sun)) {}

CloudLight CloudLight::WithSun(const glm::dvec3& to_sun) const { return {field_light_, to_sun}; }

CloudRayLight CloudLight::Radiance(const CloudRay& ray, double length_m) const {
  const CloudRayParts parts = sun_light_->gather.Along(ray, length_m);
  const CloudGroundIrradiance& irradiance = sun_light_->irradiance;
  const double reflected = parts.ground * field_light_->ground_albedo / kPi;
  return {
      .sun = sun_light_->factor.Sun(parts) + reflected * (irradiance.direct + irradiance.diffuse),
      .sky = parts.sky + reflected * irradiance.sky,
      .ground = parts.ground + reflected * irradiance.ground,
      .transmittance = parts.transmittance,
      .scaled_transmittance = parts.scaled_transmittance,
      .mean_distance_m = parts.mean_distance_m};
}

const CloudGroundIrradiance& CloudLight::ground_irradiance() const {
  return sun_light_->irradiance;
}
const CloudField& CloudLight::field() const { return *field_light_->field; }
const CloudOptics& CloudLight::optics() const { return *field_light_->optics; }
const CloudSunDepths& CloudLight::sun() const { return sun_light_->depths; }
const CloudFactor& CloudLight::factor() const { return sun_light_->factor; }
double CloudLight::ground_albedo() const { return field_light_->ground_albedo; }
const SolvedCloudMoments& CloudLight::sun_moments() const { return sun_light_->moments; }
const SolvedCloudMoments& CloudLight::sky_moments() const { return field_light_->sky; }

std::size_t CloudLight::bytes() const {
  const std::size_t ground = field_light_->ground ? field_light_->ground->moments.bytes() : 0;
  return sun_light_->depths.bytes() + sun_light_->moments.moments.bytes() +
         field_light_->sky.moments.bytes() + ground + field_light_->solver.bytes();
}

}  // namespace alpenglow::renderer
