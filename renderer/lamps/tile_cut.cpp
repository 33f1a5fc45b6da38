// SPDX-License-Identifier: MIT
#include "renderer/lamps/tile_cut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <queue>
#include <unordered_map>

#include "atmosphere/lamp/airlight.h"
#include "atmosphere/math/constants.h"
#include "renderer/lamps/placed_lamp.h"

namespace alpenglow::renderer {

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
  constexpr std::size_t kMostEnds = 5;
  if (ends.size() < kMostEnds) ends.push_back({point, ray.direction});
  surface_spread_m = std::max(surface_spread_m, glm::length(point - ends[0].point));
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

/// Contribution of a node to a tile [cd/m^2].
struct Share {
  std::uint32_t node;
  double least;  // lower bound over the tile
  double most;   // upper bound over the tile
  double error;  // of using the node instead of the lamps below it, anywhere in the tile

  bool operator<(const Share& other) const {
    return error != other.error ? error < other.error : node < other.node;
  }
};

/// Returns the nodes that a tile's error allows: cuts the tree from the roots down, and leaves out
/// the dimmest.
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

/// Returns the lamps below a node: all if they are few, else one of every branch.
LampNodes MembersOf(const LampTree& tree, std::uint32_t number) {
  constexpr std::size_t kBranches = 8;
  const std::vector<LampNode>& nodes = tree.nodes();
  LampNodes members{number};
  for (std::size_t before = 0; members.size() != before && members.size() < kBranches;) {
    before = members.size();
    LampNodes below;
    for (const std::uint32_t member : members) {
      if (const auto& children = nodes[member].children) {
        below.insert(below.end(), children->begin(), children->end());
      } else {
        below.push_back(member);
      }
    }
    members = std::move(below);
  }
  for (std::uint32_t& member : members) {
    while (nodes[member].children) member = (*nodes[member].children)[0];
  }
  return members;
}

/// Returns whether terrain hides a node from the air in front of a tile in the same way as the
/// lamps below it. Tests points of three rays, at equal angles seen from the node.
bool IsHiddenAsItsLamps(const LampTree& tree, const LampStage& stage, std::uint32_t number,
                        const TileRays& tile, const glm::dvec3& eye) {
  constexpr int kPoints = 6;
  const LampNodes members = MembersOf(tree, number);
  // Without terrain, only the planet can hide lamps.
  const auto sees_eye = [&](std::uint32_t lamp) {
    return stage.Sees(tree.Light(lamp).lamp.position_m, eye);
  };
  if (!stage.ground().terrain && sees_eye(number) &&
      std::all_of(members.begin(), members.end(), sees_eye))
    return true;
  const PlacedLamp& light = tree.Light(number);
  for (const std::size_t corner : {0UL, 1UL, 4UL}) {
    const LampRayEnd& ray = tile.rays[corner];
    const double nearest = light.distance_m * glm::dot(light.direction, ray.direction);
    const double approach =
        std::max(light.distance_m * glm::length(glm::cross(light.direction, ray.direction)), 1.0);
    const double low = std::atan2(-nearest, approach);
    const double high = std::atan2(Reach(light, ray.length_m) - nearest, approach);
    for (int i = 0; i < kPoints; ++i) {
      const double angle = low + (high - low) * (i + 0.5) / kPoints;
      const double t = std::max(nearest + approach * std::tan(angle), 0.0);
      const glm::dvec3 point = eye + t * ray.direction;
      const auto sees = [&](std::uint32_t lamp) {
        return stage.Sees(tree.Light(lamp).lamp.position_m, point);
      };
      const bool is_lit = sees(number);
      const bool as_all = std::all_of(members.begin(), members.end(),
                                      [&](std::uint32_t member) { return sees(member) == is_lit; });
      if (!as_all) return false;
    }
  }
  return true;
}

/// Returns the contribution of a node's light in the air to a tile.
Share WeighInAir(const LampTree& tree, const LampStage& stage, std::uint32_t number,
                 const TileRays& tile, const glm::dvec3& eye, double pixel_angle_rad) {
  constexpr int kScoutNodes = 4;
  constexpr double kRefine = 10.0;
  const LampNode& node = tree.nodes()[number];
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
  // One of the lamps below may be closer to the ray than the centre of all, and light in the air
  // decreases with this distance.
  share.most *= std::max(d / std::max(d - node.radius_m, bright.radius_m), 1.0);
  const double gap = tile.GapTo(ahead);
  // Second order in the lamps' places: 1/D across the ray, and extinction and the ray's end along
  // it.
  const double relative = std::max(spread_across, 0.0) / (d * d) +
                          spread_along * (2.0 * node.extinction_per_m * node.extinction_per_m +
                                          1.0 / (d * d + gap * gap));
  const bool is_one = d > 2.0 * node.radius_m && IsHiddenAsItsLamps(tree, stage, number, tile, eye);
  share.error = share.most * (is_one ? std::min(relative, kRefine) : kRefine);
  return share;
}

/// A place of a surface that lamps may light.
struct TilePlace {
  glm::dvec3 point, normal;  // shading normal
  glm::dvec3 smooth_point, geometric_normal;
};

/// Returns the places where a tile's rays end.
std::vector<TilePlace> PlacesOf(const TileRays& tile, const LampStage& stage) {
  constexpr double kBack_m = 0.5;  // step back, to hit the surface again and get its normal
  std::vector<TilePlace> places;
  for (const TileRays::End& end : tile.ends) {
    const auto& terrain = stage.ground().terrain;
    const auto hit = terrain
                         ? terrain->Intersect(end.point - kBack_m * end.direction, end.direction)
                         : std::nullopt;
    if (hit && hit->distance_m < 2.0 * kBack_m) {
      places.push_back({end.point, hit->normal, hit->smooth_point, hit->geometric_normal});
    } else {
      const glm::dvec3 up = stage.UpAt(end.point);
      places.push_back({end.point, up, end.point, up});
    }
  }
  return places;
}

/// Contributions of nodes to the surfaces of a tile, as if these reflected all light. The upper
/// bound assumes that they face the node; the lower bound uses their orientation to the node and to
/// its beam at the sampled places. Where terrain hides a lamp, only its glow remains.
class SurfaceWeights {
 public:
  SurfaceWeights(const LampTree& tree, const LampStage& stage, const TileRays& tile)
      : tree_(&tree), stage_(&stage), tile_(&tile), places_(PlacesOf(tile, stage)) {}

