// SPDX-License-Identifier: MIT
#include "renderer/lamp/lamp_light.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <queue>
#include <string>

#include "atmosphere/colour/black_body.h"
#include "atmosphere/lamp/airlight.h"
#include "atmosphere/number/constants.h"
#include "atmosphere/number/quadrature.h"
#include "atmosphere/text/error.h"
#include "lut/program/program.h"
#include "renderer/ground/band_light.h"
#include "renderer/ground/scene_geometry.h"
#include "renderer/lamp/ies_file.h"
#include "renderer/lamp/lamp_glow.h"

namespace alpenglow {
namespace {

/// A lamp where it stands, with the air between it and the eye.
struct PlacedLamp {
  Lamp lamp;
  LampAir air;
  LampAir middle_air;       // of the middle band alone, for estimates
  Bands<float> intensity;   // W sr^-1 nm^-1 in its brightest direction
  double candela = 0.0;     // in its brightest direction
  double mean_share = 1.0;  // mean intensity over all directions, relative to the brightest
  double above_ground_m = 0.0;
  double distance_m = 0.0;    // from the eye
  glm::dvec3 direction{0.0};  // from the eye, unit
  double blur = 0.0;          // radius in the picture, as CameraRays::BlurRadius
  bool is_hidden = false;     // from the eye, by terrain
  Bands<float> towards_eye;   // intensity, dimmed by the air
};

/// A node of the tree: a lamp, or one that stands for others.
struct Node {
  PlacedLamp light;
  glm::dmat3 moments{0.0};  // second moments of the lamps about its place, per candela [m^2]
  double radius_m = 0.0;    // of the lamps' places around its own
  double extinction_per_m = 0.0;
  std::optional<std::array<std::uint32_t, 2>> children;
};

Bands<double> OneBand(const Bands<double>& all, std::size_t band) {
  Bands<double> one(1);
  one[0] = all[band];
  return one;
}

Bands<double> InDoubles(const std::vector<double>& values, double scale) {
  Bands<double> bands(values.size());
  for (std::size_t band = 0; band < values.size(); ++band) bands[band] = scale * values[band];
  return bands;
}

void AddScaled(const Bands<float>& intensity, const Bands<double>& factor, double scale,
               Bands<float>& sum) {
  for (std::size_t band = 0; band < sum.count; ++band) {
    sum[band] += intensity[band] * static_cast<float>(scale * factor[band]);
  }
}

/// Scale height of the exponential that has the molecules' density at the ground and 4 km up:
/// within 2 % of it between, where lamps shine.
double MoleculeHeight_m(const Medium& medium) {
  constexpr double kHigh_m = 4000.0;
  return -kHigh_m / std::log(MoleculeDensity(medium, kHigh_m));
}

/// Molecules, aerosol and fog, densities as of altitude 0.
std::vector<LampLayer> LayersOf(const Medium& medium, const std::optional<Fog>& fog,
                                double fog_base_m) {
  LampLayer molecules;
  molecules.scale_height_m = MoleculeHeight_m(medium);
  molecules.scattering_per_m = InDoubles(medium.rayleigh_scattering_per_m, 1.0);
  molecules.extinction_per_m = molecules.scattering_per_m;
  molecules.phase.kind = PhaseKind::kRayleigh;
  LampLayer aerosol;
  aerosol.scale_height_m = medium.mie_scale_height_m;
  aerosol.scattering_per_m = InDoubles(medium.mie_scattering_per_m, 1.0);
  aerosol.extinction_per_m = InDoubles(medium.mie_extinction_per_m, 1.0);
  // Lamps are near: their light is scattered as at the middle wavelength.
  aerosol.phase = MiePhase(medium, medium.wavelengths_nm.size() / 2);
  std::vector<LampLayer> layers{molecules, aerosol};
  if (!fog) return layers;
  LampLayer drops;
  drops.scale_height_m = fog->scale_height_m;
  const double at_zero = fog->extinction_per_m * std::exp(fog_base_m / fog->scale_height_m);
  const std::vector<double> grey(medium.wavelengths_nm.size(), at_zero);
  drops.scattering_per_m = InDoubles(grey, fog->albedo);
  drops.extinction_per_m = InDoubles(grey, 1.0);
  drops.phase = fog->phase;
  layers.push_back(drops);
  return layers;
}

/// Mean over all directions, by quadrature around the axis.
double MeanOverDirections(const LampProfile& profile) {
  if (profile.kind == LampProfile::Kind::kIsotropic) return 1.0;
  constexpr int kTurns = 36;
  constexpr int kPanels = 32;
  const GaussRule& rule = GaussLegendre(4);
  double sum = 0.0;
  for (int panel = 0; panel < kPanels; ++panel) {
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      const double gamma = kPi * (panel + rule.node[i]) / kPanels;
      for (int turn = 0; turn < kTurns; ++turn) {
        const double c = 2.0 * kPi * (turn + 0.5) / kTurns;
        sum += rule.weight[i] * kPi / kPanels * 0.5 * std::sin(gamma) / kTurns *
               RelativeIntensity(profile, {std::cos(gamma), std::sin(gamma) * std::cos(c),
                                           std::sin(gamma) * std::sin(c)});
      }
    }
  }
  return sum;
}

/// The lamp as the air around it sees it in a picture: the mean of 1/D over a square of width w
/// around it is that of D = w / (4 ln(1 + sqrt 2)), and over a disk of radius R that of R / 2.
Lamp AsWideAsAPixel(const PlacedLamp& placed, double pixel_angle_rad) {
  constexpr double kPixelMean = 0.2836;
  constexpr double kDiskMean = 0.5;
  Lamp lamp = placed.lamp;
  const double angle = std::max(kPixelMean * pixel_angle_rad, kDiskMean * placed.blur);
  lamp.radius_m = std::max(lamp.radius_m, angle * placed.distance_m);
  return lamp;
}

/// A lamp as it lights the air along a ray from the eye, times a share.
struct LampAlongRay {
  Lamp lamp;
  double share = 1.0;
};
LampAlongRay AlongRay(const PlacedLamp& placed, const glm::dvec3& direction,
                      double pixel_angle_rad) {
  LampAlongRay along{AsWideAsAPixel(placed, pixel_angle_rad)};
  // From within the lamp a ray goes along with the lamp's light, which has one intensity all along.
  if (placed.distance_m <= placed.lamp.radius_m) {
    along.share = RelativeIntensity(placed.lamp, direction);
    along.lamp.profile = {};
  }
  return along;
}

}  // namespace

