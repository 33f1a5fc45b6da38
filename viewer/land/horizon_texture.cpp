// SPDX-License-Identifier: MIT
#include "viewer/land/horizon_texture.h"

#include <cmath>

#include "atmosphere/number/constants.h"
#include "viewer/gl/render_target.h"

namespace alpenglow::viewer {

// Nodes are the middles of texels.
PlaceOnGrid PlaceOnGridOf(const HeightRaster& grid, const LocalFrame& of_grid,
                          const LocalFrame& of_places) {
  const auto turned = [&](const glm::dvec3& axis) {
    return of_grid.EnuFromEcef(of_places.EcefFromEnu(Vector<Enu>{axis})).xyz;
  };
  const glm::dvec3 x = turned({1.0, 0.0, 0.0}), y = turned({0.0, 1.0, 0.0}),
                   z = turned({0.0, 0.0, 1.0});
  const glm::dvec3 origin = of_grid.EnuFromGeodetic(of_places.origin()).xyz;
  const auto row = [&](glm::length_t axis, double first_m, int nodes) {
    const double scale = 1.0 / (grid.cell_m * nodes);
    return glm::vec4(
        glm::dvec4(x[axis], y[axis], z[axis], origin[axis] - first_m + 0.5 * grid.cell_m) * scale);
  };
  return {row(0, grid.first_x_m, grid.columns), row(1, grid.first_y_m, grid.rows)};
}

void HorizonTexture::Use(const TerrainHorizon& horizon) {
  if (horizon_ && horizon_->map == horizon.map) return;
  horizon_ = horizon;
  azimuth_rad_ = std::nullopt;
}

PlaceOnGrid HorizonTexture::PlaceIn(const LocalFrame& anchor) const {
  if (!horizon_) return {};
  return PlaceOnGridOf(horizon_->map->grid(), horizon_->frame, anchor);
}

void HorizonTexture::Upload(double azimuth_rad) {
  const HeightRaster sines = horizon_->map->Towards(azimuth_rad);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_R32F, sines.columns, sines.rows, 0, GL_RED, GL_FLOAT,
               sines.z_m.data());
  ClampAndFilter(GL_TEXTURE_2D, true);
  azimuth_rad_ = azimuth_rad;
}

void HorizonTexture::Bind(int unit, const Vector<Ecef>& to_sun) {
  constexpr double kTurns_rad = 0.1 * kRadiansPerDegree;
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D, texture_.id());
  if (!horizon_) return;
  const glm::dvec3 direction = horizon_->frame.EnuFromEcef(to_sun).xyz;
  const double azimuth_rad = std::atan2(direction.y, direction.x);
  if (!azimuth_rad_ ||
      std::abs(std::remainder(azimuth_rad - *azimuth_rad_, 2.0 * kPi)) > kTurns_rad)
    Upload(azimuth_rad);
}

}  // namespace alpenglow::viewer
