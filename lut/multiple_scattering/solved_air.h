// SPDX-License-Identifier: MIT
// A medium with its solution: everything that lights ground, other media and air in it by a
// distant source. Sun and moon have the same solution, because all values are per unit irradiance
// above the air.
//
//   single_scattering     transmittance and light scattered once, for any ray
//   beam                  direct light of a disk, along refracted rays
//   multiple_scattering   light scattered more than once and light of the sky on surfaces, with the
//                         forward peak of the aerosol
//
// Programs solve a medium once and pass this type to whatever is lit. Copies share the solution.
#pragma once

#include <memory>

#include "atmosphere/medium/medium.h"
#include "atmosphere/ray/single_scattering.h"
#include "atmosphere/refraction/refracted_view.h"
#include "lut/layer.h"
#include "lut/multiple_scattering/multiple_scattering.h"

namespace alpenglow::lut {

/// Accuracy of a solution. A draft takes a third of the time; irradiance from its sky is accurate
/// to 3 % by day and 6 % in twilight.
enum class AirSolution { kDraft, kFull };

/// Immutable, safe to share between threads.
class SolvedAir {
 public:
  /// Solves the medium: in full with OptionsFor(medium). Throws InputError for a medium that
  /// Validate rejects.
  explicit SolvedAir(const Medium& medium, AirSolution solution = AirSolution::kFull);
  /// Takes a full solution, whose parts must belong to one medium.
  SolvedAir(SingleScattering<float> single_scattering, RefractedBeam beam,
            MultipleScattering multiple_scattering);

  /// Returns this solution over another place: rays run on the sphere that osculates the ellipsoid
  /// there (OnOsculatingSphere). Beam and multiple scattering stay those of the first sphere.
  [[nodiscard]] SolvedAir OnSphereAt(double latitude_rad) const;

  [[nodiscard]] const Medium& medium() const { return single_scattering_->medium(); }
  [[nodiscard]] std::size_t bands() const { return single_scattering_->bands(); }
  [[nodiscard]] AirSolution solution() const { return solution_; }
  [[nodiscard]] const SingleScattering<float>& single_scattering() const {
    return *single_scattering_;
  }
  [[nodiscard]] const RefractedBeam& beam() const { return *beam_; }
  [[nodiscard]] const MultipleScattering& multiple_scattering() const {
    return *multiple_scattering_;
  }

  /// Returns the irradiance perpendicular to the beams of a disk whose irradiance above the air is
  /// 1.
  /// @param mu  see RefractedBeam::Left.
  [[nodiscard]] Spectrum BeamLeft(double altitude_m, double mu) const {
    return beam_->Left(*single_scattering_, altitude_m, mu);
  }

 private:
  AirSolution solution_ = AirSolution::kFull;
  std::shared_ptr<const SingleScattering<float>> single_scattering_;
  std::shared_ptr<const RefractedBeam> beam_;
  std::shared_ptr<const MultipleScattering> multiple_scattering_;
};

}  // namespace alpenglow::lut
