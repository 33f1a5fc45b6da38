// SPDX-License-Identifier: MIT
// Phase functions of cloud droplets by Lorenz-Mie theory, with fog bow and glory.
//
// The table renderer/data/droplet_phase.csv has the phase functions of water spheres with the size
// distribution of Hansen (1971), J. Atmos. Sci. 28, 1400, of effective variance 1/9, for effective
// size parameters 2 pi r_eff / wavelength from 25 to 504 in steps of a third of an octave, and for the
// refractive index of water at 400, 550 and 700 nm. The index is larger for blue light and puts its bow
// further inside. With the same index for all light, the wider bow of red light would make both edges
// of the bow of 10 um droplets red; with their own, the outer one is red and the inner one nearly white.
#pragma once

#include "renderer/cloud_phase/cloud_phase.h"

namespace alpenglow::renderer {

/// Returns the phase functions at a wavelength, by the effective radius. At 550 nm the table reaches
/// from 2.2 to 44 um; beyond its ends the first or last phase function holds.
/// @param wavelength_nm  in [300, 1000]; throws InputError beyond. Phase functions of one size
///     parameter are mixtures of those of the two nearest indices, or the first or last beyond them.
[[nodiscard]] CloudPhases DropletPhases(double wavelength_nm);

}  // namespace alpenglow::renderer
