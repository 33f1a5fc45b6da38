// SPDX-License-Identifier: MIT
// The report of pictures: its files, and that its numbers are physics. No test measures time.
#include "renderer/report/report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lut/image/svg_elements.h"
#include "lut/report/report_pages.h"
#include "tests/fixtures/bare_scene.h"
#include "tests/fixtures/report_files.h"
#include "tests/fixtures/report_rows.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::renderer {
namespace {

namespace fs = std::filesystem;

/// Returns a quick report of the default air, measured once.
const Report& QuickReport() {
  static const Report report =
      MeasurePictureReport({.mediums = {QuickMedium("earth")}, .quick = true});
  return report;
}

const ReportRow& RowOf(std::string_view topic, std::string_view name) {
  return tests::RowOf(QuickReport(), topic, name);
}

constexpr const char* kTwoStreams = "two streams (Joseph et al. 1976)";
constexpr const char* kManyBeams = "beams, 1e4 photons, radius 1";
constexpr const char* kManyPoints = "points (Jarosz et al. 2008), 1e5 photons, radius 2";
constexpr const char* kEyePaths = "paths from the eye: find wide light only, 1004 paths";

void ExpectLessErrorEverywhere(const char* topic, const char* better, const char* worse) {
  const ReportRow& good = RowOf(topic, better);
  const ReportRow& bad = RowOf(topic, worse);
  for (std::size_t r = 0; r < good.at.size(); ++r) {
    if (!good.at[r].IsMeasured() || !bad.at[r].IsMeasured()) continue;
    // If the sun is below -6 degrees, no air before mountains is lit.
    if (topic == std::string("aerial_perspective") && good.at[r].error.Largest() == 0.0) continue;
    EXPECT_LT(good.at[r].error.Rms(), bad.at[r].error.Rms())
        << topic << ": " << better << " against " << worse << ", column " << r;
  }
}

class PictureReportFiles : public TemporaryFolder {};

TEST_F(PictureReportFiles, EveryTopicHasATableAndAPlot) {
  WriteReport(QuickReport(), folder_ / "report");
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder_ / "report"))
    names.insert(entry.path().filename());
  for (const char* file : {"index.html", "summary.md"}) EXPECT_EQ(names.count(file), 1U) << file;
  for (const char* key : {"aerial_perspective", "terrain_transmittance", "shafts", "clouds",
                          "layers", "volumes", "caustics", "airlight", "many_lamps", "pictures"}) {
    EXPECT_EQ(names.count(std::string(key) + ".csv"), 1U) << key;
    EXPECT_EQ(std::count_if(names.begin(), names.end(),
                            [&](const std::string& name) {
                              return name.rfind(std::string(key) + ".", 0) == 0 &&
                                     name.size() > 4 && name.substr(name.size() - 4) == ".svg" &&
                                     name.find(".samples.") == std::string::npos;
                            }),
              1)
        << key;
  }
}

TEST_F(PictureReportFiles, LinesHaveAllColumnsAndFiniteNumbers) {
  const std::vector<std::string> header = CellsOf(LinesOf(CsvHeader())[0]);
  for (const ReportTopic& topic : QuickReport().topics) {
    const std::vector<std::string> lines = LinesOf(CsvOfTopic(topic, QuickReport().maker));
    EXPECT_FALSE(lines.empty()) << topic.key;
    for (const std::string& line : lines) {
      const std::vector<std::string> cells = CellsOf(line);
      ASSERT_EQ(cells.size(), header.size()) << line;
      auto value = ValuesByName(header, cells);
      for (const char* name :
           {"memory_bytes", "build_s", "rays", "samples", "time_s", "time_spread", "error_median",
            "error_rms", "error_99", "error_max", "reference_noise"}) {
        const double number = std::stod(value[name]);
        EXPECT_TRUE(std::isfinite(number) && number >= 0.0) << name << " in " << line;
      }
    }
  }
}

