// SPDX-License-Identifier: MIT
// Sixteen or eight lanes as vectors of the instruction set, and positions, densities and columns at
// the nodes of such a vector (formulas in optical_depth.glsl, ray_map.glsl and direct_panels.h).
// Only direct_kernel.cpp may include this header. Lengths are in km.
#pragma once

#include <bit>
#include <cstdint>
#include <type_traits>

#include "atmosphere/ray/batch.h"
#include "atmosphere/ray/direct_kernel.h"

namespace alpenglow::atmosphere {
namespace {

/// Number of bands that are summed over lanes together; kMaxBands is a multiple.
inline constexpr std::size_t kFour = 4;

#ifdef ALPENGLOW_BATCHES
/// The vector for groups of `count` lanes: as wide as the processor supports, at most `count`.
template <std::size_t count>
using LaneVector =
    xsimd::make_sized_batch_t<float,
                              (BatchOf<float>::kLanes < count ? BatchOf<float>::kLanes : count)>;

template <typename T>
T LoadLanes(const float* from) {
  return T::load_aligned(from);
}
template <typename A>
void StoreLanes(float* to, const xsimd::batch<float, A>& value) {
  value.store_unaligned(to);
}
// Stores four sums over lanes, times four factors.
template <typename A>
void StoreSums(const xsimd::batch<float, A>* value, const float* factor, float* to) {
  using Four = xsimd::make_sized_batch_t<float, kFour>;
  constexpr std::size_t kLanes = xsimd::batch<float, A>::size;
  alignas(64) float lanes[kLanes];
  Four quarter[kFour];
  for (std::size_t i = 0; i < kFour; ++i) {
    value[i].store_aligned(lanes);
    quarter[i] = Four::load_aligned(lanes);
    for (std::size_t at = kFour; at < kLanes; at += kFour)
      quarter[i] += Four::load_aligned(lanes + at);
  }
  (xsimd::haddp(quarter) * Four::load_unaligned(factor)).store_unaligned(to);
}
template <typename A>
float LaneOf(const xsimd::batch<float, A>& value, std::size_t lane) {
  return value.get(lane);
}
template <typename A>
bool AnyLane(const xsimd::batch_bool<float, A>& condition) {
  return xsimd::any(condition);
}
// Returns value 2^n, where n is in the low bits of `shifted`.
template <typename A>
xsimd::batch<float, A> TimesPowerOfTwo(const xsimd::batch<float, A>& value,
                                       const xsimd::batch<float, A>& shifted) {
  using Whole = xsimd::batch<std::int32_t, A>;
  // The template argument of xsimd::bitwise_cast is another one since xsimd 11.
  const Whole exponent = std::bit_cast<Whole>(shifted) << 23;
  return std::bit_cast<xsimd::batch<float, A>>(std::bit_cast<Whole>(value) + exponent);
}
#else
template <std::size_t count>
using LaneVector = float;

template <typename T>
T LoadLanes(const float* from) {
  return *from;
}
void StoreLanes(float* to, float value) { *to = value; }
void StoreSums(const float* value, const float* factor, float* to) {
  for (std::size_t i = 0; i < kFour; ++i) to[i] = value[i] * factor[i];
}
float LaneOf(float value, std::size_t) { return value; }
bool AnyLane(bool condition) { return condition; }
float TimesPowerOfTwo(float value, float shifted) {
  const std::uint32_t exponent = std::bit_cast<std::uint32_t>(shifted) << 23;
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(value) + exponent);
}
#endif

template <typename T>
constexpr std::size_t kLanesOf = sizeof(T) / sizeof(float);

// Returns 2^x for x < 100, relative error 3e-7. Below 2^-60 the result is clamped: products of
// three such numbers are then not subnormal, which would be slow.
template <typename T>
T PowerOfTwo(const T& x) {
  using namespace shared;
  const T rounding(
      12582912.0F);  // 1.5 2^23: adding it moves the nearest whole number into the low bits
  const T bounded = max(x, T(-60.0F));
  const T shifted = bounded + rounding;
  const T f = bounded - (shifted - rounding);
  T p = T(0.00967151299F) + f * T(0.00132647285F);
  p = T(0.0555073358F) + f * p;
  p = T(0.240222424F) + f * p;
  p = T(0.693147004F) + f * p;
  p = T(1.0F) + f * p;
  return TimesPowerOfTwo(p, shifted);
}

constexpr std::size_t kHalf = kDirectLanes / 2;

// Factor 1 for lanes that belong to the second panel of a group, else 0.
alignas(64) constexpr float kSecond[kDirectLanes] = {0, 0, 0, 0, 0, 0, 0, 0,
                                                     1, 1, 1, 1, 1, 1, 1, 1};
alignas(64) constexpr float kEntryLane[kDirectLanes] = {0, 0, 0, 0, 0, 0, 0, 1};
alignas(64) constexpr float kPerigeeLane[kDirectLanes] = {0, 0, 0, 0, 0, 0, 0, 0,
                                                          0, 0, 0, 0, 0, 0, 0, 1};

/// The panels of a group, one for each half of its lanes.
struct TwoPanels {
  const DirectPanel& first;
  const DirectPanel& second;
};

/// Reads the parameters of two panels into the lanes from `first` on.
template <typename T>
struct PanelLanes {
  const TwoPanels& panels;
  std::size_t first;

