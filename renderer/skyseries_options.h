// SPDX-License-Identifier: MIT
// This header defines the command line of skyseries. Only one translation unit includes it, because
// CLI11 is slow to compile.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lut/cli/command_line.h"
#include "lut/cli/output_file.h"
#include "lut/evaluate/eval.h"
#include "lut/image/look_options.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/camera/track.h"
#include "renderer/effects/effect_choice.h"
#include "renderer/picture/render.h"
#include "renderer/scene/scene_options.h"
#include "renderer/scene/scene_weather.h"
#include "renderer/scene/weather_options.h"
#include "renderer/series/frame_times.h"
#include "renderer/series/series.h"

namespace alpenglow::renderer {

inline constexpr char kSkyseriesFooter[] =
    "A time is an instant (2026-06-21T04:00:00Z, with an offset, or local with --zone), a clock "
    "time of the --date (18:30 or 1830), an event with an offset (sunrise-1h, sunset+20m, noon, "
    "midnight, civil-dawn, "
    "civil-dusk, nautical-..., astronomical-..., moonrise, moonset, moon-transit; "
    "first-contact, second-contact, eclipse-maximum, third-contact and last-contact of an eclipse "
    "of the sun), a clock time or an event after a day (\"tomorrow sunrise\", \"2026-06-22 "
    "18:30\"), or now, now+2h, or tomorrow (at noon).\n\n"
    "Example: a day over the built-in range\n"
    "  skyseries --out 'out/frame.%04d.exr' --png --date 2026-06-21 --from sunrise-1h "
    "--to sunset+1h --every 10m\n"
    "Example: dawn on Mount Fuji\n"
    "  skyseries --dem N35E138.hgt --latitude 35.50 --longitude 138.76 --heading 190 "
    "--zone Asia/Tokyo --date 2026-01-01 --at sunrise-10m --out fuji.exr --png\n"
    "Example: along a recorded flight, with motion blur\n"
    "  skyseries --path flight.csv --fps 24 --shutter 0.5 --out 'out/f.%04d.exr' --png\n"
    "Example: a walk as a film\n"
    "  skyseries --dem N46E008.hgt --path walk.gpx --every 2s --out 'out/w.%04d.exr' --video "
    "walk.mp4";

/// The command line. Times stay texts until the scene is known, which gives them a zone and a day.
struct SkyseriesOptions {
  CommonOptions common;
  std::string scene_file;
  SceneOptions scene;
  std::optional<std::string> clouds;  // see CloudsFromText; replace those of the scene
  SceneWeather weather;               // replaces that of the scene
  std::optional<std::string> path;
  TrackStyle track;
  TimesText times;
  std::optional<std::string> date, zone, frames;
  double frames_per_second = 25.0, shutter = 0.0;
  RenderSettings settings;
  std::optional<EffectBudget> budget;  // effects are chosen or explained for each picture
  std::string out;
  SeriesOutput output{FrameName("frame.exr")};  // the name is set from `out`
  bool list = false;
};

/// Texts of the options of light and picture, as typed. ReadPictureOptions reads them once the
/// whole command line is known, because they depend on each other.
struct PictureOptionTexts {
  std::string size = "1280x720", filter = "blackman-harris", cloud_light = "fast", glare = "none";
  DisplayOptions display;
  std::optional<int> samples, paths;
  std::optional<std::string> effects, max_error, noise;
  std::vector<std::string> layers;
  bool no_shafts = false, explain = false;
};

/// Adds an option that replaces a part of the scene file, and cannot be given together with one.
inline CLI::Option* AddWithoutFile(CLI::App& app, const char* name, auto& value,
                                   const std::string& text) {
  return app.add_option(name, value, text)->excludes(app.get_option("SCENE"));
}

inline void AddPlaceOptions(CLI::App& app, SkyseriesOptions& options) {
  BeginGroup(app, kPlaceGroup);
  app.add_option("SCENE", options.scene_file,
                 "Scene file (TOML). It replaces the options that exclude it");
  SceneOptions& scene = options.scene;
  AddWithoutFile(app, "--latitude", scene.latitude,
                 fmt::format("Degrees north, -90 to 90 (default: {0}, with a view of the built-in "
                             "mountain range at {0} {1} from a distance of 17 km)",
                             kHomeLatitude, kHomeLongitude));
  AddWithoutFile(app, "--longitude", scene.longitude,
                 fmt::format("Degrees east, -180 to 360 (default: {})", kHomeLongitude));
  AddWithoutFile(app, "--place", scene.place,
                 "Airport, peak or city by name or code: LSZH, \"Mont Blanc\". Its time zone is "
                 "the default of --zone");
  AddWithoutFile(app, "--height,--altitude", scene.height_m,
                 "Height of the camera in metres above the ellipsoid, -12000 to 1e9");
  AddWithoutFile(app, "--above-ground", scene.above_ground_m,
                 "Height of the camera in metres above the ground, 0 to 1e9 (default: 2, or the "
                 "view of the range)");
  AddWithoutFile(app, "--heading", scene.heading,
                 "Direction of view in degrees clockwise from north, -360 to 360 (default: 0, or "
                 "the view of the range)");
  AddWithoutFile(app, "--pitch", scene.pitch,
                 "Direction of view in degrees above the horizontal, -90 to 90 (default: 0, or the "
                 "view of the range)");
  AddWithoutFile(app, "--fov", scene.fov,
                 "Horizontal field of view in degrees, 0.1 to 179, or 360 for a panorama (default: "
                 "60, or the view of the range)");
  AddWithoutFile(app, "--dem", scene.dem,
                 "Elevation models: GeoTIFF, SRTM .hgt, USGS DEM, and folders of these files; "
                 "several may be given (default: a built-in mountain range, different for each "
                 "place)");
}

/// Adds the path of the camera; the times of its frames are in AddTimeOptions.
inline void AddPathOptions(CLI::App& app, SkyseriesOptions& options) {
  CLI::Option* path = app.add_option(
      "--path,--replay,--track", options.path,
      "Path of the camera: a GPX or KML track (.gpx, .kml), along which the camera looks and "
      "banks, or a CSV file with the columns t_s, latitude, longitude, height_m (above the "
      "ellipsoid) and optionally heading, pitch, roll, fov and utc. skyview --record writes such a "
      "file. Frames begin at the first point. Without a scene and a place, the path gives the "
      "place");
  app.add_option("--track-speed", options.track.speed_m_per_s,
                 "Speed in metres per second along a track without times, 0.1 to 1e5")
      ->check(InRange(0.1, 1e5))
      ->needs(path)
      ->capture_default_str();
  app.add_option("--track-height", options.track.over_ground_m,
                 "Height in metres above the ground of a track without heights, 0 to 1e6")
      ->check(InRange(0.0, 1e6))
      ->needs(path)
      ->capture_default_str();
}

inline void AddTimeOptions(CLI::App& app, SkyseriesOptions& options) {
  BeginGroup(app, kTimeGroup);
  TimesText& times = options.times;
  CLI::Option* path = app.get_option("--path");
  CLI::Option* at = app.add_option("--at,--time", times.at, "Time of the picture; may be repeated")
                        ->allow_extra_args(false);
  CLI::Option* from = app.add_option("--from", times.from, "First time of the series");
  CLI::Option* to = app.add_option("--to", times.to, "Last time of the series");
  CLI::Option* every = app.add_option(
      "--every", times.every,
      "Time between frames: 10m, 90s, 1h; 1d is a calendar day in the zone. With whole days "
      "--to may be a day, and with an event in --from each frame shows the event of its own day");
  CLI::Option* count =
      app.add_option("--count", times.count, "Number of frames, including the first and the last");
  app.add_option("--date", options.date,
                 "Day of events and clock times: 2026-06-21, today, tomorrow, yesterday (default: "
                 "the day of the scene; without a scene file 2026-06-21)");
  app.add_option("--zone", options.zone, "IANA zone of local times (default: zone of the scene)");
  CLI::Option* fps =
      app.add_option("--fps", options.frames_per_second,
                     "Frames per second of the --video, and of the path if neither --every nor "
                     "--count is given")
          ->capture_default_str();
  app.add_option("--shutter", options.shutter,
                 "Motion blur along a path: fraction of the time between frames during which the "
                 "shutter is open, 0 to 1")
      ->check(InRange(0.0, 1.0))
      ->needs(path)
      ->capture_default_str();
  app.add_option("--frames", options.frames, "Render only these frames: A-B,C, counted from 0");
  from->needs(to)->excludes(at)->excludes(path);
  to->needs(from);
  every->excludes(count);
  // CLI11 has no "needs one of".
  app.parse_complete_callback([from, path, every, count, fps, &options] {
    for (const CLI::Option* option : {every, count}) {
      if (*option && !*from && !*path) {
        throw CLI::RequiresError(option->get_name(), "--from or --path");
      }
      if (*option && *fps && !options.output.video) {
        throw CLI::ExcludesError(option->get_name(), "--fps");
      }
    }
    if (*fps && !*path && !options.output.video)
      throw CLI::RequiresError("--fps", "--path or --video");
  });
}

inline void AddAirOptions(CLI::App& app, SkyseriesOptions& options) {
  BeginGroup(app, kAirGroup);
  AddWithoutFile(app, "--atmosphere", options.scene.atmosphere,
                 "Atmosphere file (TOML) or preset: earth, hazy, clear-mountain, mars, "
                 "bruneton2017");
  AddWithoutFile(app, "--bortle", options.scene.bortle,
                 "Light pollution of the night sky: class 1 (dark) to 9 (city)");
  AddWeatherOptions(app, options.weather, options.clouds);
}

inline void AddDisplayOptions(CLI::App& app, PictureOptionTexts& texts) {
  app.add_option("--exposure", texts.display.exposure,
                 "Exposure: auto (each picture is metered; in a series the exposure changes "
                 "smoothly), eye (metered, but dusk and night stay darker than day, as for an eye "
                 "that adapts only in part), incident (the light on the ground is metered in each "
                 "frame; smooth from day to night) or an EV at ISO 100, -30 to 30")
      ->check(ReadableBy([](const std::string& text) { (void)ExposureRuleFromText(text); }))
      ->capture_default_str();
  AddLookOptions(app, texts.display, LookNames(), kToneMapHelp);
  app.add_flag("--night-vision", texts.display.night_vision, kNightVisionHelp);
  app.add_option("--glare", texts.glare,
                 "\"eye\" adds to the PNG the light that the eye scatters around sun and lamps. It "
                 "does not change the EXR and needs a perspective camera")
      ->check(CLI::IsMember({"none", "eye"}))
      ->capture_default_str();
}

inline void AddRayOptions(CLI::App& app, PictureOptionTexts& texts) {
  app.add_option("--samples", texts.samples,
                 "Rays per pixel, 1 to 1024. Powers of two are distributed best; pictures with 1 "
                 "are not smoothed. With --noise, the number of first rays, at least 2 (default: "
                 "4, and --noise)")
      ->check(InRange(1, PixelSamples::kMostSamples));
  app.add_option("--noise", texts.noise,
                 "Use more rays, up to 256, in pixels whose noise exceeds this fraction of their "
                 "brightness, 1e-8 to 1 or in percent (default: 2%; with --samples alone all "
                 "pixels have the same number of rays)")
      ->check(FaultOfRelativeError);
  app.add_option(
         "--paths", texts.paths,
         "Trace the light of sun, moon and sky through air, clouds and ground by this number "
         "of paths per pixel, 1 to 1048576, without the approximations of the fast method. "
         "A path takes about 0.2 ms of a processor. Rays per pixel are as many, at most 1024, "
         "unless --samples is given")
      ->check(InRange(1, kMostPaths))
      ->excludes(app.get_option("--noise"));
  app.add_option("--filter", texts.filter,
                 "Pixel filter. box is sharpest and has the most aliasing; gaussian has the least "
                 "aliasing")
      ->check(CLI::IsMember(PixelFilterNames()))
      ->capture_default_str();
  app.add_option("--cloud-light", texts.cloud_light,
                 "Light in clouds: fast (by the table of a solution, without noise), hybrid (16 "
                 "paths a pixel, which end in the table after 2 collisions) or traced (64 paths a "
                 "pixel, exact but for their noise)")
      ->check(CLI::IsMember(CloudLightMethodNames()))
      ->excludes(app.get_option("--paths"))
      ->capture_default_str();
}

inline void AddEffectOptions(CLI::App& app, PictureOptionTexts& texts) {
  CLI::Option* effects =
      app.add_option(
             "--effects", texts.effects,
             "Effects to render: all; auto, those that each picture needs to stay within "
             "--max-error; or a list of names: " +
                 NamesOfEffects() +
                 ". molecules, aerosol, ozone, fine-air and fine-spectrum are on unless one of "
                 "them is named. all,-NAME leaves one effect out (default: all; auto with "
                 "--max-error)")
          ->check(ReadableBy([](const std::string& text) {
            if (text != "auto") (void)EffectsFromText(text);
          }));
  app.add_option("--max-error", texts.max_error,
                 "Largest error caused by leaving effects out: root mean square of the relative "
                 "changes of pixels, 1e-8 to 1 or in percent (default: 1%)")
      ->check(FaultOfRelativeError);
  app.add_flag("--no-shafts", texts.no_shafts,
               "Light the air as if terrain cast no shadows into it, for comparison")
      ->excludes(effects);
}

/// Returns the settings of the pictures.
[[nodiscard]] inline RenderSettings SettingsFrom(const PictureOptionTexts& texts) {
  const ImageSize size = ImageSizeFromText(texts.size);
  RenderSettings settings;
  settings.width = size.width;
  settings.height = size.height;
  settings.paths = texts.paths;
  if (texts.paths) settings.samples_per_pixel = std::min(*texts.paths, PixelSamples::kMostSamples);
  if (texts.samples) settings.samples_per_pixel = *texts.samples;
  if (!texts.paths && (texts.noise || !texts.samples))
    settings.noise = RelativeErrorFromText(texts.noise.value_or("2%"));
  const std::string effects = texts.effects.value_or(texts.max_error ? "auto" : "all");
  settings.effects = texts.no_shafts     ? EffectSet::All().Without(Effect::kShafts)
                     : effects == "auto" ? EffectSet::All()
                                         : EffectsFromText(effects);
  settings.filter = PixelFilterFromName(texts.filter);
  settings.cloud_light = CloudLightMethodFromName(texts.cloud_light);
  settings.layers = LayersFromNames(texts.layers);
  if (texts.display.night_vision) settings.layers.push_back(PictureLayer::kScotopic);
  return settings;
}

/// Returns the budget of the choice of effects, if effects are chosen or explained.
[[nodiscard]] inline std::optional<EffectBudget> BudgetFrom(const PictureOptionTexts& texts) {
  const bool chooses = texts.max_error || texts.effects.value_or("all") == "auto";
  if (!chooses && !texts.explain) return std::nullopt;
  return EffectBudget{
      .max_error = RelativeErrorFromText(texts.max_error.value_or("1%")).value_or(0.01),
      .explain = texts.explain,
      .leave_out = chooses};
}

/// Sets exposure and look of the developed pictures.
inline void SetDevelopment(const PictureOptionTexts& texts, SeriesOutput& output) {
  output.exposure = RuleOf(texts.display);
  output.look = LookOf(texts.display);
  output.glare = texts.glare == "eye";
}

/// Reads the texts into the options when the command line has been parsed. Throws ValidationError
/// for options that exclude each other.
inline void ReadPictureOptions(const PictureOptionTexts& texts, SkyseriesOptions& options) {
  if (texts.noise && texts.samples == 1)
    throw CLI::ValidationError("--noise", "needs --samples of 2 at least");
  if (texts.max_error && texts.effects.value_or("auto") != "auto")
    throw CLI::ValidationError("--max-error", "goes with --effects auto");
  if (texts.paths && (texts.effects || texts.max_error || texts.no_shafts || texts.explain))
    throw CLI::ValidationError("--paths",
                               "traces all effects: it excludes --effects, --max-error, "
                               "--no-shafts and --explain");
  options.settings = SettingsFrom(texts);
  if (texts.paths && std::ranges::any_of(options.settings.layers, IsOfPolarisation))
    throw CLI::ValidationError("--paths", "has no layers of polarised light");
  options.budget = BudgetFrom(texts);
  SetDevelopment(texts, options.output);
  options.output.video_frames_per_s = options.frames_per_second;
  options.output.progress = options.common.progress_style();
}

inline void AddPictureOptions(CLI::App& app, PictureOptionTexts& texts) {
  BeginGroup(app, kPictureGroup);
  app.add_option("--size", texts.size, "Width x height in pixels, 1 to 16384 each")
      ->check(ReadableBy([](const std::string& text) { (void)ImageSizeFromText(text); }))
      ->capture_default_str();
  AddDisplayOptions(app, texts);
  AddRayOptions(app, texts);
  AddEffectOptions(app, texts);
}

/// Adds an option that names a file of the whole series.
inline CLI::Option* AddFile(CLI::App& app, const char* name,
                            std::optional<std::filesystem::path>& file, const char* extension,
                            const char* text) {
  return app
      .add_option_function<std::string>(
          name, [&file](const std::string& typed) { file = typed; }, text)
      ->check([extension](const std::string& typed) { return FaultOfFileName(typed, extension); });
}

inline void AddOutputOptions(CLI::App& app, SkyseriesOptions& options, PictureOptionTexts& texts) {
  BeginGroup(app, kOutputGroup);
  app.add_option("--out", options.out, "EXR files, with %04d for the frame number")->required();
  app.add_flag("--png", options.output.png, "Write a tone-mapped PNG next to every EXR");
  app.add_option(
         "--aov", texts.layers,
         "Additional layers in the EXR, separated by commas. For polarised light: stokes_q and "
         "stokes_u (linear sRGB in cd/m^2) and polarisation (degree 0 to 1 and angle in degrees "
         "clockwise from the vertical of the picture, for luminance)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember(LayerNames()));
  AddFile(app, "--video", options.output.video, "",
          "Film of all frames of this run (.mp4, .mov, .mkv) with --fps frames per second; needs "
          "ffmpeg");
  AddFile(app, "--contact-sheet", options.output.contact_sheet, ".png",
          "PNG with small copies of all frames of this run");
  AddFile(app, "--keogram", options.output.keogram, ".png",
          "PNG of the middle column of every frame of this run, side by side");
  AddFile(app, "--plot", options.output.plot, ".svg",
          "SVG of the elevation of sun and moon, the light on level ground and the exposure over "
          "the time of the series");
  app.add_flag("--resume", options.output.resume,
               "Keep intact frames that were made with the same settings, and remove unfinished "
               "files of killed runs on this machine");
  app.add_flag_callback(
      "--list",
      [&app, &options] {
        options.list = true;
        app.get_option("--out")->required(false);
      },
      "Print the frames as CSV, with sun and moon, and render nothing; needs no --out");
}

inline void AddSkyseriesOptions(CLI::App& app, SkyseriesOptions& options) {
  const auto texts = std::make_shared<PictureOptionTexts>();
  AddPlaceOptions(app, options);
  AddPathOptions(app, options);
  AddTimeOptions(app, options);
  AddAirOptions(app, options);
  AddPictureOptions(app, *texts);
  AddOutputOptions(app, options, *texts);
  AddCommonOptions(app, "skyseries", options.common);
  app.add_flag("--explain", texts->explain,
               "Print for each picture what each effect changes, what it costs, and whether it is "
               "kept");
  app.callback([texts, &options] { ReadPictureOptions(*texts, options); });
  app.footer(kSkyseriesFooter);
}

}  // namespace alpenglow::renderer
