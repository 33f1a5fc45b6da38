// SPDX-License-Identifier: MIT
// Photons that a distant light sends through spheres: power, ends, the image of the sun, and refusals.
#include "renderer/specular/photon_beams.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "atmosphere/math/constants.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/sanitized.h"

namespace alpenglow::renderer {
namespace {

using testing::HasSubstr;

constexpr double kOpen = std::numeric_limits<double>::infinity();

double Nowhere(const glm::dvec3& /*origin*/, const glm::dvec3& /*direction*/) { return kOpen; }

const std::vector<SpecularSphere> kOneBall{{.centre = {0.0, 0.0, 0.0}, .radius_m = 1.0}};

double PowerOfLeg(const std::vector<PhotonBeam>& beams, int leg) {
  double sum = 0.0;
  for (const PhotonBeam& beam : beams)
    if (beam.leg == leg) sum += beam.area_m2;
  return sum;
}

TEST(PhotonBeams, RefuseOptionsOutsideTheirRange) {
  const auto fault = [](const PhotonOptions& options) {
    return tests::FaultOf([&] { return FollowPhotons(kOneBall, {}, options, Nowhere); });
  };
  EXPECT_THAT(fault({.photons = 0}), HasSubstr("the number of photons is 0"));
  EXPECT_THAT(fault({.longest_m = 0.0}), HasSubstr("the longest beam [m] is 0"));
  const std::vector<SpecularSphere> flat{{.radius_m = 0.0}};
  EXPECT_THAT(tests::FaultOf([&] { return FollowPhotons(flat, {}, {}, Nowhere); }),
              HasSubstr("radius_m is 0"));
}

TEST(PhotonBeams, CarryThePowerThatMeetsTheSphere) {
  const std::vector<PhotonBeam> beams = FollowPhotons(kOneBall, {}, {.photons = 20000}, Nowhere);
  // All but the orders that are not sampled, of which 1e-4 of the light is a bound.
  EXPECT_NEAR(PowerOfLeg(beams, 0), kPi, 2e-4 * kPi);
  EXPECT_EQ(PowerOfLeg(beams, 1), 0.0) << "nothing else is there";
}

TEST(PhotonBeams, StartOnTheSphereAndEndAtTheGround) {
  const auto ground = [](const glm::dvec3& origin, const glm::dvec3& direction) {
    return direction.z < 0.0 ? -(origin.z + 5.0) / direction.z : kOpen;
  };
  for (const PhotonBeam& beam :
       FollowPhotons(kOneBall, {}, {.photons = 1000, .longest_m = 30.0}, ground)) {
    EXPECT_NEAR(glm::length(beam.origin), 1.0, 1e-12);
    EXPECT_LE(beam.length_m, 30.0);
    EXPECT_GE(beam.origin.z + beam.length_m * beam.direction.z, -5.0 - 1e-9);
  }
}

TEST(PhotonBeams, OfParallelLightAreEvenOverTheCrossSection) {
  // A mirror sends the light of equal areas into equal solid angles: a sphere scatters evenly.
  const std::vector<SpecularSphere> mirror{{.material = SphereMaterial::kMirror}};
  glm::dvec3 mean(0.0), squares(0.0);
  const std::vector<PhotonBeam> beams = FollowPhotons(mirror, {}, {.photons = 20000}, Nowhere);
  for (const PhotonBeam& beam : beams) {
    mean += beam.direction / static_cast<double>(beams.size());
    squares += beam.direction * beam.direction / static_cast<double>(beams.size());
  }
  // Halton's points are more even than random ones, whose standard errors are 0.004 and 0.002.
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(mean[axis], 0.0, 2e-3);
    EXPECT_NEAR(squares[axis], 1.0 / 3.0, 2e-3);
  }
}

TEST(PhotonBeams, MakeAnImageOfTheSunInTheFocus) {
  // Paraxial light of index 2 - close to it - meets behind the sphere; the image of a disk of angular
  // radius a at the focal length f has the radius f a. Rays near the axis alone are free of aberration.
  const double a = 0.0047;
  const std::vector<SpecularSphere> ball{{.radius_m = 1.0, .index = 1.5}};
  const double f = 1.5;  // n R / (2 (n - 1))
  double squares = 0.0, count = 0.0;
  for (const PhotonBeam& beam :
       FollowPhotons(ball, {{0.0, 0.0, 1.0}, a}, {.photons = 200000}, Nowhere)) {
    if (std::hypot(beam.origin.x, beam.origin.y) > 0.02 || beam.direction.z > -0.9) continue;
    const glm::dvec3 place = beam.origin + (-f - beam.origin.z) / beam.direction.z * beam.direction;
    squares += place.x * place.x + place.y * place.y;
    ++count;
  }
  // Limb darkening (1 - u (1 - mu)) / (1 - u / 3) with u = 0.6 has the mean square radius
  // (1/2 - u (1/2 - 4/15)) / (1 - u/3) = 0.45. Some hundred rays leave 3 %.
  EXPECT_GT(count, 300.0);
  EXPECT_NEAR(squares / count, 0.45 * f * f * a * a, 0.1 * 0.45 * f * f * a * a);
}

TEST(PhotonBeams, OfOneSphereLightTheNext) {
  // The second sphere is in the shadow of the first one: it gets light by way of it alone.
  const std::vector<SpecularSphere> row{{.radius_m = 1.0},
                                        {.centre = {0.0, 0.0, -6.0}, .radius_m = 1.0}};
  const std::vector<PhotonBeam> beams = FollowPhotons(row, {}, {.photons = 20000}, Nowhere);
  EXPECT_NEAR(PowerOfLeg(beams, 0), kPi, 2e-4 * kPi) << "sunlight meets the first sphere";
  EXPECT_GT(PowerOfLeg(beams, 1), 0.1);
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (beams[i].leg == 0) continue;
    ASSERT_GT(i, 0U);
    EXPECT_EQ(beams[i - 1].leg, beams[i].leg - 1);
  }
}

TEST(PhotonBeams, DoNotDependOnThreads) {
  const auto followed = [](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return FollowPhotons(kOneBall, {{0.0, 0.6, 0.8}, 0.0047}, {.photons = 5000}, Nowhere);
  };
  const std::vector<PhotonBeam> one = followed(1), two = followed(2);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].origin, two[i].origin);
    EXPECT_EQ(one[i].direction, two[i].direction);
  }
}

}  // namespace
}  // namespace alpenglow::renderer
