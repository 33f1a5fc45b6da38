// SPDX-License-Identifier: MIT
// OpenGL: render targets, pictures in tiles, timers of passes.
#include "viewer/gl/render_target.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/base/error.h"
#include "tests/viewer/shaders/headless.h"
#include "viewer/gl/gl_context.h"
#include "viewer/gl/pass_timer.h"
#include "viewer/gl/shader.h"

namespace alpenglow::viewer {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class RenderTargets : public tests::Headless {
 protected:
  static void Draw(const RenderTarget& target, const std::string& outputs) {
    const ShaderProgram program(
        {{"vertex",
          "void main() { vec2 p = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);\n"
          "gl_Position = vec4(2.0 * p - 1.0, 0.5, 1.0); }"}},
        {{"fragment", outputs}});
    const GlVertexArray none;
    target.Bind();
    glBindVertexArray(none.id());
    program.Use();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    CheckGl("RenderTargets");
  }
};

constexpr const char* kTwoOutputs =
    "layout(location = 0) out vec4 a; layout(location = 1) out vec4 b;\n"
    "void main() {\n"
    "  a = vec4(gl_FragCoord.xy, -1e-7, 1e9);\n"
    "  b = vec4(gl_FragCoord.y, 1.0 / 3.0, 65504.0, -2.0); }\n";

TEST_F(RenderTargets, OutputsOfOneDrawAreReadInTheirOwnFormats) {
  const RenderTarget target(4, 3, {PixelFormat::kRgba32F, PixelFormat::kRgba16F},
                            RenderTarget::Depth::k32Bit);
  Draw(target, kTwoOutputs);
  const std::vector<glm::vec4> a = target.ReadValues(0);
  ASSERT_EQ(a.size(), 12U);
  EXPECT_EQ(a[0], glm::vec4(0.5F, 2.5F, -1e-7F, 1e9F)) << "the first row is the highest";
  EXPECT_EQ(a[11], glm::vec4(3.5F, 0.5F, -1e-7F, 1e9F));
  EXPECT_EQ(target.ReadValues(1)[0], glm::vec4(2.5F, 0x555p-12F, 65504.0F, -2.0F))
      << "halves have eleven bits: 1/3 is 0x555 / 2^12";
  EXPECT_EQ(target.Read().at(3, 2)[0], 3.5F) << "reading one output leaves the others";
}

TEST_F(RenderTargets, UploadedPixelsAreReadBack) {
  const RenderTarget target(3, 2, RenderTarget::Depth::kNone);
  HdrImage image(3, 2);
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    image.rgb[i] = {static_cast<float>(i), -1.0F, 1e6F};
  }
  target.Write(image);
  EXPECT_EQ(target.Read().rgb, image.rgb);
  EXPECT_THROW(target.Write(HdrImage(2, 3)), InternalError);
}

TEST_F(RenderTargets, BytesAreReadFromTheTopRowDown) {
  const RenderTarget target(4, 3);
  Draw(target, "out vec4 a; void main() { a = vec4(gl_FragCoord.y / 4.0, 0.2, 1.0, 0.0); }\n");
  const DisplayImage image = target.ReadBytes();
  EXPECT_EQ(image.width, 4);
  EXPECT_EQ(image.rgb[0], std::lround(255 * 2.5 / 4.0)) << "of the highest row";
  EXPECT_EQ(image.rgb[1], 51);
}

TEST_F(RenderTargets, ConstructorKeepsBoundTextures) {
  const GlTexture texture;
  glBindTexture(GL_TEXTURE_2D, texture.id());
  const RenderTarget target(3, 2, RenderTarget::Depth::k32Bit);
  GLint bound = 0;
  glGetIntegerv(GL_TEXTURE_BINDING_2D, &bound);
  EXPECT_EQ(static_cast<GLuint>(bound), texture.id());
}

