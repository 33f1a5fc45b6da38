// SPDX-License-Identifier: MIT
// Light of lamps on the graphics card, against the renderer's.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <random>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/ray/shell.h"
#include "renderer/illumination/lighting.h"
#include "renderer/lamps/lamp_light.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/lamp_site.h"
#include "tests/fixtures/sanitized.h"
#include "tests/renderer/lamps/ridge.h"
#include "tests/viewer/shaders/gpu_values.h"
#include "tests/viewer/shaders/headless.h"
#include "viewer/lamps/lamp_painter.h"
#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {
namespace {

constexpr double kLitPixel_rad = 1e-3;

Light LightAt(double north_m, double east_m, double height_m, double candela) {
  const Place place = BareScene(0.0, 0.0, 0.0, 40.0).place;
  Light light = tests::LampNear(place, north_m, east_m, height_m, candela);
  light.radius_m = 0.1;
  return light;
}

Light Spot(Light light, double heading_rad, double pitch_rad, double outer_rad) {
  light.type = Light::Type::kSpot;
  light.heading_rad = heading_rad;
  light.pitch_rad = pitch_rad;
  light.inner_rad = 0.5 * outer_rad;
  light.outer_rad = outer_rad;
  return light;
}

Scene Night(double eye_height_m, double fog_per_m, double fog_height_m) {
  Scene scene = BareScene(eye_height_m, 0.0, 0.0, 40.0);
  scene.lights = {LightAt(300.0, 10.0, 5.0, 1000.0), LightAt(20.0, -8.0, 1.0, 400.0),
                  LightAt(2500.0, 900.0, 40.0, 20000.0),
                  Spot(LightAt(400.0, -60.0, 30.0, 50000.0), 2.0, -0.2, 0.3)};
  if (fog_per_m > 0.0) {
    MediumLayer fog;
    fog.extinction_per_m = fog_per_m;
    fog.scale_height_m = fog_height_m;
    fog.base_height_m = 0.0;
    fog.phase = DropletPhase(12.0);
    scene.layers = {fog};
  }
  return scene;
}

/// The lamps of a scene as the renderer and as the GPU have them.
struct BothLamps : tests::LampSite {
  explicit BothLamps(const Scene& of) : BothLamps(of, LoadGround(of)) {}
  BothLamps(const Scene& of, SceneGround on)
      : LampSite(of, std::move(on)),
        lamps(scene, ground, medium),
        painter(lamps, {}, {}),
        eye_m(0.0, 0.0, ground.eye_height_m) {
    painter.Prepare(lamps, {FrameTransform(eye_m), eye_m.z, kLitPixel_rad}, 0.0);
  }

  [[nodiscard]] std::vector<float> OnGpu(const std::string& expression,
                                         const std::vector<tests::Arguments<float>>& points) const {
    return tests::EvaluateWithTexts(painter.texts(), expression, points,
                                    [&](const ShaderProgram& program) {
                                      painter.Connect(program);
                                      painter.Bind();
                                    });
  }

  SceneLamps lamps;
  LampPainter painter;
  glm::dvec3 eye_m;
};

/// Rays (x, y, z, length): half of them within a tenth of a radian of a lamp, lengths to the sky,
/// the ground, or some place before.
std::vector<tests::Arguments<float>> Rays(const BothLamps& both, int count,
                                          bool near_lamps = true) {
  std::mt19937 random(7);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<>(low, high)(random);
  };
  std::vector<tests::Arguments<float>> rays;
  const std::vector<glm::dvec3> lamps = both.light.Directions();
  while (static_cast<int>(rays.size()) < count) {
    glm::dvec3 way(uniform(-1.0, 1.0), uniform(-1.0, 1.0), uniform(-0.4, 0.6));
    if (near_lamps && rays.size() % 2 == 0) {
      way = lamps[rays.size() / 2 % lamps.size()] + std::pow(10.0, uniform(-4.0, -1.0)) * way;
    }
    way = glm::normalize(way);
    double length = rays.size() % 3 == 0 ? std::pow(10.0, uniform(1.0, 3.5)) : 1e9;
    if (way.z < 0.0) length = std::min(length, both.eye_m.z / -way.z);
    rays.push_back({static_cast<float>(way.x), static_cast<float>(way.y), static_cast<float>(way.z),
                    static_cast<float>(length)});
  }
  return rays;
}

