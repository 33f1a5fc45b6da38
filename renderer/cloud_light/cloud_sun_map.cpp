// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_sun_map.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "renderer/cloud_light/cloud_tracking.h"
#include "renderer/clouds/cloud_line.h"
#include "renderer/clouds/periodic_index.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

// Levels stand at most this number of cells apart along a beam.
constexpr double kCellsAlongBeam = 4.0;
constexpr double kLeastAcross = 0.25;  // cells are at most four times as long on the ground
constexpr double kFine_m = 120.0, kFineDepth = 8.0;
constexpr double kFirstStep_m = 5.0, kStepGrowth = 1.2;
// Beams and levels of a block, in each direction. A word of bits has a whole number of blocks.
constexpr int kBeamsOfBlock = 4;

glm::dvec3 CheckedSun(const glm::dvec3& to_sun) {
  if (!(std::abs(glm::length(to_sun) - 1.0) <= 1e-6)) {
    throw InputError("the direction from clouds to the sun must be a unit vector");
  }
  const double elevation_deg = std::asin(std::min(to_sun.z, 1.0)) / kRadiansPerDegree;
  if (!(elevation_deg >= kLowestCloudSun_deg - 1e-9)) {
    throw InputError(
        fmt::format("the sun over clouds is at {} degrees; maps of its light need {} "
                    "degrees or more",
                    elevation_deg, kLowestCloudSun_deg));
  }
  return to_sun;
}

/// Two neighbours on one axis, and the weight of the second.
struct MapNeighbours {
  std::array<int, 2> node;
  float share;
};

/// Returns the neighbours around a coordinate in units of nodes; no value outside of an open map.
std::optional<MapNeighbours> NeighboursOf(double at, int count, bool is_periodic) {
  const double cell = std::floor(at);
  const auto share = static_cast<float>(at - cell);
  if (is_periodic) {
    const int node = PeriodicIndex(cell, count);
    return MapNeighbours{{node, node + 1 < count ? node + 1 : 0}, share};
  }
  if (!(cell >= 0.0 && cell < count - 1)) return std::nullopt;
  return MapNeighbours{{static_cast<int>(cell), static_cast<int>(cell) + 1}, share};
}

/// The stored part of the beams of one line of nodes.
struct BeamLine {
  std::vector<std::uint64_t> has_cloud;
  std::vector<std::uint32_t> count;  // of values, for each node
  std::vector<std::uint16_t> value;
};

/// Returns the optical depth between neighbouring levels along a beam from the highest one down. The
/// beam ends where it reaches an optical depth: levels below have 0.
std::vector<double> DepthsBetweenLevels(const CloudTracker& tracker, const CloudRay& beam,
                                        double level_m, std::size_t levels, double step_m,
                                        double most_depth) {
  std::vector<double> depth(levels, 0.0);
  const double end_m = level_m * static_cast<double>(levels);
  double sum = 0.0;
  tracker.EachSpan(beam, end_m, [&](double begin_m, double until_m, double) {
    for (double at_m = begin_m; at_m < until_m && sum < most_depth;) {
      const auto passed = std::min(static_cast<std::size_t>(at_m / level_m), levels - 1);
      const double border_m = level_m * static_cast<double>(passed + 1);
      double next_m = std::min({at_m + step_m, until_m, std::max(border_m, at_m + 1e-6)});
      if (!(next_m > at_m)) next_m = until_m;
      const double part =
          (next_m - at_m) * tracker.Extinction_per_m(beam.At(0.5 * (at_m + next_m)));
      depth[levels - 1 - passed] += part;
      sum += part;
      at_m = next_m;
    }
    return sum < most_depth;
  });
  return depth;
}

}  // namespace

