// SPDX-License-Identifier: MIT
#include "renderer/lamp/tile_cut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <queue>

#include "atmosphere/lamp/airlight.h"
#include "atmosphere/number/constants.h"

namespace alpenglow {

TileRays::TileRays(const MovingCamera& moving, const PixelBox& box, const RayTrace& trace) {
  constexpr int kMoreRays = 8;
  const std::array<std::array<double, 2>, 5> points{
      {{0.5 * (box.x0 + box.x1), 0.5 * (box.y0 + box.y1)},
       {box.x0 + 0.5, box.y0 + 0.5},
       {box.x1 - 0.5, box.y0 + 0.5},
       {box.x0 + 0.5, box.y1 - 0.5},
       {box.x1 - 0.5, box.y1 - 0.5}}};
  const CameraRays& camera = moving.middle();
  for (const auto& [x, y] : points) {
    Add(camera.MiddleRay(x, y), trace);
    radius_rad = std::max(radius_rad, glm::length(rays.back().direction - middle()));
  }
  for (const auto& [x, y] : points) {
    for (int i = 0; (moving.IsMoving() || camera.HasLens()) && i < kMoreRays; ++i) {
      const double time = i / (kMoreRays - 1.0);
      const CameraRay ray =
          moving.Ray(x, y, {(i + 0.5) / kMoreRays, i % 2 == 0 ? 0.95 : 0.4}, time);
      Add(ray, trace);
      radius_rad = std::max(radius_rad, glm::length(ray.through - middle()));
    }
  }
  radius_rad += 2.0 * camera.PixelAngle();
}

void TileRays::Add(const CameraRay& ray, const RayTrace& trace) {
  rays.push_back({ray.direction, trace(ray)});
  const double length = rays.back().length_m;
  if (std::isinf(length)) return;
  const glm::dvec3 point = ray.origin + length * ray.direction;
  if (!surface) surface = point;
  surface_spread_m = std::max(surface_spread_m, glm::length(point - *surface));
}

double TileRays::longest() const {
  double most = 0.0;
  for (const LampRayEnd& ray : rays) most = std::max(most, ray.length_m);
  return most;
}

double TileRays::shortest() const {
  double least = std::numeric_limits<double>::infinity();
  for (const LampRayEnd& ray : rays) least = std::min(least, ray.length_m);
  return least;
}

double TileRays::GapTo(double distance_m) const {
  double least = std::numeric_limits<double>::infinity();
  for (const LampRayEnd& ray : rays) {
    least = std::min(least, std::abs(ray.length_m - distance_m));
  }
  return least;
}

glm::dvec3 TileRays::Nearest(const glm::dvec3& to_lamp) const {
  const double apart = glm::length(to_lamp - middle());
  if (apart <= radius_rad) return to_lamp;
  return glm::normalize(middle() + (to_lamp - middle()) * (radius_rad / apart));
}

glm::dvec3 TileRays::Farthest(const glm::dvec3& to_lamp) const {
  const double apart = std::max(glm::length(to_lamp - middle()), 1e-9);
  return glm::normalize(middle() - (to_lamp - middle()) * (radius_rad / apart));
}

namespace {

/// A node as a tile sees it [cd/m^2].
struct Share {
  std::uint32_t node;
  double least;  // anywhere in the tile
  double most;   // anywhere in the tile
  double error;  // of taking the node for the lamps below it, anywhere in the tile

