// SPDX-License-Identifier: MIT
#include "lut/cli/output_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>

#include "atmosphere/base/error.h"
#include "lut/layer.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::lut {
namespace {

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

TEST_F(GrowingFiles, LinesStandInThePartUntilTheFileIsFinished) {
  GrowingFile file(folder_ / "a.csv");
  file.Append("one\n");
  EXPECT_EQ(ContentOf(folder_ / "a.csv.part"), "one\n") << "at once";
  file.Append("two\nthree\n");
  file.Sync();
  EXPECT_FALSE(fs::exists(folder_ / "a.csv"));
  file.Finish();
  EXPECT_EQ(ContentOf(folder_ / "a.csv"), "one\ntwo\nthree\n");
  EXPECT_EQ(FileCount(), 1U) << "the part has become the file";
}

TEST_F(GrowingFiles, WithoutALineThereIsNoFile) {
  { GrowingFile(folder_ / "a.csv").Finish(); }
  EXPECT_EQ(FileCount(), 0U);
}

TEST_F(GrowingFiles, AKilledWriterLeavesEveryLineAndTheNextOneKeepsThem) {
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

TEST_F(GrowingFiles, TwoProcessesDoNotWriteOne) {
  GrowingFile file(folder_ / "a.csv");
  file.Append("one\n");
  EXPECT_EQ(InProcess([&] { const GrowingFile second(folder_ / "a.csv"); }), 1 << 8)
      << "the second writer is refused";
  EXPECT_EQ(ContentOf(folder_ / "a.csv.part"), "one\n");
}

TEST_F(GrowingFiles, ADiskThatIsFullLeavesWholeLines) {
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

TEST_F(GrowingFiles, AFolderThatIsNotThereIsNamed) {
  const fs::path target = folder_ / "none" / "a.csv";
  EXPECT_THROW(GrowingFile{target}, OutputError);
  try {
    GrowingFile{target};
  } catch (const OutputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("none/a.csv"));
  }
}

}  // namespace
}  // namespace alpenglow::lut
