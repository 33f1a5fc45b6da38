// SPDX-License-Identifier: MIT
// The program skyseries: exit statuses, files and messages.
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "atmosphere/base/text_file.h"
#include "atmosphere/time_place/time.h"
#include "lut/image/exr.h"
#include "lut/image/image.h"
#include "lut/image/png.h"
#include "tests/fixtures/bare_scene_folder.h"
#include "tests/fixtures/lost_messages.h"
#include "tests/fixtures/places.h"
#include "tests/fixtures/raster_file.h"
#include "tests/fixtures/sanitized.h"

namespace alpenglow::renderer {
namespace {

namespace fs = std::filesystem;
using testing::ContainsRegex;
using testing::HasSubstr;

class Skyseries : public BareSceneFolder {
 protected:
  [[nodiscard]] std::string SmallStill() const {
    return InFolder("s.toml") + " --size 16x9 --samples 1 --out " + InFolder("still.exr");
  }
  [[nodiscard]] Metadata Header(const char* name = "still.exr") const {
    return ReadExrMetadata(folder_ / name);
  }
  /// Expects that a command fails with a status and a message.
  void ExpectFault(const std::string& arguments, int status, const std::string& message) const {
    const Outcome outcome = Run(arguments);
    EXPECT_EQ(outcome.status, status) << arguments << "\n" << outcome.error;
    EXPECT_THAT(outcome.error, HasSubstr(message)) << arguments;
  }
  /// @param arguments  as typed into a shell.
  [[nodiscard]] Outcome Run(const std::string& arguments) const {
    return RunCommand(std::string("'") + tests::kSkyseries + "' " + arguments);
  }
  [[nodiscard]] pid_t Start(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), tests::kSkyseries);
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    const pid_t child = fork();
    if (child == 0) {
      execv(pointers[0], pointers.data());
      _exit(127);
    }
    return child;
  }
  [[nodiscard]] std::vector<std::string> SeriesArguments(const char* count = "40") const {
    const char* const size = tests::ScaledDown("64x36", "32x18");
    return {InFolder("s.toml"), "--size", size,
            "--samples",        "1",      "--from",
            "sunrise",          "--to",   "sunset",
            "--count",          count,    "--quiet",
            "--resume",         "--out",  InFolder("series/f.%04d.exr")};
  }
  /// Starts the series, and sends it a signal after its second frame.
  [[nodiscard]] int StatusAfterSignal(int signal) const {
    const pid_t child = Start(SeriesArguments());
    while (!fs::exists(folder_ / "series" / "f.0001.exr")) {
      usleep(1000);
      if (waitpid(child, nullptr, WNOHANG) != 0) return -2;  // it ended before the second frame
    }
    kill(child, signal);
    return ExitStatusOf(child);
  }
  /// Expects that all pictures in the folder of the series are whole, and returns their number.
  [[nodiscard]] int WholeFrames() const {
    int frames = 0;
    for (const auto& entry : fs::directory_iterator(folder_ / "series")) {
      if (entry.path().extension() != ".exr" || entry.path().filename().string()[0] == '.')
        continue;
      EXPECT_NO_THROW((void)ReadExr(entry.path()));
      ++frames;
    }
    return frames;
  }
};

TEST_F(Skyseries, ReportsPreparationAndProgressOfAFrame) {
  const Outcome outcome = Run(SmallStill() + " --progress json");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.error, HasSubstr("{\"label\":\"frames\",\"step\":\"air\","));
  EXPECT_THAT(outcome.error, HasSubstr("{\"label\":\"frames\",\"done\":0,\"part\":0."));
  EXPECT_THAT(outcome.error, HasSubstr("{\"label\":\"frames\",\"done\":1,\"total\":1,"));
}

TEST_F(Skyseries, HelpAndVersionArePrinted) {
  const Outcome outcome = Run("--help");
  EXPECT_EQ(outcome.status, 0);
  for (const char* option :
       {"--at",         "--from",          "--to",       "--every",    "--count",
        "--date",       "--zone",          "--frames",   "--out",      "--png",
        "--size",       "--samples",       "--aov",      "--filter",   "--path",
        "--shutter",    "--fps",           "--exposure", "--tone-map", "--look",
        "--resume",     "--contact-sheet", "--latitude", "--dem",      "--white-balance",
        "--atmosphere", "--threads",       "--quiet",    "--progress", "--version",
        "--clouds",     "--cloud-light",   "--metar",    "Example"})
    EXPECT_THAT(outcome.out, HasSubstr(option));
  const Outcome version = Run("--version");
  EXPECT_EQ(version.status, 0);
  EXPECT_THAT(version.out, HasSubstr("skyseries of alpenglow "));
}

TEST_F(Skyseries, OtherNamesOfOptionsAreAccepted) {
  const std::string list = "--list --latitude 46.5 --longitude 8 ";
  const Outcome still = Run(list + "--height 3000 --at noon");
  ASSERT_EQ(still.status, 0) << still.error;
  EXPECT_EQ(Run(list + "--altitude 3000 --time noon").out, still.out);
  WriteText(folder_ / "p.csv", "t_s,latitude,longitude,height_m\n0,46.5,8,900\n1,46.6,8,900\n");
  const Outcome path = Run("--list --count 2 --path " + InFolder("p.csv"));
  ASSERT_EQ(path.status, 0) << path.error;
  for (const char* name : {"--replay ", "--track "})
    EXPECT_EQ(Run(std::string("--list --count 2 ") + name + InFolder("p.csv")).out, path.out);
}

