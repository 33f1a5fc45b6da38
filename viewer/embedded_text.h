// SPDX-License-Identifier: MIT
// Files of this folder that travel inside the library: shader texts and data.
#pragma once

#include <string_view>

namespace alpenglow::viewer {

/// Throws InternalError for a name that was not embedded (see CMakeLists.txt).
std::string_view EmbeddedText(std::string_view name);

}  // namespace alpenglow::viewer
