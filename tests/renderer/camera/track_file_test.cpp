// SPDX-License-Identifier: MIT
#include "renderer/camera/track.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "atmosphere/math/constants.h"
#include "renderer/camera/track_file.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::renderer {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class TrackFile : public TemporaryFolder {
 protected:
  [[nodiscard]] Track Read(const std::string& text, const char* name = "t.gpx") const {
    WriteText(folder_ / name, text);
    return ReadTrack(folder_ / name);
  }
  [[nodiscard]] std::string Fault(const std::string& text) const {
    return tests::FaultOf([&] { return Read(text).points.size(); });
  }
};

constexpr char kGpx[] = R"(<?xml version="1.0" encoding="UTF-8"?>
<gpx version="1.1" creator="test" xmlns="http://www.topografix.com/GPX/1/1">
  <wpt lat="1" lon="2"><name>not on the track</name></wpt>
  <trk><name> Over the pass </name>
    <trkseg>
      <trkpt lat="46.5" lon="8.0"><ele>2000.5</ele><time>2026-06-21T04:00:00Z</time></trkpt>
      <trkpt lat="46.51" lon="8.01"><ele>2010</ele><time>2026-06-21T04:00:10.500Z</time></trkpt>
    </trkseg>
    <trkseg>
      <trkpt lat="46.52" lon="8.02"><ele>2020</ele><time>2026-06-21T06:00:20+02:00</time></trkpt>
    </trkseg>
  </trk>
</gpx>
)";

TEST_F(TrackFile, AllSegmentsOfAGpxTrackAreReadInOrder) {
  const Track track = Read(kGpx);
  EXPECT_EQ(track.name, "Over the pass");
  EXPECT_EQ(track.heights, TrackHeights::kSea);
  ASSERT_EQ(track.points.size(), 3U);
  EXPECT_NEAR(track.points[1].place.latitude_deg, 46.51, 1e-12);
  EXPECT_NEAR(track.points[1].place.longitude_deg, 8.01, 1e-12);
  EXPECT_EQ(track.points[0].place.height_m, 2000.5);
  EXPECT_EQ(FormatUtc(*track.points[1].utc, 1), "2026-06-21T04:00:10.5Z");
  EXPECT_EQ(FormatUtc(*track.points[2].utc), "2026-06-21T04:00:20Z");
}

TEST_F(TrackFile, RoutesAndWaypointsAreReadIfThereIsNoTrack) {
  const Track route = Read(
      "<gpx><rte><name>R</name><rtept lat='1' lon='2'/><rtept lat='3' lon='4'/></rte>"
      "<rte><rtept lat='5' lon='6'/></rte></gpx>");
  EXPECT_EQ(route.points.size(), 2U) << "the first route";
  EXPECT_EQ(route.note, "the first of 2 routes is read");
  EXPECT_EQ(route.heights, TrackHeights::kOnGround) << "no heights";
  EXPECT_FALSE(route.points[0].utc);
  EXPECT_EQ(Read("<gpx><wpt lat='1' lon='2'/><wpt lat='3' lon='4'/></gpx>").points.size(), 2U);
}

TEST_F(TrackFile, ALineOfKmlIsReadLongitudeFirst) {
  const Track track = Read(R"(<kml xmlns="http://www.opengis.net/kml/2.2"><Document><Placemark>
      <name>Valley</name><LineString><altitudeMode>absolute</altitudeMode><coordinates>
        8.0,46.5,1000  8.1,46.6,1100
        8.2,46.7,1200
      </coordinates></LineString></Placemark></Document></kml>)",
                           "t.kml");
  EXPECT_EQ(track.name, "Valley");
  EXPECT_EQ(track.heights, TrackHeights::kSea);
  ASSERT_EQ(track.points.size(), 3U);
  EXPECT_NEAR(track.points[2].place.latitude_deg, 46.7, 1e-12);
  EXPECT_EQ(track.points[2].place.height_m, 1200.0);
  const auto heights = [&](const std::string& mode) {
    return Read("<kml><LineString>" + mode +
                "<coordinates>8,46 8.1,46</coordinates></LineString></kml>")
        .heights;
  };
  EXPECT_EQ(heights(""), TrackHeights::kOnGround) << "KML's default";
  EXPECT_EQ(heights("<altitudeMode>relativeToGround</altitudeMode>"), TrackHeights::kOverGround);
  EXPECT_EQ(heights("<altitudeMode>clampToGround</altitudeMode>"), TrackHeights::kOnGround);
}

