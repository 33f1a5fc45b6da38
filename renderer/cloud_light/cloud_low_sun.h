// SPDX-License-Identifier: MIT
// Optical depth from any point to a sun near the horizon, over a round planet.
//
// A sun below 3 degrees needs no map: its beams stay in a layer of clouds for tens of kilometres and
// pass a field many times, so that neighbouring points have little in common. Each beam is followed
// instead. At the distance s along the ground from a point of altitude z, where the sun stands at the
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
  /// Distance along the ground beyond which clouds do not shade, in [1e3, 4e5]. The share of beams
  /// that meet clouds when they return falls from one at `full_m` to none there.
  double farthest_m = 4e5;
  double full_m = 4e5;  // in [0, 4e5]; from farthest_m on, beams end sharply
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

  /// Returns the optical depth from a point to the sun, at most kDeepest: where it is reached, the
  /// beam ends.
  [[nodiscard]] double OpticalDepth(const glm::dvec3& point) const {
    return OpticalDepth(point, SlopeAt(point), kDeepest);
  }
  /// Returns the same as if the sun were as high as over the place, so that a periodic field has
  /// periodic light; at most kDeepestMean.
  [[nodiscard]] double OpticalDepthAsAtPlace(const glm::dvec3& point) const {
    return OpticalDepth(point, std::tan(elevation_rad_), kDeepestMean);
  }

  /// Returns an unbiased estimate of the transmittance along the same beam.
  /// @param random  has Next(), uniform in [0, 1).
  template <typename Random>
  [[nodiscard]] double Transmittance(const glm::dvec3& point, Random& random) const;

  static constexpr double kDeepest = 32.0, kDeepestMean = 12.0;

 private:
  static constexpr double kChord_m = 2000.0;

  [[nodiscard]] double ElevationAt_rad(const glm::dvec3& point) const {
    return elevation_rad_ + glm::dot(glm::dvec2(point) - place_m_, azimuth_) * per_radius_;
  }
  /// Returns the tangent of the sun's elevation at a point.
  [[nodiscard]] double SlopeAt(const glm::dvec3& point) const {
    return std::tan(ElevationAt_rad(point));
  }
  [[nodiscard]] double OpticalDepth(const glm::dvec3& point, double slope, double most_depth) const;
  /// A part of a beam.
  struct Interval {
    double begin_m, end_m;
  };
  /// Returns where a beam is below an altitude, relative to the point where its slope is given: between
  /// the roots of a parabola that opens upwards.
  [[nodiscard]] Interval Below(double altitude_m, double slope) const;
  /// A beam from a point, with its slope there.
  struct Beam {
    glm::dvec3 from;
    double slope;
    Interval first, returned;  // parts between the altitudes of the field; empty if end <= begin
    double returning;          // share of beams that meet clouds when they return
  };
  [[nodiscard]] Beam BeamFrom(const glm::dvec3& point, double slope) const;
  /// Calls visit(ray, length_m) for chords of a part of a beam, in order, until it returns false.
  template <typename Visit>
  void EachChord(const Beam& beam, const Interval& part, const Visit& visit) const;
  [[nodiscard]] double OpticalDepthOf(const Beam& beam, const Interval& part,
                                      double most_depth) const;
  template <typename Random>
  [[nodiscard]] double TransmittanceOf(const Beam& beam, const Interval& part,
                                       Random& random) const;

  glm::dvec3 to_sun_;
  CloudTracker tracker_;
  double low_m_, high_m_;  // altitudes of the field's clouds
  glm::dvec2 azimuth_;     // unit vector to the sun on the ground
  double elevation_rad_;
  glm::dvec2 place_m_;
  double per_radius_, step_m_, farthest_m_, full_m_;
};

