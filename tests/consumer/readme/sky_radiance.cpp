// SPDX-License-Identifier: MIT
// An example of README.md: the light of the sky, and the air in front of a mountain.
#include <alpenglow/alpenglow.h>

#include <cstdio>

using namespace alpenglow;

int main() {
  const Sky sky(Atmosphere::Preset("earth"));              // solves all orders of scattering, once
  const Direction sun = DirectionFromAngles(30.0, 180.0);  // elevation and azimuth in degrees
  const LocalPoint eye{.up_m = 2.0}, peak{.north_m = 30e3, .up_m = 2000.0};
  const Spectrum zenith = sky.Radiance(eye, {.up = 1.0}, sun);  // per unit of sunlight [1/sr]
  const AirBetween air = sky.Between(eye, peak, sun);           // aerial perspective
  std::printf("zenith: %.0f cd/m^2\n", Luminance(sky.atmosphere().ColourOf(zenith)));
  for (std::size_t i = 0; i < zenith.size(); ++i)
    std::printf("band %zu: transmittance %.3f, in-scattered light %.4f/sr\n", i,
                air.transmittance[i], air.inscattered[i]);
}
