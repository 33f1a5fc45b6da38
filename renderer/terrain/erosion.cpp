// SPDX-License-Identifier: MIT
#include "renderer/terrain/erosion.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "renderer/terrain/lattice_noise.h"

namespace alpenglow {
namespace {

constexpr float kFillSlope_m = 1e-3F;  // sediment rises by this much from sample to sample
constexpr std::uint32_t kUnseen = std::numeric_limits<std::uint32_t>::max();

// Heights above -20 km as keys that sort like the heights, and then by sample.
std::uint64_t FloodKey(float height_m, std::uint32_t sample) {
  return (static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(height_m + 20000.0F)) << 32) |
         sample;
}

struct Offset {
  int row;
  int column;
};
constexpr std::array<Offset, 8> kNeighbours{
    {{-1, -1}, {-1, 0}, {-1, 1}, {0, -1}, {0, 1}, {1, -1}, {1, 0}, {1, 1}}};

// Sample positions in samples, scattered.
class ScatteredSamples {
 public:
  ScatteredSamples(int size, std::uint32_t seed) {
    constexpr double kScatter = 2.0 / 3.0;
    position_.reserve(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
    for (int row = 0; row < size; ++row) {
      for (int column = 0; column < size; ++column) {
        const std::uint32_t hash = LatticeHash(column, row, seed);
        const double dx = static_cast<double>(hash & 0xffffU) / 65536.0 - 0.5;
        const double dy = static_cast<double>(hash >> 16) / 65536.0 - 0.5;
        position_.push_back(
            {static_cast<float>(column + kScatter * dx), static_cast<float>(row + kScatter * dy)});
      }
    }
  }
  [[nodiscard]] float Distance(std::size_t a, std::size_t b) const {
    const float dx = position_[a][0] - position_[b][0];
    const float dy = position_[a][1] - position_[b][1];
    return std::sqrt(dx * dx + dy * dy);
  }

 private:
  std::vector<std::array<float, 2>> position_;
};

// The flood that rises from the rim and visits every sample after one that it can flow to.
class Flood {
 public:
  Flood(Land& land, std::uint32_t seed)
      : land_(land), scattered_(land.size, seed), visited_(land.height_m.size(), false) {
    drainage_.order.reserve(land.height_m.size());
    drainage_.receiver.assign(land.height_m.size(), kUnseen);
    drainage_.distance_m.assign(land.height_m.size(), 0.0F);
  }

  Drainage Run() {
    PushRim();
    while (!front_.empty()) {
      const auto sample = static_cast<std::uint32_t>(front_.top() & 0xffffffffU);
      front_.pop();
      Visit(sample);
    }
    return std::move(drainage_);
  }

 private:
  void PushRim() {
    const int last = land_.size - 1;
    for (int i = 0; i < land_.size; ++i) {
      for (const std::size_t sample :
           {land_.index(0, i), land_.index(last, i), land_.index(i, 0), land_.index(i, last)}) {
        if (drainage_.receiver[sample] != kUnseen) continue;
        drainage_.receiver[sample] = static_cast<std::uint32_t>(sample);
        front_.push(FloodKey(land_.height_m[sample], static_cast<std::uint32_t>(sample)));
      }
    }
  }

