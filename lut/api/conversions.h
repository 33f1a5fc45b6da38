// SPDX-License-Identifier: MIT
// Conversions between values of the public headers and those of this layer.
#pragma once

#include <alpenglow/progress.h>

#include <cstddef>
#include <functional>

#include "atmosphere/api/local_rays.h"

namespace alpenglow {

/// Returns a function that may be called from any thread after each part of a task, and passes the
/// fraction of the parts that are done to `progress`. It throws Cancelled if that returns false. The
/// function holds a copy of `progress`, which may be empty.
[[nodiscard]] std::function<void()> PartDone(ProgressFunction progress, std::size_t parts);
/// Returns such a function for another fraction of the number of parts that are done.
[[nodiscard]] std::function<void()> PartDone(ProgressFunction progress,
                                             std::function<double(std::size_t done)> fraction_of);

}  // namespace alpenglow
