// SPDX-License-Identifier: MIT
#include "atmosphere/lamp/airlight.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/reference/airlight_reference.h"
#include "tests/fixtures/airlight_on_surface.h"
#include "tests/fixtures/fog_under_clear_air.h"
#include "tests/fixtures/lamp_cases.h"
#include "tests/fixtures/media.h"

namespace alpenglow::atmosphere {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

Lamp LampAt(const glm::dvec3& position) {
  Lamp lamp;
  lamp.position_m = position;
  return lamp;
}

LampSegment Along(const glm::dvec3& direction, double length_m) {
  LampSegment segment;
  segment.direction = glm::normalize(direction);
  segment.end_m = length_m;
  return segment;
}

void ExpectNearTheReference(const LampAir& air, const Lamp& lamp, const LampSegment& segment,
                            double tolerance, const std::string& what) {
  const reference::LampLight truth = reference::AirlightAlong(air, lamp, segment);
  EXPECT_TRUE(truth.converged) << what;
  EXPECT_NEAR(Airlight(air, lamp, segment)[0] / truth.radiance[0], 1.0, tolerance) << what;
}

double Logarithmic(double low, double high, double u) { return low * std::pow(high / low, u); }

struct ErrorsOfSixteen {
  double rms, most;
};

// Lamps 0.1 to 100 m beside segments of 10 to 1000 m, extinction 1e-4 to 0.1 per metre at the
// lowest point: the distribution of renderer/report/reference_methods.h.
ErrorsOfSixteen Measure(double g, double scale_height_m, int cases) {
  double squares = 0.0, most = 0.0;
  for (int i = 1; i <= cases; ++i) {
    const double sigma = Logarithmic(1e-4, 0.1, Halton(i, 2));
    const double length = Logarithmic(10.0, 1000.0, Halton(i, 3));
    const double pitch = std::asin(2.0 * Halton(i, 11) - 1.0);
    const double turn = 2.0 * kPi * Halton(i, 13);
    LampAir air = HomogeneousAir(0.9 * sigma, sigma, tests::LobeOf(g));
    air.layers[0].scale_height_m = scale_height_m;
    const glm::dvec3 forward(std::cos(pitch), 0.0, std::sin(pitch));
    const glm::dvec3 off = std::cos(turn) * glm::dvec3(-std::sin(pitch), 0.0, std::cos(pitch)) +
                           std::sin(turn) * glm::dvec3(0.0, 1.0, 0.0);
    const Lamp lamp = LampAt(length * (1.4 * Halton(i, 7) - 0.2) * forward +
                             Logarithmic(0.1, 100.0, Halton(i, 5)) * off);
    air.altitude_at_origin_m = -std::min({0.0, length * forward.z, lamp.position_m.z});
    const LampSegment segment = Along(forward, length);
    const double truth = reference::AirlightAlong(air, lamp, segment).radiance[0];
    const double error = std::abs(Airlight(air, lamp, segment)[0] / truth - 1.0);
    squares += error * error;
    most = std::max(most, error);
  }
  return {std::sqrt(squares / cases), most};
}

TEST(Airlight, SixteenSamplesAreAccurateToAThousandth) {
  for (const double g : {0.0, 0.8, 0.95}) {
    const ErrorsOfSixteen errors = Measure(g, kInfinite, 400);
    EXPECT_LT(errors.rms, 2e-4) << "g " << g;
    EXPECT_LT(errors.most, 1e-3) << "g " << g;
  }
  for (const double height : {5.0, 30.0}) {
    const ErrorsOfSixteen errors = Measure(0.8, height, 200);
    EXPECT_LT(errors.rms, 1e-3) << "rms, H " << height;
    EXPECT_LT(errors.most, 1e-2) << "three separate layers of light on one ray, H " << height;
  }
}

TEST(Airlight, SamplesAndReferenceAgreeWithStoredCases) {
  const auto cases = stored::LampCases();
  EXPECT_EQ(cases.size(), 50U);
  for (const auto& [id, air, lamp, segment, radiance] : cases) {
    EXPECT_NEAR(Airlight(air, lamp, segment)[0], radiance, 1e-3 * radiance) << id << ", 16 samples";
    EXPECT_NEAR(Airlight(air, lamp, segment, 64)[0], radiance, 2e-5 * radiance)
        << id << ", 64 samples";
    EXPECT_NEAR(reference::AirlightAlong(air, lamp, segment).radiance[0], radiance, 1e-9 * radiance)
        << id;
  }
}

TEST(AirlightReference, InThinAirIsTheAngleOfTheSegment) {
  // Without extinction and for isotropic scattering the integral is sigma / (4 pi D) times the
  // angle under which the lamp sees the segment.
  const LampAir air = HomogeneousAir(1e-12, 1e-12, tests::LobeOf(0.0));
  const reference::LampLight found =
      reference::AirlightAlong(air, LampAt({5.0, 2.0, 0.0}), Along({1.0, 0.0, 0.0}, 12.0));
  const double angle = std::atan2(5.0, 2.0) + std::atan2(7.0, 2.0);
  EXPECT_NEAR(found.radiance[0] / (1e-12 / (4.0 * kPi * 2.0) * angle), 1.0, 1e-9);
}

// Hard case 42.
TEST(Airlight, OfARayThroughTheLampIsFiniteAndRight) {
  const LampAir air = HomogeneousAir(0.02, 0.02, tests::LobeOf(0.8));
  Lamp lamp = LampAt({40.0, 0.0, 0.0});
  lamp.radius_m = 0.1;
  const LampSegment through = Along({1.0, 0.0, 0.0}, 100.0);
  ExpectNearTheReference(air, lamp, through, 1e-3, "through the centre of the lamp");
  const double centre = Airlight(air, lamp, through)[0];
  lamp.position_m.y = 0.05;
  EXPECT_NEAR(Airlight(air, lamp, through)[0], centre, 1e-3 * centre) << "inside of the lamp";
  lamp.position_m.y = 1e-3;
  lamp.radius_m = 0.0;
  ExpectNearTheReference(air, lamp, through, 1e-3, "a point of light 1 mm from the ray");
}

// Hard case 42.
TEST(Airlight, OfLampsAtAndBehindTheEyeIsFiniteAndRight) {
  const LampAir air = HomogeneousAir(0.01, 0.012, tests::LobeOf(0.7));
  const LampSegment ahead = Along({1.0, 0.0, 0.0}, 50.0);
  Lamp lamp = LampAt({0.0, 0.0, 0.0});
  lamp.radius_m = 0.05;
  ExpectNearTheReference(air, lamp, ahead, 1e-3, "at the eye");
  lamp.position_m = {-5.0, 0.0, 0.0};
  ExpectNearTheReference(air, lamp, ahead, 1e-3, "behind");
  lamp.position_m = {80.0, 0.0, 0.0};
  ExpectNearTheReference(air, lamp, ahead, 1e-3, "beyond the end");
}

// Hard case 14.
TEST(Airlight, IsProportionalToTheLengthOfShortSegments) {
  const LampAir air = HomogeneousAir(0.01, 0.01, tests::LobeOf(0.5));
  const Lamp lamp = LampAt({3.0, 1.0, 0.0});
  EXPECT_EQ(Airlight(air, lamp, Along({1.0, 0.0, 0.0}, 0.0))[0], 0.0);
  const double metre = Airlight(air, lamp, Along({1.0, 0.0, 0.0}, 1e-3))[0];
  const double half = Airlight(air, lamp, Along({1.0, 0.0, 0.0}, 5e-4))[0];
  EXPECT_NEAR(metre / half, 2.0, 1e-3) << "the source changes by 1e-3 over a millimetre";
}

TEST(Airlight, OfPiecesSumsToThatOfTheRay) {
  const LampAir air = HomogeneousAir(0.01, 0.01, tests::LobeOf(0.8));
  const Lamp lamp = LampAt({30.0, 2.0, 1.0});
  LampSegment piece = Along({1.0, 0.0, 0.0}, 100.0);
  const double whole = Airlight(air, lamp, piece, 32)[0];
  double sum = 0.0;
  for (const double end : {20.0, 31.0, 33.0, 100.0}) {
    piece.end_m = end;
    sum += Airlight(air, lamp, piece, 32)[0];
    piece.begin_m = end;
  }
  EXPECT_NEAR(sum / whole, 1.0, 1e-4);
}

TEST(Airlight, OutsideTheBeamIsZero) {
  const LampAir air = HomogeneousAir(0.02, 0.02, tests::LobeOf(0.6));
  Lamp lamp = LampAt({40.0, 5.0, 0.0});
  lamp.axis = {0.0, 1.0, 0.0};
  lamp.profile.kind = LampProfile::Kind::kCone;
  lamp.profile.inner_rad = 0.1;
  lamp.profile.outer_rad = 0.2;
  EXPECT_EQ(Airlight(air, lamp, Along({1.0, 0.0, 0.0}, 100.0))[0], 0.0);
  lamp.axis = {0.0, -1.0, 0.0};
  ExpectNearTheReference(air, lamp, Along({1.0, 0.0, 0.0}, 100.0), 1e-3, "across the beam");
}

TEST(Airlight, OfATableEqualsThatOfItsCone) {
  const LampAir air = HomogeneousAir(0.01, 0.01, tests::LobeOf(0.6));
  Lamp cone = LampAt({40.0, 10.0, 0.0});
  cone.axis = glm::normalize(glm::dvec3(-0.6, -1.0, 0.2));
  cone.side = glm::normalize(glm::cross(cone.axis, glm::dvec3(0.0, 0.0, 1.0)));
  cone.profile.kind = LampProfile::Kind::kCone;
  cone.profile.inner_rad = 0.2;
  cone.profile.outer_rad = 0.6;
  Lamp table = cone;
  table.profile.kind = LampProfile::Kind::kTable;
  table.profile.table.c_rad = {0.0};
  for (int i = 0; i <= 120; ++i) {
    const double gamma = 0.6 * i / 120.0;
    table.profile.table.gamma_rad.push_back(gamma);
    table.profile.table.intensity.push_back(
        RelativeIntensity(cone.profile, {std::cos(gamma), std::sin(gamma), 0.0}));
  }
  const LampSegment segment = Along({1.0, 0.0, 0.0}, 100.0);
  EXPECT_NEAR(Airlight(air, table, segment)[0] / Airlight(air, cone, segment)[0], 1.0, 2e-3)
      << "linear between angles 0.3 degrees apart";
  ExpectNearTheReference(air, table, segment, 1e-3, "table");
}

TEST(Airlight, EveryBandHasItsOwnExtinction) {
  LampAir air;
  LampLayer fog;
  fog.scattering_per_m = SpectrumOf<double>(3);
  fog.extinction_per_m = SpectrumOf<double>(3);
  for (std::size_t band = 0; band < 3; ++band) {
    fog.scattering_per_m[band] = 0.004 * static_cast<double>(band + 1);
    fog.extinction_per_m[band] = 0.006 * static_cast<double>(band + 1);
  }
  fog.phase = tests::LobeOf(0.8);
  fog.scale_height_m = 40.0;
  LampLayer molecules = fog;
  molecules.phase = {.kind = PhaseKind::kRayleigh};
  molecules.scale_height_m = 8000.0;
  air.layers = {fog, molecules};
  const Lamp lamp = LampAt({60.0, 10.0, 15.0});
  const LampSegment segment = Along({1.0, 0.1, 0.2}, 150.0);
  const reference::LampLight truth = reference::AirlightAlong(air, lamp, segment);
  const SpectrumOf<double> found = Airlight(air, lamp, segment);
  ASSERT_EQ(found.size(), 3U);
  for (std::size_t band = 0; band < 3; ++band) {
    EXPECT_NEAR(found[band] / truth.radiance[band], 1.0, 1e-3) << "band " << band;
  }
}

TEST(Airlight, OnSurfacesIsTheIntegralOverTheirHemisphere) {
  for (const double g : {0.0, 0.85}) {
    const LampAir air = HomogeneousAir(0.01, 0.012, tests::LobeOf(g));
    for (const double cos_normal : {1.0, 0.5, 0.0, -0.5}) {
      // Plain quadrature around the normal is finest at the lamp, where radiance is 1/sin(alpha).
      const glm::dvec3 normal(cos_normal, std::sqrt(1.0 - cos_normal * cos_normal), 0.0);
      const Lamp lamp = LampAt({30.0, 0.0, 0.0});
      double sum = 0.0;
      constexpr int kSteps = 120, kTurns = 48;
      for (int i = 0; i < kSteps; ++i) {
        const double low = kPi * std::pow((i + 0.0) / kSteps, 2.0);
        const double high = kPi * std::pow((i + 1.0) / kSteps, 2.0);
        const double alpha = 0.5 * (low + high);
        const double radiance =
            reference::AirlightAlong(air, lamp,
                                     Along({std::cos(alpha), std::sin(alpha), 0.0}, 2000.0))
                .radiance[0];
        for (int j = 0; j < kTurns; ++j) {
          const double phi = 2.0 * kPi * (j + 0.5) / kTurns;
          const double facing =
              normal.x * std::cos(alpha) + normal.y * std::sin(alpha) * std::cos(phi);
          sum += std::max(facing, 0.0) * radiance * std::sin(alpha) * (high - low) * 2.0 * kPi /
                 kTurns;
        }
      }
      EXPECT_NEAR(AirlightOnSurface(air, 30.0, cos_normal)[0] / sum, 1.0, 1e-2)
          << "g " << g << ", cosine " << cos_normal;
    }
  }
}

// Fixed on 2026-11-21: panels were made for the fog alone, and up to half of the light of rays that
// leave it was missed, whatever the number of nodes.
TEST(Airlight, OfClearAirAboveFogIsFound) {
  LampAir air = tests::FogUnderClearAir(4e-3, 25.0, tests::LobeOf(0.8));
  air.altitude_at_origin_m = 38.0;
  for (const double distance : {430.0, 1200.0, 2200.0}) {
    for (const double climb : {0.05, 0.2}) {
      Lamp lamp = LampAt({distance, 23.0, -37.0});
      lamp.radius_m = 0.1;
      ExpectNearTheReference(air, lamp, Along({1.0, 0.0, climb}, 4.0 * distance + 20e3), 2e-3,
                             fmt::format("a lamp at {} m, a ray that climbs {}", distance, climb));
    }
  }
}

// Fixed on 2026-11-21: where the light fell to nothing from one point of the ray to the next, its
// scale was taken for 0 and the radiance was not a number.
TEST(Airlight, IsFiniteWhereLightEndsAbruptly) {
  LampAir air = HomogeneousAir(4e-3, 4e-3, tests::LobeOf(0.8));
  air.layers[0].scale_height_m = 25.0;  // 2 per metre at the eye, 152 m down
  LampSegment ray;
  ray.origin_m = {0.0, 0.0, -152.35477520255077};
  ray.end_m = 37235.5;
  const Lamp lamp =
      LampAt(ray.origin_m + 4308.8693800637693 * glm::dvec3(std::sqrt(1.0 - 0.0016), 0.0, 0.04));
  for (int i = -20; i <= 20; ++i) {
    ray.direction = glm::normalize(glm::dvec3(0.998056103, 0.013887809, 0.060755441 + 1e-5 * i));
    const double found = Airlight(air, lamp, ray, 8)[0];
    EXPECT_TRUE(std::isfinite(found) && found >= 0.0) << i;
  }
}

// Fixed on 2026-11-21: where two points of the ray at which the light was looked at fell together,
// the panel between them had no width, and the radiance was not a number.
TEST(Airlight, IsFiniteInEveryDirectionUnderALamp) {
  const LampAir air = tests::FogUnderClearAir(4e-3, 25.0, DropletPhase(12.0));
  const GaussRule& rule = GaussLegendre(3);
  for (double below_m = 0.2; below_m < 2e4; below_m *= 1.6) {
    LampSegment ray;
    ray.origin_m = {0.0, 0.0, 0.35 - below_m};
    const Lamp lamp = LampAt(ray.origin_m + below_m * glm::dvec3(0.0, 0.0, 1.0));
    for (std::size_t i = 0; i < 12; ++i) {
      for (int k = 0; k < 8; ++k) {
        const double angle = 0.2 + 0.7 * static_cast<double>(i / 3) + 0.7 * rule.node[i % 3];
        const double turn = kPi * (k + 0.5) / 8.0;
        ray.direction = {-std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn),
                         std::cos(angle)};
        ray.end_m = 4.0 * below_m + 20e3;
        const double found = Airlight(air, lamp, ray, 8)[0];
        EXPECT_TRUE(std::isfinite(found) && found >= 0.0) << below_m << " " << i << " " << k;
      }
    }
  }
}

