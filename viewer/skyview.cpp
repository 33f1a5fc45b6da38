// SPDX-License-Identifier: MIT
// The program skyview: an interactive flight through a scene, rendered on the GPU.
#include <fmt/format.h>

#include <chrono>
#include <future>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "lut/cli/growing_file.h"
#include "lut/cli/output_file.h"
#include "lut/cli/outputs.h"
#include "lut/image/picture_format.h"
#include "renderer/camera/track.h"
#include "renderer/camera/track_file.h"
#include "renderer/camera/track_names.h"
#include "renderer/scene/places.h"
#include "renderer/scene/scene_clouds.h"
#include "renderer/scene/scene_options.h"
#include "renderer/scene/scene_weather.h"
#include "renderer/series/frame_times.h"
#include "renderer/series/video.h"
#include "viewer/flight/flight_recorder.h"
#include "viewer/flight_session.h"
#include "viewer/gl/gl_context.h"
#include "viewer/gl/render_target.h"
#include "viewer/picture_writer.h"
#include "viewer/reports.h"
#include "viewer/skyview_options.h"
#include "viewer/viewer_app.h"
#include "viewer/window.h"

namespace alpenglow::viewer {
namespace {

/// Places the eye over the middle of the given elevation models if the command line does not give a
/// position.
void StandOverTheLand(const SkyviewOptions& options, SceneOptions& typed) {
  if (options.dem.empty() || typed.place || (typed.latitude && typed.longitude)) return;
  LandSource land;
  for (const std::string& file : options.dem) land.files.emplace_back(file);
  const LandTiles tiles(land);
  const Place middle = tiles.Middle();
  if (!typed.latitude) typed.latitude = middle.latitude_deg;
  if (!typed.longitude) typed.longitude = middle.longitude_deg;
  if (!options.altitude) typed.above_ground_m = 300.0;
}

/// @param track  the track of --path, if it is one: without another place, the scene is that of its
///     middle, as in skyseries.
Scene SceneOf(const SkyviewOptions& options, const std::optional<Track>& track) {
  if (!options.scene_file.empty())
    return ReadScene(options.scene_file, kForViewer, options.weather);
  SceneOptions typed;
  typed.place = options.place;
  typed.latitude = options.latitude;
  typed.longitude = options.longitude;
  typed.height_m = options.altitude;
  typed.heading = options.heading;
  typed.pitch = options.pitch;
  typed.dem = options.dem;
  if (track && !typed.place && !typed.latitude && !typed.longitude) {
    const Place middle = track->points[track->points.size() / 2].place;
    typed.latitude = middle.latitude_deg;
    typed.longitude = middle.longitude_deg;
  }
  StandOverTheLand(options, typed);
  Scene scene = SceneFromOptions(AtStation(typed, options.weather));
  scene.time.reset();  // StartOf uses noon at the place instead of noon in Greenwich
  return options.weather.metar ? InTypedWeather(std::move(scene), options.weather) : scene;
}

// A position and directions on the command line override the camera of a scene file.
EyePlacement PlacementOf(const SkyviewOptions& options) {
  EyePlacement placement;
  if (options.scene_file.empty()) return placement;
  placement.latitude_deg = options.latitude;
  placement.longitude_deg = options.longitude;
  placement.height_m = options.altitude;
  placement.heading_deg = options.heading;
  placement.pitch_deg = options.pitch;
  return placement;
}

/// Returns the scene with the clouds of --clouds, if there are any, and writes messages about its weather.
Scene WithClouds(Scene scene, const SkyviewOptions& options) {
  for (const std::string& note : scene.weather.notes) Warn(note);
  if (options.clouds) scene.clouds = CloudsFromText(*options.clouds);
  return scene;
}

UtcTime StartOf(const SkyviewOptions& options, const Scene& scene) {
  if (!options.time && scene.time) return *scene.time;
  Place place = options.place ? PlaceNamed(*options.place).place
                              : Placed({scene.place}, PlacementOf(options)).place;
  place.height_m = 0.0;  // as in skyseries, events are those at sea level
  const EventDay day{place, scene.zone, scene.time.value_or(ParseInstant("2026-06-21T12:00:00Z"))};
  return InstantFromText(options.time.value_or("noon"), day);
}

// Without a display, a frame lasts 1/60 s of scene time.
void PaintHeadless(const SkyviewOptions& options, FlightSession& flight, const ImageSize& size,
                   FlightRecorder& recorder) {
  constexpr double kFrame_s = 1.0 / 60.0;
  if (options.record)
    flight.WaitUntilReady(size);  // points are recorded only once the ground is known
  recorder.Record(0.0, flight.eye(), flight.now());
  for (int frame = 1; frame < options.frames; ++frame) {
    flight.Advance({}, kFrame_s);
    recorder.Record(frame * kFrame_s, flight.eye(), flight.now());
  }
  if (options.hud == "on") {
    FlightRecorder none;
    ViewerApp app(flight, none, {options.hud_scale > 0.0 ? options.hud_scale : 1.0, true, {}});
    app.WritePicture(*options.screenshot, size);
  } else {
    PictureWriter(flight).Write(*options.screenshot, size);
  }
}

/// Returns the screen that covers the whole window.
ToneMapPass::Screen ScreenOf(const Window& window) { return {0, window.width(), window.height()}; }

/// While this object exists, the flight and the pictures are written to their files if the display
/// is lost.
class LossOfDisplay {
 public:
  LossOfDisplay(Window& window, FlightRecorder& recorder, ViewerApp& app)
      : window_(window), recorder_(recorder) {
    window.AtLostDisplay([&recorder, &app] {
      try {
        recorder.Finish();
      } catch (const OutputError& fault) {
        Log(fmt::format("skyview: {}\n", fault.what()));
      }
      app.FinishWithoutWindow();
    });
  }
  ~LossOfDisplay() {
    window_.AtLostDisplay([&recorder = recorder_] { recorder.Finish(); });
  }
  LossOfDisplay(const LossOfDisplay&) = delete;
  LossOfDisplay& operator=(const LossOfDisplay&) = delete;

