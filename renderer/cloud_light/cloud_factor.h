// SPDX-License-Identifier: MIT
// A factor on the light of higher orders, fitted to traced paths.
//
// Coarse cells lose light of the second and third order close under sunlit surfaces and have too
// much of it deeper inside. Both depend mainly on the optical depth tau_s to the sun. A factor
// k(tau_s), linear between six nodes in log(1 + tau_s), is fitted by least squares to paths of the
// exact method along random rays that enter through the top and the base, or that paths from there
// take after some collisions. The square of a ray's error counts relative to its radiance, at least a
// tenth of the mean, as for counted photons. Relative to the square of the radiance, dark rays would
// outweigh bright ones and leave them 0.5 to 1.5 % too dark in cumulus. Rays after collisions have
// more noise, of which most is in few bright ones: theirs counts relative to the square. Factors are
// expected to be those that many fields have, times a common number; relative to that, to scatter by 0.2
// and to differ by 0.1 from node to node. These expectations count against the errors of the rays, so
// that noise of the paths does not make factors alternate. The fit holds for one field and one sun.
//
// Noise of the paths would make the light of a film flicker. In a periodic field all factors are
// therefore multiplied by one number, with which the light along rays through top and base has the flux
// of the moments: these lose no light.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "renderer/cloud_light/cloud_gather.h"
#include "renderer/cloud_light/cloud_path_tracer.h"
#include "renderer/cloud_light/cloud_plane_rays.h"

namespace alpenglow::renderer {

struct CloudFactorOptions {
  std::size_t rays = 20000;  // in [0, 10^7]; 0: the factor is 1 everywhere
  int paths_per_ray = 2;     // in [1, 1000]
  std::uint64_t seed = 1;
  int collisions = 0;  // of paths from outside, after which rays begin; >= 0
};

/// A value at each of the hats of CloudHatsAt().
struct CloudFactor {
  std::array<double, kCloudFactorNodes> node{1.0, 1.0, 1.0, 1.0, 1.0, 1.0};

  /// Returns the light of the sun along a ray.
  [[nodiscard]] double Sun(const CloudRayParts& parts) const {
    double sum = parts.first;
    for (std::size_t i = 0; i < node.size(); ++i) sum += node[i] * parts.higher[i];
    return sum;
  }

  /// Returns the factor at an optical depth to the sun.
  [[nodiscard]] double At(double depth_to_sun) const {
    const CloudHats hats = CloudHatsAt(depth_to_sun);
    return std::lerp(node[hats.node], node[hats.node + 1], hats.share);
  }

  bool operator==(const CloudFactor&) const = default;
};

/// Returns the factor, with as many threads as are free; the result does not depend on their
/// number. Values are in [kLeastCloudFactor, kMostCloudFactor]. Throws InputError for options out of
/// range.
/// @param gather  of the field and sun of the tracer. @param tracer  with black ground.
[[nodiscard]] CloudFactor FitCloudFactor(const CloudField& field, const CloudGather& gather,
                                         const CloudPathTracer& tracer,
                                         const CloudFactorOptions& options = {});

/// Returns a factor in the same ratios with which the light along rays has a flux, apart from limits
/// as above; the factor itself if there is no light of higher orders.
/// @param gather  of a periodic field, with a sun above it. @param flux  through top and base, without
///     light that is not scattered, for a unit irradiance across the sun's beam.
[[nodiscard]] CloudFactor WithFlux(const CloudFactor& factor, const CloudGather& gather,
                                   const CloudPlaneRays& rays, double flux);

inline constexpr double kLeastCloudFactor = 0.25, kMostCloudFactor = 4.0;

}  // namespace alpenglow::renderer
