// SPDX-License-Identifier: MIT
// This header turns recorded or drawn tracks into camera paths.
//
// ReadTrack reads GPX 1.0 and 1.1 (topografix.com) and KML 2.2 (OGC 07-147r2) files.
//
// From a GPX file it reads all segments of its tracks, in the order of their times; without tracks
// the first route, and without routes the waypoints. From a KML file it reads all gx:Tracks in the
// order of their times, or else the first LineString. For incomplete and implausible points, see
// TrackOf. Heights are above sea level, which is assumed to be the ellipsoid (within 110 m of it).
//
// TrackOf turns the raw points of a recorder, with lost fixes and implausible values, into a track.
// A recorder that has just been switched on may lack a height or a fix, or show a wrong year, while
// its other points are good. One rule holds for place, time and height: a value that is missing,
// that cannot be read, or that is impossible, is missing; so is one that does not fit those around
// it (odd_points.h). A point without a place is dropped; a missing time or height is interpolated
// from the points around it. The track's note counts all of them.
//
// PathAlong turns a track into the path of a camera that looks along it.
//
//   bank = atan(v psi' / g), to 35 degrees           psi' is the turn of the path per second
//
// The camera passes through all points of the track on the smooth curve of CameraPath; between
// segments of the track, and in a pause of a track with times, it moves in a straight line at
// constant speed. Recorded positions are
// noisier than real flight, so the motion is smoothed. The camera looks along a chord of the curve
// that spans 4 s. Its position along the curve, and hence its speed, follows the least-squares
// parabola over 4 s before and after, except near steps of the track of more than 4 s (pauses, and
// receivers that record seldom). The bank is smoothed over 4 s too.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/time_place/geodesy.h"
#include "atmosphere/time_place/time.h"
#include "renderer/camera/camera_path.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

struct TrackPoint {
  GeodeticPosition place;  // its height is 0 if unknown
  std::optional<UtcInstant> utc = {};
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

/// Reads a track. A KML line without altitudeMode inherits it from the enclosing MultiTrack or
/// other element. Throws InputError "file:line: ..." for invalid XML, for UTF-16, for files that
/// are neither GPX nor KML, for files of which no point has a possible place (naming the first
/// fault), and for lines of different altitudeModes. Throws InputError without a line number for a
/// file that cannot be read or exceeds 16 MiB.
[[nodiscard]] Track ReadTrack(const std::filesystem::path& file);

/// A point as recorded. Values that are missing, cannot be read, or are impossible are empty.
struct RecordedPoint {
  std::optional<GeodeticPosition> place;  // height 0; empty: the fix was lost
  std::optional<double> height_m;
  std::optional<UtcInstant> utc;
  /// The recorder marks a pause here with an impossible place; the next point begins a segment.
  bool is_pause = false;
};

/// Consecutive points without a gap.
using RecordedSegment = std::vector<RecordedPoint>;

/// Returns the points in the order of their times, segment by segment. A segment whose times run
/// backwards is reversed. If only some segments have times, the order of the file is kept.
///
/// - A point without a place, or with an odd one (OddPlaces), is dropped.
/// - A point whose time is not after the times before it and before the times after it is dropped,
///   with as few drops as possible. At both ends also points before or after a step of a year are
///   dropped if they are the smaller part (a clock that was not set), and a single point whose
///   distance in time to the rest exceeds both a day and a hundred times the duration of the rest.
///   Points with the place and time of the previous point are skipped. If fewer than half of the
///   times remain in this way, none is used.
/// - A missing or odd height (OddHeights) is interpolated along the path. Beyond the first and the
///   last known height, it continues with the slope of the adjacent step for the length of that
///   step, then level. A track above sea level without any height is placed on the ground.
/// - A missing time is interpolated along the path. Before the first and after the last time, the
///   speed is that of the adjacent step. If fewer than two points have a time, the track has none.
///
/// The note of the track counts all these changes in one line.
[[nodiscard]] Track TrackOf(const std::vector<RecordedSegment>& segments, TrackHeights heights);

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
