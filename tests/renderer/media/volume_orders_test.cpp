// SPDX-License-Identifier: MIT
#include "renderer/media/volume_orders.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "renderer/media/media_march.h"
#include "renderer/report/plume.h"
#include "renderer/report/plume_light.h"
#include "tests/fixtures/sanitized.h"

namespace alpenglow::renderer {
namespace {

constexpr double kVolumeCells = tests::ScaledDown(VolumeOrders::kMostCells, 8192.0);

MediumOptics SmokeOptics(double extinction_per_m, double albedo, double g) {
  MediumOptics optics{SpectrumOf<double>(1), SpectrumOf<double>(1), SpectrumOf<double>(1),
                      tests::LobeOf(g)};
  optics.extinction_per_m[0] = extinction_per_m;
  optics.scattering_per_m[0] = albedo * extinction_per_m;
  return optics;
}

/// Returns a homogeneous ellipsoid over the origin, turned by a heading.
LocalVolume SmokeBall(const MediumOptics& optics, const glm::dvec3& size_m,
                      double heading_rad = 0.0) {
  VolumePlacement placement;
  placement.shape = VolumePlacement::Shape::kEllipsoid;
  placement.size_m = size_m;
  placement.across = {std::cos(heading_rad), -std::sin(heading_rad), 0.0};
  placement.ahead = {std::sin(heading_rad), std::cos(heading_rad), 0.0};
  return {placement, std::nullopt, nullptr, optics};
}

/// Light that a body sends to the origin of a ray.
struct BodyLight {
  double radiance, transmittance;
};
/// @param part  of the light, for example VolumeOrders::Scattered::sun.
/// @param more  radiance of the body's own emission, per unit of scaled extinction.
BodyLight LightThrough(const LocalVolume& volume, const VolumeOrders& orders, const CloudRay& ray,
                       const glm::dvec3& to_sun, Spectrum VolumeOrders::Scattered::*part,
                       float more = 0.0F) {
  const LocalMedia media({std::shared_ptr<const LocalMedium>(&volume, [](const LocalMedium*) {})},
                         1);
  const VolumeOrders::Look look = orders.LookAlong(ray.origin, ray.direction);
  const auto source = [&](double, const glm::dvec3& point, std::span<const double> densities,
                          std::span<const double> columns_m) {
    const double to_sun_m = volume.Column(point, to_sun, std::numeric_limits<double>::infinity());
    Spectrum light = orders.At({point, to_sun_m, columns_m[0]}, look).*part;
    light[0] = (light[0] + more) * static_cast<float>(densities[0] * orders.extinction_per_m()[0]);
    return light;
  };
  const std::vector<SpectrumOf<double>> extinction{orders.extinction_per_m()};
  const MarchedLight light =
      MarchMedia(media, ray.origin, ray.direction, 1e5, source, kMarchTolerance, {}, extinction);
  return {static_cast<double>(light.radiance[0]), static_cast<double>(light.transmittance[0])};
}

const glm::dvec3 kSunOverSmoke = glm::normalize(glm::dvec3(0.7, 0.3, 0.6));

/// Returns unit radiance from all directions. @param emits  whether the body glows.
VolumeIllumination InUniformSky(bool emits = false) {
  const auto sky = [](const glm::dvec3&) { return Spectrum(1, 1.0F); };
  return {.to_sun = kSunOverSmoke, .sky = sky, .lamps = nullptr, .emits = emits};
}
const std::array<CloudRay, 3> kRaysThroughSmoke{{{{-500.0, 3.0, 40.0}, {1.0, 0.0, 0.0}},
                                                 {{10.0, -500.0, 60.0}, {0.0, 1.0, 0.0}},
                                                 {{20.0, 12.0, 900.0}, {0.0, 0.0, -1.0}}}};

/// Errors of the whole light of a plume, of all orders and of the first.
/// @param side  of the raster of rays of a view.
/// @param of_first  the least error of the first order alone.
void ExpectPlumeErrors(const PlumeCase& of, int side, double most_rms, double of_first = 0.5) {
  const Plume plume = MakePlume(of);
  const glm::dvec3 to_sun = TowardsAzimuth(20.0, 35.0);
  const auto traced = TracedPlume(plume, to_sun, 104, side);
  const PlumeOrders orders(plume, to_sun, kVolumeCells);
  const PlumeErrors all =
      ErrorsOfPlume(traced, [&](const CloudRay& ray) { return orders.Along(ray); });
  const PlumeErrors single = ErrorsOfPlume(
      traced, [&](const CloudRay& ray) { return FirstOrderOfPlume(plume, to_sun, ray); });
  // The coarse cells of the small case are twice as far from the truth.
  const double more = tests::ScaledDown(1.0, 2.0);
  EXPECT_LT(all.sun.Rms(), more * most_rms) << of.albedo << ", " << of.g;
  EXPECT_LT(all.whole.Rms(), more * most_rms) << of.albedo << ", " << of.g;
  EXPECT_GT(single.sun.Rms(), of_first) << "what the first order alone is wrong by";
}

TEST(VolumeOrders, PlumesOfDepth10HaveTheLightOfTracedPaths) {
  const std::vector<std::pair<double, double>> optics{{0.8, 0.85}, {1.0, 0.85}, {1.0, 0.7}};
  for (std::size_t i = 0; i < tests::ScaledDown(optics.size(), std::size_t{1}); ++i) {
    const auto& [albedo, g] = optics[i];
    ExpectPlumeErrors({10.0, albedo, g, tests::ScaledDown(64, 24)}, tests::ScaledDown(5, 2), 0.06);
  }
}

TEST(VolumeOrders, PlumesOfDepth50HaveTheLightOfTracedPaths) {
  const std::vector<double> albedos{0.8, 1.0};
  for (std::size_t i = 0; i < tests::ScaledDown(albedos.size(), std::size_t{1}); ++i) {
    ExpectPlumeErrors({50.0, albedos[i], 0.85, tests::ScaledDown(64, 24)}, tests::ScaledDown(4, 2),
                      0.09);
  }
}

/// Expects unit light along a ray through a white body in a uniform sky. The residual of the solution is
/// 0.5 % of the light that enters.
void ExpectInvisible(const LocalVolume& body, const VolumeOrders& orders, const CloudRay& ray) {
  const BodyLight light =
      LightThrough(body, orders, ray, kSunOverSmoke, &VolumeOrders::Scattered::sky);
  EXPECT_NEAR(light.radiance + light.transmittance, 1.0, 0.01);
}

TEST(VolumeOrders, WhiteBodiesInUniformLightAreInvisible) {
  for (const double g : {0.0, 0.5, 0.85}) {
    SCOPED_TRACE(g);
    const LocalVolume ball = SmokeBall(SmokeOptics(0.05, 1.0, g), {200.0, 140.0, 100.0}, 0.4);
    const VolumeOrders orders(ball, InUniformSky(), kVolumeCells);
    for (const CloudRay& ray : kRaysThroughSmoke) ExpectInvisible(ball, orders, ray);
  }
}

TEST(VolumeOrders, SmallFlatAndDeepWhiteBodiesAreInvisible) {
  const std::array<glm::dvec3, 3> sizes_m{glm::dvec3(0.01), glm::dvec3(2e5), {400.0, 400.0, 4.0}};
  for (const glm::dvec3& size_m : sizes_m) {
    for (const auto& [depth, g] : {std::pair{1e-6, 0.99}, {100.0, -0.3}, {100.0, 0.85}}) {
      SCOPED_TRACE(testing::Message() << size_m.x << ", " << depth << ", " << g);
      const LocalVolume ball = SmokeBall(SmokeOptics(depth / size_m.z, 1.0, g), size_m);
      const VolumeOrders orders(ball, InUniformSky(), 512.0);
      ExpectInvisible(ball, orders, {{0.0, 0.0, 3.0 * size_m.z}, {0.0, 0.0, -1.0}});
    }
  }
}

TEST(VolumeOrders, BodiesAsHotAsTheirSurroundingsAreInvisible) {
  // Kirchhoff's law: emission is absorption times the radiance of the surroundings.
  MediumOptics optics = SmokeOptics(0.05, 0.7, 0.6);
  optics.emission_per_m[0] = 0.05 * 0.3;
  const LocalVolume ball = SmokeBall(optics, {200.0, 140.0, 100.0});
  const VolumeOrders orders(ball, InUniformSky(true), kVolumeCells);
  const auto own = static_cast<float>(optics.emission_per_m[0] / orders.extinction_per_m()[0]);
  for (const CloudRay& ray : kRaysThroughSmoke) {
    const BodyLight of_sky =
        LightThrough(ball, orders, ray, kSunOverSmoke, &VolumeOrders::Scattered::sky);
    const BodyLight hot =
        LightThrough(ball, orders, ray, kSunOverSmoke, &VolumeOrders::Scattered::own, own);
    EXPECT_NEAR(of_sky.radiance + hot.radiance + hot.transmittance, 1.0, 0.01);
    EXPECT_LT(of_sky.radiance + hot.transmittance, 0.8) << "smoke that does not glow is dark";
  }
}

TEST(VolumeOrders, AFarLampIsASun) {
  const LocalVolume ball = SmokeBall(SmokeOptics(0.05, 0.9, 0.6), glm::dvec3(120.0));
  const auto column = [&](const glm::dvec3& point) {
    return ball.Column(point, kSunOverSmoke, std::numeric_limits<double>::infinity());
  };
  const auto lamp = [&](const glm::dvec3& point, std::size_t, double) {
    return std::vector<LampBeam>{{-kSunOverSmoke, 1.0, column(point), 1e9}};
  };
  const VolumeOrders orders(
      ball,
      {.to_sun = kSunOverSmoke, .has_sun = true, .sky = nullptr, .lamps = lamp, .emits = false},
      kVolumeCells);
  for (const CloudRay& ray : kRaysThroughSmoke) {
    const double sun =
        LightThrough(ball, orders, ray, kSunOverSmoke, &VolumeOrders::Scattered::sun).radiance;
    const double higher =
        LightThrough(ball, orders, ray, kSunOverSmoke, &VolumeOrders::Scattered::own).radiance;
    const glm::dvec3 middle(0.0, 0.0, 60.0);
    EXPECT_GT(higher, 0.1 * sun);
    EXPECT_LT(higher, sun) << "the sun has the first order, too";
    const VolumeOrders::Look look = orders.LookAlong(ray.origin, ray.direction);
    const double first =
        orders.FirstOfLamp(glm::dot(ray.direction, kSunOverSmoke), 0, 2.0 * column(middle)) *
        std::exp(-orders.extinction_per_m()[0] * column(middle));
    const VolumeOrders::Scattered at = orders.At({middle, column(middle), column(middle)}, look);
    EXPECT_NEAR((first + static_cast<double>(at.own[0])) / static_cast<double>(at.sun[0]), 1.0,
                0.02)
        << "samples of the lamp's beam stand for their middles, those of the sun for their parts";
  }
}

TEST(VolumeOrders, ATurnedBodyHasTheSameLight) {
  const double turn = 0.9;
  const auto turned = [&](const glm::dvec3& v) {
    return glm::dvec3(std::cos(turn) * v.x + std::sin(turn) * v.y,
                      -std::sin(turn) * v.x + std::cos(turn) * v.y, v.z);
  };
  const auto light = [&](double heading_rad, const glm::dvec3& to_sun, const CloudRay& ray) {
    const LocalVolume ball =
        SmokeBall(SmokeOptics(0.04, 0.9, 0.7), {160.0, 100.0, 90.0}, heading_rad);
    const VolumeOrders orders(
        ball, {.to_sun = to_sun, .has_sun = true, .sky = nullptr, .lamps = nullptr, .emits = false},
        1000.0);
    return LightThrough(ball, orders, ray, to_sun, &VolumeOrders::Scattered::sun).radiance;
  };
  for (const CloudRay& ray : kRaysThroughSmoke) {
    const CloudRay other{turned(ray.origin), turned(ray.direction)};
    EXPECT_NEAR(light(turn, turned(kSunOverSmoke), other) / light(0.0, kSunOverSmoke, ray), 1.0,
                1e-4)
        << "the solution is in the frame of the body";
  }
}

TEST(VolumeOrders, LobesBackwardsHaveTheLightOfTracedPaths) {
  constexpr double kOfFirst = 0.4;  // most light of such lobes turns back at once
  const std::vector<double> lobes{-0.5, -0.7};
  for (std::size_t i = 0; i < tests::ScaledDown(lobes.size(), std::size_t{1}); ++i) {
    ExpectPlumeErrors({10.0, 1.0, lobes[i], tests::ScaledDown(64, 24)}, tests::ScaledDown(4, 2),
                      0.06, kOfFirst);
  }
}

/// The radiance of a deep white medium that scatters light evenly, for unit irradiance of a beam:
///   mu_0 / (4 pi (mu + mu_0)) H(mu) H(mu_0),   1 / H(mu) = 1/2 integral of m H(m) / (mu + m) dm
/// over m in [0, 1] (Chandrasekhar 1960, Radiative Transfer, section 33).
class DeepWhiteMedium {
 public:
  DeepWhiteMedium() : h_(rule_.node.size(), 1.0) {
    // The mean of two iterates converges; an iterate alone swings.
    for (int i = 0; i < 500; ++i) {
      std::vector<double> next;
      for (std::size_t k = 0; k < h_.size(); ++k) next.push_back(0.5 * (h_[k] + H(rule_.node[k])));
      h_ = std::move(next);
    }
  }
  [[nodiscard]] double Radiance(double mu, double mu_0) const {
    return mu_0 / (4.0 * kPi * (mu + mu_0)) * H(mu) * H(mu_0);
  }

