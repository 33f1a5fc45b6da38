// SPDX-License-Identifier: MIT
#include "renderer/lit_clouds/layered_air.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>

#include "atmosphere/math/constants.h"
#include "renderer/layers/layer_beam.h"
#include "renderer/layers/layer_stack.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/solved_media.h"

namespace alpenglow::renderer {
namespace {

constexpr AltitudeRange kCloudRange_m{1000.0, 1400.0};
constexpr double kMuS = 0.6;

LayeredCloud CloudOf(double optical_depth) {
  return {kCloudRange_m, GreyLayer(tests::LobeOf(0.8), optical_depth, 1.0)};
}

/// Returns a sun whose beam meets no ozone.
LayeredSun SunWithoutOzone(std::size_t bands) {
  return {kMuS, std::vector<double>(bands, kMuS), std::vector<double>(bands, 0.0)};
}

/// Returns the medium with aerosol that absorbs nothing over ground of an albedo.
Medium White(Medium medium, double ground_albedo) {
  medium.mie_extinction_per_m = medium.mie_scattering_per_m;
  std::ranges::fill(medium.ground_albedo, ground_albedo);
  return medium;
}

TEST(LayeredAir, CloudsWithoutDepthChangeNothing) {
  const Medium& medium = tests::ThreeBandAir().medium();
  const std::size_t bands = medium.wavelengths_nm.size();
  const LayeredAir air(medium, {CloudOf(0.0)}, SunWithoutOzone(bands));
  for (const double altitude_m : {0.0, 1200.0, 5000.0}) {
    const LayeredAir::Change change = air.ChangeAt(altitude_m);
    for (std::size_t band = 0; band < bands; ++band) {
      EXPECT_NEAR(change.down[band], 0.0F, 1e-6F) << "rounding";
      EXPECT_NEAR(change.up[band], 0.0F, 1e-6F);
    }
  }
  const Spectrum factor = air.FactorTowards({0.0, 1000.0}, {-0.5, 1.0});
  for (const float band : factor.values()) EXPECT_NEAR(band, 1.0F, 1e-5F);
}

// Over white ground all light leaves at the top, with and without clouds.
TEST(LayeredAir, ConservesLightWithoutAbsorption) {
  const Medium medium = White(tests::ThreeBandAir().medium(), 1.0);
  const std::size_t bands = medium.wavelengths_nm.size();
  const LayeredAir air(medium, {CloudOf(5.0)}, SunWithoutOzone(bands));
  const LayeredAir::Change top = air.ChangeAt(medium.atmosphere_height_m);
  const LayeredAir::Change above = air.ChangeAt(kCloudRange_m.high_m);
  for (std::size_t band = 0; band < bands; ++band) {
    EXPECT_NEAR(top.up[band], 0.0F, 1e-5F);
    EXPECT_GT(air.ChangeAt(0.0).down[band], 0.1F) << "light of the beam is diffuse below the deck";
    EXPECT_NEAR(above.up[band], above.down[band], 1e-5F) << "the beam above is the same";
  }
}

// The layer alone, over the same ground.
TEST(LayeredAir, InAVacuumTheLightIsThatOfTheLayer) {
  Medium medium = tests::WithoutAir(tests::ThreeBandAir().medium());
  std::ranges::fill(medium.ground_albedo, 0.3);
  const std::size_t bands = medium.wavelengths_nm.size();
  const LayeredCloud cloud = CloudOf(5.0);
  const LayeredAir air(medium, {cloud}, SunWithoutOzone(bands));
  const LayerStack stack({cloud.optics}, 0.3, kLayerStreams);
  const LayerField light = LayerField::UnderSun(stack, kMuS);
  const LayerFluxes below = light.Fluxes(5.0), above = light.Fluxes(0.0);
  const double up_from_clear_ground = 0.3 * kMuS;
  for (std::size_t band = 0; band < bands; ++band) {
    EXPECT_NEAR(static_cast<double>(air.ChangeAt(0.0).down[band]), below.down, 1e-6);
    EXPECT_NEAR(static_cast<double>(air.ChangeAt(0.0).up[band]), below.up - up_from_clear_ground,
                1e-6);
    EXPECT_NEAR(static_cast<double>(air.ChangeAt(2000.0).up[band]), above.up - up_from_clear_ground,
                1e-6);
  }
}

// A stretch through several layers of air has a mean of theirs.
TEST(LayeredAir, LongStretchesHaveTheMeanOfTheirParts) {
  const Medium& medium = tests::ThreeBandAir().medium();
  const LayeredAir air(medium, {CloudOf(8.0)}, SunOverLayers(tests::ThreeBandAir(), kMuS));
  const LightWay way{-0.3, 2.0};
  const Spectrum low = air.FactorTowards({0.0, 300.0}, way);
  const Spectrum high = air.FactorTowards({700.0, 1000.0}, way);
  const Spectrum whole = air.FactorTowards({0.0, 1000.0}, way);
  for (std::size_t band = 0; band < whole.size(); ++band) {
    EXPECT_GE(whole[band], std::min(low[band], high[band]) - 1e-6F);
    EXPECT_LE(whole[band], std::max(low[band], high[band]) + 1e-6F);
  }
}

// The air mass of a low sun is that of the round planet (38 at the horizon).
TEST(LayeredAir, TheSunOverLayersHasTheAirMassOfARoundPlanet) {
  const SolvedAir& air = tests::ThreeBandAir();
  const LayeredSun high = SunOverLayers(air, 0.8), low = SunOverLayers(air, 1e-3);
  for (std::size_t band = 0; band < high.cosine_of_air.size(); ++band) {
    EXPECT_NEAR(high.cosine_of_air[band], 0.8, 0.002);
    EXPECT_GT(low.cosine_of_air[band], 1.0 / 80.0) << "haze is lower than molecules";
    EXPECT_LT(low.cosine_of_air[band], 1.0 / 25.0);
  }
}

}  // namespace
}  // namespace alpenglow::renderer
