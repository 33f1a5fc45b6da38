// SPDX-License-Identifier: MIT
// Terrain on the graphics card: what the eye sees of it, and the shadow that it casts.
#pragma once

#include <glm/mat4x4.hpp>

#include "atmosphere/sun/geodesy.h"
#include "renderer/terrain/mesh.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/gl/shader.h"
#include "viewer/shaders/uniform_blocks.h"

namespace alpenglow {

class TerrainSurface {
 public:
  /// Texels along one side of the shadow map.
  static constexpr int kShadowSize = 4096;

  /// @param frame  of the mesh's vertices. A mesh without triangles draws nothing.
  TerrainSurface(const TriangleMesh& mesh, const LocalFrame& frame);

  /// Draws distance and normal of what the eye sees into the bound target (see terrain.frag.glsl).
  /// The uniform block View must be bound to `view_binding`.
  void DrawSurface(const GeodeticPosition& eye, GLuint view_binding) const;

  /// Draws the shadow map for a sun in this direction, unless it stands where it stood last time
  /// (within a fifth of its radius).
  void CastShadow(const Vector<Ecef>& to_sun);

  /// From metres in the frame (east, north, up) at the eye to metres in the frame of the mesh.
  [[nodiscard]] glm::dmat4 MeshFromEye(const GeodeticPosition& eye) const;
  [[nodiscard]] const LocalFrame& frame() const { return frame_; }

  /// From metres in the frame (east, north, up) at the eye to the clip space of the shadow map.
  [[nodiscard]] glm::mat4 ShadowFromEye(const GeodeticPosition& eye) const;
  /// Size of the shadow map's texel [m], the larger side; 0 without terrain.
  [[nodiscard]] float shadow_texel_m() const { return static_cast<float>(shadow_texel_m_); }
  void BindShadow(int unit) const;

 private:
  LocalFrame frame_;
  GLsizei indices_;
  glm::dvec3 low_, high_;  // corners of the box around the mesh
  GlVertexArray layout_;
  GlBuffer positions_, normals_, triangles_, block_;
  ShaderProgram surface_program_, shadow_program_;
  GlTexture shadow_map_;
  GlFramebuffer shadow_target_;
  glm::dvec3 shadow_sun_{0.0};  // direction that the map was drawn for; 0: none yet
  glm::dmat4 shadow_from_mesh_{1.0};
  double shadow_texel_m_ = 0.0;
};

}  // namespace alpenglow
