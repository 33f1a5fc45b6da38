// SPDX-License-Identifier: MIT
#include "renderer/clouds/cirrus.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "renderer/clouds/cloud_cover.h"
#include "renderer/clouds/periodic_index.h"
#include "renderer/clouds/periodic_map.h"
#include "renderer/clouds/portable_functions.h"
#include "renderer/clouds/shape_noise.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

constexpr double kLeastRadius_m = 10.0, kMostRadius_m = 25.0;
constexpr double kNodeSpacing_m = 150.0;
constexpr double kLife_s = 4000.0;  // of a tuft
constexpr double kPatches_m = 3413.3;

/// A tuft, from which fibres fall.
struct Tuft {
  glm::dvec3 place;
  glm::dvec2 wind;  // direction
  double length_m;  // L of a fibre that falls to the base
  double across_m;  // extent across the wind
  double along_m;   // extent along the wind
  double strength;  // in [0, 1], by its age
  int fibres;
};

/// Makes the tufts and fibres of a field.
class FibreSource {
 public:
  FibreSource(const CloudOptions& options, double time_s)
      : options_(options), time_s_(time_s), wind_(WindDirection(options)) {}

  /// Returns a tuft of the sequence.
  [[nodiscard]] Tuft TuftOf(int number) const {
    CountedRandom random(options_.seed * 6271U + 29U, static_cast<std::uint32_t>(number));
    Tuft tuft{};
    tuft.place = PlaceOf(random);
    const glm::dvec2 turn = PortableCircle(random.Between(-0.02, 0.02));
    tuft.wind = {wind_.x * turn.x - wind_.y * turn.y, wind_.x * turn.y + wind_.y * turn.x};
    tuft.length_m = random.Between(2000.0, 8000.0) * options_.depth_m / 1200.0;
    tuft.across_m = random.Between(150.0, 700.0);
    tuft.along_m = random.Between(300.0, 4000.0);
    const double lives = time_s_ / kLife_s + random.Uniform();
    const double age = lives - std::floor(lives);
    tuft.strength = SmoothRamp(0.0, 0.3, age) * (1.0 - SmoothRamp(0.7, 1.0, age));
    tuft.fibres = 20 + static_cast<int>(60.0 * random.Uniform());
    return tuft;
  }

  /// Returns a fibre of a tuft.
  [[nodiscard]] Fibre FibreOf(const Tuft& tuft, int tuft_number, int number) const {
    CountedRandom random(options_.seed * 6271U + 31U + static_cast<std::uint32_t>(number),
                         static_cast<std::uint32_t>(tuft_number));
    const glm::dvec2 across(-tuft.wind.y, tuft.wind.x);
    // The sum of three numbers is dense in the middle of the tuft.
    const double aside = random.Uniform() + random.Uniform() + random.Uniform() - 1.5;
    const glm::dvec3 head =
        tuft.place + glm::dvec3(tuft.across_m * aside * across +
                                    tuft.along_m * random.Between(-0.5, 0.5) * tuft.wind,
                                random.Between(-0.08, 0.08) * options_.depth_m);
    const double possible = head.z - options_.base_altitude_m;
    const double fall = possible * random.Between(0.2, 1.0);
    const double length = tuft.length_m * fall / possible * random.Between(0.8, 1.2);
    const double radius = tuft.strength * random.Between(kLeastRadius_m, kMostRadius_m);
    const double knots = random.Uniform() * 1000.0;
    const int nodes = 3 + static_cast<int>(length / kNodeSpacing_m);
    Fibre fibre;
    for (int i = 0; i < nodes; ++i) {
      const double share = static_cast<double>(i) / (nodes - 1);
      // Equal steps of the way along the wind, which is the square of the fall.
      const glm::dvec3 place(glm::dvec2(head) - length * share * tuft.wind,
                             head.z - fall * std::sqrt(share));
      const double fade = SmoothRamp(-0.02, 0.06, share) * (1.0 - SmoothRamp(0.35, 1.0, share));
      const double knot =
          1.0 + 0.45 * ValueNoise({knots, 0.0, length * share / 500.0}, 1 << 20, 77U);
      fibre.push_back({Drifted(place), radius * fade * knot});
    }
    return fibre;
  }