 private:
  [[nodiscard]] double H(double mu) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < h_.size(); ++k)
      sum += 0.5 * rule_.weight[k] * rule_.node[k] * h_[k] / (mu + rule_.node[k]);
    return 1.0 / sum;
  }
  const GaussRule& rule_ = GaussLegendre(32);
  std::vector<double> h_;
};

LocalVolume SmokeBox(const MediumOptics& optics, const glm::dvec3& size_m) {
  VolumePlacement placement;
  placement.size_m = size_m;
  return {placement, std::nullopt, nullptr, optics};
}

VolumeIllumination InTheSun(const glm::dvec3& to_sun) {
  return {.to_sun = to_sun, .has_sun = true, .sky = nullptr, .lamps = nullptr, .emits = false};
}

double SunlitRadiance(const LocalVolume& body, const VolumeOrders& orders, const CloudRay& ray) {
  return LightThrough(body, orders, ray, kSunOverSmoke, &VolumeOrders::Scattered::sun).radiance;
}

TEST(VolumeOrders, FacesOfDeepBodiesHaveTheLightOfDeepMedia) {
  const DeepWhiteMedium medium;
  for (const double extinction_per_m : {5.0, 40.0, 1000.0}) {
    SCOPED_TRACE(extinction_per_m);
    const LocalVolume box = SmokeBox(SmokeOptics(extinction_per_m, 1.0, 0.0), {100.0, 100.0, 60.0});
    const VolumeOrders orders(box, InTheSun(kSunOverSmoke), kVolumeCells);
    const std::array<CloudRay, 3> rays{{{{200.0, 0.0, 30.0}, {-1.0, 0.0, 0.0}},
                                        {{0.0, 200.0, 30.0}, {0.0, -1.0, 0.0}},
                                        {{0.0, 0.0, 200.0}, {0.0, 0.0, -1.0}}}};
    for (const CloudRay& ray : rays) {
      const double truth = medium.Radiance(1.0, -glm::dot(ray.direction, kSunOverSmoke));
      EXPECT_NEAR(SunlitRadiance(box, orders, ray) / truth, 1.0, tests::ScaledDown(0.08, 0.12))
          << "light spreads over some cells, and cells below the surface are as deep as a free "
             "path";
    }
    const CloudRay from_behind{{-200.0, 0.0, 30.0}, {1.0, 0.0, 0.0}};
    EXPECT_LT(SunlitRadiance(box, orders, from_behind), tests::ScaledDown(0.005, 0.01))
        << "nothing comes through";
  }
}

