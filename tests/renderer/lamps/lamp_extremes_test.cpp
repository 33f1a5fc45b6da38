// SPDX-License-Identifier: MIT
// Lamps where formulas divide by nothing: on the ray, behind the eye, without light.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "atmosphere/reference/airlight_reference.h"
#include "renderer/lamps/lamp_light.h"
#include "renderer/picture/render.h"
#include "tests/fixtures/bare_scene.h"

namespace alpenglow::renderer {
namespace {

constexpr double kEyeHeight_m = 40.0;
const UtcInstant kNight = ParseInstant("2026-06-21T23:00:00Z");

/// A foggy night with nothing but fog in the air; the eye looks level to the north.
Scene FoggyNight() {
  Scene scene = BareScene(kEyeHeight_m, 0.0, 0.0, 40.0);
  for (auto* list : {&scene.medium.rayleigh_scattering_per_m, &scene.medium.mie_scattering_per_m,
                     &scene.medium.mie_extinction_per_m, &scene.medium.ozone_absorption_per_m})
    std::fill(list->begin(), list->end(), 0.0);
  Fog fog;
  fog.extinction_per_m = 0.01;
  fog.scale_height_m = 30.0;
  fog.base_height_m = 0.0;
  fog.phase = {.kind = PhaseKind::kHenyeyGreenstein, .g = 0.8};
  scene.fog = fog;
  return scene;
}

Light LampToTheNorth(double north_m, double candela) {
  const Scene scene = FoggyNight();
  Light light;
  light.latitude_rad = scene.place.latitude_rad + north_m / 6.37e6;
  light.longitude_rad = scene.place.longitude_rad;
  light.height = {kEyeHeight_m, false};
  light.intensity_cd = candela;
  light.radius_m = 0.001;  // the smallest that a scene takes
  return light;
}

// With the lamps alone: without what else shines at night.
Image Picture(const Scene& scene) {
  const EffectSet effects = EffectSet::All()
                                .Without(Effect::kMoonlight)
                                .Without(Effect::kNightSky)
                                .Without(Effect::kStars);
  return SceneRenderer(scene).Render(kNight, {.width = 17,
                                              .height = 9,
                                              .samples_per_pixel = 1,
                                              .effects = effects,
                                              .layers = {PictureLayer::kLamps}});
}

double BrightestOf(const Image& image) {
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
  const Image dark = Picture(scene);
  scene.lights = {LampToTheNorth(30.0, 0.0), LampToTheNorth(-5.0, 0.0)};
  const Image image = Picture(scene);
  EXPECT_EQ(image.rgb, dark.rgb);
  for (const Channel& layer : image.layers) {
    for (const float value : layer.values) EXPECT_EQ(value, 0.0F) << layer.name;
  }
}

/// Luminance [cd/m^2] that the lamp gives the air along a ray of 100 m.
struct AirOf {
  explicit AirOf(const Scene& of)
      : scene(of),
        ground(LoadGround(scene)),
        medium(OnOsculatingSphere(scene.medium, scene.place.latitude_rad)),
        colour(medium.wavelengths_nm),
        light(scene, ground, medium, colour) {}

  [[nodiscard]] double Along(const glm::dvec3& direction) const {
    const Bands<float> bands = light.InAir(light.All(), {direction, 100.0}, 0.0, 32);
    const std::vector<double> values(
        bands.value.begin(), bands.value.begin() + static_cast<std::ptrdiff_t>(bands.count));
    return colour.Xyz(values)[1];
  }
  [[nodiscard]] glm::dvec3 Place() const {
    const Light& lamp = scene.lights[0];
    return ground.frame
        .EnuFromGeodetic({lamp.latitude_rad, lamp.longitude_rad, lamp.height.value_m})
        .xyz;
  }
  /// The same by quadrature.
  [[nodiscard]] double ByTheReference(const glm::dvec3& direction) const {
    Lamp lamp;
    lamp.position_m = Place();
    lamp.radius_m = scene.lights[0].radius_m;
    LampAir fog = HomogeneousAir(0.01, 0.01, scene.fog->phase);
    fog.layers[0].scale_height_m = 30.0;
    const LampSegment segment{{0.0, 0.0, kEyeHeight_m}, direction, 0.0, 100.0};
    return *scene.lights[0].intensity_cd * reference::AirlightAlong(fog, lamp, segment).radiance[0];
  }

