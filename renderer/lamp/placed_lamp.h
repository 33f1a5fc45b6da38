// SPDX-License-Identifier: MIT
// What the lamps of a scene stand in: its ground, and its molecules, aerosol and fog as layers of
// exponential density.
//
// A lamp where it stands, and what an eye has of it: the air between, the disk that it sees, the
// pieces of a ray that the lamp lights.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/air/medium.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/lamp/lamp.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/ground/scene_ground.h"
#include "renderer/lamp/ies_file.h"
#include "renderer/scene/scene.h"

namespace alpenglow::renderer {

/// Immutable, safe to share between threads. Refers to the ground.
class LampStage {
 public:
  LampStage(const Scene& scene, const SceneGround& ground, const Medium& medium);

  [[nodiscard]] const SceneGround& ground() const { return *ground_; }
  /// Fog is the last.
  [[nodiscard]] const std::vector<LampLayer>& layers() const { return layers_; }
  [[nodiscard]] std::size_t bands() const { return bands_; }

  [[nodiscard]] double AltitudeOf(const glm::dvec3& point) const;
  [[nodiscard]] glm::dvec3 UpAt(const glm::dvec3& point) const;
  /// The terrain that a point is over, along z (SurfaceUnderPoint).
  [[nodiscard]] std::optional<SurfaceUnder> TerrainAt(const glm::dvec3& point) const;
  /// Its height there [m along z], or `otherwise`.
  [[nodiscard]] double TerrainUnder(const glm::dvec3& point, double otherwise) const;
  /// Over the terrain [m]; a point below it has none.
  [[nodiscard]] double HeightOverGround(const glm::dvec3& point) const;
  /// Whether no terrain stands between two points.
  [[nodiscard]] bool Sees(const glm::dvec3& from, const glm::dvec3& to) const;

  /// Whether terrain keeps a lamp's light from a surface.
  /// @param smooth_point  TerrainHit's, which shadow rays begin at; geometric_normal: unit.
  [[nodiscard]] bool Shades(const Lamp& lamp, const glm::dvec3& smooth_point,
                            const glm::dvec3& geometric_normal) const;

  /// The layers over the plane that touches the sphere below a point.
  [[nodiscard]] LampAir AirAround(const glm::dvec3& middle) const;
  /// Of the fog alone.
  [[nodiscard]] Bands<float> FogTransmittance(const glm::dvec3& from, const glm::dvec3& direction,
                                              double length_m) const;

 private:
  const SceneGround* ground_;
  double planet_radius_m_;
  std::vector<LampLayer> layers_;
  bool has_fog_;
  std::size_t bands_;
};

/// From where lamps are seen.
struct LampEye {
  glm::dvec3 at{0.0};
  std::optional<CameraRays> lens;  // of a camera that has one
};

/// A lamp where it stands, with the air between it and the eye.
struct PlacedLamp {
  Lamp lamp;
  LampAir air;
  LampAir middle_air;       // of the middle band alone, for estimates
  Bands<float> intensity;   // W sr^-1 nm^-1 in its brightest direction
  double candela = 0.0;     // in its brightest direction
  double mean_share = 1.0;  // mean intensity over all directions, relative to the brightest
  double above_ground_m = 0.0;
  double distance_m = 0.0;    // from the eye
  glm::dvec3 direction{0.0};  // from the eye, unit
  double blur = 0.0;          // radius in the picture, as CameraRays::BlurRadius
  bool is_hidden = false;     // from the eye, by terrain
  Bands<float> towards_eye;   // intensity, dimmed by the air

  /// Whether the eye is in the luminous sphere.
  [[nodiscard]] bool HoldsEye() const { return distance_m <= lamp.radius_m; }
};

/// IES files by name: each is read once.
using MeasuredLamps = std::map<std::string, IesLamp>;
/// Of the lights of a scene. Throws InputError for what ReadIes refuses.
[[nodiscard]] MeasuredLamps MeasuredLampsOf(const std::vector<Light>& lights);

/// A light of a scene, before no eye. Throws InputError naming its `number` (from 0) for one below
/// the ground and for one that is tilted beyond the angles of its file.
[[nodiscard]] PlacedLamp PlacedOn(const LampStage& stage, const Light& light, std::size_t number,
                                  const MeasuredLamps& measured);
/// Spectral intensity of a black body that has so many candela. Throws InputError where the bands
/// have no luminance of it, as two at 700 and 830 nm have none of one of 1000 K.
[[nodiscard]] Bands<float> LampIntensity(double temperature_k, double candela,
                                         const std::vector<double>& wavelengths_nm,
                                         const BandColour& colour);

/// All lights of a scene that shine, before no eye. Throws InputError as PlacedOn and
/// MeasuredLampsOf do.
[[nodiscard]] std::vector<PlacedLamp> PlacedLampsOf(const Scene& scene, const LampStage& stage,
                                                    const Medium& medium, const BandColour& colour);

/// The lamp as an eye has it: distance, direction, air between, blur; its light has not arrived.
[[nodiscard]] PlacedLamp Before(const LampEye& eye, const LampStage& stage, PlacedLamp placed);
/// And with what of its light arrives.
[[nodiscard]] PlacedLamp ShiningOn(const LampEye& eye, const LampStage& stage, PlacedLamp placed);

/// A lamp as it lights the air along a ray from the eye, times a share.
struct LampAlongRay {
  Lamp lamp;
  double share = 1.0;
};
/// As wide as the air around it sees it in a picture: the mean of 1/D over a square of width w
/// around it is that of D = w / (4 ln(1 + sqrt 2)), and over a disk of radius R that of R / 2.
[[nodiscard]] LampAlongRay AlongRay(const PlacedLamp& placed, const glm::dvec3& direction,
                                    double pixel_angle_rad);

/// The part of a ray of that length that a lamp lights: beyond, rays to the sky have left it [m].
[[nodiscard]] double Reach(const PlacedLamp& placed, double length_m);

/// The lit pieces of a ray from the eye, in distances: points at equal angles as the lamp sees them
/// are tested, and edges between them bisected.
[[nodiscard]] std::vector<std::array<double, 2>> PiecesLitBy(const PlacedLamp& placed,
                                                             const LampStage& stage,
                                                             const glm::dvec3& eye,
                                                             const glm::dvec3& direction,
                                                             double length_m);

/// Of a lamp's light as the eye gets it, what a ray of the camera sees of it [1/sr].
[[nodiscard]] double SeenPerSr(const PlacedLamp& placed, const LampStage& stage, const LampEye& eye,
                               const CameraRay& ray, double pixel_angle_rad);
/// Of a lamp that the eye is in: its luminance, I(-d) / (pi R^2) of the direction d of the ray, as
/// if the eye were in its middle and saw the inside of the luminous sphere. What a lamp from
/// outside tends to: its disk, I / (pi R^2) bright, fills the sky.
[[nodiscard]] Bands<float> SeenFromWithin(const PlacedLamp& placed, const CameraRay& ray);

/// intensity * scale * factor, in floats.
[[nodiscard]] Bands<float> Scaled(const Bands<float>& intensity, const Bands<double>& factor,
                                  double scale);

}  // namespace alpenglow::renderer
