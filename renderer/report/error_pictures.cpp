// SPDX-License-Identifier: MIT
#include "renderer/report/error_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace alpenglow::renderer {
namespace {

constexpr int kScreenPixels = 4;            // of the display, along a side of a pixel
constexpr double kLargestShownError = 0.5;  // has the full colour

/// Returns white for no error, blue for too little light and red for too much.
std::array<double, 3> ErrorColour(double error) {
  constexpr std::array<double, 3> kBlue{0.02, 0.25, 0.65}, kRed{0.70, 0.05, 0.10};
  const double share = std::min(std::abs(error) / kLargestShownError, 1.0);
  const std::array<double, 3>& end = error < 0.0 ? kBlue : kRed;
  std::array<double, 3> colour{};
  for (std::size_t i = 0; i < 3; ++i) colour[i] = 1.0 + share * (end[i] - 1.0);
  return colour;
}

}  // namespace

double BrightestOf(const std::vector<CloudEstimate>& truth) {
  double brightest = 1e-9;
  for (const CloudEstimate& each : truth)
    brightest = std::max(brightest, each.value - 2.0 * each.standard_error);
  return brightest;
}

ErrorPictures::ErrorPictures(const CloudRaster& raster, std::vector<CloudEstimate> truth,
                             const ReferenceCaption& caption, double white)
    : raster_(raster), truth_(std::move(truth)), white_(white) {
  const auto count = static_cast<double>(truth_.size());
  for (const CloudEstimate& each : truth_) mean_ += each.value / count;
  double noise = 0.0;
  for (std::size_t i = 0; i < truth_.size(); ++i)
    noise += std::pow(truth_[i].standard_error / ScaleOf(i), 2) / count;
  AddPicture(
      caption.key,
      fmt::format("{}, standard error {:.1f} % (rms)", caption.name, 100.0 * std::sqrt(noise)),
      [&](std::size_t i) { return Grey(truth_[i].value); });
  AddPicture(caption.key + ".error",
             fmt::format("Standard error of the reference; full colour from {:.0f} % on",
                         100.0 * kLargestShownError),
             [&](std::size_t i) { return ErrorColour(truth_[i].standard_error / ScaleOf(i)); });
}

void ErrorPictures::Add(const std::string& key, const std::string& name,
                        const std::vector<double>& found) {
  AddPicture(key, name, [&](std::size_t i) { return Grey(found[i]); });
  AddPicture(key + ".error",
             fmt::format("{}: error; blue: too dark, red: too bright, full colour from {:.0f} % on",
                         name, 100.0 * kLargestShownError),
             [&](std::size_t i) { return ErrorColour((found[i] - truth_[i].value) / ScaleOf(i)); });
}

double ErrorPictures::ScaleOf(std::size_t pixel) const {
  return std::max(truth_[pixel].value, kDarkestCloud * mean_);
}

ErrorPictures::ScreenColour ErrorPictures::Grey(double light) const {
  const double value = std::pow(std::max(light, 0.0) / white_, 1.0 / 2.2);
  return {value, value, value};
}

void ErrorPictures::AddPicture(std::string key, std::string caption,
                               const std::function<ScreenColour(std::size_t)>& colour_of) {
  DisplayImage image{kScreenPixels * raster_.columns, kScreenPixels * raster_.lines, {}};
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const ScreenColour colour = colour_of(
          static_cast<std::size_t>(y / kScreenPixels * raster_.columns + x / kScreenPixels));
      for (const double value : colour)
        image.rgb.push_back(static_cast<std::uint8_t>(255.0 * std::clamp(value, 0.0, 1.0) + 0.5));
    }
  }
  pictures_.push_back({std::move(key), std::move(caption), std::move(image)});
}

}  // namespace alpenglow::renderer
