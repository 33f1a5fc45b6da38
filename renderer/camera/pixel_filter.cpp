// SPDX-License-Identifier: MIT
#include "renderer/camera/pixel_filter.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "atmosphere/number/constants.h"
#include "atmosphere/text/error.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {
namespace {

constexpr double kGaussianRadius = 1.5;
constexpr double kGaussianSigma = 0.5;
constexpr double kBlackmanHarrisRadius = 1.5;
// Four terms, side lobes below -92 dB: Harris (1978), Proc. IEEE 66, 51, table I.
constexpr std::array<double, 4> kBlackmanHarris{0.35875, 0.48829, 0.14128, 0.01168};

double RadiusOf(PixelFilter::Kind kind) {
  switch (kind) {
    case PixelFilter::Kind::kBox:
      return 0.5;
    case PixelFilter::Kind::kGaussian:
      return kGaussianRadius;
    case PixelFilter::Kind::kBlackmanHarris:
      return kBlackmanHarrisRadius;
  }
  throw InternalError("unknown kind of filter");
}

constexpr int kKnots = 513;       // of the inverse of the distribution, straight in between
constexpr int kFilterSteps = 16;  // of the trapezoidal rule between two points of the distribution

}  // namespace

double PixelFilter::Shape(double x) const {
  if (!(std::abs(x) < radius_)) return 0.0;
  switch (kind_) {
    case Kind::kBox:
      return 1.0;
    case Kind::kGaussian: {
      constexpr double kTwice = 2.0 * kGaussianSigma * kGaussianSigma;
      return std::exp(-x * x / kTwice) - std::exp(-radius_ * radius_ / kTwice);
    }
    case Kind::kBlackmanHarris: {
      double sum = 0.0;
      for (std::size_t k = 0; k < kBlackmanHarris.size(); ++k) {
        sum += kBlackmanHarris[k] * std::cos(static_cast<double>(k) * kPi * x / radius_);
      }
      return sum;
    }
  }
  throw InternalError("unknown kind of filter");
}

PixelFilter::PixelFilter(Kind kind) : kind_(kind), radius_(RadiusOf(kind)), integral_(1.0) {
  // The distribution on the positive side, tabulated over x, read backwards.
  std::vector<double> below{0.0};
  const double step = radius_ / (kKnots - 1);
  for (int i = 1; i < kKnots; ++i) {
    double area = 0.0;
    for (int k = 0; k < kFilterSteps; ++k) area += Shape(step * (i - 1 + (k + 0.5) / kFilterSteps));
    below.push_back(below.back() + area * step / kFilterSteps);
  }
  const double half = below.back();
  integral_ = 2.0 * half;
  for (int i = 0; i < kKnots; ++i) {
    const double wanted = half * i / (kKnots - 1);
    const auto above = std::clamp(std::upper_bound(below.begin(), below.end(), wanted),
                                  below.begin() + 1, below.end() - 1);
    const double low = *(above - 1), high = *above;
    const double share = high > low ? std::clamp((wanted - low) / (high - low), 0.0, 1.0) : 0.0;
    offsets_.push_back(step * (static_cast<double>(above - 1 - below.begin()) + share));
  }
}

double PixelFilter::Offset(double u) const {
  const double at = std::abs(2.0 * u - 1.0) * (kKnots - 1);
  const auto i = std::min(static_cast<std::size_t>(at), static_cast<std::size_t>(kKnots - 2));
  const double share = at - static_cast<double>(i);
  const double offset = (1.0 - share) * offsets_[i] + share * offsets_[i + 1];
  return u < 0.5 ? -offset : offset;
}

double PixelFilter::Weight(double x) const { return Shape(x) / integral_; }

const std::vector<std::string>& PixelFilterNames() {
  static const std::vector<std::string> names{"box", "gaussian", "blackman-harris"};
  return names;
}

PixelFilter::Kind PixelFilterFromName(std::string_view name) {
  const std::vector<std::string>& names = PixelFilterNames();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw InputError(fmt::format("filter \"{}\" is not one of {}", name, fmt::join(names, ", ")));
  }
  return static_cast<PixelFilter::Kind>(found - names.begin());
}

std::string NameOf(PixelFilter::Kind kind) {
  return PixelFilterNames()[static_cast<std::size_t>(kind)];
}

}  // namespace alpenglow::renderer
