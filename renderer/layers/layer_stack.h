// SPDX-License-Identifier: MIT
// A stack of homogeneous plane-parallel layers over a Lambertian ground, in one band: what does not
// depend on the source of light.
//
// The light of every azimuth mode m = 0 ... streams - 1 is followed in discrete ordinates
// (layer_mode.h) after delta-M (layer_optics.h). Layers are added from the ground upwards: with the
// reflection rho of everything below a layer,
//
//   rho_top = R + T rho (1 - R rho)^-1 T
//
// and rho = 2 A sqrt(mu w) sqrt(mu w)^T of the ground for m = 0. A new source then costs products
// of small matrices with vectors (adding: van de Hulst 1980, Multiple Light Scattering, ch. 4;
// Nakajima and Tanaka 1986, J. Quant. Spectrosc. Radiat. Transf. 35, 13).
//
// Vectors of streams are in units of sqrt(mu w) I.
#pragma once

#include <cstddef>
#include <vector>

#include "renderer/layer.h"
#include "renderer/layers/dense_matrix.h"
#include "renderer/layers/layer_mode.h"
#include "renderer/layers/layer_optics.h"
#include "renderer/layers/stream_set.h"

namespace alpenglow::renderer {

/// Light at one interface, for every stream of one azimuth mode.
struct InterfaceLight {
  std::vector<double> down, up;
};

/// Sources of one azimuth mode, for every stream. Empty vectors are 0.
struct ModeSources {
  std::vector<double> from_above{};               // downwards at the top
  std::vector<std::vector<double>> up{}, down{};  // of each layer: leaving its top and its bottom
  std::vector<double> of_ground{};                // upwards at the bottom
};

/// Immutable; safe to use from many threads.
class LayerStack {
 public:
  /// @param layers  from the top to the bottom, at least one. @param ground_albedo  in [0, 1].
  /// @param streams  even, in [2, 64]. Throws InputError, which has the value and its range.
  LayerStack(std::vector<LayerOptics> layers, double ground_albedo, int streams = 8);

  [[nodiscard]] const StreamSet& streams() const { return streams_; }
  [[nodiscard]] std::size_t size() const { return layers_.size(); }
  [[nodiscard]] const LayerOptics& optics(std::size_t layer) const { return layers_[layer]; }
  [[nodiscard]] const ScaledLayer& scaled(std::size_t layer) const { return scaled_[layer]; }
  [[nodiscard]] double ground_albedo() const { return ground_albedo_; }
  /// Returns the optical depth above a layer; of the whole stack for layer = size().
  [[nodiscard]] double DepthAbove(std::size_t layer) const { return above_[layer]; }
  /// Returns the same after delta-M.
  [[nodiscard]] double ScaledAbove(std::size_t layer) const { return scaled_above_[layer]; }

  /// Returns the number of azimuth modes; higher ones have no light.
  [[nodiscard]] int modes() const { return modes_; }
  [[nodiscard]] const LayerMode& mode(int m, std::size_t layer) const {
    return modes_of_layers_[static_cast<std::size_t>(m) * size() + layer];
  }
  /// Returns sqrt(mu w) of every stream.
  [[nodiscard]] const std::vector<double>& unit_light() const { return unit_light_; }

  /// Returns the light at all interfaces, from the top to the ground.
  [[nodiscard]] std::vector<InterfaceLight> Solve(int m, const ModeSources& sources) const;

 private:
  /// The layers and the ground below one layer, for one azimuth mode.
  struct Below {
    DenseMatrix rho;      // its reflection
    DenseMatrix between;  // (1 - R rho)^-1: light to and fro
  };
  void AddModes();
  void AddFromBelow(int m);

  StreamSet streams_;
  std::vector<LayerOptics> layers_;
  std::vector<ScaledLayer> scaled_;
  double ground_albedo_;
  int modes_ = 1;
  std::vector<double> above_, scaled_above_, unit_light_;
  std::vector<LayerMode> modes_of_layers_;  // [m * size + layer]
  std::vector<Below> below_;                // likewise
};

}  // namespace alpenglow::renderer
