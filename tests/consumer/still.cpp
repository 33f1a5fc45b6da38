// SPDX-License-Identifier: MIT
// An example of README.md: a still of an elevation model, as EXR and PNG.
//
//   still FOLDER [DEM LATITUDE LONGITUDE]     without a model: the built-in mountains
#include <alpenglow/alpenglow.h>

#include <cstdio>
#include <cstdlib>

using namespace alpenglow;

int main(int argc, char** argv) {
  const std::filesystem::path folder = argc > 1 ? argv[1] : ".";
  SceneDescription description = BuiltInScene();
  if (argc > 4) {
    description.terrain = TerrainKind::kElevationModel;
    description.elevation_model = argv[2];
    description.place = {std::atof(argv[3]), std::atof(argv[4])};
    description.camera = {.height_m = 50.0, .heading_deg = 45.0};
  }
  try {
    const Scene scene(description);
    const UtcTime time = TimeFromText("2026-06-21T16:00:00Z");
    const HdrImage still = scene.Render(time, {.width = 160, .height = 90});
    WriteExr(folder / "still.exr", still);
    WritePng(folder / "still.png", still);
    std::printf("sun at %.1f degrees, %.0f lx\n", SunAt(description.place, time).elevation_deg,
                scene.HorizontalIlluminance(time));
  } catch (const InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
}
