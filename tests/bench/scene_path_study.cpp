// SPDX-License-Identifier: MIT
// Compares pictures of the fast method with paths through the whole scene
// (renderer/path_tracing/scene_path_tracer.h), over a plain:
//   scene_path_study [CLOUDS [SUN_DEG [PATHS]]]
// with the text of --clouds. Views look from the ground to both sides of the sun, and down from 4 km.
// Pixels are single rays. Groups are the sky beside clouds, clouds that dim by half or more, the ground
// in their shadow, and the ground in the sun. Errors are root mean square and bias of luminance
// relative to the traced pixel, in per cent; the standard errors of the paths are subtracted from the
// square. The bias by colour is that of linear sRGB. Times are of the processor.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <map>
#include <string>
#include <vector>

#include "atmosphere/base/parsing.h"
#include "atmosphere/math/angles.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/time_place/time.h"
#include "renderer/picture/frame_context.h"
#include "renderer/picture/pixel_light.h"
#include "renderer/picture/prepared_scene.h"
#include "renderer/scene/scene_clouds.h"

namespace alpenglow::renderer {
namespace {

constexpr int kWide = 12, kHigh = 7;

struct StudyView {
  const char* name;
  double height_m, from_sun_deg, pitch_deg;
};
constexpr StudyView kViews[] = {{"towards the sun", 2.0, 50.0, 22.0},
                                {"away from the sun", 2.0, 180.0, 22.0},
                                {"down from 4 km", 4000.0, 120.0, -40.0}};

Scene SceneUnder(const std::string& clouds, const StudyView& view, double sun_azimuth_deg) {
  Scene scene;
  scene.place = {46.5, 8.0, 0.0};
  scene.medium = MediumPreset("earth");
  scene.terrain.kind = TerrainSource::Kind::kNone;
  scene.clouds = CloudsFromText(clouds);
  double heading_deg = sun_azimuth_deg + view.from_sun_deg;
  heading_deg -= 360.0 * std::floor(heading_deg / 360.0);
  scene.camera = CameraFromDegrees({view.height_m, false}, heading_deg, view.pitch_deg, 0.0, 70.0);
  return scene;
}

/// A morning with the sun at an elevation.
struct StudyTime {
  UtcTime time;
  double azimuth_deg;
};

StudyTime MorningWith(double elevation_deg) {
  const SceneRenderer renderer(SceneUnder("none", kViews[0], 0.0));
  const UtcTime midnight = ParseInstant("2026-06-21T03:00:00Z");
  for (double second = 0.0; second < 32400.0; second += 10.0) {
    const UtcTime time = AddSeconds(midnight, second);
    const SunInSky sun = renderer.ApparentSun(time);
    if (sun.elevation_rad() / kRadiansPerDegree >= elevation_deg)
      return {time, sun.azimuth_rad() / kRadiansPerDegree};
  }
  throw InputError(fmt::format("the sun is never {} degrees high", elevation_deg));
}

struct StudyPixel {
  Spectrum fast, traced;
  double relative_error;
};

/// Errors of a group of pixels.
struct StudyGroup {
  int pixels = 0;
  double squares = 0.0, noise = 0.0;
  std::array<double, 3> fast{}, traced{};
  double fast_luminance = 0.0, traced_luminance = 0.0;

