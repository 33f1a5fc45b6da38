// SPDX-License-Identifier: MIT
// One azimuth mode of the light in one homogeneous layer, independent of its sources.
//
// The radiance is I = sum over m of I^m cos m phi, with mu > 0 upwards and tau downwards. For the
// streams +-mu_i with weights w_i, let e = sqrt(mu w) (I+ + I-) and o = sqrt(mu w) (I+ - I-). Then
//
//   de/dtau = S_o o,   do/dtau = S_e e,   S_o = L L^T   (symmetric, positive definite)
//   S_e, S_o = M^-1/2 (1 - sqrt(W) D sqrt(W)) M^-1/2,   D_ij = sum of 2 c_l Lambda_l(mu_i)
//   Lambda_l(mu_j) over even or odd l - m,   c_l = w' (2 l + 1) chi'_l / 2
//
// without sources (Stamnes and Swanson 1981, J. Atmos. Sci. 38, 387; the symmetric form is that of
// Nakajima and Tanaka 1986, J. Quant. Spectrosc. Radiat. Transf. 35, 13). The eigenvectors Z and
// eigenvalues k^2 of L^T S_e L separate the equations into a_j'' = k_j^2 a_j:
//
//   e = B a,   o = U a',   B = L Z,   U = L^-T Z = B^-T
//
// A layer of depth T is described by what it reflects and transmits, in units of sqrt(mu w) I:
//
//   R = (1 + Y_s)^-1 + (1 + Y_a)^-1 - 1,   T = (1 + Y_s)^-1 - (1 + Y_a)^-1
//   Y_s = U k tanh(k T / 2) U^T,   Y_a = U k coth(k T / 2) U^T
//
// from solutions that are even or odd about its middle. Both matrices are symmetric, their norms do
// not exceed 1, and no exponential of a positive number occurs; k = 0 (no absorption) is an ordinary
// case.
#pragma once

#include <cstddef>
#include <vector>

#include "renderer/layer.h"
#include "renderer/layers/dense_matrix.h"
#include "renderer/layers/layer_optics.h"
#include "renderer/layers/stream_set.h"

namespace alpenglow::renderer {

/// Sums over even and over odd l - m, for every amplitude a_j.
struct EvenAndOdd {
  std::vector<double> even, odd;
};

/// Slopes at the ends of a layer of a solution of a'' = k^2 a that is 1 at one end and 0 at the
/// other: k coth(k T) and k / sinh(k T), up to their signs.
struct EndSlopes {
  double own, other;
};
/// @param depth  T > 0.
[[nodiscard]] EndSlopes EndSlopesOf(double k, double depth);

/// Immutable.
class LayerMode {
 public:
  /// @param m  in [0, streams).
  LayerMode(const StreamSet& streams, const ScaledLayer& layer, int m);

  [[nodiscard]] const std::vector<double>& decay() const { return decay_; }  // k_j
  [[nodiscard]] const std::vector<EndSlopes>& end_slopes() const { return end_slopes_; }
  [[nodiscard]] const DenseMatrix& even() const { return even_; }  // B
  [[nodiscard]] const DenseMatrix& odd() const { return odd_; }    // U
  [[nodiscard]] const DenseMatrix& reflection() const { return reflection_; }
  [[nodiscard]] const DenseMatrix& transmission() const { return transmission_; }

  /// Returns the factors of a_j (even) and a_j' (odd) in the source function of a direction.
  /// @param legendre  AssociatedLegendre of its mu, for l < streams.
  [[nodiscard]] EvenAndOdd EmissionAt(const std::vector<double>& legendre) const;
  /// Returns the source function by degree: its sum with AssociatedLegendre is that of a direction.
  [[nodiscard]] std::vector<double> SourceOf(const std::vector<double>& value,
                                             const std::vector<double>& slope) const;

 private:
  void SetEmission(const StreamSet& streams, const ScaledLayer& layer);
  void SetResponse(double depth);

  int m_;
  std::vector<double> decay_;
  std::vector<EndSlopes> end_slopes_;  // none without depth
  DenseMatrix even_, odd_, reflection_, transmission_;
  std::vector<double> emission_;  // [l * size + j], c_l times the moment l of amplitude j
};

}  // namespace alpenglow::renderer
