// SPDX-License-Identifier: MIT
#include "renderer/media/media_light.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>

#include "lut/multiple_scattering/spherical_harmonics.h"
#include "renderer/media/fog_light.h"

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
      const Bands<double> here = values_at(unit);
      for (std::size_t band = 0; band < bands; ++band)
        values[band][static_cast<std::size_t>(row) * columns + x] = static_cast<float>(here[band]);
    }
  });
  std::vector<VolumeGrid> grids;
  for (std::vector<float>& of_band : values) grids.emplace_back(size, std::move(of_band));
  return grids;
}

/// A lamp that lights a volume.
struct VolumeLamp {
  std::uint32_t number;
  std::vector<VolumeGrid> depth;  // [band] of the path; excludes the volume itself without grid
};

/// A volume with its light for one position of the sun.
struct LitVolume {
  std::vector<double> chi;
  SkyMoments sky;
  std::optional<VolumeGrid> sun_column;  // [m], of gridded volumes
  std::vector<VolumeGrid> sky_left;      // [band]
  std::vector<VolumeLamp> lamps;
};

void AddDepth(const MediumOptics& optics, double column, Bands<double>& depth) {
  if (column == 0.0) return;
  for (std::size_t band = 0; band < depth.count; ++band) {
    depth[band] += column * optics.extinction_per_m[band];
  }
}

}  // namespace

struct MediaLight::State {
  LocalMedia media;
  const SceneGeometry& geometry;
  SolvedAir air;
  const LampLight* lamps;
  DistantLight sun;  // or the moon
  std::vector<LitVolume> volumes;
  std::optional<FogLight> fog;

  State(LocalMedia of, const SceneGeometry& over, const SolvedAir& in, const Lighting& light,
        const LampLight* with);

  [[nodiscard]] std::size_t bands() const { return media.bands(); }
  [[nodiscard]] const FogLayer& fog_layer() const { return *media.fog()->fog(); }
  /// Returns the transmittance of the air for sunlight at a point.
  [[nodiscard]] BandLight SunInAir(const glm::dvec3& point) const;
  /// Returns the optical depth of all volumes between a point and the sun.
  [[nodiscard]] Bands<double> VolumesToSun(const glm::dvec3& point) const;
  /// Returns the optical depth of the fog between a point and the sun.
  [[nodiscard]] double FogToSun(const glm::dvec3& point) const {
    return media.fog()->optics.extinction_per_m[0] *
           fog_layer().ColumnToSpace(point, sun.direction.seen);
  }

  [[nodiscard]] LitVolume Light(const LocalMedium& medium) const;
  [[nodiscard]] std::vector<VolumeLamp> LampsOf(const LocalVolume& volume) const;
  [[nodiscard]] VolumeLamp LampOf(const LocalVolume& volume, std::uint32_t number) const;
  [[nodiscard]] VolumeGrid SunColumns(const LocalVolume& volume) const;
  [[nodiscard]] std::vector<VolumeGrid> SkyLeft(const LocalVolume& volume,
                                                const SkyMoments& sky) const;
};

MediaLight::State::State(LocalMedia of, const SceneGeometry& over, const SolvedAir& in,
                         const Lighting& light, const LampLight* with)
    : media(std::move(of)), geometry(over), air(in), lamps(with), sun(light.source) {
  for (const LocalMedium& medium : media.all()) {
    if (medium.volume() != nullptr) volumes.push_back(Light(medium));
  }
  if (media.fog() == nullptr) return;
  const double scale = fog_layer().scale_height_m();
  const double bottom = media.fog_bottom_m();
  const glm::dvec3 head(0.0, 0.0, bottom + (std::isinf(scale) ? 0.0 : scale));
  fog.emplace(*media.fog(), air.multiple_scattering(), sun.direction, SunInAir(head), bottom);
}

BandLight MediaLight::State::SunInAir(const glm::dvec3& point) const {
  const LocalLight here = LocalLightAt(geometry, point, sun);
  if (here.visible_fraction <= 0.0) return BandLight(bands());
  return static_cast<float>(here.visible_fraction) *
         air.BeamLeft(here.altitude_m, here.mu_s_effective);
}

