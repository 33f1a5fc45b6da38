// SPDX-License-Identifier: MIT
/// @file
/// Fields of clouds and the light in them: of all orders of scattering, by a fast method, and by
/// path tracing, which has no bias and states its standard error.
///
/// These classes are in the library alpenglow::renderer. They compute clouds alone, in one band of
/// wavelengths and without the air around them; Scene renders clouds in the light of a sky.
///
/// The frame is flat: x east, y north, z up from the plane of altitude 0, which does not curve. All
/// light is linear in three sources: the sun's beam, a uniform sky above, and ground below that
/// emits uniformly beside what it reflects. With the irradiance E of the sun across its beam and the
/// radiances L_sky and L_ground, a ray has the radiance
///
///     L = E sun + L_sky sky + L_ground ground
///
/// All functions throw InputError that names the value and its range for values that are not finite
/// or out of range, and for directions of length 0. Points lie within 1e8 m of the origin. Results
/// do not depend on the number of processors.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <alpenglow/export.h>
#include <alpenglow/geometry.h>

namespace ALPENGLOW_EXPORT alpenglow {

/// The genus of a layer of clouds.
enum class CloudGenus {
  kCumulus,        ///< heaps of droplets over warm ground
  kStratocumulus,  ///< a low deck of droplets
  kAltocumulus,    ///< small patches of droplets at middle heights
  kCirrus,         ///< streaks of ice crystals
  kStratus,        ///< a low layer of droplets that covers the whole sky evenly
  kCirrostratus    ///< a high layer of ice crystals, likewise
};

/// A layer of clouds of one genus. Empty values are the usual ones of the genus:
///
///     genus          cover  base    depth   droplets    ice        crystals  wind
///     cumulus        0.3    1200 m  1500 m  250 / cm^3  -          -         6 m/s
///     stratocumulus  0.8     900 m   350 m  100 / cm^3  -          -         8 m/s
///     altocumulus    0.6    4000 m   200 m   80 / cm^3  -          -         12 m/s
///     cirrus         0.4    8000 m  1200 m  -           40 mg/m^3  35 um     25 m/s
///     stratus        1       500 m   600 m  200 / cm^3  -          -         5 m/s
///     cirrostratus   1      7500 m  1000 m  -           15 mg/m^3  35 um     25 m/s
struct CloudLayer {
  CloudGenus genus = CloudGenus::kCumulus;  ///< see there
  /// Fraction of the sky with clouds, seen vertically, in [0, 1]; of cumulus in [0, 0.8]. Stratus and
  /// cirrostratus have 1.
  std::optional<double> cover = {};
  /// Altitude, in [0, 11000]; of clouds of ice in [0, 15000].
  std::optional<double> base_m = {};
  /// From the base to the highest tops, in [100, 4000].
  std::optional<double> depth_m = {};
  /// Number of droplets, in [1, 5000]; clouds of ice have none.
  std::optional<double> droplets_per_cm3 = {};
  /// Mass of ice, in [1, 1000]; of clouds of ice alone.
  std::optional<double> ice_mg_per_m3 = {};
  /// Effective radius of crystals, in [5, 200]; of clouds of ice alone.
  std::optional<double> crystal_radius_um = {};
  /// Vertical optical depth, in [0, 1000]; of stratus and cirrostratus alone.
  std::optional<double> optical_depth = {};
  /// Layers with the same options and another seed have other clouds, but for stratus and
  /// cirrostratus.
  std::uint32_t seed = 1;
  /// Wind to the east, in [-150, 150]; usually that of the genus.
  std::optional<double> wind_east_m_per_s = {};
  double wind_north_m_per_s = 0.0;  ///< wind to the north, in [-150, 150]
  /// The field repeats to the east and to the north after this length, a multiple of 2560 in
  /// [2560, 81920]. Stratus and cirrostratus have no use for it.
  double period_m = 20480.0;
};

/// The particles of a grid of clouds.
enum class CloudParticles {
  kDroplets,  ///< water spheres by Lorenz-Mie theory, by effective radius, with fog bow and glory
  kIce,       ///< ice crystals by geometric optics, by effective radius, with their halos
  kHenyeyGreenstein  ///< one Henyey-Greenstein phase function for all
};

/// A field of clouds as samples on a regular grid. Between samples the extinction is trilinear. Grids
/// should end in clear air: where cloud reaches their last samples, the fast method may miss the last
/// 20 m of it.
struct CloudGrid {
  /// Numbers of samples to the east, to the north and upwards; each in [2, 8192]. There may be 2e8
  /// samples, and as many as fit into the memory of the machine (kCloudGridBytes each).
  std::array<int, 3> samples{};
  /// Distances between samples to the east, to the north and upwards [m]; each in [0.001, 1e5].
  std::array<double, 3> spacing_m{};
  LocalPoint first;  ///< place of the first sample; each coordinate in [-1e8, 1e8]
  /// Extinction of each sample [1/m], in [0, 1e6]. The first samples differ by their place to the
  /// east, the last ones by their altitude: sample (i, j, k) is number (k * ny + j) * nx + i.
  std::vector<float> extinction_per_m;
  /// Effective radius of each sample [um], in (0, 1e4]; empty: 10 everywhere.
  std::vector<float> effective_radius_um;
  double single_scattering_albedo = 1.0;                 ///< in [0, 1]
  CloudParticles particles = CloudParticles::kDroplets;  ///< see there
  double g = 0.85;  ///< asymmetry parameter of kHenyeyGreenstein, in [0.001, 0.99]
  /// The field repeats after its samples to the east and to the north, one spacing behind the last
  /// ones. Otherwise it ends at the last ones.
  bool is_periodic = false;
};

/// Memory for each sample of a grid while its field is made [bytes].
inline constexpr double kCloudGridBytes = 64.0;

/// A field of clouds. Immutable; copies share their memory. All functions may be called from several
/// threads.
class CloudField {
 public:
  /// Makes a layer at a time. The field is byte-identical for the same options and time, on every
  /// machine. With time the wind carries it, and clouds grow and decay. Its cover is within 0.05 of
  /// that of the layer if the period is 5120 m or more (asserted by
  /// cloud_generator_test). Throws InputError, too, if the field may need more memory than the
  /// machine has.
  /// @param layer   see there.
  /// @param time_s  since any moment, in [0, 1e7].
  explicit CloudField(const CloudLayer& layer, double time_s = 0.0);
  /// Stores a grid. Throws InputError, too, unless there is a value of each list for each sample.
  explicit CloudField(const CloudGrid& grid);

