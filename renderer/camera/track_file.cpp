// SPDX-License-Identifier: MIT
#include "renderer/camera/track_file.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <charconv>
#include <string_view>

#include "atmosphere/text/error.h"
#include "atmosphere/text/toml_table.h"

namespace alpenglow {
namespace {

using tinyxml2::XMLElement;

constexpr std::string_view kBlanks = " \t\r\n";

class TrackReader {
 public:
  explicit TrackReader(const std::filesystem::path& file) : file_(file.string()) {
    const std::string text = ReadTextFile(file);
    if (document_.Parse(text.data(), text.size()) == tinyxml2::XML_SUCCESS) return;
    Fail(std::max(document_.ErrorLineNum(), 1),
         fmt::format("this is no XML ({})", document_.ErrorName()));
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

  /// Without its namespace: "gx:Track" is "Track".
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

  /// Elements of a name at any depth, in the order of the file, none inside another.
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
    text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
    const std::size_t last = text.find_last_not_of(kBlanks);
    return last == std::string_view::npos ? text : text.substr(0, last + 1);
  }

  [[nodiscard]] double Number(std::string_view text, const XMLElement& at,
                              std::string_view what) const {
    // XML's numbers may have a plus, which from_chars does not read.
    if (text.starts_with('+')) text.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || error != std::errc() || end != text.data() + text.size()) {
      Fail(at.GetLineNum(), fmt::format("{} is \"{}\"; it must be a number", what, text));
    }
    return value;
  }

  [[nodiscard]] GeodeticPosition Place(double latitude, double longitude, double height_m,
                                       const XMLElement& at) const {
    try {
      // Beyond the spheres that a path may reach, as in files of camera paths.
      return PlaceFromDegrees(latitude, longitude,
                              RequireInRange(height_m, -12000.0, 1e9, "height"));
    } catch (const InputError& error) {
      Fail(at.GetLineNum(), error.what());
    }
  }

  [[nodiscard]] UtcInstant Instant(const XMLElement& element) const {
    try {
      return ParseInstant(TextOf(&element), "Etc/UTC");
    } catch (const InputError& error) {
      Fail(element.GetLineNum(), error.what());
    }
  }

  [[nodiscard]] double Attribute(const XMLElement& point, const char* name) const {
    const char* text = point.Attribute(name);
    if (text == nullptr) {
      Fail(point.GetLineNum(), fmt::format("<{}> has no {}", point.Name(), name));
    }
    return Number(text, point, name);
  }

  [[nodiscard]] Track ReadGpx(const XMLElement& gpx) const {
    Track track;
    std::vector<const XMLElement*> points = All(gpx, "trkpt");
    const XMLElement* owner = ChildOf(gpx, "trk");
    if (points.empty()) {
      owner = ChildOf(gpx, "rte");
      if (owner != nullptr) points = All(*owner, "rtept");
    }
    if (points.empty()) points = All(gpx, "wpt");
    if (points.empty()) Fail(gpx.GetLineNum(), "there is no trkpt, rtept or wpt in it");
    if (owner != nullptr) track.name = TextOf(ChildOf(*owner, "name"));
    for (const XMLElement* point : points) AddGpxPoint(*point, track);
    return track;
  }

  // One point without a height puts the track on the ground: the others' would jump to it.
  void AddGpxPoint(const XMLElement& point, Track& track) const {
    const XMLElement* height = ChildOf(point, "ele");
    const XMLElement* time = ChildOf(point, "time");
    if (height == nullptr) track.heights = TrackHeights::kOnGround;
    TrackPoint added;
    added.place = Place(Attribute(point, "lat"), Attribute(point, "lon"),
                        height == nullptr ? 0.0 : Number(TextOf(height), *height, "ele"), point);
    if (time != nullptr) added.utc = Instant(*time);
    track.points.push_back(added);
  }

  [[nodiscard]] Track ReadKml(const XMLElement& kml) const {
    Track track;
    const std::vector<const XMLElement*> recorded = All(kml, "Track");
    const std::vector<const XMLElement*> drawn = All(kml, "LineString");
    const XMLElement* first = !recorded.empty() ? recorded.front()
                              : !drawn.empty()  ? drawn.front()
                                                : nullptr;
    if (first == nullptr) Fail(kml.GetLineNum(), "there is no gx:Track and no LineString in it");
    track.heights = HeightsOf(*first);
    track.name = PlacemarkName(*first);
    for (const XMLElement* element : recorded) AddKmlTrack(*element, track);
    if (recorded.empty()) AddLineString(*first, track);
    if (track.points.empty()) Fail(first->GetLineNum(), "it has no points");
    return track;
  }

  [[nodiscard]] TrackHeights HeightsOf(const XMLElement& line) const {
    const XMLElement* mode = ChildOf(line, "altitudeMode");
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

  /// "8.5 47.3 410" or "8.5,47.3,410": longitude first. The height may be left out.
  [[nodiscard]] GeodeticPosition Coordinate(std::string_view text, char separator,
                                            const XMLElement& at) const {
    const std::string_view all = text;
    double values[3] = {0.0, 0.0, 0.0};
    std::size_t count = 0;
    for (; !text.empty() && count < 3; ++count) {
      const std::size_t end = std::min(text.find(separator), text.size());
      values[count] = Number(text.substr(0, end), at, "a coordinate");
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    if (count < 2 || !text.empty()) {
      Fail(at.GetLineNum(), fmt::format("\"{}\" is no coordinate", all));
    }
    return Place(values[1], values[0], values[2], at);
  }

  void AddLineString(const XMLElement& line, Track& track) const {
    const XMLElement* coordinates = ChildOf(line, "coordinates");
    std::string_view text = TextOf(coordinates);
    while (!text.empty()) {
      const std::size_t end = std::min(text.find_first_of(kBlanks), text.size());
      track.points.push_back({Coordinate(text.substr(0, end), ',', *coordinates)});
      text.remove_prefix(end);
      text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
    }
  }

  void AddKmlTrack(const XMLElement& element, Track& track) const {
    const std::vector<const XMLElement*> places = All(element, "coord");
    const std::vector<const XMLElement*> times = All(element, "when");
    if (places.size() != times.size()) {
      Fail(element.GetLineNum(), fmt::format("it has {} gx:coord and {} when; as many are needed",
                                             places.size(), times.size()));
    }
    for (std::size_t i = 0; i < places.size(); ++i) {
      TrackPoint point;
      point.place = Coordinate(TextOf(places[i]), ' ', *places[i]);
      point.utc = Instant(*times[i]);
      track.points.push_back(point);
    }
  }

  std::string file_;
  tinyxml2::XMLDocument document_;
};

}  // namespace

Track ReadTrack(const std::filesystem::path& file) { return TrackReader(file).Read(); }

}  // namespace alpenglow
