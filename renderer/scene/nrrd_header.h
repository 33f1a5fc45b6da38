// SPDX-License-Identifier: MIT
// Headers of NRRD files (http://teem.sourceforge.net/nrrd/format.html): lines "field: value" after
// a line "NRRD000x", up to an empty line, which the data follow, or naming a file of their own.
//
// Fields that describe data or say how to show them (content, number, units, labels, spacings,
// thicknesses, space origin, ...) are passed over: a volume's place and size stand in its scene.
// Every other field is understood or refused by its name.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>

namespace alpenglow::renderer {

struct NrrdHeader {
  enum class Type { kFloat, kByte };
  enum class Encoding { kRaw, kGzip };

  std::array<int, 3> size{};  // along the axes of the file, fastest first
  Type type = Type::kFloat;
  Encoding encoding = Encoding::kRaw;
  bool is_big_endian = false;
  /// Along which axis of space (0 right, 1 ahead, 2 up) each axis of the file runs, and whether
  /// against it.
  std::array<std::size_t, 3> space_axis{0, 1, 2};
  std::array<bool, 3> is_reversed{};

  std::filesystem::path data_file;
  std::size_t data_begin = 0;  // bytes of that file before the data and what is skipped
  int line_skip = 0;           // lines before the data, or before they are unpacked
  int byte_skip = 0;           // then bytes of the data; -1: all but the last ones
};

/// Throws InputError "file: ..." or "file:line: ..." for what is no such header, for fields that
/// are not known or stand twice, and for values that are not read: types other than float and
/// uint8, three dimensions only, encodings other than raw and gzip, data in more than one file,
/// axes that are not along those of space, samples at the corners of cells, values that are not
/// one number a sample.
[[nodiscard]] NrrdHeader ReadNrrdHeader(const std::filesystem::path& file);

}  // namespace alpenglow::renderer
