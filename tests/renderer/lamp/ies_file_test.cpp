// SPDX-License-Identifier: MIT
#include "renderer/lamp/ies_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "atmosphere/number/constants.h"
#include "tests/fixtures/fault_of.h"

namespace alpenglow {
namespace {

using testing::HasSubstr;

const std::string kHead = "IESNA:LM-63-2002\n[TEST] 1\n[MANUFAC] none\nTILT=NONE\n";

std::string FaultOf(const std::string& text) {
  return tests::FaultOf([&] { return IesFromText(text, "l.ies"); });
}

double At(const IesLamp& lamp, double gamma_deg, double c_deg) {
  LampProfile profile;
  profile.kind = LampProfile::Kind::kTable;
  profile.table = lamp.table;
  const double gamma = gamma_deg * kRadiansPerDegree, c = c_deg * kRadiansPerDegree;
  return lamp.intensity_cd *
         RelativeIntensity(profile, {std::cos(gamma), std::sin(gamma) * std::cos(c),
                                     std::sin(gamma) * std::sin(c)});
}

TEST(IesFile, ALampThatIsTheSameAllAround) {
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
  for (const auto& [c, candela] : std::vector<std::pair<double, double>>{{0.0, 1.0},
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

TEST(IesFile, AnglesGoCounterclockwiseAroundALampThatIsSeenFromAbove) {
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

TEST(IesFile, FaultsAreNamedByLine) {
  EXPECT_THAT(FaultOf("hello"), HasSubstr("l.ies: has no TILT line"));
  EXPECT_THAT(FaultOf("TILT=INCLUDE\n1\n"), HasSubstr("l.ies:1: TILT=INCLUDE; only TILT=NONE"));
  EXPECT_THAT(FaultOf(kHead + "1 1000 1 2 1 2 2 0 0 0 1 1 60\n0 90\n0\n1 1\n"),
              HasSubstr("photometric type is 2"));
  EXPECT_THAT(FaultOf(kHead + "1 1000 1 2 1 1 2 0 0 0 1 1 60\n0 90\n0\n1\n"),
              HasSubstr("candela value is missing: the file ends"));
  EXPECT_THAT(FaultOf(kHead + "1 1000 1 2 1 1 2 0 0 0 1 1 60\n90 0\n0\n1 1\n"),
              HasSubstr("l.ies:6: vertical angle 0 comes after 90"));
  EXPECT_THAT(FaultOf(kHead + "1 1000 1 2 1 1 2 0 0 0 1 1 60\n0 90\n0\n1 -1\n"),
              HasSubstr("candela value is -1"));
  EXPECT_THAT(FaultOf(kHead + "1 1000 1 2 1 1 2 0 0 0 1 1 60\n0 90\n0\n0 0\n"),
              HasSubstr("has no light"));
  EXPECT_THAT(FaultOf(kHead + "1 1000 1 2 1 1 2 0 0 0 1 1 60\n0 90\n5\n1 1\n"),
              HasSubstr("horizontal angles go from 5"));
  EXPECT_THAT(FaultOf(kHead + "1 1000 1 x 1\n"), HasSubstr("is \"x\"; it must be a number"));
}

}  // namespace
}  // namespace alpenglow
