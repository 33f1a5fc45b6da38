// SPDX-License-Identifier: MIT
#include "renderer/surface/drape_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <string_view>

#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"
#include "renderer/layer.h"
#include "renderer/material/land_cover.h"

namespace alpenglow::renderer {
namespace {

using Pixel = std::array<std::uint16_t, 4>;

constexpr std::int64_t kMostPixels = std::int64_t{1} << 26;
constexpr const char* kDrapeDrivers[] = {"GTiff", "PNG", nullptr};
constexpr RasterFormats kDrapeFormats{"GeoTIFF or PNG", kDrapeDrivers, "pictures on terrain"};

enum class BandRole { kUndeclared, kRed, kGreen, kBlue, kGrey, kAlpha, kPalette, kOther };

struct RoleName {
  std::string_view description;  // of a band, in lower case
  BandRole role;
};
constexpr RoleName kDescriptions[] = {
    {"red", BandRole::kRed},        {"r", BandRole::kRed},
    {"green", BandRole::kGreen},    {"g", BandRole::kGreen},
    {"blue", BandRole::kBlue},      {"b", BandRole::kBlue},
    {"grey", BandRole::kGrey},      {"gray", BandRole::kGrey},
    {"alpha", BandRole::kAlpha},    {"nir", BandRole::kOther},
    {"swir", BandRole::kOther},     {"near infrared", BandRole::kOther},
    {"infrared", BandRole::kOther}, {"near-infrared", BandRole::kOther},
    {"coastal", BandRole::kOther},  {"yellow", BandRole::kOther},
    {"rededge", BandRole::kOther},  {"red edge", BandRole::kOther},
    {"pan", BandRole::kOther}};

BandRole RoleByDescription(GDALRasterBand& band, BandRole otherwise) {
  const std::string description = LowerCase(Trimmed(band.GetDescription()));
  for (const RoleName& known : kDescriptions) {
    if (description == known.description) return known.role;
  }
  return otherwise;
}

BandRole RoleOf(GDALRasterBand& band) {
  switch (band.GetColorInterpretation()) {
    case GCI_RedBand:
      return BandRole::kRed;
    case GCI_GreenBand:
      return BandRole::kGreen;
    case GCI_BlueBand:
      return BandRole::kBlue;
    case GCI_AlphaBand:
      return BandRole::kAlpha;
    case GCI_PaletteIndex:
      return BandRole::kPalette;
    case GCI_GrayIndex:  // GDAL also says so of the first of several bands without declaration
      return RoleByDescription(band, BandRole::kGrey);
    case GCI_Undefined:
      return RoleByDescription(band, BandRole::kUndeclared);
    default:
      return BandRole::kOther;
  }
}

/// The bands of a picture.
struct ColourBands {
  std::array<GDALRasterBand*, 3> rgb{};  // all the same for grey and for palettes
  GDALRasterBand* alpha = nullptr;       // null: none
};

/// Sorts the bands of a file by their roles.
class BandSorter {
 public:
  BandSorter(const std::filesystem::path& file, GDALDataset& dataset) : file_(file) {
    for (int number = 1; number <= dataset.GetRasterCount(); ++number) {
      GDALRasterBand* band = dataset.GetRasterBand(number);
      with_role_[RoleOf(*band)].push_back(band);
      const bool is_plain =
          RoleOf(*band) == BandRole::kUndeclared || RoleOf(*band) == BandRole::kGrey;
      if (is_plain) plain_.push_back(band);
      names_.push_back(NameOf(*band));
    }
  }

  [[nodiscard]] ColourBands Sorted() const {
    ColourBands bands;
    if (Count(BandRole::kAlpha) > 1) Refuse("two bands as alpha");
    if (Count(BandRole::kAlpha) == 1) bands.alpha = with_role_.at(BandRole::kAlpha).front();
    bands.rgb = Colours();
    return bands;
  }

 private:
  [[nodiscard]] std::size_t Count(BandRole role) const {
    const auto found = with_role_.find(role);
    return found == with_role_.end() ? 0 : found->second.size();
  }
  [[nodiscard]] static std::string NameOf(GDALRasterBand& band) {
    const std::string description(Trimmed(band.GetDescription()));
    const char* declared = GDALGetColorInterpretationName(band.GetColorInterpretation());
    return description.empty() ? declared : fmt::format("{} ({})", declared, description);
  }
  [[noreturn]] void Refuse(const char* what) const {
    RefuseFile(file_, fmt::format("declares {} (its bands are {}); red, green and blue, grey or a "
                                  "palette are read",
                                  what, fmt::join(names_, ", ")));
  }

