// SPDX-License-Identifier: MIT
#include "renderer/illumination/distant_light.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/axes_across.h"
#include "atmosphere/math/constants.h"

namespace alpenglow::renderer {

DistantLight SunlightOf(const SunInSky& apparent, const Medium& medium) {
  DistantLight sun{LightSource::kSun, DirectionOf(apparent), apparent.angular_radius_rad(),
                   Spectrum(medium.solar_irradiance.size())};
  for (std::size_t band = 0; band < sun.irradiance.size(); ++band) {
    sun.irradiance[band] = static_cast<float>(medium.solar_irradiance[band] /
                                              (apparent.distance_au * apparent.distance_au));
  }
  return sun;
}

glm::dvec3 TowardsDisk(const glm::dvec3& to_light, double radius_rad,
                       std::array<double, 2> sample) {
  const AxesAcross across = AxesAcrossOf(to_light);
  const double rho = radius_rad * CircleOfLight(sample[0]);
  const double angle = 2.0 * kPi * sample[1];
  return glm::normalize(to_light +
                        rho * (std::cos(angle) * across.side + std::sin(angle) * across.other));
}

LocalLight LocalLightAt(const SceneGeometry& geometry, const glm::dvec3& point,
                        const DistantLight& light) {
  const double altitude = std::max(geometry.AltitudeOf(point), 0.0);
  const double r = geometry.radius_m();
  const glm::dvec3 up = geometry.UpAt(point);
  const auto cosine = [&](const glm::dvec3& to) { return std::clamp(glm::dot(up, to), -1.0, 1.0); };
  const double horizon = -std::sqrt(altitude * (2.0 * r + altitude)) / (r + altitude);
  const VisibleDisk disk = DiskOverHorizon(cosine(light.direction.seen), horizon, light.radius_rad);
  return {altitude, up, cosine(light.direction.for_air), disk.fraction, disk.mu_s_effective};
}

}  // namespace alpenglow::renderer
