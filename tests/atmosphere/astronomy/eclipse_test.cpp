// SPDX-License-Identifier: MIT
#include "atmosphere/astronomy/sky_bodies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <span>
#include <vector>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "tests/fixtures/sanitized.h"

namespace alpenglow::atmosphere {
namespace {

constexpr double kWavelength_nm = 550.0;

// The reference solution sums chords of the sun's disk at right angles to the line of the centres,
// and cuts the moon's chord out of each. It uses no circle around the sun's centre and no angle.
double UncoveredByChords(const EclipsedDisk& disk, double wavelength_nm) {
  const auto clipped = [](double value, double most) { return std::clamp(value, -most, most); };
  const auto light_of_chord = [&](double x) {
    const double half = std::sqrt(std::max(1.0 - x * x, 0.0));
    const double from_moon = x - disk.separation;
    const double hidden =
        std::sqrt(std::max(disk.moon_radius * disk.moon_radius - from_moon * from_moon, 0.0));
    const std::array<double, 2> bounds{clipped(hidden, half), half};
    const auto radiance = [&](double y) {
      return std::vector<double>{2.0 * LimbDarkening(std::hypot(x, y), wavelength_nm) / kPi};
    };
    return bounds[1] > bounds[0] ? IntegrateAdaptively(radiance, 1, bounds, 1e-8).value
                                 : std::vector<double>{0.0};
  };
  std::vector<double> breaks{
      -1.0, disk.separation - disk.moon_radius, disk.separation + disk.moon_radius,
      (disk.separation * disk.separation + 1.0 - disk.moon_radius * disk.moon_radius) /
          std::max(2.0 * disk.separation, 1e-9),
      1.0};
  for (double& at : breaks) at = std::clamp(at, -1.0, 1.0);
  std::sort(breaks.begin(), breaks.end());
  return IntegrateAdaptively(light_of_chord, 1, breaks, 1e-7).value[0];
}

TEST(Eclipse, UncoveredLightIsTheIntegralOverAllChords) {
  constexpr std::array kRadii{1.04, 1.0, 0.93};
  for (const double radius : std::span(kRadii).first(tests::ScaledDown<std::size_t>(3, 1))) {
    for (const double separation : {0.0, 0.02, 0.05, 0.3, 0.9, 1.0, 1.3, 1.9}) {
      const EclipsedDisk disk{radius, separation};
      const double wavelength_nm = radius == 1.0 ? 700.0 : 400.0;
      EXPECT_NEAR(UncoveredLight(disk, wavelength_nm), UncoveredByChords(disk, wavelength_nm), 1e-6)
          << radius << " " << separation << ": the ends of the chords are square roots";
    }
  }
}

TEST(Eclipse, LightIsCompleteBeforeItAndAbsentInTotality) {
  EXPECT_EQ(UncoveredLight({1.04, 2.04}, kWavelength_nm), 1.0);
  EXPECT_EQ(UncoveredLight({1.04, 3.0}, kWavelength_nm), 1.0);
  EXPECT_EQ(UncoveredLight({1.04, 0.04}, kWavelength_nm), 0.0);
  EXPECT_EQ(UncoveredLight({1.04, 0.0}, kWavelength_nm), 0.0);
  EXPECT_EQ(EclipsedDisk({1.04, 2.04}).CoveredArea(), 0.0);
  EXPECT_EQ(EclipsedDisk({1.04, 0.03}).CoveredArea(), 1.0);
  EXPECT_EQ(EclipsedDisk({1.04, 3.0}).Magnitude(), 0.0);
  EXPECT_TRUE(EclipsedDisk({1.04, 0.03}).IsTotal());
  EXPECT_FALSE(EclipsedDisk({0.96, 0.0}).IsTotal()) << "annular";
}

TEST(Eclipse, LightFadesSmoothlyAndMonotonically) {
  double before = 1.0;
  for (double separation = 2.05; separation >= 0.0; separation -= 0.001) {
    const double now = UncoveredLight({1.04, separation}, kWavelength_nm);
    EXPECT_LE(now, before + 1e-12) << separation;
    EXPECT_LT(before - now, 1e-3) << "a chord of 2 radii, 1.3 times as bright as the mean, of pi";
    before = now;
  }
  EXPECT_EQ(before, 0.0);
}

// Near second contact the rims enclose segments of any thinness.
TEST(Eclipse, LastLightIsAccurateToOnePartInTenThousand) {
  constexpr double kRadius = 1.03;
  for (const double thread : {1e-2, 1e-3, 1e-4, 1e-5}) {
    const EclipsedDisk disk{kRadius, kRadius - 1.0 + thread};
    const double reference = UncoveredByChords(disk, kWavelength_nm);
    EXPECT_NEAR(UncoveredLight(disk, kWavelength_nm) / reference, 1.0, 1e-4) << thread;
  }
}

TEST(Eclipse, LastLightIsRed) {
  const EclipsedDisk thin{1.03, 0.08};
  EXPECT_GT(UncoveredLight(thin, 680.0), 1.2 * UncoveredLight(thin, 440.0))
      << "the limb is a third as bright as the centre in blue light, half in red";
  EXPECT_LT(UncoveredLight(thin, kWavelength_nm), 0.75 * (1.0 - thin.CoveredArea()))
      << "what is left is limb";
}

// The closed form is compared with points of a lattice on a disk without limb darkening.
TEST(Eclipse, CoveredAreaIsTheOverlapOfTwoCircles) {
  for (const EclipsedDisk disk : {EclipsedDisk{1.04, 0.5}, EclipsedDisk{0.95, 0.3},
                                  EclipsedDisk{1.0, 1.0}, EclipsedDisk{0.95, 0.01}}) {
    int of_sun = 0, of_both = 0;
    constexpr int kPoints = 1500;
    for (int i = 0; i < kPoints * kPoints; ++i) {
      const double x = (i % kPoints + 0.5) * 2.0 / kPoints - 1.0;
      const double y = (i / kPoints + 0.5) * 2.0 / kPoints - 1.0;
      if (std::hypot(x, y) > 1.0) continue;
      ++of_sun;
      if (std::hypot(x - disk.separation, y) < disk.moon_radius) ++of_both;
    }
    EXPECT_NEAR(disk.CoveredArea(), static_cast<double>(of_both) / of_sun, 2e-4)
        << "points on the rims";
  }
  EXPECT_NEAR(EclipsedDisk({1.0, 1.0}).CoveredArea(), 2.0 / 3.0 - std::sqrt(3.0) / (2.0 * kPi),
              1e-12);
  EXPECT_NEAR(EclipsedDisk({1.0, 1.0}).Magnitude(), 0.5, 1e-12);
}

struct City {
  const char* name;
  double latitude_deg, longitude_deg, height_m;
  bool is_total;
};

constexpr std::array<City, 9> kCities{{
    {"A Coruna", 43.3623, -8.4115, 20.0, true},
    {"Oviedo", 43.3619, -5.8494, 230.0, true},
    {"Leon", 42.5987, -5.5671, 840.0, true},
    {"Burgos", 42.3439, -3.6969, 860.0, true},
    {"Zaragoza", 41.6488, -0.8891, 210.0, true},
    {"Valencia", 39.4699, -0.3763, 15.0, true},
    {"Palma", 39.5696, 2.6502, 15.0, true},
    {"Madrid", 40.4168, -3.7038, 660.0, false},
    {"Sevilla", 37.3891, -5.9845, 10.0, false},
}};

/// Besselian elements as polynomials of hours from 18h TDT, 2026 August 12: Espenak and Meeus
/// (2006), Five Millennium Canon of Solar Eclipses, NASA/TP-2006-214141, from
/// eclipse.gsfc.nasa.gov; k is 0.272488 for the penumbra and 0.272281 for the umbra.
struct Elements {
  std::array<double, 4> x{0.4755140, 0.5189249, -0.0000773, -0.0000080};
  std::array<double, 4> y{0.7711830, -0.2301680, -0.0001246, 0.0000038};
  std::array<double, 4> d_deg{14.7966700, -0.0120650, -0.0000030, 0.0};
  std::array<double, 4> mu_deg{88.747787, 15.003090, 0.0, 0.0};
  std::array<double, 4> l1{0.5379550, 0.0000939, -0.0000121, 0.0};
  std::array<double, 4> l2{-0.0081420, 0.0000935, -0.0000121, 0.0};
  double tan_f1 = 0.0046141, tan_f2 = 0.0045911;
};

// The reference solution follows the shadow's cone in the plane through the earth's centre, as
// Bessel did.
class Besselian {
 public:
  Besselian(const City& city, double delta_t_s) : delta_t_s_(delta_t_s) {
    constexpr double kEquator_m = 6378137.0, kFlatness = 0.99664719;
    const double latitude = city.latitude_deg * kRadiansPerDegree;
    const double u = std::atan(kFlatness * std::tan(latitude));
    sine_ = kFlatness * std::sin(u) + city.height_m / kEquator_m * std::sin(latitude);
    cosine_ = std::cos(u) + city.height_m / kEquator_m * std::cos(latitude);
    longitude_deg_ = city.longitude_deg;
  }

