// SPDX-License-Identifier: MIT
// Draws into a part of what is bound.
#pragma once

#include <epoxy/gl.h>

namespace alpenglow::viewer {

/// Pixels from a lower left one on.
struct PixelBox {
  int x, y, width, height;
};

/// Draws reach pixels of the box alone, as long as it lives. Not within another.
class Scissor {
 public:
  explicit Scissor(const PixelBox& box) {
    glEnable(GL_SCISSOR_TEST);
    glScissor(box.x, box.y, box.width, box.height);
  }
  ~Scissor() { glDisable(GL_SCISSOR_TEST); }
  Scissor(const Scissor&) = delete;
  Scissor& operator=(const Scissor&) = delete;
};

}  // namespace alpenglow::viewer
