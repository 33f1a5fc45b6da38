// SPDX-License-Identifier: MIT
#include "renderer/report/report_pictures.h"

#include <fmt/format.h>

#include <unistd.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <fstream>
#include <memory>
#include <utility>
#include <vector>

#include "atmosphere/base/parsing.h"
#include "atmosphere/math/constants.h"
#include "lut/cli/program.h"
#include "renderer/effects/effect_choice.h"
#include "renderer/picture/render.h"
#include "renderer/scene/scene_options.h"
#include "renderer/series/frame_times.h"

namespace alpenglow::renderer {
namespace {

constexpr std::size_t kScenes = 4;
struct SceneText {
  const char* key;
  const char* name;
  const char* time;  // time of the day of the range; of the night, of the runway
};
constexpr std::array<SceneText, kScenes> kSceneTexts{{{"noon", "Noon", "noon"},
                                                      {"sunset", "Sunset", "sunset-15m"},
                                                      {"twilight", "Twilight", "civil-dusk-10m"},
                                                      {"night", "Night with lamps", "noon+12h"}}};

/// Returns the resident memory of this program [bytes]; 0 where the system does not report it.
std::uint64_t ResidentBytes() {
  std::ifstream text("/proc/self/statm");
  std::string line;
  std::getline(text, line);
  const std::vector<std::string_view> pages = WordsOf(line);
  const double resident = pages.size() < 2 ? 0.0 : ParseNumber(pages[1]).value_or(0.0);
  return static_cast<std::uint64_t>(resident) * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

/// Returns the processor time of all threads [s].
double ProcessorSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Returns the result of `make` and the processor time that it takes [s].
template <typename Make>
auto Timed(const Make& make) {
  const double start = ProcessorSeconds();
  auto made = make();
  return std::pair{std::move(made), ProcessorSeconds() - start};
}

/// Returns the middle of a picture of the usual size, with pixels of the usual angular size. The
/// range takes seconds to generate, so tests of the report see its place without it.
Scene RangeScene(bool quick, int width) {
  Scene scene = SceneFromOptions({});
  constexpr double kWidthOfPictures = 1280.0;
  scene.camera.fov_rad =
      2.0 * std::atan(std::tan(0.5 * scene.camera.fov_rad) * width / kWidthOfPictures);
  if (quick) scene.terrain.kind = TerrainSource::Kind::kNone;
  return scene;
}

UtcTime InstantOf(std::size_t r) {
  const Scene range = SceneFromOptions({});
  return InstantFromText(kSceneTexts[r].time, {range.place, range.zone, range.time});
}

std::vector<double> ChangesOf(const HdrImage& reference, const HdrImage& image) {
  const double floor = ChangeFloor(reference);
  std::vector<double> changes;
  for (std::size_t i = 0; i < image.rgb.size(); ++i)
    changes.push_back(PixelChange(reference.rgb[i], image.rgb[i], floor));
  return changes;
}

ReportTopic WordsOfPictures() {
  return {
      .key = "pictures",
      .title = "Whole pictures: effect of samples of a pixel and nodes of the air",
      .what =
          "The built-in range at noon, a quarter of an hour before sunset and ten minutes before "
          "the end of civil twilight, from the same place: the middle of a picture 1280 pixels "
          "wide. And a runway with forty lamps and an aeroplane's landing lights in height fog. "
          "Sky, air, shafts, shadows and lamps are rendered as skyseries renders them.",
      .error_unit =
          "fractions of the pixel, as a distance of linear red, green and blue. Pixels below a "
          "sixteenth of middle grey count as if they were that bright. The largest possible error "
          "is 2, for light in only one of the pictures",
      .notes =
          "Rows with fewer air nodes and without effects are rendered with 4 samples. \"rays as "
          "noise asks\" uses 4 rays for every pixel, and up to 256 if the rays of the neighbouring "
          "pixels predict a larger error than the parameter; air and rays are shared between "
          "pixels. Most of the error of few samples is at edges of terrain, which are thinner than "
          "a pixel: a sample sees one side of them. Time is the processor time of all threads per "
          "pixel. build is the time to load the scene and to prepare a picture (shadow heights, "
          "tree of lamps). memory is the increase of the program's memory when both scenes were "
          "loaded.",
      .wanted = 0.1,
      .answer = "pixel",
      .everywhere = "from noon to night"};
}

class PicturesTopic {
 public:
  explicit PicturesTopic(const ReportEffort& effort)
      : effort_(effort),
        width_(effort.quick ? 16 : 192),
        height_(effort.quick ? 9 : 108),
        topic_(WordsOfPictures()) {
    const std::uint64_t before = ResidentBytes();
    const auto renderer_of = [](const Scene& scene) {
      return std::make_shared<const SceneRenderer>(scene);
    };
    const auto [range, range_s] =
        Timed([&] { return renderer_of(RangeScene(effort.quick, width_)); });
    const auto [runway, runway_s] =
        Timed([&] { return renderer_of(RunwayScene(effort.quick ? 10 : 40, true)); });
    range_bytes_ = std::max(ResidentBytes(), before) - before;
    load_s_ = std::max(range_s, runway_s);
    for (std::size_t r = 0; r < kScenes; ++r)
      scenes_.push_back({r + 1 < kScenes ? range : runway, InstantOf(r)});
    for (ReferenceSceneCase& scene : scenes_) scene.frame_s = FrameSeconds(scene);
    SolveReference();
    Describe();
  }

  void Add(ReportRow row, const RenderSettings& settings) {
    row.at.resize(kScenes);
    row.memory_bytes = range_bytes_;
    row.build_s = load_s_;
    for (std::size_t r = 0; r < kScenes; ++r) {
      Measure(scenes_[r], settings, row.at[r]);
      row.build_s = std::max(row.build_s, load_s_ + scenes_[r].frame_s);
    }
    topic_.rows.push_back(std::move(row));
  }

  void AddSamples(int samples) {
    Add({.series = "samples of a pixel",
         .parameter = fmt::format("{}", samples),
         .in_summary = true},
        Settings(samples));
  }

  void AddNoise(double noise) {
    RenderSettings settings = Settings(4);
    settings.noise = noise;
    Add({.series = "rays as noise asks",
         .parameter = fmt::format("{:g} %", 100.0 * noise),
         .in_summary = true},
        settings);
  }

  void AddNodes(int nodes) {
    RenderSettings settings = Settings(4);
    settings.air_nodes = nodes;
    Add({.series = "fewer air nodes",
         .parameter = fmt::format("{} nodes", nodes),
         .in_summary = nodes == 4},
        settings);
  }

  void AddWithout(Effect effect, const std::string& what) {
    RenderSettings settings = Settings(4);
    settings.effects = settings.effects.Without(effect);
    Add({.series = "without " + what,
         .parameter = "",
         .origin = MethodOrigin::kLiterature,
         .in_summary = true},
        settings);
  }

  [[nodiscard]] ReportTopic Finished() && { return std::move(topic_); }

 private:
  struct ReferenceSceneCase {
    std::shared_ptr<const SceneRenderer> renderer;
    UtcTime instant;
    HdrImage reference{};
    double frame_s = 0.0;  // time to prepare a picture
  };

  [[nodiscard]] int ReferenceSamples() const { return effort_.quick ? 32 : 256; }
  [[nodiscard]] double Pixels() const { return static_cast<double>(width_ * height_); }

  [[nodiscard]] SunRange SunOf(std::size_t r) const {
    const double deg = scenes_[r].renderer->ApparentSun(scenes_[r].instant).elevation_deg;
    const double rounded = std::round(10.0 * deg) / 10.0;
    return {rounded, rounded};
  }

  [[nodiscard]] RenderSettings Settings(int samples) const {
    RenderSettings settings;
    settings.width = width_;
    settings.height = height_;
    settings.samples_per_pixel = samples;
    return settings;
  }

  void SolveReference() {
    RenderSettings settings = Settings(ReferenceSamples());
    settings.air_nodes = 16;
    settings.lamps = {.nodes = 24, .share_of_error = 5e-4};
    const double start = ProcessorSeconds();
    for (ReferenceSceneCase& scene : scenes_)
      scene.reference = scene.renderer->Render(scene.instant, settings);
    topic_.reference.time_s =
        (ProcessorSeconds() - start) / (static_cast<double>(kScenes) * Pixels());
  }

  /// Completes the texts that depend on the scenes.
  void Describe() {
    topic_.scene = fmt::format("{} x {}", width_, height_);
    topic_.regimes.clear();
    for (std::size_t r = 0; r < kScenes; ++r)
      topic_.regimes.push_back({kSceneTexts[r].key, kSceneTexts[r].name, SunOf(r)});
    topic_.medium = scenes_.front().renderer->medium();
    topic_.rays = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    topic_.reference.text = fmt::format(
        "the same picture with {} samples per pixel, 16 nodes in the air and 24 for every lamp",
        ReferenceSamples());
    topic_.reference.noise.assign(kScenes, 0.0);
  }

  /// Measures the error of a picture, and its time without the preparation.
  void Measure(const ReferenceSceneCase& scene, const RenderSettings& settings,
               RegimeResult& result) const {
    std::vector<double> seconds;
    for (int pass = 0; pass < (effort_.quick ? 1 : 2); ++pass) {
      const auto [image, taken] =
          Timed([&] { return scene.renderer->Render(scene.instant, settings); });
      seconds.push_back(taken);
      result.error = result.strict = ErrorStatistics(ChangesOf(scene.reference, image));
      ThrowIfInterrupted();
    }
    std::sort(seconds.begin(), seconds.end());
    const bool shafts = settings.effects.Has(Effect::kShafts);
    // Processor clocks tick in microseconds, so a small picture can appear to take no time.
    result.time_s = std::max(seconds.front() - (shafts ? scene.frame_s : 0.0), 1e-6) / Pixels();
    result.time_spread = seconds.back() / seconds.front() - 1.0;
  }

  /// Returns the preparation time of a picture: the time of a picture of one pixel.
  [[nodiscard]] double FrameSeconds(const ReferenceSceneCase& scene) const {
    RenderSettings settings = Settings(1);
    settings.width = settings.height = 1;
    const auto draw = [&] { return scene.renderer->Render(scene.instant, settings); };
    const double first = Timed(draw).second;
    return std::min(first, Timed(draw).second);
  }

  const ReportEffort& effort_;
  int width_, height_;
  std::vector<ReferenceSceneCase> scenes_;
  std::uint64_t range_bytes_ = 0;
  double load_s_ = 0.0;
  ReportTopic topic_;
};

/// Returns a lamp of a runway that points east, placed along the runway from its threshold and left
/// of its centreline.
Light RunwayLamp(const Place& threshold, double along_m, double left_m, double height_m,
                 double candela) {
  constexpr double kRadius_m = 6371000.0;
  Light light;
  light.place = PlaceFromRadians(
      threshold.latitude_rad() + left_m / kRadius_m,
      threshold.longitude_rad() + along_m / (kRadius_m * std::cos(threshold.latitude_rad())), 0.0);
  light.height = {height_m, false};
  light.intensity_cd = candela;
  return light;
}

}  // namespace

Scene RunwayScene(int lamps, bool with_beam) {
  constexpr double kLength_m = 1800.0, kHalfWidth_m = 23.0, kEye_m = 38.0, kApproach_m = 420.0;
  constexpr double kVisibility_m = 900.0;
  const Place threshold{47.46, 8.55, 0.0};
  Scene scene;
  scene.place = threshold;
  scene.medium = MediumPreset("earth");
  scene.terrain.kind = TerrainSource::Kind::kNone;
  scene.camera = CameraFromDegrees({kEye_m, false}, 90.0, -4.0, 0.0, 50.0);
  scene.layers = {MediumLayer{.extinction_per_m = kOpticalDepthOfVisibility / kVisibility_m,
                              .scale_height_m = 25.0,
                              .base_height_m = 0.0,
                              .phase = {.kind = PhaseKind::kHenyeyGreenstein, .g = 0.8}}};
  for (int i = 0; i < lamps; ++i) {
    const double along = kLength_m * (i / 2) / std::max(1, lamps / 2);
    scene.lights.push_back(RunwayLamp(threshold, kApproach_m + along,
                                      i % 2 == 0 ? kHalfWidth_m : -kHalfWidth_m, 0.35, 600.0));
  }
  for (const double side : {-6.0, 6.0}) {
    if (!with_beam) break;
    Light beam = RunwayLamp(threshold, kApproach_m + 180.0, side, 24.0, 4e5);
    beam.type = Light::Type::kSpot;
    beam.temperature_k = 4200.0;
    beam.heading_rad = 0.5 * kPi;
    beam.pitch_rad = -4.0 * kRadiansPerDegree;
    beam.inner_rad = 2.5 * kRadiansPerDegree;
    beam.outer_rad = 6.0 * kRadiansPerDegree;
    scene.lights.push_back(beam);
  }
  return scene;
}

ReportTopic MeasurePictures(const ReportEffort& effort) {
  PicturesTopic topic(effort);
  for (const int samples : {1, 4, 16}) topic.AddSamples(samples);
  if (!effort.quick) topic.AddSamples(32);
  topic.AddNoise(0.04);
  if (!effort.quick) {
    for (const double noise : {0.02, 0.01}) topic.AddNoise(noise);
  }
  if (!effort.quick) topic.AddNodes(2);
  topic.AddNodes(4);
  if (!effort.quick) {
    topic.AddNodes(8);
    topic.AddWithout(Effect::kShafts, "shafts");
  }
  topic.AddWithout(Effect::kMultipleScattering, "higher orders");
  return std::move(topic).Finished();
}

}  // namespace alpenglow::renderer