TEST_F(Skyseries, ListsNeedNoRendering) {
  const std::string list = InFolder("s.toml") + " --list --date 2026-06-21 ";
  EXPECT_THAT(Run(list + "--at 18:30").out, HasSubstr("\n0,2026-06-21T16:30:00Z,"));
  EXPECT_THAT(Run(list + "--at '2026-06-21 18:30'").out, HasSubstr("\n0,2026-06-21T16:30:00Z,"));
  EXPECT_THAT(Run(list + "--at 'tomorrow sunrise'").out, HasSubstr("\n0,"));
  EXPECT_THAT(Run(list + "--at now").out, HasSubstr("\n0,"));
  const std::string month = Run(list + "--from sunrise --to 2026-07-20 --every 1d").out;
  EXPECT_EQ(std::count(month.begin(), month.end(), '\n'), 31) << "a head, and each day";
  const auto files = fs::directory_iterator(InFolder("."));
  EXPECT_EQ(std::distance(begin(files), end(files)), 1) << "the scene alone";
}

TEST_F(Skyseries, TimesOfAPlaceAreATableACsvAndAPlot) {
  const std::string place = "times --latitude 46.5 --longitude 8 --zone Europe/Zurich ";
  const Outcome table = Run(place + "--date 2026-06-21 --days 2");
  EXPECT_EQ(table.status, 0) << table.error;
  EXPECT_THAT(table.out, HasSubstr("\n2026-06-22"));
  const Outcome plot = Run(place + "--date 2026-12-23 --minutes 360 --out " + InFolder("t.csv") +
                           " --plot " + InFolder("t.svg"));
  EXPECT_EQ(plot.status, 0) << plot.error;
  EXPECT_THAT(ReadTextFile(InFolder("t.csv")), HasSubstr("\n2026-12-23,"));
  EXPECT_THAT(ReadTextFile(InFolder("t.svg")), HasSubstr(">full moon, high, 0.25 to 0.32</text>"));
  EXPECT_EQ(Run(place + "--minutes 60").status, 2) << "of a plot";
}

/// Returns the field of a row (counted from 0) of a CSV text, by its name in the head.
std::string FieldOf(const std::string& csv, const std::string& name, int row = 0) {
  std::istringstream lines(csv);
  std::string head, line, column, field;
  std::getline(lines, head);
  for (int i = 0; i <= row; ++i) std::getline(lines, line);
  std::istringstream columns(head), fields(line);
  while (std::getline(columns, column, ',') && std::getline(fields, field, ',')) {
    if (column == name) return field;
  }
  return "no " + name;
}

struct PlacedDay {
  const char* options;
  std::vector<std::pair<const char*, const char*>> events;  // as typed, and its column of `times`
};

TEST_F(Skyseries, ListsAndTimesOfAPlaceAgreeToTheSecond) {
  const std::vector<PlacedDay> days = {
      {"--latitude 69.65 --longitude 18.96 --date 2026-05-10",
       {{"sunset", "sunset"}, {"sunrise", "sunrise"}, {"noon", "noon"}}},
      {"--latitude 46.5 --longitude 8 --zone Europe/Zurich --date 2026-06-21",
       {{"astronomical-dusk", "astronomical-dusk"}, {"moonset", "moonset"}}},
      {"--latitude -33.9 --longitude 179.99 --date 2026-01-05",
       {{"civil-dawn", "civil-dawn"}, {"moon-transit", "moon-transit"}}},
      {"--latitude 42.3439 --longitude -3.6969 --date 2026-08-12",
       {{"first-contact", "eclipse_first_contact"},
        {"second-contact", "eclipse_second_contact"},
        {"third-contact", "eclipse_third_contact"},
        {"sunset", "sunset"}}}};
  for (const PlacedDay& day : days) {
    const std::string csv = InFolder("times.csv");
    ASSERT_EQ(Run(std::string("times ") + day.options + " --out " + csv).status, 0);
    std::string at;
    for (const auto& [event, column] : day.events) at += std::string(" --at ") + event;
    const Outcome list = Run(std::string("--list ") + day.options + at);
    int row = 0;
    for (const auto& [event, column] : day.events) {
      EXPECT_EQ(FieldOf(list.out, "utc", row++), FieldOf(ContentOf(csv), column))
          << day.options << " " << event;
    }
  }
}

TEST_F(Skyseries, AStillIsASeriesOfOne) {
  const Outcome outcome = Run(SmallStill() + " --png --aov depth,normal");
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  const HdrImage image = ReadExr(folder_ / "still.exr");
  EXPECT_EQ(image.width, 16);
  EXPECT_EQ(image.layers.size(), 4U) << "depth and three of the normal";
  EXPECT_EQ(ReadPng(folder_ / "still.png").height, 9);
  EXPECT_EQ(Header().at("alpenglow.utc"), "2026-06-21T10:00:00.000Z");
  EXPECT_EQ(FileCount(), 5U) << "scene, EXR, PNG, manifest, and the same as JSON";
  EXPECT_EQ(outcome.out, "") << "standard output is for results only";
}

// The eclipse of 2026 August 12 at Burgos is partial, total, then over.
TEST_F(Skyseries, FilesOfAnEclipseHaveTheCoveredShare) {
  WriteText(folder_ / "burgos.toml",
            "[place]\nlatitude = 42.3439\nlongitude = -3.6969\n[terrain]\nnone = true\n");
  const std::string command =
      InFolder("burgos.toml") + " --size 16x9 --samples 1 --quiet --out " + InFolder("e.%d.exr") +
      " --date 2026-08-12 --at 2026-08-12T18:10:00Z --at second-contact+52s --at "
      "2026-08-12T20:00:00Z";
  const Outcome outcome = Run(command);
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.error, HasSubstr("warning: 1 of 3 frames stand in the totality"));
  EXPECT_NEAR(std::stod(Header("e.0.exr").at("alpenglow.sun_covered")), 0.605, 0.01);
  EXPECT_EQ(Header("e.1.exr").at("alpenglow.sun_covered"), "1.000000");
  EXPECT_EQ(Header("e.2.exr").count("alpenglow.sun_covered"), 0U);
  const std::string manifest = ContentOf(folder_ / "e.manifest.csv");
  EXPECT_THAT(manifest, HasSubstr("sun_elevation_deg,sun_covered,moon_azimuth_deg"));
  EXPECT_THAT(manifest, HasSubstr(",1.000000,"));
  EXPECT_THAT(ContentOf(folder_ / "e.manifest.json"), HasSubstr("\"sun_covered\":1.000000"));
  EXPECT_THAT(Run("--list " + command).out, HasSubstr(",1.0000,"));
  EXPECT_THAT(Run("--list --latitude 42.3439 --longitude -3.6969 --atmosphere mars --at "
                  "2026-08-12T18:29:00Z")
                  .out,
              HasSubstr(",0.0000,"))
      << "the earth's moon covers no sun of another planet";
  const std::string times = InFolder("times.csv");
  ASSERT_EQ(
      Run("times --latitude 42.3439 --longitude -3.6969 --date 2026-08-12 --out " + times).status,
      0);
  const UtcTime total = ParseInstant(FieldOf(ContentOf(times), "eclipse_second_contact"));
  const UtcTime taken = ParseInstant(Header("e.1.exr").at("alpenglow.utc"));
  EXPECT_NEAR(SecondsBetween(total, taken), 52.0, 1.0);
}

