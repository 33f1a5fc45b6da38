// SPDX-License-Identifier: MIT
// How long the passes of a frame take, on the graphics card and on the thread that asks for them.
//
// A graphics card is asked by timer queries (GL_TIME_ELAPSED), whose results are taken frames later
// and wait for nothing. Software OpenGL answers such queries too, but not truthfully: Mesa's
// llvmpipe leaves out the vertices, which it works on at once, and of a pass into several pictures
// it told 108 ms of 200 (Mesa 22.3.6). There a pass is timed by the clock on the wall between two
// glFinish, which keep passes from overlapping and so make the frame slower than it is.
#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "viewer/gl/gl_objects.h"

namespace alpenglow::viewer {

enum class PassClock {
  kNone,      // passes are not timed
  kQueries,   // timer queries: nothing waits
  kFinishes,  // the clock on the wall between two glFinish
};
/// The one that is truthful on the driver of the current context.
[[nodiscard]] PassClock TruthfulPassClock();

struct PassTime {
  std::string pass;
  double ms;      // on the graphics card
  double cpu_ms;  // of the thread that draws
};

/// Passes follow each other and are not nested. One that is begun several times in a frame gives as
/// many times.
class PassTimer {
 public:
  explicit PassTimer(PassClock clock = PassClock::kNone) : clock_(clock) {}
  PassTimer(const PassTimer&) = delete;
  PassTimer& operator=(const PassTimer&) = delete;

  /// Ends the pass before, if one is open.
  void Begin(std::string_view pass);
  /// Ends the open pass, if there is one.
  void End();

  /// How passes are timed from here on. No pass is open.
  void SetClock(PassClock clock) { clock_ = clock; }

  /// What is known of since the last call, in the order of the passes. Of queries that nobody takes,
  /// the newest passes are left out.
  [[nodiscard]] std::vector<PassTime> Take();
  /// The same, when everything that was drawn is done.
  [[nodiscard]] std::vector<PassTime> TakeAll();

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

}  // namespace alpenglow::viewer
