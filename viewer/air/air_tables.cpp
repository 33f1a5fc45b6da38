// SPDX-License-Identifier: MIT
#include "viewer/air/air_tables.h"

#include <algorithm>
#include <cmath>
#include <glm/exponential.hpp>
#include <span>

#include "atmosphere/air/phase.h"
#include "atmosphere/number/constants.h"
#include "atmosphere/number/quadrature.h"
#include "atmosphere/text/error.h"
#include "lut/diffuse/diffuse_fan.h"
#include "lut/sky/sky_view.h"
#include "lut/table/transmittance_map.h"

namespace alpenglow {
namespace {

constexpr std::size_t kBands = 4;
constexpr double kMetresPerKilometre = 1000.0;
constexpr double kHair_rad = 1e-9;  // off the horizon, to the side of it that a row belongs to
constexpr int kPhaseNodes = 1024;
constexpr int kSunCosines = 256, kSunAltitudes = 64;

double Unit(int i, int n) { return static_cast<double>(i) / (n - 1); }

glm::vec4 Vec4Of(const Bands<float>& bands) {
  glm::vec4 texel(0.0F);
  for (std::size_t band = 0; band < bands.count; ++band)
    texel[static_cast<glm::length_t>(band)] = bands[band];
  return texel;
}

glm::vec4 Vec4Of(const std::array<float, kMaxBands>& per_band, std::size_t bands) {
  glm::vec4 texel(0.0F);
  for (std::size_t band = 0; band < bands; ++band)
    texel[static_cast<glm::length_t>(band)] = per_band[band];
  return texel;
}

glm::vec4 Vec4Of(const std::vector<double>& per_band) {
  glm::vec4 texel(0.0F);
  for (std::size_t band = 0; band < per_band.size(); ++band)
    texel[static_cast<glm::length_t>(band)] = static_cast<float>(per_band[band]);
  return texel;
}

/// a / b, and 0 where b is not positive.
glm::vec4 Quotient(const glm::vec4& a, const glm::vec4& b) {
  glm::vec4 quotient(0.0F);
  for (glm::length_t band = 0; band < 4; ++band)
    if (b[band] > 0.0F) quotient[band] = std::max(a[band], 0.0F) / b[band];
  return quotient;
}

/// 1 - exp(-tau) that does not cancel.
glm::vec4 Absorbed(const glm::vec4& tau) {
  glm::vec4 share;
  for (glm::length_t band = 0; band < 4; ++band) share[band] = -std::expm1(-tau[band]);
  return share;
}

float PhaseOfMolecules(double nu) {
  return static_cast<float>(0.0596831036594607509 * (1.0 + nu * nu));
}

glm::vec4 PhaseOfAerosol(const Medium& medium, double nu) {
  return Vec4Of(MiePhaseValues(medium, std::clamp(nu, -1.0, 1.0)));
}

/// A row of directions of one zenith angle.
struct Row {
  bool ground;
  double zenith_angle, mu, sine;
};

/// The row of a coordinate in [0, 1] from the horizon.
Row RowAt(const AirMap& map, bool ground, double v, double range) {
  const double angle =
      std::max(shared::AirAngleFromRow<double>(v, range), kHair_rad) * (ground ? 1.0 : -1.0);
  const double zenith = std::clamp(0.5 * kPi + map.horizon_dip + angle, 0.0, kPi);
  return {ground, zenith, std::cos(zenith), std::sin(zenith)};
}

/// Rows above the horizon, then rows below it.
std::vector<Row> RowsOf(const AirMap& map, int sky, double sky_range, int ground) {
  std::vector<Row> rows;
  for (int i = 0; i < sky; ++i) rows.push_back(RowAt(map, false, Unit(i, sky), sky_range));
  for (int i = 0; i < ground; ++i)
    rows.push_back(RowAt(map, true, Unit(i, ground), map.ground_range));
  return rows;
}

std::vector<double> AzimuthsOf(int columns) {
  std::vector<double> azimuths;
  for (int i = 0; i < columns; ++i)
    azimuths.push_back(shared::AirAzimuthFromColumn<double>(Unit(i, columns)));
  return azimuths;
}

double Sine(double cosine) { return std::sqrt(std::max((1.0 - cosine) * (1.0 + cosine), 0.0)); }

double SunCosineOf(const Row& row, double mu_s, double azimuth) {
  return std::clamp(row.mu * mu_s + row.sine * Sine(mu_s) * std::cos(azimuth), -1.0, 1.0);
}

// --- the sky ---

// What molecules, aerosol and all else give in the direction of the sun, or in the one of its
// azimuth that is nearest to it and sees air. Where that is dark, each as much as the others.
std::array<glm::vec4, 3> SkyMix(const AirIntegrator<float>& air, const SkyView& view,
                                const AirMap& map, const AirEye& eye) {
  const double sun = std::acos(std::clamp(eye.mu_s, -1.0, 1.0));
  const double horizon = view.map().horizon_zenith_angle_rad();
  const double margin = std::min(0.02, 0.05 * map.sky_range);
  const double zenith = std::clamp(
      sun, horizon - map.sky_range + (map.altitude > map.top ? margin : 0.0), horizon - margin);
  const double nu = std::cos(zenith - sun);
  const ViewRay ray{eye.altitude_m, std::cos(zenith), eye.mu_s, nu};
  const ScatteredOnce<float> once = air.Scatter(air.Sample(ray, {}));
  const glm::vec4 aerosol = PhaseOfAerosol(air.medium(), nu);
  std::array<glm::vec4, 3> mix{Vec4Of(once.rayleigh), Vec4Of(once.mie),
                               Vec4Of(view.Radiance(zenith, 0.0))};
  for (glm::length_t band = 0; band < 4; ++band) {
    const float all = mix[2][band];
    const float rest = all - PhaseOfMolecules(nu) * mix[0][band] - aerosol[band] * mix[1][band];
    mix[2][band] = std::max(rest, 0.05F * all);
    if (all > 0.0F) continue;
    for (glm::vec4& share : mix) share[band] = 1.0F;
  }
  return mix;
}

float TwilightAt(const AirMap& map, const AirEye& eye, double nu, double distance_km) {
  return static_cast<float>(shared::AirTwilight<double>(map.altitude, eye.mu_s, nu, distance_km,
                                                        map.twilight_fall, map.twilight_reference,
                                                        map.radius));
}

float TwilightAtFoot(const AirMap& map, const AirEye& eye, const Row& row, double nu) {
  return TwilightAt(
      map, eye, nu,
      shared::AirFoot<double>(map.altitude, row.mu, row.ground ? 1.0 : 0.0, map.radius));
}

AirTexels SkyTexels(const SkyView& view, const AirMap& map, const Medium& medium, const AirEye& eye,
                    const std::array<glm::vec4, 3>& mix, const AirTablesSize& size) {
  const std::vector<double> azimuths = AzimuthsOf(size.sky_columns);
  const SkyAzimuths prepared(view, azimuths);
  std::vector<float> radiance(azimuths.size() * view.stride());
  AirTexels texels(size.sky_columns, size.sky_rows + size.sky_ground_rows);
  int y = 0;
  for (const Row& row : RowsOf(map, size.sky_rows, map.sky_range, size.sky_ground_rows)) {
    view.FillRow(row.zenith_angle, prepared, radiance);
    for (int x = 0; x < size.sky_columns; ++x) {
      const float* light = &radiance[static_cast<std::size_t>(x) * view.stride()];
      const double nu = SunCosineOf(row, eye.mu_s, azimuths[static_cast<std::size_t>(x)]);
      texels.At(x, y) = Quotient(
          glm::vec4{light[0], light[1], light[2], light[3]} / TwilightAtFoot(map, eye, row, nu),
          PhaseOfMolecules(nu) * mix[0] + PhaseOfAerosol(medium, nu) * mix[1] + mix[2]);
    }
    ++y;
  }
  return texels;
}

AirTexels ThroughTexels(const AirIntegrator<float>& air, const AirMap& map, const AirEye& eye,
                        const AirTablesSize& size) {
  AirTexels texels(size.through_rows + size.through_ground_rows, 1);
  int x = 0;
  for (const Row& row : RowsOf(map, size.through_rows, map.sky_range, size.through_ground_rows))
    texels.At(x++, 0) = Vec4Of(air.TransmittanceAlong({eye.altitude_m, row.mu, 1.0, row.mu}));
  return texels;
}

// --- the way to a point ---

/// A row of rays: where they enter the air, where they may first meet land and where they may last
/// do so [m from the eye].
struct Reach {
  Row row;
  double begin_m, near_m, end_m;
  std::vector<double> distance_m;  // of the nodes, from near_m on
};

Reach ReachOf(const AirMap& map, const Row& row, int distances) {
  using namespace shared;
  const double near = AirEntry<double>(map.altitude, row.mu, map.ceiling, map.radius);
  const double end = row.ground ? AirEndDown<double>(map.altitude, row.mu, map.radius)
                                : AirEndUp<double>(map.altitude, row.mu, map.ceiling, map.radius);
  const double begin = AirEntry<double>(map.altitude, row.mu, map.top, map.radius);
  Reach reach{row,
              kMetresPerKilometre * begin,
              kMetresPerKilometre * near,
              kMetresPerKilometre * std::max(end, near + 1e-3),
              {}};
  // The eye's own place has no way to it: a little beyond.
  const double first = map.altitude > map.ceiling ? 0.0 : 0.05;
  for (int j = 0; j < distances; ++j) {
    const double w = j == 0 ? first / (distances - 1) : Unit(j, distances);
    const double share =
        AirShareFromNode<double>(w, row.ground ? map.ground_crowding : map.sky_crowding);
    reach.distance_m.push_back(reach.near_m + (reach.end_m - reach.near_m) * share);
  }
  return reach;
}

/// Nodes of a rule along a ray, and where each of its pieces, from one distance to the next, ends
/// among them.
struct PieceNodes {
  std::vector<RayNode> node;
  std::vector<std::size_t> end;
};

constexpr int kNodesOfAPiece = 3;
constexpr int kNodesOfFirstPiece = 16;  // through all air above the ceiling

int NodesOfPiece(const Reach& reach, double to_m) {
  return to_m <= reach.near_m ? kNodesOfFirstPiece : kNodesOfAPiece;
}

void AddRule(double begin_m, double end_m, int count, std::vector<RayNode>& nodes) {
  if (end_m <= begin_m) return;
  const GaussRule& rule = GaussLegendre(count);
  for (std::size_t k = 0; k < rule.node.size(); ++k) {
    nodes.push_back(
        {begin_m + rule.node[k] * (end_m - begin_m), rule.weight[k] * (end_m - begin_m)});
  }
}

// Closed by a node of no weight at the end of each piece.
PieceNodes NodesOf(const Reach& reach) {
  PieceNodes nodes;
  double from = reach.begin_m;
  for (const double to : reach.distance_m) {
    AddRule(from, to, NodesOfPiece(reach, to), nodes.node);
    nodes.node.push_back({to, 0.0});
    nodes.end.push_back(nodes.node.size());
    from = to;
  }
  return nodes;
}

// Only in the sun, without those.
PieceNodes LitNodesOf(const Reach& reach, const ShadowSpan& shadow) {
  PieceNodes nodes;
  double from = reach.begin_m;
  for (const double to : reach.distance_m) {
    const int count = NodesOfPiece(reach, to);
    AddRule(from, std::min(to, shadow.dark_begin_m), count, nodes.node);
    AddRule(std::max(from, shadow.dark_end_m), to, count, nodes.node);
    nodes.end.push_back(nodes.node.size());
    from = to;
  }
  return nodes;
}

glm::vec4 DepthOf(const AirConstants<float>& air, float rayleigh, float mie, float ozone) {
  glm::vec4 depth(0.0F);
  for (std::size_t band = 0; band < air.bands; ++band) {
    depth[static_cast<glm::length_t>(band)] =
        air.rayleigh[band] * rayleigh + air.mie_extinction[band] * mie + air.ozone[band] * ozone;
  }
  return depth;
}

/// One row of rays under a sun in the zenith, which leaves nothing of them dark.
class RowOfRays {
 public:
  RowOfRays(const AirIntegrator<float>& air, const AirEye& eye, const Reach& reach)
      : air_(air), nodes_(NodesOf(reach)), samples_(SamplesOf(eye, reach)) {}

