// SPDX-License-Identifier: MIT
// Tests what `skylut sky` writes and returns when users run it.
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStandardAttributes.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "lut/image/exr.h"
#include "lut/image/image.h"
#include "lut/image/png.h"
#include "tests/fixtures/places.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::lut {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class SkylutSky : public TemporaryFolder {
 protected:
  [[nodiscard]] Outcome Run(const std::string& arguments) const {
    return RunCommand(std::string("'") + tests::kSkylut + "' sky " + arguments);
  }
};

TEST_F(SkylutSky, AWrongCommandLineExitsWith2) {
  for (const char* arguments :
       {"", "--out a.hdr --sun-elevation 10", "--out - --sun-elevation 10",
        "--out a.exr --png a.jpg --sun-elevation 10", "--out a.exr", "--sun-elevation 10",
        "--out a.exr --sun-elevation 91", "--out a.exr --sun-azimuth 10",
        "--out a.exr --sun-elevation 10 --latitude 46", "--out a.exr --latitude 46 --longitude 8",
        "--out a.exr --latitude 46 --time 2026-06-21T12:00:00Z",
        "--out a.exr --sun-elevation 10 --orient maya", "--out a.exr --sun-elevation 10 --size 5",
        "--out a.exr --sun-elevation 10 --tone-map agx",
        "--out a.exr --sun-elevation 10 --aov depth",
        "--out a.exr --sun-elevation 10 --exposure bright",
        "--out a.exr --sun-elevation 10 --white-balance 5600",
        "--out a.exr --sun-elevation 10 --altitude 1e10",
        "--out a.exr --sun-elevation 10 --zone Europe/Zurich"}) {
    EXPECT_EQ(Run(arguments).status, 2) << arguments;
  }
  EXPECT_EQ(FileCount(), 0U);
}

TEST_F(SkylutSky, AWrongInputExitsWith3AndOneLine) {
  const Outcome time = Run("--out a.exr --latitude 46 --longitude 8 --time 2024-02-30T00:00:00Z");
  EXPECT_EQ(time.status, 3);
  EXPECT_THAT(time.error, HasSubstr("2024-02-30"));
  EXPECT_EQ(std::count(time.error.begin(), time.error.end(), '\n'), 1);
  EXPECT_EQ(Run("--out a.exr --sun-elevation 10 --atmosphere missing.toml").status, 3);
  EXPECT_EQ(FileCount(), 0U);
}

TEST_F(SkylutSky, AMissingFolderIsMade) {
  const Outcome outcome =
      Run("--size 8x4 --sun-elevation 10 --out new/deep/a.exr --png other/a.png --quiet");
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_NO_THROW((void)ReadExr(folder_ / "new" / "deep" / "a.exr"));
  EXPECT_NO_THROW((void)ReadPng(folder_ / "other" / "a.png"));
}

TEST_F(SkylutSky, TwoOutputsOfOneNameAreRefused) {
  fs::create_symlink("a.exr", folder_ / "a.png");
  const Outcome outcome = Run("--size 8x4 --sun-elevation 10 --out a.exr --png a.png --quiet");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.error, HasSubstr("are the same file"));
  EXPECT_EQ(FileCount(), 1U) << "only the link";
}

TEST_F(SkylutSky, AnImpossibleFolderExitsWith4) {
  WriteText(folder_ / "no", "in the way");
  for (const char* outputs : {"--out no/where/a.exr", "--out a.exr --png no/where/a.png"}) {
    const Outcome outcome =
        Run(std::string("--progress plain --size 8x4 --sun-elevation 10 ") + outputs);
    EXPECT_EQ(outcome.status, 4);
    EXPECT_THAT(outcome.error, HasSubstr("no/where"));
    EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1)
        << "no row was rendered for nothing: " << outcome.error;
  }
  EXPECT_EQ(FileCount(), 1U) << "only what is in the way";
}

TEST_F(SkylutSky, TheAtmosphereIsNeverOverwritten) {
  WriteText(folder_ / "air.exr", "preset = \"earth\"\n");
  const Outcome outcome = Run("--out ./air.exr --sun-elevation 10 --atmosphere air.exr");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.error, HasSubstr("an input is not overwritten"));
  EXPECT_EQ(ContentOf(folder_ / "air.exr"), "preset = \"earth\"\n");
}

