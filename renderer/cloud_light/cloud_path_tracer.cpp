// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_path_tracer.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/phase.h"
#include "renderer/cloud_light/cloud_similarity.h"
#include "renderer/clouds/periodic_index.h"

namespace alpenglow::renderer {
namespace {

using atmosphere::reference::kPathsPerBatch;
using atmosphere::reference::kSidePaths;
using atmosphere::reference::SunLobe;
using PathRandom = CloudPathTracer::PathRandom;

constexpr double kUnbounded_m = std::numeric_limits<double>::infinity();
// Photons with less weight than this survive with probability 1/2.
constexpr double kLeastWeight = 0.25;
// Paths that are worth less than this, in light of a mean direction, survive by their worth.
constexpr double kLeastWorth = 0.25;
// Steps of the optical depth to the sun at the last true collision; voxels have 20 m.
constexpr double kSunStep_m = 8.0;
// Radius of the droplets whose phase function the lobe around the sun has at the ground.
constexpr double kTypicalRadius_um = 10.0;
// Fluxes have this number of groups of batches, whose scatter is their standard error. A wave of
// groups is traced at once; its size bounds the memory.
constexpr std::size_t kFluxGroups = 32, kWave = 8;
constexpr std::size_t kMostColumns = std::size_t{1} << 18U;

/// Returns a direction with density cos / pi around the vertical; `up` is 1 or -1.
glm::dvec3 LambertianDirection(double up, PathRandom& random) {
  const double cosine = std::sqrt(1.0 - random.Next());
  return TurnedFrom({0.0, 0.0, up}, cosine, 2.0 * kPi * random.Next());
}

/// Returns the weight of a photon after Russian roulette; 0 if it ends.
double WeightAfterRoulette(double weight, PathRandom& random) {
  if (weight >= kLeastWeight || weight == 0.0) return weight;
  return random.Next() < 0.5 ? 2.0 * weight : 0.0;
}

CloudEstimate EstimateOf(const std::vector<double>& batch_means) {
  const auto count = static_cast<double>(batch_means.size());
  double sum = 0.0, squares = 0.0;
  for (const double value : batch_means) sum += value;
  const double mean = sum / count;
  for (const double value : batch_means) squares += (value - mean) * (value - mean);
  return {mean, std::sqrt(squares / (count - 1.0) / count)};
}

void RequireUnit(const glm::dvec3& direction, const char* name) {
  if (!(std::abs(glm::length(direction) - 1.0) <= 1e-6)) {
    throw InputError(fmt::format("{} has the length {}; it must be a unit vector", name,
                                 glm::length(direction)));
  }
}

/// Returns the number of batches. Throws InputError for options that are not valid.
std::size_t BatchesOf(const CloudPathOptions& options) {
  if (options.paths < 1) throw InputError("paths through clouds: there must be at least one");
  if (options.max_order < 1) {
    throw InputError(fmt::format("max_order is {}; it must be 1 or more", options.max_order));
  }
  return std::max(kLeastCloudBatches, (options.paths + kPathsPerBatch - 1) / kPathsPerBatch);
}

}  // namespace

/// A path from the eye, its segments that are not followed yet, and what it has collected.
struct CloudPathTracer::Walker {
  struct Branch {
    CloudRay ray;
    double weight = 1.0;
    double share = 1.0;  // weight of the sun's light at the next collision: see the header
    int order = 0;       // events so far
    int collisions = 0;  // those of them in clouds
  };
  Branch at;
  std::vector<Branch> segments{};
  CloudPathLight light{};
};

/// Light that is scattered or reflected into the path, by the direction from which it comes.
struct CloudPathTracer::Turn {
  const PhaseFunction* phase;  // null: level Lambertian ground
  glm::dvec3 before;           // direction of the path

