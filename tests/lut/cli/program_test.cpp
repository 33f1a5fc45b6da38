// SPDX-License-Identifier: MIT
#include "lut/cli/program.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>
#include <sstream>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "atmosphere/base/error.h"
#include "lut/cli/growing_file.h"
#include "lut/cli/output_file.h"
#include "lut/cli/outputs.h"
#include "lut/cli/terminal.h"
#include "lut/layer.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/lost_messages.h"
#include "tests/fixtures/report_files.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::lut {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

struct Outcome {
  int status;
  std::string error_text;
};

Outcome RunBody(const std::function<int()>& body) {
  testing::internal::CaptureStderr();
  const int status = RunProgram("skytest", body);
  return {status, testing::internal::GetCapturedStderr()};
}

using AtomicFile = TemporaryFolder;

TEST(Program, ReturnsTheStatusOfItsBody) {
  EXPECT_EQ(RunBody([] { return 0; }).status, 0);
  EXPECT_EQ(RunBody([] { return 2; }).status, 2);
}

TEST(Program, WarningsBeginWithTheProgramsName) {
  const auto warning = [] {
    Warn("thick air");
    return 0;
  };
  EXPECT_EQ(RunBody(warning).error_text, "skytest: warning: thick air\n");
  testing::internal::CaptureStderr();
  Warn("thick air");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "alpenglow: warning: thick air\n");
}

TEST(Program, EveryKindOfFailureHasItsStatusAndOneLine) {
  const std::vector<std::pair<int, std::function<int()>>> cases = {
      {2, []() -> int { throw OptionError("--size 99999x1"); }},
      {3, []() -> int { throw InputError("x.toml:3: key g"); }},
      {4, []() -> int { throw OutputError("out.exr"); }},
      {5, []() -> int { throw DisplayError("OpenGL 2.1"); }},
      {70, []() -> int { throw InternalError("two\nlines"); }},
      {70, []() -> int { throw std::bad_alloc(); }},
      {70, []() -> int { throw 7; }},
  };
  for (const auto& [status, body] : cases) {
    const Outcome outcome = RunBody(body);
    EXPECT_EQ(outcome.status, status);
    EXPECT_EQ(CountOf(outcome.error_text, "\n"), 1U) << outcome.error_text;
    EXPECT_THAT(outcome.error_text, testing::StartsWith("skytest: "));
  }
}

// Hard case 45.
TEST(Program, ASignalStopsBetweenUnitsAndSetsTheStatus) {
  for (const int signal : {SIGINT, SIGTERM}) {
    int units = 0;
    const Outcome outcome = RunBody([&] {
      for (; units < 5; ++units) {
        ThrowIfInterrupted();
        if (units == 2) std::raise(signal);
      }
      return 0;
    });
    EXPECT_EQ(outcome.status, 128 + signal);
    EXPECT_EQ(units, 3) << "the unit during which the signal came is finished";
    EXPECT_TRUE(Interrupted());
  }
  EXPECT_EQ(RunBody([] { return Interrupted() ? 1 : 0; }).status, 0) << "a new run starts afresh";
}

/// Runs a body in a child process that gets a signal, and returns the status of the program.
int StatusOfSignalled(int signal, const std::function<int()>& body) {
  const pid_t child = fork();
  if (child == 0) {
    static_cast<void>(!freopen("/dev/null", "w", stderr));
    _exit(RunProgram("skytest", [&] {
      std::raise(signal);
      return body();
    }));
  }
  return ExitStatusOf(child);
}

// A loop that never looks for signals, while it writes a file.
TEST_F(AtomicFile, ASignalEndsWorkThatDoesNotCheckForIt) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const int status = StatusOfSignalled(signal, [&] {
      WriteTextAtomically(folder_ / "done.txt", "whole");
      WriteFileAtomically(folder_ / "half.txt", [](const fs::path&) {
        for (;;) pause();
      });
      return 0;
    });
    EXPECT_EQ(status, 128 + signal);
    EXPECT_EQ(ContentOf(folder_ / "done.txt"), "whole") << "finished work is kept";
    EXPECT_EQ(FileCount(), 1U) << "and nothing else";
  }
}

