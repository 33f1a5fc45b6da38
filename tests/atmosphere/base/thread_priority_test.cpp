// SPDX-License-Identifier: MIT
#include "atmosphere/base/thread_priority.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <future>
#include <thread>

#ifdef __linux__
#include <sys/resource.h>
#include <unistd.h>

namespace alpenglow::atmosphere {
namespace {

// Returns the nice value of a thread that is `steps` lower; 19 is the lowest priority of Linux.
int Lowered(int nice, int steps) { return std::min(nice + steps, 19); }

int NiceOfThread() { return getpriority(PRIO_PROCESS, static_cast<id_t>(gettid())); }

/// Returns the nice value of a worker: a task that is enqueued is run by one.
int NiceOfWorker() {
  std::promise<int> nice;
  std::future<int> value = nice.get_future();
  tbb::this_task_arena::enqueue([&nice] { nice.set_value(NiceOfThread()); });
  return value.get();
}

// Threads are started for each part, because a thread keeps its lower priority.
TEST(PriorityOfThreads, IsLoweredForOneThreadAlone) {
  const int before = NiceOfThread();
  int lowered = before;
  std::jthread([&lowered] {
    LowerPriorityOfThread(3);
    lowered = NiceOfThread();
  }).join();
  EXPECT_EQ(lowered, Lowered(before, 3));
  EXPECT_EQ(NiceOfThread(), before);
}

TEST(PriorityOfThreads, IsLoweredOnceForWorkersOfALoweredThread) {
  const int before = NiceOfThread();
  std::jthread([before] {
    const LowerPriorityOfWorkers below(3);
    EXPECT_EQ(NiceOfWorker(), Lowered(before, 3));
    EXPECT_EQ(NiceOfWorker(), Lowered(before, 3)) << "a worker that comes again keeps its priority";
    EXPECT_EQ(NiceOfThread(), before);
  }).join();
}

}  // namespace
}  // namespace alpenglow::atmosphere
#endif
