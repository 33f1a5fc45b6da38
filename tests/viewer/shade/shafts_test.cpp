// SPDX-License-Identifier: MIT
// What shade takes from rays on the graphics card, against the renderer's exact stretches.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "atmosphere/math/constants.h"
#include "renderer/elevation/mesh.h"
#include "renderer/terrain/terrain.h"
#include "renderer/visibility/heights_around.h"
#include "renderer/visibility/shadow_heights.h"
#include "renderer/visibility/sun_shadow_map.h"
#include "tests/fixtures/quantile.h"
#include "tests/fixtures/rough_land.h"
#include "tests/viewer/shaders/gpu_values.h"
#include "tests/viewer/shaders/headless.h"
#include "viewer/shade/shafts.h"
#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {
namespace {

constexpr double kShaftSunRadius_rad = 0.00465;
constexpr int kSide = 301;
constexpr double kCell_m = 60.0;

/// Stands for the table of the air: what has come together after a distance, in two bands.
constexpr std::array<double, 2> kReach_km = {12.0, 45.0};
constexpr const char* kSingleTo =
    "#define LEFT_BY_MEDIA(direction, km) 1.0\n"
    "vec4 SingleTo(vec3 direction, float distance_km) {\n"
    "  return vec4(1.0 - exp(-distance_km / vec2(12.0, 45.0)), 0.0, 0.0);\n}\n"
    "vec4 SkyRadiance(vec3 direction) { return SingleTo(direction, 1e9); }\n";

/// Returns the light that shade removes along a path, as a share of the light of the whole ray.
double TakenOf(const SunlitPath& lit, double length_m, double reach_km) {
  constexpr int kSteps = 4000;
  double taken = 0.0, all = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double at_m = (i + 0.5) / kSteps * length_m;
    const double light = std::exp(-at_m / (1e3 * reach_km));
    taken += light * (1.0 - SunlightAt(lit, at_m));
    all += light;
  }
  return taken / all;
}

struct Ray {
  glm::dvec3 direction;
  double length_m;
};

/// From one eye to the ground, or out of the land.
std::vector<Ray> RaysFrom(const glm::dvec3& eye, const Terrain& terrain, int count) {
  std::mt19937 random(11);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const double azimuth = uniform(0.0, 2.0 * kPi), z = uniform(-0.25, 0.3);
    const double flat = std::sqrt(1.0 - z * z);
    const glm::dvec3 direction(flat * std::cos(azimuth), flat * std::sin(azimuth), z);
    const auto hit = terrain.Intersect(eye, direction);
    rays.push_back({direction, hit ? hit->distance_m : 60e3});
  }
  return rays;
}

/// Errors of what shade takes, as shares of the light of the whole unshaded ray, ascending.
std::vector<double> ErrorsUnder(double sun_degrees, const ShadeSteps& steps) {
  static const Terrain terrain(LandMesh(RoughLand, kSide, kCell_m));
  const double e = sun_degrees * kRadiansPerDegree;
  const glm::dvec3 to_sun(std::cos(e) * 0.8, std::cos(e) * 0.6, std::sin(e));
  const ShadowHeights reference(terrain.mesh(), to_sun, kShaftSunRadius_rad);
  const auto map = std::make_shared<SunShadowMap>(SunShadowMapOf(
      RasterOf(terrain.mesh(), std::size_t{1} << 18), to_sun, kShaftSunRadius_rad, 1024));
  const glm::dvec3 eye(-3000.0, 500.0, RoughLand(-3000.0, 500.0) + 300.0);
  const std::vector<Ray> rays = RaysFrom(eye, terrain, 400);
  ShadeTexture texture;
  texture.TakeOver(map);
  texture.Upload(100000, 1);
  glm::dmat4 map_from_eye(1.0);
  map_from_eye[3] = glm::dvec4(eye, 1.0);

  const std::vector<ShaderPiece> pieces = {{"air", kSingleTo},
                                           ViewerPiece("viewer/shaders/shafts/march.glsl")};
  std::vector<tests::Arguments<float>> points;
  for (const Ray& ray : rays)
    points.push_back({static_cast<float>(ray.direction.x), static_cast<float>(ray.direction.y),
                      static_cast<float>(ray.direction.z),
                      static_cast<float>(1e-3 * ray.length_m)});
  std::vector<double> errors;
  for (std::size_t band = 0; band < kReach_km.size(); ++band) {
    const std::vector<float> taken = tests::EvaluateOnGpu(
        pieces,
        "MarchedShade(vec3(a[0], a[1], a[2]), a[3])[" + std::to_string(band) +
            "] / SingleTo(vec3(0.0), a[3])[" + std::to_string(band) + "]",
        points,
        [&](const ShaderProgram& program) { texture.Bind(program, 1, map_from_eye, steps); });
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const double expected = TakenOf(reference.Along(eye, rays[i].direction, rays[i].length_m),
                                      rays[i].length_m, kReach_km[band]);
      errors.push_back(std::abs(static_cast<double>(taken[i]) - expected));
    }
  }
  std::sort(errors.begin(), errors.end());
  return errors;
}

