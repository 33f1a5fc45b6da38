// SPDX-License-Identifier: MIT
// This header provides what the public HdrImage, an image of light, does not have: its checks, the
// image that is developed for a display, and layers of polarisation. picture_format.h lists the
// formats of files.
//
// Colours of light are not clamped. A colour more saturated than the display's gamut has a negative
// channel and keeps its luminance. The red of a low sun has negative blue; the blue that ozone
// leaves of deep twilight has negative red (100 km up, sun at -15 degrees: a hundredth of the blue,
// and on 16 bands more often than on 4). Tone curves map such colours into the gamut
// (tone_curve.glsl).
//
// Layers of images and panoramas can hold the polarisation of the light. Q is positive for light
// that vibrates along the image's vertical rather than across it, U for light that vibrates from
// the lower left to the upper right rather than across that direction.
#pragma once

#include <alpenglow/image.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace alpenglow::lut {

/// Largest number of pixels along one side of an image.
inline constexpr int kLargestImageSide = 32768;

/// Name of the channel of distances, which is OpenEXR's depth channel Z in a layer.
inline constexpr const char* kDepthChannel = "depth.Z";
/// Name of the channel of the distances of clouds.
inline constexpr const char* kCloudDistanceChannel = "clouds.Z";

/// Returns a description of the first invalid value (see ImageLayer): "pixel (3, 4) of layer lamps.R
/// is nan". Returns nullopt if all values are valid.
[[nodiscard]] std::optional<std::string> FaultyValue(const HdrImage& image);

/// Projection of an image: the view of a camera, or the whole sphere by longitude and latitude
/// (OpenEXR's attribute envmap = latlong).
enum class Projection { kCamera, kLatitudeLongitude };

/// 8-bit sRGB of the exposed image, dithered by triangular blue noise of +-1 code (dither.h;
/// identical in every run). For out-of-gamut colours see tone_curve.glsl.
struct DisplayImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
};

enum class StokesLayer {
  kQ,             // stokes_q.R, .G, .B: linear sRGB [cd/m^2], of either sign
  kU,             // stokes_u.R, .G, .B
  kPolarisation,  // polarisation.degree and .angle, of luminance: DegreeAndAngle
};

/// Converts between a layer and its name: "stokes_q", "stokes_u", "polarisation". Throws InputError
/// for another name.
[[nodiscard]] std::string NameOf(StokesLayer layer);
[[nodiscard]] StokesLayer StokesLayerFromName(const std::string& name);
[[nodiscard]] std::vector<std::string> StokesLayerNames();
/// Returns the layers in the order of their names, each once.
[[nodiscard]] std::vector<StokesLayer> StokesLayersFromNames(const std::vector<std::string>& names);
/// Returns the names of the layer's channels in the EXR file.
[[nodiscard]] std::vector<std::string> ChannelsOf(StokesLayer layer);

/// Returns the degree of linear polarisation in [0, 1], and the direction of vibration [degrees]
/// clockwise from the image's vertical, in [-90, 90]; both 0 without light.
/// @param luminance, q, u  in one unit.
[[nodiscard]] std::array<float, 2> DegreeAndAngle(double luminance, double q, double u);

}  // namespace alpenglow::lut
