// SPDX-License-Identifier: MIT
#include <alpenglow/sky.h>

#include <alpenglow/errors.h>
#include <alpenglow/version.h>
#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "atmosphere/api/conversions.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/base/error.h"
#include "atmosphere/base/finite.h"
#include "atmosphere/math/constants.h"
#include "lut/api/conversions.h"
#include "lut/api/sky_parts.h"
#include "lut/multiple_scattering/successive_orders.h"
#include "lut/version.h"

namespace alpenglow {

using atmosphere::RequireInRange;
using atmosphere::ViewRay;

std::string_view Version() { return version::kRelease; }

namespace {

// Returns the light unless it is not finite.
const Spectrum& Checked(const Spectrum& light) {
  atmosphere::RequireFinite(light.values(), "light of a sky");
  return light;
}

// Clear air needs some six orders, thick air more than a hundred: the estimate slows down.
double EstimatedFraction(double orders) { return orders / (orders + 2.0); }

lut::TableFolder SolvedWithoutTables(const atmosphere::Medium& medium,
                                     const ProgressFunction& progress) {
  const lut::MultipleScatteringOptions options = lut::OptionsFor(medium);
  const auto parts = static_cast<double>(lut::PartsOfOrder(medium, options));
  lut::TableFolder tables;
  tables.medium = medium;
  tables.multiple_scattering.emplace(
      lut::SolvedStepwise(medium, options, PartDone(progress, [parts](std::size_t done) {
                            return EstimatedFraction(static_cast<double>(done) / parts);
                          })));
  if (progress && !progress(1.0)) throw Cancelled();
  return tables;
}

/// The sun of a ray or a plane.
struct CheckedSun {
  explicit CheckedSun(const Sunlight& sun)
      : seen(UnitVectorOf(sun.to_sun)),
        for_air(UnitVectorOf(sun.to_sun_for_air)),
        radius_rad(sun.angular_radius_deg * atmosphere::kRadiansPerDegree),
        strength(static_cast<float>(1.0 / (sun.distance_au * sun.distance_au))) {
    RequireInRange(sun.distance_au, kNearestSun_au, kFarthestSun_au, "sun.distance_au");
    RequireInRange(sun.angular_radius_deg, kSmallestSun_deg, kLargestSun_deg,
                   "sun.angular_radius_deg");
  }

  glm::dvec3 seen, for_air;
  double radius_rad;
  float strength;  // over that at the mean distance
};

/// The light of single rays and planes.
class SkyLight {
 public:
  explicit SkyLight(const lut::TableLookup& lookup) : lookup_(lookup) {}

  [[nodiscard]] Spectrum Radiance(const LocalPoint& eye, const Direction& view,
                                  const Sunlight& sun) const {
    const CheckedSun from(sun);
    return Checked(from.strength * lookup_.InscatterOfAllOrders(
                                       RayFrom(AltitudeOf(eye), UnitVectorOf(view), from.for_air)));
  }
  [[nodiscard]] Polarisation PolarisationOf(const LocalPoint& eye, const Direction& view,
                                            const Sunlight& sun) const;
  [[nodiscard]] Spectrum DiskRadiance(const LocalPoint& eye, const Direction& view,
                                      const Sunlight& sun) const;
  [[nodiscard]] AirBetween Between(const LocalPoint& eye, const LocalPoint& object,
                                   const Sunlight& sun) const;
  /// @param normal  null: that of the horizontal plane.
  [[nodiscard]] Spectrum SunIrradiance(const LocalPoint& point, const Sunlight& sun,
                                       const Direction* normal) const;
  [[nodiscard]] Spectrum SkyIrradiance(const LocalPoint& point, const Sunlight& sun,
                                       const Direction* normal) const;

 private:
  [[nodiscard]] AltitudeAndZenith AltitudeOf(const LocalPoint& point) const {
    return alpenglow::AltitudeOf(point, lookup_.medium().planet_radius_m);
  }

