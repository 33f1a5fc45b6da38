// SPDX-License-Identifier: MIT
#include "lut/image/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "atmosphere/base/error.h"
#include "atmosphere/base/names.h"
#include "atmosphere/math/constants.h"
#include "lut/layer.h"

namespace alpenglow::lut {
namespace {

std::string FaultAt(const HdrImage& image, std::size_t pixel, std::string_view of, float value) {
  const auto width = static_cast<std::size_t>(image.width);
  return fmt::format("pixel ({}, {}) of {} is {}", pixel % width, pixel / width, of, value);
}

std::optional<std::string> FaultOf(const HdrImage& image, const ImageLayer& layer) {
  const bool is_distance = layer.name == kDepthChannel || layer.name == kCloudDistanceChannel;
  const auto fault = std::find_if(layer.values.begin(), layer.values.end(), [&](float value) {
    return is_distance ? !(value >= 0.0F) : !std::isfinite(value);
  });
  if (fault == layer.values.end()) return std::nullopt;
  const auto pixel = static_cast<std::size_t>(fault - layer.values.begin());
  return FaultAt(image, pixel, "layer " + layer.name, *fault);
}

constexpr EnumNames kStokesNames{{std::pair{StokesLayer::kQ, "stokes_q"},
                                  {StokesLayer::kU, "stokes_u"},
                                  {StokesLayer::kPolarisation, "polarisation"}}};

}  // namespace

std::optional<std::string> FaultyValue(const HdrImage& image) {
  for (std::size_t pixel = 0; pixel < image.rgb.size(); ++pixel) {
    for (std::size_t c = 0; c < 3; ++c) {
      const float value = image.rgb[pixel][c];
      if (std::isfinite(value)) continue;
      return FaultAt(image, pixel, std::string("layer ") + "RGB"[c], value);
    }
  }
  for (const ImageLayer& layer : image.layers) {
    if (auto fault = FaultOf(image, layer)) return fault;
  }
  return std::nullopt;
}

std::string NameOf(StokesLayer layer) { return kStokesNames.Of(layer); }

StokesLayer StokesLayerFromName(const std::string& name) {
  return kStokesNames.Named(name, "layer \"{}\" is not one of {}");
}

std::vector<std::string> StokesLayerNames() { return kStokesNames.All(); }

std::vector<StokesLayer> StokesLayersFromNames(const std::vector<std::string>& names) {
  std::vector<StokesLayer> layers;
  for (const std::string& name : names) {
    const StokesLayer layer = StokesLayerFromName(name);
    if (std::find(layers.begin(), layers.end(), layer) == layers.end()) layers.push_back(layer);
  }
  return layers;
}

std::vector<std::string> ChannelsOf(StokesLayer layer) {
  const std::string name = NameOf(layer);
  if (layer == StokesLayer::kPolarisation) return {name + ".degree", name + ".angle"};
  return {name + ".R", name + ".G", name + ".B"};
}

std::array<float, 2> DegreeAndAngle(double luminance, double q, double u) {
  const double polarised = std::hypot(q, u);
  if (!(luminance > 0.0) || polarised == 0.0) return {0.0F, 0.0F};
  return {static_cast<float>(std::min(polarised / luminance, 1.0)),
          static_cast<float>(0.5 * std::atan2(u, q) / kRadiansPerDegree)};
}

}  // namespace alpenglow::lut
