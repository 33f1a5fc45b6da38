// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_moments.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "lut/multiple_scattering/moment_kernel.h"
#include "renderer/cloud_light/cloud_krylov.h"

namespace alpenglow::renderer {
namespace {

constexpr int kPolarNodes = 3, kAzimuths = 8;
constexpr std::size_t kDirections = 2U * kPolarNodes * kAzimuths;
// Cells that are computed at once between moments and directions.
constexpr std::size_t kCellsAtOnce = 64;

struct CloudDirection {
  glm::dvec3 travel;
  double solid_angle_sr;
};

/// Returns the nodes of Gauss on both hemispheres; azimuths of neighbouring cosines alternate.
std::vector<CloudDirection> CloudDirections() {
  const GaussRule& rule = GaussLegendre(kPolarNodes);
  std::vector<CloudDirection> directions;
  for (int side = -1; side <= 1; side += 2) {
    for (int node = 0; node < kPolarNodes; ++node) {
      const auto n = static_cast<std::size_t>(node);
      const double cosine = side * rule.node[n], sine = std::sqrt(1.0 - cosine * cosine);
      for (int i = 0; i < kAzimuths; ++i) {
        const int turned = (node + (side > 0 ? 1 : 0)) % 2;
        const double azimuth_rad = 2.0 * kPi * (i + 0.25 + 0.5 * turned) / kAzimuths;
        directions.push_back({{sine * std::cos(azimuth_rad), sine * std::sin(azimuth_rad), cosine},
                              2.0 * kPi * rule.weight[n] / kAzimuths});
      }
    }
  }
  return directions;
}

/// The steps of the tracks of one direction, and the lines where tracks enter.
struct CloudTrack {
  std::vector<CloudTrackStep> steps;
  std::size_t shifts = 0;
  int first_line = 0, end_line = 0;
  glm::dvec2 leaves_at_m{0.0};  // in the last cell, from its corner
};

/// Subtracts from the offsets of segments their mean over each level.
void CentreOffsets(std::vector<CloudTrackStep>& steps) {
  for (std::size_t first = 0; first < steps.size();) {
    std::size_t end = first;
    std::array<float, 3> sum{};
    float length_m = 0.0F;
    for (; end < steps.size() && steps[end].level == steps[first].level; ++end) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        sum[axis] += steps[end].length_m * steps[end].offsets_m[axis];
      length_m += steps[end].length_m;
    }
    for (; first < end; ++first) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        steps[first].offsets_m[axis] -= sum[axis] / length_m;
    }
  }
}

