// SPDX-License-Identifier: MIT
#include "lut/table_commands.h"

#include <alpenglow/tables.h>
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>

#include "atmosphere/medium/aerosol_mixture.h"
#include "atmosphere/medium/medium.h"
#include "atmosphere/medium/medium_presets.h"
#include "lut/cli/metar_air.h"
#include "lut/cli/metar_option.h"
#include "lut/cli/output_file.h"
#include "lut/evaluate/eval.h"
#include "lut/report/report.h"
#include "lut/report/report_pages.h"
#include "lut/report/report_scattering.h"
#include "lut/table_io/exchange_tables.h"
#include "lut/table_io/table_folder.h"
#include "lut/table_search/table_search.h"

namespace alpenglow::lut {
namespace {

struct BuildOptions {
  std::optional<std::string> atmosphere, metar;
  std::string out;
  bool single_scattering_only = false;
  std::string quality = "standard";
  std::string tables = "smallest";
  std::string layout = "native";
  std::optional<std::string> type, format, max_error;
  std::optional<int> lowest_sun_deg;
};

/// Returns the options of the table layout of another program (Bruneton or takram), if one is
/// requested.
std::optional<ExportOptions> ExchangeOf(const BuildOptions& options) {
  if (options.layout == "native") return std::nullopt;
  ExportOptions exchange;
  exchange.user = TableUserFromName(options.layout);
  if (options.type) exchange.type = TexelTypeFromName(*options.type);
  if (options.format) exchange.format = TexelFormatFromName(*options.format);
  exchange.lowest_sun_deg = options.lowest_sun_deg;
  return exchange;
}

/// Checks option rules that CLI11 cannot express: options that contradict each other.
void CheckLayout(const BuildOptions& options) {
  if (const auto exchange = ExchangeOf(options)) {
    if (options.single_scattering_only) {
      throw CLI::ValidationError("--single-scattering-only", "needs --layout native");
    }
    if (const auto fault = FaultOf(*exchange)) throw CLI::ValidationError("--layout", *fault);
    return;
  }
  if (options.type.value_or("float") != "float") {
    throw CLI::ValidationError("--type", "layout native is float");
  }
  if (options.format.value_or("exr") != "exr") {
    throw CLI::ValidationError("--format", "layout native is exr");
  }
  if (options.lowest_sun_deg) {
    throw CLI::ValidationError("--lowest-sun", "needs --layout bruneton or takram");
  }
}

/// Throws if the atmosphere file is the file `name` in the output folder, which would be
/// overwritten.
void RequireAtmosphereElsewhere(const BuildOptions& options, const char* name) {
  if (!options.atmosphere) return;
  RequireNoInput({"--out", std::filesystem::path(options.out) / name},
                 {{"--atmosphere", *options.atmosphere}});
}

/// Returns the air of the options, by default a preset.
Atmosphere AirOf(const BuildOptions& options, const char* preset) {
  return Atmosphere(
      InTypedAir(MediumFromChoice(options.atmosphere.value_or(preset), kForLight), options.metar));
}

/// Writes a warning about media whose aerosol has a tabulated phase function. The exported tables
/// hold no phase functions, and the programs that load them use a single lobe.
void WarnOfLobe(const Medium& medium) {
  if (medium.mie_phase.front().kind != PhaseKind::kTable) return;
  const std::size_t middle = medium.wavelengths_nm.size() / 2;
  Warn(fmt::format(
      "the aerosol of {} has a tabulated phase function, and these programs have one lobe of "
      "Cornette and Shanks; with g = {:.3f} it has the same mean cosine at {:g} nm, but no aureole",
      medium.name, CornetteShanksG(MeanCosine(MiePhase(medium, middle))),
      medium.wavelengths_nm[middle]));
}

void BuildExchangeTables(const BuildOptions& options, const ExportOptions& exchange,
                         const CommonOptions& common) {
  RequireAtmosphereElsewhere(options, kMediumFileName);
  const Atmosphere air = AirOf(options, "bruneton2017");
  ExportTables(air, options.out, exchange,
               ShownProgress("scattering", kExchangeRows, common.progress_style()));
  if (!IsTheMediumThatLoadersAssume(air.medium())) {
    Warn(fmt::format(
        "programs with fixed constants assume the preset bruneton2017; these tables are for {}",
        air.name()));
    WarnOfLobe(air.medium());
  }
}

/// Writes the smallest tables within an error. This search has no function in the public headers: its
/// result is a text about measured errors of methods.
void BuildWithin(double max_error, const BuildOptions& options, const Atmosphere& air) {
  MakeFolder(options.out);  // before the tables are computed
  const TableChoice choice = ChooseTables(
      air.medium(),
      {.max_error = max_error,
       .wanted = options.tables == "all" ? TablesWanted::kAll : TablesWanted::kSmallest});
  WriteTables(choice, options.out);
  Print(ChoiceText(choice, max_error));
}

void Build(const BuildOptions& options, const CommonOptions& common) {
  if (const auto exchange = ExchangeOf(options)) {
    BuildExchangeTables(options, *exchange, common);
    return;
  }
  const Atmosphere air = AirOf(options, "earth");
  if (const auto max_error = RelativeErrorFromText(options.max_error.value_or(""))) {
    BuildWithin(*max_error, options, air);
    return;
  }
  const BakeOptions bake{.quality = BakeQualityFromName(options.quality),
                         .single_scattering_only = options.single_scattering_only};
  const std::size_t rows = ScatteringTable::Rows(SizesOf(bake.quality).single_scattering);
  BakeTables(air, options.out, bake,
             ShownProgress("single scattering", rows, common.progress_style()));
}

/// Adds the options that choose the tables and their sizes.
void AddSizes(CLI::App& build, BuildOptions& options) {
  CLI::Option* quality =
      build
          .add_option(
              "--quality", options.quality,
              "Sizes of the tables: preview (128x32; 6x16x32x24; 28x14), standard (256x64; "
              "8x32x64x48; 32x18) or fine (512x128; 10x48x96x64; 64x32). The sizes are those of "
              "transmittance (mu x r), single scattering (azimuth x mu_s x mu x r) and multiple "
              "scattering (mu_s x altitudes)")
          ->check(CLI::IsMember({"preview", "standard", "fine"}))
          ->capture_default_str();
  CLI::Option* max_error =
      build
          .add_option(
              "--max-error", options.max_error,
              "Choose the number of ray nodes, the tables and the smallest sizes so that sky, "
              "aerial perspective, twilight and irradiance stay below this relative error "
              "(rms), like 0.5%, and print the measured errors")
          ->check(FaultOfRelativeError)
          ->excludes(quality);
  build
      .add_option(
          "--tables", options.tables,
          "With --max-error: smallest (least memory: a table is omitted if closed forms or a "
          "few nodes along the ray can replace it) or all (all three tables)")
      ->check(CLI::IsMember({"smallest", "all"}))
      ->needs(max_error)
      ->capture_default_str();
  build
      .add_flag("--single-scattering-only", options.single_scattering_only,
                "Omit the table of multiple scattering")
      ->excludes(max_error);
  build
      .add_option(
          "--layout", options.layout,
          "Files to write: native, or those that other programs load: bruneton (the demo of "
          "Bruneton 2017) or takram (@takram/three-atmosphere). Both have three "
          "wavelengths and use the preset bruneton2017 by default, the only atmosphere "
          "that the sky of takram draws")
      ->check(CLI::IsMember({"native", "bruneton", "takram"}))
      ->excludes(quality)
      ->excludes(max_error)
      ->capture_default_str();
}

/// Adds the options that choose the format of the files.
void AddFormats(CLI::App& build, BuildOptions& options) {
  build
      .add_option("--type", options.type,
                  "Type of texels: float or half (default: float; half for takram)")
      ->check(CLI::IsMember(TexelTypeNames()));
  build
      .add_option("--format", options.format,
                  "File format: exr, bin (for half and takram) or dat (for float and bruneton) "
                  "(default: exr; dat for bruneton)")
      ->check(CLI::IsMember(TexelFormatNames()));
  build
      .add_option(
          "--lowest-sun", options.lowest_sun_deg,
          "Zenith angle in degrees of the lowest sun in the tables, a constant in the programs "
          "that load them: 102 (default of bruneton, for the demo in half precision) or 120 "
          "(takram, and the demo of Bruneton when compiled for single precision)")
      ->check(CLI::IsMember({102, 120}));
}

struct ReportCommandOptions {
  std::optional<std::string> atmosphere;
  std::string out;
  bool quick = false;
};

void WriteMeasuredReport(const ReportCommandOptions& options, const CommonOptions& common) {
  const Report report = MeasureReport(
      {.mediums = MediumsOfReport(options.atmosphere, options.quick),
       .hard_mediums = options.atmosphere || options.quick ? std::vector<Medium>{} : HardMediums(),
       .quick = options.quick,
       .progress = common.progress_style()});
  WriteReport(report, options.out);
  if (!common.quiet) Print(SummaryOf(report));
}

}  // namespace

Subcommand AddBuildCommand(CLI::App& app) {
  const auto options = std::make_shared<BuildOptions>();
  CLI::App& build = *app.add_subcommand(
      "build",
      "Build the tables of an atmosphere: transmittance, single scattering, multiple scattering.");
  BeginGroup(build, kAirGroup);
  AddAtmosphereOption(build, options->atmosphere);
  AddMetarOption(build, options->metar, kMetarAirHelp);
  BeginGroup(build, kOutputGroup);
  build.add_option("--out", options->out, "Folder for the tables; it is created if necessary")
      ->check(FaultOfFolderName)
      ->required();
  AddSizes(build, *options);
  AddFormats(build, *options);
  BeginDiagnostics(build);
  build.parse_complete_callback([options] { CheckLayout(*options); });
  build.footer(
      "Examples: skylut build --out tables --atmosphere atmosphere.toml --quality fine\n"
      "          skylut build --out tables --max-error 1%\n"
      "          skylut build --out takram --layout takram");
  return [options](const CommonOptions& common) { Build(*options, common); };
}

Subcommand AddReportCommand(CLI::App& app) {
  const auto options = std::make_shared<ReportCommandOptions>();
  CLI::App& report =
      *app.add_subcommand("report",
                          "Compare every method with reference solutions by day, at sunset and in "
                          "twilight, and plot error over time and memory. The report has CSV "
                          "files, SVG plots, summary.md and a page, index.html.");
  BeginGroup(report, kAirGroup);
  report.add_option("--atmosphere", options->atmosphere,
                    "Atmosphere file (TOML) or preset (default: the presets earth and hazy and, "
                    "for multiple scattering, dust, thick haze and thick air)");
  BeginGroup(report, kOutputGroup);
  report.add_option("--out", options->out, "Folder for the report; it is created if necessary")
      ->check(FaultOfFolderName)
      ->required();
  report.add_flag("--quick", options->quick,
                  "Use few rays and methods and one atmosphere, to test the report and not the "
                  "methods");
  BeginDiagnostics(report);
  report.footer("Example: skylut report --out report");
  return [options](const CommonOptions& common) { WriteMeasuredReport(*options, common); };
}

}  // namespace alpenglow::lut
