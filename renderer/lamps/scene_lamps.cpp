// SPDX-License-Identifier: MIT
#include "renderer/lamps/scene_lamps.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <numeric>
#include <queue>

#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/time_place/geodesy.h"
#include "renderer/surface/scene_geometry.h"

namespace alpenglow::renderer {

namespace {

// Returns the luminance that a lamp may add to a picture [cd/m^2]: that of its light in the air
// three degrees from it, or of ground that reflects a third of its light, scaled by the part of a
// pixel that the ground fills.
double Promise(const LampNode& node, const LampView& view) {
  constexpr double kBeside = 0.05;
  const PlacedLamp& lamp = node.light;
  const double distance = std::max(lamp.distance_m - node.radius_m, 1.0);
  const double in_air = lamp.candela * node.extinction_per_m / (distance * kBeside);
  const double height = std::max(lamp.above_ground_m, 0.3);
  const double width = std::min(height / (distance * view.pixel_angle_rad), 1.0);
  return std::max(in_air, 0.1 * lamp.candela / (height * height) * width * width);
}

// Returns the error of using a node instead of the lamps below it.
double ErrorOf(const LampNode& node) {
  if (!node.children) return 0.0;
  const double distance = std::max(node.light.distance_m - node.radius_m, 1.0);
  const double relative = node.radius_m / distance;
  return node.light.candela / distance * relative * relative;
}

glm::vec4 ScaledInFloats(const Spectrum& bands, double scale) {
  glm::vec4 values(0.0F);
  for (std::size_t band = 0; band < std::min<std::size_t>(bands.size(), 4); ++band) {
    values[static_cast<glm::length_t>(band)] = static_cast<float>(scale) * bands[band];
  }
  return values;
}

LampDisk DiskOf(const PlacedLamp& lamp, const LampView& view) {
  const glm::vec3 towards = view.from_eye.AlongBack(lamp.direction);
  return {{towards, lamp.lamp.radius_m / lamp.distance_m},
          ScaledInFloats(lamp.towards_eye, 1.0 / (lamp.distance_m * lamp.distance_m)),
          {lamp.distance_m, 0.0, 0.0, 0.0}};
}

}  // namespace

SceneLamps::SceneLamps(const Scene& scene, const SceneGround& ground, const Medium& medium)
    : medium_(medium),
      colour_(medium.wavelengths_nm),
      stage_(scene, ground, medium),
      tree_(PlacedLampsOf(scene, stage_, medium, colour_),
            {{0.0, 0.0, ground.eye_height_m}, std::nullopt}, stage_) {
  for (std::uint32_t i = 0; i < tree_.lamps(); ++i) {
    const LampProfile& profile = tree_.Light(i).lamp.profile;
    auto known = std::find(tables_.begin(), tables_.end(), profile);
    if (profile.kind == LampProfile::Kind::kTable && known == tables_.end()) {
      known = tables_.insert(tables_.end(), profile);
    }
    table_of_lamp_.push_back(static_cast<int>(known - tables_.begin()));
  }
  if (ground.terrain) {
    shades_.resize(std::min(tree_.lamps(), kMostShades));
    tbb::parallel_for(std::size_t{0}, shades_.size(), [&](std::size_t i) {
      shades_[i] = ShadeAround(stage_, tree_.Light(static_cast<std::uint32_t>(i)).lamp.position_m);
    });
  }
  PlanBrightest();
  for (std::uint32_t i = 0; i < tree_.nodes().size(); ++i) {
    const LampAirlightIrradiance* glow = &tree_.GlowOf(i);
    if (number_of_glow_.try_emplace(glow, static_cast<int>(glows_.size())).second) {
      glows_.push_back(glow);
    }
  }
}

void SceneLamps::PlanBrightest() {
  std::vector<std::uint32_t> lamps(shades_.size());
  std::iota(lamps.begin(), lamps.end(), std::uint32_t{0});
  std::stable_sort(lamps.begin(), lamps.end(), [&](std::uint32_t a, std::uint32_t b) {
    return tree_.Light(a).candela > tree_.Light(b).candela;
  });
  lamps.resize(std::min(lamps.size(), kMostPlans));
  for (const std::uint32_t node : lamps) {
    const PlacedLamp& placed = tree_.Light(node);
    planned_.push_back({node, placed.lamp, PlanLayerCount(), PlanLevelsOf(placed.candela)});
  }
  plans_.emplace(planned_.size(), [this](std::size_t i) {
    return LampShadowFieldAround(stage_, planned_[i].lamp, planned_[i].levels);
  });
}

int SceneLamps::PlanLayerCount() const {
  return planned_.empty() ? 0 : planned_.back().first_layer + planned_.back().levels;
}

std::vector<float> ShadeAround(const LampStage& stage, const glm::dvec3& place) {
  // These steps are short enough not to miss crests of 45 m cells by much.
  constexpr double kStep_m = 5.0, kMostSteps = 16.0;
  const double ratio = std::pow(kFarthestShade_m / kNearestShade_m, 1.0 / (kShadeRings - 1));
  std::vector<float> shade;
  std::vector<double> steepest(kShadeTurns, -std::numeric_limits<double>::infinity());
  for (int ring = 0; ring < kShadeRings; ++ring) {
    const double before = kNearestShade_m * std::pow(ratio, ring - 1);
    const int steps =
        static_cast<int>(std::ceil(std::clamp((ratio - 1.0) * before / kStep_m, 1.0, kMostSteps)));
    for (int turn = 0; turn < kShadeTurns; ++turn) {
      double& slope = steepest[static_cast<std::size_t>(turn)];
      const double angle = 2.0 * kPi * turn / kShadeTurns;
      for (int i = 1; i <= steps; ++i) {
        const double far = before * std::pow(ratio, i / static_cast<double>(steps));
        const glm::dvec3 point = place + far * glm::dvec3(std::cos(angle), std::sin(angle), 0.0);
        const double ground_m = stage.TerrainUnder(point, stage.PlanetUnder(point));
        slope = std::max(slope, (ground_m - place.z) / far);
      }
      shade.push_back(static_cast<float>(slope));
    }
  }
  return shade;
}

LampNodes SceneLamps::Cut(std::size_t most) const {
  const auto less = [&](std::uint32_t a, std::uint32_t b) {
    const double error_a = ErrorOf(tree_.nodes()[a]), error_b = ErrorOf(tree_.nodes()[b]);
    return error_a != error_b ? error_a < error_b : a < b;
  };
  std::priority_queue<std::uint32_t, LampNodes, decltype(less)> open(less);
  for (const std::uint32_t root : tree_.roots()) open.push(root);
  while (!open.empty() && open.size() < most && tree_.nodes()[open.top()].children) {
    const auto children = *tree_.nodes()[open.top()].children;
    open.pop();
    for (const std::uint32_t child : children) open.push(child);
  }
  LampNodes cut;
  for (; !open.empty(); open.pop()) cut.push_back(open.top());
  return cut;
}

ChosenLamp SceneLamps::Choose(std::uint32_t node) const {
  const int table = node < table_of_lamp_.size() ? table_of_lamp_[node] : 0;
  const int shade = node < shades_.size() ? static_cast<int>(node) : -1;
  ChosenLamp chosen{&tree_.Light(node), table, number_of_glow_.at(&tree_.GlowOf(node)), shade};
  for (std::size_t i = 0; i < plans().size(); ++i) {
    if (planned_[i].node != node) continue;
    chosen.first_plan = planned_[i].first_layer;
    chosen.plan_levels = planned_[i].levels;
  }
  return chosen;
}

PlacedLamp SceneLamps::Landing(const LampView& view) const {
  PlacedLamp placed;
  placed.lamp.position_m = view.from_eye.Point(landing_->offset_m);
  placed.lamp.radius_m = landing_->radius_m;
  placed.lamp.profile.kind = LampProfile::Kind::kCone;
  placed.lamp.profile.inner_rad = landing_->inner_rad;
  placed.lamp.profile.outer_rad = landing_->outer_rad;
  placed.lamp.axis = view.from_eye.Along(landing_->axis);
  placed.candela = landing_->intensity_cd;
  placed.intensity = LampIntensity(landing_->temperature_k, landing_->intensity_cd,
                                   medium_.wavelengths_nm, colour_);
  // Mean over a cone, accurate to a tenth. It determines the light that the illuminated air, spread
  // evenly, brings to the ground.
  placed.mean_share = 0.5 * (1.0 - std::cos(0.5 * (landing_->inner_rad + landing_->outer_rad)));
  return renderer::Before({view.from_eye.origin_m(), std::nullopt}, stage_, std::move(placed));
}

SceneLamps::InView SceneLamps::Before(const LampView& view, std::array<double, 2> core_rad,
                                      double dimmest_cd_per_m2, std::size_t most) {
  if (stands_at_m_ != view.from_eye.origin_m())
    tree_.StandBefore({view.from_eye.origin_m(), std::nullopt}, stage_);
  stands_at_m_ = view.from_eye.origin_m();
  InView in_view;
  std::vector<ChosenLamp> chosen;
  std::optional<PlacedLamp> landing;
  if (landing_) {
    landing = Landing(view);
    chosen.push_back({&*landing});
  }
  std::vector<std::pair<double, std::uint32_t>> bright;
  for (const std::uint32_t node : Cut(most - chosen.size())) {
    const double promise = Promise(tree_.nodes()[node], view);
    if (promise >= dimmest_cd_per_m2) bright.emplace_back(-promise, node);
  }
  std::sort(bright.begin(), bright.end());
  bright.resize(std::min(bright.size(), most - chosen.size()));
  for (const auto& [minus_promise, node] : bright) chosen.push_back(Choose(node));
  in_view.block = LampsBlockOf(chosen, layers(), medium_, colour_, view, core_rad);
  for (std::uint32_t i = 0; i < tree_.lamps(); ++i) {
    const PlacedLamp& lamp = tree_.Light(i);
    if (!lamp.HoldsEye() && !lamp.is_hidden) in_view.disks.push_back(DiskOf(lamp, view));
  }
  return in_view;
}

std::vector<float> SampledProfile(const LampProfile& profile) {
  std::vector<float> samples;
  for (int turn = 0; turn < kLampTurns; ++turn) {
    const double c = 2.0 * kPi * turn / (kLampTurns - 1);
    for (int i = 0; i < kLampGammas; ++i) {
      const double gamma = kPi * i / (kLampGammas - 1);
      samples.push_back(static_cast<float>(RelativeIntensity(
          profile,
          {std::cos(gamma), std::sin(gamma) * std::cos(c), std::sin(gamma) * std::sin(c)})));
    }
  }
  return samples;
}

void LampShadowFieldFollower::Follow() {
  if (plans_.size() == lamps_ || plan_.IsBusy()) return;
  if (std::optional<LampShadowField> made = plan_.Poll()) plans_.push_back(std::move(*made));
  if (plans_.size() < lamps_) plan_.Request(plans_.size());
}

void LampShadowFieldFollower::WaitUntilReady() {
  for (Follow(); plans_.size() < lamps_; Follow()) plan_.Wait();
}

}  // namespace alpenglow::renderer