LitVolume MediaLight::State::Light(const LocalMedium& medium) const {
  const LocalVolume& volume = *medium.volume();
  const double low = geometry.AltitudeOf(volume.FrameFromUnit({0.5, 0.5, 0.0}));
  const double high = geometry.AltitudeOf(volume.FrameFromUnit({0.5, 0.5, 1.0}));
  const SkyMoments sky(air.multiple_scattering(), geometry.UpAt(volume.Middle()),
                       sun.direction.for_air, {low, 0.5 * (low + high), high});
  LitVolume lit{
      LegendreCoefficients(medium.optics.phase, air.multiple_scattering().options().degree), sky,
      std::nullopt, SkyLeft(volume, sky), LampsOf(volume)};
  if (volume.grid() != nullptr) lit.sun_column.emplace(SunColumns(volume));
  return lit;
}

VolumeGrid MediaLight::State::SunColumns(const LocalVolume& volume) const {
  constexpr int kMost = 64;
  std::array<int, 3> size = volume.grid()->size();
  for (int& side : size) side = std::min(side, kMost);
  const auto column = [&](const glm::dvec3& unit) {
    Bands<double> of_all(1);
    of_all[0] = volume.Column(volume.FrameFromUnit(unit), sun.direction.seen, kEndless);
    return of_all;
  };
  return std::move(Tabulated(size, 1, column).front());
}

std::vector<VolumeLamp> MediaLight::State::LampsOf(const LocalVolume& volume) const {
  constexpr std::size_t kMost = 8;
  constexpr double kDimmest = 1e-4;  // relative to the brightest
  if (lamps == nullptr) return {};
  std::vector<std::pair<double, std::uint32_t>> bright;
  for (const std::uint32_t number : lamps->All()) {
    const LampLight::SceneLamp lamp = lamps->At(number);
    const glm::dvec3 nearest = volume.FrameFromUnit(
        glm::clamp(volume.UnitFromFrame(lamp.lamp.position_m), glm::dvec3(0.0), glm::dvec3(1.0)));
    const double distance = std::max(glm::length(nearest - lamp.lamp.position_m), 1.0);
    bright.emplace_back(-lamp.candela / (distance * distance), number);
  }
  std::sort(bright.begin(), bright.end());
  std::vector<VolumeLamp> chosen;
  for (const auto& [minus_lux, number] : bright) {
    if (chosen.size() == kMost || minus_lux > kDimmest * bright.front().first) break;
    chosen.push_back(LampOf(volume, number));
  }
  return chosen;
}

VolumeLamp MediaLight::State::LampOf(const LocalVolume& volume, std::uint32_t number) const {
  constexpr int kMost = 24, kPlain = 8;
  constexpr double kDark = 60.0;
  std::array<int, 3> size{kPlain, kPlain, kPlain};
  if (volume.grid() != nullptr) size = volume.grid()->size();
  for (int& side : size) side = std::min(side, kMost);
  const glm::dvec3 lamp = lamps->At(number).lamp.position_m;
  const auto depth_at = [&](const glm::dvec3& unit) {
    const glm::dvec3 point = volume.FrameFromUnit(unit);
    const double distance = std::max(glm::length(lamp - point), 1e-9);
    Bands<double> depth = lamps->DepthTo(number, point);
    for (const LocalMedium& medium : media.all()) {
      const bool is_exact = medium.volume() == &volume && volume.grid() == nullptr;
      if (medium.volume() == nullptr || is_exact) continue;
      AddDepth(medium.optics, medium.volume()->Column(point, (lamp - point) / distance, distance),
               depth);
    }
    for (std::size_t band = 0; band < depth.count; ++band)
      depth[band] = std::min(depth[band], kDark);
    return depth;
  };
  return {number, Tabulated(size, bands(), depth_at)};
}

