// SPDX-License-Identifier: MIT
// Films: developed pictures, handed one by one to ffmpeg.
#pragma once

#include <filesystem>
#include <functional>

#include "lut/picture/image.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

struct VideoSettings {
  int width, height;    // pixels
  double frames_per_s;  // > 0
  Metadata metadata;    // becomes the film's comment
};

/// Throws InputError unless the file's name ends in .mp4, .mov or .mkv, and OutputError when there
/// is no ffmpeg on the PATH.
void RequireVideo(const std::filesystem::path& file);

/// Writes a film whole or not at all: H.264, 4:2:0, the colours of sRGB (BT.709 primaries) in a
/// limited range; an odd side gets a black line more. `frame` gives the pictures from number 0 on,
/// each of the film's size; what it throws ends ffmpeg and passes. Between pictures a signal is
/// heard (ThrowIfInterrupted). Throws OutputError with ffmpeg's own last words.
void WriteVideo(const std::filesystem::path& file, const VideoSettings& settings, int frames,
                const std::function<DisplayImage(int)>& frame);

}  // namespace alpenglow::renderer
