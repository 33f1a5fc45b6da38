// SPDX-License-Identifier: MIT
// Where the eye is, where it looks, where the sun stands: ViewBlock of uniform_blocks.h. Frame:
// east, north, up at the eye.
layout(std140) uniform View {
  vec4 view_right;      // times the tangent of half the width of the view
  vec4 view_up;         // times the tangent of half its height
  vec4 view_forward;    // unit; angle between rays, of all that a pixel has [rad]
  vec4 sun;             // unit vector to the apparent sun; angular radius [rad]
  vec4 sun_for_air;     // unit vector to the sun whose straight rays light the air (SunForAir of sun.h)
  vec4 sun_irradiance;  // above the air, one value a band [W m^-2 nm^-1]
  vec4 bend;         // of refraction (bent_sight.glsl): radius of the planet that this one looks as,
                     // altitude above which rays are straight [km]; usual curvature [1/km], 0: none
  vec4 bend_slopes;  // curvature of level rays at altitude 0, by layer [1/km]
  vec4 bend_falls;   // with altitude [1/km]
  vec4 eye;  // altitude of the eye [km]; what is added to a pixel's place, in half widths and
             // heights: rays of a pixel differ by it; radius of the planet [km], 0: none is in sight
};

#define EYE_ALTITUDE eye.x
#define PICTURE_SHIFT eye.yz
#define PLANET_RADIUS eye.w
#define LOOK_RADIUS bend.x
#define BEND_TOP bend.y
#define BEND_USUAL bend.z
#define RAY_ANGLE view_forward.w

// Of a place in the picture, from (-1, -1) to (1, 1).
vec3 ViewDirection(vec2 screen) {
  vec2 at = screen + PICTURE_SHIFT;
  return normalize(view_forward.xyz + at.x * view_right.xyz + at.y * view_up.xyz);
}
