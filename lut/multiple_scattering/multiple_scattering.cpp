// SPDX-License-Identifier: MIT
#include "lut/multiple_scattering/multiple_scattering.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <mutex>
#include <set>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/ray/shell.h"
#include "atmosphere/shared_glsl/instruction_set.h"
#include "lut/cli/messages.h"
#include "lut/multiple_scattering/moment_grid.h"
#include "lut/multiple_scattering/successive_orders.h"
#include "lut/tables/table_axes.h"

namespace alpenglow::lut {

const SunAxis& MultipleScattering::SunNodes() {
  static const SunAxis axis(-0.05, 0.10, -0.55);
  return axis;
}

double MultipleScattering::SunCoordinate(double mu_s) {
  return std::clamp(SunNodes().Coordinate(mu_s), 0.0, 1.0);
}

namespace {

void RequireNodes(const MultipleScatteringOptions& options) {
  constexpr int kMostRayNodes = 32;  // upper limit of RaySampling
  RequireInRange(options.zenith_nodes, 1, kMaxGaussNodes, "zenith_nodes");
  RequireInRange(options.azimuth_nodes, 1, static_cast<double>(kMostAzimuths), "azimuth_nodes");
  RequireInRange(options.ray_nodes, 1, kMostRayNodes, "ray_nodes");
  RequireInRange(options.later_zenith_nodes, 1, kMaxGaussNodes, "later_zenith_nodes");
  RequireInRange(options.later_azimuth_nodes, 1, static_cast<double>(kMostAzimuths),
                 "later_azimuth_nodes");
  RequireInRange(options.later_ray_nodes, 1, kMostRayNodes, "later_ray_nodes");
}

// Checks the preconditions of the solver and of the look-ups.
const Medium& Checked(const Medium& medium, const MultipleScatteringOptions& options) {
  RequireInRange(options.altitudes, 4, 1024, "altitudes");
  RequireInRange(options.sun_angles, 4, 1024, "sun_angles");
  RequireDegree(options.degree);
  if (options.delta_m && options.exact_orders)
    throw InputError("delta_m sums all orders; exact_orders wants some");
  RequireNodes(options);
  RequireInRange(options.max_orders, 1, 10000, "max_orders");
  RequireInRange(options.tolerance, 0.0, 1.0, "tolerance");
  RequireInRange(options.exact_orders.value_or(1), 1, 1000, "exact_orders");
  Validate(medium);
  if (medium.wavelengths_nm.size() > kMaxBands) {
    throw InputError(
        fmt::format("spectrum.wavelengths_nm has {} values; diffuse light is kept for at most {}",
                    medium.wavelengths_nm.size(), kMaxBands));
  }
  return medium;
}

// Adds `times` times the beam's light at a node to the values of the node.
void AddBeam(const MultipleScatteringOptions& options, const Spectrum& beam, double mu_s,
             float times, bool polarised, float* value) {
  const Moments towards = LegendreTerms(options.degree, static_cast<float>(mu_s));
  const auto add = [&](float share) {
    for (std::size_t band = 0; band < beam.size(); ++band, ++value)
      *value += times * share * beam[band];
  };
  for (std::size_t i = 0; i < MomentCount(options.degree); ++i) add(towards[i]);
  // Unpolarised light has T2m = L2m.
  for (std::size_t m = 0; polarised && m < kTensorMoments; ++m)
    add(towards[MomentIndex(2, static_cast<int>(m))]);
  add(static_cast<float>(std::max(mu_s, 0.0)));
}

// Returns the values at all nodes plus `times` times the beam.
std::vector<float> WithBeam(const Medium& medium, const MultipleScatteringOptions& options,
                            float times, std::vector<float> values) {
  const ScaledBeam beam(medium, options.degree);
  const MomentGrid grid = GridOf(medium, options);
  const std::size_t floats = values.size() / (grid.altitudes * grid.suns);
  for (std::size_t node = 0; node < grid.altitudes * grid.suns; ++node) {
    const double u =
        static_cast<double>(node / grid.suns) / static_cast<double>(grid.altitudes - 1);
    const double mu_s = MuSOfNode(grid, node % grid.suns);
    AddBeam(options, beam.At(medium.atmosphere_height_m * u * u, mu_s), mu_s, times,
            medium.polarised, &values[node * floats]);
  }
  return values;
}

// Writes, once for each air, that its light is not converged.
void WarnOfMissingOrders(const Medium& medium, int orders) {
  static std::mutex asking;
  static std::set<std::uint64_t> said;
  {
    const std::scoped_lock lock(asking);
    if (!said.insert(MediumHash(medium)).second) return;
  }
  Warn(fmt::format(
      "the air of {} is too thick: {} orders of scattering are too few, and its light may be wrong "
      "by as much as the sunlight",
      medium.name.empty() ? "the medium" : medium.name, orders));
}

SolvedOrders Solved(
    const Medium& medium, const MultipleScatteringOptions& options,
    const OrderPartDone& part_done = [] {}) {
  SolvedOrders solved = SolveSuccessiveOrders(Checked(medium, options), options, part_done);
  if (options.delta_m) solved.values = WithBeam(medium, options, 1.0F, std::move(solved.values));
  return solved;
}

// Returns the number of altitudes, quadratic in altitude, with which light in an exponential layer
// is interpolated well: density falls as a Gaussian function of the coordinate, and three nodes lie
// within its width.
int AltitudesOfLayer(const Medium& medium, double scale_height_m) {
  constexpr int kFewest = 24, kMost = 64;
  const double widths = std::sqrt(2.0 * medium.atmosphere_height_m / scale_height_m);
  return std::clamp(1 + static_cast<int>(std::ceil(3.0 * widths)), kFewest, kMost);
}

}  // namespace

MultipleScatteringOptions OptionsFor(const Medium& medium) {
  const auto thickest = [](const std::vector<double>& per_m, double scale_height_m) {
    return scale_height_m * *std::max_element(per_m.begin(), per_m.end());
  };
  const double aerosol = thickest(medium.mie_scattering_per_m, medium.mie_scale_height_m);
  const double molecules =
      thickest(medium.rayleigh_scattering_per_m, medium.rayleigh_scale_height_m);
  MultipleScatteringOptions options;
  if (aerosol > 0.08 || NarrowLobes(medium) > 2e-4) {
    options.degree = kMaxDegree;
    options.delta_m = true;
    // There must be more azimuths than degrees, to avoid aliasing of the highest degrees.
    options.azimuth_nodes = 14;
    options.later_azimuth_nodes = 13;
  }
  if (aerosol + molecules > 0.9) {
    options.altitudes = 24;
    options.later_ray_nodes = 8;
  }
  // The quadrature errors of single orders accumulate over many orders.
  if (molecules > 0.4) {
    options.ray_nodes = 14;
    options.later_ray_nodes = 12;
  }
  if (molecules > 0.9) {
    options.ray_nodes = 28;
    options.later_ray_nodes = 24;
    options.later_zenith_nodes = 12;
  }
  // Projections on moments of degree 12 by fewer directions bring light from one degree to another,
  // and each of many orders gains energy.
  if (aerosol > 1.5) options.later_zenith_nodes = std::max(options.later_zenith_nodes, 8);
  // Light diffuses along its gradient, which fewer altitudes would flatten.
  if (aerosol > 3.0) options.altitudes = AltitudesOfLayer(medium, medium.mie_scale_height_m);
  return options;
}

MultipleScatteringOptions RaisedFor(const Medium& medium, MultipleScatteringOptions options) {
  using Options = MultipleScatteringOptions;
  const Options needed = OptionsFor(medium), usual;
  for (const auto number :
       {&Options::altitudes, &Options::sun_angles, &Options::degree, &Options::zenith_nodes,
        &Options::azimuth_nodes, &Options::ray_nodes, &Options::later_zenith_nodes,
        &Options::later_azimuth_nodes, &Options::later_ray_nodes}) {
    if (needed.*number > usual.*number) options.*number = std::max(options.*number, needed.*number);
  }
  options.delta_m = needed.delta_m;
  return options;
}

MultipleScattering SolvedStepwise(const Medium& medium, const MultipleScatteringOptions& options,
                                  const OrderPartDone& part_done) {
  return {medium, options, Solved(medium, options, part_done)};
}

MultipleScattering::MultipleScattering(const Medium& medium,
                                       const MultipleScatteringOptions& options)
    : MultipleScattering(medium, options, Solved(medium, options)) {}

MultipleScattering::MultipleScattering(const Medium& medium,
                                       const MultipleScatteringOptions& options,
                                       SolvedOrders solved)
    : medium_(Checked(medium, options)),
      options_(options),
      bands_(medium.wavelengths_nm.size()),
      orders_(solved.orders),
      converged_(solved.converged),
      values_(std::move(solved.values)) {
  moments_ = MomentCount(options.degree);
  const std::size_t expected = static_cast<std::size_t>(options.altitudes) *
                               static_cast<std::size_t>(options.sun_angles) * channels() * bands_;
  if (values_.size() != expected) {
    throw InputError(
        fmt::format("diffuse light: {} values; its options need {}", values_.size(), expected));
  }
  for (const float value : values_) {
    if (!std::isfinite(value)) throw InputError("diffuse light: a value is not finite");
  }
  if (!converged_) WarnOfMissingOrders(medium_, orders_);
  grid_ = GridOf(medium_, options_);
  if (options_.delta_m) {
    peak_.emplace(medium_, options_.degree);
    smooth_ = WithBeam(medium_, options_, -1.0F, values_);
  } else if (!options_.exact_orders) {
    glow_.emplace(medium_, options_.degree);
  }
  air_ = SingleScattering<float>(medium_).constants();
  blocks_ = BlocksOf();
  packed_ = Packed();
  packed_sky_ = PackedSky();
}

std::vector<MomentBlock> MultipleScattering::BlocksOf() const {
  const DeltaScaledMedium scattering = ScatteringMedium(medium_, options_);
  const AirConstants<float> air = SingleScattering<float>(scattering.medium).constants();
  std::vector<MomentBlock> blocks((bands_ + kBlockBands - 1) / kBlockBands);
  for (std::size_t i = 0; i < blocks.size(); ++i)
    blocks[i].shape = ShapeOfBlock(medium_, scattering.chi, grid_.degree, i * kBlockBands);
  for (std::size_t band = 0; band < bands_; ++band) {
    MomentBlock& block = blocks[band / kBlockBands];
    const std::size_t lane = band % kBlockBands;
    block.rayleigh[lane] = air.rayleigh[band];
    block.mie_scattering[lane] = air.mie_scattering[band];
    block.mie_extinction[lane] = air.mie_extinction[band];
    block.ozone[lane] = air.ozone[band];
  }
  return blocks;
}

AlignedFloats MultipleScattering::Packed() const {
  const std::size_t nodes = grid_.altitudes * grid_.suns;
  const std::size_t stride = PackedVectors(grid_.degree, grid_.polarised) * 8;
  const std::vector<float> twilight = TwilightAtNodes(grid_);
  AlignedFloats packed(blocks_.size() * nodes * stride);
  for (std::size_t node = 0; node < nodes; ++node) {
    const float* value = &smooth()[node * channels() * bands_];
    const std::size_t sun = node % grid_.suns;
    const float sine = SunSine(MuSOfNode(grid_, sun));
    const auto store = [&](std::size_t index, std::size_t m, const float* of_bands) {
      for (std::size_t band = 0; band < bands_; ++band) {
        packed.data()[(band / kBlockBands * nodes + node) * stride + index + band % kBlockBands] =
            of_bands[band] / twilight[sun] / SinePowerOf(grid_, m, sine);
      }
    };
    if (grid_.polarised) store(PackedTensorTrace(grid_.degree), 0, value);
    for (std::size_t l = 0; l <= grid_.degree; ++l) {
      for (std::size_t m = 0; m <= l; ++m, value += bands_) store(PackedIndex(l, m), m, value);
    }
    for (std::size_t m = 0; grid_.polarised && m < kTensorMoments; ++m, value += bands_)
      store(PackedTensorIndex(grid_.degree, m), m, value);
  }
  return packed;
}

std::vector<float> MultipleScattering::PackedSky() const {
  const std::size_t nodes = grid_.altitudes * grid_.suns;
  const std::vector<float> twilight = TwilightAtNodes(grid_);
  std::vector<float> packed(blocks_.size() * nodes * kBlockBands);
  for (std::size_t node = 0; node < nodes; ++node) {
    for (std::size_t band = 0; band < bands_; ++band) {
      packed[(band / kBlockBands * nodes + node) * kBlockBands + band % kBlockBands] =
          smooth()[(node * channels() + channels() - 1) * bands_ + band] /
          twilight[node % grid_.suns];
    }
  }
  return packed;
}

double MultipleScattering::AltitudeCoordinate(double altitude_m) const {
  return std::sqrt(std::clamp(altitude_m / medium_.atmosphere_height_m, 0.0, 1.0));
}

template <typename Visit>
void MultipleScattering::VisitNodes(double altitude_coordinate, double mu_s,
                                    const Visit& visit) const {
  const CubicTaps row = TapsAt(altitude_coordinate, options_.altitudes);
  const CubicTaps column = SunTaps(grid_, mu_s);
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t s = 0; s < 4; ++s) {
      const float weight = row.weight[a] * column.weight[s];
      if (weight != 0.0F)
        visit(&smooth()[(row.node[a] * grid_.suns + column.node[s]) * channels() * bands_], weight,
              column.node[s]);
    }
  }
}