TEST_F(Skyseries, IncidentLightIsMeteredBehindThePolariser) {
  WriteText(folder_ / "p.toml", std::string(kBareSceneText) + "[camera]\npolariser_deg = 30.0\n");
  const auto metadata = [&](const char* scene) {
    const Outcome outcome = Run(InFolder(scene) + " --size 16x9 --samples 1 --quiet --png " +
                                "--exposure incident --out " + InFolder("i.exr"));
    EXPECT_EQ(outcome.status, 0) << outcome.error;
    return Header("i.exr");
  };
  const Metadata bare = metadata("s.toml"), through = metadata("p.toml");
  EXPECT_NEAR(std::stod(bare.at("alpenglow.ev100")) - std::stod(through.at("alpenglow.ev100")), 1.0,
              1e-3)
      << "light that is not polarised loses a stop";
  EXPECT_EQ(bare.count("alpenglow.polariser_deg"), 0U);
  EXPECT_NEAR(std::stod(through.at("alpenglow.polariser_deg")), 30.0, 1e-6);
}

TEST_F(Skyseries, PicturesHaveALimitOfNoiseOrEqualRays) {
  const std::string scene = InFolder("s.toml") + " --size 16x9 --quiet --out ";
  ASSERT_EQ(Run(scene + InFolder("held.exr")).status, 0);
  ASSERT_EQ(Run(scene + InFolder("even.exr") + " --samples 3").status, 0);
  const Metadata held = Header("held.exr");
  EXPECT_EQ(held.at("alpenglow.noise"), "0.02");
  EXPECT_THAT(held.at("alpenglow.note.rays"), HasSubstr(" a pixel, 2 to "));
  const Metadata even = Header("even.exr");
  EXPECT_EQ(even.count("alpenglow.noise"), 0U);
  EXPECT_EQ(even.at("alpenglow.note.rays"), "3.000 a pixel, 3 to 3");
}

TEST_F(Skyseries, AWrongCommandLineExitsWith2) {
  for (const std::string& arguments :
       {std::string("--nonsense"), std::string(), InFolder("s.toml")})
    EXPECT_EQ(Run(arguments).status, 2) << arguments;
  // Noise cannot be limited with a single ray.
  std::istringstream wrong(
      "--size 0x5;--size 5;--exposure bright;--exposure nan;--tone-map filmic;--look golden;"
      "--white-balance warm;--aov smell;--samples 0;--samples 1025;--noise 0;--noise 2%;"
      "--glare lens;--filter lanczos;--cloud-light slow;--threads -1;--effects bloom;--effects "
      "auto,sky;"
      "--effects auto --no-shafts;--effects all --max-error 1%;--max-error 0;--max-error 1%%;"
      "--max-error 101%;--from sunrise;--progress loud;--at noon --from sunrise --to sunset;"
      "--from sunrise --to sunset --every 1h --count 3;--keogram k.jpg;--plot p.png;"
      "--contact-sheet sheet.jpg;--fps 5;--track-speed 5;--latitude 3;--clouds fog;"
      "--clouds 'cumulus 0.9';--clouds 'none, fair';--metar LSZH;--metar 'LSZH 211350Z 22/12 9999';"
      "--station-height 400;--metar 'LSZH 211350Z CAVOK' --station-height 9000");
  int number = 0;  // Each command line starts a program. The sanitizers run every fourth.
  for (std::string options; std::getline(wrong, options, ';'); ++number) {
    if (number % tests::ScaledDown(1, 4) != 0) continue;
    const Outcome outcome = Run(SmallStill() + " " + options);
    EXPECT_EQ(outcome.status, 2) << options << "\n" << outcome.error;
  }
  EXPECT_EQ(FileCount(), 1U) << "only the scene";
  ExpectFault(
      "--list --at noon --latitude 46,5", 2,
      "--latitude is \"46,5\"; it must be a number with a decimal point: Degrees north, -90 "
      "to 90");
  ExpectFault("--list --at noon --latitude 46.5N", 2, "it must be a number: Degrees north");
}

TEST_F(Skyseries, UnknownWordsNameTheNearestKnown) {
  const std::vector<std::pair<std::string, const char*>> cases = {
      {"-o x.exr", "unknown option -o; did you mean --out?"},
      {InFolder("s.toml") + " --outt=x.exr", "unknown option --outt; did you mean --out?"},
      {"help", "unknown command help; did you mean --help?"},
      {"time --latitude 3 --longitude 4", "unknown command time; did you mean times?"},
      {"times --latitude 3 --longitude 4 --dates today", "did you mean --date?"}};
  for (const auto& [arguments, message] : cases) ExpectFault(arguments, 2, message);
}

