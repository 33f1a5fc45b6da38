// SPDX-License-Identifier: MIT
#include "renderer/ground/ground_heights.h"

#include <algorithm>

namespace alpenglow::renderer {
namespace {

constexpr double kReach_m = 20000.0;  // over any mountain, under any trench

/// The vertical of a place in a frame.
glm::dvec3 UpAt(const LocalFrame& frame, const GeodeticPosition& place) {
  const LocalFrame there(frame.ellipsoid(), place);
  return frame.EnuFromEcef(there.EcefFromEnu(Vector<Enu>{glm::dvec3(0.0, 0.0, 1.0)})).xyz;
}

/// The first surface under a point that is so far over another.
std::optional<SurfaceUnder> SeenFrom(const Terrain& terrain, const glm::dvec3& point,
                                     const glm::dvec3& up, double over_m) {
  const auto hit = terrain.Intersect(point + over_m * up, -up);
  if (!hit) return std::nullopt;
  return SurfaceUnder{*hit, over_m - hit->distance_m};
}

}  // namespace

std::optional<GroundHeights> GroundHeightsAlong(const Terrain& terrain, const glm::dvec3& point,
                                                const glm::dvec3& up) {
  const auto from_above = terrain.Intersect(point + kReach_m * up, -up, 2.0 * kReach_m);
  if (!from_above) return std::nullopt;
  const double highest_m = kReach_m - from_above->distance_m;
  const auto from_below = terrain.Intersect(point - kReach_m * up, up, 2.0 * kReach_m);
  // One ray may meet an edge that the other just passes: the surface that one has met exists.
  const double lowest_m = from_below ? from_below->distance_m - kReach_m : highest_m;
  return GroundHeights{std::min(lowest_m, highest_m), highest_m};
}

std::optional<GroundHeights> GroundHeightsAt(const Terrain& terrain, const LocalFrame& frame,
                                             const GeodeticPosition& place) {
  GeodeticPosition foot = place;
  foot.height_m = 0.0;
  return GroundHeightsAlong(terrain, frame.EnuFromGeodetic(foot).xyz, UpAt(frame, foot));
}

std::optional<SurfaceUnder> SurfaceUnderPoint(const Terrain& terrain, const glm::dvec3& point,
                                              const glm::dvec3& up) {
  constexpr double kRounding_m = 0.02;  // what stands on a surface is not under it
  const auto below = SeenFrom(terrain, point, up, kRounding_m);
  return below ? below : SeenFrom(terrain, point, up, kReach_m);
}

std::optional<double> GroundUnderEye(const Terrain& terrain, const LocalFrame& frame,
                                     const GeodeticPosition& place) {
  const auto surface =
      SurfaceUnderPoint(terrain, frame.EnuFromGeodetic(place).xyz, UpAt(frame, place));
  if (!surface) return std::nullopt;
  return place.height_m + surface->height_m;
}

}  // namespace alpenglow::renderer
