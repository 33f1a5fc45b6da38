// SPDX-License-Identifier: MIT
#include "renderer/visibility/shadow_heights.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"

namespace alpenglow::renderer {
namespace {

// Lower than any beam that terrain can block, but finite, because maps are interpolated.
constexpr float kNoTerrain = -1e7F;

struct Flat {
  double u_low, u_high, v_low, v_high;
};

Flat BoundsAlong(const TriangleMesh& mesh, const glm::dvec3& sunwards, const glm::dvec3& across) {
  const double infinity = std::numeric_limits<double>::infinity();
  Flat flat{infinity, -infinity, infinity, -infinity};
  for (const auto& position : mesh.positions) {
    const glm::dvec3 p = ToDouble(position);
    const double u = glm::dot(p, sunwards);
    const double v = glm::dot(p, across);
    flat = {std::min(flat.u_low, u), std::max(flat.u_high, u), std::min(flat.v_low, v),
            std::max(flat.v_high, v)};
  }
  return flat;
}

// Returns the side of the square that two triangles cover on average, seen from above.
double SpacingOf(const TriangleMesh& mesh) {
  double area_m2 = 0.0;
  for (const auto& triangle : mesh.triangles) {
    const glm::dvec3 a = ToDouble(mesh.positions[triangle[0]]);
    const glm::dvec3 ab = ToDouble(mesh.positions[triangle[1]]) - a;
    const glm::dvec3 ac = ToDouble(mesh.positions[triangle[2]]) - a;
    area_m2 += 0.5 * std::abs(ab.x * ac.y - ab.y * ac.x);
  }
  return std::sqrt(2.0 * area_m2 / static_cast<double>(mesh.triangles.size()));
}

// Sets the maximum atomically: the result does not depend on the order of threads.
void RaiseHeight(float& cell, float value) {
  std::atomic_ref<float> shared(cell);
  float known = shared.load(std::memory_order_relaxed);
  while (known < value && !shared.compare_exchange_weak(known, value, std::memory_order_relaxed)) {
  }
}

/// A corner of a triangle: u and v in cells, z in metres.
struct ShadowCorner {
  double u, v, z;
};

ShadowCorner OnLine(const ShadowCorner& a, const ShadowCorner& b, double v) {
  const double share = (v - a.v) / (b.v - a.v);
  return {a.u + share * (b.u - a.u), v, a.z + share * (b.z - a.z)};
}

}  // namespace

ShadowHeights::ShadowHeights(const TriangleMesh& mesh, const glm::dvec3& to_light,
                             double radius_rad, const Options& options) {
  ALPENGLOW_ENSURE(std::abs(glm::length(to_light) - 1.0), <, 1e-6);
  const double flat = std::hypot(to_light.x, to_light.y);
  sunwards_ =
      flat > 0.0 ? glm::dvec3(to_light.x, to_light.y, 0.0) / flat : glm::dvec3(1.0, 0.0, 0.0);
  across_ = {-sunwards_.y, sunwards_.x, 0.0};
  const double elevation = std::atan2(to_light.z, flat);
  for (std::size_t beam = 0; beam < kBeams; ++beam) {
    const double at = std::min(elevation - HeightOver(beam) * radius_rad, 0.5 * kPi);
    sine_[beam] = std::sin(at);
    cosine_[beam] = std::cos(at);
  }
  if (mesh.triangles.empty()) return;
  const Flat bounds = BoundsAlong(mesh, sunwards_, across_);
  const double width = bounds.u_high - bounds.u_low;
  const double depth = bounds.v_high - bounds.v_low;
  const double extent = std::max(width, depth);
  const double spacing = SpacingOf(mesh);  // 0 if all triangles are vertical
  const double own =
      std::min(spacing > 0.0 ? spacing / 1.5 : extent, extent / options.fewest_lines);
  const double wanted = options.cell_m > 0.0 ? options.cell_m : own;
  // Seen along a vertical sheet the extents have no area, but the number of cells still has to be
  // limited.
  const auto most = static_cast<double>(options.most_cells);
  cell_m_ = std::max({wanted, std::sqrt(width * depth / most), 4.0 * extent / most});
  // Leave one free line on every side.
  first_u_m_ = bounds.u_low - cell_m_;
  first_v_m_ = bounds.v_low - cell_m_;
  columns_ = static_cast<std::size_t>(std::ceil(width / cell_m_)) + 3;
  lines_ = static_cast<std::size_t>(std::ceil(depth / cell_m_)) + 3;
  Beams nothing;
  nothing.fill(kNoTerrain);
  highest_.assign(columns_ * lines_, nothing);
  Deposit(mesh);
  SweepFromTheSun();
  if (options.for_rays) BuildPyramid();
}

std::size_t ShadowHeights::bytes() const {
  std::size_t bytes = highest_.size() * sizeof(Beams);
  for (const Level& level : levels_) bytes += level.extremes.size() * sizeof(Extremes);
  return bytes;
}

// A triangle cuts a chord out of a line. Only the end of the chord with the higher beam can shade
// points that the triangle itself does not occlude.
void ShadowHeights::Deposit(const TriangleMesh& mesh) {
  const auto raise = [&](const ShadowCorner& a, const ShadowCorner& b) {
    for (std::size_t beam = 0; beam < kBeams; ++beam) {
      const auto c = [&](const ShadowCorner& p) {
        return p.z * cosine_[beam] - (first_u_m_ + cell_m_ * p.u) * sine_[beam];
      };
      const double c_a = c(a);
      const double c_b = c(b);
      const ShadowCorner& higher = c_a > c_b ? a : b;
      const std::size_t at = static_cast<std::size_t>(higher.v) * columns_ +
                             static_cast<std::size_t>(std::max(higher.u, 0.0));
      RaiseHeight(highest_[at][beam], static_cast<float>(std::max(c_a, c_b)));
    }
  };
  std::vector<ShadowCorner> corners(mesh.positions.size());
  tbb::parallel_for(std::size_t{0}, corners.size(), [&](std::size_t i) {
    const glm::dvec3 p = ToDouble(mesh.positions[i]);
    corners[i] = {(glm::dot(p, sunwards_) - first_u_m_) / cell_m_,
                  (glm::dot(p, across_) - first_v_m_) / cell_m_, p.z};
  });
  const auto cut = [&](const std::array<std::uint32_t, 3>& triangle) {
    std::array<ShadowCorner, 3> corner{corners[triangle[0]], corners[triangle[1]],
                                       corners[triangle[2]]};
    const auto put_in_order = [](ShadowCorner& a, ShadowCorner& b) {
      if (b.v < a.v) std::swap(a, b);
    };
    put_in_order(corner[0], corner[1]);
    put_in_order(corner[1], corner[2]);
    put_in_order(corner[0], corner[1]);
    for (double v = std::ceil(corner[0].v); v <= corner[2].v; v += 1.0) {
      if (corner[0].v == corner[2].v) break;
      const ShadowCorner other = v < corner[1].v || corner[1].v == corner[2].v
                                     ? OnLine(corner[0], corner[1], v)
                                     : OnLine(corner[1], corner[2], v);
      raise(OnLine(corner[0], corner[2], v), other);
    }
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, mesh.triangles.size(), 4096),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i)
                        cut(mesh.triangles[i]);
                    });
}