/// Returns a ray towards a ball of radius 1 around the origin with even probability for all of them.
CloudRay RayThroughBall(int number) {
  const double z = 2.0 * Halton(number, 2) - 1.0, azimuth = 2.0 * kPi * Halton(number, 3);
  const glm::dvec3 travel(std::sqrt(1.0 - z * z) * glm::dvec2(std::cos(azimuth), std::sin(azimuth)),
                          z);
  const double radius = std::sqrt(Halton(number, 5)), turn = 2.0 * kPi * Halton(number, 7);
  const glm::dvec3 side = glm::normalize(glm::cross(travel, glm::dvec3(0.6, 0.0, 0.8)));
  const glm::dvec3 other = glm::cross(travel, side);
  return {radius * (std::cos(turn) * side + std::sin(turn) * other) - 2.0 * travel, travel};
}

TEST(VolumeOrders, DeepWhiteBallsSendBackTheLightOfTheSun) {
  constexpr double kRadius_m = 50.0;
  const int rays = tests::ScaledDown(4000, 500);
  for (const double extinction_per_m : {1.0, 40.0, 1000.0}) {
    SCOPED_TRACE(extinction_per_m);
    const LocalVolume ball =
        SmokeBall(SmokeOptics(extinction_per_m, 1.0, 0.5), glm::dvec3(2.0 * kRadius_m));
    const VolumeOrders orders(ball, InTheSun(kSunOverSmoke), kVolumeCells);
    double sum = 0.0;
    for (int i = 1; i <= rays; ++i) {
      const CloudRay unit = RayThroughBall(i);
      sum += SunlitRadiance(
          ball, orders,
          {kRadius_m * unit.origin + glm::dvec3(0.0, 0.0, kRadius_m), unit.direction});
    }
    // Rays of the ball have the etendue 4 pi pi r^2, and the sun enters through pi r^2.
    EXPECT_NEAR(4.0 * kPi * sum / rays, 1.0, tests::ScaledDown(0.06, 0.15));
  }
}

