// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_cells.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "atmosphere/base/error.h"
#include "renderer/clouds/periodic_index.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

// Samples along each side of a cell.
constexpr int kMostSamples = 4;

/// Calls visit(x, y, z) for a place and all places within `reach` of it.
template <typename Visit>
void EachAround(const std::array<int, 3>& place, int reach, const Visit& visit) {
  for (int z = place[2] - reach; z <= place[2] + reach; ++z) {
    for (int y = place[1] - reach; y <= place[1] + reach; ++y) {
      for (int x = place[0] - reach; x <= place[0] + reach; ++x) visit(x, y, z);
    }
  }
}

/// Returns the content of a cell by samples of a field.
CloudCellContent Sampled(const CloudField& field, const glm::dvec3& low, const glm::dvec3& cell_m) {
  if (field.EmptyDistance_m(low + 0.5 * cell_m) > 0.5 * glm::length(cell_m)) return {};
  std::array<int, 3> samples{};
  for (int axis = 0; axis < 3; ++axis) {
    samples[static_cast<std::size_t>(axis)] =
        std::clamp(static_cast<int>(std::lround(cell_m[axis] / field.lattice().voxel_m[axis])), 2,
                   kMostSamples);
  }
  const glm::dvec3 step_m = cell_m / glm::dvec3(samples[0], samples[1], samples[2]);
  double sum = 0.0;
  int with_cloud = 0;
  for (int z = 0; z < samples[2]; ++z) {
    for (int y = 0; y < samples[1]; ++y) {
      for (int x = 0; x < samples[0]; ++x) {
        const double per_m = field.Extinction_per_m(low + (glm::dvec3(x, y, z) + 0.5) * step_m);
        sum += per_m;
        with_cloud += per_m > 0.0 ? 1 : 0;
      }
    }
  }
  if (with_cloud == 0) return {};
  return {sum / with_cloud,
          static_cast<double>(with_cloud) / (samples[0] * samples[1] * samples[2])};
}

}  // namespace

CloudCells::CloudCells(const CloudField& field, double cell_m)
    : origin_m_(field.lattice().origin_m), is_periodic_(field.lattice().is_periodic) {
  RequireInRange(cell_m, 10.0, 10000.0, "the side of cells of light in clouds [m]");
  glm::dvec3 size_m = field.lattice().size_m();
  if (!is_periodic_) {
    const CloudBox bounds = field.Bounds();
    origin_m_ = bounds.low;
    size_m = bounds.high - bounds.low;
  }
  origin_m_.z = field.base_altitude_m();
  size_m.z = field.top_altitude_m() - origin_m_.z;
  for (int axis = 0; axis < 3; ++axis) {
    const double cells =
        std::max(axis < 2 ? 1.0 : double{kLeastLevels}, std::round(size_m[axis] / cell_m));
    count_[static_cast<std::size_t>(axis)] = static_cast<int>(cells);
    cell_m_[axis] = std::max(size_m[axis], 1e-3) / cells;
  }
  if (1.0 * count_[0] * count_[1] * count_[2] > 1e9) {
    throw InputError(fmt::format("cells of {} m are too small for a field of {} x {} m", cell_m,
                                 size_m.x, size_m.y));
  }
  Fill([&](const CloudBox& cell) { return Sampled(field, cell.low, cell.high - cell.low); });
}

CloudCells::CloudCells(const CloudCellLattice& lattice, const Content& content)
    : count_(lattice.count),
      origin_m_(lattice.origin_m),
      cell_m_(lattice.cell_m),
      is_periodic_(false),
      is_body_(true) {
  Fill(content);
  WeightNeighboursByDepth();
}

void CloudCells::Fill(const Content& content) {
  const auto places = PlaceOf(0, 0, count_[2]);
  stored_.assign(places, -1);
  std::vector<char> has_cloud(places, 0);
  std::vector<float> extinction_per_m(places, 0.0F);
  tbb::parallel_for(0, count_[1] * count_[2], [&](int row) {
    for (int x = 0; x < count_[0]; ++x) {
      const glm::dvec3 low = origin_m_ + glm::dvec3(x, row % count_[1], row / count_[1]) * cell_m_;
      const CloudCellContent samples = content({low, low + cell_m_});
      const std::size_t place = PlaceOf(x, row % count_[1], row / count_[1]);
      has_cloud[place] = samples.share > 0.0 ? 1 : 0;
      if (samples.share > 0.5) {
        extinction_per_m[place] = static_cast<float>(samples.extinction_per_m);
      }
    }
  });
  for (std::size_t place = 0; place < places; ++place) {
    if (extinction_per_m[place] <= 0.0F) continue;
    stored_[place] = static_cast<std::int32_t>(place_.size());
    place_.push_back(static_cast<std::uint32_t>(place));
    extinction_per_m_.push_back(extinction_per_m[place]);
  }
  StoreCells(has_cloud);
  FindRuns();
  FindNeighbours();
}

