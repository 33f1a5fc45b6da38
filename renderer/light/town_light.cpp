// SPDX-License-Identifier: MIT
#include "renderer/light/town_light.h"

#include <algorithm>
#include <vector>

#include "atmosphere/colour/black_body.h"
#include "atmosphere/sun/night_sky.h"

namespace alpenglow::renderer {
namespace {

/// Half sodium, half LED; the sum has a luminance of 1 cd/m^2.
BandLight LampsOfUnitLuminance(const BandColour& colour) {
  constexpr double kSodium_k = 2050.0, kLed_k = 4000.0, kShare = 0.5;
  const std::vector<double>& wavelengths_nm = colour.wavelengths_nm();
  BandLight sum(wavelengths_nm.size());
  for (const double temperature_k : {kSodium_k, kLed_k}) {
    std::vector<double> values;
    for (const double nm : wavelengths_nm) values.push_back(BlackBodyRadiance(nm, temperature_k));
    const double luminance = colour.Xyz(values)[1];
    for (std::size_t band = 0; band < sum.count; ++band)
      sum[band] += static_cast<float>(kShare * values[band] / luminance);
  }
  return sum;
}

}  // namespace

BandLight TownLight(double zenith, double ground_m, const AirIntegrator<float>& air,
                    const BandColour& colour) {
  const double wanted = std::max(
      LuminanceOfSurfaceBrightness(zenith) - LuminanceOfSurfaceBrightness(kNaturalZenith), 0.0);
  const BandLight lamps = LampsOfUnitLuminance(colour);
  const BandLight left = air.TransmittanceToSpace(ground_m, 1.0);
  BandLight seen(lamps.count);
  for (std::size_t band = 0; band < lamps.count; ++band)
    seen[band] = (1.0F - left[band]) * lamps[band];
  return static_cast<float>(wanted / colour.Xyz(InDouble(seen))[1]) * lamps;
}

}  // namespace alpenglow::renderer
