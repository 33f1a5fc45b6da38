// SPDX-License-Identifier: MIT
#include "renderer/picture/sphere_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "atmosphere/base/error.h"
#include "renderer/media/local_body.h"

namespace alpenglow::renderer {
namespace {

// Radii of the study of caustics (specular/README.md), relative to that of the sphere. With 1e5 photons
// beams fill the picture, and points have an error of 14 %. The noise of beams depends on their number
// times their radius, that of points on the square of the radius.
constexpr double kStudiedPhotons = 1e5, kStudiedBeam = 0.025, kStudiedPoint = 0.2;
constexpr double kWidest = 0.25;
constexpr double kLongestBeam = 12.0, kFarthestGround = 200.0;
// 360 of 1e5 photons.
constexpr double kStudiedSpot = 0.06;

double LargestRadius(const std::vector<SpecularSphere>& spheres) {
  double largest_m = 0.0;
  for (const SpecularSphere& sphere : spheres) largest_m = std::max(largest_m, sphere.radius_m);
  return largest_m;
}

/// Returns the radius of beams or points.
double MapRadius(const SphereSurroundings& around) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const SpecularSphere& sphere : around.spheres)
    nearest_m = std::min(nearest_m, glm::length(sphere.centre - around.eye));
  const double few = kStudiedPhotons / around.photons;
  const double dense =
      around.map == PhotonMap::kBeams ? kStudiedBeam * few : kStudiedPoint * std::sqrt(few);
  return std::max(0.5 * around.pixel_rad * nearest_m,
                  std::min(dense, kWidest) * LargestRadius(around.spheres));
}

std::vector<PhotonBeam> BeamsOf(const SphereSurroundings& around) {
  const auto to_ground = [&](const glm::dvec3& origin, const glm::dvec3& direction) {
    return around.geometry.Trace(origin, direction, around.pixel_rad).distance_m;
  };
  return FollowPhotons(
      around.spheres, around.light,
      {.photons = around.photons, .longest_m = kFarthestGround * LargestRadius(around.spheres)},
      to_ground);
}

/// Returns the radius of spots on the ground.
double SpotRadius(const SphereSurroundings& around) {
  const double dense = kStudiedSpot * std::sqrt(kStudiedPhotons / around.photons);
  return std::min(dense, kWidest) * LargestRadius(around.spheres);
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

std::optional<Caustics::MediaMap> Caustics::MapOf(const SphereSurroundings& around,
                                                  const std::optional<LocalMedia>& media,
                                                  std::vector<PhotonBeam> beams) {
  if (!media) return std::nullopt;
  const double longest_m = kLongestBeam * LargestRadius(around.spheres);
  for (PhotonBeam& beam : beams) beam.length_m = std::min(beam.length_m, longest_m);
  const double radius_m = MapRadius(around);
  if (around.map == PhotonMap::kPoints) return PointMap(beams, *media, radius_m);
  return BeamMap(std::move(beams), *media, radius_m);
}

Caustics::Caustics(const SphereSurroundings& around, const std::optional<LocalMedia>& media,
                   std::vector<PhotonBeam> beams)
    : irradiance_(around.irradiance),
      on_ground_(beams, SpotRadius(around)),
      in_media_(MapOf(around, media, std::move(beams))) {}

Caustics::Caustics(const SphereSurroundings& around, const std::optional<LocalMedia>& media)
    : Caustics(around, media, BeamsOf(around)) {}

Spectrum Caustics::OnGround(const glm::dvec3& point) const {
  return static_cast<float>(on_ground_.Irradiance(point)) * irradiance_;
}

Spectrum Caustics::Along(const glm::dvec3& origin, const glm::dvec3& direction,
                         double length_m) const {
  if (!in_media_) return Spectrum(irradiance_.size());
  const SpectrumOf<double> per_irradiance = std::visit(
      [&](const auto& map) { return map.Radiance(origin, direction, length_m); }, *in_media_);
  Spectrum light = irradiance_;
  for (std::size_t band = 0; band < light.size(); ++band)
    light[band] *= static_cast<float>(per_irradiance[band]);
  return light;
}

}  // namespace alpenglow::renderer
