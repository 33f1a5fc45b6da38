// SPDX-License-Identifier: MIT
#include "viewer/gl/pass_timer.h"

#include <ctime>
#include <string_view>
#include <utility>

namespace alpenglow::viewer {

double MillisecondsOfThisThread() {
  timespec time = {};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

PassClock TruthfulPassClock() {
  if (IsSoftwareOpenGl()) return PassClock::kFinishes;
  GLint bits = 0;
  glGetQueryiv(GL_TIME_ELAPSED, GL_QUERY_COUNTER_BITS, &bits);
  return bits > 0 ? PassClock::kQueries : PassClock::kFinishes;
}

GlQuery PassTimer::FreeQuery() {
  if (free_.empty()) return {};
  GlQuery query = std::move(free_.back());
  free_.pop_back();
  return query;
}

void PassTimer::Begin(std::string_view pass) {
  End();
  if (clock_ == PassClock::kNone || in_flight_.size() == kMostInFlight) return;
  open_ = true;
  pass_ = {std::string(pass), 0.0, 0.0};
  if (clock_ == PassClock::kFinishes) {
    glFinish();
  } else {
    in_flight_.push_back({pass_, FreeQuery()});
    glBeginQuery(GL_TIME_ELAPSED, in_flight_.back().query.id());
  }
  begin_ = std::chrono::steady_clock::now();
  cpu_begin_ms_ = MillisecondsOfThisThread();
}

void PassTimer::End() {
  if (!std::exchange(open_, false)) return;
  pass_.cpu_ms = MillisecondsOfThisThread() - cpu_begin_ms_;
  if (clock_ == PassClock::kQueries) {
    glEndQuery(GL_TIME_ELAPSED);
    in_flight_.back().time = pass_;
    return;
  }
  glFinish();
  const auto elapsed = std::chrono::steady_clock::now() - begin_;
  pass_.ms = std::chrono::duration<double, std::milli>(elapsed).count();
  done_.push_back(pass_);
}

std::vector<PassTime> PassTimer::Poll() {
  while (!in_flight_.empty() && !(open_ && in_flight_.size() == 1)) {
    InFlight& oldest = in_flight_.front();
    GLuint is_available = GL_FALSE;
    glGetQueryObjectuiv(oldest.query.id(), GL_QUERY_RESULT_AVAILABLE, &is_available);
    if (is_available == GL_FALSE) break;
    GLuint64 nanoseconds = 0;
    glGetQueryObjectui64v(oldest.query.id(), GL_QUERY_RESULT, &nanoseconds);
    oldest.time.ms = 1e-6 * static_cast<double>(nanoseconds);
    done_.push_back(oldest.time);
    free_.push_back(std::move(oldest.query));
    in_flight_.pop_front();
  }
  return std::exchange(done_, {});
}

std::vector<PassTime> PassTimer::PollAll() {
  End();
  glFinish();
  return Poll();
}

}  // namespace alpenglow::viewer