  /// Returns the distance outside of the edge of penumbra (outer) or umbra [equatorial radii].
  /// @param hours  from 18h TDT.
  [[nodiscard]] double Outside(double hours, bool is_outer) const {
    const auto at = [&](const std::array<double, 4>& c) {
      return c[0] + hours * (c[1] + hours * (c[2] + hours * c[3]));
    };
    const double d = at(e_.d_deg) * kRadiansPerDegree;
    constexpr double kDegreesOfSecond = 0.00417807;  // of sidereal time
    const double angle =
        (at(e_.mu_deg) + longitude_deg_ - kDegreesOfSecond * delta_t_s_) * kRadiansPerDegree;
    const double xi = cosine_ * std::sin(angle);
    const double eta = sine_ * std::cos(d) - cosine_ * std::cos(angle) * std::sin(d);
    const double zeta = sine_ * std::sin(d) + cosine_ * std::cos(angle) * std::cos(d);
    const double radius =
        is_outer ? at(e_.l1) - zeta * e_.tan_f1 : std::abs(at(e_.l2) - zeta * e_.tan_f2);
    return std::hypot(at(e_.x) - xi, at(e_.y) - eta) - radius;
  }

  [[nodiscard]] UtcTime InstantAt(double hours) const {
    return AddSeconds(ParseInstant("2026-08-12T18:00:00Z"), hours * 3600.0 - delta_t_s_);
  }

