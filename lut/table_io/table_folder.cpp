// SPDX-License-Identifier: MIT
#include "lut/table_io/table_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <system_error>

#include "atmosphere/base/error.h"
#include "atmosphere/base/names.h"
#include "lut/cli/output_file.h"

namespace alpenglow::lut {

namespace fs = std::filesystem;

BakeQuality BakeQualityFromName(std::string_view name) {
  constexpr EnumNames kNames{{std::pair{BakeQuality::kPreview, "preview"},
                              {BakeQuality::kStandard, "standard"},
                              {BakeQuality::kFine, "fine"}}};
  return kNames.Named(name, "quality is \"{0}\"; it must be {2}");
}

TableSizes SizesOf(BakeQuality quality) {
  switch (quality) {
    case BakeQuality::kPreview:
      return {{.mu = 128, .altitudes = 32},
              {.nu = 6, .mu_s = 16, .mu = 32, .altitudes = 24},
              {.altitudes = 14,
               .sun_angles = 28,
               .degree = 2,
               .zenith_nodes = 8,
               .azimuth_nodes = 6,
               .ray_nodes = 8},
              8};
    case BakeQuality::kStandard:
      return {{}, {.nu = 8, .mu_s = 32, .mu = 64, .altitudes = 48}, {}, 12};
    case BakeQuality::kFine:
      return {{.mu = 512, .altitudes = 128},
              {.nu = 10, .mu_s = 48, .mu = 96, .altitudes = 64},
              {.altitudes = 32,
               .sun_angles = 64,
               .degree = 6,
               .zenith_nodes = 14,
               .azimuth_nodes = 12,
               .ray_nodes = 14},
              16};
  }
  throw InputError("quality is no BakeQuality");
}

void BuildTableFolder(const Medium& medium, const BakeOptions& options, const fs::path& folder,
                      const std::function<void()>& row_done) {
  const TableSizes sizes = SizesOf(options.quality);
  MakeFolder(folder);
  // Remove the file of an earlier build, because it would describe the new tables wrongly. The new
  // file is written last.
  std::error_code error;
  fs::remove(folder / kMultipleScatteringFileName, error);
  WriteTable(folder / kTransmittanceFileName, TransmittanceTable(medium, sizes.transmittance));
  WriteTable(folder / kSingleScatteringFileName, ScatteringTable(medium,
                                                                 {.size = sizes.single_scattering,
                                                                  .lowest_mu_s = {},
                                                                  .axes = ScatteringAxes::kAzimuth},
                                                                 row_done));
  if (options.single_scattering_only) return;
  WriteTable(folder / kMultipleScatteringFileName,
             MultipleScattering(medium, RaisedFor(medium, sizes.multiple_scattering)),
             {.ray_nodes = sizes.ray_nodes});
}

TableFolder ReadTableFolder(const fs::path& folder,
                            const std::optional<std::uint64_t>& medium_hash) {
  TableFolder tables;
  std::optional<std::uint64_t> hash = medium_hash;
  const auto of_medium = [&](const Medium& medium) {
    tables.medium = medium;
    hash = MediumHash(medium);
  };
  FolderUse use;
  std::error_code error;
  if (fs::exists(folder / kMultipleScatteringFileName, error)) {
    StoredMultipleScattering stored =
        ReadMultipleScattering(folder / kMultipleScatteringFileName, hash);
    use = stored.use;
    tables.ray_nodes = use.ray_nodes;
    tables.multiple_scattering = std::move(stored.light);
    of_medium(tables.multiple_scattering->medium());
  }
  if (use.transmittance) {
    tables.transmittance = ReadTransmittanceTable(folder / kTransmittanceFileName, hash);
    of_medium(tables.transmittance->medium());
  }
  if (use.single_scattering) {
    tables.single_scattering = ReadScatteringTable(folder / kSingleScatteringFileName, hash);
    of_medium(tables.single_scattering->medium());
  }
  return tables;
}

std::string DescribeTables(const fs::path& file_or_folder) {
  std::error_code error;
  if (!fs::is_directory(file_or_folder, error)) {
    return DescriptionText(file_or_folder, DescribeTable(file_or_folder));
  }
  std::string text;
  for (const char* name :
       {kTransmittanceFileName, kSingleScatteringFileName, kMultipleScatteringFileName}) {
    const fs::path file = file_or_folder / name;
    if (fs::exists(file, error)) text += DescriptionText(file, DescribeTable(file));
  }
  if (text.empty()) {
    throw InputError(fmt::format("{}: has none of {}, {} and {}", file_or_folder.string(),
                                 kTransmittanceFileName, kSingleScatteringFileName,
                                 kMultipleScatteringFileName));
  }
  return text;
}

TableLookup::TableLookup(TableFolder tables) : tables_(std::move(tables)), air_(tables_.medium) {
  const auto require_medium = [this](const auto& table) {
    if (table && MediumHash(table->medium()) != MediumHash(tables_.medium)) {
      throw InputError("the tables were made for different atmospheres");
    }
  };
  require_medium(tables_.transmittance);
  require_medium(tables_.single_scattering);
  require_medium(tables_.multiple_scattering);
}

void TableLookup::ReplaceMultipleScattering(MultipleScattering light) {
  tables_.multiple_scattering = std::move(light);
}

bool TableLookup::HasTableFor(const ViewRay& ray) const {
  const Medium& air = tables_.medium;
  const RayExtent extent = ExtentOf(ray, air.planet_radius_m, air.atmosphere_height_m);
  return tables_.single_scattering && extent.end != RayEnd::kLength &&
         !SubmergedPart(ray, extent, air.planet_radius_m).Exists();
}

const MultipleScattering& TableLookup::multiple_scattering() const {
  if (!tables_.multiple_scattering) {
    throw InternalError("light of higher orders from tables of single scattering");
  }
  return *tables_.multiple_scattering;
}

bool TableLookup::HasTransmittanceFor(const ViewRay& ray) const {
  const Medium& air = tables_.medium;
  const RayExtent extent = ExtentOf(ray, air.planet_radius_m, air.atmosphere_height_m);
  return tables_.transmittance && !SubmergedPart(ray, extent, air.planet_radius_m).Exists();
}

Spectrum TableLookup::Transmittance(const ViewRay& ray) const {
  if (HasTransmittanceFor(ray)) return tables_.transmittance->LookupAlong(ray);
  return air_.TransmittanceAlong(ray);
}

Spectrum TableLookup::OpticalDepth(const ViewRay& ray) const {
  if (!HasTransmittanceFor(ray)) return air_.OpticalDepthAlong(ray);
  Spectrum depth = tables_.transmittance->LookupAlong(ray);
  // A transmittance that the table stores as 0 gets the optical depth of the smallest float.
  constexpr float kSmallest = std::numeric_limits<float>::denorm_min();
  for (std::size_t band = 0; band < depth.size(); ++band) {
    depth[band] = -std::log(std::max(depth[band], kSmallest));
  }
  return depth;
}

Spectrum TableLookup::InscatterOnce(const ViewRay& ray) const {
  if (HasTableFor(ray)) {
    return air_.Inscatter(tables_.single_scattering->Lookup(ray), ray.nu);
  }
  const Sampling lit{.nodes = tables_.ray_nodes, .split_ozone = false, .dark_samples = false};
  return air_.Inscatter(air_.Scatter(air_.Sample(ray, lit)), ray.nu);
}

Spectrum TableLookup::InscatterOfAllOrders(const ViewRay& ray) const {
  const Sampling all{.nodes = tables_.ray_nodes, .split_ozone = false, .dark_samples = true};
  const RaySamples<float> samples = air_.Sample(ray, all);
  Spectrum light = tables_.single_scattering ? InscatterOnce(ray)
                                             : air_.Inscatter(air_.Scatter(samples), ray.nu);
  const Spectrum more = multiple_scattering().InscatterAlong(samples, ray.nu);
  for (std::size_t band = 0; band < light.size(); ++band) light[band] += more[band];
  return light;
}

PolarisedLight TableLookup::PolarisationOfAllOrders(const ViewRay& ray) const {
  const Sampling all{.nodes = tables_.ray_nodes, .split_ozone = false, .dark_samples = true};
  const RaySamples<float> samples = air_.Sample(ray, all);
  PolarisedLight light = PolarisedOnce(tables_.medium, air_.Scatter(samples), ray);
  const PolarisedLight more = multiple_scattering().PolarisationAlong(samples, ray.nu);
  for (std::size_t band = 0; band < light.q.size(); ++band) {
    light.q[band] += more.q[band];
    light.u[band] += more.u[band];
  }
  return light;
}

Spectrum TableLookup::SunIrradiance(double altitude_m, double mu_s) const {
  if (mu_s <= 0.0) return Spectrum(bands());
  Spectrum irradiance = Transmittance({altitude_m, mu_s, mu_s, 1.0});
  for (std::size_t band = 0; band < irradiance.size(); ++band) {
    irradiance[band] *= static_cast<float>(mu_s);
  }
  return irradiance;
}

Spectrum TableLookup::SkyIrradiance(double altitude_m, double mu_s) const {
  return multiple_scattering().SkyIrradiance(altitude_m, mu_s);
}

}  // namespace alpenglow::lut