struct LampLight::State {
  const SceneGround& ground;
  double planet_radius_m;
  std::vector<LampLayer> layers;
  bool has_fog;
  glm::dvec3 eye;
  std::optional<CameraRays> lens;  // of a camera that has one
  std::size_t bands;
  std::vector<Node> nodes;  // the scene's lamps, then those that stand for others
  std::size_t lamps = 0;
  LampNodes roots;
  std::vector<std::shared_ptr<const LampGlow>> glows;
  std::vector<std::size_t> glow_of_lamp;

  State(const Scene& scene, const SceneGround& on, const Medium& medium)
      : ground(on),
        planet_radius_m(medium.planet_radius_m),
        layers(LayersOf(medium, scene.fog, FogBase(scene, on))),
        has_fog(scene.fog.has_value() && scene.fog->extinction_per_m > 0.0),
        eye(0.0, 0.0, on.eye_height_m),
        bands(medium.wavelengths_nm.size()) {}

  static double FogBase(const Scene& scene, const SceneGround& ground) {
    if (!scene.fog) return 0.0;
    return scene.fog->base_height_m.value_or(GroundBelow(ground, {0.0, 0.0, 0.0}, 0.0));
  }

  // Height of the terrain below or above a point [m along z], or `otherwise`.
  static double GroundBelow(const SceneGround& ground, const glm::dvec3& point, double otherwise) {
    constexpr double kAbove_m = 20000.0;
    if (!ground.terrain) return otherwise;
    const auto hit = ground.terrain->Intersect({point.x, point.y, kAbove_m}, {0.0, 0.0, -1.0});
    return hit ? kAbove_m - hit->distance_m : otherwise;
  }

  [[nodiscard]] double AltitudeOf(const glm::dvec3& point) const {
    return AltitudeOverSphere(point, planet_radius_m);
  }

  // The layers over the plane that touches the sphere below a point.
  [[nodiscard]] LampAir AirAround(const glm::dvec3& middle) const {
    LampAir air;
    air.layers = layers;
    air.up = UpAt(middle);
    air.altitude_at_origin_m = AltitudeOf(middle) - glm::dot(air.up, middle);
    return air;
  }

  [[nodiscard]] glm::dvec3 PositionOf(const Light& light, std::size_t number) const {
    GeodeticPosition place{light.latitude_rad, light.longitude_rad, 0.0};
    if (!light.height.above_ground) place.height_m = light.height.value_m;
    glm::dvec3 position = ground.frame.EnuFromGeodetic(place).xyz;
    const double floor = GroundBelow(ground, position, position.z);
    if (light.height.above_ground) {
      position.z = floor + light.height.value_m;
    } else if (position.z < floor && ground.terrain) {
      throw InputError(fmt::format("light {}: height_m is {}; the ground there is at {:.1f} m",
                                   number + 1, light.height.value_m, floor));
    }
    return position;
  }

