// SPDX-License-Identifier: MIT
// skyview: a flight through a scene, on the graphics card.
// The numbers of keys alone.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <chrono>
#include <set>

#include "atmosphere/number/constants.h"
#include "lut/program/growing_file.h"
#include "lut/program/output_name.h"
#include "renderer/scene/scene_files.h"
#include "renderer/series/frame_times.h"
#include "viewer/benchmark.h"
#include "viewer/capture/video.h"
#include "viewer/flight/flight_recorder.h"
#include "viewer/flythrough.h"
#include "viewer/gl/gl_context.h"
#include "viewer/gl/picture_tiles.h"
#include "viewer/gl/render_target.h"
#include "viewer/skyview_options.h"
#include "viewer/window.h"

namespace alpenglow {
namespace {

Scene SceneOf(const SkyviewOptions& options) {
  if (!options.scene_file.empty()) return ReadScene(options.scene_file);
  SceneOptions typed;
  typed.latitude = options.latitude.value_or(typed.latitude);
  typed.longitude = options.longitude.value_or(typed.longitude);
  typed.height_m = options.altitude;
  typed.heading = options.heading;
  typed.pitch = options.pitch;
  typed.dem = options.dem;
  return SceneFromOptions(typed);
}

// Over the scene of a file, a place and directions that are typed move the eye.
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

UtcInstant StartOf(const SkyviewOptions& options, const Scene& scene) {
  if (!options.time && scene.time) return *scene.time;
  const Eye eye = Placed({scene.place}, PlacementOf(options));
  const EventDay day{eye.place, scene.zone,
                     scene.time.value_or(ParseInstant("2026-06-21T12:00:00Z"))};
  return InstantFromText(options.time.value_or("noon"), day);
}

// A frame lasts a sixtieth of a second where nobody watches.
void PaintHeadless(const SkyviewOptions& options, Flythrough& flight, const ImageSize& size,
                   FlightRecorder& recorder) {
  constexpr double kFrame_s = 1.0 / 60.0;
  recorder.Note(0.0, flight.eye(), flight.now());
  for (int frame = 1; frame < options.frames; ++frame) {
    flight.Advance({}, kFrame_s);
    recorder.Note(frame * kFrame_s, flight.eye(), flight.now());
  }
  flight.WritePicture(*options.screenshot, size.width, size.height);
}

/// Keys and mouse, as the flight understands them.
class PilotHands {
 public:
  void Take(const WindowEvents& events) {
    for (const KeyEvent& key : events.keys) {
      if (key.change == GLFW_RELEASE) {
        held_.erase(key.key);
      } else {
        held_.insert(key.key);
      }
    }
    const bool drags = events.buttons[0] && pointer_ && events.pointer;
    drag_right_px_ = drags ? events.pointer->right - pointer_->right : 0.0;
    drag_down_px_ = drags ? events.pointer->down - pointer_->down : 0.0;
    pointer_ = events.pointer;
  }
  [[nodiscard]] Steering steering() const {
    return {Axis(GLFW_KEY_W, GLFW_KEY_S), Axis(GLFW_KEY_D, GLFW_KEY_A),
            Axis(GLFW_KEY_R, GLFW_KEY_F), Axis(GLFW_KEY_RIGHT, GLFW_KEY_LEFT),
            Axis(GLFW_KEY_UP, GLFW_KEY_DOWN)};
  }
  [[nodiscard]] double drag_right_px() const { return drag_right_px_; }
  [[nodiscard]] double drag_down_px() const { return drag_down_px_; }

  static std::optional<Command> CommandOf(const KeyEvent& key) {
    if (key.change == GLFW_RELEASE) return std::nullopt;
    const bool shift = (key.modifiers & GLFW_MOD_SHIFT) != 0;
    switch (key.key) {
      case GLFW_KEY_T:
        return shift ? Command::kSlowerTime : Command::kFasterTime;
      case GLFW_KEY_X:
        return shift ? Command::kWiderView : Command::kNarrowerView;
      case GLFW_KEY_F3:
        return Command::kScreenshot;
      case GLFW_KEY_H:
        return Command::kHud;
      case GLFW_KEY_ESCAPE:
        return Command::kQuit;
      default:
        return std::nullopt;
    }
  }

 private:
  [[nodiscard]] double Axis(int positive, int negative) const {
    return (held_.contains(positive) ? 1.0 : 0.0) - (held_.contains(negative) ? 1.0 : 0.0);
  }

