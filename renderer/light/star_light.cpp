// SPDX-License-Identifier: MIT
#include "renderer/light/star_light.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/colour/black_body.h"
#include "atmosphere/sun/planets.h"
#include "atmosphere/sun/refraction.h"
#include "atmosphere/sun/stars.h"
#include "atmosphere/sun/sun.h"

namespace alpenglow {
namespace {

BandLight IrradianceOf(const PointLight& point, const std::vector<double>& wavelengths_nm,
                       const BandColour& colour) {
  BandLight spectrum(wavelengths_nm.size());
  const double temperature_k = TemperatureOf(point.colour_index);
  for (std::size_t band = 0; band < spectrum.count; ++band) {
    spectrum[band] =
        static_cast<float>(1e6 * BlackBodyRadiance(wavelengths_nm[band], temperature_k));
  }
  const double of_spectrum = colour.Xyz(InDouble(spectrum))[1];
  return static_cast<float>(IlluminanceOf(point.magnitude) / of_spectrum) * spectrum;
}

}  // namespace

std::vector<StarLight> StarLightsOver(const GeodeticPosition& eye, const UtcInstant& instant,
                                      double faintest, const MoonDisk& moon,
                                      const std::vector<double>& wavelengths_nm,
                                      const BandColour& colour) {
  const LocalFrame local(kWgs84, eye);
  std::vector<StarLight> lights;
  const auto add = [&](const PointLight& point) {
    if (point.magnitude > faintest) return;
    const glm::dvec3 enu = local.EnuFromEcef(point.direction).xyz;
    const double elevation = std::asin(std::clamp(enu.z, -1.0, 1.0));
    const glm::dvec3 seen =
        DirectionFromAngles(elevation + RefractionFromHeight(elevation, eye.height_m),
                            std::atan2(enu.x, enu.y))
            .xyz;
    if (glm::length(seen - moon.to_moon) < moon.radius_rad) return;
    lights.push_back({seen, IrradianceOf(point, wavelengths_nm, colour)});
  };
  for (const PointLight& planet : PlanetsAt(eye, instant)) add(planet);
  for (const PointLight& star : StarsAt(instant, faintest)) add(star);
  return lights;
}

}  // namespace alpenglow
