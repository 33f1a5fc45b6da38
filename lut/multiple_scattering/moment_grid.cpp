// SPDX-License-Identifier: MIT
#include "lut/multiple_scattering/moment_grid.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "atmosphere/math/constants.h"
#include "atmosphere/math/numerics.h"
#include "atmosphere/medium/phase.h"
#include "atmosphere/medium/phase_text.h"
#include "atmosphere/ray/ray.h"
#include "atmosphere/ray/shell.h"
#include "lut/multiple_scattering/spherical_harmonics.h"

namespace alpenglow::lut {

MomentGrid GridOf(const Medium& medium, const MultipleScatteringOptions& options) {
  const SunAxis& sun = MultipleScattering::SunNodes();
  MomentGrid grid{};
  grid.altitudes = static_cast<std::size_t>(options.altitudes);
  grid.suns = static_cast<std::size_t>(options.sun_angles);
  grid.degree = static_cast<std::size_t>(options.degree);
  grid.polarised = medium.polarised;
  grid.top_km = static_cast<float>(medium.atmosphere_height_m / 1000.0);
  grid.sun_centre = static_cast<float>(sun.centre());
  grid.sun_width = static_cast<float>(sun.width());
  grid.first_asinh = static_cast<float>(sun.low());
  grid.cells_a_unit = static_cast<float>((options.sun_angles - 1) / (sun.high() - sun.low()));
  // In earth's air moments fall by a factor e per 1.25 degrees. On other planets the rate is
  // proportional to radius over scale height. The fall over the sun axis is limited to a factor
  // 1e-6.
  const double fall = 46.0 / 796.0 * medium.planet_radius_m / medium.rayleigh_scale_height_m;
  grid.twilight_start = -0.03F;
  grid.twilight_width = 0.05F;
  grid.twilight_fall = static_cast<float>(std::min(fall, 50.0));
  return grid;
}

DeltaScaledMedium ScatteringMedium(const Medium& medium, const MultipleScatteringOptions& options) {
  if (options.delta_m) return WithoutPeak(medium, options.degree);
  return {medium, {}, MieLegendreCoefficients(medium, options.degree)};
}

float TwilightOf(const MomentGrid& grid, double mu_s) {
  const double x = static_cast<double>(grid.twilight_start) - mu_s;
  const double width = static_cast<double>(grid.twilight_width);
  return static_cast<float>(std::exp(-0.5 * static_cast<double>(grid.twilight_fall) *
                                     (x + std::sqrt(x * x + width * width))));
}

float RayleighChi2(const Medium& medium, std::size_t band) {
  return 0.1F * static_cast<float>(shared::RoundShare(Depolarisation(medium, band)));
}

BlockShape ShapeOfBlock(const Medium& medium, const std::vector<double>& chi, std::size_t degree,
                        std::size_t first_band) {
  const std::size_t bands = medium.wavelengths_nm.size();
  BlockShape shape{};
  for (std::size_t lane = 0; lane < kBlockBands && first_band + lane < bands; ++lane) {
    const std::size_t band = first_band + lane;
    shape.rayleigh_chi2[lane] = RayleighChi2(medium, band);
    for (std::size_t l = 0; l <= degree; ++l)
      shape.mie[l][lane] = static_cast<float>(chi[l * bands + band]);
  }
  return shape;
}

double MuSOfNode(const MomentGrid& grid, std::size_t sun) {
  const double mu_s = MultipleScattering::SunNodes().MuS(static_cast<double>(sun) /
                                                         static_cast<double>(grid.suns - 1));
  return grid.polarised ? std::min(mu_s, kHighestPolarisedSun) : mu_s;
}

double SineOf(double cosine) { return std::sqrt(std::max((1.0 - cosine) * (1.0 + cosine), 0.0)); }

float SunSine(double mu_s) { return static_cast<float>(SineOf(mu_s)); }

CubicTaps SunTaps(const MomentGrid& grid, double mu_s) {
  const int suns = static_cast<int>(grid.suns);
  CubicTaps taps = TapsAt(MultipleScattering::SunCoordinate(mu_s), suns);
  const float here = TwilightOf(grid, mu_s);
  for (std::size_t tap = 0; tap < 4; ++tap) {
    const double v = static_cast<double>(taps.node[tap]) / (suns - 1);
    taps.weight[tap] *= here / TwilightOf(grid, MultipleScattering::SunNodes().MuS(v));
  }
  return taps;
}

std::vector<float> TwilightAtNodes(const MomentGrid& grid) {
  std::vector<float> twilight;
  for (std::size_t sun = 0; sun < grid.suns; ++sun) {
    const double v = static_cast<double>(sun) / static_cast<double>(grid.suns - 1);
    twilight.push_back(TwilightOf(grid, MultipleScattering::SunNodes().MuS(v)));
  }
  return twilight;
}

namespace {

// Returns whether aerosol scatters less than 3e-4 of what molecules scatter, in every band. It then
// needs no more moments than molecules do.
bool OnlyMolecules(const AirConstants<float>& air, float rayleigh_density, float mie_density) {
  for (std::size_t band = 0; band < air.bands; ++band) {
    if (air.mie_scattering[band] * mie_density > 3e-4F * air.rayleigh[band] * rayleigh_density)
      return false;
  }
  return true;
}

// Vertical optical depth from which light is scattered so often that marches are cut at optical
// depths.
constexpr double kDeepAir = 0.9;
// Optical depths of the cuts, and Gauss nodes of each part.
constexpr std::array kCutDepths{1.5, 6.0, 24.0};
constexpr int kNodesOfPart = 10;

ColumnSet<float> ColumnsUpTo(const SingleScattering<float>& air, ViewRay ray, double length_m) {
  if (length_m <= 0.0) return {0.0F, 0.0F, 0.0F};
  ray.length_m = length_m;
  return air.ColumnsAlong(ray);
}

// Returns the largest optical depth of scattering air between the observer and a distance.
double DepthUpTo(const SingleScattering<float>& air, const ViewRay& ray, double length_m) {
  const ColumnSet<float> columns = ColumnsUpTo(air, ray, length_m);
  float depth = 0.0F;
  for (std::size_t band = 0; band < air.bands(); ++band) {
    const Extinction<float> extinction = ExtinctionAt(air.constants(), band);
    depth = std::max(depth, extinction.rayleigh * columns.rayleigh + extinction.mie * columns.mie);
  }
  return static_cast<double>(depth);
}

// Returns the distance at which a ray reaches an optical depth [m], to a tenth, which is enough for
// a cut.
double DistanceOfDepth(const SingleScattering<float>& air, const ViewRay& ray, double end_m,
                       double depth) {
  double shortest = 1e-6 * end_m, longest = end_m;
  while (longest > 1.1 * shortest) {
    const double middle = std::sqrt(shortest * longest);
    (DepthUpTo(air, ray, middle) < depth ? shortest : longest) = middle;
  }
  return longest;
}

bool IsDeep(const SingleScattering<float>& air) {
  const ViewRay up{0.0, 1.0, 1.0, 1.0};
  return DepthUpTo(air, up, air.medium().atmosphere_height_m) >= kDeepAir;
}

// Returns the distances at which a ray through deep air is cut [m]. What a node sees lies within a
// few optical depths, and the Gauss nodes of the whole ray would miss it.
std::vector<double> CutsOf(const SingleScattering<float>& air, const ViewRay& ray,
                           const RayExtent& extent) {
  std::vector<double> cuts_m;
  const double depth = DepthUpTo(air, ray, extent.end_m);
  for (const double cut : kCutDepths) {
    if (depth <= 1.5 * cut) break;
    const double at_m = DistanceOfDepth(air, ray, extent.end_m, cut);
    if (at_m < 0.99 * extent.end_m) cuts_m.push_back(at_m);
  }
  return cuts_m;
}

// Returns the ray that begins at a distance of another one.
ViewRay PointAlong(const ViewRay& ray, double distance_m, double radius_km) {
  if (distance_m <= 0.0) return ray;
  const double h = ray.altitude_m / 1000.0, d = distance_m / 1000.0;
  const double there = std::max(shared::AltitudeAlongRay<double>(h, ray.mu, d, radius_km), 0.0);
  const double mu = shared::ZenithCosineAlongRay<double>(h, ray.mu, d, there, radius_km);
  return {1000.0 * there, std::clamp(mu, -1.0, 1.0), ray.mu_s, ray.nu};
}

constexpr std::size_t kOrderLanes = 16;

std::size_t RoundUp(std::size_t count) {
  return (count + kOrderLanes - 1) / kOrderLanes * kOrderLanes;
}

/// Sunlit pieces of the rays of one march.
struct Pieces {
  std::vector<std::size_t> ray;
  std::vector<double> begin, end;
};

// Returns, for every ray, the parts of [begin, end] before and after the planet's shadow.
std::array<Pieces, 2> SunlitPieces(const MomentMarches& marches, std::size_t altitude,
                                   const March& march, double begin, double end) {
  const double h_m = marches.altitude_km(altitude) * 1000.0;
  const RayExtent extent{0.0, march.panels.back() * 1000.0, RayEnd::kSpace};
  std::array<Pieces, 2> pieces;
  const auto add = [](Pieces& to, std::size_t ray, double from, double until) {
    if (until - from <= 1e-9 * until) return;
    to.ray.push_back(ray);
    to.begin.push_back(from);
    to.end.push_back(until);
  };
  for (std::size_t sun = 0; sun < marches.grid().suns; ++sun) {
    for (std::size_t k = 0; k < marches.azimuths(); ++k) {
      const std::size_t ray = sun * marches.azimuths() + k;
      const double nu = marches.Nu(march, sun, k);
      const ShadowSpan dark =
          PlanetShadow({h_m, static_cast<double>(march.mu), marches.mu_s(sun), nu}, extent,
                       marches.radius_km() * 1000.0);
      if (dark.dark_begin_m >= dark.dark_end_m) {
        add(pieces[0], ray, begin, end);
      } else {
        add(pieces[0], ray, begin, std::min(end, dark.dark_begin_m / 1000.0));
        add(pieces[1], ray, std::max(begin, dark.dark_end_m / 1000.0), end);
      }
    }
  }
  return pieces;
}

/// Columns [km] of n points, in contiguous memory.
struct ColumnStore {
  explicit ColumnStore(std::size_t n) : rayleigh(n), mie(n), ozone(n) {}
  AlignedFloats rayleigh, mie, ozone;
  [[nodiscard]] ColumnSet<float*> Write() { return {rayleigh.data(), mie.data(), ozone.data()}; }
  [[nodiscard]] ColumnPointers Read() const { return {rayleigh.data(), mie.data(), ozone.data()}; }
};

// Returns the upward columns at the node along |mu|, and at the perigee of the march.
std::array<float, 6> OriginAndPerigee(const AirConstants<float>& air, float altitude_km,
                                      const March& march) {
  AlignedFloats altitude(kOrderLanes), mu(kOrderLanes);
  const float r = air.radius + altitude_km;
  altitude.data()[0] = altitude_km;
  mu.data()[0] = std::abs(march.mu);
  altitude.data()[1] = std::max(altitude_km - r * march.mu * march.mu / (1.0F + march.sine), -1.0F);
  ColumnStore columns(kOrderLanes);
  Kernel<RayKernel<float>>().columns_up(air, kOrderLanes, altitude.data(), mu.data(),
                                        columns.Write());
  const ColumnPointers c = columns.Read();
  return {c.rayleigh[0], c.mie[0], c.ozone[0], c.rayleigh[1], c.mie[1], c.ozone[1]};
}

/// Adds the light of sunlit pieces to the radiance of a march.
class PieceScatterer {
 public:
  PieceScatterer(const MomentMarches& marches, std::size_t altitude, const March& march,
                 const MultipleScatteringOptions& options)
      : marches_(marches),
        air_(marches.air().constants()),
        altitude_km_(static_cast<float>(marches.altitude_km(altitude))),
        march_(march),
        map_(static_cast<float>(MapLengthsPerKm(marches.air().medium()))),
        ends_(OriginAndPerigee(air_, altitude_km_, march)) {
    const GaussRule& rule = GaussLegendre(options.ray_nodes);
    node_.assign(rule.node.begin(), rule.node.end());
    weight_.assign(rule.weight.begin(), rule.weight.end());
    const Medium& medium = marches.air().medium();
    for (std::size_t sun = 0; sun < marches.grid().suns; ++sun) {
      for (std::size_t k = 0; k < marches.azimuths(); ++k) {
        const double nu = marches.Nu(march, sun, k);
        for (const double depolarisation : medium.rayleigh_depolarisation) {
          rayleigh_phase_.push_back(static_cast<float>(shared::PhaseMolecules(nu, depolarisation)));
        }
        if (options.delta_m) {
          AddSeries(nu);
        } else {
          const Spectrum phases = marches.air().AerosolPhases(nu);
          mie_phase_.insert(
              mie_phase_.end(), phases.values().begin(),
              phases.values().begin() + static_cast<std::ptrdiff_t>(medium.mie_phase.size()));
        }
      }
    }
  }

