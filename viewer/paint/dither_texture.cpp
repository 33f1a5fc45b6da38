// SPDX-License-Identifier: MIT
#include "viewer/paint/dither_texture.h"

#include <vector>

#include "lut/picture/dither.h"
#include "viewer/gl/render_target.h"

namespace alpenglow::viewer {

DitherTexture::DitherTexture() {
  std::vector<float> noise;
  for (int y = 0; y < kDitherTileSize; ++y) {
    for (int x = 0; x < kDitherTileSize; ++x) {
      for (int channel = 0; channel < 3; ++channel) noise.push_back(DitherNoise(x, y, channel));
      noise.push_back(0.0F);
    }
  }
  glBindTexture(GL_TEXTURE_2D, noise_.id());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, kDitherTileSize, kDitherTileSize, 0, GL_RGBA, GL_FLOAT,
               noise.data());
  ClampAndFilter(GL_TEXTURE_2D, false);
}

void DitherTexture::Bind(const ShaderProgram& program, int unit, int width, int height) const {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D, noise_.id());
  glUniform1i(program.Uniform("dither_noise"), unit);
  glUniform2f(program.Uniform("screen_size"), static_cast<float>(width),
              static_cast<float>(height));
}

}  // namespace alpenglow::viewer
