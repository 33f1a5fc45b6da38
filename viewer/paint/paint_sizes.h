// SPDX-License-Identifier: MIT
// What a quality means for each part of a picture.
#pragma once

#include <cstddef>

#include "viewer/air/air_tables.h"
#include "viewer/lamps/fog_map.h"
#include "viewer/lamps/lamp_painter.h"
#include "viewer/paint/auto_quality.h"
#include "viewer/shade/shade_quality.h"

namespace alpenglow::viewer {

struct PaintSizes {
  AirQuality air = AirQuality::kMedium;
  double land_detail = 96.0;  // LandSize::detail
  double land_growth = 4.0;   // LandSize::most_growth
  bool has_shafts = true;
  ShadeQuality shade = kMediumShade;
  LampQuality lamps = kMediumLamps;
  std::size_t most_lamps = kMostGpuLamps;
  FogMapSize fog;
  int dropped_octaves = 0;    // of the ground's detail
  bool sky_by_pixel = false;  // SkyByPixel instead of light of vertices, once it is there
};

/// kReference is drawn as kHigh until the renderer's picture is there.
[[nodiscard]] PaintSizes SizesOf(Quality quality);
/// With what is left out. Rays of shafts and of the light of lamps are as far apart on the screen, at
/// whatever scale light is painted.
[[nodiscard]] PaintSizes SizesOf(const PaintedQuality& painted);

}  // namespace alpenglow::viewer
