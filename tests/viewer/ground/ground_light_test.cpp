// SPDX-License-Identifier: MIT
// What the ground sends to the eye on the graphics card, against the renderer's.
#include "renderer/lit_ground/ground_light.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>

#include "atmosphere/math/numerics.h"
#include "lut/image/image.h"
#include "lut/image/png.h"
#include "tests/fixtures/class_map.h"
#include "tests/fixtures/quantile.h"
#include "tests/fixtures/sanitized.h"
#include "tests/renderer/lit_ground/rough_site.h"
#include "tests/viewer/ground/sun_in_closed_form.h"
#include "tests/viewer/shaders/gpu_values.h"
#include "tests/viewer/shaders/headless.h"
#include "viewer/ground/ground_block.h"
#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {
namespace {

using GroundOnGpu = tests::Headless;

constexpr double kEye_m = 4000.0;
constexpr double kPixel_rad = 8e-4;

std::vector<ShaderPiece> Texts(const GroundMaterial& material) {
  std::vector<ShaderPiece> pieces = WithViewerPieces(
      SharedTexts(), {"viewer/shaders/air/block.glsl", "viewer/shaders/view/block.glsl",
                      "viewer/shaders/air/sun_light.glsl"});
  pieces.push_back(tests::SunInClosedForm());
  for (ShaderPiece& piece : GroundTexts(material, {true, true})) pieces.push_back(std::move(piece));
  for (ShaderPiece& piece : SkyByPixelTexts()) pieces.push_back(std::move(piece));
  return pieces;
}

template <typename Block>
void Bind(const ShaderProgram& program, const char* name, GLuint binding, const GlBuffer& buffer,
          const Block& block) {
  glBindBufferBase(GL_UNIFORM_BUFFER, binding, buffer.id());
  glBufferData(GL_UNIFORM_BUFFER, sizeof(block), &block, GL_STATIC_DRAW);
  program.BindBlock(name, binding);
}

SkyIrradianceGradient UnoccludedSkyOver(const LitGround& lit) {
  const SolvedAir& air = lit.site().air();
  return {air.single_scattering(), air.multiple_scattering(), 1000.0,
          lit.lighting().source.direction.seen.z};
}

/// The uniform blocks that shaders read for an eye over the origin of the site.
class Blocks {
 public:
  Blocks(const LitGround& lit, const Lighting& light, double eye_m)
      : lit_(lit), eye_m_(eye_m), textures_(lit.site().air().multiple_scattering()) {
    if (const ColourDrape* drape = lit.site().material().drape())
      textures_.SetDrape(DrapeTexels(*drape, Picture(), 256));
    const GroundMaterial& material = lit.site().material();
    const OccludedSkyIrradiance::Extent& extent = lit.site().horizons()->extent();
    mirror_ = GlossMirror::Of(
        light.on_terrain->sky(), lit.site().air().multiple_scattering(),
        {material.HasWater() ? &material.water() : nullptr,
         material.cover().kind == GroundCover::Kind::kBlinnPhong ? &material.glossy() : nullptr},
        lit.lighting().source.direction.seen, std::max(extent.lowest_m, 0.0),
        std::max(extent.highest_m, 0.0));
    textures_.SetGlossMirror(LightSource::kSun, mirror_);
  }

  void Upload(const ShaderProgram& program) const {
    const GroundSite& site = lit_.site();
    const Lighting& light = lit_.lighting();
    Bind(program, "Air", 0, air_, AirBlockOf(site.medium()));
    ViewBlock view{};
    view.sun = {glm::vec3(light.source.direction.seen), light.source.radius_rad};
    view.sun_for_air = {glm::vec3(light.source.direction.for_air), 0.0F};
    view.eye = {eye_m_ / 1e3, 0.0, 0.0, 0.0};
    Bind(program, "View", 1, view_, view);
    const GroundPattern& pattern = site.geometry().pattern();
    GroundPoint eye = pattern.At({0.0, 0.0, eye_m_});
    eye.sea_s = light.sea_s;
    Bind(program, "Ground", 2, ground_, WithAxesOf(pattern, GroundBlockOf(light.surface, eye)));
    Bind(program, "GroundLight", 3, light_,
         GroundLightBlockOf(UnoccludedSkyOver(lit_), light.source.direction.seen, kPixel_rad));
    Bind(program, "GroundSurface", 4, surface_,
         Draped(Mirrored(GroundSurfaceBlockOf(site.material()), mirror_), Picture(),
                FrameTransform(site.ground().frame, site.ground().frame), pattern));
    GroundTextures::Connect(program, 0);
    textures_.Bind(0, LightSource::kSun, LightSource::kSun);
  }

