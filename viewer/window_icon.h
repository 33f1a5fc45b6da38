// SPDX-License-Identifier: MIT
// The icon of the window: a peak in the last light.
#pragma once

#include <cstdint>
#include <vector>

namespace alpenglow::viewer {

/// side x side pixels, red, green, blue and alpha of a byte each, row 0 at the top. side >= 1.
[[nodiscard]] std::vector<std::uint8_t> WindowIcon(int side);

}  // namespace alpenglow::viewer
