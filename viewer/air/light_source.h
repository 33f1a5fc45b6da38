// SPDX-License-Identifier: MIT
// What lights a sky.
#pragma once

#include <cstddef>

namespace alpenglow::viewer {

enum class LightSource : std::size_t { kSun, kMoon };
inline constexpr std::size_t kLightSources = 2;

[[nodiscard]] constexpr std::size_t IndexOf(LightSource source) {
  return static_cast<std::size_t>(source);
}
[[nodiscard]] constexpr LightSource OtherThan(LightSource source) {
  return source == LightSource::kSun ? LightSource::kMoon : LightSource::kSun;
}

}  // namespace alpenglow::viewer
