// SPDX-License-Identifier: MIT
// Provides the reports of --benchmark and --explain.
//
// Benchmark measures the frame times of a scripted flight. It prints one line per pass, "name
// median_ms p95_ms p99_ms", followed by "name.cpu", the time of the drawing thread. "frame" is the
// whole frame, from the start of one to the start of the next. Where the timing of passes makes
// frames slower (pass_timer.h), passes are timed in every second frame, and "frame" refers to the
// other frames.
//
// ExplainView compares a view on the GPU with that of the renderer, and reports the effect of each
// shortcut alone.
#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "renderer/picture/reference_picture.h"
#include "viewer/flight/flight_recorder.h"
#include "viewer/gl/pass_timer.h"
#include "viewer/passes/auto_quality.h"
#include "viewer/passes/sky_painter.h"

namespace alpenglow::viewer {

/// Measures frame times. An OpenGL context must be current during its lifetime.
class Benchmark {
 public:
  /// Rate of the scene's clock: scene seconds per real second.
  static constexpr double kTimeRate = 60.0;

  /// @param seconds  duration of the flight, > 0. Frames in the first second, or in the first
  ///     quarter if that is shorter, are not counted, because drivers compile shaders at their
  ///     first use.
  explicit Benchmark(double seconds, PassClock clock = TruthfulPassClock());
  ~Benchmark();
  Benchmark(const Benchmark&) = delete;
  Benchmark& operator=(const Benchmark&) = delete;

  /// Ends a frame, waits until the frame before it is complete, as a double-buffered display does,
  /// and starts the next frame. Returns false when the time is over and at least one frame was
  /// timed.
  [[nodiscard]] bool NextFrame();
  /// Returns the time since the start of the first frame.
  [[nodiscard]] double elapsed_s() const { return elapsed_s_; }
  /// Returns the timer to which the passes of a frame are reported.
  [[nodiscard]] PassTimer& timer() { return timer_; }

  /// Returns the lines of the report, of which "frame" is the last but one, and "frame.cpu" the
  /// last. Call it after NextFrame has returned false.
  [[nodiscard]] std::string Text() const;
  /// Returns a line such as "812 frames, the worst of them 93.1 ms, 2.3 times the median, after
  /// 34.5 s".
  [[nodiscard]] std::string WorstText() const;

 private:
  using Clock = std::chrono::steady_clock;
  void EndFrame(Clock::time_point now);
  void WaitForTheFrameBefore();
  void RecordFrame(double ms);
  void RecordPasses(const std::vector<PassTime>& passes);

  double seconds_, warm_up_s_;
  PassClock clock_;
  PassTimer timer_;
  std::optional<Clock::time_point> first_, begin_;
  double begin_cpu_ms_ = 0.0;  // of the drawing thread
  double elapsed_s_ = 0.0;
  bool times_passes_ = false;
  int timed_frames_ = 0;
  GLsync drawn_ = nullptr;
  std::vector<std::string> passes_;                         // in the order of their first draw
  std::map<std::string, std::vector<double>> ms_, cpu_ms_;  // by name of the pass
  std::vector<double> frame_ms_, frame_cpu_ms_;
  double worst_ms_ = 0.0, worst_at_s_ = 0.0;
};

/// Returns a frame of the scripted flight: circles of 5 km radius to the right, at 250 m/s and at
/// the initial height.
[[nodiscard]] ReplayFrame BenchmarkFlight(const CameraPose& start, const UtcTime& begin,
                                          double elapsed_s);

/// Returns a text table of errors: of the picture against the renderer's, and of each shortcut
/// against its best setting. Its columns are the mean, 99 % and 99.9 % of pixels (DifferenceOf)
/// and the frame time that the shortcut saves. Everything must be ready for the view
/// (SkyPainter::WaitUntilReady).
[[nodiscard]] std::string ExplainView(SkyPainter& painter, const ReferenceScene& scene,
                                      const PaintedView& view, Quality quality);

}  // namespace alpenglow::viewer
