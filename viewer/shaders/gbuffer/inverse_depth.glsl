// SPDX-License-Identifier: MIT
// Inverse depth of land, stored in the fourth component of a picture. On a plane it is linear over
// the picture, and half floats hold it from a metre to a thousand kilometres. 0: no land.
float InverseDepth(float along_view_m) { return 100.0 / along_view_m; }
