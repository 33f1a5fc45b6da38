// SPDX-License-Identifier: MIT
// What the air leaves of a star, in one of its pixels.
flat in vec3 direction;
flat in vec4 radiance;
flat in vec2 place;
flat in vec2 bell_sum;
out vec4 picture;

void main() {
  vec2 off = 2.0 * (gl_FragCoord.xy - place);
  float share = exp(-0.5 * dot(off, off)) / (bell_sum.x * bell_sum.y);
  bool planet = GroundClearance(EYE_ALTITUDE, direction.z, RADIUS) > 0.0;
  vec4 left = planet ? vec4(0.0)
                     : TransmittanceToSpace(direction) * FogTransmittance(direction, 1e3);
  picture = vec4(share * LinearSrgb(left * radiance), 0.0);
}
