// SPDX-License-Identifier: MIT
// The exact method for light in a field of clouds: path tracing with null collisions.
//
// Radiance: paths start at the eye. At every collision the path collects the sun's beam, whose
// transmittance is estimated by ratio tracking, and goes on in a direction drawn from the phase
// function p. Vertices have side paths and side rays around the sun (sun_lobe.h). Paths of little
// worth end at random, where worth is the weight times the brightness of the direction. Paths that
// leave upwards collect a uniform sky; below is a Lambertian ground.
//
// Fluxes: photons start from sun or sky at the top of the field and are counted in columns where
// they cross the planes through its top and base.
//
// Where a bias of some percent is allowed, paths are shorter after some collisions (WithSimilarity).
// Otherwise the results have no bias. They state their standard errors, from the scatter of independent batches
// of kPathsPerBatch paths each. They are the same for any number of threads.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "atmosphere/reference/path_sampling.h"
#include "atmosphere/reference/sun_lobe.h"
#include "renderer/cloud_light/cloud_low_sun.h"
#include "renderer/cloud_light/cloud_tracking.h"
#include "renderer/cloud_phase/cloud_phase.h"
#include "renderer/clouds/cloud_field.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

class CloudSimilarity;

/// The sun above a field and the ground below.
struct CloudSurroundings {
  glm::dvec3 to_sun{0.0, 0.0, 1.0};  // unit vector; the ground does not hide a low sun
  double ground_albedo = 0.0;        // in [0, 1]
  double ground_altitude_m = 0.0;    // at or below the base of the field
  /// Beams over a round planet, for radiances; null: straight ones. It must outlive the tracer.
  const CloudLowSun* low_sun = nullptr;
};

/// Phase functions and albedo of droplets or crystals at one wavelength.
struct CloudScatterers {
  CloudPhases phases;
  std::optional<double> albedo = {};  // of single scattering, in [0, 1]; nothing: the field's
};

struct CloudPathOptions {
  std::uint64_t seed = 1;
  /// Number of paths or photons, >= 1. It is rounded up to whole batches, at least
  /// kLeastCloudBatches of them.
  std::size_t paths = 4016;
  /// Largest number of scatterings and reflections, >= 1. 1: single scattering and sunlit ground.
  int max_order = std::numeric_limits<int>::max();
};

inline constexpr std::size_t kLeastCloudBatches = 16;

/// A mean over paths.
struct CloudEstimate {
  double value = 0.0, standard_error = 0.0;

  bool operator==(const CloudEstimate&) const = default;
};

/// Light along a ray. The radiance is linear in its sources: E sun + L sky + L' ground.
struct CloudRadiance {
  CloudEstimate sun;     // scattered sunlight for unit irradiance across the beam [1/sr]
  CloudEstimate sky;     // for unit radiance from all directions above; with the sky behind
  CloudEstimate ground;  // for a ground that emits unit radiance beside what it reflects
  CloudEstimate transmittance;
  std::size_t paths = 0;

  bool operator==(const CloudRadiance&) const = default;
};

/// Light that one path has collected.
struct CloudPathLight {
  double sun = 0.0, sky = 0.0, ground = 0.0;
};

enum class CloudSource { kSun, kSky };

struct CloudFluxOptions {
  CloudPathOptions paths{.paths = 1U << 18U};
  std::array<int, 2> columns{1, 1};  // along x and y; each in [1, 4096], together at most 2^20
};

/// Fluxes through horizontal planes, for a unit flux from the source through the top [1].
struct CloudColumnFluxes {
  CloudEstimate up_at_top;
  CloudEstimate direct_at_base;  // not scattered and not reflected
  CloudEstimate down_at_base;    // without the direct flux
  CloudEstimate up_at_base;
  CloudEstimate absorbed;  // by droplets in the column

  bool operator==(const CloudColumnFluxes&) const = default;
};

struct CloudFluxes {
  std::array<int, 2> columns{};
  std::vector<CloudColumnFluxes> column;  // x fastest, from the corner of the lattice on
  CloudColumnFluxes mean;                 // over all columns
  /// Mean of what leaves: up_at_top + direct + down - up at base + absorbed. It is 1, but for light
  /// that leaves an open field sideways, and for its standard error.
  CloudEstimate energy;
  std::size_t photons = 0;

  bool operator==(const CloudFluxes&) const = default;
};

/// Traces paths through a field, which must outlive the tracer. Immutable; safe to use from many
/// threads.
class CloudPathTracer {
 public:
  using PathRandom = atmosphere::reference::PathRandom;

