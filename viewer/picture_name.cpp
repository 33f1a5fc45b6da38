// SPDX-License-Identifier: MIT
#include "viewer/picture_name.h"

#include <fmt/format.h>

#include <algorithm>

#include "lut/cli/growing_file.h"
#include "lut/image/picture_format.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {
namespace {

namespace fs = std::filesystem;

/// Returns the first numbered name for which no file with any of the extensions exists.
fs::path NextFree(const fs::path& folder, const char* stem,
                  const std::vector<const char*>& extensions,
                  const std::vector<fs::path>& promised = {}) {
  for (int number = 1;; ++number) {
    const fs::path free = folder / fmt::format("{}-{:04d}", stem, number);
    const auto is_taken = [&](const char* extension) {
      const fs::path file = free.string() + extension;
      const bool is_promised = std::find(promised.begin(), promised.end(), file) != promised.end();
      return is_promised || fs::exists(file) || fs::exists(GrowingFile::PartOf(file));
    };
    if (std::none_of(extensions.begin(), extensions.end(), is_taken)) return free;
  }
}

}  // namespace

fs::path NextScreenshot(const fs::path& folder, const std::vector<fs::path>& promised) {
  std::vector<const char*> extensions;
  for (const PictureFormat& format : PictureFormats()) extensions.push_back(format.extension);
  return NextFree(folder, "skyview", extensions, promised);
}

fs::path NextFlight(const fs::path& folder) {
  fs::path file = NextFree(folder, "flight", {".csv"});
  file += ".csv";
  return file;
}

}  // namespace alpenglow::viewer
