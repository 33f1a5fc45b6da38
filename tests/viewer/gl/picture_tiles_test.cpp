// SPDX-License-Identifier: MIT
#include "viewer/gl/picture_tiles.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/base/error.h"
#include "tests/viewer/shaders/headless.h"
#include "viewer/gl/gl_context.h"
#include "viewer/gl/render_target.h"
#include "viewer/gl/shader.h"

namespace alpenglow::viewer {
namespace {

using ::testing::HasSubstr;

TEST(PictureTiles, TheyCoverEveryPixelOnceAndNoneIsTooLarge) {
  for (const auto& [width, height, side] :
       {std::array{100, 60, 32}, {7, 5, 1}, {64, 64, 64}, {1, 1, 9}, {13, 200, 50}}) {
    std::vector<int> covered(static_cast<std::size_t>(width * height), 0);
    for (const PictureTile& tile : TilesOf(width, height, side)) {
      EXPECT_LE(std::max(tile.width, tile.height), side);
      for (int y = 0; y < tile.height; ++y) {
        for (int x = 0; x < tile.width; ++x) {
          ++covered[static_cast<std::size_t>((tile.top + y) * width + tile.left + x)];
        }
      }
    }
    EXPECT_EQ(std::count(covered.begin(), covered.end(), 1), width * height);
  }
}

TEST(PictureTiles, TheyAreCutWhereTheStepsOfThePictureAre) {
  const int width = 1000, height = 700;
  TiledPicture picture(width, height, 500);
  int with_rims = 0;
  for (const TiledPicture::Tile& tile : picture.tiles()) {
    EXPECT_EQ(tile.kept.left % kTileStep, 0);
    EXPECT_EQ((height - tile.kept.top - tile.kept.height) % kTileStep, 0) << "from the bottom";
    EXPECT_EQ(tile.painted.left % kTileStep, 0);
    EXPECT_LE(std::max(tile.painted.width, tile.painted.height), 500);
    const bool is_inner = tile.kept.left > 0 && tile.kept.left + tile.kept.width < width;
    if (!is_inner) continue;
    EXPECT_EQ(tile.painted.width, tile.kept.width + 2 * kTileStep);
    ++with_rims;
  }
  EXPECT_GT(with_rims, 2);
  for (const int step : {2, 3, 4, 5, 6, 8}) EXPECT_EQ(kTileStep % step, 0) << "of shafts and lamps";
  EXPECT_EQ(TiledPicture(200, 100, 200).tiles().size(), 1U) << "in one piece without a rim";
}

TEST(PictureTiles, OneTileSeesTheWholeView) {
  EXPECT_EQ(ViewOfTile({0, 0, 300, 200}, 300, 200), glm::dvec4(0.0, 0.0, 1.0, 1.0));
  const glm::dvec4 upper_left = ViewOfTile({0, 0, 150, 50}, 300, 200);
  EXPECT_EQ(upper_left, glm::dvec4(-0.5, 0.75, 2.0, 4.0));
}

class PaintedTiles : public tests::Headless {};

// The direction of every pixel, and a triangle between them and the eye: what a painter makes of
// the four numbers of a tile's view.
constexpr const char* kVertex =
    "uniform vec4 tile_view; uniform bool is_triangle; out vec2 where;\n"
    "void main() {\n"
    "  vec2 p = 2.0 * vec2((gl_VertexID << 1) & 2, gl_VertexID & 2) - 1.0;\n"
    "  where = p / tile_view.zw + tile_view.xy;\n"
    "  gl_Position = vec4(p, 0.9, 1.0);\n"
    "  if (!is_triangle) return;\n"
    "  vec3 corner = vec3[](vec3(-1, -2, 3), vec3(5, 1, 6), vec3(-2, 4, 5))[gl_VertexID];\n"
    "  gl_Position = vec4((corner.xy - tile_view.xy * corner.z) * tile_view.zw, 0.0, corner.z);\n"
    "}\n";
constexpr const char* kFragment =
    "uniform bool is_triangle; in vec2 where; out vec4 colour;\n"
    "void main() { colour = is_triangle ? vec4(9.0) : vec4(where, 0.0, 1.0); }\n";

Image Painted(const ShaderProgram& program, int width, int height, const glm::dvec4& view) {
  const RenderTarget target(width, height, RenderTarget::Depth::kNone);
  const GlVertexArray none;
  target.Bind();
  glBindVertexArray(none.id());
  program.Use();
  glUniform4f(program.Uniform("tile_view"), static_cast<float>(view.x), static_cast<float>(view.y),
              static_cast<float>(view.z), static_cast<float>(view.w));
  for (const int is_triangle : {0, 1}) {
    glUniform1i(program.Uniform("is_triangle"), is_triangle);
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  return target.Read();
}

TEST_F(PaintedTiles, PutTogetherTheyAreThePictureInOnePiece) {
  const ShaderProgram program({{"vertex", kVertex}}, {{"fragment", kFragment}});
  const int width = 37, height = 23;
  const Image whole = Painted(program, width, height, {0.0, 0.0, 1.0, 1.0});
  TiledPicture picture(width, height, 9);
  for (const TiledPicture::Tile& tile : picture.tiles()) {
    picture.Put(tile,
                Painted(program, tile.painted.width, tile.painted.height, picture.ViewOf(tile)));
  }
  const Image together = picture.Take();
  int differing = 0, of_triangle = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (whole.at(x, y)[0] == 9.0F) ++of_triangle;
      for (const std::size_t i : {0U, 1U}) {
        if (std::abs(whole.at(x, y)[i] - together.at(x, y)[i]) > 1e-5F) ++differing;
      }
    }
  }
  EXPECT_GT(of_triangle, 100) << "there is a triangle to compare";
  EXPECT_LE(differing, 2) << "an edge may pass through the middle of a pixel";
}

TEST_F(PaintedTiles, WhatTheDriverCannotDrawIsRefusedWithItsLimits) {
  EXPECT_NO_THROW(RequireDrawable(640, 480));
  EXPECT_GE(LargestSquareOfDriver(), 1024) << "OpenGL 3.3 has at least that";
  try {
    RequireDrawable(1 << 20, 10);
    ADD_FAILURE() << "no driver draws a million pixels a side";
  } catch (const OptionError& error) {
    EXPECT_THAT(error.what(), HasSubstr("--size 1048576x10"));
    EXPECT_THAT(error.what(), HasSubstr("pixels a side"));
  }
  EXPECT_NO_THROW(CheckGl("asking leaves no errors"));
}

TEST(PictureMemory, APictureThatMemoryDoesNotHoldIsRefusedBeforeItIsMade) {
  EXPECT_NO_THROW(RequireMemoryFor(64, 64, 12));
  if (!std::filesystem::exists("/proc/meminfo")) GTEST_SKIP() << "the system does not tell";
  EXPECT_THROW(RequireMemoryFor(1 << 30, 1 << 30, 12), OptionError);
}

}  // namespace
}  // namespace alpenglow::viewer
