// SPDX-License-Identifier: MIT
#include "viewer/benchmark.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "atmosphere/number/constants.h"
#include "atmosphere/text/error.h"

namespace alpenglow::viewer {
namespace {

double Seconds(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

std::string LineOf(const std::string& name, const std::vector<double>& ms) {
  const Percentiles of = PercentilesOf(ms);
  return fmt::format("{} {:.3f} {:.3f} {:.3f}\n", name, of.median, of.p95, of.p99);
}

}  // namespace

Percentiles PercentilesOf(std::vector<double> values) {
  ALPENGLOW_ENSURE(values.size(), >, 0U);
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    const double rank = std::ceil(share * static_cast<double>(values.size()));
    return values[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
  };
  return {at(0.5), at(0.95), at(0.99)};
}

Benchmark::Benchmark(double seconds, PassClock clock)
    : seconds_(seconds), warm_up_s_(std::min(1.0, 0.25 * seconds)), clock_(clock) {}

Benchmark::~Benchmark() {
  if (drawn_ != nullptr) glDeleteSync(drawn_);
}

// With queries every frame is timed; else every second one, by finishes.
bool Benchmark::NextFrame() {
  timer_.End();
  WaitForTheFrameBefore();
  const Clock::time_point now = Clock::now();
  if (!first_) first_ = now;
  if (begin_) EndFrame(now);
  begin_ = now;
  elapsed_s_ = Seconds(now - *first_);
  times_passes_ = clock_ == PassClock::kQueries || !times_passes_;
  timer_.SetClock(times_passes_ ? clock_ : PassClock::kNone);
  if (elapsed_s_ < seconds_ || frame_ms_.empty() || timed_frames_ == 0) return true;
  NotePasses(timer_.TakeAll());
  return false;
}

void Benchmark::WaitForTheFrameBefore() {
  constexpr GLuint64 kLongest_ns = 10'000'000'000;
  GLsync before = std::exchange(drawn_, glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0));
  if (before == nullptr) return;
  glClientWaitSync(before, GL_SYNC_FLUSH_COMMANDS_BIT, kLongest_ns);
  glDeleteSync(before);
}

void Benchmark::EndFrame(Clock::time_point now) {
  const std::vector<PassTime> passes = timer_.Take();
  if (Seconds(*begin_ - *first_) < warm_up_s_) return;
  const bool is_slowed = times_passes_ && clock_ == PassClock::kFinishes;
  if (!is_slowed) NoteFrame(1e3 * Seconds(now - *begin_));
  if (times_passes_) ++timed_frames_;
  NotePasses(passes);
}

void Benchmark::NoteFrame(double ms) {
  frame_ms_.push_back(ms);
  if (ms <= worst_ms_) return;
  worst_ms_ = ms;
  worst_at_s_ = elapsed_s_;
}

void Benchmark::NotePasses(const std::vector<PassTime>& passes) {
  for (const PassTime& pass : passes) {
    if (!ms_.contains(pass.pass)) passes_.push_back(pass.pass);
    ms_[pass.pass].push_back(pass.ms);
    cpu_ms_[pass.pass].push_back(pass.cpu_ms);
  }
}

std::string Benchmark::Text() const {
  std::string text;
  for (const std::string& pass : passes_) {
    text += LineOf(pass, ms_.at(pass)) + LineOf(pass + ".cpu", cpu_ms_.at(pass));
  }
  return text + LineOf("frame", frame_ms_);
}

std::string Benchmark::WorstText() const {
  return fmt::format(
      "{} frames, the worst of them {:.1f} ms, {:.1f} times the median, after {:.1f} s",
      frame_ms_.size(), worst_ms_, worst_ms_ / PercentilesOf(frame_ms_).median, worst_at_s_);
}

ReplayFrame BenchmarkFlight(const Eye& start, const UtcInstant& begin, double elapsed_s) {
  constexpr double kSpeed_m_per_s = 250.0, kRadius_m = 5000.0;
  const double turned = kSpeed_m_per_s * elapsed_s / kRadius_m;
  const double ahead = kRadius_m * std::sin(turned), right = kRadius_m * (1.0 - std::cos(turned));
  const double c = std::cos(start.heading_rad), s = std::sin(start.heading_rad);
  Eye eye = start;
  eye.place = LocalFrame(kWgs84, start.place)
                  .GeodeticFromEnu(Point<Enu>{{ahead * s + right * c, ahead * c - right * s, 0.0}});
  eye.place.height_m = start.place.height_m;
  eye.heading_rad = std::remainder(start.heading_rad + turned, 2.0 * kPi);
  return {elapsed_s, eye, AddSeconds(begin, Benchmark::kTimeRate * elapsed_s)};
}

}  // namespace alpenglow::viewer
