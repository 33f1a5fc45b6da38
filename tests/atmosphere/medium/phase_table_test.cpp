// SPDX-License-Identifier: MIT
#include "atmosphere/medium/phase_table.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "atmosphere/math/constants.h"
#include "atmosphere/medium/phase.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::atmosphere {
namespace {

using testing::HasSubstr;

// The angles of OPAC's tables: 112, the finest in the peak.
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

PhaseFunction Lobe(double g) { return {.kind = PhaseKind::kHenyeyGreenstein, .g = g}; }

using tests::FaultOf;

TEST(PhaseTable, FollowsALobeThroughTheAnglesOfOpac) {
  const struct { double g, bound; } lobes[] = {{0.7, 3e-4}, {0.9, 1e-3}, {0.97, 4e-3}};
  const std::vector<double> angles = OpacAngles();
  ASSERT_EQ(angles.size(), 112U);
  for (const auto& lobe : lobes) {
    const PhaseTable table(angles, ValuesAt(angles, Lobe(lobe.g)));
    EXPECT_NEAR(table.integral(), 1.0, 0.3 * lobe.bound);
    for (double angle = 0.0; angle <= 180.0; angle += 0.037) {
      const double c = std::cos(angle * kRadiansPerDegree);
      EXPECT_NEAR(table.At(PhaseTable::Position(c)) / Phase(Lobe(lobe.g), c), 1.0, lobe.bound)
          << "g " << lobe.g << " at " << angle
          << " degrees: cubics through samples two degrees apart";
    }
  }
}

TEST(PhaseTable, DenseSamplesAreKeptToOnePartInTwentyThousand) {
  std::vector<double> angles;
  for (int i = 0; i <= 1800; ++i) angles.push_back(i * 0.1);
  const PhaseTable table(angles, ValuesAt(angles, Lobe(0.9)));
  for (double angle = 0.0; angle <= 180.0; angle += 0.0173) {
    const double c = std::cos(angle * kRadiansPerDegree);
    EXPECT_NEAR(table.At(PhaseTable::Position(c)) / Phase(Lobe(0.9), c), 1.0, 5e-5)
        << angle << " degrees: the broken line through 1024 nodes";
  }
}

TEST(PhaseTable, IsPositiveHoweverRuggedTheSamples) {
  std::vector<double> values{1.0, 1e-6, 50.0, 1e-8, 0.02, 1e-5, 0.3};
  const std::vector<double> angles{0.0, 1.0, 2.0, 40.0, 90.0, 170.0, 180.0};
  // Scaled to an integral near 1 by trial: the integral of what is refused is in the message.
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

TEST(PhaseTable, ScalesSamplesAndSaysHowFarTheyWereOff) {
  const std::vector<double> angles = OpacAngles();
  std::vector<double> values = ValuesAt(angles, Lobe(0.7));
  for (double& value : values) value *= 1.015;
  const PhaseTable table(angles, values);
  EXPECT_NEAR(table.integral(), 1.015, 2e-4);
  EXPECT_NEAR(table.At(PhaseTable::Position(0.3)), Phase(Lobe(0.7), 0.3), 1e-4);
  for (double& value : values) value *= 1.01;
  EXPECT_THAT(FaultOf([&] { PhaseTable(angles, values); }),
              HasSubstr("phase: the integral over the sphere is 1.025"));
}

TEST(PhaseTable, RefusesWhatIsNoPhaseFunction) {
  const std::vector<double> angles = OpacAngles();
  const std::vector<double> values = ValuesAt(angles, Lobe(0.5));
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
      {400.0, 600.0}, angles, {ValuesAt(angles, Lobe(0.5)), ValuesAt(angles, Lobe(0.8))}};
  EXPECT_EQ(spectral.At(300.0).per_sr(), spectral.per_sr[0]);
  EXPECT_EQ(spectral.At(700.0).per_sr(), spectral.per_sr[1]);
  const PhaseTable between = spectral.At(450.0);
  EXPECT_DOUBLE_EQ(between.per_sr()[40],
                   0.75 * spectral.per_sr[0][40] + 0.25 * spectral.per_sr[1][40]);
  EXPECT_NEAR(between.mean_cosine(), 0.75 * 0.5 + 0.25 * 0.8, 1e-3)
      << "mixing is linear but for the cubics in the logarithm";
}

TEST(PhaseTable, EqualSamplesAreEqualWhereverTheyAre) {
  const std::vector<double> angles = OpacAngles();
  const auto make = [&](double g) {
    return PhaseFunction{
        .kind = PhaseKind::kTable,
        .table = std::make_shared<const PhaseTable>(angles, ValuesAt(angles, Lobe(g)))};
  };
  EXPECT_EQ(make(0.7), make(0.7));
  EXPECT_NE(make(0.7), make(0.71));
  EXPECT_EQ(make(0.7).table->hash(), make(0.7).table->hash());
  EXPECT_NE(make(0.7).table->hash(), make(0.71).table->hash());
}

class PhaseFile : public TemporaryFolder {
 protected:
  // Two wavelengths, columns in another order than the manual's.
  std::string Text() const {
    std::string text = "# made for a test\nangle_deg,wavelength_nm,phase_per_sr\n";
    for (const double wavelength : {600.0, 400.0}) {
      for (const double angle : OpacAngles()) {
        const double c = std::cos(angle * kRadiansPerDegree);
        text += fmt::format("{},{},{}\n", angle, wavelength,
                            Phase(Lobe(wavelength == 400.0 ? 0.5 : 0.8), c));
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
  EXPECT_EQ(phase.per_sr[0], ValuesAt(OpacAngles(), Lobe(0.5)));
}

TEST_F(PhaseFile, FaultsAreNamedWithFileAndLine) {
  const std::string text = Text();
  EXPECT_THAT(FaultOfText("wavelength_nm,angle_deg\n"), HasSubstr("p.csv:1: 2 fields"));
  EXPECT_THAT(FaultOfText("wavelength_nm,angle_deg,p\n"),
              HasSubstr("p.csv:1: column phase_per_sr is missing"));
  EXPECT_THAT(FaultOfText(text + "a,400,1\n"),
              HasSubstr("angle_deg is \"a\"; it must be a number"));
  EXPECT_THAT(FaultOfText(text + "0,400,1\n"), HasSubstr("400 nm has 0 degrees twice"));
  EXPECT_THAT(FaultOfText(text + "0.05,400,1\n"), HasSubstr("600 nm has other angles than 400 nm"));
  EXPECT_THAT(FaultOfText(text + "0.05,500,1\n"), HasSubstr("p.csv: "));
  EXPECT_THAT(FaultOfText(""), HasSubstr("p.csv: no values"));
}

}  // namespace
}  // namespace alpenglow::atmosphere
