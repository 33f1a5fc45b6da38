// SPDX-License-Identifier: MIT
// Measures the relative error of single scattering in float: root mean square, 99th percentile and
// maximum. It prints two tables: by elevation of the sun, kind of ray and number of nodes; and by
// regime, for direct integration and 8 nodes. Run by hand; results are in README.md.
#include <fmt/format.h>

#include "tests/fixtures/direct_regimes.h"
#include "tests/fixtures/ray_regimes.h"

namespace alpenglow::atmosphere {
namespace {

void PrintNodes() {
  fmt::print("| air | sun | ray | nodes | rms | 99 % | max |\n|---|---|---|---|---|---|---|\n");
  for (const char* name : {"earth", "hazy"}) {
    const Medium medium = MediumPreset(name);
    for (const auto& sun : alpenglow::tests::kSunHeights) {
      for (const auto& view : alpenglow::tests::kRayViews) {
        for (const int nodes : {8, 12}) {
          const auto error =
              alpenglow::tests::ErrorOfRegime(medium, sun, view.view, {.nodes = nodes}, 600);
          fmt::print("| {} | {} | {} | {} | {:.1e} | {:.1e} | {:.1e} |\n", name, sun.name,
                     view.name, nodes, error.rms, error.percentile99, error.largest);
        }
      }
    }
  }
}

void PrintDirect(const Medium& medium, const alpenglow::tests::DirectRegime& regime) {
  const DirectScattering direct(medium);
  const SingleScattering<float>& air = direct.reference();
  const alpenglow::tests::ReferenceRays reference =
      tests::ReferenceRaysOf(regime, medium, 20001, 1500);
  const auto print = [&](const char* method, const auto& scatter) {
    const auto error = alpenglow::tests::ErrorsOf(reference, air, scatter);
    fmt::print("| {} | {} | {} | {:.1e} | {:.1e} | {:.1e} |\n", medium.name, regime.name, method,
               error.rms, error.percentile99, error.largest);
  };
  print("fast", [&](const ViewRay& ray) { return direct.Scatter(ray, DirectMode::kFast); });
  print("normal", [&](const ViewRay& ray) { return direct.Scatter(ray, DirectMode::kNormal); });
  print("8 nodes", [&](const ViewRay& ray) { return air.Scatter(air.Sample(ray, {.nodes = 8})); });
}

}  // namespace
}  // namespace alpenglow::atmosphere

int main() {
  using namespace alpenglow::atmosphere;
  PrintNodes();
  fmt::print("\n| air | regime | method | rms | 99 % | max |\n|---|---|---|---|---|---|\n");
  for (const std::string& preset : MediumPresetNames()) {
    for (const alpenglow::tests::DirectRegime& regime : alpenglow::tests::DirectRegimes())
      PrintDirect(MediumPreset(preset), regime);
  }
}
