// SPDX-License-Identifier: MIT
#include "viewer/gl/render_target.h"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/viewer/shaders/headless.h"
#include "viewer/gl/gl_context.h"
#include "viewer/gl/shader.h"

namespace alpenglow::viewer {
namespace {

class RenderTargets : public tests::Headless {
 protected:
  static void Draw(const RenderTarget& target, const std::string& outputs) {
    const ShaderProgram program(
        {{"vertex",
          "void main() { vec2 p = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);\n"
          "gl_Position = vec4(2.0 * p - 1.0, 0.5, 1.0); }"}},
        {{"fragment", outputs}});
    const GlVertexArray none;
    target.Bind();
    glBindVertexArray(none.id());
    program.Use();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    CheckGl("RenderTargets");
  }
};

constexpr const char* kTwoOutputs =
    "layout(location = 0) out vec4 a; layout(location = 1) out vec4 b;\n"
    "void main() {\n"
    "  a = vec4(gl_FragCoord.xy, -1e-7, 1e9);\n"
    "  b = vec4(gl_FragCoord.y, 1.0 / 3.0, 65504.0, -2.0); }\n";

TEST_F(RenderTargets, SeveralOutputsOfOneDrawAreReadEachInItsOwnFormat) {
  const RenderTarget target(4, 3, {PixelFormat::kRgba32F, PixelFormat::kRgba16F},
                            RenderTarget::Depth::k32Bit);
  Draw(target, kTwoOutputs);
  const std::vector<glm::vec4> a = target.ReadValues(0);
  ASSERT_EQ(a.size(), 12U);
  EXPECT_EQ(a[0], glm::vec4(0.5F, 2.5F, -1e-7F, 1e9F)) << "the first row is the highest";
  EXPECT_EQ(a[11], glm::vec4(3.5F, 0.5F, -1e-7F, 1e9F));
  EXPECT_EQ(target.ReadValues(1)[0], glm::vec4(2.5F, 0x555p-12F, 65504.0F, -2.0F))
      << "halves have eleven bits: 1/3 is 0x555 / 2^12";
  EXPECT_EQ(target.Read().at(3, 2)[0], 3.5F) << "reading one output leaves the others";
}

TEST_F(RenderTargets, WhatIsPutThereIsReadBack) {
  const RenderTarget target(3, 2, RenderTarget::Depth::kNone);
  Image image(3, 2);
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    image.rgb[i] = {static_cast<float>(i), -1.0F, 1e6F};
  }
  target.Write(image);
  EXPECT_EQ(target.Read().rgb, image.rgb);
  EXPECT_THROW(target.Write(Image(2, 3)), InternalError);
}

TEST_F(RenderTargets, BytesAreOfADevelopedPicture) {
  const RenderTarget target(4, 3);
  Draw(target, "out vec4 a; void main() { a = vec4(gl_FragCoord.y / 4.0, 0.2, 1.0, 0.0); }\n");
  const DisplayImage image = target.ReadBytes();
  EXPECT_EQ(image.width, 4);
  EXPECT_EQ(image.rgb[0], std::lround(255 * 2.5 / 4.0)) << "of the highest row";
  EXPECT_EQ(image.rgb[1], 51);
}

TEST_F(RenderTargets, MakingOneLeavesWhatIsBoundToATextureUnit) {
  const GlTexture texture;
  glBindTexture(GL_TEXTURE_2D, texture.id());
  const RenderTarget target(3, 2, RenderTarget::Depth::k32Bit);
  GLint bound = 0;
  glGetIntegerv(GL_TEXTURE_BINDING_2D, &bound);
  EXPECT_EQ(static_cast<GLuint>(bound), texture.id());
}

TEST_F(RenderTargets, ATargetIsMadeAnewForAnotherSizeAlone) {
  std::optional<RenderTarget> target;
  Fit(target, 3, 2);
  const GLuint first = target->framebuffer();
  Fit(target, 3, 2);
  EXPECT_EQ(target->framebuffer(), first);
  Fit(target, 3, 4);
  EXPECT_EQ(target->height(), 4);
}

TEST_F(RenderTargets, APictureWithoutMemoryForItIsADisplayError) {
  GLint side = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &side);
  glTexImage2D(GL_PROXY_TEXTURE_2D, 0, GL_RGBA32F, side, side, 0, GL_RGBA, GL_FLOAT, nullptr);
  GLint held = 0;
  glGetTexLevelParameteriv(GL_PROXY_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &held);
  if (held == side) GTEST_SKIP() << "this driver has memory for all that it draws";
  EXPECT_THROW(RenderTarget(side, side, RenderTarget::Depth::kNone), DisplayError);
}

}  // namespace
}  // namespace alpenglow::viewer
