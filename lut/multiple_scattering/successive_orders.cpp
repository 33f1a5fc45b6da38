// SPDX-License-Identifier: MIT
#include "lut/multiple_scattering/successive_orders.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "atmosphere/math/constants.h"
#include "lut/multiple_scattering/four_bands.h"
#include "lut/multiple_scattering/lane_krylov.h"
#include "lut/multiple_scattering/moment_grid.h"
#include "lut/multiple_scattering/spherical_harmonics.h"

namespace alpenglow::lut {
namespace {

Four NotNegative(const Four& light) {
  const Four dark = {};
  return light < dark ? dark : light;
}

/// Memory layout of the nodes.
struct Layout {
  explicit Layout(const MomentGrid& grid)
      : degree(grid.degree),
        suns(grid.suns),
        nodes(grid.altitudes * grid.suns),
        stride(PackedVectors(grid.degree, grid.polarised) * 8) {}
  std::size_t degree, suns, nodes, stride;
};

/// Packed moments and sky irradiance at every node, divided by TwilightOf (and SinePower).
class Field {
 public:
  Field() = default;
  explicit Field(const Layout& layout)
      : values_(layout.nodes * (layout.stride + kBlockBands)),
        moments_(layout.nodes * layout.stride) {}

  [[nodiscard]] float* moments() { return values_.data(); }
  [[nodiscard]] const float* moments() const { return values_.data(); }
  [[nodiscard]] Four Sky(std::size_t node) const {
    return LoadFour(values_.data() + moments_ + node * kBlockBands);
  }
  void AddSky(std::size_t node, const Four& light) {
    StoreFour(values_.data() + moments_ + node * kBlockBands, Sky(node) + light);
  }
  [[nodiscard]] AlignedFloats& values() { return values_; }
  [[nodiscard]] const AlignedFloats& values() const { return values_; }

 private:
  AlignedFloats values_;
  std::size_t moments_ = 0;  // number of floats before the irradiances
};

Four Of(const std::vector<double>& bands, std::size_t first_band) {
  Four block = {};
  for (std::size_t lane = 0; lane < kBlockBands && first_band + lane < bands.size(); ++lane)
    block[static_cast<int>(lane)] = static_cast<float>(bands[first_band + lane]);
  return block;
}

/// Four bands of the light that arrives along a march, one value per sun and azimuth. Q and U, in
/// the frame of polarised_scattering.h, are present for polarised light only.
struct MarchRadiance {
  MarchRadiance(std::size_t rays, bool polarised) : i(rays), q(polarised ? rays : 0), u(q) {}
  std::vector<Four> i, q, u;
};

/// Transport of four bands along the marches of one set.
class Transport {
 public:
  Transport(const MomentMarches& marches, std::size_t first_band);

  /// Finds the moments of the light of the previous order that arrives at one altitude's nodes.
  /// @param is_light  whether negative values are errors, and become 0; a difference has both
  ///   signs.
  void NextOrder(std::size_t altitude, const Field& previous, Field& next, bool is_light) const;
  /// Finds the moments of sunlight from the radiance that SunlightScatteredOnce returns.
  void Project(const March& march, std::size_t altitude, const SunlightOfMarch& sunlight,
               Field& field) const;

 private:
  using Around = std::array<Four, kMaxDegree + 1>;
  [[nodiscard]] bool polarised() const { return marches_.grid().polarised; }
  void ProjectMarch(const March& march, std::size_t altitude, const MarchRadiance& radiance,
                    Field& field) const;
  [[nodiscard]] Around Harmonics(const Four* radiance, float share, bool sines) const;
  void AddMoments(const March& march, const Around& around, float sun_sine, float* moments) const;
  void AddTensor(const March& march, const Around& i, const Around& q, const Around& u,
                 float sun_sine, float* moments) const;
  void PolariseSunlight(const March& march, const SunlightOfMarch& sunlight,
                        MarchRadiance& radiance) const;
  void AddGroundLight(const March& march, const Four& reflected, const Field& previous,
                      bool is_light, std::vector<Four>& radiance) const;

