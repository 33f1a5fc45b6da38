// SPDX-License-Identifier: MIT
#include "renderer/lit_clouds/air_reflection.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "atmosphere/math/constants.h"
#include "lut/multiple_scattering/spherical_harmonics.h"
#include "renderer/layers/layer_field.h"

namespace alpenglow::renderer {

std::vector<double> ReflectionOfAirAbove(const Medium& medium, double altitude_m) {
  constexpr int kStreams = 8;
  const std::size_t bands = medium.rayleigh_scattering_per_m.size();
  const std::vector<double> chi = MieLegendreCoefficients(medium, kStreams);
  const double molecules_m = MoleculeColumn_m(medium, altitude_m);
  const double aerosol_m =
      medium.mie_scale_height_m * std::exp(-altitude_m / medium.mie_scale_height_m);
  std::vector<double> reflection;
  for (std::size_t band = 0; band < bands; ++band) {
    LayerOptics molecules{.optical_depth = molecules_m * medium.rayleigh_scattering_per_m[band],
                          .chi = {1.0, 0.0, 0.1}};
    const double extinction_per_m = medium.mie_extinction_per_m[band];
    LayerOptics aerosol{.optical_depth = aerosol_m * extinction_per_m, .chi = {1.0}};
    if (extinction_per_m > 0.0)
      aerosol.albedo = medium.mie_scattering_per_m[band] / extinction_per_m;
    for (std::size_t l = 1; l <= kStreams; ++l) aerosol.chi.push_back(chi[l * bands + band]);
    const LayerStack stack({MixedLayer({molecules, aerosol})}, 0.0, kStreams);
    const double depth = stack.optics(0).optical_depth;
    const double down = LayerField::OverUniformGround(stack).Fluxes(depth).down / kPi;
    reflection.push_back(std::clamp(down, 0.0, 1.0));
  }
  return reflection;
}

}  // namespace alpenglow::renderer
