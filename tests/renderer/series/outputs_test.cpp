// SPDX-License-Identifier: MIT
// Files made of a series: keogram, plot, manifest and film; and tables of the times of days.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "lut/cli/messages.h"
#include "renderer/series/day_plot.h"
#include "renderer/series/day_times.h"
#include "renderer/series/keogram.h"
#include "renderer/series/manifest.h"
#include "renderer/series/video.h"
#include "tests/fixtures/environment_variable.h"
#include "tests/fixtures/report_files.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::renderer {
namespace {

using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

TEST(JsonText, SpecialCharactersAreEscaped) {
  EXPECT_EQ(JsonString("a \"b\" c:\\d\n\xC3\xA9"), "\"a \\\"b\\\" c:\\\\d\\u000a\xC3\xA9\"");
}

UtcTime Hour(double hour) { return {61212, 3600.0 * hour}; }

/// Returns a picture with a bright middle column, whose green is 10 number + row.
DisplayImage KeogramFrame(int number) {
  DisplayImage picture{5, 3, std::vector<std::uint8_t>(45, 255)};
  for (std::size_t y = 0; y < 3; ++y)
    picture.rgb[3 * (5 * y + 2) + 1] = static_cast<std::uint8_t>(10 * number + static_cast<int>(y));
  return picture;
}

Keogram KeogramOf(const std::vector<double>& hours) {
  Keogram keogram(static_cast<int>(hours.size()), std::nullopt);
  for (std::size_t i = 0; i < hours.size(); ++i)
    keogram.Add(Hour(hours[i]), KeogramFrame(static_cast<int>(i)));
  return keogram;
}

std::uint8_t GreenAt(const DisplayImage& image, int x, int y) {
  return image.rgb[static_cast<std::size_t>(3 * (image.width * y + x) + 1)];
}

TEST(KeogramPicture, HasTheMiddleColumnsOfPicturesInOrder) {
  const Keogram keogram = KeogramOf({4.0, 5.0, 6.0, 7.0});
  const DisplayImage image = keogram.Image();
  ASSERT_EQ(image.width, 4 * keogram.columns());
  ASSERT_EQ(image.height, 3 + Keogram::kScaleHeight);
  for (int x = 0; x < image.width; ++x) {
    for (int y = 0; y < 3; ++y)
      EXPECT_EQ(GreenAt(image, x, y), 10 * (x / keogram.columns()) + y) << x << " " << y;
  }
}

TEST(KeogramPicture, FramesHaveAtLeastFourColumns) {
  EXPECT_EQ(Keogram(1, std::nullopt).columns(), Keogram::kMostColumns);
  EXPECT_EQ(Keogram(64, std::nullopt).columns(), 10) << "640 together";
  EXPECT_EQ(Keogram(5000, std::nullopt).columns(), 4);
}

/// Returns the columns that have a tick of the scale.
std::vector<int> TicksOf(const DisplayImage& image) {
  std::vector<int> ticks;
  for (int x = 0; x < image.width; ++x) {
    const bool begins = GreenAt(image, x, 3) > 100 && (x == 0 || GreenAt(image, x - 1, 3) < 100);
    if (begins) ticks.push_back(x + 1);  // a tick is two pixels wide
  }
  return ticks;
}

TEST(KeogramPicture, ScaleOfHoursFollowsTheFrames) {
  std::vector<double> hours;
  for (int i = 0; i < 20; ++i) hours.push_back(4.5 + 0.25 * i);
  // 20 frames of 32 columns have room for 8 steps; 4 h 45 min need steps of an hour.
  EXPECT_THAT(TicksOf(KeogramOf(hours).Image()), testing::ElementsAre(80, 208, 336, 464, 592));
  hours.back() = 30.0;  // the day ends between the last two frames, which are 21 hours apart
  EXPECT_THAT(TicksOf(KeogramOf(hours).Image()), testing::SizeIs(testing::Ge(4)));
}

TEST(KeogramPicture, FramesOutOfOrderHaveNoFalseTicks) {
  EXPECT_THAT(TicksOf(KeogramOf({9.0, 8.0, 7.0}).Image()), testing::IsEmpty());
}

const PlotTitle kTitle{"46.5 N, 8 E"};

TEST(DayPlot, TitleHasThePlaceAndTheTimes) {
  const std::vector<PlottedMoment> moments{{Hour(4.0), 10.0, -5.0}, {Hour(6.0), 20.0, -5.0}};
  EXPECT_THAT(SvgOfDay(moments, {PlaceText({-33.94612345, 151.177222, 0.0})}),
              HasSubstr(">33.9461 S, 151.177 E: 2026-06-21T04:00:00Z to 2026-06-21T06:00:00Z<"));
}

TEST(DayPlot, CurvesHaveGapsWhereFramesHaveNoValue) {
  std::vector<PlottedMoment> moments;
  for (int i = 0; i < 24; ++i) {
    PlottedMoment moment{Hour(i), 60.0 * std::sin(0.26 * (i - 6.0)), 10.0};
    if (i < 8 || i > 15) moment.ev100 = 10.0;
    moments.push_back(moment);
  }
  const std::string svg = SvgOfDay(moments, kTitle);
  EXPECT_EQ(CountOf(svg, "<polyline"), 4U) << "sun, moon, and two parts of EV; no frame has lux";
  EXPECT_THAT(svg, HasSubstr(">02:00</text>"));
  EXPECT_THAT(svg, HasSubstr(">UTC</text>"));
  EXPECT_THAT(SvgOfDay(moments, {"Fuji", "Asia/Tokyo"}), HasSubstr(">Asia/Tokyo</text>"));
}

TEST(DayPlot, LightIsDrawnByItsLogarithmWithoutZeros) {
  std::vector<PlottedMoment> moments;
  for (int i = 0; i < 5; ++i)
    moments.push_back({Hour(i), 0.0, 0.0, i == 4 ? 0.0 : std::pow(10.0, 4 - 2 * i), 1.0});
  const std::string svg = SvgOfDay(moments, kTitle);
  EXPECT_THAT(svg, HasSubstr(">1e4</text>"));
  EXPECT_THAT(svg, HasSubstr(">1e-2</text>"));
  EXPECT_THAT(svg, Not(HasSubstr("\"-inf")));
  EXPECT_THAT(svg, Not(HasSubstr("\"nan")));
}

TEST(DayPlot, PublishedLevelsAreDrawn) {
  const std::vector<PlottedMoment> moments{{Hour(0.0), -40.0, 50.0, 0.2, -5.0},
                                           {Hour(1.0), -40.0, 40.0, 0.15, -5.0}};
  EXPECT_THAT(SvgOfDay(moments, kTitle), Not(HasSubstr("full moon")));
  const std::string svg = SvgOfDay(moments, kTitle, PublishedLightLevels());
  EXPECT_THAT(svg, HasSubstr(">full moon, high, 0.25 to 0.32</text>"));
  EXPECT_THAT(svg, HasSubstr(">without moon, 0.001</text>"));
  EXPECT_THAT(svg, HasSubstr(">1e-3</text>")) << "the panel reaches as far as the levels";
}

TEST(DayPlot, OneFrameAndAYearOfFramesHaveTheirTicks) {
  EXPECT_THAT(SvgOfDay({{Hour(4.0), 10.0, -5.0}}, kTitle), HasSubstr(">04:00</text>"));
  std::vector<PlottedMoment> year;
  for (int i = 0; i < 365; ++i) year.push_back({Hour(24.0 * i), 10.0, 0.0});
  EXPECT_THAT(SvgOfDay(year, kTitle), HasSubstr(">06-21</text>"));
  EXPECT_LT(CountOf(SvgOfDay(year, kTitle), "<text"), 60U);
}

TEST(JsonManifest, HasTheMoonAndNullForMissingValues) {
  const Frame frame{3, Hour(4.0)};
  const Place place{46.5, 8.0, 0.0};
  FrameRecord record = RecordOf(frame, place, std::nullopt);
  record.Set("file", "f.0003.exr");
  const std::string early = JsonOfManifest({record}, {{"alpenglow.fov_deg", "60"}}, false);
  const MoonPosition moon = TrueMoonAt(place, frame.instant);
  EXPECT_THAT(early, HasSubstr("\"moon_elevation_deg\":" +
                               std::to_string(moon.elevation_deg).substr(0, 5)));
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
  const std::string csv = CsvOfManifest({record}, false);
  EXPECT_THAT(csv,
              HasSubstr(",moon_azimuth_deg,moon_elevation_deg,moon_illuminated,illuminance_lx,"));
  EXPECT_THAT(csv, HasSubstr(",1000,14.25,"));
}

EventDay TromsoInJune() {
  EventDay day{Place{69.65, 18.96, 0.0}, "Europe/Oslo", {}};
  day.around = DayFromText("2026-06-21", day);
  return day;
}

std::vector<DayTimes> TimesOfDays(const EventDay& first, int count) {
  std::vector<DayTimes> days;
  VisitTimesOfDays(first, count, [&](const DayTimes& day) { days.push_back(day); });
  return days;
}

std::string TableOf(const std::vector<DayTimes>& days, const std::optional<std::string>& zone) {
  std::string text = HeadOfTable(zone);
  for (const DayTimes& day : days) text += LinesOf(day, zone);
  return text;
}

std::string CsvOf(const std::vector<DayTimes>& days) {
  std::string text = HeaderOfTimesCsv();
  for (const DayTimes& day : days) text += CsvLineOf(day);
  return text;
}

TEST(DayTimes, MissingEventsAreLeftOut) {
  const std::vector<DayTimes> days = TimesOfDays(TromsoInJune(), 2);
  ASSERT_EQ(days.size(), 2U);
  EXPECT_EQ(days[1].date, "2026-06-22");
  EXPECT_FALSE(days[0].at[3].has_value()) << "no sunrise under the midnight sun";
  EXPECT_TRUE(days[0].at[4].has_value());
  EXPECT_NEAR(days[0].noon_elevation_deg, 90.0 - 69.65 + 23.44, 0.05) << "and 1' of refraction";
  EXPECT_THAT(TableOf(days, TromsoInJune().zone),
              HasSubstr("2026-06-21 --:-- --:-- --:-- --:-- 12:4"));
  EXPECT_THAT(CsvOf(days), HasSubstr("\n2026-06-21,,,,,2026-06-21T10:4"));
}

TEST(DayTimes, TheMoonGrowsToTheFullMoon) {
  EventDay day = TromsoInJune();
  std::vector<double> illuminated;
  for (const char* date : {"2026-06-15", "2026-06-16", "2026-06-22", "2026-06-28", "2026-06-29"}) {
    day.around = DayFromText(date, day);
    illuminated.push_back(TimesOfDays(day, 1).front().moon_illuminated);
  }
  for (std::size_t i = 1; i < illuminated.size(); ++i)
    EXPECT_GT(illuminated[i], illuminated[i - 1]) << i;
  EXPECT_LT(illuminated.front(), 0.01) << "new moon of 02:54 UTC";
  EXPECT_GT(illuminated.back(), 0.99) << "full moon at 23:57 UTC";
}

EventDay EclipsedDay(double latitude_deg, double longitude_deg) {
  EventDay day{CheckedPlace({latitude_deg, longitude_deg, 0.0}), "Europe/Madrid", {}};
  day.around = DayFromText("2026-08-11", day);
  return day;
}

TEST(DayTimes, AnEclipseIsListedWithContactsToTheSecond) {
  const EventDay day = EclipsedDay(42.3439, -3.6969);  // Burgos
  const std::vector<DayTimes> days = TimesOfDays(day, 3);
  EXPECT_FALSE(days[0].eclipse);
  ASSERT_TRUE(days[1].eclipse);
  EXPECT_FALSE(days[2].eclipse);
  EXPECT_TRUE(days[1].eclipse->at_deepest.disk.IsTotal());
  EXPECT_THAT(TableOf(days, day.zone), HasSubstr("\n           eclipse of the sun: begins 19:33:"));
  EXPECT_THAT(TableOf(days, day.zone), HasSubstr(", total 20:28:"));
  EXPECT_THAT(CsvOf(days), HasSubstr(",2026-08-12T17:33:"));
  EXPECT_THAT(CsvOf(days), HasSubstr(",1.0000\n2026-08-13,"));
}

// In Palma the sun sets between third and last contact, in Istanbul before the first.
TEST(DayTimes, OnlyVisiblePartsOfAnEclipseAreListed) {
  const std::vector<DayTimes> palma = TimesOfDays(EclipsedDay(39.5696, 2.6502), 2);
  ASSERT_TRUE(palma[1].eclipse);
  EXPECT_TRUE(palma[1].eclipse->whole.inner->third_contact.IsSeen());
  EXPECT_THAT(TableOf(palma, "Europe/Madrid"), Not(HasSubstr("ends")));
  EXPECT_THAT(CsvOf(palma), HasSubstr("Z,,1.")) << "no last contact before the magnitude";
  EXPECT_FALSE(TimesOfDays(EclipsedDay(41.0, 29.0), 2)[1].eclipse);
}

// In Rome the sun sets on the sea horizon while the eclipse still grows.
TEST(DayTimes, AnEclipseWithAHiddenMaximumIsDeepestAtSunset) {
  const DayTimes rome = TimesOfDays(EclipsedDay(41.9, 12.5), 2)[1];
  ASSERT_TRUE(rome.eclipse);
  EXPECT_FALSE(rome.eclipse->whole.maximum.IsSeen());
  EXPECT_EQ(rome.eclipse->at_deepest.instant, rome.at[5]);
  EXPECT_LT(rome.eclipse->at_deepest.disk.Magnitude(),
            rome.eclipse->whole.maximum.disk.Magnitude());
}

TEST(FrameList, HasALineForEachFrameWithSunAndMoon) {
  const EventDay day = TromsoInJune();
  std::vector<FrameRecord> records;
  for (const Frame& frame :
       FramesFromTimes({{"noon", "2026-06-21T22:00:00Z"}, {}, {}, {}, {}}, day)) {
    records.push_back(RecordOf(frame, day.place, day.zone));
    records.back().Set("file", FrameName("night.%03d.exr").Picture(frame.number).string());
  }
  std::string text = HeaderOfList();
  for (const FrameRecord& record : records) text += ListLineOf(record);
  EXPECT_THAT(text, HasSubstr("\n0,2026-06-21T10:4"));
  EXPECT_THAT(text, HasSubstr("\n1,2026-06-21T22:00:00Z,2026-06-22T00:00:00+02:00,"));
  EXPECT_THAT(text, HasSubstr(",night.001.exr\n"));
}

TEST(FrameList, AzimuthsAreInTheHalfOpenCircleAfterRounding) {
  FrameRecord record;
  record.Set("sun_azimuth_deg", 359.9998);
  record.Set("moon_azimuth_deg", 359.9994);
  EXPECT_EQ(ListLineOf(record), ",,,0.000,,,359.999,,,\n");
  record.Set("heading", -1e-9);
  record.Set("sun_azimuth_deg", 359.99996);
  EXPECT_THAT(CsvOfManifest({record}, true),
              HasSubstr("\n,,,,0.0000,,,359.9994,,,,,,,,,,0.000000,,,\n"));
  record.Set("heading", -90.0);
  EXPECT_THAT(JsonOfManifest({record}, {}, true), HasSubstr("\"heading\":270.000000,"));
}

class Videos : public TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    path_ = std::getenv("PATH");
  }
  void TearDown() override {
    setenv("PATH", path_.c_str(), 1);
    TemporaryFolder::TearDown();
  }
  /// Makes a shell script the first ffmpeg on the PATH.
  void UseFfmpeg(const std::string& script) {
    fs::create_directory(folder_ / "bin");
    WriteText(folder_ / "bin" / "ffmpeg", "#!/bin/sh\n" + script + "\n");
    fs::permissions(folder_ / "bin" / "ffmpeg", fs::perms::owner_all);
    setenv("PATH", ((folder_ / "bin").string() + ":" + path_).c_str(), 1);
  }
  /// Returns the fault with which writing a film ends.
  [[nodiscard]] std::string FaultOfVideo(
      int frames, const std::function<DisplayImage(int)>& frame = Frame) const {
    try {
      WriteVideo(File(), {64, 64, 25.0, {}}, frames, frame);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "no fault";
  }
  [[nodiscard]] fs::path File() const { return folder_ / "film.mp4"; }

  /// Returns red that fades from frame to frame, over constant green.
  static DisplayImage Frame(int number) {
    DisplayImage image{64, 64, {}};
    for (int pixel = 0; pixel < 64 * 64; ++pixel) {
      const bool upper = pixel < 32 * 64;
      image.rgb.push_back(static_cast<std::uint8_t>(upper ? 200 - 10 * number : 0));
      image.rgb.push_back(static_cast<std::uint8_t>(upper ? 0 : 150));
      image.rgb.push_back(0);
    }
    return image;
  }

 private:
  std::string path_;
};

