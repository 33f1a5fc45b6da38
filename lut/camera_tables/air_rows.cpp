// SPDX-License-Identifier: MIT
// Computes for AirTables the light scattered on the way to a point. A row of texels is one march:
// all rays of a row pass through the same air and differ only in the direction of the sun. The
// light gathered up to each distance is stored.
#include "lut/camera_tables/air_rows.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/medium/phase_text.h"
#include "lut/multiple_scattering/azimuth_fan.h"
#include "lut/multiple_scattering/moment_grid.h"

namespace alpenglow::lut {
namespace {

constexpr double kHair_rad = 1e-9;  // offset from the horizon to the side that a row belongs to

AirRow RowAt(const AirMap& map, bool ground, double v, double range) {
  const double half_tangent = shared::AirHalfTangent<double>(v, std::tan(0.5 * range));
  const double angle = std::max(2.0 * std::atan(half_tangent), kHair_rad) * (ground ? 1.0 : -1.0);
  const double zenith = std::clamp(0.5 * kPi + map.horizon_dip + angle, 0.0, kPi);
  return {ground, zenith, std::cos(zenith), std::sin(zenith)};
}

/// A row of rays [m from the eye]: the distance at which they enter the air, the one at which they
/// may first meet land, and the one at which they may last meet it.
struct Reach {
  AirRow row;
  double begin_m, near_m, end_m;
  std::vector<double> distance_m;  // distances of the nodes, from near_m on
};

Reach ReachOf(const AirMap& map, const AirRow& row, int distances) {
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
  // At distance 0 the path has no length, so the first node lies a little beyond the eye.
  const double first = map.altitude > map.ceiling ? 0.0 : 0.05;
  for (int j = 0; j < distances; ++j) {
    const double w = j == 0 ? first / (distances - 1) : Unit(j, distances);
    const double share =
        AirShareFromNode<double>(w, row.ground ? map.ground_crowding : map.sky_crowding);
    reach.distance_m.push_back(reach.near_m + (reach.end_m - reach.near_m) * share);
  }
  return reach;
}

/// Quadrature nodes along a ray, and for each piece, which extends from one distance to the next,
/// the index after its last node.
struct PieceNodes {
  std::vector<RayNode> node;
  std::vector<std::size_t> end;
};

constexpr int kNodesOfAPiece = 3;
constexpr int kNodesOfFirstPiece = 16;  // a piece through all air above the ceiling

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

// Returns nodes without weight at the ends of the pieces only.
PieceNodes EndsOf(const Reach& reach) {
  PieceNodes nodes;
  for (const double to : reach.distance_m) {
    nodes.node.push_back({to, 0.0});
    nodes.end.push_back(nodes.node.size());
  }
  return nodes;
}

// Returns the nodes of all pieces. A node without weight closes each piece.
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

// Returns nodes in sunlight only, without closing nodes.
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

/// Returns 1 - exp(-tau) without cancellation.
glm::vec4 Absorbed(const glm::vec4& tau) {
  glm::vec4 share;
  for (glm::length_t band = 0; band < 4; ++band) share[band] = -std::expm1(-tau[band]);
  return share;
}

/// One row of rays under a sun in the zenith, so that no part of them is in the planet's shadow.
class RowOfRays {
 public:
  RowOfRays(const SingleScattering<float>& air, const EyeUnderLight& eye, const AirMap& map,
            const Reach& reach, PieceNodes nodes)
      : air_(air), nodes_(std::move(nodes)), samples_(SamplesOf(eye, map, reach)) {}

  [[nodiscard]] const RaySamples<float>& samples() const { return samples_; }
  /// Returns for each piece the index after its last sample, which has no weight.
  [[nodiscard]] const std::vector<std::size_t>& ends() const { return nodes_.end; }

  /// Returns the optical depths to all distances.
  [[nodiscard]] std::vector<glm::vec4> OpticalDepths() const {
    std::vector<glm::vec4> depths;
    for (const std::size_t end : nodes_.end) {
      depths.push_back(DepthOf(air_.constants(), samples_.view_rayleigh[end - 1],
                               samples_.view_mie[end - 1], samples_.view_ozone[end - 1]));
    }
    return depths;
  }

