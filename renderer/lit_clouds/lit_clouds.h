// SPDX-License-Identifier: MIT
// The light of a scene's clouds under one sun or moon: along rays, as shadows, and on the ground.
//
// Fields of clouds have grey solutions for unit sources (CloudLight). Here the sources get their
// colours: the sun's beam in the air at the cloud, the mean skylight above a layer, and the mean light
// of ground and lower layers below it (layer_exchange.h). Along a ray in chord i, with the
// transmittance T of nearer clouds and A of the air,
//
//   L += T_i A (E_beam sun_i + L_sky sky_i + L_ground ground_i)
//
// The colours of fog bow, glory, corona and halo are a factor on sun_i (cloud_colours.h).
//
// Skylight is found above all clouds, and light from below on the ground. The air between these and a
// cloud adds what it adds in a clear sky, times the mean fraction of light that reaches it. If all
// layers are the same at every place, they are solved together with the air instead, in every direction
// (layered_air.h); below a sun of 3 degrees that goes over into what follows. On the
// ground that is the fraction of the beam with what clouds turn by a few degrees: air sends light of the
// beam down, but of diffuse light it takes away nearly as much as it adds. Fields of
// single clouds take more light from the bright sky near the horizon than from the zenith. Their sky
// has the mean radiance of a clear one along rays through the field, weighted by what it takes away.
//
// Clouds stand in the air as screens at the mean distance of their light, which the air in front dims
// and veils. Light that the air scatters more than once is that of a clear sky times
//
//   (T (I' - 2 u') + 2 (d - T d') + 2 u) / I'
//
// with the mean fluxes d down, without light that is turned by a few degrees and follows the beam
// (cloud_shadow.h), and u up at the interface below, between or above layers, the fraction T
// of skylight there, and without clouds the fluxes d' and u' and the diffuse radiance integrated over
// all directions I'. Light of clouds and ground counts as even over a hemisphere, and the directions
// of the light that is scattered are those of the clear sky.
//
// A sun below 3 degrees stands over a round planet: its beams are followed for 180 km or more,
// clouds see it longer than the ground, and light from below lights them. Light of higher orders is
// that of the sun's height over the place of the scene.
//
// A mountain takes away all light of the sun where its shadow falls on a screen, also that of higher
// orders, which comes from a few hundred metres around.
//
// Lamps light clouds from below by the irradiance of a level surface there (LampsOnClouds).
//
// Not modelled:
//
//   - skylight and light from the ground that differ with direction or place, where they light clouds,
//     and air beside single clouds;
//   - lamplight that the ground reflects to clouds, light of towns that clouds and ground send to and
//     fro, where it lights clouds, and the air between clouds and towns of light pollution (NightAlong);
//   - the light of the night sky that clouds keep from the ground;
//   - light that passes within clouds from their sunlit parts into those in the shadow of a mountain,
//     and the shadow's edge within one screen;
//   - clouds further away than that towards a low sun (LowSunOver).
#pragma once

#include <cstddef>
#include <functional>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "lut/multiple_scattering/solved_air.h"
#include "renderer/illumination/aerial_perspective.h"
#include "renderer/illumination/distant_light.h"
#include "renderer/lamps/lamp_light.h"
#include "renderer/lit_clouds/cloud_chords.h"
#include "renderer/lit_clouds/cloud_colours.h"
#include "renderer/lit_clouds/cloud_layers.h"
#include "renderer/lit_clouds/cloud_shadow.h"
#include "renderer/lit_clouds/layer_exchange.h"
#include "renderer/lit_clouds/layered_air.h"
#include "renderer/lit_clouds/mirrored_clouds.h"
#include "renderer/lit_clouds/shared_cloud_light.h"
#include "renderer/media/lit_medium.h"
#include "renderer/surface/scene_geometry.h"
#include "renderer/surface/terrain_sunlight.h"

namespace alpenglow::renderer {

/// Clouds on one chord of a ray, or on several at nearly the same distance, as a screen.
struct CloudScreen {
  double distance_m;    // mean distance of the light
  float transmittance;  // of this screen, with the light in the forward peak
  Spectrum radiance;    // without air and nearer screens, per unit solar irradiance [1/sr]
  float ground = 0.0F;  // without air and nearer screens, for unit radiance from below
};

/// Clouds along a ray.
struct CloudsOnRay {
  std::vector<CloudScreen> screens;  // in order
  float unscattered = 1.0F;          // transmittance of all for light that is not scattered at all

