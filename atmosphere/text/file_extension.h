// SPDX-License-Identifier: MIT
// The extension of a file's name, which says what is in the file.
#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <string_view>

namespace alpenglow::atmosphere {

/// True if a name ends in an extension such as ".gpx", in whatever case: cameras and recorders
/// write ".GPX" and ".TIF" too.
[[nodiscard]] inline bool HasExtension(const std::filesystem::path& file,
                                       std::string_view extension) {
  const auto lower = [](unsigned char letter) { return std::tolower(letter); };
  const std::string own = file.extension().string();
  return std::equal(
      own.begin(), own.end(), extension.begin(), extension.end(), [&](char one, char other) {
        return lower(static_cast<unsigned char>(one)) == lower(static_cast<unsigned char>(other));
      });
}

}  // namespace alpenglow::atmosphere
