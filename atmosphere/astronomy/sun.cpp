// SPDX-License-Identifier: MIT
// Times of events of the sun: a function of time is sampled every hour of the local mean solar
// day, its extrema are refined where they could hide a crossing, and each change of sign is
// located.
#include "atmosphere/astronomy/sun.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "atmosphere/astronomy/ephemeris.h"
#include "atmosphere/astronomy/sky_bodies.h"
#include "atmosphere/base/error.h"
#include "atmosphere/base/names.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/refraction/refraction.h"

namespace alpenglow::atmosphere {

SunInSky TrueSunAt(const Place& place, const UtcTime& instant) {
  return TrueSunAt(place, instant, DeltaT(instant));
}

SunInSky TrueSunAt(const Place& place, const UtcTime& instant, double delta_t_s) {
  const auto [bodies, ecef_from_gcrs] = TurnedEarthAt(instant, delta_t_s);
  const ApparentPlace sun = SeenFrom(place, ecef_from_gcrs, bodies, bodies.sun);
  const double radius_rad = std::asin(kSunRadius_m / (sun.distance_au * kAstronomicalUnit_m));
  return {sun.elevation_rad / kRadiansPerDegree, sun.azimuth_rad / kRadiansPerDegree,
          sun.distance_au, radius_rad / kRadiansPerDegree};
}

SunInSky SunForAir(const SunInSky& seen) {
  SunInSky sun = seen;
  sun.elevation_deg = std::clamp(seen.elevation_deg - seen.lower_for_air_deg, -90.0, 90.0);
  sun.lower_for_air_deg = 0.0;
  return sun;
}

SunInSky ApparentSunAt(const Place& place, const UtcTime& instant) {
  return ApparentSunAt(place, instant, AlmanacAir());
}

SunInSky ApparentSunAt(const Place& place, const UtcTime& instant, const BendingAir& air) {
  return Refracted(TrueSunAt(place, instant), place.height_m, air);
}

Vector<Enu> EnuFromAngles(double elevation_rad, double azimuth_rad) {
  const double horizontal = std::cos(elevation_rad);
  return {{horizontal * std::sin(azimuth_rad), horizontal * std::cos(azimuth_rad),
           std::sin(elevation_rad)}};
}

LightDirection DirectionOf(const SunInSky& apparent) {
  const SunInSky for_air = SunForAir(apparent);
  return {EnuFromAngles(apparent.elevation_rad(), apparent.azimuth_rad()).xyz,
          EnuFromAngles(for_air.elevation_rad(), for_air.azimuth_rad()).xyz};
}

VisibleDisk DiskOverHorizon(double mu_s, double horizon_mu, double radius_rad) {
  const double elevation = std::asin(std::clamp(mu_s, -1.0, 1.0));
  const double horizon = std::asin(std::clamp(horizon_mu, -1.0, 1.0));
  const double x = (elevation - horizon) / radius_rad;  // centre above horizon, in radii
  if (x >= 1.0) return {1.0, mu_s};
  if (x <= -1.0) return {0.0, mu_s};
  // The visible part is a segment of the unit disk above the chord at distance x below its centre.
  const double chord = std::sqrt(1.0 - x * x);
  const double area = kPi - std::acos(x) + x * chord;
  const double centroid = 2.0 / 3.0 * chord * chord * chord / area;  // above the disk's centre
  return {area / kPi, std::sin(elevation + centroid * radius_rad)};
}

double DiskSolidAngle(double radius_rad) {
  const double half_sine = std::sin(0.5 * radius_rad);
  return 4.0 * kPi * half_sine * half_sine;
}

double LimbDarkening(double rho) { return shared::SunLimbDarkening(rho); }

double LimbDarkening(double rho, double wavelength_nm) {
  return shared::SunLimbDarkeningAt(rho, wavelength_nm / 1000.0);
}

// With u = 0.6 the fraction of light outside of the circle is mu^2 (1 + mu) / 2: a cubic, solved by
// Newton's method from above, where it is convex. For small mu each step only halves mu, but the
// root is then negligible in 1 - mu^2.
double CircleOfLight(double share) {
  const double twice = 2.0 * std::clamp(1.0 - share, 0.0, 1.0);
  double mu = 1.0;
  for (int i = 0; i < 12; ++i) {
    const double above = mu * mu * (1.0 + mu) - twice;
    if (above <= 1e-12) break;
    mu -= above / (mu * (2.0 + 3.0 * mu));
  }
  return std::sqrt(std::max(1.0 - mu * mu, 0.0));
}

namespace {

constexpr double kEventStep_s = 3600.0;
constexpr int kEventSteps = 24;
constexpr double kEventTolerance_s = 0.01;

constexpr EnumNames kSunEvents{{
    std::pair{SunEvent::kNoon, "noon"},
    {SunEvent::kSunrise, "sunrise"},
    {SunEvent::kSunset, "sunset"},
    {SunEvent::kCivilDawn, "civil-dawn"},
    {SunEvent::kCivilDusk, "civil-dusk"},
    {SunEvent::kNauticalDawn, "nautical-dawn"},
    {SunEvent::kNauticalDusk, "nautical-dusk"},
    {SunEvent::kAstronomicalDawn, "astronomical-dawn"},
    {SunEvent::kAstronomicalDusk, "astronomical-dusk"},
}};

/// The crossing that defines an event: elevation, limb or centre, and direction.
struct Crossing {
  double true_elevation_rad;
  bool of_upper_limb;
  bool rising;
};

/// Returns the crossing of every event except noon.
Crossing CrossingOf(SunEvent event, const Place& place) {
  const auto twilight = [](double degrees, bool rising) {
    return Crossing{degrees * kRadiansPerDegree, false, rising};
  };
  switch (event) {
    case SunEvent::kCivilDawn:
      return twilight(-6.0, true);
    case SunEvent::kCivilDusk:
      return twilight(-6.0, false);
    case SunEvent::kNauticalDawn:
      return twilight(-12.0, true);
    case SunEvent::kNauticalDusk:
      return twilight(-12.0, false);
    case SunEvent::kAstronomicalDawn:
      return twilight(-18.0, true);
    case SunEvent::kAstronomicalDusk:
      return twilight(-18.0, false);
    default:
      break;
  }
  const double radius_m = OsculatingRadius(kWgs84, place.latitude_rad());
  return {SeaHorizonFrom(place.height_m, radius_m).true_elevation_rad, true,
          event == SunEvent::kSunrise};
}

/// Returns the elevation of the sun above the elevation of a crossing [rad].
double HeightOver(const Crossing& crossing, const Place& place, const UtcTime& instant) {
  const SunInSky sun = TrueSunAt(place, instant);
  const double limb_rad = crossing.of_upper_limb ? sun.angular_radius_rad() : 0.0;
  return sun.elevation_rad() + limb_rad - crossing.true_elevation_rad;
}

struct EventSample {
  double time_s, value;
  [[nodiscard]] bool IsAbove() const { return value >= 0.0; }
};

/// Returns the largest (or least) value of f between two times, by golden-section search; stops as
/// soon as the value has the other sign.
template <typename Function>
EventSample Extremum(const Function& f, double low_s, double high_s, bool largest) {
  const double ratio = 0.5 * (std::sqrt(5.0) - 1.0);
  const double sign = largest ? 1.0 : -1.0;
  EventSample left{high_s - ratio * (high_s - low_s), 0.0};
  EventSample right{low_s + ratio * (high_s - low_s), 0.0};
  left.value = f(left.time_s);
  right.value = f(right.time_s);
  while (high_s - low_s > 0.5) {
    if (left.IsAbove() == largest) return left;
    if (right.IsAbove() == largest) return right;
    if (sign * left.value > sign * right.value) {
      high_s = right.time_s;
      right = left;
      left.time_s = high_s - ratio * (high_s - low_s);
      left.value = f(left.time_s);
    } else {
      low_s = left.time_s;
      left = right;
      right.time_s = low_s + ratio * (high_s - low_s);
      right.value = f(right.time_s);
    }
  }
  return sign * left.value > sign * right.value ? left : right;
}

/// Returns samples from an hour before the day to an hour after it, ascending, dense
/// enough that the sign changes at most once between two.
template <typename Function>
std::vector<EventSample> Samples(const Function& f) {
  std::vector<EventSample> regular;
  for (int i = -1; i <= kEventSteps + 1; ++i)
    regular.push_back({i * kEventStep_s, f(i * kEventStep_s)});
  std::vector<EventSample> all = regular;
  for (std::size_t i = 1; i + 1 < regular.size(); ++i) {
    const EventSample& before = regular[i - 1];
    const EventSample& here = regular[i];
    const EventSample& after = regular[i + 1];
    const bool is_peak = here.value >= before.value && here.value >= after.value;
    const bool is_trough = here.value <= before.value && here.value <= after.value;
    const bool could_hide = is_peak ? !here.IsAbove() : is_trough && here.IsAbove();
    if (could_hide) all.push_back(Extremum(f, before.time_s, after.time_s, is_peak));
  }
  std::sort(all.begin(), all.end(),
            [](const EventSample& a, const EventSample& b) { return a.time_s < b.time_s; });
  return all;
}

/// Returns the first time in [0, one day) at which f changes its sign in the given direction.
template <typename Function>
std::optional<double> FirstChange(const Function& f, bool rising) {
  const std::vector<EventSample> samples = Samples(f);
  for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
    if (samples[i].IsAbove() == rising || samples[i + 1].IsAbove() != rising) continue;
    const double time_s =
        BracketedRoot(f, samples[i].time_s, samples[i + 1].time_s, kEventTolerance_s);
    if (time_s >= 0.0 && time_s < kSecondsPerDay) return time_s;
  }
  return std::nullopt;
}

/// The sun's hour angle passes 0 within 17 minutes of mean noon (equation of time).
double NoonOf(const Place& place, const UtcTime& midnight) {
  const auto hour_angle = [&](double time_s) {
    const glm::dvec3 sun = EcefTowards(TrueSunAt(place, AddSeconds(midnight, time_s)), place).xyz;
    return std::remainder(place.longitude_rad() - std::atan2(sun.y, sun.x), 2.0 * kPi);
  };
  constexpr double kReach_s = 1800.0;
  return BracketedRoot(hour_angle, 0.5 * kSecondsPerDay - kReach_s, 0.5 * kSecondsPerDay + kReach_s,
                       kEventTolerance_s);
}

}  // namespace

std::optional<SunEvent> SunEventFromName(std::string_view name) { return kSunEvents.Find(name); }

std::optional<UtcTime> FindSunEvent(SunEvent event, const Place& place, const UtcTime& around) {
  const Place wrapped = WithWrappedLongitude(place);
  const UtcTime midnight = MeanSolarMidnight(wrapped, around);
  if (event == SunEvent::kNoon) return AddSeconds(midnight, NoonOf(wrapped, midnight));
  const Crossing crossing = CrossingOf(event, wrapped);
  const auto height_over_crossing = [&](double time_s) {
    return HeightOver(crossing, wrapped, AddSeconds(midnight, time_s));
  };
  const std::optional<double> time_s = FirstChange(height_over_crossing, crossing.rising);
  if (!time_s) return std::nullopt;
  return AddSeconds(midnight, *time_s);
}

bool IsAboveEvent(SunEvent event, const Place& place, const UtcTime& instant) {
  if (event == SunEvent::kNoon) throw InternalError("noon is not at a height of the sun");
  return HeightOver(CrossingOf(event, place), place, instant) >= 0.0;
}

}  // namespace alpenglow::atmosphere
