// SPDX-License-Identifier: MIT
#include "atmosphere/astronomy/moon.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "atmosphere/astronomy/ephemeris.h"
#include "atmosphere/astronomy/ephemeris_tables.h"
#include "atmosphere/astronomy/sky_bodies.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/base/error.h"
#include "atmosphere/base/names.h"
#include "atmosphere/math/angles.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/refraction/refraction.h"

namespace alpenglow::atmosphere {
namespace {

struct Filter {
  double wavelength_nm;
  std::array<double, 4> a;
  std::array<double, 3> d;
};

// The filters, out of 32, that lie near the smooth curve through all.
constexpr std::array<Filter, 9> kFilters{{
    {350.0, {-2.67511, -1.78539, 0.50612, -0.25578}, {0.34185, 0.01441, -0.01602}},
    {412.3, {-2.34185, -1.74337, 0.42156, -0.21512}, {0.36591, -0.05902, 0.00080}},
    {441.6, {-2.31964, -1.72114, 0.37286, -0.19304}, {0.37935, -0.09562, 0.00970}},
    {486.9, {-2.23351, -1.68573, 0.37632, -0.19877}, {0.36590, -0.08945, 0.00678}},
    {553.8, {-2.12504, -1.65970, 0.38409, -0.20655}, {0.37206, -0.10745, 0.00347}},
    {665.1, {-1.88914, -1.58096, 0.30477, -0.17908}, {0.37141, -0.13514, 0.01248}},
    {745.3, {-1.86896, -1.57522, 0.33712, -0.19415}, {0.36888, -0.14828, 0.00958}},
    {865.3, {-1.74561, -1.58482, 0.35009, -0.19569}, {0.39200, -0.18837, 0.00978}},
    {1059.5, {-1.59323, -1.71358, 0.50599, -0.25178}, {0.48160, -0.29486, 0.00116}},
}};

double LogReflectance(const Filter& filter, double angle_rad) {
  const auto& [a, d] = std::pair{filter.a, filter.d};
  const double degrees = angle_rad / kRadiansPerDegree;
  return a[0] + angle_rad * (a[1] + angle_rad * (a[2] + angle_rad * a[3])) +
         d[0] * std::exp(-degrees / 4.06054) + d[1] * std::exp(-degrees / 12.8802) +
         d[2] * std::cos((degrees + 30.5858) / 16.7498);
}

// Returns the geometric state of the moon; bodies move about the barycentre.
BodyState MoonOf(const BodyState& earth, const UtcTime& instant, double delta_t_s) {
  const BodyState moon = TabulatedMoonFromEarth(TerrestrialTimeAt(instant, delta_t_s));
  return {earth.position_au + moon.position_au,
          earth.velocity_au_per_day + moon.velocity_au_per_day};
}

constexpr double kStep_s = 1200.0;
constexpr double kMoonTolerance_s = 0.01;
constexpr int kSteps = static_cast<int>(30.0 * kSecondsPerDay / kStep_s);

/// Elevation of the upper limb above the sea horizon [rad], some seconds after an instant.
class LimbOverHorizon {
 public:
  LimbOverHorizon(const Place& place, const UtcTime& from)
      : place_(place),
        from_(from),
        horizon_rad_(SeaHorizonFrom(place.height_m, OsculatingRadius(kWgs84, place.latitude_rad()))
                         .true_elevation_rad) {}

  double operator()(double after_s) const {
    const MoonPosition moon = TrueMoonAt(place_, AddSeconds(from_, after_s));
    return moon.elevation_rad() + moon.angular_radius_rad() - horizon_rad_;
  }

