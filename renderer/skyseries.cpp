// SPDX-License-Identifier: MIT
// skyseries renders pictures of a scene through the day. A single picture is a series of one.
#include <fmt/format.h>

#include <map>
#include <memory>

#include "atmosphere/base/parsing.h"
#include "atmosphere/math/constants.h"
#include "renderer/camera/track.h"
#include "renderer/scene/places.h"
#include "renderer/scene/scene_options.h"
#include "renderer/series/frame_times.h"
#include "renderer/series/manifest.h"
#include "renderer/series/series.h"
#include "renderer/skyseries_commands.h"
#include "renderer/skyseries_options.h"
#include "renderer/surface/scene_ground.h"

namespace alpenglow::renderer {
namespace {

bool IsTrack(const std::filesystem::path& file) {
  return HasExtension(file, ".gpx") || HasExtension(file, ".kml");
}

/// Returns the track of the options, if they name one.
std::optional<Track> TrackOf(const SkyseriesOptions& options) {
  if (!options.path || !IsTrack(*options.path)) return std::nullopt;
  return ReadTrack(*options.path);
}

/// Returns the place of a path: its middle, from which most of it is visible. A flight over the
/// built-in range begins at the view of the range.
GeodeticPosition PlaceOfPath(const SkyseriesOptions& options, const std::optional<Track>& track) {
  if (track) return track->points[track->points.size() / 2].place;
  const std::vector<CameraPathPoint> points = ReadCameraPath(*options.path).points();
  return points[options.scene.dem.empty() ? 0 : points.size() / 2].pose.place;
}

/// Returns the scene options. Without a scene file and without a place, the path gives the place,
/// except for a path over the built-in range at its home, where the range stays at its place.
SceneOptions OptionsOfScene(const SkyseriesOptions& options, const std::optional<Track>& track) {
  SceneOptions scene = options.scene;
  if (!options.path || scene.place || scene.latitude || scene.longitude) return scene;
  const GeodeticPosition place = PlaceOfPath(options, track);
  if (!track && scene.dem.empty() && IsOnRangeAtHome(place)) return scene;
  scene.latitude = place.latitude_rad / kRadiansPerDegree;
  scene.longitude = place.longitude_rad / kRadiansPerDegree;
  return scene;
}

Scene SceneOf(const SkyseriesOptions& options, const std::optional<Track>& track) {
  Scene scene = options.scene_file.empty() ? SceneFromOptions(OptionsOfScene(options, track))
                                           : ReadScene(options.scene_file);
  if (options.scene.place) scene.zone = PlaceNamed(*options.scene.place).zone;
  if (options.zone) scene.zone = options.zone;
  return scene;
}

/// Returns a track as a path; loads the ground unless the track's heights are above the sea.
CameraPath PathOfTrack(const SkyseriesOptions& options, const Track& track, const Scene& scene) {
  if (!track.note.empty())
    Say(fmt::format("skyseries: warning: {}: {}\n", *options.path, track.note));
  TrackStyle style = options.track;
  style.fov_rad = scene.camera.fov_rad;
  std::optional<SceneGround> ground;
  return PathAlong(track, style, [&](const GeodeticPosition& place) {
    if (!ground) ground.emplace(LoadGround(scene));
    return GroundHeightUnder(*ground, place);
  });
}

std::optional<CameraPath> PathOf(const SkyseriesOptions& options, const std::optional<Track>& track,
                                 const Scene& scene) {
  if (!options.path) return std::nullopt;
  if (track) return PathOfTrack(options, *track, scene);
  const Camera& camera = scene.camera;
  return ReadCameraPath(*options.path, {scene.place, camera.heading_rad, camera.pitch_rad,
                                        camera.roll_rad, camera.fov_rad});
}

PathRate RateOf(const SkyseriesOptions& options) {
  return {options.times.every, options.times.count, options.frames_per_second};
}

std::vector<Frame> FramesOf(const SkyseriesOptions& options, const Scene& scene,
                            const std::optional<CameraPath>& path) {
  EventDay day{scene.place, scene.zone, scene.time};
  if (options.date) day.around = DayFromText(*options.date, day);
  if (path) {
    const auto start =
        options.times.at.empty() ? scene.time : InstantFromText(options.times.at.front(), day);
    if (!start && !path->UtcAt(0.0)) throw InputError("a path without utc needs a time: --at");
    return FramesAlong(*path, RateOf(options), start.value_or(UtcInstant{}));
  }
  const bool typed = !options.times.at.empty() || options.times.from;
  if (!typed && scene.time && !options.date) return {{0, *scene.time}};
  return FramesFromTimes(options.times, day);
}

/// The options, read once into the values that a series needs, before anything is rendered.
struct SeriesPlan {
  explicit SeriesPlan(const SkyseriesOptions& options) : SeriesPlan(options, TrackOf(options)) {}