  /// Adds a screen behind all others. It becomes a part of the last one if their distances differ by
  /// less than kMostJoined, because the air up to a screen costs as much as the air of a whole ray.
  /// The air between both is then that of their mean distance, to second order in its optical depth.
  void Add(const CloudScreen& screen);
  static constexpr double kMostJoined = 1.2;

  /// Returns the transmittance of all screens, with the light in the forward peak.
  [[nodiscard]] float transmittance() const {
    return TransmittanceTo(std::numeric_limits<double>::infinity());
  }
  /// Returns the distances of the screens, weighted by the light that they take away [m].
  [[nodiscard]] float WeightedDistance_m() const;
  /// Returns the transmittance of the screens up to a distance, with the light in the forward peak.
  [[nodiscard]] float TransmittanceTo(double distance_m) const;
  /// Returns `unscattered` relative to the transmittance with the forward peak: for the disks of sun
  /// and moon. It is at most 1.
  [[nodiscard]] float DiskLeft() const;
  /// Returns light that increases along the ray, behind the screens.
  /// @param whole  of the whole ray. @param upto  returns the light up to a distance; it is called
  ///     for each screen in order.
  template <typename Upto>
  [[nodiscard]] Spectrum Dimmed(const Spectrum& whole, const Upto& upto) const;
};

template <typename Upto>
Spectrum CloudsOnRay::Dimmed(const Spectrum& whole, const Upto& upto) const {
  Spectrum sum(whole.size()), before(whole.size());
  float left = 1.0F;
  for (const CloudScreen& screen : screens) {
    const Spectrum reached = upto(screen.distance_m);
    sum = sum + left * (reached + -1.0F * before);
    before = reached;
    left *= screen.transmittance;
  }
  return sum + left * (whole + -1.0F * before);
}

/// Returns the light of lamps that clouds on a ray scatter to its origin [W m^-2 sr^-1 nm^-1]. The
/// irradiance of a level surface at a cloud, which looks down, counts as if it came evenly from below.
/// @param left  returns the transmittance of air and other media up to a distance.
[[nodiscard]] Spectrum LampsOnClouds(const CloudsOnRay& clouds, const LampLight& lamps,
                                     const SceneGeometry& geometry, const glm::dvec3& origin,
                                     const glm::dvec3& direction,
                                     const std::function<Spectrum(double)>& left);

/// Radiance J of an infinitely long path at night (night_light.h) [W m^-2 sr^-1 nm^-1].
struct NightScattered {
  Spectrum all;
  Spectrum towns;  // the part of light pollution: ground around has twice this radiance
};

/// Returns the light of the night that air, media and clouds along a ray scatter to its origin
/// [W m^-2 sr^-1 nm^-1]: (1 - T) J without clouds. Clouds, too, send J instead of what they hide, but
/// for the light of towns, which they have from below.
/// @param whole  transmittance of air, media and clouds. @param left  as in LampsOnClouds().
[[nodiscard]] Spectrum NightAlong(const CloudsOnRay& clouds, const NightScattered& night,
                                  const Spectrum& whole,
                                  const std::function<Spectrum(double)>& left);

/// How a picture sees clouds.
struct CloudsInPicture {
  CloudLightMethod method = CloudLightMethod::kFast;  // of light along rays
  /// Rays of a picture share the noise of the hybrid method (shared_cloud_light.h), with
  /// LitClouds::kSharedPaths paths each. Nothing: every ray has the paths of the options.
  std::optional<PixelRays> pixels = std::nullopt;
  /// The light that mountains let through to clouds; null: all.
  std::shared_ptr<const TerrainSunlight> past_terrain = nullptr;
  /// It is true if bows, glories, coronas and halos have their colours.
  bool has_colours = false;
  /// The eye for which ground mirrors clouds. Nothing: mirrored rays are followed one by one.
  std::optional<MirrorEye> mirror = std::nullopt;
};

/// Immutable; safe to use from many threads. Refers to geometry and air.
class LitClouds {
 public:
  /// @param clouds  solved for the light.
  LitClouds(std::shared_ptr<const SolvedClouds> clouds, const SceneGeometry& geometry,
            const SolvedAir& air, const DistantLight& light, CloudsInPicture view = {});
  LitClouds(const LitClouds&) = delete;
  LitClouds& operator=(const LitClouds&) = delete;

  static constexpr int kSharedPaths = 16;

  /// Returns the clouds on a ray. @param length_m  may be infinite.
  [[nodiscard]] CloudsOnRay Along(const glm::dvec3& origin, const glm::dvec3& direction,
                                  double length_m) const;

