// SPDX-License-Identifier: MIT
#include "renderer/procedural_mountains/erosion.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <numeric>
#include <queue>
#include <utility>

#include "renderer/procedural_mountains/lattice_noise.h"

namespace alpenglow::renderer {
namespace {

constexpr float kFillSlope_m = 1e-3F;  // sediment rises by this much from sample to sample

// Converts heights above -20 km to integers with equal sort order.
std::uint32_t HeightKey(float height_m) {
  return std::bit_cast<std::uint32_t>(height_m + 20000.0F);
}

// Returns the sort key of the flood: by height, then by sample.
std::uint64_t FloodKey(float height_m, std::size_t sample) {
  return (static_cast<std::uint64_t>(HeightKey(height_m)) << 32) | sample;
}
std::uint32_t QueuedSample(std::uint64_t key) {
  return static_cast<std::uint32_t>(key & 0xffffffffU);
}

struct Offset {
  int row;
  int column;
};
constexpr std::array<Offset, 8> kNeighbours{
    {{-1, -1}, {-1, 0}, {-1, 1}, {0, -1}, {0, 1}, {1, -1}, {1, 0}, {1, 1}}};

// Returns the keys of all samples in ascending order without comparisons: digit by digit, the
// lowest first (radix sort; equal digits keep the order of their samples).
std::vector<std::uint64_t> SortedKeys(const std::vector<float>& height_m) {
  constexpr int kDigitBits = 11;
  constexpr std::uint32_t kDigits = 1U << kDigitBits;
  const auto [low, high] = std::minmax_element(height_m.begin(), height_m.end());
  const std::uint32_t lowest = HeightKey(*low);
  const std::uint32_t span = HeightKey(*high) - lowest;
  std::vector<std::uint64_t> keys(height_m.size());
  for (std::size_t i = 0; i < keys.size(); ++i) keys[i] = FloodKey(height_m[i], i);
  std::vector<std::uint64_t> sorted(keys.size());
  for (int shift = 0; shift < 32 && span >> shift != 0; shift += kDigitBits) {
    const auto digit = [&](std::uint64_t key) {
      return ((static_cast<std::uint32_t>(key >> 32) - lowest) >> shift) & (kDigits - 1);
    };
    std::array<std::uint32_t, kDigits> place{};
    for (const std::uint64_t key : keys) ++place[digit(key)];
    std::exclusive_scan(place.begin(), place.end(), place.begin(), 0U);
    for (const std::uint64_t key : keys) sorted[place[digit(key)]++] = key;
    keys.swap(sorted);
  }
  return keys;
}

// A flood that rises from the rim and visits every sample after one that the sample can flow to.
// The order is that of a queue of all reached samples, lowest first. A sample that is reached
// before the flood has passed its own height, and is not filled, has its queue position in the
// sorted list of all samples. Only the others (in basins) need a separate queue.
class Flood {
 public:
  explicit Flood(Land& land) : land_(land), state_(land.height_m.size(), kUnreached) {
    order_.reserve(land.height_m.size());
  }

  // Fills the land and returns all samples, each after the one from which the flood reached it.
  std::vector<std::uint32_t> Run() {
    ReachRim();
    for (const std::uint64_t key : SortedKeys(land_.height_m)) {
      while (!basins_.empty() && basins_.top() < key) VisitBasin();
      const std::uint32_t sample = QueuedSample(key);
      if (state_[sample] == kReached) VisitInside(sample);
      if (state_[sample] == kOnRim) VisitRim(sample);
      if (state_[sample] == kUnreached) state_[sample] = kPassed;
    }
    while (!basins_.empty()) VisitBasin();
    return std::move(order_);
  }

 private:
  // One bit marks the two states that wait for the flood.
  static constexpr std::uint8_t kWaiting = 0x80;
  static constexpr std::uint8_t kUnreached = kWaiting;
  static constexpr std::uint8_t kPassed = kWaiting | 1;  // the flood is above its own height
  static constexpr std::uint8_t kReached = 0;
  static constexpr std::uint8_t kInBasin = 1;
  static constexpr std::uint8_t kOnRim = 2;

