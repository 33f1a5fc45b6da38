// SPDX-License-Identifier: MIT
// The reading of the shared texts on the graphics card, against the one in C++ float.
#include <gtest/gtest.h>

#include <cstddef>

#include "tests/shared_text_cases.h"
#include "tests/viewer/headless.h"
#include "viewer/gl_objects.h"
#include "viewer/shader.h"

namespace alpenglow {
namespace {

using SharedText = testing::Headless;
using testing::Arguments;

/// A picture of one pixel to draw into: without a window there is none, and OpenGL wants one even
/// for draws that stop before the rasteriser.
class OnePixel {
 public:
  OnePixel() {
    glBindTexture(GL_TEXTURE_2D, pixel_.id());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 1, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glBindFramebuffer(GL_FRAMEBUFFER, target_.id());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, pixel_.id(), 0);
  }

 private:
  GlTexture pixel_;
  GlFramebuffer target_;
};

/// Values of an expression in a[0] ... a[7], one a vertex, recorded by transform feedback.
std::vector<float> EvaluateOnGpu(const std::string& expression,
                                 const std::vector<Arguments<float>>& points) {
  std::vector<ShaderPiece> pieces = SharedTexts();
  pieces.push_back({"expression",
                    "in vec4 first;\nin vec4 second;\nout float value;\nvoid main() {\n"
                    "  float a[8] = float[8](first.x, first.y, first.z, first.w, second.x, "
                    "second.y, second.z, second.w);\n  value = " +
                        expression + ";\n}\n"});
  const ShaderProgram program = ShaderProgram::ForTransformFeedback(pieces, {"value"});
  const OnePixel target;
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
  glEnable(GL_RASTERIZER_DISCARD);
  glBeginTransformFeedback(GL_POINTS);
  glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(points.size()));
  glEndTransformFeedback();
  glDisable(GL_RASTERIZER_DISCARD);
  glGetBufferSubData(GL_TRANSFORM_FEEDBACK_BUFFER, 0, bytes, values.data());
  CheckGl("EvaluateOnGpu");
  return values;
}

TEST_F(SharedText, GpuAgreesWithFloatToOnePartInAHundredThousand) {
  for (const testing::SharedTextCase& c : testing::AllSharedTextCases()) {
    SCOPED_TRACE(c.glsl);
    const std::vector<float> on_gpu = EvaluateOnGpu(c.glsl, c.points);
    for (std::size_t i = 0; i < c.points.size(); ++i) {
      ASSERT_NEAR(static_cast<double>(on_gpu[i]), static_cast<double>(c.in_float(c.points[i])),
                  testing::Allowance(c, c.points[i]))
          << "at " << ::testing::PrintToString(c.points[i])
          << "; allowed are 1e-5 and what one ulp of the arguments changes";
    }
  }
}

TEST_F(SharedText, AMessageOfTheDriverNamesOurFileAndLine) {
  std::vector<ShaderPiece> pieces = SharedTexts();
  pieces.push_back({"viewer/broken.glsl", "void main() {\n  gl_Position = nonsense;\n}\n"});
  try {
    ShaderProgram::ForTransformFeedback(pieces, {});
    FAIL() << "a broken shader was accepted";
  } catch (const InternalError& error) {
    EXPECT_NE(std::string(error.what()).find("viewer/broken.glsl:2"), std::string::npos)
        << error.what();
  }
}

TEST(ShaderText, LinesOfPiecesBecomeNamesAndLinesInTheLogsOfThreeDrivers) {
  const std::vector<ShaderPiece> pieces{{"a.glsl", ""}, {"b.glsl", ""}};
  EXPECT_EQ(NamePieces("0:100012(5): error: x\n0:3(1): error: y", pieces),
            "b.glsl:12: error: x\na.glsl:3: error: y");
  EXPECT_EQ(NamePieces("0(100012) : error C1008", pieces), "b.glsl:12 : error C1008");
  EXPECT_EQ(NamePieces("ERROR: 0:100012: 'x'", pieces), "ERROR: b.glsl:12: 'x'");
  EXPECT_EQ(NamePieces("0:700012(5): z", pieces), "0:700012(5): z")
      << "no such piece: left as it is";
}

TEST(ShaderText, EveryPieceHasLinesOfItsOwn) {
  const std::vector<ShaderPiece> pieces{{"a.glsl", "float a;"}, {"b.glsl", "float b;"}};
  EXPECT_EQ(ComposeShader(pieces),
            "#version 330 core\n#line 1\nfloat a;\n#line 100001\nfloat b;\n");
}

}  // namespace
}  // namespace alpenglow