// Returns the mean transmittance of the volumes over directions, weighted by the sky's radiance.
std::vector<VolumeGrid> MediaLight::State::SkyLeft(const LocalVolume& volume,
                                                   const SkyMoments& sky) const {
  constexpr std::array<int, 3> kSize{8, 8, 8};
  const LebedevRule& rule = Lebedev();
  const std::vector<double> all(
      static_cast<std::size_t>(air.multiple_scattering().options().degree) + 1, 1.0);
  std::array<BandLight, 26> weight;
  BandLight sum(bands());
  for (std::size_t i = 0; i < weight.size(); ++i) {
    weight[i] = static_cast<float>(rule.weight[i]) * sky.Towards(rule.direction[i], all)[1];
    sum = sum + weight[i];
  }
  const bool is_dark = sum == BandLight(bands());
  return Tabulated(kSize, bands(), [&](const glm::dvec3& unit) {
    Bands<double> mean(bands());
    if (is_dark) return mean;
    const glm::dvec3 point = volume.FrameFromUnit(unit);
    for (std::size_t i = 0; i < weight.size(); ++i) {
      Bands<double> depth(bands());
      for (const LocalMedium& medium : media.all()) {
        if (medium.volume() != nullptr)
          AddDepth(medium.optics, medium.volume()->Column(point, rule.direction[i], kEndless),
                   depth);
      }
      for (std::size_t band = 0; band < mean.count; ++band)
        mean[band] += static_cast<double>(weight[i][band]) * std::exp(-depth[band]);
    }
    for (std::size_t band = 0; band < mean.count; ++band)
      mean[band] = sum[band] > 0.0F ? mean[band] / static_cast<double>(sum[band]) : 0.0;
    return mean;
  });
}

Bands<double> MediaLight::State::VolumesToSun(const glm::dvec3& point) const {
  Bands<double> depth(bands());
  for (std::size_t m = 0; m < volumes.size(); ++m) {
    const LocalVolume& volume = *media.all()[m].volume();
    const glm::dvec3 off = volume.UnitFromFrame(point) - 0.5;
    const bool in_box = std::max({std::abs(off.x), std::abs(off.y), std::abs(off.z)}) <= 0.5;
    AddDepth(media.all()[m].optics,
             in_box && volumes[m].sun_column ? volumes[m].sun_column->At(off + 0.5)
                                             : volume.Column(point, sun.direction.seen, kEndless),
             depth);
  }
  return depth;
}

namespace {

/// The air along one ray, at knots so close that values between them are linear. The knots begin
/// where the ray enters the air; before the air and behind it, nothing is interpolated.
class AirOnRay {
 public:
  AirOnRay(const MediaLight::State& light, const glm::dvec3& origin, const glm::dvec3& direction)
      : light_(light), origin_(origin), direction_(direction) {
    constexpr double kLongest_m = 2000.0, kHighest_m = 100.0;
    ray_.altitude_m = light.geometry.AltitudeOf(origin);
    ray_.mu = SineAt(0.0);
    const double top_m = light.air.medium().atmosphere_height_m;
    const RayExtent in_air = ExtentOf(ray_, light.geometry.radius_m(), top_m);
    begin_m_ = in_air.begin_m;
    // A basin can lie below the planet's sphere.
    if (in_air.end == RayEnd::kSpace) end_m_ = in_air.end_m;
    step_m_ = std::min(kLongest_m, kHighest_m / std::max(std::abs(SineAt(begin_m_)), 1e-3));
  }

  struct Knot {
    bool is_known = false;
    BandLight depth;  // of the air, from the origin
    BandLight sun;    // in the air, without terrain and media
  };

  /// Transmittance of the air over a distance, and sunlight at its end.
  struct Light {
    BandLight left, sun;
  };
  [[nodiscard]] Light At(double distance_m) {
    if (distance_m < begin_m_ || distance_m > end_m_) {
      const Knot here = Computed(distance_m);
      return Between(here, here, 0.0F);
    }
    const double u = (distance_m - begin_m_) / step_m_;
    const auto low = static_cast<std::size_t>(u);
    if (knots_.size() < low + 2) knots_.resize(low + 2);
    const Knot& a = Known(low);
    const Knot& b = Known(low + 1);
    return Between(a, b, static_cast<float>(u - static_cast<double>(low)));
  }

 private:
  [[nodiscard]] double SineAt(double distance_m) const {
    const glm::dvec3 up = light_.geometry.UpAt(origin_ + distance_m * direction_);
    return std::clamp(glm::dot(direction_, up), -1.0, 1.0);
  }
  [[nodiscard]] Light Between(const Knot& a, const Knot& b, float share) const {
    Light light{BandLight(light_.bands()), BandLight(light_.bands())};
    for (std::size_t band = 0; band < light.left.count; ++band) {
      light.left[band] = std::exp(-((1.0F - share) * a.depth[band] + share * b.depth[band]));
      light.sun[band] = (1.0F - share) * a.sun[band] + share * b.sun[band];
    }
    return light;
  }
  [[nodiscard]] Knot Computed(double distance_m) const {
    ViewRay ray = ray_;
    ray.length_m = distance_m;
    ray.passes_ground = true;
    const BandLight none(light_.bands());
    return {true,
            distance_m <= begin_m_ ? none : light_.air.single_scattering().OpticalDepthAlong(ray),
            light_.SunInAir(origin_ + distance_m * direction_)};
  }
  const Knot& Known(std::size_t index) {
    Knot& knot = knots_[index];
    if (!knot.is_known) knot = Computed(begin_m_ + static_cast<double>(index) * step_m_);
    return knot;
  }

