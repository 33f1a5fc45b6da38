// SPDX-License-Identifier: MIT
#include "lut/successive_orders.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec4.hpp>

#include "atmosphere/constants.h"
#include "atmosphere/quadrature.h"
#include "atmosphere/shell.h"
#include "lut/cubic_taps.h"

namespace alpenglow {
namespace {

constexpr std::size_t kLanes = 4;  // bands follow four at a time
using Light = glm::vec4;           // one value per band of such a block

// Moments and sky irradiance at every node: [(altitude * sun_angles + sun) * channels + channel].
using Field = std::vector<Light>;

// Where a sample finds the previous order, for one sun and azimuth: cell and fraction of the sun
// coordinate, and the local azimuth.
struct SunTap {
  std::uint32_t cell;
  float fraction;
  float cos_azimuth;
};

SunTap SunTapAt(double mu_s, float cos_azimuth, std::size_t suns) {
  const double position = DiffuseLight::SunCoordinate(mu_s) * static_cast<double>(suns - 1);
  const std::size_t cell = std::min(static_cast<std::size_t>(position), suns - 2);
  return {static_cast<std::uint32_t>(cell),
          static_cast<float>(position - static_cast<double>(cell)), cos_azimuth};
}

/// A point of a march: what the source there needs, whatever sun, band and order.
struct MarchSample {
  CubicTaps altitude;
  Moments legendre;
  float weight_km, rayleigh_density, mie_density;
  float view_rayleigh, view_mie, view_ozone;  // columns from the node [km]
};

/// One direction at one altitude.
struct March {
  double mu = 0.0;
  double solid_angle = 0.0;  // of the direction, one azimuth of half a turn
  std::vector<MarchSample> samples;
  std::vector<SunTap> taps;  // [(sample * suns + sun) * azimuths + azimuth]
  bool hits_ground = false;
  double ground_distance_km = 0.0;
  std::vector<SunTap> ground_taps;  // [sun * azimuths + azimuth], if it hits the ground
  Bands<float> ground_transmittance;
};

/// What does not depend on band or order.
class Geometry {
 public:
  Geometry(const Medium& medium, const DiffuseLightOptions& options);

  [[nodiscard]] std::size_t altitudes() const { return altitude_km_.size(); }
  [[nodiscard]] std::size_t suns() const { return mu_s_.size(); }
  [[nodiscard]] std::size_t azimuths() const { return azimuth_cosine_.size(); }
  [[nodiscard]] const std::vector<March>& marches(std::size_t altitude) const {
    return marches_[altitude];
  }
  [[nodiscard]] double altitude_km(std::size_t i) const { return altitude_km_[i]; }
  [[nodiscard]] double mu_s(std::size_t j) const { return mu_s_[j]; }
  [[nodiscard]] float azimuth_cosine(std::size_t k) const { return azimuth_cosine_[k]; }
  [[nodiscard]] double radius_km() const { return radius_km_; }
  [[nodiscard]] const AirIntegrator<float>& air() const { return air_; }

  /// Cosine between a march and the sun.
  [[nodiscard]] double Nu(const March& march, std::size_t sun, std::size_t azimuth) const;
  /// Sun zenith cosine at a distance along a march, where the radius is r_km.
  [[nodiscard]] double MuSAlong(std::size_t altitude, std::size_t sun, double nu,
                                double distance_km, double r_km) const;

 private:
  [[nodiscard]] std::vector<March> MarchesAt(std::size_t altitude,
                                             const DiffuseLightOptions& options) const;
  void Sample(std::size_t altitude, const DiffuseLightOptions& options, March& march) const;