TEST_F(TrackFile, ATrackOfKmlHasItsTimes) {
  const Track track = Read(R"(<kml><Placemark><gx:Track><altitudeMode>absolute</altitudeMode>
      <when>2026-06-21T04:00:00Z</when><when>2026-06-21T04:00:05Z</when>
      <gx:coord>8.0 46.5 1000</gx:coord><gx:coord>8.1 46.6 1100</gx:coord>
      </gx:Track></Placemark></kml>)",
                           "t.kml");
  ASSERT_EQ(track.points.size(), 2U);
  EXPECT_EQ(FormatUtc(*track.points[1].utc), "2026-06-21T04:00:05Z");
  EXPECT_NEAR(track.points[1].place.longitude_deg, 8.1, 1e-12);
}

TEST_F(TrackFile, AFaultIsReportedWithItsFileAndLine) {
  const std::string file = (folder_ / "t.gpx").string();
  const auto gpx = [](const std::string& point) {
    return "<gpx>\n<trk><trkseg>\n" + point + "\n</trkseg></trk></gpx>";
  };
  struct Case {
    std::string text;
    int line;
    const char* fault;
  };
  const Case cases[] = {
      {"", 1, "this is no XML"},
      {"t_s,latitude", 1, "this is no XML"},
      {"<gpx>\n<trk>\n</gpx>", 2,
       "its XML is cut off, damaged or nested too deeply (XML_ERROR_MISMATCHED_ELEMENT)"},
      {"<gpx>\n<trk><trkseg>\n<trkpt lat='46' lon='8'><ele>9", 3, "its XML is cut off"},
      {"<svg/>", 1, "<svg> is neither GPX nor KML"},
      {"\n<gpx/>", 2, "there is no trkpt, rtept or wpt in it"},
      {gpx("<trkpt lon='8'/>"), 3, "<trkpt> has no lat"},
      {gpx("<trkpt lat='north' lon='8'/>"), 3, "lat is \"north\"; it must be a number"},
      {gpx("<trkpt lat='91' lon='8'/>"), 3, "latitude is 91"},
      {gpx("<trkpt lat='inf' lon='8'/>"), 3, "latitude is inf"},
      {gpx("<trkpt lat='nan' lon='8'/>"), 1, "none of its points has a place"},
      {"\xFF\xFE<\0g\0", 1, "this is UTF-16"},
      {"<kml><gx:Track><altitudeMode>absolute</altitudeMode></gx:Track>\n<gx:Track/></kml>", 2,
       "its altitudeMode is not that of the lines before it"},
      {"<kml>\n</kml>", 1, "there is no gx:Track and no LineString in it"},
      {"<kml><LineString>\n<coordinates>8</coordinates></LineString></kml>", 2,
       "\"8\" is no coordinate"},
      {"<kml><LineString>\n<coordinates>8,46,1,2</coordinates></LineString></kml>", 2,
       "is no coordinate"},
      {"<kml>\n<LineString><coordinates/></LineString></kml>", 2, "it has no points"},
      {"<kml><LineString>\n<altitudeMode>moon</altitudeMode></LineString></kml>", 2,
       "altitudeMode is \"moon\""},
      {"<kml>\n<gx:Track><gx:coord>8 46</gx:coord></gx:Track></kml>", 2,
       "it has 1 gx:coord and 0 when"},
  };
  for (const Case& one : cases) {
    const std::string fault = Fault(one.text);
    EXPECT_THAT(fault, HasSubstr(one.fault)) << one.text;
    EXPECT_THAT(fault, StartsWith(file + ":" + std::to_string(one.line) + ": ")) << one.text;
  }
  EXPECT_THAT(tests::FaultOf([&] { return ReadTrack(folder_ / "none.gpx").points.size(); }),
              HasSubstr("none.gpx"));
}

