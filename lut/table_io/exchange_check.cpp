// SPDX-License-Identifier: MIT
#include "lut/table_io/exchange_check.h"

#include <fmt/format.h>
#include <half.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <optional>

#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/atmosphere_file.h"
#include "atmosphere/medium/phase_text.h"
#include "lut/table_io/table_image.h"
#include "lut/tables/transmittance_table.h"

namespace alpenglow::lut {
namespace {

namespace fs = std::filesystem;
using Rgba = std::array<double, 4>;

constexpr double kLargestMedian = 0.05;      // relative difference from the texels of this program
constexpr std::size_t kCheckedTexels = 600;  // per scattering texture

std::optional<TexelFormat> FormatOfFolder(const fs::path& folder) {
  for (const TexelFormat format : {TexelFormat::kExr, TexelFormat::kBin, TexelFormat::kDat}) {
    std::error_code error;
    if (fs::exists(folder / ("scattering" + SuffixOf(format)), error)) return format;
  }
  return std::nullopt;
}

/// Returns layout and format. The only .exr files of Bruneton's layout are written by this program,
/// because the demo reads none; they state their layout.
ExportOptions OptionsOf(const fs::path& folder) {
  const std::optional<TexelFormat> format = FormatOfFolder(folder);
  if (!format) RefuseFile(folder, "has no scattering.exr, .bin or .dat");
  ExportOptions options{.format = format};
  if (*format == TexelFormat::kDat) {
    options.user = TableUser::kBrunetonDemo;
    options.type = TexelType::kFloat;
  } else if (*format == TexelFormat::kBin) {
    options.type = TexelType::kHalf;
  } else {
    const TableImageReader image(folder / "scattering.exr");
    options.type = image.IsHalf() ? TexelType::kHalf : TexelType::kFloat;
    const bool bruneton = image.Has("alpenglow.layout") &&
                          image.Attribute("alpenglow.layout").starts_with("bruneton");
    if (bruneton) options.user = TableUser::kBrunetonDemo;
  }
  return options;
}

float LittleEndianValue(const char* bytes, TexelType type) {
  const auto byte = [&](unsigned i) {
    return std::uint32_t{static_cast<unsigned char>(bytes[i])} << (8U * i);
  };
  if (type == TexelType::kFloat) return std::bit_cast<float>(byte(0) | byte(1) | byte(2) | byte(3));
  half value;
  value.setBits(static_cast<unsigned short>(byte(0) | byte(1)));
  return value;
}

std::vector<float> RawTexels(const fs::path& file, std::size_t texels, TexelType type) {
  const std::size_t size = type == TexelType::kHalf ? 2 : 4;
  const std::uint64_t bytes = fs::file_size(file);
  if (bytes != 4 * size * texels) {
    RefuseFile(file, fmt::format("has {} bytes; such a table has {}", bytes, 4 * size * texels));
  }
  std::ifstream stream(file, std::ios::binary);
  std::string content(bytes, '\0');
  if (!stream.read(content.data(), static_cast<std::streamsize>(bytes)))
    RefuseFile(file, "cannot be read");
  std::vector<float> values(4 * texels);
  const char* bytes_of_value = content.data();
  for (float& value : values) {
    value = LittleEndianValue(bytes_of_value, type);
    bytes_of_value += size;
  }
  return values;
}

/// Returns RGBA texels. Loaders replace a missing alpha by 1; only the texture scattering needs its
/// alpha.
std::vector<float> RgbaOf(const TableImageReader& image, bool needs_alpha) {
  if (needs_alpha || image.HasChannel("A")) {
    return image.Values({"R", "G", "B", "A"}, TexelTypes::kFloatOrHalf);
  }
  const std::vector<float> rgb = image.Values({"R", "G", "B"}, TexelTypes::kFloatOrHalf);
  std::vector<float> rgba;
  rgba.reserve(rgb.size() / 3 * 4);
  for (std::size_t i = 0; i < rgb.size(); i += 3) {
    rgba.insert(rgba.end(), {rgb[i], rgb[i + 1], rgb[i + 2], 1.0F});
  }
  return rgba;
}

/// Returns the rows in the order of the textures; files of three-atmosphere have the last row on
/// top.
std::vector<float> ImageTexels(const fs::path& file, const TextureShape& shape, bool reversed) {
  const TableImageReader image(file);
  const std::size_t rows = shape.height * shape.depth;
  if (image.width() != shape.width || image.height() != rows) {
    RefuseFile(file, fmt::format("is {} x {} texels; it must be {} x {}", image.width(),
                                 image.height(), shape.width, rows));
  }
  std::vector<float> values = RgbaOf(image, std::string_view(shape.name) == "scattering");
  const auto row = static_cast<std::ptrdiff_t>(4 * shape.width);
  for (std::ptrdiff_t low = 0, high = static_cast<std::ptrdiff_t>(rows) - 1; reversed && low < high;
       ++low, --high) {
    std::swap_ranges(values.begin() + low * row, values.begin() + (low + 1) * row,
                     values.begin() + high * row);
  }
  return values;
}

std::vector<float> TexelsOf(const fs::path& file, const TextureShape& shape,
                            const ExportOptions& options) {
  std::error_code error;
  if (!fs::is_regular_file(file, error))
    RefuseFile(file, "is missing; the whole set is not loaded");
  if (options.format == TexelFormat::kExr) {
    return ImageTexels(file, shape, options.user == TableUser::kThreeAtmosphere);
  }
  return RawTexels(file, shape.width * shape.height * shape.depth, *options.type);
}

double Largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

/// Returns the upper bound of red, green and blue of a texel. Scattering is stored without its
/// phase function, whose mean is 1/(4 pi), so its bound is 4 pi times the largest radiance, which
/// is at most the irradiance of the sun.
double HighestOf(const TextureShape& shape, const Medium& medium) {
  if (std::string_view(shape.name) == kTransmittanceShape.name) return 1.0;
  const double sun = Largest(medium.solar_irradiance);
  return std::string_view(shape.name) == kIrradianceShape.name ? sun : 4.0 * kPi * sun;
}

std::array<ExchangeDescription::Channel, 4> ChannelRangesOf(const fs::path& file,
                                                            const std::vector<float>& texels,
                                                            double highest) {
  std::array<ExchangeDescription::Channel, 4> ranges{};
  for (std::size_t c = 0; c < 4; ++c) ranges[c] = {texels[c], texels[c]};
  for (std::size_t i = 0; i < texels.size(); ++i) {
    const double value = texels[i];
    // Alpha is used only in scattering, where it holds light like the other channels.
    if (!std::isfinite(value) || (i % 4 < 3 && !(value >= 0.0 && value <= highest))) {
      RefuseFile(file, fmt::format("channel {} of texel {} is {}; it must lie in [0, {}]",
                                   "RGBA"[i % 4], i / 4, value, highest));
    }
    ExchangeDescription::Channel& range = ranges[i % 4];
    range.lowest = std::min(range.lowest, texels[i]);
    range.highest = std::max(range.highest, texels[i]);
  }
  return ranges;
}

/// Collects pairs of a texel and the value that this program computes for it.
class Comparison {
 public:
  void Add(double value, double truth) { pairs_.push_back({value, truth}); }