  /// Returns the samples of one piece.
  [[nodiscard]] RaySamples<float> Piece(std::size_t i) const {
    const std::size_t first = i == 0 ? 0 : nodes_.end[i - 1];
    const std::size_t count = nodes_.end[i] - 1 - first;
    RaySamples<float> piece;
    piece.extent = samples_.extent;
    piece.count = count;
    using Samples = RaySamples<float>;
    for (auto row : {&Samples::distance, &Samples::weight, &Samples::altitude, &Samples::mu,
                     &Samples::rayleigh_density, &Samples::mie_density, &Samples::view_rayleigh,
                     &Samples::view_mie, &Samples::view_ozone}) {
      std::copy_n((samples_.*row).begin() + static_cast<std::ptrdiff_t>(first), count,
                  (piece.*row).begin());
    }
    return piece;
  }

 private:
  // kBetweenSamples avoids cancellation, but the samples must be close together.
  [[nodiscard]] RaySamples<float> SamplesOf(const EyeUnderLight& eye, const AirMap& map,
                                            const Reach& reach) const {
    const double mu = reach.row.mu;
    return air_.SampleAt(
        {eye.altitude_m, mu, 1.0, mu}, {reach.begin_m, reach.end_m, RayEnd::kLength}, {},
        nodes_.node,
        map.altitude > map.ceiling ? ViewColumns::kFromSpace : ViewColumns::kBetweenSamples);
  }

  const SingleScattering<float>& air_;
  PieceNodes nodes_;
  RaySamples<float> samples_;
};

/// Columns [km] between samples and the sun.
struct SunColumns {
  std::vector<float> rayleigh, mie, ozone;
};

/// Light up to one distance, for the tables single and diffuse.
struct SunlightTo {
  glm::vec4 single, diffuse;
};

// Divides light scattered once, and what is added to it around the sun, between the tables.
SunlightTo Divided(const glm::vec4& once, const glm::vec4& added) {
  const glm::vec4 single = glm::max(once + added, 0.5F * once);
  return {single, once + added - single};
}

/// Sunlight along the rays of one row, up to each distance: scattered once, and what is added
/// around the sun to the light of the moments.
class SunlightOfRow {
 public:
  SunlightOfRow(const SingleScattering<float>& air, const MultipleScattering& multiple_scattering,
                const AirPhases& phases, const AirTables& tables, const Reach& reach,
                const RowOfRays& rays)
      : air_(air),
        multiple_scattering_(multiple_scattering),
        phases_(phases),
        eye_(tables.eye),
        map_(tables.map),
        reach_(reach),
        rays_(rays) {}

  /// @param nu_seen  cosine between the ray and the direction in which the sun is seen.
  [[nodiscard]] std::vector<SunlightTo> Along(double nu, double nu_seen) const {
    const ViewRay ray{eye_.altitude_m, reach_.row.mu, eye_.mu_s(), nu};
    const RayExtent extent{reach_.begin_m, reach_.end_m, RayEnd::kLength};
    const ShadowSpan shadow = PlanetShadow(ray, extent, air_.medium().planet_radius_m);
    if (shadow.dark_begin_m == shadow.dark_end_m)
      return Gathered(rays_.samples(), rays_.ends(), SunOf(rays_.samples(), nu), nu_seen);
    const PieceNodes nodes = LitNodesOf(reach_, shadow);
    const RaySamples<float> samples =
        air_.SampleAt(ray, extent, {}, nodes.node, ViewColumns::kFromSpace);
    return Gathered(samples, nodes.end, SunOf(samples), nu_seen);
  }

 private:
  [[nodiscard]] static SunColumns SunOf(const RaySamples<float>& samples) {
    const auto row = [&](const RaySamples<float>::Row& from) {
      return std::vector<float>(from.begin(),
                                from.begin() + static_cast<std::ptrdiff_t>(samples.count));
    };
    return {row(samples.sun_rayleigh), row(samples.sun_mie), row(samples.sun_ozone)};
  }

  // Returns the columns for samples that were taken with another sun direction.
  [[nodiscard]] SunColumns SunOf(const RaySamples<float>& samples, double nu) const {
    const auto eye = static_cast<float>((map_.radius + map_.altitude) * eye_.mu_s());
    const auto radius = static_cast<float>(map_.radius);
    const auto begin = static_cast<float>(reach_.begin_m / kMetresPerKilometre);
    std::vector<float> altitude_m(samples.count), mu_s(samples.count);
    for (std::size_t s = 0; s < samples.count; ++s) {
      const float cosine = (eye + (begin + samples.distance[s]) * static_cast<float>(nu)) /
                           (radius + samples.altitude[s]);
      mu_s[s] = std::clamp(cosine, -1.0F, 1.0F);
      altitude_m[s] = 1000.0F * samples.altitude[s];
    }
    auto columns = air_.ColumnsToSpace(altitude_m, mu_s);
    for (std::vector<float>& column : columns)
      for (float& value : column) value *= 1e-3F;
    return {std::move(columns[0]), std::move(columns[1]), std::move(columns[2])};
  }

