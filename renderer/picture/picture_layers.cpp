// SPDX-License-Identifier: MIT
#include "renderer/picture/picture_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "lut/image/image.h"
#include "lut/image/night_vision.h"
#include "renderer/effects/effect_choice.h"
#include "renderer/illumination/polarised_axes.h"
#include "renderer/surface/scene_geometry.h"

namespace alpenglow::renderer {
namespace {

LayerValues Rgb(const BandColour& colour, const Spectrum& light) {
  const auto rgb = colour.LinearSrgb(light);
  return {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2])};
}

template <Spectrum Shaded::*kPart>
LayerValues LightOf(const BandColour& colour, const PixelSum& rays) {
  return Rgb(colour, rays.Mean(kPart));
}

// Returns the colour of a factor (albedo, transmittance) under the sun above the air, within [0,
// 1]. Red light after a long path through air is more saturated than the red primary of sRGB: its
// blue is negative, down to -0.002 beside a red of 0.1. A negative component is correct for light
// (image.h). A negative factor would turn the light that it multiplies negative, so it is clamped.
template <Spectrum Shaded::*kPart>
LayerValues FactorOf(const BandColour& colour, const PixelSum& rays) {
  const Spectrum factor = rays.Mean(kPart);
  Spectrum sun(factor.size());
  for (std::size_t band = 0; band < factor.size(); ++band) {
    sun[band] = static_cast<float>(SolarIrradiance(colour.wavelengths_nm()[band]));
  }
  const LayerValues white = Rgb(colour, sun);
  LayerValues seen = Rgb(colour, sun * factor);
  for (std::size_t c = 0; c < 3; ++c) seen[c] = std::clamp(seen[c] / white[c], 0.0F, 1.0F);
  return seen;
}

LayerValues SunVisibility(const BandColour&, const PixelSum& rays) {
  return {rays.parts->sun_visibility / static_cast<float>(rays.rays)};
}

// Returns light, transmittance and distance of clouds. The mean distance of several rays has their
// weights.
LayerValues Clouds(const BandColour& colour, const PixelSum& rays) {
  const LayerValues light = LightOf<&Shaded::clouds>(colour, rays);
  const auto count = static_cast<float>(rays.rays);
  const float taken = count - rays.parts->cloud_transmittance;
  const float distance_m = taken > 0.0F ? rays.parts->cloud_distance_m / taken : INFINITY;
  return {light[0], light[1], light[2], rays.parts->cloud_transmittance / count, distance_m};
}

LayerValues Scotopic(const BandColour& colour, const PixelSum& rays) {
  return {static_cast<float>(colour.ScotopicLuminance(rays.MeanRadiance()))};
}

LayerValues RayCountLayer(const BandColour&, const PixelSum& rays) {
  return {static_cast<float>(rays.rays)};
}

template <Spectrum PolarisedLight::*kPart>
LayerValues StokesOf(const BandColour& colour, const PixelSum& rays) {
  return Rgb(colour, (1.0F / static_cast<float>(rays.rays)) * (*rays.parts->polarised.*kPart));
}

LayerValues Polarisation(const BandColour& colour, const PixelSum& rays) {
  const auto luminance = [&](const Spectrum& light) { return colour.Xyz(light)[1]; };
  const auto [degree, angle] =
      DegreeAndAngle(luminance(rays.radiance), luminance(rays.parts->polarised->q),
                     luminance(rays.parts->polarised->u));
  return {degree, angle};
}

LayerKind InStokes(PictureLayer layer, StokesLayer stokes,
                   LayerValues (*of_rays)(const BandColour&, const PixelSum&)) {
  return {layer, NameOf(stokes), ChannelsOf(stokes), nullptr, of_rays};
}

LayerValues Depth(const Hit& hit) { return {static_cast<float>(hit.distance_m)}; }

LayerValues Normal(const Hit& hit) {
  if (hit.kind == HitKind::kSky) return {};
  return {static_cast<float>(hit.normal.x), static_cast<float>(hit.normal.y),
          static_cast<float>(hit.normal.z)};
}

