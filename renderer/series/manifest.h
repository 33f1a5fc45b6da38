// SPDX-License-Identifier: MIT
// Metadata of pictures and series: the names and values that identify a picture in its header, with
// a fingerprint; the list of frames without rendering (`skyseries --list`); and the manifest of a
// series as JSON.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/time_place/geodesy.h"
#include "lut/image/image.h"
#include "renderer/camera/camera_path.h"
#include "renderer/picture/render.h"
#include "renderer/scene/scene.h"
#include "renderer/series/frame_times.h"

namespace alpenglow::renderer {

/// Returns program, air, place, camera, ground and lamps of a scene. Numbers are written so that
/// they read back exactly. The content of the terrain's file is hashed: throws InputError when it
/// cannot be read.
[[nodiscard]] Metadata SceneMetadata(const Scene& scene);

/// Returns place, height and angles of a camera, which replace those of SceneMetadata.
[[nodiscard]] Metadata PoseMetadata(const CameraPose& pose);

/// Returns SceneMetadata and the settings that affect the pixels.
[[nodiscard]] Metadata PictureMetadata(const Scene& scene, const RenderSettings& settings);

/// Returns the ray statistics of a picture for its header.
[[nodiscard]] Metadata NotesOn(const RayCount& rays, const RenderSettings& settings);

/// Returns 16 hexadecimal digits, FNV-1a over names and values: equal for equal metadata.
[[nodiscard]] std::string Fingerprint(const Metadata& metadata);

/// Sources of a list of frames.
struct FrameListing {
  std::function<GeodeticPosition(const Frame&)> place_of;
  std::optional<std::string> zone;
  std::optional<FrameName> name;  // file names of the frames, if they are known
};

/// Returns CSV with a header: frame, utc, local_time (empty without a zone), sun_azimuth_deg,
/// sun_elevation_deg, sun_covered (fraction of the sun's light behind the moon, [0, 1]),
/// moon_azimuth_deg, moon_elevation_deg (angles without refraction), moon_illuminated ([0, 1]),
/// file (empty without a name).
[[nodiscard]] std::string ListOf(const std::vector<Frame>& frames, const FrameListing& listing);

/// Values of a frame in the manifest.
struct ManifestEntry {
  Frame frame;
  std::string file;                                       // file name without a folder
  std::string local_time;                                 // empty without a zone
  GeodeticPosition place;                                 // of the eye
  std::optional<CameraPose> pose = {};                    // on a path
  std::optional<double> illuminance_lx = {}, ev100 = {};  // empty until the frame exists
  std::string exposure = {};  // exposure rule; empty until the frame exists
  double sun_covered = 0.0;   // fraction of the sun's light behind the moon
};

/// Returns one JSON object: "program", "settings" (everything that affects the pixels except time
/// and pose), "frames", a list of objects with frame, file, utc, local_time, sun_azimuth_deg,
/// sun_elevation_deg, sun_covered (fraction of the sun's light at 550 nm behind the moon, [0, 1]),
/// moon_azimuth_deg, moon_elevation_deg (angles without refraction), moon_illuminated ([0, 1]),
/// illuminance_lx, ev100, exposure; on a path also t_s, latitude, longitude, height_m, heading,
/// pitch, roll and fov. Unknown values are null.
[[nodiscard]] std::string JsonOfManifest(const std::vector<ManifestEntry>& entries,
                                         const Metadata& settings);

}  // namespace alpenglow::renderer
