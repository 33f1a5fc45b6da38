// SPDX-License-Identifier: MIT
// The choice of the chunks that an eye needs, and of those that it sees. It takes most of the land's
// processor time in a frame, so that a worker thread makes it while the drawing thread prepares the
// other parts of the frame.
#pragma once

#include <optional>
#include <vector>

#include "renderer/terrain/level_ranges.h"
#include "renderer/terrain/seen_chunks.h"
#include "viewer/land/chunk_set.h"

namespace alpenglow::viewer {

/// Returns the distance of the farthest ground that may be visible from a height [m].
[[nodiscard]] double SightFrom(double height_m);

/// An eye over loaded land. While the choice is made, the set must not change and no other thread
/// may use the tree.
struct LandChoiceOrder {
  const ChunkTree* tree;
  const ChunkSet* set;
  Ellipsoid ellipsoid;
  Place place;
  LandEye eye;
  LandView view;
  double detail;                    // range of level 0 in samples
  bool is_over_ground;              // whether the eye is above the ground under it
  std::vector<double> reach_m;      // LandChoice::reach_m of the frame before; empty: the first
  std::optional<double> ceiling_m;  // LandChoice::ceiling_m of the frame before
  double seconds;                   // time since that frame
};

/// The chunks to draw in a frame.
struct LandChoice {
  LandDemand demand;                // chunks that the eye needs
  std::vector<double> reach_m;      // of each level; levels reach their range gradually
  std::vector<LevelRange> ranges;   // by these reaches
  std::vector<SeenChunk> drawn;     // in view
  double farthest_m = 0.0;          // no chunk around the eye, in view or not, is farther
  std::optional<double> ceiling_m;  // height of the ground around the eye, over the ellipsoid
};

[[nodiscard]] LandChoice ChooseLand(const LandChoiceOrder& order);

}  // namespace alpenglow::viewer