  /// To every distance.
  [[nodiscard]] std::vector<glm::vec4> OpticalDepths() const {
    std::vector<glm::vec4> depths;
    for (const std::size_t end : nodes_.end) {
      depths.push_back(DepthOf(air_.constants(), samples_.view_rayleigh[end - 1],
                               samples_.view_mie[end - 1], samples_.view_ozone[end - 1]));
    }
    return depths;
  }

  /// The samples of one piece.
  [[nodiscard]] RaySamples<float> Piece(std::size_t i) const {
    const std::size_t first = i == 0 ? 0 : nodes_.end[i - 1];
    const std::size_t count = nodes_.end[i] - 1 - first;
    RaySamples<float> piece;
    piece.extent = samples_.extent;
    piece.count = count;
    const auto copy = [&](auto row) {
      std::copy_n((samples_.*row).begin() + static_cast<std::ptrdiff_t>(first), count,
                  (piece.*row).begin());
    };
    using Samples = RaySamples<float>;
    for (auto row :
         {&Samples::distance, &Samples::weight, &Samples::lit, &Samples::altitude, &Samples::mu,
          &Samples::mu_s, &Samples::rayleigh_density, &Samples::mie_density,
          &Samples::view_rayleigh, &Samples::view_mie, &Samples::view_ozone}) {
      copy(row);
    }
    return piece;
  }

