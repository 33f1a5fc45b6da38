// SPDX-License-Identifier: MIT
#include "renderer/specular/beam_media.h"

#include <algorithm>
#include <cmath>

namespace alpenglow::renderer {
namespace {

bool IsEven(const SpectrumOf<double>& spectrum) {
  return std::ranges::all_of(spectrum.values(), [&](double value) { return value == spectrum[0]; });
}

bool AreGrey(const LocalMedia& media) {
  return std::ranges::all_of(media.all(), [](const auto& medium) {
    return IsEven(medium->optics().extinction_per_m) && IsEven(medium->optics().scattering_per_m);
  });
}

}  // namespace

ColumnsOnRay::ColumnsOnRay(const LocalMedia& media, const glm::dvec3& origin,
                           const glm::dvec3& direction, const RaySpan& span)
    : media_(media.all().size()), begin_m_(span.begin_m) {
  const double step_m = (span.end_m - span.begin_m) / kSteps;
  per_step_ = step_m > 0.0 ? 1.0 / step_m : 0.0;
  column_m_.reserve((kSteps + 1) * media_);
  for (std::size_t knot = 0; knot <= kSteps; ++knot) {
    const double distance_m = begin_m_ + static_cast<double>(knot) * step_m;
    for (const auto& medium : media.all())
      column_m_.push_back(medium->Column(origin, direction, distance_m));
  }
}

double ColumnsOnRay::At(std::size_t medium, double distance_m) const {
  const double place =
      std::clamp((distance_m - begin_m_) * per_step_, 0.0, static_cast<double>(kSteps));
  const std::size_t knot = std::min(static_cast<std::size_t>(place), kSteps - 1);
  const double share = place - static_cast<double>(knot);
  return (1.0 - share) * column_m_[knot * media_ + medium] +
         share * column_m_[(knot + 1) * media_ + medium];
}

double LargestDepth(const LocalMedia& media, const PhotonBeam& beam) {
  double depth = 0.0;
  for (const auto& medium : media.all()) {
    const double column_m = medium->Column(beam.origin, beam.direction, beam.length_m);
    double largest = 0.0;
    for (const double value : medium->optics().extinction_per_m.values())
      largest = std::max(largest, value);
    depth += largest * column_m;
  }
  return depth;
}

ScatteredLight::ScatteredLight(const LocalMedia& media)
    : media_(media), is_grey_(AreGrey(media)), sum_(media.bands()) {}

void ScatteredLight::Add(const ScatteredBeam& beam) {
  const std::size_t bands = is_grey_ ? std::min<std::size_t>(1, sum_.size()) : sum_.size();
  const MediaList& all = media_.all();
  for (std::size_t band = 0; band < bands; ++band) {
    double depth = 0.0;
    for (std::size_t m = 0; m < all.size(); ++m)
      depth += all[m]->optics().extinction_per_m[band] * beam.columns_m[m];
    const double left = beam.weight * std::exp(-depth);
    for (const auto& medium : all) {
      const double density = medium->DensityAt(beam.point);
      if (density <= 0.0) continue;
      const MediumOptics& optics = medium->optics();
      sum_[band] +=
          left * density * optics.scattering_per_m[band] * Phase(optics.phase, beam.cos_scattering);
    }
  }
}

SpectrumOf<double> ScatteredLight::Sum() const {
  return is_grey_ && sum_.size() > 0 ? SpectrumOf<double>(sum_.size(), sum_[0]) : sum_;
}

}  // namespace alpenglow::renderer
