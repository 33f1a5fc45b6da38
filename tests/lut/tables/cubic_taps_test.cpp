// SPDX-License-Identifier: MIT
#include "lut/tables/cubic_taps.h"

#include <gtest/gtest.h>

namespace alpenglow::lut {
namespace {

template <typename Function>
double Interpolated(double at, int nodes, const Function& function) {
  const CubicTaps taps = TapsAt(at, nodes);
  double sum = 0.0;
  for (std::size_t tap = 0; tap < 4; ++tap) {
    sum += static_cast<double>(taps.weight[tap]) *
           function(static_cast<double>(taps.node[tap]) / (nodes - 1));
  }
  return sum;
}

TEST(CubicTaps, ReproduceAParabolaUpToBothEnds) {
  const auto parabola = [](double x) { return 1.0 - 3.0 * x + 5.0 * x * x; };
  for (const int nodes : {3, 4, 9}) {
    for (const double at : {0.0, 0.03, 0.2, 0.5, 0.81, 0.97, 1.0})
      EXPECT_NEAR(Interpolated(at, nodes, parabola), parabola(at), 2e-6) << nodes << " " << at;
  }
}

TEST(CubicTaps, BetweenTwoNodesAreALine) {
  const auto square = [](double x) { return x * x; };
  for (const double at : {0.0, 0.3, 1.0}) EXPECT_NEAR(Interpolated(at, 2, square), at, 1e-6);
}

}  // namespace
}  // namespace alpenglow::lut
