// SPDX-License-Identifier: MIT
// Names of screenshots that a key asks for.
#pragma once

#include <filesystem>

namespace alpenglow {

/// The next free of skyview-0001, skyview-0002, ... in the folder: with neither a .png nor an .exr,
/// so that both of one frame have one number.
[[nodiscard]] std::filesystem::path NextScreenshot(const std::filesystem::path& folder);

}  // namespace alpenglow