  const MomentMarches& marches_;
  Layout layout_;
  std::size_t first_band_;
  Four albedo_;
  BlockShape shape_;
  std::vector<float> twilight_;
  std::vector<std::vector<std::vector<MarchLight>>> lights_;  // [altitude][march][point]
  std::vector<std::vector<Four>> ground_transmittance_;       // [altitude][march]
};

// Returns the factor of the weights of a march with which the light of a constant source, without
// ozone, is exact: 1 less the transmittance of the march. Without it each order would gain or lose
// the error of the quadrature, 1e-3 to 1e-2 in thick air, and hundreds of orders would have lost
// much of the light.
float FactorOfWeights(const AirConstants<float>& air, std::size_t band, const March& march) {
  const Extinction<float> extinction = ExtinctionAt(air, band);
  float sum = 0.0F;
  for (const auto& at : march.air) {
    sum += at[0] * (extinction.rayleigh * at[1] + extinction.mie * at[2]) *
           std::exp(-extinction.rayleigh * at[3] - extinction.mie * at[4]);
  }
  const float exact = -std::expm1(-extinction.rayleigh * march.columns_km[0] -
                                  extinction.mie * march.columns_km[1]);
  return sum > 0.0F ? exact / sum : 1.0F;
}

// Returns the transmittances to the points of a march, times their weights and scattering
// coefficients.
std::vector<MarchLight> LightsOf(const AirConstants<float>& air, std::size_t first_band,
                                 const March& march) {
  std::vector<MarchLight> lights(march.air.size());
  for (std::size_t lane = 0; lane < kBlockBands && first_band + lane < air.bands; ++lane) {
    const std::size_t band = first_band + lane;
    const float factor = FactorOfWeights(air, band, march);
    for (std::size_t i = 0; i < lights.size(); ++i) {
      const std::array<float, 6>& at = march.air[i];
      const float depth = OpticalDepthOf(ExtinctionAt(air, band), {at[3], at[4], at[5]});
      const float share = factor * at[0] * std::exp(-depth);
      lights[i].rayleigh[lane] = share * air.rayleigh[band] * at[1];
      lights[i].mie[lane] = share * air.mie_scattering[band] * at[2];
    }
  }
  return lights;
}

Transport::Transport(const MomentMarches& marches, std::size_t first_band)
    : marches_(marches),
      layout_(marches.grid()),
      first_band_(first_band),
      albedo_(Of(marches.air().medium().ground_albedo, first_band)),
      shape_(ShapeOfBlock(marches.air().medium(), marches.chi(), layout_.degree, first_band)),
      twilight_(TwilightAtNodes(marches.grid())) {
  const AirConstants<float>& air = marches.air().constants();
  for (std::size_t altitude = 0; altitude < marches.grid().altitudes; ++altitude) {
    auto& lights = lights_.emplace_back();
    auto& transmittance = ground_transmittance_.emplace_back();
    for (const March& march : marches.At(altitude)) {
      lights.push_back(LightsOf(air, first_band, march));
      const Spectrum& ground = march.ground_transmittance;
      transmittance.push_back(Of({ground.values().begin(), ground.values().end()}, first_band));
    }
  }
}

// Sums radiance over azimuths with cos(m phi), or with sin(m phi) for m = 1, 2.
Transport::Around Transport::Harmonics(const Four* radiance, float share, bool sines) const {
  Around around;
  const std::size_t last = sines ? 2 : layout_.degree, azimuths = marches_.azimuths();
  for (std::size_t m = sines ? 1 : 0; m <= last; ++m) {
    const float* const factor = sines ? marches_.AzimuthSines(m) : marches_.AzimuthCosines(m);
    Four sum = {};
    for (std::size_t k = 0; k < azimuths; ++k) sum += factor[k] * radiance[k];
    around[m] = sum * share;
  }
  return around;
}

void Transport::AddMoments(const March& march, const Around& around, float sun_sine,
                           float* moments) const {
  for (std::size_t l = 0; l <= layout_.degree; ++l) {
    for (std::size_t m = 0; m <= l; ++m) {
      float legendre = march.legendre[l * (l + 1) / 2 + m];
      if (polarised()) legendre /= SinePower(m, sun_sine);
      float* const moment = moments + PackedIndex(l, m);
      StoreFour(moment, LoadFour(moment) + legendre * around[m]);
    }
  }
}

// Adds the light of one zenith angle to T20, T21, T22 and to the copy of moment 00: with ll = (I +
// Q) / 2, hh = (I - Q) / 2 and lh = U / 2, J gains ll l l^T + hh h h^T + lh (l h^T + h l^T).
void Transport::AddTensor(const March& march, const Around& i, const Around& q, const Around& u,
                          float sun_sine, float* moments) const {
  constexpr float kFactor = static_cast<float>(5.0 / (2.0 * kPi));
  const float mu = march.mu, sine = march.sine;
  const Four ll0 = 0.5F * (i[0] + q[0]), hh0 = 0.5F * (i[0] - q[0]);
  const Four ll2 = 0.5F * (i[2] + q[2]), hh2 = 0.5F * (i[2] - q[2]);
  const Four zz_less_mean = (sine * sine - 0.5F * mu * mu) * ll0 - 0.5F * hh0;
  const Four xz = sine * (0.5F * u[1] - 0.5F * mu * (i[1] + q[1]));
  const Four xx_less_yy = mu * mu * ll2 - hh2 - mu * u[2];
  const Four tensor[kTensorMoments] = {
      (-kFactor / kTensorNorm[0]) * zz_less_mean, (-kFactor / kTensorNorm[1] / sun_sine) * xz,
      (-0.25F * kFactor / kTensorNorm[2] / SinePower(2, sun_sine)) * xx_less_yy};
  for (std::size_t m = 0; m < kTensorMoments; ++m) {
    float* const moment = moments + PackedTensorIndex(layout_.degree, m);
    StoreFour(moment, LoadFour(moment) + tensor[m]);
  }
  float* const trace = moments + PackedTensorTrace(layout_.degree);
  StoreFour(trace, LoadFour(trace) + march.legendre[0] * i[0]);
}

// Projects the radiance of all suns and azimuths along a march. Azimuths also represent their
// mirror images.
void Transport::ProjectMarch(const March& march, std::size_t altitude,
                             const MarchRadiance& radiance, Field& field) const {
  for (std::size_t sun = 0; sun < layout_.suns; ++sun) {
    const std::size_t node = altitude * layout_.suns + sun;
    const std::size_t ray = sun * marches_.azimuths();
    const float share = march.solid_angle / twilight_[sun];
    const float sun_sine = SunSine(marches_.mu_s(sun));
    float* moments = field.moments() + node * layout_.stride;
    const Around i = Harmonics(&radiance.i[ray], share, false);
    AddMoments(march, i, sun_sine, moments);
    if (polarised()) {
      AddTensor(march, i, Harmonics(&radiance.q[ray], share, false),
                Harmonics(&radiance.u[ray], share, true), sun_sine, moments);
    }
    if (march.mu > 0.0F) field.AddSky(node, march.mu * i[0]);
  }
}

// Finds the polarisation of scattered sunlight, which is unpolarised before molecules scatter it: J
// = E/2 P(sun).
void Transport::PolariseSunlight(const March& march, const SunlightOfMarch& sunlight,
                                 MarchRadiance& radiance) const {
  const std::size_t rays = layout_.suns * marches_.azimuths();
  const std::size_t bands = sunlight.molecules.size() / rays;
  for (std::size_t ray = 0; ray < rays; ++ray) {
    const std::size_t sun = ray / marches_.azimuths(), k = ray % marches_.azimuths();
    const auto mu_s = static_cast<float>(marches_.mu_s(sun));
    const float sun_sine = SunSine(marches_.mu_s(sun));
    const float in_l = march.mu * marches_.AzimuthCosines(1)[k] * sun_sine - march.sine * mu_s;
    const float in_h = -marches_.AzimuthSines(1)[k] * sun_sine;
    for (std::size_t lane = 0; lane < kBlockBands && first_band_ + lane < bands; ++lane) {
      const float light = static_cast<float>(3.0 / (16.0 * kPi)) * 10.0F *
                          shape_.rayleigh_chi2[lane] *
                          sunlight.molecules[(first_band_ + lane) * rays + ray];
      radiance.q[ray][static_cast<int>(lane)] = light * (in_h - in_l) * (in_h + in_l);
      radiance.u[ray][static_cast<int>(lane)] = -2.0F * light * in_l * in_h;
    }
  }
}

void Transport::Project(const March& march, std::size_t altitude, const SunlightOfMarch& sunlight,
                        Field& field) const {
  const std::size_t rays = layout_.suns * marches_.azimuths();
  const std::size_t bands = sunlight.radiance.size() / rays;
  MarchRadiance radiance(rays, polarised());
  for (std::size_t lane = 0; lane < kBlockBands && first_band_ + lane < bands; ++lane) {
    for (std::size_t ray = 0; ray < rays; ++ray)
      radiance.i[ray][static_cast<int>(lane)] =
          sunlight.radiance[(first_band_ + lane) * rays + ray];
  }
  if (polarised()) PolariseSunlight(march, sunlight, radiance);
  ProjectMarch(march, altitude, radiance, field);
}

// Adds the light of the previous order that the ground reflects into the march.
void Transport::AddGroundLight(const March& march, const Four& reflected, const Field& previous,
                               bool is_light, std::vector<Four>& radiance) const {
  for (std::size_t ray = 0; ray < radiance.size(); ++ray) {
    const CubicTaps& taps = march.ground_taps[ray];
    Four irradiance = {};
    for (std::size_t tap = 0; tap < 4; ++tap)
      irradiance += taps.weight[tap] * previous.Sky(taps.node[tap]);
    radiance[ray] += reflected * (is_light ? NotNegative(irradiance) : irradiance);
  }
}

void Transport::NextOrder(std::size_t altitude, const Field& previous, Field& next,
                          bool is_light) const {
  const std::size_t rays = layout_.suns * marches_.azimuths();
  const std::size_t stokes = polarised() ? 3 : 1;
  const MomentKernel& kernel = Kernel<MomentKernel>();
  AlignedFloats rows((layout_.suns + 2) * (layout_.degree / 2 + 3) * 8);
  AlignedFloats arriving(rays * stokes * 8);
  MarchRadiance radiance(rays, polarised());
  for (std::size_t i = 0; i < marches_.At(altitude).size(); ++i) {
    const March& march = marches_.At(altitude)[i];
    std::fill_n(arriving.data(), arriving.size(), 0.0F);
    kernel.arrive(marches_.grid(), marches_.Direction(altitude, march), march.points.data(),
                  lights_[altitude][i].data(), march.points.size(), shape_, previous.moments(),
                  rows.data(), arriving.data());
    for (std::size_t ray = 0; ray < rays; ++ray) {
      const float* const halves = arriving.data() + ray * stokes * 8;
      radiance.i[ray] = LoadFour(halves) + LoadFour(halves + 4);
      if (is_light) radiance.i[ray] = NotNegative(radiance.i[ray]);
      if (!polarised()) continue;
      radiance.q[ray] = LoadFour(halves + 8) + LoadFour(halves + 12);
      radiance.u[ray] = LoadFour(halves + 16) + LoadFour(halves + 20);
    }
    if (march.hits_ground) {
      const Four reflected =
          ground_transmittance_[altitude][i] * albedo_ * static_cast<float>(1.0 / kPi);
      AddGroundLight(march, reflected, previous, is_light, radiance.i);
    }
    ProjectMarch(march, altitude, radiance, next);
  }
}

/// Solution of four bands for all orders.
class Block {
 public:
  /// @param later  the marches of the orders after the second.
  Block(const MomentMarches& marches, const MomentMarches& later,
        const MultipleScatteringOptions& options, const OrderPartDone& part_done,
        std::size_t first_band)
      : options_(options),
        part_done_(part_done),
        layout_(marches.grid()),
        twilight_(TwilightAtNodes(marches.grid())),
        transport_(marches, first_band),
        later_(later, first_band) {}

