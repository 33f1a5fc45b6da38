// SPDX-License-Identifier: MIT
// Measures the time of the air in front of terrain, per pixel: aerial perspective at four bands,
// shafts by shadow heights, shafts by 512 occlusion rays. Run by hand; results are in README.md.
#include <benchmark/benchmark.h>

#include "atmosphere/math/constants.h"
#include "renderer/visibility/sunlit_path.h"
#include "tests/fixtures/occlusion_march.h"

namespace alpenglow::renderer {
namespace {

/// The built-in range, and all data that a picture of it needs.
struct World {
  World()
      : ground([] {
          Scene scene;
          scene.place = {47.0 * kRadiansPerDegree, 11.0 * kRadiansPerDegree, 0.0};
          scene.medium = MediumPreset("earth");
          scene.camera.height = {300.0, true};
          return LoadGround(scene);
        }()),
        air(MediumPreset("earth")),
        multiple_scattering(air.medium()),
        aerial(air, multiple_scattering) {}

  SceneGround ground;
  SingleScattering<float> air;
  MultipleScattering multiple_scattering;
  AerialPerspective aerial;
};

const World& TheWorld() {
  static const World kWorld;
  return kWorld;
}

/// A view and the lengths of its rays, which are infinite where a ray misses terrain.
struct TerrainRays {
  explicit TerrainRays(double sun_deg)
      : view(ViewWithSun(TheWorld().ground.eye_height_m, 200.0, sun_deg, 64, 36)) {
    for (std::size_t i = 0; i < view.directions.size(); ++i)
      length_m.push_back(LengthOf(view, i, *TheWorld().ground.terrain));
  }

  [[nodiscard]] std::size_t Next(std::size_t i, bool terrain_only) const {
    do {
      i = (i + 1) % length_m.size();
    } while (terrain_only && std::isinf(length_m[i]));
    return i;
  }

  ShaftView view;
  std::vector<double> length_m;
};

void AerialPerspectiveOfOnePixel(benchmark::State& state) {
  const TerrainRays rays(20.0);
  std::size_t i = 0;
  for (auto unused : state) {
    i = rays.Next(i, true);
    benchmark::DoNotOptimize(TheWorld().aerial.Along(RayOf(rays.view, i, rays.length_m[i]), {}));
  }
}
BENCHMARK(AerialPerspectiveOfOnePixel);

void SingleScatteringOfOnePixel(benchmark::State& state) {
  const TerrainRays rays(20.0);
  const World& world = TheWorld();
  std::size_t i = 0;
  for (auto unused : state) {
    i = rays.Next(i, true);
    benchmark::DoNotOptimize(world.aerial.Once(RayOf(rays.view, i, rays.length_m[i]), nullptr, {}));
  }
}
BENCHMARK(SingleScatteringOfOnePixel);

void SweepOfShadowHeights(benchmark::State& state) {
  const TerrainRays rays(8.0);
  for (auto unused : state) {
    benchmark::DoNotOptimize(
        ShadowHeights(TheWorld().ground.terrain->mesh(), rays.view.to_sun, rays.view.sun_radius_rad)
            .bytes());
  }
}
BENCHMARK(SweepOfShadowHeights)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

void ShaftsOfOnePixel(benchmark::State& state) {
  const TerrainRays rays(static_cast<double>(state.range(0)));
  const World& world = TheWorld();
  const ShadowHeights shadow(world.ground.terrain->mesh(), rays.view.to_sun,
                             rays.view.sun_radius_rad);
  std::size_t i = 0;
  for (auto unused : state) {
    i = rays.Next(i, false);
    const ViewRay ray = RayOf(rays.view, i, rays.length_m[i]);
    const SunlitPath path =
        shadow.Along(rays.view.eye, rays.view.directions[i], std::min(ray.length_m, 2000e3));
    benchmark::DoNotOptimize(world.aerial.Once(ray, &path, {}));
  }
}
BENCHMARK(ShaftsOfOnePixel)->Arg(15)->Arg(8)->Arg(3)->Arg(1)->ArgName("sun");

void ShaftsBy512OcclusionRays(benchmark::State& state) {
  const TerrainRays rays(static_cast<double>(state.range(0)));
  const World& world = TheWorld();
  (void)DiskPoints();
  std::size_t i = 0;
  for (auto unused : state) {
    i = rays.Next(i, false);
    benchmark::DoNotOptimize(
        MarchWithOcclusion(world.air, rays.view, i, *world.ground.terrain, 512));
  }
}
BENCHMARK(ShaftsBy512OcclusionRays)->Arg(15)->Arg(8)->Arg(3)->Arg(1)->ArgName("sun");

void ShaftsBySunProbes(benchmark::State& state) {
  const TerrainRays rays(static_cast<double>(state.range(0)));
  const World& world = TheWorld();
  const SunProbes probes(*world.ground.terrain, rays.view.to_sun, rays.view.sun_radius_rad);
  std::size_t i = 0;
  for (auto unused : state) {
    i = rays.Next(i, false);
    const ViewRay ray = RayOf(rays.view, i, rays.length_m[i]);
    const SunlitPath path =
        probes.Along(rays.view.eye, rays.view.directions[i], std::min(ray.length_m, 2000e3));
    benchmark::DoNotOptimize(world.aerial.Once(ray, &path, {}));
  }
}
BENCHMARK(ShaftsBySunProbes)->Arg(15)->Arg(3)->ArgName("sun");

}  // namespace
}  // namespace alpenglow::renderer
