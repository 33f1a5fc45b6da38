// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_light_fluxes.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/medium/phase.h"

namespace alpenglow::renderer {
namespace {

/// Returns the direction at an angle from an axis.
glm::dvec3 AroundAxis(const glm::dvec3& axis, double cosine, double azimuth_rad) {
  const glm::dvec3 other = std::abs(axis.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 side = glm::normalize(glm::cross(axis, other));
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  return glm::normalize(cosine * axis + sine * (std::cos(azimuth_rad) * side +
                                                std::sin(azimuth_rad) * glm::cross(axis, side)));
}

/// The fluxes through one rectangle of both planes.
class ColumnOfRays {
 public:
  ColumnOfRays(const CloudLight& light, const glm::dvec2& low, const glm::dvec2& size)
      : light_(light), low_(low), size_(size), bounds_(light.field().Bounds()) {}

  /// @param first  number of the first point of Halton's sequences.
  [[nodiscard]] CloudLightFluxes Fluxes(int first, int rays) const {
    const glm::dvec3 to_sun = light_.sun().to_sun();
    CloudLightFluxes sum;
    for (int i = first + 1; i <= first + rays; ++i) {
      const glm::dvec2 place = low_ + size_ * glm::dvec2(Halton(i, 2), Halton(i, 3));
      const double cosine = std::sqrt(Halton(i, 5)), azimuth_rad = 2.0 * kPi * Halton(i, 7);
      const CloudRay from_top{{place, bounds_.high.z},
                              AroundAxis({0.0, 0.0, -1.0}, cosine, azimuth_rad)};
      const CloudRayLight above = light_.Radiance(from_top);
      sum.up_at_top += kPi * above.sun + above.scaled_transmittance * ReflectedByGround();
      const CloudRay from_base{{place, bounds_.low.z}, UpwardsFromBase(i, cosine, azimuth_rad)};
      sum.direct_at_base += to_sun.z * light_.SunTransmittance(from_base.origin);
      const double up = from_base.direction.z;
      if (up <= 0.0) continue;
      const double density = 0.5 * up / kPi + 0.5 * Phase(light_.optics().phase(),
                                                          glm::dot(from_base.direction, to_sun));
      sum.down_at_base += light_.Radiance(from_base).sun * up / density;
    }
    const double per_ray = 1.0 / (rays * to_sun.z);
    return {per_ray * sum.up_at_top, per_ray * sum.direct_at_base, per_ray * sum.down_at_base};
  }

 private:
  /// Returns the mean flux from the ground upwards.
  [[nodiscard]] double ReflectedByGround() const {
    const CloudGroundIrradiance& irradiance = light_.ground_irradiance();
    return light_.ground_albedo() * (irradiance.direct + irradiance.diffuse);
  }
  [[nodiscard]] glm::dvec3 UpwardsFromBase(int i, double cosine, double azimuth_rad) const {
    if (Halton(i, 11) < 0.5) return AroundAxis({0.0, 0.0, 1.0}, cosine, azimuth_rad);
    const double from_sun = SampleCosine(light_.optics().phase(), Halton(i, 13));
    return AroundAxis(light_.sun().to_sun(), from_sun, azimuth_rad);
  }

  const CloudLight& light_;
  glm::dvec2 low_, size_;
  CloudBox bounds_;
};

}  // namespace

std::vector<CloudLightFluxes> GatheredFluxes(const CloudLight& light,
                                             const CloudLightFluxOptions& options) {
  for (const int count : options.columns) {
    RequireInRange(count, 1.0, 4096.0, "columns of fluxes of clouds along an axis");
  }
  RequireInRange(options.rays_per_column, 1.0, 1e7, "rays per column of fluxes of clouds");
  const CloudLattice& lattice = light.field().lattice();
  const glm::dvec2 size =
      glm::dvec2(lattice.size_m()) / glm::dvec2(options.columns[0], options.columns[1]);
  const int columns = options.columns[0] * options.columns[1];
  std::vector<CloudLightFluxes> fluxes(static_cast<std::size_t>(columns));
  tbb::parallel_for(0, columns, [&](int column) {
    const glm::dvec2 at(column % options.columns[0], column / options.columns[0]);
    const ColumnOfRays rays(light, glm::dvec2(lattice.origin_m) + at * size, size);
    // Columns begin at different points of the sequences.
    fluxes[static_cast<std::size_t>(column)] =
        rays.Fluxes(column * 1009 % 1000003, options.rays_per_column);
  });
  return fluxes;
}

}  // namespace alpenglow::renderer
