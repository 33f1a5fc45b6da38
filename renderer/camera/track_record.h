// SPDX-License-Identifier: MIT
// This header turns the raw points of a recorder, with lost fixes and implausible values, into a
// track.
//
// A recorder that has just been switched on may lack a height or a fix, or show a wrong year, while
// its other points are good. One rule holds for place, time and height: a value that is missing,
// that cannot be read, or that is impossible, is missing; so is one that does not fit those around
// it (odd_points.h). A point without a place is dropped; a missing time or height is interpolated
// from the points around it. The track's note counts all of them.
#pragma once

#include <optional>
#include <vector>

#include "atmosphere/time_place/geodesy.h"
#include "atmosphere/time_place/time.h"
#include "renderer/camera/track.h"

namespace alpenglow::renderer {

/// A point as recorded. Values that are missing, cannot be read, or are impossible are empty.
struct RecordedPoint {
  std::optional<Place> place;  // height 0; empty: the fix was lost
  std::optional<double> height_m;
  std::optional<UtcTime> utc;
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

}  // namespace alpenglow::renderer
