// SPDX-License-Identifier: MIT
// Inputs and distance of a fragment of land.
in float sunk;  // [km]; positive: hidden by the planet

// Returns the distance. gl_FragCoord.w gives the exact distance along the view axis; the remaining
// factor depends on the position of the pixel's ray in the view.
float Distance() {
  vec2 at = pixel.xy * gl_FragCoord.xy - 1.0 + PICTURE_SHIFT;
  vec2 aside = at * vec2(length(view_right.xyz), length(view_up.xyz));
  return sqrt(1.0 + dot(aside, aside)) / gl_FragCoord.w;
}
