// SPDX-License-Identifier: MIT
#include "renderer/series/series.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <system_error>
#include <variant>

#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"
#include "atmosphere/math/constants.h"
#include "lut/cli/outputs.h"
#include "lut/cli/program.h"
#include "lut/image/development.h"
#include "lut/image/exr.h"
#include "lut/image/look.h"
#include "lut/image/picture_format.h"
#include "lut/image/png.h"
#include "renderer/picture/render.h"
#include "renderer/series/contact_sheet.h"
#include "renderer/series/day_plot.h"
#include "renderer/series/frame_exposure.h"
#include "renderer/series/keogram.h"
#include "renderer/series/manifest.h"
#include "renderer/series/scene_metadata.h"
#include "renderer/series/video.h"

namespace alpenglow::renderer {
namespace {

namespace fs = std::filesystem;

constexpr char kRenderFingerprint[] = "alpenglow.render_fingerprint";
constexpr char kFingerprint[] = "alpenglow.fingerprint";
constexpr char kExposure[] = "alpenglow.exposure";

/// Returns the values that affect the pixels of a frame: settings and instant, with their
/// fingerprint.
Metadata RenderMetadata(const SeriesSource& source, const Frame& frame) {
  Metadata metadata = source.settings;
  if (source.viewpoint.path) {
    for (const auto& [name, value] : PoseMetadata(source.viewpoint.path->PoseAt(frame.path_s))) {
      metadata[name] = value;
    }
    metadata["alpenglow.path_s"] = fmt::format("{}", frame.path_s);
  }
  metadata["alpenglow.utc"] = FormatUtc(frame.instant, 3);
  metadata[kRenderFingerprint] = Fingerprint(metadata);
  return metadata;
}

/// Returns a value of a file's header, or "" if the file or the value is missing.
std::string HeaderValue(const fs::path& file, const std::string& name) {
  try {
    const Metadata metadata = FormatOfPicture(file).read_metadata(file);
    const auto found = metadata.find(name);
    return found == metadata.end() ? "" : found->second;
  } catch (const InputError&) {
    return "";
  }
}

/// Adds the values that the header of an existing frame has.
void AddFound(const Metadata& header, FrameRecord& record) {
  const auto value = [&](const char* name) {
    const auto found = header.find(name);
    return found == header.end() ? std::string() : found->second;
  };
  if (const auto ev100 = ParseNumber(value(kEv100Key))) record.Set("ev100", *ev100);
  if (const auto illuminance = ParseNumber(value(kIlluminanceNote)))
    record.Set("illuminance_lx", *illuminance);
  record.Set("exposure", value(kExposure));
}

Metadata NotesOf(const fs::path& exr) {
  Metadata notes = ReadExrMetadata(exr);
  std::erase_if(notes, [](const auto& entry) { return !entry.first.starts_with(kNotePrefix); });
  return notes;
}

/// Returns the picture in the file if it is intact and was made with these settings.
std::optional<NotedPicture> KeptPicture(const fs::path& file,
                                        const std::string& render_fingerprint) {
  if (HeaderValue(file, kRenderFingerprint) != render_fingerprint) return std::nullopt;
  try {
    NotedPicture kept(ReadExr(file), NotesOf(file));
    if (FaultyValue(kept.image)) return std::nullopt;
    return kept;
  } catch (const InputError&) {
    return std::nullopt;  // damaged: render again
  }
}

bool IsKeptPng(const fs::path& file, const std::string& fingerprint) {
  if (HeaderValue(file, kFingerprint) != fingerprint) return false;
  try {
    (void)ReadPng(file);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

/// Returns all metadata of a frame's header except its notes.
Metadata FrameMetadata(const SeriesSource& source, const SeriesOutput& output, const Frame& frame,
                       const FrameRecord& record, const Development& development) {
  Metadata metadata = RenderMetadata(source, frame);
  metadata.merge(HeaderOf(record));
  metadata.merge(HeaderOfDevelopment(output, development));
  metadata[kFingerprint] = Fingerprint(metadata);
  return metadata;
}

class Series {
 public:
  Series(const SeriesSource& source, const std::vector<Frame>& frames,
         const std::vector<Frame>& selected, const SeriesOutput& output)
      : source_(source),
        listed_(frames.size() > kMostListed ? selected : frames),
        output_(output),
        exposure_(source, frames, output) {
    for (const Frame& frame : listed_) {
      ThrowIfInterrupted();
      records_.push_back(RecordBefore(frame));
    }
  }

  /// Renders or updates a frame. @return whether it was rendered.
  bool Make(const Frame& frame, Progress& progress) {
    const fs::path exr = output_.name.Picture(frame.number);
    const std::string wanted = RenderMetadata(source_, frame).at(kRenderFingerprint);
    std::optional<NotedPicture> picture;
    if (output_.resume) picture = KeptPicture(exr, wanted);
    const bool rendered = !picture;
    if (rendered) picture = source_.render(frame, progress);
    const Development development = exposure_.DevelopmentOf(frame, picture->image, rendered);
    Write(frame, *picture, development, rendered);
    if (output_.video || output_.keogram) developments_.emplace(frame.number, development);
    if (output_.contact_sheet) AddThumbnail(frame, picture->image, development);
    return rendered;
  }

  /// Warns about missing light in pictures during the totality of a solar eclipse.
  void WarnOfTotality(const std::vector<Frame>& selected) const {
    const auto is_total = [&](const Frame& frame) {
      return RecordOfFrame(frame).Number("sun_covered") == 1.0;
    };
    const auto total = std::count_if(selected.begin(), selected.end(), is_total);
    if (total == 0) return;
    Log(fmt::format(
        "skyseries: warning: {} of {} frames stand in the totality of an eclipse; the "
        "corona is not drawn, and light that the air outside of the moon's shadow sends "
        "in is missing: such pictures are too dark\n",
        total, selected.size()));
  }

  void WriteManifest() const {
    const std::vector<FrameRecord> records = Records();
    const bool on_path = source_.viewpoint.path.has_value();
    WriteTextAtomically(output_.name.Manifest(), CsvOfManifest(records, on_path));
    WriteTextAtomically(output_.name.JsonManifest(),
                        JsonOfManifest(records, source_.settings, on_path));
  }

  void WriteContactSheet() const {
    if (output_.contact_sheet) {
      WritePng(*output_.contact_sheet, ContactSheet(thumbnails_), source_.settings);
    }
  }

  void WritePlot() const {
    if (!output_.plot) return;
    std::vector<PlottedMoment> moments;
    const std::vector<FrameRecord> records = Records();
    for (std::size_t i = 0; i < listed_.size(); ++i) {
      const auto value = [&](const char* key) { return records[i].Number(key); };
      moments.push_back({listed_[i].instant, *value("sun_elevation_deg"),
                         *value("moon_elevation_deg"), value("illuminance_lx"), value("ev100")});
    }
    std::stable_sort(moments.begin(), moments.end(),
                     [](const PlottedMoment& a, const PlottedMoment& b) {
                       return SecondsBetween(a.instant, b.instant) > 0.0;
                     });
    WriteTextAtomically(*output_.plot,
                        SvgOfDay(moments, {PlaceText(source_.viewpoint.PlaceOf(listed_.front())),
                                           source_.viewpoint.zone}));
  }

  /// Video and keogram take the developed pictures one by one, so the series is never held in
  /// memory.
  void WriteVideoAndKeogram(const std::vector<Frame>& shown) const {
    if (!output_.video && !output_.keogram) return;
    Keogram keogram(static_cast<int>(shown.size()), source_.viewpoint.zone);
    const auto picture = [&](int index) {
      const Frame& frame = shown[static_cast<std::size_t>(index)];
      DisplayImage image = Shown(frame);
      if (output_.keogram) keogram.Add(frame.instant, image);
      return image;
    };
    const auto count = static_cast<int>(shown.size());
    if (output_.video) {
      const DisplayImage first = Shown(shown.front());
      WriteVideo(*output_.video,
                 {first.width, first.height, output_.video_frames_per_s, source_.settings}, count,
                 picture);
    } else {
      for (int i = 0; i < count; ++i) {
        ThrowIfInterrupted();
        static_cast<void>(picture(i));
      }
    }
    if (output_.keogram) WritePng(*output_.keogram, keogram.Image(), source_.settings);
  }

  [[nodiscard]] const SeriesSummary& summary() const { return summary_; }

 private:
  void Write(const Frame& frame, const NotedPicture& picture, const Development& development,
             bool rendered) {
    const HdrImage& image = picture.image;
    Metadata metadata = FrameMetadata(source_, output_, frame, RecordOfFrame(frame), development);
    metadata.insert(picture.notes.begin(), picture.notes.end());
    const fs::path exr = output_.name.Picture(frame.number);
    const fs::path png = output_.name.Png(frame.number);
    const bool keep_exr = !rendered && HeaderValue(exr, kFingerprint) == metadata.at(kFingerprint);
    const bool keep_png = !output_.png || (keep_exr && IsKeptPng(png, metadata.at(kFingerprint)));
    if (!keep_exr) WriteExr(exr, image, metadata);
    if (!keep_png)
      WritePng(png,
               Develop(exposure_.Seen(frame, image, development.look), development.ev100,
                       development.look),
               metadata);
    (rendered ? summary_.rendered : keep_exr && keep_png ? summary_.kept : summary_.developed) += 1;
    AddFound(metadata, records_[IndexOf(frame)]);
    made_.insert(frame.number);
  }

  /// Returns an existing frame, developed.
  [[nodiscard]] DisplayImage Shown(const Frame& frame) const {
    if (output_.png) return ReadPng(output_.name.Png(frame.number));
    const Development& development = developments_.at(frame.number);
    const HdrImage image = ReadExr(output_.name.Picture(frame.number));
    return Develop(exposure_.Seen(frame, image, development.look), development.ev100,
                   development.look);
  }

  void AddThumbnail(const Frame& frame, const HdrImage& image, const Development& development) {
    const FrameRecord& record = RecordOfFrame(frame);
    const auto* const local = std::get_if<std::string>(&record.At("local_time"));
    const std::string time = (local ? *local : FormatUtc(frame.instant)).substr(11, 5);
    const HdrImage small = Reduced(exposure_.Seen(frame, image, development.look), kThumbnailWidth);
    thumbnails_.push_back({Develop(small, development.ev100, development.look),
                           fmt::format("{} {:+.1f}", time, *record.Number("sun_elevation_deg"))});
  }

  [[nodiscard]] std::size_t IndexOf(const Frame& frame) const {
    const auto found =
        std::lower_bound(listed_.begin(), listed_.end(), frame.number,
                         [](const Frame& listed, int number) { return listed.number < number; });
    return static_cast<std::size_t>(found - listed_.begin());
  }
  [[nodiscard]] const FrameRecord& RecordOfFrame(const Frame& frame) const {
    return records_[IndexOf(frame)];
  }

  /// Returns what is known of a frame before it is rendered.
  [[nodiscard]] FrameRecord RecordBefore(const Frame& frame) const {
    FrameRecord record = source_.viewpoint.RecordOf(frame);
    record.Set("file", output_.name.Picture(frame.number).filename().string());
    if (source_.viewpoint.path)
      AddPose(frame, source_.viewpoint.path->PoseAt(frame.path_s), record);
    return record;
  }

  /// Adds the values of a frame that another run (or machine) has rendered, from its file.
  void AddFoundElsewhere(const Frame& frame, FrameRecord& record) const {
    std::error_code none;  // a frame that cannot be asked for is not there
    if (!fs::exists(output_.name.Picture(frame.number), none)) return;
    const std::string wanted = RenderMetadata(source_, frame).at(kRenderFingerprint);
    try {
      const Metadata header = ReadExrMetadata(output_.name.Picture(frame.number));
      const auto made = header.find(kRenderFingerprint);
      if (made != header.end() && made->second == wanted) AddFound(header, record);
    } catch (const InputError&) {
      // There is no such frame yet.
    }
  }

  /// Returns the records of the listed frames with the values of those that exist.
  [[nodiscard]] std::vector<FrameRecord> Records() const {
    std::vector<FrameRecord> records = records_;
    for (const Frame& frame : listed_) {
      if (!made_.contains(frame.number)) AddFoundElsewhere(frame, records[IndexOf(frame)]);
    }
    return records;
  }

  const SeriesSource& source_;
  const std::vector<Frame>& listed_;  // in the manifests
  const SeriesOutput& output_;
  std::vector<FrameRecord>
      records_;  // of the listed frames, with the values of those made by this run
  std::set<int> made_;
  SeriesSummary summary_;
  SeriesExposure exposure_;
  std::map<int, Development> developments_;
  std::vector<Thumbnail> thumbnails_;
};

/// Returns the files made from all frames.
std::vector<NamedFile> MadeOfTheFrames(const SeriesOutput& output) {
  std::vector<NamedFile> files;
  const auto add = [&](const char* name, const std::optional<fs::path>& file) {
    if (file) files.push_back({name, *file});
  };
  add("--contact-sheet", output.contact_sheet);
  add("--keogram", output.keogram);
  add("--plot", output.plot);
  add("--video", output.video);
  return files;
}

/// Returns all files that a run writes.
std::vector<NamedFile> OutputsOf(const std::vector<Frame>& selected, const SeriesOutput& output,
                                 std::vector<NamedFile> made_of_all) {
  std::vector<NamedFile> outputs = std::move(made_of_all);
  outputs.push_back({"--out: the manifest", output.name.Manifest()});
  outputs.push_back({"--out: the manifest", output.name.JsonManifest()});
  for (const Frame& frame : selected) {
    outputs.push_back({"--out", output.name.Picture(frame.number)});
    if (output.png) outputs.push_back({"--png", output.name.Png(frame.number)});
  }
  return outputs;
}

std::size_t RemoveLeftovers(const fs::path& folder, const std::vector<NamedFile>& made_of_all) {
  std::size_t removed = RemoveAbandonedTemporaries(folder);
  std::set<fs::path> others;
  for (const NamedFile& made : made_of_all) others.insert(made.file.parent_path());
  others.erase(folder);
  for (const fs::path& other : others) removed += RemoveAbandonedTemporaries(other);
  return removed;
}

}  // namespace

Projection SeriesSource::ProjectionOf(const Frame& frame) const {
  if (!viewpoint.path) return projection;
  Camera camera;
  camera.fov_rad = viewpoint.path->PoseAt(frame.path_s).fov_rad;
  return camera.IsPanorama() ? Projection::kLatitudeLongitude : Projection::kCamera;
}

SeriesSummary RunSeries(const SeriesSource& source, const std::vector<Frame>& frames,
                        const std::vector<Frame>& selected, const SeriesOutput& output) {
  if (frames.size() > 1 && !output.name.HasNumber()) {
    throw InputError(
        fmt::format("--out has no frame number (%04d), but there are {} frames", frames.size()));
  }
  for (const Frame& frame : frames) {
    if (output.glare && source.ProjectionOf(frame) != Projection::kCamera)
      throw InputError("--glare is of an eye that looks one way, not of a panorama");
  }
  const std::vector<NamedFile> made_of_all = MadeOfTheFrames(output);
  const std::vector<NamedFile> outputs = OutputsOf(selected, output, made_of_all);
  for (const NamedFile& file : outputs) RequireNoInput(file, output.inputs);
  RequireDifferent(outputs);
  if (output.video) RequireVideo(*output.video);
  const fs::path folder = output.name.Folder();
  MakeFolder(folder);
  PrepareOutputs(made_of_all, output.inputs);
  Series series(source, frames, selected, output);
  series.WarnOfTotality(selected);
  const std::size_t removed = output.resume ? RemoveLeftovers(folder, made_of_all) : 0;
  series.WriteManifest();  // before rendering, to detect a folder that is not writable
  Progress progress("frames", selected.size(), output.progress);
  try {
    for (const Frame& frame : selected) {
      ThrowIfInterrupted();
      if (series.Make(frame, progress)) {
        progress.Advance();
      } else {
        progress.Skip();
      }
    }
  } catch (...) {
    try {
      series.WriteManifest();
    } catch (const OutputError&) {
      // Report the first failure.
    }
    throw;
  }
  series.WriteManifest();
  series.WriteContactSheet();
  series.WritePlot();
  series.WriteVideoAndKeogram(selected);
  SeriesSummary summary = series.summary();
  summary.removed = removed;
  return summary;
}

}  // namespace alpenglow::renderer
