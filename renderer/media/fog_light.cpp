// SPDX-License-Identifier: MIT
#include "renderer/media/fog_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/ray/shell.h"
#include "lut/multiple_scattering/spherical_harmonics.h"
#include "renderer/layer.h"
#include "renderer/surface/scene_geometry.h"

namespace alpenglow::renderer {

double SlabField::DownwardFlux() const { return kPi * (mean + 2.0 / 3.0 * slope); }
double SlabField::UpwardFlux() const { return kPi * (mean - 2.0 / 3.0 * slope); }

namespace {

/// Returns the fraction of the scattered light that is in the forward peak. A lobe that scatters
/// backwards has none, although its second coefficient is positive.
double ForwardPeak(const SlabScattering& scattering) {
  return std::clamp(scattering.chi_1, 0.0, std::max(scattering.chi_2, 0.0));
}

}  // namespace

EddingtonSlab::EddingtonSlab(const SlabScattering& scattering, double depth, double ground_albedo,
                             double mu0) {
  ALPENGLOW_ENSURE(depth, >=, 0.0);
  ALPENGLOW_ENSURE(mu0, >, 0.0);
  ALPENGLOW_ENSURE(scattering.chi_2, <, 1.0);
  // Without any absorption e^(k tau) and e^(-k tau) are the same solution. An absorption of a
  // millionth separates them, and removes a millionth of the light per unit of depth.
  constexpr double kMostAlbedo = 1.0 - 1e-6;
  const double w_true = std::min(scattering.albedo, kMostAlbedo);
  const double f = ForwardPeak(scattering);
  scale_ = 1.0 - w_true * f;
  const double w = w_true * (1.0 - f) / scale_;
  // Eddington's phase function 1 + 3 g mu sends more light back than arrives if g is below -2/3 and
  // the beam is vertical.
  const double g = std::max((scattering.chi_1 - f) / (1.0 - f), -2.0 / 3.0);
  depth_ = scale_ * depth;
  k_ = std::sqrt(3.0 * (1.0 - w) * (1.0 - w * g));
  slope_of_k_ = k_ / (1.0 - w * g);
  // If the beam decays like the diffuse light, the particular solution has a pole that the boundary
  // conditions cancel.
  mu0_ = std::abs(k_ * mu0 - 1.0) < 1e-4 ? (1.0 - 1e-4) / k_ : mu0;
  const double source = w / (4.0 * kPi);
  particular_ = 3.0 * mu0_ * mu0_ * source * (1.0 + g - w * g) / (k_ * k_ * mu0_ * mu0_ - 1.0);
  particular_slope_ = 3.0 * mu0_ * ((1.0 - w) * particular_ - source);
  // Boundary conditions: no diffuse light from above, the ground's reflection from below.
  const double across = std::exp(-k_ * depth_);
  const double beam = std::exp(-depth_ / mu0_);
  const double top_falling = 1.0 + 2.0 / 3.0 * slope_of_k_;
  const double top_rising = (1.0 - 2.0 / 3.0 * slope_of_k_) * across;
  const double top = -(particular_ + 2.0 / 3.0 * particular_slope_);
  const double up = 1.0 - ground_albedo, down = 2.0 / 3.0 * (1.0 + ground_albedo);
  const double bottom_falling = (up - down * slope_of_k_) * across;
  const double bottom_rising = up + down * slope_of_k_;
  const double bottom =
      ground_albedo * mu0_ * beam / kPi - (up * particular_ - down * particular_slope_) * beam;
  const double determinant = top_falling * bottom_rising - top_rising * bottom_falling;
  falling_ = (top * bottom_rising - top_rising * bottom) / determinant;
  rising_ = (top_falling * bottom - bottom_falling * top) / determinant;
}

SlabField EddingtonSlab::At(double depth) const {
  const double tau = std::clamp(scale_ * depth, 0.0, depth_);
  const double falling = falling_ * std::exp(-k_ * tau);
  const double rising = rising_ * std::exp(-k_ * (depth_ - tau));
  const double beam = std::exp(-tau / mu0_);
  return {falling + rising + particular_ * beam,
          slope_of_k_ * (falling - rising) + particular_slope_ * beam};
}

double EddingtonSlab::BeamLeft(double slant_depth) const { return std::exp(-scale_ * slant_depth); }

namespace {

/// Skylight is attenuated in fog like a beam of this zenith cosine: the diffusivity factor 1.66 of
/// Elsasser (1942).
constexpr double kSkyCosine = 0.6;
constexpr int kGlowNodes = 65;

BandLight NotNegative(BandLight light) {
  for (std::size_t band = 0; band < light.count; ++band) {
    light[band] = std::max(light[band], 0.0F);
  }
  return light;
}

std::vector<double> AltitudesOver(double bottom_m, const FogLayer& layer) {
  constexpr double kEndless_m = 8000.0;
  const double step = std::isinf(layer.scale_height_m()) ? kEndless_m : layer.scale_height_m();
  std::vector<double> altitudes;
  for (const double share : {0.0, 0.5, 1.0, 2.0, 4.0, 8.0}) {
    altitudes.push_back(bottom_m + share * step);
  }
  return altitudes;
}

}  // namespace

FogLight::FogLight(const LocalMedium& fog, const MultipleScattering& diffuse,
                   const LightDirection& light, const BandLight& in_air, double bottom_m)
    : fog_(fog),
      to_light_(light.seen),
      chi_(LegendreCoefficients(fog.optics.phase, diffuse.options().degree)),
      extinction_per_m_(fog.optics.extinction_per_m[0]),
      depth_(extinction_per_m_ * fog.fog()->ColumnAbove(bottom_m)),
      sky_(diffuse, {0.0, 0.0, 1.0}, light.for_air, AltitudesOver(bottom_m, *fog.fog())),
      ground_(diffuse.bands()) {
  const double albedo = fog.optics.scattering_per_m[0] / extinction_per_m_;
  peak_scale_ = 1.0 - albedo * ForwardPeak({albedo, chi_[1], chi_[2]});
  broad_.kind = PhaseKind::kHenyeyGreenstein;
  broad_.g = std::clamp(chi_[1], -0.99, 0.99);
  const BandLight sky = diffuse.SkyIrradiance(std::max(bottom_m, 0.0), sky_.mu_s());
  const std::vector<double>& ground_albedo = diffuse.medium().ground_albedo;
  for (std::size_t band = 0; band < ground_.count; ++band) {
    ground_[band] = static_cast<float>(ground_albedo[band] / kPi) *
                    (static_cast<float>(std::max(to_light_.z, 0.0)) * in_air[band] + sky[band]);
  }
  sky_ = sky_.WithoutGround(ground_);
  // This is the cosine for which the plane layer is as deep towards the sun as the layer over a
  // round planet.
  const FogLayer& layer = *fog.fog();
  const double slant =
      layer.ColumnToSpace({0.0, 0.0, bottom_m}, to_light_) / layer.ColumnAbove(bottom_m);
  Solve(albedo, std::clamp(1.0 / slant, 1e-3, 1.0), in_air, sky, ground_albedo);
}

void FogLight::Solve(double albedo, double mu0, const BandLight& sun, const BandLight& sky,
                     const std::vector<double>& ground_albedo) {
  const SlabScattering scattering{albedo, chi_[1], chi_[2]};
  for (Glow* glow : {&of_sun_, &of_sky_}) {
    glow->mean.assign(kGlowNodes, BandLight(sun.count));
    glow->slope.assign(kGlowNodes, BandLight(sun.count));
  }
  for (std::size_t band = 0; band < sun.count; ++band) {
    const EddingtonSlab under_sun(scattering, depth_, ground_albedo[band], mu0);
    const EddingtonSlab under_sky(scattering, depth_, ground_albedo[band], kSkyCosine);
    const auto beam = static_cast<double>(sun[band]);
    const double sky_beam = static_cast<double>(sky[band]) / kSkyCosine;
    for (std::size_t i = 0; i < kGlowNodes; ++i) {
      const double u = static_cast<double>(i) / (kGlowNodes - 1);
      const SlabField sunny = under_sun.At(depth_ * u * u * u * u);
      const SlabField dull = under_sky.At(depth_ * u * u * u * u);
      of_sun_.mean[i][band] = static_cast<float>(beam * sunny.mean);
      of_sun_.slope[i][band] = static_cast<float>(beam * sunny.slope);
      of_sky_.mean[i][band] = static_cast<float>(sky_beam * dull.mean);
      of_sky_.slope[i][band] = static_cast<float>(sky_beam * dull.slope);
    }
  }
}

double FogLight::DepthAbove(double altitude_m) const {
  return std::min(extinction_per_m_ * fog_.fog()->ColumnAbove(altitude_m), depth_);
}

FogLight::Place FogLight::PlaceOf(double altitude_m) const {
  const double u =
      depth_ > 0.0 ? (kGlowNodes - 1) * std::sqrt(std::sqrt(DepthAbove(altitude_m) / depth_)) : 0.0;
  const double low = std::min(std::floor(u), kGlowNodes - 2.0);
  return {static_cast<std::size_t>(low), static_cast<float>(u - low)};
}

BandLight FogLight::At(const std::vector<BandLight>& nodes, const Place& place) {
  return (1.0F - place.share) * nodes[place.low] + place.share * nodes[place.low + 1];
}

FogLight::Look FogLight::LookAlong(const glm::dvec3& look) const {
  const double cosine = glm::dot(look, to_light_);
  return {Phase(fog_.optics.phase, cosine), Phase(broad_, cosine), look.z,
          sky_.Towards(look, chi_)};
}

FogLight::Scattered FogLight::At(const Look& look, double altitude_m, const BandLight& sun,
                                 const BandLight& lit, double slant_depth) const {
  const double direct = std::exp(-slant_depth);
  const double taken_along = std::exp(-peak_scale_ * slant_depth) - direct;
  const auto once = static_cast<float>(look.phase * direct + look.broad_phase * taken_along);
  // Light that reaches the eye travels against the viewing direction: downwards if the view goes
  // upwards.
  const auto tilt = static_cast<float>(chi_[1] * look.down);
  const Place place = PlaceOf(altitude_m);
  return {once * sun + lit * Field(of_sun_, place, tilt),
          SkyLeft(altitude_m) * NotNegative(sky_.At(look.sky, altitude_m)) +
              Field(of_sky_, place, tilt)};
}

// At the edge of a layer, a radiance that is linear in the cosine is negative in directions from
// which no light arrives.
BandLight FogLight::Field(const Glow& glow, const Place& place, float tilt) {
  return NotNegative(At(glow.mean, place) + tilt * At(glow.slope, place));
}

float FogLight::SkyLeft(double altitude_m) const {
  return static_cast<float>(std::exp(-peak_scale_ * DepthAbove(altitude_m) / kSkyCosine));
}

float FogLight::BeamLeft(double slant_depth) const {
  return static_cast<float>(std::exp(-peak_scale_ * slant_depth));
}

BandLight FogLight::OnSurface(double altitude_m, double cos_up) const {
  const Place place = PlaceOf(altitude_m);
  const auto tilt = static_cast<float>(2.0 * kPi / 3.0 * cos_up);
  BandLight irradiance =
      static_cast<float>(kPi) * (At(of_sun_.mean, place) + At(of_sky_.mean, place)) +
      tilt * (At(of_sun_.slope, place) + At(of_sky_.slope, place));
  // The light of the ground is already part of the clear sky's irradiance of a slope.
  const auto twice = static_cast<float>(kPi * 0.5 * (1.0 - cos_up)) * SkyLeft(altitude_m);
  return NotNegative(irradiance + -twice * ground_);
}

namespace {

enum Quantity { kDirect, kBroad, kGlow, kSkyLight, kQuantities };

glm::vec4 InFloats(const BandLight& light) {
  glm::vec4 values(0.0F);
  for (std::size_t band = 0; band < light.count; ++band) {
    values[static_cast<glm::length_t>(band)] = light[band];
  }
  return values;
}

/// The four quantities, summed from the eye on.
using Sums = std::array<glm::vec4, kQuantities>;

class FogMarch {
 public:
  FogMarch(const LocalMedium& fog, double bottom_m, const SolvedAir& air, const FogView& view)
      : fog_(fog),
        layer_(*fog.fog()),
        air_(air),
        view_(view),
        radius_m_(air.medium().planet_radius_m),
        eye_(0.0, 0.0, std::max(view.altitude_m, 0.0)),
        light_(fog, air.multiple_scattering(), view.light, SunInAir(Head(bottom_m)), bottom_m) {}