glm::dvec3 DirectionOf(const tests::Arguments<float>& ray) {
  return glm::normalize(glm::dvec3(ray[0], ray[1], ray[2]));
}

struct Deviation {
  double mean, p99;
};
Deviation Of(std::vector<double> deviations) {
  std::sort(deviations.begin(), deviations.end());
  double sum = 0.0;
  for (const double deviation : deviations) sum += deviation;
  const auto count = static_cast<double>(deviations.size());
  return {sum / count, deviations[static_cast<std::size_t>(0.99 * (count - 1.0))]};
}
/// Relative to what is expected, of values worth the name.
Deviation Compare(const std::vector<float>& gpu, const std::vector<double>& truth) {
  const double least = 1e-7 * *std::max_element(truth.begin(), truth.end());
  std::vector<double> deviations;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (truth[i] > least) deviations.push_back(std::abs(double{gpu[i]} / truth[i] - 1.0));
  }
  return Of(std::move(deviations));
}

using LampsOnGpu = tests::Headless;

/// Returns the deviation in the middle band of the scene's air.
Deviation GlowDeviation(const BothLamps& both, bool near_lamps = true) {
  constexpr int kBand = 2;
  const auto rays = Rays(both, tests::ScaledDown(400, 150), near_lamps);
  const std::vector<float> gpu =
      both.OnGpu("LampAirlightIn(vec3(a[0], a[1], a[2]), a[3], 1.0)[2]", rays);
  std::vector<double> truth;
  for (const auto& ray : rays) {
    const LampRayEnd end{DirectionOf(ray), double{ray[3]}};
    truth.push_back(double{both.light.InAir(both.light.All(), end, kLitPixel_rad, 48)[kBand]});
  }
  return Compare(gpu, truth);
}

TEST_F(LampsOnGpu, GlowInClearAirAsInTheRenderer) {
  const Deviation deviation = GlowDeviation(BothLamps(Night(6.0, 0.0, 1.0)));
  EXPECT_LT(deviation.mean, 1e-3) << "12 nodes for four lamps, one a spot";
  EXPECT_LT(deviation.p99, 0.01);
}

TEST_F(LampsOnGpu, GlowInFogAsInTheRenderer) {
  constexpr double kBase_m = 18000.0;  // 720 scale heights up
  Scene high = Night(kBase_m + 6.0, 0.004, 25.0);
  for (Light& light : high.lights) light.height.value_m += kBase_m;
  high.layers[0].base_height_m = kBase_m;
  for (const auto& [where, scene] : {std::pair{"around", Night(6.0, 0.004, 25.0)},
                                     {"under", Night(300.0, 0.004, 25.0)},
                                     {"over a high base", high}}) {
    const Deviation deviation = GlowDeviation(BothLamps(scene));
    EXPECT_LT(deviation.mean, 4e-3) << where << ": fog of 25 m is thin where the rule looks for it";
    EXPECT_LT(deviation.p99, 0.06) << where;
  }
}

TEST_F(LampsOnGpu, FogFarBelowItsBaseIsOpaqueAndDark) {
  Scene scene = Night(6.0, 0.004, 7.0);
  scene.layers[0].base_height_m = 5000.0;
  const BothLamps both(scene);
  const auto rays = Rays(both, 100);
  for (const float glow :
       both.OnGpu("LampAirlightIn(vec3(a[0], a[1], a[2]), a[3], 1.0)[2]", rays)) {
    EXPECT_EQ(glow, 0.0F);
  }
  for (const float lit :
       both.OnGpu("LampsOnGround(vec3(a[0], a[1], -6.0), vec3(0.0, 0.0, 1.0), 0.1)[2]", rays)) {
    EXPECT_LT(lit, 1e-20F) << "the table of what air brings to the ground ends there";
  }
}

