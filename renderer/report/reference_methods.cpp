// SPDX-License-Identifier: MIT
#include "renderer/report/reference_methods.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/math/axes_across.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/reference/airlight_reference.h"
#include "atmosphere/time_place/geodesy.h"
#include "renderer/camera/camera_rays.h"

namespace alpenglow::renderer {

ShaftView ViewWithSun(double eye_height_m, double heading_deg, double sun_elevation_deg, int width,
                      int height) {
  const CameraRays camera(CameraFromDegrees({eye_height_m, false}, heading_deg, 0.0, 0.0, 70.0),
                          width, height);
  ShaftView view{
      {0.0, 0.0, eye_height_m},
      EnuFromAngles(sun_elevation_deg * kRadiansPerDegree, (heading_deg + 20.0) * kRadiansPerDegree)
          .xyz,
      0.265 * kRadiansPerDegree,
      {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) view.directions.push_back(camera.Direction(x + 0.5, y + 0.5));
  }
  return view;
}

ViewRay RayOf(const ShaftView& view, std::size_t i, double length_m) {
  const glm::dvec3& d = view.directions[i];
  return {view.eye.z, d.z, view.to_sun.z, std::clamp(glm::dot(d, view.to_sun), -1.0, 1.0),
          length_m};
}

double LengthOf(const ShaftView& view, std::size_t i, const Terrain& terrain) {
  const auto hit = terrain.Intersect(view.eye, view.directions[i]);
  return hit ? hit->distance_m : std::numeric_limits<double>::infinity();
}

double RadiusOfLight(double share) {
  constexpr double kDarkening = 0.6;
  double low = 0.0;
  double high = 1.0;
  for (int step = 0; step < 40; ++step) {
    const double rho = 0.5 * (low + high);
    const double inner = 1.0 - rho * rho;
    const double light = ((1.0 - kDarkening) * rho * rho +
                          kDarkening * 2.0 / 3.0 * (1.0 - inner * std::sqrt(inner))) /
                         (1.0 - kDarkening / 3.0);
    (light < share ? low : high) = rho;
  }
  return 0.5 * (low + high);
}

const std::vector<DiskPoint>& DiskPoints() {
  static const auto kPoints = [] {
    std::vector<DiskPoint> points;
    for (int n = 1; n <= 4096; ++n) {
      points.push_back({RadiusOfLight(std::fmod(n * 0.7548776662466927, 1.0)),
                        2.0 * kPi * std::fmod(n * 0.5698402909980532, 1.0)});
    }
    return points;
  }();
  return kPoints;
}

std::vector<float> OccludedSunlight(const ShaftView& view, const glm::dvec3& direction,
                                    const Terrain& terrain, std::span<const double> distances_m,
                                    std::size_t first) {
  const auto [side, up] = AxesAcrossOf(view.to_sun);
  const std::vector<DiskPoint>& disk = DiskPoints();
  std::vector<float> light;
  for (std::size_t i = 0; i < distances_m.size(); ++i) {
    const auto [rho, angle] = disk[(first + i) % disk.size()];
    const glm::dvec3 to_disk = glm::normalize(
        view.to_sun + view.sun_radius_rad * rho * (std::cos(angle) * side + std::sin(angle) * up));
    const bool occluded = terrain.Occluded(view.eye + distances_m[i] * direction, {0.0, 0.0, 1.0},
                                           to_disk, std::numeric_limits<double>::infinity());
    light.push_back(occluded ? 0.0F : 1.0F);
  }
  return light;
}

ScatteredOnce<float> MarchWithOcclusion(const SingleScattering<float>& air, const ShaftView& view,
                                        std::size_t i, const Terrain& terrain, int count,
                                        double offset) {
  const ViewRay ray = RayOf(view, i, LengthOf(view, i, terrain));
  const Medium& medium = air.medium();
  const RayExtent extent = ExtentOf(ray, medium.planet_radius_m, medium.atmosphere_height_m);
  const double k = std::max(extent.end_m / 30e3 - 2.0, 0.0);
  std::vector<RayNode> nodes;
  std::vector<double> distances;
  for (int s = 0; s < count; ++s) {
    const double v = (s + offset) / count;
    const double bend = 1.0 + k * (1.0 - v);
    distances.push_back(extent.end_m * v / bend);
    nodes.push_back({distances.back(), extent.end_m * (1.0 + k) / (bend * bend) / count});
  }
  RaySamples<float> samples = air.SampleAt(ray, nodes);
  const auto light = OccludedSunlight(view, view.directions[i], terrain, distances,
                                      static_cast<std::size_t>(4096.0 * offset));
  for (std::size_t s = 0; s < light.size(); ++s) samples.lit[s] *= light[s];
  return air.Scatter(samples);
}

namespace {

double Logarithmic(double low, double high, double u) { return low * std::pow(high / low, u); }

/// Adds molecules and a little haze at 550 nm, as in the default air at the ground.
void AddClearAir(LampAir& air) {
  LampLayer molecules = air.layers[0];
  molecules.scale_height_m = 8000.0;
  molecules.scattering_per_m[0] = molecules.extinction_per_m[0] = 1.2e-5;
  molecules.phase = {.kind = PhaseKind::kRayleigh};
  LampLayer haze = air.layers[0];
  haze.scale_height_m = 1200.0;
  haze.scattering_per_m[0] = 3.8e-5;
  haze.extinction_per_m[0] = 4.2e-5;
  air.layers.push_back(molecules);
  air.layers.push_back(haze);
}

void MakeBeam(int i, Lamp& lamp) {
  lamp.profile.kind = LampProfile::Kind::kCone;
  lamp.profile.inner_rad = 0.05 + 0.3 * Halton(i, 17);
  lamp.profile.outer_rad = 0.1 + 0.6 * Halton(i, 17);
  const double z = 2.0 * Halton(i, 19) - 1.0;
  const double azimuth = 2.0 * kPi * Halton(i, 23);
  const double r = std::sqrt(1.0 - z * z);
  lamp.axis = {r * std::cos(azimuth), r * std::sin(azimuth), z};
  lamp.side = AxesAcrossOf(lamp.axis).side;
}

/// The ray relative to the lamp: its nearest point, and the distance there.
struct Approach {
  double nearest_m, distance_m;

