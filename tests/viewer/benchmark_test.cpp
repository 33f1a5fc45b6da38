// SPDX-License-Identifier: MIT
#include "viewer/reports.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <numeric>
#include <sstream>

#include "atmosphere/math/constants.h"
#include "tests/viewer/shaders/headless.h"

namespace alpenglow::viewer {
namespace {

using ::testing::ElementsAre;

TEST(FrameTimes, PercentilesAreTimesThatWereMeasured) {
  std::vector<double> hundred(100);
  std::iota(hundred.begin(), hundred.end(), 1.0);
  std::reverse(hundred.begin(), hundred.end());
  const Percentiles of = PercentilesOf(hundred);
  EXPECT_EQ(of.median, 50.0);
  EXPECT_EQ(of.p95, 95.0);
  EXPECT_EQ(of.p99, 99.0);
  const Percentiles of_one = PercentilesOf({7.0});
  EXPECT_EQ(of_one.median, 7.0);
  EXPECT_EQ(of_one.p99, 7.0);
  EXPECT_EQ(PercentilesOf({1.0, 2.0, 30.0}).p95, 30.0) << "the worst of few";
}

TEST(FrameTimes, TheFlightIsSteadyLevelAndTimeRunsSixtyfold) {
  const CameraPose start{PlaceFromDegrees(46.0, 8.0, 3000.0), 0.7};
  const UtcInstant begin = ParseInstant("2026-06-21T18:00:00Z");
  const auto at = [&](double seconds) { return BenchmarkFlight(start, begin, seconds); };
  EXPECT_NEAR(at(0.0).eye.place.latitude_rad, start.place.latitude_rad, 1e-12);
  for (const double seconds : {0.0, 3.0, 40.0, 600.0}) {
    const ReplayFrame a = at(seconds), b = at(seconds + 0.1);
    const glm::dvec3 step =
        (EcefFromGeodetic(kWgs84, b.eye.place) - EcefFromGeodetic(kWgs84, a.eye.place)).xyz;
    EXPECT_NEAR(glm::length(step), 25.0, 0.1) << "250 m/s";
    EXPECT_EQ(b.eye.place.height_m, 3000.0);
    const Vector<Enu> ahead =
        LocalFrame(kWgs84, a.eye.place).EnuFromEcef(Vector<Ecef>{glm::normalize(step)});
    EXPECT_NEAR(std::remainder(std::atan2(ahead.xyz.x, ahead.xyz.y) - a.eye.heading_rad, 2.0 * kPi),
                0.0, 0.01)
        << "it looks where it flies";
    EXPECT_NEAR(SecondsBetween(*a.now, *b.now), 6.0, 1e-4);
  }
}

class Benchmarks : public tests::Headless {};

TEST_F(Benchmarks, EveryPassHasALineAndTheFrameTheLastOne) {
  for (const PassClock clock : {PassClock::kFinishes, PassClock::kQueries}) {
    Benchmark benchmark(0.1, clock);
    while (benchmark.NextFrame()) {
      benchmark.timer().Begin("sky");
      benchmark.timer().Begin("land");
    }
    std::istringstream text(benchmark.Text());
    std::vector<std::string> names;
    std::string name;
    for (double median = 0.0, p95 = 0.0, p99 = 0.0; text >> name >> median >> p95 >> p99;) {
      names.push_back(name);
      EXPECT_LE(median, p95);
      EXPECT_LE(p95, p99);
    }
    EXPECT_TRUE(text.eof());
    EXPECT_THAT(names, ElementsAre("sky", "sky.cpu", "land", "land.cpu", "frame"));
    EXPECT_GE(benchmark.elapsed_s(), 0.1);
    EXPECT_THAT(benchmark.WorstText(), ::testing::HasSubstr("times the median"));
  }
}

}  // namespace
}  // namespace alpenglow::viewer
