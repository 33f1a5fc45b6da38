// SPDX-License-Identifier: MIT
#include "atmosphere/weather/reported_air.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "atmosphere/math/constants.h"
#include "atmosphere/medium/medium_presets.h"
#include "atmosphere/medium/standard_air.h"
#include "tests/fixtures/fault_of.h"

namespace alpenglow::atmosphere {
namespace {

using testing::HasSubstr;

MetarReport Report(const std::string& groups) { return ReadMetar("XAAA 010000Z " + groups); }

TEST(ReportedAir, TheStandardAtmosphereIsThatOfAStandardReport) {
  for (const double station_m : {0.0, 423.0, 1655.0}) {
    const StationAir air = AirAtStation(Report("Q1013"), station_m);
    // 1013 hPa is 0.25 hPa below the standard.
    EXPECT_NEAR(air.pressure_pa, StandardAirAt(station_m).pressure_pa, 30.0) << station_m;
    EXPECT_NEAR(air.density_kg_per_m3, StandardAirAt(station_m).density_kg_per_m3, 4e-4);
  }
}

// Mean values of Denver (1655 m): altimeters set to 1018 hPa, 838 hPa at the station. The altimeter
// formula of the National Weather Service of the USA, in hectopascals and metres, has other constants.
TEST(ReportedAir, PressureAtTheStationIsThatOfAltimeters) {
  for (const double station_m : {-400.0, 500.0, 1655.0, 4061.0}) {
    for (const double qnh_hpa : {960.0, 1018.0, 1045.0}) {
      const double station_hpa =
          0.01 * AirAtStation(Report(fmt::format("Q{:04.0f}", qnh_hpa)), station_m).pressure_pa;
      const double inner = std::pow(1013.25, 0.190284) * 0.0065 / 288.0;
      const double set_hpa =
          (station_hpa - 0.3) *
          std::pow(1.0 + inner * station_m / std::pow(station_hpa - 0.3, 0.190284), 1.0 / 0.190284);
      // That formula subtracts 0.3 hPa for the height of the instrument, 3 m.
      EXPECT_NEAR(set_hpa, qnh_hpa, 0.5) << station_m;
    }
  }
}

// The vapour pressure over water at 20 degrees Celsius is 23.39 hPa (IAPWS-95), and the density follows
// from Dalton's law.
TEST(ReportedAir, DensityIsThatOfDryAirAndVapour) {
  const StationAir air = AirAtStation(Report("30/20 Q1000"), 0.0);
  const double vapour_pa = 2339.0, temperature_k = 303.15;
  const double density =
      (1e5 - vapour_pa) / (287.05 * temperature_k) + vapour_pa / (461.5 * temperature_k);
  EXPECT_NEAR(air.density_kg_per_m3, density, 1e-4 * density);
}

// The slow reference integrates the density of the medium numerically. The bound of the header.
TEST(ReportedAir, MoleculesHaveTheDensityAndTheColumnOfTheReport) {
  for (const char* groups : {"M30/M33 Q1045", "15/10 Q1013", "40/05 Q0995"}) {
    for (const double station_m : {0.0, 423.0, 1655.0, 3000.0}) {
      const Medium earth = MediumPreset("earth");
      const Medium medium = InReportedAir(earth, Report(groups), station_m);
      const StationAir air = AirAtStation(Report(groups), station_m);
      const auto coefficient = [](const Medium& of, double height_m) {
        return of.rayleigh_scattering_per_m[1] * MoleculeDensity(of, height_m);
      };
      const double ratio = coefficient(medium, station_m) / coefficient(earth, station_m);
      EXPECT_NEAR(ratio, air.density_kg_per_m3 / StandardAirAt(station_m).density_kg_per_m3, 1e-9);
      double column = 0.0, standard = 0.0;
      constexpr double kStep_m = 50.0;
      for (double height_m = station_m + 0.5 * kStep_m; height_m < 1e5; height_m += kStep_m) {
        column += kStep_m * coefficient(medium, height_m);
        standard += kStep_m * coefficient(earth, height_m);
      }
      EXPECT_NEAR(column / standard, air.pressure_pa / StandardAirAt(station_m).pressure_pa, 1e-4)
          << groups << " " << station_m;
    }
  }
}

TEST(ReportedAir, VisibilityAtTheStationIsTheReportedOne) {
  for (const char* preset : {"earth", "hazy", "clear-mountain", "bruneton2017"}) {
    for (const double station_m : {0.0, 423.0, 1000.0}) {
      for (const char* visibility : {"3000", "8000", "3SM", "9KM"}) {
        const MetarReport report = Report(std::string(visibility) + " 22/12 Q1018");
        const Medium medium = InReportedAir(MediumPreset(preset), report, station_m);
        const double wanted_m = report.visibility->distance_m;
        EXPECT_NEAR(VisibilityAt(medium, station_m, 0.0), wanted_m, 1e-9 * wanted_m) << preset;
      }
    }
  }
}

TEST(ReportedAir, AThousandMetresAreHaze) {
  const Medium medium = InReportedAir(MediumPreset("earth"), Report("1000"), 423.0);
  EXPECT_NEAR(VisibilityAt(medium, 423.0, 0.0), 1000.0, 1e-6);
}

// Koschmieder's range at 550 nm, by a medium that has exactly this wavelength.
TEST(ReportedAir, VisibilityIsThatOfExtinctionAt550Nanometres) {
  const Medium medium =
      InReportedAir(MediumPreset("earth", {450.0, 550.0, 650.0}), Report("5000"), 0.0);
  const double extinction_per_m =
      medium.rayleigh_scattering_per_m[1] + medium.mie_extinction_per_m[1];
  EXPECT_NEAR(kOpticalDepthOfVisibility / extinction_per_m, 5000.0, 1e-3);
}

TEST(ReportedAir, LimitsOfVisibilityChangeOnlyAirThatContradictsThem) {
  const Medium earth = MediumPreset("earth");
  EXPECT_EQ(InReportedAir(earth, Report("9999"), 0.0), earth);
  EXPECT_EQ(InReportedAir(earth, Report("CAVOK"), 0.0), earth);
  AirChoice dense;
  dense.aerosol = AerosolForVisibility(earth, 4000.0);
  const Medium hazy = Changed(earth, dense);
  EXPECT_NEAR(VisibilityOf(InReportedAir(hazy, Report("9999"), 0.0)), 10000.0, 1e-5);
  EXPECT_NEAR(VisibilityOf(InReportedAir(hazy, Report("P6SM"), 0.0)), 6.0 * 1609.344, 1e-5);
}

TEST(ReportedAir, FogLeavesTheAir) {
  const Medium earth = MediumPreset("earth");
  for (const char* groups : {"0300 FG", "0999", "1/4SM", "M1/4SM", "1500 FG", "//// FG"}) {
    EXPECT_TRUE(IsInFog(Report(groups))) << groups;
    EXPECT_EQ(InReportedAir(earth, Report(groups), 0.0), earth) << groups;
  }
  for (const char* groups : {"1000", "9999 MIFG", "9999 BCFG", "3000 BR", "9999 VCFG", "CAVOK"})
    EXPECT_FALSE(IsInFog(Report(groups))) << groups;
}

TEST(ReportedAir, AReportWithoutValuesLeavesTheAir) {
  const Medium earth = MediumPreset("earth");
  EXPECT_EQ(InReportedAir(earth, Report(""), 500.0), earth);
  EXPECT_EQ(InReportedAir(earth, Report("24008KT FEW040"), 500.0), earth);
}

TEST(ReportedAir, ChangedAirKeepsThePresetOfItsBands) {
  const Medium medium = InReportedAir(MediumPreset("earth"), Report("5000 22/12 Q1018"), 423.0);
  EXPECT_EQ(medium.name, "custom (from earth)");
  const std::optional<Medium> fine = OnBands(medium, 40);
  ASSERT_TRUE(fine);
  // Factors common to all wavelengths are carried over exactly; 550 nm lies between bands.
  EXPECT_NEAR(VisibilityAt(*fine, 423.0, 0.0), 5000.0, 50.0);
}

TEST(ReportedAir, AirWithoutAerosolCannotHaveHaze) {
  Medium pure = MediumPreset("earth");
  for (double& value : pure.mie_scattering_per_m) value = 0.0;
  for (double& value : pure.mie_extinction_per_m) value = 0.0;
  EXPECT_THAT(tests::FaultOf([&] { return InReportedAir(pure, Report("4000"), 0.0); }),
              HasSubstr("the visibility is 4000 m, and the air has no aerosol"));
  EXPECT_EQ(tests::FaultOf([&] { return InReportedAir(pure, Report("9999"), 0.0); }), "no fault");
}

TEST(ReportedAir, HazeBeyondAThousandTimesTheAerosolIsRefused) {
  EXPECT_THAT(tests::FaultOf(
                  [] { return InReportedAir(MediumPreset("bruneton2017"), Report("3000"), 9e3); }),
              HasSubstr("the visibility is 3000 m, and 1000 times the aerosol of the air leaves"));
}

// Temperature at the adiabatic condensation level: Bolton (1980), Mon. Weather Rev. 108, 1046,
// equation 15; rising dry air cools by g / c_p. The bound of the header.
TEST(ReportedAir, CondensationLevelIsThatOfRisingAir) {
  for (int air_c = 0; air_c <= 35; air_c += 5) {
    for (int spread_k = 1; spread_k <= 20; ++spread_k) {
      const double air_k = 273.15 + air_c, dew_k = air_k - spread_k;
      const double level_k = 1.0 / (1.0 / (dew_k - 56.0) + std::log(air_k / dew_k) / 800.0) + 56.0;
      const double level_m = (air_k - level_k) * 1005.7 / kStandardGravity_m_per_s2;
      MetarReport report;
      report.temperature = {air_c, air_c - spread_k};
      EXPECT_NEAR(*CondensationLevel_m(report) / level_m, 1.0, 0.04) << air_c << " " << spread_k;
    }
  }
  EXPECT_FALSE(CondensationLevel_m(Report("12///")));
}

}  // namespace
}  // namespace alpenglow::atmosphere
