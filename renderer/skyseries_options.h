// SPDX-License-Identifier: MIT
// This header defines the command line of skyseries. Only one translation unit includes it, because
// CLI11 is slow to compile.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "lut/cli/command_line.h"
#include "lut/cli/output_file.h"
#include "lut/evaluate/eval.h"
#include "lut/image/look.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/camera/track.h"
#include "renderer/picture/render.h"
#include "renderer/scene/scene_options.h"
#include "renderer/series/frame_times.h"

namespace alpenglow::renderer {

inline constexpr char kSkyseriesFooter[] =
    "A time is an instant (2026-06-21T04:00:00Z, with an offset, or local with --zone), a clock "
    "time of the --date (18:30 or 1830), an event with an offset (sunrise-1h, sunset+20m, noon, "
    "midnight, civil-dawn, "
    "civil-dusk, nautical-..., astronomical-..., moonrise, moonset, moon-transit; "
    "first-contact, second-contact, eclipse-maximum, third-contact and last-contact of an eclipse "
    "of the sun), either of them "
    "after a day of its own (\"tomorrow sunrise\", \"2026-06-22 18:30\"), or now, now+2h, tomorrow "
    "(its noon)\n\n"
    "Example: a day over the built-in range\n"
    "  skyseries --out 'out/frame.%04d.exr' --png --date 2026-06-21 --from sunrise-1h "
    "--to sunset+1h --every 10m\n"
    "Example: dawn on Mount Fuji\n"
    "  skyseries --dem N35E138.hgt --latitude 35.50 --longitude 138.76 --heading 190 "
    "--zone Asia/Tokyo --date 2026-01-01 --at sunrise-10m --out fuji.exr --png\n"
    "Example: along a recorded flight, what moves blurred\n"
    "  skyseries --path flight.csv --fps 24 --shutter 0.5 --out 'out/f.%04d.exr' --png\n"
    "Example: a walk as a film\n"
    "  skyseries --dem N46E008.hgt --path walk.gpx --every 2s --out 'out/w.%04d.exr' --video "
    "walk.mp4";

/// Options as typed; their texts are parsed later, against the scene.
struct SkyseriesOptions {
  CommonOptions common;
  std::string scene_file;
  SceneOptions scene;
  TimesText times;
  std::optional<std::string> date, zone, frames, contact_sheet, keogram, plot, video;
  std::string out, size = "1280x720", exposure = "auto", tone_curve = "agx", look = "photo",
                   filter = "blackman-harris", glare = "none", white_balance = "camera";
  std::optional<int> samples;
  std::optional<std::string> path;
  TrackStyle track;
  double frames_per_second = 25.0, shutter = 0.0;
  std::vector<std::string> layers;
  std::optional<std::string> effects, max_error, noise;
  bool png = false, night_vision = false, no_shafts = false, explain = false, resume = false,
       list = false;
};

inline void AddSceneOptions(CLI::App& app, SkyseriesOptions& options) {
  CLI::Option* file = app.add_option("SCENE", options.scene_file,
                                     "Scene file (TOML); without it, the next options:");
  SceneOptions& scene = options.scene;
  const auto without_file = [&](const char* name, auto& value, const std::string& text) {
    return app.add_option(name, value, text)->excludes(file)->group("Instead of a scene file");
  };
  without_file("--latitude", scene.latitude,
               fmt::format("Degrees north, -90 to 90 (default: {0}; the range at {0} {1} is seen "
                           "from a shoulder 17 km off)",
                           kHomeLatitude, kHomeLongitude));
  without_file("--longitude", scene.longitude,
               fmt::format("Degrees east, -180 to 360 (default: {})", kHomeLongitude));
  without_file("--heading", scene.heading,
               "Degrees clockwise from north, -360 to 360 (default: 0, or the range's view)");
  without_file("--pitch", scene.pitch,
               "Degrees above the horizontal, -90 to 90 (default: 0, or the range's view)");
  without_file("--fov", scene.fov,
               "Horizontal field of view in degrees, 0.1 to 179, or 360 for a panorama (default: "
               "60, or the range's view)");
  without_file("--height", scene.height_m, "Metres above the ellipsoid, -12000 to 1e9");
  without_file("--above-ground", scene.above_ground_m,
               "Metres above the ground, 0 to 1e9 (default: 2, or the range's view)");
  without_file("--place", scene.place,
               "Airport, peak or city by name or code: LSZH, \"Mont Blanc\"; its zone is that of "
               "local times");
  without_file("--dem", scene.dem,
               "Elevation models: GeoTIFF, SRTM .hgt, USGS DEM, VRT, and folders of such; several "
               "may be named (default: a "
               "built-in mountain range, of its own for each place, which has the view of it)");
  without_file("--atmosphere", scene.atmosphere,
               "Atmosphere file (TOML) or preset: earth, hazy, "
               "clear-mountain, mars, bruneton2017");
  without_file("--bortle", scene.bortle,
               "Class of the night sky, 1 to 9: how much light of towns there is in the air");
}

inline void AddTimeOptions(CLI::App& app, SkyseriesOptions& options) {
  TimesText& times = options.times;
  CLI::Option* at = app.add_option("--at", times.at, "Time of the picture; may be repeated")
                        ->allow_extra_args(false);
  CLI::Option* from = app.add_option("--from", times.from, "First time of the series");
  CLI::Option* to = app.add_option("--to", times.to, "Last time of the series");
  CLI::Option* every = app.add_option(
      "--every", times.every,
      "Time between frames: 10m, 90s, 1h; 1d is a day of the calendar in the zone. With whole days "
      "and an event in --from each "
      "frame is the event of its own day, and --to may be a day");
  CLI::Option* count = app.add_option("--count", times.count,
                                      "Number of frames, first and last "
                                      "included");
  CLI::Option* path = app.add_option(
      "--path", options.path,
      "Way of the camera: a GPX or KML track (.gpx, .kml), along which the camera looks and banks, "
      "or "
      "a CSV with a header of t_s, latitude, longitude, height_m (over the "
      "ellipsoid) and, if wanted, heading, pitch, roll, fov and utc; skyview --record writes one. "
      "Its frames begin at its first point. Without a scene and a place it says where");
  CLI::Option* fps =
      app.add_option(
             "--fps", options.frames_per_second,
             "Frames per second of the path, without --every and --count, and of the --video")
          ->capture_default_str();
  app.add_option("--track-speed", options.track.speed_m_per_s,
                 "Metres a second along a track without times, 0.1 to 1e5")
      ->check(CLI::Range(0.1, 1e5))
      ->needs(path)
      ->capture_default_str();
  app.add_option("--track-height", options.track.over_ground_m,
                 "Metres over the ground of a track without heights, 0 to 1e6")
      ->check(CLI::Range(0.0, 1e6))
      ->needs(path)
      ->capture_default_str();
  app.add_option(
         "--shutter", options.shutter,
         "Share of the time between frames of a path that the shutter is open, 0 to 1: what "
         "moves is blurred")
      ->check(CLI::Range(0.0, 1.0))
      ->needs(path)
      ->capture_default_str();
  from->needs(to)->excludes(at)->excludes(path);
  to->needs(from);
  every->excludes(count);
  // CLI11 has no "needs one of".
  app.parse_complete_callback([from, path, every, count, fps, &options] {
    for (const CLI::Option* option : {every, count}) {
      if (*option && !*from && !*path) {
        throw CLI::RequiresError(option->get_name(), "--from or --path");
      }
      if (*option && *fps && !options.video) {
        throw CLI::ExcludesError(option->get_name(), "--fps");
      }
    }
    if (*fps && !*path && !options.video) throw CLI::RequiresError("--fps", "--path or --video");
  });
  app.add_option("--date", options.date,
                 "Day of events and clock times: 2026-06-21, today, tomorrow, yesterday (default: "
                 "the scene's; "
                 "without a file 2026-06-21)");
  app.add_option("--zone", options.zone, "IANA zone of local times (default: the scene's)");
  app.add_option("--frames", options.frames, "Render only these frames: A-B,C, counted from 0");
  app.add_flag_callback(
      "--list",
      [&app, &options] {
        options.list = true;
        app.get_option("--out")->required(false);
      },
      "Print the frames as CSV, with sun and moon, and render nothing; needs no --out");
}

inline void AddOutputOptions(CLI::App& app, SkyseriesOptions& options) {
  app.add_option("--out", options.out, "EXR files, with %04d for the frame number")->required();
  app.add_flag("--png", options.png, "Write a developed PNG beside every EXR");
  app.add_option("--size", options.size, "Width x height in pixels, 1 to 16384 each")
      ->check(ReadableBy([](const std::string& text) { (void)ImageSizeFromText(text); }))
      ->capture_default_str();
  app.add_option(
         "--samples", options.samples,
         "Rays per pixel, 1 to 1024; powers of two are spread best, 1 is not smoothed. With "
         "--noise the first rays, 2 at least (default: 4, and --noise)")
      ->check(CLI::Range(1, PixelSamples::kMostSamples));
  app.add_option("--noise", options.noise,
                 "More rays, up to 256, where the noise of a pixel is more than this part of its "
                 "brightness, 1e-8 to 1 or in percent (default: 2%; with --samples alone all "
                 "pixels have equally many)")
      ->check(FaultOfRelativeError);
  app.add_option("--filter", options.filter,
                 "How rays are spread about a pixel: box is sharpest and has the most stair steps, "
                 "gaussian the fewest")
      ->check(CLI::IsMember(PixelFilterNames()))
      ->capture_default_str();
  app.add_option(
         "--aov", options.layers,
         "More layers in the EXR, separated by commas; of polarised light stokes_q, stokes_u "
         "(linear sRGB in cd/m^2) and polarisation (degree 0 to 1, and angle in degrees "
         "clockwise from the picture's vertical, of luminance)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember(LayerNames()));
  app.add_option(
         "--exposure", options.exposure,
         "auto (pictures are metered, those of a series smoothly from frame to frame), eye "
         "(metered, "
         "but dusk is darker than day and night darker, as an eye has it that adapts in part), "
         "incident (each frame's light on the ground is metered: smooth from day to night) or EV "
         "at "
         "ISO 100, -30 to 30")
      ->check(ReadableBy([](const std::string& text) { (void)ExposureRuleFromText(text); }))
      ->capture_default_str();
  app.add_option("--tone-map", options.tone_curve,
                 "Curve of the PNG; local: an exposure of its own for every part, and agx")
      ->check(CLI::IsMember({"agx", "aces", "reinhard", "pbr-neutral", "linear", "local"}))
      ->capture_default_str();
  app.add_option("--look", options.look,
                 "Of agx: photo, or as its authors have it, none, punchy, medium or high contrast")
      ->check(CLI::IsMember(AgxLookNames()))
      ->capture_default_str();
  app.add_option("--white-balance", options.white_balance,
                 "Light that the PNG shows as white: camera (daylight, by night 4000 K), daylight, "
                 "auto (the "
                 "mean colour of what is metered, 3000 to 7000 K) or kelvins, 1500 to 25000")
      ->check(ReadableBy([](const std::string& text) { (void)WhiteBalanceFromText(text); }))
      ->capture_default_str();
  app.add_flag("--night-vision", options.night_vision,
               "PNG as the eye adapted to the dark sees it: below 5 cd/m^2 colour fades and fine "
               "detail is lost");
  app.add_option("--glare", options.glare,
                 "eye: PNG with the light that the eye scatters around sun and lamps; not in the "
                 "EXR, not of panoramas")
      ->check(CLI::IsMember({"none", "eye"}))
      ->capture_default_str();
  app.add_flag("--resume", options.resume,
               "Keep intact frames that were made with these settings; remove unfinished files of "
               "runs that were killed on this machine");
  app.add_option("--contact-sheet", options.contact_sheet, "PNG of all frames of this run, small")
      ->check([](const std::string& name) { return FaultOfFileName(name, ".png"); });
  app.add_option("--keogram", options.keogram,
                 "PNG of the middle column of every frame of this run, side by side")
      ->check([](const std::string& name) { return FaultOfFileName(name, ".png"); });
  app.add_option("--plot", options.plot,
                 "SVG of the elevation of sun and moon, the light on the ground and the exposure "
                 "over the time of the series")
      ->check([](const std::string& name) { return FaultOfFileName(name, ".svg"); });
  app.add_option(
         "--video", options.video,
         "Film of all frames of this run (.mp4, .mov, .mkv), --fps a second, through ffmpeg")
      ->check([](const std::string& name) { return FaultOfFileName(name, ""); });
}

inline void AddEffectOptions(CLI::App& app, SkyseriesOptions& options) {
  CLI::Option* effects =
      app.add_option(
             "--effects", options.effects,
             "all; auto: what each picture needs within --max-error; or exactly these: " +
                 NamesOfEffects() +
                 ". molecules, aerosol, ozone, fine-air, fine-spectrum are on unless one is "
                 "named; -NAME takes one away from all (default: all; auto with "
                 "--max-error)")
          ->check(ReadableBy([](const std::string& text) {
            if (text != "auto") (void)EffectsFromText(text);
          }));
  app.add_option("--max-error", options.max_error,
                 "Change of the picture that leaving effects out may make: root mean square of "
                 "the pixels' relative changes, 1e-8 to 1 or in percent (default: 1%)")
      ->check(FaultOfRelativeError);
  app.add_flag("--explain", options.explain,
               "Print for each picture what each effect changes, what it costs, and whether it is "
               "kept");
  app.add_flag("--no-shafts", options.no_shafts,
               "Leave the air in the sun where terrain shades it, for comparison")
      ->excludes(effects);
  app.callback([&options] {
    if (options.noise && options.samples == 1)
      throw CLI::ValidationError("--noise", "needs --samples of 2 at least");
    if (options.max_error && options.effects.value_or("auto") != "auto")
      throw CLI::ValidationError("--max-error", "goes with --effects auto");
  });
}

/// Sets the number of rays per pixel.
inline void SetRays(const SkyseriesOptions& options, RenderSettings& settings) {
  if (options.samples) settings.samples_per_pixel = *options.samples;
  if (options.noise || !options.samples)
    settings.noise = RelativeErrorFromText(options.noise.value_or("2%"));
}

/// Returns the settings of the small picture that meters a series: 96 pixels along the longer side,
/// with the effects of `settings`.
inline RenderSettings PreviewSettings(const RenderSettings& settings,
                                      const SkyseriesOptions& options) {
  constexpr int kLongSide = 96;
  RenderSettings preview;
  const int longest = std::max(settings.width, settings.height);
  preview.width = std::max(settings.width * kLongSide / longest, 1);
  preview.height = std::max(settings.height * kLongSide / longest, 1);
  preview.effects = settings.effects;
  preview.filter = settings.filter;
  if (options.night_vision) preview.layers.push_back(PictureLayer::kScotopic);
  return preview;
}

/// Returns whether effects are chosen for each picture.
inline bool ChoosesEffects(const SkyseriesOptions& options) {
  return options.max_error || options.effects.value_or("all") == "auto";
}

/// Returns the effects that pictures may use.
inline EffectSet EffectsOf(const SkyseriesOptions& options) {
  if (options.no_shafts) return EffectSet::All().Without(Effect::kShafts);
  return ChoosesEffects(options) ? EffectSet::All()
                                 : EffectsFromText(options.effects.value_or("all"));
}

inline EffectBudget BudgetOf(const SkyseriesOptions& options) {
  return {.max_error = RelativeErrorFromText(options.max_error.value_or("1%")).value_or(0.01),
          .explain = options.explain,
          .leave_out = ChoosesEffects(options)};
}

inline void AddSkyseriesOptions(CLI::App& app, SkyseriesOptions& options) {
  AddSceneOptions(app, options);
  AddTimeOptions(app, options);
  AddOutputOptions(app, options);
  AddEffectOptions(app, options);
  AddCommonOptions(app, "skyseries", options.common);
  app.footer(kSkyseriesFooter);
}

}  // namespace alpenglow::renderer
