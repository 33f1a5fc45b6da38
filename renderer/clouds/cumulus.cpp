// SPDX-License-Identifier: MIT
#include "renderer/clouds/cumulus.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>
#include <utility>

#include "renderer/clouds/cloud_cover.h"
#include "renderer/clouds/periodic_index.h"
#include "renderer/clouds/periodic_map.h"
#include "renderer/clouds/portable_functions.h"
#include "renderer/clouds/shape_noise.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

constexpr double kLeastSize_m = 120.0, kLargestSize_m = 3000.0;
constexpr double kBreak_m = 1300.0, kBreakWidth_m = 900.0;
constexpr double kSizeExponent = -1.6;
constexpr double kUsualDepth_m = 1500.0;  // of layers whose clouds do not tower
constexpr double kGrid_m = 40.0;          // of places and of the union of spheres
constexpr double kUnion_m = 14.0;         // s
constexpr double kMostOffset_m = 30.0;    // for the cover
constexpr double kMostNoise_m = 60.0;     // bound of the noise on the heap
constexpr double kMostRaised_m = kMostOffset_m + kMostNoise_m;
constexpr double kLean = 0.12;  // offset along the wind per height

/// Returns the factor of the sizes of large clouds, and of their heights, in deep layers.
double Towering(const CloudOptions& options) {
  return std::sqrt(std::max(options.depth_m / kUsualDepth_m, 1.0));
}

/// Returns the size of a cloud, from the distribution of the header.
double DrawnSize(const CloudOptions& options, CountedRandom& random) {
  constexpr double kPower = 1.0 + kSizeExponent;
  const double towering = Towering(options);
  const double largest_m = std::min(towering * kLargestSize_m, 0.25 * options.period_m);
  const double low = PortablePower(kLeastSize_m, kPower), high = PortablePower(largest_m, kPower);
  for (;;) {
    const double size = PortablePower(random.Between(high, low), 1.0 / kPower);
    const double beyond = std::max(0.0, size - towering * kBreak_m) / (towering * kBreakWidth_m);
    if (random.Uniform() < PortableExp2(-beyond / std::numbers::ln2)) return size;
  }
}

/// Adds lobes on the upper and outer side of a sphere, and lobes on these.
void AddLobes(const CloudSphere& on, int levels, const glm::dvec2& lean, CountedRandom& random,
              std::vector<CloudSphere>& spheres) {
  constexpr double kLeastRadius_m = 22.0;
  if (levels == 0 || 0.5 * on.radius_m < kLeastRadius_m) return;
  const int count = levels >= 2 ? 11 : 9;
  for (int i = 0; i < count; ++i) {
    const double up = random.Between(-0.25, 1.0);
    const double out = std::sqrt(1.0 - up * up);
    const glm::dvec2 circle = PortableCircle(random.Uniform());
    const double radius = on.radius_m * random.Between(0.32, 0.56);
    const double away = on.radius_m - radius * random.Between(0.25, 0.6);
    const glm::dvec3 direction(out * circle, up);
    const CloudSphere lobe{on.centre_m + away * direction + glm::dvec3(radius * lean, 0.0), radius};
    spheres.push_back(lobe);
    AddLobes(lobe, levels - 1, lean, random, spheres);
  }
}

/// A cloud before it is placed.
struct CloudPlan {
  double size_m, depth_m;
  glm::dvec2 lean;  // offset per height
};

/// The foot of a plume on the base of a cloud.
struct PlumeFoot {
  glm::dvec2 place_m;
  double radius_m;
};

/// Returns the feet of a cloud's plumes. The first stands in the middle, and every other one beside
/// an earlier one, within an ellipse. Large clouds have more plumes, not only larger ones, so that
/// their outlines have detail of more scales.
std::vector<PlumeFoot> PlumeFeet(double size_m, CountedRandom& random) {
  constexpr int kTries = 12;
  const glm::dvec2 axis = PortableCircle(random.Uniform());
  const double stretch = random.Between(0.75, 1.35);
  const double count = 3.0 + size_m / 60.0 * random.Between(0.7, 1.3);
  const double mean_radius = 0.33 * size_m / std::sqrt(count);
  std::vector<PlumeFoot> feet{{glm::dvec2(0.0), mean_radius * 1.15}};
  while (static_cast<double>(feet.size()) < count) {
    PlumeFoot foot{{}, mean_radius * random.Between(0.7, 1.3)};
    for (int attempt = 0; attempt < kTries; ++attempt) {
      const auto beside =
          static_cast<std::size_t>(random.Uniform() * static_cast<double>(feet.size()));
      const double away = random.Between(0.95, 1.3) * (feet[beside].radius_m + foot.radius_m);
      foot.place_m = feet[beside].place_m + away * PortableCircle(random.Uniform());
      const glm::dvec2 in_ellipse(glm::dot(foot.place_m, axis) / stretch,
                                  (foot.place_m.y * axis.x - foot.place_m.x * axis.y) * stretch);
      if (glm::length(in_ellipse) + foot.radius_m < 0.5 * size_m) break;
    }
    feet.push_back(foot);
  }
  return feet;
}