/// Counts how often storage of a two-dimensional texture is made during its lifetime.
class StorageCounter {
 public:
  StorageCounter() {
    const RenderTarget any(1, 1);  // epoxy replaces the function in its first call
    own_ = epoxy_glTexImage2D;
    made_ = 0;
    epoxy_glTexImage2D = Count;
  }
  ~StorageCounter() { epoxy_glTexImage2D = own_; }
  StorageCounter(const StorageCounter&) = delete;
  StorageCounter& operator=(const StorageCounter&) = delete;

  [[nodiscard]] int made() const { return made_; }

 private:
  static void Count(GLenum target, GLint level, GLint internal, GLsizei width, GLsizei height,
                    GLint border, GLenum format, GLenum type, const void* data) {
    ++made_;
    own_(target, level, internal, width, height, border, format, type, data);
  }
  static inline int made_ = 0;
  static inline PFNGLTEXIMAGE2DPROC own_ = nullptr;
};

TEST_F(RenderTargets, TextureKeepsItsStorageForEqualSizeAndFormat) {
  const GlTexture texture;
  const auto read_after = [&](GLenum format, int width, float value) {
    const std::vector<float> values(static_cast<std::size_t>(2 * width), value);
    UploadTexture(GL_TEXTURE_2D, texture, {format, width, 2, 1, GL_RED, GL_FLOAT, values.data()});
    std::vector<float> read(values.size());
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RED, GL_FLOAT, read.data());
    return read.back();
  };
  const StorageCounter storage;
  EXPECT_EQ(read_after(GL_R32F, 4, 1.0F), 1.0F);
  EXPECT_EQ(read_after(GL_R32F, 4, 2.0F), 2.0F);
  EXPECT_EQ(storage.made(), 1);
  EXPECT_EQ(read_after(GL_R32F, 8, 3.0F), 3.0F);
  EXPECT_EQ(read_after(GL_R16F, 8, 4.0F), 4.0F);
  EXPECT_EQ(storage.made(), 3) << "another size, and another format";
  CheckGl("RenderTargets");
}

TEST_F(RenderTargets, ATargetIsRecreatedOnlyForAnotherSize) {
  std::optional<RenderTarget> target;
  Fit(target, 3, 2);
  const GLuint first = target->framebuffer();
  Fit(target, 3, 2);
  EXPECT_EQ(target->framebuffer(), first);
  Fit(target, 3, 4);
  EXPECT_EQ(target->height(), 4);
}

TEST_F(RenderTargets, APictureTooLargeForMemoryIsADisplayError) {
  GLint side = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &side);
  glTexImage2D(GL_PROXY_TEXTURE_2D, 0, GL_RGBA32F, side, side, 0, GL_RGBA, GL_FLOAT, nullptr);
  GLint held = 0;
  glGetTexLevelParameteriv(GL_PROXY_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &held);
  if (held == side) GTEST_SKIP() << "this driver has memory for all that it draws";
  EXPECT_THROW(RenderTarget(side, side, RenderTarget::Depth::kNone), DisplayError);
}

// --- pictures in tiles ---

