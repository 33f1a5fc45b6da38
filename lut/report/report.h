// SPDX-License-Identifier: MIT
// Speed and accuracy held against each other, on the same rays, in one run: `skylut report`.
//
// Every method of a topic (transmittance, light scattered once, all orders, panoramas, refraction)
// answers the same rays, drawn once from the distribution of report_measure.h, by day, at sunset, in
// civil and nautical twilight, and from space. Its error is the distance to a judge (judge.h, path_tracer.h); its cost is memory,
// the time to get ready, and the time of one answer on one thread. Methods of the literature,
// written anew from their publications (report_baselines.h), stand beside this library's.
//
// What a topic asks, and of what, is the topic's own: those of pictures (renderer/report/report.h)
// are written into folders of the same form.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/air/medium.h"
#include "lut/layer.h"
#include "lut/program/messages.h"
#include "lut/report/svg_plot.h"

namespace alpenglow::lut {

/// A range of the sun's elevation [degrees].
struct SunRange {
  double lowest_deg, highest_deg;
};

/// Conditions under which every method is measured: a panel of the plots, columns of the tables.
struct ReportRegime {
  const char* key;
  const char* name;
  std::optional<SunRange> sun;  // nothing: the sun plays no part
  // Seen from kSpaceAltitude_m; the sun's elevation is then that at the lowest point of the ray.
  bool from_space = false;
};
inline constexpr std::size_t kReportRegimes = 5;
inline constexpr std::array<ReportRegime, kReportRegimes> kRegimes = {{
    {"day", "Day: sun above 5°", SunRange{5.0, 90.0}},
    {"sunset", "Sunset: sun 5° to 0°", SunRange{0.0, 5.0}},
    {"twilight", "Civil twilight: sun 0° to −6°", SunRange{-6.0, 0.0}},
    {"dusk", "Nautical twilight: sun −6° to −12°", SunRange{-12.0, -6.0}},
    {"space", "From space: 400 km, sun above −6°", SunRange{-6.0, 90.0}, true},
}};
inline constexpr double kSpaceAltitude_m = 400e3;

/// Of the errors of all rays and wavelengths of a regime.
struct ErrorStatistics {
  double median = 0.0, rms = 0.0, percentile_99 = 0.0, largest = 0.0;
  /// The judge's own noise hides the error: rms is what it can be at most, about.
  bool rms_is_bound = false;
  /// Relative to each value itself, however dark, above kDarkestValue (report_measure.h). Rms and
  /// percentile_99 count what is dark as brighter (DarkestRadiance).
  double strict_rms = 0.0, strict_percentile_99 = 0.0;
};

/// A method in one regime.
struct RegimeResult {
  ErrorStatistics error;
  double time_s = 0.0;       // of one answer (a ray, all wavelengths), fastest pass over the rays
  double time_spread = 0.0;  // median pass over fastest pass, less 1: how noisy the machine was
  double samples = 0.0;      // points that the air is looked at for an answer, mean; 0: a look-up

  /// Not every method can answer under all conditions.
  [[nodiscard]] bool IsMeasured() const { return time_s > 0.0; }
};

enum class MethodOrigin { kOurs, kLiterature };

struct ReportRow {
  std::string series;     // methods that differ in size alone share a line in the plots
  std::string parameter;  // size or number of steps
  MethodOrigin origin = MethodOrigin::kOurs;
  int style = 0;            // of the line, see PlotSeries
  bool in_summary = false;  // among the few that summary.md shows
  std::uint64_t memory_bytes = 0;
  double build_s = 0.0;  // to get ready, all threads; 0: nothing to do
  std::vector<RegimeResult> at =
      std::vector<RegimeResult>(kReportRegimes);  // by the topic's regimes

  [[nodiscard]] std::string Name() const {
    return parameter.empty() ? series : series + ", " + parameter;
  }
};

/// What errors are measured against.
struct ReportJudge {
  std::string text;     // in words
  double time_s = 0.0;  // of one answer, all threads
  // Rms of its own standard errors, by regime; 0: none.
  std::vector<double> noise = std::vector<double>(kReportRegimes);
};

/// What is on the x axis of a topic's plot.
enum class CostAxis { kTimeOfAnswer, kTimeToBuild };

struct ReportTopic {
  std::string key, title;
  std::string what;        // what is asked of every method, in one or two sentences
  std::string error_unit;  // what an error of 1 % means
  std::string notes;       // about the methods
  double wanted = 0.01;    // an error that nobody sees: 99 of 100 errors should be below it
  CostAxis cost = CostAxis::kTimeOfAnswer;
  std::string answer = "ray";                   // what is answered
  std::string everywhere = "whatever the sun";  // in all regimes, in words
  std::string scene{};  // what else than the atmosphere was looked at; empty: nothing
  std::vector<ReportRegime> regimes{kRegimes.begin(), kRegimes.end()};
  Medium medium{};
  std::size_t rays = 0;  // answers asked for in each regime
  ReportJudge judge{};
  std::vector<ReportRow> rows{};
};

struct ReportOptions {
  std::vector<Medium> mediums;            // one section each
  std::vector<Medium> hard_mediums = {};  // one section each of light of all orders
  bool quick = false;                     // few rays, few methods, little care: for tests
  ProgressStyle progress = ProgressStyle::kQuiet;
};

/// What a report is of when it is asked for by name: the air of a file, or of the presets earth and
/// (unless it is quick) hazy. Throws what ReadMedium does.
[[nodiscard]] std::vector<Medium> MediumsOfReport(const std::optional<std::string>& atmosphere_file,
                                                  bool quick);

/// The dust of Mars, haze of optical depth 1 and molecules of optical depth 5: what a report that is
/// neither quick nor of a file looks at besides.
[[nodiscard]] std::vector<Medium> HardMediums();

/// The machine and the program, in words.
struct ReportMaker {
  std::string machine, system, program, compiler, date;
};

/// What a page says apart from its topics.
struct ReportWords {
  std::string title, lead;
  std::string minute;   // what the section "In one minute" holds
  std::string reading;  // how topics are asked, after what is said of plots and tables
};

struct Report {
  ReportWords words;
  ReportMaker maker;
  double wall_s = 0.0, cpu_s = 0.0;  // of the whole report
  bool quick = false;
  std::vector<ReportTopic> topics{};
};

/// Measures one topic after the other.
using MeasureTopic = std::function<ReportTopic()>;
[[nodiscard]] Report MeasureTopics(ReportWords words, bool quick, ProgressStyle progress,
                                   const std::vector<MeasureTopic>& topics);

/// Measures everything: some minutes. Stops between methods when the program is
/// interrupted.
[[nodiscard]] Report MeasureReport(const ReportOptions& options);

/// The plot of a topic's errors against cost, a panel a regime.
[[nodiscard]] Plot PlotOfTopic(const ReportTopic& topic);

/// Rows of a topic as CSV, one a method and regime, without the header line.
[[nodiscard]] std::string CsvHeader();
[[nodiscard]] std::string CsvOfTopic(const ReportTopic& topic, const ReportMaker& maker);

/// The few rows that a reader wants first, as tables in Markdown.
[[nodiscard]] std::string SummaryOf(const Report& report);

/// The whole report as one page that needs no other file.
[[nodiscard]] std::string PageOf(const Report& report);

/// Writes into the folder, which is made when missing: index.html, summary.md, a CSV a topic, an
/// SVG a plot. Every file is written whole or not at all, index.html last. Throws OutputError.
void WriteReport(const Report& report, const std::filesystem::path& folder);

}  // namespace alpenglow::lut
