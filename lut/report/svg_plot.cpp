// SPDX-License-Identifier: MIT
#include "lut/report/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "atmosphere/base/error.h"
#include "lut/image/svg_elements.h"
#include "lut/layer.h"

namespace alpenglow::lut {
namespace {

constexpr double kWidth = 1080.0;
constexpr double kPanelHeight = 330.0;
constexpr double kLeft = 62.0, kRight = 14.0, kTop = 76.0, kBottom = 52.0, kGap = 18.0;
constexpr std::size_t kColourCount = 7;
constexpr double kLegendRow = 18.0, kLegendSize = 12.0;

struct Box {
  double x0 = 0.0, y0 = 0.0, x1 = 0.0, y1 = 0.0;
};

bool Drawable(const PlotPoint& point) {
  return std::isfinite(point.x) && std::isfinite(point.y) && point.x > 0.0 && point.y > 0.0;
}

/// A logarithmic axis whose range holds all values.
struct Decades {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void Hold(double value) {
    low = std::min(low, std::log10(value));
    high = std::max(high, std::log10(value));
  }
  /// Adds a margin of about a tenth of a decade around the values.
  void Close() {
    if (low > high) low = high = 0.0;
    low -= 0.12;
    high += 0.12;
    if (high - low < 1.0) {
      const double middle = 0.5 * (low + high);
      low = middle - 0.5;
      high = middle + 0.5;
    }
  }
  [[nodiscard]] double Share(double value) const {
    return (std::log10(value) - low) / (high - low);
  }
};

/// Position of a panel on the sheet, and the axes that all panels share.
struct Frame {
  Box area;
  Decades x, y;

  [[nodiscard]] double X(double value) const {
    return area.x0 + x.Share(value) * (area.x1 - area.x0);
  }
  [[nodiscard]] double Y(double value) const {
    return area.y1 - y.Share(value) * (area.y1 - area.y0);
  }
};

/// Estimates the width of a text without font metrics: a little more than that of bold Helvetica.
double TextWidth(const std::string& text, double size) {
  const auto letters = std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;  // no continuation bytes of UTF-8
  });
  return 0.6 * size * static_cast<double>(letters);
}

/// Returns a text of a class of the style sheet.
std::string TextElement(double x, double y, const std::string& kind, const std::string& text,
                        const std::string& more = "") {
  return SvgText({x, y}, fmt::format("class=\"{}\"{}", kind, more), text);
}

/// Returns a line of a class of the style sheet.
std::string LineElement(double x0, double y0, double x1, double y1, const std::string& kind) {
  return SvgLine({x0, y0}, {x1, y1}, fmt::format("class=\"{}\"", kind));
}