  /// Returns the hours at which the place is deepest in the penumbra.
  [[nodiscard]] double Maximum() const {
    double best = 0.0;
    for (double hours = -1.0; hours < 2.0; hours += 1e-4) {
      if (Outside(hours, true) < Outside(best, true)) best = hours;
    }
    return best;
  }

  [[nodiscard]] UtcTime Contact(bool is_outer, double from, double to) const {
    return InstantAt(
        BracketedRoot([&](double hours) { return Outside(hours, is_outer); }, from, to, 1e-6));
  }

 private:
  Elements e_;
  double delta_t_s_, longitude_deg_, sine_, cosine_;
};

Place PlaceOf(const City& city) {
  return CheckedPlace({city.latitude_deg, city.longitude_deg, city.height_m});
}

const SolarEclipse& EclipseOf2026(std::size_t city) {
  static const auto eclipses = [] {
    std::array<SolarEclipse, kCities.size()> found;
    for (std::size_t i = 0; i < kCities.size(); ++i)
      found[i] =
          FindSolarEclipse(PlaceOf(kCities[i]), ParseInstant("2026-08-12T00:00:00Z"), 86400.0)
              .value();
    return found;
  }();
  return eclipses.at(city);
}

TEST(Eclipse, ContactsIn2026InSpainAgreeWithNasaWithin5Seconds) {
  double worst_s = 0.0;
  for (std::size_t i = 0; i < kCities.size(); ++i) {
    const SolarEclipse& eclipse = EclipseOf2026(i);
    EXPECT_NEAR(DeltaT(eclipse.maximum.instant), 69.184, 1e-9);
    const Besselian almanac(kCities[i], DeltaT(eclipse.maximum.instant));
    const double middle = almanac.Maximum();
    const auto compare = [&](const SolarEclipse::Moment& here, bool is_outer, double from,
                             double to) {
      const double late_s =
          SecondsBetween(almanac.Contact(is_outer, middle + from, middle + to), here.instant);
      EXPECT_NEAR(late_s, 0.0, 5.0) << kCities[i].name << ", " << (is_outer ? "outer" : "inner");
      worst_s = std::max(worst_s, std::abs(late_s));
    };
    compare(eclipse.first_contact, true, -3.0, 0.0);
    compare(eclipse.last_contact, true, 0.0, 3.0);
    ASSERT_EQ(eclipse.inner.has_value(), kCities[i].is_total) << kCities[i].name;
    if (!eclipse.inner) continue;
    compare(eclipse.inner->second_contact, false, -0.5, 0.0);
    compare(eclipse.inner->third_contact, false, 0.0, 0.5);
    EXPECT_TRUE(eclipse.maximum.disk.IsTotal()) << kCities[i].name;
  }
  RecordProperty("worst_s", std::to_string(worst_s));
}

TEST(Eclipse, MomentsAreInOrderAndTheMaximumIsDeepest) {
  for (std::size_t i = 0; i < kCities.size(); ++i) {
    const SolarEclipse& eclipse = EclipseOf2026(i);
    const auto after_s = [&](const SolarEclipse::Moment& moment) {
      return SecondsBetween(eclipse.first_contact.instant, moment.instant);
    };
    const double middle_s = after_s(eclipse.maximum);
    EXPECT_GT(middle_s, 0.0);
    EXPECT_GT(after_s(eclipse.last_contact), middle_s);
    if (eclipse.inner) {
      EXPECT_LT(after_s(eclipse.inner->second_contact), middle_s);
      EXPECT_GT(after_s(eclipse.inner->third_contact), middle_s);
    }
    for (const double aside_s : {-60.0, 60.0}) {
      const auto moment =
          EclipseAt(PlaceOf(kCities[i]), AddSeconds(eclipse.maximum.instant, aside_s));
      EXPECT_GT(moment.disk.separation, eclipse.maximum.disk.separation);
    }
    EXPECT_NEAR(eclipse.first_contact.disk.Magnitude(), 0.0, 5e-4)
        << "the radii of almanacs and ours: 0.6 arcseconds of 1900";
  }
}

// The moon's shadow passes Cape Town by that day.
TEST(Eclipse, IsAbsentOutsideTheShadowAndUnseenAtNight) {
  const UtcTime day = ParseInstant("2026-08-12T00:00:00Z");
  EXPECT_FALSE(FindSolarEclipse(Place{-33.9, 18.4, 0.0}, day, 86400.0));
  const SolarEclipse& in_madrid = EclipseOf2026(7);
  EXPECT_TRUE(in_madrid.first_contact.IsSeen());
  EXPECT_TRUE(in_madrid.maximum.IsSeen());
  EXPECT_FALSE(in_madrid.last_contact.IsSeen()) << "the sun sets before";
  EXPECT_FALSE(EclipseOf2026(6).last_contact.IsSeen()) << "and still earlier in Palma";
}

TEST(Eclipse, OtherNewMoonsOfTheYearMissTheSun) {
  // The search has three days about each new moon, which are 29.53 days apart within 0.6 days.
  const Place burgos = PlaceOf(kCities[3]);
  int eclipses = 0;
  for (int moon = -7; moon <= 4; ++moon) {
    const UtcTime start =
        AddSeconds(ParseInstant("2026-08-11T06:00:00Z"), moon * 29.530589 * 86400.0);
    const auto eclipse = FindSolarEclipse(burgos, start, 3.0 * 86400.0);
    if (!eclipse) continue;
    ++eclipses;
    EXPECT_EQ(FormatUtc(eclipse->maximum.instant).substr(0, 10), "2026-08-12");
  }
  EXPECT_EQ(eclipses, 1) << "that of 2026 February 17 is of the Antarctic";
}

// Annular eclipse of 2023 October 14 in Albuquerque: a ring for 4 min 48 s (Espenak, NASA), near
// the middle of the path.
TEST(Eclipse, AnAnnularEclipseLeavesARing) {
  const auto eclipse = FindSolarEclipse(Place{35.0844, -106.6504, 1620.0},
                                        ParseInstant("2023-10-14T06:00:00Z"), 86400.0);
  ASSERT_TRUE(eclipse);
  ASSERT_TRUE(eclipse->inner);
  EXPECT_FALSE(eclipse->maximum.disk.IsTotal());
  const double ring_s =
      SecondsBetween(eclipse->inner->second_contact.instant, eclipse->inner->third_contact.instant);
  EXPECT_NEAR(ring_s, 288.0, 5.0) << "that of 2026 errs by less";
  const double left = UncoveredLight(eclipse->maximum.disk, kWavelength_nm);
  EXPECT_GT(left, 0.03);
  EXPECT_LT(left, 1.0 - eclipse->maximum.disk.CoveredArea()) << "the rim is dark";
}

}  // namespace
}  // namespace alpenglow::atmosphere