Spectrum MultipleScattering::InscatterByMoments(const RaySamples<float>& samples, double nu) const {
  alignas(64) std::array<float, kMaxBands + kBlockBands> light{};
  Kernel<MomentKernel>().inscatter(grid_, samples, static_cast<float>(nu), blocks_.data(),
                                   blocks_.size(), packed_.data(), light.data());
  Spectrum sum(bands_);
  std::copy_n(light.begin(), bands_, sum.values().begin());
  return sum;
}

Spectrum MultipleScattering::InscatterAlong(const RaySamples<float>& samples, double nu,
                                            double nu_seen, SegmentEnd end) const {
  Spectrum light = InscatterByMoments(samples, nu);
  if (samples.count == 0) return light;
  if (glow_ && GlowAboutTheSun::Reaches(nu_seen)) {
    const Spectrum glow = GlowAlong(samples, nu_seen);
    for (std::size_t band = 0; band < bands_; ++band)
      light[band] = std::max(light[band] + glow[band], 0.0F);
  }
  if (!peak_) return light;
  const bool is_hidden = end == SegmentEnd::kOpaque && samples.extent.end == RayEnd::kLength;
  const Spectrum more = peak_->Along(samples, nu_seen),
                 behind = is_hidden ? Spectrum(bands_) : PeakBehind(samples, nu, nu_seen);
  for (std::size_t band = 0; band < bands_; ++band)
    light[band] = std::max(light[band] + more[band] + behind[band], 0.0F);
  return light;
}

