// SPDX-License-Identifier: MIT
// Provides the command line of skyview. Only one translation unit includes this file, because CLI11
// is slow to compile.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lut/cli/command_line.h"
#include "lut/image/look.h"
#include "renderer/scene/scene_options.h"
#include "viewer/input/action.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

inline constexpr char kSkyviewExamples[] =
    "Example: sunrise over the built-in range, without a display\n"
    "  skyview --time sunrise+15m --headless --screenshot dawn.png\n"
    "A flight as a film:\n"
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
  std::optional<double> latitude, longitude, altitude, heading, pitch;
  std::optional<std::string> time, screenshot, record, replay, video, place, track;
  std::vector<std::string> dem;
  std::optional<double> benchmark;  // seconds
  double fps = 30.0;                // frame rate of the film
  int frames = 1;
  std::string vsync = "on", quality = "auto", hud = "auto", exposure = "auto", look = "photo",
              white_balance = "camera";
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
         "--exposure", options.exposure,
         "auto (the picture is metered), eye (metered, but dusk is darker than day and night "
         "darker) or EV at ISO 100, -30 to 30, locked")
      ->check(ReadableBy([](const std::string& text) { (void)FlightExposureFromText(text); }))
      ->capture_default_str();
  app.add_option("--look", options.look,
                 "Of agx: photo, or as its authors have it, none, punchy, medium or high contrast")
      ->check(CLI::IsMember(AgxLookNames()))
      ->capture_default_str();
  app.add_option("--white-balance", options.white_balance,
                 "Light that is shown as white: camera (daylight, by night 4000 K), daylight, auto "
                 "(the mean "
                 "colour of what is metered, 3000 to 7000 K) or kelvins, 1500 to 25000")
      ->check(ReadableBy([](const std::string& text) { (void)WhiteBalanceFromText(text); }))
      ->capture_default_str();
}

[[nodiscard]] inline Look LookOf(const SkyviewOptions& options) {
  Look look;
  look.agx = AgxLookFromName(options.look);
  look.white = WhiteBalanceFromText(options.white_balance);
  return look;
}

inline void AddSkyviewOptions(CLI::App& app, SkyviewOptions& options) {
  CLI::Option* file = app.add_option("SCENE", options.scene_file,
                                     "Scene file (TOML); without it a built-in range, or --dem");
  app.add_option("--latitude", options.latitude, "Of the eye: degrees north, -90 to 90")
      ->check(CLI::Range(-90.0, 90.0));
  app.add_option("--longitude", options.longitude, "Of the eye: degrees east, -180 to 360")
      ->check(CLI::Range(-180.0, 360.0));
  app.add_option("--altitude", options.altitude, "Of the eye: metres above the ellipsoid, to 1e9")
      ->check(CLI::Range(-12000.0, 1e9));
  app.add_option("--heading", options.heading, "Degrees clockwise from north, -360 to 360")
      ->check(CLI::Range(-360.0, 360.0));
  app.add_option("--pitch", options.pitch, "Degrees above the horizontal, -90 to 90")
      ->check(CLI::Range(-90.0, 90.0));
  app.add_option("--time", options.time,
                 "2026-06-21T04:00:00Z, or an event of the scene's day: sunrise-10m, noon, "
                 "civil-dusk (default: the scene's time, else noon there on 2026-06-21)");
  app.add_option("--dem", options.dem,
                 "Elevation models: GeoTIFF, SRTM .hgt, USGS DEM, and folders of such; several may "
                 "be named")
      ->excludes(file);
  app.add_option("--place", options.place,
                 "Begin at an airport, peak or city by name or code: LSZH, \"Mont Blanc\"");
  app.add_option("--track", options.track, "Follow a GPX or KML file");
  app.add_option("--quality", options.quality,
                 "low, medium, high, reference (the renderer's own picture where the eye stands), "
                 "or auto, which keeps --frame-rate")
      ->capture_default_str();
  app.add_option("--frame-rate", options.frame_rate,
                 "Frames a second that --quality auto keeps, "
                 "1 to 1000")
      ->check(CLI::Range(1.0, 1000.0))
      ->capture_default_str();
  app.add_option("--hud", options.hud,
                 "Instruments: on, off, or auto: on in windows, not in pictures of --screenshot")
      ->check(CLI::IsMember({"on", "off", "auto"}))
      ->capture_default_str();
  app.add_option("--hud-scale", options.hud_scale,
                 "Size of instruments, 0.5 to 8 (default: as the "
                 "desktop says)")
      ->check(CLI::Range(0.5, 8.0));
  app.add_flag("--invert-y", options.invert_y, "Sticks and mouse look down when pushed up");
  app.add_option(
         "--size", options.size,
         "Width x height in pixels, 1 to 32768 each; what is no --screenshot is as large as "
         "OpenGL draws in one piece at most")
      ->check(ReadableBy([](const std::string& text) { (void)SizeFromText(text); }))
      ->capture_default_str();
  app.add_flag("--fullscreen", options.fullscreen, "Use the whole screen");
  app.add_option("--vsync", options.vsync, "Frames wait for the display: on or off")
      ->check(CLI::IsMember({"on", "off"}))
      ->capture_default_str();
  CLI::Option* picture = app.add_option("--screenshot", options.screenshot,
                                        "Write this PNG or EXR after --frames frames and end");
  app.add_option("--frames", options.frames,
                 "Frames before the screenshot, 1 to 1000000; without a display, pictures of a "
                 "replay, its ends included")
      ->check(CLI::Range(1, 1000000))
      ->needs(picture)
      ->capture_default_str();
  CLI::Option* benchmark =
      app.add_option("--benchmark", options.benchmark,
                     "Fly for so many seconds, with time running x60, and print frame times: one "
                     "line a pass, \"name median_ms p95_ms p99_ms\" (name.cpu: of the thread that "
                     "draws), and the whole frame as \"frame\"; 0.1 to 3600")
          ->check(CLI::Range(0.1, 3600.0))
          ->excludes(picture);
  CLI::Option* explain = app.add_flag(
      "--explain", options.explain,
      "Compare this view with the renderer's, say what each shortcut costs and saves, and end");
  explain->excludes(picture)->excludes(benchmark);
  app.add_flag("--headless", options.headless,
               "Needs no display; only with --screenshot, --video, --benchmark or --explain");
  app.add_option("--record", options.record,
                 "Write the flight to this file, for --replay and skyseries --path");
  app.add_option("--replay", options.replay,
                 "Fly along this path; without a display, --screenshot out.%04d.png --frames N "
                 "writes pictures along it");
  CLI::Option* video =
      app.add_option(
             "--video", options.video,
             "Write the replay as a film (.mp4, .mov, .mkv), through ffmpeg; with --headless")
          ->needs("--replay")
          ->needs("--headless")
          ->excludes(picture);
  app.add_option("--fps", options.fps, "Pictures a second of the film, 1 to 1000")
      ->check(CLI::Range(1.0, 1000.0))
      ->needs(video)
      ->capture_default_str();
  benchmark->excludes(video)->excludes("--replay")->excludes("--record");
  for (CLI::Option* flies_nothing : {explain, video}) flies_nothing->excludes("--record");
  AddPictureLooks(app, options);
  AddCommonOptions(app, "skyview", options.common);
  app.callback([&options] {
    if (options.headless && !options.screenshot && !options.benchmark && !options.video &&
        !options.explain) {
      throw CLI::RequiresError("--headless", "--screenshot, --video, --benchmark or --explain");
    }
  });
  app.footer("Keys: " + FirstKeysText() + ".\n\n" + kSkyviewExamples);
}

}  // namespace alpenglow::viewer
