// SPDX-License-Identifier: MIT
#include "renderer/path_tracing/scene_path_tracer.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <utility>

#include "renderer/lit_clouds/cloud_chords.h"

namespace alpenglow::renderer {
namespace {

using atmosphere::reference::PathMeeting;
using atmosphere::reference::PathScatterer;
using atmosphere::reference::PathSurface;

constexpr double kNoEnd_m = std::numeric_limits<double>::infinity();

/// Returns how far a point of the ground is moved off its surface, which is known in single precision
/// [m].
double OffSurface_m(const glm::dvec3& point) { return 0.02 + 1e-6 * glm::length(point); }

}  // namespace

ScenePathTracer::ScenePathTracer(const TracedScene& scene)
    : scene_(scene),
      centre_to_origin_(0.0, 0.0, scene.medium.planet_radius_m),
      to_sun_(scene.light.source.direction.for_air),
      air_(scene.medium, to_sun_, this) {
  if (scene_.clouds == nullptr) return;
  for (std::size_t i = 0; i < scene_.clouds->size(); ++i) {
    const CloudField& field = (*scene_.clouds)[i].field;
    layers_.push_back({&field, CloudTracker(field, false),
                       AltitudeRange{field.base_altitude_m(), field.top_altitude_m()},
                       scene_.phases[i]});
  }
}

SpectrumOf<double> ScenePathTracer::OnePath(const glm::dvec3& origin, const glm::dvec3& direction,
                                            PathRandom& random) const {
  const std::vector<double> light = air_.OnePath(origin + centre_to_origin_, direction, random);
  SpectrumOf<double> radiance(light.size());
  std::copy(light.begin(), light.end(), radiance.values().begin());
  return radiance;
}

atmosphere::reference::PathTracedRadiance ScenePathTracer::Radiance(
    const glm::dvec3& origin, const glm::dvec3& direction,
    const atmosphere::reference::PathOptions& options) const {
  return air_.Radiance(origin + centre_to_origin_, direction, options);
}

std::optional<ScenePathTracer::Collision> ScenePathTracer::CollisionOn(const glm::dvec3& origin,
                                                                       const glm::dvec3& direction,
                                                                       double length_m,
                                                                       PathRandom& random) const {
  std::optional<Collision> first;
  for (const Layer& layer : layers_) {
    const double within_m = first ? first->distance_m : length_m;
    for (const CloudChord& chord :
         ChordsWithin(layer.range, origin, direction, within_m, scene_.medium.planet_radius_m)) {
      const CloudRay ray{chord.origin, chord.direction};
      const auto along_m = layer.tracker.Collision(ray, chord.length_m, random);
      if (!along_m) continue;
      const double radius_um = layer.field->EffectiveRadius_um(ray.At(*along_m));
      first = Collision{chord.OnRay(*along_m), &layer.phases.Drawn(radius_um, random.Next()),
                        layer.field->single_scattering_albedo()};
      break;
    }
  }
  return first;
}

std::optional<Hit> ScenePathTracer::TerrainWithin(const glm::dvec3& origin,
                                                  const glm::dvec3& direction,
                                                  std::optional<double> length_m) const {
  if (!scene_.ground.terrain) return std::nullopt;
  if (length_m && !scene_.ground.terrain->Intersect(origin, direction, *length_m))
    return std::nullopt;
  const Hit hit = scene_.geometry.Trace(origin, direction, scene_.pixel_angle_rad);
  if (hit.kind != HitKind::kTerrain || hit.distance_m > length_m.value_or(kNoEnd_m))
    return std::nullopt;
  return hit;
}

PathMeeting ScenePathTracer::OnSurface(const Hit& hit, const glm::dvec3& direction) const {
  const SeenGround seen = scene_.ground_light.SeenFrom(hit, -direction, scene_.light);
  const glm::dvec3 outward = glm::dot(hit.geometric_normal, direction) > 0.0 ? -hit.geometric_normal
                                                                             : hit.geometric_normal;
  const glm::dvec3 point = hit.smooth_point + OffSurface_m(hit.point) * outward;
  const auto& albedo = seen.albedo.values();
  return {hit.distance_m, PathSurface{point + centre_to_origin_, seen.hit.normal,
                                      std::vector<double>(albedo.begin(), albedo.end())}};
}

std::optional<PathMeeting> ScenePathTracer::Meet(const PathSegment& segment,
                                                 PathRandom& random) const {
  const glm::dvec3 origin = InScene(segment.origin);
  const auto cloud = CollisionOn(origin, segment.direction, segment.length_m, random);
  const auto before_m = cloud ? std::optional(cloud->distance_m) : std::nullopt;
  if (const auto hit = TerrainWithin(origin, segment.direction, before_m))
    return OnSurface(*hit, segment.direction);
  if (cloud) return PathMeeting{cloud->distance_m, PathScatterer{cloud->phase, cloud->albedo}};
  if (!segment.ends_on_planet) return std::nullopt;
  const glm::dvec3 point = origin + segment.length_m * segment.direction;
  const glm::dvec3 up = scene_.geometry.UpAt(point);
  return OnSurface({HitKind::kPlanet, segment.length_m, up, up, up, point, point,
                    segment.length_m * scene_.pixel_angle_rad},
                   segment.direction);
}

double ScenePathTracer::SunTransmittance(const glm::dvec3& point, PathRandom& random) const {
  const glm::dvec3 origin = InScene(point);
  if (scene_.ground.terrain &&
      scene_.ground.terrain->Occluded(origin, scene_.geometry.UpAt(origin), to_sun_, kNoEnd_m))
    return 0.0;
  double left = 1.0;
  for (const Layer& layer : layers_) {
    for (const CloudChord& chord :
         ChordsWithin(layer.range, origin, to_sun_, kNoEnd_m, scene_.medium.planet_radius_m)) {
      left *= layer.tracker.Transmittance({chord.origin, chord.direction}, chord.length_m, random);
      if (left == 0.0) return 0.0;
    }
  }
  return left;
}

const PhaseFunction* ScenePathTracer::SunLobe(PathRandom& random) const {
  constexpr double kTypicalRadius_um = 10.0;
  if (layers_.empty()) return nullptr;
  const auto layer = static_cast<std::size_t>(random.Next() * static_cast<double>(layers_.size()));
  return &layers_[layer].phases.Drawn(kTypicalRadius_um, 0.0);
}

}  // namespace alpenglow::renderer
