// SPDX-License-Identifier: MIT
// Position and view of the eye, and the lights of the sky: ViewBlock of pass_setup.h. Frame:
// east, north, up at the eye.
layout(std140) uniform View {
  vec4 view_right;      // times the tangent of half the horizontal field of view
  vec4 view_up;         // times the tangent of half the vertical field of view
  vec4 view_forward;    // unit vector; angle between rays, counting all of a pixel [rad]
  vec4 sun;             // unit vector to the apparent sun; angular radius [rad]
  vec4 sun_for_air;     // unit vector to the sun whose straight rays light the air (SunForAir)
  vec4 sun_irradiance;  // above the air, one value per band [W m^-2 nm^-1]
  vec4 bend;         // refraction (view/refracted_rays.glsl): apparent radius of the planet; altitude
                     // above which rays are straight [km]; usual curvature [1/km], 0: none
  vec4 bend_slopes;  // curvature of level rays at altitude 0, by layer [1/km]
  vec4 bend_falls;   // decrease of the curvature with altitude [1/km]
  vec4 eye;  // altitude of the eye [km]; offset of the ray from the pixel, in half widths
             // and heights of the picture; radius of the planet [km], 0: not in sight
  vec4 other_sun;             // the second light of the sky, in programs with TWO_LIGHTS
  vec4 other_sun_for_air;
  vec4 other_sun_irradiance;
  vec4 night_scattered;  // the night sky: radiance of an infinite path of air [W m^-2 sr^-1 nm^-1],
  vec4 night_level;      // and irradiance of level ground [W m^-2 nm^-1]; in programs with HAS_NIGHT
};

#ifdef TWO_LIGHTS
#define sun (of_other ? other_sun : sun)
#define sun_for_air (of_other ? other_sun_for_air : sun_for_air)
#define sun_irradiance (of_other ? other_sun_irradiance : sun_irradiance)
#endif

#define EYE_ALTITUDE eye.x
#define PICTURE_SHIFT eye.yz
#define PLANET_RADIUS eye.w
#define LOOK_RADIUS bend.x
#define BEND_TOP bend.y
#define BEND_USUAL bend.z
#define RAY_ANGLE view_forward.w

// Returns the direction of a point in the picture, from (-1, -1) to (1, 1).
vec3 ViewDirection(vec2 screen) {
  vec2 at = screen + PICTURE_SHIFT;
  return normalize(view_forward.xyz + at.x * view_right.xyz + at.y * view_up.xyz);
}
