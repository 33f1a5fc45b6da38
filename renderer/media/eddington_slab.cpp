// SPDX-License-Identifier: MIT
#include "renderer/media/eddington_slab.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"

namespace alpenglow::renderer {

double SlabField::DownwardFlux() const { return kPi * (mean + 2.0 / 3.0 * slope); }
double SlabField::UpwardFlux() const { return kPi * (mean - 2.0 / 3.0 * slope); }

// A lobe that scatters backwards has no forward peak, although its second coefficient is positive.
double PeakFraction(const SlabScattering& scattering) {
  return std::clamp(scattering.chi_1, 0.0, std::max(scattering.chi_2, 0.0));
}

EddingtonSlab::EddingtonSlab(const SlabScattering& scattering, double depth, double ground_albedo,
                             double mu0) {
  ALPENGLOW_ENSURE(depth, >=, 0.0);
  ALPENGLOW_ENSURE(mu0, >, 0.0);
  ALPENGLOW_ENSURE(scattering.chi_2, <, 1.0);
  // Without any absorption e^(k tau) and e^(-k tau) are the same solution. An absorption of a
  // millionth separates them, and removes a millionth of the light per unit of depth.
  constexpr double kMostAlbedo = 1.0 - 1e-6;
  const double w_true = std::min(scattering.albedo, kMostAlbedo);
  const double f = PeakFraction(scattering);
  scale_ = 1.0 - w_true * f;
  const double w = w_true * (1.0 - f) / scale_;
  // Eddington's phase function 1 + 3 g mu sends more light back than arrives if g is below -2/3 and
  // the beam is vertical.
  const double g = std::max((scattering.chi_1 - f) / (1.0 - f), -2.0 / 3.0);
  depth_ = scale_ * depth;
  k_ = std::sqrt(3.0 * (1.0 - w) * (1.0 - w * g));
  slope_of_k_ = k_ / (1.0 - w * g);
  // If the beam decays like the diffuse light, the particular solution has a pole that the boundary
  // conditions cancel.
  mu0_ = std::abs(k_ * mu0 - 1.0) < 1e-4 ? (1.0 - 1e-4) / k_ : mu0;
  const double source = w / (4.0 * kPi);
  particular_ = 3.0 * mu0_ * mu0_ * source * (1.0 + g - w * g) / (k_ * k_ * mu0_ * mu0_ - 1.0);
  particular_slope_ = 3.0 * mu0_ * ((1.0 - w) * particular_ - source);
  // Boundary conditions: no diffuse light from above, the ground's reflection from below.
  const double across = std::exp(-k_ * depth_);
  const double beam = std::exp(-depth_ / mu0_);
  const double top_falling = 1.0 + 2.0 / 3.0 * slope_of_k_;
  const double top_rising = (1.0 - 2.0 / 3.0 * slope_of_k_) * across;
  const double top = -(particular_ + 2.0 / 3.0 * particular_slope_);
  const double up = 1.0 - ground_albedo, down = 2.0 / 3.0 * (1.0 + ground_albedo);
  const double bottom_falling = (up - down * slope_of_k_) * across;
  const double bottom_rising = up + down * slope_of_k_;
  const double bottom =
      ground_albedo * mu0_ * beam / kPi - (up * particular_ - down * particular_slope_) * beam;
  const double determinant = top_falling * bottom_rising - top_rising * bottom_falling;
  falling_ = (top * bottom_rising - top_rising * bottom) / determinant;
  rising_ = (top_falling * bottom - bottom_falling * top) / determinant;
}

SlabField EddingtonSlab::At(double depth) const {
  const double tau = std::clamp(scale_ * depth, 0.0, depth_);
  const double falling = falling_ * std::exp(-k_ * tau);
  const double rising = rising_ * std::exp(-k_ * (depth_ - tau));
  const double beam = std::exp(-tau / mu0_);
  return {falling + rising + particular_ * beam,
          slope_of_k_ * (falling - rising) + particular_slope_ * beam};
}

double EddingtonSlab::BeamLeft(double slant_depth) const { return std::exp(-scale_ * slant_depth); }

}  // namespace alpenglow::renderer
