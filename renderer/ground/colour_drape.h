// SPDX-License-Identifier: MIT
// A picture laid over the terrain: colours of an orthophoto, or a map of land cover.
//
// Read by GDAL: GeoTIFF and PNG, 8 or 16 bits (sRGB-encoded) or floating point (linear), three
// bands or more (the first three are red, green, blue), or one (grey). With a coordinate system it
// lies where it says; without, it covers the terrain from rim to rim, its upper edge in the north.
// A map of land cover is one band of 8 bits, of the classes of land_cover.h. Pixels may be left out
// by an alpha band, a mask or a nodata value: there the ground shows its own cover. Averages over
// 2 x 2, 4 x 4, ... pixels serve distant ground.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "renderer/ground/band_light.h"
#include "renderer/ground/scene_ground.h"
#include "renderer/scene/scene.h"

namespace alpenglow::renderer {

/// Spectral albedo from a colour of a picture, quick: AlbedoFromLinearSrgb, but for colours too
/// saturated for it, which are clamped band by band.
class BandsOfColour {
 public:
  explicit BandsOfColour(std::span<const double> wavelengths_nm);

  /// @param rgb  linear sRGB.
  [[nodiscard]] BandLight Albedo(const std::array<double, 3>& rgb) const;
  /// What a channel adds to the albedo.
  [[nodiscard]] const BandLight& OfPrimary(std::size_t channel) const {
    return of_primary_[channel];
  }

 private:
  std::array<BandLight, 3> of_primary_;
};

/// Colours or land cover on the terrain. Immutable; safe to ask from many threads.
class ColourDrape {
 public:
  /// The picture that a scene names, over its ground; null if it names
  /// none. Throws InputError naming the file and the fault for what
  /// cannot be read, has over 2^26 pixels or no terrain under it.
  [[nodiscard]] static std::shared_ptr<const ColourDrape> Of(const Scene& scene,
                                                             const SceneGround& ground);

  /// The same colours for points of another frame.
  [[nodiscard]] std::shared_ptr<const ColourDrape> In(const LocalFrame& frame) const;

  /// Shares of land cover, where else are colours.
  [[nodiscard]] bool IsLandCover() const { return is_land_cover_; }

  /// About the width of a pixel [m].
  [[nodiscard]] double pixel_m() const { return pixel_m_; }

  /// Linear sRGB, or shares of land cover as CoverOfClass has them, averaged over about a footprint;
  /// nothing outside the picture and where less than half of it is there.
  /// @param point  in the ground's frame, at that altitude.
  [[nodiscard]] std::optional<std::array<double, 3>> At(const glm::dvec3& point, double altitude_m,
                                                        double footprint_m) const;

 private:
  /// Linear sRGB times how much of a pixel is there, and that weight, in 16 bits.
  struct Level {
    int columns = 0, rows = 0;
    std::vector<std::array<std::uint16_t, 4>> pixels;
  };
  /// Where a place lies in the picture [pixels from its upper left corner].
  struct Place {
    double x, y;
  };

  ColourDrape(const std::filesystem::path& file, bool is_land_cover, const SceneGround& ground);
  [[nodiscard]] std::array<double, 4> Bilinear(std::size_t level, const Place& at) const;

  std::shared_ptr<const std::vector<Level>> levels_;  // each half as fine as the one before
  LocalFrame frame_;                                  // of the ground that it was laid over
  glm::dmat3 turn_{1.0};                              // into that frame
  glm::dvec3 origin_{0.0};
  // Places at the nodes of a grid over the frame's plane.
  double first_x_m_ = 0.0, first_y_m_ = 0.0, step_x_m_ = 1.0, step_y_m_ = 1.0;
  std::vector<Place> places_;
  double radius_m_ = 0.0;
  double pixel_m_ = 1.0;
  bool is_land_cover_;
};

}  // namespace alpenglow::renderer
