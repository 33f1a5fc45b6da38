// SPDX-License-Identifier: MIT
// Panoramas of all directions, in the projection of the renderer's CameraRays. They are assembled
// from six square perspectives around the eye, whose pixels are finer than those of the panorama.
#pragma once

#include <functional>

#include "lut/image/image.h"
#include "viewer/layer.h"
#include "viewer/passes/painted_view.h"

namespace alpenglow::viewer {

/// Returns whether a view is a panorama: Camera::IsPanorama.
[[nodiscard]] bool IsPanorama(const PaintedView& view);

/// Number of perspectives of a panorama.
inline constexpr int kPanoramaSides = 6;

/// Returns a panorama. Each of its pixels is the mean of the perspectives over 4 x 4 directions.
/// @param paint  returns the picture of a perspective. It is called kPanoramaSides
///     times.
[[nodiscard]] HdrImage PaintPanorama(const PaintedView& panorama,
                                     const std::function<HdrImage(const PaintedView& side)>& paint);

}  // namespace alpenglow::viewer
