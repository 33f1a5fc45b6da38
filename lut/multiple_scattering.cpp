// SPDX-License-Identifier: MIT
#include "lut/multiple_scattering.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec4.hpp>

#include "atmosphere/constants.h"
#include "atmosphere/error.h"
#include "atmosphere/quadrature.h"
#include "atmosphere/shell.h"

namespace alpenglow {
namespace {

constexpr std::size_t kLanes = 4;  // bands are solved four at a time

std::size_t MomentCount(int degree) {
  return static_cast<std::size_t>((degree + 1) * (degree + 2) / 2);
}

// Catmull-Rom weights for four neighbours of a position on a uniform grid of n nodes; the outermost
// neighbours are mirrored at the ends (first-order extrapolation keeps it linear there).
struct CubicTaps {
  std::array<std::size_t, 4> node;
  std::array<float, 4> weight;
};

CubicTaps TapsAt(double coordinate, int n) {
  const double position = std::clamp(coordinate, 0.0, 1.0) * (n - 1);
  const int cell = std::min(static_cast<int>(position), n - 2);
  const double t = position - cell;
  const std::array<double, 4> weight{
      0.5 * (-t + 2 * t * t - t * t * t), 0.5 * (2 - 5 * t * t + 3 * t * t * t),
      0.5 * (t + 4 * t * t - 3 * t * t * t), 0.5 * (-t * t + t * t * t)};
  CubicTaps taps{};
  std::array<double, 4> adjusted = weight;
  if (cell == 0) {  // node -1 is 2 f0 - f1
    adjusted = {0.0, weight[1] + 2 * weight[0], weight[2] - weight[0], weight[3]};
  }
  if (cell == n - 2) {  // node n is 2 f(n-1) - f(n-2)
    adjusted[1] -= weight[3];
    adjusted[2] += 2 * weight[3];
    adjusted[3] = 0.0;
  }
  for (int i = 0; i < 4; ++i) {
    const auto slot = static_cast<std::size_t>(i);
    taps.node[slot] = static_cast<std::size_t>(std::clamp(cell - 1 + i, 0, n - 1));
    taps.weight[slot] = static_cast<float>(adjusted[slot]);
  }
  return taps;
}

// Y_lm = norm_lm P_l^m(mu) cos(m phi): the norms, and the associated Legendre functions without the
// Condon-Shortley phase (the sign cancels between projection and evaluation).
struct HarmonicNorms {
  std::array<float, kMaxMoments> norm{};
  HarmonicNorms() {
    std::size_t index = 0;
    for (int l = 0; l <= kMaxDegree; ++l) {
      for (int m = 0; m <= l; ++m, ++index) {
        double ratio = 1.0;  // (l - m)! / (l + m)!
        for (int k = l - m + 1; k <= l + m; ++k) ratio /= k;
        norm[index] =
            static_cast<float>(std::sqrt((m == 0 ? 1.0 : 2.0) * (2 * l + 1) / (4.0 * kPi) * ratio));
      }
    }
  }
};

std::size_t MomentIndex(int l, int m) { return static_cast<std::size_t>(l * (l + 1) / 2 + m); }

// norm_lm P_l^m(mu) for all l, m.
std::array<float, kMaxMoments> LegendreTerms(int degree, float mu) {
  static const HarmonicNorms norms;
  std::array<float, kMaxMoments> p{};
  const float sine = std::sqrt(std::max((1.0F - mu) * (1.0F + mu), 0.0F));
  float diagonal = 1.0F;
  for (int m = 0; m <= degree; ++m) {
    p[MomentIndex(m, m)] = diagonal;
    if (m < degree) p[MomentIndex(m + 1, m)] = mu * static_cast<float>(2 * m + 1) * diagonal;
    for (int l = m + 2; l <= degree; ++l) {
      p[MomentIndex(l, m)] = (static_cast<float>(2 * l - 1) * mu * p[MomentIndex(l - 1, m)] -
                              static_cast<float>(l + m - 1) * p[MomentIndex(l - 2, m)]) /
                             static_cast<float>(l - m);
    }
    diagonal *= static_cast<float>(2 * m + 1) * sine;
  }
  for (std::size_t i = 0; i < MomentCount(degree); ++i) p[i] *= norms.norm[i];
  return p;
}

// cos(m phi), m = 0 ... degree.
std::array<float, kMaxDegree + 1> CosineMultiples(int degree, float cosine) {
  std::array<float, kMaxDegree + 1> values{};
  values[0] = 1.0F;
  if (degree >= 1) values[1] = cosine;
  for (std::size_t m = 2; m <= static_cast<std::size_t>(degree); ++m) {
    values[m] = 2.0F * cosine * values[m - 1] - values[m - 2];
  }
  return values;
}

// Cosine of the azimuth between view and sun from the three cosines; any value at the poles.
float AzimuthCosine(float mu, float mu_s, float nu) {
  const float sines =
      std::sqrt(std::max((1.0F - mu) * (1.0F + mu) * (1.0F - mu_s) * (1.0F + mu_s), 1e-12F));
  return std::clamp((nu - mu * mu_s) / sines, -1.0F, 1.0F);
}

/// One direction of the angular grid at a node.
struct Direction {
  double mu;
  double weight;  // of mu; the azimuth's is constant
};

// Gauss nodes above and below the horizon, dense near it (mu - horizon = range v^2).
std::vector<Direction> DirectionsAt(double altitude_km, double radius_km, int nodes) {
  const double horizon = shared::HorizonCosine<double>(altitude_km, radius_km);
  const GaussRule& rule = GaussLegendre(nodes);
  std::vector<Direction> directions;
  for (const double end : {-1.0, 1.0}) {
    for (std::size_t k = 0; k < rule.node.size(); ++k) {
      const double v = rule.node[k];
      directions.push_back(
          {horizon + (end - horizon) * v * v, std::abs(end - horizon) * 2.0 * v * rule.weight[k]});
    }
  }
  return directions;
}

}  // namespace

std::vector<double> LegendreCoefficients(const PhaseFunction& phase, int degree) {
  // Panels shrink towards the forward peak (1 - x = 2 q^k), so that g = 0.999 is resolved.
  std::vector<double> chi(static_cast<std::size_t>(degree) + 1, 0.0);
  const GaussRule& rule = GaussLegendre(32);
  std::vector<double> edges{-1.0, 0.0};
  for (double gap = 0.5; gap > 1e-9; gap *= 0.5) edges.push_back(1.0 - gap);
  edges.push_back(1.0);
  for (std::size_t panel = 0; panel + 1 < edges.size(); ++panel) {
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      const double x = edges[panel] + (edges[panel + 1] - edges[panel]) * rule.node[i];
      const double weight =
          2.0 * kPi * rule.weight[i] * (edges[panel + 1] - edges[panel]) * Phase(phase, x);
      double before = 0.0, now = 1.0;
      for (std::size_t l = 0; l < chi.size(); ++l) {
        chi[l] += weight * now;
        const double next =
            ((2.0 * static_cast<double>(l) + 1.0) * x * now - static_cast<double>(l) * before) /
            (static_cast<double>(l) + 1.0);
        before = now;
        now = next;
      }
    }
  }
  return chi;
}

