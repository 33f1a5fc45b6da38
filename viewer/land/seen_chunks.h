// SPDX-License-Identifier: MIT
// Which chunks the eye may see. Never leaves one out by mistake; keeps their order.
#pragma once

#include <vector>

#include "viewer/land/chunk_buffers.h"
#include "viewer/land/land_pass.h"

namespace alpenglow::viewer {

/// Those that may reach into the view, where they are or lifted by bent rays.
[[nodiscard]] std::vector<ChunkBuffers::Drawn> InView(std::vector<ChunkBuffers::Drawn> chunks,
                                                      const EyeInAnchor& eye, const LandView& view);

/// Those that have a part which no nearer land hides (skyline.h), for an eye over the ground.
/// @param bends_per_m  most curvature of rays.
[[nodiscard]] std::vector<ChunkBuffers::Drawn> WithoutHidden(
    const std::vector<ChunkBuffers::Drawn>& chunks, const EyeInAnchor& eye, double bends_per_m);

/// No part of them is farther from the eye [m].
[[nodiscard]] double FarthestOf(const std::vector<ChunkBuffers::Drawn>& chunks,
                                const EyeInAnchor& eye);

}  // namespace alpenglow::viewer
