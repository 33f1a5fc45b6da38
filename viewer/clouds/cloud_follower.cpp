// SPDX-License-Identifier: MIT
#include "viewer/clouds/cloud_follower.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "atmosphere/math/constants.h"
#include "renderer/lit_clouds/lit_clouds.h"
#include "renderer/scene/scene_clouds.h"
#include "renderer/surface/scene_geometry.h"
#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {
namespace {

// Clouds are made again when the light has turned by this angle, or after this time. Below the horizon,
// it also lights other clouds when the eye has climbed by this height.
constexpr double kTurned_rad = 0.5 * kRadiansPerDegree, kPassed_s = 60.0, kClimbed_m = 500.0;
// The rest after a computation, in units of its time: drawing needs the processors.
constexpr double kRest = 1.0;
// Other clouds are made when they have stayed the same for this time, so that no computation begins for
// values of a slider that a user passes.
constexpr double kSettle_s = 0.3;

CloudColours ColoursOf(const LitClouds& clouds, const CloudTexels& texels) {
  CloudColours colours;
  for (std::size_t i = 0; i < texels.layer.size(); ++i) {
    const AltitudeRange& range = texels.layer[i].range;
    const LitClouds::LightAround low = clouds.AroundLayer(i, {0.0, 0.0, range.low_m});
    const LitClouds::LightAround high = clouds.AroundLayer(i, {0.0, 0.0, range.high_m});
    colours.sky_low.push_back(GpuBandsOf(low.sky));
    colours.sky_high.push_back(GpuBandsOf(high.sky));
    colours.ground_low.push_back(GpuBandsOf(low.ground));
    colours.ground_high.push_back(GpuBandsOf(high.ground));
  }
  for (const LitClouds::InterfaceLight& light : clouds.Interfaces()) {
    colours.interfaces.push_back({static_cast<float>(std::max(light.low_m, -1e6)),
                                  light.air_left,
                                  GpuBandsOf(light.added),
                                  GpuBandsOf(light.diffuse),
                                  {}});
    for (const Spectrum& towards : light.diffuse_towards)
      colours.interfaces.back().diffuse_towards.push_back(GpuBandsOf(towards));
  }
  return colours;
}

}  // namespace

/// Makes clouds. It keeps the fields of the last time and their solutions, which other air of the same
/// planet does not change.
class CloudFollower::Maker {
 public:
  Maker(const LocalFrame& frame, double ground_m)
      : ground_{frame, std::nullopt, 0.0, "", true}, ground_m_(ground_m) {}

  MadeClouds operator()(const CloudMoment& moment) {
    if (!HasFieldsOf(moment)) {
      solved_.reset();
      clouds_.emplace(*moment.scene, ground_m_, moment.air->medium().planet_radius_m);
      kept_ = moment;
    }
    Solve(moment);
    const SceneGeometry geometry(ground_, moment.air->medium(), false);
    const LitClouds lit(solved_, geometry, *moment.air, moment.light);
    return {moment, texels_, ColoursOf(lit, *texels_)};
  }

 private:
  [[nodiscard]] bool HasFieldsOf(const CloudMoment& moment) const {
    return kept_ && kept_->scene == moment.scene && SecondsBetween(kept_->now, moment.now) == 0.0 &&
           kept_->air->medium().planet_radius_m == moment.air->medium().planet_radius_m;
  }
  void Solve(const CloudMoment& moment) {
    const std::shared_ptr<const SolvedClouds> before = solved_;
    solved_ = clouds_->At(moment.now, {moment.light.direction.seen, moment.eye_altitude_m});
    if (solved_ == before) return;
    texels_ = std::make_shared<const CloudTexels>(TexelsOfClouds(*solved_));
  }

  SceneGround ground_;  // without terrain
  double ground_m_;
  std::optional<CloudMoment> kept_;  // of clouds_
  std::optional<CloudsByTime> clouds_;
  std::shared_ptr<const SolvedClouds> solved_;
  std::shared_ptr<const CloudTexels> texels_;
};

CloudFollower::CloudFollower(const Scene& scene, const SceneGround& ground)
    : scene_(std::make_shared<const Scene>(scene)), frame_(ground.frame) {
  ground_m_ = GroundHeightUnder(ground, scene.place);
  Begin();
}

void CloudFollower::Begin() {
  if (!HasAny() || maker_) return;
  maker_.emplace([maker = std::make_shared<Maker>(frame_, ground_m_)](
                     const CloudMoment& moment) { return (*maker)(moment); },
                 Suits);
}

std::size_t CloudFollower::layers() const {
  if (!shown_) return 0;
  return std::max(shown_->textures->layers(), earlier_ ? earlier_->textures->layers() : 0);
}

