// SPDX-License-Identifier: MIT
#include <alpenglow/image.h>

#include <alpenglow/errors.h>
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "atmosphere/base/error.h"
#include "lut/image/development.h"
#include "lut/image/exr.h"
#include "lut/image/image.h"
#include "lut/image/look.h"
#include "lut/image/metering.h"
#include "lut/image/png.h"
#include "lut/image/white_balance.h"

namespace alpenglow {
namespace {

constexpr std::size_t kLongestChannel = 255;   // of OpenEXR
constexpr std::size_t kLongestAttribute = 79;  // of PNG

lut::Projection ProjectionOf(const HdrImage& image) {
  return image.is_panorama ? lut::Projection::kLatitudeLongitude : lut::Projection::kCamera;
}

/// Throws InputError for a wrong number of values and for values that no file stores.
void RequireValid(const HdrImage& image) {
  atmosphere::RequireInRange(image.width, 1, lut::kLargestImageSide, "width");
  atmosphere::RequireInRange(image.height, 1, lut::kLargestImageSide, "height");
  const std::size_t pixels =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (image.rgb.size() != pixels) {
    throw InputError(fmt::format("rgb has {} pixels; it must have {} times {}", image.rgb.size(),
                                 image.width, image.height));
  }
  std::set<std::string> names{"R", "G", "B"};
  for (const ImageLayer& layer : image.layers) {
    if (layer.name.empty() || layer.name.size() > kLongestChannel ||
        layer.values.size() != pixels) {
      throw InputError(fmt::format(
          "the layer \"{}\" has {} values; it must have {}, and a name of 1 to {} bytes",
          layer.name, layer.values.size(), pixels, kLongestChannel));
    }
    if (!names.insert(layer.name).second)
      throw InputError(fmt::format("the layer \"{}\" is there twice", layer.name));
  }
  if (const auto fault = lut::FaultyValue(image)) throw InputError(*fault);
}

/// Returns the attributes of a file. Throws InputError for names that EXR or PNG cannot store.
Metadata CheckedMetadata(const HdrImage& image) {
  for (const auto& [name, value] : image.metadata) {
    const bool is_printable =
        std::all_of(name.begin(), name.end(), [](char c) { return c > ' ' && c <= '~'; });
    if (name.empty() || name.size() > kLongestAttribute || !is_printable) {
      throw InputError(fmt::format(
          "metadata has the name \"{}\"; it must have 1 to {} letters, digits or signs of ASCII",
          name, kLongestAttribute));
    }
    if (value.find('\0') != std::string::npos)
      throw InputError(fmt::format("metadata {} contains a byte 0", name));
  }
  return image.metadata;
}

struct Developed {
  lut::DisplayImage display;
  double ev100;
  lut::Look look;
};

Developed DevelopedBy(const HdrImage& image, const DisplayOptions& options) {
  const lut::ExposureRule rule =
      options.ev100
          ? lut::ExposureRule{lut::ExposureRule::Kind::kFixed,
                              atmosphere::RequireInRange(*options.ev100, -30.0, 30.0, "ev100")}
          : lut::ExposureRule{};
  lut::Look look = lut::LookFromName(options.tone_map);
  look.agx = lut::AgxLookFromName(options.look);
  look.white = lut::WhiteBalanceFromText(options.white_balance);
  const lut::PictureView view{ProjectionOf(image)};
  RequireValid(image);
  look = lut::Settled(lut::LookUnder(rule, look), image, view);
  const HdrImage seen = lut::Seen(image, look, view);
  const double ev100 = lut::Ev100By(
      rule, lut::MeterEv100(seen, lut::kSunDiskLuminance_cd_per_m2, view.projection), look);
  return {lut::Develop(seen, ev100, look), ev100, look};
}

}  // namespace

HdrImage::HdrImage(int image_width, int image_height) : width(image_width), height(image_height) {
  atmosphere::RequireInRange(image_width, 1, lut::kLargestImageSide, "image width");
  atmosphere::RequireInRange(image_height, 1, lut::kLargestImageSide, "image height");
  rgb.resize(static_cast<std::size_t>(image_width) * static_cast<std::size_t>(image_height));
}

void WriteExr(const std::filesystem::path& file, const HdrImage& image) {
  RequireValid(image);
  lut::WriteExr(file, image, CheckedMetadata(image), ProjectionOf(image));
}

HdrImage ReadExr(const std::filesystem::path& file) { return lut::ReadExrPicture(file); }

std::vector<std::uint8_t> ForDisplay(const HdrImage& image, const DisplayOptions& options) {
  return DevelopedBy(image, options).display.rgb;
}

void WritePng(const std::filesystem::path& file, const HdrImage& image,
              const DisplayOptions& options) {
  Metadata metadata = CheckedMetadata(image);
  const Developed developed = DevelopedBy(image, options);
  metadata["alpenglow.ev100"] = fmt::format("{:.6f}", developed.ev100);
  metadata["alpenglow.tone_curve"] = lut::NameOf(developed.look);
  metadata["alpenglow.white_balance"] = lut::NameOf(developed.look.white);
  lut::WritePng(file, developed.display, metadata);
}

}  // namespace alpenglow
