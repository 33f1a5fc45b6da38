// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/base/text_file.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/medium/aerosol_mixture.h"
#include "atmosphere/medium/atmosphere_file.h"
#include "atmosphere/medium/medium.h"
#include "atmosphere/medium/medium_fields.h"
#include "atmosphere/medium/phase_forms.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/places.h"
#include "tests/fixtures/toml_keys.h"

namespace alpenglow::atmosphere {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

Medium Read(const std::string& text) { return MediumFromToml(text, "a.toml"); }

std::string FileFaultOf(const std::string& text) {
  return tests::FaultOf([&] { return Read(text); });
}

// The example of the manual gives everything, with wavelengths from red to blue.
constexpr const char* kComplete = R"(preset = "bruneton2017"
[planet]
radius_m = 6360000.0
atmosphere_top_m = 60000.0              # height of the top above the ground
ground_albedo = 0.1                     # one value or one per wavelength
[spectrum]
wavelengths_nm = [680.0, 550.0, 440.0]
solar_irradiance = [1.474, 1.8504, 1.91198]        # W m^-2 nm^-1 at the top, 1 au
[rayleigh]
scattering_per_m = [5.802e-6, 13.558e-6, 33.1e-6]  # at the ground; one per wavelength
scale_height_m = 8000.0
[mie]
scattering_per_m = [3.996e-6, 3.996e-6, 3.996e-6]
extinction_per_m = [4.440e-6, 4.440e-6, 4.440e-6]
scale_height_m = 1200.0
phase = "cornette-shanks"
g = 0.8
[ozone]                                 # tent profile
absorption_per_m = [0.650e-6, 1.881e-6, 0.085e-6]  # at the peak
bottom_m = 10000.0
peak_m = 25000.0
top_m = 40000.0
)";

TEST(AtmosphereFile, AnEmptyFileIsTheEarth) {
  EXPECT_EQ(Read(""), MediumPreset("earth"));
  EXPECT_EQ(Read("# only a comment\n[planet]\n"), MediumPreset("earth"));
  EXPECT_EQ(Read("\xef\xbb\xbfpreset = \"hazy\"\r\n"), MediumPreset("hazy"))
      << "a byte order mark and CRLF are harmless";
  EXPECT_FALSE(Read("[planet]\nradius_m = 6371000\n").follows_wgs84) << "a radius means a sphere";
  EXPECT_TRUE(Read("[planet]\nradius_m = 6371000\nfollows_wgs84 = true\n").follows_wgs84);
}

TEST(AtmosphereFile, DescendingListsAreReversed) {
  EXPECT_EQ(Read(kComplete), MediumPreset("bruneton2017"));
  const std::string spectrum = "[spectrum]\nwavelengths_nm = ";
  const std::pair<std::string, std::string> ascending_and_descending[] = {
      {"[450, 550]\nsolar_irradiance = [2.0, 1.8]\n[planet]\nground_albedo = [0.1, 0.2]\n",
       "[550, 450]\nsolar_irradiance = [1.8, 2.0]\n[planet]\nground_albedo = [0.2, 0.1]\n"},
      {"[450, 550, 650]\n[mie]\nphase = \"double-henyey-greenstein\"\ng = [0.9, 0.8, 0.7]\n"
       "g_back = [-0.1, -0.2, -0.3]\nback_weight = [0.1, 0.2, 0.3]\n",
       "[650, 550, 450]\n[mie]\nphase = \"double-henyey-greenstein\"\ng = [0.7, 0.8, 0.9]\n"
       "g_back = [-0.3, -0.2, -0.1]\nback_weight = [0.3, 0.2, 0.1]\n"},
      {"[450, 550, 650]\n[mie]\nphase = \"draine\"\ng = 0.5\nalpha = [0.1, 0.2, 0.3]\n",
       "[650, 550, 450]\n[mie]\nphase = \"draine\"\ng = 0.5\nalpha = [0.3, 0.2, 0.1]\n"}};
  for (const auto& [ascending, descending] : ascending_and_descending) {
    EXPECT_EQ(Read(spectrum + descending), Read(spectrum + ascending)) << ascending;
    EXPECT_EQ(MediumHash(Read(spectrum + descending)), MediumHash(Read(spectrum + ascending)));
  }
  EXPECT_EQ(Read(spectrum + ascending_and_descending[0].second).ground_albedo,
            (std::vector<double>{0.1, 0.2}));
  EXPECT_EQ(Read(spectrum + ascending_and_descending[1].second).mie_phase.front().g_back, -0.1)
      << "at 450 nm";
}

TEST(AtmosphereFile, MissingKeysHaveTheValuesOfThePreset) {
  const Medium medium = Read("preset = \"hazy\"\n[mie]\nscale_height_m = 2000\n");
  Medium expected = MediumPreset("hazy");
  expected.mie_scale_height_m = 2000.0;
  expected.name = "custom (from hazy)";
  EXPECT_EQ(medium, expected);
}

