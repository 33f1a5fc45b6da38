// SPDX-License-Identifier: MIT
#include "renderer/picture/pixel_writer.h"

#include <algorithm>

namespace alpenglow::renderer {

PixelWriter::PixelWriter(const BandColour& colour, int width, int height,
                         const std::vector<PictureLayer>& layers)
    : colour_(colour), image_(width, height) {
  for (const PictureLayer layer : layers) {
    const LayerKind& kind = KindOf(layer);
    if (std::any_of(planes_.begin(), planes_.end(),
                    [&](const Plane& plane) { return plane.kind.layer == layer; })) {
      continue;
    }
    planes_.push_back({kind, image_.layers.size()});
    for (const std::string& channel : kind.channels) {
      image_.layers.push_back({channel, std::vector<float>(image_.rgb.size(), 0.0F)});
    }
  }
}

void PixelWriter::Set(const Plane& plane, int x, int y, const LayerValues& values) {
  const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) +
                            static_cast<std::size_t>(x);
  for (std::size_t i = 0; i < plane.kind.channels.size(); ++i) {
    image_.layers[plane.first_channel + i].values[pixel] = values.at(i);
  }
}

void PixelWriter::Write(int x, int y, const PixelSum& rays) {
  Count(static_cast<std::uint64_t>(rays.rays));
  const auto rgb = colour_.LinearSrgb(InDouble(rays.MeanRadiance()));
  image_.at(x, y) = {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]),
                     static_cast<float>(rgb[2])};
  for (const Plane& plane : planes_) {
    if (plane.kind.of_rays != nullptr) Set(plane, x, y, plane.kind.of_rays(colour_, rays));
  }
}

void PixelWriter::Count(std::uint64_t rays) {
  rays_ += rays;
  for (std::uint64_t seen = least_; rays < seen && !least_.compare_exchange_weak(seen, rays);) {
  }
  for (std::uint64_t seen = most_; rays > seen && !most_.compare_exchange_weak(seen, rays);) {
  }
}

void PixelWriter::WriteMiddle(int x, int y, const Hit& hit) {
  for (const Plane& plane : planes_) {
    if (plane.kind.of_middle != nullptr) Set(plane, x, y, plane.kind.of_middle(hit));
  }
}

bool PixelWriter::AsksForMiddle() const {
  return std::any_of(planes_.begin(), planes_.end(),
                     [](const Plane& plane) { return plane.kind.of_middle != nullptr; });
}

Image PixelWriter::Take() { return std::move(image_); }

}  // namespace alpenglow::renderer