  [[nodiscard]] const Transport& transport() const { return transport_; }
  [[nodiscard]] Field Empty() const { return Field(layout_); }

  /// A sum of orders.
  struct Sum {
    Field total;
    int orders;  // number of orders computed
    bool converged;
  };
  [[nodiscard]] Sum Solve(Field first_order) const;

 private:
  [[nodiscard]] Four Isotropic(const Field& field, std::size_t node) const {
    return LoadFour(field.moments() + node * layout_.stride);
  }
  [[nodiscard]] double LargestShare(const Field& part, const Field& whole) const;
  [[nodiscard]] Field After(const Transport& transport, const Field& field, bool is_light) const;
  void AddTail(const Field& last, const Field& before, const Field& second_before, double largest,
               Field& total) const;
  [[nodiscard]] Sum SumAfter(const Field& order, const Field& sum_before, int most) const;

  const MultipleScatteringOptions& options_;
  const OrderPartDone& part_done_;
  Layout layout_;
  std::vector<float> twilight_;
  Transport transport_, later_;
};

// Returns the largest ratio over nodes of the size of the isotropic moment of `part` to that of
// `whole`.
double Block::LargestShare(const Field& part, const Field& whole) const {
  constexpr float kNight = 1e-9F;  // nodes with less light are ignored
  double largest = 0.0;
  for (std::size_t node = 0; node < layout_.nodes; ++node) {
    const Four share = Isotropic(part, node), of = Isotropic(whole, node);
    for (int lane = 0; lane < static_cast<int>(kBlockBands); ++lane) {
      if (of[lane] * twilight_[node % layout_.suns] <= kNight) continue;
      largest = std::max(largest, static_cast<double>(std::abs(share[lane]) / of[lane]));
    }
  }
  return largest;
}

// Returns the light that follows from light by one more scattering or reflection.
Field Block::After(const Transport& transport, const Field& field, bool is_light) const {
  Field next = Empty();
  tbb::parallel_for(std::size_t{0}, layout_.nodes / layout_.suns, [&](std::size_t i) {
    transport.NextOrder(i, field, next, is_light);
    part_done_();
  });
  return next;
}

// Adds (last + before) (q + q^2 + ...) for the ratio q of an order to the second one before it.
// Over bright ground orders come in pairs: light that the ground reflects, and the part of it that
// the air scatters down again.
// @param largest  upper bound of q.
void Block::AddTail(const Field& last, const Field& before, const Field& second_before,
                    double largest, Field& total) const {
  for (std::size_t node = 0; node < layout_.nodes; ++node) {
    const Four now = Isotropic(last, node), then = Isotropic(second_before, node);
    Four factor = {};
    for (int lane = 0; lane < static_cast<int>(kBlockBands); ++lane) {
      if (then[lane] <= 0.0F) continue;
      const float ratio = std::clamp(now[lane] / then[lane], 0.0F, static_cast<float>(largest));
      factor[lane] = ratio / (1.0F - ratio);
    }
    for (std::size_t i = 0; i < layout_.stride; i += kBlockBands) {
      const std::size_t at = node * layout_.stride + i;
      const Four two = LoadFour(last.moments() + at) + LoadFour(before.moments() + at);
      float* const sum = total.moments() + at;
      StoreFour(sum, LoadFour(sum) + factor * two);
    }
    total.AddSky(node, factor * (last.Sky(node) + before.Sky(node)));
  }
}

// Number of orders that AddTail reads.
constexpr int kFewestOrders = 3;

// Number of orders that are summed one by one. Clear and hazy air needs no more.
constexpr int kMostSingleOrders = 16;

// Largest ratio of an order to the one before it at which light is known to decay.
constexpr double kSlowestDecay = 0.9999;

// Adds `times` times a part.
void Accumulate(const Field& part, float times, Field& total) {
  float* const sum = total.values().data();
  const float* const term = part.values().data();
  for (std::size_t i = 0; i < total.values().size(); i += kBlockBands)
    StoreFour(sum + i, LoadFour(sum + i) + times * LoadFour(term + i));
}

Field Difference(Field from, const Field& part) {
  Accumulate(part, -1.0F, from);
  return from;
}

Field Plus(Field sum, const Field& part) {
  Accumulate(part, 1.0F, sum);
  return sum;
}

// Returns the largest ratio of two norms.
double LargestRatio(const LaneNumbers& now, const LaneNumbers& before) {
  double largest = 0.0;
  for (std::size_t lane = 0; lane < kBlockBands; ++lane)
    if (before[lane] > 0.0) largest = std::max(largest, now[lane] / before[lane]);
  return largest;
}

// Returns the sum of all orders after `order`. In thick air they decay slowly: at an optical depth
// of 40, each is larger than 0.998 of the one before it. With S for one scattering, the sum x
// solves x = S (order + x) and is found by LaneKrylov from the residual S (order + x) - x.
// @param sum_before  of all orders up to `order`.
// @param most        largest number of scatterings to compute.
Block::Sum Block::SumAfter(const Field& order, const Field& sum_before, int most) const {
  constexpr int kBasis = 48;  // vectors in memory
  constexpr int kStepsBetweenChecks = 8;
  constexpr double kLargestResidual = 0.1;  // over the tolerance
  Sum sum{Empty(), 0, false};
  const auto scatter = [&](const Field& field, bool is_light) {
    ++sum.orders;
    return After(later_, field, is_light);
  };
  Field scattered = scatter(order, true);
  LaneNumbers residual = Norms(scattered.values());
  while (!sum.converged && sum.orders < most) {
    const Field begin = sum.total;
    LaneKrylov krylov(Difference(scattered, begin).values());
    for (int step = 1; step <= kBasis && !sum.converged && sum.orders < most; ++step) {
      Field newest = Empty();
      newest.values() = krylov.Newest();
      krylov.Extend(Difference(newest, scatter(newest, false)).values());
      if (step % kStepsBetweenChecks != 0 && sum.orders + 1 < most) continue;
      Field next = Empty();
      next.values() = krylov.Solution();
      next = Plus(std::move(next), begin);
      const Field change = Difference(next, sum.total);
      sum.total = std::move(next);
      scattered = scatter(Plus(order, sum.total), true);
      const Field rest = Difference(scattered, sum.total), whole = Plus(sum_before, scattered);
      const LaneNumbers residual_before = std::exchange(residual, Norms(rest.values()));
      // The error decreases like the residual; the last change is the difference of two errors.
      const double q = LargestRatio(residual, residual_before);
      sum.converged = q < 1.0 &&
                      LargestShare(change, whole) * q / (1.0 - q) <= options_.tolerance &&
                      LargestShare(rest, whole) <= kLargestResidual * options_.tolerance;
    }
  }
  sum.total = std::move(scattered);
  return sum;
}

Block::Sum Block::Solve(Field first_order) const {
  Field order = std::move(first_order);
  Field total = order;
  Field before, second_before;
  int orders = 1;
  double share = 1.0, rest = 1.0, ratio = 0.0;
  const int most = options_.exact_orders.value_or(std::min(options_.max_orders, kMostSingleOrders));
  const auto goes_on = [&] {
    if (options_.exact_orders) return orders < most;
    if (share <= 0.0 || orders >= most) return false;
    return orders < kFewestOrders || rest > options_.tolerance;
  };
  while (goes_on()) {
    Field next = After(orders == 1 ? transport_ : later_, order, true);
    Accumulate(next, 1.0F, total);
    second_before = std::move(before);
    before = std::move(order);
    order = std::move(next);
    ++orders;
    const double share_before = share;
    share = LargestShare(order, total);
    ratio = share / share_before;
    // Deep in thick air, light increases from order to order before it decays.
    rest = ratio < kSlowestDecay ? share * ratio / (1.0 - ratio) : 1.0;
  }
  if (options_.exact_orders) return {std::move(total), orders, true};
  if (rest > options_.tolerance && share > 0.0 && orders < options_.max_orders) {
    const Sum more = SumAfter(order, total, options_.max_orders - orders);
    Accumulate(more.total, 1.0F, total);
    return {std::move(total), orders + more.orders, more.converged};
  }
  const bool converged = rest <= options_.tolerance || share == 0.0;
  // Nodes of thin air may decay more slowly than the one with the largest share. Shares decay
  // faster than the light, because the sum of all orders increases.
  constexpr double kOfThinAir = 0.96;
  const double decay = converged ? std::min(ratio * (1.0 + share), kSlowestDecay) : 0.0;
  if (orders >= kFewestOrders)
    AddTail(order, before, second_before, std::max(decay * decay, kOfThinAir), total);
  return {std::move(total), orders, converged};
}

// Values of one block of bands in the order of MultipleScattering::values().
void Unpack(const MomentGrid& grid, const Field& field, std::size_t first_band, std::size_t bands,
            std::vector<float>& values) {
  const Layout layout(grid);
  const std::vector<float> twilight = TwilightAtNodes(grid);
  const std::size_t channels = values.size() / layout.nodes / bands;
  for (std::size_t node = 0; node < layout.nodes; ++node) {
    const float factor = twilight[node % layout.suns];
    const float sun_sine = SunSine(MuSOfNode(grid, node % layout.suns));
    const float* moments = field.moments() + node * layout.stride;
    for (std::size_t lane = 0; lane < kBlockBands && first_band + lane < bands; ++lane) {
      float* value = &values[node * channels * bands + first_band + lane];
      for (std::size_t l = 0; l <= layout.degree; ++l) {
        for (std::size_t m = 0; m <= l; ++m, value += bands)
          *value = factor * SinePowerOf(grid, m, sun_sine) * moments[PackedIndex(l, m) + lane];
      }
      for (std::size_t m = 0; grid.polarised && m < kTensorMoments; ++m, value += bands) {
        *value = factor * SinePowerOf(grid, m, sun_sine) *
                 moments[PackedTensorIndex(layout.degree, m) + lane];
      }
      *value = factor * field.Sky(node)[static_cast<int>(lane)];
    }
  }
}

// Returns the fraction of an aerosol's scattered sunlight that falls between the directions of the
// marches: [phase * suns + sun]. These directions are at least 11 degrees of azimuth from the sun.
// They miss 41 % of the light of the dust of Mars at 450 nm, 6 % of a lobe of g = 0.8 and 1 % of a
// lobe of g = 0.7.
std::vector<double> MissedShares(const MomentMarches& marches) {
  constexpr double kNoise = 0.01;  // error of the quadrature for phase functions that it resolves
  const std::size_t phases = marches.air().medium().mie_phase.size();
  const std::size_t suns = marches.grid().suns;
  std::vector<double> shares(phases * suns, 1.0);
  for (std::size_t sun = 0; sun < suns; ++sun) {
    for (const March& march : marches.At(0)) {
      for (std::size_t k = 0; k < marches.azimuths(); ++k) {
        const Spectrum around = marches.air().AerosolPhases(marches.Nu(march, sun, k));
        for (std::size_t phase = 0; phase < phases; ++phase)
          shares[phase * suns + sun] -= static_cast<double>(march.solid_angle * around[phase]);
      }
    }
  }
  for (double& share : shares) share = std::abs(share) < kNoise ? 0.0 : share;
  return shares;
}

// Returns the fraction of a beam's moments of degree l that is left after a blur which is just wide
// enough for moments to represent it without ringing.
float SpreadOf(std::size_t degree, std::size_t l) {
  const auto squared = [](std::size_t x) { return static_cast<float>(x * (x + 1)); };
  return std::exp(-2.3F * squared(l) / squared(degree + 1));
}

/// Light scattered once into a narrow peak that the marches miss. It is added as light from the
/// sun's direction.
class MissedPeak {
 public:
  explicit MissedPeak(const MomentMarches& marches)
      : marches_(marches),
        shares_(MissedShares(marches)),
        twilight_(TwilightAtNodes(marches.grid())) {}

