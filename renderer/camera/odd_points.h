// SPDX-License-Identifier: MIT
// This header finds the values of a track that its recorder cannot have met: places and heights
// that a recorder writes when it has none, and values that nothing could reach and leave again in
// the time between the points.
//
// The longest chain of values in the order of the track is kept in which each can be reached
// from the one before; the others are odd, at the start, in the middle and at the end alike. If no
// chain contains more than half of the values, nothing tells the odd ones from the others, and all
// are kept.
#pragma once

#include <optional>
#include <vector>

#include "atmosphere/time_place/geodesy.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// The points of a track that have a place, in order, for the functions below.
struct PlacesInTime {
  std::vector<Place> places;  // with height 0
  /// Increasing where they are known. With fewer than two, the track was drawn.
  std::vector<std::optional<double>> times_s;
};

/// Returns which places are odd:
/// - latitude 0 and longitude 0 to a metre, more than 100 km from the places before and after: what
///   a receiver without a fix writes;
/// - places that need more than 400 m/s (the ground speed of an airliner in a jet stream is 350) or
///   five times the median speed of the track, whichever is more, beyond 200 m of noise. Missing
///   times are interpolated along the path. If fewer than two points have a time, places that lie
///   farther than 500 km or 200 times the median step.
[[nodiscard]] std::vector<bool> OddPlaces(const PlacesInTime& points);

/// Returns which of the known heights are odd:
/// - customary values of a missing height: -999, -9999, -99999, 9999, 99999, 65535, 32767, -32767
///   and -32768;
/// - heights that need more than 100 m/s up or down, or 20 times the median rate of the track,
///   whichever is more, beyond 300 m of noise. If fewer than two points have a time, heights that
///   need a slope of more than 2, beyond 1000 m.
[[nodiscard]] std::vector<bool> OddHeights(const PlacesInTime& points,
                                           const std::vector<std::optional<double>>& heights_m);

}  // namespace alpenglow::renderer