  void Place(const Light& light, const Medium& medium, const BandColour& colour,
             std::map<std::string, IesLamp>& measured) {
    PlacedLamp placed;
    placed.lamp.position_m = PositionOf(light, nodes.size());
    placed.lamp.radius_m = light.radius_m;
    placed.candela = light.intensity_cd.value_or(0.0);
    Aim(light, placed);
    if (light.type == Light::Type::kSpot) {
      placed.lamp.profile.kind = LampProfile::Kind::kCone;
      placed.lamp.profile.inner_rad = light.inner_rad;
      placed.lamp.profile.outer_rad = light.outer_rad;
    }
    if (light.ies) {
      const auto [found, is_new] = measured.try_emplace(light.ies->string());
      if (is_new) found->second = ReadIes(*light.ies);
      placed.lamp.profile.kind = LampProfile::Kind::kTable;
      placed.lamp.profile.table = found->second.table;
      if (!light.intensity_cd) placed.candela = found->second.intensity_cd;
    }
    placed.above_ground_m = HeightOverGround(placed.lamp.position_m);
    placed.mean_share = MeanOverDirections(placed.lamp.profile);
    placed.intensity = IntensityOf(light.temperature_k, placed.candela, medium, colour);
    StandBeforeEye(placed);
    ShineOnEye(placed);
    AddNode(std::move(placed));
  }

  /// Of the terrain below a lamp; lamps of a group that lies over a hill have none.
  [[nodiscard]] double HeightOverGround(const glm::dvec3& position) const {
    const double none = position.z - AltitudeOf(position);
    return std::max(position.z - GroundBelow(ground, position, none), 0.0);
  }

  [[nodiscard]] glm::dvec3 UpAt(const glm::dvec3& point) const {
    return glm::normalize(point + glm::dvec3(0.0, 0.0, planet_radius_m));
  }

  void ShineOnEye(PlacedLamp& placed) const {
    placed.is_hidden = !IsLit(placed, eye);
    AddScaled(placed.intensity, TransmittanceBetween(placed.air, eye, placed.lamp.position_m),
              RelativeIntensity(placed.lamp, -placed.direction), placed.towards_eye);
  }

