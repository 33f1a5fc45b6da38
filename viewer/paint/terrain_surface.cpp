// SPDX-License-Identifier: MIT
#include "viewer/paint/terrain_surface.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <limits>

#include "viewer/embedded_text.h"
#include "viewer/gl/render_target.h"

namespace alpenglow {
namespace {

constexpr GLuint kPosition = 0;
constexpr GLuint kNormal = 1;
constexpr GLuint kMeshBinding = 8;

template <typename Row>
void Upload(GLenum target, const GlBuffer& buffer, const std::vector<Row>& rows) {
  glBindBuffer(target, buffer.id());
  glBufferData(target, static_cast<GLsizeiptr>(rows.size() * sizeof(Row)), rows.data(),
               GL_STATIC_DRAW);
}

void DescribeVertices(GLuint attribute, const GlBuffer& buffer) {
  glBindBuffer(GL_ARRAY_BUFFER, buffer.id());
  glEnableVertexAttribArray(attribute);
  glVertexAttribPointer(attribute, 3, GL_FLOAT, GL_FALSE, 3 * sizeof(float), nullptr);
}

std::pair<glm::dvec3, glm::dvec3> BoxAround(const TriangleMesh& mesh) {
  glm::dvec3 low(std::numeric_limits<double>::infinity());
  glm::dvec3 high = -low;
  for (const auto& position : mesh.positions) {
    for (glm::length_t axis = 0; axis < 3; ++axis) {
      const auto value = static_cast<double>(position[static_cast<std::size_t>(axis)]);
      low[axis] = std::min(low[axis], value);
      high[axis] = std::max(high[axis], value);
    }
  }
  return {low, high};
}

ShaderPiece Piece(const char* name) { return {name, std::string(viewer::EmbeddedText(name))}; }

ShaderProgram SurfaceProgram() {
  return ShaderProgram(
      {Piece("viewer/shaders/view_block.glsl"), Piece("viewer/shaders/terrain.vert.glsl")},
      {Piece("viewer/shaders/terrain.frag.glsl")}, {{kPosition, "position"}, {kNormal, "normal"}});
}

ShaderProgram ShadowProgram() {
  return ShaderProgram({Piece("viewer/shaders/shadow.vert.glsl")},
                       {Piece("viewer/shaders/empty.frag.glsl")}, {{kPosition, "position"}});
}

glm::vec4 Padded(const glm::dvec3& v) { return {glm::vec3(v), 0.0F}; }

}  // namespace

TerrainSurface::TerrainSurface(const TriangleMesh& mesh, const LocalFrame& frame)
    : frame_(frame),
      indices_(static_cast<GLsizei>(3 * mesh.triangles.size())),
      surface_program_(SurfaceProgram()),
      shadow_program_(ShadowProgram()) {
  std::tie(low_, high_) = BoxAround(mesh);
  glBindVertexArray(layout_.id());
  Upload(GL_ARRAY_BUFFER, positions_, mesh.positions);
  Upload(GL_ARRAY_BUFFER, normals_, mesh.normals);
  Upload(GL_ELEMENT_ARRAY_BUFFER, triangles_, mesh.triangles);
  DescribeVertices(kPosition, positions_);
  DescribeVertices(kNormal, normals_);
  glBindTexture(GL_TEXTURE_2D, shadow_map_.id());
  const int side = indices_ > 0 ? kShadowSize : 1;
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, side, side, 0, GL_DEPTH_COMPONENT, GL_FLOAT,
               nullptr);
  ClampAndFilter(GL_TEXTURE_2D, true);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  glBindFramebuffer(GL_FRAMEBUFFER, shadow_target_.id());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, shadow_map_.id(), 0);
  glDrawBuffer(GL_NONE);
}

glm::dmat4 TerrainSurface::MeshFromEye(const GeodeticPosition& eye) const {
  const LocalFrame there(frame_.ellipsoid(), eye);
  const auto axis = [&](const glm::dvec3& v) {
    return glm::dvec4(frame_.EnuFromEcef(there.EcefFromEnu(Vector<Enu>{v})).xyz, 0.0);
  };
  return {axis({1.0, 0.0, 0.0}), axis({0.0, 1.0, 0.0}), axis({0.0, 0.0, 1.0}),
          glm::dvec4(frame_.EnuFromGeodetic(eye).xyz, 1.0)};
}