  const MediaLight::State& light_;
  glm::dvec3 origin_, direction_;
  ViewRay ray_;
  double begin_m_ = 0.0, end_m_ = kEndless, step_m_;  // of the knots
  std::vector<Knot> knots_;
};

/// Sources along one ray.
class Sources {
 public:
  Sources(const MediaLight::State& light, const glm::dvec3& origin, const glm::dvec3& direction,
          const SunlitPath* sunlit)
      : light_(light), direction_(direction), air_(light, origin, direction), sunlit_(sunlit) {
    const double cosine = glm::dot(direction, light.sun.direction.seen);
    for (std::size_t m = 0; m < light.volumes.size(); ++m) {
      phase_.push_back(Phase(light.media.all()[m].optics.phase, cosine));
      sky_.push_back(light.volumes[m].sky.Towards(direction, light.volumes[m].chi));
    }
    if (light.fog) look_ = light.fog->LookAlong(direction);
  }

  BandLight operator()(double distance_m, const glm::dvec3& point,
                       std::span<const double> densities) {
    const AirOnRay::Light air = air_.At(distance_m);
    const float past_terrain =
        sunlit_ != nullptr ? static_cast<float>(SunlightAt(*sunlit_, distance_m)) : 1.0F;
    const Bands<double> depth = light_.VolumesToSun(point);
    BandLight lit(depth.count);
    for (std::size_t band = 0; band < lit.count; ++band) {
      lit[band] = past_terrain * static_cast<float>(std::exp(-depth[band]));
    }
    const BandLight sun = lit * air.sun;
    const double altitude = light_.geometry.AltitudeOf(point);
    const double fog_depth = light_.fog ? light_.FogToSun(point) : 0.0;
    BandLight sum(sun.count);
    for (std::size_t m = 0; m < light_.volumes.size(); ++m) {
      if (densities[m] > 0.0) AddVolume(m, point, altitude, densities[m], sun, fog_depth, sum);
    }
    if (light_.fog && densities.back() > 0.0) {
      AddFog(altitude, densities.back(), sun, lit, fog_depth, sum);
    }
    return air.left * sum;
  }

 private:
  void AddVolume(std::size_t m, const glm::dvec3& point, double altitude, double density,
                 const BandLight& sun, double fog_depth, BandLight& sum) const {
    const LitVolume& volume = light_.volumes[m];
    const LocalMedium& medium = light_.media.all()[m];
    const BandLight sky = volume.sky.At(sky_[m], altitude);
    const glm::dvec3 unit = medium.volume()->UnitFromFrame(point);
    const float sun_through_fog = light_.fog ? light_.fog->BeamLeft(fog_depth) : 1.0F;
    const float sky_through_fog = light_.fog ? light_.fog->SkyLeft(altitude) : 1.0F;
    for (std::size_t band = 0; band < sum.count; ++band) {
      const float arriving =
          static_cast<float>(phase_[m]) * sun_through_fog * sun[band] +
          sky_through_fog * sky[band] * static_cast<float>(volume.sky_left[band].At(unit));
      sum[band] +=
          static_cast<float>(density) * (static_cast<float>(medium.optics.scattering_per_m[band]) *
                                             light_.sun.irradiance[band] * arriving +
                                         static_cast<float>(medium.optics.emission_per_m[band]));
    }
    for (const VolumeLamp& lamp : volume.lamps) AddLamp(medium, lamp, point, unit, density, sum);
  }

