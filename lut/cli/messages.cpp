// SPDX-License-Identifier: MIT
#include "lut/cli/messages.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <limits.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iostream>
#include <mutex>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/base/names.h"
#include "lut/cli/terminal.h"
#include "lut/layer.h"

namespace alpenglow::lut {

std::string JsonString(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < 0x20) {
      quoted += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
      continue;
    }
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

namespace {

constexpr EnumNames kProgressStyles{{std::pair{ProgressStyle::kAuto, "auto"},
                                     {ProgressStyle::kPlain, "plain"},
                                     {ProgressStyle::kJson, "json"},
                                     {ProgressStyle::kQuiet, "quiet"}}};

// First error number of standard output, 0 for none.
std::atomic<int> output_fault{0};

void RememberOutputFault() {
  int none = 0;
  output_fault.compare_exchange_strong(none, errno == 0 ? EIO : errno);
}

// Writes text to standard error unchanged.
void WriteError(std::string_view text) noexcept {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

constexpr const char* kNameOfLibrary = "alpenglow";

/// The name before warnings.
struct NameOfProgram {
  std::mutex mutex{};
  std::string text = kNameOfLibrary;

  void Set(std::string name) {
    const std::scoped_lock lock(mutex);
    text = std::move(name);
  }
};

NameOfProgram& WarningName() {
  static NameOfProgram name;
  return name;
}

using Clock = std::chrono::steady_clock;

enum class Form { kBar, kLines, kJson, kNothing };

Form FormOf(ProgressStyle style) {
  switch (style) {
    case ProgressStyle::kAuto:
      return isatty(STDERR_FILENO) == 1 ? Form::kBar : Form::kLines;
    case ProgressStyle::kPlain:
      return Form::kLines;
    case ProgressStyle::kJson:
      return Form::kJson;
    case ProgressStyle::kQuiet:
      return Form::kNothing;
  }
  throw InternalError("unknown progress style");
}

/// Returns the bar and its text in fewer columns than the terminal has: in the last one some
/// terminals begin a new line. The bar is the first to become shorter.
/// @param complete  number of complete parts out of a number of parts.
std::string BarLine(const std::string& label,
                    const std::function<std::size_t(std::size_t)>& complete,
                    const std::string& text) {
  constexpr std::size_t kLongest = 30, kShortest = 5;
  constexpr int kUsualColumns = 80;
  const auto columns =
      static_cast<std::size_t>(std::max(ColumnsOf(STDERR_FILENO, kUsualColumns), 2)) - 1;
  const std::size_t others = label.size() + text.size() + 4;  // with brackets and spaces
  const std::size_t width = std::min(kLongest, columns - std::min(columns, others));
  const std::size_t filled = width < kShortest ? 0 : complete(width);
  const std::string bar =
      width < kShortest ? "" : fmt::format("[{:#<{}}{:.<{}}] ", "", filled, "", width - filled);
  return fmt::format("{} {}{}", label, bar, text).substr(0, columns);
}

}  // namespace

void Log(std::string_view text) noexcept { WriteError(Printable(text, "\n")); }

void Warn(std::string_view text) noexcept {
  NameOfProgram& name = WarningName();
  const std::scoped_lock lock(name.mutex);
  Log(fmt::format("{}: warning: {}\n", name.text, text));
}

WarningsOf::WarningsOf(std::string program) { WarningName().Set(std::move(program)); }
WarningsOf::~WarningsOf() { WarningName().Set(kNameOfLibrary); }

void LogWithoutWaiting(std::string_view text) noexcept {
  pollfd error{STDERR_FILENO, POLLOUT, 0};
  if (poll(&error, 1, 0) != 1 || (error.revents & POLLOUT) == 0) return;
  const std::string printable = Printable(text, "\n");
  [[maybe_unused]] const ssize_t written =
      write(STDERR_FILENO, printable.data(), std::min<std::size_t>(printable.size(), PIPE_BUF));
}

void Print(std::string_view text) noexcept {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) RememberOutputFault();
}

void FlushStandardOutput() {
  errno = 0;
  const bool streams = static_cast<bool>(std::cout.flush());
  if (!streams || std::fflush(stdout) != 0 || std::ferror(stdout) != 0) RememberOutputFault();
  if (const int fault = output_fault.exchange(0); fault != 0) {
    if (fault == EPIPE) throw ReaderLeft("standard output: nobody reads it any more");
    throw OutputError("standard output: cannot be written: " +
                      std::generic_category().message(fault));
  }
}

void OccupyStandardDescriptors() noexcept {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(descriptor, F_GETFD) != -1 || errno != EBADF) continue;
    // open() uses the lowest free number, which is this one. The descriptor is for reading only:
    // printing a result to a closed standard output must still fail.
    static_cast<void>(open("/dev/null", O_RDONLY));
  }
}

std::string DurationText(double seconds) {
  const long whole = std::lround(seconds);
  if (whole < 60) return fmt::format("{}s", whole);
  if (whole < 3600) return fmt::format("{}m{:02}s", whole / 60, whole % 60);
  return fmt::format("{}h{:02}m", whole / 3600, whole / 60 % 60);
}

ProgressStyle ProgressStyleFromName(const std::string& name) {
  return kProgressStyles.Named(name, "--progress is \"{0}\"; it must be {2}");
}

std::vector<std::string> ProgressStyleNames() { return kProgressStyles.All(); }

struct Progress::State {
  std::string label;
  std::size_t total;
  Form form;
  Clock::time_point start = Clock::now();
  Clock::time_point drawn = start - std::chrono::hours(1);
  std::mutex mutex{};
  std::size_t done = 0;
  std::size_t skipped = 0;
  double part = 0.0;              // completed fraction of the next unit
  std::string step{};             // current step of its preparation
  std::set<std::string> named{};  // steps for which a line was written
  Clock::time_point step_start{};
  double prepared_s = 0.0;  // before the first unit was done; not part of the speed
  std::size_t bar_length = 0;
  std::size_t reported_steps = 0;  // number of parts of the resolution in the last reported line

