// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_low_sun_map.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "atmosphere/base/error.h"
#include "atmosphere/math/numerics.h"
#include "renderer/clouds/periodic_index.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

// Slopes of neighbouring rounds differ by less than the disk of the sun is wide, 0.0093.
constexpr double kMostRound = 0.005;
constexpr std::size_t kColumnsAtOnce = 32;
constexpr double kNear_m = 150.0, kNearStep_m = 5.0, kNearGrowth = 1.15, kMostNearStep_m = 40.0;
constexpr double kArcStep_m = 50.0;
// Rows of beams are so close that they resolve a thin layer, and cells wider where cloud is thin.
constexpr double kRowsInLayer = 40.0, kCellDepth = 0.2, kMostCells = 2.0;
// Refraction lifts the sun by 0.010 at the horizon, and twice as much for a cloud behind it.
constexpr double kHiddenBelowHorizon = 0.03;
constexpr double kReachOfHorizon = 0.8, kMostReach_m = 4e5;
// Shorter periods count as several.
constexpr double kLeastPeriod_m = 100.0;

// Deeper beams are stored as 2^-31, and end.
constexpr float kOpaque = 21.5F;

// Transmittances from 2^-31 to 1 have an exponent of 5 bits and a fraction of 11.
constexpr std::uint32_t kLeastBits = 96U << 23U, kDroppedBits = 12;

std::uint16_t Coded(float depth) {
  if (depth <= 0.0F) return 31U << 11U;
  const auto bits = std::bit_cast<std::uint32_t>(std::exp(-depth));
  if (bits <= kLeastBits) return 0;
  return static_cast<std::uint16_t>((bits - kLeastBits + (1U << (kDroppedBits - 1))) >>
                                    kDroppedBits);
}

float Decoded(std::uint16_t value) {
  return std::bit_cast<float>((std::uint32_t{value} << kDroppedBits) + kLeastBits);
}

}  // namespace

CloudLowSunMap::CloudLowSunMap(const CloudField& field, const CloudLowSun& sun,
                               const CloudLowSunMapOptions& options, Unmade)
    : field_(field), sun_(sun) {
  RequireInRange(options.cell_m, 5.0, 1000.0, "the cell of a map of low sunlight in clouds [m]");
  RequireInRange(options.plane_m, 50.0, 2000.0,
                 "the distance of planes of low sunlight in clouds [m]");
  if (!field.lattice().is_periodic) return;
  const glm::dvec2 azimuth = sun.azimuth();
  along_ = std::abs(azimuth.x) >= std::abs(azimuth.y) ? 0 : 1;
  across_ = 1 - along_;
  const glm::dvec2 size_m(field.lattice().size_m());
  const double straight = std::abs(azimuth[along_]);
  const double period_m =
      size_m[along_] * std::max(1.0, std::ceil(kLeastPeriod_m / size_m[along_])) / straight;
  planes_ = static_cast<int>(std::max(1.0, std::round(period_m / options.plane_m)));
  distance_m_ = period_m / planes_;
  const double wider =
      std::clamp(kCellDepth / (options.cell_m * field.largest_extinction_per_m()), 1.0, kMostCells);
  const double cells = size_m[across_] * straight / (wider * options.cell_m);
  columns_ = static_cast<std::size_t>(std::max(1.0, std::round(cells)));
  cell_m_ = size_m[across_] / static_cast<double>(columns_);
  const double layer_m = std::max(1.0, field.top_altitude_m() - field.base_altitude_m());
  row_m_ = wider * std::min(options.cell_m, layer_m / kRowsInLayer);
  ChooseRounds();
}

double CloudLowSunMap::BytesFor(const CloudField& field, const CloudLowSun& sun,
                                const CloudLowSunMapOptions& options) {
  const CloudLowSunMap map(field, sun, options, Unmade{});
  const double slices = static_cast<double>(map.rounds_) * map.planes_;
  return slices * (sizeof(Slice) + sizeof(std::uint16_t) * static_cast<double>(map.rows_) *
                                       static_cast<double>(map.columns_));
}