  [[nodiscard]] const FogLight& light() const { return light_; }

  /// Returns the sums at fractions i / (depths - 1) of the light that the fog removes along the
  /// whole ray.
  [[nodiscard]] std::vector<Sums> Along(const glm::dvec3& direction, int depths) const {
    const std::vector<Step> steps = StepsOf(direction);
    std::vector<Sums> nodes(static_cast<std::size_t>(depths), Sums{});
    if (steps.empty()) return nodes;
    const double whole = steps.back().taken;
    Sums sum{}, before{};
    double taken = 0.0;
    std::size_t node = 1;
    const FogLight::Look look = light_.LookAlong(direction);
    for (const Step& step : steps) {
      before = sum;
      const Sums here = SourceAt(step, direction, look);
      for (std::size_t q = 0; q < sum.size(); ++q) {
        sum[q] += static_cast<float>(step.taken - taken) * here[q];
      }
      if (taken == 0.0) nodes[0] = here;
      const auto at = [&](std::size_t i) {
        return whole * static_cast<double>(i) / (depths - 1.0);
      };
      for (; node < nodes.size() && at(node) <= step.taken * (1.0 + 1e-9); ++node) {
        const auto share = static_cast<float>((at(node) - taken) / (step.taken - taken));
        for (std::size_t q = 0; q < sum.size(); ++q) {
          nodes[node][q] =
              (before[q] + share * (sum[q] - before[q])) / static_cast<float>(at(node));
        }
      }
      taken = step.taken;
    }
    return nodes;
  }

