// SPDX-License-Identifier: MIT
#include "renderer/shadow/sunlit_path.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "renderer/shadow/sunlight_over_edge.h"

namespace alpenglow::renderer {

double SunlightOverEdge(double x) {
  if (x >= 1.0) return 1.0;
  if (x <= -1.0) return 0.0;
  return shared::SunlightOverEdge(x);
}

double SunlightAt(const SunlitPath& path, double distance_m) {
  for (const SunlitPiece& piece : path) {
    if (distance_m < piece.begin_m || distance_m > piece.end_m) continue;
    if (piece.begin_x == piece.end_x) return SunlightOverEdge(piece.begin_x);
    const double share = (distance_m - piece.begin_m) / piece.length_m();
    return SunlightOverEdge(piece.begin_x + share * (piece.end_x - piece.begin_x));
  }
  return 0.0;
}

void SunlitPathBuilder::Add(const SunlitPiece& piece) {
  if (!(piece.begin_m < piece.end_m)) return;
  const double begin_x = std::clamp(piece.begin_x, -1.0, 1.0);
  const double end_x = std::clamp(piece.end_x, -1.0, 1.0);
  if (begin_x <= -1.0 && end_x <= -1.0) {
    Close();
    return;
  }
  Extend({piece.begin_m, piece.end_m, begin_x, end_x});
}

void SunlitPathBuilder::Extend(const SunlitPiece& piece) {
  const auto is_full = [](const SunlitPiece& p) { return p.begin_x >= 1.0 && p.end_x >= 1.0; };
  const bool touches = open_ && open_->end_m == piece.begin_m &&
                       std::abs(open_->end_x - piece.begin_x) <= kTolerance &&
                       is_full(*open_) == is_full(piece);
  const double begin_m = touches ? open_->begin_m : piece.begin_m;
  const double begin_x = touches ? open_->begin_x : piece.begin_x;
  const double slope = (piece.end_x - begin_x) / (piece.end_m - begin_m);
  const double play = kTolerance / (piece.end_m - begin_m);
  if (touches && slope >= least_slope_ && slope <= most_slope_) {
    open_->end_m = piece.end_m;
    open_->end_x = piece.end_x;
    least_slope_ = std::max(least_slope_, slope - play);
    most_slope_ = std::min(most_slope_, slope + play);
    return;
  }
  Close();
  open_ = piece;
  const double own_slope = (piece.end_x - piece.begin_x) / piece.length_m();
  const double own_play = kTolerance / piece.length_m();
  least_slope_ = own_slope - own_play;
  most_slope_ = own_slope + own_play;
}

void SunlitPathBuilder::Close() {
  if (open_) path_.push_back(*open_);
  open_.reset();
}

SunlitPath SunlitPathBuilder::Take() {
  Close();
  return std::exchange(path_, {});
}

}  // namespace alpenglow::renderer