TEST_F(SkylutSky, WritesALatLongPictureThatNamesItsProgram) {
  const Outcome outcome =
      Run("--quiet --size 64x32 --out a.exr --png a.png --sun-elevation 10 --sun-azimuth 30 "
          "--altitude 1000 --orient blender --tone-map aces");
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_EQ(outcome.error, "");
  EXPECT_EQ(FileCount(), 2U) << "no temporary stays";
  {
    const Imf::InputFile file((folder_ / "a.exr").c_str());
    ASSERT_TRUE(Imf::hasEnvmap(file.header()));
    EXPECT_EQ(Imf::envmap(file.header()), Imf::ENVMAP_LATLONG);
    EXPECT_EQ(Imf::whiteLuminance(file.header()), 1.0F) << "the unit is cd/m^2";
  }
  const Metadata exr = ReadExrMetadata(folder_ / "a.exr");
  for (const auto& [name, value] : Metadata{{"alpenglow.sun_elevation_deg", "10.000000"},
                                            {"alpenglow.sun_azimuth_deg", "30.000000"},
                                            {"alpenglow.altitude_m", "1000"},
                                            {"alpenglow.orientation", "blender"},
                                            {"alpenglow.centre_azimuth_deg", "90.000000"},
                                            {"alpenglow.sun_disk", "left out"},
                                            {"alpenglow.atmosphere", "earth"},
                                            {"alpenglow.exposure", "metered"}}) {
    ASSERT_EQ(exr.count(name), 1U) << name;
    EXPECT_EQ(exr.at(name), value) << name;
  }
  for (const char* name :
       {"Software", "alpenglow.unit", "alpenglow.atmosphere_hash", "alpenglow.ev100"})
    EXPECT_EQ(exr.count(name), 1U) << name;
  EXPECT_EQ(ReadPngMetadata(folder_ / "a.png").at("alpenglow.tone_curve"), "aces");
  EXPECT_EQ(ReadPng(folder_ / "a.png").width, 64);
}

TEST_F(SkylutSky, SunlitGroundHasOneExposureFromSpaceAndGround) {
  const auto ev100 = [&](const std::string& altitude) {
    const Outcome outcome =
        Run("--quiet --size 32x16 --out a.exr --png a.png --sun-elevation 50 --sun-disk "
            "--white-balance auto --atmosphere bruneton2017 --altitude " +
            altitude);
    EXPECT_EQ(outcome.status, 0) << outcome.error;
    const Metadata png = ReadPngMetadata(folder_ / "a.png");
    EXPECT_THAT(png.at("alpenglow.white_balance"), HasSubstr("auto, "));
    EXPECT_THAT(png.at("alpenglow.exposure_rule"), HasSubstr("of the solid angle"));
    return std::stod(png.at("alpenglow.ev100"));
  };
  const double from_the_ground = ev100("2");
  for (const char* altitude : {"40000", "400000"}) {
    EXPECT_NEAR(ev100(altitude), from_the_ground, 0.6)
        << altitude
        << " m: half of the sphere or less is lit; air in front of the ground adds light";
  }
}

TEST_F(SkylutSky, APlaceAndATimeGiveTheSunThere) {
  const std::string rest =
      "--quiet --size 16x8 --latitude 46.5 --longitude 8 --atmosphere bruneton2017 ";
  ASSERT_EQ(Run(rest + "--out a.exr --altitude 900 --time 2026-06-21T11:30:00Z").status, 0);
  // These are the aliases of --altitude and --time.
  ASSERT_EQ(
      Run(rest + "--out b.exr --height 900 --at 2026-06-21T13:30 --zone Europe/Zurich").status, 0);
  const Metadata metadata = ReadExrMetadata(folder_ / "a.exr");
  // Noon of the solstice has 90 - 46.5 + 23.44, and refraction of half a minute of arc.
  EXPECT_NEAR(std::stod(metadata.at("alpenglow.sun_elevation_deg")), 66.94, 0.02);
  EXPECT_NEAR(std::stod(metadata.at("alpenglow.sun_azimuth_deg")), 180.0, 1.0);
  EXPECT_EQ(metadata.at("alpenglow.utc"), "2026-06-21T11:30:00.000Z");
  EXPECT_EQ(metadata.at("alpenglow.altitude_m"), "900");
  EXPECT_EQ(ContentOf(folder_ / "a.exr"), ContentOf(folder_ / "b.exr")) << "the same instant";
}

TEST_F(SkylutSky, WritesPolarisationChannelsAndJsonProgress) {
  const Outcome outcome =
      Run("--progress json --size 16x8 --out a.exr --sun-elevation 10 --aov "
          "polarisation,stokes_q,stokes_q");
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_EQ(ReadExr(folder_ / "a.exr").layers.size(), 5U)
      << "degree, angle, and Q in three colours";
  EXPECT_EQ(ReadExrMetadata(folder_ / "a.exr").at("alpenglow.layers"), "polarisation,stokes_q");
  EXPECT_THAT(outcome.error, HasSubstr("\"label\":\"rows\""));
}

}  // namespace
}  // namespace alpenglow::lut
