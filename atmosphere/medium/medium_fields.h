// SPDX-License-Identifier: MIT
// The keys of atmosphere.toml, in the order of the file: their values, units, members of Medium and
// meanings. The reader and the writer of the file, the check of a medium, its hash and
// ATMOSPHERE_FILE.md follow these tables.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/base/toml_fields.h"
#include "atmosphere/medium/medium.h"

namespace alpenglow::atmosphere {

/// Returns the kind of refraction as the file names it.
[[nodiscard]] std::string NameOf(RefractionBy refraction);

/// Returns the keys above all sections. The reader of the file takes their values itself.
[[nodiscard]] const TomlFields<Medium>& TopFieldsOfMedium();

/// Returns the sections of the file: planet, spectrum, rayleigh, mie, aerosol and ozone.
[[nodiscard]] const std::vector<TomlFields<Medium>>& SectionsOfMedium();

/// Returns the section with this name; throws InternalError if there is none.
[[nodiscard]] const TomlFields<Medium>& SectionOfMedium(std::string_view name);

}  // namespace alpenglow::atmosphere
