// SPDX-License-Identifier: MIT
// Names of the files that a flight writes: pictures and records.
#pragma once

#include <filesystem>
#include <vector>

namespace alpenglow::viewer {

/// Returns the first of skyview-0001, skyview-0002, ... in the folder for which no picture of any
/// format exists, so that the files of one frame share one number.
/// @param promised  files that do not exist yet and will be written.
[[nodiscard]] std::filesystem::path NextScreenshot(
    const std::filesystem::path& folder, const std::vector<std::filesystem::path>& promised = {});

/// Returns the first of flight-0001.csv, flight-0002.csv, ... that neither exists nor is being
/// recorded.
[[nodiscard]] std::filesystem::path NextFlight(const std::filesystem::path& folder);

}  // namespace alpenglow::viewer