CloudSunMap::CloudSunMap(const CloudField& field, const glm::dvec3& to_sun,
                         const CloudSunMapOptions& options)
    : to_sun_(CheckedSun(to_sun)),
      slope_(glm::dvec2(to_sun) / to_sun.z),
      low_(field.lattice().origin_m),
      base_m_(field.base_altitude_m()),
      is_periodic_(field.lattice().is_periodic) {
  RequireInRange(options.cell_m, 1.0, 1000.0, "the cell of a map of sunlight in clouds [m]");
  RequireInRange(options.step_m, 1.0, 100.0, "the step of a map of sunlight in clouds [m]");
  const double depth_m = field.top_altitude_m() - base_m_;
  glm::dvec2 size_m(field.lattice().size_m());
  if (!is_periodic_) {
    low_ -= glm::max(depth_m * slope_, 0.0);
    size_m += glm::abs(depth_m * slope_);
  }
  for (int axis = 0; axis < 2; ++axis) {
    // Beams whose feet are apart along an axis are nearer to each other by this factor.
    const double across = std::sqrt(std::max(0.0, 1.0 - to_sun[axis] * to_sun[axis]));
    const double cell_m = options.cell_m / std::max(across, kLeastAcross);
    // Blocks of equal size keep the mean.
    const double cells =
        kBeamsOfBlock * std::max(1.0, std::round(size_m[axis] / (kBeamsOfBlock * cell_m)));
    cell_m_[axis] = size_m[axis] / cells;
    nodes_[static_cast<std::size_t>(axis)] = static_cast<int>(cells) + (is_periodic_ ? 0 : 1);
  }
  const double most_m = options.cell_m * std::min(1.0, kCellsAlongBeam * to_sun.z);
  levels_ = static_cast<int>(std::max(1.0, std::ceil(depth_m / most_m)));
  level_m_ = std::max(depth_m, 1e-3) / levels_;
  words_ = static_cast<std::size_t>(levels_ + 63) / 64;

  const CloudTracker tracker(field, false);
  std::vector<BeamLine> lines(static_cast<std::size_t>(nodes_[1]));
  tbb::parallel_for(0, nodes_[1], [&](int line) {
    BeamLine& made = lines[static_cast<std::size_t>(line)];
    made.has_cloud.assign(static_cast<std::size_t>(nodes_[0]) * words_, 0);
    for (int column = 0; column < nodes_[0]; ++column) {
      const std::vector<double> depth = DepthsBetweenLevels(
          tracker, {PointAt(column, line, levels_), -to_sun_}, level_m_ / to_sun.z,
          static_cast<std::size_t>(levels_), options.step_m, kDeepest);
      const std::size_t before = made.value.size();
      double sum = 0.0;
      for (std::size_t level = depth.size(); level-- > 0;) {
        if (depth[level] <= 0.0) continue;
        sum += depth[level];
        made.has_cloud[static_cast<std::size_t>(column) * words_ + level / 64] |= std::uint64_t{1}
                                                                                  << (level % 64);
        made.value.push_back(
            static_cast<std::uint16_t>(65535.0 * std::sqrt(std::min(1.0, sum / kDeepest)) + 0.5));
      }
      made.count.push_back(static_cast<std::uint32_t>(made.value.size() - before));
    }
  });
  std::size_t values = 0;
  for (const BeamLine& line : lines) values += line.value.size();
  ALPENGLOW_ENSURE(values, <, std::size_t{std::numeric_limits<std::uint32_t>::max()});
  value_.reserve(values);
  for (BeamLine& line : lines) {
    auto first = static_cast<std::uint32_t>(value_.size());
    for (const std::uint32_t count : line.count) {
      first_.push_back(first);
      first += count;
    }
    has_cloud_.insert(has_cloud_.end(), line.has_cloud.begin(), line.has_cloud.end());
    value_.insert(value_.end(), line.value.begin(), line.value.end());
    line = {};
  }
  for (std::size_t axis = 0; axis < 2; ++axis)
    blocks_[axis] = std::max(1, nodes_[axis] / kBeamsOfBlock);
  block_.resize(BlockOf((levels_ + kBeamsOfBlock - 1) / kBeamsOfBlock, 0, 0));
  tbb::parallel_for(0, blocks_[1], [&](int line) { MakeBlocks(line); });
}

std::size_t CloudSunMap::StoredFrom(std::size_t node, int level) const {
  const std::uint64_t* word = &has_cloud_[node * words_];
  auto w = static_cast<std::size_t>(level) / 64;
  int count = std::popcount(word[w] >> (static_cast<std::size_t>(level) % 64));
  while (++w < words_) count += std::popcount(word[w]);
  return static_cast<std::size_t>(count);
}

CloudSunMap::Ends CloudSunMap::Between(std::size_t node, int level) const {
  const std::size_t stored = StoredFrom(node, level);
  const float below = Depth(node, stored);
  return {below, HasCloud(node, level) ? Depth(node, stored - 1) : below};
}

glm::dvec3 CloudSunMap::PointAt(int column, int line, double level) const {
  const double rise_m = level * level_m_;
  const glm::dvec2 place = low_ + glm::dvec2(column, line) * cell_m_ + rise_m * slope_;
  return {place, base_m_ + rise_m};
}

double CloudSunMap::Transmittance(const glm::dvec3& point) const {
  const double rise_m = point.z - base_m_;
  const double level = std::max(0.0, rise_m / level_m_);
  if (!(level < levels_)) return 1.0;
  const int whole = static_cast<int>(level);
  const auto above = static_cast<float>(level - whole);
  const glm::dvec2 foot = FootOf(point);
  const auto u = NeighboursOf(foot.x, nodes_[0], is_periodic_);
  const auto v = NeighboursOf(foot.y, nodes_[1], is_periodic_);
  if (!u || !v) return 1.0;
  const auto left = [&](std::size_t column, std::size_t line) {
    const Ends ends = Between(NodeOf(u->node[column], v->node[line]), whole);
    const float depth = ends.below + above * (ends.above - ends.below);
    return depth == 0.0F ? 1.0F : std::exp(-depth);
  };
  const float south = std::lerp(left(0, 0), left(1, 0), u->share);
  const float north = std::lerp(left(0, 1), left(1, 1), u->share);
  return static_cast<double>(std::lerp(south, north, v->share));
}

