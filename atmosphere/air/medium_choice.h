// SPDX-License-Identifier: MIT
// An atmosphere as people name it: a preset, or a file.
#pragma once

#include <filesystem>
#include <string>

#include "atmosphere/air/medium.h"

namespace alpenglow::atmosphere {

/// MediumPreset of a name that is one of MediumPresetNames, else ReadMedium of the file, whose name
/// is relative to `folder`. Throws InputError as they do; for a word that is neither it names the
/// nearest preset, or all.
[[nodiscard]] Medium MediumFromChoice(const std::string& preset_or_file,
                                      const std::filesystem::path& folder = {});

}  // namespace alpenglow::atmosphere
