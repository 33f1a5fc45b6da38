// SPDX-License-Identifier: MIT
// Bent rays against the ray equation, d/ds (n dr/ds) = grad n, integrated step by step in the plane
// of the ray. The judge shares neither Bouguer's law nor the angles with what it judges.
#include "atmosphere/ray/bent_view.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace alpenglow {
namespace {

constexpr double kDegree = kRadiansPerDegree;
constexpr double kMinute = kRadiansPerDegree / 60.0;

/// n - 1 of air of 15 C and 1013.25 hPa. Peck and Reeder (1972), J. Opt. Soc. Am. 62, 958-962,
/// equation 2.
double PeckAndReeder(double wavelength_nm) {
  const double square = std::pow(1000.0 / wavelength_nm, 2);
  return 1e-8 * (8060.51 + 2480990.0 / (132.274 - square) + 17455.7 / (39.32957 - square));
}

/// A plane through the planet's centre: x along the horizontal of the eye, y up.
class RayEquation {
 public:
  RayEquation(const Medium& medium, double refractivity)
      : medium_(medium), refractivity_(refractivity) {}

  struct State {
    double x, y, p, q;  // place [m], and n times the direction
  };
  struct End {
    double refraction_rad = 0.0;
    double column_m = 0.0;  // of molecules
    bool is_ground = false;
    double angle_rad = 0.0;  // at the centre
    State state{};
  };

