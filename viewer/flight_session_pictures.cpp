// SPDX-License-Identifier: MIT
// Defines the functions of FlightSession that write pictures and that save and restore moments of a
// flight.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"
#include "lut/cli/program.h"
#include "renderer/series/manifest.h"
#include "viewer/flight_session.h"
#include "viewer/gl/picture_tiles.h"

namespace alpenglow::viewer {
namespace {

constexpr int kPictureSamples = 4;
// Largest side of a tile, used if the driver cannot hold the whole picture: 0.7 GB.
constexpr int kLargestPart = 4096;

// Completed fractions when the flight exists, when its scene is ready, and when all light is
// painted. Over the built-in range at 1280x720 these steps take 2, 3 and 3 s, and writing takes
// 0.3 s.
constexpr double kBegunShare = 0.2;
constexpr double kSettledShare = 0.5;
constexpr double kPaintedShare = 0.95;

}  // namespace

void RequirePictureName(const std::filesystem::path& file) {
  if (HasExtension(file, ".png") || HasExtension(file, ".exr")) return;
  throw InputError(
      fmt::format("\"{}\" is no picture's name; it must end in .png or .exr", file.string()));
}

FlightMoment FlightSession::Moment() const {
  return {eye(),          now(),         knows_ground_, waits_above_ground_m_,
          scene_.terrain, medium_,       air_,          sky_air_,
          rule_,          look_,         white_,        rule_of_exposure_,
          exposure_,      landing_light_};
}

void FlightSession::TakeUp(const FlightMoment& moment) {
  // The eye keeps its position, whatever land is loaded here.
  const GroundHeight no_ground = [](const GeodeticPosition&) {
    return -std::numeric_limits<double>::infinity();
  };
  cockpit_.pilot().PutAt(moment.eye, no_ground);
  cockpit_.clock().Set(moment.now);
  knows_ground_ = moment.knows_ground;
  waits_above_ground_m_ = moment.waits_above_ground_m;
  if (has_range_ && moment.terrain.centre != scene_.terrain.centre) UseRange(moment.terrain);
  medium_ = moment.planet;
  air_ = moment.air;
  if (moment.sky_air && moment.sky_air != sky_air_) {
    scene_.medium = Changed(medium_, air_);
    sky_air_ = moment.sky_air;
    painter_.Replace(*sky_air_);
  }
  rule_ = moment.quality;
  look_ = moment.look;
  white_ = moment.white;
  rule_of_exposure_ = moment.exposure_rule;
  exposure_ = moment.exposure;
  landing_light_ = moment.landing_light;
}

Image FlightSession::Picture(const ImageSize& size, int samples, const PictureProgress& progress) {
  const Quality quality = rule_.fixed.value_or(Quality::kHigh);
  painter_.Use(SizesOf(quality));
  if (progress) progress(kBegunShare);
  Settle(size, samples);
  if (progress) progress(kSettledShare);
  AimLandingLight();
  Image image = PaintedInParts(ViewOf(size), samples, progress);
  painter_.Use(SizesOf(used_));
  return image;
}

Image FlightSession::PaintedInParts(const PaintedView& whole, int samples,
                                    const PictureProgress& progress) {
  const int largest = IsDrawable(whole.width, whole.height)
                          ? std::max(whole.width, whole.height)
                          : std::min(LargestSquareOfDriver(), kLargestPart);
  TiledPicture picture(whole.width, whole.height, settings_.largest_part.value_or(largest));
  const auto slices = static_cast<double>(picture.tiles().size()) * samples;
  int slices_before = 0;
  const auto after_sample = [&](int sample) {
    ThrowIfInterrupted();
    if (!progress) return;
    glFinish();  // completes the GPU's work before other threads use the GPU
    const double painted = (slices_before + sample) / slices;
    progress(kSettledShare + (kPaintedShare - kSettledShare) * painted);
  };
  for (const TiledPicture::Tile& tile : picture.tiles()) {
    ThrowIfInterrupted();
    painter_.Paint(
        {whole.eye, whole.now, tile.painted.width, tile.painted.height, picture.ViewOf(tile)},
        samples, SkyPainter::Bodies::kAll, after_sample);
    picture.Put(tile, painter_.picture().Read());
    slices_before += samples;
  }
  return picture.Take();
}

Metadata FlightSession::PictureHeader(const ImageSize& size) const {
  RenderSettings settings;
  settings.width = size.width;
  settings.height = size.height;
  settings.samples_per_pixel = kPictureSamples;
  settings.filter = PixelFilter::Kind::kBox;
  Metadata metadata = PictureMetadata(SceneSeen(), settings);
  metadata["alpenglow.time"] = FormatUtc(now(), 3);
  metadata["alpenglow.painter"] = "skyview";
  metadata["alpenglow.quality"] = NameOf(rule_.fixed.value_or(Quality::kHigh));
  return metadata;
}

Development FlightSession::DevelopmentOf(const Image& picture) const {
  Look look = look_;
  if (white_ && exposure_.ev100) {
    look.white = *white_;
    return {look, *exposure_.ev100};
  }
  const MeterReading reading = ReadingOf(picture, look_);
  look.white = reading.white;
  const double metered = Ev100By(rule_of_exposure_, reading.ev100, look_);
  return {look, exposure_.ev100.value_or(metered - exposure_.compensation_ev)};
}

Metadata FlightSession::ExposureHeader(const Development& development) const {
  const ExposureRule rule = exposure_.locked
                                ? ExposureRule{ExposureRule::Kind::kFixed, development.ev100}
                                : rule_of_exposure_;
  return {{"alpenglow.ev100", fmt::format("{:.4f}", development.ev100)},
          {"alpenglow.exposure", NameOf(rule.kind)},
          {"alpenglow.exposure_rule", RuleInWords(rule)},
          {"alpenglow.exposure_compensation_ev",
           fmt::format("{}", exposure_.locked ? 0.0 : exposure_.compensation_ev)},
          {"alpenglow.tone_curve", NameOf(development.look)},
          {"alpenglow.white_balance", NameOf(development.look.white)}};
}

Development FlightSession::PaintStill(const ToneMapPass::Screen& screen,
                                      const PictureProgress& progress) {
  const ImageSize size{screen.width, screen.height};
  const Image image = Picture(size, kPictureSamples, progress);
  const RenderTarget picture(size.width, size.height, RenderTarget::Depth::kNone);
  picture.Write(image);
  Development development = DevelopmentOf(image);
  exposure_.ev100 = development.ev100;
  darkroom_.developer().Use(development.look);
  darkroom_.developer().Develop(picture, development.ev100, screen);
  return development;
}

void FlightSession::WritePicture(const std::filesystem::path& file, const ImageSize& size,
                                 const PictureProgress& progress) {
  RequirePictureName(file);
  Image image = Picture(size, kPictureSamples, progress);
  const auto [look, ev100] = DevelopmentOf(image);
  Metadata metadata = PictureHeader(size);
  metadata.merge(ExposureHeader({look, ev100}));
  if (HasExtension(file, ".exr")) {
    WriteExr(file, image, metadata);
  } else {
    WritePng(file, Develop(Balanced(std::move(image), look.white), ev100, look), metadata);
  }
}

void FlightSession::WriteReplay(const CameraPath& path,
                                const std::vector<std::filesystem::path>& files,
                                const ImageSize& size, FlightRecorder& recorder) {
  const double steps = std::max(static_cast<double>(files.size()) - 1.0, 1.0);
  for (std::size_t i = 0; i < files.size(); ++i) {
    ThrowIfInterrupted();
    const double along_s = (path.end_s() - path.begin_s()) * static_cast<double>(i) / steps;
    Show(ReplayAt(path, path.begin_s() + along_s));
    WritePicture(files[i], size);
    recorder.Note(along_s, eye(), now());  // the ground at this place is loaded by now
  }
}

DisplayImage FlightSession::Film(const ReplayFrame& frame, const ImageSize& size, double seconds) {
  Show(frame);
  Image image = Picture(size, kPictureSamples);
  Expose(ReadingOf(image, look_), seconds);
  const Look& look = darkroom_.developer().look();
  return Develop(Balanced(std::move(image), look.white), *exposure_.ev100, look);
}

Scene FlightSession::SceneSeen() const {
  Scene seen = scene_;
  seen.place = eye().place;
  seen.place.height_m = 0.0;
  if (!has_one_model_) seen.terrain.kind = TerrainSource::Kind::kNone;
  seen.time = now();
  seen.camera.height = {eye().place.height_m, false};
  seen.camera.heading_rad = eye().heading_rad;
  seen.camera.pitch_rad = eye().pitch_rad;
  seen.camera.roll_rad = eye().roll_rad;
  seen.camera.fov_rad = eye().fov_rad;
  return seen;
}

}  // namespace alpenglow::viewer
