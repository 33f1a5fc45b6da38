// SPDX-License-Identifier: MIT
// What air scatters of the lamps of towns, said by how bright they make the zenith.
//
// Lamps without end all around send light up evenly, L from every direction below; air that favours
// no direction scatters it once. Along a ray of transmittance T that is
//
//   (1 - T) J,      J = L / 2,
//
// which rises from the zenith to the horizon as the air does that one looks through, thickens with
// haze, and stands before mountains too. J is chosen so that the zenith over the ground of the place
// has the brightness asked for, of which kNaturalZenith is the sky's own (night_sky.h). A dome of
// light over one town, in one direction, is not drawn, nor are the lamps.
//
// Half of the luminance of J is that of sodium lamps, of the colour of a black body of 2050 K, half
// that of white LED, of 4000 K: four bands do not resolve the lines that they have.
#pragma once

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/ray/single_scattering.h"
#include "renderer/ground/band_light.h"

namespace alpenglow::renderer {

/// J [W m^-2 sr^-1 nm^-1].
/// @param zenith  [V magnitudes a square arcsecond], nothing of towns where it is darker than
/// kNaturalZenith. @param ground_m  altitude of the place that has it, >= 0.
[[nodiscard]] BandLight TownLight(double zenith, double ground_m, const AirIntegrator<float>& air,
                                  const BandColour& colour);

}  // namespace alpenglow::renderer
