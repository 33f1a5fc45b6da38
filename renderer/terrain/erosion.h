// SPDX-License-Identifier: MIT
// Rivers that cut a rising land: the stream-power law on the land's own drainage tree.
//
//   dh/dt = U - K A^m dh/ds        Whipple and Tucker (1999), J. Geophys. Res. 104, with m = 3/8
//
// U uplift, K erodibility, A drainage area, s along the flow. Solved implicitly from the outlets
// upstream, which is stable for any step and O(n): Braun and Willett (2013), Geomorphology
// 180-181, 170-179. The tree comes from a priority flood (Barnes, Lehman, Mulla 2014, Computers &
// Geosciences 62), which also fills closed basins with sediment. Rock that would stand steeper
// than its angle of repose slides.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "renderer/terrain/land.h"

namespace alpenglow::renderer {

/// What drives and resists, one value a sample.
struct Rock {
  std::vector<float> uplift_m_per_step;
  std::vector<float> erodibility_per_step;  // K dt [m^(1 - 2m)]
  std::vector<float> steepest_slope;        // tangent of the angle of repose
};

/// The samples of a square grid, each moved by up to a third of the spacing when distances are
/// taken, so that rivers do not follow the axes of the grid.
class ScatteredSamples {
 public:
  /// @param size  samples a side.
  ScatteredSamples(int size, std::uint32_t seed);

  /// Distances [samples] between consecutive samples of a row, `first` at their head, and those
  /// `rows` south and `columns` east of them; both in {-1, 0, 1}, not both 0.
  [[nodiscard]] const float* Distances(std::size_t first, int rows, int columns) const;

 private:
  int size_;
  std::vector<float> to_east_, to_south_west_, to_south_, to_south_east_;
};

/// Where water goes. The rim is the outlet: its samples are their own receivers.
struct Drainage {
  std::vector<std::uint32_t> order;     // every sample after its receiver
  std::vector<std::uint32_t> receiver;  // the neighbour it flows to
  std::vector<float> distance_m;        // to the receiver
  std::vector<float> area_m2;           // drained through the sample, its own included
};

/// The drainage tree of a land; closed basins are filled to their outlets on the way.
[[nodiscard]] Drainage DrainAndFill(Land& land, const ScatteredSamples& scattered);

/// One implicit step of uplift, river incision and slides. The rim stays where it is.
void ErodeOnce(Land& land, const Rock& rock, const ScatteredSamples& scattered);

/// Valley floors: rivers fill their valleys with gravel, at most `deepest_m` (one value a sample)
/// high, as long as the floor rises upstream by no more than `floor_slope`; where the rock rises
/// faster the river runs on it.
void FillValleys(Land& land, float floor_slope, const std::vector<float>& deepest_m,
                 const ScatteredSamples& scattered);

}  // namespace alpenglow::renderer
