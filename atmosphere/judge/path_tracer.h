// SPDX-License-Identifier: MIT
// The judge of multiple scattering: a backward path tracer in a spherical shell.
//
// Along every straight piece of a path, light from the sun is gathered at points spread over the
// whole piece (several rational maps of the distance, each dense where light may come from: at the
// near end, at the lowest air, at the edge of the planet's shadow), jittered and combined by the
// balance heuristic (Veach and Guibas 1995, SIGGRAPH, 419). One of the same points, or the ground
// at the end, is then drawn to continue from, in proportion to what it scatters, summed over
// wavelengths. A path therefore serves all wavelengths, never misses the air, and its weight never
// grows. New directions are drawn from a mixture of the phase functions, the aerosol's lobe around
// the sun and, in twilight, the glow along the sunward horizon. Russian roulette ends paths.
//
// Unbiased but for the tables of columns (1e-6, path_sampling.h). Nothing here uses the shared
// texts, the closed forms or the tables of lut/, but for the phase functions' values.
// A point sun, no refraction, a Lambertian ground lit where mu_s >= 0. Light is scalar, or polarised
// (TraceStokes): then the path carries weights over Stokes parameters instead of a number
// (path_sampling.h), on the same points and in directions drawn in the same way.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "atmosphere/air/medium.h"
#include "atmosphere/air/phase.h"
#include "atmosphere/ray/ray.h"

namespace alpenglow::atmosphere::judge {

struct PathOptions {
  std::uint64_t seed = 1;
  std::size_t max_paths = 1U << 20U;
  /// Stop as soon as one standard error of every wavelength is below this part of its value.
  double relative_error = 0.005;
  /// Scatterings and reflections together, >= 1. 1: single scattering and directly lit ground.
  int max_order = 1000;
  /// Asked before every batch of paths; once it says true the tracer returns soon, with a result
  /// that is worth nothing.
  std::function<bool()> stopped = [] { return false; };
};

/// For unit solar irradiance [1/sr], at every wavelength.
struct PathTracedRadiance {
  std::vector<double> total;           // all orders, and ground at the end of the ray
  std::vector<double> single;          // order 1: scattered once, and directly lit ground
  std::vector<double> standard_error;  // of total
  std::vector<double> single_standard_error;
  std::size_t paths = 0;
  bool converged = false;  // relative_error was reached before max_paths
};

/// The same result for any number of threads (oneTBB's, as the caller limits them). Light reflected
/// by the ground at the ray's end is left out where BringsLightOfGround says so. Throws InputError
/// for a ray or a medium that is not valid, max_order < 1 or relative_error < 0. Of a medium whose
/// light is polarised, I of TraceStokes with the medium's depolarisation.
[[nodiscard]] PathTracedRadiance TraceRadiance(const Medium& medium, const ViewRay& ray,
                                               const PathOptions& options = {});

/// How the air polarises. The ground depolarises.
struct PolarisedScattering {
  std::vector<double> depolarisation;  // of molecules, by wavelength: see RayleighMatrix
  /// Of the aerosol: none where it depolarises, one for all wavelengths, or one per wavelength.
  std::vector<SphereRatios> aerosol = {};
};

/// Of a medium's molecules; its aerosol depolarises.
[[nodiscard]] PolarisedScattering ScatteringOf(const Medium& medium);

/// Stokes parameters for unit solar irradiance [1/sr]. Q > 0 vibrates in the vertical plane of the
/// view; U > 0 from the upper right to the lower left as the eye sees it where the sun is to the
/// left of the view (on its right, U has the opposite sign). Straight up and down the view counts
/// as tilted towards the sun's azimuth.
struct PathTracedStokes {
  PathTracedRadiance i, q, u;  // `converged` speaks of I
};

/// As TraceRadiance, of polarised light: the molecules' phase function is that of the matrix.
[[nodiscard]] PathTracedStokes TraceStokes(const Medium& medium,
                                           const PolarisedScattering& scattering,
                                           const ViewRay& ray, const PathOptions& options = {});

/// Which side of a horizontal plane light falls on.
enum class PlaneSide { kFromAbove, kFromBelow };

/// Per unit solar irradiance [1].
struct PathTracedIrradiance {
  std::vector<double> value;
  std::vector<double> standard_error;
  std::size_t paths = 0;
  bool converged = false;
};

/// Diffuse irradiance (all orders, without the sun's own beam) on a horizontal plane at an altitude
/// in [0, top].
[[nodiscard]] PathTracedIrradiance TraceIrradiance(const Medium& medium, double altitude_m,
                                                   double mu_s, PlaneSide side,
                                                   const PathOptions& options = {});

}  // namespace alpenglow::atmosphere::judge
