// SPDX-License-Identifier: MIT
#include "renderer/lit_clouds/shared_cloud_light.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "atmosphere/reference/path_sampling.h"
#include "tests/fixtures/thread_counts.h"

namespace alpenglow::renderer {
namespace {

constexpr int kColumns = 40, kRows = 24;
constexpr double kNoClouds_m = std::numeric_limits<double>::infinity();

/// A picture on a plane: the direction of the point (x, y) is (x, y, 1).
PixelRays FlatPixels() {
  return {kColumns, kRows, glm::dvec3(0.0),
          [](int column, int row) {
            return PixelRays::Ray{{column + 0.5, row + 0.5, 1.0}, kNoClouds_m};
          },
          [](const glm::dvec3& direction) {
            return std::optional(std::array{direction.x, direction.y});
          }};
}

/// Clouds whose light by paths is 1.5 times that of the fast method, with noise.
struct NoisySky {
  double noise = 0.4, slope = 0.01, step = 0.0;  // of light: along x, and at x = 20

  [[nodiscard]] CloudRayPart Clean(const glm::dvec3& direction) const {
    CloudRayPart part{.distance_m = direction.y < 12.0 ? 2000.0 : 5000.0, .transmittance = 0.5};
    const double light = 1.0 + slope * direction.x + (direction.x < 20.0 ? 0.0 : step);
    part.fast = {light, 0.5 * light, 0.0};
    part.light = {1.5 * light, 0.75 * light, 0.25};
    return part;
  }
  [[nodiscard]] std::vector<CloudRayPart> operator()(const PixelRays::Ray& ray,
                                                     bool by_paths) const {
    CloudRayPart part = Clean(ray.direction);
    if (by_paths) {
      const auto pixel =
          static_cast<std::uint64_t>(1e3 * (ray.direction.x + 1e3 * ray.direction.y));
      atmosphere::reference::PathRandom random(7, pixel, 1);
      for (std::size_t i = 0; i < 3; ++i)
        part.light[i] *= 1.0 + noise * (2.0 * random.Next() - 1.0);
    } else {
      part.light = part.fast;
    }
    return {part};
  }
};

std::vector<double> SunOfPixels(const SharedCloudLight& shared, const NoisySky& sky) {
  std::vector<double> sun;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const PixelRays::Ray ray = FlatPixels().ray(column, row);
      sun.push_back(shared.Parts(ray, sky).front().light[0]);
    }
  }
  return sun;
}

// The formula of the header, with a search of the whole picture for the pixels around one.
double SlowSun(const NoisySky& sky, int column, int row) {
  const CloudRayPart own = sky.Clean({column + 0.5, row + 0.5, 1.0});
  double light = 0.0, fast = 0.0;
  for (int y = 0; y < kRows; ++y) {
    for (int x = 0; x < kColumns; ++x) {
      if (std::abs(x - column) > 1 || std::abs(y - row) > 1) continue;
      const CloudRayPart part = sky({{x + 0.5, y + 0.5, 1.0}, kNoClouds_m}, true).front();
      const double dx = x - column, dy = y - row;
      const double brighter = (std::log(part.fast[0]) - std::log(own.fast[0])) / 0.35;
      const double farther = (std::log(part.distance_m) - std::log(own.distance_m)) / 0.02;
      const double weight = std::exp(-(dx * dx + dy * dy) / 1.5) *
                            std::exp(-0.5 * (brighter * brighter + farther * farther));
      light += weight * part.light[0];
      fast += weight * part.fast[0];
    }
  }
  return own.fast[0] * light / fast;
}

TEST(SharedCloudLight, IsTheFilterOfItsFormula) {
  const NoisySky sky{.step = 0.3};
  const std::vector<double> sun = SunOfPixels(SharedCloudLight(FlatPixels()), sky);
  for (const auto& [column, row] : {std::pair{0, 0}, {5, 5}, {19, 11}, {20, 12}, {39, 23}}) {
    EXPECT_NEAR(sun[static_cast<std::size_t>(row * kColumns + column)], SlowSun(sky, column, row),
                1e-9);
  }
}

TEST(SharedCloudLight, KeepsTheMean) {
  const NoisySky sky;
  double mean = 0.0, clean = 0.0;
  const std::vector<double> sun = SunOfPixels(SharedCloudLight(FlatPixels()), sky);
  for (std::size_t pixel = 0; pixel < sun.size(); ++pixel) {
    mean += sun[pixel];
    clean += sky.Clean({static_cast<double>(pixel % kColumns) + 0.5, 0.5, 1.0}).light[0];
  }
  // 960 pixels with a relative noise of 0.23 have a mean within 0.8 % (standard error).
  EXPECT_NEAR(mean, clean, 0.025 * clean);
}

