// SPDX-License-Identifier: MIT
// Sides of textures that change while one flies.
#pragma once

#include <bit>

namespace alpenglow::viewer {

/// `side`, or one more where it is a power of two (but 1). Mesa's software driver compiles a program
/// again when a side of a texture that it reads becomes a power of two, or ceases to be one: frames
/// of 0.3 to 0.9 s, measured with its cache of programs off.
/// @param side  > 0.
[[nodiscard]] constexpr int OffPowersOfTwo(int side) {
  return side > 1 && std::has_single_bit(static_cast<unsigned>(side)) ? side + 1 : side;
}

}  // namespace alpenglow::viewer
