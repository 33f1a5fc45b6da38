// SPDX-License-Identifier: MIT
#include "lut/tables/scattering_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/reference/reference_solution.h"
#include "lut/cli/program.h"
#include "lut/tables/table_axes.h"
#include "tests/fixtures/bands_near.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/sanitized.h"
#include "tests/lut/tables/table_errors.h"

namespace alpenglow::lut {
namespace {

constexpr ScatteringTableSize kStandard{.nu = 8, .mu_s = 32, .mu = 128, .altitudes = 32};
constexpr ScatteringTableSize kTiny{.nu = 2, .mu_s = 4, .mu = 8, .altitudes = 4};

constexpr ScatteringTableSize kSmall{.nu = 6, .mu_s = 12, .mu = 16, .altitudes = 8};

// Several tests look things up in these tables, which are built once.
const ScatteringTable& SmallTable() {
  static const ScatteringTable table(MediumPreset("earth"), {.size = kSmall, .lowest_mu_s = {}});
  return table;
}
const ScatteringTable& StandardTable() {
  static const ScatteringTable table(MediumPreset("earth"), {.size = kStandard, .lowest_mu_s = {}});
  return table;
}

const ScatteringTable& SmallAzimuthTable() {
  static const ScatteringTable table(
      MediumPreset("earth"), {.size = kSmall, .lowest_mu_s = {}, .axes = ScatteringAxes::kAzimuth});
  return table;
}

/// Returns the values of a texel: molecules in all bands, then aerosol.
std::vector<float> TexelOf(const ScatteringTable& table, std::size_t nu, std::size_t mu_s,
                           std::size_t mu, std::size_t altitude) {
  const std::size_t values = 2 * table.medium().wavelengths_nm.size();
  const auto texel =
      table.texels().begin() +
      static_cast<std::ptrdiff_t>(
          (((altitude * kSmall.mu + mu) * kSmall.nu + nu) * kSmall.mu_s + mu_s) * values);
  return {texel, texel + static_cast<std::ptrdiff_t>(values)};
}

/// Returns molecules in all bands, then aerosol.
template <typename Real>
std::vector<Real> ValuesOf(const ScatteredOnce<Real>& light) {
  std::vector<Real> values;
  for (const SpectrumOf<Real>* part : {&light.rayleigh, &light.mie}) {
    for (std::size_t band = 0; band < part->size(); ++band) values.push_back((*part)[band]);
  }
  return values;
}

/// Returns light by integration.
std::vector<double> Integrated(const SingleScattering<double>& air, const ViewRay& ray) {
  return ValuesOf(air.Scatter(air.Sample(ray, {.nodes = 16, .split_ozone = true})));
}

TEST(ScatteringTable, TexelsEqualTheIntegralsOfTheirRays) {
  const ScatteringTable& table = SmallTable();
  const SingleScattering<double> air(table.medium());
  for (std::size_t altitude = 0; altitude < kSmall.altitudes; altitude += 2) {
    for (std::size_t mu = 0; mu < kSmall.mu; mu += 3) {
      for (std::size_t mu_s = 0; mu_s < kSmall.mu_s; mu_s += 2) {
        for (std::size_t nu = 0; nu < kSmall.nu; nu += 3) {
          EXPECT_TRUE(tests::BandsNear(TexelOf(table, nu, mu_s, mu, altitude),
                                       Integrated(air, table.RayOfTexel(nu, mu_s, mu, altitude)),
                                       2e-4, 1e-12))
              << "a rounding of a grazing sunbeam's zenith cosine moves an optical depth of ten by "
                 "1e-4";
        }
      }
    }
  }
}

TEST(ScatteringTable, InterpolationIsExactAtTheNodes) {
  const ScatteringTable& table = SmallTable();
  int compared = 0;
  for (std::size_t altitude = 1; altitude + 1 < kSmall.altitudes; altitude += 2) {
    // At the horizon, the last mu, the node is a nudge away from where the look-up takes the ray to
    // be.
    for (std::size_t mu = 1; mu < kSmall.mu - 1; mu += 2) {
      for (std::size_t mu_s = 0; mu_s < kSmall.mu_s; mu_s += 3) {
        const ViewRay ray = table.RayOfTexel(2, mu_s, mu, altitude);
        // Several texels hold one ray if nu was moved.
        if (std::abs(ray.nu - (2.0 * 2.0 / 5.0 - 1.0)) > 1e-15) continue;
        ++compared;
        EXPECT_TRUE(tests::BandsNear(ValuesOf(table.Lookup(ray)),
                                     TexelOf(table, 2, mu_s, mu, altitude), 1e-5, 1e-12))
            << altitude << " " << mu << " " << mu_s;
      }
    }
  }
  EXPECT_GT(compared, 20);
}

struct Regime {
  const char* name;
  double highest_deg, lowest_deg;  // zenith angle of the sun
  double relative_rms;             // bound, of the rms of the truth
  double median;                   // bound, relative to each value
};

/// A ray with its radiance by the reference solution.
struct ReferenceRay {
  ViewRay ray;
  std::vector<double> radiance;
};

/// Returns observers to 12 km who look in all directions. The rays of a regime are solved once.
const std::vector<ReferenceRay>& RaysOf(const Medium& medium, const Regime& regime) {
  static std::map<std::string, std::vector<ReferenceRay>> solved;
  std::vector<ReferenceRay>& rays = solved[regime.name];
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  while (rays.size() < tests::ScaledDown<std::size_t>(100, 24)) {
    const double u = uniform(random);
    const double sun =
        regime.highest_deg + (regime.lowest_deg - regime.highest_deg) * uniform(random);
    const double view = 180.0 * uniform(random);
    const ViewRay ray = RayFromAngles(12000.0 * u * u, view, 180.0 * uniform(random), sun);
    rays.push_back({ray, reference::SingleScatteringAlong(medium, ray).inscatter});
  }
  return rays;
}

// Compares radiance with phase functions in all bands.
void ExpectErrorsBelow(const ScatteringTable& table, const Regime& regime) {
  const SingleScattering<float> air(table.medium());
  TableErrors absolute, relative;
  for (const auto& [ray, truth] : RaysOf(table.medium(), regime)) {
    const Spectrum value = air.Inscatter(table.Lookup(ray), ray.nu);
    for (std::size_t band = 0; band < value.size(); ++band) {
      absolute.Add(value[band], truth[band]);
      if (truth[band] > 0.0) relative.Add(double{value[band]} / truth[band], 1.0);
    }
  }
  EXPECT_LT(absolute.RelativeRms(), regime.relative_rms) << regime.name;
  EXPECT_LT(relative.Quantile(0.5), regime.median) << regime.name;
}

TEST(ScatteringTable, ErrorIsBelowTheStatedBounds) {
  for (const Regime& regime :
       {Regime{"day", 0.0, 85.0, 0.01, 0.0025}, Regime{"sunset", 85.0, 90.0, 0.015, 0.008},
        Regime{"civil twilight", 90.0, 96.0, 0.4, 0.15}}) {
    ExpectErrorsBelow(StandardTable(), regime);
  }
}

TEST(ScatteringTable, AzimuthAxesAreAsAccurateInTwilightAsByDay) {
  const ScatteringTable table(MediumPreset("earth"),
                              {.size = {.nu = 8, .mu_s = 32, .mu = 64, .altitudes = 48},
                               .lowest_mu_s = {},
                               .axes = ScatteringAxes::kAzimuth});
  EXPECT_LT(table.bytes(), StandardTable().bytes());
  for (const Regime& regime :
       {Regime{"day", 0.0, 85.0, 0.004, 0.0015}, Regime{"sunset", 85.0, 90.0, 0.005, 0.002},
        Regime{"civil twilight", 90.0, 96.0, 0.008, 0.0045}}) {
    ExpectErrorsBelow(table, regime);
  }
}

TEST(ScatteringTable, AzimuthTableIsExactAtItsNodes) {
  const ScatteringTable& table = SmallAzimuthTable();
  const SingleScattering<double> air(table.medium());
  for (std::size_t altitude = 1; altitude + 1 < kSmall.altitudes; altitude += 2) {
    for (std::size_t mu = 1; mu + 1 < kSmall.mu; mu += 2) {
      for (std::size_t mu_s = 0; mu_s < kSmall.mu_s; mu_s += 3) {
        for (std::size_t azimuth = 0; azimuth < kSmall.nu; ++azimuth) {
          const ViewRay ray = table.RayOfTexel(azimuth, mu_s, mu, altitude);
          EXPECT_TRUE(
              tests::BandsNear(ValuesOf(table.Lookup(ray)), Integrated(air, ray), 1e-3, 1e-9))
              << "the azimuth is known to a rounding of nu, near the sun its square root";
        }
      }
    }
  }
}

// Hard case 11.
TEST(ScatteringTable, SunInTheZenithIsRotationallySymmetric) {
  const ScatteringTable& table = SmallTable();
  for (const double zenith_deg : {10.0, 60.0, 89.0, 120.0}) {
    const ViewRay first = RayFromAngles(1000.0, zenith_deg, 0.0, 0.0);
    for (const double azimuth_deg : {37.0, 90.0, 180.0}) {
      const ViewRay turned = RayFromAngles(1000.0, zenith_deg, azimuth_deg, 0.0);
      const double same = table.Lookup(first).rayleigh[0];
      EXPECT_NEAR(table.Lookup(turned).rayleigh[0], same, 1e-6 * same);
    }
  }
}

// Hard case 23.
TEST(ScatteringTable, IsNeverNegativeOrNan) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int i = 0; i < 20000; ++i) {
    const double u = uniform(random);
    ViewRay ray = RayFromAngles((i % 3 == 0 ? 1e6 : 1e5) * u * u - 500.0, 180.0 * uniform(random),
                                360.0 * uniform(random), 180.0 * uniform(random));
    if (i % 2 == 0) ray.length_m = 1e5 * uniform(random);
    for (const ScatteringTable* table : {&SmallTable(), &SmallAzimuthTable()}) {
      for (const float value : ValuesOf(table->Lookup(ray)))
        ASSERT_TRUE(value >= 0.0F && value <= 1.0F) << i << ": " << value;
    }
  }
  const ViewRay zenith{10.0, 1.0, 0.5, 0.5}, at_the_sun{10.0, 0.5, 0.5, 1.0};
  EXPECT_GT(SmallAzimuthTable().Lookup(zenith).rayleigh[0], 0.0F);
  EXPECT_GT(SmallAzimuthTable().Lookup(at_the_sun).mie[0], 0.0F);
}

