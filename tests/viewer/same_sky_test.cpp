// SPDX-License-Identifier: MIT
// One sky by three programs: panoramas of skylut sky, skyseries and skyview over the bare planet, in
// the air of every preset. same_light_test.cpp compares the ways to light inside the libraries.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/medium_presets.h"
#include "lut/image/exr.h"
#include "lut/image/image.h"
#include "lut/image/tone_mapping.h"
#include "tests/fixtures/luminance.h"
#include "tests/fixtures/places.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/temporary_folder.h"
#include "tests/viewer/shaders/headless.h"

namespace alpenglow::viewer {
namespace {

constexpr int kPanoramaWidth = 256, kPanoramaHeight = 128;
constexpr double kSkyLatitude_deg = 46.5, kSkyLongitude_deg = 8.0;
const char* const kSkyInstant = "2026-06-21T18:15:00Z";  // the sun is 9 degrees high

// Returns the directions of pixels over the horizon, north in the middle: east, north, up.
glm::dvec3 ToPixel(int x, int y) {
  const double azimuth = 2.0 * kPi * ((x + 0.5) / kPanoramaWidth - 0.5);
  const double elevation = kPi * (0.5 - (y + 0.5) / kPanoramaHeight);
  return EnuFromAngles(elevation, azimuth).xyz;
}

double LuminanceOfPixel(const HdrImage& image, int x, int y) {
  return tests::Luminance(image.at(x, y));
}

// Returns the root mean square of differences relative to the light of the second picture over the
// horizon, without 14 degrees around the sun: pictures have its disk, the panorama for lighting does
// not, and each smooths the light beside it in its own way.
double SkyDifferenceOf(const HdrImage& image, const HdrImage& expected) {
  const SunInSky sun =
      TrueSunAt({kSkyLatitude_deg, kSkyLongitude_deg, 0.0}, ParseInstant(kSkyInstant));
  const glm::dvec3 to_sun = DirectionOf(sun).seen;
  double squares = 0.0, count = 0.0;
  for (int y = 0; y < kPanoramaHeight / 2 - 1; ++y) {
    for (int x = 0; x < kPanoramaWidth; ++x) {
      if (glm::dot(ToPixel(x, y), to_sun) > std::cos(14.0 * kRadiansPerDegree)) continue;
      const double error = LuminanceOfPixel(image, x, y) / LuminanceOfPixel(expected, x, y) - 1.0;
      squares += error * error;
      ++count;
    }
  }
  return std::sqrt(squares / count);
}

// Sanitizers see one preset.
std::vector<std::string> PresetsToShow() {
  std::vector<std::string> presets = MediumPresetNames();
  presets.resize(tests::ScaledDown<std::size_t>(presets.size(), 1));
  return presets;
}

class PanoramasOfAllPrograms : public TemporaryFolder,
                               public testing::WithParamInterface<std::string> {
 protected:
  [[nodiscard]] HdrImage PictureOf(const std::string& command) const {
    const Outcome outcome = RunCommand(command);
    EXPECT_EQ(outcome.status, 0) << command << "\n" << outcome.error;
    return ReadExr(folder_ / "picture.exr");
  }
};

// Measured: 0.01 to 0.05 % between skylut and skyseries, 0.07 to 0.13 % for skyview, whose pictures
// read tables.
TEST_P(PanoramasOfAllPrograms, ShowTheSameSky) {
  if (!tests::HasOpenGl()) GTEST_SKIP() << "EGL gives no OpenGL here";
  WriteText(folder_ / "s.toml",
            fmt::format("[place]\nlatitude = {}\nlongitude = {}\n[time]\nutc = \"{}\"\n[camera]\n"
                        "height_m = 2\nheading = 0\npitch = 0\nfov = 360\n[terrain]\nnone = true\n"
                        "[atmosphere]\npreset = \"{}\"\n",
                        kSkyLatitude_deg, kSkyLongitude_deg, kSkyInstant, GetParam()));
  const std::string size = fmt::format(" --size {}x{}", kPanoramaWidth, kPanoramaHeight);
  const HdrImage series = PictureOf(
      fmt::format("'{}' s.toml --samples 1 --out picture.exr{}", tests::kSkyseries, size));
  const HdrImage sky = PictureOf(fmt::format(
      "'{}' sky --latitude {} --longitude {} --time {} --atmosphere {} --out picture.exr{}",
      tests::kSkylut, kSkyLatitude_deg, kSkyLongitude_deg, kSkyInstant, GetParam(), size));
  const HdrImage view = PictureOf(
      fmt::format("env -u DISPLAY -u WAYLAND_DISPLAY '{}' s.toml --headless --quality medium "
                  "--screenshot picture.exr{}",
                  tests::kSkyview, size));
  EXPECT_LT(SkyDifferenceOf(sky, series), 1e-3);
  EXPECT_LT(SkyDifferenceOf(view, series), 2.5e-3);
}

std::string NameOfPreset(const testing::TestParamInfo<std::string>& preset) {
  std::string name = preset.param;
  std::erase(name, '-');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Presets, PanoramasOfAllPrograms, testing::ValuesIn(PresetsToShow()),
                         NameOfPreset);

}  // namespace
}  // namespace alpenglow::viewer