  T operator()(float DirectPanel::*number) const {
    return Spread(panels.first.*number, panels.second.*number);
  }
  T Spread(float a, float b) const {
    using namespace shared;
    if constexpr (kLanesOf<T> <= kHalf) {
      return T(first < kHalf ? a : b);
    } else {
      return select(LoadLanes<T>(kSecond + first) > T(0.5F), T(b), T(a));
    }
  }
};

/// Positions of the nodes of a vector.
template <typename T>
struct NodePlaces {
  T position;  // upwards along the panel from its low end [km]
  T weight;    // Gauss weight times derivative of the map [km]
  T altitude, radius;
  T mu, mu_s;  // mu >= 0, upwards along the panel
};

template <typename T>
T Position(const PanelLanes<T>& panel, const T& v, const T& slope, const T& length) {
  using namespace shared;
  const T position = length * DirectDistance<T>(v, slope);
  const auto is_entry = LoadLanes<T>(kEntryLane + panel.first) > T(0.5F);
  const auto is_perigee = LoadLanes<T>(kPerigeeLane + panel.first) > T(0.5F);
  return select(is_perigee, panel(&DirectPanel::perigee),
                select(is_entry, panel(&DirectPanel::entry), position));
}

template <typename T>
T AltitudeOnPanel(const DirectAir& air, const PanelLanes<T>& panel, const T& position) {
  using namespace shared;
  const T inverse = panel(&DirectPanel::inverse_radius);
  const T x = position * (position + T(2.0F) * panel(&DirectPanel::from_perigee)) *
              (T(0.5F) * inverse * inverse);
  const T climb = air.is_tall ? T(2.0F) / (T(1.0F) + sqrt(max(T(1.0F) + T(2.0F) * x, T(0.0F))))
                              : ClimbSeries<T>(x);
  return panel(&DirectPanel::altitude) + panel(&DirectPanel::radius) * x * climb;
}

template <typename T>
NodePlaces<T> PlacesOf(const DirectAir& air, const DirectRule& rule, const PanelLanes<T>& panel) {
  using namespace shared;
  const T v = LoadLanes<T>(rule.node.data() + panel.first);
  const T slope = panel(&DirectPanel::slope), length = panel(&DirectPanel::length);
  NodePlaces<T> at;
  at.weight = LoadLanes<T>(rule.weight.data() + panel.first) * length * DirectSlope<T>(v, slope);
  at.position = Position(panel, v, slope, length);
  const T from_perigee = panel(&DirectPanel::from_perigee), r = panel(&DirectPanel::radius);
  at.altitude = max(AltitudeOnPanel<T>(air, panel, at.position), T(0.0F));
  at.radius = at.altitude + T(static_cast<float>(air.radius));
  const T per_radius = T(1.0F) / at.radius;
  at.mu = abs(at.position + from_perigee) * per_radius;
  at.mu_s = (r * panel(&DirectPanel::mu_s) + at.position * panel(&DirectPanel::nu)) * per_radius;
  return at;
}

/// Columns from points upwards along the ray (mu >= 0), and in a direction with the elevation of
/// the sun.
template <typename T>
struct TwoColumns {
  T view, sun;
};

/// A layer at some altitudes: its density relative to the ground, and its upward column divided by
/// the shape of DirectColumnShape.
template <typename T>
struct LayerAt {
  const DirectLayer& layer;
  T density, scale;

  LayerAt(const DirectLayer& of_layer, const T& altitude, const T& root_radius)
      : layer(of_layer),
        density(PowerOfTwo<T>(altitude * T(of_layer.per_height))),
        scale(density * root_radius * T(of_layer.up_scale)) {}

