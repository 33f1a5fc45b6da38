// SPDX-License-Identifier: MIT
#include "atmosphere/ray/direct_panels.h"

#include <algorithm>
#include <cmath>

#include "atmosphere/number/constants.h"
#include "atmosphere/ray/ray_map.h"
#include "atmosphere/ray/ray_panels.h"
#include "atmosphere/ray/shell.h"

namespace alpenglow::atmosphere {
namespace {

/// A ray from where it enters the air [km].
struct Entry {
  double altitude, mu, mu_s, nu;
  double skipped;  // distance from the observer
  double length;   // of the ray in the air
  RayEnd end;
};

/// The dark part of a ray; empty unless begin < end.
struct Dark {
  double begin = 0.0, end = 0.0;
  [[nodiscard]] bool Exists() const { return begin < end; }
};

// Moves an observer above the top to where the ray meets the air. Returns whether it does.
bool EnterAir(const DirectAir& air, Entry& entry) {
  if (entry.altitude <= air.top) return true;
  if (entry.mu >= 0.0 || shared::GroundClearance<double>(entry.altitude - air.top, entry.mu,
                                                         air.radius + air.top) <= 0.0)
    return false;
  entry.skipped = shared::DistanceDownTo<double>(entry.altitude, entry.mu, air.top, air.radius);
  entry.mu_s = shared::SunCosineAlongRay<double>(entry.altitude, entry.mu_s, entry.nu,
                                                 entry.skipped, air.top, air.radius);
  entry.mu = shared::ZenithCosineAlongRay<double>(entry.altitude, entry.mu, entry.skipped, air.top,
                                                  air.radius);
  entry.altitude = air.top;
  return true;
}

void FindEnd(const DirectAir& air, double length_m, Entry& entry) {
  const bool ground =
      entry.mu < 0.0 && shared::GroundClearance<double>(entry.altitude, entry.mu, air.radius) > 0.0;
  entry.end = ground ? RayEnd::kGround : RayEnd::kSpace;
  entry.length = ground
                     ? shared::DistanceDownTo<double>(entry.altitude, entry.mu, 0.0, air.radius)
                     : shared::DistanceUpTo<double>(entry.altitude, entry.mu, air.top, air.radius);
  const double asked = Kilometres(length_m) - entry.skipped;
  if (asked >= entry.length) return;
  entry.length = std::max(asked, 0.0);
  entry.end = RayEnd::kLength;
}

// The formulas are those of PlanetShadow, here in double precision.
Dark DarkOf(const DirectAir& air, const Entry& entry) {
  const double height = (air.radius + entry.altitude) * entry.mu_s;
  if (height > 0.0 && height + entry.length * entry.nu > 0.0) return {};
  const double a = (1.0 - entry.nu) * (1.0 + entry.nu);
  const auto& [h, mu, mu_s, nu, skipped, length, end] = entry;
  if (shared::MeetsShadow<double>(h, mu, mu_s, nu, a, air.radius) == 0.0) return {};
  return {std::max(shared::ShadowBegin<double>(h, mu, mu_s, nu, a, air.radius), 0.0),
          std::min(shared::ShadowEnd<double>(h, mu, mu_s, nu, a, air.radius), length)};
}

/// Places the panels of one ray.
class PanelPlacer {
 public:
  PanelPlacer(const DirectAir& air, const Entry& entry, DirectRay& ray)
      : air_(air),
        entry_(entry),
        dark_(DarkOf(air, entry)),
        from_perigee_((air.radius + entry.altitude) * entry.mu),
        ray_(ray) {
    ray_.falls = from_perigee_ < 0.0;
  }

  void Place(bool dark) const {
    const double perigee = std::clamp(-from_perigee_, 0.0, entry_.length);
    PlaceMonotone(0.0, perigee, false, dark);
    PlaceMonotone(perigee, entry_.length, true, dark);
  }

  // Seven nodes suffice for a single panel, but not where dense air hides its low end and sunbeams
  // graze it, or the ray comes down to it.
  [[nodiscard]] bool FitsEightLanes() const {
    if (ray_.panels != 1) return false;
    const DirectPanel& panel = ray_.panel[0];
    const bool rises = panel.direction > 0.0F;
    if (ray_.falls && rises) return false;  // behind the perigee
    return !(panel.hard && (dark_.Exists() || panel.mu_s < 0.05F || !rises));
  }