std::string StyleSheet() {
  constexpr std::array<std::array<const char*, 2>, kColourCount> kColours = {{
      {"#0072b2", "#56b4e9"},
      {"#d55e00", "#ff8c42"},
      {"#009e73", "#2fd6a3"},
      {"#b0568c", "#e39bc6"},
      {"#b87f00", "#f0c04a"},
      {"#5b5b5b", "#b8b8b8"},
      {"#4b3fa7", "#a79bff"},
  }};
  const auto colours = [&](std::size_t shade) {
    std::string text;
    for (std::size_t i = 0; i < kColours.size(); ++i)
      text += fmt::format(".p .c{} {{color:{}}}\n", i, kColours[i][shade]);
    return text;
  };
  return "<style>\n"
         ".p {font-family:Helvetica,Arial,'Liberation Sans',sans-serif; font-size:11px}\n"
         ".p text {fill:#222}\n"
         ".p .title {font-size:16px; font-weight:bold}\n"
         ".p .subtitle {font-size:12px; fill:#555}\n"
         ".p .panel {font-size:11px; font-weight:bold}\n"
         ".p .tick {fill:#555}\n"
         ".p .axis {fill:#333; font-size:12px}\n"
         ".p text.name {font-size:12px; font-weight:bold; fill:currentColor}\n"
         ".p text.note {font-size:9.5px; fill:currentColor; stroke:#fff; "
         "stroke-width:2.5px; paint-order:stroke}\n"
         ".p .sheet {fill:#fff}\n"
         ".p .grid {stroke:#e4e4e4; stroke-width:1}\n"
         ".p .frame {stroke:#999; stroke-width:1; fill:none}\n"
         ".p .level {stroke:#888; stroke-width:1; stroke-dasharray:2 3}\n"
         ".p .run {stroke:currentColor; stroke-width:2; fill:none}\n"
         ".p .faint .run {stroke-width:1.5; stroke-dasharray:6 3}\n"
         ".p .tail {stroke:currentColor; stroke-width:1; opacity:.45}\n"
         ".p .mark {fill:currentColor; stroke:currentColor; stroke-width:1.3}\n"
         ".p .faint .mark {fill:#fff}\n" +
         colours(0) +
         "@media (prefers-color-scheme: dark) {\n"
         ".p text {fill:#e6e6e6}\n.p .subtitle,.p .tick {fill:#aaa}\n.p .axis {fill:#ccc}\n"
         ".p .sheet {fill:#15181c}\n.p .grid {stroke:#2b3036}\n.p .frame {stroke:#666}\n"
         ".p .faint .mark {fill:#15181c}\n.p text.note {stroke:#15181c}\n" +
         colours(1) + "}\n</style>\n";
}

/// Returns a mark at (x, y): a disk, a triangle, a square or a diamond.
std::string Marker(std::size_t series, double x, double y) {
  constexpr std::array<const char*, 4> kShapes{"m-3.6 0a3.6 3.6 0 1 0 7.2 0a3.6 3.6 0 1 0 -7.2 0z",
                                               "m0 -4.3l4 7.2h-7.9z", "m-3.2 -3.2h6.5v6.5h-6.5z",
                                               "m0 -4.7l4.7 4.7l-4.7 4.7l-4.7 -4.7z"};
  return fmt::format("<path class=\"mark\" d=\"M{:.1f} {:.1f}{}\"/>\n", x, y,
                     kShapes[series % kShapes.size()]);
}

std::vector<PlotPoint> DrawablePoints(const PlotSeries& series) {
  std::vector<PlotPoint> points;
  std::copy_if(series.points.begin(), series.points.end(), std::back_inserter(points), Drawable);
  return points;
}

/// Returns small ticks at 2, 3, ... 9 times the powers of ten of the x axis.
std::string MinorTicks(const Frame& frame) {
  std::string text;
  for (int decade = static_cast<int>(std::floor(frame.x.low)); decade <= frame.x.high; ++decade) {
    for (int digit = 2; digit < 10; ++digit) {
      const double at = frame.X(digit * std::pow(10.0, decade));
      if (at > frame.area.x0 && at < frame.area.x1)
        text += LineElement(at, frame.area.y1 - 4.0, at, frame.area.y1, "frame");
    }
  }
  return text;
}

/// Returns grid, ticks and frame of a panel. Every panel has x ticks, the first panel also y ticks.
std::string FrameText(const Frame& frame, const Plot& plot, bool first) {
  std::string text;
  const auto whole = [](double value) { return static_cast<int>(value); };
  const int x_stride = frame.x.high - frame.x.low > 7.0 ? 2 : 1;
  for (int decade = whole(std::ceil(frame.x.low)); decade <= whole(std::floor(frame.x.high));
       ++decade) {
    const double at = frame.X(std::pow(10.0, decade));
    text += LineElement(at, frame.area.y0, at, frame.area.y1, "grid");
    if (decade % x_stride == 0)
      text +=
          TextElement(at, frame.area.y1 + 16.0, "tick",
                      QuantityText(std::pow(10.0, decade), plot.x.unit), " text-anchor=\"middle\"");
  }
  for (int decade = whole(std::ceil(frame.y.low)); decade <= whole(std::floor(frame.y.high));
       ++decade) {
    const double at = frame.Y(std::pow(10.0, decade));
    text += LineElement(frame.area.x0, at, frame.area.x1, at, "grid");
    if (first)
      text +=
          TextElement(frame.area.x0 - 6.0, at + 4.0, "tick",
                      QuantityText(std::pow(10.0, decade), plot.y.unit), " text-anchor=\"end\"");
  }
  return text + MinorTicks(frame) +
         fmt::format(
             "<rect class=\"frame\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" "
             "height=\"{:.1f}\"/>\n",
             frame.area.x0, frame.area.y0, frame.area.x1 - frame.area.x0,
             frame.area.y1 - frame.area.y0);
}