/// Adds one plume: spheres in a chain from the base to its top.
void AddPlume(const CloudPlan& plan, const PlumeFoot& foot, CountedRandom& random,
              std::vector<CloudSphere>& plumes) {
  constexpr double kMeeting = 0.3;
  const double radius = foot.radius_m;
  const double eccentricity = std::min(1.0, 2.0 * glm::length(foot.place_m) / plan.size_m);
  const double top = std::max(
      0.9 * radius, plan.depth_m * (1.0 - 0.65 * eccentricity) * random.Between(0.55, 1.0));
  double height = 0.3 * radius;
  do {
    const double share = height / top;
    const glm::dvec2 jitter(random.Between(-0.175, 0.175), random.Between(-0.175, 0.175));
    const double here = radius * (1.05 - 0.2 * share) * random.Between(0.85, 1.15);
    // Plumes meet above the middle, so that a cloud has one dome and not a tower on every foot.
    const glm::dvec2 place = (1.0 - kMeeting * share) * foot.place_m;
    plumes.push_back({glm::dvec3(place + plan.lean * height + radius * jitter, height), here});
    height += 0.7 * radius;
  } while (height <= top - 0.6 * radius);
}

/// Returns the spheres of a full cloud.
std::vector<CloudSphere> SpheresOf(const CloudPlan& plan, CountedRandom& random) {
  std::vector<CloudSphere> spheres;
  for (const PlumeFoot& foot : PlumeFeet(plan.size_m, random)) {
    AddPlume(plan, foot, random, spheres);
  }
  const std::size_t plumes = spheres.size();
  const int levels = plan.size_m > 500.0 ? 2 : 1;
  for (std::size_t i = 0; i < plumes; ++i) {
    const CloudSphere plume = spheres[i];
    AddLobes(plume, levels, 0.3 * plan.lean, random, spheres);
  }
  return spheres;
}

/// Returns size now over full size at an age in lives: growth, a full cloud, and decay.
double GrowthAt(double age) {
  constexpr double kGrowing = 0.35, kDecaying = 0.35;
  const double rest = std::min(age / kGrowing, (1.0 - age) / kDecaying);
  const double lacking = 1.0 - std::min(rest, 1.0);
  return 1.0 - lacking * lacking;
}
constexpr double kMeanSquareGrowth = 0.3 + 0.7 * 8.0 / 15.0;

/// Returns the cover of footprints that gives a cover of clouds: noise cuts more away at the rims of
/// clouds than it adds. The offset of the depth makes the cover exact.
double FootprintCover(double cover) { return std::min(0.99, cover * (1.02 + 0.34 * cover)); }

/// Returns the factor of a cloud's height. Only large clouds tower.
double HeightPerSize(const CloudOptions& options, double size_m) {
  constexpr double kFlat_m = 300.0, kTower_m = 1300.0;
  const double share = std::clamp((size_m - kFlat_m) / (kTower_m - kFlat_m), 0.0, 1.0);
  return std::lerp(1.0, Towering(options), share);
}

/// Returns a cloud of the sequence, without its place.
CumulusCloud DrawnCloud(const CloudOptions& options, int number, double time_s) {
  const auto stream = static_cast<std::uint32_t>(number);
  CountedRandom random(options.seed * 7919U + 13U, stream);
  CumulusCloud cloud{};
  cloud.size_m = DrawnSize(options, random);
  const double life_s = 1200.0 * std::sqrt(cloud.size_m / 500.0);
  const double lives = time_s / life_s + random.Uniform();
  const double past = std::floor(lives);
  cloud.growth = GrowthAt(lives - past);
  CountedRandom form(options.seed * 7919U + 17U + static_cast<std::uint32_t>(past), stream);
  const double height_m = HeightPerSize(options, cloud.size_m) * cloud.size_m;
  const double depth = std::min(options.depth_m, height_m * form.Between(0.45, 0.9));
  cloud.spheres = SpheresOf({cloud.size_m, depth, kLean * WindDirection(options)}, form);
  return cloud;
}

