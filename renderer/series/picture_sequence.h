// SPDX-License-Identifier: MIT
// A sequence of pictures as one file: a contact sheet of all pictures, each small and with a line
// of text; a keogram, which places the middle columns of the pictures side by side, so that one
// image shows their course (Eather, Mende, Reference 1976, J. Geophys. Res. 81, 3219); and a film,
// for which developed pictures are piped to ffmpeg one by one.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "lut/image/image.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

inline constexpr int kThumbnailWidth = 320;

/// Returns the picture with its width reduced to at most `width`, with pixels averaged in linear
/// light and without layers. Pictures that are narrow enough are returned unchanged.
[[nodiscard]] Image Reduced(const Image& image, int width);

struct Thumbnail {
  DisplayImage image;
  std::string label;  // digits, ':', '.', '+', '-' and spaces; other characters are left blank
};

/// Returns the thumbnails row by row, in about as many columns as rows. All must have the same
/// size.
[[nodiscard]] DisplayImage ContactSheet(const std::vector<Thumbnail>& thumbnails);

/// Grows by one column per picture.
class Keogram {
 public:
  /// Adds the middle column of a developed picture; all pictures must have the same height.
  void Add(const DisplayImage& picture);

  /// Returns an image with one column per added picture, at least one, and with their height.
  [[nodiscard]] DisplayImage Image() const;

 private:
  int height_ = 0;
  std::vector<std::uint8_t> rgb_;  // column by column
};

struct VideoSettings {
  int width, height;    // pixels
  double frames_per_s;  // > 0
  Metadata metadata;    // stored as the film's comment
};

/// Throws InputError unless the file's name ends in .mp4, .mov or .mkv, and OutputError if there is
/// no ffmpeg on the PATH.
void RequireVideo(const std::filesystem::path& file);

/// Writes a film completely or not at all: H.264, 4:2:0, the colours of sRGB (BT.709 primaries) in
/// a limited range; an odd side is padded with a black line. `frame` returns the pictures from
/// number 0 on, each of the film's size; its exceptions end ffmpeg and propagate. Signals are
/// checked between pictures (ThrowIfInterrupted). Throws OutputError with ffmpeg's last message.
void WriteVideo(const std::filesystem::path& file, const VideoSettings& settings, int frames,
                const std::function<DisplayImage(int)>& frame);

}  // namespace alpenglow::renderer
