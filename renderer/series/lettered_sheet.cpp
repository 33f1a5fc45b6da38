// SPDX-License-Identifier: MIT
#include "renderer/series/lettered_sheet.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace alpenglow::renderer {
namespace {

constexpr int kLetterWidth = 3;  // in dots
constexpr std::uint8_t kSheetPaper = 24, kSheetInk = 200;

/// Returns five rows of three pixels, top row first, '#' for ink; empty for unsupported characters.
std::string_view DotsOf(char c) {
  switch (c) {
    case '0':
      return "####.##.##.####";
    case '1':
      return ".#.##..#..#.###";
    case '2':
      return "###..#####..###";
    case '3':
      return "###..####..####";
    case '4':
      return "#.##.####..#..#";
    case '5':
      return "####..###..####";
    case '6':
      return "####..####.####";
    case '7':
      return "###..#.#..#..#.";
    case '8':
      return "####.#####.####";
    case '9':
      return "####.####..####";
    case ':':
      return "....#.....#....";
    case '.':
      return ".............#.";
    case '+':
      return "....#.###.#....";
    case '-':
      return "......###......";
    default:
      return "...............";
  }
}

}  // namespace

LetteredSheet::LetteredSheet(int width, int height)
    : image_{width, height,
             std::vector<std::uint8_t>(
                 3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
                 kSheetPaper)} {}

void LetteredSheet::Paste(const DisplayImage& picture, int left, int top) {
  const std::size_t row_bytes = 3 * static_cast<std::size_t>(picture.width);
  for (int y = 0; y < picture.height; ++y) {
    const auto from =
        picture.rgb.begin() + static_cast<std::ptrdiff_t>(row_bytes * static_cast<std::size_t>(y));
    std::copy_n(from, row_bytes,
                image_.rgb.begin() + static_cast<std::ptrdiff_t>(Index(left, top + y)));
  }
}

void LetteredSheet::Fill(int left, int top, int width, int height) {
  for (int y = std::max(top, 0); y < std::min(top + height, image_.height); ++y) {
    for (int x = std::max(left, 0); x < std::min(left + width, image_.width); ++x) {
      std::fill_n(image_.rgb.begin() + static_cast<std::ptrdiff_t>(Index(x, y)), 3, kSheetInk);
    }
  }
}

void LetteredSheet::Print(std::string_view text, int left, int top) {
  for (const char c : text) {
    const std::string_view dots = DotsOf(c);
    for (int i = 0; i < static_cast<int>(dots.size()); ++i) {
      if (dots[static_cast<std::size_t>(i)] != '#') continue;
      Fill(left + i % kLetterWidth * kDot, top + i / kLetterWidth * kDot, kDot, kDot);
    }
    left += kAdvance;
  }
}

}  // namespace alpenglow::renderer
