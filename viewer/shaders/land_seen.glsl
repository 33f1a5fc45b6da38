// SPDX-License-Identifier: MIT
// A fragment of land.
in float sunk;  // [km]; over 0: the planet hides it

// The card has the distance along the view, exactly; the rest is where in the view the ray of the
// pixel lies.
float Distance() {
  vec2 shift = PICTURE_SHIFT * vec2(length(view_right.xyz), length(view_up.xyz));
  vec2 aside = (2.0 * gl_FragCoord.xy - eye_view.xy) * eye_view.zw + shift;
  return sqrt(1.0 + dot(aside, aside)) / gl_FragCoord.w;
}
