// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_gather.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "renderer/clouds/cloud_line.h"

namespace alpenglow::renderer {
namespace {

constexpr double kDeepestNode = 40.0;
// Nodes of light along a ray are this far apart where it enters, and further where little of their
// light is left.
constexpr double kNodesEvery_m = 40.0, kFarthestNode_m = 80.0;
// A share of the depth under the surface is a safe step outside of cloud but near it, because noise
// makes the depth steeper than distance.
constexpr double kStepOutside = 0.3;
// The light of the rest of a ray is that of its beginning once this is left; its transmittance is 0
// once that is left, which hides the disc of the sun behind an optical depth of 11.
constexpr double kLeastLit = 0.02;
constexpr double kLeastTransmittance = 5e-3;
constexpr int kMostSteps = 20000;

}  // namespace

CloudHats CloudHatsAt(double depth_to_sun) {
  static const double per_log = (kCloudFactorNodes - 1) / std::log1p(kDeepestNode);
  const double at = per_log * std::log1p(std::clamp(depth_to_sun, 0.0, kDeepestNode));
  const auto node = std::min(static_cast<std::size_t>(at), kCloudFactorNodes - 2);
  return {node, std::min(at - static_cast<double>(node), 1.0)};
}

/// Light and the optical depth to the sun at a place of a ray.
struct CloudGather::Node {
  double at_m = -1.0;
  double to_sun = 0.0;
  double sun = 0.0, sky = 0.0, ground = 0.0;  // sources of higher orders

  [[nodiscard]] static Node Between(const Node& one, const Node& other, double at_m) {
    const double share = (at_m - one.at_m) / (other.at_m - one.at_m);
    return {at_m, std::lerp(one.to_sun, other.to_sun, share), std::lerp(one.sun, other.sun, share),
            std::lerp(one.sky, other.sky, share), std::lerp(one.ground, other.ground, share)};
  }
};

/// The state of the march along a ray.
struct CloudGather::March {
  March(const CloudGather& gather, const CloudRay& along, double until_m)
      : ray(along),
        line(*gather.field_, along.origin, along.direction),
        end_m(until_m),
        factors(gather.optics_->SourceFactors(-along.direction)) {
    parts.once.cos_scattering = glm::dot(along.direction, gather.to_sun_->ToSunAt(along.origin));
    peak = gather.optics_->peak().AtAngle(parts.once.cos_scattering);
  }

  /// Returns the light of the whole ray. The rest of a ray that was not followed to its end is like
  /// its beginning.
  /// @param has_equilibrium  whether ground is the rest of sky.
  [[nodiscard]] CloudRayParts Finished(bool has_equilibrium) const;