  /// The tables of the sky's light on slopes, for programs that read them.
  void UploadSkyByPixel(const ShaderProgram& program) {
    constexpr int kUnit = GroundTextures::kUnits;
    glActiveTexture(GL_TEXTURE0 + kUnit);  // where the tables are uploaded
    const SkyIrradianceGradient open = UnoccludedSkyOver(lit_);
    sky_.Use(LightSource::kSun, {{std::shared_ptr<void>(), &lit_.sky()}, open});
    Place eye = lit_.site().ground().frame.origin();
    eye.height_m += eye_m_;
    const LocalFrame here(lit_.site().ground().frame.ellipsoid(), eye);
    Bind(program, "SkyByPixel", 5, sky_block_,
         sky_.BlockOf(LightSource::kSun, here, lit_.lighting().source.direction.seen, open));
    SkyByPixel::Connect(program, kUnit);
    sky_.Bind(kUnit, LightSource::kSun);
  }

 private:
  [[nodiscard]] FlatRectangle Picture() const {
    return RectangleOf(lit_.site().ground().terrain->mesh());
  }

  const LitGround& lit_;
  double eye_m_;
  GlossMirror mirror_;
  GroundTextures textures_;
  SkyByPixel sky_;
  GlBuffer air_, view_, ground_, light_, surface_, sky_block_;
};

struct SeenPoint {
  Hit hit;
  LitVertex light;
  glm::dvec3 to_eye;
};

const glm::dvec3 kEye(0.0, 0.0, kEye_m);

/// Places of the terrain that see all of the sun or nothing: the renderer takes a point of it.
std::vector<SeenPoint> LandPoints(const LitGround& lit) {
  const Terrain& terrain = *lit.site().ground().terrain;
  std::vector<SeenPoint> cases;
  for (int i = 1; i <= 400; ++i) {
    const glm::dvec3 above(6000.0 * (Halton(i, 2) - 0.5), 6000.0 * (Halton(i, 3) - 0.5), 9000.0);
    const auto found = terrain.Intersect(above, {0.0, 0.0, -1.0});
    SeenPoint c;
    c.hit.kind = HitKind::kTerrain;
    c.hit.point = above - glm::dvec3(0.0, 0.0, found->distance_m);
    c.hit.smooth_point = found->smooth_point;
    c.hit.mesh_normal = found->normal;
    c.hit.geometric_normal = found->geometric_normal;
    c.to_eye = glm::normalize(kEye - c.hit.point);
    c.hit.footprint_m = kPixel_rad * glm::length(c.hit.point - kEye);
    c.hit.normal = lit.site().geometry().DetailedNormal(
        lit.site().geometry().GroundAt(c.hit.point, c.hit.footprint_m,
                                       glm::dot(c.hit.mesh_normal, c.to_eye)),
        c.hit.mesh_normal);
    c.light = lit.At(tests::VertexAt(lit.site(), c.hit.point, c.hit.mesh_normal));
    const double over_plane = glm::dot(c.hit.mesh_normal, lit.lighting().source.direction.seen) /
                              lit.lighting().source.radius_rad;
    if (std::abs(over_plane) > 1.0 && std::abs(c.light.sun_x) > 1.0F) cases.push_back(c);
  }
  return cases;
}

/// Places of the planet that an eye sees beyond the mountains, in all directions.
std::vector<SeenPoint> PlanetPoints(const LitGround& lit, double eye_m) {
  std::vector<SeenPoint> cases;
  for (int i = 1; i <= 300; ++i) {
    const double azimuth = 2.0 * kPi * Halton(i, 2);
    const double dip = std::atan(eye_m / (25e3 * std::pow(8.0, Halton(i, 3))));
    const glm::dvec3 direction(std::cos(dip) * std::cos(azimuth), std::cos(dip) * std::sin(azimuth),
                               -std::sin(dip));
    const SceneGround bare{lit.site().ground().frame, std::nullopt, 0.0, "", true};
    SeenPoint c;
    c.hit = SceneGeometry(bare, lit.site().medium(), false)
                .Trace({0.0, 0.0, eye_m}, direction, kPixel_rad);
    c.to_eye = -direction;
    if (c.hit.kind == HitKind::kPlanet) cases.push_back(c);
  }
  return cases;
}

/// The arguments with which a shader computes the light of a place.
struct Question {
  std::string radiance;
  std::function<tests::Arguments<float>(const SeenPoint&)> arguments;
};

/// The point from the eye, and what of the normal is needed to know it, before what a question
/// adds.
tests::Arguments<float> PlaceOf(const SeenPoint& c, double eye_m,
                                const std::array<float, 3>& more) {
  const auto point = tests::InFloats(c.hit.point - glm::dvec3(0.0, 0.0, eye_m));
  const auto normal = tests::InFloats(c.hit.mesh_normal);
  return {point[0], point[1], point[2], normal[0], normal[1], more[0], more[1], more[2]};
}

const std::string kPoint = "vec3(a[0], a[1], a[2])";
const std::string kToEye = "normalize(-vec3(a[0], a[1], a[2]))";
const std::string kNormal = "vec3(a[3], a[4], sqrt(1.0 - a[3] * a[3] - a[4] * a[4]))";

/// Ascending relative differences of the sum of two bands: of light, arguments hold no more.
std::vector<double> Differences(const LitGround& lit, const Lighting& light, double eye_m,
                                const std::vector<SeenPoint>& cases, const Question& question) {
  Blocks blocks(lit, light, eye_m);
  std::vector<tests::Arguments<float>> points;
  for (const SeenPoint& c : cases) points.push_back(question.arguments(c));
  const std::vector<float> gpu = tests::EvaluateOnGpu(
      Texts(lit.site().material()), "dot(" + question.radiance + ", vec4(1.0, 0.0, 1.0, 0.0))",
      points, [&](const ShaderProgram& program) {
        blocks.Upload(program);
        blocks.UploadSkyByPixel(program);
      });
  std::vector<double> differences;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const GroundLight& ground = lit.site().light();
    const NaturalRadiance reference = ground.Natural(
        ground.SeenFrom(cases[i].hit, cases[i].to_eye, light), {light, nullptr}, {0.0, 0.0});
    double sum = 0.0;
    for (const std::size_t band : {0U, 2U}) {
      sum += static_cast<double>(reference.radiance[band]) /
             static_cast<double>(lit.lighting().source.irradiance[band]);
    }
    differences.push_back(std::abs(static_cast<double>(gpu[i]) / sum - 1.0));
  }
  std::sort(differences.begin(), differences.end());
  return differences;
}

