// SPDX-License-Identifier: MIT
#include "lut/report/svg_plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <regex>

#include "tests/fixtures/report_files.h"

namespace alpenglow::lut {
namespace {

using testing::HasSubstr;

Plot PlotOf(std::vector<PlotPoint> points) {
  return {"title",
          "subtitle",
          {"x", PlotUnit::kSeconds},
          {"y", PlotUnit::kShare},
          {{"panel", {{"series <1>", false, std::move(points)}}, {}}}};
}

TEST(QuantityText, IsShortAndHasAUnit) {
  EXPECT_EQ(QuantityText(1.5e-6, PlotUnit::kSeconds), "1.5 µs");
  EXPECT_EQ(QuantityText(1e-9, PlotUnit::kSeconds), "1 ns");
  EXPECT_EQ(QuantityText(0.25, PlotUnit::kSeconds), "250 ms");
  EXPECT_EQ(QuantityText(0.0012, PlotUnit::kShare), "0.12 %");
  EXPECT_EQ(QuantityText(1e-7, PlotUnit::kShare), "1e-5 %");
  EXPECT_EQ(QuantityText(16.0, PlotUnit::kShare), "1600 %");
  EXPECT_EQ(QuantityText(65536.0, PlotUnit::kBytes), "66 kB");
  EXPECT_EQ(QuantityText(512.0, PlotUnit::kCount), "512");
}

TEST(SvgPlot, HasMarkerAndNameOfEverySeries) {
  const std::string svg = SvgOfPlot(PlotOf({{1e-6, 0.1, {}, "8"}, {1e-5, 0.01, 0.02, "16"}}));
  EXPECT_EQ(CountOf(svg, "class=\"mark\""), 3U) << "two points, and one in the legend";
  EXPECT_EQ(CountOf(svg, "class=\"tail\""), 1U);
  EXPECT_EQ(CountOf(svg, "series &lt;1&gt;"), 1U);
  EXPECT_THAT(svg, HasSubstr("prefers-color-scheme: dark"));
}

TEST(SvgPlot, OmitsValuesWithoutALogarithm) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::string svg =
      SvgOfPlot(PlotOf({{1e-6, 0.1, {}, ""}, {0.0, 0.1, {}, ""}, {1e-6, nan, {}, ""}}));
  EXPECT_EQ(CountOf(svg, "class=\"mark\""), 2U) << "one point, and one in the legend";
  EXPECT_EQ(CountOf(svg, "nan") + CountOf(svg, "inf"), 0U);
}

TEST(SvgPlot, WithoutPointsIsAnEmptyFrame) {
  const std::string svg = SvgOfPlot(PlotOf({}));
  EXPECT_EQ(CountOf(svg, "nan") + CountOf(svg, "inf"), 0U);
}

TEST(SvgPlot, MarkersLieInsideTheSheet) {
  const std::string svg = SvgOfPlot(PlotOf({{1e-9, 1e-9, {}, ""}, {10.0, 10.0, {}, ""}}));
  const std::regex centre("class=\"mark\" d=\"M([0-9.]+) ([0-9.]+)m");
  std::sregex_iterator at(svg.begin(), svg.end(), centre);
  ASSERT_NE(at, std::sregex_iterator());
  for (std::sregex_iterator end; at != end; ++at) {
    EXPECT_GT(std::stod((*at)[1]), 60.0);
    EXPECT_LT(std::stod((*at)[1]), 1080.0);
    EXPECT_GT(std::stod((*at)[2]), 70.0);
    EXPECT_LT(std::stod((*at)[2]), 480.0) << "the legend is below the panels";
  }
}

}  // namespace
}  // namespace alpenglow::lut
