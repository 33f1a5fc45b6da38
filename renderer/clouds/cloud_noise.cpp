// SPDX-License-Identifier: MIT
#include "renderer/clouds/cloud_noise.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "atmosphere/base/error.h"
#include "renderer/clouds/periodic_index.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

std::int32_t WholePart(double value) {
  const auto truncated = static_cast<std::int32_t>(value);
  return truncated - (value < truncated ? 1 : 0);
}

double HashFraction(std::uint32_t hash) { return static_cast<double>(hash) / 4294967296.0; }

/// Returns the lowest ten bits as a number in [0, 1).
double TenBits(std::uint32_t hash) { return (hash & 1023U) / 1024.0; }

/// Returns the hash of a lattice point; all axes repeat, or only x and y.
std::uint32_t PointHash(const std::array<std::int32_t, 3>& point, int period, bool wraps_z,
                        std::uint32_t seed) {
  return LatticeHash3(PeriodicIndex(point[0], period), PeriodicIndex(point[1], period),
                      wraps_z ? PeriodicIndex(point[2], period) : point[2], seed);
}

double BlendedValues(const glm::dvec3& cells, int period, bool wraps_z, std::uint32_t seed) {
  const std::array<std::int32_t, 3> low{WholePart(cells.x), WholePart(cells.y), WholePart(cells.z)};
  std::array<double, 3> fade{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    fade[a] = shared::NoiseFade(cells[axis] - low[a]);
  }
  const auto value = [&](int x, int y, int z) {
    return HashFraction(PointHash({low[0] + x, low[1] + y, low[2] + z}, period, wraps_z, seed));
  };
  const auto plane = [&](int z) {
    return shared::NoiseBlend(fade[0], fade[1], value(0, 0, z), value(1, 0, z), value(0, 1, z),
                              value(1, 1, z));
  };
  const double below = plane(0);
  return 2.0 * (below + fade[2] * (plane(1) - below)) - 1.0;
}

/// Returns the shift of a row of cells: every other row stands half a cell aside, so that the cells
/// form no square pattern.
double RowShift(std::int32_t row) { return (row & 1) != 0 ? 0.5 : 0.0; }

constexpr std::size_t kMostTexels = 256;  // along an axis

/// Texels along x within one cell of an octave.
struct TexelRun {
  glm::dvec3 first;  // point of the first one, in cells
  double per_texel;  // cells
  std::size_t count;
  double amplitude;

  [[nodiscard]] glm::dvec3 PointOf(std::size_t i) const {
    return {first.x + static_cast<double>(i) * per_texel, first.y, first.z};
  }
};

/// Round bumps around one hashed point per cell of a lattice that repeats along all axes.
class BumpLattice {
 public:
  BumpLattice(int period, std::uint32_t seed) : period_(period) {
    for (std::int32_t z = 0; z < period; ++z) {
      for (std::int32_t y = 0; y < period; ++y) {
        for (std::int32_t x = 0; x < period; ++x) {
          // Three parts of one hash, in steps of 2^-10, place the point.
          const std::uint32_t hash = LatticeHash3(x, y, z, seed);
          points_.push_back({TenBits(hash), TenBits(hash >> 10U), TenBits(hash >> 20U)});
        }
      }
    }
  }

  /// Adds values that are 1 at a point of the lattice, and 0 at distances of a cell and more.
  /// @param texel  the first one of the run.
  void AddAlong(const TexelRun& run, double* texel) const {
    const auto& [first, per_texel, count, amplitude] = run;
    const std::array<std::int32_t, 3> middle{WholePart(first.x), WholePart(first.y),
                                             WholePart(first.z)};
    std::array<double, kMostTexels> least;
    std::fill_n(least.begin(), count, 1.0);
    for (std::int32_t z = middle[2] - 1; z <= middle[2] + 1; ++z) {
      for (std::int32_t y = middle[1] - 1; y <= middle[1] + 1; ++y) {
        const std::int32_t row =
            (PeriodicIndex(z, period_) * period_ + PeriodicIndex(y, period_)) * period_;
        for (std::int32_t x = middle[0] - 1; x <= middle[0] + 1; ++x) {
          const glm::dvec3& point =
              points_[static_cast<std::size_t>(row + PeriodicIndex(x, period_))];
          const double dy = y + point.y - first.y, dz = z + point.z - first.z;
          const double dx = x + point.x - first.x, rest = dy * dy + dz * dz;
          for (std::size_t i = 0; i < count; ++i) {
            const double along = dx - static_cast<double>(i) * per_texel;
            const double square = along * along + rest;
            least[i] = square < least[i] ? square : least[i];
          }
        }
      }
    }
    for (std::size_t i = 0; i < count; ++i) texel[i] += amplitude * (1.0 - least[i]);
  }

