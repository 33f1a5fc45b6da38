// SPDX-License-Identifier: MIT
#include "atmosphere/astronomy/sky_bodies.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>

#include "atmosphere/base/error.h"
#include "atmosphere/base/names.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"

namespace alpenglow::atmosphere {
namespace {

constexpr double kHour_s = 3600.0;
constexpr double kTolerance_s = 0.01;

// Radii used by almanacs, see the header.
constexpr double kEarthEquator_m = 6378137.0;
constexpr double kMountains_m = 0.2725076 * kEarthEquator_m;
constexpr double kValleys_m = 0.272281 * kEarthEquator_m;
constexpr double kAuwers_rad = 959.63 / 3600.0 * kRadiansPerDegree;

double MuAt(double rho) { return std::sqrt(std::max((1.0 - rho) * (1.0 + rho), 0.0)); }
double RhoAt(double mu) { return std::sqrt(std::max((1.0 - mu) * (1.0 + mu), 0.0)); }

/// Returns the light of the disk between two circles around its centre, low < high, where `passed`
/// is the fraction of each circle that is not covered. The integral is over mu, as
/// 2 rho d rho = -2 mu d mu.
template <typename Passed>
double LightBetween(double low, double high, double wavelength_nm, const Passed& passed) {
  const GaussRule& rule = GaussLegendre(32);
  const double from = MuAt(high), width = MuAt(low) - from;
  double light = 0.0;
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    // This substitution makes the steps smaller towards both ends, where the arc cosine behaves
    // like a square root.
    const double t = rule.node[i], step = t * t * (3.0 - 2.0 * t);
    const double mu = from + width * step, rho = RhoAt(mu);
    light += rule.weight[i] * 6.0 * t * (1.0 - t) * width * 2.0 * mu *
             LimbDarkening(rho, wavelength_nm) * passed(rho);
  }
  return light;
}

double LightBetween(double low, double high, double wavelength_nm) {
  return LightBetween(low, high, wavelength_nm, [](double) { return 1.0; });
}

/// Returns the distance of the centres on the unit sphere.
double ChordBetween(const SunInSky& sun, const MoonPosition& moon) {
  return glm::length(EnuFromAngles(sun.elevation_rad(), sun.azimuth_rad()).xyz -
                     EnuFromAngles(moon.elevation_rad(), moon.azimuth_rad()).xyz);
}

/// Sun and moon at a place, some seconds after an instant.
class Pair {
 public:
  Pair(const Place& place, const UtcTime& from) : place_(place), from_(from) {}

  /// Returns the squared distance of the centres on the unit sphere.
  [[nodiscard]] double Chord2(double after_s) const {
    const double chord = ChordBetween(SunIn(after_s), MoonIn(after_s));
    return chord * chord;
  }

  /// Returns the distance of the centres minus their distance at a kind of contact [rad].
  [[nodiscard]] double OverContact(double after_s, bool is_outer) const {
    const SunInSky sun = SunIn(after_s);
    const MoonPosition moon = MoonIn(after_s);
    const double apart = ChordBetween(sun, moon);
    const double sun_rad = kAuwers_rad / sun.distance_au;
    const double moon_rad = std::asin((is_outer ? kMountains_m : kValleys_m) / moon.distance_m);
    const double contact = is_outer ? sun_rad + moon_rad : std::abs(sun_rad - moon_rad);
    return 2.0 * std::asin(std::min(0.5 * apart, 1.0)) - contact;
  }

  [[nodiscard]] SolarEclipse::Moment At(double after_s) const {
    return EclipseAt(place_, AddSeconds(from_, after_s));
  }

 private:
  [[nodiscard]] SunInSky SunIn(double after_s) const {
    return TrueSunAt(place_, AddSeconds(from_, after_s));
  }
  [[nodiscard]] MoonPosition MoonIn(double after_s) const {
    return TrueMoonAt(place_, AddSeconds(from_, after_s));
  }

  Place place_;
  UtcTime from_;
};

/// Returns the time of the least distance of the centres, if it is in [0, end).
std::optional<double> NearestTime(const Pair& pair, double end_s) {
  const auto parting = [&](double time_s) {
    constexpr double kStep_s = 1.0;
    return pair.Chord2(time_s + kStep_s) - pair.Chord2(time_s - kStep_s);
  };
  for (double time_s = 0.0; time_s < end_s; time_s += kHour_s) {
    const double next_s = std::min(time_s + kHour_s, end_s);
    if (parting(time_s) > 0.0 || parting(next_s) <= 0.0) continue;
    return BracketedRoot(parting, time_s, next_s, kTolerance_s);
  }
  return std::nullopt;
}

/// Raises a body, a SunInSky or MoonPosition, by refraction.
template <typename Body>
Body Lifted(Body body, double height_m, const BendingAir& air) {
  const double true_rad = body.elevation_rad();
  const double lift_rad = RefractionFromHeight(air, true_rad, height_m);
  body.lower_for_air_deg = (lift_rad - LiftForAir(air, true_rad)) / kRadiansPerDegree;
  body.elevation_deg += lift_rad / kRadiansPerDegree;
  return body;
}

}  // namespace

double EclipsedDisk::Magnitude() const {
  return std::max(0.5 * (1.0 + moon_radius - separation), 0.0);
}

double EclipsedDisk::CoveredArea() const {
  const double p = moon_radius, z = separation;
  if (!IsCovered()) return 0.0;
  if (z <= std::abs(1.0 - p)) return std::min(p * p, 1.0);
  // The area consists of two circular segments over the common chord, each a sector minus a
  // triangle.
  const double at_sun = std::acos(std::clamp((z * z + 1.0 - p * p) / (2.0 * z), -1.0, 1.0));
  const double at_moon = std::acos(std::clamp((z * z + p * p - 1.0) / (2.0 * z * p), -1.0, 1.0));
  return (at_sun - 0.5 * std::sin(2.0 * at_sun) +
          p * p * (at_moon - 0.5 * std::sin(2.0 * at_moon))) /
         kPi;
}

