// SPDX-License-Identifier: MIT
// Free flights and transmittances along straight rays through a field of clouds, without bias.
//
// Null collisions fill the extinction sigma up to a bound m that is constant over a stretch of the
// ray (CloudField::SpanAhead). Distances between tentative collisions have the density
// m exp(-m t). A tentative collision is a true one with the probability sigma / m (Woodcock et al.
// 1965, ANL-7050, 557); the product of 1 - sigma / m over all of them is an unbiased estimate of the
// transmittance (ratio tracking: Novak, Selle and Jarosz 2014, ACM Trans. Graph. 33, 179).
//
// Distances are doubles, because a float resolves 8 mm at 100 km, more than the step beyond the
// border of a brick. A ray is followed only between the altitudes of the field's lowest and highest
// bricks, or within their box if the field is open.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/medium/phase.h"
#include "renderer/clouds/cloud_field.h"
#include "renderer/clouds/cloud_line.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Rays are followed for this distance: a level ray in a periodic field need not end.
inline constexpr double kFarthestCloud_m = 1e6;

/// A point and a direction of unit length.
struct CloudRay {
  glm::dvec3 origin{0.0}, direction{0.0, 0.0, 1.0};

  [[nodiscard]] glm::dvec3 At(double distance_m) const { return origin + distance_m * direction; }
};

/// Follows rays through a field, which must outlive the tracker. Safe to use from many threads.
class CloudTracker {
 public:
  /// @param uses_detail  whether the extinction is that with the detail below a voxel.
  /// @param scale  times the extinction, in (0, 1]: CloudOptics::extinction_scale().
  CloudTracker(const CloudField& field, bool uses_detail, double scale = 1.0)
      : field_(&field),
        bounds_(field.Bounds()),
        is_periodic_(field.lattice().is_periodic),
        uses_detail_(uses_detail),
        scale_(scale) {}

  /// Returns a tracker of the same field with another scale.
  [[nodiscard]] CloudTracker WithScale(double scale) const {
    return {*field_, uses_detail_, scale};
  }

  [[nodiscard]] double Extinction_per_m(const glm::dvec3& point) const {
    return scale_ * (uses_detail_ ? field_->DetailedExtinction_per_m(point)
                                  : field_->Extinction_per_m(point));
  }

  /// Returns the distance to the next collision; no value if there is none up to `farthest_m`.
  /// @param random  has Next(), uniform in [0, 1).
  template <typename Random>
  [[nodiscard]] std::optional<double> Collision(const CloudRay& ray, double farthest_m,
                                                Random& random) const {
    std::optional<double> found;
    EachTentative(ray, farthest_m, random, [&](double distance_m, double share) {
      if (random.Next() >= share) return true;
      found = distance_m;
      return false;
    });
    return found;
  }

  /// Returns an unbiased estimate of the transmittance up to `farthest_m`. Below kLeastFollowed it
  /// survives with probability 1/2, so that the number of steps through thick clouds is bounded.
  template <typename Random>
  [[nodiscard]] double Transmittance(const CloudRay& ray, double farthest_m, Random& random) const {
    double left = 1.0;
    EachTentative(ray, farthest_m, random, [&](double, double share) {
      left *= 1.0 - share;
      if (left >= kLeastFollowed) return true;
      left = random.Next() < 0.5 ? 2.0 * left : 0.0;
      return left > 0.0;
    });
    return left;
  }

  /// Returns the optical depth up to `farthest_m` by the two-point rule of Gauss on steps of at most
  /// `step_m`.
  [[nodiscard]] double OpticalDepth(const CloudRay& ray, double farthest_m, double step_m) const;

  /// Returns the distance at which the ray has an optical depth, by the rule of the middle on steps of
  /// `step_m`; no value if it has less.
  [[nodiscard]] std::optional<double> DistanceAt(const CloudRay& ray, double depth,
                                                 double step_m) const;

  /// Calls visit(begin_m, end_m, majorant_per_m) for the stretches of a ray with cloud, in order,
  /// until it returns false.
  template <typename Visit>
  void EachSpan(const CloudRay& ray, double farthest_m, const Visit& visit) const {
    auto [at_m, end_m] = StretchOf(ray, farthest_m);
    while (at_m < end_m) {
      const CloudSpan span = field_->SpanAhead(ray.At(at_m), ray.direction);
      const double next_m = std::min(at_m + span.length_m, end_m);
      if (span.majorant_per_m > 0.0 && !visit(at_m, next_m, scale_ * span.majorant_per_m)) return;
      at_m = next_m;
    }
  }

