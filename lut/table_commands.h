// SPDX-License-Identifier: MIT
// `skylut build`: tables of an atmosphere, into a folder.
//
// `skylut report`: speed against error, into a folder.
#pragma once

#include "lut/program/command_line.h"

namespace alpenglow::lut {

/// Adds the subcommand; what runs it once the whole command line is parsed.
[[nodiscard]] Subcommand AddBuildCommand(CLI::App& app);

/// Adds the subcommand; what runs it once the whole command line is parsed.
[[nodiscard]] Subcommand AddReportCommand(CLI::App& app);

}  // namespace alpenglow::lut
