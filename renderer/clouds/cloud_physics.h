// SPDX-License-Identifier: MIT
// Water, droplets and crystals in the core of a cloud, and its extinction, as functions of altitude.
//
//   w(z)     = f_ad c_w (z - z_base)                                 water of a lifted parcel
//   c_w      = rho_air (c_p / L) (Gamma_d - Gamma_s)                 Albrecht, Fairall, Thomson, White,
//              Snider and Schubert (1990), Geophys. Res. Lett. 17, 89
//   r_eff^3  = 3 w / (4 pi rho_w k N),  k = r_v^3 / r_eff^3          Martin, Johnson and Spice (1994),
//              J. Atmos. Sci. 51, 1823: k = 0.80 over the sea, 0.67 over land
//   sigma    = Q_ext 3 w / (4 rho r_eff),  Q_ext = 2                 Stephens (1978), J. Atmos. Sci.
//              35, 2123
//
// Hence sigma ~ (z - z_base)^(2/3) N^(1/3). Q_ext = 2 is the limit of large spheres. Ice has
// the same relation with the density of ice, if r_eff is three quarters of volume over mean projected
// area (Foot 1988, Quart. J. R. Met. Soc. 114, 145).
#pragma once

#include <cstddef>
#include <vector>

namespace alpenglow::renderer {

/// Air at the base of a cloud.
struct BaseAir {
  double temperature_K;
  double pressure_Pa;
};

/// Returns the air of the standard atmosphere (ISO 2533) in the troposphere.
/// @param altitude_m  in [-500, 11000].
[[nodiscard]] BaseAir StandardBaseAir(double altitude_m);

/// Returns the water that condenses per metre of ascent, c_w [kg m^-3 m^-1]. The saturation pressure
/// is that of Bolton (1980), Mon. Wea. Rev. 108, 1046, equation 10; the lapse rate of saturated air
/// is that of the AMS Glossary, "moist-adiabatic lapse rate".
/// @param air  temperature in [200, 320] K, pressure in [1e4, 1.1e5] Pa.
[[nodiscard]] double CondensationRate_kg_per_m4(const BaseAir& air);

/// Returns the effective radius of droplets [um]; 0 without water.
/// @param number_per_m3  > 0. @param k  in (0, 1].
[[nodiscard]] double DropletRadius_um(double water_kg_per_m3, double number_per_m3, double k);

/// Returns the extinction of spheres much larger than the wavelength [1/m]; 0 without water.
/// @param radius_um  effective radius, > 0 where there is water.
[[nodiscard]] double WaterExtinction_per_m(double water_kg_per_m3, double radius_um);
/// Returns the same of ice crystals.
[[nodiscard]] double IceExtinction_per_m(double ice_kg_per_m3, double radius_um);

/// The core of a cloud at one altitude.
struct CloudLevel {
  double water_kg_per_m3 = 0.0;      // liquid or ice
  double effective_radius_um = 1.0;  // > 0
  double extinction_per_m = 0.0;
};

/// Droplets in the core of a cloud.
struct DropletOptions {
  double base_altitude_m = 0.0;
  double condensation_kg_per_m4 = 2e-6;  // c_w
  double adiabatic_fraction = 1.0;       // f_ad in (0, 1]
  double number_per_cm3 = 100.0;         // N > 0
  double k = 0.8;                        // in (0, 1]
};

/// Returns the core at an altitude. Below the base there is no water, and the radius is 1 um.
[[nodiscard]] CloudLevel DropletLevel(const DropletOptions& options, double altitude_m);

/// The core of a cloud by altitude: a table with linear interpolation. Immutable; safe to use from
/// many threads.
class CloudColumn {
 public:
  /// A column without extinction.
  CloudColumn() = default;
  /// @param levels  at bottom_m, bottom_m + step_m, ...; at least two. Outside them the nearest one
  /// holds.
  CloudColumn(double bottom_m, double step_m, std::vector<CloudLevel> levels);

  [[nodiscard]] double Extinction_per_m(double altitude_m) const {
    return Interpolated(&CloudLevel::extinction_per_m, altitude_m);
  }
  [[nodiscard]] double EffectiveRadius_um(double altitude_m) const {
    return Interpolated(&CloudLevel::effective_radius_um, altitude_m);
  }
  [[nodiscard]] double Water_kg_per_m3(double altitude_m) const {
    return Interpolated(&CloudLevel::water_kg_per_m3, altitude_m);
  }
  /// Returns the column with another number of equal droplets or crystals everywhere.
  /// @param factor  >= 0, of water and extinction.
  [[nodiscard]] CloudColumn Times(double factor) const;
  /// Returns the largest extinction between two altitudes, low <= high.
  [[nodiscard]] double LargestBetween_per_m(double low_m, double high_m) const;

 private:
  [[nodiscard]] double Interpolated(double CloudLevel::*member, double altitude_m) const {
    const double at = (altitude_m - bottom_m_) * per_step_;
    if (!(at > 0.0)) return levels_.front().*member;
    const auto last = levels_.size() - 1;
    if (at >= static_cast<double>(last)) return levels_.back().*member;
    const auto below = static_cast<std::size_t>(at);
    const double share = at - static_cast<double>(below);
    return (1.0 - share) * (levels_[below].*member) + share * (levels_[below + 1].*member);
  }

  double bottom_m_ = 0.0, per_step_ = 1.0;
  std::vector<CloudLevel> levels_{2};
};

/// Returns the column of droplets from the base to `top_m`, in steps of 5 m. The relative error of
/// its extinction and radius is below 1e-3 from 30 m above the base on.
[[nodiscard]] CloudColumn DropletColumn(const DropletOptions& options, double top_m);

/// Returns a column of ice with one water content and one effective radius.
[[nodiscard]] CloudColumn IceColumn(double ice_kg_per_m3, double radius_um);

}  // namespace alpenglow::renderer