  Scene scene;
  std::optional<CameraPath> path;
  std::vector<Frame> frames, selected;
  double shutter_s;  // on a path, the time that the shutter is open

  /// Returns the place of the eye in a frame; without a path, that of the scene.
  [[nodiscard]] GeodeticPosition PlaceOf(const Frame& frame) const {
    return path ? path->PoseAt(frame.path_s).place : scene.place;
  }

 private:
  SeriesPlan(const SkyseriesOptions& options, const std::optional<Track>& track)
      : scene(SceneOf(options, track)),
        path(PathOf(options, track, scene)),
        frames(FramesOf(options, scene, path)),
        selected(options.frames ? SelectFrames(frames, *options.frames) : frames),
        shutter_s(path ? options.shutter * FrameInterval(*path, RateOf(options)) : 0.0) {}
};

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
    Say(fmt::format("skyseries: {}\n", renderer->terrain_message()));
  }
  return renderer;
}

Metadata MetadataOf(const Scene& scene, const std::optional<CameraPath>& path,
                    const RenderSettings& settings, const SkyseriesOptions& options) {
  Metadata metadata = PictureMetadata(scene, settings);
  if (path) {
    metadata["alpenglow.path"] =
        fmt::format("hash {}, shutter {} of {} s", Fingerprint({{"path", TextOf(*path)}}),
                    options.shutter, FrameInterval(*path, RateOf(options)));
  }
  if (ChoosesEffects(options)) {
    metadata["alpenglow.effects"] += fmt::format(" within {}", BudgetOf(options).max_error);
  }
  return metadata;
}

/// Returns the file name if one is given.
std::optional<std::filesystem::path> FileOf(const std::optional<std::string>& name) {
  return name ? std::optional<std::filesystem::path>(*name) : std::nullopt;
}

RenderSettings SettingsOf(const SkyseriesOptions& options) {
  const ImageSize size = ImageSizeFromText(options.size);
  RenderSettings settings;
  settings.width = size.width;
  settings.height = size.height;
  SetRays(options, settings);
  settings.effects = EffectsOf(options);
  settings.filter = PixelFilterFromName(options.filter);
  settings.layers = LayersFromNames(options.layers);
  if (options.night_vision) settings.layers.push_back(PictureLayer::kScotopic);
  return settings;
}

/// Renders the frames of a series. The renderer is built for the first frame that needs it. Sun and
/// moon of a frame are computed once.
class FramePictures {
 public:
  FramePictures(const SeriesPlan& plan, const SkyseriesOptions& options)
      : plan_(plan), options_(options), settings_(SettingsOf(options)) {}

  [[nodiscard]] const RenderSettings& settings() const { return settings_; }

  [[nodiscard]] NotedPicture Render(const Frame& frame, Progress& progress) {
    settings_.progress = &progress;
    const SceneRenderer& renderer = Loaded(&progress);
    const CameraSample camera_sample = ShotAt(frame);
    NotedPicture picture = Rendered(renderer, camera_sample);
    picture.notes[kIlluminanceNote] = fmt::format("{:.6g}", renderer.Illuminance(camera_sample));
    return picture;
  }
  /// Returns the illuminance behind the polariser [lux].
  [[nodiscard]] double Illuminance(const Frame& frame) {
    const double behind_filter = plan_.scene.camera.polariser_rad ? 0.5 : 1.0;
    return behind_filter * Loaded(nullptr).Illuminance(ShotAt(frame));
  }
  [[nodiscard]] Image Small(const Frame& frame) {
    return Loaded(nullptr).Render(ShotAt(frame), PreviewSettings(settings_, options_));
  }

