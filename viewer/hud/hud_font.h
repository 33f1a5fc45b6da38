// SPDX-License-Identifier: MIT
// The letters of instruments and panels, made at the size at which they are read.
#pragma once

#include <imgui.h>

#include <filesystem>
#include <optional>

namespace alpenglow::viewer {

/// DejaVu Sans where a package has put it (Debian: fonts-dejavu-core).
[[nodiscard]] std::optional<std::filesystem::path> InstalledFont();

/// Empties the atlas and puts letters of Latin, Greek and Cyrillic into it: those of `font`, or
/// without one those that Dear ImGui brings (Latin only, in whole multiples of 13 pixels). Throws
/// InputError when the file is no TrueType font.
/// @param scale  pixels a unit; letters are 14 units high.
void LoadFont(ImFontAtlas& atlas, double scale, const std::optional<std::filesystem::path>& font);

}  // namespace alpenglow::viewer