TEST_F(Videos, AFilmHasThePicturesInOrderAndColour) {
  if (RunCommand("ffmpeg -version").status != 0) GTEST_SKIP() << "there is no ffmpeg here";
  const int frames = 10;
  WriteVideo(File(), {64, 64, 25.0, {{"alpenglow.scene", "a test"}}}, frames, Frame);
  EXPECT_EQ(FileCount(), 1U) << "the film and nothing else";
  ASSERT_EQ(RunCommand("ffmpeg -i film.mp4 -f rawvideo -pix_fmt rgb24 film.raw").status, 0);
  const std::string raw = ContentOf(folder_ / "film.raw");
  const std::size_t bytes = std::size_t{3} * 64 * 64;
  ASSERT_EQ(raw.size(), bytes * frames);
  for (int number = 0; number < frames; ++number) {
    const auto at = [&](std::size_t row, std::size_t channel) {
      const std::size_t pixel = row * 64 + 30;
      return static_cast<int>(static_cast<unsigned char>(
          raw[static_cast<std::size_t>(number) * bytes + 3 * pixel + channel]));
    };
    EXPECT_NEAR(at(10, 0), 200 - 10 * number, 6) << "eight bits of luma, compressed";
    EXPECT_NEAR(at(10, 1), 0, 6);
    EXPECT_NEAR(at(50, 1), 150, 6) << "the lower half stays green";
  }
  EXPECT_THAT(RunCommand("ffmpeg -i film.mp4").error, HasSubstr("alpenglow.scene=a test"));
  const auto odd = [](int) {
    return DisplayImage{63, 35, std::vector<std::uint8_t>(std::size_t{3} * 63 * 35, 99)};
  };
  WriteVideo(folder_ / "odd.mkv", {63, 35, 25.0, {}}, 3, odd);
  EXPECT_THAT(RunCommand("ffmpeg -i odd.mkv").error, HasSubstr("64x36")) << "odd sides get a line";
}

