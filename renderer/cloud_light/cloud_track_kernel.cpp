// SPDX-License-Identifier: MIT
#include "renderer/cloud_light/cloud_track_kernel.h"

#include "atmosphere/ray/batch.h"

namespace alpenglow::renderer {
namespace {

using Lanes = BatchOf<float>;
using Batch = Lanes::Type;

#ifdef ALPENGLOW_BATCHES
inline Batch LoadAnywhere(const float* from) { return Batch::load_unaligned(from); }
#else
inline Batch LoadAnywhere(const float* from) { return *from; }
#endif

/// The tracks of one line, with a window on those above the columns of the current segment.
class LineOfTracks {
 public:
  explicit LineOfTracks(const CloudTrackWork& work, std::size_t room)
      : work_(work), window_(work.track + (room - work.columns) / 2) {
    for (std::size_t i = 0; i < room; ++i) work.track[i] = work.entering;
  }

  /// Moves all tracks by one column. Tracks that leave a periodic field at one side enter it at the
  /// other one.
  void Shift(int columns) {
    const std::size_t last = work_.columns - 1;
    if (columns > 0) {
      --window_;
      window_[0] = work_.is_periodic ? window_[last + 1] : work_.entering;
    } else if (columns < 0) {
      ++window_;
      window_[last] = work_.is_periodic ? window_[-1] : work_.entering;
    }
  }
  [[nodiscard]] float* At(std::size_t column) const { return window_ + column; }

 private:
  const CloudTrackWork& work_;
  float* window_;
};

inline void PassClearCells(float* light, float* sum_m, float length_m) {
  for (std::size_t i = 0; i < kCloudLanes; i += Lanes::kLanes) {
    const Batch mean = LoadAnywhere(light + i);
    Lanes::Store(sum_m + i, Lanes::Load(sum_m + i) + mean * Batch(length_m));
  }
}

/// Returns the source in the middle of a segment.
template <bool kInSpace>
inline Batch SourceOf(const CloudTrackWork& work, const CloudTrackStep& step, std::size_t at,
                      const Batch& slope) {
  const Batch source = Lanes::Load(work.source + at);
  if constexpr (!kInSpace) return source + slope * Batch(step.offset_m);
  const auto& [x, y, z] = work.slopes_per_m;
  return source + Lanes::Load(x + at) * Batch(step.offsets_m[0]) +
         Lanes::Load(y + at) * Batch(step.offsets_m[1]) +
         Lanes::Load(z + at) * Batch(step.offsets_m[2]);
}

template <bool kInSpace>
inline void PassCloud(const CloudTrackWork& work, const CloudTrackStep& step, std::size_t at,
                      float* tracks) {
  using namespace shared;
  const Batch one(1.0F), half(0.5F), length(step.length_m);
  for (std::size_t i = 0; i < kCloudLanes; i += Lanes::kLanes) {
    const Batch t = Lanes::Load(work.extinction_per_m + at + i) * length;
    const Batch slope = Lanes::Load(work.slope_per_m + at + i);
    const Batch source = SourceOf<kInSpace>(work, step, at + i, slope);
    const Batch light = LoadAnywhere(tracks + i);
    const Batch left = exp(Batch(-t));
    const Batch divisor = max(t, Batch(0.03F));
    // Below 0.03 the differences cancel; the series have errors of 5e-7 there.
    const auto is_thin = t < Batch(0.03F);
    const Batch p = select(is_thin, Batch(one - t * (half - t * Batch(1.0F / 6.0F))),
                           Batch((one - left) / divisor));
    const Batch q = select(is_thin, Batch(t * (t * Batch(1.0F / 24.0F) - Batch(1.0F / 12.0F))),
                           Batch((p - half * (one + left)) / divisor));
    const Batch mean = source + (light - source) * p + slope * length * q;
    Lanes::StoreAnywhere(tracks + i, light + t * (source - mean));
    Lanes::Store(work.sum_m + at + i, Lanes::Load(work.sum_m + at + i) + mean * length);
  }
}

/// Returns the line within the field, or a negative number outside of an open one.
inline int LineInField(const CloudTrackWork& work, int line) {
  if (work.is_periodic) {
    const int rest = line % work.lines;
    return rest < 0 ? rest + work.lines : rest;
  }
  return line < work.lines ? line : -1;
}

template <bool kInSpace>
double FollowLines(const CloudTrackWork& work, int first, int end) {
  std::size_t shifts = 0;
  for (std::size_t i = 0; i < work.step_count; ++i) shifts += work.steps[i].shift != 0 ? 1 : 0;
  const std::size_t room = CloudTrackRoom(work.columns, shifts);
  double leaving = 0.0;
  for (int entry = first; entry < end; ++entry) {
    LineOfTracks tracks(work, room);
    for (std::size_t i = 0; i < work.step_count; ++i) {
      const CloudTrackStep& step = work.steps[i];
      tracks.Shift(step.shift);
      const int line = LineInField(work, entry + step.line);
      if (line < 0) continue;
      const std::uint32_t* row = work.row_first + (step.level * work.lines + line);
      for (std::uint32_t run = row[0]; run < row[1]; ++run) {
        const CloudTrackRun& cells = work.runs[run];
        const std::size_t at = kCloudLanes * cells.block;
        if (cells.has_cloud) {
          PassCloud<kInSpace>(work, step, at, tracks.At(cells.column));
        } else {
          PassClearCells(tracks.At(cells.column), work.sum_m + at, step.length_m);
        }
      }
    }
    for (std::size_t column = 0; column < work.columns; ++column) {
      leaving += static_cast<double>(*tracks.At(column));
    }
    if (work.leaving == nullptr) continue;
    const int line = LineInField(work, entry + work.steps[work.step_count - 1].line);
    if (line < 0) continue;
    float* to = work.leaving + static_cast<std::size_t>(line) * work.columns;
    for (std::size_t column = 0; column < work.columns; ++column) to[column] = *tracks.At(column);
  }
  return leaving;
}

double Follow(const CloudTrackWork& work, int first, int end) {
  return work.slopes_per_m[0] != nullptr ? FollowLines<true>(work, first, end)
                                         : FollowLines<false>(work, first, end);
}

}  // namespace

const CloudTrackKernel& KernelOf(KernelName<CloudTrackKernel, kThisSet> /*name*/) {
  static constexpr CloudTrackKernel kernel{Follow};
  return kernel;
}

}  // namespace alpenglow::renderer
