// SPDX-License-Identifier: MIT
// The light of a plume by VolumeOrders and by single scattering, along rays from six sides, beside
// that of traced paths. The whole light and its errors are those of cloud_views.h.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <glm/vec3.hpp>
#include <vector>

#include "renderer/cloud_light/cloud_light.h"
#include "renderer/cloud_light/cloud_path_tracer.h"
#include "renderer/media/local_media.h"
#include "renderer/media/volume_orders.h"
#include "renderer/report/cloud_views.h"
#include "renderer/report/plume.h"

namespace alpenglow::renderer {

/// A side from which parallel rays look at a plume.
struct PlumeView {
  const char* name;
  glm::dvec3 from;  // unit
};

/// Returns six views: from the side of the sun, from the opposite side, from both sides across, from
/// above and from below.
inline constexpr std::size_t kPlumeViews = 6;
[[nodiscard]] std::array<PlumeView, kPlumeViews> PlumeViewsOf(const glm::dvec3& to_sun);

/// Returns parallel rays of a view, side x side of them over the plume, from the top left.
[[nodiscard]] std::vector<CloudRay> PlumeRaster(const PlumeView& view, int side);

/// A ray, and its light by traced paths.
struct PlumeRay {
  std::size_t view;
  CloudRay ray;
  CloudRadiance traced;
};

/// Returns the rays of all views that the plume dims by a tenth or more, as in CloudPixelsOf, without
/// their light.
[[nodiscard]] std::vector<PlumeRay> PlumeRaysOf(const Plume& plume, const glm::dvec3& to_sun,
                                                int side);

/// Returns the path tracer of a plume. Refers to the plume.
[[nodiscard]] CloudPathTracer PlumeTracer(const Plume& plume, const glm::dvec3& to_sun);

/// Returns the rays of PlumeRaysOf with their light.
[[nodiscard]] std::vector<PlumeRay> TracedPlume(const Plume& plume, const glm::dvec3& to_sun,
                                                std::size_t paths, int side);

/// The light of a plume of all orders, for unit sources. Refers to the plume.
class PlumeOrders {
 public:
  PlumeOrders(const Plume& plume, const glm::dvec3& to_sun, double most_cells);
  PlumeOrders(const PlumeOrders&) = delete;
  PlumeOrders& operator=(const PlumeOrders&) = delete;

  /// Returns the parts of the light of a ray.
  [[nodiscard]] CloudRayLight Along(const CloudRay& ray) const;
  /// Returns the whole light in one integration, as pictures do.
  [[nodiscard]] double WholeAlong(const CloudRay& ray) const;

  [[nodiscard]] std::size_t bytes() const { return sky_.bytes() + ground_.bytes(); }

 private:
  /// Returns unit sources: the sun, and the sky above or the ground below.
  [[nodiscard]] VolumeIllumination Light(bool is_sky) const;
  [[nodiscard]] double ColumnToSun(const glm::dvec3& point) const;
  /// Light that is scattered at a place into a direction of view, per unit of scaled extinction.
  using PlumeSource =
      std::function<double(const VolumeOrders::Place& place, const VolumeOrders::Look& look)>;
  /// Integrates a source. Returns the integral as the light of the sun, with the transmittances.
  [[nodiscard]] CloudRayLight Integrated(const CloudRay& ray, const PlumeSource& scattered) const;

  const Plume& plume_;
  glm::dvec3 to_sun_;
  VolumeOrders sky_, ground_;
  LocalMedia media_;
};

/// Returns the sun's light of the first order alone.
[[nodiscard]] CloudRayLight FirstOrderOfPlume(const Plume& plume, const glm::dvec3& to_sun,
                                              const CloudRay& ray);

struct PlumeErrors {
  CloudErrors sun, sky, whole;
};

/// @param light  returns the light of a ray.
[[nodiscard]] PlumeErrors ErrorsOfPlume(const std::vector<PlumeRay>& traced,
                                        const std::function<CloudRayLight(const CloudRay&)>& light);

}  // namespace alpenglow::renderer
