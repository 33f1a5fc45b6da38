// SPDX-License-Identifier: MIT
// This header reads tracks from files: GPX 1.0 and 1.1 (topografix.com) and KML 2.2 (OGC 07-147r2).
//
// From a GPX file it reads all segments of its tracks, in the order of their times; without tracks
// the first route, and without routes the waypoints. From a KML file it reads all gx:Tracks in the
// order of their times, or else the first LineString. For incomplete and implausible points, see
// TrackOf (track_record.h). Heights are above sea level, which is assumed to be the ellipsoid
// (within 110 m of it).
#pragma once

#include <filesystem>

#include "renderer/camera/track.h"

namespace alpenglow::renderer {

/// Reads a track. A KML line without altitudeMode inherits it from the enclosing MultiTrack or
/// other element. Throws InputError "file:line: ..." for invalid XML, for UTF-16, for files that
/// are neither GPX nor KML, for files of which no point has a possible place (naming the first
/// fault), and for lines of different altitudeModes. Throws InputError without a line number for a
/// file that cannot be read or exceeds 16 MiB.
[[nodiscard]] Track ReadTrack(const std::filesystem::path& file);

}  // namespace alpenglow::renderer
