// SPDX-License-Identifier: MIT
#include "renderer/lamps/placed_lamp.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>

#include "atmosphere/base/error.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/lamp/lamp.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "renderer/surface/inside_planet.h"
#include "renderer/surface/scene_geometry.h"

namespace alpenglow::renderer {
namespace {

SpectrumOf<double> OneBand(const SpectrumOf<double>& all, std::size_t band) {
  SpectrumOf<double> one(1);
  one[0] = all[band];
  return one;
}

/// Returns the mean over all directions, by quadrature around the axis.
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

glm::dvec3 PositionOf(const LampStage& stage, const Light& light, std::size_t number) {
  Place place = light.place;
  if (!light.height.above_ground) place.height_m = light.height.value_m;
  glm::dvec3 position = stage.ground().frame.EnuFromGeodetic(place).xyz;
  const std::optional<Terrain>& terrain = stage.ground().terrain;
  const auto over =
      terrain ? GroundHeightsAlong(*terrain, position, {0.0, 0.0, 1.0}) : std::nullopt;
  if (light.height.above_ground) {
    position.z += (over ? over->highest_m : 0.0) + light.height.value_m;
  } else if (over && over->lowest_m > 0.0) {
    throw InputError(fmt::format("light {}: height_m is {}; the ground there is at {:.1f} m",
                                 number + 1, light.height.value_m, position.z + over->lowest_m));
  }
  return position;
}

LampProfile ProfileOf(const Light& light, const MeasuredLamps& measured) {
  LampProfile profile;
  if (light.type == Light::Type::kSpot) {
    profile.kind = LampProfile::Kind::kCone;
    profile.inner_rad = light.inner_rad;
    profile.outer_rad = light.outer_rad;
  }
  if (light.ies) {
    profile.kind = LampProfile::Kind::kTable;
    profile.table = measured.at(light.ies->string()).table;
  }
  return profile;
}

// A lamp is measured pointing straight down; its pitch tilts it from there.
double CandelaOf(const Light& light, std::size_t number, const MeasuredLamps& measured) {
  if (light.intensity_cd) return *light.intensity_cd;
  const IesLamp& lamp = measured.at(light.ies->string());
  try {
    return lamp.intensity_cd * lamp.tilt.FactorAt(90.0 + light.pitch_rad / kRadiansPerDegree);
  } catch (const InputError& error) {
    throw InputError(fmt::format("light {}: {} {}", number + 1, light.ies->string(), error.what()));
  }
}

// Aims a lamp by heading and pitch. The angle C of a measured lamp is 0 above the axis of a
// horizontal lamp, and towards the heading for one that points down; it increases to the left.
Lamp Aimed(const Light& light, Lamp lamp) {
  const double heading = light.heading_rad, pitch = light.pitch_rad;
  const glm::dvec3 ahead(std::sin(heading), std::cos(heading), 0.0);
  const glm::dvec3 up(0.0, 0.0, 1.0);
  lamp.axis = std::cos(pitch) * ahead + std::sin(pitch) * up;
  lamp.side = -std::sin(pitch) * ahead + std::cos(pitch) * up;
  return lamp;
}

}  // namespace

MeasuredLamps MeasuredLampsOf(const std::vector<Light>& lights) {
  MeasuredLamps measured;
  for (const Light& light : lights) {
    if (!light.ies || light.intensity_cd == 0.0) continue;
    const auto [found, is_new] = measured.try_emplace(light.ies->string());
    if (is_new) found->second = ReadIes(*light.ies);
  }
  return measured;
}

PlacedLamp PlacedOn(const LampStage& stage, const Light& light, std::size_t number,
                    const MeasuredLamps& measured) {
  PlacedLamp placed;
  placed.lamp.position_m = PositionOf(stage, light, number);
  placed.lamp.radius_m = light.radius_m;
  placed.lamp = Aimed(light, placed.lamp);
  placed.lamp.profile = ProfileOf(light, measured);
  placed.candela = CandelaOf(light, number, measured);
  placed.above_ground_m = stage.HeightOverGround(placed.lamp.position_m);
  placed.mean_share = MeanOverDirections(placed.lamp.profile);
  return placed;
}

Spectrum LampIntensity(double temperature_k, double candela,
                       const std::vector<double>& wavelengths_nm, const BandColour& colour) {
  std::vector<double> spectrum;
  for (const double nm : wavelengths_nm) spectrum.push_back(BlackBodyRadiance(nm, temperature_k));
  const double luminous = colour.Xyz(spectrum)[1];
  if (!(luminous > 0.0)) {
    throw InputError(fmt::format(
        "light.temperature_k: a black body of {} K has no luminous intensity on the {} wavelengths "
        "of the atmosphere, {} to {} nm; give another temperature, or more wavelengths from 380 to "
        "780 nm",
        temperature_k, wavelengths_nm.size(), wavelengths_nm.front(), wavelengths_nm.back()));
  }
  Spectrum intensity(spectrum.size());
  for (std::size_t band = 0; band < spectrum.size(); ++band) {
    intensity[band] = static_cast<float>(candela * spectrum[band] / luminous);
  }
  return intensity;
}

std::vector<PlacedLamp> PlacedLampsOf(const Scene& scene, const LampStage& stage,
                                      const Medium& medium, const BandColour& colour) {
  const MeasuredLamps measured = MeasuredLampsOf(scene.lights);
  std::vector<PlacedLamp> lamps;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    if (light.intensity_cd == 0.0) continue;
    PlacedLamp lamp = PlacedOn(stage, light, i, measured);
    lamp.intensity =
        LampIntensity(light.temperature_k, lamp.candela, medium.wavelengths_nm, colour);
    lamps.push_back(std::move(lamp));
  }
  return lamps;
}