// Returns a point of a track, `hundredths` of a degree east of 8 E. An empty height or time is left
// out.
std::string TrackPointText(int hundredths, const std::string& height, const std::string& time) {
  std::string text = "<trkpt lat='46.5' lon='8.0" + std::to_string(hundredths) + "'>";
  if (!height.empty()) text += "<ele>" + height + "</ele>";
  if (!time.empty()) text += "<time>2026-06-21T10:0" + time + "Z</time>";
  return text + "</trkpt>";
}
std::string GpxOf(const std::string& points) {
  return "<gpx><trk><trkseg>" + points + "</trkseg></trk></gpx>";
}
std::vector<double> HeightsOf(const Track& track) {
  std::vector<double> heights_m;
  for (const TrackPoint& point : track.points) heights_m.push_back(point.place.height_m);
  return heights_m;
}
std::vector<std::string> ClockTimesOf(const Track& track) {
  std::vector<std::string> times;
  for (const TrackPoint& point : track.points)
    times.push_back(FormatUtc(point.utc.value()).substr(11, 8));
  return times;
}
MATCHER_P(IsAbout, expected, "") { return std::abs(arg - expected) < 1e-2; }

TEST_F(TrackFile, HeightsThatSomePointsLackAreInterpolated) {
  const Track first =
      Read(GpxOf(TrackPointText(0, "", "0:00") + TrackPointText(2, "4250", "1:00") +
                 TrackPointText(4, "4300", "2:00") + TrackPointText(6, "4350", "3:00")));
  EXPECT_EQ(first.heights, TrackHeights::kSea);
  EXPECT_THAT(HeightsOf(first),
              ElementsAre(IsAbout(4200.0), IsAbout(4250.0), IsAbout(4300.0), IsAbout(4350.0)));
  EXPECT_EQ(first.note, "1 of 4 points have no height, which is interpolated");
  const Track inside = Read(GpxOf(TrackPointText(0, "100", "") + TrackPointText(1, "nan", "") +
                                  TrackPointText(3, " ", "") + TrackPointText(4, "500", "") +
                                  TrackPointText(5, "", "") + TrackPointText(9, "", "")));
  EXPECT_THAT(HeightsOf(inside), ElementsAre(IsAbout(100.0), IsAbout(200.0), IsAbout(400.0),
                                             IsAbout(500.0), IsAbout(600.0), IsAbout(900.0)))
      << "on with the slope, for no longer than the step it is of";
  EXPECT_THAT(inside.note, HasSubstr("4 of 6 points have no height"));
}

TEST_F(TrackFile, TimesThatSomePointsLackAreInterpolated) {
  const Track ends = Read(GpxOf(TrackPointText(0, "1", "") + TrackPointText(0, "1", "0:00") +
                                TrackPointText(2, "1", "1:00") + TrackPointText(3, "1", "") +
                                TrackPointText(4, "1", "2:00") + TrackPointText(6, "1", "")));
  EXPECT_THAT(ClockTimesOf(ends),
              ElementsAre("10:00:00", "10:00:00", "10:01:00", "10:01:30", "10:02:00", "10:03:00"));
  EXPECT_EQ(ends.note, "3 of 6 points have no time, which is interpolated");
  const Track one = Read(GpxOf(TrackPointText(0, "1", "0:00") + TrackPointText(2, "1", "")));
  EXPECT_FALSE(one.points[0].utc);
  EXPECT_THAT(one.note, HasSubstr("flown with an even speed"));
}

TEST_F(TrackFile, APointWithAnImpossibleTimeIsLeftOutAndCounted) {
  const auto odd = [](int year) {
    return "<trkpt lat='46.5' lon='8'><time>" + std::to_string(year) +
           "-02-05T10:00:00Z</time></trkpt>";
  };
  const std::string a = TrackPointText(2, "1", "1:00"), b = TrackPointText(4, "1", "2:00"),
                    c = TrackPointText(6, "1", "3:00"), rest = a + b + c;
  const std::vector<std::string> texts = {odd(2045) + rest,
                                          rest + odd(2045),
                                          odd(1980) + rest,
                                          rest + odd(1980),
                                          a + odd(2045) + b + c,
                                          a + b + TrackPointText(5, "1", "0:30") + c,
                                          a + TrackPointText(3, "1", "1:00") + b + c};
  for (const std::string& text : texts) {
    const Track track = Read(GpxOf(text));
    EXPECT_THAT(ClockTimesOf(track), ElementsAre("10:01:00", "10:02:00", "10:03:00")) << text;
    EXPECT_EQ(track.note,
              "1 of 4 points have a time that does not fit the others' and are left out")
        << text;
  }
  EXPECT_EQ(Read(GpxOf(rest + TrackPointText(6, "1", "3:00"))).note, "") << "the same point twice";
  EXPECT_EQ(Read(GpxOf(rest)).note, "");
}

