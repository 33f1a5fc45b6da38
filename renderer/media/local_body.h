// SPDX-License-Identifier: MIT
// A bounded medium: a box or an ellipsoid with a density in it (LocalBody). A new body is a subclass
// with a density and its column; its light is that of every body (lit_volume.h).
//
// A body is flat: the planet's curvature below it is ignored (over 2 km, 0.1 m).
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>

#include "renderer/media/local_medium.h"
#include "renderer/scene/scene.h"
#include "renderer/scene/volume_grid.h"
#include "renderer/surface/scene_ground.h"

namespace alpenglow::renderer {

/// An interval of a line, as distances along it [m].
struct LineSpan {
  double begin_m, end_m;
};

/// Scattering and emission at a point of a body, at density 1, band by band.
struct BodyColour {
  SpectrumOf<double> scattering_per_m;
  SpectrumOf<double> emission_per_m;  // W m^-2 sr^-1 nm^-1 per metre
};

/// Immutable; safe to use from many threads. Directions are unit vectors.
class LocalBody : public LocalMedium {
 public:
  LocalBody(const VolumePlacement& placement, MediumOptics optics,
            ScatteringOrders orders = ScatteringOrders::kAll);

  [[nodiscard]] const VolumePlacement& placement() const { return placement_; }
  /// Returns the orders of scattering of which its light is wanted.
  [[nodiscard]] ScatteringOrders orders() const { return orders_; }
  /// Returns the middle of the bounding box.
  [[nodiscard]] glm::dvec3 Middle() const { return FrameFromUnit(glm::dvec3(0.5)); }
  /// Returns the number of samples across, ahead and up that resolve the density. The body's light
  /// is then computed with tables of columns. No value if Column() is in closed form and fast.
  [[nodiscard]] virtual std::optional<std::array<int, 3>> Samples() const { return std::nullopt; }

  /// Returns scattering and emission at a point of a body whose colour varies; optics() are then a
  /// mean of the body. No value if it has the same optics() everywhere.
  [[nodiscard]] virtual std::optional<BodyColour> ColourAt(const glm::dvec3& /*point*/) const {
    return std::nullopt;
  }

  /// Returns the point as fractions of size_m: the box becomes the unit cube.
  [[nodiscard]] glm::dvec3 UnitFromFrame(const glm::dvec3& point) const;
  [[nodiscard]] glm::dvec3 FrameFromUnit(const glm::dvec3& unit) const;
  /// Returns the change of UnitFromFrame along a direction [1/m].
  [[nodiscard]] glm::dvec3 UnitsPerMetre(const glm::dvec3& direction) const;

  [[nodiscard]] bool Contains(const glm::dvec3& point) const;
  /// Returns the interval of a line within [0, length_m] that is inside the body.
  [[nodiscard]] std::optional<LineSpan> SpanAlong(const glm::dvec3& origin,
                                                  const glm::dvec3& direction,
                                                  double length_m) const;

  /// Returns a LitVolume.
  [[nodiscard]] std::unique_ptr<const LitMedium> LitBy(const MediaSources& sources) const override;

 private:
  VolumePlacement placement_;
  ScatteringOrders orders_;
};

/// Returns position and orientation of a body whose underside is at a height over a place, and at a
/// height above the ground on the highest terrain there; without its size.
/// @param heading_rad  of `ahead`, clockwise from north.
[[nodiscard]] VolumePlacement PlacementAt(Place place, const Height& height, double heading_rad,
                                          const SceneGround& ground);

}  // namespace alpenglow::renderer
