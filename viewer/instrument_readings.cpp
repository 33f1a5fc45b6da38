// SPDX-License-Identifier: MIT
#include "viewer/instrument_readings.h"

#include <fmt/format.h>

#include <algorithm>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/refraction/refracted_view.h"
#include "lut/sky/sky_view_map.h"
#include "renderer/scene/places.h"

namespace alpenglow::viewer {
namespace {

HudFlight FlightOf(FlightSession& flight) {
  const CameraPose& eye = flight.eye();
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
      SkyViewMap(OnOsculatingSphere(flight.edits().planet(), eye.place.latitude_rad), height_m, 1.0)
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
  model.latitude_rad = flight.eye().place.latitude_rad;
  model.longitude_rad = flight.eye().place.longitude_rad;
  model.time = TimeOf(flight);
  model.sky = SkyOf(flight);
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
