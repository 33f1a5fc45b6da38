// SPDX-License-Identifier: MIT
// `skylut sky`: panoramas for lighting.
#pragma once

#include "lut/program/command_line.h"

namespace alpenglow::lut {

/// Adds the subcommand; what runs it once the whole command line is parsed.
[[nodiscard]] Subcommand AddSkyCommand(CLI::App& app);

}  // namespace alpenglow::lut
