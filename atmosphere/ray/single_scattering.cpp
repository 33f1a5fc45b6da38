// SPDX-License-Identifier: MIT
#include "atmosphere/ray/single_scattering.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <type_traits>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/medium/phase_table.h"
#include "atmosphere/medium/phase_text.h"
#include "atmosphere/ray/ray.h"
#include "atmosphere/ray/shell.h"

namespace alpenglow::atmosphere {
namespace {

// Returns PhaseTable::Position in float, computed from the sine of half the angle to the nearer
// end, which resolves small angles there.
float PositionOf(double nu) {
  const double nearer = std::clamp(0.5 - 0.5 * std::abs(nu), 0.0, 0.5);
  const float share =
      2.0F * static_cast<float>(1.0 / kPi) * std::asin(std::sqrt(static_cast<float>(nearer)));
  return std::cbrt(nu < 0.0 ? 1.0F - share : share) * static_cast<float>(PhaseTable::kNodes - 1);
}

std::size_t RoundUp(std::size_t count, std::size_t lanes) {
  return (count + lanes - 1) / lanes * lanes;
}

/// Returns the lengths and coefficients of a medium in km.
template <typename Real>
AirConstants<Real> ConstantsOf(const Medium& medium) {
  const auto km = [](double metres) { return static_cast<Real>(metres / kMetresPerKilometre); };
  AirConstants<Real> air{};
  air.radius = km(medium.planet_radius_m);
  air.top = km(medium.atmosphere_height_m);
  air.rayleigh_height = km(medium.rayleigh_scale_height_m);
  air.mie_height = km(medium.mie_scale_height_m);
  air.deficit = static_cast<Real>(medium.rayleigh_deficit.share);
  air.deficit_height = km(medium.rayleigh_deficit.scale_height_m);
  air.ozone_bottom = km(medium.ozone.bottom_m);
  air.ozone_peak = km(medium.ozone.peak_m);
  air.ozone_top = km(medium.ozone.top_m);
  air.mie_ends_below_top = medium.mie_scale_height_m *
                               std::exp(-medium.atmosphere_height_m / medium.mie_scale_height_m) *
                               40.0 <
                           1e-12;
  air.smooth_ozone = medium.ozone.shape == OzoneShape::kSmooth;
  air.bands = medium.wavelengths_nm.size();
  for (std::size_t band = 0; band < air.bands; ++band) {
    const auto per_km = [band](const std::vector<double>& per_m) {
      return static_cast<Real>(per_m[band] * kMetresPerKilometre);
    };
    air.rayleigh[band] = per_km(medium.rayleigh_scattering_per_m);
    air.mie_scattering[band] = per_km(medium.mie_scattering_per_m);
    air.mie_extinction[band] = per_km(medium.mie_extinction_per_m);
    air.ozone[band] = per_km(medium.ozone_absorption_per_m);
  }
  return air;
}

/// Computes columns at up to kLength points with the kernel.
template <typename Real, std::size_t kLength = 16>
struct ColumnRows {
  alignas(64) std::array<Real, kLength> altitude{}, mu{}, rayleigh, mie, ozone;

  void Set(std::size_t i, double altitude_km, double cosine) {
    altitude[i] = static_cast<Real>(altitude_km);
    mu[i] = static_cast<Real>(cosine);
  }
  [[nodiscard]] ColumnSet<Real> At(std::size_t i) const { return {rayleigh[i], mie[i], ozone[i]}; }
  [[nodiscard]] ColumnSet<Real*> Targets() { return {rayleigh.data(), mie.data(), ozone.data()}; }
};

template <typename Real>
ColumnSet<Real> ColumnsBetween(Real mu_origin, Real mu_point, const ColumnSet<Real>& origin,
                               const ColumnSet<Real>& point, const ColumnSet<Real>& perigee) {
  using namespace shared;
  return {
      ColumnBetween<Real>(mu_origin, mu_point, origin.rayleigh, point.rayleigh, perigee.rayleigh),
      ColumnBetween<Real>(mu_origin, mu_point, origin.mie, point.mie, perigee.mie),
      ColumnBetween<Real>(mu_origin, mu_point, origin.ozone, point.ozone, perigee.ozone)};
}

// Ends the rows after `count` samples, with weightless samples up to a multiple of the SIMD lanes.
template <typename Real>
void CloseSamples(std::size_t count, RaySamples<Real>& samples) {
  samples.count = count;
  samples.padded = RoundUp(count, Kernel<RayKernel<Real>>().lanes);
  for (; count < samples.padded; ++count) {
    samples.distance[count] = samples.weight[count] = samples.lit[count] = Real(0);
  }
}

/// Gauss rules of 1 to kMaxGaussNodes nodes in the form that kernels use, padded with zeros.
template <typename Real>
class RuleRows {
 public:
  static constexpr std::size_t kLength = kMaxGaussNodes + 16;
  struct alignas(64) Row {
    alignas(64) std::array<Real, kLength> node{};
    alignas(64) std::array<Real, kLength> weight{};
  };

