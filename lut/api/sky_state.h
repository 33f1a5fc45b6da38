// SPDX-License-Identifier: MIT
// The state of a sky of the public headers.
#pragma once

#include <alpenglow/sky.h>

#include "atmosphere/ray/single_scattering.h"
#include "lut/table_io/table_folder.h"

namespace alpenglow {

struct Sky::State {
  /// @param tables  with multiple scattering, of the medium of the atmosphere.
  State(Atmosphere air_parameters, lut::TableFolder tables);

  [[nodiscard]] const lut::MultipleScattering& multiple_scattering() const {
    return *lookup.tables().multiple_scattering;
  }

  Atmosphere parameters;
  atmosphere::SingleScattering<float> air;
  lut::TableLookup lookup;
};

}  // namespace alpenglow
