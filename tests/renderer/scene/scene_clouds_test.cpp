// SPDX-License-Identifier: MIT
#include "renderer/scene/scene_clouds.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "atmosphere/time_place/geodesy.h"
#include "atmosphere/time_place/time.h"
#include "renderer/clouds/cloud_generator.h"
#include "renderer/scene/scene_options.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::renderer {
namespace {

using testing::HasSubstr;

/// A folder with "field.txt": 5 x 5 x 3 points, 0.1 km apart from 2 km up, with cloud at the middle.
class SceneClouds : public TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    WriteText(folder_ / "field.txt", "5 5 3\n0.1 0.1\n2.0 2.1 2.2\n3 3 2 50 8\n");
  }
  [[nodiscard]] Scene Read(const std::string& clouds) const {
    return SceneFromToml(
        "[place]\nlatitude = 46.5\nlongitude = 8\n[time]\nutc = \"2026-06-21T04:00:00Z\"\n" +
            clouds,
        "s.toml", folder_);
  }
  /// Returns the only field of a scene at an instant.
  [[nodiscard]] CloudField FieldAt(const std::string& clouds, const char* instant) const {
    const Scene scene = Read(clouds);
    return CloudFieldsOf(scene, CloudTime_s(scene, ParseInstant(instant))).at(0).field;
  }
};

constexpr char kGridText[] = "[[cloud]]\ngrid = \"field.txt\"\n";

TEST_F(SceneClouds, FieldsAreOrderedByTheirBases) {
  const Scene scene = Read(
      "[[cloud]]\ngenus = \"cirrus\"\nperiod_m = 2560\n"
      "[[cloud]]\ngrid = \"field.txt\"\n"
      "[[cloud]]\ngenus = \"cumulus\"\nperiod_m = 2560\n");
  const std::vector<SceneCloudField> fields = CloudFieldsOf(scene, 0.0);
  ASSERT_EQ(fields.size(), 3U);
  EXPECT_FALSE(fields[0].is_of_ice) << "cumulus";
  EXPECT_FALSE(fields[1].field.period_m()) << "the grid";
  EXPECT_TRUE(fields[2].is_of_ice) << "cirrus";
  EXPECT_LT(fields[0].field.base_altitude_m(), fields[1].field.base_altitude_m());
  EXPECT_LT(fields[1].field.base_altitude_m(), fields[2].field.base_altitude_m());
}

TEST_F(SceneClouds, AGenusIsThatOfTheGenerator) {
  const Scene scene = Read(
      "[[cloud]]\ngenus = \"altocumulus\"\nperiod_m = 2560\nseed = 5\nwind_m_per_s = [9, 2]\n");
  const CloudField field = CloudFieldsOf(scene, 1000.0).at(0).field;
  const CloudField made = MakeCloudField(scene.clouds[0].options, 1000.0);
  EXPECT_EQ(field.hash(), made.hash());
  // The wind carries the corner by 9000 m and 2000 m, the first of which exceeds three periods.
  EXPECT_NEAR(field.lattice().origin_m.x, 9000.0 - 3.0 * 2560.0, 1e-9);
  EXPECT_NEAR(field.lattice().origin_m.y, 2000.0, 1e-9);
}

TEST_F(SceneClouds, TheMiddleOfAGridIsAtItsPlace) {
  const char* const now = "2026-06-21T04:00:00Z";
  const CloudField here = FieldAt(kGridText, now);
  EXPECT_NEAR(here.Extinction_per_m({0.0, 0.0, 2100.0}), 0.05, 1e-8) << "floats";
  EXPECT_EQ(here.Extinction_per_m({200.0, 0.0, 2100.0}), 0.0);
  const CloudField there =
      FieldAt(std::string(kGridText) + "latitude = 46.51\nlongitude = 8\n", now);
  const LocalFrame frame(kWgs84, {46.5, 8.0, 0.0});
  const glm::dvec3 middle = frame.EnuFromGeodetic({46.51, 8.0, 0.0}).xyz;
  EXPECT_NEAR(middle.y, 1111.8, 0.5) << "a hundredth of a degree of the meridian at 46.5 N";
  EXPECT_NEAR(there.Extinction_per_m({middle.x, middle.y, 2100.0}), 0.05, 1e-8);
}