TEST_F(Skyseries, CloudsOfTheOptionReplaceThoseOfTheScene) {
  WriteText(folder_ / "cloudy.toml",
            std::string(kBareSceneText) + "[[cloud]]\ngenus = \"cirrus\"\nperiod_m = 2560\n");
  const std::string still = " --size 16x9 --samples 1 --out " + InFolder("still.exr");
  ASSERT_EQ(Run(InFolder("cloudy.toml") + still + " --aov clouds").status, 0)
      << "rays to the ground meet no cloud, and their distance is infinite";
  ASSERT_EQ(Run(InFolder("cloudy.toml") + still + " --clouds none").status, 0);
  EXPECT_EQ(Header().count("alpenglow.cloud_0"), 0U);
  EXPECT_THAT(Run(InFolder("s.toml") + still + " --resume").error, HasSubstr("1 kept"))
      << "without clouds it is the same picture";
  ExpectFault(SmallStill() + " --clouds 'cumulos 0.3'", 2, "did you mean cumulus?");
  EXPECT_EQ(Run("--list --at noon --clouds 'cumulus 0.3, cirrus 0.5'").status, 0);
}

TEST_F(Skyseries, AReportMakesTheWeatherOfTheScene) {
  WriteText(folder_ / "cloudy.toml",
            std::string(kBareSceneText) + "[[cloud]]\ngenus = \"cirrus\"\nperiod_m = 2560\n");
  const std::string still = " --size 16x9 --samples 1 --out " + InFolder("still.exr");
  const std::string clear = " --metar 'LSZH 211350Z 24008G20KT 8000 -RA NSC 22/12 Q1018 NOSIG'";
  const Outcome outcome = Run(InFolder("cloudy.toml") + still + clear);
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_THAT(outcome.error, HasSubstr("skyseries: warning: --metar: not modelled: G20KT (gusts), "
                                       "-RA (light: rain), NOSIG (trend)\n"));
  EXPECT_EQ(Header().count("alpenglow.cloud_0"), 0U) << "NSC replaces the clouds of the scene";
  EXPECT_EQ(Header().at("alpenglow.metar"),
            "LSZH 211350Z 24008G20KT 8000 -RA NSC 22/12 Q1018 NOSIG");
  EXPECT_EQ(Header().at("alpenglow.atmosphere"), "custom (from bruneton2017)");
  ExpectFault(SmallStill() + " --metar 'LSZH 211350Z 24O08KT'", 2,
              "--metar: group \"24O08KT\": a wind is");
}

TEST_F(Skyseries, TheTimeOfAReportIsThatOfThePictureUnlessOneIsGiven) {
  const std::string list = "--list --metar 'LSZH 191350Z CAVOK'";
  EXPECT_THAT(Run(list).out, HasSubstr("\n0,2026-06-19T13:50:00Z,2026-06-19T15:50:00+02:00,"))
      << "in the zone of the station";
  EXPECT_THAT(Run(list + " --at 2026-01-05T10:00Z").out, HasSubstr("\n0,2026-01-05T10:00:00Z,"));
  EXPECT_THAT(Run(list + " --at 09:00Z").out, HasSubstr("\n0,2026-06-19T09:00:00Z,"));
}

TEST_F(Skyseries, TracedPicturesAreKeptApartFromOthers) {
  const std::string still = SmallStill() + " --resume";
  ASSERT_EQ(Run(still).status, 0);
  const Outcome traced = Run(still + " --paths 2");
  ASSERT_EQ(traced.status, 0) << traced.error;
  EXPECT_THAT(traced.error, HasSubstr("1 rendered"));
  EXPECT_THAT(traced.error, HasSubstr("the mean standard error of pixels is"));
  EXPECT_EQ(Header().at("alpenglow.paths"), "2");
  EXPECT_EQ(Header().count("alpenglow.note.path_error"), 1U);
  EXPECT_THAT(Run(still + " --paths 2").error, HasSubstr("1 kept"));
  EXPECT_THAT(Run(still + " --paths 3").error, HasSubstr("1 rendered"));
  EXPECT_THAT(Run(still).error, HasSubstr("1 rendered"));
}

TEST_F(Skyseries, ScenesThatPathsDoNotTraceAreRefused) {
  WriteText(folder_ / "fog.toml",
            std::string(kBareSceneText) + "[fog]\nvisibility_m = 500\nscale_height_m = 100\n");
  const std::string still = " --size 16x9 --out " + InFolder("still.exr");
  ExpectFault(InFolder("fog.toml") + still + " --paths 2", 3, "--paths does not trace fog (fog)");
  EXPECT_FALSE(fs::exists(folder_ / "still.exr"));
  ExpectFault(InFolder("s.toml") + still + " --paths 2 --noise 1%", 2, "--noise");
  ExpectFault(InFolder("s.toml") + still + " --paths 2 --effects auto", 2, "--effects");
  ExpectFault(InFolder("s.toml") + still + " --paths 2 --aov stokes_q", 2, "polarised");
}

TEST_F(Skyseries, AnOptionOfAnotherCommandNamesThatCommand) {
  ExpectFault("times --latitude 3 --longitude 4 --samples 4", 2,
              "--samples is an option of skyseries, not of this command");
  ExpectFault("report --days 3 --out r", 2,
              "--days is an option of skyseries times, not of this command");
  const Outcome times = Run("times --place Zurich --date 2026-06-21 --days 2");
  ASSERT_EQ(times.status, 0) << times.error;
  EXPECT_THAT(times.out, HasSubstr("Europe/Zur"));
  EXPECT_EQ(Run("times --place Zurich --latitude 3 --longitude 4").status, 2);
  ExpectFault("times --place Nowhereville", 3, "there is no place \"Nowhereville\"");
}

TEST_F(Skyseries, AnOutputWithAWrongNameIsAWrongCommandLine) {
  const std::string scene = InFolder("s.toml") + " --size 16x9 --samples 1 ";
  ExpectFault(scene + "--out " + InFolder("f.%s.exr"), 2, "frame number is written");
  ExpectFault(scene + "--out " + InFolder("f.png"), 2, "must end in .exr");
  ExpectFault(SmallStill() + " --video " + InFolder("f.gif"), 2, "must end in .mp4");
}