std::vector<double> LandDifferences(const LitGround& lit) {
  const SkyIrradianceGradient open = UnoccludedSkyOver(lit);
  const glm::dvec3& to_sun = lit.lighting().source.direction.seen;
  const glm::dvec3 sunward = glm::normalize(glm::dvec3(to_sun.x, to_sun.y, 0.0));
  const auto shares = [open, sunward, &lit](const SeenPoint& c) {
    const glm::dvec3& normal = c.hit.mesh_normal;
    const std::array<float, 4> of = open.On(
        glm::dot(normal, lit.site().geometry().UpAt(c.hit.point)), glm::dot(normal, sunward));
    return std::array<float, 3>{c.light.sun_x, c.light.sky[0] / of[0], c.light.sky[2] / of[2]};
  };
  const std::string seen = "LandSeen(" + kPoint + ", " + kNormal + ", " + kToEye + ")";
  return Differences(lit, lit.lighting(), kEye_m, LandPoints(lit),
                     {"SentOn(" + seen + ", a[5], SkyByShare(" + seen +
                          ", vec4(a[6], 0.0, a[7], 0.0)), " + kToEye + ")",
                      [&](const SeenPoint& c) { return PlaceOf(c, kEye_m, shares(c)); }});
}

std::vector<double> DifferencesByPixel(const LitGround& lit) {
  const std::string seen = "LandSeen(" + kPoint + ", " + kNormal + ", " + kToEye + ")";
  return Differences(lit, lit.lighting(), kEye_m, LandPoints(lit),
                     {"SentOn(" + seen + ", a[5], SkyAtPixel(GroundPlaceAt(" + kPoint + "), " +
                          kPoint + ", " + seen + ".normal), " + kToEye + ")",
                      [](const SeenPoint& c) {
                        return PlaceOf(c, kEye_m, {c.light.sun_x, 0.0F, 0.0F});
                      }});
}

