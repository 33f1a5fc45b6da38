// SPDX-License-Identifier: MIT
#include "lut/sky/panorama.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "tests/fixtures/luminance.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/sky_view_errors.h"
#include "tests/fixtures/solved_media.h"
#include "tests/fixtures/thread_counts.h"

namespace alpenglow::lut {
namespace {

constexpr double kAzimuths_deg[] = {0.0, 40.0, 200.0, 275.0};

using tests::Earth;
using tests::Luminance;

HdrImage Panorama(const PanoramaOptions& options) {
  return RenderPanorama(Earth().single_scattering(), Earth().multiple_scattering(), options);
}

PanoramaOptions SunAtDegrees(double elevation, double azimuth) {
  PanoramaOptions options;
  options.width = 256;
  options.height = 128;
  options.sun.elevation_deg = elevation;
  options.sun.azimuth_deg = azimuth;
  return options;
}

struct Pixel {
  int x, y;
};
Pixel Brightest(const HdrImage& image) {
  Pixel best{0, 0};
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (Luminance(image.at(x, y)) > Luminance(image.at(best.x, best.y))) best = {x, y};
    }
  }
  return best;
}

// Returns the horizontal texture coordinate at which each program looks up a direction of its own
// axes, by the published formulas of these programs.
double LookedUpAt(PanoramaCentre centre, double x, double y, double z) {
  const auto turn = [](double angle) { return angle / (2.0 * kPi); };
  switch (centre) {
    case PanoramaCentre::kNorth:  // x east, y north, z up: the middle is north, right is east
      return 0.5 + turn(std::atan2(x, y));
    case PanoramaCentre::kBlender:  // Cycles, direction_to_equirectangular
      return 0.5 - turn(std::atan2(y, x));
    case PanoramaCentre::kOpenExr:  // ImfEnvmap.h: longitude 0 is +z, 90 degrees +x
      return 0.5 - turn(std::atan2(x, z));
    case PanoramaCentre::kThreeJs:  // equirectUv
      return 0.5 + turn(std::atan2(z, x));
    case PanoramaCentre::kUnity:  // ToRadialCoords: 0.5 - atan2(z, x) / 2 pi
      return 0.5 - turn(std::atan2(z, x));
    case PanoramaCentre::kGodot:  // sky shader: atan(x, -z)
      return turn(std::atan2(x, -z));
  }
  return -1.0;
}

// Returns the column of a direction in the axes of a program. East is +x everywhere.
double ColumnOf(PanoramaCentre centre, double elevation_rad, double azimuth_rad, int width) {
  const auto enu = EnuFromAngles(elevation_rad, azimuth_rad).xyz;
  const double east = enu.x, north = enu.y, up = enu.z;
  double u = 0.0;
  switch (centre) {
    case PanoramaCentre::kNorth:
    case PanoramaCentre::kBlender:
      u = LookedUpAt(centre, east, north, up);
      break;
    case PanoramaCentre::kUnity:
      u = LookedUpAt(centre, east, up, north);
      break;
    default:
      u = LookedUpAt(centre, east, up, -north);
  }
  return (u - std::floor(u)) * width;
}

bool ShowsTheSunAt(const HdrImage& image, double column, double row) {
  const Pixel sun = Brightest(image);
  const double across = std::remainder(sun.x + 0.5 - column, static_cast<double>(image.width));
  return std::abs(across) <= 1.0 && std::abs(sun.y + 0.5 - row) <= 1.0;
}

class Orientation : public testing::TestWithParam<PanoramaCentre> {};