  CloudRay ray;
  CloudField::Line line;
  double end_m;
  double at_m = 0.0;
  ForwardPeak::Angle peak;
  CloudHarmonics factors;
  CloudRayParts parts{};
  double depth = 0.0;  // to the eye, not scaled
  double lit = 0.0;    // share of the ray's light so far
  double weighted_m = 0.0;
  Node before, after;  // around the place of the march
};

CloudRayParts CloudGather::March::Finished(bool has_equilibrium) const {
  CloudRayParts whole = parts;
  whole.transmittance = std::exp(-depth);
  if (parts.scaled_transmittance < kLeastTransmittance) {
    whole.transmittance = whole.scaled_transmittance = 0.0;
  }
  if (lit > 0.0) {
    whole.mean_distance_m = weighted_m / lit;
    const double factor = (1.0 - whole.scaled_transmittance) / lit;
    whole.first *= factor;
    for (double& each : whole.once.by_depth) each *= factor;
    for (double& each : whole.higher) each *= factor;
    whole.sky *= factor;
    whole.ground *= factor;
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

CloudGather::Node CloudGather::NodeAt(const March& march, double at_m) const {
  const glm::dvec3 point = march.ray.At(at_m);
  const CloudCells::Mixture around = sun_->cells().Around(point);
  const auto source = [&](const CloudMoments* moments) {
    if (moments == nullptr) return 0.0;
    return std::max(0.0, static_cast<double>(moments->Source(around, march.factors)));
  };
  return {at_m, to_sun_->OpticalDepth(point), source(sun_), source(sky_), source(ground_)};
}

/// A step inside of cloud.
struct CloudGather::Inside {
  double begin_m, length_m, extinction_per_m;

  /// Adds the light of the step, and what it leaves of the light behind.
  void Add(const CloudGather& gather, March& march) const;

 private:
  [[nodiscard]] double middle_m() const { return begin_m + 0.5 * length_m; }
  /// Moves on the nodes until the middle is between them.
  void MoveNodes(const CloudGather& gather, March& march) const;
};

void CloudGather::Inside::MoveNodes(const CloudGather& gather, March& march) const {
  if (middle_m() <= march.after.at_m) return;
  march.before = begin_m <= march.after.at_m ? march.after : gather.NodeAt(march, begin_m);
  const double apart_m =
      std::min(kNodesEvery_m / march.parts.scaled_transmittance, kFarthestNode_m);
  march.after = gather.NodeAt(march, std::max(march.before.at_m + apart_m, begin_m + length_m));
}

void CloudGather::Inside::Add(const CloudGather& gather, March& march) const {
  const double depth = extinction_per_m * length_m;
  if (depth <= 0.0) return;
  const CloudOptics& optics = *gather.optics_;
  const double scale = optics.extinction_scale();
  const double passed = march.parts.scaled_transmittance;
  const double left = std::exp(-scale * depth);
  if (passed >= kLeastLit) {
    MoveNodes(gather, march);
    const Node light = Node::Between(march.before, march.after, middle_m());
    const double share = passed * (1.0 - left);
    const double beam = share * optics.scaled_albedo() * std::exp(-scale * light.to_sun);
    const double peak_depth = (1.0 - scale) * (light.to_sun + march.depth + 0.5 * depth);
    march.parts.first += beam * march.peak.Effective(peak_depth);
    march.parts.once.Add(beam, peak_depth);
    const CloudHats hats = CloudHatsAt(light.to_sun);
    march.parts.higher[hats.node] += share * light.sun * (1.0 - hats.share);
    march.parts.higher[hats.node + 1] += share * light.sun * hats.share;
    march.parts.sky += share * light.sky;
    march.parts.ground += share * light.ground;
    march.lit += share;
    march.weighted_m += share * middle_m();
  }
  march.depth += depth;
  march.parts.scaled_transmittance *= left;
}

double CloudGather::LayerLength_m(const CloudRay& ray) const {
  const double last_m =
      ray.direction.z >= 0.0 ? field_->top_altitude_m() : field_->base_altitude_m();
  const double rise_m = last_m - ray.origin.z;
  if (ray.direction.z == 0.0) return rise_m > 0.0 ? kFarthestCloud_m : 0.0;
  return std::max(rise_m / ray.direction.z, 0.0);
}

double CloudGather::StepInside_m(const CloudField::Sample& sample) const {
  const double per_m = optics_->extinction_scale() * sample.extinction_per_m;
  const double by_depth_m =
      std::min(options_.step_depth / std::max(per_m, 1e-9), options_.most_step_m);
  // The first metres under the surface are resolved.
  return std::max(std::min(by_depth_m, 3.0 + 0.4 * sample.depth_m), options_.least_step_m);
}

CloudRayParts CloudGather::Along(const CloudRay& ray, double length_m) const {
  March march(*this, ray, std::min({length_m, LayerLength_m(ray), kFarthestCloud_m}));
  CloudField::Sample sample{};
  for (int step = 0; step < kMostSteps && march.at_m < march.end_m; ++step) {
    if (sample.extinction_per_m <= 0.0) {
      const double clear_m = march.line.ClearAhead_m(march.at_m);
      if (clear_m > 0.0) {
        march.at_m += clear_m;
        continue;
      }
      sample = march.line.At(march.at_m);
      if (sample.extinction_per_m <= 0.0) {
        march.at_m += std::max(-kStepOutside * sample.depth_m, options_.least_step_m);
        continue;
      }
    }
    const double step_m = std::min(StepInside_m(sample), march.end_m - march.at_m);
    // The middle of a step tells how long the next one may be.
    const double middle_m = march.at_m + 0.5 * step_m;
    sample = march.line.At(middle_m);
    const double per_m = options_.uses_detail ? field_->DetailedExtinction_per_m(ray.At(middle_m))
                                              : sample.extinction_per_m;
    Inside{march.at_m, step_m, per_m}.Add(*this, march);
    march.at_m += step_m;
    if (march.parts.scaled_transmittance < kLeastTransmittance) break;
  }
  return march.Finished(ground_ == nullptr);
}

}  // namespace alpenglow::renderer