// Hard case 23.
TEST(ScatteringTable, NightIsBlackBelowTheLowestUsefulSun) {
  const ScatteringTable& table = SmallTable();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  EXPECT_NEAR(table.lowest_mu_s(), std::cos(123.1 * 0.017453292519943295), 1e-3)
      << "top at 120 km: the horizon dips 11.04 degrees";
  for (int i = 0; i < 1000; ++i) {
    const ViewRay ray = RayFromAngles(120000.0 * uniform(random), 180.0 * uniform(random),
                                      180.0 * uniform(random), 123.2 + 50.0 * uniform(random));
    EXPECT_EQ(table.Lookup(ray).rayleigh[0], 0.0F) << "no glow is left over";
  }
}

// Hard case 6.
TEST(ScatteringTable, ObserversAboveTheTopSeeTheLightAtEntry) {
  const ScatteringTable& table = SmallTable();
  EXPECT_EQ(table.Lookup(RayFromAngles(4e5, 60.0, 0.0, 30.0)).rayleigh[0], 0.0F) << "upwards";
  EXPECT_EQ(table.Lookup(RayFromAngles(1e8, 120.0, 0.0, 30.0)).rayleigh[0], 0.0F) << "past it";
  for (const double zenith_deg : {91.0, 100.0, 140.0, 180.0}) {
    const ViewRay above = RayFromAngles(120000.0 + 1e-6, zenith_deg, 20.0, 40.0);
    const ViewRay below = RayFromAngles(120000.0 - 1e-6, zenith_deg, 20.0, 40.0);
    const double inside = table.Lookup(below).rayleigh[0];
    EXPECT_NEAR(table.Lookup(above).rayleigh[0], inside, 1e-5 * inside) << zenith_deg;
  }
}

