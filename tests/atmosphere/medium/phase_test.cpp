// SPDX-License-Identifier: MIT
#include "atmosphere/medium/phase.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/phase_table.h"
#include "atmosphere/medium/phase_text.h"
#include "tests/fixtures/fault_of.h"

namespace alpenglow::atmosphere {
namespace {

PhaseFunction Make(PhaseKind kind, double g = 0.0, double alpha = 1.0) {
  PhaseFunction phase;
  phase.kind = kind;
  phase.g = g;
  phase.alpha = alpha;
  return phase;
}

PhaseFunction MakeDouble(double g, double g_back, double back_weight) {
  PhaseFunction phase = Make(PhaseKind::kDoubleHenyeyGreenstein, g);
  phase.g_back = g_back;
  phase.back_weight = back_weight;
  return phase;
}

// The lobe of Henyey and Greenstein, as somebody would
// tabulate it: every half degree, finer in the peak.
std::shared_ptr<const PhaseTable> TabulatedLobe(double g) {
  std::vector<double> angle_deg, per_sr;
  for (int i = 0; i <= 400; ++i) {
    const double angle = i <= 50 ? i * 0.1 : 5.0 + (i - 50) * 0.5;
    angle_deg.push_back(angle);
    const double c = std::cos(angle * kRadiansPerDegree);
    per_sr.push_back((1.0 - g * g) / (4.0 * kPi * std::pow(1.0 + g * g - 2.0 * g * c, 1.5)));
  }
  return std::make_shared<const PhaseTable>(angle_deg, per_sr);
}

std::vector<PhaseFunction> ManyPhases() {
  std::vector<PhaseFunction> phases{{.kind = PhaseKind::kTable, .table = TabulatedLobe(0.0)},
                                    {.kind = PhaseKind::kTable, .table = TabulatedLobe(0.9)},
                                    FogPhase(2.0),
                                    FogPhase(5.0),
                                    FogPhase(20.0),
                                    FogPhase(50.0),
                                    Make(PhaseKind::kRayleigh),
                                    MakeDouble(0.89, 0.09, 0.26),
                                    MakeDouble(0.999, -0.9, 0.5),
                                    MakeDouble(0.5, -0.5, 0.0),
                                    MakeDouble(0.5, -0.5, 1.0)};
  for (const double g : {-0.999, -0.9, -0.3, -0.01, -1e-9, 0.0, 1e-9, 0.05, 0.0999, 0.1001, 0.3,
                         0.5, 0.76, 0.8, 0.93, 0.99, 0.999}) {
    phases.push_back(Make(PhaseKind::kHenyeyGreenstein, g));
    phases.push_back(Make(PhaseKind::kCornetteShanks, g));
    phases.push_back(Make(PhaseKind::kDraine, g, 0.35));
    if (std::abs(g) < kLargestSchlickG) phases.push_back(Make(PhaseKind::kSchlick, g));
  }
  return phases;
}

std::string Describe(const PhaseFunction& phase) {
  return fmt::format("{} g {} g_back {} back_weight {} alpha {}", NameOf(phase.kind), phase.g,
                     phase.g_back, phase.back_weight, phase.alpha);
}

// Integral over cosines from low to 1 - (small): Simpson in w with 1 - c = 2 sinh(w)/sinh(w_max)
// folded at both ends, so that a lobe of any width is resolved.
double IntegrateOverCosine(const std::function<double(double)>& f, double low, double high) {
  constexpr int kSteps = 4000;
  constexpr double kSharpness = 20.0;
  const double half = 0.5 * (high - low);
  double sum = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    const double w = static_cast<double>(i) / kSteps;
    const double weight = i == 0 || i == kSteps ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
    const double from_end = half * std::sinh(kSharpness * w) / std::sinh(kSharpness);
    const double slope = half * kSharpness * std::cosh(kSharpness * w) / std::sinh(kSharpness);
    sum += weight * slope * (f(low + from_end) + f(high - from_end));
  }
  return sum / (3.0 * kSteps);
}

// Hard case 31.
TEST(Phase, LightScatteredIntoAllDirectionsIsOne) {
  for (const PhaseFunction& phase : ManyPhases()) {
    const double whole =
        2.0 * kPi * IntegrateOverCosine([&](double c) { return Phase(phase, c); }, -1.0, 1.0);
    EXPECT_NEAR(whole, 1.0, 1e-8) << Describe(phase) << "; Simpson's rule is good to 1e-9 here";
  }
}

TEST(Phase, MeanCosineIsTheMeanOfTheLobe) {
  for (const PhaseFunction& phase : ManyPhases()) {
    const double mean =
        2.0 * kPi * IntegrateOverCosine([&](double c) { return c * Phase(phase, c); }, -1.0, 1.0);
    EXPECT_NEAR(mean, MeanCosine(phase), 1e-8) << Describe(phase);
  }
}

TEST(Phase, MeanCosineOfHenyeyGreensteinIsG) {
  EXPECT_EQ(MeanCosine(Make(PhaseKind::kHenyeyGreenstein, 0.85)), 0.85);
}

TEST(Phase, PositiveGScattersForwards) {
  for (const PhaseKind kind : {PhaseKind::kHenyeyGreenstein, PhaseKind::kCornetteShanks,
                               PhaseKind::kSchlick, PhaseKind::kDraine}) {
    EXPECT_GT(Phase(Make(kind, 0.7), 1.0), 10.0 * Phase(Make(kind, 0.7), -1.0)) << NameOf(kind);
    EXPECT_GT(MeanCosine(Make(kind, 0.7)), 0.5) << NameOf(kind);
  }
}

TEST(Phase, NegativeGIsTheMirrorImage) {
  for (const PhaseKind kind : {PhaseKind::kHenyeyGreenstein, PhaseKind::kCornetteShanks,
                               PhaseKind::kSchlick, PhaseKind::kDraine}) {
    for (const double c : {-1.0, -0.4, 0.0, 0.9, 1.0}) {
      EXPECT_DOUBLE_EQ(Phase(Make(kind, -0.6), c), Phase(Make(kind, 0.6), -c)) << NameOf(kind);
    }
    EXPECT_DOUBLE_EQ(MeanCosine(Make(kind, -0.6)), -MeanCosine(Make(kind, 0.6))) << NameOf(kind);
  }
}

TEST(Phase, DraineSpansHenyeyGreensteinCornetteShanksAndRayleigh) {
  for (const double c : {-1.0, -0.3, 0.2, 0.99, 1.0}) {
    EXPECT_NEAR(Phase(Make(PhaseKind::kDraine, 0.8, 0.0), c),
                Phase(Make(PhaseKind::kHenyeyGreenstein, 0.8), c), 1e-13);
    EXPECT_NEAR(Phase(Make(PhaseKind::kDraine, 0.8, 1.0), c),
                Phase(Make(PhaseKind::kCornetteShanks, 0.8), c), 1e-13);
    EXPECT_NEAR(Phase(Make(PhaseKind::kDraine, 0.0, 1.0), c), Phase(Make(PhaseKind::kRayleigh), c),
                1e-15);
  }
}

TEST(Phase, AgreesWithTheFormulasAsPublished) {
  // Written out once more from the papers, in the form
  // that cancels, at points where that is harmless.
  const double g = 0.6;
  const double c = 0.3;
  const double d = std::pow(1.0 + g * g - 2.0 * g * c, 1.5);
  const double k = 1.55 * g - 0.55 * g * g * g;
  EXPECT_NEAR(Phase(Make(PhaseKind::kRayleigh), c), 3.0 / (16.0 * kPi) * (1.0 + c * c), 1e-15);
  EXPECT_NEAR(Phase(Make(PhaseKind::kHenyeyGreenstein, g), c), (1.0 - g * g) / (4.0 * kPi * d),
              1e-15);
  EXPECT_NEAR(Phase(Make(PhaseKind::kCornetteShanks, g), c),
              3.0 * (1.0 - g * g) * (1.0 + c * c) / (8.0 * kPi * (2.0 + g * g) * d), 1e-15);
  EXPECT_NEAR(Phase(Make(PhaseKind::kSchlick, g), c),
              (1.0 - k * k) / (4.0 * kPi * (1.0 - k * c) * (1.0 - k * c)), 1e-15);
}

TEST(Phase, SamplesHaveTheDistributionOfTheLobe) {
  // The share of light below the drawn cosine must be the uniform number that drew it. The double
  // Henyey-Greenstein is not monotone in u and has its own test.
  for (const PhaseFunction& phase : ManyPhases()) {
    if (phase.kind == PhaseKind::kDoubleHenyeyGreenstein) continue;
    if (phase.kind == PhaseKind::kHenyeyGreensteinDraine) continue;
    for (const double u : {1e-6, 0.01, 0.2, 0.5, 0.77, 0.99, 1.0 - 1e-6}) {
      const double cosine = SampleCosine(phase, u);
      const double below =
          2.0 * kPi * IntegrateOverCosine([&](double c) { return Phase(phase, c); }, -1.0, cosine);
      const bool kinked = phase.kind == PhaseKind::kTable;
      EXPECT_NEAR(below, u, kinked ? 2e-7 : 2e-8)
          << Describe(phase) << "; the quadrature is good to 1e-8, and to 1e-7 over kinks";
    }
  }
}

void ExpectHistogramOf(const PhaseFunction& phase) {
  constexpr int kBins = 40;
  constexpr int kSamples = 400000;
  std::vector<double> counts(kBins, 0.0);
  for (int i = 0; i < kSamples; ++i) {
    const double cosine = SampleCosine(phase, (i + 0.5) / kSamples);
    counts[std::min<std::size_t>(static_cast<std::size_t>((cosine + 1.0) / 2.0 * kBins),
                                 kBins - 1)] += 1.0;
  }
  for (int bin = 0; bin < kBins; ++bin) {
    const double low = -1.0 + 2.0 * bin / kBins;
    const double expected =
        kSamples * 2.0 * kPi *
        IntegrateOverCosine([&](double c) { return Phase(phase, c); }, low, low + 2.0 / kBins);
    EXPECT_NEAR(counts[static_cast<std::size_t>(bin)], expected, 3.0)
        << "equidistant numbers miss a bin's share by at most one sample at each of two ends a "
           "lobe";
  }
}

TEST(Phase, SamplesOfTwoLobesFillHistogramBinsAsTheLobesDo) {
  ExpectHistogramOf(MakeDouble(0.8, -0.4, 0.3));
  ExpectHistogramOf(FogPhase(12.0));
}

TEST(Phase, SamplesStayInRangeAtTheEndsOfTheUnitInterval) {
  for (const PhaseFunction& phase : ManyPhases()) {
    for (const double u : {0.0, 1e-300, std::nextafter(1.0, 0.0)}) {
      const double cosine = SampleCosine(phase, u);
      EXPECT_TRUE(cosine >= -1.0 && cosine <= 1.0)
          << Describe(phase) << " u " << u << ": " << cosine;
    }
  }
}

TEST(Phase, FogScattersForwardTheMoreTheLargerItsDroplets) {
  double before = 0.0;
  for (const double diameter_um : {5.0, 10.0, 20.0, 50.0}) {
    const PhaseFunction fog = FogPhase(diameter_um);
    EXPECT_GT(fog.g, before) << "forward lobes narrow with the diameter";
    before = fog.g;
    EXPECT_NEAR(MeanCosine(fog), 0.86, 0.04)
        << diameter_um << " um: drops of water have mean cosines of 0.82 to 0.89 in visible light";
    for (const double c : {-1.0, -0.3, 0.7, 1.0}) {
      EXPECT_NEAR(Phase(fog, c) / shared::PhaseFog(c, diameter_um), 1.0, 1e-12);
    }
  }
  EXPECT_NEAR(FogPhase(4.9999).g, FogPhase(5.0).g, 0.003) << "the two fits meet";
  EXPECT_NEAR(FogPhase(4.9999).g_back, FogPhase(5.0).g_back, 0.01);
  EXPECT_NEAR(FogPhase(4.9999).back_weight, FogPhase(5.0).back_weight, 0.01);
  EXPECT_THROW(static_cast<void>(FogPhase(1.4)), InputError);
  EXPECT_THROW(static_cast<void>(FogPhase(51.0)), InputError);
}

// Hard case 13.
TEST(Phase, CosinesBeyondOneByRoundingAreClamped) {
  for (const PhaseFunction& phase : ManyPhases()) {
    EXPECT_EQ(Phase(phase, 1.0 + 1e-12), Phase(phase, 1.0)) << Describe(phase);
    EXPECT_EQ(Phase(phase, -1.0 - 1e-12), Phase(phase, -1.0)) << Describe(phase);
    EXPECT_TRUE(std::isfinite(Phase(phase, 1.0))) << Describe(phase);
  }
}

double RelativeDifference(float in_float, double in_double) {
  return std::abs(static_cast<double>(in_float) / in_double - 1.0);
}

// Hard case 31.
TEST(Phase, FloatAgreesWithDoubleEvenInTheSharpestLobe) {
  for (const float g : {-0.999f, -0.5f, 0.0f, 0.3f, 0.8f, 0.93f, 0.999f}) {
    for (const float c : {-1.0f, -0.999999f, -0.3f, 0.0f, 0.9f, 0.9999f, 0.9999999f, 1.0f}) {
      const double gd = static_cast<double>(g);
      const double cd = static_cast<double>(c);
      const char* why = "a few roundings of float, each 6e-8";
      EXPECT_LT(RelativeDifference(shared::PhaseHenyeyGreenstein(c, g),
                                   shared::PhaseHenyeyGreenstein(cd, gd)),
                2e-6)
          << why;
      EXPECT_LT(RelativeDifference(shared::PhaseCornetteShanks(c, g),
                                   shared::PhaseCornetteShanks(cd, gd)),
                2e-6)
          << why;
      EXPECT_LT(RelativeDifference(shared::PhaseDraine(c, g, 0.4f),
                                   shared::PhaseDraine(cd, gd, static_cast<double>(0.4f))),
                2e-6)
          << why;
      EXPECT_LT(RelativeDifference(shared::PhaseRayleigh(c), shared::PhaseRayleigh(cd)), 1e-6)
          << why;
      if (std::abs(gd) < 0.9) {
        EXPECT_LT(RelativeDifference(shared::PhaseSchlick(c, g), shared::PhaseSchlick(cd, gd)),
                  2e-6)
            << why;
      }
    }
  }
}

TEST(Phase, NamesGoThereAndBack) {
  for (const PhaseFunction& phase : ManyPhases()) {
    EXPECT_EQ(PhaseKindFromName(NameOf(phase.kind)), phase.kind);
  }
  try {
    (void)PhaseKindFromName("mie");
    FAIL() << "\"mie\" was accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("\"mie\""));
    EXPECT_THAT(error.what(), testing::HasSubstr("cornette-shanks"));
  }
}

