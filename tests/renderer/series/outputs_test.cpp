// SPDX-License-Identifier: MIT
// What is made of a series: keogram, plot, manifest for programs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/math/constants.h"
#include "lut/cli/messages.h"
#include "renderer/series/contact_sheet.h"
#include "renderer/series/day_times.h"
#include "renderer/series/manifest.h"

namespace alpenglow::renderer {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(JsonText, QuotesBackslashesAndControlCharactersAreEscaped) {
  EXPECT_EQ(JsonString("a \"b\" c:\\d\n\xC3\xA9"), "\"a \\\"b\\\" c:\\\\d\\u000a\xC3\xA9\"");
}

TEST(KeogramPicture, HasTheMiddleColumnOfEachPictureInTheirOrder) {
  Keogram keogram;
  for (int number = 0; number < 4; ++number) {
    DisplayImage picture{5, 3, std::vector<std::uint8_t>(45, 255)};
    for (std::size_t y = 0; y < 3; ++y)
      picture.rgb[3 * (5 * y + 2) + 1] =
          static_cast<std::uint8_t>(10 * number + static_cast<int>(y));
    keogram.Add(picture);
  }
  const DisplayImage image = keogram.Image();
  ASSERT_EQ(image.width, 4);
  ASSERT_EQ(image.height, 3);
  for (std::size_t x = 0; x < 4; ++x) {
    for (std::size_t y = 0; y < 3; ++y) {
      EXPECT_EQ(image.rgb[3 * (4 * y + x)], 255);
      EXPECT_EQ(image.rgb[3 * (4 * y + x) + 1], 10 * x + y);
    }
  }
}

UtcInstant Hour(double hour) { return {61212, 3600.0 * hour}; }

std::size_t CountOf(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++count;
  return count;
}

TEST(DayPlot, CurvesHaveGapsWhereFramesHaveNoValue) {
  std::vector<PlottedMoment> moments;
  for (int i = 0; i < 24; ++i) {
    PlottedMoment moment{Hour(i), 60.0 * std::sin(0.26 * (i - 6.0)), 10.0};
    if (i < 8 || i > 15) moment.ev100 = 10.0;
    moments.push_back(moment);
  }
  const std::string svg = SvgOfDay(moments, std::nullopt);
  EXPECT_EQ(CountOf(svg, "<polyline"), 4U) << "sun, moon, and two parts of EV; no frame has lux";
  EXPECT_THAT(svg, HasSubstr(">02:00</text>"));
  EXPECT_THAT(svg, HasSubstr(">UTC</text>"));
  EXPECT_THAT(SvgOfDay(moments, "Asia/Tokyo"), HasSubstr(">Asia/Tokyo</text>"));
}

TEST(DayPlot, LightIsDrawnByItsLogarithmAndItsBlackestLeftOut) {
  std::vector<PlottedMoment> moments;
  for (int i = 0; i < 5; ++i)
    moments.push_back({Hour(i), 0.0, 0.0, i == 4 ? 0.0 : std::pow(10.0, 4 - 2 * i), 1.0});
  const std::string svg = SvgOfDay(moments, std::nullopt);
  EXPECT_THAT(svg, HasSubstr(">1e4</text>"));
  EXPECT_THAT(svg, HasSubstr(">1e-2</text>"));
  EXPECT_THAT(svg, Not(HasSubstr("\"-inf")));
  EXPECT_THAT(svg, Not(HasSubstr("\"nan")));
}

TEST(DayPlot, PublishedLevelsStandBesideTheLight) {
  const std::vector<PlottedMoment> moments{{Hour(0.0), -40.0, 50.0, 0.2, -5.0},
                                           {Hour(1.0), -40.0, 40.0, 0.15, -5.0}};
  EXPECT_THAT(SvgOfDay(moments, std::nullopt), Not(HasSubstr("full moon")));
  const std::string svg = SvgOfDay(moments, std::nullopt, PublishedLightLevels());
  EXPECT_THAT(svg, HasSubstr(">full moon, high, 0.25 to 0.32</text>"));
  EXPECT_THAT(svg, HasSubstr(">without moon, 0.001</text>"));
  EXPECT_THAT(svg, HasSubstr(">1e-3</text>")) << "the panel reaches as far as the levels";
}

TEST(DayPlot, OneFrameAndAYearOfFramesHaveTheirTicks) {
  EXPECT_THAT(SvgOfDay({{Hour(4.0), 10.0, -5.0}}, std::nullopt), HasSubstr(">04:00</text>"));
  std::vector<PlottedMoment> year;
  for (int i = 0; i < 365; ++i) year.push_back({Hour(24.0 * i), 10.0, 0.0});
  EXPECT_THAT(SvgOfDay(year, std::nullopt), HasSubstr(">06-21</text>"));
  EXPECT_LT(CountOf(SvgOfDay(year, std::nullopt), "<text"), 60U);
}

TEST(JsonManifest, SaysWhereTheMoonStandsAndNullForWhatIsNotThereYet) {
  const Frame frame{3, Hour(4.0)};
  const GeodeticPosition place = PlaceFromDegrees(46.5, 8.0, 0.0);
  FrameRecord record = RecordOf(frame, place, std::nullopt);
  record.Set("file", "f.0003.exr");
  const std::string early = JsonOfManifest({record}, {{"alpenglow.fov_deg", "60"}}, false);
  const MoonPosition moon = MoonAt(place, frame.instant);
  EXPECT_THAT(early,
              HasSubstr("\"moon_elevation_deg\":" +
                        std::to_string(moon.elevation_rad / kRadiansPerDegree).substr(0, 5)));
  EXPECT_THAT(early, HasSubstr("\"moon_illuminated\":0."));
  EXPECT_THAT(early, HasSubstr("\"utc\":\"2026-06-21T04:00:00Z\",\"local_time\":null"));
  EXPECT_THAT(early, HasSubstr("\"illuminance_lx\":null,\"ev100\":null,\"exposure\":null}"));
  EXPECT_THAT(early, HasSubstr("\"alpenglow.fov_deg\":\"60\""));
  record.Set("ev100", 14.25);
  record.Set("illuminance_lx", 1000.0);
  AddPose(frame, CameraPose{}, record);
  const std::string later = JsonOfManifest({record}, {}, true);
  EXPECT_THAT(later, HasSubstr("\"illuminance_lx\":1000,\"ev100\":14.25,"));
  EXPECT_THAT(later, HasSubstr("\"fov\":60.000000}"));
}

}  // namespace
}  // namespace alpenglow::renderer
