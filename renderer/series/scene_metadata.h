// SPDX-License-Identifier: MIT
// Metadata of scenes and pictures: the names and values that identify a picture in its header, and
// their fingerprint. Files of a scene are identified by the hash of their contents.
#pragma once

#include <filesystem>
#include <map>
#include <stop_token>
#include <string>
#include <vector>

#include "lut/image/image.h"
#include "renderer/camera/camera_path.h"
#include "renderer/picture/render.h"
#include "renderer/scene/scene.h"

namespace alpenglow::renderer {

/// Names of the files of a scene, with hashes of their contents.
struct FileHashes {
  std::map<std::filesystem::path, std::string> names_and_hashes;
  std::string models;                    // of all elevation models; empty if there are not several
  std::vector<std::string> grids;        // of each volume
  std::vector<std::string> cloud_grids;  // of each layer of clouds; empty without a grid
};
/// Reads all files of a scene. Throws InputError when one cannot be read, or when a stop is
/// requested.
[[nodiscard]] FileHashes HashFilesOf(const Scene& scene, const std::stop_token& stop = {});

/// Returns program, place, camera, air, media, clouds, terrain, ground and lamps of a scene, except
/// its time and zone (with clouds, their time is a part): any other change of the scene that changes the picture changes a value.
/// Numbers are written so that they read back exactly, or hashed.
/// @param hashes  of the files of this scene, taken when the scene was loaded.
[[nodiscard]] Metadata SceneMetadata(const Scene& scene, const FileHashes& hashes);

/// Returns place, height and angles of a camera, which replace those of SceneMetadata.
[[nodiscard]] Metadata PoseMetadata(const CameraPose& pose);

/// Returns SceneMetadata and the settings that affect the pixels.
[[nodiscard]] Metadata PictureMetadata(const Scene& scene, const FileHashes& hashes,
                                       const RenderSettings& settings);

/// Returns the ray statistics of a picture for its header.
[[nodiscard]] Metadata NotesOn(const RayCount& rays, const RenderSettings& settings);

/// Returns 16 hexadecimal digits, FNV-1a over names and values: equal for equal metadata.
[[nodiscard]] std::string Fingerprint(const Metadata& metadata);

}  // namespace alpenglow::renderer
