// SPDX-License-Identifier: MIT
#include "viewer/picture_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>

#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"
#include "lut/cli/growing_file.h"
#include "lut/cli/output_file.h"

namespace alpenglow::viewer {
namespace {

namespace fs = std::filesystem;

/// Returns the first numbered name for which no file with any of the extensions exists.
fs::path NextFree(const fs::path& folder, const char* stem,
                  std::initializer_list<const char*> extensions,
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

void RequirePictureName(const std::filesystem::path& file) {
  if (HasExtension(file, ".png") || HasExtension(file, ".exr")) return;
  throw OptionError(
      fmt::format("\"{}\" is no picture's name; it must end in .png or .exr", file.string()));
}

fs::path NextScreenshot(const fs::path& folder, const std::vector<fs::path>& promised) {
  return NextFree(folder, "skyview", {".png", ".exr"}, promised);
}

fs::path NextFlight(const fs::path& folder) {
  fs::path file = NextFree(folder, "flight", {".csv"});
  file += ".csv";
  return file;
}

}  // namespace alpenglow::viewer
