// SPDX-License-Identifier: MIT
// Compares pictures of the fast method with paths through the whole scene
// (renderer/path_tracing/scene_path_tracer.h), over a plain:
//   scene_path_study [CLOUDS [SUN_DEG [PATHS [KEY=VALUE ...]]]]
// with the text of --clouds. Keys are
//   air     earth, molecules (without haze) or none
//   views   usual: from the ground to both sides of the sun, and down from 4 km
//           ground: down from 2 m, 4 km and 12 km
//   seed    of the first layer
//   albedo  of the ground, for example 0
//   clouds  the method of light in clouds: fast, hybrid or traced
// Pixels are single rays. Groups are the sky beside clouds, clouds that dim by half or more, the ground
// in their shadow, and the ground in the sun. Errors are root mean square and bias of luminance
// relative to the traced pixel, in per cent; the standard errors of the paths are subtracted from the
// square. The bias by colour is that of linear sRGB. Times are of the processor.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <map>
#include <optional>
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
#include "tests/bench/processor_time.h"

namespace alpenglow::renderer {
namespace {

constexpr int kWide = 12, kHigh = 7;

struct StudyView {
  const char* name;
  double height_m, from_sun_deg, pitch_deg;
};
const std::vector<StudyView> kUsualViews{{"towards the sun", 2.0, 50.0, 22.0},
                                         {"away from the sun", 2.0, 180.0, 22.0},
                                         {"down from 4 km", 4000.0, 120.0, -40.0}};
const std::vector<StudyView> kGroundViews{{"down from 2 m", 2.0, 120.0, -40.0},
                                          {"down from 4 km", 4000.0, 120.0, -40.0},
                                          {"down from 4 km, towards the sun", 4000.0, 0.0, -40.0},
                                          {"down from 12 km", 12000.0, 120.0, -50.0}};

struct StudySky {
  std::string clouds = "cumulus 0.25";
  double sun_deg = 35.0;
  int paths = 512;
  std::string air = "earth";
  bool is_of_ground = false;
  CloudLightMethod method = CloudLightMethod::kFast;
  std::optional<std::uint32_t> seed = {};
  std::optional<double> ground_albedo = {};

  [[nodiscard]] bool HasAir() const { return air != "none"; }
  [[nodiscard]] const std::vector<StudyView>& Views() const {
    return is_of_ground ? kGroundViews : kUsualViews;
  }
};

Medium MediumOf(const StudySky& sky) {
  Medium medium = MediumPreset("earth");
  std::vector<std::vector<double>*> none;
  if (sky.air != "earth") none = {&medium.mie_scattering_per_m, &medium.mie_extinction_per_m};
  if (!sky.HasAir()) {
    none.push_back(&medium.rayleigh_scattering_per_m);
    none.push_back(&medium.ozone_absorption_per_m);
  }
  for (auto* values : none) std::ranges::fill(*values, 0.0);
  if (sky.ground_albedo) std::ranges::fill(medium.ground_albedo, *sky.ground_albedo);
  return medium;
}

Scene SceneUnder(const StudySky& sky, const StudyView& view, double sun_azimuth_deg) {
  Scene scene;
  scene.place = {46.5, 8.0, 0.0};
  scene.medium = MediumOf(sky);
  scene.terrain.kind = TerrainSource::Kind::kNone;
  scene.clouds = CloudsFromText(sky.clouds);
  if (sky.seed && !scene.clouds.empty()) scene.clouds.front().options.seed = *sky.seed;
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
  const SceneRenderer renderer(SceneUnder({.clouds = "none"}, kUsualViews.front(), 0.0));
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

void Compare(const StudyView& view, const StudyTime& when, const StudySky& sky,
             std::map<std::string, StudyGroup>& all) {
  const PreparedScene scene(SceneUnder(sky, view, when.azimuth_deg), nullptr);
  RenderSettings settings;
  settings.width = kWide;
  settings.height = kHigh;
  settings.samples_per_pixel = 1;
  settings.cloud_light = sky.method;
  RenderSettings with_paths = settings;
  with_paths.paths = sky.paths;
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
  const double took_s = tests::ProcessorSecondsSince(begin);
  std::map<std::string, StudyGroup> groups;
  for (int i = 0; i < kWide * kHigh; ++i) {
    const std::string group = GroupOf(fast_frame, fast_shader, i % kWide + 0.5, i / kWide + 0.5);
    if (group.empty() || (group == "sky" && !sky.HasAir())) continue;
    groups[group].Add(scene.colour(), pixels[static_cast<std::size_t>(i)]);
    all[group].Add(scene.colour(), pixels[static_cast<std::size_t>(i)]);
  }
  for (const auto& [name, group] : groups)
    fmt::print("{}", group.Line(fmt::format("{}: {}", view.name, name)));
  fmt::print("  {:.2f} ms of the processor per path\n", 1e3 * took_s / (kWide * kHigh) / sky.paths);
}

void RunStudy(const StudySky& sky) {
  const StudyTime when = MorningWith(sky.sun_deg);
  fmt::print("{}, sun {} degrees high, {} paths per pixel, air: {}, {} clouds\n", sky.clouds,
             sky.sun_deg, sky.paths, sky.air, NameOf(sky.method));
  fmt::print("{:46} {:>6} {:>7} {:>7}   {:>6} {:>6} {:>6}   {:>6}\n", "view: group", "pixels",
             "rms", "bias", "red", "green", "blue", "noise");
  std::map<std::string, StudyGroup> all;
  for (const StudyView& view : sky.Views()) Compare(view, when, sky, all);
  for (const auto& [name, group] : all) fmt::print("{}", group.Line("all views: " + name));
}

}  // namespace
}  // namespace alpenglow::renderer

int main(int count, char** arguments) {
  using namespace alpenglow;
  const std::vector<std::string> words(arguments + 1, arguments + count);
  renderer::StudySky sky;
  const auto number = [](const std::string& text) {
    const auto value = atmosphere::ParseNumber(text);
    if (!value) throw InputError(fmt::format("\"{}\" is not a number", text));
    return *value;
  };
  if (!words.empty()) sky.clouds = words[0];
  if (words.size() > 1) sky.sun_deg = number(words[1]);
  if (words.size() > 2) sky.paths = static_cast<int>(number(words[2]));
  for (std::size_t i = 3; i < words.size(); ++i) {
    const std::size_t equals = words[i].find('=');
    const std::string key = words[i].substr(0, equals), value = words[i].substr(equals + 1);
    if (key == "air") sky.air = value;
    if (key == "views") sky.is_of_ground = value == "ground";
    if (key == "seed") sky.seed = static_cast<std::uint32_t>(number(value));
    if (key == "albedo") sky.ground_albedo = number(value);
    if (key == "clouds") sky.method = renderer::CloudLightMethodFromName(value);
  }
  renderer::RunStudy(sky);
}
