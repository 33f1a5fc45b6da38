// SPDX-License-Identifier: MIT
// The square of a lamp's core, for lamp gl_InstanceID of the block.
out vec2 screen;
flat out int number;

void main() {
  number = gl_InstanceID;
  Lamp lamp = lamps[gl_InstanceID];
  gl_Position = LampCorner(lamp.position.xyz / lamp.profile.z, lamp.glow.z * lamp_count.z);
  if (lamp.glow.z <= 0.0) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  screen = gl_Position.xy;
}