 private:
  Place place_;
  UtcTime from_;
  double horizon_rad_;
};

struct Sample {
  double time_s, value;
  [[nodiscard]] bool IsAbove() const { return value >= 0.0; }
};

/// Returns the extremum of the parabola through three samples at uniform steps; the time of the
/// middle sample if there is none.
double TurnOf(const Sample& before, const Sample& here, const Sample& after) {
  const double bend = before.value - 2.0 * here.value + after.value;
  const double steps = bend != 0.0 ? 0.5 * (before.value - after.value) / bend : 0.0;
  return here.time_s + steps * kStep_s;
}

/// Returns the samples of the step that follows `here`. If the moon only just rises or sets, both
/// events may be in one step, near the highest or lowest point of its path; the parabola finds this
/// point within seconds, and it is added as a sample.
std::vector<Sample> SamplesOfStep(const LimbOverHorizon& limb, const Sample& before,
                                  const Sample& here) {
  const double end_s = here.time_s + kStep_s;
  const Sample next{end_s, limb(end_s)};
  const double turn_s = TurnOf(before, here, next);
  if (here.IsAbove() != next.IsAbove() || !(turn_s > here.time_s && turn_s < end_s))
    return {here, next};
  return {here, {turn_s, limb(turn_s)}, next};
}

std::optional<UtcTime> NextChange(const Place& place, const UtcTime& after, bool rising) {
  const LimbOverHorizon limb(place, after);
  Sample before{-kStep_s, limb(-kStep_s)}, here{0.0, limb(0.0)};
  for (int step = 0; step < kSteps; ++step) {
    const std::vector<Sample> samples = SamplesOfStep(limb, before, here);
    for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
      if (samples[i].IsAbove() == rising || samples[i + 1].IsAbove() != rising) continue;
      return AddSeconds(
          after, BracketedRoot(limb, samples[i].time_s, samples[i + 1].time_s, kMoonTolerance_s));
    }
    before = here;
    here = samples.back();
  }
  return std::nullopt;
}

constexpr double kWavelength_nm = 550.0;

// Returns the light of a Lommel-Seeliger sphere, relative to full phase:
// 1 - sin(a/2) tan(a/2) ln cot(a/4).
double SpherePhase(double angle_rad) {
  if (angle_rad < 1e-6) return 1.0;
  const double half = 0.5 * angle_rad;
  return 1.0 + std::sin(half) * std::tan(half) * std::log(std::tan(0.5 * half));
}

// Returns the irradiance of earthlight at the moon, relative to that of sunlight there.
double EarthIrradiance(const MoonPosition& moon) {
  constexpr double kGeometricAlbedo = 0.37;
  const double angle = kPi - moon.phase_angle_rad();
  const double share = kEarthMeanRadius_m / moon.distance_m;
  return kGeometricAlbedo * share * share * (std::sin(angle) + (kPi - angle) * std::cos(angle)) /
         kPi;
}

// Returns the irradiance of sunlight at the moon, relative to that at the earth.
double SunlightAt(const MoonPosition& moon, double earth_sun_au) {
  const double inverse_depth = earth_sun_au / moon.sun_distance_au;
  return inverse_depth * inverse_depth;
}

}  // namespace

double MoonReflectance(double phase_angle_rad, double wavelength_nm) {
  constexpr double kLast_rad = 150.0 * kRadiansPerDegree;
  const double angle_rad = std::min(phase_angle_rad, kLast_rad);
  const auto above = std::find_if(kFilters.begin() + 1, kFilters.end() - 1, [&](const Filter& f) {
    return f.wavelength_nm >= wavelength_nm;
  });
  const auto below = above - 1;
  const double share = std::clamp(
      (wavelength_nm - below->wavelength_nm) / (above->wavelength_nm - below->wavelength_nm), 0.0,
      1.0);
  return (1.0 - share) * std::exp(LogReflectance(*below, angle_rad)) +
         share * std::exp(LogReflectance(*above, angle_rad));
}

MoonPosition TrueMoonAt(const Place& place, const UtcTime& instant) {
  return TrueMoonAt(place, instant, DeltaT(instant));
}

MoonPosition TrueMoonAt(const Place& place, const UtcTime& instant, double delta_t_s) {
  const EarthAndSun bodies = EarthAndSunAt(instant, delta_t_s);
  const BodyState moon = MoonOf(bodies.earth, instant, delta_t_s);
  const glm::dmat3 ecef_from_gcrs = EcefFromGcrs(instant, delta_t_s);
  const ApparentPlace seen = SeenFrom(place, ecef_from_gcrs, bodies, moon);
  const glm::dvec3 sun_au = bodies.sun.position_au - moon.position_au;
  const Vector<Ecef> to_sun{glm::normalize(ecef_from_gcrs * sun_au)};
  // This is the geometric vector, without light time about the barycentre: the observer moves along
  // with the moon.
  const glm::dvec3 from_centre_m =
      ecef_from_gcrs * (moon.position_au - bodies.earth.position_au) * kAstronomicalUnit_m;
  const double distance_m = glm::length(from_centre_m - EcefFromGeodetic(kWgs84, place).xyz);
  const double phase_angle_rad = AngleBetween(to_sun.xyz, -seen.direction.xyz);
  MoonPosition position{{}, to_sun};
  position.elevation_deg = seen.elevation_rad / kRadiansPerDegree;
  position.azimuth_deg = seen.azimuth_rad / kRadiansPerDegree;
  position.distance_m = distance_m;
  position.angular_radius_deg = std::asin(kMoonRadius_m / distance_m) / kRadiansPerDegree;
  position.phase_angle_deg = phase_angle_rad / kRadiansPerDegree;
  position.illuminated_fraction = 0.5 * (1.0 + std::cos(phase_angle_rad));
  position.sun_distance_au = glm::length(sun_au);
  return position;
}

