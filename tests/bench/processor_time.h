// SPDX-License-Identifier: MIT
// Time of the processor, for all threads together.
#pragma once

#include <ctime>

namespace alpenglow::tests {

/// Returns the time since an earlier value of std::clock [s].
inline double ProcessorSecondsSince(std::clock_t begin) {
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

}  // namespace alpenglow::tests
