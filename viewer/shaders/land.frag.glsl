// SPDX-License-Identifier: MIT
// What the eye sees of the land.
in vec3 facing;
in vec4 sky_light;
in float sun_height;
layout(location = 0) out vec4 surface;  // normal on the side that is seen, octahedral; height of
                                        // the sun over the terrain's edge; distance [m]
layout(location = 1) out vec4 sky_irradiance;  // in bands, per unit solar irradiance

void main() {
  if (sunk > 0.0) discard;
  float d = Distance();
  vec3 n = gl_FrontFacing ? facing : -facing;
  surface = vec4(OctahedralFromVector(n), sun_height, d);
  sky_irradiance = sky_light;
  WriteDepth(d);
}
