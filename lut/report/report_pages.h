// SPDX-License-Identifier: MIT
// The report as CSV, plots, Markdown and an HTML page.
#pragma once

#include <filesystem>
#include <string>

#include "lut/report/report.h"
#include "lut/report/svg_plot.h"

namespace alpenglow::lut {

/// Returns the plot of a topic's errors against cost, one panel per regime.
[[nodiscard]] Plot PlotOfTopic(const ReportTopic& topic);

/// Return the header line, and the rows of a topic as CSV, one per method and regime, without the
/// header line.
[[nodiscard]] std::string CsvHeader();
[[nodiscard]] std::string CsvOfTopic(const ReportTopic& topic, const ReportMaker& maker);

/// Returns the most important rows as tables in Markdown.
[[nodiscard]] std::string SummaryOf(const Report& report);

/// Returns the whole report as one self-contained page.
[[nodiscard]] std::string PageOf(const Report& report);

/// Writes into the folder, which is created if it is missing: index.html, summary.md, a CSV file
/// per topic and per further table, an SVG file per plot, a PNG file per picture. Every file is written atomically, index.html last. Throws
/// OutputError.
void WriteReport(const Report& report, const std::filesystem::path& folder);

}  // namespace alpenglow::lut
