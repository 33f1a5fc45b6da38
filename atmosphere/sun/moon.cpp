// SPDX-License-Identifier: MIT
#include "atmosphere/sun/moon.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "atmosphere/number/constants.h"
#include "atmosphere/number/root.h"
#include "atmosphere/sun/apparent_place.h"
#include "atmosphere/sun/moon_orbit.h"
#include "atmosphere/sun/refraction.h"
#include "atmosphere/text/error.h"

namespace alpenglow::atmosphere {
namespace {

// Geometric, as bodies move about the barycentre.
BodyState MoonOf(const BodyState& earth, const UtcInstant& instant, double delta_t_s) {
  const BodyState moon = MoonFromEarth(TerrestrialTimeAt(instant, delta_t_s));
  return {earth.position_au + moon.position_au,
          earth.velocity_au_per_day + moon.velocity_au_per_day};
}

/// Position angle on the sky of a direction, seen from another: from north over east.
double PositionAngle(const glm::dvec3& of, const glm::dvec3& at) {
  const glm::dvec3 pole(0.0, 0.0, 1.0);
  const glm::dvec3 east = glm::cross(pole, at);
  const glm::dvec3 north = glm::cross(at, east);
  const double angle = std::atan2(glm::dot(of, east), glm::dot(of, north));
  return angle < 0.0 ? angle + 2.0 * kPi : angle;
}

double AngleBetween(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

constexpr double kStep_s = 1200.0;
constexpr double kMoonTolerance_s = 0.01;
constexpr int kSteps = static_cast<int>(30.0 * kSecondsPerDay / kStep_s);

/// How far the upper limb stands over the sea horizon [rad], some seconds after an instant.
class LimbOverHorizon {
 public:
  LimbOverHorizon(const GeodeticPosition& place, const UtcInstant& from)
      : place_(place),
        from_(from),
        horizon_rad_(SeaHorizonFrom(place.height_m, OsculatingRadius(kWgs84, place.latitude_rad))
                         .true_elevation_rad) {}

  double operator()(double after_s) const {
    const MoonPosition moon = MoonAt(place_, AddSeconds(from_, after_s));
    return moon.elevation_rad + moon.angular_radius_rad - horizon_rad_;
  }

 private:
  GeodeticPosition place_;
  UtcInstant from_;
  double horizon_rad_;
};

struct Sample {
  double time_s, value;
  [[nodiscard]] bool IsAbove() const { return value >= 0.0; }
};

/// Where the parabola through three samples at even steps turns; the middle one if it does not.
double TurnOf(const Sample& before, const Sample& here, const Sample& after) {
  const double bend = before.value - 2.0 * here.value + after.value;
  const double steps = bend != 0.0 ? 0.5 * (before.value - after.value) / bend : 0.0;
  return here.time_s + steps * kStep_s;
}

/// Samples of the step that follows `here`. Where the moon only just rises or sets, both may fall
/// into one step, beside the highest or lowest place of its path, which the parabola finds within
/// seconds.
std::vector<Sample> SamplesOfStep(const LimbOverHorizon& limb, const Sample& before,
                                  const Sample& here) {
  const double end_s = here.time_s + kStep_s;
  const Sample next{end_s, limb(end_s)};
  const double turn_s = TurnOf(before, here, next);
  if (here.IsAbove() != next.IsAbove() || !(turn_s > here.time_s && turn_s < end_s))
    return {here, next};
  return {here, {turn_s, limb(turn_s)}, next};
}

std::optional<UtcInstant> NextChange(const GeodeticPosition& place, const UtcInstant& after,
                                     bool rising) {
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

}  // namespace

double MoonPosition::IlluminatedFraction() const { return 0.5 * (1.0 + std::cos(phase_angle_rad)); }

MoonPosition MoonAt(const GeodeticPosition& place, const UtcInstant& instant) {
  return MoonAt(place, instant, DeltaT(instant));
}

MoonPosition MoonAt(const GeodeticPosition& place, const UtcInstant& instant, double delta_t_s) {
  const EarthAndSun bodies = EarthAndSunAt(instant, delta_t_s);
  const BodyState moon = MoonOf(bodies.earth, instant, delta_t_s);
  const glm::dmat3 ecef_from_gcrs = EcefFromGcrs(instant, delta_t_s);
  const ApparentPlace seen = SeenFrom(place, ecef_from_gcrs, bodies, moon);
  const glm::dvec3 sun_au = bodies.sun.position_au - moon.position_au;
  const Vector<Ecef> to_sun{glm::normalize(ecef_from_gcrs * sun_au)};
  // Not the way of the light about the barycentre: the observer flies along with the moon.
  const glm::dvec3 from_centre_m =
      ecef_from_gcrs * (moon.position_au - bodies.earth.position_au) * kAstronomicalUnit_m;
  const double distance_m = glm::length(from_centre_m - EcefFromGeodetic(kWgs84, place).xyz);
  return {seen.elevation_rad,
          seen.azimuth_rad,
          distance_m,
          std::asin(kMoonRadius_m / distance_m),
          seen.direction,
          to_sun,
          glm::length(sun_au),
          AngleBetween(to_sun.xyz, -seen.direction.xyz),
          PositionAngle(to_sun.xyz, seen.direction.xyz)};
}

MoonPosition ApparentMoonAt(const GeodeticPosition& place, const UtcInstant& instant) {
  return ApparentMoonAt(place, instant, AlmanacAir());
}

MoonPosition ApparentMoonAt(const GeodeticPosition& place, const UtcInstant& instant,
                            const BendingAir& air) {
  MoonPosition moon = MoonAt(place, instant);
  const double lift_rad = RefractionFromHeight(air, moon.elevation_rad, place.height_m);
  moon.lower_for_air_rad = lift_rad - LiftForAir(air, moon.elevation_rad);
  moon.elevation_rad += lift_rad;
  return moon;
}

std::optional<UtcInstant> NextMoonrise(const GeodeticPosition& place, const UtcInstant& after) {
  return NextChange(place, after, true);
}

std::optional<UtcInstant> NextMoonset(const GeodeticPosition& place, const UtcInstant& after) {
  return NextChange(place, after, false);
}

UtcInstant NextMoonTransit(const GeodeticPosition& place, const UtcInstant& after) {
  const auto hour_angle = [&](double after_s) {
    const glm::dvec3 moon = MoonAt(place, AddSeconds(after, after_s)).direction.xyz;
    return WrappedLongitude(place.longitude_rad - std::atan2(moon.y, moon.x));
  };
  // It grows but where it jumps, at the lower transit, from half a turn to minus that.
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
  if (name == "moonrise") return MoonEvent::kMoonrise;
  if (name == "moonset") return MoonEvent::kMoonset;
  if (name == "moon-transit") return MoonEvent::kMoonTransit;
  return std::nullopt;
}

std::optional<UtcInstant> NextMoonEvent(MoonEvent event, const GeodeticPosition& place,
                                        const UtcInstant& after) {
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

}  // namespace alpenglow::atmosphere
