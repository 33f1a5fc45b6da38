// SPDX-License-Identifier: MIT
#include "lut/picture/dither.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "lut/picture/dither_text.h"

namespace alpenglow::lut {
namespace {

constexpr int kSize = kDitherTileSize;
constexpr int kCells = kSize * kSize;

/// Gaussian of the distance on the torus, sigma 1.9 pixels (Ulichney's 1.5 leaves more low
/// frequencies in tiles this small), in integers so that sums are exact.
std::vector<int> DitherKernel() {
  std::vector<int> kernel(kCells);
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const double dx = std::min(x, kSize - x);
      const double dy = std::min(y, kSize - y);
      const double gauss = std::exp(-(dx * dx + dy * dy) / (2.0 * 1.9 * 1.9));
      kernel[static_cast<std::size_t>(y * kSize + x)] = static_cast<int>(std::lround(1e6 * gauss));
    }
  }
  return kernel;
}

/// A pattern of points on the torus and how crowded every cell is.
class Pattern {
 public:
  Pattern() : kernel_(DitherKernel()), crowding_(kCells, 0), set_(kCells, false) {}

  void Add(int cell) { Change(cell, true, 1); }
  void Remove(int cell) { Change(cell, false, -1); }

  [[nodiscard]] int TightestCluster() const { return Extreme(true, 1); }
  [[nodiscard]] int LargestVoid() const { return Extreme(false, -1); }

 private:
  void Change(int cell, bool set, int sign) {
    set_[static_cast<std::size_t>(cell)] = set;
    const int x0 = cell % kSize;
    const int y0 = cell / kSize;
    for (int y = 0; y < kSize; ++y) {
      const int row = (y - y0 + kSize) % kSize * kSize;
      for (int x = 0; x < kSize; ++x) {
        crowding_[static_cast<std::size_t>(y * kSize + x)] +=
            sign * kernel_[static_cast<std::size_t>(row + (x - x0 + kSize) % kSize)];
      }
    }
  }
  /// The cell with `set` of the largest sign * crowding, the first of equal ones.
  [[nodiscard]] int Extreme(bool set, int sign) const {
    int best = -1;
    for (int i = 0; i < kCells; ++i) {
      const auto cell = static_cast<std::size_t>(i);
      if (set_[cell] != set) continue;
      if (best < 0 || sign * crowding_[cell] > sign * crowding_[static_cast<std::size_t>(best)]) {
        best = i;
      }
    }
    return best;
  }

  std::vector<int> kernel_, crowding_;
  std::vector<bool> set_;
};

/// A tenth of the cells at random. (Regular starts, lattices among them, survive the relaxation and
/// correlate the tile with its shifted copies.)
std::vector<int> FirstPoints() {
  std::mt19937 random(20260621);  // the same sequence on every machine (ISO C++ [rand.predef])
  std::vector<int> cells;
  while (cells.size() < kCells / 10) {
    const auto cell = static_cast<int>(random() % kCells);
    if (std::find(cells.begin(), cells.end(), cell) == cells.end()) cells.push_back(cell);
  }
  return cells;
}

/// Moves points from clusters into voids until nothing improves.
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
  // Crowding by points plus crowding by gaps is the same everywhere, so the largest void of the
  // points is also the tightest cluster of the gaps: one loop does both of Ulichney's last phases.
  for (std::size_t points = first.size(); points < kCells; ++points) {
    const int cell = pattern.LargestVoid();
    pattern.Add(cell);
    rank[static_cast<std::size_t>(cell)] = static_cast<std::uint16_t>(points);
  }
  return rank;
}

/// Inverse cumulative distribution of the triangle on (-1, 1). @param u in (0, 1).
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
