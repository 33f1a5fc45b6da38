// SPDX-License-Identifier: MIT
#include "renderer/picture/picture_layers.h"

#include <gtest/gtest.h>

#include <cmath>

#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/medium.h"
#include "atmosphere/medium/medium_presets.h"
#include "lut/multiple_scattering/multiple_scattering.h"
#include "renderer/illumination/aerial_perspective.h"

namespace alpenglow::renderer {
namespace {

TEST(PictureLayers, EveryLayerHasItsNameChannelsAndOneWayToItsValues) {
  ASSERT_EQ(LayerNames().size(), 13U);
  for (const std::string& name : LayerNames()) {
    const PictureLayer layer = LayerFromName(name);
    const LayerKind& kind = KindOf(layer);
    EXPECT_EQ(kind.layer, layer);
    EXPECT_EQ(NameOf(layer), name);
    EXPECT_NE(kind.of_middle == nullptr, kind.of_rays == nullptr) << name;
    for (const std::string& channel : kind.channels)
      EXPECT_EQ(channel.find(name + "."), 0U) << channel;
    EXPECT_LE(kind.channels.size(), LayerValues{}.size());
  }
  EXPECT_THROW((void)LayersFromNames({"depth", "dept"}), InputError);
}

TEST(PictureLayers, FactorsOfTheReddestLightAreNotNegative) {
  const Medium earth = MediumPreset("earth");
  const BandColour colour(earth.wavelengths_nm);
  Shaded ray;
  ray.radiance = ray.transmittance = ray.albedo = BandLight(colour.wavelengths_nm().size());
  ray.transmittance[ray.transmittance.count - 1] = 0.9F;  // as if through a red filter
  ray.albedo[1] = 0.9F;                                   // or a green one
  PixelSum pixel;
  pixel.Add(ray, true);
  for (const PictureLayer layer : {PictureLayer::kTransmittance, PictureLayer::kAlbedo}) {
    const LayerValues factor = KindOf(layer).of_rays(colour, pixel);
    for (const float value : factor) {
      EXPECT_GE(value, 0.0F) << NameOf(layer);
      EXPECT_LE(value, 1.0F) << NameOf(layer);
    }
  }
  EXPECT_GT(KindOf(PictureLayer::kTransmittance).of_rays(colour, pixel)[0], 0.3F)
      << "red stays what it is";
}

/// The sky of a medium from 100 km up, towards 8.5 degrees below the horizontal and 84 degrees
/// beside the sun, which is 15 degrees down: what ozone leaves in the planet's shadow.
std::vector<double> DeepTwilight(const Medium& medium) {
  const SingleScattering<float> air(medium);
  const MultipleScattering multiple_scattering(medium);
  const double down = -8.5 * kRadiansPerDegree, sun = -15.0 * kRadiansPerDegree;
  const double nu = std::sin(down) * std::sin(sun) +
                    std::cos(down) * std::cos(sun) * std::cos(84.0 * kRadiansPerDegree);
  const AirAlongRay seen = AerialPerspective(air, multiple_scattering)
                               .Along({100e3, std::sin(down), std::sin(sun), nu}, {.sky = 12});
  std::vector<double> radiance;
  for (std::size_t band = 0; band < seen.inscatter.count; ++band) {
    radiance.push_back(static_cast<double>(seen.inscatter[band]) * medium.solar_irradiance[band]);
  }
  return radiance;
}

TEST(PictureLayers, DeepTwilightIsBluerThanSrgbAndHasLightInEveryBand) {
  // A negative channel of a colour is the gamut's, not a rounding: on 16 bands the blue there is
  // (-2.4e-5, 1.4e-3, 8.1e-3) cd/m^2, of radiances that are all positive.
  const Medium fine = *OnBands(MediumPreset("earth"), 16);
  const std::vector<double> radiance = DeepTwilight(fine);
  for (const double band : radiance) EXPECT_GT(band, 0.0);
  const BandColour colour(fine.wavelengths_nm);
  const auto rgb = colour.LinearSrgb(radiance);
  EXPECT_LT(rgb[0], 0.0);
  EXPECT_GT(rgb[0], -0.01 * rgb[2]) << "just outside";
  EXPECT_GT(colour.Xyz(radiance)[1], 0.0) << "its luminance is that of light";
}

TEST(PictureLayers, LightOfOneBandAloneHasLuminance) {
  // More bands are narrower than the eye's; their rows are fitted to spectra of daylight, and some
  // ends of the spectrum weigh a little less than nothing.
  for (const int bands : {3, 4, 5, 6}) {
    const BandColour colour(WavelengthSet(bands));
    for (std::size_t band = 0; band < colour.wavelengths_nm().size(); ++band) {
      std::vector<double> alone(colour.wavelengths_nm().size(), 0.0);
      alone[band] = 1.0;
      EXPECT_GT(colour.Xyz(alone)[1], 0.0) << colour.wavelengths_nm()[band] << " nm of " << bands;
    }
  }
}

}  // namespace
}  // namespace alpenglow::renderer
