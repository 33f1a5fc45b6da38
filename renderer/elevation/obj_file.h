// SPDX-License-Identifier: MIT
// This header provides terrain from a Wavefront OBJ file.
#pragma once

#include <filesystem>

#include "renderer/elevation/mesh.h"

namespace alpenglow::renderer {

/// Reads a file whose coordinates are metres from the place of the scene. Polygons are cut into
/// triangles of equal total area. Normals are those of the file (vn) where it has any. Otherwise
/// they are averaged over the triangles of a smoothing group, or of all triangles if there are no
/// groups; after "s off" they are the normals of the faces. A triangle whose normals point to its
/// back is reversed. Faces without area are omitted. The message counts these, normals without a
/// direction, self-intersecting polygons and unknown statements, and states whether the mesh is so
/// far from the place that its coordinates cannot be metres from there. Throws InputError, naming
/// the file, if there are no triangles, and the errors of ParseObj.
[[nodiscard]] MeshModel ReadObj(const std::filesystem::path& file, UpAxis up = UpAxis::kZ);

}  // namespace alpenglow::renderer
