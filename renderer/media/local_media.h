// SPDX-License-Identifier: MIT
// The media of a scene besides the air, as a list. Their order has no meaning.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "atmosphere/medium/medium.h"
#include "renderer/media/exponential_layer.h"
#include "renderer/media/local_medium.h"
#include "renderer/scene/scene.h"
#include "renderer/surface/scene_ground.h"

namespace alpenglow::renderer {

/// Immutable; safe to use from many threads. Copies share the media.
class LocalMedia {
 public:
  /// Reads the grids of volumes. Throws InputError "volume N: ..." for grids that cannot be read.
  /// Layers that lie wholly below the ground and volumes without any effect are left out.
  LocalMedia(const Scene& scene, const SceneGround& ground, const Medium& medium);
  /// Takes any media, each of `bands` bands.
  LocalMedia(MediaList all, std::size_t bands) : all_(std::move(all)), bands_(bands) {}
  /// Returns a subset: with or without the bodies, with or without the layers.
  [[nodiscard]] LocalMedia Only(bool bodies, bool layers) const;

  [[nodiscard]] bool IsEmpty() const { return all_.empty(); }
  [[nodiscard]] bool HasBodies() const;
  [[nodiscard]] bool HasLayers() const { return layer() != nullptr; }
  [[nodiscard]] std::size_t bands() const { return bands_; }
  [[nodiscard]] const MediaList& all() const { return all_; }
  /// Returns the first layer; null: none.
  [[nodiscard]] const ExponentialLayer* layer() const;

 private:
  MediaList all_;
  std::size_t bands_;
};

}  // namespace alpenglow::renderer
