// SPDX-License-Identifier: MIT
// What the three programs have in common: exit statuses, signals, progress, atomic output.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>

namespace alpenglow {

/// Runs `body` and maps failures to exit statuses, one line on standard error each: InputError 3,
/// OutputError 4, DisplayError 5, stopped by SIGINT 130 or SIGTERM 143, anything else 70.
/// Installs handlers for SIGINT and SIGTERM that make Interrupted() true.
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
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct State;
  State* state_;
};

enum class ProgressStyle { kAuto, kPlain, kJson, kQuiet };

/// Progress on standard error: a bar with the time left on a terminal, one line per 5 % elsewhere,
/// JSON lines on request. Advance() may be called from any thread.
class Progress {
 public:
  Progress(std::string label, std::size_t total, ProgressStyle style);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void Advance(std::size_t steps = 1);

 private:
  struct State;
  State* state_;
};

/// Writes a file whole or not at all: `write` gets the name of a temporary in the target's folder,
/// which is renamed to `target` when `write` returns. Creates no folders. On failure the temporary
/// is removed and OutputError names the target.
void WriteFileAtomically(const std::filesystem::path& target,
                         const std::function<void(const std::filesystem::path&)>& write);

}  // namespace alpenglow
