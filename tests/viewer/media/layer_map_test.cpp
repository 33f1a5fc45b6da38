// SPDX-License-Identifier: MIT
// Light of sun and sky in a layer on the graphics card, against the renderer's.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <random>

#include "atmosphere/ray/shell.h"
#include "renderer/media/media_light.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/solved_media.h"
#include "tests/viewer/shaders/gpu_values.h"
#include "tests/viewer/shaders/headless.h"
#include "viewer/media/scene_layer.h"

namespace alpenglow::viewer {
namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();
constexpr double kLayerSunRadius_rad = 0.00465;

glm::dvec3 ToSun(double elevation_rad) {
  return {0.6 * std::cos(elevation_rad), 0.8 * std::cos(elevation_rad), std::sin(elevation_rad)};
}
const glm::dvec3 kToSun = ToSun(0.5);

/// Air and ground around an eye over the bare ellipsoid, in three bands.
struct Stage {
  Scene scene = [] {
    Scene bare = BareScene(10.0, 0.0, 0.0, 60.0);
    bare.medium = MediumPreset("bruneton2017");
    return bare;
  }();
  SceneGround ground = LoadGround(scene);
  SceneGeometry geometry{ground, scene.medium, false};
  SolvedAir air = tests::SolvedAsClearAir(scene.medium);

  [[nodiscard]] Lighting Under(const glm::dvec3& to_sun) const {
    SunInSky sun;
    sun.distance_au = 1.0;
    Lighting at =
        LightingOf(sun, UtcTime{60000, 0.0}, PlaceFromRadians(0.8, 0.0, 0.0), scene.medium);
    at.source.direction = Unrefracted(to_sun);
    at.source.radius_rad = kLayerSunRadius_rad;
    return at;
  }
};

const Stage& TheStage() {
  static const Stage kStage;
  return kStage;
}

std::shared_ptr<const ExponentialLayer> DropletsOf(double per_m, double height_m, double base_m) {
  const Medium& medium = TheStage().scene.medium;
  MediumOptics optics{SpectrumOf<double>(3), SpectrumOf<double>(3), SpectrumOf<double>(3),
                      DropletPhase(14.0)};
  for (std::size_t band = 0; band < 3; ++band) {
    optics.extinction_per_m[band] = optics.scattering_per_m[band] = per_m;
  }
  return std::make_shared<const ExponentialLayer>(
      LayerShape{base_m, height_m, medium.planet_radius_m, medium.atmosphere_height_m,
                 std::nullopt},
      optics);
}

/// A layer before an eye, as the renderer has it and as the graphics card does.
struct BothLayers {
  BothLayers(const std::shared_ptr<const ExponentialLayer>& layer, double eye_m,
             const glm::dvec3& to_sun = kToSun)
      : eye(0.0, 0.0, eye_m),
        media({layer}, 3),
        light(TheStage().Under(to_sun)),
        renderer(media, TheStage().geometry, TheStage().air, light),
        map(MakeLayerMap(*layer, TheStage().air,
                         {eye_m, Unrefracted(to_sun), kLayerSunRadius_rad})),
        painter({}) {
    painter.Upload(map);
  }

  [[nodiscard]] std::vector<float> OnGpu(const std::string& expression,
                                         const std::vector<tests::Arguments<float>>& points) const {
    std::vector<ShaderPiece> pieces = SharedTexts();
    for (const ShaderPiece& piece : LayerTexts()) pieces.push_back(piece);
    return tests::EvaluateOnGpu(pieces, expression, points, [&](const ShaderProgram& program) {
      painter.Connect(program);
      painter.Bind(map, map.eye, painter, map.eye);
    });
  }

  glm::dvec3 eye;
  LocalMedia media;
  Lighting light;
  MediaLight renderer;
  LayerMap map;
  LayerPainter painter;
};

/// Directions of a picture and lengths [km]: to the sky, to the planet, or to somewhere before.
std::vector<tests::Arguments<float>> Rays(const BothLayers& both, int count) {
  std::mt19937 random(5);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<>(low, high)(random);
  };
  const double radius = TheStage().scene.medium.planet_radius_m;
  std::vector<tests::Arguments<float>> rays;
  while (static_cast<int>(rays.size()) < count) {
    const glm::dvec3 way =
        glm::normalize(glm::dvec3(uniform(-1.0, 1.0), uniform(-1.0, 1.0), uniform(-0.5, 0.5)));
    double length = rays.size() % 2 == 0 ? std::pow(10.0, uniform(1.5, 4.0)) : 1e9;
    if (shared::GroundClearance(both.eye.z, way.z, radius) > 0.0) {
      length = std::min(length, shared::DistanceDownTo(both.eye.z, way.z, 0.0, radius));
    }
    rays.push_back({static_cast<float>(way.x), static_cast<float>(way.y), static_cast<float>(way.z),
                    static_cast<float>(length / 1000.0)});
  }
  return rays;
}