/// Cells of the ground grid under a cloud, relative to that of its middle.
std::vector<std::pair<int, int>> FootprintOf(const CumulusCloud& cloud, double scale) {
  double reach = 0.0;  // in cells
  for (const CloudSphere& sphere : cloud.spheres) {
    const double away = glm::length(glm::dvec2(sphere.centre_m)) + sphere.radius_m;
    reach = std::max(reach, scale / kGrid_m * away);
  }
  const int most = static_cast<int>(reach) + 1, side = 2 * most + 1;
  std::vector<char> is_under(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  const auto index = [&](int x, int y) {
    return static_cast<std::size_t>((x + most) * side + y + most);
  };
  for (const CloudSphere& sphere : cloud.spheres) {
    const glm::dvec2 middle = scale / kGrid_m * glm::dvec2(sphere.centre_m);
    const double radius = scale / kGrid_m * sphere.radius_m;
    for (int y = static_cast<int>(std::ceil(middle.y - radius)); y <= middle.y + radius; ++y) {
      for (int x = static_cast<int>(std::ceil(middle.x - radius)); x <= middle.x + radius; ++x) {
        const glm::dvec2 away = glm::dvec2(x, y) - middle;
        if (glm::dot(away, away) < radius * radius) is_under[index(x, y)] = 1;
      }
    }
  }
  std::vector<std::pair<int, int>> cells;
  for (int x = -most; x <= most; ++x) {
    for (int y = -most; y <= most; ++y) {
      if (is_under[index(x, y)] != 0) cells.emplace_back(x, y);
    }
  }
  return cells;
}

/// The ground under the clouds that are placed.
class GroundGrid {
 public:
  explicit GroundGrid(double period_m)
      : side_(static_cast<int>(period_m / kGrid_m)),
        is_taken_(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_)) {}

  [[nodiscard]] int side() const { return side_; }
  [[nodiscard]] double Cover() const {
    return static_cast<double>(std::count(is_taken_.begin(), is_taken_.end(), 1)) /
           static_cast<double>(is_taken_.size());
  }
  /// Returns how many cells of a footprint are taken, or at least `enough` if more are.
  [[nodiscard]] int Taken(const std::vector<std::pair<int, int>>& cells, int x, int y,
                          int enough) const {
    int taken = 0;
    for (const auto& [dx, dy] : cells) {
      taken += is_taken_[Index(x + dx, y + dy)];
      if (taken >= enough) break;
    }
    return taken;
  }
  void Take(const std::vector<std::pair<int, int>>& cells, int x, int y) {
    for (const auto& [dx, dy] : cells) is_taken_[Index(x + dx, y + dy)] = 1;
  }

 private:
  [[nodiscard]] std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(PeriodicIndex(y, side_)) * static_cast<std::size_t>(side_) +
           static_cast<std::size_t>(PeriodicIndex(x, side_));
  }

  int side_;
  std::vector<std::uint8_t> is_taken_;
};

/// Places clouds on the ground, the largest first.
class CloudPlacing {
 public:
  explicit CloudPlacing(const CloudOptions& options)
      : options_(options), ground_(options.period_m) {}

