// SPDX-License-Identifier: MIT
#include "renderer/clouds/cloud_gather.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace alpenglow::renderer {
namespace {

constexpr double kDeepestNode = 40.0;
constexpr double kMomentsEvery_m = 20.0;
// The optical depth to the sun is that of the middle of stretches of this length.
constexpr double kSunEvery_m = 10.0;
// A share of the depth under the surface is a safe step outside, because noise makes the depth
// steeper than distance.
constexpr double kStepOutside = 0.3;
constexpr int kHalvings = 3;
// The rest of the light of a ray is that of its beginning once this is left.
constexpr double kLeastTransmittance = 5e-3;
constexpr int kMostSteps = 20000;
// Bent rays are followed in pieces that deviate from their tangent by less than 0.4 m on Earth.
constexpr double kStraight_m = 2000.0;

}  // namespace

CloudHats CloudHatsAt(double depth_to_sun) {
  static const double per_log = (kCloudFactorNodes - 1) / std::log1p(kDeepestNode);
  const double at = per_log * std::log1p(std::clamp(depth_to_sun, 0.0, kDeepestNode));
  const auto node = std::min(static_cast<std::size_t>(at), kCloudFactorNodes - 2);
  return {node, std::min(at - static_cast<double>(node), 1.0)};
}

/// What is known along a ray.
struct CloudGather::March {
  March(const CloudGather& gather, const CloudRay& along)
      : ray(along),
        bend_per_m(0.5 / gather.options_.planet_radius_m),
        peak(gather.optics_->peak().AtAngle(glm::dot(along.direction, gather.map_->to_sun()))),
        factors(gather.optics_->SourceFactors(-along.direction)) {}

  [[nodiscard]] glm::dvec3 At(double at_m) const {
    return ray.origin + glm::dvec3(0.0, 0.0, bend_per_m * at_m * at_m) + at_m * ray.direction;
  }
  [[nodiscard]] glm::dvec3 DirectionAt(double at_m) const {
    if (bend_per_m == 0.0) return ray.direction;
    return glm::normalize(ray.direction + glm::dvec3(0.0, 0.0, 2.0 * bend_per_m * at_m));
  }

  CloudRay ray;
  double bend_per_m;
  ForwardPeak::Angle peak;
  CloudHarmonics factors;
  CloudRayParts parts{};
  double depth = 0.0;   // to the eye, not scaled
  double weight = 0.0;  // of all light so far
  double weighted_m = 0.0;
  double to_sun = 0.0, to_sun_until_m = -1.0;  // the optical depth, and where its stretch ends
  // Light of higher orders at the last place of moments.
  double moments_at_m = -1e9, sun = 0.0, sky = 0.0, ground = 0.0;
};

CloudGather::CloudGather(const CloudField& field, const CloudOptics& optics, const CloudSunMap& map,
                         const CloudMoments& sun, const CloudMoments& sky,
                         const CloudMoments* ground, const CloudGatherOptions& options)
    : field_(&field),
      optics_(&optics),
      map_(&map),
      sun_(&sun),
      sky_(&sky),
      ground_(ground),
      options_(options) {}

/// A step inside of cloud.
struct CloudGather::Inside {
  double middle_m, length_m;
  glm::dvec3 point;

  void Add(const CloudGather& gather, March& march) const;
};

void CloudGather::Inside::Add(const CloudGather& gather, March& march) const {
  const double depth = gather.Extinction_per_m(point) * length_m;
  if (depth <= 0.0) return;
  const CloudOptics& optics = *gather.optics_;
  const double scale = optics.extinction_scale();
  const double begin_m = middle_m - 0.5 * length_m;
  if (begin_m >= march.to_sun_until_m) {
    const double stretch_m = std::max(length_m, kSunEvery_m);
    march.to_sun_until_m = begin_m + stretch_m;
    march.to_sun =
        OpticalDepthToSun(*gather.field_, *gather.map_, march.At(begin_m + 0.5 * stretch_m));
  }
  const double to_sun = march.to_sun;
  if (middle_m - march.moments_at_m > kMomentsEvery_m) {
    const CloudCells::Mixture around = gather.sun_->cells().Around(point);
    march.moments_at_m = middle_m;
    march.sun = std::max(0.0, static_cast<double>(gather.sun_->Source(around, march.factors)));
    march.sky = std::max(0.0, static_cast<double>(gather.sky_->Source(around, march.factors)));
    if (gather.ground_ != nullptr) {
      march.ground =
          std::max(0.0, static_cast<double>(gather.ground_->Source(around, march.factors)));
    }
  }
  const double passed = march.parts.scaled_transmittance;
  const double left = std::exp(-scale * depth);
  const double share = passed * (1.0 - left);
  const double peak_share = 1.0 - scale;
  march.parts.first += share * optics.scaled_albedo() * std::exp(-scale * to_sun) *
                       march.peak.Effective(peak_share * (to_sun + march.depth + 0.5 * depth));
  const CloudHats hats = CloudHatsAt(to_sun);
  march.parts.higher[hats.node] += share * march.sun * (1.0 - hats.share);
  march.parts.higher[hats.node + 1] += share * march.sun * hats.share;
  march.parts.sky += share * march.sky;
  march.parts.ground += share * march.ground;
  march.weight += share;
  march.weighted_m += share * middle_m;
  march.depth += depth;
  march.parts.scaled_transmittance *= left;
}