  AirIntegrator<float> air_;
  double radius_km_;
  std::vector<double> altitude_km_, mu_s_;
  std::vector<float> azimuth_cosine_;
  std::vector<std::vector<March>> marches_;
};

double Sine(double cosine) { return std::sqrt(std::max((1.0 - cosine) * (1.0 + cosine), 0.0)); }

Geometry::Geometry(const Medium& medium, const DiffuseLightOptions& options)
    : air_(medium), radius_km_(medium.planet_radius_m / 1000.0) {
  for (int i = 0; i < options.altitudes; ++i) {
    const double u = static_cast<double>(i) / (options.altitudes - 1);
    altitude_km_.push_back(medium.atmosphere_height_m / 1000.0 * u * u);
  }
  for (int j = 0; j < options.sun_angles; ++j) {
    mu_s_.push_back(
        DiffuseLight::MuSFromCoordinate(static_cast<double>(j) / (options.sun_angles - 1)));
  }
  for (int k = 0; k < options.azimuth_nodes; ++k) {
    azimuth_cosine_.push_back(
        static_cast<float>(std::cos((k + 0.5) * kPi / options.azimuth_nodes)));
  }
  marches_.resize(altitudes());
  tbb::parallel_for(std::size_t{0}, altitudes(),
                    [&](std::size_t i) { marches_[i] = MarchesAt(i, options); });
}

double Geometry::Nu(const March& march, std::size_t sun, std::size_t azimuth) const {
  const double nu = march.mu * mu_s_[sun] + Sine(march.mu) * Sine(mu_s_[sun]) *
                                                static_cast<double>(azimuth_cosine_[azimuth]);
  return std::clamp(nu, -1.0, 1.0);
}

double Geometry::MuSAlong(std::size_t altitude, std::size_t sun, double nu, double distance_km,
                          double r_km) const {
  const double r = radius_km_ + altitude_km_[altitude];
  return std::clamp((r * mu_s_[sun] + distance_km * nu) / r_km, -1.0, 1.0);
}

// Gauss nodes above and below the horizon, dense near it: mu - horizon = range v^2.
std::vector<March> Geometry::MarchesAt(std::size_t altitude,
                                       const DiffuseLightOptions& options) const {
  const double horizon = shared::HorizonCosine<double>(altitude_km_[altitude], radius_km_);
  const GaussRule& rule = GaussLegendre(options.zenith_nodes);
  std::vector<March> marches;
  for (const double end : {-1.0, 1.0}) {
    for (std::size_t k = 0; k < rule.node.size(); ++k) {
      const double v = rule.node[k];
      March march;
      march.mu = horizon + (end - horizon) * v * v;
      march.solid_angle =
          std::abs(end - horizon) * 2.0 * v * rule.weight[k] * kPi / options.azimuth_nodes;
      Sample(altitude, options, march);
      marches.push_back(std::move(march));
    }
  }
  return marches;
}

void Geometry::Sample(std::size_t altitude, const DiffuseLightOptions& options,
                      March& march) const {
  // With the sun in the zenith no part of the ray is in shadow: one set of panels serves every sun.
  const ViewRay ray{altitude_km_[altitude] * 1000.0, march.mu, 1.0, march.mu};
  const RaySamples<float> samples =
      air_.Sample(ray, {.nodes = options.ray_nodes, .split_ozone = false, .dark_samples = true});
  const double top_km = air_.medium().atmosphere_height_m / 1000.0;
  for (std::size_t s = 0; s < samples.count; ++s) {
    const auto h = static_cast<double>(samples.altitude[s]);
    march.samples.push_back({TapsAt(std::sqrt(h / top_km), options.altitudes),
                             LegendreTerms(options.degree, samples.mu[s]), samples.weight[s],
                             samples.rayleigh_density[s], samples.mie_density[s],
                             samples.view_rayleigh[s], samples.view_mie[s], samples.view_ozone[s]});
    for (std::size_t j = 0; j < suns(); ++j) {
      for (std::size_t k = 0; k < azimuths(); ++k) {
        const double nu = Nu(march, j, k);
        const double mu_s =
            MuSAlong(altitude, j, nu, static_cast<double>(samples.distance[s]), radius_km_ + h);
        march.taps.push_back(SunTapAt(
            mu_s, AzimuthCosine(samples.mu[s], static_cast<float>(mu_s), static_cast<float>(nu)),
            suns()));
      }
    }
  }
  march.hits_ground = samples.extent.end == RayEnd::kGround;
  if (!march.hits_ground) return;
  march.ground_distance_km = samples.extent.end_m / 1000.0;
  march.ground_transmittance = air_.TransmittanceAlong(ray);
  for (std::size_t j = 0; j < suns(); ++j) {
    for (std::size_t k = 0; k < azimuths(); ++k) {
      const double mu_s =
          MuSAlong(altitude, j, Nu(march, j, k), march.ground_distance_km, radius_km_);
      march.ground_taps.push_back(SunTapAt(mu_s, 0.0F, suns()));
    }
  }
}

/// Four bands through all orders.
class Block {
 public:
  Block(const Geometry& geometry, const DiffuseLightOptions& options, std::size_t first_band);