TEST_F(SceneClouds, AGridMovesWithTheWindFromTheTimeOfTheScene) {
  const std::string windy = std::string(kGridText) + "wind_m_per_s = [2, -1]\n";
  for (const auto& [instant, seconds] : {std::pair{"2026-06-21T04:00:00Z", 0.0},
                                         {"2026-06-21T04:05:00Z", 300.0},
                                         {"2026-06-21T03:50:00Z", -600.0}}) {
    const CloudField field = FieldAt(windy, instant);
    // The offset is rounded with times of 4e6 s: 1e-9 of a voxel.
    EXPECT_NEAR(field.Extinction_per_m({2.0 * seconds, -seconds, 2100.0}), 0.05, 1e-8) << instant;
  }
}

TEST_F(SceneClouds, ARepeatingGridHasItsPeriod) {
  const CloudField field =
      FieldAt(std::string(kGridText) + "repeats = true\n", "2026-06-21T04:00:00Z");
  EXPECT_EQ(field.period_m(), glm::dvec2(500.0, 500.0));
  EXPECT_EQ(
      CloudFieldsOf(Read(std::string(kGridText) + "genus = \"cirrus\"\n"), 0.0).at(0).is_of_ice,
      true);
}

/// Returns the bytes of 3 x 2 x 2 floats, little endian: 0 to 11, x fastest.
std::string CountedFloats() {
  std::string bytes(12 * sizeof(float), '\0');
  for (int i = 0; i < 12; ++i) {
    const auto value = static_cast<float>(i);
    std::memcpy(bytes.data() + static_cast<std::size_t>(i) * sizeof(float), &value, sizeof(float));
  }
  return bytes;
}

TEST_F(SceneClouds, NrrdAndRawLieOverTheirBaseAroundTheirMiddle) {
  WriteText(folder_ / "x.raw", CountedFloats());
  WriteText(folder_ / "x.nrrd",
            "NRRD0004\ntype: float\ndimension: 3\nsizes: 3 2 2\nencoding: raw\n"
            "endian: little\n\n" +
                CountedFloats());
  const std::string keys =
      "spacing_m = [100, 80, 50]\nbase_height_m = 1500\nextinction_per_m = 0.01\n"
      "effective_radius_um = 7\n";
  for (const std::string grid : {"grid = 'x.nrrd'\n", "grid = 'x.raw'\ngrid_size = [3, 2, 2]\n"}) {
    const CloudField field = FieldAt("[[cloud]]\n" + grid + keys, "2026-06-21T04:00:00Z");
    EXPECT_EQ(field.lattice().origin_m, glm::dvec3(-100.0, -40.0, 1500.0)) << grid;
    EXPECT_EQ(field.lattice().size_m(), glm::dvec3(200.0, 80.0, 50.0)) << grid;
    // Between samples, x, y and z in samples, the value is x + 3 y + 6 z; floats.
    EXPECT_NEAR(field.Extinction_per_m({0.0, 0.0, 1525.0}), 0.01 * 5.5, 1e-8) << grid;
    EXPECT_NEAR(field.Extinction_per_m({50.0, 0.0, 1500.0}), 0.01 * 3.0, 1e-8) << grid;
    EXPECT_EQ(field.Extinction_per_m({0.0, 0.0, 1499.0}), 0.0) << grid;
    EXPECT_NEAR(field.EffectiveRadius_um({0.0, 0.0, 1525.0}), 7.0, 1e-5) << grid << ": floats";
  }
}

TEST_F(SceneClouds, TheDataOfAnNrrdAreAnInput) {
  WriteText(folder_ / "x.raw", CountedFloats());
  WriteText(folder_ / "x.nhdr",
            "NRRD0004\ntype: float\ndimension: 3\nsizes: 3 2 2\nencoding: raw\n"
            "endian: little\ndata file: x.raw\n");
  const Scene scene = Read("[[cloud]]\ngrid = 'x.nhdr'\nspacing_m = 100\nbase_height_m = 1500\n");
  const std::vector<NamedFile> files = FilesOf(scene);
  ASSERT_EQ(files.size(), 2U);
  EXPECT_EQ(files[0].file, folder_ / "x.nhdr");
  EXPECT_EQ(files[1].file, folder_ / "x.raw");
}

