// SPDX-License-Identifier: MIT
// Media that scatter the light of photon beams to a ray: columns along lines, and light scattered once.
//
// The light that a beam of power P per area sends to the origin of a ray from a short piece dt of it is
//
//   dL = dt P sum over media m  density_m sigma_s,m p_m(cos)  exp(-sum over m  sigma_t,m N_m)
//
// N_m is the column of medium m along the beam and from there along the ray. Columns along both are
// taken at knots and are linear between.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "renderer/media/local_media.h"
#include "renderer/specular/box_tree.h"
#include "renderer/specular/photon_beams.h"

namespace alpenglow::renderer {

/// Columns of all media along a ray, over a stretch of it.
class ColumnsOnRay {
 public:
  /// Columns are 0 at distance 0. @param span  where they will be asked for.
  ColumnsOnRay(const LocalMedia& media, const glm::dvec3& origin, const glm::dvec3& direction,
               const RaySpan& span);
  /// Returns the column of one medium up to a distance in the stretch [m].
  [[nodiscard]] double At(std::size_t medium, double distance_m) const;

 private:
  static constexpr std::size_t kSteps = 32;
  std::size_t media_;
  double begin_m_, per_step_;
  std::vector<double> column_m_;  // [knot][medium]
};

/// Returns the optical depth of a beam in the band where it is deepest.
[[nodiscard]] double LargestDepth(const LocalMedia& media, const PhotonBeam& beam);

/// Light of beams at a point.
struct ScatteredBeam {
  const glm::dvec3& point;
  double cos_scattering;              // from the beam towards the origin of the ray
  double weight;                      // dt P
  std::span<const double> columns_m;  // N_m
};

/// Adds up the light of beams on one ray.
class ScatteredLight {
 public:
  explicit ScatteredLight(const LocalMedia& media);
  void Add(const ScatteredBeam& beam);
  /// Returns the sum in all bands.
  [[nodiscard]] SpectrumOf<double> Sum() const;

 private:
  const LocalMedia& media_;
  bool is_grey_;  // bands are alike: the first one is computed
  SpectrumOf<double> sum_;
};

/// A ray of finite or infinite length. @param direction  unit, away from the origin.
struct SearchedRay {
  const glm::dvec3 &origin, &direction;
  double length_m;
};

/// Returns the light of beams or points whose boxes a ray meets.
/// @param add  add(number, columns on the ray, room for a column of each medium, light) adds that of one.
template <typename Add>
[[nodiscard]] SpectrumOf<double> LightOfBoxes(const BoxTree& tree, const LocalMedia& media,
                                              const SearchedRay& ray, const Add& add) {
  ScatteredLight light(media);
  const BoxRay in_boxes(ray.origin, ray.direction, ray.length_m);
  const std::optional<RaySpan> span = in_boxes.Within(tree.Bounds());
  if (!span || media.IsEmpty()) return light.Sum();
  const ColumnsOnRay on_ray(media, ray.origin, ray.direction, *span);
  std::vector<double> columns_m(media.all().size());
  tree.VisitAlong(in_boxes, [&](std::uint32_t number) { add(number, on_ray, columns_m, light); });
  return light.Sum();
}

}  // namespace alpenglow::renderer