MoonPosition ApparentMoonAt(const Place& place, const UtcTime& instant, const BendingAir& air) {
  return Refracted(TrueMoonAt(place, instant), place.height_m, air);
}

LightDirection DirectionOf(const MoonPosition& apparent) {
  const double for_air_deg = apparent.elevation_deg - apparent.lower_for_air_deg;
  return {EnuFromAngles(apparent.elevation_rad(), apparent.azimuth_rad()).xyz,
          EnuFromAngles(for_air_deg * kRadiansPerDegree, apparent.azimuth_rad()).xyz};
}

std::optional<UtcTime> NextMoonrise(const Place& place, const UtcTime& after) {
  return NextChange(place, after, true);
}

std::optional<UtcTime> NextMoonset(const Place& place, const UtcTime& after) {
  return NextChange(place, after, false);
}

UtcTime NextMoonTransit(const Place& place, const UtcTime& after) {
  const auto hour_angle = [&](double after_s) {
    const glm::dvec3 moon = EcefTowards(TrueMoonAt(place, AddSeconds(after, after_s)), place).xyz;
    return std::remainder(place.longitude_rad() - std::atan2(moon.y, moon.x), 2.0 * kPi);
  };
  // The hour angle increases, except for the jump from half a turn to minus half a turn at the
  // lower transit.
  double low_s = 0.0, low = hour_angle(low_s);
  while (true) {
    const double high_s = low_s + kStep_s, high = hour_angle(high_s);
    if (low < 0.0 && high >= 0.0) {
      return AddSeconds(after, BracketedRoot(hour_angle, low_s, high_s, kMoonTolerance_s));
    }
    low_s = high_s;
    low = high;
  }
}

std::optional<MoonEvent> MoonEventFromName(std::string_view name) {
  constexpr EnumNames kNames{{std::pair{MoonEvent::kMoonrise, "moonrise"},
                              {MoonEvent::kMoonset, "moonset"},
                              {MoonEvent::kMoonTransit, "moon-transit"}}};
  return kNames.Find(name);
}

std::optional<UtcTime> NextMoonEvent(MoonEvent event, const Place& place, const UtcTime& after) {
  switch (event) {
    case MoonEvent::kMoonrise:
      return NextMoonrise(place, after);
    case MoonEvent::kMoonset:
      return NextMoonset(place, after);
    case MoonEvent::kMoonTransit:
      return NextMoonTransit(place, after);
  }
  throw InternalError("unknown event of the moon");
}

MoonDisk MoonDiskOf(const MoonPosition& moon, const LightDirection& direction,
                    const glm::dvec3& to_sun, double earth_sun_au) {
  constexpr double kLastMeasured_rad = 150.0 * kRadiansPerDegree;
  const double angle_rad = std::min(moon.phase_angle_rad(), kLastMeasured_rad);
  const double sunlight = SunlightAt(moon, earth_sun_au);
  const double seen = MoonReflectance(angle_rad, kWavelength_nm) / kPi;
  const double earthlit = MoonReflectance(0.0, kWavelength_nm) / kPi;
  return {direction, to_sun, moon.angular_radius_rad(),
          2.0 * sunlight * seen / SpherePhase(angle_rad),
          sunlight * EarthIrradiance(moon) * earthlit};
}

double MoonIrradiance(const MoonPosition& moon, double earth_sun_au, double wavelength_nm) {
  const double sine = std::sin(moon.angular_radius_rad());
  return sine * sine * SunlightAt(moon, earth_sun_au) *
         MoonReflectance(moon.phase_angle_rad(), wavelength_nm);
}

double MoonRadiance(const MoonDisk& moon, const glm::dvec3& direction) {
  const glm::dvec3& to_moon = moon.direction.seen;
  if (glm::dot(direction, to_moon) <= 0.0) return 0.0;
  // Position on the disk, in radii; over half a degree, rays can be treated as parallel.
  const glm::dvec3 beside = direction - to_moon;
  const glm::dvec3 at = (beside - glm::dot(beside, to_moon) * to_moon) / std::sin(moon.radius_rad);
  const double squared = glm::dot(at, at);
  if (squared >= 1.0) return 0.0;
  const double mu_seen = std::sqrt(1.0 - squared);
  const double mu_lit = glm::dot(at - mu_seen * to_moon, moon.to_sun);
  return moon.radiance_per_irradiance * shared::LommelSeeliger(mu_lit, mu_seen) +
         moon.earthshine_per_irradiance;
}

}  // namespace alpenglow::atmosphere
