// SPDX-License-Identifier: MIT
// skyseries renders pictures of a scene through the day. A single picture is a series of one.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "atmosphere/math/constants.h"
#include "lut/cli/terminal.h"
#include "renderer/camera/track.h"
#include "renderer/camera/track_file.h"
#include "renderer/camera/track_names.h"
#include "renderer/path_tracing/traceable_scene.h"
#include "renderer/scene/places.h"
#include "renderer/scene/scene_clouds.h"
#include "renderer/scene/scene_options.h"
#include "renderer/scene/scene_weather.h"
#include "renderer/series/frame_times.h"
#include "renderer/series/manifest.h"
#include "renderer/series/scene_metadata.h"
#include "renderer/series/series.h"
#include "renderer/skyseries_commands.h"
#include "renderer/skyseries_options.h"
#include "renderer/surface/scene_ground.h"

namespace alpenglow::renderer {
namespace {

/// Returns the place of a path: its middle, from which most of it is visible. A flight over the
/// built-in range begins at the view of the range.
Place PlaceOfPath(const std::string& file, const std::optional<Track>& track, bool over_range) {
  if (track) return track->points[track->points.size() / 2].place;
  const std::vector<CameraPathPoint> points = ReadCameraPath(file).points();
  return points[over_range ? 0 : points.size() / 2].pose.place;
}

/// Returns the scene options. Without a place, the path gives the place, except for a path over the
/// built-in range at its home, where the range stays at its place.
SceneOptions AlongPath(SceneOptions scene, const std::string& file,
                       const std::optional<Track>& track) {
  if (scene.place || scene.latitude || scene.longitude) return scene;
  const bool over_range = scene.dem.empty();
  const Place place = PlaceOfPath(file, track, over_range);
  if (!track && over_range && IsOnRangeAtHome(place)) return scene;
  scene.latitude = place.latitude_deg;
  scene.longitude = place.longitude_deg;
  return scene;
}

Scene SceneOf(const SkyseriesOptions& options, const std::optional<Track>& track) {
  const SceneWeather& weather = options.weather;
  if (!options.scene_file.empty()) return ReadScene(options.scene_file, kForPictures, weather);
  const SceneOptions placed = options.path ? AlongPath(options.scene, *options.path, track)
                                           : AtStation(options.scene, weather);
  Scene scene = SceneFromOptions(placed);
  if (placed.place) scene.zone = PlaceNamed(*placed.place).zone;
  if (!weather.metar) return scene;
  scene.time.reset();  // noon by default; the report has its own time
  return InTypedWeather(std::move(scene), weather);
}

/// Returns a track as a path; loads the ground unless the track's heights are above the sea.
CameraPath PathOfTrack(const Track& track, TrackStyle style, const Scene& scene) {
  if (!track.note.empty()) Log(fmt::format("skyseries: warning: {}: {}\n", track.file, track.note));
  style.fov_rad = scene.camera.fov_rad;
  std::optional<SceneGround> ground;
  return PathAlong(track, style, [&](const Place& place) {
    if (!ground) ground.emplace(LoadGround(scene));
    return GroundHeightUnder(*ground, place);
  });
}

/// Throws InputError with the file and the point if the scene cannot be seen from a point of a path.
/// Land is not loaded: over land, only the distance from the scene's place is checked here.
void RequireVisible(const CameraPath& path, const std::string& file, const Scene& scene) {
  Scene bare = scene;
  bare.terrain = {};
  bare.terrain.kind = TerrainSource::Kind::kNone;
  const SceneGround ground = LoadGround(bare);
  const bool has_land = scene.terrain.kind != TerrainSource::Kind::kNone;
  CheckPoints(path, file, [&](Place place) {
    if (has_land) place.height_m = std::max(place.height_m, 0.0);
    static_cast<void>(FromEyeAt(ground, place));
  });
}

/// The series that the options describe, resolved once before anything is rendered.
struct SeriesPlan {
  Scene scene;
  SeriesViewpoint viewpoint;
  std::vector<Frame> frames, selected;
  double shutter = 0.0, interval_s = 0.0;  // on a path: fraction of the time between frames
  RenderSettings settings;
  std::optional<EffectBudget> budget;  // none: all effects of the settings are rendered
};

/// Returns the frames of a series that does not follow a path.
std::vector<Frame> FramesAt(const TimesText& times, bool on_date, const Scene& scene,
                            const EventDay& day) {
  const bool typed = !times.at.empty() || times.from;
  if (!typed && scene.time && !on_date) return {{0, *scene.time}};
  return FramesFromTimes(times, day);
}

SeriesPlan PlanOf(const SkyseriesOptions& options) {
  std::optional<Track> track;
  if (options.path && IsTrack(*options.path)) track = ReadTrack(*options.path);
  SeriesPlan plan;
  plan.scene = SceneOf(options, track);
  for (const std::string& note : plan.scene.weather.notes) Warn(note);
  if (options.zone) plan.scene.zone = options.zone;
  if (options.clouds) plan.scene.clouds = CloudsFromText(*options.clouds);
  const Scene& scene = plan.scene;
  plan.viewpoint = {scene.place, scene.zone, {}, scene.medium.follows_wgs84};
  std::optional<CameraPath>& path = plan.viewpoint.path;
  if (track) {
    path = PathOfTrack(*track, options.track, scene);
  } else if (options.path) {
    path = ReadCameraPath(*options.path,
                          {scene.place, scene.camera.heading_rad, scene.camera.pitch_rad,
                           scene.camera.roll_rad, scene.camera.fov_rad});
    RequireVisible(*path, *options.path, scene);
  }
  EventDay day{scene.place, scene.zone, scene.time};
  if (options.date) day.around = DayFromText(*options.date, day);
  const TimesText& times = options.times;
  if (path) {
    const auto start = times.at.empty() ? scene.time : InstantFromText(times.at.front(), day);
    if (!start && !path->UtcAt(0.0)) throw InputError("a path without utc needs a time: --at");
    const PathRate rate{times.every, times.count, options.frames_per_second};
    plan.frames = FramesAlong(*path, rate, start.value_or(UtcTime{}));
    plan.shutter = options.shutter;
    plan.interval_s = FrameInterval(*path, rate);
  } else {
    plan.frames = FramesAt(times, options.date.has_value(), scene, day);
  }
  if (!scene.clouds.empty())
    plan.scene.cloud_day = CloudDayNear(scene, plan.frames.front().instant);
  plan.selected = options.frames ? SelectFrames(plan.frames, *options.frames) : plan.frames;
  plan.settings = options.settings;
  if (plan.settings.paths) RequireTraceable(scene);
  plan.budget = options.budget;
  return plan;
}

std::vector<NamedFile> InputsOf(const SkyseriesOptions& options, const Scene& scene) {
  std::vector<NamedFile> inputs = FilesOf(scene);
  if (!options.scene_file.empty()) inputs.push_back({"the scene", options.scene_file});
  if (options.path) inputs.push_back({"--path", *options.path});
  if (options.scene.atmosphere) inputs.push_back({"--atmosphere", *options.scene.atmosphere});
  return inputs;
}

std::unique_ptr<SceneRenderer> Load(const Scene& scene, Progress* progress) {
  auto renderer = std::make_unique<SceneRenderer>(scene, progress);
  if (!renderer->terrain_message().empty()) {
    Log(fmt::format("skyseries: {}\n", renderer->terrain_message()));
  }
  return renderer;
}

/// Returns the settings of the small picture that meters a series: 96 pixels along the longer side,
/// with the effects of `settings`.
RenderSettings PreviewSettings(const RenderSettings& settings, bool night_vision) {
  constexpr int kLongSide = 96;
  RenderSettings preview;
  const int longest = std::max(settings.width, settings.height);
  preview.width = std::max(settings.width * kLongSide / longest, 1);
  preview.height = std::max(settings.height * kLongSide / longest, 1);
  preview.effects = settings.effects;
  preview.filter = settings.filter;
  if (night_vision) preview.layers.push_back(PictureLayer::kScotopic);
  return preview;
}

/// Renders the frames of a series. The renderer is built for the first frame that needs it. Sun and
/// moon of a frame are computed once.
class FramePictures {
 public:
  FramePictures(const SeriesPlan& plan, bool night_vision, bool is_quiet)
      : plan_(plan),
        is_quiet_(is_quiet),
        settings_(plan.settings),
        preview_(PreviewSettings(plan.settings, night_vision)) {}