std::array<float, kMaxMoments> SphericalHarmonics(int degree, float mu, float cos_azimuth) {
  std::array<float, kMaxMoments> y = LegendreTerms(degree, mu);
  const auto cosines = CosineMultiples(degree, cos_azimuth);
  for (int l = 0; l <= degree; ++l) {
    for (int m = 0; m <= l; ++m) y[MomentIndex(l, m)] *= cosines[static_cast<std::size_t>(m)];
  }
  return y;
}

double DiffuseLight::SunCoordinate(double mu_s) {
  const double low = std::asinh((kLowestMuS - kSunCentre) / kSunWidth);
  const double high = std::asinh((1.0 - kSunCentre) / kSunWidth);
  return std::clamp((std::asinh((mu_s - kSunCentre) / kSunWidth) - low) / (high - low), 0.0, 1.0);
}

double DiffuseLight::MuSFromCoordinate(double v) {
  const double low = std::asinh((kLowestMuS - kSunCentre) / kSunWidth);
  const double high = std::asinh((1.0 - kSunCentre) / kSunWidth);
  return std::clamp(kSunCentre + kSunWidth * std::sinh(low + (high - low) * v), -1.0, 1.0);
}

/// Successive orders for one block of four bands.
class DiffuseLightSolver {
 public:
  DiffuseLightSolver(DiffuseLight& result, std::size_t first_band);