/// Returns nine points a kilometre apart, each 100 m higher and a minute later than the one before,
/// as GPX; `texts` replaces some of them.
std::string WalkWith(const std::map<int, std::string>& texts) {
  std::string points;
  for (int i = 0; i < 9; ++i) {
    const auto other = texts.find(i);
    points += other != texts.end() ? other->second
                                   : fmt::format(
                                         "<trkpt lat='{}' lon='8'><ele>{}</ele><time>"
                                         "2026-06-21T10:0{}:00Z</time></trkpt>",
                                         46.0 + 0.01 * i, 1000 + 100 * i, i);
  }
  return GpxOf(points);
}
/// Returns point i of the walk with another value of one kind.
std::string WalkPoint(int i, const std::string& lat_lon, const std::string& height = "",
                      const std::string& time = "") {
  return fmt::format("<trkpt {}><ele>{}</ele><time>{}</time></trkpt>",
                     lat_lon.empty() ? fmt::format("lat='{}' lon='8'", 46.0 + 0.01 * i) : lat_lon,
                     height.empty() ? fmt::format("{}", 1000 + 100 * i) : height,
                     time.empty() ? fmt::format("2026-06-21T10:0{}:00Z", i) : time);
}

// Places that receivers and programs write when they have none, and places out of reach.
TEST_F(TrackFile, APointAtAnOddPlaceIsLeftOutWhereverItStands) {
  for (const char* odd :
       {"lat='0' lon='0'", "lat='0.0' lon='0.0'", "lat='100' lon='180'", "lat='8' lon='46'",
        "lat='-46' lon='8'", "lat='90' lon='0'", "lat='47' lon='8'", "lat='1e9' lon='8'",
        "lat='inf' lon='8'", "lat='46.0x' lon='8'", "lat='' lon=''", "lat='46' lon='-400'",
        "lon='8'"}) {
    for (const std::vector<int>& at : {std::vector{0}, {4}, {8}, {0, 1}, {3, 4, 5}, {7, 8}}) {
      std::map<int, std::string> texts;
      for (const int i : at) texts[i] = WalkPoint(i, odd);
      const Track track = Read(WalkWith(texts));
      EXPECT_EQ(track.points.size(), 9U - at.size()) << odd << " at " << at.front();
      for (const TrackPoint& point : track.points)
        EXPECT_LT(std::abs(point.place.latitude_deg - 46.04), 0.05) << odd;
      EXPECT_THAT(track.note, StartsWith(fmt::format("{} of 9 points have ", at.size()))) << odd;
      EXPECT_THAT(track.note, Not(HasSubstr("\n"))) << "one line";
    }
  }
}

TEST_F(TrackFile, APointWithAnOddHeightKeepsItsPlace) {
  for (const char* odd : {"-9999", "-9999.0", "-32768", "65535", "32767", "nan", "high", "1e300",
                          "-inf", "25000", "-6000"}) {
    for (const std::vector<int>& at : {std::vector{0}, {4}, {8}, {0, 1}, {3, 4, 5}, {7, 8}}) {
      std::map<int, std::string> texts;
      for (const int i : at) texts[i] = WalkPoint(i, "", odd);
      const Track track = Read(WalkWith(texts));
      ASSERT_EQ(track.points.size(), 9U) << odd;
      for (int i = 0; i < 9; ++i) {
        EXPECT_NEAR(track.points[static_cast<std::size_t>(i)].place.height_m, 1000.0 + 100.0 * i,
                    at.size() > 1 && (at.front() == 0 || at.back() == 8) ? 101.0 : 1.0)
            << odd << " at " << i << "; at the ends it goes on for one step, then level";
      }
      EXPECT_THAT(track.note, HasSubstr(fmt::format("{} of 9 points have ", at.size()))) << odd;
    }
  }
}

