// SPDX-License-Identifier: MIT
// Measures the errors of shafts, and of one march of 512 occlusion rays per pixel, relative to 4096
// occlusion rays. Run by hand; results are in README.md.
//   shaft_error [elevation model around 35.5 N 138.75 E]
#include <fmt/core.h>

#include "atmosphere/math/constants.h"
#include "tests/fixtures/occlusion_march.h"

int main(int argc, char** argv) {
  using namespace alpenglow::renderer;
  Scene scene;
  scene.place = {47.0 * kRadiansPerDegree, 11.0 * kRadiansPerDegree, 0.0};
  scene.medium = MediumPreset("earth");
  scene.camera.height = {300.0, true};
  if (argc > 1) {
    scene.place = {35.5 * kRadiansPerDegree, 138.75 * kRadiansPerDegree, 0.0};
    scene.terrain.kind = TerrainSource::Kind::kElevationModel;
    scene.terrain.file = argv[1];
  }
  const SceneGround ground = LoadGround(scene);
  fmt::print("heading sun     shafts: rms  99 %      512 rays: rms  99 %      no shafts: rms\n");
  for (const double heading : {90.0, 200.0}) {
    for (const double sun : {15.0, 8.0, 3.0, 1.0}) {
      const auto pixels =
          MeasureShafts(ground, ViewWithSun(ground.eye_height_m, heading, sun, 48, 27));
      const ShaftError found = ErrorOf(pixels, &ShaftPixel::found);
      const ShaftError march = ErrorOf(pixels, &ShaftPixel::march);
      fmt::print("{:5.0f} {:5.0f}    {:.2e} {:.2e}       {:.2e} {:.2e}          {:.2e}\n", heading,
                 sun, found.rms, found.at_99_percent, march.rms, march.at_99_percent,
                 ErrorOf(pixels, &ShaftPixel::unbroken).rms);
    }
  }
}
