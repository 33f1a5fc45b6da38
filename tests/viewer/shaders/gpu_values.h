// SPDX-License-Identifier: MIT
// Values of GLSL expressions, for tests.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tests/fixtures/shared_text_cases.h"
#include "viewer/gl/gl_context.h"
#include "viewer/gl/render_target.h"
#include "viewer/gl/shader.h"

namespace alpenglow::tests {

using namespace viewer;

/// Values of an expression in a[0] ... a[7], one a point, recorded by transform feedback.
/// @param prepare  gives the program what its texts read besides the arguments.
inline std::vector<float> EvaluateOnGpu(
    std::vector<ShaderPiece> pieces, const std::string& expression,
    const std::vector<Arguments<float>>& points,
    const std::function<void(const ShaderProgram&)>& prepare = [](const ShaderProgram&) {}) {
  pieces.push_back({"expression",
                    "in vec4 first;\nin vec4 second;\nout float value;\nvoid main() {\n"
                    "  float a[8] = float[8](first.x, first.y, first.z, first.w, second.x, "
                    "second.y, second.z, second.w);\n  value = " +
                        expression + ";\n}\n"});
  const ShaderProgram program = ShaderProgram::ForTransformFeedback(pieces, {"value"});
  // Without a window there is nothing to draw into, and OpenGL wants it even for draws that stop
  // before the rasteriser.
  const RenderTarget target(1, 1);
  const GlVertexArray layout;
  glBindVertexArray(layout.id());
  const GlBuffer arguments;
  glBindBuffer(GL_ARRAY_BUFFER, arguments.id());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(points.size() * sizeof(points[0])),
               points.data(), GL_STATIC_DRAW);
  for (const auto& [name, offset] : {std::pair{"first", 0UL}, std::pair{"second", 16UL}}) {
    const GLint at = glGetAttribLocation(program.id(), name);
    if (at < 0) continue;  // the expression does not read it
    glEnableVertexAttribArray(static_cast<GLuint>(at));
    glVertexAttribPointer(static_cast<GLuint>(at), 4, GL_FLOAT, GL_FALSE, sizeof(points[0]),
                          reinterpret_cast<const void*>(offset));
  }
  std::vector<float> values(points.size());
  const auto bytes = static_cast<GLsizeiptr>(values.size() * sizeof(float));
  const GlBuffer recorded;
  glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, recorded.id());
  glBufferData(GL_TRANSFORM_FEEDBACK_BUFFER, bytes, nullptr, GL_STREAM_READ);
  program.Use();
  prepare(program);
  glEnable(GL_RASTERIZER_DISCARD);
  glBeginTransformFeedback(GL_POINTS);
  glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(points.size()));
  glEndTransformFeedback();
  glDisable(GL_RASTERIZER_DISCARD);
  glGetBufferSubData(GL_TRANSFORM_FEEDBACK_BUFFER, 0, bytes, values.data());
  CheckGl("EvaluateOnGpu");
  return values;
}

/// Evaluates an expression that may use the shared texts and `texts`.
inline std::vector<float> EvaluateWithTexts(
    std::vector<ShaderPiece> texts, const std::string& expression,
    const std::vector<Arguments<float>>& points,
    const std::function<void(const ShaderProgram&)>& prepare = [](const ShaderProgram&) {}) {
  std::vector<ShaderPiece> pieces = SharedTexts();
  for (ShaderPiece& text : texts) pieces.push_back(std::move(text));
  return EvaluateOnGpu(std::move(pieces), expression, points, prepare);
}

}  // namespace alpenglow::tests
