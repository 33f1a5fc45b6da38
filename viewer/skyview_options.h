// SPDX-License-Identifier: MIT
// Provides the command line of skyview. Only one translation unit includes this file, because CLI11
// is slow to compile.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lut/cli/command_line.h"
#include "lut/image/look_options.h"
#include "lut/image/picture_format.h"
#include "renderer/scene/scene_options.h"
#include "renderer/scene/scene_weather.h"
#include "renderer/scene/weather_options.h"
#include "viewer/input/action.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

inline constexpr char kSkyviewExamples[] =
    "Example: sunrise over the built-in range, without a display\n"
    "  skyview --time sunrise+15m --headless --screenshot dawn.png\n"
    "Example: a flight as a film\n"
    "  skyview --record flight.csv\n"
    "  skyview --replay flight.csv --headless --video flight.mp4";

/// Returns the rule of exposure for a text. Throws InputError for a rule that pictures in flight do
/// not support.
[[nodiscard]] inline ExposureRule FlightExposureFromText(const std::string& text) {
  const ExposureRule rule = ExposureRuleFromText(text);
  if (rule.kind != ExposureRule::Kind::kIncident) return rule;
  throw InputError("skyview meters what it shows; incident is for skyseries");
}

/// Options as typed. Texts are interpreted later, with the scene.
struct SkyviewOptions {
  CommonOptions common;
  std::string scene_file, size = "1280x720";
  SceneWeather weather;  // replaces that of the scene
  std::optional<double> latitude, longitude, altitude, heading, pitch;
  std::optional<std::string> time, screenshot, record, replay, video, place, track;
  std::optional<std::string> clouds;  // see CloudsFromText; replace those of the scene
  std::vector<std::string> dem;
  std::optional<double> benchmark;  // seconds
  double fps = 30.0;                // frame rate of the film
  int frames = 1;
  std::string vsync = "on", quality = "auto", hud = "auto";
  DisplayOptions display;
  double frame_rate = 20.0;  // target of automatic quality
  double hud_scale = 0.0;    // 0: the scale of the desktop
  bool invert_y = false, explain = false;
  bool fullscreen = false, headless = false;
};

[[nodiscard]] inline ImageSize SizeFromText(const std::string& text) {
  return ImageSizeFromText(text, kLargestImageSide);
}

inline void AddPictureLooks(CLI::App& app, SkyviewOptions& options) {
  app.add_option(
         "--exposure", options.display.exposure,
         "Exposure: auto (the picture is metered), eye (metered, but dusk and night stay darker "
         "than day) or a fixed EV at ISO 100, -30 to 30")
      ->check(ReadableBy([](const std::string& text) { (void)FlightExposureFromText(text); }))
      ->capture_default_str();
  AddLookOptions(app, options.display, ToneCurveNames(),
                 "Tone curve of the screen and of PNG files");
}

inline void AddPlaceOptions(CLI::App& app, SkyviewOptions& options) {
  BeginGroup(app, kPlaceGroup);
  CLI::Option* file =
      app.add_option("SCENE", options.scene_file,
                     "Scene file (TOML). Without it, skyview shows --dem or a built-in mountain "
                     "range");
  app.add_option("--latitude", options.latitude, "Place of the camera in degrees north, -90 to 90")
      ->check(InRange(-90.0, 90.0));
  app.add_option("--longitude", options.longitude,
                 "Place of the camera in degrees east, -180 to 360")
      ->check(InRange(-180.0, 360.0));
  app.add_option("--place", options.place,
                 "Start at an airport, peak or city by name or code: LSZH, \"Mont Blanc\"");
  app.add_option("--altitude,--height", options.altitude,
                 "Height of the camera in metres above the ellipsoid, -12000 to 1e9")
      ->check(InRange(-12000.0, 1e9));
  app.add_option("--heading", options.heading,
                 "Direction of view in degrees clockwise from north, -360 to 360")
      ->check(InRange(-360.0, 360.0));
  app.add_option("--pitch", options.pitch,
                 "Direction of view in degrees above the horizontal, -90 to 90")
      ->check(InRange(-90.0, 90.0));
  app.add_option("--dem", options.dem,
                 "Elevation models: GeoTIFF, SRTM .hgt, USGS DEM, and folders of these files; "
                 "several may be given")
      ->excludes(file);
  app.add_option("--track", options.track, "Follow a GPX or KML track");
  app.add_option("--replay,--path", options.replay,
                 "Fly along a recorded path, or a GPX or KML track. Without a display, "
                 "--screenshot out.%04d.png --frames N writes pictures along it");
  BeginGroup(app, kTimeGroup);
  app.add_option("--time,--at", options.time,
                 "Time at the start: 2026-06-21T04:00:00Z, or an event of the day of the scene: "
                 "sunrise-10m, noon, civil-dusk (default: the time of the scene, or noon on "
                 "2026-06-21 at the place of the camera)");
}

