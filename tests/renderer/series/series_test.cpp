// SPDX-License-Identifier: MIT
#include "renderer/series/series.h"
#include "renderer/series/scene_metadata.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/medium/phase_forms.h"
#include "lut/cli/program.h"
#include "lut/image/exr.h"
#include "lut/image/night_vision.h"
#include "lut/image/png.h"
#include "lut/image/white_balance.h"
#include "renderer/scene/scene_clouds.h"
#include "renderer/scene/scene_fields.h"
#include "renderer/scene/scene_options.h"
#include "renderer/series/contact_sheet.h"
#include "renderer/series/keogram.h"
#include "renderer/series/manifest.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/temporary_folder.h"
#include "tests/fixtures/toml_keys.h"

namespace alpenglow::renderer {
namespace {

using atmosphere::operator*;  // Matrix3 is an array of the standard library
namespace fs = std::filesystem;
using testing::HasSubstr;
using Provenance = TemporaryFolder;

TEST(FrameName, NumbersAreFilledIn) {
  struct Case {
    const char* pattern;
    int number;
    const char *exr, *manifest;
  };
  for (const Case& one :
       {Case{"d/frame.%04d.exr", 7, "d/frame.0007.exr", "d/frame.manifest.csv"},
        {"d/frame.%04d.exr", 123456, "d/frame.123456.exr", "d/frame.manifest.csv"},
        {"d/%04d.exr", 7, "d/0007.exr", "d/manifest.csv"},
        {"f%d.exr", 7, "f7.exr", "f.manifest.csv"},
        {"f%3d.exr", 7, "f007.exr", "f.manifest.csv"},  // no spaces, as in ffmpeg
        {"f%0d.exr", 7, "f7.exr", "f.manifest.csv"},
        {"100%%-%02d.exr", 7, "100%-07.exr", "100%.manifest.csv"},
        {"still.exr", 7, "still.exr", "still.manifest.csv"}}) {
    EXPECT_EQ(FrameName(one.pattern).Picture(one.number), one.exr) << one.pattern;
    EXPECT_EQ(FrameName(one.pattern).Manifest(), one.manifest) << one.pattern;
  }
  EXPECT_EQ(FrameName("d/frame.%04d.exr").Png(7), "d/frame.0007.png");
  EXPECT_FALSE(FrameName("still.exr").HasNumber());
  for (const char* pattern : {"%s.exr", "%04x.exr", "%n.exr", "%", "a%.exr", "%d%d.exr", "%*d.exr",
                              "%99999d.exr", "%ld.exr", "%d/a.exr", "a.%04d.png", "a.%04d", ""})
    EXPECT_NE(tests::FaultOf([&] { return FrameName(pattern); }), "no fault") << pattern;
}

class SeriesRun : public TemporaryFolder {
 protected:
  SeriesSource Source() {
    SeriesSource source;
    source.render = [this](const Frame& frame, Progress&) {
      ++renderings_;
      if (on_render_) on_render_();
      const double light = frame.instant.second_of_day;
      return Even({light, light, light});
    };
    source.settings = {{"alpenglow.fov_deg", "60"}};
    source.viewpoint.place = {46.5, 8.0, 0.0};
    source.viewpoint.zone = "Europe/Zurich";
    return source;
  }
  SeriesOutput Output(bool png = false) const {
    SeriesOutput output{FrameName((folder_ / "frame.%04d.exr").string())};
    output.progress = ProgressStyle::kQuiet;
    output.png = png;
    return output;
  }
  static std::vector<Frame> Frames(int count) {
    std::vector<Frame> frames;
    for (int i = 1; i <= count; ++i) frames.push_back({i, UtcTime{61212, 3600.0 * (i + 3)}});
    return frames;
  }
  SeriesSummary Run(const SeriesSource& source, const SeriesOutput& output, int count = 3) {
    const std::vector<Frame> frames = Frames(count);
    return RunSeries(source, frames, frames, output);
  }

  /// Runs a series of one frame whose picture has one colour.
  void RunColour(const std::array<double, 3>& rgb, const SeriesOutput& output) {
    SeriesSource source = Source();
    source.render = [&](const Frame&, Progress&) { return Even(rgb); };
    Run(source, output, 1);
  }
  static HdrImage Even(const std::array<double, 3>& rgb) {
    HdrImage image(16, 9);
    for (auto& pixel : image.rgb) {
      for (std::size_t c = 0; c < 3; ++c) pixel[c] = static_cast<float>(rgb[c]);
    }
    return image;
  }
  /// Returns the light of a white of this temperature [cd/m^2].
  static std::array<double, 3> LightOf(double kelvin) {
    auto white = LinearSrgbFromXyz() * WhiteOfTemperature(kelvin);
    for (double& value : white) value *= 800.0;
    return white;
  }
  [[nodiscard]] Metadata ExrHeader(int frame) const {
    return ReadExrMetadata(folder_ / fmt::format("frame.{:04d}.exr", frame));
  }
  [[nodiscard]] Metadata PngHeader(int frame) const {
    return ReadPngMetadata(folder_ / fmt::format("frame.{:04d}.png", frame));
  }