  /// Returns whether the field repeats to the east and to the north.
  [[nodiscard]] bool is_periodic() const;
  /// Returns the lengths to the east and to the north after which the field repeats or ends [m].
  [[nodiscard]] std::array<double, 2> size_m() const;
  /// Returns an altitude below all clouds: that of the lowest block of 8 samples with or near cloud.
  [[nodiscard]] double base_m() const;
  /// Returns an altitude above all clouds, likewise.
  [[nodiscard]] double top_m() const;
  /// Returns the extinction at a point [1/m]. At a sample of a grid it is that of the sample.
  [[nodiscard]] double Extinction_per_m(const LocalPoint& point) const;
  /// Returns the effective radius of droplets or crystals at a point [um].
  [[nodiscard]] double EffectiveRadius_um(const LocalPoint& point) const;
  /// Returns the memory of the field [bytes].
  [[nodiscard]] std::size_t bytes() const;

 private:
  friend class CloudLight;
  friend class CloudPaths;
  struct State;
  std::shared_ptr<const State> state_;
};

/// A ray from an eye.
struct CloudRay {
  LocalPoint eye;  ///< not below the ground
  Direction view;  ///< of any length but 0
  /// Length of the ray, >= 0; rays end after 1e6 m in any case.
  double length_m = std::numeric_limits<double>::infinity();
};

/// The ground below a field, and the wavelength of its light.
struct CloudSurroundings {
  /// Wavelength of the phase functions of droplets and ice, in [300, 1000].
  double wavelength_nm = 550.0;
  double ground_albedo = 0.0;  ///< of a Lambertian ground, in [0, 1]
  double ground_m = 0.0;       ///< altitude of the ground, in [-1e5, CloudField::base_m()]
  /// Radius of the planet, in [1e5, 1e9]. Beams of a sun below 3 degrees curve over it, in the flat
  /// frame: the sun is higher by 1/radius for each metre towards it. Its direction is that over the
  /// origin. Clouds further away than 60 km shade others less and less, and none beyond 180 km do; high
  /// clouds shade up to where a sun of 3 degrees is seen past them, and none 120 km further. The ground
  /// does not hide the sun.
  double planet_radius_m = 6.371e6;
};

/// Light that clouds scatter into a ray, and what they leave of the light behind it.
struct CloudRayLight {
  double sun = 0.0;     ///< for unit irradiance across the sun's beam [1/sr]
  double sky = 0.0;     ///< for unit radiance of the sky [1]
  double ground = 0.0;  ///< for unit radiance that the ground emits [1]
  /// Fraction of light behind the clouds that arrives without scattering: of sun, stars and edges.
  double transmittance = 1.0;
  /// Fraction of light of wide sources behind the clouds: with light that droplets turn by a few
  /// degrees. Not below `transmittance`, but for rounding.
  double wide_transmittance = 1.0;
  /// Mean distance of the scattered light [m]; 0 without clouds.
  double mean_distance_m = 0.0;
};

/// Radiance of a ray to the sky or to the ground, with what is behind the clouds.
struct CloudRadiance {
  double sun = 0.0;  ///< for unit irradiance across the sun's beam, without the sun's disk [1/sr]
  double sky = 0.0;  ///< for unit radiance of the sky [1]
  double ground = 0.0;  ///< for unit radiance that the ground emits [1]
};

/// A mean over random paths.
struct CloudEstimate {
  double value = 0.0;           ///< without bias
  double standard_error = 0.0;  ///< from the scatter of at least 16 independent batches of paths
};

/// CloudRadiance by path tracing.
struct TracedCloudRadiance {
  CloudEstimate sun;            ///< see CloudRadiance
  CloudEstimate sky;            ///< see CloudRadiance
  CloudEstimate ground;         ///< see CloudRadiance
  CloudEstimate transmittance;  ///< fraction of light behind that arrives without scattering
  std::size_t paths = 0;        ///< the number of paths
};

/// Fluxes of sunlight through horizontal planes above and below the clouds, relative to the sun's
/// flux through the plane above [1].
struct CloudFluxes {
  double up_at_top = 0.0;  ///< upwards through the plane of CloudField::top_m()
  double direct_at_base =
      0.0;  ///< downwards through that of base_m(), neither scattered nor reflected
  double down_at_base = 0.0;  ///< all other light downwards through that of base_m()
};

/// CloudFluxes by path tracing.
struct TracedCloudFluxes {
  CloudEstimate up_at_top;       ///< see CloudFluxes
  CloudEstimate direct_at_base;  ///< see CloudFluxes
  CloudEstimate down_at_base;    ///< see CloudFluxes
};

/// Fluxes of columns and their mean.
struct CloudColumns {
  /// The columns: the first ones differ by their place to the east. They begin at the first sample
  /// of a grid, or at the origin that the wind has moved.
  std::vector<TracedCloudFluxes> column;
  TracedCloudFluxes mean;   ///< over all columns
  std::size_t photons = 0;  ///< the number of paths
};

/// Options of the fast method.
struct CloudLightOptions {
  CloudSurroundings surroundings;  ///< see there
  /// Side of the cells of light of higher orders, in [20, 2500]. Empty: 40 for fields of at most 8
  /// km by 8 km, and 80 for larger ones. Errors below hold for both.
  std::optional<double> cell_m = {};
  /// Multiplies light of higher orders by a factor that is fitted to 40000 traced paths, which
  /// reduces the bias of sunlight. Errors below hold with it.
  bool has_fitted_factor = true;
};

/// The light of a field under one sun by the fast method: light of first collisions and of the
/// forward peak in closed form, light of higher orders from its moments on coarse cells.
/// Immutable; copies share their memory. All functions may be called from several threads.
///
/// Errors of rays through cumulus with an optical depth above 0.3, relative to their radiance (at
/// least to a twentieth of the mean): below 25 % (rms) with a mean within 5 % for the part of the
/// sun, and below 15 % with a mean within 3 % for that of the sky, at suns of 12 and 35 degrees
/// (asserted by cloud_light_test).
class CloudLight {
 public:
  /// Solves for the light, on all processors. This is slow compared with all other functions.
  /// Throws InputError, too, for a field without memory for its light.
  /// @param field    its copy is kept.
  /// @param to_sun   direction to the sun, at most 4 degrees below the horizontal plane.
  /// @param options  see there.
  CloudLight(const CloudField& field, const Direction& to_sun,
             const CloudLightOptions& options = {});