  /// Throws InputError for surroundings out of range.
  /// @param uses_detail  whether the detail below a voxel is part of the field.
  CloudPathTracer(const CloudField& field, CloudScatterers scatterers,
                  const CloudSurroundings& surroundings, bool uses_detail = false);

  /// Returns a tracer whose paths are in the medium of cloud_similarity.h after some collisions. Throws
  /// InputError for phase functions without a forward peak. Mean sunlight is within 2 % of that without
  /// bias for suns from 12 degrees on, and within 40 % at 1 degree (asserted for 8 collisions).
  /// @param collisions  true ones, in [1, 1000].
  [[nodiscard]] CloudPathTracer WithSimilarity(int collisions) const;

  /// Returns the light along a ray from the eye, by as many threads as are free. Throws InputError
  /// for options or a ray that are not valid.
  [[nodiscard]] CloudRadiance Radiance(const CloudRay& ray,
                                       const CloudPathOptions& options = {}) const;

  /// Returns the light along one path from the eye; its mean over random numbers is the radiance.
  [[nodiscard]] CloudPathLight OnePath(const CloudRay& ray, PathRandom& random,
                                       int max_order = std::numeric_limits<int>::max()) const;

  /// Returns the light along one path that collides at the origin of a ray, on which it arrives.
  [[nodiscard]] CloudPathLight CollidedPath(const CloudRay& ray, PathRandom& random) const;

  /// Returns the ray on which a path leaves its last of some collisions; no value if it leaves the
  /// field before.
  [[nodiscard]] std::optional<CloudRay> AfterCollisions(CloudRay ray, int collisions,
                                                        PathRandom& random) const;

  /// Returns an unbiased estimate of the transmittance of clouds from a point to the sun.
  [[nodiscard]] double SunTransmittance(const glm::dvec3& point, PathRandom& random) const;

  /// Returns the fluxes by column. Columns of an open field are those of its lattice; light may
  /// enter them from the side. Throws InputError for options out of range, for a sun at or below
  /// the horizon, and for the sky above an open field.
  [[nodiscard]] CloudFluxes Fluxes(CloudSource source, const CloudFluxOptions& options = {}) const;

 private:
  struct Walker;
  struct Turn;
  struct Event;
  class PhotonCounter;

  [[nodiscard]] double GroundDistance_m(const CloudRay& ray) const;
  /// Returns whether paths are in the medium of similarity after a number of collisions.
  [[nodiscard]] bool IsSimilarAfter(int collisions) const {
    return similarity_ != nullptr && collisions >= true_collisions_;
  }
  [[nodiscard]] const CloudTracker& TrackerAfter(int collisions) const {
    return IsSimilarAfter(collisions) ? similar_tracker_ : tracker_;
  }
  [[nodiscard]] const PhaseFunction& PhaseAt(const glm::dvec3& point, PathRandom& random) const;
  [[nodiscard]] Event EventAt(const CloudRay& ray, int collisions, PathRandom& random) const;
  /// Returns the sunlight that an event scatters into the ray on which a path arrives.
  [[nodiscard]] double SunFrom(const Event& event, const CloudRay& ray, PathRandom& random) const;
  [[nodiscard]] double SunTransmittanceAfter(int collisions, const glm::dvec3& point,
                                             PathRandom& random) const;
  [[nodiscard]] double SunDepth(const glm::dvec3& point) const;
  void Follow(Walker& walker, PathRandom& random, int max_order) const;
  void Collide(Walker& walker, PathRandom& random, int max_order) const;
  void Reflect(Walker& walker, PathRandom& random, int max_order) const;
  /// Adds the next segments of a path from its vertex, and light of its side ray.
  void GoOn(Walker& walker, const Turn& turn, const atmosphere::reference::SunLobe& lobe,
            PathRandom& random) const;
  [[nodiscard]] double SideRay(const Walker& walker, const Turn& turn,
                               const atmosphere::reference::SunLobe& lobe,
                               PathRandom& random) const;
  [[nodiscard]] glm::dvec3 AroundSun(double to_sun, PathRandom& random) const;
  [[nodiscard]] CloudRay Launched(CloudSource source, PathRandom& random) const;
  void FollowPhoton(CloudRay ray, int max_order, PathRandom& random, PhotonCounter& counter) const;

  const CloudField* field_;
  CloudTracker tracker_;
  CloudPhases phases_;
  double albedo_;
  CloudSurroundings surroundings_;
  std::shared_ptr<const CloudSimilarity> similarity_;  // null: all collisions are true ones
  CloudTracker similar_tracker_;
  int true_collisions_ = 0;
};

}  // namespace alpenglow::renderer