TEST(AtmosphereFile, BandsChooseTheWavelengths) {
  for (const int bands : kWavelengthSetSizes) {
    const Medium medium = Read("[spectrum]\nbands = " + std::to_string(bands) + "\n");
    EXPECT_EQ(medium.wavelengths_nm, WavelengthSet(bands));
  }
}

TEST(AtmosphereFile, PolarisationIsThePresetsUnlessGiven) {
  EXPECT_TRUE(Read("").polarised);
  EXPECT_FALSE(Read("preset = \"bruneton2017\"\n").polarised) << "as others have it";
  EXPECT_EQ(Read("polarised = true\n"), MediumPreset("earth"));
  for (const char* preset : {"earth", "mars", "bruneton2017"}) {
    const auto read = [preset](const std::string& polarised) {
      return Read("polarised = " + polarised + "\npreset = \"" + preset + "\"\n");
    };
    const Medium here = MediumPreset(preset);
    EXPECT_EQ(MediumHash(read("true")), MediumHash(InPolarisedLight(here, preset))) << preset;
    EXPECT_EQ(MediumHash(read("false")), MediumHash(InScalarLight(here))) << preset;
  }
  EXPECT_EQ(Read("[rayleigh]\ndepolarisation = 0.04\n").rayleigh_depolarisation,
            std::vector<double>{0.04});
  const Medium reversed = Read(
      "polarised = false\n[spectrum]\nwavelengths_nm = [600, 500]\n"
      "[rayleigh]\ndepolarisation = [0.01, 0.02]\n");
  EXPECT_EQ(reversed.rayleigh_depolarisation, (std::vector<double>{0.02, 0.01}));
  EXPECT_FALSE(reversed.polarised) << "a shape of scattering of its own";
}

TEST(AtmosphereFile, AScaleHeightGivesMoleculesOneExponential) {
  EXPECT_EQ(Read("[rayleigh]\nscale_height_m = 7000\n").rayleigh_deficit, MoleculeDeficit{});
  const Medium both =
      Read("[rayleigh]\nscale_height_m = 7000\ndeficit = 0.3\ndeficit_scale_height_m = 2500\n");
  EXPECT_EQ(both.rayleigh_deficit, (MoleculeDeficit{0.3, 2500.0}));
  EXPECT_NEAR(MoleculeColumn_m(both), 1.3 * 7000.0 - 0.3 * 2500.0, 1e-9);
  EXPECT_NEAR(MoleculeDensity(both, 5000.0), 1.3 * std::exp(-5.0 / 7.0) - 0.3 * std::exp(-2.0),
              1e-15);
}

TEST(AtmosphereFile, RefractionIsThatOfAlmanacsUnlessDensityIsGiven) {
  EXPECT_EQ(Read("[rayleigh]\nrefraction = \"molecules\"\n").refraction, RefractionBy::kMolecules);
  EXPECT_EQ(Read("[mie]\nscale_height_m = 1000\n").refraction, RefractionBy::kAlmanacs);
  EXPECT_EQ(Read("[rayleigh]\nscale_height_m = 7000\n").refraction, RefractionBy::kMolecules);
  EXPECT_EQ(Read("[rayleigh]\nscale_height_m = 7000\nrefraction = \"almanacs\"\n").refraction,
            RefractionBy::kAlmanacs);
  EXPECT_EQ(Read("preset = \"mars\"\n").refraction, RefractionBy::kMolecules);
}

TEST(AtmosphereFile, VisibilityIsTheDistanceOfTwoPercentContrast) {
  const Medium medium =
      Read("[spectrum]\nwavelengths_nm = [550]\n[aerosol]\nvisibility_m = 23000\n");
  const double extinction = medium.mie_extinction_per_m[0] + medium.rayleigh_scattering_per_m[0];
  EXPECT_NEAR(std::exp(-23000.0 * extinction), 0.02, 1e-5) << "3.912 has four digits";
  const Medium four =
      Read("[spectrum]\nwavelengths_nm = [450, 500, 590, 650]\n[aerosol]\nvisibility_m = 23000\n");
  const double at_550 = four.mie_extinction_per_m[1] * std::pow(550.0 / 500.0, -1.3);
  EXPECT_NEAR(at_550, medium.mie_extinction_per_m[0], 1e-4 * at_550)
      << "molecules at 550 nm are interpolated between the bands";
}