/// Returns the steps from the plane where tracks enter to the other one. Tracks of different
/// directions enter columns at different places (by Halton's points), none near a border.
CloudTrack TrackAlong(const CloudCells& cells, const glm::dvec3& travel, int number) {
  const glm::dvec3 cell_m = cells.cell_m();
  const int levels = cells.count()[2];
  const glm::dvec3 enters(0.13 + 0.74 * Halton(number + 1, 2), 0.13 + 0.74 * Halton(number + 1, 3),
                          travel.z > 0.0 ? 0.0 : 1.0);
  std::array<int, 3> cell{0, 0, travel.z > 0.0 ? 0 : levels - 1};
  const glm::dvec3 origin_m = (enters + glm::dvec3(0, 0, cell[2])) * cell_m;
  glm::dvec3 next_m, spacing_m;
  for (int axis = 0; axis < 3; ++axis) {
    const double slope = std::max(std::abs(travel[axis]), 1e-9);
    spacing_m[axis] = cell_m[axis] / slope;
    next_m[axis] = spacing_m[axis] * (travel[axis] > 0.0 ? 1.0 - enters[axis] : enters[axis]);
  }
  CloudTrack track;
  double at_m = 0.0;
  int column = 0, least_line = 0, most_line = 0;
  while (cell[2] >= 0 && cell[2] < levels) {
    const int axis =
        next_m.x < next_m.y ? (next_m.x < next_m.z ? 0 : 2) : (next_m.y < next_m.z ? 1 : 2);
    const double middle_m = 0.5 * (at_m + next_m[axis]);
    const glm::dvec3 centre_m = (glm::dvec3(cell[0], cell[1], cell[2]) + 0.5) * cell_m;
    const glm::dvec3 off_m = origin_m + middle_m * travel - centre_m;
    track.steps.push_back(
        {cell[0] - column,
         cell[1],
         cell[2],
         static_cast<float>(next_m[axis] - at_m),
         static_cast<float>(glm::dot(off_m, travel)),
         {static_cast<float>(off_m.x), static_cast<float>(off_m.y), static_cast<float>(off_m.z)}});
    track.shifts += cell[0] != column ? 1 : 0;
    column = cell[0];
    least_line = std::min(least_line, cell[1]);
    most_line = std::max(most_line, cell[1]);
    at_m = next_m[axis];
    next_m[axis] += spacing_m[axis];
    cell[static_cast<std::size_t>(axis)] += travel[axis] > 0.0 ? 1 : -1;
  }
  CentreOffsets(track.steps);
  const CloudTrackStep& last = track.steps.back();
  track.leaves_at_m =
      glm::dvec2(origin_m + at_m * travel) - glm::dvec2(column, last.line) * glm::dvec2(cell_m);
  const int lines = cells.count()[1];
  track.first_line = cells.is_periodic() ? 0 : -most_line;
  track.end_line = cells.is_periodic() ? lines : lines - least_line;
  return track;
}

/// Power that the scaled beam loses, for unit irradiance across it.
struct CollidedLight {
  std::vector<double> of_cell_m2;  // by full cell
  double lost_m2 = 0.0;            // in wisps far from full cells

  [[nodiscard]] double Sum_m2() const {
    double sum = lost_m2;
    for (const double each : of_cell_m2) sum += each;
    return sum;
  }
};

/// Lines of beams are shared among this number of sums, which are added in order.
constexpr int kBeamSums = 16;

/// Returns the sum of light that visit(i, add) adds by add(point, collided_m2), for i < kBeamSums.
template <typename Visit>
CollidedLight SumOfCollided(const CloudCells& cells, const glm::dvec3& ahead, const Visit& visit) {
  std::vector<CollidedLight> sums(kBeamSums);
  tbb::parallel_for(0, kBeamSums, [&](int i) {
    CollidedLight& sum = sums[static_cast<std::size_t>(i)];
    sum.of_cell_m2.assign(cells.full(), 0.0);
    visit(i, [&](const glm::dvec3& point, double collided_m2) {
      const std::int32_t cell = cells.FullCellAt(point, ahead);
      (cell < 0 ? sum.lost_m2 : sum.of_cell_m2[static_cast<std::size_t>(cell)]) += collided_m2;
    });
  });
  CollidedLight all = std::move(sums.front());
  for (std::size_t i = 1; i < sums.size(); ++i) {
    all.lost_m2 += sums[i].lost_m2;
    for (std::size_t cell = 0; cell < all.of_cell_m2.size(); ++cell) {
      all.of_cell_m2[cell] += sums[i].of_cell_m2[cell];
    }
  }
  return all;
}

CollidedLight CollidedOfMap(const CloudCells& cells, const CloudSunMap& map,
                            double extinction_scale) {
  return SumOfCollided(cells, -map.to_sun(), [&](int i, const auto& add) {
    const auto add_part = [&](const CloudSunMap::BeamPart& part) {
      add(part.middle, -map.to_sun().z * part.area_m2 *
                           std::exp(-extinction_scale * part.depth_above) *
                           std::expm1(-extinction_scale * (part.depth_below - part.depth_above)));
    };
    for (int line = map.lines() * i / kBeamSums; line < map.lines() * (i + 1) / kBeamSums; ++line) {
      map.EachPartOfLine(line, add_part);
    }
  });
}

