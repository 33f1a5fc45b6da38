// SPDX-License-Identifier: MIT
// Pictures through a polariser.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "atmosphere/math/constants.h"
#include "renderer/illumination/aerial_perspective.h"
#include "renderer/picture/render.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/luminance.h"

namespace alpenglow::renderer {
namespace {

using tests::Luminance;

const UtcInstant kMorning = ParseInstant("2026-06-21T06:00:00Z");

Image Through(Scene scene, std::optional<double> polariser_deg, int width, int height,
              const std::vector<PictureLayer>& layers = {}) {
  if (polariser_deg) scene.camera.polariser_rad = *polariser_deg * kRadiansPerDegree;
  return SceneRenderer(scene).Render(kMorning, {.width = width,
                                                .height = height,
                                                .samples_per_pixel = 1,
                                                .air_nodes = 12,
                                                .layers = layers});
}

TEST(Polariser, HalvesLightThatIsNotPolarisedToTheLastBit) {
  Scene scene = BareScene(300.0, 60.0, 0.0, 90.0);
  scene.medium.polarised = false;
  const Image bare = Through(scene, std::nullopt, 16, 9);
  const Image through = Through(scene, 30.0, 16, 9);
  for (std::size_t i = 0; i < bare.rgb.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(through.rgb[i][c], 0.5F * bare.rgb[i][c]);
  }
}

TEST(Polariser, AirThatIsNotAskedForPolarisationHasNoneAndTheSameLight) {
  const Medium earth = MediumPreset("earth", {450.0, 650.0});
  const SingleScattering<float> air(earth);
  const MultipleScattering multiple_scattering(earth,
                                               {.altitudes = 6, .sun_angles = 8, .degree = 2});
  const AerialPerspective aerial(air, multiple_scattering);
  const ViewRay ray = RayFromAngles(2.0, 60.0, 80.0, 70.0);
  const AirAlongRay without = aerial.Along(ray, AerialPerspective::Nodes{});
  const AirAlongRay with = aerial.Along(ray, AerialPerspective::Nodes{.polarised = true});
  EXPECT_FALSE(without.polarised.has_value());
  EXPECT_EQ(without.inscatter, with.inscatter);
  ASSERT_TRUE(with.polarised.has_value());
  EXPECT_GT(std::hypot(with.polarised->q[0], with.polarised->u[0]), 0.3F * with.inscatter[0]);
}

/// A direction of a panorama that looks north, and the picture's axes there, east, north, up.
struct Seen {
  glm::dvec3 view, up, right;
};

Seen SeenAt(int x, int y, int width, int height) {
  const double azimuth = 2.0 * kPi * ((x + 0.5) / width - 0.5);
  const double elevation = kPi * (0.5 - (y + 0.5) / height);
  const double se = std::sin(elevation), ce = std::cos(elevation);
  const double sa = std::sin(azimuth), ca = std::cos(azimuth);
  return {{ce * sa, ce * ca, se}, {-se * sa, -se * ca, ce}, {ca, -sa, 0.0}};
}

// In all directions, on both sides of the sun.
TEST(Polariser, SkyVibratesAcrossThePlaneOfTheSunAndSeaAsFresnelHasIt) {
  constexpr int kWidth = 24, kHeight = 12;
  Scene scene = BareScene(30.0, 0.0, 0.0, 360.0);
  scene.ground.kind = GroundCover::Kind::kWater;
  const auto through = [&](std::optional<double> angle) {
    return Through(scene, angle, kWidth, kHeight);
  };
  const Image upright = through(0.0), level = through(90.0), right = through(45.0),
              left = through(-45.0);
  const Image bare =
      Through(scene, std::nullopt, kWidth, kHeight,
              {PictureLayer::kStokesQ, PictureLayer::kStokesU, PictureLayer::kPolarisation});
  const auto layer = [&](std::size_t channel, int x, int y) {
    return bare.layers[channel].values[static_cast<std::size_t>(y * kWidth + x)];
  };
  const SunPosition sun = ApparentSunAt(scene.place, kMorning);
  const glm::dvec3 to_sun{std::cos(sun.elevation_rad) * std::sin(sun.azimuth_rad),
                          std::cos(sun.elevation_rad) * std::cos(sun.azimuth_rad),
                          std::sin(sun.elevation_rad)};
  int compared = 0;
  double strongest = 0.0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const double whole = Luminance(bare.at(x, y));
      const double q = Luminance(upright.at(x, y)) - Luminance(level.at(x, y));
      const double u = Luminance(right.at(x, y)) - Luminance(left.at(x, y));
      EXPECT_NEAR(Luminance(upright.at(x, y)) + Luminance(level.at(x, y)), whole, 1e-6 * whole);
      EXPECT_NEAR(Luminance(right.at(x, y)) + Luminance(left.at(x, y)), whole, 1e-6 * whole);
      const double degree = std::hypot(q, u) / whole;
      EXPECT_LT(degree, 1.0);
      EXPECT_NEAR(Luminance({layer(0, x, y), layer(1, x, y), layer(2, x, y)}), q, 1e-5 * whole);
      EXPECT_NEAR(Luminance({layer(3, x, y), layer(4, x, y), layer(5, x, y)}), u, 1e-5 * whole);
      EXPECT_NEAR(static_cast<double>(layer(6, x, y)), degree, 1e-4);
      const Seen seen = SeenAt(x, y, kWidth, kHeight);
      if (seen.view.z < 0.2 || std::abs(glm::dot(seen.view, to_sun)) > 0.5) continue;
      const double angle = static_cast<double>(layer(7, x, y)) * kRadiansPerDegree;
      EXPECT_NEAR(std::remainder(angle - 0.5 * std::atan2(u, q), kPi), 0.0, 1e-3);
      const glm::dvec3 vibrates = std::cos(angle) * seen.up + std::sin(angle) * seen.right;
      EXPECT_LT(std::abs(glm::dot(vibrates, to_sun)), std::sin(5.0 * kRadiansPerDegree))
          << "pixel " << x << ", " << y
          << ": light scattered again turns it by degrees, a wrong sign by tens";
      EXPECT_GT(degree, 0.3);
      strongest = std::max(strongest, degree);
      ++compared;
    }
  }
  EXPECT_GT(compared, 50);
  EXPECT_GT(strongest, 0.6) << "of pixels 15 degrees wide, in air of little haze over a sea";
  EXPECT_LT(strongest, 0.85) << "Coulson (1988): the clearest air of mountains";
}

TEST(Polariser, TakesReflectionsOffTheSeaAtBrewstersAngle) {
  Scene scene = BareScene(5.0, 240.0, -36.7, 4.0);
  scene.ground.kind = GroundCover::Kind::kWater;
  scene.ground.wind_m_per_s = 1.0;
  const auto red = [&](double angle) {  // water itself sends none
    const Image image = Through(scene, angle, 4, 4);
    double sum = 0.0;
    for (const auto& pixel : image.rgb) sum += static_cast<double>(pixel[0]);
    return sum;
  };
  EXPECT_LT(red(0.0), 0.2 * red(90.0)) << "waves tilt the surface by 5 degrees and more";
}

}  // namespace
}  // namespace alpenglow::renderer