  void Add(const BandColour& colour, const StudyPixel& pixel) {
    const double fast_y = colour.Xyz(pixel.fast)[1], traced_y = colour.Xyz(pixel.traced)[1];
    ++pixels;
    squares += std::pow(fast_y / traced_y - 1.0, 2.0) - std::pow(pixel.relative_error, 2.0);
    noise += pixel.relative_error;
    fast_luminance += fast_y;
    traced_luminance += traced_y;
    for (std::size_t i = 0; i < 3; ++i) {
      fast.at(i) += colour.LinearSrgb(pixel.fast).at(i);
      traced.at(i) += colour.LinearSrgb(pixel.traced).at(i);
    }
  }
  [[nodiscard]] std::string Line(const std::string& name) const {
    const auto percent = [](double of, double relative_to) {
      return 100.0 * (of / relative_to - 1.0);
    };
    return fmt::format("{:46} {:6} {:7.1f} {:+7.1f}   {:+6.1f} {:+6.1f} {:+6.1f}   {:6.2f}\n", name,
                       pixels, 100.0 * std::sqrt(std::max(squares / pixels, 0.0)),
                       percent(fast_luminance, traced_luminance), percent(fast[0], traced[0]),
                       percent(fast[1], traced[1]), percent(fast[2], traced[2]),
                       100.0 * noise / pixels);
  }
};

/// Returns the group of a pixel; empty for one between groups.
std::string GroupOf(const FrameContext& frame, const PixelShader& shader, double x, double y) {
  const LitClouds& clouds = *frame.lights().front().clouds;
  const CameraRay ray = frame.camera().MiddleRay(x, y);
  const Hit hit = shader.Trace(ray);
  const double left =
      static_cast<double>(clouds.Along(ray.origin, ray.direction, hit.distance_m).transmittance());
  if (left < 0.5) return "cloud";
  if (left < 0.98) return "";
  if (hit.kind == HitKind::kSky) return "sky";
  const double sun = clouds.shadow().Transmittance(hit.point);
  return sun > 0.95 ? "ground in the sun" : sun < 0.5 ? "ground in shadow" : "";
}

void Compare(const StudyView& view, const StudyTime& when, const std::string& clouds, int paths,
             std::map<std::string, StudyGroup>& all) {
  const PreparedScene scene(SceneUnder(clouds, view, when.azimuth_deg), nullptr);
  RenderSettings settings;
  settings.width = kWide;
  settings.height = kHigh;
  settings.samples_per_pixel = 1;
  RenderSettings with_paths = settings;
  with_paths.paths = paths;
  const FrameContext traced_frame(scene, when.time, with_paths);
  const FrameContext fast_frame = traced_frame.Sampled(settings);
  const PixelShader traced_shader(traced_frame), fast_shader(fast_frame);
  std::vector<StudyPixel> pixels(kWide * kHigh);
  const std::clock_t begin = std::clock();
  tbb::parallel_for(0, kWide * kHigh, [&](int i) {
    PixelLight fast(fast_shader, i % kWide, i / kWide, 1);
    PixelLight traced(traced_shader, i % kWide, i / kWide, 1);
    fast.TakeUpTo(1);
    traced.TakeUpTo(1);
    pixels[static_cast<std::size_t>(i)] = {fast.sum().MeanRadiance(), traced.sum().MeanRadiance(),
                                           traced.sum().paths.RelativeError().value_or(0.0)};
  });
  const double took_s = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  std::map<std::string, StudyGroup> groups;
  for (int i = 0; i < kWide * kHigh; ++i) {
    const std::string group = GroupOf(fast_frame, fast_shader, i % kWide + 0.5, i / kWide + 0.5);
    if (group.empty()) continue;
    groups[group].Add(scene.colour(), pixels[static_cast<std::size_t>(i)]);
    all[group].Add(scene.colour(), pixels[static_cast<std::size_t>(i)]);
  }
  for (const auto& [name, group] : groups)
    fmt::print("{}", group.Line(fmt::format("{}: {}", view.name, name)));
  fmt::print("  {:.2f} ms of the processor per path\n", 1e3 * took_s / (kWide * kHigh) / paths);
}

int Study(const std::string& clouds, double sun_deg, int paths) {
  const StudyTime when = MorningWith(sun_deg);
  fmt::print("{}, sun {} degrees high, {} paths per pixel\n", clouds, sun_deg, paths);
  fmt::print("{:46} {:>6} {:>7} {:>7}   {:>6} {:>6} {:>6}   {:>6}\n", "view: group", "pixels",
             "rms", "bias", "red", "green", "blue", "noise");
  std::map<std::string, StudyGroup> all;
  for (const StudyView& view : kViews) Compare(view, when, clouds, paths, all);
  for (const auto& [name, group] : all) fmt::print("{}", group.Line("all views: " + name));
  return 0;
}

}  // namespace
}  // namespace alpenglow::renderer

int main(int argc, char** argv) {
  using alpenglow::atmosphere::ParseNumber;
  const std::string clouds = argc > 1 ? argv[1] : "cumulus 0.25";
  const double sun_deg = argc > 2 ? ParseNumber(argv[2]).value_or(35.0) : 35.0;
  const double paths = argc > 3 ? ParseNumber(argv[3]).value_or(512.0) : 512.0;
  return alpenglow::renderer::Study(clouds, sun_deg, static_cast<int>(paths));
}