TEST(Program, ABrokenPipeEndsTheWorkWithoutAMessage) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  std::fflush(stdout);
  const int before = dup(STDOUT_FILENO);
  dup2(ends[1], STDOUT_FILENO);
  close(ends[0]);
  close(ends[1]);
  int lines = 0;
  const Outcome outcome = RunBody([&] {
    for (; lines < 1000; ++lines) PrintNow("a line\n");
    return 0;
  });
  dup2(before, STDOUT_FILENO);
  std::clearerr(stdout);
  std::cout.clear();
  close(before);
  EXPECT_EQ(outcome.status, 4);
  EXPECT_EQ(outcome.error_text, "");
  EXPECT_EQ(lines, 0) << "at the first line that nobody reads";
}

TEST(Program, AFailureToStartThreadsIsNoInternalError) {
  const Outcome outcome = RunBody([]() -> int {
    throw std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again));
  });
  EXPECT_EQ(outcome.status, 4);
  EXPECT_THAT(outcome.error_text, HasSubstr("a thread cannot be started: give fewer --threads"));
}

TEST(Program, HelpIsAsWideAsTheTerminal) {
  const std::string text =
      "Options:\n  --height,--altitude FLOAT  Height of the camera in metres above the ellipsoid\n"
      "Example: a picture\n  skytest --latitude 35.36 --longitude 138.73 --out fuji.exr\n";
  EXPECT_EQ(Wrapped(text, 200, "skytest "), text);
  EXPECT_EQ(Wrapped(text, 59, "skytest "),
            "Options:\n  --height,--altitude FLOAT  Height of the camera in metres\n"
            "                             above the ellipsoid\n"
            "Example: a picture\n  skytest --latitude 35.36 --longitude 138.73 --out \\\n"
            "    fuji.exr\n");
  for (std::size_t columns = 30; columns < 100; ++columns) {
    std::istringstream lines(Wrapped(text, columns, "skytest "));
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), columns) << line;
  }
}

TEST(Program, RoundedDirectionsAreBelow360Degrees) {
  EXPECT_EQ(DirectionText(359.9998, 3), "0.000");
  EXPECT_EQ(DirectionText(359.9994, 3), "359.999");
  EXPECT_EQ(DirectionText(-1e-12, 6), "0.000000");
  EXPECT_EQ(DirectionText(-90.0, 1), "270.0");
  EXPECT_EQ(DirectionText(360.0, 0), "0");
  EXPECT_EQ(DirectionText(359.6, 0), "0");
}

TEST(Program, VersionNamesProgramReleaseAndLibraries) {
  const std::string text = VersionText("skytest");
  EXPECT_THAT(text, testing::StartsWith("skytest of alpenglow "));
  EXPECT_THAT(text, HasSubstr("OpenEXR 3."));
  EXPECT_THAT(text, HasSubstr("SIMD: "));
  EXPECT_THAT(ProducerText(), testing::MatchesRegex("alpenglow [0-9.]+ \\(.+\\)"));
}

TEST(Program, ANegativeNumberOfThreadsIsRefused) {
  EXPECT_THROW(ThreadLimit{-1}, InputError);
  EXPECT_NO_THROW(ThreadLimit{0});
}

// A user who may start no thread at all, or two. The limit does not hold for root.
TEST(Program, UsesFewerThreadsWhenTheSystemLimitsThem) {
  for (const rlim_t most : {1U, 3U}) {
    const pid_t child = fork();
    if (child == 0) {
      const rlimit limit{most, most};
      if (setrlimit(RLIMIT_NPROC, &limit) != 0) _exit(100);
      if (geteuid() == 0 && setuid(54321) != 0) _exit(100);
      const ThreadLimit threads(8);
      _exit(static_cast<int>(
          tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)));
    }
    const int status = ExitStatusOf(child);
    EXPECT_GE(status, 1);
    EXPECT_LE(status, static_cast<int>(most));
  }
}

