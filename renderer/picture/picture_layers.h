// SPDX-License-Identifier: MIT
// Layers that a picture can have besides its colours: one table of their names, channels and
// values, and the writer that turns the rays of a pixel into the picture and its layers.
//
// DifferenceOf compares a picture with the renderer's, away from edges. The difference of a pixel
// is PixelChange (effect_choice.h), the relative difference of linear radiance above the floor of
// ChangeFloor. Pixels at an edge are excluded, because there a hundredth of a pixel decides what is
// visible: pixels with neighbours of another kind, a tenth farther or nearer, lit by more or less
// of the sun's disk, or lit a fifth more or less by lamps.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/error_statistics.h"
#include "lut/image/image.h"
#include "lut/multiple_scattering/polarised_scattering.h"
#include "renderer/surface/scene_geometry.h"

namespace alpenglow::renderer {

struct Hit;

enum class PictureLayer {
  kDepth,          // [m], infinite in the sky
  kNormal,         // ENU, unit, with relief; zero in the sky
  kAlbedo,         // 0 to 1, colour under the sun above the air
  kInscatter,      // light of sun and sky scattered by air [cd/m^2]
  kTransmittance,  // of air and media, 0 to 1, colour under the sun above the air
  kSunVisibility,  // 0 to 1
  kLamps,          // all light that comes from lamps [cd/m^2]
  kVolumes,        // light scattered by media, and their emission, also on the ground [cd/m^2]
  kClouds,         // see Shaded: light of clouds [cd/m^2], their transmittance, their distance [m],
                   // which is infinite without clouds
  kScotopic,       // luminance for the rods of the eye [scotopic cd/m^2]
  kRays,           // number of rays of the pixel
  // Stokes layers of the mean radiance of the pixel's rays (image.h); with a polariser, of the
  // light that it passes.
  kStokesQ,
  kStokesU,
  kPolarisation,
};

/// Returns whether the layer is a Stokes layer of image.h, computed from Shaded::polarised.
[[nodiscard]] bool IsOfPolarisation(PictureLayer layer);

/// Returns the names of all layers, in the order of the enumeration.
[[nodiscard]] const std::vector<std::string>& LayerNames();
[[nodiscard]] std::string NameOf(PictureLayer layer);
/// Throws InputError for a name that is not in LayerNames().
[[nodiscard]] PictureLayer LayerFromName(const std::string& name);
[[nodiscard]] std::vector<PictureLayer> LayersFromNames(const std::vector<std::string>& names);

/// One ray's contribution to a pixel.
struct Shaded {
  Spectrum radiance;  // W m^-2 sr^-1 nm^-1
  Spectrum inscatter, transmittance, albedo;
  Spectrum lamps;    // part of `radiance` that comes from lamps
  Spectrum volumes;  // part of `radiance` that media scatter from sun and sky, or emit
  /// Q and U of `radiance` in the axes of the picture; empty unless requested.
  std::optional<PolarisedLight> polarised = std::nullopt;
  float sun_visibility = 0.0F;
  Spectrum clouds;  // part of `radiance` that clouds scatter to the eye
  float cloud_transmittance = 1.0F;
  /// Distances along the ray, weighted by the light that clouds take away there [m]: the mean
  /// distance of the clouds, times 1 - cloud_transmittance.
  float cloud_distance_m = 0.0F;
};

/// The luminances of the paths of a pixel.
struct PathSpread {
  std::uint64_t paths = 0;
  double sum = 0.0, squares = 0.0;

  void Add(double luminance) {
    ++paths;
    sum += luminance;
    squares += luminance * luminance;
  }
  /// Returns the standard error of the mean, relative to it; no value for black pixels, and for a
  /// single path.
  [[nodiscard]] std::optional<double> RelativeError() const;
};

/// Sum over the rays of a pixel, which all have the same weight.
struct PixelSum {
  Spectrum radiance;
  int rays = 0;
  PathSpread paths = {};
  /// Sums of the other members of Shaded; null unless layers need them, since most pictures have no
  /// layers.
  std::shared_ptr<Shaded> parts = nullptr;

