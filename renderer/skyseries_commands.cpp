// SPDX-License-Identifier: MIT
#include "renderer/skyseries_commands.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/astronomy/moon.h"
#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/medium.h"
#include "lut/cli/messages.h"
#include "lut/cli/output_file.h"
#include "lut/cli/outputs.h"
#include "lut/cli/program.h"
#include "lut/cli/terminal.h"
#include "lut/image/look.h"
#include "lut/report/report_pages.h"
#include "renderer/picture/render.h"
#include "renderer/report/report.h"
#include "renderer/scene/places.h"
#include "renderer/scene/scene.h"
#include "renderer/scene/scene_options.h"
#include "renderer/series/day_plot.h"
#include "renderer/series/day_times.h"

namespace alpenglow::renderer {
namespace {

struct PictureReportOptions {
  CommonOptions common;
  std::optional<std::string> atmosphere;
  std::string out;
  bool quick = false;
};

void WriteMeasuredReport(const PictureReportOptions& options) {
  const ThreadLimit threads(options.common.threads);
  const Report report =
      MeasurePictureReport({.mediums = MediumsOfReport(options.atmosphere, options.quick),
                            .quick = options.quick,
                            .progress = options.common.progress_style()});
  WriteReport(report, options.out);
  if (!options.common.quiet) Print(SummaryOf(report));
}

struct TimesOptions {
  CommonOptions common;
  std::optional<std::string> scene_file, place, zone, out;
  std::optional<double> latitude_deg, longitude_deg;
  double height_m = 0.0;
  std::string date = "today";
  int days = 1;
  std::optional<std::string> plot;
  double every_min = 30.0;
};

/// Returns the place on the ellipsoid.
Place PlaceOf(const TimesOptions& options) {
  if (!options.place) return CheckedPlace({*options.latitude_deg, *options.longitude_deg, 0.0});
  Place place = PlaceNamed(*options.place).place;
  place.height_m = 0.0;
  return place;
}

/// Returns the scene, or a place without terrain.
Scene SceneOf(const TimesOptions& options) {
  if (options.scene_file) return ReadScene(*options.scene_file);
  Scene scene;
  scene.place = PlaceOf(options);
  if (options.place) scene.zone = PlaceNamed(*options.place).zone;
  scene.camera.height = {std::max(options.height_m, 0.0), false};
  scene.medium = MediumPreset("earth");
  scene.terrain.kind = TerrainSource::Kind::kNone;
  return scene;
}

/// Returns the place and the first day.
EventDay FirstDayOf(const TimesOptions& options, const Scene& scene) {
  EventDay day{scene.place, options.zone ? options.zone : scene.zone, {}};
  if (!options.scene_file) day.place.height_m = options.height_m;
  day.around = DayFromText(options.date, day);
  return day;
}

/// Plots from the first noon on, by day and by night.
void WritePlot(const TimesOptions& options, const Scene& scene, const EventDay& first) {
  const SceneRenderer renderer(scene);
  const double span_s = kSecondsPerDay * options.days, step_s = 60.0 * options.every_min;
  std::vector<PlottedMoment> moments;
  for (double at_s = 0.0; at_s <= span_s; at_s += step_s) {
    ThrowIfInterrupted();
    const UtcTime instant = AddSeconds(*first.around, at_s);
    const double lux = renderer.Illuminance(instant);
    moments.push_back({instant, TrueSunAt(first.place, instant).elevation_deg,
                       TrueMoonAt(first.place, instant).elevation_deg, lux, IncidentEv100(lux)});
  }
  WriteTextAtomically(
      *options.plot, SvgOfDay(moments, {options.place.value_or(PlaceText(first.place)), first.zone},
                              PublishedLightLevels()));
}

void PrepareOutputsOf(const TimesOptions& options, const Scene& scene) {
  std::vector<NamedFile> inputs = FilesOf(scene), outputs;
  if (options.scene_file) inputs.push_back({"the scene", *options.scene_file});
  if (options.out) outputs.push_back({"--out", *options.out});
  if (options.plot) outputs.push_back({"--plot", *options.plot});
  PrepareOutputs(outputs, inputs);
}

void WriteTimes(const TimesOptions& options) {
  const ThreadLimit threads(options.common.threads);
  const Scene scene = SceneOf(options);
  const EventDay first = FirstDayOf(options, scene);
  PrepareOutputsOf(options, scene);
  if (options.out) {
    std::string csv = HeaderOfTimesCsv();
    VisitTimesOfDays(first, options.days, [&](const DayTimes& day) { csv += CsvLineOf(day); });
    WriteTextAtomically(*options.out, csv);
  } else {
    PrintNow(HeadOfTable(first.zone));
    VisitTimesOfDays(first, options.days,
                     [&](const DayTimes& day) { PrintNow(LinesOf(day, first.zone)); });
  }
  if (options.plot) WritePlot(options, scene, first);
}

void AddTimesOutput(CLI::App& times, TimesOptions& options) {
  BeginGroup(times, kOutputGroup);
  times.add_option("--out", options.out, "CSV file with UTC instants, instead of a table")
      ->check([](const std::string& name) { return FaultOfFileName(name, ".csv"); });
  CLI::Option* plot =
      times
          .add_option(
              "--plot", options.plot,
              "SVG of sun, moon and light on level ground from the first noon, next to published "
              "light levels, for the air of the scene or for clear air")
          ->check([](const std::string& name) { return FaultOfFileName(name, ".svg"); });
  times
      .add_option("--minutes", options.every_min,
                  "Time in minutes between points of the plot, 1 to 1440")
      ->check(InRange(1.0, 1440.0))
      ->needs(plot)
      ->capture_default_str();
}

}  // namespace

std::function<void()> AddPictureReportCommand(CLI::App& app) {
  const auto options = std::make_shared<PictureReportOptions>();
  CLI::App& report = *app.add_subcommand(
      "report",
      "Compare the air in front of mountains, shafts, lamps and whole pictures with slow reference "
      "solutions, and plot error over time. The report has CSV files, SVG plots, summary.md and a "
      "page, index.html.");
  report.preparse_callback([&app](std::size_t) { app.get_option("--out")->required(false); });
  BeginGroup(report, kAirGroup);
  report.add_option("--atmosphere", options->atmosphere,
                    "Atmosphere file (TOML) of the air in front of mountains (default: the presets "
                    "earth and hazy)");
  BeginGroup(report, kOutputGroup);
  report.add_option("--out", options->out, "Folder for the report; it is created if necessary")
      ->check(FaultOfFolderName)
      ->required();
  report.add_flag("--quick", options->quick,
                  "Use few rays and small pictures, to test the report and not the methods");
  AddCommonOptions(report, "skyseries", options->common);
  report.footer("Example: skyseries report --out report");
  return [options] { WriteMeasuredReport(*options); };
}

std::function<void()> AddTimesCommand(CLI::App& app) {
  const auto options = std::make_shared<TimesOptions>();
  CLI::App& times = *app.add_subcommand(
      "times", "Print when sun and moon rise, culminate and set at a place, and the twilights.");
  times.preparse_callback([&app](std::size_t) { app.get_option("--out")->required(false); });
  BeginGroup(times, kPlaceGroup);
  CLI::Option* file = times.add_option("SCENE", options->scene_file, "Scene file (TOML)");
  CLI::Option* latitude =
      times.add_option("--latitude", options->latitude_deg, "Degrees north, -90 to 90")
          ->check(InRange(-90.0, 90.0))
          ->excludes(file);
  CLI::Option* place =
      times
          .add_option(
              "--place", options->place,
              "Airport, peak or city by name or code: LSZH, \"Mont Blanc\". Its time zone is "
              "the default of --zone")
          ->excludes(file)
          ->excludes(latitude);
  times.add_option("--longitude", options->longitude_deg, "Degrees east, -180 to 360")
      ->check(InRange(-180.0, 360.0))
      ->needs(latitude);
  latitude->needs("--longitude");
  times.parse_complete_callback([file, latitude, place] {
    if (!*file && !*latitude && !*place)
      throw CLI::RequiresError("times", "SCENE, --place, or --latitude");
  });
  times
      .add_option(
          "--height,--altitude", options->height_m,
          "Height in metres above the ellipsoid, -12000 to 1e9. The horizon of a high place is "
          "lower. The events of skyseries --at are those of height 0")
      ->check(InRange(-12000.0, 1e9))
      ->excludes(file)
      ->capture_default_str();
  BeginGroup(times, kTimeGroup);
  times.add_option(
      "--zone", options->zone,
      "IANA zone of days and times (default: zone of the scene; without a zone, days are "
      "those of the meridian, and times are UTC)");
  times.add_option("--date", options->date, "First day: 2026-06-21, today, tomorrow, yesterday")
      ->capture_default_str();
  times.add_option("--days", options->days, "Number of days, 1 to 3660")
      ->check(InRange(1, 3660))
      ->capture_default_str();
  AddTimesOutput(times, *options);
  AddCommonOptions(times, "skyseries", options->common);
  times.footer(
      "Example: the week in Zermatt\n"
      "  skyseries times --place Zermatt --days 7\n"
      "Example: a year on Mount Fuji\n"
      "  skyseries times --latitude 35.36 --longitude 138.73 --zone Asia/Tokyo --date 2026-01-01 "
      "--days 365 --out fuji.csv\n"
      "Example: the light of a month of nights\n"
      "  skyseries times --latitude 35.36 --longitude 138.73 --zone Asia/Tokyo --days 30 --plot "
      "month.svg");
  return [options] { WriteTimes(*options); };
}

}  // namespace alpenglow::renderer