TEST_F(SceneClouds, AFaultyGridIsNamedWithItsKey) {
  WriteText(folder_ / "field.txt", "5 5 3\n0.1 0.1\n2.0 2.1 2.2\n3 3 2 -50 8\n");
  const std::string fault = tests::FaultOf([&] { return CloudFieldsOf(Read(kGridText), 0.0); });
  EXPECT_THAT(fault, testing::StartsWith("s.toml: cloud[0].grid: "));
  EXPECT_THAT(fault, HasSubstr("field.txt:4: extinction is \"-50\""));
  const Scene missing = Read("[[cloud]]\ngrid = \"none.txt\"\n");
  EXPECT_THAT(tests::FaultOf([&] { return CloudFieldsOf(missing, 0.0); }),
              HasSubstr("s.toml: cloud[0].grid: " + (folder_ / "none.txt").string()));
}

TEST_F(SceneClouds, TimesAreContinuousAroundTheSceneAndNeverNegative) {
  const Scene scene = Read("");
  const auto time_s = [&](const char* instant) {
    return CloudTime_s(scene, ParseInstant(instant));
  };
  const double noon_s = time_s("2026-06-21T12:00:00Z");
  EXPECT_EQ(time_s("2026-06-21T12:00:05Z") - noon_s, 5.0);
  EXPECT_EQ(time_s("2026-06-22T12:00:00Z") - noon_s, 86400.0);
  EXPECT_EQ(time_s("2026-05-03T12:00:00Z") - noon_s, -49.0 * 86400.0);
  EXPECT_EQ(time_s("2026-08-09T12:00:00Z") - noon_s, 49.0 * 86400.0);
  for (const char* instant :
       {"1900-01-01T00:00:00Z", "2025-12-31T23:59:59Z", "2100-12-31T00:00:00Z"}) {
    EXPECT_GE(time_s(instant), 0.0) << instant;
    EXPECT_LE(time_s(instant), 1e7) << instant << ": the range of MakeCloudField";
  }
  EXPECT_EQ(CloudDayOf(Scene{}), ParseInstant("2026-06-21T00:00:00Z").modified_julian_day);
}

TEST_F(SceneClouds, TimesAreContinuousFromTheBeginningOfASeries) {
  for (const char* begin : {"2024-02-29T23:00:00Z", "2026-08-09T23:59:59Z", "2026-08-10T00:00:00Z",
                            "2026-05-01T22:00:00Z", "2031-01-01T00:00:00Z"}) {
    const UtcTime first = ParseInstant(begin);
    Scene scene = Read("");
    const double alone_s = CloudTime_s(scene, first);
    scene.cloud_day = CloudDayNear(scene, first);
    EXPECT_EQ(CloudTime_s(scene, first), alone_s) << begin << ": a still has the same clouds";
    for (const double later_s : {3600.0, 86400.0, 14.9 * 86400.0}) {
      // Times of 1e7 s are doubles.
      EXPECT_NEAR(CloudTime_s(scene, AddSeconds(first, later_s)) - alone_s, later_s, 1e-6) << begin;
    }
  }
}

TEST(CloudsOfText, PresetsAndGeneraAreLayers) {
  EXPECT_TRUE(CloudsFromText("none").empty());
  EXPECT_EQ(CloudsFromText("fair").at(0).options.cover, 0.25);
  EXPECT_EQ(CloudsFromText("broken").at(0).options.genus, CloudGenus::kStratocumulus);
  EXPECT_EQ(CloudsFromText("high").at(0).options.genus, CloudGenus::kCirrus);
  const std::vector<SceneCloud> clouds = CloudsFromText(" cumulus 0.4,cirrus , altocumulus  1 ");
  ASSERT_EQ(clouds.size(), 3U);
  CloudOptions cumulus = DefaultCloudOptions(CloudGenus::kCumulus);
  cumulus.cover = 0.4;
  EXPECT_EQ(clouds[0].options, cumulus);
  EXPECT_EQ(clouds[1].options.cover, DefaultCloudOptions(CloudGenus::kCirrus).cover);
  EXPECT_EQ(clouds[2].options.cover, 1.0);
  EXPECT_EQ(clouds[2].options.seed, 3U) << "layers of one genus differ";
  for (const SceneCloud& cloud : clouds) EXPECT_NO_THROW(CheckCloudOptions(cloud.options));
}