  /// Returns the cover of the footprints.
  [[nodiscard]] double PlaceAll(std::vector<CumulusCloud>& clouds) {
    std::vector<std::size_t> order(clouds.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return clouds[a].size_m > clouds[b].size_m;
    });
    for (const std::size_t number : order)
      Place(clouds[number], static_cast<std::uint32_t>(number));
    return ground_.Cover();
  }

 private:
  static constexpr int kTries = 150;

  void Place(CumulusCloud& cloud, std::uint32_t number) {
    // On the average over its life, a cloud covers this share of its full footprint.
    const auto cells = FootprintOf(cloud, std::sqrt(kMeanSquareGrowth));
    const auto guarded = FootprintOf(cloud, std::sqrt(kMeanSquareGrowth) + 120.0 / cloud.size_m);
    CountedRandom random(options_.seed * 7919U + 19U, number);
    int best_x = 0, best_y = 0;
    int least = static_cast<int>(guarded.size()) + 1;
    for (int attempt = 0; attempt < kTries && least > 0; ++attempt) {
      const int x = static_cast<int>(random.Uniform() * ground_.side());
      const int y = static_cast<int>(random.Uniform() * ground_.side());
      if (random.Uniform() > Likelihood(kGrid_m * glm::dvec2(x, y))) continue;
      const int taken = ground_.Taken(guarded, x, y, least);
      if (taken >= least) continue;
      least = taken;
      best_x = x;
      best_y = y;
    }
    ground_.Take(cells, best_x, best_y);
    cloud.place_m = kGrid_m * glm::dvec2(best_x, best_y);
  }

  /// Returns how likely a place is, relative to the best ones: clouds come in clusters.
  [[nodiscard]] double Likelihood(const glm::dvec2& place) const {
    const GroundNoise clusters{2560.0, 2, 0.6, 1e9, 3U + 1000U * options_.seed};
    return SmoothRamp(-1.1, 0.5, clusters.At(place, 0.0, options_.period_m));
  }

  const CloudOptions& options_;
  GroundGrid ground_;
};

