// SPDX-License-Identifier: MIT
// Cases of light in plane-parallel layers (renderer/layers), for the report and for studies.
//
// A cloud of optical depth 0.3 to 60 lies between two layers of molecules over ground of albedo 0.1 or
// 0.8. Radiances are taken at seven depths in random directions beyond 3 degrees from the sun, and
// fluxes at the same depths.
#pragma once

#include <vector>

#include "renderer/layers/first_order.h"
#include "renderer/layers/layer_optics.h"

namespace alpenglow::renderer {

/// Returns the Legendre coefficients of the phase function of Henyey and Greenstein, to 1e-9.
[[nodiscard]] std::vector<double> MomentsOfLobe(double g);

/// Returns a cloud between two layers of molecules.
/// @param depth  optical, of the cloud. @param g  mean cosine of its phase function.
[[nodiscard]] std::vector<LayerOptics> CloudInAir(double depth, double g);

/// A direction at a depth below the top.
struct LayerLook {
  double depth;
  LightWay way;
};

/// One sun over one stack.
struct LayerCase {
  double cloud_depth, ground_albedo;
  double mu_s;
  std::vector<LayerOptics> layers;
  std::vector<double> depths;  // of fluxes
  std::vector<LayerLook> looks;
};

/// Returns all cases: five depths of the cloud, two grounds, three suns.
/// @param looks  number of random directions at each depth; those near the sun are left out.
[[nodiscard]] std::vector<LayerCase> LayerCasesOf(double g, int looks = 12);

/// Light of one case.
struct LightOfLayers {
  std::vector<double> radiances;  // per irradiance across the beam [1/sr], by LayerCase::looks
  std::vector<double> fluxes;  // upwards and downwards at each depth, relative to the incident flux
};

/// Returns the light of a case. @param field  with the functions Radiance and Fluxes of LayerField.
template <typename Field>
[[nodiscard]] LightOfLayers LightIn(const LayerCase& of, const Field& field) {
  LightOfLayers light;
  for (const LayerLook& look : of.looks)
    light.radiances.push_back(field.Radiance(look.depth, look.way));
  for (const double depth : of.depths) {
    const auto fluxes = field.Fluxes(depth);
    light.fluxes.push_back(fluxes.up / of.mu_s);
    light.fluxes.push_back(fluxes.down / of.mu_s);
  }
  return light;
}

}  // namespace alpenglow::renderer
