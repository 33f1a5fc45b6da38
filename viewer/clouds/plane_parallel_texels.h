// SPDX-License-Identifier: MIT
// The light of a plane-parallel layer of clouds as values of textures, from the discrete ordinates of
// cloud_light/plane_parallel_light.h instead of moments.
//
// With the light L(z, d) of higher orders in the layer, a thin part of a ray of the scaled optical depth
// t adds L(begin) - e^-t L(end) to it, so that its source is
//
//   J(z, d) = (L(begin) - e^-t L(end)) / (1 - e^-t)
//
// at the middle of each level. The levels' four largest eigenvectors u_k(z) of J J^T span it: a texel has
// the four components of its level, and the functions of the direction are b_k(d) = sum_z u_k(z) J(z, d).
#pragma once

#include "renderer/cloud_light/cloud_light.h"
#include "viewer/clouds/cloud_texels.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// Fills the light of a layer, of whose field IsPlaneParallel holds.
void FillPlaneParallelLight(const CloudLight& light, CloudLayerTexels& layer);

}  // namespace alpenglow::viewer