TEST(AtmosphereFile, TurbidityIsOpticalDepthRelativeToCleanAir) {
  const Medium medium = Read("[spectrum]\nwavelengths_nm = [550]\n[aerosol]\nturbidity = 3\n");
  const double aerosol = medium.mie_extinction_per_m[0] * medium.mie_scale_height_m;
  const double molecules = medium.rayleigh_scattering_per_m[0] * MoleculeColumn_m(medium);
  EXPECT_NEAR((aerosol + molecules) / molecules, 3.0, 1e-12);
}

TEST(AtmosphereFile, OpticalDepthAndExponentKeepTheAlbedo) {
  const Medium medium = Read(
      "[spectrum]\nwavelengths_nm = [450, 550]\n[mie]\nscale_height_m = 2000\n"
      "[aerosol]\noptical_depth_550 = 0.1\nangstrom_exponent = 0.5\n");
  EXPECT_NEAR(medium.mie_extinction_per_m[1] * 2000.0, 0.1, 1e-15);
  EXPECT_NEAR(medium.mie_extinction_per_m[0] / medium.mie_extinction_per_m[1],
              std::pow(450.0 / 550.0, -0.5), 1e-12);
  EXPECT_NEAR(medium.mie_scattering_per_m[1] / medium.mie_extinction_per_m[1], 0.9253, 1e-12);
  const Medium grey = Read("[aerosol]\noptical_depth_550 = 0.1\nsingle_scattering_albedo = 1\n");
  EXPECT_EQ(grey.mie_scattering_per_m, grey.mie_extinction_per_m);
}

TEST(AtmosphereFile, DobsonUnitsSetTheColumnOfTheLayer) {
  const Medium thin = Read("[ozone]\ndobson = 150\n");
  const Medium narrow = Read("[ozone]\ndobson = 300\nbottom_m = 20000\ntop_m = 35000\n");
  const Medium earth = MediumPreset("earth");
  for (std::size_t i = 0; i < earth.wavelengths_nm.size(); ++i) {
    EXPECT_NEAR(thin.ozone_absorption_per_m[i], earth.ozone_absorption_per_m[i] / 2.0, 1e-18);
    EXPECT_NEAR(narrow.ozone_absorption_per_m[i],
                earth.ozone_absorption_per_m[i] * EquivalentDepth_m(earth.ozone) / 7500.0, 1e-18);
  }
}

TEST(AtmosphereFile, OzoneProfilesAreSmoothOrATent) {
  const Medium earth = MediumPreset("earth");
  EXPECT_EQ(Read("[ozone]\nprofile = \"tent\"\n").ozone, OzoneLayer{});
  EXPECT_EQ(Read("[ozone]\nbottom_m = 12000\n").ozone, (OzoneLayer{12e3, 25e3, 40e3}));
  EXPECT_EQ(Read("[ozone]\npeak_m = 20000\n").ozone, SmoothOzone(20000.0));
  EXPECT_EQ(Read("preset = \"bruneton2017\"\n[ozone]\nprofile = \"smooth\"\n").ozone,
            SmoothOzone());
  const Medium tent = Read("[ozone]\nprofile = \"tent\"\n");
  EXPECT_NEAR(tent.ozone_absorption_per_m[1] * 15000.0,
              earth.ozone_absorption_per_m[1] * EquivalentDepth_m(earth.ozone), 1e-12)
      << "another profile keeps the column";
}

TEST(AtmosphereFile, PhaseParametersNeedTheirPhaseFunction) {
  const Medium medium = Read(
      "[mie]\nphase = \"double-henyey-greenstein\"\ng = 0.9\ng_back = -0.2\nback_weight = 0.1\n");
  EXPECT_EQ(medium.mie_phase.front().kind, PhaseKind::kDoubleHenyeyGreenstein);
  EXPECT_EQ(medium.mie_phase.front().g_back, -0.2);
  EXPECT_EQ(Read("[mie]\ng = 0.7\n").mie_phase.front().g, 0.7);
  EXPECT_EQ(Read("[mie]\nphase = \"rayleigh\"\n").mie_phase.front().kind, PhaseKind::kRayleigh);
}

// Such files were written when the presets of the earth had one lobe.
TEST(AtmosphereFile, ALobeMayReplaceTheTableOfAPreset) {
  const Medium lobe = Read("[mie]\ng = 0.76\n");
  EXPECT_EQ(lobe.mie_phase,
            (std::vector<PhaseFunction>{{.kind = PhaseKind::kCornetteShanks, .g = 0.76}}));
  EXPECT_EQ(Read("[mie]\nphase = \"cornette-shanks\"\ng = 0.76\n").mie_phase, lobe.mie_phase);
  const Medium of_preset = Read("[mie]\nphase = \"cornette-shanks\"\n");
  EXPECT_EQ(of_preset.mie_phase.size(), 1U);
  EXPECT_NEAR(MeanCosine(of_preset.mie_phase.front()), 0.7034, 7e-4) << "OPAC's, at 550 nm";
  const Medium infrared = Read(
      "[spectrum]\nwavelengths_nm = [1000]\nsolar_irradiance = [0.7]\n[planet]\n"
      "ground_albedo = [0.2]\n[rayleigh]\nscattering_per_m = [1e-6]\n[mie]\n"
      "scattering_per_m = [1e-5]\nextinction_per_m = [1e-5]\n[ozone]\nabsorption_per_m = [0]\n");
  EXPECT_EQ(infrared.mie_phase, AerosolPhase("earth", {1000.0})) << "as at 650 nm";
}