  // Adds the block's bands to the result's values.
  void Solve();

 private:
  using Light = glm::vec4;  // one value per band of the block

  // Moments and sky irradiance at every node: [(altitude * sun_angles + sun) * channels + channel].
  using Field = std::vector<Light>;

  // What the march along one direction of one altitude needs, whatever the sun: at each sample the
  // taps in altitude, the source's factors, and the geometry of the local angles.
  struct MarchSample {
    CubicTaps altitude;
    Light rayleigh, mie;  // sigma T weight
    float distance_km, radius_km, mu;
  };
  struct March {
    double mu;
    double weight;
    std::vector<MarchSample> samples;
    bool hits_ground = false;
    float ground_distance_km = 0.0F;
    Light ground_transmittance{0.0F};
  };

  Light BlockOf(const Bands<float>& bands) const;
  Light BlockOf(const std::vector<double>& bands) const;
  March PrepareMarch(std::size_t altitude, const Direction& direction) const;
  void FirstOrder(std::size_t altitude, Field& field) const;
  void NextOrder(std::size_t altitude, const Field& previous, Field& field) const;
  void Project(std::size_t altitude, std::size_t sun, const March& march, float cos_azimuth,
               const Light& radiance, Field& field) const;
  Light GroundRadiance(const March& march, const Field& field, double mu_s_ground) const;
  double LargestShare(const Field& part, const Field& whole) const;

  DiffuseLight& result_;
  const Medium& medium_;
  AirIntegrator<float> air_;
  std::size_t first_band_, altitudes_, suns_, channels_;
  int degree_;
  double radius_km_;
  std::vector<float> azimuth_cosines_;
  std::vector<double> altitude_km_;
  std::vector<double> mu_s_;
  std::vector<std::vector<March>> marches_;  // [altitude][direction]
  Light albedo_;
};

DiffuseLightSolver::DiffuseLightSolver(DiffuseLight& result, std::size_t first_band)
    : result_(result),
      medium_(result.medium_),
      air_(result.medium_),
      first_band_(first_band),
      altitudes_(static_cast<std::size_t>(result.options_.altitudes)),
      suns_(static_cast<std::size_t>(result.options_.sun_angles)),
      channels_(result.channels()),
      degree_(result.options_.degree),
      radius_km_(result.medium_.planet_radius_m / 1000.0),
      albedo_(BlockOf(result.medium_.ground_albedo)) {
  for (int k = 0; k < result.options_.azimuth_nodes; ++k) {
    azimuth_cosines_.push_back(static_cast<float>(
        std::cos((k + 0.5) * kPi / static_cast<double>(result.options_.azimuth_nodes))));
  }
  for (std::size_t i = 0; i < altitudes_; ++i) {
    const double u = static_cast<double>(i) / static_cast<double>(altitudes_ - 1);
    altitude_km_.push_back(medium_.atmosphere_height_m / 1000.0 * u * u);
  }
  for (std::size_t j = 0; j < suns_; ++j) {
    mu_s_.push_back(
        DiffuseLight::MuSFromCoordinate(static_cast<double>(j) / static_cast<double>(suns_ - 1)));
  }
  marches_.resize(altitudes_);
  for (std::size_t i = 0; i < altitudes_; ++i) {
    for (const Direction& direction :
         DirectionsAt(altitude_km_[i], radius_km_, result.options_.zenith_nodes)) {
      marches_[i].push_back(PrepareMarch(i, direction));
    }
  }
}