void ShadowHeights::SweepFromTheSun() {
  tbb::parallel_for(std::size_t{0}, lines_, [&](std::size_t line) {
    Beams* nodes = &highest_[line * columns_];
    for (std::size_t i = columns_ - 1; i-- > 0;) {
      for (std::size_t beam = 0; beam < kBeams; ++beam)
        nodes[i][beam] = std::max(nodes[i][beam], nodes[i + 1][beam]);
    }
  });
}

void ShadowHeights::BuildPyramid() {
  const auto parent = [](std::size_t cells) { return (cells + 1) / 2; };
  Level level{parent(columns_ - 1), parent(lines_ - 1), {}};
  level.extremes.resize(level.columns * level.rows);
  tbb::parallel_for(std::size_t{0}, level.rows, [&](std::size_t row) {
    for (std::size_t column = 0; column < level.columns; ++column) {
      Extremes extremes{kNoTerrain, std::numeric_limits<float>::max()};
      for (std::size_t line = 2 * row; line <= std::min(2 * row + 2, lines_ - 1); ++line) {
        for (std::size_t i = 2 * column; i <= std::min(2 * column + 2, columns_ - 1); ++i) {
          const Beams& node = highest_[line * columns_ + i];
          extremes = {std::max(extremes.highest_lower, node.front()),
                      std::min(extremes.lowest_upper, node.back())};
        }
      }
      level.extremes[row * level.columns + column] = extremes;
    }
  });
  levels_.push_back(std::move(level));
  while (levels_.back().columns > 1 || levels_.back().rows > 1) {
    const Level& fine = levels_.back();
    Level coarse{parent(fine.columns), parent(fine.rows), {}};
    coarse.extremes.resize(coarse.columns * coarse.rows,
                           {kNoTerrain, std::numeric_limits<float>::max()});
    for (std::size_t row = 0; row < fine.rows; ++row) {
      for (std::size_t column = 0; column < fine.columns; ++column) {
        Extremes& into = coarse.extremes[row / 2 * coarse.columns + column / 2];
        const Extremes& from = fine.extremes[row * fine.columns + column];
        into = {std::max(into.highest_lower, from.highest_lower),
                std::min(into.lowest_upper, from.lowest_upper)};
      }
    }
    levels_.push_back(std::move(coarse));
  }
}

