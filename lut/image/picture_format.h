// SPDX-License-Identifier: MIT
// This header provides the table of the formats of picture files: one row for each format, which
// the programs choose by the extension of the file.
//
// A format stores light, which is linear [cd/m^2], or colours, which are developed for a display.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "lut/image/image.h"

namespace alpenglow::lut {

/// One of the two writers is null: that of what the format does not store. Writers replace the file
/// atomically and throw OutputError.
struct PictureFormat {
  const char* extension;  // ".exr"
  const char* name;       // "EXR"
  void (*write_light)(const std::filesystem::path& file, const HdrImage& image,
                      const Metadata& metadata, Projection projection);
  void (*write_colours)(const std::filesystem::path& file, const DisplayImage& image,
                        const Metadata& metadata);
  /// Reads the metadata that the writer was given. Throws InputError.
  Metadata (*read_metadata)(const std::filesystem::path& file);

  [[nodiscard]] bool StoresLight() const { return write_light != nullptr; }
};

/// Returns all rows. The first one is the format of pictures for which none was chosen.
[[nodiscard]] std::span<const PictureFormat> PictureFormats();

/// Returns the format of a file's extension, in lower or upper case. Throws OptionError that lists
/// the extensions for another name.
[[nodiscard]] const PictureFormat& FormatOfPicture(const std::filesystem::path& file);

/// Return names in messages: those of all formats, "PNG or EXR", and of those that store colours.
[[nodiscard]] std::string NamesOfPictureFormats();
[[nodiscard]] std::string NamesOfDevelopedFormats();

}  // namespace alpenglow::lut
