// SPDX-License-Identifier: MIT
#include "viewer/viewer_app.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/refraction/refracted_view.h"
#include "lut/cli/messages.h"
#include "lut/cli/output_file.h"
#include "lut/image/look.h"
#include "lut/sky/sky_view_map.h"
#include "renderer/scene/places.h"
#include "viewer/gl/picture_tiles.h"
#include "viewer/passes/picture_programs.h"
#include "viewer/picture_queue.h"
#include "viewer/window.h"

namespace alpenglow::viewer {
namespace {

constexpr double kMessage_s = 8.0;
const std::vector<std::string> kCurves{"agx", "aces", "reinhard", "pbr-neutral", "linear"};
const std::vector<std::string> kWhiteBalances{"camera", "daylight", "auto"};
const std::vector<std::string> kQualities{"auto", "low", "medium", "high", "reference"};

const char* NameOf(FlightMode mode) {
  switch (mode) {
    case FlightMode::kAircraft:
      return "aircraft";
    case FlightMode::kTrack:
      return "track";
    case FlightMode::kFree:
      break;
  }
  return "free camera";
}

HudFlight FlightOf(FlightSession& flight) {
  const Eye& eye = flight.eye();
  const FlightReadout readout = flight.cockpit().pilot().Readout(flight.edits().Ground());
  HudFlight shown;
  shown.mode = readout.aircraft ? std::string(readout.aircraft_name) : NameOf(readout.mode);
  if (flight.cockpit().pilot().Replays()) shown.mode = "replay";
  shown.heading_rad = eye.heading_rad;
  shown.pitch_rad = eye.pitch_rad;
  shown.roll_rad = eye.roll_rad;
  shown.fov_rad = eye.fov_rad;
  const double height_m = std::max(eye.place.height_m, 0.0);
  shown.horizon_dip_rad =
      SkyViewMap(OnOsculatingSphere(flight.edits().planet(), eye.place.latitude_rad), height_m, 1.0)
          .horizon_zenith_angle_rad() -
      0.5 * kPi;
  shown.ground_speed_m_per_s = readout.speed_m_per_s;
  shown.height_m = eye.place.height_m;
  shown.above_ground_m = readout.above_ground_m;
  shown.climb_m_per_s = readout.vertical_speed_m_per_s;
  if (readout.course)
    shown.path = HudDirection{readout.course->heading_rad, readout.course->climb_rad};
  if (!readout.aircraft) return shown;
  shown.air_speed_m_per_s = readout.aircraft->indicated_m_per_s;
  shown.throttle = readout.aircraft->throttle;
  shown.load_factor = readout.aircraft->load;
  shown.stall = readout.aircraft->stalled;
  return shown;
}

std::string ZoneOf(FlightSession& flight) { return flight.edits().ZoneAt(flight.eye().place); }

HudTime TimeOf(FlightSession& flight) {
  const SceneClock& clock = flight.cockpit().clock();
  const LocalTime local = LocalTimeAt(clock.now(), ZoneOf(flight));
  HudTime time;
  time.utc = FormatUtc(clock.now());
  time.local = local.time;
  time.zone = local.zone;
  time.day_fraction = local.day_fraction;
  time.rate = clock.rate();
  time.paused = clock.paused();
  return time;
}

HudSky SkyOf(FlightSession& flight) {
  const BendingAir air = GentleAirOf(flight.edits().planet());
  const SunPosition sun = ApparentSunAt(flight.eye().place, flight.now(), air);
  const MoonPosition moon = ApparentMoonAt(flight.eye().place, flight.now(), air);
  return {sun.azimuth_rad, sun.elevation_rad,
          HudMoon{moon.azimuth_rad, moon.elevation_rad, moon.IlluminatedFraction()}};
}

HudAir AirOf(FlightSession& flight) {
  const Medium& planet = flight.edits().planet();
  const Medium air = Changed(planet, flight.edits().air_choice());
  HudAir shown;
  shown.planet = planet.name;
  shown.visibility_km = std::min(1e-3 * VisibilityOf(air), 1e4);
  const double height_m = flight.eye().place.height_m;
  shown.visibility_here_km =
      std::min(1e-3 * VisibilityAt(air, height_m, flight.frames().FogAt(height_m)), 1e4);
  shown.aerosol_scale = flight.edits().air_choice().aerosol;
  shown.ozone_du = OzoneDobson(air);
  double albedo = 0.0;
  for (const double value : air.ground_albedo) albedo += value;
  shown.ground_albedo = albedo / static_cast<double>(air.ground_albedo.size());
  return shown;
}

HudAutopilot AutopilotOf(const Pilot& pilot) {
  if (pilot.aircraft() == nullptr) return {};
  const AutopilotTargets& held = pilot.aircraft()->autopilot().targets();
  return {held.heading_rad, held.height_m, held.speed_m_per_s};
}

std::string WhiteBalanceOf(const Look& look) {
  for (const std::string& name : kWhiteBalances) {
    if (WhiteBalanceFromText(name) == look.white) return name;
  }
  return fmt::format("{:.0f} K", look.white.kelvin.value_or(kDaylight_k));
}

HudExposure ExposureOf(const ExposureControl& control) {
  const FlightExposure& exposure = control.exposure();
  const Look& look = control.look();
  HudExposure shown;
  shown.ev100 = exposure.ev100.value_or(15.0);
  shown.locked = exposure.locked;
  shown.compensation_ev = exposure.compensation_ev;
  shown.tone_curve = NameOf(look.curve);
  shown.look = NameOf(look.agx);
  shown.white_balance = WhiteBalanceOf(look);
  shown.white_k = control.white_k();
  return shown;
}

// Returns the flight modes, named like the keys that select them.
std::vector<Action> ModesOf(const Pilot& pilot) {
  std::vector<Action> modes{Action::kFreeMode, Action::kAircraftMode};
  if (pilot.track().exists()) modes.push_back(Action::kTrackMode);
  return modes;
}

std::vector<HudRow> TablesOf(const TableFigures& figures) {
  const LandFigures& land = figures.land;
  const auto ms = [](double seconds) { return fmt::format("{:.0f} ms", 1e3 * seconds); };
  const auto mb = [](std::size_t bytes) {
    return fmt::format("{:.0f} MB", 1e-6 * static_cast<double>(bytes));
  };
  return {{"air", ms(figures.air_s), ""},
          {"light on land", ms(figures.ground_s), ""},
          {"shade", ms(figures.shade_s), ""},
          {fmt::format("land, {} triangles", land.triangles), "",
           mb(land.tile_bytes + land.chunk_bytes + land.card_bytes)}};
}

HudSettings SettingsOf(const Hud& hud) {
  return {.scale = hud.scale(), .theme = hud.theme_choice()};
}

// Draws the instruments with a second Hud. The Hud of the window keeps its panels unchanged, and
// none of them appears in the picture.
void DrawInstruments(const RenderTarget& screen, const HudModel& model,
                     const HudSettings& settings) {
  Hud instruments(settings);
  HudInput input;
  input.width = screen.width();
  input.height = screen.height();
  static_cast<void>(instruments.Update(model, {}, nullptr, input));
  instruments.Paint(screen.framebuffer());
}

void RequireInstruments(const std::filesystem::path& file, const ImageSize& size) {
  if (!HasExtension(file, ".png"))
    throw InputError(fmt::format("\"{}\": only a PNG has instruments (--hud on)", file.string()));
  RequireDrawable(size.width, size.height);
}

HudProgress ProgressOf(const PictureUnderWay& picture) {
  const std::string name = picture.file.filename().string();
  if (picture.waiting == 0) return {fmt::format("Picture {}:", name), picture.share};
  return {fmt::format("Picture {} ({} more to come):", name, picture.waiting), picture.share};
}

// Carries out an action of the flight. Returns a message about its result, which is empty if there
// is nothing to report; nullopt for other actions.
std::optional<std::string> Carry(Action action, FlightSession& flight) {
  if (auto said = flight.cockpit().Do(action, flight.edits().Ground())) return said;
  constexpr double kStep_ev = 1.0 / 3.0;
  constexpr double kHazeStep = 1.25;
  ExposureControl& exposure = flight.exposure();
  SceneEdits& edits = flight.edits();
  AirChoice choice = edits.air_choice();
  switch (action) {
    case Action::kExposureLock:
      exposure.Lock(!exposure.exposure().locked);
      return exposure.exposure().locked ? "exposure locked" : "exposure follows the meter";
    case Action::kBrighter:
    case Action::kDarker:
      exposure.Compensate(exposure.exposure().compensation_ev +
                          (action == Action::kBrighter ? kStep_ev : -kStep_ev));
      return fmt::format("exposure {:+.1f} EV", exposure.exposure().compensation_ev);
    case Action::kResetExposure:
      exposure.Reset();
      return "exposure follows the meter";
    case Action::kClearer:
    case Action::kHazier:
      choice.aerosol = std::clamp(
          choice.aerosol * (action == Action::kHazier ? kHazeStep : 1.0 / kHazeStep), 1e-3, 1000.0);
      edits.Use(choice, flight.eye().place);
      return fmt::format("visibility {:.1f} km",
                         1e-3 * VisibilityOf(Changed(edits.planet(), choice)));
    case Action::kResetVisibility:
      choice.aerosol = 1.0;
      edits.Use(choice, flight.eye().place);
      return fmt::format("visibility {:.1f} km", 1e-3 * VisibilityOf(edits.planet()));
    case Action::kNextQuality: {
      const std::optional<Quality> fixed = flight.frames().rule().fixed;
      const int next = fixed ? static_cast<int>(*fixed) + 1 : 0;
      flight.frames().Use(next > static_cast<int>(Quality::kReference)
                              ? QualityRule{}
                              : QualityRule{static_cast<Quality>(next)});
      return "quality " + flight.frames().QualityText();
    }
    default:
      return std::nullopt;
  }
}

std::string TextOf(const PictureOutcome& outcome) {
  const std::string name = outcome.file.filename().string();
  if (outcome.fault.empty()) return fmt::format("{} is written", name);
  return fmt::format("{} is not written: {}", name, outcome.fault);
}

}  // namespace

ViewerApp::ViewerApp(FlightSession& flight, FlightRecorder& recorder, const Settings& settings)
    : flight_(flight),
      recorder_(recorder),
      hud_({.scale = settings.hud_scale}),
      controls_(settings.controls),
      pictures_(flight.start().scene, flight.start().settings) {
  if (!settings.shows_hud) hud_.ToggleVisible();
}

ViewerApp::~ViewerApp() {
  pictures_.Finish();
  SayOutcomes();
}

void ViewerApp::FinishWithoutWindow() {
  pictures_.FinishWithoutWindow();
  SayOutcomes();
}

void ViewerApp::SayOutcomes() {
  for (const PictureOutcome& outcome : pictures_.TakeOutcomes())
    lut::Say(fmt::format("skyview: {}\n", TextOf(outcome)));
}

void ViewerApp::Say(const std::string& text, bool is_warning) {
  constexpr std::size_t kMost = 6;
  messages_.push_back({text, 0.0, is_warning});
  if (messages_.size() > kMost) messages_.pop_front();
}

template <typename Work>
void ViewerApp::Try(const Work& work) {
  try {
    work();
  } catch (const InputError& fault) {
    Say(fault.what(), true);
  } catch (const OutputError& fault) {
    Say(fault.what(), true);
  }
}

void ViewerApp::Age(double seconds) {
  for (Message& message : messages_) message.age_s += seconds;
  while (!messages_.empty() && messages_.front().age_s > kMessage_s) messages_.pop_front();
  for (const std::string& note : flight_.edits().TakeNotes()) Say(note);
  constexpr double kMemory = 0.1;
  frame_ms_ += kMemory * (1e3 * seconds - frame_ms_);
}

HudModel ViewerApp::Model() const {
  HudModel model;
  model.flight = FlightOf(flight_);
  model.autopilot = AutopilotOf(flight_.cockpit().pilot());
  model.latitude_rad = flight_.eye().place.latitude_rad;
  model.longitude_rad = flight_.eye().place.longitude_rad;
  model.time = TimeOf(flight_);
  model.sky = SkyOf(flight_);
  model.exposure = ExposureOf(flight_.exposure());
  model.exposure.cursor_luminance_cd_per_m2 = cursor_cd_per_m2_;
  model.air = AirOf(flight_);
  model.speed = {frame_ms_, flight_.frames().QualityText()};
  for (const Message& message : messages_)
    model.messages.push_back({message.text, message.is_warning});
  if (const auto progress = flight_.frames().Progress())
    model.progress = HudProgress{progress->text, progress->share};
  if (const auto picture = pictures_.UnderWay()) model.progress = ProgressOf(*picture);
  model.recording = recorder_.file().has_value();
  model.units = units_;
  return model;
}

HudChoices ViewerApp::Choices() const {
  HudChoices choices;
  for (const Action mode : ModesOf(flight_.cockpit().pilot()))
    choices.modes.emplace_back(RowOf(mode).does);
  for (const SkyEvent event : kSkyEvents) choices.moments.emplace_back(NameOf(event));
  choices.planets = MediumPresetNames();
  choices.tone_curves = kCurves;
  choices.looks = AgxLookNames();
  choices.white_balances = kWhiteBalances;
  choices.qualities = kQualities;
  choices.lamps = {{"landing light", landing_light_}};
  choices.table_heading = {"", "made in", "memory"};
  choices.tables = TablesOf(flight_.frames().Figures());
  return choices;
}

void ViewerApp::WantStrip() {
  if (!hud_.IsOpen(HudPanel::kPlaceAndTime)) return;
  const std::shared_ptr<const SolvedAir>& air = flight_.frames().air();
  const UtcInstant begin = AddSeconds(
      flight_.now(), -kSecondsPerDay * LocalTimeAt(flight_.now(), ZoneOf(flight_)).day_fraction);
  strip_.RequestIfNeeded({std::shared_ptr<const MultipleScattering>(air, &air->multiple_scattering),
                          flight_.eye().place, begin});
  strip_.Update();
}

void ViewerApp::Advance(const WindowEvents& events, const ImageSize& size, double seconds) {
  Age(seconds);
  TellOfPictures();
  WantStrip();
  for (const KeyEvent& key : events.keys) keys_.Note(key.key, key.change != 0);
  if (!events.focused) keys_.Release();
  HudInput input;
  input.width = size.width;
  input.height = size.height;
  input.seconds = seconds;
  if (events.pointer) input.pointer = HudPointer{events.pointer->right, events.pointer->down};
  input.buttons = events.buttons;
  input.wheel = events.wheel;
  input.text = events.text;
  if (size.width > 0 && size.height > 0)
    Serve(hud_.Update(Model(), Choices(), strip_.value() ? &*strip_.value() : nullptr,
                      keys_.Into(input)));
  Tell(events, size.width, size.height, {hud_.WantsMouse(), hud_.WantsKeyboard()}, controls_);
  const Intent intent =
      controls_.Take(flight_.cockpit().pilot().mode(), seconds, GamepadOf(events));
  for (const Action action : intent.actions) Do(action, size);
  for (const Action action : intent.refused)
    Say(fmt::format("{}: not while the window is minimised", RowOf(action).does));
  flight_.Advance(intent.pilot, seconds);
  NoteFlight(seconds);
  const bool on_picture = events.pointer && !hud_.WantsMouse() && hud_.visible();
  if (!on_picture) flight_.frames().LeavePicture();
  cursor_cd_per_m2_ = on_picture ? flight_.frames().LuminanceAt(events.pointer->right / size.width,
                                                                events.pointer->down / size.height)
                                 : std::nullopt;
}

void ViewerApp::Do(Action action, const ImageSize& size) {
  Try([&] {
    if (const auto said = Carry(action, flight_)) {
      if (!said->empty()) Say(*said);
      return;
    }
    switch (action) {
      case Action::kHud:
        hud_.ToggleVisible();
        break;
      case Action::kNightTheme:
        hud_.SetTheme(hud_.theme() == HudTheme::kNight ? HudThemeChoice::kDay
                                                       : HudThemeChoice::kNight);
        break;
      case Action::kPanels:
        hud_.ToggleMenu();
        break;
      case Action::kFullScreen:
        full_screen_ = !full_screen_;
        break;
      case Action::kScreenshot:
        AskForPicture({HudPictureKind::kPng, size.width, size.height, false});
        break;
      case Action::kScreenshotExr:
        AskForPicture({HudPictureKind::kExr, size.width, size.height, false});
        break;
      case Action::kLandingLight:
        SetLandingLight(!landing_light_);
        Say(landing_light_ ? "landing light on" : "landing light off");
        break;
      case Action::kReplay:
        FlyAgain();
        break;
      case Action::kSaveFlight:
        SaveFlight();
        break;
      case Action::kHelp:
        hud_.Toggle(HudPanel::kHelp);
        break;
      case Action::kQuit:
        if (!hud_.ClosePanels()) hud_.Toggle(HudPanel::kLeave);
        break;
      default:
        break;
    }
  });
}

void ViewerApp::AskForPicture(const HudCaptureRequest& asked) {
  const bool is_exr = asked.kind == HudPictureKind::kExr;
  const ImageSize size{asked.width, asked.height};
  std::filesystem::path file = NextScreenshot(".", pictures_.Files());
  file += is_exr ? ".exr" : ".png";
  RequireWritable(file);
  if (!asked.with_hud) return pictures_.Ask({flight_.Moment(), file, size});
  RequireInstruments(file, size);
  pictures_.Ask({flight_.Moment(), file, size,
                 [model = Model(), settings = SettingsOf(hud_)](const Image& developed) {
                   const RenderTarget screen(developed.width, developed.height,
                                             RenderTarget::Depth::kNone);
                   glActiveTexture(GL_TEXTURE0 + kUploadUnit);
                   screen.Write(developed);
                   DrawInstruments(screen, model, settings);
                   return screen.ReadBytes();
                 }});
}

void ViewerApp::TellOfPictures() {
  pictures_.NextFrame();
  for (const PictureOutcome& outcome : pictures_.TakeOutcomes())
    Say(TextOf(outcome), !outcome.fault.empty());
}

void ViewerApp::Leave() {
  if (leaves_) return pictures_.Drop();
  leaves_ = true;
  if (pictures_.UnderWay()) Say("leaving when the pictures are written; leave again to drop them");
}

void ViewerApp::Record(bool records) {
  if (!records) {
    const std::optional<std::filesystem::path> file = recorder_.file();
    const bool is_written = recorder_.Finish();
    if (file)
      Say(fmt::format("{} is {}", file->filename().string(),
                      is_written ? "written" : "not written: nothing was flown"));
    return;
  }
  const std::filesystem::path file = NextFlight(".");
  recorder_.Begin(file);
  Say(fmt::format("recording into {}", file.filename().string()));
}

void ViewerApp::SaveFlight() {
  const CameraPath path = flown_.Path();
  const std::filesystem::path file = NextFlight(".");
  WriteTextAtomically(file, TextOf(path));
  Say(fmt::format("{} is written: {:.0f} s", file.filename().string(), path.end_s()));
}

void ViewerApp::FlyAgain() {
  const CameraPath path = flown_.Path();
  flight_.FlyAgain(path);
  Say(fmt::format("this flight again, {:.0f} s; then it goes on", path.end_s()));
}

void ViewerApp::NoteFlight(double seconds) {
  const bool replays = flight_.cockpit().pilot().Replays();
  if (std::exchange(replays_, replays) && !replays) Say("here the replay ends");
  elapsed_s_ += seconds;
  flown_s_ += replays ? 0.0 : seconds;
  // The renderer cannot render points inside the ground.
  if (!flight_.standpoint().KnowsGround()) return;
  recorder_.Note(elapsed_s_, flight_.eye(), flight_.now());
  if (!replays) flown_.Note(flown_s_, flight_.eye(), flight_.now());
}

void ViewerApp::ServeTime(const HudTimeRequest& asked) {
  SceneClock& clock = flight_.cockpit().clock();
  if (asked.instant) clock.Type(*asked.instant, flight_.eye().place, ZoneOf(flight_));
  if (asked.day_fraction) {
    clock.Shift(kSecondsPerDay *
                (*asked.day_fraction - LocalTimeAt(clock.now(), ZoneOf(flight_)).day_fraction));
  }
  if (asked.rate) clock.SetRate(*asked.rate);
  if (asked.paused) clock.Pause(*asked.paused);
  for (const SkyEvent event : kSkyEvents) {
    if (asked.moment == NameOf(event)) Say(flight_.cockpit().JumpTo(event));
  }
}

void ViewerApp::ServeAir(const HudAirRequest& asked) {
  SceneEdits& edits = flight_.edits();
  const GeodeticPosition& place = flight_.eye().place;
  if (asked.planet) edits.UsePlanet(*asked.planet, place);
  AirChoice choice = edits.air_choice();
  if (asked.visibility_km)
    choice.aerosol = AerosolForVisibility(edits.planet(), 1e3 * *asked.visibility_km);
  if (asked.aerosol_scale) choice.aerosol = *asked.aerosol_scale;
  if (asked.ozone_du) choice.ozone_du = asked.ozone_du;
  if (asked.ground_albedo) choice.ground_albedo = asked.ground_albedo;
  if (asked.visibility_km || asked.aerosol_scale || asked.ozone_du || asked.ground_albedo)
    edits.Use(choice, place);
}

void ViewerApp::ServeLook(const HudRequest& asked) {
  Look look = flight_.exposure().look();
  if (asked.tone_curve) look.curve = ToneCurveFromName(*asked.tone_curve);
  if (asked.look) look.agx = AgxLookFromName(*asked.look);
  if (asked.white_balance) look.white = WhiteBalanceFromText(*asked.white_balance);
  if (look != flight_.exposure().look()) flight_.exposure().Use(look);
}

void ViewerApp::ServeFlight(const HudRequest& asked) {
  Pilot& pilot = flight_.cockpit().pilot();
  for (const Action mode : ModesOf(pilot)) {
    if (asked.mode == RowOf(mode).does) Say(Carry(mode, flight_).value_or(""));
  }
  PilotedAircraft* aircraft = pilot.aircraft();
  if (aircraft == nullptr) return;
  if (asked.throttle) aircraft->SetThrottle(*asked.throttle);
  AutopilotTargets targets = aircraft->autopilot().targets();
  if (asked.hold_heading_rad) targets.heading_rad = asked.hold_heading_rad->value;
  if (asked.hold_height_m) targets.height_m = asked.hold_height_m->value;
  if (asked.hold_speed_m_per_s) targets.speed_m_per_s = asked.hold_speed_m_per_s->value;
  if (asked.hold_heading_rad || asked.hold_height_m || asked.hold_speed_m_per_s)
    aircraft->autopilot().Set(targets);
}

void ViewerApp::SetLandingLight(bool is_on) {
  landing_light_ = is_on;
  flight_.frames().SetLandingLight(is_on);
}

void ViewerApp::Serve(const HudRequest& asked) {
  Try([&] {
    if (asked.place) {
      flight_.standpoint().Place(
          {asked.place->latitude_deg, asked.place->longitude_deg, asked.place->height_m, {}, {}});
    }
    if (asked.named_place) flight_.standpoint().GoTo(*asked.named_place);
    if (asked.place || asked.named_place) flight_.standpoint().AwaitGround();
    ServeTime(asked.time);
    ServeAir(asked.air);
    if (asked.lamp) SetLandingLight(asked.lamp->is_on);
    ServeLook(asked);
    if (asked.exposure_locked) flight_.exposure().Lock(*asked.exposure_locked);
    if (asked.ev100) flight_.exposure().Set(*asked.ev100);
    if (asked.compensation_ev) flight_.exposure().Compensate(*asked.compensation_ev);
    if (asked.quality) flight_.frames().Use(QualityRuleFromText(*asked.quality));
    ServeFlight(asked);
    if (asked.units) units_ = *asked.units;
    if (asked.capture) AskForPicture(*asked.capture);
    if (asked.record) Record(*asked.record);
    if (asked.quit) Leave();
  });
}

void ViewerApp::WritePicture(const std::filesystem::path& file, const ImageSize& size) {
  RequireInstruments(file, size);
  const RenderTarget screen(size.width, size.height, RenderTarget::Depth::kNone);
  const Metadata header =
      PictureWriter(flight_).PaintStill({screen.framebuffer(), size.width, size.height});
  DrawInstruments(screen, Model(), SettingsOf(hud_));
  WritePng(file, screen.ReadBytes(), header);
}

void ViewerApp::Paint(const ToneMapPass::Screen& screen, double seconds) {
  flight_.Paint(screen, seconds);
  const TimedPass timed(flight_.frames().timer(), "hud");
  hud_.Paint(screen.framebuffer);
}

}  // namespace alpenglow::viewer
