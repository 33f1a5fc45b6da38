// SPDX-License-Identifier: MIT
#include "renderer/lamps/ies_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "atmosphere/math/constants.h"
#include "tests/fixtures/fault_of.h"

namespace alpenglow::renderer {
namespace {

using testing::HasSubstr;
using Angles = std::vector<std::pair<double, double>>;  // C, candela

const std::string kHead = "IESNA:LM-63-2002\n[TEST] 1\n[MANUFAC] none\nTILT=NONE\n";

std::string FaultOf(const std::string& text) {
  return tests::FaultOf([&] { return IesFromText(text, "l.ies"); });
}

// Returns the intensity in a direction with components down, towards C 0 and to the right of it.
double Towards(const IesLamp& lamp, double down, double ahead, double right) {
  LampProfile profile;
  profile.kind = LampProfile::Kind::kTable;
  profile.table = lamp.table;
  const double length = std::hypot(down, ahead, right);
  return lamp.intensity_cd *
         RelativeIntensity(profile, {down / length, ahead / length, -right / length});
}

double At(const IesLamp& lamp, double gamma_deg, double c_deg) {
  const double gamma = gamma_deg * kRadiansPerDegree, c = c_deg * kRadiansPerDegree;
  return Towards(lamp, std::cos(gamma), std::sin(gamma) * std::cos(c),
                 -std::sin(gamma) * std::sin(c));
}

TEST(IesFile, RotationallySymmetricLampsAreRead) {
  const IesLamp lamp =
      IesFromText(kHead + "1 1000 2 3 1 1 2 0.1 0.1 0\n1.0 1 60\n0 45 90\n0\n100 80\n0\n", "l.ies");
  EXPECT_EQ(lamp.intensity_cd, 200.0) << "the multiplier is 2";
  EXPECT_NEAR(At(lamp, 0.0, 77.0), 200.0, 1e-9);
  EXPECT_NEAR(At(lamp, 45.0, 200.0), 160.0, 1e-9);
  EXPECT_NEAR(At(lamp, 22.5, 0.0), 180.0, 1e-9) << "linear between";
  EXPECT_NEAR(At(lamp, 100.0, 0.0), 0.0, 1e-9) << "nothing beyond the last angle";
}

TEST(IesFile, QuadrantsAndHalvesAreMirrored) {
  const IesLamp quadrant = IesFromText(
      kHead + "1 1000 1 2 3 1 2 0 0 0 1 1 60\n0 90\n0 45 90\n10 1 10 2 10 3\n", "l.ies");
  for (const auto& [c, candela] : Angles{{0.0, 1.0},
                                         {45.0, 2.0},
                                         {90.0, 3.0},
                                         {135.0, 2.0},
                                         {180.0, 1.0},
                                         {225.0, 2.0},
                                         {270.0, 3.0},
                                         {315.0, 2.0},
                                         {337.5, 1.5}}) {
    EXPECT_NEAR(At(quadrant, 90.0 - 1e-9, c), candela, 1e-6) << "C " << c;
  }
  const IesLamp half = IesFromText(
      kHead + "1 1000 1 2 3 1 2 0 0 0 1 1 60\n0 90\n0 90 180\n10 1 10 2 10 3\n", "l.ies");
  EXPECT_NEAR(At(half, 90.0 - 1e-9, 270.0), 2.0, 1e-6);
  EXPECT_NEAR(At(half, 90.0 - 1e-9, 180.0), 3.0, 1e-6);
}

TEST(IesFile, AnglesRunCounterclockwiseSeenFromAbove) {
  const IesLamp measured = IesFromText(kHead +
                                           "1 1000 1 2 5 1 2 0 0 0 1 1 60\n0 90\n0 90 180 270 360\n"
                                           "5 1 5 2 5 3 5 4 5 1\n",
                                       "l.ies");
  Lamp lamp;  // shines down, measured with C = 0 to the north
  lamp.axis = {0.0, 0.0, -1.0};
  lamp.side = {0.0, 1.0, 0.0};
  lamp.profile.kind = LampProfile::Kind::kTable;
  lamp.profile.table = measured.table;
  const auto candela = [&](double east, double north) {
    return measured.intensity_cd * RelativeIntensity(lamp, {east, north, 0.0});
  };
  EXPECT_NEAR(candela(0.0, 1.0), 1.0, 1e-9) << "north";
  EXPECT_NEAR(candela(-1.0, 0.0), 2.0, 1e-9) << "C 90 is west, on a plan counterclockwise";
  EXPECT_NEAR(candela(0.0, -1.0), 3.0, 1e-9) << "south";
  EXPECT_NEAR(candela(1.0, 0.0), 4.0, 1e-9) << "east";
}

// Returns a file with one value for each pair of angles, in the order of the file.
std::string FileOf(int type, const std::string& vertical, const std::string& horizontal,
                   const std::string& candela) {
  const auto count = [](const std::string& list) {
    return std::count(list.begin(), list.end(), ' ') + 1;
  };
  return kHead + fmt::format("1 1000 1 {} {} {} 2 0 0 0\n1 1 100\n{}\n{}\n{}\n", count(vertical),
                             count(horizontal), type, vertical, horizontal, candela);
}

TEST(IesFile, HalvesAcrossAreMirroredToo) {
  const IesLamp half = IesFromText(FileOf(1, "0 90", "90 135 180 270", "9 1 9 2 9 3 9 4"), "l.ies");
  for (const auto& [c, candela] : Angles{{90.0, 1.0},
                                         {45.0, 2.0},
                                         {0.0, 3.0},
                                         {315.0, 3.5},
                                         {270.0, 4.0},
                                         {180.0, 3.0},
                                         {225.0, 3.5}}) {
    EXPECT_NEAR(At(half, 90.0 - 1e-9, c), candela, 1e-6) << "C " << c;
  }
  const IesLamp open = IesFromText(FileOf(1, "0 90", "90 170 270", "9 1 9 2 9 4"), "l.ies");
  EXPECT_NEAR(At(open, 90.0 - 1e-9, 180.0), 2.2, 1e-6) << "no plane was measured at 180";
  EXPECT_NEAR(At(open, 90.0 - 1e-9, 0.0), 2.2, 1e-6);
}

TEST(IesFile, TypeBTurnsAboutTheLevelAxis) {
  const IesLamp lamp = IesFromText(FileOf(2, "-90 -30 0 30 90", "-60 0 30 60",
                                          "0 0 50 0 0  10 20 100 80 10  0 0 70 40 0  0 0 30 0 0"),
                                   "l.ies");
  EXPECT_NEAR(Towards(lamp, 1.0, 0.0, 0.0), 100.0, 1e-9);
  EXPECT_NEAR(Towards(lamp, std::sqrt(3.0), 1.0, 0.0), 80.0, 1e-9) << "V 30 is towards C 0";
  EXPECT_NEAR(Towards(lamp, std::sqrt(3.0), -1.0, 0.0), 20.0, 1e-9);
  EXPECT_NEAR(Towards(lamp, std::sqrt(3.0), 0.0, 1.0), 70.0, 1e-9) << "H 30 is clockwise";
  EXPECT_NEAR(Towards(lamp, 1.0, 0.0, -std::sqrt(3.0)), 50.0, 1e-9);
  EXPECT_NEAR(Towards(lamp, 1.0, 0.0, -9.0), 0.0, 1e-9) << "beyond the last H";
  const double v = std::cos(kPi / 6.0);  // V 30 and H 30: sin H is the share to the right
  EXPECT_NEAR(Towards(lamp, v * v, 0.5 * v, 0.5), 40.0, 1.0) << "sampled at 2.5 degrees";
}

TEST(IesFile, TypeBFromZeroIsSymmetric) {
  const IesLamp lamp =
      IesFromText(FileOf(2, "-90 0 90", "0 30 90", "10 100 20  5 60 15  0 0 0"), "l.ies");
  EXPECT_NEAR(Towards(lamp, std::sqrt(3.0), 0.0, 1.0), 60.0, 1e-9);
  EXPECT_NEAR(Towards(lamp, std::sqrt(3.0), 0.0, -1.0), 60.0, 1e-9);
  EXPECT_NEAR(Towards(lamp, 0.0, 1.0, 0.0), 20.0, 1e-9);
}

TEST(IesFile, TypeAShinesHorizontallyAndTurnsAboutTheVertical) {
  const IesLamp lamp = IesFromText(
      FileOf(3, "-90 0 30 90", "-90 0 60 90", "0 10 0 0  0 100 70 0  0 50 20 0  0 0 0 0"), "l.ies");
  EXPECT_NEAR(Towards(lamp, 0.0, 1.0, 0.0), 100.0, 1e-9) << "V 0, H 0 is C 0, level";
  EXPECT_NEAR(Towards(lamp, -1.0, std::sqrt(3.0), 0.0), 70.0, 1e-9) << "V 30 is above it";
  EXPECT_NEAR(Towards(lamp, 0.0, 1.0, std::sqrt(3.0)), 50.0, 1e-9) << "H 60 is clockwise";
  EXPECT_NEAR(Towards(lamp, 0.0, 0.0, -1.0), 10.0, 1e-9);
}

TEST(IesFile, TypeBHasTheFluxOfItsIntensities) {
  std::string angles, candela;
  for (int h = -90; h <= 90; h += 5) angles += fmt::format("{}{}", h > -90 ? " " : "", h);
  for (int h = -90; h <= 90; h += 5) {
    for (int v = -90; v <= 90; v += 5) {
      candela += fmt::format("{:.9f} ", 1000.0 * std::abs(std::cos(h * kRadiansPerDegree) *
                                                          std::cos(v * kRadiansPerDegree)));
    }
  }
  const IesLamp lamp = IesFromText(FileOf(2, angles, angles, candela), "l.ies");
  double lumen = 0.0;
  constexpr int kSteps = 90;
  for (int i = 0; i < kSteps; ++i) {
    const double down = (i + 0.5) / kSteps, across = std::sqrt(1.0 - down * down);
    for (int c = 0; c < kSteps; ++c) {
      const double angle = 2.0 * kPi * (c + 0.5) / kSteps;
      lumen += 2.0 * kPi / (kSteps * kSteps) *
               Towards(lamp, down, across * std::cos(angle), across * std::sin(angle));
    }
  }
  EXPECT_NEAR(lumen, 1000.0 * kPi, 0.003 * 1000.0 * kPi)
      << "I = I0 cos H cos V is Lambert's; lines between 5 degrees are up to 5^2 / 8 of a degree "
         "squared too low in each angle, 0.1 % each, and again where they are sampled";
}

TEST(IesFile, OldEditionsHaveABallastLampPhotometricFactor) {
  const std::string data = "TILT=NONE\n1 1000 1 2 1 1 2 0 0 0\n0.8 0.5 100\n0 90\n0\n1000 0\n";
  const auto candela = [&](const std::string& head) {
    return IesFromText(head + data, "l.ies").intensity_cd;
  };
  EXPECT_EQ(candela("my lamp\nline two\n"), 400.0) << "1986";
  EXPECT_EQ(candela("IESNA91\n[TEST] 1\n"), 400.0);
  EXPECT_EQ(candela("\xEF\xBB\xBFiesna91 \r\n"), 400.0);
  EXPECT_EQ(candela(""), 400.0) << "1986 without labels";
  for (const char* later : {"IESNA:LM-63-1995\n", "IESNA:LM-63-2002\n", "IES:LM-63-2019\n"}) {
    EXPECT_EQ(candela(later), 800.0) << later;
  }
}

TEST(IesFile, TiltFactorsAreRead) {
  const std::string data = "1 1000 1 2 1 1 2 0 0 0\n1 1 100\n0 90\n0\n1000 0\n";
  const std::string head = "IESNA:LM-63-2002\nTILT=INCLUDE\n";
  const IesLamp lamp = IesFromText(head + "1\n3\n0 45 90\n1.0 0.9 0.7\n" + data, "l.ies");
  EXPECT_EQ(lamp.intensity_cd, 1000.0);
  EXPECT_NEAR(lamp.tilt.FactorAt(0.0), 1.0, 1e-12);
  EXPECT_NEAR(lamp.tilt.FactorAt(67.5), 0.8, 1e-12);
  EXPECT_NEAR(lamp.tilt.FactorAt(90.0), 0.7, 1e-12);
  EXPECT_THAT(tests::FaultOf([&] { return lamp.tilt.FactorAt(91.0); }), HasSubstr("0 to 90"));
  const IesLamp level = IesFromText(head + "2\n3\n0 45 90\n1.0 0.9 0.7\n" + data, "l.ies");
  EXPECT_NEAR(level.tilt.FactorAt(90.0), 1.0, 1e-12) << "the lamp lies level all the same";
  EXPECT_THAT(FaultOf(head + "4\n1\n0\n1\n" + data), HasSubstr("l.ies:3: lamp-to-luminaire"));
  EXPECT_THAT(FaultOf(head + "1\n0\n" + data), HasSubstr("l.ies:4: number of tilt angles is 0"));
}

TEST(IesFile, LinesMayEndInAnyWay) {
  const std::string text = FileOf(1, "0 45 90", "0", "100 80 0");
  for (const char* end : {"\n", "\r\n", "\r"}) {
    std::string other = "\xEF\xBB\xBF";
    for (const char c : text) other += c == '\n' ? end : std::string(1, c);
    EXPECT_NEAR(At(IesFromText(other + "\x1a", "l.ies"), 45.0, 0.0), 80.0, 1e-9);
    EXPECT_THAT(FaultOf(other + "7"), HasSubstr("l.ies:10: \"7\" follows the last of 3")) << end;
  }
}

TEST(IesFile, TextAfterTheLastValueIsRefused) {
  const std::string comma = kHead + "1 1000 1 3 1 1 2 0 0 0\n1 1 100\n0 45 90\n0\n";
  EXPECT_THAT(FaultOf(comma + "1000,5 800,5 400,5\n"),
              HasSubstr("l.ies:9: \"5\" follows the last of 3 candela values"));
  EXPECT_THAT(FaultOf(comma + "1000 800 400\nend\n"), HasSubstr("l.ies:10: \"end\" follows"));
  EXPECT_THAT(FaultOf(comma + "1000 800 400\n\x1a 5"), HasSubstr("\"5\" follows"));
  EXPECT_EQ(FaultOf(comma + "1000 800 400 \t\r\n\n\x1a"), "no fault");
  EXPECT_EQ(FaultOf(comma + "1000,800,400,\n"), "no fault") << "a comma separates numbers";
}

TEST(IesFile, FaultsAreReportedByLine) {
  const std::string type_1 = kHead + "1 1000 1 2 1 1 2 0 0 0 1 1 60\n";
  const char* const ranges = "from 0 to 0, 90, 180 or 360, or from 90 to 270";
  for (const auto& [text, fault] : std::vector<std::pair<std::string, const char*>>{
           {"hello", "l.ies: has no TILT line"},
           {"TILT=lamp.tlt\n1\n", "l.ies:1: TILT=lamp.tlt; TILT=NONE and"},
           {kHead + "1 1000 1 2 1 4 2 0 0 0 1 1 60\n0 90\n0\n1 1\n",
            "photometric type is 4; it must lie in [1, 3]"},
           {kHead + "1 1000 1 2 1 2 2 0 0 0 1 1 60\n0 90\n0\n1 1\n",
            "horizontal angles go from 0 to 0"},
           {FileOf(1, "0 90", "0 100 200 300", "1 1 1 1 1 1 1 1"), ranges},
           {FileOf(1, "0 90", "0 90 180 270", "1 1 1 1 1 1 1 1"), ranges},
           {FileOf(1, "0 90", "0 90 170 359", "1 1 1 1 1 1 1 1"), ranges},
           {FileOf(1, "0 90", "90 180 269", "1 1 1 1 1 1 1 1"), ranges},
           {type_1 + "0 90\n0\n1\n", "candela value is missing: the file ends"},
           {type_1 + "90 0\n0\n1 1\n", "l.ies:6: vertical angle 0 comes after 90"},
           {type_1 + "0 90\n0\n1 -1\n", "candela value is -1"},
           {type_1 + "0 90\n0\n0 0\n", "has no light"},
           {type_1 + "0 90\n5\n1 1\n", "horizontal angles go from 5"},
           {FileOf(2, "0 90", "-60 30", "1 1 1 1"), "go from -60 to 30"},
           {kHead + "1 1000 1 x 1\n", "is \"x\"; it must be a number"}})
    EXPECT_THAT(FaultOf(text), HasSubstr(fault)) << text;
}

}  // namespace
}  // namespace alpenglow::renderer
