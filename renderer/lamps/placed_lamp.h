// SPDX-License-Identifier: MIT
// This header places the lamps of a scene: each lamp as an eye sees it, with the air between them,
// its disk, and the pieces of a ray that it lights.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/lamp/lamp.h"
#include "atmosphere/medium/medium.h"
#include "renderer/camera/camera_rays.h"
#include "renderer/lamps/ies_file.h"
#include "renderer/lamps/lamp_stage.h"
#include "renderer/scene/scene.h"
#include "renderer/surface/scene_ground.h"

namespace alpenglow::renderer {

/// Position and lens of the eye that sees lamps.
struct LampEye {
  glm::dvec3 at{0.0};
  std::optional<CameraRays> lens;  // set if the camera has a lens
};

/// A lamp at its place, with the air between it and the eye.
struct PlacedLamp {
  Lamp lamp;
  LampAir air;
  LampAir middle_air;       // of the middle band only, for estimates
  Spectrum intensity;       // W sr^-1 nm^-1 in its brightest direction
  double candela = 0.0;     // in its brightest direction
  double mean_share = 1.0;  // mean intensity over all directions, relative to the brightest
  double above_ground_m = 0.0;
  double distance_m = 0.0;    // from the eye
  glm::dvec3 direction{0.0};  // from the eye, unit
  double blur = 0.0;          // radius in the picture, as in CameraRays::BlurRadius
  bool is_hidden = false;     // from the eye, by terrain or the planet
  Spectrum towards_eye;       // intensity, dimmed by the air

  /// Returns whether the eye is inside the luminous sphere.
  [[nodiscard]] bool HoldsEye() const { return distance_m <= lamp.radius_m; }
};

/// IES files by name; each is read once.
using MeasuredLamps = std::map<std::string, IesLamp>;
/// Reads the IES files of a scene's lights. Throws InputError for files that ReadIes rejects.
[[nodiscard]] MeasuredLamps MeasuredLampsOf(const std::vector<Light>& lights);

/// Returns a light of a scene at its place, without an eye. Throws InputError naming its `number`
/// (from 0) for a light below the ground, and for one that is tilted beyond the angles of its file.
[[nodiscard]] PlacedLamp PlacedOn(const LampStage& stage, const Light& light, std::size_t number,
                                  const MeasuredLamps& measured);
/// Returns the spectral intensity of a black body with a luminous intensity of `candela`. Throws
/// InputError if it has no luminance in the bands, such as a black body of 1000 K in two bands at
/// 700 and 830 nm.
[[nodiscard]] Spectrum LampIntensity(double temperature_k, double candela,
                                     const std::vector<double>& wavelengths_nm,
                                     const BandColour& colour);

/// Returns all lights of a scene that emit, without an eye. Throws InputError as PlacedOn and
/// MeasuredLampsOf do.
[[nodiscard]] std::vector<PlacedLamp> PlacedLampsOf(const Scene& scene, const LampStage& stage,
                                                    const Medium& medium, const BandColour& colour);

/// Computes distance, direction, air and blur for an eye, but not the light that arrives there.
[[nodiscard]] PlacedLamp Before(const LampEye& eye, const LampStage& stage, PlacedLamp placed);
/// Computes the same as Before, and the light that arrives at the eye.
[[nodiscard]] PlacedLamp ShiningOn(const LampEye& eye, const LampStage& stage, PlacedLamp placed);

/// A lamp as a light source for the air along a ray from the eye, with a factor on its light.
struct LampAlongRay {
  Lamp lamp;
  double share = 1.0;
};
/// Widens a lamp to its size in the picture, as seen by the air around it: the mean of 1/D over a
/// square of width w around it is that of D = w / (4 ln(1 + sqrt 2)), and over a disk of radius R
/// that of R / 2.
[[nodiscard]] LampAlongRay AlongRay(const PlacedLamp& placed, const glm::dvec3& direction,
                                    double pixel_angle_rad);

/// Returns the length of the part of a ray that a lamp lights [m]. Beyond it, the lamp's light on
/// rays to the sky is neglected.
[[nodiscard]] double Reach(const PlacedLamp& placed, double length_m);

/// Returns the lit pieces of a ray from the eye, as distances. Points at equal angles seen from the
/// lamp are tested, and shadow edges between them are found by bisection.
[[nodiscard]] std::vector<std::array<double, 2>> PiecesLitBy(const PlacedLamp& placed,
                                                             const LampStage& stage,
                                                             const glm::dvec3& eye,
                                                             const glm::dvec3& direction,
                                                             double length_m);

/// Returns the fraction of a lamp's light at the eye that a camera ray sees, per solid angle
/// [1/sr].
[[nodiscard]] double SeenPerSr(const PlacedLamp& placed, const LampStage& stage, const LampEye& eye,
                               const CameraRay& ray, double pixel_angle_rad);
/// Returns the luminance of a lamp that contains the eye: I(-d) / (pi R^2) for the direction d of
/// the ray, as if the eye were in the centre and saw the inside of the luminous sphere. This is the
/// limit of a lamp seen from outside: its disk of luminance I / (pi R^2) fills the sky.
[[nodiscard]] Spectrum SeenFromWithin(const PlacedLamp& placed, const CameraRay& ray);

/// Returns intensity * scale * factor, in floats.
[[nodiscard]] Spectrum Scaled(const Spectrum& intensity, const SpectrumOf<double>& factor,
                              double scale);

}  // namespace alpenglow::renderer
