// SPDX-License-Identifier: MIT
// Terrain seen from the sun.
uniform mat4 shadow_from_mesh;
in vec3 position;

void main() { gl_Position = shadow_from_mesh * vec4(position, 1.0); }