  int renderings_ = 0;
  std::function<void()> on_render_;
};

TEST_F(SeriesRun, WritesEveryFrameAndTheManifest) {
  SeriesOutput output = Output(true);
  const SeriesSummary summary = Run(Source(), output);
  EXPECT_EQ(summary.rendered, 3);
  EXPECT_EQ(FileCount(), 8U) << "three EXR, three PNG, the manifest and the same as JSON";
  EXPECT_EQ(ReadExr(folder_ / "frame.0002.exr").at(0, 0)[0], 18000.0F);
  const std::string manifest = ContentOf(folder_ / "frame.manifest.csv");
  EXPECT_THAT(manifest, testing::StartsWith("frame,file,utc,local_time,sun_azimuth_deg,"));
  EXPECT_THAT(manifest, HasSubstr("\n2,frame.0002.exr,2026-06-21T05:00:00Z,"
                                  "2026-06-21T07:00:00+02:00,"));
}

TEST_F(SeriesRun, HeadersAndManifestDescribeFramesAndTheirExposure) {
  SeriesOutput output = Output(true);
  Run(Source(), output, 1);
  const Metadata metered = ExrHeader(1);
  EXPECT_EQ(metered.at("alpenglow.exposure"), "metered");
  EXPECT_EQ(metered.at("alpenglow.exposure_rule"), RuleInWords({}));
  // 14400 cd/m^2 everywhere: log2(8 * 14400) = 16.81.
  EXPECT_NEAR(std::stod(metered.at("alpenglow.ev100")), 16.81, 0.04)
      << "half a bin of the meter's histogram";
  EXPECT_EQ(PngHeader(1).at("alpenglow.exposure_rule"), RuleInWords({}));
  EXPECT_THAT(ContentOf(folder_ / "frame.manifest.csv"),
              AllOf(HasSubstr(",ev100,exposure\n"), testing::EndsWith(",metered\n")));
  output.exposure = {ExposureRule::Kind::kFixed, 12.5};
  Run(Source(), output);
  for (const Metadata& metadata : {ExrHeader(1), PngHeader(1)}) {
    for (const auto& [key, value] : {std::pair{"utc", "2026-06-21T04:00:00.000Z"},
                                     {"ev100", "12.5000"},
                                     {"fov_deg", "60"},
                                     {"frame", "1"},
                                     {"white_balance", "daylight (D65)"}})
      EXPECT_EQ(metadata.at(std::string("alpenglow.") + key), value);
    EXPECT_EQ(metadata.at("alpenglow.fingerprint").size(), 16U);
  }
}

TEST_F(SeriesRun, IncidentExposureFollowsTheLightOnThePlace) {
  SeriesSource source = Source();
  source.illuminance = [](const Frame& frame) { return frame.instant.second_of_day; };
  SeriesOutput output = Output();
  output.exposure.kind = ExposureRule::Kind::kIncident;
  Run(source, output);
  const Metadata metadata = ExrHeader(2);
  EXPECT_EQ(metadata.at("alpenglow.ev100"), fmt::format("{:.4f}", IncidentEv100(18000.0)));
  EXPECT_EQ(metadata.at("alpenglow.exposure"), "incident");
}

TEST_F(SeriesRun, SingleFramesAreExposedAsInTheSeries) {
  SeriesSource source = Source();
  int previews = 0;
  source.preview = [&](const Frame& frame) {
    ++previews;
    HdrImage image(4, 3);
    const double jump = frame.number > 4 ? 30.0 : 1.0;
    for (auto& pixel : image.rgb) pixel.fill(static_cast<float>(100.0 * jump));
    return image;
  };
  SeriesOutput output = Output(true);
  std::vector<Frame> frames;
  for (int i = 1; i <= 8; ++i) frames.push_back({i, UtcTime{61212, 600.0 * i}});
  RunSeries(source, frames, frames, output);
  std::vector<double> ev100;
  for (int i = 1; i <= 8; ++i) {
    const Metadata metadata = ReadExrMetadata(folder_ / fmt::format("frame.{:04d}.exr", i));
    ev100.push_back(std::stod(metadata.at("alpenglow.ev100")));
    EXPECT_THAT(metadata.at("alpenglow.exposure_rule"), HasSubstr("over frames 0, 1, 2 ... of 8"));
  }
  for (std::size_t i = 1; i < ev100.size(); ++i)
    EXPECT_LT(ev100[i] - ev100[i - 1], 0.75 * std::log2(30.0)) << "a jump is spread";
  const std::string whole = ContentOf(folder_ / "frame.0005.png");
  fs::remove(folder_ / "frame.0005.exr");
  fs::remove(folder_ / "frame.0005.png");
  RunSeries(source, frames, SelectFrames(frames, "5"), output);
  EXPECT_EQ(ContentOf(folder_ / "frame.0005.png"), whole);

  previews = 0;
  output.resume = true;
  EXPECT_EQ(RunSeries(source, frames, frames, output).kept, 8);
  EXPECT_EQ(previews, 0) << "frames that are there say how they were exposed";
}

TEST_F(SeriesRun, WhiteBalanceChangesOnlyTheDevelopedPicture) {
  SeriesOutput output = Output(true);
  output.look.white.kind = WhiteBalance::Kind::kAuto;
  RunColour(LightOf(4000.0), output);
  const HdrImage light = ReadExr(folder_ / "frame.0001.exr");
  EXPECT_GT(light.at(0, 0)[0], 2.0F * light.at(0, 0)[2]) << "light is as it was";
  const DisplayImage shown = ReadPng(folder_ / "frame.0001.png");
  EXPECT_NEAR(shown.rgb[0], shown.rgb[2], 3) << "grey, dithered";
  EXPECT_EQ(ExrHeader(1).at("alpenglow.white_balance"), "auto, 4000 K, CAT16");
}

TEST_F(SeriesRun, AutomaticWhiteBalanceIsSmoothOverAFilm) {
  // The light of a lamp of 3500 K appears from one frame to the next.
  const auto light = [](const Frame& frame) {
    return Even(LightOf(frame.number < 24 ? 6500.0 : 3500.0));
  };
  int previews = 0;
  SeriesSource source = Source();
  source.render = [&](const Frame& frame, Progress&) { return light(frame); };
  source.preview = [&](const Frame& frame) {
    ++previews;
    return light(frame);
  };
  SeriesOutput output = Output();
  output.look.white.kind = WhiteBalance::Kind::kAuto;
  output.exposure = {ExposureRule::Kind::kFixed, 9.0};
  std::vector<Frame> frames;
  for (int i = 0; i < 49; ++i) frames.push_back({i, UtcTime{61212, 40000.0 + 30.0 * i}});
  RunSeries(source, frames, frames, output);
  EXPECT_EQ(previews, 13) << "a node every four frames";
  std::vector<double> mireds;
  for (const Frame& frame : frames) {
    const Metadata header = ReadExrMetadata(output.name.Picture(frame.number));
    mireds.push_back(1e6 / std::stod(header.at("alpenglow.white_k")));
  }
  EXPECT_NEAR(mireds.front(), 1e6 / 6500.0, 0.1);
  EXPECT_NEAR(mireds.back(), 1e6 / 3500.0, 0.1);
  constexpr double kStep = 1e6 / 3500.0 - 1e6 / 6500.0;
  for (std::size_t i = 1; i < mireds.size(); ++i) {
    EXPECT_GE(mireds[i] - mireds[i - 1], -0.1) << "whole kelvins";
    EXPECT_LE(mireds[i] - mireds[i - 1], 0.75 * kStep / 4.0 + 0.1) << "3 s / (4 n)";
  }
  previews = 0;
  output.resume = true;
  EXPECT_EQ(RunSeries(source, frames, frames, output).kept, 49);
  EXPECT_EQ(previews, 0);
}

TEST_F(SeriesRun, NightVisionChangesOnlyTheDevelopedPicture) {
  SeriesSource source = Source();
  source.render = [](const Frame&, Progress&) {
    HdrImage image = Even({2e-3, 1e-4, 1e-4});
    image.layers.push_back({kScotopicChannel, std::vector<float>(image.rgb.size(), 1e-3F)});
    return image;
  };
  SeriesOutput output = Output(true);
  output.look.night_vision = true;
  Run(source, output, 1);
  EXPECT_EQ(ReadExr(folder_ / "frame.0001.exr").at(0, 0)[0], 2e-3F);
  const DisplayImage seen = ReadPng(folder_ / "frame.0001.png");
  EXPECT_GT(seen.rgb[2], seen.rgb[0]) << "red light has turned a bluish grey";
}

TEST_F(SeriesRun, GlareChangesOnlyTheDevelopedPicture) {
  SeriesSource source = Source();
  source.fov_rad = 0.5;
  source.render = [](const Frame&, Progress&) {
    HdrImage image = Even({100.0, 100.0, 100.0});
    image.at(8, 4).fill(1e7F);
    return image;
  };
  SeriesOutput output = Output(true);
  output.exposure = {ExposureRule::Kind::kFixed, 10.0};
  Run(source, output, 1);
  const DisplayImage without = ReadPng(folder_ / "frame.0001.png");
  output.glare = true;
  Run(source, output, 1);
  EXPECT_EQ(ReadExr(folder_ / "frame.0001.exr").at(9, 4)[0], 100.0F);
  EXPECT_EQ(ExrHeader(1).count("alpenglow.glare"), 1U);
  const std::size_t beside = 3 * (4 * 16 + 9);
  EXPECT_GT(ReadPng(folder_ / "frame.0001.png").rgb[beside], without.rgb[beside] + 20);
  source.projection = Projection::kLatitudeLongitude;
  EXPECT_THROW((void)Run(source, output, 1), InputError);
}

TEST_F(SeriesRun, ResumeKeepsFinishedFrames) {
  SeriesOutput output = Output(true);
  Run(Source(), output);
  fs::remove(folder_ / "frame.0002.exr");
  const fs::file_time_type before = fs::last_write_time(folder_ / "frame.0001.exr");
  output.resume = true;
  const SeriesSummary summary = Run(Source(), output);
  EXPECT_EQ(summary.rendered, 1);
  EXPECT_EQ(summary.kept, 2);
  EXPECT_EQ(renderings_, 4);
  EXPECT_EQ(fs::last_write_time(folder_ / "frame.0001.exr"), before);
  output.resume = false;
  EXPECT_EQ(Run(Source(), output).rendered, 3);
}

// Hard case 48.
TEST_F(SeriesRun, ResumeRendersStaleFramesAgain) {
  SeriesOutput output = Output();
  Run(Source(), output);
  output.resume = true;
  SeriesSource changed = Source();
  changed.settings["alpenglow.fov_deg"] = "45";
  EXPECT_EQ(Run(changed, output).rendered, 3);
  EXPECT_EQ(ExrHeader(3).at("alpenglow.fov_deg"), "45");

  std::vector<Frame> later = Frames(3);
  later[1].instant.second_of_day += 60.0;
  EXPECT_EQ(RunSeries(changed, later, later, output).rendered, 1) << "frame 2 shows another time";
}

// Hard case 45.
TEST_F(SeriesRun, ResumeRendersDamagedFramesAgain) {
  SeriesOutput output = Output();
  Run(Source(), output);
  const std::string whole = ContentOf(folder_ / "frame.0001.exr");
  WriteText(folder_ / "frame.0001.exr", whole.substr(0, whole.size() - 20));
  WriteText(folder_ / "frame.0002.exr", "no picture");
  output.resume = true;
  const SeriesSummary summary = Run(Source(), output);
  EXPECT_EQ(summary.rendered, 2);
  EXPECT_EQ(summary.kept, 1);
  EXPECT_EQ(ContentOf(folder_ / "frame.0001.exr"), whole);
}

TEST_F(SeriesRun, AnotherExposureIsDevelopedWithoutRendering) {
  SeriesOutput output = Output(true);
  Run(Source(), output);
  const DisplayImage metered = ReadPng(folder_ / "frame.0001.png");
  output.resume = true;
  output.exposure = {ExposureRule::Kind::kFixed, 18.0};
  const SeriesSummary summary = Run(Source(), output);
  EXPECT_EQ(summary.developed, 3);
  EXPECT_EQ(renderings_, 3);
  EXPECT_EQ(ExrHeader(1).at("alpenglow.ev100"), "18.0000");
  EXPECT_LT(ReadPng(folder_ / "frame.0001.png").rgb[0], metered.rgb[0]) << "a higher EV is darker";
  fs::remove(folder_ / "frame.0003.png");
  EXPECT_EQ(Run(Source(), output).developed, 1) << "a missing PNG";
  EXPECT_EQ(renderings_, 3);
  EXPECT_TRUE(fs::exists(folder_ / "frame.0003.png"));
}

TEST_F(SeriesRun, OnlySelectedFramesAreRendered) {
  const std::vector<Frame> frames = Frames(5);
  RunSeries(Source(), frames, SelectFrames(frames, "1-2"), Output());
  EXPECT_EQ(renderings_, 2);
  RunSeries(Source(), frames, SelectFrames(frames, "4"), Output());
  const std::string manifest = ContentOf(folder_ / "frame.manifest.csv");
  std::istringstream lines(manifest);
  std::string line;
  std::vector<bool> has_ev;
  while (std::getline(lines, line)) has_ev.push_back(line.back() != ',');
  EXPECT_EQ(has_ev, (std::vector<bool>{true, true, true, false, true, false}))
      << "title, then frames 1 to 5: those of the earlier run are remembered\n"
      << manifest;
}

// A process of a farm, of a week at one frame a second.
TEST_F(SeriesRun, AProcessOfALongSeriesListsItsOwnFramesAlone) {
  std::vector<Frame> frames;
  for (int i = 0; i < 604800; ++i) frames.push_back({i, AddSeconds(UtcTime{61212, 0.0}, i)});
  RunSeries(Source(), frames, SelectFrames(frames, "400000-400001"), Output());
  EXPECT_EQ(renderings_, 2);
  const std::string manifest = ContentOf(folder_ / "frame.manifest.csv");
  EXPECT_EQ(std::count(manifest.begin(), manifest.end(), '\n'), 3);
  EXPECT_THAT(manifest, HasSubstr("\n400001,frame.400001.exr,2026-06-25T15:06:41Z,"));
}

TEST_F(SeriesRun, TwoOutputsOfOneNameAreRefusedBeforeTheWork) {
  SeriesOutput output = Output(true);
  output.keogram = folder_ / "x" / ".." / "frame.0002.png";
  EXPECT_THROW(Run(Source(), output), OptionError);
  EXPECT_EQ(renderings_, 0);
  EXPECT_EQ(FileCount(), 0U);
}

// Hard case 45.
TEST_F(SeriesRun, ASignalKeepsFinishedFramesOnly) {
  on_render_ = [this] {
    if (renderings_ == 2) std::raise(SIGINT);
  };
  testing::internal::CaptureStderr();
  const int status = RunProgram("skytest", [&] {
    Run(Source(), Output());
    return 0;
  });
  testing::internal::GetCapturedStderr();
  EXPECT_EQ(status, 130);
  EXPECT_EQ(renderings_, 2);
  EXPECT_EQ(FileCount(), 4U) << "two frames and two manifests, no temporary";
  EXPECT_NO_THROW((void)ReadExr(folder_ / "frame.0002.exr"));
  EXPECT_EQ(RunProgram("skytest", [] { return 0; }), 0) << "forgets the signal";
}

// Hard case 46.
TEST_F(SeriesRun, AFolderRemovedWhileRunningIsAnOutputError) {
  SeriesOutput output{FrameName((folder_ / "sub" / "frame.%04d.exr").string())};
  output.progress = ProgressStyle::kQuiet;
  on_render_ = [this] {
    if (renderings_ == 2) fs::remove_all(folder_ / "sub");
  };
  try {
    Run(Source(), output);
    FAIL() << "the folder came back";
  } catch (const OutputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("frame.0002.exr"));
  }
}

TEST_F(SeriesRun, AnImpossibleFolderIsReportedBeforeTheFirstFrame) {
  WriteText(folder_ / "file", "in the way");
  SeriesOutput output{FrameName((folder_ / "file" / "frame.%04d.exr").string())};
  EXPECT_THROW(Run(Source(), output), OutputError);
  EXPECT_EQ(renderings_, 0);
}

TEST_F(SeriesRun, SeveralFramesNeedANumberInTheName) {
  SeriesOutput output{FrameName((folder_ / "still.exr").string())};
  output.progress = ProgressStyle::kQuiet;
  EXPECT_THROW(Run(Source(), output, 2), InputError);
  EXPECT_EQ(Run(Source(), output, 1).rendered, 1);
  EXPECT_TRUE(fs::exists(folder_ / "still.exr"));
}

TEST_F(SeriesRun, TheContactSheetShowsEveryFrame) {
  SeriesOutput output = Output();
  output.contact_sheet = folder_ / "sheet.png";
  Run(Source(), output, 5);
  const DisplayImage sheet = ReadPng(folder_ / "sheet.png");
  // Pictures of 16 pixels are narrower than labels such as "12:00 +12.3", of 11 letters of 12 pixels.
  EXPECT_GE(sheet.width, 3 * (10 * 12 - 3 + 8) + 8);
  EXPECT_LE(sheet.width, 3 * (11 * 12 - 3 + 8) + 8);
  EXPECT_GT(sheet.height, 2 * 9);
}

TEST_F(SeriesRun, KeogramAndPlotAreMadeOfExistingFrames) {
  SeriesOutput output = Output(true);
  Run(Source(), output, 5);
  const int rendered = renderings_;
  output.resume = true;
  output.keogram = folder_ / "made" / "keogram.png";
  output.plot = folder_ / "made" / "plot.svg";
  Run(Source(), output, 5);
  EXPECT_EQ(renderings_, rendered);
  const DisplayImage keogram = ReadPng(*output.keogram);
  constexpr int kColumns = Keogram::kMostColumns;
  ASSERT_EQ(keogram.width, 5 * kColumns);
  EXPECT_EQ(keogram.height, 9 + Keogram::kScaleHeight);
  const DisplayImage third = ReadPng(folder_ / "frame.0003.png");
  EXPECT_EQ(keogram.rgb[3 * (4 * 5 * kColumns + 2 * kColumns)], third.rgb[3 * (4 * 16 + 8)]);
  EXPECT_THAT(ContentOf(*output.plot), HasSubstr("<polyline"));
  const std::string with_png = ContentOf(*output.keogram);
  output.png = false;
  Run(Source(), output, 5);
  EXPECT_EQ(ContentOf(*output.keogram), with_png) << "the same pixels, developed again";
}

TEST_F(SeriesRun, TheManifestReadsTheIlluminanceOfFrames) {
  SeriesSource source = Source();
  const auto render = source.render;
  source.render = [&](const Frame& frame, Progress& progress) {
    NotedPicture picture = render(frame, progress);
    picture.notes[kIlluminanceNote] = "1234.5";
    return picture;
  };
  const std::vector<Frame> frames = Frames(2);
  RunSeries(source, frames, SelectFrames(frames, "1"), Output());
  RunSeries(source, frames, SelectFrames(frames, "2"), Output());
  const std::string manifest = ContentOf(folder_ / "frame.manifest.json");
  EXPECT_THAT(manifest, testing::ContainsRegex("0001.exr.*illuminance_lx\":1234.5"))
      << "of another run's frame";
}

TEST_F(SeriesRun, AFilmWithoutFfmpegIsRefusedBeforeTheFirstFrame) {
  const std::string path = std::getenv("PATH");
  setenv("PATH", folder_.c_str(), 1);
  SeriesOutput output = Output();
  output.video = folder_ / "film.mp4";
  EXPECT_THROW((void)Run(Source(), output), OutputError);
  setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(renderings_, 0);
  EXPECT_FALSE(fs::exists(folder_ / "film.mp4"));
}

TEST(ContactSheet, ReducingKeepsTheMean) {
  HdrImage image(640, 360);
  for (int i = 0; i < 360; ++i) image.at(i, i).fill(640.0F);
  const HdrImage reduced = Reduced(image, 320);
  EXPECT_EQ(reduced.width, 320);
  EXPECT_EQ(reduced.height, 180);
  EXPECT_FLOAT_EQ(reduced.at(5, 5)[0], 320.0F) << "two of four pixels are lit";
  EXPECT_EQ(Reduced(image, 1000).width, 640);
  EXPECT_EQ(Reduced(HdrImage(5000, 1), 100).height, 1);
}

// Hard case 44.
TEST(ContactSheet, TinyThumbnailsHaveTheirPlace) {
  for (const auto& [width, height] : {std::pair{1, 1}, std::pair{1, 500}, std::pair{16384, 1}}) {
    const HdrImage small = Reduced(HdrImage(width, height), kThumbnailWidth);
    EXPECT_LE(small.width, kThumbnailWidth);
    DisplayImage white{small.width, small.height, {}};
    white.rgb.assign(3 * small.rgb.size(), 255);
    const DisplayImage sheet = ContactSheet({{white, ""}, {white, ""}, {white, ""}});
    EXPECT_EQ(std::count(sheet.rgb.begin(), sheet.rgb.end(), 255),
              static_cast<std::ptrdiff_t>(3 * white.rgb.size()))
        << width << " x " << height;
  }
}

/// Returns the record of a scene with the contents of its files as they are now.
Metadata RecordOf(const Scene& scene) { return SceneMetadata(scene, HashFilesOf(scene)); }

// Hard case 48.
TEST_F(Provenance, FingerprintsFollowSettingsAndTerrain) {
  WriteText(folder_ / "dem.tif", "one");
  Scene scene;
  scene.medium = MediumPreset("earth");
  scene.terrain = {TerrainSource::Kind::kElevationModel, folder_ / "dem.tif", VoidPolicy::kFill};
  const std::string first = Fingerprint(RecordOf(scene));
  EXPECT_EQ(Fingerprint(RecordOf(scene)), first);
  for (const auto& change : std::vector<std::function<void(Scene&)>>{
           [](Scene& other) { other.camera.heading_rad += 1e-12; },
           [](Scene& other) { other.medium.mie_scattering_per_m[0] *= 1.0000001; },
           [](Scene& other) { other.medium.refraction = RefractionBy::kMolecules; },
           [](Scene& other) { other.lights.emplace_back(); }}) {
    Scene other = scene;
    change(other);
    EXPECT_NE(Fingerprint(RecordOf(other)), first);
  }
  WriteText(folder_ / "dem.tif", "two");
  EXPECT_NE(Fingerprint(RecordOf(scene)), first);
  fs::remove(folder_ / "dem.tif");
  EXPECT_THROW((void)RecordOf(scene), InputError);
}

TEST_F(Provenance, RecordsNameTheMethodOfLightInClouds) {
  Scene scene;
  scene.medium = MediumPreset("earth");
  RenderSettings settings;
  settings.cloud_light = CloudLightMethod::kHybrid;
  const auto record = [&] { return PictureMetadata(scene, HashFilesOf(scene), settings); };
  EXPECT_EQ(record().count("alpenglow.cloud_light"), 0U) << "without clouds all are the same";
  scene.clouds = CloudsFromText("fair");
  EXPECT_EQ(record().at("alpenglow.cloud_light"), "hybrid");
  const std::string hybrid = Fingerprint(record());
  settings.cloud_light = CloudLightMethod::kFast;
  EXPECT_NE(Fingerprint(record()), hybrid) << "--resume must not mix methods";
}

/// A key of scene.toml with two values; an empty value leaves the key out.
struct ChangedKey {
  const char *section, *before, *after;
};

const std::vector<ChangedKey>& ChangedPlacesAndCameras() {
  static const std::vector<ChangedKey> kKeys{
      {"[place]\nlongitude = 8\n", "latitude = 46.5", "latitude = 46.6"},
      {"[place]\nlatitude = 46.5\n", "longitude = 8", "longitude = 9"},
      {"[camera]\n", "", "above_ground_m = 3"},
      {"[camera]\n", "above_ground_m = 3", "height_m = 3"},
      {"[camera]\n", "", "heading = 10"},
      {"[camera]\n", "", "pitch = 10"},
      {"[camera]\n", "", "roll = 10"},
      {"[camera]\n", "", "fov = 50"},
      {"[camera]\nfocal_length_mm = 50\n", "sensor_width_mm = 36", "sensor_width_mm = 35"},
      {"[camera]\nfocal_length_mm = 50\nfocus_m = 10\n", "", "f_number = 2"},
      {"[camera]\nf_number = 2\nfocus_m = 10\n", "focal_length_mm = 50", "focal_length_mm = 35"},
      {"[camera]\nf_number = 2\nfocal_length_mm = 50\n", "focus_m = 10", "focus_m = 20"},
      {"[camera]\nf_number = 2\nfocal_length_mm = 50\nfocus_m = 10\n", "", "blades = 6"},
      {"[camera]\nf_number = 2\nfocal_length_mm = 50\nfocus_m = 10\nblades = 6\n", "",
       "blade_rotation = 10"},
      {"[camera]\n", "", "shutter_s = 30"},
      {"[camera]\n", "", "polariser_deg = 0"},
      {"[camera]\n", "polariser_deg = 0", "polariser_deg = 45"}};
  return kKeys;
}

const std::vector<ChangedKey>& ChangedGrounds() {
  static const std::vector<ChangedKey> kKeys{
      {"[terrain]\n", "range = true", "none = true"},
      {"[terrain]\n", "dem = 'one'", "dem = 'two'"},
      {"[terrain]\n", "dem = 'one'", "mesh = 'one'"},
      {"[terrain]\nmesh = 'one'\n", "", "up = 'y'"},
      {"[terrain]\ndem = 'one'\n", "", "voids = 'open'"},
      {"[terrain]\ndem = 'one'\n", "", "colour = 'one'"},
      {"[terrain]\ndem = 'one'\n", "colour = 'one'", "colour = 'two'"},
      {"[terrain]\ndem = 'one'\n", "colour = 'one'", "land_cover = 'one'"},
      {"[terrain]\ndem = 'one'\n", "land_cover = 'one'", "land_cover = 'two'"},
      {"[ground]\n", "", "cover = 'snow'"},
      {"[ground]\n", "", "sea_level_m = 0"},
      {"[ground]\n", "sea_level_m = 0", "sea_level_m = 1"},
      {"[ground]\ncover = 'water'\n", "wind_m_per_s = 1", "wind_m_per_s = 15"},
      {"[ground]\n", "", "wetness = 0.5"},
      {"[ground]\ncover = 'lambert'\n", "albedo = 0.3", "albedo = [0.3, 0.3, 0.31]"},
      {"[ground]\ncover = 'oren-nayar'\n", "", "roughness = 0.6"},
      {"[ground]\ncover = 'blinn-phong'\n", "", "reflectance = 0.05"},
      {"[ground]\ncover = 'snow'\n", "", "grain_diameter_mm = 0.6"}};
  return kKeys;
}

constexpr char kPoint[] = "[[light]]\nlatitude = 46.5\nlongitude = 8\nintensity_cd = 9\n";
constexpr char kSpot[] =
    "[[light]]\ntype = 'spot'\nlatitude = 46.5\nlongitude = 8\nintensity_cd = 9\n";
constexpr char kMeasured[] = "[[light]]\nlatitude = 46.5\nlongitude = 8\nies = 'one'\n";

const std::vector<ChangedKey>& ChangedLights() {
  static const std::vector<ChangedKey> kKeys{
      {"", "", kPoint},
      {"", kMeasured, kPoint},
      {"[[light]]\nlongitude = 8\nintensity_cd = 9\n", "latitude = 46.5", "latitude = 46.6"},
      {"[[light]]\nlatitude = 46.5\nintensity_cd = 9\n", "longitude = 8", "longitude = 9"},
      {"[[light]]\nlatitude = 46.5\nlongitude = 8\n", "intensity_cd = 9", "intensity_cd = 10"},
      {"[[light]]\nlatitude = 46.5\nlongitude = 8\n", "ies = 'one'", "ies = 'two'"},
      {kPoint, "type = 'point'", "type = 'spot'\ncone = [10, 20]"},
      {kPoint, "", "above_ground_m = 3"},
      {kPoint, "above_ground_m = 3", "height_m = 3"},
      {kPoint, "", "temperature_k = 3001"},
      {kPoint, "", "radius_m = 0.2"},
      {kMeasured, "", "intensity_cd = 9"},
      {kMeasured, "", "heading = 10"},
      {kMeasured, "", "pitch = 0"},
      {kSpot, "cone = [10, 20]", "cone = [11, 20]"},
      {kSpot, "cone = [10, 20]", "cone = [10, 21]"},
      {kSpot, "cone = [10, 20]", "cone = [10, 20]\nheading = 10"},
      {kSpot, "cone = [10, 20]", "cone = [10, 20]\npitch = 10"}};
  return kKeys;
}

const std::vector<ChangedKey>& ChangedAir() {
  static const std::vector<ChangedKey> kKeys{
      {"[atmosphere]\n", "preset = 'earth'", "preset = 'hazy'"},
      {"[atmosphere]\n", "preset = 'earth'", "file = 'mars.toml'"},
      {"[weather]\n", "metar = 'XAAA 210000Z CAVOK'", "metar = 'XAAA 210000Z NSC'"},
      {"[weather]\nmetar = 'XAAA 210000Z FEW040'\n", "", "station_height_m = 300"},
      {"", "", "[night]\nbortle = 4"},
      {"[night]\n", "bortle = 4", "bortle = 5"},
      {"[night]\n", "zenith_mag_per_arcsec2 = 20", "zenith_mag_per_arcsec2 = 21"},
      {"", "", "[fog]\nvisibility_m = 900"},
      {"[fog]\n", "visibility_m = 900", "visibility_m = 901"},
      {"[fog]\n", "extinction_per_m = 0.004", "extinction_per_m = 0.005"},
      {"[fog]\nvisibility_m = 900\n", "", "scale_height_m = 25"},
      {"[fog]\nvisibility_m = 900\n", "", "base_height_m = 0"},
      {"[fog]\nvisibility_m = 900\n", "", "albedo = 0.9"},
      {"[fog]\nvisibility_m = 900\n", "", "droplet_diameter_um = 16"},
      {"[fog]\nvisibility_m = 900\n", "", "droplet_diameter_um = 4"},
      {"[fog]\nvisibility_m = 900\n", "g = 0.8", "g = 0.81"}};
  return kKeys;
}

constexpr char kVolume[] =
    "[[volume]]\nlatitude = 46.5\nlongitude = 8\nsize_m = [4, 4, 4]\nvisibility_m = 9\n";
constexpr char kBareVolume[] = "[[volume]]\nlatitude = 46.5\nlongitude = 8\nsize_m = [4, 4, 4]\n";

constexpr char kBareGrid[] =
    "[[volume]]\nlatitude = 46.5\nlongitude = 8\nsize_m = [4, 4, 4]\ngrid_size = [2, 2, 3]\n"
    "grid = 'one'\n";

const std::vector<ChangedKey>& ChangedVolumes() {
  static const std::vector<ChangedKey> kKeys{
      {"", "", kVolume},
      {kVolume, "", kVolume},
      {"[[volume]]\nlongitude = 8\nsize_m = [4, 4, 4]\nvisibility_m = 9\n", "latitude = 46.5",
       "latitude = 46.6"},
      {"[[volume]]\nlatitude = 46.5\nsize_m = [4, 4, 4]\nvisibility_m = 9\n", "longitude = 8",
       "longitude = 9"},
      {"[[volume]]\nlatitude = 46.5\nlongitude = 8\nvisibility_m = 9\n", "size_m = [4, 4, 4]",
       "size_m = [4, 4, 5]"},
      {kVolume, "", "shape = 'ellipsoid'"},
      {kVolume, "", "above_ground_m = 3"},
      {kVolume, "above_ground_m = 3", "height_m = 3"},
      {kVolume, "", "heading = 10"},
      {kVolume, "", "scale_height_m = 30"},
      {kVolume, "", "albedo = 0.9"},
      {kVolume, "", "emission_per_m = 1"},
      {kVolume, "albedo = 0.9", "albedo = 0.9\ntemperature_k = 1500"},
      {kVolume, "", "g = 0.5"},
      {kVolume, "", "droplet_diameter_um = 16"},
      {kVolume, "", "orders = 'single'"},
      {kVolume, "grid_size = [2, 2, 3]\ngrid = 'one'", "grid_size = [2, 3, 2]\ngrid = 'one'"},
      {kVolume, "grid_size = [2, 2, 3]\ngrid = 'one'", "grid_size = [2, 2, 3]\ngrid = 'two'"},
      {kBareGrid, "transfer = [[0, 1, 1, 1, 1], [1, 0, 1, 1, 1]]",
       "transfer = [[0, 1, 1, 1, 1], [1, 0, 1, 0.9, 1]]"},
      {kBareGrid, "transfer = [[0, 1, 1, 1, 1], [1, 0, 1, 1, 1]]",
       "transfer = [[0, 1, 1, 1, 1, 900], [1, 0, 1, 1, 1]]"},
      {kBareVolume, "visibility_m = 9", "visibility_m = 10"},
      {kBareVolume, "extinction_per_m = 1", "extinction_per_m = [1, 1, 1, 1.1]"}};
  return kKeys;
}

constexpr char kBall[] = "[[object]]\nlatitude = 46.5\nlongitude = 8\n";

const std::vector<ChangedKey>& ChangedObjects() {
  static const std::vector<ChangedKey> kKeys{
      {"", "", kBall},
      {kBall, "", kBall},
      {"[[object]]\nlongitude = 8\n", "latitude = 46.5", "latitude = 46.6"},
      {"[[object]]\nlatitude = 46.5\n", "longitude = 8", "longitude = 9"},
      {kBall, "shape = 'sphere'\nabove_ground_m = 1", "above_ground_m = 2"},
      {kBall, "above_ground_m = 3", "height_m = 3"},
      {kBall, "", "radius_m = 2"},
      {kBall, "", "material = 'mirror'"},
      {kBall, "", "index = 1.6"},
      {kBall, "", "photons = 1000"},
      {kBall, "", "photon_map = 'points'"}};
  return kKeys;
}

constexpr char kCumulus[] = "[[cloud]]\ngenus = 'cumulus'\n";
constexpr char kCirrus[] = "[[cloud]]\ngenus = 'cirrus'\n";
constexpr char kStratus[] = "[[cloud]]\ngenus = 'stratus'\n";
constexpr char kCloudGrid[] = "[[cloud]]\ngrid = 'one.txt'\n";
constexpr char kVdbCloud[] = "[[cloud]]\ngrid = 'one.vdb'\n";
constexpr char kRawCloud[] = "[[cloud]]\ngrid = 'one.raw'\nspacing_m = 50\nbase_height_m = 900\n";
constexpr char kMovingGrid[] = "[[cloud]]\ngrid = 'one.txt'\nwind_m_per_s = [3, 0]\n";

const std::vector<ChangedKey>& ChangedClouds() {
  static const std::vector<ChangedKey> kKeys{
      {"", "", kCumulus},
      {kCumulus, "", kCumulus},
      {"[[cloud]]\n", "genus = 'cumulus'", "genus = 'stratocumulus'"},
      {kCumulus, "", "cover = 0.31"},
      {kCumulus, "", "base_height_m = 1300"},
      {kCumulus, "", "base_height_m = 1200"},  // the default is above the ground
      {kCumulus, "", "depth_m = 1600"},
      {kCumulus, "", "droplets_per_cm3 = 251"},
      {kCumulus, "", "seed = 2"},
      {kCumulus, "", "wind_m_per_s = [6, 1]"},
      {kCumulus, "", "period_m = 10240"},
      {kCirrus, "", "ice_mg_per_m3 = 41"},
      {kCirrus, "", "crystal_radius_um = 36"},
      {kStratus, "", "optical_depth = 30"},
      {"[[cloud]]\n", "grid = 'one.txt'", "grid = 'two.txt'"},
      {kVdbCloud, "", "base_height_m = 1200"},
      {kVdbCloud, "", "spacing_m = 50"},
      {kVdbCloud, "", "extinction_per_m = 0.1"},
      {kVdbCloud, "", "effective_radius_um = 12"},
      {kVdbCloud, "", "vdb_grid = 'smoke'"},
      {kVdbCloud, "", "up = 'y'"},
      {kRawCloud, "grid_size = [2, 2, 3]", "grid_size = [2, 3, 2]"},
      {kCloudGrid, "", "genus = 'cirrus'"},
      {kCloudGrid, "", "repeats = true"},
      {kCloudGrid, "", "latitude = 46.6\nlongitude = 8"},
      {kCloudGrid, "latitude = 46.6\nlongitude = 8", "latitude = 46.6\nlongitude = 8.1"},
      {kCumulus, "[time]\nutc = 'A'", "[time]\nutc = 'B'"},
      {kMovingGrid, "[time]\nutc = 'A'", "[time]\nutc = 'C'"}};
  return kKeys;
}

/// Replaces 'A', 'B' and 'C' by times of one day, of the next, and an hour after the first.
std::string WithTimes(std::string text) {
  for (const auto& [name, time] : {std::pair{"'A'", "'2026-06-21T04:00:00Z'"},
                                   {"'B'", "'2026-06-22T04:00:00Z'"},
                                   {"'C'", "'2026-06-21T05:00:00Z'"}}) {
    const std::size_t at = text.find(name);
    if (at != std::string::npos) text.replace(at, 3, time);
  }
  return text;
}

TEST(Manifest, CloudsDependOnTheDayOfTheSceneAlone) {
  const auto record = [](const std::string& text) {
    return Fingerprint(RecordOf(SceneFromToml(
        WithTimes("[place]\nlatitude = 46.5\nlongitude = 8\n" + text), "scene.toml", "")));
  };
  const std::string at = "[time]\nutc = 'A'\n", later = "[time]\nutc = 'C'\n";
  EXPECT_EQ(record(at + kCumulus), record(later + kCumulus)) << "two times of one day";
  EXPECT_EQ(record(at), record("")) << "a scene without clouds has no day";
}

std::vector<std::vector<ChangedKey>> AllChanges() {
  return {ChangedPlacesAndCameras(), ChangedGrounds(), ChangedLights(), ChangedAir(),
          ChangedVolumes(),          ChangedObjects(), ChangedClouds()};
}

TEST_F(SeriesRun, ResumeRendersAgainAfterAnyChangeOfTheScene) {
  for (const char* name : {"one", "two", "one.txt", "two.txt", "one.vdb", "one.raw"})
    WriteText(folder_ / name, name);
  WriteText(folder_ / "mars.toml", "preset = 'mars'\n");
  const auto settings = [&](const ChangedKey& key, const char* value) {
    const std::string text = WithTimes(std::string(key.section) + value + "\n");
    const bool has_place = text.find("[place]") != std::string::npos;
    const std::string place = has_place ? "" : "[place]\nlatitude = 46.5\nlongitude = 8\n";
    return RecordOf(SceneFromToml(place + text, "scene.toml", folder_));
  };
  SeriesSource source = Source();
  SeriesOutput output = Output();
  output.resume = true;
  for (const auto& keys : AllChanges()) {
    for (const ChangedKey& key : keys) {
      const std::string before = Fingerprint(settings(key, key.before));
      EXPECT_EQ(Fingerprint(settings(key, key.before)), before) << key.section << key.before;
      EXPECT_NE(Fingerprint(settings(key, key.after)), before)
          << key.section << key.before << " -> " << key.after;
    }
    source.settings = settings(keys.front(), keys.front().before);
    Run(source, output, 1);
    EXPECT_EQ(Run(source, output, 1).kept, 1) << keys.front().section;
    source.settings = settings(keys.front(), keys.front().after);
    EXPECT_EQ(Run(source, output, 1).rendered, 1) << keys.front().section;
  }
}

/// Returns whether two texts of a file have different values of a key.
bool ChangesKey(const std::string& before, const std::string& after, const std::string& key) {
  const auto line_of = [&](const std::string& text) {
    return tests::Between("\n" + text + "\n", "\n" + key + " = ", "\n");
  };
  return line_of(before) != line_of(after);
}

// Keys of time and place.zone are not recorded: each frame of a series has its own time.
TEST(Manifest, ResumeIsTestedWithEveryKeyOfTheScene) {
  const std::set<std::string> not_recorded{"place.zone", "time.utc", "time.local"};
  ForEachTable([&](const auto& fields, const auto&) {
    const std::string name = "[" + fields.name + "]";
    for (const TomlKey& key : fields.Keys()) {
      bool is_tested = not_recorded.contains(fields.name + "." + key.key);
      for (const auto& changes : AllChanges()) {
        for (const ChangedKey& change : changes) {
          const std::string before = std::string(change.section) + change.before;
          const std::string after = std::string(change.section) + change.after;
          is_tested = is_tested ||
                      (after.find(name) != std::string::npos && ChangesKey(before, after, key.key));
        }
      }
      EXPECT_TRUE(is_tested) << fields.name << "." << key.key;
    }
  });
}

/// Returns scenes with objects of every table, one with an elevation model and one with a mesh.
std::vector<Scene> ScenesWithEveryTable(const fs::path& folder) {
  std::vector<Scene> scenes;
  for (const char* const terrain : {"dem", "mesh"}) {
    Scene& scene = scenes.emplace_back(SceneFromToml(
        fmt::format("[place]\nlatitude = 46.5\nlongitude = 8\n[fog]\nvisibility_m = 900\n"
                    "scale_height_m = 30\n[terrain]\n{} = 'file'\n",
                    terrain),
        "scene.toml", folder));
    scene.lights.resize(1);
    scene.lights[0].type = Light::Type::kSpot;
    scene.volumes.resize(1);
    scene.objects.resize(1);
    scene.clouds.resize(1);
  }
  return scenes;
}

TEST_F(Provenance, EveryMemberOfTheTablesOfFieldsIsRecorded) {
  WriteText(folder_ / "file", "one");
  ForEachTable([&](const auto& fields, const auto& objects_of) {
    for (const auto& field : fields.fields) {
      if (!field.member.set || !field.member.get) continue;
      if (field.key == "zone") continue;  // local times in a list of frames, not pixels
      bool is_recorded = false;
      for (const Scene& scene : ScenesWithEveryTable(folder_)) {
        Scene other = scene;
        ASSERT_FALSE(objects_of(other).empty()) << fields.name;
        auto& object = objects_of(other).front();
        object = tests::WithAnotherValue(field, object);
        is_recorded = is_recorded || Fingerprint(RecordOf(other)) != Fingerprint(RecordOf(scene));
      }
      EXPECT_TRUE(is_recorded) << fields.name << "." << field.key;
    }
  });
}

TEST(Manifest, EveryParameterOfAPhaseFunctionIsRecorded) {
  Scene scene;
  scene.medium = MediumPreset("earth");
  scene.layers.resize(1);
  PhaseFunction& phase = scene.layers[0].phase;
  for (const PhaseForm& form : PhaseForms()) {
    if (form.kind == PhaseKind::kTable) continue;
    phase = {.kind = form.kind};
    const std::string before = Fingerprint(RecordOf(scene));
    for (const PhaseParameter& parameter : form.parameters) {
      phase = {.kind = form.kind};
      phase.*parameter.member += 1e-6;
      EXPECT_NE(Fingerprint(RecordOf(scene)), before) << form.name << " " << parameter.key;
    }
  }
}

TEST_F(Provenance, FingerprintsFollowTheContentOfEveryFile) {
  for (const char* name : {"dem", "colour", "ies", "raw", "data", "field.txt", "floats"})
    WriteText(folder_ / name, "one");
  WriteText(folder_ / "smoke.nhdr",
            "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\ndata file: data\n");
  WriteText(
      folder_ / "cloud.nhdr",
      "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\ndata file: floats\n");
  const Scene scene =
      SceneFromToml(fmt::format("[place]\nlatitude = 46.5\nlongitude = 8\n"
                                "[terrain]\ndem = 'dem'\ncolour = 'colour'\n{}ies = 'ies'\n"
                                "{}grid = 'raw'\ngrid_size = [2, 2, 2]\n{}grid = 'smoke.nhdr'\n"
                                "[[cloud]]\ngrid = 'field.txt'\n[[cloud]]\n"
                                "grid = 'cloud.nhdr'\nspacing_m = 50\nbase_height_m = 900\n",
                                kPoint, kVolume, kVolume),
                    "scene.toml", folder_);
  std::string before = Fingerprint(RecordOf(scene));
  for (const NamedFile& file : FilesOf(scene)) {
    WriteText(file.file, ContentOf(file.file) + "\n");
    EXPECT_NE(std::exchange(before, Fingerprint(RecordOf(scene))), Fingerprint(RecordOf(scene)))
        << file.file;
  }
}

}  // namespace
}  // namespace alpenglow::renderer
