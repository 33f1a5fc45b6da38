// SPDX-License-Identifier: MIT
// What a recorder wrote, with its lost fixes and odd points, and the track that is made of it.
//
// A recorder that has just been switched on knows no height, has no fix, or shows another year; the
// rest of its points are good. What one point lacks is taken from its neighbours, and a point that
// cannot be true is left out. The track says how many there were of each.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "renderer/camera/track_file.h"

namespace alpenglow::renderer {

struct RecordedPoint {
  std::optional<GeodeticPosition> place;  // its height is 0; nothing: the fix was lost
  std::optional<double> height_m;
  std::optional<UtcInstant> utc;
};

/// Points without a gap between them.
using RecordedSegment = std::vector<RecordedPoint>;

/// The points in the order of their times, segment by segment; a segment whose times run backwards
/// is turned round. Where only some segments have times, the order of the file is kept.
///
/// - A point without a place is left out.
/// - A height that some points lack is interpolated over the way; beyond the first and the last
///   height it goes on with the slope of the step next to it for as long as that step, then level.
///   Without any height a track over the sea lies on the ground.
/// - A point whose time is not after those before it and before those after it is left out: as few
///   as possible. So is a first or last one that is more than a day and a hundred times the length
///   of the rest away from it. Points at the place and time of the one before are passed over.
/// - A time that some points lack is interpolated over the way; before the first and after the last
///   time the speed is that of the step next to it. Where fewer than two points have a time, the
///   track has none.
///
/// The note of the track counts all this in one line.
[[nodiscard]] Track TrackOf(const std::vector<RecordedSegment>& segments, TrackHeights heights);

}  // namespace alpenglow::renderer