TEST(AtmosphereFile, PhaseParametersMayBeOnePerWavelength) {
  const Medium medium = Read(
      "[spectrum]\nwavelengths_nm = [650, 550, 450]\n[mie]\nphase = "
      "\"double-henyey-greenstein\"\ng = [0.8, 0.85, 0.9]\ng_back = -0.2\nback_weight = 0.1\n");
  ASSERT_EQ(medium.mie_phase.size(), 3U);
  EXPECT_EQ(medium.mie_phase[0].g, 0.9) << "450 nm: lists that descend are stored ascending";
  EXPECT_EQ(MiePhase(medium, 2).g, 0.8);
  EXPECT_EQ(MiePhase(medium, 2).g_back, -0.2);
  EXPECT_EQ(Read("[mie]\ng = [0.7, 0.7, 0.7, 0.7]\n").mie_phase.size(), 1U)
      << "four times the same is one for all";
}

TEST(AtmosphereFile, FogIsDefinedByItsDroplets) {
  const Medium medium = Read("[mie]\nphase = \"fog\"\ndroplet_diameter_um = 12\n");
  EXPECT_EQ(medium.mie_phase.front(), DropletPhase(12.0));
}

TEST(AtmosphereFile, APhaseFunctionMayBeAFileNextToTheAtmosphere) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / "alpenglow_phase_file";
  std::filesystem::create_directory(folder);
  {
    std::ofstream csv(folder / "dust.csv");
    csv << "wavelength_nm,angle_deg,phase_per_sr\n";
    for (const double wavelength : {400, 700}) {
      for (int angle = 0; angle <= 180; angle += 3) {
        const double c = std::cos(angle * 3.14159265358979 / 180.0);
        csv << wavelength << ',' << angle << ','
            << Phase(tests::LobeOf(wavelength < 500 ? 0.3 : 0.5), c) << '\n';
      }
    }
    std::ofstream(folder / "a.toml") << "[mie]\nphase = \"table\"\nphase_file = \"dust.csv\"\n";
    std::ofstream(folder / "b.toml") << "[mie]\nphase = \"table\"\nphase_file = \"none.csv\"\n";
  }
  const Medium medium = ReadMedium(folder / "a.toml");
  ASSERT_EQ(medium.mie_phase.size(), medium.wavelengths_nm.size());
  const double at_445 = (445.0 - 400.0) / 300.0;
  EXPECT_NEAR(MeanCosine(medium.mie_phase[0]), 0.3 + 0.2 * at_445, 1e-3)
      << "linear between 400 and 700 nm";
  EXPECT_THROW(static_cast<void>(ReadMedium(folder / "b.toml")), InputError);
  std::filesystem::remove_all(folder);
}

TEST(AtmosphereFile, AMixtureSetsSpectrumLayerAndPhaseFunction) {
  const Medium desert = Read("[aerosol]\nmixture = \"desert\"\n");
  const AerosolOptics optics = AerosolMixture("desert", desert.wavelengths_nm);
  EXPECT_EQ(desert.mie_extinction_per_m, optics.extinction_per_m);
  EXPECT_EQ(desert.mie_scattering_per_m, optics.scattering_per_m);
  EXPECT_EQ(desert.mie_scale_height_m, optics.scale_height_m);
  EXPECT_EQ(desert.mie_phase, optics.phase);
}

TEST(AtmosphereFile, AmountOfAMixtureMayBeGivenByAnyKey) {
  const std::string mixture = "mixture = \"maritime_clean\"\n";
  const std::string green = "[spectrum]\nwavelengths_nm = [450, 550, 650]\n[aerosol]\n" + mixture;
  const Medium own = Read(green);
  const Medium thin = Read(green + "optical_depth_550 = 0.1\n");
  EXPECT_NEAR(thin.mie_extinction_per_m[1] * thin.mie_scale_height_m, 0.1, 1e-15);
  EXPECT_NEAR(thin.mie_extinction_per_m[0] / thin.mie_extinction_per_m[2],
              own.mie_extinction_per_m[0] / own.mie_extinction_per_m[2], 1e-13)
      << "the spectrum is the mixture's";
  const Medium hazy = Read(green + "visibility_m = 20000\n");
  EXPECT_NEAR(
      std::exp(-20000.0 * (hazy.mie_extinction_per_m[1] + hazy.rayleigh_scattering_per_m[1])), 0.02,
      1e-5)
      << "Koschmieder: a black wall at the visibility keeps 2 % of its contrast";
  const Medium turbid = Read(green + "turbidity = 3\n");
  EXPECT_NEAR(turbid.mie_extinction_per_m[1] * turbid.mie_scale_height_m,
              2.0 * turbid.rayleigh_scattering_per_m[1] * MoleculeColumn_m(turbid), 1e-12);
  const Medium fog =
      Read("[mie]\nphase = \"fog\"\ndroplet_diameter_um = 10\n[aerosol]\n" + mixture);
  EXPECT_EQ(fog.mie_phase.front(), DropletPhase(10.0)) << "[mie] may say otherwise";
}

