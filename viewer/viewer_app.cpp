// SPDX-License-Identifier: MIT
#include "viewer/viewer_app.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/refraction/refracted_view.h"
#include "lut/cli/messages.h"
#include "lut/cli/output_file.h"
#include "lut/image/picture_format.h"
#include "lut/sky/sky_view_map.h"
#include "renderer/scene/places.h"
#include "viewer/gl/render_target.h"
#include "viewer/passes/picture_programs.h"
#include "viewer/picture_name.h"
#include "viewer/picture_writer.h"

namespace alpenglow::viewer {
namespace {

constexpr double kMessage_s = 8.0;

HudSettings SettingsOf(const Hud& hud) {
  return {.scale = hud.scale(), .preferences = hud.preferences()};
}

// Draws the instruments with a second Hud. The Hud of the window keeps its panels unchanged, and
// none of them appears in the picture.
void DrawInstruments(const RenderTarget& screen, const HudModel& model, const HudSettings& settings,
                     FlightCommands& flight) {
  Hud instruments(settings);
  instruments.Update(model, nullptr, {.size = {screen.width(), screen.height()}}, flight);
  instruments.Paint(screen.framebuffer());
}

void RequireInstruments(const std::filesystem::path& file, const ImageSize& size) {
  if (FormatOfPicture(file).StoresLight())
    throw InputError(fmt::format("\"{}\": only a {} has instruments (--hud on)", file.string(),
                                 NamesOfDevelopedFormats()));
  RequireDrawable(size.width, size.height);
}

HudProgress ProgressOf(const PictureUnderWay& picture) {
  const std::string name = picture.file.filename().string();
  if (picture.waiting == 0) return {fmt::format("Picture {}:", name), picture.share};
  return {fmt::format("Picture {} ({} more to come):", name, picture.waiting), picture.share};
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
  ReportOutcomesAtEnd();
}

void ViewerApp::FinishWithoutWindow() {
  pictures_.FinishWithoutWindow();
  ReportOutcomesAtEnd();
}

void ViewerApp::ReportOutcomesAtEnd() {
  for (const PictureOutcome& outcome : pictures_.PollOutcomes())
    lut::Log(fmt::format("skyview: {}\n", TextOf(outcome)));
}

void ViewerApp::Display(const std::string& text, bool is_warning) {
  constexpr std::size_t kMost = 6;
  messages_.push_back({text, 0.0, is_warning});
  if (messages_.size() > kMost) messages_.pop_front();
}

void ViewerApp::Report(const std::string& message) {
  if (!message.empty()) Display(message);
}

template <typename Work>
void ViewerApp::Try(const Work& work) {
  try {
    work();
  } catch (const InputError& fault) {
    Display(fault.what(), true);
  } catch (const OutputError& fault) {
    Display(fault.what(), true);
  }
}

void ViewerApp::Age(double seconds) {
  for (Message& message : messages_) message.age_s += seconds;
  while (!messages_.empty() && messages_.front().age_s > kMessage_s) messages_.pop_front();
  for (const std::string& note : flight_.edits().PollNotes()) Report(note);
  constexpr double kMemory = 0.1;
  frame_ms_ += kMemory * (1e3 * seconds - frame_ms_);
}

HudModel ViewerApp::Model() const {
  HudModel model = ReadInstruments(flight_);
  model.exposure.cursor_luminance_cd_per_m2 = cursor_cd_per_m2_;
  model.speed.frame_ms = frame_ms_;
  for (const Message& message : messages_)
    model.messages.push_back({message.text, message.is_warning});
  if (const auto picture = pictures_.UnderWay()) model.progress = ProgressOf(*picture);
  model.recording = recorder_.file().has_value();
  model.units = hud_.preferences().units;
  return model;
}

void ViewerApp::WantStrip() {
  if (!hud_.IsOpen(HudPanel::kPlaceAndTime)) return;
  const std::shared_ptr<const SolvedAir> air = flight_.frames().air();
  const UtcTime begin = AddSeconds(
      flight_.now(), -kSecondsPerDay * LocalTimeAt(flight_.now(), flight_.zone()).day_fraction);
  strip_.RequestIfNeeded(
      {std::shared_ptr<const MultipleScattering>(air, &air->multiple_scattering()),
       flight_.eye().place, begin});
  strip_.Update();
}

void ViewerApp::Advance(const InputFrame& input) {
  size_ = input.size;
  Age(input.seconds);
  ReportPictures();
  WantStrip();
  hud_.Update(Model(), strip_.value() ? &*strip_.value() : nullptr, input, *this);
  const Intent intent =
      controls_.Interpret(input, flight_.controller().pilot().mode(), hud_.Taken());
  for (const Action* action : intent.actions) Try([&] { action->run(*this); });
  for (const Action* action : intent.refused)
    Report(fmt::format("{}: not while the window is minimised", action->help));
  flight_.Advance(intent.pilot, input.seconds);
  RecordFlight(input.seconds);
  ReadLuminance(input);
}

void ViewerApp::ReadLuminance(const InputFrame& input) {
  const std::optional<PointerPlace>& pointer = input.events.pointer;
  const bool on_picture = pointer && !hud_.Taken().mouse && hud_.visible();
  if (!on_picture) flight_.frames().LeavePicture();
  cursor_cd_per_m2_ = on_picture ? flight_.frames().LuminanceAt(pointer->right / input.size.width,
                                                                pointer->down / input.size.height)
                                 : std::nullopt;
}

void ViewerApp::Use(const QualityRule& rule) {
  flight_.frames().Use(rule);
  Report("quality " + flight_.frames().QualityText());
}

void ViewerApp::Use(const std::vector<SceneCloud>& clouds) {
  Try([&] { flight_.edits().Use(clouds); });
}

void ViewerApp::UsePlanet(const std::string& preset) {
  Try([&] { flight_.edits().UsePlanet(preset, flight_.eye().place); });
}

void ViewerApp::Use(const AirChoice& choice) {
  Try([&] { flight_.edits().Use(choice, flight_.eye().place); });
}

void ViewerApp::ToggleLandingLight() {
  const bool is_on = !flight_.frames().has_landing_light();
  flight_.frames().SetLandingLight(is_on);
  Report(is_on ? "landing light on" : "landing light off");
}

void ViewerApp::MoveTo(const EyePlacement& placement) {
  Try([&] {
    flight_.standpoint().MoveTo(placement);
    flight_.standpoint().AwaitGround();
  });
}

void ViewerApp::GoTo(const std::string& place) {
  Try([&] {
    flight_.standpoint().GoTo(place);
    flight_.standpoint().AwaitGround();
  });
}

void ViewerApp::SetTime(const std::string& text) {
  Try([&] { flight_.controller().clock().Type(text, flight_.eye().place, flight_.zone()); });
}

void ViewerApp::Switch(WindowPart part) {
  switch (part) {
    case WindowPart::kInstruments:
      return hud_.ToggleVisible();
    case WindowPart::kNightColours:
      return hud_.SetTheme(hud_.theme() == HudTheme::kNight ? HudThemeChoice::kDay
                                                            : HudThemeChoice::kNight);
    case WindowPart::kMenu:
      return hud_.ToggleMenu();
    case WindowPart::kFullScreen:
      full_screen_ = !full_screen_;
      return;
    case WindowPart::kHelp:
      return hud_.Toggle(HudPanel::kHelp);
    case WindowPart::kLeaveQuestion:
      if (!hud_.ClosePanels()) hud_.Toggle(HudPanel::kLeave);
      return;
    case WindowPart::kMouseMode:
      return controls_.NextMouseMode();
  }
}

void ViewerApp::Request(const PictureOrder& picture) {
  Try([&] {
    const ImageSize size = picture.size.value_or(size_);
    std::filesystem::path file = NextScreenshot(".", pictures_.Files());
    file += picture.extension;
    RequireWritable(file);
    PictureRequest request{flight_.Moment(), file, size};
    if (picture.with_instruments) {
      RequireInstruments(file, size);
      request.instruments = Instruments();
    }
    pictures_.Request(std::move(request));
  });
}

std::function<DisplayImage(const HdrImage&)> ViewerApp::Instruments() {
  return [this, model = Model(), settings = SettingsOf(hud_)](const HdrImage& developed) {
    const RenderTarget screen(developed.width, developed.height, RenderTarget::Depth::kNone);
    glActiveTexture(GL_TEXTURE0 + kUploadUnit);
    screen.Write(developed);
    DrawInstruments(screen, model, settings, *this);
    return screen.ReadBytes();
  };
}

void ViewerApp::ReportPictures() {
  pictures_.NextFrame();
  for (const PictureOutcome& outcome : pictures_.PollOutcomes())
    Display(TextOf(outcome), !outcome.fault.empty());
}

void ViewerApp::Leave() {
  if (leaves_) return pictures_.Drop();
  leaves_ = true;
  if (pictures_.UnderWay())
    Report("leaving when the pictures are written; leave again to drop them");
}

void ViewerApp::Record(bool records) {
  Try([&] {
    if (records) {
      const std::filesystem::path file = NextFlight(".");
      recorder_.Begin(file);
      return Report(fmt::format("recording into {}", file.filename().string()));
    }
    const std::optional<std::filesystem::path> file = recorder_.file();
    const bool is_written = recorder_.Finish();
    if (file)
      Report(fmt::format("{} is {}", file->filename().string(),
                         is_written ? "written" : "not written: nothing was flown"));
  });
}

void ViewerApp::Use(FlightSoFar use) {
  if (use == FlightSoFar::kSave) {
    SaveFlight();
  } else {
    FlyAgain();
  }
}

void ViewerApp::SaveFlight() {
  Try([&] {
    const CameraPath path = flown_.Path();
    const std::filesystem::path file = NextFlight(".");
    WriteTextAtomically(file, TextOf(path));
    Report(fmt::format("{} is written: {:.0f} s", file.filename().string(), path.end_s()));
  });
}

void ViewerApp::FlyAgain() {
  Try([&] {
    const CameraPath path = flown_.Path();
    flight_.FlyAgain(path);
    Report(fmt::format("this flight again, {:.0f} s; then it goes on", path.end_s()));
  });
}

void ViewerApp::RecordFlight(double seconds) {
  const bool replays = flight_.controller().pilot().Replays();
  if (std::exchange(replays_, replays) && !replays) Report("the replay ends here");
  elapsed_s_ += seconds;
  flown_s_ += replays ? 0.0 : seconds;
  // The renderer cannot render points inside the ground.
  if (!flight_.standpoint().KnowsGround()) return;
  recorder_.Record(elapsed_s_, flight_.eye(), flight_.now());
  if (!replays) flown_.Record(flown_s_, flight_.eye(), flight_.now());
}

void ViewerApp::WritePicture(const std::filesystem::path& file, const ImageSize& size) {
  RequireInstruments(file, size);
  const RenderTarget screen(size.width, size.height, RenderTarget::Depth::kNone);
  const Metadata header =
      PictureWriter(flight_).PaintStill({screen.framebuffer(), size.width, size.height});
  DrawInstruments(screen, Model(), SettingsOf(hud_), *this);
  FormatOfPicture(file).write_colours(file, screen.ReadBytes(), header);
}

void ViewerApp::Paint(const ToneMapPass::Screen& screen, double seconds) {
  flight_.Paint(screen, seconds);
  const TimedPass timed(flight_.frames().timer(), "hud");
  hud_.Paint(screen.framebuffer);
}

namespace {

HudFlight FlightOf(FlightSession& flight) {
  const CameraPose eye = InWindow(flight.eye());
  const FlightReadout readout = flight.controller().pilot().Readout(flight.controller().ground());
  HudFlight shown;
  shown.mode = readout.aircraft ? std::string(readout.aircraft_name) : NameOf(readout.mode);
  if (flight.controller().pilot().Replays()) shown.mode = "replay";
  shown.heading_rad = eye.heading_rad;
  shown.pitch_rad = eye.pitch_rad;
  shown.roll_rad = eye.roll_rad;
  shown.fov_rad = eye.fov_rad;
  const double height_m = std::max(eye.place.height_m, 0.0);
  shown.horizon_dip_rad =
      SkyViewMap(OnOsculatingSphere(flight.edits().planet(), eye.place.latitude_rad()), height_m,
                 1.0)
          .horizon_zenith_angle_rad() -
      0.5 * kPi;
  shown.ground_speed_m_per_s = readout.speed_m_per_s;
  shown.height_m = eye.place.height_m;
  shown.above_ground_m = readout.above_ground_m;
  shown.climb_m_per_s = readout.vertical_speed_m_per_s;
  shown.path = readout.course;
  if (!readout.aircraft) return shown;
  shown.air_speed_m_per_s = readout.aircraft->indicated_m_per_s;
  shown.throttle = readout.aircraft->throttle;
  shown.load_factor = readout.aircraft->load;
  shown.stall = readout.aircraft->stalled;
  return shown;
}

HudTime TimeOf(FlightSession& flight) {
  const SceneClock& clock = flight.controller().clock();
  const LocalTime local = LocalTimeAt(clock.now(), flight.zone());
  HudTime time;
  time.utc = FormatUtc(clock.now());
  time.local = local.time;
  time.zone = local.zone;
  time.day_fraction = local.day_fraction;
  time.rate = clock.rate();
  time.paused = clock.paused();
  return time;
}

HudSky SkyOf(const FrameSky& sky) {
  HudSky shown{sky.sun.azimuth_rad(), sky.sun.elevation_rad()};
  if (!sky.moon) return shown;
  shown.moon = HudMoon{sky.bodies.moon.azimuth_rad(),
                       std::asin(std::clamp(sky.moon->direction.seen.z, -1.0, 1.0)),
                       sky.bodies.moon.illuminated_fraction};
  return shown;
}

HudAir AirOf(FlightSession& flight) {
  const Medium& planet = flight.edits().planet();
  const Medium air = Changed(planet, flight.edits().air_choice());
  HudAir shown;
  shown.planet = planet.name;
  shown.visibility_km = std::min(1e-3 * VisibilityOf(air), 1e4);
  const Place& place = flight.eye().place;
  const double per_m = flight.frames().ExtinctionAt(place, flight.now());
  shown.visibility_here_km = std::min(1e-3 * VisibilityAt(air, place.height_m, per_m), 1e4);
  shown.aerosol_scale = flight.edits().air_choice().aerosol;
  shown.ozone_du = OzoneDobson(air);
  double albedo = 0.0;
  for (const double value : air.ground_albedo) albedo += value;
  shown.ground_albedo = albedo / static_cast<double>(air.ground_albedo.size());
  return shown;
}

HudExposure ExposureOf(const ExposureControl& control) {
  const FlightExposure& exposure = control.exposure();
  HudExposure shown;
  shown.ev100 = exposure.ev100.value_or(15.0);
  shown.locked = exposure.locked;
  shown.compensation_ev = exposure.compensation_ev;
  return shown;
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

}  // namespace

HudModel ReadInstruments(FlightSession& flight) {
  HudModel model;
  model.flight = FlightOf(flight);
  if (const PilotedAircraft* aircraft = flight.controller().pilot().aircraft())
    model.autopilot = aircraft->autopilot().targets();
  model.latitude_deg = flight.eye().place.latitude_deg;
  model.longitude_deg = flight.eye().place.longitude_deg;
  model.time = TimeOf(flight);
  model.sky = SkyOf(*flight.frames().SkyAt(flight.eye().place, flight.now()));
  model.exposure = ExposureOf(flight.exposure());
  model.air = AirOf(flight);
  model.landing_light = flight.frames().has_landing_light();
  model.speed.quality = flight.frames().QualityText();
  if (const auto progress = flight.frames().Progress())
    model.progress = HudProgress{progress->text, progress->share};
  model.tables = TablesOf(flight.frames().Figures());
  return model;
}

}  // namespace alpenglow::viewer
