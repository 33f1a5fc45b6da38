// SPDX-License-Identifier: MIT
#include "renderer/camera/track_file.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"
#include "atmosphere/base/text_file.h"
#include "renderer/camera/track_record.h"

namespace alpenglow::renderer {
namespace {

using tinyxml2::XMLElement;

constexpr std::string_view kTrackBlanks = " \t\r\n";

class TrackReader {
 public:
  explicit TrackReader(const std::filesystem::path& file) : file_(file.string()) {
    const std::string text = ReadTextFile(file);
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
      Fail(1, "this is UTF-16; UTF-8 is read: save it as such");
    if (document_.Parse(text.data(), text.size()) == tinyxml2::XML_SUCCESS) return;
    const bool is_xml = Trimmed(text).starts_with('<');
    Fail(std::max(document_.ErrorLineNum(), 1),
         fmt::format("{} ({})",
                     is_xml ? "its XML is cut off, damaged or nested too deeply" : "this is no XML",
                     document_.ErrorName()));
  }

  [[nodiscard]] Track Read() {
    const XMLElement* root = document_.RootElement();
    if (root == nullptr) Fail(1, "there is nothing in it");
    if (NameOf(*root) == "gpx") return ReadGpx(*root);
    if (NameOf(*root) == "kml") return ReadKml(*root);
    Fail(root->GetLineNum(), fmt::format("<{}> is neither GPX nor KML", root->Name()));
  }

 private:
  [[noreturn]] void Fail(int line, const std::string& fault) const {
    throw InputError(fmt::format("{}:{}: {}", file_, line, fault));
  }

  /// Returns the name without its namespace: "gx:Track" becomes "Track".
  [[nodiscard]] static std::string_view NameOf(const XMLElement& element) {
    const std::string_view name = element.Name();
    const std::size_t colon = name.find(':');
    return colon == std::string_view::npos ? name : name.substr(colon + 1);
  }

  [[nodiscard]] static const XMLElement* ChildOf(const XMLElement& parent, std::string_view name) {
    for (const XMLElement* child = parent.FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      if (NameOf(*child) == name) return child;
    }
    return nullptr;
  }

  /// Collects the elements of a name at any depth, in the order of the file, without those nested
  /// in another match.
  static void Collect(const XMLElement& in, std::string_view name,
                      std::vector<const XMLElement*>& found) {
    for (const XMLElement* child = in.FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      if (NameOf(*child) == name) {
        found.push_back(child);
      } else {
        Collect(*child, name, found);
      }
    }
  }
  [[nodiscard]] static std::vector<const XMLElement*> All(const XMLElement& in,
                                                          std::string_view name) {
    std::vector<const XMLElement*> found;
    Collect(in, name, found);
    return found;
  }

  [[nodiscard]] static std::string_view TextOf(const XMLElement* element) {
    if (element == nullptr || element->GetText() == nullptr) return {};
    std::string_view text = element->GetText();
    text.remove_prefix(std::min(text.find_first_not_of(kTrackBlanks), text.size()));
    const std::size_t last = text.find_last_not_of(kTrackBlanks);
    return last == std::string_view::npos ? text : text.substr(0, last + 1);
  }

  /// Returns what `read` returns; nothing if it throws InputError, which is remembered if it is the
  /// first. One value that cannot be read does not spoil the file.
  template <typename Read>
  [[nodiscard]] auto Tried(const XMLElement& at, const Read& read) -> decltype(read()) {
    try {
      return read();
    } catch (const InputError& fault) {
      if (!first_fault_) first_fault_ = Fault{at.GetLineNum(), fault.what()};
      return std::nullopt;
    }
  }

  [[nodiscard]] static double Number(std::string_view text, std::string_view what) {
    // Numbers in XML may have a plus sign, which from_chars does not accept.
    const std::string_view digits = text.starts_with('+') ? text.substr(1) : text;
    double value = 0.0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (digits.empty() || error != std::errc() || end != digits.data() + digits.size())
      throw InputError(fmt::format("{} is \"{}\"; it must be a number", what, text));
    return value;
  }

  /// Returns empty for blank text or nan, which receivers without a fix write.
  [[nodiscard]] static std::optional<double> NumberIfAny(std::string_view text,
                                                         std::string_view what) {
    if (text.find_first_not_of(kTrackBlanks) == std::string_view::npos) return std::nullopt;
    const double value = Number(text, what);
    return std::isnan(value) ? std::nullopt : std::optional<double>(value);
  }

  [[nodiscard]] static std::optional<double> Attribute(const XMLElement& point, const char* name) {
    const char* text = point.Attribute(name);
    if (text == nullptr) throw InputError(fmt::format("<{}> has no {}", point.Name(), name));
    return NumberIfAny(text, name);
  }

