// SPDX-License-Identifier: MIT
#include "viewer/clouds/cloud_textures.h"

#include <algorithm>
#include <utility>

#include "renderer/clouds/cloud_bricks.h"

namespace alpenglow::viewer {
namespace {

constexpr std::size_t kTexturesOfLayer = 7;
constexpr int kCorners = CloudField::StoredBricks::kCornersOfSide;
constexpr int kVoxels = CloudField::StoredBricks::kVoxels;

enum class Edges { kRepeat, kClamp };

// Sets how coordinates along x and y continue beyond the texture.
void ContinueAs(GLenum target, Edges edges) {
  const GLint mode = edges == Edges::kRepeat ? GL_REPEAT : GL_CLAMP_TO_EDGE;
  glTexParameteri(target, GL_TEXTURE_WRAP_S, mode);
  glTexParameteri(target, GL_TEXTURE_WRAP_T, mode);
  glTexParameteri(target, GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE);
}

void UploadBricks(const GlTexture& texture, const CloudLayerTexels& of) {
  UploadTexture(
      GL_TEXTURE_3D, texture,
      {GL_R32I, of.bricks[0], of.bricks[1], of.bricks[2], GL_RED_INTEGER, GL_INT, of.brick.data()});
  ClampAndFilter(GL_TEXTURE_3D, false);
}

void UploadDepth(const GlTexture& texture, const CloudLayerTexels& of) {
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  UploadTexture(GL_TEXTURE_3D, texture,
                {GL_R8, kCorners * of.tiles[0], kCorners * of.tiles[1], kCorners * of.tiles[2],
                 GL_RED, GL_UNSIGNED_BYTE, of.depth.data()});
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  ContinueAs(GL_TEXTURE_3D, Edges::kClamp);
}

void UploadSource(const GlTexture& texture, const CloudLayerTexels& of,
                  const std::vector<HalfBits>& source) {
  UploadTexture(
      GL_TEXTURE_3D, texture,
      {GL_RGBA16F, of.cells[0], of.cells[1], of.cells[2], GL_RGBA, GL_HALF_FLOAT, source.data()});
  ContinueAs(GL_TEXTURE_3D, of.is_periodic ? Edges::kRepeat : Edges::kClamp);
}

}  // namespace

CloudTextures::CloudTextures(std::shared_ptr<const CloudTexels> texels)
    : texels_(std::move(texels)) {
  for (std::size_t i = 0; i < std::min(texels_->layer.size(), kMostCloudLayers); ++i)
    layers_.emplace_back();
}

void CloudTextures::Upload(std::size_t step) const {
  if (step == 0) {
    const CloudSunTexels& sun = texels_->sun;
    glPixelStorei(GL_UNPACK_ALIGNMENT, 2);
    UploadTexture(GL_TEXTURE_3D, light_,
                  {GL_R16F, sun.nodes, sun.nodes, sun.levels, GL_RED, GL_HALF_FLOAT,
                   sun.transmittance.data()});
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    const bool repeats = std::all_of(texels_->layer.begin(), texels_->layer.end(),
                                     [](const CloudLayerTexels& of) { return of.is_periodic; });
    ContinueAs(GL_TEXTURE_3D, repeats ? Edges::kRepeat : Edges::kClamp);
    return;
  }
  const std::size_t number = (step - 1) / kTexturesOfLayer;
  const CloudLayerTexels& of = texels_->layer[number];
  const Layer& layer = layers_[number];
  switch ((step - 1) % kTexturesOfLayer) {
    case 0:
      return UploadBricks(layer.bricks, of);
    case 1:
      return UploadDepth(layer.depth, of);
    case 2:
      return UploadTexture(GL_TEXTURE_2D, layer.extinction,
                           {GL_R16F, CloudLayerTexels::kBytes, CloudLayerTexels::kExtinctionRows, 1,
                            GL_RED, GL_HALF_FLOAT, of.extinction.data()});
    case 3:
      return UploadSource(layer.sun, of, of.sun);
    case 4:
      return UploadSource(layer.sky, of, of.sky);
    case 5:
      UploadTexture(GL_TEXTURE_2D, layer.basis,
                    {GL_RGBA32F, CloudLayerTexels::kAzimuths, 2 * CloudLayerTexels::kElevations, 1,
                     GL_RGBA, GL_FLOAT, of.basis.data()});
      glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_REPEAT);
      return;
    default:
      return UploadTexture(GL_TEXTURE_2D, layer.peak,
                           {GL_R32F, CloudLayerTexels::kPeakAngles, CloudLayerTexels::kPeakDepths,
                            1, GL_RED, GL_FLOAT, of.peak.data()});
  }
}