TEST(Airlight, ReportsItsNumberOfEvaluations) {
  const LampAir air = HomogeneousAir(0.01, 0.01, tests::LobeOf(0.8));
  for (const int nodes : {8, 16, 32}) {
    const AirlightEffort effort =
        EffortOfAirlight(air, LampAt({40.0, 1.0, 0.0}), Along({1.0, 0.0, 0.0}, 100.0), nodes);
    EXPECT_EQ(effort.integrated, nodes);
    EXPECT_GE(effort.scouted, 4) << "three steps are the fewest";
    EXPECT_LE(effort.scouted, 64);
  }
  EXPECT_EQ(EffortOfAirlight(air, LampAt({4.0, 1.0, 0.0}), Along({1.0, 0.0, 0.0}, 0.0)).scouted, 0);
}

// Hard case 28.
TEST(Airlight, WithoutScatteringIsZero) {
  const LampAir air = HomogeneousAir(0.0, 0.0, tests::LobeOf(0.0));
  EXPECT_EQ(Airlight(air, LampAt({30.0, 2.0, 0.0}), Along({1.0, 0.0, 0.0}, kInfinite))[0], 0.0);
}

TEST(Lamp, TransmittanceOfFogIsTheIntegralOfItsDensity) {
  LampAir air = HomogeneousAir(0.01, 0.01, tests::LobeOf(0.0));
  air.layers[0].scale_height_m = 50.0;
  // Level, and rising by one scale height: (1 - 1/e) of the length.
  EXPECT_NEAR(TransmittanceBetween(air, {0.0, 0.0, 0.0}, {100.0, 0.0, 0.0})[0], std::exp(-1.0),
              1e-12);
  EXPECT_NEAR(TransmittanceBetween(air, {0.0, 0.0, 0.0}, {0.0, 0.0, 50.0})[0],
              std::exp(-0.5 * (1.0 - std::exp(-1.0))), 1e-12);
  for (const double rise : {1e-9, 1e-4, 0.0499, 0.0501, 0.2}) {
    const double x = rise / 50.0;
    EXPECT_NEAR(TransmittanceBetween(air, {0.0, 0.0, 0.0}, {0.0, 0.0, rise})[0],
                std::exp(-0.01 * 50.0 * -std::expm1(-x)), 1e-13)
        << "rise " << rise;
  }
}

