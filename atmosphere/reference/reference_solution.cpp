// SPDX-License-Identifier: MIT
#include "atmosphere/reference/reference_solution.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/refraction/refraction.h"

namespace alpenglow::atmosphere::reference {
namespace {

using Extended = long double;
using Columns = std::array<double, 3>;  // molecules, aerosol, ozone [m]

/// A straight line through the shell, by direct formulas in extended precision.
struct Line {
  Extended r, mu, radius;

  [[nodiscard]] Extended Altitude(Extended t) const {
    return std::sqrt(r * r + 2 * r * mu * t + t * t) - radius;
  }
  [[nodiscard]] Extended Perigee() const { return -r * mu; }

  // Appends the distances in (begin, end) at which the line crosses altitude z.
  void AppendCrossings(Extended z, Extended begin, Extended end, std::vector<double>& found) const {
    const Extended discriminant = r * r * mu * mu - (r - radius - z) * (r + radius + z);
    if (discriminant < 0) return;
    for (const Extended t :
         {-r * mu - std::sqrt(discriminant), -r * mu + std::sqrt(discriminant)}) {
      if (t > begin && t < end) found.push_back(static_cast<double>(t));
    }
  }
};

// Below altitude 0 air has the density of altitude 0.
Columns Densities(const Medium& medium, Extended altitude) {
  const OzoneLayer& layer = medium.ozone;
  const double h = std::max(static_cast<double>(altitude), 0.0);
  double ozone = 0.0;
  if (layer.shape == OzoneShape::kSmooth) {
    const double y = h / layer.top_m;
    if (y > 0.0 && y < 1.0) ozone = std::pow(27.0 / 4.0 * y, 4) * std::pow(1.0 - y, 8);
  } else if (h > layer.bottom_m && h <= layer.peak_m) {
    ozone = (h - layer.bottom_m) / (layer.peak_m - layer.bottom_m);
  } else if (h > layer.peak_m && h < layer.top_m) {
    ozone = (layer.top_m - h) / (layer.top_m - layer.peak_m);
  }
  const MoleculeDeficit& deficit = medium.rayleigh_deficit;
  double molecules = std::exp(-h / medium.rayleigh_scale_height_m);
  if (deficit.share != 0.0) {
    molecules =
        (1.0 + deficit.share) * molecules - deficit.share * std::exp(-h / deficit.scale_height_m);
  }
  return {molecules, std::exp(-h / medium.mie_scale_height_m), ozone};
}

// Returns the points at which the integrands along the line have a kink or a large curvature: edges
// of the ozone tent, the perigee, altitude 0 where the line passes it, and a ladder of altitudes
// that brackets both scale heights, so that no layer lies between the nodes of a first panel.
std::vector<double> Breakpoints(const Medium& medium, const Line& line, double begin, double end) {
  std::vector<double> points;
  points.reserve(2 + 1 + 2 * (4 + 6));
  points.insert(points.end(), {begin, end});
  const Extended perigee = line.Perigee();
  if (perigee > begin && perigee < end) points.push_back(static_cast<double>(perigee));
  // A line that ends at the ground does not pass altitude 0: a panel of rounding errors there could
  // lie outside the planet's shadow.
  constexpr Extended kRounding_m = 1e-3;
  const Extended deepest = std::clamp<Extended>(perigee, begin, end);
  if (line.Altitude(static_cast<double>(deepest)) < -kRounding_m)
    line.AppendCrossings(0.0, begin, end, points);
  for (const double z : {medium.ozone.bottom_m, medium.ozone.peak_m, medium.ozone.top_m}) {
    line.AppendCrossings(z, begin, end, points);
  }
  for (const double height : {medium.rayleigh_scale_height_m, medium.mie_scale_height_m}) {
    for (const double multiple : {1.0, 4.0, 16.0})
      line.AppendCrossings(multiple * height, begin, end, points);
  }
  std::sort(points.begin(), points.end());
  return points;
}

// Appends the points t at which the sunbeam through the point has its perigee at altitude z: the
// line leaves the cylinder of radius R + z around the axis from the planet's centre to the sun.
// There the edges of the ozone tent make the integrand kink like (t - t0)^1.5, which error
// estimates do not detect in time.
void AppendSunPerigees(const Line& line, const ViewRay& ray, Extended z, double begin, double end,
                       std::vector<double>& points) {
  const Extended nu = ray.nu;
  const Extended a = (1 - nu) * (1 + nu);
  const Extended b = line.r * (line.mu - ray.mu_s * nu);
  const Extended c = line.r * line.r * (1 - static_cast<Extended>(ray.mu_s) * ray.mu_s) -
                     (line.radius + z) * (line.radius + z);
  const Extended discriminant = b * b - a * c;
  if (a <= 0 || discriminant < 0) return;
  for (const Extended t :
       {(-b - std::sqrt(discriminant)) / a, (-b + std::sqrt(discriminant)) / a}) {
    if (t > begin && t < end) points.push_back(static_cast<double>(t));
  }
}

Columns ColumnsAlong(const Medium& medium, const Line& line, double begin, double end,
                     double tolerance) {
  const auto densities = [&](double t) { return Densities(medium, line.Altitude(t)); };
  return IntegrateAdaptively(densities, 3, Breakpoints(medium, line, begin, end), tolerance).value;
}

/// Columns from the begin of a line to many points of it. What lies before the last breakpoint is
/// integrated once.
class ColumnsToPoints {
 public:
  ColumnsToPoints(const Medium& medium, const Line& line, double begin)
      : medium_(medium), line_(line), begin_(begin) {}

