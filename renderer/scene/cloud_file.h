// SPDX-License-Identifier: MIT
// Fields of clouds of others from files, by the ending of their names:
//
//   .txt, .dat      text of I3RC and SHDOM: places, extinction and radius (clouds/cloud_grid_file.h)
//   .vdb            OpenVDB: densities and places (vdb_file.h)
//   .nrrd, .nhdr    NRRD: densities (volume_file.h)
//   .raw            floats, little endian, x fastest: densities (volume_file.h)
//
// Densities times an extinction per unit of density give the extinction. Samples of all formats are the
// corners of the field's voxels; between them the extinction is trilinear.
#pragma once

#include <array>
#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <utility>

#include "renderer/clouds/cloud_field.h"

namespace alpenglow::renderer {

/// The largest number of samples of a file: fields of more take more than 2 GB while they are read.
inline constexpr double kMostCloudSamples = 2e8;

/// Least and greatest values of CloudFileOptions.
struct CloudFileRanges {
  static constexpr std::pair kSpacing_m{1e-3, 1e5};
  static constexpr std::pair kExtinction_per_m{1e-9, 1e6};
  static constexpr std::pair kRadius_um{0.01, 1e4};
};

struct CloudFileOptions {
  /// The field repeats after its samples along x and y; otherwise it ends at the last ones.
  bool is_periodic = false;
  /// Distance between samples [m], in [1e-3, 1e5]. NRRD and raw files need it; for OpenVDB it
  /// replaces that of the file. Text has its own.
  std::optional<glm::dvec3> spacing_m = {};
  glm::dvec3 origin_m{0.0};  // is added to all places of the file; z not of text
  std::optional<std::array<int, 3>> samples = {};  // along x, y, z; of raw files
  double extinction_per_m = 1.0;                   // of the density 1, in [1e-9, 1e6]; not of text
  std::string grid = {};                           // of OpenVDB; empty: as for ReadVdb
  bool is_y_up = false;                            // OpenVDB files have y up and z to the south
  double effective_radius_um = 10.0;               // in [0.01, 1e4]; not of text
};

/// Returns the field of a file. Throws InputError "FILE: ..." that names the value and its range for
/// unknown endings, options that the format needs or does not have, sizes that do not match the file,
/// densities that are negative or not finite, OpenVDB files without a grid of floats, and more than
/// kMostCloudSamples samples.
[[nodiscard]] CloudField ReadCloudField(const std::filesystem::path& file,
                                        const CloudFileOptions& options = {});

}  // namespace alpenglow::renderer
