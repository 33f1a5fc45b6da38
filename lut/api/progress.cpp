// SPDX-License-Identifier: MIT
#include <alpenglow/progress.h>

#include <memory>
#include <mutex>
#include <utility>

#include "lut/api/conversions.h"

namespace alpenglow {

std::function<void()> PartDone(ProgressFunction progress, std::size_t parts) {
  struct Count {
    std::mutex mutex{};
    std::size_t done = 0;
  };
  return [progress = std::move(progress), parts, count = std::make_shared<Count>()] {
    if (!progress) return;
    const std::scoped_lock lock(count->mutex);
    const double fraction = static_cast<double>(++count->done) / static_cast<double>(parts);
    if (!progress(fraction)) throw Cancelled();
  };
}

}  // namespace alpenglow