  /// @param end  a distance along the line, at or after its begin.
  [[nodiscard]] Columns UpTo(double end, double tolerance) {
    const auto densities = [&](double t) { return Densities(medium_, line_.Altitude(t)); };
    const TenPointRule rule(densities, 3);
    const std::vector<double> points = Breakpoints(medium_, line_, begin_, end);
    const double last = points[points.size() - 2];
    const auto apply = [&](double low, double high) {
      if (high > last) return rule(low, high);
      const auto [found, is_new] = panels_.try_emplace({low, high});
      if (is_new) found->second = rule(low, high);
      return found->second;
    };
    return IntegratePanels(apply, Columns{}, points, tolerance).value;
  }

 private:
  const Medium& medium_;
  Line line_;
  double begin_;
  std::map<std::pair<double, double>, Columns> panels_;  // integrals by begin and end
};

double TauAt(const Medium& medium, std::size_t band, std::span<const double> columns) {
  return medium.rayleigh_scattering_per_m[band] * columns[0] +
         medium.mie_extinction_per_m[band] * columns[1] +
         medium.ozone_absorption_per_m[band] * columns[2];
}

// Returns the phase function of Hansen and Travis (1974), 2.15: a fraction D of Rayleigh
// scattering, and isotropic scattering for the rest.
double PhaseOfMolecules(double depolarisation, double nu) {
  const double share = (1.0 - depolarisation) / (1.0 + 0.5 * depolarisation);
  return (0.75 * share * (1.0 + nu * nu) + 1.0 - share) / (4.0 * kPi);
}

// Columns from a point towards the sun; not lit if the planet blocks the sun.
struct SunPath {
  bool lit;
  Columns columns;
};

SunPath TowardsSun(const Medium& medium, const Line& view, const ViewRay& ray, double t, bool lit,
                   double tolerance) {
  if (!lit) return {false, {}};
  const Extended h = std::max<Extended>(view.Altitude(t), 0);
  const Extended r = view.radius + h;
  const Extended mu_s = std::clamp((view.r * ray.mu_s + static_cast<Extended>(t) * ray.nu) / r,
                                   Extended(-1), Extended(1));
  const Line sun{r, mu_s, view.radius};
  // At the ends of the dark part, the line to the sun may lead through the planet.
  constexpr Extended kRounding_m = 1e-3;
  if (mu_s < 0 && sun.Altitude(sun.Perigee()) < -kRounding_m) return {false, {}};
  const Extended top = view.radius + medium.atmosphere_height_m;
  const Extended end =
      -r * mu_s + std::sqrt(std::max<Extended>(r * r * mu_s * mu_s + (top - r) * (top + r), 0));
  return {true, ColumnsAlong(medium, sun, 0.0, static_cast<double>(end), tolerance)};
}

// Returns the segment of a line in the planet's shadow, a half-cylinder away from the sun: the
// distance of its points from the axis is less than the planet's radius. ray.h computes the same
// segment with another formula.
ShadowSpan DarkPart(const Line& line, const ViewRay& ray, const RayExtent& extent) {
  const Extended nu = ray.nu;
  const Extended sunwards = line.r * ray.mu_s;  // of the observer, from the planet's centre
  const auto room = [&](Extended t) {           // radius^2 - distance from the axis^2
    const Extended towards = sunwards + t * nu;
    return line.radius * line.radius - line.r * line.r - 2 * line.r * line.mu * t - t * t +
           towards * towards;
  };
  Extended begin = extent.begin_m, end = extent.end_m;
  const Extended across = (1 - nu) * (1 + nu);
  if (across > 1e-14L) {
    const Extended nearest = (sunwards * nu - line.r * line.mu) / across;
    if (room(nearest) <= 0) return {};
    const Extended half = std::sqrt(room(nearest) / across);
    begin = std::max(begin, nearest - half);
    end = std::min(end, nearest + half);
  } else if (room(0) <= 0) {
    return {};
  }
  if (nu > 0) end = std::min(end, -sunwards / nu);
  if (nu < 0) begin = std::max(begin, -sunwards / nu);
  if ((nu == 0 && sunwards >= 0) || !(begin < end)) return {};
  return {static_cast<double>(begin), static_cast<double>(end)};
}

using State = RayEquation::State;

State Add(const State& a, double s, const State& b) {
  return {a.x + s * b.x, a.y + s * b.y, a.p + s * b.p, a.q + s * b.q};
}

}  // namespace

OpticalDepth OpticalDepthAlong(const Medium& medium, const ViewRay& ray) {
  const RayExtent extent = ExtentOf(ray, medium.planet_radius_m, medium.atmosphere_height_m);
  const Extended radius = medium.planet_radius_m;
  const Line line{radius + StartAltitude(ray, medium.planet_radius_m), ray.mu, radius};
  const auto densities = [&](double t) {
    const Columns now = Densities(medium, line.Altitude(t));
    std::vector<double> extinction(medium.wavelengths_nm.size());
    for (std::size_t band = 0; band < extinction.size(); ++band)
      extinction[band] = TauAt(medium, band, now);
    return extinction;
  };
  const auto result =
      IntegrateAdaptively(densities, medium.wavelengths_nm.size(),
                          Breakpoints(medium, line, extent.begin_m, extent.end_m), 1e-12);
  return {result.value, extent.end == RayEnd::kGround, result.error < 1e-10};
}

RayRadiance SingleScatteringAlong(const Medium& medium, const ViewRay& ray) {
  constexpr double kInnerTolerance = 1e-10;
  constexpr double kOuterTolerance = 1e-9;
  const std::size_t bands = medium.wavelengths_nm.size();
  const RayExtent extent = ExtentOf(ray, medium.planet_radius_m, medium.atmosphere_height_m);
  const Extended radius = medium.planet_radius_m;
  const Line line{radius + StartAltitude(ray, medium.planet_radius_m), ray.mu, radius};
  const ShadowSpan shadow = DarkPart(line, ray, extent);

  std::vector<double> points = Breakpoints(medium, line, extent.begin_m, extent.end_m);
  const bool any_dark = shadow.dark_begin_m < shadow.dark_end_m;
  if (any_dark) points.insert(points.end(), {shadow.dark_begin_m, shadow.dark_end_m});
  for (const double z : {medium.ozone.bottom_m, medium.ozone.peak_m, medium.ozone.top_m,
                         1.0 * medium.mie_scale_height_m, 4.0 * medium.mie_scale_height_m}) {
    AppendSunPerigees(line, ray, z, extent.begin_m, extent.end_m, points);
  }
  std::sort(points.begin(), points.end());
  const auto is_dark = [&](double t) {
    return any_dark && t > shadow.dark_begin_m && t < shadow.dark_end_m;
  };

  std::vector<double> phase_rayleigh;
  for (std::size_t band = 0; band < bands; ++band)
    phase_rayleigh.push_back(PhaseOfMolecules(Depolarisation(medium, band), ray.nu));
  const std::vector<double> phase_mie = MiePhaseValues(medium, ray.nu);
  ColumnsToPoints seen(medium, line, extent.begin_m);
  const auto source = [&](double t) {
    std::vector<double> scattered(bands, 0.0);
    const SunPath sun = TowardsSun(medium, line, ray, t, !is_dark(t), kInnerTolerance);
    if (!sun.lit) return scattered;
    const Columns view = seen.UpTo(t, kInnerTolerance);
    const Columns density = Densities(medium, line.Altitude(t));
    for (std::size_t band = 0; band < bands; ++band) {
      const double tau = TauAt(medium, band, view) + TauAt(medium, band, sun.columns);
      scattered[band] =
          std::exp(-tau) *
          (medium.rayleigh_scattering_per_m[band] * density[0] * phase_rayleigh[band] +
           medium.mie_scattering_per_m[band] * density[1] * phase_mie[band]);
    }
    return scattered;
  };
  const auto scattered = IntegrateAdaptively(source, bands, points, kOuterTolerance);

  RayRadiance result;
  result.inscatter = scattered.value;
  result.error = scattered.error;
  result.converged = scattered.error < 1e-8;
  result.ground.assign(bands, 0.0);
  const OpticalDepth depth = OpticalDepthAlong(medium, ray);
  for (const double tau : depth.tau) result.transmittance.push_back(std::exp(-tau));
  if (!BringsLightOfGround(ray, extent)) return result;
  const Extended mu_s_ground =
      (line.r * ray.mu_s + static_cast<Extended>(extent.end_m) * ray.nu) / radius;
  const std::vector<double> irradiance =
      SunIrradiance(medium, 0.0, std::clamp(static_cast<double>(mu_s_ground), -1.0, 1.0));
  for (std::size_t band = 0; band < bands; ++band) {
    result.ground[band] =
        result.transmittance[band] * medium.ground_albedo[band] / kPi * irradiance[band];
  }
  return result;
}

std::vector<double> SunIrradiance(const Medium& medium, double altitude_m, double mu_s) {
  std::vector<double> irradiance(medium.wavelengths_nm.size(), 0.0);
  if (mu_s <= 0.0) return irradiance;
  const OpticalDepth depth = OpticalDepthAlong(medium, {altitude_m, mu_s, mu_s, 1.0});
  for (std::size_t band = 0; band < irradiance.size(); ++band)
    irradiance[band] = mu_s * std::exp(-depth.tau[band]);
  return irradiance;
}

double PeckAndReeder(double wavelength_nm) {
  const double square = std::pow(1000.0 / wavelength_nm, 2);
  return 1e-8 * (8060.51 + 2480990.0 / (132.274 - square) + 17455.7 / (39.32957 - square));
}

RayEquation::End RayEquation::Follow(double elevation_rad, double height_m, double length_m) const {
  const double start = 1.0 + refractivity_ * Refracting(height_m);
  State at{0.0, medium_.planet_radius_m + height_m, start * std::cos(elevation_rad),
           start * std::sin(elevation_rad)};
  double gone_m = EnterAir(at);
  End end;
  while (gone_m < length_m) {
    const double height = Height(at);
    const bool rises = at.x * at.p + at.y * at.q > 0.0;
    if (height > medium_.atmosphere_height_m + 1.0 && rises) break;
    const double step_m = std::min(height < 40e3 ? 500.0 : 2000.0, length_m - gone_m);
    const State next = Stepped(at, step_m);
    if (Height(next) < 0.0) {
      end.is_ground = true;
      double above_m = 0.0, below_m = step_m;
      for (int i = 0; i < 40; ++i) {
        const double middle_m = 0.5 * (above_m + below_m);
        (Height(Stepped(at, middle_m)) < 0.0 ? below_m : above_m) = middle_m;
      }
      at = Stepped(at, above_m);
      break;
    }
    end.column_m += 0.5 * step_m * (Density(height) + Density(Height(next)));
    at = next;
    gone_m += step_m;
  }
  end.refraction_rad = elevation_rad - std::atan2(at.q, at.p);
  end.angle_rad = std::atan2(at.x, at.y);
  end.state = at;
  return end;
}

double RayEquation::Density(double height_m) const {
  return height_m > medium_.atmosphere_height_m ? 0.0 : MoleculeDensity(medium_, height_m);
}

double RayEquation::Refracting(double height_m) const {
  if (medium_.refraction == RefractionBy::kMolecules) return Density(height_m);
  if (height_m > medium_.atmosphere_height_m) return 0.0;
  double sum = 0.0;
  for (const auto& [share, scale_height_m] : kAlmanacLayers)
    sum += share * std::exp(-height_m / scale_height_m);
  return sum;
}

double RayEquation::Height(const State& at) const {
  return std::hypot(at.x, at.y) - medium_.planet_radius_m;
}

// Moves a ray from far outside in a straight line to the top of the air, and returns the distance.
double RayEquation::EnterAir(State& at) const {
  const double radius = std::hypot(at.x, at.y);
  const double top = medium_.planet_radius_m + medium_.atmosphere_height_m;
  if (radius <= top) return 0.0;
  const double along = -(at.x * at.p + at.y * at.q);
  const double nearest = radius * radius - along * along;
  if (along <= 0.0 || nearest >= top * top) return 0.0;
  const double length = along - std::sqrt(top * top - nearest);
  at.x += length * at.p;
  at.y += length * at.q;
  return length;
}

RayEquation::State RayEquation::Slope(const State& at) const {
  const double height = Height(at);
  const double n = 1.0 + refractivity_ * Refracting(height);
  const double gradient =
      refractivity_ * (Refracting(height + 0.5) - Refracting(height - 0.5));  // over one metre
  const double radius = std::hypot(at.x, at.y);
  return {at.p / n, at.q / n, gradient * at.x / radius, gradient * at.y / radius};
}

RayEquation::State RayEquation::Stepped(const State& at, double step_m) const {
  const State k1 = Slope(at), k2 = Slope(Add(at, 0.5 * step_m, k1)),
              k3 = Slope(Add(at, 0.5 * step_m, k2)), k4 = Slope(Add(at, step_m, k3));
  return Add(Add(Add(Add(at, step_m / 6.0, k1), step_m / 3.0, k2), step_m / 3.0, k3), step_m / 6.0,
             k4);
}

}  // namespace alpenglow::atmosphere::reference