  bool operator<(const Share& other) const {
    return error != other.error ? error < other.error : node < other.node;
  }
};

/// Nodes that a tile's error allows: cut from the roots down, the dimmest left out.
template <typename Weigh>
LampNodes Cut(const LampTree& tree, const LampSettings& settings, const Weigh& weigh) {
  std::priority_queue<Share> open;
  double least = 0.0, error = 0.0;
  const auto add = [&](std::uint32_t node) {
    const Share share = weigh(node);
    least += share.least;
    error += share.error;
    open.push(share);
  };
  for (const std::uint32_t root : tree.roots()) add(root);
  const auto budget = [&] {
    return std::max(0.5 * settings.share_of_error * least, 0.5 * settings.floor_cd_per_m2);
  };
  while (!open.empty() && open.top().error > 0.0 && error > budget()) {
    const Share worst = open.top();
    open.pop();
    least -= worst.least;
    error -= worst.error;
    for (const std::uint32_t child : tree.nodes()[worst.node].children.value()) add(child);
  }
  std::vector<Share> cut;
  for (; !open.empty(); open.pop()) cut.push_back(open.top());
  std::sort(cut.begin(), cut.end(), [](const Share& a, const Share& b) {
    return a.most != b.most ? a.most < b.most : a.node < b.node;
  });
  LampNodes kept;
  double dropped = 0.0;
  for (const Share& share : cut) {
    dropped += share.most;
    if (dropped > budget()) kept.push_back(share.node);
  }
  std::sort(kept.begin(), kept.end());
  return kept;
}

/// What a node's light in the air is to a tile.
Share WeighInAir(const LampNode& node, std::uint32_t number, const TileRays& tile,
                 const glm::dvec3& eye, double pixel_angle_rad) {
  constexpr int kScoutNodes = 4;
  constexpr double kRefine = 10.0;
  const PlacedLamp& light = node.light;
  const auto along = [&](const Lamp& lamp, const glm::dvec3& direction, double length) {
    const LampSegment segment{eye, direction, 0.0, std::min(length, 4.0 * light.distance_m + 20e3)};
    return light.candela * Airlight(light.middle_air, lamp, segment, kScoutNodes)[0];
  };
  const glm::dvec3 farthest = tile.Farthest(light.direction);
  const LampAlongRay dim = AlongRay(light, farthest, pixel_angle_rad);
  Share share{number, dim.share * along(dim.lamp, farthest, tile.shortest()), 0.0, 0.0};
  Lamp bright = dim.lamp;
  bright.profile = {};  // as if its beam pointed everywhere
  const glm::dvec3 nearest = tile.Nearest(light.direction);
  share.most = along(bright, nearest, tile.longest());
  if (!node.children) return share;
  const double ahead = light.distance_m * glm::dot(nearest, light.direction);
  const double across = light.distance_m * glm::length(glm::cross(nearest, light.direction));
  const double d = ahead > 0.0 ? across : light.distance_m;
  const double spread_along = glm::dot(nearest, node.moments * nearest);
  const double spread_across =
      node.moments[0][0] + node.moments[1][1] + node.moments[2][2] - spread_along;
  // One of the lamps below may be nearer to the ray than the middle of all, and light in the air
  // falls with that distance.
  share.most *= std::max(d / std::max(d - node.radius_m, bright.radius_m), 1.0);
  const double gap = tile.GapTo(ahead);
  // Second order in the lamps' places: 1/D across the ray, extinction and the ray's end along it.
  const double relative = std::max(spread_across, 0.0) / (d * d) +
                          spread_along * (2.0 * node.extinction_per_m * node.extinction_per_m +
                                          1.0 / (d * d + gap * gap));
  share.error = share.most * (d > 2.0 * node.radius_m ? std::min(relative, kRefine) : kRefine);
  return share;
}

/// What a node is to the surfaces of a tile, if they faced it and reflected everything.
Share WeighOnSurface(const LampNode& node, std::uint32_t number, const TileRays& tile) {
  const PlacedLamp& light = node.light;
  const double middle = glm::length(*tile.surface - light.lamp.position_m);
  const double d = std::max(middle - tile.surface_spread_m, 0.3);
  const double far = middle + tile.surface_spread_m + 0.3;
  const double t = TransmittanceBetween(light.middle_air, light.lamp.position_m, *tile.surface)[0];
  const double luminance = light.candela * t / kPi;
  Share share{number, 0.1 * light.mean_share * luminance / (far * far), luminance / (d * d), 0.0};
  if (!node.children) return share;
  const double relative = (node.moments[0][0] + node.moments[1][1] + node.moments[2][2]) / (d * d);
  share.error = share.most * (d > 2.0 * node.radius_m ? relative : 10.0);
  return share;
}

}  // namespace

LampNodes CutInAir(const LampTree& tree, const TileRays& tile, const glm::dvec3& eye,
                   double pixel_angle_rad, const LampSettings& settings) {
  return Cut(tree, settings, [&](std::uint32_t node) {
    return WeighInAir(tree.nodes()[node], node, tile, eye, pixel_angle_rad);
  });
}

LampNodes CutOnSurface(const LampTree& tree, const TileRays& tile, const LampSettings& settings) {
  if (!tile.surface) return {};
  return Cut(tree, settings,
             [&](std::uint32_t node) { return WeighOnSurface(tree.nodes()[node], node, tile); });
}

bool IsFar(const LampNode& node, const TileRays& tile, double pixel_angle_rad) {
  constexpr double kSteps = 7.0;
  const double apart = glm::length(node.light.direction - tile.middle());
  return node.light.lamp.profile.kind == LampProfile::Kind::kIsotropic &&
         apart - tile.radius_rad > kSteps * LampPlan::kSpacing * pixel_angle_rad;
}

}  // namespace alpenglow