std::ptrdiff_t CloudCells::WrappedPlace(int x, int y, int z) const {
  if (is_periodic_) {
    x = PeriodicIndex(x, count_[0]);
    y = PeriodicIndex(y, count_[1]);
  }
  const bool is_inside =
      x >= 0 && y >= 0 && z >= 0 && x < count_[0] && y < count_[1] && z < count_[2];
  return is_inside ? static_cast<std::ptrdiff_t>(PlaceOf(x, y, z)) : -1;
}

void CloudCells::StoreCells(const std::vector<char>& has_cloud) {
  std::vector<char> is_near(has_cloud.size(), 0);
  const auto columns = static_cast<std::size_t>(count_[0]);
  const auto lines = static_cast<std::size_t>(count_[1]);
  for (std::size_t place = 0; place < has_cloud.size(); ++place) {
    if (has_cloud[place] == 0) continue;
    const std::array<int, 3> at{static_cast<int>(place % columns),
                                static_cast<int>(place / columns % lines),
                                static_cast<int>(place / columns / lines)};
    EachAround(at, 1, [&](int x, int y, int z) {
      const std::ptrdiff_t beside = WrappedPlace(x, y, z);
      if (beside >= 0) is_near[static_cast<std::size_t>(beside)] = 1;
    });
  }
  for (std::size_t place = 0; place < is_near.size(); ++place) {
    if (is_near[place] == 0 || stored_[place] >= 0) continue;
    stored_[place] = static_cast<std::int32_t>(place_.size());
    place_.push_back(static_cast<std::uint32_t>(place));
  }
}

void CloudCells::FindRuns() {
  lane_.resize(size());
  full_runs_.row_first.push_back(0);
  all_runs_.row_first.push_back(0);
  const int last_full = static_cast<int>(full()) - 1;
  for (int row = 0; row < count_[1] * count_[2]; ++row) {
    for (int column = 0; column < count_[0]; column += static_cast<int>(kCloudLanes)) {
      bool has_stored = false, has_full = false;
      const int end = std::min(column + static_cast<int>(kCloudLanes), count_[0]);
      for (int x = column; x < end; ++x) {
        const std::int32_t cell = stored_[PlaceOf(x, row % count_[1], row / count_[1])];
        if (cell < 0) continue;
        has_stored = true;
        has_full = has_full || cell <= last_full;
        lane_[static_cast<std::size_t>(cell)] = static_cast<std::uint32_t>(kCloudLanes * blocks_) +
                                                static_cast<std::uint32_t>(x - column);
      }
      if (!has_stored) continue;
      const CloudTrackRun run{static_cast<std::uint32_t>(column),
                              static_cast<std::uint32_t>(blocks_++), has_full};
      all_runs_.run.push_back(run);
      if (has_full) full_runs_.run.push_back(run);
    }
    full_runs_.row_first.push_back(static_cast<std::uint32_t>(full_runs_.run.size()));
    all_runs_.row_first.push_back(static_cast<std::uint32_t>(all_runs_.run.size()));
  }
}

void CloudCells::FindNeighbours() {
  const auto columns = static_cast<std::size_t>(count_[0]);
  const auto lines = static_cast<std::size_t>(count_[1]);
  neighbours_.resize(full());
  for (std::size_t cell = 0; cell < full(); ++cell) {
    const std::size_t place = place_[cell];
    const std::array<int, 3> at{static_cast<int>(place % columns),
                                static_cast<int>(place / columns % lines),
                                static_cast<int>(place / columns / lines)};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::array<std::uint32_t, 2> lane{lane_[cell], lane_[cell]};
      int found = 0;
      for (std::size_t side = 0; side < 2; ++side) {
        std::array<int, 3> beside = at;
        beside[axis] += side == 0 ? -1 : 1;
        const std::ptrdiff_t there = WrappedPlace(beside[0], beside[1], beside[2]);
        if (there < 0) continue;
        const std::int32_t number = stored_[static_cast<std::size_t>(there)];
        if (number < 0 || static_cast<std::size_t>(number) >= full()) continue;
        lane[side] = lane_[static_cast<std::size_t>(number)];
        ++found;
      }
      const double span_m = found * cell_m_[static_cast<int>(axis)];
      neighbours_[cell][axis] = {lane[0], lane[1],
                                 found > 0 ? static_cast<float>(1.0 / span_m) : 0.0F, 0.0F};
    }
  }
}

glm::dvec3 CloudCells::Middle(std::size_t cell) const {
  const auto columns = static_cast<std::size_t>(count_[0]);
  const auto lines = static_cast<std::size_t>(count_[1]);
  const std::size_t place = place_[cell];
  return origin_m_ +
         (glm::dvec3(place % columns, place / columns % lines, place / columns / lines) + 0.5) *
             cell_m_;
}

