// SPDX-License-Identifier: MIT
// Successive orders of scattering in a spherical atmosphere: what fills the table of DiffuseLight.
//
// One order's radiance at every node (altitude, sun angle), along directions of a Gauss grid split
// at the horizon, is marched through the previous order's moments and projected onto moments again.
// Bands follow four at a time, in kernels (diffuse_kernel.h). Sunlight scattered once is integrated
// over the lit pieces of each direction (diffuse_march.h); light scattered more often is smooth, and
// from the third step on fewer directions serve it. When the orders have become a geometric series,
// every one in proportion to the second one before it, its rest is summed in closed form.
#pragma once

#include "lut/diffuse/multiple_scattering.h"

namespace alpenglow::lut {

/// Deterministic for any number of threads.
[[nodiscard]] SolvedOrders SolveSuccessiveOrders(const Medium& medium,
                                                 const DiffuseLightOptions& options);

}  // namespace alpenglow::lut
