// SPDX-License-Identifier: MIT
// A medium as the text of an atmosphere.toml: what files carry so that their medium can be rebuilt.
#pragma once

#include <string>

#include "atmosphere/air/medium.h"

namespace alpenglow::atmosphere {

/// Every parameter, in the shortest digits that give the same double back:
/// MediumHash(MediumFromToml(TomlFromMedium(m), "")) == MediumHash(m). The name is not in it.
/// Throws InputError for a medium that no atmosphere.toml describes (a parameter set that its phase
/// function does not have).
[[nodiscard]] std::string TomlFromMedium(const Medium& medium);

}  // namespace alpenglow::atmosphere
