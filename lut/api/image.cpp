// SPDX-License-Identifier: MIT
#include <alpenglow/image.h>

#include <alpenglow/errors.h>
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "lut/image/development.h"
#include "lut/image/exr.h"
#include "lut/image/image.h"
#include "lut/image/look.h"
#include "lut/image/metering.h"
#include "lut/image/png.h"

namespace alpenglow {

using atmosphere::kPi;

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

/// An image as it is seen before it is exposed, and what exposes it.
struct Metered {
  HdrImage seen;
  lut::ExposureRule rule;
  lut::Look look;
  double ev100;
};

double IlluminanceOf(const DisplayOptions& options) {
  if (!options.illuminance_lx)
    throw InputError("exposure is \"incident\", which needs illuminance_lx");
  return atmosphere::RequireInRange(*options.illuminance_lx, 0.0,
                                    std::numeric_limits<double>::max(), "illuminance_lx");
}

Metered MeteredBy(const HdrImage& image, const DisplayOptions& options) {
  const lut::ExposureRule rule = lut::RuleOf(options);
  lut::Look look = lut::LookOf(options);
  RequireValid(image);
  const lut::PictureView view{ProjectionOf(image),
                              image.is_panorama ? 2.0 * kPi / image.width : 0.0};
  look = lut::Settled(look, image, view);
  Metered metered{lut::Seen(image, look, view), rule, look, 0.0};
  metered.ev100 = rule.kind == lut::ExposureRule::Kind::kIncident
                      ? lut::IncidentEv100(IlluminanceOf(options))
                      : lut::Ev100By(rule,
                                     lut::MeterEv100(metered.seen, lut::kSunDiskLuminance_cd_per_m2,
                                                     view.projection),
                                     look);
  return metered;
}

lut::DisplayImage Developed(const Metered& metered) {
  return lut::Develop(metered.seen, metered.ev100, metered.look);
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

double ExposureValue(const HdrImage& image, const DisplayOptions& options) {
  return MeteredBy(image, options).ev100;
}

std::vector<std::uint8_t> ForDisplay(const HdrImage& image, const DisplayOptions& options) {
  return Developed(MeteredBy(image, options)).rgb;
}

void WritePng(const std::filesystem::path& file, const HdrImage& image,
              const DisplayOptions& options) {
  const Metered metered = MeteredBy(image, options);
  Metadata metadata = lut::HeaderOfExposure(metered.rule, metered.ev100, RuleInWords(metered.rule));
  metadata.merge(lut::HeaderOfLook(metered.look));
  metadata.merge(CheckedMetadata(image));
  lut::WritePng(file, Developed(metered), metadata);
}

}  // namespace alpenglow
