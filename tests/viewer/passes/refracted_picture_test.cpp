// SPDX-License-Identifier: MIT
// Refraction in pictures of the graphics card, and the rows of a picture that hold the planet.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/math/constants.h"
#include "atmosphere/ray/shell.h"
#include "atmosphere/refraction/refracted_view.h"
#include "lut/image/tone_mapping.h"
#include "renderer/picture/render.h"
#include "renderer/scene/scene_options.h"
#include "renderer/surface/scene_ground.h"
#include "tests/fixtures/far_peak.h"
#include "tests/fixtures/temporary_folder.h"
#include "tests/viewer/air/shared_air.h"
#include "tests/viewer/shaders/gpu_values.h"
#include "tests/viewer/shaders/headless.h"
#include "viewer/passes/painted_view.h"
#include "viewer/passes/refracted_disk.h"
#include "viewer/passes/sky_painter.h"
#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {
namespace {

constexpr double kArcMinute = kRadiansPerDegree / 60.0;

PaintedView ViewFrom(const Scene& scene, const UtcTime& now, int width, int height) {
  CameraPose eye{scene.place, scene.camera.heading_rad, scene.camera.pitch_rad, 0.0,
                 scene.camera.fov_rad};
  eye.place.height_m = scene.camera.height.value_m;
  return {eye, now, width, height};
}

HdrImage Painted(const Scene& scene, const PaintedView& view) {
  SkyPainter painter(scene, LandSourceOf(scene), view, SizesOf(Quality::kLow),
                     tests::SharedAirOf(scene));
  painter.WaitUntilReady(view);
  painter.Paint(view);
  return painter.picture().Read();
}

using RefractionOnGpu = tests::Headless;

TEST_F(RefractionOnGpu, LandIsDisplacedAsByTheReferenceFormula) {
  const double eye_m = 3000.0;
  const LandBend bend = LandBendOf(GentleAirOf(MediumPreset("earth")), eye_m);
  const auto vec4_of = [](double x, double y, double z, double w) {
    return fmt::format("vec4({:.9e}, {:.9e}, {:.9e}, {:.9e})", x, y, z, w);
  };
  const auto& slope = bend.slope_per_km;
  const auto& fall = bend.fall_per_km;
  std::vector<ShaderPiece> pieces = SharedTexts();
  pieces.push_back(
      {"view",
       "const vec4 bend = " + vec4_of(bend.look_radius_km, bend.top_km, bend.usual_per_km, 0.0) +
           ";\nconst vec4 bend_slopes = " + vec4_of(slope[0], slope[1], slope[2], 0.0) +
           ";\nconst vec4 bend_falls = " + vec4_of(fall[0], fall[1], fall[2], 0.0) +
           fmt::format(";\n#define EYE_ALTITUDE {:.9e}\n#define PLANET_RADIUS {:.9e}\n",
                       eye_m / 1000.0, bend.radius_km) +
           "#define LOOK_RADIUS bend.x\n#define BEND_TOP bend.y\n"
           "#define BEND_USUAL bend.z\n"});
  pieces.push_back(ViewerPiece("viewer/shaders/view/refracted_rays.glsl"));
  std::vector<tests::Arguments<float>> places;
  for (const float away_m : {5e3F, 50e3F, 100e3F, 200e3F})
    for (const float rise_m : {-5000.0F, -3000.0F, 500.0F}) places.push_back({away_m, rise_m});
  const auto seen = tests::EvaluateOnGpu(pieces, "SeenAt(vec3(0.0, a[0], a[1])).z", places);
  const auto back = tests::EvaluateOnGpu(
      pieces, "PlaceSeen(normalize(SeenAt(vec3(0.0, a[0], a[1]))), length(vec2(a[0], a[1]))).z",
      places);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto [away_m, rise_m] = std::pair{double{places[i][0]}, double{places[i][1]}};
    const double distance_m = std::hypot(away_m, rise_m);
    const double radius_m = 1000.0 * bend.radius_km;
    const double place_m = std::hypot(away_m, radius_m + eye_m + rise_m) - radius_m;
    const double lift = LiftOfLand(bend, eye_m, place_m, distance_m);
    EXPECT_NEAR(
        (std::asin(double{seen[i]} / distance_m) - std::asin(rise_m / distance_m)) / kArcMinute,
        lift / kArcMinute, 0.02)
        << "float has altitudes to a metre; " << away_m << " m away, " << rise_m << " m up";
    EXPECT_NEAR(double{back[i]}, rise_m, 0.03 * lift * distance_m + 0.1)
        << "the height of what is seen, to 3 % of the lift";
  }
}

