// SPDX-License-Identifier: MIT
// Mountains seen along bent rays: in pictures, against the ray equation.
#include <gtest/gtest.h>

#include <cmath>

#include "renderer/picture/render.h"
#include "tests/fixtures/far_peak.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::renderer {
namespace {

using tests::ElevationByEquation;
using tests::FarPeak;
using tests::SceneOf;

constexpr double kMinute = kRadiansPerDegree / 60.0;
const UtcInstant kNoon = ParseInstant("2026-06-21T11:30:00Z");

using RefractedTerrain = TemporaryFolder;

TEST_F(RefractedTerrain, APeakBehindTheGeometricHorizonStandsWhereTheRayEquationHasIt) {
  const Medium medium =
      OnOsculatingSphere(MediumPreset("earth"), BareScene(0.0, 0.0, 0.0, 1.0).place.latitude_rad);
  const double radius_m = medium.planet_radius_m;
  for (const FarPeak& peak :
       {FarPeak{20.0, 110e3, 650.0}, FarPeak{20.0, 150e3, 1350.0}, FarPeak{3000.0, 300e3, 800.0}}) {
    const double horizon_m = radius_m * std::acos(radius_m / (radius_m + peak.eye_m));
    const double hides_m = radius_m / std::cos((peak.distance_m - horizon_m) / radius_m) - radius_m;
    ASSERT_GT(hides_m, peak.height_m) << "by straight rays it is hidden";
    const double expected = ElevationByEquation(medium, peak);
    const Scene scene = SceneOf(peak, expected / kRadiansPerDegree, 0.1, radius_m, folder_);
    const SceneRenderer renderer(scene);
    RenderSettings settings{.width = 60,
                            .height = 120,
                            .samples_per_pixel = 1,
                            .air_nodes = 4,
                            .effects = EffectSet::All(),
                            .layers = {PictureLayer::kDepth}};
    const CameraRays camera(scene.camera, settings.width, settings.height);
    const auto far_pixels = [&](const Image& image) {
      std::vector<int> rows;
      for (int y = 0; y < settings.height; ++y) {
        const double depth_m =
            static_cast<double>(image.layers[0].values[static_cast<std::size_t>(y) * 60 + 30]);
        if (std::isfinite(depth_m) && depth_m > 0.9 * peak.distance_m) rows.push_back(y);
      }
      return rows;
    };
    const auto rows = far_pixels(renderer.Render(kNoon, settings));
    ASSERT_FALSE(rows.empty()) << "refraction shows it: " << peak.distance_m << " m";
    const double top = std::asin(camera.Direction(30.5, rows.front()).z);
    EXPECT_NEAR(top / kMinute, expected / kMinute, 0.15)
        << "0.1' of RefractedPath, and half a pixel";
    settings.effects = settings.effects.Without(Effect::kRefraction);
    EXPECT_TRUE(far_pixels(renderer.Render(kNoon, settings)).empty());
  }
}

TEST_F(RefractedTerrain, PicturesInWhichItMovesLessThanHalfAPixelAreThoseOfStraightRays) {
  const FarPeak peak{20.0, 40e3, 1500.0};  // lifted by 1.2'
  const double radius_m = MediumPreset("earth").planet_radius_m;
  const SceneRenderer renderer(SceneOf(peak, 1.0, 6.0, radius_m, folder_));
  RenderSettings settings{
      .width = 64, .height = 36, .samples_per_pixel = 1, .air_nodes = 4, .layers = {}};
  const Image bent = renderer.Render(kNoon, settings);
  settings.effects = settings.effects.Without(Effect::kRefraction);
  EXPECT_EQ(bent.rgb, renderer.Render(kNoon, settings).rgb) << "pixels of 5.6'";
}

}  // namespace
}  // namespace alpenglow::renderer