CollidedLight CollidedOfLowSun(const CloudCells& cells, const CloudField& field,
                               const CloudLowSunMap& sun, double extinction_scale) {
  constexpr std::size_t kPoints = 8;
  const glm::dvec3 cell_m = cells.cell_m();
  const double scale_m3 = extinction_scale * cell_m.x * cell_m.y * cell_m.z / kPoints;
  return SumOfCollided(cells, -sun.sun().to_sun(), [&](int i, const auto& add) {
    const auto part = static_cast<std::size_t>(i);
    const std::size_t end = cells.size() * (part + 1) / kBeamSums * kPoints;
    for (std::size_t k = cells.size() * part / kBeamSums * kPoints; k < end; ++k) {
      const auto number = static_cast<int>(k + 1);
      const glm::dvec3 inside(Halton(number, 2), Halton(number, 3), Halton(number, 5));
      const glm::dvec3 point = cells.Middle(k / kPoints) + (inside - 0.5) * cell_m;
      const double extinction_per_m = field.Extinction_per_m(point);
      if (extinction_per_m <= 0.0) continue;
      add(point, scale_m3 * extinction_per_m *
                     std::exp(-extinction_scale * sun.OpticalDepthAsAtPlace(point)));
    }
  });
}

CollidedLight CollidedIn(const CloudCells& cells, const CloudSunDepths& to_sun,
                         double extinction_scale) {
  return to_sun.map()
             ? CollidedOfMap(cells, *to_sun.map(), extinction_scale)
             : CollidedOfLowSun(cells, to_sun.field(), *to_sun.low_map(), extinction_scale);
}

/// Returns the light of fine cells by coarse ones.
CollidedLight OnCoarseCells(const CollidedLight& fine, const CloudCells& fine_cells,
                            const CloudCells& cells, const glm::dvec3& ahead) {
  CollidedLight coarse{std::vector<double>(cells.full(), 0.0), fine.lost_m2};
  for (std::size_t i = 0; i < fine_cells.full(); ++i) {
    const std::int32_t cell = cells.FullCellAt(fine_cells.Middle(i), ahead);
    (cell < 0 ? coarse.lost_m2 : coarse.of_cell_m2[static_cast<std::size_t>(cell)]) +=
        fine.of_cell_m2[i];
  }
  return coarse;
}

/// Returns the mean irradiance of the scaled beam in full cells. What is lost far from them is given
/// to all of them.
std::vector<float> BeamIn(const CloudCells& cells, const CollidedLight& collided,
                          double extinction_scale) {
  const glm::dvec3 cell_m = cells.cell_m();
  const double volume_m3 = cell_m.x * cell_m.y * cell_m.z;
  const double kept_m2 = collided.Sum_m2() - collided.lost_m2;
  const double all = kept_m2 > 0.0 ? collided.Sum_m2() / kept_m2 : 1.0;
  std::vector<float> beam(cells.full());
  for (std::size_t cell = 0; cell < beam.size(); ++cell) {
    beam[cell] = static_cast<float>(all * collided.of_cell_m2[cell] /
                                    (extinction_scale * cells.Extinction_per_m(cell) * volume_m3));
  }
  return beam;
}

/// Arrays for the tracks of one thread.
struct TrackRoom {
  lut::AlignedFloats source, slope_per_m, sum_m;
  std::array<lut::AlignedFloats, 3> slopes_per_m;  // in a body
  std::vector<float> track;
};

}  // namespace

/// The sources from which light begins.
struct CloudMomentSolver::Source {
  std::vector<float> beam;          // mean irradiance of the scaled beam in full cells; or nothing
  CloudHarmonics beam_harmonics{};  // of the beam's direction of travel
  std::vector<CloudHarmonics> incident;  // moments of beams in full cells; or nothing
  std::vector<float> entering;           // radiance of each direction; or nothing
};

