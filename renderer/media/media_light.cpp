// SPDX-License-Identifier: MIT
#include "renderer/media/media_light.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <span>
#include <vector>

#include "renderer/media/glow_field.h"

namespace alpenglow::renderer {
namespace {

constexpr double kNoEnd = std::numeric_limits<double>::infinity();

using LitMedia = std::vector<std::unique_ptr<const LitMedium>>;

/// The air along one ray, at knots so close that values between them are linear. The knots begin
/// where the ray enters the air; before the air and behind it, nothing is interpolated.
class AirOnRay {
 public:
  AirOnRay(const MediaSources& sources, const glm::dvec3& origin, const glm::dvec3& direction)
      : sources_(sources), origin_(origin), direction_(direction) {
    constexpr double kLongest_m = 2000.0, kHighest_m = 100.0;
    ray_.altitude_m = sources.geometry.AltitudeOf(origin);
    ray_.mu = SineAt(0.0);
    const double top_m = sources.air.medium().atmosphere_height_m;
    const RayExtent in_air = ExtentOf(ray_, sources.geometry.radius_m(), top_m);
    begin_m_ = in_air.begin_m;
    // A basin can lie below the planet's sphere.
    if (in_air.end == RayEnd::kSpace) end_m_ = in_air.end_m;
    step_m_ = std::min(kLongest_m, kHighest_m / std::max(std::abs(SineAt(begin_m_)), 1e-3));
  }

  struct Knot {
    bool is_known = false;
    Spectrum depth;  // of the air, from the origin
    Spectrum sun;    // in the air, without terrain and media
  };

  /// Transmittance of the air over a distance, and sunlight at its end.
  struct Light {
    Spectrum left, sun;
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
    const glm::dvec3 up = sources_.geometry.UpAt(origin_ + distance_m * direction_);
    return std::clamp(glm::dot(direction_, up), -1.0, 1.0);
  }
  [[nodiscard]] Light Between(const Knot& a, const Knot& b, float share) const {
    Light light{Spectrum(sources_.bands()), Spectrum(sources_.bands())};
    for (std::size_t band = 0; band < light.left.size(); ++band) {
      light.left[band] = std::exp(-((1.0F - share) * a.depth[band] + share * b.depth[band]));
      light.sun[band] = (1.0F - share) * a.sun[band] + share * b.sun[band];
    }
    return light;
  }
  [[nodiscard]] Knot Computed(double distance_m) const {
    ViewRay ray = ray_;
    ray.length_m = distance_m;
    ray.passes_ground = true;
    const Spectrum none(sources_.bands());
    return {true,
            distance_m <= begin_m_ ? none : sources_.air.single_scattering().OpticalDepthAlong(ray),
            sources_.SunInAir(origin_ + distance_m * direction_)};
  }
  const Knot& Known(std::size_t index) {
    Knot& knot = knots_[index];
    if (!knot.is_known) knot = Computed(begin_m_ + static_cast<double>(index) * step_m_);
    return knot;
  }

  const MediaSources& sources_;
  glm::dvec3 origin_, direction_;
  ViewRay ray_;
  double begin_m_ = 0.0, end_m_ = kNoEnd, step_m_;  // of the knots
  std::vector<Knot> knots_;
};

/// Sources along one ray.
class Sources {
 public:
  /// @param sunlit  stretches that terrain does not shade; null: the whole ray.
  Sources(const MediaSources& sources, const LitMedia& lit, const glm::dvec3& origin,
          const glm::dvec3& direction, const SunlitPath* sunlit)
      : sources_(sources),
        lit_(lit),
        origin_(origin),
        direction_(direction),
        air_(sources, origin, direction),
        sunlit_(sunlit),
        on_ray_(lit.size()) {}

  Spectrum operator()(double distance_m, const glm::dvec3& point, std::span<const double> densities,
                      std::span<const double> columns_m) {
    const AirOnRay::Light air = air_.At(distance_m);
    const double altitude_m = sources_.geometry.AltitudeOf(point);
    const float past_terrain =
        sunlit_ != nullptr ? static_cast<float>(SunlightAt(*sunlit_, distance_m)) : 1.0F;
    Spectrum sum(air.sun.size());
    for (std::size_t m = 0; m < lit_.size(); ++m) {
      if (densities[m] <= 0.0) continue;
      const SpectrumOf<double> depth = DepthOfOthers(m, point);
      MediumAt(m).AddSource({point, distance_m, altitude_m, air.sun, past_terrain, depth,
                             columns_m[m], SkyPastOthers(m, altitude_m)},
                            densities[m], sum);
    }
    return air.left * sum;
  }

 private:
  /// Return what the media other than `m` do to the light of the sun and of the sky.
  [[nodiscard]] SpectrumOf<double> DepthOfOthers(std::size_t m, const glm::dvec3& point) const {
    SpectrumOf<double> depth(sources_.bands());
    for (std::size_t other = 0; other < lit_.size(); ++other) {
      if (other != m) lit_[other]->AddDepthToLight(point, sources_.light.direction.seen, depth);
    }
    return depth;
  }
  [[nodiscard]] float SkyPastOthers(std::size_t m, double altitude_m) const {
    float left = 1.0F;
    for (std::size_t other = 0; other < lit_.size(); ++other) {
      if (other != m) left *= lit_[other]->SkyLeft(altitude_m);
    }
    return left;
  }

