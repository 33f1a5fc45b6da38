// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_low_sun.h"

#include <fmt/format.h>

#include <algorithm>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

constexpr double kHighestLowSun_deg = 10.0;
// Far away, where only what is left of the light matters, steps are longer.
constexpr double kStepPerDistance = 0.02, kMostStep = 4.0;

double LowElevation_rad(const glm::dvec3& to_sun) {
  if (!(std::abs(glm::length(to_sun) - 1.0) <= 1e-6)) {
    throw InputError("the direction from clouds to the sun must be a unit vector");
  }
  const double elevation_rad = std::atan2(to_sun.z, glm::length(glm::dvec2(to_sun)));
  const double elevation_deg = elevation_rad / kRadiansPerDegree;
  if (!(elevation_deg >= kLowestCloudLight_deg - 1e-9 &&
        elevation_deg <= kHighestLowSun_deg + 1e-9)) {
    throw InputError(
        fmt::format("the sun over clouds is at {} degrees; its beams are followed from {} to {} "
                    "degrees",
                    elevation_deg, kLowestCloudLight_deg, kHighestLowSun_deg));
  }
  return elevation_rad;
}

}  // namespace

CloudLowSun::CloudLowSun(const CloudField& field, const glm::dvec3& to_sun,
                         const CloudLowSunOptions& options)
    : to_sun_(to_sun),
      tracker_(field, false),
      low_m_(field.base_altitude_m()),
      high_m_(field.top_altitude_m()),
      elevation_rad_(LowElevation_rad(to_sun)),
      place_m_(options.place_m),
      per_radius_(1.0 / RequireInRange(options.planet_radius_m, 1e5, 1e9,
                                       "the radius of the planet under clouds [m]")),
      step_m_(RequireInRange(options.step_m, 1.0, 100.0, "the step of a beam in clouds [m]")),
      farthest_m_(RequireInRange(options.farthest_m, 1e3, 4e5,
                                 "the distance where beams in clouds end [m]")),
      full_m_(RequireInRange(options.full_m, 0.0, 4e5,
                             "the distance up to which clouds shade in full [m]")) {
  azimuth_ = glm::normalize(glm::dvec2(to_sun));
}

glm::dvec3 CloudLowSun::ToSunAt(const glm::dvec3& point) const {
  const double elevation_rad = ElevationAt_rad(point);
  return {std::cos(elevation_rad) * azimuth_, std::sin(elevation_rad)};
}

CloudBeam::Part CloudLowSun::Below(double altitude_m, double slope) const {
  const double square = slope * slope + 2.0 * per_radius_ * altitude_m;
  if (square <= 0.0) return {0.0, 0.0};
  // One root is the quotient of the other by their product, without cancellation.
  const double sum = -(slope + std::copysign(std::sqrt(square), slope));
  const double one_m = sum / per_radius_, other_m = -2.0 * altitude_m / sum;
  return {std::max(0.0, std::min(one_m, other_m)), std::max(0.0, std::max(one_m, other_m))};
}

CloudBeam CloudLowSun::BeamFrom(const glm::dvec3& point, double slope) const {
  const CloudBeam::Part layer = Below(high_m_ - point.z, slope);
  const CloudBeam::Part gap = Below(low_m_ - point.z, slope);
  CloudBeam beam{point, azimuth_, slope, per_radius_, layer, {0.0, 0.0}, 0.0};
  if (!gap.is_empty()) {
    beam.first.end_m = std::min(gap.begin_m, layer.end_m);
    beam.returned = {std::max(gap.end_m, layer.begin_m), layer.end_m};
    const double left_m = farthest_m_ - beam.returned.begin_m;
    if (left_m > 0.0) {
      beam.returning =
          beam.returned.begin_m <= full_m_ ? 1.0 : std::min(1.0, left_m / (farthest_m_ - full_m_));
    }
  }
  if (beam.first.begin_m >= farthest_m_) beam.first = {0.0, 0.0};
  return beam;
}

double CloudLowSun::OpticalDepthOf(const CloudBeam& beam, const CloudBeam::Part& part,
                                   double most_depth) const {
  double depth = 0.0;
  EachChord(beam, part, [&](const CloudRay& ray, double length_m) {
    const double away_m = glm::length(ray.origin - beam.from);
    const double most_m = std::clamp(kStepPerDistance * away_m, step_m_, kMostStep * step_m_);
    tracker_.EachSpan(ray, length_m, [&](double begin_m, double end_m, double) {
      const double steps = std::ceil((end_m - begin_m) / most_m);
      const double step_m = (end_m - begin_m) / steps;
      for (double i = 0.0; i < steps && depth < most_depth; ++i) {
        depth += step_m * tracker_.Extinction_per_m(ray.At(begin_m + (i + 0.5) * step_m));
      }
      return depth < most_depth;
    });
    return depth < most_depth;
  });
  return depth;
}

double CloudLowSun::OpticalDepth(const glm::dvec3& point, double slope) const {
  const CloudBeam beam = BeamFrom(point, slope);
  const double first = OpticalDepthOf(beam, beam.first);
  return WithReturned(beam, first,
                      [&] { return OpticalDepthOf(beam, beam.returned, kDeepest - first); });
}

}  // namespace alpenglow::renderer
