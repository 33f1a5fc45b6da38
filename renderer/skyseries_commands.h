// SPDX-License-Identifier: MIT
// `skyseries report`: speed against error of pictures, into a folder.
//
// `skyseries times`: sun and moon of a place, day by day.
#pragma once

#include <functional>

#include "lut/program/command_line.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Adds the subcommand, with common options of its own; where it is given, the program's own --out
/// is not asked for. What runs it once the whole command line is parsed.
[[nodiscard]] std::function<void()> AddPictureReportCommand(CLI::App& app);

/// Adds the subcommand, with common options of its own; where it is given, the program's own --out
/// is not asked for. What runs it once the whole command line is parsed.
[[nodiscard]] std::function<void()> AddTimesCommand(CLI::App& app);

}  // namespace alpenglow::renderer