TEST_F(LampsOnGpu, AnEyeInsideALampSeesTheRenderersLight) {
  Scene scene = Night(6.0, 0.004, 25.0);
  scene.lights = {LightAt(0.0, 0.0, 6.0, 1000.0)};
  scene.lights[0].radius_m = 0.5;
  const BothLamps both(scene);
  const auto rays = Rays(both, 100);
  const std::vector<float> gpu =
      both.OnGpu("LampAirlightIn(vec3(a[0], a[1], a[2]), a[3], 1.0)[2]", rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const glm::dvec3 direction = DirectionOf(rays[i]);
    const LampRayEnd end{direction, double{rays[i][3]}};
    const CameraRay seen{
        .eye = both.eye_m, .origin = both.eye_m, .direction = direction, .through = direction};
    const double truth = double{both.light.InAir(both.light.All(), end, kLitPixel_rad, 48)[2]} +
                         double{both.light.Seen(both.light.All(), seen, kLitPixel_rad)[2]};
    EXPECT_NEAR(double{gpu[i]}, truth, 0.01 * truth);
  }
}

/// Points of the ground and normals, in the frame of the ground: (x, y, z, nx, ny, nz).
std::vector<tests::Arguments<float>> Points(int count, bool with_slopes) {
  std::mt19937 random(3);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<>(low, high)(random);
  };
  std::vector<tests::Arguments<float>> points;
  for (int i = 0; i < count; ++i) {
    const double far = std::pow(10.0, uniform(0.5, 3.3)), turn = uniform(-1.0, 1.0);
    const glm::dvec3 normal =
        !with_slopes ? glm::dvec3(0.0, 0.0, 1.0)
                     : glm::normalize(glm::dvec3(uniform(-0.5, 0.5), uniform(-0.5, 0.5), 1.0));
    points.push_back({static_cast<float>(far * std::sin(turn)),
                      static_cast<float>(far * std::cos(turn)), 0.0F, static_cast<float>(normal.x),
                      static_cast<float>(normal.y), static_cast<float>(normal.z)});
  }
  return points;
}

/// Relative to what level ground there gets.
Deviation GroundDeviation(const BothLamps& both, bool with_slopes) {
  std::vector<tests::Arguments<float>> points = Points(tests::ScaledDown(400, 150), with_slopes);
  std::vector<double> truth, level;
  for (auto& point : points) {
    const glm::dvec3 normal = glm::normalize(glm::dvec3(point[3], point[4], point[5]));
    const glm::dvec3 up(0.0, 0.0, 1.0);
    const glm::dvec3 place(point[0], point[1], point[2]);
    const LitPoint at{place, place, normal, normal}, on_level{place, place, up, up};
    truth.push_back(double{both.light.OnSurface(both.light.All(), at)[2]});
    level.push_back(double{both.light.OnSurface(both.light.All(), on_level)[2]});
    point[2] -= static_cast<float>(both.eye_m.z);
  }
  const std::vector<float> gpu =
      both.OnGpu("LampsOnGround(vec3(a[0], a[1], a[2]), vec3(a[3], a[4], a[5]), 0.1)[2]", points);
  std::vector<double> deviations;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    deviations.push_back(std::abs(double{gpu[i]} - truth[i]) / level[i]);
  }
  return Of(std::move(deviations));
}

TEST_F(LampsOnGpu, LightTheGroundAsInTheRenderer) {
  const BothLamps clear(Night(6.0, 0.0, 1.0)), fog(Night(6.0, 0.004, 25.0));
  EXPECT_LT(GroundDeviation(clear, false).p99, 0.01);
  const Deviation level = GroundDeviation(fog, false), slopes = GroundDeviation(fog, true);
  EXPECT_LT(level.mean, 0.01) << "its light in the fog comes from a map of LampAirlightIrradiance";
  EXPECT_LT(level.p99, 0.08);
  EXPECT_LT(slopes.mean, 0.04)
      << "six terms of light in the fog; LampAirlightIrradiance itself is off by 18 %";
  EXPECT_LT(slopes.p99, 0.2);
}