  void Add(std::size_t altitude, std::size_t first_band, Field& field) const;

 private:
  void AddBand(const Spectrum& peak, std::size_t node, std::size_t first_band, Field& field) const;
  [[nodiscard]] Spectrum PeakAt(std::size_t altitude, std::size_t sun) const;

  const MomentMarches& marches_;
  std::vector<double> shares_;
  std::vector<float> twilight_;
};

// Returns the irradiance of the peak on a plane that faces the sun.
Spectrum MissedPeak::PeakAt(std::size_t altitude, std::size_t sun) const {
  const SingleScattering<float>& air = marches_.air();
  const Medium& medium = air.medium();
  const double altitude_m = 1000.0 * marches_.altitude_km(altitude), mu_s = marches_.mu_s(sun);
  Spectrum peak = air.TransmittanceToSpace(altitude_m, mu_s);
  const double aerosol_m = static_cast<double>(air.ColumnsToSpace(altitude_m, mu_s)[1]);
  for (std::size_t band = 0; band < peak.size(); ++band) {
    const std::size_t phase = medium.mie_phase.size() > 1 ? band : 0;
    peak[band] *= static_cast<float>(shares_[phase * marches_.grid().suns + sun] *
                                     medium.mie_scattering_per_m[band] * aerosol_m);
  }
  return peak;
}

void MissedPeak::Add(std::size_t altitude, std::size_t first_band, Field& field) const {
  const Layout layout(marches_.grid());
  if (altitude + 1 == marches_.grid().altitudes) return;  // no air lies above the top
  for (std::size_t sun = 0; sun < layout.suns; ++sun) {
    const ViewRay to_sun{1000.0 * marches_.altitude_km(altitude), marches_.mu_s(sun), 1.0, 1.0};
    const Medium& medium = marches_.air().medium();
    if (ExtentOf(to_sun, medium.planet_radius_m, medium.atmosphere_height_m).end == RayEnd::kGround)
      continue;
    AddBand(PeakAt(altitude, sun), altitude * layout.suns + sun, first_band, field);
  }
}

void MissedPeak::AddBand(const Spectrum& peak, std::size_t node, std::size_t first_band,
                         Field& field) const {
  const Layout layout(marches_.grid());
  const std::size_t sun = node % layout.suns;
  const auto mu_s = static_cast<float>(marches_.mu_s(sun));
  const Moments towards = LegendreTerms(static_cast<int>(layout.degree), mu_s);
  Four light = {};
  for (std::size_t lane = 0; lane < kBlockBands && first_band + lane < peak.size(); ++lane)
    light[static_cast<int>(lane)] = peak[first_band + lane] / twilight_[sun];
  float* moments = field.moments() + node * layout.stride;
  for (std::size_t l = 0; l <= layout.degree; ++l) {
    for (std::size_t m = 0; m <= l; ++m) {
      const float share = SpreadOf(layout.degree, l) *
                          towards[MomentIndex(static_cast<int>(l), static_cast<int>(m))] /
                          SinePowerOf(marches_.grid(), m, SunSine(marches_.mu_s(sun)));
      // Unpolarised light has T2m = L2m.
      const bool twice = marches_.grid().polarised && (l == 2 || l == 0);
      const std::size_t again = PackedTensorIndex(layout.degree, l == 0 ? 3 : m);
      for (std::size_t lane = 0; lane < kBlockBands; ++lane) {
        moments[PackedIndex(l, m) + lane] += share * light[static_cast<int>(lane)];
        if (twice) moments[again + lane] += share * light[static_cast<int>(lane)];
      }
    }
  }
  field.AddSky(node, std::max(mu_s, 0.0F) * light);
}

// Returns the options of the orders after the second. They are smooth, so fewer directions suffice.
MultipleScatteringOptions OfLaterOrders(MultipleScatteringOptions options) {
  options.zenith_nodes = std::min(options.zenith_nodes, options.later_zenith_nodes);
  options.azimuth_nodes = std::min(options.azimuth_nodes, options.later_azimuth_nodes);
  options.ray_nodes = std::min(options.ray_nodes, options.later_ray_nodes);
  return options;
}

}  // namespace

std::size_t PartsOfOrder(const Medium& medium, const MultipleScatteringOptions& options) {
  const std::size_t blocks = (medium.wavelengths_nm.size() + kBlockBands - 1) / kBlockBands;
  return blocks * static_cast<std::size_t>(options.altitudes);
}

SolvedOrders SolveSuccessiveOrders(const Medium& medium, const MultipleScatteringOptions& options,
                                   const OrderPartDone& part_done) {
  const DeltaScaledMedium rest = ScatteringMedium(medium, options);
  const SingleScattering<float> air(rest.medium);
  const MomentMarches marches(air, options, rest.chi);
  const MomentMarches later(air, OfLaterOrders(options), rest.chi);
  const std::size_t bands = medium.wavelengths_nm.size();
  std::vector<Block> blocks;
  std::vector<Field> first;
  for (std::size_t band = 0; band < bands; band += kBlockBands) {
    blocks.emplace_back(marches, later, options, part_done, band);
    first.push_back(blocks.back().Empty());
  }
  std::optional<MissedPeak> peak;
  if (!options.delta_m) peak.emplace(marches);
  tbb::parallel_for(std::size_t{0}, marches.grid().altitudes, [&](std::size_t altitude) {
    for (std::size_t block = 0; block < blocks.size(); ++block)
      if (peak) peak->Add(altitude, block * kBlockBands, first[block]);
    for (const March& march : marches.At(altitude)) {
      const SunlightOfMarch sunlight = SunlightScatteredOnce(marches, altitude, march, options);
      for (std::size_t block = 0; block < blocks.size(); ++block)
        blocks[block].transport().Project(march, altitude, sunlight, first[block]);
    }
    for (std::size_t block = 0; block < blocks.size(); ++block) part_done();
  });
  SolvedOrders solved;
  const std::size_t channels =
      MomentCount(options.degree) + 1 + (medium.polarised ? kTensorMoments : 0);
  solved.values.resize(Layout(marches.grid()).nodes * channels * bands);
  for (std::size_t block = 0; block < blocks.size(); ++block) {
    const Block::Sum sum = blocks[block].Solve(std::move(first[block]));
    solved.orders = std::max(solved.orders, sum.orders);
    solved.converged = solved.converged && sum.converged;
    Unpack(marches.grid(), sum.total, block * kBlockBands, bands, solved.values);
  }
  return solved;
}

}  // namespace alpenglow::lut