  /// Adds light that arrives at a node along a march to an order's moments.
  void Project(const March& march, std::size_t altitude, std::size_t sun, std::size_t azimuth,
               const Light& radiance, Field& field) const;
  [[nodiscard]] Field Empty() const {
    return Field(geometry_.altitudes() * geometry_.suns() * channels_, Light(0.0F));
  }
  [[nodiscard]] Light Of(const Bands<float>& bands) const;

  struct Sum {
    Field total;
    int orders;
    bool converged;
  };
  [[nodiscard]] Sum Solve(Field first_order) const;

 private:
  [[nodiscard]] Light Of(const std::vector<double>& bands) const;
  [[nodiscard]] std::size_t Orders() const { return static_cast<std::size_t>(options_.degree) + 1; }
  void NextOrder(std::size_t altitude, const Field& previous, Field& next) const;
  void Contract(const MarchSample& sample, const Field& previous, std::vector<Light>& rows) const;
  void Arrive(const March& march, const Field& previous, std::vector<Light>& rows,
              std::vector<Light>& radiance) const;
  void AddGroundLight(const March& march, const Field& previous,
                      std::vector<Light>& radiance) const;
  [[nodiscard]] double LargestShare(const Field& part, const Field& whole) const;
  [[nodiscard]] Light TailFactor(const Light& last, const Light& before) const;

