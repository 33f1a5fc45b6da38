// SPDX-License-Identifier: MIT
// Writes the visible land to a GBuffer. MOONLIT as in land/land.vert.glsl.
in vec3 facing;
in vec4 sky_light;
in float disk_height;
// Outputs of GBuffer of land_pass.h. The normal points to the visible side.
layout(location = 0) out vec4 surface;
layout(location = 1) out vec4 sky_irradiance;
#if MOONLIT
in vec4 moon_sky_light;
layout(location = 2) out vec4 moon_sky_irradiance;
#endif

void main() {
  if (sunk > 0.0) discard;
  float d = Distance();
  vec3 n = gl_FrontFacing ? facing : -facing;
  surface = vec4(OctahedralFromVector(n), disk_height, d);
  sky_irradiance = sky_light;
#if MOONLIT
  moon_sky_irradiance = moon_sky_light;
#endif
  WriteDepth(d);
}