/// Under the sky of a plain as wide as the view.
std::vector<double> PlanetDifferences(const LitGround& lit, double eye_m) {
  Lighting light = lit.lighting();
  const SolvedAir& air = lit.site().air();
  light.on_terrain = std::make_shared<const TerrainIrradiance>(
      nullptr, air.single_scattering(), air.multiple_scattering(), light.source.direction.seen);
  const std::string seen = "PlanetSeen(" + kPoint + ", " + kToEye + ")";
  return Differences(lit, light, eye_m, PlanetPoints(lit, eye_m),
                     {"SentOn(" + seen + ", kNoEdge, SkyOnPlanet(" + seen + "), " + kToEye + ")",
                      [eye_m](const SeenPoint& c) { return PlaceOf(c, eye_m, {}); }});
}

GLint OffsetOf(const ShaderProgram& program, const char* member) {
  GLuint index = GL_INVALID_INDEX;
  glGetUniformIndices(program.id(), 1, &member, &index);
  if (index == GL_INVALID_INDEX) return -1;
  GLint offset = -1;
  glGetActiveUniformsiv(program.id(), 1, &index, GL_UNIFORM_OFFSET, &offset);
  return offset;
}

TEST_F(GroundOnGpu, UniformBlocksHaveTheOffsetsOfTheDriver) {
  const auto site = tests::RoughSite();
  std::vector<ShaderPiece> pieces = Texts(site->material());
  pieces.push_back(
      {"main", "void main() { gl_Position = open_sky[7] + cover_albedo + sky_moment; }\n"});
  const ShaderProgram program = ShaderProgram::ForTransformFeedback(pieces, {"gl_Position"});
  int member = 0;
  for (const char* name : {"sky_towards", "ground_view", "open_sky[0]"})
    EXPECT_EQ(OffsetOf(program, name), 16 * member++) << name;
  member = 0;
  for (const char* name :
       {"horizon_u", "horizon_v", "slope_u", "slope_v", "sky_moment", "sky_place", "slope_unit"})
    EXPECT_EQ(OffsetOf(program, name), 16 * member++) << name;
  member = 0;
  for (const char* name : {"cover_albedo", "rough", "coat", "water", "under_water", "snow_y",
                           "drape_red", "drape_green", "drape_blue", "drape_place", "drape_eye",
                           "drape_east", "drape_north", "by_root_mu[0]"})
    EXPECT_EQ(OffsetOf(program, name), 16 * member++) << name;
  EXPECT_EQ(OffsetOf(program, "mirror_place"), 16 * 30) << "after 17 values by_root_mu";
}

// Returns a block in which all components of a vector are the same number, of the second light
// none.
SkyByPixelBlock BlockOfNumbers(float first) {
  const auto all = [first](int more) { return glm::vec4(first + static_cast<float>(more)); };
  return {all(0), all(1), all(2), all(3), all(4), all(5), all(6), {}, {}, {}};
}

