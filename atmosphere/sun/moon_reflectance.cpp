// SPDX-License-Identifier: MIT
#include "atmosphere/sun/moon_reflectance.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "atmosphere/number/constants.h"

namespace alpenglow::atmosphere {
namespace {

struct Filter {
  double wavelength_nm;
  std::array<double, 4> a;
  std::array<double, 3> d;
};

// Those of the 32 that lie near the smooth curve through all.
constexpr std::array<Filter, 9> kFilters{{
    {350.0, {-2.67511, -1.78539, 0.50612, -0.25578}, {0.34185, 0.01441, -0.01602}},
    {412.3, {-2.34185, -1.74337, 0.42156, -0.21512}, {0.36591, -0.05902, 0.00080}},
    {441.6, {-2.31964, -1.72114, 0.37286, -0.19304}, {0.37935, -0.09562, 0.00970}},
    {486.9, {-2.23351, -1.68573, 0.37632, -0.19877}, {0.36590, -0.08945, 0.00678}},
    {553.8, {-2.12504, -1.65970, 0.38409, -0.20655}, {0.37206, -0.10745, 0.00347}},
    {665.1, {-1.88914, -1.58096, 0.30477, -0.17908}, {0.37141, -0.13514, 0.01248}},
    {745.3, {-1.86896, -1.57522, 0.33712, -0.19415}, {0.36888, -0.14828, 0.00958}},
    {865.3, {-1.74561, -1.58482, 0.35009, -0.19569}, {0.39200, -0.18837, 0.00978}},
    {1059.5, {-1.59323, -1.71358, 0.50599, -0.25178}, {0.48160, -0.29486, 0.00116}},
}};

double LogReflectance(const Filter& filter, double angle_rad) {
  const auto& [a, d] = std::pair{filter.a, filter.d};
  const double degrees = angle_rad / kRadiansPerDegree;
  return a[0] + angle_rad * (a[1] + angle_rad * (a[2] + angle_rad * a[3])) +
         d[0] * std::exp(-degrees / 4.06054) + d[1] * std::exp(-degrees / 12.8802) +
         d[2] * std::cos((degrees + 30.5858) / 16.7498);
}

}  // namespace

double MoonReflectance(double phase_angle_rad, double wavelength_nm) {
  constexpr double kLast_rad = 150.0 * kRadiansPerDegree;
  const double angle_rad = std::min(phase_angle_rad, kLast_rad);
  const auto above = std::find_if(kFilters.begin() + 1, kFilters.end() - 1, [&](const Filter& f) {
    return f.wavelength_nm >= wavelength_nm;
  });
  const auto below = above - 1;
  const double share = std::clamp(
      (wavelength_nm - below->wavelength_nm) / (above->wavelength_nm - below->wavelength_nm), 0.0,
      1.0);
  return (1.0 - share) * std::exp(LogReflectance(*below, angle_rad)) +
         share * std::exp(LogReflectance(*above, angle_rad));
}

}  // namespace alpenglow::atmosphere