/// Traverses the pyramid along a ray, in cells of the map.
struct ShadowHeights::Walk {
  const ShadowHeights& map;
  double u, v, u_slope, v_slope;  // position in cells, slopes in cells per metre of the ray
  std::array<double, kBeams> beam_at_eye{}, beam_slope{};
  SunlitPathBuilder builder;

  Walk(const ShadowHeights& of, const glm::dvec3& origin, const glm::dvec3& unit)
      : map(of),
        u((glm::dot(origin, of.sunwards_) - of.first_u_m_) / of.cell_m_),
        v((glm::dot(origin, of.across_) - of.first_v_m_) / of.cell_m_),
        u_slope(glm::dot(unit, of.sunwards_) / of.cell_m_),
        v_slope(glm::dot(unit, of.across_) / of.cell_m_) {
    for (std::size_t beam = 0; beam < kBeams; ++beam) {
      const auto c = [&](const glm::dvec3& p) {
        return p.z * of.cosine_[beam] - glm::dot(p, of.sunwards_) * of.sine_[beam];
      };
      beam_at_eye[beam] = c(origin);
      beam_slope[beam] = c(unit);
    }
  }

  [[nodiscard]] double Beam(std::size_t beam, double t) const {
    return beam_at_eye[beam] + t * beam_slope[beam];
  }

  // Clips [begin, end] to the part where a + t b >= 0.
  static void KeepWhere(double a, double b, double& begin, double& end) {
    if (b == 0.0) {
      if (a < 0.0) end = begin;
    } else if (b > 0.0) {
      begin = std::max(begin, std::min(-a / b, end));
    } else {
      end = std::min(end, std::max(-a / b, begin));
    }
  }

  void Whole(double length_m) {
    double begin = 0.0;
    double end = length_m;
    const auto lines = static_cast<double>(map.lines_ - 1);
    const auto columns = static_cast<double>(map.columns_ - 1);
    KeepWhere(v, v_slope, begin, end);
    KeepWhere(lines - v, -v_slope, begin, end);
    KeepWhere(columns - u, -u_slope, begin, end);
    const auto top = static_cast<double>(map.levels_.back().extremes.front().highest_lower);
    KeepWhere(top - beam_at_eye[0], -beam_slope[0], begin, end);
    if (!(begin < end)) {
      builder.Add({0.0, length_m});
      return;
    }
    builder.Add({0.0, begin});
    Block(map.levels_.size(), 0, 0, begin, end);
    builder.Add({end, length_m});
  }

  // Processes a block of 2^level cells a side; the first column of blocks is unbounded away from
  // the sun.
  void Block(std::size_t level, std::size_t column, std::size_t row, double begin, double end) {
    if (level == 0) {
      Cell(column, row, begin, end);
      return;
    }
    const Level& blocks = map.levels_[level - 1];
    const Extremes& extremes = blocks.extremes[row * blocks.columns + column];
    if (std::min(Beam(0, begin), Beam(0, end)) >= static_cast<double>(extremes.highest_lower)) {
      builder.Add({begin, end});
      return;
    }
    if (std::max(Beam(kBeams - 1, begin), Beam(kBeams - 1, end)) <=
        static_cast<double>(extremes.lowest_upper)) {
      builder.Add({begin, end, -1.0, -1.0});
      return;
    }
    const double half = static_cast<double>(std::size_t{1} << (level - 1));
    Split(level - 1, 2 * column, 2 * row, half * static_cast<double>(2 * column + 1),
          half * static_cast<double>(2 * row + 1), begin, end);
  }