  [[nodiscard]] static const Row& Of(int nodes) {
    ALPENGLOW_ENSURE(nodes, >=, 1);
    ALPENGLOW_ENSURE(nodes, <=, kMaxGaussNodes);
    static const std::vector<Row> rows = Make();
    return rows[static_cast<std::size_t>(nodes - 1)];
  }

 private:
  static std::vector<Row> Make() {
    std::vector<Row> rows(kMaxGaussNodes);
    for (int n = 1; n <= kMaxGaussNodes; ++n) {
      const GaussRule& rule = GaussLegendre(n);
      Row& row = rows[static_cast<std::size_t>(n - 1)];
      const auto real = [](double value) { return static_cast<Real>(value); };
      std::transform(rule.node.begin(), rule.node.end(), row.node.begin(), real);
      std::transform(rule.weight.begin(), rule.weight.end(), row.weight.begin(), real);
    }
    return rows;
  }
};

// Places Gauss nodes in every panel, in the order of the panels.
template <typename Real>
void PlaceSamples(const RayPanels& panels, RaySamples<Real>& samples) {
  const RayKernel<Real>& kernel = Kernel<RayKernel<Real>>();
  for (std::size_t i = 0; i < panels.count; ++i) {
    const RayPanel& panel = panels.panel[i];
    const auto count = static_cast<std::size_t>(panel.nodes);
    ALPENGLOW_ENSURE(samples.count + count + 16, <=, kMaxRaySamples);
    const auto& rule = RuleRows<Real>::Of(panel.nodes);
    kernel.place({.begin = static_cast<Real>(panel.begin),
                  .end = static_cast<Real>(panel.end),
                  .stretch = static_cast<Real>(panel.stretch),
                  .rises = panel.rises,
                  .lit = panel.lit,
                  .count = count,
                  .node = rule.node.data(),
                  .weight = rule.weight.data()},
                 samples);
  }
  CloseSamples(samples.count, samples);
}

// Returns the column of a layer along [begin, end] km from the entry by 8 Gauss nodes: exact to
// 1e-7 relative while the density is smooth and the altitudes span less than 6 scale heights,
// however short the segment.
template <typename Density>
double ShortColumn(const RayEntry& entry, double begin, double end, double radius,
                   const Density& density) {
  const GaussRule& rule = GaussLegendre(8);
  double sum = 0.0;
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double h = shared::AltitudeAlongRay<double>(entry.altitude_km, entry.mu,
                                                      begin + rule.node[i] * (end - begin), radius);
    sum += rule.weight[i] * density(std::max(h, 0.0));
  }
  return sum * (end - begin);
}

// Returns the column of the ozone tent in the same way, for each linear part separately: a rule
// across an edge of the tent has an error of 1 %.
double ShortTentColumn(const RayEntry& entry, double length, double radius,
                       const OzoneLayer& tent) {
  const double bottom = tent.bottom_m / kMetresPerKilometre;
  const double peak = tent.peak_m / kMetresPerKilometre;
  const double top = tent.top_m / kMetresPerKilometre;
  std::vector<double> cuts{0.0, length};
  for (const double z : {bottom, peak, top}) {
    const LineCrossings crossings = CrossingsOf(entry.altitude_km, entry.mu, z, radius);
    cuts.insert(cuts.end(), crossings.distance.begin(),
                crossings.distance.begin() + static_cast<std::ptrdiff_t>(crossings.count));
  }
  for (double& cut : cuts) cut = std::clamp(cut, 0.0, length);
  std::sort(cuts.begin(), cuts.end());
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    if (cuts[i] == cuts[i + 1]) continue;
    sum += ShortColumn(entry, cuts[i], cuts[i + 1], radius,
                       [&](double h) { return shared::TentDensity<double>(h, bottom, peak, top); });
  }
  return sum;
}

double ShortOzoneColumn(const RayEntry& entry, double length, double radius,
                        const OzoneLayer& ozone) {
  if (ozone.shape == OzoneShape::kTent) return ShortTentColumn(entry, length, radius, ozone);
  const double top = ozone.top_m / kMetresPerKilometre;
  return ShortColumn(entry, 0.0, length, radius,
                     [top](double h) { return shared::SmoothOzoneDensity<double>(h, top); });
}