bool CloudTextures::UploadOne(int unit) {
  const std::size_t all = 1 + kTexturesOfLayer * layers_.size();
  if (uploaded_ < all) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    Upload(uploaded_++);
    CheckGl("CloudTextures::UploadOne");
  }
  return uploaded_ == all;
}

void CloudTextures::Prepare(const ShaderProgram& march, int first_unit) {
  int unit = first_unit;
  for (const char* sampler : {"cloud_bricks", "cloud_depth", "cloud_extinction", "cloud_sun_source",
                              "cloud_sky_source", "cloud_basis", "cloud_peak", "cloud_light"})
    march.BindSampler(sampler, unit++);
}

void CloudTextures::BindLight(int unit) const { BindTexture(unit, GL_TEXTURE_3D, light_); }

void CloudTextures::BindLayer(const ShaderProgram& march, std::size_t number, std::size_t in_block,
                              int first_unit, const glm::dvec3& to_light) const {
  const Layer& layer = layers_[number];
  int unit = first_unit;
  for (const GlTexture* texture : {&layer.bricks, &layer.depth})
    BindTexture(unit++, GL_TEXTURE_3D, *texture);
  BindTexture(unit++, GL_TEXTURE_2D, layer.extinction);
  for (const GlTexture* texture : {&layer.sun, &layer.sky})
    BindTexture(unit++, GL_TEXTURE_3D, *texture);
  for (const GlTexture* texture : {&layer.basis, &layer.peak})
    BindTexture(unit++, GL_TEXTURE_2D, *texture);
  BindLight(unit);
  const CloudLayerTexels& of = texels_->layer[number];
  const auto f = [](double value) { return static_cast<float>(value); };
  const double cells_m = of.cells[2] * of.cell_height_m;
  glUniform1i(march.Uniform("layer_number"), static_cast<GLint>(in_block));
  glUniform4f(march.Uniform("layer_shape"), f(1.0 / of.voxel_m), f(of.origin_m.z),
              f(kVoxels * of.voxel_m), f(of.cells[2]));
  glUniform3f(march.Uniform("layer_cells"), f(of.cells_base_m), f(1.0 / cells_m),
              f(of.scaled_albedo));
  glUniform3f(march.Uniform("layer_texel"), f(1.0 / (kCorners * of.tiles[0])),
              f(1.0 / (kCorners * of.tiles[1])), f(1.0 / (kCorners * of.tiles[2])));
  glUniform2f(march.Uniform("layer_periods_per_voxel"), f(of.voxel_m / of.size_m.x),
              f(of.voxel_m / of.size_m.y));
  glUniform3f(march.Uniform("layer_voxels"), f(of.size_m.x / of.voxel_m),
              f(of.size_m.y / of.voxel_m), f(kVoxels * of.bricks[2]));
  glUniform3f(march.Uniform("beam_towards"), f(to_light.x), f(to_light.y), f(to_light.z));
  glUniform1fv(march.Uniform("layer_factor"), static_cast<GLsizei>(of.factor.size()),
               of.factor.data());
}

}  // namespace alpenglow::viewer
