// SPDX-License-Identifier: MIT
// The light that a body (LocalBody), here also called a volume, scatters, and that it emits.
//
// By its ScatteringOrders it has the light of all orders (volume_orders.h), or that of the first
// alone, which has closed forms.
//
// Sunlight arrives through the air (RefractedBeam), the terrain's shadow, and every medium on its
// path. Skylight is given by its moments (MultipleScattering) and the phase function, and attenuated
// by the mean transmittance of the bodies over 26 directions; light of all orders has its own sky,
// which other bodies attenuate on the way to the middle of the volume. Columns towards the sun
// through a volume with Samples() are taken from a grid of at most 64 samples per side; the error is
// 2 % of the sun's light in turbulent smoke with as many samples itself.
//
// The eight lamps of the scene that are brightest at a volume light it, through the air around lamps
// and bodies (optical depths are from a grid of at most 24 samples per side), shadowed by terrain.
// Other bodies that glow are lamps, too (body_glow.h), without air and terrain in between. Surfaces have
// the light of a body that glows by its parts (glow_field.h).
//
// With light of all orders a volume attenuates light without the forward peak of its phase function:
// its own, that of wide sources behind it, and sunlight in its shadow.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "renderer/illumination/sky_moments.h"
#include "renderer/media/glow_field.h"
#include "renderer/media/lit_medium.h"
#include "renderer/media/local_body.h"
#include "renderer/media/volume_orders.h"

namespace alpenglow::renderer {

class LitVolume final : public LitMedium {
 public:
  /// Refers to both.
  LitVolume(const LocalBody& volume, const MediaSources& sources);

  [[nodiscard]] std::unique_ptr<const MediumOnRay> OnRay(
      const glm::dvec3& origin, const glm::dvec3& direction) const override;
  [[nodiscard]] std::optional<SpectrumOf<double>> WideExtinction_per_m() const override;
  /// A lamp's light varies on the scale of its distance from the ray, so panels end there.
  void AddCuts(const glm::dvec3& origin, const glm::dvec3& direction,
               std::vector<double>& cuts_m) const override;
  /// Inside a volume with Samples(), the depth towards the centre of the disk is that of
  /// sun_column_.
  void AddDepthToLight(const glm::dvec3& point, const glm::dvec3& to_disk,
                       SpectrumOf<double>& depth) const override;
  [[nodiscard]] const GlowField* Glow() const override { return glow_.get(); }

 private:
  class OnOneRay;
  /// A lamp or another body that glows and lights the volume.
  struct VolumeLamp {
    Lamp lamp;
    Spectrum intensity;                    // W sr^-1 nm^-1 in its brightest direction
    std::vector<VolumeGrid> depth;         // [band] of the path without the volume itself
    std::optional<VolumeGrid> own_column;  // of the path in a volume with Samples() [m]
  };
  /// Returns the optical depth of the path from a point to a lamp without the volume.
  using LampDepth = std::function<SpectrumOf<double>(const glm::dvec3& point)>;

  /// Scattering and emission at a point.
  struct Colour {
    Spectrum scattering_per_m, emission_per_m;  // at density 1
    Spectrum relative;                          // scattering relative to the mean of the volume
  };
  [[nodiscard]] Colour MeanColour() const;
  /// Returns the colour at a point of a volume whose colour varies.
  [[nodiscard]] std::optional<Colour> ColourAt(const glm::dvec3& point) const;
  /// Returns the light that leaves the volume from its emission: with light of all orders also what the
  /// volume scatters of it, else the emission that is not absorbed. Null: it does not glow.
  [[nodiscard]] std::unique_ptr<const GlowField> GlowAround() const;
  [[nodiscard]] SkyMoments Sky() const;
  [[nodiscard]] std::optional<VolumeGrid> SunColumns() const;
  [[nodiscard]] std::vector<VolumeGrid> SkyLeft(const SkyMoments& sky) const;
  [[nodiscard]] std::vector<VolumeLamp> AllLamps() const;
  [[nodiscard]] std::vector<VolumeLamp> Lamps() const;
  /// Returns the bodies that glow brighter than a thousandth of the sunlight on the volume.
  [[nodiscard]] std::vector<VolumeLamp> Glows() const;
  [[nodiscard]] VolumeLamp LampOf(const Lamp& lamp, const Spectrum& intensity,
                                  const LampDepth& depth) const;
  /// Adds the optical depth of a medium other than the volume between a point and a lamp.
  void AddOther(const LocalMedium& medium, const glm::dvec3& point, const glm::dvec3& lamp,
                SpectrumOf<double>& depth) const;
  /// Returns the distance of a lamp from the nearest point of the volume's box [m].
  [[nodiscard]] double NearestTo(const Lamp& lamp) const;
  /// Returns the column of the volume between a point and a lamp [m].
  [[nodiscard]] double ColumnToLamp(const VolumeLamp& seen, const glm::dvec3& point) const;
  /// Returns the column of the volume between a point and the light [m].
  [[nodiscard]] double ColumnToLight(const glm::dvec3& point, const glm::dvec3& to_disk) const;
  /// Returns the light of all orders; null: of the first order alone.
  [[nodiscard]] std::unique_ptr<const VolumeOrders> Orders() const;
  [[nodiscard]] std::vector<LampBeam> LampBeams(const glm::dvec3& point, std::size_t band,
                                                double least_m) const;
  /// Returns the sky's radiance from a direction at the middle of the volume past clouds and other
  /// bodies, per unit solar irradiance [1/sr].
  [[nodiscard]] Spectrum SkyPastBodies(const glm::dvec3& from) const;
  /// Adds the light of a lamp that the volume scatters along a direction once.
  void AddLamp(const VolumeLamp& seen, const Colour& colour, const glm::dvec3& direction,
               const LightOnPoint& light, double density, Spectrum& sum) const;

  const LocalBody& volume_;
  const MediaSources& sources_;
  Colour mean_colour_;
  std::vector<double> chi_;
  SkyMoments sky_;
  LightPastClouds past_;                  // at the middle
  std::optional<VolumeGrid> sun_column_;  // [m], of volumes with Samples()
  std::vector<VolumeLamp> lamps_;
  std::unique_ptr<const VolumeOrders> orders_;  // null: the first order alone
  std::vector<VolumeGrid> sky_left_;            // [band]; empty with orders_
  SpectrumOf<double> extinction_per_m_;         // for wide sources
  std::unique_ptr<const GlowField> glow_;       // null: none
};

}  // namespace alpenglow::renderer
