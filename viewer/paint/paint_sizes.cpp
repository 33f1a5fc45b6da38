// SPDX-License-Identifier: MIT
#include "viewer/paint/paint_sizes.h"

namespace alpenglow {

PaintSizes SizesOf(Quality quality) {
  PaintSizes sizes;
  switch (quality) {
    case Quality::kLow:
      sizes.air = AirQuality::kLow;
      sizes.land_detail = 64.0;
      sizes.shafts = {8, {3, 5}};
      sizes.shade.samples = sizes.shade.cells = 512;
      sizes.lamps = {8, 4};
      sizes.relief_pixels = 2.0;
      break;
    case Quality::kMedium:
      sizes.lamps = {12, 4};
      break;
    case Quality::kHigh:
    case Quality::kReference:
      sizes.air = AirQuality::kHigh;
      sizes.land_detail = 256.0;
      sizes.shafts = {1, {6, 12}};
      sizes.shade.samples = sizes.shade.cells = 2048;
      sizes.lamps = {16, 1};
      break;
  }
  return sizes;
}

}  // namespace alpenglow
