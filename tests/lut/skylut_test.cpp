// SPDX-License-Identifier: MIT
// Tests what the program prints, writes and returns when users run it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <vector>

#include "lut/table_io/table_file.h"
#include "tests/fixtures/lost_messages.h"
#include "tests/fixtures/places.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::lut {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

class Skylut : public TemporaryFolder {
 protected:
  /// Runs `skylut <arguments>` in the folder of the test.
  [[nodiscard]] Outcome Run(const std::string& arguments) const {
    return RunCommand(std::string("'") + tests::kSkylut + "' " + arguments);
  }

  /// Tables of bruneton2017 that are coarse, but quickly made.
  void WriteCoarseTables(const std::string& folder) const {
    const Medium medium = MediumPreset("bruneton2017");
    fs::create_directory(folder_ / folder);
    WriteTable(folder_ / folder / kTransmittanceFileName,
               TransmittanceTable(medium, {.mu = 64, .altitudes = 16}));
    WriteTable(folder_ / folder / kSingleScatteringFileName,
               ScatteringTable(medium, {.size = {.nu = 4, .mu_s = 8, .mu = 16, .altitudes = 4},
                                        .lowest_mu_s = {}}));
  }

  void WriteCases() const {
    WriteText(folder_ / "cases.csv",
              "id,quantity,altitude_m,view_zenith_deg,relative_azimuth_deg,sun_zenith_deg,"
              "distance_m\n"
              "t,transmittance,0,60,0,30,\n"
              "s,single,100,75,40,50,\n"
              "i,inscatter_single,100,75,40,50,20000\n"
              "e,irradiance_sun,0,0,0,30,\n");
  }
};

std::vector<double> ValuesOf(const fs::path& results) {
  std::istringstream lines(ContentOf(results));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "id,wavelength_nm,value,error");
  std::vector<double> values;
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    std::string cell;
    for (int i = 0; i < 3; ++i) std::getline(cells, cell, ',');
    values.push_back(std::stod(cell));
  }
  return values;
}

TEST_F(Skylut, APresetMayReplaceAnAtmosphereFile) {
  WriteCases();
  const std::string eval = "eval --cases cases.csv --method integral --quiet --atmosphere ";
  ASSERT_EQ(Run(eval + "hazy --out hazy.csv").status, 0);
  ASSERT_EQ(Run(eval + "earth --out earth.csv").status, 0);
  EXPECT_LT(ValuesOf(folder_ / "hazy.csv").front(), ValuesOf(folder_ / "earth.csv").front())
      << "haze lets less light through";
  const Outcome unknown = Run(eval + "haezy --out r.csv");
  EXPECT_EQ(unknown.status, 3);
  EXPECT_THAT(unknown.error,
              HasSubstr("\"haezy\" is neither a file nor a preset; did you mean hazy?"));
  EXPECT_THAT(Run(eval + "vacuum-of-space --out r.csv").error, HasSubstr("presets are earth, "));
}

// A vertical path through the molecules of a cold high is denser than one of the standard atmosphere.
TEST_F(Skylut, AReportScalesHazeAndDensityOfTheAir) {
  WriteCases();
  const std::string eval = "eval --cases cases.csv --method integral --quiet ";
  ASSERT_EQ(Run(eval + "--out standard.csv").status, 0);
  const Outcome hazy = Run(eval + "--metar 'LSZH 211350Z 24008KT 3000 HZ FEW040' --out hazy.csv");
  ASSERT_EQ(hazy.status, 0) << hazy.error;
  EXPECT_THAT(hazy.error,
              HasSubstr("skylut: warning: --metar: not modelled: wind, FEW040 (clouds)"));
  ASSERT_EQ(Run(eval + "--metar 'LSZH 211350Z M30/M33 Q1045' --out cold.csv").status, 0);
  const double standard = ValuesOf(folder_ / "standard.csv").front();
  EXPECT_LT(ValuesOf(folder_ / "hazy.csv").front(), 0.8 * standard);
  EXPECT_LT(ValuesOf(folder_ / "cold.csv").front(), standard);
  EXPECT_THAT(Run(eval + "--metar 'LSZH 211350Z 24O08KT 9999' --out r.csv").error,
              HasSubstr("--metar: group \"24O08KT\": a wind is"));
}

TEST_F(Skylut, UnknownWordsNameTheNearestKnown) {
  EXPECT_THAT(Run("help").error, HasSubstr("unknown command help; did you mean --help?"));
  EXPECT_THAT(Run("bild --out t").error, HasSubstr("unknown command bild; did you mean build?"));
  EXPECT_THAT(Run("build -o t").error, HasSubstr("unknown option -o; did you mean --out?"));
  EXPECT_EQ(Run("build -o t").status, 2);
}