TEST_F(PictureReportFiles, ThePageHasEverySectionAndNeedsNoOtherFile) {
  const std::string page = PageOf(QuickReport());
  for (const ReportTopic& topic : QuickReport().topics)
    EXPECT_NE(page.find(XmlText(topic.title)), std::string::npos) << topic.title;
  for (const char* outside : {"<link", "<script", "url(", ">nan", ">inf", "@reading@"})
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  EXPECT_EQ(CountOf(page, "src="), CountOf(page, "src=\"data:image/png;base64,"));
  EXPECT_GT(CountOf(page, "src="), 0U) << "pictures of clouds";
}

TEST(PictureReport, MoreEffortGivesLessError) {
  const char* const uniform[] = {"uniform march, 128 steps", "uniform march, 8 steps"};
  for (const auto& [topic, better, worse] : std::vector<std::array<const char*, 3>>{
           {"aerial_perspective", "direct integration, automatic", "direct integration, at most 2"},
           {"aerial_perspective", uniform[0], uniform[1]},
           {"aerial_perspective", "quadratic march, 128 steps", "quadratic march, 8 steps"},
           {"terrain_transmittance", uniform[0], uniform[1]},
           {"shafts", "occlusion rays, 256 rays", "occlusion rays, 16 rays"},
           {"shafts", "shadow heights, automatic nodes", "no shafts"},
           {"airlight", "panels around the light, 32 nodes", "panels around the light, 8 nodes"},
           {"airlight", "uniform march, 256 points", "uniform march, 16 points"},
           {"layers", "discrete ordinates, 4 streams", "discrete ordinates, 2 streams"},
           {"layers", "discrete ordinates, 8 streams", "discrete ordinates, 4 streams"},
           {"layers", "discrete ordinates, 12 streams", "discrete ordinates, 8 streams"},
           {"layers", "discrete ordinates, 4 streams", kTwoStreams},
           {"volumes", "moments on cells, 4096 cells", "moments on cells, 512 cells"},
           {"volumes", "moments on cells, 512 cells", "single scattering"},
           {"volumes", "path tracing, 256 paths", "path tracing, 16 paths"},
           {"caustics", kManyBeams, "beams, 1e3 photons, radius 1"},
           {"caustics", kManyPoints, "points (Jarosz et al. 2008), 1e4 photons, radius 2"},
           {"caustics", kManyPoints, kEyePaths},
           {"pictures", "samples of a pixel, 4", "without higher orders"}})
    ExpectLessErrorEverywhere(topic, better, worse);
}

TEST(PictureReport, AirBeforeMountainsKeepsItsErrorAtEverySun) {
  for (const RegimeResult& at : RowOf("aerial_perspective", "direct integration, automatic").at) {
    EXPECT_LT(at.error.Rms(), 1e-3) << "to 100 km in clear air";
    EXPECT_LT(at.error.Quantile(0.99), 5e-3);
  }
}

TEST(PictureReport, OneGreyTransmittanceIsWrongByPercents) {
  for (const RegimeResult& at : RowOf("terrain_transmittance", "closed form, one grey value").at)
    EXPECT_GT(at.error.Rms(), 0.01) << "the air of 100 km is not grey";
  for (const RegimeResult& at : RowOf("terrain_transmittance", "closed form, float").at)
    EXPECT_LT(at.error.Rms(), 1e-5);
}

TEST(PictureReport, ClosedFormOfSunEtAlNeedsUniformIsotropicFog) {
  const ReportRow& row = RowOf("airlight", "Sun et al. (2005)");
  EXPECT_TRUE(row.at[0].IsMeasured());
  EXPECT_LT(row.at[0].error.Rms(), 1e-6);
  for (std::size_t r = 1; r < row.at.size(); ++r) EXPECT_FALSE(row.at[r].IsMeasured());
}

