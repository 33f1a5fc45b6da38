// SPDX-License-Identifier: MIT
#include "atmosphere/base/thread_priority.h"

#include <tbb/task_scheduler_observer.h>

#include <utility>

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

// An observer sees the workers that enter the arena of the thread which starts to observe.
class LowerPriorityOfWorkers::Observer : public tbb::task_scheduler_observer {
 public:
  explicit Observer(int steps) : steps_(steps) { observe(true); }
  ~Observer() override { observe(false); }
  Observer(const Observer&) = delete;
  Observer& operator=(const Observer&) = delete;

  void on_scheduler_entry(bool is_worker) override {
    thread_local bool is_lowered = false;
    if (is_worker && !std::exchange(is_lowered, true)) LowerPriorityOfThread(steps_);
  }

 private:
  int steps_;
};

LowerPriorityOfWorkers::LowerPriorityOfWorkers(int steps)
    : observer_(std::make_unique<Observer>(steps)) {}

LowerPriorityOfWorkers::~LowerPriorityOfWorkers() = default;

}  // namespace alpenglow::atmosphere
