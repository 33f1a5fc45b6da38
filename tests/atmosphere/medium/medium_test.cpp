// SPDX-License-Identifier: MIT
#include "atmosphere/medium/medium.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <utility>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/aerosol_mixture.h"
#include "atmosphere/medium/atmosphere_file.h"
#include "atmosphere/medium/medium_presets.h"
#include "atmosphere/medium/phase.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/media.h"

namespace alpenglow::atmosphere {
namespace {

using testing::HasSubstr;

using tests::FaultOf;

double OpticalDepthOfAerosol(const Medium& medium, std::size_t band) {
  return medium.mie_extinction_per_m[band] * medium.mie_scale_height_m;
}

TEST(Medium, EveryPresetIsValidOnItsWavelengthsAndOnManyBands) {
  for (const std::string& name : MediumPresetNames()) {
    EXPECT_EQ(FindFault(MediumPreset(name)), std::nullopt) << name;
    EXPECT_EQ(MediumPreset(name).name, name);
    if (name == "bruneton2017") continue;
    EXPECT_EQ(FindFault(MediumPreset(name, WavelengthSet(40))), std::nullopt) << name;
  }
}

TEST(Medium, EarthHasFourBandsAndAnEllipsoid) {
  const Medium earth = MediumPreset("earth");
  EXPECT_EQ(earth.wavelengths_nm, WavelengthSet(4));
  EXPECT_TRUE(earth.follows_wgs84);
  EXPECT_DOUBLE_EQ(earth.planet_radius_m, 6371008.7714);
  EXPECT_DOUBLE_EQ(earth.atmosphere_height_m, 120000.0);
  EXPECT_EQ(earth.rayleigh_scattering_per_m[0], RayleighScatteringAtSeaLevel(WavelengthSet(4)[0]));
}

TEST(Medium, AerosolOfEarthHasTheOpticalDepthAndSlopeOfAngstrom) {
  const Medium earth = MediumPreset("earth", {450.0, 550.0, 700.0});
  EXPECT_NEAR(OpticalDepthOfAerosol(earth, 1), 0.05, 1e-15);
  EXPECT_NEAR(OpticalDepthOfAerosol(earth, 0) / OpticalDepthOfAerosol(earth, 2),
              std::pow(450.0 / 700.0, -1.3), 1e-12);
  EXPECT_NEAR(earth.mie_scattering_per_m[1] / earth.mie_extinction_per_m[1], 0.9253, 1e-12)
      << "OPAC continental average, 80 % relative humidity, 550 nm";
}

TEST(Medium, PhaseFunctionsOfEarthAerosolsAreThoseOfOpac) {
  for (const auto& [preset, mixture] :
       {std::pair{"earth", "continental_average"}, std::pair{"clear-mountain", "continental_clean"},
        std::pair{"hazy", "continental_polluted"}}) {
    const Medium medium = MediumPreset(preset);
    ASSERT_EQ(medium.mie_phase.size(), medium.wavelengths_nm.size()) << preset;
    EXPECT_EQ(medium.mie_phase, AerosolMixture(mixture, medium.wavelengths_nm).phase) << preset;
    EXPECT_EQ(AerosolPhase(preset, medium.wavelengths_nm), medium.mie_phase);
  }
  const PhaseFunction green = AerosolPhase("earth", {550.0}).front();
  const double at_one_degree = Phase(green, std::cos(kRadiansPerDegree));
  EXPECT_NEAR(at_one_degree, 3.7325, 0.01 * 3.7325)
      << "the published table, whose integral is up to 1 % below 1";
}

TEST(Medium, VisibilityOfEarthIsThatOfACleanDay) {
  const auto visibility_m = [](const char* name) {
    const Medium medium = MediumPreset(name, {550.0});
    return 3.912 / (medium.mie_extinction_per_m[0] + medium.rayleigh_scattering_per_m[0]);
  };
  EXPECT_NEAR(visibility_m("earth"), 74000.0, 1000.0) << "Koschmieder's 3.912 / extinction";
  EXPECT_GT(visibility_m("clear-mountain"), 130000.0);
  EXPECT_NEAR(visibility_m("hazy"), 22000.0, 1000.0);
}

TEST(Medium, OzoneColumnOfEarthIsThreeHundredDobson) {
  const Medium earth = MediumPreset("earth", {600.0});
  double layer_m = 0.0;  // by the midpoint rule, exact for a smooth layer of compact support
  for (double h = 5.0; h < 66000.0; h += 10.0) {
    layer_m += 10.0 * std::pow(6.75 * (h / 66000.0) * std::pow(1.0 - h / 66000.0, 2), 4);
  }
  const double column = earth.ozone_absorption_per_m[0] * layer_m / OzoneCrossSection(600.0);
  EXPECT_NEAR(column, 300.0 * 2.6867811e20, 1e15) << "molecules per square metre";
}

TEST(Medium, DustOfMarsAbsorbsBlueAndItsGasHardlyScatters) {
  const Medium mars = MediumPreset("mars", {450.0, 532.2, 650.0});
  EXPECT_LT(mars.mie_scattering_per_m[0], 0.9 * mars.mie_scattering_per_m[2]);
  EXPECT_LT(mars.rayleigh_scattering_per_m[0], 0.02 * mars.mie_extinction_per_m[0]);
  EXPECT_NEAR(mars.solar_irradiance[1] * 1.524 * 1.524, SolarIrradiance(532.2), 1e-12);
  const double cross_section_m2 =
      mars.rayleigh_scattering_per_m[1] / (610.0 / (1.380649e-23 * 210.0));
  EXPECT_NEAR(cross_section_m2, 1.24e-30, 0.08 * 1.24e-30)
      << "Sneep and Ubachs (2005) measured 1.24e-30 m^2 at 532.2 nm";
}

TEST(Medium, Bruneton2017IsAsPublishedButAscending) {
  const Medium medium = MediumPreset("bruneton2017");
  EXPECT_EQ(medium.wavelengths_nm, (std::vector<double>{440.0, 550.0, 680.0}));
  EXPECT_EQ(medium.solar_irradiance, (std::vector<double>{1.91198, 1.8504, 1.474}));
  EXPECT_EQ(medium.rayleigh_scattering_per_m, (std::vector<double>{33.1e-6, 13.558e-6, 5.802e-6}));
  EXPECT_EQ(medium.ozone_absorption_per_m, (std::vector<double>{0.085e-6, 1.881e-6, 0.650e-6}));
  EXPECT_EQ(medium.ground_albedo, (std::vector<double>{0.1, 0.1, 0.1}));
  EXPECT_FALSE(medium.follows_wgs84);
  EXPECT_EQ(medium.planet_radius_m, 6360000.0);
  EXPECT_EQ(medium.atmosphere_height_m, 60000.0);
  EXPECT_EQ(medium.mie_phase.front().g, 0.8);
  EXPECT_THAT(FaultOf([] { (void)MediumPreset("bruneton2017", {450.0}); }), HasSubstr("440"));
}

TEST(Medium, UnknownPresetsAndWavelengthsWithoutTablesAreRefused) {
  EXPECT_THAT(FaultOf([] { (void)MediumPreset("venus"); }), HasSubstr("clear-mountain"));
  EXPECT_THAT(FaultOf([] { (void)MediumPreset("earth", {300.0}); }), HasSubstr("[360, 830]"));
  EXPECT_THAT(FaultOf([] { (void)MediumPreset("earth", {600.0, 500.0}); }), HasSubstr("ordered"));
  EXPECT_THAT(FaultOf([] { (void)MediumPreset("earth", {}); }), HasSubstr("0 values"));
}

struct Change {
  const char* key;
  std::function<void(Medium&)> make;
};

std::vector<Change> HashedChanges() {
  return {
      {"follows_wgs84", [](Medium& m) { m.follows_wgs84 = false; }},
      {"radius", [](Medium& m) { m.planet_radius_m += 1e-9; }},
      {"top", [](Medium& m) { m.atmosphere_height_m += 1.0; }},
      {"wavelengths", [](Medium& m) { m.wavelengths_nm[1] += 1.0; }},
      {"irradiance", [](Medium& m) { m.solar_irradiance[1] += 0.1; }},
      {"albedo", [](Medium& m) { m.ground_albedo[0] += 0.1; }},
      {"rayleigh", [](Medium& m) { m.rayleigh_scattering_per_m[0] *= 1.1; }},
      {"rayleigh height", [](Medium& m) { m.rayleigh_scale_height_m += 1.0; }},
      {"rayleigh deficit", [](Medium& m) { m.rayleigh_deficit.share = 0.3; }},
      {"depolarisation", [](Medium& m) { m.rayleigh_depolarisation = {0.03}; }},
      {"polarised", [](Medium& m) { m.polarised = false; }},
      {"both", [](Medium& m) { m = InScalarLight(m); }},
      {"mie", [](Medium& m) { m.mie_scattering_per_m[0] *= 0.9; }},
      {"mie extinction", [](Medium& m) { m.mie_extinction_per_m[0] *= 1.1; }},
      {"mie height", [](Medium& m) { m.mie_scale_height_m += 1.0; }},
      {"phase", [](Medium& m) { m.mie_phase.front().kind = PhaseKind::kDraine; }},
      {"g", [](Medium& m) { m.mie_phase.front().g += 0.01; }},
      {"g_back", [](Medium& m) { m.mie_phase.front().g_back += 0.01; }},
      {"back_weight", [](Medium& m) { m.mie_phase.front().back_weight += 0.01; }},
      {"alpha", [](Medium& m) { m.mie_phase.front().alpha -= 0.01; }},
      {"ozone", [](Medium& m) { m.ozone_absorption_per_m[2] *= 1.1; }},
      {"ozone shape", [](Medium& m) { m.ozone.shape = OzoneShape::kTent; }},
      {"ozone bottom", [](Medium& m) { m.ozone.bottom_m += 1.0; }},
      {"ozone peak", [](Medium& m) { m.ozone.peak_m += 1.0; }},
      {"ozone top", [](Medium& m) { m.ozone.top_m += 1.0; }},
  };
}

TEST(Medium, HashDependsOnEverythingThatChangesLight) {
  const std::uint64_t hash = MediumHash(MediumPreset("earth"));
  std::set<std::uint64_t> hashes{hash};
  for (const Change& change : HashedChanges()) {
    Medium medium = MediumPreset("earth");
    change.make(medium);
    EXPECT_TRUE(hashes.insert(MediumHash(medium)).second) << change.key;
  }
  Medium same = MediumPreset("earth");
  same.name = "home";
  same.refraction = RefractionBy::kMolecules;
  EXPECT_EQ(MediumHash(same), hash);
}

TEST(Medium, OneValueForAllBandsEqualsItsCopies) {
  Medium one = MediumPreset("earth");
  one.mie_phase = {PhaseFunction{}};
  one.rayleigh_depolarisation = {0.03};
  Medium copies = one;
  copies.mie_phase.resize(one.wavelengths_nm.size(), one.mie_phase.front());
  copies.rayleigh_depolarisation.assign(4, 0.03);
  EXPECT_EQ(MediumHash(one), MediumHash(copies));
  EXPECT_EQ(RayleighPhaseValues(one, 0.3), RayleighPhaseValues(copies, 0.3));
  copies.mie_phase[2].g += 0.01;
  EXPECT_NE(MediumHash(one), MediumHash(copies));
  EXPECT_EQ(MiePhaseValues(one, 0.3), std::vector<double>(4, Phase(one.mie_phase[0], 0.3)));
  EXPECT_EQ(MiePhaseValues(copies, 0.3)[2], Phase(copies.mie_phase[2], 0.3));
}

TEST(Medium, MoleculesScatterAsInHansenAndTravis) {
  const Medium air = MediumPreset("earth");
  EXPECT_EQ(RayleighPhaseValues(InScalarLight(air), 0.3),
            std::vector<double>(4, Phase({.kind = PhaseKind::kRayleigh}, 0.3)));
  for (const double cosine : {-1.0, -0.4, 0.0, 0.7, 1.0}) {
    for (std::size_t band = 0; band < 4; ++band) {
      EXPECT_NEAR(RayleighPhaseValues(air, cosine)[band],
                  RayleighMatrix(Depolarisation(air, band), cosine).a1, 1e-15);
    }
  }
}

TEST(Medium, GasOfEarthIsAirAndOfMarsCarbonDioxide) {
  EXPECT_EQ(GasDepolarisation("earth", {550.0})[0], AirDepolarisation(550.0));
  const double d = GasDepolarisation("mars", {550.0})[0];
  EXPECT_NEAR((6.0 + 3.0 * d) / (6.0 - 7.0 * d), 1.15, 1e-12)
      << "the King factor of its scattering";
}

TEST(Medium, HashIsTheSameOnEveryMachine) {
  // The medium has literals only, so that no library's pow can change it. The value is from a
  // separate program.
  EXPECT_EQ(MediumHash(MediumPreset("bruneton2017")), 3681725893479617410U)
      << "a new value here makes every table on every disk stale";
  Medium negative_zero = MediumPreset("bruneton2017");
  negative_zero.mie_phase.front().g_back = -0.0;
  EXPECT_EQ(MediumHash(negative_zero), MediumHash(MediumPreset("bruneton2017")));
}

TEST(Medium, FirstFaultNamesKeyValueAndRange) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Change faults[] = {
      {"planet.radius_m is nan; it must lie in [1000, 100000000]",
       [](Medium& m) { m.planet_radius_m = kNan; }},
      {"planet.atmosphere_top_m is 0", [](Medium& m) { m.atmosphere_height_m = 0.0; }},
      {"planet.ground_albedo is 1.5; it must lie in [0, 1]",
       [](Medium& m) { m.ground_albedo[2] = 1.5; }},
      {"spectrum.wavelengths_nm is 199", [](Medium& m) { m.wavelengths_nm[0] = 199.0; }},
      {"spectrum.wavelengths_nm has 525 after 525", [](Medium& m) { m.wavelengths_nm[0] = 525.0; }},
      {"spectrum.solar_irradiance is -1", [](Medium& m) { m.solar_irradiance[0] = -1.0; }},
      {"rayleigh.scattering_per_m is inf",
       [](Medium& m) { m.rayleigh_scattering_per_m[3] = kInfinity; }},
      {"rayleigh.scattering_per_m has 3 values; it must have 4",
       [](Medium& m) { m.rayleigh_scattering_per_m.pop_back(); }},
      {"rayleigh.scale_height_m is 0.5", [](Medium& m) { m.rayleigh_scale_height_m = 0.5; }},
      {"rayleigh.deficit is -0.1", [](Medium& m) { m.rayleigh_deficit.share = -0.1; }},
      {"rayleigh.deficit_scale_height_m is 1000",
       [](Medium& m) {
         m.rayleigh_deficit = {0.4, 1e3};
       }},
      {"rayleigh.deficit_scale_height_m is 9000",
       [](Medium& m) {
         m.rayleigh_deficit = {0.4, 9e3};
       }},
      {"rayleigh.depolarisation is 0.6; it must lie in [0, 0.5]",
       [](Medium& m) { m.rayleigh_depolarisation = {0.6}; }},
      {"rayleigh.depolarisation has 2 values; it must have 1 or 4",
       [](Medium& m) {
         m.rayleigh_depolarisation = {0.03, 0.03};
       }},
      {"mie.scale_height_m is 300000", [](Medium& m) { m.mie_scale_height_m = 3e5; }},
      {"mie.scattering_per_m is 1 at 445 nm; it must not exceed",
       [](Medium& m) { m.mie_scattering_per_m[0] = 1.0; }},
      {"mie.g is 1;", [](Medium& m) { m.mie_phase.front().g = 1.0; }},
      {"mie.phase has 2 values; it must have 1 or 4",
       [](Medium& m) { m.mie_phase.push_back(m.mie_phase.front()); }},
      {"mie.phase is rayleigh beside cornette-shanks",
       [](Medium& m) {
         m.mie_phase.resize(4, m.mie_phase.front());
         m.mie_phase[1].kind = PhaseKind::kRayleigh;
       }},
      {"mie.phase is table; it needs values",
       [](Medium& m) { m.mie_phase.front().kind = PhaseKind::kTable; }},
      {"ozone.absorption_per_m is -1", [](Medium& m) { m.ozone_absorption_per_m[0] = -1.0; }},
      {"ozone.peak_m is 50000; it must lie between",
       [](Medium& m) {
         m.ozone = {10e3, 50e3, 40e3};
       }},
      {"ozone.profile is smooth; its bottom is 0", [](Medium& m) { m.ozone.top_m = 5e4; }},
  };
  for (const Change& fault : faults) {
    Medium medium = MediumPreset("earth");
    medium.mie_phase = {PhaseFunction{}};
    fault.make(medium);
    const std::string message = FaultOf([&] { Validate(medium); });
    EXPECT_THAT(message, HasSubstr(fault.key));
    ASSERT_TRUE(FindFault(medium).has_value()) << fault.key;
    EXPECT_EQ(message.rfind(FindFault(medium)->key, 0), 0U) << message;
  }
}

// Hard case 28.
TEST(Medium, EmptyAirIsValid) {
  EXPECT_EQ(FindFault(tests::WithoutAir(MediumPreset("earth"))), std::nullopt);
}

TEST(Medium, LimitsOfLengthsKeepClosedFormsAccurate) {
  // The changed medium is bruneton2017: a tent of ozone, one exponential of molecules.
  const Change changes[] = {
      // 25 scale heights of 8 km are the smallest radius.
      {"", [](Medium& m) { m.planet_radius_m = 200e3; }},
      {"planet.radius_m is 199000; with rayleigh.scale_height_m 8000 it must lie in [200000, "
       "100000000]",
       [](Medium& m) { m.planet_radius_m = 199e3; }},
      {"", [](Medium& m) { m.planet_radius_m = 1e8; }},
      {"planet.radius_m is 101000000; it must lie in",
       [](Medium& m) { m.planet_radius_m = 1.01e8; }},
      {"with mie.scale_height_m 50000 it must lie in [1250000, 100000000]",
       [](Medium& m) {
         m.planet_radius_m = 1e6;
         m.mie_scale_height_m = 50e3;
       }},
      {"planet.radius_m is 201000; with the smooth ozone layer of ozone.peak_m 30000 it must lie "
       "in [270000, ",
       [](Medium& m) {
         m.planet_radius_m = 201e3;
         m.ozone = SmoothOzone(30e3);
         m.atmosphere_height_m = 90e3;
       }},
      // The tent of ozone ends at 40 km. Ozone that absorbs nothing may lie anywhere.
      {"", [](Medium& m) { m.atmosphere_height_m = 40e3; }},
      {"planet.atmosphere_top_m is 39000; with ozone up to 40000 it must lie in [40000, 2400000]",
       [](Medium& m) { m.atmosphere_height_m = 39e3; }},
      {"", [](Medium& m) { m.atmosphere_height_m = 2.4e6; }},
      {"planet.atmosphere_top_m is 2500000; with rayleigh.scale_height_m 8000 it must lie in "
       "[40000, 2400000]",
       [](Medium& m) { m.atmosphere_height_m = 2.5e6; }},
      {"",
       [](Medium& m) {
         m.atmosphere_height_m = 10e3;
         m.ozone_absorption_per_m.assign(3, 0.0);
       }},
      {"with rayleigh.deficit_scale_height_m 6000 it must lie in [48000, ",
       [](Medium& m) {
         m.rayleigh_deficit = {0.3, 6e3};
         m.atmosphere_height_m = 47e3;
       }},
      {"mie.scale_height_m is 1; it must lie in [100, 200000]",
       [](Medium& m) { m.mie_scale_height_m = 1.0; }},
      {"", [](Medium& m) { m.mie_scale_height_m = 100.0; }},
      {"", [](Medium& m) { m.mie_scale_height_m = 200e3; }},  // 32 of them are the earth's radius
      {"mie.scale_height_m is 201000", [](Medium& m) { m.mie_scale_height_m = 201e3; }},
      {"rayleigh.scale_height_m is 1; it must lie in [100, 200000]",
       [](Medium& m) { m.rayleigh_scale_height_m = 1.0; }},
  };
  for (const auto& [message, make] : changes) {
    Medium medium = MediumPreset("bruneton2017");
    make(medium);
    const auto fault = FindFault(medium);
    EXPECT_EQ(fault.has_value(), *message != '\0') << message;
    if (fault) {
      EXPECT_THAT(fault->text, HasSubstr(message));
    }
  }
}

TEST(MediumBands, OfAPresetEqualThePresetAtThoseWavelengths) {
  for (const char* name : {"earth", "hazy", "clear-mountain", "mars"}) {
    const auto four = OnBands(MediumPreset(name, WavelengthSet(16)), 4);
    ASSERT_TRUE(four.has_value()) << name;
    EXPECT_EQ(*four, MediumPreset(name, WavelengthSet(4))) << name;
  }
}

TEST(MediumBands, KeepFactorsOfAllWavelengthsExactly) {
  const auto text = [](int bands) {
    return MediumFromToml("preset = \"earth\"\n[ozone]\ndobson = 450\n[spectrum]\nbands = " +
                              std::to_string(bands) + "\n",
                          "a.toml");
  };
  const auto eight = OnBands(text(4), 8);
  ASSERT_TRUE(eight.has_value());
  const Medium expected = text(8);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_NEAR(eight->ozone_absorption_per_m[i] / expected.ozone_absorption_per_m[i], 1.0, 1e-12);
    EXPECT_EQ(eight->solar_irradiance[i], expected.solar_irradiance[i]);
  }
}

