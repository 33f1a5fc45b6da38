// SPDX-License-Identifier: MIT
#include "renderer/relief/relief.h"

#include <cmath>

#include "atmosphere/base/error.h"
#include "renderer/procedural_mountains/lattice_noise.h"
#include "renderer/relief/with_gradient.h"

namespace alpenglow::renderer {
namespace {

using Bits = std::uint32_t;
using shared::abs;
using shared::max;
using shared::min;
using shared::sqrt;

constexpr Bits kPatchSeed = 211U, kFineSeed = 223U, kGullySeed = 239U, kCragSeed = 257U;
// Gradient noise is multiplied by a gain. Its variance, and mean and standard deviation of its size.
constexpr double kNoiseGain = 1.5, kNoiseVariance = 0.0700;
constexpr double kNoiseSize = 0.2101, kNoiseSizeSpread = 0.161;
// Root mean squares of an octave of gullies per unit of its half height, and of its slope.
constexpr double kGullySpread = 0.37;
constexpr double kGullySlopeSpread = 0.41 * 6.283185307179586;
// Gullies of waves longer than this hold snow and debris, and how much an octave adds; root mean
// square of the stripes' cosine with their coherence.
constexpr double kValleyWave_m = 30.0, kValleyPart = 0.4, kCosineSpread = 0.6;
// Parts of the forms of soil and rock that snow follows.
constexpr double kSnowOnSoft = 0.4, kSnowOnRock = 0.1, kSnowInValleys = 1.8;
// A shift of the crags' lattice with height, as in ground_cover.glsl.
constexpr double kLean = 0.01 * shared::kLean_percent;
// Relief below cells of 2 m, which no octave here has.
constexpr double kFinestRelief_m = 0.15;
constexpr double kTwoPi = 6.283185307179586;

/// The number type of the computation: T is Real or WithGradient<Real>.
template <typename T>
struct PlacedGround {
  std::int32_t east_block, north_block;
  T east_m, north_m;
  T height_m, slope_east, slope_north;  // of the model
  T laplacian_per_m;
};

/// A cell of a lattice and the position in it, in cells.
template <typename T>
struct CellPlace {
  Bits east, north;
  T dx, dy;
};

/// Returns the cell of a place that is moved by a shift [m].
template <typename T>
CellPlace<T> CellOf(const PlacedGround<T>& at, int cell_m, const T& shift_east,
                    const T& shift_north) {
  const auto per_block = static_cast<std::int32_t>(shared::kBlock_m / cell_m);
  const T x = (at.east_m + shift_east) * T(1.0 / cell_m);
  const T y = (at.north_m + shift_north) * T(1.0 / cell_m);
  const auto i = std::floor(ValueOf(x)), j = std::floor(ValueOf(y));
  return {static_cast<Bits>(at.east_block) * static_cast<Bits>(per_block) +
              static_cast<Bits>(static_cast<std::int32_t>(i)),
          static_cast<Bits>(at.north_block) * static_cast<Bits>(per_block) +
              static_cast<Bits>(static_cast<std::int32_t>(j)),
          x - T(i), y - T(j)};
}

template <typename T>
T NoiseAt(const CellPlace<T>& at, Bits seed) {
  const auto corner = [&](Bits i, Bits j) {
    return shared::LatticePoint(at.east + i, at.north + j, seed);
  };
  return T(kNoiseGain) * shared::NoiseInCell<T>(corner(0, 0), corner(1, 0), corner(0, 1),
                                                corner(1, 1), at.dx, at.dy);
}

/// Returns the sine of any number of turns.
template <typename T>
T SineOf(const T& turns) {
  return shared::SineOfTurns<T>(turns - T(std::round(ValueOf(turns))));
}

/// Noise with several octaves, and the variance of what the footprint removes.
template <typename T>
struct FilteredNoise {
  T value{0};
  double variance = 0.0;
};

template <typename T>
void AddOctave(FilteredNoise<T>& sum, const PlacedGround<T>& at, int cell_m, double weight,
               Bits seed, double footprint_m) {
  const double share = shared::OctaveShare<double>(cell_m, footprint_m);
  sum.variance += weight * weight * kNoiseVariance * shared::UnresolvedPart(share);
  if (share > 0.0) sum.value += T(weight * share) * NoiseAt(CellOf(at, cell_m, T(0), T(0)), seed);
}

/// Patches of some hundred metres, and the fine noise that makes borders ragged.
template <typename T>
struct Noises {
  FilteredNoise<T> patches, fine;
  T hummocks{0};  // [m]
};

template <typename T>
Noises<T> NoisesAt(const PlacedGround<T>& at, double footprint_m) {
  Noises<T> noises;
  AddOctave(noises.patches, at, 512, 1.0, kPatchSeed, footprint_m);
  AddOctave(noises.patches, at, 128, 0.6, kPatchSeed + 1, footprint_m);
  int cell_m = shared::kRaggedCell_m;
  double weight = 0.85;
  for (Bits n = 0; n < shared::kRaggedOctaves; ++n, cell_m /= 2, weight *= 0.72)
    AddOctave(noises.fine, at, cell_m, weight, kFineSeed + n, footprint_m);
  return noises;
}

/// The mean of the stripes of 3 x 3 cells, as a cosine and a sine. Coherence is low where stripes
/// branch.
template <typename T>
struct Stripes {
  T cosine, sine, coherence;
};

template <typename T>
Stripes<T> StripesAt(const CellPlace<T>& at, const T& across_east, const T& across_north,
                     Bits seed) {
  T cosine(0), sine(0), weights(0);
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) {
      const Bits hash = shared::LatticePoint(at.east + static_cast<Bits>(i),
                                             at.north + static_cast<Bits>(j), seed);
      const T dx = at.dx - (T(i) + shared::StripeCentre(T(hash & 0xffffU)));
      const T dy = at.dy - (T(j) + shared::StripeCentre(T(hash >> 16)));
      const T weight = shared::StripeKernel<T>(dx * dx + dy * dy);
      if (!(ValueOf(weight) > 0)) continue;
      const T turns = (across_east * dx + across_north * dy) *
                      shared::StripesPerCell(T(shared::MixedBits(hash) >> 24));
      cosine += weight * SineOf<T>(turns + T(0.25));
      sine += weight * SineOf(turns);
      weights += weight;
    }
  }
  const T length = sqrt(cosine * cosine + sine * sine + T(1e-6) * weights * weights);
  return {cosine / length, sine / length, min(T(1), T(1.6) * length / weights)};
}