using Shafts = tests::Headless;

TEST_F(Shafts, RemoveTheSameLightAsTheRenderer) {
  struct Case {
    double sun_degrees, fine_p99, coarse_p99;
  };
  for (const Case& c : {Case{15.0, 0.005, 0.02}, Case{8.0, 0.015, 0.02}, Case{3.0, 0.01, 0.03},
                        Case{1.0, 0.015, 0.05}}) {
    const std::vector<double> fine = ErrorsUnder(c.sun_degrees, {16, 8});
    EXPECT_LT(tests::Quantile(fine, 0.5), 1e-3);
    EXPECT_LT(tests::Quantile(fine, 0.99), c.fine_p99)
        << "of the light of the unshaded ray: crests are cut off between samples of 60 m, their "
           "shade between steps; sun at "
        << c.sun_degrees;
    const std::vector<double> coarse = ErrorsUnder(c.sun_degrees, {4, 6});
    EXPECT_LT(tests::Quantile(coarse, 0.9), 0.015);
    EXPECT_LT(tests::Quantile(coarse, 0.99), c.coarse_p99) << c.sun_degrees;
  }
}

TEST_F(Shafts, OfRaysThroughAHoleEndAtTheLowestGround) {
  const double e = 8.0 * kRadiansPerDegree;
  const auto map = std::make_shared<SunShadowMap>(
      SunShadowMapOf(RasterOf(LandMesh(RoughLand, kSide, kCell_m), std::size_t{1} << 18),
                     {std::cos(e), 0.0, std::sin(e)}, kShaftSunRadius_rad, 1024));
  ShadeTexture texture;
  texture.TakeOver(map);
  texture.Upload(map->lines, 1);
  glm::dmat4 map_from_eye(1.0);
  map_from_eye[3] = glm::dvec4(400.0, 300.0, 4000.0, 1.0);
  const auto down_km = static_cast<float>(1e-3 * (4000.0 - map->floor_m));
  const std::vector<float> taken =
      tests::EvaluateOnGpu({{"air", kSingleTo}, ViewerPiece("viewer/shaders/shafts/march.glsl")},
                           "MarchedShade(vec3(0.0, 0.0, -1.0), a[0]).x", {{1e9F}, {down_km}},
                           [&](const ShaderProgram& program) {
                             texture.Bind(program, 1, map_from_eye, {4, 8});
                           });
  EXPECT_NEAR(taken[0], taken[1], 1e-6F);
  EXPECT_LT(taken[0], 0.3F) << "of a ray of any length";
}

TEST_F(Shafts, SunlightOverAnEdgeSumsToTheLimbDarkenedDisk) {
  const std::vector<ShaderPiece> pieces = {{"air", kSingleTo},
                                           ViewerPiece("viewer/shaders/shafts/march.glsl")};
  std::vector<tests::Arguments<float>> points;
  for (int i = -30; i <= 30; ++i) points.push_back({0.1F * static_cast<float>(i)});
  const std::vector<float> sums = tests::EvaluateOnGpu(pieces, "SunlightUpTo(a[0])", points);
  double sum = 0.0;
  std::size_t next = 0;
  for (int i = -3000; i <= 3000; ++i) {
    if (i % 100 == 0) {
      EXPECT_NEAR(static_cast<double>(sums[next++]), sum, 1e-3) << i;
    }
    sum += 1e-3 * SunlightOverEdge(1e-3 * (i + 0.5));
  }
}