  /// Follows a ray up to a length; shorter steps make no difference of 0.001'.
  [[nodiscard]] End Follow(double elevation_rad, double height_m, double length_m = 1e12) const {
    State at{0.0, medium_.planet_radius_m + height_m, std::cos(elevation_rad),
             std::sin(elevation_rad)};
    const double start = 1.0 + Refractivity(height_m);
    at.p *= start;
    at.q *= start;
    EnterAir(at);
    End end;
    double gone_m = 0.0;
    while (gone_m < length_m) {
      const double height = Height(at);
      const bool rises = at.x * at.p + at.y * at.q > 0.0;
      if (height > medium_.atmosphere_height_m + 1.0 && rises) break;
      double step_m = std::min(height < 40e3 ? 500.0 : 2000.0, length_m - gone_m);
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

 private:
  [[nodiscard]] double Density(double height_m) const {
    return height_m > medium_.atmosphere_height_m ? 0.0 : MoleculeDensity(medium_, height_m);
  }
  [[nodiscard]] double Refractivity(double height_m) const {
    return refractivity_ * Density(height_m);
  }
  [[nodiscard]] double Height(const State& at) const {
    return std::hypot(at.x, at.y) - medium_.planet_radius_m;
  }
  /// From far outside to the top, straight.
  void EnterAir(State& at) const {
    const double radius = std::hypot(at.x, at.y);
    const double top = medium_.planet_radius_m + medium_.atmosphere_height_m;
    if (radius <= top) return;
    const double along = -(at.x * at.p + at.y * at.q);
    const double nearest = radius * radius - along * along;
    if (along <= 0.0 || nearest >= top * top) return;
    const double length = along - std::sqrt(top * top - nearest);
    at.x += length * at.p;
    at.y += length * at.q;
  }
  [[nodiscard]] State Slope(const State& at) const {
    const double height = Height(at);
    const double n = 1.0 + Refractivity(height);
    const double gradient =
        refractivity_ * (Density(height + 0.5) - Density(height - 0.5));  // a metre up
    const double radius = std::hypot(at.x, at.y);
    return {at.p / n, at.q / n, gradient * at.x / radius, gradient * at.y / radius};
  }
  static State Add(const State& a, double s, const State& b) {
    return {a.x + s * b.x, a.y + s * b.y, a.p + s * b.p, a.q + s * b.q};
  }
  /// Runge and Kutta's fourth order.
  [[nodiscard]] State Stepped(const State& at, double step) const {
    const State k1 = Slope(at), k2 = Slope(Add(at, 0.5 * step, k1)),
                k3 = Slope(Add(at, 0.5 * step, k2)), k4 = Slope(Add(at, step, k3));
    return Add(Add(Add(Add(at, step / 6.0, k1), step / 3.0, k2), step / 3.0, k3), step / 6.0, k4);
  }

  const Medium& medium_;
  double refractivity_;
};

constexpr std::array kHeights_m{0.0, 2.0, 100.0, 3000.0, 12e3, 40e3, 110e3, 400e3, 36e6};

TEST(BentView, ApparentElevationIsThatOfTheRayEquationFromTheHorizonUpAtEveryHeight) {
  const Medium medium = MediumPreset("earth");
  for (const double height : kHeights_m) {
    const BentView view(medium, height);
    for (const double over : {0.01, 0.1, 0.3, 1.0, 4.0, 15.0, 60.0}) {
      const double elevation = view.horizon_rad() + over * kDegree;
      for (const std::size_t band : {std::size_t{0}, medium.wavelengths_nm.size() - 1}) {
        const RayEquation judge(medium, PeckAndReeder(medium.wavelengths_nm[band]));
        const double refraction = judge.Follow(elevation, height).refraction_rad;
        EXPECT_NEAR((elevation - view.TrueElevation(elevation, band)) / kMinute,
                    refraction / kMinute, 0.1)
            << "a tenth of an arcminute; blue and red have horizons of their own below 0.01 "
               "degrees; "
            << height << " m, " << over << " degrees over the horizon, band " << band;
      }
    }
  }
}

TEST(BentView, TheSettingDiskIsAsFlatAsByTheRayEquation) {
  const Medium medium = MediumPreset("earth");
  const RayEquation judge(medium, PeckAndReeder(kHorizonWavelength_nm));
  constexpr double kDiameter = 32.0 * kMinute;
  for (const double height : {2.0, 3000.0, 12e3}) {
    const BentView view(medium, height);
    const double horizon = view.horizon_rad();
    // The lower limb stands on the horizon, the upper where the judge finds what is as much higher.
    const double lower = horizon + 1e-3 * kMinute;
    const double truly = lower - judge.Follow(lower, height).refraction_rad + kDiameter;
    double upper = lower + kDiameter;
    for (int i = 0; i < 12; ++i) upper = truly + judge.Follow(upper, height).refraction_rad;
    const double flat =
        (view.ApparentElevationOf(view.TrueElevation(lower) + kDiameter) - lower) / kDiameter;
    EXPECT_NEAR(flat, (upper - lower) / kDiameter, 0.002) << height << " m";
    EXPECT_LT(flat, 0.91) << "to be seen with the naked eye";
  }
}

TEST(BentView, TheUpperRimIsGreenAndBlueByTheDispersionOfAir) {
  const BentView view(MediumPreset("earth", {450.0, 550.0, 650.0}), 2.0);
  // Young (2000), Optics and Photonics News 11(3), 31-37: at the horizon green is lifted by some 10
  // to 20 arcseconds over red.
  const double red_to_green =
      view.TrueElevation(view.horizon_rad(), 2) - view.TrueElevation(view.horizon_rad(), 1);
  const double green_to_blue =
      view.TrueElevation(view.horizon_rad(), 1) - view.TrueElevation(view.horizon_rad(), 0);
  EXPECT_NEAR(red_to_green * 60.0 / kMinute, 13.0, 5.0);
  EXPECT_GT(green_to_blue, red_to_green);
}

TEST(BentView, TheHorizonLiesWhereRaysOfTheEquationJustMissTheGround) {
  const Medium medium = MediumPreset("earth");
  const RayEquation judge(medium, PeckAndReeder(kHorizonWavelength_nm));
  for (const double height : {2.0, 100.0, 3000.0, 12e3, 400e3}) {
    const BentView view(medium, height);
    const double little = 0.02 * kMinute;
    EXPECT_FALSE(judge.Follow(view.horizon_rad() + little, height).is_ground) << height;
    EXPECT_TRUE(judge.Follow(view.horizon_rad() - little, height).is_ground) << height;
    const double geometric = -std::acos(medium.planet_radius_m / (medium.planet_radius_m + height));
    EXPECT_GT(view.horizon_rad(), geometric) << "air lifts the horizon";
    // As far as the horizon but for where the ray is almost level.
    const double below = view.horizon_rad() - 0.01 * std::max(-view.horizon_rad(), 1e-3);
    const auto ground = view.ToGround(below);
    ASSERT_TRUE(ground);
    const auto found = judge.Follow(below, height);
    ASSERT_TRUE(found.is_ground);
    EXPECT_NEAR(ground->angle_rad / found.angle_rad, 1.0, 0.002) << height << " m";
  }
}

TEST(BentView, GroundNearByIsWhereStraightRaysFindIt) {
  const Medium medium = MediumPreset("earth");
  const BentView view(medium, 2.0);
  for (const double degrees : {-10.0, -45.0, -89.0}) {
    const double range_m = view.ToGround(degrees * kDegree)->angle_rad * medium.planet_radius_m;
    EXPECT_NEAR(range_m, 2.0 / std::tan(-degrees * kDegree), 1e-3) << degrees << ": a millimetre";
  }
  EXPECT_FALSE(view.ToGround(0.01)) << "the sky";
}

TEST(BentView, TheSunShinesThroughTheColumnOfTheBentRay) {
  const Medium medium = MediumPreset("earth");
  const RayEquation judge(medium, PeckAndReeder(kHorizonWavelength_nm)), straight(medium, 0.0);
  Medium clear = medium;
  clear.mie_extinction_per_m.assign(medium.wavelengths_nm.size(), 0.0);
  for (const double height : {2.0, 3000.0, 40e3}) {
    const BentView view(clear, height);
    for (const double over : {0.01, 0.5, 2.0, 6.0}) {
      const double elevation = view.horizon_rad() + over * kDegree;
      const double bent_m = judge.Follow(elevation, height).column_m;
      const double more_m = bent_m - straight.Follow(elevation, height).column_m;
      EXPECT_NEAR(view.MoreOpticalDepth(elevation, 0) / medium.rayleigh_scattering_per_m[0], more_m,
                  0.002 * bent_m)
          << height << " m, " << over << " degrees over the horizon";
    }
  }
}

TEST(BentView, NoAirBendsNothing) {
  Medium medium = MediumPreset("earth");
  for (double& scattering : medium.rayleigh_scattering_per_m) scattering = 0.0;
  const BentView view(medium, 1000.0);
  EXPECT_EQ(view.TrueElevation(0.3, 0), 0.3);
  EXPECT_NEAR(view.horizon_rad(),
              -std::acos(medium.planet_radius_m / (medium.planet_radius_m + 1000.0)), 1e-12);
  EXPECT_EQ(view.MoreOpticalDepth(0.0, 0), 0.0);
}

TEST(BentView, AirThatWouldTrapRaysIsTakenToBendNone) {
  Medium medium = MediumPreset("earth");
  medium.rayleigh_scale_height_m = 500.0;
  medium.rayleigh_deficit = {};
  EXPECT_FALSE(GentlyBends(BendingAirOf(medium, 550.0)));
  EXPECT_EQ(BentView(medium, 2.0).TrueElevation(0.0, 0), 0.0);
}

}  // namespace
}  // namespace alpenglow