TEST_F(LampsOnGpu, LightDistantGroundAsInTheRenderer) {
  for (const double north_m : {15e3, 40e3, 100e3, 180e3}) {
    Scene scene = Night(6.0, 0.0, 1.0);
    scene.lights = {LightAt(north_m, 0.0, 40.0, 1e6)};
    const BothLamps both(scene);
    EXPECT_GT(both.light.OnSurface(both.light.All(), {.point = {0.0, 0.0, 0.0}})[2], 0.0F);
    EXPECT_LT(GroundDeviation(both, false).p99, 0.02) << north_m;
  }
}

TEST_F(LampsOnGpu, ARidgeShadesGroundAndAirBehindIt) {
  Scene scene = Night(6.0, 0.0, 1.0);
  scene.lights = {LightAt(400.0, 0.0, 5.0, 1000.0)};
  const BothLamps both(scene, Ridge(scene));
  std::vector<tests::Arguments<float>> points;
  std::vector<bool> lit;
  for (const float north_m : {0.0F, 30.0F, 60.0F, 240.0F, 300.0F, 390.0F, 450.0F, 550.0F}) {
    for (const float east_m : {-300.0F, -100.0F, 7.0F, 155.0F}) {
      points.push_back({east_m, north_m, static_cast<float>(-both.eye_m.z), 0.0F, 0.0F, 1.0F});
      const glm::dvec3 up(0.0, 0.0, 1.0);
      const glm::dvec3 place(east_m, north_m, 0.0);
      const LitPoint at{place, place, up, up};
      const double far = glm::length(both.light.At(0).lamp.position_m - at.point);
      const double direct = double{both.light.At(0).intensity[2]} * 5.0 / (far * far * far);
      lit.push_back(double{both.light.OnSurface(both.light.All(), at)[2]} > 0.5 * direct);
    }
  }
  const std::vector<float> shares =
      both.OnGpu("LampLit(lamps[0], vec3(a[0], a[1], a[2]) - lamps[0].position.xyz)", points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(double{shares[i]}, lit[i] ? 1.0 : 0.0, 1e-3)
        << points[i][0] << " m east, " << points[i][1] << " m north";
    EXPECT_EQ(lit[i], points[i][1] > 100.0F) << "the ridge stands between";
  }
  const std::vector<float> near =
      both.OnGpu("LampAirlightIn(vec3(0.0, 1.0, 0.0), 100.0, 1.0)[2]", points);
  std::vector<tests::Arguments<float>> ways;
  for (int i = 0; i < 24; ++i) {
    const double elevation = 0.4 + 0.02 * i;
    ways.push_back({0.0F, static_cast<float>(std::cos(elevation)),
                    static_cast<float>(std::sin(elevation)), 0.0F, 0.0F, 0.0F});
  }
  const std::vector<float> over =
      both.OnGpu("LampAirlightIn(vec3(a[0], a[1], a[2]), 1e9, 1.0)[2]", ways);
  const auto truth = [&](const glm::dvec3& way, double length_m) {
    return double{both.light.InAir(both.light.All(), {way, length_m}, kLitPixel_rad, 32)[2]};
  };
  double sum = 0.0, worst = 0.0;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const double is = truth({0.0, ways[i][1], ways[i][2]}, std::numeric_limits<double>::infinity());
    EXPECT_LT(double{near[0]}, 0.02 * is) << "air before the ridge is dark";
    EXPECT_LT(truth({0.0, 1.0, 0.0}, 100.0), 1e-9 * is);
    sum += std::abs(double{over[i]} / is - 1.0);
    worst = std::max(worst, std::abs(double{over[i]} / is - 1.0));
  }
  // Rings of the shade's map are a twentieth of the distance apart, and the aerosol is brightest
  // where the ray comes out of the shade.
  EXPECT_LT(sum / static_cast<double>(ways.size()), 0.04);
  EXPECT_LT(worst, 0.08) << "12 nodes find the edge of the shade";
}