  void Add(const Pieces& pieces, SunlightOfMarch& light) const {
    if (pieces.ray.empty()) return;
    const std::size_t count = RoundUp(pieces.ray.size());
    const std::size_t azimuths = marches_.azimuths();
    AlignedFloats begin(count), end(count), nu(count), mu_s(count);
    for (std::size_t i = 0; i < pieces.ray.size(); ++i) {
      const std::size_t sun = pieces.ray[i] / azimuths;
      begin.data()[i] = static_cast<float>(pieces.begin[i]);
      end.data()[i] = static_cast<float>(pieces.end[i]);
      nu.data()[i] = static_cast<float>(marches_.Nu(march_, sun, pieces.ray[i] % azimuths));
      mu_s.data()[i] = static_cast<float>(marches_.mu_s(sun));
    }
    float extinction = 0.0F;
    for (std::size_t band = 0; band < air_.bands; ++band)
      extinction = std::max(extinction, air_.rayleigh[band] + air_.mie_extinction[band]);
    const LitPieces lit{count,        begin.data(), end.data(),    nu.data(),  mu_s.data(),
                        altitude_km_, march_.mu,    air_.radius,   extinction, map_,
                        node_.size(), node_.data(), weight_.data()};
    Scatter(pieces, lit, light);
  }

