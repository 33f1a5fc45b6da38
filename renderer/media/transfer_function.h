// SPDX-License-Identifier: MIT
// A transfer function: extinction, albedo and emission of a volume as functions of a scalar value,
// as for pictures of measured volumes (Levoy 1988, "Display of surfaces from volume data"). Between
// nodes
//
//   extinction [1/m], albedo w, temperature T [K]   are linear in the value,
//   emission = extinction (1 - w) B(T)              by Kirchhoff's law, B that of a black body,
//
// and beyond the first and the last node all are those of the node.
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "atmosphere/ray/single_scattering.h"
#include "renderer/scene/scene.h"
#include "renderer/scene/volume_grid.h"

namespace alpenglow::renderer {

/// Immutable; safe to use from many threads.
class TransferFunction {
 public:
  /// @param nodes  two or more, of increasing values.
  TransferFunction(const std::vector<TransferNode>& nodes,
                   const std::vector<double>& wavelengths_nm);

  [[nodiscard]] std::size_t bands() const { return wavelengths_nm_.size(); }
  /// Returns the extinction of a value [1/m].
  [[nodiscard]] double Extinction(double value) const;
  /// Returns the largest extinction of the values in [least, largest] [1/m].
  [[nodiscard]] double LargestExtinction(double least, double largest) const;
  /// Returns whether no node lies between two values: all of the function is linear there.
  [[nodiscard]] bool IsLinear(double least, double largest) const;

  /// Returns the values of the two nodes around a value; infinite where there is none.
  [[nodiscard]] std::pair<double, double> NodesAround(double value) const;

  /// Albedo and emission per extinction of a value, band by band.
  struct Colour {
    SpectrumOf<double> albedo;    // 0 to 1
    SpectrumOf<double> emission;  // W m^-2 sr^-1 nm^-1
  };
  [[nodiscard]] Colour ColourOf(double value) const;

  /// Returns the positions on a piece of a line at which its values cross nodes, in [0, 1] and in
  /// order, with 0 first and 1 last. Between two of them the function is linear in the value.
  [[nodiscard]] std::vector<double> Crossings(const CubicPiece& piece) const;
  /// Returns the integral of the extinction over a piece of a line [1/m, times the unit of the
  /// piece]. Relative error below 1e-10.
  [[nodiscard]] double Integral(const CubicPiece& piece) const;

 private:
  /// A place between two nodes: (1 - share) of `node` and share of the next one.
  struct Place {
    std::size_t node;
    double share;
  };
  [[nodiscard]] Place PlaceOf(double value) const;

  std::vector<double> wavelengths_nm_;
  std::vector<double> values_, extinction_per_m_, temperature_k_;  // [node]
  std::vector<SpectrumOf<double>> albedo_;                         // [node]
};

}  // namespace alpenglow::renderer
