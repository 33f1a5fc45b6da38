// SPDX-License-Identifier: MIT
// Renders a series of pictures: exposes and writes them one by one, and resumes an interrupted
// series.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "atmosphere/time_place/geodesy.h"
#include "lut/cli/messages.h"
#include "lut/cli/output_file.h"
#include "lut/image/image.h"
#include "lut/image/look.h"
#include "renderer/camera/camera_path.h"
#include "renderer/series/frame_times.h"
#include "renderer/series/manifest.h"

namespace alpenglow::renderer {

/// A picture with notes: values found during rendering. Notes do not identify the pixels; they are
/// stored in the file in addition to its settings, and kept when the picture is developed again.
struct NotedPicture {
  NotedPicture(HdrImage picture, Metadata found = {})  // NOLINT: implicit, notes are optional
      : image(std::move(picture)), notes(std::move(found)) {}

  HdrImage image;
  Metadata notes;  // names begin with kNotePrefix
};
inline constexpr const char* kNotePrefix = "alpenglow.note.";
/// Name of the note with the illuminance of sun and sky on level ground at the eye [lx], for the
/// plot and the manifest.
inline constexpr const char* kIlluminanceNote = "alpenglow.note.illuminance_lx";

/// The eye of a series: at one place or along a path.
struct SeriesViewpoint {
  Place place;                           // without a path
  std::optional<std::string> zone = {};  // of the local times
  std::optional<CameraPath> path = {};   // camera path of Frame::path_s
  bool has_moon = true;  // the planet has the earth's moon, which can eclipse the sun

  /// Returns the place of the eye in a frame.
  [[nodiscard]] Place PlaceOf(const Frame& frame) const {
    return path ? path->PoseAt(frame.path_s).place : place;
  }
  /// Returns the record of what is known before a frame is rendered (manifest.h).
  [[nodiscard]] FrameRecord RecordOf(const Frame& frame) const {
    return renderer::RecordOf(frame, PlaceOf(frame), zone, has_moon);
  }
};

/// Source of the pictures of a series.
struct SeriesSource {
  /// Renders a frame; reports its preparation steps and the finished part of the picture to the
  /// progress.
  std::function<NotedPicture(const Frame&, Progress&)> render;
  /// Returns the illuminance of sun and sky on a horizontal plane at the eye, behind the camera's
  /// polariser [lux], for ExposureRule::Kind::kIncident.
  std::function<double(const Frame&)> illuminance;
  /// Everything that affects the pixels except the instant and the pose (SceneMetadata, size,
  /// samples, layers).
  Metadata settings;
  SeriesViewpoint viewpoint;
  Projection projection = Projection::kCamera;  // without a path
  double fov_rad = 0.0;                         // without a path
  /// Returns a small picture of a frame, for the meter of a series (frame_exposure.h); without it
  /// each frame is metered by itself.
  std::function<HdrImage(const Frame&)> preview = {};

  [[nodiscard]] Projection ProjectionOf(const Frame& frame) const;
  [[nodiscard]] double FovOf(const Frame& frame) const {
    return viewpoint.path ? viewpoint.path->PoseAt(frame.path_s).fov_rad : fov_rad;
  }
};

/// Exposure and destination of the pictures.
struct SeriesOutput {
  FrameName name;
  bool png = false;            // write a developed picture next to every EXR
  ExposureRule exposure = {};  // applies to every frame
  Look look = {};
  bool resume = false;
  std::vector<NamedFile> inputs = {};  // files that the series must not overwrite
  std::optional<std::filesystem::path> contact_sheet = std::nullopt;  // PNG
  ProgressStyle progress = ProgressStyle::kAuto;
  bool glare = false;  // developed pictures have the glare of the eye (glare.h); EXRs never have it
  std::optional<std::filesystem::path> keogram = std::nullopt;  // PNG (keogram.h)
  std::optional<std::filesystem::path> plot = std::nullopt;     // SVG (day_plot.h)
  std::optional<std::filesystem::path> video = std::nullopt;    // video.h
  double video_frames_per_s = 25.0;
};

/// Largest number of frames of a series that a run of some of them lists in the manifests.
inline constexpr std::size_t kMostListed = 20000;

/// Numbers of processed frames.
struct SeriesSummary {
  int rendered = 0;
  int kept = 0;             // intact, with the same settings
  int developed = 0;        // pixels kept, exposure or tone curve changed: written again
  std::size_t removed = 0;  // temporary files of runs that were killed
};

/// Renders `selected` of the frames of a series and writes an EXR for each (with `png` also a PNG),
/// and the manifest: a CSV of all `frames` with frame, file, utc, local_time, sun_azimuth_deg,
/// sun_elevation_deg (without refraction), sun_covered (fraction of the sun's light behind the
/// moon), ev100; on a path also t_s, latitude, longitude, height_m, heading, pitch, roll and fov;
/// and exposure, the exposure rule (like ev100, empty until the frame exists). A JSON manifest has
/// the same content (manifest.h). Contact sheet, keogram and video show the selected frames, the
/// plot shows all frames. They are written after the last selected frame.
///
/// Files are written atomically, in folders that are created if they are missing. With `resume` a
/// frame is rendered only if its file is missing, unreadable, or made with other settings: each
/// file carries a fingerprint of its settings. Temporary files of killed runs are removed from the
/// folders (RemoveAbandonedTemporaries). A signal stops the series between frames
/// (ThrowIfInterrupted); finished frames and the manifest are kept.
///
/// A run of some frames of a series of more than kMostListed lists these frames alone, in manifests
/// and plot: a process of a farm prepares what it renders. A run of all frames lists all.
///
/// A warning names frames in the totality of a solar eclipse, where light is missing.
///
/// Throws OutputError, also for a video without an ffmpeg, before the first frame; InputError for
/// several frames under a name without a number, and when a file of the series is one of its
/// inputs; OptionError if two of its files have one name.
SeriesSummary RunSeries(const SeriesSource& source, const std::vector<Frame>& frames,
                        const std::vector<Frame>& selected, const SeriesOutput& output);

}  // namespace alpenglow::renderer
