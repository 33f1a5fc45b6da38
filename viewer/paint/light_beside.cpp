// SPDX-License-Identifier: MIT
#include "viewer/paint/light_beside.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/number/constants.h"
#include "atmosphere/ray/single_scattering.h"
#include "lut/sky/sky_view.h"
#include "viewer/paint/painted_view.h"
#include "viewer/shaders/uniform_blocks.h"

namespace alpenglow {
namespace {

std::vector<glm::vec4> SkyOf(const SkyView& view, const KeyLight& light) {
  std::vector<double> azimuths;
  for (int column = 0; column < LightBeside::kColumns; ++column)
    azimuths.push_back(2.0 * kPi * (column + 0.5) / LightBeside::kColumns - light.disk.azimuth_rad);
  const SkyAzimuths prepared(view, azimuths);
  std::vector<float> row(prepared.count() * view.stride());
  std::vector<glm::vec4> sky;
  for (int i = 0; i < LightBeside::kRows; ++i) {
    view.FillRow(kPi * (1.0 - (i + 0.5) / LightBeside::kRows), prepared, row);
    for (std::size_t column = 0; column < prepared.count(); ++column) {
      glm::vec4 radiance(0.0F);
      for (std::size_t band = 0; band < view.bands(); ++band)
        radiance[static_cast<glm::length_t>(band)] = row[column * view.stride() + band];
      sky.push_back(light.irradiance * radiance);
    }
  }
  return sky;
}

}  // namespace

LightBeside LightBesideOf(const KeyLight& light, const GeodeticPosition& eye,
                          const SolvedAir& air) {
  const AirIntegrator<float> integrator(OnOsculatingSphere(air.medium, eye.latitude_rad));
  const double altitude_m = std::max(eye.height_m, 0.0);
  const double mu = std::sin(light.disk.elevation_rad);
  const SkyView view(integrator, air.diffuse, altitude_m, mu);
  LightBeside beside{SkyOf(view, light),
                     light.irradiance * GpuBandsOf(air.diffuse.SkyIrradiance(altitude_m, mu)),
                     glm::vec4(0.0F), glm::vec3(DirectionToSun(light.disk))};
  if (mu > 0.0)
    beside.direct = light.irradiance * GpuBandsOf(integrator.TransmittanceToSpace(altitude_m, mu));
  return beside;
}

}  // namespace alpenglow
