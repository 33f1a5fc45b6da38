// SPDX-License-Identifier: MIT
#include "renderer/specular/photon_beams.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <optional>

#include "atmosphere/base/error.h"
#include "atmosphere/math/axes_across.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/reference/path_sampling.h"
#include "renderer/illumination/distant_light.h"

namespace alpenglow::renderer {
namespace {

// Light that has met this many spheres is lost.
constexpr std::size_t kMostLegs = 8;
// Two numbers for the point of the sphere, two for that of the disk, one for the order at each sphere.
constexpr std::array<int, 4 + kMostLegs> kBases{2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37};
constexpr std::size_t kPhotonsAtOnce = 1000;

using Shifts = std::array<double, kBases.size()>;

Shifts ShiftsOf(std::uint64_t seed) {
  atmosphere::reference::PathRandom random(seed, 0, 0);
  Shifts shifts{};
  for (double& shift : shifts) shift = random.Next();
  return shifts;
}

/// The numbers of one photon.
struct PhotonNumbers {
  int photon;
  const Shifts& shifts;

  [[nodiscard]] double operator[](std::size_t dimension) const {
    const double shifted = Halton(photon, kBases[dimension]) + shifts[dimension];
    return shifted < 1.0 ? shifted : shifted - 1.0;
  }
};

/// The photons of one sphere.
struct PhotonsOfSphere {
  std::size_t sphere;
  int first, count;
};

/// Distributes photons in proportion to cross-sections; each sphere has one at least.
std::vector<PhotonsOfSphere> Distributed(std::span<const SpecularSphere> spheres, int photons) {
  const auto square = [](double sum, const SpecularSphere& sphere) {
    return sum + sphere.radius_m * sphere.radius_m;
  };
  const double all = std::accumulate(spheres.begin(), spheres.end(), 0.0, square);
  std::vector<PhotonsOfSphere> parts;
  int first = 0;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const int count = std::max(1, static_cast<int>(photons * square(0.0, spheres[i]) / all));
    parts.push_back({i, first, count});
    first += count;
  }
  return parts;
}

class PhotonFollower {
 public:
  PhotonFollower(std::span<const SpecularSphere> spheres, const DiskOfLight& light,
                 const PhotonOptions& options, const DistanceToEnd& end)
      : spheres_(spheres), light_(light), options_(options), end_(end) {
    double largest_m = 0.0;
    for (const SpecularSphere& sphere : spheres)
      for (const SpecularSphere& other : spheres)
        largest_m = std::max(largest_m, glm::length(sphere.centre - other.centre) +
                                            sphere.radius_m + other.radius_m);
    before_m_ = 2.0 * largest_m;
  }

  /// Adds the beams of a photon that the light sends onto a sphere.
  void Follow(const PhotonsOfSphere& part, const PhotonNumbers& numbers,
              std::vector<PhotonBeam>& beams) const {
    const SpecularSphere& sphere = spheres_[part.sphere];
    glm::dvec3 direction =
        -TowardsDisk(light_.to_light, light_.radius_rad, {numbers[2], numbers[3]});
    const AxesAcross across = AxesAcrossOf(direction);
    const double rho = sphere.radius_m * std::sqrt(numbers[0]), angle = 2.0 * kPi * numbers[1];
    glm::dvec3 origin = sphere.centre - before_m_ * direction +
                        rho * (std::cos(angle) * across.side + std::sin(angle) * across.other);
    std::optional<EnteredSphere> met = FirstSphereOn(spheres_, origin, direction);
    if (!met || met->number != part.sphere) return;
    const double area_m2 = kPi * sphere.radius_m * sphere.radius_m / part.count;
    for (std::size_t leg = 0; leg < kMostLegs && met; ++leg) {
      const DividedRay divided(spheres_[met->number], origin + met->distance_m * direction,
                               direction);
      const std::optional<int> order = divided.SampleOrder(numbers[4 + leg]);
      if (!order) return;
      const LeavingRay leaving = divided.Leaving(*order);
      origin = leaving.origin;
      direction = leaving.direction;
      met = FirstSphereOn(spheres_, origin, direction);
      const double surface_m = end_(origin, direction);
      const double end_m = std::min(surface_m, options_.longest_m);
      if (met && met->distance_m > end_m) met.reset();
      const double length_m = met ? met->distance_m : end_m;
      const bool ends_on_surface = !met && surface_m <= options_.longest_m;
      beams.push_back(
          {origin, direction, length_m, area_m2, static_cast<int>(leg), ends_on_surface});
    }
  }

 private:
  std::span<const SpecularSphere> spheres_;
  const DiskOfLight& light_;
  const PhotonOptions& options_;
  const DistanceToEnd& end_;
  double before_m_ = 0.0;  // photons start so far before their sphere that no sphere is behind them
};

}  // namespace

std::vector<PhotonBeam> FollowPhotons(std::span<const SpecularSphere> spheres,
                                      const DiskOfLight& light, const PhotonOptions& options,
                                      const DistanceToEnd& end) {
  RequireInRange(options.photons, 1.0, kMostPhotons, "the number of photons");
  RequireInRange(options.longest_m, std::numeric_limits<double>::min(),
                 std::numeric_limits<double>::max(), "the longest beam [m]");
  for (const SpecularSphere& sphere : spheres) Validate(sphere);
  const PhotonFollower follower(spheres, light, options, end);
  const Shifts shifts = ShiftsOf(options.seed);
  std::vector<PhotonBeam> all;
  for (const PhotonsOfSphere& part : Distributed(spheres, options.photons)) {
    const auto count = static_cast<std::size_t>(part.count);
    std::vector<std::vector<PhotonBeam>> blocks((count + kPhotonsAtOnce - 1) / kPhotonsAtOnce);
    tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t block) {
      const std::size_t first = block * kPhotonsAtOnce;
      for (std::size_t i = first; i < std::min(first + kPhotonsAtOnce, count); ++i) {
        const PhotonNumbers numbers{part.first + static_cast<int>(i), shifts};
        follower.Follow(part, numbers, blocks[block]);
      }
    });
    for (const std::vector<PhotonBeam>& block : blocks)
      all.insert(all.end(), block.begin(), block.end());
  }
  return all;
}

}  // namespace alpenglow::renderer
