// SPDX-License-Identifier: MIT
// The layers that a picture may have besides its colours: one table of their names, channels and
// values.
//
// From the rays of a pixel to the picture and its layers.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "lut/picture/image.h"
#include "renderer/ground/band_light.h"
#include "renderer/ground/scene_geometry.h"
#include "renderer/light/picture_stokes.h"

namespace alpenglow::renderer {

struct Hit;

enum class PictureLayer {
  kDepth,          // [m], infinite in the sky
  kNormal,         // ENU, unit, with relief; zero in the sky
  kAlbedo,         // 0 to 1, as a colour under the sun above the air
  kInscatter,      // of sun and sky in air [cd/m^2]
  kTransmittance,  // of air, fog and volumes, 0 to 1, as a colour under the sun above the air
  kSunVisibility,  // 0 to 1
  kLamps,          // all that comes from lamps [cd/m^2]
  kVolumes,        // in fog and volumes, and what these emit [cd/m^2]
  kScotopic,       // what rods see [scotopic cd/m^2]
  kRays,           // how many the pixel took
  // Of the mean radiance of the pixel's rays (image.h); behind a polariser, what it passes.
  kStokesQ,
  kStokesU,
  kPolarisation,
};

/// Whether the layer is one of image.h, made of Shaded::polarised.
[[nodiscard]] bool IsOfPolarisation(PictureLayer layer);

/// Names of all layers, in their order.
[[nodiscard]] const std::vector<std::string>& LayerNames();
[[nodiscard]] std::string NameOf(PictureLayer layer);
/// Throws InputError for a name that is not of LayerNames().
[[nodiscard]] PictureLayer LayerFromName(const std::string& name);
[[nodiscard]] std::vector<PictureLayer> LayersFromNames(const std::vector<std::string>& names);

/// One ray's contribution to a pixel.
struct Shaded {
  BandLight radiance;  // W m^-2 sr^-1 nm^-1
  BandLight inscatter, transmittance, albedo;
  BandLight lamps;    // of radiance, what comes from lamps
  BandLight volumes;  // of radiance, what volumes and fog send of sun, sky and their own
  /// Of radiance, Q and U in the axes of the picture; where asked for.
  std::optional<PolarisedLight> polarised = std::nullopt;
  float sun_visibility = 0.0F;
};

/// Rays of a pixel, which count alike.
struct PixelSum {
  BandLight radiance;
  int rays = 0;
  /// Sums of the rest: only where layers ask for it, since most pictures have none.
  std::shared_ptr<Shaded> parts = nullptr;

  /// @param with_parts  of the first ray and all that follow.
  void Add(const Shaded& ray, bool with_parts);
  [[nodiscard]] BandLight MeanRadiance() const {
    return (1.0F / static_cast<float>(rays)) * radiance;
  }
  [[nodiscard]] BandLight Mean(BandLight Shaded::*part) const {
    return (1.0F / static_cast<float>(rays)) * ((*parts).*part);
  }
};

/// Values of a layer's channels in one pixel, as many as it has.
using LayerValues = std::array<float, 3>;

/// How a layer gets its values. Of what stands in the middle of a pixel (a mean of two surfaces is
/// the depth of neither), or the mean of its rays: one of the two is null.
struct LayerKind {
  PictureLayer layer;
  std::string name;
  std::vector<std::string> channels;
  LayerValues (*of_middle)(const Hit& hit);
  LayerValues (*of_rays)(const BandColour& colour, const PixelSum& rays);
};

[[nodiscard]] const LayerKind& KindOf(PictureLayer layer);

/// How many rays the pixels of a picture took.
struct RayCount {
  std::uint64_t rays = 0;   // of all pixels
  std::uint64_t least = 0;  // of a pixel
  std::uint64_t most = 0;   // of a pixel
};

/// Puts the means of pixels into the picture.
class PixelWriter {
 public:
  /// A layer that is named twice is there once. Refers to `colour`.
  PixelWriter(const BandColour& colour, int width, int height,
              const std::vector<PictureLayer>& layers);

  /// Whether a layer is of what stands in the middle of a pixel: see WriteMiddle.
  [[nodiscard]] bool AsksForMiddle() const;

  /// Means of the rays. Not shared between pixels: rows may be written from any thread.
  void Write(int x, int y, const PixelSum& rays);
  /// Layers of what stands in the middle.
  void WriteMiddle(int x, int y, const Hit& hit);

  [[nodiscard]] Image Take();
  /// Of the pixels that are written.
  [[nodiscard]] RayCount rays() const {
    return {rays_, least_ <= most_ ? least_.load() : 0, most_};
  }

 private:
  struct Plane {
    const LayerKind& kind;
    std::size_t first_channel;  // of image_.layers
  };
  void Set(const Plane& plane, int x, int y, const LayerValues& values);

  void Count(std::uint64_t rays);

  const BandColour& colour_;
  Image image_;
  std::vector<Plane> planes_;
  std::atomic<std::uint64_t> rays_{0}, least_{~std::uint64_t{0}}, most_{0};
};

}  // namespace alpenglow::renderer
