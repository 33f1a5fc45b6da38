// SPDX-License-Identifier: MIT
#include "lut/cli/program.h"

#include <OpenEXR/OpenEXRConfig.h>
#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/version.h>
#include <semaphore.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <ctime>
#include <filesystem>
#include <latch>
#include <new>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/base/names.h"
#include "atmosphere/shared_glsl/instruction_set.h"
#include "lut/cli/command_words.h"
#include "lut/cli/messages.h"
#include "lut/cli/output_file.h"
#include "lut/cli/terminal.h"
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

// A signal handler may only access a lock-free atomic.
std::atomic<int> received_signal{0};
static_assert(std::atomic<int>::is_always_lock_free);

/// Exception that unwinds the stack to RunProgram. It is not a std::exception, so that no handler
/// on the way treats it as a fault.
struct Stopped {
  int signal;
};

/// Ends the process if it does not end by itself soon after a signal: no loop can be too long, and
/// no library too busy. A handler wakes it by a semaphore, one of the few calls that a handler may
/// make. Without a thread for it the program ends when it next looks for a signal.
class SignalWatch {
 public:
  explicit SignalWatch(std::string name) : name_(std::move(name)) {
    sem_init(&signalled, 0, 0);
    // Handlers run in other threads.
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    try {
      thread_ = std::thread([this] { Watch(); });
    } catch (const std::system_error&) {
      // There may be no further thread.
    }
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
  }
  ~SignalWatch() {
    is_over_.store(true);
    sem_post(&signalled);
    if (thread_.joinable()) thread_.join();
  }
  SignalWatch(const SignalWatch&) = delete;
  SignalWatch& operator=(const SignalWatch&) = delete;

  inline static sem_t signalled;

 private:
  void Watch() {
    while (sem_wait(&signalled) != 0) {
    }
    constexpr int kSeconds = 1;
    timespec end = {};
    clock_gettime(CLOCK_REALTIME, &end);
    end.tv_sec += kSeconds;
    while (!is_over_.load()) {
      if (sem_timedwait(&signalled, &end) != 0 && errno == ETIMEDOUT) break;
    }
    if (is_over_.load()) return;
    RemoveTemporariesOfThisProcess();
    const int signal = received_signal.load();
    LogWithoutWaiting(
        fmt::format("{}: {}\n", name_, signal == SIGINT ? "interrupted" : "terminated"));
    _exit(128 + signal);
  }

  std::string name_;
  std::atomic<bool> is_over_{false};
  std::thread thread_;
};

void RememberSignal(int signal) {
  const int error = errno;
  received_signal.store(signal);
  sem_post(&SignalWatch::signalled);
  errno = error;
}

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

/// Returns how many of a number of threads can be started beside this one, by starting them.
std::size_t StartableThreads(std::size_t wanted) {
  std::latch release(1);
  std::vector<std::thread> threads;
  threads.reserve(wanted);
  try {
    while (threads.size() < wanted) threads.emplace_back([&] { release.wait(); });
  } catch (const std::system_error&) {
    // This is the limit.
  }
  release.count_down();
  for (std::thread& thread : threads) thread.join();
  return threads.size();
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

std::string LongNameOf(const std::string& option) {
  const std::string typed = option.substr(0, option.find('='));
  return typed.substr(std::min(typed.find_first_not_of('-'), typed.size()));
}

std::string FaultOfOptionOfOthers(const std::string& option,
                                  const std::vector<std::string>& commands) {
  return fmt::format("{} is an option of {}, not of this command",
                     option.substr(0, option.find('=')), fmt::join(commands, " and "));
}

std::string FaultOfUnknownOption(const std::string& option, const std::vector<std::string>& known) {
  const std::string typed = option.substr(0, option.find('='));
  const std::vector<std::string> like = OptionsLike(LongNameOf(option), known);
  if (like.empty()) return fmt::format("unknown option {}", typed);
  return fmt::format("unknown option {}; did you mean --{}?", typed, fmt::join(like, " or --"));
}

int RunProgram(const std::string& name, const std::function<int()>& body) {
  OccupyStandardDescriptors();
  const SignalWatch watch(name);
  const WarningsOf warnings(name);
  InstallHandlers();
  try {
    const int status = body();
    FlushStandardOutput();
    return status;
  } catch (const OptionError& error) {
    return ReportFailure(name, error.what(), 2);
  } catch (const InputError& error) {
    return ReportFailure(name, error.what(), 3);
  } catch (const ReaderLeft&) {
    return 4;
  } catch (const OutputError& error) {
    return ReportFailure(name, error.what(), 4);
  } catch (const DisplayError& error) {
    return ReportFailure(name, error.what(), 5);
  } catch (const Stopped& stopped) {
    return ReportFailure(name, stopped.signal == SIGINT ? "interrupted" : "terminated",
                         128 + stopped.signal);
  } catch (const std::system_error& error) {
    if (error.code() != std::errc::resource_unavailable_try_again)
      return ReportFailure(name, fmt::format("internal error: {}", error.what()), 70);
    return ReportFailure(name,
                         "a thread cannot be started: give fewer --threads, or raise the limit of "
                         "processes (ulimit -u, the limit of a container)",
                         4);
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
  std::unique_ptr<tbb::global_control> control;
  bool must_stay = false;
};

ThreadLimit::ThreadLimit(int threads) : state_(std::make_unique<State>()) {
  if (threads < 0) {
    throw InputError(fmt::format("--threads is {}; it must be 0 (all) or more", threads));
  }
  const std::size_t usual =
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  const std::size_t wanted = threads > 0 ? static_cast<std::size_t>(threads) : usual;
  // One more than those that work at once: some libraries have a thread of their own.
  const std::size_t most = std::max(wanted, usual);
  const std::size_t startable = StartableThreads(most);
  const std::size_t allowed = startable < wanted ? std::max<std::size_t>(startable, 1) : wanted;
  state_->must_stay = startable < most;
  if (threads > 0 || state_->must_stay) {
    state_->control = std::make_unique<tbb::global_control>(
        tbb::global_control::max_allowed_parallelism, allowed);
  }
}

// If a limit ends, oneTBB starts the threads that it now may have. Where the machine refuses them,
// it would throw in this destructor, which ends the program: the limit stays until the end.
ThreadLimit::~ThreadLimit() {
  static std::vector<std::unique_ptr<tbb::global_control>>* const kept =
      new std::vector<std::unique_ptr<tbb::global_control>>();
  if (state_->must_stay) kept->push_back(std::move(state_->control));
}

}  // namespace alpenglow::lut