TEST(MediumBands, DepolarisationIsThatOfTheGasOrInterpolated) {
  const auto polarised = [](int bands) { return MediumPreset("earth", WavelengthSet(bands)); };
  const auto four = OnBands(polarised(16), 4);
  ASSERT_TRUE(four.has_value());
  EXPECT_EQ(*four, polarised(4));
  Medium own = polarised(4);
  own.rayleigh_depolarisation = {0.0, 0.1, 0.2, 0.3};
  const auto eight = OnBands(own, 8);
  ASSERT_TRUE(eight.has_value());
  ASSERT_EQ(eight->rayleigh_depolarisation.size(), 8U);
  for (std::size_t i = 1; i < 8; ++i)
    EXPECT_GE(eight->rayleigh_depolarisation[i], eight->rayleigh_depolarisation[i - 1]);
  own.rayleigh_depolarisation = {0.05};
  EXPECT_EQ(OnBands(own, 8)->rayleigh_depolarisation, std::vector<double>{0.05});
}

TEST(MediumBands, AreAbsentWithoutKnownSpectra) {
  EXPECT_FALSE(OnBands(MediumPreset("bruneton2017"), 8).has_value());
  Medium own = MediumPreset("earth");
  own.name = "my own";
  EXPECT_FALSE(OnBands(own, 8).has_value());
}

}  // namespace
}  // namespace alpenglow::atmosphere
