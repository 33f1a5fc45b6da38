// SPDX-License-Identifier: MIT
// What shafts are held against: light scattered once along a ray, with an occlusion ray against the
// terrain at each of many points of it, every one towards another point of the sun's disk.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <span>
#include <vector>

#include "atmosphere/constants.h"
#include "atmosphere/geodesy.h"
#include "atmosphere/single_scattering.h"
#include "atmosphere/sun.h"
#include "atmosphere/sun_disk.h"
#include "renderer/aerial_perspective.h"
#include "renderer/camera_rays.h"
#include "renderer/scene_ground.h"
#include "renderer/shadow_heights.h"

namespace alpenglow {

/// A sun, an eye over terrain and rays from it, in the frame of the terrain.
struct ShaftView {
  glm::dvec3 eye, to_sun;
  double sun_radius_rad;
  std::vector<glm::dvec3> directions;
};

/// Rays of a picture that looks `heading_deg` from north, with the sun at a bearing of 35 degrees
/// from there: some rays pass close to the sun, some far from it.
inline ShaftView ViewWithSun(double eye_height_m, double heading_deg, double sun_elevation_deg,
                             int width, int height) {
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

inline ViewRay RayOf(const ShaftView& view, std::size_t i, double length_m) {
  const glm::dvec3& d = view.directions[i];
  return {view.eye.z, d.z, view.to_sun.z, std::clamp(glm::dot(d, view.to_sun), -1.0, 1.0),
          length_m};
}

inline double LengthOf(const ShaftView& view, std::size_t i, const Terrain& terrain) {
  const auto hit = terrain.Intersect(view.eye, view.directions[i]);
  return hit ? hit->distance_m : std::numeric_limits<double>::infinity();
}

/// Distance from the disk's centre, in radii, within which a share of its light comes: inverts the
/// integral of LimbDarkening by halving.
inline double RadiusOfLight(double share) {
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

/// A point of the disk: distance from the centre in radii, and angle.
struct DiskPoint {
  double rho, angle;
};

/// Points of the plane's R2 sequence (Roberts 2018), as dense as the disk is bright.
inline const std::vector<DiskPoint>& DiskPoints() {
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

/// Sunlight, in [0, 1], that passes the terrain at points of a ray: one occlusion ray each, towards
/// the points of the disk from the `first` one on.
inline std::vector<float> OccludedSunlight(const ShaftView& view, const glm::dvec3& direction,
                                           const Terrain& terrain,
                                           std::span<const double> distances_m,
                                           std::size_t first = 0) {
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

/// Light scattered once along a ray, by `count` equal steps in a distance that is dense near the
/// eye: t = length v / (1 + k (1 - v)), with half of the steps in the first 30 km.
inline ScatteredOnce<float> MarchWithOcclusion(const AirIntegrator<float>& air,
                                               const ShaftView& view, std::size_t i,
                                               const Terrain& terrain, int count,
                                               double offset = 0.5) {
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

/// Light scattered once along the ray of a pixel, summed over bands.
struct ShaftPixel {
  double found;     // AerialPerspective with ShadowHeights
  double march;     // 512 occlusion rays
  double fine;      // 4096
  double unbroken;  // without terrain between sun and air
};

inline std::vector<ShaftPixel> MeasureShafts(const SceneGround& ground, const ShaftView& view) {
  const AirIntegrator<float> air(MediumPreset("earth"));
  DiffuseLightOptions coarse;  // not looked at
  coarse.altitudes = 4;
  coarse.sun_angles = 4;
  coarse.degree = 2;
  coarse.max_orders = 1;
  const DiffuseLight diffuse(air.medium(), coarse);
  const AerialPerspective aerial(air, diffuse);
  const ShadowHeights shadow(ground.terrain->mesh(), view.to_sun, view.sun_radius_rad);
  std::vector<ShaftPixel> pixels;
  for (std::size_t i = 0; i < view.directions.size(); ++i) {
    const ViewRay ray = RayOf(view, i, LengthOf(view, i, *ground.terrain));
    const auto light = [&](const ScatteredOnce<float>& once) {
      const Bands<float> bands = air.Inscatter(once, ray.nu);
      double sum = 0.0;
      for (std::size_t band = 0; band < bands.count; ++band)
        sum += static_cast<double>(bands[band]);
      return sum;
    };
    const SunlitPath path =
        shadow.Along(view.eye, view.directions[i], std::min(ray.length_m, 2000e3));
    const auto march = [&](double offset) {
      return light(MarchWithOcclusion(air, view, i, *ground.terrain, 512, offset));
    };
    double fine = 0.0;
    for (int k = 0; k < 8; ++k) fine += march((k + 0.5) / 8.0) / 8.0;
    pixels.push_back({light(air.Scatter(aerial.Sample(ray, &path, {}))), march(0.5), fine,
                      light(air.Scatter(aerial.Sample(ray, nullptr, {})))});
  }
  return pixels;
}

/// Errors of one way against 4096 occlusion rays, relative to the mean of the picture.
struct ShaftError {
  double rms, at_99_percent;
};

inline ShaftError ErrorOf(const std::vector<ShaftPixel>& pixels, double ShaftPixel::*way) {
  std::vector<double> error;
  double square = 0.0;
  double mean = 0.0;
  for (const ShaftPixel& pixel : pixels) {
    error.push_back(std::abs(pixel.*way - pixel.fine));
    square += error.back() * error.back() / static_cast<double>(pixels.size());
    mean += pixel.fine / static_cast<double>(pixels.size());
  }
  std::sort(error.begin(), error.end());
  return {std::sqrt(square) / mean, error[error.size() * 99 / 100] / mean};
}

}  // namespace alpenglow
