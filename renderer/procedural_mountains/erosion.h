// SPDX-License-Identifier: MIT
// This header provides erosion of a rising land by rivers: the stream-power law on the land's own
// drainage tree.
//
//   dh/dt = U - K A^m dh/ds        Whipple and Tucker (1999), J. Geophys. Res. 104, with m = 3/8
//
// with U uplift, K erodibility, A drainage area, s along the flow. It is solved implicitly from the
// outlets upstream, which is stable for any step and O(n): Braun and Willett (2013), Geomorphology
// 180-181, 170-179. The tree is built by a priority flood (Barnes, Lehman, Mulla 2014, Computers &
// Geosciences 62), which also fills closed basins with sediment. Rock that would be steeper than
// its angle of repose slides.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "renderer/procedural_mountains/land.h"

namespace alpenglow::renderer {

/// Uplift and resistance of the rock, one value per sample.
struct Rock {
  std::vector<float> uplift_m_per_step;
  std::vector<float> erodibility_per_step;  // K dt [m^(1 - 2m)]
  std::vector<float> steepest_slope;        // tangent of the angle of repose
};

/// The samples of a square grid. For distances each sample is moved by up to a third of the
/// spacing, so that rivers do not follow the axes of the grid.
class ScatteredSamples {
 public:
  /// @param size  samples per side.
  ScatteredSamples(int size, std::uint32_t seed);

  /// Returns the distances [samples] between consecutive samples of a row, starting at `first`, and
  /// the samples `rows` south and `columns` east of them; both in {-1, 0, 1}, not both 0.
  [[nodiscard]] const float* Distances(std::size_t first, int rows, int columns) const;

 private:
  int size_;
  std::vector<float> to_east_, to_south_west_, to_south_, to_south_east_;
};

/// Drainage tree of a land. The rim is the outlet: its samples are their own receivers.
struct Drainage {
  std::vector<std::uint32_t> order;     // every sample after its receiver
  std::vector<std::uint32_t> receiver;  // neighbour to which the sample flows
  std::vector<float> distance_m;        // to the receiver
  std::vector<float> area_m2;           // drained through the sample, including its own area
};

/// Returns the drainage tree of a land and fills closed basins to their outlets.
[[nodiscard]] Drainage DrainAndFill(Land& land, const ScatteredSamples& scattered);

/// Applies one implicit step of uplift, river incision and slides. The rim does not change.
void ErodeOnce(Land& land, const Rock& rock, const ScatteredSamples& scattered);

/// Forms valley floors: rivers fill their valleys with gravel, at most `deepest_m` high (one value
/// per sample), as long as the floor rises upstream by at most `floor_slope`. Where the rock rises
/// faster, the river runs on rock.
void FillValleys(Land& land, float floor_slope, const std::vector<float>& deepest_m,
                 const ScatteredSamples& scattered);

}  // namespace alpenglow::renderer