TEST_F(Skyseries, TwoOutputsOfOneNameAreRefused) {
  fs::create_directory(folder_ / "d");
  fs::create_symlink(folder_ / "still.png", folder_ / "d" / "link.png");
  const std::string frames = InFolder("s.toml") +
                             " --size 16x9 --samples 1 --png --from noon --to noon+20m --every 10m"
                             " --out " +
                             InFolder("f.%02d.exr");
  for (const std::string& arguments :
       {SmallStill() + " --png --contact-sheet " + InFolder("still.png"),
        SmallStill() + " --png --keogram " + InFolder("d/../still.png"),
        SmallStill() + " --png --keogram " + InFolder("d/link.png"),
        SmallStill() + " --contact-sheet " + InFolder("k.png") + " --keogram " + InFolder("k.png"),
        frames + " --keogram " + InFolder("f.01.png"),
        "times " + InFolder("s.toml") + " --out " + InFolder("t.csv") + " --plot " +
            InFolder("p.svg") + " --date 1850-01-01"}) {
    const Outcome outcome = Run(arguments);
    EXPECT_EQ(outcome.status, arguments.starts_with("times") ? 3 : 2) << outcome.error;
    EXPECT_THAT(outcome.error, HasSubstr(outcome.status == 2 ? "are the same file" : "1900"));
  }
  EXPECT_EQ(FileCount(), 2U) << "only the scene and the folder";
}

// A signal between two days, and a reader who has seen enough.
TEST_F(Skyseries, TimesStopAtASignalOrABrokenPipe) {
  const std::string times = std::string("'") + tests::kSkyseries +
                            "' times --latitude 46.5 --longitude 8 --date 2026-01-01 --days 3660";
  const Outcome signalled =
      RunCommand("bash -c \"" + times +
                 " > all.txt & p=\\$!; while [ ! -s all.txt ]; do sleep 0.01; "
                 "done; kill -TERM \\$p; wait \\$p\"");
  EXPECT_EQ(signalled.status, 143) << signalled.error;
  const Outcome head = RunCommand("bash -c \"" + times + " | head -1; exit \\${PIPESTATUS[0]}\"");
  EXPECT_EQ(head.status, 4);
  EXPECT_EQ(head.error, "");
  EXPECT_THAT(head.out, HasSubstr("naut."));
}

TEST_F(Skyseries, FileTypesOfOutputsIgnoreCase) {
  const Outcome outcome =
      Run(InFolder("s.toml") + " --list --at noon --plot P.SVG --keogram K.PNG" +
          " --contact-sheet C.Png --out F.EXR");
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_THAT(outcome.out, HasSubstr("F.EXR"));
}

TEST_F(Skyseries, FileTypesOfTracksIgnoreCase) {
  WriteText(folder_ / "UP.GPX",
            "<gpx><trk><trkseg>"
            "<trkpt lat='46.5' lon='8'><time>2026-06-21T10:00:00Z</time></trkpt>"
            "<trkpt lat='46.5' lon='8.1'><ele>4100</ele><time>2026-06-21T10:01:00Z</time></trkpt>"
            "<trkpt lat='46.5' lon='8.2'><ele>4200</ele><time>2026-06-21T10:02:00Z</time></trkpt>"
            "</trkseg></trk></gpx>");
  const Outcome list = Run(InFolder("s.toml") + " --list --count 3 --path " + InFolder("UP.GPX"));
  EXPECT_EQ(list.status, 0) << list.error;
  EXPECT_THAT(list.out, HasSubstr("\n0,2026-06-21T10:00:00Z,"));
  EXPECT_THAT(list.error, HasSubstr("UP.GPX: 1 of 3 points have no height"));
  EXPECT_EQ(std::count(list.error.begin(), list.error.end(), '\n'), 1) << list.error;
}

TEST_F(Skyseries, ABadInputExitsWith3AndOneLine) {
  WriteText(folder_ / "bad.toml", "[place]\nlatitude = 91\nlongitude = 0\n");
  WriteText(folder_ / "polar.toml",
            "[place]\nlatitude = 78\nlongitude = 16\n[time]\nutc = \"2026-06-21T10:00:00Z\"\n"
            "[terrain]\nnone = true\n");
  WriteText(folder_ / "lamp.toml", std::string(kBareSceneText) +
                                       "[[light]]\nlatitude = 46.51\nlongitude = 8.0\n"
                                       "ies = \"none.ies\"\n");
  const std::string out = " --out " + InFolder("still.exr");
  const std::string still = SmallStill();
  const std::vector<std::pair<std::string, std::string>> cases = {
      {InFolder("missing.toml") + out, "missing.toml: cannot be read"},
      {InFolder("bad.toml") + out, "bad.toml:2: place.latitude is 91"},
      {InFolder("polar.toml") + out + " --at sunrise", "there is no sunrise"},
      {still + " --at sunrize", "did you mean sunrise?"},
      {still + " --at 2024-02-30T00:00:00Z", "2024-02-30"},
      {still + " --frames 5", "the series has 0 to 0"},
      {still + " --from sunrise --to sunset --count 3", "no frame number"},
      {InFolder("lamp.toml") + out, "none.ies"},
      {"--list --at noon --atmosphere hzay", "neither a file nor a preset; did you mean hazy?"},
      {"--latitude 91" + out, "latitude is 91"},
      {"--dem " + InFolder("missing.hgt") + out, "missing.hgt"},
      {"--fov 200 --dem x.hgt" + out, "--fov is 200"},
      {"--atmosphere " + InFolder("missing.toml") + " --dem x.hgt" + out, "missing.toml"},
  };
  for (const auto& [arguments, message] : cases) {
    const Outcome outcome = Run(arguments);
    EXPECT_EQ(outcome.status, 3) << arguments << "\n" << outcome.error;
    EXPECT_THAT(outcome.error, HasSubstr(message)) << arguments;
    EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
  }
  EXPECT_FALSE(fs::exists(folder_ / "still.exr"));
}

