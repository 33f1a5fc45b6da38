// SPDX-License-Identifier: MIT
#include "renderer/series/frame_list.h"

#include <fmt/format.h>

#include "atmosphere/number/constants.h"
#include "atmosphere/sun/eclipse.h"
#include "atmosphere/sun/moon.h"
#include "atmosphere/sun/sun.h"

namespace alpenglow::renderer {
namespace {

std::string LineOf(const Frame& frame, const FrameListing& listing) {
  const GeodeticPosition place = listing.place_of(frame);
  const SunPosition sun = SunAt(place, frame.instant);
  const MoonPosition moon = MoonAt(place, frame.instant);
  return fmt::format("{},{},{},{:.3f},{:.3f},{:.4f},{:.3f},{:.3f},{:.3f},{}\n", frame.number,
                     FormatUtc(frame.instant),
                     listing.zone ? FormatInZone(frame.instant, *listing.zone) : "",
                     sun.azimuth_rad / kRadiansPerDegree, sun.elevation_rad / kRadiansPerDegree,
                     CoveredLight(place, frame.instant), moon.azimuth_rad / kRadiansPerDegree,
                     moon.elevation_rad / kRadiansPerDegree, moon.IlluminatedFraction(),
                     listing.name ? listing.name->Exr(frame.number).string() : "");
}

}  // namespace

std::string ListOf(const std::vector<Frame>& frames, const FrameListing& listing) {
  std::string text =
      "frame,utc,local_time,sun_azimuth_deg,sun_elevation_deg,sun_covered,moon_azimuth_deg,"
      "moon_elevation_deg,moon_illuminated,file\n";
  for (const Frame& frame : frames) text += LineOf(frame, listing);
  return text;
}

}  // namespace alpenglow::renderer
