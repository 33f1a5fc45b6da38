// SPDX-License-Identifier: MIT
// What --explain prints: a view on the graphics card beside the renderer's, and each shortcut alone.
#pragma once

#include <string>

#include "viewer/flythrough.h"

namespace alpenglow::viewer {

/// A table of text: of the picture, and of each shortcut against its best setting, the mean, 99 % and
/// 99.9 % of pixels (ViewDifference), and the time of a frame that it saves. The renderer's land is
/// what the scene names, or of several elevation models what is loaded around the eye.
[[nodiscard]] std::string ExplainView(Flythrough& flight, const ImageSize& size);

}  // namespace alpenglow::viewer
