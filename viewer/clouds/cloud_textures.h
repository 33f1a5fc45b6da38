// SPDX-License-Identifier: MIT
// Provides the textures of clouds, uploaded one after another, so that no frame waits for all of
// them, and the uniform block of shaders/clouds/light.glsl.
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec4.hpp>
#include <memory>
#include <vector>

#include "renderer/lit_clouds/lit_clouds.h"
#include "viewer/clouds/cloud_texels.h"
#include "viewer/gl/gl_context.h"
#include "viewer/gl/shader.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {

/// Layers of clouds that are drawn; those above are left out.
inline constexpr std::size_t kMostCloudLayers = 4;

/// Mirrors the uniform block `Clouds` of clouds/light.glsl. The numbers from kMostCloudLayers on are
/// of the clouds that fade out.
struct CloudsBlock {
  glm::vec4 turn;
  std::array<glm::vec4, 2 * kMostCloudLayers> place, levels, shear, range;
  std::array<glm::vec4, kMostCloudLayers + 1> interfaces, added;
  std::array<glm::vec4, kMostCloudLayers> sky_low, sky_high, ground_low, ground_high;
  static constexpr std::size_t kDirections =
      LitClouds::InterfaceLight::kElevations * LitClouds::InterfaceLight::kAzimuths;
  std::array<std::array<glm::vec4, kDirections>, kMostCloudLayers + 1> diffuse_towards;
};
static_assert(sizeof(CloudsBlock) ==
              (1 + 8 * kMostCloudLayers + (2 + CloudsBlock::kDirections) * (kMostCloudLayers + 1) +
               4 * kMostCloudLayers) *
                  sizeof(glm::vec4));

/// The textures of clouds under one light.
class CloudTextures {
 public:
  explicit CloudTextures(std::shared_ptr<const CloudTexels> texels);

  /// Uploads the next texture. Returns whether all are uploaded.
  bool UploadOne(int unit);
  /// Returns the number of layers that are drawn.
  [[nodiscard]] std::size_t layers() const { return layers_.size(); }

  /// Texture units of the march, from the first one on.
  static constexpr int kMarchUnits = 8;
  /// Connects a program of clouds/march.glsl.
  static void Prepare(const ShaderProgram& march, int first_unit);
  /// Binds a layer for the next draw call, and sets its uniforms.
  /// @param number  of the layer. @param in_block  of the layer in the block Clouds.
  void BindLayer(const ShaderProgram& march, std::size_t number, std::size_t in_block,
                 int first_unit, const glm::dvec3& to_light) const;
  /// Binds the transmittances of all layers.
  void BindLight(int unit) const;

 private:
  struct Layer {
    GlTexture bricks, depth, extinction, sun, sky, basis, peak;
  };
  void Upload(std::size_t step) const;

  std::shared_ptr<const CloudTexels> texels_;
  std::vector<Layer> layers_;
  GlTexture light_;
  std::size_t uploaded_ = 0;
};

}  // namespace alpenglow::viewer