TEST_F(Skylut, AWrongCommandLineExitsWith2) {
  for (const char* arguments :
       {"",
        "frobnicate",
        "build",
        "build --out t.dds",
        "build --out -",
        "report --out r.png",
        "build --out t --quality best",
        "build --out t --threads -1",
        "build --out t --max-error much",
        "build --out t --max-error 1% --quality fine",
        "build --out t --tables all",
        "build --out t --max-error 1% --layout takram",
        "build --out t --max-error 1% --single-scattering-only",
        "build --out t --lowest-sun 102",
        "build --out t --layout bruneton --lowest-sun 110",
        "build --out t --layout takram --lowest-sun 102",
        "build --out t --layout takram --format dat",
        "build --out t --layout takram --quality fine",
        "build --out t --layout unity",
        "build --out t --type half",
        "build --out t --format dat",
        "build --out t --layout bruneton --type half",
        "build --out t --layout takram --single-scattering-only",
        "info",
        "eval --cases c --out r",
        "eval --cases c --out - --method integral",
        "eval --cases c --out r --method path-trace --samples 8",
        "eval --cases c --out r --method table",
        "eval --cases c --out r --method table --lut t --samples 8",
        "eval --cases c --out r --method integral --samples 1",
        "eval --cases c --out r --method integral --max-error much",
        "eval --cases c --out r --method integral --samples 8 --max-error 1%"}) {
    const Outcome outcome = Run(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_NE(outcome.error, "") << arguments;
  }
}

TEST_F(Skylut, HelpAndVersionExitWith0) {
  EXPECT_THAT(Run("--version").out, testing::StartsWith("skylut of alpenglow "));
  for (const char* command : {"", "build ", "info ", "eval ", "report "}) {
    const Outcome help = Run(std::string(command) + "--help");
    EXPECT_EQ(help.status, 0);
    EXPECT_THAT(help.out, HasSubstr("Usage:"));
  }
}

TEST_F(Skylut, BuiltTablesAreDescribedAndEvaluated) {
  WriteText(folder_ / "air.toml", "preset = \"bruneton2017\"\n");
  const Outcome built =
      Run("build --out tables --atmosphere air.toml --quality preview --progress json");
  ASSERT_EQ(built.status, 0) << built.error;
  EXPECT_THAT(built.error, testing::StartsWith("{\"label\":\"single scattering\",\"done\":"));
  const Outcome info = Run("info tables");
  EXPECT_EQ(info.status, 0) << info.error;
  for (const char* fact : {"transmittance", "single scattering", "bruneton2017", "every texel",
                           "rayleigh.0550nm", "made by     alpenglow "}) {
    EXPECT_THAT(info.out, HasSubstr(fact));
  }
  EXPECT_EQ(Run("info tables/transmittance.exr").status, 0);
  EXPECT_EQ(Run("info tables/multiple_scattering.exr").status, 0);

  WriteCases();
  for (const char* method :
       {"table --lut tables", "table --lut tables --atmosphere air.toml", "integral --lut tables",
        "integral --atmosphere air.toml", "integral --atmosphere air.toml --max-error 0.1%"}) {
    const Outcome eval = Run(std::string("eval --cases cases.csv --out results.csv --quiet "
                                         "--method ") +
                             method);
    ASSERT_EQ(eval.status, 0) << eval.error;
    const std::vector<double> values = ValuesOf(folder_ / "results.csv");
    ASSERT_EQ(values.size(), 12U) << "four cases at three wavelengths";
    // Molecules, aerosol and the tent of 15 km: the vertical columns at 550 nm.
    const double vertical =
        13.558e-6 * 8e3 * (1.0 - std::exp(-7.5)) + 4.44e-6 * 1.2e3 + 1.881e-6 * 15e3;
    EXPECT_NEAR(values[1], std::exp(-2.0 * vertical), 0.003)
        << "60 degrees from the zenith; the curvature of the shell takes 0.5 % of the path";
  }
}

TEST_F(Skylut, TablesGiveLightOfAllOrdersUnlessOmitted) {
  WriteText(folder_ / "air.toml", "preset = \"bruneton2017\"\n");
  WriteText(folder_ / "cases.csv",
            "id,quantity,altitude_m,view_zenith_deg,relative_azimuth_deg,sun_zenith_deg,"
            "distance_m\n"
            "t,total,100,75,40,50,\n"
            "g,total,1000,130,40,50,\n"
            "e,irradiance_sky,0,0,0,30,\n");
  const std::string build = "build --out tables --atmosphere air.toml --quality preview --quiet";
  ASSERT_EQ(Run(build).status, 0);
  const std::string eval = "eval --cases cases.csv --quiet --lut tables --out ";
  ASSERT_EQ(Run(eval + "table.csv --method table").status, 0);
  ASSERT_EQ(Run(eval + "integral.csv --method integral").status, 0);
  const std::vector<double> looked_up = ValuesOf(folder_ / "table.csv");
  const std::vector<double> integrated = ValuesOf(folder_ / "integral.csv");
  ASSERT_EQ(looked_up.size(), 9U);
  for (std::size_t i = 0; i < looked_up.size(); ++i) {
    EXPECT_NEAR(looked_up[i] / integrated[i], 1.0, 0.02) << i << ": the coarsest tables";
  }

  fs::remove(folder_ / "tables" / "transmittance.exr");
  const Outcome missing = Run(eval + "r.csv --method table");
  EXPECT_EQ(missing.status, 3);
  EXPECT_THAT(missing.error, HasSubstr("transmittance.exr"));

  ASSERT_EQ(Run(build + " --single-scattering-only").status, 0);
  EXPECT_FALSE(fs::exists(folder_ / "tables" / "multiple_scattering.exr")) << "not even an old one";
  const Outcome refused = Run(eval + "r.csv --method table");
  EXPECT_EQ(refused.status, 3);
  EXPECT_THAT(refused.error, HasSubstr("cases.csv:2"));
}

TEST_F(Skylut, TablesForAnErrorReportChoiceAndMeasurement) {
  // One band of scalar light is enough. Under the sanitizers, where it takes half a minute, the
  // planet has no air.
  const std::string no_air =
      "[rayleigh]\nscattering_per_m = 0.0\n[mie]\nscattering_per_m = 0.0\nextinction_per_m = 0.0\n";
  WriteText(folder_ / "small.toml",
            "preset = \"earth\"\npolarised = false\n[spectrum]\nwavelengths_nm = [550]\n" +
                (tests::kSanitized ? no_air : ""));
  const Outcome built = Run("build --out tables --max-error 5% --quiet --atmosphere small.toml");
  ASSERT_EQ(built.status, 0) << built.error;
  for (const char* fact : {"for errors below 5 %: ", "no table: closed form", "sun angles x ",
                           "Gauss nodes", "sky by day", "aerial perspective", "twilight",
                           "irradiance of the sky", "99th percentile", "against paths"}) {
    EXPECT_THAT(built.out, HasSubstr(fact));
  }
  EXPECT_THAT(Run("info tables").out, HasSubstr("multiple scattering"));
  WriteCases();
  EXPECT_EQ(Run("eval --cases cases.csv --out r.csv --lut tables --method table --quiet").status, 0)
      << "what has no table is integrated";
}

TEST_F(Skylut, UsesTheEarthWithoutAnAtmosphereFile) {
  WriteCases();
  ASSERT_EQ(Run("eval --cases cases.csv --out r.csv --method integral --quiet").status, 0);
  EXPECT_THAT(ContentOf(folder_ / "r.csv"), HasSubstr("\nt,445,")) << "four bands";
}

TEST_F(Skylut, WrongInputsExitWith3AndOneLine) {
  WriteCoarseTables("tables");
  WriteCases();
  WriteText(folder_ / "bad.csv", "id,quantity\n");
  WriteText(folder_ / "bad.toml", "[planet]\nradius_m = -1\n");
  const std::string whole = ContentOf(folder_ / "tables" / "transmittance.exr");
  WriteText(folder_ / "cut.exr", whole.substr(0, whole.size() / 2));
  WriteText(folder_ / "earth.toml", "preset = \"earth\"\n");
  fs::create_directory(folder_ / "empty");
  const std::pair<const char*, const char*> runs[] = {
      {"build --out t --atmosphere bad.toml", "bad.toml:2"},
      {"build --out t --atmosphere none.toml", "none.toml"},
      {"build --out t --layout takram --atmosphere earth.toml", "spectrum.wavelengths_nm has 4"},
      {"info none", "none"},
      {"info empty", "empty"},
      {"info cut.exr", "cut.exr"},
      {"info cases.csv", "cases.csv"},
      {"eval --cases bad.csv --out r.csv --method integral", "bad.csv:1"},
      {"eval --cases none.csv --out r.csv --method integral", "none.csv"},
      {"eval --cases cases.csv --out r.csv --method table --lut empty", "transmittance.exr"},
      {"eval --cases cases.csv --out r.csv --method table --lut tables --atmosphere earth.toml",
       "another atmosphere"},
  };
  for (const auto& [arguments, reason] : runs) {
    const Outcome outcome = Run(std::string(arguments) + " --quiet");
    EXPECT_EQ(outcome.status, 3) << arguments;
    EXPECT_THAT(outcome.error, testing::StartsWith("skylut: "));
    EXPECT_THAT(outcome.error, HasSubstr(reason));
    EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
  }
  EXPECT_FALSE(fs::exists(folder_ / "r.csv"));
  EXPECT_FALSE(fs::exists(folder_ / "t" / "transmittance.exr"));
}

// Hard case 46.
TEST_F(Skylut, UnwritableOutputsExitWith4) {
  WriteCases();
  const Outcome build = Run("build --out cases.csv/tables --quality preview --quiet");
  EXPECT_EQ(build.status, 4) << build.error;
  EXPECT_THAT(build.error, HasSubstr("cases.csv/tables"));
  const Outcome eval =
      Run("eval --cases cases.csv --out cases.csv/r.csv --method integral --quiet");
  EXPECT_EQ(eval.status, 4) << eval.error;
  EXPECT_THAT(eval.error, HasSubstr("cases.csv"));
}

TEST_F(Skylut, IncompleteSetsForOtherProgramsAreRefused) {
  fs::create_directory(folder_ / "set");
  WriteText(folder_ / "set" / "scattering.dat", "short");
  for (const char* arguments : {"info set", "info set/scattering.dat"}) {
    const Outcome outcome = Run(arguments);
    EXPECT_EQ(outcome.status, 3) << arguments;
    EXPECT_THAT(outcome.error, HasSubstr("set/transmittance.dat: is missing")) << arguments;
  }
}

TEST_F(Skylut, LostMessagesLoseNoResult) {
  WriteCases();
  const std::vector<std::string> eval{
      tests::kSkylut, "eval",  "--cases", (folder_ / "cases.csv").string(), "--method", "integral",
      "--progress",   "plain", "--out",   (folder_ / "r.csv").string()};
  ASSERT_EQ(Run("eval --cases cases.csv --out told.csv --method integral").status, 0);
  for (const tests::Lost how :
       {tests::Lost::kFull, tests::Lost::kClosed, tests::Lost::kPipe, tests::Lost::kTerminal}) {
    fs::remove(folder_ / "r.csv");
    const std::optional<int> status = tests::StatusWithLostMessages(eval, how);
    if (!status) continue;  // a machine without /dev/pts has no terminal to lose
    EXPECT_EQ(*status, 0) << static_cast<int>(how);
    EXPECT_EQ(ContentOf(folder_ / "r.csv"), ContentOf(folder_ / "told.csv"))
        << static_cast<int>(how);
    std::vector<std::string> wrong = eval;
    wrong.back() = (folder_ / "cases.csv" / "r.csv").string();
    EXPECT_EQ(tests::StatusWithLostMessages(wrong, how), 4) << "the status still tells";
  }
}

TEST_F(Skylut, UnreadResultsExitWith4) {
  WriteCoarseTables("tables");
  for (const char* command : {"info tables", "--version", "info --help"}) {
    const std::string run = std::string("'") + tests::kSkylut + "' " + command;
    for (const char* nowhere : {" >/dev/full", " >&-"}) {
      const Outcome outcome = RunCommand("(" + run + nowhere + ")");
      EXPECT_EQ(outcome.status, 4) << command << nowhere;
      EXPECT_THAT(outcome.error, HasSubstr("standard output")) << command << nowhere;
    }
  }
}

TEST_F(Skylut, AnInputIsNeverOverwritten) {
  WriteCases();
  WriteCoarseTables("tables");
  const std::string cases = ContentOf(folder_ / "cases.csv");
  fs::create_directory(folder_ / "t");
  WriteText(folder_ / "t" / "atmosphere.toml", "preset = \"bruneton2017\"\n");
  for (const char* arguments :
       {"eval --cases cases.csv --out ./cases.csv --method integral",
        "eval --cases cases.csv --out tables/transmittance.exr --lut tables --method table",
        "build --out t --layout takram --atmosphere t/atmosphere.toml"}) {
    const Outcome outcome = Run(arguments);
    EXPECT_EQ(outcome.status, 3) << arguments;
    EXPECT_THAT(outcome.error, HasSubstr("an input is not overwritten"));
  }
  EXPECT_EQ(ContentOf(folder_ / "cases.csv"), cases);
  EXPECT_EQ(ContentOf(folder_ / "t" / "atmosphere.toml"), "preset = \"bruneton2017\"\n");
}

// Hard case 45.
TEST_F(Skylut, AnInterruptLeavesNoPartialFile) {
  // The build is interrupted when its first line of progress is out, whenever that is.
  const std::string script = "cd '" + folder_.string() + "' && rm -f fifo && mkfifo fifo && { '" +
                             tests::kSkylut +
                             "' build --out tables --quality fine --progress json 2>fifo & } && "
                             "pid=$! && { read line && kill -INT $pid && cat >/dev/null; } <fifo; "
                             "wait $pid";
  const int status = std::system(("bash -c '" +
                                  [&] {
                                    std::string quoted;
                                    for (const char c : script) {
                                      quoted +=
                                          c == '\'' ? std::string("'\\''") : std::string(1, c);
                                    }
                                    return quoted;
                                  }() +
                                  "'")
                                     .c_str());
  EXPECT_EQ(ExitStatus(status), 130);
  EXPECT_FALSE(fs::exists(folder_ / "tables" / "single_scattering.exr"));
  EXPECT_TRUE(fs::exists(folder_ / "tables" / "transmittance.exr")) << "finished work is kept";
  std::size_t files = 0;
  for (const auto& unused : fs::directory_iterator(folder_ / "tables")) {
    static_cast<void>(unused);
    ++files;
  }
  EXPECT_EQ(files, 1U) << "no temporary stays";
}

TEST_F(Skylut, UnsupportedWavelengthsAreRefusedWithFileAndLine) {
  std::string fine = "[spectrum]\nwavelengths_nm = [380";
  for (int wavelength_nm = 390; wavelength_nm <= 800; wavelength_nm += 10)
    fine += ", " + std::to_string(wavelength_nm);
  WriteText(folder_ / "fine.toml", fine + "]\n");
  WriteText(folder_ / "infrared.toml", "[spectrum]\nwavelengths_nm = [700, 800]\n");
  WriteCases();
  const std::string sky = "sky --out s.exr --sun-elevation 10 --size 8x4 --quiet --atmosphere ";
  for (const std::string& command :
       {sky + "fine.toml", std::string("build --out t --quiet --atmosphere fine.toml"),
        std::string("eval --method integral --cases cases.csv --out r.csv --quiet --atmosphere "
                    "fine.toml")}) {
    const Outcome refused = Run(command);
    EXPECT_EQ(refused.status, 3) << command;
    EXPECT_THAT(refused.error,
                AllOf(HasSubstr("fine.toml:2: spectrum.wavelengths_nm has 43 values"),
                      HasSubstr("1 to 40")));
  }
  const Outcome grey = Run(sky + "infrared.toml");
  EXPECT_EQ(grey.status, 3);
  EXPECT_THAT(grey.error, AllOf(HasSubstr("infrared.toml:2: spectrum.wavelengths_nm"),
                                HasSubstr("for colours")));
  EXPECT_FALSE(fs::exists(folder_ / "s.exr"));
}

// Hard case 2.
TEST_F(Skylut, EveryMethodHasAirBelowTheSea) {
  WriteText(
      folder_ / "below.csv",
      "id,quantity,altitude_m,view_zenith_deg,relative_azimuth_deg,sun_zenith_deg,distance_m\n"
      "down,transmittance,-400,90.2168558,0,50,10000\n"
      "up,transmittance,-430,89.8730814,0,50,10000\n"
      "light,inscatter_single,-430,90.5,0,50,10000\n");
  const Outcome integral = Run("eval --method integral --cases below.csv --out i.csv --quiet");
  ASSERT_EQ(integral.status, 0) << integral.error;
  const auto value = [](const std::string& text, const std::string& id) {
    const std::size_t line = text.find("\n" + id + ",");
    const std::size_t second = text.find(',', text.find(',', line + 1) + 1);
    return std::stod(text.substr(second + 1));
  };
  const std::string light = ContentOf(folder_ / "i.csv");
  EXPECT_NEAR(value(light, "down"), value(light, "up"), 1e-5) << "the ends swapped";
  EXPECT_LT(value(light, "down"), 0.9) << "ten kilometres of air";
  WriteText(
      folder_ / "traced.csv",
      "id,quantity,altitude_m,view_zenith_deg,relative_azimuth_deg,sun_zenith_deg,distance_m\n"
      "light,inscatter_single,-430,90.5,0,50,10000\n");
  ASSERT_EQ(Run("eval --cases traced.csv --out p.csv --method path-trace --quiet").status, 0);
  const double traced = value(ContentOf(folder_ / "p.csv"), "light");
  EXPECT_GT(traced, 0.0);
  EXPECT_NEAR(value(light, "light"), traced, 0.025 * traced) << "five standard errors of 0.5 %";
}

}  // namespace
}  // namespace alpenglow::lut
