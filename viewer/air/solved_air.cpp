// SPDX-License-Identifier: MIT
#include "viewer/air/solved_air.h"

#include <tbb/task_arena.h>

#include <utility>

namespace alpenglow::viewer {

std::shared_ptr<const SolvedAir> SolveAir(const Medium& medium, AirSolution solution) {
  constexpr DiffuseLightOptions kDraft{
      .altitudes = 12, .sun_angles = 24, .zenith_nodes = 8, .azimuth_nodes = 5, .ray_nodes = 6};
  const AirIntegrator<float> air(medium);
  tbb::task_arena one_thread(1);
  return one_thread.execute([&] {
    BentBeam beam(medium);
    MediumTables tables = MakeMediumTables(air, beam);
    return std::make_shared<const SolvedAir>(SolvedAir{
        medium, solution, std::move(beam),
        DiffuseLight(medium, solution == AirSolution::kDraft ? kDraft : DiffuseLightOptions{}),
        std::move(tables)});
  });
}

}  // namespace alpenglow::viewer
