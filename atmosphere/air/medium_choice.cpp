// SPDX-License-Identifier: MIT
#include "atmosphere/air/medium_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <system_error>
#include <vector>

#include "atmosphere/text/error.h"
#include "atmosphere/text/toml_table.h"

namespace alpenglow::atmosphere {
namespace {

bool LooksLikeFile(const std::string& text) {
  return text.find_first_of("./\\") != std::string::npos;
}

}  // namespace

Medium MediumFromChoice(const std::string& preset_or_file, const std::filesystem::path& folder) {
  const std::vector<std::string> presets = MediumPresetNames();
  if (std::find(presets.begin(), presets.end(), preset_or_file) != presets.end())
    return MediumPreset(preset_or_file);
  const std::filesystem::path file = folder / preset_or_file;
  std::error_code error;
  if (std::filesystem::exists(file, error) || LooksLikeFile(preset_or_file))
    return ReadMedium(file);
  const std::optional<std::string> nearest = NearestName(preset_or_file, presets);
  throw InputError(fmt::format("atmosphere \"{}\" is neither a file nor a preset; {}",
                               preset_or_file,
                               nearest ? fmt::format("did you mean {}?", *nearest)
                                       : fmt::format("presets are {}", fmt::join(presets, ", "))));
}

}  // namespace alpenglow::atmosphere