 private:
  /// Returns a place in a patch; patches are drawn out along the wind.
  [[nodiscard]] glm::dvec3 PlaceOf(CountedRandom& random) const {
    const GroundNoise patches{kPatches_m, 2, 0.5, 1e9, 5U + 1000U * options_.seed};
    for (;;) {
      const glm::dvec2 place = options_.period_m * glm::dvec2(random.Uniform(), random.Uniform());
      const double likely = 0.03 + SmoothRamp(-0.4, 0.5, patches.At(place, 0.0, options_.period_m));
      if (random.Uniform() > likely) continue;
      const double height = options_.depth_m * random.Between(0.8, 0.92);
      return {place, options_.base_altitude_m + height};
    }
  }

  /// Returns where the drift of the air has moved a place.
  [[nodiscard]] glm::dvec3 Drifted(const glm::dvec3& place) const {
    const glm::dvec2 ground(place);
    const auto drift = [&](double wavelength, double amplitude, std::uint32_t seed) {
      const GroundNoise east{wavelength, 1, 0.5, 3000.0, seed + 1000U * options_.seed};
      const GroundNoise north{wavelength, 1, 0.5, 3000.0, seed + 1U + 1000U * options_.seed};
      return amplitude * glm::dvec2(east.At(ground, time_s_, options_.period_m),
                                    north.At(ground, time_s_, options_.period_m));
    };
    return place + glm::dvec3(drift(5120.0, 700.0, 11U) + drift(1706.7, 120.0, 13U) +
                                  drift(512.0, 18.0, 15U),
                              0.0);
  }

  const CloudOptions& options_;
  double time_s_;
  glm::dvec2 wind_;
};

/// Parts of fibres between two nodes, four at a time, so that compilers use vectors. Places are
/// relative to the cell that holds the parts.
class FibreParts {
 public:
  void Add(const glm::dvec3& begin, const FibreNode& from, const FibreNode& to) {
    if (count_ % kLanes == 0) packs_.emplace_back();
    Pack& pack = packs_.back();
    const std::size_t lane = count_++ % kLanes;
    const glm::dvec3 along = to.place_m - from.place_m;
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      pack.begin[a][lane] = static_cast<float>(begin[axis]);
      pack.along[a][lane] = static_cast<float>(along[axis]);
      pack.per_length[a][lane] = static_cast<float>(along[axis] / glm::dot(along, along));
    }
    pack.radius[lane] = static_cast<float>(from.radius_m);
    pack.radius_change[lane] = static_cast<float>(to.radius_m - from.radius_m);
  }
  [[nodiscard]] bool empty() const { return packs_.empty(); }

  /// Returns the greatest radius minus distance of the parts, and at least `least`.
  [[nodiscard]] float DepthAt(const glm::vec3& point, float least) const {
    Lanes depth = Lanes{} + least;
    for (const Pack& pack : packs_) {
      const Lanes x = point.x - pack.begin[0], y = point.y - pack.begin[1];
      const Lanes z = point.z - pack.begin[2];
      const Lanes share = x * pack.per_length[0] + y * pack.per_length[1] + z * pack.per_length[2];
      const Lanes above = share > 0.0F ? share : Lanes{};
      const Lanes t = above < 1.0F ? above : Lanes{} + 1.0F;
      const Lanes dx = x - t * pack.along[0], dy = y - t * pack.along[1];
      const Lanes dz = z - t * pack.along[2];
      const Lanes square = dx * dx + dy * dy + dz * dz;
      // Roots are only taken where they can give a greater depth.
      const Lanes radius = pack.radius + t * pack.radius_change, reach = radius - depth;
      const auto is_near = (reach > 0.0F) & (square < reach * reach);
      for (std::size_t i = 0; i < kLanes; ++i) {
        if (is_near[i] != 0) depth[i] = radius[i] - std::sqrt(square[i]);
      }
    }
    float most = depth[0];
    for (std::size_t i = 1; i < kLanes; ++i) most = std::max(most, depth[i]);
    return most;
  }

 private:
  static constexpr std::size_t kLanes = 4;
  using Lanes = float __attribute__((vector_size(16)));
  struct Pack {
    std::array<Lanes, 3> begin{}, along{}, per_length{};
    Lanes radius{-1e6F, -1e6F, -1e6F, -1e6F}, radius_change{};
  };

  std::size_t count_ = 0;
  std::vector<Pack> packs_;
};

