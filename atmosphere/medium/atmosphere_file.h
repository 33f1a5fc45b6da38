// SPDX-License-Identifier: MIT
// This header reads and writes atmosphere.toml. ATMOSPHERE_FILE.md describes every key, and
// medium_fields.h has the tables of the keys.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "atmosphere/medium/medium.h"

namespace alpenglow::atmosphere {

/// Reads atmosphere.toml: a preset, modified by the values of the file (keys, units and meaning:
/// ATMOSPHERE_FILE.md). Wavelengths may ascend or descend; descending ones are stored reversed,
/// together with every list of the file. Throws InputError "file:line: key ..." for unknown keys
/// (with the nearest known one), wrong types, NaN, infinities, lists of unequal length, values out
/// of range, keys that contradict each other or would have no effect, and malformed text. The name
/// of the medium is the preset's, or "custom (from PRESET)" if the file changes anything.
/// @param use  of the medium; wavelengths that it does not allow are an error too.
[[nodiscard]] Medium ReadMedium(const std::filesystem::path& file, const MediumUse& use = {});

/// Reads a medium like ReadMedium, from text; messages contain `origin` in place of the file name.
[[nodiscard]] Medium MediumFromToml(std::string_view text, const std::string& origin,
                                    const MediumUse& use = {});

/// Writes every parameter, in the shortest digits that give the same double back:
/// MediumHash(MediumFromToml(TomlFromMedium(m), "")) == MediumHash(m). The name is not written.
/// Throws InputError for a medium that atmosphere.toml cannot describe (a parameter is set that its
/// phase function does not have).
[[nodiscard]] std::string TomlFromMedium(const Medium& medium);

}  // namespace alpenglow::atmosphere
