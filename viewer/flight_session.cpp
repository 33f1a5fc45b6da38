// SPDX-License-Identifier: MIT
#include "viewer/flight_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "atmosphere/base/error.h"
#include "renderer/scene/places.h"
#include "renderer/scene/scene_options.h"
#include "renderer/terrain/loaded_heights.h"
#include "renderer/terrain/procedural_mountains.h"
#include "viewer/gl/gl_objects.h"
#include "viewer/shaders/uniform_blocks.h"

namespace alpenglow::viewer {
namespace {

// The renderer starts its picture after the eye has been at rest for this time.
constexpr double kStandsStill_s = 0.3;

Eye EyeOfScene(const Scene& scene) {
  Eye eye{scene.place, scene.camera.heading_rad, scene.camera.pitch_rad, scene.camera.roll_rad,
          scene.camera.fov_rad};
  eye.place.height_m = scene.camera.height.value_m;
  return Zoomed(eye, 1.0);
}

// Returns the half width of a square around a place that contains all land, at most 60 km. A
// smaller square has finer samples.
double HalfWidthOfLand(const LandLattice& lattice, const GeodeticPosition& place) {
  constexpr double kMost_m = 60e3;
  const SampleSize size = SampleSizeAt(lattice, place.latitude_rad);
  const LatticePlace at = lattice.At(place.latitude_rad, place.longitude_rad);
  const double columns = std::max(at.column, lattice.last_column - at.column);
  const double rows = std::max(at.row, lattice.last_row - at.row);
  return std::min(std::max(columns * size.column_m, rows * size.row_m) + size.row_m, kMost_m);
}

Look InDaylight(Look look) {
  look.white = {};
  return look;
}

// Throws InputError for a medium with too many wavelengths, before it is solved.
const Scene& Drawable(const Scene& scene) {
  static_cast<void>(AirBlockOf(scene.medium));
  return scene;
}

}  // namespace

double AdaptedEv100(std::optional<double> before, double metered, double seconds) {
  constexpr double kHalfTime_s = 0.3;
  if (!before) return metered;
  return metered + (*before - metered) * std::exp2(-seconds / kHalfTime_s);
}

WhiteBalance AdaptedWhite(const WhiteBalance& before, const WhiteBalance& metered, double seconds) {
  if (before.kind != metered.kind || !before.kelvin || !metered.kelvin) return metered;
  return {metered.kind, 1.0 / AdaptedEv100(1.0 / *before.kelvin, 1.0 / *metered.kelvin, seconds)};
}

FlightSession::FlightSession(const Scene& scene, const UtcInstant& start,
                             const FlightSessionSettings& settings)
    : first_scene_(Drawable(scene)),
      settings_(settings),
      scene_(scene),
      first_terrain_(scene.terrain),
      has_range_(settings.land.files.empty() && settings.land.range_centre),
      has_one_model_(settings.land.files.empty() ||
                     (settings.land.files.size() == 1 &&
                      !std::filesystem::is_directory(settings.land.files.front()))),
      medium_(scene.medium),
      rule_(settings.quality),
      auto_(1.0 / settings.frame_rate),
      used_(Painted()),
      cockpit_(EyeOfScene(scene), EllipsoidOf(scene.medium), start),
      darkroom_(InDaylight(settings.look), settings.first_air ? ToneMapPass::FirstPictures::kDraft
                                                              : ToneMapPass::FirstPictures::kWait),
      painter_(scene, settings.land,
               {EyeOfScene(scene), start, settings.size.width, settings.size.height},
               SizesOf(used_.quality), settings.first_air),
      rule_of_exposure_(settings.exposure),
      look_(settings.look) {
  if (settings.exposure.kind == ExposureRule::Kind::kFixed) {
    SetExposure(settings.exposure.ev100);
    rule_of_exposure_ = {};  // applies once the exposure is unlocked
  }
  if (first_terrain_.kind == TerrainSource::Kind::kProceduralMountains && !first_terrain_.centre)
    first_terrain_.centre = scene.place;
  scene_.terrain = first_terrain_;
  if (scene.camera.height.above_ground) ForgetGround(scene.camera.height.value_m);
}

bool FlightSession::IsRangeExpectedAt(const GeodeticPosition& place) const {
  constexpr double kNear_m = 100.0;
  if (!has_range_ || painter_.land().KnowsGround(place)) return false;
  GeodeticPosition view = ProceduralMountainsViewAboveGround(*scene_.terrain.centre).eye;
  view.height_m = place.height_m;
  return glm::length(LocalFrame(kWgs84, view).EnuFromGeodetic(place).xyz) < kNear_m;
}

GroundHeight FlightSession::Ground() const {
  return [this](const GeodeticPosition& place) {
    if (IsRangeExpectedAt(place)) return kRangeViewGround_m;
    return painter_.land().GroundUnder(place).value_or(0.0);
  };
}

void FlightSession::ForgetGround(std::optional<double> above_ground_m) {
  knows_ground_ = false;
  waits_above_ground_m_ = above_ground_m;
  put_at_ = std::nullopt;
}

void FlightSession::AwaitGround() {
  if (knows_ground_ || !waits_above_ground_m_) return;
  if (!IsRangeExpectedAt(eye().place)) {
    painter_.land().AwaitGround(eye().place);
    return StandOnGround();
  }
  Eye stands = eye();
  stands.place.height_m = kRangeViewGround_m + *waits_above_ground_m_;
  cockpit_.pilot().PutAt(stands, Ground());
  put_at_ = eye();
}

void FlightSession::StandOnGround() {
  if (knows_ground_ || !painter_.land().KnowsGround(eye().place)) return;
  knows_ground_ = true;
  const std::optional<double> above_m = std::exchange(waits_above_ground_m_, std::nullopt);
  const bool has_left = put_at_ && *put_at_ != eye();
  if (!above_m || has_left) return cockpit_.pilot().KeepAbove(Ground());
  Eye stands = eye();
  stands.place.height_m = painter_.land().HighestGround(stands.place).value_or(0.0) + *above_m;
  cockpit_.pilot().PutAt(stands, Ground());
}

void FlightSession::Place(const EyePlacement& placement) {
  const bool moves = placement.latitude_deg || placement.longitude_deg;
  if (!moves && !placement.height_m && !placement.heading_deg && !placement.pitch_deg) return;
  const double above_m =
      waits_above_ground_m_.value_or(eye().place.height_m - Ground()(eye().place));
  Eye placed = Placed(eye(), placement);
  if (moves) BringLandTo(placed.place, "this place");
  if (moves && !placement.height_m)
    placed.place.height_m = Ground()(placed.place) + std::max(above_m, 0.0);
  cockpit_.pilot().PutAt(placed, Ground());
  if (placement.height_m) {
    ForgetGround();
  } else if (moves) {
    ForgetGround(std::max(above_m, 0.0));
  }
}

void FlightSession::GoTo(const std::string& name) {
  const NamedPlace& there = PlaceNamed(name);
  BringLandTo(there.place, there.name);
  cockpit_.GoTo(there, Ground());
  ForgetGround(eye().place.height_m - Ground()(eye().place));
}

void FlightSession::BringRangeTo(const GeodeticPosition& place) {
  const auto reaches = [&](const TerrainSource& range) {
    return ProceduralMountainsExtent(*range.centre).Covers(place.latitude_rad, place.longitude_rad);
  };
  if (!has_range_ || reaches(scene_.terrain)) return;
  UseRange(reaches(first_terrain_) ? first_terrain_ : RangeSeenFrom(place));
}

void FlightSession::UseRange(const TerrainSource& range) {
  scene_.terrain = range;
  painter_.Replace(LandSourceOf(scene_));
  reference_.reset();
  reference_scene_.reset();
}

void FlightSession::BringLandTo(const GeodeticPosition& place, const std::string& name) {
  BringRangeTo(place);
  const Landscape& land = painter_.land();
  if (land.tiles().source().IsEmpty()) return;
  if (land.Reaches(place)) {
    if (!land.KnowsGround(place)) painter_.AwaitLand();
    return;
  }
  notes_.push_back(
      fmt::format("there is no terrain at {}: --dem loads an elevation model of it", name));
}

std::vector<std::string> FlightSession::TakeNotes() {
  std::vector<std::string> notes = std::exchange(notes_, {});
  for (std::string& note : painter_.land().TakeNotes()) notes.push_back(std::move(note));
  return notes;
}

void FlightSession::Follow(const CameraPath& path) {
  ForgetGround();
  cockpit_.pilot().SetTrack(std::make_shared<const CameraPath>(path));
  static_cast<void>(cockpit_.Do(Action::kTrackMode, Ground()));
}

void FlightSession::Replay(const CameraPath& flight) {
  ForgetGround();
  cockpit_.Replay(std::make_shared<const CameraPath>(flight), Ground());
}

void FlightSession::FlyAgain(const CameraPath& flown) {
  ForgetGround();
  cockpit_.FlyAgain(std::make_shared<const CameraPath>(flown), Ground());
}

void FlightSession::Show(const ReplayFrame& frame) {
  ForgetGround();
  const CameraPathPoint shown{frame.path_s, PoseOf(Zoomed(frame.eye, 1.0)), frame.now};
  cockpit_.Replay(std::make_shared<const CameraPath>(std::vector{shown}), Ground());
}

void FlightSession::Advance(const PilotControls& controls, double seconds) {
  StandOnGround();
  cockpit_.Advance(controls, seconds, Ground());
  still_s_ = still_eye_ == eye() ? still_s_ + seconds : 0.0;
  still_eye_ = eye();
}

std::string FlightSession::JumpTo(SkyEvent event) { return cockpit_.JumpTo(event); }

std::optional<std::string> FlightSession::Do(Action action) {
  if (auto said = cockpit_.Do(action, Ground())) return said;
  constexpr double kStep_ev = 1.0 / 3.0;
  constexpr double kHazeStep = 1.25;
  switch (action) {
    case Action::kExposureLock:
      exposure_.locked = !exposure_.locked;
      return exposure_.locked ? "exposure locked" : "exposure follows the meter";
    case Action::kBrighter:
    case Action::kDarker:
      exposure_.compensation_ev += action == Action::kBrighter ? kStep_ev : -kStep_ev;
      return fmt::format("exposure {:+.1f} EV", exposure_.compensation_ev);
    case Action::kResetExposure:
      exposure_ = {false, 0.0, exposure_.ev100};
      return "exposure follows the meter";
    case Action::kClearer:
    case Action::kHazier: {
      AirChoice choice = air_;
      choice.aerosol = std::clamp(
          air_.aerosol * (action == Action::kHazier ? kHazeStep : 1.0 / kHazeStep), 1e-3, 1000.0);
      Use(choice);
      return fmt::format("visibility {:.1f} km", 1e-3 * VisibilityOf(Changed(medium_, air_)));
    }
    case Action::kResetVisibility: {
      AirChoice choice = air_;
      choice.aerosol = 1.0;
      Use(choice);
      return fmt::format("visibility {:.1f} km", 1e-3 * VisibilityOf(medium_));
    }
    case Action::kNextQuality: {
      const int next = rule_.fixed ? static_cast<int>(*rule_.fixed) + 1 : 0;
      Use(next > static_cast<int>(Quality::kReference) ? QualityRule{}
                                                       : QualityRule{static_cast<Quality>(next)});
      return "quality " + QualityText();
    }
    default:
      return std::nullopt;
  }
}

void FlightSession::Use(const QualityRule& rule) {
  rule_ = rule;
  reference_.reset();
}

void FlightSession::Use(const AirChoice& choice) {
  const Medium changed = Changed(medium_, choice);
  air_ = choice;
  scene_.medium = changed;
  reference_scene_.reset();
  sky_air_ = OnOsculatingSphere(changed, eye().place.latitude_rad);
  painter_.Replace(*sky_air_);
}

void FlightSession::UsePlanet(const std::string& preset) {
  Medium planet = MediumPreset(preset);
  if (planet.follows_wgs84 != medium_.follows_wgs84) {
    throw InputError(fmt::format(
        "{} is another planet than the one that this land lies on; start there with a scene file",
        preset));
  }
  static_cast<void>(AirBlockOf(planet));
  medium_ = std::move(planet);
  Use(air_);
}

void FlightSession::SetExposure(double ev100) { exposure_ = {true, 0.0, ev100}; }

PaintedQuality FlightSession::Painted() const {
  return rule_.fixed ? PaintedAlways(*rule_.fixed) : auto_.painted();
}

void FlightSession::NoteFrame(double seconds) {
  if (!rule_.fixed) auto_.Note(seconds);
}

std::string FlightSession::QualityText() const {
  if (!rule_.fixed) return "auto: " + TextOf(auto_.painted());
  if (*rule_.fixed == Quality::kReference && reference_ && reference_->samples() > 0)
    return fmt::format("reference, {} rays a pixel", reference_->samples());
  return NameOf(*rule_.fixed);
}

std::string FlightSession::zone() const { return ZoneNear(eye().place, scene_.zone, scene_.place); }

PaintedView FlightSession::ViewOf(const ImageSize& size) const {
  return {eye(), now(), size.width, size.height};
}

ReferenceScene FlightSession::SceneForRenderer() const {
  ReferenceScene scene{SceneSeen(), nullptr};
  if (!has_one_model_) scene.ground = GroundAround();
  return scene;
}

std::function<std::shared_ptr<const SceneGround>()> FlightSession::GroundAround() const {
  constexpr int kMostSamples = 3000;
  return [sample = painter_.land().Sampler(), place = eye().place,
          half_width_m = HalfWidthOfLand(painter_.land().tiles().lattice(), eye().place),
          ellipsoid = EllipsoidOf(scene_.medium)]() -> std::shared_ptr<const SceneGround> {
    GeodeticPosition foot = place;
    foot.height_m = 0.0;
    const LocalFrame frame(ellipsoid, foot);
    const std::optional<ElevationGrid> grid = sample(place, half_width_m, kMostSamples);
    if (!grid)
      return std::make_shared<const SceneGround>(
          SceneGround{frame, std::nullopt, place.height_m, "", true});
    SceneGround ground = GroundOf(*grid, frame);
    ground.eye_height_m = place.height_m;
    return std::make_shared<const SceneGround>(std::move(ground));
  };
}

void FlightSession::ShowReference(const ImageSize& size) {
  const bool wanted =
      rule_.fixed == std::optional(Quality::kReference) && still_s_ >= kStandsStill_s;
  if (!wanted) return;
  if (!reference_) reference_ = std::make_unique<ReferencePicture>();
  if (!reference_scene_)
    reference_scene_ = std::make_shared<const ReferenceScene>(SceneForRenderer());
  reference_->Show({reference_scene_, eye(), now(), size.width, size.height});
  if (const std::optional<Image> image = reference_->Take()) painter_.Show(*image);
}

void FlightSession::AimLandingLight() {
  if (!landing_light_) return painter_.SetLandingLight(std::nullopt);
  LandingLight light;
  const ViewAxes axes = AxesOf(eye());
  light.axis = axes.forward;
  light.offset_m = -1.5 * axes.up;
  painter_.SetLandingLight(light);
}

std::optional<double> FlightSession::LuminanceAt(double right, double down) {
  const bool is_inside = right >= 0.0 && right < 1.0 && down >= 0.0 && down < 1.0;
  if (exposure_.ev100 && is_inside) return spot_.At(painter_.picture(), right, down);
  spot_.Leave();
  return std::nullopt;
}

void FlightSession::Paint(const ToneMapPass::Screen& screen, double seconds) {
  const PaintedQuality wanted = Painted();
  if (wanted != used_) painter_.Use(SizesOf(wanted));
  used_ = wanted;
  const auto scaled = [&](int side) {
    const int part = std::max(static_cast<int>(std::lround(wanted.scale * side)), 1);
    return wanted.scale < 1.0 ? OffPowersOfTwo(part) : part;
  };
  const ImageSize size{scaled(screen.width), scaled(screen.height)};
  AimLandingLight();
  const PaintedView view = ViewOf(size);
  const bool awaited_land = painter_.AwaitsLand();
  painter_.Update(view, seconds);
  const bool is_another = (awaited_land && !painter_.AwaitsLand()) || HasJumped();
  const bool has_reference = reference_ && reference_->samples() > 0 && still_s_ > 0.0;
  if (!has_reference) {
    painter_.Paint(
        view, 1,
        DisplayPass::Upscales(view, screen) ? SkyPainter::Bodies::kNone : SkyPainter::Bodies::kAll);
  }
  ShowReference({screen.width, screen.height});
  if (const std::optional<MeterReading> metered = meter_.Take(look_)) metered_ = metered;
  meter_.LookAt(painter_.picture());
  if (!metered_ || is_another) metered_ = meter_.Read(painter_.picture(), look_);
  if (is_another) ForgetAdaptation();
  Expose(*metered_, seconds);
  darkroom_.Print(painter_, view, *exposure_.ev100, screen);
}

// A clock at 3600 times real time passes these 900 s in a quarter of a second.
bool FlightSession::HasJumped() {
  constexpr double kJump_s = 900.0;
  const std::optional<UtcInstant> before = std::exchange(painted_at_, now());
  return before && std::abs(SecondsBetween(*before, now())) > kJump_s;
}

// The next picture is unrelated to the previous one, so nothing adapts to it.
void FlightSession::ForgetAdaptation() {
  if (!exposure_.locked) exposure_.ev100 = std::nullopt;
  white_ = std::nullopt;
}

void FlightSession::Settle(const ImageSize& size, int samples) {
  painter_.Settle(ViewOf(size), samples);
  if (knows_ground_) return;
  StandOnGround();
  painter_.Settle(ViewOf(size), samples);
}

void FlightSession::Use(const Look& look) {
  if (look.white != look_.white) {
    white_.reset();  // a new rule takes effect without adaptation
    metered_.reset();
  }
  look_ = look;
}

std::optional<double> FlightSession::white_k() const {
  if (!white_) return std::nullopt;
  return white_->IsDaylight() ? std::optional(kDaylight_k) : white_->kelvin;
}

double FlightSession::AdaptedTo(double metered_ev100, double seconds) {
  if (rule_of_exposure_.kind != ExposureRule::Kind::kEye) return metered_ev100;
  const UtcInstant before = adapted_at_.value_or(now());
  adapted_at_ = now();
  // After a jump of an hour the eye has had an hour to adapt.
  return adaptation_.Follow(metered_ev100,
                            std::max(seconds, std::abs(SecondsBetween(before, now()))));
}

void FlightSession::Expose(const MeterReading& metered, double seconds) {
  if (!exposure_.locked) {
    const double wanted = Ev100By(rule_of_exposure_, AdaptedTo(metered.ev100, seconds), look_);
    exposure_.ev100 = AdaptedEv100(exposure_.ev100, wanted - exposure_.compensation_ev, seconds);
  }
  white_ = white_ ? AdaptedWhite(*white_, metered.white, seconds) : metered.white;
  Look shown = look_;
  shown.white = *white_;
  darkroom_.developer().Use(shown);
}

}  // namespace alpenglow::viewer