 private:
  struct Step {
    double middle_m;
    double taken;  // fraction of light that the fog removes up to the end of this step
  };

  [[nodiscard]] glm::dvec3 Head(double bottom_m) const {
    const double scale = layer_.scale_height_m();
    return {0.0, 0.0, bottom_m + (std::isinf(scale) ? 0.0 : scale)};
  }

  [[nodiscard]] BandLight SunInAir(const glm::dvec3& point) const {
    const double altitude = std::max(AltitudeOverSphere(point, radius_m_), 0.0);
    const glm::dvec3 up = glm::normalize(point + glm::dvec3(0.0, 0.0, radius_m_));
    const double mu_s = std::clamp(glm::dot(up, view_.light.seen), -1.0, 1.0);
    const VisibleDisk disk =
        DiskOverHorizon(mu_s, shared::HorizonCosine(altitude, radius_m_), view_.radius_rad);
    if (disk.fraction <= 0.0) return BandLight(air_.bands());
    return static_cast<float>(disk.fraction) * air_.BeamLeft(altitude, disk.mu_s_effective);
  }

  [[nodiscard]] double EndOf(const glm::dvec3& direction) const {
    if (shared::GroundClearance(eye_.z, direction.z, radius_m_) <= 0.0) {
      return std::numeric_limits<double>::infinity();
    }
    return shared::DistanceDownTo(eye_.z, direction.z, 0.0, radius_m_);
  }

