// SPDX-License-Identifier: MIT
// This header provides `skylut report`, which compares the speed and the accuracy of methods on
// identical rays in one run.
//
// Every method of a topic (transmittance, light scattered once, all orders, panoramas, refraction)
// is evaluated on one set of rays, drawn once from the distribution of report_rays.h, by day, at
// sunset, in civil and nautical twilight, and from space. The error of a method is its difference
// from the reference solution (reference_solution.h, path_tracer.h). Its cost is memory, the build
// time, and the time of one evaluation on one thread. Methods of the literature, reimplemented from
// their publications (report_baselines.h), are listed beside this library's.
//
// Each topic defines its own quantities and rays. Topics of images (renderer/report/report.h) are
// written into folders of the same form.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/math/error_statistics.h"
#include "atmosphere/medium/medium.h"
#include "lut/cli/messages.h"
#include "lut/image/image.h"
#include "lut/layer.h"

namespace alpenglow::lut {

/// A range of the sun's elevation [degrees].
struct SunRange {
  double lowest_deg, highest_deg;
};

/// Conditions under which every method is measured: a panel of the plots, columns of the tables.
struct ReportRegime {
  const char* key;
  const char* name;
  std::optional<SunRange> sun;  // nullopt: independent of the sun
  // The observer is at kSpaceAltitude_m. The sun's elevation is then that at the lowest point of
  // the ray.
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

/// Result of a method in one regime.
struct RegimeResult {
  ErrorStatistics error;  // of all rays and wavelengths; dark values count as brighter
  /// Errors relative to each value itself, however dark, above kDarkestValue (error_study.h).
  ErrorStatistics strict;
  double time_s = 0.0;       // of one answer (a ray, all wavelengths), fastest pass over the rays
  double time_spread = 0.0;  // median pass over fastest pass, minus 1: noise of the machine
  double samples = 0.0;      // mean number of points of the air per answer; 0: a look-up

  /// Returns whether the method was measured. Some methods do not support all conditions.
  [[nodiscard]] bool IsMeasured() const { return time_s > 0.0; }
};

enum class MethodOrigin { kOurs, kLiterature };

struct ReportRow {
  std::string series;     // methods that differ only in size share a line in the plots
  std::string parameter;  // size or number of steps
  MethodOrigin origin = MethodOrigin::kOurs;
  bool in_summary = false;  // whether summary.md shows the row
  std::uint64_t memory_bytes = 0;
  double build_s = 0.0;  // time to prepare, all threads; 0: no preparation
  std::vector<RegimeResult> at =
      std::vector<RegimeResult>(kReportRegimes);  // indexed by the topic's regimes

  [[nodiscard]] std::string Name() const {
    return parameter.empty() ? series : series + ", " + parameter;
  }
};

/// Reference solution against which errors are measured.
struct ReportReference {
  std::string text;     // description
  double time_s = 0.0;  // of one answer, all threads
  // Rms of its own standard errors, by regime; 0: no noise.
  std::vector<double> noise = std::vector<double>(kReportRegimes);
};

/// Unit of a column of a further table. Biases are fractions of either sign.
enum class ReportUnit { kSeconds, kBytes, kError, kBias };

struct ReportColumn {
  std::string name;
  ReportUnit unit;
};

/// A further table of a topic, for numbers of its methods beside errors and times.
struct ReportTable {
  struct Line {
    std::string method;
    MethodOrigin origin;
    std::vector<std::optional<double>> values;  // of each column; nullopt: an empty cell
  };
  std::string key, title;
  std::vector<ReportColumn> columns;
  std::vector<Line> lines;
};

/// A picture of a topic.
struct ReportPicture {
  std::string key, caption;
  DisplayImage image;
};

/// Quantity on the x axis of a topic's plot.
enum class CostAxis { kTimeOfAnswer, kTimeToBuild };

struct ReportTopic {
  std::string key, title;
  std::string what;        // the quantity that methods compute, in one or two sentences
  std::string error_unit;  // meaning of an error of 1 %
  std::string notes;       // about the methods
  double wanted = 0.01;    // an invisible error: 99 of 100 errors should be below it
  CostAxis cost = CostAxis::kTimeOfAnswer;
  std::string answer = "ray";                   // unit of evaluation
  std::string everywhere = "whatever the sun";  // "in all regimes", in words of the topic
  std::string scene{};                          // scene besides the atmosphere; empty: none
  std::vector<ReportRegime> regimes{kRegimes.begin(), kRegimes.end()};
  Medium medium{};
  std::size_t rays = 0;  // evaluations in each regime
  ReportReference reference{};
  std::vector<ReportRow> rows{};
  std::vector<ReportTable> tables{};
  std::vector<ReportPicture> pictures{};
};

struct ReportOptions {
  std::vector<Medium> mediums;            // one section each
  std::vector<Medium> hard_mediums = {};  // one section each, all orders of scattering
  bool quick = false;                     // few rays, few methods, low accuracy: for tests
  ProgressStyle progress = ProgressStyle::kQuiet;
};

/// Returns the media of a report: the atmosphere of a file, or the presets earth and (unless the
/// report is quick) hazy. Throws the errors of ReadMedium.
[[nodiscard]] std::vector<Medium> MediumsOfReport(const std::optional<std::string>& atmosphere_file,
                                                  bool quick);

/// Description of the machine and of the program.
struct ReportMaker {
  std::string machine, system, program, compiler, date;
};

/// Texts of a page apart from its topics.
struct ReportWords {
  std::string title, lead;
  std::string minute;   // text of the section "In one minute"
  std::string reading;  // how topics are measured; follows the explanation of plots and tables
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

/// Measures all topics, which takes some minutes. Stops between methods if the program is
/// interrupted.
[[nodiscard]] Report MeasureReport(const ReportOptions& options);

}  // namespace alpenglow::lut
