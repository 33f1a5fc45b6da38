// SPDX-License-Identifier: MIT
// Tracks that others recorded or drew: GPX 1.0 and 1.1 (topografix.com), KML 2.2 (OGC 07-147r2).
//
// Of a GPX file all segments of its tracks, one after the other; without tracks its first route,
// without routes its waypoints. Of a KML file all gx:Tracks, else its first LineString. Heights are
// over the sea there, which is taken for the ellipsoid (within 110 m of it).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/sun/geodesy.h"
#include "atmosphere/sun/time.h"

namespace alpenglow {

struct TrackPoint {
  GeodeticPosition place;  // its height is 0 where there is none
  std::optional<UtcInstant> utc = {};
};

/// What the heights of a track count from. On the ground they say nothing (KML's clampToGround, and
/// points without a height).
enum class TrackHeights { kSea, kOverGround, kOnGround };

struct Track {
  std::string name;  // empty if it has none
  TrackHeights heights = TrackHeights::kSea;
  std::vector<TrackPoint> points;
};

/// Throws InputError "file:line: ..." for what is no XML, neither GPX nor KML, has no points, a
/// latitude, longitude, height or time that is none; InputError without a line for a file that
/// cannot be read or is over 16 MiB.
[[nodiscard]] Track ReadTrack(const std::filesystem::path& file);

}  // namespace alpenglow
