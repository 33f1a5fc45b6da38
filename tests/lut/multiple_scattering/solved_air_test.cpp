// SPDX-License-Identifier: MIT
#include "lut/multiple_scattering/solved_air.h"

#include <gtest/gtest.h>

#include "tests/fixtures/solved_media.h"

namespace alpenglow::lut {
namespace {

using tests::Earth;

TEST(SolvedAir, DraftIsAccurateToAFewPercent) {
  for (const char* name : {"earth", "hazy"}) {
    const Medium medium = MediumPreset(name);
    const SolvedAir full(medium), draft(medium, AirSolution::kDraft);
    EXPECT_EQ(full.solution(), AirSolution::kFull);
    EXPECT_EQ(draft.solution(), AirSolution::kDraft);
    for (const double mu_s : {1.0, 0.5, 0.1, -0.05}) {
      const Spectrum exact = full.multiple_scattering().SkyIrradiance(0.0, mu_s);
      const Spectrum quick = draft.multiple_scattering().SkyIrradiance(0.0, mu_s);
      for (std::size_t band = 0; band < exact.size(); ++band)
        EXPECT_NEAR(quick[band] / exact[band], 1.0F, mu_s > 0.0 ? 0.03F : 0.06F)
            << name << ", sun " << mu_s;
    }
  }
}

TEST(SolvedAir, RaysOverAnotherPlaceUseItsSphere) {
  const double pole_rad = 1.5;
  const SolvedAir there = Earth().OnSphereAt(pole_rad);
  EXPECT_EQ(there.medium(), OnOsculatingSphere(Earth().medium(), pole_rad));
  EXPECT_NE(there.medium().planet_radius_m, Earth().medium().planet_radius_m);
  EXPECT_EQ(&there.multiple_scattering(), &Earth().multiple_scattering()) << "it is shared";
  EXPECT_EQ(&there.beam(), &Earth().beam());
}

TEST(SolvedAir, BeamEqualsThatOfRefractedRays) {
  constexpr double kAltitude_m = 500.0, kMu = 0.02;
  const Spectrum straight = Earth().single_scattering().TransmittanceToSpace(kAltitude_m, kMu);
  const Spectrum factor = Earth().beam().OverStraight(kAltitude_m, kMu);
  const Spectrum beam = Earth().BeamLeft(kAltitude_m, kMu);
  for (std::size_t band = 0; band < Earth().bands(); ++band)
    EXPECT_NEAR(beam[band], straight[band] * factor[band], 1e-6F * beam[band]) << "rounding";
}

}  // namespace
}  // namespace alpenglow::lut
