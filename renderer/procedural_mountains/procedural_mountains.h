// SPDX-License-Identifier: MIT
// This header provides a mountain range that needs no file: alpine chains of 70 km x 70 km,
// generated and eroded.
#pragma once

#include <cstdint>
#include <vector>

#include "atmosphere/time_place/camera_pose.h"
#include "atmosphere/time_place/geodesy.h"
#include "renderer/elevation/elevation.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Returns the range of a seed, centred on a place (also one of CentreOfRangeSeenFrom): foreland in
/// the north, valleys at 500-900 m, chains that rise southwards, one highest peak. Its heights are
/// bit-identical on every machine with IEEE arithmetic, for any number of threads and any centre;
/// the range falls to 0 m at the rim. Each seed has different mountains; the foreland behind the
/// view is always that of seed 0. It takes two seconds of processor time, for seed 0 only once per
/// machine.
[[nodiscard]] ElevationGrid ProceduralMountains(const Place& centre, std::uint32_t seed = 0);

/// Returns the grid of the range without heights, immediately.
[[nodiscard]] ElevationGrid ProceduralMountainsExtent(const Place& centre);

/// Fingerprint of the heights of seed 0, see FingerprintOf (land.h).
inline constexpr std::uint64_t kProceduralMountainsFingerprint = 15784046122448507333ULL;

/// Returns the heights of a seed, rows from the north, without a cache; ProceduralMountains caches
/// them.
[[nodiscard]] std::vector<float> MadeRangeHeights(std::uint32_t seed);

/// Returns the view that the range was designed for: from a shoulder of the foothills to the
/// highest peak, chain behind chain, east at the left.
[[nodiscard]] CameraPose ProceduralMountainsView(const Place& centre, const ElevationGrid& range);

/// Height of the ground [m] at the position of the view, known before a range is made. It is equal
/// for all seeds to a centimetre; beside a pole, where the heights are resampled, to some metres.
inline constexpr double kRangeViewGround_m = 2084.44;

/// Returns ProceduralMountainsView without the heights of the range: place.height_m is relative to
/// the ground.
[[nodiscard]] CameraPose ProceduralMountainsViewAboveGround(const Place& centre);

/// Returns the centre of the range whose built-in view is at a place, to a micrometre. A centre
/// beyond a pole keeps its meridian: its latitude exceeds 90 degrees. The view is 2 km east of its
/// centre's meridian, which is impossible for a place within 2 km of a pole: the view is then
/// within 4 km of the place.
[[nodiscard]] Place CentreOfRangeSeenFrom(const Place& place);

}  // namespace alpenglow::renderer
