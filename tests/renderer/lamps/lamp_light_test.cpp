// SPDX-License-Identifier: MIT
// Light of lamps on surfaces, in the air and in pictures, also where formulas divide by zero: on
// the ray, behind the eye, without light.
#include "renderer/lamps/lamp_light.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "renderer/lamps/placed_lamp.h"
#include "renderer/picture/render.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/lamp_night.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/temporary_folder.h"
#include "tests/fixtures/wall_folder.h"

namespace alpenglow::renderer {
namespace {

using testing::HasSubstr;
using tests::FogOver;
using tests::kLampEye;
using tests::kLampEye_m;
using tests::kNorth;
using tests::LampSite;
using tests::LightAt;
using tests::NightScene;
using tests::RunwayScene;
using tests::SpotOf;
using LampShadows = tests::WallFolder;

TEST(LampIntensity, IsRefusedIfTheBandsHaveNoneOfItsLuminance) {
  const std::vector<double> deep_red{700.0, 830.0};
  const BandColour colour(deep_red);
  EXPECT_GT(LampIntensity(3000.0, 100.0, deep_red, colour)[0], 0.0F);
  EXPECT_THAT(
      tests::FaultOf([&] { return LampIntensity(1000.0, 100.0, deep_red, colour); }),
      AllOf(HasSubstr("light.temperature_k"), HasSubstr("1000 K"), HasSubstr("700 to 830 nm")));
}

TEST(LampLight, ACandelaIsACandelaInEveryColour) {
  // 1000 cd at 100 m light a surface that faces them by 0.1 lux.
  Scene scene = NightScene();
  scene.lights = {LightAt(100.0, 0.0, kLampEye_m, 1000.0)};
  const LitPoint facing{kLampEye, kLampEye, kNorth, kNorth};
  std::vector<std::array<double, 3>> colours;
  for (const double kelvin : {2000.0, Light{}.temperature_k, 6500.0}) {
    scene.lights[0].temperature_k = kelvin;
    const LampSite site(scene);
    const double distance = glm::length(site.PositionOf(scene.lights[0]) - kLampEye);
    const Spectrum light = site.light.OnSurface(site.light.All(), facing);
    EXPECT_NEAR(site.Luminance(light), 1000.0 / (distance * distance), 0.1 * 0.01)
        << kelvin << " K: 100 m of clear air take away and give less than 1 %";
    colours.push_back(site.colour.LinearSrgb(light));
  }
  EXPECT_GT(colours[0][0], 3.0 * colours[0][2]) << "2000 K is orange";
  EXPECT_NEAR(colours[2][0] / colours[2][2], 1.0, 0.15) << "6500 K is white";
}

TEST(LampLight, LightInFogIsThatOfTheReference) {
  Scene scene = NightScene();
  scene.layers = {FogOver(0.0, 0.01, 30.0)};
  scene.lights = {LightAt(300.0, 10.0, 5.0, 1000.0)};
  const LampSite site(scene);
  const glm::dvec3 place = site.PositionOf(scene.lights[0]);
  for (const glm::dvec3& towards :
       {glm::dvec3(0.0, 1.0, -0.1), glm::dvec3(0.1, 1.0, 0.0), glm::dvec3(0.0, 1.0, -0.2)}) {
    const glm::dvec3 unit = glm::normalize(towards);
    const double expected = tests::FogByQuadrature(scene.layers[0], scene.lights[0], place,
                                                   {kLampEye, unit, 0.0, 350.0});
    EXPECT_NEAR(site.InAir(unit, 350.0, 16) / expected, 1.0, 0.02)
        << "molecules and aerosol, which the quadrature omits, add and take 1 %";
  }
}

TEST(LampLight, ABeamLightsOnlyTheAirInIt) {
  Scene scene = NightScene();
  scene.layers = {FogOver(0.0, 0.01, 1000.0)};
  scene.lights = {SpotOf(LightAt(100.0, -50.0, kLampEye_m, 1e5), 0.02, 0.05)};
  scene.lights[0].heading_rad = 0.5 * kPi;  // across the view, 100 m ahead
  const LampSite site(scene);
  // The beam is 3.5 m wide, 50 m from the lamp, and scatters to the side: I sigma p(90 deg) l / d^2
  // T.
  const double expected = 1e5 * 0.0096 * 0.01364 * 3.5 / 2500.0 * std::exp(-0.0096 * 150.0);
  EXPECT_NEAR(site.InAir(kNorth, 300.0, 16, 1e-3) / expected, 1.0, 0.2)
      << "the beam's edge is soft";
  EXPECT_EQ(site.InAir(glm::normalize(glm::dvec3(0.0, 1.0, 0.2)), 300.0, 16, 1e-3), 0.0)
      << "over it";
}

// Hard case 42.
TEST(LampLight, AnEyeInsideALampSeesItsLuminanceAllAround) {
  Scene scene = NightScene();
  scene.lights = {LightAt(0.0, 0.0, kLampEye_m, 1000.0)};
  const LampSite at_eye(scene);
  scene.lights = {LightAt(0.03, 0.0, kLampEye_m, 1000.0)};  // of a radius of 0.05 m
  const LampSite beside_it(scene);
  const double luminance = 1000.0 / (kPi * 0.05 * 0.05);
  for (const glm::dvec3& towards :
       {glm::dvec3(0.0, 1.0, 0.0), glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(0.0, -0.6, -0.8)}) {
    for (const LampSite* site : {&at_eye, &beside_it}) {
      const Spectrum seen = site->light.Seen({0}, {kLampEye, kLampEye, towards, towards}, 1e-3);
      EXPECT_NEAR(site->Luminance(seen) / luminance, 1.0, 1e-5)
          << "in floats, through 5 cm of air, which takes 1e-6 of the light";
    }
  }
}

// Hard case 42.
TEST(LampLight, AHeadlampLightsTheAirAheadAndIsNotSeen) {
  Scene scene = NightScene();
  scene.layers = {FogOver(0.0, 0.01, 1000.0)};
  scene.lights = {LightAt(0.0, 0.0, kLampEye_m, 1000.0)};
  const LampSite around(scene);
  scene.lights = {SpotOf(scene.lights[0], 0.3, 0.6)};  // to the north
  const LampSite ahead(scene);
  for (const glm::dvec3& towards : {kNorth, glm::dvec3(std::sin(0.2), std::cos(0.2), 0.0)}) {
    EXPECT_GT(around.InAir(towards, 300.0, 16, 1e-3), 0.0);
    EXPECT_EQ(ahead.InAir(towards, 300.0, 16, 1e-3), around.InAir(towards, 300.0, 16, 1e-3))
        << "in the beam all along the ray";
  }
  EXPECT_EQ(ahead.InAir({1.0, 0.0, 0.0}, 300.0, 16, 1e-3), 0.0);
  const auto seen = [&](const glm::dvec3& towards) {
    return ahead.Luminance(ahead.light.Seen({0}, {kLampEye, kLampEye, towards, towards}, 1e-3));
  };
  EXPECT_EQ(seen(kNorth), 0.0);
  EXPECT_GT(seen(-kNorth), 0.0) << "looking into it";
}

/// Returns the illuminance of the eye by lamps near the middle of a picture of 320 x 180 pixels,
/// from `sub` x `sub` rays per pixel.
double IlluminanceInPicture(const LampSite& site, const LampLight& light, const CameraRays& camera,
                            int sub) {
  double sum = 0.0;
  for (int y = 70 * sub; y < 110 * sub; ++y) {
    for (int x = 140 * sub; x < 185 * sub; ++x) {
      const CameraRay ray = camera.Ray((x + 0.5) / sub, (y + 0.5) / sub, {0.5, 0.5});
      const double cosine = glm::dot(ray.through, camera.Direction(160.0, 90.0));
      sum += site.Luminance(light.Seen(light.All(), ray, camera.PixelAngle())) *
             std::pow(camera.PixelAngle() / sub, 2) * std::pow(cosine, 3);
    }
  }
  return sum;
}

TEST(LampLight, PicturesKeepTheIntensityAlsoThroughALens) {
  Scene scene = NightScene();
  scene.lights = {LightAt(500.0, 3.0, kLampEye_m, 1000.0)};
  const LampSite site(scene);
  const CameraRays pinhole(scene.camera, 320, 180, FrameTransform(kLampEye));
  EXPECT_NEAR(IlluminanceInPicture(site, site.light, pinhole, 2) / (1000.0 / (500.0 * 500.0)), 1.0,
              0.06)
      << "four rays a pixel sum a soft disk of 1.8 pixels; the air takes 1.5 %";
  const double sharp = IlluminanceInPicture(site, site.light, pinhole, 8);
  for (const int blades : {0, 6}) {
    scene.camera.lens = ThinLens{1.4, 0.085, 3.0, blades, 0.0};
    const CameraRays camera(scene.camera, 320, 180, FrameTransform(kLampEye));
    const LampLight light = site.light.SeenBy(camera);
    EXPECT_NEAR(IlluminanceInPicture(site, light, camera, 8) / sharp, 1.0, 0.01)
        << "sums over points, " << blades << " blades";
    // The middle is as bright as flux over area; the area of a hexagon is smaller than its circle.
    const glm::dvec3 to_lamp = site.PositionOf(scene.lights[0]) - kLampEye;
    const glm::dvec3 towards = glm::normalize(to_lamp);
    const double area = Iris(blades).area() * std::pow(camera.BlurRadius(to_lamp), 2);
    const Spectrum seen =
        light.Seen(light.All(), {kLampEye, kLampEye, towards, towards}, camera.PixelAngle());
    EXPECT_NEAR(site.Luminance(seen) * area / sharp, 1.0, 0.25)
        << blades << " blades: the edge is as soft as a pixel, the blur 4 pixels";
  }
}

TEST_F(LampShadows, AWallShadesTheGroundAndTheAirBehindIt) {
  Scene scene = WallScene();
  scene.layers = {FogOver(0.0, 0.005, std::numeric_limits<double>::infinity())};
  // The lamp is behind the wall and 80 m to the right, level with the middle of the wall.
  scene.lights = {LightAt(130.0, 80.0, 20.0, 1000.0)};
  const LampSite site(scene);
  const glm::dvec3 up(0.0, 0.0, 1.0);
  const auto on_ground = [&](const glm::dvec3& point) {
    return site.Luminance(site.light.OnSurface(site.light.All(), {point, point, up, up}));
  };
  EXPECT_GT(on_ground({-80.0, 160.0, 0.0}), 2.0 * on_ground({-80.0, 60.0, 0.0}))
      << "the wall stands between the lamp and the second point; air alone lights it";
  // The truth along a ray in front of the wall: 4000 short pieces, each tested for shadow.
  const glm::dvec3 eye(0.0, 0.0, 20.0), ray = glm::normalize(glm::dvec3(-0.5, 0.8, 0.05));
  Lamp lamp;
  lamp.position_m = site.PositionOf(scene.lights[0]);
  lamp.radius_m = 0.05;
  const LampAir air = HomogeneousAir(0.005, 0.005, scene.layers[0].phase);
  double lit = 0.0, whole = 0.0;
  constexpr int kPieces = 4000;
  for (int i = 0; i < kPieces; ++i) {
    const LampSegment piece{eye, ray, 200.0 * i / kPieces, 200.0 * (i + 1) / kPieces};
    const glm::dvec3 way = eye + 0.5 * (piece.begin_m + piece.end_m) * ray - lamp.position_m;
    const double light = 1000.0 * Airlight(air, lamp, piece, 2)[0];
    whole += light;
    if (!site.ground.terrain->Occluded(lamp.position_m, glm::normalize(way), way, glm::length(way)))
      lit += light;
  }
  EXPECT_LT(lit, 0.9 * whole) << "the wall shades part of the ray";
  EXPECT_GT(lit, 0.1 * whole);
  EXPECT_NEAR(site.InAir(ray, 200.0, 16) / lit, 1.0, 0.03)
      << "edges to 1/768 of the ray's angle, and the clear air";
}

// Hard case 42.
TEST_F(LampShadows, LampsAreHiddenByAWallAndRefusedBelowTheGround) {
  Scene scene = WallScene();
  scene.lights = {LightAt(130.0, 0.0, 10.0, 1000.0), LightAt(130.0, 80.0, 10.0, 1000.0)};
  const LampSite site(scene);
  const auto seen = [&](const Light& lamp) {
    const glm::dvec3 eye(0.0, 0.0, 20.0), to_lamp = glm::normalize(site.PositionOf(lamp) - eye);
    return site.Luminance(site.light.Seen(site.light.All(), {eye, eye, to_lamp, to_lamp}, 1e-3));
  };
  EXPECT_EQ(seen(scene.lights[0]), 0.0);
  EXPECT_GT(seen(scene.lights[1]), 0.0);
  scene.lights = {LightAt(50.0, 0.0, -5.0, 1000.0)};
  EXPECT_THROW(LampSite{scene}, InputError);
}

TEST(LampLight, FogDimsLightBehindIt) {
  Scene scene = NightScene();
  scene.layers = {FogOver(0.0, 0.01, 50.0)};
  const LampSite site(scene);
  const Spectrum level = site.light.LayerTransmittance(kNorth, 100.0);
  EXPECT_NEAR(static_cast<double>(level[0]), std::exp(-std::exp(-0.8)), 1e-4)
      << "a kilometre of fog at 40 m, which the sphere's curvature hardly changes";
  const Spectrum down = site.light.LayerTransmittance({0.0, 0.0, -1.0}, 40.0);
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
  const HdrImage night = renderer.Render(ParseInstant("2026-01-15T23:00:00Z"), settings);
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
  // Expects pictures of the lamps without impossible values.
  static void ExpectNumbers(const Scene& scene, const std::vector<std::string>& times) {
    const SceneRenderer renderer(scene);
    const RenderSettings settings{.width = 8,
                                  .height = 5,
                                  .samples_per_pixel = 2,
                                  .air_nodes = 4,
                                  .layers = {PictureLayer::kDepth, PictureLayer::kLamps}};
    for (const std::string& time : times)
      EXPECT_EQ(FaultyValue(renderer.Render(ParseInstant(time), settings)).value_or(""), "");
  }
  static Scene With(Light lamp) {
    Scene scene = NightScene();
    scene.medium = MediumPreset("bruneton2017");  // three bands are quick to prepare
    scene.lights = {std::move(lamp)};
    return scene;
  }
  Light Measured(const std::string& text) const {
    WriteText(folder_ / "lamp.ies", "IESNA:LM-63-2002\n" + text);
    Light lamp = point_;
    lamp.intensity_cd.reset();
    lamp.ies = folder_ / "lamp.ies";
    return lamp;
  }
  const Light point_ = LightAt(0.0, 0.0, kLampEye_m, 1000.0);
  const std::string night_ = "2026-01-15T23:00:00Z", day_ = "2026-06-21T11:00:00Z";
};

// Hard case 42.
TEST_F(LampsAtTheEye, GivePicturesOfFiniteNumbers) {
  ExpectNumbers(With(point_), {night_, day_});
  Light measured = Measured("TILT=NONE\n1 1000 1 3 1 1 2 0 0 0\n1 1 50\n0 45 90\n0\n1000 500 0\n");
  measured.intensity_cd = 1000.0;
  measured.pitch_rad = -0.5 * kPi;
  // A value of any lamp that is not a number makes the picture's one.
  Scene scene = With(measured);
  scene.lights.push_back(SpotOf(point_, 0.2, 0.4));
  scene.camera.lens = ThinLens{2.0, 0.05, 10.0};
  ExpectNumbers(scene, {night_});
  scene = With(point_);
  for (const double north_m : {5.0, -5.0})  // the middle of these lamps is at the eye
    scene.lights.push_back(LightAt(north_m, 0.0, kLampEye_m, 1000.0));
  scene.layers = {FogOver(0.0, 0.02, 100.0)};
  ExpectNumbers(scene, {night_, day_});  // the sun lights the fog too
}

TEST_F(LampsAtTheEye, AMeasuredLampIsTiltedByItsPitch) {
  Light light = Measured(
      "TILT=INCLUDE\n1\n2\n0 90\n1 0.6\n"
      "1 1000 1 2 1 1 2 0 0 0\n1 1 50\n0 180\n0\n1000 1000\n");
  const auto candela = [&](double pitch_rad) {
    light.pitch_rad = pitch_rad;
    const LampSite site(With(light));
    const LampStage lamps(site.scene, site.ground, site.medium);
    return PlacedOn(lamps, light, 0, MeasuredLampsOf(site.scene.lights)).candela;
  };
  EXPECT_NEAR(candela(-0.5 * kPi), 1000.0, 1e-6);
  EXPECT_NEAR(candela(-0.25 * kPi), 800.0, 1e-6);
  EXPECT_NEAR(candela(0.0), 600.0, 1e-6);
  EXPECT_THAT(
      tests::FaultOf([&] { return candela(0.25 * kPi); }),
      testing::EndsWith("lamp.ies is tilted by 135 degrees; its factors are for 0 to 90 degrees"));
}

/// Returns a night with nothing but fog in the air; the eye looks level to the north.
Scene FoggyNight(double scale_height_m = 30.0, double base_m = 0.0) {
  Scene scene = NightScene();
  scene.medium = tests::WithoutAir(MediumPreset("bruneton2017"));
  scene.layers = {FogOver(base_m, 0.01, scale_height_m)};
  return scene;
}

Light LampToTheNorth(double north_m, double candela) {
  Light lamp = LightAt(north_m, 0.0, kLampEye_m, candela);
  lamp.radius_m = 0.001;  // the smallest that a scene takes
  return lamp;
}

// Renders the lamps without the other lights of the night.
HdrImage Picture(const Scene& scene) {
  const EffectSet effects = EffectSet::All()
                                .Without(Effect::kMoonlight)
                                .Without(Effect::kNightSky)
                                .Without(Effect::kStars);
  return SceneRenderer(scene).Render(ParseInstant("2026-06-21T23:00:00Z"),
                                     {.width = 17,
                                      .height = 9,
                                      .samples_per_pixel = 1,
                                      .effects = effects,
                                      .layers = {PictureLayer::kLamps}});
}

double BrightestOf(const HdrImage& image) {
  double brightest = 0.0;
  for (const auto& rgb : image.rgb) {
    for (const float channel : rgb) {
      EXPECT_TRUE(std::isfinite(channel));
      brightest = std::max(brightest, static_cast<double>(channel));
    }
  }
  return brightest;
}

// Hard case 42.
TEST(LampExtremes, ALampWithoutIntensityChangesNoByte) {
  Scene scene = FoggyNight();
  const HdrImage dark = Picture(scene);
  scene.lights = {LampToTheNorth(30.0, 0.0), LampToTheNorth(-5.0, 0.0)};
  const HdrImage image = Picture(scene);
  EXPECT_EQ(image.rgb, dark.rgb);
  for (const ImageLayer& layer : image.layers) {
    for (const float value : layer.values) EXPECT_EQ(value, 0.0F) << layer.name;
  }
}

double FogOf(const LampSite& site, const glm::dvec3& direction) {
  return tests::FogByQuadrature(site.scene.layers[0], site.scene.lights[0],
                                site.PositionOf(site.scene.lights[0]),
                                {kLampEye, direction, 0.0, 100.0});
}

// Hard case 42.
TEST(LampExtremes, RaysThroughALampOrAMillimetreBesideItAreRight) {
  Scene scene = FoggyNight();
  scene.lights = {LampToTheNorth(30.0, 100.0)};
  const LampSite site(scene);
  const glm::dvec3 offset = site.PositionOf(scene.lights[0]) - kLampEye;
  for (const double beside_m : {0.0, 1e-4, 1e-3, 1e-2}) {
    const glm::dvec3 direction = glm::normalize(offset + glm::dvec3(beside_m, 0.0, 0.0));
    EXPECT_NEAR(site.InAir(direction, 100.0, 32) / FogOf(site, direction), 1.0, 2e-3)
        << beside_m << " m; 32 nodes a panel";
  }
  EXPECT_GT(BrightestOf(Picture(scene)), 0.0) << "the lamp stands in the middle of the picture";
}

// Hard case 42.
TEST(LampExtremes, ALampBehindTheEyeIsNotSeenAndLightsTheFogAhead) {
  for (const double behind_m : {2e-3, 1.0, 30.0}) {  // just outside of the sphere, and far
    Scene scene = FoggyNight();
    scene.lights = {LampToTheNorth(-behind_m, 100.0)};
    const LampSite site(scene);
    const double fog = site.InAir(kNorth, 100.0, 32);
    EXPECT_NEAR(fog / FogOf(site, kNorth), 1.0, 2e-3) << behind_m << " m; 32 nodes a panel";
    // The picture shows that fog and no lamp: it is as bright as the ray in the middle, within the
    // lobe of the fog.
    const double brightest = BrightestOf(Picture(scene));
    EXPECT_GT(brightest, 0.0) << behind_m;
    EXPECT_LT(brightest, 20.0 * fog) << behind_m;
  }
}

// The base of these fogs is so high that exp(base / scale height) overflows.
TEST(LampExtremes, FogOverAHighBaseIsLitAsFogOverTheGround) {
  constexpr double kBase_m = 5960.0;
  Scene high = FoggyNight(7.0, kBase_m);
  high.camera.height = {kBase_m + kLampEye_m, false};
  high.lights = {LampToTheNorth(30.0, 100.0)};
  high.lights[0].height = {kBase_m + 10.0, false};
  const LampSite site(high);
  const glm::dvec3 place = site.PositionOf(high.lights[0]) - glm::dvec3(0.0, 0.0, kBase_m);
  for (const double fall : {-0.8, -0.2, 0.0}) {
    const glm::dvec3 direction = glm::normalize(glm::dvec3(0.1, 1.0, fall));
    const double truth = tests::FogByQuadrature(high.layers[0], high.lights[0], place,
                                                {kLampEye, direction, 0.0, 50.0});
    EXPECT_NEAR(site.InAir(direction, 50.0, 32) / truth, 1.0, 5e-3) << fall;
  }
}

TEST(LampExtremes, ThePlanetHidesALampBeyondTheHorizon) {
  Scene scene = NightScene();
  scene.camera = CameraFromDegrees({2.0, false}, 0.0, 0.0, 0.0, 60.0);
  // Both horizons together are 10.1 km away.
  for (const double far_m : {9e3, 11e3, 100e3}) {
    scene.lights = {tests::LampNear(scene.place, far_m, 0.0, 2.0, 1e9)};
    const LampSite site(scene);
    const bool is_seen = far_m < 10e3;
    const CameraRays camera = CameraOn(site.ground, scene.camera, {}, 160, 90).middle();
    const LampLight light = site.light.SeenBy(camera);
    const glm::dvec3 to_lamp = glm::normalize(site.PositionOf(scene.lights[0]) - camera.eye());
    const Spectrum seen =
        light.Seen(light.All(), {camera.eye(), camera.eye(), to_lamp, to_lamp}, 1e-3);
    EXPECT_EQ(site.Luminance(seen) > 0.0, is_seen) << far_m;
    // Air along a ray to the sea is beyond the horizon of a far lamp.
    const double low = site.InAir({0.0, 1.0, -1e-3}, 2000.0, 12);
    EXPECT_EQ(low > 0.0, is_seen) << far_m;
    const double high = site.InAir(glm::normalize(glm::dvec3(0.0, 1.0, 0.05)), INFINITY, 12);
    EXPECT_GT(high, 0.0) << far_m << ": it lights the air above its horizon";
  }
}

TEST(LampExtremes, AirIsLitUnlessTheSeaHidesTheLamp) {
  Scene scene = NightScene();
  scene.lights = {tests::LampNear(scene.place, 40e3, 0.0, 2.0, 1e9)};
  const LampSite site(scene);
  const LampStage stage(scene, site.ground, site.medium);
  const glm::dvec3 lamp = site.PositionOf(scene.lights[0]);
  constexpr double kHorizon_m = 5048.0;  // of the lamp
  for (const double north_m : {1e3, 10e3, 20e3, 30e3}) {
    const double shadow_m = std::pow(40e3 - north_m - kHorizon_m, 2.0) / (2.0 * 6.378e6);
    for (const double off_m : {-2.0, 2.0}) {
      const Place place = PlaceFromRadians(scene.place.latitude_rad() + north_m / 6.371e6,
                                           scene.place.longitude_rad(), shadow_m + off_m);
      EXPECT_EQ(stage.Sees(lamp, site.ground.frame.EnuFromGeodetic(place).xyz), off_m > 0.0)
          << north_m << " m north";
    }
  }
}

TEST(LampExtremes, NoLampIsSeenThroughFogFarBelowItsBase) {
  Scene scene = FoggyNight(7.0, 5000.0);
  scene.lights = {LampToTheNorth(30.0, 100.0)};
  EXPECT_EQ(BrightestOf(Picture(scene)), 0.0);
  scene.camera = CameraFromDegrees({5200.0, false}, 0.0, -89.0, 0.0, 60.0);
  scene.lights = {LampToTheNorth(0.0, 1e6)};
  scene.lights[0].height = {5150.0, false};
  const double above = BrightestOf(Picture(scene));
  EXPECT_GT(above, 0.0) << "over the fog";
  scene.lights.push_back(LampToTheNorth(30.0, 1e6));
  EXPECT_NEAR(BrightestOf(Picture(scene)), above, 1e-5 * above) << "sums in single precision";
}

}  // namespace
}  // namespace alpenglow::renderer
