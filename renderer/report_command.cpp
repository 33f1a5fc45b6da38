// SPDX-License-Identifier: MIT
#include "renderer/report_command.h"

#include <memory>
#include <optional>
#include <string>

#include "atmosphere/air/medium.h"
#include "lut/program/output_name.h"
#include "renderer/report/report.h"

namespace alpenglow::renderer {
namespace {

struct PictureReportOptions {
  CommonOptions common;
  std::optional<std::string> atmosphere;
  std::string out;
  bool quick = false;
};

void WriteMeasuredReport(const PictureReportOptions& options) {
  const ThreadLimit threads(options.common.threads);
  const Report report =
      MeasurePictureReport({.mediums = MediumsOfReport(options.atmosphere, options.quick),
                            .quick = options.quick,
                            .progress = options.common.progress_style()});
  WriteReport(report, options.out);
  if (!options.common.quiet) Print(SummaryOf(report));
}

}  // namespace

std::function<void()> AddPictureReportCommand(CLI::App& app) {
  const auto options = std::make_shared<PictureReportOptions>();
  CLI::App& report = *app.add_subcommand(
      "report",
      "Measure the air before mountains, shafts, lamps and whole pictures against slow judges, "
      "error against time: CSV, SVG plots, summary.md and a page, index.html.");
  report.preparse_callback([&app](std::size_t) { app.get_option("--out")->required(false); });
  report.add_option("--out", options->out, "Folder for the report; made when missing")
      ->check(FaultOfFolderName)
      ->required();
  report.add_option("--atmosphere", options->atmosphere,
                    "Atmosphere file (TOML) of the air before mountains; without it the presets "
                    "earth and hazy");
  report.add_flag("--quick", options->quick,
                  "Few rays and small pictures: a test of the report, not of the methods");
  AddCommonOptions(report, "skyseries", options->common);
  report.footer("Example: skyseries report --out report");
  return [options] { WriteMeasuredReport(*options); };
}

}  // namespace alpenglow::renderer
