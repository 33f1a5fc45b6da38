// SPDX-License-Identifier: MIT
#include "lut/image/tone_mapping.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "atmosphere/base/error.h"
#include "atmosphere/base/names.h"
#include "lut/image/metering.h"
#include "lut/layer.h"

namespace alpenglow::lut {
namespace {

constexpr EnumNames kLooks{{std::pair{AgxLook::kPhoto, "photo"},
                            {AgxLook::kNone, "none"},
                            {AgxLook::kPunchy, "punchy"},
                            {AgxLook::kMedium, "medium"},
                            {AgxLook::kHigh, "high"}}};

// log2 luminance of every pixel. Pixels without light get the smallest value of the others, so that
// the base is smooth.
struct Stops {
  int width, height;
  std::vector<float> value;
  float darkest, brightest;

  [[nodiscard]] float at(int x, int y) const {
    return value[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                 static_cast<std::size_t>(x)];
  }
};

std::optional<Stops> StopsOf(const HdrImage& image) {
  Stops stops{image.width, image.height, {}, 0.0F, 0.0F};
  bool any = false;
  for (const std::array<float, 3>& rgb : image.rgb) {
    const float y = shared::Luminance<float>(rgb[0], rgb[1], rgb[2]);
    const bool lit = y > 1e-12F;
    stops.value.push_back(lit ? std::log2(y) : NAN);
    if (!lit) continue;
    stops.darkest = any ? std::min(stops.darkest, stops.value.back()) : stops.value.back();
    stops.brightest = any ? std::max(stops.brightest, stops.value.back()) : stops.value.back();
    any = true;
  }
  if (!any) return std::nullopt;
  for (float& value : stops.value) {
    if (std::isnan(value)) value = stops.darkest;
  }
  return stops;
}

/// Sums of luminance and of counts over cells of position and luminance.
class BilateralGrid {
 public:
  BilateralGrid(const Stops& stops, const LocalExposureOptions& options)
      : darkest_(stops.darkest),
        per_pixel_(1.0F / static_cast<float>(
                              std::max(options.reach * std::max(stops.width, stops.height), 1.0))),
        per_stop_(1.0F / static_cast<float>(options.edge_stops)),
        nx_(Cells(static_cast<float>(stops.width) * per_pixel_)),
        ny_(Cells(static_cast<float>(stops.height) * per_pixel_)),
        nz_(Cells((stops.brightest - stops.darkest) * per_stop_)),
        cells_(static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_) *
               static_cast<std::size_t>(nz_)) {
    for (int y = 0; y < stops.height; ++y) {
      for (int x = 0; x < stops.width; ++x) Splat(x, y, stops.at(x, y));
    }
    Blur(1, nx_);
    Blur(nx_, ny_);
    Blur(nx_ * ny_, nz_);
  }

  /// Returns the smoothed value at a pixel with value `stop`.
  [[nodiscard]] float Slice(int x, int y, float stop) const {
    Cell sum;
    VisitCorners(x, y, stop, [&](std::size_t cell, float weight) {
      sum.value += weight * cells_[cell].value;
      sum.weight += weight * cells_[cell].weight;
    });
    return sum.value / sum.weight;
  }

 private:
  struct Cell {
    float value = 0.0F, weight = 0.0F;
  };

  static constexpr float kMargin = 2.0F;  // additional cells at the borders, for the blur
  static int Cells(float length) { return static_cast<int>(length + 2.0F * kMargin) + 2; }

  template <typename Visit>
  void VisitCorners(int x, int y, float stop, const Visit& visit) const {
    const std::array<float, 3> at = {(static_cast<float>(x) + 0.5F) * per_pixel_ + kMargin,
                                     (static_cast<float>(y) + 0.5F) * per_pixel_ + kMargin,
                                     (stop - darkest_) * per_stop_ + kMargin};
    std::array<int, 3> low;
    std::array<float, 3> share;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = static_cast<int>(at[axis]);
      share[axis] = at[axis] - static_cast<float>(low[axis]);
    }
    for (int corner = 0; corner < 8; ++corner) {
      const int dx = corner & 1, dy = (corner >> 1) & 1, dz = corner >> 2;
      const float weight = (dx != 0 ? share[0] : 1.0F - share[0]) *
                           (dy != 0 ? share[1] : 1.0F - share[1]) *
                           (dz != 0 ? share[2] : 1.0F - share[2]);
      visit(static_cast<std::size_t>(((low[2] + dz) * ny_ + low[1] + dy) * nx_ + low[0] + dx),
            weight);
    }
  }