/// The union of the spheres of all clouds, on a grid over one period.
class SphereUnion {
 public:
  SphereUnion(const CloudOptions& options, const CloudLattice& lattice,
              const std::vector<CumulusCloud>& clouds)
      : side_(static_cast<int>(options.period_m / kGrid_m)),
        bottom_m_(lattice.origin_m.z - kGrid_m),
        layers_(static_cast<int>(lattice.size_m().z / kGrid_m) + 4),
        depth_m_(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_) *
                 static_cast<std::size_t>(layers_)) {
    std::vector<PlacedSphere> spheres;
    for (const CumulusCloud& cloud : clouds) {
      const double relief = std::clamp(cloud.growth * cloud.size_m / kFullRelief_m, 0.2, 1.0);
      const glm::dvec3 base(cloud.place_m, options.base_altitude_m);
      for (const CloudSphere& sphere : cloud.spheres) {
        spheres.push_back(
            {base + cloud.growth * sphere.centre_m, cloud.growth * sphere.radius_m, relief});
      }
    }
    relief_.resize(depth_m_.size());
    const std::vector<std::vector<std::uint32_t>> of_layer = ByLayer(spheres);
    tbb::parallel_for(0, layers_, [&](int layer) {
      std::vector<float> relief(Row(1, 0) - Row(0, 0));
      for (const std::uint32_t number : of_layer[static_cast<std::size_t>(layer)]) {
        Add(spheres[number], layer, relief);
      }
      Finish(layer, relief);
    });
  }

  /// The grid around a point.
  struct Cell {
    std::array<std::size_t, 8> corner;  // x fastest
    glm::dvec3 share;
  };
  [[nodiscard]] Cell CellOf(const glm::dvec3& point) const {
    const glm::dvec3 at = (point - glm::dvec3(0.0, 0.0, bottom_m_)) / kGrid_m;
    const std::array<int, 3> low{WholePart(at.x), WholePart(at.y), WholePart(at.z)};
    const int z = std::clamp(low[2], 0, layers_ - 2);
    const std::size_t x0 = Wrapped(low[0]), x1 = Wrapped(low[0] + 1);
    const std::size_t south = Row(z, Wrapped(low[1])), north = Row(z, Wrapped(low[1] + 1));
    const std::size_t up = Row(1, 0);
    return {{south + x0, south + x1, north + x0, north + x1, south + up + x0, south + up + x1,
             north + up + x0, north + up + x1},
            at - glm::dvec3(low[0], low[1], low[2])};
  }
  /// Returns F_0.
  [[nodiscard]] double Depth_m(const Cell& cell) const { return Mixed(depth_m_, cell); }
  /// Returns the size of the relief, relative to that of large clouds.
  [[nodiscard]] double Relief(const Cell& cell) const { return Mixed(relief_, cell) / 255.0; }

  /// Returns an upper bound of F_0 in a box.
  [[nodiscard]] double LargestIn(const glm::dvec3& low, const glm::dvec3& high) const {
    const auto number = [&](double at) { return static_cast<int>(std::floor(at / kGrid_m)); };
    const int first = std::clamp(number(low.z - bottom_m_), 0, layers_ - 1);
    const int last = std::clamp(number(high.z - bottom_m_) + 1, 0, layers_ - 1);
    float largest = depth_m_[Row(first, Wrapped(number(low.y))) + Wrapped(number(low.x))];
    for (int z = first; z <= last; ++z) {
      for (int y = number(low.y); y <= number(high.y) + 1; ++y) {
        for (int x = number(low.x); x <= number(high.x) + 1; ++x) {
          largest = std::max(largest, depth_m_[Row(z, Wrapped(y)) + Wrapped(x)]);
        }
      }
    }
    return static_cast<double>(largest);
  }

 private:
  static constexpr double kFullRelief_m = 1200.0;  // size of a cloud with the full relief
  static constexpr double kEmpty_m = -200.0;

  struct PlacedSphere {
    glm::dvec3 centre_m;
    double radius_m, relief;
  };

  [[nodiscard]] static int WholePart(double value) {
    const int truncated = static_cast<int>(value);
    return truncated - (value < truncated ? 1 : 0);
  }
  template <typename Value>
  [[nodiscard]] static double Mixed(const std::vector<Value>& values, const Cell& cell) {
    const Value* all = values.data();
    const auto along_x = [&](std::size_t first) {
      const auto west = static_cast<double>(all[cell.corner[first]]);
      return west + cell.share.x * (static_cast<double>(all[cell.corner[first + 1]]) - west);
    };
    const auto along_xy = [&](std::size_t first) {
      const double south = along_x(first);
      return south + cell.share.y * (along_x(first + 2) - south);
    };
    const double below = along_xy(0);
    return below + cell.share.z * (along_xy(4) - below);
  }

  [[nodiscard]] std::size_t Wrapped(int number) const {
    return static_cast<std::size_t>(PeriodicIndex(number, side_));
  }
  [[nodiscard]] std::size_t Row(int layer, std::size_t y) const {
    return (static_cast<std::size_t>(layer) * static_cast<std::size_t>(side_) + y) *
           static_cast<std::size_t>(side_);
  }

  /// Returns the distance from a sphere's surface within which it is part of the union: noise and
  /// offset raise the surface by less. The surface of a small lobe is far from no larger sphere, whose
  /// terms reach further.
  [[nodiscard]] static double ReachBeyond(const PlacedSphere& sphere) {
    return std::min(kCloudMargin_m + kMostRaised_m * sphere.relief, 20.0 + 0.8 * sphere.radius_m);
  }

  /// Returns the numbers of the spheres that reach each layer.
  [[nodiscard]] std::vector<std::vector<std::uint32_t>> ByLayer(
      const std::vector<PlacedSphere>& spheres) const {
    std::vector<std::vector<std::uint32_t>> of_layer(static_cast<std::size_t>(layers_));
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      const double height = spheres[i].centre_m.z - bottom_m_;
      const double reach = spheres[i].radius_m + ReachBeyond(spheres[i]);
      const int first = std::max(0, static_cast<int>(std::ceil((height - reach) / kGrid_m)));
      const int last =
          std::min(layers_ - 1, static_cast<int>(std::floor((height + reach) / kGrid_m)));
      for (int layer = first; layer <= last; ++layer) {
        of_layer[static_cast<std::size_t>(layer)].push_back(static_cast<std::uint32_t>(i));
      }
    }
    return of_layer;
  }

  /// Adds the term of a sphere to the sums of a layer, and its relief with the term as weight.
  void Add(const PlacedSphere& sphere, int layer, std::vector<float>& relief) {
    const double dz = bottom_m_ + kGrid_m * layer - sphere.centre_m.z;
    const double beyond = ReachBeyond(sphere);
    const double reach = sphere.radius_m + beyond;
    const double square = reach * reach - dz * dz;
    if (square <= 0.0) return;
    const double across = std::sqrt(square);
    const auto first = [&](double at) {
      return static_cast<int>(std::ceil((at - across) / kGrid_m));
    };
    const auto last = [&](double at) {
      return static_cast<int>(std::floor((at + across) / kGrid_m));
    };
    const int begin_x = first(sphere.centre_m.x), end_x = last(sphere.centre_m.x);
    const auto radius = static_cast<float>(sphere.radius_m), least = static_cast<float>(-beyond);
    const auto sphere_relief = static_cast<float>(sphere.relief);
    for (int y = first(sphere.centre_m.y); y <= last(sphere.centre_m.y); ++y) {
      const double dy = kGrid_m * y - sphere.centre_m.y;
      const auto aside = static_cast<float>(dy * dy + dz * dz);
      const std::size_t row = Wrapped(y) * static_cast<std::size_t>(side_);
      float* sums = depth_m_.data() + Row(layer, 0) + row;
      for (int x = begin_x; x <= end_x; ++x) {
        const auto dx = static_cast<float>(kGrid_m * x - sphere.centre_m.x);
        const float depth = radius - std::sqrt(dx * dx + aside);
        if (depth < least) continue;
        const float term = UnionTerm(depth);
        sums[Wrapped(x)] += term;
        relief[row + Wrapped(x)] += term * sphere_relief;
      }
    }
  }

  /// Returns exp(depth / s), to 2e-5 of it. @param depth_m  below 1000.
  [[nodiscard]] static float UnionTerm(float depth_m) {
    constexpr auto kPerMetre = static_cast<float>(1.0 / (kUnion_m * std::numbers::ln2));
    const float x = depth_m * kPerMetre;
    const auto truncated = static_cast<std::int32_t>(x);
    const float f = (x - static_cast<float>(truncated)) * std::numbers::ln2_v<float>;
    const float power =
        1.0F +
        f * (1.0F + f * (1.0F / 2 + f * (1.0F / 6 + f * (1.0F / 24 + f * (1.0F / 120 + f / 720)))));
    return power * std::bit_cast<float>(static_cast<std::uint32_t>(truncated + 127) << 23U);
  }

  /// Replaces sums by depths and mean reliefs.
  void Finish(int layer, const std::vector<float>& relief) {
    const std::size_t begin = Row(layer, 0);
    for (std::size_t i = 0; i < relief.size(); ++i) {
      float& depth = depth_m_[begin + i];
      const auto sum = static_cast<double>(depth);
      depth = static_cast<float>(sum > 0.0 ? kUnion_m * std::numbers::ln2 * PortableLog2(sum)
                                           : kEmpty_m);
      if (sum > 0.0) {
        relief_[begin + i] =
            static_cast<std::uint8_t>(255.0 * static_cast<double>(relief[i]) / sum + 0.5);
      }
    }
  }

  int side_;
  double bottom_m_;
  int layers_;
  std::vector<float> depth_m_;        // sums of terms while they are added
  std::vector<std::uint8_t> relief_;  // 255: the full relief
};

