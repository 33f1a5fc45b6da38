// SPDX-License-Identifier: MIT
/// @file
/// Progress of long tasks, and their cancellation.
#pragma once

#include <exception>
#include <functional>

#include <alpenglow/export.h>

namespace ALPENGLOW_EXPORT alpenglow {

/// Receives the fraction of a task that is done, in (0, 1], and returns whether the task continues.
/// Calls follow each other, from any thread, with rising fractions. An exception that it throws ends
/// the task and reaches the caller.
using ProgressFunction = std::function<bool(double fraction)>;

/// A ProgressFunction has ended the task.
class Cancelled : public std::exception {
 public:
  /// Returns "cancelled".
  [[nodiscard]] const char* what() const noexcept override { return "cancelled"; }
};

}  // namespace alpenglow