  [[nodiscard]] std::vector<SunlightTo> Gathered(const RaySamples<float>& samples,
                                                 const std::vector<std::size_t>& ends,
                                                 const SunColumns& sun, double nu_seen) const {
    return multiple_scattering_.peak()
               ? WithPeak(*multiple_scattering_.peak(), samples, ends, sun, nu_seen)
               : WithGlow(samples, ends, sun, nu_seen);
  }

  /// Returns the scattering coefficients of molecules times their phase function.
  [[nodiscard]] glm::vec4 MoleculesAt(double nu) const {
    glm::vec4 molecules = Vec4Of(air_.constants().rayleigh, air_.bands());
    const std::vector<double> phase = RayleighPhaseValues(air_.medium(), nu);
    for (std::size_t band = 0; band < phase.size(); ++band)
      molecules[static_cast<glm::length_t>(band)] *= static_cast<float>(phase[band]);
    return molecules;
  }

  // The glow is that of the mean column over sunlit aerosol, as in MultipleScattering.
  [[nodiscard]] std::vector<SunlightTo> WithGlow(const RaySamples<float>& samples,
                                                 const std::vector<std::size_t>& ends,
                                                 const SunColumns& sun, double nu_seen) const {
    const AirConstants<float>& air = air_.constants();
    const glm::vec4 molecules = MoleculesAt(nu_seen), phase = phases_.OfAerosol(nu_seen);
    const glm::vec4 scattering = Vec4Of(air.mie_scattering, air.bands);
    const bool glows = GlowAboutTheSun::Reaches(nu_seen);
    std::vector<SunlightTo> light;
    glm::vec4 of_molecules(0.0F), of_aerosol(0.0F);
    float lit_km = 0.0F, column = 0.0F;
    std::size_t s = 0;
    for (const std::size_t end : ends) {
      for (; s < end; ++s) {
        if (samples.weight[s] == 0.0F) continue;
        const glm::vec4 seen = samples.weight[s] * glm::exp(-DepthAt(samples, sun, s));
        of_molecules += seen * samples.rayleigh_density[s];
        of_aerosol += seen * samples.mie_density[s];
        lit_km += samples.weight[s] * samples.mie_density[s];
        column += samples.weight[s] * samples.mie_density[s] * (samples.view_mie[s] + sun.mie[s]);
      }
      const glm::vec4 aerosol = scattering * of_aerosol;
      const glm::vec4 once = molecules * of_molecules + phase * aerosol;
      glm::vec4 glow(0.0F);
      if (glows && lit_km > 0.0F)
        glow = aerosol * Vec4Of(multiple_scattering_.GlowFactor(nu_seen, column / lit_km));
      light.push_back(Divided(once, glow));
    }
    return light;
  }

  [[nodiscard]] std::vector<SunlightTo> WithPeak(const DeltaM& peak,
                                                 const RaySamples<float>& samples,
                                                 const std::vector<std::size_t>& ends,
                                                 const SunColumns& sun, double nu_seen) const {
    const AirConstants<float>& air = air_.constants();
    const glm::vec4 molecules = MoleculesAt(nu_seen), phase = phases_.OfAerosol(nu_seen);
    const std::vector<PeakAtAngle> peaks = peak.At(nu_seen);
    std::vector<SunlightTo> light;
    glm::vec4 once(0.0F), added(0.0F);
    std::size_t s = 0;
    for (const std::size_t end : ends) {
      for (; s < end; ++s) {
        if (samples.weight[s] == 0.0F) continue;
        const glm::vec4 depth = DepthAt(samples, sun, s);
        for (std::size_t band = 0; band < air.bands; ++band) {
          const auto i = static_cast<glm::length_t>(band);
          const float mie = air.mie_scattering[band];
          const float of_gas = molecules[i] * samples.rayleigh_density[s];
          const float of_aerosol = mie * samples.mie_density[s];
          once[i] += samples.weight[s] * std::exp(-depth[i]) * (of_gas + of_aerosol * phase[i]);
          const float y = mie * (samples.view_mie[s] + sun.mie[s]);
          added[i] += samples.weight[s] * peaks[band].LightOf(y, depth[i], of_gas, of_aerosol);
          if (peaks[band].twice_back() == 0.0F) continue;
          const SunlitPoint point{samples.rayleigh_density[s], samples.mie_density[s],
                                  sun.rayleigh[s], sun.mie[s]};
          added[i] +=
              samples.weight[s] * of_aerosol *
              peaks[band].TwiceBackOf(UpFromBelow(air, band, peak.share(band), point), y, depth[i]);
        }
      }
      light.push_back(Divided(once, added));
    }
    return light;
  }