TEST_F(LampsOnGpu, ThePlanetShadesTheAirBeyondItsHorizon) {
  Scene scene = Night(2.0, 0.0, 1.0);
  scene.lights = {LightAt(40e3, 0.0, 2.0, 1e9)};
  const BothLamps both(scene);
  const LampStage stage(both.scene, both.ground, both.medium);
  const glm::dvec3 lamp = both.light.At(0).lamp.position_m;
  std::vector<tests::Arguments<float>> points;
  std::vector<bool> lit;
  for (const double north_m : {1e3, 10e3, 20e3, 30e3}) {
    for (const double up_m : {0.0, 20.0, 150.0, 400.0}) {
      const glm::dvec3 from_eye(0.0, north_m, up_m);
      points.push_back({0.0F, static_cast<float>(north_m), static_cast<float>(up_m), 0, 0, 0});
      lit.push_back(stage.Sees(lamp, both.eye_m + from_eye));
    }
  }
  const std::vector<float> shares =
      both.OnGpu("LampLit(lamps[0], vec3(a[0], a[1], a[2]) - lamps[0].position.xyz)", points);
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_EQ(shares[i] > 0.5F, lit[i]) << points[i][1] << " " << points[i][2];
  const auto glow = [&](const glm::dvec3& way, double length_m) {
    const auto x = static_cast<float>(way.x), y = static_cast<float>(way.y),
               z = static_cast<float>(way.z), m = static_cast<float>(length_m);
    const double card = double{both.OnGpu("LampAirlightIn(vec3(a[0], a[1], a[2]), a[3], 1.0)[2]",
                                          {{x, y, z, m, 0.0F, 0.0F}})[0]};
    return std::array<double, 2>{
        card, double{both.light.InAir(both.light.All(), {way, length_m}, kLitPixel_rad, 32)[2]}};
  };
  const auto low = glow(glm::normalize(glm::dvec3(0.0, 1.0, -1e-3)), 2000.0);
  EXPECT_EQ(low[0], 0.0) << "air over the nearest sea";
  EXPECT_EQ(low[1], 0.0);
  const auto high = glow(glm::normalize(glm::dvec3(0.0, 1.0, 0.03)), 1e9);
  EXPECT_GT(high[1], 0.0);
  EXPECT_NEAR(high[0] / high[1], 1.0, 0.1) << "12 nodes find the edge of the shade";
}

/// Points of the surface around the ridge, seen from the eye.
std::vector<tests::Arguments<float>> OnRidge(const LampStage& stage, const glm::dvec3& eye_m) {
  std::mt19937 random(5);
  std::uniform_real_distribution<> away(-590.0, 590.0);
  std::vector<tests::Arguments<float>> points;
  for (int i = 0; i < 3000; ++i) {
    const glm::dvec3 at(away(random), away(random), 0.0);
    points.push_back({static_cast<float>(at.x), static_cast<float>(at.y),
                      static_cast<float>(stage.TerrainUnder(at, 0.0) - eye_m.z)});
  }
  return points;
}

TEST_F(LampsOnGpu, GroundIsLitWhereShadowRaysReachTheLamp) {
  Scene scene = Night(6.0, 0.0, 1.0);
  scene.lights = {LightAt(400.0, 0.0, 5.0, 1000.0)};
  BothLamps both(scene, Ridge(scene));
  const LampStage stage(both.scene, both.ground, both.medium);
  const std::vector<tests::Arguments<float>> points = OnRidge(stage, both.eye_m);
  const auto wrong = [&] {
    const std::vector<float> lit = both.OnGpu(
        "LampLitGround(lamps[0], vec3(a[0], a[1], a[2]) - lamps[0].position.xyz, 0.001)", points);
    std::size_t count = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto hit = stage.TerrainAt({points[i][0], points[i][1], 0.0});
      const bool is_lit =
          !stage.Shades(both.light.At(0).lamp, hit->hit.smooth_point, hit->hit.geometric_normal);
      count += (lit[i] > 0.5F) != is_lit ? 1 : 0;
    }
    return static_cast<double>(count) / static_cast<double>(points.size());
  };
  EXPECT_GT(wrong(), 4e-3) << "the horizon around the lamp, while plans are made";
  both.lamps.WaitForPlans();
  both.painter.Prepare(both.lamps, {FrameTransform(both.eye_m), both.eye_m.z, kLitPixel_rad}, 0.0);
  EXPECT_LT(wrong(), 2e-3) << "corners of shade";
}

