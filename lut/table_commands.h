// SPDX-License-Identifier: MIT
// This header declares the subcommands `skylut build`, which writes the tables of an atmosphere to
// a folder, and `skylut report`, which measures speed against error and writes the results to a
// folder.
#pragma once

#include "lut/cli/command_line.h"

namespace alpenglow::lut {

/// Adds the subcommand and returns the function that runs it after the whole command line has been
/// parsed.
[[nodiscard]] Subcommand AddBuildCommand(CLI::App& app);

/// Adds the subcommand and returns the function that runs it after the whole command line has been
/// parsed.
[[nodiscard]] Subcommand AddReportCommand(CLI::App& app);

}  // namespace alpenglow::lut