 private:
  [[nodiscard]] const SceneRenderer& Loaded(Progress* progress) {
    if (!renderer_) renderer_ = Load(plan_.scene, progress);
    return *renderer_;
  }
  [[nodiscard]] CameraSample ShotAt(const Frame& frame) {
    CameraSample camera_sample = plan_.path ? CameraSampleOf(frame, *plan_.path, plan_.shutter_s)
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
    if (!ChoosesEffects(options_) && !options_.explain) {
      CountedPicture picture = renderer.RenderCounted(camera_sample, settings_);
      return {std::move(picture.image), NotesOn(picture.rays, settings_)};
    }
    ChosenPicture picture = renderer.RenderWithin(camera_sample, settings_, BudgetOf(options_));
    if (options_.explain)
      Print(fmt::format("{}\n{}\n", FormatUtc(camera_sample.instant), ExplainText(picture.choice)));
    Metadata notes = NotesOn(picture.choice);
    notes.merge(NotesOn(picture.rays, settings_));
    return {std::move(picture.image), std::move(notes)};
  }

  const SeriesPlan& plan_;
  const SkyseriesOptions& options_;
  RenderSettings settings_;
  std::unique_ptr<SceneRenderer> renderer_;
  std::map<int, SkyBodies> bodies_;  // by the number of the frame
};

SeriesSource SourceOf(const SeriesPlan& plan, const SkyseriesOptions& options,
                      FramePictures& pictures) {
  const Scene& scene = plan.scene;
  return {[&](const Frame& frame, Progress& progress) { return pictures.Render(frame, progress); },
          [&](const Frame& frame) { return pictures.Illuminance(frame); },
          MetadataOf(scene, plan.path, pictures.settings(), options),
          scene.place,
          scene.zone,
          plan.path,
          scene.camera.IsPanorama() ? Projection::kLatitudeLongitude : Projection::kCamera,
          scene.camera.fov_rad,
          [&](const Frame& frame) { return pictures.Small(frame); },
          scene.medium.follows_wgs84};
}

SeriesOutput OutputOf(const SkyseriesOptions& options) {
  SeriesOutput output{FrameName(options.out)};
  output.png = options.png;
  output.exposure = ExposureRuleFromText(options.exposure);
  output.look = LookFromName(options.tone_curve);
  output.look.agx = AgxLookFromName(options.look);
  output.look.night_vision = options.night_vision;
  output.look.white = WhiteBalanceFromText(options.white_balance);
  output.look = LookUnder(output.exposure, output.look);
  output.glare = options.glare == "eye";
  output.resume = options.resume;
  output.contact_sheet = FileOf(options.contact_sheet);
  output.keogram = FileOf(options.keogram);
  output.plot = FileOf(options.plot);
  output.video = FileOf(options.video);
  output.video_frames_per_s = options.frames_per_second;
  output.progress = options.common.progress_style();
  return output;
}

void List(const SkyseriesOptions& options) {
  const SeriesPlan plan(options);
  std::optional<FrameName> name;
  if (!options.out.empty()) name.emplace(options.out);
  std::vector<FrameRecord> records;
  for (const Frame& frame : plan.selected) {
    FrameRecord& record =
        records.emplace_back(RecordOf(frame, plan.PlaceOf(frame), plan.scene.zone));
    if (name) record.Set("file", name->Exr(frame.number).string());
  }
  Print(ListOf(records));
}

void PrintSummary(const SeriesSummary& summary) {
  if (summary.removed > 0) {
    Say(fmt::format("skyseries: removed {} unfinished files of runs that were killed\n",
                    summary.removed));
  }
  Say(fmt::format("skyseries: {} rendered, {} developed again, {} kept\n", summary.rendered,
                  summary.developed, summary.kept));
}

int Run(const SkyseriesOptions& options) {
  const ThreadLimit threads(options.common.threads);
  SeriesOutput output = OutputOf(options);
  const SeriesPlan plan(options);
  output.inputs = InputsOf(options, plan.scene);
  FramePictures pictures(plan, options);
  const SeriesSummary summary =
      RunSeries(SourceOf(plan, options, pictures), plan.frames, plan.selected, output);
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
    List(options);
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
