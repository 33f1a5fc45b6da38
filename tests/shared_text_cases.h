// SPDX-License-Identifier: MIT
// Every function of the shared texts, written once as an expression, with the hard inputs it is
// tested on: read as double and float by the tests of the folders, as GLSL by tests/viewer.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "atmosphere/phase_text.h"
#include "atmosphere/shell.h"
#include "lut/scattering_map.h"
#include "lut/tone_curve.h"
#include "lut/transmittance_map.h"

namespace alpenglow::tests {

inline constexpr std::size_t kArguments = 8;
template <typename Real>
using Arguments = std::array<Real, kArguments>;

/// One expression in a[0] ... a[7], valid as C++ and as GLSL.
struct SharedTextCase {
  std::string glsl;
  std::function<double(const Arguments<double>&)> in_double;
  std::function<float(const Arguments<float>&)> in_float;
  std::vector<Arguments<float>> points;
  double full_scale;  // of a coordinate, a code or a cosine that a map gives; else 0
};

inline Arguments<double> Widen(const Arguments<float>& a) {
  Arguments<double> wide{};
  for (std::size_t i = 0; i < kArguments; ++i) wide[i] = static_cast<double>(a[i]);
  return wide;
}

/// What a float reading may differ by from the exact value of the expression at the same arguments:
/// 1e-5 of the value, plus what one unit in the last place of each argument changes. The second
/// term is the conditioning of the question, not of the formula: near the top of the atmosphere, or
/// where a descending ray has come back to low altitude, an argument rounded to float fixes the
/// answer no better. Coordinates in a table and codes of a display may differ by 1e-6 of full scale
/// (a texel is 4e-3 of it, the step of an 8-bit picture too). Values below 1e-30, where GPUs may
/// flush to 0, agree when both are.
inline double Allowance(const SharedTextCase& c, const Arguments<float>& a) {
  const Arguments<double> exact = Widen(a);
  const double value = c.in_double(exact);
  double allowance = 1e-5 * std::abs(value) + 1e-6 * c.full_scale + 1e-30;
  for (std::size_t i = 0; i < kArguments; ++i) {
    double largest = 0.0;
    for (const float towards : {-1e30F, 1e30F}) {
      Arguments<double> moved = exact;
      moved[i] = static_cast<double>(std::nextafterf(a[i], towards));
      const double change = std::abs(c.in_double(moved) - value);
      if (change > largest) largest = change;
    }
    allowance += largest;
  }
  return allowance;
}

namespace grid {

inline constexpr float kRadius_km = 6371.0F;
inline constexpr float kTop_km = 120.0F;

/// Altitudes [km] from the ground over 0.01 m to 400 km.
inline std::vector<float> Altitudes() {
  return {0.0F,  1e-5F, 1e-3F, 2e-3F, 0.03F, 0.3F,     1.0F,   3.0F,   10.0F,
          12.3F, 25.0F, 33.3F, 40.0F, 80.0F, 119.999F, 120.0F, 250.0F, 400.0F};
}

/// Cosines over all view angles: straight up and down, horizontal, and close to the horizon of h.
inline std::vector<float> Cosines(float h) {
  std::vector<float> cosines{1.0F, -1.0F, 0.0F, 1e-7F, -1e-7F, 1.0F - 6e-8F, -1.0F + 6e-8F};
  for (int i = -9; i <= 9; ++i) cosines.push_back(0.1F * static_cast<float>(i) + 0.013F);
  const auto horizon =
      static_cast<float>(shared::HorizonCosine<double>(static_cast<double>(h), 6371.0));
  cosines.push_back(horizon);
  cosines.push_back(std::nextafterf(horizon, 1.0F));
  cosines.push_back(std::nextafterf(horizon, -1.0F));
  for (const float step : {1e-6F, 1e-5F, 1e-4F, 1e-3F, 1e-2F}) {
    cosines.push_back(horizon + step);
    cosines.push_back(horizon - step);
    cosines.push_back(step);
    cosines.push_back(-step);
  }
  return cosines;
}

/// (h, mu) with R and the top behind them, for altitudes up to `highest`.
inline std::vector<Arguments<float>> Rays(float highest = 400.0F) {
  std::vector<Arguments<float>> points;
  for (const float h : Altitudes()) {
    if (h > highest) continue;
    for (const float mu : Cosines(h)) points.push_back({h, mu, kRadius_km, kTop_km});
  }
  return points;
}

/// (h, mu) of rays that go up, at most horizontal, for altitudes up to `highest`.
inline std::vector<Arguments<float>> UpwardRays(float highest = 400.0F) {
  std::vector<Arguments<float>> points;
  for (const Arguments<float>& point : Rays(highest)) {
    if (point[1] >= 0.0F) points.push_back(point);
  }
  return points;
}

/// (h, mu) of rays of any direction that do not meet the ground.
inline std::vector<Arguments<float>> RaysToSpace(float highest = 400.0F) {
  std::vector<Arguments<float>> points;
  for (const Arguments<float>& point : Rays(highest)) {
    const Arguments<double> a = Widen(point);
    if (a[1] >= 0.0 || shared::PerigeeAltitude(a[0], a[1], a[2]) > 0.0) points.push_back(point);
  }
  return points;
}

/// (h, mu, R, d): points along rays, from 1 mm to the far side of the shell, kept above the ground.
inline std::vector<Arguments<float>> PointsAlongRays() {
  std::vector<Arguments<float>> points;
  for (const Arguments<float>& ray : Rays()) {
    for (const float d : {0.0F, 1e-6F, 1e-3F, 0.1F, 3.0F, 30.0F, 300.0F, 1000.0F, 2000.0F}) {
      const double h = shared::AltitudeAlongRay<double>(
          static_cast<double>(ray[0]), static_cast<double>(ray[1]), static_cast<double>(d), 6371.0);
      if (h >= 0.0) points.push_back({ray[0], ray[1], kRadius_km, d, static_cast<float>(h)});
    }
  }
  return points;
}

/// (h, mu, R, z): rays and altitudes above them.
inline std::vector<Arguments<float>> RaysAndHigherAltitudes() {
  std::vector<Arguments<float>> points;
  for (const Arguments<float>& ray : Rays()) {
    for (const float z : Altitudes()) {
      if (z >= ray[0]) points.push_back({ray[0], ray[1], kRadius_km, z});
    }
  }
  return points;
}

/// (h, mu, R, z): descending rays and altitudes that they reach. A ray that only grazes z within
/// 1 m is left out: whether float rounds it to a hit is GroundClearance's question.
inline std::vector<Arguments<float>> RaysAndLowerAltitudes() {
  std::vector<Arguments<float>> points;
  for (const Arguments<float>& ray : Rays()) {
    for (const float z : Altitudes()) {
      const double perigee = shared::PerigeeAltitude<double>(static_cast<double>(ray[0]),
                                                             static_cast<double>(ray[1]), 6371.0);
      if (ray[1] < 0.0F && z <= ray[0] && perigee < static_cast<double>(z) - 1e-3) {
        points.push_back({ray[0], ray[1], kRadius_km, z});
      }
    }
  }
  return points;
}

/// (cosine, g, g_back, back_weight or alpha), |g| up to `sharpest`.
inline std::vector<Arguments<float>> Scattering(float sharpest = 1.0F) {
  std::vector<Arguments<float>> points;
  for (const float g : {0.0F, 0.1F, 0.64F, 0.8F, 0.9F, 0.999F, -0.3F, -0.999F}) {
    if (std::abs(g) > sharpest) continue;
    for (const float c : {1.0F, -1.0F, 1.0F - 6e-8F, 0.99999F, 0.9999F, 0.99F, 0.5F, 0.0F, -0.7F,
                          -0.9999F, 1.0000001F, -1.0000001F}) {
      points.push_back({c, g, -0.5F, 0.25F});
    }
  }
  return points;
}

/// (h, x, R, top) with x in [0, 1], for altitudes up to the top.
inline std::vector<Arguments<float>> UnitsAtAltitudes() {
  std::vector<Arguments<float>> points;
  for (const float h : Altitudes()) {
    if (h > kTop_km) continue;
    for (const float x : {0.0F, 1e-6F, 1e-3F, 0.1F, 0.25F, 0.5F, 0.77F, 0.999F, 1.0F}) {
      points.push_back({h, x, kRadius_km, kTop_km});
    }
  }
  return points;
}

/// (h, mu, R, top) of rays that meet the ground, for altitudes up to the top.
inline std::vector<Arguments<float>> RaysToGround() {
  std::vector<Arguments<float>> points;
  for (const Arguments<float>& ray : Rays(kTop_km)) {
    const Arguments<double> a = Widen(ray);
    const double perigee = shared::PerigeeAltitude(a[0], a[1], a[2]);
    if (a[1] < 0.0 && perigee < -1e-3) points.push_back(ray);
  }
  return points;
}

/// Exposed colours (red, green, blue) and a scale: black, deep shade, the sun's disk, saturated,
/// out of gamut.
inline std::vector<Arguments<float>> Colours() {
  std::vector<Arguments<float>> points;
  for (const float y : {0.0F, 1e-5F, 0.003F, 0.04F, 0.18F, 0.5F, 1.0F, 4.0F, 60.0F, 1e5F}) {
    points.push_back({y, y, y, 1.0F});
    points.push_back({y, 0.7F * y, 0.2F * y, 0.01F});
    points.push_back({0.05F * y, 0.3F * y, y, 7.0F});
    points.push_back({y, -0.1F * y, 0.2F * y, 1.0F});
  }
  return points;
}

}  // namespace grid

// The macro reads its expression twice: as C++ for double and float, and as text for GLSL.
#define ALPENGLOW_SHARED_CASE(expression, points)    \
  MakeSharedTextCase(                                \
      #expression,                                   \
      [](const auto& a) {                            \
        using namespace alpenglow::shared;           \
        using Number = std::decay_t<decltype(a[0])>; \
        static_cast<void>(Number{});                 \
        return static_cast<Number>(expression);      \
      },                                             \
      points)

template <typename Function>
SharedTextCase MakeSharedTextCase(const char* glsl, Function f,
                                  std::vector<Arguments<float>> points) {
  return {glsl, [f](const Arguments<double>& a) { return f(a); },
          [f](const Arguments<float>& a) { return f(a); }, std::move(points), 0.0};
}

inline std::vector<SharedTextCase> ShellCases() {
  return {
      ALPENGLOW_SHARED_CASE(AltitudeAlongRay(a[0], a[1], a[3], a[2]), grid::PointsAlongRays()),
      ALPENGLOW_SHARED_CASE(ZenithCosineAlongRay(a[0], a[1], a[3], a[4], a[2]),
                            grid::PointsAlongRays()),
      ALPENGLOW_SHARED_CASE(SunCosineAlongRay(a[0], Number(0.02), a[1], a[3], a[4], a[2]),
                            grid::PointsAlongRays()),
      ALPENGLOW_SHARED_CASE(HorizonDistance(a[0], a[2]), grid::Rays()),
      ALPENGLOW_SHARED_CASE(HorizonCosine(a[0], a[2]), grid::Rays()),
      ALPENGLOW_SHARED_CASE(PerigeeAltitude(a[0], a[1], a[2]), grid::Rays()),
      ALPENGLOW_SHARED_CASE(DistanceUpTo(a[0], a[1], a[3], a[2]), grid::RaysAndHigherAltitudes()),
      ALPENGLOW_SHARED_CASE(DistanceDownTo(a[0], a[1], a[3], a[2]), grid::RaysAndLowerAltitudes()),
      ALPENGLOW_SHARED_CASE(GroundClearance(a[0], a[1], a[2]), grid::Rays()),
  };
}

/// Columns upwards, and towards space below the horizontal, of both scale heights and the tent.
inline std::vector<SharedTextCase> OpticalDepthCases() {
  return {
      ALPENGLOW_SHARED_CASE(ColumnJ0(abs(a[1])), grid::Rays()),
      ALPENGLOW_SHARED_CASE(ColumnJ2(abs(a[1])), grid::Rays()),
      ALPENGLOW_SHARED_CASE(ChapmanUp((a[2] + a[0]) / Number(8.0), a[1]), grid::UpwardRays()),
      ALPENGLOW_SHARED_CASE(ExponentialColumnToInfinity(a[0], a[1], Number(1.2), a[2]),
                            grid::UpwardRays(120.0F)),
      ALPENGLOW_SHARED_CASE(ExponentialColumnUp(a[0], a[1], Number(8.0), a[3], a[2]),
                            grid::UpwardRays(120.0F)),
      ALPENGLOW_SHARED_CASE(ExponentialColumnUp(a[0], a[1], Number(1.2), a[3], a[2]),
                            grid::UpwardRays(120.0F)),
      ALPENGLOW_SHARED_CASE(TentDensity(a[0], Number(10.0), Number(25.0), Number(40.0)),
                            grid::Rays()),
      ALPENGLOW_SHARED_CASE(
          TentPieceColumn(a[0], a[1], Number(0.0), DistanceUpTo(a[0], a[1], Number(10.0), a[2]),
                          Number(-5.0), Number(10.0), Number(40.0), a[2]),
          grid::UpwardRays(3.0F)),
      ALPENGLOW_SHARED_CASE(
          TentColumnUp(a[0], a[1], Number(10.0), Number(25.0), Number(40.0), a[2]),
          grid::UpwardRays(120.0F)),
      ALPENGLOW_SHARED_CASE(SmoothOzoneDensity(abs(a[0]), Number(66.0)), grid::Rays()),
      ALPENGLOW_SHARED_CASE(
          SmoothOzonePair(a[0], a[1], Number(30.0), Number(20.0), Number(66.0), a[2]),
          grid::UpwardRays(30.0F)),
      ALPENGLOW_SHARED_CASE(SmoothOzoneColumnUp(a[0], a[1], Number(66.0), a[2]),
                            grid::UpwardRays(120.0F)),
      ALPENGLOW_SHARED_CASE(
          ColumnToSun(a[1], SmoothOzoneColumnUp(a[0], abs(a[1]), Number(66.0), a[2]),
                      SmoothOzoneColumnUp(PerigeeAltitude(a[0], a[1], a[2]), Number(0.0),
                                          Number(66.0), a[2])),
          grid::RaysToSpace(120.0F)),
      ALPENGLOW_SHARED_CASE(
          ColumnToSun(a[1], ExponentialColumnUp(a[0], abs(a[1]), Number(8.0), a[3], a[2]),
                      ExponentialColumnUp(PerigeeAltitude(a[0], a[1], a[2]), Number(0.0),
                                          Number(8.0), a[3], a[2])),
          grid::RaysToSpace(120.0F)),
      ALPENGLOW_SHARED_CASE(
          ColumnToSun(a[1], ExponentialColumnUp(a[0], abs(a[1]), Number(1.2), a[3], a[2]),
                      ExponentialColumnUp(PerigeeAltitude(a[0], a[1], a[2]), Number(0.0),
                                          Number(1.2), a[3], a[2])),
          grid::RaysToSpace(120.0F)),
      ALPENGLOW_SHARED_CASE(
          ColumnToSun(a[1],
                      TentColumnUp(a[0], abs(a[1]), Number(10.0), Number(25.0), Number(40.0), a[2]),
                      TentColumnUp(PerigeeAltitude(a[0], a[1], a[2]), Number(0.0), Number(10.0),
                                   Number(25.0), Number(40.0), a[2])),
          grid::RaysToSpace(120.0F)),
      ALPENGLOW_SHARED_CASE(ColumnBetween(a[1], Number(1.0), a[0], Number(0.0), Number(0.0)),
                            grid::UpwardRays()),
  };
}

inline std::vector<SharedTextCase> PhaseCases() {
  return {
      ALPENGLOW_SHARED_CASE(PhaseRayleigh(a[0]), grid::Scattering()),
      ALPENGLOW_SHARED_CASE(PhaseHenyeyGreenstein(a[0], a[1]), grid::Scattering()),
      ALPENGLOW_SHARED_CASE(PhaseDoubleHenyeyGreenstein(a[0], a[1], a[2], a[3]),
                            grid::Scattering()),
      ALPENGLOW_SHARED_CASE(PhaseDraine(a[0], a[1], a[3]), grid::Scattering()),
      ALPENGLOW_SHARED_CASE(PhaseCornetteShanks(a[0], a[1]), grid::Scattering()),
      ALPENGLOW_SHARED_CASE(PhaseSchlick(a[0], a[1]), grid::Scattering(0.93F)),
      ALPENGLOW_SHARED_CASE(PhaseHenyeyGreensteinDraine(a[0], a[1], a[2], a[3], Number(17.0)),
                            grid::Scattering()),
      ALPENGLOW_SHARED_CASE(PhaseFog(a[0], Number(5.0) + Number(45.0) * a[3]), grid::Scattering()),
      ALPENGLOW_SHARED_CASE(PhaseFog(a[0], Number(2.0) + Number(4.0) * a[3]), grid::Scattering()),
  };
}

inline std::vector<SharedTextCase> TableMapCases() {
  return {
      ALPENGLOW_SHARED_CASE(TexelFromUnit(a[1], Number(32.0)), grid::UnitsAtAltitudes()),
      ALPENGLOW_SHARED_CASE(UnitFromTexel(a[1], Number(32.0)), grid::UnitsAtAltitudes()),
      ALPENGLOW_SHARED_CASE(UnitFromAltitude(a[0], a[3], a[2]), grid::UnitsAtAltitudes()),
      ALPENGLOW_SHARED_CASE(AltitudeFromUnit(a[1], a[3], a[2]), grid::UnitsAtAltitudes()),
      ALPENGLOW_SHARED_CASE(SkyDistanceRange(a[0], a[3], a[2]) / Number(1000.0),
                            grid::UnitsAtAltitudes()),
      ALPENGLOW_SHARED_CASE(
          ZenithCosineFromSkyExcess(a[1] * Number(1000.0), a[0], Number(125.0), a[2]),
          grid::UnitsAtAltitudes()),
      ALPENGLOW_SHARED_CASE(UnitFromSkyCosine(a[0], a[1], Number(125.0), a[2]),
                            grid::RaysToSpace(grid::kTop_km)),
      ALPENGLOW_SHARED_CASE(SkyCosineFromUnit(a[1], a[0], Number(125.0), a[2]),
                            grid::UnitsAtAltitudes()),
      ALPENGLOW_SHARED_CASE(UnitFromGroundCosine(a[0], a[1], a[2]), grid::RaysToGround()),
      ALPENGLOW_SHARED_CASE(GroundCosineFromUnit(a[1], a[0], a[2]), grid::UnitsAtAltitudes()),
      ALPENGLOW_SHARED_CASE(MuTexelFromUnit(a[1], Number(1.0), Number(128.0)),
                            grid::UnitsAtAltitudes()),
      ALPENGLOW_SHARED_CASE(MuTexelFromUnit(a[1], Number(0.0), Number(128.0)),
                            grid::UnitsAtAltitudes()),
      ALPENGLOW_SHARED_CASE(GroundFromMuTexel(a[1]), grid::UnitsAtAltitudes()),
      ALPENGLOW_SHARED_CASE(UnitFromMuTexel(a[1], Number(128.0)), grid::UnitsAtAltitudes()),
      ALPENGLOW_SHARED_CASE(SunbeamExcess(a[1], a[3], a[2]), grid::Rays()),
      ALPENGLOW_SHARED_CASE(UnitFromSunCosine(a[1], Number(-0.3), a[3], a[2]), grid::Rays()),
      ALPENGLOW_SHARED_CASE(SunCosineFromUnit(a[1], Number(-0.3), a[3], a[2]),
                            grid::UnitsAtAltitudes()),
      ALPENGLOW_SHARED_CASE(UnitFromScatteringCosine(a[1]), grid::Rays()),
      ALPENGLOW_SHARED_CASE(ScatteringCosineFromUnit(a[1]), grid::UnitsAtAltitudes()),
      ALPENGLOW_SHARED_CASE(PossibleScatteringCosine(Number(0.4), a[1], Number(0.3)), grid::Rays()),
  };
}

inline std::vector<SharedTextCase> ToneCurveCases() {
  return {
      ALPENGLOW_SHARED_CASE(Luminance(a[0], a[1], a[2]), grid::Colours()),
      ALPENGLOW_SHARED_CASE(ExposedChannel(a[0], a[3]), grid::Colours()),
      ALPENGLOW_SHARED_CASE(PrintedChannel(a[0]), grid::Colours()),
      ALPENGLOW_SHARED_CASE(InnerChannel(a[0], min(a[0], min(a[1], a[2])), abs(a[0])),
                            grid::Colours()),
      ALPENGLOW_SHARED_CASE(AgxWhiteShare(a[0], a[1], a[2]), grid::Colours()),
      ALPENGLOW_SHARED_CASE(AgxLogCode(AgxInset(a[0], AgxWhiteShare(a[0], a[1], a[2]))),
                            grid::Colours()),
      ALPENGLOW_SHARED_CASE(AgxSigmoid(a[1]), grid::UnitsAtAltitudes()),
      ALPENGLOW_SHARED_CASE(AgxCode(a[0], AgxWhiteShare(a[0], a[1], a[2])), grid::Colours()),
      ALPENGLOW_SHARED_CASE(AgxLight(a[1], Number(0.5)), grid::UnitsAtAltitudes()),
      ALPENGLOW_SHARED_CASE(AcesCurve(AcesRed(abs(a[0]), abs(a[1]), abs(a[2]))), grid::Colours()),
      ALPENGLOW_SHARED_CASE(AcesCurve(AcesGreen(abs(a[0]), abs(a[1]), abs(a[2]))), grid::Colours()),
      ALPENGLOW_SHARED_CASE(AcesCurve(AcesBlue(abs(a[0]), abs(a[1]), abs(a[2]))), grid::Colours()),
      ALPENGLOW_SHARED_CASE(AcesLightRed(a[0], a[1], a[2]), grid::Colours()),
      ALPENGLOW_SHARED_CASE(AcesLightGreen(a[0], a[1], a[2]), grid::Colours()),
      ALPENGLOW_SHARED_CASE(AcesLightBlue(a[0], a[1], a[2]), grid::Colours()),
      ALPENGLOW_SHARED_CASE(ReinhardLuminance(abs(a[0])), grid::Colours()),
      ALPENGLOW_SHARED_CASE(
          ReinhardLight(abs(a[0]), max(a[0], max(a[1], a[2])), Luminance(a[0], abs(a[1]), a[2])),
          grid::Colours()),
      ALPENGLOW_SHARED_CASE(
          NeutralLight(abs(a[0]), max(a[0], max(abs(a[1]), a[2])), min(a[0], min(abs(a[1]), a[2]))),
          grid::Colours()),
      ALPENGLOW_SHARED_CASE(SrgbCode(a[1]), grid::UnitsAtAltitudes()),
      ALPENGLOW_SHARED_CASE(SrgbLight(a[1]), grid::UnitsAtAltitudes()),
  };
}

inline std::vector<SharedTextCase> AllSharedTextCases() {
  std::vector<SharedTextCase> all;
  for (const auto& part : {ShellCases(), OpticalDepthCases(), PhaseCases()}) {
    all.insert(all.end(), part.begin(), part.end());
  }
  for (const auto& part : {TableMapCases(), ToneCurveCases()}) {
    for (const SharedTextCase& c : part) {
      all.push_back(c);
      all.back().full_scale = 1.0;
    }
  }
  return all;
}

}  // namespace alpenglow::tests
