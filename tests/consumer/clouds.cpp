// SPDX-License-Identifier: MIT
// An example of README.md: light in a field of clouds, by the fast method and by traced paths.
#include <alpenglow/clouds.h>

#include <cmath>
#include <cstdio>

using namespace alpenglow;

int main() {
  const CloudField cumulus({.genus = CloudGenus::kCumulus, .cover = 0.3, .period_m = 5120.0});
  const Direction sun = DirectionFromAngles(35.0, 200.0);
  const CloudSurroundings grass{.ground_albedo = 0.15};
  const CloudLight light(cumulus, sun, {.surroundings = grass});  // solves all orders, once
  const CloudPaths paths(cumulus, sun, grass);                    // slower, without bias
  const TracedCloudFluxes traced = paths.Fluxes({1, 1}, {.paths = 20000}).mean;
  const CloudFluxes fast = light.Fluxes().front();
  std::printf("reflected %.3f, traced %.3f +- %.3f\n", fast.up_at_top, traced.up_at_top.value,
              traced.up_at_top.standard_error);
  const CloudRay from_above{{.up_m = 4000.0}, {.east = 0.3, .up = -1.0}};
  const CloudRadiance seen = light.Radiance(from_above);  // per unit of sun, sky and ground
  const TracedCloudRadiance exact = paths.Radiance(from_above);
  std::printf("radiance %.4f/sr, traced %.4f +- %.4f/sr\n", seen.sun, exact.sun.value,
              exact.sun.standard_error);
  return std::abs(fast.up_at_top - traced.up_at_top.value) < 0.05 ? 0 : 1;
}