// Returns the column of a layer above and below altitude 0. The density has a kink there, across
// which no rule integrates.
template <typename Density>
double ShortColumnBelowToo(const RayEntry& entry, double length, double radius,
                           const Density& density) {
  if (!entry.IsSubmerged()) return ShortColumn(entry, 0.0, length, radius, density);
  return ShortColumn(entry, 0.0, entry.submerged_begin_km, radius, density) +
         (entry.submerged_end_km - entry.submerged_begin_km) * density(0.0) +
         ShortColumn(entry, entry.submerged_end_km, length, radius, density);
}

// Returns the columns along a segment. The difference of two closed forms is accurate to 1e-7 of
// the whole column, which is too inaccurate for a short segment; short segments are integrated.
template <typename Real>
ColumnSet<Real> SegmentColumns(const AirConstants<Real>& air, const Medium& medium,
                               const RayEntry& entry, double length) {
  using namespace shared;
  const double radius = medium.planet_radius_m / kMetresPerKilometre;
  const double h_end =
      std::max(AltitudeAlongRay<double>(entry.altitude_km, entry.mu, length, radius), 0.0);
  const double mu_end =
      ZenithCosineAlongRay<double>(entry.altitude_km, entry.mu, length, h_end, radius);
  const double perigee = PerigeeAltitude<double>(entry.altitude_km, entry.mu, radius);
  const bool through = entry.mu < 0.0 && mu_end > 0.0;
  const double h_begin = std::max(entry.altitude_km, 0.0);
  const double low = through ? std::max(perigee, 0.0) : std::min(h_begin, h_end);
  const double span = std::max(h_begin, h_end) - low;
  const bool below = entry.IsSubmerged();

  const auto real = [](double value) { return static_cast<Real>(value); };
  const RayKernel<Real>& kernel = Kernel<RayKernel<Real>>();
  ColumnRows<Real> rows;
  rows.Set(0, h_begin, std::max(std::abs(entry.mu), entry.mu_ground));
  rows.Set(1, h_end, std::max(std::abs(mu_end), entry.mu_ground));
  rows.Set(2, std::max(perigee, below ? 0.0 : -1.0), entry.mu_ground);
  kernel.columns_up(air, RoundUp(3, kernel.lanes), rows.altitude.data(), rows.mu.data(),
                    rows.Targets());
  ColumnSet<Real> columns =
      ColumnsBetween<Real>(real(entry.mu), real(mu_end), rows.At(0), rows.At(1), rows.At(2));
  const Real submerged = real(entry.submerged_end_km - entry.submerged_begin_km);
  columns.rayleigh += submerged;
  columns.mie += submerged;
  const auto molecules = [&medium](double h) {
    return MoleculeDensity(medium, h * kMetresPerKilometre);
  };
  const auto aerosol = [&medium](double h) {
    return std::exp(-h * kMetresPerKilometre / medium.mie_scale_height_m);
  };
  const double rayleigh = medium.rayleigh_scale_height_m / kMetresPerKilometre;
  const double mie = medium.mie_scale_height_m / kMetresPerKilometre;
  if (span < 4.0 * rayleigh)
    columns.rayleigh = real(ShortColumnBelowToo(entry, length, radius, molecules));
  if (span < 4.0 * mie) columns.mie = real(ShortColumnBelowToo(entry, length, radius, aerosol));
  if (span < 2.0) columns.ozone = real(ShortOzoneColumn(entry, length, radius, medium.ozone));
  return columns;
}

}  // namespace

PhaseNodes::PhaseNodes(const Medium& medium) : bands_(medium.wavelengths_nm.size()) {
  value_.reserve(PhaseTable::kNodes * bands_);
  for (std::size_t node = 0; node < PhaseTable::kNodes; ++node) {
    for (std::size_t band = 0; band < bands_; ++band)
      value_.push_back(static_cast<float>(MiePhase(medium, band).table->nodes()[node]));
  }
}

Spectrum PhaseNodes::At(double nu) const {
  const float position = PositionOf(nu);
  const auto cell = std::min(static_cast<std::size_t>(position), PhaseTable::kNodes - 2);
  const float share = position - static_cast<float>(cell);
  const float* low = &value_[cell * bands_];
  Spectrum values(bands_);
  for (std::size_t band = 0; band < bands_; ++band)
    values[band] = low[band] + share * (low[bands_ + band] - low[band]);
  return values;
}