std::int32_t CloudCells::FullCellAt(const glm::dvec3& point, const glm::dvec3& ahead) const {
  const glm::dvec3 at = glm::floor((point - origin_m_) / cell_m_);
  const std::array<int, 3> here{static_cast<int>(at.x), static_cast<int>(at.y),
                                static_cast<int>(at.z)};
  const auto full_at = [&](int x, int y, int z) {
    const std::ptrdiff_t place = WrappedPlace(x, y, z);
    const std::int32_t cell = place < 0 ? -1 : stored_[static_cast<std::size_t>(place)];
    return cell < static_cast<std::int32_t>(full()) ? cell : -1;
  };
  const std::int32_t inside = full_at(here[0], here[1], here[2]);
  if (inside >= 0) return inside;
  for (int reach = 1; reach <= 2; ++reach) {
    std::int32_t nearest = -1;
    double least = 1e9;
    EachAround(here, reach, [&](int x, int y, int z) {
      const std::int32_t cell = full_at(x, y, z);
      if (cell < 0) return;
      const glm::dvec3 away(x - here[0], y - here[1], z - here[2]);
      const double distance = glm::dot(away, away) - 0.3 * glm::dot(away, ahead);
      if (distance >= least) return;
      least = distance;
      nearest = cell;
    });
    if (nearest >= 0) return nearest;
  }
  return -1;
}

CloudCells::Mixture CloudCells::Around(const glm::dvec3& point) const {
  glm::dvec3 at = (point - origin_m_) / cell_m_ - 0.5;
  at.z = std::clamp(at.z, 0.0, count_[2] - 1.0);
  const glm::dvec3 low = glm::floor(at);
  std::array<std::array<std::size_t, 2>, 3> index{};
  std::array<std::array<float, 2>, 3> share{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int a = static_cast<int>(axis), count = count_[axis];
    const bool wraps = is_periodic_ && axis < 2;
    int first = static_cast<int>(low[a]);
    if (wraps) first = PeriodicIndex(first, count);
    int second = first + 1;
    if (wraps) {
      second = second < count ? second : 0;
    } else {
      first = std::clamp(first, 0, count - 1);
      second = std::clamp(second, 0, count - 1);
    }
    index[axis] = {static_cast<std::size_t>(first), static_cast<std::size_t>(second)};
    const auto rest = static_cast<float>(at[a] - low[a]);
    share[axis] = {1.0F - rest, rest};
  }
  Mixture mixture{};
  float sum = 0.0F;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const std::size_t x = corner & 1U, y = corner >> 1U & 1U, z = corner >> 2U;
    const float weight = share[0][x] * share[1][y] * share[2][z];
    const std::size_t row = index[2][z] * static_cast<std::size_t>(count_[1]) + index[1][y];
    const std::int32_t cell = stored_[row * static_cast<std::size_t>(count_[0]) + index[0][x]];
    if (cell < 0 || weight <= 0.0F) continue;
    const auto i = static_cast<std::size_t>(mixture.count++);
    mixture.cell[i] = static_cast<std::uint32_t>(cell);
    mixture.weight[i] = weight;
    sum += weight;
  }
  for (int i = 0; i < mixture.count; ++i) mixture.weight[static_cast<std::size_t>(i)] /= sum;
  return mixture;
}

void CloudCells::WeightNeighboursByDepth() {
  std::vector<float> extinction_of_lane(lanes(), 0.0F);
  for (std::size_t cell = 0; cell < full(); ++cell)
    extinction_of_lane[lane_[cell]] = extinction_per_m_[cell];
  for (std::size_t cell = 0; cell < full(); ++cell) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Neighbours& both = neighbours_[cell][axis];
      // Slope towards a neighbour: the difference over the distance in optical depth, times extinction.
      const auto towards = [&](std::uint32_t beside) {
        return 2.0F * extinction_per_m_[cell] /
               (static_cast<float>(cell_m_[static_cast<int>(axis)]) *
                (extinction_per_m_[cell] + extinction_of_lane[beside]));
      };
      const float after = both.after == lane_[cell] ? 0.0F : towards(both.after);
      const float before = both.before == lane_[cell] ? 0.0F : towards(both.before);
      const float mean = after > 0.0F && before > 0.0F ? 0.5F : 1.0F;
      both.per_m = mean * 0.5F * (after + before);
      both.bend_per_m = mean * 0.5F * (after - before);
    }
  }
}

std::size_t CloudCells::bytes() const {
  return stored_.size() * sizeof(std::int32_t) +
         (place_.size() + lane_.size()) * sizeof(std::uint32_t) +
         extinction_per_m_.size() * sizeof(float) + neighbours_.size() * sizeof(neighbours_[0]) +
         (full_runs_.run.size() + all_runs_.run.size()) * sizeof(CloudTrackRun) +
         (full_runs_.row_first.size() + all_runs_.row_first.size()) * sizeof(std::uint32_t);
}

}  // namespace alpenglow::renderer
