// SPDX-License-Identifier: MIT
// A series of pictures: rendered, exposed, written one by one, and taken up again where it stopped.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "atmosphere/sun/geodesy.h"
#include "lut/picture/image.h"
#include "lut/picture/look.h"
#include "lut/program/messages.h"
#include "lut/program/output_file.h"
#include "renderer/camera/camera_path.h"
#include "renderer/series/frame_times.h"

namespace alpenglow::renderer {

/// A picture, and what was found out about it while it was made: not part of what its pixels depend
/// on, written into its file beside that, and kept when the picture is developed again.
struct NotedPicture {
  NotedPicture(Image picture, Metadata found = {})  // NOLINT: a picture without notes is one
      : image(std::move(picture)), notes(std::move(found)) {}

  Image image;
  Metadata notes;  // names begin with kNotePrefix
};
inline constexpr const char* kNotePrefix = "alpenglow.note.";
/// Of sun and sky on level ground at the eye [lx], for the plot and the manifest.
inline constexpr const char* kIlluminanceNote = "alpenglow.note.illuminance_lx";

/// What makes the pictures of a series.
struct SeriesSource {
  /// Tells the progress what it prepares, and how much of the picture is done.
  std::function<NotedPicture(const Frame&, Progress&)> render;
  /// Of sun and sky on a horizontal plane at the eye, behind the camera's polariser [lux], for
  /// ExposureRule::Kind::kIncident.
  std::function<double(const Frame&)> illuminance;
  /// Everything that the pixels depend on but the instant and the pose (SceneMetadata, size,
  /// samples, layers).
  Metadata settings;
  GeodeticPosition place;
  std::optional<std::string> zone;
  std::optional<CameraPath> path;               // that Frame::path_s is on
  Projection projection = Projection::kCamera;  // without a path
  double fov_rad = 0.0;                         // without a path
  /// A small picture of a frame, for the meter of a series (smooth_meter.h); without it each frame is
  /// metered by itself.
  std::function<Image(const Frame&)> pilot = {};
  bool has_moon = true;  // the earth's, which eclipses the sun

  /// Share of the sun's light (550 nm) that the moon covers, [0, 1].
  [[nodiscard]] double SunCovered(const Frame& frame) const;
  /// Of the eye of a frame.
  [[nodiscard]] GeodeticPosition PlaceOf(const Frame& frame) const {
    return path ? path->PoseAt(frame.path_s).place : place;
  }
  [[nodiscard]] Projection ProjectionOf(const Frame& frame) const;
  [[nodiscard]] double FovOf(const Frame& frame) const {
    return path ? path->PoseAt(frame.path_s).fov_rad : fov_rad;
  }
};

/// How the pictures are exposed and where they go.
struct SeriesOutput {
  FrameName name;
  bool png = false;            // a developed picture beside every EXR
  ExposureRule exposure = {};  // of every frame
  Look look = {};
  bool resume = false;
  std::vector<NamedFile> inputs = {};  // that no file of the series may replace
  std::optional<std::filesystem::path> contact_sheet = std::nullopt;  // PNG
  ProgressStyle progress = ProgressStyle::kAuto;
  bool glare = false;  // developed pictures have that of the eye (eye.h); the EXR never
  std::optional<std::filesystem::path> keogram = std::nullopt;  // PNG (contact_sheet.h)
  std::optional<std::filesystem::path> plot = std::nullopt;     // SVG (day_times.h)
  std::optional<std::filesystem::path> video = std::nullopt;    // video.h
  double video_frames_per_s = 25.0;
};

/// What was done for the selected frames.
struct SeriesSummary {
  int rendered = 0;
  int kept = 0;             // intact, with the same settings
  int developed = 0;        // pixels kept, exposure or curve changed: written again
  std::size_t removed = 0;  // temporaries of runs that were killed
};

/// Renders `selected` of the frames of a series and writes an EXR each (with `png` a PNG too), and
/// the manifest: a CSV of all `frames` with frame, file, utc, local_time, sun_azimuth_deg,
/// sun_elevation_deg (without refraction), sun_covered (share of its light behind the moon), ev100; on a path also t_s, latitude, longitude, height_m,
/// heading, pitch, roll and fov; and exposure, the rule (as ev100 empty until the frame exists);
/// and the same as JSON (manifest.h). Contact sheet, keogram and video show the selected frames,
/// the plot all that there are times of; they are made when the last of the selected is there.
///
/// Files are written atomically, in folders that are created when they are missing. With `resume`
/// a frame is rendered only if its file is missing, unreadable, or made with other settings: each
/// file carries a fingerprint of its settings; and what killed runs left behind in the folders is
/// removed (RemoveAbandonedTemporaries). Stops between frames when a signal has come
/// (ThrowIfInterrupted), finished frames and the manifest kept.
///
/// Throws OutputError, also for a video without an ffmpeg, before the first frame; InputError for several frames under a name without a number, and when a file
/// of the series is one of its inputs.
SeriesSummary RunSeries(const SeriesSource& source, const std::vector<Frame>& frames,
                        const std::vector<Frame>& selected, const SeriesOutput& output);

}  // namespace alpenglow::renderer
