// SPDX-License-Identifier: MIT
#include "lut/program/progress.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>
#include <optional>

#include "atmosphere/text/error.h"
#include "lut/program/messages.h"

namespace alpenglow {
namespace {

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

std::string JsonString(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    if (static_cast<unsigned char>(c) >= 0x20) quoted += c;
  }
  return quoted + '"';
}

std::string Bar(std::size_t done, std::size_t total) {
  constexpr std::size_t kWidth = 30;
  const std::size_t filled = total == 0 ? kWidth : done * kWidth / total;
  return std::string(filled, '#') + std::string(kWidth - filled, '.');
}

}  // namespace

std::string DurationText(double seconds) {
  const long whole = std::lround(seconds);
  if (whole < 60) return fmt::format("{}s", whole);
  if (whole < 3600) return fmt::format("{}m{:02}s", whole / 60, whole % 60);
  return fmt::format("{}h{:02}m", whole / 3600, whole / 60 % 60);
}

ProgressStyle ProgressStyleFromName(const std::string& name) {
  if (name == "auto") return ProgressStyle::kAuto;
  if (name == "plain") return ProgressStyle::kPlain;
  if (name == "json") return ProgressStyle::kJson;
  if (name == "quiet") return ProgressStyle::kQuiet;
  throw InputError(
      fmt::format("--progress is \"{}\"; it must be auto, plain, json or quiet", name));
}

struct Progress::State {
  std::string label;
  std::size_t total;
  Form form;
  Clock::time_point start = Clock::now();
  Clock::time_point drawn = start - std::chrono::hours(1);
  std::mutex mutex{};
  std::size_t done = 0;
  std::size_t skipped = 0;
  std::size_t reported_steps = 0;  // of Resolution() that the last line reported

  [[nodiscard]] double ElapsedSeconds() const {
    return std::chrono::duration<double>(Clock::now() - start).count();
  }
  [[nodiscard]] std::optional<double> SecondsLeft() const {
    const std::size_t worked = done - skipped;
    if (done >= total) return 0.0;
    if (worked == 0) return std::nullopt;
    return ElapsedSeconds() * static_cast<double>(total - done) / static_cast<double>(worked);
  }
  [[nodiscard]] std::size_t Percent() const { return total == 0 ? 100 : done * 100 / total; }

  void Count(std::size_t steps) {
    done = std::min(total, done + steps);
    if (form == Form::kBar) DrawBar();
    if (form == Form::kLines && IsDue(20)) PrintLine();
    if (form == Form::kJson && IsDue(100)) PrintJson();
  }
  /// Whether another of `resolution` equal parts of the work is complete since the last report.
  bool IsDue(std::size_t resolution) {
    const std::size_t steps = total == 0 ? resolution : done * resolution / total;
    if (steps == reported_steps) return false;
    reported_steps = steps;
    return true;
  }
  void DrawBar() {
    const Clock::time_point now = Clock::now();
    if (done < total && now - drawn < std::chrono::milliseconds(100)) return;
    drawn = now;
    const std::optional<double> left = SecondsLeft();
    const std::string time = done >= total ? "in " + DurationText(ElapsedSeconds())
                             : left        ? DurationText(*left) + " left"
                                           : "";
    Say(fmt::format("\r{} [{}] {:3} % {}/{} {:<12}", label, Bar(done, total), Percent(), done,
                    total, time));
  }
  void PrintLine() const {
    const std::optional<double> left = SecondsLeft();
    Say(fmt::format("{}: {} % ({} of {}){}\n", label, Percent(), done, total,
                    left ? ", " + DurationText(*left) + " left" : ""));
  }
  void PrintJson() const {
    const std::optional<double> left = SecondsLeft();
    Say(fmt::format("{{\"label\":{},\"done\":{},\"total\":{},\"elapsed_s\":{:.3f},\"eta_s\":{}}}\n",
                    JsonString(label), done, total, ElapsedSeconds(),
                    left ? fmt::format("{:.3f}", *left) : "null"));
  }
};

Progress::Progress(std::string label, std::size_t total, ProgressStyle style)
    : state_(new State{.label = std::move(label), .total = total, .form = FormOf(style)}) {
  if (state_->form == Form::kBar) state_->DrawBar();
}

Progress::~Progress() {
  if (state_->form == Form::kBar) Say("\n");
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

}  // namespace alpenglow