PlacedLamp Before(const LampEye& eye, const LampStage& stage, PlacedLamp placed) {
  constexpr double kAtTheEye_m = 1e-6;
  const glm::dvec3 to_lamp = placed.lamp.position_m - eye.at;
  const double distance_m = glm::length(to_lamp);
  placed.distance_m = std::max(distance_m, kAtTheEye_m);
  // A lamp at the eye has no direction; choose an arbitrary one.
  placed.direction = distance_m > kAtTheEye_m ? to_lamp / distance_m : -placed.lamp.axis;
  placed.air = stage.AirAround(0.5 * (eye.at + placed.lamp.position_m));
  placed.middle_air = placed.air;
  for (LampLayer& layer : placed.middle_air.layers) {
    layer.scattering_per_m = OneBand(layer.scattering_per_m, stage.bands() / 2);
    layer.extinction_per_m = OneBand(layer.extinction_per_m, stage.bands() / 2);
  }
  placed.blur = eye.lens ? eye.lens->BlurRadius(to_lamp) : 0.0;
  placed.towards_eye = Spectrum(stage.bands());
  return placed;
}

PlacedLamp ShiningOn(const LampEye& eye, const LampStage& stage, PlacedLamp placed) {
  placed = Before(eye, stage, std::move(placed));
  placed.is_hidden = !stage.Sees(placed.lamp.position_m, eye.at);
  placed.towards_eye =
      Scaled(placed.intensity, TransmittanceBetween(placed.air, eye.at, placed.lamp.position_m),
             RelativeIntensity(placed.lamp, -placed.direction));
  return placed;
}

LampAlongRay AlongRay(const PlacedLamp& placed, const glm::dvec3& direction,
                      double pixel_angle_rad) {
  constexpr double kPixelMean = 0.2836;
  constexpr double kDiskMean = 0.5;
  LampAlongRay along{placed.lamp};
  const double angle = std::max(kPixelMean * pixel_angle_rad, kDiskMean * placed.blur);
  along.lamp.radius_m = std::max(placed.lamp.radius_m, angle * placed.distance_m);
  // Inside the lamp, a ray has the direction of the lamp's light, so the intensity is constant
  // along it.
  if (placed.HoldsEye()) {
    along.share = RelativeIntensity(placed.lamp, direction);
    along.lamp.profile = {};
  }
  return along;
}

double Reach(const PlacedLamp& placed, double length_m) {
  return std::min(length_m, 4.0 * placed.distance_m + 20e3);
}

std::vector<std::array<double, 2>> PiecesLitBy(const PlacedLamp& placed, const LampStage& stage,
                                               const glm::dvec3& eye, const glm::dvec3& direction,
                                               double length_m) {
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
    return stage.Sees(placed.lamp.position_m, eye + 0.9999 * distance(theta) * direction);
  };
  constexpr int kSteps = 12;
  std::array<bool, kSteps + 1> lit_at{};
  for (int i = 0; i <= kSteps; ++i)
    lit_at.at(static_cast<std::size_t>(i)) = is_lit(low + (high - low) * i / kSteps);
  const bool all_lit = std::all_of(lit_at.begin(), lit_at.end(), [](bool lit) { return lit; });
  if (all_lit && !stage.ground().terrain) return {{0.0, length_m}};
  std::vector<std::array<double, 2>> pieces;
  double begin = low;
  bool lit = lit_at.front();
  for (int i = 1; i <= kSteps; ++i) {
    double from = low + (high - low) * (i - 1) / kSteps;
    double to = low + (high - low) * i / kSteps;
    if (lit_at.at(static_cast<std::size_t>(i)) == lit) continue;
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

double SeenPerSr(const PlacedLamp& placed, const LampStage& stage, const LampEye& eye,
                 const CameraRay& ray, double pixel_angle_rad) {
  const double radius = std::max(placed.lamp.radius_m / placed.distance_m, 0.9 * pixel_angle_rad);
  const glm::dvec3 way = placed.lamp.position_m - ray.eye;
  if (eye.lens) {
    const auto blur = eye.lens->BlurAt(way, ray.through, radius);
    if (!blur) return 0.0;
    // A point in focus is seen by the whole lens, a blurred one by a single point of the lens.
    const glm::dvec3 seen_from = placed.blur > radius ? ray.eye + blur->on_lens : ray.origin;
    return stage.Sees(placed.lamp.position_m, seen_from) ? blur->per_sr : 0.0;
  }
  const double off = glm::length(ray.direction - glm::normalize(way)) / radius;
  if (off >= 1.0 || placed.is_hidden) return 0.0;
  return shared::SoftDiskPerSr(off, radius);
}

Spectrum SeenFromWithin(const PlacedLamp& placed, const CameraRay& ray) {
  const double radius = placed.lamp.radius_m;
  return Scaled(placed.intensity,
                TransmittanceBetween(placed.air, ray.eye, ray.eye + radius * ray.direction),
                RelativeIntensity(placed.lamp, -ray.direction) / (kPi * radius * radius));
}

Spectrum Scaled(const Spectrum& intensity, const SpectrumOf<double>& factor, double scale) {
  Spectrum scaled(intensity.size());
  for (std::size_t band = 0; band < scaled.size(); ++band) {
    scaled[band] = intensity[band] * static_cast<float>(scale * factor[band]);
  }
  return scaled;
}

}  // namespace alpenglow::renderer
