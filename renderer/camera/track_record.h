// SPDX-License-Identifier: MIT
// This header turns the raw points of a recorder, with lost fixes and implausible values, into a
// track.
//
// A recorder that has just been switched on may lack a height or a fix, or show a wrong year, while
// its other points are good. Missing values of a point are interpolated from its neighbours, and
// impossible points are dropped. The track's note counts both.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "renderer/camera/track_file.h"

namespace alpenglow::renderer {

struct RecordedPoint {
  std::optional<GeodeticPosition> place;  // height 0; empty: the fix was lost
  std::optional<double> height_m;
  std::optional<UtcInstant> utc;
};

/// Consecutive points without a gap.
using RecordedSegment = std::vector<RecordedPoint>;

/// Returns the points in the order of their times, segment by segment. A segment whose times run
/// backwards is reversed. If only some segments have times, the order of the file is kept.
///
/// - A point without a place is dropped.
/// - A missing height is interpolated along the path. Beyond the first and the last known height,
///   it continues with the slope of the adjacent step for the length of that step, then level. A
///   track above sea level without any height is placed on the ground.
/// - A point whose time is not after the times before it and before the times after it is dropped,
///   with as few drops as possible. A first or last point is also dropped if its distance in time
///   to the rest exceeds both a day and a hundred times the duration of the rest. Points with the
///   place and time of the previous point are skipped.
/// - A missing time is interpolated along the path. Before the first and after the last time, the
///   speed is that of the adjacent step. If fewer than two points have a time, the track has none.
///
/// The note of the track counts all these changes in one line.
[[nodiscard]] Track TrackOf(const std::vector<RecordedSegment>& segments, TrackHeights heights);

}  // namespace alpenglow::renderer