DiffuseLightSolver::Light DiffuseLightSolver::BlockOf(const Bands<float>& bands) const {
  Light block(0.0F);
  for (std::size_t lane = 0; lane < kLanes && first_band_ + lane < bands.count; ++lane) {
    block[static_cast<int>(lane)] = bands[first_band_ + lane];
  }
  return block;
}

DiffuseLightSolver::Light DiffuseLightSolver::BlockOf(const std::vector<double>& bands) const {
  Light block(0.0F);
  for (std::size_t lane = 0; lane < kLanes && first_band_ + lane < bands.size(); ++lane) {
    block[static_cast<int>(lane)] = static_cast<float>(bands[first_band_ + lane]);
  }
  return block;
}

DiffuseLightSolver::March DiffuseLightSolver::PrepareMarch(std::size_t altitude,
                                                           const Direction& direction) const {
  March march{
      direction.mu, direction.weight * kPi / static_cast<double>(azimuth_cosines_.size()), {}};
  // With the sun in the zenith no part of the ray is in shadow: one set of panels serves every sun.
  const ViewRay ray{altitude_km_[altitude] * 1000.0, direction.mu, 1.0, direction.mu};
  const RaySamples<float> samples = air_.Sample(
      ray, {.nodes = result_.options_.ray_nodes, .split_ozone = false, .dark_samples = true});
  const Light rayleigh = BlockOf(medium_.rayleigh_scattering_per_m) * 1000.0F;
  const Light mie_scattering = BlockOf(medium_.mie_scattering_per_m) * 1000.0F;
  const Light mie_extinction = BlockOf(medium_.mie_extinction_per_m) * 1000.0F;
  const Light ozone = BlockOf(medium_.ozone_absorption_per_m) * 1000.0F;
  for (std::size_t s = 0; s < samples.count; ++s) {
    const Light tau = rayleigh * samples.view_rayleigh[s] + mie_extinction * samples.view_mie[s] +
                      ozone * samples.view_ozone[s];
    const Light light = samples.weight[s] * glm::vec4(std::exp(-tau.x), std::exp(-tau.y),
                                                      std::exp(-tau.z), std::exp(-tau.w));
    const double u =
        std::sqrt(static_cast<double>(samples.altitude[s]) * 1000.0 / medium_.atmosphere_height_m);
    march.samples.push_back({TapsAt(u, result_.options_.altitudes),
                             light * rayleigh * samples.rayleigh_density[s],
                             light * mie_scattering * samples.mie_density[s], samples.distance[s],
                             static_cast<float>(radius_km_) + samples.altitude[s], samples.mu[s]});
  }
  march.hits_ground = samples.extent.end == RayEnd::kGround;
  if (march.hits_ground) {
    march.ground_distance_km = static_cast<float>(samples.extent.end_m / 1000.0);
    march.ground_transmittance = BlockOf(air_.TransmittanceAlong(ray));
  }
  return march;
}

void DiffuseLightSolver::Project(std::size_t altitude, std::size_t sun, const March& march,
                                 float cos_azimuth, const Light& radiance, Field& field) const {
  const auto harmonics = SphericalHarmonics(degree_, static_cast<float>(march.mu), cos_azimuth);
  // Azimuth runs over half a turn; the other half is its mirror image.
  const Light light = radiance * static_cast<float>(2.0 * march.weight);
  Light* node = &field[(altitude * suns_ + sun) * channels_];
  for (std::size_t i = 0; i + 1 < channels_; ++i) node[i] += light * harmonics[i];
  if (march.mu > 0.0) node[channels_ - 1] += light * static_cast<float>(march.mu);
}

