// SPDX-License-Identifier: MIT
// C++ and the driver agree on where every member of a uniform block lies.
#include "viewer/shaders/pass_setup.h"

#include <gtest/gtest.h>

#include <cmath>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "tests/viewer/shaders/gpu_values.h"
#include "tests/viewer/shaders/headless.h"

namespace alpenglow::viewer {
namespace {

using UniformBlocks = tests::Headless;

struct Member {
  const char* name;
  std::size_t offset;
};

void ExpectOffsets(const ShaderProgram& program, const std::vector<Member>& members) {
  for (const Member& member : members) {
    GLuint index = GL_INVALID_INDEX;
    glGetUniformIndices(program.id(), 1, &member.name, &index);
    ASSERT_NE(index, GL_INVALID_INDEX) << member.name;
    GLint offset = -1;
    glGetActiveUniformsiv(program.id(), 1, &index, GL_UNIFORM_OFFSET, &offset);
    EXPECT_EQ(offset, static_cast<GLint>(member.offset)) << member.name;
  }
}

GLint SizeOf(const ShaderProgram& program, const char* block) {
  const GLuint index = glGetUniformBlockIndex(program.id(), block);
  GLint size = -1;
  if (index != GL_INVALID_INDEX) {
    glGetActiveUniformBlockiv(program.id(), index, GL_UNIFORM_BLOCK_DATA_SIZE, &size);
  }
  return size;
}

// A program that reads all blocks of the picture.
ShaderProgram ProgramOfBlocks() {
  std::vector<ShaderPiece> pieces = WithViewerPieces(
      SharedTexts(), {"viewer/shaders/view.block.glsl", "viewer/shaders/air.block.glsl",
                      "viewer/shaders/ground.glsl"});
  pieces.push_back({"main", "void main() { gl_Position = shell + eye + conifers; }\n"});
  return ShaderProgram::ForTransformFeedback(pieces, {"gl_Position"});
}

TEST_F(UniformBlocks, AirLiesWhereTheDriverLooks) {
  const ShaderProgram program = ProgramOfBlocks();
  EXPECT_EQ(SizeOf(program, "Air"), static_cast<GLint>(sizeof(AirBlock)));
  ExpectOffsets(program, {{"rayleigh_scattering", offsetof(AirBlock, rayleigh_scattering)},
                          {"mie_scattering", offsetof(AirBlock, mie_scattering)},
                          {"mie_extinction", offsetof(AirBlock, mie_extinction)},
                          {"ozone_absorption", offsetof(AirBlock, ozone_absorption)},
                          {"ground_albedo", offsetof(AirBlock, ground_albedo)},
                          {"red_from_bands", offsetof(AirBlock, red_from_bands)},
                          {"green_from_bands", offsetof(AirBlock, green_from_bands)},
                          {"blue_from_bands", offsetof(AirBlock, blue_from_bands)},
                          {"shell", offsetof(AirBlock, shell)},
                          {"ozone_layer", offsetof(AirBlock, ozone_layer)},
                          {"deficit", offsetof(AirBlock, deficit)},
                          {"wavelengths", offsetof(AirBlock, wavelengths)}});
}

TEST_F(UniformBlocks, ViewLiesWhereTheDriverLooks) {
  const ShaderProgram program = ProgramOfBlocks();
  EXPECT_EQ(SizeOf(program, "View"), static_cast<GLint>(sizeof(ViewBlock)));
  ExpectOffsets(program, {{"view_right", offsetof(ViewBlock, view_right)},
                          {"view_up", offsetof(ViewBlock, view_up)},
                          {"view_forward", offsetof(ViewBlock, view_forward)},
                          {"sun", offsetof(ViewBlock, sun)},
                          {"sun_for_air", offsetof(ViewBlock, sun_for_air)},
                          {"sun_irradiance", offsetof(ViewBlock, sun_irradiance)},
                          {"bend", offsetof(ViewBlock, bend)},
                          {"bend_slopes", offsetof(ViewBlock, bend_slopes)},
                          {"bend_falls", offsetof(ViewBlock, bend_falls)},
                          {"eye", offsetof(ViewBlock, eye)}});
}

TEST_F(UniformBlocks, GroundLiesWhereTheDriverLooks) {
  const ShaderProgram program = ProgramOfBlocks();
  EXPECT_EQ(SizeOf(program, "Ground"), static_cast<GLint>(sizeof(GroundBlock)));
  ExpectOffsets(program, {{"conifers", offsetof(GroundBlock, conifers)},
                          {"leaves", offsetof(GroundBlock, leaves)},
                          {"yellow_leaves", offsetof(GroundBlock, yellow_leaves)},
                          {"bare_trees", offsetof(GroundBlock, bare_trees)},
                          {"meadow", offsetof(GroundBlock, meadow)},
                          {"dry_meadow", offsetof(GroundBlock, dry_meadow)},
                          {"rock", offsetof(GroundBlock, rock)},
                          {"snow", offsetof(GroundBlock, snow)},
                          {"cover_lines", offsetof(GroundBlock, cover_lines)},
                          {"green_lines", offsetof(GroundBlock, green_lines)},
                          {"octave_cell[0]", offsetof(GroundBlock, octave_cell)},
                          {"octave_place[0]", offsetof(GroundBlock, octave_place)},
                          {"mesh_east", offsetof(GroundBlock, mesh_east)},
                          {"mesh_north", offsetof(GroundBlock, mesh_north)},
                          {"mesh_up", offsetof(GroundBlock, mesh_up)}});
}

TEST(AirBlock, AMediumOfFiveWavelengthsIsRefused) {
  EXPECT_THROW(static_cast<void>(AirBlockOf(MediumPreset("earth", WavelengthSet(8)))), InputError);
}

TEST(AirBlock, AMediumOfThreeWavelengthsHasADarkFourthBand) {
  const AirBlock block = AirBlockOf(MediumPreset("bruneton2017"));
  EXPECT_GT(block.rayleigh_scattering.z, 0.0F);
  EXPECT_EQ(block.rayleigh_scattering.w, 0.0F);
  EXPECT_EQ(block.red_from_bands.w, 0.0F);
}

// --- the ground's materials and relief, far from the origin of their pattern ---

using GroundCoverBlock = tests::Headless;

constexpr double kEast_m = 612345.678, kNorth_m = 5191234.567, kUp_m = 1234.5;  // of the eye

constexpr double kSea_s = 2.2e8;  // years of waves

/// (east, north) from the eye, altitude, vertical component of the normal, footprint. Half of them
/// face the north, and a tenth of the altitude is how far they lie over the eye.
std::vector<tests::Arguments<float>> GroundPoints() {
  std::vector<tests::Arguments<float>> points;
  for (int i = 0; i < 400; ++i) {
    const auto t = static_cast<float>(i);
    points.push_back({std::fmod(t * 317.3F, 4000.0F) - 2000.0F,
                      std::fmod(t * 173.9F, 3000.0F) - 1500.0F, std::fmod(t * 91.7F, 3600.0F),
                      0.5F + 0.5F * std::fmod(t * 0.0317F, 1.0F),
                      0.2F + std::fmod(t * 0.7F, 30.0F)});
  }
  return points;
}

GroundPoint PointOf(const tests::Arguments<float>& a) {
  GroundPoint at{kEast_m + static_cast<double>(a[0]), kNorth_m + static_cast<double>(a[1]),
                 static_cast<double>(a[2]), static_cast<double>(a[4])};
  at.up_m = kUp_m + 0.1 * static_cast<double>(a[2]);
  at.normal_north = static_cast<double>(a[0]) > 0.0 ? 0.4 : -0.4;
  at.sea_s = kSea_s;
  return at;
}

std::vector<float> GroundValues(const MountainSurface& surface, const std::string& expression) {
  GroundPoint eye{kEast_m, kNorth_m, kUp_m, 0.0};
  eye.up_m = kUp_m;
  eye.sea_s = kSea_s;
  GroundBlock block = GroundBlockOf(surface, eye);
  block.mesh_east = {1.0F, 0.0F, 0.0F, 0.0F};
  block.mesh_north = {0.0F, 1.0F, 0.0F, 0.0F};
  block.mesh_up = {0.0F, 0.0F, 1.0F, 0.0F};
  const GlBuffer buffer;
  const std::vector<ShaderPiece> texts =
      WithViewerPieces(SharedTexts(), {"viewer/shaders/ground.glsl"});
  return tests::EvaluateOnGpu(texts, expression, GroundPoints(), [&](const ShaderProgram& program) {
    glBindBufferBase(GL_UNIFORM_BUFFER, 3, buffer.id());
    glBufferData(GL_UNIFORM_BUFFER, sizeof(block), &block, GL_STATIC_DRAW);
    program.BindBlock("Ground", 3);
  });
}

TEST_F(GroundCoverBlock, AlbedoIsThatOfTheRendererInEverySeason) {
  const std::vector<double> wavelengths = WavelengthSet(4);
  for (const int day : {61081, 61161, 61212, 61334}) {  // February, May, June, October 2026
    const MountainSurface surface(wavelengths,
                                  CoverInSeason(PlaceFromDegrees(46.5, 8.0, 0.0), day));
    const std::vector<float> on_gpu = GroundValues(
        surface,
        "GroundAlbedo(vec3(a[0], a[1], 0.1 * a[2]), a[2], vec2(a[3], a[0] > 0.0 ? 0.4 : -0.4), "
        "a[4], vec4(0.0)).y");
    const auto points = GroundPoints();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Bands<float> albedo =
          surface.Albedo(PointOf(points[i]), static_cast<double>(points[i][3]));
      EXPECT_NEAR(on_gpu[i], albedo[1], 2e-3)
          << "float places the pattern to 1e-4 of its shortest wave, and its edges are steep";
    }
  }
}

TEST_F(GroundCoverBlock, WavesAreThoseOfTheRenderer) {
  const MountainSurface surface(WavelengthSet(4), {});
  constexpr double kBreeze = 0.003 + 0.00512 * 5.0;  // Cox, Munk: 5 m/s
  const std::vector<float> east =
      GroundValues(surface, "WavesAt(vec3(a[0], a[1], 0.0), a[4], 0.0286, 1.0).x");
  const auto points = GroundPoints();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const WavySurface waves = WavesAt(PointOf(points[i]), kBreeze);
    EXPECT_NEAR(east[i], waves.slope_east, 1e-3) << "float places a wave to 1 mm";
  }
}

