// SPDX-License-Identifier: MIT
#include "renderer/series/day_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "atmosphere/base/error.h"
#include "lut/image/svg_elements.h"
#include "renderer/series/time_axis.h"

namespace alpenglow::renderer {
namespace {

constexpr double kWidth = 960.0, kLeft = 70.0, kRight = 20.0, kTop = 48.0, kPlotGap = 34.0,
                 kPanelHeight = 170.0, kBottom = 44.0;
constexpr int kPanels = 3;
constexpr double kPlotHeight = kTop + kPanels * kPanelHeight + (kPanels - 1) * kPlotGap + kBottom;

// Attributes replace a style sheet, which not all SVG readers support; colours of Okabe and Ito
// (2008), Color Universal Design, which colour-blind readers can distinguish.
constexpr char kSunColour[] = "#d55e00", kMoonColour[] = "#0072b2", kLightColour[] = "#b87f00",
               kEvColour[] = "#4b3fa7";
constexpr char kGridLine[] = "stroke=\"#888\" stroke-width=\"0.5\"";

using Value = std::function<std::optional<double>(const PlottedMoment&)>;

struct Curve {
  std::string name, colour;
  Value value;  // on the panel's axis
};

struct DayPanel {
  std::string title;
  std::vector<Curve> curves;
  double step;       // smallest step between grid lines
  bool logarithmic;  // values are exponents of ten
  double low, high;  // minimum range of the axis
  std::vector<LightLevel> levels = {};
};

/// The place of instants in the plot.
class PlotTime {
 public:
  PlotTime(const std::vector<PlottedMoment>& moments, const std::optional<std::string>& zone)
      : axis_(moments.front().instant, moments.back().instant, zone) {}

  [[nodiscard]] double X(const UtcTime& instant) const {
    return kLeft +
           SecondsBetween(axis_.first(), instant) / axis_.span_s() * (kWidth - kLeft - kRight);
  }
  [[nodiscard]] std::string Local(const UtcTime& instant) const { return axis_.Local(instant); }
  [[nodiscard]] std::vector<TimeTick> Ticks() const { return axis_.Ticks(kMostTicks); }

 private:
  static constexpr int kMostTicks = 13;

  TimeAxis axis_;
};

/// Returns the background of the curves, darker for a lower sun: day, three twilights, night.
std::string BandsOfTwilight(const std::vector<PlottedMoment>& moments, const PlotTime& time,
                            double top) {
  std::string text;
  for (std::size_t i = 0; i + 1 < moments.size(); ++i) {
    const double sun = 0.5 * (moments[i].sun_elevation_deg + moments[i + 1].sun_elevation_deg);
    constexpr std::array<double, 4> kEnds{-0.833, -6.0, -12.0, -18.0};
    const auto darkness =
        std::count_if(kEnds.begin(), kEnds.end(), [&](double end) { return sun < end; });
    if (darkness == 0) continue;
    const double x0 = time.X(moments[i].instant), x1 = time.X(moments[i + 1].instant);
    constexpr std::array<const char*, 4> kShades{"#eceef5", "#dcdfec", "#cbd0e2", "#bac1d9"};
    text += fmt::format(
        "<rect x=\"{:.2f}\" y=\"{:.1f}\" width=\"{:.2f}\" height=\"{:.1f}\" fill=\"{}\" "
        "stroke=\"none\" shape-rendering=\"crispEdges\"/>\n",
        x0, top, x1 - x0, kPanelHeight, kShades[static_cast<std::size_t>(darkness) - 1]);
  }
  return text;
}

/// Range of a panel in multiples of the step, with at most eight steps.
struct PlotRange {
  double low, high, step;