/// Second moments of the gullies that the footprint removes: of their forms in rock and soil [m]
/// and of valleys, which are perfectly correlated in one octave.
template <typename T>
struct GullyMoments {
  T rock_rock{0}, soft_soft{0}, valley_valley{0}, rock_soft{0}, rock_valley{0}, soft_valley{0};

  /// Adds an octave with standard deviations.
  void Add(const T& part, const T& rock, const T& soft, const T& valley) {
    rock_rock += part * rock * rock;
    soft_soft += part * soft * soft;
    valley_valley += part * valley * valley;
    rock_soft += part * rock * soft;
    rock_valley -= part * rock * valley;
    soft_valley -= part * soft * valley;
  }
  /// Weights of the three in a sum.
  struct Sum {
    T rock, soft, valley;
  };
  /// Returns the covariance of two sums.
  [[nodiscard]] T Covariance(const Sum& a, const Sum& b) const {
    return a.rock * b.rock * rock_rock + a.soft * b.soft * soft_soft +
           a.valley * b.valley * valley_valley + (a.rock * b.soft + a.soft * b.rock) * rock_soft +
           (a.rock * b.valley + a.valley * b.rock) * rock_valley +
           (a.soft * b.valley + a.valley * b.soft) * soft_valley;
  }
};

/// The forms of gullies, and what is left of them below the footprint.
template <typename T>
struct Gullies {
  T rock{0}, soft{0};         // heights [m]
  T slope_east, slope_north;  // of the model and of the gullies
  T valley{0};                // about -1 on ribs to 1 in gullies
  GullyMoments<T> unresolved;
  T slope_variance{0};  // unresolved
};

template <typename T>
T SlopeOf(const T& east, const T& north) {
  return sqrt(east * east + north * north + T(1e-8));
}

template <typename T>
struct GullySetting {
  T strength, stony;
};

