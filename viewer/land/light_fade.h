// SPDX-License-Identifier: MIT
// Light of vertices that is made beside drawing and fades into what is shown.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "viewer/land/chunk_buffers.h"

namespace alpenglow::viewer {

/// Directions towards the disks before which vertices have their edges of shade, of the light that fades and
/// of the one that is shown; nothing without such light.
struct EdgesOfVertices {
  std::optional<Vector<Ecef>> from, to;
};

/// One light after another: the next begins when the one before is all there and shown. The first is
/// shown at once.
class LightFade {
 public:
  /// To follow; asked again meanwhile, the newest follows.
  void Ask(LightOfVertices light) { asked_ = std::move(light); }
  /// Whether any light has been all there.
  [[nodiscard]] bool HasShown() const { return lights_shown_ > 0; }
  [[nodiscard]] bool IsChanging() const { return asked_ || is_filling_ || share_ < 1.0; }

  /// The light of vertices that are made now, and its number; empty before the first.
  [[nodiscard]] const std::optional<LightOfVertices>& light() const { return light_; }
  [[nodiscard]] int number() const { return number_; }
  /// Whether the side that is not shown is being filled with it.
  [[nodiscard]] bool IsFilling() const { return is_filling_; }

  /// What is shown goes from `from` to the other side by a share; `from` is the one to be filled.
  [[nodiscard]] LightSide from() const { return from_; }
  [[nodiscard]] double share() const { return lights_shown_ > 1 ? share_ : 1.0; }
  [[nodiscard]] EdgesOfVertices edges() const {
    return {share() < 1.0 ? to_disk_[Index(from_)] : std::nullopt, to_disk_[Index(Other(from_))]};
  }

  /// @param is_complete  whether all vertices have the light.
  void Advance(double seconds, bool is_complete) {
    share_ = std::min(share_ + seconds / std::max(filled_in_s_, 0.2), 1.0);
    if (is_filling_) filled_in_s_ += seconds;
    if (is_filling_ && is_complete && share_ == 1.0) {
      is_filling_ = false;
      from_ = Other(from_);
      share_ = 0.0;
      ++lights_shown_;
    }
    // The side that is faded from must stay as it is until the fading ends.
    if (!is_filling_ && asked_ && share_ == 1.0) Begin();
  }

 private:
  [[nodiscard]] static constexpr std::size_t Index(LightSide side) {
    return static_cast<std::size_t>(side);
  }
  void Begin() {
    light_ = std::exchange(asked_, std::nullopt);
    ++number_;
    is_filling_ = true;
    filled_in_s_ = 0.0;
    to_disk_[Index(from_)] = light_->to_disk;
  }

  std::optional<LightOfVertices> light_, asked_;
  std::array<std::optional<Vector<Ecef>>, 2> to_disk_;  // of the sides
  int number_ = 0;
  bool is_filling_ = false;
  int lights_shown_ = 0;
  LightSide from_ = LightSide::kSecond;
  double share_ = 1.0;        // of the way to the other side
  double filled_in_s_ = 0.0;  // the last one
};

}  // namespace alpenglow::viewer