  /// Returns columns upwards, from mu sqrt(R + h) of two directions. Both columns share one
  /// division.
  [[nodiscard]] TwoColumns<T> Up(const T& view_root, const T& sun_root) const {
    using namespace shared;
    const T delta(layer.delta), view = T(1.0F) + view_root * T(layer.root),
                                sun = T(1.0F) + sun_root * T(layer.root);
    const T below_view = DirectDenominator<T>(view, delta);
    const T below_sun = DirectDenominator<T>(sun, delta);
    const T inverse = scale / (below_view * below_sun);
    return {DirectNumerator<T>(view) * (inverse * below_sun),
            DirectNumerator<T>(sun) * (inverse * below_view)};
  }
};

template <typename T>
T ColumnBeyondTop(const DirectLayer& layer, const T& mu_top) {
  return T(layer.beyond_scale) *
         shared::DirectColumnShape<T>(mu_top * T(layer.beyond_root), T(layer.delta));
}

template <typename T>
T PerigeeColumn(const DirectLayer& layer, const T& altitude, const T& root_radius) {
  return PowerOfTwo<T>(altitude * T(layer.per_height)) * root_radius * T(layer.perigee_scale);
}

template <typename T, std::size_t count>
T Polynomial(const std::array<float, count>& coefficients, const T& x) {
  T sum(coefficients[count - 1]);
  for (std::size_t i = count - 1; i-- > 0;) sum = T(coefficients[i]) + x * sum;
  return sum;
}

/// The polynomials in U of smooth ozone at some altitudes.
template <typename T>
struct SmoothOzoneHere {
  T in_cosine[kOzoneCosines];

