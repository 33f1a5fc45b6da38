// SPDX-License-Identifier: MIT
#include "viewer/capture/screenshot_name.h"

#include <fmt/format.h>

#include <string>

namespace alpenglow {

std::filesystem::path NextScreenshot(const std::filesystem::path& folder) {
  for (int number = 1;; ++number) {
    const std::string stem = (folder / fmt::format("skyview-{:04d}", number)).string();
    if (!std::filesystem::exists(stem + ".png") && !std::filesystem::exists(stem + ".exr")) {
      return stem;
    }
  }
}

}  // namespace alpenglow