  void ReachRim() {
    const int last = land_.size - 1;
    for (int i = 0; i < land_.size; ++i) {
      for (const std::size_t sample :
           {land_.index(0, i), land_.index(last, i), land_.index(i, 0), land_.index(i, last)})
        state_[sample] = kOnRim;
    }
  }

  void VisitBasin() {
    const std::uint32_t sample = QueuedSample(basins_.top());
    basins_.pop();
    VisitInside(sample);
  }

  void VisitRim(std::uint32_t sample) {
    order_.push_back(sample);
    const int row = static_cast<int>(sample) / land_.size;
    const int column = static_cast<int>(sample) % land_.size;
    for (int r = std::max(row - 1, 0); r <= std::min(row + 1, land_.size - 1); ++r) {
      for (int c = std::max(column - 1, 0); c <= std::min(column + 1, land_.size - 1); ++c)
        Reach(land_.index(r, c), land_.height_m[sample] + kFillSlope_m);
    }
  }

  void VisitInside(std::uint32_t sample) {
    order_.push_back(sample);
    const float filled = land_.height_m[sample] + kFillSlope_m;
    const auto size = static_cast<std::size_t>(land_.size);
    for (const std::size_t middle : {sample - size, std::size_t{sample}, sample + size}) {
      const std::uint8_t* const state = &state_[middle - 1];
      if (((state[0] | state[1] | state[2]) & kWaiting) == 0) continue;
      for (std::size_t next = middle - 1; next <= middle + 1; ++next) Reach(next, filled);
    }
  }

  void Reach(std::size_t sample, float filled) {
    if ((state_[sample] & kWaiting) == 0) return;
    float& height = land_.height_m[sample];
    if (state_[sample] == kUnreached && height >= filled) {
      state_[sample] = kReached;
      return;
    }
    height = std::max(height, filled);
    state_[sample] = kInBasin;
    basins_.push(FloodKey(height, sample));
  }

  Land& land_;
  std::vector<std::uint8_t> state_;
  std::vector<std::uint32_t> order_;
  std::priority_queue<std::uint64_t, std::vector<std::uint64_t>, std::greater<>> basins_;
};

// Finds the neighbour to which every sample flows: the steepest descent among neighbours that the
// flood reached earlier. Samples of the rim are their own receivers. Neighbours in one direction
// are processed for a whole row at a time, in loops that compilers can vectorise.
class Receivers {
 public:
  Receivers(const Land& land, const ScatteredSamples& scattered, Drainage& drainage)
      : land_(land), scattered_(scattered), drainage_(drainage), rank_(land.height_m.size()) {
    for (std::size_t i = 0; i < rank_.size(); ++i)
      rank_[drainage.order[i]] = static_cast<std::int32_t>(i);
    drainage_.receiver.resize(rank_.size());
    std::iota(drainage_.receiver.begin(), drainage_.receiver.end(), 0U);
    drainage_.distance_m.assign(rank_.size(), 0.0F);
    tbb::parallel_for(1, std::max(land.size - 1, 1), [&](int row) { FindOfRow(row); });
  }

 private:
  // For a row without its ends: the slope to the best neighbour, and the index of that neighbour.
  struct Best {
    std::vector<float> slope;
    std::vector<std::uint32_t> neighbour;  // in kNeighbours
  };

  void FindOfRow(int row) const {
    const auto width = static_cast<std::size_t>(land_.size - 2);
    const std::size_t first = land_.index(row, 1);
    Best best{std::vector<float>(width, -1.0F), std::vector<std::uint32_t>(width, 0)};
    std::array<const float*, kNeighbours.size()> distance;
    std::array<std::int32_t, kNeighbours.size()> step;
    for (std::uint32_t k = 0; k < kNeighbours.size(); ++k) {
      step[k] = kNeighbours[k].row * land_.size + kNeighbours[k].column;
      distance[k] = scattered_.Distances(first, kNeighbours[k].row, kNeighbours[k].column);
      TakeSteeper(first, step[k], distance[k], k, best);
    }
    for (std::size_t i = 0; i < width; ++i) {
      const std::uint32_t k = best.neighbour[i];
      drainage_.receiver[first + i] += static_cast<std::uint32_t>(step[k]);
      drainage_.distance_m[first + i] = distance[k][i] * static_cast<float>(land_.spacing_m);
    }
  }