  /// Returns the density with which directions are drawn, which is the light per light that arrives.
  [[nodiscard]] double Density(const glm::dvec3& after) const {
    return phase != nullptr ? Phase(*phase, glm::dot(before, after)) : std::max(after.z, 0.0) / kPi;
  }
  [[nodiscard]] glm::dvec3 Drawn(PathRandom& random) const {
    return phase != nullptr ? ScatteredFrom(before, *phase, random)
                            : LambertianDirection(1.0, random);
  }
};

/// A collision of a path.
struct CloudPathTracer::Event {
  const PhaseFunction* phase;
  double albedo;
  int number;  // of collisions of the path up to this one
};

CloudPathTracer::CloudPathTracer(const CloudField& field, CloudScatterers scatterers,
                                 const CloudSurroundings& surroundings, bool uses_detail)
    : field_(&field),
      tracker_(field, uses_detail),
      phases_(std::move(scatterers.phases)),
      albedo_(scatterers.albedo.value_or(field.single_scattering_albedo())),
      surroundings_(surroundings),
      similar_tracker_(tracker_) {
  RequireInRange(albedo_, 0.0, 1.0, "the albedo of single scattering in clouds");
  RequireUnit(surroundings_.to_sun, "the direction to the sun");
  RequireInRange(surroundings_.ground_albedo, 0.0, 1.0, "the albedo of the ground below clouds");
  RequireInRange(surroundings_.ground_altitude_m, -1e5, field.base_altitude_m(),
                 "the altitude of the ground below clouds [m]");
}

CloudPathTracer CloudPathTracer::WithSimilarity(int collisions) const {
  RequireInRange(collisions, 1.0, 1000.0, "true collisions of light in clouds");
  CloudPathTracer other = *this;
  const CloudScatterers scatterers{phases_, albedo_};
  other.similarity_ = std::make_shared<const CloudSimilarity>(*field_, scatterers);
  other.similar_tracker_ = tracker_.WithScale(other.similarity_->extinction_scale());
  other.true_collisions_ = collisions;
  return other;
}

double CloudPathTracer::GroundDistance_m(const CloudRay& ray) const {
  const double height_m = ray.origin.z - surroundings_.ground_altitude_m;
  return ray.direction.z < 0.0 && height_m >= 0.0 ? -height_m / ray.direction.z : kUnbounded_m;
}

const PhaseFunction& CloudPathTracer::PhaseAt(const glm::dvec3& point, PathRandom& random) const {
  if (!phases_.depends_on_radius()) return phases_.Drawn(1.0, 0.0);
  return phases_.Drawn(field_->EffectiveRadius_um(point), random.Next());
}

double CloudPathTracer::SunTransmittance(const glm::dvec3& point, PathRandom& random) const {
  if (surroundings_.low_sun != nullptr) return surroundings_.low_sun->Transmittance(point, random);
  return tracker_.Transmittance({point, surroundings_.to_sun}, kUnbounded_m, random);
}

double CloudPathTracer::SunTransmittanceAfter(int collisions, const glm::dvec3& point,
                                              PathRandom& random) const {
  if (!IsSimilarAfter(collisions)) return SunTransmittance(point, random);
  if (surroundings_.low_sun != nullptr)
    return std::exp(-similarity_->extinction_scale() * SunDepth(point));
  return similar_tracker_.Transmittance({point, surroundings_.to_sun}, kUnbounded_m, random);
}

double CloudPathTracer::SunDepth(const glm::dvec3& point) const {
  if (surroundings_.low_sun != nullptr) return surroundings_.low_sun->OpticalDepth(point);
  return tracker_.OpticalDepth({point, surroundings_.to_sun}, kUnbounded_m, kSunStep_m);
}

CloudPathTracer::Event CloudPathTracer::EventAt(const CloudRay& ray, int collisions,
                                                PathRandom& random) const {
  if (IsSimilarAfter(collisions))
    return {&similarity_->phase(), similarity_->albedo(), collisions + 1};
  return {&PhaseAt(ray.origin, random), albedo_, collisions + 1};
}

double CloudPathTracer::SunFrom(const Event& event, const CloudRay& ray, PathRandom& random) const {
  const double cosine = glm::dot(ray.direction, surroundings_.to_sun);
  if (similarity_ != nullptr && event.number == true_collisions_)
    return event.albedo * similarity_->LastTrueSource(cosine, SunDepth(ray.origin));
  return event.albedo * Phase(*event.phase, cosine) *
         SunTransmittanceAfter(event.number, ray.origin, random);
}

glm::dvec3 CloudPathTracer::AroundSun(double to_sun, PathRandom& random) const {
  return TurnedFrom(surroundings_.to_sun, to_sun, 2.0 * kPi * random.Next());
}

double CloudPathTracer::SideRay(const Walker& walker, const Turn& turn, const SunLobe& lobe,
                                PathRandom& random) const {
  const double to_sun = lobe.DrawnFromPeak(random.Next());
  CloudRay side{walker.at.ray.origin, AroundSun(to_sun, random)};
  const double main = turn.Density(side.direction);
  if (main == 0.0) return 0.0;
  const std::optional<double> distance_m = tracker_.Collision(side, GroundDistance_m(side), random);
  if (!distance_m) return 0.0;
  side.origin = side.At(*distance_m);
  const Event event = EventAt(side, walker.at.collisions, random);
  return SunFrom(event, side, random) * main /
         (main + lobe.OfSidePaths(to_sun) + lobe.Peak(to_sun));
}

void CloudPathTracer::GoOn(Walker& walker, const Turn& turn, const SunLobe& lobe,
                           PathRandom& random) const {
  const glm::dvec3 from = walker.at.ray.origin;
  if (IsSimilarAfter(walker.at.collisions)) {  // the lobe is so wide that it needs no side paths
    const double weight = WeightAfterRoulette(walker.at.weight, random);
    if (weight > 0.0) {
      walker.segments.push_back(
          {{from, turn.Drawn(random)}, weight, 1.0, walker.at.order, walker.at.collisions});
    }
    return;
  }
  walker.light.sun += walker.at.weight * SideRay(walker, turn, lobe, random);
  const auto add = [&](const glm::dvec3& direction) {
    const double to_sun = glm::dot(direction, surroundings_.to_sun);
    const double main = turn.Density(direction), all = main + lobe.OfSidePaths(to_sun);
    double weight = walker.at.weight * main / all;
    // Clouds are brighter around the sun: paths there are worth more than their weight.
    const double worth = weight * std::max(4.0 * kPi * lobe.Mean(to_sun), 1.0);
    if (worth < kLeastWorth) {
      if (random.Next() * kLeastWorth >= worth) return;
      weight *= kLeastWorth / worth;
    }
    walker.segments.push_back({{from, direction},
                               weight,
                               all / (all + lobe.Peak(to_sun)),
                               walker.at.order,
                               walker.at.collisions});
  };
  if (random.Next() < kSidePaths) add(AroundSun(lobe.DrawnFromMean(random.Next()), random));
  add(turn.Drawn(random));
}

void CloudPathTracer::Collide(Walker& walker, PathRandom& random, int max_order) const {
  const Event event = EventAt(walker.at.ray, walker.at.collisions, random);
  walker.light.sun += walker.at.weight * walker.at.share * SunFrom(event, walker.at.ray, random);
  walker.at.weight *= event.albedo;
  walker.at.collisions = event.number;
  if (++walker.at.order >= max_order) return;
  GoOn(walker, {event.phase, walker.at.ray.direction}, SunLobe(*event.phase), random);
}

void CloudPathTracer::Reflect(Walker& walker, PathRandom& random, int max_order) const {
  walker.light.ground += walker.at.weight;
  walker.at.weight *= surroundings_.ground_albedo;
  if (walker.at.weight == 0.0) return;
  const double mu_s = surroundings_.to_sun.z;
  if (mu_s > 0.0) {
    walker.light.sun += walker.at.weight * mu_s / kPi *
                        SunTransmittanceAfter(walker.at.collisions, walker.at.ray.origin, random);
  }
  if (++walker.at.order >= max_order) return;
  GoOn(walker, {nullptr, {}}, SunLobe(phases_.Drawn(kTypicalRadius_um, 0.0)), random);
}

CloudPathLight CloudPathTracer::OnePath(const CloudRay& ray, PathRandom& random,
                                        int max_order) const {
  Walker walker{.at = {ray}, .segments = {{ray}}};
  Follow(walker, random, max_order);
  return walker.light;
}

CloudPathLight CloudPathTracer::CollidedPath(const CloudRay& ray, PathRandom& random) const {
  constexpr int kAllOrders = std::numeric_limits<int>::max();
  Walker walker{.at = {ray}};
  Collide(walker, random, kAllOrders);
  Follow(walker, random, kAllOrders);
  return walker.light;
}

std::optional<CloudRay> CloudPathTracer::AfterCollisions(CloudRay ray, int collisions,
                                                         PathRandom& random) const {
  for (int i = 0; i < collisions; ++i) {
    const std::optional<double> distance_m = tracker_.Collision(ray, kUnbounded_m, random);
    if (!distance_m) return std::nullopt;
    ray.origin = ray.At(*distance_m);
    ray.direction = ScatteredFrom(ray.direction, PhaseAt(ray.origin, random), random);
  }
  return ray;
}

void CloudPathTracer::Follow(Walker& walker, PathRandom& random, int max_order) const {
  while (!walker.segments.empty()) {
    walker.at = walker.segments.back();
    walker.segments.pop_back();
    CloudRay& ray = walker.at.ray;
    const double ground_m = GroundDistance_m(ray);
    const std::optional<double> distance_m =
        TrackerAfter(walker.at.collisions).Collision(ray, ground_m, random);
    if (!distance_m && ground_m == kUnbounded_m) {
      if (ray.direction.z >= 0.0) walker.light.sky += walker.at.weight;
      continue;
    }
    ray.origin = ray.At(distance_m.value_or(ground_m));
    if (distance_m) {
      Collide(walker, random, max_order);
    } else {
      Reflect(walker, random, max_order);
    }
  }
}

CloudRadiance CloudPathTracer::Radiance(const CloudRay& ray,
                                        const CloudPathOptions& options) const {
  const std::size_t batches = BatchesOf(options);
  RequireUnit(ray.direction, "the direction of a ray through clouds");
  std::vector<double> sun(batches), sky(batches), ground(batches), transmittance(batches);
  tbb::parallel_for(std::size_t{0}, batches, [&](std::size_t batch) {
    CloudPathLight sum;
    double left = 0.0;
    for (std::size_t path = 0; path < kPathsPerBatch; ++path) {
      PathRandom random(options.seed, batch, path);
      const CloudPathLight light = OnePath(ray, random, options.max_order);
      sum.sun += light.sun;
      sum.sky += light.sky;
      sum.ground += light.ground;
      left += tracker_.Transmittance(ray, GroundDistance_m(ray), random);
    }
    sun[batch] = sum.sun / kPathsPerBatch;
    sky[batch] = sum.sky / kPathsPerBatch;
    ground[batch] = sum.ground / kPathsPerBatch;
    transmittance[batch] = left / kPathsPerBatch;
  });
  return {EstimateOf(sun), EstimateOf(sky), EstimateOf(ground), EstimateOf(transmittance),
          batches * kPathsPerBatch};
}

namespace {

/// Kinds of flux, in the order of CloudColumnFluxes.
enum class FluxKind { kUpAtTop, kDirectAtBase, kDownAtBase, kUpAtBase, kAbsorbed };
constexpr std::size_t kFluxKinds = 5;

/// A rectangle of the plane through the top of a field, where photons start.
struct LaunchArea {
  glm::dvec2 low, size;
};

/// Returns a period, or the part of the plane from which a beam reaches the lattice of an open field.
LaunchArea LaunchAreaOf(const CloudField& field, const glm::dvec3& to_sun) {
  const glm::dvec2 low(field.lattice().origin_m), size(field.lattice().size_m());
  if (field.lattice().is_periodic) return {low, size};
  const double depth_m = field.top_altitude_m() - field.base_altitude_m();
  const glm::dvec2 shift = depth_m / to_sun.z * glm::dvec2(to_sun);
  return {low + glm::min(shift, 0.0), size + glm::abs(shift)};
}

/// Means and scatter of the fluxes of groups of photons.
class FluxMoments {
 public:
  explicit FluxMoments(std::size_t values) : sum_(values), squares_(values) {}

