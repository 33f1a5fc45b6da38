// SPDX-License-Identifier: MIT
#include "atmosphere/ray/direct_kernel.h"

#include "atmosphere/ray/direct_nodes.h"

namespace alpenglow {
namespace {

/// A group of `count` lanes in vectors.
template <std::size_t count>
struct Lanes {
  using T = LaneVector<count>;
  static constexpr std::size_t kVectors = count / kLanesOf<T>;
  NodePlaces<T> place[kVectors];
  NodeAir<T> air[kVectors];

  [[nodiscard]] ColumnSet<float> ViewOf(std::size_t lane) const {
    const ColumnSet<T>& view = air[lane / kLanesOf<T>].view;
    const std::size_t i = lane % kLanesOf<T>;
    return {LaneOf(view.rayleigh, i), LaneOf(view.mie, i), LaneOf(view.ozone, i)};
  }
};

/// Columns from the eye, from columns upwards to space: base + sign column.
struct ViewBase {
  ColumnSet<float> rising, falling;
};

template <std::size_t count>
ViewBase BaseOf(const Lanes<count>& lanes, bool falls) {
  const ColumnSet<float> entry = lanes.ViewOf(kHalf - 1);
  ViewBase base{entry, {-entry.rayleigh, -entry.mie, -entry.ozone}};
  if (!falls || count < kDirectLanes) return base;
  const ColumnSet<float> low = lanes.ViewOf(count - 1);
  base.rising = {2.0F * low.rayleigh - entry.rayleigh, 2.0F * low.mie - entry.mie,
                 2.0F * low.ozone - entry.ozone};
  return base;
}

template <typename T>
T FromEye(const PanelLanes<T>& panel, float rising, float falling, const T& up) {
  using namespace shared;
  const auto base = [&](const DirectPanel& one) { return one.direction > 0.0F ? rising : falling; };
  const T from_entry = panel.Spread(base(panel.panels.first), base(panel.panels.second));
  return max(from_entry - panel(&DirectPanel::direction) * up, T(0.0F));
}

template <std::size_t count>
void FillLanes(const DirectAir& air, const DirectRule& rule, const TwoPanels& panels, bool falls,
               Lanes<count>& lanes) {
  using T = LaneVector<count>;
  for (std::size_t i = 0; i < Lanes<count>::kVectors; ++i) {
    lanes.place[i] = PlacesOf<T>(air, rule, PanelLanes<T>{panels, i * kLanesOf<T>});
    lanes.air[i] = AirAt<T>(air, lanes.place[i]);
  }
  const ViewBase base = BaseOf<count>(lanes, falls);
  for (std::size_t i = 0; i < Lanes<count>::kVectors; ++i) {
    const PanelLanes<T> panel{panels, i * kLanesOf<T>};
    ColumnSet<T>& view = lanes.air[i].view;
    view = {FromEye<T>(panel, base.rising.rayleigh, base.falling.rayleigh, view.rayleigh),
            FromEye<T>(panel, base.rising.mie, base.falling.mie, view.mie),
            FromEye<T>(panel, base.rising.ozone, base.falling.ozone, view.ozone)};
  }
}

/// Sums over the nodes of a ray, lane by lane, for each block of four bands: molecules and aerosol,
/// and, of four rows, the same with the last polynomial.
template <typename T, std::size_t rows>
using LightLanes = std::array<std::array<std::array<T, kFour>, rows>, kMaxBands / kFour>;

/// The factors that the light of a group is summed from.
template <std::size_t count, std::size_t rows>
struct LitLanes {
  using T = LaneVector<count>;
  static constexpr std::size_t kVectors = Lanes<count>::kVectors;
  ColumnSet<T> columns[kVectors];  // from the sun to the eye
  T weight[kVectors][rows];