LayerKind InColour(PictureLayer layer, const std::string& name,
                   LayerValues (*of_rays)(const BandColour&, const PixelSum&)) {
  return {layer, name, {name + ".R", name + ".G", name + ".B"}, nullptr, of_rays};
}

// Returns the kinds in the order of the enumeration.
const std::vector<LayerKind>& LayerKinds() {
  using enum PictureLayer;
  static const std::vector<LayerKind> kKinds{
      {kDepth, "depth", {kDepthChannel}, Depth, nullptr},
      {kNormal, "normal", {"normal.X", "normal.Y", "normal.Z"}, Normal, nullptr},
      InColour(kAlbedo, "albedo", FactorOf<&Shaded::albedo>),
      InColour(kInscatter, "inscatter", LightOf<&Shaded::inscatter>),
      InColour(kTransmittance, "transmittance", FactorOf<&Shaded::transmittance>),
      {kSunVisibility, "sun_visibility", {"sun_visibility.Y"}, nullptr, SunVisibility},
      InColour(kLamps, "lamps", LightOf<&Shaded::lamps>),
      InColour(kVolumes, "volumes", LightOf<&Shaded::volumes>),
      {kClouds,
       "clouds",
       {"clouds.R", "clouds.G", "clouds.B", "clouds.T", kCloudDistanceChannel},
       nullptr,
       Clouds},
      {kScotopic, "scotopic", {kScotopicChannel}, nullptr, Scotopic},
      {kRays, "rays", {"rays.Y"}, nullptr, RayCountLayer},
      InStokes(kStokesQ, StokesLayer::kQ, StokesOf<&PolarisedLight::q>),
      InStokes(kStokesU, StokesLayer::kU, StokesOf<&PolarisedLight::u>),
      InStokes(kPolarisation, StokesLayer::kPolarisation, Polarisation)};
  return kKinds;
}

const std::vector<float>* FindLayer(const HdrImage& image, std::string_view name) {
  for (const ImageLayer& channel : image.layers) {
    if (channel.name == name) return &channel.values;
  }
  return nullptr;
}

const std::vector<float>& LayerOf(const HdrImage& image, std::string_view name) {
  if (const std::vector<float>* layer = FindLayer(image, name)) return *layer;
  throw InternalError("the renderer's picture has no layer " + std::string(name));
}

/// Minimum and maximum of a layer in the neighbourhood of a pixel.
struct LuminanceRange {
  float least, most;
};
LuminanceRange RangeAround(const HdrImage& image, const std::vector<float>& layer, int x, int y) {
  LuminanceRange range{INFINITY, -INFINITY};
  for (int row = std::max(y - 1, 0); row <= std::min(y + 1, image.height - 1); ++row) {
    for (int column = std::max(x - 1, 0); column <= std::min(x + 1, image.width - 1); ++column) {
      const float value = layer[static_cast<std::size_t>(row * image.width + column)];
      range = {std::min(range.least, value), std::max(range.most, value)};
    }
  }
  return range;
}

// Returns whether lamp light changes so much next to a pixel that an offset of a tenth of a pixel
// changes it by a hundredth.
bool IsEdgeOfLamps(const HdrImage& image, const std::vector<float>& lamps, int x, int y,
                   float floor_cd_per_m2) {
  constexpr float kStep = 0.2F;
  const LuminanceRange light = RangeAround(image, lamps, x, y);
  return light.most - light.least > kStep * std::max(light.most, floor_cd_per_m2);
}

/// Returns the changes of pixels that are not at an edge.
/// @param counts  returns whether a pixel counts, by its number.
template <typename Counts>
std::vector<double> ChangesWhere(const Counts& counts, const HdrImage& reference,
                                 const HdrImage& painted) {
  ALPENGLOW_ENSURE(reference.rgb.size(), ==, painted.rgb.size());
  const std::vector<bool> edges = EdgesOf(reference);
  const double floor = ChangeFloor(reference);
  std::vector<double> changes;
  for (std::size_t i = 0; i < reference.rgb.size(); ++i) {
    if (!edges[i] && counts(i))
      changes.push_back(PixelChange(reference.rgb[i], painted.rgb[i], floor));
  }
  return changes;
}

}  // namespace

