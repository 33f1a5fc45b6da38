// SPDX-License-Identifier: MIT
// The contents of a sky of the public headers, for the sources that implement them.
#pragma once

#include <alpenglow/sky.h>

#include "lut/table_io/table_folder.h"

namespace alpenglow {

/// The light of a sky is that of the look-ups. Their tables have multiple scattering, and belong to
/// the medium of the atmosphere.
struct Sky::State {
  Atmosphere parameters;
  lut::TableLookup lookup;
};

/// Makes skies from their contents, and returns these.
struct SkyParts {
  [[nodiscard]] static Sky Made(const Atmosphere& atmosphere, lut::TableFolder tables);
  [[nodiscard]] static const lut::TableLookup& LookupOf(const Sky& sky) {
    return sky.state_->lookup;
  }
};

}  // namespace alpenglow
