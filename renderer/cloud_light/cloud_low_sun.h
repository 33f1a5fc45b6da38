// SPDX-License-Identifier: MIT
// Optical depth from any point to a sun near the horizon, over a round planet.
//
// Beams of a sun below 3 degrees stay in a layer of clouds for tens of kilometres and pass a field many
// times. At the distance s along the ground from a point of altitude z, where the sun stands at the
// elevation e, the altitude of its beam is
//
//   z(s) = z + s tan e + s^2 / (2 R)
//
// with the radius R of the planet: the surface falls away below the beam. (The next term is
// 5 s^4 / (24 R^3) for e = 0, 21 m at 400 km.) A sun below the horizontal is seen by high clouds, and
// lights them from below: its beams sink out of the layer, and cross it again far away. They are
// followed up to there in chords of 2 km, which leave the parabola by 0.08 m. Fields repeat in x, y
// and z of this frame, as if their plane were bent over the planet. A layer that goes on so far would
// always shade itself from a sun below the horizontal; from one distance to another a beam that returns
// therefore meets it with less and less probability. With the transmittance T of the crossing and the
// share w that is left at the distance where it begins, 1 - w (1 - T) of the light passes. A sharp end
// would draw a line on the layer, from which on the beams of points return beyond the end; less
// extinction would too, because a crossing has an optical depth of hundreds.
//
// The sun is higher by s / R for points nearer to it. The ground does not end a beam.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <variant>

#include "renderer/cloud_light/cloud_sun_map.h"
#include "renderer/cloud_light/cloud_tracking.h"
#include "renderer/clouds/cloud_field.h"

namespace alpenglow::renderer {

/// The lowest sun for clouds: clouds at 15 km see it at the horizon of the sea.
inline constexpr double kLowestCloudLight_deg = -4.0;

struct CloudLowSunOptions {
  glm::dvec2 place_m{0.0};           // where the sun has the given direction
  double planet_radius_m = 6.371e6;  // in [1e5, 1e9]; 7/6 of it for rays in refracting air
  double step_m = 20.0;              // in cloud, in [1, 100]; up to four times as long far away
  /// Distance along the ground beyond which beams that enter the layer meet no clouds, in [1e3, 4e5].
  /// The share of beams that meet clouds when they return falls from one at `full_m` to none there.
  double farthest_m = 4e5;
  double full_m = 4e5;  // in [0, 4e5]; from farthest_m on, the share falls sharply
};

/// The way of light from the sun to a point, seen from there: a parabola, by the distance along the
/// ground.
struct CloudBeam {
  /// A part of the beam; empty if end_m <= begin_m.
  struct Part {
    double begin_m, end_m;

    [[nodiscard]] bool is_empty() const { return end_m <= begin_m; }
  };

  [[nodiscard]] glm::dvec3 At(double distance_m) const {
    return {glm::dvec2(from) + distance_m * azimuth,
            from.z + distance_m * (slope + 0.5 * distance_m * per_radius)};
  }
  [[nodiscard]] double SlopeAt(double distance_m) const { return slope + distance_m * per_radius; }

  glm::dvec3 from;
  glm::dvec2 azimuth;  // unit vector to the sun on the ground
  double slope;        // at the point
  double per_radius;
  Part first, returned;  // between the altitudes of the field
  double returning;      // share of beams that meet clouds when they return
};

/// Immutable; safe to use from many threads. The field must outlive it.
class CloudLowSun {
 public:
  /// Throws InputError for options out of range and a sun below kLowestCloudLight_deg or above 10
  /// degrees.
  /// @param to_sun  unit vector.
  CloudLowSun(const CloudField& field, const glm::dvec3& to_sun,
              const CloudLowSunOptions& options = {});

  /// Returns the unit vector to the sun from the place, and from a point.
  [[nodiscard]] const glm::dvec3& to_sun() const { return to_sun_; }
  [[nodiscard]] glm::dvec3 ToSunAt(const glm::dvec3& point) const;
  /// Returns the tangent of the sun's elevation at the place, and at a point.
  [[nodiscard]] double slope() const { return std::tan(elevation_rad_); }
  [[nodiscard]] double SlopeAt(const glm::dvec3& point) const {
    return std::tan(ElevationAt_rad(point));
  }
  /// Returns the same at a distance from the place towards the sun.
  [[nodiscard]] double SlopeAfter(double distance_m) const {
    return std::tan(elevation_rad_ + distance_m * per_radius_);
  }
  [[nodiscard]] const glm::dvec2& azimuth() const { return azimuth_; }
  [[nodiscard]] double per_radius() const { return per_radius_; }
  [[nodiscard]] double farthest_m() const { return farthest_m_; }

