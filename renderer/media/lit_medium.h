// SPDX-License-Identifier: MIT
// The interface of the light in one medium: what its sources are (MediaSources), what it does to
// the light of others, and the light that it sends along a ray (MediumOnRay).
#pragma once

#include <cstddef>
#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "lut/multiple_scattering/solved_air.h"
#include "renderer/illumination/lighting.h"
#include "renderer/lamps/lamp_light.h"
#include "renderer/media/local_media.h"

namespace alpenglow::renderer {

class GlowField;

/// This switch turns the light that media emit themselves on or off.
enum class MediaEmission { kOn, kOff };

/// Light of the sky on a surface inside or above layers.
struct SkyThroughMedia {
  Spectrum left;   // fraction of the irradiance from a clear sky
  Spectrum added;  // irradiance from the media, per unit solar irradiance [1]

  /// Returns the light of a clear sky.
  [[nodiscard]] static SkyThroughMedia Clear(std::size_t bands);
};

/// Mean light at an altitude below, between or above clouds.
struct LightPastClouds {
  SkyThroughMedia sky;  // on a level surface
  Spectrum ground;      // light from below, relative to that under a clear sky
  float sun = 1.0F;     // fraction of the beam

  /// Returns the light without clouds.
  [[nodiscard]] static LightPastClouds Clear(std::size_t bands);
};
using CloudsOverMedia = std::function<LightPastClouds(double altitude_m)>;

/// The sources of light in the media of a scene, for one position of the sun. It refers to its parts.
struct MediaSources {
  const LocalMedia& media;
  const SceneGeometry& geometry;
  SolvedAir air;
  DistantLight light;      // the sun or the moon
  const LampLight* lamps;  // null: none
  MediaEmission emission;
  CloudsOverMedia clouds;  // null: none

  [[nodiscard]] std::size_t bands() const { return media.bands(); }
  /// Returns the transmittance of the air for sunlight at a point.
  [[nodiscard]] Spectrum SunInAir(const glm::dvec3& point) const;
  [[nodiscard]] LightPastClouds PastClouds(double altitude_m) const;
};

/// Light of sun and sky on its way to a point of a medium.
struct LightOnPoint {
  const glm::dvec3& point;
  double distance_m;  // from the origin of the ray
  double altitude_m;
  const Spectrum& in_air;           // transmittance of the air for sunlight
  float past_terrain;               // fraction of the sunlight that terrain does not stop
  const SpectrumOf<double>& depth;  // optical depth of the other media towards the sun
  double column_to_eye_m;           // of the medium itself, from the ray's origin
  float sky_left;                   // transmittance of the other layers for skylight

  /// Returns the transmittance of terrain and of an optical depth for sunlight, without the air.
  [[nodiscard]] Spectrum LitThrough(const SpectrumOf<double>& all_media) const;
};

/// Light of a medium along one ray.
class MediumOnRay {
 public:
  MediumOnRay() = default;
  MediumOnRay(const MediumOnRay&) = delete;
  MediumOnRay& operator=(const MediumOnRay&) = delete;
  virtual ~MediumOnRay() = default;

  /// Adds the light that the medium sends to the ray's origin [W m^-2 sr^-1 nm^-1 per metre],
  /// without attenuation in between, which is that of LitMedium::WideExtinction_per_m.
  /// @param density  at the point, > 0.
  virtual void AddSource(const LightOnPoint& light, double density, Spectrum& sum) const = 0;
};

/// The light in one medium for one position of the sun. Immutable; safe to use from many threads.
class LitMedium {
 public:
  LitMedium() = default;
  LitMedium(const LitMedium&) = delete;
  LitMedium& operator=(const LitMedium&) = delete;
  virtual ~LitMedium() = default;

  [[nodiscard]] virtual std::unique_ptr<const MediumOnRay> OnRay(
      const glm::dvec3& origin, const glm::dvec3& direction) const = 0;
  /// Returns the extinction at density 1 for light of wide sources and of the medium itself [1/m];
  /// nothing: that of its optics.
  [[nodiscard]] virtual std::optional<SpectrumOf<double>> WideExtinction_per_m() const {
    return std::nullopt;
  }
  /// Adds distances along a ray at which panels of the march must end.
  virtual void AddCuts(const glm::dvec3& /*origin*/, const glm::dvec3& /*direction*/,
                       std::vector<double>& /*cuts_m*/) const {}

  /// Adds the optical depth of the medium between a point and the light: the shadow that it casts on
  /// the ground, into the air and on other media. Light in a forward peak may count as not
  /// scattered.
  /// @param to_disk  towards the light: the centre of its disk, or a point of it for soft shadows.
  virtual void AddDepthToLight(const glm::dvec3& point, const glm::dvec3& to_disk,
                               SpectrumOf<double>& depth) const = 0;
  /// Returns the transmittance of a layer for skylight from above to an altitude. It includes the
  /// light in the forward peak.
  [[nodiscard]] virtual float SkyLeft(double /*altitude_m*/) const { return 1.0F; }
  /// Returns the light that a body that glows sends to surfaces; null: none.
  [[nodiscard]] virtual const GlowField* Glow() const { return nullptr; }
  /// Attenuates the light of the sky on a surface by a layer, and adds the light of the layer.
  /// @param cos_up  between the surface's normal and the vertical.
  virtual void ChangeSky(double /*altitude_m*/, double /*cos_up*/, SkyThroughMedia& /*sky*/) const {
  }
};

}  // namespace alpenglow::renderer
