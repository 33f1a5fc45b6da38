// SPDX-License-Identifier: MIT
#include "atmosphere/refraction/refraction.h"

#include <erfa.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/refraction/observer_refraction.h"
#include "atmosphere/refraction/refracted_view.h"
#include "tests/fixtures/refracted_twilight.h"

namespace alpenglow::atmosphere {
namespace {

constexpr double kDegree = kRadiansPerDegree;
constexpr double kMinute = kRadiansPerDegree / 60.0;
constexpr double kArcsecond_rad = kRadiansPerDegree / 3600.0;

/// Returns the refraction in the air of almanacs.
double AlmanacRefraction(double true_elevation_rad, double height_m) {
  return RefractionFromHeight(AlmanacAir(), true_elevation_rad, height_m);
}

TEST(Refraction, Is34ArcminutesAtTheHorizon) {
  EXPECT_NEAR(RefractionOfRay(0.0, 0.0) / kMinute, 34.0, 0.001) << "the scale height is chosen so";
  EXPECT_NEAR(AlmanacRefraction(-34.0 * kMinute, 0.0) / kMinute, 34.0, 0.001);
}

TEST(Refraction, InverseIsTheRayFromTheGround) {
  for (double apparent = 0.0; apparent < 90.0; apparent += apparent < 5.0 ? 0.05 : 0.5) {
    const double ray = RefractionOfRay(apparent * kDegree, 0.0);
    const double elevation = apparent * kDegree - ray;
    EXPECT_NEAR(AlmanacRefraction(elevation, 0.0), ray, 1e-11) << apparent;
  }
}

TEST(Refraction, AgreesWithErfaFarFromTheHorizon) {
  double a = 0.0;
  double b = 0.0;
  eraRefco(1013.25, 15.0, 0.0, 0.55, &a, &b);
  for (double zenith = 0.0; zenith <= 75.0; zenith += 5.0) {
    const double tangent = std::tan(zenith * kDegree);
    const double series = a * tangent + b * tangent * tangent * tangent;
    const double elevation = (90.0 - zenith) * kDegree - series;
    EXPECT_NEAR(AlmanacRefraction(elevation, 0.0) / kArcsecond_rad, series / kArcsecond_rad, 0.5)
        << zenith;
  }
}

// Bennett, G. G. (1982), J. Navigation 35, 255-259, scaled to 15 C and 1013.25 hPa.
double Bennett(double apparent_degrees) {
  const double angle = apparent_degrees + 7.31 / (apparent_degrees + 4.4);
  return kMinute / std::tan(angle * kDegree) * (1013.25 / 1010.0) * (283.15 / 288.15);
}

TEST(Refraction, AgreesWithBennettNearTheHorizon) {
  for (double apparent = 0.0; apparent < 20.0; apparent += 0.25) {
    const double bennett = Bennett(apparent);
    EXPECT_NEAR(AlmanacRefraction(apparent * kDegree - bennett, 0.0) / kMinute, bennett / kMinute,
                0.35)
        << "at apparent " << apparent << " degrees; models of the air differ by 1 %";
  }
}

/// Returns the ratio of density to that at sea level in the U.S. Standard Atmosphere 1976 up to 32
/// km.
double StandardDensity(double height_m) {
  const double h = height_m * 6356766.0 / (6356766.0 + height_m);
  const double rho_11 = std::pow(216.65 / 288.15, 4.255876);
  if (h < 11000.0) return std::pow(1.0 - 0.0065 * h / 288.15, 4.255876);
  const double rho_20 = rho_11 * std::exp(-9000.0 / 6341.62);
  if (h < 20000.0) return rho_11 * std::exp(-(h - 11000.0) / 6341.62);
  return rho_20 * std::pow(1.0 + (h - 20000.0) / 216650.0, -35.163195);
}

/// Returns the bending along a ray by its definition, tan(psi) d ln n, with h = s^2 against the
/// singularity of the horizontal ray. This shares nothing with the library.
double RayThroughStandardAtmosphere(double apparent_rad, double eye_m = 0.0) {
  const double radius = 6371008.7714;
  const double n0 = 2.7782e-4;
  const double at_eye = 1.0 + n0 * StandardDensity(eye_m);
  const double invariant = at_eye * (radius + eye_m) * std::cos(apparent_rad);
  const int steps = 20000;
  const double width = std::sqrt(80e3 - eye_m) / steps;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double s = (i + 0.5) * width;
    const double height = eye_m + s * s;
    const double index = 1.0 + n0 * StandardDensity(height);
    const double slope = n0 * (StandardDensity(height + 1.0) - StandardDensity(height - 1.0)) / 2.0;
    const double q = index * (radius + height);
    sum -=
        slope / index * invariant / std::sqrt((q - invariant) * (q + invariant)) * 2.0 * s * width;
  }
  return sum;
}

TEST(Refraction, AgreesWithTheStandardAtmosphere) {
  for (const double apparent : {0.0, 0.25, 0.5, 1.0, 2.0, 5.0, 10.0, 45.0}) {
    EXPECT_NEAR(RefractionOfRay(apparent * kDegree, 0.0) / kMinute,
                RayThroughStandardAtmosphere(apparent * kDegree) / kMinute, 1.0)
        << "its lapse rate gives 33.0' at the horizon, almanacs count 34'";
  }
}

/// Returns the bending to space by the integral over the elevation, in many parts: dense where the
/// ray is low, and where thin layers take a small part of it.
double BendingInParts(const BendingAir& air, double elevation_rad, double height_m) {
  const RefractedRay ray(air, elevation_rad, height_m);
  const double exit_rad = ray.ElevationAt(air.top_m);
  const auto rising = [&](double low_rad, double high_rad) {
    constexpr int kParts = 60;
    double sum = 0.0;
    for (int i = 0; i < kParts; ++i) {
      const auto at = [&](int part) {
        const double share = static_cast<double>(part) / kParts;
        return low_rad + (high_rad - low_rad) * share * share * share;
      };
      sum += ray.Bending(at(i), at(i + 1));
    }
    return sum;
  };
  const bool is_inside = height_m < air.top_m;
  if (elevation_rad >= 0.0) return is_inside ? rising(elevation_rad, exit_rad) : 0.0;
  return rising(0.0, exit_rad) + rising(0.0, is_inside ? -elevation_rad : exit_rad);
}

/// Returns air of the earth, of a small and of a large planet, and with a thin layer at the ground.
std::vector<BendingAir> DifferentAirs() {
  const auto layers = [](double height_m, double thin_share, double thin_m) {
    return RefractivityLayers{{{1.0 - thin_share, height_m}, {thin_share, thin_m}, {0.0, 1.0}}};
  };
  return {AlmanacAir(),
          AlmanacAir(6.4e6),
          {2.8e-4, layers(8000.0, 0.0, 1.0), 60e3, 6.36e6},
          {2.8e-4, layers(8000.0, 0.15, 500.0), 120e3, 6.4e6},
          {4e-6, layers(11100.0, 0.0, 1.0), 80e3, 3.39e6},
          {2e-3, layers(34000.0, 0.0, 1.0), 1.4e6, 1.1e7},
          {1.5e-3, layers(28000.0, 0.0, 1.0), 1.05e6, 7e5},
          {0.0, layers(8000.0, 0.0, 1.0), 60e3, 6.36e6}};
}

// The bound of observer_refraction.h.
TEST(ObserverRefraction, IsTheIntegralOverTheElevation) {
  for (const BendingAir& air : DifferentAirs()) {
    ASSERT_TRUE(GentlyBends(air));
    const double most = 2e-6 * BendingInParts(air, 0.0, 0.0) + 1e-15;
    for (const double share : {0.0, 1e-4, 0.03, 0.3, 0.99, 1.5, 40.0}) {
      const double height_m = share * air.top_m;
      const ObserverRefraction table(air, height_m);
      for (const double over : {0.0, 1e-5, 1e-3, 0.02, 0.3, 1.2}) {
        const double seen = table.horizon_rad() + over;
        EXPECT_NEAR(table.SeenAt(seen), BendingInParts(air, seen, height_m), most)
            << air.planet_radius_m << " m, from " << height_m << " m, " << over << " up";
      }
    }
  }
}

TEST(ObserverRefraction, InverseFindsTheRay) {
  for (const BendingAir& air : DifferentAirs()) {
    for (const double share : {0.0, 1e-4, 0.03, 0.3, 1.5}) {
      const ObserverRefraction table(air, share * air.top_m);
      for (const double over : {1e-6, 1e-3, 0.02, 0.3, 1.2}) {
        const double seen = table.horizon_rad() + over;
        const auto found = table.ApparentElevationOf(seen - table.SeenAt(seen));
        ASSERT_TRUE(found);
        EXPECT_NEAR(*found, seen, 1e-10) << air.planet_radius_m << " " << share << " " << over;
      }
      EXPECT_FALSE(table.ApparentElevationOf(table.horizon_rad() - table.on_horizon_rad() - 1e-6));
    }
  }
}

// Tables are kept from call to call: an answer must not depend on the calls before it.
TEST(ObserverRefraction, ResultsDoNotDependOnEarlierCalls) {
  const double alone = ObserverRefraction(AlmanacAir(), 1234.0).AtTrue(0.01);
  for (int i = 0; i < 3; ++i) {
    for (const BendingAir& air : DifferentAirs()) (void)RefractionFromHeight(air, 0.01, 1234.0 + i);
    EXPECT_EQ(AlmanacRefraction(0.01, 1234.0), alone);
  }
}

// Saemundsson, T. (1986), Sky and Telescope 72, 70, of a true elevation, at 10 C and 1010 hPa.
double Saemundsson(double true_degrees) {
  const double angle = true_degrees + 10.3 / (true_degrees + 5.11);
  return 1.02 * kMinute / std::tan(angle * kDegree) * (1013.25 / 1010.0) * (283.15 / 288.15);
}

TEST(Refraction, OfTrueElevationsAgreesWithSaemundsson) {
  for (double elevation = -0.5; elevation < 20.0; elevation += 0.25) {
    EXPECT_NEAR(AlmanacRefraction(elevation * kDegree, 0.0) / kMinute,
                Saemundsson(elevation) / kMinute, 0.35)
        << elevation << " degrees; the formula is said to agree with Bennett's to 0.1'";
  }
}

TEST(Refraction, OfEarthPresetsAgreesWithAlmanacs) {
  for (const char* preset : {"earth", "clear-mountain", "hazy"}) {
    const BendingAir air = GentleAirOf(MediumPreset(preset));
    EXPECT_NEAR(RefractionSeenAt(air, 0.0, 0.0) / kMinute, 34.0, 0.5) << preset;
    for (const double height_m : {0.0, 1e3, 3e3, 10e3}) {
      const double horizon = GrazingElevation(air, height_m);
      EXPECT_NEAR(-horizon / kMinute, SeaHorizonFrom(height_m).dip_rad / kMinute, 0.02);
      for (const double over : {0.0, 0.1, 0.5, 1.0, 3.0, 10.0, 30.0}) {
        const double apparent = horizon + over * kDegree;
        EXPECT_NEAR(RefractionSeenAt(air, apparent, height_m) / kMinute,
                    RefractionOfRay(apparent, height_m) / kMinute, 0.02)
            << preset << " from " << height_m << " m, " << over
            << " degrees over the horizon; densities of molecules differ by 1e-4";
      }
    }
  }
}

TEST(Refraction, FromHeightsAgreesWithTheStandardAtmosphere) {
  for (const double height_m : {1e3, 3e3, 10e3}) {
    for (const double apparent : {0.0, 0.5, 1.0, 3.0, 10.0}) {
      EXPECT_NEAR(RefractionOfRay(apparent * kDegree, height_m) / kMinute,
                  RayThroughStandardAtmosphere(apparent * kDegree, height_m) / kMinute, 0.7)
          << "0.6' as kAlmanacLayers says, and 0.1' of other refractivities; " << height_m << " m, "
          << apparent << " degrees";
    }
  }
}

TEST(Refraction, DipOfTheSeaAgreesWithTheNauticalAlmanac) {
  // Bowditch (2017), American Practical Navigator, table 14: dip 1.76' sqrt(height in metres).
  for (const double height : {2.0, 10.0, 100.0, 1000.0, 4000.0}) {
    EXPECT_NEAR(SeaHorizonFrom(height).dip_rad / (1.76 * std::sqrt(height) * kMinute), 1.0, 0.02)
        << height << " m; terrestrial refraction varies by more from day to day";
  }
  EXPECT_EQ(SeaHorizonFrom(0.0).dip_rad, 0.0);
  EXPECT_EQ(SeaHorizonFrom(-430.0).dip_rad, 0.0) << "the shore of the Dead Sea";
}

TEST(Refraction, SunsetFromAMountainAgreesWithTheAlmanac) {
  // Explanatory Supplement to the Astronomical Almanac (1992), section 9.31: rise and set at
  // zenith distance 90 degrees 50' + 2.12' sqrt(height in metres).
  for (const double height : {10.0, 100.0, 1000.0, 3776.0}) {
    const double depression = -SeaHorizonFrom(height).true_elevation_rad / kMinute;
    EXPECT_NEAR(depression, 34.0 + 2.12 * std::sqrt(height), 0.02 * depression) << height << " m";
  }
}

TEST(Refraction, LiftsTheHorizonFromSpaceByTwiceTheRefraction) {
  const double height = 400e3;
  const SeaHorizon horizon = SeaHorizonFrom(height);
  const double geometric = std::acos(kEarthMeanRadius_m / (kEarthMeanRadius_m + height));
  EXPECT_NEAR(horizon.dip_rad, geometric, 0.3 * kDegree) << "n r instead of r at the ground";
  EXPECT_NEAR((-horizon.dip_rad - horizon.true_elevation_rad) / kMinute, 68.0, 0.01);
  EXPECT_EQ(AlmanacRefraction(0.0, height), 0.0) << "this ray never meets the air";
}

TEST(Refraction, IsContinuousAndMonotonicFromAnyHeight) {
  for (const double height : {0.0, 2.0, 900.0, 3776.0, 11e3, 400e3, 36e6}) {
    const SeaHorizon horizon = SeaHorizonFrom(height);
    const double horizon_deg = horizon.true_elevation_rad / kDegree;
    double at = -90.0, before = 0.0;
    for (double elevation = -90.0; elevation <= 90.0;
         elevation += std::abs(elevation - horizon_deg) < 6.0 ? 0.05 : 0.5) {
      const double refraction = AlmanacRefraction(elevation * kDegree, height);
      EXPECT_GE(refraction, 0.0);
      EXPECT_LE(refraction, 69.0 * kMinute);
      if (elevation > -90.0) {
        EXPECT_GT(elevation * kDegree + refraction, at * kDegree + before) << elevation;
      }
      EXPECT_NEAR(refraction, before, (elevation - at) * kDegree + 1e-15)
          << height << " m, " << elevation
          << " degrees: what keeps the order loses less than the body climbs, from far out nearly "
             "so";
      at = elevation;
      before = refraction;
    }
    EXPECT_NEAR(AlmanacRefraction(horizon.true_elevation_rad + 1e-9, height),
                -horizon.dip_rad - horizon.true_elevation_rad, 1e-8)
        << "on the horizon";
  }
}

TEST(ApparentSun, IsHigherByTheRefractionAtTheEye) {
  const UtcTime evening = ParseInstant("2026-06-21T18:50:00Z");
  for (const double height_m : {0.0, 10e3}) {
    const Place eye = CheckedPlace({47.0, 8.0, height_m});
    const SunInSky sun = TrueSunAt(eye, evening), apparent = ApparentSunAt(eye, evening);
    EXPECT_EQ(
        apparent.elevation_deg,
        sun.elevation_deg + AlmanacRefraction(sun.elevation_rad(), height_m) / kRadiansPerDegree);
    EXPECT_GT(apparent.elevation_deg, sun.elevation_deg);
    EXPECT_EQ(apparent.azimuth_deg, sun.azimuth_deg);
  }
}

// The sun that lights the air by straight rays is compared with light of bent rays.
constexpr std::array kViews{std::array{90.0, 0.0}, std::array{45.0, 0.0}, std::array{45.0, 180.0},
                            std::array{5.0, 0.0}, std::array{20.0, 90.0}};

glm::dvec3 Towards(double elevation_deg, double azimuth_deg) {
  return EnuFromAngles(elevation_deg * kRadiansPerDegree, azimuth_deg * kRadiansPerDegree).xyz;
}

using Bands = std::array<double, 3>;

/// The air of the earth in three colours. Errors of straight rays are relative to bent rays by the
/// same 120 steps, which therefore leave nothing in them.
const tests::RefractedTwilight& Evening() {
  static const tests::RefractedTwilight air(MediumPreset("earth", {450.0, 550.0, 650.0}), 0.0, 120);
  return air;
}

/// Has the light of views under a sun, by bent rays.
class RefractedSky {
 public:
  explicit RefractedSky(double truly_deg) : truly_deg_(truly_deg) {
    for (const auto& [elevation, azimuth] : kViews)
      refracted_.push_back(
          Evening().Radiance(Towards(elevation, azimuth), Towards(truly_deg, 0.0), true));
  }

