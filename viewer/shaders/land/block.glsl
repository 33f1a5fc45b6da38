// SPDX-License-Identifier: MIT
// The eye relative to the vertices of land, which are in metres in the frame of an anchor. The
// eye's position in that frame is split into two floats per coordinate, so that differences near
// the eye are exact to a micrometre.
layout(std140) uniform Land {
  vec4 eye_high;  // position of the eye in the anchor's frame [m]
  vec4 eye_low;   // remainder that a float cannot hold
  vec4 east;      // axes of the eye's frame in the anchor's
  vec4 north;
  vec4 up;
  vec4 eye_sample;  // column and row of the eye from the anchor's; radians per column and row
  vec4 eye_above;   // height over all nearby ground [m]; weight of the new light; 1: reversed
                    // depth; weight of horizon_sines in the shadow edges
  vec4 pixel;       // width and height of a pixel, in a picture from (-1, -1) to (1, 1)
  vec4 horizon_u;   // from (x, y, z, 1) in the anchor's frame to coordinates of horizon_sines
  vec4 horizon_v;
  vec4 risen;       // rise of the disk since the old and new shadow edges [its radii]
  vec4 globe;       // sine and cosine of the eye's latitude; radius [m]; columns of a whole turn, 0
                    // if the land does not close around the earth
  vec4 turning[32];  // by level: start of the morph range [m], inverse of its length [1/m]
};