  /// Returns the optical depth from the sun to a sample and on to the eye.
  [[nodiscard]] glm::vec4 DepthAt(const RaySamples<float>& samples, const SunColumns& sun,
                                  std::size_t s) const {
    return DepthOf(air_.constants(), samples.view_rayleigh[s] + sun.rayleigh[s],
                   samples.view_mie[s] + sun.mie[s], samples.view_ozone[s] + sun.ozone[s]);
  }

  const SingleScattering<float>& air_;
  const MultipleScattering& multiple_scattering_;
  const AirPhases& phases_;
  const EyeUnderLight& eye_;
  const AirMap& map_;
  const Reach& reach_;
  const RowOfRays& rays_;
};

class WayBuilder {
 public:
  WayBuilder(const SingleScattering<float>& air, const MultipleScattering& multiple_scattering,
             const AirPhases& once, AirTables& tables)
      : air_(air),
        multiple_scattering_(multiple_scattering),
        fan_(multiple_scattering),
        once_(once),
        phases_(tables.phase),
        tables_(tables),
        azimuths_(AzimuthsOf(tables.size.columns)) {}

  void Fill() {
    const AirTablesSize& size = tables_.size;
    int y = 0;
    for (const AirRow& row :
         RowsOf(tables_.map, size.rows, tables_.map.air_sky_range, size.ground_rows)) {
      FillRow(y++, ReachOf(tables_.map, row, size.distances));
    }
    y = 0;
    for (const AirRow& row : RowsOf(tables_.map, size.extinction_rows, tables_.map.air_sky_range,
                                    size.extinction_ground_rows)) {
      FillExtinction(y++, ReachOf(tables_.map, row, size.extinction_distances));
    }
  }

 private:
  void FillRow(int y, const Reach& reach) {
    const RowOfRays rays(air_, tables_.eye, tables_.map, reach, NodesOf(reach));
    std::vector<glm::vec4> absorbed = rays.OpticalDepths();
    for (glm::vec4& share : absorbed) share = Absorbed(share);
    const double mu_s_seen = std::cos(tables_.eye.zenith_angle_seen_rad());
    std::vector<double> nus;
    for (const double azimuth : azimuths_)
      nus.push_back(SunCosineOf(reach.row, tables_.eye.mu_s(), azimuth));
    const SunlightOfRow sunlight(air_, multiple_scattering_, once_, tables_, reach, rays);
    for (std::size_t x = 0; x < nus.size(); ++x) {
      const double nu_seen = SunCosineOf(reach.row, mu_s_seen, azimuths_[x]);
      const glm::vec4 mix = AirPhases::OfMolecules(nu_seen) * tables_.single_mix[0] +
                            phases_.OfAerosol(nu_seen) * tables_.single_mix[1];
      const std::vector<SunlightTo> light = sunlight.Along(nus[x], nu_seen);
      for (std::size_t j = 0; j < light.size(); ++j) {
        if (tables_.has_set) {
          Texel(tables_.multiple_scattering, x, y, j) = light[j].single + light[j].diffuse;
          continue;
        }
        Texel(tables_.single, x, y, j) = Quotient(light[j].single, absorbed[j] * mix);
        Texel(tables_.multiple_scattering, x, y, j) = light[j].diffuse;
      }
    }
    AddMoments(y, reach, rays, absorbed, {nus.begin(), nus.end()});
    DivideByTwilight(y, reach, nus);
  }

  // Adds the light of the moments to the light in the table.
  void AddMoments(int y, const Reach& reach, const RowOfRays& rays,
                  const std::vector<glm::vec4>& absorbed, const std::vector<float>& nus) {
    const ViewRay ray{tables_.eye.altitude_m, reach.row.mu, tables_.eye.mu_s(), 0.0};
    const std::size_t bands = air_.bands();
    std::vector<glm::vec4> sum(nus.size(), glm::vec4(0.0F));
    for (std::size_t j = 0; j < absorbed.size(); ++j) {
      const std::vector<float> piece = fan_.InscatterAlong(rays.Piece(j), ray, nus);
      for (std::size_t x = 0; x < nus.size(); ++x) {
        for (std::size_t band = 0; band < bands; ++band)
          sum[x][static_cast<glm::length_t>(band)] += piece[x * bands + band];
        glm::vec4& texel = Texel(tables_.multiple_scattering, x, y, j);
        texel = Quotient(texel + sum[x], absorbed[j]);
      }
    }
  }