  /// Returns the light of the same field under another sun. It shares the light of sky and ground,
  /// and equals that of a new solution.
  /// @param to_sun   as for the constructor.
  [[nodiscard]] CloudLight WithSun(const Direction& to_sun) const;

  /// Returns the light that clouds scatter into a ray, for a picture that has its own sky and ground
  /// behind them. Clouds get the mean light of the ground.
  [[nodiscard]] CloudRayLight Scattered(const CloudRay& ray) const;
  /// Returns Scattered() of many rays, computed on all processors.
  [[nodiscard]] std::vector<CloudRayLight> Scattered(std::span<const CloudRay> rays) const;

  /// Returns the radiance of a ray to the sky or to the ground, which CloudPaths::Radiance()
  /// estimates. Throws InputError for a ray of finite length. The ground at its end is in the sun's
  /// own shadow of clouds, and otherwise in mean light.
  [[nodiscard]] CloudRadiance Radiance(const CloudRay& ray) const;

  /// Returns the fraction of sunlight that clouds leave at a point in clear air or on the ground.
  [[nodiscard]] double SunTransmittance(const LocalPoint& point) const;

  /// Returns the fluxes of columns of equal size, the first ones along the east, on all processors.
  /// Throws InputError, too, for a sun below 3 degrees.
  /// Means over a field of cumulus are within 0.03 of those of CloudPaths at a sun of 37 degrees
  /// (asserted by clouds_api_test and cloud_light_fluxes_test); in other fields up to 8 % of the
  /// light upwards was missing.
  /// @param columns          numbers to the east and to the north, each in [1, 4096].
  /// @param rays_per_column  rays through each of both planes, in [1, 10000000].
  [[nodiscard]] std::vector<CloudFluxes> Fluxes(const std::array<int, 2>& columns = {1, 1},
                                                int rays_per_column = 4096) const;

