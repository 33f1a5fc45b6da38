// SPDX-License-Identifier: MIT
// Measures the time of the viewer's tables of the air: computing them, and passes over whole
// pictures that read them. Run by hand; LIBGL_ALWAYS_SOFTWARE=1 selects software OpenGL.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "atmosphere/medium/atmosphere_file.h"
#include "atmosphere/medium/medium.h"
#include "lut/camera_tables/air_tables.h"
#include "tests/fixtures/solved_media.h"
#include "viewer/air/air_follower.h"
#include "viewer/gl/gl_context.h"
#include "viewer/gl/render_target.h"
#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {
namespace {

using tests::Earth;

const MediumTables& Phases() {
  static const MediumTables tables = MakeMediumTables(Earth());
  return tables;
}

AirTables Tables(AirQuality quality, double altitude_m) {
  const glm::dvec3 to_light(std::sqrt(1.0 - 0.3 * 0.3), 0.0, 0.3);
  return MakeAirTables(Earth(), Phases(), {altitude_m, Unrefracted(to_light)},
                       AirTablesSizeOf(quality, altitude_m));
}

void MakingOfAirTables(benchmark::State& state) {
  static_cast<void>(Phases());  // computed before measuring
  for (auto unused : state) {
    benchmark::DoNotOptimize(
        Tables(static_cast<AirQuality>(state.range(0)), static_cast<double>(state.range(1))));
  }
}
BENCHMARK(MakingOfAirTables)
    ->ArgsProduct({{0, 1, 2, 3}, {1500, 400000}})
    ->ArgNames({"quality", "altitude"})
    ->Unit(benchmark::kMillisecond);

void UploadOfAirTables(benchmark::State& state) {
  const HeadlessContext context;
  const AirTables tables = Tables(AirQuality::kHigh, static_cast<double>(state.range(0)));
  AirTextures textures;
  for (auto unused : state) {
    textures.Upload(tables);
    glFinish();
  }
}
BENCHMARK(UploadOfAirTables)->Arg(1500)->Arg(400000)->Unit(benchmark::kMillisecond);

void SolvingOfAir(benchmark::State& state) {
  const Medium medium = MediumPreset(state.range(0) == 0 ? "earth" : "hazy");
  for (auto unused : state) benchmark::DoNotOptimize(TabulateAir(medium));
}
BENCHMARK(SolvingOfAir)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->UseRealTime();

void MakingOfMediumTables(benchmark::State& state) {
  for (auto unused : state) benchmark::DoNotOptimize(MakeMediumTables(Earth()));
}
BENCHMARK(MakingOfMediumTables)->Unit(benchmark::kMillisecond);

void MakingOfIntegrator(benchmark::State& state) {
  const Medium medium = MediumFromToml("[aerosol]\nmixture = \"desert\"\n", "dusty");
  for (auto unused : state) benchmark::DoNotOptimize(SingleScattering<float>(medium));
}
BENCHMARK(MakingOfIntegrator)->Unit(benchmark::kMillisecond);

// Draws a picture of width x height. `statement` computes a pixel from a unit vector `direction`
// and a distance `km`.
void Pass(benchmark::State& state, const std::string& statement, int width, int height) {
  const HeadlessContext context;
  AirTextures textures;
  textures.Upload(MakeMediumTables(Earth()));
  textures.Upload(Tables(static_cast<AirQuality>(state.range(0)), 1500.0));
  const glm::dvec3 sun(0.0, std::sqrt(1.0 - 0.09), 0.3);
  textures.SetView(1500.0, {sun, sun});
  std::vector<ShaderPiece> pieces = SharedTexts();
  for (ShaderPiece& piece : AirTableTexts()) pieces.push_back(std::move(piece));
  pieces.push_back({"main", fmt::format("in vec2 screen;\nout vec4 picture;\nvoid main() {{\n"
                                        "  vec3 direction = normalize(vec3(0.6 * screen.x, 1.0, "
                                        "0.35 * screen.y));\n"
                                        "  float km = 60.0 + 50.0 * screen.x;\n"
                                        "  {}\n}}\n",
                                        statement)});
  const ShaderProgram program = FullScreenProgram(pieces);
  AirTextures::Prepare(program, 0, 0);
  const RenderTarget target(width, height, RenderTarget::Depth::kNone);
  const GlVertexArray no_vertices;
  const auto draw = [&] {
    target.Bind();
    textures.Bind(0, 0);
    DrawFullScreen(program, no_vertices);
    glFinish();
  };
  draw();  // drivers compile at the first draw
  for (auto unused : state) draw();
  CheckGl("Pass");
  state.SetLabel(GlDescription());
  state.SetItemsProcessed(state.iterations() * width * height);
}

void PassOf(benchmark::State& state, const char* expression) { Pass(state, expression, 1280, 720); }
#define ALPENGLOW_PASS(name, statement)      \
  BENCHMARK_CAPTURE(PassOf, name, statement) \
      ->Arg(3)                               \
      ->Unit(benchmark::kMillisecond)        \
      ->UseRealTime()                        \
      ->MeasureProcessCPUTime()
ALPENGLOW_PASS(nothing, "picture = vec4(direction, km);");
ALPENGLOW_PASS(sky, "picture = SkyRadiance(direction);");
ALPENGLOW_PASS(through, "picture = TransmittanceToSpace(direction);");
ALPENGLOW_PASS(to_sun, "picture = TransmittanceToSun(0.01 * km, 0.3 + 0.2 * direction.x);");
ALPENGLOW_PASS(single, "picture = SingleTo(direction, km);");
ALPENGLOW_PASS(way,
               "AirTo to = AirToPoint(direction, km);"
               "picture = to.single + to.diffuse + to.transmittance;");

ALPENGLOW_PASS(all_of_it,
               "AirTo to = AirToPoint(direction, km);"
               "picture = km > 60.0 ? SkyRadiance(direction) : to.single + to.diffuse + "
               "0.1 * to.transmittance - SingleTo(direction, 0.5 * km);");

void SkyAlone(benchmark::State& state) {
  Pass(state, "picture = SkyRadiance(direction);", 512, 512);
}
BENCHMARK(SkyAlone)->Arg(3)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace alpenglow::viewer
