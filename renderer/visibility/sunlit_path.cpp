// SPDX-License-Identifier: MIT
#include "renderer/visibility/sunlit_path.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/base/error.h"

namespace alpenglow::renderer {

double SunlightOverEdge(double x) {
  if (x >= 1.0) return 1.0;
  if (x <= -1.0) return 0.0;
  return shared::SunlightOverEdge(x);
}

double SunlightAt(const SunlitPath& path, double distance_m) {
  for (const SunlitPiece& piece : path) {
    if (distance_m < piece.begin_m || distance_m > piece.end_m) continue;
    if (piece.begin_x == piece.end_x) return SunlightOverEdge(piece.begin_x);
    const double share = (distance_m - piece.begin_m) / piece.length_m();
    return SunlightOverEdge(piece.begin_x + share * (piece.end_x - piece.begin_x));
  }
  return 0.0;
}

void SunlitPathBuilder::Add(const SunlitPiece& piece) {
  if (!(piece.begin_m < piece.end_m)) return;
  const double begin_x = std::clamp(piece.begin_x, -1.0, 1.0);
  const double end_x = std::clamp(piece.end_x, -1.0, 1.0);
  if (begin_x <= -1.0 && end_x <= -1.0) {
    Close();
    return;
  }
  Extend({piece.begin_m, piece.end_m, begin_x, end_x});
}

void SunlitPathBuilder::Extend(const SunlitPiece& piece) {
  const auto is_full = [](const SunlitPiece& p) { return p.begin_x >= 1.0 && p.end_x >= 1.0; };
  const bool touches = open_ && open_->end_m == piece.begin_m &&
                       std::abs(open_->end_x - piece.begin_x) <= kTolerance &&
                       is_full(*open_) == is_full(piece);
  const double begin_m = touches ? open_->begin_m : piece.begin_m;
  const double begin_x = touches ? open_->begin_x : piece.begin_x;
  const double slope = (piece.end_x - begin_x) / (piece.end_m - begin_m);
  const double play = kTolerance / (piece.end_m - begin_m);
  if (touches && slope >= least_slope_ && slope <= most_slope_) {
    open_->end_m = piece.end_m;
    open_->end_x = piece.end_x;
    least_slope_ = std::max(least_slope_, slope - play);
    most_slope_ = std::min(most_slope_, slope + play);
    return;
  }
  Close();
  open_ = piece;
  const double own_slope = (piece.end_x - piece.begin_x) / piece.length_m();
  const double own_play = kTolerance / piece.length_m();
  least_slope_ = own_slope - own_play;
  most_slope_ = own_slope + own_play;
}

void SunlitPathBuilder::Close() {
  if (open_) path_.push_back(*open_);
  open_.reset();
}

SunlitPath SunlitPathBuilder::Take() {
  Close();
  return std::exchange(path_, {});
}

namespace {

constexpr int kHalvings = 6;

// Returns the distance at which `lit` changes, between two distances where it differs.
template <typename Lit>
double Edge(double lit_m, double dark_m, const Lit& lit) {
  for (int step = 0; step < kHalvings; ++step) {
    const double middle = 0.5 * (lit_m + dark_m);
    (lit(middle) ? lit_m : dark_m) = middle;
  }
  return 0.5 * (lit_m + dark_m);
}

}  // namespace

SunProbes::SunProbes(const Terrain& terrain, const glm::dvec3& to_light, double radius_rad,
                     int probes)
    : terrain_(terrain), to_light_(to_light), probes_(probes) {
  ALPENGLOW_ENSURE(probes, >=, 2);
  const double flat = std::hypot(to_light.x, to_light.y);
  sunwards_ =
      flat > 0.0 ? glm::dvec3(to_light.x, to_light.y, 0.0) / flat : glm::dvec3(1.0, 0.0, 0.0);
  across_ = {-sunwards_.y, sunwards_.x, 0.0};
  upwards_ = glm::dvec3(0.0, 0.0, flat) - to_light.z * sunwards_;
  bottom_of_sun_ = glm::normalize(to_light - std::tan(radius_rad) * upwards_);
  highest_c_m_ = u_high_m_ = v_high_m_ = -std::numeric_limits<double>::infinity();
  v_low_m_ = std::numeric_limits<double>::infinity();
  const glm::dvec3 above_bottom =
      glm::normalize(upwards_ + std::tan(radius_rad) * to_light);  // normal to the lowest beams
  for (const auto& position : terrain.mesh().positions) {
    const glm::dvec3 p = ToDouble(position);
    highest_c_m_ = std::max(highest_c_m_, glm::dot(p, above_bottom));
    u_high_m_ = std::max(u_high_m_, glm::dot(p, sunwards_));
    v_low_m_ = std::min(v_low_m_, glm::dot(p, across_));
    v_high_m_ = std::max(v_high_m_, glm::dot(p, across_));
  }
  upwards_ = above_bottom;
}

SunProbes::Stretch SunProbes::WithinTheShadowOfTheBox(const glm::dvec3& origin,
                                                      const glm::dvec3& unit,
                                                      double length_m) const {
  Stretch stretch{0.0, length_m};
  const auto keep_below = [&](const glm::dvec3& axis, double most) {
    const double room = most - glm::dot(origin, axis);
    const double rate = glm::dot(unit, axis);
    if (rate > 0.0) {
      stretch.end_m = std::min(stretch.end_m, room / rate);
    } else if (rate < 0.0) {
      stretch.begin_m = std::max(stretch.begin_m, room / rate);
    } else if (room < 0.0) {
      stretch.end_m = -1.0;
    }
  };
  keep_below(upwards_, highest_c_m_);
  keep_below(sunwards_, u_high_m_);
  keep_below(across_, v_high_m_);
  keep_below(-across_, -v_low_m_);
  return stretch;
}

double SunProbes::SunlightAt(const glm::dvec3& point) const {
  const auto sees = [&](const glm::dvec3& to) {
    return !terrain_.Occluded(point, to, to, std::numeric_limits<double>::infinity());
  };
  const glm::dvec3 top_of_sun =
      2.0 * glm::dot(bottom_of_sun_, to_light_) * to_light_ - bottom_of_sun_;
  // Half of the light passes when the edge is in the middle.
  if (sees(bottom_of_sun_)) return sees(to_light_) ? 1.0 : 0.5;
  if (sees(to_light_)) return 0.75;
  return sees(top_of_sun) ? 0.25 : 0.0;
}

SunlitPath SunProbes::Along(const glm::dvec3& origin, const glm::dvec3& unit,
                            double length_m) const {
  if (!(length_m > 0.0)) return {};
  const Stretch near = WithinTheShadowOfTheBox(origin, unit, length_m);
  if (!(near.begin_m < near.end_m)) return {{0.0, length_m}};
  const auto sees = [&](double distance_m, const glm::dvec3& to) {
    return !terrain_.Occluded(origin + distance_m * unit, to, to,
                              std::numeric_limits<double>::infinity());
  };
  const auto lit = [&](double distance_m) { return sees(distance_m, to_light_); };
  const auto free_of_edges = [&](double distance_m) { return sees(distance_m, bottom_of_sun_); };
  // Probes are dense near the eye, where air and shadows contribute most.
  const auto probe_m = [&](int i) {
    constexpr double kStrength = 3.0;
    const double v = (i + 0.5) / probes_;
    return near.begin_m + (near.end_m - near.begin_m) * v / (1.0 + kStrength * (1.0 - v));
  };
  std::vector<char> is_lit;
  for (int i = 0; i < probes_; ++i) is_lit.push_back(lit(probe_m(i)) ? 1 : 0);

  SunlitPathBuilder builder;
  builder.Add({0.0, near.begin_m});
  double done_m = near.begin_m;
  for (int i = 0; i + 1 < probes_; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (is_lit[at] == is_lit[at + 1]) continue;
    const bool rises = is_lit[at + 1] != 0;
    // Half of the disk is visible at the edge. All of it is visible at the end of the penumbra,
    // which is searched up to the next change of light.
    const int step = rises ? 1 : -1;
    int last = rises ? i + 1 : i;
    const double edge_m = Edge(probe_m(last), probe_m(rises ? i : i + 1), lit);
    double dark_m = edge_m;
    while (!free_of_edges(probe_m(last)) && last + step >= 0 && last + step < probes_ &&
           is_lit[static_cast<std::size_t>(last + step)] != 0) {
      dark_m = probe_m(last);
      last += step;
    }
    const double free_m = Edge(probe_m(last), dark_m, free_of_edges);
    const double half_m = std::abs(free_m - edge_m);
    const double begin_m = std::max(edge_m - half_m, done_m);
    const double end_m = std::clamp(edge_m + half_m, begin_m, near.end_m);
    const auto height = [&](double distance_m) {
      const double x = half_m > 0.0 ? (distance_m - edge_m) / half_m : 0.0;
      return rises ? x : -x;
    };
    const double before = rises ? -1.0 : 1.0;
    builder.Add({done_m, begin_m, before, before});
    builder.Add({begin_m, end_m, height(begin_m), height(end_m)});
    done_m = std::max(done_m, end_m);
  }
  const double after = is_lit.back() != 0 ? 1.0 : -1.0;
  builder.Add({done_m, near.end_m, after, after});
  builder.Add({near.end_m, length_m});
  return builder.Take();
}

bool IsOneSurface(const Terrain& terrain) {
  const TriangleMesh& mesh = terrain.mesh();
  const glm::dvec3 up(0.0, 0.0, 1.0);
  const double infinity = std::numeric_limits<double>::infinity();
  const auto alone = [&](const glm::dvec3& p) {
    return !terrain.Occluded(p, up, up, infinity) && !terrain.Occluded(p, -up, -up, infinity);
  };
  return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const auto& triangle) {
    const glm::dvec3 a = ToDouble(mesh.positions[triangle[0]]);
    const glm::dvec3 b = ToDouble(mesh.positions[triangle[1]]);
    const glm::dvec3 c = ToDouble(mesh.positions[triangle[2]]);
    if (!((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 0.0)) return false;
    return alone(a) && alone(b) && alone(c) && alone((a + b + c) / 3.0);
  });
}

}  // namespace alpenglow::renderer