  explicit Approach(const LampTestCase& work) {
    const glm::dvec3 to_lamp = work.lamp.position_m - work.segment.origin_m;
    nearest_m = glm::dot(to_lamp, work.segment.direction);
    distance_m =
        std::max(glm::length(to_lamp - nearest_m * work.segment.direction), work.lamp.radius_m);
  }
  [[nodiscard]] double Sinh(double t) const { return (t - nearest_m) / distance_m; }
};

/// Returns the light scattered per metre of the ray.
double SourceAt(const LampTestCase& work, const Approach& approach, double t) {
  const glm::dvec3 point = work.segment.origin_m + t * work.segment.direction;
  const double sinh = approach.Sinh(t);
  const double squared = 1.0 + sinh * sinh;
  double scattered = 0.0;
  for (const LampLayer& layer : work.air.layers) {
    scattered += layer.scattering_per_m[0] * layer.Density(work.air.AltitudeOf(point)) *
                 Phase(layer.phase, -sinh / std::sqrt(squared));
  }
  return scattered * TransmittanceBetween(work.air, work.segment.origin_m, point)[0] *
         TransmittanceBetween(work.air, point, work.lamp.position_m)[0] *
         RelativeIntensity(work.lamp, glm::normalize(point - work.lamp.position_m)) /
         (approach.distance_m * approach.distance_m * squared);
}

/// Position s on a ray as a function of a variable v, t = nearest + D s(v), and ds / dv.
struct Mapped {
  double s, slope;
};
double VariableOf(LampRule rule, double s) {
  switch (rule) {
    case LampRule::kUniform:
      return s;
    case LampRule::kEquiAngular:
      return std::atan(s);
    case LampRule::kHalfAngle:
      return std::tanh(0.5 * std::asinh(s));
    case LampRule::kAsinh:
      return std::asinh(s);
  }
  return s;
}
Mapped FromVariable(LampRule rule, double v) {
  switch (rule) {
    case LampRule::kUniform:
      return {v, 1.0};
    case LampRule::kEquiAngular:
      return {std::tan(v), 1.0 + std::tan(v) * std::tan(v)};
    case LampRule::kHalfAngle: {
      const double x = 2.0 * std::atanh(v);
      return {std::sinh(x), std::cosh(x) * 2.0 / ((1.0 - v) * (1.0 + v))};
    }
    case LampRule::kAsinh:
      return {std::sinh(v), std::cosh(v)};
  }
  return {v, 1.0};
}

}  // namespace

LampTestCase LampTestCaseNumber(int i, const LampTestKind& kind) {
  LampTestCase work;
  const double sigma = Logarithmic(1e-4, 0.1, Halton(i, 2));
  const double length = Logarithmic(10.0, 1000.0, Halton(i, 3));
  const double across = Logarithmic(0.1, 100.0, Halton(i, 5));
  const double along = kind.through ? length * Halton(i, 7) : length * (1.4 * Halton(i, 7) - 0.2);
  const double pitch = std::asin(2.0 * Halton(i, 11) - 1.0);
  const double turn = 2.0 * kPi * Halton(i, 13);
  work.air =
      HomogeneousAir(0.9 * sigma, sigma, {.kind = PhaseKind::kHenyeyGreenstein, .g = kind.g});
  work.air.layers[0].scale_height_m = kind.scale_height_m;
  if (kind.clear_air) AddClearAir(work.air);
  const glm::dvec3 forward(std::cos(pitch), 0.0, std::sin(pitch));
  const glm::dvec3 lift(-std::sin(pitch), 0.0, std::cos(pitch));
  const glm::dvec3 off = std::cos(turn) * lift + std::sin(turn) * glm::dvec3(0.0, 1.0, 0.0);
  // The altitude at which sigma is given is the lowest of the test case.
  work.segment = {glm::dvec3(0.0), forward, 0.0, length};
  work.lamp.position_m = along * forward + (kind.through ? 0.0 : across) * off;
  if (kind.through) work.lamp.radius_m = 0.1;
  work.air.altitude_at_origin_m = -std::min({0.0, length * forward.z, work.lamp.position_m.z});
  if (kind.beam) MakeBeam(i, work.lamp);
  const reference::LampLight reference =
      reference::AirlightAlong(work.air, work.lamp, work.segment);
  work.truth = reference.radiance[0];
  work.converged = reference.converged;
  return work;
}

double AirlightByRule(LampRule rule, const LampTestCase& work, int nodes) {
  const Approach approach(work);
  const double low = VariableOf(rule, approach.Sinh(work.segment.begin_m));
  const double high = VariableOf(rule, approach.Sinh(work.segment.end_m));
  double sum = 0.0;
  const auto add = [&](double share, double weight) {
    const Mapped at = FromVariable(rule, low + (high - low) * share);
    sum += weight * (high - low) * at.slope * approach.distance_m *
           SourceAt(work, approach, approach.nearest_m + approach.distance_m * at.s);
  };
  if (rule == LampRule::kUniform || rule == LampRule::kEquiAngular) {
    for (int i = 0; i < nodes; ++i) add((i + 0.5) / nodes, 1.0 / nodes);
  } else {
    const GaussRule& gauss = GaussLegendre(nodes);
    for (std::size_t i = 0; i < gauss.node.size(); ++i) add(gauss.node[i], gauss.weight[i]);
  }
  return sum;
}

double SunFunction(double u, double v) {
  // With xi = atan y the integrand is exp(-u y) / (1 + y^2); beyond u y = 40 it is negligible.
  const double end = u > 0.0 ? std::min(v, std::atan(40.0 / u)) : v;
  const std::array<double, 3> panels{0.0, std::min(0.5 * end, std::atan(1.0 / std::max(u, 1e-3))),
                                     end};
  const auto integrand = [u](double xi) { return std::array{std::exp(-u * std::tan(xi))}; };
  return IntegrateAdaptively(integrand, 1, panels, 1e-13).value[0];
}

double AirlightOfSun2005(double scattering_per_m, double extinction_per_m, double length_m,
                         double along_m, double across_m) {
  const double distance = std::hypot(along_m, across_m);
  const double gamma = std::atan2(across_m, along_m);
  const double u = extinction_per_m * across_m;
  const double v_end = std::isinf(length_m)
                           ? 0.5 * kPi
                           : 0.25 * kPi + 0.5 * std::atan((length_m - along_m) / across_m);
  return scattering_per_m / (2.0 * kPi * across_m) *
         std::exp(-extinction_per_m * distance * std::cos(gamma)) *
         (SunFunction(u, v_end) - SunFunction(u, 0.5 * gamma));
}

OctaveLight OctaveSunlight(const CloudField& field, const CloudSunMap& map, double g,
                           const CloudRay& ray, const CloudOctaves& octaves) {
  constexpr double kStepDepth = 0.25, kLeastStep_m = 2.0, kMostStep_m = 20.0;
  constexpr double kLeastTransmittance = 1e-3;
  struct Octave {
    double factor;  // b^i w p(nu; c^i g)
    double attenuation;
  };
  const double nu = std::clamp(glm::dot(ray.direction, map.to_sun()), -1.0, 1.0);
  std::vector<Octave> each;
  for (int i = 0; i < octaves.count; ++i) {
    const PhaseFunction phase{.kind = PhaseKind::kHenyeyGreenstein,
                              .g = g * std::pow(octaves.eccentricity, i)};
    each.push_back(
        {std::pow(octaves.contribution, i) * field.single_scattering_albedo() * Phase(phase, nu),
         std::pow(octaves.attenuation, i)});
  }
  OctaveLight light;
  const CloudTracker tracker(field, false);
  tracker.EachSpan(ray, kFarthestCloud_m, [&](double begin_m, double end_m, double) {
    for (double at_m = begin_m; at_m < end_m && light.transmittance > kLeastTransmittance;) {
      const double per_m = std::max(tracker.Extinction_per_m(ray.At(at_m)), 1e-9);
      const double step_m = std::min(std::clamp(kStepDepth / per_m, kLeastStep_m, kMostStep_m),
                                     std::max(end_m - at_m, 1e-6));
      const glm::dvec3 middle = ray.At(at_m + 0.5 * step_m);
      at_m += step_m;
      const double depth = step_m * tracker.Extinction_per_m(middle);
      if (depth <= 0.0) continue;
      const double to_sun = OpticalDepthToSun(field, map, middle);
      const double left = std::exp(-depth);
      for (const auto& [factor, attenuation] : each) {
        light.sun += light.transmittance * (1.0 - left) * factor * std::exp(-attenuation * to_sun);
      }
      light.transmittance *= left;
    }
    return light.transmittance > kLeastTransmittance;
  });
  return light;
}

}  // namespace alpenglow::renderer
