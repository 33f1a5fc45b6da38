// SPDX-License-Identifier: MIT
// This header provides the description and the check of a folder of tables for other programs
// (exchange_tables.h), whichever program made them.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/math/error_statistics.h"
#include "atmosphere/medium/medium.h"
#include "lut/table_io/exchange_tables.h"

namespace alpenglow::lut {

/// Returns the folder of a set, given this folder or one of its textures; nullopt if the path is
/// neither. A set is recognised by its scattering.exr, .bin or .dat, none of which is a native
/// table.
[[nodiscard]] std::optional<std::filesystem::path> ExchangeFolderOf(
    const std::filesystem::path& file_or_folder);

struct ExchangeDescription {
  struct Channel {
    float lowest, highest;
  };
  struct Texture {
    std::filesystem::path file;
    TextureShape shape{};
    std::array<Channel, 4> rgba{};
    /// Relative differences between red, green and blue and the values that this program computes,
    /// over texels with more than a thousandth of the largest value.
    ErrorStatistics errors;
  };
  ExportOptions options;  // type: from the first file
  Medium medium;
  bool medium_is_assumed = false;  // bruneton2017, because there is no atmosphere.toml
  std::vector<Texture> textures;
  std::vector<std::filesystem::path> absent;  // missing ones that three-atmosphere does not need
};

/// Reads every texture of the folder's layout and checks it: size; every texel finite, not negative
/// and at most the largest possible light; and texels against the values of this program (alpha
/// where it holds light), for a sun down to 102 or to 120 degrees, whichever the files use. Medians
/// of up to 5 % pass: those of Bruneton's own files are up to 3 %. Throws InputError naming the
/// file for a texture that is missing or fails.
[[nodiscard]] ExchangeDescription DescribeExchangeTables(const std::filesystem::path& folder);

/// Returns the description for people: one fact per line.
[[nodiscard]] std::string DescriptionText(const std::filesystem::path& folder,
                                          const ExchangeDescription& description);

}  // namespace alpenglow::lut