/// The cells of one size and the tracks through them.
class CloudMomentSolver::Grid {
 public:
  /// @param extinction_per_m  by which the extinction of cells is multiplied.
  Grid(std::shared_ptr<const CloudCells> cells, double extinction_per_m,
       std::shared_ptr<const CloudOptics> optics)
      : cells_(std::move(cells)),
        optics_(std::move(optics)),
        directions_(CloudDirections()),
        extinction_per_m_(std::max<std::size_t>(cells_->lanes(), kCloudLanes)) {
    for (std::size_t cell = 0; cell < cells_->full(); ++cell) {
      extinction_per_m_.data()[cells_->Lane(cell)] = static_cast<float>(
          optics_->extinction_scale() * extinction_per_m * cells_->Extinction_per_m(cell));
    }
    for (std::size_t i = 0; i < directions_.size(); ++i) {
      const glm::dvec3& travel = directions_[i].travel;
      tracks_.push_back(TrackAlong(*cells_, travel, static_cast<int>(i)));
      source_factors_.push_back(optics_->SourceFactors(travel));
      harmonics_.push_back(CloudHarmonicsOf(travel));
      // Tracks stand for the area of a column each.
      const double per_m = directions_[i].solid_angle_sr * std::abs(travel.z) / cells_->cell_m().z;
      for (float& each : harmonics_.back()) each *= static_cast<float>(per_m);
    }
  }

  [[nodiscard]] const std::shared_ptr<const CloudCells>& cells() const { return cells_; }
  [[nodiscard]] std::size_t bytes() const {
    return cells_->bytes() + extinction_per_m_.size() * sizeof(float);
  }

  /// Moments of light on full or all stored cells, and fluxes through the planes.
  struct Swept {
    std::vector<CloudHarmonics> moments;
    double up_at_top = 0.0, down_at_base = 0.0;
    std::vector<CloudBaseLight> through_base = {};  // of a periodic field, if light is everywhere
  };
  /// Returns the light that scattered light of `moments` and a source make along all tracks.
  /// @param moments  of at least all full cells, or null. @param source  or null.
  /// @param everywhere  whether light around full cells is wanted, too.
  [[nodiscard]] Swept Sweep(const CloudHarmonics* moments, const Source* source,
                            bool everywhere) const;

  /// Returns 0, or in a white body the mean radiance that enters: the deeper it is, the longer takes
  /// the solution to find it.
  [[nodiscard]] std::vector<CloudHarmonics> FirstGuess(const Source& source) const;
  /// Solves M = K M + b, and returns M on all stored cells.
  /// @param guess  moments of a coarser grid, or null.
  [[nodiscard]] SolvedCloudMoments Solve(const Source& source, const CloudMoments* guess,
                                         const CloudMomentOptions& options) const;

 private:
  /// Values of every direction and cell: the source before, the integral along tracks after.
  using DirectionValues = std::vector<std::vector<float>>;
  void FillSources(const CloudHarmonics* moments, const Source* source,
                   DirectionValues& values) const;
  /// Finds the slope of the source along the tracks of a direction, in a field.
  void FindSlopesAlong(std::size_t direction, TrackRoom& room) const;
  /// Finds this slope and those along all axes, in a body.
  void FindSlopes(std::size_t direction, TrackRoom& room) const;
  /// Returns the sum of the radiances with which tracks leave.
  /// @param leaving  see CloudTrackWork.
  [[nodiscard]] double Follow(std::size_t direction, float entering, bool everywhere,
                              std::vector<float>& values, TrackRoom& room, float* leaving) const;
  [[nodiscard]] std::vector<CloudHarmonics> MomentsOf(const DirectionValues& values,
                                                      std::size_t count) const;

  std::shared_ptr<const CloudCells> cells_;
  std::shared_ptr<const CloudOptics> optics_;
  std::vector<CloudDirection> directions_;
  std::vector<CloudTrack> tracks_;
  std::vector<CloudHarmonics> source_factors_, harmonics_;  // of each direction
  lut::AlignedFloats extinction_per_m_;
};