TEST(RefractedDisk, InterpolatedNodesAgreeWithTheRays) {
  const Medium medium = MediumPreset("earth");
  constexpr double kRadius = 16.0 * kArcMinute;
  for (const double height_m : {2.0, 10e3}) {
    const RefractedView rays(medium, height_m);
    const double middle = rays.horizon_rad() + 18.0 * kArcMinute;
    const RefractedDisk disk = RefractedDiskOf(medium, height_m, middle, kRadius);
    for (double beside = -16.0; beside <= 16.0; beside += 1.7) {
      const double elevation = middle + beside * kArcMinute;
      const double at = (elevation - disk.first_rad) / disk.step_rad;
      const auto below = static_cast<std::size_t>(at);
      const double share = at - static_cast<double>(below);
      for (const std::size_t band : {std::size_t{0}, medium.wavelengths_nm.size() - 1}) {
        const auto of = static_cast<glm::length_t>(band);
        const double lift = std::lerp(double{disk.lift_rad[below][of]},
                                      double{disk.lift_rad[below + 1][of]}, share);
        EXPECT_NEAR(lift / kArcMinute,
                    (elevation - rays.TrueElevation(elevation, band)) / kArcMinute, 0.1)
            << "0.05' between nodes; the tables of RefractedView are good to 0.1'; " << height_m;
      }
    }
  }
}

TEST(RefractedDisk, HighDisksAndWideViewsNeedNone) {
  const auto air = std::make_shared<const SolvedAir>(MediumPreset("earth"), AirSolution::kDraft);
  constexpr double kRadius = 16.0 * kArcMinute;
  RefractedDiskFollower follower;
  EXPECT_EQ(follower.Follow(air, 2.0, 0.3, kRadius, 0.0), nullptr) << "17 degrees up";
  EXPECT_NE(follower.Follow(air, 2.0, 0.005, kRadius, kArcMinute), nullptr);
  EXPECT_EQ(follower.Follow(air, 2.0, 0.005, kRadius, 6.0 * kArcMinute), nullptr)
      << "its halves move by 3' against each other";
}

TEST(RefractedDisk, AKeptOneCoversTheMovedDisk) {
  const auto air = std::make_shared<const SolvedAir>(MediumPreset("earth"), AirSolution::kDraft);
  constexpr double kRadius = 16.0 * kArcMinute, kElevation = 2.0 * 60.0 * kArcMinute;
  RefractedDiskFollower follower;
  const double first_rad = follower.Follow(air, 2.0, kElevation, kRadius, 0.0)->first_rad;
  double moved = 0.0;
  for (; moved < kRadius; moved += 0.01 * kRadius) {
    const RefractedDisk* const disk = follower.Follow(air, 2.0, kElevation + moved, kRadius, 0.0);
    if (disk->first_rad != first_rad) break;  // computed anew
    const double last_rad = first_rad + (RefractedDisk::kNodes - 1) * disk->step_rad;
    EXPECT_LE(disk->first_rad, kElevation + moved - kRadius);
    EXPECT_GE(last_rad, kElevation + moved + kRadius);
  }
  EXPECT_GT(moved, 0.1 * kRadius);
  EXPECT_LT(moved, 0.25 * kRadius) << "the nodes reach a quarter of the radius farther";
}

TEST(ViewBend, IsOffIfNothingMovesByHalfAPixel) {
  const Medium medium = MediumPreset("earth");
  const UtcTime noon = ParseInstant("2026-06-21T11:30:00Z");
  const Scene near = BareScene(20.0, 0.0, 0.0, 60.0);
  EXPECT_FALSE(BendOf(ViewFrom(near, noon, 640, 360), medium, 40e3)) << "pixels of 5.6'";
  EXPECT_TRUE(BendOf(ViewFrom(near, noon, 640, 360), medium, 120e3)) << "lifted by 5' at most";
  const Scene high = BareScene(10e3, 0.0, 0.0, 60.0);
  EXPECT_TRUE(BendOf(ViewFrom(high, noon, 640, 360), medium, 0.0)) << "the horizon is, by 12'";
}

TEST(ViewBend, IsOnIfPixelsAtTheEdgeAreSmallEnough) {
  const Medium medium = MediumPreset("earth");
  const UtcTime noon = ParseInstant("2026-06-21T11:30:00Z");
  const Scene wide = BareScene(20.0, 0.0, 0.0, 120.0);
  EXPECT_TRUE(BendOf(ViewFrom(wide, noon, 640, 360), medium, 120e3))
      << "land rises by 5'; pixels have 18.6' in the middle and 3.8' in the corners";
  const PaintedView whole = ViewFrom(wide, noon, 640, 360);
  PaintedView part = whole;
  part.width = 320;
  part.part = {-0.5, 0.0, 2.0, 1.0};
  EXPECT_NEAR(LeastPixelAngle(part), LeastPixelAngle(whole), 1e-12) << "both have that corner";
}

