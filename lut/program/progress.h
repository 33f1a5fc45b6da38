// SPDX-License-Identifier: MIT
// How far a long run has come, on standard error.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

namespace alpenglow {

enum class ProgressStyle { kAuto, kPlain, kJson, kQuiet };

/// "auto", "plain", "json" or "quiet"; throws InputError for another name.
[[nodiscard]] ProgressStyle ProgressStyleFromName(const std::string& name);

/// Progress on standard error: a bar with the time left on a terminal, one line per 5 % elsewhere,
/// on request JSON lines
///   {"label":"frames","done":3,"total":10,"elapsed_s":1.5,"eta_s":3.5}
/// one per percent at most, eta_s null until it is known. Advance() may be called from any thread.
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

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// "45s", "3m20s", "2h05m": a duration as people read it. @param seconds not negative.
[[nodiscard]] std::string DurationText(double seconds);

}  // namespace alpenglow
