// SPDX-License-Identifier: MIT
// Cumulus: a population of clouds, each a heap of spheres with billow noise on it.
//
// Sizes: the number of clouds per size is ~ l^-1.7 up to a scale break near 1 km, l^2 their area
// seen from above (Neggers, Jonker and Siebesma 2003, J. Atmos. Sci. 60, 1060). Sizes across are
// drawn with an exponent of -1.6 from 120 m on, because large clouds fill less of their extent, and
// fall off exponentially from 1.3 km on. All sizes are drawn before any cloud is placed, and every
// cloud is placed, the largest first: the sizes keep their distribution whatever the cover is. Clouds
// stand where they touch no other if there is such a place, and closer together where noise of 2.5 km
// is high. In layers of the depth D > 1500 m, large clouds tower: the scales of 1.3 km are larger by
// t = (D / 1500 m)^(1/2), and clouds from 1.3 km on are higher for their size by t, as this project chose.
//
// One cloud: plumes side by side on a base, five for a cloud of 120 m and 20 for one of 1 km, each a
// chain of spheres that leans to the middle of the cloud; lobes on the upper and outer side of every
// sphere, and lobes on the lobes. Their union is
//
//   F_0 = s ln(sum_i exp((r_i - |p - c_i|) / s)),   s = 14 m, on a grid of 40 m
//
// Billow noise displaces F_0 by more at the top than at the base, and by less on small clouds; the
// base is cut level. With the plumes it gives outlines the perimeter dimension 1.35 (Lovejoy 1982,
// Science 216, 185).
//
// A cloud grows, stays and decays within 20 minutes times the root of its size over 500 m, and then
// another one grows at the same place.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "renderer/clouds/cloud_field.h"
#include "renderer/clouds/cloud_options.h"

namespace alpenglow::renderer {

/// A sphere of a cloud, relative to the middle of its base.
struct CloudSphere {
  glm::dvec3 centre_m;
  double radius_m;
};

/// A cloud of the population.
struct CumulusCloud {
  double size_m;                     // across, when it is full
  double growth;                     // in [0, 1]: size now over size when full
  glm::dvec2 place_m;                // of the middle of its base
  std::vector<CloudSphere> spheres;  // when it is full
};

/// Returns the clouds of a period at a time, in the order in which they were drawn.
[[nodiscard]] std::vector<CumulusCloud> CumulusPopulation(const CloudOptions& options,
                                                          double time_s);

/// Returns the shape of cumulus at a time, with the cover of the options.
/// @param matter  for the optical depths that make the cover.
[[nodiscard]] std::unique_ptr<const CloudShape> CumulusShape(const CloudOptions& options,
                                                             const CloudLattice& lattice,
                                                             const CloudMatter& matter,
                                                             double time_s);

}  // namespace alpenglow::renderer
