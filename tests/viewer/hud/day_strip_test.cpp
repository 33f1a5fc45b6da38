// SPDX-License-Identifier: MIT
#include "viewer/hud/panel_controls.h"

#include <gtest/gtest.h>

#include <cmath>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "lut/image/image.h"
#include "lut/sky/sky_view.h"

namespace alpenglow::viewer {
namespace {

/// Air of four bands with all of its light, solved once.
struct Air {
  std::shared_ptr<const SingleScattering<float>> air =
      std::make_shared<SingleScattering<float>>(MediumPreset("earth"));
  std::shared_ptr<const MultipleScattering> multiple_scattering =
      std::make_shared<MultipleScattering>(MediumPreset("earth"));
};
const Air& Earth() {
  static const Air earth;
  return earth;
}

DayStripRequest Alps() {
  DayStripRequest request{Earth().multiple_scattering, PlaceFromDegrees(46.0, 8.0, 500.0), {}, 24};
  request.begin = ParseInstant("2026-03-19T23:28:00Z");  // midnight of the mean sun
  return request;
}

TEST(DayStrip, NoonIsBlueMidnightBlackAndDuskRedBelow) {
  const DayStrip strip = MakeDayStrip(Alps());
  const auto& noon = strip.at(11, 0);
  EXPECT_GT(noon[2], noon[0]) << "the zenith at noon";
  EXPECT_GT(noon[2], 0.3F);
  for (int row = 0; row < strip.rows; ++row) {
    for (const float channel : strip.at(0, row)) EXPECT_LT(channel, 0.02F) << "midnight";
  }
  const auto& dusk = strip.at(18, strip.rows - 1);  // half past six of solar time, at an equinox
  EXPECT_GT(dusk[0], 1.3F * dusk[2]) << "the horizon under which the sun has gone";
}

// The reference solution: the table of the sky, and a day's exposure from its definition.
TEST(DayStrip, ColoursAreThoseOfTheSky) {
  const DayStripRequest request = Alps();
  const DayStrip strip = MakeDayStrip(request);
  const Medium& medium = Earth().air->medium();
  for (const int column : {7, 12, 18}) {
    const SunPosition sun =
        ApparentSunAt(request.place, AddSeconds(request.begin, 3600.0 * (column + 0.5)));
    const SkyView view(*Earth().air, *request.multiple_scattering, request.place.height_m,
                       std::sin(sun.elevation_rad));
    const double dip =
        std::acos(medium.planet_radius_m / (medium.planet_radius_m + request.place.height_m));
    Image sky(1, strip.rows);
    double mean = 0.0;
    constexpr std::array<double, 6> kElevations_deg{80.0, 50.0, 28.0, 14.0, 6.0, 1.5};
    for (int row = 0; row < strip.rows; ++row) {
      const double elevation = kElevations_deg[static_cast<std::size_t>(row)] * kRadiansPerDegree;
      const Bands<float> seen = view.Radiance(0.5 * kPi - elevation + dip, 0.0);
      std::vector<double> radiance;
      for (std::size_t band = 0; band < seen.count; ++band) {
        radiance.push_back(static_cast<double>(seen[band]) * medium.solar_irradiance[band] /
                           (sun.distance_au * sun.distance_au));
      }
      const auto rgb = BandColour(medium.wavelengths_nm).LinearSrgb(radiance);
      mean += (0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]) / strip.rows;
      sky.at(0, row) = {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]),
                        static_cast<float>(rgb[2])};
    }
    const double ev100 = 0.8 * std::log2(mean * 100.0 / 12.5) + 0.2 * 14.0;
    const DisplayImage developed = Develop(sky, ev100, ToneCurve::kAgx);
    for (int row = 0; row < strip.rows; ++row) {
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t at = static_cast<std::size_t>(row) * 3 + c;
        EXPECT_NEAR(strip.at(column, row)[c], developed.rgb[at] / 255.0, 2.5 / 255.0)
            << "column " << column << " row " << row
            << ": pictures are dithered by up to a code, and rounded; the table has 0.3 %";
      }
    }
  }
}

TEST(DayStrip, AStripIsMadeAnewOnlyForWhatItWouldShow) {
  const DayStripRequest shown = Alps();
  DayStripRequest request = shown;
  request.place.latitude_rad += 0.002;
  request.place.height_m += 50.0;
  request.begin = AddSeconds(request.begin, 1e-5);
  EXPECT_TRUE(LooksTheSame(shown, request)) << "a tenth of a degree is not seen";
  request.begin = AddSeconds(request.begin, 86400.0);
  EXPECT_FALSE(LooksTheSame(shown, request)) << "another day is";
}

}  // namespace
}  // namespace alpenglow::viewer
