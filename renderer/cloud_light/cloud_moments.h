// SPDX-License-Identifier: MIT
// Light of all orders in a field of clouds: moments of degree 3 of the scattered radiance on cells.
//
//   M_lm(p) = integral of I(p, d) Y_lm(d) over all directions d of travel
//   J(p, d) = w' sum_lm chi'_l Y_lm(d) (M_lm(p) + E'(p) Y_lm(-s))
//
// where I is the radiance of the medium of cloud_optics.h without the sun's beam, E' the irradiance
// of the beam, s the direction to the sun and J the source per unit of scaled extinction. I follows
// from J along tracks (cloud_track_kernel.h) of 48 directions: three cosines of Gauss on each
// hemisphere times eight azimuths. The quadrature on half ranges gives thin layers their energy;
// tracks conserve it for any optical depth of a cell. Restarted by a coarser solution (cells of four
// times, then twice the size), generalised minimal residuals (Saad and Schultz 1986, SIAM J. Sci.
// Stat. Comput. 7, 856) solve M = K M + b.
//
// The source of the beam is exact: every part of a beam of the map of sunlight gives what it loses
// to the cell that it lies in, or to the nearest full one. A sun too low for a map is as high as over
// the place everywhere; eight points in each cell stand for its beams.
//
// The radiances of the tracks that leave through the base light the ground (cloud_floor.h).
//
// Uniform light from above and below is an equilibrium of droplets that absorb nothing, so that the
// light of a uniform ground is 1 less that of the sky. Absorbing ones need their own solution.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "renderer/cloud_light/cloud_cells.h"
#include "renderer/cloud_light/cloud_floor.h"
#include "renderer/cloud_light/cloud_optics.h"
#include "renderer/cloud_light/cloud_sun_depths.h"

namespace alpenglow::renderer {

struct CloudMomentOptions {
  std::optional<double> cell_m = {};  // in [10, 2500]; nothing: UsualCloudCell_m
  double tolerance = 5e-3;            // of the residual relative to the source, in [1e-6, 0.5]
  int most_sweeps = 60;               // over all tracks on one grid, >= 1
};

/// Returns 40 m for a field of at most 8 km by 8 km, and 80 m for a larger one, whose solution
/// would take more than some seconds.
[[nodiscard]] double UsualCloudCell_m(const CloudField& field);

/// Moments of light on stored cells. Immutable; safe to use from many threads. Copies share the
/// cells.
class CloudMoments {
 public:
  CloudMoments(std::shared_ptr<const CloudCells> cells, std::vector<CloudHarmonics> moments)
      : cells_(std::move(cells)), moments_(std::move(moments)) {}

  [[nodiscard]] const CloudCells& cells() const { return *cells_; }
  [[nodiscard]] const CloudHarmonics& Of(std::size_t cell) const { return moments_[cell]; }
  [[nodiscard]] CloudHarmonics Of(const CloudCells::Mixture& mixture) const;
  /// Returns the moments at a point; 0 where no cloud is near.
  [[nodiscard]] CloudHarmonics At(const glm::dvec3& point) const {
    return Of(cells_->Around(point));
  }
  /// Returns the sum of moments times factors (CloudOptics::SourceFactors).
  [[nodiscard]] float Source(const CloudCells::Mixture& mixture,
                             const CloudHarmonics& factors) const;
  /// Returns the memory of the moments [bytes], without the cells.
  [[nodiscard]] std::size_t bytes() const { return moments_.size() * sizeof(CloudHarmonics); }

 private:
  std::shared_ptr<const CloudCells> cells_;
  std::vector<CloudHarmonics> moments_;  // of each stored cell
};

/// A solution and its fluxes.
struct SolvedCloudMoments {
  CloudMoments moments;
  /// Mean fluxes through the top and the base of a periodic field, per unit irradiance across the
  /// sun's beam, or per unit radiance of sky or ground; 0 for an open field. Those of the sun are
  /// without light that is not scattered.
  double up_at_top = 0.0, down_at_base = 0.0;
  /// Light through the base of a periodic field, without the light that droplets turn by a few
  /// degrees and without light that is not scattered.
  std::vector<CloudBaseLight> through_base = {};
  int sweeps = 0;         // on the finest grid
  double residual = 0.0;  // relative to the source
};

/// Light that enters a medium from outside and light of beams in it.
struct CloudIllumination {
  /// Returns the radiance that enters along a direction of travel; null: none.
  std::function<double(const glm::dvec3& travel)> entering;
  /// Returns, for each full cell of a grid, the sum of E' Y_lm(d) over all scaled beams of irradiance
  /// E' that travel along d, the mean over the cell weighted by extinction; null: none. Isotropic
  /// emission of the radiance J per unit of scaled extinction is J / (w' Y_00) in the first moment.
  std::function<std::vector<CloudHarmonics>(const CloudCells& cells)> incident;
};

/// Solves for the light of one field. Immutable. It does not refer to the field.
class CloudMomentSolver {
 public:
  /// Throws InputError for options out of range.
  CloudMomentSolver(const CloudField& field, std::shared_ptr<const CloudOptics> optics,
                    const CloudMomentOptions& options = {});
  /// Solves on given cells of one medium, from the coarsest to the finest. Throws likewise.
  /// @param extinction_per_m  by which the extinction of cells is multiplied.
  CloudMomentSolver(const std::vector<std::shared_ptr<const CloudCells>>& cells,
                    double extinction_per_m, std::shared_ptr<const CloudOptics> optics,
                    const CloudMomentOptions& options = {});
  ~CloudMomentSolver();
  CloudMomentSolver(CloudMomentSolver&&) noexcept;
  CloudMomentSolver& operator=(CloudMomentSolver&&) noexcept;

  /// Each uses as many threads as are free; the result does not depend on their number.
  /// @param to_sun  of the same field. Unit irradiance across the beam.
  [[nodiscard]] SolvedCloudMoments Sun(const CloudSunDepths& to_sun) const;
  /// Unit radiance from all directions above.
  [[nodiscard]] SolvedCloudMoments Sky() const;
  /// Unit radiance from all directions below.
  [[nodiscard]] SolvedCloudMoments Ground() const;
  /// Returns no light, of which no sweep is made.
  [[nodiscard]] SolvedCloudMoments None() const;
  /// Light that is given in the frame of the cells.
  [[nodiscard]] SolvedCloudMoments Light(const CloudIllumination& light) const;

  [[nodiscard]] const CloudCells& cells() const;
  /// Returns the memory of all grids [bytes].
  [[nodiscard]] std::size_t bytes() const;

 private:
  class Grid;
  struct Source;
  [[nodiscard]] SolvedCloudMoments Cascade(const std::vector<Source>& sources) const;

  std::shared_ptr<const CloudOptics> optics_;
  CloudMomentOptions options_;
  std::vector<std::unique_ptr<const Grid>> grids_;  // from the coarsest to the finest
};

}  // namespace alpenglow::renderer