void CloudMomentSolver::Grid::FillSources(const CloudHarmonics* moments, const Source* source,
                                          DirectionValues& values) const {
  const bool has_beam = source != nullptr && !source->beam.empty();
  const bool has_incident = source != nullptr && !source->incident.empty();
  const std::size_t blocks = (cells_->full() + kCellsAtOnce - 1) / kCellsAtOnce;
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t block) {
    const std::size_t first = block * kCellsAtOnce;
    const std::size_t count = std::min(kCellsAtOnce, cells_->full() - first);
    std::array<std::array<float, kCellsAtOnce>, kCloudMoments> moment{};
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < kCloudMoments; ++k) {
        float value = moments != nullptr ? moments[first + i][k] : 0.0F;
        if (has_beam) value += source->beam_harmonics[k] * source->beam[first + i];
        if (has_incident) value += source->incident[first + i][k];
        moment[k][i] = value;
      }
    }
    for (std::size_t d = 0; d < kDirections; ++d) {
      std::array<float, kCellsAtOnce> sum{};
      for (std::size_t k = 0; k < kCloudMoments; ++k) {
        const float factor = source_factors_[d][k];
        for (std::size_t i = 0; i < kCellsAtOnce; ++i) sum[i] += factor * moment[k][i];
      }
      std::copy_n(sum.begin(), count, values[d].begin() + static_cast<std::ptrdiff_t>(first));
    }
  });
}

void CloudMomentSolver::Grid::FindSlopesAlong(std::size_t direction, TrackRoom& room) const {
  const float* source = room.source.data();
  const glm::vec3 travel(directions_[direction].travel);
  for (std::size_t cell = 0; cell < cells_->full(); ++cell) {
    const auto& [x, y, z] = cells_->NeighboursOf(cell);
    room.slope_per_m.data()[cells_->Lane(cell)] =
        travel.x * x.per_m * (source[x.after] - source[x.before]) +
        travel.y * y.per_m * (source[y.after] - source[y.before]) +
        travel.z * z.per_m * (source[z.after] - source[z.before]);
  }
}

void CloudMomentSolver::Grid::FindSlopes(std::size_t direction, TrackRoom& room) const {
  const float* source = room.source.data();
  const glm::vec3 travel(directions_[direction].travel);
  for (std::size_t cell = 0; cell < cells_->full(); ++cell) {
    const std::uint32_t lane = cells_->Lane(cell);
    const std::array<CloudCells::Neighbours, 3>& beside = cells_->NeighboursOf(cell);
    float along = 0.0F;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const CloudCells::Neighbours& of = beside[axis];
      const float before = source[of.before], after = source[of.after];
      const float slope =
          of.per_m * (after - before) + of.bend_per_m * (after + before - 2.0F * source[lane]);
      room.slopes_per_m[axis].data()[lane] = slope;
      along += travel[static_cast<int>(axis)] * slope;
    }
    room.slope_per_m.data()[lane] = along;
  }
}

