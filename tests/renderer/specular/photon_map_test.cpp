// SPDX-License-Identifier: MIT
// Light of photon beams and points in fog: the caustic of a sphere relative to quadrature over cones,
// single beams in closed form, and refusals.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "atmosphere/math/constants.h"
#include "renderer/report/sphere_caustic.h"
#include "renderer/specular/beam_map.h"
#include "renderer/specular/photon_beams.h"
#include "renderer/specular/point_map.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/sanitized.h"

namespace alpenglow::renderer {
namespace {

using testing::HasSubstr;

constexpr double kEndless = std::numeric_limits<double>::infinity();

/// One beam along +x, from the origin.
std::vector<PhotonBeam> OneBeam(double length_m, double area_m2 = 2.0) {
  return {{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, length_m, area_m2, 0}};
}

TEST(BeamMap, RefusesRadiiThatAreNotPositive) {
  for (const double radius_m : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THAT(
        tests::FaultOf([&] { return BeamMap(OneBeam(1.0), FogOf({}), radius_m).radius_m(); }),
        HasSubstr("the radius of beams [m] is "));
  }
}

TEST(BeamMap, IsDarkWithoutBeamsOrMedia) {
  const glm::dvec3 eye{0.0, -5.0, 0.0}, ahead{0.0, 1.0, 0.0};
  EXPECT_EQ(BeamMap({}, FogOf({}), 0.1).Radiance(eye, ahead, kEndless)[0], 0.0);
  EXPECT_EQ(BeamMap(OneBeam(1.0), LocalMedia({}, 1), 0.1).Radiance(eye, ahead, kEndless)[0], 0.0);
  EXPECT_EQ(BeamMap(OneBeam(1.0), FogOf({}), 0.1).Radiance(eye, -ahead, kEndless)[0], 0.0);
}

TEST(BeamMap, OneBeamHasTheLightOfAThinCylinder) {
  const ThinFog fog{.extinction_per_m = 0.02, .albedo = 0.8, .g = 0.6};
  const BeamMap map(OneBeam(50.0, 2.0), FogOf(fog), 0.01);
  for (const double angle : {0.4, 1.0, kPi / 2.0, 2.5}) {
    for (const double u : {0.0, 0.005, 0.009}) {
      // The ray passes the axis at (20, 0, u), 7 m from the eye.
      const glm::dvec3 d{std::cos(angle), std::sin(angle), 0.0};
      const double chord = 2.0 * std::sqrt(1e-4 - u * u) / std::sin(angle);
      const double expected =
          2.0 / (kPi * 1e-4) * chord * 0.016 * fog.Phase(-std::cos(angle)) * std::exp(-0.02 * 27.0);
      // Attenuation is that of the middle of the chord.
      EXPECT_NEAR(map.Radiance(glm::dvec3(20.0, 0.0, u) - 7.0 * d, d, kEndless)[0], expected,
                  1e-5 * expected)
          << angle << " " << u;
    }
  }
}

TEST(BeamMap, RaysAlongABeamHaveFiniteLight) {
  const ThinFog fog{.extinction_per_m = 0.1};
  const BeamMap map(OneBeam(30.0, 1.0), FogOf(fog), 0.2);
  // From 10 m behind the end of the beam: the integral of exp(-0.1 (s + 40 - s)) over 30 m.
  const double expected = 30.0 / (kPi * 0.04) * 0.1 / (4.0 * kPi) * std::exp(-4.0);
  for (const double tilt : {0.0, 1e-13, 1e-9}) {
    const glm::dvec3 d = glm::normalize(glm::dvec3(-1.0, tilt, 0.0));
    EXPECT_NEAR(map.Radiance({40.0, 0.0, 0.05}, d, kEndless)[0], expected, 1e-3 * expected);
  }
}

TEST(BeamMap, EndsWithItsBeamsAndWithTheRay) {
  const BeamMap map(OneBeam(10.0), FogOf({}), 0.1);
  const glm::dvec3 d{0.0, 1.0, 0.0};
  EXPECT_GT(map.Radiance({9.99, -5.0, 0.0}, d, kEndless)[0], 0.0);
  EXPECT_EQ(map.Radiance({10.01, -5.0, 0.0}, d, kEndless)[0], 0.0);
  EXPECT_EQ(map.Radiance({-0.01, -5.0, 0.0}, d, kEndless)[0], 0.0);
  EXPECT_EQ(map.Radiance({5.0, -5.0, 0.0}, d, 4.8)[0], 0.0);
  EXPECT_NEAR(map.Radiance({5.0, -5.0, 0.0}, d, 5.0)[0],
              0.5 * map.Radiance({5.0, -5.0, 0.0}, d, kEndless)[0],
              0.01 * map.Radiance({5.0, -5.0, 0.0}, d, kEndless)[0])
      << "the ray ends at the axis";
}

TEST(BeamMap, ColumnsOfExponentialFogAreThoseOfTheMedium) {
  // A beam rises through fog of 20 m scale height, and a ray of sight crosses it.
  const ThinFog fog{.extinction_per_m = 0.03};
  const LocalMedia media = FogOf(fog, 1, 20.0);
  const glm::dvec3 up = glm::normalize(glm::dvec3(1.0, 0.0, 1.0));
  const BeamMap map({{{0.0, 0.0, 0.0}, up, 80.0, 1.0, 0}}, media, 0.05);
  for (const double s : {2.0, 17.0, 60.0}) {
    const glm::dvec3 place = s * up, eye{s * up.x, -30.0, 3.0};
    const glm::dvec3 d = glm::normalize(place - eye);
    const double t = glm::length(place - eye);
    const double depth =
        0.03 * (media.all()[0]->Column({0.0, 0.0, 0.0}, up, s) + media.all()[0]->Column(eye, d, t));
    const double cosine = glm::dot(up, d);
    const double expected = 2.0 / (kPi * 0.05 * std::sqrt(1.0 - cosine * cosine)) * 0.03 *
                            media.all()[0]->DensityAt(place) / (4.0 * kPi) * std::exp(-depth);
    // Columns are linear between knots: 0.8 m apart along the beam, 1/32 of the stretch of the ray.
    EXPECT_NEAR(map.Radiance(eye, d, kEndless)[0], expected, 1e-3 * expected) << s;
  }
}

TEST(BeamMap, LegsBehindAnotherSphereAreAttenuatedAllTheWay) {
  const ThinFog fog{.extinction_per_m = 0.1};
  const std::vector<PhotonBeam> path{{{-8.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 8.0, 1.0, 0},
                                     {{1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 9.0, 1.0, 1}};
  const BeamMap map(path, FogOf(fog), 0.01);
  const double expected =
      2.0 / (kPi * 0.01) * 0.1 / (4.0 * kPi) * std::exp(-0.1 * (8.0 + 3.0 + 2.0));
  EXPECT_NEAR(map.Radiance({4.0, -2.0, 0.0}, {0.0, 1.0, 0.0}, kEndless)[0], expected,
              1e-5 * expected);
}

TEST(BeamMap, BandsHaveTheLightOfTheirOwnMedium) {
  const PhaseFunction phase{.kind = PhaseKind::kHenyeyGreenstein, .g = 0.3};
  const LayerShape shape{0.0, kEndless, 6.36e6, 1e5, -1e3};
  const auto map = [&](const std::vector<double>& extinction, const std::vector<double>& albedo) {
    return BeamMap(
        OneBeam(10.0),
        LocalMedia({std::make_shared<const ExponentialLayer>(
                       shape, OpticsFromLists(extinction, albedo, phase, extinction.size()))},
                   extinction.size()),
        0.1);
  };
  const glm::dvec3 eye{4.0, -6.0, 0.0}, d{0.0, 1.0, 0.0};
  const SpectrumOf<double> both = map({0.02, 0.07}, {1.0, 0.5}).Radiance(eye, d, kEndless);
  EXPECT_NEAR(both[0], map({0.02}, {1.0}).Radiance(eye, d, kEndless)[0], 1e-9 * both[0]);
  EXPECT_NEAR(both[1], map({0.07}, {0.5}).Radiance(eye, d, kEndless)[0], 1e-9 * both[1]);
}

/// Returns the errors of the caustic of a ball by a map. The true picture is the mean of several rays a
/// pixel. Under the sanitizers the picture is small.
template <typename Map>
CausticErrors ErrorsOfCaustic(const Map& map, const ThinFog& fog) {
  const auto view = tests::ScaledDown<CausticView>({}, {.columns = 24, .rows = 12});
  const SphereCaustic cones(1.0, 1.5, 4, tests::ScaledDown(1500, 800), fog);
  const std::vector<double> truth = CausticPicture(
      view, tests::ScaledDown(3, 2),
      [&](const glm::dvec3& d) { return cones.Radiance(view.eye(), d, view.kEnd_m); });
  const std::vector<double> made = CausticPicture(
      view, 1, [&](const glm::dvec3& d) { return map.Radiance(view.eye(), d, view.kEnd_m)[0]; });
  return CausticErrorsOf(made, truth);
}

/// Returns those of 1e5 beams with a radius of half a pixel, and fewer under the sanitizers.
CausticErrors ErrorsOfBeams(const ThinFog& fog) {
  const double half_pixel_m = 0.5 * CausticView::kPixel_m;
  return ErrorsOfCaustic(
      BeamMap(BeamsOfBall(tests::ScaledDown(100000, 4000)), FogOf(fog), half_pixel_m), fog);
}

// A fraction of the beams under the sanitizers has five times the noise.
constexpr double kNoise = tests::ScaledDown(1.0, 6.0);

TEST(BeamMap, ACausticIsThatOfConesOfLight) {
  const CausticErrors errors = ErrorsOfBeams({.extinction_per_m = 0.05, .albedo = 0.9});
  EXPECT_LT(errors.median, 0.02 * kNoise);
  EXPECT_LT(errors.rms, 0.03 * kNoise);
  EXPECT_LT(errors.focus, 0.09 * kNoise);
  EXPECT_LT(std::abs(errors.bias), 0.005 * kNoise);
}

TEST(BeamMap, ACausticInForwardScatteringFogHasMoreNoise) {
  // Much of the light that such fog sends to the eye is that of beams towards the eye: of few grazing
  // photons, which refraction spreads over wide angles.
  const CausticErrors errors = ErrorsOfBeams({.extinction_per_m = 0.05, .g = 0.7});
  EXPECT_LT(errors.median, 0.05 * kNoise);
  EXPECT_LT(errors.rms, 0.09 * kNoise);
  EXPECT_LT(errors.focus, 0.09 * kNoise);
  EXPECT_LT(std::abs(errors.bias), 0.02 * kNoise);
}

TEST(PointMap, HasTheMeanLightOfTheCaustic) {
  // Points have more noise than beams: the mean is compared, and the median with a wide radius. A fifth
  // of the points are in the picture, with a standard error of 1 % of their sum.
  const ThinFog fog{.extinction_per_m = 0.05};
  const CausticErrors errors = ErrorsOfCaustic(
      PointMap(BeamsOfBall(tests::ScaledDown(100000, 10000)), FogOf(fog), 0.1), fog);
  EXPECT_LT(errors.median, tests::ScaledDown(0.06, 0.2));
  EXPECT_LT(std::abs(errors.bias), tests::ScaledDown(0.02, 0.05));
}

TEST(PointMap, RefusesRadiiThatAreNotPositive) {
  EXPECT_THAT(
      tests::FaultOf([&] { return PointMap(OneBeam(1.0), FogOf({}), 0.0).Radiance({}, {}, 0.0); }),
      HasSubstr("the radius of points [m] is 0"));
}

}  // namespace
}  // namespace alpenglow::renderer