TEST(Program, UnwritableStandardOutputExitsWith4) {
  const int full = open("/dev/full", O_WRONLY);
  ASSERT_GE(full, 0);
  std::fflush(stdout);
  const int before = dup(STDOUT_FILENO);
  dup2(full, STDOUT_FILENO);
  bool done = false;
  const Outcome outcome = RunBody([&] {
    Print(std::string(100000, 'x'));  // more than a buffer holds
    done = true;
    return 0;
  });
  dup2(before, STDOUT_FILENO);
  std::clearerr(stdout);
  close(before);
  close(full);
  EXPECT_TRUE(done);
  EXPECT_EQ(outcome.status, 4);
  EXPECT_THAT(outcome.error_text, HasSubstr("standard output: cannot be written: No space left"));
  EXPECT_EQ(RunBody([] { return 0; }).status, 0) << "the next run knows nothing of it";
}

TEST_F(AtomicFile, LongNamesAreWritten) {
  WriteTextAtomically(folder_ / "a.txt", "one");
  WriteTextAtomically(folder_ / "a.txt", "two");
  EXPECT_EQ(ContentOf(folder_ / "a.txt"), "two");
  EXPECT_EQ(FileCount(), 1U);
  const fs::path target = folder_ / (std::string(250, 'n') + ".exr");  // of 255 bytes
  WriteTextAtomically(target, "one");
  EXPECT_EQ(ContentOf(target), "one");
}

TEST_F(AtomicFile, TwoOutputsToOneFileAreRefused) {
  fs::create_directory(folder_ / "d");
  fs::create_directory_symlink(folder_ / "d", folder_ / "link");
  fs::create_symlink("d/a.png", folder_ / "to_a.png");
  const fs::path before = fs::current_path();
  fs::current_path(folder_);
  for (const char* other :
       {"d/a.png", "./d/a.png", "d/../d/a.png", "link/a.png", "to_a.png", "new/../d/a.png"}) {
    const auto outputs = [&](const fs::path& file) {
      return std::vector<NamedFile>{
          {"--out", "x.exr"}, {"--png", folder_ / "d" / "a.png"}, {"--keogram", file}};
    };
    EXPECT_THROW(RequireDifferent(outputs(other)), OptionError) << other;
    EXPECT_THROW(RequireDifferent(outputs(folder_ / other)), OptionError) << other;
  }
  EXPECT_NO_THROW(RequireDifferent({{"--out", "a.png"}, {"--png", "d/a.png"}, {"--k", "b.png"}}));
  fs::current_path(before);
}

TEST_F(AtomicFile, FoldersOfOutputsAreMadeBeforeTheWork) {
  PrepareOutputs({{"--out", folder_ / "new" / "deep" / "x.exr"}}, {});
  EXPECT_TRUE(fs::is_directory(folder_ / "new" / "deep"));
  EXPECT_EQ(FileCount(), 1U) << "and no file yet";
  WriteText(folder_ / "in.csv", "1");
  EXPECT_THROW(PrepareOutputs({{"--out", folder_ / "new" / ".." / "in.csv"}},
                              {{"--cases", folder_ / "in.csv"}}),
               InputError);
  EXPECT_THROW(PrepareOutputs({{"--out", folder_ / "in.csv" / "x.exr"}}, {}), OutputError);
}

