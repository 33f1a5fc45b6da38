// SPDX-License-Identifier: MIT
#include "renderer/surface/surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "renderer/material/land_cover.h"
#include "renderer/material/reflectance.h"
#include "renderer/procedural_mountains/lattice_noise.h"

namespace alpenglow::renderer {
namespace {

Spectrum AlbedoBands(const std::array<double, 3>& rgb, std::span<const double> wavelengths_nm) {
  const std::vector<double> albedo = AlbedoFromLinearSrgb(rgb, wavelengths_nm);
  Spectrum bands(albedo.size());
  for (std::size_t band = 0; band < albedo.size(); ++band)
    bands[band] = static_cast<float>(albedo[band]);
  return bands;
}

/// A family of noise of ground_cover.glsl.
struct Noise {
  int longest_m, octaves;
  std::uint32_t seed;
  int fall;
};
constexpr std::array<Noise, kGroundNoises> kNoises{{
    {shared::kBroadWave_m, shared::kBroadOctaves, shared::kBroadSeed, shared::kBroadFall},
    {shared::kFineWave_m, shared::kFineOctaves, shared::kFineSeed, shared::kFineFall},
    {shared::kReliefWave_m, shared::kReliefOctaves, shared::kReliefSeed, shared::kReliefFall},
    {shared::kGrainWave_m, shared::kGrainOctaves, shared::kGrainSeed, shared::kGrainFall},
    {shared::kWaveWave_m, shared::kWaveOctaves, shared::kWaveSeed, shared::kWaveFall},
}};

// Waves travel to the east with a spread of 50 degrees to either side, 29 rms. By multiples of the
// golden angle no two octaves travel alike.
void SetTravelling(NoiseOctave& wave, int octave) {
  constexpr double kNoiseWaves = 4.1;  // rms slope of the noise over its rms height, per square
  constexpr double kSpread_rad = 50.0 * kRadiansPerDegree;
  const double turn = octave * kGoldenAngle / (2.0 * kPi);
  const double direction = kSpread_rad * (2.0 * (turn - std::floor(turn)) - 1.0);
  const double speed = WaveSpeed(kNoiseWaves / wave.wavelength_m);
  wave.drift_east = speed * std::cos(direction);
  wave.drift_north = speed * std::sin(direction);
}

std::vector<NoiseOctave> MadeOctaves(GroundNoise family) {
  const Noise& noise = kNoises[static_cast<std::size_t>(family)];
  std::vector<NoiseOctave> octaves;
  double wavelength_m = noise.longest_m;
  glm::dvec2 lean(0.01 * shared::kLean_percent, 0.0);
  for (int octave = 0; octave < noise.octaves; ++octave, wavelength_m *= 0.5) {
    NoiseOctave made{wavelength_m, noise.seed + static_cast<std::uint32_t>(octave), 0.0, 0.0, 0.0,
                     0.0};
    if (family == GroundNoise::kWaves) {
      SetTravelling(made, octave);
    } else {
      made.lean_east = lean.x;
      made.lean_north = lean.y;
    }
    lean = {shared::NextLeanEast(lean.x, lean.y), shared::NextLeanNorth(lean.x, lean.y)};
    octaves.push_back(made);
  }
  return octaves;
}

// Calls visit(octave, amplitude) for the octaves that a footprint keeps.
template <typename Visit>
void VisitOctaves(double footprint_m, GroundNoise family, const Visit& visit) {
  const double fall = kNoises[static_cast<std::size_t>(family)].fall;
  double amplitude = 1.0;
  for (const NoiseOctave& octave : OctavesOf(family)) {
    const double kept = shared::OctaveShare(octave.wavelength_m, footprint_m);
    if (kept == 0.0) break;
    visit(octave, kept * amplitude);
    amplitude /= fall;
  }
}

double LandFootprint(const GroundPoint& point) {
  return shared::LandFootprint(point.across_m, point.cosine);
}

double DetailNoise(const GroundPoint& point, GroundNoise family) {
  double sum = 0.0;
  VisitOctaves(LandFootprint(point), family, [&](const NoiseOctave& octave, double amplitude) {
    const glm::dvec2 at = octave.PlaceOf(point);
    sum += amplitude * GradientNoise(at.x, at.y, octave.seed);
  });
  return sum;
}

using Kind = GroundCover::Kind;

// Elevation models store the sea level with a rounding error.
constexpr double kWaterLine_m = 0.5;

}  // namespace

glm::dvec2 NoiseOctave::PlaceOf(const GroundPoint& point) const {
  const glm::dvec2 at((point.east_m + lean_east * point.up_m - drift_east * point.sea_s),
                      (point.north_m + lean_north * point.up_m - drift_north * point.sea_s));
  const glm::dvec2 squares = at / wavelength_m;
  if (drift_east == 0.0) return squares;
  constexpr double kAround = 4294967296.0;
  return squares - kAround * glm::floor(squares / kAround + 0.5);
}

std::span<const NoiseOctave> OctavesOf(GroundNoise family) {
  static const std::array<std::vector<NoiseOctave>, kGroundNoises> kOctaves{
      MadeOctaves(GroundNoise::kBroad), MadeOctaves(GroundNoise::kFine),
      MadeOctaves(GroundNoise::kRelief), MadeOctaves(GroundNoise::kGrain),
      MadeOctaves(GroundNoise::kWaves)};
  return kOctaves[static_cast<std::size_t>(family)];
}

double SeaTime(const UtcTime& instant) {
  return (instant.modified_julian_day - 58849) * kSecondsPerDay + instant.second_of_day;
}

double WaveSpeed(double wave_number) {
  constexpr double kGravity = 9.80665, kTension = 7.4e-5;
  return std::sqrt(kGravity / wave_number + kTension * wave_number);
}

// Linear sRGB of broad classes of ground, chosen within the ranges of visible albedo of Oke (1987),
// Boundary Layer Climates, table 1.1: forest 0.05-0.15, grass 0.1-0.25, rock and soil 0.1-0.3, snow
// 0.7-0.95. Dry grass and leafless trees become lighter towards the red, like litter and bark and
// as satellites observe: in the blue, green and red about 0.06, 0.10, 0.14 and 0.04, 0.06, 0.08.
MountainSurface::MountainSurface(std::span<const double> wavelengths_nm, const MountainCover& cover,
                                 double wetness)
    : cover_(cover),
      materials_{AlbedoBands({0.038, 0.054, 0.027}, wavelengths_nm),
                 AlbedoBands({0.043, 0.067, 0.024}, wavelengths_nm),
                 AlbedoBands({0.130, 0.092, 0.030}, wavelengths_nm),
                 AlbedoBands({0.068, 0.060, 0.045}, wavelengths_nm),
                 Wetted(AlbedoBands({0.098, 0.115, 0.055}, wavelengths_nm), wetness),
                 Wetted(AlbedoBands({0.126, 0.108, 0.060}, wavelengths_nm), wetness),
                 Wetted(AlbedoBands({0.173, 0.172, 0.166}, wavelengths_nm), wetness),
                 AlbedoBands({0.820, 0.840, 0.860}, wavelengths_nm)} {}

Spectrum MountainSurface::Albedo(const GroundPoint& point, double normal_up,
                                 const std::optional<MappedCover>& mapped) const {
  const double broad = DetailNoise(point, GroundNoise::kBroad);
  const double fine = DetailNoise(point, GroundNoise::kFine);
  const double grain = DetailNoise(point, GroundNoise::kGrain);
  const double altitude = shared::WaveringAltitude(point.altitude_m, broad, fine);
  const auto rise = [](double value) { return static_cast<float>(value); };
  const float forest =
      mapped ? mapped->wood
             : shared::ForestShare(rise(shared::TreelessRise(altitude, cover_.tree_line_m)),
                                   rise(shared::FlatRise(normal_up)), rise(broad), rise(fine));
  const float rock = shared::RockShare(
      mapped ? mapped->stone : rise(shared::BareRise(altitude, cover_.tree_line_m)),
      mapped ? 1.0F : rise(shared::SoilRise(normal_up)));
  const double snow_line_m =
      cover_.snow_line_m + shared::SunnySide(-cover_.sun_in_south * point.normal_north);
  const float broadleaf =
      rise(shared::BroadleafShare(altitude, cover_.broadleaf_line_m, broad, fine));
  const float in_leaf = rise(shared::LeafShare(altitude, cover_.leaf_line_m));
  const float not_bare = rise(shared::LeafShare(altitude, cover_.bare_line_m));
  const float grass = rise(shared::LeafShare(altitude, cover_.grass_line_m));
  const float gap =
      shared::CanopyGap(broadleaf * (1.0F - not_bare), rise(broad), rise(fine), rise(grain));
  const float lying =
      rise(shared::ColdRise(shared::SnowAltitude(point.altitude_m, broad), snow_line_m)) *
      rise(shared::SnowHoldRise(normal_up));
  const float snow =
      std::max(shared::SnowSeen(lying, forest, rock, gap), mapped ? mapped->snow : 0.0F);
  const auto tone = shared::GroundTone(rise(broad), rise(fine), rise(grain), forest, rock);
  Spectrum albedo(materials_.rock.size());
  for (std::size_t band = 0; band < albedo.size(); ++band) {
    const Materials& of = materials_;
    const float green = shared::GreenAlbedo(
        shared::PartlyCovered(of.dry_meadow[band], of.meadow[band], grass), of.conifers[band],
        shared::BroadleafAlbedo(of.bare_trees[band], of.yellow_leaves[band], of.leaves[band],
                                not_bare, in_leaf),
        forest, broadleaf);
    albedo[band] =
        shared::CoverAlbedo(green, materials_.rock[band], materials_.snow[band], rock, snow, tone);
  }
  return albedo;
}

glm::dvec3 MountainSurface::DetailedNormal(const GroundPoint& point, const glm::dvec3& normal) {
  glm::dvec3 tilt(0.0);
  VisitOctaves(LandFootprint(point), GroundNoise::kRelief,
               [&](const NoiseOctave& octave, double amplitude) {
                 const glm::dvec2 at = octave.PlaceOf(point);
                 const NoiseSlope noise = GradientNoiseSlope(at.x, at.y, octave.seed);
                 tilt -= shared::kReliefHeight_m * amplitude / octave.wavelength_m *
                         glm::dvec3(noise.by_x, noise.by_y,
                                    octave.lean_east * noise.by_x + octave.lean_north * noise.by_y);
               });
  return glm::normalize(normal + tilt - glm::dot(tilt, normal) * normal);
}

glm::dvec3 WavySurface::Normal(const glm::dvec3& up) const {
  const glm::dvec3 tilt(slope_east, slope_north, 0.0);
  return glm::normalize(up - tilt + glm::dot(tilt, up) * up);
}

WavySurface WavesAt(const GroundPoint& point, double slope_variance) {
  const double longest_m = shared::LongestWave(slope_variance);
  const double each = shared::WaveOctaveVariance(slope_variance, longest_m);
  const double shown = shared::WaveShown(std::max(point.cosine, 0.0), slope_variance);
  WavySurface waves{0.0, 0.0, slope_variance};
  const double footprint_m = shared::SeenFootprint(point.across_m, point.cosine);
  VisitOctaves(footprint_m, GroundNoise::kWaves, [&](const NoiseOctave& octave, double height) {
    const double kept = shown * height * shared::kWaveWave_m / octave.wavelength_m *
                        shared::WaveRaised(octave.wavelength_m, longest_m);
    if (kept == 0.0) return;
    const glm::dvec2 at = octave.PlaceOf(point);
    const NoiseSlope noise = GradientNoiseSlope(at.x, at.y, octave.seed);
    waves.slope_east += kept * shared::WaveSlope(each) * noise.by_x;
    waves.slope_north += kept * shared::WaveSlope(each) * noise.by_y;
    waves.slope_variance -= kept * kept * each;
  });
  return waves;
}

GroundPatch::GroundPatch(const GroundMaterial& material, const GroundPoint& at)
    : material_(material),
      kind_(Kind::kWater),
      albedo_(material.albedo().size()),
      waves_(WavesAt(at, material.water().slope_variance())) {}

Spectrum GroundPatch::Brdf(const ReflectionAngles& at) const {
  switch (kind_) {
    case Kind::kOrenNayar:
      return material_.rough_.Brdf(albedo_, at);
    case Kind::kBlinnPhong:
      return material_.glossy_.Brdf(albedo_, at);
    case Kind::kWater:
      return material_.water_.Brdf(at, waves_.slope_variance);
    case Kind::kSnow:
      return material_.snow_.Brdf(at);
    case Kind::kMountain:
    case Kind::kLambert:
      break;
  }
  return static_cast<float>(1.0 / kPi) * albedo_;
}

Spectrum GroundPatch::BodyAlbedo(double mu_eye) const {
  switch (kind_) {
    case Kind::kOrenNayar:
      return material_.rough_.Albedo(albedo_, mu_eye);
    case Kind::kBlinnPhong:
      return material_.glossy_.BodyAlbedo(albedo_, mu_eye);
    case Kind::kWater:
      return material_.water_.BodyAlbedo(mu_eye);
    case Kind::kSnow:
      return material_.snow_.Albedo(mu_eye);
    case Kind::kMountain:
    case Kind::kLambert:
      break;
  }
  return albedo_;
}

MirroredRays GroundPatch::Mirrored(const glm::dvec3& normal, const glm::dvec3& to_eye) const {
  if (kind_ == Kind::kWater) return material_.water_.Mirrored(normal, to_eye);
  if (kind_ == Kind::kBlinnPhong) return material_.glossy_.Mirrored(normal, to_eye);
  return {};
}

GroundMaterial::GroundMaterial(const GroundCover& cover, std::shared_ptr<const ColourDrape> drape,
                               std::span<const double> wavelengths_nm)
    : cover_(cover),
      drape_(std::move(drape)),
      bands_of_colour_(wavelengths_nm),
      albedo_(Wetted(bands_of_colour_.Albedo(cover.albedo), cover.wetness)),
      rough_(cover.kind == Kind::kOrenNayar ? cover.roughness : 0.0),
      glossy_(cover.kind == Kind::kBlinnPhong ? cover.roughness : 1.0, cover.reflectance),
      water_(cover.wind_m_per_s.value_or(kUsualWind_m_per_s), wavelengths_nm),
      snow_(cover.grain_diameter_m, wavelengths_nm) {}

bool GroundMaterial::HasGloss() const { return cover_.kind == Kind::kBlinnPhong || HasWater(); }

bool GroundMaterial::HasWater() const {
  return cover_.kind == Kind::kWater || cover_.sea_level_m || HasLandCover();
}

std::optional<double> GroundMaterial::WaterLine_m() const {
  if (!cover_.sea_level_m) return std::nullopt;
  return *cover_.sea_level_m + kWaterLine_m;
}

Spectrum GroundMaterial::AlbedoAt(const GroundPoint& at, double normal_up,
                                  const MountainSurface& season,
                                  const std::optional<std::array<double, 3>>& draped) const {
  if (draped && !HasLandCover()) return Wetted(bands_of_colour_.Albedo(*draped), cover_.wetness);
  if (cover_.kind != Kind::kMountain) return albedo_;
  if (!draped || shared::IsMapped((*draped)[1], (*draped)[2]) == 0.0)
    return season.Albedo(at, normal_up);
  return season.Albedo(
      at, normal_up,
      MappedCover{static_cast<float>((*draped)[0]), static_cast<float>((*draped)[1]),
                  static_cast<float>((*draped)[2])});
}

GroundPatch GroundMaterial::OfTerrain(const GroundPoint& at, const glm::dvec3& point,
                                      double normal_up, const MountainSurface& season) const {
  const auto water_line_m = WaterLine_m();
  if (cover_.kind == Kind::kWater || (water_line_m && at.altitude_m <= *water_line_m))
    return {*this, at};
  if (cover_.kind == Kind::kSnow) return {*this, cover_.kind, Spectrum(albedo_.size())};
  std::optional<std::array<double, 3>> draped;
  if (drape_) draped = drape_->At(point, at.altitude_m, at.across_m);
  if (draped && HasLandCover() && shared::IsMappedWater((*draped)[0], (*draped)[1]) > 0.0)
    return {*this, at};
  return {*this, cover_.kind, AlbedoAt(at, normal_up, season, draped)};
}

GroundPatch GroundMaterial::OfPlanet(const GroundPoint& at, const Spectrum& planet_albedo) const {
  const auto water_line_m = WaterLine_m();
  if (cover_.kind == Kind::kWater || (water_line_m && *water_line_m >= 0.0)) return {*this, at};
  if (cover_.kind == Kind::kMountain) return {*this, cover_.kind, planet_albedo};
  return {*this, cover_.kind, albedo_};
}

}  // namespace alpenglow::renderer
