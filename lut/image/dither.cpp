// SPDX-License-Identifier: MIT
#include "lut/image/dither.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>

#include "lut/image/tone_mapping.h"

namespace alpenglow::lut {
namespace {

constexpr int kSize = kDitherTileSize;
constexpr int kCells = kSize * kSize;

// Points farther away than this along x or y add less than half a unit of the kernel, which is 0.
constexpr int kReach = 10;
constexpr int kKernelSide = 2 * kReach + 1;

/// Returns a Gaussian of the distance, sigma 1.9 pixels (Ulichney's 1.5 leaves more low frequencies
/// in tiles this small), in integers so that sums are exact. Element 0 is at (-kReach, -kReach).
std::vector<int> DitherKernel() {
  std::vector<int> kernel;
  for (int dy = -kReach; dy <= kReach; ++dy) {
    for (int dx = -kReach; dx <= kReach; ++dx) {
      const double gauss = std::exp(-static_cast<double>(dx * dx + dy * dy) / (2.0 * 1.9 * 1.9));
      kernel.push_back(static_cast<int>(std::lround(1e6 * gauss)));
    }
  }
  return kernel;
}

/// The extreme cells of a row of a pattern, each if the row has one. They are found when they are
/// needed.
struct PatternRow {
  bool is_known = false;
  std::optional<int> cluster, gap;
};

/// A pattern of points on the torus, with the crowding of every cell.
class Pattern {
 public:
  Pattern() : kernel_(DitherKernel()), crowding_(kCells, 0), set_(kCells, 0) {}

  void Add(int cell) { Change(cell, true, 1); }
  void Remove(int cell) { Change(cell, false, -1); }

  /// Returns the point with the largest crowding; of equal ones the first.
  [[nodiscard]] int TightestCluster() {
    return Extreme(&PatternRow::cluster, [](int a, int b) { return a > b; });
  }
  /// Returns the cell without a point that has the smallest crowding; of equal ones the first.
  [[nodiscard]] int LargestVoid() {
    return Extreme(&PatternRow::gap, [](int a, int b) { return a < b; });
  }

 private:
  void Change(int cell, bool set, int sign) {
    set_[static_cast<std::size_t>(cell)] = set ? 1 : 0;
    const int x0 = cell % kSize + kSize - kReach;
    const int y0 = cell / kSize + kSize - kReach;
    for (int dy = 0; dy < kKernelSide; ++dy) {
      const int y = (y0 + dy) % kSize;
      rows_[static_cast<std::size_t>(y)].is_known = false;
      int* const row = crowding_.data() + y * kSize;
      const int* const kernel = kernel_.data() + dy * kKernelSide;
      for (int dx = 0; dx < kKernelSide; ++dx) row[(x0 + dx) % kSize] += sign * kernel[dx];
    }
  }
  [[nodiscard]] PatternRow ExtremesOfRow(int y) const {
    PatternRow row;
    row.is_known = true;
    const int* const crowding = crowding_.data();
    for (int cell = y * kSize; cell < (y + 1) * kSize; ++cell) {
      if (set_[static_cast<std::size_t>(cell)] != 0) {
        if (!row.cluster || crowding[cell] > crowding[*row.cluster]) row.cluster = cell;
      } else if (!row.gap || crowding[cell] < crowding[*row.gap]) {
        row.gap = cell;
      }
    }
    return row;
  }
  template <typename Exceeds>
  [[nodiscard]] int Extreme(std::optional<int> PatternRow::*of_row, const Exceeds& exceeds) {
    std::optional<int> best;
    for (int y = 0; y < kSize; ++y) {
      PatternRow& row = rows_[static_cast<std::size_t>(y)];
      if (!row.is_known) row = ExtremesOfRow(y);
      const std::optional<int> cell = row.*of_row;
      if (!cell) continue;
      if (!best || exceeds(crowding_[static_cast<std::size_t>(*cell)],
                           crowding_[static_cast<std::size_t>(*best)])) {
        best = cell;
      }
    }
    return best.value();
  }

