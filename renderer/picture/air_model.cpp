// SPDX-License-Identifier: MIT
#include "renderer/picture/air_model.h"

namespace alpenglow::renderer {
namespace {

constexpr EffectSet kParts{Effect::kMolecules, Effect::kAerosol, Effect::kOzone};

Medium OnlyWith(Medium medium, EffectSet parts) {
  const std::vector<double> none(medium.wavelengths_nm.size(), 0.0);
  if (!parts.Has(Effect::kMolecules)) medium.rayleigh_scattering_per_m = none;
  if (!parts.Has(Effect::kAerosol))
    medium.mie_scattering_per_m = medium.mie_extinction_per_m = none;
  if (!parts.Has(Effect::kOzone)) medium.ozone_absorption_per_m = none;
  return medium;
}

}  // namespace

const AirModel& AirModels::With(EffectSet effects) const {
  const EffectSet parts = effects.And(kParts);
  if (parts == kParts) return whole_;
  const std::lock_guard lock(mutex_);
  std::unique_ptr<AirModel>& partial = partial_[parts];
  if (!partial) {
    partial = std::make_unique<AirModel>(OnlyWith(whole_.air.medium(), parts), parts_);
  }
  return *partial;
}

}  // namespace alpenglow::renderer