/// Fibres by the cells of a lattice that they pass.
class FibreIndex {
 public:
  FibreIndex(const std::vector<Fibre>& fibres, const CloudLattice& lattice)
      : cell_m_(double{kCellVoxels} * lattice.voxel_m), bottom_m_(lattice.origin_m.z) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      count_[axis] = (lattice.voxels[axis] + kCellVoxels - 1) / kCellVoxels;
    }
    cells_.resize(static_cast<std::size_t>(count_[0]) * static_cast<std::size_t>(count_[1]) *
                  static_cast<std::size_t>(count_[2]));
    for (const Fibre& fibre : fibres) {
      for (std::size_t i = 0; i + 1 < fibre.size(); ++i) Add(fibre[i], fibre[i + 1]);
    }
  }

  /// Returns whether no fibre passes near a box.
  [[nodiscard]] bool IsEmpty(const glm::dvec3& low, const glm::dvec3& high) const {
    const std::array<int, 3> first = CellOf(low), last = CellOf(high);
    for (int z = std::max(first[2], 0); z <= std::min(last[2], count_[2] - 1); ++z) {
      for (int y = first[1]; y <= last[1]; ++y) {
        for (int x = first[0]; x <= last[0]; ++x) {
          if (!cells_[Index({x, y, z})].empty()) return false;
        }
      }
    }
    return true;
  }

  /// Returns the greatest r - d of the fibres that pass the cell of a point, and at least the depth
  /// that no offset raises above the margin.
  [[nodiscard]] double DepthAt(const glm::dvec3& point) const {
    const std::array<int, 3> cell = CellOf(point);
    if (cell[2] < 0 || cell[2] >= count_[2]) return kLeastCloudDepth_m;
    constexpr auto kLeast = static_cast<float>(-kCloudMargin_m - kSlack_m);
    return static_cast<double>(
        cells_[Index(cell)].DepthAt(glm::vec3(point - CornerOf(cell)), kLeast));
  }

 private:
  [[nodiscard]] std::array<int, 3> CellOf(const glm::dvec3& point) const {
    const glm::dvec3 at = glm::floor((point - glm::dvec3(0.0, 0.0, bottom_m_)) / cell_m_);
    return {static_cast<int>(at.x), static_cast<int>(at.y), static_cast<int>(at.z)};
  }
  [[nodiscard]] std::size_t Index(const std::array<int, 3>& cell) const {
    const auto wrapped = [&](std::size_t axis) {
      return static_cast<std::size_t>(PeriodicIndex(cell[axis], count_[axis]));
    };
    return (static_cast<std::size_t>(cell[2]) * static_cast<std::size_t>(count_[1]) + wrapped(1)) *
               static_cast<std::size_t>(count_[0]) +
           wrapped(0);
  }

  [[nodiscard]] glm::dvec3 CornerOf(const std::array<int, 3>& cell) const {
    return cell_m_ * glm::dvec3(cell[0], cell[1], cell[2]) + glm::dvec3(0.0, 0.0, bottom_m_);
  }

  void Add(const FibreNode& from, const FibreNode& to) {
    const double radius = std::max(from.radius_m, to.radius_m);
    if (radius < 1.0) return;
    const glm::dvec3 reach(radius + kCloudMargin_m + kSlack_m);
    const std::array<int, 3> low = CellOf(glm::min(from.place_m, to.place_m) - reach);
    const std::array<int, 3> high = CellOf(glm::max(from.place_m, to.place_m) + reach);
    for (int z = std::max(low[2], 0); z <= std::min(high[2], count_[2] - 1); ++z) {
      for (int y = low[1]; y <= high[1]; ++y) {
        for (int x = low[0]; x <= high[0]; ++x) {
          cells_[Index({x, y, z})].Add(from.place_m - CornerOf({x, y, z}), from, to);
        }
      }
    }
  }

  static constexpr double kSlack_m = 20.0;  // for an offset of the depth
  // Cells of half a brick hold half as many fibres per point as cells of a brick.
  static constexpr int kCellVoxels = 4;

  glm::dvec3 cell_m_;
  double bottom_m_;
  std::array<int, 3> count_{};
  std::vector<FibreParts> cells_;
};

