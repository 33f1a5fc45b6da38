// SPDX-License-Identifier: MIT
// A film of the pictures of a series: developed pictures are piped to ffmpeg one by one.
#pragma once

#include <filesystem>
#include <functional>

#include "lut/image/image.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

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