  [[nodiscard]] ErrorStatistics Errors() const {
    double largest = 0.0;
    for (const auto& [value, truth] : pairs_) largest = std::max(largest, truth);
    std::vector<double> errors;
    for (const auto& [value, truth] : pairs_) {
      if (truth > 1e-3 * largest) errors.push_back(std::abs(value / truth - 1.0));
    }
    return ErrorStatistics(std::move(errors));
  }

 private:
  std::vector<std::pair<double, double>> pairs_;
};

template <typename Real>
Rgba TimesSun(const Medium& medium, const SpectrumOf<Real>& unit) {
  Rgba rgba{};
  for (std::size_t c = 0; c < 3; ++c) {
    rgba[c] = static_cast<double>(unit[2 - c]) * medium.solar_irradiance[2 - c];
  }
  return rgba;
}

/// A texel of the scattering textures with the light that this program computes for it, without
/// phase functions: scattered once, by molecules and by aerosol, and scattered more often.
struct CheckedTexel {
  std::size_t texel;
  Rgba molecules, aerosol, more;
};

/// Computes checked texels one by one.
class Reference {
 public:
  Reference(const Medium& medium, double lowest_mu_s)
      : medium_(medium), air_(medium), quick_air_(medium), map_(MapOf(medium, lowest_mu_s)) {}

