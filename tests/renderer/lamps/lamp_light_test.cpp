// SPDX-License-Identifier: MIT
#include "renderer/lamps/lamp_light.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/reference/airlight_reference.h"
#include "renderer/lamps/placed_lamp.h"
#include "renderer/picture/render.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::renderer {
namespace {

constexpr double kLampEyeHeight_m = 40.0;

/// An eye 40 m over the ellipsoid that looks north.
Scene NightScene() { return BareScene(kLampEyeHeight_m, 0.0, 0.0, 40.0); }

void AddFog(Scene& scene, double extinction_per_m, double scale_height_m) {
  Fog fog;
  fog.extinction_per_m = extinction_per_m;
  fog.scale_height_m = scale_height_m;
  fog.base_height_m = 0.0;
  fog.phase = {.kind = PhaseKind::kHenyeyGreenstein, .g = 0.8};
  scene.fog = fog;
}

/// A lamp so many metres north and east of the eye.
Light LightAt(double north_m, double east_m, double height_m, double candela) {
  const double radius = 6371000.0;
  Light light;
  light.latitude_rad = BareScene(0.0, 0.0, 0.0, 40.0).place.latitude_rad + north_m / radius;
  light.longitude_rad = BareScene(0.0, 0.0, 0.0, 40.0).place.longitude_rad +
                        east_m / (radius * std::cos(light.latitude_rad));
  light.height = {height_m, false};
  light.intensity_cd = candela;
  light.radius_m = 0.05;
  return light;
}

/// What the renderer makes of a scene, without the sky.
struct Stage {
  explicit Stage(const Scene& of)
      : scene(of),
        ground(LoadGround(scene)),
        medium(OnOsculatingSphere(scene.medium, scene.place.latitude_rad)),
        colour(medium.wavelengths_nm),
        light(scene, ground, medium, colour) {}

  [[nodiscard]] double Luminance(const Bands<float>& bands) const {
    std::vector<double> values(bands.value.begin(),
                               bands.value.begin() + static_cast<std::ptrdiff_t>(bands.count));
    return colour.Xyz(values)[1];
  }
  [[nodiscard]] glm::dvec3 Place(const Light& lamp) const {
    return ground.frame
        .EnuFromGeodetic({lamp.latitude_rad, lamp.longitude_rad, lamp.height.value_m})
        .xyz;
  }