Spectrum MultipleScattering::GlowFactor(double nu, float column_km) const {
  if (peak_) return peak_->FactorOf(nu, column_km);
  return glow_ ? glow_->FactorOf(nu, column_km) : Spectrum(bands_);
}

// The column is the mean over sunlit aerosol.
Spectrum MultipleScattering::GlowAlong(const RaySamples<float>& samples, double nu) const {
  float lit_km = 0.0F, column = 0.0F;
  for (std::size_t i = 0; i < samples.count; ++i) {
    const float lit = samples.weight[i] * samples.lit[i] * samples.mie_density[i];
    lit_km += lit;
    column += lit > 0.0F ? lit * (samples.sun_mie[i] + samples.view_mie[i]) : 0.0F;
  }
  if (!(lit_km > 0.0F)) return Spectrum(bands_);
  ScatteredOnce<float> once{Spectrum(bands_), Spectrum(bands_)};
  Kernel<RayKernel<float>>().scatter(air_, samples, once);
  Spectrum glow = glow_->FactorOf(nu, column / lit_km);
  for (std::size_t band = 0; band < bands_; ++band) glow[band] *= once.mie[band];
  return glow;
}

Spectrum MultipleScattering::GroundLight(double mu_s) const {
  Spectrum light = SkyIrradiance(0.0, mu_s);
  const Spectrum sun = mu_s > 0.0 ? peak_->air().TransmittanceToSpace(0.0, mu_s) : Spectrum(bands_);
  for (std::size_t band = 0; band < bands_; ++band) {
    light[band] = static_cast<float>(medium_.ground_albedo[band] / kPi) *
                  (light[band] + static_cast<float>(std::max(mu_s, 0.0)) * sun[band]);
  }
  return light;
}

