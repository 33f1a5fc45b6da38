// SPDX-License-Identifier: MIT
#include "renderer/media/media_march.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <memory>

#include "renderer/media/local_volume.h"
#include "tests/fixtures/noise_grid.h"

namespace alpenglow::renderer {
namespace {

using Shape = VolumePlacement::Shape;

/// Returns a body in one band.
std::shared_ptr<const LocalVolume> Body(Shape shape, const glm::dvec3& bottom,
                                        const glm::dvec3& size, double extinction,
                                        std::optional<double> scale_height = std::nullopt,
                                        std::shared_ptr<const VolumeGrid> grid = nullptr) {
  VolumePlacement placement;
  placement.shape = shape;
  placement.bottom = bottom;
  placement.size_m = size;
  MediumOptics optics{SpectrumOf<double>(1), SpectrumOf<double>(1), SpectrumOf<double>(1),
                      PhaseFunction{}};
  optics.extinction_per_m[0] = extinction;
  return std::make_shared<const LocalVolume>(placement, scale_height, std::move(grid), optics);
}

std::shared_ptr<const ExponentialLayer> Layer(double base, double scale_height, double extinction) {
  MediumOptics optics{SpectrumOf<double>(1), SpectrumOf<double>(1), SpectrumOf<double>(1),
                      PhaseFunction{}};
  optics.extinction_per_m[0] = extinction;
  return std::make_shared<const ExponentialLayer>(
      LayerShape{base, scale_height, 6371e3, 120e3, std::nullopt}, optics);
}

/// Returns the source for which L = B (1 - T): extinction times B.
MediaSource Glowing(const LocalMedia& media, double radiance) {
  return [&media, radiance](double, const glm::dvec3&, std::span<const double> densities,
                            std::span<const double>) {
    Spectrum light(1);
    for (std::size_t m = 0; m < densities.size(); ++m) {
      light[0] += static_cast<float>(densities[m] * radiance *
                                     media.all()[m]->optics().extinction_per_m[0]);
    }
    return light;
  };
}

TEST(MarchMedia, AnIsothermalSlabShinesWithOneMinusTransmittance) {
  for (const double tau : {1e-3, 0.1, 1.0, 5.0, 12.0, 300.0}) {
    const LocalMedia slab({Body(Shape::kBox, {0.0, 50.0, -50.0}, {1e3, 10.0, 1e3}, tau / 10.0)}, 1);
    const MarchedLight light =
        MarchMedia(slab, glm::dvec3(0.0), {0.0, 1.0, 0.0}, 1e4, Glowing(slab, 7.0));
    EXPECT_NEAR(static_cast<double>(light.radiance[0]) / (7.0 * -std::expm1(-tau)), 1.0, 1e-5)
        << tau << ": Kronrod's rule is of degree 10 in panels of optical depth 2 at most";
    EXPECT_NEAR(static_cast<double>(light.transmittance[0]), std::exp(-tau), 2e-6);
  }
}

TEST(MarchMedia, AnExponentialSlabShinesWithOneMinusTransmittance) {
  for (const double k : {0.001, 0.03, 1.0}) {
    const LocalMedia slab({Body(Shape::kBox, {0.0, 0.0, 0.0}, {1e3, 1e3, 400.0}, k, 40.0)}, 1);
    for (const glm::dvec3& way : {glm::dvec3(0.0, 0.0, 1.0), glm::dvec3(0.6, 0.0, 0.8)}) {
      const glm::dvec3 from = -100.0 * way;
      const double tau = k * slab.all()[0]->Column(from, way, 1e5);
      const MarchedLight light = MarchMedia(slab, from, way, 1e5, Glowing(slab, 2.0));
      EXPECT_NEAR(static_cast<double>(light.radiance[0]) / (2.0 * -std::expm1(-tau)), 1.0, 1e-3)
          << k;
    }
  }
}

TEST(MarchMedia, OnlyNarrowSourcesSufferAllExtinction) {
  const LocalMedia slab({Body(Shape::kBox, {0.0, 50.0, -50.0}, {1e3, 10.0, 1e3}, 0.3)}, 1);
  SpectrumOf<double> wide(1);
  wide[0] = 0.1;
  const std::vector<SpectrumOf<double>> extinction{wide};
  const MarchedLight light = MarchMedia(slab, glm::dvec3(0.0), {0.0, 1.0, 0.0}, 1e4,
                                        Glowing(slab, 7.0), kMarchTolerance, {}, extinction);
  EXPECT_NEAR(static_cast<double>(light.narrow_transmittance[0]), std::exp(-3.0), 1e-6);
  EXPECT_NEAR(static_cast<double>(light.transmittance[0]), std::exp(-1.0), 1e-6);
  EXPECT_NEAR(static_cast<double>(light.radiance[0]), 3.0 * 7.0 * -std::expm1(-1.0), 1e-4)
      << "the source is that of an extinction of 0.3, its attenuation that of 0.1";
}

TEST(MarchMedia, ThinBodyShinesAsItsSourceTimesItsLength) {
  const LocalMedia sphere({Body(Shape::kEllipsoid, {0.0, 90.0, -10.0}, glm::dvec3(20.0), 1e-7)}, 1);
  const MarchedLight light = MarchMedia(
      sphere, glm::dvec3(0.0), {0.0, 1.0, 0.0}, INFINITY,
      [](double, const glm::dvec3&, std::span<const double> density, std::span<const double>) {
        Spectrum source(1);
        source[0] = static_cast<float>(3.0 * density[0]);
        return source;
      });
  EXPECT_NEAR(static_cast<double>(light.radiance[0]), 60.0, 1e-4) << "optical depth 2e-6";
}

TEST(MarchMedia, FogToTheHorizonIsOneMinusItsTransmittance) {
  const LocalMedia fog({Layer(0.0, 30.0, 4e-3)}, 1);
  for (const glm::dvec3& from : {glm::dvec3(0.0, 0.0, 2.0), glm::dvec3(0.0, 0.0, 500.0)}) {
    for (const double rise : {-0.01, -0.001, 0.0, 0.002, 0.1, 1.0}) {
      const glm::dvec3 way = glm::normalize(glm::dvec3(1.0, 0.0, rise));
      const double length = rise < 0.0 ? 0.9 * from.z / -rise : 1e9;
      const MarchedLight light = MarchMedia(fog, from, way, length, Glowing(fog, 1.0));
      EXPECT_NEAR(static_cast<double>(light.radiance[0] + light.transmittance[0]), 1.0, 1e-3)
          << from.z << " " << rise;
    }
  }
}

/// Light and transmittance from front to back, in very small steps.
struct SteppedLight {
  double radiance = 0.0, transmittance = 1.0;
};
SteppedLight StepThrough(const LocalMedia& media, const glm::dvec3& from, const glm::dvec3& way,
                         double begin, double end, int steps,
                         const std::function<double(const glm::dvec3&)>& source) {
  SteppedLight truth;
  const double step = (end - begin) / steps;
  for (int i = 0; i < steps; ++i) {
    const glm::dvec3 point = from + (begin + (i + 0.5) * step) * way;
    double per_m = 0.0;
    for (const auto& medium : media.all()) {
      per_m += medium->DensityAt(point) * medium->optics().extinction_per_m[0];
    }
    const double left = std::exp(-per_m * step);
    truth.radiance += truth.transmittance * (1.0 - left) * source(point);
    truth.transmittance *= left;
  }
  return truth;
}

// Returns light with the edge of a shadow, as of bodies and terrain.
double Striped(const glm::dvec3& point) {
  return 1.0 + 0.9 * std::tanh(0.4 * (point.y - 0.3 * point.z - 95.0));
}

TEST(MarchMedia, KeepsItsToleranceAgainstFineSteps) {
  const auto grid = tests::NoiseGrid(48, 10.0, 0.1, 3);
  for (const double extinction : {0.005, 0.05, 0.5}) {
    const LocalMedia media(
        {Body(Shape::kBox, {0.0, 100.0, -30.0}, {60.0, 60.0, 60.0}, extinction, std::nullopt, grid),
         Body(Shape::kEllipsoid, {5.0, 80.0, -20.0}, {50.0, 40.0, 40.0}, 0.3 * extinction),
         Layer(-10.0, 25.0, 0.02 * extinction)},
        1);
    const MediaSource source = [&](double, const glm::dvec3& point, std::span<const double> rho,
                                   std::span<const double>) {
      Spectrum light(1);
      for (std::size_t m = 0; m < rho.size(); ++m) {
        light[0] += static_cast<float>(rho[m] * media.all()[m]->optics().extinction_per_m[0] *
                                       Striped(point));
      }
      return light;
    };
    for (int i = 0; i < 12; ++i) {
      const glm::dvec3 way = glm::normalize(glm::dvec3(0.02 * i - 0.1, 1.0, 0.13 - 0.025 * i));
      const SteppedLight truth =
          StepThrough(media, glm::dvec3(0.0), way, 0.0, 200.0, 80000, Striped);
      const MarchedLight light = MarchMedia(media, glm::dvec3(0.0), way, 200.0, source);
      EXPECT_NEAR(static_cast<double>(light.radiance[0]) / truth.radiance, 1.0, kMarchTolerance);
      EXPECT_NEAR(static_cast<double>(light.transmittance[0]), truth.transmittance,
                  kMarchTolerance);
      EXPECT_LT(light.error, kMarchTolerance) << "its own estimate";
    }
  }
}

TEST(MarchMedia, SmallerToleranceCostsMoreAndErrsLess) {
  const LocalMedia media({Body(Shape::kBox, {0.0, 100.0, -30.0}, {60.0, 60.0, 60.0}, 0.1,
                               std::nullopt, tests::NoiseGrid(32, 10.0, 0.1, 3))},
                         1);
  const MediaSource source = Glowing(media, 1.0);
  const glm::dvec3 way = glm::normalize(glm::dvec3(0.05, 1.0, 0.07));
  const double exact = -std::expm1(-0.1 * media.all()[0]->Column({}, way, 1e3));
  double last_error = 1.0;
  std::size_t last_nodes = 0;
  for (const double tolerance : {1e-1, 1e-3, 1e-5}) {
    const MarchedLight light = MarchMedia(media, glm::dvec3(0.0), way, 1e3, source, tolerance);
    const double error = std::abs(static_cast<double>(light.radiance[0]) / exact - 1.0);
    EXPECT_LT(error, tolerance);
    EXPECT_LE(error, last_error);
    EXPECT_GE(light.nodes, last_nodes);
    last_error = std::max(error, 2e-7);  // single precision
    last_nodes = light.nodes;
  }
}

TEST(MarchMedia, OrderOfOverlappingBodiesDoesNotMatter) {
  const auto a = Body(Shape::kBox, {0.0, 60.0, -20.0}, glm::dvec3(40.0), 0.02);
  const auto b = Body(Shape::kEllipsoid, {0.0, 80.0, -15.0}, glm::dvec3(50.0), 0.04);
  const LocalMedia one({a, b}, 1), other({b, a}, 1);
  const glm::dvec3 way = glm::normalize(glm::dvec3(0.1, 1.0, 0.05));
  const MarchedLight first = MarchMedia(one, {}, way, 500.0, Glowing(one, 1.0));
  const MarchedLight second = MarchMedia(other, {}, way, 500.0, Glowing(other, 1.0));
  EXPECT_NEAR(static_cast<double>(first.radiance[0]), static_cast<double>(second.radiance[0]),
              1e-6);
  EXPECT_NEAR(static_cast<double>(first.transmittance[0]),
              static_cast<double>(second.transmittance[0]), 1e-6);
}

TEST(MarchMedia, AnEmptyGridIsNotSampled) {
  const auto nothing =
      std::make_shared<VolumeGrid>(std::array<int, 3>{16, 16, 16}, std::vector<float>(4096, 0.0F));
  const LocalMedia media(
      {Body(Shape::kBox, {0.0, 60.0, -20.0}, glm::dvec3(40.0), 5.0, std::nullopt, nothing)}, 1);
  const MarchedLight light = MarchMedia(media, {}, {0.0, 1.0, 0.0}, 500.0, Glowing(media, 1.0));
  EXPECT_EQ(light.nodes, 0U);
  EXPECT_TRUE(light.pieces.empty());
  EXPECT_EQ(light.radiance[0], 0.0F);
  EXPECT_EQ(light.transmittance[0], 1.0F);
}

TEST(MarchMedia, FogFarBelowItsBaseTakesFewNodes) {
  // 2026-11-21: the density at the far end, e^15 of that at the base, once set the step of the
  // whole ray.
  const LocalMedia fog({Layer(900.0, 60.0, 0.02)}, 1);
  const glm::dvec3 way = glm::normalize(glm::dvec3(1.0, 0.0, -0.1));
  const MarchedLight light = MarchMedia(fog, {0.0, 0.0, 1900.0}, way, 18500.0, Glowing(fog, 1.0));
  EXPECT_LT(light.nodes, 500U);
  EXPECT_NEAR(static_cast<double>(light.radiance[0]), 1.0, 1e-3);
}

TEST(MarchMedia, PiecesHaveTheTransmittanceInFrontOfThem) {
  const LocalMedia media(
      {Body(Shape::kBox, {0.0, 60.0, -20.0}, glm::dvec3(40.0), 0.05), Layer(0.0, 50.0, 0.002)}, 1);
  const glm::dvec3 from(0.0, 0.0, 5.0), way(0.0, 1.0, 0.0);
  const MarchedLight light = MarchMedia(media, from, way, 300.0, Glowing(media, 1.0));
  ASSERT_FALSE(light.pieces.empty());
  double at = 0.0;
  for (const MarchedPiece& piece : light.pieces) {
    EXPECT_GE(piece.begin_m, at);
    at = piece.end_m;
    const double in_box = std::clamp(at - 40.0, 0.0, 40.0);
    EXPECT_NEAR(static_cast<double>(piece.past_bodies[0]), std::exp(-0.05 * in_box), 1e-5);
    EXPECT_LE(piece.transmittance[0], piece.mean_transmittance[0]);
  }
  EXPECT_EQ(light.pieces.back().transmittance[0], light.transmittance[0]);
}

}  // namespace
}  // namespace alpenglow::renderer
