// SPDX-License-Identifier: MIT
#include "renderer/light/star_lights.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/colour/black_body.h"
#include "atmosphere/number/constants.h"
#include "atmosphere/sun/apparent_place.h"
#include "atmosphere/sun/stars.h"
#include "atmosphere/sun/sun.h"

namespace alpenglow::renderer {
namespace {

glm::dvec3 Refracted(const glm::dvec3& enu, const BentView& view) {
  const double elevation = std::asin(std::clamp(enu.z, -1.0, 1.0));
  return DirectionFromAngles(view.LiftedElevationOf(elevation), std::atan2(enu.x, enu.y)).xyz;
}

StarLight LightOf(const PointLight& point, const glm::dvec3& direction, const BandColour& colour) {
  const std::vector<double>& wavelengths_nm = colour.wavelengths_nm();
  const double temperature = TemperatureOf(point.colour_index);
  BandLight spectrum(wavelengths_nm.size());
  for (std::size_t band = 0; band < spectrum.count; ++band)
    spectrum[band] = static_cast<float>(1e6 * BlackBodyRadiance(wavelengths_nm[band], temperature));
  const double of_spectrum = colour.Xyz(InDouble(spectrum))[1];
  const double lux = IlluminanceOf(point.magnitude);
  return {direction, static_cast<float>(lux / of_spectrum) * spectrum, lux};
}

/// As the earth turns under the stars.
glm::dvec3 After(const glm::dvec3& ecef, double seconds) {
  const double turned = -kEarthRotation_rad_per_s * seconds;
  const double c = std::cos(turned), s = std::sin(turned);
  return {c * ecef.x - s * ecef.y, s * ecef.x + c * ecef.y, ecef.z};
}

}  // namespace

OpenShutter OpenFor(double open_s, double pixel_angle_rad) {
  // An arc of t is t^2 / 8 off its chord.
  const double step_rad = std::sqrt(8.0 * 0.1 * pixel_angle_rad);
  const double turned_rad = kEarthRotation_rad_per_s * open_s;
  return {open_s, static_cast<int>(std::ceil(turned_rad / step_rad))};
}

double FaintestStar(double lux, double pixel_angle_rad) {
  constexpr double kUnseenStar = 1e-3;
  return MagnitudeOf(kUnseenStar * pixel_angle_rad * pixel_angle_rad / kPi * lux);
}

std::vector<StarLight> StarLightsOver(const GeodeticPosition& eye, const UtcInstant& instant,
                                      const BentView& view, const BandColour& colour,
                                      double faintest, const OpenShutter& shutter) {
  const LocalFrame local(kWgs84, eye);
  std::vector<StarLight> lights;
  const auto add = [&](const PointLight& point) {
    if (point.magnitude > faintest) return;
    const auto seen_after = [&](double seconds) {
      const Vector<Ecef> ecef{After(point.direction.xyz, seconds)};
      return Refracted(local.EnuFromEcef(ecef).xyz, view);
    };
    lights.push_back(LightOf(point, seen_after(0.0), colour));
    for (int i = 0; shutter.steps > 0 && i <= shutter.steps; ++i)
      lights.back().way.push_back(seen_after(shutter.open_s * (i / double(shutter.steps) - 0.5)));
  };
  for (const PointLight& planet : PlanetsAt(eye, instant)) add(planet);
  for (const PointLight& star : StarsAt(instant, faintest)) add(star);
  return lights;
}

}  // namespace alpenglow::renderer