TEST(VolumeOrders, DeepBallsHaveTheSameLightAroundTheSun) {
  const LocalVolume ball = SmokeBall(SmokeOptics(40.0, 1.0, 0.5), glm::dvec3(100.0));
  const VolumeOrders orders(ball, InTheSun(kSunOverSmoke), kVolumeCells);
  const glm::dvec3 side = glm::normalize(glm::cross(kSunOverSmoke, glm::dvec3(0.0, 0.0, 1.0)));
  const glm::dvec3 other = glm::cross(kSunOverSmoke, side);
  for (const double radius_m : {15.0, 30.0, 40.0}) {
    double least = 1e9, most = 0.0;
    for (int i = 0; i < 24; ++i) {
      const double turn = 2.0 * kPi * i / 24;
      const glm::dvec3 off = radius_m * (std::cos(turn) * side + std::sin(turn) * other);
      const double light = SunlitRadiance(
          ball, orders, {glm::dvec3(0.0, 0.0, 50.0) + 200.0 * kSunOverSmoke + off, -kSunOverSmoke});
      least = std::min(least, light);
      most = std::max(most, light);
    }
    EXPECT_LT(most / least, tests::ScaledDown(1.2, 1.4))
        << "cells on the surface; before cells were limited in depth the ratio was 2 and more";
  }
}