  [[nodiscard]] NotedPicture Render(const Frame& frame, Progress& progress) {
    settings_.progress = &progress;
    const SceneRenderer& renderer = Loaded(&progress);
    const CameraSample camera_sample = CameraSampleAt(frame);
    NotedPicture picture = Rendered(renderer, camera_sample);
    picture.notes[kIlluminanceNote] = fmt::format("{:.6g}", renderer.Illuminance(camera_sample));
    return picture;
  }
  /// Returns the illuminance behind the polariser [lux].
  [[nodiscard]] double Illuminance(const Frame& frame) {
    const double behind_filter = plan_.scene.camera.polariser_rad ? 0.5 : 1.0;
    return behind_filter * Loaded(nullptr).Illuminance(CameraSampleAt(frame));
  }
  [[nodiscard]] HdrImage Small(const Frame& frame) {
    return Loaded(nullptr).Render(CameraSampleAt(frame), preview_);
  }

 private:
  [[nodiscard]] const SceneRenderer& Loaded(Progress* progress) {
    if (!renderer_) renderer_ = Load(plan_.scene, progress);
    return *renderer_;
  }
  [[nodiscard]] CameraSample CameraSampleAt(const Frame& frame) {
    CameraSample camera_sample =
        plan_.viewpoint.path
            ? CameraSampleOf(frame, *plan_.viewpoint.path, plan_.shutter * plan_.interval_s)
            : CameraSample(frame.instant);
    const auto known = bodies_.find(frame.number);
    camera_sample.bodies =
        known != bodies_.end()
            ? known->second
            : bodies_.emplace(frame.number, Loaded(nullptr).BodiesOver(camera_sample))
                  .first->second;
    return camera_sample;
  }
  [[nodiscard]] NotedPicture Rendered(const SceneRenderer& renderer,
                                      const CameraSample& camera_sample) const {
    if (!plan_.budget) {
      CountedPicture picture = renderer.RenderCounted(camera_sample, settings_);
      if (picture.rays.path_error && !is_quiet_) {
        Log(fmt::format("skyseries: {}: the mean standard error of pixels is {:.2g} %\n",
                        FormatUtc(camera_sample.instant), 100.0 * *picture.rays.path_error));
      }
      return {std::move(picture.image), NotesOn(picture.rays, settings_)};
    }
    ChosenPicture picture = renderer.RenderWithin(camera_sample, settings_, *plan_.budget);
    if (plan_.budget->explain)
      Print(fmt::format("{}\n{}\n", FormatUtc(camera_sample.instant), ExplainText(picture.choice)));
    Metadata notes = NotesOn(picture.choice);
    notes.merge(NotesOn(picture.rays, settings_));
    return {std::move(picture.image), std::move(notes)};
  }