/// Optical depths to a sun of any elevation from kLowestCloudLight_deg on: by a map from
/// kLowestCloudSun_deg on, and by following beams below. Immutable; safe to use from many threads. The
/// field must outlive it.
class CloudSunDepths {
 public:
  /// Throws the InputErrors of CloudSunMap and CloudLowSun.
  CloudSunDepths(const CloudField& field, const glm::dvec3& to_sun,
                 const CloudSunMapOptions& map_options = {},
                 const CloudLowSunOptions& low_options = {});

  [[nodiscard]] const CloudField& field() const { return *field_; }
  /// Returns the map or the beams; null if the other has the depths.
  [[nodiscard]] const CloudSunMap* map() const { return std::get_if<CloudSunMap>(&sun_); }
  [[nodiscard]] const CloudLowSun* low_sun() const { return std::get_if<CloudLowSun>(&sun_); }
  /// Returns the unit vector to the sun, over the place of a low one.
  [[nodiscard]] const glm::dvec3& to_sun() const {
    return map() ? map()->to_sun() : low_sun()->to_sun();
  }
  /// Returns the unit vector to the sun at a point: over a round planet for a low one.
  [[nodiscard]] glm::dvec3 ToSunAt(const glm::dvec3& point) const {
    return map() ? map()->to_sun() : low_sun()->ToSunAt(point);
  }
  /// Returns the optical depth from a point to the sun: OpticalDepthToSun() or
  /// CloudLowSun::OpticalDepth().
  [[nodiscard]] double OpticalDepth(const glm::dvec3& point) const;
  /// Returns the transmittance for points in clear air and on the ground.
  [[nodiscard]] double Transmittance(const glm::dvec3& point) const;
  /// Returns CloudSunMap::TransmittanceAround(), or that at the point under a low sun.
  [[nodiscard]] double TransmittanceAround(const glm::dvec3& point) const {
    return map() ? map()->TransmittanceAround(point) : Transmittance(point);
  }
  /// Returns the mean transmittance from a plane below or above the field to the sun: that of the
  /// map, or of 4096 beams over the place, whose standard error is 0.008 at most.
  [[nodiscard]] double MeanTransmittance(double altitude_m) const;
  /// Returns the same from the base of the field.
  [[nodiscard]] double MeanTransmittance() const {
    return MeanTransmittance(field_->base_altitude_m());
  }
  /// Returns the memory of the map [bytes]; 0 without one.
  [[nodiscard]] std::size_t bytes() const;

 private:
  const CloudField* field_;
  std::variant<CloudSunMap, CloudLowSun> sun_;
};

template <typename Visit>
void CloudLowSun::EachChord(const Beam& beam, const Interval& part, const Visit& visit) const {
  const auto along = [&](double distance_m) {
    return glm::dvec3(glm::dvec2(beam.from) + distance_m * azimuth_,
                      beam.from.z + distance_m * (beam.slope + 0.5 * distance_m * per_radius_));
  };
  for (double at_m = part.begin_m; at_m < part.end_m; at_m += kChord_m) {
    const glm::dvec3 from = along(at_m);
    const glm::dvec3 way = along(std::min(at_m + kChord_m, part.end_m)) - from;
    const double length_m = glm::length(way);
    if (length_m > 0.0 && !visit(CloudRay{from, way / length_m}, length_m)) return;
  }
}

template <typename Random>
double CloudLowSun::TransmittanceOf(const Beam& beam, const Interval& part, Random& random) const {
  double left = 1.0;
  EachChord(beam, part, [&](const CloudRay& ray, double length_m) {
    left *= tracker_.Transmittance(ray, length_m, random);
    return left > 0.0;
  });
  return left;
}

template <typename Random>
double CloudLowSun::Transmittance(const glm::dvec3& point, Random& random) const {
  const Beam beam = BeamFrom(point, SlopeAt(point));
  const double left = TransmittanceOf(beam, beam.first, random);
  if (left == 0.0 || beam.returning == 0.0) return left;
  return left * (1.0 - beam.returning * (1.0 - TransmittanceOf(beam, beam.returned, random)));
}

}  // namespace alpenglow::renderer