TEST(PictureTiles, CoverEveryPixelOnceAndAreNotTooLarge) {
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

TEST(PictureTiles, BeginAtMultiplesOfTheStep) {
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

TEST(PictureTiles, ASingleTileHasTheWholeView) {
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

HdrImage Painted(const ShaderProgram& program, int width, int height, const glm::dvec4& view) {
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

TEST_F(PaintedTiles, TogetherEqualThePictureInOnePiece) {
  const ShaderProgram program({{"vertex", kVertex}}, {{"fragment", kFragment}});
  const int width = 37, height = 23;
  const HdrImage whole = Painted(program, width, height, {0.0, 0.0, 1.0, 1.0});
  TiledPicture picture(width, height, 9);
  for (const TiledPicture::Tile& tile : picture.tiles()) {
    picture.Put(tile,
                Painted(program, tile.painted.width, tile.painted.height, picture.ViewOf(tile)));
  }
  const HdrImage together = picture.Take();
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

TEST_F(PaintedTiles, SizesBeyondTheDriverAreRefusedWithItsLimits) {
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

TEST(PictureMemory, PicturesTooLargeForMemoryAreRefusedInAdvance) {
  EXPECT_NO_THROW(RequireMemoryFor(64, 64, 12));
  if (!std::filesystem::exists("/proc/meminfo")) GTEST_SKIP() << "the system does not tell";
  EXPECT_THROW(RequireMemoryFor(1 << 30, 1 << 30, 12), OptionError);
}

// --- timers of passes ---

class PassTimers : public tests::Headless {
 protected:
  static std::vector<std::string> NamesOf(const std::vector<PassTime>& times) {
    std::vector<std::string> names;
    for (const PassTime& time : times) names.push_back(time.pass);
    return names;
  }
};

/// A picture whose every pixel is so many sines of sines.
class Work {
 public:
  explicit Work(int sines)
      : program_({{"vertex",
                   "void main() { vec2 p = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);\n"
                   "gl_Position = vec4(2.0 * p - 1.0, 0.0, 1.0); }"}},
                 {{"fragment",
                   "out vec4 colour; void main() { float s = gl_FragCoord.x;\n"
                   "for (int i = 0; i < " +
                       std::to_string(sines) +
                       "; ++i) s = sin(s + gl_FragCoord.y);\ncolour = vec4(s); }"}}) {
    Draw();
    glFinish();
  }
  void Draw() const {
    target_.Bind();
    glBindVertexArray(none_.id());
    program_.Use();
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }

 private:
  RenderTarget target_{128, 128, RenderTarget::Depth::kNone};
  GlVertexArray none_;
  ShaderProgram program_;
};

TEST_F(PassTimers, PassWithMoreWorkTakesLonger) {
  const Work light(1), heavy(400);
  for (const PassClock clock : {PassClock::kFinishes, PassClock::kQueries}) {
    PassTimer timer(clock);
    double least_light = 1e9, least_heavy = 1e9;
    for (int i = 0; i < 5; ++i) {
      timer.Begin("light");
      light.Draw();
      timer.Begin("heavy");  // ends the other
      heavy.Draw();
      const std::vector<PassTime> times = timer.PollAll();
      ASSERT_THAT(NamesOf(times), ElementsAre("light", "heavy"));
      EXPECT_GE(times[1].cpu_ms, 0.0);
      least_light = std::min(least_light, times[0].ms);
      least_heavy = std::min(least_heavy, times[1].ms);
    }
    EXPECT_GT(least_heavy, least_light) << "400 times the sines; the least of five, whatever else "
                                           "the machine does";
  }
}

TEST_F(PassTimers, WithoutATimerQueryNothingIsTimed) {
  const Work work(1);
  PassTimer timer;
  timer.Begin("work");
  work.Draw();
  EXPECT_TRUE(timer.PollAll().empty());
}

TEST_F(PassTimers, NumberOfUnreadResultsIsBounded) {
  PassTimer timer(PassClock::kQueries);
  for (int i = 0; i < 2000; ++i) timer.Begin("nothing");
  const std::size_t taken = timer.PollAll().size();
  EXPECT_GT(taken, 100U);
  EXPECT_LT(taken, 1000U);
  timer.Begin("again");
  EXPECT_THAT(NamesOf(timer.PollAll()), ElementsAre("again")) << "the queries are free again";
}

TEST_F(PassTimers, AnOpenPassHasNoResult) {
  for (const PassClock clock : {PassClock::kFinishes, PassClock::kQueries}) {
    PassTimer timer(clock);
    timer.Begin("open");
    EXPECT_TRUE(timer.Poll().empty());
    timer.End();
    glFinish();
    EXPECT_THAT(NamesOf(timer.Poll()), ElementsAre("open"));
  }
}

}  // namespace
}  // namespace alpenglow::viewer