  // Fixes where a sample flows to (the steepest way among samples that already know theirs) and
  // lets the flood reach its neighbours.
  void Visit(std::uint32_t sample) {
    const int row = static_cast<int>(sample) / land_.size;
    const int column = static_cast<int>(sample) % land_.size;
    const float height = land_.height_m[sample];
    const bool is_rim = drainage_.receiver[sample] == sample;
    float steepest = -1.0F;
    for (const Offset& offset : kNeighbours) {
      const int r = row + offset.row;
      const int c = column + offset.column;
      if (r < 0 || c < 0 || r >= land_.size || c >= land_.size) continue;
      const std::size_t next = land_.index(r, c);
      if (visited_[next]) {
        if (is_rim) continue;
        const float distance = scattered_.Distance(sample, next);
        const float slope = (height - land_.height_m[next]) / distance;
        if (slope > steepest) {
          steepest = slope;
          drainage_.receiver[sample] = static_cast<std::uint32_t>(next);
          drainage_.distance_m[sample] = distance * static_cast<float>(land_.spacing_m);
        }
      } else if (drainage_.receiver[next] == kUnseen) {
        drainage_.receiver[next] = sample;
        land_.height_m[next] = std::max(land_.height_m[next], height + kFillSlope_m);
        front_.push(FloodKey(land_.height_m[next], static_cast<std::uint32_t>(next)));
      }
    }
    visited_[sample] = true;
    drainage_.order.push_back(sample);
  }

  Land& land_;
  ScatteredSamples scattered_;
  std::vector<bool> visited_;
  Drainage drainage_;
  std::priority_queue<std::uint64_t, std::vector<std::uint64_t>, std::greater<>> front_;
};

void AccumulateArea(Drainage& drainage, double spacing_m) {
  drainage.area_m2.assign(drainage.order.size(), static_cast<float>(spacing_m * spacing_m));
  for (auto sample = drainage.order.rbegin(); sample != drainage.order.rend(); ++sample) {
    const std::uint32_t receiver = drainage.receiver[*sample];
    if (receiver != *sample) drainage.area_m2[receiver] += drainage.area_m2[*sample];
  }
}

// A^m with m = 3/8 from square roots alone, which IEEE arithmetic rounds the same everywhere.
float StreamPower(float area_m2) {
  const float fourth_root = std::sqrt(std::sqrt(area_m2));
  return fourth_root * std::sqrt(fourth_root);
}

}  // namespace

Drainage DrainAndFill(Land& land, std::uint32_t seed) {
  Drainage drainage = Flood(land, seed).Run();
  AccumulateArea(drainage, land.spacing_m);
  return drainage;
}

void ErodeOnce(Land& land, const Rock& rock, std::uint32_t seed) {
  const Drainage drainage = DrainAndFill(land, seed);
  for (const std::uint32_t sample : drainage.order) {
    const std::uint32_t receiver = drainage.receiver[sample];
    if (receiver == sample) continue;
    const float below = land.height_m[receiver];
    const float distance = drainage.distance_m[sample];
    const float pull =
        rock.erodibility_per_step[sample] * StreamPower(drainage.area_m2[sample]) / distance;
    const float risen = land.height_m[sample] + rock.uplift_m_per_step[sample];
    const float cut = (risen + pull * below) / (1.0F + pull);
    land.height_m[sample] =
        std::min(std::max(cut, below), below + rock.steepest_slope[sample] * distance);
  }
}

void FillValleys(Land& land, float floor_slope, const std::vector<float>& deepest_m,
                 std::uint32_t seed) {
  constexpr float kRiverArea_m2 = 4e6F;
  constexpr float kGravelPerRootArea = 8e-3F;  // depth [m] by the root of the drained area [m]
  const Drainage drainage = DrainAndFill(land, seed);
  std::vector<float> floor = land.height_m;
  for (const std::uint32_t sample : drainage.order) {
    const std::uint32_t receiver = drainage.receiver[sample];
    if (receiver == sample) continue;
    const float area = drainage.area_m2[sample];
    const float deepest = area > kRiverArea_m2
                              ? std::min(deepest_m[sample], kGravelPerRootArea * std::sqrt(area))
                              : deepest_m[sample];
    const float level = floor[receiver] + floor_slope * drainage.distance_m[sample];
    // Never below where it flows to: gravel ends gently, not in a dam.
    const float lowest = std::max(land.height_m[sample], floor[receiver]);
    floor[sample] = std::clamp(level, lowest, std::max(lowest, land.height_m[sample] + deepest));
  }
  land.height_m = std::move(floor);
}

}  // namespace alpenglow