TEST_P(Orientation, TheSunIsFoundAndNotMirrored) {
  for (const double azimuth_deg : kAzimuths_deg) {
    PanoramaOptions options = SunAtDegrees(35.0, azimuth_deg);
    options.centre = GetParam();
    options.draws_sun = true;
    HdrImage image = Panorama(options);
    const double column =
        ColumnOf(GetParam(), options.sun.elevation_rad(), options.sun.azimuth_rad(), options.width);
    const double row = (90.0 - 35.0) / 180.0 * options.height;
    EXPECT_TRUE(ShowsTheSunAt(image, column, row)) << NameOf(GetParam()) << " " << azimuth_deg;
    for (int y = 0; y < image.height; ++y) {
      std::reverse(&image.at(0, y), &image.at(image.width - 1, y) + 1);
    }
    const double mirrored = options.width - column;
    const bool symmetric =
        std::abs(std::remainder(mirrored - column, static_cast<double>(options.width))) < 3.0;
    if (!symmetric) {
      EXPECT_FALSE(ShowsTheSunAt(image, column, row)) << "a mirrored picture must not pass";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(EveryProgram, Orientation,
                         testing::Values(PanoramaCentre::kNorth, PanoramaCentre::kBlender,
                                         PanoramaCentre::kOpenExr, PanoramaCentre::kThreeJs,
                                         PanoramaCentre::kUnity, PanoramaCentre::kGodot),
                         [](const auto& tested) { return NameOf(tested.param); });

TEST(Panorama, NamesOfOrientationsSurviveARoundTrip) {
  for (const char* name : {"north", "blender", "openexr", "three", "unity", "godot"})
    EXPECT_EQ(NameOf(PanoramaCentreFromName(name)), name);
  EXPECT_EQ(PanoramaCentreFromName("geographic"), PanoramaCentre::kNorth);
  EXPECT_THROW((void)PanoramaCentreFromName("maya"), InputError);
}

// Returns the cosine-weighted integral over the pixels of a half of the sphere: illuminance [lx].
double IlluminanceFromAbove(const HdrImage& image) {
  double sum = 0.0;
  for (int y = 0; y < image.height / 2; ++y) {
    const double top = std::cos(kPi * y / image.height);
    const double bottom = std::cos(kPi * (y + 1.0) / image.height);
    for (int x = 0; x < image.width; ++x) {
      sum += Luminance(image.at(x, y)) * kPi * (top * top - bottom * bottom) / image.width;
    }
  }
  return sum;
}

/// Returns the luminance [cd/m^2] of light of the earth that is given relative to the sun's.
template <typename Real>
double LuminanceOf(const SpectrumOf<Real>& relative) {
  static const BandColour colour(Earth().medium().wavelengths_nm);
  std::vector<double> light;
  for (std::size_t band = 0; band < relative.size(); ++band)
    light.push_back(double{relative[band]} * Earth().medium().solar_irradiance[band]);
  return colour.Xyz(light)[1];
}

TEST(Panorama, IlluminanceOfAHorizontalPlaneIsThatOfTheSky) {
  for (const double elevation_deg : {50.0, 10.0, 0.0, -5.0, -9.0}) {
    const HdrImage image = Panorama(SunAtDegrees(elevation_deg, 120.0));
    const double expected = LuminanceOf(Earth().multiple_scattering().SkyIrradiance(
        2.0, std::sin(elevation_deg * kRadiansPerDegree)));
    EXPECT_NEAR(IlluminanceFromAbove(image), expected, 0.02 * expected)
        << "sun at " << elevation_deg << ": the pixels of the aureole are 1.4 degrees wide, and "
        << "the table of irradiance is interpolated between its nodes";
  }
}

TEST(Panorama, PixelsEqualTheLightOfTheirDirections) {
  const DirectSky direct(Earth().medium(), Earth().multiple_scattering());
  for (const double altitude_m : {2.0, 10e3, 400e3}) {
    for (const double elevation_deg : {60.0, 10.0, 1.0, -4.0, -10.0}) {
      PanoramaOptions options = SunAtDegrees(elevation_deg, 10.0);
      options.altitude_m = altitude_m;
      const HdrImage image = Panorama(options);
      const double mu_s = std::sin(options.sun.elevation_rad());
      double brightest = 0.0;
      for (const auto& pixel : image.rgb) brightest = std::max(brightest, Luminance(pixel));
      double squares = 0.0;
      constexpr int kPixels = tests::ScaledDown(50, 20);
      for (int i = 1; i <= kPixels; ++i) {
        const int x = static_cast<int>(Halton(i, 2) * options.width);
        const int y = static_cast<int>(Halton(i, 3) * options.height);
        const double zenith = kPi * (y + 0.5) / options.height;
        const double from_sun =
            2.0 * kPi * ((x + 0.5) / options.width - 0.5) - options.sun.azimuth_rad();
        const double exact =
            LuminanceOf(direct.Radiance(SkyRay(altitude_m, zenith, mu_s, from_sun)));
        const double error =
            (Luminance(image.at(x, y)) - exact) / std::max(exact, 1e-4 * brightest);
        squares += error * error;
      }
      EXPECT_LT(std::sqrt(squares / kPixels), elevation_deg >= 10.0 ? 0.001 : 0.003)
          << altitude_m << " m, sun at " << elevation_deg;
    }
  }
}

TEST(Panorama, LayersOfPolarisationDoNotChangeThePicture) {
  PanoramaOptions options = SunAtDegrees(10.0, 0.0);
  options.width = 64;
  options.height = 32;
  const HdrImage bare = Panorama(options);
  options.layers = {"polarisation", "stokes_q", "stokes_u"};
  const HdrImage image = Panorama(options);
  EXPECT_EQ(image.rgb, bare.rgb) << "to the last bit";
  ASSERT_EQ(image.layers.size(), 8U);
  EXPECT_EQ(image.layers[1].name, "polarisation.angle");
  EXPECT_EQ(image.layers[2].name, "stokes_q.R");
  EXPECT_FALSE(FaultyValue(image).has_value());
  const auto at = [&](std::size_t layer, std::size_t x, std::size_t y) {
    return image.layers[layer].values[y * 64 + x];
  };
  const auto luminance = [&](std::size_t layer, std::size_t x, std::size_t y) {
    return Luminance({at(layer, x, y), at(layer + 1, x, y), at(layer + 2, x, y)});
  };
  // The sun is in the middle. East of it light vibrates from the lower left to the upper right, the
  // sun being up and to the left, west of it as in a mirror; level where the sun is below.
  for (const auto& [x, y, angle] :
       {std::tuple{48U, 14U, 10.0F}, std::tuple{15U, 14U, -10.0F}, std::tuple{31U, 1U, 90.0F}}) {
    const double whole = Luminance(image.at(static_cast<int>(x), static_cast<int>(y)));
    const double q = luminance(2, x, y), u = luminance(5, x, y);
    EXPECT_NEAR(at(0, x, y), std::hypot(q, u) / whole, 1e-5);
    EXPECT_GT(at(0, x, y), 0.4) << "far from the sun";
    const double off = std::remainder(static_cast<double>(at(1, x, y) - angle), 180.0);
    EXPECT_NEAR(off, 0.0, 5.0) << "across the plane of the sun, but for pixels of 6 degrees";
  }
}

// Hard case 32.
TEST(Panorama, TheSunsDiskHasAllItsLight) {
  for (const auto& [width, height] : {std::pair{16, 8}, std::pair{256, 128}, std::pair{900, 450}}) {
    PanoramaOptions options = SunAtDegrees(41.0, 77.0);
    options.width = width;
    options.height = height;
    const HdrImage without = Panorama(options);
    options.draws_sun = true;
    const HdrImage with = Panorama(options);
    double light = 0.0;
    for (int y = 0; y < height; ++y) {
      const double solid_angle =
          2.0 * kPi / width * (std::cos(kPi * y / height) - std::cos(kPi * (y + 1.0) / height));
      for (int x = 0; x < width; ++x) {
        light += solid_angle * (Luminance(with.at(x, y)) - Luminance(without.at(x, y)));
      }
    }
    const double expected = LuminanceOf(
        Earth().single_scattering().TransmittanceToSpace(2.0, std::sin(41.0 * kRadiansPerDegree)));
    EXPECT_NEAR(light, expected, 2e-3 * expected) << "the air's transmittance over half a degree";
  }
}

TEST(Panorama, ASunBelowTheHorizonHasNoDisk) {
  PanoramaOptions options = SunAtDegrees(-2.0, 30.0);
  const HdrImage without = Panorama(options);
  options.draws_sun = true;
  EXPECT_EQ(Panorama(options).rgb, without.rgb);
}

TEST(Panorama, CompassAgreesWithSunsAtTheQuarters) {
  PanoramaOptions options = SunAtDegrees(5.0, 45.0);
  options.width = 720;
  options.height = 360;
  const HdrImage plain = Panorama(options);
  options.draws_compass = true;
  const HdrImage painted = Panorama(options);
  // Columns in which ink stands on the horizontal row of a letter's foot or head; azimuth 0 is the
  // middle of the picture, 2 pixels are a degree.
  const auto ink = [&](double azimuth_deg, double across_deg, double up_deg) {
    const int x = static_cast<int>(360.0 + 2.0 * (azimuth_deg + across_deg) + 720.0) % 720;
    const int y = static_cast<int>(180.0 - 2.0 * up_deg);
    return painted.at(x, y) != plain.at(x, y);
  };
  for (const double azimuth : {0.0, 90.0, 180.0, 270.0}) {
    EXPECT_TRUE(ink(azimuth, 0.0, azimuth == 0.0 || azimuth == 270.0 ? 0.0 : 4.0)) << azimuth;
    EXPECT_FALSE(ink(azimuth, 7.0, 0.0)) << azimuth;
  }
  // E has its stem on the left, N has stems on both sides, S none at the left foot.
  EXPECT_TRUE(ink(90.0, -4.0, 2.0));
  EXPECT_FALSE(ink(90.0, 4.0, 2.0));
  EXPECT_TRUE(ink(0.0, 4.0, 2.0) && ink(0.0, -4.0, 2.0));
  EXPECT_FALSE(ink(180.0, -4.0, -2.0));
}

// Hard case 43.
TEST(Panorama, IsTheSameForAnyNumberOfThreads) {
  static_cast<void>(
      tests::SameForAnyNumberOfThreads([] { return Panorama(SunAtDegrees(3.0, 30.0)); }));
}

// Hard case 44.
TEST(Panorama, OnePixelIsAllowed) {
  PanoramaOptions options = SunAtDegrees(30.0, 0.0);
  options.width = options.height = 1;
  EXPECT_GT(Luminance(Panorama(options).at(0, 0)), 0.0);
}

}  // namespace
}  // namespace alpenglow::lut