TEST(VolumeOrders, PlatesOfAnyDepthAreInvisibleInUniformLight) {
  for (const double depth : {1000.0, 1e5}) {
    const glm::dvec3 size_m(400.0, 400.0, 4.0);
    const LocalVolume box = SmokeBox(SmokeOptics(depth / size_m.z, 1.0, 0.5), size_m);
    const VolumeOrders orders(box, InUniformSky(), kVolumeCells);
    ExpectInvisible(box, orders, {{0.0, 0.0, 12.0}, {0.0, 0.0, -1.0}});
    ExpectInvisible(box, orders, {{30.0, 50.0, 12.0}, glm::normalize(glm::dvec3(0.5, 0.3, -1.0))});
  }
}

TEST(VolumeOrders, EmptyAndBlackBodiesScatterNothing) {
  for (const double extinction_per_m : {0.0, 1e-12, 0.05}) {
    const LocalVolume ball = SmokeBall(SmokeOptics(extinction_per_m, 0.0, 0.5), glm::dvec3(100.0));
    const VolumeOrders orders(ball, InUniformSky(), 1000.0);
    const VolumeOrders::Look look = orders.LookAlong({-500.0, 0.0, 50.0}, {1.0, 0.0, 0.0});
    const VolumeOrders::Scattered light = orders.At({{0.0, 0.0, 50.0}, 50.0, 50.0}, look);
    EXPECT_EQ(light.sky[0], 0.0F);
    EXPECT_EQ(light.sun[0], 0.0F);
  }
}

}  // namespace
}  // namespace alpenglow::renderer
