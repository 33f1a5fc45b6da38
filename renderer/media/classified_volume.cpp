// SPDX-License-Identifier: MIT
#include "renderer/media/classified_volume.h"

#include <algorithm>
#include <glm/common.hpp>
#include <utility>

namespace alpenglow::renderer {
namespace {

double LargestIn(const VolumeGrid& grid, const TransferFunction& transfer) {
  const auto [least, largest] = std::minmax_element(grid.values().begin(), grid.values().end());
  return transfer.LargestExtinction(static_cast<double>(*least), static_cast<double>(*largest));
}

/// Returns the mean optics of a grid from at most 64 points along each side: the albedo weighted by
/// scattering, since it is that of scattered light, and the emission by extinction.
MediumOptics MeanOptics(const VolumeGrid& grid, const TransferFunction& transfer,
                        const PhaseFunction& phase, std::size_t bands) {
  constexpr int kMostPoints = 64;
  std::array<int, 3> count = grid.size();
  for (int& side : count) side = std::min(side, kMostPoints);
  double extinction = 0.0;
  SpectrumOf<double> scattering(bands), twice(bands), emission(bands);
  for (int i = 0; i < count[0] * count[1] * count[2]; ++i) {
    const glm::dvec3 cell(i % count[0], i / count[0] % count[1], i / (count[0] * count[1]));
    const double value = grid.At((cell + 0.5) / glm::dvec3(count[0], count[1], count[2]));
    const double here = transfer.Extinction(value);
    if (here == 0.0) continue;
    const TransferFunction::Colour colour = transfer.ColourOf(value);
    extinction += here;
    scattering = scattering + here * colour.albedo;
    twice = twice + here * (colour.albedo * colour.albedo);
    emission = emission + here * colour.emission;
  }
  const double largest_per_m = LargestIn(grid, transfer);
  MediumOptics mean{SpectrumOf<double>(bands, largest_per_m), SpectrumOf<double>(bands),
                    SpectrumOf<double>(bands), phase};
  for (std::size_t band = 0; band < bands; ++band) {
    if (scattering[band] > 0.0)
      mean.scattering_per_m[band] = largest_per_m * std::min(twice[band] / scattering[band], 1.0);
    if (extinction > 0.0) mean.emission_per_m[band] = largest_per_m * emission[band] / extinction;
  }
  return mean;
}

/// Stretches of a line along which a transfer function is linear in the value.
class LinearStretches {
 public:
  LinearStretches(const TransferFunction& transfer, double largest_per_m)
      : transfer_(transfer), largest_per_m_(largest_per_m) {}

  /// Takes the next piece of the line; values on it lie in [least, largest].
  void Add(double begin, double end, double least, double largest) {
    if (!(begin < end)) return;
    const bool continues =
        is_open_ && open_.end == begin &&
        transfer_.IsLinear(std::min(least, open_.least), std::max(largest, open_.largest));
    if (continues) {
      open_ = {open_.begin, end, std::min(least, open_.least), std::max(largest, open_.largest)};
      return;
    }
    Close();
    open_ = {begin, end, least, largest};
    is_open_ = true;
  }
  void Close() {
    if (!is_open_) return;
    const double most = transfer_.LargestExtinction(open_.least, open_.largest);
    if (most > 0.0) pieces_.push_back({open_.begin, open_.end, most / largest_per_m_});
    is_open_ = false;
  }
  [[nodiscard]] std::vector<DensePiece> Take() { return std::move(pieces_); }

