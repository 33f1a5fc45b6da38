// SPDX-License-Identifier: MIT
// Names of file formats, from the first bytes of a file. Readers use them in messages about files
// of other formats: "hill.stl: this is STL, a mesh; meshes are read as Wavefront OBJ".
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace alpenglow::atmosphere {

struct FileFormat {
  std::string name;    // "STL, a mesh"
  std::string advice;  // what makes the file readable: "unzip it"; empty: nothing is known
  bool is_text;
};

/// Returns the format that the bytes show; nullopt if they show none, like those of CSV, TOML, OBJ
/// and raw samples.
/// @param first_bytes  the beginning of the file; kFormatBytes are enough.
/// @param file_bytes   size of the file, which STL files state in their header.
[[nodiscard]] std::optional<FileFormat> FormatOf(std::string_view first_bytes,
                                                 std::uint64_t file_bytes);

inline constexpr std::size_t kFormatBytes = 4096;

/// Returns the format of a regular file; nullopt also if the file cannot be read.
[[nodiscard]] std::optional<FileFormat> FormatOfFile(const std::filesystem::path& file);

/// Throws the InputError "FILE: this is FORMAT; WANTED".
/// @param wanted  a clause such as "meshes are read as Wavefront OBJ".
[[noreturn]] void RefuseFormat(const std::filesystem::path& file, const FileFormat& format,
                               std::string_view wanted);

/// Does what RefuseFormat does if the bytes of the file show a format.
void RefuseKnownFormats(const std::filesystem::path& file, std::string_view wanted);

}  // namespace alpenglow::atmosphere
