// SPDX-License-Identifier: MIT
// This header computes the light that fog scatters, to all orders, under sun and sky. Fog is a
// level layer over the lowest ground.
//
// EddingtonSlab computes multiple scattering in a plane layer: Eddington's approximation, with the
// forward peak removed from the scattering.
//
//   I(tau, mu) = I0(tau) + I1(tau) mu                     mu > 0 downwards
//   dI1/dtau / 3 = -(1 - w) I0 + w S / 4 pi  e^(-tau / mu0)
//   dI0/dtau     = -(1 - w g) I1 + 3 w g mu0 S / 4 pi  e^(-tau / mu0)
//
// The boundary conditions are no diffuse light from above, and the ground's reflection from below.
// The forward peak is removed by
//
//   tau' = (1 - w f) tau,   w' = w (1 - f) / (1 - w f),   g' = (g - f) / (1 - f),   f = chi_2
//
// at most g, and 0 if g < 0, because a lobe that scatters backwards has no forward peak:
//
// Joseph, Wiscombe, Weinman (1976), "The delta-Eddington approximation for radiative flux
// transfer", J. Atmos. Sci. 33, 2452. For the layer, see Shettle and Weinman (1970), J. Atmos. Sci.
// 27, 1048.
//
// Radiances follow from this solution. The first order is exact, except for light in the forward
// peak, which is scattered by a lobe with the same mean cosine; higher orders are w (I0 + chi_1 I1
// mu). Compared with a path tracer, over layers of optical depth 0.5 to 8 with g = 0.8, the sun at
// 9 and 37 degrees and a view from outside, the relative error is 0.35 root mean square; the result
// is 0.4 to 2.5 of the value at worst (tests/renderer/media/eddington_slab_test.cpp). It
// approximates the light that single scattering omits where that is most of the light.
//
// FogLight evaluates
//
//   J = w [ p(cos) S e^-tau_s                      sun: first order
//         + p'(cos) S (e^-tau_s' - e^-tau_s)       sun: light in the forward peak
//         + sum chi_l L_lm Y_lm  e^(-tau' / 0.6)   sky: first order
//         + I0 + chi_1 I1 mu ]                     all higher orders (EddingtonSlab)
//
// with the optical depth tau_s towards the sun, tau' without the forward peak, and a lobe p' with
// the same mean cosine as p. Light that the ground reflects under a clear sky is removed from the
// moments L_lm, because the layer has its own ground.
//
// A FogMap holds FogLight summed along rays, for interpolation on the GPU. Values are per unit
// solar irradiance. Along a ray they are relative to the fraction of light that the fog removes,
//
//   L(d) = (1 - T(d)) [p A + p' B + G + K],    T = exp(-tau(d)), of the fog alone
//
// A is the light of the sun itself, scattered with the fog's phase function p; B is the light in
// its forward peak, scattered with the lobe p'; G is the glow of the sun in the fog; K is the light
// of the sky. Tables are over the sine of the ray's elevation, its azimuth from the sun and
// (1 - T(d)) / (1 - T(end)), where the ray ends at the bare planet or in space. A, B and G are for
// open ground: terrain does not shade them.
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "lut/multiple_scattering/solved_air.h"
#include "renderer/illumination/lighting.h"
#include "renderer/illumination/occluded_sky.h"
#include "renderer/media/local_media.h"

namespace alpenglow::renderer {

/// Scattering properties of a layer.
struct SlabScattering {
  double albedo = 1.0;  // w, [0, 1]
  double chi_1 = 0.0;   // mean cosine of the phase function
  double chi_2 = 0.0;   // its second Legendre coefficient, < 1
};

/// The diffuse field at a depth.
struct SlabField {
  double mean = 0.0;   // I0: mean radiance over all directions
  double slope = 0.0;  // I1: slope of the radiance in mu

  [[nodiscard]] double DownwardFlux() const;
  [[nodiscard]] double UpwardFlux() const;
};

/// A plane layer lit by a beam of unit irradiance perpendicular to the beam. Immutable.
class EddingtonSlab {
 public:
  /// @param depth  vertical optical depth of the layer, >= 0.
  /// @param ground_albedo  in [0, 1].
  /// @param mu0  cosine between the beam and the vertical, in (0, 1].
  EddingtonSlab(const SlabScattering& scattering, double depth, double ground_albedo, double mu0);

  /// Returns the diffuse field. Fluxes of layers lit from above are within 0.06 of the incident
  /// flux of a path tracer (tests/renderer/media/eddington_slab_test.cpp).
  /// @param depth  below the top of the layer, clamped to it.
  [[nodiscard]] SlabField At(double depth) const;

  /// Returns the transmittance of the beam over a slant depth, including the light in the forward
  /// peak.
  [[nodiscard]] double BeamLeft(double slant_depth) const;

 private:
  double depth_;                       // scaled, like all members below
  double scale_, mu0_;                 // factor on depths; cosine of the beam
  double k_ = 0.0, slope_of_k_ = 0.0;  // I1 of e^(-k tau), relative to I0
  double particular_ = 0.0, particular_slope_ = 0.0;
  double falling_ = 0.0, rising_ = 0.0;  // factors of e^(-k tau) and e^(-k (depth - tau))
};

/// Light scattered by fog for one position of the sun, per unit solar irradiance. Immutable. Refers
/// to the fog.
class FogLight {
 public:
  /// @param fog  a LocalMedium that is fog.
  /// @param in_air  transmittance of the air at the fog for the light, while it is above the horizon.
  /// @param bottom_m  altitude of the ground below it.
  FogLight(const LocalMedium& fog, const MultipleScattering& diffuse, const LightDirection& light,
           const BandLight& in_air, double bottom_m);