// Returns the continuation of the ray at its end, from the last of its samples.
ViewRay MultipleScattering::RayBehind(const RaySamples<float>& samples, double nu) const {
  const std::size_t last = LastSample(samples);
  const double radius_m = medium_.planet_radius_m;
  const double from_m = 1000.0 * static_cast<double>(samples.altitude[last]);
  const double mu = static_cast<double>(samples.mu[last]);
  const double on_m = std::max(samples.extent.end_m - samples.extent.begin_m -
                                   1000.0 * static_cast<double>(samples.distance[last]),
                               0.0);
  const double altitude_m =
      std::max(shared::AltitudeAlongRay<double>(from_m, mu, on_m, radius_m), 0.0);
  const auto there = [&](double cosine, double along) {
    return std::clamp(((radius_m + from_m) * cosine + on_m * along) / (radius_m + altitude_m), -1.0,
                      1.0);
  };
  return {altitude_m, there(mu, 1.0), there(static_cast<double>(samples.mu_s[last]), nu), nu};
}

// Returns the part of the light from behind the end of samples that the forward peak adds. It comes
// from the ground or, if the samples end before it, from the air and the ground that follow.
Spectrum MultipleScattering::PeakBehind(const RaySamples<float>& samples, double nu,
                                        double nu_seen) const {
  Spectrum light(bands_), closed(bands_);
  if (samples.extent.end == RayEnd::kSpace) return light;
  const DeltaM::Way way = peak_->WayTo(samples);
  const ViewRay ray = RayBehind(samples, nu);
  if (samples.extent.end == RayEnd::kGround) {
    light = GroundLight(ray.mu_s);
  } else {
    const RaySamples<float> after =
        peak_->air().Sample(ray, {.nodes = 12, .split_ozone = false, .dark_samples = true});
    if (after.count == 0) return light;
    light = InscatterByMoments(after, nu);
    closed = peak_->Behind(way, after, nu_seen);
    if (after.extent.end == RayEnd::kGround) {
      const DeltaM::Way further = peak_->WayTo(after);
      const Spectrum ground = GroundLight(RayBehind(after, nu).mu_s);
      for (std::size_t band = 0; band < bands_; ++band)
        light[band] += (further.clear[band] + further.more[band]) * ground[band];
    }
  }
  for (std::size_t band = 0; band < bands_; ++band)
    light[band] = way.more[band] * light[band] + closed[band];
  return light;
}

