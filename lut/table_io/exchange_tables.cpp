// SPDX-License-Identifier: MIT
#include "lut/table_io/exchange_tables.h"

#include <fmt/format.h>
#include <half.h>
#include <oneapi/tbb/parallel_for.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/base/finite.h"
#include "atmosphere/base/names.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/atmosphere_file.h"
#include "atmosphere/medium/medium.h"
#include "atmosphere/medium/phase_text.h"
#include "lut/cli/output_file.h"
#include "lut/cli/program.h"
#include "lut/table_io/table_folder.h"
#include "lut/tables/transmittance_table.h"

namespace alpenglow::lut {
namespace {

namespace fs = std::filesystem;

constexpr EnumNames kTexelTypes{
    {std::pair{TexelType::kFloat, "float"}, {TexelType::kHalf, "half"}}};
constexpr EnumNames kTexelFormats{
    {std::pair{TexelFormat::kExr, "exr"}, {TexelFormat::kBin, "bin"}, {TexelFormat::kDat, "dat"}}};

constexpr TransmittanceTableSize kTransmittanceSize{.mu = kTransmittanceShape.width,
                                                    .altitudes = kTransmittanceShape.height};
constexpr const ScatteringTableSize& kScatteringSize = kExchangeScatteringSize;

constexpr TextureShape ScatteringShape(const char* name) {
  return {name, kScatteringSize.nu * kScatteringSize.mu_s, kScatteringSize.mu,
          kScatteringSize.altitudes};
}

// Four orders of scattering in total: these are the three orders after the first.
constexpr MultipleScatteringOptions kFourOrders{.altitudes = 32,
                                                .sun_angles = 56,
                                                .degree = 6,
                                                .zenith_nodes = 14,
                                                .azimuth_nodes = 10,
                                                .ray_nodes = 12,
                                                .exact_orders = 3};
constexpr Sampling kHigherOrderSampling{.nodes = 12, .split_ozone = false, .dark_samples = true};

TexelType TypeOf(const ExportOptions& options) {
  return options.type.value_or(options.user == TableUser::kThreeAtmosphere ? TexelType::kHalf
                                                                           : TexelType::kFloat);
}

TexelFormat FormatOf(const ExportOptions& options) {
  return options.format.value_or(options.user == TableUser::kThreeAtmosphere ? TexelFormat::kExr
                                                                             : TexelFormat::kDat);
}

/// Returns a texel. Red, green and blue are the bands from the longest wavelength to the shortest.
std::array<float, 4> RgbaTexel(const Medium& medium, const Spectrum& unit, bool times_sun,
                               float alpha) {
  std::array<float, 4> rgba{0.0F, 0.0F, 0.0F, alpha};
  for (std::size_t c = 0; c < 3; ++c) {
    const std::size_t band = 2 - c;
    rgba[c] = unit[band] * (times_sun ? static_cast<float>(medium.solar_irradiance[band]) : 1.0F);
  }
  return rgba;
}

ExchangeTexture EmptyTexture(const TextureShape& shape) {
  return {shape.name, shape.width, shape.height, shape.depth,
          std::vector<float>(4 * shape.width * shape.height * shape.depth)};
}

void Put(ExchangeTexture& texture, std::size_t texel, const std::array<float, 4>& rgba) {
  std::copy(rgba.begin(), rgba.end(), &texture.rgba[4 * texel]);
}

ExchangeTexture TransmittanceTexture(const Medium& medium) {
  const TransmittanceTable table(medium, kTransmittanceSize);
  ExchangeTexture texture = EmptyTexture(kTransmittanceShape);
  for (std::size_t texel = 0; texel < texture.width * texture.height; ++texel) {
    Spectrum transmittance(3);
    std::copy_n(&table.texels()[3 * texel], 3, transmittance.values().begin());
    Put(texture, texel, RgbaTexel(medium, transmittance, false, 1.0F));
  }
  return texture;
}

ExchangeTexture IrradianceTexture(const Medium& medium, const MultipleScattering& light) {
  ExchangeTexture texture = EmptyTexture(kIrradianceShape);
  for (std::size_t y = 0; y < texture.height; ++y) {
    const double h = medium.atmosphere_height_m * static_cast<double>(y) /
                     static_cast<double>(texture.height - 1);
    for (std::size_t x = 0; x < texture.width; ++x) {
      const double mu_s =
          2.0 * static_cast<double>(x) / static_cast<double>(texture.width - 1) - 1.0;
      Put(texture, y * texture.width + x,
          RgbaTexel(medium, light.SkyIrradiance(h, mu_s), true, 1.0F));
    }
  }
  return texture;
}

/// Orders 2 to 4 divided by the molecules' phase function, one row (a view angle at an altitude) at
/// a time.
class HigherOrdersOfRays {
 public:
  HigherOrdersOfRays(const ScatteringTable& rays, const MultipleScattering& light)
      : rays_(rays), light_(light), air_(rays.medium()) {}

