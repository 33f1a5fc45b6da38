// SPDX-License-Identifier: MIT
#include "viewer/paint/star_painter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <utility>

namespace alpenglow {
namespace {

constexpr double kFaintest = 6.0;  // as the catalogue goes

void Attribute(GLuint location, GLint count, std::size_t offset) {
  glEnableVertexAttribArray(location);
  glVertexAttribPointer(location, count, GL_FLOAT, GL_FALSE, sizeof(StarVertex),
                        reinterpret_cast<const void*>(offset));
}

StarVertex VertexOf(const StarLight& star) {
  StarVertex vertex{{static_cast<float>(star.direction.x), static_cast<float>(star.direction.y),
                     static_cast<float>(star.direction.z)},
                    {}};
  std::copy_n(star.irradiance.value.begin(), star.irradiance.count, vertex.irradiance.begin());
  return vertex;
}

}  // namespace

StarPainter::StarPainter(ShaderProgram program) : program_(std::move(program)) {}

void StarPainter::Upload(const std::vector<StarVertex>& stars) {
  count_ = static_cast<int>(stars.size());
  glBindVertexArray(layout_.id());
  glBindBuffer(GL_ARRAY_BUFFER, buffer_.id());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(stars.size() * sizeof(StarVertex)),
               stars.data(), GL_DYNAMIC_DRAW);
  Attribute(0, 3, offsetof(StarVertex, direction));
  Attribute(1, 4, offsetof(StarVertex, irradiance));
}

void StarPainter::PrepareNone() { Upload({{{0.0F, 0.0F, 1.0F}, {}}}); }

void StarPainter::Prepare(const PaintedView& view, const MoonDisk& moon, const SolvedAir& air) {
  constexpr double kTime_s = 2.0, kPlace_m = 1000.0;
  const std::vector<double>& wavelengths_nm = air.medium.wavelengths_nm;
  const bool is_known =
      known_ && wavelengths_nm_ == wavelengths_nm &&
      std::abs(SecondsBetween(known_->now, view.now)) < kTime_s &&
      glm::length(LocalFrame(kWgs84, known_->eye.place).EnuFromGeodetic(view.eye.place).xyz) <
          kPlace_m;
  if (is_known) return;
  if (wavelengths_nm_ != wavelengths_nm) {
    colour_.emplace(wavelengths_nm);
    wavelengths_nm_ = wavelengths_nm;
  }
  std::vector<StarVertex> vertices;
  for (const StarLight& star :
       StarLightsOver(view.eye.place, view.now, kFaintest, moon, wavelengths_nm, *colour_))
    vertices.push_back(VertexOf(star));
  Upload(vertices);
  known_ = {view.eye, view.now};
}

void StarPainter::Paint(int width, int height) const {
  program_.Use();
  glUniform2f(program_.Uniform("picture_size"), static_cast<float>(width),
              static_cast<float>(height));
  glDepthFunc(GL_EQUAL);
  glEnable(GL_PROGRAM_POINT_SIZE);
  glBindVertexArray(layout_.id());
  glDrawArrays(GL_POINTS, 0, count_);
  glDisable(GL_PROGRAM_POINT_SIZE);
  has_painted_ = true;
}

}  // namespace alpenglow