  // Everything that depends on the eye, anew.
  void StandBefore(const CameraRays& camera) {
    eye = camera.eye();
    lens.reset();
    if (camera.HasLens()) lens = camera;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      StandBeforeEye(nodes[i].light);
      if (i < lamps) ShineOnEye(nodes[i].light);
    }
  }

  Node& AddNode(PlacedLamp placed) {
    Node node;
    for (const LampLayer& layer : placed.middle_air.layers) {
      node.extinction_per_m += layer.extinction_per_m[0] *
                               std::exp(-AltitudeOf(placed.lamp.position_m) / layer.scale_height_m);
    }
    node.light = std::move(placed);
    nodes.push_back(std::move(node));
    return nodes.back();
  }

  // Lamps of these numbers under one node: halves along the longest side.
  std::uint32_t Join(LampNodes members) {
    if (members.size() == 1) return members.front();
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
    for (const std::uint32_t i : members) {
      low = glm::min(low, nodes[i].light.lamp.position_m);
      high = glm::max(high, nodes[i].light.lamp.position_m);
    }
    const glm::dvec3 size = high - low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    std::sort(members.begin(), members.end(), [&](std::uint32_t a, std::uint32_t b) {
      const double at_a = nodes[a].light.lamp.position_m[axis];
      const double at_b = nodes[b].light.lamp.position_m[axis];
      return at_a != at_b ? at_a < at_b : a < b;
    });
    const auto middle = members.begin() + static_cast<std::ptrdiff_t>(members.size() / 2);
    const std::uint32_t left = Join({members.begin(), middle});
    const std::uint32_t right = Join({middle, members.end()});
    AddSum(members).children = {left, right};
    return static_cast<std::uint32_t>(nodes.size() - 1);
  }

  Node& AddSum(const LampNodes& members) {
    PlacedLamp sum;
    sum.intensity = Bands<float>(bands);
    glm::dvec3 centre(0.0);
    for (const std::uint32_t i : members) {
      const PlacedLamp& light = nodes[i].light;
      sum.candela += light.candela;
      centre += light.candela * light.lamp.position_m;
      sum.lamp.radius_m = std::max(sum.lamp.radius_m, light.lamp.radius_m);
      for (std::size_t band = 0; band < bands; ++band) sum.intensity[band] += light.intensity[band];
    }
    sum.lamp.position_m = centre / sum.candela;
    sum.above_ground_m = HeightOverGround(sum.lamp.position_m);
    StandBeforeEye(sum);
    glm::dmat3 moments(0.0);
    double radius = 0.0;
    for (const std::uint32_t i : members) {
      const glm::dvec3 off = nodes[i].light.lamp.position_m - sum.lamp.position_m;
      moments += nodes[i].light.candela / sum.candela * glm::outerProduct(off, off);
      radius = std::max(radius, glm::length(off));
    }
    Node& node = AddNode(std::move(sum));
    node.moments = moments;
    node.radius_m = radius;
    return node;
  }

  void MakeTree() {
    lamps = nodes.size();
    LampNodes even;
    for (std::uint32_t i = 0; i < lamps; ++i) {
      const bool is_even = nodes[i].light.lamp.profile.kind == LampProfile::Kind::kIsotropic;
      (is_even ? even : roots).push_back(i);
    }
    if (!even.empty()) roots.push_back(Join(std::move(even)));
  }

  // Axis by heading and pitch; C of a measured lamp is 0 above the axis where it is level, towards
  // the heading where it points down, and goes from there to the left.
  static void Aim(const Light& light, PlacedLamp& placed) {
    const double heading = light.heading_rad, pitch = light.pitch_rad;
    const glm::dvec3 ahead(std::sin(heading), std::cos(heading), 0.0);
    const glm::dvec3 up(0.0, 0.0, 1.0);
    placed.lamp.axis = std::cos(pitch) * ahead + std::sin(pitch) * up;
    placed.lamp.side = -std::sin(pitch) * ahead + std::cos(pitch) * up;
  }

  static Bands<float> IntensityOf(double temperature_k, double candela, const Medium& medium,
                                  const BandColour& colour) {
    std::vector<double> spectrum;
    for (const double nm : medium.wavelengths_nm)
      spectrum.push_back(BlackBodyRadiance(nm, temperature_k));
    const double luminous = colour.Xyz(spectrum)[1];
    Bands<float> intensity(spectrum.size());
    for (std::size_t band = 0; band < spectrum.size(); ++band) {
      intensity[band] = static_cast<float>(candela * spectrum[band] / luminous);
    }
    return intensity;
  }

  void StandBeforeEye(PlacedLamp& placed) const {
    const glm::dvec3 to_lamp = placed.lamp.position_m - eye;
    constexpr double kAtTheEye_m = 1e-6;
    const double distance_m = glm::length(to_lamp);
    placed.distance_m = std::max(distance_m, kAtTheEye_m);
    // A lamp at the eye has no direction; any one will do.
    placed.direction = distance_m > kAtTheEye_m ? to_lamp / distance_m : -placed.lamp.axis;
    placed.air = AirAround(0.5 * (eye + placed.lamp.position_m));
    placed.middle_air = placed.air;
    for (LampLayer& layer : placed.middle_air.layers) {
      layer.scattering_per_m = OneBand(layer.scattering_per_m, bands / 2);
      layer.extinction_per_m = OneBand(layer.extinction_per_m, bands / 2);
    }
    placed.blur = lens ? lens->BlurRadius(to_lamp) : 0.0;
    placed.towards_eye = Bands<float>(bands);
  }

  // Of a lamp that the eye is in: its luminance, I(-d) / (pi R^2) of the direction d of the ray, as
  // if the eye were in its middle and saw the inside of the luminous sphere. What a lamp from
  // outside tends to: its disk, I / (pi R^2) bright, fills the sky.
  [[nodiscard]] Bands<float> SeenFromWithin(const PlacedLamp& placed, const CameraRay& ray) const {
    const double radius = placed.lamp.radius_m;
    Bands<float> seen(bands);
    AddScaled(placed.intensity,
              TransmittanceBetween(placed.air, ray.eye, ray.eye + radius * ray.direction),
              RelativeIntensity(placed.lamp, -ray.direction) / (kPi * radius * radius), seen);
    return seen;
  }

  // Of a lamp's light as the eye gets it, what a ray of the camera sees of it [1/sr].
  [[nodiscard]] double SeenPerSr(const PlacedLamp& placed, const CameraRay& ray,
                                 double pixel_angle_rad) const {
    const double radius = std::max(placed.lamp.radius_m / placed.distance_m, 0.9 * pixel_angle_rad);
    const glm::dvec3 way = placed.lamp.position_m - ray.eye;
    if (lens) {
      const auto blur = lens->BlurAt(way, ray.through, radius);
      if (!blur) return 0.0;
      // In focus the light comes from all of the lens, else from one point of it.
      const glm::dvec3 seen_from = placed.blur > radius ? ray.eye + blur->on_lens : ray.origin;
      return IsLit(placed, seen_from) ? blur->per_sr : 0.0;
    }
    const double off = glm::length(ray.direction - glm::normalize(way)) / radius;
    if (off >= 1.0 || placed.is_hidden) return 0.0;
    // (1 - r^2)^2 over the disk integrates to pi / 3.
    return (1.0 - off * off) * (1.0 - off * off) * 3.0 / (kPi * radius * radius);
  }

  // Whether no terrain stands between the lamp and a point in the air.
  [[nodiscard]] bool IsLit(const PlacedLamp& placed, const glm::dvec3& point) const {
    if (!ground.terrain) return true;
    const glm::dvec3 way = point - placed.lamp.position_m;
    const double length = glm::length(way);
    if (length < 1e-6) return true;
    return !ground.terrain->Occluded(placed.lamp.position_m, way / length, way / length, length);
  }

  // Lamps share a table when they stand alike: within a tenth of the thinnest layer's scale height,
  // and within a fifth of their height over the ground.
  void MakeGlows() {
    double thinnest_m = std::numeric_limits<double>::infinity();
    for (const LampLayer& layer : layers) thinnest_m = std::min(thinnest_m, layer.scale_height_m);
    const double alike_m = std::clamp(0.1 * thinnest_m, 0.5, 100.0);
    struct Stand {
      double altitude_m, above_m;
    };
    std::vector<Stand> stands;
    for (const Node& node : nodes) {
      const Stand here{AltitudeOf(node.light.lamp.position_m), node.light.above_ground_m};
      const auto same = std::find_if(stands.begin(), stands.end(), [&](const Stand& other) {
        return std::abs(other.altitude_m - here.altitude_m) <= alike_m &&
               std::abs(other.above_m - here.above_m) <= 0.2 * std::max(here.above_m, 0.5);
      });
      glow_of_lamp.push_back(static_cast<std::size_t>(same - stands.begin()));
      if (same != stands.end()) continue;
      stands.push_back(here);
      glows.push_back(std::make_shared<const LampGlow>(layers, here.altitude_m,
                                                       here.altitude_m - here.above_m));
    }
  }

  // Beyond this, rays to the sky have left what a lamp lights.
  [[nodiscard]] static double Reach(const PlacedLamp& placed, double length_m) {
    return std::min(length_m, 4.0 * placed.distance_m + 20e3);
  }

  [[nodiscard]] LampTile TileAt(const LampLight& light, const MovingCamera& camera,
                                const std::array<int, 4>& box, const LampSettings& settings,
                                const Trace& trace) const;
  [[nodiscard]] bool AllLit(const LampNodes& members, const LampRayEnd& ray) const;

  // The lit pieces of a ray, in distances: points at equal angles as the lamp sees them are tested,
  // and edges between them bisected.
  [[nodiscard]] std::vector<std::array<double, 2>> LitPieces(const PlacedLamp& placed,
                                                             const glm::dvec3& direction,
                                                             double length_m) const {
    if (!ground.terrain) return {{0.0, length_m}};
    const glm::dvec3 to_lamp = placed.lamp.position_m - eye;
    const double nearest = glm::dot(to_lamp, direction);
    const double approach =
        std::max(glm::length(to_lamp - nearest * direction), placed.lamp.radius_m);
    const double low = std::atan2(-nearest, approach);
    const double high = std::atan2(length_m - nearest, approach);
    const auto distance = [&](double theta) {
      return std::clamp(nearest + approach * std::tan(theta), 0.0, length_m);
    };
    const auto is_lit = [&](double theta) {
      return IsLit(placed, eye + 0.9999 * distance(theta) * direction);
    };
    constexpr int kSteps = 12;
    std::vector<std::array<double, 2>> pieces;
    double begin = low;
    bool lit = is_lit(low);
    for (int i = 1; i <= kSteps; ++i) {
      double from = low + (high - low) * (i - 1) / kSteps;
      double to = low + (high - low) * i / kSteps;
      if (is_lit(to) == lit) continue;
      for (int step = 0; step < 6; ++step) {
        const double middle = 0.5 * (from + to);
        (is_lit(middle) == lit ? from : to) = middle;
      }
      const double edge = 0.5 * (from + to);
      if (lit) pieces.push_back({distance(begin), distance(edge)});
      begin = edge;
      lit = !lit;
    }
    if (lit) pieces.push_back({distance(begin), length_m});
    return pieces;
  }
};