/// Adds an octave of gullies along the fall line of the sum so far.
template <typename T>
void AddGullies(Gullies<T>& sum, const PlacedGround<T>& at, const GullySetting<T>& setting, int n,
                const ReliefScale& scale) {
  const int cell_m = shared::kBlock_m >> n;
  const double wave_m = cell_m / 1.7;
  const double missing = shared::MissingShare(wave_m, scale.spacing_m);
  const double share = shared::OctaveShare(wave_m, scale.footprint_m);
  if (missing <= 0.0) return;
  const T height = T(missing * shared::GullyHeight(wave_m)) * setting.strength;
  const double soft = n < shared::kSoftOctaves ? shared::SoftPart(wave_m) : 0.0;
  const T form = T(soft) + T(1.0 - soft) * setting.stony;  // in the slope: soft or of rock
  const T tilt = T(kGullySlopeSpread / wave_m) * height * form;
  const double unresolved = shared::UnresolvedPart(share);
  sum.slope_variance += T(unresolved) * tilt * tilt;
  const T depth = T(missing * (wave_m > kValleyWave_m ? kValleyPart : 0.0)) * setting.strength;
  sum.unresolved.Add(T(unresolved), T(kGullySpread) * height * setting.stony,
                     T(kCosineSpread * soft) * height, T(kCosineSpread) * depth);
  if (share <= 0.0 || !(ValueOf(height) > 0)) return;
  // On level ground the direction of stripes would turn at once: they grow wide instead.
  const T steepness =
      sqrt(sum.slope_east * sum.slope_east + sum.slope_north * sum.slope_north + T(0.01));
  const T along_east = sum.slope_east / steepness, along_north = sum.slope_north / steepness;
  const Stripes<T> stripes = StripesAt<T>(CellOf(at, cell_m, T(0), T(0)), -along_north, along_east,
                                          kGullySeed + static_cast<Bits>(n));
  const T part = T(share) * stripes.coherence;
  const T root = shared::GullyRoot(stripes.cosine);
  sum.rock += height * setting.stony * part * shared::GullyProfile(root);
  sum.soft += T(soft) * height * part * stripes.cosine;
  const T slope =
      height * form * part * T(kTwoPi / wave_m) * shared::GullyProfileSlope(root, stripes.sine);
  sum.slope_east -= slope * along_north;
  sum.slope_north += slope * along_east;
  sum.valley -= depth * part * stripes.cosine;
}

/// Properties of a place on which the layers depend besides their forms.
template <typename T>
struct Setting {
  T model_slope, ice, above_line, hollow, cold;
};

template <typename T>
Setting<T> SettingAt(const PlacedGround<T>& at, const MountainCover& cover, const T& patches) {
  Setting<T> setting;
  setting.model_slope = SlopeOf(at.slope_east, at.slope_north);
  const T sunward = T(cover.sun_in_south) * at.slope_north;  // of the normal, per its height
  const T normal_up = T(1) / sqrt(T(1) + setting.model_slope * setting.model_slope);
  setting.above_line = at.height_m - T(cover.snow_line_m) + T(110) * patches -
                       shared::SunnySide<T>(sunward * normal_up);
  setting.ice = shared::IceShare<T>(setting.above_line, setting.model_slope);
  setting.hollow = min(max(T(40) * at.laplacian_per_m, T(-0.5)), T(0.5));
  setting.cold = shared::BareRise<T>(at.height_m + T(150) * patches, T(cover.tree_line_m));
  return setting;
}

template <typename T>
Gullies<T> GulliesAt(const PlacedGround<T>& at, const Setting<T>& setting, const T& patches,
                     const ReliefScale& scale) {
  Gullies<T> sum;
  sum.slope_east = at.slope_east;
  sum.slope_north = at.slope_north;
  const GullySetting<T> of_octaves{
      shared::GullyStrength<T>(setting.model_slope, patches, setting.ice),
      shared::StonyRise<T>(setting.model_slope, patches)};
  for (int n = 0; n < shared::kGullyOctaves; ++n) AddGullies(sum, at, of_octaves, n, scale);
  return sum;
}

/// A layer's height above the model, and the variance of what the footprint removes, without
/// gullies.
template <typename T>
struct Layer {
  T height_m, variance;
};

