// SPDX-License-Identifier: MIT
#include "renderer/camera/camera_rays.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/math/constants.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

constexpr double kRotation = 0.3;

TEST(Iris, HasTheAreaThatItsEdgeEncloses) {
  for (const int blades : {0, 3, 5, 6, 9}) {
    const Iris iris(blades, kRotation);
    constexpr int kSteps = 3600;
    double area = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      const double angle = 2.0 * kPi * (i + 0.5) / kSteps;
      area += 0.5 * std::pow(iris.EdgeTowards({std::cos(angle), std::sin(angle)}), 2) * 2.0 * kPi /
              kSteps;
    }
    EXPECT_NEAR(area, iris.area(), 1e-5) << blades << " blades, midpoint rule";
  }
}

TEST(Iris, HasCornersOnTheCircleTheFirstWhereItIsTurnedTo) {
  const Iris iris(5, kRotation);
  for (int corner = 0; corner < 5; ++corner) {
    const double angle = kRotation + 2.0 * kPi * corner / 5.0;
    EXPECT_NEAR(iris.EdgeTowards({std::cos(angle), std::sin(angle)}), 1.0, 1e-12);
    const double between = angle + kPi / 5.0;
    EXPECT_NEAR(iris.EdgeTowards({std::cos(between), std::sin(between)}), std::cos(kPi / 5.0),
                1e-12);
  }
}

TEST(Iris, ItsPointsFillItEvenly) {
  for (const int blades : {0, 3, 6}) {
    const Iris iris(blades, kRotation);
    const PixelSamples samples(0, 0, PixelSamples::kMostSamples);
    glm::dvec2 sum(0.0);
    int inner = 0;
    for (int i = 0; i < PixelSamples::kMostSamples; ++i) {
      const glm::dvec2 point = iris.Point(samples.Point(i, SampleOf::kLens));
      const double relative = glm::length(point) / iris.EdgeTowards(point);
      EXPECT_LE(relative, 1.0 + 1e-12) << blades;
      inner += relative < std::sqrt(0.25) ? 1 : 0;
      sum += point;
    }
    EXPECT_NEAR(inner / 1024.0, 0.25, 2.0 / 1024.0) << "area goes with the square of the radius";
    EXPECT_LT(glm::length(sum) / 1024.0, 2e-3) << "no direction is preferred, " << blades;
  }
}

}  // namespace
}  // namespace alpenglow::renderer
