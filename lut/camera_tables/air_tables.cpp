// SPDX-License-Identifier: MIT
#include "lut/camera_tables/air_tables.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

#include "atmosphere/base/error.h"
#include "atmosphere/math/angles.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/phase_text.h"
#include "lut/camera_tables/air_rows.h"
#include "lut/sky/sky_view.h"
#include "lut/tables/transmittance_table.h"

namespace alpenglow::lut {
namespace {

// Returns the angle below the horizontal at which rays from altitude h are tangent to the sphere of
// altitude z; 0 from below it.
double DipToAltitude(double z, double h, double radius) {
  return DipOfHorizon(std::max(h - z, 0.0), radius + h);
}

constexpr std::size_t kBands = 4;
constexpr int kPhaseNodes = 4096;
constexpr int kSunCosines = 256, kSunAltitudes = 64;

// Returns the contributions of molecules, aerosol and everything else in the direction of the sun,
// or in the nearest direction of its azimuth that passes through air. In bands without light there,
// all three are equal.
std::array<glm::vec4, 3> SkyMix(const SingleScattering<float>& air,
                                const MultipleScattering& multiple_scattering, const SkyView& view,
                                const AirMap& map, const EyeUnderLight& eye) {
  const double sun = eye.zenith_angle_seen_rad();
  const double horizon = view.map().horizon_zenith_angle_rad();
  const double margin = std::min(0.02, 0.05 * map.sky_range);
  const double zenith = std::clamp(
      sun, horizon - map.sky_range + (map.altitude > map.top ? margin : 0.0), horizon - margin);
  const ViewRay ray{eye.altitude_m, std::cos(zenith), eye.mu_s(),
                    std::cos(zenith - std::acos(std::clamp(eye.mu_s(), -1.0, 1.0)))};
  const RaySamples<float> samples = air.Sample(ray, {.dark_samples = true});
  const ScatteredOnce<float> once = air.Scatter(samples);
  const glm::vec4 all = Vec4Of(view.Radiance(zenith, 0.0));
  std::array<glm::vec4, 3> mix{Vec4Of(once.rayleigh), Vec4Of(once.mie),
                               Vec4Of(multiple_scattering.InscatterByMoments(samples, ray.nu))};
  for (glm::length_t band = 0; band < 4; ++band) {
    if (!(mix[2][band] > 0.0F)) mix[2][band] = 1e-3F * all[band];
    if (all[band] > 0.0F) continue;
    for (glm::vec4& share : mix) share[band] = 1.0F;
  }
  return mix;
}

double CosineOfPhaseNode(int node) {
  const double half_sine = shared::PhaseHalfSine<double>(Unit(node, kPhaseNodes));
  return 1.0 - 2.0 * half_sine * half_sine;
}

AirTexels PhaseAround(const SingleScattering<float>& air,
                      const MultipleScattering& multiple_scattering, const AirTexels& aerosol,
                      const EyeUnderLight& eye) {
  const float column_km = GlowColumn_km(air, eye.altitude_m, eye.mu_s());
  AirTexels phase = aerosol;
  for (int k = 0; k < phase.width; ++k) {
    const glm::vec4 once = phase.At(k, 0);
    phase.At(k, 0) =
        glm::max(once + Vec4Of(multiple_scattering.GlowFactor(CosineOfPhaseNode(k), column_km)),
                 0.1F * once);
  }
  return phase;
}

float TwilightAtFoot(const AirMap& map, const EyeUnderLight& eye, const AirRow& row, double nu) {
  return TwilightAt(
      map, eye.mu_s(), nu,
      shared::AirFoot<double>(map.altitude, row.mu, row.ground ? 1.0 : 0.0, map.radius));
}

AirTexels SkyTexels(const SkyView& view, const AirMap& map, const AirPhases& phases,
                    const EyeUnderLight& eye, const std::array<glm::vec4, 3>& mix,
                    const AirTablesSize& size) {
  const std::vector<double> azimuths = AzimuthsOf(size.sky_columns);
  const SkyAzimuths prepared(view, azimuths);
  std::vector<float> radiance(azimuths.size() * view.stride());
  AirTexels texels(size.sky_columns, size.sky_rows + size.sky_ground_rows);
  const double mu_s_seen = std::cos(eye.zenith_angle_seen_rad());
  int y = 0;
  for (const AirRow& row : RowsOf(map, size.sky_rows, map.sky_range, size.sky_ground_rows)) {
    view.FillRow(row.zenith_angle, prepared, radiance);
    for (int x = 0; x < size.sky_columns; ++x) {
      const float* light = &radiance[static_cast<std::size_t>(x) * view.stride()];
      const double azimuth = azimuths[static_cast<std::size_t>(x)];
      const double nu = SunCosineOf(row, mu_s_seen, azimuth);
      texels.At(x, y) =
          Quotient(glm::vec4{light[0], light[1], light[2], light[3]} /
                       TwilightAtFoot(map, eye, row, SunCosineOf(row, eye.mu_s(), azimuth)),
                   AirPhases::OfMolecules(nu) * mix[0] + phases.OfAerosol(nu) * mix[1] + mix[2]);
    }
    ++y;
  }
  return texels;
}

SkyView ViewOf(const SingleScattering<float>& air, const MultipleScattering& multiple_scattering,
               const EyeUnderLight& eye, double fineness) {
  SkyViewSize size = SkyViewSizeFor(air.medium(), eye.altitude_m, eye.mu_s());
  for (int* nodes : {&size.sky_rows, &size.ground_rows, &size.azimuths})
    *nodes = static_cast<int>(std::lround(fineness * *nodes));
  return SkyView(air, multiple_scattering, eye.altitude_m, eye.mu_s(), size)
      .WithSunSeenAt(eye.zenith_angle_seen_rad());
}

AirTexels ThroughTexels(const SingleScattering<float>& air, const AirMap& map,
                        const EyeUnderLight& eye, const AirTablesSize& size) {
  AirTexels texels(size.through_rows + size.through_ground_rows, 1);
  int x = 0;
  for (const AirRow& row : RowsOf(map, size.through_rows, map.sky_range, size.through_ground_rows))
    texels.At(x++, 0) = Vec4Of(air.TransmittanceAlong({eye.altitude_m, row.mu, 1.0, row.mu}));
  return texels;
}

/// Returns the fractions of the two phase functions in the light that air scatters at the altitude
/// of the eye, at most 1500 m.
std::array<glm::vec4, 2> SingleMix(const SingleScattering<float>& air, const AirMap& map) {
  constexpr double kHighest = 1500.0;
  const Medium& medium = air.medium();
  const double h = std::min(kMetresPerKilometre * map.altitude, kHighest);
  const AirConstants<float>& constants = air.constants();
  const auto molecules = static_cast<float>(MoleculeDensity(medium, h));
  const auto aerosol = static_cast<float>(std::exp(-h / medium.mie_scale_height_m));
  std::array<glm::vec4, 2> mix{molecules * Vec4Of(constants.rayleigh, constants.bands),
                               aerosol * Vec4Of(constants.mie_scattering, constants.bands)};
  const glm::vec4 all = mix[0] + mix[1];
  for (glm::length_t band = 0; band < 4; ++band) {
    for (glm::vec4& share : mix) share[band] = all[band] > 0.0F ? share[band] / all[band] : 1.0F;
  }
  return mix;
}

}  // namespace

AirMap::AirMap(const Medium& medium, double altitude_m, double twilight_fall_)
    : altitude(std::max(altitude_m, 0.0) / kMetresPerKilometre),
      top(medium.atmosphere_height_m / kMetresPerKilometre),
      radius(medium.planet_radius_m / kMetresPerKilometre),
      horizon_dip(DipToAltitude(0.0, altitude, radius)),
      sky_range(horizon_dip + (altitude > top ? -DipToAltitude(top, altitude, radius) : 0.5 * kPi)),
      air_sky_range(horizon_dip +
                    (altitude > ceiling ? -DipToAltitude(ceiling, altitude, radius) : 0.5 * kPi)),
      ground_range(0.5 * kPi - horizon_dip),
      twilight_fall(twilight_fall_),
      twilight_reference(altitude > ceiling ? radius : radius + altitude) {
  // An eye above all land sees the air below the ceiling through all of the air above it.
  const double layers = altitude * kMetresPerKilometre / medium.rayleigh_scale_height_m;
  sky_crowding = ground_crowding = altitude > ceiling ? 0.0 : 6.0 / (1.0 + layers) - 2.0;
}

// Over the point of the eye's horizon the lowest beam has the height R (1 / cos(angle) - 1), where
// `angle` is the depth of the sun below that horizon.
bool HasSetInView(const Medium& medium, const AirMap& map, const EyeUnderLight& eye) {
  constexpr double kNoShadows_rad = 3.2 * kRadiansPerDegree, kScaleHeights = 3.0;
  const double lower_rad = eye.zenith_angle_seen_rad() - 0.5 * kPi;
  if (lower_rad < kNoShadows_rad) return false;
  const double aerosol_km = kScaleHeights * medium.mie_scale_height_m / kMetresPerKilometre;
  const double below_rad = lower_rad - map.horizon_dip;
  return below_rad > 0.0 && std::cos(below_rad) * (map.radius + aerosol_km) < map.radius;
}

void RequireFourBands(const Medium& medium) {
  RequireInRange(static_cast<double>(medium.wavelengths_nm.size()), 1.0,
                 static_cast<double>(kBands), "number of spectrum.wavelengths_nm");
}

AirTablesSize AirTablesSizeOf(AirQuality quality, double altitude_m) {
  constexpr double kHighUp_m = 25000.0;
  const bool high_up = altitude_m > kHighUp_m;
  const auto with = [&](int sky, double fineness, int columns, int rows, int distances) {
    return AirTablesSize{.sky_columns = sky,
                         .sky_rows = sky,
                         .sky_ground_rows = sky * 2 / 3,
                         .sky_fineness = fineness,
                         .columns = high_up ? 3 * columns : columns,
                         .rows = rows,
                         .ground_rows = rows,
                         .distances = high_up ? (distances + 1) / 2 : distances,
                         .extinction_rows = 2 * rows,
                         .extinction_ground_rows = 2 * rows,
                         .extinction_distances = 2 * distances,
                         .through_rows = 512,
                         .through_ground_rows = 256};
  };
  switch (quality) {
    case AirQuality::kFirst:
      return with(66, 1.0, 12, 12, 9);
    case AirQuality::kLow:
      return with(144, 1.0, 24, 33, 12);
    case AirQuality::kMedium:
      return with(192, 1.25, 33, 48, 17);
    case AirQuality::kHigh:
      break;
  }
  AirTablesSize high = with(192, 1.5, 33, 65, 24);
  // In deep dusk the light halves within the height of a pixel above the horizon.
  high.sky_rows = 288;
  return high;
}

AirTables MakeAirTables(const SolvedAir& solved, const MediumTables& medium,
                        const EyeUnderLight& eye, const AirTablesSize& size) {
  RequireFourBands(solved.medium());
  const SingleScattering<float>& air = solved.single_scattering();
  const MultipleScattering& multiple_scattering = solved.multiple_scattering();
  const SkyView view = ViewOf(air, multiple_scattering, eye, size.sky_fineness);
  const AirMap map(air.medium(), eye.altitude_m,
                   static_cast<double>(multiple_scattering.grid().twilight_fall));
  AirTexels phase = PhaseAround(air, multiple_scattering, medium.phase, eye);
  const AirPhases phases(phase);
  const std::array<glm::vec4, 3> mix = SkyMix(air, multiple_scattering, view, map, eye);
  AirTexels sky = SkyTexels(view, map, phases, eye, mix, size);
  const int rows = size.rows + size.ground_rows;
  AirTables tables{
      size,
      eye,
      map,
      HasSetInView(air.medium(), map, eye),
      mix,
      SingleMix(air, map),
      Vec4Of(air.constants().rayleigh, air.bands()) +
          Vec4Of(air.constants().mie_extinction, air.bands()),
      std::move(phase),
      std::move(sky),
      ThroughTexels(air, map, eye, size),
      AirTexels(size.extinction_distances, size.extinction_rows + size.extinction_ground_rows),
      AirTexels(size.columns, rows, size.distances),
      AirTexels(size.columns, rows, size.distances)};
  FillWays(air, multiple_scattering, AirPhases(medium.phase), tables);
  return tables;
}

MediumTables MakeMediumTables(const SolvedAir& air) {
  using namespace shared;
  RequireFourBands(air.medium());
  MediumTables tables{AirTexels(kPhaseNodes, 1), AirTexels(kSunCosines, 2 * kSunAltitudes)};
  for (int k = 0; k < kPhaseNodes; ++k) {
    const std::vector<double> phase = MiePhaseValues(air.medium(), CosineOfPhaseNode(k));
    for (std::size_t band = 0; band < phase.size(); ++band)
      tables.phase.At(k, 0)[static_cast<glm::length_t>(band)] = static_cast<float>(phase[band]);
  }
  constexpr double kHair = 1e-9;  // offset above the horizon
  const double radius = air.medium().planet_radius_m / kMetresPerKilometre;
  const double top = air.medium().atmosphere_height_m / kMetresPerKilometre;
  for (int y = 0; y < kSunAltitudes; ++y) {
    const double h = AltitudeFromUnit<double>(Unit(y, kSunAltitudes), top, radius);
    for (int x = 0; x < kSunCosines; ++x) {
      const double mu = std::max(SkyCosineFromUnit<double>(Unit(x, kSunCosines), h, top, radius),
                                 HorizonCosine<double>(h, radius) + kHair);
      const double altitude_m = kMetresPerKilometre * h;
      tables.to_sun.At(x, y) = Vec4Of(air.single_scattering().TransmittanceToSpace(altitude_m, mu));
      tables.to_sun.At(x, kSunAltitudes + y) = Vec4Of(air.BeamLeft(altitude_m, mu));
    }
  }
  return tables;
}

std::shared_ptr<const TabulatedAir> TabulateAir(const Medium& medium, AirSolution solution) {
  RequireFourBands(medium);
  tbb::task_arena one_thread(1);
  return one_thread.execute([&] {
    SolvedAir air(medium, solution);
    MediumTables tables = MakeMediumTables(air);
    return std::make_shared<const TabulatedAir>(TabulatedAir{std::move(air), std::move(tables)});
  });
}

}  // namespace alpenglow::lut