TEST(ScatteringTable, ShortRaysToTheGroundAreAccurate) {
  const ScatteringTable& table = StandardTable();
  const SingleScattering<double> air(table.medium());
  for (const double altitude_m : {0.1, 1.7, 10.0, 50.0}) {
    const ViewRay ray = RayFromAngles(altitude_m, 150.0, 60.0, 40.0);
    const double truth = Integrated(air, ray)[0];
    EXPECT_NEAR(table.Lookup(ray).rayleigh[0], truth, 0.02 * truth)
        << "the light per length hardly depends on the altitude here";
  }
}

// Hard case 14.
TEST(ScatteringTable, SegmentsAreDifferencesAndLengthZeroIsZero) {
  const ScatteringTable& table = StandardTable();
  const SingleScattering<double> air(table.medium());
  ViewRay ray = RayFromAngles(500.0, 80.0, 45.0, 50.0);
  ray.length_m = 0.0;
  EXPECT_EQ(table.Lookup(ray).rayleigh[0], 0.0F);
  ViewRay whole = ray;
  whole.length_m = std::numeric_limits<double>::infinity();
  const double all = table.Lookup(whole).rayleigh[0];
  for (const double length_m : {1000.0, 10000.0, 100000.0, 1e6}) {
    ray.length_m = length_m;
    const double truth = Integrated(air, ray)[0];
    EXPECT_NEAR(table.Lookup(ray).rayleigh[0], truth, 2.0 * 0.02 * all)
        << "twice the day's error of whole rays";
  }
}