 private:
  Window& window_;
  FlightRecorder& recorder_;
};

void Fly(const SkyviewOptions& options, FlightSession& flight, Window& window,
         FlightRecorder& recorder) {
  using Clock = std::chrono::steady_clock;
  int frames = 0;
  const double scale = options.hud_scale > 0.0 ? options.hud_scale : window.content_scale();
  ViewerApp app(flight, recorder,
                {scale,
                 options.hud != "off",
                 {.invert_y = options.invert_y, .invert_look_y = options.invert_y}});
  flight.standpoint().AwaitGround();
  const LossOfDisplay loss(window, recorder, app);
  bool looks = false;
  for (Clock::time_point before = Clock::now();;) {
    ThrowIfInterrupted();
    const WindowEvents events = window.Poll();
    if (events.close) app.Leave();
    if (app.quit()) return;
    const Clock::time_point now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - before).count();
    before = now;
    app.Advance({events, {window.width(), window.height()}, seconds});
    if (app.TakeFullScreen()) window.SetFullscreen(!window.fullscreen());
    if (looks != (app.mouse_mode() == MouseMode::kLook)) {
      looks = !looks;
      window.CapturePointer(looks);
    }
    if (events.minimised || window.width() == 0 || window.height() == 0) continue;
    app.Paint(ScreenOf(window), seconds);
    window.Swap();
    flight.frames().RecordFrame(std::chrono::duration<double>(Clock::now() - now).count());
    if (options.screenshot && ++frames == options.frames) {
      PictureWriter(flight).Write(*options.screenshot, {window.width(), window.height()});
      return;
    }
  }
}

// Draws the scripted flight into a window or, without a window, into a picture of the given size.
void RunBenchmark(double seconds, FlightSession& flight, const ImageSize& size, Window* window) {
  const RenderTarget picture(size.width, size.height, {PixelFormat::kRgba8},
                             RenderTarget::Depth::kNone);
  const ToneMapPass::Screen screen{window == nullptr ? picture.framebuffer() : 0, size.width,
                                   size.height};
  flight.WaitUntilReady(size);
  const CameraPose start = flight.eye();
  const UtcTime begin = flight.now();
  Benchmark benchmark(seconds);
  flight.frames().SetTimer(&benchmark.timer());
  for (double before_s = 0.0; benchmark.NextFrame(); before_s = benchmark.elapsed_s()) {
    ThrowIfInterrupted();
    if (window != nullptr && window->Poll().close) break;
    flight.Show(BenchmarkFlight(start, begin, benchmark.elapsed_s()));
    const double frame_s = benchmark.elapsed_s() - before_s;
    flight.Paint(screen, frame_s);
    if (window != nullptr) window->Swap();
    flight.frames().RecordFrame(frame_s);
  }
  flight.frames().SetTimer(nullptr);
  Print(benchmark.Text());
  Log(fmt::format("skyview: {}; quality {}\n", benchmark.WorstText(),
                  flight.frames().QualityText()));
}

void WriteFilm(const SkyviewOptions& options, const CameraPath& path, const ImageSize& size,
               FlightSession& flight) {
  const double length_s = path.end_s() - path.begin_s();
  const int frames = 1 + static_cast<int>(length_s * options.fps);
  PictureWriter pictures(flight);
  const VideoSettings settings{
      size.width, size.height, options.fps, {{"alpenglow.replay", *options.replay}}};
  WriteVideo(*options.video, settings, frames, [&](int number) {
    const double seconds = number == 0 ? 0.0 : 1.0 / options.fps;
    return pictures.Film(ReplayAt(path, path.begin_s() + number / options.fps), size, seconds);
  });
}

std::vector<NamedFile> InputsOf(const SkyviewOptions& options, const Scene& scene) {
  std::vector<NamedFile> inputs = FilesOf(scene);
  if (!options.scene_file.empty()) inputs.push_back({"the scene", options.scene_file});
  if (options.replay) inputs.push_back({"--replay", *options.replay});
  if (options.track) inputs.push_back({"--track", *options.track});
  return inputs;
}

std::vector<NamedFile> OutputsOf(const SkyviewOptions& options) {
  std::vector<NamedFile> outputs;
  if (options.record) {
    outputs.push_back({"--record", *options.record});
    outputs.push_back({"--record", GrowingFile::PartOf(*options.record)});
  }
  if (options.video) outputs.push_back({"--video", *options.video});
  if (!options.screenshot) return outputs;
  const bool many = options.replay && options.headless;
  for (const std::filesystem::path& file :
       many ? ReplayPictures(*options.screenshot, options.frames)
            : std::vector<std::filesystem::path>{*options.screenshot}) {
    outputs.push_back({"--screenshot", file});
  }
  return outputs;
}

/// Writes the notes about the land to standard error.
void LogNotes(FlightSession& flight) {
  for (const std::string& note : flight.edits().PollNotes())
    Log(fmt::format("skyview: {}\n", note));
}

/// Writes a message if windows or instruments show another field of view than the scene's.
void LogFieldOfView(const CameraPose& eye) {
  const double shown_rad = InWindow(eye).fov_rad;
  if (shown_rad == eye.fov_rad) return;
  Log(fmt::format(
      "skyview: the field of view is {:.4g} degrees; windows and instruments show {:.4g}"
      ", pictures without instruments all of it\n",
      eye.fov_rad / kRadiansPerDegree, shown_rad / kRadiansPerDegree));
}

/// Returns whether only linear pictures are requested; these can be assembled from tiles.
bool PaintsInParts(const SkyviewOptions& options) {
  return !options.benchmark && !options.explain && options.hud != "on";
}

Track ReadTrackWithNote(const std::string& file) {
  Track track = ReadTrack(file);
  if (!track.note.empty()) Log(fmt::format("skyview: warning: {}: {}\n", file, track.note));
  return track;
}

/// Returns a track as the path that skyseries flies. Waits for land where the track needs its
/// height.
CameraPath PathOfTrack(const Track& track, const Scene& scene, FlightSession& flight) {
  TrackStyle style;
  style.fov_rad = scene.camera.fov_rad;
  return PathAlong(track, style, [&](const Place& place) {
    flight.edits().AwaitGround(place);
    return flight.edits().GroundAt(place);
  });
}

/// Throws InputError with the file and the point if a point of a path is below the ground.
void RequirePointsOver(const CameraPath& path, const std::string& file,
                       const GroundHeight& ground) {
  CheckPoints(path, file, [&](const Place& place) { RequireOverGround(place, ground(place)); });
}

/// Checks a path over land, for which it waits. A mesh is not checked, because it may have caves.
void RequireOverLand(const CameraPath& path, const std::string& file, const Scene& scene,
                     FlightSession& flight) {
  if (scene.terrain.kind == TerrainSource::Kind::kMesh) return;
  RequirePointsOver(path, file, [&](const Place& place) {
    flight.edits().AwaitGround(place);
    return flight.edits().GroundAt(place);
  });
}

int Run(const SkyviewOptions& options) {
  const ThreadLimit threads(options.common.threads);
  const ImageSize size = SizeFromText(options.size);
  if (options.screenshot) (void)FormatOfPicture(*options.screenshot);
  if (options.video) RequireVideo(*options.video);
  std::optional<Track> flown;  // --path, if it is a track
  if (options.replay && IsTrack(*options.replay)) flown = ReadTrackWithNote(*options.replay);
  Scene scene = WithClouds(SceneOf(options, flown), options);
  const UtcTime start = StartOf(options, scene);
  if (!scene.clouds.empty()) scene.cloud_day = CloudDayNear(scene, start);
  std::optional<CameraPath> path;
  if (options.replay && !flown) path = ReadFlight(*options.replay);
  const bool has_land = scene.terrain.kind != TerrainSource::Kind::kNone;
  if (path && !has_land) RequirePointsOver(*path, *options.replay, [](auto&&) { return 0.0; });
  PrepareOutputs(OutputsOf(options), InputsOf(options, scene));  // before the flight
  std::future<FirstAir> first_air;  // computed while the window is being created
  if (!options.headless) {
    // Without a further thread it is computed when it is needed.
    first_air =
        std::async(std::launch::async | std::launch::deferred, DraftOfAir, std::cref(scene));
  }
  // Declared first: the context must outlive the objects that are created in it.
  const auto headless = options.headless ? std::make_unique<HeadlessContext>() : nullptr;
  const auto window =
      options.headless
          ? nullptr
          : std::make_unique<Window>(WindowSettings{size.width, size.height, options.fullscreen,
                                                    options.vsync == "on" && !options.benchmark});
  if (!options.common.quiet) Log(fmt::format("skyview: {}\n", GlDescription()));
  if (window) RequireDrawable(std::max(window->width(), 1), std::max(window->height(), 1));
  if (headless && !PaintsInParts(options)) RequireDrawable(size.width, size.height);
  FlightSession flight(
      scene, start,
      {LandSourceOf(scene), QualityRuleFromText(options.quality), options.frame_rate, size,
       std::nullopt, FlightExposureFromText(options.display.exposure), LookOf(options.display),
       first_air.valid() ? first_air.get() : FirstAir()});
  flight.standpoint().MoveTo(PlacementOf(options));
  if (options.place) flight.standpoint().GoTo(*options.place);
  if (options.track) {
    const Track track = ReadTrackWithNote(*options.track);
    flight.edits().BringRangeTo(track.points[track.points.size() / 2].place);
    flight.Follow(PathAlong(track, {}, flight.controller().ground()));
  }
  if (path) flight.edits().BringRangeTo(path->PoseAt(path->begin_s()).place);
  if (path && has_land) RequireOverLand(*path, *options.replay, scene, flight);
  if (flown) path = PathOfTrack(*flown, scene, flight);
  if (window || options.benchmark || options.hud == "on")
    LogFieldOfView(path ? path->PoseAt(path->begin_s()) : flight.eye());
  FlightRecorder recorder = options.record ? FlightRecorder(*options.record) : FlightRecorder();
  if (window) window->AtLostDisplay([&recorder] { recorder.Finish(); });
  if (options.explain) {
    Print(flight.Explain(size));
  } else if (options.benchmark) {
    const bool shown = window && window->width() > 0 && window->height() > 0;
    const ImageSize drawn = shown ? ImageSize{window->width(), window->height()} : size;
    RunBenchmark(*options.benchmark, flight, drawn, window.get());
  } else if (window) {
    if (path) flight.Replay(*path);
    Fly(options, flight, *window, recorder);
  } else if (options.video) {
    WriteFilm(options, *path, size, flight);
  } else if (path) {
    PictureWriter(flight).WriteReplay(*path, ReplayPictures(*options.screenshot, options.frames),
                                      size, recorder);
  } else {
    PaintHeadless(options, flight, size, recorder);
  }
  if (!options.common.quiet) LogNotes(flight);
  recorder.Finish();
  return 0;
}

int Main(int argc, char** argv) {
  CLI::App app("Fly through a scene, rendered on the graphics card.", "skyview");
  SkyviewOptions options;
  AddSkyviewOptions(app, options);
  if (const std::optional<int> status = ParseCommandLine(app, argc, argv)) return *status;
  return Run(options);
}

}  // namespace
}  // namespace alpenglow::viewer

int main(int argc, char** argv) {
  return alpenglow::viewer::RunProgram("skyview",
                                       [&] { return alpenglow::viewer::Main(argc, argv); });
}
