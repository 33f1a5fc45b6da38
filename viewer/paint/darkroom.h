// SPDX-License-Identifier: MIT
// From what a SkyPainter painted to what a screen shows. A picture smaller than the screen is
// developed as small as it is and enlarged by the edges that land has on the screen: light costs by
// what is painted, edges do not suffer.
#pragma once

#include <optional>
#include <vector>

#include "viewer/gl/render_target.h"
#include "viewer/land/land_outline.h"
#include "viewer/paint/developer.h"
#include "viewer/paint/enlarger.h"
#include "viewer/paint/sky_painter.h"

namespace alpenglow::viewer {

class Darkroom {
 public:
  explicit Darkroom(const Look& look,
                    Developer::FirstPictures first = Developer::FirstPictures::kWait)
      : developer_(look, first) {}

  [[nodiscard]] Developer& developer() { return developer_; }
  [[nodiscard]] const Developer& developer() const { return developer_; }

  /// Whether a view will be enlarged on a screen, with disks and stars as sharp as that: its picture is
  /// to be painted without them.
  [[nodiscard]] static bool Enlarges(const PaintedView& view, const Developer::Screen& screen) {
    return view.width < screen.width || view.height < screen.height;
  }
  /// Shows the picture that was painted last, of this view.
  void Print(SkyPainter& painter, const PaintedView& view, double ev100,
             const Developer::Screen& screen);

 private:
  void PrintEnlarged(SkyPainter& painter, const PaintedView& view, double ev100,
                     const Developer::Screen& screen);
  void PrintBodies(SkyPainter& painter, const PaintedView& view, double ev100,
                   const Developer::Screen& screen, const std::vector<PixelBox>& boxes);
  void MakeReady(SkyPainter& painter, const PaintedView& view, double ev100,
                 const Developer::Screen& screen);

  Developer developer_;
  Enlarger code_enlarger_{Enlarger::Shows::kCodes}, light_enlarger_{Enlarger::Shows::kLight};
  std::optional<RenderTarget> codes_, light_;  // of the picture's size; of the screen's
  std::optional<LandOutline> outline_;
  PassArea bodies_;
  int prints_ = 0;
};

}  // namespace alpenglow::viewer
