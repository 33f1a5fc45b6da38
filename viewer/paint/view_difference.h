// SPDX-License-Identifier: MIT
// How far the picture on the graphics card is from the renderer's, edges aside.
//
// Of a pixel: PixelChange (picture_change.h), the relative difference of linear radiance above the
// floor of ChangeFloor. Left out are pixels beside an edge, where a hundredth of a pixel decides
// what is seen: whose neighbours are of another kind, a tenth farther or nearer, or lit by more or
// less of the sun's disk, or by a fifth more or less by lamps.
#pragma once

#include <vector>

#include "lut/picture/image.h"
#include "renderer/picture/picture_layers.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

struct ViewDifference {
  double mean = 0.0;
  double at_99_percent = 0.0;
  double at_999_permille = 0.0;
  double worst = 0.0;
  double edge_share = 0.0;  // of all pixels that were left out
};

/// Layers that the renderer's picture has; without that of lamps these have no edges.
[[nodiscard]] std::vector<PictureLayer> LayersOfEdges();

/// Pixels of the renderer's picture that stand beside an edge, row by row.
[[nodiscard]] std::vector<bool> EdgesOf(const Image& judge);

/// @param judge  the renderer's, with LayersOfEdges(). Throws InternalError for other sizes and for
///     pictures that are nothing but edges.
[[nodiscard]] ViewDifference DifferenceOf(const Image& judge, const Image& painted);

}  // namespace alpenglow::viewer
