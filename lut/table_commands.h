// SPDX-License-Identifier: MIT
// Subcommands of skylut: `build` writes the tables of an atmosphere to a folder, and `report`
// measures speed against error and writes the results to a folder.
#pragma once

#include "lut/cli/command_line.h"

namespace alpenglow::lut {

/// Each adds a subcommand and returns the function that runs it after the whole command line has
/// been parsed.
[[nodiscard]] Subcommand AddBuildCommand(CLI::App& app);
[[nodiscard]] Subcommand AddReportCommand(CLI::App& app);

}  // namespace alpenglow::lut