  /// Precomputed values of a ray through the fog.
  struct Look {
    double phase, broad_phase;   // p and p' towards the sun [1/sr]
    double down;                 // downward cosine of the arriving light: the look's zenith cosine
    std::vector<BandLight> sky;  // SkyMoments::Towards
  };
  [[nodiscard]] Look LookAlong(const glm::dvec3& look) const;

  /// Returns the light scattered per unit of scattering [1/sr]: from the sun with its glow in the
  /// fog, and from the sky.
  /// @param sun  transmittance of air, terrain and volumes for sunlight.
  /// @param lit  the same without the air, in [0, 1].
  /// @param slant_depth  of the fog towards the sun.
  struct Scattered {
    BandLight of_sun, of_sky;
  };
  [[nodiscard]] Scattered At(const Look& look, double altitude_m, const BandLight& sun,
                             const BandLight& lit, double slant_depth) const;

  /// Return the transmittance of skylight from above to an altitude, and of a beam over a slant
  /// depth; both include the light in the forward peak.
  [[nodiscard]] float SkyLeft(double altitude_m) const;
  [[nodiscard]] float BeamLeft(double slant_depth) const;

  /// Returns the irradiance of a surface by the fog's own light [1].
  /// @param cos_up  of its normal's zenith angle.
  [[nodiscard]] BandLight OnSurface(double altitude_m, double cos_up) const;

 private:
  struct Glow {
    std::vector<BandLight> mean, slope;  // at depth (i / last)^4 of the layer's [1/sr]
  };
  struct Place {
    std::size_t low;
    float share;
  };
  [[nodiscard]] double DepthAbove(double altitude_m) const;
  [[nodiscard]] Place PlaceOf(double altitude_m) const;
  [[nodiscard]] static BandLight At(const std::vector<BandLight>& nodes, const Place& place);
  /// Returns the diffuse light scattered at a place, at least 0.
  /// @param tilt  the mean cosine of the phase function times Look::down.
  [[nodiscard]] static BandLight Field(const Glow& glow, const Place& place, float tilt);
  void Solve(double albedo, double mu0, const BandLight& sun, const BandLight& sky,
             const std::vector<double>& ground_albedo);

  const LocalMedium& fog_;
  glm::dvec3 to_light_;
  std::vector<double> chi_;
  PhaseFunction broad_;
  double extinction_per_m_, depth_;
  double peak_scale_;  // scales optical depths to exclude the forward peak
  SkyMoments sky_;     // without the ground
  BandLight ground_;   // radiance of the ground under a clear sky
  Glow of_sun_, of_sky_;
};

/// Resolution of a map. Its mean difference from MediaLight is 0.1 % by day and 0.5 % with the sun
/// on the horizon, where light in fog decreases by a factor e every few metres (99 %: 2 % and 5 %;
/// kFineFog: half of all these). The computation time is proportional to elevations times azimuths.
struct FogMapSize {
  int elevations = 128;  // even: half of them above the horizon
  int azimuths = 16;     // from 0 to pi
  int depths = 12;

  bool operator==(const FogMapSize&) const = default;
};
inline constexpr FogMapSize kCoarseFog{48, 12, 8};
inline constexpr FogMapSize kFineFog{192, 24, 16};

/// Eye of a map and the light over it, the sun or the moon, in the frame east, north, up at the eye,
/// on the sphere of the air's medium.
struct FogView {
  double altitude_m = 0.0;
  LightDirection light = Unrefracted({0.0, 0.0, 1.0});
  double radius_rad = 0.0046;  // of its disk
};

/// Table of the light in fog. It is immutable and needs no GPU.
struct FogMap {
  FogView view;
  FogMapSize size;
  /// A, B, G and K in this order: [((quantity * depths + depth) * azimuths + azimuth) * elevations
  /// + elevation].
  std::vector<glm::vec4> light;
  /// Irradiance of the fog's own light on level ground, and the additional irradiance on a vertical
  /// surface, at altitudes with an optical depth above of (i / last)^4 of the layer's: [row *
  /// kHeights + i]. W/m^2 per W/m^2.
  static constexpr int kHeights = 64;
  std::vector<glm::vec4> on_surface;
  double extinction_per_m, scale_height_m, base_m, top_m, radius_m;
  double depth;       // vertical optical depth of the layer
  double peak_scale;  // factor on optical depths that excludes the forward peak
  PhaseFunction phase;
  double broad_g;
};

/// @param fog  fog of LocalMedia; bottom_m: altitude of the ground below it.
/// @param air  medium of at most four bands.
/// tests/viewer/lamps/fog_map_test.cpp bounds the errors of rays against MediaLight.
[[nodiscard]] FogMap MakeFogMap(const LocalMedium& fog, double bottom_m, const SolvedAir& air,
                                const FogView& view, const FogMapSize& size = {});

/// Returns whether the map of one eye and sun is valid for others, to a few per cent: the eye is
/// within a tenth of the fog's scale height, at most 100 m, and the sun within a tenth of a degree.
/// Quantities that vary faster, transmittance and the phase function towards the sun, are not in
/// the map.
[[nodiscard]] bool Serves(const FogView& made, const FogView& wanted, double scale_height_m);

}  // namespace alpenglow::renderer
