// SPDX-License-Identifier: MIT
// Hints for words on a command line that the program does not know.
//
// What the three programs have in common: exit statuses, signals, version, threads; messages,
// progress and atomic output have headers of their own, included here.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "lut/program/messages.h"
#include "lut/program/output_file.h"

namespace alpenglow::lut {

/// Describes the fault of a word that stands where a command or the name of a file may: it is
/// neither, but nearly a command, or one that other programs have as a command ("help"). Empty for
/// other words.
[[nodiscard]] std::string FaultOfCommand(const std::string& word,
                                         const std::vector<std::string>& commands);

/// Describes an option that the program does not have, "-o" or "--lattitude=3", and which
/// of the known ones (long names without dashes) are like it.
[[nodiscard]] std::string FaultOfUnknownOption(const std::string& option,
                                               const std::vector<std::string>& known);

/// Runs `body` and maps failures to exit statuses, one line on standard error each: OptionError 2,
/// InputError 3, OutputError 4, DisplayError 5, stopped by SIGINT 130 or SIGTERM 143, anything else
/// 70. Output that standard output did not take is an OutputError too. Installs handlers for SIGINT
/// and SIGTERM that make Interrupted() true; the second signal of a kind ends the program at once.
/// SIGXFSZ, SIGPIPE and SIGHUP are ignored: a file over the limit and a result that nobody reads
/// are OutputErrors, and a terminal that goes away takes the messages with it, but not the work.
/// Whoever closed standard error gets no messages, in no file either (OccupyStandardDescriptors).
int RunProgram(const std::string& name, const std::function<int()>& body);

/// True once SIGINT or SIGTERM has arrived. Long loops ask it and call ThrowIfInterrupted between
/// units of work.
[[nodiscard]] bool Interrupted();
void ThrowIfInterrupted();

/// Program version, git describe, library versions, SIMD used: what --version prints.
[[nodiscard]] std::string VersionText(const std::string& program);
/// "alpenglow 0.1.0 (git describe)": what every output file carries.
[[nodiscard]] std::string ProducerText();

/// Uses `threads` threads (0: all) from here to the end of the object.
class ThreadLimit {
 public:
  /// Throws InputError for a negative number.
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace alpenglow::lut
