// SPDX-License-Identifier: MIT
// Tracks that others recorded or drew: GPX 1.0 and 1.1 (topografix.com), KML 2.2 (OGC 07-147r2).
//
// Of a GPX file all segments of its tracks, in the order of their times; without tracks its first
// route, without routes its waypoints. Of a KML file all gx:Tracks in that order, else its first
// LineString. Points that lack something, and odd ones: see track_record.h. Heights are over the
// sea, which is taken for the ellipsoid (within 110 m of it).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/sun/geodesy.h"
#include "atmosphere/sun/time.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

struct TrackPoint {
  GeodeticPosition place;  // its height is 0 where there is none
  std::optional<UtcInstant> utc = {};
  int segment = 0;  // nothing is known of the way between points of different segments
};

/// What the heights of a track count from. On the ground they say nothing (KML's clampToGround, and
/// points without a height).
enum class TrackHeights { kSea, kOverGround, kOnGround };

struct Track {
  std::string name;  // empty if it has none
  TrackHeights heights = TrackHeights::kSea;
  std::vector<TrackPoint> points;
  std::string file = {};  // that it was read from
  std::string note = {};  // one line about points that are left out or made up; empty: none are
};

/// An altitudeMode of KML that a line does not have is that of the MultiTrack or other element
/// around it. Throws InputError "file:line: ..." for what is no XML, is UTF-16, is neither GPX nor
/// KML, has no points, a latitude, longitude, height or time that is none (an empty one, and nan,
/// is missing), or lines of different altitudeModes; InputError without a line for a file that
/// cannot be read or is over 16 MiB.
[[nodiscard]] Track ReadTrack(const std::filesystem::path& file);

}  // namespace alpenglow::renderer
