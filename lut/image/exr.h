// SPDX-License-Identifier: MIT
// This header provides images as OpenEXR files: linear float RGB with layers and metadata.
#pragma once

#include <cstdint>
#include <filesystem>

#include "lut/image/image.h"

namespace alpenglow::lut {

/// Writes float RGB and the layers, ZIP, atomically, with the metadata as text attributes and
/// whiteLuminance 1 (the unit is cd/m^2). Throws OutputError. If there is a FaultyValue, throws
/// InternalError naming file, pixel and layer before it writes anything.
void WriteExr(const std::filesystem::path& file, const HdrImage& image, const Metadata& metadata,
              Projection projection = Projection::kCamera);
/// Reads an EXR file as ReadExr of the public header does, which calls this function.
[[nodiscard]] HdrImage ReadExrPicture(const std::filesystem::path& file);
/// Reads the text attributes of the header. Throws InputError.
[[nodiscard]] Metadata ReadExrMetadata(const std::filesystem::path& file);

/// Checks the headers of an EXR file before the library reads them: OpenEXR allocates the memory
/// that an attribute claims before it detects that the file is shorter, so two damaged bytes can
/// cost two gigabytes, and it allocates a table of all lines of the data window. Throws InputError
/// naming the file if an attribute extends beyond the end of the file, if a side of a data window
/// is longer than `longest_side`, or if a header is not terminated. Other errors are left to the
/// library.
///
/// Layout of the file, "OpenEXR File Layout" (openexr.com): magic number and version, 4 bytes each;
/// attributes: name and type, each ended by 0, size, 4 bytes, little-endian, value; a 0 ends a
/// header; in files of several parts headers follow each other, and another 0 ends them.
void RequireBoundedExrHeader(const std::filesystem::path& file,
                             std::int64_t longest_side = kLargestImageSide);

}  // namespace alpenglow::lut
