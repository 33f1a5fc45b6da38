// SPDX-License-Identifier: MIT
// Names of the frames of a series: "DIR/frame.%04d.exr".
#pragma once

#include <filesystem>
#include <string>

namespace alpenglow::renderer {

/// A pattern with at most one integer conversion, %d, or %4d and %04d, which fill up with zeros as
/// ffmpeg does; %% is a per cent sign.
class FrameName {
 public:
  /// Throws InputError for other conversions, for more
  /// than one, and for names that do not end in .exr.
  explicit FrameName(const std::string& pattern);

  /// Whether frames of different numbers have different names.
  [[nodiscard]] bool HasNumber() const { return has_number_; }
  [[nodiscard]] std::filesystem::path Exr(int number) const;
  /// As Exr, with .png for .exr.
  [[nodiscard]] std::filesystem::path Png(int number) const;
  /// The list of the frames, in their folder: "DIR/frame.manifest.csv".
  [[nodiscard]] std::filesystem::path Manifest() const;
  /// The same for programs: "DIR/frame.manifest.json".
  [[nodiscard]] std::filesystem::path JsonManifest() const;
  [[nodiscard]] std::filesystem::path Folder() const;

 private:
  std::string before_, after_;  // of the number
  bool has_number_ = false;
  int width_ = 0;
};

}  // namespace alpenglow::renderer
