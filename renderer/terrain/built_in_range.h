// SPDX-License-Identifier: MIT
// A mountain range that needs no file: alpine chains of 70 km x 70 km, generated and eroded.
#pragma once

#include <cstdint>
#include <vector>

#include "atmosphere/sun/geodesy.h"
#include "renderer/layer.h"
#include "renderer/terrain/elevation.h"

namespace alpenglow::renderer {

/// The range of a seed, centred on a place (also one of CentreOfRangeSeenFrom): foreland in the
/// north, valleys at 500-900 m, chains that rise southwards, one peak above all. Its heights are the
/// same bytes on every machine with IEEE arithmetic, for any number of threads and any centre; it
/// falls to 0 m at the rim. Each seed has mountains of its own; the foreland behind the view is that
/// of seed 0. Takes two seconds of processor time, but for seed 0 only once a machine.
[[nodiscard]] ElevationGrid BuiltInRange(const GeodeticPosition& centre, std::uint32_t seed = 0);

/// Its grid without heights, at once.
[[nodiscard]] ElevationGrid BuiltInRangeExtent(const GeodeticPosition& centre);

/// Fingerprint of the heights of seed 0, see FingerprintOf (land.h).
inline constexpr std::uint64_t kBuiltInRangeFingerprint = 15784046122448507333ULL;

/// The heights of a seed, rows from the north, made anew: BuiltInRange keeps them.
[[nodiscard]] std::vector<float> MadeRangeHeights(std::uint32_t seed);

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

/// Height of the ground [m] under the view, of every seed to a centimetre; beside a pole, where the
/// heights are resampled, to some metres. It is known before a range is made.
inline constexpr double kRangeViewGround_m = 2084.44;

/// The same view without the range at hand: eye.height_m counts from the ground.
[[nodiscard]] BuiltInView BuiltInRangeViewAboveGround(const GeodeticPosition& centre);

/// Centre of the range whose built-in view stands at a place, to a micrometre. A centre beyond a
/// pole keeps the meridian that it has this side of it: its latitude exceeds 90 degrees. The view
/// stands 2 km east of its centre's meridian, which no place within 2 km of a pole does: the view
/// is then within 4 km of the place.
[[nodiscard]] GeodeticPosition CentreOfRangeSeenFrom(const GeodeticPosition& place);

}  // namespace alpenglow::renderer
