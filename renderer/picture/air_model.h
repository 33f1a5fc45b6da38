// SPDX-License-Identifier: MIT
// The air of a scene, solved, whole and without some of its parts.
#pragma once

#include <map>
#include <memory>
#include <mutex>

#include "atmosphere/ray/bent_beam.h"
#include "atmosphere/ray/single_scattering.h"
#include "lut/diffuse/multiple_scattering.h"
#include "renderer/effect/effects.h"
#include "renderer/light/aerial_perspective.h"
#include "renderer/picture/ground_light.h"

namespace alpenglow::renderer {

/// Air and what its light reaches, of all orders as hazy and thick air needs it (OptionsFor). Refers to the parts of the ground.
struct AirModel {
  AirModel(const Medium& medium, const GroundParts& parts)
      : air(medium),
        beam(medium),
        diffuse(medium, OptionsFor(medium)),
        aerial(air, diffuse),
        ground_light(parts, sunlit()) {}
  AirModel(const AirModel&) = delete;
  AirModel& operator=(const AirModel&) = delete;

  [[nodiscard]] SunlitAir sunlit() const { return {air, beam, diffuse}; }

  AirIntegrator<float> air;
  BentBeam beam;
  DiffuseLight diffuse;
  AerialPerspective aerial;
  GroundLight ground_light;
};

/// Safe to share between threads. Air that lacks a part is solved when it is first asked for. The
/// air in front of lamps has all parts always.
class AirModels {
 public:
  AirModels(const Medium& medium, const GroundParts& parts)
      : parts_(parts), whole_(medium, parts) {}

  [[nodiscard]] const AirModel& whole() const { return whole_; }
  /// With those of molecules, aerosol and ozone that are among the effects.
  [[nodiscard]] const AirModel& With(EffectSet effects) const;

 private:
  GroundParts parts_;
  AirModel whole_;
  mutable std::mutex mutex_;
  mutable std::map<EffectSet, std::unique_ptr<AirModel>> partial_;
};

}  // namespace alpenglow::renderer
