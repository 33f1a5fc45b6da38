// SPDX-License-Identifier: MIT
// The program skylut builds, describes and evaluates tables of the sky.
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/medium/medium_presets.h"
#include "lut/cli/command_line.h"
#include "lut/cli/metar_air.h"
#include "lut/cli/metar_option.h"
#include "lut/cli/output_file.h"
#include "lut/cli/outputs.h"
#include "lut/cli/program.h"
#include "lut/evaluate/eval.h"
#include "lut/evaluate/integral_evaluator.h"
#include "lut/evaluate/lamp_cases.h"
#include "lut/sky_command.h"
#include "lut/table_commands.h"
#include "lut/table_io/exchange_check.h"
#include "lut/table_io/table_folder.h"

namespace alpenglow::lut {
namespace {

struct Options {
  CommonOptions common;
  std::optional<std::string> atmosphere, metar, tables, max_error;
  std::string described;
  std::string cases, results, method;
  std::optional<int> samples;
};

void AddInfo(CLI::App& app, Options& options) {
  CLI::App& info = *app.add_subcommand(
      "info",
      "Describe tables: contents, units, ranges and origin. Every texel is checked. Tables for "
      "other "
      "programs (bruneton, takram), whichever program made them, are compared with texels that "
      "skylut computes.");
  info.add_option("tables", options.described, "A table file or a folder of tables")->required();
  BeginDiagnostics(info);
  info.footer("Example: skylut info tables");
}

void AddEval(CLI::App& app, Options& options) {
  CLI::App& eval = *app.add_subcommand(
      "eval",
      "Evaluate cases, one per line: id,quantity,altitude_m,view_zenith_deg,"
      "relative_azimuth_deg,sun_zenith_deg,distance_m. Quantities: transmittance, "
      "optical_depth, single, inscatter_single, total, irradiance_sun, irradiance_sky, stokes_q, "
      "stokes_u. Radiances [1/sr] and irradiances [1] are per unit solar irradiance. If distance_m "
      "is empty, the ray ends at the ground or at the top of the atmosphere; single and total then "
      "include the light of the ground. If distance_m is given, the ray ends there, or at the "
      "ground or the top if they are nearer, and the light of the ground is left out. Results: "
      "id,wavelength_nm,value,error. For lamps in homogeneous air (quantity airlight) the columns "
      "are id,quantity,scattering_per_m,extinction_per_m,phase,g,segment_m,light_along_m,"
      "light_across_m,profile,axis_x,axis_y,axis_z,exponent,inner_deg,outer_deg. This needs "
      "--method integral and no atmosphere, and the result is the radiance for unit intensity "
      "[1/(sr m2)].");
  BeginGroup(eval, kAirGroup);
  AddAtmosphereOption(eval, options.atmosphere);
  eval.add_option("--lut", options.tables,
                  "Folder of tables. Without --atmosphere, the atmosphere of the tables is used");
  AddMetarOption(eval, options.metar, kMetarAirHelp)->excludes("--lut");
  BeginGroup(eval, kOutputGroup);
  eval.add_option("--cases", options.cases, "CSV file of the cases")->required();
  eval.add_option("--out", options.results, "CSV file of the results")
      ->check([](const std::string& name) { return FaultOfFileName(name, ""); })
      ->required();
  eval.add_option("--method", options.method,
                  "table (needs --lut), integral (along rays) or path-trace")
      ->check(CLI::IsMember({"table", "integral", "path-trace"}))
      ->required();
  CLI::Option* samples =
      eval.add_option("--samples", options.samples,
                      "With integral: Gauss nodes in each smooth piece of a ray (default: 16)")
          ->check(InRange(kFewestSamples, kMostSamples));
  eval.add_option("--max-error", options.max_error,
                  "Relative error, 1e-8 to 1 or in percent; for path-trace, one standard error "
                  "(default of path-trace: 0.5%)")
      ->check(FaultOfRelativeError)
      ->excludes(samples);
  BeginDiagnostics(eval);
  eval.footer("Example: skylut eval --cases cases.csv --out results.csv --method integral");
}

/// Checks option rules that CLI11 cannot express: options that are valid with one method only.
void CheckMethod(const CLI::App& eval, const Options& options) {
  if (!eval.parsed() || options.method == "integral") return;
  if (options.samples) throw CLI::ValidationError("--samples", "needs --method integral");
  if (options.method == "path-trace") return;
  if (!options.tables) throw CLI::ValidationError("--method table", "needs --lut");
  if (options.max_error) throw CLI::ValidationError("--method table", "takes no --max-error");
}

std::unique_ptr<Evaluator> EvaluatorFor(const Options& options) {
  std::optional<Medium> medium;
  std::optional<std::uint64_t> hash;
  const MediumUse use = options.method == "path-trace" ? MediumUse{} : kForLight;
  if (options.atmosphere)
    hash = MediumHash(medium.emplace(MediumFromChoice(*options.atmosphere, use)));
  if (options.tables) {
    TableFolder tables = ReadTableFolder(*options.tables, hash);
    if (options.method == "table") {
      return MakeTableEvaluator(std::move(tables));
    }
    medium = tables.medium;
  }
  if (!medium) medium = MediumPreset("earth");
  if (options.metar) medium = InTypedAir(*std::move(medium), options.metar);
  const auto error = RelativeErrorFromText(options.max_error.value_or(""));
  if (options.method == "path-trace")
    return MakePathTraceEvaluator(
        *medium, {.max_paths = kMostPathsOfCase, .relative_error = error.value_or(0.005)});
  return MakeIntegralEvaluator(*medium,
                               {.samples = options.samples.value_or(16), .max_error = error});
}

std::vector<NamedFile> InputsOf(const Options& options) {
  std::vector<NamedFile> inputs{{"--cases", options.cases}};
  if (options.atmosphere) inputs.push_back({"--atmosphere", *options.atmosphere});
  if (!options.tables) return inputs;
  for (const char* name :
       {kTransmittanceFileName, kSingleScatteringFileName, kMultipleScatteringFileName}) {
    inputs.push_back({"--lut", std::filesystem::path(*options.tables) / name});
  }
  return inputs;
}

void Evaluate(const Options& options) {
  PrepareOutputs({{"--out", options.results}}, InputsOf(options));
  const ProgressStyle style = options.common.progress_style();
  if (!HoldsLampCases(options.cases)) {
    EvaluateFile(options.cases, options.results, *EvaluatorFor(options), style);
    return;
  }
  if (options.method != "integral") {
    throw InputError(options.cases + ": light of lamps needs --method integral");
  }
  EvaluateLampFile(options.cases, options.results,
                   {.samples = options.samples.value_or(16),
                    .max_error = RelativeErrorFromText(options.max_error.value_or(""))},
                   style);
}

std::string Description(const std::filesystem::path& tables) {
  if (const std::optional<std::filesystem::path> folder = ExchangeFolderOf(tables)) {
    return DescriptionText(*folder, DescribeExchangeTables(*folder));
  }
  return DescribeTables(tables);
}

int Run(int argc, char** argv) {
  Options options;
  CLI::App app("Build, inspect and evaluate tables of the sky, and make sky panoramas.", "skylut");
  app.fallthrough();
  app.require_subcommand(1);
  AddCommonOptions(app, "skylut", options.common);
  const Subcommand build = AddBuildCommand(app);
  const Subcommand sky = AddSkyCommand(app);
  const Subcommand report = AddReportCommand(app);
  AddInfo(app, options);
  AddEval(app, options);
  app.parse_complete_callback([&] { CheckMethod(*app.get_subcommand("eval"), options); });
  if (const auto status = ParseCommandLine(app, argc, argv)) return *status;

  const ThreadLimit threads(options.common.threads);
  if (app.got_subcommand("build")) {
    build(options.common);
  } else if (app.got_subcommand("sky")) {
    sky(options.common);
  } else if (app.got_subcommand("report")) {
    report(options.common);
  } else if (app.got_subcommand("info")) {
    Print(Description(options.described));
  } else {
    Evaluate(options);
  }
  return 0;
}

}  // namespace
}  // namespace alpenglow::lut

int main(int argc, char** argv) {
  return alpenglow::lut::RunProgram("skylut", [&] { return alpenglow::lut::Run(argc, argv); });
}
