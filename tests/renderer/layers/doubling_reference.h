// SPDX-License-Identifier: MIT
// A slow reference solution for light in plane-parallel layers by doubling and adding (van de Hulst
// 1980, Multiple Light Scattering, ch. 4; de Haan, Bosma and Hovenier 1987, Astron. Astrophys. 183,
// 371). It has no eigenvectors, no delta-M and no Legendre series: kernels of very thin layers are
// Fourier integrals of the phase function over the azimuth. It shares the products and the inverse
// of matrices with the tested code.
//
// Without absorption, kernels of narrow lobes gain or lose light by the error of Gauss's rule, which
// adds up in deep layers.
//
// Kernels have a row for each direction of scattered light and a column for each direction of
// incident light. The directions of view and of the sun are further nodes of weight 0.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numeric>
#include <utility>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "renderer/layer.h"
#include "renderer/layers/dense_matrix.h"

namespace alpenglow::renderer::doubling {

struct Layer {
  double depth, albedo;
  std::function<double(double)> phase;  // of the cosine of the scattering angle [1/sr]
};

struct Options {
  int nodes = 16;               // of each hemisphere
  int modes = 32;               // of the azimuth
  std::vector<double> further;  // |mu| of views and of the sun
};

/// Light at an interface per light of a node at the top of the stack: kernels of one azimuth mode,
/// and the transmittance of unscattered light.
struct Interface {
  DenseMatrix down, up;
  std::vector<double> direct;
};

class Stack {
 public:
  /// @param layers  from the top.
  Stack(const std::vector<Layer>& layers, double ground_albedo, const Options& options)
      : options_(options) {
    const GaussRule& rule = GaussLegendre(options.nodes);
    mu_ = rule.node;
    weight_ = rule.weight;
    for (const double mu : options.further) {
      mu_.push_back(mu);
      weight_.push_back(0.0);
    }
    std::vector<PhaseSamples> samples;
    for (const Layer& layer : layers) samples.push_back(SamplesOf(layer));
    for (int m = 0; m < options.modes; ++m) {
      modes_.push_back(Solve(layers, samples, ground_albedo, m));
    }
  }

  /// Returns the radiance of diffuse light for a beam of irradiance 1 across it [1/sr].
  /// @param interface  0 at the top. @param view, sun  numbers of `further`.
  [[nodiscard]] double Radiance(std::size_t interface, bool up, std::size_t view, std::size_t sun,
                                double azimuth) const {
    const auto nodes = static_cast<std::size_t>(options_.nodes);
    double sum = 0.0;
    for (std::size_t m = 0; m < modes_.size(); ++m) {
      const Interface& at = modes_[m][interface];
      sum += (m == 0 ? 0.5 : 1.0) / kPi * std::cos(static_cast<double>(m) * azimuth) *
             (up ? at.up : at.down)(nodes + view, nodes + sun);
    }
    return sum;
  }

  /// Returns the diffuse irradiance of a horizontal plane for the same beam.
  [[nodiscard]] double Flux(std::size_t interface, bool up, std::size_t sun) const {
    const Interface& at = modes_[0][interface];
    double sum = 0.0;
    for (std::size_t i = 0; i < mu_.size(); ++i) {
      sum += weight_[i] * mu_[i] *
             (up ? at.up : at.down)(i, static_cast<std::size_t>(options_.nodes) + sun);
    }
    return sum;
  }

 private:
  struct Homogeneous {
    DenseMatrix reflection, transmission;
    std::vector<double> direct;
  };

  /// Returns a kernel as an operator on the light of nodes: columns times weights.
  [[nodiscard]] DenseMatrix Weighted(const DenseMatrix& kernel) const {
    return kernel.WithColumnsTimes(weight_);
  }
  [[nodiscard]] static DenseMatrix RowsTimes(const DenseMatrix& kernel,
                                             const std::vector<double>& factors) {
    return kernel.Transposed().WithColumnsTimes(factors).Transposed();
  }

  /// Phase function from every node to every other one: values at azimuths from 0 to pi.
  struct PhaseSamples {
    std::vector<std::vector<double>> across,
        along;  // reflected, transmitted; [row * size + column]
  };
  static constexpr int kAzimuths = 256;

  [[nodiscard]] PhaseSamples SamplesOf(const Layer& layer) const {
    PhaseSamples samples;
    for (const double to : mu_) {
      for (const double from : mu_) {
        const double sines = std::sqrt((1.0 - to * to) * (1.0 - from * from));
        samples.across.emplace_back();
        samples.along.emplace_back();
        for (int k = 0; k <= kAzimuths; ++k) {
          const double turned = sines * std::cos(kPi * k / kAzimuths);
          samples.across.back().push_back(layer.phase(turned - to * from));
          samples.along.back().push_back(layer.phase(turned + to * from));
        }
      }
    }
    return samples;
  }