  [[nodiscard]] CheckedTexel At(std::size_t texel, const MultipleScattering& light) const {
    const ViewRay ray = RayOf(texel);
    auto once = air_.Scatter(air_.Sample(ray, {.nodes = 24}));
    for (std::size_t band = 0; band < once.rayleigh.size(); ++band)
      once.rayleigh[band] *= PhaseOverThatOfLoaders(medium_, band, ray.nu);
    Rgba more = TimesSun(medium_, HigherOrdersAlong(quick_air_, light, ray));
    for (double& value : more) value /= shared::PhaseRayleigh<double>(ray.nu);
    return {texel, TimesSun(medium_, once.rayleigh), TimesSun(medium_, once.mie), more};
  }

 private:
  /// Returns a table that serves only for the positions of texels.
  static ScatteringTable MapOf(const Medium& medium, double lowest_mu_s) {
    const ScatteringTableSize& size = kExchangeScatteringSize;
    return {medium,
            {.size = size, .lowest_mu_s = lowest_mu_s},
            std::vector<float>(6 * size.nu * size.mu_s * size.mu * size.altitudes)};
  }
  [[nodiscard]] ViewRay RayOf(std::size_t texel) const {
    const ScatteringTableSize& size = kExchangeScatteringSize;
    const std::size_t row = texel / (size.nu * size.mu_s);
    return map_.RayOfTexel(texel / size.mu_s % size.nu, texel % size.mu_s, row % size.mu,
                           row / size.mu);
  }

  Medium medium_;
  SingleScattering<double> air_;
  SingleScattering<float> quick_air_;
  ScatteringTable map_;
};

/// Returns texels distributed over a scattering texture; every call returns those of one fixed set.
std::vector<CheckedTexel> CheckedTexels(const Medium& medium, double lowest_mu_s,
                                        const MultipleScattering& light) {
  const Reference reference(medium, lowest_mu_s);
  const ScatteringTableSize& size = kExchangeScatteringSize;
  const std::size_t all = size.nu * size.mu_s * size.mu * size.altitudes;
  std::vector<CheckedTexel> texels;
  // Multiples of the golden ratio are distributed most evenly (Weyl 1916, Math. Ann. 77, 313).
  for (std::size_t i = 0; i < kCheckedTexels; ++i) {
    const double x = static_cast<double>(i) * 0.6180339887498949;
    const double share = x - std::floor(x);
    texels.push_back(
        reference.At(static_cast<std::size_t>(share * static_cast<double>(all)), light));
  }
  return texels;
}

ErrorStatistics TransmittanceErrors(const std::vector<float>& texels, const Medium& medium) {
  const TransmittanceTable table(
      medium, {.mu = kTransmittanceShape.width, .altitudes = kTransmittanceShape.height});
  Comparison comparison;
  for (std::size_t i = 0; i < texels.size(); ++i) {
    if (i % 4 < 3) comparison.Add(texels[i], table.texels()[i / 4 * 3 + 2 - i % 4]);
  }
  return comparison.Errors();
}

ErrorStatistics IrradianceErrors(const std::vector<float>& texels, const MultipleScattering& light,
                                 const Medium& medium) {
  Comparison comparison;
  const auto unit = [](std::size_t i, std::size_t n) {
    return static_cast<double>(i) / static_cast<double>(n - 1);
  };
  for (std::size_t i = 0; i < texels.size() / 4; ++i) {
    const double h_m =
        medium.atmosphere_height_m * unit(i / kIrradianceShape.width, kIrradianceShape.height);
    const double mu_s = 2.0 * unit(i % kIrradianceShape.width, kIrradianceShape.width) - 1.0;
    const Rgba ours = TimesSun(medium, light.SkyIrradiance(h_m, mu_s));
    for (std::size_t c = 0; c < 3; ++c) comparison.Add(texels[4 * i + c], ours[c]);
  }
  return comparison.Errors();
}

/// Returns the errors of alpha in scattering, which holds the red light that aerosol scatters once.
ErrorStatistics AlphaErrors(const std::vector<float>& scattering,
                            const std::vector<CheckedTexel>& checked) {
  Comparison comparison;
  for (const CheckedTexel& ours : checked)
    comparison.Add(scattering[4 * ours.texel + 3], ours.aerosol[0]);
  return comparison.Errors();
}

ErrorStatistics ScatteringErrors(std::string_view name, const std::vector<float>& texels,
                                 const std::vector<CheckedTexel>& checked) {
  Comparison comparison;
  for (const auto& [texel, molecules, aerosol, more] : checked) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double truth = name == "scattering"                ? molecules[c] + more[c]
                           : name == "higher_order_scattering" ? more[c]
                                                               : aerosol[c];
      comparison.Add(texels[4 * texel + c], truth);
    }
  }
  return comparison.Errors();
}

