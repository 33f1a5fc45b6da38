// SPDX-License-Identifier: MIT
// This header adds two subcommands: `skyseries report` writes a report on the speed and error of
// pictures into a folder, and `skyseries times` lists sun and moon at a place, day by day.
#pragma once

#include <functional>

#include "lut/cli/command_line.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Adds the subcommand, with its own common options; if it is given, the program's own --out is not
/// required. Returns the function that runs it after the whole command line is parsed.
[[nodiscard]] std::function<void()> AddPictureReportCommand(CLI::App& app);

/// Adds the subcommand, with its own common options; if it is given, the program's own --out is not
/// required. Returns the function that runs it after the whole command line is parsed.
[[nodiscard]] std::function<void()> AddTimesCommand(CLI::App& app);

}  // namespace alpenglow::renderer