std::optional<double> PathSpread::RelativeError() const {
  if (paths < 2 || !(sum > 0.0)) return std::nullopt;
  const auto count = static_cast<double>(paths);
  const double variance = std::max(squares - sum * sum / count, 0.0) / (count - 1.0);
  return std::sqrt(variance * count) / sum;
}

void PixelSum::Add(const Shaded& ray, bool with_parts) {
  const bool is_first = rays++ == 0;
  radiance = is_first ? ray.radiance : radiance + ray.radiance;
  if (!with_parts) return;
  if (is_first) {
    parts = std::make_shared<Shaded>(ray);
    return;
  }
  for (const auto part : {&Shaded::inscatter, &Shaded::transmittance, &Shaded::albedo,
                          &Shaded::lamps, &Shaded::volumes, &Shaded::clouds})
    (*parts).*part = (*parts).*part + ray.*part;
  if (ray.polarised) parts->polarised = *parts->polarised + *ray.polarised;
  parts->sun_visibility += ray.sun_visibility;
  parts->cloud_transmittance += ray.cloud_transmittance;
  parts->cloud_distance_m += ray.cloud_distance_m;
}

const std::vector<std::string>& LayerNames() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names;
    for (const LayerKind& kind : LayerKinds()) names.push_back(kind.name);
    return names;
  }();
  return kNames;
}

const LayerKind& KindOf(PictureLayer layer) {
  return LayerKinds().at(static_cast<std::size_t>(layer));
}

bool IsOfPolarisation(PictureLayer layer) {
  return layer == PictureLayer::kStokesQ || layer == PictureLayer::kStokesU ||
         layer == PictureLayer::kPolarisation;
}

std::string NameOf(PictureLayer layer) { return KindOf(layer).name; }

PictureLayer LayerFromName(const std::string& name) {
  const auto& kinds = LayerKinds();
  const auto found = std::find_if(kinds.begin(), kinds.end(),
                                  [&](const LayerKind& kind) { return kind.name == name; });
  if (found != kinds.end()) return found->layer;
  throw InputError(
      fmt::format("layer \"{}\" is not one of {}", name, fmt::join(LayerNames(), ", ")));
}

std::vector<PictureLayer> LayersFromNames(const std::vector<std::string>& names) {
  std::vector<PictureLayer> layers;
  for (const std::string& name : names) layers.push_back(LayerFromName(name));
  return layers;
}

PixelWriter::PixelWriter(const BandColour& colour, int width, int height,
                         const std::vector<PictureLayer>& layers)
    : colour_(colour), image_(width, height) {
  for (const PictureLayer layer : layers) {
    const LayerKind& kind = KindOf(layer);
    if (std::any_of(planes_.begin(), planes_.end(),
                    [&](const Plane& plane) { return plane.kind.layer == layer; })) {
      continue;
    }
    planes_.push_back({kind, image_.layers.size()});
    for (const std::string& channel : kind.channels) {
      image_.layers.push_back({channel, std::vector<float>(image_.rgb.size(), 0.0F)});
    }
  }
}

void PixelWriter::Set(const Plane& plane, int x, int y, const LayerValues& values) {
  const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) +
                            static_cast<std::size_t>(x);
  for (std::size_t i = 0; i < plane.kind.channels.size(); ++i) {
    image_.layers[plane.first_channel + i].values[pixel] = values.at(i);
  }
}

void PixelWriter::Write(int x, int y, const PixelSum& rays) {
  Count(static_cast<std::uint64_t>(rays.rays));
  Count(rays.paths);
  const auto rgb = colour_.LinearSrgb(rays.MeanRadiance());
  image_.at(x, y) = {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]),
                     static_cast<float>(rgb[2])};
  for (const Plane& plane : planes_) {
    if (plane.kind.of_rays != nullptr) Set(plane, x, y, plane.kind.of_rays(colour_, rays));
  }
}