TEST_F(TrackFile, APointWithAnOddTimeDoesNotSpoilTheFile) {
  for (const char* odd :
       {"0000-03-13T00:00:00Z", "null", "noon", "1980-01-06T00:00:01Z", "2006-11-05T10:00:00Z",
        "2045-02-05T10:00:00Z", "-0044-03-15T12:00:00Z"}) {
    for (const std::vector<int>& at : {std::vector{0}, {4}, {8}, {0, 1}, {3, 4, 5}, {7, 8}}) {
      std::map<int, std::string> texts;
      for (const int i : at) texts[i] = WalkPoint(i, "", "", odd);
      const Track track = Read(WalkWith(texts));
      EXPECT_GE(track.points.size(), 9U - at.size()) << odd;
      for (const TrackPoint& point : track.points) {
        ASSERT_TRUE(point.utc) << odd;
        const double minutes = (point.place.latitude_deg - 46.0) / 0.01;
        EXPECT_NEAR(SecondsBetween(ParseInstant("2026-06-21T10:00:00Z"), *point.utc),
                    60.0 * minutes, 1.0)
            << odd << ": a point that is kept has the time that its place tells";
      }
      EXPECT_THAT(track.note, HasSubstr(fmt::format("{} of 9 points have ", at.size()))) << odd;
    }
  }
}

TEST_F(TrackFile, OddPointsOfKmlAreLeftOutLikeThoseOfGpx) {
  const Track track = Read(R"(<kml><gx:Track><altitudeMode>absolute</altitudeMode>
      <when>0000-03-13T00:00:00Z</when><gx:coord>0 0 0</gx:coord>
      <when>2026-06-21T10:01:00Z</when><gx:coord>8.01 46.5 1100</gx:coord>
      <when>2026-06-21T10:02:00Z</when><gx:coord>8.02 46.5 -9999</gx:coord>
      <when>2026-06-21T10:03:00Z</when><gx:coord>8.03 46.5 1300</gx:coord>
      <when>2026-06-21T10:04:00Z</when><gx:coord>180 100 0</gx:coord>
      <when>2026-06-21T10:05:00Z</when><gx:coord>8.05 46.5 1500</gx:coord>
      </gx:Track></kml>)",
                           "t.kml");
  EXPECT_THAT(HeightsOf(track), ElementsAre(1100.0, IsAbout(1200.0), 1300.0, 1500.0));
  EXPECT_EQ(track.points[2].segment, 0);
  EXPECT_EQ(track.points[3].segment, 1) << "latitude 100 marks a pause";
  const Track line = Read(
      "<kml><LineString><altitudeMode>absolute</altitudeMode><coordinates>8,46,1000 0,0,0 "
      "8.01,46,65535 8.02,46,1200</coordinates></LineString></kml>",
      "l.kml");
  EXPECT_THAT(HeightsOf(line), ElementsAre(1000.0, IsAbout(1100.0), 1200.0));
}

TEST_F(TrackFile, AFileOfOddPointsAloneSaysWhatIsWrong) {
  std::map<int, std::string> nowhere, unreadable, no_height, no_time, one_time;
  for (int i = 0; i < 9; ++i) {
    nowhere[i] = WalkPoint(i, "lat='0' lon='0'");
    unreadable[i] = WalkPoint(i, "lat='100' lon='180'");
    no_height[i] = WalkPoint(i, "", "-9999");
    no_time[i] = WalkPoint(i, "", "", "0000-00-00T00:00:00Z");
    one_time[i] = WalkPoint(i, "", "", "2026-06-21T10:00:00Z");
  }
  EXPECT_THAT(Fault(WalkWith(nowhere)), HasSubstr("none of its points has a place"));
  EXPECT_THAT(Fault(WalkWith(unreadable)),
              HasSubstr("none of the points of the file has a place: latitude is 100"));
  const Track on_ground = Read(WalkWith(no_height));
  EXPECT_EQ(on_ground.heights, TrackHeights::kOnGround);
  EXPECT_THAT(on_ground.note, HasSubstr("9 of 9 points have a height that does not fit"));
  const Track even = Read(WalkWith(no_time));
  EXPECT_EQ(even.points.size(), 9U);
  EXPECT_FALSE(even.points[0].utc);
  const Track frozen = Read(WalkWith(one_time));
  EXPECT_EQ(frozen.points.size(), 9U);
  EXPECT_FALSE(frozen.points[0].utc);
  EXPECT_THAT(frozen.note, HasSubstr("flown with an even speed"));
}

