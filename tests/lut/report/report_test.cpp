// SPDX-License-Identifier: MIT
// The report: what it writes, that its numbers agree with each other, and that they are physics.
// Nothing here asks how long anything takes.
#include "lut/report/report.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <set>

#include "atmosphere/math/constants.h"
#include "lut/image/png.h"
#include "lut/image/svg_elements.h"
#include "lut/multiple_scattering/multiple_scattering.h"
#include "lut/report/report_baselines.h"
#include "lut/report/report_pages.h"
#include "lut/report/report_rays.h"
#include "tests/fixtures/report_files.h"
#include "tests/fixtures/report_rows.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::lut {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// Air of the report: one band takes less time than the usual four, and scalar light less than
/// polarised.
Medium ReportedAir() {
  const Medium air = MediumPreset("earth", {550.0});
  return tests::kSanitized ? InScalarLight(air) : air;
}

/// A quick report, measured once.
const Report& QuickReport() {
  static const Report report = MeasureReport({.mediums = {ReportedAir()}, .quick = true});
  return report;
}

const ReportRow& RowOf(const std::string& topic, const std::string& name) {
  return tests::RowOf(QuickReport(), topic, name);
}

std::string UsualMoments() {
  const MultipleScatteringOptions usual;
  return fmt::format("moments to degree {}, {} x {}", usual.degree, usual.altitudes,
                     usual.sun_angles);
}

class ReportFiles : public TemporaryFolder {};

TEST_F(ReportFiles, ExactlyTheStatedFilesAreWritten) {
  WriteReport(QuickReport(), folder_ / "report");
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder_ / "report"))
    names.insert(entry.path().filename());
  EXPECT_EQ(names,
            (std::set<std::string>{
                "index.html", "summary.md", "transmittance.csv", "single_scattering.csv",
                "all_orders.csv", "panoramas.csv", "refraction.csv", "transmittance.earth.svg",
                "single_scattering.earth.svg", "single_scattering.earth.samples.svg",
                "all_orders.earth.svg", "panoramas.earth.svg", "refraction.earth.svg"}));
}

TEST_F(ReportFiles, ThePageIsSelfContainedAndNamesItsProgram) {
  const std::string page = PageOf(QuickReport());
  for (const char* place : {"@findings@", "@maker@", "@topics@"})
    EXPECT_EQ(page.find(place), std::string::npos) << place;
  for (const char* outside : {"<link", "<script", "<img", "url(", "src="})
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  const ReportMaker& maker = QuickReport().maker;
  for (const std::string& fact : {maker.machine, maker.program, maker.compiler, maker.date})
    EXPECT_THAT(page, HasSubstr(XmlText(fact)));
  EXPECT_THAT(page, HasSubstr(fmt::format("{:016x}", MediumHash(ReportedAir()))));
}

/// Returns a report of one topic with a further table and a picture.
Report ReportWithTableAndPicture() {
  ReportTopic topic;
  topic.key = "made";
  topic.title = "Made: a table";
  topic.scene = "a room";
  topic.medium = ReportedAir();
  topic.regimes = {kRegimes[0]};
  ReportRow row{.series = "ours", .parameter = ""};
  row.at = {{.error = ErrorStatistics({0.01}), .strict = {}, .time_s = 1e-6}};
  topic.rows = {row};
  topic.tables = {{.key = "more",
                   .title = "Made, <more>",
                   .columns = {{"memory", ReportUnit::kBytes},
                               {"rms, all", ReportUnit::kError},
                               {"bias", ReportUnit::kBias}},
                   .lines = {{"ours", MethodOrigin::kOurs, {2e6, 0.05, -0.0314}},
                             {"theirs", MethodOrigin::kLiterature, {0.0, 0.2, {}}}}}};
  topic.reference.noise = {0.0};
  topic.pictures = {{"view", "A <view>", {2, 1, {255, 0, 0, 0, 0, 255}}}};
  Report report{.words = {}, .maker = {}};
  report.topics = {topic};
  return report;
}