LampLight::LampLight(const Scene& scene, const SceneGround& ground, const Medium& medium,
                     const BandColour& colour)
    : state_(std::make_unique<State>(scene, ground, medium)) {
  std::map<std::string, IesLamp> measured;
  for (const Light& light : scene.lights) {
    if (light.intensity_cd != 0.0) state_->Place(light, medium, colour, measured);
  }
  state_->MakeTree();
  state_->MakeGlows();
}
LampLight::LampLight(std::unique_ptr<State> state) : state_(std::move(state)) {}
LampLight::LampLight(LampLight&&) noexcept = default;
LampLight::~LampLight() = default;

LampLight LampLight::SeenBy(const CameraRays& camera) const {
  auto state = std::make_unique<State>(*state_);
  state->StandBefore(camera);
  return LampLight(std::move(state));
}

LampNodes LampLight::All() const {
  LampNodes all(state_->lamps);
  std::iota(all.begin(), all.end(), std::uint32_t{0});
  return all;
}

std::vector<glm::dvec3> LampLight::Directions() const {
  std::vector<glm::dvec3> directions;
  for (std::size_t i = 0; i < state_->lamps; ++i)
    directions.push_back(state_->nodes[i].light.direction);
  return directions;
}

Bands<float> LampLight::FogTransmittance(const glm::dvec3& direction, double length_m) const {
  Bands<float> left(state_->bands);
  std::fill_n(left.value.begin(), left.count, 1.0F);
  if (!state_->has_fog) return left;
  const LampLayer& fog = state_->layers.back();
  // Fog ends where it is 50 scale heights thin; homogeneous fog ends nowhere.
  const double h = fog.scale_height_m;
  const double z = state_->AltitudeOf(state_->eye);
  const double length = std::min(length_m, 1e6);
  const double z_end = state_->AltitudeOf(state_->eye + length * direction);
  const double column =
      ExponentialColumn(length, std::exp(-z / h), std::exp(-z_end / h), (z_end - z) / h);
  for (std::size_t band = 0; band < left.count; ++band) {
    left[band] = static_cast<float>(std::exp(-fog.extinction_per_m[band] * column));
  }
  return left;
}