// Sunlight scattered once, and reflected by the ground, in every direction at the nodes of one
// altitude.
void DiffuseLightSolver::FirstOrder(std::size_t altitude, Field& field) const {
  const Sampling sampling{
      .nodes = result_.options_.ray_nodes, .split_ozone = false, .dark_samples = false};
  const double r = radius_km_ + altitude_km_[altitude];
  for (std::size_t j = 0; j < suns_; ++j) {
    const double sun_sine = std::sqrt((1.0 - mu_s_[j]) * (1.0 + mu_s_[j]));
    for (const March& march : marches_[altitude]) {
      const double sine = std::sqrt((1.0 - march.mu) * (1.0 + march.mu));
      for (const float cosine : azimuth_cosines_) {
        const double nu = std::clamp(
            march.mu * mu_s_[j] + sine * sun_sine * static_cast<double>(cosine), -1.0, 1.0);
        const ViewRay ray{altitude_km_[altitude] * 1000.0, march.mu, mu_s_[j], nu};
        Light radiance = BlockOf(air_.Inscatter(air_.Scatter(air_.Sample(ray, sampling)), nu));
        const double mu_s_ground =
            (r * mu_s_[j] + static_cast<double>(march.ground_distance_km) * nu) / radius_km_;
        if (march.hits_ground && mu_s_ground > 0.0) {
          radiance += march.ground_transmittance * albedo_ *
                      static_cast<float>(std::min(mu_s_ground, 1.0) / kPi) *
                      BlockOf(air_.TransmittanceToSpace(0.0, std::min(mu_s_ground, 1.0)));
        }
        Project(altitude, j, march, cosine, radiance, field);
      }
    }
  }
}

// Light of the previous order that the ground reflects into the march.
DiffuseLightSolver::Light DiffuseLightSolver::GroundRadiance(const March& march, const Field& field,
                                                             double mu_s_ground) const {
  const CubicTaps taps =
      TapsAt(DiffuseLight::SunCoordinate(mu_s_ground), result_.options_.sun_angles);
  Light irradiance(0.0F);
  for (std::size_t tap = 0; tap < 4; ++tap) {
    irradiance += taps.weight[tap] * field[taps.node[tap] * channels_ + channels_ - 1];
  }
  return march.ground_transmittance * albedo_ * glm::max(irradiance, Light(0.0F)) *
         static_cast<float>(1.0 / kPi);
}

