// SPDX-License-Identifier: MIT
/// @file
/// Progress of long tasks, their cancellation, and the number of their threads.
#pragma once

#include <exception>
#include <functional>

#include <alpenglow/export.h>

namespace ALPENGLOW_EXPORT alpenglow {

/// Receives the fraction of a task that is done, in (0, 1], and returns whether the task continues.
/// Calls follow each other, from any thread, with rising fractions. An exception that it throws ends
/// the task and reaches the caller. After it has ended the task it is not called again.
using ProgressFunction = std::function<bool(double fraction)>;

/// A ProgressFunction has ended the task.
class Cancelled : public std::exception {
 public:
  /// Returns "cancelled".
  [[nodiscard]] const char* what() const noexcept override { return "cancelled"; }
};

/// Runs functions of the library on at most a number of threads, the calling one included. Without
/// it they use all processors. Results do not depend on the number. The threads of other parts of the
/// process, and their limits, are left alone. Throws InputError for a number below 1, and what `work`
/// throws.
/// @param threads  the number, at least 1.
/// @param work     calls the functions.
void OnThreads(int threads, const std::function<void()>& work);

}  // namespace alpenglow
