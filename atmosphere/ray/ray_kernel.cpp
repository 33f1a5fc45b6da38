// SPDX-License-Identifier: MIT
#include "atmosphere/ray/ray_kernel.h"

#include "atmosphere/ray/batch.h"

namespace alpenglow::atmosphere {
namespace {

/// The lengths of AirConstants, copied to all lanes.
template <typename Real, typename T>
struct ShellLengths {
  explicit ShellLengths(const AirConstants<Real>& air)
      : radius(air.radius),
        top(air.top),
        rayleigh(air.rayleigh_height),
        mie(air.mie_height),
        deficit(air.deficit),
        deficit_height(air.deficit_height),
        ozone_bottom(air.ozone_bottom),
        ozone_peak(air.ozone_peak),
        ozone_top(air.ozone_top),
        is_tall(IsTall(static_cast<double>(air.top), static_cast<double>(air.radius))),
        has_deficit(air.deficit > Real(0)),
        smooth_ozone(air.smooth_ozone),
        mie_ends_below_top(air.mie_ends_below_top) {}

  T radius, top, rayleigh, mie, deficit, deficit_height, ozone_bottom, ozone_peak, ozone_top;
  bool is_tall, has_deficit, smooth_ozone, mie_ends_below_top;
};

template <typename Real, typename T>
T OzoneColumnUp(const ShellLengths<Real, T>& shell, const T& h, const T& mu) {
  using namespace shared;
  if (shell.smooth_ozone) return SmoothOzoneColumnUp<T>(h, mu, shell.ozone_top, shell.radius);
  return TentColumnUp<T>(h, mu, shell.ozone_bottom, shell.ozone_peak, shell.ozone_top,
                         shell.radius);
}

template <typename Real, typename T>
T MoleculeColumnUp(const ShellLengths<Real, T>& shell, const T& h, const T& mu) {
  using namespace shared;
  const T column = ExponentialColumnUp<T>(h, mu, shell.rayleigh, shell.top, shell.radius);
  if (!shell.has_deficit) return column;
  return column + shell.deficit * column -
         DeficitColumnUp<T>(h, mu, shell.deficit, shell.deficit_height, shell.radius);
}

template <typename Real, typename T>
T MoleculeDensityAt(const ShellLengths<Real, T>& shell, const T& h) {
  using namespace shared;
  if (!shell.has_deficit) return exp(-h / shell.rayleigh);
  return MoleculeDensity<T>(h, shell.rayleigh, shell.deficit, shell.deficit_height);
}

template <typename Real, typename T>
ColumnSet<T> ColumnsUp(const ShellLengths<Real, T>& shell, const T& h, const T& mu) {
  using namespace shared;
  return {MoleculeColumnUp(shell, h, mu),
          shell.mie_ends_below_top
              ? ExponentialColumnToInfinity<T>(h, mu, shell.mie, shell.radius)
              : ExponentialColumnUp<T>(h, mu, shell.mie, shell.top, shell.radius),
          OzoneColumnUp(shell, h, mu)};
}

// Returns columns at the perigee. Points in the planet's shadow have perigees below the ground,
// whose columns are not used: they only have to be finite.
template <typename Real, typename T>
ColumnSet<T> ColumnsAtPerigee(const ShellLengths<Real, T>& shell, const T& h, const T& mu) {
  using namespace shared;
  const T perigee = max(PerigeeAltitude<T>(h, mu, shell.radius), T(Real(-1)));
  return ColumnsUp(shell, perigee, T(Real(0)));
}

template <typename Real, typename T>
ColumnSet<T> ColumnsTowards(const ShellLengths<Real, T>& shell, const T& h, const T& mu) {
  using namespace shared;
  const ColumnSet<T> up = ColumnsUp(shell, h, T(abs(mu)));
  if (BatchOf<Real>::All(mu >= T(Real(0)))) return up;
  const ColumnSet<T> low = ColumnsAtPerigee(shell, h, mu);
  return {ColumnToSun<T>(mu, up.rayleigh, low.rayleigh), ColumnToSun<T>(mu, up.mie, low.mie),
          ColumnToSun<T>(mu, up.ozone, low.ozone)};
}

template <typename T>
ColumnSet<T> Between(const T& mu_origin, const T& mu_point, const ColumnSet<T>& origin,
                     const ColumnSet<T>& point, const ColumnSet<T>& perigee) {
  using namespace shared;
  return {ColumnBetween<T>(mu_origin, mu_point, origin.rayleigh, point.rayleigh, perigee.rayleigh),
          ColumnBetween<T>(mu_origin, mu_point, origin.mie, point.mie, perigee.mie),
          ColumnBetween<T>(mu_origin, mu_point, origin.ozone, point.ozone, perigee.ozone)};
}

template <typename Real>
void Place(const PanelRule<Real>& panel, RaySamples<Real>& samples) {
  using namespace shared;
  using Lanes = BatchOf<Real>;
  using T = typename Lanes::Type;
  const T length(panel.end - panel.begin), begin(panel.begin), end(panel.end);
  const T lit(panel.lit ? Real(1) : Real(0));
  const T b(panel.stretch);
  const T scale = StretchedScale<T>(length, T(exp(b)));
  for (std::size_t i = 0; i < panel.count; i += Lanes::kLanes) {
    const T v = Lanes::Load(panel.node + i), weight = Lanes::Load(panel.weight + i);
    T t = length * v, derivative = length;
    if (panel.stretch > Real(0)) {
      const T growth = exp(b * v);
      t = StretchedDistance<T>(scale, growth);
      derivative = StretchedSlope<T>(scale, b, growth);
    }
    const std::size_t at = samples.count + i;
    Lanes::StoreAnywhere(&samples.distance[at], T(panel.rises ? begin + t : end - t));
    Lanes::StoreAnywhere(&samples.weight[at], T(weight * derivative));
    Lanes::StoreAnywhere(&samples.lit[at], lit);
  }
  samples.count += panel.count;
}

template <typename Real, typename T>
T OzoneDensity(const ShellLengths<Real, T>& shell, const T& h) {
  using namespace shared;
  if (shell.smooth_ozone) return SmoothOzoneDensity<T>(h, shell.ozone_top);
  return TentDensity<T>(h, shell.ozone_bottom, shell.ozone_peak, shell.ozone_top);
}

/// A ray, copied to all lanes.
template <typename Real, typename T>
struct RayInLanes {
  RayInLanes(const AirConstants<Real>& air, const RayEntry& entry)
      : shell(air),
        h0(static_cast<Real>(entry.altitude_km)),
        mu0(static_cast<Real>(entry.mu)),
        mu_s0(static_cast<Real>(entry.mu_s)),
        nu(static_cast<Real>(entry.nu)) {}

