// SPDX-License-Identifier: MIT
#include "lut/multiple_scattering/solved_air.h"

#include <utility>

namespace alpenglow::lut {
namespace {

MultipleScatteringOptions OptionsOf(const Medium& medium, AirSolution solution) {
  constexpr MultipleScatteringOptions kDraft{
      .altitudes = 12, .sun_angles = 24, .zenith_nodes = 8, .azimuth_nodes = 5, .ray_nodes = 6};
  return solution == AirSolution::kDraft ? RaisedFor(medium, kDraft) : OptionsFor(medium);
}

}  // namespace

SolvedAir::SolvedAir(const Medium& medium, AirSolution solution)
    : SolvedAir(SingleScattering<float>(medium), RefractedBeam(medium),
                MultipleScattering(medium, OptionsOf(medium, solution))) {
  solution_ = solution;
}

SolvedAir::SolvedAir(SingleScattering<float> single_scattering, RefractedBeam beam,
                     MultipleScattering multiple_scattering)
    : single_scattering_(
          std::make_shared<const SingleScattering<float>>(std::move(single_scattering))),
      beam_(std::make_shared<const RefractedBeam>(std::move(beam))),
      multiple_scattering_(
          std::make_shared<const MultipleScattering>(std::move(multiple_scattering))) {}

SolvedAir SolvedAir::OnSphereAt(double latitude_rad) const {
  SolvedAir there = *this;
  there.single_scattering_ =
      std::make_shared<const SingleScattering<float>>(OnOsculatingSphere(medium(), latitude_rad));
  return there;
}

}  // namespace alpenglow::lut
