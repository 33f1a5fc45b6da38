// SPDX-License-Identifier: MIT
#include "lut/cli/program.h"

#include <OpenEXR/OpenEXRConfig.h>
#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/version.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <filesystem>
#include <new>
#include <optional>
#include <system_error>

#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"
#include "atmosphere/shared_glsl/instruction_set.h"
#include "lut/layer.h"
#include "lut/version.h"

namespace alpenglow::lut {
namespace {

/// Returns the known options similar to a name; a single letter matches all options that begin with
/// it.
std::vector<std::string> OptionsLike(const std::string& name,
                                     const std::vector<std::string>& known) {
  if (name.size() != 1) {
    const std::optional<std::string> nearest = NearestName(name, known);
    return nearest ? std::vector<std::string>{*nearest} : std::vector<std::string>{};
  }
  std::vector<std::string> like;
  for (const std::string& one : known) {
    const bool is_new = std::find(like.begin(), like.end(), one) == like.end();
    if (one.starts_with(name) && is_new) like.push_back(one);
  }
  return like;
}

}  // namespace

std::string FaultOfCommand(const std::string& word, const std::vector<std::string>& commands) {
  std::error_code error;
  const bool is_known = std::find(commands.begin(), commands.end(), word) != commands.end();
  if (word.empty() || word.find_first_of("-./\\") != std::string::npos || is_known ||
      std::filesystem::exists(word, error)) {
    return "";
  }
  if (word == "help" || word == "version")
    return fmt::format("unknown command {0}; did you mean --{0}?", word);
  const std::optional<std::string> nearest = NearestName(word, commands);
  return nearest ? fmt::format("unknown command {}; did you mean {}?", word, *nearest) : "";
}

std::string FaultOfUnknownOption(const std::string& option, const std::vector<std::string>& known) {
  const std::string typed = option.substr(0, option.find('='));
  const std::string name = typed.substr(std::min(typed.find_first_not_of('-'), typed.size()));
  const std::vector<std::string> like = OptionsLike(name, known);
  if (like.empty()) return fmt::format("unknown option {}", typed);
  return fmt::format("unknown option {}; did you mean --{}?", typed, fmt::join(like, " or --"));
}

namespace {

// A signal handler may only access a lock-free atomic.
std::atomic<int> received_signal{0};
static_assert(std::atomic<int>::is_always_lock_free);

void RememberSignal(int signal) { received_signal.store(signal); }

/// Exception that unwinds the stack to RunProgram. It is not a std::exception, so that no handler
/// on the way treats it as a fault.
struct Stopped {
  int signal;
};

void InstallHandlers() {
  received_signal.store(0);
  struct sigaction action = {};
  action.sa_handler = RememberSignal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  for (const int lost : {SIGXFSZ, SIGPIPE, SIGHUP}) std::signal(lost, SIG_IGN);
}

int ReportFailure(const std::string& name, std::string message, int status) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  Log(fmt::format("{}: {}\n", name, message));
  return status;
}

// Returns "avx512 (of scalar, sse2, avx2, avx512)".
std::string SimdText() {
  std::string available;
  for (const InstructionSet set : AvailableInstructionSets()) {
    available += available.empty() ? "" : ", ";
    available += NameOf(set);
  }
  return fmt::format("{} (of {})", NameOf(CurrentInstructionSet()), available);
}

}  // namespace

int RunProgram(const std::string& name, const std::function<int()>& body) {
  OccupyStandardDescriptors();
  InstallHandlers();
  try {
    const int status = body();
    FlushStandardOutput();
    return status;
  } catch (const OptionError& error) {
    return ReportFailure(name, error.what(), 2);
  } catch (const InputError& error) {
    return ReportFailure(name, error.what(), 3);
  } catch (const OutputError& error) {
    return ReportFailure(name, error.what(), 4);
  } catch (const DisplayError& error) {
    return ReportFailure(name, error.what(), 5);
  } catch (const Stopped& stopped) {
    return ReportFailure(name, stopped.signal == SIGINT ? "interrupted" : "terminated",
                         128 + stopped.signal);
  } catch (const std::bad_alloc&) {
    return ReportFailure(name, "internal error: there is no memory left", 70);
  } catch (const std::exception& error) {
    return ReportFailure(name, fmt::format("internal error: {}", error.what()), 70);
  } catch (...) {
    return ReportFailure(name, "internal error: unknown exception", 70);
  }
}

bool Interrupted() { return received_signal.load() != 0; }

void ThrowIfInterrupted() {
  if (const int signal = received_signal.load(); signal != 0) throw Stopped{signal};
}

std::string ProducerText() {
  return fmt::format("alpenglow {} ({})", version::kRelease, version::kGitDescribe);
}

std::string VersionText(const std::string& program) {
  return fmt::format(
      "{} of {}\n"
      "compiled by {} {}\n"
      "libraries: OpenEXR {}, oneTBB {} (run time {}), fmt {}.{}.{}\n"
      "SIMD: {}\n",
      program, ProducerText(), version::kCompiler, version::kCompilerVersion,
      OPENEXR_VERSION_STRING, TBB_VERSION_STRING, TBB_runtime_version(), FMT_VERSION / 10000,
      FMT_VERSION / 100 % 100, FMT_VERSION % 100, SimdText());
}

struct ThreadLimit::State {
  std::optional<tbb::global_control> control;
};

ThreadLimit::ThreadLimit(int threads) : state_(std::make_unique<State>()) {
  if (threads < 0) {
    throw InputError(fmt::format("--threads is {}; it must be 0 (all) or more", threads));
  }
  if (threads > 0) {
    state_->control.emplace(tbb::global_control::max_allowed_parallelism,
                            static_cast<std::size_t>(threads));
  }
}

ThreadLimit::~ThreadLimit() = default;

}  // namespace alpenglow::lut
