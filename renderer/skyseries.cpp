// SPDX-License-Identifier: MIT
// skyseries renders pictures of a scene through the day. A single picture is a series of one.
#include <fmt/format.h>

#include <algorithm>
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

/// Returns the place of a path: its middle, from which most of it is visible. A flight over the
/// built-in range begins at the view of the range.
GeodeticPosition PlaceOfPath(const SkyseriesOptions& options) {
  if (IsTrack(*options.path)) {
    const std::vector<TrackPoint> points = ReadTrack(*options.path).points;
    return points[points.size() / 2].place;
  }
  const std::vector<CameraPathPoint> points = ReadCameraPath(*options.path).points();
  return points[options.scene.dem.empty() ? 0 : points.size() / 2].pose.place;
}

/// Returns the scene options. Without a scene file and without a place, the path gives the place,
/// except for a path over the built-in range at its home, where the range stays at its place.
SceneOptions OptionsOfScene(const SkyseriesOptions& options) {
  SceneOptions scene = options.scene;
  if (!options.path || scene.place || scene.latitude || scene.longitude) return scene;
  const GeodeticPosition place = PlaceOfPath(options);
  if (!IsTrack(*options.path) && scene.dem.empty() && IsOnRangeAtHome(place)) return scene;
  scene.latitude = place.latitude_rad / kRadiansPerDegree;
  scene.longitude = place.longitude_rad / kRadiansPerDegree;
  return scene;
}

Scene SceneOf(const SkyseriesOptions& options) {
  Scene scene = options.scene_file.empty() ? SceneFromOptions(OptionsOfScene(options))
                                           : ReadScene(options.scene_file);
  if (options.scene.place) scene.zone = PlaceNamed(*options.scene.place).zone;
  if (options.zone) scene.zone = options.zone;
  return scene;
}

/// Returns a track as a path; loads the ground unless the track's heights are above the sea.
CameraPath PathOfTrack(const SkyseriesOptions& options, const Scene& scene) {
  const Track track = ReadTrack(*options.path);
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

std::optional<CameraPath> PathOf(const SkyseriesOptions& options, const Scene& scene) {
  if (!options.path) return std::nullopt;
  if (IsTrack(*options.path)) return PathOfTrack(options, scene);
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

NotedPicture RenderFrame(const SceneRenderer& renderer, const CameraSample& camera_sample,
                         const RenderSettings& settings, const SkyseriesOptions& options) {
  if (!ChoosesEffects(options) && !options.explain) {
    CountedPicture picture = renderer.RenderCounted(camera_sample, settings);
    return {std::move(picture.image), NotesOn(picture.rays, settings)};
  }
  ChosenPicture picture = renderer.RenderWithin(camera_sample, settings, BudgetOf(options));
  if (options.explain)
    Print(fmt::format("{}\n{}\n", FormatUtc(camera_sample.instant), ExplainText(picture.choice)));
  Metadata notes = NotesOn(picture.choice);
  notes.merge(NotesOn(picture.rays, settings));
  return {std::move(picture.image), std::move(notes)};
}

void List(const SkyseriesOptions& options) {
  const Scene scene = SceneOf(options);
  const std::optional<CameraPath> path = PathOf(options, scene);
  const std::vector<Frame> frames = FramesOf(options, scene, path);
  std::optional<FrameName> name;
  if (!options.out.empty()) name.emplace(options.out);
  std::vector<FrameRecord> records;
  for (const Frame& frame : options.frames ? SelectFrames(frames, *options.frames) : frames) {
    const GeodeticPosition place = path ? path->PoseAt(frame.path_s).place : scene.place;
    FrameRecord& record = records.emplace_back(RecordOf(frame, place, scene.zone));
    if (name) record.Set("file", name->Exr(frame.number).string());
  }
  Print(ListOf(records));
}

int Run(const SkyseriesOptions& options) {
  const ThreadLimit threads(options.common.threads);
  SeriesOutput output{FrameName(options.out)};
  const Scene scene = SceneOf(options);
  const std::optional<CameraPath> path = PathOf(options, scene);
  const std::vector<Frame> frames = FramesOf(options, scene, path);
  const std::vector<Frame> selected =
      options.frames ? SelectFrames(frames, *options.frames) : frames;
  output.png = options.png;
  output.exposure = ExposureRuleFromText(options.exposure);
  output.look = LookFromName(options.tone_curve);
  output.look.agx = AgxLookFromName(options.look);
  output.look.night_vision = options.night_vision;
  output.look.white = WhiteBalanceFromText(options.white_balance);
  output.look = LookUnder(output.exposure, output.look);
  output.glare = options.glare == "eye";
  output.resume = options.resume;
  output.inputs = InputsOf(options, scene);
  output.contact_sheet = FileOf(options.contact_sheet);
  output.keogram = FileOf(options.keogram);
  output.plot = FileOf(options.plot);
  output.video = FileOf(options.video);
  output.video_frames_per_s = options.frames_per_second;
  output.progress = options.common.progress_style();

  const ImageSize size = ImageSizeFromText(options.size);
  RenderSettings settings;
  settings.width = size.width;
  settings.height = size.height;
  SetRays(options, settings);
  settings.effects = EffectsOf(options);
  settings.filter = PixelFilterFromName(options.filter);
  settings.layers = LayersFromNames(options.layers);
  if (options.night_vision) settings.layers.push_back(PictureLayer::kScotopic);
  std::unique_ptr<SceneRenderer> loaded;
  // The renderer is built for the first frame that needs it.
  const auto renderer = [&](Progress* progress) -> const SceneRenderer& {
    if (!loaded) loaded = Load(scene, progress);
    return *loaded;
  };
  const auto camera_sample = [&](const Frame& frame) {
    return path ? CameraSampleOf(frame, *path,
                                 options.shutter * FrameInterval(*path, RateOf(options)))
                : CameraSample(frame.instant);
  };
  const SeriesSource source{
      [&](const Frame& frame, Progress& progress) {
        settings.progress = &progress;
        NotedPicture picture =
            RenderFrame(renderer(&progress), camera_sample(frame), settings, options);
        picture.notes[kIlluminanceNote] =
            fmt::format("{:.6g}", renderer(nullptr).Illuminance(camera_sample(frame)));
        return picture;
      },
      [&](const Frame& frame) {
        const double behind_filter = scene.camera.polariser_rad ? 0.5 : 1.0;
        return behind_filter * renderer(nullptr).Illuminance(camera_sample(frame));
      },
      MetadataOf(scene, path, settings, options),
      scene.place,
      scene.zone,
      path,
      scene.camera.IsPanorama() ? Projection::kLatitudeLongitude : Projection::kCamera,
      scene.camera.fov_rad,
      [&](const Frame& frame) {
        return renderer(nullptr).Render(camera_sample(frame), PreviewSettings(settings, options));
      },
      scene.medium.follows_wgs84};
  const SeriesSummary summary = RunSeries(source, frames, selected, output);
  if (!options.common.quiet) {
    if (summary.removed > 0) {
      Say(fmt::format("skyseries: removed {} unfinished files of runs that were killed\n",
                      summary.removed));
    }
    Say(fmt::format("skyseries: {} rendered, {} developed again, {} kept\n", summary.rendered,
                    summary.developed, summary.kept));
  }
  return 0;
}

int Main(int argc, char** argv) {
  CLI::App app("Pictures of a scene through the day: sky, terrain and the air between.",
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
