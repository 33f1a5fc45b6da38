// SPDX-License-Identifier: MIT
#include "renderer/series/keogram.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "atmosphere/base/error.h"
#include "renderer/series/lettered_sheet.h"
#include "renderer/series/time_axis.h"

namespace alpenglow::renderer {
namespace {

constexpr int kTickWidth = 2, kTickHeight = 6, kTextGap = 4;
// Labels have five letters; they and the space between them.
constexpr int kLabelPitch = 80;

}  // namespace

Keogram::Keogram(int frames, std::optional<std::string> zone)
    : columns_(std::clamp((kUsualWidth + frames - 1) / std::max(frames, 1), kFewestColumns,
                          kMostColumns)),
      zone_(std::move(zone)) {}

void Keogram::Add(const UtcTime& instant, const DisplayImage& picture) {
  if (rgb_.empty()) height_ = picture.height;
  ALPENGLOW_ENSURE(picture.height, ==, height_);
  instants_.push_back(instant);
  for (int y = 0; y < height_; ++y) {
    const auto pixel =
        picture.rgb.begin() + 3 * (std::ptrdiff_t{y} * picture.width + picture.width / 2);
    rgb_.insert(rgb_.end(), pixel, pixel + 3);
  }
}

std::optional<double> Keogram::ColumnOf(const UtcTime& instant) const {
  if (instants_.size() == 1) return 0.5 * columns_;
  for (std::size_t i = 0; i + 1 < instants_.size(); ++i) {
    const double step_s = SecondsBetween(instants_[i], instants_[i + 1]);
    const double after_s = SecondsBetween(instants_[i], instant);
    if (step_s <= 0.0 || after_s < 0.0 || after_s > step_s) continue;
    return (static_cast<double>(i) + 0.5 + after_s / step_s) * columns_;
  }
  return std::nullopt;
}

DisplayImage Keogram::Image() const {
  ALPENGLOW_ENSURE(rgb_.size(), >, 0U);
  const auto frames = static_cast<int>(instants_.size());
  LetteredSheet sheet(frames * columns_, height_ + kScaleHeight);
  DisplayImage column{1, height_, {}};
  for (int x = 0; x < frames * columns_; ++x) {
    const std::ptrdiff_t size = std::ptrdiff_t{3} * height_;
    const auto from = rgb_.begin() + x / columns_ * size;
    column.rgb.assign(from, from + size);
    sheet.Paste(column, x, 0);
  }
  const auto [first, last] = std::minmax_element(
      instants_.begin(), instants_.end(),
      [](const UtcTime& a, const UtcTime& b) { return SecondsBetween(a, b) > 0.0; });
  const int most = std::max(1, frames * columns_ / kLabelPitch);
  for (const TimeTick& tick : TimeAxis(*first, *last, zone_).Ticks(most)) {
    const std::optional<double> at = ColumnOf(tick.instant);
    if (!at) continue;
    const auto x = static_cast<int>(std::lround(*at));
    sheet.Fill(x - kTickWidth / 2, height_, kTickWidth, kTickHeight);
    const int width = LetteredSheet::TextWidth(tick.label);
    const int left = std::clamp(x - width / 2, 0, std::max(0, frames * columns_ - width));
    sheet.Print(tick.label, left, height_ + kTickHeight + kTextGap);
  }
  return sheet.image();
}

}  // namespace alpenglow::renderer