  /// Relative errors of straight rays from a lifted sun, over the views.
  struct Errors {
    Bands worst{};
    double rms = 0.0;  // of all bands
  };
  [[nodiscard]] Errors ErrorsOf(double lift_rad) const {
    Errors errors;
    const glm::dvec3 sun = Towards(truly_deg_ + lift_rad / kRadiansPerDegree, 0.0);
    for (std::size_t view = 0; view < kViews.size(); ++view) {
      const auto lifted = Evening().Radiance(Towards(kViews[view][0], kViews[view][1]), sun, false);
      for (std::size_t band = 0; band < 3; ++band) {
        const double error = lifted[band] / refracted_[view][band] - 1.0;
        errors.worst[band] = std::max(errors.worst[band], std::abs(error));
        errors.rms += error * error / static_cast<double>(3 * kViews.size());
      }
    }
    errors.rms = std::sqrt(errors.rms);
    return errors;
  }

 private:
  double truly_deg_;
  std::vector<tests::BandValues> refracted_;
};

double LiftAt(double truly_deg) {
  return LiftForAir(Evening().air(), truly_deg * kRadiansPerDegree);
}

TEST(LiftForAir, GivesAnEveningSkyTheLightOfRefractedRays) {
  for (const double truly_deg : {1.0, -1.5, -3.0}) {
    const RefractedSky::Errors errors = RefractedSky(truly_deg).ErrorsOf(LiftAt(truly_deg));
    // One lift serves all colours and views: low in the west light comes through lower air.
    EXPECT_LT(errors.rms, 0.06) << truly_deg;
    for (const double worst : errors.worst) EXPECT_LT(worst, 0.15) << truly_deg;
  }
}

TEST(LiftForAir, IsBetterForAirThanTheApparentRefraction) {
  const RefractedSky sky(-1.0);
  const double seen = RefractionFromHeight(Evening().air(), -kRadiansPerDegree, 0.0);
  EXPECT_LT(sky.ErrorsOf(LiftAt(-1.0)).rms, 0.4 * sky.ErrorsOf(seen).rms)
      << "from where it is seen, the sun lights the air by a third too much";
}

TEST(LiftForAir, ImprovesDuskComparedWithNoLift) {
  for (const double truly_deg : {-5.0, -6.5, -8.0}) {
    const RefractedSky sky(truly_deg);
    const Bands with = sky.ErrorsOf(LiftAt(truly_deg)).worst, without = sky.ErrorsOf(0.0).worst;
    // Red comes through lower air, which bends more.
    EXPECT_LT(with[0], 0.20) << truly_deg;
    EXPECT_LT(with[1], 0.25) << truly_deg;
    EXPECT_LT(with[2], 0.5) << truly_deg << ", without the lift up to 0.63";
    EXPECT_LT(with[1] + with[2], 0.75 * (without[1] + without[2])) << truly_deg;
  }
}

using Bands = std::array<double, 3>;

TEST(LiftForAir, GrowsSmoothlyToAFifthOfHorizontalRefraction) {
  const auto lift = [air = AlmanacAir()](double minutes) {
    return LiftForAir(air, minutes * kMinute) / kMinute;
  };
  EXPECT_NEAR(lift(-34.0), 0.2 * 34.0, 0.01);
  EXPECT_EQ(LiftForAir(AlmanacAir(), -0.7), LiftForAir(AlmanacAir(), -34.1 * kMinute))
      << "nothing ends at night";
  // A sun that sinks by a minute of arc lights the air from 0.9 to 1.04 minutes lower, whatever
  // happens to what is seen of it: refraction itself grows by at most 0.2 of what it sinks by.
  for (double minutes = 120.0; minutes > -600.0; minutes -= 1.0) {
    const double sinks = 1.0 + lift(minutes) - lift(minutes - 1.0);
    EXPECT_GT(sinks, 0.9) << minutes;
    EXPECT_LT(sinks, 1.0 + 1e-6) << minutes;
  }
}

TEST(LiftForAir, IsZeroWithoutAir) {
  BendingAir none = AlmanacAir();
  none.refractivity = 0.0;
  for (const double elevation_deg : {10.0, 0.0, -1.0, -10.0})
    EXPECT_NEAR(LiftForAir(none, elevation_deg * kRadiansPerDegree), 0.0, 1e-12) << elevation_deg;
}

TEST(SunForAir, IsRaisedByTheLiftForAirAtAnyHeight) {
  for (const double height_m : {0.0, 3000.0, 11000.0, 400e3}) {
    const Place eye = CheckedPlace({46.5, 8.0, height_m});
    for (const char* time :
         {"2026-06-21T11:00:00Z", "2026-06-21T19:22:00Z", "2026-06-21T20:20:00Z"}) {
      const UtcTime now = ParseInstant(time);
      const SunInSky truly = TrueSunAt(eye, now), seen = ApparentSunAt(eye, now);
      EXPECT_NEAR(SunForAir(seen).elevation_rad(),
                  truly.elevation_rad() + LiftForAir(AlmanacAir(), truly.elevation_rad()), 1e-12)
          << time << " " << height_m;
      EXPECT_EQ(SunForAir(seen).azimuth_rad(), seen.azimuth_rad());
      EXPECT_EQ(SunForAir(truly).elevation_rad(), truly.elevation_rad()) << "nothing has lifted it";
      const MoonPosition moon = ApparentMoonAt(eye, now, AlmanacAir()), bare = TrueMoonAt(eye, now);
      EXPECT_NEAR(moon.elevation_rad() - moon.lower_for_air_deg * kRadiansPerDegree,
                  bare.elevation_rad() + LiftForAir(AlmanacAir(), bare.elevation_rad()), 1e-12);
    }
  }
}

}  // namespace
}  // namespace alpenglow::atmosphere