TEST(AtmosphereFile, WavelengthsBeyondThePresetsDataNeedLists) {
  const Medium infrared = Read(
      "[spectrum]\nwavelengths_nm = [900]\nsolar_irradiance = [0.91]\n[planet]\nground_albedo = "
      "0.3\n"
      "[rayleigh]\nscattering_per_m = [1.56e-6]\n"
      "[aerosol]\noptical_depth_550 = 0.1\nsingle_scattering_albedo = 0.9\n[ozone]\ndobson = "
      "300\n");
  EXPECT_EQ(infrared.wavelengths_nm, std::vector<double>{900.0});
  EXPECT_EQ(infrared.ozone_absorption_per_m, std::vector<double>{0.0});
}

struct BadInput {
  const char* text;
  const char* message;
};

TEST(AtmosphereFile, ContradictingLimitsNameBothCauses) {
  const BadInput inputs[] = {
      {"# a thin atmosphere\npreset = \"earth\"\n[rayleigh]\nscale_height_m = 100\n",
       "a.toml:4: planet.atmosphere_top_m is 120000, but no value is possible: with ozone up to "
       "66000 it must be at least 59400, and with rayleigh.scale_height_m 100 at most 30000; raise "
       "rayleigh.scale_height_m to 198 or more, or lower ozone.peak_m to 11111.1 or leave out "
       "ozone (ozone.dobson = 0)"},
      {"[planet]\natmosphere_top_m = 50000\n[rayleigh]\nscale_height_m = 100\n",
       "a.toml:2: planet.atmosphere_top_m is 50000, but no value is possible"},
      {"[ozone]\npeak_m = 2e6\n[planet]\nradius_m = 6e7\n",
       "a.toml:2: planet.atmosphere_top_m is 120000, but no value is possible: with ozone up to "
       "6000000 it must be at least 5400000, and with rayleigh.scale_height_m "},
      {"[rayleigh]\nscale_height_m = 150\ndeficit = 0.5\ndeficit_scale_height_m = 140\n[ozone]\n"
       "profile = \"tent\"\ntop_m = 60000\n",
       "a.toml:2: planet.atmosphere_top_m is 120000, but no value is possible: with ozone up to "
       "60000 it must be at least 60000, and with rayleigh.scale_height_m 150 at most 45000; raise "
       "rayleigh.scale_height_m to 200 or more, or lower ozone.top_m to 45000"},
      {"[ozone]\nbottom_m = 50000\n", "a.toml:2: ozone.top_m is 40000 and ozone.bottom_m 50000"}};
  for (const BadInput& input : inputs)
    EXPECT_THAT(FileFaultOf(input.text), HasSubstr(input.message)) << input.text;
  // The change that the message proposes is accepted.
  for (const char* ozone : {"dobson = 0", "peak_m = 11111.1"}) {
    EXPECT_EQ(FileFaultOf("[planet]\natmosphere_top_m = 30000\n[rayleigh]\nscale_height_m = 100\n"
                          "[ozone]\n" +
                          std::string(ozone) + "\n"),
              "no fault");
  }
}

/// Expects that a key refuses values that it does not accept, and that a mistyped key is refused.
/// @param section  the line above the key, if it is not a key of the top level.
void ExpectRefusals(const TomlKey& key, const std::string& section, const std::string& name) {
  const int line = section.empty() ? 1 : 2;
  for (const auto& [value, fault] : tests::RefusedValues(key, name)) {
    EXPECT_EQ(FileFaultOf(fmt::format("{}{} = {}\n", section, key.key, value)),
              fmt::format("a.toml:{}: {}", line, fault));
  }
  EXPECT_EQ(FileFaultOf(fmt::format("{}{}q = 1\n", section, key.key)),
            fmt::format("a.toml:{}: unknown key {}q; did you mean {}?", line, name, key.key));
}

