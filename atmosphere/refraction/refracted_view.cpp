// SPDX-License-Identifier: MIT
#include "atmosphere/refraction/refracted_view.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/refraction/observer_refraction.h"

namespace alpenglow::atmosphere {
namespace {

constexpr double kHorizontal = 0.5 * kPi;
constexpr int kSkyNodes = 256, kGroundNodes = 128;
constexpr double kLittleMoreDepth_rad = 15.0 * kRadiansPerDegree;
/// Scales on which the tabulated values change slowly between nodes: height and angle of the air
/// near the horizon.
constexpr double kRayLayer_m = 10e3, kWidest_rad = 0.3 * kRadiansPerDegree;

/// Returns the position of a node: x = s (exp(u) - 1), u uniform from 0 to the value of the last
/// node.
double NodePlace(int node, int nodes, double scale, double last) {
  return scale * std::expm1(node * std::log1p(last / scale) / (nodes - 1));
}

/// Returns the nodes between which a position lies: the lower one, and the weight of the upper.
std::pair<std::size_t, double> BetweenLogarithmicNodes(double place, int nodes, double scale,
                                                       double last) {
  const double at =
      (nodes - 1) * std::log1p(std::max(place, 0.0) / scale) / std::log1p(last / scale);
  const int below = std::clamp(static_cast<int>(at), 0, nodes - 2);
  return {static_cast<std::size_t>(below), std::clamp(at - below, 0.0, 1.0)};
}

/// Returns the density of the molecules relative to air at sea level, in the band nearest to
/// kHorizonWavelength_nm, the peak sensitivity of the eye.
double RelativeDensity(const Medium& medium) {
  const auto off = [](double wavelength_nm) {
    return std::abs(wavelength_nm - kHorizonWavelength_nm);
  };
  std::size_t middle = 0;
  for (std::size_t band = 1; band < medium.wavelengths_nm.size(); ++band)
    if (off(medium.wavelengths_nm[band]) < off(medium.wavelengths_nm[middle])) middle = band;
  const double wavelength_nm = std::max(medium.wavelengths_nm[middle], 250.0);
  return medium.rayleigh_scattering_per_m[middle] / RayleighScatteringAtSeaLevel(wavelength_nm);
}

double LookRadius_m(const BendingAir& air, double height_m) {
  const double height = std::max(height_m, 1.0);  // the result hardly changes for lower observers
  const double dip = GrazingElevation(air, height);
  const double sine = std::sin(0.5 * dip);
  return height * std::cos(dip) / (2.0 * sine * sine);
}

// Returns the ratio of the curvature of most rays to distant land to the curvature at the ground,
// fitted to the ray equation for observers from the ground to 36,000 km.
double UsualShare(double height_m, double upper_m, double top_m) {
  if (height_m > top_m) return 0.5 + 0.15 * std::exp(-(height_m - top_m) / (1.6 * upper_m));
  return std::clamp(0.98 - 0.122 * height_m / upper_m, 0.65, 0.9);
}

constexpr int kHeights = 18, kElevations = 40;
constexpr double kTop_m = 40e3;  // a beam that passes above it has met hardly any air
/// Light near the horizon changes over this angle: 10 km of air at 1900 km have the same angular
/// height.
constexpr double kScale = 0.3 * kRadiansPerDegree;
/// The last node is next to the zenith, where the cosine of the elevation is 0.
constexpr double kHighest_rad = 89.9 * kRadiansPerDegree;

double PlaceOf(double mu, double horizon_mu) {
  const double over = std::max(mu - horizon_mu, 0.0);
  return std::log1p(over / kScale) / std::log1p((1.0 - horizon_mu) / kScale);
}

double MuOf(double place, double horizon_mu) {
  return horizon_mu + kScale * std::expm1(place * std::log1p((1.0 - horizon_mu) / kScale));
}

/// Returns the nodes between which a position in [0, 1] lies: the lower one, and the weight of the
/// upper.
std::pair<std::size_t, double> BetweenUniformNodes(double place, int nodes) {
  const double at = place * (nodes - 1);
  const int below = std::clamp(static_cast<int>(at), 0, nodes - 2);
  return {static_cast<std::size_t>(below), std::clamp(at - below, 0.0, 1.0)};
}

/// Returns the logarithm of the apparent solid angle of a small disk at an elevation, divided by
/// its true solid angle.
double LogSpread(const BendingAir& air, double elevation_rad, double height_m) {
  constexpr double kStep_rad = 1e-5;
  const double refraction = RefractionSeenAt(air, elevation_rad, height_m);
  const double slope =
      (RefractionSeenAt(air, elevation_rad + kStep_rad, height_m) - refraction) / kStep_rad;
  return std::log(std::cos(elevation_rad) / std::cos(elevation_rad - refraction) / (1.0 - slope));
}

}  // namespace

BendingAir BendingAirOf(const Medium& medium, double wavelength_nm) {
  const MoleculeDeficit& deficit = medium.rayleigh_deficit;
  const RefractivityLayers of_molecules{{{1.0 + deficit.share, medium.rayleigh_scale_height_m},
                                         {-deficit.share, deficit.scale_height_m},
                                         {0.0, medium.rayleigh_scale_height_m}}};
  return {.refractivity = RelativeDensity(medium) * RefractivityAtSeaLevel(wavelength_nm),
          .layers = medium.refraction == RefractionBy::kAlmanacs ? kAlmanacLayers : of_molecules,
          .top_m = medium.atmosphere_height_m,
          .planet_radius_m = medium.planet_radius_m};
}

BendingAir GentleAirOf(const Medium& medium) { return GentleAirOf(medium, medium.planet_radius_m); }

BendingAir GentleAirOf(const Medium& medium, double planet_radius_m) {
  BendingAir air = BendingAirOf(medium, kHorizonWavelength_nm);
  air.planet_radius_m = planet_radius_m;
  // Testing whether air bends rays gently takes longer than a position of the sun.
  thread_local BendingAir tested, gentle;
  if (!IsSame(tested, air)) {
    tested = gentle = air;
    if (!GentlyBends(air)) gentle.refractivity = 0.0;
  }
  return gentle;
}

RefractedLight RefractedLightOf(const Medium& medium, const BendingAir& air, double elevation_rad,
                                double height_m) {
  RefractedLight light;
  light.refraction_rad = RefractionSeenAt(air, elevation_rad, height_m);
  constexpr double kStep = 1e-2;
  BendingAir thicker = air;
  thicker.refractivity *= 1.0 + kStep;
  if (air.refractivity > 0.0) {
    light.per_refractivity_rad =
        (RefractionSeenAt(thicker, elevation_rad, height_m) - light.refraction_rad) /
        (kStep * air.refractivity);
  }
  if (elevation_rad > kLittleMoreDepth_rad) return light;
  const auto molecules = [&](double h_m) { return MoleculeDensity(medium, h_m); };
  const auto aerosol = [&](double h_m) { return std::exp(-h_m / medium.mie_scale_height_m); };
  BendingAir still = air;
  still.refractivity = 0.0;
  const RefractedRay bent(air, elevation_rad, height_m), straight(still, elevation_rad, height_m);
  light.molecules_m = bent.ColumnToSpace(molecules) - straight.ColumnToSpace(molecules);
  light.aerosol_m = bent.ColumnToSpace(aerosol) - straight.ColumnToSpace(aerosol);
  return light;
}

RefractedView::RefractedView(const Medium& medium, double height_m)
    : air_(GentleAirOf(medium)), height_m_(std::max(height_m, 0.0)) {
  const double of_molecules = air_.refractivity / RefractivityAtSeaLevel(kHorizonWavelength_nm);
  for (std::size_t band = 0; band < medium.wavelengths_nm.size(); ++band) {
    more_refractivity_.push_back(
        of_molecules * RefractivityAtSeaLevel(medium.wavelengths_nm[band]) - air_.refractivity);
    molecules_per_m_.push_back(medium.rayleigh_scattering_per_m[band]);
    aerosol_per_m_.push_back(medium.mie_extinction_per_m[band]);
  }
  horizon_rad_ = GrazingElevation(air_, height_m_);
  const double away_m = std::sqrt(height_m_ * (2.0 * air_.planet_radius_m + height_m_));
  sky_scale_rad_ = std::min(kWidest_rad, kRayLayer_m / std::max(away_m, 1.0));
  ground_scale_rad_ = std::clamp(-horizon_rad_, 1e-5, kWidest_rad);
  for (int i = 0; i < kSkyNodes; ++i) {
    const double over = NodePlace(i, kSkyNodes, sky_scale_rad_, kHorizontal - horizon_rad_);
    sky_.push_back(RefractedLightOf(medium, air_, horizon_rad_ + over, height_m_));
  }
  const double at_ground_m = (1.0 + air_.refractivity) * air_.planet_radius_m;
  const double at_eye_m =
      (1.0 + RefractivityAt(air_, height_m_)) * (air_.planet_radius_m + height_m_);
  for (int i = 0; i < kGroundNodes; ++i) {
    const double at_ground = NodePlace(i, kGroundNodes, ground_scale_rad_, kHorizontal);
    // The observer's elevation follows from the elevation at the ground by their common invariant.
    const double elevation =
        -std::acos(std::min(std::cos(at_ground) * at_ground_m / at_eye_m, 1.0));
    const RefractedRay ray(air_, elevation, height_m_);
    bending_.push_back(ray.Bending(at_ground, std::min(-elevation, ray.ElevationAt(air_.top_m))));
  }
}

RefractedView::Node RefractedView::At(double elevation_rad) const {
  const auto [below, share] = BetweenLogarithmicNodes(elevation_rad - horizon_rad_, kSkyNodes,
                                                      sky_scale_rad_, kHorizontal - horizon_rad_);
  const Node &a = sky_[below], &b = sky_[below + 1];
  const auto between = [&, share = share](double Node::*of) {
    return a.*of + share * (b.*of - a.*of);
  };
  return {between(&Node::refraction_rad), between(&Node::per_refractivity_rad),
          between(&Node::molecules_m), between(&Node::aerosol_m)};
}

double RefractedView::TrueElevation(double elevation_rad, std::size_t band) const {
  const Node node = At(elevation_rad);
  return elevation_rad - node.refraction_rad - more_refractivity_[band] * node.per_refractivity_rad;
}

double RefractedView::TrueElevation(double elevation_rad) const {
  return elevation_rad - At(elevation_rad).refraction_rad;
}

double RefractedView::ApparentElevationOf(double true_elevation_rad) const {
  const double on_horizon = At(horizon_rad_).refraction_rad;
  if (true_elevation_rad <= horizon_rad_ - on_horizon) return horizon_rad_;
  const auto error = [&](double elevation) {
    return TrueElevation(elevation) - true_elevation_rad;
  };
  return BracketedRoot(error, std::max(true_elevation_rad, horizon_rad_),
                       true_elevation_rad + on_horizon + 1e-9, 1e-10);
}

double RefractedView::LiftedElevationOf(double true_elevation_rad) const {
  const double below_rad = TrueElevation(horizon_rad_) - true_elevation_rad;
  return ApparentElevationOf(true_elevation_rad) - std::max(below_rad, 0.0);
}

double RefractedView::MoreOpticalDepth(double elevation_rad, std::size_t band) const {
  const Node node = At(elevation_rad);
  return molecules_per_m_[band] * node.molecules_m + aerosol_per_m_[band] * node.aerosol_m;
}

std::optional<RefractedGroundRay> RefractedView::ToGround(double elevation_rad) const {
  if (elevation_rad >= horizon_rad_) return std::nullopt;
  const double at_ground = RefractedRay(air_, elevation_rad, height_m_).ElevationAt(0.0);
  const auto [below, share] =
      BetweenLogarithmicNodes(at_ground, kGroundNodes, ground_scale_rad_, kHorizontal);
  const double bending = bending_[below] + share * (bending_[below + 1] - bending_[below]);
  return RefractedGroundRay{-elevation_rad - at_ground + bending, at_ground};
}

LandBend LandBendOf(const BendingAir& air, double height_m) {
  const double height = std::max(height_m, 0.0);
  const double upper_m = air.UpperScaleHeight();
  LandBend bend{air.planet_radius_m / kMetresPerKilometre,
                LookRadius_m(air, height) / kMetresPerKilometre,
                std::min(4.1 * upper_m, air.top_m) / kMetresPerKilometre,
                0.0,
                {},
                {}};
  for (std::size_t i = 0; i < air.layers.size(); ++i) {
    const auto& [share, scale_height_m] = air.layers[i];
    bend.slope_per_km[i] = air.refractivity * share * kMetresPerKilometre / scale_height_m;
    bend.fall_per_km[i] = kMetresPerKilometre / scale_height_m;
  }
  bend.usual_per_km =
      UsualShare(height, upper_m, bend.top_km * kMetresPerKilometre) * bend.MostCurvature();
  return bend;
}

double LiftOfLand(const LandBend& bend, double eye_m, double place_m, double distance_m) {
  const auto& slope = bend.slope_per_km;
  const auto& fall = bend.fall_per_km;
  return shared::LandLift<double>(std::max(eye_m, 0.0) / kMetresPerKilometre,
                                  place_m / kMetresPerKilometre, distance_m / kMetresPerKilometre,
                                  bend.radius_km, bend.top_km, bend.usual_per_km, slope[0],
                                  slope[1], slope[2], fall[0], fall[1], fall[2]);
}

double MostLiftOfPlanet(const LandBend& bend, double eye_m, double farthest_land_m) {
  const double eye_km = std::max(eye_m, 0.0) / kMetresPerKilometre;
  const double horizon_rad = std::asin(shared::HorizonCosine(eye_km, bend.look_radius_km)) -
                             std::asin(shared::HorizonCosine(eye_km, bend.radius_km));
  return std::max(horizon_rad, LiftOfLand(bend, eye_m, 0.0, farthest_land_m));
}

RefractedBeam::RefractedBeam(const Medium& medium)
    : bands_(medium.wavelengths_nm.size()),
      top_m_(std::min(medium.atmosphere_height_m, kTop_m)),
      molecules_per_m_(medium.rayleigh_scattering_per_m),
      aerosol_per_m_(medium.mie_extinction_per_m) {
  const BendingAir air = GentleAirOf(medium);
  if (air.refractivity == 0.0) return;
  const SingleScattering<double> straight(medium);
  rows_.resize(kHeights);
  oneapi::tbb::parallel_for(0, kHeights, [&](int i) {
    const double share = static_cast<double>(i) / (kHeights - 1);
    rows_[static_cast<std::size_t>(i)] = RowAt(straight, air, share * share * top_m_);
  });
}

RefractedBeam::Row RefractedBeam::RowAt(const SingleScattering<double>& straight,
                                        const BendingAir& air, double height_m) {
  const Medium& medium = straight.medium();
  const auto densities = [&](double h_m) {
    return glm::dvec2(MoleculeDensity(medium, h_m), std::exp(-h_m / medium.mie_scale_height_m));
  };
  Row row{std::sin(GrazingElevation(air, height_m)), {}};
  for (int i = 0; i < kElevations; ++i) {
    const double mu = MuOf(static_cast<double>(i) / (kElevations - 1), row.horizon_mu);
    const double elevation = std::min(std::asin(std::min(mu, 1.0)), kHighest_rad);
    const std::array<double, 3> less = straight.ColumnsToSpace(height_m, std::sin(elevation));
    row.nodes.push_back({RefractedRay(air, elevation, height_m).ColumnToSpace(densities) -
                             glm::dvec2(less[0], less[1]),
                         LogSpread(air, elevation, height_m)});
  }
  return row;
}

RefractedBeam::Node RefractedBeam::At(double altitude_m, double mu) const {
  const auto mix = [](const auto& a, const auto& b, double share) { return a + share * (b - a); };
  const double height = std::clamp(altitude_m / top_m_, 0.0, 1.0);
  const auto [row, up] = BetweenUniformNodes(std::sqrt(height), kHeights);
  const Row &low = rows_[row], &high = rows_[row + 1];
  const auto [node, right] =
      BetweenUniformNodes(PlaceOf(mu, mix(low.horizon_mu, high.horizon_mu, up)), kElevations);
  const auto in = [&, node = node, right = right](const Row& of) {
    const Node &a = of.nodes[node], &b = of.nodes[node + 1];
    return Node{mix(a.more_m, b.more_m, right), mix(a.log_spread, b.log_spread, right)};
  };
  const Node below = in(low), above = in(high);
  return {mix(below.more_m, above.more_m, up), mix(below.log_spread, above.log_spread, up)};
}

Spectrum RefractedBeam::OverStraight(double altitude_m, double mu) const {
  Spectrum over(bands_);
  const Node node = rows_.empty() ? Node{glm::dvec2(0.0), 0.0} : At(altitude_m, mu);
  for (std::size_t band = 0; band < bands_; ++band) {
    const double more =
        molecules_per_m_[band] * node.more_m[0] + aerosol_per_m_[band] * node.more_m[1];
    over[band] = static_cast<float>(std::exp(node.log_spread - more));
  }
  return over;
}

Spectrum RefractedBeam::Left(const SingleScattering<float>& air, double altitude_m,
                             double mu) const {
  Spectrum left = air.TransmittanceToSpace(altitude_m, mu);
  const Spectrum over = OverStraight(altitude_m, mu);
  for (std::size_t band = 0; band < bands_; ++band) left[band] *= over[band];
  return left;
}

}  // namespace alpenglow::atmosphere