/// Returns the start of a group of elements in the colour and the kind of line of series `i`.
std::string GroupOf(std::size_t i, const PlotSeries& series) {
  return fmt::format("<g class=\"c{}{}\">\n", i % kColourCount, series.faint ? " faint" : "");
}

std::string SeriesText(const Frame& frame, std::size_t i, const PlotSeries& series) {
  const std::vector<PlotPoint> points = DrawablePoints(series);
  std::string text = GroupOf(i, series);
  std::vector<SvgPoint> run;
  for (const PlotPoint& point : points) {
    const double x = frame.X(point.x), y = frame.Y(point.y);
    run.push_back({x, y});
    if (point.y_high && *point.y_high > point.y)
      text += LineElement(x, y, x, frame.Y(*point.y_high), "tail");
    const bool is_end = &point == &points.front() || &point == &points.back();
    if (is_end && points.size() > 1 && !point.note.empty())
      text += x < 0.5 * (frame.area.x0 + frame.area.x1)
                  ? TextElement(x + 6.0, y - 5.0, "note", point.note)
                  : TextElement(x - 6.0, y - 5.0, "note", point.note, " text-anchor=\"end\"");
  }
  if (run.size() > 1) text += SvgPolyline(run, "class=\"run\"");
  for (const PlotPoint& point : points) text += Marker(i, frame.X(point.x), frame.Y(point.y));
  return text + "</g>\n";
}

std::string PanelText(const Frame& frame, const Plot& plot, const PlotPanel& panel, bool first) {
  std::string text = FrameText(frame, plot, first);
  text += TextElement(frame.area.x0, frame.area.y0 - 8.0, "panel", panel.title);
  for (const PlotLevel& level : panel.levels) {
    const double at = frame.Y(level.y);
    text += LineElement(frame.area.x0, at, frame.area.x1, at, "level") +
            TextElement(frame.area.x1 - 4.0, at - 3.0, "tick", level.name, " text-anchor=\"end\"");
  }
  for (std::size_t i = 0; i < panel.series.size(); ++i)
    text += SeriesText(frame, i, panel.series[i]);
  return text;
}

/// The marks and names of the series that have points, in rows below the panels.
struct Legend {
  std::string text;
  double height = kLegendRow;
};

Legend LegendBelow(const Plot& plot, double top) {
  Legend legend;
  double x = kLeft;
  for (std::size_t i = 0; i < plot.panels.front().series.size(); ++i) {
    const PlotSeries& series = plot.panels.front().series[i];
    if (std::all_of(plot.panels.begin(), plot.panels.end(), [i](const PlotPanel& panel) {
          return DrawablePoints(panel.series[i]).empty();
        }))
      continue;
    const double width = TextWidth(series.name, kLegendSize) + 36.0;
    if (x > kLeft && x + width > kWidth - kRight) {
      x = kLeft;
      legend.height += kLegendRow;
    }
    const double y = top + legend.height - 0.5 * kLegendRow;
    legend.text += GroupOf(i, series) + Marker(i, x + 6.0, y) +
                   TextElement(x + 16.0, y + 4.0, "name", series.name) + "</g>\n";
    x += width;
  }
  return legend;
}