  SmoothOzoneHere(const DirectAir& air, const T& altitude) {
    const T y = Height(air, altitude);
    for (std::size_t q = 0; q < kOzoneCosines; ++q)
      in_cosine[q] = Polynomial<T>(air.ozone_fit.up[q], y);
  }
  static T Height(const DirectAir& air, const T& altitude) {
    using namespace shared;
    const T within = min(max(altitude, T(0.0F)), T(air.ozone_top));
    return within * T(2.0F / air.ozone_top) - T(1.0F);
  }
  [[nodiscard]] TwoColumns<T> Up(const T& view_mu, const T& sun_mu) const {
    const T k(kOzoneCosine), inverse = T(1.0F) / ((view_mu + k) * (sun_mu + k));
    return {Along(view_mu, inverse * (sun_mu + k)), Along(sun_mu, inverse * (view_mu + k))};
  }
  // @param inverse  1 / (mu + k).
  [[nodiscard]] T Along(const T& mu, const T& inverse) const {
    using namespace shared;
    const T u = mu * inverse * T(2.0F * (1.0F + kOzoneCosine)) - T(1.0F);
    T sum = in_cosine[kOzoneCosines - 1];
    for (std::size_t q = kOzoneCosines - 1; q-- > 0;) sum = in_cosine[q] + u * sum;
    return max(sum * inverse, T(0.0F));
  }
};

template <typename T>
T TentUp(const DirectAir& air, const T& altitude, const T& mu) {
  return shared::TentColumnUp<T>(altitude, mu, T(air.ozone_bottom), T(air.ozone_peak),
                                 T(air.ozone_top), T(static_cast<float>(air.radius)));
}

template <typename T>
TwoColumns<T> OzoneUp(const DirectAir& air, const NodePlaces<T>& at, const T& sun_mu) {
  if (!air.has_ozone) return {T(0.0F), T(0.0F)};
  if (!air.smooth_ozone)
    return {TentUp<T>(air, at.altitude, at.mu), TentUp<T>(air, at.altitude, sun_mu)};
  return SmoothOzoneHere<T>(air, at.altitude).Up(at.mu, sun_mu);
}

template <typename T>
T OzoneAtPerigee(const DirectAir& air, const T& altitude) {
  using namespace shared;
  if (!air.has_ozone) return T(0.0F);
  if (!air.smooth_ozone) return TentUp<T>(air, max(altitude, T(0.0F)), T(0.0F));
  const T y = SmoothOzoneHere<T>::Height(air, altitude);
  return max(Polynomial<T>(air.ozone_fit.perigee, y), T(0.0F));
}

/// The columns and densities that determine the light at the nodes of a vector.
template <typename T>
struct NodeAir {
  T rayleigh_density, mie_density;
  ColumnSet<T> view, sun;  // view: upwards along the panel, to space
};

template <typename T>
NodeAir<T> AirUpwards(const DirectAir& air, const NodePlaces<T>& at) {
  using namespace shared;
  const T root = sqrt(at.radius), sun_mu = abs(at.mu_s);
  const T view_root = at.mu * root, sun_root = sun_mu * root;
  const LayerAt<T> gas(air.rayleigh, at.altitude, root), aerosol(air.mie, at.altitude, root);
  const TwoColumns<T> rayleigh = gas.Up(view_root, sun_root), mie = aerosol.Up(view_root, sun_root),
                      ozone = OzoneUp<T>(air, at, sun_mu);
  NodeAir<T> node{gas.density,
                  aerosol.density,
                  {rayleigh.view, mie.view, ozone.view},
                  {rayleigh.sun, mie.sun, ozone.sun}};
  if (!air.has_deficit) return node;
  const LayerAt<T> deficit(air.deficit, at.altitude, root);
  const TwoColumns<T> missing = deficit.Up(view_root, sun_root);
  node.rayleigh_density += T(air.deficit_share) * (gas.density - deficit.density);
  node.view.rayleigh -= missing.view;
  node.sun.rayleigh -= missing.sun;
  return node;
}

/// Densities relative to the ground; for ozone relative to its peak.
template <typename T>
struct NodeDensities {
  T rayleigh, mie, ozone;
};

template <typename T>
T OzoneDensity(const DirectAir& air, const T& altitude) {
  using namespace shared;
  if (!air.has_ozone) return T(0.0F);
  if (air.smooth_ozone) return SmoothOzoneDensity<T>(altitude, T(air.ozone_top));
  return TentDensity<T>(altitude, T(air.ozone_bottom), T(air.ozone_peak), T(air.ozone_top));
}

template <typename T>
NodeDensities<T> DensitiesAt(const DirectAir& air, const T& altitude) {
  const auto density = [&](const DirectLayer& layer) {
    return PowerOfTwo<T>(altitude * T(layer.per_height));
  };
  T rayleigh = density(air.rayleigh);
  if (air.has_deficit) rayleigh += T(air.deficit_share) * (rayleigh - density(air.deficit));
  return {rayleigh, density(air.mie), OzoneDensity<T>(air, altitude)};
}

// Returns columns at the perigees of the sunbeams, for beams from below the horizontal. For points
// in the planet's shadow the perigee is below the ground, and the columns only have to be finite.
template <typename T>
ColumnSet<T> ColumnsAtSunPerigee(const DirectAir& air, const NodePlaces<T>& at) {
  using namespace shared;
  const T radius(static_cast<float>(air.radius));
  const T altitude =
      max(PerigeeAltitude<T>(at.altitude, min(abs(at.mu_s), T(1.0F)), radius), T(-1.0F));
  const T root = sqrt(altitude + radius);
  T rayleigh = PerigeeColumn<T>(air.rayleigh, altitude, root);
  if (air.has_deficit) rayleigh -= PerigeeColumn<T>(air.deficit, altitude, root);
  return {rayleigh, PerigeeColumn<T>(air.mie, altitude, root), OzoneAtPerigee<T>(air, altitude)};
}

template <typename T>
void PassPerigees(const DirectAir& air, const NodePlaces<T>& at, ColumnSet<T>& sun) {
  using namespace shared;
  if (!AnyLane(at.mu_s < T(0.0F))) return;
  const ColumnSet<T> low = ColumnsAtSunPerigee(air, at);
  sun = {ColumnToSun<T>(at.mu_s, sun.rayleigh, low.rayleigh),
         ColumnToSun<T>(at.mu_s, sun.mie, low.mie), ColumnToSun<T>(at.mu_s, sun.ozone, low.ozone)};
}

// Subtracts the part above the top from columns to space.
template <typename T>
void CutAtTop(const DirectAir& air, const NodePlaces<T>& at, ColumnSet<T>& sun) {
  using namespace shared;
  const T top(static_cast<float>(air.top)), radius(static_cast<float>(air.radius));
  const T along = at.radius * at.mu_s;
  const T climb = max((top - at.altitude) * (at.altitude + top + T(2.0F) * radius), T(0.0F));
  const T mu_top = min(sqrt(along * along + climb) / (top + radius), T(1.0F));
  sun.rayleigh = max(sun.rayleigh - ColumnBeyondTop<T>(air.rayleigh, mu_top), T(0.0F));
  sun.mie = max(sun.mie - ColumnBeyondTop<T>(air.mie, mu_top), T(0.0F));
}

template <typename T>
NodeAir<T> AirAt(const DirectAir& air, const NodePlaces<T>& at) {
  NodeAir<T> node = AirUpwards<T>(air, at);
  PassPerigees<T>(air, at, node.sun);
  if (air.reaches_top) CutAtTop<T>(air, at, node.sun);
  return node;
}

}  // namespace
}  // namespace alpenglow::atmosphere