  /// Calls visit(begin_m, length_m, extinction_per_m) for steps along a ray, in order, until it returns
  /// false. The extinction is that in their middles. Stretches without cloud have no steps.
  /// @param step_m  the length of all steps but those at ends.
  template <typename Visit>
  void EachStep(const CloudRay& ray, double farthest_m, double step_m, const Visit& visit) const {
    if (uses_detail_) {  // it makes clouds wider than the cubes that a line takes for filled
      EachSpan(ray, farthest_m, [&](double begin_m, double end_m, double) {
        for (double at_m = begin_m; at_m < end_m; at_m += step_m) {
          const double length_m = std::min(step_m, end_m - at_m);
          if (!visit(at_m, length_m, Extinction_per_m(ray.At(at_m + 0.5 * length_m)))) return false;
        }
        return true;
      });
      return;
    }
    auto [at_m, end_m] = StretchOf(ray, farthest_m);
    CloudField::Line line(*field_, ray.origin, ray.direction);
    bool was_clear = true;
    while (at_m < end_m) {
      const double clear_m = was_clear ? line.ClearAhead_m(at_m) : 0.0;
      at_m += clear_m;
      if (clear_m > 0.0) continue;
      const double length_m = std::min(step_m, end_m - at_m);
      const double per_m = scale_ * line.At(at_m + 0.5 * length_m).extinction_per_m;
      if (!visit(at_m, length_m, per_m)) return;
      was_clear = per_m <= 0.0;
      at_m += length_m;
    }
  }

 private:
  static constexpr double kLeastFollowed = 0.1;

  /// The part of a ray between the altitudes of clouds, or in their box.
  struct Stretch {
    double begin_m, end_m;
  };
  [[nodiscard]] Stretch StretchOf(const CloudRay& ray, double farthest_m) const {
    Stretch stretch{0.0, std::min(farthest_m, kFarthestCloud_m)};
    for (int axis = is_periodic_ ? 2 : 0; axis < 3; ++axis)
      Clip(ray, axis, stretch.begin_m, stretch.end_m);
    return stretch;
  }
  /// Shortens the stretch from at_m to end_m to the part between the bounds along an axis.
  void Clip(const CloudRay& ray, int axis, double& at_m, double& end_m) const {
    const double below_m = bounds_.low[axis] - ray.origin[axis];
    const double above_m = bounds_.high[axis] - ray.origin[axis];
    const double slope = ray.direction[axis];
    if (slope == 0.0) {
      if (below_m > 0.0 || above_m <= 0.0) end_m = at_m;
      return;
    }
    at_m = std::max(at_m, std::min(below_m / slope, above_m / slope));
    end_m = std::min(end_m, std::max(below_m / slope, above_m / slope));
  }

  /// Calls visit(distance_m, share) for tentative collisions in order, until it returns false; share
  /// is the probability that the collision is a true one.
  template <typename Random, typename Visit>
  void EachTentative(const CloudRay& ray, double farthest_m, Random& random,
                     const Visit& visit) const {
    double depth = -std::log(1.0 - random.Next());  // of the bound, up to the next one
    EachSpan(ray, farthest_m, [&](double begin_m, double end_m, double majorant_per_m) {
      double at_m = begin_m;
      while (depth < (end_m - at_m) * majorant_per_m) {
        at_m += depth / majorant_per_m;
        if (!visit(at_m, Extinction_per_m(ray.At(at_m)) / majorant_per_m)) return false;
        depth = -std::log(1.0 - random.Next());
      }
      depth -= (end_m - at_m) * majorant_per_m;
      return true;
    });
  }

  const CloudField* field_;
  CloudBox bounds_;
  bool is_periodic_, uses_detail_;
  double scale_;
};

/// The optical depth along a ray, linear between nodes. Distances of first collisions that are drawn
/// from it are stratified if their fractions are.
class CloudDepths {
 public:
  /// Adds the depths of steps of at most `step_m`, by the rule of the middle, until the ray ends or
  /// the depth exceeds kDeepest.
  CloudDepths(const CloudTracker& tracker, const CloudRay& ray, double length_m, double step_m);

  /// Returns the optical depth of the ray; that beyond kDeepest is omitted.
  [[nodiscard]] double depth() const { return nodes_.empty() ? 0.0 : nodes_.back().depth; }
  /// Returns the distance of a first collision. The ray must have one: depth() > 0.
  /// @param fraction  of the collisions that are nearer, in [0, 1).
  [[nodiscard]] double Collision_m(double fraction) const;

  static constexpr double kDeepest = 16.0;

 private:
  /// The end of a step of constant extinction, and the optical depth up to it.
  struct Node {
    double begin_m, end_m, depth;
  };
  std::vector<Node> nodes_;
};

/// Returns the direction at an angle from an axis.
[[nodiscard]] glm::dvec3 TurnedFrom(const glm::dvec3& axis, double cosine, double azimuth_rad);

/// Returns a direction drawn from a phase function around a direction.
template <typename Random>
[[nodiscard]] glm::dvec3 ScatteredFrom(const glm::dvec3& direction, const PhaseFunction& phase,
                                       Random& random) {
  const double cosine = SampleCosine(phase, random.Next());
  return TurnedFrom(direction, cosine, 2.0 * kPi * random.Next());
}

}  // namespace alpenglow::renderer