  PlotRange(const DayPanel& panel, const std::vector<PlottedMoment>& moments)
      : low(panel.low), high(panel.high), step(panel.step) {
    bool empty = true;
    for (const Curve& curve : panel.curves) {
      for (const PlottedMoment& moment : moments) {
        const std::optional<double> value = curve.value(moment);
        if (!value) continue;
        low = empty && panel.low >= panel.high ? *value : std::min(low, *value);
        high = empty && panel.low >= panel.high ? *value : std::max(high, *value);
        empty = false;
      }
    }
    while ((high - low) / step > 8.0) step *= 2.0;
    low = step * std::floor(low / step);
    high = step * std::max(std::ceil(high / step), std::floor(low / step) + 1.0);
  }
};

std::string CurveText(const Curve& curve, const std::vector<PlottedMoment>& moments,
                      const PlotTime& time, const std::function<double(double)>& y) {
  std::string text;
  std::vector<SvgPoint> run;
  const auto end_run = [&] {
    if (run.size() > 1)
      text += SvgPolyline(
          run, fmt::format("fill=\"none\" stroke-width=\"2\" stroke=\"{}\"", curve.colour));
    run.clear();
  };
  for (const PlottedMoment& moment : moments) {
    const std::optional<double> value = curve.value(moment);
    if (!value) {
      end_run();
      continue;
    }
    const SvgPoint& at = run.emplace_back(SvgPoint{time.X(moment.instant), y(*value)});
    if (run.size() == 1)  // also marks an isolated frame
      text += fmt::format("<circle fill=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"1.5\"/>\n",
                          curve.colour, at.x, at.y);
  }
  end_run();
  return text;
}

std::string GridText(const DayPanel& panel, const PlotRange& range, const PlotTime& time,
                     double top, const std::function<double(double)>& y) {
  std::string text;
  for (double value = range.low; value <= range.high + 1e-9; value += range.step) {
    text += SvgLine({kLeft, y(value)}, {kWidth - kRight, y(value)}, kGridLine);
    const std::string name =
        panel.logarithmic ? fmt::format("1e{:.0f}", value) : fmt::format("{:.0f}", value);
    text += SvgText({kLeft - 6.0, y(value) + 4.0}, "text-anchor=\"end\"", name);
  }
  for (const TimeTick& tick : time.Ticks())
    text +=
        SvgLine({time.X(tick.instant), top}, {time.X(tick.instant), top + kPanelHeight}, kGridLine);
  return text;
}

/// Returns a band or a line, with its name at the left.
std::string LevelText(const LightLevel& level, const std::function<double(double)>& y) {
  const double high = y(std::log10(level.high_lx)), low = y(std::log10(level.low_lx));
  return fmt::format(
             "<rect stroke=\"none\" fill=\"#7a1f5c\" fill-opacity=\"0.35\" x=\"{}\" y=\"{:.1f}\" "
             "width=\"{:.1f}\" height=\"{:.1f}\"/>\n",
             kLeft, high, kWidth - kLeft - kRight, std::max(low - high, 1.0)) +
         SvgText({kLeft + 4.0, high - 2.0}, "font-size=\"9\" fill=\"#7a1f5c\"",
                 fmt::format(
                     "{}, {:g}{}", level.name, level.low_lx,
                     level.high_lx > level.low_lx ? fmt::format(" to {:g}", level.high_lx) : ""));
}

std::string PanelText(const DayPanel& panel, const std::vector<PlottedMoment>& moments,
                      const PlotTime& time, double top) {
  const PlotRange range(panel, moments);
  const auto y = [&](double value) {
    return top + kPanelHeight * (range.high - value) / (range.high - range.low);
  };
  std::string text = BandsOfTwilight(moments, time, top) + GridText(panel, range, time, top, y);
  text += fmt::format(
      "<rect fill=\"none\" stroke=\"#888\" x=\"{}\" y=\"{:.1f}\" width=\"{:.1f}\" "
      "height=\"{}\"/>\n",
      kLeft, top, kWidth - kLeft - kRight, kPanelHeight);
  for (const LightLevel& level : panel.levels) text += LevelText(level, y);
  double name_x = kWidth - kRight;
  for (auto curve = panel.curves.rbegin(); curve != panel.curves.rend(); ++curve) {
    text += CurveText(*curve, moments, time, y);
    text +=
        SvgText({name_x, top - 6.0},
                fmt::format("fill=\"{}\" font-weight=\"bold\" text-anchor=\"end\"", curve->colour),
                curve->name);
    name_x -= 60.0;
  }
  return text + SvgText({kLeft, top - 6.0}, "", panel.title);
}

std::vector<DayPanel> Panels(const std::vector<LightLevel>& levels) {
  const Value lux = [](const PlottedMoment& moment) -> std::optional<double> {
    constexpr double kLeast_lx = 1e-5;
    if (!moment.illuminance_lx || *moment.illuminance_lx < kLeast_lx) return std::nullopt;
    return std::log10(*moment.illuminance_lx);
  };
  return {{"elevation, degrees, without refraction",
           {{"sun", kSunColour, [](const PlottedMoment& m) { return m.sun_elevation_deg; }},
            {"moon", kMoonColour, [](const PlottedMoment& m) { return m.moon_elevation_deg; }}},
           10.0,
           false,
           -10.0,
           10.0},
          {"illuminance of level ground, lx",
           {{"lux", kLightColour, lux}},
           1.0,
           true,
           levels.empty() ? 0.0 : -3.0,
           levels.empty() ? 0.0 : 5.0,
           levels},
          {"exposure, EV at ISO 100",
           {{"EV", kEvColour, [](const PlottedMoment& m) { return m.ev100; }}},
           1.0,
           false,
           0.0,
           0.0}};
}

}  // namespace

const std::vector<LightLevel>& PublishedLightLevels() {
  static const std::vector<LightLevel> levels{{"full moon, high", 0.25, 0.32},
                                              {"end of civil twilight", 3.4, 3.4},
                                              {"end of nautical twilight", 8e-3, 8e-3},
                                              {"without moon", 1e-3, 1e-3}};
  return levels;
}

std::string PlaceText(const Place& place) {
  const auto text = [](double degrees, const char* positive, const char* negative) {
    const double rounded = 1e-4 * std::round(1e4 * std::abs(degrees));
    return fmt::format("{:.6g} {}", rounded, degrees < 0.0 ? negative : positive);
  };
  return text(place.latitude_deg, "N", "S") + ", " + text(place.longitude_deg, "E", "W");
}

std::string SvgOfDay(const std::vector<PlottedMoment>& moments, const PlotTitle& title,
                     const std::vector<LightLevel>& levels) {
  ALPENGLOW_ENSURE(moments.size(), >, 0U);
  const PlotTime time(moments, title.zone);
  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
      "height=\"{1}\" font-size=\"12\" font-family=\"Helvetica,Arial,'Liberation "
      "Sans',sans-serif\" "
      "fill=\"#222\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n",
      kWidth, kPlotHeight);
  text += SvgText({kLeft, 22.0}, "font-size=\"15\" font-weight=\"bold\"",
                  fmt::format("{}: {} to {}", title.place, time.Local(moments.front().instant),
                              time.Local(moments.back().instant)));
  double top = kTop;
  for (const DayPanel& panel : Panels(levels)) {
    text += PanelText(panel, moments, time, top);
    top += kPanelHeight + kPlotGap;
  }
  for (const auto& [instant, name] : time.Ticks())
    text +=
        SvgText({time.X(instant), kPlotHeight - kBottom + 16.0}, "text-anchor=\"middle\"", name);
  return text +
         SvgText({kWidth - kRight, kPlotHeight - 8.0}, "text-anchor=\"end\"",
                 title.zone.value_or("UTC")) +
         "</svg>\n";
}

}  // namespace alpenglow::renderer