  /// @param with_parts  must be equal for all rays of the pixel.
  void Add(const Shaded& ray, bool with_parts);
  [[nodiscard]] Spectrum MeanRadiance() const {
    return (1.0F / static_cast<float>(rays)) * radiance;
  }
  [[nodiscard]] Spectrum Mean(Spectrum Shaded::*part) const {
    return (1.0F / static_cast<float>(rays)) * ((*parts).*part);
  }
};

/// Values of a layer's channels in one pixel; unused entries are 0.
using LayerValues = std::array<float, 5>;

/// Describes how a layer gets its values: from the surface in the middle of a pixel (the mean depth
/// of two surfaces is the depth of neither), or from the mean of the pixel's rays. One of the two
/// functions is null.
struct LayerKind {
  PictureLayer layer;
  std::string name;
  std::vector<std::string> channels;
  LayerValues (*of_middle)(const Hit& hit);
  LayerValues (*of_rays)(const BandColour& colour, const PixelSum& rays);
};

[[nodiscard]] const LayerKind& KindOf(PictureLayer layer);

/// Numbers of rays in a picture.
struct RayCount {
  std::uint64_t rays = 0;   // sum over all pixels
  std::uint64_t least = 0;  // smallest number in a pixel
  std::uint64_t most = 0;   // largest number in a pixel
  /// Mean of the relative standard errors of luminance in pixels; empty without paths.
  std::optional<double> path_error = std::nullopt;
};

/// Writes the means of pixels into the picture.
class PixelWriter {
 public:
  /// A layer that is named twice is stored once. Refers to `colour`.
  PixelWriter(const BandColour& colour, int width, int height,
              const std::vector<PictureLayer>& layers);

  /// Returns whether a layer takes its values from the middle of a pixel (WriteMiddle).
  [[nodiscard]] bool AsksForMiddle() const;

  /// Writes the means of the rays. Pixels share no data, so rows may be written from any thread.
  void Write(int x, int y, const PixelSum& rays);
  /// Writes the layers that describe the surface in the middle of the pixel.
  void WriteMiddle(int x, int y, const Hit& hit);

  [[nodiscard]] HdrImage Take();
  /// Returns the ray counts of the pixels written so far.
  [[nodiscard]] RayCount rays() const;

 private:
  struct Plane {
    const LayerKind& kind;
    std::size_t first_channel;  // index into image_.layers
  };
  void Set(const Plane& plane, int x, int y, const LayerValues& values);

  void Count(std::uint64_t rays);
  void Count(const PathSpread& paths);

  const BandColour& colour_;
  HdrImage image_;
  std::vector<Plane> planes_;
  std::atomic<std::uint64_t> rays_{0}, least_{~std::uint64_t{0}}, most_{0};
  // Whole numbers, so that their sum does not depend on the order of the pixels.
  std::atomic<std::uint64_t> traced_pixels_{0}, errors_in_millionths_{0};
};

/// Returns the layers that the renderer's picture must have. The layer of lamps is optional;
/// without it lamps cause no edges.
[[nodiscard]] std::vector<PictureLayer> LayersOfEdges();

/// Returns which pixels of the renderer's picture are at an edge, row by row.
[[nodiscard]] std::vector<bool> EdgesOf(const HdrImage& reference);

/// Returns the differences of a drawn picture from the reference, of all pixels that are not at an
/// edge.
/// @param reference solution  the renderer's, with LayersOfEdges(). Throws InternalError if the
///   sizes differ or all pixels are at edges.
[[nodiscard]] ErrorStatistics DifferenceOf(const HdrImage& reference, const HdrImage& painted);

/// Pixels from which clouds take more than a tenth of the light, and the others.
enum class CloudyPixels { kCloudy, kClear };
/// Returns the differences of such pixels only; nothing if there are none.
/// @param reference  also with PictureLayer::kClouds, otherwise it has no such pixels.
[[nodiscard]] std::optional<ErrorStatistics> DifferenceOf(const HdrImage& reference,
                                                          const HdrImage& painted,
                                                          CloudyPixels pixels);

}  // namespace alpenglow::renderer