  void Splat(int x, int y, float stop) {
    VisitCorners(x, y, stop, [&](std::size_t cell, float weight) {
      cells_[cell].value += weight * stop;
      cells_[cell].weight += weight;
    });
  }

  // Blurs by (1, 4, 6, 4, 1) / 16 along one axis: a Gaussian of one cell.
  void Blur(int stride, int length) {
    const auto step = static_cast<std::size_t>(stride);
    const std::vector<Cell> before = cells_;
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      const int along = static_cast<int>(i / step) % length;
      Cell sum;
      for (int k = -2; k <= 2; ++k) {
        if (along + k < 0 || along + k >= length) continue;
        constexpr std::array<float, 3> kTap = {0.375F, 0.25F, 0.0625F};
        const float tap = kTap[static_cast<std::size_t>(std::abs(k))];
        const Cell& cell =
            before[i + static_cast<std::size_t>(k + 2) * step - std::size_t{2} * step];
        sum.value += tap * cell.value;
        sum.weight += tap * cell.weight;
      }
      cells_[i] = sum;
    }
  }

  float darkest_, per_pixel_, per_stop_;
  int nx_, ny_, nz_;
  std::vector<Cell> cells_;
};

std::vector<float> BaseOf(const Stops& stops, const LocalExposureOptions& options) {
  const BilateralGrid grid(stops, options);
  std::vector<float> base(stops.value.size());
  tbb::parallel_for(0, stops.height, [&](int y) {
    for (int x = 0; x < stops.width; ++x) {
      base[static_cast<std::size_t>(y) * static_cast<std::size_t>(stops.width) +
           static_cast<std::size_t>(x)] = grid.Slice(x, y, stops.at(x, y));
    }
  });
  return base;
}

/// Returns the range between the first and the last percentile.
float RangeOf(std::vector<float> values) {
  const auto at = [&](double share) {
    const auto place = values.begin() +
                       static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), place, values.end());
    return *place;
  };
  const float low = at(0.01);
  return at(0.99) - low;
}

}  // namespace

AgxGrade GradeOf(AgxLook look) {
  switch (look) {
    case AgxLook::kPhoto:
      return {0.6, 1.8, true, 0.38, 1.0, 1.0, 0.35, true};
    case AgxLook::kNone:
      return {};
    case AgxLook::kPunchy:
      return {0.0, 1.0, false, 0.0, 1.3, 1.2, 0.0, false};
    case AgxLook::kMedium:
      return {0.0, 1.2, false, 0.0, 1.0, 1.0, 0.0, false};
    case AgxLook::kHigh:
      return {0.0, 1.4, false, 0.0, 1.0, 0.95, 0.0, false};
  }
  throw InternalError("unknown look");
}

AgxLook AgxLookFromName(const std::string& name) {
  return kLooks.Named(name, "look is \"{}\"; it must be one of {}");
}

std::string NameOf(AgxLook look) { return kLooks.Of(look); }

std::vector<std::string> AgxLookNames() { return kLooks.All(); }

HdrImage WithHighlightsRolledOff(HdrImage image, double ev100) {
  const auto grey = static_cast<float>(kMeterConstant / 100.0 * std::exp2(ev100));
  tbb::parallel_for(std::size_t{0}, image.rgb.size(), [&](std::size_t i) {
    std::array<float, 3>& rgb = image.rgb[i];
    const float y = shared::Luminance(rgb[0], rgb[1], rgb[2]);
    if (!(y > grey)) return;
    const float stops = std::log2(y / grey);
    const float gain = std::exp2(std::log1p(stops) - stops);
    for (float& channel : rgb) channel *= gain;
  });
  return image;
}

HdrImage LocallyExposed(const HdrImage& image, double ev100, const LocalExposureOptions& options) {
  RequireInRange(options.base_range_stops, 0.0, 100.0, "base_range_stops");
  RequireInRange(options.reach, 1e-4, 1.0, "reach");
  RequireInRange(options.edge_stops, 0.1, 100.0, "edge_stops");
  HdrImage exposed = image;
  const std::optional<Stops> stops = StopsOf(image);
  if (!stops) return exposed;
  const std::vector<float> base = BaseOf(*stops, options);
  const float range = RangeOf(base);
  if (range <= static_cast<float>(options.base_range_stops)) return exposed;
  const float slope = static_cast<float>(options.base_range_stops) / range;
  const auto middle = static_cast<float>(ev100 + std::log2(kMeterConstant / 100.0));
  for (std::size_t i = 0; i < base.size(); ++i) {
    const float gain = std::exp2((slope - 1.0F) * (base[i] - middle));
    for (float& channel : exposed.rgb[i]) channel *= gain;
  }
  return exposed;
}

}  // namespace alpenglow::lut