  /// Returns a medium on the ray. One that the ray does not meet is never looked at.
  [[nodiscard]] const MediumOnRay& MediumAt(std::size_t m) {
    if (!on_ray_[m]) on_ray_[m] = lit_[m]->OnRay(origin_, direction_);
    return *on_ray_[m];
  }

  const MediaSources& sources_;
  const LitMedia& lit_;
  glm::dvec3 origin_, direction_;
  AirOnRay air_;
  const SunlitPath* sunlit_;
  std::vector<std::unique_ptr<const MediumOnRay>> on_ray_;
};

/// Returns the optical depth of the air between two points.
Spectrum DepthOfAir(const MediaSources& sources, const glm::dvec3& from, const glm::dvec3& to) {
  const double length_m = glm::length(to - from);
  ViewRay ray;
  ray.altitude_m = sources.geometry.AltitudeOf(from);
  ray.mu = std::clamp(glm::dot(to - from, sources.geometry.UpAt(from)) / std::max(length_m, 1e-9),
                      -1.0, 1.0);
  ray.length_m = length_m;
  ray.passes_ground = true;
  return sources.air.single_scattering().OpticalDepthAlong(ray);
}

}  // namespace

struct MediaLight::State {
  State(LocalMedia of, const SceneGeometry& geometry, const SolvedAir& air, const Lighting& light,
        const LampLight* lamps, MediaEmission emission, CloudsOverMedia clouds)
      : media(std::move(of)), sources{media,    geometry,         air, light.source, lamps,
                                      emission, std::move(clouds)} {
    for (const auto& medium : media.all()) {
      lit.push_back(medium->LitBy(sources));
      extinction_per_m.push_back(
          lit.back()->WideExtinction_per_m().value_or(medium->optics().extinction_per_m));
    }
  }

  LocalMedia media;
  MediaSources sources;
  LitMedia lit;                                      // [medium]
  std::vector<SpectrumOf<double>> extinction_per_m;  // [medium], for light of wide sources
};

MediaLight::MediaLight(LocalMedia media, const SceneGeometry& geometry, const SolvedAir& air,
                       const Lighting& light, const LampLight* lamps, MediaEmission emission,
                       CloudsOverMedia clouds)
    : state_(std::make_unique<State>(std::move(media), geometry, air, light, lamps, emission,
                                     std::move(clouds))) {}
MediaLight::~MediaLight() = default;

const LocalMedia& MediaLight::media() const { return state_->media; }

MarchedLight MediaLight::Along(const glm::dvec3& origin, const glm::dvec3& direction,
                               double length_m, const SunlitPath* sunlit, double tolerance) const {
  Sources sources(state_->sources, state_->lit, origin, direction, sunlit);
  std::vector<double> cuts;
  for (const auto& medium : state_->lit) medium->AddCuts(origin, direction, cuts);
  return MarchMedia(state_->media, origin, direction, length_m, std::ref(sources), tolerance, cuts,
                    state_->extinction_per_m);
}

Spectrum MediaLight::BeamLeft(const glm::dvec3& point, const glm::dvec3& to_disk) const {
  Spectrum left(state_->media.bands());
  SpectrumOf<double> depth(left.size());
  for (const auto& medium : state_->lit) medium->AddDepthToLight(point, to_disk, depth);
  for (std::size_t band = 0; band < left.size(); ++band)
    left[band] = static_cast<float>(std::exp(-depth[band]));
  return left;
}

Spectrum MediaLight::GlowOnSurface(const glm::dvec3& point, const glm::dvec3& normal,
                                   const std::function<bool(const glm::dvec3& place)>& sees) const {
  const Spectrum none(state_->media.bands());
  Spectrum sum = none;
  for (std::size_t m = 0; m < state_->lit.size(); ++m) {
    const GlowField* const field = state_->lit[m]->Glow();
    if (field == nullptr) continue;
    const Spectrum clear = field->On(point, normal, sees);
    if (clear == none) continue;
    const glm::dvec3 way = field->middle() - point;
    const double length_m = std::max(glm::length(way), 1e-9);
    const Spectrum air = DepthOfAir(state_->sources, point, field->middle());
    std::vector<double> columns_m(state_->lit.size(), 0.0);
    for (std::size_t other = 0; other < columns_m.size(); ++other) {
      if (other != m)
        columns_m[other] = state_->media.all()[other]->Column(point, way / length_m, length_m);
    }
    for (std::size_t band = 0; band < sum.size(); ++band) {
      double depth = static_cast<double>(air[band]);
      for (std::size_t other = 0; other < columns_m.size(); ++other)
        depth += columns_m[other] * state_->extinction_per_m[other][band];
      sum[band] += clear[band] * static_cast<float>(std::exp(-depth));
    }
  }
  return sum;
}

std::vector<glm::dvec3> MediaLight::PlacesThatGlow() const {
  std::vector<glm::dvec3> places;
  for (const auto& medium : state_->lit) {
    if (const GlowField* const field = medium->Glow()) places.push_back(field->middle());
  }
  return places;
}

SkyThroughMedia MediaLight::SkyOnSurface(double altitude_m, double cos_up,
                                         SkyThroughMedia above) const {
  for (const auto& medium : state_->lit) medium->ChangeSky(altitude_m, cos_up, above);
  return above;
}

}  // namespace alpenglow::renderer
