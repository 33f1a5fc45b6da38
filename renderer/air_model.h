// SPDX-License-Identifier: MIT
// The air of a scene, solved, whole and without some of its parts.
#pragma once

#include <map>
#include <memory>
#include <mutex>

#include "atmosphere/single_scattering.h"
#include "lut/multiple_scattering.h"
#include "renderer/aerial_perspective.h"
#include "renderer/effects.h"
#include "renderer/ground_light.h"

namespace alpenglow {

/// Air and what its light reaches. Refers to ground, geometry, lamps and
/// horizons.
struct AirModel {
  AirModel(const Medium& medium, const SceneGround& ground, const SceneGeometry& geometry,
           const LampLight& lamps, const HorizonsOnDemand& horizons)
      : air(medium),
        diffuse(medium),
        aerial(air, diffuse),
        ground_light(ground, geometry, air, diffuse, lamps, horizons) {}

  AirIntegrator<float> air;
  DiffuseLight diffuse;
  AerialPerspective aerial;
  GroundLight ground_light;
};

/// Safe to share between threads. Air that lacks a part is solved when it is first asked for. The
/// air in front of lamps has all parts always.
class AirModels {
 public:
  AirModels(const Medium& medium, const SceneGround& ground, const SceneGeometry& geometry,
            const LampLight& lamps, const HorizonsOnDemand& horizons)
      : ground_(ground),
        geometry_(geometry),
        lamps_(lamps),
        horizons_(horizons),
        whole_(medium, ground, geometry, lamps, horizons) {}

  [[nodiscard]] const AirModel& whole() const { return whole_; }
  /// With those of molecules, aerosol and ozone that are among the effects.
  [[nodiscard]] const AirModel& With(EffectSet effects) const;

 private:
  const SceneGround& ground_;
  const SceneGeometry& geometry_;
  const LampLight& lamps_;
  const HorizonsOnDemand& horizons_;
  AirModel whole_;
  mutable std::mutex mutex_;
  mutable std::map<EffectSet, std::unique_ptr<AirModel>> partial_;
};

}  // namespace alpenglow