Bands<float> LampLight::InAir(const LampNodes& lamps, const LampRayEnd& ray, double pixel_angle_rad,
                              int nodes) const {
  Bands<float> sum(state_->bands);
  for (const std::uint32_t index : lamps) {
    const PlacedLamp& placed = state_->nodes[index].light;
    const auto [lamp, share] = AlongRay(placed, ray.direction, pixel_angle_rad);
    const double reach = State::Reach(placed, ray.length_m);
    for (const auto& [begin, end] : state_->LitPieces(placed, ray.direction, reach)) {
      const LampSegment segment{state_->eye, ray.direction, begin, end};
      AddScaled(placed.intensity, Airlight(placed.air, lamp, segment, nodes), share, sum);
    }
  }
  return sum;
}

Bands<float> LampLight::OnSurface(const LampNodes& lamps, const LitPoint& at) const {
  Bands<float> sum(state_->bands);
  for (const std::uint32_t index : lamps) {
    const PlacedLamp& placed = state_->nodes[index].light;
    const glm::dvec3 to_lamp = placed.lamp.position_m - at.point;
    const double distance = std::max(glm::length(to_lamp), placed.lamp.radius_m);
    const glm::dvec3 towards = to_lamp / distance;
    const double cosine = glm::dot(at.normal, towards);
    const LampGlow& glow = *state_->glows[state_->glow_of_lamp[index]];
    AddScaled(placed.intensity, glow.On(distance * towards, at.normal, state_->UpAt(at.point)),
              placed.mean_share, sum);
    if (cosine <= 0.0 || glm::dot(at.geometric_normal, towards) <= 0.0) continue;
    const double relative = RelativeIntensity(placed.lamp, -towards);
    if (relative <= 0.0) continue;
    if (state_->ground.terrain &&
        state_->ground.terrain->Occluded(at.point, at.geometric_normal, towards, distance)) {
      continue;
    }
    AddScaled(placed.intensity, TransmittanceBetween(placed.air, placed.lamp.position_m, at.point),
              relative * cosine / (distance * distance), sum);
  }
  return sum;
}

LampLight::SceneLamp LampLight::At(std::uint32_t number) const {
  const PlacedLamp& placed = state_->nodes[number].light;
  return {placed.lamp, placed.intensity, placed.candela};
}

Bands<double> LampLight::DepthTo(std::uint32_t number, const glm::dvec3& point) const {
  const PlacedLamp& placed = state_->nodes[number].light;
  Bands<double> depth = TransmittanceBetween(placed.air, placed.lamp.position_m, point);
  const bool is_lit = state_->IsLit(placed, point);
  for (std::size_t band = 0; band < depth.count; ++band) {
    depth[band] = is_lit ? -std::log(depth[band]) : std::numeric_limits<double>::infinity();
  }
  return depth;
}

Bands<float> LampLight::Seen(const LampNodes& lamps, const CameraRay& ray, double pixel_angle_rad,
                             const std::function<Bands<float>(double)>& left) const {
  Bands<float> sum(state_->bands);
  for (const std::uint32_t index : lamps) {
    const PlacedLamp& placed = state_->nodes[index].light;
    if (glm::length(placed.lamp.position_m - ray.eye) <= placed.lamp.radius_m) {
      const Bands<float> around = state_->SeenFromWithin(placed, ray);
      sum = sum + (left ? left(placed.lamp.radius_m) * around : around);
      continue;
    }
    const double share =
        state_->SeenPerSr(placed, ray, pixel_angle_rad) / (placed.distance_m * placed.distance_m);
    if (share == 0.0) continue;
    Bands<float> arriving = placed.towards_eye;
    if (left) arriving = left(placed.distance_m) * arriving;
    for (std::size_t band = 0; band < sum.count; ++band) {
      sum[band] += arriving[band] * static_cast<float>(share);
    }
  }
  return sum;
}

