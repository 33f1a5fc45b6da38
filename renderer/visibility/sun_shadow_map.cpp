// SPDX-License-Identifier: MIT
#include "renderer/visibility/sun_shadow_map.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "lut/camera_tables/air_tables.h"

namespace alpenglow::renderer {
namespace {

constexpr double kLowestMappedSun_rad = -3.0 * kRadiansPerDegree;
constexpr double kHighestMappedSun_rad = 80.0 * kRadiansPerDegree;

// Height below any shadow. It is finite because maps are interpolated.
constexpr float kNoShade_m = -1e5F;
// A shadow counts if it reaches this far above the ground. Smaller values are interpolation errors.
constexpr float kLeastShade_m = 0.5F;

/// Heights at even steps along a line, interpolated between the nodes of a raster.
class Profile {
 public:
  Profile(const HeightRaster& raster, const glm::dvec2& first, const glm::dvec2& step)
      : raster_(raster),
        x_(static_cast<float>((first.x - raster.first_x_m) / raster.cell_m)),
        y_(static_cast<float>((first.y - raster.first_y_m) / raster.cell_m)),
        dx_(static_cast<float>(step.x / raster.cell_m)),
        dy_(static_cast<float>(step.y / raster.cell_m)) {}

  [[nodiscard]] float At(int i) const {
    const float x = x_ + static_cast<float>(i) * dx_, y = y_ + static_cast<float>(i) * dy_;
    if (!(x >= 0.0F && y >= 0.0F && x < static_cast<float>(raster_.columns - 1) &&
          y < static_cast<float>(raster_.rows - 1)))
      return HeightRaster::kNothing;
    const int column = static_cast<int>(x), row = static_cast<int>(y);
    const float along = x - static_cast<float>(column), across = y - static_cast<float>(row);
    const float* low = &raster_.z_m[raster_.index(column, row)];
    const float* high = low + raster_.columns;
    const float at_low = low[0] + along * (low[1] - low[0]);
    return at_low + across * (high[0] + along * (high[1] - high[0]) - at_low);
  }

 private:
  const HeightRaster& raster_;
  float x_, y_, dx_, dy_;
};

void Widen(SunShadowMap& map, double u_m, double v_m, double height_m) {
  map.low_u_m = std::min(map.low_u_m, u_m - map.cell_m);
  map.high_u_m = std::max(map.high_u_m, u_m + map.cell_m);
  map.low_v_m = std::min(map.low_v_m, v_m - map.cell_m);
  map.high_v_m = std::max(map.high_v_m, v_m + map.cell_m);
  map.ceiling_m = std::max(map.ceiling_m, height_m);
}

float LowestOf(const HeightRaster& heights) {
  float lowest_m = std::numeric_limits<float>::infinity();
  for (const float z_m : heights.z_m)
    lowest_m = z_m > kNoShade_m ? std::min(lowest_m, z_m) : lowest_m;
  return lowest_m;
}

// Returns a map whose nodes cover the raster, without heights.
SunShadowMap EmptyMap(const HeightRaster& heights, const glm::dvec3& to_light, int most_side) {
  SunShadowMap map;
  map.to_light = to_light;
  const double flat = std::hypot(to_light.x, to_light.y);
  map.sunwards = glm::dvec3(to_light.x, to_light.y, 0.0) / flat;
  map.across = {-map.sunwards.y, map.sunwards.x, 0.0};
  const double infinity = std::numeric_limits<double>::infinity();
  glm::dvec2 low(infinity), high(-infinity);
  for (const int column : {0, heights.columns - 1}) {
    for (const int row : {0, heights.rows - 1}) {
      const auto [x, y] = heights.Place(column, row);
      const glm::dvec2 corner(x * map.sunwards.x + y * map.sunwards.y,
                              x * map.across.x + y * map.across.y);
      low = glm::dvec2(std::min(low.x, corner.x), std::min(low.y, corner.y));
      high = glm::dvec2(std::max(high.x, corner.x), std::max(high.y, corner.y));
    }
  }
  const double extent = std::max(high.x - low.x, high.y - low.y);
  map.cell_m = std::max(heights.cell_m, extent / (most_side - 1));
  map.first_u_m = low.x;
  map.first_v_m = low.y;
  map.columns = OffPowersOfTwo(static_cast<int>(std::ceil((high.x - low.x) / map.cell_m)) + 1);
  map.lines = OffPowersOfTwo(static_cast<int>(std::ceil((high.y - low.y) / map.cell_m)) + 1);
  map.low_u_m = map.low_v_m = infinity;
  map.high_u_m = map.high_v_m = map.ceiling_m = -infinity;
  return map;
}

/// The inputs that all lines share.
struct LineSweep {
  const HeightRaster& heights;
  float lowest_m;
  int steps;                    // per cell along u; a crest is found to half a step
  std::array<float, 3> fall_m;  // descent of each beam per step

