// SPDX-License-Identifier: MIT
// Reads densities on a grid from files: NRRD and raw.
//
// ReadNrrdHeader reads the header of an NRRD file (http://teem.sourceforge.net/nrrd/format.html):
// lines "field: value" after a line "NRRD000x", up to an empty line. The data follow, or are in a
// separate file that the header names.
//
// Fields that describe data or their display (content, number, units, labels, spacings,
// thicknesses, space origin, ...) are ignored: the scene gives the place and size of a volume. All
// other fields are interpreted or rejected by name.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>

#include "renderer/scene/volume_grid.h"

namespace alpenglow::renderer {

/// Text about volumes for messages about files of other formats (RefuseFormat).
inline constexpr char kVolumesWanted[] = "grids of volumes are read as NRRD or raw floats";

struct NrrdHeader {
  enum class Type { kFloat, kByte };
  enum class Encoding { kRaw, kGzip };

  std::array<int, 3> size{};  // along the axes of the file, fastest first
  Type type = Type::kFloat;
  Encoding encoding = Encoding::kRaw;
  bool is_big_endian = false;
  /// Axis of space (0 right, 1 ahead, 2 up) along which each axis of the file runs, and whether it
  /// runs in the opposite direction.
  std::array<std::size_t, 3> space_axis{0, 1, 2};
  std::array<bool, 3> is_reversed{};

  std::filesystem::path data_file;
  std::size_t data_begin = 0;  // bytes before the data and before the skipped lines and bytes
  int line_skip = 0;           // lines to skip before the data, or before decompression
  int byte_skip = 0;           // bytes to skip after that; -1: skip all but the last ones
};

/// Throws InputError "file: ..." or "file:line: ..." for text that is not such a header, for
/// unknown or repeated fields, and for unsupported values: types other than float and uint8,
/// numbers of dimensions other than three, encodings other than raw and gzip, data in more than one
/// file, axes that are not along those of space, samples at the corners of cells, more than one
/// number per sample.
[[nodiscard]] NrrdHeader ReadNrrdHeader(const std::filesystem::path& file);

/// Reads an NRRD file: three axes, type float or uint8 (255 is 1), encoding raw or gzip,
/// data in the file or in another one that it names. Its space directions reorder the samples so
/// that they run to the right, ahead and up. Throws InputError "file: ..." or "file:line: ..." for
/// damaged data, and errors of ReadNrrdHeader.
[[nodiscard]] VolumeGrid ReadNrrd(const std::filesystem::path& file,
                                  GridValues allowed = GridValues::kDensities);

/// Reads a file that consists only of nx * ny * nz floats, little endian, x fastest. Throws
/// InputError "file: ..." when it has another length, which names the format that the bytes show.
[[nodiscard]] VolumeGrid ReadRawGrid(const std::filesystem::path& file,
                                     const std::array<int, 3>& size,
                                     GridValues allowed = GridValues::kDensities);

}  // namespace alpenglow::renderer
