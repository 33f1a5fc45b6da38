// SPDX-License-Identifier: MIT
#include "renderer/report/glass_paths.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/axes_across.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/phase.h"
#include "atmosphere/reference/path_sampling.h"
#include "renderer/illumination/distant_light.h"
#include "renderer/specular/specular_sphere.h"

namespace alpenglow::renderer {
namespace {

const glm::dvec3 kToLight{0.0, 0.0, -1.0};

/// Returns the radiance of the disk in a direction, for unit irradiance across its axis as TowardsDisk
/// distributes it: evenly, apart from limb darkening, in the plane that touches the unit sphere.
double RadianceOfDisk(double radius_rad, const glm::dvec3& direction) {
  const double cosine = glm::dot(direction, kToLight);
  if (cosine <= 0.0 || radius_rad <= 0.0) return 0.0;
  const double rho = std::sqrt(std::max(0.0, 1.0 / (cosine * cosine) - 1.0)) / radius_rad;
  if (rho >= 1.0) return 0.0;
  return LimbDarkening(rho) / (kPi * radius_rad * radius_rad * cosine * cosine * cosine);
}

/// Returns the light that one path finds.
double OneGlassPath(const ThinFog& fog, double light_radius_rad, const CausticRay& ray,
                    atmosphere::reference::PathRandom& random) {
  static const SpecularSphere kBall{.radius_m = 1.0, .index = 1.5};
  const double scattered = -std::expm1(-fog.extinction_per_m * ray.length_m);
  const double t = -std::log1p(-scattered * random.Next()) / fog.extinction_per_m;
  const glm::dvec3 place = ray.eye + t * ray.direction;
  const double cosine =
      SampleCosine({.kind = PhaseKind::kHenyeyGreenstein, .g = fog.g}, random.Next());
  const double angle = 2.0 * kPi * random.Next();
  const AxesAcross across = AxesAcrossOf(ray.direction);
  const glm::dvec3 way =
      cosine * ray.direction + std::sqrt(std::max(0.0, 1.0 - cosine * cosine)) *
                                   (std::cos(angle) * across.side + std::sin(angle) * across.other);
  const std::optional<double> distance_m = DistanceTo(kBall, place, way);
  if (!distance_m) return 0.0;
  const DividedRay divided(kBall, place + *distance_m * way, way);
  const std::optional<int> order = divided.SampleOrder(random.Next());
  if (!order) return 0.0;
  return fog.albedo * scattered * std::exp(-fog.extinction_per_m * *distance_m) *
         RadianceOfDisk(light_radius_rad, divided.Leaving(*order).direction);
}

}  // namespace

double LightOfCones(const SphereCaustic& cones, const CausticRay& ray, const DiskSample& disk) {
  double sum = 0.0;
  for (std::size_t i = disk.first; i < disk.first + disk.count; ++i) {
    const auto n = static_cast<double>(i + 1);
    const glm::dvec3 to_light = TowardsDisk(
        kToLight, disk.radius_rad,
        {std::fmod(n * 0.7548776662466927, 1.0), std::fmod(n * 0.5698402909980532, 1.0)});
    // In the frame of the cones the light travels along +z.
    const AxesAcross across = AxesAcrossOf(-to_light);
    const auto turned = [&](const glm::dvec3& v) {
      return glm::dvec3(glm::dot(v, across.side), glm::dot(v, across.other),
                        -glm::dot(v, to_light));
    };
    sum += cones.Radiance(turned(ray.eye), turned(ray.direction), ray.length_m);
  }
  return sum / static_cast<double>(disk.count);
}

CloudEstimate LightOfGlassPaths(const ThinFog& fog, double light_radius_rad, const CausticRay& ray,
                                std::size_t paths, std::uint64_t seed) {
  constexpr std::size_t kInBatch = atmosphere::reference::kPathsPerBatch;
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < paths; ++i) {
    atmosphere::reference::PathRandom random(seed, i / kInBatch, i % kInBatch);
    const double light = OneGlassPath(fog, light_radius_rad, ray, random);
    sum += light;
    squares += light * light;
  }
  const auto count = static_cast<double>(paths);
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(0.0, squares / count - mean * mean) / count)};
}

}  // namespace alpenglow::renderer
