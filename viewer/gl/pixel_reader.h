// SPDX-License-Identifier: MIT
// Pixels on their way back from the graphics card, without waiting for it.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "viewer/gl/gl_objects.h"
#include "viewer/gl/render_target.h"

namespace alpenglow::viewer {

/// Reads one rectangle after the other. An OpenGL context must be current in all calls.
class PixelReader {
 public:
  /// Of a picture [pixels], row 0 at the bottom as OpenGL has it.
  struct Rectangle {
    int left, bottom, width, height;
  };

  PixelReader() = default;
  ~PixelReader();
  PixelReader(const PixelReader&) = delete;
  PixelReader& operator=(const PixelReader&) = delete;

  /// Begins to read red, green and blue of the first output; nothing while Busy().
  void Begin(const RenderTarget& picture, const Rectangle& part);
  /// Gives up what was begun.
  void Forget();
  /// Whether what was begun is not taken yet.
  [[nodiscard]] bool Busy() const { return arrives_ != nullptr; }
  /// What was begun, once it has arrived: most often a frame or two later.
  [[nodiscard]] std::optional<std::vector<std::array<float, 3>>> Take();

 private:
  GlBuffer buffer_;
  std::size_t pixels_ = 0;
  GLsync arrives_ = nullptr;
};

}  // namespace alpenglow::viewer
