// SPDX-License-Identifier: MIT
#include "atmosphere/medium/phase.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/phase_forms.h"
#include "atmosphere/medium/phase_table.h"
#include "atmosphere/medium/phase_text.h"
#include "tests/fixtures/comma_locale.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/temporary_folder.h"

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

// The lobe of Henyey and Greenstein is tabulated every half degree, and finer in the peak.
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
                                    DropletPhase(2.0),
                                    DropletPhase(5.0),
                                    DropletPhase(20.0),
                                    DropletPhase(50.0),
                                    Make(PhaseKind::kRayleigh),
                                    MakeDouble(0.89, 0.09, 0.26),
                                    MakeDouble(0.999, -0.9, 0.5),
                                    MakeDouble(0.5, -0.5, 0.0),
                                    MakeDouble(0.5, -0.5, 1.0)};
  for (const double g : {-0.999, -0.9, -0.3, -0.01, -1e-9, 0.0, 1e-9, 0.05, 0.0999, 0.1001, 0.3,
                         0.5, 0.76, 0.8, 0.93, 0.99, 0.999}) {
    for (const PhaseForm& form : PhaseForms()) {
      const std::optional<PhaseParameter> of_lobe = ParameterOf(form, "g");
      if (!of_lobe || !(g > of_lobe->low && g < of_lobe->high)) continue;
      phases.push_back(Make(form.kind, g, 0.35));
      if (!ParameterOf(form, "back_weight")) continue;
      phases.back().g_back = -0.5 * g;
      phases.back().back_weight = 0.3;
    }
  }
  return phases;
}

std::string Describe(const PhaseFunction& phase) {
  return fmt::format("{} g {} g_back {} back_weight {} alpha {}", NameOf(phase.kind), phase.g,
                     phase.g_back, phase.back_weight, phase.alpha);
}

// Integrates over cosines by Simpson's rule in w with 1 - c = 2 sinh(w)/sinh(w_max), folded at both
// ends, so that a lobe of any width is resolved.
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
TEST(Phase, IntegratesToOneAndHasTheMeanOfItsLobe) {
  EXPECT_EQ(MeanCosine(Make(PhaseKind::kHenyeyGreenstein, 0.85)), 0.85);
  for (const PhaseFunction& phase : ManyPhases()) {
    const double whole =
        2.0 * kPi * IntegrateOverCosine([&](double c) { return Phase(phase, c); }, -1.0, 1.0);
    EXPECT_NEAR(whole, 1.0, 1e-8) << Describe(phase) << "; Simpson's rule is good to 1e-9 here";
    const double mean =
        2.0 * kPi * IntegrateOverCosine([&](double c) { return c * Phase(phase, c); }, -1.0, 1.0);
    EXPECT_NEAR(mean, MeanCosine(phase), 1e-8) << Describe(phase);
  }
}

TEST(Phase, NegativeGIsTheMirrorImageOfPositiveG) {
  for (const PhaseKind kind : {PhaseKind::kHenyeyGreenstein, PhaseKind::kCornetteShanks,
                               PhaseKind::kSchlick, PhaseKind::kDraine}) {
    EXPECT_GT(Phase(Make(kind, 0.7), 1.0), 10.0 * Phase(Make(kind, 0.7), -1.0)) << NameOf(kind);
    EXPECT_GT(MeanCosine(Make(kind, 0.7)), 0.5) << NameOf(kind);
    for (const double c : {-1.0, -0.4, 0.0, 0.9, 1.0})
      EXPECT_DOUBLE_EQ(Phase(Make(kind, -0.6), c), Phase(Make(kind, 0.6), -c)) << NameOf(kind);
    EXPECT_DOUBLE_EQ(MeanCosine(Make(kind, -0.6)), -MeanCosine(Make(kind, 0.6))) << NameOf(kind);
  }
}