template <typename Real>
SingleScattering<Real>::SingleScattering(const Medium& medium) : medium_(medium), constants_{} {
  Validate(medium_, kForLight);
  constants_ = ConstantsOf<Real>(medium_);
  if (std::is_same_v<Real, float> && medium_.mie_phase.front().kind == PhaseKind::kTable)
    phase_nodes_ = PhaseNodes(medium_);
}

template <typename Real>
std::array<Real, 3> SingleScattering<Real>::ColumnsToSpace(double altitude_m, double mu) const {
  const RayKernel<Real>& kernel = Kernel<RayKernel<Real>>();
  ColumnRows<Real> rows;
  rows.Set(0, altitude_m / kMetresPerKilometre, mu);
  kernel.columns_to_space(constants_, kernel.lanes, rows.altitude.data(), rows.mu.data(),
                          rows.Targets());
  const ColumnSet<Real> columns = rows.At(0);
  const Real metres = static_cast<Real>(kMetresPerKilometre);
  return {columns.rayleigh * metres, columns.mie * metres, columns.ozone * metres};
}

template <typename Real>
std::array<std::vector<Real>, 3> SingleScattering<Real>::ColumnsToSpace(
    std::span<const Real> altitudes_m, std::span<const Real> mu) const {
  ALPENGLOW_ENSURE(altitudes_m.size(), ==, mu.size());
  constexpr std::size_t kBlock = 128;
  const RayKernel<Real>& kernel = Kernel<RayKernel<Real>>();
  ColumnRows<Real, kBlock> rows;
  std::array<std::vector<Real>, 3> columns;
  for (auto& species : columns) species.reserve(mu.size());
  const auto metres = [](Real km) { return km * static_cast<Real>(kMetresPerKilometre); };
  for (std::size_t first = 0; first < mu.size(); first += kBlock) {
    const std::size_t count = std::min(kBlock, mu.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      rows.altitude[i] = altitudes_m[first + i] / static_cast<Real>(kMetresPerKilometre);
      rows.mu[i] = mu[first + i];
    }
    kernel.columns_to_space(constants_, RoundUp(count, kernel.lanes), rows.altitude.data(),
                            rows.mu.data(), rows.Targets());
    const auto row_end = static_cast<std::ptrdiff_t>(count);
    std::transform(rows.rayleigh.begin(), rows.rayleigh.begin() + row_end,
                   std::back_inserter(columns[0]), metres);
    std::transform(rows.mie.begin(), rows.mie.begin() + row_end, std::back_inserter(columns[1]),
                   metres);
    std::transform(rows.ozone.begin(), rows.ozone.begin() + row_end, std::back_inserter(columns[2]),
                   metres);
  }
  return columns;
}

template <typename Real>
SpectrumOf<Real> SingleScattering<Real>::TransmittanceToSpace(double altitude_m, double mu) const {
  const ViewRay ray{altitude_m, mu, 1.0, 1.0};
  if (mu < 0.0 || !(altitude_m >= 0.0 && altitude_m <= medium_.atmosphere_height_m)) {
    const RayExtent extent = ExtentOf(ray, medium_.planet_radius_m, medium_.atmosphere_height_m);
    if (extent.end == RayEnd::kGround) return SpectrumOf<Real>(bands());
    return TransmittanceAlong(ray);
  }
  const RayKernel<Real>& kernel = Kernel<RayKernel<Real>>();
  ColumnRows<Real> rows;
  rows.Set(0, altitude_m / kMetresPerKilometre, mu);
  kernel.columns_up(constants_, kernel.lanes, rows.altitude.data(), rows.mu.data(), rows.Targets());
  const ColumnSet<Real> columns = rows.At(0);
  SpectrumOf<Real> transmittance(bands());
  for (std::size_t band = 0; band < bands(); ++band) {
    transmittance[band] = std::exp(-OpticalDepthOf(ExtinctionAt(constants_, band), columns));
  }
  return transmittance;
}

template <typename Real>
ColumnSet<Real> SingleScattering<Real>::ColumnsAlong(const ViewRay& ray) const {
  const RayExtent extent = ExtentOf(ray, medium_.planet_radius_m, medium_.atmosphere_height_m);
  const RayEntry entry = EntryOf(ray, extent, medium_);
  return SegmentColumns<Real>(constants_, medium_, entry,
                              (extent.end_m - extent.begin_m) / kMetresPerKilometre);
}

template <typename Real>
SpectrumOf<Real> SingleScattering<Real>::OpticalDepthAlong(const ViewRay& ray) const {
  const ColumnSet<Real> columns = ColumnsAlong(ray);
  const Real metres = static_cast<Real>(kMetresPerKilometre);
  SpectrumOf<Real> depth(bands());
  for (std::size_t band = 0; band < bands(); ++band) {
    depth[band] = metres * OpticalDepthOf(ExtinctionAt<Real>(medium_, band), columns);
  }
  return depth;
}

