// SPDX-License-Identifier: MIT
// One triangle over the whole picture, or squares in it. `screen` runs from (-1, -1) to (1, 1) over
// the picture.
in vec4 square;  // lower left and upper right corner; all 0: the triangle
out vec2 screen;

void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  bool right = gl_VertexID % 2 == 1, above = gl_VertexID / 2 == 1;
  vec2 of_square = vec2(right ? square.z : square.x, above ? square.w : square.y);
  screen = square.xy == square.zw ? corner : of_square;
  gl_Position = vec4(screen, -1.0, 1.0);  // depth 0
}