double CloudGather::StepInside_m(const glm::dvec3& point, double depth_m) const {
  const double per_m = optics_->extinction_scale() * field_->Extinction_per_m(point);
  const double by_depth_m =
      std::min(options_.step_depth / std::max(per_m, 1e-9), options_.most_step_m);
  // The first metres under the surface are resolved.
  return std::max(std::min(by_depth_m, 3.0 + 0.4 * depth_m), options_.least_step_m);
}

CloudRayParts CloudGather::Along(const CloudRay& ray, double length_m) const {
  March march(*this, ray);
  const double end_m = std::min(length_m, kFarthestCloud_m);
  const double top_m = field_->top_altitude_m();
  double at_m = 0.0, outside_m = 0.0;  // the last step outside
  double brick_until_m = 0.0;          // end of the brick with cloud around the ray
  for (int step = 0; step < kMostSteps && at_m < end_m; ++step) {
    glm::dvec3 point = march.At(at_m);
    if (at_m >= brick_until_m) {
      const glm::dvec3 direction = march.DirectionAt(at_m);
      if (point.z > top_m && direction.z >= 0.0) break;
      const CloudSpan span = field_->SpanAhead(point, direction);
      if (span.majorant_per_m == 0.0) {
        if (march.bend_per_m == 0.0 && !(span.length_m < end_m - at_m)) break;
        at_m += march.bend_per_m == 0.0 ? span.length_m : std::min(span.length_m, kStraight_m);
        outside_m = 0.0;
        continue;
      }
      brick_until_m = at_m + span.length_m;
    }
    double depth_m = field_->SignedDepth_m(point);
    if (depth_m <= 0.0) {
      outside_m = std::min(std::max(options_.least_step_m, -kStepOutside * depth_m),
                           std::max(options_.least_step_m, brick_until_m - at_m));
      at_m += outside_m;
      continue;
    }
    if (outside_m > 1.5 * options_.least_step_m) {
      double before_m = at_m - outside_m;
      for (int i = 0; i < kHalvings; ++i) {
        const double middle_m = 0.5 * (before_m + at_m);
        (field_->SignedDepth_m(march.At(middle_m)) > 0.0 ? at_m : before_m) = middle_m;
      }
      point = march.At(at_m);
      depth_m = field_->SignedDepth_m(point);
    }
    outside_m = 0.0;
    const double step_m = std::min(StepInside_m(point, depth_m), end_m - at_m);
    const double middle_m = at_m + 0.5 * step_m;
    Inside{middle_m, step_m, march.At(middle_m)}.Add(*this, march);
    at_m += step_m;
    if (march.parts.scaled_transmittance < kLeastTransmittance) break;
  }
  CloudRayParts& parts = march.parts;
  parts.transmittance = std::exp(-march.depth);
  if (march.weight > 0.0) parts.mean_distance_m = march.weighted_m / march.weight;
  if (parts.scaled_transmittance < kLeastTransmittance) {
    const double whole = 1.0 / (1.0 - parts.scaled_transmittance);
    parts.first *= whole;
    for (double& each : parts.higher) each *= whole;
    parts.sky *= whole;
    parts.ground *= whole;
    parts.transmittance = parts.scaled_transmittance = 0.0;
  }
  if (ground_ == nullptr) {
    parts.sky = std::min(parts.sky, 1.0 - parts.scaled_transmittance);
    parts.ground = 1.0 - parts.scaled_transmittance - parts.sky;
  }
  return parts;
}

}  // namespace alpenglow::renderer