  /// Returns the optical depth from a point to the sun, at most kDeepest: where it is reached, the
  /// beam ends.
  [[nodiscard]] double OpticalDepth(const glm::dvec3& point) const {
    return OpticalDepth(point, SlopeAt(point));
  }
  /// Returns the same as if the sun were as high as over the place, so that a periodic field has
  /// periodic light.
  [[nodiscard]] double OpticalDepthAsAtPlace(const glm::dvec3& point) const {
    return OpticalDepth(point, slope());
  }
  /// Returns the same for a slope of the beam at the point.
  [[nodiscard]] double OpticalDepth(const glm::dvec3& point, double slope) const;

  /// Returns an unbiased estimate of the transmittance along the same beam.
  /// @param random  has Next(), uniform in [0, 1).
  template <typename Random>
  [[nodiscard]] double Transmittance(const glm::dvec3& point, Random& random) const;

  static constexpr double kDeepest = 32.0;

  [[nodiscard]] CloudBeam BeamFrom(const glm::dvec3& point, double slope) const;
  /// Returns the optical depth of a part of a beam; it ends where `most_depth` is reached.
  [[nodiscard]] double OpticalDepthOf(const CloudBeam& beam, const CloudBeam::Part& part,
                                      double most_depth = kDeepest) const;
  /// Returns the optical depth of a beam from those of its parts. @param returned  returns that of
  /// the returned part; it is called only where this matters.
  template <typename Returned>
  [[nodiscard]] static double WithReturned(const CloudBeam& beam, double first,
                                           const Returned& returned);

 private:
  static constexpr double kChord_m = 2000.0;

  [[nodiscard]] double ElevationAt_rad(const glm::dvec3& point) const {
    return elevation_rad_ + glm::dot(glm::dvec2(point) - place_m_, azimuth_) * per_radius_;
  }
  /// Returns where a beam is below an altitude, relative to the point where its slope is given: between
  /// the roots of a parabola that opens upwards.
  [[nodiscard]] CloudBeam::Part Below(double altitude_m, double slope) const;
  /// Calls visit(ray, length_m) for chords of a part of a beam, in order, until it returns false.
  template <typename Visit>
  void EachChord(const CloudBeam& beam, const CloudBeam::Part& part, const Visit& visit) const;
  template <typename Random>
  [[nodiscard]] double TransmittanceOf(const CloudBeam& beam, const CloudBeam::Part& part,
                                       Random& random) const;

  glm::dvec3 to_sun_;
  CloudTracker tracker_;
  double low_m_, high_m_;  // altitudes of the field's clouds
  glm::dvec2 azimuth_;     // unit vector to the sun on the ground
  double elevation_rad_;
  glm::dvec2 place_m_;
  double per_radius_, step_m_, farthest_m_, full_m_;
};

template <typename Returned>
double CloudLowSun::WithReturned(const CloudBeam& beam, double first, const Returned& returned) {
  if (first >= kDeepest || beam.returning <= 0.0) return std::min(first, kDeepest);
  const double crossing = returned();
  const double added =
      beam.returning < 1.0 ? -std::log1p(beam.returning * std::expm1(-crossing)) : crossing;
  return std::min(first + added, kDeepest);
}

template <typename Visit>
void CloudLowSun::EachChord(const CloudBeam& beam, const CloudBeam::Part& part,
                            const Visit& visit) const {
  for (double at_m = part.begin_m; at_m < part.end_m; at_m += kChord_m) {
    const glm::dvec3 from = beam.At(at_m);
    const glm::dvec3 way = beam.At(std::min(at_m + kChord_m, part.end_m)) - from;
    const double length_m = glm::length(way);
    if (length_m > 0.0 && !visit(CloudRay{from, way / length_m}, length_m)) return;
  }
}

template <typename Random>
double CloudLowSun::TransmittanceOf(const CloudBeam& beam, const CloudBeam::Part& part,
                                    Random& random) const {
  double left = 1.0;
  EachChord(beam, part, [&](const CloudRay& ray, double length_m) {
    left *= tracker_.Transmittance(ray, length_m, random);
    return left > 0.0;
  });
  return left;
}

template <typename Random>
double CloudLowSun::Transmittance(const glm::dvec3& point, Random& random) const {
  const CloudBeam beam = BeamFrom(point, SlopeAt(point));
  const double left = TransmittanceOf(beam, beam.first, random);
  if (left == 0.0 || beam.returning == 0.0) return left;
  return left * (1.0 - beam.returning * (1.0 - TransmittanceOf(beam, beam.returned, random)));
}

}  // namespace alpenglow::renderer