  std::set<int> held_;
  std::optional<PointerPlace> pointer_;
  double drag_right_px_ = 0.0, drag_down_px_ = 0.0;
};

bool IsFullscreenKey(const KeyEvent& key) {
  return key.key == GLFW_KEY_F10 && key.change == GLFW_PRESS &&
         (key.modifiers & GLFW_MOD_SHIFT) != 0;
}

void Fly(const SkyviewOptions& options, const std::optional<CameraPath>& path, Flythrough& flight,
         Window& window, FlightRecorder& recorder) {
  using Clock = std::chrono::steady_clock;
  int frames = 0;
  double elapsed_s = 0.0;
  PilotHands hands;
  for (Clock::time_point before = Clock::now(); !flight.quit();) {
    ThrowIfInterrupted();
    const WindowEvents events = window.Poll();
    if (events.close) return;
    hands.Take(events);
    const Clock::time_point now = Clock::now();
    const double seconds = std::min(std::chrono::duration<double>(now - before).count(), 0.25);
    before = now;
    if (events.minimised) continue;
    const double angle_of_pixel = flight.eye().fov_rad / window.width();
    flight.Turn(-hands.drag_right_px() * angle_of_pixel, hands.drag_down_px() * angle_of_pixel);
    flight.Advance(hands.steering(), seconds);
    // The pilot has the controls again when the path ends.
    if (path && path->begin_s() + elapsed_s <= path->end_s()) {
      flight.Show(ReplayAt(*path, path->begin_s() + elapsed_s));
    }
    recorder.Note(elapsed_s, flight.eye(), flight.now());
    elapsed_s += seconds;
    flight.Paint(window.width(), window.height(), 0, seconds);
    window.SetTitle(flight.HudText());
    window.Swap();
    for (const KeyEvent& key : events.keys) {
      if (IsFullscreenKey(key)) window.SetFullscreen(!window.fullscreen());
      if (const auto command = PilotHands::CommandOf(key)) flight.Do(*command);
    }
    if (options.screenshot && ++frames == options.frames) {
      flight.WritePicture(*options.screenshot, window.width(), window.height());
      return;
    }
  }
}

void WriteFilm(const SkyviewOptions& options, const CameraPath& path, const ImageSize& size,
               Flythrough& flight) {
  const double length_s = path.end_s() - path.begin_s();
  const int frames = 1 + static_cast<int>(length_s * options.fps);
  const VideoSettings settings{
      size.width, size.height, options.fps, {{"alpenglow.replay", *options.replay}}};
  WriteVideo(*options.video, settings, frames, [&](int number) {
    const double seconds = number == 0 ? 0.0 : 1.0 / options.fps;
    return flight.Film(ReplayAt(path, path.begin_s() + number / options.fps), size, seconds);
  });
}

// The scripted flight, drawn into a window or, without one, into a picture of its size.
void RunBenchmark(double seconds, Flythrough& flight, const ImageSize& size, Window* window) {
  const Eye start = flight.eye();
  const UtcInstant begin = flight.now();
  const RenderTarget picture(size.width, size.height, RenderTarget::Depth::kNone);
  Benchmark benchmark(seconds);
  for (double before_s = 0.0; benchmark.NextFrame(); before_s = benchmark.elapsed_s()) {
    ThrowIfInterrupted();
    if (window != nullptr && window->Poll().close) break;
    flight.Show(BenchmarkFlight(start, begin, benchmark.elapsed_s()));
    benchmark.timer().Begin("picture");
    flight.Paint(size.width, size.height, window == nullptr ? picture.framebuffer() : 0,
                 benchmark.elapsed_s() - before_s);
    benchmark.timer().End();
    if (window != nullptr) window->Swap();
  }
  Print(benchmark.Text());
  Say(fmt::format("skyview: {}\n", benchmark.WorstText()));
}

std::vector<NamedFile> InputsOf(const SkyviewOptions& options, const Scene& scene) {
  std::vector<NamedFile> inputs = FilesOf(scene);
  if (!options.scene_file.empty()) inputs.push_back({"the scene", options.scene_file});
  if (options.replay) inputs.push_back({"--replay", *options.replay});
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

/// Whatever would keep the pictures and the flight from their files, before the flight.
void RequireOutputs(const SkyviewOptions& options, const Scene& scene) {
  const std::vector<NamedFile> inputs = InputsOf(options, scene);
  for (const NamedFile& output : OutputsOf(options)) {
    RequireNoInput(output, inputs);
    RequireWritable(output.file);
  }
}

int Run(const SkyviewOptions& options) {
  const ThreadLimit threads(options.common.threads);
  const ImageSize size = ImageSizeFromText(options.size);
  if (options.screenshot) RequirePictureName(*options.screenshot);
  if (options.video) RequireVideo(*options.video);
  const Scene scene = SceneOf(options);
  const UtcInstant start = StartOf(options, scene);
  std::optional<CameraPath> path;
  if (options.replay) path = ReadFlight(*options.replay);
  RequireOutputs(options, scene);
  // The context outlives what was made in it.
  const auto headless = options.headless ? std::make_unique<HeadlessContext>() : nullptr;
  const auto window =
      options.headless
          ? nullptr
          : std::make_unique<Window>(WindowSettings{size.width, size.height, options.fullscreen,
                                                    options.vsync == "on" && !options.benchmark});
  if (!options.common.quiet) Say(fmt::format("skyview: {}\n", GlDescription()));
  if (window) RequireDrawable(std::max(window->width(), 1), std::max(window->height(), 1));
  if (headless) RequireDrawable(size.width, size.height);
  Flythrough flight(scene, start);
  flight.Place(PlacementOf(options));
  if (!flight.terrain_message().empty())
    Say(fmt::format("skyview: {}\n", flight.terrain_message()));
  FlightRecorder recorder = options.record ? FlightRecorder(*options.record) : FlightRecorder();
  if (window) window->AtLostDisplay([&recorder] { recorder.Finish(); });
  if (options.benchmark) {
    const bool shown = window && window->width() > 0 && window->height() > 0;
    const ImageSize drawn = shown ? ImageSize{window->width(), window->height()} : size;
    RunBenchmark(*options.benchmark, flight, drawn, window.get());
  } else if (window) {
    Fly(options, path, flight, *window, recorder);
  } else if (options.video) {
    WriteFilm(options, *path, size, flight);
  } else if (path) {
    flight.WriteReplay(*path, ReplayPictures(*options.screenshot, options.frames), size, recorder);
  } else {
    PaintHeadless(options, flight, size, recorder);
  }
  recorder.Finish();
  return 0;
}

int Main(int argc, char** argv) {
  CLI::App app("A flight through a scene, on the graphics card", "skyview");
  SkyviewOptions options;
  AddSkyviewOptions(app, options);
  if (const std::optional<int> status = ParseCommandLine(app, argc, argv)) return *status;
  return Run(options);
}

}  // namespace
}  // namespace alpenglow

int main(int argc, char** argv) {
  return alpenglow::RunProgram("skyview", [&] { return alpenglow::Main(argc, argv); });
}
