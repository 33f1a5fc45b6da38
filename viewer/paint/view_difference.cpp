// SPDX-License-Identifier: MIT
#include "viewer/paint/view_difference.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/text/error.h"
#include "renderer/effect/picture_change.h"

namespace alpenglow::viewer {
namespace {

const std::vector<float>* FindLayer(const Image& image, const std::string& name) {
  for (const Channel& channel : image.layers) {
    if (channel.name == name) return &channel.values;
  }
  return nullptr;
}

const std::vector<float>& LayerOf(const Image& image, const std::string& name) {
  if (const std::vector<float>* layer = FindLayer(image, name)) return *layer;
  throw InternalError("the renderer's picture has no layer " + name);
}

/// Extremes of a layer around a pixel.
struct LuminanceRange {
  float least, most;
};
LuminanceRange RangeAround(const Image& image, const std::vector<float>& layer, int x, int y) {
  LuminanceRange range{INFINITY, -INFINITY};
  for (int row = std::max(y - 1, 0); row <= std::min(y + 1, image.height - 1); ++row) {
    for (int column = std::max(x - 1, 0); column <= std::min(x + 1, image.width - 1); ++column) {
      const float value = layer[static_cast<std::size_t>(row * image.width + column)];
      range = {std::min(range.least, value), std::max(range.most, value)};
    }
  }
  return range;
}

// Light of lamps changes beside a pixel by so much that a tenth of a pixel is a hundredth of it.
bool IsEdgeOfLamps(const Image& image, const std::vector<float>& lamps, int x, int y,
                   float floor_cd_per_m2) {
  constexpr float kStep = 0.2F;
  const LuminanceRange light = RangeAround(image, lamps, x, y);
  return light.most - light.least > kStep * std::max(light.most, floor_cd_per_m2);
}

}  // namespace

std::vector<PictureLayer> LayersOfEdges() {
  return {PictureLayer::kDepth, PictureLayer::kSunVisibility, PictureLayer::kLamps};
}

std::vector<bool> EdgesOf(const Image& judge) {
  constexpr float kNearer = 1.1F;
  constexpr float kShade = 0.1F;
  const std::vector<float>& depth = LayerOf(judge, kDepthChannel);
  const std::vector<float>& sun = LayerOf(judge, "sun_visibility.Y");
  const std::vector<float>* lamps = FindLayer(judge, "lamps.G");
  const auto floor = static_cast<float>(ChangeFloor(judge));
  std::vector<bool> edges;
  edges.reserve(judge.rgb.size());
  for (int y = 0; y < judge.height; ++y) {
    for (int x = 0; x < judge.width; ++x) {
      const LuminanceRange distance = RangeAround(judge, depth, x, y);
      const LuminanceRange light = RangeAround(judge, sun, x, y);
      const bool is_sky = std::isinf(distance.least);
      const bool is_even = is_sky || distance.most <= kNearer * distance.least;
      const bool is_lamp = lamps != nullptr && IsEdgeOfLamps(judge, *lamps, x, y, floor);
      edges.push_back(!is_even || light.most - light.least > kShade || is_lamp);
    }
  }
  return edges;
}

ViewDifference DifferenceOf(const Image& judge, const Image& painted) {
  ALPENGLOW_ENSURE(judge.rgb.size(), ==, painted.rgb.size());
  const std::vector<bool> edges = EdgesOf(judge);
  const double floor = ChangeFloor(judge);
  std::vector<double> changes;
  for (std::size_t i = 0; i < judge.rgb.size(); ++i) {
    if (!edges[i]) changes.push_back(PixelChange(judge.rgb[i], painted.rgb[i], floor));
  }
  ALPENGLOW_ENSURE(changes.size(), >, 0U);
  std::sort(changes.begin(), changes.end());
  double sum = 0.0;
  for (const double change : changes) sum += change;
  const auto count = static_cast<double>(changes.size());
  const auto quantile = [&](double share) {
    return changes[static_cast<std::size_t>(share * (count - 1.0))];
  };
  return {sum / count, quantile(0.99), quantile(0.999), changes.back(),
          1.0 - count / static_cast<double>(judge.rgb.size())};
}

}  // namespace alpenglow::viewer
