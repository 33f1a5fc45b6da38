// SPDX-License-Identifier: MIT
#include "renderer/clouds/cloud_field.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "renderer/clouds/cloud_cover.h"
#include "renderer/clouds/cloud_line.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/thread_counts.h"

namespace alpenglow::renderer {
namespace {

using testing::HasSubstr;
using tests::FaultOf;

constexpr double kPeriod = 1280.0;

/// A ball that repeats with the field.
class Ball final : public CloudShape {
 public:
  Ball(const glm::dvec3& centre, double radius) : centre_(centre), radius_(radius) {}
  [[nodiscard]] double SignedDepth_m(const glm::dvec3& point) const override {
    glm::dvec3 from = point - centre_;
    from.x -= kPeriod * std::round(from.x / kPeriod);
    from.y -= kPeriod * std::round(from.y / kPeriod);
    return radius_ - glm::length(from);
  }
  [[nodiscard]] bool MayHoldCloud(const glm::dvec3& /*low*/,
                                  const glm::dvec3& /*high*/) const override {
    return true;
  }

 private:
  glm::dvec3 centre_;
  double radius_;
};

CloudLattice Lattice() { return {{64, 64, 40}, glm::dvec3(20.0), {0.0, 0.0, 1000.0}, true}; }

CloudMatter Matter() {
  CloudMatter matter;
  matter.column = DropletColumn({1000.0, 2e-6, 0.7, 200.0, 0.8}, 2000.0);
  return matter;
}

const glm::dvec3 kCentre(1240.0, 630.0, 1390.0);  // the ball crosses the border of the period
constexpr double kRadius = 130.0;

CloudField BallField() { return {Lattice(), Ball(kCentre, kRadius), Matter()}; }

/// Returns points all over some periods, and above and below the field.
std::vector<glm::dvec3> Points(int count) {
  std::vector<glm::dvec3> points;
  for (int i = 0; i < count; ++i) {
    points.push_back({-3000.0 + 6000.0 * std::fmod(0.618034 * i, 1.0),
                      -3000.0 + 6000.0 * std::fmod(0.754878 * i, 1.0),
                      900.0 + 1000.0 * std::fmod(0.56984 * i, 1.0)});
  }
  return points;
}

glm::dvec3 DirectionOf(int i) {
  const double z = 2.0 * std::fmod(0.618034 * i, 1.0) - 1.0;
  return {std::sqrt(1.0 - z * z) * std::cos(2.4 * i), std::sqrt(1.0 - z * z) * std::sin(2.4 * i),
          z};
}

TEST(CloudField, DepthIsThatOfTheShape) {
  const CloudField field = BallField();
  const Ball ball(kCentre, kRadius);
  for (const glm::dvec3& point : Points(20000)) {
    const double depth = ball.SignedDepth_m(point);
    // Bytes round by 0.5 m. The distance from a centre bends by 1 / d between corners: trilinear
    // interpolation errs by 20^2 / 8 * 2 / d in the middle of a voxel.
    if (depth > -kCloudMargin_m && kRadius - depth > 30.0) {
      EXPECT_NEAR(field.SignedDepth_m(point), depth, 0.5 + 100.0 / (kRadius - depth - 20.0));
    }
    if (depth < -kCloudMargin_m - 20.0 * std::sqrt(3.0)) {
      EXPECT_LT(field.SignedDepth_m(point), 0.0);
    }
  }
}

TEST(CloudField, ExtinctionFollowsFromDepthAndAltitude) {
  const CloudField field = BallField();
  const CloudEdge edge;
  for (const glm::dvec3& point : Points(3000)) {
    const double depth = field.SignedDepth_m(point);
    EXPECT_DOUBLE_EQ(field.Extinction_per_m(point),
                     edge.FractionAt(depth) * field.matter().column.Extinction_per_m(point.z));
    EXPECT_EQ(field.DetailedExtinction_per_m(point), field.Extinction_per_m(point))
        << "this field has no detail";
    EXPECT_GT(field.EffectiveRadius_um(point), 0.0);
  }
}

TEST(CloudEdge, FractionGrowsFromZeroToOne) {
  const CloudEdge edge{16.0, 0.6, 120.0};
  EXPECT_EQ(edge.FractionAt(0.0), 0.0);
  EXPECT_EQ(edge.FractionAt(-5.0), 0.0);
  EXPECT_DOUBLE_EQ(edge.FractionAt(120.0), 1.0);
  EXPECT_DOUBLE_EQ(edge.FractionAt(60.0), 0.8) << "a + (1 - a) / 2";
  for (double depth = 0.0; depth < 150.0; depth += 0.5) {
    EXPECT_LE(edge.FractionAt(depth), edge.FractionAt(depth + 0.5));
  }
}

TEST(CloudField, RepeatsAlongEastAndNorth) {
  const CloudField field = BallField();
  EXPECT_EQ(field.period_m(), glm::dvec2(kPeriod));
  for (const glm::dvec3& point : Points(3000)) {
    const glm::dvec3 elsewhere = point + glm::dvec3(-7.0 * kPeriod, 3.0 * kPeriod, 0.0);
    // Rounding of the position changes the depth by less than 1e-9 m, of floats by 1e-5.
    EXPECT_NEAR(field.SignedDepth_m(point), field.SignedDepth_m(elsewhere), 1e-4);
  }
}

TEST(CloudField, OpenFieldIsEmptyOutside) {
  CloudLattice lattice = Lattice();
  lattice.is_periodic = false;
  const CloudField field(lattice, Ball(kCentre, kRadius), Matter());
  EXPECT_FALSE(field.period_m());
  EXPECT_GT(field.Extinction_per_m({1270.0, 630.0, 1390.0}), 0.0);
  EXPECT_EQ(field.Extinction_per_m({1290.0, 630.0, 1390.0}), 0.0);
  EXPECT_EQ(field.Extinction_per_m({1270.0 - kPeriod, 630.0, 1390.0}), 0.0);
}

TEST(CloudField, BoundsAndMajorantsHold) {
  CloudMatter matter = Matter();
  const TilingNoise noise = TilingNoise::Billow(32, {4, 3, 0.55, 3});
  matter.detail = {&noise, 7.0, 160.0};
  const CloudField field(Lattice(), Ball(kCentre, kRadius), matter);
  double most = 0.0;
  for (const glm::dvec3& point : Points(20000)) {
    const double extinction =
        std::max(field.Extinction_per_m(point), field.DetailedExtinction_per_m(point));
    most = std::max(most, extinction);
    EXPECT_LE(extinction, field.BrickMajorant_per_m(point));
    EXPECT_LE(field.BrickMajorant_per_m(point), field.largest_extinction_per_m() * 1.00001);
    if (extinction > 0.0) {
      EXPECT_GE(point.z, field.base_altitude_m());
      EXPECT_LE(point.z, field.top_altitude_m());
    }
  }
  EXPECT_GT(most, 0.3 * field.largest_extinction_per_m()) << "the bound is not far off";
}

TEST(CloudField, NoCloudIsNearerThanTheEmptyDistance) {
  const CloudField field = BallField();
  const Ball ball(kCentre, kRadius);
  bool has_distance = false;
  for (const glm::dvec3& point : Points(5000)) {
    const double empty = field.EmptyDistance_m(point);
    has_distance = has_distance || empty > 100.0;
    // The stored surface is within 2 m of the ball's; see DepthIsThatOfTheShape.
    EXPECT_LE(empty, std::max(0.0, -ball.SignedDepth_m(point)) + 2.0);
  }
  EXPECT_TRUE(has_distance);
}

TEST(CloudField, SpansBoundTheExtinctionAndMakeProgress) {
  const CloudField field = BallField();
  for (int i = 0; i < 400; ++i) {
    const glm::dvec3 origin = Points(400)[static_cast<std::size_t>(i)], direction = DirectionOf(i);
    double at = 0.0;
    int spans = 0;
    while (at < 5000.0) {
      const CloudSpan span = field.SpanAhead(origin + at * direction, direction);
      ASSERT_GT(span.length_m, 0.0);
      ASSERT_LT(++spans, 400) << "more spans than bricks and their borders on the way";
      for (double share : {0.001, 0.2, 0.5, 0.8, 0.999}) {
        const double ahead = at + share * std::min(span.length_m, 5000.0);
        EXPECT_LE(field.Extinction_per_m(origin + ahead * direction), span.majorant_per_m);
      }
      at += span.length_m;
    }
  }
}

TEST(CloudField, VerticalRaysAlongBordersTakeFewSpans) {
  const CloudField field = BallField();
  const CloudLattice& lattice = field.lattice();
  // The cosine of 90 degrees in doubles is not 0.
  const glm::dvec3 direction(-6.1e-17, 3.0e-17, 1.0);
  const glm::dvec3 border = lattice.origin_m + 8.0 * lattice.voxel_m;  // of a brick
  double at = 0.0;
  for (int spans = 0; at < 5000.0; ++spans) {
    ASSERT_LT(spans, 100) << "at " << at << " m";
    at += field.SpanAhead({border.x, border.y, lattice.origin_m.z + at}, direction).length_m;
  }
}

TEST(CloudField, VoxelsNeedNotFillTheLastBrick) {
  // Fields of others have any number of voxels. Spans and distances must hold at the short bricks.
  CloudSamples samples;
  const CloudLattice lattice{{13, 21, 5}, {20.0, 30.0, 40.0}, {-50.0, 10.0, 100.0}, true};
  samples.extinction_per_m.resize(13 * 21 * 6);
  samples.extinction_per_m[(2 * 21 + 20) * 13 + 12] = 0.05F;  // the last corner along x and y
  const CloudField field(lattice, samples);
  const glm::dvec3 corner = lattice.origin_m + lattice.voxel_m * glm::dvec3(12, 20, 2);
  EXPECT_NEAR(field.Extinction_per_m(corner), 0.05, 1e-8) << "floats";
  EXPECT_NEAR(field.Extinction_per_m(corner + glm::dvec3(260.0, -630.0, 0.0)), 0.05, 1e-8);
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec3 point =
        lattice.origin_m + lattice.size_m() * glm::dvec3(std::fmod(0.618034 * i, 1.0),
                                                         std::fmod(0.754878 * i, 1.0),
                                                         std::fmod(0.56984 * i, 1.0));
    const glm::dvec3 direction = DirectionOf(i);
    const CloudSpan span = field.SpanAhead(point, direction);
    for (const double share : {0.1, 0.5, 0.99}) {
      EXPECT_LE(field.Extinction_per_m(point + share * span.length_m * direction),
                span.majorant_per_m);
      EXPECT_EQ(
          field.Extinction_per_m(point + share * field.EmptyDistance_m(point) * direction) > 0.0 &&
              field.EmptyDistance_m(point) > 0.0,
          false);
    }
  }
}

/// Returns a field of others with two clouds, the bricks of which are not full.
CloudField FieldOfOthers(bool is_periodic) {
  CloudSamples samples;
  const CloudLattice lattice{{21, 29, 13}, {20.0, 30.0, 40.0}, {-50.0, 10.0, 100.0}, is_periodic};
  const int beyond = is_periodic ? 0 : 1, nx = 21 + beyond, ny = 29 + beyond;
  samples.extinction_per_m.resize(static_cast<std::size_t>(nx * ny * 14));
  const auto at = [&](int x, int y, int z) -> float& {
    return samples.extinction_per_m[static_cast<std::size_t>((z * ny + y) * nx + x)];
  };
  at(20, 28, 6) = 0.05F;
  for (int x = 4; x < 12; ++x) at(x, 12, 9) = 0.02F;
  return {lattice, samples};
}

/// Calls visit(field, origin, direction) for lines through fields of all kinds.
template <typename Visit>
void EachTestLine(const Visit& visit) {
  for (const CloudField& field : {BallField(), FieldOfOthers(true), FieldOfOthers(false)}) {
    const glm::dvec3 size_m = field.lattice().size_m();
    for (int i = 0; i < 300; ++i) {
      const glm::dvec3 inside(std::fmod(0.618034 * i, 1.0), std::fmod(0.754878 * i, 1.0),
                              std::fmod(0.56984 * i, 1.0));
      const glm::dvec3 direction =
          i % 10 == 0 ? glm::dvec3(i % 20 == 0 ? 1.0 : -1.0, 0.0, 0.0) : DirectionOf(i);
      visit(field, field.lattice().origin_m + size_m * inside - 300.0 * direction, direction);
    }
  }
}

TEST(CloudLine, SamplesAreThoseOfTheField) {
  int with_cloud = 0;
  EachTestLine([&](const CloudField& field, const glm::dvec3& origin, const glm::dvec3& direction) {
    CloudField::Line line(field, origin, direction);
    for (double at_m = 0.0; at_m < 1500.0; at_m += 7.3) {
      const CloudField::Sample expected = field.SampleAt(origin + at_m * direction);
      const CloudField::Sample found = line.At(at_m);
      with_cloud += expected.extinction_per_m > 0.0 ? 1 : 0;
      // Coordinates are rounded differently.
      EXPECT_NEAR(found.depth_m, expected.depth_m, 1e-3);
      EXPECT_NEAR(found.extinction_per_m, expected.extinction_per_m, 1e-6);
    }
  });
  EXPECT_GT(with_cloud, 400);
}

TEST(CloudLine, ClearStretchesHaveNoCloudAndEndAtIt) {
  double clear_m = 0.0, empty_m = 0.0;
  EachTestLine([&](const CloudField& field, const glm::dvec3& origin, const glm::dvec3& direction) {
    CloudField::Line line(field, origin, direction);
    for (double at_m = 0.0; at_m < 1500.0;) {
      const double ahead_m = std::min(line.ClearAhead_m(at_m), 1500.0 - at_m);
      ASSERT_GE(ahead_m, 0.0);
      for (const double share : {0.001, 0.3, 0.7, 0.999}) {
        if (ahead_m == 0.0) continue;
        EXPECT_EQ(field.Extinction_per_m(origin + (at_m + share * ahead_m) * direction), 0.0);
      }
      clear_m += ahead_m;
      const double step_m = ahead_m > 0.0 ? ahead_m : 4.0;
      if (field.Extinction_per_m(origin + (at_m + 0.5 * step_m) * direction) == 0.0) {
        empty_m += step_m;
      }
      at_m += step_m;
    }
  });
  EXPECT_GT(clear_m, 0.9 * empty_m) << "cubes with cloud have the rest of the clear air";
}

TEST(CloudField, MovedFieldIsTheSameElsewhere) {
  CloudMatter matter = Matter();
  const TilingNoise noise = TilingNoise::Billow(32, {4, 3, 0.55, 3});
  matter.detail = {&noise, 7.0, 160.0};
  const CloudField field(Lattice(), Ball(kCentre, kRadius), matter);
  const glm::dvec2 offset(317.0, -4000.0);
  const CloudField moved = field.Moved(offset);
  EXPECT_EQ(moved.hash(), field.hash());
  for (const glm::dvec3& point : Points(2000)) {
    // Rounding of positions, and of shares to floats.
    EXPECT_NEAR(moved.DetailedExtinction_per_m(point + glm::dvec3(offset, 0.0)),
                field.DetailedExtinction_per_m(point), 1e-6);
  }
}

TEST(CloudField, DoesNotDependOnTheNumberOfThreads) {
  static_cast<void>(tests::EqualForAnyNumberOfThreads([] { return BallField().hash(); }));
}

TEST(CloudField, SamplesOfOthersAreKept) {
  const CloudLattice lattice{{8, 8, 8}, glm::dvec3(25.0), {0.0, 0.0, 500.0}, false};
  CloudSamples samples;
  for (int i = 0; i < 9 * 9 * 9; ++i) {
    const bool is_cloud = i % 9 > 2;
    samples.extinction_per_m.push_back(is_cloud ? 0.01F + 0.0001F * static_cast<float>(i) : 0.0F);
    samples.effective_radius_um.push_back(5.0F + 0.01F * static_cast<float>(i));
  }
  samples.single_scattering_albedo = 0.9;
  const CloudField field(lattice, samples);
  EXPECT_EQ(field.single_scattering_albedo(), 0.9);
  for (int i = 0; i < 8 * 8 * 8; ++i) {
    const glm::dvec3 voxel(i % 8, i / 8 % 8, i / 64);
    const glm::dvec3 corner = lattice.origin_m + lattice.voxel_m * voxel;
    const auto sample = static_cast<std::size_t>((i / 64 * 9 + i / 8 % 8) * 9 + i % 8);
    EXPECT_NEAR(field.Extinction_per_m(corner),
                static_cast<double>(samples.extinction_per_m[sample]), 1e-7);
    EXPECT_NEAR(field.EffectiveRadius_um(corner),
                static_cast<double>(samples.effective_radius_um[sample]), 1e-4);
  }
  EXPECT_GT(field.SignedDepth_m({150.0, 90.0, 610.0}), 0.0);
  EXPECT_LT(field.SignedDepth_m({10.0, 90.0, 610.0}), 0.0);
}

TEST(CloudField, RefusesBadLattices) {
  const auto fault = [](const CloudLattice& lattice, const CloudMatter& matter = Matter()) {
    return FaultOf([&] { return CloudField(lattice, Ball(kCentre, kRadius), matter); });
  };
  CloudLattice lattice = Lattice();
  lattice.voxels[1] = 0;
  EXPECT_THAT(fault(lattice), HasSubstr("0 voxels along an axis; it must have 1 to 8192"));
  lattice = Lattice();
  lattice.voxel_m.y = std::nan("");
  EXPECT_THAT(fault(lattice), HasSubstr("the side of a voxel [m]"));
  CloudMatter matter = Matter();
  const TilingNoise noise = TilingNoise::Billow(8, {2, 1, 0.5, 3});
  matter.detail = {&noise, 7.0, 300.0};
  EXPECT_THAT(fault(Lattice(), matter), HasSubstr("repeats after 300 m, which does not divide"));
}

TEST(CloudField, RefusesBadSamples) {
  const CloudLattice lattice{{8, 8, 8}, glm::dvec3(25.0), {0.0, 0.0, 500.0}, false};
  const auto fault = [&](const CloudSamples& samples) {
    return FaultOf([&] { return CloudField(lattice, samples); });
  };
  CloudSamples samples;
  samples.extinction_per_m.assign(9 * 9 * 9 - 1, 0.01F);
  EXPECT_THAT(fault(samples), HasSubstr("728 values of extinction; the lattice has 729 corners"));
  samples.extinction_per_m.push_back(-0.01F);
  EXPECT_THAT(fault(samples), HasSubstr("value 728 of the extinction is -0.01"));
  samples.extinction_per_m.back() = std::nanf("");
  EXPECT_THAT(fault(samples), HasSubstr("value 728 of the extinction is nan"));
  samples.extinction_per_m.back() = 0.02F;
  samples.effective_radius_um.assign(9 * 9 * 9, 0.0F);
  EXPECT_THAT(fault(samples), HasSubstr("value 0 of the effective radius is 0"));
  samples.effective_radius_um.clear();
  samples.single_scattering_albedo = 1.5;
  EXPECT_THAT(fault(samples), HasSubstr("single-scattering albedo"));
}

TEST(CloudCover, OpticalDepthOfABallIsItsChord) {
  CloudMatter matter;
  matter.column = IceColumn(1e-5, 30.0);
  matter.edge = {1e-3, 1.0, 1.0};  // the fraction is 1 at once
  const CloudField field(Lattice(), Ball(kCentre, kRadius), matter);
  const OpticalDepthMap map = VerticalOpticalDepths(field, 64);
  const double core = matter.column.Extinction_per_m(0.0);
  // The middle of the ball, (1240, 630), lies on a border of columns of 20 m; the next middle is
  // (10, 10) m away. Steps of 10 m err by 5 m at each end, and the surface by 1 m.
  const double chord = 2.0 * std::sqrt(kRadius * kRadius - 200.0);
  EXPECT_NEAR(static_cast<double>(map.optical_depth[31 * 64 + 62]) / core, chord, 12.0);
  // The area of the ball over that of the period; its rim has 40 columns of which half may err.
  EXPECT_NEAR(CoverOf(map, 1e-6), std::numbers::pi * kRadius * kRadius / (kPeriod * kPeriod),
              20.0 / (64.0 * 64.0));
}

TEST(CloudCover, ParameterGivesTheCover) {
  const glm::dvec3 centre(640.0, 640.0, 1390.0);
  CloudMatter matter;
  matter.column = IceColumn(1e-4, 30.0);
  matter.edge = {1e-3, 1.0, 1.0};
  const double radius = ParameterForCover(Lattice(), matter,
                                          [&](const glm::dvec3& point, double parameter) {
                                            return parameter - glm::length(point - centre);
                                          },
                                          {0.1, 0.01, 10.0, 600.0});
  // 4096 columns on cells of 20 m: a ring of 14 of them is 0.3 % of the area, or 3.5 m of radius.
  EXPECT_NEAR(radius, std::sqrt(0.1 * kPeriod * kPeriod / std::numbers::pi), 12.0);
}

TEST(CloudField, MostBytesBoundTheMemoryOfAFullField) {
  class Everywhere final : public CloudShape {
   public:
    [[nodiscard]] double SignedDepth_m(const glm::dvec3& /*point*/) const override { return 50.0; }
    [[nodiscard]] bool MayHoldCloud(const glm::dvec3& /*low*/,
                                    const glm::dvec3& /*high*/) const override {
      return true;
    }
  };
  const CloudField full(Lattice(), Everywhere(), Matter());
  // While a field is made its bricks are in memory twice.
  EXPECT_GE(CloudField::MostBytes(Lattice()), static_cast<double>(full.bytes()));
  EXPECT_LE(CloudField::MostBytes(Lattice()), 2.5 * static_cast<double>(full.bytes()));
}

}  // namespace
}  // namespace alpenglow::renderer