/// Returns a cell of a further table of a topic.
std::optional<double> CellOf(std::string_view topic, std::string_view key, std::string_view method,
                             std::string_view column) {
  for (const ReportTable& table : tests::TopicOf(QuickReport(), topic).tables) {
    if (table.key != key) continue;
    for (const ReportTable::Line& line : table.lines) {
      for (std::size_t i = 0; i < table.columns.size(); ++i) {
        if (line.method == method && table.columns[i].name == column) return line.values.at(i);
      }
    }
  }
  throw InternalError("no number " + std::string(method) + ", " + std::string(column));
}

/// Returns a number of a further table of clouds under a sun.
double NumberOf(std::string_view sun, std::string_view method, std::string_view column) {
  return CellOf("clouds", sun, method, column).value();
}

TEST(PictureReport, CloudsNeedLightOfAllOrders) {
  constexpr const char* kFitted = "moments on cells, fitted factor";
  for (const char* sun : {"sun35", "sun12"}) {
    EXPECT_LT(NumberOf(sun, "single scattering", "sun: bias"), -0.5) << sun;
    for (const char* other : {"single scattering", "octaves (Wrenninge et al. 2013), 8"}) {
      EXPECT_LT(NumberOf(sun, kFitted, "sun: rms"), NumberOf(sun, other, "sun: rms")) << sun;
      EXPECT_LT(NumberOf(sun, kFitted, "whole: rms"), NumberOf(sun, other, "whole: rms")) << sun;
    }
    EXPECT_LT(NumberOf(sun, "path tracing, 251 paths", "sun: rms"),
              NumberOf(sun, "path tracing, 16 paths", "sun: rms"));
    // Two hundred pixels of 251 paths each scatter by a hundredth in their sum.
    EXPECT_NEAR(NumberOf(sun, "path tracing, 251 paths", "sun: bias"), 0.0, 0.05) << sun;
    EXPECT_EQ(NumberOf(sun, "path tracing, 251 paths", "memory"), 0.0);
  }
}

TEST(PictureReport, EveryMethodOfCloudsHasItsPictureAndItsErrors) {
  for (const char* key : {"clouds", "volumes"}) {
    const ReportTopic& topic = tests::TopicOf(QuickReport(), key);
    EXPECT_EQ(topic.pictures.size(), 2 * (topic.rows.size() + 1)) << key;
  }
  // The four maps of photons and the reference; paths from the eye are dark.
  EXPECT_EQ(tests::TopicOf(QuickReport(), "caustics").pictures.size(), 2U * (4 + 1));
}

TEST(PictureReport, FurtherTablesHaveALineForEveryMethod) {
  for (const char* key : {"clouds", "layers", "volumes", "caustics"}) {
    const ReportTopic& topic = tests::TopicOf(QuickReport(), key);
    EXPECT_FALSE(topic.tables.empty()) << key;
    for (const ReportTable& table : topic.tables) {
      EXPECT_EQ(table.lines.size(), topic.rows.size()) << key;
      for (const ReportTable::Line& line : table.lines) {
        ASSERT_EQ(line.values.size(), table.columns.size()) << key;
        for (const std::optional<double>& value : line.values)
          EXPECT_TRUE(std::isfinite(value.value_or(0.0))) << key << ", " << line.method;
      }
    }
  }
}

TEST(PictureReport, EightStreamsKeepTheirBoundsAtEveryDepth) {
  // The bounds of LayerField: renderer/layers/layer_field.h.
  const ReportRow& row = RowOf("layers", "discrete ordinates, 8 streams");
  const ReportTopic& layers = tests::TopicOf(QuickReport(), "layers");
  for (std::size_t r = 0; r < row.at.size(); ++r) {
    EXPECT_LT(row.at[r].error.Rms(), 0.01) << layers.regimes[r].name;
    EXPECT_LT(row.at[r].error.Quantile(0.95), 0.04) << "99 of 100 of all depths together";
    const std::string flux = std::string("flux at ") + layers.regimes[r].key + ": largest";
    EXPECT_LT(CellOf("layers", "fluxes", row.Name(), flux).value(), 0.0015);
    // Eddington's approximation errs by percents, in the literature by up to a tenth.
    const double two = CellOf("layers", "fluxes", kTwoStreams, flux).value();
    EXPECT_GT(two, 0.01);
    EXPECT_LT(two, 0.1);
  }
}