  [[nodiscard]] std::array<GDALRasterBand*, 3> Colours() const {
    std::array<GDALRasterBand*, 3> rgb{};
    std::size_t found = 0;
    for (const BandRole role : {BandRole::kRed, BandRole::kGreen, BandRole::kBlue}) {
      if (Count(role) > 1) Refuse("one colour for two bands");
      if (Count(role) == 1) rgb[found++] = with_role_.at(role).front();
    }
    if (found == 3) return rgb;
    if (found > 0) Refuse("not each of red, green and blue");
    if (Count(BandRole::kOther) > 0) Refuse("bands of other quantities");
    if (plain_.empty() && Count(BandRole::kPalette) == 1) {
      rgb.fill(with_role_.at(BandRole::kPalette).front());
    } else if (plain_.size() == 1) {
      rgb.fill(plain_.front());
    } else if (plain_.size() >= 3) {
      std::copy_n(plain_.begin(), 3, rgb.begin());
    } else {
      Refuse("no colours");
    }
    return rgb;
  }

  const std::filesystem::path& file_;
  std::map<BandRole, std::vector<GDALRasterBand*>> with_role_;
  std::vector<GDALRasterBand*> plain_;  // grey, or without declaration
  std::vector<std::string> names_;
};

// sRGB decoding, IEC 61966-2-1.
double Linear(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

bool IsFloat(GDALDataType type) { return type == GDT_Float32 || type == GDT_Float64; }

/// Returns the largest code of a band of unsigned integers of 8 or 16 bits, or of as many bits as
/// its file declares; empty for another type.
std::optional<double> LargestCode(GDALRasterBand& band) {
  const GDALDataType type = band.GetRasterDataType();
  const char* sign = band.GetMetadataItem("PIXELTYPE", "IMAGE_STRUCTURE");
  if ((type != GDT_Byte && type != GDT_UInt16) || sign != nullptr) return std::nullopt;
  const char* declared = band.GetMetadataItem("NBITS", "IMAGE_STRUCTURE");
  const int bits = declared == nullptr ? 0 : ParseWholeNumber(declared).value_or(0);
  return std::exp2(bits > 0 ? bits : type == GDT_Byte ? 8 : 16) - 1.0;
}

/// Decodes stored samples of a band to linear values; NaN where a sample has no colour. A code that
/// is the nodata value may be one of another colour: Opacity decides by all bands.
class ColourDecoder {
 public:
  /// @param channel  0 to 2, for palettes.
  ColourDecoder(const std::filesystem::path& file, GDALRasterBand& band, std::size_t channel)
      : band_(band), values_(file, band) {
    if (band.GetColorInterpretation() == GCI_PaletteIndex) {
      table_ = TableOfPalette(file, band, channel);
    } else if (!values_.HasScale() && !IsFloat(band.GetRasterDataType())) {
      table_ = TableOfCodes(file, band);
    }
  }

  [[nodiscard]] std::vector<double> Row(const std::filesystem::path& file, int y) const {
    std::optional<std::vector<double>> row = values_.Read({0, y, band_.GetXSize(), 1});
    if (!row) RefuseFile(file, fmt::format("damaged ({})", LastGdalError()));
    for (double& sample : *row) sample = Decoded(sample);
    return std::move(*row);
  }

 private:
  static constexpr double kNoColour = std::numeric_limits<double>::quiet_NaN();

  [[nodiscard]] double Decoded(double stored) const {
    if (table_.empty()) return values_.IsNodata(stored) ? kNoColour : values_.Value(stored);
    return stored < static_cast<double>(table_.size()) ? table_[static_cast<std::size_t>(stored)]
                                                       : kNoColour;
  }

  static std::vector<double> TableOfCodes(const std::filesystem::path& file, GDALRasterBand& band) {
    const std::optional<double> largest = LargestCode(band);
    if (!largest) {
      RefuseFile(file, fmt::format("has numbers of type {} and declares no scale; colours are "
                                   "unsigned integers of 8 or 16 bits, or floats",
                                   GDALGetDataTypeName(band.GetRasterDataType())));
    }
    const char* white = band.GetDataset()->GetMetadataItem("MINISWHITE", "IMAGE_STRUCTURE");
    std::vector<double> table;
    for (double code = 0.0; code <= *largest; code += 1.0)
      table.push_back(Linear((white != nullptr ? *largest - code : code) / *largest));
    return table;
  }

  static std::vector<double> TableOfPalette(const std::filesystem::path& file, GDALRasterBand& band,
                                            std::size_t channel) {
    const GDALColorTable* palette = band.GetColorTable();
    if (palette == nullptr || palette->GetPaletteInterpretation() != GPI_RGB)
      RefuseFile(file, "has a palette of other colours than red, green and blue");
    std::vector<double> table;
    for (int code = 0; code < palette->GetColorEntryCount(); ++code) {
      const GDALColorEntry& entry = *palette->GetColorEntry(code);
      const std::array<short, 3> rgb{entry.c1, entry.c2, entry.c3};
      table.push_back(Linear(rgb[channel] / 255.0));
    }
    return table;
  }

  GDALRasterBand& band_;
  BandValues values_;
  std::vector<double> table_;  // of codes; empty: the values are linear
};

// Reads a row of a band, converted to the type of `row`'s elements.
template <typename Value>
void ReadRow(const std::filesystem::path& file, GDALRasterBand& band, GDALDataType type, int y,
             std::vector<Value>& row) {
  const int columns = band.GetXSize();
  if (band.RasterIO(GF_Read, 0, y, columns, 1, row.data(), columns, 1, type, 0, 0) != CE_None)
    RefuseFile(file, fmt::format("damaged ({})", LastGdalError()));
}

/// The opacity of pixels, from the mask or nodata values of the colours and from the alpha band.
class Opacity {
 public:
  Opacity(const std::filesystem::path& file, const ColourBands& bands)
      : file_(file), alpha_(bands.alpha), row_(static_cast<std::size_t>(bands.rgb[0]->GetXSize())) {
    const bool has_masks = std::none_of(bands.rgb.begin(), bands.rgb.end(), [](auto* band) {
      return (band->GetMaskFlags() & (GMF_ALL_VALID | GMF_ALPHA)) != 0;
    });
    for (GDALRasterBand* band : bands.rgb) {
      if (has_masks) masks_.push_back(band->GetMaskBand());
    }
    if (alpha_ != nullptr) largest_alpha_ = LargestCode(*alpha_).value_or(1.0);
    const GDALColorTable* palette = bands.rgb[0]->GetColorTable();
    if (bands.rgb[0]->GetColorInterpretation() != GCI_PaletteIndex || palette == nullptr) return;
    palette_ = bands.rgb[0];
    for (int code = 0; code < palette->GetColorEntryCount(); ++code)
      weights_of_entries_.push_back(palette->GetColorEntry(code)->c4 / 255.0);
  }

  /// Returns the weights of a row, in [0, 1]. A pixel is transparent where every band has its
  /// nodata value.
  [[nodiscard]] std::vector<double> Row(int y) {
    std::vector<double> weights(row_.size(), masks_.empty() ? 1.0 : 0.0);
    for (GDALRasterBand* mask : masks_) {
      ReadRow(file_, *mask, GDT_Float64, y, row_);
      for (std::size_t x = 0; x < row_.size(); ++x)
        weights[x] = std::max(weights[x], std::clamp(row_[x] / 255.0, 0.0, 1.0));
    }
    if (palette_ != nullptr) WeighEntries(y, weights);
    if (alpha_ == nullptr) return weights;
    ReadRow(file_, *alpha_, GDT_Float64, y, row_);
    for (std::size_t x = 0; x < row_.size(); ++x) {
      const double opacity = row_[x] / largest_alpha_;
      weights[x] *= opacity > 0.0 ? std::min(opacity, 1.0) : 0.0;  // written so that NaN is 0
    }
    return weights;
  }

 private:
  // A code without an entry has no colour, whatever its weight is.
  void WeighEntries(int y, std::vector<double>& weights) {
    ReadRow(file_, *palette_, GDT_Float64, y, row_);
    for (std::size_t x = 0; x < row_.size(); ++x) {
      const auto code = static_cast<std::size_t>(row_[x]);
      if (code < weights_of_entries_.size()) weights[x] *= weights_of_entries_[code];
    }
  }

  const std::filesystem::path& file_;
  GDALRasterBand* alpha_;
  GDALRasterBand* palette_ = nullptr;  // null: none
  std::vector<double> weights_of_entries_;
  std::vector<GDALRasterBand*> masks_;
  std::vector<double> row_;
  double largest_alpha_ = 1.0;
};

std::uint16_t Stored(double value) {
  return static_cast<std::uint16_t>(std::lround(65535.0 * std::clamp(value, 0.0, 1.0)));
}

/// The range of the values that were read.
struct ValueRange {
  double low = 0.0, high = 1.0;

  void Add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  [[nodiscard]] std::string Note(const std::filesystem::path& file) const {
    if (low >= 0.0 && high <= 1.0) return "";
    return fmt::format(
        "{}: its values reach {:g} where linear colours lie in [0, 1]; they are cut off there "
        "(declare scale and offset of its bands otherwise)",
        file.string(), high > 1.0 ? high : low);
  }
};

std::size_t PixelCount(GDALDataset& dataset) {
  return static_cast<std::size_t>(dataset.GetRasterXSize()) *
         static_cast<std::size_t>(dataset.GetRasterYSize());
}

Pixel SharesOfClass(const std::filesystem::path& file, std::uint8_t number) {
  const auto cover = CoverOfClass(number);
  if (!cover) RefuseFile(file, fmt::format("has {}, which is no class of land cover", number));
  Pixel stored{0, 0, 0, 65535};
  for (std::size_t k = 0; k < 3; ++k) stored[k] = Stored((*cover)[k]);
  return stored;
}

}  // namespace

RasterFile OpenDrape(const std::filesystem::path& file, bool is_land_cover) {
  static std::once_flag once;
  std::call_once(once, [] {
    GDALRegister_GTiff();
    GDALRegister_PNG();
  });
  RasterFile dataset = OpenRaster(file, kDrapeFormats);
  const int bands = dataset->GetRasterCount();
  if (bands < 1) RefuseFile(file, "has no bands");
  if (is_land_cover && (bands != 1 || dataset->GetRasterBand(1)->GetRasterDataType() != GDT_Byte)) {
    RefuseFile(file, "is no map of land cover, which has one band of 8 bits");
  }
  if (std::int64_t{dataset->GetRasterXSize()} * dataset->GetRasterYSize() > kMostPixels) {
    RefuseFile(file,
               fmt::format("has {} x {} pixels; at most {} can be held", dataset->GetRasterXSize(),
                           dataset->GetRasterYSize(), kMostPixels));
  }
  return dataset;
}

DrapePixels ReadColours(const std::filesystem::path& file, GDALDataset& dataset) {
  const ColourBands bands = BandSorter(file, dataset).Sorted();
  std::vector<ColourDecoder> decoders;
  for (std::size_t channel = 0; channel < 3; ++channel)
    decoders.emplace_back(file, *bands.rgb[channel], channel);
  Opacity opacity(file, bands);
  DrapePixels read;
  read.pixels.reserve(PixelCount(dataset));
  ValueRange range;
  for (int y = 0; y < dataset.GetRasterYSize(); ++y) {
    const std::vector<double> weights = opacity.Row(y);
    std::array<std::vector<double>, 3> rows;
    for (std::size_t channel = 0; channel < 3; ++channel)
      rows[channel] = decoders[channel].Row(file, y);
    for (std::size_t x = 0; x < weights.size(); ++x) {
      const bool has_colour = !std::isnan(rows[0][x] + rows[1][x] + rows[2][x]);
      const double weight = has_colour ? weights[x] : 0.0;
      Pixel& pixel = read.pixels.emplace_back();
      if (weight == 0.0) continue;
      pixel[3] = Stored(weight);
      for (std::size_t channel = 0; channel < 3; ++channel) {
        range.Add(rows[channel][x]);
        pixel[channel] = Stored(weight * std::clamp(rows[channel][x], 0.0, 1.0));
      }
    }
  }
  read.note = range.Note(file);
  return read;
}

DrapePixels ReadLandCover(const std::filesystem::path& file, GDALDataset& dataset) {
  GDALRasterBand* band = dataset.GetRasterBand(1);
  Opacity opacity(file, {{band, band, band}, nullptr});
  DrapePixels read;
  read.pixels.reserve(PixelCount(dataset));
  std::vector<std::uint8_t> row(static_cast<std::size_t>(dataset.GetRasterXSize()));
  for (int y = 0; y < dataset.GetRasterYSize(); ++y) {
    ReadRow(file, *band, GDT_Byte, y, row);
    const std::vector<double> weights = opacity.Row(y);
    for (std::size_t x = 0; x < row.size(); ++x)
      read.pixels.push_back(weights[x] > 0.0 ? SharesOfClass(file, row[x]) : Pixel{});
  }
  return read;
}

}  // namespace alpenglow::renderer