void PixelWriter::Count(std::uint64_t rays) {
  rays_ += rays;
  for (std::uint64_t seen = least_; rays < seen && !least_.compare_exchange_weak(seen, rays);) {
  }
  for (std::uint64_t seen = most_; rays > seen && !most_.compare_exchange_weak(seen, rays);) {
  }
}

void PixelWriter::Count(const PathSpread& paths) {
  constexpr double kMost = 1000.0;
  const std::optional<double> error = paths.RelativeError();
  if (!error) return;
  ++traced_pixels_;
  errors_in_millionths_ += static_cast<std::uint64_t>(1e6 * std::min(*error, kMost));
}

RayCount PixelWriter::rays() const {
  RayCount count{rays_, least_ <= most_ ? least_.load() : 0, most_};
  if (traced_pixels_ > 0) {
    count.path_error =
        1e-6 * static_cast<double>(errors_in_millionths_) / static_cast<double>(traced_pixels_);
  }
  return count;
}

void PixelWriter::WriteMiddle(int x, int y, const Hit& hit) {
  for (const Plane& plane : planes_) {
    if (plane.kind.of_middle != nullptr) Set(plane, x, y, plane.kind.of_middle(hit));
  }
}

bool PixelWriter::AsksForMiddle() const {
  return std::any_of(planes_.begin(), planes_.end(),
                     [](const Plane& plane) { return plane.kind.of_middle != nullptr; });
}

HdrImage PixelWriter::Take() { return std::move(image_); }

std::vector<PictureLayer> LayersOfEdges() {
  return {PictureLayer::kDepth, PictureLayer::kSunVisibility, PictureLayer::kLamps};
}

std::vector<bool> EdgesOf(const HdrImage& reference) {
  constexpr float kNearer = 1.1F;
  constexpr float kShade = 0.1F;
  const std::vector<float>& depth = LayerOf(reference, kDepthChannel);
  const std::vector<float>& sun = LayerOf(reference, "sun_visibility.Y");
  const std::vector<float>* lamps = FindLayer(reference, "lamps.G");
  const auto floor = static_cast<float>(ChangeFloor(reference));
  std::vector<bool> edges;
  edges.reserve(reference.rgb.size());
  for (int y = 0; y < reference.height; ++y) {
    for (int x = 0; x < reference.width; ++x) {
      const LuminanceRange distance = RangeAround(reference, depth, x, y);
      const LuminanceRange light = RangeAround(reference, sun, x, y);
      const bool is_sky = std::isinf(distance.least);
      const bool is_even = is_sky || distance.most <= kNearer * distance.least;
      const bool is_lamp = lamps != nullptr && IsEdgeOfLamps(reference, *lamps, x, y, floor);
      edges.push_back(!is_even || light.most - light.least > kShade || is_lamp);
    }
  }
  return edges;
}

ErrorStatistics DifferenceOf(const HdrImage& reference, const HdrImage& painted) {
  std::vector<double> changes = ChangesWhere([](std::size_t) { return true; }, reference, painted);
  ALPENGLOW_ENSURE(changes.size(), >, 0U);
  return ErrorStatistics(std::move(changes));
}

std::optional<ErrorStatistics> DifferenceOf(const HdrImage& reference, const HdrImage& painted,
                                            CloudyPixels pixels) {
  constexpr float kLeftByClouds = 0.9F;
  const std::vector<float>* left = FindLayer(reference, "clouds.T");
  if (left == nullptr) return std::nullopt;
  const auto counts = [&](std::size_t i) {
    return ((*left)[i] < kLeftByClouds) == (pixels == CloudyPixels::kCloudy);
  };
  std::vector<double> changes = ChangesWhere(counts, reference, painted);
  return changes.empty() ? std::nullopt : std::optional(ErrorStatistics(std::move(changes)));
}

}  // namespace alpenglow::renderer