  void Add(const std::vector<double>& group) {
    for (std::size_t i = 0; i < group.size(); ++i) {
      sum_[i] += group[i];
      squares_[i] += group[i] * group[i];
    }
  }
  [[nodiscard]] CloudEstimate At(std::size_t value) const {
    constexpr double kGroups = kFluxGroups;
    const double mean = sum_[value] / kGroups;
    const double variance = std::max(0.0, squares_[value] / kGroups - mean * mean);
    return {mean, std::sqrt(variance / (kGroups - 1.0))};
  }
  [[nodiscard]] CloudColumnFluxes Column(std::size_t column) const {
    const auto at = [&](FluxKind kind) {
      return At(column * kFluxKinds + static_cast<std::size_t>(kind));
    };
    return {at(FluxKind::kUpAtTop), at(FluxKind::kDirectAtBase), at(FluxKind::kDownAtBase),
            at(FluxKind::kUpAtBase), at(FluxKind::kAbsorbed)};
  }

 private:
  std::vector<double> sum_, squares_;
};

/// Returns the fluxes of a group, averaged over columns, and the energy that leaves.
std::vector<double> MeanOverColumns(const std::vector<double>& group) {
  std::vector<double> mean(kFluxKinds + 1);
  const std::size_t columns = group.size() / kFluxKinds;
  for (std::size_t i = 0; i < group.size(); ++i) {
    mean[i % kFluxKinds] += group[i] / static_cast<double>(columns);
  }
  mean.back() = mean[0] + mean[1] + mean[2] - mean[3] + mean[4];
  return mean;
}

void RequireValidColumns(const std::array<int, 2>& columns) {
  for (const int count : columns) {
    if (count < 1 || count > 4096) {
      throw InputError(fmt::format(
          "fluxes of clouds in {} columns along an axis; there must be 1 to 4096", count));
    }
  }
  if (static_cast<std::size_t>(columns[0]) * static_cast<std::size_t>(columns[1]) > kMostColumns) {
    throw InputError(fmt::format("fluxes of clouds in {} x {} columns; there must be at most {}",
                                 columns[0], columns[1], kMostColumns));
  }
}

}  // namespace

/// Fluxes by column of one group of photons.
class CloudPathTracer::PhotonCounter {
 public:
  /// @param weight  flux in a column per photon.
  PhotonCounter(const CloudField& field, const std::array<int, 2>& columns, double weight)
      : origin_(field.lattice().origin_m),
        per_column_(glm::dvec2(columns[0], columns[1]) / glm::dvec2(field.lattice().size_m())),
        is_periodic_(field.lattice().is_periodic),
        columns_(columns),
        weight_(weight),
        flux_(kFluxKinds * static_cast<std::size_t>(columns[0]) *
              static_cast<std::size_t>(columns[1])) {}

