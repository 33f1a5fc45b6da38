// SPDX-License-Identifier: MIT
#include "renderer/report/occlusion_march.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/time_place/geodesy.h"
#include "renderer/camera/camera_rays.h"

namespace alpenglow::renderer {

ShaftView ViewWithSun(double eye_height_m, double heading_deg, double sun_elevation_deg, int width,
                      int height) {
  const CameraRays camera(CameraFromDegrees({eye_height_m, false}, heading_deg, 0.0, 0.0, 70.0),
                          width, height);
  ShaftView view{{0.0, 0.0, eye_height_m},
                 DirectionFromAngles(sun_elevation_deg * kRadiansPerDegree,
                                     (heading_deg + 20.0) * kRadiansPerDegree)
                     .xyz,
                 0.265 * kRadiansPerDegree,
                 {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) view.directions.push_back(camera.Direction(x + 0.5, y + 0.5));
  }
  return view;
}

ViewRay RayOf(const ShaftView& view, std::size_t i, double length_m) {
  const glm::dvec3& d = view.directions[i];
  return {view.eye.z, d.z, view.to_sun.z, std::clamp(glm::dot(d, view.to_sun), -1.0, 1.0),
          length_m};
}

double LengthOf(const ShaftView& view, std::size_t i, const Terrain& terrain) {
  const auto hit = terrain.Intersect(view.eye, view.directions[i]);
  return hit ? hit->distance_m : std::numeric_limits<double>::infinity();
}

double RadiusOfLight(double share) {
  constexpr double kDarkening = 0.6;
  double low = 0.0;
  double high = 1.0;
  for (int step = 0; step < 40; ++step) {
    const double rho = 0.5 * (low + high);
    const double inner = 1.0 - rho * rho;
    const double light = ((1.0 - kDarkening) * rho * rho +
                          kDarkening * 2.0 / 3.0 * (1.0 - inner * std::sqrt(inner))) /
                         (1.0 - kDarkening / 3.0);
    (light < share ? low : high) = rho;
  }
  return 0.5 * (low + high);
}

const std::vector<DiskPoint>& DiskPoints() {
  static const auto kPoints = [] {
    std::vector<DiskPoint> points;
    for (int n = 1; n <= 4096; ++n) {
      points.push_back({RadiusOfLight(std::fmod(n * 0.7548776662466927, 1.0)),
                        2.0 * kPi * std::fmod(n * 0.5698402909980532, 1.0)});
    }
    return points;
  }();
  return kPoints;
}

std::vector<float> OccludedSunlight(const ShaftView& view, const glm::dvec3& direction,
                                    const Terrain& terrain, std::span<const double> distances_m,
                                    std::size_t first) {
  const glm::dvec3 side = glm::normalize(glm::cross(view.to_sun, glm::dvec3(0.3, -0.5, 0.8)));
  const glm::dvec3 up = glm::cross(view.to_sun, side);
  const std::vector<DiskPoint>& disk = DiskPoints();
  std::vector<float> light;
  for (std::size_t i = 0; i < distances_m.size(); ++i) {
    const auto [rho, angle] = disk[(first + i) % disk.size()];
    const glm::dvec3 to_disk = glm::normalize(
        view.to_sun + view.sun_radius_rad * rho * (std::cos(angle) * side + std::sin(angle) * up));
    const bool occluded = terrain.Occluded(view.eye + distances_m[i] * direction, {0.0, 0.0, 1.0},
                                           to_disk, std::numeric_limits<double>::infinity());
    light.push_back(occluded ? 0.0F : 1.0F);
  }
  return light;
}

ScatteredOnce<float> MarchWithOcclusion(const SingleScattering<float>& air, const ShaftView& view,
                                        std::size_t i, const Terrain& terrain, int count,
                                        double offset) {
  const ViewRay ray = RayOf(view, i, LengthOf(view, i, terrain));
  const Medium& medium = air.medium();
  const RayExtent extent = ExtentOf(ray, medium.planet_radius_m, medium.atmosphere_height_m);
  const double k = std::max(extent.end_m / 30e3 - 2.0, 0.0);
  std::vector<RayNode> nodes;
  std::vector<double> distances;
  for (int s = 0; s < count; ++s) {
    const double v = (s + offset) / count;
    const double bend = 1.0 + k * (1.0 - v);
    distances.push_back(extent.end_m * v / bend);
    nodes.push_back({distances.back(), extent.end_m * (1.0 + k) / (bend * bend) / count});
  }
  RaySamples<float> samples = air.SampleAt(ray, nodes);
  const auto light = OccludedSunlight(view, view.directions[i], terrain, distances,
                                      static_cast<std::size_t>(4096.0 * offset));
  for (std::size_t s = 0; s < light.size(); ++s) samples.lit[s] *= light[s];
  return air.Scatter(samples);
}

}  // namespace alpenglow::renderer
