// SPDX-License-Identifier: MIT
#include "renderer/report/cloud_views.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/math/constants.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

constexpr double kSkyShare = 0.036, kGroundShare = 0.012;
constexpr double kLeastPixelDepth = 0.1;

}  // namespace

glm::dvec3 TowardsAzimuth(double azimuth_deg, double elevation_deg) {
  const double a = azimuth_deg * kRadiansPerDegree, e = elevation_deg * kRadiansPerDegree;
  return {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)};
}

CloudRay CloudView::Ray(int pixel, const CloudRaster& raster) const {
  const int column = pixel % raster.columns, line = pixel / raster.columns;
  const glm::dvec3 forward = TowardsAzimuth(azimuth_deg, elevation_deg);
  const glm::dvec3 right = TowardsAzimuth(azimuth_deg - 90.0, 0.0);
  const glm::dvec3 up = glm::cross(right, forward);
  const double half = std::tan(0.5 * width_deg * kRadiansPerDegree);
  const double x = half * (2.0 * (column + 0.5) / raster.columns - 1.0);
  const double y = half * raster.lines / raster.columns * (1.0 - 2.0 * (line + 0.5) / raster.lines);
  return {eye, glm::normalize(forward + x * right + y * up)};
}

std::vector<CloudView> CloudViewsOf(const CloudField& field, double sun_azimuth_deg) {
  const double base_m = field.base_altitude_m(), top_m = field.top_altitude_m();
  return {{"ground, to sun", {3000, 5000, 2}, sun_azimuth_deg, 25, 60},
          {"ground, from sun", {3000, 5000, 2}, sun_azimuth_deg + 180, 25, 60},
          {"zenith", {9000, 9000, 2}, 100, 88, 60},
          {"flight", {5000, 12000, top_m + 300}, 110, -12, 60},
          {"above", {12000, 6000, 8000}, 250, -70, 50},
          {"level", {15000, 15000, base_m + 400}, 300, 2, 50}};
}

std::vector<CloudPixel> CloudPixelsOf(const CloudField& field, const std::vector<CloudView>& views,
                                      const CloudRaster& raster) {
  const CloudTracker tracker(field, false);
  std::vector<CloudPixel> pixels;
  for (std::size_t view = 0; view < views.size(); ++view) {
    for (int i = 0; i < raster.columns * raster.lines; ++i) {
      const CloudRay ray = views[view].Ray(i, raster);
      if (tracker.OpticalDepth(ray, 2e5, 4.0) >= kLeastPixelDepth) pixels.push_back({view, ray});
    }
  }
  return pixels;
}

CloudEstimate WholeCloudLight(const CloudRadiance& light) {
  return {light.sun.value + kSkyShare * light.sky.value + kGroundShare * light.ground.value,
          std::hypot(light.sun.standard_error, kSkyShare * light.sky.standard_error,
                     kGroundShare * light.ground.standard_error)};
}

double WholeCloudLight(const CloudRayLight& light, const CloudRay& ray) {
  const bool is_upward = ray.direction.z >= 0.0;
  return light.sun + kSkyShare * (light.sky + (is_upward ? light.scaled_transmittance : 0.0)) +
         kGroundShare * (light.ground + (is_upward ? 0.0 : light.scaled_transmittance));
}

void CloudErrors::Add(double value, const CloudEstimate& truth, double mean) {
  const double scale = std::max(truth.value, kDarkestCloud * mean);
  squares_ +=
      (std::pow(value - truth.value, 2) - std::pow(truth.standard_error, 2)) / (scale * scale);
  found_ += value;
  traced_ += truth.value;
  ++count_;
}

double CloudErrors::Rms() const { return std::sqrt(std::max(0.0, squares_ / count_)); }

}  // namespace alpenglow::renderer
