// SPDX-License-Identifier: MIT
// Provides AsyncValue, a value that is computed on a background thread and follows its input.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "atmosphere/base/thread_priority.h"

namespace alpenglow::atmosphere {

/// A value that follows an input, such as tables for a moving eye. One thread computes it, always
/// for the newest request: a request replaces one that has not begun. A finished value is kept
/// until it is taken over or a newer one is finished. The computation runs on that thread alone
/// unless it starts threads itself. All functions must be called on one thread, which is usually
/// the one that draws.
///
/// The policy of requests is a function, Suits, and a rest. RequestIfNeeded requests a value unless
/// the newest request suits the input, so that a small change of the input causes no work.
/// RequestWhenIdle also waits for the end of a computation and of the rest after it, which leaves
/// the CPU to other threads, and calls GiveWay; it is called once a frame.
template <typename Input, typename Value>
class AsyncValue {
 public:
  /// Computes the value. It is called on the thread of this object.
  using Make = std::function<Value(const Input&)>;
  /// Returns whether the value for one input can be used for another.
  using Suits = std::function<bool(const Input& requested, const Input& wanted)>;

  /// @param suits  empty: no request suits another input, and none is kept.
  explicit AsyncValue(Make make, Suits suits = nullptr)
      : make_(std::move(make)),
        suits_(std::move(suits)),
        thread_([this](const std::stop_token& stop) { Run(stop); }) {}
  AsyncValue(const AsyncValue&) = delete;
  AsyncValue& operator=(const AsyncValue&) = delete;
  /// Waits for a computation that has begun.
  ~AsyncValue() {
    thread_.request_stop();
    has_request_.notify_all();
    thread_.join();
  }

  void Request(Input input) {
    if (suits_) requested_ = input;
    {
      const std::scoped_lock lock(mutex_);
      waiting_ = std::move(input);
    }
    has_request_.notify_all();
  }
  /// Requests a value unless the newest request suits. Returns whether it was requested.
  bool RequestIfNeeded(const Input& wanted) {
    if (requested_ && suits_ && suits_(*requested_, wanted)) return false;
    Request(wanted);
    return true;
  }
  /// Lowers the priority of computations that begin from now on, and of the workers in their
  /// parallel loops, for good. Where drawing takes all cores, because the driver has no graphics
  /// card, a frame then does not wait for tables that are needed some frames later. Do not call it
  /// where drawing waits for each value.
  void GiveWay() { gives_way_ = true; }
  /// Does nothing while a value is being computed and during a rest.
  void RequestWhenIdle(const Input& wanted) {
    GiveWay();
    if (!IsBusy() && !IsResting()) RequestIfNeeded(wanted);
  }
  /// Returns the newest request; empty without a policy.
  [[nodiscard]] const std::optional<Input>& requested() const { return requested_; }
  /// Makes the next input count as needed, and ends the rest.
  void Forget() {
    requested_.reset();
    rests_until_ = {};
  }
  /// Begins a rest of this duration. It replaces an earlier one.
  void RestFor(double seconds) {
    rests_until_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double>(seconds));
  }
  [[nodiscard]] bool IsResting() const { return Clock::now() < rests_until_; }

  /// Takes over a finished value, which value() then returns. Returns whether there was one.
  /// Rethrows exceptions of the computation.
  bool Update() {
    const std::scoped_lock lock(mutex_);
    if (failed_) std::rethrow_exception(std::exchange(failed_, nullptr));
    if (!finished_) return false;
    value_ = std::exchange(finished_, std::nullopt);
    making_s_ = finished_making_s_;
    return true;
  }
  [[nodiscard]] const std::optional<Value>& value() const { return value_; }
  /// Updates like Update, but moves the new value, if there is one, to the caller.
  [[nodiscard]] std::optional<Value> Poll() {
    Update();
    return std::exchange(value_, std::nullopt);
  }
  /// Returns the computing time of the last value that was taken over [s]; 0 before the first.
  [[nodiscard]] double making_s() const { return making_s_; }

  /// Waits until no request is waiting or being computed; Update or Poll then give the value.
  void Wait() {
    std::unique_lock lock(mutex_);
    is_idle_.wait(lock, [this] { return !waiting_ && !is_working_; });
  }
  /// Waits for the value of an input that suits.
  void WaitUntilReady(const Input& wanted) {
    Wait();
    if (RequestIfNeeded(wanted)) Wait();
  }
  [[nodiscard]] bool IsBusy() const {
    const std::scoped_lock lock(mutex_);
    return waiting_.has_value() || is_working_;
  }

 private:
  using Clock = std::chrono::steady_clock;

  // A thread ten steps lower gets a tenth of a core for which drawing competes with it.
  static constexpr int kStepsBelowDrawing = 10;

  void Run(const std::stop_token& stop) {
    std::optional<LowerPriorityOfWorkers> below_drawing;
    std::unique_lock lock(mutex_);
    while (has_request_.wait(lock, stop, [this] { return waiting_.has_value(); })) {
      const Input input = *std::exchange(waiting_, std::nullopt);
      is_working_ = true;
      lock.unlock();
      if (gives_way_ && !below_drawing) {
        LowerPriorityOfThread(kStepsBelowDrawing);
        below_drawing.emplace(kStepsBelowDrawing);
      }
      const Clock::time_point begin = Clock::now();
      std::optional<Value> made;
      std::exception_ptr failed;
      try {
        made.emplace(make_(input));
      } catch (...) {
        failed = std::current_exception();
      }
      const std::chrono::duration<double> took = Clock::now() - begin;
      lock.lock();
      is_working_ = false;
      if (made) {
        finished_ = std::move(made);
        finished_making_s_ = took.count();
      }
      if (failed) failed_ = failed;
      is_idle_.notify_all();
    }
  }

  Make make_;
  Suits suits_;
  std::optional<Input> requested_;
  std::optional<Value> value_;
  double making_s_ = 0.0;
  Clock::time_point rests_until_{};
  std::atomic<bool> gives_way_ = false;

  mutable std::mutex mutex_;  // guards the members below, which the thread shares
  std::condition_variable_any has_request_, is_idle_;
  std::optional<Input> waiting_;
  std::optional<Value> finished_;
  double finished_making_s_ = 0.0;
  std::exception_ptr failed_;
  bool is_working_ = false;
  std::jthread thread_;  // last, because it uses all members above
};

}  // namespace alpenglow::atmosphere
