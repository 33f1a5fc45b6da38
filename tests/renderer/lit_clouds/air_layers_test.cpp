// SPDX-License-Identifier: MIT
#include "renderer/lit_clouds/air_layers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "atmosphere/math/numerics.h"
#include "atmosphere/medium/medium_presets.h"

namespace alpenglow::renderer {
namespace {

Medium Molecules() {
  Medium medium = MediumPreset("earth");
  std::ranges::fill(medium.mie_scattering_per_m, 0.0);
  std::ranges::fill(medium.mie_extinction_per_m, 0.0);
  return medium;
}

/// Returns the spherical albedo of molecules (Vermote and others 1997).
double SphericalAlbedo(double depth) {
  const GaussRule& rule = GaussLegendre(32);
  double e3 = 0.0;
  for (std::size_t i = 0; i < rule.node.size(); ++i)
    e3 += rule.weight[i] * rule.node[i] * std::exp(-depth / rule.node[i]);
  return (3.0 * depth - e3 * (4.0 + 2.0 * depth) + 2.0 * std::exp(-depth)) / (4.0 + 3.0 * depth);
}

// The formula is a fit to light of all orders.
TEST(AirReflection, OfMoleculesIsTheirSphericalAlbedo) {
  const Medium medium = Molecules();
  for (const double altitude_m : {0.0, 2000.0, 8000.0}) {
    const std::vector<double> found = ReflectionOfAirAbove(medium, altitude_m);
    for (std::size_t band = 0; band < found.size(); ++band) {
      const double depth =
          medium.rayleigh_scattering_per_m[band] * MoleculeColumn_m(medium, altitude_m);
      EXPECT_NEAR(found[band], SphericalAlbedo(depth), 0.005) << altitude_m << " " << depth;
    }
  }
}

TEST(AirReflection, HazeAddsToItAndAVacuumHasNone) {
  Medium medium = Molecules();
  const std::vector<double> of_molecules = ReflectionOfAirAbove(medium, 0.0);
  const std::vector<double> with_haze = ReflectionOfAirAbove(MediumPreset("earth"), 0.0);
  std::ranges::fill(medium.rayleigh_scattering_per_m, 0.0);
  const std::vector<double> of_nothing = ReflectionOfAirAbove(medium, 0.0);
  for (std::size_t band = 0; band < of_molecules.size(); ++band) {
    EXPECT_GT(with_haze[band], of_molecules[band]);
    EXPECT_LT(of_nothing[band], 1e-15) << "rounding";
  }
}

}  // namespace
}  // namespace alpenglow::renderer
