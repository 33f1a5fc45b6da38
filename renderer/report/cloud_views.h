// SPDX-License-Identifier: MIT
// Views of a field of clouds, and errors of the light in them, for the report and for studies.
//
// Errors are root mean squares relative to the traced value of a pixel, at least to a twentieth of
// the mean of its view, over pixels that clouds dim by a tenth or more. The scatter of the paths is
// subtracted. The whole is light as at a sun of 40 degrees over grass: sun + 0.036 sky + 0.012
// ground, with the sky and the ground behind the clouds.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

#include "renderer/cloud_light/cloud_light.h"
#include "renderer/cloud_light/cloud_path_tracer.h"
#include "renderer/cloud_light/cloud_tracking.h"
#include "renderer/clouds/cloud_field.h"

namespace alpenglow::renderer {

/// Returns the unit vector of an azimuth, anticlockwise from x, and an elevation.
[[nodiscard]] glm::dvec3 TowardsAzimuth(double azimuth_deg, double elevation_deg);

/// A raster of pixels.
struct CloudRaster {
  int columns, lines;
};

/// A camera in a field of clouds.
struct CloudView {
  const char* name;
  glm::dvec3 eye;
  double azimuth_deg, elevation_deg, width_deg;

  /// Returns the ray through the middle of a pixel; number 0 is at the top left.
  [[nodiscard]] CloudRay Ray(int pixel, const CloudRaster& raster) const;
};

/// Returns six views of a field: from the ground towards the sun and away from it, to the zenith,
/// from an aeroplane over the tops, from far above, and level between clouds.
[[nodiscard]] std::vector<CloudView> CloudViewsOf(const CloudField& field, double sun_azimuth_deg);

/// A pixel of a view that clouds dim by a tenth or more.
struct CloudPixel {
  std::size_t view;
  CloudRay ray;
};
[[nodiscard]] std::vector<CloudPixel> CloudPixelsOf(const CloudField& field,
                                                    const std::vector<CloudView>& views,
                                                    const CloudRaster& raster);

/// Returns the whole light of a ray.
[[nodiscard]] CloudEstimate WholeCloudLight(const CloudRadiance& light);
[[nodiscard]] double WholeCloudLight(const CloudRayLight& light, const CloudRay& ray);

/// Errors of a quantity over pixels.
class CloudErrors {
 public:
  /// @param mean  of the traced values of the pixel's view.
  void Add(double value, const CloudEstimate& truth, double mean);

  [[nodiscard]] int count() const { return count_; }
  /// Returns the root mean square without the scatter of the paths.
  [[nodiscard]] double Rms() const;
  /// Returns the sum of the values relative to that of the traced ones, less 1.
  [[nodiscard]] double Bias() const { return found_ / traced_ - 1.0; }

 private:
  double squares_ = 0.0, found_ = 0.0, traced_ = 0.0;
  int count_ = 0;
};

/// Fraction of the mean of a view that is the least denominator of errors.
inline constexpr double kDarkestCloud = 0.05;

}  // namespace alpenglow::renderer
