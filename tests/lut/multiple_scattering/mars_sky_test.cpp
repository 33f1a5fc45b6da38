// SPDX-License-Identifier: MIT
// What people see on Mars: a butterscotch sky by day, a blue glow around the setting sun.
#include <gtest/gtest.h>

#include <cmath>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/medium.h"
#include "atmosphere/medium/phase_table.h"
#include "atmosphere/ray/single_scattering.h"
#include "lut/sky/sky_view.h"

namespace alpenglow::lut {
namespace {

class MarsSky : public testing::Test {
 protected:
  // Linear sRGB of the sky, sun included in no pixel.
  // Angles in degrees: elevations, azimuth from the sun.
  std::array<double, 3> Sky(double sun_deg, double elevation_deg, double azimuth_deg) const {
    const SkyView view(air_, multiple_scattering_, 2.0, std::sin(sun_deg * kRadiansPerDegree));
    const Bands<float> sky =
        view.Radiance((90.0 - elevation_deg) * kRadiansPerDegree, azimuth_deg * kRadiansPerDegree);
    std::vector<double> radiance;
    for (std::size_t band = 0; band < sky.count; ++band) {
      radiance.push_back(static_cast<double>(sky[band]) * medium_.solar_irradiance[band]);
    }
    return BandColour(medium_.wavelengths_nm).LinearSrgb(radiance);
  }
  static double BlueOverRed(const std::array<double, 3>& colour) { return colour[2] / colour[0]; }

  // Solved once for all tests.
  inline static const Medium medium_ = MediumPreset("mars");
  inline static const SingleScattering<float> air_{medium_};
  inline static const MultipleScattering multiple_scattering_{medium_};
};

TEST_F(MarsSky, DustHasAPhaseFunctionAtEveryWavelength) {
  const Medium mars = MediumPreset("mars", {440.0, 550.0, 670.0});
  ASSERT_EQ(mars.mie_phase.size(), 3U);
  EXPECT_GT(Phase(mars.mie_phase[0], 1.0), 2.0 * Phase(mars.mie_phase[2], 1.0))
      << "the peak of diffraction is narrower and higher in the blue";
  EXPECT_LT(Phase(mars.mie_phase[0], 0.5), Phase(mars.mie_phase[2], 0.5));
  for (const PhaseFunction& phase : mars.mie_phase) {
    EXPECT_NEAR(phase.table->integral(), 1.0, 2e-3) << "normalised where it was made";
    EXPECT_NEAR(MeanCosine(phase), 0.68, 0.09) << "retrievals lie between 0.6 and 0.8";
  }
}

TEST_F(MarsSky, SkyByDayIsButterscotch) {
  for (const double azimuth : {60.0, 120.0, 180.0}) {
    const auto colour = Sky(50.0, 30.0, azimuth);
    EXPECT_GT(colour[0], colour[1]) << "azimuth " << azimuth;
    EXPECT_GT(colour[1], colour[2]) << "azimuth " << azimuth;
    EXPECT_GT(colour[0], 1.3 * colour[2]) << "azimuth " << azimuth;
  }
}

TEST_F(MarsSky, TheSettingSunStandsInABlueGlow) {
  const double near = BlueOverRed(Sky(3.0, 5.0, 0.0));
  const double aside = BlueOverRed(Sky(3.0, 5.0, 40.0));
  const double opposite = BlueOverRed(Sky(3.0, 5.0, 180.0));
  EXPECT_GT(near, 1.0) << "blue outshines red two degrees from the sun";
  EXPECT_GT(near, 2.0 * aside);
  EXPECT_GT(near, 2.0 * opposite);
}

TEST_F(MarsSky, TheGlowIsBrighterThanTheSkyAside) {
  EXPECT_GT(Sky(3.0, 5.0, 0.0)[2], 10.0 * Sky(3.0, 5.0, 40.0)[2]);
}

}  // namespace
}  // namespace alpenglow::lut
