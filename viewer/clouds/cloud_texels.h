// SPDX-License-Identifier: MIT
// The clouds of a scene under one light as values of textures, made from the tables of the renderer
// (lit_clouds/). shaders/clouds/march.glsl gathers light along rays from them as CloudGather does
// from the tables themselves.
//
// Shape: the bricks of the field, each with the same bytes, and the extinction as a table by byte and
// altitude, so that no formula of the edge is needed.
//
// Sources of higher orders: with the moments M of a cell (cloud_moments.h) and the factors
// a_lm(d) = w' chi'_l Y_lm(d) of a direction, the source is J = sum_lm a_lm(d) M_lm. The 16 weighted
// moments w' chi'_l M_lm of all cells are nearly in a space of four dimensions, because few patterns
// of light occur in one field: the largest four eigenvectors e_k of their covariance span it. A texel
// holds the four components of a cell, and a second table the four functions
// b_k(d) = sum_lm e_k,lm a_lm(d) / (w' chi'_l), so that J = sum_k c_k b_k(d) for any direction.
//
// Optical depth to the light: transmittances at nodes whose levels are 10 m to 80 m apart. Under a high
// sun nodes are sheared along its direction as in cloud_sun_map.h, so that shadows are as sharp on the
// ground as in the clouds. All layers share one texture, from bottom to top. A layer that no light
// reaches (CloudSunDepths::IsUnlit) has one level without shadow.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <vector>

#include "renderer/lit_clouds/cloud_layers.h"
#include "renderer/lit_clouds/lit_clouds.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// A half float, as OpenGL reads it.
using HalfBits = std::uint16_t;

/// One layer of clouds. Lattices are relative to `origin_m`, in the flat frame of the scene.
struct CloudLayerTexels {
  // Place.
  AltitudeRange range;  // of cloud
  glm::dvec3 origin_m;  // of bricks and cells
  glm::dvec2 size_m;    // period, or the sides of an open field
  bool is_periodic;

  // Shape.
  double voxel_m{};                    // a cube's side
  std::array<int, 3> bricks{};         // along x, y and z
  std::vector<std::int32_t> brick{};   // tile of the atlas (10 bits an axis), or minus the
                                       // distance to the nearest brick with values [bricks]
  std::array<int, 3> tiles{};          // of the atlas, along its axes
  std::vector<std::uint8_t> depth{};   // atlas of slots: (9 tiles)^3 values, x fastest
  std::vector<HalfBits> extinction{};  // [1/km], kBytes a row; rows by altitude over `range`

  // Light of higher orders: four components per cell.
  std::array<int, 3> cells{};
  double cell_height_m = 0.0, cells_base_m = 0.0;  // along z; the base is relative to the origin
  std::vector<HalfBits> sun{}, sky{};
  std::vector<glm::vec4> basis{};  // of sun, then of sky, by direction of view

  // Light of the beam.
  std::vector<float> peak{};  // p_eff by half sine and depth
  std::array<float, kCloudFactorNodes> factor{};
  double scale = 1.0, scaled_albedo = 1.0;  // s and w' of cloud_optics.h

  static constexpr int kBytes = 256, kExtinctionRows = 128;
  static constexpr int kAzimuths = 128, kElevations = 64;
  static constexpr int kPeakAngles = 512, kPeakDepths = 64;
};

/// Returns the coordinate in [0, 1] of a scattering angle in tables of p_eff: fourth root of sin^2 of
/// half the angle, which resolves the forward peak.
[[nodiscard]] double PeakAngleOf(double coordinate);
/// Returns the depth of a coordinate in [0, 1]: geometric from 1e-3 to ForwardPeak::kDeepest.
[[nodiscard]] double PeakDepthOf(double coordinate);

/// Transmittances of all layers to the light.
struct CloudSunTexels {
  struct Layer {
    int first, levels = 1;        // rows of the texture along z
    double low_m, level_m = 1.0;  // altitude of the first, and the distance between them
    glm::dvec2 slope;             // horizontal shift per metre of height
    double clear_from_m;          // altitude from which on nothing is hidden
  };
  std::vector<Layer> layer;
  int nodes = 0, levels = 0;  // along x and y; along z
  std::vector<HalfBits> transmittance;

  static constexpr int kNodes = 512;
  static constexpr double kLevel_m = 40.0;
};

/// Clouds under one light.
struct CloudTexels {
  std::vector<CloudLayerTexels> layer;  // from the lowest to the highest base
  CloudSunTexels sun;
  std::shared_ptr<const CloudLayers> fields;
};

/// Returns the values of textures of solved clouds. Uses as many threads as are free.
[[nodiscard]] CloudTexels TexelsOfClouds(const SolvedClouds& clouds);

}  // namespace alpenglow::viewer
