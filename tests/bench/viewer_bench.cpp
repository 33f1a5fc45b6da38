// SPDX-License-Identifier: MIT
// Time of the viewer's tables of the air: making them, and passes over whole pictures that read
// them. Run by hand; LIBGL_ALWAYS_SOFTWARE=1 for software OpenGL.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/fixtures/lit_air.h"
#include "viewer/air/air_textures.h"
#include "viewer/embedded_text.h"
#include "viewer/gl/gl_context.h"
#include "viewer/gl/render_target.h"

namespace alpenglow {
namespace {

using tests::Earth;

constexpr AirTablesSize kSmall{};
constexpr AirTablesSize kLarge{.sky_columns = 192,
                               .sky_rows = 192,
                               .sky_ground_rows = 128,
                               .columns = 64,
                               .rows = 32,
                               .ground_rows = 32,
                               .distances = 32,
                               .extinction_rows = 128,
                               .extinction_ground_rows = 128,
                               .extinction_distances = 64};

AirTables Tables(bool large) {
  return MakeAirTables(Earth().air, Earth().diffuse, {1500.0, 0.3}, large ? kLarge : kSmall);
}

void MakingOfAirTables(benchmark::State& state) {
  for (auto unused : state) benchmark::DoNotOptimize(Tables(state.range(0) != 0));
}
BENCHMARK(MakingOfAirTables)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

// A picture of width x height whose pixels are `expression` of a unit vector `direction` and of a
// distance `km`.
void Pass(benchmark::State& state, const std::string& expression, int width, int height) {
  const HeadlessContext context;
  AirTextures textures;
  textures.Upload(MakeMediumTables(Earth().air));
  textures.Upload(Tables(state.range(0) != 0));
  textures.SetView(1500.0, {0.0, std::sqrt(1.0 - 0.09), 0.3});
  std::vector<ShaderPiece> pieces = SharedTexts();
  for (ShaderPiece& piece : AirTableTexts()) pieces.push_back(std::move(piece));
  pieces.push_back({"main", fmt::format("in vec2 screen;\nout vec4 picture;\nvoid main() {{\n"
                                        "  vec3 direction = normalize(vec3(0.6 * screen.x, 1.0, "
                                        "0.35 * screen.y));\n"
                                        "  float km = 60.0 + 50.0 * screen.x;\n"
                                        "  picture = {};\n}}\n",
                                        expression)});
  const ShaderProgram program(
      {{"full", std::string(viewer::EmbeddedText("viewer/shaders/full_screen.vert.glsl"))}},
      pieces);
  AirTextures::Prepare(program, 0, 0);
  const RenderTarget target(width, height, RenderTarget::Depth::kNone);
  const GlVertexArray no_vertices;
  for (auto unused : state) {
    target.Bind();
    program.Use();
    textures.Bind(0, 0);
    glBindVertexArray(no_vertices.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glFinish();
  }
  CheckGl("Pass");
  state.SetLabel(GlDescription());
  state.SetItemsProcessed(state.iterations() * width * height);
}

void PassOf(benchmark::State& state, const char* expression) { Pass(state, expression, 1280, 720); }
#define ALPENGLOW_PASS(name, expression)      \
  BENCHMARK_CAPTURE(PassOf, name, expression) \
      ->Arg(0)                                \
      ->Arg(1)                                \
      ->Unit(benchmark::kMillisecond)         \
      ->UseRealTime()                         \
      ->MeasureProcessCPUTime()
ALPENGLOW_PASS(nothing, "vec4(direction, km)");
ALPENGLOW_PASS(sky, "SkyRadiance(direction)");
ALPENGLOW_PASS(through, "TransmittanceToSpace(direction)");
ALPENGLOW_PASS(to_sun, "TransmittanceToSun(0.01 * km, 0.3 + 0.2 * direction.x)");
ALPENGLOW_PASS(single, "SingleTo(direction, km)");
ALPENGLOW_PASS(way,
               "(AirToPoint(direction, km).single + AirToPoint(direction, km).diffuse) + "
               "AirToPoint(direction, km).transmittance");

void SkyAlone(benchmark::State& state) { Pass(state, "SkyRadiance(direction)", 512, 512); }
BENCHMARK(SkyAlone)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace alpenglow
