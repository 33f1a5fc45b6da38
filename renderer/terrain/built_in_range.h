// SPDX-License-Identifier: MIT
// A mountain range that needs no file: alpine chains of 70 km x 70 km, generated and eroded.
#pragma once

#include <cstdint>
#include <vector>

#include "atmosphere/sun/geodesy.h"
#include "renderer/terrain/elevation.h"

namespace alpenglow {

/// The range, centred on a place (also one of CentreOfRangeSeenFrom): foreland in the north,
/// valleys at 500-900 m, chains that rise southwards, one peak above all. Its heights are the same
/// bytes on every machine with IEEE arithmetic, for any number of threads and any centre; it falls
/// to 0 m at the rim.
[[nodiscard]] ElevationGrid BuiltInRange(const GeodeticPosition& centre);

/// Its grid without heights, at once.
[[nodiscard]] ElevationGrid BuiltInRangeExtent(const GeodeticPosition& centre);

/// Of its heights, see FingerprintOf (kept_heights.h). It changes with the range.
inline constexpr std::uint64_t kBuiltInRangeFingerprint = 15784046122448507333ULL;

/// Its heights, rows from the north, made anew: BuiltInRange keeps them between runs.
[[nodiscard]] std::vector<float> MadeRangeHeights();

/// An eye and where it looks.
struct BuiltInView {
  GeodeticPosition eye;
  double heading_deg = 0.0;  // clockwise from north
  double pitch_deg = 0.0;    // up is positive
  double fov_deg = 0.0;      // horizontal
};

/// The view that the range was made for: from a shoulder of the foothills to the highest peak,
/// chain behind chain, east at the left.
[[nodiscard]] BuiltInView BuiltInRangeView(const GeodeticPosition& centre,
                                           const ElevationGrid& range);

/// The same view without the range at hand: eye.height_m counts from the ground.
[[nodiscard]] BuiltInView BuiltInRangeViewAboveGround(const GeodeticPosition& centre);

/// Centre of the range whose built-in view stands at a place, to a micrometre. A centre beyond a
/// pole keeps the meridian that it has this side of it: its latitude exceeds 90 degrees. The view
/// stands 2 km east of its centre's meridian, which no place within 2 km of a pole does: the view
/// is then within 4 km of the place.
[[nodiscard]] GeodeticPosition CentreOfRangeSeenFrom(const GeodeticPosition& place);

}  // namespace alpenglow
