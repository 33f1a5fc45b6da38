// SPDX-License-Identifier: MIT
// This header provides camera paths: the pose of a camera as a function of time, interpolated
// between points, and the text file that stores a path. It also defines the distance between two
// places and the ground height that a flight needs.
//
// The file is text with one point per line. Its first line names the columns, separated by commas,
// in any order; `#` begins a comment:
//
//   t_s,latitude,longitude,height_m,heading,pitch,roll,fov,utc
//   0,46.5,8.0,2400,170,-5,0,60,2026-06-21T04:00:00Z
//   12.5,46.51,8.02,2450,182,-4,0,60,2026-06-21T04:00:12.5Z
//
// Angles are in degrees, as in a scene's camera; heights are above the ellipsoid. Times increase
// from line to line. The columns heading, pitch, roll and fov are optional. utc is optional too,
// but must be given for all points or for none.
//
// Between points the velocity of the camera is continuous. The position is interpolated as the
// normal of the ellipsoid (Gade 2010, "A non-singular horizontal position representation", J.
// Navigation 63, 395), which has no seam at 180 degrees or at a pole. The components of the normal
// are cubics whose slope at a point is that of the parabola through the point and its neighbours
// (Catmull and Rom 1974, for uneven times); the result is normalised. The slope is limited to twice
// the lower speed of the two adjacent steps, and is 0 where the path turns back. On a straight path
// the camera therefore always stays between its two neighbouring points, however long it rests at
// other points. Across a gap, where the path is unknown, place and height are interpolated linearly
// at constant speed, and the slopes on either side ignore the gap.
// Height and angles are monotone cubics without overshoot (Fritsch and Butland 1984, SIAM J. Sci.
// Stat. Comput. 5, 300): they are never below the lower of two points, and constant between two
// equal points. Angles take the shorter way around; a level camera stays level. The heading is
// interpolated relative to a direction that is carried along the path, so that a camera that looks
// ahead also looks ahead over a pole, where its heading turns by half a circle. Between two points
// with equal headings it may therefore change, except where the path stands still.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/time_place/camera_pose.h"
#include "atmosphere/time_place/geodesy.h"
#include "atmosphere/time_place/time.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Places closer than this count as one place; a satellite receiver cannot distinguish them.
inline constexpr double kSamePlace_m = 0.5;

/// Returns the length of the chord between two places [m].
[[nodiscard]] inline double DistanceBetween(const Place& a, const Place& b) {
  return glm::length((EcefFromGeodetic(kWgs84, a) - EcefFromGeodetic(kWgs84, b)).xyz);
}

/// Function that returns the height of the ground above the ellipsoid [m] at a place.
using GroundHeight = std::function<double(const Place&)>;

struct CameraPathPoint {
  double time_s = 0.0;
  CameraPose pose;
  std::optional<UtcTime> utc = std::nullopt;
  bool after_gap = false;  // the path from the previous point to this one is unknown
};

/// Interpolates poses and instants between the points of a path. Immutable.
class CameraPath {
 public:
  /// Throws InputError naming the point (counted from 1) if there are no points, if times do not
  /// increase, or if only some of the points have an instant.
  explicit CameraPath(std::vector<CameraPathPoint> points);

  [[nodiscard]] double begin_s() const { return points_.front().time_s; }
  [[nodiscard]] double end_s() const { return points_.back().time_s; }
  [[nodiscard]] const std::vector<CameraPathPoint>& points() const { return points_; }

  /// Returns the pose at a time. Before the first point and after the last one the camera rests
  /// there.
  [[nodiscard]] CameraPose PoseAt(double time_s) const;
  /// Returns the instant, linear in time between points; empty when the path has no instants.
  [[nodiscard]] std::optional<UtcTime> UtcAt(double time_s) const;

  /// Returns poses at equal time steps between two times, both included. A `count` of 1 gives the
  /// pose at the middle.
  [[nodiscard]] std::vector<CameraPose> PosesBetween(double from_s, double to_s, int count) const;

 private:
  struct Span {
    std::size_t left;  // index of the point before the time, or of the first of two
    double share;      // fraction of the step to the next point, in [0, 1]
  };
  [[nodiscard]] Span SpanAt(double time_s) const;
  template <typename Value>
  [[nodiscard]] Value Between(const std::vector<Value>& values, const std::vector<Value>& slopes,
                              const Span& span) const;

  std::vector<CameraPathPoint> points_;
  std::vector<glm::dvec3> normals_, normal_slopes_;  // of the ellipsoid, earth-fixed
  /// Height, heading, pitch, roll and fov; angles are unwrapped. The heading is relative to a
  /// direction that is carried along the path from the first point.
  static constexpr std::size_t kScalars = 5;
  std::array<std::vector<double>, kScalars> scalars_, scalar_slopes_;
  std::vector<double> utc_s_;  // since the first point
};

/// Calls a check with the place of every point of a path. Adds the file and the number of the point,
/// counted from 1, to its InputError.
void CheckPoints(const CameraPath& path, const std::string& file,
                 const std::function<void(const Place&)>& check);

/// Reads a path; `otherwise` supplies the values of columns that are left out. Throws InputError
/// "file:line: ..." for unknown or missing columns, for values out of range, and for points that
/// CameraPath rejects. If the file name ends in .part (a flight that is still being recorded), an
/// unterminated last line is ignored.
[[nodiscard]] CameraPath ReadCameraPath(const std::filesystem::path& file,
                                        const CameraPose& otherwise = {});
/// Returns the text of a path with all columns. Reading it back reproduces places to a tenth of a
/// millimetre and angles to 1e-9 degrees.
[[nodiscard]] std::string TextOf(const CameraPath& path);
/// Returns the header line of the path file. LineOf returns the line of a point. Both end in a
/// newline.
[[nodiscard]] std::string HeaderOfCameraPath(bool has_utc);
[[nodiscard]] std::string LineOf(const CameraPathPoint& point);

}  // namespace alpenglow::renderer