CloudLowSunMap::CloudLowSunMap(const CloudField& field, const CloudLowSun& sun,
                               const CloudLowSunMapOptions& options)
    : CloudLowSunMap(field, sun, options, Unmade{}) {
  if (rounds_ == 0) return;
  MakeSlices();
  value_.resize(slices_.size() * rows_ * columns_);
  const std::size_t blocks = (columns_ + kColumnsAtOnce - 1) / kColumnsAtOnce;
  tbb::parallel_for(std::size_t{0}, blocks * static_cast<std::size_t>(chains_), [&](std::size_t i) {
    const std::size_t first = i % blocks * kColumnsAtOnce;
    Fill(static_cast<int>(i / blocks), first, std::min(first + kColumnsAtOnce, columns_));
  });
}

void CloudLowSunMap::ChooseRounds() {
  const double per_radius = sun_.per_radius(), top_m = field_.top_altitude_m();
  const double horizon = std::sqrt(2.0 * per_radius * std::max(top_m, 0.0));
  const double reach_m = kReachOfHorizon * std::min(horizon / per_radius, kMostReach_m);
  hidden_ = -horizon - kHiddenBelowHorizon;
  flattest_ = std::max(sun_.SlopeAfter(-reach_m), hidden_);
  steepest_ = std::max(sun_.SlopeAfter(reach_m), hidden_);
  const double period = planes_ * distance_m_ * per_radius;
  chains_ = static_cast<int>(std::ceil(period / kMostRound));
  round_ = period / chains_;
  // Beams that return are as steep as where they left the layer.
  const double returned = std::min(-flattest_, 0.5 * sun_.farthest_m() * per_radius);
  entering_ = std::max({steepest_, returned, 0.0}) + per_radius * (kNear_m + distance_m_);
  const double leaving =
      std::sqrt(entering_ * entering_ + 2.0 * per_radius * (top_m - field_.base_altitude_m()));
  first_round_ = static_cast<int>(std::floor(flattest_ / round_)) - chains_;
  rounds_ = static_cast<int>(std::floor(leaving / round_)) + 2 - first_round_;
  const double steepest = std::max(-first_round_, first_round_ + rounds_) * round_;
  margin_m_ = distance_m_ * steepest;
  rows_ =
      3 + static_cast<std::size_t>((field_.top_altitude_m() + margin_m_ - LowestRow_m()) / row_m_);
}

double CloudLowSunMap::LowestRow_m() const { return field_.base_altitude_m() - margin_m_; }

void CloudLowSunMap::MakeSlices() {
  const double per_radius = sun_.per_radius();
  const double low_m = LowestRow_m();
  const double period_m = cell_m_ * static_cast<double>(columns_);
  for (int i = 0; i < rounds_ * planes_; ++i) {
    const int round = first_round_ + i / planes_;
    const int of_period = PeriodicIndex(round, chains_);
    const int plane = i % planes_ + planes_ * ((round - of_period) / chains_);
    const double at_m = plane * distance_m_, slope = of_period * round_;
    const double height_m = at_m * (slope + 0.5 * at_m * per_radius);
    const auto row = static_cast<std::int64_t>(std::floor((low_m - height_m) / row_m_));
    const double shift_m = at_m * sun_.azimuth()[across_];
    slices_.push_back(
        {slope + at_m * per_radius,
         field_.lattice().origin_m[across_] + shift_m - period_m * std::floor(shift_m / period_m),
         height_m + static_cast<double>(row) * row_m_, row});
  }
}

void CloudLowSunMap::Fill(int chain, std::size_t first, std::size_t end) {
  const std::size_t columns = end - first;
  std::vector<float> depth(rows_ * columns);  // of beams, by l modulo the rows
  const auto rows = static_cast<std::int64_t>(rows_);
  std::int64_t next_row = std::numeric_limits<std::int64_t>::max() / 2;
  for (int round = rounds_; round-- > 0;) {
    if (PeriodicIndex(first_round_ + round, chains_) != chain) continue;
    for (int plane = planes_; plane-- > 0;) {
      const auto number = static_cast<std::size_t>(round * planes_ + plane);
      const Slice& slice = slices_[number];
      for (std::int64_t row = 0; row < rows; ++row) {
        const std::int64_t l = slice.row + row;
        float* of_row = &depth[static_cast<std::size_t>(PeriodicIndex(l, rows)) * columns];
        if (l < next_row || l >= next_row + rows) std::fill_n(of_row, columns, 0.0F);
        AddArcs(number, static_cast<std::size_t>(row), {of_row, columns}, first);
        std::uint16_t* coded =
            &value_[(number * rows_ + static_cast<std::size_t>(row)) * columns_ + first];
        std::transform(of_row, of_row + columns, coded, Coded);
      }
      next_row = slice.row;
    }
  }
}