// Hard case 31.
TEST(Phase, ParametersOutOfRangeAreNamed) {
  const auto message = [](const PhaseFunction& phase) {
    return tests::FaultOf([&] { Validate(phase, "mie"); });
  };
  EXPECT_EQ(message(Make(PhaseKind::kHenyeyGreenstein, 1.0)), "mie.g is 1; it must lie in (-1, 1)");
  EXPECT_EQ(message(Make(PhaseKind::kSchlick, 0.95)),
            "mie.g is 0.95; it must lie in (-0.938, 0.938)");
  EXPECT_THAT(message(Make(PhaseKind::kHenyeyGreenstein, std::numeric_limits<double>::quiet_NaN())),
              testing::HasSubstr("mie.g is nan"));
  EXPECT_THAT(message(MakeDouble(0.5, -1.5, 0.5)), testing::HasSubstr("mie.g_back"));
  EXPECT_THAT(message(MakeDouble(0.5, -0.5, 1.5)), testing::HasSubstr("mie.back_weight"));
  EXPECT_THAT(message(Make(PhaseKind::kDraine, 0.5, -0.1)), testing::HasSubstr("mie.alpha"));
  EXPECT_EQ(message(Make(PhaseKind::kHenyeyGreenstein, -0.999)), "no fault");
}

}  // namespace
}  // namespace alpenglow::atmosphere