TEST_F(Skyseries, FilesOfOtherFormatsAreNamedWithoutTheirBytes) {
  using namespace std::string_view_literals;
  WriteText(folder_ / "flight.kmz", std::string("PK\x03\x04\x14\0doc.kml"sv));
  WriteText(folder_ / "escape.csv", "\x1B[31mred\x1B]0;title\x07,latitude\n0,1\n");
  WriteText(folder_ / "scene.png", "\x89PNG\r\n\x1A\n");
  const std::pair<std::string, const char*> cases[] = {
      {"s.toml --list --path flight.kmz", "flight.kmz: this is a zip archive"},
      {"s.toml --list --path escape.csv", R"(escape.csv:1: column "\x1b[31mred\x1b]0;title\x07")"},
      {"scene.png --list", "scene.png: this is a PNG picture; text is read"},
      {"--list --at noon --atmosphere \"$(printf '\\033[31m.toml')\"", R"(\x1b[31m.toml)"}};
  for (const auto& [arguments, message] : cases) {
    const Outcome outcome = Run(arguments);
    EXPECT_EQ(outcome.status, 3) << arguments;
    EXPECT_THAT(outcome.error, HasSubstr(message));
    const auto is_control = [](char c) { return c != '\n' && c >= '\0' && c < ' '; };
    EXPECT_EQ(std::count_if(outcome.error.begin(), outcome.error.end(), is_control), 0);
  }
}

TEST_F(Skyseries, APathMayHaveQuotesAndASceneComeThroughAPipe) {
  WriteText(folder_ / "path.csv",
            "\xEF\xBB\xBF\"t_s\";\"latitude\";\"longitude\";\"height_m\";\"utc\"\r\n"
            "\"0\";\"46.5\";\"8\";\"+3000\";\"2026-06-21T10:00:00Z\"\r\n"
            "\"10\";\"46.51\";\"8.01\";\"3000\";\"2026-06-21T10:00:10Z\"\r\n");
  const Outcome list = Run("s.toml --list --count 2 --path path.csv");
  EXPECT_EQ(list.status, 0) << list.error;
  EXPECT_THAT(list.out, HasSubstr("\n0,2026-06-21T10:00:00Z,"));
  const Outcome piped = RunCommand(std::string("mkfifo pipe && (cat s.toml >pipe &) && '") +
                                   tests::kSkyseries + "' pipe --list --count 2 --path path.csv");
  EXPECT_EQ(piped.status, 0) << piped.error;
  EXPECT_EQ(piped.out, list.out);
}

TEST_F(Skyseries, AMissingDatabaseOfProjIsNamed) {
  tests::Raster map;
  map.epsg = 2056;  // Switzerland, in metres
  map.geotransform = {2600000.0, 100.0, 0.0, 1200000.0, 0.0, -100.0};
  tests::WriteRaster(folder_, map);
  const Outcome outcome = RunCommand(
      std::string("PROJ_LIB=/none PROJ_DATA=/none '") + tests::kSkyseries +
      "' --dem dem.tif --latitude 46.95 --longitude 7.45 --at 2026-06-21T10:00:00Z --size 8x4 "
      "--out still.exr");
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.error, HasSubstr("dem.tif: PROJ finds no usable proj.db (PROJ_DATA=/none, "
                                       "PROJ_LIB=/none): "));
}

// Hard case 46.
TEST_F(Skyseries, AnOutputThatCannotBeWrittenExitsWith4) {
  WriteText(folder_ / "file", "in the way");
  ExpectFault(InFolder("s.toml") + " --size 16x9 --out " + InFolder("file/a.exr"), 4,
              (folder_ / "file").string());
}

TEST_F(Skyseries, ALensIsInTheHeader) {
  WriteText(folder_ / "s.toml",
            ContentOf(folder_ / "s.toml") +
                "[camera]\nf_number = 2.8\nfocal_length_mm = 50\nfocus_m = 9\nblades = 6\n");
  const Outcome outcome = Run(SmallStill());
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_THAT(Header().at("alpenglow.lens"), HasSubstr("f/2.8, 0.05 m, focus 9 m, 6 blades"));
}

TEST_F(Skyseries, FramesOfAPathAreKeptUntilItChanges) {
  const std::string header = "t_s,latitude,longitude,height_m,heading\n";
  const std::string begin = "0,46.5,8.0,1000,350\n";
  WriteText(folder_ / "p.csv", header + begin + "4,46.51,8.0,1200,10\n");
  const std::string command = InFolder("s.toml") + " --path " + InFolder("p.csv") +
                              " --size 16x9 --samples 2 --resume --every 2s --shutter 0.5 --out " +
                              InFolder("f.%d.exr");
  const Outcome outcome = Run(command);
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_THAT(outcome.error, HasSubstr("3 rendered"));
  EXPECT_THAT(ContentOf(folder_ / "f.manifest.csv"),
              AllOf(HasSubstr(",exposure,t_s,latitude,longitude,height_m,heading,pitch,roll,fov\n"),
                    HasSubstr(",2.000000,46.50"), HasSubstr("2026-06-21T10:00:04Z")))
      << "the scene's time runs along the path";
  const Metadata metadata = Header("f.2.exr");
  EXPECT_EQ(metadata.at("alpenglow.path_s"), "4");
  EXPECT_THAT(metadata.at("alpenglow.camera_height"), HasSubstr("1200 m"));
  EXPECT_THAT(Run(command).error, HasSubstr("0 rendered, 0 developed again, 3 kept"));
  WriteText(folder_ / "p.csv", header + begin + "4,46.51,8.0,1210,10\n");
  EXPECT_THAT(Run(command).error, HasSubstr("3 rendered"));
  EXPECT_EQ(Run(command + " --from sunrise --to sunset").status, 2);
  EXPECT_EQ(Run(command + " --fps 5").status, 2) << "--every says the same";
  WriteText(folder_ / "p.csv", header + "0,46.5,8.0,1000,350\n0,46.51,8.0,1200,10\n");
  ExpectFault(command, 3, "p.csv:3: t_s is 0; it must grow");
}