  [[nodiscard]] double ElapsedSeconds() const {
    return std::chrono::duration<double>(Clock::now() - start).count();
  }
  [[nodiscard]] double Worked() const { return static_cast<double>(done - skipped) + part; }
  [[nodiscard]] std::optional<double> SecondsLeft() const {
    if (done >= total) return 0.0;
    if (Worked() <= 0.0) return std::nullopt;
    return (ElapsedSeconds() - prepared_s) * (static_cast<double>(total - done) - part) / Worked();
  }
  /// Returns how many of `whole` equal parts of the work are complete.
  [[nodiscard]] std::size_t Complete(std::size_t whole) const {
    if (total == 0) return whole;
    return static_cast<std::size_t>((static_cast<double>(done) + part) *
                                    static_cast<double>(whole) / static_cast<double>(total));
  }
  [[nodiscard]] std::size_t Percent() const { return Complete(100); }

  void EndStep() {
    if (!step.empty() && Worked() <= 0.0)
      prepared_s += std::chrono::duration<double>(Clock::now() - step_start).count();
    step.clear();
  }
  void Count(std::size_t units) {
    EndStep();
    done = std::min(total, done + units);
    part = 0.0;
    Report();
  }
  void SetPart(double share) {
    if (done >= total) return;
    EndStep();
    part = std::clamp(share, part, 1.0 - 1e-9);  // completion of the unit is reported by Advance()
    constexpr std::chrono::seconds kBetweenLines(2);
    if (form == Form::kLines && Clock::now() - std::max(drawn, start) < kBetweenLines) return;
    Report();
  }
  void SetStep(std::string_view name) {
    EndStep();
    step = name;
    step_start = Clock::now();
    if (form == Form::kBar) DrawBar();
    if (form == Form::kBar || form == Form::kNothing || !named.insert(step).second) return;
    Log(form == Form::kJson ? fmt::format("{{\"label\":{},\"step\":{},\"elapsed_s\":{:.3f}}}\n",
                                          JsonString(label), JsonString(step), ElapsedSeconds())
                            : fmt::format("{}: preparing {}\n", label, step));
  }
  void Report() {
    if (form == Form::kBar) DrawBar();
    if (form == Form::kLines && IsDue(10)) PrintLine();
    if (form == Form::kJson && IsDue(100)) PrintJson();
  }
  /// Returns whether another of `resolution` equal parts of the work has been completed since the
  /// last report.
  bool IsDue(std::size_t resolution) {
    const std::size_t steps = Complete(resolution);
    if (steps == reported_steps) return false;
    reported_steps = steps;
    return true;
  }
  void DrawBar() {
    const Clock::time_point now = Clock::now();
    if (done < total && step.empty() && now - drawn < std::chrono::milliseconds(100)) return;
    drawn = now;
    const std::optional<double> left = SecondsLeft();
    const std::string note = done >= total   ? "in " + DurationText(ElapsedSeconds())
                             : !step.empty() ? step
                             : left          ? DurationText(*left) + " left"
                                             : "";
    const std::string line = BarLine(
        label, [this](std::size_t whole) { return Complete(whole); },
        fmt::format("{:3} % {}/{} {}", Percent(), done, total, note));
    const std::size_t over = bar_length - std::min(bar_length, line.size());  // to be erased
    bar_length = line.size();
    WriteError("\r" + line + std::string(over, ' '));
  }
  void PrintLine() {
    drawn = Clock::now();
    const std::optional<double> left = SecondsLeft();
    Log(fmt::format("{}: {} % ({} of {}){}\n", label, Percent(), done, total,
                    left ? ", " + DurationText(*left) + " left" : ""));
  }
  void PrintJson() const {
    const std::optional<double> left = SecondsLeft();
    Log(fmt::format(
        "{{\"label\":{},\"done\":{},{}\"total\":{},\"elapsed_s\":{:.3f},\"eta_s\":{}}}\n",
        JsonString(label), done, part > 0.0 ? fmt::format("\"part\":{:.3f},", part) : "", total,
        ElapsedSeconds(), left ? fmt::format("{:.3f}", *left) : "null"));
  }
};

Progress::Progress(std::string label, std::size_t total, ProgressStyle style)
    : state_(new State{.label = std::move(label), .total = total, .form = FormOf(style)}) {
  if (state_->form == Form::kBar) state_->DrawBar();
}

Progress::~Progress() {
  if (state_->form == Form::kBar) Log("\n");
}

void Progress::Advance(std::size_t steps) {
  const std::lock_guard<std::mutex> lock(state_->mutex);
  state_->Count(steps);
}

void Progress::Skip(std::size_t steps) {
  const std::lock_guard<std::mutex> lock(state_->mutex);
  state_->skipped += steps;
  state_->Count(steps);
}

void Progress::Prepare(std::string_view step) {
  const std::lock_guard<std::mutex> lock(state_->mutex);
  state_->SetStep(step);
}

void Prepare(Progress* progress, std::string_view step) {
  if (progress != nullptr) progress->Prepare(step);
}

ProgressFunction ShownProgress(const std::string& label, std::size_t parts, ProgressStyle style) {
  return [=, progress = std::shared_ptr<Progress>()](double) mutable {
    if (!progress) progress = std::make_shared<Progress>(label, parts, style);
    progress->Advance();
    return true;
  };
}

void Progress::Part(double share) {
  const std::lock_guard<std::mutex> lock(state_->mutex);
  state_->SetPart(share);
}

}  // namespace alpenglow::lut
