// SPDX-License-Identifier: MIT
// What lies in a folder of tables for other programs (exchange_tables.h): whoever made them.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/air/medium.h"
#include "lut/store/exchange_tables.h"

namespace alpenglow::lut {

/// The folder of a set that this is, or is a texture of; nothing when it is neither. A set is known
/// by its scattering.exr, .bin or .dat, none of which is a native table.
[[nodiscard]] std::optional<std::filesystem::path> ExchangeFolderOf(
    const std::filesystem::path& file_or_folder);

/// Distances of texels from those that we compute at the same places, relative, of texels that hold
/// more than a thousandth of the largest.
struct TexelErrors {
  std::size_t texels = 0;
  double median = 0.0, ninth_decile = 0.0, largest = 0.0;
};

struct ExchangeDescription {
  struct Channel {
    float lowest, highest;
  };
  struct Texture {
    std::filesystem::path file;
    TextureShape shape{};
    std::array<Channel, 4> rgba{};
    TexelErrors errors;  // of red, green and blue
  };
  ExchangeOptions options;  // type: of the first file
  Medium medium;
  bool medium_is_assumed = false;  // bruneton2017, for there is no atmosphere.toml
  std::vector<Texture> textures;
  std::vector<std::filesystem::path> absent;  // of those that three-atmosphere can do without
};

/// Reads every texture of the folder's layout and checks it: size, every texel finite, not negative
/// and no more than there is light for, and texels against our own (alpha where it is light), for a
/// sun down to 102 or to 120 degrees, whichever they hold. Medians of up to 5 % pass: those of
/// Bruneton's own files are up to 3 %. Throws InputError naming the file for a texture that is
/// missing or fails.
[[nodiscard]] ExchangeDescription DescribeExchangeTables(const std::filesystem::path& folder);

/// The same for people: a line a fact.
[[nodiscard]] std::string DescriptionText(const std::filesystem::path& folder,
                                          const ExchangeDescription& description);

}  // namespace alpenglow::lut
