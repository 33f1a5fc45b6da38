// SPDX-License-Identifier: MIT
// Pieces of bent rays against the ray equation.
#include "renderer/ground/bent_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/judge/ray_equation.h"
#include "atmosphere/ray/bent_view.h"

namespace alpenglow {
namespace {

constexpr double kMinute = kRadiansPerDegree / 60.0;

TEST(BentPath, PiecesEndOnRaysOfTheEquationAtEveryHeight) {
  const Medium medium = MediumPreset("earth");
  const double radius_m = medium.planet_radius_m;
  const judge::RayEquation equation(medium, judge::PeckAndReeder(kHorizonWavelength_nm));
  const BendingAir air = BendingAirOf(medium, kHorizonWavelength_nm);
  for (const double height_m : {2.0, 1000.0, 3000.0, 12e3, 110e3, 400e3}) {
    const double horizon_rad = BentView(medium, height_m).horizon_rad();
    for (const double over_minutes : {0.1, 5.0, 30.0}) {
      const double elevation = horizon_rad + over_minutes * kMinute;
      BentPath path(air, {0.0, 0.0, height_m}, {0.0, std::cos(elevation), std::sin(elevation)},
                    0.5 * kMinute);
      double farthest_off = 0.0;
      int pieces = 0;
      for (; !(path.Rises() && path.HeightHere() > 9e3); ++pieces) {
        const RayPiece piece = path.Next();
        const glm::dvec3 end = piece.begin + piece.length_m * piece.direction;
        const auto truth = equation.Follow(elevation, height_m, path.gone_m()).state;
        const double beside_m = std::hypot(end.y - truth.x, end.z + radius_m - truth.y);
        farthest_off = std::max(farthest_off, beside_m / path.gone_m());
      }
      EXPECT_LT(farthest_off / kMinute, 0.1)
          << "a tenth of an arcminute seen from the eye at " << height_m << " m, " << over_minutes
          << "' over the horizon";
      EXPECT_LT(pieces, 150) << "from space, through all of the air";
    }
  }
}

TEST(BentPath, WithoutAirARayIsStraight) {
  BendingAir air = BendingAirOf(MediumPreset("earth"), kHorizonWavelength_nm);
  air.refractivity = 0.0;
  const glm::dvec3 towards = glm::normalize(glm::dvec3(0.3, 0.9, -0.02));
  BentPath path(air, {0.0, 0.0, 1000.0}, towards, 0.1 * kMinute);
  for (int i = 0; i < 5; ++i) {
    const RayPiece piece = path.Next();
    EXPECT_LT(glm::length(piece.direction - towards), 1e-15);
  }
  EXPECT_LT(glm::length(path.here() - glm::dvec3(0.0, 0.0, 1000.0) - path.gone_m() * towards),
            1e-9 * path.gone_m());
}

}  // namespace
}  // namespace alpenglow