  void DivideByTwilight(int y, const Reach& reach, const std::vector<double>& nus) {
    for (std::size_t j = 0; j < reach.distance_m.size(); ++j) {
      const double source_km = 0.5 * (reach.near_m + reach.distance_m[j]) / kMetresPerKilometre;
      for (std::size_t x = 0; x < nus.size(); ++x) {
        const float twilight = TwilightAt(tables_.map, tables_.eye.mu_s(), nus[x], source_km);
        Texel(tables_.single, x, y, j) /= twilight;
        Texel(tables_.multiple_scattering, x, y, j) /= twilight;
      }
    }
  }

  void FillExtinction(int y, const Reach& reach) {
    const RowOfRays rays(air_, tables_.eye, tables_.map, reach, EndsOf(reach));
    const std::vector<glm::vec4> depths = rays.OpticalDepths();
    for (std::size_t j = 0; j < depths.size(); ++j) {
      const double length_km = (reach.distance_m[j] - reach.begin_m) / kMetresPerKilometre;
      Texel(tables_.extinction, j, y, 0) = depths[j] / static_cast<float>(length_km);
    }
  }

  [[nodiscard]] static glm::vec4& Texel(AirTexels& texels, std::size_t x, int y, std::size_t z) {
    return texels.At(static_cast<int>(x), y, static_cast<int>(z));
  }

  const SingleScattering<float>& air_;
  const MultipleScattering& multiple_scattering_;
  AzimuthFan fan_;
  AirPhases once_, phases_;
  AirTables& tables_;
  std::vector<double> azimuths_;
};

}  // namespace

glm::vec4 Vec4Of(const Spectrum& light) { return Vec4Of(light.values(), light.size()); }

glm::vec4 Vec4Of(std::span<const float> per_band, std::size_t bands) {
  glm::vec4 texel(0.0F);
  for (std::size_t band = 0; band < bands; ++band)
    texel[static_cast<glm::length_t>(band)] = per_band[band];
  return texel;
}

std::vector<AirRow> RowsOf(const AirMap& map, int sky, double sky_range, int ground) {
  std::vector<AirRow> rows;
  for (int i = 0; i < sky; ++i) rows.push_back(RowAt(map, false, Unit(i, sky), sky_range));
  for (int i = 0; i < ground; ++i)
    rows.push_back(RowAt(map, true, Unit(i, ground), map.ground_range));
  return rows;
}

std::vector<double> AzimuthsOf(int columns) {
  std::vector<double> azimuths;
  for (int i = 0; i < columns; ++i)
    azimuths.push_back(4.0 * std::atan(shared::AirQuarterTangent<double>(Unit(i, columns))));
  return azimuths;
}

double SunCosineOf(const AirRow& row, double mu_s, double azimuth) {
  return std::clamp(row.mu * mu_s + row.sine * SineOf(mu_s) * std::cos(azimuth), -1.0, 1.0);
}

float AirPhases::OfMolecules(double nu) {
  return static_cast<float>(shared::PhaseRayleigh<double>(nu));
}

glm::vec4 AirPhases::OfAerosol(double nu) const {
  const double place = shared::PhaseNode<double>(0.5 - 0.5 * nu) * (nodes_.width - 1);
  const int cell = std::min(static_cast<int>(place), nodes_.width - 2);
  const auto t = static_cast<float>(place - cell);
  return nodes_.At(cell, 0) + t * (nodes_.At(cell + 1, 0) - nodes_.At(cell, 0));
}

float TwilightAt(const AirMap& map, double mu_s, double nu, double distance_km) {
  return static_cast<float>(shared::AirTwilight<double>(
      map.altitude, mu_s, nu, distance_km, map.twilight_fall, map.twilight_reference, map.radius));
}

void FillWays(const SingleScattering<float>& air, const MultipleScattering& multiple_scattering,
              const AirPhases& once, AirTables& tables) {
  WayBuilder(air, multiple_scattering, once, tables).Fill();
}

}  // namespace alpenglow::lut
