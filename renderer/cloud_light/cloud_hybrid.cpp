// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_hybrid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"

namespace alpenglow::renderer {
namespace {

// Steps of the optical depth of a ray and of free flights, among them the last one, which ends in
// coarse cells; voxels have 20 m.
constexpr double kDepthStep_m = 5.0, kFlightStep_m = 8.0, kLastStep_m = 16.0;
// Last events of a path, in directions evenly around that of the path.
constexpr int kEnds = 3;
// Batches of random numbers of a ray.
constexpr std::uint64_t kShift = 0, kFirstPath = 1;

/// The sum of values and of the squares of differences between neighbours.
struct PairedSum {
  double sum = 0.0, squares = 0.0, last = 0.0;

  void Add(double value, bool is_second) {
    sum += value;
    if (is_second) squares += (value - last) * (value - last);
    last = value;
  }
  [[nodiscard]] CloudEstimate Mean(double count) const {
    return {sum / count, std::sqrt(squares) / count};
  }
};

/// Returns options with an even number of paths. Throws InputError for options out of range.
CloudHybridOptions Checked(CloudHybridOptions options) {
  RequireInRange(options.collisions.value_or(1), 1.0, 1000.0, "true collisions of light in clouds");
  RequireInRange(options.paths, 2.0, kMostCloudPaths, "paths per ray through clouds");
  options.paths += options.paths % 2;
  return options;
}

}  // namespace

/// Random numbers of one path: a point of the lattice with a random shift, then independent ones.
class CloudHybrid::Random {
 public:
  Random(std::uint64_t seed, std::uint64_t path, const KorobovLattice& lattice)
      : path_(path),
        lattice_(lattice),
        shift_(seed, kShift, 0),
        independent_(seed, kFirstPath + path, 0) {}

  /// Returns a number that is uniform in [0, 1): a coordinate of the point as long as it has some.
  double Next() {
    if (drawn_ == KorobovLattice::kDimensions) return independent_.Next();
    const double at = shift_.Next() + lattice_.At(path_, drawn_++);
    return at - std::floor(at);
  }
  CloudPathTracer::PathRandom& independent() { return independent_; }