void DiffuseLightSolver::NextOrder(std::size_t altitude, const Field& previous,
                                   Field& field) const {
  const auto orders = static_cast<std::size_t>(degree_) + 1;
  const std::size_t azimuths = azimuth_cosines_.size();
  std::vector<Light> rows(suns_ * orders);  // source per cos(m phi') at every sun node
  std::vector<Light> radiance(suns_ * azimuths);
  const double r = radius_km_ + altitude_km_[altitude];
  for (const March& march : marches_[altitude]) {
    const double sine = std::sqrt((1.0 - march.mu) * (1.0 + march.mu));
    std::fill(radiance.begin(), radiance.end(), Light(0.0F));
    for (const MarchSample& sample : march.samples) {
      // Contract altitude and degree once; every sun and azimuth then needs only cos(m phi').
      const auto legendre = LegendreTerms(degree_, sample.mu);
      std::array<Light, kMaxMoments> factor{};
      for (int l = 0; l <= degree_; ++l) {
        const float rayleigh_chi = l == 0 ? 1.0F : l == 2 ? 0.1F : 0.0F;
        const auto mie_chi = static_cast<float>(result_.chi_mie_[static_cast<std::size_t>(l)]);
        for (int m = 0; m <= l; ++m) {
          const std::size_t i = MomentIndex(l, m);
          factor[i] = (sample.rayleigh * rayleigh_chi + sample.mie * mie_chi) * legendre[i];
        }
      }
      std::fill(rows.begin(), rows.end(), Light(0.0F));
      for (std::size_t tap = 0; tap < 4; ++tap) {
        const float weight = sample.altitude.weight[tap];
        if (weight == 0.0F) continue;
        const Light* nodes = &previous[sample.altitude.node[tap] * suns_ * channels_];
        for (std::size_t c = 0; c < suns_; ++c) {
          const Light* node = nodes + c * channels_;
          Light* row = &rows[c * orders];
          for (int l = 0; l <= degree_; ++l) {
            for (int m = 0; m <= l; ++m) {
              const std::size_t i = MomentIndex(l, m);
              row[m] += weight * factor[i] * node[i];
            }
          }
        }
      }
      for (std::size_t j = 0; j < suns_; ++j) {
        const double sun_sine = std::sqrt((1.0 - mu_s_[j]) * (1.0 + mu_s_[j]));
        for (std::size_t k = 0; k < azimuths; ++k) {
          const double nu =
              march.mu * mu_s_[j] + sine * sun_sine * static_cast<double>(azimuth_cosines_[k]);
          const double mu_s =
              std::clamp((r * mu_s_[j] + static_cast<double>(sample.distance_km) * nu) /
                             static_cast<double>(sample.radius_km),
                         -1.0, 1.0);
          const auto cosines = CosineMultiples(
              degree_, AzimuthCosine(sample.mu, static_cast<float>(mu_s), static_cast<float>(nu)));
          const CubicTaps taps =
              TapsAt(DiffuseLight::SunCoordinate(mu_s), result_.options_.sun_angles);
          Light source(0.0F);
          for (std::size_t tap = 0; tap < 4; ++tap) {
            const Light* row = &rows[taps.node[tap] * orders];
            Light sum(0.0F);
            for (std::size_t m = 0; m < orders; ++m) sum += row[m] * cosines[m];
            source += taps.weight[tap] * sum;
          }
          radiance[j * azimuths + k] += glm::max(source, Light(0.0F));
        }
      }
    }
    for (std::size_t j = 0; j < suns_; ++j) {
      const double sun_sine = std::sqrt((1.0 - mu_s_[j]) * (1.0 + mu_s_[j]));
      for (std::size_t k = 0; k < azimuths; ++k) {
        const double nu =
            march.mu * mu_s_[j] + sine * sun_sine * static_cast<double>(azimuth_cosines_[k]);
        Light light = radiance[j * azimuths + k];
        if (march.hits_ground) {
          light += GroundRadiance(
              march, previous,
              (r * mu_s_[j] + static_cast<double>(march.ground_distance_km) * nu) / radius_km_);
        }
        Project(altitude, j, march, azimuth_cosines_[k], light, field);
      }
    }
  }
}

// Largest ratio over nodes of the isotropic moment of a part to that of the whole.
double DiffuseLightSolver::LargestShare(const Field& part, const Field& whole) const {
  double largest = 0.0;
  for (std::size_t node = 0; node < altitudes_ * suns_; ++node) {
    for (int lane = 0; lane < static_cast<int>(kLanes); ++lane) {
      const auto all = static_cast<double>(whole[node * channels_][lane]);
      // Nodes in deep night hold no light worth a further order.
      if (all > 1e-9)
        largest = std::max(largest, static_cast<double>(part[node * channels_][lane]) / all);
    }
  }
  return largest;
}