// Hard case 38.
TEST(ScatteringTable, TheSmallestTableWorks) {
  const ScatteringTable table(
      MediumPreset("bruneton2017"),
      {.size = {.nu = 2, .mu_s = 2, .mu = 4, .altitudes = 2}, .lowest_mu_s = {}});
  EXPECT_EQ(table.bytes(), 2U * 2U * 4U * 2U * 3U * 2U * sizeof(float));
  for (double zenith = 0.0; zenith <= 180.0; zenith += 5.0) {
    const float value = table.Lookup(RayFromAngles(500.0, zenith, 30.0, 40.0)).rayleigh[0];
    EXPECT_GE(value, 0.0F);
    EXPECT_LE(value, 1.0F);
  }
}

// Hard case 38.
TEST(ScatteringTable, ImpossibleSizesAreRefusedWithTheirBytes) {
  const Medium medium = MediumPreset("earth");
  const auto fault = [&](const ScatteringTableSize& size) {
    return tests::FaultOf([&] { ScatteringTable(medium, {.size = size, .lowest_mu_s = {}}); });
  };
  for (const ScatteringTableSize& size : {ScatteringTableSize{1, 32, 128, 32},
                                          {8, 1, 128, 32},
                                          {8, 32, 2, 32},
                                          {8, 32, 5, 32},
                                          {8, 32, 128, 1}})
    EXPECT_NE(fault(size), "no fault");
  EXPECT_THAT(fault({64, 256, 1024, 256}), testing::HasSubstr("137438953472 bytes"));
  EXPECT_THROW(ScatteringTable(medium, {.size = kTiny, .lowest_mu_s = 0.5}), InputError);
}

// Hard case 43.
TEST(ScatteringTable, NumberOfThreadsDoesNotChangeAByte) {
  const Medium medium = MediumPreset("earth");
  const auto texels_with = [&](int threads) {
    const ThreadLimit limit(threads);
    return ScatteringTable(medium, {.size = kTiny, .lowest_mu_s = {}}).texels();
  };
  const std::vector<float> one = texels_with(1);
  EXPECT_EQ(texels_with(2), one);
  EXPECT_EQ(texels_with(8), one);
}

// Hard case 28.
TEST(ScatteringTable, WithoutAirIsZero) {
  const ScatteringTable table(tests::WithoutAir(MediumPreset("bruneton2017")),
                              {.size = kTiny, .lowest_mu_s = {}});
  EXPECT_EQ(table.Lookup(RayFromAngles(500.0, 45.0, 30.0, 40.0)).rayleigh[0], 0.0F);
}

}  // namespace
}  // namespace alpenglow::lut

