// SPDX-License-Identifier: MIT
#include "atmosphere/ray/direct_kernel.h"

#include "atmosphere/ray/direct_nodes.h"

namespace alpenglow::atmosphere {
namespace {

/// A group of `count` lanes, stored in SIMD vectors.
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

/// Terms that convert columns upwards to space into columns from the observer: base + sign column.
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

// @param sunlight  at the lanes of the group; null: unshadowed except by the planet.
template <typename T>
T SunlightOn(const PanelLanes<T>& panel, const float* sunlight) {
  return sunlight == nullptr ? panel(&DirectPanel::lit) : LoadLanes<T>(sunlight + panel.first);
}

/// Sums over the nodes of a ray, lane by lane, for each block of four bands: molecules and aerosol.
template <typename T>
using LightLanes = std::array<std::array<std::array<T, kFour>, 2>, kMaxBands / kFour>;

/// The factors whose products are summed to the light of a group.
template <std::size_t count>
struct LitLanes {
  using T = LaneVector<count>;
  static constexpr std::size_t kVectors = Lanes<count>::kVectors;
  ColumnSet<T> columns[kVectors];  // from the sun to the observer
  T weight[kVectors][2];

  LitLanes(const TwoPanels& panels, const float* sunlight, const Lanes<count>& lanes) {
    for (std::size_t i = 0; i < kVectors; ++i) {
      const NodeAir<T>& node = lanes.air[i];
      columns[i] = {node.view.rayleigh + node.sun.rayleigh, node.view.mie + node.sun.mie,
                    node.view.ozone + node.sun.ozone};
      const T lit =
          lanes.place[i].weight * SunlightOn<T>(PanelLanes<T>{panels, i * kLanesOf<T>}, sunlight);
      weight[i][0] = lit * node.rayleigh_density;
      weight[i][1] = lit * node.mie_density;
    }
  }
  template <typename Block>
  void AddBand(const Extinction<T>& extinction, std::size_t band, Block& block) const {
    for (std::size_t i = 0; i < kVectors; ++i) {
      const T arriving = PowerOfTwo<T>(-OpticalDepthOf(extinction, columns[i]));
      for (std::size_t row = 0; row < 2; ++row) block[row][band] += arriving * weight[i][row];
    }
  }
};

template <std::size_t count, typename T>
void AddLight(const DirectAir& air, const LitLanes<count>& lit, bool first, LightLanes<T>& light) {
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

template <typename T>
void StoreLight(const DirectAir& air, const LightLanes<T>& light, ScatteredOnce<float>& scattered) {
  for (std::size_t band = 0; band < air.bands; band += kFour) {
    const auto& block = light[band / kFour];
    StoreSums(block[0].data(), &air.rayleigh_scattering[band], &scattered.rayleigh[band]);
    StoreSums(block[1].data(), &air.mie_scattering[band], &scattered.mie[band]);
  }
}

const DirectRule& RuleOf(const DirectWork& work, std::size_t i) {
  const std::size_t nodes = work.ray.NodesOf(work.ray.group[i]);
  return nodes == kManyNodes ? work.rules.fourteen : work.rules.few[nodes];
}

const float* SunlightOf(const DirectWork& work, std::size_t i) {
  return work.sunlight == nullptr ? nullptr : &work.sunlight->factor[i * kDirectLanes];
}

TwoPanels PanelsOf(const DirectRay& ray, std::size_t i) {
  return {ray.panel[ray.group[i].first], ray.panel[ray.group[i].second]};
}

template <std::size_t count>
[[gnu::flatten]] void ScatterLanes(const DirectWork& work, ScatteredOnce<float>& scattered) {
  LightLanes<LaneVector<count>> light;
  for (std::size_t i = 0; i < work.ray.groups; ++i) {
    Lanes<count> lanes;
    FillLanes<count>(work.air, RuleOf(work, i), PanelsOf(work.ray, i), work.ray.falls, lanes);
    const LitLanes<count> lit(PanelsOf(work.ray, i), SunlightOf(work, i), lanes);
    AddLight<count>(work.air, lit, i == 0, light);
  }
  StoreLight<LaneVector<count>>(work.air, light, scattered);
}

void SetDark(const DirectAir& air, ScatteredOnce<float>& scattered) {
  for (std::size_t band = 0; band < air.bands; ++band)
    scattered.rayleigh[band] = scattered.mie[band] = 0.0F;
}

void Scatter(const DirectWork& work, ScatteredOnce<float>& scattered) {
  if (work.ray.groups == 0) {
    SetDark(work.air, scattered);
  } else if (work.ray.narrow) {
    ScatterLanes<kHalf>(work, scattered);
  } else {
    ScatterLanes<kDirectLanes>(work, scattered);
  }
}

template <std::size_t count>
void StoreGroup(const TwoPanels& panels, const float* sunlight, const Lanes<count>& lanes,
                RaySamples<float>& samples) {
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
    put(samples.lit, SunlightOn<T>(panel, sunlight));
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

// Adds weightless samples up to a multiple of the SIMD lanes.
[[gnu::flatten]] void Pad(RaySamples<float>& samples) {
  using T = LaneVector<kHalf>;
  constexpr std::size_t kLanes = BatchOf<float>::kLanes;
  samples.padded = (samples.count + kLanes - 1) / kLanes * kLanes;
  if (samples.padded == samples.count) return;
  for (auto* row : {&samples.distance, &samples.weight, &samples.lit, &samples.altitude,
                    &samples.mu, &samples.mu_s, &samples.rayleigh_density, &samples.mie_density,
                    &samples.view_rayleigh, &samples.view_mie, &samples.view_ozone,
                    &samples.sun_rayleigh, &samples.sun_mie, &samples.sun_ozone}) {
    for (std::size_t i = samples.count; i < samples.padded; i += kLanesOf<T>)
      StoreLanes(&(*row)[i], T(0.0F));
  }
}

template <std::size_t count>
[[gnu::flatten]] void SampleLanes(const DirectWork& work, RaySamples<float>& samples,
                                  ScatteredOnce<float>* scattered) {
  LightLanes<LaneVector<count>> light;
  for (std::size_t i = 0; i < work.ray.groups; ++i) {
    const DirectRule& rule = RuleOf(work, i);
    const TwoPanels panels = PanelsOf(work.ray, i);
    const float* sunlight = SunlightOf(work, i);
    Lanes<count> lanes;
    FillLanes<count>(work.air, rule, panels, work.ray.falls, lanes);
    StoreGroup<count>(panels, sunlight, lanes, samples);
    if (scattered != nullptr)
      AddLight<count>(work.air, LitLanes<count>(panels, sunlight, lanes), i == 0, light);
  }
  if (scattered != nullptr) StoreLight<LaneVector<count>>(work.air, light, *scattered);
}

void Sample(const DirectWork& work, RaySamples<float>& samples, ScatteredOnce<float>* scattered) {
  samples.count = 0;
  if (work.ray.groups == 0) {
    if (scattered != nullptr) SetDark(work.air, *scattered);
  } else if (work.ray.narrow) {
    SampleLanes<kHalf>(work, samples, scattered);
  } else {
    SampleLanes<kDirectLanes>(work, samples, scattered);
  }
  Pad(samples);
}

// Returns columns along a panel by 8 Gauss nodes of equal measure: within 1e-7 while the density
// changes by less than e^6.
[[gnu::flatten]] ColumnSet<float> AlongPanel(const DirectAir& air, const DirectRule& eight,
                                             const DirectPanel& panel) {
  using namespace shared;
  using T = LaneVector<kHalf>;
  T sum[kFour] = {T(0.0F), T(0.0F), T(0.0F), T(0.0F)};
  for (std::size_t i = 0; i < kHalf; i += kLanesOf<T>) {
    const T position = LoadLanes<T>(eight.node.data() + i) * T(panel.length);
    const T altitude =
        max(AltitudeOnPanel<T>(air, PanelLanes<T>{{panel, panel}, i}, position), T(0.0F));
    const T weight = LoadLanes<T>(eight.weight.data() + i);
    const NodeDensities<T> here = DensitiesAt<T>(air, altitude);
    sum[0] += weight * here.rayleigh;
    sum[1] += weight * here.mie;
    sum[2] += weight * here.ozone;
  }
  const float factor[kFour] = {panel.length, panel.length, panel.length, 0.0F};
  float column[kFour];
  StoreSums(sum, factor, column);
  return {column[0], column[1], column[2]};
}

ColumnSet<float> Along(const DirectAir& air, const DirectRules& rules, const DirectRay& ray) {
  ColumnSet<float> sum{0.0F, 0.0F, 0.0F};
  for (std::size_t i = 0; i < ray.panels; ++i) {
    const ColumnSet<float> column = AlongPanel(air, rules.eight, ray.panel[i]);
    sum = {sum.rayleigh + column.rayleigh, sum.mie + column.mie, sum.ozone + column.ozone};
  }
  return sum;
}

constexpr DirectKernel kDirectKernel{Scatter, Sample, Along};

}  // namespace

const DirectKernel& KernelOf(KernelName<DirectKernel, kThisSet> /*name*/) { return kDirectKernel; }

}  // namespace alpenglow::atmosphere
