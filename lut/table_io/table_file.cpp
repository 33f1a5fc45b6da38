// SPDX-License-Identifier: MIT
#include "lut/table_io/table_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"
#include "atmosphere/medium/atmosphere_file.h"
#include "atmosphere/medium/medium.h"
#include "lut/cli/program.h"
#include "lut/multiple_scattering/moment_grid.h"
#include "lut/table_io/table_image.h"

namespace alpenglow::lut {
namespace {

namespace fs = std::filesystem;

/// Properties of a kind of table.
struct Kind {
  const char* name;
  const char* quantity;
  const char* units;
  const char* axes;  // slowest last
  const char* layout;
  int map_version;
  std::vector<std::string> species;  // first parts of channel names
  double lowest = 0.0, highest = 1.0;
};

const Kind kTransmittance{"transmittance",
                          "transmittance from a point to space, rays that miss the ground",
                          "1",
                          "mu r",
                          "column = mu (zenith to horizon), row = r (ground to top)",
                          kTransmittanceMapVersion,
                          {"T"}};
const Kind kSingleScattering{
    "single scattering",
    "sunlight scattered once along the ray, per unit solar irradiance, without phase functions",
    "1",
    "mu_s nu mu r",
    "column = nu * n(mu_s) + mu_s, row = r * n(mu) + mu (lower half hits the ground)",
    kScatteringMapVersion,
    {"rayleigh", "mie"}};

const Kind kSingleScatteringByAzimuth{
    kSingleScattering.name,
    "fourth root of sunlight scattered once along the ray, per unit solar irradiance, without "
    "phase functions",
    "1",
    "mu_s azimuth mu r",
    "column = azimuth (towards the sun first) * n(mu_s) + mu_s, row = r * n(mu) + mu (lower half "
    "hits the ground)",
    kScatteringMapVersion,
    {"rayleigh", "mie"}};

const Kind& KindOf(ScatteringAxes axes) {
  return axes == ScatteringAxes::kAzimuth ? kSingleScatteringByAzimuth : kSingleScattering;
}

/// Returns the kind with moments up to a degree, moments of the tensor of polarised light, then the
/// irradiance from above.
Kind MultipleScatteringKind(int degree, bool polarised) {
  Kind kind{"multiple scattering",
            "diffuse light of all orders per unit solar irradiance: moments of its radiance on "
            "real spherical harmonics L_lm (azimuth from the sun), and irradiance E from above",
            "1",
            "mu_s h",
            "column = mu_s (lowest sun to zenith), row = altitude (ground to top)",
            kMultipleScatteringMapVersion,
            {},
            -100.0,
            100.0};
  for (int l = 0; l <= degree; ++l) {
    for (int m = 0; m <= l; ++m) kind.species.push_back(fmt::format("L{}{}", l, m));
  }
  if (polarised) kind.species.insert(kind.species.end(), {"T20", "T21", "T22"});
  kind.species.emplace_back("E");
  return kind;
}

// Formats whole nanometres as 0450nm, others as 0450,500nm.
std::string WavelengthText(double wavelength_nm) {
  std::string text = fmt::format("{:08.3f}", wavelength_nm);
  if (text.ends_with(".000")) return text.substr(0, text.size() - 4) + "nm";
  std::replace(text.begin(), text.end(), '.', ',');
  return text + "nm";
}

std::vector<std::string> ChannelNames(const Kind& kind, const Medium& medium) {
  std::vector<std::string> names;
  for (const std::string& species : kind.species) {
    for (const double wavelength_nm : medium.wavelengths_nm) {
      names.push_back(fmt::format("{}.{}", species, WavelengthText(wavelength_nm)));
    }
  }
  if (std::set<std::string>(names.begin(), names.end()).size() != names.size()) {
    throw InputError(
        "spectrum.wavelengths_nm: two lie within 0.001 nm of each other; a table file "
        "cannot tell their channels apart");
  }
  return names;
}

std::string HashText(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

TextAttributes AttributesOf(const Kind& kind, const Medium& medium,
                            const std::vector<std::size_t>& sizes) {
  return {{"alpenglow.kind", kind.name},
          {"alpenglow.quantity", kind.quantity},
          {"alpenglow.units", kind.units},
          {"alpenglow.axes", kind.axes},
          {"alpenglow.axisSizes", fmt::format("{}", fmt::join(sizes, " "))},
          {"alpenglow.layout", kind.layout},
          {"alpenglow.mapVersion", fmt::format("{}", kind.map_version)},
          {"alpenglow.mediumHash", HashText(MediumHash(medium))},
          {"alpenglow.mediumName", medium.name},
          {"alpenglow.medium", TomlFromMedium(medium)},
          {"alpenglow.producer", ProducerText()}};
}

std::vector<std::size_t> SizesOf(const TableImageReader& image, std::size_t axes) {
  const std::string text = image.Attribute("alpenglow.axisSizes");
  std::vector<std::size_t> sizes;
  const char* at = text.data();
  const char* end = at + text.size();
  while (at != end && sizes.size() < axes) {
    std::size_t size = 0;
    const auto [next, error] = std::from_chars(at, end, size);
    if (error != std::errc() || size == 0 || size > (1U << 16U)) break;
    sizes.push_back(size);
    at = next != end && *next == ' ' ? next + 1 : next;
  }
  if (at != end || sizes.size() != axes) {
    RefuseFile(image.file(),
               fmt::format("alpenglow.axisSizes is \"{}\"; it must be {} numbers from 1 to "
                           "65536",
                           text, axes));
  }
  return sizes;
}

Medium MediumOf(const TableImageReader& image) {
  Medium medium = MediumFromToml(image.Attribute("alpenglow.medium"),
                                 image.file().string() + ": alpenglow.medium");
  medium.name = image.Attribute("alpenglow.mediumName");
  if (const std::string stored = image.Attribute("alpenglow.mediumHash");
      stored != HashText(MediumHash(medium))) {
    RefuseFile(image.file(),
               fmt::format("alpenglow.mediumHash is {}; the medium in the file has {}", stored,
                           HashText(MediumHash(medium))));
  }
  return medium;
}

void RequireKind(const TableImageReader& image, const Kind& kind) {
  if (const std::string name = image.Attribute("alpenglow.kind"); name != kind.name) {
    RefuseFile(image.file(),
               fmt::format("is a table of {}; it must be one of {}", name, kind.name));
  }
  if (const std::string version = image.Attribute("alpenglow.mapVersion");
      version != fmt::format("{}", kind.map_version)) {
    RefuseFile(image.file(), fmt::format("alpenglow.mapVersion is {}; this program reads {}: build "
                                         "the tables again",
                                         version, kind.map_version));
  }
  for (const auto& [name, text] : {std::pair{"units", kind.units},
                                   {"axes", kind.axes},
                                   {"layout", kind.layout},
                                   {"quantity", kind.quantity}}) {
    const std::string found = image.Attribute(fmt::format("alpenglow.{}", name));
    if (found != text) {
      RefuseFile(image.file(),
                 fmt::format("alpenglow.{} is \"{}\"; it must be \"{}\"", name, found, text));
    }
  }
  static_cast<void>(image.Attribute("alpenglow.producer"));
}

void RequireMedium(const TableImageReader& image, const Medium& medium,
                   const std::optional<std::uint64_t>& expected) {
  if (expected && *expected != MediumHash(medium)) {
    RefuseFile(
        image.file(),
        fmt::format("was made for another atmosphere ({}, hash {}); the one asked for has {}",
                    medium.name, HashText(MediumHash(medium)), HashText(*expected)));
  }
}

void RequireWindow(const TableImageReader& image, std::size_t width, std::size_t height) {
  if (image.width() != width || image.height() != height) {
    RefuseFile(image.file(), fmt::format("is {} x {} texels; its axes need {} x {}", image.width(),
                                         image.height(), width, height));
  }
}

std::vector<float> CheckedValues(const TableImageReader& image, const Kind& kind,
                                 const Medium& medium) {
  const std::vector<std::string> names = ChannelNames(kind, medium);
  std::vector<float> values = image.Values(names);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto value = static_cast<double>(values[i]);
    if (value >= kind.lowest && value <= kind.highest) continue;
    const std::size_t texel = i / names.size();
    RefuseFile(image.file(),
               fmt::format("texel ({}, {}) of channel {} is {}; it must lie in [{}, {}]",
                           texel % image.width(), texel / image.width(), names[i % names.size()],
                           value, kind.lowest, kind.highest));
  }
  return values;
}

/// Parses a number of a text attribute; throws for any other text.
double NumberOf(const TableImageReader& image, const std::string& name) {
  const std::string text = image.Attribute(name);
  const std::optional<double> value = ParseNumber(text);
  if (!value)
    RefuseFile(image.file(), fmt::format("{} is \"{}\"; it must be a number", name, text));
  return *value;
}

/// Adds the file's name to errors that the tables detect themselves (sizes, ranges).
template <typename Make>
auto NamingTheFile(const fs::path& file, const Make& make) {
  try {
    return make();
  } catch (const InputError& error) {
    RefuseFile(file, error.what());
  }
}

TransmittanceTable TransmittanceTableOf(const TableImageReader& image,
                                        const std::optional<std::uint64_t>& medium_hash) {
  RequireKind(image, kTransmittance);
  const Medium medium = MediumOf(image);
  RequireMedium(image, medium, medium_hash);
  const std::vector<std::size_t> sizes = SizesOf(image, 2);
  RequireWindow(image, sizes[0], sizes[1]);
  std::vector<float> values = CheckedValues(image, kTransmittance, medium);
  return NamingTheFile(image.file(), [&] {
    return TransmittanceTable(medium, {.mu = sizes[0], .altitudes = sizes[1]}, std::move(values));
  });
}

ScatteringTable ScatteringTableOf(const TableImageReader& image,
                                  const std::optional<std::uint64_t>& medium_hash) {
  ScatteringTableOptions options;
  if (image.Attribute("alpenglow.axes") == kSingleScatteringByAzimuth.axes) {
    options.axes = ScatteringAxes::kAzimuth;
  }
  const Kind& kind = KindOf(options.axes);
  RequireKind(image, kind);
  const Medium medium = MediumOf(image);
  RequireMedium(image, medium, medium_hash);
  const std::vector<std::size_t> sizes = SizesOf(image, 4);
  RequireWindow(image, sizes[0] * sizes[1], sizes[2] * sizes[3]);
  options.size = {.nu = sizes[1], .mu_s = sizes[0], .mu = sizes[2], .altitudes = sizes[3]};
  options.lowest_mu_s = NumberOf(image, "alpenglow.lowestMuS");
  std::vector<float> values = CheckedValues(image, kind, medium);
  return NamingTheFile(image.file(),
                       [&] { return ScatteringTable(medium, options, std::move(values)); });
}

int IntegerOf(const TableImageReader& image, const std::string& name, int lowest, int highest) {
  const double value = NumberOf(image, name);
  if (value == std::floor(value) && value >= lowest && value <= highest) {
    return static_cast<int>(value);
  }
  RefuseFile(image.file(), fmt::format("{} is {}; it must be a whole number from {} to {}", name,
                                       value, lowest, highest));
}

bool YesOf(const TableImageReader& image, const std::string& name) {
  const std::string text = image.Attribute(name);
  if (text == "yes" || text == "no") return text == "yes";
  RefuseFile(image.file(), fmt::format("{} is \"{}\"; it must be yes or no", name, text));
}

std::string SunCosinesText(std::size_t columns, bool polarised) {
  MomentGrid grid{};
  grid.suns = columns;
  grid.polarised = polarised;
  std::string text;
  for (std::size_t j = 0; j < columns; ++j)
    text += fmt::format("{}{:.9f}", j == 0 ? "" : " ", MuSOfNode(grid, j));
  return text;
}

std::string TablesText(const FolderUse& use) {
  std::string text;
  if (use.transmittance) text += kTransmittanceFileName;
  if (use.single_scattering) {
    text += fmt::format("{}{}", text.empty() ? "" : " ", kSingleScatteringFileName);
  }
  return text.empty() ? "none" : text;
}

FolderUse UseOf(const TableImageReader& image) {
  FolderUse use;
  use.ray_nodes = IntegerOf(image, "alpenglow.rayNodes", 2, 32);
  const std::string tables = image.Attribute("alpenglow.tables");
  for (const bool transmittance : {false, true}) {
    for (const bool single_scattering : {false, true}) {
      use.transmittance = transmittance;
      use.single_scattering = single_scattering;
      if (tables == TablesText(use)) return use;
    }
  }
  RefuseFile(image.file(), fmt::format("alpenglow.tables is \"{}\"", tables));
}

StoredMultipleScattering MultipleScatteringOf(const TableImageReader& image,
                                              const std::optional<std::uint64_t>& medium_hash) {
  const int degree = IntegerOf(image, "alpenglow.degree", 0, 1 << 20);
  NamingTheFile(image.file(), [&] { RequireDegree(degree); });
  RequireKind(image, MultipleScatteringKind(degree, false));
  const Medium medium = MediumOf(image);
  const Kind kind = MultipleScatteringKind(degree, medium.polarised);
  RequireMedium(image, medium, medium_hash);
  const std::vector<std::size_t> sizes = SizesOf(image, 2);
  RequireWindow(image, sizes[0], sizes[1]);
  if (image.Attribute("alpenglow.sunCosines") != SunCosinesText(sizes[0], medium.polarised)) {
    RefuseFile(image.file(), "alpenglow.sunCosines are not the nodes of this program");
  }
  MultipleScatteringOptions options;
  options.sun_angles = static_cast<int>(sizes[0]);
  options.altitudes = static_cast<int>(sizes[1]);
  options.degree = degree;
  options.delta_m = YesOf(image, "alpenglow.forwardPeak");
  SolvedOrders solved{CheckedValues(image, kind, medium),
                      IntegerOf(image, "alpenglow.orders", 1, 1 << 20),
                      YesOf(image, "alpenglow.converged")};
  const FolderUse use = UseOf(image);
  return NamingTheFile(image.file(), [&] {
    return StoredMultipleScattering{MultipleScattering(medium, options, std::move(solved)), use};
  });
}

std::vector<TableDescription::ChannelRange> RangesOf(const std::vector<std::string>& names,
                                                     const std::vector<float>& values) {
  std::vector<TableDescription::ChannelRange> ranges;
  for (std::size_t channel = 0; channel < names.size(); ++channel) {
    const double first = values[channel];
    TableDescription::ChannelRange range{names[channel], first, first, 0.0};
    double sum = 0.0;
    for (std::size_t i = channel; i < values.size(); i += names.size()) {
      const double value = values[i];
      range.lowest = std::min(range.lowest, value);
      range.highest = std::max(range.highest, value);
      sum += value;
    }
    range.mean = sum * static_cast<double>(names.size()) / static_cast<double>(values.size());
    ranges.push_back(range);
  }
  return ranges;
}

}  // namespace

void WriteTable(const fs::path& file, const TransmittanceTable& table) {
  const auto& [mu, altitudes] = table.size();
  WriteTableImage(file,
                  {mu, altitudes, ChannelNames(kTransmittance, table.medium()), table.texels(),
                   AttributesOf(kTransmittance, table.medium(), {mu, altitudes})});
}

void WriteTable(const fs::path& file, const ScatteringTable& table) {
  const ScatteringTableSize& size = table.size();
  const Kind& kind = KindOf(table.axes());
  TextAttributes attributes =
      AttributesOf(kind, table.medium(), {size.mu_s, size.nu, size.mu, size.altitudes});
  attributes["alpenglow.lowestMuS"] = fmt::format("{}", table.lowest_mu_s());
  WriteTableImage(
      file, {size.nu * size.mu_s, size.mu * size.altitudes, ChannelNames(kind, table.medium()),
             table.texels(), std::move(attributes)});
}

void WriteTable(const fs::path& file, const MultipleScattering& light, const FolderUse& use) {
  const MultipleScatteringOptions& options = light.options();
  const auto columns = static_cast<std::size_t>(options.sun_angles);
  const auto rows = static_cast<std::size_t>(options.altitudes);
  const Kind kind = MultipleScatteringKind(options.degree, light.medium().polarised);
  TextAttributes attributes = AttributesOf(kind, light.medium(), {columns, rows});
  attributes["alpenglow.degree"] = fmt::format("{}", options.degree);
  attributes["alpenglow.orders"] = fmt::format("{}", light.orders());
  attributes["alpenglow.forwardPeak"] = options.delta_m ? "yes" : "no";
  attributes["alpenglow.converged"] = light.converged() ? "yes" : "no";
  attributes["alpenglow.sunCosines"] = SunCosinesText(columns, light.medium().polarised);
  attributes["alpenglow.rayNodes"] = fmt::format("{}", use.ray_nodes);
  attributes["alpenglow.tables"] = TablesText(use);
  WriteTableImage(file, {columns, rows, ChannelNames(kind, light.medium()), light.values(),
                         std::move(attributes)});
}

TransmittanceTable ReadTransmittanceTable(const fs::path& file,
                                          const std::optional<std::uint64_t>& medium_hash) {
  return TransmittanceTableOf(TableImageReader(file), medium_hash);
}

ScatteringTable ReadScatteringTable(const fs::path& file,
                                    const std::optional<std::uint64_t>& medium_hash) {
  return ScatteringTableOf(TableImageReader(file), medium_hash);
}

StoredMultipleScattering ReadMultipleScattering(const fs::path& file,
                                                const std::optional<std::uint64_t>& medium_hash) {
  return MultipleScatteringOf(TableImageReader(file), medium_hash);
}

TableDescription DescribeTable(const fs::path& file) {
  const TableImageReader image(file);
  TableDescription description;
  description.kind = image.Attribute("alpenglow.kind");
  const auto describe = [&](const Kind& kind, const Medium& medium,
                            const std::vector<float>& values) {
    description.medium = medium;
    description.bytes = values.size() * sizeof(float);
    description.channels = RangesOf(ChannelNames(kind, medium), values);
    description.lowest = kind.lowest;
    description.highest = kind.highest;
  };
  if (description.kind == kTransmittance.name) {
    const TransmittanceTable table = TransmittanceTableOf(image, {});
    describe(kTransmittance, table.medium(), table.texels());
  } else if (description.kind == kSingleScattering.name) {
    const ScatteringTable table = ScatteringTableOf(image, {});
    describe(KindOf(table.axes()), table.medium(), table.texels());
  } else if (description.kind == MultipleScatteringKind(0, false).name) {
    const MultipleScattering light = MultipleScatteringOf(image, {}).light;
    describe(MultipleScatteringKind(light.options().degree, light.medium().polarised),
             light.medium(), light.values());
  } else {
    RefuseFile(file,
               fmt::format("is a table of {}, which this program does not know", description.kind));
  }
  description.quantity = image.Attribute("alpenglow.quantity");
  description.units = image.Attribute("alpenglow.units");
  description.axes = image.Attribute("alpenglow.axes");
  description.axis_sizes = image.Attribute("alpenglow.axisSizes");
  description.layout = image.Attribute("alpenglow.layout");
  description.map_version = image.Attribute("alpenglow.mapVersion");
  description.producer = image.Attribute("alpenglow.producer");
  return description;
}

std::string DescriptionText(const fs::path& file, const TableDescription& description) {
  const Medium& medium = description.medium;
  std::string text = fmt::format(
      "{}\n"
      "  kind        {}\n"
      "  quantity    {}\n"
      "  units       {}\n"
      "  axes        {} (the first varies fastest)\n"
      "  sizes       {} = {} bytes of texels\n"
      "  layout      {}\n"
      "  map         version {}\n"
      "  atmosphere  {}, hash {}\n"
      "  planet      radius {} m, air up to {} m\n"
      "  made by     {}\n",
      file.string(), description.kind, description.quantity, description.units, description.axes,
      description.axis_sizes, description.bytes, description.layout, description.map_version,
      medium.name, HashText(MediumHash(medium)), medium.planet_radius_m, medium.atmosphere_height_m,
      description.producer);
  for (const TableDescription::ChannelRange& channel : description.channels) {
    text += fmt::format("  channel     {:<20} {:.6g} to {:.6g}, mean {:.6g}\n", channel.name,
                        channel.lowest, channel.highest, channel.mean);
  }
  return text + fmt::format("  every texel is finite and in [{}, {}]\n", description.lowest,
                            description.highest);
}

}  // namespace alpenglow::lut