TEST_F(LampsOnGpu, AMeasuredLampLightsTheGroundAsInTheRenderer) {
  Scene scene = Night(6.0, 0.0, 1.0);
  const BothLamps both(scene);
  LampProfile profile;
  profile.kind = LampProfile::Kind::kTable;
  profile.table = {{0.0, 0.3, 0.6, 1.5},
                   {0.0, 1.0, 3.0},
                   {1.0, 0.8, 0.2, 0.0, 0.9, 0.9, 0.4, 0.0, 0.5, 0.2, 0.1, 0.0}};
  const std::vector<float> samples = SampledProfile(profile);
  for (int turn = 0; turn < kLampTurns; turn += 7) {
    const double c = 2.0 * 3.14159265358979 * turn / (kLampTurns - 1);
    const double gamma = 3.14159265358979 * 40 / (kLampGammas - 1);
    EXPECT_NEAR(double{samples[static_cast<std::size_t>(turn * kLampGammas + 40)]},
                RelativeIntensity(profile, {std::cos(gamma), std::sin(gamma) * std::cos(c),
                                            std::sin(gamma) * std::sin(c)}),
                1e-6);
  }
}

TEST_F(LampsOnGpu, SixtyFourNodesShineLikeManyLamps) {
  Scene scene = Night(6.0, 0.0, 1.0);
  scene.lights.clear();
  constexpr int kLamps = tests::ScaledDown(300, 150);
  for (int i = 0; i < kLamps; ++i) {
    scene.lights.push_back(LightAt(200.0 + 30.0 * (i / 2), i % 2 == 0 ? 20.0 : -20.0, 0.5, 500.0));
  }
  BothLamps both(scene);
  const SceneLamps::InView in_view =
      both.lamps.Before({FrameTransform(both.eye_m), both.eye_m.z, kLitPixel_rad}, {0.0, 0.0}, 0.0);
  EXPECT_EQ(in_view.block.count.x, 64.0F);
  EXPECT_EQ(in_view.disks.size(), std::size_t{kLamps}) << "each lamp itself is seen";
  EXPECT_LT(GlowDeviation(both, false).mean, 0.02)
      << "in all directions; close to one of the lamps that a node stands for its own glow is "
         "missing";
}

TEST(LampView, OfADistantEyeUsesEastNorthUpThere) {
  const LocalFrame ground(kWgs84, Place{46.5, 8.0, 0.0});
  const Place place{47.0, 9.0, 1000.0};
  const LampView view = LampViewFrom(ground, place, kLitPixel_rad);
  EXPECT_LT(glm::length(view.from_eye.origin_m() - ground.EnuFromGeodetic(place).xyz), 1e-6);
  const glm::dvec3 up =
      ground.EnuFromGeodetic(Place{47.0, 9.0, 2000.0}).xyz - view.from_eye.origin_m();
  EXPECT_NEAR(view.from_eye.AlongBack(up).z, 1000.0, 1e-3)
      << "a kilometre over the eye is up there";
}

TEST_F(LampsOnGpu, ALandingLightMovesWithTheEye) {
  BothLamps both(Night(6.0, 0.0, 1.0));
  LandingLight landing;
  both.lamps.SetLandingLight(landing);
  for (const double north_m : {0.0, 5000.0}) {
    const LampView view{FrameTransform({0.0, north_m, 6.0}), 6.0, kLitPixel_rad};
    const SceneLamps::InView in_view = both.lamps.Before(view, {0.0, 0.0}, 1.0);
    const auto number = static_cast<std::size_t>(in_view.block.count.w);
    const GpuLamp& lamp = in_view.block.lamps[number];
    EXPECT_NEAR(lamp.position.z, -1.5F, 1e-4F) << "the first that does not shine evenly";
    EXPECT_NEAR(lamp.position.y, 0.0F, 1e-4F);
    EXPECT_EQ(lamp.axis.y, 1.0F);
  }
}