/// The lowest sun with which the texels agree best, and this program's texels for it.
struct BestSun {
  double angle_deg = 0.0;
  std::vector<CheckedTexel> checked;
};

BestSun LowestSunIn(const std::vector<float>& scattering, const Medium& medium,
                    const MultipleScattering& light, const ExportOptions& options) {
  BestSun best;
  double least = std::numeric_limits<double>::infinity();
  for (const double angle_deg : {kDemoLowestSun_deg, kLowestSun_deg}) {
    ExportOptions tried = options;
    tried.lowest_sun_deg = angle_deg;
    std::vector<CheckedTexel> checked = CheckedTexels(medium, LowestSunOf(tried), light);
    const double median = ScatteringErrors("scattering", scattering, checked).Quantile(0.5);
    if (median >= least) continue;
    least = median;
    best = {angle_deg, std::move(checked)};
  }
  return best;
}

void RequireAgreement(const fs::path& file, const ErrorStatistics& errors, const Medium& medium) {
  if (!(errors.Quantile(0.5) > kLargestMedian)) return;
  RefuseFile(
      file, fmt::format("is not of the atmosphere {}: its texels differ from those of this program "
                        "by {:.2g} % in the median, and {:g} % are allowed",
                        medium.name, 100.0 * errors.Quantile(0.5), 100.0 * kLargestMedian));
}

fs::path FileOf(const fs::path& folder, const TextureShape& shape, const ExportOptions& options) {
  return folder / (std::string(shape.name) + SuffixOf(*options.format));
}

/// Returns whether three-atmosphere can be configured to work without the texture.
bool IsOptional(const TextureShape& shape) {
  const std::string_view name = shape.name;
  return name == "higher_order_scattering" || name == "single_mie_scattering";
}

/// A texture read from a file, with its ranges.
struct LoadedTexture {
  ExchangeDescription::Texture description;
  std::vector<float> texels;
};

LoadedTexture Load(const fs::path& folder, const TextureShape& shape, const ExportOptions& options,
                   const Medium& medium) {
  const fs::path file = FileOf(folder, shape, options);
  LoadedTexture loaded;
  loaded.texels = TexelsOf(file, shape, options);
  loaded.description.file = file;
  loaded.description.shape = shape;
  loaded.description.rgba = ChannelRangesOf(file, loaded.texels, HighestOf(shape, medium));
  return loaded;
}

ErrorStatistics ErrorsOf(const LoadedTexture& texture, const std::vector<CheckedTexel>& checked,
                         const MultipleScattering& light, const Medium& medium) {
  const std::string_view name = texture.description.shape.name;
  if (name == kTransmittanceShape.name) return TransmittanceErrors(texture.texels, medium);
  if (name == kIrradianceShape.name) return IrradianceErrors(texture.texels, light, medium);
  return ScatteringErrors(name, texture.texels, checked);
}

std::string LineOf(const ExchangeDescription::Texture& texture) {
  std::string text = fmt::format(
      "  {:<12}{}\n              {} x {} x {} texels; from ours {:.2g} % (median), {:.2g} % (9th "
      "decile), {:.2g} % (largest) of {}\n",
      "texture", texture.file.filename().string(), texture.shape.width, texture.shape.height,
      texture.shape.depth, 100.0 * texture.errors.Quantile(0.5),
      100.0 * texture.errors.Quantile(0.9), 100.0 * texture.errors.Largest(),
      texture.errors.count());
  for (std::size_t c = 0; c < 4; ++c) {
    text += fmt::format("  channel     {} {:.6g} to {:.6g}\n", "RGBA"[c], texture.rgba[c].lowest,
                        texture.rgba[c].highest);
  }
  return text;
}

}  // namespace

