// SPDX-License-Identifier: MIT
// Runs work on a background thread that always processes the latest request.
#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace alpenglow::viewer {

/// One thread and its newest request. A newer request replaces one that has not begun. A finished
/// result is kept until it is taken or a newer one is finished. The work runs on that thread alone
/// unless it starts threads itself.
template <typename Request, typename Result>
class LatestJob {
 public:
  using Work = std::function<Result(const Request&)>;

  explicit LatestJob(Work work)
      : work_(std::move(work)), thread_([this](const std::stop_token& stop) { Run(stop); }) {}
  LatestJob(const LatestJob&) = delete;
  LatestJob& operator=(const LatestJob&) = delete;
  /// Waits for work that has begun.
  ~LatestJob() {
    thread_.request_stop();
    asked_.notify_all();
    thread_.join();
  }

  void Ask(Request request) {
    {
      const std::scoped_lock lock(mutex_);
      waiting_ = std::move(request);
    }
    asked_.notify_all();
  }

  /// Returns the newest result since the last call, if any. Rethrows exceptions of the work.
  [[nodiscard]] std::optional<Result> Take() {
    const std::scoped_lock lock(mutex_);
    if (failed_) std::rethrow_exception(std::exchange(failed_, nullptr));
    return std::exchange(finished_, std::nullopt);
  }

  /// Waits until no request is waiting or running; then Take() returns the newest result.
  void Wait() {
    std::unique_lock lock(mutex_);
    idle_.wait(lock, [this] { return !waiting_ && !working_; });
  }

  [[nodiscard]] bool Busy() const {
    const std::scoped_lock lock(mutex_);
    return waiting_.has_value() || working_;
  }

 private:
  void Run(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (asked_.wait(lock, stop, [this] { return waiting_.has_value(); })) {
      const Request request = *std::exchange(waiting_, std::nullopt);
      working_ = true;
      lock.unlock();
      std::optional<Result> made;
      std::exception_ptr failed;
      try {
        made.emplace(work_(request));
      } catch (...) {
        failed = std::current_exception();
      }
      lock.lock();
      working_ = false;
      if (made) finished_ = std::move(made);
      if (failed) failed_ = failed;
      idle_.notify_all();
    }
  }

  Work work_;
  mutable std::mutex mutex_;
  std::condition_variable_any asked_, idle_;
  std::optional<Request> waiting_;
  std::optional<Result> finished_;
  std::exception_ptr failed_;
  bool working_ = false;
  std::jthread thread_;  // last, because it uses all members above
};

}  // namespace alpenglow::viewer
