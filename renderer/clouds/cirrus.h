// SPDX-License-Identifier: MIT
// Cirrus: fibres of ice, 20 to 50 m across, that fall from tufts and are drawn out by shear.
//
// Crystals grow in a tuft at the top and fall through air whose wind decreases downwards, so that
// they lag behind the tuft (Marshall 1953, J. Meteor. 10, 25; Heymsfield 1975, J. Atmos. Sci. 32,
// 820): a crystal that has fallen by f lies at
//
//   p(f) = p_0 - w L (f / f_end)^2 - z f + drift(p)
//
// where w is the direction of the wind, L the length of the streak (kilometres) and drift a smooth
// noise that neighbouring fibres share. A fibre is a line of such points with a radius that varies
// along it; the depth is the greatest of r - d over all fibres, d the distance to the line.
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "renderer/clouds/cloud_field.h"
#include "renderer/clouds/cloud_options.h"

namespace alpenglow::renderer {

/// A point of a fibre.
struct FibreNode {
  glm::dvec3 place_m;
  double radius_m;
};
using Fibre = std::vector<FibreNode>;

/// Returns the fibres over one period at a time; their places may lie outside of it.
[[nodiscard]] std::vector<Fibre> CirrusFibres(const CloudOptions& options, double time_s);

/// Returns the shape of cirrus at a time, with the cover of the options.
/// @param matter  for the optical depths that make the cover.
[[nodiscard]] std::unique_ptr<const CloudShape> CirrusShape(const CloudOptions& options,
                                                            const CloudLattice& lattice,
                                                            const CloudMatter& matter,
                                                            double time_s);

}  // namespace alpenglow::renderer
