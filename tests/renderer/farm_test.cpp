// SPDX-License-Identifier: MIT
// The scripts of a farm with substitutes for Slurm and the program: which commands they call.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fixtures/places.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::renderer {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class Farm : public TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    fs::create_directory(folder_ / "bin");
    for (const char* name : {"sbatch", "scancel", "scontrol"}) {
      // The script prints an id like sbatch. It fails like a requeue that is not granted, which
      // ends the caller.
      Script(name, std::string("echo ") + name + " \"$@\" >> calls; [ " + name +
                       " = sbatch ] && echo 77");
    }
  }
  void Script(const std::string& name, const std::string& text) {
    WriteText(folder_ / "bin" / name, "#!/bin/sh\n" + text + "\n");
    fs::permissions(folder_ / "bin" / name, fs::perms::owner_all);
  }
  /// Makes a program that writes its arguments and ends with a status.
  void Program(int status) {
    Script("program", "echo \"$@\" >> asked; echo frame; echo 0; echo 1; echo 2; exit " +
                          std::to_string(status));
  }
  [[nodiscard]] Outcome Run(const std::string& environment, const std::string& script) const {
    return RunCommand("cd '" + folder_.string() + "' && env PATH=\"$PWD/bin:$PATH\" " +
                      environment + " bash '" + tests::kSourceFolder + "/renderer/farm/'" + script);
  }
  [[nodiscard]] Outcome Task(const std::string& more = "") const {
    return Run(
        "SLURM_ARRAY_JOB_ID=9 SLURM_ARRAY_TASK_ID=1 SLURM_CPUS_PER_TASK=3 PER_TASK=2 "
        "FRAMES=3 " +
            more,
        "frames.sbatch program s.toml");
  }
  [[nodiscard]] std::string Calls() const {
    return fs::exists(folder_ / "calls") ? ContentOf(folder_ / "calls") : "";
  }
};

TEST_F(Farm, ATaskRendersItsShareOfTheFrames) {
  Program(0);
  EXPECT_EQ(Task().status, 0);
  EXPECT_THAT(ContentOf(folder_ / "asked"),
              HasSubstr("s.toml --frames 2-2 --resume --quiet --threads 3"))
      << "of three frames the second task of two has one";
  EXPECT_EQ(Task("SLURM_ARRAY_TASK_ID=2").status, 0) << "there are no more";
  EXPECT_EQ(Calls(), "");
}

TEST_F(Farm, AFailedTaskIsRequeuedAFewTimes) {
  for (const int status : {4, 70, 143}) {
    Program(status);
    fs::remove(folder_ / "calls");
    EXPECT_EQ(Task().status, status);
    EXPECT_THAT(Calls(), HasSubstr("scontrol requeue 9_1")) << status;
  }
  fs::remove(folder_ / "calls");
  EXPECT_EQ(Task("SLURM_RESTART_COUNT=3").status, 143);
  EXPECT_EQ(Calls(), "");
}

TEST_F(Farm, AnInvalidJobIsCancelledAndNotRequeued) {
  for (const int status : {2, 3}) {
    Program(status);
    fs::remove(folder_ / "calls");
    EXPECT_EQ(Task().status, status);
    EXPECT_THAT(Calls(), AllOf(HasSubstr("scancel --state=PENDING 9"), Not(HasSubstr("requeue"))));
  }
}

TEST_F(Farm, TheLastJobWaitsForAllFrames) {
  Program(0);
  const Outcome outcome = Run("PER_TASK=2", "submit.sh out --partition=p -- program s.toml");
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_THAT(Calls(), AllOf(HasSubstr("--array=0-1 --partition=p"), HasSubstr("afterok:77")));
  EXPECT_TRUE(fs::is_directory(folder_ / "out"));
  Program(3);
  EXPECT_EQ(Run("", "submit.sh out -- program s.toml").status, 3) << "as the program says";
  EXPECT_EQ(Run("", "submit.sh").status, 2);
}

TEST_F(Farm, TheLastJobMakesTheSheetKeogramAndPlot) {
  Program(0);
  EXPECT_EQ(Run("", "finish.sbatch out program s.toml").status, 0);
  EXPECT_THAT(ContentOf(folder_ / "asked"),
              HasSubstr("s.toml --resume --quiet --threads 1 --contact-sheet out/sheet.png "
                        "--keogram out/keogram.png --plot out/plot.svg"));
}

TEST_F(Farm, TablesOfAnAtmosphereAreCompleteOrAbsent) {
  Script("skylut",
         "echo \"$@\" >> asked; while [ \"$1\" != --out ]; do shift; done; mkdir \"$2\"; "
         "exit ${FAIL:-0}");
  const std::string array = "tables.sbatch out airs/hazy.toml airs/clear.toml";
  EXPECT_EQ(Run("SLURM_ARRAY_TASK_ID=1 FAIL=4", array).status, 4);
  EXPECT_TRUE(fs::is_empty(folder_ / "out"));
  EXPECT_EQ(Run("SLURM_ARRAY_TASK_ID=1 OPTIONS='--quality preview'", array).status, 0);
  EXPECT_TRUE(fs::is_directory(folder_ / "out" / "clear"));
  EXPECT_THAT(ContentOf(folder_ / "asked"), HasSubstr("--atmosphere airs/clear.toml"));
  EXPECT_THAT(ContentOf(folder_ / "asked"), HasSubstr("--threads 1 --quality preview"));
  fs::remove(folder_ / "asked");
  EXPECT_EQ(Run("SLURM_ARRAY_TASK_ID=1", array).status, 0);
  EXPECT_FALSE(fs::exists(folder_ / "asked")) << "it is there already";
}

}  // namespace
}  // namespace alpenglow::renderer