void DiffuseLightSolver::Solve() {
  const auto for_each_altitude = [&](const auto& work) {
    tbb::parallel_for(std::size_t{0}, altitudes_, work);
  };
  Field order(altitudes_ * suns_ * channels_, Light(0.0F));
  for_each_altitude([&](std::size_t i) { FirstOrder(i, order); });
  Field total = order;
  int orders = 1;
  double share = 1.0, previous_share = 1.0;
  while (share > result_.options_.tolerance && orders < result_.options_.max_orders) {
    Field next(order.size(), Light(0.0F));
    for_each_altitude([&](std::size_t i) { NextOrder(i, order, next); });
    for (std::size_t k = 0; k < total.size(); ++k) total[k] += next[k];
    order.swap(next);
    previous_share = share;
    share = LargestShare(order, total);
    ++orders;
  }
  // The rest is a geometric series in the ratio of the last two orders.
  const double ratio = std::min(share / previous_share, 0.98);
  for (std::size_t k = 0; k < total.size(); ++k) {
    total[k] += order[k] * static_cast<float>(ratio / (1.0 - ratio));
  }
  result_.orders_ = std::max(result_.orders_, orders);
  if (share > result_.options_.tolerance) result_.converged_ = false;
  for (std::size_t k = 0; k < total.size(); ++k) {
    for (std::size_t lane = 0; lane < kLanes && first_band_ + lane < result_.bands_; ++lane) {
      result_.values_[k * result_.bands_ + first_band_ + lane] = total[k][static_cast<int>(lane)];
    }
  }
}

DiffuseLight::DiffuseLight(const Medium& medium, const DiffuseLightOptions& options)
    : medium_(medium), options_(options), bands_(medium.wavelengths_nm.size()), converged_(true) {
  RequireInRange(options.altitudes, 4, 1024, "altitudes");
  RequireInRange(options.sun_angles, 4, 1024, "sun_angles");
  RequireInRange(options.degree, 2, kMaxDegree, "degree");
  Validate(medium_);
  moments_ = MomentCount(options.degree);
  chi_mie_ = LegendreCoefficients(medium.mie_phase, options.degree);
  for (std::size_t band = 0; band < bands_; ++band) {
    const auto per_km = [band](const std::vector<double>& per_m) {
      return static_cast<float>(per_m[band] * 1000.0);
    };
    coefficients_.push_back(
        {per_km(medium.rayleigh_scattering_per_m), per_km(medium.mie_extinction_per_m),
         per_km(medium.ozone_absorption_per_m), per_km(medium.mie_scattering_per_m)});
  }
  values_.assign(
      static_cast<std::size_t>(options.altitudes * options.sun_angles) * channels() * bands_, 0.0F);
  for (std::size_t first = 0; first < bands_; first += kLanes)
    DiffuseLightSolver(*this, first).Solve();
}

namespace {

// Channels of the table at a point, interpolated with cubic taps: [channel * bands + band].
template <typename Visit>
void VisitTaps(const DiffuseLightOptions& options, double u, double v, const Visit& visit) {
  const CubicTaps row = TapsAt(u, options.altitudes);
  const CubicTaps column = TapsAt(v, options.sun_angles);
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t s = 0; s < 4; ++s) {
      const float weight = row.weight[a] * column.weight[s];
      if (weight != 0.0F)
        visit(row.node[a] * static_cast<std::size_t>(options.sun_angles) + column.node[s], weight);
    }
  }
}

}  // namespace

void DiffuseLight::Interpolate(double altitude_m, double mu_s, std::span<float> moments) const {
  std::fill(moments.begin(), moments.end(), 0.0F);
  const double u = std::sqrt(std::clamp(altitude_m / medium_.atmosphere_height_m, 0.0, 1.0));
  const std::size_t stride = channels() * bands_;
  VisitTaps(options_, u, SunCoordinate(mu_s), [&](std::size_t node, float weight) {
    const float* values = &values_[node * stride];
    for (std::size_t k = 0; k < moments.size(); ++k) moments[k] += weight * values[k];
  });
}