void CloudLowSunMap::AddArcs(std::size_t slice_number, std::size_t row, std::span<float> depth,
                             std::size_t first) const {
  const Slice& slice = slices_[slice_number];
  const double low_m = field_.base_altitude_m(), high_m = field_.top_altitude_m();
  const double z = slice.low_m + static_cast<double>(row) * row_m_;
  const double rise_m = distance_m_ * (slice.slope + 0.5 * distance_m_ * sun_.per_radius());
  // The part of a beam that leaves the base downwards ends there.
  if (slice.slope < 0.0 && z + rise_m < low_m) std::fill(depth.begin(), depth.end(), 0.0F);
  if (std::max(z, z + rise_m) <= low_m || std::min(z, z + rise_m) >= high_m) return;
  const glm::dvec3 way(distance_m_ * sun_.azimuth(), rise_m);
  const auto plane = static_cast<double>(slice_number % static_cast<std::size_t>(planes_));
  glm::dvec3 from(0.0, 0.0, z);
  from[along_] = field_.lattice().origin_m[along_] + plane * way[along_];
  const double steps = std::ceil(distance_m_ / kArcStep_m);
  const auto step_m = static_cast<float>(glm::length(way) / steps);
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (depth[i] >= kOpaque) continue;
    from[across_] = slice.across_m + static_cast<double>(first + i) * cell_m_;
    double sum_per_m = 0.0;
    for (double k = 0.5; k < steps; ++k) {
      sum_per_m += field_.Extinction_per_m(from + k / steps * way);
    }
    depth[i] += step_m * static_cast<float>(sum_per_m);
  }
}

float CloudLowSunMap::OnSlice(std::size_t number, const glm::dvec3& point, Mean mean) const {
  const Slice& slice = slices_[number];
  const double u = (point[across_] - slice.across_m) / cell_m_, column = std::floor(u);
  const double v =
      std::clamp((point.z - slice.low_m) / row_m_, 0.0, static_cast<double>(rows_ - 1));
  const auto row = std::min(static_cast<std::size_t>(v), rows_ - 2);
  const auto columns = static_cast<std::int64_t>(columns_);
  const auto west =
      static_cast<std::size_t>(PeriodicIndex(static_cast<std::int64_t>(column), columns));
  const std::size_t east = west + 1 < columns_ ? west + 1 : 0;
  const auto share = static_cast<float>(u - column);
  const auto read = [&](std::uint16_t value) {
    return mean == Mean::kOfRoots ? std::sqrt(Decoded(value)) : Decoded(value);
  };
  const auto in_row = [&](std::size_t k) {
    const std::uint16_t* value = &value_[(number * rows_ + k) * columns_];
    return std::lerp(read(value[west]), read(value[east]), share);
  };
  return std::lerp(in_row(row), in_row(row + 1), static_cast<float>(v - static_cast<double>(row)));
}

float CloudLowSunMap::RestFrom(const CloudBeam& beam, std::int64_t plane, double distance_m,
                               Mean mean) const {
  const glm::dvec3 point = beam.At(distance_m);
  const auto number = static_cast<int>(PeriodicIndex(plane, static_cast<std::int64_t>(planes_)));
  const double at =
      (beam.SlopeAt(distance_m) - number * distance_m_ * sun_.per_radius()) / round_ - first_round_;
  const double round = std::clamp(std::floor(at), 0.0, static_cast<double>(rounds_ - 2));
  const auto slice = static_cast<std::size_t>(static_cast<int>(round) * planes_ + number);
  return std::lerp(OnSlice(slice, point, mean),
                   OnSlice(slice + static_cast<std::size_t>(planes_), point, mean),
                   static_cast<float>(std::clamp(at - round, 0.0, 1.0)));
}