  /// Adds the share of a photon at a point; points beside an open field are omitted.
  void Add(FluxKind kind, const glm::dvec3& point, double share) {
    std::size_t column = 0;
    for (int axis = 1; axis >= 0; --axis) {
      const auto count = columns_[static_cast<std::size_t>(axis)];
      double at = std::floor((point[axis] - origin_[axis]) * per_column_[axis]);
      if (is_periodic_) at = PeriodicIndex(at, count);
      if (!(at >= 0.0 && at < count)) return;
      column = column * static_cast<std::size_t>(count) + static_cast<std::size_t>(at);
    }
    flux_[column * kFluxKinds + static_cast<std::size_t>(kind)] += weight_ * share;
  }
  [[nodiscard]] const std::vector<double>& flux() const { return flux_; }

 private:
  glm::dvec2 origin_, per_column_;
  bool is_periodic_;
  std::array<int, 2> columns_;
  double weight_;
  std::vector<double> flux_;
};

CloudRay CloudPathTracer::Launched(CloudSource source, PathRandom& random) const {
  const LaunchArea launch = LaunchAreaOf(*field_, surroundings_.to_sun);
  const double x_m = launch.low.x + launch.size.x * random.Next();
  const double y_m = launch.low.y + launch.size.y * random.Next();
  return {{x_m, y_m, field_->top_altitude_m()},
          source == CloudSource::kSun ? -surroundings_.to_sun : LambertianDirection(-1.0, random)};
}

void CloudPathTracer::FollowPhoton(CloudRay ray, int max_order, PathRandom& random,
                                   PhotonCounter& counter) const {
  const double base_m = field_->base_altitude_m(), top_m = field_->top_altitude_m();
  double weight = 1.0;
  int collisions = 0;
  for (int order = 0; weight > 0.0 && order <= max_order; ++order) {
    const std::optional<double> distance_m =
        TrackerAfter(collisions).Collision(ray, kUnbounded_m, random);
    const double slope = ray.direction.z;
    if (distance_m) {
      ray.origin = ray.At(*distance_m);
      const Event event = EventAt(ray, collisions++, random);
      counter.Add(FluxKind::kAbsorbed, ray.origin, weight * (1.0 - event.albedo));
      weight *= event.albedo;
      ray.direction = ScatteredFrom(ray.direction, *event.phase, random);
    } else if (slope > 0.0) {
      counter.Add(FluxKind::kUpAtTop, ray.At((top_m - ray.origin.z) / slope), weight);
      return;
    } else if (slope < 0.0) {
      counter.Add(order == 0 ? FluxKind::kDirectAtBase : FluxKind::kDownAtBase,
                  ray.At((base_m - ray.origin.z) / slope), weight);
      ray.origin = ray.At(GroundDistance_m(ray));
      weight *= surroundings_.ground_albedo;
      ray.direction = LambertianDirection(1.0, random);
    } else {
      return;  // a level ray that meets no cloud for kFarthestCloud_m
    }
    weight = WeightAfterRoulette(weight, random);
    if (!distance_m) {
      const double rise_m = base_m - ray.origin.z;
      counter.Add(FluxKind::kUpAtBase, ray.At(rise_m / ray.direction.z), weight);
    }
  }
}

CloudFluxes CloudPathTracer::Fluxes(CloudSource source, const CloudFluxOptions& options) const {
  const std::size_t batches = (BatchesOf(options.paths) + kFluxGroups - 1) / kFluxGroups;
  RequireValidColumns(options.columns);
  if (source == CloudSource::kSun && !(surroundings_.to_sun.z > 0.0)) {
    throw InputError("fluxes of clouds: the sun must be above the horizon");
  }
  if (source == CloudSource::kSky && !field_->lattice().is_periodic) {
    throw InputError("fluxes of clouds below a sky: the field must be periodic");
  }
  const LaunchArea launch = LaunchAreaOf(*field_, surroundings_.to_sun);
  const glm::dvec3 size_m = field_->lattice().size_m();
  const auto columns = static_cast<std::size_t>(options.columns[0] * options.columns[1]);
  const std::size_t photons = batches * kPathsPerBatch;  // of a group
  const double weight = launch.size.x * launch.size.y / (size_m.x * size_m.y) *
                        static_cast<double>(columns) / static_cast<double>(photons);
  FluxMoments by_column(columns * kFluxKinds), means(kFluxKinds + 1);
  for (std::size_t first = 0; first < kFluxGroups; first += kWave) {
    std::vector<PhotonCounter> wave(kWave, {*field_, options.columns, weight});
    tbb::parallel_for(std::size_t{0}, kWave, [&](std::size_t i) {
      for (std::size_t photon = 0; photon < photons; ++photon) {
        const std::size_t batch = (first + i) * batches + photon / kPathsPerBatch;
        PathRandom random(options.paths.seed, batch, photon % kPathsPerBatch);
        const CloudRay ray = Launched(source, random);
        FollowPhoton(ray, options.paths.max_order, random, wave[i]);
      }
    });
    for (const PhotonCounter& counter : wave) {
      by_column.Add(counter.flux());
      means.Add(MeanOverColumns(counter.flux()));
    }
  }
  CloudFluxes fluxes{.columns = options.columns,
                     .column = {},
                     .mean = means.Column(0),
                     .energy = means.At(kFluxKinds),
                     .photons = photons * kFluxGroups};
  for (std::size_t i = 0; i < columns; ++i) fluxes.column.push_back(by_column.Column(i));
  return fluxes;
}

}  // namespace alpenglow::renderer
