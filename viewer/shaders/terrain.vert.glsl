// SPDX-License-Identifier: MIT
// Terrain relative to the eye. Vertices are metres in the frame of the mesh; the eye's position
// there comes in two floats a coordinate, so that what is left near the eye is right to a
// micrometre.
layout(std140) uniform Mesh {
  vec4 eye_high;  // position of the eye in the mesh's frame [m]
  vec4 eye_low;   // and what float cannot hold of it
  vec4 east;      // axes of the eye's frame in the mesh's
  vec4 north;
  vec4 up;
};
in vec3 position;
in vec3 normal;
out vec3 from_eye;  // [m], east, north, up at the eye
out vec3 facing;    // normal, in the same frame

vec3 InEyeFrame(vec3 v) { return vec3(dot(v, east.xyz), dot(v, north.xyz), dot(v, up.xyz)); }

void main() {
  const float nearest = 0.1;  // m
  from_eye = InEyeFrame((position - eye_high.xyz) - eye_low.xyz);
  facing = InEyeFrame(normal);
  float along_view = dot(from_eye, view_forward.xyz);
  float width = dot(view_right.xyz, view_right.xyz);
  float height = dot(view_up.xyz, view_up.xyz);
  // Only the near plane clips: z = w - 2 near. Depth is written by the fragment stage.
  gl_Position = vec4(dot(from_eye, view_right.xyz) / width, dot(from_eye, view_up.xyz) / height,
                     along_view - 2.0 * nearest, along_view);
}