  Scene scene;
  SceneGround ground;
  Medium medium;
  BandColour colour;
  LampLight light;
};

// Hard case 42.
TEST(LampExtremes, ARayThroughALampAndOneAMillimetreBesideItAreFiniteAndRight) {
  Scene scene = FoggyNight();
  scene.lights = {LampToTheNorth(30.0, 100.0)};
  const AirOf air(scene);
  const glm::dvec3 offset = air.Place() - glm::dvec3(0.0, 0.0, kEyeHeight_m);
  for (const double beside_m : {0.0, 1e-4, 1e-3, 1e-2}) {
    const glm::dvec3 direction = glm::normalize(offset + glm::dvec3(beside_m, 0.0, 0.0));
    const double found = air.Along(direction);
    EXPECT_TRUE(std::isfinite(found)) << beside_m;
    EXPECT_NEAR(found / air.ByTheReference(direction), 1.0, 2e-3)
        << beside_m << " m; 32 nodes a panel";
  }
  EXPECT_GT(BrightestOf(Picture(scene)), 0.0) << "the lamp stands in the middle of the picture";
}

// Hard case 42.
TEST(LampExtremes, ALampBehindTheEyeIsNotSeenAndLightsTheFogBeforeIt) {
  for (const double behind_m : {2e-3, 1.0, 30.0}) {  // just outside of the sphere, and far
    Scene scene = FoggyNight();
    scene.lights = {LampToTheNorth(-behind_m, 100.0)};
    const AirOf air(scene);
    const glm::dvec3 north(0.0, 1.0, 0.0);
    const double fog = air.Along(north);
    EXPECT_NEAR(fog / air.ByTheReference(north), 1.0, 2e-3) << behind_m << " m; 32 nodes a panel";
    // What is seen is that fog, no lamp: as bright as at the ray in the middle, give and take the
    // lobe of the fog.
    const double brightest = BrightestOf(Picture(scene));
    EXPECT_GT(brightest, 0.0) << behind_m;
    EXPECT_LT(brightest, 20.0 * fog) << behind_m;
  }
}

/// Fog of a scale height of 7 m; its base is so far up that exp(base / scale height) overflows.
Scene FoggyNightWithBaseAt(double base_m) {
  Scene scene = FoggyNight();
  scene.fog->scale_height_m = 7.0;
  scene.fog->base_height_m = base_m;
  return scene;
}

TEST(LampExtremes, FogOverAHighBaseIsLitAsTheSameFogOverTheGround) {
  constexpr double kBase_m = 5960.0;
  Scene high = FoggyNightWithBaseAt(kBase_m);
  high.camera.height = {kBase_m + kEyeHeight_m, false};
  high.lights = {LampToTheNorth(30.0, 100.0)};
  high.lights[0].height = {kBase_m + 10.0, false};
  const AirOf air(high);
  Lamp lamp;
  lamp.position_m = air.Place() - glm::dvec3(0.0, 0.0, kBase_m);
  lamp.radius_m = high.lights[0].radius_m;
  LampAir fog = HomogeneousAir(0.01, 0.01, high.fog->phase);
  fog.layers[0].scale_height_m = 7.0;
  for (const double fall : {-0.8, -0.2, 0.0}) {
    const glm::dvec3 direction = glm::normalize(glm::dvec3(0.1, 1.0, fall));
    const LampSegment segment{{0.0, 0.0, kEyeHeight_m}, direction, 0.0, 50.0};
    const LampRayEnd end{direction, 50.0};
    const double truth = 100.0 * reference::AirlightAlong(fog, lamp, segment).radiance[0];
    const Bands<float> bands = air.light.InAir(air.light.All(), end, 0.0, 32);
    const std::vector<double> values(
        bands.value.begin(), bands.value.begin() + static_cast<std::ptrdiff_t>(bands.count));
    EXPECT_NEAR(air.colour.Xyz(values)[1] / truth, 1.0, 5e-3) << fall;
  }
}

TEST(LampExtremes, FogFarBelowItsBaseIsAWallThatNoLampShinesThrough) {
  Scene scene = FoggyNightWithBaseAt(5000.0);
  scene.lights = {LampToTheNorth(30.0, 100.0)};
  EXPECT_EQ(BrightestOf(Picture(scene)), 0.0);
}

TEST(LampExtremes, AnEyeOverFogOfAHighBaseSeesNoLampUnderIt) {
  Scene scene = FoggyNightWithBaseAt(5000.0);
  scene.camera = CameraFromDegrees({5200.0, false}, 0.0, -89.0, 0.0, 60.0);
  scene.lights = {LampToTheNorth(30.0, 1e6), LampToTheNorth(0.0, 1e6)};
  scene.lights[1].height = {5150.0, false};
  const double with_both = BrightestOf(Picture(scene));
  EXPECT_GT(with_both, 0.0);
  scene.lights.erase(scene.lights.begin());
  EXPECT_NEAR(BrightestOf(Picture(scene)), with_both, 1e-5 * with_both)
      << "sums in single precision";
}

}  // namespace
}  // namespace alpenglow::renderer