  // Visits the four children of a block in the order in which the ray meets them.
  void Split(std::size_t level, std::size_t column, std::size_t row, double middle_u,
             double middle_v, double begin, double end) {
    const auto crossing = [&](double from, double slope, double middle) {
      return slope != 0.0 ? std::clamp((middle - from) / slope, begin, end) : end;
    };
    const double at_u = crossing(u, u_slope, middle_u);
    const double at_v = crossing(v, v_slope, middle_v);
    const std::array<double, 4> stop{begin, std::min(at_u, at_v), std::max(at_u, at_v), end};
    for (std::size_t i = 0; i < 3; ++i) {
      if (!(stop[i] < stop[i + 1])) continue;
      const double middle = 0.5 * (stop[i] + stop[i + 1]);
      Child(level, column + (u + middle * u_slope >= middle_u ? 1 : 0),
            row + (v + middle * v_slope >= middle_v ? 1 : 0), stop[i], stop[i + 1]);
    }
  }

  void Child(std::size_t level, std::size_t column, std::size_t row, double begin, double end) {
    const std::size_t columns = level == 0 ? map.columns_ - 1 : map.levels_[level - 1].columns;
    const std::size_t rows = level == 0 ? map.lines_ - 1 : map.levels_[level - 1].rows;
    if (column >= columns || row >= rows) {  // rounding beyond the map's edge
      builder.Add({begin, end});
      return;
    }
    Block(level, column, row, begin, end);
  }

  // Returns the clearance of each beam over the beam that terrain blocks, at a place in a cell.
  [[nodiscard]] Clearances ClearanceAt(std::size_t column, std::size_t row, double t) const {
    const double across = std::clamp(u + t * u_slope - static_cast<double>(column), 0.0, 1.0);
    const double along = std::clamp(v + t * v_slope - static_cast<double>(row), 0.0, 1.0);
    const Beams* low = &map.highest_[row * map.columns_ + column];
    const Beams* high = low + map.columns_;
    Clearances clearance;
    for (std::size_t beam = 0; beam < kBeams; ++beam) {
      const auto between = [&](const Beams* line) {
        const auto a = static_cast<double>(line[0][beam]);
        return a + across * (static_cast<double>(line[1][beam]) - a);
      };
      const double edge = between(low);
      clearance[beam] = Beam(beam, t) - (edge + along * (between(high) - edge));
    }
    return clearance;
  }

  // Clearances are linear through a cell; the light has a kink where one of them passes 0.
  void Cell(std::size_t column, std::size_t row, double begin, double end) {
    const Clearances at_begin = ClearanceAt(column, row, begin);
    const Clearances at_end = ClearanceAt(column, row, end);
    std::array<double, kBeams + 2> stop;
    stop[0] = begin;
    for (std::size_t beam = 0; beam < kBeams; ++beam) {
      const double a = at_begin[beam];
      const double b = at_end[beam];
      stop[beam + 1] = (a > 0.0) == (b > 0.0) ? begin : begin + (end - begin) * a / (a - b);
    }
    stop[kBeams + 1] = end;
    std::sort(stop.begin(), stop.end());
    const auto height = [&](double t) {
      const double share = (t - begin) / (end - begin);
      Clearances clearance;
      for (std::size_t beam = 0; beam < kBeams; ++beam)
        clearance[beam] = at_begin[beam] + share * (at_end[beam] - at_begin[beam]);
      return HeightFrom(clearance);
    };
    for (std::size_t i = 0; i + 1 < stop.size(); ++i) {
      if (!(stop[i] < stop[i + 1])) continue;
      // Classify the light in the middle of the piece, where rounding does not matter.
      const double inside = height(0.5 * (stop[i] + stop[i + 1]));
      if (inside >= 1.0 || inside <= -1.0) {
        builder.Add({stop[i], stop[i + 1], inside, inside});
      } else {
        builder.Add({stop[i], stop[i + 1], height(stop[i]), height(stop[i + 1])});
      }
    }
  }
};