TEST(AtmosphereFile, EveryKeyRefusesInvalidValues) {
  for (const TomlKey& key : TopFieldsOfMedium().Keys()) ExpectRefusals(key, "", key.key);
  for (const TomlFields<Medium>& section : SectionsOfMedium()) {
    for (const TomlKey& key : section.Keys())
      ExpectRefusals(key, fmt::format("[{}]\n", section.name), section.name + "." + key.key);
  }
}

TEST(AtmosphereFile, TheManualHasTheTablesOfKeys) {
  const std::string manual = ReadTextFile(std::filesystem::path(tests::kSourceFolder) /
                                          "atmosphere" / "ATMOSPHERE_FILE.md");
  EXPECT_THAT(tests::Between(manual, "## Top level\n\n", "\n\n") + "\n",
              tests::MarkdownTable(TopFieldsOfMedium().Keys()));
  for (const TomlFields<Medium>& section : SectionsOfMedium()) {
    const std::string text =
        tests::Between(manual, fmt::format("## `[{}]`", section.name), "\n## ");
    EXPECT_THAT(text + "\n", HasSubstr("\n" + tests::MarkdownTable(section.Keys())));
  }
}

TEST(AtmosphereFile, TheManualHasTheParametersOfEveryPhaseFunction) {
  const std::string manual = ReadTextFile(std::filesystem::path(tests::kSourceFolder) /
                                          "atmosphere" / "ATMOSPHERE_FILE.md");
  for (const PhaseForm& form : PhaseForms()) {
    if (form.kind == PhaseKind::kTable) continue;
    std::vector<std::string> keys;
    for (const PhaseParameter& parameter : form.parameters)
      keys.push_back(fmt::format("`{}`", parameter.key));
    EXPECT_THAT(manual, HasSubstr(fmt::format(
                            "\n| `{}` | {} |\n", form.name,
                            keys.empty() ? "none" : fmt::format("{}", fmt::join(keys, ", ")))));
  }
}

TEST(AtmosphereFile, EveryKeyExceptRefractionChangesTheHash) {
  Medium earth = MediumPreset("earth");
  earth.rayleigh_deficit.share = 0.5;
  for (const TomlFields<Medium>& section : SectionsOfMedium()) {
    for (const TomlField<Medium>& field : section.fields) {
      if (!field.member.set) continue;
      EXPECT_EQ(MediumHash(tests::WithAnotherValue(field, earth)) == MediumHash(earth),
                field.key == "refraction")
          << section.name << "." << field.key;
    }
  }
}

