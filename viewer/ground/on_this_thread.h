// SPDX-License-Identifier: MIT
// Work that libraries would spread over all processors, kept on one: the others draw.
#pragma once

#include <tbb/task_arena.h>

namespace alpenglow::viewer {

template <typename Work>
auto OnThisThread(const Work& work) {
  tbb::task_arena alone(1);
  return alone.execute(work);
}

}  // namespace alpenglow::viewer
