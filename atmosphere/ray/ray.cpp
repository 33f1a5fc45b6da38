// SPDX-License-Identifier: MIT
#include "atmosphere/ray/ray.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/ray/shell.h"

namespace alpenglow::atmosphere {
namespace {

using Extended = long double;

void RequireFinite(const ViewRay& ray, double planet_radius_m) {
  RequireInRange(ray.altitude_m, -0.5 * planet_radius_m, 1e12, "altitude_m");
  RequireInRange(ray.mu, -1.0, 1.0, "mu (cosine of the view zenith angle)");
  RequireInRange(ray.mu_s, -1.0, 1.0, "mu_s (cosine of the sun zenith angle)");
  RequireInRange(ray.nu, -1.0, 1.0, "nu (cosine between view and sun)");
  if (!(ray.length_m >= 0.0))
    throw InputError(fmt::format("length_m is {}; it must be >= 0", ray.length_m));
}

// Distances at which a line crosses the sphere of altitude z; none if it passes above.
struct Crossings {
  bool exist;
  Extended near, far;
};

Crossings CrossAltitude(Extended h, Extended mu, Extended z, Extended radius) {
  const Extended a = (radius + h) * mu;
  const Extended c = (h - z) * (2 * radius + h + z);
  const Extended discriminant = a * a - c;
  if (discriminant < 0) return {false, 0, 0};
  const Extended root = std::sqrt(discriminant);
  // Conjugate roots: one root is computed without cancellation, the other is c over it.
  const Extended far_side = a > 0 ? -a - root : -a + root;
  const Extended other = far_side != 0 ? c / far_side : 0;
  return {true, std::min(far_side, other), std::max(far_side, other)};
}

// Returns the lowest altitude of a ray of finite length.
double LowestAltitude(const ViewRay& ray, double planet_radius_m) {
  const double perigee_m = -(planet_radius_m + ray.altitude_m) * ray.mu;
  return shared::AltitudeAlongRay<double>(
      ray.altitude_m, ray.mu, std::clamp(perigee_m, 0.0, ray.length_m), planet_radius_m);
}

// Returns whether a ray of finite length stays more than a metre inside the shell, away from ground
// and top.
bool EndsWellInside(const ViewRay& ray, double planet_radius_m, double atmosphere_height_m) {
  constexpr double kMargin_m = 1.0;
  if (!(ray.length_m < 1e6)) return false;
  const double end_m =
      shared::AltitudeAlongRay<double>(ray.altitude_m, ray.mu, ray.length_m, planet_radius_m);
  return LowestAltitude(ray, planet_radius_m) > kMargin_m &&
         std::max(ray.altitude_m, end_m) < atmosphere_height_m - kMargin_m;
}

// Returns whether the ground does not end a ray: it is a segment, no part of which is too deep.
bool IsSegmentOfAir(const ViewRay& ray, double planet_radius_m) {
  if (std::isinf(ray.length_m) || (ray.altitude_m >= 0.0 && !ray.passes_ground)) return false;
  return LowestAltitude(ray, planet_radius_m) >= -DeepestAir(planet_radius_m);
}

/// Distances at which a ray is cut, in any order.
class PanelEnds {
 public:
  explicit PanelEnds(double length) : length_(length) {
    Add(0.0);
    Add(length);
  }

  void Add(double distance) {
    ALPENGLOW_ENSURE(count_, <, distance_.size());
    distance_[count_++] = std::clamp(distance, 0.0, length_);
  }

  void Add(const LineCrossings& crossings) {
    for (std::size_t i = 0; i < crossings.count; ++i) Add(crossings.distance[i]);
  }

  /// Returns the distances in ascending order.
  [[nodiscard]] std::span<const double> Sorted() {
    std::sort(distance_.begin(), distance_.begin() + count_);
    return {distance_.data(), count_};
  }

