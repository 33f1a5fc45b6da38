// SPDX-License-Identifier: MIT
// Light in a field of clouds: what a picture needs along a ray, by the fast method, the hybrid one
// (cloud_hybrid.h) or paths alone.
//
// Scattered light has three sources, which are kept apart, because a picture gives each its own
// colour: the sun, a uniform sky above and a uniform ground below. The radiance along a ray is
//
//   L = E sun + L_sky sky + L_ground ground + T L_behind
//
// where E is the irradiance across the sun's beam and T the transmittance for what is behind: that
// of narrow sources (sun, stars, edges of land), or the scaled one of wide ones (sky, haze), which
// has the light that droplets turn by a few degrees. For droplets that absorb nothing uniform light
// from all sides is an equilibrium, so that the part of the ground is that of the rest.
//
// In the fast method light of first collisions and of the forward peak is in closed form, with the
// extinction of voxels (cloud_gather.h). Light of higher orders comes from moments on cells of 40 or 80 m
// (cloud_moments.h), times a factor that is fitted to traced paths (cloud_factor.h). A field that is
// the same at every place has the light of a plane-parallel layer instead (plane_parallel_light.h).
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/cloud_light/cloud_factor.h"
#include "renderer/cloud_light/cloud_gather.h"
#include "renderer/cloud_light/cloud_hybrid.h"
#include "renderer/cloud_light/cloud_moments.h"
#include "renderer/cloud_light/cloud_optics.h"
#include "renderer/cloud_light/cloud_path_tracer.h"
#include "renderer/cloud_light/cloud_sun_depths.h"
#include "renderer/clouds/cloud_field.h"

namespace alpenglow::renderer {

class PlaneParallelCloud;

/// The method by which light of sun, sky and ground is found along a ray: the moments alone, paths that
/// end in them, or paths alone. Paths have noise, which the mean over the rays of a pixel reduces. The
/// hybrid method fits a factor of its own, for light that paths see after their collisions.
enum class CloudLightMethod { kFast, kHybrid, kTraced };

[[nodiscard]] std::vector<std::string> CloudLightMethodNames();
/// Throws InputError for other names.
[[nodiscard]] CloudLightMethod CloudLightMethodFromName(std::string_view name);
[[nodiscard]] std::string NameOf(CloudLightMethod method);

struct CloudLightOptions {
  CloudMomentOptions moments = {};
  CloudSunMapOptions sun_map = {};
  CloudLowSunOptions low_sun = {};
  CloudFactorOptions factor = {};
  CloudGatherOptions gather = {};
  CloudLightMethod method = CloudLightMethod::kFast;
  CloudHybridOptions paths = {};  // of kHybrid; kTraced takes only their number
};

/// Light that clouds scatter into a ray, and what they leave of the light behind it.
struct CloudRayLight {
  double sun = 0.0;     // for unit irradiance across the beam [1/sr]; with the sunlit ground's
  double sky = 0.0;     // for unit radiance from all directions above; with the ground's
  double ground = 0.0;  // for a ground that emits unit radiance beside what it reflects
  double transmittance = 1.0;         // of narrow sources behind
  double scaled_transmittance = 1.0;  // of wide sources behind
  /// Distance of the clouds, weighted by the light that they scatter into the ray; 0 if there are
  /// none.
  double mean_distance_m = 0.0;
  OnceScattered once{};  // sunlight of first order by the fast method, for its colours
};

/// Light of one ray by the fast method, and by the method of choice.
struct CloudRayLights {
  CloudRayLight fast, chosen;
};

/// Mean irradiances of level ground, with light that goes to and fro between it and clouds.
struct CloudGroundIrradiance {
  double direct = 0.0;   // of the sun's beam, for unit irradiance across it
  double diffuse = 0.0;  // of sunlight from clouds, likewise
  double sky = 0.0;      // for unit radiance of the sky
  double ground = 0.0;   // for a ground that emits unit radiance, without its own emission
};

/// Irradiance of level ground at a place relative to the means of CloudGroundIrradiance, without light
/// that goes to and fro.
struct CloudGroundDifference {
  double sun = 0.0;  // of sunlight from clouds, for unit irradiance across the beam
  double sky = 0.0;  // for unit radiance of the sky
};

/// The light of a field under one sun. Immutable; safe to use from many threads. Copies share
/// their tables. The field must outlive it.
class CloudLight {
 public:
  /// Solves for the light of sun, sky and ground, with as many threads as are free; the result does
  /// not depend on their number. Throws InputError of CloudSunDepths, CloudPathTracer and for options
  /// out of range.
  CloudLight(const CloudField& field, const CloudScatterers& scatterers,
             const CloudSurroundings& surroundings, const CloudLightOptions& options = {});

