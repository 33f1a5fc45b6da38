// SPDX-License-Identifier: MIT
// Provides PassTimer, which measures the time of the passes of a frame on the GPU and on the
// drawing thread.
//
// On a GPU it uses timer queries (GL_TIME_ELAPSED), whose results are read some frames later
// without waiting. Software OpenGL supports such queries too, but their results are wrong: Mesa's
// llvmpipe omits the vertex stage, which runs at once, and for a pass with several outputs it
// reported 108 ms of 200 (Mesa 22.3.6). There a pass is timed by wall clock between two glFinish
// calls. They prevent passes from overlapping and thereby make the frame slower.
#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "viewer/gl/gl_context.h"

namespace alpenglow::viewer {

enum class PassClock {
  kNone,      // passes are not timed
  kQueries,   // timer queries, without waiting
  kFinishes,  // wall clock between two glFinish calls
};
/// Returns the clock that is accurate on the driver of the current context.
[[nodiscard]] PassClock TruthfulPassClock();

/// Returns the CPU time of the calling thread [ms].
[[nodiscard]] double MillisecondsOfThisThread();

struct PassTime {
  std::string pass;
  double ms;      // on the GPU
  double cpu_ms;  // CPU time of the drawing thread
};

/// Times passes, which follow each other and are not nested. A pass that begins several times in a
/// frame has one time for each.
class PassTimer {
 public:
  explicit PassTimer(PassClock clock = PassClock::kNone) : clock_(clock) {}
  PassTimer(const PassTimer&) = delete;
  PassTimer& operator=(const PassTimer&) = delete;

  /// Begins a pass and ends the previous one if it is open.
  void Begin(std::string_view pass);
  /// Ends the open pass, if any.
  void End();

  /// Selects the clock for the following passes. No pass may be open.
  void SetClock(PassClock clock) { clock_ = clock; }

  /// Returns the times that became available since the last call, in the order of the passes. If
  /// nobody calls Poll, new passes are not timed once too many queries are pending.
  [[nodiscard]] std::vector<PassTime> Poll();
  /// Waits until all drawing is complete, and returns the remaining times.
  [[nodiscard]] std::vector<PassTime> PollAll();

 private:
  static constexpr std::size_t kMostInFlight = 256;
  struct InFlight {
    PassTime time;
    GlQuery query;
  };
  [[nodiscard]] GlQuery FreeQuery();

  PassClock clock_;
  bool open_ = false;
  PassTime pass_;
  std::chrono::steady_clock::time_point begin_;
  double cpu_begin_ms_ = 0.0;
  std::vector<PassTime> done_;
  std::deque<InFlight> in_flight_;
  std::vector<GlQuery> free_;
};

/// Times a pass during its lifetime.
class TimedPass {
 public:
  /// @param timer  null: the pass is not timed.
  TimedPass(PassTimer* timer, std::string_view pass) : timer_(timer) {
    if (timer_ != nullptr) timer_->Begin(pass);
  }
  ~TimedPass() {
    if (timer_ != nullptr) timer_->End();
  }
  TimedPass(const TimedPass&) = delete;
  TimedPass& operator=(const TimedPass&) = delete;

 private:
  PassTimer* timer_;
};

}  // namespace alpenglow::viewer
