// SPDX-License-Identifier: MIT
// The sun's disk on the graphics card, against sun.h.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/sun.h"
#include "tests/viewer/shaders/gpu_values.h"
#include "tests/viewer/shaders/headless.h"
#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {
namespace {

using SunLight = tests::Headless;

constexpr float kRadius_rad = 0.00465F;

/// (mu_s, cosine of the horizon, radius) of disks that rise through three horizons.
std::vector<tests::Arguments<float>> RisingDisks() {
  std::vector<tests::Arguments<float>> points;
  for (const double horizon_rad : {0.0, -0.025, -0.35}) {
    for (int i = -60; i <= 60; ++i) {
      points.push_back({static_cast<float>(std::sin(horizon_rad + 0.02 * i * double{kRadius_rad})),
                        static_cast<float>(std::sin(horizon_rad)), kRadius_rad});
    }
  }
  return points;
}

std::vector<float> OfDisks(const char* component) {
  const std::vector<ShaderPiece> pieces = WithViewerPieces(
      SharedTexts(), {"viewer/shaders/air.block.glsl", "viewer/shaders/view.block.glsl",
                      "viewer/shaders/air.sun_light.glsl"});
  return tests::EvaluateOnGpu(pieces, std::string("DiskOverHorizon(a[0], a[1], a[2])") + component,
                              RisingDisks());
}

TEST_F(SunLight, OfADiskThatRisesIsThatOfTheRenderer) {
  const std::vector<float> share = OfDisks(".x"), centre = OfDisks(".y");
  const auto points = RisingDisks();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto a = tests::Widen(points[i]);
    const VisibleDisk disk = DiskOverHorizon(a[0], a[1], a[2]);
    EXPECT_NEAR(double{share[i]}, disk.fraction, 1e-5) << "cosines in float place it to 1e-5 radii";
    if (disk.fraction < 1e-5) continue;  // no light comes from there
    EXPECT_NEAR(double{centre[i]}, disk.mu_s_effective, 2e-3 * double{kRadius_rad})
        << "in radii; a sliver's centre is a ratio of what is left of it";
  }
}

TEST_F(SunLight, TheDiskIsDarkenedAtItsLimbAsTheRenderersIs) {
  std::vector<ShaderPiece> pieces = SharedTexts();
  pieces.push_back({"view",
                    "const vec4 sun = vec4(0.6, 0.0, 0.8, 0.00465);\n"
                    "const vec4 wavelengths = vec4(0.68, 0.55, 0.44, 0.35);\n"});
  pieces.push_back(ViewerPiece("viewer/shaders/air.sun_light.glsl"));
  constexpr std::array<double, 4> kWavelengths_nm{680.0, 550.0, 440.0, 350.0};
  std::vector<tests::Arguments<float>> points;
  std::vector<double> radii;
  for (double rho = 0.0; rho < 1.2; rho += 0.05) {
    if (std::abs(rho - 1.0) < 0.02) continue;  // partly covered
    const double angle = rho * double{kRadius_rad};
    const glm::dvec3 direction =
        std::cos(angle) * glm::dvec3(0.6, 0.0, 0.8) + std::sin(angle) * glm::dvec3(-0.8, 0.0, 0.6);
    points.push_back({static_cast<float>(direction.x), static_cast<float>(direction.y),
                      static_cast<float>(direction.z)});
    radii.push_back(rho);
  }
  const double mean = 1.0 / DiskSolidAngle(double{kRadius_rad});
  for (std::size_t band = 0; band < kWavelengths_nm.size(); ++band) {
    const std::vector<float> found = tests::EvaluateOnGpu(
        pieces, fmt::format("SunDiskRadiance(vec3(a[0], a[1], a[2]), 1e-5)[{}]", band), points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double expected =
          radii[i] < 1.0 ? mean * LimbDarkening(radii[i], kWavelengths_nm[band]) : 0.0;
      EXPECT_NEAR(static_cast<double>(found[i]), expected, 2e-3 * mean)
          << "a direction in float lies within 2e-5 radii of its place";
    }
  }
}

TEST_F(SunLight, TheMoonIsThatOfTheRenderer) {
  MoonDisk moon{{0.6, 0.0, 0.8}, {}, 0.0045, 0.05, 0.001};
  moon.to_sun = glm::normalize(glm::dvec3(-0.2, 0.8, 0.1));
  const std::vector<ShaderPiece> pieces = WithViewerPieces(
      SharedTexts(), {"viewer/shaders/air.block.glsl", "viewer/shaders/view.block.glsl",
                      "viewer/shaders/air.sun_light.glsl"});
  std::vector<tests::Arguments<float>> points;
  std::vector<double> expected;
  for (double right = -1.3; right <= 1.3; right += 0.1) {
    for (double up = -1.3; up <= 1.3; up += 0.1) {
      const glm::dvec3 beside = right * glm::dvec3(0.0, 1.0, 0.0) + up * glm::dvec3(-0.8, 0.0, 0.6);
      const glm::dvec3 direction = glm::normalize(moon.to_moon + moon.radius_rad * beside);
      if (std::abs(std::hypot(right, up) - 1.0) < 0.02) continue;  // partly covered
      points.push_back({static_cast<float>(direction.x), static_cast<float>(direction.y),
                        static_cast<float>(direction.z)});
      expected.push_back(MoonRadiance(moon, direction));
    }
  }
  const std::vector<float> found =
      tests::EvaluateOnGpu(pieces, "MoonRadiance(vec3(a[0], a[1], a[2]), 1e-5).x", points,
                           [&](const ShaderProgram& program) {
                             glUniform4f(program.Uniform("moon"), 0.6F, 0.0F, 0.8F, 0.0045F);
                             const glm::vec3 lit(moon.to_sun);
                             glUniform4f(program.Uniform("moon_lit"), lit.x, lit.y, lit.z, 0.05F);
                             glUniform4f(program.Uniform("moon_colour"), 1.0F, 0.0F, 0.0F, 0.0F);
                             glUniform1f(program.Uniform("moon_earthshine"), 0.001F);
                           });
  int seen = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (expected[i] > 0.0) ++seen;
    EXPECT_NEAR(static_cast<double>(found[i]), expected[i], 2e-3 * 0.05)
        << "directions in float place it to 1e-5 radii; near the limb light changes by a tenth in "
           "a thousandth of a radius";
  }
  EXPECT_GT(seen, 100);
}

}  // namespace
}  // namespace alpenglow::viewer
