// SPDX-License-Identifier: MIT
// This header provides recorded or drawn tracks, and turns them into camera paths.
//
// PathAlong turns a track into the path of a camera that looks along it.
//
//   bank = atan(v psi' / g), to 35 degrees           psi' is the turn of the path per second
//
// The camera passes through all points of the track on the smooth curve of CameraPath; between
// segments of the track, and in a pause of a track with times, it moves in a straight line at
// constant speed. Recorded positions are noisier than real flight, so the motion is smoothed. The
// camera looks along a chord of the curve that spans 4 s. Its position along the curve, and hence
// its speed, follows the least-squares parabola over 4 s before and after, except near steps of the
// track of more than 4 s (pauses, and receivers that record seldom). The bank is smoothed over 4 s
// too.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "atmosphere/time_place/geodesy.h"
#include "atmosphere/time_place/time.h"
#include "renderer/camera/camera_path.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

struct TrackPoint {
  Place place;  // its height is 0 if unknown
  std::optional<UtcTime> utc = {};
  int segment = 0;  // the path between points of different segments is unknown
};

/// Reference surface of a track's heights. kOnGround: heights are ignored (KML's clampToGround, and
/// points without a height).
enum class TrackHeights { kSea, kOverGround, kOnGround };

struct Track {
  std::string name;  // empty if it has none
  TrackHeights heights = TrackHeights::kSea;
  std::vector<TrackPoint> points;
  std::string file = {};  // the file that was read
  std::string note = {};  // one line about points that were dropped or completed; may be empty
};

struct TrackStyle {
  double speed_m_per_s = 60.0;   // for a track without times
  double over_ground_m = 100.0;  // for a track without heights
  double fov_rad = 1.0471975511965976;
};

/// Returns the camera path of a track, with one point per second of its segments (at least 200
/// points in all, and at least 8 per segment). A pause ends a segment: a step of more than 10
/// minutes and a hundred times the median step. Segments of more than 200000 s together have fewer
/// points, but at least two per recorded point: what the path needs in memory is bounded by the
/// number of recorded points. Between segments there are up to 100 points.
///
/// Instants are those of the track if all of its points have one and they increase; otherwise the
/// track is flown at constant speed. Points less than 0.5 m from the previous point, or not later
/// than it, are skipped. Throws InputError if fewer than two points remain or the style's numbers
/// are not positive.
[[nodiscard]] CameraPath PathAlong(const Track& track, const TrackStyle& style,
                                   const GroundHeight& ground);

}  // namespace alpenglow::renderer
