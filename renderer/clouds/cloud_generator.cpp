// SPDX-License-Identifier: MIT
#include "renderer/clouds/cloud_generator.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "atmosphere/base/error.h"
#include "renderer/clouds/cirrus.h"
#include "renderer/clouds/cumulus.h"
#include "renderer/clouds/layer_clouds.h"
#include "renderer/clouds/plane_parallel_depths.h"
#include "renderer/clouds/shape_noise.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

constexpr double kCloudVoxel_m = 20.0;
// Four cells of the moments of light.
constexpr double kPlaneParallelPeriod_m = 320.0;

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
    case CloudGenus::kStratus:
    case CloudGenus::kCirrostratus:
      return {{20.0, 1.0, 1.0}, 0.8, 0.0, 20.0, 0.0};
  }
  throw InternalError("a genus of clouds has no matter");
}

CloudColumn GenusColumn(const CloudOptions& options, const GenusMatter& matter) {
  if (IsOfIce(options.genus)) {
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

/// Stratus and cirrostratus: all between base and top.
class PlaneParallelShape final : public CloudShape {
 public:
  PlaneParallelShape(double base_m, double depth_m) : base_m_(base_m), top_m_(base_m + depth_m) {}

  [[nodiscard]] double SignedDepth_m(const glm::dvec3& point) const override {
    return std::min(point.z - base_m_, top_m_ - point.z);
  }
  [[nodiscard]] bool MayHoldCloud(const glm::dvec3& low, const glm::dvec3& high) const override {
    return std::min(high.z - base_m_, top_m_ - low.z) > -kCloudMargin_m;
  }

 private:
  double base_m_, top_m_;
};

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
    case CloudGenus::kStratus:
    case CloudGenus::kCirrostratus:
      return std::make_unique<PlaneParallelShape>(options.base_altitude_m, options.depth_m);
  }
  throw InternalError("a genus of clouds has no shape");
}

CloudField FieldOfMatter(const CloudOptions& options, const CloudMatter& matter, double time_s) {
  const CloudLattice lattice = LatticeOf(options);
  return {lattice, *GenusShape(options, lattice, matter, time_s), matter};
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
  const double height = genus.below_m + options.depth_m * (1.0 + genus.above_m) +
                        (genus.above_m > 0.0              ? 60.0
                         : IsPlaneParallel(options.genus) ? genus.below_m
                                                          : 0.0);
  const double period_m =
      IsPlaneParallel(options.genus) ? kPlaneParallelPeriod_m : options.period_m;
  const int across = static_cast<int>(period_m / kCloudVoxel_m);
  CloudLattice lattice;
  lattice.voxels = {across, across, static_cast<int>(std::ceil(height / kCloudVoxel_m))};
  lattice.voxel_m = glm::dvec3(kCloudVoxel_m);
  lattice.origin_m = {0.0, 0.0, options.base_altitude_m - genus.below_m};
  return lattice;
}

CloudField MakeCloudField(const CloudOptions& options, double time_s) {
  CheckCloudOptions(options);
  RequireInRange(time_s, 0.0, 1e7, "the time of a field of clouds [s]");
  const CloudField field = FieldOfMatter(options, MatterOf(options), time_s);
  if (!options.optical_depth) return field.Moved(time_s * options.wind_m_per_s);
  const double own = PlaneParallelDepths(field).whole();
  CloudMatter matter = MatterOf(options);
  matter.column = matter.column.Times(*options.optical_depth / own);
  return FieldOfMatter(options, matter, time_s).Moved(time_s * options.wind_m_per_s);
}

}  // namespace alpenglow::renderer
