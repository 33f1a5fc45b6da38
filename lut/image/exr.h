// SPDX-License-Identifier: MIT
// This header provides a check of OpenEXR headers before the library reads them. OpenEXR allocates
// the memory that an attribute claims before it detects that the file is shorter: two damaged bytes
// can cost two gigabytes.
#pragma once

#include <filesystem>

namespace alpenglow::lut {

/// Throws InputError naming the file if an attribute of its headers extends beyond the end of the
/// file, or if a header is not terminated. Other errors are left to the library.
///
/// Layout of the file, "OpenEXR File Layout" (openexr.com): magic number and version, 4 bytes each;
/// attributes: name and type, each ended by 0, size, 4 bytes, little-endian, value; a 0 ends a
/// header; in files of several parts headers follow each other, and another 0 ends them.
void RequireBoundedExrHeader(const std::filesystem::path& file);

}  // namespace alpenglow::lut
