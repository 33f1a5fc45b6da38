// SPDX-License-Identifier: MIT
// Runs one of the studies: studies NAME [ARGUMENTS]
#include "tests/bench/studies.h"

#include <fmt/core.h>

#include <cstdio>
#include <exception>
#include <string_view>

namespace alpenglow::tests {
namespace {

struct Study {
  std::string_view name;
  void (*run)(int count, char** arguments);
};

constexpr Study kStudies[] = {
    {"caustic_error", CausticError},
    {"day_exposure", DayExposure},
    {"effects_error", EffectsError},
    {"exchange_error", ExchangeError},
    {"layer_error", LayerError},
    {"path_study", PathStudy},
    {"refracted_twilight", RefractedTwilightError},
    {"sky_tint", SkyTint},
    {"stokes_study", StokesStudy},
    {"tile_memory", TileMemory},
    {"viewer_error", ViewerError},
    {"volume_error", VolumeError},
#ifdef ALPENGLOW_STUDIES_OF_VIEWER
    {"shade_error", ShadeError},
    {"viewer_parity", ViewerParity},
#endif
};

int Run(std::string_view name, int count, char** arguments) {
  for (const Study& study : kStudies) {
    if (study.name != name) continue;
    study.run(count, arguments);
    return 0;
  }
  fmt::print(stderr, "usage: studies NAME [ARGUMENTS]; the studies are:\n");
  for (const Study& study : kStudies) fmt::print(stderr, "  {}\n", study.name);
  return 2;
}

}  // namespace
}  // namespace alpenglow::tests

int main(int count, char** arguments) {
  try {
    return alpenglow::tests::Run(count > 1 ? arguments[1] : "", count - 1, arguments + 1);
  } catch (const std::exception& error) {
    fmt::print(stderr, "studies: {}\n", error.what());
    return 3;
  }
}