template <typename Real>
SpectrumOf<Real> SingleScattering<Real>::TransmittanceAlong(const ViewRay& ray) const {
  const SpectrumOf<Real> depth = OpticalDepthAlong(ray);
  SpectrumOf<Real> transmittance(bands());
  for (std::size_t band = 0; band < bands(); ++band) transmittance[band] = std::exp(-depth[band]);
  return transmittance;
}

template <typename Real>
RaySamples<Real> SingleScattering<Real>::Sample(const ViewRay& ray,
                                                const Sampling& sampling) const {
  RaySamples<Real> samples;
  samples.extent = ExtentOf(ray, medium_.planet_radius_m, medium_.atmosphere_height_m);
  const RayEntry entry = EntryOf(ray, samples.extent, medium_);
  PlaceSamples(PanelsOf(ray, samples.extent, entry, medium_, sampling), samples);
  Kernel<RayKernel<Real>>().fill(constants_, entry, samples);
  return samples;
}

template <typename Real>
RaySamples<Real> SingleScattering<Real>::SampleAt(const ViewRay& ray,
                                                  std::span<const RayNode> nodes) const {
  const RayExtent extent = ExtentOf(ray, medium_.planet_radius_m, medium_.atmosphere_height_m);
  return SampleAt(ray, extent, PlanetShadow(ray, extent, medium_.planet_radius_m), nodes,
                  ViewColumns::kFromSpace);
}

template <typename Real>
RaySamples<Real> SingleScattering<Real>::SampleAt(const ViewRay& ray, const RayExtent& extent,
                                                  const ShadowSpan& shadow,
                                                  std::span<const RayNode> nodes,
                                                  ViewColumns columns) const {
  ALPENGLOW_ENSURE(nodes.size() + 16, <=, kMaxRaySamples);
  RaySamples<Real> samples;
  samples.extent = extent;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double d = nodes[i].distance_m;
    const bool dark = d > shadow.dark_begin_m && d < shadow.dark_end_m;
    samples.distance[i] = static_cast<Real>((d - extent.begin_m) / kMetresPerKilometre);
    samples.weight[i] = static_cast<Real>(nodes[i].weight_m / kMetresPerKilometre);
    samples.lit[i] = dark ? Real(0) : Real(1);
  }
  CloseSamples(nodes.size(), samples);
  const RayKernel<Real>& kernel = Kernel<RayKernel<Real>>();
  const auto fill = columns == ViewColumns::kFromSpace ? kernel.fill : kernel.fill_between;
  fill(constants_, EntryOf(ray, extent, medium_), samples);
  return samples;
}

template <typename Real>
ScatteredOnce<Real> SingleScattering<Real>::Scatter(const RaySamples<Real>& samples) const {
  ScatteredOnce<Real> scattered{SpectrumOf<Real>(bands()), SpectrumOf<Real>(bands())};
  Kernel<RayKernel<Real>>().scatter(constants_, samples, scattered);
  return scattered;
}

template <typename Real>
SpectrumOf<Real> SingleScattering<Real>::AerosolPhases(double nu) const {
  if constexpr (std::is_same_v<Real, float>) {
    if (!phase_nodes_.empty()) return phase_nodes_.At(nu);
  }
  const std::vector<PhaseFunction>& phases = medium_.mie_phase;
  SpectrumOf<Real> values(bands());
  for (std::size_t i = 0; i < phases.size(); ++i)
    values[i] = static_cast<Real>(Phase(phases[i], nu));
  if (phases.size() == 1) std::fill_n(values.values().begin(), bands(), values[0]);
  return values;
}

template <typename Real>
SpectrumOf<Real> SingleScattering<Real>::Inscatter(const ScatteredOnce<Real>& scattered,
                                                   double nu) const {
  const std::vector<double>& depolarisation = medium_.rayleigh_depolarisation;
  Real rayleigh_phase = Real(0);
  SpectrumOf<Real> radiance = AerosolPhases(nu);
  for (std::size_t band = 0; band < bands(); ++band) {
    if (band < depolarisation.size())
      rayleigh_phase = static_cast<Real>(shared::PhaseMolecules(nu, depolarisation[band]));
    radiance[band] =
        rayleigh_phase * scattered.rayleigh[band] + radiance[band] * scattered.mie[band];
  }
  return radiance;
}

template class SingleScattering<float>;
template class SingleScattering<double>;

}  // namespace alpenglow::atmosphere