  Scene scene;
  SceneGround ground;
  Medium medium;
  BandColour colour;
  LampLight light;
};

const glm::dvec3 kEye(0.0, 0.0, kLampEyeHeight_m);

TEST(LampIntensity, IsRefusedWhereTheBandsHaveNoLuminanceOfIt) {
  const std::vector<double> deep_red{700.0, 830.0};
  const BandColour colour(deep_red);
  EXPECT_GT(LampIntensity(3000.0, 100.0, deep_red, colour)[0], 0.0F);
  try {
    (void)LampIntensity(1000.0, 100.0, deep_red, colour);
    ADD_FAILURE() << "a lamp that takes light away";
  } catch (const InputError& error) {
    const std::string message = error.what();
    for (const char* part : {"light.temperature_k", "1000 K", "700 to 830 nm"})
      EXPECT_NE(message.find(part), std::string::npos) << message;
  }
}

TEST(LampLight, ACandelaIsACandelaThroughClearAir) {
  // 1000 cd at 100 m light a surface that faces them by 0.1 lux.
  Scene scene = NightScene();
  scene.lights = {LightAt(100.0, 0.0, kLampEyeHeight_m, 1000.0)};
  const Stage stage(scene);
  const LitPoint facing{kEye, kEye, {0.0, 1.0, 0.0}, {0.0, 1.0, 0.0}};
  const double distance = glm::length(stage.Place(scene.lights[0]) - kEye);
  EXPECT_NEAR(stage.Luminance(stage.light.OnSurface(stage.light.All(), facing)),
              1000.0 / (distance * distance), 0.1 * 0.01)
      << "100 m of clear air take away and give less than a per cent";
}

TEST(LampLight, TheTemperatureColoursAndTheCandelaStays) {
  Scene scene = NightScene();
  scene.lights = {LightAt(50.0, 0.0, kLampEyeHeight_m, 100.0)};
  const LitPoint facing{kEye, kEye, {0.0, 1.0, 0.0}, {0.0, 1.0, 0.0}};
  std::vector<std::array<double, 3>> colours;
  for (const double kelvin : {2000.0, 6500.0}) {
    scene.lights[0].temperature_k = kelvin;
    const Stage stage(scene);
    const Bands<float> light = stage.light.OnSurface(stage.light.All(), facing);
    EXPECT_NEAR(stage.Luminance(light), 0.04, 4e-4) << kelvin << " K";
    std::vector<double> values(light.value.begin(), light.value.begin() + 4);
    colours.push_back(stage.colour.LinearSrgb(values));
  }
  EXPECT_GT(colours[0][0], 3.0 * colours[0][2]) << "2000 K is orange";
  EXPECT_NEAR(colours[1][0] / colours[1][2], 1.0, 0.15) << "6500 K is white";
}

TEST(LampLight, LightInFogIsThatOfTheReference) {
  Scene scene = NightScene();
  AddFog(scene, 0.01, 30.0);
  scene.lights = {LightAt(300.0, 10.0, 5.0, 1000.0)};
  const Stage stage(scene);
  Lamp lamp;
  lamp.position_m = stage.Place(scene.lights[0]);
  lamp.radius_m = 0.05;
  LampAir fog = HomogeneousAir(0.01, 0.01, scene.fog->phase);
  fog.layers[0].scale_height_m = 30.0;
  for (const glm::dvec3& towards :
       {glm::dvec3(0.0, 1.0, -0.1), glm::dvec3(0.1, 1.0, 0.0), glm::dvec3(0.0, 1.0, -0.2)}) {
    LampRayEnd ray{glm::normalize(towards), 350.0};
    LampSegment segment{kEye, ray.direction, 0.0, ray.length_m};
    const double expected = 1000.0 * reference::AirlightAlong(fog, lamp, segment).radiance[0];
    const double found = stage.Luminance(stage.light.InAir(stage.light.All(), ray, 0.0, 16));
    EXPECT_NEAR(found / expected, 1.0, 0.02)
        << "molecules and aerosol, which the reference solution's fog does not have, add and take "
           "1 per cent";
  }
}

TEST(LampLight, TheLampInThePictureHasItsIntensity) {
  // Luminance times solid angle over its pixels is the illuminance at the eye.
  Scene scene = NightScene();
  scene.lights = {LightAt(500.0, 3.0, kLampEyeHeight_m, 1000.0)};
  const Stage stage(scene);
  const CameraRays camera(scene.camera, 320, 180);
  double illuminance = 0.0;
  for (int y = 0; y < 180; ++y) {
    for (int x = 0; x < 320; ++x) {
      for (const double s : {0.25, 0.75}) {
        for (const double t : {0.25, 0.75}) {
          illuminance +=
              0.25 * stage.Luminance(stage.light.Seen(
                         stage.light.All(), camera.MiddleRay(x + s, y + t), camera.PixelAngle()));
        }
      }
    }
  }
  illuminance *= camera.PixelAngle() * camera.PixelAngle();
  EXPECT_NEAR(illuminance / (1000.0 / (500.0 * 500.0)), 1.0, 0.06)
      << "four rays a pixel sum a soft disk of 1.8 pixels; the air takes 1.5 per cent";
}

TEST(LampLight, ABeamLightsTheAirInItAndNoneBesideIt) {
  Scene scene = NightScene();
  AddFog(scene, 0.01, 1000.0);
  Light beam = LightAt(100.0, -50.0, kLampEyeHeight_m, 1e5);
  beam.type = Light::Type::kSpot;
  beam.heading_rad = 0.5 * kPi;  // across the view, 100 m ahead
  beam.inner_rad = 0.02;
  beam.outer_rad = 0.05;
  scene.lights = {beam};
  const Stage stage(scene);
  const auto luminance = [&](const glm::dvec3& towards) {
    return stage.Luminance(
        stage.light.InAir(stage.light.All(), {glm::normalize(towards), 300.0}, 1e-3, 16));
  };
  // 3.5 m of beam, 50 m from the lamp, scattered to the side: I sigma p(90 deg) l / d^2 T.
  const double expected = 1e5 * 0.0096 * 0.01364 * 3.5 / 2500.0 * std::exp(-0.0096 * 150.0);
  EXPECT_NEAR(luminance({0.0, 1.0, 0.0}) / expected, 1.0, 0.2) << "the beam's edge is soft";
  EXPECT_EQ(luminance({0.0, 1.0, 0.2}), 0.0) << "over it";
}

// Hard case 42.
TEST(LampLight, AnEyeInALampSeesItsLuminanceAllAround) {
  Scene scene = NightScene();
  scene.lights = {LightAt(0.0, 0.0, kLampEyeHeight_m, 1000.0)};
  const Stage at_the_eye(scene);
  scene.lights = {LightAt(0.03, 0.0, kLampEyeHeight_m, 1000.0)};  // of a radius of 0.05 m
  const Stage beside_it(scene);
  const double luminance = 1000.0 / (kPi * 0.05 * 0.05);
  for (const glm::dvec3& towards :
       {glm::dvec3(0.0, 1.0, 0.0), glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(0.0, -0.6, -0.8)}) {
    for (const Stage* stage : {&at_the_eye, &beside_it}) {
      const Bands<float> seen = stage->light.Seen({0}, {kEye, kEye, towards, towards}, 1e-3);
      EXPECT_NEAR(stage->Luminance(seen) / luminance, 1.0, 1e-5)
          << "in floats, through 5 cm of air, which takes 1e-6 of the light";
    }
  }
}

// Hard case 42.
TEST(LampLight, AHeadlampLightsTheAirBeforeItAndIsNotSeenByItsEye) {
  Scene scene = NightScene();
  AddFog(scene, 0.01, 1000.0);
  Light lamp = LightAt(0.0, 0.0, kLampEyeHeight_m, 1000.0);
  scene.lights = {lamp};
  const Stage around(scene);
  lamp.type = Light::Type::kSpot;  // to the north
  lamp.inner_rad = 0.3;
  lamp.outer_rad = 0.6;
  scene.lights = {lamp};
  const Stage ahead(scene);
  const auto in_air = [](const Stage& stage, const glm::dvec3& towards) {
    return stage.Luminance(stage.light.InAir({0}, {towards, 300.0}, 1e-3, 16));
  };
  const glm::dvec3 north(0.0, 1.0, 0.0), east(1.0, 0.0, 0.0),
      aside(std::sin(0.2), std::cos(0.2), 0.0);
  EXPECT_GT(in_air(around, north), 0.0);
  EXPECT_EQ(in_air(ahead, north), in_air(around, north)) << "in the beam all along the ray";
  EXPECT_EQ(in_air(ahead, aside), in_air(around, aside));
  EXPECT_EQ(in_air(ahead, east), 0.0);
  const auto seen = [&](const glm::dvec3& towards) {
    return ahead.Luminance(ahead.light.Seen({0}, {kEye, kEye, towards, towards}, 1e-3));
  };
  EXPECT_EQ(seen(north), 0.0);
  EXPECT_GT(seen(-north), 0.0) << "looking into it";
}

/// Illuminance of the eye by lamps near the middle of a
/// picture of 320 x 180 pixels, from 64 rays a pixel.
double IlluminanceInPicture(const Stage& stage, const LampLight& light, const CameraRays& camera) {
  constexpr int kSub = 8;
  double sum = 0.0;
  for (int y = 70 * kSub; y < 110 * kSub; ++y) {
    for (int x = 140 * kSub; x < 185 * kSub; ++x) {
      const CameraRay ray = camera.Ray((x + 0.5) / kSub, (y + 0.5) / kSub, {0.5, 0.5});
      const double cosine = glm::dot(ray.through, camera.Direction(160.0, 90.0));
      sum += stage.Luminance(light.Seen(light.All(), ray, camera.PixelAngle())) *
             std::pow(camera.PixelAngle() / kSub, 2) * std::pow(cosine, 3);
    }
  }
  return sum;
}

TEST(LampLight, ALensSpreadsALampOverItsIrisAndKeepsItsLight) {
  Scene scene = NightScene();
  scene.lights = {LightAt(500.0, 3.0, kLampEyeHeight_m, 1000.0)};
  const Stage stage(scene);
  const CameraRays pinhole(scene.camera, 320, 180, {kEye});
  const double sharp = IlluminanceInPicture(stage, stage.light, pinhole);
  for (const int blades : {0, 6}) {
    scene.camera.lens = ThinLens{1.4, 0.085, 3.0, blades, 0.0};
    const CameraRays camera(scene.camera, 320, 180, {kEye});
    const LampLight light = stage.light.SeenBy(camera);
    EXPECT_NEAR(IlluminanceInPicture(stage, light, camera) / sharp, 1.0, 0.01)
        << "sums over points, " << blades << " blades";
    // In the middle as bright as flux over area; that of a hexagon is smaller than its circle.
    const double blur = camera.BlurRadius(stage.Place(scene.lights[0]) - kEye);
    const glm::dvec3 towards = glm::normalize(stage.Place(scene.lights[0]) - kEye);
    const double area = Iris(blades).area() * blur * blur;
    EXPECT_NEAR(stage.Luminance(
                    light.Seen(light.All(), {kEye, kEye, towards, towards}, camera.PixelAngle())) *
                    area / sharp,
                1.0, 0.25)
        << blades << " blades: the edge is as soft as a pixel, the blur 4 pixels";
  }
}

class LampShadows : public TemporaryFolder {
 protected:
  // A plain, and a wall 40 m high and 60 m wide, 100 m north of the eye.
  [[nodiscard]] Scene WallScene() const {
    WriteText(folder_ / "wall.obj",
              "v -2000 -2000 0\nv 2000 -2000 0\nv 2000 2000 0\nv -2000 2000 0\nf 1 2 3 4\n"
              "v -30 100 0\nv 30 100 0\nv 30 100 40\nv -30 100 40\nf 5 6 7 8\n");
    Scene scene = BareScene(20.0, 0.0, 0.0, 60.0);
    scene.terrain.kind = TerrainSource::Kind::kMesh;
    scene.terrain.file = folder_ / "wall.obj";
    return scene;
  }
};

TEST_F(LampShadows, AWallShadesTheGroundAndTheAirBehindIt) {
  Scene scene = WallScene();
  AddFog(scene, 0.005, std::numeric_limits<double>::infinity());
  // A lamp behind the wall and 80 m to the right, level with the middle of the wall.
  scene.lights = {LightAt(130.0, 80.0, 20.0, 1000.0)};
  const Stage stage(scene);
  const glm::dvec3 up(0.0, 0.0, 1.0);
  const glm::dvec3 before_it(-80.0, 60.0, 0.0), behind_it(-80.0, 160.0, 0.0);
  const LitPoint before{before_it, before_it, up, up};
  const LitPoint behind{behind_it, behind_it, up, up};
  const LampNodes all = stage.light.All();
  EXPECT_GT(stage.Luminance(stage.light.OnSurface(all, behind)),
            2.0 * stage.Luminance(stage.light.OnSurface(all, before)))
      << "the wall stands between the lamp and the first point; air alone lights it";
  // Along a ray in front of the wall: against 4000 short pieces, each tested for shadow.
  const glm::dvec3 eye(0.0, 0.0, 20.0);
  const LampRayEnd ray{glm::normalize(glm::dvec3(-0.5, 0.8, 0.05)), 200.0};
  Lamp lamp;
  lamp.position_m = stage.Place(scene.lights[0]);
  lamp.radius_m = 0.05;
  LampAir air = HomogeneousAir(0.005, 0.005, scene.fog->phase);
  double lit = 0.0, whole = 0.0;
  constexpr int kPieces = 4000;
  for (int i = 0; i < kPieces; ++i) {
    const LampSegment piece{eye, ray.direction, 200.0 * i / kPieces, 200.0 * (i + 1) / kPieces};
    const glm::dvec3 way =
        eye + 0.5 * (piece.begin_m + piece.end_m) * ray.direction - lamp.position_m;
    const double light = 1000.0 * Airlight(air, lamp, piece, 2)[0];
    whole += light;
    if (!stage.ground.terrain->Occluded(lamp.position_m, glm::normalize(way), way,
                                        glm::length(way))) {
      lit += light;
    }
  }
  const double found = stage.Luminance(stage.light.InAir(all, ray, 0.0, 16));
  EXPECT_LT(lit, 0.9 * whole) << "the wall shades part of the ray";
  EXPECT_GT(lit, 0.1 * whole);
  EXPECT_NEAR(found / lit, 1.0, 0.03) << "edges to 1/768 of the ray's angle, and the clear air";
}

/// By how much a plan's lamps light surfaces less or more than all lamps do, at the worst of some
/// pixels.
double WorstOnSurfaces(const Stage& stage) {
  constexpr int kWidth = 160, kHeight = 96;
  const CameraRays camera(stage.scene.camera, kWidth, kHeight,
                          {.eye = {0.0, 0.0, stage.ground.eye_height_m}});
  const auto hit = [&](const CameraRay& ray) {
    return stage.ground.terrain->Intersect(ray.origin, ray.direction);
  };
  const LampPlan plan = stage.light.PlanFor(camera, kWidth, kHeight, {}, [&](const CameraRay& ray) {
    const auto end = hit(ray);
    return end ? end->distance_m : std::numeric_limits<double>::infinity();
  });
  double worst = 0.0;
  for (int y = 1; y < kHeight; y += 5) {
    for (int x = 2; x < kWidth; x += 7) {
      const CameraRay ray = camera.MiddleRay(x + 0.5, y + 0.5);
      const auto end = hit(ray);
      if (!end) continue;
      const LitPoint at{ray.origin + end->distance_m * ray.direction, end->smooth_point,
                        end->normal, end->geometric_normal};
      const double all = stage.Luminance(stage.light.OnSurface(stage.light.All(), at));
      const double found = stage.Luminance(stage.light.OnSurface(plan.At(x, y).surface, at));
      worst = std::max(worst, std::abs(found / all - 1.0));
    }
  }
  return worst;
}

/// By how much a plan's lamps light the air before terrain less or more than all lamps do, at the
/// worst of some pixels; of at least a hundredth of the brightest's light.
double WorstInAir(const Stage& stage) {
  constexpr int kWidth = 160, kHeight = 96;
  const CameraRays camera(stage.scene.camera, kWidth, kHeight,
                          {.eye = {0.0, 0.0, stage.ground.eye_height_m}});
  const RayTrace trace = [&](const CameraRay& ray) {
    const auto end = stage.ground.terrain->Intersect(ray.origin, ray.direction);
    return end ? end->distance_m : std::numeric_limits<double>::infinity();
  };
  const LampPlan plan = stage.light.PlanFor(camera, kWidth, kHeight, {}, trace);
  std::vector<std::array<double, 2>> both;
  double brightest = 0.0;
  for (int y = 1; y < kHeight; y += 5) {
    for (int x = 2; x < kWidth; x += 7) {
      const CameraRay ray = camera.MiddleRay(x + 0.5, y + 0.5);
      const LampRayEnd end{ray.direction, trace(ray)};
      const double all =
          stage.Luminance(stage.light.InAir(stage.light.All(), end, camera.PixelAngle(), 12));
      const double found =
          stage.Luminance(stage.light.InAir(plan, x, y, end, camera.PixelAngle(), 12));
      both.push_back({found, all});
      brightest = std::max(brightest, all);
    }
  }
  double worst = 0.0;
  for (const auto& [found, all] : both)
    worst = std::max(worst, std::abs(found - all) / std::max(all, 0.01 * brightest));
  return worst;
}

/// Air that scatters so little that what is dark is dark.
void ThinTheAir(Medium& medium) {
  for (auto* of_band : {&medium.rayleigh_scattering_per_m, &medium.mie_scattering_per_m,
                        &medium.mie_extinction_per_m}) {
    for (double& value : *of_band) value *= 1e-3;
  }
}

/// A row of lamps of these candelas beside the eye, which light the plain before it.
void AddDimLamps(Scene& scene, double candela) {
  for (int i = -10; i <= 10; ++i) scene.lights.push_back(LightAt(-10.0, 6.0 * i, 8.0, candela));
}

TEST_F(LampShadows, ABrightLampBehindTheWallTakesNothingFromDimOnesBeforeIt) {
  Scene scene = WallScene();
  ThinTheAir(scene.medium);
  scene.camera.pitch_rad = -0.3;
  scene.lights = {LightAt(110.0, 0.0, 10.0, 1e4)};
  AddDimLamps(scene, 0.03);
  EXPECT_LT(WorstOnSurfaces(Stage(scene)), 0.03)
      << "a share of error of 0.5 per cent where lamps shine, of the glow's where they do not";
}

TEST_F(LampShadows, ARowOfLampsAcrossTheEndOfTheWallIsNotOneLamp) {
  Scene scene = WallScene();
  ThinTheAir(scene.medium);
  scene.camera.pitch_rad = -0.3;
  for (int i = -20; i < 40; ++i) scene.lights.push_back(LightAt(130.0, i, 10.0, 100.0));
  EXPECT_LT(WorstOnSurfaces(Stage(scene)), 0.03) << "where two of sixty lamps shine, too";
}

TEST_F(LampShadows, ARowOfLampsAcrossTheEndOfTheWallIsNotOneLampInTheAirBeforeIt) {
  Scene scene = WallScene();
  AddFog(scene, 0.002, std::numeric_limits<double>::infinity());
  scene.camera.pitch_rad = -0.3;
  for (int i = 0; i < 8; ++i) scene.lights.push_back(LightAt(130.0, 24.0 + 2.0 * i, 10.0, 100.0));
  EXPECT_LT(WorstInAir(Stage(scene)), 0.05) << "edges of shade are found to 1/768 of a ray's angle";
}

TEST_F(LampShadows, ABrightLampThatGrazesTheGroundTakesNothingFromDimOnesBesideIt) {
  Scene scene = WallScene();
  ThinTheAir(scene.medium);
  scene.camera.pitch_rad = -0.3;
  scene.lights = {LightAt(-500.0, 0.0, 0.1, 1e5)};  // its rays meet the ground at 0.15 mrad
  AddDimLamps(scene, 0.01);
  EXPECT_LT(WorstOnSurfaces(Stage(scene)), 0.03)
      << "a share of error of what the ground gets, not of what would face the lamp";
}

TEST_F(LampShadows, ABeamThatShinesElsewhereTakesNothingFromDimLampsBesideIt) {
  Scene scene = WallScene();
  ThinTheAir(scene.medium);
  scene.camera.pitch_rad = -0.3;
  Light beam = LightAt(-60.0, 0.0, 30.0, 1e5);
  beam.type = Light::Type::kSpot;
  beam.pitch_rad = 0.5 * kPi;
  beam.inner_rad = 0.2;
  beam.outer_rad = 0.4;
  scene.lights = {beam};
  AddDimLamps(scene, 0.005);
  EXPECT_LT(WorstOnSurfaces(Stage(scene)), 0.03) << "all of the beam's light goes up";
}

TEST_F(LampShadows, ALampBehindTheWallIsNotSeen) {
  Scene scene = WallScene();
  scene.lights = {LightAt(130.0, 0.0, 10.0, 1000.0), LightAt(130.0, 80.0, 10.0, 1000.0)};
  const Stage stage(scene);
  const auto seen = [&](const Light& lamp) {
    const glm::dvec3 eye(0.0, 0.0, 20.0);
    const glm::dvec3 to_lamp = glm::normalize(stage.Place(lamp) - eye);
    return stage.Luminance(stage.light.Seen(stage.light.All(), {eye, eye, to_lamp, to_lamp}, 1e-3));
  };
  EXPECT_EQ(seen(scene.lights[0]), 0.0);
  EXPECT_GT(seen(scene.lights[1]), 0.0);
}

// Hard case 42.
TEST_F(LampShadows, ALampBelowTheGroundIsRefused) {
  Scene scene = WallScene();
  scene.lights = {LightAt(50.0, 0.0, -5.0, 1000.0)};
  EXPECT_THROW(Stage{scene}, InputError);
}

/// A hundred lamps in two rows to the north, and a beam across them, in fog.
Scene RunwayScene(int rows = 50) {
  Scene scene = NightScene();
  AddFog(scene, 0.004, 25.0);
  for (int i = 0; i < rows; ++i) {
    for (const double side : {-20.0, 20.0}) {
      scene.lights.push_back(
          LightAt(150.0 + 2000.0 * i / rows, side, 1.0, 500.0 + 250.0 * i / rows));
    }
  }
  Light beam = LightAt(400.0, -60.0, 20.0, 2e5);
  beam.type = Light::Type::kSpot;
  beam.heading_rad = 0.5 * kPi;
  beam.inner_rad = 0.05;
  beam.outer_rad = 0.15;
  scene.lights.push_back(beam);
  return scene;
}

/// Where rays meet a plane below the eye.
RayTrace ToPlane(double below_m) {
  return [below_m](const CameraRay& ray) {
    const double z = ray.direction.z;
    return z < 0.0 ? below_m / -z : std::numeric_limits<double>::infinity();
  };
}

struct PlanError {
  double rms = 0.0, most = 0.0;
};

// Of light in the air by a plan against all lamps, one or more in every tile.
PlanError ErrorOfPlan(const Scene& scene, int width, int height, const RayTrace& trace) {
  const Stage stage(scene);
  const CameraRays camera(scene.camera, width, height);
  const LampPlan plan = stage.light.PlanFor(camera, width, height, {}, trace);
  PlanError error;
  double squares = 0.0;
  int pixels = 0;
  for (int y = 2; y < height; y += 9) {
    for (int x = 3; x < width; x += 13) {
      LampRayEnd ray{camera.Direction(x + 0.5, y + 0.5), 0.0};
      ray.length_m = trace(camera.MiddleRay(x + 0.5, y + 0.5));
      const double all =
          stage.Luminance(stage.light.InAir(stage.light.All(), ray, camera.PixelAngle(), 12));
      const double found =
          stage.Luminance(stage.light.InAir(plan, x, y, ray, camera.PixelAngle(), 12));
      const double relative = std::abs(found / all - 1.0);
      squares += relative * relative;
      error.most = std::max(error.most, relative);
      ++pixels;
    }
  }
  error.rms = std::sqrt(squares / pixels);
  return error;
}

TEST(LampLight, WhatStandsForManyLampsIsAsGoodAsAll) {
  const PlanError error = ErrorOfPlan(RunwayScene(), 160, 90, ToPlane(kLampEyeHeight_m));
  EXPECT_LT(error.rms, 0.01) << "a share of error of 0.5 per cent, and lattices";
  EXPECT_LT(error.most, 0.05);
}

TEST(LampLight, ALampNearARayIsNotLostAmongLampsThatAreFarFromIt) {
  // Six metres over the grass, 75 m beside a runway that runs east: lamps of one group lie on both
  // sides of rays that pass near some of them.
  constexpr double kGround_m = kLampEyeHeight_m - 6.0;
  Scene scene = NightScene();
  AddFog(scene, 0.0043, 25.0);
  scene.fog->base_height_m = kGround_m;
  const auto add = [&](double along_m, double left_m, double candela) {
    scene.lights.push_back(LightAt(left_m + 75.0, along_m - 620.0, kGround_m + 0.35, candela));
  };
  for (int i = 0; i <= 30; ++i) {
    for (const double side : {-23.0, 23.0}) add(60.0 * i, side, 800.0);
  }
  for (int i = 0; i < 60; ++i) add(30.0 * i, 0.0, 500.0);
  for (int i = -7; i <= 7; ++i) {
    add(0.0, 3.0 * i, 700.0);
    add(1800.0, 3.0 * i, 250.0);
  }
  for (int i = 1; i <= 10; ++i) {
    for (int j = -2; j <= 2; ++j) add(-30.0 * i, 1.2 * j, 900.0);
  }
  scene.camera.heading_rad = 5.04;
  scene.camera.pitch_rad = 0.026;
  scene.camera.fov_rad = 0.91;
  const PlanError error = ErrorOfPlan(scene, 960, 540, ToPlane(6.0));
  EXPECT_LT(error.rms, 0.01);
  EXPECT_LT(error.most, 0.05);
}

TEST(LampLight, TenTimesTheLampsCostThreeTimesAsMuch) {
  std::vector<double> nodes;
  for (const int rows : {50, 500}) {
    const Stage stage(RunwayScene(rows));
    const CameraRays camera(stage.scene.camera, 320, 180);
    const LampPlan plan = stage.light.PlanFor(camera, 320, 180, {}, ToPlane(kLampEyeHeight_m));
    nodes.push_back(0.0);
    for (const LampTile& tile : plan.tiles) {
      nodes.back() += static_cast<double>(tile.near_air.size() + tile.far_air.size());
    }
  }
  EXPECT_LT(nodes[1], 3.0 * nodes[0]) << "nodes that tiles see, on 100 and on 1000 lamps";
}

TEST(LampLight, DaylightDrownsLampsThatCostNothingThen) {
  const Scene scene = RunwayScene();
  const Stage stage(scene);
  const CameraRays camera(scene.camera, 64, 36);
  const LampSettings day{.nodes = 12, .share_of_error = 5e-3, .floor_cd_per_m2 = 1e4};
  const LampPlan plan = stage.light.PlanFor(camera, 64, 36, day, [](const CameraRay&) {
    return std::numeric_limits<double>::infinity();
  });
  for (const LampTile& tile : plan.tiles) {
    EXPECT_TRUE(tile.near_air.empty());
    EXPECT_TRUE(tile.far_air.empty());
  }
}

TEST(LampLight, FogDimsWhatIsBehindIt) {
  Scene scene = NightScene();
  AddFog(scene, 0.01, 50.0);
  const Stage stage(scene);
  const Bands<float> level = stage.light.FogTransmittance({0.0, 1.0, 0.0}, 100.0);
  EXPECT_NEAR(static_cast<double>(level[0]), std::exp(-std::exp(-0.8)), 1e-4)
      << "a kilometre of fog at 40 m, which the sphere's curvature hardly changes";
  const Bands<float> down = stage.light.FogTransmittance({0.0, 0.0, -1.0}, 40.0);
  EXPECT_NEAR(static_cast<double>(down[0]), std::exp(-0.01 * 50.0 * (1.0 - std::exp(-0.8))), 1e-4);
}

TEST(LampLight, PicturesHaveALayerOfLampLight) {
  Scene scene = RunwayScene();
  const SceneRenderer renderer(scene);
  const RenderSettings settings{.width = 32,
                                .height = 18,
                                .samples_per_pixel = 1,
                                .air_nodes = 4,
                                .layers = {PictureLayer::kLamps}};
  const Image night = renderer.Render(ParseInstant("2026-01-15T23:00:00Z"), settings);
  ASSERT_EQ(night.layers.size(), 3U);
  EXPECT_EQ(night.layers[0].name, "lamps.R");
  double sum = 0.0, whole = 0.0;
  for (std::size_t i = 0; i < night.rgb.size(); ++i) {
    sum += static_cast<double>(night.layers[0].values[i]);
    whole += static_cast<double>(night.rgb[i][0]);
  }
  EXPECT_GT(sum, 0.0);
  EXPECT_NEAR(sum / whole, 1.0, 1e-3) << "at night there is no other light";
}

class LampsAtTheEye : public TemporaryFolder {
 protected:
  // What cannot be in the picture of such a lamp, by day or night.
  [[nodiscard]] static std::string FaultOf(const Scene& scene, const std::string& time) {
    const RenderSettings settings{.width = 16,
                                  .height = 9,
                                  .samples_per_pixel = 2,
                                  .air_nodes = 4,
                                  .layers = {PictureLayer::kDepth, PictureLayer::kLamps}};
    return FaultyValue(SceneRenderer(scene).Render(ParseInstant(time), settings)).value_or("");
  }
  static Scene With(Light lamp) {
    Scene scene = NightScene();
    scene.lights = {std::move(lamp)};
    return scene;
  }
  const Light point_ = LightAt(0.0, 0.0, kLampEyeHeight_m, 1000.0);
  const std::string night_ = "2026-01-15T23:00:00Z", day_ = "2026-06-21T11:00:00Z";
};

// Hard case 42.
TEST_F(LampsAtTheEye, OfEveryKindMakePicturesOfNumbers) {
  EXPECT_EQ(FaultOf(With(point_), night_), "");
  EXPECT_EQ(FaultOf(With(point_), day_), "");
  Light spot = point_;
  spot.type = Light::Type::kSpot;
  spot.inner_rad = 0.2;
  spot.outer_rad = 0.4;
  EXPECT_EQ(FaultOf(With(spot), night_), "");
  WriteText(
      folder_ / "lamp.ies",
      "IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 3 1 1 2 0 0 0\n1 1 50\n0 45 90\n0\n1000 500 0\n");
  Light measured = point_;
  measured.ies = folder_ / "lamp.ies";
  measured.pitch_rad = -0.5 * kPi;
  EXPECT_EQ(FaultOf(With(measured), night_), "");
}

TEST_F(LampsAtTheEye, AMeasuredLampIsTiltedByItsPitch) {
  WriteText(folder_ / "lamp.ies",
            "IESNA:LM-63-2002\nTILT=INCLUDE\n1\n2\n0 90\n1 0.6\n"
            "1 1000 1 2 1 1 2 0 0 0\n1 1 50\n0 180\n0\n1000 1000\n");
  Light light = point_;
  light.intensity_cd.reset();
  light.ies = folder_ / "lamp.ies";
  const auto candela = [&](double pitch_rad) {
    light.pitch_rad = pitch_rad;
    const Stage stage(With(light));
    const LampStage lamps(stage.scene, stage.ground, stage.medium);
    return PlacedOn(lamps, light, 0, MeasuredLampsOf(stage.scene.lights)).candela;
  };
  EXPECT_NEAR(candela(-0.5 * kPi), 1000.0, 1e-6);
  EXPECT_NEAR(candela(-0.25 * kPi), 800.0, 1e-6);
  EXPECT_NEAR(candela(0.0), 600.0, 1e-6);
  EXPECT_THAT(
      tests::FaultOf([&] { return candela(0.25 * kPi); }),
      testing::EndsWith("lamp.ies is tilted by 135 degrees; its factors are for 0 to 90 degrees"));
}

// Hard case 42.
TEST_F(LampsAtTheEye, MakePicturesOfNumbersInFogAndThroughALens) {
  Scene scene = With(point_);
  AddFog(scene, 0.02, 100.0);
  EXPECT_EQ(FaultOf(scene, night_), "");
  EXPECT_EQ(FaultOf(scene, day_), "") << "where the sun lights the fog too";
  scene = With(point_);
  scene.camera.lens = ThinLens{2.0, 0.05, 10.0};
  EXPECT_EQ(FaultOf(scene, night_), "");
  scene = With(point_);
  scene.lights.push_back(LightAt(5.0, 0.0, kLampEyeHeight_m, 1000.0));
  scene.lights.push_back(LightAt(-5.0, 0.0, kLampEyeHeight_m, 1000.0));
  EXPECT_EQ(FaultOf(scene, night_), "") << "the middle of lamps at the eye";
}

}  // namespace
}  // namespace alpenglow::renderer