TEST(CloudsOfText, FaultsNameWordAndRange) {
  for (const auto& [text, fault] : std::vector<std::pair<const char*, const char*>>{
           {"", "a layer of clouds is empty"},
           {"fair,", "a layer of clouds is empty"},
           {"cumulos 0.3", "\"cumulos\" is no genus or preset of clouds; did you mean cumulus?"},
           {"fiar", "did you mean fair?"},
           {"xyz",
            "known: none, fair, broken, high, overcast, cumulus, stratocumulus, altocumulus, "
            "cirrus, "
            "stratus, cirrostratus"},
           {"cumulus 0.9", "the cover of cumulus is \"0.9\"; it must be a number in [0, 0.8]"},
           {"cirrus 1.01", "the cover of cirrus is \"1.01\"; it must be a number in [0, 1]"},
           {"cirrus -0.1", "\"-0.1\"; it must be a number"},
           {"cirrus nan", "\"nan\"; it must be a number"},
           {"cirrus thin", "\"thin\"; it must be a number"},
           {"cirrus 0.3 0.4", "has 3 words"},
           {"fair 0.3", "has 2 words"},
           {"none, fair", "none stands alone"}}) {
    EXPECT_THAT(tests::FaultOf([text = text] { return CloudsFromText(text); }), HasSubstr(fault))
        << text;
  }
}

TEST(CloudsOfText, LayersThatNeedMoreThanTheMemoryAreRefused) {
  const std::vector<SceneCloud> clouds = CloudsFromText("fair, high");
  const auto most = [](const SceneCloud& cloud) {
    return CloudField::MostBytes(LatticeOf(cloud.options));
  };
  const double both = most(clouds[0]) + most(clouds[1]);
  EXPECT_NO_THROW(RequireCloudsFit(clouds, both));
  const std::string fault = tests::FaultOf([&] {
    RequireCloudsFit(clouds, 0.99 * both);
    return 0;
  });
  EXPECT_THAT(fault, HasSubstr("--clouds[1].period_m is 20480 and its depth_m 1200: the clouds up "
                               "to this layer may need 0.5 GB"));
  EXPECT_GT(MemoryOfMachine(), 1e8);
  for (const char* genus : {"cumulus", "stratocumulus", "altocumulus", "cirrus"})
    EXPECT_LT(most(CloudsFromText(genus).at(0)), 0.34e9) << genus << ": as in the manual";
}

TEST(CloudsOfText, LowBasesFollowTheGroundAndHighOnesDoNot) {
  const auto base_m = [](const char* text, double ground_m) {
    return OverEllipsoid(CloudsFromText(text), ground_m).at(0).options.base_altitude_m;
  };
  EXPECT_EQ(base_m("cumulus", 800.0), 2000.0);
  EXPECT_EQ(base_m("stratocumulus", 800.0), 1700.0);
  EXPECT_EQ(base_m("altocumulus", 800.0), 4000.0);
  EXPECT_EQ(base_m("cirrus", 800.0), 8000.0);
  EXPECT_EQ(base_m("cumulus", -400.0), 1200.0) << "below the sea, from the ellipsoid on";
}

TEST(CloudsOfText, BasesBelowAllGroundAreRefused) {
  std::vector<SceneCloud> clouds = CloudsFromText("high, fair");
  EXPECT_NO_THROW(RequireCloudsOverGround(clouds, 1500.0)) << "1200 m above the ground";
  clouds[1].is_over_ground = false;
  EXPECT_NO_THROW(RequireCloudsOverGround(clouds, 1200.0));
  EXPECT_THAT(tests::FaultOf([&] {
                RequireCloudsOverGround(clouds, 1200.5);
                return 0;
              }),
              HasSubstr("--clouds[1].base_height_m is 1200; the lowest ground of the scene is at "
                        "1200.5 m"));
}

}  // namespace
}  // namespace alpenglow::renderer