TEST(Lamp, InvalidProfilesAreRefusedByName) {
  LampProfile profile;
  profile.kind = LampProfile::Kind::kCone;
  profile.inner_rad = 0.5;
  profile.outer_rad = 0.2;
  EXPECT_THROW(Validate(profile, "light"), InputError);
  profile.kind = LampProfile::Kind::kTable;
  EXPECT_THROW(Validate(profile, "light"), InputError) << "a table without values";
  profile.kind = LampProfile::Kind::kCosinePower;
  profile.exponent = -1.0;
  EXPECT_THROW(Validate(profile, "light"), InputError);
}

TEST(Lamp, MeasuredTablesWrapAroundTheirAxis) {
  LampProfile profile;
  profile.kind = LampProfile::Kind::kTable;
  profile.table = {{0.0, 0.5 * kPi}, {0.0, kPi}, {2.0, 1.0, 2.0, 3.0}};
  const auto across = [&](double c) {
    return RelativeIntensity(profile, {0.0, std::cos(c), std::sin(c)});
  };
  EXPECT_NEAR(across(0.0), 1.0, 1e-12);
  EXPECT_NEAR(across(0.5 * kPi), 2.0, 1e-12);
  EXPECT_NEAR(across(kPi), 3.0, 1e-12);
  EXPECT_NEAR(across(1.5 * kPi), 2.0, 1e-12) << "between the last column and the first";
}

}  // namespace
}  // namespace alpenglow::atmosphere