 private:
  // Evaluates the aerosol's phase function at an angle from its Legendre coefficients.
  void AddSeries(double nu) {
    const std::vector<double> legendre =
        LegendreSeries(static_cast<int>(marches_.grid().degree), nu);
    for (std::size_t phase = 0; phase < marches_.air().medium().mie_phase.size(); ++phase) {
      double sum = 0.0;
      for (std::size_t l = 0; l < legendre.size(); ++l)
        sum += legendre[l] * marches_.chi()[l * air_.bands + phase];
      mie_phase_.push_back(static_cast<float>(sum));
    }
  }

  void Scatter(const Pieces& pieces, const LitPieces& lit, SunlightOfMarch& light) const {
    const std::size_t points = lit.count * lit.nodes;
    AlignedFloats weight(points), altitude(points), mu(points), absolute_mu(points), mu_s(points);
    const LitPoints at{weight.data(), altitude.data(), mu.data(), absolute_mu.data(), mu_s.data()};
    const MomentKernel& kernel = Kernel<MomentKernel>();
    const RayKernel<float>& rays = Kernel<RayKernel<float>>();
    kernel.place(lit, at);
    ColumnStore up(points), sun(points);
    rays.columns_up(air_, points, at.altitude, at.absolute_mu, up.Write());
    rays.columns_to_space(air_, points, at.altitude, at.mu_s, sun.Write());
    AlignedFloats rayleigh(lit.count), mie(lit.count);
    const std::size_t rays_count = marches_.grid().suns * marches_.azimuths();
    const std::size_t phases = marches_.air().medium().mie_phase.size();
    const std::size_t shapes = marches_.air().medium().rayleigh_depolarisation.size();
    for (std::size_t band = 0; band < air_.bands; ++band) {
      kernel.scatter(lit, at, up.Read(), sun.Read(), ends_,
                     {air_.rayleigh[band], air_.mie_extinction[band], air_.ozone[band]},
                     {air_.rayleigh_height, air_.mie_height, air_.deficit, air_.deficit_height},
                     rayleigh.data(), mie.data());
      for (std::size_t i = 0; i < pieces.ray.size(); ++i) {
        const std::size_t ray = pieces.ray[i];
        const float mie_phase = mie_phase_[ray * phases + (phases > 1 ? band : 0)];
        const float rayleigh_phase = rayleigh_phase_[ray * shapes + (shapes > 1 ? band : 0)];
        light.radiance[band * rays_count + ray] +=
            rayleigh_phase * air_.rayleigh[band] * rayleigh.data()[i] +
            mie_phase * air_.mie_scattering[band] * mie.data()[i];
        light.molecules[band * rays_count + ray] += air_.rayleigh[band] * rayleigh.data()[i];
      }
    }
  }