struct LayerDeviation {
  double mean, p99, of_transmittance;
};

// Deviations count where the radiance is at least a tenth of the brightest.
LayerDeviation Compared(const BothLayers& both) {
  const auto rays = Rays(both, tests::ScaledDown(300, 120));
  const std::vector<float> gpu =
      both.OnGpu("MediaTo(vec3(a[0], a[1], a[2]), a[3]).radiance[1]", rays);
  const std::vector<float> left =
      both.OnGpu("MediaTransmittance(vec3(a[0], a[1], a[2]), a[3])", rays);
  std::vector<double> deviations;
  double largest = 0.0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const glm::dvec3 way = glm::normalize(glm::dvec3(rays[i][0], rays[i][1], rays[i][2]));
    const double length = rays[i][3] > 1e5F ? kEndless : 1000.0 * double{rays[i][3]};
    const MarchedLight march = both.renderer.Along(both.eye, way, length, nullptr, 2e-4);
    largest = std::max(largest, std::abs(double{left[i]} - double{march.transmittance[1]}));
    const double truth = double{march.radiance[1]} / double{both.light.source.irradiance[1]};
    if (march.transmittance[1] < 0.9F) {
      deviations.push_back(std::abs(double{gpu[i]} / truth - 1.0));
    }
  }
  std::sort(deviations.begin(), deviations.end());
  double sum = 0.0;
  for (const double deviation : deviations) sum += deviation;
  return {sum / static_cast<double>(deviations.size()), deviations[deviations.size() * 99 / 100],
          largest};
}

using LayerOnGpu = tests::Headless;

TEST_F(LayerOnGpu, EqualsTheRenderersAtAnyAltitude) {
  struct Case {
    const char* where;
    std::shared_ptr<const ExponentialLayer> layer;
    double eye_m;
  };
  for (const Case& c : {Case{"around the eye", DropletsOf(0.02, 60.0, 0.0), 10.0},
                        Case{"under the eye", DropletsOf(0.02, 60.0, 0.0), 500.0},
                        Case{"over the eye", DropletsOf(0.002, 80.0, 300.0), 250.0},
                        Case{"without an end above", DropletsOf(1e-4, kEndless, 0.0), 100.0}}) {
    const LayerDeviation deviation = Compared(BothLayers(c.layer, c.eye_m));
    EXPECT_LT(deviation.mean, 2e-3) << c.where;
    EXPECT_LT(deviation.p99, 0.02) << c.where;
    EXPECT_LT(deviation.of_transmittance, 2e-3) << c.where << ": columns of thin layers in float";
  }
}

TEST_F(LayerOnGpu, EqualsTheRenderersAtSunsetAndAfter) {
  for (const double elevation_rad : {0.0, -0.05}) {
    const LayerDeviation deviation =
        Compared(BothLayers(DropletsOf(0.02, 60.0, 0.0), 10.0, ToSun(elevation_rad)));
    EXPECT_LT(deviation.mean, 5e-3) << "light falls by e every few metres into the layer";
    EXPECT_LT(deviation.p99, 0.05);
  }
}

TEST_F(LayerOnGpu, LeavesAsMuchLightOnTheGroundAsTheRenderer) {
  const BothLayers both(DropletsOf(0.02, 60.0, 0.0), 10.0);
  std::vector<tests::Arguments<float>> points;
  for (const double altitude : {1.0, 20.0, 60.0, 150.0, 400.0}) {
    for (const double cos_up : {1.0, 0.9, 0.5}) {
      points.push_back({static_cast<float>(altitude / 1000.0), static_cast<float>(cos_up)});
    }
  }
  const std::vector<float> sun =
      both.OnGpu("SunLeftByMedia(a[0], " + std::to_string(both.map.eye.light.seen.z) + ")", points);
  const std::vector<float> sky = both.OnGpu("SkyLeftByMedia(a[0])", points);
  const std::vector<float> added = both.OnGpu("MediaOnSurface(a[0], a[1])[1]", points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double altitude = 1000.0 * double{points[i][0]};
    const SkyThroughMedia truth =
        both.renderer.SkyOnSurface(altitude, double{points[i][1]}, SkyThroughMedia::Clear(3));
    EXPECT_NEAR(double{sun[i]}, double{both.renderer.BeamLeft({0.0, 0.0, altitude}, kToSun)[1]},
                1e-3);
    EXPECT_NEAR(double{sky[i]}, double{truth.left[1]}, 1e-4);
    EXPECT_NEAR(double{added[i]}, double{truth.added[1]}, 3e-3);
  }
}