double CloudMomentSolver::Grid::Follow(std::size_t direction, float entering, bool everywhere,
                                       std::vector<float>& values, TrackRoom& room,
                                       float* leaving) const {
  const std::size_t lanes = extinction_per_m_.size();
  const CloudTrack& track = tracks_[direction];
  const auto columns = static_cast<std::size_t>(cells_->count()[0]);
  if (room.source.size() == 0) {
    room.source = room.slope_per_m = room.sum_m = lut::AlignedFloats(lanes);
    if (cells_->is_body()) room.slopes_per_m.fill(room.source);
  }
  room.track.resize(std::max(room.track.size(), CloudTrackRoom(columns, track.shifts)));
  float* source = room.source.data();
  float* sum_m = room.sum_m.data();
  for (std::size_t cell = 0; cell < cells_->full(); ++cell) {
    source[cells_->Lane(cell)] = values[cell];
  }
  if (cells_->is_body()) {
    FindSlopes(direction, room);
  } else {
    FindSlopesAlong(direction, room);
  }
  const CloudCells::Runs& runs = everywhere ? cells_->all_runs() : cells_->full_runs();
  std::array<const float*, 3> slopes_per_m{};
  if (cells_->is_body()) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      slopes_per_m[axis] = room.slopes_per_m[axis].data();
  }
  const CloudTrackWork work{.steps = track.steps.data(),
                            .step_count = track.steps.size(),
                            .columns = columns,
                            .lines = cells_->count()[1],
                            .is_periodic = cells_->is_periodic(),
                            .runs = runs.run.data(),
                            .row_first = runs.row_first.data(),
                            .extinction_per_m = extinction_per_m_.data(),
                            .source = source,
                            .slope_per_m = room.slope_per_m.data(),
                            .slopes_per_m = slopes_per_m,
                            .sum_m = sum_m,
                            .entering = entering,
                            .track = room.track.data(),
                            .leaving = leaving};
  const double sum = Kernel<CloudTrackKernel>().follow(work, track.first_line, track.end_line);
  for (std::size_t cell = 0; cell < values.size(); ++cell) values[cell] = sum_m[cells_->Lane(cell)];
  std::fill_n(sum_m, lanes, 0.0F);
  return sum;
}

std::vector<CloudHarmonics> CloudMomentSolver::Grid::MomentsOf(const DirectionValues& values,
                                                               std::size_t count) const {
  std::vector<CloudHarmonics> moments(count);
  const std::size_t blocks = (count + kCellsAtOnce - 1) / kCellsAtOnce;
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t block) {
    const std::size_t first = block * kCellsAtOnce;
    const std::size_t end = std::min(count, first + kCellsAtOnce);
    for (std::size_t d = 0; d < kDirections; ++d) {
      const CloudHarmonics& factor = harmonics_[d];
      for (std::size_t cell = first; cell < end; ++cell) {
        const float value = values[d][cell];
        for (std::size_t k = 0; k < kCloudMoments; ++k) moments[cell][k] += factor[k] * value;
      }
    }
  });
  return moments;
}

CloudMomentSolver::Grid::Swept CloudMomentSolver::Grid::Sweep(const CloudHarmonics* moments,
                                                              const Source* source,
                                                              bool everywhere) const {
  const std::size_t count = everywhere ? cells_->size() : cells_->full();
  DirectionValues values(kDirections, std::vector<float>(count));
  FillSources(moments, source, values);
  std::vector<double> leaving(kDirections, 0.0);
  std::vector<CloudBaseLight> through_base;
  for (std::size_t d = 0; everywhere && cells_->is_periodic() && d < kDirections; ++d) {
    if (directions_[d].travel.z >= 0.0) break;  // those downwards come first
    const auto columns =
        static_cast<std::size_t>(cells_->count()[0]) * static_cast<std::size_t>(cells_->count()[1]);
    through_base.push_back({directions_[d].travel, directions_[d].solid_angle_sr,
                            tracks_[d].leaves_at_m, std::vector<float>(columns)});
  }
  tbb::enumerable_thread_specific<TrackRoom> rooms;
  tbb::parallel_for(std::size_t{0}, kDirections, [&](std::size_t d) {
    const float entering =
        source != nullptr && !source->entering.empty() ? source->entering[d] : 0.0F;
    float* each = d < through_base.size() ? through_base[d].radiance.data() : nullptr;
    leaving[d] = Follow(d, entering, everywhere, values[d], rooms.local(), each);
  });
  Swept swept{.moments = MomentsOf(values, count), .through_base = std::move(through_base)};
  if (!cells_->is_periodic()) return swept;
  const double tracks = static_cast<double>(cells_->count()[0]) * cells_->count()[1];
  for (std::size_t d = 0; d < kDirections; ++d) {
    const double flux =
        directions_[d].solid_angle_sr * std::abs(directions_[d].travel.z) * leaving[d] / tracks;
    (directions_[d].travel.z > 0.0 ? swept.up_at_top : swept.down_at_base) += flux;
  }
  return swept;
}

