// SPDX-License-Identifier: MIT
/// @file
/// Images of physical light, their files, and their conversion for a display.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <alpenglow/export.h>

namespace ALPENGLOW_EXPORT alpenglow {

/// A plane of values beside the colours of an image, row 0 at the top. Values of "depth.Z" and
/// "clouds.Z" are distances [m], infinite where a ray meets nothing; all other values are finite.
struct ImageLayer {
  std::string name;           ///< channel in the EXR file, such as "depth.Z"
  std::vector<float> values;  ///< width * height values
};

/// Parameters and origin of an image by name, stored as attributes of its file.
using Metadata = std::map<std::string, std::string>;

/// An image in linear sRGB [cd/m^2]. Colours are not clamped: values outside of the gamut are
/// negative.
struct HdrImage {
  int width = 0;                          ///< pixels
  int height = 0;                         ///< pixels
  std::vector<std::array<float, 3>> rgb;  ///< width * height pixels, row 0 at the top
  std::vector<ImageLayer> layers;         ///< further planes of the same size
  bool is_panorama = false;               ///< longitude-latitude picture of the whole sphere
  Metadata metadata;                      ///< attributes of the file

  HdrImage() = default;
  /// Makes a black image. Throws InputError unless both sides lie in [1, 32768].
  HdrImage(int image_width, int image_height);

  /// Returns a pixel, which must lie in the image: this is not checked.
  [[nodiscard]] std::array<float, 3>& at(int x, int y) { return rgb[PixelAt(x, y)]; }
  /// Returns a pixel, which must lie in the image: this is not checked.
  [[nodiscard]] const std::array<float, 3>& at(int x, int y) const { return rgb[PixelAt(x, y)]; }

 private:
  [[nodiscard]] std::size_t PixelAt(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

/// Exposure and colours of an image for a display. The texts are those of the programs' options
/// --tone-map, --look, --white-balance and --exposure.
struct DisplayOptions {
  /// Exposure value at ISO 100, in [-30, 30]; by default that of `exposure`.
  std::optional<double> ev100 = {};
  /// "agx", "aces", "reinhard", "pbr-neutral", "linear", or "local" for local exposure and agx.
  std::string tone_map = "agx";
  /// Look of agx: "photo", "none", "punchy", "medium" or "high".
  std::string look = "photo";
  /// "camera", "daylight", "auto" or kelvins in [1500, 25000], such as "5600".
  std::string white_balance = "camera";
  /// "auto" meters the image, "eye" too but shows dusk and night darker than day, "incident" exposes
  /// for the light on a horizontal plane, and a number such as "14.5" is an exposure value.
  std::string exposure = "auto";
  /// Illuminance of a horizontal plane [lx], at least 0, which "incident" needs; see
  /// HorizontalIlluminance().
  std::optional<double> illuminance_lx = {};
  /// Show the colours that the dark-adapted eye sees, and panoramas with its acuity. Needs the layer
  /// "scotopic.Y", which the layer "scotopic" of a still writes.
  bool night_vision = false;
};

/// Writes float RGB and all layers as OpenEXR (ZIP), replacing the file atomically. Throws
/// OutputError if the file cannot be written. Throws InputError unless both sides lie in
/// [1, 32768], all planes have width * height finite values, and the layers have names of their own
/// other than R, G and B; and for metadata whose name is not 1 to 79 printable characters of ASCII
/// or that of another attribute of OpenEXR.
void WriteExr(const std::filesystem::path& file, const HdrImage& image);

/// Reads an OpenEXR file of scan lines with channels R, G and B; every other channel becomes a
/// layer. Throws InputError for a file that is missing, damaged or of another kind. Panoramas are
/// recognised by the attribute envmap of OpenEXR, which WriteExr() and the programs write.
[[nodiscard]] HdrImage ReadExr(const std::filesystem::path& file);

/// Returns the exposure value at ISO 100 with which ForDisplay() shows an image. Throws InputError
/// as ForDisplay() does.
[[nodiscard]] double ExposureValue(const HdrImage& image, const DisplayOptions& options = {});

/// Returns 8-bit sRGB, three values per pixel: exposed, tone-mapped and dithered. The result is the
/// same in every run. Throws InputError for an unknown name, a value out of range, an exposure
/// "incident" without illuminance, and for pixels that are not finite.
[[nodiscard]] std::vector<std::uint8_t> ForDisplay(const HdrImage& image,
                                                   const DisplayOptions& options = {});

/// Writes ForDisplay() as PNG, with the metadata of the image and those of the exposure and the
/// colours, replacing the file atomically. Throws InputError as ForDisplay() does, and OutputError if
/// the file cannot be written.
void WritePng(const std::filesystem::path& file, const HdrImage& image,
              const DisplayOptions& options = {});

}  // namespace alpenglow