TEST(SkyByPixelBlock, OfTwoLightsHasThePlacesOfTheLightWithTables) {
  const SkyByPixelBlock ten = BlockOfNumbers(10.0F), twenty = BlockOfNumbers(20.0F), none{};
  const SkyByPixelBlock both = WithLights(ten, twenty);
  EXPECT_EQ(both.slope_v.x, 13.0F);
  EXPECT_EQ(both.slope_unit.x, 16.0F);
  EXPECT_EQ(both.other_sky_moment.x, 24.0F);
  EXPECT_EQ(both.other_sky_place.x, 25.0F);
  EXPECT_EQ(both.other_slope_unit.x, 26.0F);
  const SkyByPixelBlock second = WithLights(none, twenty);
  EXPECT_EQ(second.horizon_u.x, 20.0F);
  EXPECT_EQ(second.slope_v.x, 23.0F);
  EXPECT_EQ(second.slope_unit.x, 0.0F) << "the first light has no tables";
  EXPECT_EQ(second.other_slope_unit.x, 26.0F);
  EXPECT_EQ(WithLights(ten, none).horizon_u.x, 10.0F);
  EXPECT_EQ(WithLights(ten, none).other_slope_unit.x, 0.0F);
}

TEST_F(GroundOnGpu, MountainsAreLitAsInTheRenderer) {
  const auto site = tests::RoughSite();
  for (const double elevation_deg :
       tests::ScaledDown(std::vector{50.0, 12.0, -3.0}, {12.0, -3.0})) {
    const std::vector<double> differences =
        LandDifferences(LitGround(site, tests::RoughSun(*site, elevation_deg)));
    EXPECT_LT(tests::Quantile(differences, 0.5), elevation_deg > 0.0 ? 4e-3 : 1e-2)
        << elevation_deg;
    EXPECT_LT(tests::Quantile(differences, 0.9), 0.03)
        << "the sky's light on relief is corrected by that of an open place";
  }
}

TEST_F(GroundOnGpu, SkylightPerPixelOnMountainsEqualsTheRenderers) {
  const auto site = tests::RoughSite();
  for (const double elevation_deg :
       tests::ScaledDown(std::vector{50.0, 12.0, -3.0, -8.0}, {12.0, -8.0})) {
    const std::vector<double> differences =
        DifferencesByPixel(LitGround(site, tests::RoughSun(*site, elevation_deg)));
    EXPECT_LT(tests::Quantile(differences, 0.5), 1e-3) << elevation_deg;
    EXPECT_LT(tests::Quantile(differences, 0.9), 5e-3) << elevation_deg;
  }
}

// NVIDIA's driver makes infinity of larger values, so that land was infinitely bright at midnight.
// Hard case 23.
TEST(IntegralTexels, AreFiniteHalfFloatsInTextureOrder) {
  using Sky = OccludedSkyIrradiance;
  std::vector<float> integral(Sky::kLevels * kHorizonAzimuths * Sky::kNodes * 2 * 4, 0.5F);
  integral[4] = 3e5F;  // part B of the first node
  integral[5] = -3e5F;
  integral[8] = 0.25F;  // part A of the second
  Sky::Tables tables{};
  tables.integral = integral;
  const std::vector<float> texels = IntegralTexels(tables);
  ASSERT_EQ(texels.size(), integral.size());
  EXPECT_EQ(texels[Sky::kNodes * 4], 65504.0F) << "the row of B follows that of A";
  EXPECT_EQ(texels[Sky::kNodes * 4 + 1], -65504.0F);
  EXPECT_EQ(texels[4], 0.25F);
  EXPECT_EQ(texels.back(), 0.5F);
}

TEST_F(GroundOnGpu, CoversOfOneColourAreLitAsInTheRenderer) {
  GroundCover cover;
  struct Bound {
    GroundCover::Kind kind;
    double median, most;
  };
  for (const auto& [kind, median, most] : {Bound{GroundCover::Kind::kLambert, 4e-3, 0.03},
                                           {GroundCover::Kind::kOrenNayar, 4e-3, 0.03},
                                           {GroundCover::Kind::kSnow, 0.01, 0.07},
                                           {GroundCover::Kind::kBlinnPhong, 0.03, 0.1}}) {
    cover.kind = kind;
    const auto site = tests::RoughSite(cover);
    for (const double elevation_deg : tests::ScaledDown(std::vector{50.0, 12.0}, {12.0})) {
      const std::vector<double> differences =
          LandDifferences(LitGround(site, tests::RoughSun(*site, elevation_deg)));
      EXPECT_LT(tests::Quantile(differences, 0.5), median) << elevation_deg;
      EXPECT_LT(tests::Quantile(differences, 0.9), most) << elevation_deg;
    }
  }
}

