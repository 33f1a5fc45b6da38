// SPDX-License-Identifier: MIT
// Text as JSON (RFC 8259) has it.
//
// What programs say. Words that nobody takes (a terminal that is gone, a full disk, a closed pipe)
// are lost; the work that they speak of never is, so nothing here throws while it is done.
//
// How far a long run has come, on standard error.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace alpenglow::lut {

/// In quotes; quotes, backslashes and control characters are escaped.
[[nodiscard]] std::string JsonString(std::string_view text);

/// Writes to standard error, as it stands; a line ends with its own line end.
void Say(std::string_view text) noexcept;

/// Writes a result to standard output. What is not taken is remembered until FlushStandardOutput.
void Print(std::string_view text) noexcept;

/// Brings to the system what Print and std::cout still hold. Throws OutputError when standard
/// output has not taken everything.
void FlushStandardOutput();

/// Puts something unwritable in place of each of the descriptors 0, 1 and 2 that is closed: the
/// next file that is opened would get its number, and messages would go into that file.
void OccupyStandardDescriptors() noexcept;

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