class HeapShape final : public CloudShape {
 public:
  HeapShape(const CloudOptions& options, const CloudLattice& lattice, const CloudMatter& matter,
            double time_s)
      : base_m_(options.base_altitude_m),
        rise_m_(1.0 * time_s),
        spheres_(options, lattice, CumulusPopulation(options, time_s)),
        base_waves_m_(static_cast<int>(options.period_m / 80.0), options.period_m,
                      [&](const glm::dvec2& place) {
                        const GroundNoise waves{1706.7, 3, 0.6, 1500.0, 9U + 1000U * options.seed};
                        return 18.0 * waves.At(place, time_s, options.period_m);
                      }) {
    offset_m_ = ParameterForCover(
        lattice, matter,
        [&](const glm::dvec3& point, double parameter) { return Depth(point, parameter); },
        {options.cover, CoveredOpticalDepth(options.genus), -kMostOffset_m, kMostOffset_m});
  }

  [[nodiscard]] double SignedDepth_m(const glm::dvec3& point) const override {
    return Depth(point, offset_m_);
  }

  [[nodiscard]] bool MayHoldCloud(const glm::dvec3& low, const glm::dvec3& high) const override {
    return high.z > base_m_ - kDeepestBase_m &&
           spheres_.LargestIn(low, high) + std::max(0.0, offset_m_ + most_raised_m_) >
               -kCloudMargin_m;
  }

 private:
  static constexpr double kLarge_m = 70.0, kSmall_m = 60.0, kBend_m = 22.0, kSmooth_m = 10.0;
  static constexpr double kBaseSteepness = 0.8;
  static constexpr double kDeepestBase_m = 120.0;  // bound of kBaseSteepness times the waves

