// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_gather.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace alpenglow::renderer {
namespace {

constexpr double kDeepestNode = 40.0;
constexpr double kMomentsEvery_m = 20.0;
// The optical depth to the sun is that of the middle of stretches: of this length where a ray enters,
// and longer where little of their light is left.
constexpr double kSunEvery_m = 10.0;
constexpr double kLongestSun_m = 40.0;
// A share of the depth under the surface is a safe step outside, because noise makes the depth
// steeper than distance.
constexpr double kStepOutside = 0.3;
constexpr int kHalvings = 3;
// The rest of the light of a ray is that of its beginning once this is left.
constexpr double kLeastTransmittance = 5e-3;
constexpr int kMostSteps = 20000;

}  // namespace

CloudHats CloudHatsAt(double depth_to_sun) {
  static const double per_log = (kCloudFactorNodes - 1) / std::log1p(kDeepestNode);
  const double at = per_log * std::log1p(std::clamp(depth_to_sun, 0.0, kDeepestNode));
  const auto node = std::min(static_cast<std::size_t>(at), kCloudFactorNodes - 2);
  return {node, std::min(at - static_cast<double>(node), 1.0)};
}

/// The state of the march along a ray.
struct CloudGather::March {
  March(const CloudGather& gather, const CloudRay& along, double until_m)
      : ray(along),
        end_m(until_m),
        peak(gather.optics_->peak().AtAngle(
            glm::dot(along.direction, gather.to_sun_->ToSunAt(along.origin)))),
        factors(gather.optics_->SourceFactors(-along.direction)) {}

  [[nodiscard]] glm::dvec3 At(double distance_m) const {
    return ray.origin + distance_m * ray.direction;
  }

  /// Returns the light of the whole ray. The rest of a ray that was not followed to its end is like
  /// its beginning.
  /// @param has_equilibrium  whether ground is the rest of sky.
  [[nodiscard]] CloudRayParts Finished(bool has_equilibrium) const;

  CloudRay ray;
  double end_m;
  double at_m = 0.0;
  double outside_m = 0.0;      // the last step, if it was outside of clouds
  double brick_until_m = 0.0;  // end of the brick with cloud around the ray
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

CloudRayParts CloudGather::March::Finished(bool has_equilibrium) const {
  CloudRayParts whole = parts;
  whole.transmittance = std::exp(-depth);
  if (weight > 0.0) whole.mean_distance_m = weighted_m / weight;
  if (parts.scaled_transmittance < kLeastTransmittance) {
    const double factor = 1.0 / (1.0 - parts.scaled_transmittance);
    whole.first *= factor;
    for (double& each : whole.higher) each *= factor;
    whole.sky *= factor;
    whole.ground *= factor;
    whole.transmittance = whole.scaled_transmittance = 0.0;
  }
  if (has_equilibrium) {
    whole.sky = std::min(whole.sky, 1.0 - whole.scaled_transmittance);
    whole.ground = 1.0 - whole.scaled_transmittance - whole.sky;
  }
  return whole;
}

CloudGather::CloudGather(const CloudField& field, const CloudOptics& optics,
                         const CloudSunDepths& to_sun, const CloudMoments& sun,
                         const CloudMoments& sky, const CloudMoments* ground,
                         const CloudGatherOptions& options)
    : field_(&field),
      optics_(&optics),
      to_sun_(&to_sun),
      sun_(&sun),
      sky_(&sky),
      ground_(ground),
      options_(options) {}

/// A step inside of cloud.
struct CloudGather::Inside {
  double begin_m, length_m;
  glm::dvec3 middle;

  void Add(const CloudGather& gather, March& march) const;
};

void CloudGather::Inside::Add(const CloudGather& gather, March& march) const {
  const double depth = gather.Extinction_per_m(middle) * length_m;
  if (depth <= 0.0) return;
  const CloudOptics& optics = *gather.optics_;
  const double scale = optics.extinction_scale();
  const double middle_m = begin_m + 0.5 * length_m;
  if (begin_m >= march.to_sun_until_m) {
    const double stretch_m =
        std::max(length_m, std::min(kSunEvery_m / march.parts.scaled_transmittance, kLongestSun_m));
    march.to_sun_until_m = begin_m + stretch_m;
    march.to_sun = gather.to_sun_->OpticalDepth(march.At(begin_m + 0.5 * stretch_m));
  }
  const double to_sun = march.to_sun;
  if (middle_m - march.moments_at_m > kMomentsEvery_m) {
    const CloudCells::Mixture around = gather.sun_->cells().Around(middle);
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

double CloudGather::StepInside_m(const CloudField::Sample& sample) const {
  const double per_m = optics_->extinction_scale() * sample.extinction_per_m;
  const double by_depth_m =
      std::min(options_.step_depth / std::max(per_m, 1e-9), options_.most_step_m);
  // The first metres under the surface are resolved.
  return std::max(std::min(by_depth_m, 3.0 + 0.4 * sample.depth_m), options_.least_step_m);
}

bool CloudGather::PassClearBricks(March& march) const {
  while (march.at_m >= march.brick_until_m) {
    const glm::dvec3 point = march.At(march.at_m);
    if (point.z > field_->top_altitude_m() && march.ray.direction.z >= 0.0) return false;
    const CloudSpan span = field_->SpanAhead(point, march.ray.direction);
    if (span.majorant_per_m > 0.0) {
      march.brick_until_m = march.at_m + span.length_m;
      return true;
    }
    march.at_m += span.length_m;
    march.outside_m = 0.0;
    if (!(march.at_m < march.end_m)) return false;
  }
  return true;
}

CloudField::Sample CloudGather::SampleAtSurface(March& march) const {
  double before_m = march.at_m - march.outside_m;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle_m = 0.5 * (before_m + march.at_m);
    const bool is_inside = field_->Extinction_per_m(march.At(middle_m)) > 0.0;
    (is_inside ? march.at_m : before_m) = middle_m;
  }
  return field_->SampleAt(march.At(march.at_m));
}

CloudRayParts CloudGather::Along(const CloudRay& ray, double length_m) const {
  March march(*this, ray, std::min(length_m, kFarthestCloud_m));
  for (int step = 0; step < kMostSteps && march.at_m < march.end_m; ++step) {
    if (!PassClearBricks(march)) break;
    CloudField::Sample sample = field_->SampleAt(march.At(march.at_m));
    if (sample.extinction_per_m <= 0.0) {
      const double in_brick_m = std::max(options_.least_step_m, march.brick_until_m - march.at_m);
      march.outside_m =
          std::clamp(-kStepOutside * sample.depth_m, options_.least_step_m, in_brick_m);
      march.at_m += march.outside_m;
      continue;
    }
    if (march.outside_m > 1.5 * options_.least_step_m) sample = SampleAtSurface(march);
    march.outside_m = 0.0;
    const double step_m = std::min(StepInside_m(sample), march.end_m - march.at_m);
    Inside{march.at_m, step_m, march.At(march.at_m + 0.5 * step_m)}.Add(*this, march);
    march.at_m += step_m;
    if (march.parts.scaled_transmittance < kLeastTransmittance) break;
  }
  return march.Finished(ground_ == nullptr);
}

}  // namespace alpenglow::renderer
