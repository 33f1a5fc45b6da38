// SPDX-License-Identifier: MIT
// How far a long run has come, on standard error.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace alpenglow::lut {

enum class ProgressStyle { kAuto, kPlain, kJson, kQuiet };

/// "auto", "plain", "json" or "quiet"; throws InputError for another name.
[[nodiscard]] ProgressStyle ProgressStyleFromName(const std::string& name);

/// Progress on standard error: a bar with the time left on a terminal, one line per 5 % elsewhere,
/// on request JSON lines
///   {"label":"frames","done":3,"total":10,"elapsed_s":1.5,"eta_s":3.5}
/// one per percent at most, eta_s null until it is known; inside a unit with its share, as
///   {"label":"frames","done":3,"part":0.25,"total":10,"elapsed_s":1.7,"eta_s":3.5}
/// and where work is prepared
///   {"label":"frames","step":"terrain","elapsed_s":0.1}
/// All but the first two may be called from any thread.
/// What cannot be written is lost; the work goes on.
class Progress {
 public:
  Progress(std::string label, std::size_t total, ProgressStyle style);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `steps` more units of work are done.
  void Advance(std::size_t steps = 1);
  /// `steps` units turned out to be done already (resumed work): they count as done, but say
  /// nothing about the speed.
  void Skip(std::size_t steps = 1);
  /// What has to be done before the next unit can be counted, in a word or two ("terrain"): until
  /// Part(), Advance() or the next step. As lines each step is named once.
  void Prepare(std::string_view step);
  /// The share of the next unit that is done, 0 to 1. As lines not more often than every 2 s: few
  /// units are that long.
  void Part(double share);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// progress->Prepare(step); nothing for null.
void Prepare(Progress* progress, std::string_view step);

/// "45s", "3m20s", "2h05m": a duration as people read it. @param seconds not negative.
[[nodiscard]] std::string DurationText(double seconds);

}  // namespace alpenglow::lut
