// SPDX-License-Identifier: MIT
// The hybrid method for light in a field of clouds: paths that end in the moments of light.
//
// The first K collisions of a path are those of the true medium, with voxels and the whole phase
// function p. The path then collides once more in the medium of the moments (cloud_optics.h) and
// collects the source of the moments there, so that coarse cells are seen only through K
// scatterings. In the direction d of the path, with the direction s to the sun and the optical depth
// tau_s to it, its events collect of the sun
//
//   events 1 to K - 1   p(d . s) exp(-tau_s)
//   event K             B(d . s, f w tau_s) exp(-(1 - f w) tau_s)
//   the last one        w' sum chi'_l (exp(-(1 - f w) tau_s) Y_lm(-s) + k(tau_s) M_lm) Y_lm(-d)
//
// From event K on the medium is that of the moments, where the forward peak is not scattering: the
// beam that event K sees is therefore the one that its forward peak has broadened (forward_peak.h).
// With p exp(-tau_s) there, that light would be lost. Events 2 to K have side rays as in CloudPathTracer;
// the source of the last one is smooth and needs none. Uniform light of sky and ground is collected
// where paths leave the field and at the last event.
//
// Paths of a ray are the points of a lattice with a random shift (Cranley and Patterson 1976, SIAM J.
// Numer. Anal. 13, 904): the first coordinate is that of first collisions in 1 - exp(-tau), the next
// ones are those of directions and free flights. The last event is taken in three directions evenly
// around that of the path, whose flights are a third apart, and their mean counts.
//
// The optical depths of the ray and of free flights are sums over steps, so that one number determines
// each. Without K every collision is a true one: paths are those of CloudPathTracer, without bias but
// for the optical depth of the ray.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "renderer/cloud_light/cloud_factor.h"
#include "renderer/cloud_light/cloud_moments.h"
#include "renderer/cloud_light/cloud_optics.h"
#include "renderer/cloud_light/cloud_path_tracer.h"
#include "renderer/cloud_light/cloud_sun_depths.h"
#include "renderer/cloud_light/cloud_tracking.h"
#include "renderer/clouds/cloud_field.h"

namespace alpenglow::renderer {

inline constexpr int kMostCloudPaths = 4096;

struct CloudHybridOptions {
  /// K, in [1, 1000]; nothing: all collisions are true ones.
  std::optional<int> collisions = 2;
  int paths = 64;  // per ray, in [2, kMostCloudPaths]; odd numbers are rounded up
};

/// Light that clouds scatter into a ray at least once, over black ground.
struct CloudScattered {
  CloudEstimate sun;     // for unit irradiance across the beam [1/sr]
  CloudEstimate sky;     // for unit radiance from all directions above
  CloudEstimate ground;  // for unit radiance from all directions below
  double transmittance = 1.0;

  bool operator==(const CloudScattered&) const = default;
};

/// The solution in which paths end. All of it is of one field and sun, and outlives its users.
struct SolvedCloudLight {
  const CloudOptics& optics;
  const CloudSunDepths& depths;
  const CloudMoments& sun;
  const CloudMoments& sky;
  const CloudMoments* ground;  // null for droplets that absorb nothing
  CloudFactor factor;          // on light of the sun of higher orders
};

/// A lattice of Korobov (1959): point i of n is i (1, a, a^2, ...) / n, each coordinate modulo 1. The
/// generator a is the one of at most 256 with the least error P_2 of smooth periodic functions.
class KorobovLattice {
 public:
  static constexpr std::size_t kDimensions = 7;

  /// @param points  in [2, kMostCloudPaths].
  explicit KorobovLattice(int points);

  /// Returns a coordinate of a point.
  [[nodiscard]] double At(std::size_t point, std::size_t dimension) const {
    return at_[point][dimension];
  }

 private:
  KorobovLattice(int points, int generator);
  [[nodiscard]] double Error() const;

  std::vector<std::array<double, kDimensions>> at_;
};

/// Immutable; safe to use from many threads.
class CloudHybrid {
 public:
  /// Throws InputError of CloudPathTracer and for options out of range.
  /// @param field  outlives this, like the solution.
  CloudHybrid(const CloudField& field, const CloudScatterers& scatterers,
              const SolvedCloudLight& solved, const CloudHybridOptions& options = {},
              bool uses_detail = false);

  /// Returns the light of a ray. The result depends only on the arguments. Standard errors are those
  /// of the paths alone, from differences of neighbours: they are on the safe side.
  /// @param length_m  of the ray, >= 0; may be infinite.
  /// @param seed  rays of a picture need different ones.
  [[nodiscard]] CloudScattered Radiance(const CloudRay& ray, double length_m,
                                        std::uint64_t seed) const;

 private:
  using PathRandom = CloudPathTracer::PathRandom;
  class Random;
  struct Walker;
  [[nodiscard]] CloudPathLight TracedPath(const CloudRay& event, Random& random) const;
  [[nodiscard]] const PhaseFunction& PhaseAt(const glm::dvec3& point, PathRandom& random) const;
  [[nodiscard]] double BeamAt(const CloudRay& event, const PhaseFunction& phase,
                              bool is_last) const;
  [[nodiscard]] double SideRay(const Walker& walker, const PhaseFunction& phase,
                               PathRandom& random) const;
  void CollectSun(Walker& walker, const PhaseFunction& phase, PathRandom& random) const;
  void Turn(Walker& walker, const PhaseFunction& phase, Random& random) const;
  /// Returns the unit light of sky or ground.
  [[nodiscard]] static CloudPathLight Outside(const glm::dvec3& direction);
  /// Returns the source of the beam in the medium of the moments.
  /// @param factors  CloudOptics::SourceFactors.
  [[nodiscard]] double ScaledBeam(const CloudHarmonics& factors, double to_sun) const;
  [[nodiscard]] CloudPathLight LastEvent(const CloudRay& ray, double fraction) const;
  void End(Walker& walker, const PhaseFunction& phase, Random& random) const;

  const CloudField* field_;
  SolvedCloudLight solved_;
  CloudHybridOptions options_;
  CloudPathTracer tracer_;
  CloudTracker true_medium_, scaled_medium_;
  CloudPhases phases_;
  KorobovLattice lattice_;
  CloudHarmonics beam_;  // of the direction of the sun's beam
};

}  // namespace alpenglow::renderer
