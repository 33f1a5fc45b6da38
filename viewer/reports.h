// SPDX-License-Identifier: MIT
// Frame times of a scripted flight: what --benchmark prints.
//
// One line a pass, "name median_ms p95_ms p99_ms", and beside it "name.cpu", the time of the thread
// that draws; "frame" is the whole frame, from one to the next. Where timing passes makes frames
// slower (pass_timer.h), passes are timed in every second frame, and "frame" is of the others.
//
// What --explain prints: a view on the graphics card beside the renderer's, and each shortcut alone.
#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "viewer/flight/flight_recorder.h"
#include "viewer/flythrough.h"
#include "viewer/gl/pass_timer.h"

namespace alpenglow::viewer {

/// Times that half of all, 95 % and 99 % do not exceed.
struct Percentiles {
  double median, p95, p99;
};
/// The smallest value that at least that share of all does not exceed (nearest rank). At least one
/// value.
[[nodiscard]] Percentiles PercentilesOf(std::vector<double> values);

/// An OpenGL context must be current while it lives.
class Benchmark {
 public:
  /// Seconds of the scene in a second.
  static constexpr double kTimeRate = 60.0;

  /// @param seconds  to fly for, > 0. What is drawn in the first of them, or the first quarter if
  /// that is shorter, does not count: drivers compile shaders when they are first drawn with.
  explicit Benchmark(double seconds, PassClock clock = TruthfulPassClock());
  ~Benchmark();
  Benchmark(const Benchmark&) = delete;
  Benchmark& operator=(const Benchmark&) = delete;

  /// Ends a frame, waits until the frame before it is done, as a display with two pictures would,
  /// and begins the next one. False when the time is over and at least one frame was timed.
  [[nodiscard]] bool NextFrame();
  /// Since the first frame began.
  [[nodiscard]] double elapsed_s() const { return elapsed_s_; }
  /// To be told of the passes of the frame.
  [[nodiscard]] PassTimer& timer() { return timer_; }

  /// The lines, when NextFrame was false. "frame" is the last one.
  [[nodiscard]] std::string Text() const;
  /// "812 frames, the worst of them 93.1 ms, 2.3 times the median, after 34.5 s".
  [[nodiscard]] std::string WorstText() const;

 private:
  using Clock = std::chrono::steady_clock;
  void EndFrame(Clock::time_point now);
  void WaitForTheFrameBefore();
  void NoteFrame(double ms);
  void NotePasses(const std::vector<PassTime>& passes);

  double seconds_, warm_up_s_;
  PassClock clock_;
  PassTimer timer_;
  std::optional<Clock::time_point> first_, begin_;
  double elapsed_s_ = 0.0;
  bool times_passes_ = false;
  int timed_frames_ = 0;
  GLsync drawn_ = nullptr;
  std::vector<std::string> passes_;                         // in the order they were drawn first
  std::map<std::string, std::vector<double>> ms_, cpu_ms_;  // by pass
  std::vector<double> frame_ms_;
  double worst_ms_ = 0.0, worst_at_s_ = 0.0;
};

/// The flight: at 250 m/s and the height it begins at, in circles of 5 km to the right.
[[nodiscard]] ReplayFrame BenchmarkFlight(const Eye& start, const UtcInstant& begin,
                                          double elapsed_s);

/// A table of text: of the picture, and of each shortcut against its best setting, the mean, 99 % and
/// 99.9 % of pixels (ViewDifference), and the time of a frame that it saves. The renderer's land is
/// what the scene names, or of several elevation models what is loaded around the eye.
[[nodiscard]] std::string ExplainView(Flythrough& flight, const ImageSize& size);

}  // namespace alpenglow::viewer
