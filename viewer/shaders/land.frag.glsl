// SPDX-License-Identifier: MIT
// What the eye sees of the land.
in vec3 facing;
in vec4 sky_light;
in float sun_height;
in float sunk;
layout(location = 0) out vec4 surface;  // normal on the side that is seen, octahedral; height of
                                        // the sun over the terrain's edge; distance [m]
layout(location = 1) out vec4 sky_irradiance;  // in bands, per unit solar irradiance

// The card has the distance along the view, exactly; the rest is where in the view the pixel lies.
float Distance() {
  vec2 aside = (2.0 * gl_FragCoord.xy - eye_view.xy) * eye_view.zw;
  return sqrt(1.0 + dot(aside, aside)) / gl_FragCoord.w;
}

void main() {
  if (sunk > 0.0) discard;
  float d = Distance();
  vec3 n = gl_FrontFacing ? facing : -facing;
  surface = vec4(OctahedralFromVector(n), sun_height, d);
  sky_irradiance = sky_light;
  WriteDepth(d);
}
