// SPDX-License-Identifier: MIT
// This header declares the subcommands of skylut: `build` writes the tables of an atmosphere to a
// folder, `report` measures speed against error and writes the results to a folder
// (table_commands.cpp), and `sky` renders panoramas for lighting (sky_command.cpp).
#pragma once

#include "lut/cli/command_line.h"

namespace alpenglow::lut {

/// Each adds a subcommand and returns the function that runs it after the whole command line has
/// been parsed.
[[nodiscard]] Subcommand AddBuildCommand(CLI::App& app);
[[nodiscard]] Subcommand AddReportCommand(CLI::App& app);
[[nodiscard]] Subcommand AddSkyCommand(CLI::App& app);

}  // namespace alpenglow::lut
