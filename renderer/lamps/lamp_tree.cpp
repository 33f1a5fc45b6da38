// SPDX-License-Identifier: MIT
#include "renderer/lamps/lamp_tree.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>

#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/lamp/lamp.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"

namespace alpenglow::renderer {
namespace {

constexpr int kDistances = 21;
/// Beyond this distance from a lamp, ground and air are spheres: it is 8 m lower there than a plane.
constexpr double kPlane_m = 1e4;
constexpr double kDarkest = 1e-250;  // lower limit of values in logarithms
/// Rises of the lamp, dense near 0, where distant lamps on the ground are.
constexpr std::array<double, 9> kRises{-1.0, -0.6, -0.2, -0.04, 0.0, 0.04, 0.2, 0.6, 1.0};
constexpr int kElevations = static_cast<int>(kRises.size());

double DistanceNumber(int i) {
  return shared::LampAirlightDistance(i / (kDistances - 1.0), LampAirlightIrradiance::kNearest_m,
                                      LampAirlightIrradiance::kFarthest_m);
}

/// Returns the moments of the clamped cosine over those of Y_l0, so that E = sum of A_l L_lm Y_lm.
double LobeOf(int l) {
  switch (l) {
    case 0:
      return kPi;
    case 1:
      return 2.0 * kPi / 3.0;
    case 2:
      return kPi / 4.0;
    case 4:
      return -kPi / 24.0;
    case 6:
      return kPi / 64.0;
    default:
      return 0.0;
  }
}

/// Directions around the direction to the lamp, over half a turn, because the light is symmetric
/// about the vertical plane through the lamp. Weights are solid angles of both halves.
struct Around {
  double alpha, turn, weight;
};
const std::vector<Around>& DirectionsAround() {
  static const auto kDirections = [] {
    constexpr std::array<double, 6> kCuts{0.0, 0.05, 0.2, 0.6, 1.3, kPi};
    constexpr int kTurns = 8;
    const GaussRule& rule = GaussLegendre(3);
    std::vector<Around> directions;
    for (std::size_t piece = 0; piece + 1 < kCuts.size(); ++piece) {
      const double width = kCuts[piece + 1] - kCuts[piece];
      for (std::size_t i = 0; i < rule.node.size(); ++i) {
        const double alpha = kCuts[piece] + width * rule.node[i];
        for (int k = 0; k < kTurns; ++k) {
          directions.push_back({alpha, kPi * (k + 0.5) / kTurns,
                                rule.weight[i] * width * std::sin(alpha) * 2.0 * kPi / kTurns});
        }
      }
    }
    return directions;
  }();
  return kDirections;
}

/// Interpolation position of a value among the ascending points of an axis.
struct GlowPlace {
  int low;
  double share;  // weight of the next point
};
GlowPlace GlowPlaceOf(double rise) {
  int low = 0;
  while (low + 2 < kElevations && rise >= kRises[static_cast<std::size_t>(low + 1)]) ++low;
  const double from = kRises[static_cast<std::size_t>(low)];
  const double to = kRises[static_cast<std::size_t>(low + 1)];
  return {low, std::clamp((rise - from) / (to - from), 0.0, 1.0)};
}

/// Returns the harmonics of a normal about the direction to the lamp. `lift` is perpendicular to
/// it, in the vertical plane.
Moments HarmonicsOf(const glm::dvec3& normal, const glm::dvec3& towards, const glm::dvec3& lift) {
  const double mu = std::clamp(glm::dot(normal, towards), -1.0, 1.0);
  const glm::dvec3 aside = normal - mu * towards;
  const double lengths = glm::length(lift) * glm::length(aside);
  const double azimuth =
      lengths > 1e-9 ? std::clamp(glm::dot(lift, aside) / lengths, -1.0, 1.0) : 1.0;
  return SphericalHarmonics(LampAirlightIrradiance::kDegree, static_cast<float>(mu),
                            static_cast<float>(azimuth));
}

double Facing(const Moments& lobe, const Moments& harmonics) {
  float sum = 0.0F;
  for (std::size_t k = 0; k < MomentCount(LampAirlightIrradiance::kDegree); ++k)
    sum += lobe[k] * harmonics[k];
  return static_cast<double>(sum);
}

}  // namespace

LampAirlightIrradiance::LampAirlightIrradiance(const std::vector<LampLayer>& layers,
                                               double planet_radius_m, double lamp_altitude_m,
                                               double ground_altitude_m)
    : planet_radius_m_(planet_radius_m),
      lamp_altitude_m_(lamp_altitude_m),
      ground_altitude_m_(ground_altitude_m),
      lowest_m_(std::min(ground_altitude_m, 0.0)),
      lights_(static_cast<std::size_t>(kDistances * kElevations) *
              layers.front().scattering_per_m.size()) {
  ALPENGLOW_ENSURE(ground_altitude_m, <=, lamp_altitude_m);
  air_.layers = layers;
  tbb::parallel_for(0, kDistances * kElevations, [&](int entry) {
    const double distance_m = DistanceNumber(entry / kElevations);
    const double rise = kRises[static_cast<std::size_t>(entry % kElevations)];
    const std::vector<Light> lights =
        LightAt(distance_m, std::min(rise, std::max(HighestRise(distance_m), -1.0)));
    std::copy(lights.begin(), lights.end(),
              lights_.begin() + entry * static_cast<std::ptrdiff_t>(lights.size()));
  });
  for (int i = 0; i < kDistances; ++i) ExtrapolateBelowGround(i);
}

double LampAirlightIrradiance::HighestRise(double distance_m) const {
  return (lamp_altitude_m_ - lowest_m_) / distance_m;
}

void LampAirlightIrradiance::ExtrapolateBelowGround(int distance_number) {
  constexpr double kLeast = 1e-6;  // of a rise: the entries are those of one place
  const double highest = HighestRise(DistanceNumber(distance_number));
  const auto beyond = std::upper_bound(kRises.begin() + 1, kRises.end(), highest);
  if (beyond == kRises.end()) return;
  const double before = *(beyond - 1);
  if (highest - before < kLeast) return;
  const double share = (*beyond - before) / (highest - before);
  const std::size_t bands = air_.bands();
  const auto entry = static_cast<std::size_t>(distance_number * kElevations +
                                              static_cast<int>(beyond - kRises.begin()));
  for (std::size_t i = entry * bands; i < (entry + 1) * bands; ++i) {
    Light& light = lights_[i];
    const Light& above = lights_[i - bands];
    const auto extended = [&](auto from, auto to) {
      return from + static_cast<decltype(from)>(share) * (to - from);
    };
    light.log_mean = extended(above.log_mean, light.log_mean);
    light.level = extended(above.level, light.level);
    for (std::size_t k = 0; k < light.lobe.size(); ++k)
      light.lobe[k] = extended(above.lobe[k], light.lobe[k]);
  }
}

glm::dvec3 LampAirlightIrradiance::ToLamp(double distance_m, double rise) const {
  const double lamp_m = planet_radius_m_ + lamp_altitude_m_;
  const double point_m = std::max(lamp_m - rise * distance_m, 0.5 * planet_radius_m_);
  const double sine =
      std::clamp((rise * (lamp_m + point_m) - distance_m) / (2.0 * point_m), -1.0, 1.0);
  return distance_m * glm::dvec3(std::sqrt(1.0 - sine * sine), 0.0, sine);
}

SpectrumOf<double> LampAirlightIrradiance::RadianceAt(const LampOverPlanet& at,
                                                      const glm::dvec3& direction) const {
  constexpr int kNodes = 8;
  constexpr double kFar_m = 20e3;
  const double distance_m = glm::length(at.to_lamp_m);
  if (distance_m > kPlane_m) return AirlightOverPlanet(at, direction);
  Lamp lamp;
  lamp.position_m = {at.to_lamp_m.x, at.to_lamp_m.y, lamp_altitude_m_};
  LampSegment segment;
  segment.origin_m = {0.0, 0.0, at.point_altitude_m};
  segment.direction = direction;
  segment.end_m = 4.0 * distance_m + kFar_m;
  if (direction.z < 0.0) {
    segment.end_m =
        std::min(segment.end_m, (segment.origin_m.z - at.ground_altitude_m) / -direction.z);
  }
  if (!(segment.end_m > 0.0)) return SpectrumOf<double>(air_.bands());
  return Airlight(air_, lamp, segment, kNodes);
}

std::vector<LampAirlightIrradiance::Light> LampAirlightIrradiance::LightAt(double distance_m,
                                                                           double rise) const {
  const double altitude_m = lamp_altitude_m_ - distance_m * rise;
  const LampOverPlanet at{air_.layers, planet_radius_m_, std::min(ground_altitude_m_, altitude_m),
                          altitude_m, ToLamp(distance_m, rise)};
  const glm::dvec3 towards = at.to_lamp_m / distance_m;
  const glm::dvec3 lift(-towards.z, 0.0, towards.x), side(0.0, 1.0, 0.0);
  const std::size_t bands = air_.bands();
  std::vector<std::array<double, kMaxMoments>> sums(bands);
  std::vector<double> on_level(bands);
  for (const Around& around : DirectionsAround()) {
    const glm::dvec3 direction =
        std::cos(around.alpha) * towards +
        std::sin(around.alpha) * (std::cos(around.turn) * lift + std::sin(around.turn) * side);
    const SpectrumOf<double> radiance = RadianceAt(at, direction);
    const Moments harmonics =
        SphericalHarmonics(kDegree, static_cast<float>(std::cos(around.alpha)),
                           static_cast<float>(std::cos(around.turn)));
    for (std::size_t band = 0; band < bands; ++band) {
      on_level[band] += around.weight * radiance[band] * std::max(direction.z, 0.0);
      for (std::size_t k = 0; k < MomentCount(kDegree); ++k)
        sums[band][k] += around.weight * radiance[band] * static_cast<double>(harmonics[k]);
    }
  }
  std::vector<Light> lights(bands);
  const Moments upwards = HarmonicsOf({0.0, 0.0, 1.0}, towards, lift);
  for (std::size_t band = 0; band < bands; ++band) {
    const double mean = std::max(sums[band][0], kDarkest);
    lights[band].log_mean = std::log(mean * distance_m);
    for (int l = 0; l <= kDegree; ++l) {
      for (int m = 0; m <= l; ++m) {
        const std::size_t k = MomentIndex(l, m);
        lights[band].lobe[k] = static_cast<float>(LobeOf(l) * sums[band][k] / mean);
      }
    }
    lights[band].level = on_level[band] / mean - Facing(lights[band].lobe, upwards);
  }
  return lights;
}

SpectrumOf<double> LampAirlightIrradiance::On(const glm::dvec3& to_lamp, const glm::dvec3& normal,
                                              const glm::dvec3& up) const {
  const double length = std::max(glm::length(to_lamp), 1e-6);
  const double distance = std::max(length, kNearest_m);
  const glm::dvec3 towards = to_lamp / length;
  const double sine = std::clamp(glm::dot(towards, up), -1.0, 1.0);
  const Moments harmonics = HarmonicsOf(normal, towards, up - sine * towards);
  const double u = shared::LampAirlightUnit(distance, kNearest_m, kFarthest_m) * (kDistances - 1.0);
  const int low = std::min(static_cast<int>(u), kDistances - 2);
  const double rise = shared::LampRise(sine, length / (2.0 * planet_radius_m_));
  const GlowPlace elevation = GlowPlaceOf(std::min(rise, HighestRise(distance)));
  const double upwards = std::max(glm::dot(normal, up), 0.0);
  const double levelness = upwards * upwards;
  const double near = DistanceNumber(low), step = DistanceNumber(low + 1) - near;
  const double share = std::min((distance - near) / step, 1.0);
  const double beyond = std::max(distance - kFarthest_m, 0.0) / step;
  SpectrumOf<double> irradiance(air_.bands());
  for (std::size_t band = 0; band < irradiance.size(); ++band) {
    std::array<double, 2> log_mean{};
    double facing = 0.0;
    for (const int i : {0, 1}) {
      for (const int j : {0, 1}) {
        const double weight = j == 0 ? 1.0 - elevation.share : elevation.share;
        const auto entry = static_cast<std::size_t>((low + i) * kElevations + elevation.low + j);
        const Light& light = lights_[entry * irradiance.size() + band];
        log_mean[static_cast<std::size_t>(i)] += weight * light.log_mean;
        facing += (i == 0 ? 1.0 - share : share) * weight *
                  (Facing(light.lobe, harmonics) + levelness * light.level);
      }
    }
    const double log_here = std::lerp(log_mean[0], log_mean[1], share);
    irradiance[band] = std::exp(shared::LampAirlightBeyond(log_here, log_mean[0], beyond)) /
                       distance * std::max(facing, 0.0);
  }
  return irradiance;
}

LampTree::LampTree(std::vector<PlacedLamp> lamps, const LampEye& eye, const LampStage& stage) {
  for (PlacedLamp& lamp : lamps) Add(ShiningOn(eye, stage, std::move(lamp)), stage);
  lamps_ = nodes_.size();
  LampNodes even;
  for (std::uint32_t i = 0; i < lamps_; ++i) {
    const bool is_even = Light(i).lamp.profile.kind == LampProfile::Kind::kIsotropic;
    (is_even ? even : roots_).push_back(i);
  }
  if (!even.empty()) roots_.push_back(Join(std::move(even), eye, stage));
  MakeGlows(stage);
}

LampNode& LampTree::Add(PlacedLamp placed, const LampStage& stage) {
  LampNode node;
  const double altitude_m = stage.AltitudeOf(placed.lamp.position_m);
  for (const LampLayer& layer : placed.middle_air.layers) {
    node.extinction_per_m += layer.extinction_per_m[0] * layer.Density(altitude_m);
  }
  node.light = std::move(placed);
  nodes_.push_back(std::move(node));
  return nodes_.back();
}

LampNodes LampTree::AlongLongestSide(LampNodes members) const {
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (const std::uint32_t i : members) {
    low = glm::min(low, Light(i).lamp.position_m);
    high = glm::max(high, Light(i).lamp.position_m);
  }
  const glm::dvec3 size = high - low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  std::sort(members.begin(), members.end(), [&](std::uint32_t a, std::uint32_t b) {
    const double at_a = Light(a).lamp.position_m[axis];
    const double at_b = Light(b).lamp.position_m[axis];
    return at_a != at_b ? at_a < at_b : a < b;
  });
  return members;
}

std::uint32_t LampTree::Join(LampNodes members, const LampEye& eye, const LampStage& stage) {
  if (members.size() == 1) return members.front();
  members = AlongLongestSide(std::move(members));
  const auto middle = members.begin() + static_cast<std::ptrdiff_t>(members.size() / 2);
  const std::uint32_t left = Join({members.begin(), middle}, eye, stage);
  const std::uint32_t right = Join({middle, members.end()}, eye, stage);
  AddSum(members, eye, stage).children = {left, right};
  return static_cast<std::uint32_t>(nodes_.size() - 1);
}

LampNode& LampTree::AddSum(const LampNodes& members, const LampEye& eye, const LampStage& stage) {
  PlacedLamp sum;
  sum.intensity = Spectrum(stage.bands());
  glm::dvec3 centre(0.0);
  for (const std::uint32_t i : members) {
    const PlacedLamp& light = Light(i);
    sum.candela += light.candela;
    centre += light.candela * light.lamp.position_m;
    sum.lamp.radius_m = std::max(sum.lamp.radius_m, light.lamp.radius_m);
    sum.intensity = sum.intensity + light.intensity;
  }
  sum.lamp.position_m = centre / sum.candela;
  sum.above_ground_m = stage.HeightOverGround(sum.lamp.position_m);
  sum = Before(eye, stage, std::move(sum));
  glm::dmat3 moments(0.0);
  double radius = 0.0;
  for (const std::uint32_t i : members) {
    const glm::dvec3 off = Light(i).lamp.position_m - sum.lamp.position_m;
    moments += Light(i).candela / sum.candela * glm::outerProduct(off, off);
    radius = std::max(radius, glm::length(off));
  }
  LampNode& node = Add(std::move(sum), stage);
  node.moments = moments;
  node.radius_m = radius;
  return node;
}

void LampTree::StandBefore(const LampEye& eye, const LampStage& stage) {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    PlacedLamp& light = nodes_[i].light;
    light =
        i < lamps_ ? ShiningOn(eye, stage, std::move(light)) : Before(eye, stage, std::move(light));
  }
}