  const lut::TableLookup& lookup_;
};

// The look-up takes the sun for one to the left of the view. On the other side U has the other sign.
Polarisation SkyLight::PolarisationOf(const LocalPoint& eye, const Direction& view,
                                      const Sunlight& sun) const {
  const CheckedSun from(sun);
  const AltitudeAndZenith place = AltitudeOf(eye);
  const glm::dvec3 direction = UnitVectorOf(view);
  const lut::PolarisedLight light =
      lookup_.PolarisationOfAllOrders(RayFrom(place, direction, from.for_air));
  const bool is_right = glm::dot(glm::cross(from.for_air, direction), place.up) > 0.0;
  return {Checked(from.strength * light.q),
          Checked((is_right ? -from.strength : from.strength) * light.u)};
}

Spectrum SkyLight::DiskRadiance(const LocalPoint& eye, const Direction& view,
                                const Sunlight& sun) const {
  const CheckedSun from(sun);
  const AltitudeAndZenith place = AltitudeOf(eye);
  const glm::dvec3 direction = UnitVectorOf(view);
  const double apart_rad =
      std::atan2(glm::length(glm::cross(direction, from.seen)), glm::dot(direction, from.seen));
  const double rho = apart_rad / from.radius_rad;
  if (rho > 1.0) return Spectrum(lookup_.bands());
  const auto mean = static_cast<float>(1.0 / atmosphere::DiskSolidAngle(from.radius_rad));
  Spectrum light = (from.strength * mean) *
                   lookup_.single_scattering().TransmittanceToSpace(
                       std::max(place.altitude_m, 0.0), CosineBetween(direction, place.up));
  for (std::size_t band = 0; band < light.size(); ++band) {
    light[band] *=
        static_cast<float>(atmosphere::LimbDarkening(rho, lookup_.medium().wavelengths_nm[band]));
  }
  return Checked(light);
}

AirBetween SkyLight::Between(const LocalPoint& eye, const LocalPoint& object,
                             const Sunlight& sun) const {
  const CheckedSun from(sun);
  const AltitudeAndZenith place = AltitudeOf(eye);
  static_cast<void>(AltitudeOf(object));  // checks it
  const glm::dvec3 way{object.east_m - eye.east_m, object.north_m - eye.north_m,
                       object.up_m - eye.up_m};
  const double length_m = glm::length(way);
  const glm::dvec3 view = length_m > 0.0 ? way / length_m : place.up;
  const ViewRay ray = RayFrom(place, view, from.for_air, length_m);
  const atmosphere::SingleScattering<float>& air = lookup_.single_scattering();
  const auto samples = air.Sample(
      ray, {.nodes = lookup_.tables().ray_nodes, .split_ozone = false, .dark_samples = true});
  const Spectrum once = air.Inscatter(air.Scatter(samples), ray.nu);
  const Spectrum more =
      lookup_.multiple_scattering().InscatterAlong(samples, ray.nu, lut::SegmentEnd::kOpaque);
  return {Checked(air.TransmittanceAlong(ray)), Checked(from.strength * (once + more))};
}

// The horizon cuts the disk: what is left lights the plane from its own centre.
Spectrum SkyLight::SunIrradiance(const LocalPoint& point, const Sunlight& sun,
                                 const Direction* normal) const {
  const CheckedSun from(sun);
  const AltitudeAndZenith place = AltitudeOf(point);
  const glm::dvec3 facing = normal != nullptr ? UnitVectorOf(*normal) : place.up;
  const double altitude_m = std::max(place.altitude_m, 0.0);
  const double mu_s = CosineBetween(from.seen, place.up);
  const double radius_m = lookup_.medium().planet_radius_m;
  const double sine_of_horizon = radius_m / (radius_m + altitude_m);
  const double horizon = -std::sqrt((1.0 - sine_of_horizon) * (1.0 + sine_of_horizon));
  const atmosphere::VisibleDisk disk = atmosphere::DiskOverHorizon(mu_s, horizon, from.radius_rad);
  const glm::dvec3 level = from.seen - mu_s * place.up;
  const double across = glm::length(level), mu = disk.mu_s_effective;
  const glm::dvec3 to_centre =
      across > 0.0 ? mu * place.up + std::sqrt((1.0 - mu) * (1.0 + mu)) / across * level : place.up;
  const double share = disk.fraction * glm::dot(to_centre, facing);
  if (!(share > 0.0)) return Spectrum(lookup_.bands());
  return Checked((from.strength * static_cast<float>(share)) *
                 lookup_.Transmittance({altitude_m, mu, mu, 1.0}));
}

Spectrum SkyLight::SkyIrradiance(const LocalPoint& point, const Sunlight& sun,
                                 const Direction* normal) const {
  const CheckedSun from(sun);
  const AltitudeAndZenith place = AltitudeOf(point);
  const double mu_s = CosineBetween(from.for_air, place.up);
  if (normal == nullptr)
    return Checked(from.strength * lookup_.SkyIrradiance(place.altitude_m, mu_s));
  const glm::dvec3 facing = UnitVectorOf(*normal);
  const double mu = CosineBetween(facing, place.up);
  const double azimuth = lut::AzimuthCosineOrAhead(mu, mu_s, CosineBetween(facing, from.for_air));
  return Checked(from.strength * lookup_.multiple_scattering().Irradiance(
                                     std::max(place.altitude_m, 0.0), mu_s, mu, azimuth));
}

/// Writes the light of a ray into its place in the results of a batch.
void Put(const Spectrum& light, std::size_t ray, std::span<float> results) {
  std::ranges::copy(light.values(), results.subspan(ray * light.size()).begin());
}

/// Writes the light of each ray of a batch into its place.
/// @param light_of  returns the spectrum of a ray.
template <typename LightOf>
void Fill(std::size_t rays, std::span<float> results, const LightOf& light_of) {
  oneapi::tbb::parallel_for(std::size_t{0}, rays,
                            [&](std::size_t ray) { Put(light_of(ray), ray, results); });
}

void RequireSameLength(std::span<const float> first, std::span<const float> second) {
  if (first.size() == second.size()) return;
  throw InputError(
      fmt::format("the results have {} and {} values; they must have as many as each other",
                  first.size(), second.size()));
}

}  // namespace

Sky SkyParts::Made(const Atmosphere& atmosphere, lut::TableFolder tables) {
  return Sky(std::make_shared<const Sky::State>(
      Sky::State{atmosphere, lut::TableLookup(std::move(tables))}));
}

Sky::Sky(const Atmosphere& atmosphere, const ProgressFunction& progress)
    : Sky(SkyParts::Made(atmosphere, SolvedWithoutTables(atmosphere.medium(), progress))) {}

Sky::Sky(std::shared_ptr<const State> state) : state_(std::move(state)) {}

const Atmosphere& Sky::atmosphere() const { return state_->parameters; }

Spectrum Sky::Radiance(const LocalPoint& eye, const Direction& view, const Sunlight& sun) const {
  return SkyLight(state_->lookup).Radiance(eye, view, sun);
}

void Sky::Radiance(const OneOrMany<LocalPoint>& eyes, const OneOrMany<Direction>& views,
                   const OneOrMany<Sunlight>& suns, std::span<float> result) const {
  const std::size_t rays = RaysOf(result, state_->lookup.bands());
  RequireLength("eyes", eyes, rays);
  RequireLength("views", views, rays);
  RequireLength("suns", suns, rays);
  const SkyLight sky(state_->lookup);
  Fill(rays, result, [&](std::size_t i) { return sky.Radiance(eyes[i], views[i], suns[i]); });
}

Spectrum Sky::DiskRadiance(const LocalPoint& eye, const Direction& view,
                           const Sunlight& sun) const {
  return SkyLight(state_->lookup).DiskRadiance(eye, view, sun);
}

void Sky::DiskRadiance(const OneOrMany<LocalPoint>& eyes, const OneOrMany<Direction>& views,
                       const OneOrMany<Sunlight>& suns, std::span<float> result) const {
  const std::size_t rays = RaysOf(result, state_->lookup.bands());
  RequireLength("eyes", eyes, rays);
  RequireLength("views", views, rays);
  RequireLength("suns", suns, rays);
  const SkyLight sky(state_->lookup);
  Fill(rays, result, [&](std::size_t i) { return sky.DiskRadiance(eyes[i], views[i], suns[i]); });
}

Polarisation Sky::PolarisationOf(const LocalPoint& eye, const Direction& view,
                                 const Sunlight& sun) const {
  return SkyLight(state_->lookup).PolarisationOf(eye, view, sun);
}

void Sky::PolarisationOf(const OneOrMany<LocalPoint>& eyes, const OneOrMany<Direction>& views,
                         const OneOrMany<Sunlight>& suns, std::span<float> q,
                         std::span<float> u) const {
  const std::size_t rays = RaysOf(q, state_->lookup.bands());
  RequireLength("eyes", eyes, rays);
  RequireLength("views", views, rays);
  RequireLength("suns", suns, rays);
  const SkyLight sky(state_->lookup);
  RequireSameLength(q, u);
  oneapi::tbb::parallel_for(std::size_t{0}, rays, [&](std::size_t i) {
    const Polarisation light = sky.PolarisationOf(eyes[i], views[i], suns[i]);
    Put(light.q, i, q);
    Put(light.u, i, u);
  });
}

AirBetween Sky::Between(const LocalPoint& eye, const LocalPoint& object,
                        const Sunlight& sun) const {
  return SkyLight(state_->lookup).Between(eye, object, sun);
}

void Sky::Between(const OneOrMany<LocalPoint>& eyes, const OneOrMany<LocalPoint>& objects,
                  const OneOrMany<Sunlight>& suns, std::span<float> transmittance,
                  std::span<float> inscattered) const {
  const std::size_t rays = RaysOf(transmittance, state_->lookup.bands());
  RequireLength("eyes", eyes, rays);
  RequireLength("objects", objects, rays);
  RequireLength("suns", suns, rays);
  const SkyLight sky(state_->lookup);
  RequireSameLength(transmittance, inscattered);
  oneapi::tbb::parallel_for(std::size_t{0}, rays, [&](std::size_t i) {
    const AirBetween air = sky.Between(eyes[i], objects[i], suns[i]);
    Put(air.transmittance, i, transmittance);
    Put(air.inscattered, i, inscattered);
  });
}

Spectrum Sky::SunIrradiance(const LocalPoint& point, const Sunlight& sun) const {
  return SkyLight(state_->lookup).SunIrradiance(point, sun, nullptr);
}

Spectrum Sky::SunIrradiance(const LocalPoint& point, const Sunlight& sun,
                            const Direction& normal) const {
  return SkyLight(state_->lookup).SunIrradiance(point, sun, &normal);
}

void Sky::SunIrradiance(const OneOrMany<LocalPoint>& points, const OneOrMany<Sunlight>& suns,
                        const OneOrMany<Direction>& normals, std::span<float> result) const {
  const std::size_t rays = RaysOf(result, state_->lookup.bands());
  RequireLength("points", points, rays);
  RequireLength("suns", suns, rays);
  RequireLength("normals", normals, rays);
  const SkyLight sky(state_->lookup);
  Fill(rays, result,
       [&](std::size_t i) { return sky.SunIrradiance(points[i], suns[i], &normals[i]); });
}

Spectrum Sky::SkyIrradiance(const LocalPoint& point, const Sunlight& sun) const {
  return SkyLight(state_->lookup).SkyIrradiance(point, sun, nullptr);
}

Spectrum Sky::SkyIrradiance(const LocalPoint& point, const Sunlight& sun,
                            const Direction& normal) const {
  return SkyLight(state_->lookup).SkyIrradiance(point, sun, &normal);
}

void Sky::SkyIrradiance(const OneOrMany<LocalPoint>& points, const OneOrMany<Sunlight>& suns,
                        const OneOrMany<Direction>& normals, std::span<float> result) const {
  const std::size_t rays = RaysOf(result, state_->lookup.bands());
  RequireLength("points", points, rays);
  RequireLength("suns", suns, rays);
  RequireLength("normals", normals, rays);
  const SkyLight sky(state_->lookup);
  Fill(rays, result,
       [&](std::size_t i) { return sky.SkyIrradiance(points[i], suns[i], &normals[i]); });
}

}  // namespace alpenglow