void CloudFollower::Use(const std::vector<SceneCloud>& clouds, double ground_m) {
  if (!maker_) ground_m_ = ground_m;
  Scene other = *scene_;
  other.clouds = clouds;
  scene_ = std::make_shared<const Scene>(std::move(other));
  settles_s_ = kSettle_s;
  if (maker_) maker_->Forget();
  Begin();
}

bool CloudFollower::Suits(const CloudMoment& made, const CloudMoment& wanted) {
  const bool is_up =
      wanted.light.direction.seen.z >= std::sin(kLowestCloudLight_deg * kRadiansPerDegree);
  return made.air == wanted.air && made.scene == wanted.scene &&
         (is_up || std::abs(made.eye_altitude_m - wanted.eye_altitude_m) < kClimbed_m) &&
         made.light.body == wanted.light.body &&
         std::abs(SecondsBetween(made.now, wanted.now)) < kPassed_s &&
         glm::length(made.light.direction.seen - wanted.light.direction.seen) < kTurned_rad;
}

CloudMoment CloudFollower::MomentOf(const std::shared_ptr<const SolvedAir>& air, const Place& eye,
                                    const UtcTime& now, const DistantLight& light) const {
  const LocalFrame here(frame_.ellipsoid(), eye);
  const auto turned = [&](const glm::dvec3& direction) {
    return glm::normalize(frame_.EnuFromEcef(here.EcefFromEnu(Vector<Enu>{direction})).xyz);
  };
  DistantLight from_scene = light;
  from_scene.direction = {turned(light.direction.seen), turned(light.direction.for_air)};
  return {air, scene_, now, from_scene, eye.height_m};
}

void CloudFollower::TakeOver(MadeClouds made) {
  if (shown_ && shown_->made.texels == made.texels) {
    shown_->made = std::move(made);  // other colours of the same clouds
    return;
  }
  coming_ = std::make_shared<Shown>();
  coming_->textures = std::make_shared<CloudTextures>(made.texels);
  coming_->made = std::move(made);
}

void CloudFollower::Show() {
  earlier_ = std::exchange(shown_, std::exchange(coming_, nullptr));
  share_ = 0.0;
}

void CloudFollower::Follow(const std::shared_ptr<const SolvedAir>& air, const Place& eye,
                           const UtcTime& now, const DistantLight& light, double seconds) {
  if (!maker_) return;
  if (!HasAny()) {
    coming_ = shown_ = earlier_ = nullptr;
    return;
  }
  share_ = std::min(share_ + seconds / kFade_s, 1.0);
  settles_s_ = std::max(settles_s_ - seconds, 0.0);
  if (share_ >= 1.0) earlier_ = nullptr;
  if (!coming_) {
    if (std::optional<MadeClouds> made = maker_->Poll()) {
      if (made->of.scene == scene_) maker_->RestFor(kRest * maker_->making_s());
      TakeOver(std::move(*made));
    }
    if (settles_s_ <= 0.0) maker_->RequestWhenIdle(MomentOf(air, eye, now, light));
  }
  if (coming_ && coming_->textures->UploadOne(kUploadUnit) && share_ >= 1.0) Show();
}

void CloudFollower::WaitUntilReady(const std::shared_ptr<const SolvedAir>& air, const Place& eye,
                                   const UtcTime& now, const DistantLight& light) {
  if (!maker_ || !HasAny()) return;
  maker_->WaitUntilReady(MomentOf(air, eye, now, light));
  if (std::optional<MadeClouds> made = maker_->Poll()) TakeOver(std::move(*made));
  while (coming_ && !coming_->textures->UploadOne(kUploadUnit)) continue;
  if (coming_) Show();
  earlier_ = nullptr;
  share_ = 1.0;
}

EyeInClouds CloudFollower::EyeAt(const Place& eye) const {
  constexpr double kStep_m = 1000.0;
  const double radius_m = shown_ ? shown_->made.of.air->medium().planet_radius_m
                                 : frame_.ellipsoid().equatorial_radius_m;
  const LocalFrame here(frame_.ellipsoid(), eye);
  const FrameTransform to_clouds(frame_, here);
  const glm::dvec3 at = InFlatFrame(to_clouds.origin_m(), radius_m);
  const glm::dvec3 east = InFlatFrame(to_clouds.Point({kStep_m, 0.0, 0.0}), radius_m) - at;
  return {{at.x, at.y, eye.height_m}, std::atan2(east.y, east.x)};
}

