// SPDX-License-Identifier: MIT
// The directions in which discrete ordinates follow light: Gauss's rule on each hemisphere
// ("double Gauss": Sykes 1951, Mon. Not. R. Astron. Soc. 111, 377), with associated Legendre
// functions
//
//   Lambda_l^m(mu) = sqrt((l - m)! / (l + m)!) P_l^m(mu)     without the Condon-Shortley phase,
//
// for which P_l(cos) = sum over m of (2 - delta_m0) Lambda_l^m(mu) Lambda_l^m(mu') cos m(phi -
// phi').
#pragma once

#include <cstddef>
#include <vector>

#include "renderer/layer.h"

namespace alpenglow::renderer {

/// Returns Lambda_l^m(mu) for l = 0 ... degree; 0 for l < m.
/// @param mu  in [-1, 1].
[[nodiscard]] std::vector<double> AssociatedLegendre(int m, int degree, double mu);

/// The streams of one hemisphere. Immutable.
class StreamSet {
 public:
  /// @param streams  in both hemispheres together, even, in [2, kMostStreams]; otherwise InputError.
  explicit StreamSet(int streams);
  static constexpr int kMostStreams = 64;

  [[nodiscard]] int streams() const { return streams_; }
  /// Returns the number of streams of one hemisphere.
  [[nodiscard]] std::size_t size() const { return mu_.size(); }
  [[nodiscard]] double mu(std::size_t i) const { return mu_[i]; }
  [[nodiscard]] double weight(std::size_t i) const { return weight_[i]; }
  /// Returns Lambda_l^m at stream i, for l < streams.
  [[nodiscard]] double Legendre(int m, int l, std::size_t i) const {
    return legendre_[static_cast<std::size_t>(m) * size() + i][static_cast<std::size_t>(l)];
  }

 private:
  int streams_;
  std::vector<double> mu_, weight_;
  std::vector<std::vector<double>> legendre_;  // [m * size + i][l]
};

}  // namespace alpenglow::renderer
