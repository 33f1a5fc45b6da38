// SPDX-License-Identifier: MIT
// This header provides methods of the literature, reimplemented from the publications, for
// comparison in the report.
//
// Every method uses this library's exact geometry, and this library's closed forms for columns that
// are not its subject. The remaining errors are therefore those of the method itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "atmosphere/medium/medium.h"
#include "atmosphere/ray/ray.h"
#include "atmosphere/ray/single_scattering.h"
#include "lut/layer.h"

namespace alpenglow::lut {

/// Rules for marching along a ray in steps.
enum class MarchRule {
  kMidpoint,   // equal steps, air sampled in their middles
  kTrapezoid,  // equal steps, air sampled at both ends: Bruneton and Neyret (2008), 500 steps
  kQuadratic,  // steps that grow with the square of their number, air sampled at 0.3 of a step:
               // Hillaire (2020), Computer Graphics Forum 39, 13
};

/// Returns the nodes of the rule on [begin_m, end_m]; the trapezoid has steps + 1.
[[nodiscard]] std::vector<RayNode> MarchNodes(MarchRule rule, int steps, const RayExtent& extent);

/// Returns the transmittance of a ray by a march through the densities, in float.
[[nodiscard]] Spectrum MarchedTransmittance(const Medium& medium, const ViewRay& ray,
                                            MarchRule rule, int steps);

/// Closed approximations of Chapman's function Ch(X, chi) for X = (R + h) / H, cos(chi) >= 0.
enum class ChapmanRule {
  /// c / ((c - 1) cos(chi) + 1), c = sqrt(pi X / 2): Schueler (2012), An approximation to the
  /// Chapman grazing-incidence function for atmospheric scattering, GPU Pro 3, 105.
  kSchueler,
  /// A rational approximation of the scaled complementary error function: Golubev (2019), Sampling
  /// analytic participating media, zero-radiance.github.io; after Ren and MacKenzie (2007), Atmos.
  /// Sci. Lett. 8, 70. Unity's HDRP uses it.
  kGolubev,
};
[[nodiscard]] float ChapmanFunction(ChapmanRule rule, float x, float cos_chi);

/// Returns the transmittance to space. The exponential layers use a Chapman approximation, ozone
/// uses the closed form of this library. The ray must not hit the ground.
[[nodiscard]] Spectrum ChapmanTransmittance(const SingleScattering<float>& air, ChapmanRule rule,
                                            const ViewRay& ray);

/// Multiple scattering as in Hillaire (2020), A scalable and production ready sky and atmosphere
/// rendering technique, Computer Graphics Forum 39, 13, section 5.5. Light of order two is assumed
/// isotropic, gathered over the sphere around a point, and multiplied by the geometric series of
/// all orders in an infinite medium with the properties of that point,
///
///   psi = L_2 / (1 - f),   L_2 = mean of L' over directions,   f = mean of L_f over directions
///   L'  = integral of sigma_s T p_u lit T_sun dt + ground,     L_f = integral of sigma_s T dt
///
/// with p_u = 1 / 4 pi; tabulated over (sun zenith cosine, altitude), both linear, bilinear.
class IsotropicTable {
 public:
  struct Size {
    std::size_t side = 32;    // texels along both axes
    int directions_side = 8;  // its square is the number of directions, stratified over the sphere
    int steps = 20;           // steps along each direction
  };
  IsotropicTable(const Medium& medium, const Size& size);

  /// Returns the in-scattered light of orders two and up along a ray [1/sr]; samples as for
  /// MultipleScattering.
  [[nodiscard]] Spectrum InscatterAlong(const RaySamples<float>& samples) const;

  [[nodiscard]] std::uint64_t bytes() const { return texels_.size() * sizeof(float); }

 private:
  /// Light from one direction: of order two, and under radiance 1 from all directions.
  struct Light {
    Spectrum second, series;
  };
  [[nodiscard]] Light GatherFrom(const ViewRay& ray) const;
  void FillTexel(std::size_t row, std::size_t column);

  SingleScattering<float> air_;
  Size size_;
  std::vector<float> texels_;  // [(altitude * side + sun) * bands + band]
};

}  // namespace alpenglow::lut
