// SPDX-License-Identifier: MIT
// One triangle over the whole picture; `screen` runs from (-1, -1) to (1, 1).
out vec2 screen;

void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  screen = corner;
  gl_Position = vec4(corner, -1.0, 1.0);  // depth 0
}
