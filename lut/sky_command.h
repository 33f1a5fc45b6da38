// SPDX-License-Identifier: MIT
// The subcommand `skylut sky`, which renders panoramas for lighting.
#pragma once

#include "lut/cli/command_line.h"

namespace alpenglow::lut {

/// Adds the subcommand and returns the function that runs it after the whole command line has been
/// parsed.
[[nodiscard]] Subcommand AddSkyCommand(CLI::App& app);

}  // namespace alpenglow::lut
