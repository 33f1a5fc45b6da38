// SPDX-License-Identifier: MIT
// From the column of ozone, as weather services give it, to the coefficient at the peak of its
// layer.
#pragma once

#include "atmosphere/air/medium.h"

namespace alpenglow::atmosphere {

/// Absorption coefficient at the peak of the layer [1/m] when its column is
/// `column_dobson` (1 DU = 2.6867811e20 molecules per m^2): column times cross section
/// over the depth of the layer.
/// @param wavelength_nm  in [360, 830]; 0 where the cross section has no data.
[[nodiscard]] double OzoneAbsorptionAtPeak(double column_dobson, const OzoneLayer& layer,
                                           double wavelength_nm);

}  // namespace alpenglow::atmosphere
