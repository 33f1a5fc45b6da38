// SPDX-License-Identifier: MIT
// This header reads recorded or drawn tracks from GPX 1.0 and 1.1 (topografix.com) and KML 2.2 (OGC
// 07-147r2) files.
//
// From a GPX file it reads all segments of its tracks, in the order of their times; without tracks
// the first route, and without routes the waypoints. From a KML file it reads all gx:Tracks in the
// order of their times, or else the first LineString. For incomplete and implausible points, see
// track_record.h. Heights are above sea level, which is assumed to be the ellipsoid (within 110 m
// of it).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/time_place/geodesy.h"
#include "atmosphere/time_place/time.h"
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
/// are neither GPX nor KML, for files without points, for an invalid latitude, longitude, height or
/// time (empty values and nan count as missing), and for lines of different altitudeModes. Throws
/// InputError without a line number for a file that cannot be read or exceeds 16 MiB.
[[nodiscard]] Track ReadTrack(const std::filesystem::path& file);

}  // namespace alpenglow::renderer
