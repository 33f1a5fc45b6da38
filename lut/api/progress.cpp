// SPDX-License-Identifier: MIT
#include <alpenglow/progress.h>

#include <alpenglow/errors.h>
#include <fmt/format.h>
#include <oneapi/tbb/task_arena.h>

#include <memory>
#include <mutex>
#include <utility>

#include "lut/api/conversions.h"

namespace alpenglow {

std::function<void()> PartDone(ProgressFunction progress, std::size_t parts) {
  return PartDone(std::move(progress), [parts](std::size_t done) {
    return static_cast<double>(done) / static_cast<double>(parts);
  });
}

std::function<void()> PartDone(ProgressFunction progress,
                               std::function<double(std::size_t done)> fraction_of) {
  struct Count {
    std::mutex mutex{};
    std::size_t done = 0;
    bool has_ended = false;
  };
  return [progress = std::move(progress), fraction_of = std::move(fraction_of),
          count = std::make_shared<Count>()] {
    if (!progress) return;
    const std::scoped_lock lock(count->mutex);
    if (count->has_ended) throw Cancelled();  // other threads still finish their parts
    count->has_ended = true;
    if (!progress(fraction_of(++count->done))) throw Cancelled();
    count->has_ended = false;
  };
}

void OnThreads(int threads, const std::function<void()>& work) {
  if (threads < 1) throw InputError(fmt::format("threads is {}; it must be at least 1", threads));
  tbb::task_arena arena(threads);
  arena.execute([&] { work(); });
}

}  // namespace alpenglow