std::vector<CloudHarmonics> CloudMomentSolver::Grid::FirstGuess(const Source& source) const {
  constexpr double kNearlyWhite = 0.999, kRootOf4Pi = 3.5449077018110318;
  std::vector<CloudHarmonics> guess(cells_->full());
  if (!cells_->is_body() || source.entering.empty() || optics_->albedo() < kNearlyWhite)
    return guess;
  double sum = 0.0;
  for (std::size_t d = 0; d < kDirections; ++d)
    sum += directions_[d].solid_angle_sr * static_cast<double>(source.entering[d]);
  for (CloudHarmonics& of : guess) of[0] = static_cast<float>(sum / kRootOf4Pi);
  return guess;
}

SolvedCloudMoments CloudMomentSolver::Grid::Solve(const Source& source, const CloudMoments* guess,
                                                  const CloudMomentOptions& options) const {
  const std::vector<CloudHarmonics> right_side = Sweep(nullptr, &source, false).moments;
  std::vector<CloudHarmonics> start = FirstGuess(source);
  if (guess != nullptr) {
    tbb::parallel_for(std::size_t{0}, cells_->full(),
                      [&](std::size_t cell) { start[cell] = guess->At(cells_->Middle(cell)); });
  }
  const KrylovSolution found =
      SolveByKrylov(right_side, std::move(start), options.tolerance, options.most_sweeps,
                    [&](const std::vector<CloudHarmonics>& in) {
                      return Sweep(in.data(), nullptr, false).moments;
                    });
  Swept swept = Sweep(found.moments.data(), &source, true);
  return {CloudMoments(cells_, std::move(swept.moments)),
          swept.up_at_top,
          swept.down_at_base,
          std::move(swept.through_base),
          found.applications + 2,
          found.residual};
}

CloudHarmonics CloudMoments::Of(const CloudCells::Mixture& mixture) const {
  CloudHarmonics mean{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(mixture.count); ++i) {
    const CloudHarmonics& of = moments_[mixture.cell[i]];
    for (std::size_t k = 0; k < kCloudMoments; ++k) mean[k] += mixture.weight[i] * of[k];
  }
  return mean;
}

float CloudMoments::Source(const CloudCells::Mixture& mixture,
                           const CloudHarmonics& factors) const {
  const CloudHarmonics moments = Of(mixture);
  float source = 0.0F;
  for (std::size_t k = 0; k < kCloudMoments; ++k) source += factors[k] * moments[k];
  return source;
}

double UsualCloudCell_m(const CloudField& field) {
  constexpr double kFine_m = 40.0, kCoarse_m = 80.0, kMostFine_m = 8000.0;
  const glm::dvec3 size_m = field.lattice().size_m();
  return size_m.x * size_m.y <= kMostFine_m * kMostFine_m ? kFine_m : kCoarse_m;
}

CloudMomentSolver::CloudMomentSolver(const std::vector<std::shared_ptr<const CloudCells>>& cells,
                                     double extinction_per_m,
                                     std::shared_ptr<const CloudOptics> optics,
                                     const CloudMomentOptions& options)
    : optics_(std::move(optics)), options_(options) {
  RequireInRange(options.tolerance, 1e-6, 0.5, "the tolerance of light in clouds");
  if (options.most_sweeps < 1) throw InputError("light in clouds needs one sweep or more");
  for (const auto& each : cells)
    grids_.push_back(std::make_unique<const Grid>(each, extinction_per_m, optics_));
}

