// SPDX-License-Identifier: MIT
// This header provides the local media of a scene, its volumes and its fog, with their densities
// and optical properties.
//
//   sigma_t = sum over bodies of density(p) extinction,      sigma_s = extinction albedo
//
// Overlapping bodies add up.
//
// The density of fog over the whole scene is exp(-(h - base) / H) above the sphere, and 1
// throughout if H is infinite. It is 0 above the top of the atmosphere.
//
// This header also provides the functions of the shared text fog_layer.glsl in C++.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <variant>
#include <vector>

#include "atmosphere/lamp/lamp.h"
#include "atmosphere/ray/ray.h"
#include "atmosphere/ray/shell.h"
#include "renderer/scene/local_volume.h"
#include "renderer/scene/scene.h"
#include "renderer/surface/scene_ground.h"

namespace alpenglow::shared {
// clang-format off
#include "atmosphere/shared_glsl/shared_begin.h"
#include "renderer/media/fog_layer.glsl"
#include "atmosphere/shared_glsl/shared_end.h"
// clang-format on
}  // namespace alpenglow::shared

namespace alpenglow::renderer {

/// A fog layer of exponential density. Immutable. Directions are unit vectors in the frame of
/// SceneGround, whose sphere has its centre at (0, 0, -R).
class FogLayer {
 public:
  /// @param scale_height_m  > 0; may be infinite.
  /// @param top_m  of the atmosphere above the sphere.
  FogLayer(double base_m, double scale_height_m, double planet_radius_m, double top_m);

  [[nodiscard]] double base_m() const { return base_m_; }
  [[nodiscard]] double scale_height_m() const { return scale_height_m_; }

  [[nodiscard]] double AltitudeOf(const glm::dvec3& point) const;
  [[nodiscard]] double DensityAtAltitude(double altitude_m) const;
  [[nodiscard]] double DensityAt(const glm::dvec3& point) const {
    return DensityAtAltitude(AltitudeOf(point));
  }

  /// Returns the pieces of a line within [0, length_m] where the density may exceed 1e-9, in order.
  /// If the lowest point of the line is among them, it is the end of one piece and the start of the
  /// next.
  [[nodiscard]] std::vector<DensePiece> PiecesAlong(const glm::dvec3& origin,
                                                    const glm::dvec3& direction,
                                                    double length_m) const;

  /// Returns the integral of the density from an altitude vertically to space [m].
  [[nodiscard]] double ColumnAbove(double altitude_m) const;
  /// Returns the column along a direction that does not meet the planet. Relative error below 1e-6.
  [[nodiscard]] double ColumnToSpace(const glm::dvec3& point, const glm::dvec3& direction) const;

 private:
  double base_m_, scale_height_m_, planet_radius_m_, top_m_;
  double thin_m_;  // density is below 1e-9 above this altitude
};

/// Optical properties at density 1, band by band.
struct MediumOptics {
  Bands<double> extinction_per_m;
  Bands<double> scattering_per_m;
  Bands<double> emission_per_m;  // W m^-2 sr^-1 nm^-1 per metre
  PhaseFunction phase;
};

/// A body of air and its optical properties.
struct LocalMedium {
  std::variant<LocalVolume, FogLayer> body;
  MediumOptics optics;

  [[nodiscard]] const FogLayer* fog() const { return std::get_if<FogLayer>(&body); }
  [[nodiscard]] const LocalVolume* volume() const { return std::get_if<LocalVolume>(&body); }
  [[nodiscard]] double DensityAt(const glm::dvec3& point) const;
  [[nodiscard]] std::vector<DensePiece> PiecesAlong(const glm::dvec3& origin,
                                                    const glm::dvec3& direction,
                                                    double length_m) const;
  /// Returns the integral of the density along a direction to its end [m].
  [[nodiscard]] double ColumnTowards(const glm::dvec3& point, const glm::dvec3& direction) const;
};

/// All local media of a scene. Immutable; safe to use from many threads.
class LocalMedia {
 public:
  /// Reads the grids of volumes. Throws InputError "volume N: ..." for grids that cannot be read.
  /// Fog that lies wholly below the ground is left out.
  LocalMedia(const Scene& scene, const SceneGround& ground, const Medium& medium);
  /// Takes any bodies, each of `bands` bands. Fog must be the last one; its ground is at its base.
  LocalMedia(std::vector<LocalMedium> all, std::size_t bands);
  /// Returns a subset: with or without the volumes, with or without the fog.
  [[nodiscard]] LocalMedia Only(bool volumes, bool fog) const;

  /// Returns the same media without emission.
  [[nodiscard]] LocalMedia WithoutGlow() const;

  [[nodiscard]] bool IsNothing() const { return all_.empty(); }
  [[nodiscard]] bool HasVolumes() const {
    return !all_.empty() && all_.front().volume() != nullptr;
  }
  [[nodiscard]] std::size_t bands() const { return bands_; }
  [[nodiscard]] const std::vector<LocalMedium>& all() const { return all_; }
  [[nodiscard]] const LocalMedium* fog() const {
    return !all_.empty() && all_.back().fog() != nullptr ? &all_.back() : nullptr;
  }

  /// Altitude of the ground below the fog: its base, or the lowest ground if that is higher.
  [[nodiscard]] double fog_bottom_m() const { return fog_bottom_m_; }

  /// Returns the optical depth of all media from a point along a direction to its end.
  [[nodiscard]] Bands<double> OpticalDepthTowards(const glm::dvec3& point,
                                                  const glm::dvec3& direction) const;

 private:
  std::vector<LocalMedium> all_;
  std::size_t bands_;
  double fog_bottom_m_ = 0.0;
};

}  // namespace alpenglow::renderer
