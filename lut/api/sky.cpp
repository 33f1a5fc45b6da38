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

#include "atmosphere/base/finite.h"
#include "lut/api/conversions.h"
#include "lut/api/sky_parts.h"
#include "lut/multiple_scattering/successive_orders.h"
#include "lut/version.h"

namespace alpenglow {

using atmosphere::ViewRay;

std::string_view Version() { return version::kRelease; }

glm::dvec3 UnitVectorOf(const Direction& direction) {
  const glm::dvec3 vector{direction.east, direction.north, direction.up};
  // The squares of very long and of very short directions have no double.
  const double largest = std::max({std::abs(vector.x), std::abs(vector.y), std::abs(vector.z)});
  if (!(largest > 0.0 && std::isfinite(vector.x) && std::isfinite(vector.y) &&
        std::isfinite(vector.z))) {
    throw InputError(fmt::format(
        "a direction is (east {}, north {}, up {}); it must be finite and longer than 0", vector.x,
        vector.y, vector.z));
  }
  return glm::normalize(vector / largest);
}

AltitudeAndZenith AltitudeOf(const LocalPoint& point, double planet_radius_m) {
  const glm::dvec3 from_centre{point.east_m, point.north_m, planet_radius_m + point.up_m};
  const double radius_m = glm::length(from_centre);
  const double across2 = point.east_m * point.east_m + point.north_m * point.north_m;
  // A point beside or behind the planet has no digits to lose, and z is no divisor for it.
  const double altitude_m = from_centre.z > 0.0 ? point.up_m + across2 / (radius_m + from_centre.z)
                                                : radius_m - planet_radius_m;
  constexpr double kHighest_m = 1e12;
  if (!(altitude_m >= -0.5 * planet_radius_m && altitude_m <= kHighest_m)) {
    throw InputError(fmt::format(
        "a point (east_m {}, north_m {}, up_m {}) has an altitude of {} m; it must lie in [{}, {}]",
        point.east_m, point.north_m, point.up_m, altitude_m, -0.5 * planet_radius_m, kHighest_m));
  }
  return {altitude_m, from_centre / radius_m};
}

double CosineBetween(const glm::dvec3& a, const glm::dvec3& b) {
  return std::clamp(glm::dot(a, b), -1.0, 1.0);
}

ViewRay RayFrom(const AltitudeAndZenith& eye, const glm::dvec3& view, const glm::dvec3& to_sun,
                double length_m) {
  return {eye.altitude_m,
          CosineBetween(view, eye.up),
          CosineBetween(to_sun, eye.up),
          CosineBetween(view, to_sun),
          length_m,
          true};
}

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

/// Rays from one eye under one sun.
class RaysFrom {
 public:
  RaysFrom(const Sky& sky, const LocalPoint& eye, const Direction& to_sun)
      : planet_radius_m_(sky.atmosphere().planet_radius_m()),
        lookup_(SkyParts::LookupOf(sky)),
        eye_{eye.east_m, eye.north_m, eye.up_m},
        place_(AltitudeOf(eye, planet_radius_m_)),
        to_sun_(UnitVectorOf(to_sun)) {}

  [[nodiscard]] Spectrum Radiance(const Direction& view) const {
    return Checked(lookup_.InscatterOfAllOrders(RayFrom(place_, UnitVectorOf(view), to_sun_)));
  }

  [[nodiscard]] AirBetween Between(const LocalPoint& object) const {
    static_cast<void>(AltitudeOf(object, planet_radius_m_));  // checks it
    const glm::dvec3 way = glm::dvec3{object.east_m, object.north_m, object.up_m} - eye_;
    const double length_m = glm::length(way);
    const glm::dvec3 view = length_m > 0.0 ? way / length_m : place_.up;
    const ViewRay ray = RayFrom(place_, view, to_sun_, length_m);
    const atmosphere::SingleScattering<float>& air = lookup_.single_scattering();
    const auto samples = air.Sample(
        ray, {.nodes = lookup_.tables().ray_nodes, .split_ozone = false, .dark_samples = true});
    Spectrum light = air.Inscatter(air.Scatter(samples), ray.nu);
    const Spectrum more =
        lookup_.multiple_scattering().InscatterAlong(samples, ray.nu, lut::SegmentEnd::kOpaque);
    for (std::size_t band = 0; band < light.size(); ++band) light[band] += more[band];
    return {Checked(air.TransmittanceAlong(ray)), Checked(light)};
  }

 private:
  double planet_radius_m_;
  const lut::TableLookup& lookup_;
  glm::dvec3 eye_;
  AltitudeAndZenith place_;
  glm::dvec3 to_sun_;
};

}  // namespace

Sky SkyParts::Made(const Atmosphere& atmosphere, lut::TableFolder tables) {
  return Sky(std::make_shared<const Sky::State>(
      Sky::State{atmosphere, lut::TableLookup(std::move(tables))}));
}

Sky::Sky(const Atmosphere& atmosphere, const ProgressFunction& progress)
    : Sky(SkyParts::Made(atmosphere, SolvedWithoutTables(atmosphere.medium(), progress))) {}

Sky::Sky(std::shared_ptr<const State> state) : state_(std::move(state)) {}

const Atmosphere& Sky::atmosphere() const { return state_->parameters; }

Spectrum Sky::Radiance(const LocalPoint& eye, const Direction& view,
                       const Direction& to_sun) const {
  return RaysFrom(*this, eye, to_sun).Radiance(view);
}

std::vector<Spectrum> Sky::Radiance(const LocalPoint& eye, std::span<const Direction> views,
                                    const Direction& to_sun) const {
  const RaysFrom rays(*this, eye, to_sun);
  std::vector<Spectrum> result(views.size());
  tbb::parallel_for(std::size_t{0}, views.size(),
                    [&](std::size_t i) { result[i] = rays.Radiance(views[i]); });
  return result;
}

AirBetween Sky::Between(const LocalPoint& eye, const LocalPoint& object,
                        const Direction& to_sun) const {
  return RaysFrom(*this, eye, to_sun).Between(object);
}

void Sky::Between(const LocalPoint& eye, std::span<const LocalPoint> objects,
                  const Direction& to_sun, std::span<AirBetween> result) const {
  if (result.size() != objects.size()) {
    throw InputError("the results must be as many as the objects");
  }
  const RaysFrom rays(*this, eye, to_sun);
  tbb::parallel_for(std::size_t{0}, objects.size(),
                    [&](std::size_t i) { result[i] = rays.Between(objects[i]); });
}

std::vector<AirBetween> Sky::Between(const LocalPoint& eye, std::span<const LocalPoint> objects,
                                     const Direction& to_sun) const {
  std::vector<AirBetween> result(objects.size());
  Between(eye, objects, to_sun, result);
  return result;
}

Spectrum Sky::SunIrradiance(const LocalPoint& point, const Direction& to_sun) const {
  const AltitudeAndZenith place = AltitudeOf(point, atmosphere().planet_radius_m());
  return Checked(state_->lookup.SunIrradiance(place.altitude_m,
                                              CosineBetween(UnitVectorOf(to_sun), place.up)));
}

Spectrum Sky::SkyIrradiance(const LocalPoint& point, const Direction& to_sun) const {
  const AltitudeAndZenith place = AltitudeOf(point, atmosphere().planet_radius_m());
  return Checked(state_->lookup.SkyIrradiance(place.altitude_m,
                                              CosineBetween(UnitVectorOf(to_sun), place.up)));
}

}  // namespace alpenglow