  const SeriesPlan& plan_;
  bool is_quiet_;
  RenderSettings settings_;  // those of the plan, and the progress of a frame
  const RenderSettings preview_;
  std::unique_ptr<SceneRenderer> renderer_;
  std::map<int, SkyBodies> bodies_;  // by the number of the frame
};

Metadata MetadataOf(const SeriesPlan& plan) {
  Metadata metadata = PictureMetadata(plan.scene, HashFilesOf(plan.scene), plan.settings);
  if (plan.viewpoint.path) {
    // Poses replace place and camera of the scene, which still place its mesh or range.
    metadata["alpenglow.path"] = fmt::format(
        "hash {}, shutter {} of {} s",
        Fingerprint({{"path", TextOf(*plan.viewpoint.path)}, {"scene", Fingerprint(metadata)}}),
        plan.shutter, plan.interval_s);
  }
  if (plan.budget && plan.budget->leave_out)
    metadata["alpenglow.effects"] += fmt::format(" within {}", plan.budget->max_error);
  return metadata;
}

SeriesSource SourceOf(const SeriesPlan& plan, FramePictures& pictures) {
  const Scene& scene = plan.scene;
  return {[&](const Frame& frame, Progress& progress) { return pictures.Render(frame, progress); },
          [&](const Frame& frame) { return pictures.Illuminance(frame); },
          MetadataOf(plan),
          plan.viewpoint,
          scene.camera.IsPanorama() ? Projection::kLatitudeLongitude : Projection::kCamera,
          scene.camera.fov_rad,
          [&](const Frame& frame) { return pictures.Small(frame); }};
}

/// Prints the frames, each as soon as it is known.
void List(const SeriesPlan& plan, const std::string& out) {
  std::optional<FrameName> name;
  if (!out.empty()) name.emplace(out);
  PrintNow(HeaderOfList());
  for (const Frame& frame : plan.selected) {
    ThrowIfInterrupted();
    FrameRecord record = plan.viewpoint.RecordOf(frame);
    if (name) record.Set("file", name->Picture(frame.number).string());
    PrintNow(ListLineOf(record));
  }
}

void PrintSummary(const SeriesSummary& summary) {
  if (summary.removed > 0) {
    Log(fmt::format("skyseries: removed {} unfinished files of runs that were killed\n",
                    summary.removed));
  }
  constexpr int kAnyColumns = 1000, kLeastColumns = 20;
  const int columns = std::max(ColumnsOf(STDERR_FILENO, kAnyColumns), kLeastColumns);
  Log(Wrapped(fmt::format("skyseries: {} rendered, {} developed again, {} kept", summary.rendered,
                          summary.developed, summary.kept),
              static_cast<std::size_t>(columns), ""));
}

int Run(const SkyseriesOptions& options) {
  const ThreadLimit threads(options.common.threads);
  SeriesOutput output = options.output;
  output.name = FrameName(options.out);
  const SeriesPlan plan = PlanOf(options);
  output.inputs = InputsOf(options, plan.scene);
  FramePictures pictures(plan, output.look.night_vision, options.common.quiet);
  const SeriesSummary summary =
      RunSeries(SourceOf(plan, pictures), plan.frames, plan.selected, output);
  if (!options.common.quiet) PrintSummary(summary);
  return 0;
}

int Main(int argc, char** argv) {
  CLI::App app(
      "Render pictures of a scene at one time or through the day: sky, terrain and the air "
      "between.",
      "skyseries");
  SkyseriesOptions options;
  AddSkyseriesOptions(app, options);
  const std::function<void()> report = AddPictureReportCommand(app);
  const std::function<void()> times = AddTimesCommand(app);
  if (const std::optional<int> status = ParseCommandLine(app, argc, argv)) return *status;
  if (app.got_subcommand("report")) {
    report();
  } else if (app.got_subcommand("times")) {
    times();
  } else if (options.list) {
    const ThreadLimit threads(options.common.threads);
    List(PlanOf(options), options.out);
  } else {
    return Run(options);
  }
  return 0;
}

}  // namespace
}  // namespace alpenglow::renderer

int main(int argc, char** argv) {
  return alpenglow::renderer::RunProgram("skyseries",
                                         [&] { return alpenglow::renderer::Main(argc, argv); });
}
