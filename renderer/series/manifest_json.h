// SPDX-License-Identifier: MIT
// The list of a series for programs: its manifest as JSON.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "atmosphere/sun/geodesy.h"
#include "lut/picture/image.h"
#include "renderer/camera/camera_path.h"
#include "renderer/series/frame_times.h"

namespace alpenglow::renderer {

/// What a manifest says of a frame.
struct ManifestEntry {
  Frame frame;
  std::string file;                                       // its name without a folder
  std::string local_time;                                 // empty without a zone
  GeodeticPosition place;                                 // of the eye
  std::optional<CameraPose> pose = {};                    // on a path
  std::optional<double> illuminance_lx = {}, ev100 = {};  // once the frame exists
  std::string exposure = {};                              // the rule; empty until then
  double sun_covered = 0.0;                               // share of its light, by the moon
};

/// One object: "program", "settings" (all of what the pixels depend on but time and pose), "frames",
/// a list of objects with frame, file, utc, local_time, sun_azimuth_deg, sun_elevation_deg,
/// sun_covered ([0, 1], of its light at 550 nm), moon_azimuth_deg, moon_elevation_deg (angles without
/// refraction), moon_illuminated ([0, 1]),
/// illuminance_lx, ev100, exposure; on a path also t_s, latitude, longitude, height_m, heading, pitch,
/// roll and fov. What is not known is null.
[[nodiscard]] std::string JsonOfManifest(const std::vector<ManifestEntry>& entries,
                                         const Metadata& settings);

}  // namespace alpenglow::renderer