 private:
  int period_;
  std::vector<glm::dvec3> points_;
};

/// Returns the texels of a sum of octaves, scaled to mean 0 and standard deviation 1.
/// @param octave_of  makes, from a period in cells and a seed, a function that adds the values of
/// texels along x within one cell.
template <typename OctaveOf>
std::vector<float> OctaveTexels(int side, const NoiseOctaves& octaves, const OctaveOf& octave_of) {
  const auto n = static_cast<std::size_t>(side);
  std::vector<double> sum(n * n * n, 0.0);
  double amplitude = 1.0;
  int cells = octaves.cells;
  for (int i = 0; i < octaves.octaves; ++i, cells *= 2, amplitude *= octaves.gain) {
    const auto octave = octave_of(cells, octaves.seed + static_cast<std::uint32_t>(i));
    const double per_texel = static_cast<double>(cells) / side;
    tbb::parallel_for(std::size_t{0}, n, [&](std::size_t z) {
      double* texel = sum.data() + z * n * n;
      for (std::size_t y = 0; y < n; ++y) {
        for (std::size_t x = 0; x < n;) {
          const glm::dvec3 first = (glm::dvec3(x, y, z) + 0.5) * per_texel;
          const double border = WholePart(first.x) + 1.0;
          std::size_t count = 1;
          while (x + count < n && (static_cast<double>(x + count) + 0.5) * per_texel < border) {
            ++count;
          }
          octave(TexelRun{first, per_texel, count, amplitude}, texel);
          texel += count;
          x += count;
        }
      }
    });
  }
  double mean = 0.0, square = 0.0;
  for (const double value : sum) mean += value;
  mean /= static_cast<double>(sum.size());
  for (const double value : sum) square += (value - mean) * (value - mean);
  const double scale = 1.0 / std::sqrt(square / static_cast<double>(sum.size()));
  std::vector<float> texels;
  texels.reserve(sum.size());
  for (const double value : sum) texels.push_back(static_cast<float>((value - mean) * scale));
  return texels;
}

/// The texels around a point of a cube, and the place of the point between them.
struct TexelCell {
  std::array<std::size_t, 3> low{}, high{};
  std::array<float, 3> share{};
};

TexelCell TexelCellOf(const glm::dvec3& periods, int side) {
  const glm::dvec3 texels = static_cast<double>(side) * periods;
  TexelCell cell;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const std::int32_t floor = WholePart(texels[axis]);
    cell.share[a] = static_cast<float>(texels[axis] - floor);
    cell.low[a] = static_cast<std::size_t>(floor & (side - 1));
    cell.high[a] = static_cast<std::size_t>((floor + 1) & (side - 1));
  }
  return cell;
}

void CheckNoise(int side, const NoiseOctaves& octaves) {
  const bool is_power = side >= 8 && side <= 256 && (side & (side - 1)) == 0;
  ALPENGLOW_ENSURE(is_power, ==, true);
  ALPENGLOW_ENSURE(octaves.octaves, >=, 1);
  ALPENGLOW_ENSURE(octaves.cells, >=, 1);
}

}  // namespace

double ValueNoise(const glm::dvec3& cells, int period, std::uint32_t seed) {
  return BlendedValues(cells, period, false, seed);
}

CellDistances DistancesInCells(const glm::dvec2& cells, double time, int period,
                               std::uint32_t seed) {
  constexpr double kJitter = 0.9;  // of a cell
  const std::int32_t before = WholePart(time);
  const double share = shared::NoiseFade(time - before);
  const auto place = [&](std::int32_t x, std::int32_t y, std::uint32_t axis) {
    const std::int32_t east = PeriodicIndex(x, period), north = PeriodicIndex(y, period);
    const double from = HashFraction(LatticeHash3(east, north, before, seed + axis));
    const double to = HashFraction(LatticeHash3(east, north, before + 1, seed + axis));
    return 0.5 + kJitter * (from + share * (to - from) - 0.5);
  };
  const std::int32_t column = WholePart(cells.x), row = WholePart(cells.y);
  double nearest = 9.0, second = 9.0;  // squares
  for (std::int32_t y = row - 1; y <= row + 1; ++y) {
    for (std::int32_t x = column - 2; x <= column + 1; ++x) {
      const double dx = x + RowShift(y) + place(x, y, 0U) - cells.x;
      const double dy = y + place(x, y, 0x5bd1e995U) - cells.y;
      const double square = dx * dx + dy * dy;
      second = std::min(second, std::max(nearest, square));
      nearest = std::min(nearest, square);
    }
  }
  return {std::sqrt(nearest), std::sqrt(second)};
}