TEST(LayerMap, IsReusedUntilTheEyeRises) {
  const EyeUnderLight made{10.0, Unrefracted(kToSun), kLayerSunRadius_rad};
  EXPECT_TRUE(Serves(made, {12.0, Unrefracted(kToSun), kLayerSunRadius_rad}, 60.0));
  EXPECT_FALSE(Serves(made, {100.0, Unrefracted(kToSun), kLayerSunRadius_rad}, 60.0));
}

TEST_F(LayerOnGpu, FindsTheDistanceOfAnOpticalDepthForAnyEye) {
  const std::string ray = "vec3(a[0], a[1], a[2])";
  const std::string whole = "MediaDepthTo(" + ray + ", a[3])";
  for (const double eye_m : {10.0, 2e3, 2e4, 4e5, 3.6e7}) {
    const BothLayers both(DropletsOf(0.003, 100.0, 0.0), eye_m);
    const double radius = TheStage().scene.medium.planet_radius_m;
    // Directions to ground in the distance, to the nadir and a fifth of the way to the horizon.
    std::vector<tests::Arguments<float>> rays;
    for (const double to_horizon : {1e-3, 0.2}) {
      const double horizon = std::acos(-shared::HorizonCosine(eye_m, radius));
      const double off = to_horizon * horizon, mu = -std::cos(off);
      rays.push_back({0.0F, static_cast<float>(std::sin(off)), static_cast<float>(mu),
                      static_cast<float>(shared::DistanceDownTo(eye_m, mu, 0.0, radius) / 1000.0)});
    }
    for (const char* share : {"0.02", "0.5", "0.97"}) {
      const std::string depth = whole + " * " + share;
      const std::vector<float> found =
          both.OnGpu("MediaDepthTo(" + ray + ", MediaDistanceOf(" + ray + ", " + depth + ", " +
                         whole + ", a[3])) / (" + depth + ")",
                     rays);
      for (std::size_t i = 0; i < rays.size(); ++i)
        EXPECT_NEAR(found[i], 1.0F, eye_m > 1e6 ? 0.2F : 0.01F)
            << eye_m << " m, " << share << ": floats of 36000 km are 4 m apart";
    }
  }
}

/// The shader's sum of a light that rises by 1 a kilometre of the ray (x, y, z) until its end, 20
/// km at most.
std::string LightInLayer() {
  const std::string to = "MediaStretchesTo(vec3(a[0], a[1], a[2]), min(a[3], 20.0))";
  const std::string km = to + ".distance_km";
  return "dot(" + to + ".weight, " + km + ") + MediaRest(" + to + ", vec4(" + km + ".w), vec4(" +
         km + ".z), vec4(" + km + ".y)).x";
}

TEST_F(LayerOnGpu, StretchesDimLightWithinEightPercent) {
  for (const std::shared_ptr<const ExponentialLayer>& layer :
       {DropletsOf(0.002, 80.0, 0.0),
        DropletsOf(0.013, std::numeric_limits<double>::infinity(), 0.0)}) {
    const BothLayers both(layer, 10.0);
    const auto rays = Rays(both, tests::ScaledDown(60, 30));
    const std::vector<float> gpu = both.OnGpu(LightInLayer(), rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const glm::dvec3 way = glm::normalize(glm::dvec3(rays[i][0], rays[i][1], rays[i][2]));
      const double length = 1000.0 * std::min(double{rays[i][3]}, 20.0);
      const MarchedLight march = both.renderer.Along(both.eye, way, length, nullptr, 1e-4);
      const auto upto = [&](double m) {
        Spectrum light(3);
        for (std::size_t band = 0; band < 3; ++band) {
          light[band] = static_cast<float>(std::min(m, length) / 1000.0);
        }
        return light;
      };
      const Spectrum truth = DimmedByMedia(march.pieces, upto, upto(length), Behind::kAll);
      EXPECT_NEAR(double{gpu[i]}, double{truth[0]}, 0.08 * double{truth[0]})
          << "four stretches; " << way.z << " " << length;
    }
  }
}

}  // namespace
}  // namespace alpenglow::viewer
