// SPDX-License-Identifier: MIT
// Optical depths from any point to a sun of any elevation: by the map of cloud_sun_map.h for a sun
// from 3 degrees on, and over a round planet for a lower one. There, a periodic field has the map of
// cloud_low_sun_map.h, and in an open field, which beams leave soon, each is followed. Light that no
// cloud sees has no map and casts no shadows.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <variant>

#include "renderer/cloud_light/cloud_low_sun.h"
#include "renderer/cloud_light/cloud_low_sun_map.h"
#include "renderer/cloud_light/cloud_sun_map.h"
#include "renderer/clouds/cloud_field.h"

namespace alpenglow::renderer {

/// Returns whether a sun has the beams of cloud_low_sun.h: below kLowestCloudSun_deg.
[[nodiscard]] bool IsLowCloudSun(const glm::dvec3& to_sun);

/// Optical depths to a sun of any elevation from kLowestCloudLight_deg on. Immutable; safe to use from
/// many threads. The field must outlive it.
class CloudSunDepths {
 public:
  /// Throws the InputErrors of both maps and CloudLowSun.
  CloudSunDepths(const CloudField& field, const glm::dvec3& to_sun,
                 const CloudSunMapOptions& map_options = {},
                 const CloudLowSunOptions& low_options = {},
                 const CloudLowSunMapOptions& low_map_options = {});
  /// Makes depths without a sun.
  explicit CloudSunDepths(const CloudField& field) : field_(&field) {}

  [[nodiscard]] const CloudField& field() const { return *field_; }
  /// Returns whether there is no sun.
  [[nodiscard]] bool IsUnlit() const { return std::holds_alternative<Unlit>(sun_); }
  /// Returns the map of a high or of a low sun; null if the other has the depths, or none.
  [[nodiscard]] const CloudSunMap* map() const { return std::get_if<CloudSunMap>(&sun_); }
  [[nodiscard]] const CloudLowSunMap* low_map() const { return std::get_if<CloudLowSunMap>(&sun_); }
  /// Returns the beams of a low sun; null for a high one and without one.
  [[nodiscard]] const CloudLowSun* low_sun() const {
    return low_map() ? &low_map()->sun() : nullptr;
  }
  /// Returns the unit vector to the sun, over the place of a low one; the vertical without one.
  [[nodiscard]] const glm::dvec3& to_sun() const;
  /// Returns the unit vector to the sun at a point: over a round planet for a low one.
  [[nodiscard]] glm::dvec3 ToSunAt(const glm::dvec3& point) const {
    return low_sun() ? low_sun()->ToSunAt(point) : to_sun();
  }
  /// Returns the optical depth from a point in a cloud to the sun; without one so much that no light is
  /// left.
  [[nodiscard]] double OpticalDepth(const glm::dvec3& point) const;
  /// Returns the transmittance for points in clear air and on the ground; 1 without a sun.
  [[nodiscard]] double Transmittance(const glm::dvec3& point) const;
  /// Returns the same as a mean around a point.
  [[nodiscard]] double TransmittanceAround(const glm::dvec3& point) const;
  /// Returns the mean transmittance from a plane below or above the field to the sun: that of the
  /// map, or of 4096 beams over the place of a low sun, whose standard error is 0.008 at most. Beams
  /// without a sun are vertical.
  [[nodiscard]] double MeanTransmittance(double altitude_m) const;
  /// Returns the same from the base of the field.
  [[nodiscard]] double MeanTransmittance() const {
    return MeanTransmittance(field_->base_altitude_m());
  }
  /// Returns the mean of a power of the transmittance from 4096 places of a plane.
  /// @param exponent  > 0: the factor on optical depths of a scaled medium.
  [[nodiscard]] double MeanPowerOfTransmittance(double altitude_m, double exponent) const;
  /// Returns the memory of the map [bytes].
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Unlit {};
  /// Returns the transmittance of a beam, over the place of a low sun.
  [[nodiscard]] double BeamLeft(const glm::dvec3& point) const;

  const CloudField* field_;
  std::variant<Unlit, CloudSunMap, CloudLowSunMap> sun_;
};

}  // namespace alpenglow::renderer
