// SPDX-License-Identifier: MIT
#include "viewer/passes/frame.h"

#include <utility>

namespace alpenglow::viewer {
namespace {

std::vector<SkyDisk> DisksIn(const PaintedView& view, const FrameSky& sky) {
  std::vector<SkyDisk> disks{
      {LightSource::kSun, DirectionOf(sky.sun).seen, sky.sun.angular_radius_rad()}};
  if (sky.moon)
    disks.push_back({LightSource::kMoon, sky.moon->direction.seen, sky.moon->radius_rad});
  std::erase_if(disks, [&](const SkyDisk& disk) {
    return !PixelsOfDisk(disk.towards, disk.radius_rad, view);
  });
  return disks;
}

}  // namespace

Frame FrameOf(const PaintedView& view, std::shared_ptr<const FrameSky> sky,
              const std::optional<LandBend>& bend) {
  std::vector<SkyDisk> disks = DisksIn(view, *sky);
  return {view, std::move(sky), bend, std::move(disks)};
}

}  // namespace alpenglow::viewer
