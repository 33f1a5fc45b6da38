// SPDX-License-Identifier: MIT
// Phase functions of ice crystals, with the halos of 22 and 46 degrees.
//
// The table renderer/data/ice_phase.csv has the phase functions of a mixture of hexagonal columns and
// plates in random orientation: 30 % of the extinction by smooth crystals, the rest by severely rough
// ones, which have no halo. Rays are traced through the crystals, and diffraction is added
// (tests/bench/ice_phase.cpp describes both). The halo of a prism with the angle A begins at the
// minimum deviation
//
//   D = 2 asin(n sin(A / 2)) - A,   A = 60 degrees: 22-degree halo, A = 90 degrees: 46-degree halo
//
// with the index of ice n, which is larger for blue light: the inner edge of a halo is red. Crystals
// that lie level are not modelled, nor are the parhelia and arcs that they make.
#pragma once

#include "renderer/cloud_phase/cloud_phase.h"

namespace alpenglow::renderer {

/// Returns the phase functions at a wavelength for effective radii of 10, 20, 40 and 80 um; beyond
/// these the first or last one holds. Their asymmetry parameters are in [0.77, 0.81].
/// @param wavelength_nm  in [300, 1000]; throws InputError beyond. The table has the wavelengths from
/// 400 to 700 nm; the mixture of its two nearest is returned, or the first or last beyond them.
[[nodiscard]] CloudPhases IcePhases(double wavelength_nm);

}  // namespace alpenglow::renderer