  /// Solves only for the light of sky and ground: there is no sunlight. Throws InputError likewise.
  /// @param surroundings  with any direction to the sun.
  [[nodiscard]] static CloudLight Unlit(const CloudField& field, const CloudScatterers& scatterers,
                                        const CloudSurroundings& surroundings,
                                        const CloudLightOptions& options = {});

  /// Returns the light of the same field under another sun, or under none. It shares the light of sky
  /// and ground.
  [[nodiscard]] CloudLight WithSun(const std::optional<glm::dvec3>& to_sun) const;

  /// Returns the light of the same solution by another method. It shares all tables. Throws InputError
  /// for a number of paths out of range.
  /// @param paths  of a ray; nothing: that of the options.
  [[nodiscard]] CloudLight WithMethod(CloudLightMethod method,
                                      std::optional<int> paths = std::nullopt) const;

  /// Returns the light along a ray. The ground below reflects its mean irradiance; the ground and
  /// the sky behind the clouds are not included. Transmittances and the distance are those of the
  /// fast method. Random numbers depend on the ray alone, so that the same ray has the same light.
  /// @param length_m  of the ray, >= 0; may be infinite.
  [[nodiscard]] CloudRayLight Radiance(
      const CloudRay& ray, double length_m = std::numeric_limits<double>::infinity()) const {
    return RadianceByBoth(ray, length_m).chosen;
  }
  /// Returns the same beside that of the fast method.
  [[nodiscard]] CloudRayLights RadianceByBoth(const CloudRay& ray, double length_m) const;

  /// Returns the transmittance of clouds from a point in clear air or on the ground to the sun.
  [[nodiscard]] double SunTransmittance(const glm::dvec3& point) const {
    return sun().Transmittance(point);
  }

  /// Returns the mean irradiances of the ground below a periodic field; below an open one those
  /// without clouds.
  [[nodiscard]] const CloudGroundIrradiance& ground_irradiance() const;
  /// Returns the difference of the diffuse light of level ground from its mean, below a point of a
  /// periodic field; 0 for an open one. Light of the forward peak has its mean everywhere: droplets
  /// turn it several times, and it follows the shadows of beams only by a tenth. On ground 120 m below
  /// spheres the light is within 20 % (root mean square) of traced paths, the mean alone within 29 %.
  /// @param point  in the frame of the field. Its light is that of the ground at
  ///     CloudSurroundings::ground_altitude_m below or above it.
  [[nodiscard]] CloudGroundDifference GroundDifferenceAt(const glm::dvec3& point) const;
  [[nodiscard]] const CloudField& field() const;
  [[nodiscard]] const CloudOptics& optics() const;
  /// Returns the layer of a field that is the same at every place; null for others.
  [[nodiscard]] const PlaneParallelCloud* plane_parallel() const;
  [[nodiscard]] const CloudSunDepths& sun() const;
  [[nodiscard]] const CloudFactor& factor() const;
  [[nodiscard]] double ground_albedo() const;
  /// Returns the solution for the sun.
  [[nodiscard]] const SolvedCloudMoments& sun_moments() const;
  /// Returns the solution for the sky, of which that for the ground follows.
  [[nodiscard]] const SolvedCloudMoments& sky_moments() const;
  /// Returns the memory of all tables [bytes], without the field.
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct FieldLight;
  struct SunLight;
  CloudLight() = default;

  std::shared_ptr<const FieldLight> field_light_;
  std::shared_ptr<const SunLight> sun_light_;
  CloudLightMethod method_ = CloudLightMethod::kFast;
  std::shared_ptr<const CloudHybrid> paths_;  // refers to both solutions
};

}  // namespace alpenglow::renderer