// The Gulf of Guinea, an airliner, a rocket and a train after a walk: nothing is odd about them.
TEST_F(TrackFile, PlacesThatCanBeReachedAreKept) {
  const auto kept = [&](const std::vector<std::pair<double, double>>& lat_lon, double step_s) {
    std::string points;
    for (std::size_t i = 0; i < lat_lon.size(); ++i) {
      points += fmt::format(
          "<trkpt lat='{}' lon='{}'><time>{}</time></trkpt>", lat_lon[i].first, lat_lon[i].second,
          FormatUtc(
              AddSeconds(ParseInstant("2026-06-21T10:00:00Z"), step_s * static_cast<double>(i)),
              3));
    }
    return Read(GpxOf(points)).points.size();
  };
  EXPECT_EQ(kept({{-0.01, 0.0}, {0.0, 0.0}, {0.01, 0.0}, {0.02, 0.01}}, 60.0), 4U);
  EXPECT_EQ(kept({{46.0, 8.0}, {46.03, 8.0}, {46.06, 8.0}, {46.09, 8.0}}, 10.0), 4U);
  EXPECT_EQ(kept({{46.0, 8.0}, {46.7, 8.0}, {47.4, 8.0}, {48.1, 8.0}}, 10.0), 4U);
  EXPECT_EQ(kept({{46.0, 8.0}, {46.0001, 8.0}, {46.0002, 8.0}, {46.02, 8.0}, {46.04, 8.0}}, 30.0),
            5U);
}

// A single time is no measure of speed: a leg of 50 km beside steps of 1 km is one of a drawn
// route.
TEST_F(TrackFile, ASingleTimeDropsNoPoint) {
  std::string points;
  for (int i = 0; i < 10; ++i)
    points += fmt::format("<trkpt lat='{}' lon='8'><ele>{}</ele>{}</trkpt>",
                          46.0 + 0.009 * i + (i > 6 ? 0.45 : 0.0), i > 6 ? 9000 : 1000,
                          i == 3 ? "<time>2026-06-21T10:00:00Z</time>" : "");
  const Track track = Read(GpxOf(points));
  EXPECT_EQ(track.points.size(), 10U) << track.note;
  EXPECT_EQ(track.points.back().place.height_m, 9000.0) << "8 km up in 50 km, a slope of 0.16";
  EXPECT_THAT(track.note, HasSubstr("fewer than two points have a time"));
  EXPECT_THAT(track.note, Not(HasSubstr("does not fit")));
}

// 208 km in an hour: the long leg takes its share of the way, not a ninth of the hour.
TEST_F(TrackFile, ALongLegWithoutTimesIsFlownAtTheSpeedOfTheRest) {
  std::string points;
  double latitude = 46.0;
  for (int i = 0; i < 10; ++i) {
    const char* const time = i == 0   ? "<time>2026-06-21T10:00:00Z</time>"
                             : i == 9 ? "<time>2026-06-21T11:00:00Z</time>"
                                      : "";
    points += fmt::format("<trkpt lat='{}' lon='8'><ele>1000</ele>{}</trkpt>", latitude, time);
    latitude += i == 6 ? 1.8 : 0.009;
  }
  const Track track = Read(GpxOf(points));
  EXPECT_EQ(track.points.size(), 10U) << track.note;
  EXPECT_THAT(track.note, Not(HasSubstr("does not fit")));
}

TEST_F(TrackFile, PointsAreInTheOrderOfTheirTimes) {
  const std::string newer = TrackPointText(4, "1", "2:00") + TrackPointText(6, "1", "3:00");
  const std::string older = TrackPointText(0, "1", "0:00") + TrackPointText(2, "1", "1:00");
  const Track tracks = Read("<gpx><trk><trkseg>" + newer + "</trkseg></trk><trk><trkseg>" + older +
                            "</trkseg></trk></gpx>");
  EXPECT_THAT(ClockTimesOf(tracks), ElementsAre("10:00:00", "10:01:00", "10:02:00", "10:03:00"));
  EXPECT_EQ(tracks.note, "");
  EXPECT_EQ(tracks.points[1].segment, 0);
  EXPECT_EQ(tracks.points[2].segment, 1) << "there is a gap between the tracks";
  const Track turned = Read(GpxOf(TrackPointText(4, "1", "2:00") + TrackPointText(2, "1", "1:00") +
                                  TrackPointText(0, "1", "0:00")));
  EXPECT_THAT(ClockTimesOf(turned), ElementsAre("10:00:00", "10:01:00", "10:02:00"));
}

