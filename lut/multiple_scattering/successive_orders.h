// SPDX-License-Identifier: MIT
// This header provides the solver that fills the table of MultipleScattering: successive orders of
// scattering in a spherical atmosphere.
//
// At every node (altitude, sun angle) the radiance of one order is marched through the previous
// order's moments, along directions of a Gauss grid split at the horizon, and projected onto
// moments. Kernels process four bands at a time (moment_kernel.h). Sunlight scattered once is
// integrated over the lit pieces of each direction (moment_grid.h). Light scattered more often is
// smooth, so fewer directions serve it from the third step on. When the orders have become a
// geometric series, each in proportion to the second one before it, the rest of the series is
// summed in closed form. In thick air orders decay too slowly for that. After 16 orders the sum of
// all further ones is therefore found from a linear equation (lane_krylov.h): up to an optical depth
// of 40, fewer than 120 scatterings suffice. The sum is converged when the estimated error of every
// node is below the tolerance and what one more scattering changes is below a tenth of it.
#pragma once

#include <functional>

#include "lut/multiple_scattering/multiple_scattering.h"

namespace alpenglow::lut {

/// Is called after each part of the solution, from any thread, many times for each order; the number
/// of orders is not known before. An exception ends the work.
using OrderPartDone = std::function<void()>;

/// Solves for all orders. The result does not depend on the number of threads.
[[nodiscard]] SolvedOrders SolveSuccessiveOrders(
    const Medium& medium, const MultipleScatteringOptions& options,
    const OrderPartDone& part_done = [] {});

/// Returns the number of parts of an order.
[[nodiscard]] std::size_t PartsOfOrder(const Medium& medium,
                                       const MultipleScatteringOptions& options);

/// Returns MultipleScattering(medium, options), and calls `part_done` meanwhile.
[[nodiscard]] MultipleScattering SolvedStepwise(const Medium& medium,
                                                const MultipleScatteringOptions& options,
                                                const OrderPartDone& part_done);

}  // namespace alpenglow::lut
