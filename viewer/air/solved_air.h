// SPDX-License-Identifier: MIT
// A medium with all of its light: what every table of the viewer is made from.
#pragma once

#include <memory>

#include "viewer/air/air_tables.h"

namespace alpenglow::viewer {

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
