// SPDX-License-Identifier: MIT
// This header provides developed images as PNG files: 8-bit sRGB with metadata.
#pragma once

#include <filesystem>
#include <string>

#include "lut/image/image.h"

namespace alpenglow::lut {

/// Returns the bytes of the file that WritePng() writes.
[[nodiscard]] std::string PngBytes(const DisplayImage& image, const Metadata& metadata);
/// Writes 8-bit RGB with an sRGB chunk and the metadata as text chunks, atomically. Throws
/// OutputError.
void WritePng(const std::filesystem::path& file, const DisplayImage& image,
              const Metadata& metadata);
/// Reads a PNG. Throws InputError for a file that is missing, truncated or not a PNG.
[[nodiscard]] DisplayImage ReadPng(const std::filesystem::path& file);
/// Reads the text chunks before the pixels. Throws InputError.
[[nodiscard]] Metadata ReadPngMetadata(const std::filesystem::path& file);

}  // namespace alpenglow::lut