 private:
  double length_;
  std::array<double, RayPanels::kMost + 1> distance_{};
  std::size_t count_ = 0;
};

// Returns the points at which the sunbeam through the point at distance t of the ray has its
// perigee at altitude z: these are the crossings of a cylinder of radius R + z around the axis from
// the planet's centre to the sun. Only beams from below the horizontal have a perigee.
LineCrossings SunPerigees(const RayEntry& entry, double z, double radius) {
  const double r = radius + entry.altitude_km;
  const double a = (1.0 - entry.nu) * (1.0 + entry.nu);
  const double b = r * (entry.mu - entry.mu_s * entry.nu);
  const double c = (entry.altitude_km - z) * (2.0 * radius + entry.altitude_km + z) -
                   r * r * entry.mu_s * entry.mu_s;
  const double discriminant = b * b - a * c;
  LineCrossings found{0, {}};
  if (a < 1e-12 || discriminant <= 0.0) return found;
  for (const double t : {(-b - std::sqrt(discriminant)) / a, (-b + std::sqrt(discriminant)) / a}) {
    if (r * entry.mu_s + t * entry.nu < 0.0) found.distance[found.count++] = t;
  }
  return found;
}

void AddTent(const RayEntry& entry, const OzoneLayer& ozone, double radius, PanelEnds& cuts) {
  for (const double z : {ozone.bottom_m, ozone.peak_m, ozone.top_m}) {
    cuts.Add(CrossingsOf(entry.altitude_km, entry.mu, Kilometres(z), radius));
    cuts.Add(SunPerigees(entry, Kilometres(z), radius));
  }
}

/// The dark part of a ray [km from the entry]; empty if begin == end.
struct DarkSpan {
  double begin = 0.0, end = 0.0;
};

DarkSpan DarkSpanOf(const ViewRay& ray, const RayExtent& extent, const Medium& medium) {
  const ShadowSpan shadow = PlanetShadow(ray, extent, medium.planet_radius_m);
  if (!(shadow.dark_begin_m < shadow.dark_end_m)) return {};
  return {Kilometres(shadow.dark_begin_m - extent.begin_m),
          Kilometres(shadow.dark_end_m - extent.begin_m)};
}

double LargestExtinctionPerKm(const Medium& medium) {
  double largest = 0.0;
  for (std::size_t band = 0; band < medium.wavelengths_nm.size(); ++band) {
    largest = std::max(largest,
                       medium.rayleigh_scattering_per_m[band] + medium.mie_extinction_per_m[band]);
  }
  return largest * kMetresPerKilometre;
}

// Returns the vertical optical depth of a layer divided by that of both layers, largest over bands.
double LargestShare(const std::vector<double>& of, const std::vector<double>& other) {
  double largest = 0.0;
  for (std::size_t band = 0; band < of.size(); ++band) {
    const double all = of[band] + other[band];
    if (all > 0.0) largest = std::max(largest, of[band] / all);
  }
  return largest;
}

/// Properties of the lower end of a panel that determine its number of nodes.
struct LowerEnd {
  double altitude_km, cosine;  // altitude: of air as deep as the Earth's
  bool grazed;                 // by sunbeams from below the horizontal, or at the shadow
  bool at_perigee;             // the lower end is the perigee of the ray
  bool ahead;                  // the ray descends to it
  bool from_above;             // and began in air too thin to hide anything
};

// Returns the number of nodes: extra nodes are counted in halves of the ordinary number. A long
// path down through the air hides its lower end, which has most nodes; above 50 km the air is too
// thin for that.
int NodesOf(const LowerEnd& low, int nodes) {
  int halves = low.grazed ? 3 : 2;
  const bool slanting = low.ahead && low.cosine < 0.3;
  if (low.altitude_km < 50.0) {
    if (low.at_perigee || slanting)
      halves += low.from_above || low.grazed ? 2 : 1;
    else if (low.ahead && low.from_above)
      halves += 1;
  }
  return std::min((nodes * halves + 1) / 2, kMaxGaussNodes);
}

std::vector<double> Times(std::vector<double> values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

}  // namespace

ViewRay RayFromAngles(double altitude_m, double view_zenith_deg, double relative_azimuth_deg,
                      double sun_zenith_deg) {
  const double view = view_zenith_deg * kRadiansPerDegree;
  const double sun = sun_zenith_deg * kRadiansPerDegree;
  const double azimuth = relative_azimuth_deg * kRadiansPerDegree;
  ViewRay ray;
  ray.altitude_m = altitude_m;
  ray.mu = std::cos(view);
  ray.mu_s = std::cos(sun);
  ray.nu =
      std::clamp(ray.mu * ray.mu_s + std::sin(view) * std::sin(sun) * std::cos(azimuth), -1.0, 1.0);
  return ray;
}

double StartAltitude(const ViewRay& ray, double planet_radius_m) {
  const bool is_above = ray.altitude_m >= 0.0 || IsSegmentOfAir(ray, planet_radius_m);
  return is_above ? ray.altitude_m : 0.0;
}

RayExtent ExtentOf(const ViewRay& ray, double planet_radius_m, double atmosphere_height_m) {
  RequireFinite(ray, planet_radius_m);
  if (EndsWellInside(ray, planet_radius_m, atmosphere_height_m))
    return {0.0, ray.length_m, RayEnd::kLength};
  const Extended h = StartAltitude(ray, planet_radius_m);
  const Crossings top = CrossAltitude(h, ray.mu, atmosphere_height_m, planet_radius_m);
  if (!top.exist || top.far <= 0) return {};
  RayExtent extent;
  extent.begin_m = static_cast<double>(std::max<Extended>(top.near, 0));
  if (h <= atmosphere_height_m) extent.begin_m = 0.0;
  extent.end_m = static_cast<double>(top.far);
  if (ray.mu < 0.0 && !IsSegmentOfAir(ray, planet_radius_m)) {
    if (const Crossings ground = CrossAltitude(h, ray.mu, 0, planet_radius_m); ground.exist) {
      extent.end_m = static_cast<double>(std::max<Extended>(ground.near, 0));
      extent.end = RayEnd::kGround;
    }
  }
  if (ray.length_m < extent.end_m) {
    extent.end_m = std::max(ray.length_m, extent.begin_m);
    extent.end = RayEnd::kLength;
  }
  return extent;
}

bool BringsLightOfGround(const ViewRay& ray, const RayExtent& extent) {
  return extent.end == RayEnd::kGround && std::isinf(ray.length_m);
}

SubmergedSpan SubmergedPart(const ViewRay& ray, const RayExtent& extent, double planet_radius_m) {
  if (!IsSegmentOfAir(ray, planet_radius_m)) return {};
  const Crossings ground = CrossAltitude(ray.altitude_m, ray.mu, 0, planet_radius_m);
  if (!ground.exist) return {};
  const Extended begin = std::clamp<Extended>(ground.near, extent.begin_m, extent.end_m);
  const Extended end = std::clamp<Extended>(ground.far, extent.begin_m, extent.end_m);
  return {static_cast<double>(begin), static_cast<double>(end),
          static_cast<double>((ground.far - ground.near) / (2 * Extended(planet_radius_m)))};
}

ShadowSpan PlanetShadow(const ViewRay& ray, const RayExtent& extent, double planet_radius_m) {
  // If the sun is above the plane through the planet's centre at both ends, there is no shadow in
  // between.
  const double altitude_m = StartAltitude(ray, planet_radius_m);
  const double height_m = (planet_radius_m + altitude_m) * ray.mu_s;
  if (height_m + extent.begin_m * ray.nu > 0.0 && height_m + extent.end_m * ray.nu > 0.0) return {};
  const Extended h = altitude_m, mu = ray.mu, mu_s = ray.mu_s, nu = ray.nu;
  const Extended a = (1 - nu) * (1 + nu);
  const Extended radius = planet_radius_m;
  if (shared::MeetsShadow(h, mu, mu_s, nu, a, radius) == 0) return {};
  const Extended begin =
      std::max<Extended>(extent.begin_m, shared::ShadowBegin(h, mu, mu_s, nu, a, radius));
  const Extended end =
      std::min<Extended>(extent.end_m, shared::ShadowEnd(h, mu, mu_s, nu, a, radius));
  if (!(begin < end)) return {};
  return {static_cast<double>(begin), static_cast<double>(end)};
}

double MapLengthsPerKm(const Medium& medium) {
  constexpr double kLeastShare = 0.05, kDeepAir_km = 6.4;
  const double molecules_m = medium.rayleigh_scale_height_m;
  const double aerosol_m = medium.mie_scale_height_m;
  const std::vector<double> molecules = Times(medium.rayleigh_scattering_per_m, molecules_m);
  const std::vector<double> aerosol = Times(medium.mie_extinction_per_m, aerosol_m);
  double deepest_m = 0.0;
  if (LargestShare(molecules, aerosol) > kLeastShare) deepest_m = molecules_m;
  if (LargestShare(aerosol, molecules) > kLeastShare) deepest_m = std::max(deepest_m, aerosol_m);
  return deepest_m > 0.0 ? std::max(kDeepAir_km / Kilometres(deepest_m), 1.0) : 1.0;
}

LineCrossings CrossingsOf(double h, double mu, double z, double radius) {
  const double a = (radius + h) * mu;
  const double discriminant = a * a - (h - z) * (2.0 * radius + h + z);
  if (discriminant <= 0.0) return {0, {}};
  const double root = std::sqrt(discriminant);
  return {2, {-a - root, -a + root}};
}

RayEntry EntryOf(const ViewRay& ray, const RayExtent& extent, const Medium& medium) {
  const double radius = Kilometres(medium.planet_radius_m);
  const double h = Kilometres(StartAltitude(ray, medium.planet_radius_m));
  const double d = Kilometres(extent.begin_m);
  RayEntry entry{h, ray.mu, ray.mu_s, ray.nu};
  if (d > 0.0) {
    const double altitude = Kilometres(medium.atmosphere_height_m);
    entry = {altitude, shared::ZenithCosineAlongRay<double>(h, ray.mu, d, altitude, radius),
             shared::SunCosineAlongRay<double>(h, ray.mu_s, ray.nu, d, altitude, radius), ray.nu};
  }
  const SubmergedSpan below = SubmergedPart(ray, extent, medium.planet_radius_m);
  if (!below.Exists()) return entry;
  entry.submerged_begin_km = Kilometres(below.begin_m) - d;
  entry.submerged_end_km = Kilometres(below.end_m) - d;
  entry.mu_ground = below.mu_ground;
  return entry;
}

RayPanels PanelsOf(const ViewRay& ray, const RayExtent& extent, const RayEntry& entry,
                   const Medium& medium, const Sampling& sampling) {
  const double radius = Kilometres(medium.planet_radius_m);
  const double length = Kilometres(extent.end_m - extent.begin_m);
  const double perigee = -(radius + entry.altitude_km) * entry.mu;
  const double extinction = LargestExtinctionPerKm(medium);
  const double map = MapLengthsPerKm(medium);
  const DarkSpan dark = DarkSpanOf(ray, extent, medium);
  PanelEnds cuts(length);
  if (entry.IsSubmerged()) {
    cuts.Add(entry.submerged_begin_km);
    cuts.Add(entry.submerged_end_km);
  } else if (perigee > 0.0 && perigee < length) {
    cuts.Add(perigee);
  }
  if (dark.begin < dark.end) {
    cuts.Add(dark.begin);
    cuts.Add(dark.end);
  }
  if (sampling.split_ozone && medium.ozone.shape == OzoneShape::kTent) {
    AddTent(entry, medium.ozone, radius, cuts);
  }
  const std::span<const double> ends = cuts.Sorted();
  RayPanels panels;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const double begin = ends[i], end = ends[i + 1];
    if (end - begin <= 1e-12 * length) continue;
    const double middle = 0.5 * (begin + end);
    const bool lit = !(middle > dark.begin && middle < dark.end);
    if (!lit && !sampling.dark_samples) continue;
    const bool rises = middle > perigee;
    const double at = rises ? begin : end;
    const double altitude =
        std::max(shared::AltitudeAlongRay<double>(entry.altitude_km, entry.mu, at, radius), 0.0);
    const bool at_shadow = lit && dark.begin < dark.end && (at == dark.begin || at == dark.end);
    const double sun = (radius + entry.altitude_km) * entry.mu_s + at * entry.nu;
    const LowerEnd low{map * altitude,
                       std::abs(shared::ZenithCosineAlongRay<double>(entry.altitude_km, entry.mu,
                                                                     at, altitude, radius)),
                       lit && (at_shadow || sun < 0.0),
                       at == perigee,
                       !rises,
                       map * entry.altitude_km > 60.0};
    panels.panel[panels.count++] = {
        begin,
        end,
        lit,
        rises,
        shared::PanelStretch<double>(map * altitude, low.cosine, map * (end - begin),
                                     extinction / map, at_shadow ? 1.0 : 0.0, map * radius),
        NodesOf(low, sampling.nodes)};
  }
  return panels;
}

}  // namespace alpenglow::atmosphere