  void Line(int line, SunShadowMap& map) const;
};

// Sweeps one line, starting on the side of the sun.
void LineSweep::Line(int line, SunShadowMap& map) const {
  const double v_m = map.first_v_m + map.cell_m * line;
  const glm::dvec3 first = map.first_u_m * map.sunwards + v_m * map.across;
  const glm::dvec3 step = map.cell_m / steps * map.sunwards;
  const Profile profile(heights, glm::dvec2(first), glm::dvec2(step));
  glm::vec2* nodes =
      &map.height[static_cast<std::size_t>(line) * static_cast<std::size_t>(map.columns)];
  std::array<float, 3> shade_m;  // beams from the bottom, middle and top of the disk
  shade_m.fill(kNoShade_m);
  for (int i = (map.columns - 1) * steps; i >= 0; --i) {
    const float ground_m = profile.At(i);
    for (std::size_t beam = 0; beam < 3; ++beam)
      shade_m[beam] = std::max(shade_m[beam] - fall_m[beam], ground_m);
    if (i % steps != 0) continue;
    const auto [bottom, middle, top] = shade_m;
    nodes[i / steps] = {middle, 0.5F * (bottom - top)};
    if (bottom < std::max(ground_m, lowest_m) + kLeastShade_m) continue;
    Widen(map, map.first_u_m + map.cell_m * (i / steps), v_m, double{bottom});
  }
}

// Extends the box of the map to where shadows at the first node reach the lowest ground.
void GoOnBeyond(float lowest_m, SunShadowMap& map) {
  constexpr double kFarthest_m = 300e3;
  float highest_m = lowest_m;
  for (int line = 0; line < map.lines; ++line) {
    const glm::vec2& first = map.at(0, line);
    highest_m = std::max(highest_m, first.x + first.y);
  }
  const double over_m = static_cast<double>(highest_m) - static_cast<double>(lowest_m);
  if (over_m <= 0.0) return;
  map.low_u_m = map.first_u_m - std::min(over_m / std::max(map.tangent, 1e-9), kFarthest_m);
}

}  // namespace

SunShadowMap SunShadowMapOf(const HeightRaster& heights, const glm::dvec3& to_light,
                            double radius_rad, int most_side) {
  ALPENGLOW_ENSURE(std::abs(glm::length(to_light) - 1.0), <, 1e-6);
  ALPENGLOW_ENSURE(most_side, >=, 2);
  const double elevation = std::asin(std::clamp(to_light.z, -1.0, 1.0));
  if (elevation < kLowestMappedSun_rad || elevation > kHighestMappedSun_rad || heights.z_m.empty())
    return {};
  SunShadowMap map = EmptyMap(heights, to_light, most_side);
  map.height.resize(static_cast<std::size_t>(map.columns) * static_cast<std::size_t>(map.lines));
  // At least two steps per cell of the map, and at least one per cell of the heights.
  const int steps = std::max(2, static_cast<int>(std::lround(map.cell_m / heights.cell_m)));
  LineSweep sweep{heights, LowestOf(heights), steps, {}};
  for (std::size_t beam = 0; beam < 3; ++beam) {
    const double at = elevation + (static_cast<double>(beam) - 1.0) * radius_rad;
    sweep.fall_m[beam] = static_cast<float>(map.cell_m / steps * std::tan(at));
  }
  for (int line = 0; line < map.lines; ++line) sweep.Line(line, map);
  if (!(map.low_u_m < map.high_u_m)) return {};
  map.tangent = std::tan(elevation);
  map.floor_m = static_cast<double>(sweep.lowest_m);
  GoOnBeyond(sweep.lowest_m, map);
  return map;
}

}  // namespace alpenglow::renderer