TEST(AtmosphereFile, BadInputsAreRefusedWithFileLineKeyAndRange) {
  const BadInput inputs[] = {
      {"[spectrum]\nbands = 7\n",
       "a.toml:2: spectrum.bands is 7; it must be one of 3, 4, 5, 6, 8, 16, 40"},
      {"[spectrum]\nbands = 4\nwavelengths_nm = [500]\n", "give one of"},
      {"[rayleigh]\nscale_height_m = 7000\ndeficit_scale_height_m = 2500\n", "no effect"},
      {"[aerosol]\nvisibility_m = 400000\n", "the molecules alone limit it to 340"},
      {"[aerosol]\nturbidity = 2\nvisibility_m = 23000\n",
       "a.toml:2: aerosol.turbidity is given beside aerosol.visibility_m"},
      {"[aerosol]\nangstrom_exponent = 1\n", "aerosol needs mixture or one of"},
      {"[mie]\nscattering_per_m = [0, 0, 0, 0]\n[aerosol]\nturbidity = 2\n",
       "a.toml:2: mie.scattering_per_m is given beside [aerosol]"},
      {"[ozone]\ndobson = 300\nabsorption_per_m = [0, 0, 0, 0]\n", "give one of them"},
      {"[ozone]\ndobson = 300\nbottom_m = 40000\n",
       "ozone.top_m is 40000 and ozone.bottom_m 40000; the top must lie 2 m or more above"},
      {"[ozone]\nprofile = \"smooth\"\ntop_m = 60000\n", "ozone.top_m has no effect"},
      {"[mie]\nalpha = 0.5\n", "a.toml:2: mie.alpha has no effect"},
      {"[mie]\nphase = \"henyey-greenstein\"\n", "give mie.g too"},
      {"[mie]\nphase = \"mie\"\n", "a.toml:2: mie.phase is \"mie\"; it must be one of rayleigh"},
      {"[mie]\n\ng = 1.0\n", "a.toml:3: mie.g is 1; it must lie in (-1, 1)"},
      {"[mie]\ng = [0.7, 0.8]\n",
       "a.toml:2: mie.g has 2 values; it must have 4, one per wavelength"},
      {"[mie]\nphase = \"fog\"\n", "give mie.droplet_diameter_um too"},
      {"[mie]\ndroplet_diameter_um = 10\n", "no effect without phase = \"fog\""},
      {"[mie]\nphase = \"fog\"\ndroplet_diameter_um = 12\ng = 0.8\n", "mie.g has no effect"},
      {"[mie]\nphase = \"table\"\n", "give mie.phase_file too"},
      {"[mie]\nphase_file = \"x.csv\"\n", "no effect without phase = \"table\""},
      {"[mie]\nphase = \"table\"\nphase_angles_deg = [0, 45, 90, 135, 180]\n"
       "phase_per_sr = [0.08, 0.08]\n",
       "a.toml:4: mie.phase_per_sr has 2 values; it must have 5, one per angle, or "
       "20, one per angle and wavelength"},
      {"[mie]\nphase = \"table\"\nphase_angles_deg = [0, 45, 90, 135, 180]\n"
       "phase_per_sr = [1, 1, 1, 1, 1]\n",
       "a.toml:4: mie.phase: the integral over the sphere is 12.566"},
      {"[aerosol]\n"
       "mixture = \"maritime_clean\"\n"
       "angstrom_exponent = 1\n",
       "a.toml:3: aerosol.angstrom_exponent has no effect"},
      {"[aerosol]\nmixture = \"dessert\"\n", "did you mean desert?"},
      {"[mie]\ng = 0.7\n[aerosol]\n"
       "mixture = \"maritime_clean\"\n",
       "a.toml:2: mie.g has no effect"},
      {"[spectrum]\nwavelengths_nm = [550, 900]\n",
       "a.toml:2: spectrum.wavelengths_nm leaves the data of preset earth (360 to "
       "830 nm); give spectrum.solar_irradiance too"},
      {"preset = \"bruneton2017\"\n[spectrum]\nbands = 4\n",
       "(440, 550 and 680 nm); give spectrum.solar_irradiance too"},
      {"[spectrum]\nwavelengths_nm = [300]\nsolar_irradiance = [0.5]\n"
       "[ozone]\ndobson = 300\n",
       "give ozone.absorption_per_m"},
      {"[planets]\n", "unknown key planets; did you mean planet?"},
      {"\npreset = \"earht\"\n",
       "a.toml:2: preset is \"earht\"; it must be one of earth, clear-mountain, hazy, mars, "
       "bruneton2017; did you mean earth?"},
      {"[planet]\nradius_m = 1e999\n", "a.toml:2: "},
      {"[planet]\nradius_m = 30000\n",
       "a.toml:2: planet.radius_m is 30000; with the smooth ozone layer of ozone.peak_m 22000 it "
       "must lie in [198000, 100000000]"},
      {"[planet]\natmosphere_top_m = 30000\n",
       "a.toml:2: planet.atmosphere_top_m is 30000; with ozone up to 66000 it must lie in "
       "[59400, "},
      {"[planet]\nground_albedo = [0.1, 0.2]\n",
       "a.toml:2: planet.ground_albedo has 2 values; it must have 4, one per wavelength"},
      {"planet = 3\n", "a.toml:1: planet is 3; it must be a table"},
      {"[[planet]]\nradius_m = 1e6\n", "a.toml:1: planet is a list; it must be a table"},
      {"[rayleigh]\ndepolarisation = [0.1, 0.2]\n",
       "a.toml:2: rayleigh.depolarisation has 2 values; it must have 4"},
      {"[spectrum]\nwavelengths_nm = []\n", "a.toml:2: spectrum.wavelengths_nm has 0 values"},
      {"[spectrum]\nwavelengths_nm = [500, 400, 600]\n", "a.toml:2: spectrum.wavelengths_nm has"},
      {"[spectrum]\nwavelengths_nm = [500, 500]\n", "a.toml:2: spectrum.wavelengths_nm has 500"},
      {"[rayleigh]\nscattering_per_m = [1e-6, 1e-6, 1e-6]\n",
       "a.toml:2: rayleigh.scattering_per_m has 3 values; it must have 4"},
      {"[mie]\nscattering_per_m = [1, 1, 1, 1]\n",
       "a.toml:2: mie.scattering_per_m is 1 at 445 nm; it must not exceed mie.extinction_per_m"},
      {"[mie]\nextinction_per_m = [0, 0, 0, 0]\n", "a.toml:2: mie.scattering_per_m is"},
      {"[ozone]\nprofile = \"tent\"\npeak_m = 5000\n",
       "a.toml:3: ozone.peak_m is 5000; it must lie between"},
      {"[ozone]\ntop_m = 20000\n", "a.toml:2: ozone.peak_m is 25000; it must lie between"},
      {"[ozone]\npeak_m = 1e-300\n", "a.toml:2: ozone.peak_m is 1e-300; it must lie between"},
      {"[ozone]\nprofile = \"tent\"\nbottom_m = 24999.9\npeak_m = 25000\ntop_m = 40000\n",
       "a.toml:4: ozone.peak_m is 25000; it must lie between ozone.bottom_m, 24999.9, and "
       "ozone.top_m, 40000, 1 m or more from each"},
      {"a = 1\na = 2\n", "a.toml:2: not valid TOML"},
      {"[planet]\n[planet]\n", "a.toml:2: not valid TOML"},
      {"preset = \n", "a.toml:1: not valid TOML"},
      {"preset = \"earth\n", "a.toml:1: not valid TOML"},
      {"x = [[[[[[[[\n", "a.toml:"},
      {"\xff\xfe", "a.toml: this is UTF-16 text; TOML is read: save it as UTF-8"},
      {"preset = \"\xc3\x28\"\n", "a.toml:1: not valid TOML"},
      {"# thin air\n[rayleigh]\nscale_height_m = 300\n",
       "a.toml:3: planet.atmosphere_top_m is 120000; with rayleigh.scale_height_m 300 it must lie "
       "in [59400, 90000]"},
      {"{\"preset\": \"earth\"}\n", "a.toml: this is JSON; TOML is read"},
      {"<?xml version=\"1.0\"?>\n<a/>\n", "a.toml: this is XML with the root <a>; TOML is read"},
  };
  // A contradiction with a value that the file does not give has the line of its cause.
  for (const BadInput& input : inputs) {
    EXPECT_THAT(FileFaultOf(input.text), HasSubstr(input.message)) << input.text;
  }
}