  /// Returns what a layer without ground scatters once.
  [[nodiscard]] Homogeneous Thin(const PhaseSamples& samples, double albedo, double depth,
                                 int m) const {
    const std::size_t size = mu_.size();
    std::vector<double> share;  // of each azimuth in the mode
    for (int k = 0; k <= kAzimuths; ++k) {
      share.push_back((k == 0 || k == kAzimuths ? 1.0 : 2.0) * kPi / kAzimuths *
                      std::cos(m * kPi * k / kAzimuths));
    }
    const auto mode_of = [&](const std::vector<double>& phase) {
      return std::inner_product(phase.begin(), phase.end(), share.begin(), 0.0);
    };
    Homogeneous thin{DenseMatrix(size), DenseMatrix(size), {}};
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t j = 0; j < size; ++j) {
        const double scattered = albedo * depth / mu_[i];
        thin.reflection(i, j) = scattered * mode_of(samples.across[i * size + j]);
        thin.transmission(i, j) = scattered * mode_of(samples.along[i * size + j]);
      }
      thin.direct.push_back(std::exp(-depth / mu_[i]));
    }
    return thin;
  }

  /// Returns the light between a layer and what lies below it, for light from above.
  [[nodiscard]] Interface Between(const Homogeneous& above, const DenseMatrix& below) const {
    const DenseMatrix to_and_fro = Weighted(above.reflection) * below;
    const DenseMatrix all =
        InverseOf(DenseMatrix::Identity(mu_.size()) - Weighted(to_and_fro)) * to_and_fro;
    const DenseMatrix down = above.transmission + all.WithColumnsTimes(above.direct) +
                             Weighted(all) * above.transmission;
    return {down, below.WithColumnsTimes(above.direct) + Weighted(below) * down, above.direct};
  }

  /// Returns the reflection of a layer above something, of which the light between is known.
  [[nodiscard]] DenseMatrix Reflection(const Homogeneous& above, const Interface& between) const {
    return above.reflection + RowsTimes(between.up, above.direct) +
           Weighted(above.transmission) * between.up;
  }

  [[nodiscard]] Homogeneous Twice(const Homogeneous& half) const {
    const Interface middle = Between(half, half.reflection);
    Homogeneous whole{Reflection(half, middle),
                      RowsTimes(middle.down, half.direct) +
                          half.transmission.WithColumnsTimes(half.direct) +
                          Weighted(half.transmission) * middle.down,
                      half.direct};
    for (double& direct : whole.direct) direct *= direct;
    return whole;
  }

  [[nodiscard]] Homogeneous Doubled(const Layer& layer, const PhaseSamples& samples, int m) const {
    // Light scattered twice in the first layer is left out.
    constexpr double kThin = 1e-6;
    const int doublings = std::max(static_cast<int>(std::ceil(std::log2(layer.depth / kThin))), 0);
    Homogeneous grown = Thin(samples, layer.albedo, std::ldexp(layer.depth, -doublings), m);
    if (IsDark(grown)) {
      for (double& direct : grown.direct) direct = std::pow(direct, std::exp2(doublings));
      return grown;
    }
    for (int k = 0; k < doublings; ++k) grown = Twice(grown);
    return grown;
  }

  /// Returns whether a mode has no scattered light but rounding.
  [[nodiscard]] bool IsDark(const Homogeneous& layer) const {
    for (std::size_t i = 0; i < mu_.size(); ++i) {
      for (std::size_t j = 0; j < mu_.size(); ++j) {
        const double most =
            std::max(std::abs(layer.reflection(i, j)), std::abs(layer.transmission(i, j)));
        if (most > 1e-13 * (1.0 - layer.direct[i])) return false;
      }
    }
    return true;
  }

  [[nodiscard]] std::vector<Interface> Solve(const std::vector<Layer>& layers,
                                             const std::vector<PhaseSamples>& samples,
                                             double ground_albedo, int m) const {
    const std::size_t size = mu_.size();
    DenseMatrix below(size);
    for (std::size_t i = 0; m == 0 && i < size; ++i) {
      for (std::size_t j = 0; j < size; ++j) below(i, j) = 2.0 * ground_albedo * mu_[j];
    }
    std::vector<Interface> betweens(layers.size());  // per light at the top of each layer
    for (std::size_t n = layers.size(); n-- > 0;) {
      const Homogeneous layer = Doubled(layers[n], samples[n], m);
      betweens[n] = Between(layer, below);
      below = Reflection(layer, betweens[n]);
    }
    std::vector<Interface> light{{DenseMatrix(size), below, std::vector<double>(size, 1.0)}};
    for (const Interface& next : betweens) {
      const Interface& above = light.back();
      Interface at{next.down.WithColumnsTimes(above.direct) + Weighted(next.down) * above.down +
                       RowsTimes(above.down, next.direct),
                   next.up.WithColumnsTimes(above.direct) + Weighted(next.up) * above.down,
                   above.direct};
      for (std::size_t i = 0; i < size; ++i) at.direct[i] *= next.direct[i];
      light.push_back(std::move(at));
    }
    return light;
  }

  Options options_;
  std::vector<double> mu_, weight_;
  std::vector<std::vector<Interface>> modes_;  // [m][interface]
};

}  // namespace alpenglow::renderer::doubling
