// SPDX-License-Identifier: MIT
#include "renderer/scene/scene_weather.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/medium/medium_presets.h"
#include "atmosphere/time_place/time.h"
#include "renderer/clouds/cloud_options.h"
#include "renderer/scene/scene_options.h"
#include "tests/fixtures/fault_of.h"

namespace alpenglow::renderer {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr char kStationScene[] =
    "[place]\nlatitude = 47.4\nlongitude = 8.5\n[terrain]\nnone = true\n";

Scene SceneOf(const std::string& text) { return SceneFromToml(text, "s.toml", ""); }

/// Returns the scene of a file with a report of a station.
Scene Reported(const std::string& groups, const std::string& station = "XAAA 211350Z ",
               const std::string& more = "") {
  return SceneOf(
      fmt::format("{}[weather]\nmetar = \"{}{}\"\n{}", kStationScene, station, groups, more));
}

const std::string kAtZurich = "LSZH 211350Z ";

MetarReport Report(const std::string& groups) { return ReadMetar("XAAA 211350Z " + groups); }

/// Returns genus, cover, and base of the layers of a report without a height of its station.
std::vector<std::string> LayersOf(const std::string& groups) {
  std::vector<std::string> layers;
  for (const SceneCloud& cloud : CloudsOfReport(Report(groups), {})) {
    layers.push_back(fmt::format("{} {} {:.0f}", kCloudGenusNames.Of(cloud.options.genus),
                                 cloud.options.cover, cloud.options.base_altitude_m));
  }
  return layers;
}

TEST(SceneWeather, CloudGroupsAreLayersByHeightAndOktas) {
  EXPECT_THAT(LayersOf("FEW040 SCT120 BKN250"),
              ElementsAre("cumulus 0.1875 1219", "altocumulus 0.4375 3658", "cirrus 0.75 7620"));
  EXPECT_THAT(LayersOf("SCT020"), ElementsAre("cumulus 0.4375 610"));
  EXPECT_THAT(LayersOf("BKN020"), ElementsAre("stratocumulus 0.75 610"));
  EXPECT_THAT(LayersOf("OVC008"), ElementsAre("stratus 1 244"));
  EXPECT_THAT(LayersOf("OVC120"), ElementsAre("altocumulus 1 3658"));
  EXPECT_THAT(LayersOf("OVC250"), ElementsAre("cirrostratus 1 7620"));
  EXPECT_THAT(LayersOf("SCT080CB BKN030TCU"),
              ElementsAre("cumulus 0.75 914", "cumulus 0.4375 2438"));
  EXPECT_THAT(LayersOf("OVC030CB"), ElementsAre("cumulus 0.8 914"));
  for (const char* clear : {"CAVOK", "9999 NSC", "NCD", "SKC", "CLR"})
    EXPECT_THAT(LayersOf(clear), IsEmpty()) << clear;
}

TEST(SceneWeather, AHiddenSkyIsAStratusAtTheVerticalVisibility) {
  EXPECT_THAT(LayersOf("0300 FG VV002"), ElementsAre("stratus 1 61"));
  EXPECT_THAT(LayersOf("0150 FG VV///"), ElementsAre("stratus 1 150"));
  EXPECT_THAT(LayersOf("0800 SN VV///"), ElementsAre("stratus 1 300"));
  EXPECT_THAT(LayersOf("VV///"), ElementsAre("stratus 1 300"));
}

TEST(SceneWeather, EveryLayerHasOptionsThatFieldsAccept) {
  for (const char* amount : {"FEW", "SCT", "BKN", "OVC"}) {
    for (const std::string convection : {"", "TCU", "CB"}) {
      for (int height = 0; height <= (convection.empty() ? 350 : 190); height += 7) {
        const std::string group = fmt::format("{}{:03}{}", amount, height, convection);
        for (const SceneCloud& cloud :
             CloudsOfReport(Report("240160KT " + group + " OVC360"), 3000.0))
          EXPECT_EQ(tests::FaultOf([&] { CheckCloudOptions(cloud.options); }), "no fault") << group;
      }
    }
  }
}

TEST(SceneWeather, LayersEndBelowTheNextUnlessTheyTower) {
  const std::vector<SceneCloud> flat = CloudsOfReport(Report("FEW020 BKN030"), {});
  EXPECT_NEAR(flat[0].options.depth_m, 10.0 * 30.48, 1e-9);
  const std::vector<SceneCloud> towers = CloudsOfReport(Report("FEW020TCU SCT025CB BKN030"), {});
  EXPECT_EQ(towers[0].options.depth_m, 3000.0);
  EXPECT_EQ(towers[1].options.depth_m, 4000.0);
}

TEST(SceneWeather, CloudsDriftWithTheReportedWind) {
  // 8 kt from 240 degrees; (600 m / 10 m)^(1/7) = 1.795.
  const glm::dvec2 wind = CloudsOfReport(Report("24008KT FEW040"), {}).front().options.wind_m_per_s;
  const double speed = 8.0 * 0.514444 * 1.795;
  EXPECT_NEAR(wind.x, speed * std::sin(kPi / 3.0), 2e-3) << "to the east";
  EXPECT_NEAR(wind.y, speed * std::cos(kPi / 3.0), 2e-3) << "to the north";
  const glm::dvec2 low = CloudsOfReport(Report("36010MPS OVC001"), {}).front().options.wind_m_per_s;
  EXPECT_NEAR(low.x, 0.0, 1e-9);
  EXPECT_NEAR(low.y, -10.0 * std::pow(3.048, 1.0 / 7.0), 1e-9);
  for (const char* still : {"VRB04KT FEW040", "00000KT FEW040"})
    EXPECT_EQ(CloudsOfReport(Report(still), {}).front().options.wind_m_per_s, glm::dvec2(0.0));
  EXPECT_EQ(CloudsOfReport(Report("FEW040"), {}).front().options.wind_m_per_s,
            DefaultCloudOptions(CloudGenus::kCumulus).wind_m_per_s)
      << "without a wind";
}

TEST(SceneWeather, WaterHasTheReportedWindUnlessTheSceneGivesOne) {
  const auto wind_m_per_s = [](const std::string& groups, const std::string& ground = "") {
    const Scene scene = Reported(groups, kAtZurich, "[ground]\ncover = \"water\"\n" + ground);
    return scene.ground.wind_m_per_s;
  };
  EXPECT_EQ(wind_m_per_s("24012MPS"), 12.0);
  EXPECT_NEAR(*wind_m_per_s("VRB04KT"), 4.0 * 0.514444, 1e-5) << "waves need no direction";
  EXPECT_EQ(wind_m_per_s("00000KT"), 0.0);
  EXPECT_EQ(wind_m_per_s("24060KT"), 20.0) << "the most that water has";
  EXPECT_EQ(wind_m_per_s("/////KT CAVOK"), std::nullopt) << "not observed";
  EXPECT_EQ(wind_m_per_s("24012MPS", "wind_m_per_s = 3\n"), 3.0);
  EXPECT_THAT(
      Reported("24060KT", kAtZurich, "[ground]\ncover = \"water\"\n").weather.notes,
      ElementsAre("weather.metar: water is drawn with the waves of a wind of 20 m/s, not 31"));
  EXPECT_THAT(Reported("24060KT", kAtZurich).weather.notes, IsEmpty()) << "no water";
}

TEST(SceneWeather, BasesAreAboveTheStation) {
  const Scene named = Reported("FEW040 SCT250", kAtZurich);
  EXPECT_NEAR(named.clouds[0].options.base_altitude_m, 423.0 + 1219.2, 1e-9);
  EXPECT_NEAR(named.clouds[1].options.base_altitude_m, 423.0 + 7620.0, 1e-9);
  EXPECT_FALSE(named.clouds[0].is_over_ground);
  const Scene other = Reported("FEW040 SCT250");
  EXPECT_NEAR(other.clouds[0].options.base_altitude_m, 1219.2, 1e-9);
  EXPECT_TRUE(other.clouds[0].is_over_ground && other.clouds[1].is_over_ground);
  EXPECT_THAT(other.weather.notes,
              ElementsAre("weather.metar: the station XAAA is no named airport; its height is "
                          "taken as 0 m, and clouds are above the ground of the scene"));
  const Scene given = Reported("FEW040", "XAAA 211350Z ", "station_height_m = 1000\n");
  EXPECT_NEAR(given.clouds[0].options.base_altitude_m, 2219.2, 1e-9);
  EXPECT_THAT(given.weather.notes, IsEmpty());
}

TEST(SceneWeather, BasesOfStationsBelowTheEllipsoidAreLower) {
  const std::vector<SceneCloud> clouds = CloudsOfReport(Report("FEW000 SCT040"), -400.0);
  EXPECT_EQ(clouds[0].options.base_altitude_m, 0.0) << "fields begin at the ellipsoid";
  EXPECT_NEAR(clouds[1].options.base_altitude_m, 1219.2 - 400.0, 1e-9);
}

TEST(SceneWeather, CloudsOverTheBuiltInRangeAreAboveItsGround) {
  const std::string file = "[place]\nlatitude = 47.4\nlongitude = 8.5\n[weather]\nmetar = \"" +
                           kAtZurich + "0500 FG SCT040\"\n";
  const Scene scene = SceneOf(file);
  EXPECT_TRUE(scene.clouds[0].is_over_ground);
  EXPECT_NEAR(scene.clouds[0].options.base_altitude_m, 1219.2, 1e-9);
  EXPECT_FALSE(scene.layers[0].base_height_m) << "the ground under the eye";
  const Scene given = SceneOf(file + "station_height_m = 100\n");
  EXPECT_NEAR(given.clouds[0].options.base_altitude_m, 1319.2, 1e-9);
}

// 500 m at the station, which is in air of its own extinction and in fog.
TEST(SceneWeather, FogHasTheReportedVisibilityAtTheStation) {
  const Scene scene = Reported("0500 FG 10/10 Q1018", kAtZurich);
  ASSERT_EQ(scene.layers.size(), 1U);
  EXPECT_EQ(scene.layers[0].base_height_m, 423.0);
  EXPECT_NEAR(VisibilityAt(scene.medium, 423.0, scene.layers[0].extinction_per_m), 500.0, 1e-9);
  EXPECT_THAT(Reported("5000 BR", kAtZurich).layers, IsEmpty());
  EXPECT_THAT(Reported("9999 MIFG", kAtZurich).layers, IsEmpty());
  EXPECT_NEAR(VisibilityAt(Reported("5000 BR", kAtZurich).medium, 423.0, 0.0), 5000.0, 1e-5);
}

TEST(SceneWeather, TheTimeOfAReportIsUsedIfTheSceneHasNone) {
  EXPECT_EQ(FormatUtc(*Reported("CAVOK").time), "2026-06-21T13:50:00Z");
  EXPECT_EQ(FormatUtc(*Reported("CAVOK", "XAAA 312359Z ").time), "2026-07-31T23:59:00Z");
  const Scene timed = Reported("CAVOK", kAtZurich, "[time]\nutc = \"2026-01-02T03:04:05Z\"\n");
  EXPECT_EQ(FormatUtc(*timed.time), "2026-01-02T03:04:05Z");
}

TEST(SceneWeather, ContradictionsAreNamedWithBothValues) {
  EXPECT_THAT(NotesOnReport(Report("FEW040 22/12")), IsEmpty()) << "1250 m";
  EXPECT_THAT(NotesOnReport(Report("FEW040 22/20")),
              ElementsAre("FEW040 has its base at 1219 m, and temperature 22 with dew point 20 "
                          "forms clouds of rising air at 250 m; the base is kept"));
  EXPECT_THAT(NotesOnReport(Report("SCT010CB 30/10")), Not(IsEmpty()));
  EXPECT_THAT(NotesOnReport(Report("BKN010 OVC120 30/10")), IsEmpty()) << "not of rising air";
  EXPECT_THAT(NotesOnReport(Report("5000 FG")),
              ElementsAre("FG has a visibility of 5000 m; fog has less than 1000 m"));
  EXPECT_THAT(NotesOnReport(Report("FG")), ElementsAre("FG without a visibility is not drawn"));
}

TEST(SceneWeather, GroupsWithoutEffectAreNamedInOneLine) {
  EXPECT_THAT(NotesOnReport(Report("-SHRA OVC030CB NOSIG")),
              ElementsAre("not modelled: -SHRA (light: showers, rain), NOSIG (trend)",
                          "OVC030CB is drawn as cumulus 4000 m deep without anvil, with a cover of "
                          "0.8"));
}

TEST(SceneWeather, AReportAndTablesOfTheSameWeatherAreRefused) {
  const auto fault = [](const std::string& groups, const std::string& more) {
    return tests::FaultOf([&] { return Reported(groups, kAtZurich, more); });
  };
  const std::string cloud = "[[cloud]]\ngenus = \"cirrus\"\n", fog = "[fog]\nvisibility_m = 900\n";
  EXPECT_EQ(fault("FEW040", cloud),
            "s.toml:7: weather.metar: the report and [[cloud]] both give clouds; give one");
  EXPECT_EQ(fault("0500 FG", fog),
            "s.toml:7: weather.metar: the report and [fog] both give fog; give one");
  EXPECT_THAT(fault("CAVOK", cloud), HasSubstr("both give clouds"));
  EXPECT_EQ(fault("24008KT 9999", cloud), "no fault") << "nothing about clouds";
  EXPECT_EQ(fault("CAVOK", fog), "no fault") << "fog elsewhere";
}

TEST(SceneWeather, CloudsAboveAllFieldsAreRefused) {
  EXPECT_EQ(tests::FaultOf([] { return Reported("FEW600", kAtZurich); }),
            "s.toml:7: weather.metar: the base of FEW600 in metres above the ellipsoid is 18711; "
            "it must lie in [0, 15000]");
}

TEST(SceneWeather, MalformedReportsAreRefusedWithFileKeyGroupAndReason) {
  const auto fault = [](const std::string& text) {
    return tests::FaultOf([&] { return SceneOf(text); });
  };
  EXPECT_THAT(fault(std::string(kStationScene) + "[weather]\nmetar = \"LSZH 211350Z 24O08KT\"\n"),
              HasSubstr("s.toml:7: weather.metar: group \"24O08KT\": a wind is"));
  EXPECT_EQ(fault(std::string(kStationScene) + "[weather]\nstation_height_m = 3\n"),
            "s.toml:6: weather.metar is missing");
}

TEST(SceneWeather, AReportOfTheCommandLineReplacesThatOfTheFile) {
  const std::string file = std::string(kStationScene) +
                           "[weather]\nmetar = \"LSZH 211350Z 0500 FG OVC001 10/10 Q1018\"\n";
  SceneWeather typed;
  typed.metar = "LSZH 211350Z 24008KT CAVOK";
  const Scene scene = SceneFromToml(file, "s.toml", "", kForPictures, typed);
  EXPECT_THAT(scene.clouds, IsEmpty());
  EXPECT_THAT(scene.layers, IsEmpty());
  EXPECT_EQ(scene.weather.metar, "LSZH 211350Z 24008KT CAVOK");
  const Scene cloudy = SceneFromToml(
      std::string(kStationScene) + "[[cloud]]\ngenus = \"cirrus\"\n[fog]\nvisibility_m = 9\n",
      "s.toml", "", kForPictures, typed);
  EXPECT_THAT(cloudy.clouds, IsEmpty()) << "CAVOK";
  EXPECT_EQ(cloudy.layers.size(), 1U) << "the report has no fog";
  typed.metar = "LSZH";
  EXPECT_THAT(
      tests::FaultOf([&] { return SceneFromToml(file, "s.toml", "", kForPictures, typed); }),
      HasSubstr("--metar: the report has no time"));
}

TEST(SceneWeather, TheStationIsThePlaceIfTheOptionsHaveNone) {
  SceneWeather weather;
  weather.metar = kAtZurich + "CAVOK";
  EXPECT_EQ(AtStation({}, weather).place, "LSZH");
  SceneOptions options;
  options.latitude = 3.0;
  EXPECT_FALSE(AtStation(options, weather).place);
  weather.metar = "XAAA 211350Z CAVOK";
  EXPECT_FALSE(AtStation({}, weather).place);
  EXPECT_FALSE(AtStation({}, {}).place);
}

}  // namespace
}  // namespace alpenglow::renderer