TEST_F(AtomicFile, ModeFollowsTheUmask) {
  const mode_t before = umask(022);
  WriteTextAtomically(folder_ / "a.txt", "one");
  umask(before);
  struct stat status = {};
  ASSERT_EQ(stat((folder_ / "a.txt").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0644U);
}

// Hard case 45.
TEST_F(AtomicFile, AFailedWriterLeavesTheOldFileAndNoTemporary) {
  WriteTextAtomically(folder_ / "a.txt", "old");
  const auto fail = [](const fs::path& name) {
    std::ofstream(name) << "half";
    throw OutputError(name.string() + ": the disk is full");
  };
  EXPECT_EQ(tests::FaultOf<OutputError>([&] { WriteFileAtomically(folder_ / "a.txt", fail); }),
            (folder_ / "a.txt").string() + ": the disk is full")
      << "the user's name, not the temporary's";
  EXPECT_EQ(ContentOf(folder_ / "a.txt"), "old");
  EXPECT_EQ(FileCount(), 1U);
}

TEST_F(AtomicFile, OtherExceptionsPropagateAndLeaveNoFile) {
  EXPECT_THROW(
      WriteFileAtomically(folder_ / "a.txt", [](const fs::path&) { throw InputError("x"); }),
      InputError);
  EXPECT_EQ(FileCount(), 0U);
}

// Hard case 46.
TEST_F(AtomicFile, AMissingFolderIsAnOutputErrorThatNamesTheTarget) {
  const fs::path target = folder_ / "missing" / "a.txt";
  EXPECT_THAT(tests::FaultOf<OutputError>([&] { WriteTextAtomically(target, "one"); }),
              HasSubstr(target.string()));
}

// Hard case 46.
TEST_F(AtomicFile, AFolderRemovedWhileWritingIsAnOutputError) {
  const fs::path folder = folder_ / "gone";
  fs::create_directory(folder);
  EXPECT_THROW(
      WriteFileAtomically(folder / "a.txt", [&](const fs::path&) { fs::remove_all(folder); }),
      OutputError);
}

/// While it lives, a superuser, who may write into read-only folders, has the rights of the user
/// "nobody". It changes nothing for other users.
class WithoutSuperuser {
 public:
  WithoutSuperuser() : was_superuser_(geteuid() == 0) {
    constexpr uid_t kNobody = 65534;
    if (was_superuser_ && seteuid(kNobody) != 0) throw std::runtime_error("seteuid failed");
  }
  ~WithoutSuperuser() {
    if (was_superuser_ && seteuid(0) != 0) std::abort();
  }
  WithoutSuperuser(const WithoutSuperuser&) = delete;
  WithoutSuperuser& operator=(const WithoutSuperuser&) = delete;

 private:
  bool was_superuser_;
};

// Hard case 46.
TEST_F(AtomicFile, AReadOnlyFolderIsAnOutputError) {
  fs::permissions(folder_, fs::perms::owner_read | fs::perms::owner_exec);
  {
    const WithoutSuperuser ordinary_rights;
    EXPECT_THROW(WriteTextAtomically(folder_ / "a.txt", "one"), OutputError);
  }
  fs::permissions(folder_, fs::perms::owner_all);
  EXPECT_FALSE(fs::exists(folder_ / "a.txt"));
}

TEST_F(AtomicFile, FoldersAndDevicesAreNotReplaced) {
  EXPECT_THROW(WriteTextAtomically(folder_, "one"), OutputError);
  EXPECT_THROW(WriteTextAtomically("/dev/null", "one"), OutputError);
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(AtomicFile, ASymbolicLinkIsFollowed) {
  fs::create_directory(folder_ / "real");
  fs::create_symlink(folder_ / "real" / "a.txt", folder_ / "link.txt");
  WriteTextAtomically(folder_ / "link.txt", "one");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.txt"));
  EXPECT_EQ(ContentOf(folder_ / "real" / "a.txt"), "one");
}

// A file-size limit stands in for the full disk: write() fails in the same way, with EFBIG.
// Hard case 46.
TEST_F(AtomicFile, AFullDiskIsAnOutputErrorAndLeavesNothing) {
  const fs::path target = folder_ / "a.txt";
  rlimit before = {};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const Outcome outcome = RunBody([&] {
    rlimit small = before;
    small.rlim_cur = 1000;
    setrlimit(RLIMIT_FSIZE, &small);
    const std::string fault =
        tests::FaultOf<OutputError>([&] { WriteTextAtomically(target, std::string(100000, 'x')); });
    setrlimit(RLIMIT_FSIZE, &before);
    throw OutputError(fault);
    return 0;
  });
  EXPECT_EQ(outcome.status, 4);
  EXPECT_THAT(outcome.error_text, HasSubstr(target.string()));
  EXPECT_EQ(FileCount(), 0U);
}

// Hard case 47.
TEST_F(AtomicFile, ConcurrentWritersOfOneFileBothSucceed) {
  const auto write = [&](char letter) {
    for (int i = 0; i < 50; ++i) {
      WriteTextAtomically(folder_ / "a.txt", std::string(5000, letter));
    }
  };
  std::thread other(write, 'a');
  write('b');
  other.join();
  const std::string content = ContentOf(folder_ / "a.txt");
  EXPECT_EQ(content, std::string(5000, content.at(0))) << "one writer's content, unmixed";
  EXPECT_EQ(FileCount(), 1U);
}

// Hard case 45.
TEST_F(AtomicFile, OnlyFilesOfKilledWritersAreRemoved) {
  tests::LeaveTemporaryOf(folder_ / "a.exr");
  ASSERT_EQ(FileCount(), 1U);
  std::size_t removed = 0, there = 0;
  WriteFileAtomically(folder_ / "b.exr", [&](const fs::path& name) {
    std::ofstream(name) << "b";
    removed = RemoveAbandonedTemporaries(folder_);
    there = FileCount();
  });
  EXPECT_EQ(removed, 1U);
  EXPECT_EQ(there, 1U) << "the living writer's";
  EXPECT_EQ(ContentOf(folder_ / "b.exr"), "b");
  EXPECT_EQ(RemoveAbandonedTemporaries(folder_ / "missing"), 0U);
}

TEST_F(AtomicFile, TemporariesOfOtherMachinesAndOtherFilesAreKept) {
  tests::LeaveTemporaryOf(folder_ / "a.exr");
  const fs::path ours = *fs::directory_iterator(folder_);
  std::string name = ours.filename().string();  // .a.MACHINE-...
  name[3] = name[3] == '0' ? '1' : '0';
  fs::rename(ours, folder_ / name);
  for (const char* other : {".a.part.exr", "a.exr.part", ".hidden", "a.exr"}) {
    std::ofstream(folder_ / other) << "x";
  }
  EXPECT_EQ(RemoveAbandonedTemporaries(folder_), 0U);
  EXPECT_EQ(FileCount(), 5U);
}

TEST_F(AtomicFile, CheckingATargetChangesNothing) {
  WriteTextAtomically(folder_ / "a.txt", "old");
  EXPECT_NO_THROW(RequireWritable(folder_ / "a.txt"));
  EXPECT_NO_THROW(RequireWritable(folder_ / "b.txt"));
  EXPECT_THROW(RequireWritable(folder_), OutputError);
  EXPECT_THROW(RequireWritable(folder_ / "none" / "a.txt"), OutputError);
  EXPECT_THROW(RequireWritable("/dev/null"), OutputError);
  EXPECT_EQ(ContentOf(folder_ / "a.txt"), "old");
  EXPECT_EQ(FileCount(), 1U);
}

using OutputName = TemporaryFolder;

TEST_F(OutputName, AnInputIsRecognisedUnderAnyName) {
  std::ofstream(folder_ / "in.csv") << "x";
  fs::create_symlink("in.csv", folder_ / "link.csv");
  fs::create_directory(folder_ / "sub");
  const std::vector<NamedFile> inputs{{"--cases", folder_ / "in.csv"}};
  for (const fs::path& same :
       {folder_ / "in.csv", folder_ / "link.csv", folder_ / "sub" / ".." / "in.csv"}) {
    EXPECT_THROW(RequireNoInput({"--out", same}, inputs), InputError) << same;
  }
  EXPECT_NO_THROW(RequireNoInput({"--out", folder_ / "out.csv"}, inputs));
  EXPECT_NO_THROW(RequireNoInput({"--out", folder_ / "o"}, {{"--cases", folder_ / "none"}}));
}

TEST_F(OutputName, ExtensionSelectsTheFormat) {
  EXPECT_EQ(FaultOfFileName("a/b.exr", ".exr"), "");
  EXPECT_EQ(FaultOfFileName("a/b.EXR", ".exr"), "");
  EXPECT_THAT(FaultOfFolderName("a/b.EXR"), HasSubstr("no name of a folder"));
  EXPECT_THAT(FaultOfFileName("b.hdr", ".exr"), HasSubstr("must end in .exr"));
  EXPECT_THAT(FaultOfFileName("-", ".exr"), HasSubstr("standard output"));
  EXPECT_THAT(FaultOfFileName("-", ""), HasSubstr("standard output"));
  EXPECT_EQ(FaultOfFileName("results", ""), "");
  EXPECT_EQ(FaultOfFolderName("tables"), "");
  EXPECT_EQ(FaultOfFolderName("tables.v2"), "");
  EXPECT_EQ(FaultOfFolderName("."), "");
  for (const char* file : {"t.dds", "t.exr", "-"}) EXPECT_NE(FaultOfFolderName(file), "") << file;
}

/// Returns what a progress that `work` advances writes to standard error.
template <typename Work>
std::string TextOfProgress(ProgressStyle style, std::size_t total, const Work& work) {
  testing::internal::CaptureStderr();
  {
    Progress progress("frames", total, style);
    work(progress);
  }
  return testing::internal::GetCapturedStderr();
}

std::string ProgressText(ProgressStyle style, std::size_t total) {
  return TextOfProgress(style, total, [&](Progress& progress) {
    for (std::size_t i = 0; i < total; ++i) progress.Advance();
  });
}

TEST(Progress, PlainStyleHasALinePerTenPercentAndQuietNone) {
  const std::string text = ProgressText(ProgressStyle::kPlain, 1000);
  EXPECT_EQ(CountOf(text, "\n"), 10U);
  EXPECT_THAT(text, HasSubstr("frames: 10 % (100 of 1000)"));
  EXPECT_THAT(text, HasSubstr("frames: 100 % (1000 of 1000)"));
  EXPECT_EQ(CountOf(ProgressText(ProgressStyle::kAuto, 40), "\n"), 10U) << "outside a terminal";
  EXPECT_EQ(ProgressText(ProgressStyle::kQuiet, 100), "");
}

TEST(Progress, JsonHasOneObjectPerLine) {
  const std::string text = ProgressText(ProgressStyle::kJson, 4);
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    EXPECT_THAT(line, testing::MatchesRegex("\\{\"label\":\"frames\",\"done\":[0-9]+,\"total\":4,"
                                            "\"elapsed_s\":[0-9.]+,\"eta_s\":[0-9.]+\\}"));
  EXPECT_EQ(CountOf(text, "\n"), 4U);
  EXPECT_THAT(text, HasSubstr("\"done\":4"));
  EXPECT_THAT(TextOfProgress(ProgressStyle::kJson, 4, [](Progress& progress) { progress.Skip(2); }),
              HasSubstr("\"done\":2,\"total\":4"))
      << "skipped work";
}

std::string TextOfOneUnit(ProgressStyle style) {
  return TextOfProgress(style, 2, [](Progress& progress) {
    for (const char* step : {"terrain", "mesh", "terrain"}) progress.Prepare(step);
    for (int quarter = 1; quarter <= 4; ++quarter) progress.Part(0.25 * quarter);
    progress.Advance();
  });
}

TEST(Progress, ALongUnitShowsItsStepAndFraction) {
  const std::string json = TextOfOneUnit(ProgressStyle::kJson);
  EXPECT_THAT(json, HasSubstr("{\"label\":\"frames\",\"step\":\"mesh\",\"elapsed_s\":"));
  EXPECT_THAT(json, HasSubstr("{\"label\":\"frames\",\"done\":0,\"part\":0.250,\"total\":2,"));
  EXPECT_THAT(json, HasSubstr("{\"label\":\"frames\",\"done\":1,\"total\":2,"));
  EXPECT_EQ(CountOf(json, "\n"), 2U + 5U) << "two steps, four parts, the whole";
  EXPECT_EQ(TextOfOneUnit(ProgressStyle::kPlain).substr(0, 68),
            "frames: preparing terrain\nframes: preparing mesh\nframes: 50 % (1 of ");
}

TEST(Progress, FractionsOfUnitsNeverDecrease) {
  const std::string text = TextOfProgress(ProgressStyle::kJson, 1, [](Progress& progress) {
    for (const double part : {0.5, 0.25, 0.75}) progress.Part(part);  // 0.25 of a thread held up
  });
  EXPECT_EQ(CountOf(text, "\n"), 2U);
}

TEST(Progress, AdvancesFromManyThreadsAreAllCounted) {
  const std::string text = TextOfProgress(ProgressStyle::kPlain, 400, [](Progress& progress) {
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t) {
      threads.emplace_back([&] {
        for (int i = 0; i < 100; ++i) progress.Advance();
      });
    }
    for (std::thread& thread : threads) thread.join();
  });
  EXPECT_EQ(CountOf(text, "\n"), 10U);
  EXPECT_THAT(text, HasSubstr("100 % (400 of 400)"));
}

TEST(Progress, DurationsAreShownInCommonUnits) {
  EXPECT_EQ(DurationText(0.2), "0s");
  EXPECT_EQ(DurationText(59.7), "1m00s");
  EXPECT_EQ(DurationText(200.0), "3m20s");
  EXPECT_EQ(DurationText(7500.0), "2h05m");
}

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class GrowingFiles : public TemporaryFolder {
 protected:
  /// Runs `work` in a process of its own. @return how waitpid found it.
  template <typename Work>
  static int InProcess(const Work& work) {
    const pid_t child = fork();
    if (child == 0) {
      try {
        work();
      } catch (const std::exception&) {
        _exit(1);
      }
      _exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return status;
  }
};

TEST_F(GrowingFiles, LinesAreInThePartUntilTheFileIsFinished) {
  GrowingFile file(folder_ / "a.csv");
  file.Append("one\n");
  EXPECT_EQ(ContentOf(folder_ / "a.csv.part"), "one\n") << "at once";
  file.Append("two\nthree\n");
  file.Sync();
  EXPECT_FALSE(fs::exists(folder_ / "a.csv"));
  file.Finish();
  EXPECT_EQ(ContentOf(folder_ / "a.csv"), "one\ntwo\nthree\n");
  EXPECT_EQ(FileCount(), 1U) << "the part has become the file";
  { GrowingFile(folder_ / "b.csv").Finish(); }
  EXPECT_EQ(FileCount(), 1U) << "without a line there is no file";
}

TEST_F(GrowingFiles, AKilledWriterLeavesEveryLine) {
  const int status = InProcess([&] {
    GrowingFile file(folder_ / "a.csv");
    file.Append("one\ntwo\n");
    std::raise(SIGKILL);
  });
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(ContentOf(folder_ / "a.csv.part"), "one\ntwo\n");
  GrowingFile next(folder_ / "a.csv");
  ASSERT_TRUE(next.kept().has_value());
  EXPECT_EQ(*next.kept(), folder_ / "a.csv.1.part");
  EXPECT_EQ(ContentOf(*next.kept()), "one\ntwo\n");
  next.Append("three\n");
  next.Finish();
  EXPECT_EQ(ContentOf(folder_ / "a.csv"), "three\n");
}

TEST_F(GrowingFiles, TwoProcessesCannotWriteOneFile) {
  GrowingFile file(folder_ / "a.csv");
  file.Append("one\n");
  EXPECT_EQ(InProcess([&] { const GrowingFile second(folder_ / "a.csv"); }), 1 << 8)
      << "the second writer is refused";
  EXPECT_EQ(ContentOf(folder_ / "a.csv.part"), "one\n");
}

TEST_F(GrowingFiles, AFullDiskLeavesCompleteLines) {
  const int status = InProcess([&] {
    const rlimit limit{10, 10};  // bytes of a file
    setrlimit(RLIMIT_FSIZE, &limit);
    std::signal(SIGXFSZ, SIG_IGN);
    GrowingFile file(folder_ / "a.csv");
    file.Append("seven..\n");
    file.Append("more than fits\n");
  });
  EXPECT_EQ(status, 1 << 8) << "OutputError";
  EXPECT_EQ(ContentOf(folder_ / "a.csv.part"), "seven..\n");
}

TEST_F(GrowingFiles, AMissingFolderIsNamed) {
  const fs::path target = folder_ / "none" / "a.csv";
  EXPECT_THAT(tests::FaultOf<OutputError>([&] { GrowingFile{target}; }), HasSubstr("none/a.csv"));
}

}  // namespace
}  // namespace alpenglow::lut
