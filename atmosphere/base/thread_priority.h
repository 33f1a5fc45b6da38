// SPDX-License-Identifier: MIT
// The priority of a thread, for work that gives way to drawing.
#pragma once

#include <memory>

namespace alpenglow::atmosphere {

/// Lowers the priority of the calling thread, and of the threads that it will start, by steps of
/// `nice`. Each step is a factor of 1.25 in the time of a core for which threads compete (Linux,
/// sched(7)), so that a thread ten steps lower gets a tenth of it; no other core is affected. A
/// thread cannot raise its priority again. On systems other than Linux the function does nothing.
/// @param steps  at least 0. The lowest priority of the system is the limit.
void LowerPriorityOfThread(int steps);

/// Lowers, while it exists, the priority of each worker thread of the process (TBB) that joins a
/// parallel loop of the thread which constructed it. The worker keeps the lower priority.
class LowerPriorityOfWorkers {
 public:
  /// @param steps  as in LowerPriorityOfThread; counts once for each worker.
  explicit LowerPriorityOfWorkers(int steps);
  ~LowerPriorityOfWorkers();
  LowerPriorityOfWorkers(const LowerPriorityOfWorkers&) = delete;
  LowerPriorityOfWorkers& operator=(const LowerPriorityOfWorkers&) = delete;

 private:
  class Observer;
  std::unique_ptr<Observer> observer_;
};

}  // namespace alpenglow::atmosphere
