// SPDX-License-Identifier: MIT
// A FogMap that follows eye and sun, made beside drawing.
#pragma once

#include <functional>
#include <optional>

#include "viewer/job/latest_job.h"
#include "viewer/lamps/fog_map.h"

namespace alpenglow::viewer {

/// Whether light around this eye and under this sun is that of the map, but for a few per cent: the
/// eye within a tenth of the fog's scale height, the sun within a tenth of a degree. What falls off
/// faster, transmittance and the phase function towards the sun, is not in the map.
[[nodiscard]] bool Serves(const FogMap& map, const FogView& view);

class FogFollower {
 public:
  using Make = std::function<FogMap(const FogView&)>;
  /// @param make  called on a thread of this; what it refers to must outlive this.
  explicit FogFollower(Make make) : job_(std::move(make)) {}

  /// Takes in what is finished and asks for what is needed. True when map() is a new one.
  [[nodiscard]] bool Follow(const FogView& view);
  /// Waits for a map for the view.
  void Wait(const FogView& view);
  [[nodiscard]] const std::optional<FogMap>& map() const { return map_; }

 private:
  std::optional<FogMap> map_;
  LatestJob<FogView, FogMap> job_;
};

}  // namespace alpenglow::viewer
