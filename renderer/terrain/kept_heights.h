// SPDX-License-Identifier: MIT
// Heights that take a second to make and are always the same, kept between runs.
//
// One file a name, NAME-FINGERPRINT.f32 (floats as the machine has them), in the folder that
// ALPENGLOW_CACHE names, else in $XDG_CACHE_HOME/alpenglow, else in ~/.cache/alpenglow; an empty
// ALPENGLOW_CACHE keeps nothing. The fingerprint of what is wanted is known to the program, so that
// nothing old, foreign or damaged is ever taken for it. Files are written whole or not at all, so
// any number of processes may share the folder; older ones of the same name are removed, which
// bounds its size.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace alpenglow::renderer {

/// FNV-1a, 64 bits, of the heights' bytes, little-endian.
[[nodiscard]] std::uint64_t FingerprintOf(const std::vector<float>& height_m);

/// Where heights are kept; nothing where they are not.
[[nodiscard]] std::optional<std::filesystem::path> CacheFolder();

/// What heights are wanted.
struct WantedHeights {
  std::string name;
  std::uint64_t fingerprint;
  std::size_t count;
};

/// The kept heights, or those that `make` makes; these are kept if they are what is wanted. A
/// folder that cannot be read or written costs time, nothing else.
[[nodiscard]] std::vector<float> KeptHeights(const WantedHeights& wanted,
                                             const std::function<std::vector<float>()>& make);

}  // namespace alpenglow::renderer
