// SPDX-License-Identifier: MIT
#include "renderer/lit_clouds/air_layers.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "atmosphere/math/constants.h"
#include "lut/multiple_scattering/spherical_harmonics.h"
#include "renderer/layers/layer_field.h"
#include "renderer/layers/layer_stack.h"

namespace alpenglow::renderer {

AirLayers::AirLayers(const Medium& medium, int streams)
    : medium_(medium),
      aerosol_chi_(MieLegendreCoefficients(medium, streams)),
      degrees_(static_cast<std::size_t>(streams)) {}

double AirLayers::AerosolColumn_m(double altitude_m) const {
  const double scale_m = medium_.mie_scale_height_m;
  return scale_m * std::exp(-altitude_m / scale_m);
}

LayerOptics AirLayers::Between(const AltitudeRange& range_m, std::size_t band) const {
  const double top_m = std::min(range_m.high_m, medium_.atmosphere_height_m);
  const double low_m = std::min(range_m.low_m, top_m);
  const bool is_open = range_m.high_m >= medium_.atmosphere_height_m;
  const double molecules_m =
      MoleculeColumn_m(medium_, low_m) - (is_open ? 0.0 : MoleculeColumn_m(medium_, top_m));
  const double aerosol_m = AerosolColumn_m(low_m) - (is_open ? 0.0 : AerosolColumn_m(top_m));
  LayerOptics molecules{
      .optical_depth = std::max(molecules_m, 0.0) * medium_.rayleigh_scattering_per_m[band],
      .chi = {1.0, 0.0, 0.1}};
  const double extinction_per_m = medium_.mie_extinction_per_m[band];
  LayerOptics aerosol{.optical_depth = std::max(aerosol_m, 0.0) * extinction_per_m, .chi = {1.0}};
  if (extinction_per_m > 0.0)
    aerosol.albedo = medium_.mie_scattering_per_m[band] / extinction_per_m;
  for (std::size_t l = 1; l <= degrees_; ++l)
    aerosol.chi.push_back(aerosol_chi_[l * bands() + band]);
  return MixedLayer({molecules, aerosol});
}

std::vector<double> AirLayers::Cuts_m() const {
  const double top_m = medium_.atmosphere_height_m;
  std::vector<double> cuts_m{0.0, top_m};
  for (const double heights : {0.5, 1.0, 2.0, 4.0})
    cuts_m.push_back(heights * medium_.mie_scale_height_m);
  for (const double heights : {1.0, 2.0})
    cuts_m.push_back(heights * medium_.rayleigh_scale_height_m);
  std::sort(cuts_m.begin(), cuts_m.end());
  const auto beyond = [&](double cut_m) { return cut_m > top_m; };
  cuts_m.erase(std::remove_if(cuts_m.begin(), cuts_m.end(), beyond), cuts_m.end());
  return cuts_m;
}

std::vector<double> ReflectionOfAirAbove(const Medium& medium, double altitude_m) {
  constexpr int kStreams = 8;
  const AirLayers air(medium, kStreams);
  std::vector<double> reflection;
  for (std::size_t band = 0; band < air.bands(); ++band) {
    const LayerOptics above =
        air.Between({altitude_m, std::numeric_limits<double>::infinity()}, band);
    const LayerStack stack({above}, 0.0, kStreams);
    const double down = LayerField::OverUniformGround(stack).Fluxes(above.optical_depth).down / kPi;
    reflection.push_back(std::clamp(down, 0.0, 1.0));
  }
  return reflection;
}

}  // namespace alpenglow::renderer
