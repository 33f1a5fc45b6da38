// SPDX-License-Identifier: MIT
// Writes only the depth of the visible land.
void main() {
  if (sunk > 0.0) discard;
  WriteDepth(Distance());
}
