// SPDX-License-Identifier: MIT
// Depth alone of what the eye sees of the land.
void main() {
  if (sunk > 0.0) discard;
  WriteDepth(Distance());
}
