// SPDX-License-Identifier: MIT
#include "atmosphere/base/thread_priority.h"

#include "atmosphere/base/error.h"

#ifdef __linux__
#include <sys/resource.h>
#include <unistd.h>
#endif

namespace alpenglow::atmosphere {

// On Linux each thread has its own nice value (credentials(7), sched(7)).
void LowerPriorityOfThread(int steps) {
  ALPENGLOW_ENSURE(steps, >=, 0);
#ifdef __linux__
  const auto thread = static_cast<id_t>(gettid());
  const int before = getpriority(PRIO_PROCESS, thread);
  static_cast<void>(setpriority(PRIO_PROCESS, thread, before + steps));
#endif
}

}  // namespace alpenglow::atmosphere
