// SPDX-License-Identifier: MIT
// This header provides a picture draped over the terrain: colours of an orthophoto, or a map of
// land cover.
//
// The picture is a GeoTIFF or PNG file; renderer/surface/drape_file.h describes its colours.
// With a coordinate system, the picture is placed by it; without one, it covers the whole extent of
// the terrain, with its upper edge in the north. A map of land cover has one band of 8 bits with
// the classes of land_cover.h. An alpha band, a mask or a nodata value can leave pixels out: the
// ground there shows its own cover. Averages over 2 x 2, 4 x 4, ... pixels serve distant ground.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "atmosphere/colour/spectrum.h"
#include "renderer/scene/scene.h"
#include "renderer/surface/scene_ground.h"

namespace alpenglow::renderer {

/// Fast conversion of a picture's colour to a spectral albedo: AlbedoFromLinearSrgb, except for
/// colours too saturated for it, which are clamped band by band.
class BandsOfColour {
 public:
  explicit BandsOfColour(std::span<const double> wavelengths_nm);

  /// @param rgb  linear sRGB.
  [[nodiscard]] Spectrum Albedo(const std::array<double, 3>& rgb) const;
  /// Returns the albedo that one unit of a channel contributes.
  [[nodiscard]] const Spectrum& OfPrimary(std::size_t channel) const {
    return of_primary_[channel];
  }

 private:
  std::array<Spectrum, 3> of_primary_;
};

/// Colours or land cover on the terrain. Immutable; safe to use from many threads.
class ColourDrape {
 public:
  /// Returns the picture that a scene names, placed over its ground; null if it names none. Throws
  /// InputError naming the file and the fault if the picture cannot be read, has over 2^26 pixels
  /// or has no terrain under it.
  [[nodiscard]] static std::shared_ptr<const ColourDrape> Of(const Scene& scene,
                                                             const SceneGround& ground);

  /// Returns the same drape for points given in another frame.
  [[nodiscard]] std::shared_ptr<const ColourDrape> In(const LocalFrame& frame) const;

  /// Returns whether the drape holds shares of land cover rather than colours.
  [[nodiscard]] bool IsLandCover() const { return is_land_cover_; }

  /// Returns a line on values that the drape does not show as they are, and on a picture beside the
  /// land; empty if there is nothing to say.
  [[nodiscard]] const std::string& note() const { return note_; }

  /// Approximate width of a pixel [m].
  [[nodiscard]] double pixel_m() const { return pixel_m_; }

  /// Returns linear sRGB, or shares of land cover as CoverOfClass defines them, averaged over about
  /// a footprint. Empty outside the picture, and where less than half of the footprint has valid
  /// pixels.
  /// @param point  in the ground's frame, at that altitude.
  [[nodiscard]] std::optional<std::array<double, 3>> At(const glm::dvec3& point, double altitude_m,
                                                        double footprint_m) const;

 private:
  /// Linear sRGB times the weight of a pixel (its valid fraction), and the weight, in 16 bits.
  struct Level {
    int columns = 0, rows = 0;
    std::vector<std::array<std::uint16_t, 4>> pixels;
  };

  ColourDrape(const std::filesystem::path& file, bool is_land_cover, const SceneGround& ground);
  [[nodiscard]] bool IsBesideTheLand() const;
  [[nodiscard]] std::array<double, 4> Bilinear(std::size_t level, const glm::dvec2& at) const;

  std::shared_ptr<const std::vector<Level>> levels_;  // each at half the resolution of the last
  LocalFrame frame_;                                  // frame of the ground under the picture
  glm::dmat3 turn_{1.0};                              // rotation into that frame
  glm::dvec3 origin_{0.0};
  // Positions in the picture [pixels from its upper left corner] at the nodes of a grid over the
  // frame's plane.
  double first_x_m_ = 0.0, first_y_m_ = 0.0, step_x_m_ = 1.0, step_y_m_ = 1.0;
  std::vector<glm::dvec2> places_;
  double columns_of_turn_ = 0.0;  // of longitude; 0: columns do not close around the planet
  double radius_m_ = 0.0;
  double pixel_m_ = 1.0;
  bool is_land_cover_;
  std::string note_;
};

}  // namespace alpenglow::renderer