namespace {

/// The rays of a tile's corners and its middle, and where they end; more by points of the iris and
/// of time where there are any.
struct TileRays {
  std::vector<LampRayEnd> rays;
  double radius_rad = 0.0;  // of the cone around the middle that holds the tile
  // Of the ends on surfaces: the middle one (or any), and how far the others lie from it.
  std::optional<glm::dvec3> surface;
  double surface_spread_m = 0.0;
  static constexpr int kMoreRays = 8;

  TileRays(const MovingCamera& moving, int x0, int y0, int x1, int y1,
           const LampLight::Trace& trace) {
    const std::array<std::array<double, 2>, 5> points{{{0.5 * (x0 + x1), 0.5 * (y0 + y1)},
                                                       {x0 + 0.5, y0 + 0.5},
                                                       {x1 - 0.5, y0 + 0.5},
                                                       {x0 + 0.5, y1 - 0.5},
                                                       {x1 - 0.5, y1 - 0.5}}};
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

  void Add(const CameraRay& ray, const LampLight::Trace& trace) {
    rays.push_back({ray.direction, trace(ray)});
    const double length = rays.back().length_m;
    if (std::isinf(length)) return;
    const glm::dvec3 point = ray.origin + length * ray.direction;
    if (!surface) surface = point;
    surface_spread_m = std::max(surface_spread_m, glm::length(point - *surface));
  }

  [[nodiscard]] const glm::dvec3& middle() const { return rays[0].direction; }
  [[nodiscard]] double longest() const {
    double most = 0.0;
    for (const LampRayEnd& ray : rays) most = std::max(most, ray.length_m);
    return most;
  }
  [[nodiscard]] double shortest() const {
    double least = std::numeric_limits<double>::infinity();
    for (const LampRayEnd& ray : rays) least = std::min(least, ray.length_m);
    return least;
  }
  // How far the ends of the rays stay from a distance.
  [[nodiscard]] double GapTo(double distance_m) const {
    double least = std::numeric_limits<double>::infinity();
    for (const LampRayEnd& ray : rays) {
      least = std::min(least, std::abs(ray.length_m - distance_m));
    }
    return least;
  }
  // The direction of the tile's cone that is nearest to a lamp's.
  [[nodiscard]] glm::dvec3 Nearest(const glm::dvec3& to_lamp) const {
    const double apart = glm::length(to_lamp - middle());
    if (apart <= radius_rad) return to_lamp;
    return glm::normalize(middle() + (to_lamp - middle()) * (radius_rad / apart));
  }
  // And the one that is farthest from it.
  [[nodiscard]] glm::dvec3 Farthest(const glm::dvec3& to_lamp) const {
    const double apart = std::max(glm::length(to_lamp - middle()), 1e-9);
    return glm::normalize(middle() - (to_lamp - middle()) * (radius_rad / apart));
  }
};

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
LampNodes Cut(const std::vector<Node>& nodes, const LampNodes& roots, const LampSettings& settings,
              const Weigh& weigh) {
  std::priority_queue<Share> open;
  double least = 0.0, error = 0.0;
  const auto add = [&](std::uint32_t node) {
    const Share share = weigh(node);
    least += share.least;
    error += share.error;
    open.push(share);
  };
  for (const std::uint32_t root : roots) add(root);
  const auto budget = [&] {
    return std::max(0.5 * settings.share_of_error * least, 0.5 * settings.floor_cd_per_m2);
  };
  while (!open.empty() && open.top().error > 0.0 && error > budget()) {
    const Share worst = open.top();
    open.pop();
    least -= worst.least;
    error -= worst.error;
    for (const std::uint32_t child : nodes[worst.node].children.value()) add(child);
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
Share WeighInAir(const Node& node, std::uint32_t number, const TileRays& tile,
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
Share WeighOnSurface(const Node& node, std::uint32_t number, const TileRays& tile) {
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

/// Far enough from a tile that light in the air is a parabola between lattice points: across h the
/// straight line misses 1/D by (h / D)^2 / 4.
bool IsFar(const Node& node, const TileRays& tile, double pixel_angle_rad) {
  constexpr double kSteps = 7.0;
  const double apart = glm::length(node.light.direction - tile.middle());
  return node.light.lamp.profile.kind == LampProfile::Kind::kIsotropic &&
         apart - tile.radius_rad > kSteps * LampPlan::kSpacing * pixel_angle_rad;
}

}  // namespace

LampPlan LampLight::PlanFor(const MovingCamera& camera, int width, int height,
                            const LampSettings& settings, const Trace& trace) const {
  LampPlan plan;
  plan.columns = (width + LampPlan::kTile - 1) / LampPlan::kTile;
  const int rows = (height + LampPlan::kTile - 1) / LampPlan::kTile;
  plan.tiles.resize(static_cast<std::size_t>(plan.columns) * static_cast<std::size_t>(rows));
  if (state_->nodes.empty()) return plan;
  tbb::parallel_for(0, static_cast<int>(plan.tiles.size()), [&](int number) {
    if (Interrupted()) return;
    const int x0 = number % plan.columns * LampPlan::kTile;
    const int y0 = number / plan.columns * LampPlan::kTile;
    plan.tiles[static_cast<std::size_t>(number)] = state_->TileAt(
        *this, camera,
        {x0, y0, std::min(x0 + LampPlan::kTile, width), std::min(y0 + LampPlan::kTile, height)},
        settings, trace);
  });
  return plan;
}

LampTile LampLight::State::TileAt(const LampLight& light, const MovingCamera& camera,
                                  const std::array<int, 4>& box, const LampSettings& settings,
                                  const Trace& trace) const {
  const double pixel = camera.middle().PixelAngle();
  const TileRays rays(camera, box[0], box[1], box[2], box[3], trace);
  LampTile tile;
  for (const std::uint32_t node : Cut(nodes, roots, settings, [&](std::uint32_t i) {
         return WeighInAir(nodes[i], i, rays, eye, pixel);
       })) {
    (IsFar(nodes[node], rays, pixel) ? tile.far_air : tile.near_air).push_back(node);
  }
  if (rays.surface) {
    tile.surface = Cut(nodes, roots, settings,
                       [&](std::uint32_t i) { return WeighOnSurface(nodes[i], i, rays); });
  }
  for (std::uint32_t i = 0; i < lamps; ++i) {
    const PlacedLamp& lamp = nodes[i].light;
    const bool is_within = lamp.distance_m <= lamp.lamp.radius_m;
    if (is_within || glm::length(lamp.direction - rays.middle()) <
                         rays.radius_rad + lamp.blur + lamp.lamp.radius_m / lamp.distance_m) {
      tile.seen.push_back(i);
    }
  }
  if (tile.far_air.empty()) return tile;
  for (int j = 0; j < LampPlan::kLattice; ++j) {
    for (int i = 0; i < LampPlan::kLattice; ++i) {
      const CameraRay ray = camera.middle().MiddleRay(box[0] + LampPlan::kSpacing * i,
                                                      box[1] + LampPlan::kSpacing * j);
      const LampRayEnd end{ray.direction, trace(ray)};
      tile.lattice.push_back(light.InAir(tile.far_air, end, pixel, settings.nodes));
      tile.lattice_length_m.push_back(
          AllLit(tile.far_air, end) ? end.length_m : std::numeric_limits<double>::quiet_NaN());
    }
  }
  return tile;
}

bool LampLight::State::AllLit(const LampNodes& members, const LampRayEnd& ray) const {
  return std::all_of(members.begin(), members.end(), [&](std::uint32_t i) {
    const double reach = Reach(nodes[i].light, ray.length_m);
    const auto pieces = LitPieces(nodes[i].light, ray.direction, reach);
    return pieces.size() == 1 && pieces[0][0] == 0.0 && pieces[0][1] == reach;
  });
}

Bands<float> LampLight::InAir(const LampPlan& plan, int x, int y, const LampRayEnd& ray,
                              double pixel_angle_rad, int nodes) const {
  const LampTile& tile = plan.At(x, y);
  Bands<float> sum = InAir(tile.near_air, ray, pixel_angle_rad, nodes);
  if (tile.far_air.empty()) return sum;
  const double u = (x % LampPlan::kTile + 0.5) / LampPlan::kSpacing;
  const double v = (y % LampPlan::kTile + 0.5) / LampPlan::kSpacing;
  const int i = static_cast<int>(u), j = static_cast<int>(v);
  const double p = u - i, q = v - j;
  const auto corner = static_cast<std::size_t>(j * LampPlan::kLattice + i);
  const std::array<std::size_t, 4> at{corner, corner + 1, corner + LampPlan::kLattice,
                                      corner + LampPlan::kLattice + 1};
  const std::array<double, 4> weight{(1.0 - p) * (1.0 - q), p * (1.0 - q), (1.0 - p) * q, p * q};
  // Rays that end alike: all in the sky, or on a surface that is smooth from point to point.
  constexpr double kAlike = 1.15;
  const bool smooth = std::all_of(at.begin(), at.end(), [&](std::size_t k) {
    const double length = tile.lattice_length_m[k];
    return length == ray.length_m ||
           (length < kAlike * ray.length_m && ray.length_m < kAlike * length &&
            !std::isinf(length) && !std::isinf(ray.length_m));
  });
  if (!smooth) {
    const Bands<float> far = InAir(tile.far_air, ray, pixel_angle_rad, nodes);
    for (std::size_t band = 0; band < sum.count; ++band) sum[band] += far[band];
    return sum;
  }
  for (std::size_t k = 0; k < at.size(); ++k) {
    for (std::size_t band = 0; band < sum.count; ++band) {
      sum[band] += static_cast<float>(weight[k]) * tile.lattice[at[k]][band];
    }
  }
  return sum;
}

}  // namespace alpenglow