TEST_F(Shafts, ShadeOfASegmentIsTheMeanAlongIt) {
  const std::vector<ShaderPiece> pieces = {{"air", kSingleTo},
                                           ViewerPiece("viewer/shaders/shafts/march.glsl")};
  std::vector<tests::Arguments<float>> points;
  std::vector<double> expected;
  for (const float from : {-5e4F, -300.0F, -4.0F, -1.0F, 0.2F, 3.0F, 700.0F}) {
    for (const float to : {-2e4F, -4.0F, -3.999F, 0.0F, 0.2F, 1.5F, 1e4F}) {
      const float radius = 2.5F;
      points.push_back({from, to, radius});
      double sum = 0.0;
      constexpr int kParts = 100000;
      for (int i = 0; i < kParts; ++i) {
        const double share = (i + 0.5) / kParts;
        sum += 1.0 - SunlightOverEdge((static_cast<double>(from) * (1.0 - share) +
                                       static_cast<double>(to) * share) /
                                      static_cast<double>(radius));
      }
      expected.push_back(sum / kParts);
    }
  }
  const std::vector<float> dark =
      tests::EvaluateOnGpu(pieces, "MeanDarkness(vec2(a[0], a[2]), vec2(a[1], a[2]))", points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(static_cast<double>(dark[i]), expected[i], 0.01)
        << "a cubic stands for the disk; from " << points[i][0] << " to " << points[i][1];
  }
}

TEST_F(Shafts, ATexelStoresLightAndDistance) {
  const ShaderPiece texel = ViewerPiece("viewer/shaders/shafts/texel.glsl");
  std::vector<tests::Arguments<float>> points;
  for (const float light : {0.0F, 1e-6F, 0.37F, 80.0F}) {
    for (const float km : {0.0015F, 0.2F, 17.3F, 900.0F, 1e9F}) points.push_back({light, km});
  }
  const std::string made = "ShaftTexel(vec4(a[0], 0.0, 2.0 * a[0], 0.1), a[1])";
  const std::vector<float> light = tests::EvaluateOnGpu({texel}, made + ".z", points);
  const std::vector<float> log2_km =
      tests::EvaluateOnGpu({texel}, "ShaftDistance(" + made + ")", points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(light[i], 2.0F * points[i][0], 4e-6F * points[i][0] + 1e-12F) << "four bits of 24";
    EXPECT_NEAR(static_cast<double>(log2_km[i]),
                std::min(std::log2(static_cast<double>(points[i][1])), 14.0), 2e-4)
        << "half a step of 24 / 65535";
  }
}

/// A picture of a ridge before a far wall: distances of every pixel, and what is taken there.
class ShaftPicture {
 public:
  static constexpr int kWidth = 90, kHeight = 50;  // no multiple of the pass's scale

  static float DistanceOf(int x, int y) {
    if (y < 8 + x / 4) return 2500.0F;
    return y < 36 ? 14000.0F : 0.0F;
  }

  ShaftPicture() {
    std::vector<glm::vec4> surface;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) surface.emplace_back(0.0F, 0.0F, 0.0F, DistanceOf(x, y));
    }
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, surface_.id());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, kWidth, kHeight, 0, GL_RGBA, GL_FLOAT,
                 surface.data());
    ClampAndFilter(GL_TEXTURE_2D, false);
  }

  /// Returns the picture of the light that shade removes.
  [[nodiscard]] HdrImage Painted(const ShadeTexture& shade, const ShaftDetail& detail) const {
    constexpr GLuint kViewBinding = 1;
    const std::vector<ShaderPiece> air = {ViewerPiece("viewer/shaders/view/block.glsl"),
                                          {"air", kSingleTo}};
    ShaftPass pass(air);
    ViewBlock view{};
    view.view_right = {0.2, 0.0, 0.0, 0.0};
    view.view_up = {0.0, 0.0, 0.08, 0.0};
    view.view_forward = {0.0, 0.998, 0.06, 0.0};
    const GlBuffer buffer;
    glBindBufferBase(GL_UNIFORM_BUFFER, kViewBinding, buffer.id());
    glBufferData(GL_UNIFORM_BUFFER, sizeof(view), &view, GL_STATIC_DRAW);
    pass.program().BindBlock("View", kViewBinding);
    glm::dmat4 map_from_eye(1.0);
    map_from_eye[3] = glm::dvec4(0.0, -6000.0, 1700.0, 1.0);
    pass.Paint(shade, map_from_eye, kWidth, kHeight, 0, 1, detail);
    std::vector<ShaderPiece> texts = ShaftTexts();
    texts.push_back(air.back());
    texts.push_back({"picture",
                     "uniform sampler2D surface_map;\nout vec4 picture;\nvoid main() {\n"
                     "  float far = texelFetch(surface_map, ivec2(gl_FragCoord.xy), 0).w;\n"
                     "  float way = far > 0.0 ? 1e-3 * far : 1e9;\n"
                     "  picture = TakenByShade(way, SingleTo(vec3(0.0), way));\n}\n"});
    const ShaderProgram picture = FullScreenProgram(texts);
    const RenderTarget target(kWidth, kHeight, RenderTarget::Depth::kNone);
    target.Bind();
    pass.Bind(picture, 2);
    picture.BindSampler("surface_map", 0);
    DrawFullScreen(picture, GlVertexArray());
    CheckGl("ShaftPicture");
    return target.Read();
  }

 private:
  GlTexture surface_;
};