TEST(LampShadowFieldFollower, MakesEveryPlanOnceAndInOrder) {
  std::atomic<int> made = 0;
  LampShadowFieldFollower follower(5, [&](std::size_t number) {
    ++made;
    return LampShadowField{static_cast<int>(number), {}};
  });
  EXPECT_TRUE(follower.plans().empty()) << "nothing is made before it is asked for";
  follower.WaitUntilReady();
  follower.Follow();
  follower.WaitUntilReady();
  ASSERT_EQ(follower.plans().size(), 5U);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(follower.plans()[static_cast<std::size_t>(i)].levels, i);
  EXPECT_EQ(made, 5);
}

TEST(LampShadowFieldFollower, IsReadyAtOnceWithoutLamps) {
  LampShadowFieldFollower follower(0, [](std::size_t) { return LampShadowField{}; });
  follower.WaitUntilReady();
  EXPECT_TRUE(follower.plans().empty());
}

// --- lamps in a picture: their light from a lattice and from their cores, against that of every pixel ---

using LampPicture = tests::Headless;

constexpr int kGlowWidth = 320, kGlowHeight = 180;
constexpr double kHalfWidth = 0.45;  // tangent of half the field of view
constexpr double kLampPixel_rad = 2.0 * kHalfWidth / kGlowWidth;

constexpr const char* kStage = R"(
in vec2 screen;
out vec4 picture;
void main() {
  vec3 direction = normalize(view_forward.xyz + screen.x * view_right.xyz + screen.y * view_up.xyz);
  picture = vec4(LampAirlightRgb(direction, LampRayEnd(direction, 0.0)), 1.0);
}
)";

/// A runway's edge in light fog before an eye that looks north from its end.
Scene Runway() {
  Scene scene = BareScene(6.0, 0.0, 0.0, 40.0);
  for (int i = 0; i < 8; ++i) {
    Light light;
    light.place = PlaceFromRadians(
        scene.place.latitude_rad() + (80.0 + 60.0 * (i / 2)) / 6371e3,
        scene.place.longitude_rad() + (i % 2 == 0 ? 20.0 : -20.0) / (6371e3 * std::cos(0.81)), 0.0);
    light.height = {0.5, false};
    light.intensity_cd = 600.0;
    scene.lights.push_back(light);
  }
  MediumLayer fog;
  fog.extinction_per_m = 0.004;
  fog.scale_height_m = 25.0;
  fog.base_height_m = 0.0;
  fog.phase = DropletPhase(12.0);
  scene.layers = {fog};
  return scene;
}

struct LampNight {
  Scene scene = Runway();
  SceneGround ground = LoadGround(scene);
  SceneLamps lamps{scene, ground, scene.medium};

