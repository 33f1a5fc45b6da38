// SPDX-License-Identifier: MIT
#include "renderer/series/contact_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "atmosphere/base/error.h"

namespace alpenglow::renderer {
namespace {

constexpr int kGap = 8;
constexpr int kGlyphWidth = 3;
constexpr int kGlyphHeight = 5;
constexpr int kGlyphScale = 3;
constexpr int kLabelHeight = kGlyphHeight * kGlyphScale + 6;
constexpr std::uint8_t kPaper = 24;
constexpr std::uint8_t kInk = 200;

/// Returns five rows of three pixels, top row first, '#' for ink; empty for unsupported characters.
std::string_view Glyph(char c) {
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

class Sheet {
 public:
  Sheet(int width, int height)
      : image_{
            width, height,
            std::vector<std::uint8_t>(
                3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), kPaper)} {}

  void Paste(const DisplayImage& picture, int left, int top) {
    const std::size_t row_bytes = 3 * static_cast<std::size_t>(picture.width);
    for (int y = 0; y < picture.height; ++y) {
      const auto from = picture.rgb.begin() +
                        static_cast<std::ptrdiff_t>(row_bytes * static_cast<std::size_t>(y));
      std::copy_n(from, row_bytes,
                  image_.rgb.begin() + static_cast<std::ptrdiff_t>(Index(left, top + y)));
    }
  }

  void Print(std::string_view text, int left, int top) {
    for (const char c : text) {
      Draw(Glyph(c), left, top);
      left += (kGlyphWidth + 1) * kGlyphScale;
    }
  }

  [[nodiscard]] const DisplayImage& image() const { return image_; }

 private:
  [[nodiscard]] std::size_t Index(int x, int y) const {
    return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) +
                static_cast<std::size_t>(x));
  }
  void Draw(std::string_view glyph, int left, int top) {
    for (int y = 0; y < kGlyphHeight * kGlyphScale; ++y) {
      for (int x = 0; x < kGlyphWidth * kGlyphScale; ++x) {
        const int cell = y / kGlyphScale * kGlyphWidth + x / kGlyphScale;
        const bool inside = left + x < image_.width && top + y < image_.height;
        if (!inside || glyph[static_cast<std::size_t>(cell)] != '#') continue;
        std::fill_n(image_.rgb.begin() + static_cast<std::ptrdiff_t>(Index(left + x, top + y)), 3,
                    kInk);
      }
    }
  }

  DisplayImage image_;
};

/// Returns the mean of the pixels [x0, x1) x [y0, y1).
std::array<float, 3> Mean(const HdrImage& image, int x0, int x1, int y0, int y1) {
  std::array<double, 3> sum = {};
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      for (std::size_t c = 0; c < 3; ++c) sum[c] += static_cast<double>(image.at(x, y)[c]);
    }
  }
  const double pixels = static_cast<double>(x1 - x0) * (y1 - y0);
  return {static_cast<float>(sum[0] / pixels), static_cast<float>(sum[1] / pixels),
          static_cast<float>(sum[2] / pixels)};
}

}  // namespace

HdrImage Reduced(const HdrImage& image, int width) {
  const int columns = std::min(width, image.width);
  const int rows = std::max(
      1, static_cast<int>(std::lround(static_cast<double>(image.height) * columns / image.width)));
  HdrImage reduced(columns, rows);
  for (int y = 0; y < rows; ++y) {
    const auto y0 = static_cast<int>(static_cast<std::int64_t>(y) * image.height / rows);
    const auto y1 = static_cast<int>(static_cast<std::int64_t>(y + 1) * image.height / rows);
    for (int x = 0; x < columns; ++x) {
      const auto x0 = static_cast<int>(static_cast<std::int64_t>(x) * image.width / columns);
      const auto x1 = static_cast<int>(static_cast<std::int64_t>(x + 1) * image.width / columns);
      reduced.at(x, y) = Mean(image, x0, x1, y0, y1);
    }
  }
  return reduced;
}

DisplayImage ContactSheet(const std::vector<Thumbnail>& thumbnails) {
  ALPENGLOW_ENSURE(thumbnails.size(), >, 0U);
  const auto count = static_cast<int>(thumbnails.size());
  const auto columns = static_cast<int>(std::ceil(std::sqrt(count)));
  const int rows = (count + columns - 1) / columns;
  const int cell_width = thumbnails[0].image.width + kGap;
  const int cell_height = thumbnails[0].image.height + kLabelHeight + kGap;
  Sheet sheet(columns * cell_width + kGap, rows * cell_height + kGap);
  for (int i = 0; i < count; ++i) {
    const Thumbnail& thumbnail = thumbnails[static_cast<std::size_t>(i)];
    ALPENGLOW_ENSURE(thumbnail.image.width, ==, thumbnails[0].image.width);
    ALPENGLOW_ENSURE(thumbnail.image.height, ==, thumbnails[0].image.height);
    const int left = kGap + i % columns * cell_width;
    const int top = kGap + i / columns * cell_height;
    sheet.Paste(thumbnail.image, left, top);
    sheet.Print(thumbnail.label, left, top + thumbnail.image.height + 3);
  }
  return sheet.image();
}

}  // namespace alpenglow::renderer