// Lamps at similar places share a table: altitudes within a tenth of the thinnest layer's scale
// height, and heights above the ground within a fifth.
void LampTree::MakeGlows(const LampStage& stage) {
  double thinnest_m = std::numeric_limits<double>::infinity();
  for (const LampLayer& layer : stage.layers())
    thinnest_m = std::min(thinnest_m, layer.scale_height_m);
  const double alike_m = std::clamp(0.1 * thinnest_m, 0.5, 100.0);
  struct Stand {
    double altitude_m, above_m;
  };
  std::vector<Stand> stands;
  for (const LampNode& node : nodes_) {
    const Stand here{stage.AltitudeOf(node.light.lamp.position_m), node.light.above_ground_m};
    const auto same = std::find_if(stands.begin(), stands.end(), [&](const Stand& other) {
      return std::abs(other.altitude_m - here.altitude_m) <= alike_m &&
             std::abs(other.above_m - here.above_m) <= 0.2 * std::max(here.above_m, 0.5);
    });
    glow_of_node_.push_back(static_cast<std::size_t>(same - stands.begin()));
    if (same != stands.end()) continue;
    stands.push_back(here);
    glows_.push_back(std::make_shared<const LampAirlightIrradiance>(
        stage.layers(), stage.planet_radius_m(), here.altitude_m, here.altitude_m - here.above_m));
  }
}

}  // namespace alpenglow::renderer
