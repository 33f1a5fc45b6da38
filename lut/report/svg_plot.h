// SPDX-License-Identifier: MIT
// Log-log plots as SVG text: panels side by side, one line a series, named where it runs.
//
// Colours are those of Okabe and Ito (2008), Color Universal Design, told apart by colour-blind
// readers, with a marker a series for print; lighter ones take over where the reader's system is
// dark. The text stands alone as a file and inside a page.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace alpenglow::lut {

struct PlotPoint {
  double x = 0.0, y = 0.0;  // > 0
  /// Top of a thin line above the point, for instance its 99th percentile.
  std::optional<double> y_high;
  /// Written beside the first and the last point of a series, for instance its size.
  std::string note;
};

struct PlotSeries {
  std::string name;
  int style = 0;       // colour and marker, in [0, kPlotStyles)
  bool faint = false;  // hollow markers and a dashed line: what others do
  std::vector<PlotPoint> points;
};
inline constexpr int kPlotStyles = 7;

/// A line across a panel at a height.
struct PlotLevel {
  std::string name;
  double y = 0.0;
};

struct PlotPanel {
  std::string title;
  std::vector<PlotSeries> series;
  std::vector<PlotLevel> levels;
};

/// How numbers of an axis are written; values are seconds, shares of one, counts or bytes.
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

/// "1.5 µs", "0.1 %", "32", "64 kB": two significant digits, powers of ten short.
[[nodiscard]] std::string QuantityText(double value, PlotUnit unit);

/// `text` with the five characters that XML reserves written as entities.
[[nodiscard]] std::string XmlText(const std::string& text);

/// The plot as one <svg> element, 1080 wide. Points that are not positive and finite are left out.
[[nodiscard]] std::string SvgOfPlot(const Plot& plot);

}  // namespace alpenglow::lut
