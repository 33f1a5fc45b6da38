// SPDX-License-Identifier: MIT
// Computes the tables of Martian dust in atmosphere/data:
//
//   mars_dust optics > atmosphere/data/mars_dust.csv
//   mars_dust phase  > atmosphere/data/mars_dust_phase.csv
//
// The optics follow from Lorenz-Mie theory for the sizes measured with the Pathfinder camera,
// effective radius 1.7 um and effective variance 0.25 (Markiewicz et al. 1999, J. Geophys. Res.
// 104, 9009-9018), and from the refractive index 1.5 + i k, where k is chosen to give the single
// scattering albedo. Up to 30 degrees from the sun, the phase function is that of spheres: it is
// due to diffraction, which hardly depends on the shape of a particle and whose width grows with
// the wavelength. Dust is not spherical, and spheres scatter too little light sideways. Beyond 30
// degrees, the curve therefore has the shape of the lobes seen from Gale crater (Chen-Chen,
// Perez-Hoyos and Sanchez-Lavega 2019, Icarus 330, 16-29), attached at 30 degrees. The whole curve
// is normalised.
#include <fmt/core.h>

#include <cmath>
#include <complex>
#include <string_view>
#include <vector>

#include "atmosphere/math/constants.h"
#include "atmosphere/medium/phase.h"
#include "tests/fixtures/lorenz_mie.h"

namespace {

using namespace alpenglow::atmosphere;

constexpr SizeDistribution kSizes{.effective_radius_um = 1.7, .effective_variance = 0.25};
constexpr double kRealIndex = 1.5;
constexpr double kJoint_deg = 30.0;

/// Single scattering albedo; ferric iron absorbs blue light. The values represent measurements of
/// the Pathfinder camera (Tomasko et al. 1999, J. Geophys. Res. 104, 8987-9007; Markiewicz et al.
/// 1999) within 0.03.
struct Albedo {
  double wavelength_nm, albedo;
};
constexpr Albedo kAlbedos[] = {{440.0, 0.76}, {480.0, 0.80}, {530.0, 0.87}, {600.0, 0.94},
                               {670.0, 0.97}, {750.0, 0.97}, {830.0, 0.97}};

/// Returns the refractive index for an albedo, which decreases with increasing absorption up to k =
/// 0.1.
std::complex<double> IndexOfAlbedo(const Albedo& at) {
  double low = 1e-5, high = 0.1;
  for (int step = 0; step < 30; ++step) {
    const double k = std::sqrt(low * high);
    const SphereScattering dust = ScatterBySpheres({kRealIndex, k}, kSizes, at.wavelength_nm, {});
    const bool bright = dust.scattering_efficiency > at.albedo * dust.extinction_efficiency;
    (bright ? low : high) = k;
  }
  return {kRealIndex, std::sqrt(low * high)};
}

void PrintOptics() {
  fmt::print(
      "# Dust of Mars by tests/bench/mars_dust.cpp, which names the sources: extinction relative "
      "to "
      "550 nm, single scattering albedo, imaginary part of the refractive index that gives it.\n"
      "wavelength_nm,relative_extinction,albedo,absorption_index\n");
  const Albedo green{550.0, 0.87 + 0.07 * 20.0 / 70.0};
  const double at_550 =
      ScatterBySpheres(IndexOfAlbedo(green), kSizes, 550.0, {}).extinction_efficiency;
  for (const Albedo& at : kAlbedos) {
    const std::complex<double> index = IndexOfAlbedo(at);
    const SphereScattering dust = ScatterBySpheres(index, kSizes, at.wavelength_nm, {});
    fmt::print("{},{:.4f},{},{:.5f}\n", at.wavelength_nm, dust.extinction_efficiency / at_550,
               at.albedo, index.imag());
  }
}

std::vector<double> Angles() {
  std::vector<double> angles;
  for (int i = 0; i < 12; ++i) angles.push_back(0.25 * i);
  for (int i = 6; i < 20; ++i) angles.push_back(0.5 * i);
  for (int i = 10; i < 40; i += 2) angles.push_back(i);
  for (int i = 40; i <= 180; i += 5) angles.push_back(i);
  return angles;
}

void PrintPhase() {
  fmt::print(
      "# Phase function of the dust of Mars by tests/bench/mars_dust.cpp, which names the "
      "sources.\n"
      "wavelength_nm,angle_deg,phase_per_sr\n");
  const PhaseFunction lobes{
      .kind = PhaseKind::kDoubleHenyeyGreenstein, .g = 0.89, .g_back = 0.09, .back_weight = 0.26};
  std::vector<double> fine;
  for (int i = 0; i <= 3600; ++i) fine.push_back(0.05 * i);
  for (const Albedo& at : kAlbedos) {
    const auto curve = [&](std::vector<double> angles_deg) {
      angles_deg.push_back(kJoint_deg);
      std::vector<double> angle_rad(angles_deg);
      for (double& angle : angle_rad) angle *= kRadiansPerDegree;
      std::vector<double> p =
          ScatterBySpheres(IndexOfAlbedo(at), kSizes, at.wavelength_nm, angle_rad).per_sr;
      const double scale = p.back() / Phase(lobes, std::cos(angle_rad.back()));
      for (std::size_t i = 0; i < p.size(); ++i) {
        if (angles_deg[i] > kJoint_deg) p[i] = scale * Phase(lobes, std::cos(angle_rad[i]));
      }
      p.pop_back();
      return p;
    };
    const std::vector<double> whole = curve(fine);
    double integral = 0.0;
    for (std::size_t i = 0; i < fine.size(); ++i) {
      integral +=
          whole[i] * 2.0 * kPi * std::sin(fine[i] * kRadiansPerDegree) * 0.05 * kRadiansPerDegree;
    }
    const std::vector<double> angles = Angles();
    const std::vector<double> values = curve(angles);
    for (std::size_t i = 0; i < angles.size(); ++i) {
      fmt::print("{},{},{:.5g}\n", at.wavelength_nm, angles[i], values[i] / integral);
    }
  }
}

}  // namespace

int main(int count, char** arguments) {
  const std::string_view what = count == 2 ? arguments[1] : "";
  if (what == "optics") {
    PrintOptics();
  } else if (what == "phase") {
    PrintPhase();
  } else {
    fmt::print(stderr, "mars_dust optics|phase: prints a table of atmosphere/data\n");
    return 2;
  }
  return 0;
}
