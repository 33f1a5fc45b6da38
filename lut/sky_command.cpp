// SPDX-License-Identifier: MIT
#include "lut/sky_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/medium/medium_presets.h"
#include "atmosphere/refraction/refracted_view.h"
#include "lut/cli/output_file.h"
#include "lut/cli/outputs.h"
#include "lut/cli/terminal.h"
#include "lut/image/development.h"
#include "lut/image/exr.h"
#include "lut/image/look_options.h"
#include "lut/image/metering.h"
#include "lut/image/png.h"
#include "lut/sky/panorama.h"

namespace alpenglow::lut {
namespace {

struct SkyOptions {
  std::optional<std::string> atmosphere, png, time, zone;
  std::string out, size = "2048x1024", orientation = "north", exposure = "auto";
  LookTexts look;
  std::optional<double> sun_elevation, latitude, longitude;
  std::vector<std::string> layers;
  double sun_azimuth = 180.0, altitude = 2.0;
  bool sun_disk = false, night_vision = false, compass = false;
};

/// Input of one panorama: the medium, the settings and the metadata of its output files.
struct SkyJob {
  Medium medium;
  PanoramaSettings settings;
  Metadata metadata;
};

SunInSky SunFromAngles(const SkyOptions& options) {
  SunInSky sun;
  sun.elevation_deg = *options.sun_elevation;
  sun.azimuth_deg = options.sun_azimuth;
  sun.angular_radius_deg = kSunAngularRadius_rad / kRadiansPerDegree;
  return sun;
}

SkyJob JobFrom(const SkyOptions& options) {
  SkyJob job;
  job.medium = options.atmosphere ? MediumFromChoice(*options.atmosphere, kForPictures)
                                  : MediumPreset("earth");
  const ImageSize size = ImageSizeFromText(options.size);
  job.settings.width = size.width;
  job.settings.height = size.height;
  job.settings.altitude_m = options.altitude;
  job.settings.orientation = PanoramaOrientationFromName(options.orientation);
  job.settings.sun_disk = options.sun_disk;
  job.settings.compass = options.compass;
  for (const std::string& name : options.layers) {
    const StokesLayer layer = StokesLayerFromName(name);
    auto& layers = job.settings.layers;
    if (std::find(layers.begin(), layers.end(), layer) == layers.end()) layers.push_back(layer);
  }
  if (options.sun_elevation) {
    job.settings.sun = SunFromAngles(options);
  } else {
    const Place eye = CheckedPlace({*options.latitude, *options.longitude, options.altitude});
    const UtcTime instant = ParseInstant(*options.time, options.zone);
    job.medium = OnOsculatingSphere(job.medium, eye.latitude_rad());
    // The sun is at its apparent (refracted) position. The air is lit by a lower sun
    // (lower_for_air_deg), as in the images of skyseries.
    job.settings.sun = ApparentSunAt(eye, instant, GentleAirOf(job.medium));
    job.metadata["alpenglow.latitude_deg"] = fmt::format("{:.6f}", eye.latitude_deg);
    job.metadata["alpenglow.longitude_deg"] = fmt::format("{:.6f}", eye.longitude_deg);
    job.metadata["alpenglow.utc"] = FormatUtc(instant, 3);
  }
  return job;
}

void Describe(SkyJob& job) {
  const PanoramaSettings& settings = job.settings;
  const SunInSky& sun = settings.sun;
  Metadata& metadata = job.metadata;
  metadata["Software"] = ProducerText();
  metadata["alpenglow.unit"] = "cd/m^2, linear sRGB (Rec. 709 primaries, D65)";
  metadata["alpenglow.atmosphere"] = job.medium.name;
  metadata["alpenglow.atmosphere_hash"] = fmt::format("{:016x}", MediumHash(job.medium));
  metadata["alpenglow.altitude_m"] = fmt::format("{}", settings.altitude_m);
  metadata["alpenglow.sun_elevation_deg"] = fmt::format("{:.6f}", sun.elevation_deg);
  metadata["alpenglow.sun_azimuth_deg"] = DirectionText(sun.azimuth_deg, 6);
  metadata["alpenglow.sun_distance"] = fmt::format("{:.6f}", sun.distance_au);
  metadata["alpenglow.sun_disk"] = settings.sun_disk ? "drawn" : "left out";
  if (settings.compass) metadata["alpenglow.compass"] = "painted";
  std::vector<std::string> layers;
  for (const StokesLayer layer : settings.layers) layers.push_back(NameOf(layer));
  if (!layers.empty()) metadata["alpenglow.layers"] = fmt::format("{}", fmt::join(layers, ","));
  metadata["alpenglow.orientation"] = NameOf(settings.orientation);
  metadata["alpenglow.centre_azimuth_deg"] =
      DirectionText(CentreAzimuth(settings.orientation) / kRadiansPerDegree, 6);
}

/// The image, and the illuminance on a horizontal plane at the observer.
struct RenderedSky {
  HdrImage image;
  double illuminance_lux;
};

RenderedSky Rendered(const SkyJob& job, ProgressStyle style) {
  const SingleScattering<float> air(job.medium);
  const MultipleScattering multiple_scattering(job.medium, OptionsFor(job.medium));
  Progress progress("rows", static_cast<std::size_t>(job.settings.height), style);
  return {
      RenderPanorama(air, multiple_scattering, job.settings, [&] { progress.Advance(); }),
      HorizontalIlluminance(air, multiple_scattering, job.settings.altitude_m, job.settings.sun)};
}

double Ev100Of(const RenderedSky& sky, const HdrImage& seen, const ExposureRule& rule,
               const Look& look) {
  if (rule.kind == ExposureRule::Kind::kIncident) return IncidentEv100(sky.illuminance_lux);
  return Ev100By(
      rule, MeterEv100(seen, kSunDiskLuminance_cd_per_m2, Projection::kLatitudeLongitude), look);
}

void PrepareOutputsOf(const SkyOptions& options) {
  std::vector<NamedFile> outputs{{"--out", options.out}}, inputs;
  if (options.png) outputs.push_back({"--png", *options.png});
  if (options.atmosphere) inputs.push_back({"--atmosphere", *options.atmosphere});
  PrepareOutputs(outputs, inputs);
}

void MakeSky(const SkyOptions& options, const CommonOptions& common) {
  PrepareOutputsOf(options);
  const ExposureRule rule = ExposureRuleFromText(options.exposure);
  Look look = LookFromTexts(options.look);
  look.night_vision = options.night_vision;
  look = LookUnder(rule, look);
  SkyJob job = JobFrom(options);
  const RenderedSky sky = Rendered(job, common.progress_style());
  const PictureView view{Projection::kLatitudeLongitude, 2.0 * kPi / sky.image.width};
  look = Settled(look, sky.image, view);
  const HdrImage seen = Seen(sky.image, look, view);
  const double ev100 = Ev100Of(sky, seen, rule, look);
  Describe(job);
  job.metadata["alpenglow.illuminance_lux"] = fmt::format("{:.6g}", sky.illuminance_lux);
  job.metadata.merge(HeaderOfExposure(rule, ev100, RuleInWords(rule)));
  WriteExr(options.out, sky.image, job.metadata, Projection::kLatitudeLongitude);
  if (options.png) {
    job.metadata.merge(HeaderOfLook(look));
    WritePng(*options.png, Develop(seen, ev100, look), job.metadata);
  }
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
      ->check(ReadableBy([](const std::string& text) { (void)PanoramaOrientationFromName(text); }))
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
  sky.add_option("--exposure", options.exposure,
                 "Exposure: auto (the picture is metered), eye (dusk and night stay darker than "
                 "day), incident (the light on a horizontal plane is metered) or an EV at ISO 100, "
                 "-30 to 30")
      ->check(ReadableBy([](const std::string& text) { (void)ExposureRuleFromText(text); }))
      ->capture_default_str();
  AddLookOptions(sky, options.look, LookNames(), kToneMapHelp);
  sky.add_flag("--night-vision", options.night_vision, kNightVisionHelp);
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