  void TakeSteeper(std::size_t first, std::int32_t step, const float* distance,
                   std::uint32_t neighbour, Best& best) const {
    const float* const height = &land_.height_m[first];
    const float* const next_height = height + step;
    const std::int32_t* const rank = &rank_[first];
    const std::int32_t* const next_rank = rank + step;
    float* const best_slope = best.slope.data();
    std::uint32_t* const best_neighbour = best.neighbour.data();
    const std::size_t width = best.slope.size();
    // Masks are used because the compiler does not vectorise conditions.
    for (std::size_t i = 0; i < width; ++i) {
      const float slope = (height[i] - next_height[i]) / distance[i];
      const std::uint32_t is_steeper = slope > best_slope[i] ? ~0U : 0U;
      const std::uint32_t is_reached = next_rank[i] < rank[i] ? ~0U : 0U;
      const std::uint32_t take = is_steeper & is_reached;
      const auto known = std::bit_cast<std::uint32_t>(best_slope[i]);
      const auto found = std::bit_cast<std::uint32_t>(slope);
      best_slope[i] = std::bit_cast<float>(known ^ ((known ^ found) & take));
      best_neighbour[i] ^= (best_neighbour[i] ^ neighbour) & take;
    }
  }

  const Land& land_;
  const ScatteredSamples& scattered_;
  Drainage& drainage_;
  std::vector<std::int32_t> rank_;  // position in the flood's order
};

void AccumulateArea(Drainage& drainage, double spacing_m) {
  drainage.area_m2.assign(drainage.order.size(), static_cast<float>(spacing_m * spacing_m));
  for (auto sample = drainage.order.rbegin(); sample != drainage.order.rend(); ++sample) {
    const std::uint32_t receiver = drainage.receiver[*sample];
    if (receiver != *sample) drainage.area_m2[receiver] += drainage.area_m2[*sample];
  }
}

// Returns A^m with m = 3/8, computed from square roots only, which IEEE arithmetic rounds
// identically everywhere.
float StreamPower(float area_m2) {
  const float fourth_root = std::sqrt(std::sqrt(area_m2));
  return fourth_root * std::sqrt(fourth_root);
}

// Values of a sample's step that do not depend on the new height of its receiver. They are stored
// together because samples are visited in the scattered order of the rivers.
struct Incision {
  float risen_m;
  float pull;
  float steepest_m;  // above the receiver
  std::uint32_t receiver;
};

std::vector<Incision> IncisionsOf(const Land& land, const Rock& rock, const Drainage& drainage) {
  std::vector<Incision> incisions(land.height_m.size());
  const auto of_sample = [&](std::size_t i) {
    const float distance = drainage.distance_m[i];
    incisions[i] = {land.height_m[i] + rock.uplift_m_per_step[i],
                    rock.erodibility_per_step[i] * StreamPower(drainage.area_m2[i]) / distance,
                    rock.steepest_slope[i] * distance, drainage.receiver[i]};
  };
  tbb::parallel_for(0, land.size, [&](int row) {
    for (int column = 0; column < land.size; ++column) of_sample(land.index(row, column));
  });
  return incisions;
}

}  // namespace

ScatteredSamples::ScatteredSamples(int size, std::uint32_t seed) : size_(size) {
  constexpr double kScatter = 2.0 / 3.0;
  const std::size_t samples = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
  std::vector<float> x(samples), y(samples);
  const auto scatter = [&](std::size_t i, int row, int column) {
    const std::uint32_t hash = LatticeHash(column, row, seed);
    const double dx = static_cast<double>(hash & 0xffffU) / 65536.0 - 0.5;
    const double dy = static_cast<double>(hash >> 16) / 65536.0 - 0.5;
    x[i] = static_cast<float>(column + kScatter * dx);
    y[i] = static_cast<float>(row + kScatter * dy);
  };
  const auto width = static_cast<std::size_t>(size);
  tbb::parallel_for(0, size, [&](int row) {
    for (int column = 0; column < size; ++column)
      scatter(static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column), row,
              column);
  });
  // The last samples in a direction have no neighbour there; their distance is never read.
  const auto measure = [&](std::vector<float>& distances, std::size_t to_neighbour) {
    distances.resize(samples, 0.0F);
    tbb::parallel_for(std::size_t{0}, width, [&](std::size_t row) {
      const std::size_t end = std::min((row + 1) * width, samples - to_neighbour);
      for (std::size_t i = row * width; i < end; ++i) {
        const float dx = x[i] - x[i + to_neighbour];
        const float dy = y[i] - y[i + to_neighbour];
        distances[i] = std::sqrt(dx * dx + dy * dy);
      }
    });
  };
  measure(to_east_, 1);
  measure(to_south_west_, width - 1);
  measure(to_south_, width);
  measure(to_south_east_, width + 1);
}