TEST_F(ReportFiles, FurtherTablesAreInThePageTheSummaryAndTheirFile) {
  const Report report = ReportWithTableAndPicture();
  const std::string page = PageOf(report);
  EXPECT_THAT(page, HasSubstr("<h4>Made, &lt;more&gt;</h4>"));
  EXPECT_THAT(page, HasSubstr("<td data-csv=\"-0.0314\">-3.1 %</td>"));
  EXPECT_THAT(page, HasSubstr("<td class=\"e3\" data-csv=\"0.05\">5 %</td>"));
  EXPECT_THAT(page, HasSubstr("<td data-csv=\"0\">–</td>")) << "no memory";
  EXPECT_THAT(SummaryOf(report), HasSubstr("| ours | 2 MB | 5 % | -3.1 % |\n"));
  EXPECT_THAT(SummaryOf(report), HasSubstr("| theirs | - | 20 % | |\n"));
  WriteReport(report, folder_ / "made");
  EXPECT_EQ(ContentOf(folder_ / "made" / "made.a-room-earth.more.csv"),
            "method,origin,\"memory\",\"rms, all\",\"bias\"\n"
            "\"ours\",this library,2e+06,0.05,-0.0314\n\"theirs\",literature,0,0.2,\n");
}

TEST_F(ReportFiles, PicturesAreInThePageAndBesideIt) {
  const Report report = ReportWithTableAndPicture();
  WriteReport(report, folder_ / "made");
  const DisplayImage image = ReadPng(folder_ / "made" / "made.a-room-earth.view.png");
  EXPECT_EQ(image.width, 2);
  EXPECT_EQ(image.rgb, report.topics[0].pictures[0].image.rgb);
  const std::string page = PageOf(report);
  EXPECT_THAT(page, HasSubstr("<figcaption>A &lt;view&gt;</figcaption>"));
  const std::string begin = "src=\"data:image/png;base64,iVBORw0KGgo";  // the signature of PNG
  EXPECT_THAT(page, HasSubstr(begin));
  const std::size_t at = page.find(begin), end = page.find('"', at + begin.size());
  const std::size_t digits = end - page.find("base64,", at) - 7;
  const auto bytes = static_cast<std::size_t>(
      std::filesystem::file_size(folder_ / "made" / "made.a-room-earth.view.png"));
  EXPECT_EQ(digits, (bytes + 2) / 3 * 4);
}

TEST_F(ReportFiles, NumbersOfThePageEqualThoseOfTheTables) {
  const std::string page = PageOf(QuickReport());
  std::vector<std::string> shown;
  const std::regex cell("data-csv=\"([^\"]*)\"");
  for (std::sregex_iterator at(page.begin(), page.end(), cell), end; at != end; ++at)
    shown.push_back((*at)[1]);
  std::vector<std::string> expected;
  for (const ReportTopic& topic : QuickReport().topics) {
    const std::vector<std::string> header = CellsOf(LinesOf(CsvHeader())[0]);
    const std::vector<std::string> lines = LinesOf(CsvOfTopic(topic, QuickReport().maker));
    for (std::size_t i = 0; i < lines.size(); i += topic.regimes.size()) {
      double spread = -1.0;
      std::string spread_text;
      for (std::size_t r = 0; r < topic.regimes.size(); ++r) {
        const std::vector<std::string> cells = CellsOf(lines[i + r]);
        ASSERT_EQ(cells.size(), header.size());
        auto value = ValuesByName(header, cells);
        EXPECT_EQ(value["regime"], topic.regimes[r].key);
        if (r == 0) expected.insert(expected.end(), {value["memory_bytes"], value["build_s"]});
        for (const char* name :
             {"time_s", "error_rms", "error_99", "error_max", "error_strict_rms"})
          expected.push_back(value[name]);
        if (std::stod(value["time_spread"]) > spread) {
          spread = std::stod(value["time_spread"]);
          spread_text = value["time_spread"];
        }
      }
      expected.push_back(spread_text);
    }
  }
  EXPECT_EQ(shown, expected);
}

TEST_F(ReportFiles, AFileInPlaceOfTheFolderIsAnOutputError) {
  WriteText(folder_ / "taken", "");
  EXPECT_THROW(WriteReport(QuickReport(), folder_ / "taken"), OutputError);
}

TEST(Report, EveryMethodTakesTimeAndTablesTakeMemory) {
  for (const ReportTopic& topic : QuickReport().topics) {
    EXPECT_GT(topic.reference.time_s, 0.0);
    for (const ReportRow& row : topic.rows) {
      EXPECT_EQ(row.memory_bytes > 0, row.build_s > 0.0) << row.Name();
      EXPECT_EQ(row.memory_bytes > 0, row.series.find("table") != std::string::npos ||
                                          row.series.find("moments") != std::string::npos ||
                                          row.series.find("sky view") == 0)
          << row.Name();
      for (const RegimeResult& at : row.at) {
        EXPECT_GT(at.time_s, 0.0) << row.Name();
        EXPECT_GE(at.time_spread, 0.0) << row.Name();
        EXPECT_LE(at.error.Quantile(0.5), at.error.Quantile(0.99)) << row.Name();
        EXPECT_LE(at.error.Quantile(0.99), at.error.Largest()) << row.Name();
        EXPECT_GT(at.error.Largest(), 0.0) << row.Name() << ": nothing is exact";
      }
    }
  }
}

