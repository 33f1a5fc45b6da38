// SPDX-License-Identifier: MIT
// The eye among the land's vertices. These are metres in the frame of an anchor; the eye's position
// there comes in two floats a coordinate, so that what is left near the eye is right to a
// micrometre.
layout(std140) uniform Land {
  vec4 eye_high;  // position of the eye in the anchor's frame [m]
  vec4 eye_low;   // and what float cannot hold of it
  vec4 east;      // axes of the eye's frame in the anchor's
  vec4 north;
  vec4 up;
  vec4 eye_sample;  // column and row of the eye from the anchor's; metres a column and a row
  vec4 eye_above;   // height over all ground about [m]; share of the new light; depth is reversed;
                    // share of the edges of horizon_sines in the edges of shade
  vec4 pixel;       // its width and height, of a picture from (-1, -1) to (1, 1)
  vec4 horizon_u;   // from (x, y, z, 1) in the anchor's frame to a place of horizon_sines
  vec4 horizon_v;
  vec4 risen;       // of the disk since edges of shade were made, old and new light's [its radii]
  vec4 turning[32];  // a level: distance where it begins to turn [m], one over how far it takes
};
