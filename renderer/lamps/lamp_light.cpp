// SPDX-License-Identifier: MIT
#include "renderer/lamps/lamp_light.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/lamp/airlight.h"
#include "lut/cli/program.h"
#include "renderer/lamps/lamp_tree.h"
#include "renderer/lamps/placed_lamp.h"
#include "renderer/lamps/tile_cut.h"

namespace alpenglow::renderer {
struct LampLight::State {
  LampStage stage;
  LampEye eye;
  LampTree tree;

  State(const Scene& scene, const SceneGround& ground, const Medium& medium,
        const BandColour& colour)
      : stage(scene, ground, medium),
        eye{{0.0, 0.0, ground.eye_height_m}, std::nullopt},
        tree(PlacedLampsOf(scene, stage, medium, colour), eye, stage) {}

  [[nodiscard]] Spectrum InAir(const LampNodes& lamps, const LampRayEnd& ray,
                               double pixel_angle_rad, int nodes) const;
  [[nodiscard]] LampTile TileAt(const MovingCamera& camera, const PixelBox& box,
                                const LampSettings& settings, const RayTrace& trace) const;
  /// Returns the lamps visible in a tile.
  [[nodiscard]] LampNodes SeenIn(const TileRays& rays) const;
  [[nodiscard]] bool AllLit(const LampNodes& members, const LampRayEnd& ray) const;
};

LampLight::LampLight(const Scene& scene, const SceneGround& ground, const Medium& medium,
                     const BandColour& colour)
    : state_(std::make_unique<State>(scene, ground, medium, colour)) {}
LampLight::LampLight(std::unique_ptr<State> state) : state_(std::move(state)) {}
LampLight::LampLight(LampLight&&) noexcept = default;
LampLight::~LampLight() = default;

LampLight LampLight::SeenBy(const CameraRays& camera) const {
  auto state = std::make_unique<State>(*state_);
  state->eye = {camera.eye(), std::nullopt};
  if (camera.HasLens()) state->eye.lens = camera;
  state->tree.StandBefore(state->eye, state->stage);
  return LampLight(std::move(state));
}

LampNodes LampLight::All() const {
  LampNodes all(state_->tree.lamps());
  std::iota(all.begin(), all.end(), std::uint32_t{0});
  return all;
}

std::vector<glm::dvec3> LampLight::Directions() const {
  std::vector<glm::dvec3> directions;
  for (const std::uint32_t lamp : All()) directions.push_back(state_->tree.Light(lamp).direction);
  return directions;
}

LampLight::SceneLamp LampLight::At(std::uint32_t number) const {
  const PlacedLamp& placed = state_->tree.Light(number);
  return {placed.lamp, placed.intensity, placed.candela};
}

SpectrumOf<double> LampLight::DepthTo(std::uint32_t number, const glm::dvec3& point) const {
  const PlacedLamp& placed = state_->tree.Light(number);
  SpectrumOf<double> depth = TransmittanceBetween(placed.air, placed.lamp.position_m, point);
  const bool is_lit = state_->stage.Sees(placed.lamp.position_m, point);
  for (std::size_t band = 0; band < depth.size(); ++band) {
    depth[band] = is_lit ? -std::log(depth[band]) : std::numeric_limits<double>::infinity();
  }
  return depth;
}

bool LampLight::Shades(const glm::dvec3& place, const LitPoint& at) const {
  Lamp lamp;
  lamp.position_m = place;
  return state_->stage.Shades(lamp, at.smooth_point, at.geometric_normal);
}

Spectrum LampLight::LayerTransmittance(const glm::dvec3& direction, double length_m) const {
  return state_->stage.LayerTransmittance(state_->eye.at, direction, length_m);
}

Spectrum LampLight::State::InAir(const LampNodes& lamps, const LampRayEnd& ray,
                                 double pixel_angle_rad, int nodes) const {
  Spectrum sum(stage.bands());
  for (const std::uint32_t index : lamps) {
    const PlacedLamp& placed = tree.Light(index);
    const LampAlongRay along = AlongRay(placed, ray.direction, pixel_angle_rad);
    const double reach = Reach(placed, ray.length_m);
    for (const auto& [begin, end] : PiecesLitBy(placed, stage, eye.at, ray.direction, reach)) {
      const LampSegment segment{eye.at, ray.direction, begin, end};
      sum = sum +
            Scaled(placed.intensity, Airlight(placed.air, along.lamp, segment, nodes), along.share);
    }
  }
  return sum;
}

Spectrum LampLight::InAir(const LampNodes& lamps, const LampRayEnd& ray, double pixel_angle_rad,
                          int nodes) const {
  return state_->InAir(lamps, ray, pixel_angle_rad, nodes);
}

Spectrum LampLight::InAir(const LampPlan& plan, int x, int y, const LampRayEnd& ray,
                          double pixel_angle_rad, int nodes) const {
  const LampTile& tile = plan.At(x, y);
  Spectrum sum = InAir(tile.near_air, ray, pixel_angle_rad, nodes);
  if (tile.far_air.empty()) return sum;
  const double u = (x % LampPlan::kTile + 0.5) / LampPlan::kSpacing;
  const double v = (y % LampPlan::kTile + 0.5) / LampPlan::kSpacing;
  const int i = static_cast<int>(u), j = static_cast<int>(v);
  const double p = u - i, q = v - j;
  const auto corner = static_cast<std::size_t>(j * LampPlan::kLattice + i);
  const std::array<std::size_t, 4> at{corner, corner + 1, corner + LampPlan::kLattice,
                                      corner + LampPlan::kLattice + 1};
  const std::array<double, 4> weight{(1.0 - p) * (1.0 - q), p * (1.0 - q), (1.0 - p) * q, p * q};
  // Interpolate if the rays end alike: all in the sky, or on a surface that is smooth between them.
  constexpr double kAlike = 1.15;
  const bool smooth = std::all_of(at.begin(), at.end(), [&](std::size_t k) {
    const double length = tile.lattice_length_m[k];
    return length == ray.length_m ||
           (length < kAlike * ray.length_m && ray.length_m < kAlike * length &&
            !std::isinf(length) && !std::isinf(ray.length_m));
  });
  if (!smooth) {
    const Spectrum far = InAir(tile.far_air, ray, pixel_angle_rad, nodes);
    for (std::size_t band = 0; band < sum.size(); ++band) sum[band] += far[band];
    return sum;
  }
  for (std::size_t k = 0; k < at.size(); ++k) {
    for (std::size_t band = 0; band < sum.size(); ++band) {
      sum[band] += static_cast<float>(weight[k]) * tile.lattice[at[k]][band];
    }
  }
  return sum;
}

LampNodes LampLight::FarFrom(const glm::dvec3& point) const {
  LampNodes open = state_->tree.roots(), found;
  while (!open.empty()) {
    const std::uint32_t number = open.back();
    open.pop_back();
    const LampNode& node = state_->tree.nodes()[number];
    const double distance_m = glm::length(node.light.lamp.position_m - point);
    if (!node.children || node.radius_m <= kFarCluster * distance_m) {
      found.push_back(number);
    } else {
      open.insert(open.end(), node.children->begin(), node.children->end());
    }
  }
  return found;
}

Spectrum LampLight::OnSurface(const LampNodes& lamps, const LitPoint& at) const {
  Spectrum sum(state_->stage.bands());
  for (const std::uint32_t index : lamps) {
    const PlacedLamp& placed = state_->tree.Light(index);
    const glm::dvec3 to_lamp = placed.lamp.position_m - at.point;
    const double distance = std::max(glm::length(to_lamp), placed.lamp.radius_m);
    const glm::dvec3 towards = to_lamp / distance;
    const double cosine = glm::dot(at.normal, towards);
    const LampAirlightIrradiance& glow = state_->tree.GlowOf(index);
    sum = sum + Scaled(placed.intensity,
                       glow.On(distance * towards, at.normal, state_->stage.UpAt(at.point)),
                       placed.mean_share);
    if (cosine <= 0.0) continue;
    const double relative = RelativeIntensity(placed.lamp, -towards);
    if (relative <= 0.0) continue;
    if (state_->stage.Shades(placed.lamp, at.smooth_point, at.geometric_normal)) continue;
    sum = sum + Scaled(placed.intensity,
                       TransmittanceBetween(placed.air, placed.lamp.position_m, at.point),
                       relative * cosine / (distance * distance));
  }
  return sum;
}

Spectrum LampLight::Seen(const LampNodes& lamps, const CameraRay& ray, double pixel_angle_rad,
                         const std::function<Spectrum(double)>& left) const {
  Spectrum sum(state_->stage.bands());
  for (const std::uint32_t index : lamps) {
    const PlacedLamp& placed = state_->tree.Light(index);
    if (glm::length(placed.lamp.position_m - ray.eye) <= placed.lamp.radius_m) {
      const Spectrum around = SeenFromWithin(placed, ray);
      sum = sum + (left ? left(placed.lamp.radius_m) * around : around);
      continue;
    }
    const double share = SeenPerSr(placed, state_->stage, state_->eye, ray, pixel_angle_rad) /
                         (placed.distance_m * placed.distance_m);
    if (share == 0.0) continue;
    Spectrum arriving = placed.towards_eye;
    if (left) arriving = left(placed.distance_m) * arriving;
    sum = sum + static_cast<float>(share) * arriving;
  }
  return sum;
}

LampPlan LampLight::PlanFor(const MovingCamera& camera, int width, int height,
                            const LampSettings& settings, const RayTrace& trace) const {
  LampPlan plan;
  plan.columns = (width + LampPlan::kTile - 1) / LampPlan::kTile;
  const int rows = (height + LampPlan::kTile - 1) / LampPlan::kTile;
  plan.tiles.resize(static_cast<std::size_t>(plan.columns) * static_cast<std::size_t>(rows));
  if (state_->tree.nodes().empty()) return plan;
  tbb::parallel_for(0, static_cast<int>(plan.tiles.size()), [&](int number) {
    if (Interrupted()) return;
    const int x0 = number % plan.columns * LampPlan::kTile;
    const int y0 = number / plan.columns * LampPlan::kTile;
    plan.tiles[static_cast<std::size_t>(number)] = state_->TileAt(
        camera,
        {x0, y0, std::min(x0 + LampPlan::kTile, width), std::min(y0 + LampPlan::kTile, height)},
        settings, trace);
  });
  return plan;
}

LampNodes LampLight::State::SeenIn(const TileRays& rays) const {
  LampNodes seen;
  for (std::uint32_t i = 0; i < tree.lamps(); ++i) {
    const PlacedLamp& lamp = tree.Light(i);
    const double reach = rays.radius_rad + lamp.blur + lamp.lamp.radius_m / lamp.distance_m;
    if (lamp.HoldsEye() || glm::length(lamp.direction - rays.middle()) < reach) seen.push_back(i);
  }
  return seen;
}

LampTile LampLight::State::TileAt(const MovingCamera& camera, const PixelBox& box,
                                  const LampSettings& settings, const RayTrace& trace) const {
  const double pixel = camera.middle().PixelAngle();
  const TileRays rays(camera, box, trace);
  LampTile tile;
  for (const std::uint32_t node : CutInAir(tree, stage, rays, eye.at, pixel, settings)) {
    (IsFar(tree.nodes()[node], rays, pixel) ? tile.far_air : tile.near_air).push_back(node);
  }
  tile.surface = CutOnSurface(tree, stage, rays, settings);
  tile.seen = SeenIn(rays);
  if (tile.far_air.empty()) return tile;
  for (int j = 0; j < LampPlan::kLattice; ++j) {
    for (int i = 0; i < LampPlan::kLattice; ++i) {
      const CameraRay ray = camera.middle().MiddleRay(box.x0 + LampPlan::kSpacing * i,
                                                      box.y0 + LampPlan::kSpacing * j);
      const LampRayEnd end{ray.direction, trace(ray)};
      tile.lattice.push_back(InAir(tile.far_air, end, pixel, settings.nodes));
      tile.lattice_length_m.push_back(
          AllLit(tile.far_air, end) ? end.length_m : std::numeric_limits<double>::quiet_NaN());
    }
  }
  return tile;
}

bool LampLight::State::AllLit(const LampNodes& members, const LampRayEnd& ray) const {
  return std::all_of(members.begin(), members.end(), [&](std::uint32_t i) {
    const double reach = Reach(tree.Light(i), ray.length_m);
    const auto pieces = PiecesLitBy(tree.Light(i), stage, eye.at, ray.direction, reach);
    return pieces.size() == 1 && pieces[0][0] == 0.0 && pieces[0][1] == reach;
  });
}

}  // namespace alpenglow::renderer
