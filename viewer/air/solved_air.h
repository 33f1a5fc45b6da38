// SPDX-License-Identifier: MIT
// Provides SolvedAir, a medium with all data that the tables of the viewer are computed from,
// AirChoice, the changes of a medium by the user (visibility, aerosol, ozone, ground), and the
// light sources of a sky.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "atmosphere/medium/medium.h"
#include "viewer/air/air_tables.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

enum class LightSource : std::size_t { kSun, kMoon };
inline constexpr std::size_t kLightSources = 2;

[[nodiscard]] constexpr std::size_t IndexOf(LightSource source) {
  return static_cast<std::size_t>(source);
}
[[nodiscard]] constexpr LightSource OtherThan(LightSource source) {
  return source == LightSource::kSun ? LightSource::kMoon : LightSource::kSun;
}

/// Changes of a medium; unset values keep those of the medium.
struct AirChoice {
  double aerosol = 1.0;                 // factor on the aerosol of the medium, [0, 1000]
  std::optional<double> ozone_du;       // of the whole column, [0, 10000]
  std::optional<double> ground_albedo;  // [0, 1], in all bands
};

/// Returns the changed medium. Throws InputError that names the value out of range.
[[nodiscard]] Medium Changed(Medium medium, const AirChoice& choice);

/// Returns Koschmieder's visibility at altitude 0 in the band nearest to 550 nm [m]; infinite in a
/// vacuum.
[[nodiscard]] double VisibilityOf(const Medium& medium);
/// Returns Koschmieder's visibility at an altitude [m], from the extinction of molecules and
/// aerosol there and of fog.
/// @param more_per_m  extinction of fog [1/m].
[[nodiscard]] double VisibilityAt(const Medium& medium, double altitude_m, double more_per_m);
/// Returns AirChoice::aerosol for a visibility [m]: 0 where molecules alone already reduce it
/// further, 1000 at most.
[[nodiscard]] double AerosolForVisibility(const Medium& medium, double visibility_m);
/// Returns the ozone of the column in Dobson units, from the band that absorbs most; 0 without
/// ozone.
[[nodiscard]] double OzoneDobson(const Medium& medium);

/// Accuracy of a solution. A draft takes a third of the time; irradiance from its sky is accurate
/// to 3 % by day and 6 % in twilight.
enum class AirSolution { kDraft, kFull };

/// A solved medium. It is immutable and can be shared between threads.
struct SolvedAir {
  Medium medium;
  AirSolution solution;
  RefractedBeam beam;
  MultipleScattering multiple_scattering;
  MediumTables tables;
};

/// Solves the medium on the calling thread alone, so that drawing keeps the other processors.
/// Throws InputError for a medium that Validate rejects or that has more than four bands.
[[nodiscard]] std::shared_ptr<const SolvedAir> SolveAir(const Medium& medium,
                                                        AirSolution solution = AirSolution::kFull);

}  // namespace alpenglow::viewer
