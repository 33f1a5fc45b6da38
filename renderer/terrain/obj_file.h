// SPDX-License-Identifier: MIT
// Terrain from a Wavefront OBJ file.
#pragma once

#include <filesystem>
#include <string>

#include "renderer/terrain/mesh.h"

namespace alpenglow::renderer {

struct ObjMesh {
  TriangleMesh mesh;
  std::string message;  // one line on what the file has that the mesh leaves out; empty: nothing
};

/// Reads a file whose coordinates are metres from the place of the scene. Polygons are cut into
/// triangles of the same area. Normals are those of the file (vn) where it has any; else they are
/// averaged over the triangles of a smoothing group, or of all without groups, and are those of the
/// face after "s off". A triangle whose normals point to its back is turned over. Faces without
/// area are left out. The message counts these, normals without a direction, polygons that cross
/// themselves and statements that are not known, and says so where the mesh is so far from the
/// place that its coordinates cannot be metres from there. Throws InputError, naming the file, for
/// no triangles, and as ParseObj.
[[nodiscard]] ObjMesh ReadObj(const std::filesystem::path& file, UpAxis up = UpAxis::kZ);

}  // namespace alpenglow::renderer
