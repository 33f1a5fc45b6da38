// SPDX-License-Identifier: MIT
// Headers of OpenEXR files, looked over before the library reads them: it takes the memory that an
// attribute claims before it finds out that the file has no such text (two bytes of damage, two
// gigabytes).
#pragma once

#include <filesystem>

namespace alpenglow::lut {

/// Throws InputError naming the file when an attribute of its headers claims to reach beyond its
/// end, or when a header has none. Says nothing about anything else: the library does.
///
/// Layout of the file, "OpenEXR File Layout" (openexr.com): magic number and version, 4 bytes each;
/// attributes: name and type, each ended by 0, size, 4 bytes, little-endian, value; a 0 ends a
/// header; in files of several parts headers follow each other, and another 0 ends them.
void RequireBoundedExrHeader(const std::filesystem::path& file);

}  // namespace alpenglow::lut
