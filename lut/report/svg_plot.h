// SPDX-License-Identifier: MIT
// This header provides log-log plots as SVG text: panels side by side, one line per series, and a
// legend below them.
//
// Colours are those of Okabe and Ito (2008), Color Universal Design, which colour-blind readers can
// distinguish, with one marker per series for print. Lighter colours are used if the reader's
// system is in dark mode. The text works as a separate file and embedded in a page.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace alpenglow::lut {

struct PlotPoint {
  double x = 0.0, y = 0.0;  // > 0
  /// Top of a thin line above the point, for instance its 99th percentile.
  std::optional<double> y_high;
  /// Text beside the first and the last point of a series, for instance its size.
  std::string note;
};

struct PlotSeries {
  std::string name;
  bool faint = false;  // hollow markers and a dashed line: methods of others
  std::vector<PlotPoint> points;
};

/// A line across a panel at height `y`.
struct PlotLevel {
  std::string name;
  double y = 0.0;
};

struct PlotPanel {
  std::string title;
  /// Colour and marker of a series follow from its place here, so that all panels of a plot have
  /// the same series in the same order. A series without points is not drawn.
  std::vector<PlotSeries> series;
  std::vector<PlotLevel> levels;
};

/// Format of the numbers of an axis; values are seconds, fractions of one, counts or bytes.
enum class PlotUnit { kSeconds, kShare, kCount, kBytes };

struct PlotAxis {
  std::string title;
  PlotUnit unit = PlotUnit::kShare;
};

struct Plot {
  std::string title, subtitle;
  PlotAxis x, y;
  std::vector<PlotPanel> panels;  // at least one; all share both axes
};

/// Formats a value: "1.5 µs", "0.1 %", "32", "64 kB": two significant digits, powers of ten short.
[[nodiscard]] std::string QuantityText(double value, PlotUnit unit);

/// Returns the plot as one <svg> element, 1080 wide. Points that are not positive and finite are
/// omitted.
[[nodiscard]] std::string SvgOfPlot(const Plot& plot);

}  // namespace alpenglow::lut
