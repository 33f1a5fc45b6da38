// SPDX-License-Identifier: MIT
#include "atmosphere/judge/ray_equation.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/sun/bent_ray.h"

namespace alpenglow::atmosphere::judge {
namespace {

using State = RayEquation::State;

State Add(const State& a, double s, const State& b) {
  return {a.x + s * b.x, a.y + s * b.y, a.p + s * b.p, a.q + s * b.q};
}

}  // namespace

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

// From far outside to the top, straight; the length of that.
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
      refractivity_ * (Refracting(height + 0.5) - Refracting(height - 0.5));  // a metre up
  const double radius = std::hypot(at.x, at.y);
  return {at.p / n, at.q / n, gradient * at.x / radius, gradient * at.y / radius};
}

RayEquation::State RayEquation::Stepped(const State& at, double step_m) const {
  const State k1 = Slope(at), k2 = Slope(Add(at, 0.5 * step_m, k1)),
              k3 = Slope(Add(at, 0.5 * step_m, k2)), k4 = Slope(Add(at, step_m, k3));
  return Add(Add(Add(Add(at, step_m / 6.0, k1), step_m / 3.0, k2), step_m / 3.0, k3), step_m / 6.0,
             k4);
}

}  // namespace alpenglow::atmosphere::judge
