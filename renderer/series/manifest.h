// SPDX-License-Identifier: MIT
// What made a picture, as names and values for its header, and a fingerprint of them.
//
// The frames that a series would have, without rendering them: `skyseries --list`.
//
// The list of a series for programs: its manifest as JSON.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/sun/geodesy.h"
#include "lut/picture/image.h"
#include "renderer/camera/camera_path.h"
#include "renderer/picture/render.h"
#include "renderer/scene/scene.h"
#include "renderer/series/frame_times.h"

namespace alpenglow::renderer {

/// Program, air, place, camera, ground and lamps of a scene; numbers
/// are written so that they read back exactly. The content of the
/// terrain's file is hashed: throws InputError when it cannot be read.
[[nodiscard]] Metadata SceneMetadata(const Scene& scene);

/// Place, height and angles of a camera, over those of SceneMetadata.
[[nodiscard]] Metadata PoseMetadata(const CameraPose& pose);

/// SceneMetadata, and the settings that the pixels depend on.
[[nodiscard]] Metadata PictureMetadata(const Scene& scene, const RenderSettings& settings);

/// What a file says of the rays that its picture took.
[[nodiscard]] Metadata NotesOn(const RayCount& rays, const RenderSettings& settings);

/// 16 hexadecimal digits, FNV-1a over names and values: equal for equal metadata.
[[nodiscard]] std::string Fingerprint(const Metadata& metadata);

/// What a list of frames is made from.
struct FrameListing {
  std::function<GeodeticPosition(const Frame&)> place_of;
  std::optional<std::string> zone;
  std::optional<FrameName> name;  // of their files, if they have one already
};

/// CSV with a header: frame, utc, local_time (empty without a zone), sun_azimuth_deg,
/// sun_elevation_deg, sun_covered ([0, 1], of its light, by the moon), moon_azimuth_deg,
/// moon_elevation_deg (angles without refraction), moon_illuminated ([0, 1]), file (empty without a
/// name).
[[nodiscard]] std::string ListOf(const std::vector<Frame>& frames, const FrameListing& listing);

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
