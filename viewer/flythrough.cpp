// SPDX-License-Identifier: MIT
#include "viewer/flythrough.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/number/constants.h"
#include "atmosphere/text/error.h"
#include "lut/program/program.h"
#include "renderer/series/provenance.h"
#include "viewer/capture/screenshot_name.h"

namespace alpenglow {
namespace {

constexpr double kClearance_m = 1.5;  // of the eye over the ground
constexpr double kZoomStep = 1.1;

Eye EyeOfScene(const Scene& scene, double height_m) {
  Eye eye{scene.place, scene.camera.heading_rad, scene.camera.pitch_rad, scene.camera.roll_rad,
          scene.camera.fov_rad};
  eye.place.height_m = height_m;
  return Zoomed(eye, 1.0);
}

SkyPainter PainterOf(const Scene& scene, const SceneGround& ground) {
  const Medium medium = OnOsculatingSphere(scene.medium, scene.place.latitude_rad);
  static_cast<void>(AirBlockOf(medium));  // refuses a medium of too many bands before it is solved
  return SkyPainter(medium, DiffuseLight(medium),
                    ground.terrain ? ground.terrain->mesh() : TriangleMesh{}, ground.frame,
                    scene.terrain.kind != TerrainSource::Kind::kMesh);
}

double Degrees(double radians) { return radians / kRadiansPerDegree; }

double Azimuth(double radians) {
  const double degrees = std::fmod(Degrees(radians) + 720.0, 360.0);
  return degrees;
}

}  // namespace

double AdaptedEv100(std::optional<double> before, double metered, double seconds) {
  constexpr double kHalfTime_s = 0.3;
  if (!before) return metered;
  return metered + (*before - metered) * std::exp2(-seconds / kHalfTime_s);
}

void RequirePictureName(const std::filesystem::path& file) {
  if (file.extension() == ".png" || file.extension() == ".exr") return;
  throw InputError(
      fmt::format("\"{}\" is no picture's name; it must end in .png or .exr", file.string()));
}

Flythrough::Flythrough(const Scene& scene, const UtcInstant& start)
    : scene_(scene),
      ground_(LoadGround(scene_)),
      painter_(PainterOf(scene_, ground_)),
      eye_(EyeOfScene(scene_, ground_.eye_height_m)),
      now_(start) {}

double Flythrough::GroundUnder(const GeodeticPosition& place) const {
  if (!ground_.terrain) return 0.0;
  constexpr double kFromHeight_m = 20000.0;  // over any mountain
  GeodeticPosition high = place;
  high.height_m = kFromHeight_m;
  const LocalFrame here(ground_.frame.ellipsoid(), place);
  const Vector<Ecef> down = here.EcefFromEnu(Vector<Enu>{{0.0, 0.0, -1.0}});
  const auto hit = ground_.terrain->Intersect(ground_.frame.EnuFromGeodetic(high).xyz,
                                              ground_.frame.EnuFromEcef(down).xyz);
  return hit ? kFromHeight_m - hit->distance_m : 0.0;
}

void Flythrough::Place(const EyePlacement& placement) {
  const double above_m = eye_.place.height_m - GroundUnder(eye_.place);
  eye_ = Placed(eye_, placement);
  if (!placement.height_m) eye_.place.height_m = GroundUnder(eye_.place) + above_m;
  eye_ = KeptAbove(eye_, GroundUnder(eye_.place), 0.0);
}

void Flythrough::Show(const ReplayFrame& frame) {
  eye_ = Zoomed(frame.eye, 1.0);
  eye_ = KeptAbove(eye_, GroundUnder(eye_.place), 0.0);
  if (frame.now) now_ = *frame.now;
}

void Flythrough::Advance(const Steering& steering, double seconds) {
  const double above_m = std::max(eye_.place.height_m - GroundUnder(eye_.place), 0.0);
  eye_ = Steer(eye_, steering, ground_.frame.ellipsoid(), above_m, seconds);
  eye_ = KeptAbove(eye_, GroundUnder(eye_.place), kClearance_m);
  now_ = AddSeconds(now_, time_rate_ * seconds);
}

void Flythrough::Do(Command command) {
  switch (command) {
    case Command::kFasterTime:
      time_rate_ = SteppedTimeRate(time_rate_, 1);
      break;
    case Command::kSlowerTime:
      time_rate_ = SteppedTimeRate(time_rate_, -1);
      break;
    case Command::kNarrowerView:
      eye_ = Zoomed(eye_, 1.0 / kZoomStep);
      break;
    case Command::kWiderView:
      eye_ = Zoomed(eye_, kZoomStep);
      break;
    case Command::kScreenshot:
      if (width_ > 0) WritePicture(NextScreenshot(".").replace_extension(".png"), width_, height_);
      break;
    case Command::kHud:
      hud_ = !hud_;
      break;
    case Command::kQuit:
      quit_ = true;
      break;
  }
}

void Flythrough::Paint(int width, int height, GLuint framebuffer, double seconds) {
  painter_.Paint(eye_, now_, width, height);
  ev100_ = AdaptedEv100(ev100_, painter_.MeteredEv100(), seconds);
  painter_.Develop(*ev100_, framebuffer);
  width_ = width;
  height_ = height;
}

void Flythrough::WritePicture(const std::filesystem::path& file, int width, int height) {
  RequirePictureName(file);
  constexpr int kSamples = 4;
  painter_.Paint(eye_, now_, width, height, kSamples);
  const Image image = painter_.Read();
  const double ev100 = ev100_.value_or(MeterEv100(image, kSunDiskLuminance_cd_per_m2));
  Scene seen = scene_;
  seen.place = eye_.place;
  seen.place.height_m = 0.0;
  seen.time = now_;
  seen.camera.height = {eye_.place.height_m, false};
  seen.camera.heading_rad = eye_.heading_rad;
  seen.camera.pitch_rad = eye_.pitch_rad;
  seen.camera.roll_rad = eye_.roll_rad;
  seen.camera.fov_rad = eye_.fov_rad;
  RenderSettings settings;
  settings.width = width;
  settings.height = height;
  settings.samples_per_pixel = kSamples;
  settings.filter = PixelFilter::Kind::kBox;
  Metadata metadata = PictureMetadata(seen, settings);
  metadata["alpenglow.time"] = FormatUtc(now_, 3);
  metadata["alpenglow.ev100"] = fmt::format("{}", ev100);
  metadata["alpenglow.painter"] = "skyview";
  if (file.extension() == ".exr") {
    WriteExr(file, image, metadata);
  } else {
    WritePng(file, Develop(image, ev100, ToneCurve::kAgx), metadata);
  }
}

void Flythrough::WriteReplay(const CameraPath& path,
                             const std::vector<std::filesystem::path>& files, const ImageSize& size,
                             FlightRecorder& recorder) {
  const double steps = std::max(static_cast<double>(files.size()) - 1.0, 1.0);
  for (std::size_t i = 0; i < files.size(); ++i) {
    ThrowIfInterrupted();
    const double along_s = (path.end_s() - path.begin_s()) * static_cast<double>(i) / steps;
    Show(ReplayAt(path, path.begin_s() + along_s));
    recorder.Note(along_s, eye_, now_);
    WritePicture(files[i], size.width, size.height);
  }
}

DisplayImage Flythrough::Film(const ReplayFrame& frame, const ImageSize& size, double seconds) {
  constexpr int kSamples = 4;
  Show(frame);
  painter_.Paint(eye_, now_, size.width, size.height, kSamples);
  ev100_ = AdaptedEv100(ev100_, painter_.MeteredEv100(), seconds);
  return Develop(painter_.Read(), *ev100_, ToneCurve::kAgx);
}

std::string Flythrough::HudText() const {
  if (!hud_) return "skyview";
  const SunPosition sun = ApparentSunAt(eye_.place, now_);
  return fmt::format(
      "skyview  {:.4f} {:.4f}  {:.0f} m ({:.0f} m over ground)  heading {:03.0f}  pitch {:+.0f}  "
      "view {:.0f}  {} x{:.0f}  sun {:+.1f} at {:03.0f}  EV {:.1f}",
      Degrees(eye_.place.latitude_rad), Degrees(eye_.place.longitude_rad), eye_.place.height_m,
      eye_.place.height_m - GroundUnder(eye_.place), Azimuth(eye_.heading_rad),
      Degrees(eye_.pitch_rad), Degrees(eye_.fov_rad), FormatUtc(now_), time_rate_,
      Degrees(sun.elevation_rad), Azimuth(sun.azimuth_rad), ev100_.value_or(0.0));
}

}  // namespace alpenglow
