// SPDX-License-Identifier: MIT
#include "renderer/media/local_media.h"

#include <algorithm>

#include "renderer/media/local_volume.h"

namespace alpenglow::renderer {

LocalMedia::LocalMedia(const Scene& scene, const SceneGround& ground, const Medium& medium)
    : bands_(medium.wavelengths_nm.size()) {
  for (const auto media_of : {VolumesOf, LayersOf}) {
    const MediaList media = media_of(scene, ground, medium);
    all_.insert(all_.end(), media.begin(), media.end());
  }
}

LocalMedia LocalMedia::Only(bool bodies, bool layers) const {
  LocalMedia some = *this;
  std::erase_if(some.all_,
                [&](const auto& medium) { return medium->IsLayer() ? !layers : !bodies; });
  return some;
}

bool LocalMedia::HasBodies() const {
  return std::any_of(all_.begin(), all_.end(),
                     [](const auto& medium) { return !medium->IsLayer(); });
}

const ExponentialLayer* LocalMedia::layer() const {
  for (const auto& medium : all_) {
    if (const auto* layer = dynamic_cast<const ExponentialLayer*>(medium.get())) return layer;
  }
  return nullptr;
}

}  // namespace alpenglow::renderer