  /// Returns the memory of the light, without the field [bytes].
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct State;
  explicit CloudLight(std::shared_ptr<const State> state);
  std::shared_ptr<const State> state_;
};

/// Number of random paths and their sequence.
struct CloudPathOptions {
  std::uint64_t seed = 1;  ///< of the random numbers
  /// Paths or photons, in [1, 1e10]. The number is rounded up to batches of 251, of which there are
  /// at least 16 for a ray and 32 for fluxes.
  std::size_t paths = 4016;
  /// Largest number of scatterings and reflections, >= 1; empty: unlimited.
  std::optional<int> max_order = {};
};

/// The light of a field under one sun by path tracing. It needs no preparation, and has no bias unless
/// this is allowed (WithSimilarity).
/// Immutable; copies share their memory. All functions may be called from several threads; each uses
/// all processors.
class CloudPaths {
 public:
  /// Keeps a copy of the field.
  /// @param field         see there.
  /// @param to_sun        direction to the sun, at most 4 degrees below the horizontal plane.
  /// @param surroundings  see there.
  CloudPaths(const CloudField& field, const Direction& to_sun,
             const CloudSurroundings& surroundings = {});

  /// Returns the light by shorter paths: after some collisions the phase function is replaced by a
  /// wide lobe, and the extinction is lowered so that the light is similar. It suits fields that
  /// change in every frame, for which CloudLight would be solved anew. Throws InputError, too,
  /// for a grid with g = 0.
  /// After 8 collisions mean sunlight is within 2 % of that of paths without bias for suns from 12
  /// degrees on, and within 40 % at 1 degree (asserted by cloud_path_tracer_test).
  /// @param collisions  before, in [1, 1000].
  [[nodiscard]] CloudPaths WithSimilarity(int collisions = 8) const;

  /// Returns the radiance of a ray to the sky or to the ground. Throws InputError for a ray of finite
  /// length.
  [[nodiscard]] TracedCloudRadiance Radiance(const CloudRay& ray,
                                             const CloudPathOptions& options = {}) const;

  /// Returns the fluxes of columns of equal size. Light may enter an open field from the side. Throws
  /// InputError, too, for a sun below 3 degrees.
  /// @param columns  numbers to the east and to the north, each in [1, 4096] and at most 262144
  ///   together.
  /// @param options  see there.
  [[nodiscard]] CloudColumns Fluxes(const std::array<int, 2>& columns = {1, 1},
                                    const CloudPathOptions& options = {.paths = 262144}) const;

 private:
  struct State;
  explicit CloudPaths(std::shared_ptr<const State> state);
  std::shared_ptr<const State> state_;
};

}  // namespace alpenglow