Bands<float> DiffuseLight::InscatterAlong(const RaySamples<float>& samples, double nu) const {
  Bands<float> sum(bands_);
  std::array<float, kMaxMoments * kMaxBands> storage;
  const std::span<float> moments(storage.data(), moments_ * bands_);
  for (std::size_t s = 0; s < samples.count; ++s) {
    Interpolate(static_cast<double>(samples.altitude[s]) * 1000.0,
                static_cast<double>(samples.mu_s[s]), moments);
    const auto harmonics =
        SphericalHarmonics(options_.degree, samples.mu[s],
                           AzimuthCosine(samples.mu[s], samples.mu_s[s], static_cast<float>(nu)));
    std::array<float, kMaxBands> rayleigh{}, mie{};
    for (int l = 0; l <= options_.degree; ++l) {
      const auto mie_chi = static_cast<float>(chi_mie_[static_cast<std::size_t>(l)]);
      const float rayleigh_chi = l == 0 ? 1.0F : l == 2 ? 0.1F : 0.0F;
      for (int m = 0; m <= l; ++m) {
        const std::size_t i = MomentIndex(l, m);
        for (std::size_t band = 0; band < bands_; ++band) {
          const float light = harmonics[i] * moments[i * bands_ + band];
          mie[band] += mie_chi * light;
          rayleigh[band] += rayleigh_chi * light;
        }
      }
    }
    for (std::size_t band = 0; band < bands_; ++band) {
      const std::array<float, 4>& k = coefficients_[band];
      const float tau = k[0] * samples.view_rayleigh[s] + k[1] * samples.view_mie[s] +
                        k[2] * samples.view_ozone[s];
      const float source = k[0] * samples.rayleigh_density[s] * std::max(rayleigh[band], 0.0F) +
                           k[3] * samples.mie_density[s] * std::max(mie[band], 0.0F);
      sum[band] += samples.weight[s] * std::exp(-tau) * source;
    }
  }
  return sum;
}

Bands<float> DiffuseLight::Irradiance(double altitude_m, double mu_s, double normal_mu,
                                      double normal_cos_azimuth) const {
  // pi, 2 pi / 3, pi / 4, 0, -pi / 24, 0, pi / 64: the clamped cosine's zonal coefficients.
  constexpr std::array<double, kMaxDegree + 1> kCosine{
      kPi, 2.0 * kPi / 3.0, kPi / 4.0, 0.0, -kPi / 24.0, 0.0, kPi / 64.0};
  const auto harmonics = SphericalHarmonics(options_.degree, static_cast<float>(normal_mu),
                                            static_cast<float>(normal_cos_azimuth));
  std::array<float, kMaxMoments * kMaxBands> storage;
  const std::span<float> moments(storage.data(), moments_ * bands_);
  Interpolate(altitude_m, mu_s, moments);
  Bands<float> irradiance(bands_);
  for (int l = 0; l <= options_.degree; ++l) {
    for (int m = 0; m <= l; ++m) {
      const std::size_t i = MomentIndex(l, m);
      const float factor = harmonics[i] * static_cast<float>(kCosine[static_cast<std::size_t>(l)]);
      for (std::size_t band = 0; band < bands_; ++band)
        irradiance[band] += factor * moments[i * bands_ + band];
    }
  }
  for (std::size_t band = 0; band < bands_; ++band)
    irradiance[band] = std::max(irradiance[band], 0.0F);
  return irradiance;
}

Bands<float> DiffuseLight::SkyIrradiance(double altitude_m, double mu_s) const {
  Bands<float> irradiance(bands_);
  const double u = std::sqrt(std::clamp(altitude_m / medium_.atmosphere_height_m, 0.0, 1.0));
  VisitTaps(options_, u, SunCoordinate(mu_s), [&](std::size_t node, float weight) {
    const float* values = &values_[(node * channels() + moments_) * bands_];
    for (std::size_t band = 0; band < bands_; ++band) irradiance[band] += weight * values[band];
  });
  for (std::size_t band = 0; band < bands_; ++band)
    irradiance[band] = std::max(irradiance[band], 0.0F);
  return irradiance;
}

std::vector<float> DiffuseLight::ValuesAt(double altitude_coordinate, double sun_coordinate) const {
  std::vector<float> sum(channels() * bands_, 0.0F);
  VisitTaps(options_, altitude_coordinate, sun_coordinate, [&](std::size_t node, float weight) {
    const float* values = &values_[node * sum.size()];
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weight * values[i];
  });
  return sum;
}

}  // namespace alpenglow