void CloudSunMap::MakeBlocks(int line) {
  const int levels = (levels_ + kBeamsOfBlock - 1) / kBeamsOfBlock;
  const auto border = [](int block, int blocks, int nodes) { return block * nodes / blocks; };
  const int first_line = border(line, blocks_[1], nodes_[1]);
  const int end_line = border(line + 1, blocks_[1], nodes_[1]);
  std::vector<float> sum(static_cast<std::size_t>(levels));
  for (int column = 0; column < blocks_[0]; ++column) {
    const int first = border(column, blocks_[0], nodes_[0]);
    const int end = border(column + 1, blocks_[0], nodes_[0]);
    std::fill(sum.begin(), sum.end(), 0.0F);
    for (int of_line = first_line; of_line < end_line; ++of_line) {
      for (int of_column = first; of_column < end; ++of_column) {
        const std::size_t node = NodeOf(of_column, of_line);
        std::size_t stored = 0;
        float left = 1.0F;
        for (std::size_t level = sum.size(); level-- > 0;) {
          const std::size_t bit = kBeamsOfBlock * level;
          const auto bits = has_cloud_[node * words_ + bit / 64] >> (bit % 64) & 0xFU;
          if (bits != 0) {
            stored += static_cast<std::size_t>(std::popcount(bits));
            left = std::exp(-Depth(node, stored));
          }
          sum[level] += left;
        }
      }
    }
    const auto beams = static_cast<float>((end - first) * (end_line - first_line));
    for (std::size_t level = 0; level < sum.size(); ++level) {
      block_[BlockOf(static_cast<int>(level), column, line)] =
          static_cast<std::uint16_t>(65535.0F * (sum[level] / beams) + 0.5F);
    }
  }
}

double CloudSunMap::TransmittanceAround(const glm::dvec3& point) const {
  const double level = std::max(0.0, (point.z - base_m_) / (kBeamsOfBlock * level_m_));
  const int levels = (levels_ + kBeamsOfBlock - 1) / kBeamsOfBlock;
  if (!(level < levels)) return 1.0;
  const glm::dvec2 foot = FootOf(point);
  const auto among_blocks = [&](std::size_t axis) {
    const double per_block = static_cast<double>(nodes_[axis]) / blocks_[axis];
    const double at = (foot[static_cast<int>(axis)] + 0.5) / per_block - 0.5;
    return NeighboursOf(at, blocks_[axis], is_periodic_);
  };
  const auto u = among_blocks(0), v = among_blocks(1);
  if (!u || !v) return 1.0;
  const auto whole = static_cast<int>(level);
  const auto share = static_cast<float>(level - whole);
  const auto of_level = [&](int k) {
    if (k == levels) return 65535.0F;
    const auto left = [&](std::size_t column, std::size_t line) {
      return static_cast<float>(block_[BlockOf(k, u->node[column], v->node[line])]);
    };
    return std::lerp(std::lerp(left(0, 0), left(1, 0), u->share),
                     std::lerp(left(0, 1), left(1, 1), u->share), v->share);
  };
  return static_cast<double>(std::lerp(of_level(whole), of_level(whole + 1), share)) / 65535.0;
}

double CloudSunMap::MeanTransmittance() const {
  double sum = 0.0;
  for (std::size_t node = 0; node < first_.size(); ++node) {
    sum += std::exp(-static_cast<double>(Between(node, 0).below));
  }
  return sum / static_cast<double>(first_.size());
}

std::size_t CloudSunMap::bytes() const {
  return has_cloud_.size() * sizeof(std::uint64_t) + first_.size() * sizeof(std::uint32_t) +
         (value_.size() + block_.size()) * sizeof(std::uint16_t);
}

std::uint64_t CloudSunMap::hash() const {
  Fnv1a hash;
  for (const std::uint64_t word : has_cloud_) hash.Add(word);
  hash.AddBytes({reinterpret_cast<const char*>(value_.data()), 2 * value_.size()});
  return hash.hash();
}

double OpticalDepthToSun(const CloudField& field, const CloudSunMap& map, const glm::dvec3& point) {
  CloudField::Line line(field, point, map.to_sun());
  double depth = 0.0, along_m = 0.0, step_m = kFirstStep_m;
  while (along_m < kFine_m && depth < kFineDepth) {
    const double per_m = line.At(along_m + 0.5 * step_m).extinction_per_m;
    depth += step_m * per_m;
    along_m += step_m;
    if (per_m <= 0.0) along_m += line.ClearAhead_m(along_m);
    step_m *= kStepGrowth;
  }
  return depth + map.OpticalDepth(point + along_m * map.to_sun());
}

}  // namespace alpenglow::renderer