  // Returns steps up to the distance at which the fog is opaque, so short that neither the light in
  // the fog nor its density changes much within one.
  [[nodiscard]] std::vector<Step> StepsOf(const glm::dvec3& direction) const {
    constexpr double kDepth = 0.1, kFall = 0.25, kOpaque = 12.0;
    constexpr double kShortest_m = 0.01;
    const double extinction = fog_.optics.extinction_per_m[0];
    std::vector<Step> steps;
    double tau = 0.0;
    for (const DensePiece& piece : layer_.PiecesAlong(eye_, direction, EndOf(direction))) {
      for (double t = piece.begin_m; t < piece.end_m && tau < kOpaque;) {
        const glm::dvec3 point = eye_ + t * direction;
        const double rise =
            glm::dot(direction, glm::normalize(point + glm::dvec3(0, 0, radius_m_)));
        const double per_m = extinction * layer_.DensityAt(point);
        const double h = layer_.scale_height_m();
        const double by_fall =
            std::isinf(h) ? piece.end_m : kFall * h / std::max(std::abs(rise), 1e-3);
        double step = std::min({kDepth / per_m, by_fall, 0.05 * (piece.end_m - piece.begin_m)});
        step = std::min(std::max(step, kShortest_m), piece.end_m - t);
        const double middle = t + 0.5 * step;
        tau += step * extinction *
               (layer_.DensityAt(point) + 4.0 * layer_.DensityAt(eye_ + middle * direction) +
                layer_.DensityAt(eye_ + (t + step) * direction)) /
               6.0;
        steps.push_back({middle, -std::expm1(-tau)});
        t += step;
        if (piece.end_m - t < kShortest_m) break;
      }
    }
    return steps;
  }

  // Returns the light scattered at this step, attenuated by the air in front of it.
  [[nodiscard]] Sums SourceAt(const Step& step, const glm::dvec3& direction,
                              const FogLight::Look& look) const {
    const glm::dvec3 point = eye_ + step.middle_m * direction;
    const double altitude = AltitudeOverSphere(point, radius_m_);
    const double slant =
        fog_.optics.extinction_per_m[0] * layer_.ColumnToSpace(point, view_.light.seen);
    const BandLight sun = SunInAir(point);
    BandLight all(sun.count), none(sun.count);
    std::fill_n(all.value.begin(), all.count, 1.0F);
    const FogLight::Scattered glow = light_.At(look, altitude, none, all, slant);
    const auto direct = static_cast<float>(std::exp(-slant));
    const auto scattered =
        static_cast<float>(fog_.optics.scattering_per_m[0] / fog_.optics.extinction_per_m[0]);
    ViewRay ray{eye_.z, direction.z, 0.0, 0.0};
    ray.length_m = step.middle_m;
    ray.passes_ground = true;
    const BandLight left = scattered * air_.single_scattering().TransmittanceAlong(ray);
    return {InFloats(direct * (left * sun)),
            InFloats((light_.BeamLeft(slant) - direct) * (left * sun)),
            InFloats(left * glow.of_sun), InFloats(left * glow.of_sky)};
  }

