// SPDX-License-Identifier: MIT
// Text as JSON (RFC 8259) has it.
#pragma once

#include <string>
#include <string_view>

namespace alpenglow::lut {

/// In quotes; quotes, backslashes and control characters are escaped.
[[nodiscard]] std::string JsonString(std::string_view text);

}  // namespace alpenglow::lut
