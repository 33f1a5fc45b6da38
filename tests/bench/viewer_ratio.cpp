// SPDX-License-Identifier: MIT
// Measures the time of a viewer frame relative to a reference pass in the same run. The pass sums
// 32 interpolated look-ups per pixel in a three-dimensional texture of four floats. Slow or busy
// machines are slower at both, so CTest can limit the ratio.
//   viewer_ratio
// The program prints time, ratio and limit of each frame. The exit status is 1 if a ratio exceeds
// its limit, and 77 (skipped) without software OpenGL, because graphics cards draw faster than
// their drivers can be queried.
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <string>
#include <vector>

#include "renderer/scene/scene_options.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/viewer/air/shared_air.h"
#include "viewer/gl/gl_context.h"
#include "viewer/gl/pass_timer.h"
#include "viewer/passes/auto_quality.h"
#include "viewer/passes/frame_renderer.h"
#include "viewer/passes/sky_painter.h"
#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {
namespace {

constexpr int kWidth = 640, kHeight = 360;
constexpr int kSkipped = 77;

constexpr char kReferenceText[] =
    "in vec2 screen;\n"
    "out vec4 picture;\n"
    "uniform sampler3D table;\n"
    "void main() {\n"
    "  vec3 at = vec3(0.5 + 0.4 * screen, 0.1);\n"
    "  vec4 sum = vec4(0.0);\n"
    "  for (int i = 0; i < 32; ++i) sum += texture(table, at + float(i) * vec3(0.001, 0.002, "
    "0.02));\n"
    "  picture = sum;\n"
    "}\n";

class ReferencePass {
 public:
  ReferencePass()
      : program_(FullScreenProgram({{"reference pass", kReferenceText}})),
        target_(kWidth, kHeight, RenderTarget::Depth::kNone) {
    constexpr int kSide = 32;
    const std::vector<float> texels(std::size_t{4} * kSide * kSide * kSide, 0.25F);
    glActiveTexture(GL_TEXTURE0 + kUnit);
    glBindTexture(GL_TEXTURE_3D, table_.id());
    glTexImage3D(GL_TEXTURE_3D, 0, GL_RGBA32F, kSide, kSide, kSide, 0, GL_RGBA, GL_FLOAT,
                 texels.data());
    ClampAndFilter(GL_TEXTURE_3D, true);
    program_.BindSampler("table", kUnit);
    CheckGl("ReferencePass");
  }

  void Draw() const {
    target_.Bind();
    glActiveTexture(GL_TEXTURE0 + kUnit);
    glBindTexture(GL_TEXTURE_3D, table_.id());
    DrawFullScreen(program_, no_vertices_);
  }

 private:
  static constexpr int kUnit = 0;
  ShaderProgram program_;
  RenderTarget target_;
  GlTexture table_;
  GlVertexArray no_vertices_;
};

template <typename Draw>
double MillisecondsOf(const Draw& draw) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  draw();
  glFinish();
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

struct View {
  const char* name;
  Scene scene;
  Quality quality;
  double limit;  // of the ratio to the time of the reference pass
};

// Limits are one and a half to two times the measured ratios (README.md), so that only lasting
// losses are found.
std::vector<View> Views() {
  Scene range = BareScene(2000.0, 160.0, -3.0, 60.0);
  range.terrain.kind = TerrainSource::Kind::kProceduralMountains;
  range.camera.height.above_ground = true;
  return {{"sky", BareScene(2.0, 80.0, 20.0, 90.0), Quality::kMedium, 0.7},
          {"built-in range", range, Quality::kMedium, 2.5},
          {"built-in range, low", range, Quality::kLow, 1.2}};
}

/// The shortest of several times, because other load on the machine only adds time.
struct Times {
  double frame_ms = 1e9, reference_ms = 1e9;
};

Times TimesOf(const View& view) {
  constexpr int kFrames = 16;
  CameraPose eye{view.scene.place, view.scene.camera.heading_rad, view.scene.camera.pitch_rad, 0.0,
                 view.scene.camera.fov_rad};
  eye.place.height_m = LoadGround(view.scene).eye_height_m;
  const double scale = PaintedAlways(view.quality).scale;
  const PaintedView painted{eye, ParseInstant("2026-06-21T05:30:00Z"),
                            static_cast<int>(scale * kWidth), static_cast<int>(scale * kHeight)};
  SkyPainter painter(view.scene, LandSourceOf(view.scene), painted, SizesOf(view.quality),
                     tests::SharedAirOf(view.scene));
  painter.WaitUntilReady(painted);
  DisplayPass display_pass(Look{});
  FrameDisplay display(painter, display_pass);
  const RenderTarget screen(kWidth, kHeight, {PixelFormat::kRgba8}, RenderTarget::Depth::kNone);
  const auto draw = [&] {
    constexpr double kEv100 = 13.0;
    painter.Paint(painted, 1, SkyPainter::Bodies::kNone);
    display.Show(painted, kEv100, {screen.framebuffer(), kWidth, kHeight});
  };
  const ReferencePass reference;
  Times times;
  for (int frame = 0; frame <= kFrames; ++frame) {
    const double frame_ms = MillisecondsOf(draw);
    const double reference_ms = MillisecondsOf([&] { reference.Draw(); });
    if (frame == 0) continue;  // drivers compile when they first draw
    times.frame_ms = std::min(times.frame_ms, frame_ms);
    times.reference_ms = std::min(times.reference_ms, reference_ms);
  }
  return times;
}

int Run() {
  const HeadlessContext context;
  if (TruthfulPassClock() != PassClock::kFinishes) {
    fmt::print("skipped: {} is no software OpenGL\n", GlDescription());
    return kSkipped;
  }
  int status = 0;
  for (const View& view : Views()) {
    const Times times = TimesOf(view);
    const double ratio = times.frame_ms / times.reference_ms;
    const bool holds = ratio <= view.limit;
    fmt::print("{}: {:.1f} ms, {:.2f} times the reference pass of {:.1f} ms; limit {:.1f}{}\n",
               view.name, times.frame_ms, ratio, times.reference_ms, view.limit,
               holds ? "" : ": TOO SLOW");
    if (!holds) status = 1;
  }
  return status;
}

}  // namespace
}  // namespace alpenglow::viewer

int main() {
  // Mesa's software OpenGL gets one thread for pixels, because vertices have only one in any case.
  setenv("LP_NUM_THREADS", "1", 1);
  return alpenglow::viewer::Run();
}