  [[nodiscard]] Share Of(std::uint32_t number);

 private:
  /// Bit i stands for place i.
  using LitPlaces = std::uint32_t;
  [[nodiscard]] LitPlaces AllPlaces() const { return (LitPlaces{1} << places_.size()) - 1; }

  /// Returns the places from which a node's own place is visible.
  [[nodiscard]] LitPlaces LitBy(std::uint32_t number);
  /// Says whether a node and its lamps light every place, or none. If neither holds, shadow edges
  /// cross the tile, at a different position for every lamp.
  struct Shade {
    bool is_lit, is_dark;
  };
  [[nodiscard]] Shade ShadeOf(std::uint32_t number);
  /// Returns the contribution of the air lit by a node, on level ground at the first place
  /// [cd/m^2].
  [[nodiscard]] double GlowOf(std::uint32_t number) const;
  /// Returns a lower bound of the light that a surface oriented like any of the places receives
  /// from a node, relative to a surface facing the lamp in its brightest direction. It is at most
  /// kMostRelied, because ground between the places may face away.
  [[nodiscard]] double FacingOf(std::uint32_t number) const;

  const LampTree* tree_;
  const LampStage* stage_;
  const TileRays* tile_;
  std::vector<TilePlace> places_;
  std::unordered_map<std::uint32_t, LitPlaces> lit_;
};

SurfaceWeights::LitPlaces SurfaceWeights::LitBy(std::uint32_t number) {
  const auto [found, is_new] = lit_.try_emplace(number, 0);
  if (!is_new) return found->second;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const TilePlace& place = places_[i];
    const bool is_shaded =
        stage_->Shades(tree_->Light(number).lamp, place.smooth_point, place.geometric_normal);
    if (!is_shaded) found->second |= LitPlaces{1} << i;
  }
  return found->second;
}

