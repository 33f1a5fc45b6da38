// SPDX-License-Identifier: MIT
// What lights a sky.
//
// Air as a pilot changes it: visibility, aerosol, ozone, ground.
//
// A medium with all of its light: what every table of the viewer is made from.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "atmosphere/air/medium.h"
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

/// Changes of a medium; what is left out stays.
struct AirChoice {
  double aerosol = 1.0;                 // times as much as the medium has, [0, 1000]
  std::optional<double> ozone_du;       // of the column, [0, 10000]
  std::optional<double> ground_albedo;  // [0, 1], in all bands
};

/// Throws InputError naming what is out of range.
[[nodiscard]] Medium Changed(Medium medium, const AirChoice& choice);

/// Koschmieder's visibility at altitude 0 in the band nearest to 550 nm [m]; infinite in a vacuum.
[[nodiscard]] double VisibilityOf(const Medium& medium);
/// The same at an altitude, of molecules and aerosol there and of what else takes light.
/// @param more_per_m  extinction of fog [1/m].
[[nodiscard]] double VisibilityAt(const Medium& medium, double altitude_m, double more_per_m);
/// AirChoice::aerosol for a visibility [m]: 0 where molecules alone leave no more, 1000 at most.
[[nodiscard]] double AerosolForVisibility(const Medium& medium, double visibility_m);
/// Of the column, in the band that absorbs most; 0 without ozone.
[[nodiscard]] double OzoneDobson(const Medium& medium);

/// How well: a draft takes a third of the time; irradiance from its sky is good to 3 % by day, 6 %
/// in twilight.
enum class AirSolution { kDraft, kFull };

/// Immutable, safe to share between threads.
struct SolvedAir {
  Medium medium;
  AirSolution solution;
  BentBeam beam;
  DiffuseLight diffuse;
  MediumTables tables;
};

/// On the calling thread alone, so that drawing keeps the other processors. Throws InputError for a
/// medium that Validate refuses or of more than four bands.
[[nodiscard]] std::shared_ptr<const SolvedAir> SolveAir(const Medium& medium,
                                                        AirSolution solution = AirSolution::kFull);

}  // namespace alpenglow::viewer