const float* ScatteredSamples::Distances(std::size_t first, int rows, int columns) const {
  // A distance is stored with the northern, or western, of its two samples.
  const bool is_kept_here = rows > 0 || (rows == 0 && columns > 0);
  const std::ptrdiff_t step = static_cast<std::ptrdiff_t>(rows) * size_ + columns;
  const std::vector<float>& kept = rows == 0                     ? to_east_
                                   : columns == 0                ? to_south_
                                   : (rows > 0) == (columns > 0) ? to_south_east_
                                                                 : to_south_west_;
  return kept.data() + first + (is_kept_here ? 0 : step);
}

Drainage DrainAndFill(Land& land, const ScatteredSamples& scattered) {
  Drainage drainage;
  drainage.order = Flood(land).Run();
  Receivers(land, scattered, drainage);
  AccumulateArea(drainage, land.spacing_m);
  return drainage;
}

void ErodeOnce(Land& land, const Rock& rock, const ScatteredSamples& scattered) {
  const Drainage drainage = DrainAndFill(land, scattered);
  const std::vector<Incision> incisions = IncisionsOf(land, rock, drainage);
  for (const std::uint32_t sample : drainage.order) {
    const Incision& incision = incisions[sample];
    if (incision.receiver == sample) continue;
    const float below = land.height_m[incision.receiver];
    const float cut = (incision.risen_m + incision.pull * below) / (1.0F + incision.pull);
    land.height_m[sample] = std::min(std::max(cut, below), below + incision.steepest_m);
  }
}

void FillValleys(Land& land, float floor_slope, const std::vector<float>& deepest_m,
                 const ScatteredSamples& scattered) {
  constexpr float kRiverArea_m2 = 4e6F;
  constexpr float kGravelPerRootArea = 8e-3F;  // depth [m] per root of the drained area [m]
  const Drainage drainage = DrainAndFill(land, scattered);
  std::vector<float> floor = land.height_m;
  for (const std::uint32_t sample : drainage.order) {
    const std::uint32_t receiver = drainage.receiver[sample];
    if (receiver == sample) continue;
    const float area = drainage.area_m2[sample];
    const float deepest = area > kRiverArea_m2
                              ? std::min(deepest_m[sample], kGravelPerRootArea * std::sqrt(area))
                              : deepest_m[sample];
    const float level = floor[receiver] + floor_slope * drainage.distance_m[sample];
    // The floor is never below that of its receiver, so that gravel ends gently and not in a dam.
    const float lowest = std::max(land.height_m[sample], floor[receiver]);
    floor[sample] = std::clamp(level, lowest, std::max(lowest, land.height_m[sample] + deepest));
  }
  land.height_m = std::move(floor);
}

}  // namespace alpenglow::renderer
