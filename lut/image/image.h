// SPDX-License-Identifier: MIT
// This header provides images: linear in memory, EXR (linear, with metadata) and PNG (exposed,
// tone-mapped, dithered).
//
// Layers of images and panoramas can hold the polarisation of the light. Q is positive for light
// that vibrates along the image's vertical rather than across it, U for light that vibrates from
// the lower left to the upper right rather than across that direction.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace alpenglow::lut {

/// Largest number of pixels along one side of an image.
inline constexpr int kLargestImageSide = 32768;

/// Name of the channel of distances, which is OpenEXR's depth channel Z in a layer.
inline constexpr const char* kDepthChannel = "depth.Z";

/// A plane of floats, row 0 at the top. Values of kDepthChannel are not negative, and infinite
/// where a ray hits nothing. Values of all other channels are finite.
struct Channel {
  std::string name;  // name in the EXR file: "R", "depth.Z", ...
  std::vector<float> values;
};

/// An image in linear sRGB [cd/m^2] with, optionally, more layers of equal size.
///
/// Colours are not clamped. A colour more saturated than the display's gamut has a negative channel
/// and keeps its luminance. The red of a low sun has negative blue; the blue that ozone leaves of
/// deep twilight has negative red (100 km up, sun at -15 degrees: a hundredth of the blue, and on
/// 16 bands more often than on 4). Tone curves map such colours into the gamut (tone_curve.glsl).
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::array<float, 3>> rgb;
  std::vector<Channel> layers;

  Image() = default;
  /// Makes a black image. Throws InputError unless both sides are in [1, kLargestImageSide].
  Image(int image_width, int image_height);
  [[nodiscard]] std::array<float, 3>& at(int x, int y) {
    return rgb[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(x)];
  }
  [[nodiscard]] const std::array<float, 3>& at(int x, int y) const {
    return rgb[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(x)];
  }
};

/// Returns a description of the first invalid value (see Channel): "pixel (3, 4) of layer lamps.R
/// is nan". Returns nullopt if all values are valid.
[[nodiscard]] std::optional<std::string> FaultyValue(const Image& image);

/// Parameters and origin of an image: name and value, written into the file's header.
using Metadata = std::map<std::string, std::string>;

/// Projection of an image: the view of a camera, or the whole sphere by longitude and latitude
/// (OpenEXR's attribute envmap = latlong).
enum class Projection { kCamera, kLatitudeLongitude };

/// Writes float RGB and the layers, ZIP, atomically, with the metadata as text attributes and
/// whiteLuminance 1 (the unit is cd/m^2). Throws OutputError. If there is a FaultyValue, throws
/// InternalError naming file, pixel and layer before it writes anything.
void WriteExr(const std::filesystem::path& file, const Image& image, const Metadata& metadata,
              Projection projection = Projection::kCamera);
/// Reads an EXR file as written by WriteExr (any scan-line EXR with R, G, B); every other channel
/// becomes a layer. Throws InputError for a file that is missing, truncated, of another format, or
/// has no R, G or B.
[[nodiscard]] Image ReadExr(const std::filesystem::path& file);
/// Reads the text attributes of the header. Throws InputError.
[[nodiscard]] Metadata ReadExrMetadata(const std::filesystem::path& file);

/// Checks the headers of an EXR file before the library reads them: OpenEXR allocates the memory
/// that an attribute claims before it detects that the file is shorter, so two damaged bytes can
/// cost two gigabytes, and it allocates a table of all lines of the data window. Throws InputError
/// naming the file if an attribute extends beyond the end of the file, if a side of a data window
/// is longer than `longest_side`, or if a header is not terminated. Other errors are left to the
/// library.
///
/// Layout of the file, "OpenEXR File Layout" (openexr.com): magic number and version, 4 bytes each;
/// attributes: name and type, each ended by 0, size, 4 bytes, little-endian, value; a 0 ends a
/// header; in files of several parts headers follow each other, and another 0 ends them.
void RequireBoundedExrHeader(const std::filesystem::path& file,
                             std::int64_t longest_side = kLargestImageSide);

