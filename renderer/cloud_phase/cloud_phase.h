// SPDX-License-Identifier: MIT
// Phase functions of a cloud by the effective radius of its droplets or crystals.
//
// Between two radii the phase function is the mixture of both, linear in ln r. A path draws one of
// the two with these weights at every scattering, so that any phase function of the air's aerosols,
// a formula or a table, serves clouds too.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "atmosphere/medium/phase.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Immutable; safe to use from many threads.
class CloudPhases {
 public:
  /// One phase function for all radii. Throws InputError of Validate.
  explicit CloudPhases(PhaseFunction phase);
  /// @param radius_um  ascending, > 0. @param phase  as many. Throws InputError otherwise.
  CloudPhases(std::vector<double> radius_um, std::vector<PhaseFunction> phase);

  /// Returns one of the two phase functions nearest to a radius, drawn by its weight; the first or
  /// last one beyond the ends.
  /// @param u  uniform in [0, 1).
  [[nodiscard]] const PhaseFunction& Drawn(double radius_um, double u) const;
  /// Returns whether the radius matters.
  [[nodiscard]] bool depends_on_radius() const { return phase_.size() > 1; }
  /// Returns the value of the mixture at a radius [1/sr].
  [[nodiscard]] double Value(double radius_um, double cos_scattering) const;

 private:
  /// Two neighbours and the weight of the second.
  struct Neighbours {
    std::size_t first, second;
    double weight;
  };
  [[nodiscard]] Neighbours Around(double radius_um) const;

  std::vector<double> log_radius_;
  std::vector<PhaseFunction> phase_;
};

/// Returns the columns of an embedded table of phase functions: scattering angles [degrees], then
/// phase functions [1/sr]. Throws InternalError if a row lacks numbers.
/// @param file  its path from the top of the repository. @param columns  that are read.
[[nodiscard]] std::vector<std::vector<double>> PhaseColumns(std::string_view file,
                                                            std::size_t columns);

}  // namespace alpenglow::renderer
