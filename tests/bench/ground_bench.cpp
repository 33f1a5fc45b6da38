// SPDX-License-Identifier: MIT
// Measures the time of light on the viewer's ground on one thread: preparing a position of the sun,
// and lighting vertices. Run by hand; results are in README.md.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/constants.h"
#include "renderer/lit_ground/lit_ground.h"
#include "renderer/procedural_mountains/procedural_mountains.h"

namespace alpenglow::renderer {
namespace {

constexpr Place kPlace{47.0, 11.0, 0.0};

std::shared_ptr<const GroundSite> NewSite() {
  static const Medium kMedium = OnOsculatingSphere(MediumPreset("earth"), kPlace.latitude_rad());
  static const SolvedAir kAir{SingleScattering<float>(kMedium), RefractedBeam(kMedium),
                              MultipleScattering(kMedium)};
  static const ElevationGrid kRange = ProceduralMountains(kPlace);
  return std::make_shared<const GroundSite>(GroundOf(kRange, LocalFrame(kWgs84, kPlace)),
                                            GroundCover{}, nullptr, kAir);
}

const std::shared_ptr<const GroundSite>& TheSite() {
  static const std::shared_ptr<const GroundSite> kSite = NewSite();
  return kSite;
}

Lighting SunAt(double elevation_deg) {
  SunInSky sun{};
  sun.elevation_deg = elevation_deg;
  sun.azimuth_deg = 2.0 / kRadiansPerDegree;
  sun.angular_radius_deg = 0.00465 / kRadiansPerDegree;
  sun.distance_au = 1.0;
  return LightingOf(sun, ParseInstant("2026-03-21T12:00:00Z"), kPlace, TheSite()->medium());
}

void ASitePrepared(benchmark::State& state) {
  const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
  (void)TheSite();
  for (auto unused : state) benchmark::DoNotOptimize(NewSite());
}
BENCHMARK(ASitePrepared)->Unit(benchmark::kMillisecond);

void ASunPrepared(benchmark::State& state) {
  const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
  (void)TheSite();
  for (auto unused : state)
    benchmark::DoNotOptimize(LitGround(TheSite(), SunAt(static_cast<double>(state.range(0)))));
}
BENCHMARK(ASunPrepared)->Arg(30)->Arg(5)->Unit(benchmark::kMillisecond);

void SkyOfASunPrepared(benchmark::State& state) {
  const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
  (void)TheSite();
  const Lighting light = SunAt(10.0);
  for (auto unused : state) benchmark::DoNotOptimize(TheSite()->Under(light));
}
BENCHMARK(SkyOfASunPrepared)->Unit(benchmark::kMillisecond);

// The argument is the distance between lines [m].
void ShadowPrepared(benchmark::State& state) {
  const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
  const Lighting light = SunAt(10.0);
  ShadowHeights::Options options = LitGround::kShadowOfVertices;
  options.cell_m = static_cast<double>(state.range(0));
  for (auto unused : state) {
    benchmark::DoNotOptimize(ShadowHeights(TheSite()->ground().terrain->mesh(),
                                           light.source.direction.seen, light.source.radius_rad,
                                           options));
  }
}
BENCHMARK(ShadowPrepared)->Arg(0)->Arg(60)->Arg(90)->Arg(120)->Unit(benchmark::kMillisecond);

void VerticesPlaced(benchmark::State& state) {
  const TriangleMesh& mesh = TheSite()->ground().terrain->mesh();
  for (auto unused : state) {
    for (std::size_t i = 0; i < 160000; ++i)
      benchmark::DoNotOptimize(TheSite()->Vertex(mesh.positions[6 * i], mesh.normals[6 * i]));
  }
}
BENCHMARK(VerticesPlaced)->Unit(benchmark::kMillisecond);

void VerticesLit(benchmark::State& state) {
  const LitGround lit(TheSite(), SunAt(10.0));
  const TriangleMesh& mesh = TheSite()->ground().terrain->mesh();
  std::vector<GroundVertex> vertices;
  for (std::size_t i = 0; i < 160000; ++i) {
    const std::size_t at = i * (mesh.positions.size() / 160000);
    vertices.push_back(TheSite()->Vertex(mesh.positions[at], mesh.normals[at]));
  }
  for (auto unused : state) {
    for (const GroundVertex& vertex : vertices) benchmark::DoNotOptimize(lit.At(vertex));
  }
}
BENCHMARK(VerticesLit)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace alpenglow::renderer