  const Geometry& geometry_;
  const DiffuseLightOptions& options_;
  std::size_t first_band_, channels_;
  Light albedo_, rayleigh_, mie_scattering_, mie_extinction_, ozone_;  // coefficients per km
  std::vector<Light> mie_chi_;                                         // by degree
};

Block::Block(const Geometry& geometry, const DiffuseLightOptions& options, std::size_t first_band)
    : geometry_(geometry),
      options_(options),
      first_band_(first_band),
      channels_(MomentCount(options.degree) + 1) {
  const Medium& medium = geometry.air().medium();
  albedo_ = Of(medium.ground_albedo);
  rayleigh_ = Of(medium.rayleigh_scattering_per_m) * 1000.0F;
  mie_scattering_ = Of(medium.mie_scattering_per_m) * 1000.0F;
  mie_extinction_ = Of(medium.mie_extinction_per_m) * 1000.0F;
  ozone_ = Of(medium.ozone_absorption_per_m) * 1000.0F;
  const std::vector<double> chi = MieLegendreCoefficients(medium, options.degree);
  const auto bands = static_cast<std::ptrdiff_t>(medium.wavelengths_nm.size());
  for (auto row = chi.begin(); row != chi.end(); row += bands) {
    mie_chi_.push_back(Of(std::vector<double>(row, row + bands)));
  }
}

Light Block::Of(const Bands<float>& bands) const {
  Light block(0.0F);
  for (std::size_t lane = 0; lane < kLanes && first_band_ + lane < bands.count; ++lane) {
    block[static_cast<int>(lane)] = bands[first_band_ + lane];
  }
  return block;
}

Light Block::Of(const std::vector<double>& bands) const {
  Light block(0.0F);
  for (std::size_t lane = 0; lane < kLanes && first_band_ + lane < bands.size(); ++lane) {
    block[static_cast<int>(lane)] = static_cast<float>(bands[first_band_ + lane]);
  }
  return block;
}

void Block::Project(const March& march, std::size_t altitude, std::size_t sun, std::size_t azimuth,
                    const Light& radiance, Field& field) const {
  const Moments harmonics = SphericalHarmonics(options_.degree, static_cast<float>(march.mu),
                                               geometry_.azimuth_cosine(azimuth));
  // Azimuth runs over half a turn; the other half is its mirror image.
  const Light light = radiance * static_cast<float>(2.0 * march.solid_angle);
  Light* node = &field[(altitude * geometry_.suns() + sun) * channels_];
  for (std::size_t i = 0; i + 1 < channels_; ++i) node[i] += light * harmonics[i];
  if (march.mu > 0.0) node[channels_ - 1] += light * static_cast<float>(march.mu);
}

// Source of a sample per cos(m phi) at every sun node, altitude and degree summed: [(1 + sun) *
// orders + m]. A node beyond each end continues the line through the last two, so that every tap
// has four neighbours.
void Block::Contract(const MarchSample& sample, const Field& previous,
                     std::vector<Light>& rows) const {
  const Light tau = rayleigh_ * sample.view_rayleigh + mie_extinction_ * sample.view_mie +
                    ozone_ * sample.view_ozone;
  const Light light = sample.weight_km *
                      Light(std::exp(-tau.x), std::exp(-tau.y), std::exp(-tau.z), std::exp(-tau.w));
  const Light rayleigh = light * rayleigh_ * sample.rayleigh_density;
  const Light mie = light * mie_scattering_ * sample.mie_density;
  std::array<Light, kMaxMoments> factor;
  for (int l = 0; l <= options_.degree; ++l) {
    const float rayleigh_chi = l == 0 ? 1.0F : l == 2 ? 0.1F : 0.0F;
    const Light source = rayleigh * rayleigh_chi + mie * mie_chi_[static_cast<std::size_t>(l)];
    for (int m = 0; m <= l; ++m)
      factor[MomentIndex(l, m)] = source * sample.legendre[MomentIndex(l, m)];
  }
  const std::size_t suns = geometry_.suns();
  const std::size_t orders = Orders();
  std::fill(rows.begin(), rows.end(), Light(0.0F));
  for (std::size_t tap = 0; tap < 4; ++tap) {
    const float weight = sample.altitude.weight[tap];
    if (weight == 0.0F) continue;
    const Light* node = &previous[sample.altitude.node[tap] * suns * channels_];
    for (std::size_t c = 0; c < suns; ++c, node += channels_) {
      Light* row = &rows[(c + 1) * orders];
      for (int l = 0; l <= options_.degree; ++l) {
        for (int m = 0; m <= l; ++m)
          row[m] += weight * (factor[MomentIndex(l, m)] * node[MomentIndex(l, m)]);
      }
    }
  }
  for (std::size_t m = 0; m < orders; ++m) {
    rows[m] = 2.0F * rows[orders + m] - rows[2 * orders + m];
    rows[(suns + 1) * orders + m] = 2.0F * rows[suns * orders + m] - rows[(suns - 1) * orders + m];
  }
}

// Radiance that arrives along a march for every sun and azimuth.
void Block::Arrive(const March& march, const Field& previous, std::vector<Light>& rows,
                   std::vector<Light>& radiance) const {
  const std::size_t orders = Orders();
  std::fill(radiance.begin(), radiance.end(), Light(0.0F));
  const SunTap* tap = march.taps.data();
  for (const MarchSample& sample : march.samples) {
    Contract(sample, previous, rows);
    for (Light& arriving : radiance) {
      const std::array<float, 4> weight = CatmullRom(tap->fraction);
      const auto cosines = CosineMultiples(options_.degree, tap->cos_azimuth);
      const Light* row = &rows[tap->cell * orders];
      Light source(0.0F);
      for (std::size_t m = 0; m < orders; ++m) {
        const Light there = weight[0] * row[m] + weight[1] * row[orders + m] +
                            weight[2] * row[2 * orders + m] + weight[3] * row[3 * orders + m];
        source += cosines[m] * there;
      }
      arriving += glm::max(source, Light(0.0F));
      ++tap;
    }
  }
}

// Light of the previous order that the ground reflects into the march.
void Block::AddGroundLight(const March& march, const Field& previous,
                           std::vector<Light>& radiance) const {
  const Light reflected = Of(march.ground_transmittance) * albedo_ * static_cast<float>(1.0 / kPi);
  const std::size_t last = geometry_.suns() - 1;
  for (std::size_t i = 0; i < radiance.size(); ++i) {
    const SunTap& at = march.ground_taps[i];
    const double coordinate = (static_cast<double>(at.cell) + static_cast<double>(at.fraction)) /
                              static_cast<double>(last);
    const CubicTaps taps = TapsAt(coordinate, options_.sun_angles);
    Light irradiance(0.0F);
    for (std::size_t tap = 0; tap < 4; ++tap) {
      irradiance += taps.weight[tap] * previous[taps.node[tap] * channels_ + channels_ - 1];
    }
    radiance[i] += reflected * glm::max(irradiance, Light(0.0F));
  }
}

void Block::NextOrder(std::size_t altitude, const Field& previous, Field& next) const {
  std::vector<Light> rows((geometry_.suns() + 2) * Orders());
  std::vector<Light> radiance(geometry_.suns() * geometry_.azimuths());
  for (const March& march : geometry_.marches(altitude)) {
    Arrive(march, previous, rows, radiance);
    if (march.hits_ground) AddGroundLight(march, previous, radiance);
    for (std::size_t j = 0; j < geometry_.suns(); ++j) {
      for (std::size_t k = 0; k < geometry_.azimuths(); ++k) {
        Project(march, altitude, j, k, radiance[j * geometry_.azimuths() + k], next);
      }
    }
  }
}

// Largest ratio over nodes of the isotropic moment of a part to that of the whole.
double Block::LargestShare(const Field& part, const Field& whole) const {
  constexpr float kNight = 1e-9F;  // nodes with less light do not hold up the rest
  double largest = 0.0;
  for (std::size_t node = 0; node < whole.size(); node += channels_) {
    for (int lane = 0; lane < static_cast<int>(kLanes); ++lane) {
      if (whole[node][lane] <= kNight) continue;
      largest = std::max(largest, static_cast<double>(part[node][lane] / whole[node][lane]));
    }
  }
  return largest;
}

// Sum of q + q^2 + ... for the ratio q of two consecutive orders.
Light Block::TailFactor(const Light& last, const Light& before) const {
  Light factor(0.0F);
  for (int lane = 0; lane < static_cast<int>(kLanes); ++lane) {
    if (before[lane] <= 0.0F) continue;
    const float ratio = std::clamp(last[lane] / before[lane], 0.0F, 0.98F);
    factor[lane] = ratio / (1.0F - ratio);
  }
  return factor;
}

Block::Sum Block::Solve(Field first_order) const {
  Field order = std::move(first_order);
  Field total = order;
  Field before = order;
  int orders = 1;
  double share = 1.0, rest = 1.0;
  const auto goes_on = [&] {
    if (options_.exact_orders) return orders < *options_.exact_orders;
    return rest > options_.tolerance && share > 0.0 && orders < options_.max_orders;
  };
  while (goes_on()) {
    Field next = Empty();
    tbb::parallel_for(std::size_t{0}, geometry_.altitudes(),
                      [&](std::size_t i) { NextOrder(i, order, next); });
    for (std::size_t k = 0; k < total.size(); ++k) total[k] += next[k];
    before = std::move(order);
    order = std::move(next);
    ++orders;
    const double share_before = share;
    share = LargestShare(order, total);
    const double ratio = std::clamp(share / share_before, 0.0, 0.999);
    rest = share * ratio / (1.0 - ratio);
  }
  if (options_.exact_orders) return {std::move(total), orders, true};
  for (std::size_t node = 0; node < total.size(); node += channels_) {
    const Light tail = TailFactor(order[node], before[node]);
    for (std::size_t i = 0; i < channels_; ++i) total[node + i] += tail * order[node + i];
  }
  return {std::move(total), orders, rest <= options_.tolerance || share == 0.0};
}

// Sunlight scattered once, and reflected by the ground, in every direction at the nodes of one
// altitude.
void FirstOrder(const Geometry& geometry, const std::vector<Block>& blocks,
                const DiffuseLightOptions& options, std::size_t altitude,
                std::vector<Field>& fields) {
  const AirIntegrator<float>& air = geometry.air();
  const Sampling sampling{.nodes = options.ray_nodes, .split_ozone = false, .dark_samples = false};
  for (const March& march : geometry.marches(altitude)) {
    for (std::size_t j = 0; j < geometry.suns(); ++j) {
      for (std::size_t k = 0; k < geometry.azimuths(); ++k) {
        const double nu = geometry.Nu(march, j, k);
        const ViewRay ray{geometry.altitude_km(altitude) * 1000.0, march.mu, geometry.mu_s(j), nu};
        Bands<float> radiance = air.Inscatter(air.Scatter(air.Sample(ray, sampling)), nu);
        const double mu_s =
            geometry.MuSAlong(altitude, j, nu, march.ground_distance_km, geometry.radius_km());
        if (march.hits_ground && mu_s > 0.0) {
          const Bands<float> sun = air.TransmittanceToSpace(0.0, mu_s);
          for (std::size_t band = 0; band < radiance.count; ++band) {
            radiance[band] += march.ground_transmittance[band] * sun[band] *
                              static_cast<float>(air.medium().ground_albedo[band] * mu_s / kPi);
          }
        }
        for (std::size_t block = 0; block < blocks.size(); ++block) {
          blocks[block].Project(march, altitude, j, k, blocks[block].Of(radiance), fields[block]);
        }
      }
    }
  }
}

}  // namespace

SolvedOrders SolveSuccessiveOrders(const Medium& medium, const DiffuseLightOptions& options) {
  const Geometry geometry(medium, options);
  const std::size_t bands = medium.wavelengths_nm.size();
  std::vector<Block> blocks;
  std::vector<Field> first;
  for (std::size_t band = 0; band < bands; band += kLanes) {
    blocks.emplace_back(geometry, options, band);
    first.push_back(blocks.back().Empty());
  }
  tbb::parallel_for(std::size_t{0}, geometry.altitudes(),
                    [&](std::size_t i) { FirstOrder(geometry, blocks, options, i, first); });
  SolvedOrders solved;
  for (std::size_t block = 0; block < blocks.size(); ++block) {
    const Block::Sum sum = blocks[block].Solve(std::move(first[block]));
    solved.values.resize(sum.total.size() * bands);
    solved.orders = std::max(solved.orders, sum.orders);
    solved.converged = solved.converged && sum.converged;
    for (std::size_t k = 0; k < sum.total.size(); ++k) {
      for (std::size_t lane = 0; lane < kLanes && block * kLanes + lane < bands; ++lane) {
        solved.values[k * bands + block * kLanes + lane] = sum.total[k][static_cast<int>(lane)];
      }
    }
  }
  return solved;
}

}  // namespace alpenglow