  const MomentMarches& marches_;
  const AirConstants<float>& air_;
  float altitude_km_;
  const March& march_;
  float map_;
  std::array<float, 6> ends_;
  std::vector<float> node_, weight_, rayleigh_phase_, mie_phase_;
};

// Adds the sunlight that the ground at the end of the march reflects.
void AddSunlitGround(const MomentMarches& marches, std::size_t altitude, const March& march,
                     std::vector<float>& radiance) {
  const SingleScattering<float>& air = marches.air();
  const double r = marches.radius_km() + marches.altitude_km(altitude);
  const std::size_t rays = marches.grid().suns * marches.azimuths();
  for (std::size_t ray = 0; ray < rays; ++ray) {
    const std::size_t sun = ray / marches.azimuths();
    const double nu = marches.Nu(march, sun, ray % marches.azimuths());
    const double mu_s = std::min(
        (r * marches.mu_s(sun) + march.ground_distance_km * nu) / marches.radius_km(), 1.0);
    if (mu_s <= 0.0) continue;
    const Spectrum light = air.TransmittanceToSpace(0.0, mu_s);
    for (std::size_t band = 0; band < air.bands(); ++band) {
      radiance[band * rays + ray] +=
          march.ground_transmittance[band] * light[band] *
          static_cast<float>(air.medium().ground_albedo[band] * mu_s / kPi);
    }
  }
}

}  // namespace

MomentMarches::MomentMarches(const SingleScattering<float>& air,
                             const MultipleScatteringOptions& options,
                             const std::vector<double>& chi)
    : air_(&air),
      chi_(&chi),
      grid_(GridOf(air.medium(), options)),
      radius_km_(air.medium().planet_radius_m / 1000.0),
      is_deep_(IsDeep(air)),
      azimuths_(static_cast<std::size_t>(options.azimuth_nodes)) {
  for (int i = 0; i < options.altitudes; ++i) {
    const double u = static_cast<double>(i) / (options.altitudes - 1);
    altitude_km_.push_back(air.medium().atmosphere_height_m / 1000.0 * u * u);
  }
  for (int j = 0; j < options.sun_angles; ++j) {
    mu_s_.push_back(MuSOfNode(grid_, static_cast<std::size_t>(j)));
    mu_s_floats_.push_back(static_cast<float>(mu_s_.back()));
    sine_s_.push_back(static_cast<float>(SineOf(mu_s_.back())));
  }
  for (std::size_t m = 0; m < azimuth_cosines_.size(); ++m) {
    azimuth_cosines_[m] = AlignedFloats(kMostAzimuths);
    for (std::size_t k = 0; k < azimuths_; ++k) {
      const double azimuth = (static_cast<double>(k) + 0.5) * kPi / options.azimuth_nodes;
      azimuth_cosines_[m].data()[k] =
          static_cast<float>(std::cos(static_cast<double>(m) * azimuth));
    }
  }
  for (std::size_t m = 1; m <= azimuth_sines_.size(); ++m) {
    azimuth_sines_[m - 1] = AlignedFloats(kMostAzimuths);
    for (std::size_t k = 0; k < azimuths_; ++k) {
      const double azimuth = (static_cast<double>(k) + 0.5) * kPi / options.azimuth_nodes;
      azimuth_sines_[m - 1].data()[k] =
          static_cast<float>(std::sin(static_cast<double>(m) * azimuth));
    }
  }
  marches_.resize(altitude_km_.size());
  tbb::parallel_for(std::size_t{0}, marches_.size(),
                    [&](std::size_t i) { marches_[i] = MarchesAt(i, options); });
}

MarchDirection MomentMarches::Direction(std::size_t altitude, const March& march) const {
  return {march.mu,
          march.sine,
          static_cast<float>(radius_km_ + altitude_km_[altitude]),
          mu_s_floats_.data(),
          sine_s_.data(),
          azimuth_cosines_[1].data(),
          azimuths_};
}

double MomentMarches::Nu(const March& march, std::size_t sun, std::size_t azimuth) const {
  const double mu = static_cast<double>(march.mu);
  const double nu = mu * mu_s_[sun] + SineOf(mu) * SineOf(mu_s_[sun]) *
                                          static_cast<double>(AzimuthCosines(1)[azimuth]);
  return std::clamp(nu, -1.0, 1.0);
}

// Places Gauss nodes above and below the horizon, dense near it: mu - horizon = range v^2.
std::vector<March> MomentMarches::MarchesAt(std::size_t altitude,
                                            const MultipleScatteringOptions& options) const {
  const double horizon = shared::HorizonCosine<double>(altitude_km_[altitude], radius_km_);
  const GaussRule& rule = GaussLegendre(options.zenith_nodes);
  std::vector<March> marches;
  for (const double end : {-1.0, 1.0}) {
    for (std::size_t k = 0; k < rule.node.size(); ++k) {
      const double v = rule.node[k];
      March march;
      march.mu = static_cast<float>(horizon + (end - horizon) * v * v);
      march.sine = static_cast<float>(SineOf(static_cast<double>(march.mu)));
      march.solid_angle = static_cast<float>(std::abs(end - horizon) * 4.0 * v * rule.weight[k] *
                                             kPi / options.azimuth_nodes);
      const Moments legendre = LegendreTerms(options.degree, march.mu);
      std::copy(legendre.begin(), legendre.end(), march.legendre.begin());
      AddPoints(altitude, options, static_cast<double>(march.mu), march);
      marches.push_back(std::move(march));
    }
  }
  return marches;
}

void MomentMarches::AddPoints(std::size_t altitude, const MultipleScatteringOptions& options,
                              double mu, March& march) const {
  // With the sun in the zenith no part of the ray is in shadow, so one set of panels serves every
  // sun.
  const ViewRay ray{altitude_km_[altitude] * 1000.0, mu, 1.0, mu};
  const RayExtent extent =
      ExtentOf(ray, air_->medium().planet_radius_m, air_->medium().atmosphere_height_m);
  const std::vector<double> cuts_m = is_deep_ ? CutsOf(*air_, ray, extent) : std::vector<double>();
  const int nodes = cuts_m.empty() ? options.ray_nodes : std::min(options.ray_nodes, kNodesOfPart);
  double begin_m = 0.0;
  for (std::size_t i = 0; i <= cuts_m.size(); ++i) {
    ViewRay part = PointAlong(ray, begin_m, radius_km_);
    if (i < cuts_m.size()) part.length_m = cuts_m[i] - begin_m;
    const RaySamples<float> samples =
        air_->Sample(part, {.nodes = nodes, .split_ozone = false, .dark_samples = true});
    AppendPoints(samples, {begin_m / 1000.0, ColumnsUpTo(*air_, ray, begin_m)}, options.degree,
                 march);
    begin_m = i < cuts_m.size() ? cuts_m[i] : begin_m;
  }
  const double end = extent.end_m / 1000.0;
  const double lowest = -(radius_km_ + altitude_km_[altitude]) * mu;
  march.panels = {0.0, end};
  if (lowest > 0.0 && lowest < end) march.panels = {0.0, lowest, end};
  const ColumnSet<float> whole = air_->ColumnsAlong(ray);
  march.columns_km = {whole.rayleigh, whole.mie, whole.ozone};
  march.hits_ground = extent.end == RayEnd::kGround;
  march.ground_distance_km = end;
  if (march.hits_ground) AddGround(altitude, march);
}

void MomentMarches::AppendPoints(const RaySamples<float>& samples, const PartOfMarch& part,
                                 int degree, March& march) const {
  for (std::size_t s = 0; s < samples.count; ++s) {
    const float h = samples.altitude[s];
    const CubicTaps taps =
        TapsAt(std::sqrt(static_cast<double>(h / grid_.top_km)), static_cast<int>(grid_.altitudes));
    MarchPoint point{};
    for (std::size_t tap = 0; tap < 4; ++tap) {
      point.altitude_node[tap] = static_cast<std::uint32_t>(taps.node[tap]);
      point.altitude_weight[tap] = taps.weight[tap];
    }
    point.mu = samples.mu[s];
    point.sine = static_cast<float>(SineOf(static_cast<double>(point.mu)));
    point.distance_km = static_cast<float>(part.begin_km) + samples.distance[s];
    point.inverse_radius = static_cast<float>(1.0 / (radius_km_ + static_cast<double>(h)));
    point.only_molecules =
        OnlyMolecules(air_->constants(), samples.rayleigh_density[s], samples.mie_density[s]);
    const Moments legendre = LegendreTerms(degree, point.mu);
    std::copy(legendre.begin(), legendre.end(), point.legendre.begin());
    march.points.push_back(point);
    march.air.push_back({samples.weight[s], samples.rayleigh_density[s], samples.mie_density[s],
                         part.columns.rayleigh + samples.view_rayleigh[s],
                         part.columns.mie + samples.view_mie[s],
                         part.columns.ozone + samples.view_ozone[s]});
  }
}

void MomentMarches::AddGround(std::size_t altitude, March& march) const {
  const double mu = static_cast<double>(march.mu);
  const double r = radius_km_ + altitude_km_[altitude];
  march.ground_transmittance =
      air_->TransmittanceAlong({altitude_km_[altitude] * 1000.0, mu, 1.0, mu});
  for (std::size_t j = 0; j < mu_s_.size(); ++j) {
    for (std::size_t k = 0; k < azimuths_; ++k) {
      const double mu_s = std::clamp(
          (r * mu_s_[j] + march.ground_distance_km * Nu(march, j, k)) / radius_km_, -1.0, 1.0);
      CubicTaps taps =
          TapsAt(MultipleScattering::SunCoordinate(mu_s), static_cast<int>(grid_.suns));
      const float twilight = TwilightOf(grid_, mu_s);
      for (float& weight : taps.weight) weight *= twilight;
      march.ground_taps.push_back(taps);
    }
  }
}

SunlightOfMarch SunlightScatteredOnce(const MomentMarches& marches, std::size_t altitude,
                                      const March& march,
                                      const MultipleScatteringOptions& options) {
  const std::size_t values = marches.air().bands() * marches.grid().suns * marches.azimuths();
  SunlightOfMarch light{std::vector<float>(values, 0.0F), std::vector<float>(values, 0.0F)};
  const PieceScatterer scatterer(marches, altitude, march, options);
  for (std::size_t panel = 0; panel + 1 < march.panels.size(); ++panel) {
    for (const Pieces& pieces :
         SunlitPieces(marches, altitude, march, march.panels[panel], march.panels[panel + 1])) {
      scatterer.Add(pieces, light);
    }
  }
  if (march.hits_ground) AddSunlitGround(marches, altitude, march, light.radiance);
  return light;
}

}  // namespace alpenglow::lut
