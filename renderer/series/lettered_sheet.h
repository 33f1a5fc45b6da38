// SPDX-License-Identifier: MIT
// A dark sheet with pictures and short texts, for pictures that are made of a series. Its letters are
// 3 x 5 dots, so that no font file is needed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "lut/image/image.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

class LetteredSheet {
 public:
  LetteredSheet(int width, int height);

  /// Copies a picture to a place, within the sheet.
  void Paste(const DisplayImage& picture, int left, int top);
  /// Fills a rectangle with the colour of letters; parts beside the sheet are omitted.
  void Fill(int left, int top, int width, int height);
  /// Prints digits, ':', '.', '+' and '-'; other characters are left blank.
  void Print(std::string_view text, int left, int top);

  [[nodiscard]] const DisplayImage& image() const { return image_; }

  static constexpr int kDot = 3;  // side of a dot of a letter
  static constexpr int kTextHeight = 5 * kDot;
  /// Returns the width of a text.
  [[nodiscard]] static int TextWidth(std::string_view text) {
    return static_cast<int>(text.size()) * kAdvance - kDot;
  }

 private:
  static constexpr int kAdvance = 4 * kDot;  // from one letter to the next

  [[nodiscard]] std::size_t Index(int x, int y) const {
    return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) +
                static_cast<std::size_t>(x));
  }

  DisplayImage image_;
};

}  // namespace alpenglow::renderer
