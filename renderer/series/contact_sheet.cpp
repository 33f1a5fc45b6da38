// SPDX-License-Identifier: MIT
#include "renderer/series/contact_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "atmosphere/base/error.h"
#include "renderer/series/lettered_sheet.h"

namespace alpenglow::renderer {
namespace {

constexpr int kGap = 8;
constexpr int kLabelHeight = LetteredSheet::kTextHeight + 6;

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
  int cell_width = thumbnails[0].image.width;
  for (const Thumbnail& thumbnail : thumbnails)
    cell_width = std::max(cell_width, LetteredSheet::TextWidth(thumbnail.label));
  cell_width += kGap;
  const int cell_height = thumbnails[0].image.height + kLabelHeight + kGap;
  LetteredSheet sheet(columns * cell_width + kGap, rows * cell_height + kGap);
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