Frame SharedAxes(const Plot& plot) {
  Frame frame;
  for (const PlotPanel& panel : plot.panels) {
    for (const PlotSeries& series : panel.series) {
      for (const PlotPoint& point : DrawablePoints(series)) {
        frame.x.Hold(point.x);
        frame.y.Hold(point.y);
        if (point.y_high) frame.y.Hold(std::max(*point.y_high, point.y));
      }
    }
    for (const PlotLevel& level : panel.levels) frame.y.Hold(level.y);
  }
  frame.x.Close();
  frame.y.Close();
  return frame;
}

std::string SharesOfOne(double value) {
  const double percent = 100.0 * value;
  if (percent == 0.0) return "0 %";
  if (percent < 0.00099) {
    const int exponent = static_cast<int>(std::floor(std::log10(percent) + 1e-9));
    const double digits = percent / std::pow(10.0, exponent);
    return fmt::format("{:.2g}e{} %", digits, exponent);
  }
  return percent < 99.5 ? fmt::format("{:.2g} %", percent) : fmt::format("{:.0f} %", percent);
}

std::string WithPrefix(double value, const std::vector<std::pair<double, const char*>>& prefixes) {
  for (const auto& [factor, unit] : prefixes) {
    if (value < 0.995 * factor && factor != prefixes.back().first) continue;
    const double scaled = value / factor;
    return scaled < 9.95 ? fmt::format("{:.2g} {}", scaled, unit)
                         : fmt::format("{:.0f} {}", scaled, unit);
  }
  throw InternalError("a quantity without a unit");
}

}  // namespace

std::string QuantityText(double value, PlotUnit unit) {
  switch (unit) {
    case PlotUnit::kSeconds:
      return WithPrefix(value, {{1.0, "s"}, {1e-3, "ms"}, {1e-6, "µs"}, {1e-9, "ns"}});
    case PlotUnit::kShare:
      return SharesOfOne(value);
    case PlotUnit::kCount:
      return value < 99.5 ? fmt::format("{:.3g}", value) : fmt::format("{:.0f}", value);
    case PlotUnit::kBytes:
      return value < 1000.0 ? fmt::format("{:.0f} B", value)
                            : WithPrefix(value, {{1e9, "GB"}, {1e6, "MB"}, {1e3, "kB"}});
  }
  throw InternalError("a unit without a text");
}

std::string SvgOfPlot(const Plot& plot) {
  ALPENGLOW_ENSURE(plot.panels.size(), >, 0U);
  const double bottom = kTop + kPanelHeight + kBottom;
  const Legend legend = LegendBelow(plot, bottom - 8.0);
  const double height = bottom + legend.height;
  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"p\" viewBox=\"0 0 {0} {1}\" "
      "width=\"{0}\" height=\"{1}\" role=\"img\" aria-label=\"{2}\">\n",
      kWidth, height, XmlText(plot.title));
  text += StyleSheet();
  text += fmt::format("<rect class=\"sheet\" width=\"{}\" height=\"{}\"/>\n", kWidth, height);
  text += TextElement(kLeft, 24.0, "title", plot.title);
  text += TextElement(kLeft, 42.0, "subtitle", plot.subtitle);
  Frame frame = SharedAxes(plot);
  const double count = static_cast<double>(plot.panels.size());
  const double width = (kWidth - kLeft - kRight - kGap * (count - 1.0)) / count;
  for (std::size_t i = 0; i < plot.panels.size(); ++i) {
    const double x0 = kLeft + static_cast<double>(i) * (width + kGap);
    frame.area = {x0, kTop, x0 + width, kTop + kPanelHeight};
    text += PanelText(frame, plot, plot.panels[i], i == 0);
  }
  text += TextElement(0.5 * (kLeft + kWidth - kRight), bottom - 12.0, "axis", plot.x.title,
                      " text-anchor=\"middle\"");
  text += TextElement(14.0, kTop + 0.5 * kPanelHeight, "axis", plot.y.title,
                      fmt::format(" text-anchor=\"middle\" transform=\"rotate(-90 14 {})\"",
                                  kTop + 0.5 * kPanelHeight));
  return text + legend.text + "</svg>\n";
}

}  // namespace alpenglow::lut