TEST_F(Shafts, OfEveryFourthPixelAreInterpolatedAtEqualDistance) {
  const auto land = [](double x, double y) {
    return 1000.0 + 1400.0 * std::exp(-1e-6 * ((x + 1500.0) * (x + 1500.0) + 0.3 * y * y));
  };
  ShadeTexture shade;
  shade.TakeOver(std::make_shared<SunShadowMap>(
      SunShadowMapOf(RasterOf(LandMesh(land, 201, 150.0), std::size_t{1} << 16),
                     {-std::cos(0.09), 0.0, std::sin(0.09)}, kShaftSunRadius_rad, 512)));
  shade.Upload(100000, 1);
  ASSERT_TRUE(shade.Shades());
  const ShaftPicture scene;
  const HdrImage fine = scene.Painted(shade, {1, {8, 8}}),
                 coarse = scene.Painted(shade, {4, {8, 8}});
  std::vector<double> apart;
  double largest = 0.0, jump = 0.0;
  for (std::size_t i = 0; i < fine.rgb.size(); ++i) {
    const auto a = static_cast<double>(fine.rgb[i][0]), b = static_cast<double>(coarse.rgb[i][0]);
    largest = std::max(largest, a);
    apart.push_back(std::abs(a - b));
    if (i >= ShaftPicture::kWidth)
      jump =
          std::max(jump, std::abs(a - static_cast<double>(fine.rgb[i - ShaftPicture::kWidth][0])));
  }
  std::sort(apart.begin(), apart.end());
  EXPECT_GT(largest, 0.12) << "of the light of a ray of any length";
  EXPECT_GT(jump, 0.1) << "near and far stand side by side";
  EXPECT_LT(tests::Quantile(apart, 0.95), 0.01) << "and do not run into each other";
  EXPECT_LT(apart.back(), 0.05) << "an edge of shade across rays a degree apart";
}

TEST_F(Shafts, AMapIsUsedOnlyWhenComplete) {
  const auto hill = [](double x, double y) { return 800.0 * std::exp(-1e-6 * (x * x + y * y)); };
  const HeightRaster heights = RasterOf(LandMesh(hill, 81, 100.0), std::size_t{1} << 16);
  ShadeTexture shade;
  EXPECT_FALSE(shade.Shades());
  shade.Upload(10, 1);
  EXPECT_FALSE(shade.Shades()) << "nothing was asked for";
  const auto map = std::make_shared<SunShadowMap>(
      SunShadowMapOf(heights, {std::cos(0.1), 0.0, std::sin(0.1)}, kShaftSunRadius_rad, 64));
  shade.TakeOver(map);
  shade.Upload(map->lines - 1, 1);
  EXPECT_FALSE(shade.Shades());
  shade.Upload(map->lines, 1);
  ASSERT_TRUE(shade.Shades());
  shade.TakeOver(std::make_shared<SunShadowMap>());  // night
  EXPECT_TRUE(shade.Shades()) << "not yet";
  shade.Upload(1, 1);
  EXPECT_FALSE(shade.Shades());
}

}  // namespace
}  // namespace alpenglow::viewer
