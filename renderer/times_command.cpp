// SPDX-License-Identifier: MIT
#include "renderer/times_command.h"

#include <memory>
#include <optional>
#include <string>

#include "lut/program/atomic_file.h"
#include "lut/program/messages.h"
#include "lut/program/output_name.h"
#include "renderer/scene/scene.h"
#include "renderer/series/day_times.h"

namespace alpenglow {
namespace {

struct TimesOptions {
  CommonOptions common;
  std::optional<std::string> scene_file, zone, out;
  std::optional<double> latitude_deg, longitude_deg;
  double height_m = 0.0;
  std::string date = "today";
  int days = 1;
};

/// The place and the first day.
EventDay FirstDayOf(const TimesOptions& options) {
  EventDay day;
  if (options.scene_file) {
    const Scene scene = ReadScene(*options.scene_file);
    day.place = scene.place;
    day.zone = scene.zone;
  } else {
    day.place = PlaceFromDegrees(*options.latitude_deg, *options.longitude_deg, options.height_m);
  }
  if (options.zone) day.zone = options.zone;
  day.around = DayFromText(options.date, day);
  return day;
}

void WriteTimes(const TimesOptions& options) {
  const EventDay first = FirstDayOf(options);
  const std::vector<DayTimes> days = TimesOfDays(first, options.days);
  if (options.out) {
    WriteTextAtomically(*options.out, CsvOf(days));
  } else {
    Print(TableOf(days, first.zone));
  }
}

}  // namespace

std::function<void()> AddTimesCommand(CLI::App& app) {
  const auto options = std::make_shared<TimesOptions>();
  CLI::App& times = *app.add_subcommand(
      "times", "Print when sun and moon rise, culminate and set at a place, and the twilights.");
  times.preparse_callback([&app](std::size_t) { app.get_option("--out")->required(false); });
  CLI::Option* file = times.add_option("SCENE", options->scene_file, "Scene file (TOML)");
  CLI::Option* latitude = times.add_option("--latitude", options->latitude_deg, "Degrees north")
                              ->check(CLI::Range(-90.0, 90.0))
                              ->excludes(file);
  times.add_option("--longitude", options->longitude_deg, "Degrees east")
      ->check(CLI::Range(-180.0, 360.0))
      ->needs(latitude);
  latitude->needs("--longitude");
  times.parse_complete_callback([file, latitude] {
    if (!*file && !*latitude) throw CLI::RequiresError("times", "SCENE, or --latitude");
  });
  times
      .add_option("--height", options->height_m,
                  "Metres above the ellipsoid; from high places the horizon is lower")
      ->check(CLI::Range(-12000.0, 1e9))
      ->excludes(file)
      ->capture_default_str();
  times.add_option("--zone", options->zone,
                   "IANA zone of days and times (default: the scene's; without one the days are "
                   "those of the meridian, and the times UTC)");
  times.add_option("--date", options->date, "First day: 2026-06-21, today, tomorrow, yesterday")
      ->capture_default_str();
  times.add_option("--days", options->days, "Number of days, 1 to 3660")
      ->check(CLI::Range(1, 3660))
      ->capture_default_str();
  times.add_option("--out", options->out, "CSV file, with instants of UTC, instead of a table")
      ->check([](const std::string& name) { return FaultOfFileName(name, ".csv"); });
  AddCommonOptions(times, "skyseries", options->common);
  times.footer(
      "Example: a year on Mount Fuji\n"
      "  skyseries times --latitude 35.36 --longitude 138.73 --zone Asia/Tokyo --date 2026-01-01 "
      "--days 365 --out fuji.csv");
  return [options] { WriteTimes(*options); };
}

}  // namespace alpenglow
