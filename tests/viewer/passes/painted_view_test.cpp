// SPDX-License-Identifier: MIT
// Which rows of a picture can hold the planet, against every ray of it.
#include "viewer/passes/painted_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/math/constants.h"
#include "atmosphere/ray/shell.h"

namespace alpenglow::viewer {
namespace {

constexpr double kRadius_km = 6371.0;

PaintedView ViewFrom(double height_m, double pitch_deg, double roll_deg) {
  CameraPose eye{{0.8, 0.2, height_m},
                 1.0,
                 pitch_deg * kRadiansPerDegree,
                 roll_deg * kRadiansPerDegree,
                 60.0 * kRadiansPerDegree};
  return {eye, {}, 64, 36};
}

/// One over the highest row with a ray under the horizon, by asking 9 places of each pixel.
int RowsByRays(const PaintedView& view) {
  const LandView axes = LandViewOf(view);
  const double horizon = shared::HorizonCosine(1e-3 * view.eye.place.height_m, kRadius_km);
  int rows = 0;
  for (int y = 0; y < 3 * view.height; ++y) {
    for (int x = 0; x < 3 * view.width; ++x) {
      const glm::dvec3 d =
          glm::normalize(axes.forward + ((2.0 * x + 1.0) / (3 * view.width) - 1.0) * axes.right +
                         ((2.0 * y + 1.0) / (3 * view.height) - 1.0) * axes.up);
      if (d.z < horizon) rows = y / 3 + 1;
    }
  }
  return rows;
}

TEST(PaintedView, RowsOfThePlanetHoldAllItsRaysAndLittleElse) {
  for (const double height_m : {2.0, 10e3, 400e3, 36e6}) {
    for (const double pitch_deg : {-90.0, -40.0, -3.0, 0.0, 20.0, 70.0}) {
      for (const double roll_deg : {0.0, 30.0, 90.0, 180.0}) {
        const PaintedView view = ViewFrom(height_m, pitch_deg, roll_deg);
        const int reference = RowsByRays(view), rows = RowsOfPlanet(view, kRadius_km);
        EXPECT_GE(rows, reference) << height_m << " m, " << pitch_deg << ", " << roll_deg;
        // A row to spare, and what places between those asked add.
        EXPECT_LE(rows, reference + 3) << height_m << " m, " << pitch_deg << ", " << roll_deg;
      }
    }
  }
}

}  // namespace
}  // namespace alpenglow::viewer
