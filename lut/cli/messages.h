// SPDX-License-Identifier: MIT
// Messages of programs: JSON strings (RFC 8259), text on standard error and standard output, and
// progress of long runs.
//
// If standard error cannot be written (a closed terminal, a full disk, a closed pipe), messages are
// dropped and the run continues; therefore nothing here throws during the work.
#pragma once

#include <alpenglow/progress.h>

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace alpenglow::lut {

/// Returns the text in quotes, with quotes, backslashes and control characters escaped.
[[nodiscard]] std::string JsonString(std::string_view text);

/// Writes lines to standard error; the text must include its line end. Control characters, which
/// names and contents of files may have, are escaped (Printable).
void Log(std::string_view text) noexcept;

/// Writes a line "NAME: warning: text" as Log does. NAME is that of the running program
/// (WarningsOf), or alpenglow in other programs that use the library.
void Warn(std::string_view text) noexcept;

/// Gives warnings the name of a program during the lifetime of the object.
class WarningsOf {
 public:
  explicit WarningsOf(std::string program);
  ~WarningsOf();
  WarningsOf(const WarningsOf&) = delete;
  WarningsOf& operator=(const WarningsOf&) = delete;
};

/// Writes lines as Log does, for a thread that ends the process: it takes no lock, and drops the
/// text if the reader of standard error does not read.
void LogWithoutWaiting(std::string_view text) noexcept;

/// Writes a result to standard output. An error is remembered until FlushStandardOutput.
void Print(std::string_view text) noexcept;

/// Flushes the buffers of Print and std::cout. Throws ReaderLeft (terminal.h) if nobody reads
/// standard output any more, and OutputError if it has not accepted everything for another reason.
void FlushStandardOutput();

/// Opens an unwritable file for each of the descriptors 0, 1 and 2 that is closed: otherwise the
/// next opened file would get its number, and messages would be written into that file.
void OccupyStandardDescriptors() noexcept;

enum class ProgressStyle { kAuto, kPlain, kJson, kQuiet };

/// Reads "auto", "plain", "json" or "quiet"; throws InputError for another name.
[[nodiscard]] ProgressStyle ProgressStyleFromName(const std::string& name);
[[nodiscard]] std::vector<std::string> ProgressStyleNames();

/// Progress on standard error: on a terminal a bar with the remaining time, elsewhere one line per
/// 10 %, or on request JSON lines
///   {"label":"frames","done":3,"total":10,"elapsed_s":1.5,"eta_s":3.5}
/// at most one per percent, with eta_s null until it is known; within a unit with its completed
/// fraction, as
///   {"label":"frames","done":3,"part":0.25,"total":10,"elapsed_s":1.7,"eta_s":3.5}
/// and while work is prepared
///   {"label":"frames","step":"terrain","elapsed_s":0.1}
/// All members but the first two may be called from any thread. Output that cannot be written is
/// dropped; the work continues.
class Progress {
 public:
  Progress(std::string label, std::size_t total, ProgressStyle style);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Records that `steps` more units of work are done.
  void Advance(std::size_t steps = 1);
  /// Records that `steps` units were already done (resumed work): they count as done, but are
  /// excluded from the estimate of speed.
  void Skip(std::size_t steps = 1);
  /// Names a step of preparation before the next unit, in a word or two ("terrain"): it lasts until
  /// Part(), Advance() or the next step. In line output each step is named once.
  void Prepare(std::string_view step);
  /// Records the completed fraction of the next unit, 0 to 1. In line output it is reported at most
  /// every 2 s, because only few units take that long.
  void Part(double share);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Calls progress->Prepare(step); does nothing for null.
void Prepare(Progress* progress, std::string_view step);

/// Returns a function that shows the progress of a task of the library, from its first part on, and
/// never ends it.
/// @param parts  number of times that the task calls the function.
[[nodiscard]] ProgressFunction ShownProgress(const std::string& label, std::size_t parts,
                                             ProgressStyle style);

/// Returns a duration in readable form: "45s", "3m20s", "2h05m". @param seconds not negative.
[[nodiscard]] std::string DurationText(double seconds);

}  // namespace alpenglow::lut