  /// Returns nothing if there is no text.
  [[nodiscard]] std::optional<UtcTime> Instant(const XMLElement* element) {
    const std::string_view text = TextOf(element);
    if (text.empty()) return std::nullopt;
    return Tried(*element, [&] { return std::optional(ParseInstant(text, "Etc/UTC")); });
  }

  [[nodiscard]] Track ReadGpx(const XMLElement& gpx) {
    std::vector<RecordedSegment> segments;
    for (const XMLElement* segment : All(gpx, "trkseg"))
      segments.push_back(GpxPoints(All(*segment, "trkpt")));
    if (IsEmpty(segments)) segments = {GpxPoints(All(gpx, "trkpt"))};
    const XMLElement* owner = ChildOf(gpx, "trk");
    if (IsEmpty(segments)) {
      owner = ChildOf(gpx, "rte");
      if (owner != nullptr) segments = {GpxPoints(All(*owner, "rtept"))};
    }
    if (IsEmpty(segments)) segments = {GpxPoints(All(gpx, "wpt"))};
    if (IsEmpty(segments)) Fail(gpx.GetLineNum(), "there is no trkpt, rtept or wpt in it");
    Track track = Made(segments, TrackHeights::kSea, gpx);
    if (owner != nullptr) track.name = TextOf(ChildOf(*owner, "name"));
    if (owner != nullptr && NameOf(*owner) == "rte")
      RecordThatOnlyTheFirstCounts(All(gpx, "rte").size(), "routes", track);
    return track;
  }

  static void RecordThatOnlyTheFirstCounts(std::size_t count, const char* what, Track& track) {
    if (count < 2) return;
    if (!track.note.empty()) track.note += "; ";
    track.note += fmt::format("the first of {} {} is read", count, what);
  }

  [[nodiscard]] static bool IsEmpty(const std::vector<RecordedSegment>& segments) {
    return std::all_of(segments.begin(), segments.end(),
                       [](const RecordedSegment& segment) { return segment.empty(); });
  }

  [[nodiscard]] Track Made(const std::vector<RecordedSegment>& segments, TrackHeights heights,
                           const XMLElement& at) const {
    Track track = TrackOf(segments, heights);
    if (!track.points.empty()) return track;
    if (!first_fault_) Fail(at.GetLineNum(), "none of its points has a place");
    Fail(first_fault_->line,
         fmt::format("none of the points of the file has a place: {}", first_fault_->text));
  }

  [[nodiscard]] RecordedSegment GpxPoints(const std::vector<const XMLElement*>& points) {
    RecordedSegment segment;
    for (const XMLElement* point : points) segment.push_back(GpxPoint(*point));
    return segment;
  }

  [[nodiscard]] RecordedPoint GpxPoint(const XMLElement& point) {
    const XMLElement* height = ChildOf(point, "ele");
    RecordedPoint read;
    const auto latitude = Tried(point, [&] { return Attribute(point, "lat"); });
    const auto longitude = Tried(point, [&] { return Attribute(point, "lon"); });
    SetPlace(latitude, longitude, point, read);
    if (height != nullptr) {
      read.height_m = Tried(*height, [&] { return HeightIn(NumberIfAny(TextOf(height), "ele")); });
    }
    read.utc = Instant(ChildOf(point, "time"));
    return read;
  }

  /// Returns the height if there is one. The range is wider than paths may reach, as in camera path
  /// files.
  [[nodiscard]] static std::optional<double> HeightIn(const std::optional<double>& height_m) {
    if (height_m) (void)RequireInRange(*height_m, -12000.0, 1e9, "height");
    return height_m;
  }

  void SetPlace(std::optional<double> latitude, std::optional<double> longitude,
                const XMLElement& at, RecordedPoint& point) {
    if (!latitude || !longitude) return;
    point.is_pause = IsPauseMark(*latitude);
    point.place = Tried(at, [&] {
      return std::optional(CheckedPlace({*latitude, *longitude, 0.0}));
    });
  }

  /// OpenTracks marks the begin of a pause with latitude 100 and its end with latitude 200.
  [[nodiscard]] static bool IsPauseMark(double latitude) {
    return latitude == 100.0 || latitude == 200.0;
  }

  [[nodiscard]] Track ReadKml(const XMLElement& kml) {
    std::vector<const XMLElement*> lines = All(kml, "Track");
    const bool recorded = !lines.empty();
    if (!recorded) lines = All(kml, "LineString");
    if (lines.empty()) Fail(kml.GetLineNum(), "there is no gx:Track and no LineString in it");
    const std::size_t drawn = recorded ? 1 : lines.size();
    if (!recorded) lines.erase(lines.begin() + 1, lines.end());
    std::vector<RecordedSegment> segments;
    const TrackHeights heights = HeightsOf(*lines.front());
    for (const XMLElement* line : lines) {
      if (HeightsOf(*line) != heights)
        Fail(line->GetLineNum(), "its altitudeMode is not that of the lines before it");
      segments.push_back(recorded ? KmlTrack(*line) : LineString(*line));
    }
    if (IsEmpty(segments)) Fail(lines.front()->GetLineNum(), "it has no points");
    Track track = Made(segments, heights, *lines.front());
    track.name = PlacemarkName(*lines.front());
    RecordThatOnlyTheFirstCounts(drawn, "LineStrings", track);
    return track;
  }

