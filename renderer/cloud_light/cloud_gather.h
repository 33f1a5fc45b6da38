// SPDX-License-Identifier: MIT
// Light that a field of clouds scatters into a ray, from the extinction of voxels and the moments of
// light on coarse cells.
//
// The ray passes bricks and cubes without cloud (cloud_line.h), and takes a share of the depth under
// the surface near clouds and steps of scaled optical depth 0.5 inside. With T' = exp(-tau') the
// transmittance of the scaled medium (cloud_optics.h) up to a step, its source is
//
//   w' p_eff(nu, f w (tau_s + tau)) exp(-tau'_s) + k(tau_s) sum w' chi'_l M_lm Y_lm
//
// per unit of scaled extinction, with the optical depths tau to the eye and tau_s to the sun. The
// first term is light of the beam with the forward peak (forward_peak.h). The optical depth to the sun
// and the moments are linear between nodes of the ray, 40 m apart where it enters a cloud and up to
// 80 m further inside. The factor k is left to the caller (cloud_factor.h): light of higher orders is
// summed apart for hats in log(1 + tau_s).
#pragma once

#include <array>
#include <cstddef>

#include "renderer/cloud_light/cloud_moments.h"
#include "renderer/cloud_light/cloud_optics.h"
#include "renderer/cloud_light/cloud_sun_depths.h"
#include "renderer/cloud_light/cloud_tracking.h"
#include "renderer/cloud_phase/phase_colours.h"
#include "renderer/clouds/cloud_field.h"

namespace alpenglow::renderer {

struct CloudGatherOptions {
  double step_depth = 0.5;  // scaled optical depth of a step
  double least_step_m = 4.0, most_step_m = 40.0;
  bool uses_detail = false;  // whether the extinction has the detail below a voxel
};

inline constexpr std::size_t kCloudFactorNodes = 6;

/// The hats in log(1 + tau_s) at an optical depth: two neighbouring nodes and their weights. Nodes
/// divide log(1 + tau) up to tau = 40 evenly; deeper points belong to the last one.
struct CloudHats {
  std::size_t node;  // the first of both
  double share;      // weight of the second
};
[[nodiscard]] CloudHats CloudHatsAt(double depth_to_sun);

/// Light along a ray, and what clouds leave of the light behind it.
struct CloudRayParts {
  double first = 0.0;    // of the sun's beam, for unit irradiance across it [1/sr]
  OnceScattered once{};  // the same before it is multiplied by p_eff, for its colours
  std::array<double, kCloudFactorNodes> higher{};  // of higher orders, by hat
  double sky = 0.0;     // for unit radiance from all directions above, without the sky behind
  double ground = 0.0;  // for unit radiance from all directions below, without the ground behind
  double transmittance = 1.0;         // of narrow sources behind
  double scaled_transmittance = 1.0;  // T', of wide sources behind: sky, haze
  /// Distance of the clouds, weighted by the light that they scatter into the ray; 0 if there are
  /// none.
  double mean_distance_m = 0.0;
};

/// Gathers light along rays. It refers to all its arguments, which must outlive it. Safe to use from
/// many threads.
class CloudGather {
 public:
  /// @param to_sun, sun  of one sun. @param ground  null for droplets that absorb nothing.
  CloudGather(const CloudField& field, const CloudOptics& optics, const CloudSunDepths& to_sun,
              const CloudMoments& sun, const CloudMoments& sky, const CloudMoments* ground,
              const CloudGatherOptions& options = {});

  /// @param length_m  of the ray, >= 0; may be infinite. Rays end after kFarthestCloud_m anyway.
  [[nodiscard]] CloudRayParts Along(const CloudRay& ray, double length_m) const;

 private:
  struct Node;
  struct March;
  struct Inside;
  [[nodiscard]] Node NodeAt(const March& march, double at_m) const;
  /// Returns the distance at which a ray has passed all clouds.
  [[nodiscard]] double LayerLength_m(const CloudRay& ray) const;
  [[nodiscard]] double StepInside_m(const CloudField::Sample& sample) const;

  const CloudField* field_;
  const CloudOptics* optics_;
  const CloudSunDepths* to_sun_;
  const CloudMoments* sun_;
  const CloudMoments* sky_;
  const CloudMoments* ground_;
  CloudGatherOptions options_;
};

}  // namespace alpenglow::renderer