  [[nodiscard]] double Depth(const glm::dvec3& point, double offset_m) const {
    const double over_base = kBaseSteepness * (point.z - base_m_);
    const SphereUnion::Cell cell = spheres_.CellOf(point);
    const double depth = spheres_.Depth_m(cell);
    // Noise is evaluated only where it can change the result.
    if (depth + std::max(0.0, offset_m + most_raised_m_) <= -kCloudMargin_m) {
      return kLeastCloudDepth_m;
    }
    const double relief = spheres_.Relief(cell);
    const double highest = depth + relief * (offset_m + most_raised_m_);
    if (highest <= -kCloudMargin_m || over_base < -kDeepestBase_m) return kLeastCloudDepth_m;
    const double lowest = depth + relief * (offset_m - most_lowered_m_);
    if (std::min(lowest, over_base - kDeepestBase_m) > kMostCloudDepth_m) return kMostCloudDepth_m;
    if (lowest > over_base + kDeepestBase_m) return OverBase(point, relief);
    const double heap = depth + relief * (offset_m + Displacement(point));
    return heap < over_base - kDeepestBase_m ? heap : std::min(heap, OverBase(point, relief));
  }

  /// Returns the depth that the waves of the base leave.
  [[nodiscard]] double OverBase(const glm::dvec3& point, double relief) const {
    const double base =
        base_m_ + base_waves_m_.At(glm::dvec2(point)) +
        10.0 * relief *
            ShapeNoise::Billow().At({point.x / kSmallTile_m, point.y / kSmallTile_m, 0.5});
    return kBaseSteepness * (point.z - base);
  }

  [[nodiscard]] double Displacement(const glm::dvec3& point) const {
    constexpr double kBendTile_m = 1280.0;
    const glm::dvec3 risen = point - glm::dvec3(0.0, 0.0, rise_m_);
    const glm::dvec3 bend = ShapeNoise::Smooth().At(risen / kBendTile_m);
    const glm::dvec3 bent = risen + kBend_m * bend;
    const double noise =
        kLarge_m *
            ShapeNoise::Billow().At(glm::dvec3(bent.x, bent.y, 0.4 * bent.z) / kLargeTile_m) +
        kSmall_m * ShapeNoise::Billow().At(bent / kSmallTile_m) + kSmooth_m * bend.x;
    const double height = std::clamp((point.z - base_m_) / 250.0, 0.0, 1.0);
    return Softened((0.45 + 0.55 * height) * noise);
  }

  /// Returns noise below kMostNoise_m.
  [[nodiscard]] static double Softened(double noise) {
    return noise > 0.0 ? noise / (1.0 + noise / kMostNoise_m) : noise;
  }

  double base_m_, rise_m_;
  // By which noise can lower and raise F.
  double most_lowered_m_ = -(kLarge_m + kSmall_m) * ShapeNoise::Billow().Least() -
                           kSmooth_m * ShapeNoise::Smooth().Least();
  double most_raised_m_ = Softened((kLarge_m + kSmall_m) * ShapeNoise::Billow().Largest() +
                                   kSmooth_m * ShapeNoise::Smooth().Largest());
  SphereUnion spheres_;
  PeriodicMap base_waves_m_;
  double offset_m_ = 0.0;
};

}  // namespace

std::vector<CumulusCloud> CumulusPopulation(const CloudOptions& options, double time_s) {
  constexpr int kRounds = 5;
  const double footprints = FootprintCover(options.cover);
  const double cells = options.period_m * options.period_m / (kGrid_m * kGrid_m);
  double wanted = footprints * cells;  // sum of the mean areas of all clouds
  double area = 0.0;
  std::vector<CumulusCloud> clouds;
  for (int round = 0; round < kRounds; ++round) {
    while (area < wanted) {
      clouds.push_back(DrawnCloud(options, static_cast<int>(clouds.size()), time_s));
      area += kMeanSquareGrowth * static_cast<double>(FootprintOf(clouds.back(), 1.0).size());
    }
    const double cover = CloudPlacing(options).PlaceAll(clouds);
    if (cover >= 0.99 * footprints) break;
    wanted *= std::min(2.0, footprints / cover);
  }
  return clouds;
}

std::unique_ptr<const CloudShape> CumulusShape(const CloudOptions& options,
                                               const CloudLattice& lattice,
                                               const CloudMatter& matter, double time_s) {
  return std::make_unique<HeapShape>(options, lattice, matter, time_s);
}

}  // namespace alpenglow::renderer