Spectrum MultipleScattering::Irradiance(double altitude_m, double mu_s, double normal_mu,
                                        double normal_cos_azimuth) const {
  const CubicTaps row = TapsAt(AltitudeCoordinate(altitude_m), options_.altitudes);
  const double x = (mu_s - SunNodes().centre()) / SunNodes().width();
  const double cell = (std::asinh(x) - static_cast<double>(grid_.first_asinh)) *
                      static_cast<double>(grid_.cells_a_unit);
  const CubicTaps column = TapsAt(cell / (options_.sun_angles - 1), options_.sun_angles);
  const float twilight = TwilightOf(grid_, mu_s);
  SurfacePoint point{
      {}, {}, SunSine(mu_s), static_cast<float>(normal_mu), static_cast<float>(normal_cos_azimuth)};
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t s = 0; s < 4; ++s) {
      point.node[4 * a + s] = static_cast<std::uint32_t>(row.node[a] * grid_.suns + column.node[s]);
      point.weight[4 * a + s] = twilight * row.weight[a] * column.weight[s];
    }
  }
  alignas(64) std::array<float, kMaxBands + kBlockBands> light{};
  Kernel<MomentKernel>().irradiance(grid_, point, blocks_.size(), packed_.data(),
                                    packed_sky_.data(), light.data());
  Spectrum irradiance(bands_);
  std::copy_n(light.begin(), bands_, irradiance.values().begin());
  if (peak_) {
    const double sines =
        static_cast<double>(SunSine(mu_s)) * static_cast<double>(SunSine(normal_mu));
    const double facing = std::max(normal_mu * mu_s + sines * normal_cos_azimuth, 0.0);
    const Spectrum beam = peak_->Beam(altitude_m, mu_s);
    for (std::size_t band = 0; band < bands_; ++band)
      irradiance[band] += static_cast<float>(facing) * beam[band];
  }
  return irradiance;
}

Spectrum MultipleScattering::SkyIrradiance(double altitude_m, double mu_s) const {
  Spectrum irradiance(bands_);
  VisitNodes(AltitudeCoordinate(altitude_m), mu_s,
             [&](const float* node, float weight, std::size_t) {
               for (std::size_t band = 0; band < bands_; ++band)
                 irradiance[band] += weight * node[(channels() - 1) * bands_ + band];
             });
  if (peak_) {
    const Spectrum beam = peak_->Beam(altitude_m, mu_s);
    for (std::size_t band = 0; band < bands_; ++band)
      irradiance[band] += static_cast<float>(std::max(mu_s, 0.0)) * beam[band];
  }
  for (std::size_t band = 0; band < bands_; ++band)
    irradiance[band] = std::max(irradiance[band], 0.0F);
  return irradiance;
}

