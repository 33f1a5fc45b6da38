// SPDX-License-Identifier: MIT
#include "viewer/flight/flight_recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>

#include "atmosphere/base/error.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::viewer {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class FlightRecords : public TemporaryFolder {
 protected:
  [[nodiscard]] fs::path File() const { return folder_ / "f.csv"; }
  [[nodiscard]] fs::path Part() const { return folder_ / "f.csv.part"; }

  /// Northwards, 3000 m high, a frame of a sixtieth of a second after the other.
  static void Fly(FlightRecorder& recorder, int frames) {
    const UtcInstant start = ParseInstant("2026-06-21T04:00:00Z");
    for (int frame = 0; frame < frames; ++frame) {
      const double seconds = frame / 60.0;
      const CameraPose eye{PlaceFromDegrees(46.0 + 1e-4 * seconds, 8.0, 3000.0)};
      recorder.Note(seconds, eye, AddSeconds(start, 60.0 * seconds));
    }
  }
};

TEST_F(FlightRecords, AFlightIsOnTheDiskWhileItIsFlown) {
  FlightRecorder recorder(File());
  Fly(recorder, 61);
  const CameraPath flown = ReadFlight(Part());
  EXPECT_NEAR(flown.end_s(), 1.0, 0.05) << "a line is never later than the frame";
  EXPECT_FALSE(fs::exists(File())) << "not under its name before it is whole";
  recorder.Finish();
  EXPECT_FALSE(fs::exists(Part()));
  const CameraPath whole = ReadFlight(File());
  EXPECT_EQ(whole.points().size(), flown.points().size());
  EXPECT_NEAR(SecondsBetween(*whole.UtcAt(0.0), *whole.UtcAt(1.0)), 60.0, 0.1)
      << "a minute of the scene in a second of the pilot";
}

TEST_F(FlightRecords, ARecorderThatGoesOutOfScopeFinishesItsFile) {
  {
    FlightRecorder recorder(File());
    Fly(recorder, 10);
  }
  EXPECT_EQ(ReadFlight(File()).points().size(), 4U) << "every third sixtieth of a second";
}

TEST_F(FlightRecords, WithoutAFileNothingIsWritten) {
  FlightRecorder recorder;
  Fly(recorder, 10);
  recorder.Finish();
  EXPECT_EQ(FileCount(), 0U);
}

TEST_F(FlightRecords, OfALineThatWasCutTheLinesBeforeAreFlown) {
  {
    FlightRecorder recorder(File());
    Fly(recorder, 31);
  }
  const std::string text = ContentOf(File());
  WriteText(Part(), text.substr(0, text.size() - 20));
  const CameraPath cut = ReadFlight(Part());
  EXPECT_EQ(cut.points().size() + 1, ReadFlight(File()).points().size());
  // What a loss of power leaves where the file had grown and its bytes had not come.
  WriteText(Part(), text + std::string(4000, '\0'));
  EXPECT_EQ(ReadFlight(Part()).points().size(), ReadFlight(File()).points().size());
  // Under its own name a half line is a fault.
  WriteText(File(), text.substr(0, text.size() - 20));
  EXPECT_THROW((void)ReadFlight(File()), InputError);
}

TEST_F(FlightRecords, AFlightThatIsMissingIsLookedForInItsPart) {
  WriteText(Part(), "t_s,latitude,longitude,height_m,heading\n0,46.5,8,3000,350\n");
  try {
    (void)ReadFlight(File());
    ADD_FAILURE() << "there is no such file";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("f.csv.part"));
  }
}

TEST_F(FlightRecords, OfADiskThatIsFullTheFlightHearsAtItsEnd) {
  const pid_t child = fork();
  if (child == 0) {
    const rlimit limit{1000, 1000};  // bytes of a file
    setrlimit(RLIMIT_FSIZE, &limit);
    std::signal(SIGXFSZ, SIG_IGN);
    FlightRecorder recorder(File());
    Fly(recorder, 600);
    try {
      recorder.Finish();
    } catch (const OutputError&) {
      _exit(4);
    }
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 4);
  EXPECT_GT(ReadFlight(Part()).points().size(), 4U) << "what fitted";
  EXPECT_FALSE(fs::exists(File()));
}

}  // namespace
}  // namespace alpenglow::viewer
