// SPDX-License-Identifier: MIT
#include "renderer/clouds/cloud_generator.h"

#include <cmath>
#include <memory>

#include "atmosphere/base/error.h"
#include "renderer/clouds/cirrus.h"
#include "renderer/clouds/cumulus.h"
#include "renderer/clouds/layer_clouds.h"
#include "renderer/clouds/shape_noise.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

constexpr double kCloudVoxel_m = 20.0;

/// The values of a genus besides its shape.
struct GenusMatter {
  CloudEdge edge;
  double adiabatic_fraction;
  double detail_m;  // amplitude
  double below_m,
      above_m;  // space of the lattice outside of base and depth, above as share of depth
};

GenusMatter MatterOfGenus(CloudGenus genus) {
  switch (genus) {
    case CloudGenus::kCumulus:
      return {{16.0, 0.6, 120.0}, 0.5, 7.0, 80.0, 0.25};
    case CloudGenus::kStratocumulus:
      return {{30.0, 0.35, 60.0}, 0.8, 4.0, 60.0, 0.7};
    case CloudGenus::kAltocumulus:
      return {{40.0, 0.35, 50.0}, 0.6, 4.0, 60.0, 0.5};
    case CloudGenus::kCirrus:
      return {{40.0, 1.0, 1.0}, 1.0, 0.0, 20.0, 0.0};
  }
  throw InternalError("a genus of clouds has no matter");
}

CloudColumn GenusColumn(const CloudOptions& options, const GenusMatter& matter) {
  if (options.genus == CloudGenus::kCirrus) {
    return IceColumn(1e-6 * options.ice_mg_per_m3, options.crystal_radius_um);
  }
  DropletOptions droplets;
  droplets.base_altitude_m = options.base_altitude_m;
  droplets.condensation_kg_per_m4 =
      CondensationRate_kg_per_m4(StandardBaseAir(options.base_altitude_m));
  droplets.adiabatic_fraction = matter.adiabatic_fraction;
  droplets.number_per_cm3 = options.droplet_number_per_cm3;
  return DropletColumn(droplets, options.base_altitude_m + 2.0 * options.depth_m + 200.0);
}

std::unique_ptr<const CloudShape> GenusShape(const CloudOptions& options,
                                             const CloudLattice& lattice, const CloudMatter& matter,
                                             double time_s) {
  switch (options.genus) {
    case CloudGenus::kCumulus:
      return CumulusShape(options, lattice, matter, time_s);
    case CloudGenus::kStratocumulus:
    case CloudGenus::kAltocumulus:
      return LayerCloudShape(options, lattice, matter, time_s);
    case CloudGenus::kCirrus:
      return CirrusShape(options, lattice, matter, time_s);
  }
  throw InternalError("a genus of clouds has no shape");
}

}  // namespace

CloudMatter MatterOf(const CloudOptions& options) {
  const GenusMatter genus = MatterOfGenus(options.genus);
  CloudMatter matter{GenusColumn(options, genus), genus.edge, {}};
  if (genus.detail_m > 0.0) {
    matter.detail = {&ShapeNoise::Billow(), genus.detail_m, 160.0};
  }
  return matter;
}

CloudLattice LatticeOf(const CloudOptions& options) {
  const GenusMatter genus = MatterOfGenus(options.genus);
  const double height =
      genus.below_m + options.depth_m * (1.0 + genus.above_m) + (genus.above_m > 0.0 ? 60.0 : 0.0);
  const int across = static_cast<int>(options.period_m / kCloudVoxel_m);
  CloudLattice lattice;
  lattice.voxels = {across, across, static_cast<int>(std::ceil(height / kCloudVoxel_m))};
  lattice.voxel_m = glm::dvec3(kCloudVoxel_m);
  lattice.origin_m = {0.0, 0.0, options.base_altitude_m - genus.below_m};
  return lattice;
}

CloudField MakeCloudField(const CloudOptions& options, double time_s) {
  CheckCloudOptions(options);
  RequireInRange(time_s, 0.0, 1e7, "the time of a field of clouds [s]");
  const CloudLattice lattice = LatticeOf(options);
  const CloudMatter matter = MatterOf(options);
  const CloudField field(lattice, *GenusShape(options, lattice, matter, time_s), matter);
  return field.Moved(time_s * options.wind_m_per_s);
}

}  // namespace alpenglow::renderer