inline void AddAirOptions(CLI::App& app, SkyviewOptions& options) {
  BeginGroup(app, kAirGroup);
  AddWeatherOptions(app, options.weather, options.clouds);
}

inline void AddPictureOptions(CLI::App& app, SkyviewOptions& options) {
  BeginGroup(app, kPictureGroup);
  app.add_option("--size", options.size,
                 "Width x height in pixels, 1 to 32768 each. Only a screenshot may be larger than "
                 "the largest picture that OpenGL draws in one piece")
      ->check(ReadableBy([](const std::string& text) { (void)SizeFromText(text); }))
      ->capture_default_str();
  app.add_flag("--fullscreen", options.fullscreen, "Use the whole screen");
  app.add_option("--quality", options.quality,
                 "Quality of the picture: low, medium, high, reference (the picture of the "
                 "renderer while the camera stands still) or auto (adapts to keep --frame-rate)")
      ->capture_default_str();
  app.add_option("--frame-rate", options.frame_rate,
                 "Frames per second that --quality auto keeps, 1 to 1000")
      ->check(InRange(1.0, 1000.0))
      ->capture_default_str();
  AddPictureLooks(app, options);
  app.add_option("--hud", options.hud,
                 "Instruments: on, off, or auto (on in windows, off in pictures of --screenshot)")
      ->check(CLI::IsMember({"on", "off", "auto"}))
      ->capture_default_str();
  app.add_option("--hud-scale", options.hud_scale,
                 "Size of the instruments, 0.5 to 8 (default: the scale of the desktop)")
      ->check(InRange(0.5, 8.0));
  app.add_option("--vsync", options.vsync, "Wait for the display before each frame: on or off")
      ->check(CLI::IsMember({"on", "off"}))
      ->capture_default_str();
  app.add_flag("--invert-y", options.invert_y,
               "Sticks and mouse turn the view down when they are pushed up");
}

inline void AddOutputOptions(CLI::App& app, SkyviewOptions& options) {
  BeginGroup(app, kOutputGroup);
  CLI::Option* picture =
      app.add_option("--screenshot", options.screenshot,
                     "Write this " + NamesOfPictureFormats() + " after --frames frames, and exit");
  app.add_option("--frames", options.frames,
                 "Number of frames before the screenshot, 1 to 1000000; for a replay without a "
                 "display, number of pictures along it, including both ends")
      ->check(InRange(1, 1000000))
      ->needs(picture)
      ->capture_default_str();
  app.add_flag("--headless", options.headless,
               "Run without a display; needs --screenshot, --video, --benchmark or --explain");
  app.add_option("--record", options.record,
                 "Write the flight to this file, for --replay and skyseries --path");
  CLI::Option* video =
      app.add_option("--video", options.video,
                     "Write the replay as a film (.mp4, .mov, .mkv); needs --headless and ffmpeg")
          ->needs("--replay")
          ->needs("--headless")
          ->excludes(picture)
          ->excludes("--record");
  app.add_option("--fps", options.fps, "Frames per second of the film, 1 to 1000")
      ->check(InRange(1.0, 1000.0))
      ->needs(video)
      ->capture_default_str();
}

inline void AddDiagnostics(CLI::App& app, SkyviewOptions& options) {
  AddCommonOptions(app, "skyview", options.common);
  CLI::Option* benchmark =
      app.add_option("--benchmark", options.benchmark,
                     "Fly for this number of seconds, 0.1 to 3600, with time at 60 times its rate, "
                     "and print frame times. Each line is a pass: \"name median_ms p95_ms "
                     "p99_ms\". name.cpu is the time of the drawing thread; frame is the whole "
                     "frame")
          ->check(InRange(0.1, 3600.0));
  for (const char* other : {"--screenshot", "--video", "--replay", "--record"})
    benchmark->excludes(other);
  app.add_flag("--explain", options.explain,
               "Compare this view with the picture of the renderer, print what each shortcut costs "
               "and saves, and exit")
      ->excludes("--screenshot")
      ->excludes(benchmark)
      ->excludes("--record");
}

inline void AddSkyviewOptions(CLI::App& app, SkyviewOptions& options) {
  AddPlaceOptions(app, options);
  AddAirOptions(app, options);
  AddPictureOptions(app, options);
  AddOutputOptions(app, options);
  AddDiagnostics(app, options);
  app.callback([&options] {
    if (options.headless && !options.screenshot && !options.benchmark && !options.video &&
        !options.explain) {
      throw CLI::RequiresError("--headless", "--screenshot, --video, --benchmark or --explain");
    }
  });
  app.footer("Keys: " + FirstKeysText() + ".\n\n" + kSkyviewExamples);
}

}  // namespace alpenglow::viewer