/// Returns the scale from luminance to exposed values for an exposure value at ISO 100. A luminance
/// of 2^EV100 * 1.2 cd/m^2 saturates (Lagarde, de Rousiers 2014).
[[nodiscard]] double ExposureScale(double ev100);

/// Constant K of reflected-light meters [cd s / (m^2 ISO)], ISO 2720: EV100 = log2(100 L / K).
inline constexpr double kMeterConstant = 12.5;

/// Range of the meter: from a moonless night to the sun's surroundings.
inline constexpr double kDarkestEv100 = -12.0;
inline constexpr double kBrightestEv100 = 20.0;

/// Luminance above which the exposure meter treats a pixel as part of the sun's disk [cd/m^2].
inline constexpr double kSunDiskLuminance_cd_per_m2 = 1e6;

/// Returns the EV100 of a histogram meter (metering.h): mean luminance between the 40th and 95th
/// percentile mapped to middle grey by K = 12.5, or more if the 95th percentile would exceed white
/// by day. Pixels brighter than `ignore_above_cd_per_m2` (the sun's disk), pixels without light,
/// and pixels that stay black beside the rest (space) do not count. Pixels of a panorama are
/// weighted by their solid angle. The result lies within [kDarkestEv100, kBrightestEv100], the
/// limits of the camera: a night of stars by f/1.4 for 30 s at ISO 25600, and sunlit snow eight
/// times over. Without light it is kDarkestEv100.
[[nodiscard]] double MeterEv100(const Image& image, double ignore_above_cd_per_m2,
                                Projection projection = Projection::kCamera);

enum class ToneCurve { kAgx, kAces, kReinhard, kPbrNeutral, kLinear };

/// 8-bit sRGB of the exposed image, dithered by triangular blue noise of +-1 code (development.h;
/// identical in every run). For out-of-gamut colours see tone_curve.glsl.
struct DisplayImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
};
/// Exposes, tone-maps and dithers an image. Throws InternalError for a pixel that is not finite.
[[nodiscard]] DisplayImage Develop(const Image& image, double ev100, ToneCurve curve);

/// Writes 8-bit RGB with an sRGB chunk and the metadata as text chunks, atomically. Throws
/// OutputError.
void WritePng(const std::filesystem::path& file, const DisplayImage& image,
              const Metadata& metadata);
/// Reads a PNG. Throws InputError for a file that is missing, truncated or not a PNG.
[[nodiscard]] DisplayImage ReadPng(const std::filesystem::path& file);
/// Reads the text chunks before the pixels. Throws InputError.
[[nodiscard]] Metadata ReadPngMetadata(const std::filesystem::path& file);

enum class StokesLayer {
  kQ,             // stokes_q.R, .G, .B: linear sRGB [cd/m^2], of either sign
  kU,             // stokes_u.R, .G, .B
  kPolarisation,  // polarisation.degree and .angle, of luminance: DegreeAndAngle
};

/// Converts between a layer and its name: "stokes_q", "stokes_u", "polarisation". Throws InputError
/// for another name.
[[nodiscard]] std::string NameOf(StokesLayer layer);
[[nodiscard]] StokesLayer StokesLayerFromName(const std::string& name);
/// Returns the names of the layer's channels in the EXR file.
[[nodiscard]] std::vector<std::string> ChannelsOf(StokesLayer layer);

/// Returns the degree of linear polarisation in [0, 1], and the direction of vibration [degrees]
/// clockwise from the image's vertical, in [-90, 90]; both 0 without light.
/// @param luminance, q, u  in one unit.
[[nodiscard]] std::array<float, 2> DegreeAndAngle(double luminance, double q, double u);

}  // namespace alpenglow::lut
