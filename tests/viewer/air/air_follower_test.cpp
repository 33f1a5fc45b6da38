// SPDX-License-Identifier: MIT
// Tables that follow an eye and a sun.
#include "viewer/air/air_follower.h"

#include <gtest/gtest.h>

#include <cmath>
#include <thread>
#include <utility>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "tests/lut/camera_tables/air_reference.h"
#include "tests/viewer/shaders/headless.h"

namespace alpenglow::viewer {
namespace {

using AirFollowerOnGpu = tests::Headless;

const std::shared_ptr<const SolvedAir>& Earth() {
  static const auto earth = SolveAir(MediumPreset("earth"));
  return earth;
}

AirView ViewAt(double altitude_m, double elevation_deg) {
  const double e = elevation_deg * kRadiansPerDegree;
  const glm::dvec3 sun(0.0, std::cos(e), std::sin(e));
  return {altitude_m, 0.8, {sun, sun}};
}

// Frames with the same view until the tables shown are for it, or a hundred.
void Frames(AirFollower& follower, const AirView& view) {
  for (int i = 0; i < 100 && follower.eye().altitude_m != view.altitude_m; ++i) {
    follower.Follow(view);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

TEST_F(AirFollowerOnGpu, HasTablesForTheFirstFrame) {
  const AirFollower follower(Earth(), AirQuality::kLow, ViewAt(2.0, 30.0));
  EXPECT_EQ(follower.eye().altitude_m, 2.0);
  EXPECT_EQ(follower.air(), Earth());
  EXPECT_EQ(follower.making_s(), 0.0) << "made before drawing, not beside it";
}

TEST_F(AirFollowerOnGpu, ShowsExactTablesOnceAllStandsStill) {
  AirFollower follower(Earth(), AirQuality::kLow, ViewAt(2.0, 30.0));
  Frames(follower, ViewAt(2.5, 30.0));
  EXPECT_EQ(follower.eye().altitude_m, 2.5) << "however small the change";
  EXPECT_GT(follower.making_s(), 0.0);
}

TEST_F(AirFollowerOnGpu, LeavesTinyChangesAloneWhileTheEyeMoves) {
  AirFollower follower(Earth(), AirQuality::kLow, ViewAt(1000.0, 30.0));
  follower.WaitUntilReady(ViewAt(1000.0, 30.0));
  for (int i = 1; i <= 10; ++i) {
    follower.Follow(ViewAt(1000.0 + 0.01 * i, 30.0));
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_EQ(follower.eye().altitude_m, 1000.0);
}

TEST_F(AirFollowerOnGpu, TablesOfASunThatRunsAreMadeForWhereItWillBe) {
  AirFollower follower(Earth(), AirQuality::kLow, ViewAt(2.0, 3.0));
  follower.WaitUntilReady(ViewAt(2.0, 3.0));
  const AirView now = ViewAt(2.0, 2.95);
  follower.Follow(now, 0.04);  // asks
  const double made_mu_s = follower.eye().mu_s;
  for (int i = 0; i < 2000 && follower.eye().mu_s == made_mu_s; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    follower.Follow(now, 0.04);
  }
  EXPECT_LT(follower.eye().mu_s, now.sun.for_air.z) << "lower, for the sun sinks";
}

TEST_F(AirFollowerOnGpu, SettleShowsWhatWasAskedForLast) {
  AirFollower follower(Earth(), AirQuality::kLow, ViewAt(2.0, 30.0));
  follower.Follow(ViewAt(500.0, 20.0));
  follower.WaitUntilReady(ViewAt(9000.0, -3.0));
  EXPECT_EQ(follower.eye().altitude_m, 9000.0);
  EXPECT_NEAR(follower.eye().mu_s, std::sin(-3.0 * kRadiansPerDegree), 1e-12);
}

TEST_F(AirFollowerOnGpu, AnotherMediumIsShownAsADraftAndThenInFull) {
  AirFollower follower(Earth(), AirQuality::kLow, ViewAt(2.0, 30.0));
  follower.Replace(MediumPreset("hazy"));
  follower.Follow(ViewAt(2.0, 30.0));
  EXPECT_EQ(follower.air()->medium.name, "earth") << "until then the last one";
  for (int i = 0; i < 2000 && follower.air() == Earth(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    follower.Follow(ViewAt(2.0, 30.0));
  }
  EXPECT_EQ(follower.air()->medium.name, "hazy");
  EXPECT_EQ(follower.air()->solution, AirSolution::kDraft);
  follower.WaitUntilReady(ViewAt(2.0, 30.0));
  EXPECT_EQ(follower.air()->medium.name, "hazy");
  EXPECT_EQ(follower.air()->solution, AirSolution::kFull);
}

// --- what is left alone ---

/// Tables made for one eye, as another sees them: root mean square of relative errors of the sky.
double ErrorOfOld(const AirEye& made, const AirEye& now) {
  const tests::LitAir& air = tests::Earth();
  const MediumTables medium = MakeMediumTables(air.air, air.beam);
  const AirTablesSize size = AirTablesSizeOf(AirQuality::kHigh, now.altitude_m);
  const AirTables old = MakeAirTables(air.air, air.multiple_scattering, medium, made, size);
  const AirMap map(air.medium, now.altitude_m, now.ceiling_m,
                   static_cast<double>(air.multiple_scattering.grid().twilight_fall));
  return tests::SkyErrors(tests::AirReference(air, now), tests::AirReading(old, medium, now), map,
                          200)
      .Rms();
}

TEST(AirChange, IsAboutTheErrorOfTablesThatAreNotMadeAnew) {
  const auto sine = [](double degrees) { return std::sin(degrees * kRadiansPerDegree); };
  const std::vector<std::pair<AirEye, AirEye>> changes{
      {{1500.0, sine(40.0)}, {1500.0, sine(39.0)}}, {{1500.0, sine(5.0)}, {1500.0, sine(4.9)}},
      {{1500.0, sine(0.1)}, {1500.0, sine(0.05)}},  {{2.0, sine(-4.0)}, {2.0, sine(-4.03)}},
      {{2.0, sine(-9.0)}, {2.0, sine(-9.03)}},      {{200.0, sine(20.0)}, {260.0, sine(20.0)}},
      {{9000.0, sine(20.0)}, {9100.0, sine(20.0)}}, {{30e3, sine(20.0)}, {31e3, sine(20.0)}},
      {{400e3, sine(20.0)}, {402e3, sine(20.0)}}};
  for (const auto& [made, now] : changes) {
    const double error = ErrorOfOld(made, now);
    const double guess = AirChange(made, now);
    EXPECT_LT(error, 2.0 * guess + 1e-3) << now.altitude_m << " m, sun " << now.mu_s;
    EXPECT_GT(error, 0.2 * guess) << now.altitude_m << " m, sun " << now.mu_s
                                  << ": tables would be made anew for nothing";
  }
}

TEST(SolvedAirDraft, IsGoodEnoughForAMoment) {
  for (const char* name : {"earth", "hazy"}) {
    const Medium medium = MediumPreset(name);
    const auto full = SolveAir(medium), draft = SolveAir(medium, AirSolution::kDraft);
    for (const double mu_s : {1.0, 0.5, 0.1, -0.05}) {
      const Bands<float> exact = full->multiple_scattering.SkyIrradiance(0.0, mu_s);
      const Bands<float> quick = draft->multiple_scattering.SkyIrradiance(0.0, mu_s);
      for (std::size_t band = 0; band < exact.count; ++band)
        EXPECT_NEAR(quick[band] / exact[band], 1.0F, mu_s > 0.0 ? 0.03F : 0.06F)
            << name << ", sun " << mu_s;
    }
  }
}

TEST_F(AirFollowerOnGpu, AMediumThatCannotBeShownIsRefusedAtOnce) {
  AirFollower follower(Earth(), AirQuality::kLow, ViewAt(2.0, 30.0));
  EXPECT_THROW(follower.Replace(MediumPreset("earth", WavelengthSet(8))), InputError);
  Medium broken = MediumPreset("earth");
  broken.mie_scale_height_m = -1.0;
  EXPECT_THROW(follower.Replace(broken), InputError);
}

}  // namespace
}  // namespace alpenglow::viewer
