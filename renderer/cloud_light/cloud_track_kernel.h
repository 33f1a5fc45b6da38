// SPDX-License-Identifier: MIT
// The innermost loop of CloudMoments, one table per instruction set: light along all tracks of one
// direction.
//
// Tracks are parallel lines, one through every column of cells on the plane where they enter, so
// that all of them have the same steps from cell to cell. A segment of length h in a cell with
// scaled extinction sigma, t = sigma h, and with a source J + g x, x along the track from the middle
// of the segment, has
//
//   mean  = J + (I - J) p + g h q,   p = (1 - e^-t) / t,   q = (p - (1 + e^-t) / 2) / t
//   I_out = I + t (J - mean)
//
// where I is the radiance that enters. The mean is exact, and the second line makes the light that
// leaves the track and the light that cells receive sum to zero.
//
// J is the source in the middle of the cell plus its slopes times the place of the segment's middle
// from there. In fields of clouds only the slope along the track counts, in bodies (CloudCells::is_body)
// those along all axes: without the others the diffusion of light is 10 % too strong in deep cells.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "atmosphere/shared_glsl/instruction_set.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Cells along x that are computed at once.
inline constexpr std::size_t kCloudLanes = 16;

/// One segment of all tracks of a direction.
struct CloudTrackStep {
  int shift;  // of columns, from the previous segment: -1, 0 or 1
  int line;   // lines from the one where the track enters
  int level;
  float length_m;  // of the segment
  float offset_m;  // of its middle from the middle of the cell, along the track
  /// These offsets along x, y and z have the mean 0 over the segments of a level, so that a cell emits
  /// what the source in its middle says.
  std::array<float, 3> offsets_m;
};

/// A run of kCloudLanes cells along x. Values of its cells are at [kCloudLanes * block].
struct CloudTrackRun {
  std::uint32_t column;  // of its first cell
  std::uint32_t block;
  bool has_cloud;  // whether a cell of it has extinction
};

/// Plain arrays that the loop reads and writes.
struct CloudTrackWork {
  const CloudTrackStep* steps;
  std::size_t step_count;
  std::size_t columns;  // of cells
  int lines;
  bool is_periodic;
  const CloudTrackRun* runs;       // by row, then by column
  const std::uint32_t* row_first;  // of each row, level * lines + line, in runs; and the end
  const float* extinction_per_m;   // scaled
  const float* source;             // J, per unit of extinction, in the middle of cells
  const float* slope_per_m;        // g
  /// Slopes of the source along x, y and z, by which it differs at the middles of segments; null: g
  /// along the track alone.
  std::array<const float*, 3> slopes_per_m;
  float* sum_m;    // the integral of the radiance along tracks is added
  float entering;  // radiance of tracks where they enter the field
  float* track;    // room for CloudTrackRoom() floats
  /// Radiance of tracks where they leave, by line and column of their last cells; null: not wanted.
  float* leaving = nullptr;
};

struct CloudTrackKernel {
  /// Follows the tracks that enter in lines [first, end). Returns the sum of the radiances with which
  /// they leave.
  double (*follow)(const CloudTrackWork& work, int first, int end);
};

ALPENGLOW_DECLARE_KERNEL(CloudTrackKernel);

/// Returns the number of floats that one line of tracks needs: its columns, and one float for every
/// shift to either side.
[[nodiscard]] constexpr std::size_t CloudTrackRoom(std::size_t columns, std::size_t shifts) {
  return columns + 2 * shifts + 2 * kCloudLanes;
}

}  // namespace alpenglow::renderer