/// Adds bands of strata, which dip by 10 degrees.
template <typename T>
void AddBands(Layer<T>& rock, const PlacedGround<T>& at, const T& craggy, const Noises<T>& noises,
              const T& slope, const ReliefScale& scale) {
  int height_m = shared::kBandHeight_m;
  for (int n = 0; n < shared::kBandOctaves; ++n, height_m /= 4) {
    const double missing = shared::MissingShare<double>(height_m, scale.spacing_m);
    if (missing <= 0.0) return;
    const T wave = T(height_m) / max(slope, T(0.7));
    const T share = shared::OctaveShare<T>(wave, T(scale.footprint_m));
    const T size = T(missing) * craggy;
    const T spread = shared::BandHeight<T>(T(0.7071 * height_m), T(1)) * size;
    rock.variance += shared::UnresolvedPart(share) * spread * spread;
    // Blocks are 1024 m, a multiple of the dip's period: the phase is continuous across them.
    const T dip = T(0.15625) * at.east_m - T(0.09375) * at.north_m;
    const T phase = (at.height_m + rock.height_m + dip + T(14) * noises.patches.value +
                     T(5) * noises.fine.value) /
                    T(height_m);
    rock.height_m += size * share * shared::BandHeight<T>(T(height_m), SineOf(phase));
  }
}

/// Adds crags, whose lattice leans with height so that cliffs have no vertical stripes.
template <typename T>
void AddCrags(Layer<T>& rock, const PlacedGround<T>& at, const T& craggy, const T& slope,
              const ReliefScale& scale) {
  int cell_m = shared::kCragCell_m;
  double lean_east = kLean, lean_north = 0.0;
  for (Bits n = 0; n < shared::kCragOctaves; ++n, cell_m /= 2) {
    const double missing = shared::MissingShare<double>(cell_m, scale.spacing_m);
    const double share = shared::OctaveShare<double>(cell_m, scale.footprint_m);
    const T size = T(missing) * craggy;
    const T spread =
        size * shared::CragHeight<T>(T(cell_m), T(kNoiseSize + kNoiseSizeSpread), slope);
    rock.variance += T(shared::UnresolvedPart(share)) * spread * spread;
    if (missing > 0.0 && share > 0.0) {
      const T up = at.height_m + rock.height_m;
      const T noise =
          NoiseAt(CellOf(at, cell_m, T(lean_east) * up, T(lean_north) * up), kCragSeed + n);
      rock.height_m += size * T(share) * shared::CragHeight<T>(T(cell_m), abs(noise), slope);
    }
    const double east = shared::NextLeanEast(lean_east, lean_north);
    lean_north = shared::NextLeanNorth(lean_east, lean_north);
    lean_east = east;
  }
}

/// The layers at a place before the highest is chosen.
template <typename T>
struct Layers {
  Layer<T> rock, debris, snow;
  T slope;           // mean, of model and gullies
  T slope_variance;  // of what the footprint removes
};

template <typename T>
Layers<T> LayersAt(const PlacedGround<T>& at, const Setting<T>& setting, const Gullies<T>& gullies,
                   const Noises<T>& noises, const ReliefScale& scale) {
  const T& patches = noises.patches.value;
  const T& fine = noises.fine.value;
  Layers<T> layers;
  // The slope across the fall line is normal, so that its square has the variance 2 v^2.
  const T square = gullies.slope_east * gullies.slope_east +
                   gullies.slope_north * gullies.slope_north + gullies.slope_variance + T(1e-8);
  layers.slope_variance = T(0.5) * gullies.slope_variance * gullies.slope_variance / square;
  layers.slope = sqrt(square - layers.slope_variance);
  const T& model_slope = setting.model_slope;
  const T craggy = shared::CraggyRise<T>(T(0.5) * (layers.slope + model_slope), patches);
  layers.rock = {gullies.rock, T(0)};
  AddBands(layers.rock, at, craggy, noises, layers.slope, scale);
  AddCrags(layers.rock, at, craggy, layers.slope, scale);
  const T thickness = shared::DebrisThickness<T>(setting.cold, model_slope, layers.slope,
                                                 setting.hollow, patches, fine);
  const T thickness_variance = T(2.56 * noises.patches.variance + 4.0 * noises.fine.variance) +
                               T(9.9) * layers.slope_variance;
  // The lesser one of thickness and limit.
  const T beyond = thickness - shared::LargestDebris(patches);
  const T spread = sqrt(thickness_variance + T(0.01));
  layers.debris = {gullies.soft + thickness - shared::MeanOfHigher<T>(beyond, spread),
                   shared::ShareAbove<T>(-beyond, spread) * thickness_variance};
  const T too_steep = shared::MeanOfHigher<T>(T(0.5) * (model_slope + layers.slope) - T(0.95),
                                              sqrt(T(0.25) * layers.slope_variance + T(0.0025)));
  const T snow = shared::SnowDepth<T>(setting.above_line + T(30) * fine, setting.ice,
                                      setting.hollow, gullies.valley, too_steep);
  layers.snow = {T(kSnowOnSoft) * gullies.soft + T(kSnowOnRock) * gullies.rock + snow,
                 T(2.1 * noises.patches.variance + 0.16 * noises.fine.variance) +
                     T(12.25) * layers.slope_variance};
  return layers;
}

