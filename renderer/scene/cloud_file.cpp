// SPDX-License-Identifier: MIT
#include "renderer/scene/cloud_file.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"
#include "renderer/clouds/cloud_grid_file.h"
#include "renderer/layer.h"
#include "renderer/scene/vdb_file.h"
#include "renderer/scene/volume_file.h"

namespace alpenglow::renderer {
namespace {

namespace fs = std::filesystem;

/// Densities at places, x fastest, z slowest.
struct PlacedDensities {
  std::array<int, 3> count{};
  glm::dvec3 spacing_m{1.0}, first_m{0.0};
  std::vector<float> values;
};

void CheckCount(const fs::path& file, const std::array<int, 3>& count) {
  const double samples = static_cast<double>(count[0]) * count[1] * count[2];
  if (samples > kMostCloudSamples) {
    RefuseFile(file, fmt::format("{} x {} x {} samples; there may be {:.0f} at most", count[0],
                                 count[1], count[2], kMostCloudSamples));
  }
}

PlacedDensities FromVolume(const VolumeGrid& grid, const CloudFileOptions& options) {
  return {grid.size(), *options.spacing_m, glm::dvec3(0.0), grid.values()};
}

PlacedDensities FromNrrd(const fs::path& file, const CloudFileOptions& options) {
  if (!options.spacing_m)
    RefuseFile(file, "NRRD files of clouds need the spacing of their samples");
  CheckCount(file, ReadNrrdHeader(file).size);
  return FromVolume(ReadNrrd(file), options);
}

PlacedDensities FromRaw(const fs::path& file, const CloudFileOptions& options) {
  if (!options.spacing_m || !options.samples) {
    RefuseFile(file, "raw files of clouds need the numbers and the spacing of their samples");
  }
  CheckCount(file, *options.samples);
  return FromVolume(ReadRawGrid(file, *options.samples), options);
}

void CheckDensities(const fs::path& file, const VdbGrid& grid) {
  for (std::size_t i = 0; i < grid.values.size(); ++i) {
    if (grid.values[i] >= 0.0F && std::isfinite(grid.values[i])) continue;
    RefuseFile(file, fmt::format("value {} in the box of grid \"{}\" is {}; densities must be "
                                 "finite and not negative",
                                 i, Printable(grid.name), grid.values[i]));
  }
}

/// Returns the samples of a grid within its box and one sample around it, which has the background,
/// in the order of axes of this project.
PlacedDensities FromVdb(const fs::path& file, const CloudFileOptions& options) {
  const VdbGrid grid = ReadVdb(file, options.grid, kMostCloudSamples);
  CheckDensities(file, grid);
  // The axis of the file along each axis of the field, and whether it runs in the other direction.
  const std::array<int, 3> axis_of{0, options.is_y_up ? 2 : 1, options.is_y_up ? 1 : 2};
  const int around = options.is_periodic ? 0 : 1;
  PlacedDensities placed;
  std::array<bool, 3> is_reversed{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double sign = options.is_y_up && axis == 1 ? -1.0 : 1.0;
    const int from = axis_of[a];
    const double step = sign * grid.spacing[from], first = sign * grid.origin[from];
    const int size = grid.size[static_cast<std::size_t>(from)];
    is_reversed[a] = step < 0.0;
    placed.count[a] = size + (axis == 2 ? 2 : 2 * around);
    placed.spacing_m[axis] = options.spacing_m ? (*options.spacing_m)[axis] : std::abs(step);
    const double scale = placed.spacing_m[axis] / std::abs(step);
    const double least = is_reversed[a] ? first + step * (size - 1) : first;
    placed.first_m[axis] =
        scale * least - (axis == 2 ? 1.0 : double(around)) * placed.spacing_m[axis];
  }
  CheckCount(file, placed.count);
  const auto value = [&](std::array<int, 3> at) {
    std::array<int, 3> in_file{};
    for (std::size_t a = 0; a < 3; ++a) {
      const auto from = static_cast<std::size_t>(axis_of[a]);
      const int number = at[a] - (a == 2 ? 1 : around);
      if (number < 0 || number >= grid.size[from]) return grid.background;
      in_file[from] = is_reversed[a] ? grid.size[from] - 1 - number : number;
    }
    return grid.At(in_file[0], in_file[1], in_file[2]);
  };
  for (int z = 0; z < placed.count[2]; ++z) {
    for (int y = 0; y < placed.count[1]; ++y) {
      for (int x = 0; x < placed.count[0]; ++x) placed.values.push_back(value({x, y, z}));
    }
  }
  return placed;
}

CloudField FieldOf(const fs::path& file, PlacedDensities placed, const CloudFileOptions& options) {
  using Ranges = CloudFileRanges;
  RequireInRange(options.extinction_per_m, Ranges::kExtinction_per_m.first,
                 Ranges::kExtinction_per_m.second, "the extinction of the density 1 [1/m]");
  RequireInRange(options.effective_radius_um, Ranges::kRadius_um.first, Ranges::kRadius_um.second,
                 "the effective radius [um]");
  CloudLattice lattice;
  lattice.is_periodic = options.is_periodic;
  const int ends = options.is_periodic ? 0 : 1;
  lattice.voxels = {placed.count[0] - ends, placed.count[1] - ends, placed.count[2] - 1};
  lattice.voxel_m = placed.spacing_m;
  lattice.origin_m = placed.first_m + options.origin_m;
  CloudSamples samples;
  samples.extinction_per_m = std::move(placed.values);
  for (float& value : samples.extinction_per_m) {
    value = static_cast<float>(static_cast<double>(value) * options.extinction_per_m);
  }
  samples.effective_radius_um.assign(samples.extinction_per_m.size(),
                                     static_cast<float>(options.effective_radius_um));
  try {
    return {lattice, samples};
  } catch (const InputError& error) {
    RefuseFile(file, error.what());
  }
}

CloudField TextField(const fs::path& file, const CloudFileOptions& options) {
  if (options.spacing_m || options.origin_m.z != 0.0) {
    RefuseFile(file,
               "text has the spacing and the altitudes of its samples; no others can be given");
  }
  return ReadCloudGrid(file, options.is_periodic).Moved(glm::dvec2(options.origin_m));
}

}  // namespace

CloudField ReadCloudField(const fs::path& file, const CloudFileOptions& options) {
  if (HasExtension(file, ".txt") || HasExtension(file, ".dat")) return TextField(file, options);
  if (HasExtension(file, ".vdb")) return FieldOf(file, FromVdb(file, options), options);
  if (HasExtension(file, ".nrrd") || HasExtension(file, ".nhdr")) {
    return FieldOf(file, FromNrrd(file, options), options);
  }
  if (HasExtension(file, ".raw")) return FieldOf(file, FromRaw(file, options), options);
  RefuseFile(file,
             "this ending of a file of clouds is not known; it must be .txt, .dat, .vdb, .nrrd, "
             ".nhdr or .raw");
}

}  // namespace alpenglow::renderer