TEST(AtmosphereFile, Utf16AndDeepNestingAreRefused) {
  EXPECT_THAT(FileFaultOf(std::string("\xff\xfep\0r\0e\0", 8)), HasSubstr("UTF-8"));
  EXPECT_THAT(FileFaultOf("x = " + std::string(100000, '[')),
              StartsWith("a.toml:1: not valid TOML"));
}

TEST(AtmosphereFile, EveryTruncationIsReadOrRefusedWithALine) {
  const std::string whole = kComplete;
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const std::string fault = FileFaultOf(whole.substr(0, length));
    EXPECT_TRUE(fault == "no fault" || fault.rfind("a.toml:", 0) == 0) << length << ": " << fault;
  }
}

TEST(AtmosphereFile, FilesAreReadAndNamedInMessages) {
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / "alpenglow_atmosphere_file_test.toml";
  std::ofstream(file) << kComplete;
  EXPECT_EQ(ReadMedium(file), MediumPreset("bruneton2017"));
  std::ofstream(file) << "\n[mie]\ng = 2\n";
  EXPECT_THAT(tests::FaultOf([&] { return ReadMedium(file); }),
              StartsWith(file.string() + ":3: mie.g is 2"));
  std::filesystem::remove(file);
  EXPECT_THROW((void)ReadMedium(file), InputError);
}

TEST(AtmosphereFile, UnsupportedWavelengthsAreRefusedWithTheirLine) {
  std::string fine = "preset = \"earth\"\n[spectrum]\nwavelengths_nm = [380";
  for (int wavelength_nm = 390; wavelength_nm <= 800; wavelength_nm += 10)
    fine += fmt::format(", {}", wavelength_nm);
  fine += "]\n";
  EXPECT_EQ(MediumFromToml(fine, "air.toml").wavelengths_nm.size(), 43U) << "for the path tracer";
  const auto fault = [](const std::string& text, const MediumUse& use) {
    return tests::FaultOf([&] { return MediumFromToml(text, "air.toml", use); });
  };
  EXPECT_EQ(fault(fine, kForPictures),
            "air.toml:3: spectrum.wavelengths_nm has 43 values; it must have 1 to 40 for pictures");
  EXPECT_THAT(fault(fine, kForLight), StartsWith("air.toml:3: spectrum.wavelengths_nm has 43"));
  constexpr MediumUse kFew{.most_wavelengths = 4, .shows_colours = true, .purpose = "skyview"};
  EXPECT_EQ(fault("[spectrum]\nbands = 8\n", kFew),
            "air.toml:2: spectrum.bands is 8; it must be at most 4 for skyview");
  const std::string ultraviolet = "[spectrum]\nwavelengths_nm = [400, 410]\n";
  EXPECT_THAT(fault(ultraviolet, kForPictures),
              StartsWith("air.toml:2: spectrum.wavelengths_nm reaches from 400 to 410"));
  EXPECT_EQ(fault(ultraviolet, kForLight), "no fault");
  EXPECT_THAT(fault("[spectrum]\nwavelengths_nm = [800, 400]\n", kForPictures),
              StartsWith("air.toml:2: spectrum.wavelengths_nm has nothing between 400 and 800"));
}

}  // namespace
}  // namespace alpenglow::atmosphere
