// SPDX-License-Identifier: MIT
// What stands in a scene's air: its volumes, and its fog; what each does to light.
//
//   sigma_t = sum over bodies of density(p) extinction,      sigma_s = extinction albedo
//
// Bodies that overlap add up.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <variant>
#include <vector>

#include "atmosphere/ray/ray_samples.h"
#include "renderer/ground/scene_ground.h"
#include "renderer/media/fog_layer.h"
#include "renderer/scene/local_volume.h"
#include "renderer/scene/scene.h"

namespace alpenglow::renderer {

/// What density 1 does, band by band.
struct MediumOptics {
  Bands<double> extinction_per_m;
  Bands<double> scattering_per_m;
  Bands<double> emission_per_m;  // W m^-2 sr^-1 nm^-1 a metre
  PhaseFunction phase;
};

/// A body of air and its optics.
struct LocalMedium {
  std::variant<LocalVolume, FogLayer> body;
  MediumOptics optics;

  [[nodiscard]] const FogLayer* fog() const { return std::get_if<FogLayer>(&body); }
  [[nodiscard]] const LocalVolume* volume() const { return std::get_if<LocalVolume>(&body); }
  [[nodiscard]] double DensityAt(const glm::dvec3& point) const;
  [[nodiscard]] std::vector<DensePiece> PiecesAlong(const glm::dvec3& origin,
                                                    const glm::dvec3& direction,
                                                    double length_m) const;
  /// Integral of the density towards a direction, to its end [m].
  [[nodiscard]] double ColumnTowards(const glm::dvec3& point, const glm::dvec3& direction) const;
};

/// Immutable; safe to ask from many threads.
class LocalMedia {
 public:
  /// Reads the grids of volumes. Throws InputError "volume N: ..." for those that cannot be read.
  LocalMedia(const Scene& scene, const SceneGround& ground, const Medium& medium);
  /// Any bodies, each of `bands` bands; fog, if there is any, last, over ground at its base.
  LocalMedia(std::vector<LocalMedium> all, std::size_t bands);
  /// Some of them: the volumes or none, the fog or none.
  [[nodiscard]] LocalMedia Only(bool volumes, bool fog) const;

  /// The same without light of their own.
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

  /// Altitude of the ground under the fog: its base, or the lowest ground if that is higher.
  [[nodiscard]] double fog_bottom_m() const { return fog_bottom_m_; }

  /// Of everything that stands between a point and the end of a direction.
  [[nodiscard]] Bands<double> OpticalDepthTowards(const glm::dvec3& point,
                                                  const glm::dvec3& direction) const;

 private:
  std::vector<LocalMedium> all_;
  std::size_t bands_;
  double fog_bottom_m_ = 0.0;
};

}  // namespace alpenglow::renderer