  void AddLamp(const LocalMedium& medium, const VolumeLamp& seen, const glm::dvec3& point,
               const glm::dvec3& unit, double density, BandLight& sum) const {
    const LampLight::SceneLamp lamp = light_.lamps->At(seen.number);
    const glm::dvec3 way = lamp.lamp.position_m - point;
    const double distance = std::max({glm::length(way), lamp.lamp.radius_m, 1e-3});
    const glm::dvec3 towards = way / distance;
    const double per_area = RelativeIntensity(lamp.lamp, -towards) / (distance * distance) *
                            density * Phase(medium.optics.phase, glm::dot(direction_, towards));
    if (per_area == 0.0) return;
    const LocalVolume& volume = *medium.volume();
    const double own = volume.grid() != nullptr ? 0.0 : volume.Column(point, towards, distance);
    for (std::size_t band = 0; band < sum.count; ++band) {
      const double depth = own * medium.optics.extinction_per_m[band] + seen.depth[band].At(unit);
      sum[band] +=
          lamp.intensity[band] *
          static_cast<float>(per_area * medium.optics.scattering_per_m[band] * std::exp(-depth));
    }
  }

  // @param lit  fraction of sunlight that terrain and volumes let through.
  void AddFog(double altitude, double density, const BandLight& sun, const BandLight& lit,
              double fog_depth, BandLight& sum) const {
    const FogLight::Scattered fog = light_.fog->At(*look_, altitude, sun, lit, fog_depth);
    const auto scattering =
        static_cast<float>(density * light_.media.fog()->optics.scattering_per_m[0]);
    for (std::size_t band = 0; band < sum.count; ++band) {
      sum[band] += scattering * light_.sun.irradiance[band] * (fog.of_sun[band] + fog.of_sky[band]);
    }
  }

  const MediaLight::State& light_;
  glm::dvec3 direction_;
  AirOnRay air_;
  const SunlitPath* sunlit_;
  std::vector<double> phase_;
  std::vector<std::vector<BandLight>> sky_;
  std::optional<FogLight::Look> look_;
};

}  // namespace

MediaLight::MediaLight(LocalMedia media, const SceneGeometry& geometry, const SolvedAir& air,
                       const Lighting& light, const LampLight* lamps)
    : state_(std::make_unique<State>(std::move(media), geometry, air, light, lamps)) {}
MediaLight::~MediaLight() = default;

const LocalMedia& MediaLight::media() const { return state_->media; }

MarchedLight MediaLight::Along(const glm::dvec3& origin, const glm::dvec3& direction,
                               double length_m, const SunlitPath* sunlit, double tolerance) const {
  Sources sources(*state_, origin, direction, sunlit);
  // A lamp's light varies on the scale of its distance from the ray, so panels end there.
  std::vector<double> cuts;
  for (const LitVolume& volume : state_->volumes) {
    for (const VolumeLamp& seen : volume.lamps) {
      const Lamp& lamp = state_->lamps->At(seen.number).lamp;
      const double nearest = glm::dot(lamp.position_m - origin, direction);
      const double across =
          std::max(glm::length(lamp.position_m - origin - nearest * direction), lamp.radius_m);
      for (const double step : {-4.0, -1.0, 0.0, 1.0, 4.0}) cuts.push_back(nearest + step * across);
    }
  }
  return MarchMedia(state_->media, origin, direction, length_m, std::ref(sources), tolerance, cuts);
}

BandLight MediaLight::SunLeft(const glm::dvec3& point, const glm::dvec3& to_sun) const {
  BandLight left(state_->bands());
  Bands<double> depth(state_->bands());
  for (const LocalMedium& medium : state_->media.all()) {
    if (medium.volume() != nullptr)
      AddDepth(medium.optics, medium.ColumnTowards(point, to_sun), depth);
  }
  const float fog = state_->fog ? state_->fog->BeamLeft(state_->FogToSun(point)) : 1.0F;
  for (std::size_t band = 0; band < left.count; ++band) {
    left[band] = fog * static_cast<float>(std::exp(-depth[band]));
  }
  return left;
}

SkyThroughFog MediaLight::SkyOnSurface(double altitude_m, double cos_up) const {
  SkyThroughFog sky{BandLight(state_->bands()), BandLight(state_->bands())};
  std::fill_n(sky.left.value.begin(), sky.left.count, 1.0F);
  if (!state_->fog) return sky;
  return {state_->fog->SkyLeft(altitude_m) * sky.left, state_->fog->OnSurface(altitude_m, cos_up)};
}

}  // namespace alpenglow::renderer
