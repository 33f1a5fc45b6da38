// SPDX-License-Identifier: MIT
#include "renderer/picture/sphere_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "atmosphere/base/error.h"
#include "renderer/media/local_body.h"

namespace alpenglow::renderer {
namespace {

// Beams of the study of caustics (specular/README.md): 1e5 with this radius, relative to the sphere's.
constexpr double kStudiedPhotons = 1e5, kStudiedRadius = 0.025;
constexpr double kWidestBeam = 0.25;  // radius relative to the sphere's
constexpr double kLongestBeam = 12.0;

double LargestRadius(const std::vector<SpecularSphere>& spheres) {
  double largest_m = 0.0;
  for (const SpecularSphere& sphere : spheres) largest_m = std::max(largest_m, sphere.radius_m);
  return largest_m;
}

double BeamRadius(const SphereSurroundings& around) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const SpecularSphere& sphere : around.spheres)
    nearest_m = std::min(nearest_m, glm::length(sphere.centre - around.eye));
  const double sphere_m = LargestRadius(around.spheres);
  const double dense_m = kStudiedRadius * sphere_m * kStudiedPhotons / around.photons;
  return std::max(0.5 * around.pixel_rad * nearest_m, std::min(dense_m, kWidestBeam * sphere_m));
}

std::vector<PhotonBeam> BeamsOf(const SphereSurroundings& around) {
  const auto to_ground = [&](const glm::dvec3& origin, const glm::dvec3& direction) {
    return around.geometry.Trace(origin, direction, around.pixel_rad).distance_m;
  };
  return FollowPhotons(
      around.spheres, around.light,
      {.photons = around.photons, .longest_m = kLongestBeam * LargestRadius(around.spheres)},
      to_ground);
}

}  // namespace

std::vector<SpecularSphere> SpheresOf(const Scene& scene, const SceneGround& ground) {
  std::vector<SpecularSphere> spheres;
  for (const SceneObject& object : scene.objects) {
    Place place = object.place;
    place.height_m = 0.0;
    const double ground_m = GroundHeightUnder(ground, place);
    if (!object.height.above_ground && object.height.value_m < ground_m) {
      throw InputError(fmt::format(
          "{}.height_m is {}; the ground there is at {:.1f} m, and the underside must not be lower",
          object.name, object.height.value_m, ground_m));
    }
    const VolumePlacement at = PlacementAt(object.place, object.height, 0.0, ground);
    spheres.push_back(
        {at.bottom + object.radius_m * at.up, object.radius_m, object.material, object.index});
  }
  return spheres;
}

Caustics::Caustics(const SphereSurroundings& around, LocalMedia media)
    : irradiance_(around.irradiance), map_(BeamsOf(around), std::move(media), BeamRadius(around)) {}

Spectrum Caustics::Along(const glm::dvec3& origin, const glm::dvec3& direction,
                         double length_m) const {
  const SpectrumOf<double> per_irradiance = map_.Radiance(origin, direction, length_m);
  Spectrum light = irradiance_;
  for (std::size_t band = 0; band < light.size(); ++band)
    light[band] *= static_cast<float>(per_irradiance[band]);
  return light;
}

}  // namespace alpenglow::renderer
