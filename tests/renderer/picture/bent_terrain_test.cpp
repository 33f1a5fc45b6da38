// SPDX-License-Identifier: MIT
// Mountains seen along bent rays: in pictures, against the ray equation.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "atmosphere/judge/ray_equation.h"
#include "atmosphere/ray/bent_view.h"
#include "renderer/picture/render.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow {
namespace {

constexpr double kMinute = kRadiansPerDegree / 60.0;
const UtcInstant kNoon = ParseInstant("2026-06-21T11:30:00Z");

struct Peak {
  double eye_m, distance_m, height_m;  // the distance along the ground
};

class BentTerrain : public TemporaryFolder {
 protected:
  /// A wall across the view to the north, four kilometres wide; in ENU metres.
  Scene SceneOf(const Peak& peak, double pitch_deg, double fov_deg, double radius_m) const {
    const std::filesystem::path file = folder_ / "peak.obj";
    const double angle = peak.distance_m / radius_m;
    std::ofstream obj(file);
    obj.precision(12);
    for (const double height_m : {-500.0, peak.height_m}) {
      for (const double x : {-2000.0, 2000.0})
        obj << "v " << x << ' ' << (radius_m + height_m) * std::sin(angle) << ' '
            << height_m * std::cos(angle) - 2.0 * radius_m * std::pow(std::sin(0.5 * angle), 2)
            << '\n';
    }
    obj << "f 1 2 3\nf 2 4 3\n";
    obj.close();
    Scene scene = BareScene(peak.eye_m, 0.0, pitch_deg, fov_deg);
    scene.terrain = {TerrainSource::Kind::kMesh, file, VoidPolicy::kFill};
    return scene;
  }
};

/// The elevation [rad] under which the ray equation shows the peak's top.
double ElevationByEquation(const Medium& medium, const Peak& peak) {
  const judge::RayEquation equation(medium, judge::PeckAndReeder(kHorizonWavelength_nm));
  const double angle = peak.distance_m / medium.planet_radius_m;
  const auto passes_over = [&](double elevation) {
    double length_m = peak.distance_m;
    auto end = equation.Follow(elevation, peak.eye_m, length_m);
    for (int i = 0; i < 3 && !end.is_ground; ++i) {
      length_m *= angle / end.angle_rad;
      end = equation.Follow(elevation, peak.eye_m, length_m);
    }
    return !end.is_ground &&
           std::hypot(end.state.x, end.state.y) - medium.planet_radius_m > peak.height_m;
  };
  double low = -0.1, high = 0.1;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (passes_over(middle) ? high : low) = middle;
  }
  return high;
}

TEST_F(BentTerrain, APeakBehindTheGeometricHorizonStandsWhereTheRayEquationHasIt) {
  const Medium medium =
      OnOsculatingSphere(MediumPreset("earth"), BareScene(0.0, 0.0, 0.0, 1.0).place.latitude_rad);
  const double radius_m = medium.planet_radius_m;
  for (const Peak& peak :
       {Peak{20.0, 110e3, 650.0}, Peak{20.0, 150e3, 1350.0}, Peak{3000.0, 300e3, 800.0}}) {
    const double horizon_m = radius_m * std::acos(radius_m / (radius_m + peak.eye_m));
    const double hides_m = radius_m / std::cos((peak.distance_m - horizon_m) / radius_m) - radius_m;
    ASSERT_GT(hides_m, peak.height_m) << "by straight rays it is hidden";
    const double expected = ElevationByEquation(medium, peak);
    const Scene scene = SceneOf(peak, expected / kRadiansPerDegree, 0.1, radius_m);
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
    EXPECT_NEAR(top / kMinute, expected / kMinute, 0.15) << "0.1' of BentPath, and half a pixel";
    settings.effects = settings.effects.Without(Effect::kRefraction);
    EXPECT_TRUE(far_pixels(renderer.Render(kNoon, settings)).empty());
  }
}

TEST_F(BentTerrain, PicturesInWhichItMovesLessThanHalfAPixelAreThoseOfStraightRays) {
  const Peak peak{20.0, 40e3, 1500.0};  // lifted by 1.2'
  const double radius_m = MediumPreset("earth").planet_radius_m;
  const SceneRenderer renderer(SceneOf(peak, 1.0, 6.0, radius_m));
  RenderSettings settings{
      .width = 64, .height = 36, .samples_per_pixel = 1, .air_nodes = 4, .layers = {}};
  const Image bent = renderer.Render(kNoon, settings);
  settings.effects = settings.effects.Without(Effect::kRefraction);
  EXPECT_EQ(bent.rgb, renderer.Render(kNoon, settings).rgb) << "pixels of 5.6'";
}

}  // namespace
}  // namespace alpenglow
