// SPDX-License-Identifier: MIT
// Error of single scattering in float by height of the sun, kind of ray and number of samples: root
// mean square, 99th percentile and maximum of the relative error. Run by hand; results are in
// README.md.
#include <fmt/format.h>

#include "tests/fixtures/ray_regimes.h"

int main() {
  using namespace alpenglow;
  fmt::print("| air | sun | ray | nodes | rms | 99 % | max |\n|---|---|---|---|---|---|---|\n");
  for (const char* name : {"earth", "hazy"}) {
    const Medium medium = MediumPreset(name);
    for (const auto& sun : tests::kSunHeights) {
      for (const auto& view : tests::kRayViews) {
        for (const int nodes : {8, 12}) {
          const auto error = tests::ErrorOfRegime(medium, sun, view.view, {.nodes = nodes}, 600);
          fmt::print("| {} | {} | {} | {} | {:.1e} | {:.1e} | {:.1e} |\n", name, sun.name,
                     view.name, nodes, error.rms, error.percentile99, error.largest);
        }
      }
    }
  }
}
