// SPDX-License-Identifier: MIT
// Measures the memory for a picture over a large elevation model: writes a synthetic tile, renders
// over it with shafts, and prints the maximum resident memory. Run by hand; results are in
// README.md.
//   studies tile_memory [samples per side; default 3601 as in 1" tiles of SRTM]
#include <fmt/core.h>
#include <sys/resource.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/time_place/time.h"
#include "renderer/picture/render.h"
#include "renderer/procedural_mountains/lattice_noise.h"
#include "tests/bench/studies.h"

namespace alpenglow::renderer {
namespace {

// Writes ranges up to 3 km high in the format of SRTM: big-endian, row by row from the north.
void WriteTile(const std::filesystem::path& file, int side) {
  std::ofstream out(file, std::ios::binary);
  std::vector<char> row;
  for (int r = 0; r < side; ++r) {
    row.clear();
    for (int c = 0; c < side; ++c) {
      const double scale = 10.0 / side;
      const auto height =
          static_cast<std::uint16_t>(3000.0 * RidgedNoise(scale * c, scale * r, 6, 5U));
      row.push_back(static_cast<char>(height >> 8U));
      row.push_back(static_cast<char>(height & 0xffU));
    }
    out.write(row.data(), static_cast<std::streamsize>(row.size()));
  }
}

double PeakMegabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

void Measure(int side) {
  // The name of an SRTM tile contains its position.
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "N46E008.hgt";
  WriteTile(file, side);
  Scene scene;
  scene.place = {46.5, 8.5, 0.0};
  scene.medium = MediumPreset("earth");
  scene.camera.height = {300.0, true};
  scene.terrain.kind = TerrainSource::Kind::kElevationModel;
  scene.terrain.file = file;
  const double before = PeakMegabytes();
  const SceneRenderer renderer(scene);
  const double loaded = PeakMegabytes();
  RenderSettings settings;
  settings.width = 320;
  settings.height = 180;
  (void)renderer.Render(ParseInstant("2026-06-21T18:00:00Z"), settings);
  std::filesystem::remove(file);
  fmt::print(
      "{0} x {0} samples: {1:.0f} MB before, {2:.0f} MB loaded, {3:.0f} MB after a picture\n", side,
      before, loaded, PeakMegabytes());
}

}  // namespace
}  // namespace alpenglow::renderer

void alpenglow::tests::TileMemory(int argc, char** argv) {
  renderer::Measure(argc > 1 ? std::atoi(argv[1]) : 3601);
}
