// SPDX-License-Identifier: MIT
#include "renderer/camera/camera_rays.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

using Kind = PixelFilter::Kind;
constexpr std::array<Kind, 3> kKinds{Kind::kBox, Kind::kGaussian, Kind::kBlackmanHarris};

TEST(PixelFilter, RaysAreDistributedAsTheFilterIs) {
  for (const Kind kind : kKinds) {
    const PixelFilter filter(kind);
    constexpr int kRays = 2000;
    constexpr int kSteps = 20000;
    const double step = 2.0 * filter.radius() / kSteps;
    double below = 0.0;
    int rays = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double x = -filter.radius() + i * step;
      while (rays < kRays && filter.Offset((rays + 0.5) / kRays) < x) ++rays;
      EXPECT_NEAR(below, static_cast<double>(rays) / kRays, 2e-3)
          << NameOf(kind) << " at " << x << ": straight lines between 513 knots, and one ray";
      below += step * filter.Weight(x + 0.5 * step);
    }
    EXPECT_NEAR(below, 1.0, 1e-6) << NameOf(kind);
  }
}

TEST(PixelFilter, IsSymmetricAndPositive) {
  for (const Kind kind : kKinds) {
    const PixelFilter filter(kind);
    EXPECT_EQ(filter.Offset(0.5), 0.0);
    for (const double u : {0.0, 0.125, 0.25, 0.4375}) {
      EXPECT_NEAR(filter.Offset(u), -filter.Offset(1.0 - u), 1e-12) << NameOf(kind);
      EXPECT_LE(std::abs(filter.Offset(u)), filter.radius());
      EXPECT_GE(filter.Weight(filter.Offset(u)), 0.0) << "nothing rings at an edge";
    }
  }
}

TEST(PixelFilter, NamesReadBackAndOthersAreRefused) {
  for (const Kind kind : kKinds) EXPECT_EQ(PixelFilterFromName(NameOf(kind)), kind);
  EXPECT_THROW((void)PixelFilterFromName("gauss"), InputError);
}

/// Transfer of a cosine of a frequency [cycles/pixel].
double Transfer(const PixelFilter& filter, double frequency) {
  constexpr int kSteps = 4000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double x = filter.radius() * ((i + 0.5) / kSteps * 2.0 - 1.0);
    sum += filter.Weight(x) * std::cos(2.0 * kPi * frequency * x);
  }
  return sum * 2.0 * filter.radius() / kSteps;
}

/// Of a zone plate: mean square of what aliases (frequencies from 1/2 to 3/2 cycles a pixel come
/// back as coarser ones), and of what is kept of detail below.
struct ZonePlate {
  double aliased = 0.0, kept = 0.0;
};
ZonePlate OnZonePlate(const PixelFilter& filter) {
  ZonePlate plate;
  constexpr int kSteps = 60;
  for (int i = 0; i < kSteps; ++i) {
    const double low = 0.5 * (i + 0.5) / kSteps;
    plate.kept += std::pow(Transfer(filter, low), 2) / kSteps;
    plate.aliased +=
        0.5 *
        (std::pow(Transfer(filter, 0.5 + low), 2) + std::pow(Transfer(filter, 1.0 + low), 2)) /
        kSteps;
  }
  return plate;
}

/// Width in which an edge rises from a tenth to nine tenths [pixels].
double RiseOfAnEdge(const PixelFilter& filter) { return filter.Offset(0.9) - filter.Offset(0.1); }

TEST(PixelFilter, BlackmanHarrisAliasesAQuarterOfTheBoxAndIsThirtyPerCentSofter) {
  const PixelFilter box(Kind::kBox), filter(Kind::kBlackmanHarris);
  const ZonePlate of_box = OnZonePlate(box), of_filter = OnZonePlate(filter);
  EXPECT_NEAR(of_box.aliased, 0.079, 0.001);
  EXPECT_NEAR(of_filter.aliased, 0.019, 0.001);
  EXPECT_NEAR(of_box.kept, 0.77, 0.01);
  EXPECT_NEAR(of_filter.kept, 0.63, 0.01);
  EXPECT_NEAR(RiseOfAnEdge(box), 0.80, 0.01);
  EXPECT_NEAR(RiseOfAnEdge(filter), 1.08, 0.01);
}

TEST(PixelFilter, GaussianAliasesATenthOfTheBoxAndIsSofterStill) {
  const PixelFilter filter(Kind::kGaussian);
  EXPECT_NEAR(OnZonePlate(filter).aliased, 0.008, 0.001);
  EXPECT_NEAR(OnZonePlate(filter).kept, 0.56, 0.01);
  EXPECT_NEAR(RiseOfAnEdge(filter), 1.25, 0.01);
}

}  // namespace
}  // namespace alpenglow::renderer