/// Returns the root mean square of the difference of two layers.
/// @param gully_variance  of the difference by unresolved gullies [m^2].
template <typename T>
T SpreadOf(const Layer<T>& a, const Layer<T>& b, const T& gully_variance) {
  return sqrt(a.variance + b.variance + max(gully_variance, T(0)) +
              T(kFinestRelief_m * kFinestRelief_m));
}

/// The highest of the three layers.
template <typename T>
struct Surface {
  T bedrock_share, snow_share;  // the share of snow is that beside bedrock
  T height_m;
};

/// Rock is compared last, because its spread is the largest. Snow lies where rock is low: the mean
/// of what is correlated with rock, where rock is not the highest, is that of a truncated
/// distribution.
template <typename T>
Surface<T> SurfaceOf(const Layers<T>& layers, const Gullies<T>& gullies) {
  using Sum = typename GullyMoments<T>::Sum;
  const GullyMoments<T>& unresolved = gullies.unresolved;
  const Sum of_snow{T(kSnowOnRock), T(kSnowOnSoft - 1.0), T(kSnowInValleys)};  // less debris
  const T snow_spread =
      SpreadOf(layers.snow, layers.debris, unresolved.Covariance(of_snow, of_snow));
  const T snow_above = layers.snow.height_m - layers.debris.height_m;
  const T snow = shared::ShareAbove(snow_above, snow_spread);
  const Layer<T> cover{layers.debris.height_m + shared::MeanOfHigher(snow_above, snow_spread),
                       snow * layers.snow.variance + (T(1) - snow) * layers.debris.variance};
  const Sum of_rock{T(1) - snow * of_snow.rock, T(-1) - snow * of_snow.soft,
                    -snow * of_snow.valley};  // less cover
  const T rock_spread = SpreadOf(layers.rock, cover, unresolved.Covariance(of_rock, of_rock));
  const T rock_above = layers.rock.height_m - cover.height_m;
  const T bedrock = shared::ShareAbove(rock_above, rock_spread);
  const T shift =
      unresolved.Covariance(of_snow, of_rock) / rock_spread * shared::HazardOfShare(bedrock);
  return {bedrock, shared::ShareAbove<T>(snow_above + shift, snow_spread),
          cover.height_m + shared::MeanOfHigher(rock_above, rock_spread)};
}

/// Returns the shares of all surfaces.
template <typename T>
SurfaceShares<T> SharesOf(const Surface<T>& surface, const PlacedGround<T>& at,
                          const Setting<T>& setting, const Gullies<T>& gullies,
                          const Layers<T>& layers, const Noises<T>& noises,
                          const MountainCover& cover) {
  const T& patches = noises.patches.value;
  const T& fine = noises.fine.value;
  const double patch_variance = noises.patches.variance, fine_variance = noises.fine.variance;
  const T scree =
      shared::ShareAbove<T>(shared::ScreeTendency<T>(setting.cold, layers.slope, setting.hollow,
                                                     gullies.valley, patches, fine) -
                                T(0.5),
                            T(std::sqrt(0.0004 + 0.5625 * patch_variance + 0.64 * fine_variance)));
  const T treeless = shared::TreelessRise<T>(at.height_m + T(160) * patches, T(cover.tree_line_m));
  const T wood =
      shared::ShareAbove<T>(shared::WoodTendency<T>(treeless, setting.model_slope, patches, fine),
                            T(std::sqrt(0.0225 + 0.36 * patch_variance + 0.25 * fine_variance)));
  const T covered = T(1) - surface.bedrock_share;
  const T soil = covered * (T(1) - surface.snow_share);
  return {surface.bedrock_share, soil * scree * (T(1) - wood),
          soil * (T(1) - scree) * (T(1) - wood), soil * wood, covered * surface.snow_share};
}