  const LocalMedium& fog_;
  const FogLayer& layer_;
  SolvedAir air_;
  FogView view_;
  double radius_m_;
  glm::dvec3 eye_;
  FogLight light_;
};

// Returns the sine of the elevation for a position in [0, 1] on the axis, which is dense at the
// horizontal.
double FogElevationSine(double unit) {
  const double root = 2.0 * unit - 1.0;
  return root * std::abs(root);
}

void AddRays(const FogMarch& march, FogMap& map) {
  const FogMapSize& size = map.size;
  const double sun_azimuth = std::atan2(map.view.light.seen.y, map.view.light.seen.x);
  const auto at = [&](int quantity, int depth, int azimuth, int elevation) {
    return static_cast<std::size_t>(
        ((quantity * size.depths + depth) * size.azimuths + azimuth) * size.elevations + elevation);
  };
  map.light.resize(at(kQuantities, 0, 0, 0));
  for (int azimuth = 0; azimuth < size.azimuths; ++azimuth) {
    const double turn = sun_azimuth + kPi * azimuth / (size.azimuths - 1.0);
    for (int elevation = 0; elevation < size.elevations; ++elevation) {
      const double sine = FogElevationSine(elevation / (size.elevations - 1.0));
      const double cosine = std::sqrt(std::max(1.0 - sine * sine, 0.0));
      const std::vector<Sums> nodes =
          march.Along({cosine * std::cos(turn), cosine * std::sin(turn), sine}, size.depths);
      for (int depth = 0; depth < size.depths; ++depth) {
        for (int q = 0; q < kQuantities; ++q) {
          map.light[at(q, depth, azimuth, elevation)] =
              nodes[static_cast<std::size_t>(depth)][static_cast<std::size_t>(q)];
        }
      }
    }
  }
}

void AddSurfaces(const FogMarch& march, const FogLayer& layer, FogMap& map) {
  map.on_surface.resize(2 * std::size_t{FogMap::kHeights});
  for (int i = 0; i < FogMap::kHeights; ++i) {
    const double share = std::pow(std::max(i / (FogMap::kHeights - 1.0), 1e-3), 4.0);
    const double column = share * map.depth / map.extinction_per_m;
    const double altitude =
        std::isinf(layer.scale_height_m())
            ? map.top_m - column
            : map.base_m - layer.scale_height_m() * std::log(column / layer.scale_height_m());
    const glm::vec4 level = InFloats(march.light().OnSurface(altitude, 1.0));
    map.on_surface[static_cast<std::size_t>(i)] = level;
    map.on_surface[static_cast<std::size_t>(FogMap::kHeights + i)] =
        InFloats(march.light().OnSurface(altitude, 0.0)) - level;
  }
}

}  // namespace

FogMap MakeFogMap(const LocalMedium& fog, double bottom_m, const SolvedAir& air,
                  const FogView& view, const FogMapSize& size) {
  ALPENGLOW_ENSURE(air.bands(), <=, std::size_t{4});
  const FogLayer& layer = *fog.fog();
  const FogMarch march(fog, bottom_m, air, view);
  const std::vector<double> chi = LegendreCoefficients(fog.optics.phase, 2);
  FogMap map;
  map.view = view;
  map.size = size;
  map.extinction_per_m = fog.optics.extinction_per_m[0];
  map.scale_height_m = layer.scale_height_m();
  map.base_m = layer.base_m();
  map.top_m = air.medium().atmosphere_height_m;
  map.radius_m = air.medium().planet_radius_m;
  map.depth = map.extinction_per_m * layer.ColumnAbove(bottom_m);
  map.peak_scale = -std::log(static_cast<double>(march.light().BeamLeft(1.0)));
  map.phase = fog.optics.phase;
  map.broad_g = std::clamp(chi[1], -0.99, 0.99);
  AddRays(march, map);
  AddSurfaces(march, layer, map);
  return map;
}

bool Serves(const FogView& made, const FogView& wanted, double scale_height_m) {
  constexpr double kSun_rad = 0.1 * 3.14159265358979 / 180.0;
  const double step_m = 0.1 * std::min(scale_height_m, 1000.0);
  return std::abs(made.altitude_m - wanted.altitude_m) <= step_m &&
         glm::length(made.light.seen - wanted.light.seen) <= kSun_rad;
}

}  // namespace alpenglow::renderer