TEST_F(GroundOnGpu, WaterMirrorsSkyAndSlopesAsInTheRenderer) {
  GroundCover water;
  water.kind = GroundCover::Kind::kWater;
  const auto site = tests::RoughSite(water);
  for (const double elevation_deg :
       tests::ScaledDown(std::vector{50.0, 12.0, -3.0}, {12.0, -3.0})) {
    const std::vector<double> differences =
        DifferencesByPixel(LitGround(site, tests::RoughSun(*site, elevation_deg)));
    EXPECT_LT(tests::Quantile(differences, 0.5), 0.03) << elevation_deg;
    EXPECT_LT(tests::Quantile(differences, 0.9), 0.1) << elevation_deg;
  }
}

TEST_F(GroundOnGpu, DrapedColoursAreLitAsInTheRenderer) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / fmt::format("alpenglow-drape-{}.png", getpid());
  DisplayImage picture{64, 64, {}};
  for (int i = 0; i < 64 * 64; ++i) {
    for (const double phase : {0.0, 1.0, 2.0}) {
      const double wave =
          std::sin(0.2 * (i % 64) + phase) * std::sin(0.15 * (i / 64) + 2.0 * phase);
      picture.rgb.push_back(static_cast<std::uint8_t>(130.0 + 70.0 * wave));
    }
  }
  WritePng(file, picture, {});
  const auto site = tests::RoughSite({}, file);
  std::filesystem::remove(file);
  const std::vector<double> differences =
      LandDifferences(LitGround(site, tests::RoughSun(*site, 50.0)));
  EXPECT_LT(tests::Quantile(differences, 0.5), 5e-3);
  EXPECT_LT(tests::Quantile(differences, 0.98), 0.02)
      << "a picture resampled at its own width of a pixel";
}

TEST_F(GroundOnGpu, MappedLandCoverIsLitAsInTheRenderer) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / fmt::format("alpenglow-cover-{}.tif", getpid());
  std::vector<std::uint8_t> classes;
  for (int i = 0; i < 16 * 16; ++i) {
    constexpr std::array<std::uint8_t, 6> kClasses{10, 30, 60, 70, 80, 0};
    classes.push_back(kClasses[static_cast<std::size_t>(i / 48 + i % 16 / 5) % 6]);
  }
  tests::WriteClassMap(file, 16, classes);
  const auto site = tests::RoughSite({}, {}, file);
  std::filesystem::remove(file);
  const std::vector<double> differences =
      LandDifferences(LitGround(site, tests::RoughSun(*site, 50.0)));
  EXPECT_LT(tests::Quantile(differences, 0.5), 5e-3);
  EXPECT_LT(tests::Quantile(differences, 0.9), 0.03)
      << "shores, and steep edges of snow, are elsewhere by "
         "a texel of the map resampled";
}

TEST_F(GroundOnGpu, PlanetBeyondTheTerrainIsLitAsInTheRenderer) {
  GroundCover land, sea;
  sea.sea_level_m = 0.0;
  for (const GroundCover& cover : {land, sea}) {
    const auto site = tests::RoughSite(cover);
    for (const double elevation_deg :
         tests::ScaledDown(std::vector{50.0, 12.0, 2.0, -2.0}, {12.0, -2.0})) {
      const LitGround lit(site, tests::RoughSun(*site, elevation_deg));
      for (const double eye_m : {1e3, 40e3}) {
        const std::vector<double> differences = PlanetDifferences(lit, eye_m);
        EXPECT_LT(tests::Quantile(differences, 0.5), elevation_deg > 0.0 ? 0.01 : 0.06)
            << elevation_deg << " " << eye_m;
        EXPECT_LT(tests::Quantile(differences, 0.98), elevation_deg > 0.0 ? 0.07 : 0.12)
            << "the reference solution's sky is linear between sectors of 22.5 degrees, and in "
               "twilight between "
               "suns a degree apart";
      }
    }
  }
}

}  // namespace
}  // namespace alpenglow::viewer
