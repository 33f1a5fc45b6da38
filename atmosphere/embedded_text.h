// SPDX-License-Identifier: MIT
// Files of this folder that travel inside the library: shader texts and published tables.
#pragma once

#include <string_view>

namespace alpenglow::atmosphere {

/// The text of a file of this folder, named from the top of the tree, e.g.
/// "atmosphere/data/cie1931_2deg_cmf_5nm.csv" or "atmosphere/shell.glsl".
/// Throws InternalError for a name that was not embedded (see CMakeLists.txt).
std::string_view EmbeddedText(std::string_view name);

}  // namespace alpenglow::atmosphere