EclipsedDisk EclipsedDiskOf(const SunInSky& sun, const MoonPosition& moon) {
  const double chord = ChordBetween(sun, moon);
  return {moon.angular_radius_deg / sun.angular_radius_deg,
          2.0 * std::asin(std::min(0.5 * chord, 1.0)) / sun.angular_radius_rad()};
}

double UncoveredLight(const EclipsedDisk& disk, double wavelength_nm) {
  const double p = disk.moon_radius, z = disk.separation;
  if (!disk.IsCovered()) return 1.0;
  if (disk.IsTotal()) return 0.0;
  const double first = std::abs(z - p), last = std::min(z + p, 1.0);
  const auto passed = [&](double rho) {
    const double cosine = (z * z + rho * rho - p * p) / (2.0 * z * rho);
    return 1.0 - std::acos(std::clamp(cosine, -1.0, 1.0)) / kPi;
  };
  double light = LightBetween(last, 1.0, wavelength_nm);
  if (last > first) light += LightBetween(first, last, wavelength_nm, passed);
  if (z > p) light += LightBetween(0.0, first, wavelength_nm);
  return std::min(light, 1.0);
}

SolarEclipse::Moment EclipseAt(const Place& place, const UtcTime& instant) {
  const SunInSky sun = TrueSunAt(place, instant);
  const double horizon_rad =
      SeaHorizonFrom(place.height_m, OsculatingRadius(kWgs84, place.latitude_rad()))
          .true_elevation_rad;
  return {instant, EclipsedDiskOf(sun, TrueMoonAt(place, instant)),
          sun.elevation_rad() + sun.angular_radius_rad() - horizon_rad};
}

std::optional<SolarEclipse> FindSolarEclipse(const Place& place, const UtcTime& from,
                                             double within_s) {
  const Pair pair(place, from);
  // The moon moves away from the sun by 13 degrees a day, and parallax adds one degree.
  constexpr double kChordOfTwoDays = 0.5;
  if (pair.Chord2(0.5 * within_s) > kChordOfTwoDays * kChordOfTwoDays) return std::nullopt;
  const std::optional<double> nearest_s = NearestTime(pair, within_s);
  if (!nearest_s || pair.OverContact(*nearest_s, true) >= 0.0) return std::nullopt;
  const auto contact = [&](bool is_outer, double far_s) {
    const auto over = [&](double time_s) { return pair.OverContact(time_s, is_outer); };
    return pair.At(BracketedRoot(over, std::min(*nearest_s, far_s), std::max(*nearest_s, far_s),
                                 kTolerance_s));
  };
  constexpr double kLongest_s = 4.0 * kHour_s;  // from an outer contact to the maximum
  const double begin_s = *nearest_s - kLongest_s, end_s = *nearest_s + kLongest_s;
  SolarEclipse eclipse{contact(true, begin_s), pair.At(*nearest_s), contact(true, end_s),
                       std::nullopt};
  if (pair.OverContact(*nearest_s, false) < 0.0)
    eclipse.inner = {contact(false, begin_s), contact(false, end_s)};
  return eclipse;
}

std::optional<EclipseEvent> EclipseEventFromName(std::string_view name) {
  constexpr EnumNames kNames{{std::pair{EclipseEvent::kFirstContact, "first-contact"},
                              {EclipseEvent::kSecondContact, "second-contact"},
                              {EclipseEvent::kMaximum, "eclipse-maximum"},
                              {EclipseEvent::kThirdContact, "third-contact"},
                              {EclipseEvent::kLastContact, "last-contact"}}};
  return kNames.Find(name);
}

std::optional<UtcTime> InstantOf(EclipseEvent event, const SolarEclipse& eclipse) {
  const bool has_inner = eclipse.inner.has_value();
  switch (event) {
    case EclipseEvent::kFirstContact:
      return eclipse.first_contact.instant;
    case EclipseEvent::kSecondContact:
      return has_inner ? std::optional(eclipse.inner->second_contact.instant) : std::nullopt;
    case EclipseEvent::kMaximum:
      return eclipse.maximum.instant;
    case EclipseEvent::kThirdContact:
      return has_inner ? std::optional(eclipse.inner->third_contact.instant) : std::nullopt;
    case EclipseEvent::kLastContact:
      return eclipse.last_contact.instant;
  }
  throw InternalError("unknown event of an eclipse");
}

SunInSky Refracted(const SunInSky& sun, double height_m, const BendingAir& air) {
  return Lifted(sun, height_m, air);
}

MoonPosition Refracted(const MoonPosition& moon, double height_m, const BendingAir& air) {
  return Lifted(moon, height_m, air);
}

double SkyBodies::CoveredLight() const {
  constexpr double kWavelength_nm = 550.0;
  return 1.0 - UncoveredLight(Eclipse(), kWavelength_nm);
}

MoonDisk SkyBodies::ApparentMoonDisk(const BendingAir& air) const {
  const MoonPosition seen = Refracted(moon, place.height_m, air);
  const LocalFrame frame(kWgs84, place);
  return MoonDiskOf(seen, DirectionOf(seen), frame.EnuFromEcef(seen.to_sun).xyz, sun.distance_au);
}

SkyBodies SkyBodiesAt(const Place& place, const UtcTime& instant) {
  return {place, instant, TrueSunAt(place, instant), TrueMoonAt(place, instant)};
}

}  // namespace alpenglow::atmosphere