TEST_F(Skyseries, APathThatLeavesTheSceneIsRefusedByFileAndPoint) {
  const std::string command = InFolder("s.toml") + " --path " + InFolder("p.csv") +
                              " --size 16x9 --every 2s --effects sky --out " + InFolder("f.%d.exr");
  const std::string begin = "t_s,latitude,longitude,height_m,heading\n0,46.5,8.0,1000,350\n";
  for (const auto& [point, fault] :
       {std::pair{"2,46.5,8.0,-200,350\n", "-200.0 m high; the ground there is at 0 m"},
        {"2,52.5,8.0,1000,350\n", "km from the scene's place; at most 500 km"}}) {
    WriteText(folder_ / "p.csv", begin + point + "4,46.5,8.0,1000,350\n");
    const Outcome outcome = Run(command);
    EXPECT_EQ(outcome.status, 3);
    EXPECT_THAT(outcome.error, AllOf(HasSubstr("p.csv: point 2: the eye at"), HasSubstr(fault)));
    EXPECT_EQ(FileCount(), 2U) << "the scene and the path: no manifest, no picture";
  }
}

TEST_F(Skyseries, TracksOfGpxAreFlown) {
  WriteText(folder_ / "t.gpx",
            "<gpx><trk><trkseg>"
            "<trkpt lat='46.5' lon='8.0'><ele>1000</ele><time>2026-06-21T10:00:00Z</time></trkpt>"
            "<trkpt lat='46.51' lon='8.0'><ele>1100</ele><time>2026-06-21T10:00:20Z</time></trkpt>"
            "</trkseg></trk></gpx>");
  const std::string command = InFolder("s.toml") + " --path " + InFolder("t.gpx") +
                              " --size 16x9 --samples 2 --every 10s --out " + InFolder("t.%d.exr");
  const Outcome outcome = Run(command + " --keogram " + InFolder("k.png"));
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_THAT(ContentOf(folder_ / "t.manifest.csv"),
              AllOf(HasSubstr("1,t.1.exr,2026-06-21T10:00:10Z"), HasSubstr(",46.505")));
  EXPECT_EQ(ReadPng(folder_ / "k.png").width, 3 * 32) << "columns of a frame";
  EXPECT_THAT(ContentOf(folder_ / "t.manifest.json"), HasSubstr("\"illuminance_lx\":1"))
      << "a hundred thousand lux at noon";
  WriteText(folder_ / "t.gpx", "<gpx>\n</gpx>");
  ExpectFault(command, 3, "t.gpx:1: there is no trkpt, rtept or wpt in it");
}

TEST_F(Skyseries, OmittedEffectsAreExplainedAndNotedInTheFile) {
  const Outcome outcome = Run(SmallStill() + " --effects auto --max-error 2% --explain");
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_THAT(outcome.out, HasSubstr("2026-06-21T10:00:00Z"));
  EXPECT_THAT(outcome.out, ContainsRegex("\nsky .* kept\n"));
  EXPECT_THAT(outcome.out, ContainsRegex("\nshafts .* not in this scene\n"));
  EXPECT_THAT(outcome.out, ContainsRegex("\nozone .* kept, free\n"));
  EXPECT_THAT(outcome.out, HasSubstr("budget 2.0 % rms"));
  const Metadata metadata = Header();
  EXPECT_EQ(metadata.at("alpenglow.effects"), "all within 0.02");
  EXPECT_THAT(metadata.at("alpenglow.note.effects_left_out"), HasSubstr("aerial"))
      << "the ground is out of sight";
  EXPECT_THAT(metadata.at("alpenglow.note.effects_change"), HasSubstr("rms"));
}

// Hard case 48.
TEST_F(Skyseries, AnotherBudgetOfEffectsIsRenderedAgain) {
  const std::string still = SmallStill() + " --resume";
  ASSERT_EQ(Run(still + " --effects all").status, 0);
  EXPECT_THAT(Run(still).error, HasSubstr("0 rendered, 0 developed again, 1 kept")) << "all is all";
  EXPECT_THAT(Run(still + " --effects auto").error, HasSubstr("1 rendered"));
  const Metadata made = Header();
  EXPECT_THAT(Run(still + " --max-error 1%").error, HasSubstr("1 kept"));
  EXPECT_THAT(Run(still + " --effects auto --exposure 12").error, HasSubstr("1 developed again"));
  EXPECT_EQ(Header().at("alpenglow.note.effects_left_out"),
            made.at("alpenglow.note.effects_left_out"))
      << "what was found out when the picture was made is kept with its pixels";
  EXPECT_THAT(Run(still + " --max-error 2%").error, HasSubstr("1 rendered"));
  EXPECT_THAT(Run(still + " --effects=-skylight").error, HasSubstr("1 rendered"));
}

// Hard case 43.
TEST_F(Skyseries, ThreadsAndExplanationsDoNotChangePixels) {
  ASSERT_EQ(Run(SmallStill() + " --threads 1").status, 0);
  const HdrImage one = ReadExr(folder_ / "still.exr");
  ASSERT_EQ(Run(SmallStill() + " --threads 7").status, 0);
  EXPECT_EQ(ReadExr(folder_ / "still.exr").rgb, one.rgb);
  const Outcome explained = Run(SmallStill() + " --explain");
  ASSERT_EQ(explained.status, 0) << explained.error;
  EXPECT_THAT(explained.out, ContainsRegex("\nsky .* kept\n"));
  EXPECT_EQ(ReadExr(folder_ / "still.exr").rgb, one.rgb);
}