 private:
  const TransferFunction& transfer_;
  double largest_per_m_;
  // Not std::optional: g++ 12 takes its value for uninitialised.
  ValuePiece open_{};
  bool is_open_ = false;
  std::vector<DensePiece> pieces_;
};

/// Adds the pieces of a block whose values cross nodes.
void AddCubics(const std::vector<CubicPiece>& cubics, const TransferFunction& transfer,
               LinearStretches& stretches) {
  for (const CubicPiece& cubic : cubics) {
    const std::vector<double> at = transfer.Crossings(cubic);
    const auto [least, largest] =
        std::minmax_element(cubic.coefficients.begin(), cubic.coefficients.end());
    for (std::size_t i = 0; i + 1 < at.size(); ++i) {
      const double length = cubic.end - cubic.begin;
      const double begin = i == 0 ? cubic.begin : cubic.begin + at[i] * length;
      const double end = i + 2 == at.size() ? cubic.end : cubic.begin + at[i + 1] * length;
      if (at.size() == 2) {
        stretches.Add(begin, end, *least, *largest);
        continue;
      }
      // Values between two crossings lie between two nodes: those around the value in the middle.
      const double middle = cubic.At(0.5 * (at[i] + at[i + 1]));
      const auto [low, high] = transfer.NodesAround(middle);
      stretches.Add(begin, end, std::max(*least, low), std::min(*largest, high));
    }
  }
}

}  // namespace

ClassifiedVolume::ClassifiedVolume(const VolumePlacement& placement,
                                   std::shared_ptr<const VolumeGrid> grid,
                                   std::shared_ptr<const TransferFunction> transfer,
                                   const PhaseFunction& phase, ScatteringOrders orders)
    : LocalBody(placement, MeanOptics(*grid, *transfer, phase, transfer->bands()), orders),
      grid_(std::move(grid)),
      transfer_(std::move(transfer)),
      largest_per_m_(LargestIn(*grid_, *transfer_)) {}

std::optional<BodyColour> ClassifiedVolume::ColourAt(const glm::dvec3& point) const {
  const TransferFunction::Colour colour = transfer_->ColourOf(grid_->At(UnitFromFrame(point)));
  return BodyColour{largest_per_m_ * colour.albedo, largest_per_m_ * colour.emission};
}

double ClassifiedVolume::DensityAt(const glm::dvec3& point) const {
  if (!Contains(point) || IsVoid()) return 0.0;
  return transfer_->Extinction(grid_->At(UnitFromFrame(point))) / largest_per_m_;
}

std::vector<DensePiece> ClassifiedVolume::PiecesAlong(const glm::dvec3& origin,
                                                      const glm::dvec3& direction,
                                                      double length_m) const {
  const std::optional<LineSpan> span = SpanAlong(origin, direction, length_m);
  if (!span || IsVoid()) return {};
  const glm::dvec3 start = UnitFromFrame(origin), step = UnitsPerMetre(direction);
  LinearStretches stretches(*transfer_, largest_per_m_);
  for (const ValuePiece& block : grid_->BlocksAlong(start, step, span->begin_m, span->end_m)) {
    stretches.Close();  // no piece is longer than a block
    if (transfer_->IsLinear(block.least, block.largest)) {
      stretches.Add(block.begin, block.end, block.least, block.largest);
    } else {
      AddCubics(grid_->CubicsAlong(start, step, block.begin, block.end), *transfer_, stretches);
    }
  }
  stretches.Close();
  return stretches.Take();
}

double ClassifiedVolume::Column(const glm::dvec3& origin, const glm::dvec3& direction,
                                double length_m) const {
  const std::optional<LineSpan> span = SpanAlong(origin, direction, length_m);
  if (!span || IsVoid()) return 0.0;
  const glm::dvec3 start = UnitFromFrame(origin), step = UnitsPerMetre(direction);
  double sum = 0.0;
  for (const ValuePiece& block : grid_->BlocksAlong(start, step, span->begin_m, span->end_m)) {
    if (transfer_->LargestExtinction(block.least, block.largest) == 0.0) continue;
    for (const CubicPiece& cubic : grid_->CubicsAlong(start, step, block.begin, block.end))
      sum += transfer_->Integral(cubic);
  }
  return sum / largest_per_m_;
}

}  // namespace alpenglow::renderer
