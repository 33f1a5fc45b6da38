// SPDX-License-Identifier: MIT
// Functions common to the three programs: exit statuses, signals, version, threads, and hints for
// unknown words on a command line. Messages, progress and atomic output have their own headers,
// which are included here.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "lut/cli/messages.h"
#include "lut/cli/output_file.h"

namespace alpenglow::lut {

/// Describes the fault of a word in the position of a command or a file name that is neither, but
/// is similar to a command, or is a command in other programs ("help"). Empty for other words.
[[nodiscard]] std::string FaultOfCommand(const std::string& word,
                                         const std::vector<std::string>& commands);

/// Describes an option that the program does not have, "-o" or "--lattitude=3", and similar known
/// options (long names without dashes).
[[nodiscard]] std::string FaultOfUnknownOption(const std::string& option,
                                               const std::vector<std::string>& known);

/// Runs `body` and maps failures to exit statuses, with one line on standard error each:
/// OptionError 2, InputError 3, OutputError 4, DisplayError 5, stopped by SIGINT 130 or SIGTERM
/// 143, anything else 70. Output that standard output did not accept is also an OutputError.
/// Installs handlers for SIGINT and SIGTERM after which Interrupted() returns true; the second
/// signal of a kind ends the program at once. SIGXFSZ, SIGPIPE and SIGHUP are ignored: a file over
/// the limit and a result that nobody reads are OutputErrors, and if the terminal is closed,
/// messages are dropped but the run continues. If standard error is closed, messages are dropped
/// and are not written into any file (OccupyStandardDescriptors). If the reader of standard output
/// has left (ReaderLeft), the status is 4 without a message. A body that does not end within a
/// second of a signal is ended: its temporary files are removed, files that it has completed stay.
int RunProgram(const std::string& name, const std::function<int()>& body);

/// Returns true once SIGINT or SIGTERM has arrived. Long loops check it and call ThrowIfInterrupted
/// between units of work.
[[nodiscard]] bool Interrupted();
void ThrowIfInterrupted();

/// Returns program version, git describe, library versions and the SIMD set used, for --version.
[[nodiscard]] std::string VersionText(const std::string& program);
/// Returns "alpenglow 0.2.0 (git describe)", which is written into every output file.
[[nodiscard]] std::string ProducerText();

/// Limits the program to `threads` threads (0: all) during the lifetime of the object; to fewer if
/// the machine does not let it start as many (a limit of the user, of a container).
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
