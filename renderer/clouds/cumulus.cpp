// SPDX-License-Identifier: MIT
#include "renderer/clouds/cumulus.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>
#include <utility>

#include "renderer/clouds/cloud_cover.h"
#include "renderer/clouds/periodic_map.h"
#include "renderer/clouds/portable_functions.h"
#include "renderer/clouds/shape_noise.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

constexpr double kLeastSize_m = 120.0, kLargestSize_m = 3000.0;
constexpr double kBreak_m = 1300.0, kBreakWidth_m = 900.0;
constexpr double kSizeExponent = -1.6;
constexpr double kGrid_m = 40.0;        // of places and of the union of spheres
constexpr double kUnion_m = 14.0;       // s
constexpr double kMostOffset_m = 30.0;  // for the cover
constexpr double kMostNoise_m = 60.0;   // bound of the noise on the heap
constexpr double kMostRaised_m = kMostOffset_m + kMostNoise_m;
constexpr double kLean = 0.12;  // offset along the wind per height

/// Returns the size of a cloud, from the distribution of the header.
double DrawnSize(double largest_m, CountedRandom& random) {
  constexpr double kPower = 1.0 + kSizeExponent;
  const double low = PortablePower(kLeastSize_m, kPower), high = PortablePower(largest_m, kPower);
  for (;;) {
    const double size = PortablePower(random.Between(high, low), 1.0 / kPower);
    const double beyond = std::max(0.0, size - kBreak_m) / kBreakWidth_m;
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
  const double radius = foot.radius_m;
  const double eccentricity = std::min(1.0, 2.0 * glm::length(foot.place_m) / plan.size_m);
  const double top = std::max(
      0.9 * radius, plan.depth_m * (1.0 - 0.65 * eccentricity) * random.Between(0.55, 1.0));
  double height = 0.3 * radius;
  do {
    const double share = height / top;
    const glm::dvec2 jitter(random.Between(-0.175, 0.175), random.Between(-0.175, 0.175));
    const double here = radius * (1.1 - 0.35 * share) * random.Between(0.85, 1.15);
    plumes.push_back(
        {glm::dvec3(foot.place_m + plan.lean * height + radius * jitter, height), here});
    height += 0.8 * radius;
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

/// Returns a cloud of the sequence, without its place.
CumulusCloud DrawnCloud(const CloudOptions& options, int number, double time_s) {
  const auto stream = static_cast<std::uint32_t>(number);
  CountedRandom random(options.seed * 7919U + 13U, stream);
  CumulusCloud cloud{};
  cloud.size_m = DrawnSize(std::min(kLargestSize_m, 0.25 * options.period_m), random);
  const double life_s = 1200.0 * std::sqrt(cloud.size_m / 500.0);
  const double lives = time_s / life_s + random.Uniform();
  const double past = std::floor(lives);
  cloud.growth = GrowthAt(lives - past);
  CountedRandom form(options.seed * 7919U + 17U + static_cast<std::uint32_t>(past), stream);
  const double depth = std::min(options.depth_m, cloud.size_m * form.Between(0.45, 0.9));
  cloud.spheres = SpheresOf({cloud.size_m, depth, kLean * WindDirection(options)}, form);
  return cloud;
}

/// Cells of the ground grid under a cloud, relative to that of its middle.
std::vector<std::pair<int, int>> FootprintOf(const CumulusCloud& cloud, double scale) {
  std::vector<std::pair<int, int>> cells;
  for (const CloudSphere& sphere : cloud.spheres) {
    const glm::dvec2 middle = scale / kGrid_m * glm::dvec2(sphere.centre_m);
    const double radius = scale / kGrid_m * sphere.radius_m;
    for (int y = static_cast<int>(std::ceil(middle.y - radius)); y <= middle.y + radius; ++y) {
      for (int x = static_cast<int>(std::ceil(middle.x - radius)); x <= middle.x + radius; ++x) {
        const glm::dvec2 away = glm::dvec2(x, y) - middle;
        if (glm::dot(away, away) < radius * radius) cells.emplace_back(x, y);
      }
    }
  }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
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
    const auto wrapped = [&](int cell) {
      const int rest = cell % side_;
      return static_cast<std::size_t>(rest < 0 ? rest + side_ : rest);
    };
    return wrapped(y) * static_cast<std::size_t>(side_) + wrapped(x);
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
    const GroundNoise clusters{5120.0, 2, 0.6, 1e9, 3U + 1000U * options_.seed};
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
      const double relief = std::clamp(cloud.growth * cloud.size_m / kFullRelief_m, 0.1, 1.0);
      const glm::dvec3 base(cloud.place_m, options.base_altitude_m);
      for (const CloudSphere& sphere : cloud.spheres) {
        spheres.push_back(
            {base + cloud.growth * sphere.centre_m, cloud.growth * sphere.radius_m, relief});
      }
    }
    relief_.resize(depth_m_.size());
    tbb::parallel_for(0, layers_, [&](int layer) {
      std::vector<float> relief(Row(1, 0) - Row(0, 0));
      for (const PlacedSphere& sphere : spheres) Add(sphere, layer, relief);
      Finish(layer, relief);
    });
  }

  /// F_0 and the size of the relief on it.
  struct Heap {
    double depth_m;
    double relief;  // of the noise, relative to that of large clouds
  };
  [[nodiscard]] Heap At(const glm::dvec3& point) const {
    const glm::dvec3 at = (point - glm::dvec3(0.0, 0.0, bottom_m_)) / kGrid_m;
    const glm::dvec3 low = glm::floor(at);
    const glm::dvec3 share = at - low;
    const int z = std::clamp(static_cast<int>(low.z), 0, layers_ - 2);
    const std::size_t x0 = Wrapped(static_cast<int>(low.x)),
                      x1 = Wrapped(static_cast<int>(low.x) + 1);
    const std::size_t y0 = Wrapped(static_cast<int>(low.y)),
                      y1 = Wrapped(static_cast<int>(low.y) + 1);
    const auto mixed = [&](const auto& values) {
      const auto along_x = [&](int layer, std::size_t row) {
        const auto* of_row = values.data() + Row(layer, row);
        const auto west = static_cast<double>(of_row[x0]);
        return west + share.x * (static_cast<double>(of_row[x1]) - west);
      };
      const auto along_xy = [&](int layer) {
        const double south = along_x(layer, y0);
        return south + share.y * (along_x(layer, y1) - south);
      };
      const double below = along_xy(z);
      return below + share.z * (along_xy(z + 1) - below);
    };
    return {mixed(depth_m_), mixed(relief_) / 255.0};
  }

  /// Returns an upper bound of At in a box.
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
  static constexpr double kFullRelief_m = 1300.0;  // size of a cloud with the full relief
  static constexpr double kEmpty_m = -200.0;

  struct PlacedSphere {
    glm::dvec3 centre_m;
    double radius_m, relief;
  };

  [[nodiscard]] std::size_t Wrapped(int number) const {
    if (number >= 0 && number < side_) return static_cast<std::size_t>(number);
    const int rest = number % side_;
    return static_cast<std::size_t>(rest < 0 ? rest + side_ : rest);
  }
  [[nodiscard]] std::size_t Row(int layer, std::size_t y) const {
    return (static_cast<std::size_t>(layer) * static_cast<std::size_t>(side_) + y) *
           static_cast<std::size_t>(side_);
  }

  /// Adds the term of a sphere to the sums of a layer, and its relief with the term as weight.
  void Add(const PlacedSphere& sphere, int layer, std::vector<float>& relief) {
    const double dz = bottom_m_ + kGrid_m * layer - sphere.centre_m.z;
    // Noise and offset raise the surface by less than this.
    // The surface of a small lobe is far from no larger sphere, whose terms reach further.
    const double beyond =
        std::min(kCloudMargin_m + kMostRaised_m * sphere.relief, 20.0 + 0.8 * sphere.radius_m);
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
    for (int y = first(sphere.centre_m.y); y <= last(sphere.centre_m.y); ++y) {
      const double dy = kGrid_m * y - sphere.centre_m.y;
      const std::size_t row = Wrapped(y) * static_cast<std::size_t>(side_);
      float* sums = depth_m_.data() + Row(layer, 0) + row;
      for (int x = first(sphere.centre_m.x); x <= last(sphere.centre_m.x); ++x) {
        const double dx = kGrid_m * x - sphere.centre_m.x;
        const double depth = sphere.radius_m - std::sqrt(dx * dx + dy * dy + dz * dz);
        if (depth < -beyond) continue;
        const auto term = static_cast<float>(PortableExp2(depth / (kUnion_m * std::numbers::ln2)));
        sums[Wrapped(x)] += term;
        relief[row + Wrapped(x)] += term * static_cast<float>(sphere.relief);
      }
    }
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
           spheres_.LargestIn(low, high) + kMostRaised_m > -kCloudMargin_m;
  }

 private:
  static constexpr double kLarge_m = 70.0, kSmall_m = 60.0, kBend_m = 22.0, kSmooth_m = 10.0;
  static constexpr double kDeepestBase_m = 120.0;

  [[nodiscard]] double Depth(const glm::dvec3& point, double offset_m) const {
    const auto [depth, relief] = spheres_.At(point);
    const double over_base = 0.8 * (point.z - base_m_);
    if (depth + kMostRaised_m * relief <= -kCloudMargin_m || over_base < -kDeepestBase_m) {
      return kLeastCloudDepth_m;
    }
    if (std::min(depth - most_lowered_m_, over_base - kDeepestBase_m) > kMostCloudDepth_m) {
      return kMostCloudDepth_m;
    }
    const double base =
        base_m_ + base_waves_m_.At(glm::dvec2(point)) +
        10.0 * relief *
            ShapeNoise::Billow().At({point.x / kSmallTile_m, point.y / kSmallTile_m, 0.5});
    return std::min(depth + relief * (offset_m + Displacement(point)), 0.8 * (point.z - base));
  }

  [[nodiscard]] double Displacement(const glm::dvec3& point) const {
    constexpr double kBendTile_m = 1280.0;
    const glm::dvec3 risen = point - glm::dvec3(0.0, 0.0, rise_m_);
    const glm::dvec3 at = risen / kBendTile_m;
    const glm::dvec3 bend(ShapeNoise::Smooth().At(at),
                          ShapeNoise::Smooth().At(at + glm::dvec3(0.37, 0.11, 0.7)),
                          ShapeNoise::Smooth().At(at + glm::dvec3(0.71, 0.53, 0.2)));
    const glm::dvec3 bent = risen + kBend_m * bend;
    const double noise =
        kLarge_m *
            ShapeNoise::Billow().At(glm::dvec3(bent.x, bent.y, 0.4 * bent.z) / kLargeTile_m) +
        kSmall_m * ShapeNoise::Billow().At(bent / kSmallTile_m) + kSmooth_m * bend.x;
    const double height = std::clamp((point.z - base_m_) / 250.0, 0.0, 1.0);
    const double raised = (0.45 + 0.55 * height) * noise;
    return raised > 0.0 ? raised / (1.0 + raised / kMostNoise_m) : raised;
  }

  double base_m_, rise_m_;
  double most_lowered_m_ = kMostOffset_m - kLarge_m * ShapeNoise::Billow().Least() -
                           kSmall_m * ShapeNoise::Billow().Least() -
                           kSmooth_m * ShapeNoise::Smooth().Least();  // by which noise can lower F
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