 private:
  // Cuts a stretch of monotone altitude at the edges of the shadow.
  void PlaceMonotone(double begin, double end, bool rises, bool dark) const {
    if (!(begin < end)) return;
    if (!dark_.Exists() || dark_.begin >= end || dark_.end <= begin) {
      Add(begin, end, rises, true);
      return;
    }
    Add(begin, std::max(begin, dark_.begin), rises, true);
    if (dark) Add(std::max(begin, dark_.begin), std::min(end, dark_.end), rises, false);
    Add(std::min(end, dark_.end), end, rises, true);
  }

  void Add(double begin, double end, bool rises, bool lit) const {
    if (end - begin <= 1e-9 * entry_.length) return;
    const double low = rises ? begin : end, sign = rises ? 1.0 : -1.0;
    const double altitude = AltitudeAt(low);
    const double inverse = 1.0 / (air_.radius + altitude);
    const double sun = (air_.radius + entry_.altitude) * entry_.mu_s + low * entry_.nu;
    const auto real = [](double value) { return static_cast<float>(value); };
    DirectPanel& panel = ray_.panel[ray_.panels++];
    panel.altitude = real(altitude);
    panel.radius = real(air_.radius + altitude);
    panel.inverse_radius = real(inverse);
    panel.from_perigee = real(std::abs(from_perigee_ + low));
    panel.length = real(end - begin);
    panel.mu_s = real(sun * inverse);
    panel.nu = real(sign * entry_.nu);
    panel.entry = real(-sign * low);
    panel.perigee = real(rises && ray_.falls ? -(from_perigee_ + low) : -sign * low);
    panel.begin = real(low);
    panel.direction = real(sign);
    panel.lit = lit ? 1.0F : 0.0F;
    SetMap(dark_.Exists() && (rises ? begin == dark_.end : end == dark_.begin), panel);
  }

  [[nodiscard]] double AltitudeAt(double distance) const {
    if (distance == 0.0) return entry_.altitude;
    return std::max(
        shared::AltitudeAlongRay<double>(entry_.altitude, entry_.mu, distance, air_.radius), 0.0);
  }

  void SetMap(bool at_shadow, DirectPanel& panel) const {
    constexpr float kThinning_km = 8.0F;  // of all air, about
    const float rise = at_shadow ? 12.0F : 10.0F;
    const float dense =
        std::max(air_.largest_extinction * std::exp(-panel.altitude / kThinning_km), 1e-20F);
    const float half =
        shared::DistanceUpTo<float>(panel.altitude, panel.from_perigee * panel.inverse_radius,
                                    panel.altitude + rise, static_cast<float>(air_.radius));
    panel.dense = dense;
    panel.hard = dense * std::min(half, panel.length) > 4.0F;
    const float kappa = at_shadow || panel.mu_s < 0.0F ? 3.0F : 2.0F;
    panel.slope = std::min(kappa * std::min(half, 14.0F / dense) / panel.length, 1.0F);
  }

  const DirectAir& air_;
  const Entry& entry_;
  Dark dark_;
  double from_perigee_;  // of the entry, along the ray
  DirectRay& ray_;
};

void GroupPanels(DirectMode mode, DirectRay& ray) {
  for (std::size_t i = 0; i < ray.panels;) {
    const bool two = mode == DirectMode::kFast && i + 1 < ray.panels &&
                     !(ray.panel[i].hard || ray.panel[i + 1].hard);
    ray.group[ray.groups++] = {i, two ? i + 1 : i};
    i += two ? 2 : 1;
  }
}

}  // namespace

float DirectPanel::AltitudeAt(float position) const {
  const float climb = position * (position + 2.0F * from_perigee) * inverse_radius;  // 2 r x
  return altitude + climb / (1.0F + std::sqrt(1.0F + climb * inverse_radius));
}

DirectRay DirectRayOf(const DirectAir& air, const ViewRay& ray, DirectMode mode, bool dark) {
  DirectRay placed;
  Entry entry{Kilometres(std::max(ray.altitude_m, 0.0)),
              ray.mu,
              ray.mu_s,
              ray.nu,
              0.0,
              0.0,
              RayEnd::kSpace};
  if (!EnterAir(air, entry)) return placed;
  FindEnd(air, ray.length_m, entry);
  placed.extent = {entry.skipped * kMetresPerKilometre,
                   (entry.skipped + entry.length) * kMetresPerKilometre, entry.end};
  if (!(entry.length > 0.0)) return placed;
  const PanelPlacer placer(air, entry, placed);
  placer.Place(dark);
  placed.narrow = mode == DirectMode::kFast && placer.FitsEightLanes();
  GroupPanels(mode, placed);
  return placed;
}

}  // namespace alpenglow::atmosphere
