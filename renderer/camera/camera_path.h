// SPDX-License-Identifier: MIT
// Distances along a way.
//
// What a flight asks of the ground.
//
// The way of a camera: where it is and where it looks, moment by moment; and the file that says so.
//
// The file is text, one point a line. Its first line names the columns, separated by commas, in any
// order; `#` begins a comment:
//
//   t_s,latitude,longitude,height_m,heading,pitch,roll,fov,utc
//   0,46.5,8.0,2400,170,-5,0,60,2026-06-21T04:00:00Z
//   12.5,46.51,8.02,2450,182,-4,0,60,2026-06-21T04:00:12.5Z
//
// Angles are degrees as in a scene's camera, heights are over the ellipsoid. Times grow from line
// to line. heading, pitch, roll and fov may be left out, and so may utc, for all points at once.
//
// Between points the camera moves without a jump of its speed. The place is the normal of the
// ellipsoid (Gade 2010, "A non-singular horizontal position representation", J. Navigation 63,
// 395): no seam at 180 degrees or at a pole. Its components are cubics with the slope of the
// parabola through a point and its neighbours (Catmull and Rom 1974, for uneven times), normalised.
// That slope is at most twice the lesser of the two steps' speeds, and is 0 where the way turns
// back: on a straight way the camera never leaves the two points between which it is, however long
// it stands between others. Across a gap, of which nothing is known, place and height go straight
// and with even speed, and the slopes on either side do not heed it.
// Height and angles are cubics that do not overshoot (Fritsch and Butland 1984, SIAM J. Sci. Stat.
// Comput. 5, 300): never lower than the lower of two points, and still where two points are the
// same. Angles take the shorter way around; a level camera stays level. Of a path over a pole,
// headings turn by half a circle there, and points want to be close to each other.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/sun/geodesy.h"
#include "atmosphere/sun/time.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Places that are closer are the same place: a receiver does not tell them apart.
inline constexpr double kSamePlace_m = 0.5;

/// The chord between two places [m].
[[nodiscard]] inline double DistanceBetween(const GeodeticPosition& a, const GeodeticPosition& b) {
  return glm::length((EcefFromGeodetic(kWgs84, a) - EcefFromGeodetic(kWgs84, b)).xyz);
}

/// Height of the ground [m] over the ellipsoid, under a place.
using GroundHeight = std::function<double(const GeodeticPosition&)>;

/// Where a camera is and looks. Angles as in Camera.
struct CameraPose {
  GeodeticPosition place;  // height over the ellipsoid
  double heading_rad = 0.0;
  double pitch_rad = 0.0;
  double roll_rad = 0.0;
  double fov_rad = 1.0471975511965976;
};

struct CameraPathPoint {
  double time_s = 0.0;
  CameraPose pose;
  std::optional<UtcInstant> utc = std::nullopt;
  bool after_gap = false;  // nothing is known of the way from the point before
};

/// Immutable.
class CameraPath {
 public:
  /// Throws InputError naming the point (from 1) for no points, times that do not grow, and an
  /// instant that some points have and others have not.
  explicit CameraPath(std::vector<CameraPathPoint> points);

  [[nodiscard]] double begin_s() const { return points_.front().time_s; }
  [[nodiscard]] double end_s() const { return points_.back().time_s; }
  [[nodiscard]] const std::vector<CameraPathPoint>& points() const { return points_; }

  /// Before the first point and after the last one the camera stands.
  [[nodiscard]] CameraPose PoseAt(double time_s) const;
  /// Even between points; nothing when the path has no instants.
  [[nodiscard]] std::optional<UtcInstant> UtcAt(double time_s) const;

  /// Poses at even steps from one time to another, both included; one pose at the middle for a
  /// `count` of 1.
  [[nodiscard]] std::vector<CameraPose> PosesBetween(double from_s, double to_s, int count) const;

 private:
  struct Span {
    std::size_t left;  // point before, or the first of two
    double share;      // of the way to the next, in [0, 1]
  };
  [[nodiscard]] Span SpanAt(double time_s) const;
  template <typename Value>
  [[nodiscard]] Value Between(const std::vector<Value>& values, const std::vector<Value>& slopes,
                              const Span& span) const;

  std::vector<CameraPathPoint> points_;
  std::vector<glm::dvec3> normals_, normal_slopes_;  // of the ellipsoid, earth-fixed
  /// Height, heading, pitch, roll, fov: angles without jumps.
  static constexpr std::size_t kScalars = 5;
  std::array<std::vector<double>, kScalars> scalars_, scalar_slopes_;
  std::vector<double> utc_s_;  // since the first point's
};

/// Reads a path; `otherwise` is what columns left out say. Throws InputError "file:line: ..." for
/// unknown columns and missing ones, values out of range, and what CameraPath
/// refuses. Of a file that ends in .part, which a flight is written into until it ends, a last line
/// without its end is passed over.
[[nodiscard]] CameraPath ReadCameraPath(const std::filesystem::path& file,
                                        const CameraPose& otherwise = {});
/// All columns. Read back, a place is the same to a
/// tenth of a millimetre, an angle to 1e-9 degrees.
[[nodiscard]] std::string TextOf(const CameraPath& path);
/// The first line of such a text, and the line of a point; each with its end.
[[nodiscard]] std::string HeaderOfCameraPath(bool has_utc);
[[nodiscard]] std::string LineOf(const CameraPathPoint& point);

}  // namespace alpenglow::renderer