/// Height above the model and shares, for any number type.
template <typename T>
struct Detail {
  T height_m;
  SurfaceShares<T> shares;
};

template <typename T>
Detail<T> DetailAt(const PlacedGround<T>& at, const MountainCover& cover,
                   const ReliefScale& scale) {
  const Noises<T> noises = NoisesAt(at, scale.footprint_m);
  const Setting<T> setting = SettingAt(at, cover, noises.patches.value);
  const Gullies<T> gullies = GulliesAt(at, setting, noises.patches.value, scale);
  const Layers<T> layers = LayersAt(at, setting, gullies, noises, scale);
  const Surface<T> surface = SurfaceOf(layers, gullies);
  const T& rock = surface.bedrock_share;
  // A fine model has the thickness of layers itself.
  const double missing = shared::MissingShare<double>(shared::kRaggedCell_m, scale.spacing_m);
  const T forms = rock * layers.rock.height_m + (T(1) - rock) * gullies.soft;
  const T height = T(missing) * surface.height_m + T(1.0 - missing) * forms;
  return {height, SharesOf(surface, at, setting, gullies, layers, noises, cover)};
}

template <typename Real>
PlacedGround<WithGradient<Real>> WithSlopes(const BlockPlace<Real>& place,
                                            const ModelAt<Real>& model) {
  return {place.east_block,
          place.north_block,
          {place.east_m, 1, 0},
          {place.north_m, 0, 1},
          {model.height_m, model.slope_east, model.slope_north},
          {model.slope_east, model.bend_east_per_m, model.bend_across_per_m},
          {model.slope_north, model.bend_across_per_m, model.bend_north_per_m},
          WithGradient<Real>(model.bend_east_per_m + model.bend_north_per_m)};
}

void CheckScale(const ReliefScale& scale) {
  ALPENGLOW_ENSURE(scale.spacing_m, >, 0.0);
  ALPENGLOW_ENSURE(scale.footprint_m, >, 0.0);
}

}  // namespace

template <typename Real>
BlockPlace<Real> BlockPlaceOf(double east_m, double north_m) {
  constexpr double kBlock = shared::kBlock_m;
  const double east = std::floor(east_m / kBlock), north = std::floor(north_m / kBlock);
  return {static_cast<std::int32_t>(east), static_cast<std::int32_t>(north),
          static_cast<Real>(east_m - kBlock * east), static_cast<Real>(north_m - kBlock * north)};
}

template <typename Real>
Relief<Real> ReliefAt(const BlockPlace<Real>& place, const ModelAt<Real>& model,
                      const MountainCover& cover, const ReliefScale& scale) {
  CheckScale(scale);
  const PlacedGround<Real> at{place.east_block,  place.north_block,
                              place.east_m,      place.north_m,
                              model.height_m,    model.slope_east,
                              model.slope_north, model.bend_east_per_m + model.bend_north_per_m};
  const Detail<Real> detail = DetailAt(at, cover, scale);
  return {detail.height_m, model.slope_east, model.slope_north, detail.shares};
}

template <typename Real>
Relief<Real> SlopedReliefAt(const BlockPlace<Real>& place, const ModelAt<Real>& model,
                            const MountainCover& cover, const ReliefScale& scale) {
  CheckScale(scale);
  const auto detail = DetailAt(WithSlopes(place, model), cover, scale);
  const auto& shares = detail.shares;
  return {detail.height_m.value,
          model.slope_east + detail.height_m.east,
          model.slope_north + detail.height_m.north,
          {shares.bedrock.value, shares.scree.value, shares.meadow.value, shares.forest.value,
           shares.snow.value}};
}

template BlockPlace<float> BlockPlaceOf(double, double);
template BlockPlace<double> BlockPlaceOf(double, double);
template Relief<float> ReliefAt(const BlockPlace<float>&, const ModelAt<float>&,
                                const MountainCover&, const ReliefScale&);
template Relief<double> ReliefAt(const BlockPlace<double>&, const ModelAt<double>&,
                                 const MountainCover&, const ReliefScale&);
template Relief<float> SlopedReliefAt(const BlockPlace<float>&, const ModelAt<float>&,
                                      const MountainCover&, const ReliefScale&);
template Relief<double> SlopedReliefAt(const BlockPlace<double>&, const ModelAt<double>&,
                                       const MountainCover&, const ReliefScale&);

}  // namespace alpenglow::renderer