  std::vector<int> kernel_, crowding_;
  std::vector<std::uint8_t> set_;
  std::array<PatternRow, kSize> rows_;
};

/// Returns a tenth of the cells, chosen at random. Regular starts, lattices among them, survive the
/// relaxation and correlate the tile with its shifted copies.
std::vector<int> FirstPoints() {
  std::mt19937 random(20260621);  // one sequence on every machine (ISO C++ [rand.predef])
  std::vector<int> cells;
  while (cells.size() < kCells / 10) {
    const auto cell = static_cast<int>(random() % kCells);
    if (std::find(cells.begin(), cells.end(), cell) == cells.end()) cells.push_back(cell);
  }
  return cells;
}

/// Moves points from clusters into voids until no move is an improvement.
void Relax(Pattern& pattern) {
  for (int moves = 0; moves < kCells; ++moves) {
    const int cluster = pattern.TightestCluster();
    pattern.Remove(cluster);
    const int gap = pattern.LargestVoid();
    pattern.Add(gap);
    if (gap == cluster) return;
  }
}

std::vector<std::uint16_t> VoidAndCluster() {
  Pattern pattern;
  const std::vector<int> first = FirstPoints();
  for (const int cell : first) pattern.Add(cell);
  Relax(pattern);
  std::vector<std::uint16_t> rank(kCells);
  Pattern thinned = pattern;
  for (std::size_t left = first.size(); left > 0; --left) {
    const int cell = thinned.TightestCluster();
    thinned.Remove(cell);
    rank[static_cast<std::size_t>(cell)] = static_cast<std::uint16_t>(left - 1);
  }
  // The sum of crowding by points and crowding by gaps is equal in all cells, so the largest void
  // of the points is also the tightest cluster of the gaps. One loop therefore does both of
  // Ulichney's last phases.
  for (std::size_t points = first.size(); points < kCells; ++points) {
    const int cell = pattern.LargestVoid();
    pattern.Add(cell);
    rank[static_cast<std::size_t>(cell)] = static_cast<std::uint16_t>(points);
  }
  return rank;
}

/// Returns the inverse cumulative distribution of the triangular distribution on (-1, 1). @param u
/// in (0, 1).
float Triangular(float u) {
  return u < 0.5F ? std::sqrt(2.0F * u) - 1.0F : 1.0F - std::sqrt(2.0F - 2.0F * u);
}

}  // namespace

const std::vector<std::uint16_t>& DitherTile() {
  static const std::vector<std::uint16_t> tile = VoidAndCluster();
  return tile;
}

DitherShift DitherShiftOf(int tile_x, int tile_y) {
  const std::uint32_t hash =
      shared::DitherHash(static_cast<std::uint32_t>(tile_x), static_cast<std::uint32_t>(tile_y));
  constexpr std::uint32_t kMask = kSize - 1;
  return {static_cast<int>(hash & kMask), static_cast<int>((hash >> 8) & kMask)};
}

float DitherNoise(int x, int y, int channel) {
  static const std::vector<float> noise = [] {
    std::vector<float> values;
    for (const std::uint16_t rank : DitherTile()) {
      values.push_back(Triangular((static_cast<float>(rank) + 0.5F) / kCells));
    }
    return values;
  }();
  constexpr std::array<int, 3> kShiftX = {0, 23, 47};
  constexpr std::array<int, 3> kShiftY = {0, 41, 19};
  const auto c = static_cast<std::size_t>(channel);
  const DitherShift shift = DitherShiftOf(x / kSize, y / kSize);
  const int column = (x + shift.x + kShiftX[c]) % kSize;
  const int row = (y + shift.y + kShiftY[c]) % kSize;
  return noise[static_cast<std::size_t>(row * kSize + column)];
}

std::uint8_t DitheredCode(float code, float noise) {
  return static_cast<std::uint8_t>(std::lround(shared::DitheredValue(code, noise)));
}

}  // namespace alpenglow::lut
