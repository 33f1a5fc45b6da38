// SPDX-License-Identifier: MIT
#include "renderer/camera/track_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "atmosphere/number/constants.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

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

double Degrees(double radians) { return radians / kRadiansPerDegree; }

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

TEST_F(TrackFile, AllSegmentsOfAGpxTrackAreReadOneAfterTheOther) {
  const Track track = Read(kGpx);
  EXPECT_EQ(track.name, "Over the pass");
  EXPECT_EQ(track.heights, TrackHeights::kSea);
  ASSERT_EQ(track.points.size(), 3U);
  EXPECT_NEAR(Degrees(track.points[1].place.latitude_rad), 46.51, 1e-12);
  EXPECT_NEAR(Degrees(track.points[1].place.longitude_rad), 8.01, 1e-12);
  EXPECT_EQ(track.points[0].place.height_m, 2000.5);
  EXPECT_EQ(FormatUtc(*track.points[1].utc, 1), "2026-06-21T04:00:10.5Z");
  EXPECT_EQ(FormatUtc(*track.points[2].utc), "2026-06-21T04:00:20Z");
}

TEST_F(TrackFile, RoutesAndWaypointsServeWhereThereIsNoTrack) {
  const Track route = Read(
      "<gpx><rte><name>R</name><rtept lat='1' lon='2'/><rtept lat='3' lon='4'/></rte>"
      "<rte><rtept lat='5' lon='6'/></rte></gpx>");
  EXPECT_EQ(route.points.size(), 2U) << "the first route";
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
  EXPECT_NEAR(Degrees(track.points[2].place.latitude_rad), 46.7, 1e-12);
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
  EXPECT_NEAR(Degrees(track.points[1].place.longitude_rad), 8.1, 1e-12);
}

TEST_F(TrackFile, FaultsNameTheFileTheLineAndWhatIsWrong) {
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
      {"<gpx>\n<trk>\n</gpx>", 2, "this is no XML (XML_ERROR_MISMATCHED_ELEMENT)"},
      {"<svg/>", 1, "<svg> is neither GPX nor KML"},
      {"\n<gpx/>", 2, "there is no trkpt, rtept or wpt in it"},
      {gpx("<trkpt lon='8'/>"), 3, "<trkpt> has no lat"},
      {gpx("<trkpt lat='north' lon='8'/>"), 3, "lat is \"north\"; it must be a number"},
      {gpx("<trkpt lat='91' lon='8'/>"), 3, "latitude is 91"},
      {gpx("<trkpt lat='nan' lon='8'/>"), 3, "latitude is nan"},
      {gpx("<trkpt lat='1' lon='8'>\n<ele>high</ele></trkpt>"), 4, "ele is \"high\""},
      {gpx("<trkpt lat='1' lon='8'>\n<ele>1e300</ele></trkpt>"), 3, "height is 1e+300"},
      {gpx("<trkpt lat='1' lon='8'>\n\n<time>noon</time></trkpt>"), 5, "noon"},
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

TEST_F(TrackFile, EveryTruncationOfAFileIsRefused) {
  const std::string whole = kGpx;
  for (std::size_t length = 0; length + 3 < whole.size(); length += 7) {
    EXPECT_NE(Fault(whole.substr(0, length)), "no fault") << length;
  }
}

TEST_F(TrackFile, ElementsInsideEachOtherWithoutEndAreRefused) {
  std::string deep = "<gpx>";
  for (int i = 0; i < 10000; ++i) deep += "<a>";
  EXPECT_THAT(Fault(deep), HasSubstr("this is no XML"));
}

}  // namespace
}  // namespace alpenglow