TEST(Report, MethodsOfThisLibraryKeepTheirErrorBounds) {
  for (const RegimeResult& at : RowOf("transmittance", "closed form, many at once, float").at)
    EXPECT_LT(at.error.Largest(), 1.2e-5) << "tau e^-tau times the bound of the column, 1.2e-5";
  for (const RegimeResult& at : RowOf("transmittance", "table, 256 x 64").at)
    EXPECT_LT(at.error.Largest(), 4e-3) << "bound of TransmittanceTable::Lookup";
  for (const RegimeResult& at : RowOf("panoramas", "sky view, in rows, size chosen").at)
    EXPECT_LT(at.error.Rms(), 3e-3) << "bound of SkyView";
  for (const char* name :
       {"tables of one height", "quadrature over elevation (Auer, Standish 2000)"}) {
    for (const RegimeResult& at : RowOf("refraction", name).at)
      EXPECT_LT(at.error.Largest(), 0.1 / 32.0)
          << "bound of RefractedView and RefractionSeenAt, 0.1'";
  }
  for (const auto& [nodes, most] : {std::pair{6, 1e-2}, std::pair{8, 1e-3}, std::pair{12, 1e-4},
                                    std::pair{16, 1e-5}, std::pair{20, 1e-5}}) {
    for (const RegimeResult& at :
         RowOf("single_scattering", fmt::format("Gauss, {} nodes", nodes)).at)
      EXPECT_LT(at.error.Rms(), most) << nodes << " nodes";
  }
}

TEST(Report, MoreEffortGivesLessError) {
  const auto rms = [](const char* topic, const char* name, std::size_t regime) {
    return RowOf(topic, name).at[regime].error.Rms();
  };
  for (std::size_t r = 0; r < kReportRegimes; ++r) {
    EXPECT_LT(rms("single_scattering", "Gauss, 12 nodes", r),
              rms("single_scattering", "Gauss, 4 nodes", r));
    EXPECT_LT(rms("single_scattering", "uniform march, 512 steps", r),
              rms("single_scattering", "uniform march, 16 steps", r));
    EXPECT_LT(rms("single_scattering", "quadratic march, 512 steps", r),
              rms("single_scattering", "quadratic march, 16 steps", r));
    EXPECT_LT(rms("transmittance", "table, 256 x 64", r),
              rms("transmittance", "table, 64 x 16", r));
    EXPECT_LT(rms("transmittance", "midpoint march, 160 steps", r),
              rms("transmittance", "midpoint march, 10 steps", r));
    // First-order truth: light of higher orders is there, and it is not isotropic.
    EXPECT_GT(rms("all_orders", "single scattering only", r), 0.1);
    EXPECT_LT(rms("all_orders", "isotropic table (Hillaire 2020), 32 x 32, 64 directions", r),
              rms("all_orders", "single scattering only", r));
    EXPECT_LT(rms("all_orders", UsualMoments().c_str(), r),
              rms("all_orders", "isotropic table (Hillaire 2020), 32 x 32, 64 directions", r));
  }
}

TEST(Report, NoiseOfTheReferenceIsSubtractedFromErrors) {
  const std::vector<ReferenceValue> references(4, {{2.0}, {0.02}, {2.0}});
  const auto statistics = [&](double off) {
    return ErrorsOf(references, {{2.0 + off}, {2.0 - off}, {2.0 + off}, {2.0}});
  };
  // Errors 5, 5, 5, 0 %; noise 1 %.
  EXPECT_NEAR(statistics(0.1).Rms(), std::sqrt(0.75 * 0.0025 - 0.0001), 1e-9);
  EXPECT_FALSE(statistics(0.1).RmsIsBound());
  EXPECT_NEAR(statistics(0.1).Largest(), 0.05, 1e-9);
  EXPECT_TRUE(statistics(0.001).RmsIsBound());
  EXPECT_NEAR(statistics(0.001).Rms(), 0.005, 1e-9) << "half of the noise, as a bound";
}

TEST(Report, DarkDirectionsAreRelativeToTheZenith) {
  const std::vector<ReferenceValue> references{RadianceReference({1e-6}, {}, {1e-3})};
  const std::vector<std::vector<double>> answers{{1.1e-5}};
  EXPECT_NEAR(ErrorsOf(references, answers).Largest(), 0.01, 1e-9);
  EXPECT_NEAR(StrictErrorsOf(references, answers).Rms(), 10.0, 1e-9)
      << "relative to the direction's own light";
}

