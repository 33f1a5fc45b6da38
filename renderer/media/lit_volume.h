// SPDX-License-Identifier: MIT
// The light that a body (LocalBody), here also called a volume, scatters once, and that it emits.
//
// Sunlight arrives through the air (RefractedBeam), the terrain's shadow, and every medium on its
// path. Skylight is given by its moments (MultipleScattering) and the phase function, and attenuated
// by the mean transmittance of the bodies over 26 directions. Light that a volume scatters again is
// neglected. Columns towards the sun through a volume with Samples() are taken from a grid of at
// most 64 samples per side; the error is 2 % of the sun's light in turbulent smoke with as many
// samples itself.
//
// The eight lamps of the scene that are brightest at a volume light it, through the air around lamps
// and bodies (optical depths are from a grid of at most 24 samples per side), shadowed by terrain.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "renderer/illumination/sky_moments.h"
#include "renderer/media/lit_medium.h"
#include "renderer/media/local_body.h"

namespace alpenglow::renderer {

class LitVolume final : public LitMedium {
 public:
  /// Refers to both.
  LitVolume(const LocalBody& volume, const MediaSources& sources);

  [[nodiscard]] std::unique_ptr<const MediumOnRay> OnRay(
      const glm::dvec3& direction) const override;
  /// A lamp's light varies on the scale of its distance from the ray, so panels end there.
  void AddCuts(const glm::dvec3& origin, const glm::dvec3& direction,
               std::vector<double>& cuts_m) const override;
  /// Inside a volume with Samples(), the depth towards the centre of the disk is that of
  /// sun_column_.
  void AddDepthToLight(const glm::dvec3& point, const glm::dvec3& to_disk,
                       SpectrumOf<double>& depth) const override;

 private:
  class OnOneRay;
  /// A lamp that lights the volume.
  struct VolumeLamp {
    std::uint32_t number;
    std::vector<VolumeGrid> depth;  // [band] of the path; see LampOf
  };

  [[nodiscard]] SkyMoments Sky() const;
  [[nodiscard]] std::optional<VolumeGrid> SunColumns() const;
  [[nodiscard]] std::vector<VolumeGrid> SkyLeft(const SkyMoments& sky) const;
  [[nodiscard]] std::vector<VolumeLamp> Lamps() const;
  /// The depth excludes the volume itself if it has no Samples(): its column is then exact.
  [[nodiscard]] VolumeLamp LampOf(std::uint32_t number) const;
  /// Adds the light of a lamp that the volume scatters along a direction.
  void AddLamp(const VolumeLamp& seen, const glm::dvec3& point, const glm::dvec3& direction,
               double density, Spectrum& sum) const;

  const LocalBody& volume_;
  const MediaSources& sources_;
  Spectrum scattering_per_m_, emission_per_m_;
  std::vector<double> chi_;
  SkyMoments sky_;
  std::optional<VolumeGrid> sun_column_;  // [m], of volumes with Samples()
  std::vector<VolumeGrid> sky_left_;      // [band]
  std::vector<VolumeLamp> lamps_;
};

}  // namespace alpenglow::renderer
