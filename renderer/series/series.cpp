// SPDX-License-Identifier: MIT
#include "renderer/series/series.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <system_error>

#include "atmosphere/number/constants.h"
#include "atmosphere/sun/sun.h"
#include "atmosphere/text/error.h"
#include "lut/picture/glare.h"
#include "lut/picture/picture_text.h"
#include "lut/program/program.h"
#include "renderer/picture/render.h"
#include "renderer/series/contact_sheet.h"
#include "renderer/series/provenance.h"
#include "renderer/series/smooth_meter.h"

namespace alpenglow {
namespace {

namespace fs = std::filesystem;

constexpr char kRenderFingerprint[] = "alpenglow.render_fingerprint";
constexpr char kFingerprint[] = "alpenglow.fingerprint";
constexpr char kEv100[] = "alpenglow.ev100";
constexpr char kExposure[] = "alpenglow.exposure";
constexpr char kExposureRule[] = "alpenglow.exposure_rule";
constexpr char kToneCurve[] = "alpenglow.tone_curve";
constexpr char kWhiteBalance[] = "alpenglow.white_balance";

/// How a frame is developed.
struct Development {
  Look look;  // settled
  double ev100;
  std::string rule;  // of the exposure, in words
};

std::string LocalTime(const SeriesSource& source, const UtcInstant& instant) {
  return source.zone ? FormatInZone(instant, *source.zone) : "";
}

/// Settings, instant and their fingerprint: what the pixels of a frame depend on.
Metadata RenderMetadata(const SeriesSource& source, const Frame& frame) {
  Metadata metadata = source.settings;
  if (source.path) {
    for (const auto& [name, value] : PoseMetadata(source.path->PoseAt(frame.path_s))) {
      metadata[name] = value;
    }
    metadata["alpenglow.path_s"] = fmt::format("{}", frame.path_s);
  }
  metadata["alpenglow.utc"] = FormatUtc(frame.instant, 3);
  metadata[kRenderFingerprint] = Fingerprint(metadata);
  return metadata;
}

/// A value of a file's header, or "" when there is no such file or value.
std::string HeaderValue(const std::function<Metadata()>& read, const std::string& name) {
  try {
    const Metadata metadata = read();
    const auto found = metadata.find(name);
    return found == metadata.end() ? "" : found->second;
  } catch (const InputError&) {
    return "";
  }
}

std::string ExrValue(const fs::path& file, const std::string& name) {
  return HeaderValue([&] { return ReadExrMetadata(file); }, name);
}

Metadata NotesOf(const fs::path& exr) {
  Metadata notes = ReadExrMetadata(exr);
  std::erase_if(notes, [](const auto& entry) { return !entry.first.starts_with(kNotePrefix); });
  return notes;
}

/// The picture, when it is whole and was made with these settings.
std::optional<NotedPicture> KeptPicture(const fs::path& file,
                                        const std::string& render_fingerprint) {
  if (ExrValue(file, kRenderFingerprint) != render_fingerprint) return std::nullopt;
  try {
    NotedPicture kept(ReadExr(file), NotesOf(file));
    if (FaultyValue(kept.image)) return std::nullopt;
    return kept;
  } catch (const InputError&) {
    return std::nullopt;  // damaged: to be rendered again
  }
}

bool IsKeptPng(const fs::path& file, const std::string& fingerprint) {
  if (HeaderValue([&] { return ReadPngMetadata(file); }, kFingerprint) != fingerprint) return false;
  try {
    (void)ReadPng(file);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

/// Everything that a frame's header says but its notes.
Metadata FrameMetadata(const SeriesSource& source, const SeriesOutput& output, const Frame& frame,
                       const Development& development) {
  Metadata metadata = RenderMetadata(source, frame);
  const SunPosition sun = SunAt(source.PlaceOf(frame), frame.instant);
  metadata["alpenglow.frame"] = fmt::format("{}", frame.number);
  metadata["alpenglow.sun_azimuth_deg"] =
      fmt::format("{:.6f}", sun.azimuth_rad / kRadiansPerDegree);
  metadata["alpenglow.sun_elevation_deg"] =
      fmt::format("{:.6f}", sun.elevation_rad / kRadiansPerDegree);
  metadata[kEv100] = fmt::format("{:.4f}", development.ev100);
  metadata[kExposure] = NameOf(output.exposure.kind);
  metadata[kExposureRule] = development.rule;
  metadata[kToneCurve] = NameOf(development.look);
  metadata[kWhiteBalance] = NameOf(development.look.white);
  if (output.glare) metadata["alpenglow.glare"] = "eye, in the developed picture only";
  if (source.zone) metadata["alpenglow.local_time"] = LocalTime(source, frame.instant);
  metadata[kFingerprint] = Fingerprint(metadata);
  return metadata;
}

class Series {
 public:
  Series(const SeriesSource& source, const std::vector<Frame>& frames, const SeriesOutput& output)
      : source_(source), frames_(frames), output_(output) {
    const ExposureRule::Kind kind = output.exposure.kind;
    if (kind != ExposureRule::Kind::kMetered && kind != ExposureRule::Kind::kEye) return;
    const std::optional<int> per_node = FramesPerNode(frames, source.path.has_value());
    if (!source.pilot || !per_node) return;
    smooth_.emplace(frames, *per_node, [this](const Frame& frame) {
      const Image pilot = source_.pilot(frame);
      return Metered(frame, pilot, Settled(output_.look, pilot, ViewOf(frame, pilot)));
    });
  }

  /// @return whether the frame had to be rendered.
  bool Make(const Frame& frame, Progress& progress) {
    const fs::path exr = output_.name.Exr(frame.number);
    const std::string wanted = RenderMetadata(source_, frame).at(kRenderFingerprint);
    std::optional<NotedPicture> picture;
    if (output_.resume) picture = KeptPicture(exr, wanted);
    const bool rendered = !picture;
    if (rendered) picture = source_.render(frame, progress);
    const Look look = Settled(output_.look, picture->image, ViewOf(frame, picture->image));
    const Development development = DevelopmentOf(frame, picture->image, look, rendered);
    Write(frame, *picture, development, rendered);
    if (output_.contact_sheet) AddThumbnail(frame, picture->image, development);
    return rendered;
  }

  void WriteManifest() const {
    std::string text = "frame,file,utc,local_time,sun_azimuth_deg,sun_elevation_deg,ev100";
    if (source_.path) text += ",t_s,latitude,longitude,height_m,heading,pitch,roll,fov";
    text += ",exposure\n";
    for (const Frame& frame : frames_) text += ManifestLine(frame);
    WriteTextAtomically(output_.name.Manifest(), text);
  }

  void WriteContactSheet() const {
    if (output_.contact_sheet) {
      WritePng(*output_.contact_sheet, ContactSheet(thumbnails_), source_.settings);
    }
  }

  [[nodiscard]] const SeriesSummary& summary() const { return summary_; }

 private:
  /// As they are in the files; empty before there is one.
  struct ExposureTexts {
    std::string ev100, rule;
  };

  [[nodiscard]] PictureView ViewOf(const Frame& frame, const Image& image) const {
    const Projection projection = source_.ProjectionOf(frame);
    const double across =
        projection == Projection::kCamera ? 2.0 * std::tan(0.5 * source_.FovOf(frame)) : 2.0 * kPi;
    return {projection, across / image.width};
  }

  [[nodiscard]] double Metered(const Frame& frame, const Image& image, const Look& look) const {
    const PictureView view = ViewOf(frame, image);
    return MeterEv100(Seen(image, look, view), kSunDiskLuminance_cd_per_m2, view.projection);
  }

  [[nodiscard]] Development DevelopmentOf(const Frame& frame, const Image& image, const Look& look,
                                          bool rendered) {
    const ExposureRule& rule = output_.exposure;
    std::string words = RuleInWords(rule);
    switch (rule.kind) {
      case ExposureRule::Kind::kFixed:
        return {look, rule.ev100, words};
      case ExposureRule::Kind::kIncident:
        return {look, IncidentEv100(source_.illuminance(frame)), words};
      case ExposureRule::Kind::kMetered:
      case ExposureRule::Kind::kEye:
        break;
    }
    if (!smooth_) return {look, Ev100By(rule, Metered(frame, image, look), look), words};
    words += "; " + smooth_->InWords();
    if (!rendered) {
      if (const std::optional<double> known = KeptEv100(frame, look, words))
        return {look, *known, words};
    }
    return {look, Ev100By(rule, smooth_->At(frame), look), words};
  }

  /// Of a frame that is there, where it was exposed and developed as this run would: it takes no
  /// pilots.
  [[nodiscard]] std::optional<double> KeptEv100(const Frame& frame, const Look& look,
                                                const std::string& words) const {
    const Metadata kept = ReadExrMetadata(output_.name.Exr(frame.number));
    const Metadata wanted{{kExposure, NameOf(output_.exposure.kind)},
                          {kExposureRule, words},
                          {kToneCurve, NameOf(look)},
                          {kWhiteBalance, NameOf(look.white)}};
    if (!std::includes(kept.begin(), kept.end(), wanted.begin(), wanted.end())) return std::nullopt;
    return std::stod(kept.at(kEv100));
  }

  /// As it is developed: with the eye's glare if asked for, balanced, by night as the eye sees it.
  [[nodiscard]] Image AsLookedAt(const Frame& frame, const Image& image, const Look& look) const {
    const PictureView view = ViewOf(frame, image);
    if (!output_.glare) return Seen(image, look, view);
    return Seen(WithGlareOfEye(image, view.pixel_rad), look, view);
  }

  void Write(const Frame& frame, const NotedPicture& picture, const Development& development,
             bool rendered) {
    const Image& image = picture.image;
    Metadata metadata = FrameMetadata(source_, output_, frame, development);
    metadata.insert(picture.notes.begin(), picture.notes.end());
    const fs::path exr = output_.name.Exr(frame.number);
    const fs::path png = output_.name.Png(frame.number);
    const bool keep_exr = !rendered && ExrValue(exr, kFingerprint) == metadata.at(kFingerprint);
    const bool keep_png = !output_.png || (keep_exr && IsKeptPng(png, metadata.at(kFingerprint)));
    if (!keep_exr) WriteExr(exr, image, metadata);
    if (!keep_png)
      WritePng(
          png,
          Develop(AsLookedAt(frame, image, development.look), development.ev100, development.look),
          metadata);
    (rendered ? summary_.rendered : keep_exr && keep_png ? summary_.kept : summary_.developed) += 1;
    exposure_of_[frame.number] = {metadata.at(kEv100), metadata.at(kExposure)};
  }

  void AddThumbnail(const Frame& frame, const Image& image, const Development& development) {
    const std::string local = LocalTime(source_, frame.instant);
    const std::string time = (local.empty() ? FormatUtc(frame.instant) : local).substr(11, 5);
    const double elevation_deg =
        SunAt(source_.PlaceOf(frame), frame.instant).elevation_rad / kRadiansPerDegree;
    const Image small = Reduced(AsLookedAt(frame, image, development.look), kThumbnailWidth);
    thumbnails_.push_back({Develop(small, development.ev100, development.look),
                           fmt::format("{} {:+.1f}", time, elevation_deg)});
  }

  /// Frames of other runs (or machines) are looked up in their files.
  [[nodiscard]] ExposureTexts ExposureOf(const Frame& frame) const {
    const auto found = exposure_of_.find(frame.number);
    if (found != exposure_of_.end()) return found->second;
    const fs::path exr = output_.name.Exr(frame.number);
    const std::string wanted = RenderMetadata(source_, frame).at(kRenderFingerprint);
    if (ExrValue(exr, kRenderFingerprint) != wanted) return {};
    return {ExrValue(exr, kEv100), ExrValue(exr, kExposure)};
  }

  [[nodiscard]] std::string PoseText(const Frame& frame) const {
    if (!source_.path) return "";
    const CameraPose pose = source_.path->PoseAt(frame.path_s);
    std::string text = fmt::format(
        ",{:.6f},{:.8f},{:.8f},{:.3f}", frame.path_s, pose.place.latitude_rad / kRadiansPerDegree,
        pose.place.longitude_rad / kRadiansPerDegree, pose.place.height_m);
    for (const double angle : {pose.heading_rad, pose.pitch_rad, pose.roll_rad, pose.fov_rad}) {
      text += fmt::format(",{:.6f}", angle / kRadiansPerDegree);
    }
    return text;
  }

  [[nodiscard]] std::string ManifestLine(const Frame& frame) const {
    const SunPosition sun = SunAt(source_.PlaceOf(frame), frame.instant);
    const ExposureTexts exposure = ExposureOf(frame);
    return fmt::format("{},{},{},{},{:.4f},{:.4f},{}{},{}\n", frame.number,
                       output_.name.Exr(frame.number).filename().string(), FormatUtc(frame.instant),
                       LocalTime(source_, frame.instant), sun.azimuth_rad / kRadiansPerDegree,
                       sun.elevation_rad / kRadiansPerDegree, exposure.ev100, PoseText(frame),
                       exposure.rule);
  }

  const SeriesSource& source_;
  const std::vector<Frame>& frames_;
  const SeriesOutput& output_;
  SeriesSummary summary_;
  std::optional<SmoothMeter> smooth_;
  std::map<int, ExposureTexts> exposure_of_;
  std::vector<Thumbnail> thumbnails_;
};

void CreateFolder(const fs::path& folder) {
  if (folder.empty()) return;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw OutputError(fmt::format("{}: {}", folder.string(), error.message()));
}

void RequireNoInputAmongTheOutputs(const std::vector<Frame>& frames, const SeriesOutput& output) {
  RequireNoInput({"--out: the manifest", output.name.Manifest()}, output.inputs);
  if (output.contact_sheet) {
    RequireNoInput({"--contact-sheet", *output.contact_sheet}, output.inputs);
  }
  for (const Frame& frame : frames) {
    RequireNoInput({"--out", output.name.Exr(frame.number)}, output.inputs);
    if (output.png) RequireNoInput({"--png", output.name.Png(frame.number)}, output.inputs);
  }
}

std::size_t RemoveLeftovers(const SeriesOutput& output) {
  const fs::path folder = output.name.Folder();
  std::size_t removed = RemoveAbandonedTemporaries(folder);
  if (output.contact_sheet && output.contact_sheet->parent_path() != folder) {
    removed += RemoveAbandonedTemporaries(output.contact_sheet->parent_path());
  }
  return removed;
}

}  // namespace

Projection SeriesSource::ProjectionOf(const Frame& frame) const {
  if (!path) return projection;
  Camera camera;
  camera.fov_rad = path->PoseAt(frame.path_s).fov_rad;
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
  RequireNoInputAmongTheOutputs(frames, output);
  CreateFolder(output.name.Folder());
  if (output.contact_sheet) {
    CreateFolder(output.contact_sheet->parent_path());
    RequireWritable(*output.contact_sheet);
  }
  Series series(source, frames, output);
  const std::size_t removed = output.resume ? RemoveLeftovers(output) : 0;
  series.WriteManifest();  // before the work, so that a folder that takes no files is found out
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
      // The first failure is the one to report.
    }
    throw;
  }
  series.WriteManifest();
  series.WriteContactSheet();
  SeriesSummary summary = series.summary();
  summary.removed = removed;
  return summary;
}

}  // namespace alpenglow
