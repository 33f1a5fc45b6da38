// SPDX-License-Identifier: MIT
// Pictures: linear in memory, EXR (linear, with metadata) and PNG (exposed, tone-mapped, dithered).
//
// Layers of pictures and panoramas that say how their light is polarised.
//
// Q is what vibrates along the picture's vertical more than across it, U what vibrates from the
// lower left to the upper right more than across that.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace alpenglow::lut {

/// Pixels along one side of a picture, at most.
inline constexpr int kLargestImageSide = 32768;

/// Name of the channel of distances, OpenEXR's depth channel Z in a layer.
inline constexpr const char* kDepthChannel = "depth.Z";

/// A plane of floats, row 0 at the top. Values of kDepthChannel are not negative, and infinite
/// where a ray meets nothing; those of all other channels are finite.
struct Channel {
  std::string name;  // as in the EXR file: "R", "depth.Z", ...
  std::vector<float> values;
};

/// Linear sRGB [cd/m^2] and, optionally, more layers of the same size.
///
/// Colours are not clamped: one that is more saturated than the display's gamut has a negative
/// channel and keeps its luminance. The red of a low sun has negative blue; the blue that ozone
/// leaves of deep twilight has negative red (100 km up, sun at -15 degrees: a hundredth of the
/// blue, and on 16 bands more often than on 4). Tone curves bring them back (tone_curve.glsl).
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::array<float, 3>> rgb;
  std::vector<Channel> layers;

  Image() = default;
  /// Black. Throws InputError unless both sides are in [1, kLargestImageSide].
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

/// The first value that cannot be (see Channel), in words: "pixel (3, 4) of layer lamps.R is nan".
/// Nothing where all are as they should be.
[[nodiscard]] std::optional<std::string> FaultyValue(const Image& image);

/// What made a picture: name and value, written into the file's header.
using Metadata = std::map<std::string, std::string>;

/// What the pixels of a picture are: seen through a camera, or the whole sphere by longitude and
/// latitude (OpenEXR's attribute envmap = latlong).
enum class Projection { kCamera, kLatitudeLongitude };

/// Writes float RGB and the layers, ZIP, atomically, with the metadata as text attributes and
/// whiteLuminance 1 (the unit is cd/m^2). Throws OutputError; InternalError naming file, pixel and
/// layer for a FaultyValue, before anything is written.
void WriteExr(const std::filesystem::path& file, const Image& image, const Metadata& metadata,
              Projection projection = Projection::kCamera);
/// Reads what WriteExr wrote (any scan-line EXR with R, G, B); every other channel becomes a layer.
/// Throws InputError for a file that is missing, truncated, foreign, or has no R, G or B.
[[nodiscard]] Image ReadExr(const std::filesystem::path& file);
/// The text attributes of the header. Throws InputError.
[[nodiscard]] Metadata ReadExrMetadata(const std::filesystem::path& file);

/// Exposure value at ISO 100. A luminance of 2^EV100 * 1.2
/// cd/m^2 saturates (Lagarde, de Rousiers 2014).
[[nodiscard]] double ExposureScale(double ev100);

/// K of reflected-light meters [cd s / (m^2 ISO)], ISO 2720: EV100 = log2(100 L / K).
inline constexpr double kMeterConstant = 12.5;

/// The range of the meter: from a moonless night to the sun's surroundings.
inline constexpr double kDarkestEv100 = -12.0;
inline constexpr double kBrightestEv100 = 20.0;

/// Luminance over which the exposure meter takes a pixel for the sun's disk [cd/m^2].
inline constexpr double kSunDiskLuminance_cd_per_m2 = 1e6;

/// EV100 that a histogram meter picks (metering.h): mean log luminance between the 40th and 95th
/// percentile mapped to middle grey by K = 12.5, or more where the latter would be over white by day.
/// Pixels brighter than `ignore_above_cd_per_m2` (the sun's disk), those without light, and those
/// that stay black beside the rest (space) do not count; those of a panorama weigh as their solid
/// angle. Within [kDarkestEv100, kBrightestEv100], the limits of the camera: a night of stars by f/1.4
/// for 30 s at ISO 25600, and sunlit snow eight times over. Without light kDarkestEv100.
[[nodiscard]] double MeterEv100(const Image& image, double ignore_above_cd_per_m2,
                                Projection projection = Projection::kCamera);

enum class ToneCurve { kAgx, kAces, kReinhard, kPbrNeutral, kLinear };

/// 8-bit sRGB of the exposed picture, dithered by triangular blue noise of +-1 code (develop.h; the
/// same for every run). Out-of-gamut colours: see tone_curve.glsl.
struct DisplayImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
};
/// Throws InternalError for a pixel that is not finite.
[[nodiscard]] DisplayImage Develop(const Image& image, double ev100, ToneCurve curve);

/// Writes 8-bit RGB with an sRGB chunk and the metadata
/// as text chunks, atomically. Throws OutputError.
void WritePng(const std::filesystem::path& file, const DisplayImage& image,
              const Metadata& metadata);
/// Throws InputError for a file that is missing, truncated or no PNG.
[[nodiscard]] DisplayImage ReadPng(const std::filesystem::path& file);
/// The text chunks before the pixels. Throws InputError.
[[nodiscard]] Metadata ReadPngMetadata(const std::filesystem::path& file);

enum class StokesLayer {
  kQ,             // stokes_q.R, .G, .B: linear sRGB [cd/m^2], of either sign
  kU,             // stokes_u.R, .G, .B
  kPolarisation,  // polarisation.degree and .angle, of luminance: DegreeAndAngle
};
inline constexpr std::array<StokesLayer, 3> kStokesLayers{StokesLayer::kQ, StokesLayer::kU,
                                                          StokesLayer::kPolarisation};

/// "stokes_q", "stokes_u", "polarisation"; throws InputError for another name.
[[nodiscard]] std::string NameOf(StokesLayer layer);
[[nodiscard]] StokesLayer StokesLayerFromName(const std::string& name);
/// Names of its channels, as in the EXR file.
[[nodiscard]] std::vector<std::string> ChannelsOf(StokesLayer layer);

/// Degree of linear polarisation in [0, 1], and the direction of vibration [degrees] clockwise from
/// the picture's vertical, in [-90, 90]; both 0 without light.
/// @param luminance, q, u  in one unit.
[[nodiscard]] std::array<float, 2> DegreeAndAngle(double luminance, double q, double u);

}  // namespace alpenglow::lut
