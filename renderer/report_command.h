// SPDX-License-Identifier: MIT
// `skyseries report`: speed against error of pictures, into a folder.
#pragma once

#include <functional>

#include "lut/program/command_line.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Adds the subcommand, with common options of its own; where it is given, the program's own --out
/// is not asked for. What runs it once the whole command line is parsed.
[[nodiscard]] std::function<void()> AddPictureReportCommand(CLI::App& app);

}  // namespace alpenglow::renderer
