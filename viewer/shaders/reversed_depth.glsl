// SPDX-License-Identifier: MIT
// Depth is what the card interpolates: nearest / distance along the view, which floats resolve to a
// part in ten million at any distance.
void WriteDepth(float distance_m) {}
