// SPDX-License-Identifier: MIT
#include "lut/store/table_lookup.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "atmosphere/text/error.h"

namespace alpenglow::lut {

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

void TableLookup::ReplaceMultipleScattering(DiffuseLight light) {
  tables_.multiple_scattering = std::move(light);
}

bool TableLookup::HasTableFor(const ViewRay& ray) const {
  const Medium& air = tables_.medium;
  return tables_.single_scattering &&
         ExtentOf(ray, air.planet_radius_m, air.atmosphere_height_m).end != RayEnd::kLength;
}

const DiffuseLight& TableLookup::diffuse() const {
  if (!tables_.multiple_scattering) {
    throw InternalError("light of higher orders from tables of single scattering");
  }
  return *tables_.multiple_scattering;
}

Bands<float> TableLookup::Transmittance(const ViewRay& ray) const {
  if (tables_.transmittance) return tables_.transmittance->LookupAlong(ray);
  return air_.TransmittanceAlong(ray);
}

Bands<float> TableLookup::OpticalDepth(const ViewRay& ray) const {
  if (!tables_.transmittance) return air_.OpticalDepthAlong(ray);
  Bands<float> depth = tables_.transmittance->LookupAlong(ray);
  // Transmittance that the table holds as 0 has the optical depth of the smallest float.
  constexpr float kSmallest = std::numeric_limits<float>::denorm_min();
  for (std::size_t band = 0; band < depth.count; ++band) {
    depth[band] = -std::log(std::max(depth[band], kSmallest));
  }
  return depth;
}

Bands<float> TableLookup::InscatterOnce(const ViewRay& ray) const {
  if (HasTableFor(ray)) {
    return air_.Inscatter(tables_.single_scattering->Lookup(ray), ray.nu);
  }
  const Sampling lit{.nodes = tables_.ray_nodes, .split_ozone = false, .dark_samples = false};
  return air_.Inscatter(air_.Scatter(air_.Sample(ray, lit)), ray.nu);
}

Bands<float> TableLookup::InscatterOfAllOrders(const ViewRay& ray) const {
  const Sampling all{.nodes = tables_.ray_nodes, .split_ozone = false, .dark_samples = true};
  const RaySamples<float> samples = air_.Sample(ray, all);
  Bands<float> light = tables_.single_scattering ? InscatterOnce(ray)
                                                 : air_.Inscatter(air_.Scatter(samples), ray.nu);
  const Bands<float> more = diffuse().InscatterAlong(samples, ray.nu);
  for (std::size_t band = 0; band < light.count; ++band) light[band] += more[band];
  return light;
}

PolarisedLight TableLookup::PolarisationOfAllOrders(const ViewRay& ray) const {
  const Sampling all{.nodes = tables_.ray_nodes, .split_ozone = false, .dark_samples = true};
  const RaySamples<float> samples = air_.Sample(ray, all);
  PolarisedLight light = PolarisedOnce(tables_.medium, air_.Scatter(samples), ray);
  const PolarisedLight more = diffuse().PolarisationAlong(samples, ray.nu);
  for (std::size_t band = 0; band < light.q.count; ++band) {
    light.q[band] += more.q[band];
    light.u[band] += more.u[band];
  }
  return light;
}

Bands<float> TableLookup::SunIrradiance(double altitude_m, double mu_s) const {
  if (mu_s <= 0.0) return Bands<float>(bands());
  Bands<float> irradiance = Transmittance({altitude_m, mu_s, mu_s, 1.0});
  for (std::size_t band = 0; band < irradiance.count; ++band) {
    irradiance[band] *= static_cast<float>(mu_s);
  }
  return irradiance;
}

Bands<float> TableLookup::SkyIrradiance(double altitude_m, double mu_s) const {
  return diffuse().SkyIrradiance(altitude_m, mu_s);
}

}  // namespace alpenglow::lut
