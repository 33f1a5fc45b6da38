// SPDX-License-Identifier: MIT
#include "renderer/lit_clouds/shared_cloud_light.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <utility>

namespace alpenglow::renderer {
namespace {

// Widths of the weights: squared pixels, and logarithms of light and distance.
constexpr double kSquaredReach = 1.5, kSameLogLight = 0.35, kSameLogDistance = 0.02;
// Rays around one count if their weights sum up to this at least; a ray itself has 1.
constexpr double kLeastAround = 0.05;
// Rays this near to the middle of a pixel are its ray.
constexpr double kMiddleWithin = 1e-3;
// Blocks of small pictures that are always kept, and rows of blocks that each thread needs.
constexpr std::size_t kFewBlocks = 8192, kRowsPerThread = 3;

std::size_t BlocksAlong(int pixels) {
  return static_cast<std::size_t>((pixels + SharedCloudLight::kBlock - 1) /
                                  SharedCloudLight::kBlock);
}

std::size_t SlotsOf(const PixelRays& pixels) {
  const std::size_t columns = BlocksAlong(pixels.columns);
  const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  return std::min(columns * BlocksAlong(pixels.rows),
                  std::max(kFewBlocks, kRowsPerThread * threads * columns));
}

/// Returns the share of the weight that depends on the ratio of two values.
double LikeRatio(double value, double of, double same_log) {
  if (!(value > 0.0 && of > 0.0)) return value == of ? 1.0 : 0.0;
  return std::exp(-0.5 * std::pow(std::log(value / of) / same_log, 2));
}

}  // namespace

std::optional<std::array<double, 3>> SharedLight(const CloudRayPart& part,
                                                 const std::vector<CloudPartAround>& around) {
  std::array<double, 3> shared{};
  for (std::size_t source = 0; source < shared.size(); ++source) {
    double weights = 0.0, fast = 0.0, light = 0.0;
    for (const auto& [other, squared_pixels] : around) {
      const double weight = std::exp(-squared_pixels / kSquaredReach) *
                            LikeRatio(other->distance_m, part.distance_m, kSameLogDistance) *
                            LikeRatio(other->fast[source], part.fast[source], kSameLogLight);
      weights += weight;
      fast += weight * other->fast[source];
      light += weight * other->light[source];
    }
    if (weights < kLeastAround) return std::nullopt;
    shared[source] = fast > 0.0 ? part.fast[source] * light / fast : light / weights;
  }
  return shared;
}

/// The rays of 8 x 8 pixels, each from the time on when it was first needed.
struct SharedCloudLight::Block {
  using Parts = std::vector<CloudRayPart>;

  explicit Block(std::size_t of) : number(of) {}
  Block(const Block&) = delete;
  Block& operator=(const Block&) = delete;
  ~Block() {
    for (const std::atomic<const Parts*>& each : pixel) delete each.load();
  }

  /// Returns the parts of a pixel's ray. Threads that need a new one at the same time each trace it,
  /// with equal results, and the first one's is kept.
  template <typename Made>
  [[nodiscard]] const Parts& At(std::size_t index, const Made& made) {
    std::atomic<const Parts*>& kept = pixel[index];
    if (const Parts* known = kept.load(std::memory_order_acquire)) return *known;
    auto traced = std::make_unique<const Parts>(made());
    const Parts* before = nullptr;
    if (kept.compare_exchange_strong(before, traced.get(), std::memory_order_acq_rel)) {
      return *traced.release();
    }
    return *before;
  }

  std::size_t number;
  std::array<std::atomic<const Parts*>, std::size_t{kBlock} * kBlock> pixel{};
};

/// The rays through the pixels around a place. It holds their blocks.
class SharedCloudLight::Around {
 public:
  Around(const SharedCloudLight& shared, const std::array<double, 2>& place, const Trace& trace)
      : shared_(shared), trace_(trace) {
    const PixelRays& pixels = shared.pixels_;
    const int x = static_cast<int>(std::floor(place[0])),
              y = static_cast<int>(std::floor(place[1]));
    for (int row = std::max(y - 1, 0); row <= std::min(y + 1, pixels.rows - 1); ++row) {
      for (int column = std::max(x - 1, 0); column <= std::min(x + 1, pixels.columns - 1);
           ++column) {
        const double right = column + 0.5 - place[0], down = row + 0.5 - place[1];
        rays_.push_back({column, row, right * right + down * down});
      }
    }
  }

  /// Returns the parts of the ray at the place itself; null if it is not in the middle of a pixel.
  [[nodiscard]] const std::vector<CloudRayPart>* Own() {
    for (const Ray& ray : rays_) {
      if (ray.squared_pixels < kMiddleWithin * kMiddleWithin) return &PartsOf(ray);
    }
    return nullptr;
  }

  [[nodiscard]] std::optional<std::array<double, 3>> LightOf(const CloudRayPart& part) {
    std::vector<CloudPartAround> around;
    for (const Ray& ray : rays_) {
      for (const CloudRayPart& other : PartsOf(ray)) {
        if (other.layer != part.layer || other.chord != part.chord) continue;
        around.push_back({&other, ray.squared_pixels});
      }
    }
    return SharedLight(part, around);
  }

 private:
  struct Ray {
    int column, row;
    double squared_pixels;
  };

  [[nodiscard]] const std::vector<CloudRayPart>& PartsOf(const Ray& ray) {
    const std::size_t number = static_cast<std::size_t>(ray.row / kBlock) * shared_.block_columns_ +
                               static_cast<std::size_t>(ray.column / kBlock);
    auto block = std::find_if(blocks_.begin(), blocks_.end(),
                              [&](const auto& known) { return known->number == number; });
    if (block == blocks_.end()) block = blocks_.insert(block, shared_.BlockOf(number));
    const auto index = static_cast<std::size_t>(ray.row % kBlock * kBlock + ray.column % kBlock);
    return (*block)->At(index,
                        [&] { return trace_(shared_.pixels_.ray(ray.column, ray.row), true); });
  }

  const SharedCloudLight& shared_;
  const Trace& trace_;
  std::vector<Ray> rays_;
  std::vector<std::shared_ptr<Block>> blocks_;
};

SharedCloudLight::SharedCloudLight(PixelRays pixels)
    : pixels_(std::move(pixels)),
      block_columns_(BlocksAlong(pixels_.columns)),
      kept_(std::make_shared<Kept>(SlotsOf(pixels_))) {}

std::shared_ptr<SharedCloudLight::Block> SharedCloudLight::BlockOf(std::size_t number) const {
  Kept::Slot& slot = kept_->slot[number % kept_->slot.size()];
  const std::lock_guard lock(slot.taking);
  if (!slot.block || slot.block->number != number) slot.block = std::make_shared<Block>(number);
  return slot.block;
}

std::vector<CloudRayPart> SharedCloudLight::Parts(const PixelRays::Ray& ray,
                                                  const Trace& trace) const {
  const auto place = pixels_.place(ray.direction);
  const bool is_inside = place && (*place)[0] >= 0.0 && (*place)[0] < pixels_.columns &&
                         (*place)[1] >= 0.0 && (*place)[1] < pixels_.rows;
  if (!is_inside) return trace(ray, true);
  Around around(*this, *place, trace);
  const std::vector<CloudRayPart>* own = around.Own();
  std::vector<CloudRayPart> parts = own != nullptr ? *own : trace(ray, false);
  for (CloudRayPart& part : parts) {
    const auto light = around.LightOf(part);
    if (!light) return trace(ray, true);
    part.light = *light;
  }
  return parts;
}

}  // namespace alpenglow::renderer