  /// Returns the altitudeMode of the line or of the nearest enclosing element.
  [[nodiscard]] static const XMLElement* AltitudeModeOf(const XMLElement& line) {
    for (const tinyxml2::XMLNode* node = &line; node != nullptr; node = node->Parent()) {
      const XMLElement* element = node->ToElement();
      if (element == nullptr) break;
      if (const XMLElement* mode = ChildOf(*element, "altitudeMode")) return mode;
    }
    return nullptr;
  }

  [[nodiscard]] TrackHeights HeightsOf(const XMLElement& line) const {
    const XMLElement* mode = AltitudeModeOf(line);
    const std::string_view text = TextOf(mode);
    if (mode == nullptr || text == "clampToGround" || text == "clampToSeaFloor") {
      return TrackHeights::kOnGround;
    }
    if (text == "relativeToGround" || text == "relativeToSeaFloor") {
      return TrackHeights::kOverGround;
    }
    if (text == "absolute") return TrackHeights::kSea;
    Fail(mode->GetLineNum(), fmt::format("altitudeMode is \"{}\"; known are clampToGround, "
                                         "relativeToGround and absolute",
                                         text));
  }

  [[nodiscard]] static std::string PlacemarkName(const XMLElement& line) {
    for (const tinyxml2::XMLNode* node = line.Parent(); node != nullptr; node = node->Parent()) {
      const XMLElement* element = node->ToElement();
      if (element != nullptr && NameOf(*element) == "Placemark") {
        return std::string(TextOf(ChildOf(*element, "name")));
      }
    }
    return "";
  }

  /// Removes and returns the text up to the first separator, and removes the separators that
  /// follow.
  [[nodiscard]] static std::string_view TakePart(std::string_view& text,
                                                 std::string_view separators) {
    const std::size_t end = std::min(text.find_first_of(separators), text.size());
    const std::string_view part = text.substr(0, end);
    text.remove_prefix(std::min(text.find_first_not_of(separators, end), text.size()));
    return part;
  }

  /// Parses "8.5 47.3 410" or "8.5,47.3,410": longitude first. The height is optional.
  [[nodiscard]] RecordedPoint Coordinate(std::string_view text, std::string_view separators,
                                         const XMLElement& at) {
    const std::string_view all = text;
    std::vector<std::string_view> parts;
    while (!text.empty()) parts.push_back(TakePart(text, separators));
    RecordedPoint point;
    const auto value = [&](std::size_t i) -> std::optional<double> {
      if (parts.size() < 2 || parts.size() > 3)
        throw InputError(fmt::format("\"{}\" is no coordinate", all));
      return i < parts.size() ? NumberIfAny(parts[i], "a coordinate") : std::nullopt;
    };
    const auto longitude = Tried(at, [&] { return value(0); });
    const auto latitude = Tried(at, [&] { return value(1); });
    SetPlace(latitude, longitude, at, point);
    point.height_m = Tried(at, [&] { return HeightIn(value(2)); });
    return point;
  }

  [[nodiscard]] RecordedSegment LineString(const XMLElement& line) {
    const XMLElement* coordinates = ChildOf(line, "coordinates");
    std::string_view text = TextOf(coordinates);
    RecordedSegment segment;
    while (!text.empty())
      segment.push_back(Coordinate(TakePart(text, kTrackBlanks), ",", *coordinates));
    return segment;
  }

  [[nodiscard]] RecordedSegment KmlTrack(const XMLElement& element) {
    const std::vector<const XMLElement*> places = All(element, "coord");
    const std::vector<const XMLElement*> times = All(element, "when");
    if (places.size() != times.size()) {
      Fail(element.GetLineNum(), fmt::format("it has {} gx:coord and {} when; as many are needed",
                                             places.size(), times.size()));
    }
    RecordedSegment segment;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const std::string_view text = TextOf(places[i]);
      RecordedPoint point;
      if (!text.empty()) point = Coordinate(text, kTrackBlanks, *places[i]);
      point.utc = Instant(times[i]);
      segment.push_back(point);
    }
    return segment;
  }

  struct Fault {
    int line;
    std::string text;
  };

  std::optional<Fault> first_fault_;  // of a value of a point
  std::string file_;
  tinyxml2::XMLDocument document_;
};

}  // namespace

Track ReadTrack(const std::filesystem::path& file) {
  Track track = TrackReader(file).Read();
  track.file = file.string();
  return track;
}

}  // namespace alpenglow::renderer
