// SPDX-License-Identifier: MIT
// From the rays of a pixel to the picture and its layers.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "lut/picture/image.h"
#include "renderer/ground/band_light.h"
#include "renderer/ground/scene_geometry.h"
#include "renderer/picture/render.h"

namespace alpenglow {

/// One ray's contribution to a pixel.
struct Shaded {
  BandLight radiance;  // W m^-2 sr^-1 nm^-1
  BandLight inscatter, transmittance, albedo;
  BandLight lamps;    // of radiance, what comes from lamps
  BandLight volumes;  // of radiance, what volumes and fog send of sun, sky and their own
  float sun_visibility = 0.0F;
};

/// Accumulates the rays of a pixel into the picture.
class PixelWriter {
 public:
  /// Throws InputError for a layer that is not of KnownLayers(). Refers to `colour`.
  PixelWriter(const BandColour& colour, const RenderSettings& settings);

  /// Whether a layer is of what stands in the middle of a pixel: see WriteMiddle.
  [[nodiscard]] bool AsksForMiddle() const;

  /// Means of the rays. Not shared between pixels: rows may be written from any thread.
  void Write(int x, int y, const std::vector<Shaded>& rays);
  /// Depth and normal: a mean of two surfaces is the depth of neither.
  void WriteMiddle(int x, int y, const Hit& hit);

  [[nodiscard]] Image Take();

 private:
  [[nodiscard]] std::array<float, 3> Rgb(const BandLight& light) const;
  [[nodiscard]] std::array<float, 3> RgbOfFactor(const BandLight& factor) const;
  [[nodiscard]] std::vector<float> ValuesOf(const std::string& layer,
                                            const std::vector<Shaded>& rays) const;
  /// Writes the values of each layer that `values` knows.
  template <typename Values>
  void WriteLayers(int x, int y, bool of_middle, const Values& values);

  const BandColour& colour_;
  Image image_;
  std::vector<std::string> layers_;
};

}  // namespace alpenglow