void TerrainSurface::DrawSurface(const GeodeticPosition& eye, GLuint view_binding) const {
  if (indices_ == 0) return;
  const glm::dmat4 mesh_from_eye = MeshFromEye(eye);
  const glm::dvec3 position(mesh_from_eye[3]);
  const glm::vec3 high(position);
  const MeshBlock block{glm::vec4(high, 0.0F), Padded(position - glm::dvec3(high)),
                        Padded(glm::dvec3(mesh_from_eye[0])), Padded(glm::dvec3(mesh_from_eye[1])),
                        Padded(glm::dvec3(mesh_from_eye[2]))};
  glBindBufferBase(GL_UNIFORM_BUFFER, kMeshBinding, block_.id());
  glBufferData(GL_UNIFORM_BUFFER, sizeof(block), &block, GL_DYNAMIC_DRAW);
  surface_program_.Use();
  surface_program_.BindBlock("Mesh", kMeshBinding);
  surface_program_.BindBlock("View", view_binding);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glBindVertexArray(layout_.id());
  glDrawElements(GL_TRIANGLES, indices_, GL_UNSIGNED_INT, nullptr);
  glDisable(GL_DEPTH_TEST);
}

void TerrainSurface::CastShadow(const Vector<Ecef>& to_sun) {
  const glm::dvec3 sun = frame_.EnuFromEcef(to_sun).xyz;
  if (indices_ == 0 || glm::length(sun - shadow_sun_) < 1e-3) return;
  shadow_sun_ = sun;
  const glm::dvec3 aside = glm::normalize(glm::cross(
      std::abs(sun.z) < 0.9 ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(1.0, 0.0, 0.0), sun));
  const glm::dvec3 over = glm::cross(sun, aside);
  glm::dvec3 low(std::numeric_limits<double>::infinity());
  glm::dvec3 high = -low;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 at{(corner & 1) != 0 ? high_.x : low_.x, (corner & 2) != 0 ? high_.y : low_.y,
                        (corner & 4) != 0 ? high_.z : low_.z};
    const glm::dvec3 seen{glm::dot(aside, at), glm::dot(over, at), -glm::dot(sun, at)};
    low = glm::min(low, seen);
    high = glm::max(high, seen);
  }
  const glm::dvec3 scale = 2.0 / (high - low);
  const glm::dvec3 shift = -(high + low) / (high - low);
  glm::dmat4 clip(1.0);  // columns
  for (glm::length_t axis = 0; axis < 3; ++axis) {
    clip[axis] = {scale.x * aside[axis], scale.y * over[axis], -scale.z * sun[axis], 0.0};
  }
  clip[3] = {shift, 1.0};
  shadow_from_mesh_ = clip;
  shadow_texel_m_ = std::max(high.x - low.x, high.y - low.y) / kShadowSize;

  glBindFramebuffer(GL_FRAMEBUFFER, shadow_target_.id());
  glViewport(0, 0, kShadowSize, kShadowSize);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glClear(GL_DEPTH_BUFFER_BIT);
  shadow_program_.Use();
  const glm::mat4 matrix(shadow_from_mesh_);
  glUniformMatrix4fv(shadow_program_.Uniform("shadow_from_mesh"), 1, GL_FALSE,
                     glm::value_ptr(matrix));
  // A look-up reaches two texels aside: what the depth of a plane changes over them is no shadow.
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(2.5F, 1.0F);
  glBindVertexArray(layout_.id());
  glDrawElements(GL_TRIANGLES, indices_, GL_UNSIGNED_INT, nullptr);
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDisable(GL_DEPTH_TEST);
}

glm::mat4 TerrainSurface::ShadowFromEye(const GeodeticPosition& eye) const {
  return glm::mat4(shadow_from_mesh_ * MeshFromEye(eye));
}

void TerrainSurface::BindShadow(int unit) const {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D, shadow_map_.id());
}

}  // namespace alpenglow