std::vector<float> MultipleScattering::ValuesAt(double altitude_coordinate,
                                                double sun_coordinate) const {
  std::vector<float> sum(channels() * bands_, 0.0F);
  const double mu_s = SunNodes().MuS(sun_coordinate);
  const float here = SunSine(mu_s);
  VisitNodes(altitude_coordinate, mu_s, [&](const float* node, float weight, std::size_t sun) {
    const float there = SunSine(MuSOfNode(grid_, sun));
    for (std::size_t channel = 0; channel < channels(); ++channel) {
      const std::size_t m = OrderOf(channel);
      const float share = weight * SinePowerOf(grid_, m, here) / SinePowerOf(grid_, m, there);
      for (std::size_t i = channel * bands_; i < (channel + 1) * bands_; ++i)
        sum[i] += share * node[i];
    }
  });
  if (peak_) {
    const double altitude_m =
        medium_.atmosphere_height_m * altitude_coordinate * altitude_coordinate;
    AddBeam(options_, peak_->Beam(altitude_m, mu_s), mu_s, 1.0F, medium_.polarised, sum.data());
  }
  return sum;
}

std::size_t MultipleScattering::OrderOf(std::size_t channel) const {
  if (channel + 1 == channels()) return 0;
  if (channel >= moments_) return channel - moments_;
  std::size_t l = 0;
  while ((l + 1) * (l + 2) / 2 <= channel) ++l;
  return channel - l * (l + 1) / 2;
}

std::array<Spectrum, kTensorMoments> MultipleScattering::TensorAt(double altitude_m,
                                                                  double mu_s) const {
  std::array<Spectrum, kTensorMoments> tensor;
  tensor.fill(Spectrum(bands_));
  const float here = SunSine(mu_s);
  VisitNodes(
      AltitudeCoordinate(altitude_m), mu_s, [&](const float* node, float weight, std::size_t sun) {
        const float there = SunSine(MuSOfNode(grid_, sun));
        for (std::size_t m = 0; m < kTensorMoments; ++m) {
          const float share = weight * SinePowerOf(grid_, m, here) / SinePowerOf(grid_, m, there);
          const float* of_bands = node + (moments_ + m) * bands_;
          for (std::size_t band = 0; band < bands_; ++band)
            tensor[m][band] += share * of_bands[band];
        }
      });
  if (!peak_) return tensor;
  // Unpolarised light has T2m = L2m.
  const Spectrum beam = peak_->Beam(altitude_m, mu_s);
  const Moments towards = LegendreTerms(2, static_cast<float>(mu_s));
  for (std::size_t m = 0; m < kTensorMoments; ++m) {
    for (std::size_t band = 0; band < bands_; ++band)
      tensor[m][band] += towards[MomentIndex(2, static_cast<int>(m))] * beam[band];
  }
  return tensor;
}

PolarisedLight MultipleScattering::PolarisationAlong(const RaySamples<float>& samples,
                                                     double nu) const {
  PolarisedLight light{Spectrum(bands_), Spectrum(bands_)};
  if (!medium_.polarised) return light;
  for (std::size_t s = 0; s < samples.count; ++s) {
    const float mu = samples.mu[s], mu_s = samples.mu_s[s];
    const float sine = SunSine(static_cast<double>(mu));
    const auto cosine = static_cast<float>(AzimuthCosineOrAhead(double{mu}, double{mu_s}, nu));
    const float across = SunSine(static_cast<double>(cosine));
    const TensorStokes<float> stokes = TensorStokesAlong<float>(mu, sine);
    const std::array<Spectrum, kTensorMoments> here =
        TensorAt(1000.0 * static_cast<double>(samples.altitude[s]),
                 SunNodes().MuS(SunCoordinate(static_cast<double>(mu_s))));
    for (std::size_t band = 0; band < bands_; ++band) {
      const auto tensor = [&](std::size_t m) { return here[m][band]; };
      const float depth =
          OpticalDepthOf(ExtinctionAt(air_, band),
                         {samples.view_rayleigh[s], samples.view_mie[s], samples.view_ozone[s]});
      const float share = samples.weight[s] * std::exp(-depth) * air_.rayleigh[band] *
                          samples.rayleigh_density[s] * RayleighChi2(medium_, band);
      light.q[band] += share * (stokes.q20 * tensor(0) + stokes.q21 * cosine * tensor(1) +
                                stokes.q22 * (2.0F * cosine * cosine - 1.0F) * tensor(2));
      // If the sines of azimuths are positive, h points to the side away from the sun.
      light.u[band] -= share * (stokes.u21 * across * tensor(1) +
                                stokes.u22 * 2.0F * across * cosine * tensor(2));
    }
  }
  return light;
}

}  // namespace alpenglow::lut