CloudMomentSolver::CloudMomentSolver(const CloudField& field,
                                     std::shared_ptr<const CloudOptics> optics,
                                     const CloudMomentOptions& options)
    : CloudMomentSolver({}, 1.0, std::move(optics), options) {
  const double cell_m = RequireInRange(options.cell_m.value_or(UsualCloudCell_m(field)), 10.0,
                                       2500.0, "the side of cells of light in clouds [m]");
  for (const double times : {4.0, 2.0, 1.0}) {
    grids_.push_back(std::make_unique<const Grid>(
        std::make_shared<const CloudCells>(field, times * cell_m), 1.0, optics_));
  }
}

CloudMomentSolver::~CloudMomentSolver() = default;
CloudMomentSolver::CloudMomentSolver(CloudMomentSolver&&) noexcept = default;
CloudMomentSolver& CloudMomentSolver::operator=(CloudMomentSolver&&) noexcept = default;

std::size_t CloudMomentSolver::bytes() const {
  std::size_t bytes = 0;
  for (const auto& grid : grids_) bytes += grid->bytes();
  return bytes;
}

const CloudCells& CloudMomentSolver::cells() const { return *grids_.back()->cells(); }

SolvedCloudMoments CloudMomentSolver::Cascade(const std::vector<Source>& sources) const {
  std::optional<SolvedCloudMoments> solved;
  for (std::size_t i = 0; i < grids_.size(); ++i) {
    solved = grids_[i]->Solve(sources[i], solved ? &solved->moments : nullptr, options_);
  }
  return std::move(*solved);
}

SolvedCloudMoments CloudMomentSolver::Sun(const CloudSunDepths& to_sun) const {
  const double scale = optics_->extinction_scale();
  const CollidedLight collided = CollidedIn(cells(), to_sun, scale);
  std::vector<Source> sources(grids_.size());
  for (std::size_t i = 0; i < grids_.size(); ++i) {
    const CloudCells& of = *grids_[i]->cells();
    const bool is_finest = i + 1 == grids_.size();
    sources[i].beam_harmonics = CloudHarmonicsOf(-to_sun.to_sun());
    sources[i].beam = BeamIn(
        of, is_finest ? collided : OnCoarseCells(collided, cells(), of, -to_sun.to_sun()), scale);
  }
  SolvedCloudMoments solved = Cascade(sources);
  if (cells().is_periodic()) {
    // The scaled beam has light that droplets turn by a few degrees.
    const glm::dvec3 size_m =
        cells().cell_m() * glm::dvec3(cells().count()[0], cells().count()[1], 1.0);
    const double level = std::max(to_sun.to_sun().z, 0.0);
    const double scaled = level - collided.Sum_m2() / (size_m.x * size_m.y);
    const double peak = scaled - level * to_sun.MeanTransmittance();
    solved.down_at_base += to_sun.map() ? peak : std::max(peak, 0.0);
  }
  return solved;
}

SolvedCloudMoments CloudMomentSolver::None() const {
  const std::shared_ptr<const CloudCells>& of = grids_.back()->cells();
  return {CloudMoments(of, std::vector<CloudHarmonics>(of->size()))};
}

SolvedCloudMoments CloudMomentSolver::Sky() const {
  return Light({.entering = [](const glm::dvec3& travel) { return travel.z < 0.0 ? 1.0 : 0.0; },
                .incident = nullptr});
}

SolvedCloudMoments CloudMomentSolver::Ground() const {
  return Light({.entering = [](const glm::dvec3& travel) { return travel.z > 0.0 ? 1.0 : 0.0; },
                .incident = nullptr});
}

SolvedCloudMoments CloudMomentSolver::Light(const CloudIllumination& light) const {
  std::vector<Source> sources(grids_.size());
  for (std::size_t i = 0; i < grids_.size(); ++i) {
    if (light.entering) {
      for (const CloudDirection& direction : CloudDirections())
        sources[i].entering.push_back(static_cast<float>(light.entering(direction.travel)));
    }
    if (light.incident) sources[i].incident = light.incident(*grids_[i]->cells());
  }
  return Cascade(sources);
}

}  // namespace alpenglow::renderer