TEST_F(RefractionOnGpu, SettingSunAndSeaAreWhereTheRendererHasThem) {
  Scene scene = BareScene(20.0, 306.0, 0.15, 1.2);
  scene.ground.kind = GroundCover::Kind::kWater;
  constexpr int kAcross = 64, kDown = 48;
  const UtcTime now = ParseInstant("2026-06-21T19:23:40Z");
  const HdrImage painted = Painted(scene, ViewFrom(scene, now, kAcross, kDown));
  RenderSettings settings{.width = kAcross,
                          .height = kDown,
                          .samples_per_pixel = 16,
                          .filter = PixelFilter::Kind::kBox,
                          .air_nodes = 8,
                          .layers = {}};
  const HdrImage reference = SceneRenderer(scene).Render(now, settings);
  const auto luminance = [](const HdrImage& picture, int x, int y) {
    const auto& rgb = picture.at(x, y);
    return shared::Luminance(rgb[0], rgb[1], rgb[2]);
  };
  float brightest = 0.0F;
  for (int y = 0; y < kDown; ++y)
    for (int x = 0; x < kAcross; ++x) brightest = std::max(brightest, luminance(reference, x, y));
  // Half of what the lower limb, dimmed by the air, has of the brightest.
  const auto is_sun = [&](const HdrImage& picture, int x, int y) {
    return luminance(picture, x, y) > 0.2F * brightest;
  };
  int in_both = 0, in_one = 0;
  for (int y = 0; y < kDown; ++y) {
    for (int x = 0; x < kAcross; ++x) {
      const bool a = is_sun(painted, x, y), b = is_sun(reference, x, y);
      in_both += a && b ? 1 : 0;
      in_one += a != b ? 1 : 0;
    }
  }
  EXPECT_GT(in_both, 250) << "pixels of 1.1': a disk of 600, half set at most";
  EXPECT_LT(in_one, in_both / 20) << "pixels on its rim; a round one differs in a seventh";
}

using RefractedPeak = tests::HeadlessWith<TemporaryFolder>;

TEST_F(RefractedPeak, BehindTheHorizonAppearsWhereTheRayEquationSays) {
  const Medium medium =
      OnOsculatingSphere(MediumPreset("earth"), BareScene(0.0, 0.0, 0.0, 1.0).place.latitude_rad());
  const UtcTime noon = ParseInstant("2026-06-21T11:30:00Z");
  for (const tests::FarPeak& peak :
       {tests::FarPeak{20.0, 110e3, 650.0}, tests::FarPeak{3000.0, 300e3, 800.0}}) {
    const double expected = tests::ElevationByEquation(medium, peak);
    const Scene scene =
        tests::SceneOf(peak, expected / kRadiansPerDegree, 0.4, medium.planet_radius_m, folder_);
    constexpr int kAcross = 32, kDown = 64;
    const PaintedView view = ViewFrom(scene, noon, kAcross, kDown);
    SkyPainter painter(scene, LandSourceOf(scene), view, SizesOf(Quality::kLow),
                       tests::SharedAirOf(scene));
    painter.WaitUntilReady(view);
    painter.Paint(view);
    const CameraRays camera(scene.camera, kAcross, kDown);
    double top = 1.0;
    const std::vector<glm::vec4> values = painter.picture().ReadValues();
    for (int y = kDown - 1; y >= 0; --y)
      if (values[static_cast<std::size_t>(y * kAcross + kAcross / 2)].w > 0.0F)
        top = std::asin(camera.Direction(kAcross / 2 + 0.5, y).z);
    EXPECT_NEAR(top / kArcMinute, expected / kArcMinute, 1.1)
        << "0.3' of LiftOfLand, and a pixel of 0.75'; straight rays do not show it";
  }
}

// --- which rows of a picture can hold the planet, against every ray of it ---

constexpr double kRadius_km = 6371.0;

PaintedView ViewFrom(double height_m, double pitch_deg, double roll_deg) {
  CameraPose eye{{0.8, 0.2, height_m},
                 1.0,
                 pitch_deg * kRadiansPerDegree,
                 roll_deg * kRadiansPerDegree,
                 60.0 * kRadiansPerDegree};
  return {eye, {}, 64, 36};
}

/// One over the highest row with a ray under the horizon, by asking 9 places of each pixel.
int RowsByRays(const PaintedView& view) {
  const ViewAxes axes = AxesOf(view);
  const double horizon = shared::HorizonCosine(1e-3 * view.eye.place.height_m, kRadius_km);
  int rows = 0;
  for (int y = 0; y < 3 * view.height; ++y) {
    for (int x = 0; x < 3 * view.width; ++x) {
      const glm::dvec3 d =
          glm::normalize(axes.forward + ((2.0 * x + 1.0) / (3 * view.width) - 1.0) * axes.right +
                         ((2.0 * y + 1.0) / (3 * view.height) - 1.0) * axes.up);
      if (d.z < horizon) rows = y / 3 + 1;
    }
  }
  return rows;
}

TEST(PaintedView, RowsOfThePlanetContainItAndFewOtherRows) {
  for (const double height_m : {2.0, 10e3, 400e3, 36e6}) {
    for (const double pitch_deg : {-90.0, -40.0, -3.0, 0.0, 20.0, 70.0}) {
      for (const double roll_deg : {0.0, 30.0, 90.0, 180.0}) {
        const PaintedView view = ViewFrom(height_m, pitch_deg, roll_deg);
        const int reference = RowsByRays(view), rows = RowsOfPlanet(view, kRadius_km);
        EXPECT_GE(rows, reference) << height_m << " m, " << pitch_deg << ", " << roll_deg;
        // A row to spare, and what places between those asked add.
        EXPECT_LE(rows, reference + 3) << height_m << " m, " << pitch_deg << ", " << roll_deg;
      }
    }
  }
}

}  // namespace
}  // namespace alpenglow::viewer