  ShellLengths<Real, T> shell;
  T h0, mu0, mu_s0, nu;
};

/// The part of a ray below altitude 0 (SubmergedSpan), where air has the density of altitude 0.
/// Without one the columns are those of the closed forms alone.
template <typename Real, typename T>
struct BelowGround {
  explicit BelowGround(const RayEntry& entry)
      : exists(entry.IsSubmerged()),
        begin(static_cast<Real>(entry.submerged_begin_km)),
        end(static_cast<Real>(entry.submerged_end_km)),
        mu(static_cast<Real>(entry.mu_ground)) {}

  /// Returns the columns up from a point of the ray; points below altitude 0 have those of the
  /// crossing.
  [[nodiscard]] ColumnSet<T> Up(const ShellLengths<Real, T>& shell, const T& h,
                                const T& cosine) const {
    using namespace shared;
    return ColumnsUp(shell, h, T(max(T(abs(cosine)), mu)));
  }
  /// Adds the length below altitude 0 on the way to distance d.
  void AddTo(ColumnSet<T>& columns, const T& d) const {
    using namespace shared;
    const T length = min(max(d, begin), end) - begin;
    columns.rayleigh += length;
    columns.mie += length;
  }

  bool exists;
  T begin, end, mu;
};

// Fills all values at the lanes from the i-th sample on, except the columns from the observer.
// Returns altitudes.
template <typename Real, typename T>
T FillButView(const RayInLanes<Real, T>& ray, std::size_t i, RaySamples<Real>& samples) {
  using namespace shared;
  using Lanes = BatchOf<Real>;
  const ShellLengths<Real, T>& shell = ray.shell;
  const T d = Lanes::Load(&samples.distance[i]);
  const T h = max(AltitudeAlongRay<T>(ray.h0, ray.mu0, d, shell.radius), T(Real(0)));
  const T mu_s = SunCosineAlongRay<T>(ray.h0, ray.mu_s0, ray.nu, d, h, shell.radius);
  const ColumnSet<T> sun = ColumnsTowards(shell, h, mu_s);
  const auto put = [i](auto& row, const T& value) { Lanes::Store(&row[i], value); };
  put(samples.altitude, h);
  put(samples.mu, ZenithCosineAlongRay<T>(ray.h0, ray.mu0, d, h, shell.radius));
  put(samples.mu_s, mu_s);
  put(samples.rayleigh_density, MoleculeDensityAt(shell, h));
  put(samples.mie_density, T(exp(-h / shell.mie)));
  put(samples.sun_rayleigh, sun.rayleigh);
  put(samples.sun_mie, sun.mie);
  put(samples.sun_ozone, sun.ozone);
  return h;
}

template <typename Real>
void Fill(const AirConstants<Real>& air, const RayEntry& entry, RaySamples<Real>& samples) {
  using namespace shared;
  using Lanes = BatchOf<Real>;
  using T = typename Lanes::Type;
  const RayInLanes<Real, T> ray(air, entry);
  const ShellLengths<Real, T>& shell = ray.shell;
  const T zero(Real(0));
  const BelowGround<Real, T> below(entry);
  ColumnSet<T> perigee{zero, zero, zero};
  if (entry.mu < 0.0)
    perigee = below.exists ? below.Up(shell, zero, zero) : ColumnsAtPerigee(shell, ray.h0, ray.mu0);
  // If all samples fit into one SIMD load with room to spare, the last lane is not a sample and
  // lies at the entry.
  const bool entry_among_samples =
      samples.padded == Lanes::kLanes && samples.count < samples.padded;
  ColumnSet<T> origin = perigee;
  if (!entry_among_samples) origin = below.Up(shell, T(max(ray.h0, zero)), ray.mu0);
  for (std::size_t i = 0; i < samples.padded; i += Lanes::kLanes) {
    const T h = FillButView<Real, T>(ray, i, samples);
    const T mu = Lanes::Load(&samples.mu[i]);
    const ColumnSet<T> point = below.Up(shell, h, mu);
    if (entry_among_samples) {
      origin = {T(Lanes::Last(point.rayleigh)), T(Lanes::Last(point.mie)),
                T(Lanes::Last(point.ozone))};
    }
    ColumnSet<T> view = Between<T>(ray.mu0, mu, origin, point, perigee);
    if (below.exists) below.AddTo(view, T(Lanes::Load(&samples.distance[i])));
    Lanes::Store(&samples.view_rayleigh[i], view.rayleigh);
    Lanes::Store(&samples.view_mie[i], view.mie);
    Lanes::Store(&samples.view_ozone[i], view.ozone);
  }
}

// Returns the columns from the preceding to each sample, for the lanes from the i-th sample on.
template <typename Real, typename T>
void FillSteps(const RayInLanes<Real, T>& ray, const Real* before, std::size_t i,
               RaySamples<Real>& samples) {
  using namespace shared;
  using Lanes = BatchOf<Real>;
  // Gauss-Legendre on [0, 1].
  constexpr std::size_t kNodes = 4;
  constexpr Real kNode[kNodes] = {Real(0.069431844202973713), Real(0.33000947820757187),
                                  Real(0.66999052179242813), Real(0.93056815579702629)};
  constexpr Real kWeight[kNodes] = {Real(0.17392742256872693), Real(0.32607257743127307),
                                    Real(0.32607257743127307), Real(0.17392742256872693)};
  const ShellLengths<Real, T>& shell = ray.shell;
  const T begin = Lanes::Load(before + i);
  const T length = Lanes::Load(&samples.distance[i]) - begin;
  ColumnSet<T> sum{T(Real(0)), T(Real(0)), T(Real(0))};
  const T per_rayleigh = T(Real(-1)) / shell.rayleigh, per_mie = T(Real(-1)) / shell.mie;
  const T per_deficit = T(Real(-1)) / shell.deficit_height;
  for (std::size_t k = 0; k < kNodes; ++k) {
    const T d = begin + T(kNode[k]) * length;
    const T along = shell.is_tall ? AltitudeAlongRay<T>(ray.h0, ray.mu0, d, shell.radius)
                                  : AltitudeNearby<T>(ray.h0, ray.mu0, d, shell.radius);
    const T h = max(along, T(Real(0)));
    const T weight(kWeight[k]);
    T molecules = exp(h * per_rayleigh);
    if (shell.has_deficit) molecules += shell.deficit * (molecules - exp(h * per_deficit));
    sum.rayleigh += weight * molecules;
    sum.mie += weight * exp(h * per_mie);
    sum.ozone += weight * OzoneDensity<Real, T>(shell, h);
  }
  Lanes::Store(&samples.view_rayleigh[i], T(sum.rayleigh * length));
  Lanes::Store(&samples.view_mie[i], T(sum.mie * length));
  Lanes::Store(&samples.view_ozone[i], T(sum.ozone * length));
}

template <typename Real>
void FillBetween(const AirConstants<Real>& air, const RayEntry& entry, RaySamples<Real>& samples) {
  using T = typename BatchOf<Real>::Type;
  const RayInLanes<Real, T> ray(air, entry);
  alignas(64) Real before[kMaxRaySamples];
  before[0] = Real(0);
  for (std::size_t i = 1; i < samples.padded; ++i)
    before[i] = i < samples.count ? samples.distance[i - 1] : Real(0);
  for (std::size_t i = 0; i < samples.padded; i += BatchOf<Real>::kLanes) {
    FillButView<Real, T>(ray, i, samples);
    FillSteps<Real, T>(ray, before, i, samples);
  }
  for (std::size_t i = 1; i < samples.count; ++i) {
    samples.view_rayleigh[i] += samples.view_rayleigh[i - 1];
    samples.view_mie[i] += samples.view_mie[i - 1];
    samples.view_ozone[i] += samples.view_ozone[i - 1];
  }
}

template <typename Real>
void Scatter(const AirConstants<Real>& air, const RaySamples<Real>& samples,
             ScatteredOnce<Real>& scattered) {
  using namespace shared;
  using Lanes = BatchOf<Real>;
  using T = typename Lanes::Type;
  for (std::size_t band = 0; band < air.bands; ++band) {
    const Extinction<T> extinction{T(air.rayleigh[band]), T(air.mie_extinction[band]),
                                   T(air.ozone[band])};
    T rayleigh_sum(Real(0)), mie_sum(Real(0));
    for (std::size_t i = 0; i < samples.padded; i += Lanes::kLanes) {
      const auto at = [i](const auto& row) { return Lanes::Load(&row[i]); };
      const ColumnSet<T> columns{at(samples.view_rayleigh) + at(samples.sun_rayleigh),
                                 at(samples.view_mie) + at(samples.sun_mie),
                                 at(samples.view_ozone) + at(samples.sun_ozone)};
      const T tau = OpticalDepthOf(extinction, columns);
      const T light = at(samples.weight) * at(samples.lit) * exp(-tau);
      rayleigh_sum += light * at(samples.rayleigh_density);
      mie_sum += light * at(samples.mie_density);
    }
    scattered.rayleigh[band] = Lanes::Sum(rayleigh_sum) * air.rayleigh[band];
    scattered.mie[band] = Lanes::Sum(mie_sum) * air.mie_scattering[band];
  }
}

template <typename Real, typename ColumnsOf>
void ForEachPoint(std::size_t n, const Real* altitude, const Real* mu,
                  const ColumnSet<Real*>& columns, const ColumnsOf& columns_of) {
  using Lanes = BatchOf<Real>;
  using T = typename Lanes::Type;
  for (std::size_t i = 0; i < n; i += Lanes::kLanes) {
    const ColumnSet<T> found = columns_of(T(Lanes::Load(altitude + i)), T(Lanes::Load(mu + i)));
    Lanes::Store(columns.rayleigh + i, found.rayleigh);
    Lanes::Store(columns.mie + i, found.mie);
    Lanes::Store(columns.ozone + i, found.ozone);
  }
}

template <typename Real>
void FindColumnsToSpace(const AirConstants<Real>& air, std::size_t n, const Real* altitude,
                        const Real* mu, const ColumnSet<Real*>& columns) {
  using T = typename BatchOf<Real>::Type;
  const ShellLengths<Real, T> shell(air);
  ForEachPoint(n, altitude, mu, columns,
               [&](const T& h, const T& cosine) { return ColumnsTowards(shell, h, cosine); });
}

template <typename Real>
void FindColumnsUp(const AirConstants<Real>& air, std::size_t n, const Real* altitude,
                   const Real* mu, const ColumnSet<Real*>& columns) {
  using T = typename BatchOf<Real>::Type;
  const ShellLengths<Real, T> shell(air);
  ForEachPoint(n, altitude, mu, columns,
               [&](const T& h, const T& cosine) { return ColumnsUp(shell, h, cosine); });
}

template <typename Real>
constexpr RayKernel<Real> kRayKernel{BatchOf<Real>::kLanes, Place<Real>,   Fill<Real>,
                                     FillBetween<Real>,     Scatter<Real>, FindColumnsToSpace<Real>,
                                     FindColumnsUp<Real>};

}  // namespace

const RayKernel<float>& KernelOf(KernelName<RayKernel<float>, kThisSet> /*name*/) {
  return kRayKernel<float>;
}

const RayKernel<double>& KernelOf(KernelName<RayKernel<double>, kThisSet> /*name*/) {
  return kRayKernel<double>;
}

}  // namespace alpenglow::atmosphere