class StreakShape final : public CloudShape {
 public:
  StreakShape(const CloudOptions& options, const CloudLattice& lattice, const CloudMatter& matter,
              double time_s)
      : fibres_(CirrusFibres(options, time_s), lattice) {
    offset_m_ = ParameterForCover(lattice, matter,
                                  [&](const glm::dvec3& point, double parameter) {
                                    return fibres_.DepthAt(point) + parameter;
                                  },
                                  {options.cover, CoveredOpticalDepth(options.genus), -20.0, 20.0});
  }

  [[nodiscard]] double SignedDepth_m(const glm::dvec3& point) const override {
    return fibres_.DepthAt(point) + offset_m_;
  }
  [[nodiscard]] bool MayHoldCloud(const glm::dvec3& low, const glm::dvec3& high) const override {
    return !fibres_.IsEmpty(low, high);
  }

 private:
  FibreIndex fibres_;
  double offset_m_ = 0.0;
};

/// The ground below fibres, in cells of 40 m.
class GroundBelow {
 public:
  explicit GroundBelow(double period_m)
      : side_(static_cast<int>(period_m / 40.0)),
        is_below_(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_)) {}

  void Add(const Fibre& fibre) {
    constexpr double kVisibleRadius_m = 9.0;
    for (std::size_t i = 0; i + 1 < fibre.size(); ++i) {
      if (fibre[i].radius_m < kVisibleRadius_m) continue;
      for (int part = 0; part < 8; ++part) {
        const glm::dvec3 place =
            fibre[i].place_m + part / 8.0 * (fibre[i + 1].place_m - fibre[i].place_m);
        std::uint8_t& cell =
            is_below_[Index(place.y) * static_cast<std::size_t>(side_) + Index(place.x)];
        covered_ += 1 - cell;
        cell = 1;
      }
    }
  }
  [[nodiscard]] double Cover() const {
    return static_cast<double>(covered_) / static_cast<double>(is_below_.size());
  }

 private:
  [[nodiscard]] std::size_t Index(double place) const {
    return static_cast<std::size_t>(PeriodicIndex(std::floor(place / 40.0), side_));
  }

  int side_;
  std::vector<std::uint8_t> is_below_;
  std::int64_t covered_ = 0;
};

}  // namespace

std::vector<Fibre> CirrusFibres(const CloudOptions& options, double time_s) {
  constexpr int kMostTufts = 4000;
  const FibreSource source(options, time_s);
  GroundBelow ground(options.period_m);
  std::vector<Fibre> fibres;
  for (int number = 0; number < kMostTufts && ground.Cover() < options.cover; ++number) {
    const Tuft tuft = source.TuftOf(number);
    for (int i = 0; i < tuft.fibres; ++i) {
      fibres.push_back(source.FibreOf(tuft, number, i));
      ground.Add(fibres.back());
    }
  }
  return fibres;
}

std::unique_ptr<const CloudShape> CirrusShape(const CloudOptions& options,
                                              const CloudLattice& lattice,
                                              const CloudMatter& matter, double time_s) {
  return std::make_unique<StreakShape>(options, lattice, matter, time_s);
}

}  // namespace alpenglow::renderer