 private:
  [[nodiscard]] RaySamples<float> SamplesOf(const AirEye& eye, const Reach& reach) const {
    const double mu = reach.row.mu;
    return air_.SampleAt(
        {eye.altitude_m, mu, 1.0, mu}, {reach.begin_m, reach.end_m, RayEnd::kLength}, {},
        nodes_.node, reach.begin_m > 0.0 ? ViewColumns::kFromSpace : ViewColumns::kBetweenSamples);
  }

  const AirIntegrator<float>& air_;
  PieceNodes nodes_;
  RaySamples<float> samples_;
};

/// Light scattered once, up to each distance, with the phase functions.
std::vector<glm::vec4> SingleAlong(const AirIntegrator<float>& air, const AirEye& eye,
                                   const Reach& reach, double nu) {
  const ViewRay ray{eye.altitude_m, reach.row.mu, eye.mu_s, nu};
  const RayExtent extent{reach.begin_m, reach.end_m, RayEnd::kLength};
  const ShadowSpan shadow = PlanetShadow(ray, extent, air.medium().planet_radius_m);
  const PieceNodes nodes = LitNodesOf(reach, shadow);
  const RaySamples<float> samples =
      air.SampleAt(ray, extent, {}, nodes.node, ViewColumns::kFromSpace);
  const AirConstants<float>& constants = air.constants();
  const glm::vec4 molecules = PhaseOfMolecules(nu) * Vec4Of(constants.rayleigh, constants.bands);
  const glm::vec4 aerosol =
      PhaseOfAerosol(air.medium(), nu) * Vec4Of(constants.mie_scattering, constants.bands);
  std::vector<glm::vec4> light;
  glm::vec4 sum(0.0F);
  std::size_t s = 0;
  for (const std::size_t end : nodes.end) {
    for (; s < end; ++s) {
      const glm::vec4 depth = DepthOf(constants, samples.view_rayleigh[s] + samples.sun_rayleigh[s],
                                      samples.view_mie[s] + samples.sun_mie[s],
                                      samples.view_ozone[s] + samples.sun_ozone[s]);
      sum += samples.weight[s] * glm::exp(-depth) *
             (samples.rayleigh_density[s] * molecules + samples.mie_density[s] * aerosol);
    }
    light.push_back(sum);
  }
  return light;
}

/// Shares of the two phase functions in what the air about the eye, or a little over the ground,
/// scatters.
std::array<glm::vec4, 2> SingleMix(const AirIntegrator<float>& air, const AirMap& map) {
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

/// The parts of the tables that belong to ways to a point.
class WayBuilder {
 public:
  WayBuilder(const AirIntegrator<float>& air, const DiffuseLight& diffuse, AirTables& tables)
      : air_(air), fan_(diffuse), tables_(tables), azimuths_(AzimuthsOf(tables.size.columns)) {}

  void Fill() {
    const AirTablesSize& size = tables_.size;
    int y = 0;
    for (const Row& row :
         RowsOf(tables_.map, size.rows, tables_.map.air_sky_range, size.ground_rows)) {
      FillRow(y++, ReachOf(tables_.map, row, size.distances));
    }
    y = 0;
    for (const Row& row : RowsOf(tables_.map, size.extinction_rows, tables_.map.air_sky_range,
                                 size.extinction_ground_rows)) {
      FillExtinction(y++, ReachOf(tables_.map, row, size.extinction_distances));
    }
  }

 private:
  void FillRow(int y, const Reach& reach) {
    const RowOfRays rays(air_, tables_.eye, reach);
    std::vector<glm::vec4> absorbed = rays.OpticalDepths();
    for (glm::vec4& share : absorbed) share = Absorbed(share);
    FillSingle(y, reach, absorbed);
    FillDiffuse(y, reach, rays, absorbed);
  }

  void FillSingle(int y, const Reach& reach, const std::vector<glm::vec4>& absorbed) {
    for (int x = 0; x < tables_.single.width; ++x) {
      const double nu =
          SunCosineOf(reach.row, tables_.eye.mu_s, azimuths_[static_cast<std::size_t>(x)]);
      const glm::vec4 mix = PhaseOfMolecules(nu) * tables_.single_mix[0] +
                            PhaseOfAerosol(air_.medium(), nu) * tables_.single_mix[1];
      const std::vector<glm::vec4> light = SingleAlong(air_, tables_.eye, reach, nu);
      for (std::size_t j = 0; j < light.size(); ++j)
        tables_.single.At(x, y, static_cast<int>(j)) =
            Quotient(light[j] / TwilightOnWay(reach, nu, j), absorbed[j] * mix);
    }
  }

  void FillDiffuse(int y, const Reach& reach, const RowOfRays& rays,
                   const std::vector<glm::vec4>& absorbed) {
    std::vector<float> nus;
    for (const double azimuth : azimuths_)
      nus.push_back(static_cast<float>(SunCosineOf(reach.row, tables_.eye.mu_s, azimuth)));
    const ViewRay ray{tables_.eye.altitude_m, reach.row.mu, tables_.eye.mu_s, 0.0};
    const std::size_t bands = air_.bands();
    std::vector<glm::vec4> sum(nus.size(), glm::vec4(0.0F));
    for (std::size_t j = 0; j < absorbed.size(); ++j) {
      const std::vector<float> piece = fan_.InscatterAlong(rays.Piece(j), ray, nus);
      for (std::size_t x = 0; x < nus.size(); ++x) {
        for (std::size_t band = 0; band < bands; ++band)
          sum[x][static_cast<glm::length_t>(band)] += piece[x * bands + band];
        tables_.diffuse.At(static_cast<int>(x), y, static_cast<int>(j)) =
            Quotient(sum[x] / TwilightOnWay(reach, static_cast<double>(nus[x]), j), absorbed[j]);
      }
    }
  }

  [[nodiscard]] float TwilightOnWay(const Reach& reach, double nu, std::size_t j) const {
    const double source_m = 0.5 * (reach.near_m + reach.distance_m[j]);
    return TwilightAt(tables_.map, tables_.eye, nu, source_m / kMetresPerKilometre);
  }

  void FillExtinction(int y, const Reach& reach) {
    const std::vector<glm::vec4> depths = RowOfRays(air_, tables_.eye, reach).OpticalDepths();
    for (std::size_t j = 0; j < depths.size(); ++j) {
      const double length_km = (reach.distance_m[j] - reach.begin_m) / kMetresPerKilometre;
      tables_.extinction.At(static_cast<int>(j), y) = depths[j] / static_cast<float>(length_km);
    }
  }

  const AirIntegrator<float>& air_;
  DiffuseFan fan_;
  AirTables& tables_;
  std::vector<double> azimuths_;
};

}  // namespace

void RequireFourBands(const Medium& medium) {
  RequireInRange(static_cast<double>(medium.wavelengths_nm.size()), 1.0,
                 static_cast<double>(kBands), "number of spectrum.wavelengths_nm");
}

AirTablesSize AirTablesSizeOf(AirQuality quality, double altitude_m) {
  constexpr double kHighUp_m = 25000.0;
  const bool high_up = altitude_m > kHighUp_m;
  const auto with = [&](int sky, int columns, int rows, int distances) {
    return AirTablesSize{.sky_columns = sky,
                         .sky_rows = sky,
                         .sky_ground_rows = sky * 2 / 3,
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
      return with(64, 12, 12, 8);
    case AirQuality::kLow:
      return with(128, 24, 32, 12);
    case AirQuality::kMedium:
      return with(192, 32, 48, 16);
    case AirQuality::kHigh:
      break;
  }
  return with(192, 32, 64, 24);
}

AirTables MakeAirTables(const AirIntegrator<float>& air, const DiffuseLight& diffuse,
                        const AirEye& eye, const AirTablesSize& size) {
  RequireFourBands(air.medium());
  const SkyView view(air, diffuse, eye.altitude_m, eye.mu_s);
  const AirMap map(air.medium(), eye.altitude_m, eye.ceiling_m,
                   static_cast<double>(diffuse.grid().twilight_fall));
  const std::array<glm::vec4, 3> mix = SkyMix(air, view, map, eye);
  const int rows = size.rows + size.ground_rows;
  AirTables tables{
      size,
      eye,
      map,
      mix,
      SingleMix(air, map),
      SkyTexels(view, map, air.medium(), eye, mix, size),
      ThroughTexels(air, map, eye, size),
      AirTexels(size.extinction_distances, size.extinction_rows + size.extinction_ground_rows),
      AirTexels(size.columns, rows, size.distances),
      AirTexels(size.columns, rows, size.distances)};
  WayBuilder(air, diffuse, tables).Fill();
  return tables;
}

MediumTables MakeMediumTables(const AirIntegrator<float>& air) {
  using namespace shared;
  RequireFourBands(air.medium());
  MediumTables tables{AirTexels(kPhaseNodes, 1), AirTexels(kSunCosines, kSunAltitudes)};
  for (int k = 0; k < kPhaseNodes; ++k) {
    const double share = Unit(k, kPhaseNodes);
    tables.phase.At(k, 0) = PhaseOfAerosol(air.medium(), std::cos(kPi * share * share));
  }
  const double radius = air.medium().planet_radius_m / kMetresPerKilometre;
  const double top = air.medium().atmosphere_height_m / kMetresPerKilometre;
  for (int y = 0; y < kSunAltitudes; ++y) {
    const double h = AltitudeFromUnit<double>(Unit(y, kSunAltitudes), top, radius);
    for (int x = 0; x < kSunCosines; ++x) {
      const double mu = std::max(SkyCosineFromUnit<double>(Unit(x, kSunCosines), h, top, radius),
                                 HorizonCosine<double>(h, radius) + kHair_rad);
      tables.to_sun.At(x, y) = Vec4Of(air.TransmittanceToSpace(kMetresPerKilometre * h, mu));
    }
  }
  return tables;
}

}  // namespace alpenglow