  /// Returns a row: [(nu * mu_s + mu_s) * 3 + band]
  [[nodiscard]] std::vector<float> Row(std::size_t row) const {
    const ScatteringTableSize& size = rays_.size();
    std::vector<float> values;
    values.reserve(size.nu * size.mu_s * 3);
    for (std::size_t nu = 0; nu < size.nu; ++nu) {
      for (std::size_t mu_s = 0; mu_s < size.mu_s; ++mu_s) {
        const ViewRay ray = rays_.RayOfTexel(nu, mu_s, row % size.mu, row / size.mu);
        const Spectrum more = HigherOrdersAlong(air_, light_, ray);
        const auto phase = static_cast<float>(shared::PhaseRayleigh<double>(ray.nu));
        for (std::size_t band = 0; band < 3; ++band) values.push_back(more[band] / phase);
      }
    }
    return values;
  }

 private:
  const ScatteringTable& rays_;
  const MultipleScattering& light_;
  SingleScattering<float> air_;
};

/// Returns scattering, higher_order_scattering, single_mie_scattering.
std::array<ExchangeTexture, 3> ScatteringTextures(const Medium& medium,
                                                  const MultipleScattering& light,
                                                  double lowest_mu_s,
                                                  const std::function<void()>& row_done) {
  const std::size_t rows = ScatteringTable::Rows(kScatteringSize);
  const ScatteringTable once(medium, {.size = kScatteringSize, .lowest_mu_s = lowest_mu_s},
                             row_done);
  const HigherOrdersOfRays higher(once, light);
  const std::vector<TextureShape> shapes = ShapesOf(TableUser::kThreeAtmosphere);
  std::array<ExchangeTexture, 3> textures{EmptyTexture(shapes[2]), EmptyTexture(shapes[3]),
                                          EmptyTexture(shapes[4])};
  const std::size_t width = textures[0].width;
  tbb::parallel_for(std::size_t{0}, rows, [&](std::size_t row) {
    if (Interrupted()) return;
    const std::vector<float> more = higher.Row(row);
    for (std::size_t x = 0; x < width; ++x) {
      Spectrum molecules(3), mie(3), orders(3);
      const float* texel = &once.texels()[6 * (row * width + x)];
      const double nu = once.RayOfTexel(x / kScatteringSize.mu_s, x % kScatteringSize.mu_s,
                                        row % kScatteringSize.mu, row / kScatteringSize.mu)
                            .nu;
      for (std::size_t band = 0; band < 3; ++band) {
        orders[band] = more[3 * x + band];
        molecules[band] =
            texel[band] * static_cast<float>(PhaseOverThatOfLoaders(medium, band, nu)) +
            orders[band];
        mie[band] = texel[3 + band];
      }
      const std::array<float, 4> mie_rgb = RgbaTexel(medium, mie, true, 1.0F);
      Put(textures[0], row * width + x, RgbaTexel(medium, molecules, true, mie_rgb[0]));
      Put(textures[1], row * width + x, RgbaTexel(medium, orders, true, 0.0F));
      Put(textures[2], row * width + x, mie_rgb);
    }
    row_done();
  });
  ThrowIfInterrupted();
  return textures;
}

/// Returns the rows from the last to the first.
std::vector<float> UpsideDown(const ExchangeTexture& texture) {
  std::vector<float> values;
  values.reserve(texture.rgba.size());
  const std::size_t row = 4 * texture.width;
  for (std::size_t y = texture.height * texture.depth; y-- > 0;) {
    const auto begin = texture.rgba.begin() + static_cast<std::ptrdiff_t>(y * row);
    values.insert(values.end(), begin, begin + static_cast<std::ptrdiff_t>(row));
  }
  return values;
}

void WriteExr(const fs::path& file, const ExchangeTexture& texture, const ExportOptions& options,
              const Medium& medium) {
  const bool reversed = options.user == TableUser::kThreeAtmosphere;
  const std::vector<float> values = reversed ? UpsideDown(texture) : texture.rgba;
  const TableImage image{texture.width,
                         texture.height * texture.depth,
                         {"R", "G", "B", "A"},
                         values,
                         {{"alpenglow.layout", reversed ? "takram, rows reversed" : "bruneton"},
                          {"alpenglow.texture", texture.name},
                          {"alpenglow.lowestMuS", fmt::format("{}", LowestSunOf(options))},
                          {"alpenglow.mediumHash", fmt::format("{:016x}", MediumHash(medium))},
                          {"alpenglow.mediumName", medium.name},
                          {"alpenglow.medium", TomlFromMedium(medium)},
                          {"alpenglow.producer", ProducerText()}},
                         TypeOf(options)};
  WriteTableImage(file, image);
}

std::string LittleEndian(const std::vector<float>& values, TexelType type) {
  const unsigned size = type == TexelType::kHalf ? 2 : 4;
  std::string bytes(size * values.size(), '\0');
  char* next = bytes.data();
  for (const float value : values) {
    const std::uint32_t bits =
        type == TexelType::kHalf ? half(value).bits() : std::bit_cast<std::uint32_t>(value);
    for (unsigned i = 0; i < size; ++i) *next++ = static_cast<char>(bits >> (8U * i) & 255U);
  }
  return bytes;
}

std::string MediumText(const Medium& medium, const ExportOptions& options) {
  return fmt::format(
      "# What the tables beside this file were made for, by {}.\n"
      "# Layout {}, {} texels, lowest sun {} degrees from the zenith (cosine {:.6f}); medium {}, "
      "hash {:016x}.\n{}",
      ProducerText(), options.user == TableUser::kThreeAtmosphere ? "takram" : "bruneton",
      TypeOf(options) == TexelType::kHalf ? "half" : "float", LowestSunAngle_deg(options),
      LowestSunOf(options), medium.name, MediumHash(medium), TomlFromMedium(medium));
}

}  // namespace

double PhaseOverThatOfLoaders(const Medium& medium, std::size_t band, double nu) {
  return shared::PhaseMolecules<double>(nu, Depolarisation(medium, band)) /
         shared::PhaseRayleigh<double>(nu);
}

TableUser TableUserFromName(std::string_view name) {
  constexpr EnumNames kNames{
      {std::pair{TableUser::kBrunetonDemo, "bruneton"}, {TableUser::kThreeAtmosphere, "takram"}}};
  return kNames.Named(name, "layout is \"{0}\"; it must be {2}");
}

TexelType TexelTypeFromName(std::string_view name) {
  return kTexelTypes.Named(name, "type is \"{0}\"; it must be {2}");
}

std::vector<std::string> TexelTypeNames() { return kTexelTypes.All(); }

TexelFormat TexelFormatFromName(std::string_view name) {
  return kTexelFormats.Named(name, "format is \"{0}\"; it must be {2}");
}

std::vector<std::string> TexelFormatNames() { return kTexelFormats.All(); }

std::optional<std::string> FaultOf(const ExportOptions& options) {
  if (options.user != TableUser::kThreeAtmosphere && options.user != TableUser::kBrunetonDemo)
    return "user is no TableUser";
  const TexelFormat format = FormatOf(options);
  const double sun_deg = LowestSunAngle_deg(options);
  if (sun_deg != kDemoLowestSun_deg && sun_deg != kLowestSun_deg) {
    return fmt::format("a lowest sun is 102 or 120 degrees from the zenith, not {}", sun_deg);
  }
  if (options.user == TableUser::kThreeAtmosphere) {
    if (format == TexelFormat::kDat) return "layout takram is exr or bin, not dat";
    if (format == TexelFormat::kBin && TypeOf(options) == TexelType::kFloat) {
      return "layout takram reads bin as half, not float";
    }
    if (sun_deg != kLowestSun_deg) return "layout takram has a lowest sun of 120 degrees";
  } else {
    if (format == TexelFormat::kBin) return "layout bruneton is dat or exr, not bin";
    if (format == TexelFormat::kDat && TypeOf(options) == TexelType::kHalf) {
      return "layout bruneton reads dat as float, not half";
    }
  }
  return std::nullopt;
}

double LowestSunAngle_deg(const ExportOptions& options) {
  return options.lowest_sun_deg.value_or(
      options.user == TableUser::kThreeAtmosphere ? kLowestSun_deg : kDemoLowestSun_deg);
}

double LowestSunOf(const ExportOptions& options) {
  const double sun_deg = LowestSunAngle_deg(options);
  return sun_deg == kLowestSun_deg ? -0.5 : std::cos(sun_deg / 180.0 * kPi);
}

void RequireThreeBands(const Medium& medium) {
  if (medium.wavelengths_nm.size() == 3) return;
  throw InputError(fmt::format(
      "spectrum.wavelengths_nm has {} values; tables for other programs hold red, green and blue",
      medium.wavelengths_nm.size()));
}

std::vector<TextureShape> ShapesOf(TableUser user) {
  std::vector<TextureShape> shapes{kTransmittanceShape, kIrradianceShape,
                                   ScatteringShape("scattering")};
  if (user == TableUser::kThreeAtmosphere) {
    shapes.push_back(ScatteringShape("higher_order_scattering"));
    shapes.push_back(ScatteringShape("single_mie_scattering"));
  }
  return shapes;
}

std::string SuffixOf(TexelFormat format) { return std::string(".") + kTexelFormats.Of(format); }

MultipleScattering FourOrdersOf(const Medium& medium) {
  return MultipleScattering(medium, kFourOrders);
}

Spectrum HigherOrdersAlong(const SingleScattering<float>& air, const MultipleScattering& light,
                           const ViewRay& ray) {
  return light.InscatterAlong(air.Sample(ray, kHigherOrderSampling), ray.nu);
}

bool IsTheMediumThatLoadersAssume(const Medium& medium) {
  return MediumHash(medium) == MediumHash(MediumPreset("bruneton2017"));
}

std::vector<ExchangeTexture> MakeExchangeTextures(const Medium& medium,
                                                  const ExportOptions& options,
                                                  const std::function<void()>& row_done) {
  RequireThreeBands(medium);
  const MultipleScattering light = FourOrdersOf(medium);
  std::vector<ExchangeTexture> textures{TransmittanceTexture(medium),
                                        IrradianceTexture(medium, light)};
  auto [scattering, higher, mie] =
      ScatteringTextures(medium, light, LowestSunOf(options), row_done);
  textures.push_back(std::move(scattering));
  if (options.user == TableUser::kThreeAtmosphere) {
    textures.push_back(std::move(higher));
    textures.push_back(std::move(mie));
  }
  return textures;
}

void WriteExchangeTables(const std::vector<ExchangeTexture>& textures, const Medium& medium,
                         const ExportOptions& options, const fs::path& folder) {
  if (const auto fault = FaultOf(options)) throw InputError(*fault);
  MakeFolder(folder);
  const TexelFormat format = FormatOf(options);
  for (const ExchangeTexture& texture : textures) {
    const fs::path file = folder / (texture.name + SuffixOf(format));
    RequireFinite(texture.rgba, file.string());
    if (format == TexelFormat::kExr) {
      WriteExr(file, texture, options, medium);
    } else {
      WriteTextAtomically(file, LittleEndian(texture.rgba, TypeOf(options)));
    }
  }
  WriteTextAtomically(folder / kMediumFileName, MediumText(medium, options));
}

}  // namespace alpenglow::lut