  /// Returns the light of the sky that arrives at a point of a mirror, with clouds in front of a part of
  /// it, per unit solar irradiance [1/sr]. Clouds have the light of the fast method.
  /// @param clear  light of the clear sky. The air before a cloud sends as large a part of it as it has
  ///     of the loss 1 - T of the whole way.
  [[nodiscard]] Spectrum OverSky(const glm::dvec3& point, const glm::dvec3& direction,
                                 const Spectrum& clear) const;

  [[nodiscard]] const CloudShadow& shadow() const { return *shadow_; }

  /// Returns the skylight on a surface: layers above it dim the light of the clear sky and add
  /// sunlight that they scatter, which differs from place to place as on level ground at the place of
  /// the scene. Light that goes to and fro between ground and layers has its mean everywhere.
  /// @param point  in the frame of the scene. @param cos_up  between the surface's normal and the
  ///     vertical. @param above  what arrives from above all layers.
  [[nodiscard]] SkyThroughMedia SkyOnSurface(const glm::dvec3& point, double cos_up,
                                             SkyThroughMedia above) const;

  /// Radiances per unit solar irradiance [1/sr].
  struct LightAround {
    Spectrum sky, ground;
  };
  /// Returns the mean light from above and from below in a layer. @param point  in it.
  [[nodiscard]] LightAround AroundLayer(std::size_t layer, const glm::dvec3& point) const;

  /// Returns the diffuse light downwards at an altitude for unit diffuse light that the ground emits,
  /// with what goes to and fro between ground and layers. It is a mean over the fields without air.
  [[nodiscard]] const Spectrum& SentBackAt(double altitude_m) const;

  /// Mean light below, between or above layers.
  struct InterfaceLight {
    double low_m;      // altitude from which on it holds; -infinity below the lowest layer
    float air_left;    // fraction of the light that the air below sends in a clear sky
    Spectrum added;    // irradiance of a level surface, per unit solar irradiance
    Spectrum diffuse;  // factor on light that the air scatters more than once
    /// The same along rays of WayOfNode(), azimuths of an elevation after one another. If it is empty, it is the
    /// same in all directions.
    std::vector<Spectrum> diffuse_towards;

    static constexpr int kElevations = 16, kAzimuths = 9;
    /// Returns the way of the light along a ray. With its sine s of elevation, sign(s) sqrt|s| has even
    /// steps from -1 to 1; azimuths from the light go from 0 to pi.
    [[nodiscard]] static LightWay WayOfNode(int elevation, int azimuth);
  };
  /// Returns it from the ground up: one more than there are layers.
  [[nodiscard]] std::vector<InterfaceLight> Interfaces() const;

  /// Returns the mean light at an altitude, for media there.
  [[nodiscard]] LightPastClouds MeanAt(double altitude_m) const;

  /// Returns the diffuse light in the air along a ray, below, between and above layers, relative to
  /// that of a clear sky.
  [[nodiscard]] std::vector<DiffuseStretch> DiffuseInAir(const glm::dvec3& origin,
                                                         const glm::dvec3& direction) const;

