// SPDX-License-Identifier: MIT
#include "viewer/hud/hud_font.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "atmosphere/text/error.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {
namespace {

constexpr double kLetterHeight = 14.0;  // units
constexpr double kBuiltInHeight_px = 13.0;

void AddBuiltIn(ImFontAtlas& atlas, double scale) {
  ImFontConfig config;
  config.SizePixels = static_cast<float>(kBuiltInHeight_px * std::max(std::round(scale), 1.0));
  config.PixelSnapH = true;
  atlas.AddFontDefault(&config);
}

void AddFile(ImFontAtlas& atlas, double scale, const std::filesystem::path& file) {
  static constexpr std::array<ImWchar, 7> kLetters{0x20, 0x17F, 0x370, 0x3FF, 0x400, 0x45F, 0};
  const auto height = static_cast<float>(std::round(kLetterHeight * scale));
  // Dear ImGui would end the program for a file that is not there.
  if (!std::filesystem::is_regular_file(file) ||
      atlas.AddFontFromFileTTF(file.c_str(), height, nullptr, kLetters.data()) == nullptr) {
    throw InputError(fmt::format("\"{}\" is no TrueType font", file.string()));
  }
}

}  // namespace

std::optional<std::filesystem::path> InstalledFont() {
  for (const char* folder : {"truetype/dejavu", "dejavu-sans-fonts", "TTF", "dejavu"}) {
    const std::filesystem::path file =
        std::filesystem::path("/usr/share/fonts") / folder / "DejaVuSans.ttf";
    if (std::filesystem::is_regular_file(file)) return file;
  }
  return std::nullopt;
}

void LoadFont(ImFontAtlas& atlas, double scale, const std::optional<std::filesystem::path>& font) {
  atlas.Clear();
  if (font) {
    AddFile(atlas, scale, *font);
  } else {
    AddBuiltIn(atlas, scale);
  }
  atlas.Build();
}

}  // namespace alpenglow::viewer