// Returns c of the beams through a point.
ShadowHeights::Beams ShadowHeights::BeamsOf(const glm::dvec3& point) const {
  const double u = glm::dot(point, sunwards_);
  Beams through;
  for (std::size_t beam = 0; beam < kBeams; ++beam)
    through[beam] = static_cast<float>(point.z * cosine_[beam] - u * sine_[beam]);
  return through;
}

// Returns C interpolated between four nodes; in front of the first column, that of the first
// column.
ShadowHeights::Beams ShadowHeights::HighestAt(double column, double line) const {
  const double along = std::max(column, 0.0);
  const std::size_t i = std::min(static_cast<std::size_t>(along), columns_ - 2);
  const std::size_t j = std::min(static_cast<std::size_t>(line), lines_ - 2);
  const auto x = static_cast<float>(along - static_cast<double>(i));
  const auto y = static_cast<float>(line - static_cast<double>(j));
  const Beams* low = &highest_[j * columns_ + i];
  const Beams* high = low + columns_;
  Beams between;
  for (std::size_t beam = 0; beam < kBeams; ++beam) {
    const float a = low[0][beam] + x * (low[1][beam] - low[0][beam]);
    const float b = high[0][beam] + x * (high[1][beam] - high[0][beam]);
    between[beam] = a + y * (b - a);
  }
  return between;
}

double ShadowHeights::HeightFrom(const Clearances& clearance) {
  if (!(clearance[kBeams - 1] > 0.0)) return -1.0;
  std::size_t passes = kBeams - 1;
  while (passes > 0 && clearance[passes - 1] > 0.0) --passes;
  if (passes == 0) return 1.0;
  const double over = clearance[passes];
  const double under = clearance[passes - 1];
  const double share = over / (over - under);
  return HeightOver(passes) + share * (HeightOver(passes - 1) - HeightOver(passes));
}

std::optional<ShadowHeights::Clearances> ShadowHeights::ClearancesAt(const glm::dvec3& point,
                                                                     double cells) const {
  if (highest_.empty()) return std::nullopt;
  const double column = (glm::dot(point, sunwards_) - first_u_m_) / cell_m_ + cells;
  const double line = (glm::dot(point, across_) - first_v_m_) / cell_m_;
  const bool is_beside = line < 0.0 || line > static_cast<double>(lines_ - 1);
  if (is_beside || column > static_cast<double>(columns_ - 1)) return std::nullopt;
  const Beams through = BeamsOf(point), edge = HighestAt(column, line);
  Clearances clearance;
  for (std::size_t beam = 0; beam < kBeams; ++beam)
    clearance[beam] = static_cast<double>(through[beam] - edge[beam]);
  return clearance;
}

double ShadowHeights::SunlightAt(const glm::dvec3& point) const {
  const std::optional<Clearances> clearance = ClearancesAt(point, 0.0);
  return clearance ? SunlightOverEdge(HeightFrom(*clearance)) : 1.0;
}

// Clearances increase from the lowest beam to the highest; the edge cuts the disk where they pass
// 0. Beyond the disk the two nearest beams are extrapolated.
SunOverEdge ShadowHeights::Over(const glm::dvec3& ground) const {
  constexpr double kOwnCells = 1.0;
  constexpr SunOverEdge kNothing{1e7, 0.0};
  const std::optional<Clearances> found = ClearancesAt(ground, kOwnCells);
  if (!found) return kNothing;
  const Clearances& clearance = *found;
  const std::size_t upper = clearance[1] > 0.0 ? 1 : 2;
  const double over = clearance[upper], under = clearance[upper - 1];
  const double radius = std::max((over - under) / (HeightOver(upper - 1) - HeightOver(upper)), 0.0);
  return {over + HeightOver(upper) * radius, radius};
}

SunlitPath ShadowHeights::Along(const glm::dvec3& origin, const glm::dvec3& unit,
                                double length_m) const {
  ALPENGLOW_ENSURE(std::isfinite(length_m), ==, true);
  if (!(length_m > 0.0)) return {};
  if (highest_.empty()) return {{0.0, length_m}};
  ALPENGLOW_ENSURE(levels_.empty(), ==, false);
  Walk walk(*this, origin, unit);
  walk.Whole(length_m);
  return walk.builder.Take();
}

}  // namespace alpenglow::renderer