  LitLanes(const DirectRule& rule, const Lanes<count>& lanes) {
    for (std::size_t i = 0; i < kVectors; ++i) {
      const NodeAir<T>& node = lanes.air[i];
      columns[i] = {node.view.rayleigh + node.sun.rayleigh, node.view.mie + node.sun.mie,
                    node.view.ozone + node.sun.ozone};
      weight[i][0] = lanes.place[i].weight * node.rayleigh_density;
      weight[i][1] = lanes.place[i].weight * node.mie_density;
      if constexpr (rows == 4) {
        const T last = LoadLanes<T>(rule.last_polynomial.data() + i * kLanesOf<T>);
        weight[i][2] = last * weight[i][0];
        weight[i][3] = last * weight[i][1];
      }
    }
  }
  template <typename Block>
  void AddBand(const Extinction<T>& extinction, std::size_t band, Block& block) const {
    for (std::size_t i = 0; i < kVectors; ++i) {
      const T arriving = PowerOfTwo<T>(-OpticalDepthOf(extinction, columns[i]));
      for (std::size_t row = 0; row < rows; ++row) block[row][band] += arriving * weight[i][row];
    }
  }
};

template <std::size_t count, std::size_t rows, typename T>
void AddLight(const DirectAir& air, const LitLanes<count, rows>& lit, bool first,
              LightLanes<T, rows>& light) {
  for (std::size_t band = 0; band < air.bands; band += kFour) {
    auto& block = light[band / kFour];
    for (std::size_t i = 0; i < kFour; ++i) {
      if (first) {
        for (auto& row : block) row[i] = T(0.0F);
      }
      lit.AddBand({T(air.rayleigh_extinction[band + i]), T(air.mie_extinction[band + i]),
                   T(air.ozone_extinction[band + i])},
                  i, block);
    }
  }
}

template <typename T, std::size_t rows>
void StoreLight(const DirectAir& air, const LightLanes<T, rows>& light, std::size_t first_row,
                ScatteredOnce<float>& scattered) {
  for (std::size_t band = 0; band < air.bands; band += kFour) {
    const auto& block = light[band / kFour];
    StoreSums(block[first_row].data(), &air.rayleigh_scattering[band], &scattered.rayleigh[band]);
    StoreSums(block[first_row + 1].data(), &air.mie_scattering[band], &scattered.mie[band]);
  }
}

const DirectRule& RuleOf(const DirectRules& rules, const DirectGroup& group, bool narrow) {
  return group.first != group.second || narrow ? rules.seven : rules.fourteen;
}

template <std::size_t count>
void FillGroup(const DirectAir& air, const DirectRules& rules, const DirectRay& ray, std::size_t i,
               Lanes<count>& lanes) {
  const DirectGroup& group = ray.group[i];
  FillLanes<count>(air, RuleOf(rules, group, ray.narrow),
                   {ray.panel[group.first], ray.panel[group.second]}, ray.falls, lanes);
}

template <std::size_t count, std::size_t rows>
[[gnu::flatten]] void ScatterLanes(const DirectAir& air, const DirectRules& rules,
                                   const DirectRay& ray, ScatteredOnce<float>& scattered,
                                   ScatteredOnce<float>* last) {
  LightLanes<LaneVector<count>, rows> light;
  for (std::size_t i = 0; i < ray.groups; ++i) {
    Lanes<count> lanes;
    FillGroup<count>(air, rules, ray, i, lanes);
    const LitLanes<count, rows> lit(RuleOf(rules, ray.group[i], ray.narrow), lanes);
    AddLight<count, rows>(air, lit, i == 0, light);
  }
  StoreLight<LaneVector<count>, rows>(air, light, 0, scattered);
  if constexpr (rows == 4) StoreLight<LaneVector<count>, rows>(air, light, 2, *last);
}

void SetDark(const DirectAir& air, ScatteredOnce<float>& scattered) {
  for (std::size_t band = 0; band < air.bands; ++band)
    scattered.rayleigh[band] = scattered.mie[band] = 0.0F;
}

template <std::size_t rows>
void ScatterRows(const DirectAir& air, const DirectRules& rules, const DirectRay& ray,
                 ScatteredOnce<float>& scattered, ScatteredOnce<float>* last) {
  if (ray.groups == 0) {
    SetDark(air, scattered);
    if (last != nullptr) SetDark(air, *last);
  } else if (ray.narrow) {
    ScatterLanes<kHalf, rows>(air, rules, ray, scattered, last);
  } else {
    ScatterLanes<kDirectLanes, rows>(air, rules, ray, scattered, last);
  }
}

void Scatter(const DirectAir& air, const DirectRules& rules, const DirectRay& ray,
             ScatteredOnce<float>& scattered, ScatteredOnce<float>* last) {
  if (last == nullptr) {
    ScatterRows<2>(air, rules, ray, scattered, last);
  } else {
    ScatterRows<4>(air, rules, ray, scattered, last);
  }
}

template <std::size_t count>
void StoreGroup(const TwoPanels& panels, const Lanes<count>& lanes, RaySamples<float>& samples) {
  using namespace shared;
  using T = LaneVector<count>;
  for (std::size_t i = 0; i < Lanes<count>::kVectors; ++i) {
    const PanelLanes<T> panel{panels, i * kLanesOf<T>};
    const std::size_t at = samples.count + panel.first;
    const auto put = [at](auto& row, const T& value) { StoreLanes(&row[at], value); };
    const NodePlaces<T>& place = lanes.place[i];
    const NodeAir<T>& node = lanes.air[i];
    const T direction = panel(&DirectPanel::direction);
    put(samples.distance, panel(&DirectPanel::begin) + direction * place.position);
    put(samples.weight, place.weight);
    put(samples.lit, panel(&DirectPanel::lit));
    put(samples.altitude, place.altitude);
    put(samples.mu, direction * min(place.mu, T(1.0F)));
    put(samples.mu_s, min(max(place.mu_s, T(-1.0F)), T(1.0F)));
    put(samples.rayleigh_density, node.rayleigh_density);
    put(samples.mie_density, node.mie_density);
    put(samples.view_rayleigh, node.view.rayleigh);
    put(samples.view_mie, node.view.mie);
    put(samples.view_ozone, node.view.ozone);
    put(samples.sun_rayleigh, node.sun.rayleigh);
    put(samples.sun_mie, node.sun.mie);
    put(samples.sun_ozone, node.sun.ozone);
  }
  samples.count += count;
}

// Weightless samples up to whole SIMD lanes.
void Pad(RaySamples<float>& samples) {
  constexpr std::size_t kLanes = BatchOf<float>::kLanes;
  samples.padded = (samples.count + kLanes - 1) / kLanes * kLanes;
  for (auto* row : {&samples.distance, &samples.weight, &samples.lit, &samples.altitude,
                    &samples.mu, &samples.mu_s, &samples.rayleigh_density, &samples.mie_density,
                    &samples.view_rayleigh, &samples.view_mie, &samples.view_ozone,
                    &samples.sun_rayleigh, &samples.sun_mie, &samples.sun_ozone}) {
    for (std::size_t i = samples.count; i < samples.padded; ++i) (*row)[i] = 0.0F;
  }
}

template <std::size_t count>
[[gnu::flatten]] void SampleLanes(const DirectAir& air, const DirectRules& rules,
                                  const DirectRay& ray, RaySamples<float>& samples) {
  for (std::size_t i = 0; i < ray.groups; ++i) {
    Lanes<count> lanes;
    FillGroup<count>(air, rules, ray, i, lanes);
    const DirectGroup& group = ray.group[i];
    StoreGroup<count>({ray.panel[group.first], ray.panel[group.second]}, lanes, samples);
  }
}

void Sample(const DirectAir& air, const DirectRules& rules, const DirectRay& ray,
            RaySamples<float>& samples) {
  samples.count = 0;
  if (ray.narrow) {
    SampleLanes<kHalf>(air, rules, ray, samples);
  } else {
    SampleLanes<kDirectLanes>(air, rules, ray, samples);
  }
  Pad(samples);
}

constexpr DirectKernel kDirectKernel{Scatter, Sample};

}  // namespace

template <>
const DirectKernel& KernelOf<DirectKernel, kThisSet>() {
  return kDirectKernel;
}

}  // namespace alpenglow