TEST(ReportRays, AreInTheirRegimeAndMeetAir) {
  const Medium medium = MediumPreset("earth");
  for (const ReportRegime& regime : kRegimes) {
    int down = 0;
    for (int i = 1; i <= 600; ++i) {
      for (const ViewRay& ray : {ViewNumber(medium, i, regime), SunbeamNumber(medium, i, regime)}) {
        if (regime.from_space) continue;
        const double elevation_deg = std::asin(ray.mu_s) / kRadiansPerDegree;
        EXPECT_GE(elevation_deg, regime.sun->lowest_deg - 1e-6);
        EXPECT_LE(elevation_deg, regime.sun->highest_deg + 1e-6);
      }
      const auto end = [&](const ViewRay& ray) {
        return ExtentOf(ray, medium.planet_radius_m, medium.atmosphere_height_m).end;
      };
      EXPECT_EQ(end(SunbeamNumber(medium, i, regime)), RayEnd::kSpace)
          << "beams come from the sun, not through the planet";
      if (end(ViewNumber(medium, i, regime)) == RayEnd::kGround) ++down;
    }
    EXPECT_NEAR(down, regime.from_space ? 300 : 150, 15) << regime.key;
  }
}

TEST(ReportRays, FromSpaceHaveTheSunAboveTheirLowestPoint) {
  const Medium medium = MediumPreset("earth");
  const ReportRegime& space = kRegimes.back();
  ASSERT_TRUE(space.from_space);
  const double radius_m = medium.planet_radius_m;
  for (int i = 1; i <= 200; ++i) {
    const ViewRay ray = ViewNumber(medium, i, space);
    const double r = radius_m + ray.altitude_m;
    const RayExtent extent = ExtentOf(ray, radius_m, medium.atmosphere_height_m);
    ASSERT_GT(extent.end_m, extent.begin_m) << "it meets air";
    const double low_m = extent.end == RayEnd::kGround ? extent.end_m : -r * ray.mu;
    const double low_r = std::sqrt(r * r + low_m * (low_m + 2.0 * r * ray.mu));
    const double elevation_deg =
        std::asin((r * ray.mu_s + low_m * ray.nu) / low_r) / kRadiansPerDegree;
    EXPECT_GE(elevation_deg, space.sun->lowest_deg - 1e-6);
    EXPECT_LE(elevation_deg, space.sun->highest_deg + 1e-6);
  }
}

TEST(ReportBaselines, ChapmanApproximationsAreAsGoodAsPublished) {
  // The publications compare themselves with one exponential of 8 km; only its height matters.
  Medium medium = MediumPreset("earth");
  medium.rayleigh_scale_height_m = 8000.0;
  medium.rayleigh_deficit = {};
  const SingleScattering<double> air(medium);
  const double radius_m = air.medium().planet_radius_m;
  for (const double mu : {0.0, 0.02, 0.1, 0.3, 1.0}) {
    const double column_m = air.ColumnsToSpace(0.0, mu)[0];
    const auto x = static_cast<float>(radius_m / 8000.0);
    const auto ratio = [&](ChapmanRule rule) {
      return 8000.0 * double{ChapmanFunction(rule, x, static_cast<float>(mu))} / column_m;
    };
    // Both miss by what lies above the top, 3e-7, and by their own: 3.4e-3 and 15 % at the worst
    // height and angle.
    EXPECT_NEAR(ratio(ChapmanRule::kGolubev), 1.0, 4e-3) << mu;
    EXPECT_NEAR(ratio(ChapmanRule::kSchueler), 1.0, 0.16) << mu;
  }
}

TEST(ReportBaselines, FiveHundredTrapezoidsAgreeWithTheClosedForm) {
  for (const char* name : {"earth", "bruneton2017"}) {
    const SingleScattering<float> air(MediumPreset(name));
    for (const double mu : {0.05, 0.2, 1.0}) {
      const Spectrum closed = air.TransmittanceToSpace(0.0, mu);
      const Spectrum march =
          MarchedTransmittance(air.medium(), {0.0, mu}, MarchRule::kTrapezoid, 500);
      // The trapezoid's own error, (step / scale height)^2 / 12 of the aerosol's depth.
      for (std::size_t band = 0; band < air.bands(); ++band)
        EXPECT_NEAR(march[band], closed[band], 5e-4F) << name << " " << mu;
    }
  }
}

}  // namespace
}  // namespace alpenglow::lut