 private:
  /// Returns whether another layer is at some of the altitudes of a layer.
  [[nodiscard]] bool SharesAltitudes(std::size_t layer) const;
  /// Returns the clouds on a ray, from the nearest on, as long as they are seen.
  /// @param by_paths  whether the light is that by the method of choice.
  [[nodiscard]] std::vector<CloudRayPart> PartsOf(const glm::dvec3& origin,
                                                  const PixelRays::Ray& ray, bool by_paths) const;
  [[nodiscard]] CloudsOnRay CloudsOf(const std::vector<CloudRayPart>& parts,
                                     const glm::dvec3& origin, const glm::dvec3& direction) const;
  /// Returns what clouds change in the light of a clear sky along a ray.
  [[nodiscard]] CloudChange ChangeAlong(const glm::dvec3& point, const glm::dvec3& direction) const;
  /// A part of a ray, as distances.
  struct Distances {
    double begin_m, end_m;
  };
  /// Returns the factor of a DiffuseStretch.
  [[nodiscard]] Spectrum DiffuseOn(const Distances& part, const glm::dvec3& origin,
                                   const glm::dvec3& direction) const;
  void FindExchange();
  /// Solves plane-parallel layers together with the air, if all are and the sun is up.
  void FindLayered();
  /// Finds the light that layers turn by a few degrees, at each interface.
  void FindTurned();
  /// Returns the fluxes of each layer in beams. What a layer takes away from a clear sky in addition to
  /// that from an even one counts as if it scattered a beam.
  /// @param sky  irradiance of a clear sky. @param band  of the beams.
  [[nodiscard]] std::vector<CloudLayerFluxes> LitBy(const std::vector<Spectrum>& beams, double sky,
                                                    std::size_t band) const;
  /// Returns the mean beam on a plane behind other layers, per unit solar irradiance.
  /// @param of_layer  which does not dim the beam; the number of layers: none.
  [[nodiscard]] Spectrum MeanBeam(double altitude_m, std::size_t of_layer) const;
  /// Returns the mean fraction of the beam that other layers leave on a plane.
  [[nodiscard]] double MeanBeamLeft(double altitude_m, std::size_t of_layer) const;
  /// Returns the same of all layers with the light that they turn by a few degrees.
  [[nodiscard]] double MeanScaledLeft(double altitude_m) const;
  /// Returns an altitude at an interface.
  [[nodiscard]] double AltitudeOf(std::size_t interface) const;
  /// Returns the altitude at which a layer takes the beam for its light at an altitude.
  [[nodiscard]] double BeamAltitudeOf(std::size_t layer, double altitude_m) const;
  [[nodiscard]] CloudScreen Screen(const CloudRayPart& grey, const glm::dvec3& point) const;
  /// Returns the mean radiance of a clear sky along rays through a layer, weighted by what the layer
  /// takes away, relative to that of an even sky with the same irradiance of a level surface.
  [[nodiscard]] Spectrum SkyOnClouds(std::size_t layer) const;
  /// @param sun  at a place in the layer.
  [[nodiscard]] LightAround AroundLayer(std::size_t layer, const LocalLight& sun) const;
  /// Returns what layers add to the light of the sky on level ground, where they leave air_left_ of it.
  [[nodiscard]] Spectrum AddedAt(std::size_t interface, double altitude_m) const;
  /// Returns a mean of light by exchange and of light that is solved together with the air.
  [[nodiscard]] Spectrum Blended(const Spectrum& by_exchange, const Spectrum& together) const;
  /// Returns the transmittance to the light of the layers other than one.
  [[nodiscard]] double PastOthers(std::size_t layer, const glm::dvec3& flat_point) const;

  [[nodiscard]] std::size_t layers() const { return clouds_->light.size(); }
  [[nodiscard]] const CloudLight& Layer(std::size_t layer) const { return clouds_->light[layer]; }
  /// Returns SkyOnSurface of level ground below an interface.
  [[nodiscard]] SkyThroughMedia SkyAt(std::size_t interface, const glm::dvec3& point) const;
  /// Returns the altitudes of a layer.
  [[nodiscard]] AltitudeRange RangeOf(std::size_t layer) const;
  /// Returns the altitude that parts the light below a layer from that above it.
  [[nodiscard]] double MiddleOf(std::size_t layer) const;
  /// Returns the number of the interface at an altitude.
  [[nodiscard]] std::size_t InterfaceAt(double altitude_m) const;

  std::shared_ptr<const SolvedClouds> clouds_;
  std::vector<CloudLight> along_rays_;  // of each layer, by the method
  std::vector<CloudColours> colours_;   // of each layer; empty: grey
  std::vector<double> peak_scale_;      // of each layer: s of cloud_shadow.h
  std::optional<SharedCloudLight> shared_;
  std::shared_ptr<const TerrainSunlight> past_terrain_;  // null: none
  const SceneGeometry& geometry_;
  SolvedAir air_;
  DistantLight light_;
  std::shared_ptr<const CloudShadow> shadow_;
  /// Radiance of the sky above and of the ground below each layer, per unit solar irradiance [1/sr];
  /// the air between adds to both (AroundLayer).
  std::vector<Spectrum> sky_above_, ground_below_;
  std::vector<Spectrum> sky_on_clouds_;  // SkyOnClouds
  std::vector<float> beam_left_;  // mean fraction of the beam that other layers leave to each
  Spectrum left_on_ground_;       // light on the ground relative to that without clouds
  /// Light at each interface: the fraction of the light that the air below sends in a clear sky, what
  /// layers add to it, and the light that they turn by a few degrees, per unit solar irradiance.
  std::vector<float> air_left_;
  std::vector<Spectrum> added_, turned_;
  std::vector<Spectrum> sent_back_;  // SentBackAt, at each interface
  Spectrum sky_on_top_;  // irradiance of a clear sky above all layers, per unit solar irradiance
  std::vector<Spectrum> beams_;        // mean ones on each layer, per unit solar irradiance
  std::vector<float> sky_past_;        // transmittance of each layer for skylight
  std::vector<Spectrum> diffuse_;      // factor in the air at each interface
  std::optional<LayeredAir> layered_;  // together with the air, if all layers are plane-parallel
  float layered_share_ = 0.0F;         // in the light of layers
  std::optional<MirroredClouds> mirror_;
};

}  // namespace alpenglow::renderer