TEST(Phase, DraineIncludesOtherPhaseFunctions) {
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
  // The formulas are written out once more from the papers, in the form that cancels, at points
  // where that is harmless.
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

TEST(Phase, SamplesOfTwoLobesHaveTheirDistribution) {
  ExpectHistogramOf(MakeDouble(0.8, -0.4, 0.3));
  ExpectHistogramOf(DropletPhase(12.0));
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

TEST(Phase, FogOfLargerDropletsScattersMoreForwards) {
  double before = 0.0;
  for (const double diameter_um : {5.0, 10.0, 20.0, 50.0}) {
    const PhaseFunction fog = DropletPhase(diameter_um);
    EXPECT_GT(fog.g, before) << "forward lobes narrow with the diameter";
    before = fog.g;
    EXPECT_NEAR(MeanCosine(fog), 0.86, 0.04)
        << diameter_um << " um: drops of water have mean cosines of 0.82 to 0.89 in visible light";
    for (const double c : {-1.0, -0.3, 0.7, 1.0}) {
      const double value = shared::PhaseHenyeyGreensteinDraine(
          c, shared::DropletForwardG(diameter_um), shared::DropletDraineG(diameter_um),
          shared::DropletDraineWeight(diameter_um), shared::DropletDraineAlpha(diameter_um));
      EXPECT_NEAR(Phase(fog, c) / value, 1.0, 1e-12);
    }
  }
  EXPECT_NEAR(DropletPhase(4.9999).g, DropletPhase(5.0).g, 0.003) << "the two fits meet";
  EXPECT_NEAR(DropletPhase(4.9999).g_back, DropletPhase(5.0).g_back, 0.01);
  EXPECT_NEAR(DropletPhase(4.9999).back_weight, DropletPhase(5.0).back_weight, 0.01);
  EXPECT_THROW(static_cast<void>(DropletPhase(1.4)), InputError);
  EXPECT_THROW(static_cast<void>(DropletPhase(51.0)), InputError);
}

// Hard case 13.
TEST(Phase, CosinesSlightlyBeyondOneAreClamped) {
  for (const PhaseFunction& phase : ManyPhases()) {
    EXPECT_EQ(Phase(phase, 1.0 + 1e-12), Phase(phase, 1.0)) << Describe(phase);
    EXPECT_EQ(Phase(phase, -1.0 - 1e-12), Phase(phase, -1.0)) << Describe(phase);
    EXPECT_TRUE(std::isfinite(Phase(phase, 1.0))) << Describe(phase);
  }
}

// Hard case 31.
TEST(Phase, FloatAgreesWithDoubleEvenInTheSharpestLobe) {
  const auto expect = [](float in_float, double in_double, double bound = 2e-6) {
    EXPECT_LT(std::abs(static_cast<double>(in_float) / in_double - 1.0), bound)
        << "a few roundings of float, each 6e-8";
  };
  for (const float g : {-0.999f, -0.5f, 0.0f, 0.3f, 0.8f, 0.93f, 0.999f}) {
    for (const float c : {-1.0f, -0.999999f, -0.3f, 0.0f, 0.9f, 0.9999f, 0.9999999f, 1.0f}) {
      const double gd = static_cast<double>(g), cd = static_cast<double>(c);
      expect(shared::PhaseHenyeyGreenstein(c, g), shared::PhaseHenyeyGreenstein(cd, gd));
      expect(shared::PhaseCornetteShanks(c, g), shared::PhaseCornetteShanks(cd, gd));
      expect(shared::PhaseDraine(c, g, 0.4f),
             shared::PhaseDraine(cd, gd, static_cast<double>(0.4f)));
      expect(shared::PhaseRayleigh(c), shared::PhaseRayleigh(cd), 1e-6);
      if (std::abs(gd) < 0.9) expect(shared::PhaseSchlick(c, g), shared::PhaseSchlick(cd, gd));
    }
  }
}

TEST(Phase, NamesSurviveARoundTrip) {
  for (const PhaseFunction& phase : ManyPhases())
    EXPECT_EQ(PhaseKindFromName(NameOf(phase.kind)), phase.kind);
  EXPECT_THAT(tests::FaultOf([] { return PhaseKindFromName("mie"); }),
              testing::AllOf(testing::HasSubstr("\"mie\""), testing::HasSubstr("cornette-shanks")));
}

// Hard case 31.
TEST(Phase, ParametersOutOfRangeAreNamed) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const std::pair<PhaseFunction, const char*> phases[] = {
      {Make(PhaseKind::kHenyeyGreenstein, 1.0), "mie.g is 1; it must lie in (-1, 1)"},
      {Make(PhaseKind::kSchlick, 0.95), "mie.g is 0.95; it must lie in (-0.938, 0.938)"},
      {Make(PhaseKind::kHenyeyGreenstein, kNan), "mie.g is nan"},
      {MakeDouble(0.5, -1.5, 0.5), "mie.g_back"},
      {MakeDouble(0.5, -0.5, 1.5), "mie.back_weight"},
      {Make(PhaseKind::kDraine, 0.5, -0.1), "mie.alpha"},
      {Make(PhaseKind::kHenyeyGreenstein, -0.999), "no fault"}};
  for (const auto& bad : phases)
    EXPECT_THAT(tests::FaultOf([&] { Validate(bad.first, "mie"); }),
                testing::StartsWith(bad.second));
}

using testing::HasSubstr;

// OPAC's tables have 112 angles, the finest in the peak.
std::vector<double> OpacAngles() {
  std::vector<double> angles;
  for (int i = 0; i < 20; ++i) angles.push_back(i * 0.1);
  for (const double angle : {2.0, 3.0, 4.0, 5.0, 6.0}) angles.push_back(angle);
  for (int i = 8; i <= 180; i += 2) angles.push_back(i);
  return angles;
}

std::vector<double> ValuesAt(const std::vector<double>& angles, const PhaseFunction& phase) {
  std::vector<double> values;
  for (const double angle : angles) {
    values.push_back(Phase(phase, std::cos(angle * kRadiansPerDegree)));
  }
  return values;
}

using tests::FaultOf;

TEST(PhaseTable, FollowsALobeSampledAtTheAnglesOfOpac) {
  const struct { double g, bound; } lobes[] = {{0.7, 3e-4}, {0.9, 1e-3}, {0.97, 4e-3}};
  const std::vector<double> angles = OpacAngles();
  ASSERT_EQ(angles.size(), 112U);
  for (const auto& lobe : lobes) {
    const PhaseTable table(angles, ValuesAt(angles, tests::LobeOf(lobe.g)));
    EXPECT_NEAR(table.integral(), 1.0, 0.3 * lobe.bound);
    for (double angle = 0.0; angle <= 180.0; angle += 0.037) {
      const double c = std::cos(angle * kRadiansPerDegree);
      EXPECT_NEAR(table.At(PhaseTable::Position(c)) / Phase(tests::LobeOf(lobe.g), c), 1.0,
                  lobe.bound)
          << "g " << lobe.g << " at " << angle
          << " degrees: cubics through samples two degrees apart";
    }
  }
}

TEST(PhaseTable, KeepsDenseSamplesToOnePartIn20000) {
  std::vector<double> angles;
  for (int i = 0; i <= 1800; ++i) angles.push_back(i * 0.1);
  const PhaseTable table(angles, ValuesAt(angles, tests::LobeOf(0.9)));
  for (double angle = 0.0; angle <= 180.0; angle += 0.0173) {
    const double c = std::cos(angle * kRadiansPerDegree);
    EXPECT_NEAR(table.At(PhaseTable::Position(c)) / Phase(tests::LobeOf(0.9), c), 1.0, 5e-5)
        << angle << " degrees: the broken line through 1024 nodes";
  }
}

TEST(PhaseTable, IsPositiveForAnySamples) {
  std::vector<double> values{1.0, 1e-6, 50.0, 1e-8, 0.02, 1e-5, 0.3};
  const std::vector<double> angles{0.0, 1.0, 2.0, 40.0, 90.0, 170.0, 180.0};
  // Samples are scaled to an integral near 1 by trial: the integral of what is refused is in the
  // message.
  double scale = 1.0;
  for (int step = 0; step < 4; ++step) {
    const std::string fault = FaultOf([&] { PhaseTable(angles, values); });
    const std::size_t at = fault.find("sphere is ");
    if (at == std::string::npos) break;
    scale = 1.0 / std::stod(fault.substr(at + 10));
    for (double& value : values) value *= scale;
  }
  const PhaseTable table(angles, values);
  for (const double node : table.nodes()) EXPECT_GT(node, 0.0);
}

TEST(PhaseTable, NormalisesSamplesAndReportsTheFactor) {
  const std::vector<double> angles = OpacAngles();
  std::vector<double> values = ValuesAt(angles, tests::LobeOf(0.7));
  for (double& value : values) value *= 1.015;
  const PhaseTable table(angles, values);
  EXPECT_NEAR(table.integral(), 1.015, 2e-4);
  EXPECT_NEAR(table.At(PhaseTable::Position(0.3)), Phase(tests::LobeOf(0.7), 0.3), 1e-4);
  for (double& value : values) value *= 1.01;
  EXPECT_THAT(FaultOf([&] { PhaseTable(angles, values); }),
              HasSubstr("phase: the integral over the sphere is 1.025"));
}

TEST(PhaseTable, RefusesInvalidPhaseFunctions) {
  const std::vector<double> angles = OpacAngles();
  const std::vector<double> values = ValuesAt(angles, tests::LobeOf(0.5));
  const auto with = [&](std::size_t index, double angle, double value) {
    std::vector<double> a = angles, v = values;
    a[index] = angle;
    v[index] = value;
    return FaultOf([&] { PhaseTable(a, v); });
  };
  EXPECT_THAT(with(0, 0.05, 1.0), HasSubstr("must run from 0 to 180"));
  EXPECT_THAT(with(111, 179.0, 1.0), HasSubstr("must run from 0 to 180"));
  EXPECT_THAT(with(5, 0.4, 1.0), HasSubstr("0.4 degrees after 0.4"));
  EXPECT_THAT(with(5, 0.5, 0.0), HasSubstr("0 per sr at 0.5 degrees"));
  EXPECT_THAT(with(5, 0.5, std::nan("")), HasSubstr("nan per sr at 0.5 degrees"));
  EXPECT_THAT(FaultOf([] { PhaseTable({0.0, 180.0}, {0.08, 0.08}); }), HasSubstr("at least 5"));
}

TEST(PhaseTable, BetweenWavelengthsIsTheMeanOfBoth) {
  const std::vector<double> angles = OpacAngles();
  const SpectralPhase spectral{
      {400.0, 600.0},
      angles,
      {ValuesAt(angles, tests::LobeOf(0.5)), ValuesAt(angles, tests::LobeOf(0.8))}};
  EXPECT_EQ(spectral.At(300.0).per_sr(), spectral.per_sr[0]);
  EXPECT_EQ(spectral.At(700.0).per_sr(), spectral.per_sr[1]);
  const PhaseTable between = spectral.At(450.0);
  EXPECT_DOUBLE_EQ(between.per_sr()[40],
                   0.75 * spectral.per_sr[0][40] + 0.25 * spectral.per_sr[1][40]);
  EXPECT_NEAR(between.mean_cosine(), 0.75 * 0.5 + 0.25 * 0.8, 1e-3)
      << "mixing is linear but for the cubics in the logarithm";
}

TEST(PhaseTable, ComparesSamplesByValue) {
  const std::vector<double> angles = OpacAngles();
  const auto make = [&](double g) {
    return PhaseFunction{
        .kind = PhaseKind::kTable,
        .table = std::make_shared<const PhaseTable>(angles, ValuesAt(angles, tests::LobeOf(g)))};
  };
  EXPECT_EQ(make(0.7), make(0.7));
  EXPECT_NE(make(0.7), make(0.71));
  EXPECT_EQ(make(0.7).table->hash(), make(0.7).table->hash());
  EXPECT_NE(make(0.7).table->hash(), make(0.71).table->hash());
}

class PhaseFile : public TemporaryFolder {
 protected:
  // Returns a file of two wavelengths, with columns in another order than the manual's.
  std::string Text() const {
    std::string text = "# made for a test\nangle_deg,wavelength_nm,phase_per_sr\n";
    for (const double wavelength : {600.0, 400.0}) {
      for (const double angle : OpacAngles()) {
        const double c = std::cos(angle * kRadiansPerDegree);
        text += fmt::format("{},{},{}\n", angle, wavelength,
                            Phase(tests::LobeOf(wavelength == 400.0 ? 0.5 : 0.8), c));
      }
    }
    return text;
  }
  std::string FaultOfText(const std::string& text) const {
    WriteText(folder_ / "p.csv", text);
    return FaultOf([&] { static_cast<void>(ReadSpectralPhase(folder_ / "p.csv")); });
  }
};

TEST_F(PhaseFile, ColumnsAndRowsMayComeInAnyOrder) {
  WriteText(folder_ / "p.csv", Text());
  const SpectralPhase phase = ReadSpectralPhase(folder_ / "p.csv");
  EXPECT_EQ(phase.wavelength_nm, (std::vector<double>{400.0, 600.0}));
  EXPECT_EQ(phase.angle_deg, OpacAngles());
  EXPECT_EQ(phase.per_sr[0], ValuesAt(OpacAngles(), tests::LobeOf(0.5)));
}

TEST_F(PhaseFile, QuotesSeparatorsAndLineEndsOfOtherProgramsAreRead) {
  const std::string plain_text = Text().substr(Text().find('\n') + 1);  // without its comment
  std::string text = "\xEF\xBB\xBF\"";
  for (const char letter : plain_text) {
    if (letter == ',') {
      text += "\";\"";
    } else if (letter == '\n') {
      text += "\"\r\n\"";
    } else {
      text += letter;
    }
  }
  text.pop_back();
  WriteText(folder_ / "plain.csv", plain_text);
  WriteText(folder_ / "p.csv", text);
  const tests::CommaLocale locale(folder_);
  const SpectralPhase plain = ReadSpectralPhase(folder_ / "plain.csv");
  const SpectralPhase phase = ReadSpectralPhase(folder_ / "p.csv");
  EXPECT_EQ(phase.wavelength_nm, plain.wavelength_nm);
  EXPECT_EQ(phase.per_sr, plain.per_sr);
  EXPECT_THAT(FaultOfText("{\"a\": 1}"),
              HasSubstr("p.csv: this is JSON; phase functions are read"));
}

TEST_F(PhaseFile, FaultsAreNamedWithFileAndLine) {
  const std::string text = Text();
  const std::pair<std::string, const char*> texts[] = {
      {"wavelength_nm,angle_deg\n", "p.csv:1: column phase_per_sr is missing"},
      {"wavelength_nm,angle_deg,p\n", "p.csv:1: column \"p\" is unknown"},
      {text + "0,400\n", "has 2 fields; it must have 3"},
      {text + "a,400,1\n", "angle_deg is \"a\"; it must be a number"},
      {text + "0,400,1\n", "400 nm has 0 degrees twice"},
      {text + "0.05,400,1\n", "600 nm has other angles than 400 nm"},
      {text + "0.05,500,1\n", "p.csv: "},
      {text + "0,400,nan\n", "phase_per_sr is nan; it must lie in"},
      {"wavelength_nm,angle_deg,phase_per_sr\n", "p.csv: has no lines below its header"},
      {"", "p.csv: is empty"}};
  for (const auto& [file, message] : texts)
    EXPECT_THAT(FaultOfText(file), HasSubstr(message)) << message;
}

}  // namespace
}  // namespace alpenglow::atmosphere
