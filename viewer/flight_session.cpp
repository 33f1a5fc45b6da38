// SPDX-License-Identifier: MIT
#include "viewer/flight_session.h"

#include <limits>
#include <memory>

#include "viewer/reports.h"
#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {
namespace {

CameraPose EyeOfScene(const Scene& scene) {
  CameraPose eye{scene.place, scene.camera.heading_rad, scene.camera.pitch_rad,
                 scene.camera.roll_rad, scene.camera.fov_rad};
  eye.place.height_m = scene.camera.height.value_m;
  return eye;
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

QualityChoice QualityOf(const FlightSessionSettings& settings) {
  return {settings.quality, settings.frame_rate};
}

}  // namespace

FlightSession::FlightSession(const Scene& scene, const UtcTime& start,
                             const FlightSessionSettings& settings)
    : start_{Drawable(scene), settings},
      controller_(EyeOfScene(scene), EllipsoidOf(scene.medium), start,
                  [this](const Place& place) { return edits_.GroundAt(place); }),
      exposure_(settings.exposure, settings.look),
      display_pass_(InDaylight(settings.look), IsDraft(settings.first_air)
                                                   ? ToneMapPass::FirstPictures::kDraft
                                                   : ToneMapPass::FirstPictures::kWait),
      painter_(scene, settings.land,
               {InWindow(EyeOfScene(scene)), start, settings.size.width, settings.size.height},
               SizesOf(QualityOf(settings).painted().quality), settings.first_air),
      edits_(scene, settings.land, painter_),
      standpoint_(controller_, edits_, painter_),
      frames_(painter_, display_pass_, exposure_, QualityOf(settings)) {
  if (scene.camera.height.above_ground) standpoint_.Leave(scene.camera.height.value_m);
}

void FlightSession::Follow(const CameraPath& path) {
  standpoint_.Leave();
  controller_.pilot().SetTrack(std::make_shared<const CameraPath>(path));
  controller_.Enter(FlightMode::kTrack);
}

void FlightSession::Replay(const CameraPath& flight) {
  standpoint_.Leave();
  controller_.Replay(std::make_shared<const CameraPath>(flight));
}

void FlightSession::FlyAgain(const CameraPath& flown) {
  standpoint_.Leave();
  controller_.FlyAgain(std::make_shared<const CameraPath>(flown));
}

void FlightSession::Show(const ReplayFrame& frame) {
  const CameraPathPoint shown{frame.path_s, frame.eye, frame.now};
  Replay(CameraPath(std::vector{shown}));
}

void FlightSession::Advance(const PilotControls& controls, double seconds) {
  standpoint_.StandOnGround();
  controller_.Advance(controls, seconds);
}

void FlightSession::Paint(const ToneMapPass::Screen& screen, double seconds) {
  const CameraPose shown = InWindow(eye());
  const auto scene = [&] { return edits_.ForRenderer(shown, now()); };
  frames_.Paint(shown, now(), {scene, edits_.version()}, screen, seconds);
}

void FlightSession::WaitUntilReady(const ImageSize& size) {
  painter_.WaitUntilReady(InWindow(ViewOf(size)));
  if (standpoint_.KnowsGround()) return;
  standpoint_.StandOnGround();
  painter_.WaitUntilReady(InWindow(ViewOf(size)));
}

FlightMoment FlightSession::Moment() const {
  return {eye(),          now(),     standpoint_.state(),        edits_.changes(),
          frames_.rule(), exposure_, frames_.has_landing_light()};
}

void FlightSession::TakeUp(const FlightMoment& moment) {
  // The eye keeps its position, whatever land is loaded here.
  const GroundHeight no_ground = [](const Place&) {
    return -std::numeric_limits<double>::infinity();
  };
  controller_.pilot().PutAt(moment.eye, no_ground);
  controller_.clock().Set(moment.now);
  standpoint_.Restore(moment.standpoint);
  edits_.Restore(moment.scene);
  frames_.Use(moment.quality);
  exposure_ = moment.exposure;
  frames_.SetLandingLight(moment.landing_light);
}

std::string FlightSession::Explain(const ImageSize& size) {
  WaitUntilReady(size);
  return ExplainView(painter_, edits_.ForRenderer(eye(), now()), ViewOf(size),
                     frames_.rule().fixed.value_or(Quality::kMedium));
}

}  // namespace alpenglow::viewer
