// SPDX-License-Identifier: MIT
#include "renderer/media/lit_volume.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <iterator>
#include <limits>
#include <utility>

#include "lut/multiple_scattering/spherical_harmonics.h"
#include "renderer/media/body_glow.h"

namespace alpenglow::renderer {
namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();

/// Directions of Lebedev's rule of degree 7 (1976), and their weights, which sum to 1.
struct LebedevRule {
  std::array<glm::dvec3, 26> direction{};
  std::array<double, 26> weight{};
};
const LebedevRule& Lebedev() {
  static const LebedevRule kRule = [] {
    LebedevRule rule;
    std::size_t count = 0;
    for (int i = 0; i < 27; ++i) {
      const glm::dvec3 corner(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
      const double sides = glm::dot(corner, corner);
      if (sides == 0.0) continue;
      rule.direction[count] = glm::normalize(corner);
      rule.weight[count++] = sides == 1.0 ? 1.0 / 21.0 : sides == 2.0 ? 4.0 / 105.0 : 9.0 / 280.0;
    }
    return rule;
  }();
  return kRule;
}

/// Tabulates the values of each band at the centres of cells of the unit cube.
template <typename Values>
std::vector<VolumeGrid> Tabulated(const std::array<int, 3>& size, std::size_t bands,
                                  const Values& values_at) {
  const int rows = size[1] * size[2];
  const auto columns = static_cast<std::size_t>(size[0]);
  std::vector<std::vector<float>> values(
      bands, std::vector<float>(columns * static_cast<std::size_t>(rows)));
  tbb::parallel_for(0, rows, [&](int row) {
    for (std::size_t x = 0; x < columns; ++x) {
      const glm::dvec3 unit((static_cast<double>(x) + 0.5) / size[0],
                            (row % size[1] + 0.5) / size[1], (row / size[1] + 0.5) / size[2]);
      const SpectrumOf<double> here = values_at(unit);
      for (std::size_t band = 0; band < bands; ++band)
        values[band][static_cast<std::size_t>(row) * columns + x] = static_cast<float>(here[band]);
    }
  });
  std::vector<VolumeGrid> grids;
  for (std::vector<float>& of_band : values) grids.emplace_back(size, std::move(of_band));
  return grids;
}

void AddDepth(const LocalMedium& medium, double column, SpectrumOf<double>& depth) {
  if (column == 0.0) return;
  for (std::size_t band = 0; band < depth.size(); ++band) {
    depth[band] += column * medium.optics().extinction_per_m[band];
  }
}

Spectrum InFloats(const SpectrumOf<double>& values) {
  Spectrum light(values.size());
  for (std::size_t band = 0; band < values.size(); ++band)
    light[band] = static_cast<float>(values[band]);
  return light;
}

}  // namespace

LitVolume::LitVolume(const LocalBody& volume, const MediaSources& sources)
    : volume_(volume),
      sources_(sources),
      mean_colour_(MeanColour()),
      chi_(LegendreCoefficients(volume.optics().phase,
                                sources.air.multiple_scattering().options().degree)),
      sky_(Sky()),
      past_(sources.PastClouds(sources.geometry.AltitudeOf(volume.Middle()))),
      sun_column_(SunColumns()),
      lamps_(AllLamps()),
      orders_(Orders()),
      sky_left_(orders_ ? std::vector<VolumeGrid>{} : SkyLeft(sky_)),
      extinction_per_m_(orders_ ? orders_->extinction_per_m() : volume.optics().extinction_per_m),
      glow_(GlowAround()) {}

LitVolume::Colour LitVolume::MeanColour() const {
  Colour colour{InFloats(volume_.optics().scattering_per_m), Spectrum(sources_.bands()),
                Spectrum(sources_.bands(), 1.0F)};
  if (sources_.emission == MediaEmission::kOn)
    colour.emission_per_m = InFloats(volume_.optics().emission_per_m);
  return colour;
}

std::optional<LitVolume::Colour> LitVolume::ColourAt(const glm::dvec3& point) const {
  const std::optional<BodyColour> here = volume_.ColourAt(point);
  if (!here) return std::nullopt;
  Colour colour{InFloats(here->scattering_per_m), Spectrum(sources_.bands()),
                Spectrum(sources_.bands())};
  if (sources_.emission == MediaEmission::kOn)
    colour.emission_per_m = InFloats(here->emission_per_m);
  for (std::size_t band = 0; band < sources_.bands(); ++band) {
    const float mean = mean_colour_.scattering_per_m[band];
    if (mean > 0.0F) colour.relative[band] = colour.scattering_per_m[band] / mean;
  }
  return colour;
}

std::unique_ptr<const GlowField> LitVolume::GlowAround() const {
  if (mean_colour_.emission_per_m == Spectrum(sources_.bands())) return nullptr;
  return std::make_unique<const GlowField>(volume_, [this](const glm::dvec3& travel) {
    std::shared_ptr<const VolumeOrders::Look> look;
    if (orders_) look = std::make_shared<const VolumeOrders::Look>(orders_->LookTowards(-travel));
    return [this, look](const glm::dvec3& point) {
      const std::optional<Colour> here = ColourAt(point);
      const Colour& colour = here ? *here : mean_colour_;
      GlowField::Source source{colour.emission_per_m, extinction_per_m_};
      if (look) {
        const Spectrum scattered = orders_->OwnAt(point, *look);
        for (std::size_t band = 0; band < scattered.size(); ++band)
          source.light_per_m[band] +=
              static_cast<float>(extinction_per_m_[band]) * colour.relative[band] * scattered[band];
      } else {
        for (std::size_t band = 0; band < source.light_per_m.size(); ++band)
          source.extinction_per_m[band] -= static_cast<double>(colour.scattering_per_m[band]);
      }
      return source;
    };
  });
}

std::unique_ptr<const VolumeOrders> LitVolume::Orders() const {
  if (volume_.orders() == ScatteringOrders::kSingle) return nullptr;
  VolumeIllumination light{.to_sun = sources_.light.direction.seen,
                           .sky = nullptr,
                           .lamps = nullptr,
                           .emits = sources_.emission == MediaEmission::kOn};
  const Spectrum none(sources_.bands());
  const auto is_sunlit = [&](const glm::dvec3& unit) {
    return sources_.SunInAir(volume_.FrameFromUnit(unit)) != none;
  };
  light.has_sun = is_sunlit(glm::dvec3(0.5)) || is_sunlit({0.5, 0.5, 1.0});
  light.sky = [&](const glm::dvec3& from) { return SkyPastBodies(from); };
  if (!lamps_.empty()) {
    light.lamps = [&](const glm::dvec3& point, std::size_t band, double least_m) {
      return LampBeams(point, band, least_m);
    };
  }
  return std::make_unique<const VolumeOrders>(volume_, light);
}

Spectrum LitVolume::SkyPastBodies(const glm::dvec3& from) const {
  const std::vector<double> all(
      static_cast<std::size_t>(sources_.air.multiple_scattering().options().degree) + 1, 1.0);
  SpectrumOf<double> depth(sources_.bands());
  for (const auto& medium : sources_.media.all()) {
    if (medium->IsLayer() || medium.get() == &volume_) continue;
    AddDepth(*medium, medium->Column(volume_.Middle(), from, kEndless), depth);
  }
  Spectrum sky = sky_.Towards(from, all)[1];
  const bool is_above = glm::dot(from, sources_.geometry.UpAt(volume_.Middle())) >= 0.0;
  sky = is_above ? past_.sky.left * sky + static_cast<float>(1.0 / kPi) * past_.sky.added
                 : past_.ground * sky;
  for (std::size_t band = 0; band < sky.size(); ++band)
    sky[band] *= static_cast<float>(std::exp(-depth[band]));
  return sky;
}

std::optional<SpectrumOf<double>> LitVolume::WideExtinction_per_m() const {
  return extinction_per_m_;
}

SkyMoments LitVolume::Sky() const {
  const SceneGeometry& geometry = sources_.geometry;
  const double low = geometry.AltitudeOf(volume_.FrameFromUnit({0.5, 0.5, 0.0}));
  const double high = geometry.AltitudeOf(volume_.FrameFromUnit({0.5, 0.5, 1.0}));
  return {sources_.air.multiple_scattering(),
          geometry.UpAt(volume_.Middle()),
          sources_.light.direction.for_air,
          {low, 0.5 * (low + high), high}};
}

std::optional<VolumeGrid> LitVolume::SunColumns() const {
  constexpr int kMost = 64;
  const auto samples = volume_.Samples();
  if (!samples) return std::nullopt;
  std::array<int, 3> size = *samples;
  for (int& side : size) side = std::min(side, kMost);
  const auto column = [&](const glm::dvec3& unit) {
    SpectrumOf<double> of_all(1);
    of_all[0] =
        volume_.Column(volume_.FrameFromUnit(unit), sources_.light.direction.seen, kEndless);
    return of_all;
  };
  return std::move(Tabulated(size, 1, column).front());
}

std::vector<LitVolume::VolumeLamp> LitVolume::Lamps() const {
  constexpr std::size_t kMost = 8;
  constexpr double kDimmest = 1e-4;  // relative to the brightest
  if (sources_.lamps == nullptr) return {};
  const LampLight& lamps = *sources_.lamps;
  std::vector<std::pair<double, std::uint32_t>> bright;
  for (const std::uint32_t number : lamps.All()) {
    const LampLight::SceneLamp lamp = lamps.At(number);
    const double distance = std::max(NearestTo(lamp.lamp), 1.0);
    bright.emplace_back(-lamp.candela / (distance * distance), number);
  }
  std::sort(bright.begin(), bright.end());
  std::vector<VolumeLamp> chosen;
  for (const auto& [minus_lux, number] : bright) {
    if (chosen.size() == kMost || minus_lux > kDimmest * bright.front().first) break;
    const LampLight::SceneLamp scene_lamp = lamps.At(number);
    const glm::dvec3 lamp = scene_lamp.lamp.position_m;
    chosen.push_back(
        LampOf(scene_lamp.lamp, scene_lamp.intensity, [&, at = number](const glm::dvec3& point) {
          SpectrumOf<double> depth = lamps.DepthTo(at, point);
          for (const auto& medium : sources_.media.all()) {
            if (!medium->IsLayer()) AddOther(*medium, point, lamp, depth);
          }
          return depth;
        }));
  }
  return chosen;
}

std::vector<LitVolume::VolumeLamp> LitVolume::AllLamps() const {
  std::vector<VolumeLamp> lamps = Lamps();
  std::ranges::move(Glows(), std::back_inserter(lamps));
  return lamps;
}

std::vector<LitVolume::VolumeLamp> LitVolume::Glows() const {
  constexpr double kDimmest = 1e-3;
  if (sources_.emission == MediaEmission::kOff) return {};
  const Spectrum sun = sources_.light.irradiance * sources_.SunInAir(volume_.Middle());
  std::vector<VolumeLamp> glows;
  for (const auto& glowing : sources_.media.all()) {
    const auto* body = dynamic_cast<const LocalBody*>(glowing.get());
    if (body == nullptr || body == &volume_) continue;
    const BodyGlow glow = GlowOf(*body);
    const auto distance = static_cast<float>(std::max(NearestTo(glow.lamp), glow.lamp.radius_m));
    bool is_bright = false;
    for (std::size_t band = 0; band < sun.size(); ++band) {
      const float dimmest = static_cast<float>(kDimmest) * sun[band] * distance * distance;
      is_bright = is_bright || glow.intensity[band] > dimmest;
    }
    if (!is_bright) continue;
    glows.push_back(LampOf(glow.lamp, glow.intensity, [&](const glm::dvec3& point) {
      SpectrumOf<double> depth(sources_.bands());
      for (const auto& medium : sources_.media.all()) {
        if (!medium->IsLayer() && medium != glowing)
          AddOther(*medium, point, glow.lamp.position_m, depth);
      }
      return depth;
    }));
  }
  return glows;
}

void LitVolume::AddOther(const LocalMedium& medium, const glm::dvec3& point, const glm::dvec3& lamp,
                         SpectrumOf<double>& depth) const {
  if (&medium == &volume_) return;
  const double distance = std::max(glm::length(lamp - point), 1e-9);
  AddDepth(medium, medium.Column(point, (lamp - point) / distance, distance), depth);
}

double LitVolume::NearestTo(const Lamp& lamp) const {
  const glm::dvec3 nearest = volume_.FrameFromUnit(
      glm::clamp(volume_.UnitFromFrame(lamp.position_m), glm::dvec3(0.0), glm::dvec3(1.0)));
  return glm::length(nearest - lamp.position_m);
}

LitVolume::VolumeLamp LitVolume::LampOf(const Lamp& lamp, const Spectrum& intensity,
                                        const LampDepth& depth) const {
  constexpr int kMost = 24, kPlain = 8;
  constexpr double kDark = 60.0;
  std::array<int, 3> size = volume_.Samples().value_or(std::array{kPlain, kPlain, kPlain});
  for (int& side : size) side = std::min(side, kMost);
  const auto depth_at = [&](const glm::dvec3& unit) {
    SpectrumOf<double> along = depth(volume_.FrameFromUnit(unit));
    for (std::size_t band = 0; band < along.size(); ++band)
      along[band] = std::min(along[band], kDark);
    return along;
  };
  const auto column_at = [&](const glm::dvec3& unit) {
    const glm::dvec3 way = lamp.position_m - volume_.FrameFromUnit(unit);
    const double distance = std::max(glm::length(way), 1e-9);
    SpectrumOf<double> column(1);
    column[0] = volume_.Column(volume_.FrameFromUnit(unit), way / distance, distance);
    return column;
  };
  VolumeLamp seen{lamp, intensity, Tabulated(size, sources_.bands(), depth_at), std::nullopt};
  if (volume_.Samples()) seen.own_column = std::move(Tabulated(size, 1, column_at).front());
  return seen;
}

double LitVolume::ColumnToLamp(const VolumeLamp& seen, const glm::dvec3& point) const {
  if (seen.own_column) return seen.own_column->At(volume_.UnitFromFrame(point));
  const glm::dvec3 way = seen.lamp.position_m - point;
  const double distance = std::max(glm::length(way), 1e-9);
  return volume_.Column(point, way / distance, distance);
}

std::vector<LampBeam> LitVolume::LampBeams(const glm::dvec3& point, std::size_t band,
                                           double least_m) const {
  std::vector<LampBeam> beams;
  for (const VolumeLamp& seen : lamps_) {
    const glm::dvec3 way = seen.lamp.position_m - point;
    const double length = std::max(glm::length(way), 1e-9);
    const double distance = std::max({length, seen.lamp.radius_m, least_m});
    const glm::dvec3 travel = way / -length;
    const double left = std::exp(-seen.depth[band].At(volume_.UnitFromFrame(point)));
    const double per_area = RelativeIntensity(seen.lamp, travel) / (distance * distance);
    beams.push_back({travel, per_area * left * static_cast<double>(seen.intensity[band]),
                     ColumnToLamp(seen, point), length});
  }
  return beams;
}

// Returns the mean transmittance of the bodies over directions, weighted by the sky's radiance.
std::vector<VolumeGrid> LitVolume::SkyLeft(const SkyMoments& sky) const {
  constexpr std::array<int, 3> kSize{8, 8, 8};
  const LebedevRule& rule = Lebedev();
  const std::vector<double> all(
      static_cast<std::size_t>(sources_.air.multiple_scattering().options().degree) + 1, 1.0);
  std::array<Spectrum, 26> weight;
  Spectrum sum(sources_.bands());
  for (std::size_t i = 0; i < weight.size(); ++i) {
    weight[i] = static_cast<float>(rule.weight[i]) * sky.Towards(rule.direction[i], all)[1];
    sum = sum + weight[i];
  }
  const bool is_dark = sum == Spectrum(sources_.bands());
  return Tabulated(kSize, sources_.bands(), [&](const glm::dvec3& unit) {
    SpectrumOf<double> mean(sources_.bands());
    if (is_dark) return mean;
    const glm::dvec3 point = volume_.FrameFromUnit(unit);
    for (std::size_t i = 0; i < weight.size(); ++i) {
      SpectrumOf<double> depth(sources_.bands());
      for (const auto& medium : sources_.media.all()) {
        if (medium->IsLayer()) continue;
        AddDepth(*medium, medium->Column(point, rule.direction[i], kEndless), depth);
      }
      for (std::size_t band = 0; band < mean.size(); ++band)
        mean[band] += static_cast<double>(weight[i][band]) * std::exp(-depth[band]);
    }
    for (std::size_t band = 0; band < mean.size(); ++band)
      mean[band] = sum[band] > 0.0F ? mean[band] / static_cast<double>(sum[band]) : 0.0;
    return mean;
  });
}

double LitVolume::ColumnToLight(const glm::dvec3& point, const glm::dvec3& to_disk) const {
  if (sun_column_ && to_disk == sources_.light.direction.seen) {
    const glm::dvec3 off = volume_.UnitFromFrame(point) - 0.5;
    if (std::max({std::abs(off.x), std::abs(off.y), std::abs(off.z)}) <= 0.5)
      return sun_column_->At(off + 0.5);
  }
  return volume_.Column(point, to_disk, kEndless);
}

void LitVolume::AddDepthToLight(const glm::dvec3& point, const glm::dvec3& to_disk,
                                SpectrumOf<double>& depth) const {
  const double column_m = ColumnToLight(point, to_disk);
  for (std::size_t band = 0; band < depth.size(); ++band)
    depth[band] += column_m * extinction_per_m_[band];
}

void LitVolume::AddCuts(const glm::dvec3& origin, const glm::dvec3& direction,
                        std::vector<double>& cuts_m) const {
  for (const VolumeLamp& seen : lamps_) {
    const Lamp& lamp = seen.lamp;
    const double nearest = glm::dot(lamp.position_m - origin, direction);
    const double across =
        std::max(glm::length(lamp.position_m - origin - nearest * direction), lamp.radius_m);
    for (const double step : {-4.0, -1.0, 0.0, 1.0, 4.0}) cuts_m.push_back(nearest + step * across);
  }
}

void LitVolume::AddLamp(const VolumeLamp& seen, const Colour& colour, const glm::dvec3& direction,
                        const LightOnPoint& light, double density, Spectrum& sum) const {
  const glm::dvec3 way = seen.lamp.position_m - light.point;
  const double distance = std::max({glm::length(way), seen.lamp.radius_m, 1e-3});
  const glm::dvec3 towards = way / distance;
  const double per_area = density * RelativeIntensity(seen.lamp, -towards) / (distance * distance);
  if (per_area == 0.0) return;
  const glm::dvec3 unit = volume_.UnitFromFrame(light.point);
  const double own_m = ColumnToLamp(seen, light.point);
  const double cos_scattering = glm::dot(direction, towards);
  const double phase = orders_ ? 0.0 : Phase(volume_.optics().phase, cos_scattering);
  for (std::size_t band = 0; band < sum.size(); ++band) {
    const double depth = own_m * extinction_per_m_[band] + seen.depth[band].At(unit);
    const double scattered =
        orders_ ? static_cast<double>(colour.relative[band]) * extinction_per_m_[band] *
                      orders_->FirstOfLamp(cos_scattering, band, own_m + light.column_to_eye_m)
                : static_cast<double>(colour.scattering_per_m[band]) * phase;
    sum[band] += seen.intensity[band] * static_cast<float>(per_area * scattered * std::exp(-depth));
  }
}

class LitVolume::OnOneRay final : public MediumOnRay {
 public:
  OnOneRay(const LitVolume& lit, const glm::dvec3& origin, const glm::dvec3& direction)
      : lit_(lit),
        direction_(direction),
        phase_(static_cast<float>(Phase(lit.volume_.optics().phase,
                                        glm::dot(direction, lit.sources_.light.direction.seen)))),
        sky_(lit.sky_.Towards(direction, lit.chi_)) {
    if (lit.orders_) look_ = lit.orders_->LookAlong(origin, direction);
  }

