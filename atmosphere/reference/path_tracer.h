// SPDX-License-Identifier: MIT
// The reference solution for multiple scattering: a backward path tracer in a spherical shell.
//
// Along every straight segment of a path, light from the sun is gathered at points distributed over
// the whole segment: several rational maps of the distance, each dense where much light is expected
// (at the near end, at the lowest air, at the edge of the planet's shadow), jittered and combined
// by the balance heuristic (Veach and Guibas 1995, SIGGRAPH, 419). The path continues from one of
// these points, or from the ground at the end, drawn with probability proportional to its scattered
// light, summed over wavelengths. A path therefore serves all wavelengths, never misses the air,
// and its weight never increases. New directions are sampled from a mixture of the phase functions,
// the aerosol's lobe around the sun and, in twilight, the glow along the sunward horizon. Paths end
// by Russian roulette.
//
// Clouds and mountains among the air (path_surroundings.h) end segments: a cloud where a free flight
// through it collides. Vertices then have side paths and side rays around the sun (sun_lobe.h).
//
// The estimate is unbiased except for the tables of columns (1e-6, column_table.h). The shared
// sources, the closed forms and the tables of lut/ are not used, except for the values of phase
// functions. The sun is a point, there is no refraction, and the ground is Lambertian and lit where
// mu_s >= 0. Light is scalar or polarised (TraceStokes); for polarised light the path carries
// weights over Stokes parameters instead of a number (path_analyser.h), with the same distribution
// of points and directions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <vector>

#include "atmosphere/medium/medium.h"
#include "atmosphere/medium/phase.h"
#include "atmosphere/ray/ray.h"
#include "atmosphere/reference/path_sampling.h"
#include "atmosphere/reference/path_surroundings.h"

namespace alpenglow::atmosphere::reference {

struct PathOptions {
  std::uint64_t seed = 1;
  std::size_t max_paths = 1U << 20U;
  /// Stop as soon as one standard error at every wavelength is below this fraction of the value.
  double relative_error = 0.005;
  /// Maximum number of scattering and reflection events, >= 1. 1: single scattering and directly
  /// lit ground.
  int max_order = 1000;
  /// Called before every batch of paths. Once it returns true the tracer returns soon, and its
  /// result must not be used.
  std::function<bool()> stopped = [] { return false; };
};

/// Radiance for unit solar irradiance [1/sr], at every wavelength.
struct PathTracedRadiance {
  std::vector<double> total;           // all orders, and ground at the end of the ray
  std::vector<double> single;          // order 1: scattered once, and directly lit ground
  std::vector<double> standard_error;  // standard error of total
  std::vector<double> single_standard_error;
  std::size_t paths = 0;
  bool converged = false;  // relative_error was reached before max_paths
};

/// Returns the radiance along a ray. The result does not depend on the number of threads (oneTBB's,
/// as limited by the caller). Light reflected by the ground at the ray's end is omitted if
/// BringsLightOfGround returns false. For a medium with polarised light, the result is I of
/// TraceStokes with the medium's depolarisation. Throws InputError for a ray or a medium that is
/// not valid, max_order < 1 or relative_error < 0.
[[nodiscard]] PathTracedRadiance TraceRadiance(const Medium& medium, const ViewRay& ray,
                                               const PathOptions& options = {});

/// Polarisation by molecules and aerosol. The ground depolarises.
struct PolarisedScattering {
  std::vector<double> depolarisation;  // of molecules, by wavelength: see RayleighMatrix
  /// Polarisation by the aerosol: empty if it depolarises, one for all wavelengths, or one per
  /// wavelength.
  std::vector<SphereRatios> aerosol = {};
};

/// Returns the polarisation by a medium's molecules; its aerosol depolarises.
[[nodiscard]] PolarisedScattering ScatteringOf(const Medium& medium);

/// Stokes parameters for unit solar irradiance [1/sr]. Q > 0 is polarised in the vertical plane of
/// the view. U > 0 is polarised from the upper right to the lower left as the observer sees it, if
/// the sun is to the left of the view; if the sun is on the right, U has the opposite sign. A
/// vertical view is treated as tilted towards the sun's azimuth.
struct PathTracedStokes {
  PathTracedRadiance i, q, u;  // `converged` refers to I
};

/// Returns the Stokes parameters along a ray, like TraceRadiance; the phase function of the
/// molecules is that of the scattering matrix.
[[nodiscard]] PathTracedStokes TraceStokes(const Medium& medium,
                                           const PolarisedScattering& scattering,
                                           const ViewRay& ray, const PathOptions& options = {});

/// Side of a horizontal plane on which light falls.
enum class PlaneSide { kFromAbove, kFromBelow };

/// Irradiance per unit solar irradiance [1].
struct PathTracedIrradiance {
  std::vector<double> value;
  std::vector<double> standard_error;
  std::size_t paths = 0;
  bool converged = false;
};

/// Returns the diffuse irradiance (all orders, without the direct beam of the sun) on a horizontal
/// plane at an altitude in [0, top].
[[nodiscard]] PathTracedIrradiance TraceIrradiance(const Medium& medium, double altitude_m,
                                                   double mu_s, PlaneSide side,
                                                   const PathOptions& options = {});

/// Traces paths from any point, also among clouds and mountains (path_surroundings.h). Points are
/// metres from the planet's centre. Light is polarised if the medium's is. Immutable; safe
/// to use from many threads.
class AirPathTracer {
 public:
  /// Throws InputError for a medium that is not valid, and a direction that is not a unit vector.
  /// @param surroundings  must outlive the tracer; null: the planet's sphere with the albedo of the
  ///     medium.
  AirPathTracer(const Medium& medium, const glm::dvec3& to_sun,
                const PathSurroundings* surroundings);
  AirPathTracer(const AirPathTracer&) = delete;
  AirPathTracer& operator=(const AirPathTracer&) = delete;
  ~AirPathTracer();

  [[nodiscard]] std::size_t bands() const;
  /// Returns the light of one path, by band; its mean over random numbers is the radiance for unit
  /// solar irradiance [1/sr].
  /// @param direction  unit.
  [[nodiscard]] std::vector<double> OnePath(const glm::dvec3& origin, const glm::dvec3& direction,
                                            PathRandom& random,
                                            int max_order = std::numeric_limits<int>::max()) const;
  /// Returns the radiance along a ray, as TraceRadiance does. Throws InputError for options that are
  /// not valid.
  [[nodiscard]] PathTracedRadiance Radiance(const glm::dvec3& origin, const glm::dvec3& direction,
                                            const PathOptions& options = {}) const;

 private:
  struct State;
  std::unique_ptr<const State> state_;
};

}  // namespace alpenglow::atmosphere::reference