TEST_F(TrackFile, ALostFixIsLeftOutAndCounted) {
  const Track kml = Read(R"(<kml><gx:MultiTrack><altitudeMode>absolute</altitudeMode><gx:Track>
      <when>2026-06-21T09:59:50Z</when><gx:coord/>
      <when>2026-06-21T10:00:00Z</when><gx:coord>8.00 46.50 4200</gx:coord>
      <when>2026-06-21T10:01:00Z</when><gx:coord>8.02  46.50	4300</gx:coord>
      <when>2026-06-21T10:02:00Z</when><gx:coord> </gx:coord>
      </gx:Track></gx:MultiTrack></kml>)",
                         "t.kml");
  EXPECT_THAT(ClockTimesOf(kml), ElementsAre("10:00:00", "10:01:00"));
  EXPECT_EQ(kml.heights, TrackHeights::kSea) << "as the MultiTrack says";
  EXPECT_THAT(HeightsOf(kml), ElementsAre(4200.0, 4300.0));
  EXPECT_EQ(kml.note, "2 of 4 points have no place (a lost fix) and are left out");
  const Track gpx = Read(GpxOf("<trkpt lat='' lon='8'/><trkpt lat='46' lon='NaN'/>" +
                               TrackPointText(0, "1", "") + TrackPointText(2, "1", "")));
  EXPECT_EQ(gpx.points.size(), 2U);
  EXPECT_THAT(gpx.note, HasSubstr("2 of 4 points"));
}

TEST_F(TrackFile, AnAltitudeModeHoldsInsideItsElement) {
  const auto heights = [&](const std::string& around, const std::string& own) {
    return Read("<kml><Folder><Placemark><gx:MultiTrack>" + around + "<gx:Track>" + own +
                    "<when>2026-06-21T10:00:00Z</when><gx:coord>8 46 9</gx:coord></gx:Track>"
                    "</gx:MultiTrack></Placemark></Folder></kml>",
                "t.kml")
        .heights;
  };
  const std::string absolute = "<altitudeMode>absolute</altitudeMode>";
  const std::string sea_floor = "<gx:altitudeMode>relativeToSeaFloor</gx:altitudeMode>";
  EXPECT_EQ(heights("", ""), TrackHeights::kOnGround);
  EXPECT_EQ(heights(absolute, ""), TrackHeights::kSea);
  EXPECT_EQ(heights("", absolute), TrackHeights::kSea);
  EXPECT_EQ(heights(absolute, sea_floor), TrackHeights::kOverGround) << "its own comes first";
  EXPECT_EQ(heights(sea_floor, ""), TrackHeights::kOverGround);
}

TEST_F(TrackFile, PrefixesOfNamespacesAndByteOrderMarksAreRead) {
  const Track track = Read(
      "\xEF\xBB\xBF<?xml version='1.0'?><g:gpx xmlns:g='http://www.topografix.com/GPX/1/1'>"
      "<g:trk><g:trkseg><g:trkpt lat='46' lon='8'><g:ele>5</g:ele>"
      "<g:time>2026-06-21T12:00:00.250+02:00</g:time></g:trkpt></g:trkseg></g:trk></g:gpx>");
  ASSERT_EQ(track.points.size(), 1U);
  EXPECT_EQ(track.points[0].place.height_m, 5.0);
  EXPECT_EQ(FormatUtc(*track.points[0].utc, 2), "2026-06-21T10:00:00.25Z");
}

TEST_F(TrackFile, EveryTruncationOfAFileIsRefused) {
  const std::string whole = kGpx;
  for (std::size_t length = 0; length + 3 < whole.size(); length += 7) {
    EXPECT_NE(Fault(whole.substr(0, length)), "no fault") << length;
  }
}

TEST_F(TrackFile, DeeplyNestedElementsAreRefused) {
  std::string deep = "<gpx>";
  for (int i = 0; i < 10000; ++i) deep += "<a>";
  EXPECT_THAT(Fault(deep), HasSubstr("nested too deeply"));
}

}  // namespace
}  // namespace alpenglow::renderer
