// SPDX-License-Identifier: MIT
// A fragment of land.
in float sunk;  // [km]; over 0: the planet hides it

// The card has the distance along the view, exactly; the rest is where in the view the ray of the
// pixel lies.
float Distance() {
  vec2 at = pixel.xy * gl_FragCoord.xy - 1.0 + PICTURE_SHIFT;
  vec2 aside = at * vec2(length(view_right.xyz), length(view_up.xyz));
  return sqrt(1.0 + dot(aside, aside)) / gl_FragCoord.w;
}
