// SPDX-License-Identifier: MIT
// Names of files that a key asks for.
#pragma once

#include <filesystem>
#include <vector>

namespace alpenglow::viewer {

/// The next free of skyview-0001, skyview-0002, ... in the folder: with neither a .png nor an .exr,
/// so that both of one frame have one number.
/// @param promised  files that are not there yet and will be.
[[nodiscard]] std::filesystem::path NextScreenshot(
    const std::filesystem::path& folder, const std::vector<std::filesystem::path>& promised = {});

/// The next free of flight-0001.csv, flight-0002.csv, ...: neither there nor being recorded into.
[[nodiscard]] std::filesystem::path NextFlight(const std::filesystem::path& folder);

}  // namespace alpenglow::viewer
