// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_light_fluxes.h"

#include <tbb/parallel_for.h>

#include <cstddef>

#include "atmosphere/base/error.h"
#include "renderer/cloud_light/cloud_plane_rays.h"

namespace alpenglow::renderer {
namespace {

/// The fluxes through one rectangle of both planes.
class ColumnOfRays {
 public:
  ColumnOfRays(const CloudLight& light, const glm::dvec2& low, const glm::dvec2& size)
      : light_(light),
        rays_(light.field(), low, size, light.sun().to_sun(), light.optics().phase()) {}

  /// @param first  number of the first point of Halton's sequences.
  [[nodiscard]] CloudLightFluxes Fluxes(int first, int rays) const {
    const double mu_s = light_.sun().to_sun().z;
    CloudLightFluxes sum;
    for (int i = first + 1; i <= first + rays; ++i) {
      const CloudPlaneRay from_top = rays_.FromTop(i), from_base = rays_.FromBase(i);
      const CloudRayLight above = light_.Radiance(from_top.ray);
      sum.up_at_top +=
          from_top.weight * above.sun + above.scaled_transmittance * ReflectedByGround();
      sum.direct_at_base += mu_s * light_.SunTransmittance(from_base.ray.origin);
      if (from_base.weight > 0.0)
        sum.down_at_base += from_base.weight * light_.Radiance(from_base.ray).sun;
    }
    const double per_ray = 1.0 / (rays * mu_s);
    return {per_ray * sum.up_at_top, per_ray * sum.direct_at_base, per_ray * sum.down_at_base};
  }

 private:
  /// Returns the mean flux from the ground upwards.
  [[nodiscard]] double ReflectedByGround() const {
    const CloudGroundIrradiance& irradiance = light_.ground_irradiance();
    return light_.ground_albedo() * (irradiance.direct + irradiance.diffuse);
  }

  const CloudLight& light_;
  CloudPlaneRays rays_;
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
