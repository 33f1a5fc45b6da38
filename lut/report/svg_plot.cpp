// SPDX-License-Identifier: MIT
#include "lut/report/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "atmosphere/base/error.h"
#include "lut/layer.h"

namespace alpenglow::lut {
namespace {

constexpr double kWidth = 1080.0;
constexpr double kPanelHeight = 330.0;
constexpr double kLeft = 62.0, kRight = 14.0, kTop = 76.0, kBottom = 52.0, kGap = 18.0;
constexpr double kLabelSize = 12.0, kNoteSize = 9.5;

struct Box {
  double x0 = 0.0, y0 = 0.0, x1 = 0.0, y1 = 0.0;
  double penalty = 0.0;  // for the place of a label: distance from the labelled point

  [[nodiscard]] double Overlap(const Box& other) const {
    const double width = std::min(x1, other.x1) - std::max(x0, other.x0);
    const double height = std::min(y1, other.y1) - std::max(y0, other.y0);
    return width > 0.0 && height > 0.0 ? width * height : 0.0;
  }
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

std::string TextElement(double x, double y, const std::string& kind, const std::string& text,
                        const std::string& more = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"{}\"{}>{}</text>\n", x, y, kind, more,
                     XmlText(text));
}

std::string LineElement(double x0, double y0, double x1, double y1, const std::string& kind) {
  return fmt::format(
      "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" class=\"{}\"/>\n", x0, y0, x1,
      y1, kind);
}

std::string StyleSheet() {
  constexpr std::array<std::array<const char*, 2>, kPlotStyles> kColours = {{
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
         ".p .panel {font-size:13px; font-weight:bold}\n"
         ".p .tick {fill:#555}\n"
         ".p .axis {fill:#333; font-size:12px}\n"
         ".p text.name {font-size:12px; font-weight:bold; fill:currentColor}\n"
         ".p text.note {font-size:9.5px; fill:currentColor}\n"
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
         ".p .faint .mark {fill:#15181c}\n" +
         colours(1) + "}\n</style>\n";
}

std::string Marker(int style, double x, double y) {
  constexpr double r = 3.6;
  switch (style % 4) {
    case 0:
      return fmt::format("<circle class=\"mark\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\"/>\n", x, y,
                         r);
    case 1:
      return fmt::format("<path class=\"mark\" d=\"M{:.1f} {:.1f}l{} {}h{}z\"/>\n", x, y - 1.2 * r,
                         1.1 * r, 2.0 * r, -2.2 * r);
    case 2:
      return fmt::format(
          "<rect class=\"mark\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" height=\"{}\"/>\n",
          x - 0.9 * r, y - 0.9 * r, 1.8 * r, 1.8 * r);
    default:
      return fmt::format("<path class=\"mark\" d=\"M{:.1f} {:.1f}l{} {}l{} {}l{} {}z\"/>\n", x,
                         y - 1.3 * r, 1.3 * r, 1.3 * r, -1.3 * r, 1.3 * r, -1.3 * r, -1.3 * r);
  }
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

std::string SeriesText(const Frame& frame, const PlotSeries& series) {
  const std::vector<PlotPoint> points = DrawablePoints(series);
  std::string text =
      fmt::format("<g class=\"c{}{}\">\n", series.style, series.faint ? " faint" : "");
  std::string run;
  for (const PlotPoint& point : points) {
    run += fmt::format("{:.1f},{:.1f} ", frame.X(point.x), frame.Y(point.y));
    if (point.y_high && *point.y_high > point.y)
      text += LineElement(frame.X(point.x), frame.Y(point.y), frame.X(point.x),
                          frame.Y(*point.y_high), "tail");
  }
  if (points.size() > 1) text += fmt::format("<polyline class=\"run\" points=\"{}\"/>\n", run);
  for (const PlotPoint& point : points)
    text += Marker(series.style, frame.X(point.x), frame.Y(point.y));
  return text + "</g>\n";
}

/// Places labels one after the other, each beside a point and away from everything drawn before.
class Labels {
 public:
  Labels(const Frame& frame, const PlotPanel& panel) : frame_(frame) {
    for (const PlotSeries& series : panel.series) Avoid(DrawablePoints(series));
    for (const PlotLevel& level : panel.levels) {
      const double at = frame.Y(level.y);
      ink_.push_back({frame.area.x0, at - 1.0, frame.area.x1, at + 1.0});
    }
  }

  /// Returns the text at the best of the places around the points.
  [[nodiscard]] std::string Place(const std::vector<PlotPoint>& points, const std::string& text,
                                  const std::string& kind, double size) {
    std::vector<Box> places;
    for (const PlotPoint& point : points) {
      const std::vector<Box> around =
          PlacesAround(frame_.X(point.x), frame_.Y(point.y), text, size);
      places.insert(places.end(), around.begin(), around.end());
    }
    return Taken(places, kind, text, size);
  }

  /// Returns the text placed on the line across the panel at height `y`.
  [[nodiscard]] std::string PlaceAlong(double y, const std::string& text) {
    const double size = 11.0, width = TextWidth(text, size);
    std::vector<Box> places;
    for (double x = frame_.area.x1 - 4.0 - width; x > frame_.area.x0 + 4.0; x -= 12.0) {
      places.push_back({x, frame_.Y(y) - 3.0 - size, x + width, frame_.Y(y) - 3.0});
      places.push_back({x, frame_.Y(y) + 3.0, x + width, frame_.Y(y) + 3.0 + size});
    }
    return Taken(places, "tick", text, size);
  }

 private:
  [[nodiscard]] std::string Taken(const std::vector<Box>& places, const std::string& kind,
                                  const std::string& text, double size) {
    const Box best =
        *std::min_element(places.begin(), places.end(),
                          [&](const Box& a, const Box& b) { return Cost(a) < Cost(b); });
    taken_.push_back(best);
    return TextElement(best.x0, best.y1 - 0.22 * size, kind, text);
  }

  void Avoid(const std::vector<PlotPoint>& points) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double x = frame_.X(points[i].x), y = frame_.Y(points[i].y);
      ink_.push_back({x - 5.0, y - 5.0, x + 5.0, y + 5.0});
      if (points[i].y_high)
        ink_.push_back({x - 1.0, frame_.Y(std::max(*points[i].y_high, points[i].y)), x + 1.0, y});
      if (i == 0) continue;
      // A line is represented by a row of small boxes.
      const double px = frame_.X(points[i - 1].x), py = frame_.Y(points[i - 1].y);
      const int pieces = 1 + static_cast<int>(std::hypot(x - px, y - py) / 5.0);
      for (int k = 1; k < pieces; ++k) {
        const double cx = px + (x - px) * k / pieces, cy = py + (y - py) * k / pieces;
        ink_.push_back({cx - 2.5, cy - 2.5, cx + 2.5, cy + 2.5});
      }
    }
  }

  [[nodiscard]] static std::vector<Box> PlacesAround(double x, double y, const std::string& text,
                                                     double size) {
    const double width = TextWidth(text, size), height = size;
    std::vector<Box> places;
    for (const double away : {7.0, 14.0, 24.0}) {
      for (const auto& [dx, dy] :
           {std::pair{away, -0.5 * height}, std::pair{-away - width, -0.5 * height},
            std::pair{-0.5 * width, -away - height}, std::pair{-0.5 * width, away},
            std::pair{away, -away - 0.5 * height}, std::pair{away, away - 0.5 * height},
            std::pair{-away - width, -away - 0.5 * height},
            std::pair{-away - width, away - 0.5 * height}}) {
        places.push_back({x + dx, y + dy, x + dx + width, y + dy + height, 8.0 * (away - 7.0)});
      }
    }
    return places;
  }

  [[nodiscard]] double Cost(const Box& place) const {
    double cost = place.penalty;
    for (const Box& box : taken_) cost += 20.0 * place.Overlap(box);
    for (const Box& box : ink_) cost += 3.0 * place.Overlap(box);
    const double area = (place.x1 - place.x0) * (place.y1 - place.y0);
    cost += 50.0 * (area - place.Overlap(Box{frame_.area.x0 + 2.0, frame_.area.y0 + 2.0,
                                             frame_.area.x1 - 2.0, frame_.area.y1 - 2.0}));
    return cost;
  }

  const Frame& frame_;
  std::vector<Box> ink_, taken_;
};

std::string LabelsText(const Frame& frame, const PlotPanel& panel) {
  Labels labels(frame, panel);
  std::string text;
  for (const PlotLevel& level : panel.levels) text += labels.PlaceAlong(level.y, level.name);
  for (const PlotSeries& series : panel.series) {
    const std::vector<PlotPoint> points = DrawablePoints(series);
    if (points.empty()) continue;
    text += fmt::format("<g class=\"c{}\">\n", series.style);
    text += labels.Place(points, series.name, "name", kLabelSize);
    text += "</g>\n";
  }
  for (const PlotSeries& series : panel.series) {
    const std::vector<PlotPoint> points = DrawablePoints(series);
    if (points.size() < 2) continue;
    text += fmt::format("<g class=\"c{}\">\n", series.style);
    for (const PlotPoint& end : {points.front(), points.back()}) {
      if (!end.note.empty()) text += labels.Place({end}, end.note, "note", kNoteSize);
    }
    text += "</g>\n";
  }
  return text;
}

std::string PanelText(const Frame& frame, const Plot& plot, const PlotPanel& panel, bool first) {
  std::string text = FrameText(frame, plot, first);
  text += TextElement(frame.area.x0, frame.area.y0 - 8.0, "panel", panel.title);
  for (const PlotLevel& level : panel.levels) {
    const double at = frame.Y(level.y);
    text += LineElement(frame.area.x0, at, frame.area.x1, at, "level");
  }
  for (const PlotSeries& series : panel.series) text += SeriesText(frame, series);
  return text + LabelsText(frame, panel);
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

std::string XmlText(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string SvgOfPlot(const Plot& plot) {
  ALPENGLOW_ENSURE(plot.panels.size(), >, 0U);
  const double height = kTop + kPanelHeight + kBottom;
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
  text += TextElement(0.5 * (kLeft + kWidth - kRight), height - 12.0, "axis", plot.x.title,
                      " text-anchor=\"middle\"");
  text += TextElement(14.0, kTop + 0.5 * kPanelHeight, "axis", plot.y.title,
                      fmt::format(" text-anchor=\"middle\" transform=\"rotate(-90 14 {})\"",
                                  kTop + 0.5 * kPanelHeight));
  return text + "</svg>\n";
}

}  // namespace alpenglow::lut
