// SPDX-License-Identifier: MIT
// Pixels of a picture or a map of land cover that is draped over terrain, from GeoTIFF and PNG.
//
// Declarations of a file about its bands decide which of them are red, green, blue, grey and alpha:
// their colour interpretation, or else their description ("red", "NIR"). Only if it declares none,
// the first three bands are red, green and blue, and a single one is grey. Declared bands of other
// quantities are passed over if red, green and blue are there.
//
// Integers of 8 and 16 bits, or of as many as the file declares (NBITS), and palettes are encoded
// like sRGB; entries of palettes may be transparent. Floating point numbers, and any numbers with a
// declared scale or offset, are linear reflectances in [0, 1].
#pragma once

#include <gdal_priv.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "renderer/elevation/gdal_file.h"

namespace alpenglow::renderer {

struct DrapePixels {
  /// Linear sRGB or shares of land cover, times the weight of a pixel (its valid fraction), and the
  /// weight; row by row.
  std::vector<std::array<std::uint16_t, 4>> pixels;
  std::string note;  // on values that were cut off; empty: none
};

/// Opens the picture; throws InputError naming the file for other formats, for maps of land cover
/// that are not one band of 8 bits, and for more than 2^26 pixels.
[[nodiscard]] RasterFile OpenDrape(const std::filesystem::path& file, bool is_land_cover);

/// Reads the colours; throws InputError for damaged files, for declared bands that have no red,
/// green and blue, and for types of numbers that are no colours.
[[nodiscard]] DrapePixels ReadColours(const std::filesystem::path& file, GDALDataset& dataset);

/// Reads classes as shares of land cover (CoverOfClass).
[[nodiscard]] DrapePixels ReadLandCover(const std::filesystem::path& file, GDALDataset& dataset);

}  // namespace alpenglow::renderer