TilingNoise TilingNoise::Billow(int side, const NoiseOctaves& octaves) {
  CheckNoise(side, octaves);
  return {side, OctaveTexels(side, octaves, [](int period, std::uint32_t seed) {
            return [lattice = BumpLattice(period, seed)](const TexelRun& run, double* texel) {
              lattice.AddAlong(run, texel);
            };
          })};
}

TilingNoise TilingNoise::Value(int side, const NoiseOctaves& octaves) {
  CheckNoise(side, octaves);
  return {side, OctaveTexels(side, octaves, [](int period, std::uint32_t seed) {
            return [=](const TexelRun& run, double* texel) {
              for (std::size_t i = 0; i < run.count; ++i) {
                texel[i] += run.amplitude * BlendedValues(run.PointOf(i), period, true, seed);
              }
            };
          })};
}

TilingNoise::TilingNoise(int side, std::vector<float> texels)
    : side_(side),
      texels_(std::move(texels)),
      least_(*std::min_element(texels_.begin(), texels_.end())),
      largest_(*std::max_element(texels_.begin(), texels_.end())) {}

double TilingNoise::At(const glm::dvec3& periods) const {
  const TexelCell cell = TexelCellOf(periods, side_);
  const auto n = static_cast<std::size_t>(side_);
  const auto along_x = [&](std::size_t y, std::size_t z) {
    const float* row = texels_.data() + (z * n + y) * n;
    return row[cell.low[0]] + cell.share[0] * (row[cell.high[0]] - row[cell.low[0]]);
  };
  const auto along_xy = [&](std::size_t z) {
    const float south = along_x(cell.low[1], z);
    return south + cell.share[1] * (along_x(cell.high[1], z) - south);
  };
  const float below = along_xy(cell.low[2]);
  return static_cast<double>(below + cell.share[2] * (along_xy(cell.high[2]) - below));
}

TilingVectorNoise::TilingVectorNoise(int side, const NoiseOctaves& octaves) : side_(side) {
  NoiseOctaves seeded = octaves;
  least_ = largest_ = 0.0;
  const auto n = static_cast<std::size_t>(side);
  texels_.resize(n * n * n);
  for (std::size_t component = 0; component < 3; ++component, seeded.seed += 100U) {
    const TilingNoise noise = TilingNoise::Value(side, seeded);
    least_ = std::min(least_, noise.Least());
    largest_ = std::max(largest_, noise.Largest());
    for (std::size_t i = 0; i < texels_.size(); ++i) texels_[i][component] = noise.Texel(i);
  }
}

glm::dvec3 TilingVectorNoise::At(const glm::dvec3& periods) const {
  const TexelCell cell = TexelCellOf(periods, side_);
  const auto n = static_cast<std::size_t>(side_);
  const auto texel = [&](std::size_t x, std::size_t y, std::size_t z) {
    Four four;
    __builtin_memcpy(&four, texels_.data() + (z * n + y) * n + x, sizeof four);
    return four;
  };
  const auto along_x = [&](std::size_t y, std::size_t z) {
    const Four west = texel(cell.low[0], y, z);
    return west + cell.share[0] * (texel(cell.high[0], y, z) - west);
  };
  const auto along_xy = [&](std::size_t z) {
    const Four south = along_x(cell.low[1], z);
    return south + cell.share[1] * (along_x(cell.high[1], z) - south);
  };
  const Four below = along_xy(cell.low[2]);
  const Four value = below + cell.share[2] * (along_xy(cell.high[2]) - below);
  return {static_cast<double>(value[0]), static_cast<double>(value[1]),
          static_cast<double>(value[2])};
}

}  // namespace alpenglow::renderer