TEST_F(GroundCoverBlock, ReliefIsThatOfTheRenderer) {
  const MountainSurface surface(WavelengthSet(4),
                                CoverInSeason(PlaceFromDegrees(46.5, 8.0, 0.0), 61212));
  const std::vector<float> east = GroundValues(surface,
                                               "DetailedNormal(vec3(a[0], a[1], 0.1 * a[2]), "
                                               "vec3(sqrt(1.0 - a[3] * a[3]), 0.0, a[3]), a[4]).x");
  const std::vector<float> north =
      GroundValues(surface,
                   "DetailedNormal(vec3(a[0], a[1], 0.1 * a[2]), vec3(sqrt(1.0 - a[3] * a[3]), "
                   "0.0, a[3]), a[4]).y");
  const auto points = GroundPoints();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto up = static_cast<double>(points[i][3]);
    const glm::dvec3 normal = MountainSurface::DetailedNormal(
        PointOf(points[i]), glm::dvec3(std::sqrt(1.0 - up * up), 0.0, up));
    EXPECT_NEAR(east[i], normal.x, 2e-3) << "slope over 1 m of heights that float holds to 1 mm";
    EXPECT_NEAR(north[i], normal.y, 2e-3);
  }
}

}  // namespace
}  // namespace alpenglow::viewer
