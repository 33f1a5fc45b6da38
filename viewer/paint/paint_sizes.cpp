// SPDX-License-Identifier: MIT
#include "viewer/paint/paint_sizes.h"

namespace alpenglow {

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
      break;
  }
  return sizes;
}

}  // namespace alpenglow