  void AddSource(const LightOnPoint& light, double density, Spectrum& sum) const override {
    const std::optional<Colour> here = lit_.ColourAt(light.point);
    const Colour& colour = here ? *here : lit_.mean_colour_;
    look_ ? AddAllOrders(colour, light, density, sum) : AddFirstOrder(colour, light, density, sum);
    for (std::size_t band = 0; band < sum.size(); ++band)
      sum[band] += static_cast<float>(density) * colour.emission_per_m[band];
    for (const VolumeLamp& lamp : lit_.lamps_)
      lit_.AddLamp(lamp, colour, direction_, light, density, sum);
  }

 private:
  void AddFirstOrder(const Colour& colour, const LightOnPoint& light, double density,
                     Spectrum& sum) const {
    SpectrumOf<double> depth = light.depth;
    lit_.AddDepthToLight(light.point, lit_.sources_.light.direction.seen, depth);
    const Spectrum sun = light.LitThrough(depth) * light.in_air;
    // The phase function counts as even for the light of clouds, which fills half of all directions.
    const Spectrum sky = lit_.past_.sky.left * lit_.sky_.At(sky_, light.altitude_m) +
                         static_cast<float>(0.5 / kPi) * lit_.past_.sky.added;
    const glm::dvec3 unit = lit_.volume_.UnitFromFrame(light.point);
    const Spectrum& irradiance = lit_.sources_.light.irradiance;
    for (std::size_t band = 0; band < sum.size(); ++band) {
      const float arriving =
          phase_ * sun[band] +
          light.sky_left * sky[band] * static_cast<float>(lit_.sky_left_[band].At(unit));
      sum[band] +=
          static_cast<float>(density) * colour.scattering_per_m[band] * irradiance[band] * arriving;
    }
  }