TEST(SharedCloudLight, ReducesNoiseWhereRaysAreAlike) {
  const NoisySky sky{.slope = 0.0};
  const std::vector<double> sun = SunOfPixels(SharedCloudLight(FlatPixels()), sky);
  double before = 0.0, after = 0.0;
  for (int row = 1; row < kRows - 1; ++row) {
    if (row == 11 || row == 12) continue;  // between the two distances
    for (int column = 1; column < kColumns - 1; ++column) {
      const double filtered = sun[static_cast<std::size_t>(row * kColumns + column)];
      before += std::pow(sky(FlatPixels().ray(column, row), true).front().light[0] - 1.5, 2);
      after += std::pow(filtered - 1.5, 2);
    }
  }
  // Filtered values have about 200 independent ones among them: 5 % (standard error).
  EXPECT_NEAR(std::sqrt(after / before), 0.37, 0.04);
}

TEST(SharedCloudLight, WithoutNoiseChangesNothing) {
  const NoisySky sky{.noise = 0.0, .step = 1.0};
  const SharedCloudLight shared(FlatPixels());
  for (int column = 0; column < kColumns; ++column) {
    const PixelRays::Ray ray = FlatPixels().ray(column, 11);
    const CloudRayPart part = shared.Parts(ray, sky).front(), exact = sky.Clean(ray.direction);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(part.light[i], exact.light[i], 1e-12);
    EXPECT_EQ(part.distance_m, exact.distance_m);
  }
}

TEST(SharedCloudLight, RaysBetweenPixelsHaveTheirOwnFastLight) {
  const NoisySky sky{.noise = 0.0};
  const SharedCloudLight shared(FlatPixels());
  for (const glm::dvec3& direction : {glm::dvec3(7.1, 3.2, 1.0), glm::dvec3(20.0, 12.0, 1.0)}) {
    const CloudRayPart part = shared.Parts({direction, kNoClouds_m}, sky).front();
    EXPECT_NEAR(part.light[0], sky.Clean(direction).light[0], 1e-12);
  }
}

// Clouds of other distances, layers and rays beside the picture have nothing in common with a ray.
TEST(SharedCloudLight, RaysUnlikeTheirNeighboursHaveOwnPaths) {
  const NoisySky sky;
  const SharedCloudLight shared(FlatPixels());
  const auto far_between = [&](const PixelRays::Ray& ray, bool by_paths) {
    std::vector<CloudRayPart> parts = sky(ray, by_paths);
    if (ray.direction.x == 7.25) parts.front().distance_m = 9000.0;
    return parts;
  };
  const PixelRays::Ray between{{7.25, 3.5, 1.0}, kNoClouds_m}, beside{{-2.0, 3.5, 1.0}, 1.0};
  EXPECT_EQ(shared.Parts(between, far_between).front().light, sky(between, true).front().light);
  EXPECT_EQ(shared.Parts(beside, sky).front().light, sky(beside, true).front().light);
}

TEST(SharedCloudLight, DoesNotDependOnThreadsOrOrder) {
  const NoisySky sky;
  const std::vector<double> in_order = SunOfPixels(SharedCloudLight(FlatPixels()), sky);
  tests::EqualForAnyNumberOfThreads([&] {
    const SharedCloudLight shared(FlatPixels());
    std::vector<double> sun(in_order.size());
    tbb::parallel_for(std::size_t{0}, sun.size(), [&](std::size_t i) {
      const std::size_t pixel = sun.size() - 1 - i;
      const PixelRays::Ray ray =
          FlatPixels().ray(static_cast<int>(pixel) % kColumns, static_cast<int>(pixel) / kColumns);
      sun[pixel] = shared.Parts(ray, sky).front().light[0];
    });
    EXPECT_EQ(sun, in_order);
    return sun;
  });
}

TEST(SharedCloudLight, TracesEachPixelOnceWhileItsBlockIsKept) {
  int traced = 0;
  const NoisySky sky;
  const auto counted = [&](const PixelRays::Ray& ray, bool by_paths) {
    ++traced;
    return sky(ray, by_paths);
  };
  const SharedCloudLight shared(FlatPixels());
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      EXPECT_EQ(shared.Parts(FlatPixels().ray(column, row), counted).size(), 1U);
    }
  }
  EXPECT_EQ(traced, kColumns * kRows);
}

TEST(SharedCloudLight, MemoryOfLargePicturesIsBounded) {
  PixelRays pixels = FlatPixels();
  pixels.columns = pixels.rows = 16384;
  const SharedCloudLight large(pixels);
  EXPECT_LT(large.MostBlocks(), std::size_t{2048} * 2048) << "blocks of the whole picture";
  const NoisySky sky;
  // Blocks of the same slot take turns.
  const auto row_of = static_cast<double>(large.MostBlocks() / 2048 * 8);
  const PixelRays::Ray first{{4.5, 4.5, 1.0}, kNoClouds_m};
  const PixelRays::Ray second{{4.5, 4.5 + row_of, 1.0}, kNoClouds_m};
  const double before = large.Parts(first, sky).front().light[0];
  EXPECT_NE(large.Parts(second, sky).front().light[0], before);
  EXPECT_EQ(large.Parts(first, sky).front().light[0], before);
}

}  // namespace
}  // namespace alpenglow::renderer