// Hard case 45.
TEST_F(Skyseries, SignalsLeaveWholeFramesAndTheNextRunResumes) {
  const auto no_temporaries = [&] {
    for (const auto& entry : fs::directory_iterator(folder_ / "series")) {
      if (entry.path().filename().string()[0] == '.') return false;
    }
    return true;
  };
  for (const auto& [signal, status] : {std::pair{SIGTERM, 143}, {SIGKILL, -1}}) {
    fs::remove_all(folder_ / "series");
    EXPECT_EQ(StatusAfterSignal(signal), status);
    EXPECT_LT(WholeFrames(), 40) << "the signal came too late";
    EXPECT_TRUE(signal == SIGKILL || no_temporaries());
    const fs::path first = folder_ / "series" / "f.0000.exr";
    const fs::file_time_type written = fs::last_write_time(first);
    std::vector<std::string> some = SeriesArguments();
    some.insert(some.end(), {"--frames", tests::ScaledDown("0-9", "0-3")});
    EXPECT_EQ(ExitStatusOf(Start(some)), 0);
    EXPECT_GE(WholeFrames(), tests::ScaledDown(10, 4));
    EXPECT_EQ(fs::last_write_time(first), written) << "finished frames are kept";
  }
}

TEST_F(Skyseries, LostMessagesLoseNoFrame) {
  using tests::Lost;
  const std::vector<Lost> all{Lost::kFull, Lost::kClosed, Lost::kPipe, Lost::kTerminal};
  for (const Lost how : tests::ScaledDown(all, {Lost::kPipe, Lost::kTerminal})) {
    fs::remove_all(folder_ / "series");
    const std::optional<int> status = tests::StatusWithLostMessages(
        {tests::kSkyseries, InFolder("s.toml"), "--size", "16x9", "--samples", "1", "--from",
         "sunrise", "--to", "sunset", "--count", "3", "--progress", "plain", "--out",
         InFolder("series/f.%d.exr")},
        how);
    if (!status) continue;  // no such thing here (a system without terminals)
    EXPECT_EQ(*status, 0) << static_cast<int>(how);
    for (int frame = 0; frame < 3; ++frame) {
      EXPECT_NO_THROW((void)ReadExr(folder_ / "series" / fmt::format("f.{}.exr", frame)))
          << static_cast<int>(how);
    }
    EXPECT_THAT(ContentOf(folder_ / "series" / "f.manifest.csv"),
                testing::StartsWith("frame,file,utc"))
        << "no message went into an output";
  }
}

// Hard case 45.
TEST_F(Skyseries, ResumingRemovesFilesOfAKilledRun) {
  fs::create_directory(folder_ / "series");
  tests::LeaveTemporaryOf(folder_ / "series" / "f.0.exr");
  const std::string series = InFolder("s.toml") + " --size 16x9 --samples 1 --at noon --out " +
                             InFolder("series/f.%d.exr");
  const auto files = [&] {
    return std::distance(fs::directory_iterator(folder_ / "series"), fs::directory_iterator());
  };
  ASSERT_EQ(Run(series).status, 0);
  EXPECT_EQ(files(), 4) << "picture, two manifests, and what was left: another run may look at it";
  const Outcome resumed = Run(series + " --resume");
  EXPECT_EQ(resumed.status, 0);
  EXPECT_THAT(resumed.error, HasSubstr("removed 1 unfinished"));
  EXPECT_EQ(files(), 3);
}

TEST_F(Skyseries, AnInputIsNeverOverwritten) {
  WriteText(folder_ / "colour.png", "a picture");
  WriteText(folder_ / "x.hgt", "an elevation model");
  WriteText(folder_ / "s.toml",
            "[place]\nlatitude = 46.5\nlongitude = 8.0\n[time]\nutc = \"2026-06-21T10:00:00Z\"\n"
            "[terrain]\ndem = \"x.hgt\"\ncolour = \"colour.png\"\n");
  fs::create_symlink("s.toml", folder_ / "scene.exr");
  for (const std::string& arguments :
       {InFolder("scene.exr") + " --out " + InFolder("scene.exr"),
        InFolder("s.toml") + " --png --out " + InFolder("colour.exr"),
        InFolder("s.toml") + " --out " + InFolder("a.exr") + " --contact-sheet " +
            InFolder("colour.png")})
    ExpectFault(arguments, 3, "an input is not overwritten");
  EXPECT_EQ(ContentOf(folder_ / "colour.png"), "a picture");
}

// Hard case 47.
TEST_F(Skyseries, TwoProcessesOnTheSameFramesBothSucceed) {
  const pid_t one = Start(SeriesArguments("5")), other = Start(SeriesArguments("5"));
  EXPECT_EQ(ExitStatusOf(one), 0);
  EXPECT_EQ(ExitStatusOf(other), 0);
  EXPECT_EQ(WholeFrames(), 5);
}

TEST_F(Skyseries, AnAtmosphereOfTooManyWavelengthsIsRefusedWithFileAndLine) {
  std::string fine = "preset = \"earth\"\n[spectrum]\nwavelengths_nm = [380";
  for (int wavelength_nm = 390; wavelength_nm <= 800; wavelength_nm += 10)
    fine += ", " + std::to_string(wavelength_nm);
  WriteText(folder_ / "air.toml", fine + "]\n");
  WriteText(folder_ / "scene.toml",
            "[place]\nlatitude = 46.5\nlongitude = 8.0\n[time]\nutc = \"2026-06-21T12:00:00Z\"\n"
            "[terrain]\nnone = true\n[atmosphere]\nfile = \"air.toml\"\n");
  for (const std::string& scene :
       {InFolder("scene.toml"), "--atmosphere " + InFolder("air.toml")}) {
    const Outcome refused = Run(scene + " --size 8x4 --quiet --out " + InFolder("x.exr"));
    EXPECT_EQ(refused.status, 3) << scene;
    EXPECT_THAT(refused.error, HasSubstr("air.toml:3: spectrum.wavelengths_nm has 43 values; it "
                                         "must have 1 to 40 for pictures"));
  }
}

}  // namespace
}  // namespace alpenglow::renderer