 private:
  std::uint64_t path_;
  const KorobovLattice& lattice_;
  CloudPathTracer::PathRandom shift_, independent_;
  std::size_t drawn_ = 0;
};

/// A path at an event and what it has collected.
struct CloudHybrid::Walker {
  CloudRay ray;
  CloudPathLight light{};
  double weight = 1.0;
  double share = 1.0;  // weight of the sun's light at the next event, beside that of the side ray
  int left = 0;        // true collisions from this one on
};

KorobovLattice::KorobovLattice(int points) {
  constexpr int kCandidates = 256;
  double least = std::numeric_limits<double>::infinity();
  const int step = std::max(points / kCandidates, 1);
  for (int generator = 1; generator < points; generator += step) {
    const KorobovLattice candidate(points, generator);
    const double error = candidate.Error();
    if (error >= least) continue;
    least = error;
    *this = candidate;
  }
}

KorobovLattice::KorobovLattice(int points, int generator) {
  const auto count = static_cast<std::uint64_t>(points);
  std::array<std::uint64_t, kDimensions> multiple{};
  std::uint64_t power = 1;
  for (std::uint64_t& each : multiple) {
    each = power;
    power = power * static_cast<std::uint64_t>(generator) % count;
  }
  for (std::uint64_t i = 0; i < count; ++i) {
    std::array<double, kDimensions>& point = at_.emplace_back();
    for (std::size_t j = 0; j < kDimensions; ++j) {
      point[j] = static_cast<double>(i * multiple[j] % count) / static_cast<double>(count);
    }
  }
}

double KorobovLattice::Error() const {
  double sum = 0.0;
  for (const std::array<double, kDimensions>& point : at_) {
    double product = 1.0;
    for (const double x : point) product *= 1.0 + kPi * kPi * (x * x - x + 1.0 / 6.0);
    sum += product;
  }
  return sum;
}

CloudHybrid::CloudHybrid(const CloudField& field, const CloudScatterers& scatterers,
                         const SolvedCloudLight& solved, const CloudHybridOptions& options,
                         bool uses_detail)
    : field_(&field),
      solved_(solved),
      options_(Checked(options)),
      tracer_(field, scatterers,
              {.to_sun = solved.depths.to_sun(),
               .ground_altitude_m = std::min(field.base_altitude_m(), 0.0),
               .low_sun = solved.depths.low_sun()},
              uses_detail),
      true_medium_(field, uses_detail),
      scaled_medium_(field, uses_detail, solved.optics.extinction_scale()),
      phases_(scatterers.phases),
      lattice_(options_.paths),
      beam_(CloudHarmonicsOf(-solved.depths.to_sun())) {}

const PhaseFunction& CloudHybrid::PhaseAt(const glm::dvec3& point, PathRandom& random) const {
  if (!phases_.depends_on_radius()) return phases_.Drawn(1.0, 0.0);
  return phases_.Drawn(field_->EffectiveRadius_um(point), random.Next());
}

double CloudHybrid::BeamAt(const CloudRay& event, const PhaseFunction& phase, bool is_last) const {
  const double to_sun = solved_.depths.OpticalDepth(event.origin);
  const double cosine = glm::dot(event.direction, solved_.depths.to_sun());
  if (!is_last) return Phase(phase, cosine) * std::exp(-to_sun);
  const double scale = solved_.optics.extinction_scale();
  return solved_.optics.peak().Broadened(cosine, (1.0 - scale) * to_sun) *
         std::exp(-scale * to_sun);
}

double CloudHybrid::SideRay(const Walker& walker, const PhaseFunction& phase,
                            PathRandom& random) const {
  const glm::dvec3& to_sun = solved_.depths.to_sun();
  CloudRay side{walker.ray.origin, ScatteredFrom(to_sun, phase, random)};
  const std::optional<double> distance_m =
      true_medium_.DistanceAt(side, -std::log1p(-random.Next()), kFlightStep_m);
  if (!distance_m) return 0.0;
  side.origin = side.At(*distance_m);
  const double main = Phase(phase, glm::dot(walker.ray.direction, side.direction));
  const double around_sun = Phase(phase, glm::dot(to_sun, side.direction));
  return solved_.optics.albedo() * BeamAt(side, PhaseAt(side.origin, random), walker.left == 2) *
         main / (main + around_sun);
}

void CloudHybrid::CollectSun(Walker& walker, const PhaseFunction& phase, PathRandom& random) const {
  const bool is_last = walker.left == 1;
  walker.weight *= solved_.optics.albedo();
  walker.light.sun += walker.weight * walker.share * BeamAt(walker.ray, phase, is_last);
  if (!is_last) walker.light.sun += walker.weight * SideRay(walker, phase, random);
}

void CloudHybrid::Turn(Walker& walker, const PhaseFunction& phase, Random& random) const {
  const glm::dvec3 next = ScatteredFrom(walker.ray.direction, phase, random);
  const double main = Phase(phase, glm::dot(walker.ray.direction, next));
  walker.share = main / (main + Phase(phase, glm::dot(next, solved_.depths.to_sun())));
  walker.ray.direction = next;
  --walker.left;
}

CloudPathLight CloudHybrid::Outside(const glm::dvec3& direction) {
  return direction.z >= 0.0 ? CloudPathLight{.sky = 1.0} : CloudPathLight{.ground = 1.0};
}

double CloudHybrid::ScaledBeam(const CloudHarmonics& factors, double to_sun) const {
  double source = 0.0;
  for (std::size_t i = 0; i < kCloudMoments; ++i) {
    source += static_cast<double>(factors[i] * beam_[i]);
  }
  return source * std::exp(-solved_.optics.extinction_scale() * to_sun);
}

CloudPathLight CloudHybrid::LastEvent(const CloudRay& ray, double fraction) const {
  const std::optional<double> distance_m =
      scaled_medium_.DistanceAt(ray, -std::log1p(-fraction), kLastStep_m);
  if (!distance_m) return Outside(ray.direction);
  const CloudRay event{ray.At(*distance_m), ray.direction};
  const CloudHarmonics factors = solved_.optics.SourceFactors(-ray.direction);
  const double to_sun = solved_.depths.OpticalDepth(event.origin);
  const CloudCells::Mixture around = solved_.sun.cells().Around(event.origin);
  const auto higher = static_cast<double>(solved_.sun.Source(around, factors));
  const auto sky = static_cast<double>(solved_.sky.Source(around, factors));
  return {.sun = ScaledBeam(factors, to_sun) + solved_.factor.At(to_sun) * higher,
          .sky = sky,
          .ground = solved_.ground != nullptr
                        ? static_cast<double>(solved_.ground->Source(around, factors))
                        : 1.0 - sky};
}

void CloudHybrid::End(Walker& walker, const PhaseFunction& phase, Random& random) const {
  const double cosine = SampleCosine(phase, random.Next());
  const double azimuth_rad = 2.0 * kPi * random.Next(), fraction = random.Next();
  const double weight = walker.weight / kEnds;
  for (int i = 0; i < kEnds; ++i) {
    const double turn = static_cast<double>(i) / kEnds, moved = fraction + turn;
    const glm::dvec3 next =
        TurnedFrom(walker.ray.direction, cosine, azimuth_rad + 2.0 * kPi * turn);
    const CloudPathLight light = LastEvent({walker.ray.origin, next}, moved - std::floor(moved));
    walker.light.sun += weight * light.sun;
    walker.light.sky += weight * light.sky;
    walker.light.ground += weight * light.ground;
  }
}

CloudPathLight CloudHybrid::TracedPath(const CloudRay& event, Random& random) const {
  Walker walker{event};
  walker.left = *options_.collisions;
  for (;;) {
    const PhaseFunction& phase = PhaseAt(walker.ray.origin, random.independent());
    CollectSun(walker, phase, random.independent());
    if (walker.left == 1) {
      End(walker, phase, random);
      return walker.light;
    }
    Turn(walker, phase, random);
    const std::optional<double> distance_m =
        true_medium_.DistanceAt(walker.ray, -std::log1p(-random.Next()), kFlightStep_m);
    if (!distance_m) {
      const CloudPathLight light = Outside(walker.ray.direction);
      walker.light.sky += walker.weight * light.sky;
      walker.light.ground += walker.weight * light.ground;
      return walker.light;
    }
    walker.ray.origin = walker.ray.At(*distance_m);
  }
}

CloudScattered CloudHybrid::Radiance(const CloudRay& ray, double length_m,
                                     std::uint64_t seed) const {
  const CloudDepths depths(true_medium_, ray, length_m, kDepthStep_m);
  CloudScattered found;
  found.transmittance = std::exp(-depths.depth());
  const double collided = -std::expm1(-depths.depth());
  if (collided <= 0.0) return found;
  const int paths = options_.paths;
  PairedSum sun, sky, ground;
  for (int i = 0; i < paths; ++i) {
    Random random(seed, static_cast<std::uint64_t>(i), lattice_);
    const CloudRay event{ray.At(depths.Collision_m(random.Next())), ray.direction};
    CloudPathLight light;
    if (options_.collisions) {
      light = TracedPath(event, random);
    } else {
      light = tracer_.CollidedPath(event, random.independent());
    }
    sun.Add(collided * light.sun, i % 2 == 1);
    sky.Add(collided * light.sky, i % 2 == 1);
    ground.Add(collided * light.ground, i % 2 == 1);
  }
  found.sun = sun.Mean(paths);
  found.sky = sky.Mean(paths);
  found.ground = ground.Mean(paths);
  return found;
}

}  // namespace alpenglow::renderer