  void AddAllOrders(const Colour& colour, const LightOnPoint& light, double density,
                    Spectrum& sum) const {
    const VolumeOrders& orders = *lit_.orders_;
    const double column_m = lit_.ColumnToLight(light.point, lit_.sources_.light.direction.seen);
    const Spectrum sun = light.LitThrough(light.depth) * light.in_air;
    const VolumeOrders::Scattered scattered =
        orders.At({light.point, column_m, light.column_to_eye_m}, *look_);
    const Spectrum& irradiance = lit_.sources_.light.irradiance;
    for (std::size_t band = 0; band < sum.size(); ++band) {
      sum[band] += static_cast<float>(density * orders.extinction_per_m()[band]) *
                   colour.relative[band] *
                   (irradiance[band] *
                        (sun[band] * scattered.sun[band] + light.sky_left * scattered.sky[band]) +
                    scattered.own[band]);
    }
  }

  const LitVolume& lit_;
  glm::dvec3 direction_;
  float phase_;
  std::vector<Spectrum> sky_;
  std::optional<VolumeOrders::Look> look_;  // nothing: the first order alone
};

std::unique_ptr<const MediumOnRay> LitVolume::OnRay(const glm::dvec3& origin,
                                                    const glm::dvec3& direction) const {
  return std::make_unique<OnOneRay>(*this, origin, direction);
}

}  // namespace alpenglow::renderer
