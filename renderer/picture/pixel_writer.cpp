// SPDX-License-Identifier: MIT
#include "renderer/picture/pixel_writer.h"

#include <algorithm>

#include "atmosphere/text/error.h"
#include "lut/picture/night_vision.h"

namespace alpenglow {
namespace {

std::vector<std::string> ChannelsOf(const std::string& layer) {
  if (layer == "depth") return {"depth.Z"};
  if (layer == "sun_visibility") return {"sun_visibility.Y"};
  if (layer == kScotopicLayer) return {kScotopicChannel};
  if (layer == "normal") return {"normal.X", "normal.Y", "normal.Z"};
  return {layer + ".R", layer + ".G", layer + ".B"};
}

bool IsOfMiddle(const std::string& layer) { return layer == "depth" || layer == "normal"; }

std::vector<float> ValuesOfMiddle(const std::string& layer, const Hit& hit) {
  if (layer == "depth") return {static_cast<float>(hit.distance_m)};
  if (hit.kind == HitKind::kSky) return {0.0F, 0.0F, 0.0F};
  return {static_cast<float>(hit.normal.x), static_cast<float>(hit.normal.y),
          static_cast<float>(hit.normal.z)};
}

}  // namespace

const std::vector<std::string>& KnownLayers() {
  static const std::vector<std::string> layers{"depth",     "normal",        "albedo",
                                               "inscatter", "transmittance", "sun_visibility",
                                               "lamps",     "volumes",       kScotopicLayer};
  return layers;
}

PixelWriter::PixelWriter(const BandColour& colour, const RenderSettings& settings)
    : colour_(colour), image_(settings.width, settings.height) {
  for (const std::string& layer : settings.layers) {
    if (std::find(KnownLayers().begin(), KnownLayers().end(), layer) == KnownLayers().end()) {
      throw InputError(
          fmt::format("layer \"{}\" is not one of {}", layer, fmt::join(KnownLayers(), ", ")));
    }
    for (const std::string& channel : ChannelsOf(layer)) {
      image_.layers.push_back({channel, std::vector<float>(image_.rgb.size(), 0.0F)});
    }
    layers_.push_back(layer);
  }
}

void PixelWriter::Write(int x, int y, const std::vector<Shaded>& rays) {
  const auto share = 1.0F / static_cast<float>(rays.size());
  BandLight radiance(rays.front().radiance.count);
  for (const Shaded& ray : rays) radiance = radiance + share * ray.radiance;
  image_.at(x, y) = Rgb(radiance);
  WriteLayers(x, y, false, [&](const std::string& layer) { return ValuesOf(layer, rays); });
}

void PixelWriter::WriteMiddle(int x, int y, const Hit& hit) {
  WriteLayers(x, y, true, [&](const std::string& layer) { return ValuesOfMiddle(layer, hit); });
}

template <typename Values>
void PixelWriter::WriteLayers(int x, int y, bool of_middle, const Values& values) {
  const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) +
                            static_cast<std::size_t>(x);
  std::size_t channel = 0;
  for (const std::string& layer : layers_) {
    if (IsOfMiddle(layer) != of_middle) {
      channel += ChannelsOf(layer).size();
      continue;
    }
    for (const float value : values(layer)) image_.layers[channel++].values[pixel] = value;
  }
}

bool PixelWriter::AsksForMiddle() const {
  return std::any_of(layers_.begin(), layers_.end(), IsOfMiddle);
}

Image PixelWriter::Take() { return std::move(image_); }

std::array<float, 3> PixelWriter::Rgb(const BandLight& light) const {
  const auto rgb = colour_.LinearSrgb(InDouble(light));
  return {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2])};
}

// Colour of a factor (albedo, transmittance) as it looks under the sun above the air.
std::array<float, 3> PixelWriter::RgbOfFactor(const BandLight& factor) const {
  BandLight sun(factor.count);
  for (std::size_t band = 0; band < factor.count; ++band) {
    sun[band] = static_cast<float>(SolarIrradiance(colour_.wavelengths_nm()[band]));
  }
  const auto white = Rgb(sun);
  const auto seen = Rgb(sun * factor);
  return {seen[0] / white[0], seen[1] / white[1], seen[2] / white[2]};
}

std::vector<float> PixelWriter::ValuesOf(const std::string& layer,
                                         const std::vector<Shaded>& rays) const {
  const auto share = 1.0F / static_cast<float>(rays.size());
  if (layer == "sun_visibility") {
    float visible = 0.0F;
    for (const Shaded& ray : rays) visible += share * ray.sun_visibility;
    return {visible};
  }
  BandLight mean(rays.front().radiance.count);
  for (const Shaded& ray : rays) {
    mean = mean + share * (layer == "albedo"          ? ray.albedo
                           : layer == "transmittance" ? ray.transmittance
                           : layer == "lamps"         ? ray.lamps
                           : layer == "volumes"       ? ray.volumes
                           : layer == kScotopicLayer  ? ray.radiance
                                                      : ray.inscatter);
  }
  if (layer == kScotopicLayer)
    return {static_cast<float>(colour_.ScotopicLuminance(InDouble(mean)))};
  const bool is_light = layer == "inscatter" || layer == "lamps" || layer == "volumes";
  const auto rgb = is_light ? Rgb(mean) : RgbOfFactor(mean);
  return {rgb[0], rgb[1], rgb[2]};
}

}  // namespace alpenglow