TEST_F(Videos, MissingFfmpegIsReportedBeforeAnythingIsDrawn) {
  setenv("PATH", folder_.c_str(), 1);
  EXPECT_THROW(RequireVideo(File()), OutputError);
  const auto frame = [](int) -> DisplayImage { throw InputError("a frame was drawn"); };
  EXPECT_THAT(FaultOfVideo(1, frame), HasSubstr("needs ffmpeg"));
  EXPECT_EQ(FileCount(), 0U);
}

TEST_F(Videos, MessagesOfFfmpegAreReportedAndNoFileIsLeft) {
  UseFfmpeg("echo a first line >&2; echo Unknown encoder >&2; exit 1");
  EXPECT_THAT(FaultOfVideo(100), HasSubstr("ffmpeg: Unknown encoder"));
  UseFfmpeg("while read -r line; do :; done; exit 7");
  EXPECT_THAT(FaultOfVideo(3), HasSubstr("gives no reason"));
  UseFfmpeg("kill -9 $$");
  EXPECT_THAT(FaultOfVideo(100), HasSubstr("film.mp4")) << "the file that is missing is named";
  EXPECT_EQ(FileCount(), 1U) << "the folder of the script";
}

TEST_F(Videos, NeedNoFolderForTemporaries) {
  const EnvironmentVariable missing("TMPDIR", (folder_ / "missing").c_str());
  UseFfmpeg("echo Unknown encoder >&2; exit 1");
  EXPECT_THAT(FaultOfVideo(100), HasSubstr("ffmpeg: Unknown encoder"));
}

TEST_F(Videos, AFrameThatFailsLeavesNoFileAndNoProcess) {
  UseFfmpeg("echo $$ > " + (folder_ / "process").string() + "; exec sleep 1000");
  const auto frame = [&](int number) {
    if (number == 1) throw InputError("the second picture");
    while (ContentOf(folder_ / "process").empty()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return Frame(number);
  };
  EXPECT_EQ(FaultOfVideo(3, frame), "the second picture");
  EXPECT_NE(kill(std::stoi(ContentOf(folder_ / "process")), 0), 0) << "it has been ended";
  EXPECT_FALSE(fs::exists(File()));
}

TEST_F(Videos, UnknownFileTypesAreRefused) {
  EXPECT_THROW(RequireVideo("film.gif"), InputError);
  EXPECT_THROW(RequireVideo("film"), InputError);
}

}  // namespace
}  // namespace alpenglow::renderer
