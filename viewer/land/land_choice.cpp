// SPDX-License-Identifier: MIT
#include "viewer/land/land_choice.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace alpenglow::viewer {
namespace {

// Returns the distance of the horizon from a height, over a sphere a little larger than the earth
// [m].
double HorizonDistance(double height_m) {
  constexpr double kRadius_m = 6.4e6;
  const double above = std::max(height_m, 0.0);
  return std::sqrt(above * (above + 2.0 * kRadius_m));
}

// Returns the distance that each level reaches. The reach of each available level grows gradually,
// from coarse to fine.
std::vector<double> ReachAfter(const LandChoiceOrder& order, const LandDemand& demand) {
  constexpr double kReachTime_s = 0.7;  // time for a new level to reach its full range
  std::vector<double> reach_m = order.reach_m;
  reach_m.resize(static_cast<std::size_t>(order.tree->top()) + 1, 0.0);
  for (std::size_t level = 0; level < reach_m.size(); ++level) {
    const double full_m = order.detail * std::sqrt(order.eye.size.column_m * order.eye.size.row_m) *
                          std::exp2(static_cast<double>(level));
    const double grown_m = reach_m[level] + full_m * order.seconds / kReachTime_s;
    reach_m[level] = std::min(demand.reach_m[level], grown_m);
  }
  return reach_m;
}

// Returns the next ceiling. The ground around the eye is as high as any chunk near it, minus its
// distance.
std::optional<double> CeilingOver(const std::vector<DrawnChunk>& around,
                                  const LandChoiceOrder& order) {
  constexpr double kTime_s = 0.3;
  double highest = -1e9;
  for (const DrawnChunk& near : around) {
    const ChunkSet::Kept* const kept = order.set->Find(near.key);
    if (kept == nullptr || kept->chunk->triangles.empty()) continue;
    highest = std::max(highest, kept->chunk->highest_m - near.beside_m);
  }
  if (highest < -1e8) return order.ceiling_m;
  const double share = order.ceiling_m ? 1.0 - std::exp(-order.seconds / kTime_s) : 1.0;
  // lerp() reaches its end exactly. A running sum would keep changing by rounding, and
  // Landscape::WaitUntilReady would not end.
  return std::lerp(order.ceiling_m.value_or(highest), highest, share);
}

std::vector<SeenChunk> OnGpu(const std::vector<DrawnChunk>& around, const ChunkSet& set) {
  std::vector<SeenChunk> there;
  for (const DrawnChunk& near : around) {
    const ChunkSet::Kept* const kept = set.Find(near.key);
    if (kept == nullptr || kept->slot < 0) continue;
    there.push_back({kept->slot, kept->chunk.get(), near.coarse_sides});
  }
  return there;
}

}  // namespace

double SightFrom(double height_m) {
  constexpr double kHighestGround_m = 9000.0;
  return HorizonDistance(height_m) + HorizonDistance(kHighestGround_m);
}

LandChoice ChooseLand(const LandChoiceOrder& order) {
  constexpr double kHigh_m = 5000.0;  // over all ground nearby; little is hidden from there
  const auto is_there = [&](const ChunkKey& key) { return order.set->Has(key); };
  LandChoice choice;
  choice.demand = DemandOf(*order.tree, order.eye, order.detail, is_there);
  choice.reach_m = ReachAfter(order, choice.demand);
  choice.ranges = RangesOf(choice.reach_m, order.eye);
  const std::vector<DrawnChunk> around =
      DrawnChunks(*order.tree, order.eye, choice.ranges, is_there);
  std::vector<SeenChunk> there = OnGpu(around, *order.set);
  const FrameTransform eye(order.set->anchor().frame, LocalFrame(order.ellipsoid, order.place));
  choice.farthest_m = FarthestOf(there, eye);
  choice.ceiling_m = CeilingOver(around, order);
  choice.drawn = InView(std::move(there), eye, order.view);
  if (order.is_over_ground && order.eye.above_m < kHigh_m)
    choice.drawn = WithoutHidden(choice.drawn, eye, order.view.bends_per_m);
  return choice;
}

}  // namespace alpenglow::viewer
