// SPDX-License-Identifier: MIT
#include "lut/build_command.h"

#include <memory>
#include <optional>
#include <string>

#include "atmosphere/medium.h"
#include "lut/table_folder.h"

namespace alpenglow {
namespace {

struct BuildOptions {
  std::optional<std::string> atmosphere;
  std::string out;
  bool single_scattering_only = false;
  std::string quality = "standard";
};

void Build(const BuildOptions& options, const CommonOptions& common) {
  const Medium medium =
      options.atmosphere ? ReadMedium(*options.atmosphere) : MediumPreset("earth");
  BuildTableFolder(medium, TableQualityFromName(options.quality), options.out,
                   common.progress_style());
}

}  // namespace

Subcommand AddBuildCommand(CLI::App& app) {
  const auto options = std::make_shared<BuildOptions>();
  CLI::App& build = *app.add_subcommand(
      "build", "Build the tables of transmittance and single scattering of an atmosphere.");
  build.add_option("--out", options->out, "Folder for the tables; made when missing")->required();
  AddAtmosphereOption(build, options->atmosphere);
  build
      .add_option("--quality", options->quality,
                  "preview (128x32; 8x24x64x16), standard (256x64; 8x32x128x32) or fine "
                  "(512x128; 16x48x192x48): sizes of transmittance mu x r; scattering nu x mu_s "
                  "x mu x r")
      ->check(CLI::IsMember({"preview", "standard", "fine"}))
      ->capture_default_str();
  build.add_flag("--single-scattering-only", options->single_scattering_only,
                 "States what is built: tables of single scattering, and no others");
  build.footer("Example: skylut build --out tables --atmosphere atmosphere.toml --quality fine");
  return [options](const CommonOptions& common) { Build(*options, common); };
}

}  // namespace alpenglow