std::optional<fs::path> ExchangeFolderOf(const fs::path& file_or_folder) {
  if (FormatOfFolder(file_or_folder)) return file_or_folder;
  const std::optional<TexelFormat> format = FormatOfFolder(file_or_folder.parent_path());
  if (!format || !HasExtension(file_or_folder, SuffixOf(*format))) return std::nullopt;
  for (const TextureShape& shape : ShapesOf(TableUser::kThreeAtmosphere)) {
    if (file_or_folder.stem() == shape.name) return file_or_folder.parent_path();
  }
  return std::nullopt;
}

ExchangeDescription DescribeExchangeTables(const fs::path& folder) {
  ExchangeDescription description;
  description.options = OptionsOf(folder);
  std::error_code error;
  description.medium_is_assumed = !fs::exists(folder / kMediumFileName, error);
  description.medium = description.medium_is_assumed ? MediumPreset("bruneton2017")
                                                     : ReadMedium(folder / kMediumFileName);
  if (IsTheMediumThatLoadersAssume(description.medium)) description.medium.name = "bruneton2017";
  const Medium& medium = description.medium;
  RequireThreeBands(medium);
  ExportOptions& options = description.options;
  std::vector<LoadedTexture> loaded;
  for (const TextureShape& shape : ShapesOf(options.user)) {
    if (IsOptional(shape) && !fs::exists(FileOf(folder, shape, options), error)) {
      description.absent.push_back(FileOf(folder, shape, options));
      continue;
    }
    loaded.push_back(Load(folder, shape, options, medium));
  }
  const LoadedTexture& scattering = loaded[2];
  const MultipleScattering light = FourOrdersOf(medium);
  const auto [lowest_sun_deg, checked] = LowestSunIn(scattering.texels, medium, light, options);
  options.lowest_sun_deg = lowest_sun_deg;
  RequireAgreement(scattering.description.file, AlphaErrors(scattering.texels, checked), medium);
  if (const auto fault = FaultOf(options)) RefuseFile(scattering.description.file, *fault);
  for (LoadedTexture& texture : loaded) {
    texture.description.errors = ErrorsOf(texture, checked, light, medium);
    RequireAgreement(texture.description.file, texture.description.errors, medium);
    description.textures.push_back(std::move(texture.description));
  }
  return description;
}

std::string DescriptionText(const fs::path& folder, const ExchangeDescription& description) {
  const Medium& medium = description.medium;
  const ExportOptions& options = description.options;
  const bool takram = options.user == TableUser::kThreeAtmosphere;
  std::string text = fmt::format(
      "{}\n"
      "  layout      {}, {} {}\n"
      "  lowest sun  {} degrees from the zenith (mu_s_min {:.6f}), by its texels\n"
      "  atmosphere  {}, hash {:016x}{}\n"
      "  units       W m^-2 nm^-1; scattering per steradian, without phase functions\n",
      folder.string(), takram ? "takram (three-atmosphere)" : "bruneton (his demo)",
      options.type == TexelType::kHalf ? "half" : "float", SuffixOf(*options.format).substr(1),
      *options.lowest_sun_deg, LowestSunOf(options), medium.name, MediumHash(medium),
      description.medium_is_assumed ? fmt::format(" (assumed: no {} beside them)", kMediumFileName)
                                    : "");
  if (!IsTheMediumThatLoadersAssume(medium)) {
    text += "  programs with fixed constants assume bruneton2017: these need other constants\n";
  }
  for (const ExchangeDescription::Texture& texture : description.textures) text += LineOf(texture);
  for (const fs::path& file : description.absent) {
    text += fmt::format("  absent      {}: the loader must be told to do without\n",
                        file.filename().string());
  }
  return text + "  every texel is finite and in its range\n";
}

}  // namespace alpenglow::lut
