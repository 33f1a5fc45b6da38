// SPDX-License-Identifier: MIT
#include "viewer/air/solved_air.h"

#include <tbb/task_arena.h>

namespace alpenglow {

std::shared_ptr<const SolvedAir> SolveAir(const Medium& medium) {
  const AirIntegrator<float> air(medium);
  tbb::task_arena one_thread(1);
  return one_thread.execute([&] {
    return std::make_shared<const SolvedAir>(
        SolvedAir{medium, DiffuseLight(medium), MakeMediumTables(air)});
  });
}

}  // namespace alpenglow
