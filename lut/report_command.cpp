// SPDX-License-Identifier: MIT
#include "lut/report_command.h"

#include <memory>
#include <optional>
#include <string>

#include "atmosphere/air/medium.h"
#include "lut/program/output_name.h"
#include "lut/report/report.h"

namespace alpenglow::lut {
namespace {

struct ReportCommandOptions {
  std::optional<std::string> atmosphere;
  std::string out;
  bool quick = false;
};

void WriteMeasuredReport(const ReportCommandOptions& options, const CommonOptions& common) {
  const Report report = MeasureReport(
      {.mediums = MediumsOfReport(options.atmosphere, options.quick),
       .hard_mediums = options.atmosphere || options.quick ? std::vector<Medium>{} : HardMediums(),
       .quick = options.quick,
       .progress = common.progress_style()});
  WriteReport(report, options.out);
  if (!common.quiet) Print(SummaryOf(report));
}

}  // namespace

Subcommand AddReportCommand(CLI::App& app) {
  const auto options = std::make_shared<ReportCommandOptions>();
  CLI::App& report = *app.add_subcommand(
      "report",
      "Measure every method against the judges, error against time and memory, by day, at sunset "
      "and in twilight: CSV, SVG plots, summary.md and a page, index.html.");
  report.add_option("--out", options->out, "Folder for the report; made when missing")
      ->check(FaultOfFolderName)
      ->required();
  report.add_option("--atmosphere", options->atmosphere,
                    "Atmosphere file (TOML) or preset; without it the presets earth and hazy, and, "
                    "for light of all "
                    "orders, dust, thick haze and thick air");
  report.add_flag("--quick", options->quick,
                  "Few rays and methods, one atmosphere: a test of the report, not of the methods");
  report.footer("Example: skylut report --out report");
  return [options](const CommonOptions& common) { WriteMeasuredReport(*options, common); };
}

}  // namespace alpenglow::lut
