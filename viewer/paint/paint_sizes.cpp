// SPDX-License-Identifier: MIT
#include "viewer/paint/paint_sizes.h"

#include <algorithm>
#include <cmath>

namespace alpenglow::viewer {
namespace {

// At least two: with one, passes are left out and programs are others.
int Scaled(int pixels, double scale) {
  return std::max(static_cast<int>(std::lround(pixels * scale)), 2);
}

}  // namespace

PaintSizes SizesOf(Quality quality) {
  PaintSizes sizes;
  switch (quality) {
    case Quality::kLow:
      sizes.air = AirQuality::kLow;
      sizes.land_detail = 64.0;
      sizes.shade = kLowShade;
      sizes.lamps = kLowLamps;
      sizes.fog = kCoarseFog;
      sizes.dropped_octaves = 1;
      break;
    case Quality::kMedium:
      sizes.dropped_octaves = 1;
      break;
    case Quality::kHigh:
    case Quality::kReference:
      sizes.air = AirQuality::kHigh;
      sizes.land_detail = 1024.0;
      sizes.shade = kHighShade;
      sizes.lamps = kHighLamps;
      sizes.fog = kFineFog;
      sizes.sky_by_pixel = true;
      break;
  }
  return sizes;
}

PaintSizes SizesOf(const PaintedQuality& painted) {
  PaintSizes sizes = SizesOf(painted.quality);
  if (painted.saving >= Saving::kCoarseShafts) sizes.shade.detail = kCoarseShafts;
  if (painted.saving >= Saving::kFewLamps) sizes.most_lamps = 12;
  if (painted.saving >= Saving::kNearLand) sizes.land_growth = 1.0;
  const double usual = PaintedAlways(painted.quality).scale;
  if (painted.scale < usual) {
    const double scale = painted.scale / usual;
    sizes.shade.detail.scale = Scaled(sizes.shade.detail.scale, scale);
    sizes.lamps.step = Scaled(sizes.lamps.step, scale);
  }
  return sizes;
}

}  // namespace alpenglow::viewer