  [[nodiscard]] HdrImage Paint(const LampQuality& quality) {
    const GlBuffer view_buffer;
    ViewBlock view{};
    view.view_right = {kHalfWidth, 0.0, 0.0, 0.0};
    view.view_up = {0.0, 0.0, kHalfWidth * kGlowHeight / kGlowWidth, 0.0};
    view.view_forward = {0.0, 1.0, 0.0, 0.0};
    glBindBufferBase(GL_UNIFORM_BUFFER, 1, view_buffer.id());
    glBufferData(GL_UNIFORM_BUFFER, sizeof(view), &view, GL_STATIC_DRAW);
    const RenderTarget surface(kGlowWidth, kGlowHeight, RenderTarget::Depth::kNone);
    surface.Bind();
    glClearColor(0.0F, 0.0F, 0.0F, 0.0F);
    glClear(GL_COLOR_BUFFER_BIT);
    LampPainter painter(lamps, quality, {});
    painter.Prepare(lamps, {FrameTransform({0.0, 0.0, 6.0}), 6.0, kLampPixel_rad}, 0.0);
    std::vector<ShaderPiece> texts =
        WithViewerPieces(SharedTexts(), {"viewer/shaders/view/block.glsl"});
    texts.insert(texts.end(), painter.texts().begin(), painter.texts().end());
    texts.push_back({"stage", kStage});
    const ShaderProgram program = FullScreenProgram(texts);
    painter.Connect(program);
    surface.BindTexture(0);
    painter.PaintGlow(kGlowWidth, kGlowHeight);
    const RenderTarget picture(kGlowWidth, kGlowHeight, RenderTarget::Depth::kNone);
    picture.Bind();
    painter.Bind();
    DrawFullScreen(program, GlVertexArray());
    painter.PaintOver(kLampPixel_rad);
    return picture.Read();
  }
};

glm::dvec3 DirectionOf(int x, int y) {
  const double right = kHalfWidth * ((2.0 * x + 1.0) / kGlowWidth - 1.0);
  const double up = kHalfWidth * (kGlowHeight - 2.0 * y - 1.0) / kGlowWidth;
  return glm::normalize(glm::dvec3(right, 1.0, up));
}

constexpr int kEvery = tests::ScaledDown(3, 5);

/// By every third pixel each way; by every fifth under the sanitizers.
std::vector<double> Deviations(const HdrImage& image,
                               const std::function<double(int x, int y)>& truth) {
  std::vector<double> deviations;
  for (int y = 1; y < kGlowHeight; y += kEvery) {
    for (int x = 1; x < kGlowWidth; x += kEvery) {
      deviations.push_back(std::abs(double{image.at(x, y)[1]} / truth(x, y) - 1.0));
    }
  }
  std::sort(deviations.begin(), deviations.end());
  return deviations;
}

double Mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

TEST_F(LampPicture, LampsAndGlowEqualTheRenderersInEveryPixel) {
  LampNight night;
  const BandColour colour(night.scene.medium.wavelengths_nm);
  const LampLight light(night.scene, night.ground, night.scene.medium, colour);
  const auto truth = [&](int x, int y) {
    const glm::dvec3 direction = DirectionOf(x, y);
    LampRayEnd end{direction, std::numeric_limits<double>::infinity()};
    if (direction.z < -2e-3) {
      const double h = 6e-3, radius = night.scene.medium.planet_radius_m / 1000.0;
      end.length_m = 1e3 * shared::DistanceDownTo(h, direction.z, 0.0, radius);
    }
    const CameraRay ray{{0.0, 0.0, 6.0}, {0.0, 0.0, 6.0}, direction, direction};
    const Spectrum sum = light.InAir(light.All(), end, kLampPixel_rad, 32) +
                         light.Seen(light.All(), ray, kLampPixel_rad);
    const std::vector<double> values(sum.values().begin(), sum.values().begin() + 4);
    return colour.LinearSrgb(values)[1];
  };
  const std::vector<double> deviations = Deviations(night.Paint({.nodes = 12, .step = 1}), truth);
  EXPECT_LT(Mean(deviations), 5e-3);
  EXPECT_LT(deviations[deviations.size() * 999 / 1000], 0.02);
}

TEST_F(LampPicture, ALatticeOfEverySecondPixelGivesTheWholePicture) {
  LampNight night;
  const HdrImage whole = night.Paint({.nodes = 12, .step = 1});
  const std::vector<double> deviations =
      Deviations(night.Paint({.nodes = 12, .step = 2}),
                 [&](int x, int y) { return double{whole.at(x, y)[1]}; });
  EXPECT_LT(deviations[deviations.size() / 2], 2e-3);
  EXPECT_LT(Mean(deviations), 0.015);
  EXPECT_LT(deviations[deviations.size() * 99 / 100], 0.02)
      << "two pixels here are eight of a picture of 720 lines";
}

}  // namespace
}  // namespace alpenglow::viewer