double CloudLowSunMap::PlanesBefore(const glm::dvec3& point) const {
  return (point[along_] - field_.lattice().origin_m[along_]) /
         (distance_m_ * sun_.azimuth()[along_]);
}

double CloudLowSunMap::NearDepth(const CloudBeam& beam, double end_m) const {
  double depth = 0.0, at_m = 0.0, step_m = kNearStep_m;
  while (at_m < end_m && depth < CloudLowSun::kDeepest) {
    const double length_m = std::min(step_m, end_m - at_m);
    depth += length_m * field_.Extinction_per_m(beam.At(at_m + 0.5 * length_m));
    at_m += length_m;
    step_m = std::min(kNearGrowth * step_m, kMostNearStep_m);
  }
  return depth;
}

double CloudLowSunMap::DepthOf(const CloudBeam& beam, const CloudBeam::Part& part,
                               Mean mean) const {
  if (part.is_empty()) return 0.0;
  if (beam.SlopeAt(part.begin_m) > entering_) return sun_.OpticalDepthOf(beam, part);
  const double before = PlanesBefore(beam.from);
  const double plane = std::ceil(before + std::max(part.begin_m, kNear_m) / distance_m_);
  const double to_plane_m = (plane - before) * distance_m_;
  const double end_m = std::min(to_plane_m, part.end_m);
  const double depth = part.begin_m > 0.0 ? sun_.OpticalDepthOf(beam, {part.begin_m, end_m})
                                          : NearDepth(beam, end_m);
  if (end_m < to_plane_m || depth >= CloudLowSun::kDeepest) return depth;
  const float rest = RestFrom(beam, static_cast<std::int64_t>(plane), to_plane_m, mean);
  return depth - (mean == Mean::kOfRoots ? 2.0 : 1.0) * static_cast<double>(std::log(rest));
}

double CloudLowSunMap::DepthFrom(const glm::dvec3& point, double slope, Mean mean) const {
  const double seen = std::max(slope, hidden_);
  if (!Holds(seen)) return sun_.OpticalDepth(point, seen);
  const CloudBeam beam = sun_.BeamFrom(point, seen);
  return CloudLowSun::WithReturned(beam, DepthOf(beam, beam.first, mean),
                                   [&] { return DepthOf(beam, beam.returned, mean); });
}

double CloudLowSunMap::OpticalDepth(const glm::dvec3& point, double slope) const {
  return DepthFrom(point, slope, Mean::kOfRoots);
}

double CloudLowSunMap::Transmittance(const glm::dvec3& point, double slope) const {
  return std::exp(-DepthFrom(point, slope, Mean::kOfLight));
}

double CloudLowSunMap::TransmittanceAround(const glm::dvec3& point) const {
  const double slope = std::max(sun_.SlopeAt(point), hidden_);
  if (!Holds(slope)) return std::exp(-sun_.OpticalDepth(point, slope));
  const CloudBeam beam = sun_.BeamFrom(point, slope);
  const double before = PlanesBefore(point);
  const auto left = [&](const CloudBeam::Part& part) {
    if (part.is_empty()) return 1.0;
    if (beam.SlopeAt(part.begin_m) > entering_) return std::exp(-sun_.OpticalDepthOf(beam, part));
    const double at = before + part.begin_m / distance_m_, plane = std::floor(at);
    const auto number = static_cast<std::int64_t>(plane);
    const double behind_m = (plane - before) * distance_m_;
    return static_cast<double>(
        std::lerp(RestFrom(beam, number, behind_m, Mean::kOfLight),
                  RestFrom(beam, number + 1, behind_m + distance_m_, Mean::kOfLight),
                  static_cast<float>(at - plane)));
  };
  const double first = left(beam.first);
  if (beam.returning <= 0.0) return first;
  return first * (1.0 - beam.returning * (1.0 - left(beam.returned)));
}

std::uint64_t CloudLowSunMap::hash() const {
  Fnv1a hash;
  hash.AddBytes(
      {reinterpret_cast<const char*>(value_.data()), value_.size() * sizeof(std::uint16_t)});
  return hash.hash();
}

}  // namespace alpenglow::renderer