SurfaceWeights::Shade SurfaceWeights::ShadeOf(std::uint32_t number) {
  LitPlaces lit_by_any = LitBy(number), lit_by_all = lit_by_any;
  for (const std::uint32_t member : MembersOf(*tree_, number)) {
    lit_by_any |= LitBy(member);
    lit_by_all &= LitBy(member);
  }
  return {lit_by_all == AllPlaces(), lit_by_any == 0};
}

double SurfaceWeights::GlowOf(std::uint32_t number) const {
  const PlacedLamp& light = tree_->Light(number);
  const glm::dvec3& point = tile_->ends[0].point;
  const glm::dvec3 up = stage_->UpAt(point);
  const SpectrumOf<double> glow = tree_->GlowOf(number).On(light.lamp.position_m - point, up, up);
  return light.candela * light.mean_share * glow[glow.size() / 2] / kPi;
}

double SurfaceWeights::FacingOf(std::uint32_t number) const {
  constexpr double kMostRelied = 0.1, kBetween = 0.5;
  const Lamp& lamp = tree_->Light(number).lamp;
  double least = kMostRelied / kBetween;
  for (const TilePlace& place : places_) {
    const glm::dvec3 way = lamp.position_m - place.point;
    const glm::dvec3 towards = way / std::max(glm::length(way), 1e-9);
    const double cosine = std::max(glm::dot(place.normal, towards), 0.0);
    least = std::min(least, cosine * RelativeIntensity(lamp, -towards));
  }
  return kBetween * least;
}

Share SurfaceWeights::Of(std::uint32_t number) {
  constexpr double kWall = 0.5;  // fraction of a glow that remains on a steep surface
  const LampNode& node = tree_->nodes()[number];
  const PlacedLamp& light = node.light;
  const glm::dvec3& surface = tile_->ends[0].point;
  const double middle = glm::length(surface - light.lamp.position_m);
  const double d = std::max(middle - tile_->surface_spread_m, 0.3);
  const double far = middle + tile_->surface_spread_m + 0.3;
  const double t = TransmittanceBetween(light.middle_air, light.lamp.position_m, surface)[0];
  const double luminance = light.candela * t / kPi;
  const double glow = GlowOf(number);
  const auto [is_lit, is_dark] = ShadeOf(number);
  Share share{number, kWall * glow, glow, 0.0};
  if (is_lit) share.least += FacingOf(number) * luminance / (far * far);
  if (!is_dark) share.most += luminance / (d * d);
  if (!node.children) return share;
  const double relative = (node.moments[0][0] + node.moments[1][1] + node.moments[2][2]) / (d * d);
  share.error = share.most * ((is_lit || is_dark) && d > 2.0 * node.radius_m ? relative : 10.0);
  return share;
}

}  // namespace

LampNodes CutInAir(const LampTree& tree, const LampStage& stage, const TileRays& tile,
                   const glm::dvec3& eye, double pixel_angle_rad, const LampSettings& settings) {
  return Cut(tree, settings, [&](std::uint32_t node) {
    return WeighInAir(tree, stage, node, tile, eye, pixel_angle_rad);
  });
}

LampNodes CutOnSurface(const LampTree& tree, const LampStage& stage, const TileRays& tile,
                       const LampSettings& settings) {
  if (tile.ends.empty()) return {};
  SurfaceWeights weights(tree, stage, tile);
  return Cut(tree, settings, [&](std::uint32_t node) { return weights.Of(node); });
}

bool IsFar(const LampNode& node, const TileRays& tile, double pixel_angle_rad) {
  constexpr double kSteps = 7.0;
  const double apart = glm::length(node.light.direction - tile.middle());
  return node.light.lamp.profile.kind == LampProfile::Kind::kIsotropic &&
         apart - tile.radius_rad > kSteps * LampPlan::kSpacing * pixel_angle_rad;
}

}  // namespace alpenglow::renderer