TEST(PictureReport, VolumesHaveLightOfAllOrders) {
  constexpr const char* kMoments = "moments on cells, 4096 cells";
  // The bounds of VolumeOrders are 6 and 9 % with cells of the plume's structures; those of the quick
  // report are coarser, and its rays and paths scatter by some hundredths.
  for (const auto& [depth, most_rms] : {std::pair{"depth10", 0.12}, {"depth50", 0.18}}) {
    EXPECT_LT(CellOf("volumes", depth, kMoments, "whole: rms").value(), most_rms);
    EXPECT_LT(CellOf("volumes", depth, kMoments, "whole: median").value(), most_rms);
    EXPECT_LT(std::abs(CellOf("volumes", depth, kMoments, "whole: bias").value()), most_rms);
    EXPECT_LT(CellOf("volumes", depth, "single scattering", "whole: bias").value(), -0.5);
    // The scatter of paths is their own standard error; 30 rays know it to a fifth.
    for (const char* paths : {"path tracing, 16 paths", "path tracing, 256 paths"}) {
      const double error = CellOf("volumes", depth, paths, "standard error").value();
      EXPECT_GT(CellOf("volumes", depth, paths, "whole: rms").value(), 0.4 * error) << paths;
      EXPECT_LT(CellOf("volumes", depth, paths, "whole: rms").value(), 2.5 * error) << paths;
    }
    EXPECT_FALSE(CellOf("volumes", depth, kMoments, "standard error").has_value());
    EXPECT_GT(CellOf("volumes", depth, kMoments, "memory").value(),
              CellOf("volumes", depth, "moments on cells, 512 cells", "memory").value());
  }
}

TEST(PictureReport, PathsFromTheEyeFindOnlyWideLightBehindGlass) {
  for (const char* kind : {"isotropic", "forward"}) {
    EXPECT_EQ(CellOf("caustics", kind, kEyePaths, "bias").value(), -1.0) << kind;
    EXPECT_EQ(CellOf("caustics", kind, kEyePaths, "standard error").value(), 0.0) << kind;
  }
  const double error = CellOf("caustics", "wide", kEyePaths, "standard error").value();
  EXPECT_GT(error, 0.0);
  EXPECT_LT(CellOf("caustics", "wide", kEyePaths, "rms").value(), 2.0 * error);
  // The mean of 60 pixels, each of which scatters by its own light and half.
  EXPECT_NEAR(CellOf("caustics", "wide", kEyePaths, "bias").value(), 0.0, 0.6);
}

TEST(PictureReport, BeamsHaveTheLightOfTheCaustic) {
  // A tenth of the beams of the bounds of renderer/specular/README.md, with three times their noise.
  EXPECT_LT(CellOf("caustics", "isotropic", kManyBeams, "median").value(), 0.06);
  EXPECT_LT(CellOf("caustics", "isotropic", kManyBeams, "focus").value(), 0.27);
  EXPECT_LT(CellOf("caustics", "forward", kManyBeams, "median").value(), 0.15);
  EXPECT_LT(CellOf("caustics", "wide", kManyBeams, "median").value(), 0.15);
  for (const char* kind : {"isotropic", "forward", "wide"}) {
    EXPECT_LT(std::abs(CellOf("caustics", kind, kManyBeams, "bias").value()), 0.06) << kind;
    EXPECT_GT(CellOf("caustics", kind, kManyBeams, "memory").value(), 1e6) << "beams, and a tree";
  }
}

TEST(PictureReport, SamplesOfAirlightIncludeThoseThatOnlyProbe) {
  const ReportRow& row = RowOf("airlight", "panels around the light, 16 nodes");
  for (const RegimeResult& at : row.at) EXPECT_GT(at.samples, 16.0);
}

}  // namespace
}  // namespace alpenglow::renderer
