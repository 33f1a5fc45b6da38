// SPDX-License-Identifier: MIT
#include "renderer/relief/detailed_ground.h"

namespace alpenglow::renderer {
namespace {

constexpr int kPlacesPerAxis = 4;
constexpr double kFootprintPerSpacing = 1.0 / 6.0;

}  // namespace

DetailedGround::DetailedGround(const MetricGrid& grid, SampleMeaning meaning,
                               const MountainCover& cover)
    : cover_(cover), model_(grid, meaning), correction_(MeanRelief(), SampleMeaning::kCellMeans) {}

MetricGrid DetailedGround::MeanRelief() const {
  MetricGrid means{
      model_.columns(), model_.rows(), model_.spacing_east_m(), model_.spacing_north_m(), {}};
  const ReliefScale scale{model_.spacing_m(), kFootprintPerSpacing * model_.spacing_m()};
  for (int row = 0; row < means.rows; ++row) {
    for (int column = 0; column < means.columns; ++column) {
      double sum = 0.0;
      for (int k = 0; k < kPlacesPerAxis * kPlacesPerAxis; ++k) {
        const double x = column - 0.5 + (k % kPlacesPerAxis + 0.5) / kPlacesPerAxis;
        const double y = row - 0.5 + (k / kPlacesPerAxis + 0.5) / kPlacesPerAxis;
        const double east_m = x * means.spacing_east_m, north_m = -y * means.spacing_north_m;
        sum += ReliefAt(BlockPlaceOf<double>(east_m, north_m), model_.At(east_m, north_m), cover_,
                        scale)
                   .height_m;
      }
      means.height_m.push_back(static_cast<float>(sum / (kPlacesPerAxis * kPlacesPerAxis)));
    }
  }
  return means;
}

Relief<double> DetailedGround::At(double east_m, double north_m, double footprint_m) const {
  Relief<double> relief =
      SlopedReliefAt(BlockPlaceOf<double>(east_m, north_m), model_.At(east_m, north_m), cover_,
                     {model_.spacing_m(), footprint_m});
  const ModelAt<double> correction = correction_.At(east_m, north_m);
  relief.height_m -= correction.height_m;
  relief.slope_east -= correction.slope_east;
  relief.slope_north -= correction.slope_north;
  return relief;
}

Relief<double> DetailedGround::HeightAt(double east_m, double north_m, double footprint_m) const {
  Relief<double> relief =
      ReliefAt(BlockPlaceOf<double>(east_m, north_m), model_.At(east_m, north_m), cover_,
               {model_.spacing_m(), footprint_m});
  relief.height_m -= correction_.At(east_m, north_m).height_m;
  return relief;
}

}  // namespace alpenglow::renderer