namespace {

glm::vec4 Mixed(const glm::vec4& one, const glm::vec4& other, float share) {
  return (1.0F - share) * one + share * other;
}

void Mix(std::vector<glm::vec4>& shown, const std::vector<glm::vec4>& earlier, float share) {
  for (std::size_t i = 0; i < shown.size(); ++i) shown[i] = Mixed(earlier[i], shown[i], share);
}

// Returns colours between those of earlier and of new clouds with as many layers.
CloudColours Between(const CloudColours& earlier, CloudColours shown, float share) {
  if (earlier.sky_low.size() != shown.sky_low.size()) return shown;
  Mix(shown.sky_low, earlier.sky_low, share);
  Mix(shown.sky_high, earlier.sky_high, share);
  Mix(shown.ground_low, earlier.ground_low, share);
  Mix(shown.ground_high, earlier.ground_high, share);
  for (std::size_t i = 0; i < shown.interfaces.size(); ++i) {
    CloudColours::Interface& of = shown.interfaces[i];
    const CloudColours::Interface& before = earlier.interfaces[i];
    of = {std::lerp(before.low_m, of.low_m, share), std::lerp(before.left, of.left, share),
          Mixed(before.added, of.added, share), Mixed(before.diffuse, of.diffuse, share),
          std::move(of.diffuse_towards)};
    if (of.diffuse_towards.size() == before.diffuse_towards.size())
      Mix(of.diffuse_towards, before.diffuse_towards, share);
  }
  return shown;
}

// Returns the place of a point in the lattice of a layer that the wind has moved, within a period.
glm::dvec2 InLattice(const glm::dvec2& at, const CloudLayerTexels& layer,
                     const glm::dvec2& moved_m) {
  const glm::dvec2 place = at - glm::dvec2(layer.origin_m) - moved_m;
  return layer.is_periodic ? place - layer.size_m * glm::floor(place / layer.size_m) : place;
}

}  // namespace

CloudsBlock CloudFollower::BlockFor(const Place& eye, const UtcTime& now) const {
  CloudsBlock block{};
  if (!shown_) return block;
  const EyeInClouds in_clouds = EyeAt(eye);
  block.turn = {std::cos(in_clouds.turn_rad), std::sin(in_clouds.turn_rad), share_, 0.0};
  const auto fill = [&](const Shown& of, std::size_t first) {
    const double passed_s = SecondsBetween(of.made.of.now, now);
    for (std::size_t i = 0; i < of.textures->layers(); ++i) {
      const CloudLayerTexels& layer = of.made.texels->layer[i];
      const CloudSunTexels::Layer& sun = of.made.texels->sun.layer[i];
      const glm::dvec2 moved_m = passed_s * (*of.made.texels->fields)[i].wind_m_per_s;
      const glm::dvec2 place = InLattice(glm::dvec2(in_clouds.at), layer, moved_m);
      block.place[first + i] = {place, 1.0 / layer.size_m};
      block.levels[first + i] = {sun.low_m, 1.0 / sun.level_m, sun.first, sun.levels};
      block.shear[first + i] = {sun.slope, layer.scale, sun.clear_from_m};
      block.range[first + i] = {layer.range.low_m, layer.range.high_m,
                                layer.is_periodic ? 0.0 : 1.0, 0.0};
    }
    // A layer that these clouds do not have hides nothing.
    for (std::size_t i = of.textures->layers(); i < kMostCloudLayers; ++i) {
      block.levels[first + i] = {0.0, 0.0, 0.0, 1.0};
      block.shear[first + i] = {0.0, 0.0, 1.0, -1e9};
    }
  };
  fill(*shown_, 0);
  fill(earlier_ ? *earlier_ : *shown_, kMostCloudLayers);
  const CloudColours colours =
      earlier_ ? Between(earlier_->made.colours, shown_->made.colours, static_cast<float>(share_))
               : shown_->made.colours;
  for (std::size_t i = 0; i < shown_->textures->layers(); ++i) {
    block.sky_low[i] = colours.sky_low[i];
    block.sky_high[i] = colours.sky_high[i];
    block.ground_low[i] = colours.ground_low[i];
    block.ground_high[i] = colours.ground_high[i];
  }
  for (std::size_t i = 0; i <= kMostCloudLayers; ++i) {
    const CloudColours::Interface& of =
        colours.interfaces[std::min(i, colours.interfaces.size() - 1)];
    const float low_m = i < colours.interfaces.size() ? of.low_m : 1e9F;
    block.interfaces[i] = {low_m, of.left, 0.0, 0.0};
    block.added[i] = of.added;
    block.diffuse_towards[i].fill(of.diffuse);
    std::ranges::copy(of.diffuse_towards, block.diffuse_towards[i].begin());
  }
  return block;
}

double CloudFollower::ExtinctionAt(const Place& place, const UtcTime& now) const {
  if (!shown_) return 0.0;
  const EyeInClouds at = EyeAt(place);
  const double passed_s = SecondsBetween(shown_->made.of.now, now);
  double sum = 0.0;
  for (const SceneCloudField& layer : *shown_->made.texels->fields) {
    const glm::dvec2 moved_m = passed_s * layer.wind_m_per_s;
    sum += layer.field.Extinction_per_m({glm::dvec2(at.at) - moved_m, at.at.z});
  }
  return sum;
}

}  // namespace alpenglow::viewer
