// SPDX-License-Identifier: MIT
#include "viewer/shade/shade_texture.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

#include "atmosphere/text/error.h"
#include "viewer/gl/gl_context.h"
#include "viewer/gl/render_target.h"

namespace alpenglow::viewer {
namespace {

// The component of a place along an axis of the map's frame, scaled and shifted, for places in the
// frame of the eye.
glm::vec4 Row(const glm::dmat4& map_from_eye, const glm::dvec3& axis, double scale, double shift) {
  const auto along = [&](int column) {
    return scale * glm::dot(glm::dvec3(map_from_eye[column]), axis);
  };
  return {along(0), along(1), along(2), along(3) + shift};
}

void Allocate(const ShadeMap& map) {
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RG32F, map.columns, map.lines, 0, GL_RG, GL_FLOAT, nullptr);
  ClampAndFilter(GL_TEXTURE_2D, true);
}

}  // namespace

void ShadeTexture::TakeOver(std::shared_ptr<const ShadeMap> map) {
  ALPENGLOW_ENSURE(map != nullptr, ==, true);
  coming_.map = std::move(map);
  lines_sent_ = 0;
}

bool ShadeTexture::Upload(int most_lines, int unit) {
  if (!coming_.map) return false;
  const ShadeMap& map = *coming_.map;
  if (!map.ShadesNothing()) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_2D, coming_.texture.id());
    if (lines_sent_ == 0) Allocate(map);
    const int lines = std::min(most_lines, map.lines - lines_sent_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, lines_sent_, map.columns, lines, GL_RG, GL_FLOAT,
                    &map.at(0, lines_sent_));
    lines_sent_ += lines;
    CheckGl("ShadeTexture::Upload");
  }
  if (lines_sent_ < map.lines) return false;
  std::swap(used_, coming_);
  coming_.map = nullptr;
  return true;
}

void ShadeTexture::Bind(const ShaderProgram& program, int unit, const glm::dmat4& map_from_eye,
                        const ShadeSteps& steps) const {
  ALPENGLOW_ENSURE(Shades(), ==, true);
  const ShadeMap& map = *used_.map;
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D, used_.texture.id());
  glUniform1i(program.Uniform("shade_map"), unit);
  const double across_u = 1.0 / (map.cell_m * map.columns);
  const double across_v = 1.0 / (map.cell_m * map.lines);
  // Nodes are the middles of texels.
  const auto u = [&](double u_m) { return (u_m - map.first_u_m + 0.5 * map.cell_m) * across_u; };
  const auto v = [&](double v_m) { return (v_m - map.first_v_m + 0.5 * map.cell_m) * across_v; };
  const auto set = [&](const char* name, const glm::vec4& row) {
    glUniform4f(program.Uniform(name), row.x, row.y, row.z, row.w);
  };
  set("shade_u", Row(map_from_eye, map.sunwards, across_u, u(0.0)));
  set("shade_v", Row(map_from_eye, map.across, across_v, v(0.0)));
  set("shade_z", Row(map_from_eye, {0.0, 0.0, 1.0}, 1.0, 0.0));
  const glm::vec3 low(u(map.low_u_m), v(map.low_v_m), map.floor_m);
  const glm::vec3 high(u(map.high_u_m), v(map.high_v_m), map.ceiling_m);
  glUniform3f(program.Uniform("shade_low"), low.x, low.y, low.z);
  glUniform3f(program.Uniform("shade_high"), high.x, high.y, high.z);
  glUniform2f(program.Uniform("shade_first"), static_cast<float>(u(map.first_u_m)),
              static_cast<float>(map.tangent / across_u));
  glUniform1i(program.Uniform("shade_pieces"), steps.pieces);
  glUniform1i(program.Uniform("shade_steps"), steps.steps);
}

}  // namespace alpenglow::viewer