namespace alpenglow::shared {
namespace {

constexpr double kRadius_km = 6371.0;
constexpr double kTop_km = 120.0;

std::vector<double> Altitudes() {
  std::vector<double> altitudes{1e-5, 1e-3};
  for (double h = 0.01; h < kTop_km; h *= 1.3) altitudes.push_back(h);
  altitudes.push_back(kTop_km);
  return altitudes;
}

// Returns directions that meet the ground, dense at the horizon.
std::vector<double> GroundCosines(double h) {
  const double horizon = HorizonCosine<double>(h, kRadius_km);
  std::vector<double> cosines{-1.0};
  for (double step = 1e-6; step < 1.0 + horizon; step *= 1.5) cosines.push_back(horizon - step);
  return cosines;
}

TEST(ScatteringMap, RaysToTheGroundAreInvertible) {
  for (const double h : Altitudes()) {
    for (const double mu : GroundCosines(h)) {
      const double x = UnitFromGroundCosine<double>(h, mu, kRadius_km);
      ASSERT_GE(x, 0.0);
      ASSERT_LE(x, 1.0);
      EXPECT_NEAR(GroundCosineFromUnit<double>(x, h, kRadius_km), mu, 1e-12) << h << " km";
    }
  }
}

TEST(ScatteringMap, SunCoordinateIsInvertible) {
  for (const double lowest_deg : {102.0, 120.0}) {
    const double lowest = std::cos(lowest_deg * atmosphere::kRadiansPerDegree);
    for (double mu_s = lowest; mu_s <= 1.0; mu_s += 1e-4) {
      const double x = UnitFromSunCosine<double>(mu_s, lowest, kTop_km, kRadius_km);
      ASSERT_GE(x, 0.0);
      ASSERT_LE(x, 1.0);
      EXPECT_NEAR(SunCosineFromUnit<double>(x, lowest, kTop_km, kRadius_km), mu_s, 1e-12);
    }
    EXPECT_NEAR(UnitFromSunCosine<double>(1.0, lowest, kTop_km, kRadius_km), 1.0, 1e-15);
    EXPECT_EQ(UnitFromSunCosine<double>(-1.0, lowest, kTop_km, kRadius_km), 0.0)
        << "suns below the lowest are clamped to it";
  }
}

// Hard case 37.
TEST(ScatteringMap, TexelCentresAreInvertible) {
  for (const double n : {4.0, 6.0, 128.0}) {
    for (double i = 0.0; i < n; ++i) {
      const double u = (i + 0.5) / n;
      const double x = UnitFromMuTexel<double>(u, n);
      const double ground = GroundFromMuTexel<double>(u);
      EXPECT_NEAR(MuTexelFromUnit<double>(x, ground, n), u, 1e-15);
      EXPECT_EQ(ground, i < n / 2.0 ? 1.0 : 0.0);
      const double mu = GroundCosineFromUnit<double>(x, 2.0, kRadius_km);
      EXPECT_NEAR(UnitFromGroundCosine<double>(2.0, mu, kRadius_km), x, 1e-12);
    }
  }
  for (double x = 0.0; x <= 1.0; x += 1.0 / 31.0) {
    const double mu_s = SunCosineFromUnit<double>(x, -0.5, kTop_km, kRadius_km);
    EXPECT_NEAR(UnitFromSunCosine<double>(mu_s, -0.5, kTop_km, kRadius_km), x, 1e-12);
    EXPECT_NEAR(UnitFromScatteringCosine<double>(ScatteringCosineFromUnit<double>(x)), x, 1e-15);
  }
}

// Hard case 37.
TEST(ScatteringMap, HalvesMeetAtTheHorizon) {
  const double n = 128.0;
  EXPECT_DOUBLE_EQ(MuTexelFromUnit<double>(0.0, 1.0, n), 63.5 / 128.0) << "straight down";
  EXPECT_DOUBLE_EQ(MuTexelFromUnit<double>(1.0, 1.0, n), 0.5 / 128.0) << "horizon, seen as ground";
  EXPECT_DOUBLE_EQ(MuTexelFromUnit<double>(0.0, 0.0, n), 64.5 / 128.0) << "straight up";
  EXPECT_DOUBLE_EQ(MuTexelFromUnit<double>(1.0, 0.0, n), 127.5 / 128.0) << "horizon, seen as sky";
}

TEST(ScatteringMap, OnTheGroundEveryDownwardRayHasOneCoordinate) {
  for (const double mu : {-1.0, -0.5, -1e-6, 0.0}) {
    EXPECT_EQ(UnitFromGroundCosine<double>(0.0, mu, kRadius_km), 0.0);
    EXPECT_EQ(UnitFromGroundCosine<float>(0.0F, static_cast<float>(mu), 6371.0F), 0.0F);
  }
  for (const double x : {0.0, 0.5, 1.0}) {
    EXPECT_TRUE(std::isfinite(GroundCosineFromUnit<double>(x, 0.0, kRadius_km)));
  }
}

// Hard case 9.
TEST(ScatteringMap, FloatAgreesWithDouble) {
  for (const double z : Altitudes()) {
    const float h = static_cast<float>(z);
    for (const double cosine : GroundCosines(z)) {
      const float mu = static_cast<float>(cosine);
      if (GroundClearance<double>(double{h}, double{mu}, kRadius_km) <= 0.0) continue;
      // The distance to the ground is a square root at the horizon, of the clearance |r mu| - rho:
      // the four roundings in r, r mu, rho^2 and rho, of 2^-24 each, move the coordinate by this.
      const double clearance = GroundClearance<double>(double{h}, double{mu}, kRadius_km);
      const double rho = HorizonDistance<double>(double{h}, kRadius_km);
      const double rounding = 4.0 * std::ldexp(1.0, -24) * rho;
      const double spread = std::min(1.0, rounding / std::sqrt(2.0 * rho * clearance));
      EXPECT_NEAR(UnitFromGroundCosine<float>(h, mu, 6371.0F),
                  UnitFromGroundCosine<double>(double{h}, double{mu}, kRadius_km), 1e-5 + spread)
          << z << " km, " << cosine;
    }
    for (float u = 0.0F; u <= 1.0F; u += 0.01F) {
      EXPECT_NEAR(GroundCosineFromUnit<float>(u, h, 6371.0F),
                  GroundCosineFromUnit<double>(double{u}, double{h}, kRadius_km), 1e-5);
    }
  }
  for (float mu_s = -0.2F; mu_s <= 1.0F; mu_s += 0.001F) {
    EXPECT_NEAR(UnitFromSunCosine<float>(mu_s, -0.25F, 120.0F, 6371.0F),
                UnitFromSunCosine<double>(double{mu_s}, -0.25, kTop_km, kRadius_km), 1e-5);
  }
  for (float u = 0.0F; u <= 1.0F; u += 0.001F) {
    EXPECT_NEAR(SunCosineFromUnit<float>(u, -0.25F, 120.0F, 6371.0F),
                SunCosineFromUnit<double>(double{u}, -0.25, kTop_km, kRadius_km), 1e-5);
  }
}

// Hard case 13.
TEST(ScatteringMap, ImpossibleScatteringAnglesAreClamped) {
  EXPECT_NEAR(PossibleScatteringCosine<double>(-1.0, 0.3, 1.0), 0.3, 1e-15) << "sun in the zenith";
  EXPECT_NEAR(PossibleScatteringCosine<double>(1.0, 0.6, 0.6), 1.0, 1e-15) << "looking at the sun";
  EXPECT_NEAR(PossibleScatteringCosine<double>(-1.0, 0.6, 0.6), 0.36 - 0.64, 1e-15);
  EXPECT_EQ(PossibleScatteringCosine<double>(0.2, 0.0, 0.0), 0.2);
}

}  // namespace
}  // namespace alpenglow::shared

namespace alpenglow::lut {
namespace {

template <typename Function>
double Interpolated(double at, int nodes, const Function& function) {
  const CubicTaps taps = TapsAt(at, nodes);
  double sum = 0.0;
  for (std::size_t tap = 0; tap < 4; ++tap) {
    sum += static_cast<double>(taps.weight[tap]) *
           function(static_cast<double>(taps.node[tap]) / (nodes - 1));
  }
  return sum;
}

TEST(CubicTaps, ReproduceAParabolaOrALineBetweenTwoNodes) {
  const auto parabola = [](double x) { return 1.0 - 3.0 * x + 5.0 * x * x; };
  for (const int nodes : {3, 4, 9}) {
    for (const double at : {0.0, 0.03, 0.2, 0.5, 0.81, 0.97, 1.0})
      EXPECT_NEAR(Interpolated(at, nodes, parabola), parabola(at), 2e-6) << nodes << " " << at;
  }
  const auto square = [](double x) { return x * x; };
  for (const double at : {0.0, 0.3, 1.0}) EXPECT_NEAR(Interpolated(at, 2, square), at, 1e-6);
}

}  // namespace
}  // namespace alpenglow::lut
