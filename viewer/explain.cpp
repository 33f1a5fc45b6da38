// SPDX-License-Identifier: MIT
#include "viewer/explain.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <iterator>
#include <vector>

#include "atmosphere/text/error.h"
#include "renderer/picture/render.h"
#include "viewer/paint/view_difference.h"

namespace alpenglow {
namespace {

constexpr int kSamples = 16;

/// One part of a picture at its best.
struct Shortcut {
  const char* name;
  void (*perfect)(PaintSizes& sizes);
};
constexpr std::array<Shortcut, 5> kShortcuts{
    {{"air tables", [](PaintSizes& sizes) { sizes.air = AirQuality::kHigh; }},
     {"levels of land", [](PaintSizes& sizes) { sizes.land_detail = 512.0; }},
     {"shafts",
      [](PaintSizes& sizes) {
        sizes.shade.size.samples = sizes.shade.size.cells = 2048;
        sizes.shade.detail = {1, {8, 12}};
      }},
     {"lamps' light in the air",
      [](PaintSizes& sizes) {
        sizes.lamps = {24, 1};
      }},
     {"relief", [](PaintSizes& sizes) { sizes.relief_pixels = 1.0; }}}};

struct TimedPicture {
  Image image;
  double frame_ms;
};

TimedPicture Paint(Flythrough& flight, const PaintedView& view, const PaintSizes& sizes) {
  using Clock = std::chrono::steady_clock;
  SkyPainter& painter = flight.painter();
  painter.Use(sizes);
  painter.Settle(view);
  painter.Paint(view);
  glFinish();
  double best_ms = 1e9;
  for (int i = 0; i < 5; ++i) {
    const Clock::time_point begin = Clock::now();
    painter.Paint(view);
    glFinish();
    best_ms =
        std::min(best_ms, std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
  }
  painter.Paint(view, kSamples);
  return {painter.picture().Read(), best_ms};
}

Image JudgeOf(const Flythrough& flight, const ImageSize& size) {
  RenderSettings settings;
  settings.width = size.width;
  settings.height = size.height;
  settings.samples_per_pixel = kSamples;
  settings.filter = PixelFilter::Kind::kBox;
  settings.layers = LayersOfEdges();
  return RendererOf(flight.SceneForRenderer())->Render(flight.now(), settings);
}

std::string Row(const std::string& name, const ViewDifference& is, const std::string& time) {
  return fmt::format("{:<26}{:>8.3f} %{:>9.3f} %{:>9.3f} %  {:>10}\n", name, 100.0 * is.mean,
                     100.0 * is.at_99_percent, 100.0 * is.at_999_permille, time);
}

}  // namespace

std::string ExplainView(Flythrough& flight, const ImageSize& size) {
  flight.Settle(size);
  const Quality quality = flight.quality_rule().fixed.value_or(Quality::kMedium);
  const PaintSizes sizes = SizesOf(quality);
  const PaintedView view{flight.eye(), flight.now(), size.width, size.height};
  const Image judge = JudgeOf(flight, size);
  const TimedPicture painted = Paint(flight, view, sizes);
  const ViewDifference all = DifferenceOf(judge, painted.image);
  std::string text = fmt::format(
      "quality {}, {}x{}, {} rays a pixel; {:.1f} % of pixels are edges and left out\n"
      "{:<26}{:>10}{:>11}{:>11}  {:>10}\n",
      NameOf(quality), size.width, size.height, kSamples, 100.0 * all.edge_share, "off by", "mean",
      "99 %", "99.9 %", "frame");
  text += Row("picture, from renderer's", all, fmt::format("{:.1f} ms", painted.frame_ms));
  for (const Shortcut& shortcut : kShortcuts) {
    PaintSizes better = sizes;
    shortcut.perfect(better);
    const TimedPicture without = Paint(flight, view, better);
    Image reference = without.image;
    reference.layers = judge.layers;
    text += Row(shortcut.name, DifferenceOf(reference, painted.image),
                fmt::format("saves {:.1f}", without.frame_ms - painted.frame_ms));
  }
  flight.painter().Use(sizes);
  return text;
}

}  // namespace alpenglow
