// SPDX-License-Identifier: MIT
// Pictures of the report: the true light of a view, that of every method, and the errors of both.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "lut/report/report.h"
#include "renderer/cloud_light/cloud_path_tracer.h"
#include "renderer/layer.h"
#include "renderer/report/cloud_views.h"

namespace alpenglow::renderer {

/// The words of a reference.
struct ReferenceCaption {
  std::string key;   // in names of files
  std::string name;  // "Traced paths: 496 a pixel"
};

class ErrorPictures {
 public:
  /// Adds the picture of the reference and that of its standard errors.
  /// @param truth  of all pixels, line by line. @param white  light that is shown white.
  ErrorPictures(const CloudRaster& raster, std::vector<CloudEstimate> truth,
                const ReferenceCaption& caption, double white);

  /// Adds the picture of a method and that of its errors, blue where it is too dark and red where it
  /// is too bright. @param found  light of all pixels.
  void Add(const std::string& key, const std::string& name, const std::vector<double>& found);

  [[nodiscard]] std::vector<ReportPicture> Finished() && { return std::move(pictures_); }

 private:
  using ScreenColour = std::array<double, 3>;
  [[nodiscard]] double ScaleOf(std::size_t pixel) const;
  [[nodiscard]] ScreenColour Grey(double light) const;
  void AddPicture(std::string key, std::string caption,
                  const std::function<ScreenColour(std::size_t)>& colour_of);

  CloudRaster raster_;
  std::vector<CloudEstimate> truth_;
  double white_, mean_ = 0.0;
  std::vector<ReportPicture> pictures_;
};

/// Returns the largest light of a picture that is no noise, to be shown white.
[[nodiscard]] double BrightestOf(const std::vector<CloudEstimate>& truth);

}  // namespace alpenglow::renderer
