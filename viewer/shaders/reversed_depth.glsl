// SPDX-License-Identifier: MIT
// Depth is what the card interpolates: nearest / distance along the view, which floats resolve to a
// part in ten million at any distance.
void WriteDepth(float distance_m) {}

// Nearness (nearness.glsl) at a depth; `slant` is distance over distance along the view.
float NearnessOfDepth(float depth, float slant) { return Nearness(0.1) * depth; }
