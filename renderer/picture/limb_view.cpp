// SPDX-License-Identifier: MIT
#include "renderer/picture/limb_view.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/refraction/refracted_view.h"

namespace alpenglow::renderer {

LimbView::LimbView(const SceneGeometry& geometry, const Medium& medium, const CameraRays& camera,
                   const PixelFilter& filter)
    : up_(geometry.UpAt(camera.eye())),
      bending_air_(GentleAirOf(medium)),
      radius_m_(geometry.radius_m()),
      altitude_m_(geometry.AltitudeOf(camera.eye())),
      top_m_(medium.atmosphere_height_m),
      pixel_rad_(camera.PixelAngle()),
      filter_rad_(filter.radius() * pixel_rad_),
      molecules_m_(medium.rayleigh_scale_height_m),
      haze_m_(std::min(medium.mie_scale_height_m, molecules_m_)) {
  constexpr double kThinHaze = 0.05;  // relative to the molecules
  const std::size_t middle = medium.wavelengths_nm.size() / 2;
  const double haze = medium.mie_extinction_per_m[middle];
  const double molecules = kThinHaze * medium.rayleigh_scattering_per_m[middle];
  hazy_below_m_ = haze > molecules && haze_m_ < molecules_m_
                      ? std::log(haze / molecules) / (1.0 / haze_m_ - 1.0 / molecules_m_)
                      : 0.0;
}

bool LimbView::IsSteepAt(const glm::dvec3& direction) const {
  constexpr double kSteep = 0.15;
  const double mu = glm::dot(direction, up_);
  if (mu >= 0.0) return false;
  const double eye_m = radius_m_ + altitude_m_;
  const double lowest_m = altitude_m_ - eye_m * mu * mu / (1.0 + std::sqrt(1.0 - mu * mu));
  const double distance_m = -eye_m * mu;
  if (lowest_m - filter_rad_ * distance_m > top_m_) return false;
  const double scale_m = lowest_m < hazy_below_m_ ? haze_m_ : molecules_m_;
  return pixel_rad_ * distance_m > kSteep * scale_m;
}

double LimbView::GroundCosine(double mu) const {
  const double eye_m = radius_m_ + altitude_m_;
  const double square =
      (eye_m * mu * eye_m * mu - altitude_m_ * (eye_m + radius_m_)) / (radius_m_ * radius_m_);
  return mu < 0.0 && square > 0.0 ? std::sqrt(square) : 0.0;
}

}  // namespace alpenglow::renderer
