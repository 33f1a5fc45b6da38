// SPDX-License-Identifier: MIT
#include "viewer/reports.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "renderer/picture/reference_picture.h"
#include "renderer/picture/render.h"
#include "viewer/passes/display_pass.h"
#include "viewer/passes/panorama.h"

namespace alpenglow::viewer {
namespace {

double Seconds(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

std::string LineOf(const std::string& name, const std::vector<double>& ms) {
  const ErrorStatistics of(ms);
  return fmt::format("{} {:.3f} {:.3f} {:.3f}\n", name, of.Quantile(0.5), of.Quantile(0.95),
                     of.Quantile(0.99));
}

constexpr int kSamples = 16;

/// A shortcut of the painter, and the setting that avoids it.
struct Shortcut {
  const char* name;
  void (*perfect)(PaintSizes& sizes);
};
constexpr std::array<Shortcut, 6> kShortcuts{
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
     {"octaves of the ground", [](PaintSizes& sizes) { sizes.dropped_octaves = 0; }},
     {"rays through clouds", [](PaintSizes& sizes) { sizes.clouds = kHighClouds; }}}};

struct TimedPicture {
  HdrImage image;
  double frame_ms;
};

double LeastMs(const std::function<void()>& draw) {
  using Clock = std::chrono::steady_clock;
  draw();
  glFinish();
  double least_ms = 1e9;
  for (int i = 0; i < 5; ++i) {
    const Clock::time_point begin = Clock::now();
    draw();
    glFinish();
    least_ms =
        std::min(least_ms, std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
  }
  return least_ms;
}

TimedPicture PaintPerspective(SkyPainter& painter, const PaintedView& view) {
  painter.WaitUntilReady(view);
  const double best_ms = LeastMs([&] { painter.Paint(view); });
  painter.Paint(view, kSamples);
  return {painter.picture().Read(), best_ms};
}

// The time of a panorama is that of its sides.
TimedPicture Paint(SkyPainter& painter, const PaintedView& view, const PaintSizes& sizes) {
  painter.Use(sizes);
  if (!IsPanorama(view)) return PaintPerspective(painter, view);
  double sum_ms = 0.0;
  HdrImage image = PaintPanorama(view, [&](const PaintedView& side) {
    TimedPicture painted = PaintPerspective(painter, side);
    sum_ms += painted.frame_ms;
    return std::move(painted.image);
  });
  return {std::move(image), sum_ms};
}

/// A picture of linear light with one ray per pixel of the screen, or with fewer rays and upscaled.
class OneRay {
 public:
  OneRay(SkyPainter& painter, const PaintedView& screen) : painter_(painter), screen_(screen) {}

  /// @param scale  size of the painted picture relative to the screen.
  [[nodiscard]] TimedPicture At(double scale) {
    PaintedView painted = screen_;
    painted.width = std::max(static_cast<int>(std::lround(scale * screen_.width)), 1);
    painted.height = std::max(static_cast<int>(std::lround(scale * screen_.height)), 1);
    const double ms = LeastMs([&] { Show(painted); });
    return {light_.Read(), ms};
  }

 private:
  void Show(const PaintedView& painted) {
    painter_.Paint(painted, 1, SkyPainter::Bodies::kStars);
    painter_.PaintOutline(outline_);
    upscaler_.Upscale(painter_.picture(), outline_, HalfViewOf(painted), light_.framebuffer());
  }

  SkyPainter& painter_;
  PaintedView screen_;
  DepthPrepass outline_{screen_.width, screen_.height};
  RenderTarget light_{screen_.width, screen_.height};
  Upscaler upscaler_{Upscaler::Shows::kLight};
};

HdrImage ReferenceOf(const ReferenceScene& scene, const PaintedView& view) {
  RenderSettings settings = ComparisonSettings(view.width, view.height, kSamples);
  if (!scene.scene.clouds.empty()) settings.layers.push_back(PictureLayer::kClouds);
  CameraSample camera(view.now);
  camera.poses = {view.eye};
  return RendererOf(scene)->Render(camera, settings);
}

std::string Row(const std::string& name, const ErrorStatistics& is, const std::string& time) {
  return fmt::format("{:<26}{:>8.3f} %{:>9.3f} %{:>9.3f} %  {:>10}\n", name, 100.0 * is.mean(),
                     100.0 * is.Quantile(0.99), 100.0 * is.Quantile(0.999), time);
}

// Compares a view that is painted at a fraction of its size and upscaled with the view at one ray
// per pixel.
std::string FewerRays(SkyPainter& painter, const PaintedView& view,
                      const std::vector<ImageLayer>& edges, double scale) {
  painter.WaitUntilReady(view);
  OneRay of_view(painter, view);
  TimedPicture all = of_view.At(1.0);
  all.image.layers = edges;
  const TimedPicture fewer = of_view.At(scale);
  return Row(fmt::format("light at {:.2g}x", scale), DifferenceOf(all.image, fewer.image),
             fmt::format("saves {:.1f}", all.frame_ms - fewer.frame_ms));
}

}  // namespace

Benchmark::Benchmark(double seconds, PassClock clock)
    : seconds_(seconds), warm_up_s_(std::min(1.0, 0.25 * seconds)), clock_(clock) {}

Benchmark::~Benchmark() {
  if (drawn_ != nullptr) glDeleteSync(drawn_);
}

// GPU timer queries time every frame. Without them glFinish times every second frame.
bool Benchmark::NextFrame() {
  timer_.End();
  WaitForTheFrameBefore();
  const Clock::time_point now = Clock::now();
  if (!first_) first_ = now;
  if (begin_) EndFrame(now);
  begin_ = now;
  begin_cpu_ms_ = MillisecondsOfThisThread();
  elapsed_s_ = Seconds(now - *first_);
  times_passes_ = clock_ == PassClock::kQueries || !times_passes_;
  timer_.SetClock(times_passes_ ? clock_ : PassClock::kNone);
  if (elapsed_s_ < seconds_ || frame_ms_.empty() || timed_frames_ == 0) return true;
  RecordPasses(timer_.PollAll());
  return false;
}

void Benchmark::WaitForTheFrameBefore() {
  constexpr GLuint64 kLongest_ns = 10'000'000'000;
  GLsync before = std::exchange(drawn_, glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0));
  if (before == nullptr) return;
  glClientWaitSync(before, GL_SYNC_FLUSH_COMMANDS_BIT, kLongest_ns);
  glDeleteSync(before);
}

void Benchmark::EndFrame(Clock::time_point now) {
  const std::vector<PassTime> passes = timer_.Poll();
  if (Seconds(*begin_ - *first_) < warm_up_s_) return;
  const bool is_slowed = times_passes_ && clock_ == PassClock::kFinishes;
  if (!is_slowed) RecordFrame(1e3 * Seconds(now - *begin_));
  if (times_passes_) ++timed_frames_;
  RecordPasses(passes);
}

void Benchmark::RecordFrame(double ms) {
  frame_ms_.push_back(ms);
  frame_cpu_ms_.push_back(MillisecondsOfThisThread() - begin_cpu_ms_);
  if (ms <= worst_ms_) return;
  worst_ms_ = ms;
  worst_at_s_ = elapsed_s_;
}

void Benchmark::RecordPasses(const std::vector<PassTime>& passes) {
  for (const PassTime& pass : passes) {
    if (!ms_.contains(pass.pass)) passes_.push_back(pass.pass);
    ms_[pass.pass].push_back(pass.ms);
    cpu_ms_[pass.pass].push_back(pass.cpu_ms);
  }
}

std::string Benchmark::Text() const {
  std::string text;
  for (const std::string& pass : passes_) {
    text += LineOf(pass, ms_.at(pass)) + LineOf(pass + ".cpu", cpu_ms_.at(pass));
  }
  return text + LineOf("frame", frame_ms_) + LineOf("frame.cpu", frame_cpu_ms_);
}

std::string Benchmark::WorstText() const {
  return fmt::format(
      "{} frames, the worst of them {:.1f} ms, {:.1f} times the median, after {:.1f} s",
      frame_ms_.size(), worst_ms_, worst_ms_ / ErrorStatistics(frame_ms_).Quantile(0.5),
      worst_at_s_);
}

ReplayFrame BenchmarkFlight(const CameraPose& start, const UtcTime& begin, double elapsed_s) {
  constexpr double kSpeed_m_per_s = 250.0, kRadius_m = 5000.0;
  const double turned = kSpeed_m_per_s * elapsed_s / kRadius_m;
  const double ahead = kRadius_m * std::sin(turned), right = kRadius_m * (1.0 - std::cos(turned));
  const double c = std::cos(start.heading_rad), s = std::sin(start.heading_rad);
  CameraPose eye = start;
  eye.place = LocalFrame(kWgs84, start.place)
                  .GeodeticFromEnu(Point<Enu>{{ahead * s + right * c, ahead * c - right * s, 0.0}});
  eye.place.height_m = start.place.height_m;
  eye.heading_rad = std::remainder(start.heading_rad + turned, 2.0 * kPi);
  return {elapsed_s, eye, AddSeconds(begin, Benchmark::kTimeRate * elapsed_s)};
}

std::string ExplainView(SkyPainter& painter, const ReferenceScene& scene, const PaintedView& view,
                        Quality quality) {
  const PaintSizes sizes = SizesOf(quality);
  const HdrImage by_renderer = ReferenceOf(scene, view);
  const std::vector<bool> edges = EdgesOf(by_renderer);
  if (std::find(edges.begin(), edges.end(), false) == edges.end()) {
    return fmt::format("quality {}, {}x{}: every pixel is an edge, so that none can be compared\n",
                       NameOf(quality), view.width, view.height);
  }
  const TimedPicture painted = Paint(painter, view, sizes);
  const ErrorStatistics all = DifferenceOf(by_renderer, painted.image);
  std::string text = fmt::format(
      "quality {}, {}x{}, {} rays a pixel; {:.1f} % of pixels are edges and left out\n"
      "{:<26}{:>10}{:>11}{:>11}  {:>10}\n",
      NameOf(quality), view.width, view.height, kSamples,
      100.0 * (1.0 - static_cast<double>(all.count()) / static_cast<double>(edges.size())),
      "off by", "mean", "99 %", "99.9 %", "frame");
  text += Row("picture, from renderer's", all, fmt::format("{:.1f} ms", painted.frame_ms));
  if (const auto cloudy = DifferenceOf(by_renderer, painted.image, CloudyPixels::kCloudy))
    text += Row("pixels with clouds", *cloudy, "");
  if (const auto clear = DifferenceOf(by_renderer, painted.image, CloudyPixels::kClear))
    text += Row("pixels without clouds", *clear, "");
  for (const Shortcut& shortcut : kShortcuts) {
    PaintSizes better = sizes;
    shortcut.perfect(better);
    const TimedPicture without = Paint(painter, view, better);
    HdrImage reference = without.image;
    reference.layers = by_renderer.layers;
    text += Row(shortcut.name, DifferenceOf(reference, painted.image),
                fmt::format("saves {:.1f}", without.frame_ms - painted.frame_ms));
  }
  painter.Use(sizes);
  const double scale = PaintedAlways(quality).scale;
  const bool is_upscaled = scale < 1.0 && !IsPanorama(view);  // windows show no panoramas
  return is_upscaled ? text + FewerRays(painter, view, by_renderer.layers, scale) : text;
}

}  // namespace alpenglow::viewer
