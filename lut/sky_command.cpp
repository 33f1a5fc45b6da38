// SPDX-License-Identifier: MIT
#include "lut/sky_command.h"

#include <alpenglow/image.h>
#include <alpenglow/panorama.h>
#include <alpenglow/sky.h>
#include <alpenglow/sun_and_moon.h>
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/medium/medium_presets.h"
#include "atmosphere/time_place/geodesy.h"
#include "atmosphere/time_place/time.h"
#include "lut/cli/metar_air.h"
#include "lut/cli/metar_option.h"
#include "lut/cli/output_file.h"
#include "lut/cli/outputs.h"
#include "lut/cli/terminal.h"
#include "lut/image/look_options.h"
#include "lut/sky/panorama.h"

namespace alpenglow::lut {
namespace {

struct SkyOptions {
  std::optional<std::string> atmosphere, metar, png, time, zone;
  std::string out, size = "2048x1024", orientation = "north";
  DisplayOptions display;
  std::optional<double> sun_elevation, latitude, longitude;
  std::vector<std::string> layers;
  double sun_azimuth = 180.0, altitude = 2.0;
  bool sun_disk = false, compass = false;
};

/// Input of one panorama: the air, the options and the metadata of its place and time.
struct SkyJob {
  Atmosphere air;
  PanoramaOptions panorama;
  Metadata metadata;
};

SunInSky SunFromAngles(const SkyOptions& options) {
  return {.elevation_deg = *options.sun_elevation,
          .azimuth_deg = options.sun_azimuth,
          .angular_radius_deg = kSunAngularRadius_rad / kRadiansPerDegree};
}

/// Sets place, sun and air of a panorama at an instant. The sun is at its apparent (refracted)
/// position, and lights the air from a lower one, as in the images of skyseries.
void PlaceAt(const SkyOptions& options, SkyJob& job) {
  const Place eye = CheckedPlace({*options.latitude, *options.longitude, options.altitude});
  const UtcTime time = TimeFromText(*options.time, options.zone.value_or(""));
  job.air = job.air.AtLatitude(eye.latitude_deg);
  job.panorama.sun = SunAt(eye, time, job.air);
  job.metadata["alpenglow.latitude_deg"] = fmt::format("{:.6f}", eye.latitude_deg);
  job.metadata["alpenglow.longitude_deg"] = fmt::format("{:.6f}", eye.longitude_deg);
  job.metadata["alpenglow.utc"] = FormatUtc(time, 3);
}

SkyJob JobFrom(const SkyOptions& options) {
  SkyJob job;
  job.air = Atmosphere(InTypedAir(
      MediumFromChoice(options.atmosphere.value_or("earth"), kForPictures), options.metar));
  const ImageSize size = ImageSizeFromText(options.size);
  job.panorama = {.width = size.width,
                  .height = size.height,
                  .altitude_m = options.altitude,
                  .sun = {},
                  .centre = PanoramaCentreFromName(options.orientation),
                  .draws_sun = options.sun_disk,
                  .draws_compass = options.compass,
                  .layers = options.layers};
  if (options.sun_elevation)
    job.panorama.sun = SunFromAngles(options);
  else
    PlaceAt(options, job);
  return job;
}

/// The image, and the illuminance on a horizontal plane at the observer.
struct RenderedSky {
  HdrImage image;
  double illuminance_lux;
};

RenderedSky Rendered(const SkyJob& job, ProgressStyle style) {
  const Sky sky(job.air);
  RenderedSky rendered{
      RenderPanorama(sky, job.panorama,
                     ShownProgress("rows", static_cast<std::size_t>(job.panorama.height), style)),
      HorizontalIlluminance(sky, job.panorama.altitude_m, job.panorama.sun)};
  rendered.image.metadata.insert(job.metadata.begin(), job.metadata.end());
  return rendered;
}

void PrepareOutputsOf(const SkyOptions& options) {
  std::vector<NamedFile> outputs{{"--out", options.out}}, inputs;
  if (options.png) outputs.push_back({"--png", *options.png});
  if (options.atmosphere) inputs.push_back({"--atmosphere", *options.atmosphere});
  PrepareOutputs(outputs, inputs);
}

void MakeSky(const SkyOptions& options, const CommonOptions& common) {
  PrepareOutputsOf(options);
  static_cast<void>(LookOf(options.display));  // refuses wrong names before the work
  RenderedSky sky = Rendered(JobFrom(options), common.progress_style());
  DisplayOptions display = options.display;
  display.illuminance_lx = sky.illuminance_lux;
  const ExposureRule rule = RuleOf(display);
  Metadata& metadata = sky.image.metadata;
  metadata["alpenglow.illuminance_lux"] = fmt::format("{:.6g}", sky.illuminance_lux);
  metadata.merge(HeaderOfExposure(rule, ExposureValue(sky.image, display), RuleInWords(rule)));
  WriteExr(options.out, sky.image);
  if (options.png) WritePng(*options.png, sky.image, display);
}

void AddPlace(CLI::App& sky, SkyOptions& options) {
  BeginGroup(sky, kPlaceGroup);
  CLI::Option* elevation =
      sky.add_option("--sun-elevation", options.sun_elevation,
                     "Apparent elevation of the sun in degrees above the horizontal, -90 to 90")
          ->check(InRange(-90.0, 90.0));
  sky.add_option("--sun-azimuth", options.sun_azimuth,
                 "Azimuth of the sun in degrees from north over east, -360 to 360")
      ->check(InRange(-360.0, 360.0))
      ->needs(elevation)
      ->capture_default_str();
  CLI::Option* latitude = sky.add_option("--latitude", options.latitude, "Degrees north, -90 to 90")
                              ->check(InRange(-90.0, 90.0))
                              ->excludes(elevation);
  CLI::Option* longitude =
      sky.add_option("--longitude", options.longitude, "Degrees east, -180 to 360")
          ->check(InRange(-180.0, 360.0))
          ->needs(latitude);
  sky.add_option("--altitude,--height", options.altitude,
                 "Height of the observer in metres above the ground, -12000 to 1e9; values below 0 "
                 "are treated as 0")
      ->check(InRange(-12000.0, 1e9))
      ->capture_default_str();
  sky.add_option("--orient", options.orientation,
                 "Direction of the centre of the picture: north or geographic (north); blender, "
                 "three or unity (east, which is +x there); openexr or godot (south, which is +z "
                 "there). East is +x in all of them, and no picture is mirrored")
      ->check(ReadableBy([](const std::string& text) { (void)PanoramaCentreFromName(text); }))
      ->capture_default_str();
  BeginGroup(sky, kTimeGroup);
  CLI::Option* time = sky.add_option("--time,--at", options.time,
                                     "Instant: 2026-06-21T04:00:00Z, with an offset, or a local "
                                     "time with --zone")
                          ->needs(latitude);
  sky.add_option("--zone", options.zone, "IANA zone of a local time")->needs(time);
  latitude->needs(longitude)->needs(time);
}

void AddPicture(CLI::App& sky, SkyOptions& options) {
  BeginGroup(sky, kPictureGroup);
  sky.add_option("--size", options.size, "Width x height in pixels, 1 to 16384 each")
      ->check(ReadableBy([](const std::string& text) { (void)ImageSizeFromText(text); }))
      ->capture_default_str();
  sky.add_flag("--sun-disk", options.sun_disk,
               "Draw the disk of the sun: pixels of about 1e9 cd/m^2 that contain all its light");
  sky.add_flag("--compass", options.compass,
               "Paint N, E, S and W on the horizon, to check the orientation in another program");
  sky.add_option("--exposure", options.display.exposure,
                 "Exposure: auto (the picture is metered), eye (dusk and night stay darker than "
                 "day), incident (the light on a horizontal plane is metered) or an EV at ISO 100, "
                 "-30 to 30")
      ->check(ReadableBy([](const std::string& text) { (void)ExposureRuleFromText(text); }))
      ->capture_default_str();
  AddLookOptions(sky, options.display, LookNames(), kToneMapHelp);
  sky.add_flag("--night-vision", options.display.night_vision, kNightVisionHelp);
}

void AddOutput(CLI::App& sky, SkyOptions& options) {
  BeginGroup(sky, kOutputGroup);
  sky.add_option("--out", options.out,
                 "EXR file in linear sRGB and cd/m^2, with the attribute envmap latlong")
      ->check([](const std::string& name) { return FaultOfFileName(name, ".exr"); })
      ->required();
  CLI::Option* png =
      sky.add_option("--png", options.png,
                     "PNG file, exposed and tone-mapped, in addition to --out")
          ->check([](const std::string& name) { return FaultOfFileName(name, ".png"); });
  sky.add_option("--aov", options.layers,
                 "Additional layers in the EXR, separated by commas: stokes_q and stokes_u (linear "
                 "sRGB in cd/m^2), polarisation (degree 0 to 1 and angle in degrees clockwise from "
                 "the vertical, for luminance)")
      ->delimiter(',')
      ->check(CLI::IsMember(StokesLayerNames()));
  for (const char* name : {"--white-balance", "--tone-map", "--look", "--night-vision"})
    sky.get_option(name)->needs(png);
}

}  // namespace

Subcommand AddSkyCommand(CLI::App& app) {
  const auto options = std::make_shared<SkyOptions>();
  CLI::App& sky = *app.add_subcommand(
      "sky",
      "Make a panorama of the sky for lighting: the whole sphere around an observer, "
      "in a latitude-longitude picture, ground included. The position of the sun is given by "
      "--sun-elevation and --sun-azimuth, or by a place and a time.");
  AddPlace(sky, *options);
  BeginGroup(sky, kAirGroup);
  AddAtmosphereOption(sky, options->atmosphere);
  AddMetarOption(sky, options->metar, kMetarAirHelp);
  AddPicture(sky, *options);
  AddOutput(sky, *options);
  BeginDiagnostics(sky);
  sky.parse_complete_callback([options] {
    if (!options->sun_elevation && !options->latitude) {
      throw CLI::ValidationError("sky",
                                 "needs --sun-elevation, or --latitude, --longitude, --time");
    }
  });
  sky.footer(
      "Example: skylut sky --out sky.exr --png sky.png --sun-elevation 10 --orient blender\n"
      "Example: skylut sky --out sky.exr --latitude 46.5 --longitude 8 --zone Europe/Zurich "
      "--time 2026-06-21T05:30 --altitude 3500");
  return [options](const CommonOptions& common) { MakeSky(*options, common); };
}

}  // namespace alpenglow::lut
