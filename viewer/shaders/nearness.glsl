// SPDX-License-Identifier: MIT
// How near land is, as the fourth component of a picture: over a plane it is linear in the picture,
// and half floats hold it from a metre to a thousand kilometres. 0: no land.
float Nearness(float along_view_m) { return 100.0 / along_view_m; }
