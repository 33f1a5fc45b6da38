// SPDX-License-Identifier: MIT
#include "renderer/scene/places.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "atmosphere/base/csv.h"
#include "atmosphere/base/error.h"
#include "atmosphere/base/names.h"
#include "atmosphere/base/parsing.h"
#include "atmosphere/math/constants.h"
#include "renderer/embedded_text.h"

namespace alpenglow::renderer {
namespace {

double ExactNumber(std::string_view text) {
  const std::optional<double> number = ParseNumber(text);
  ALPENGLOW_ENSURE(number.has_value(), ==, true);
  return *number;
}

constexpr EnumNames kPlaceKinds{{std::pair{PlaceKind::kAirport, "airport"},
                                 {PlaceKind::kPeak, "peak"},
                                 {PlaceKind::kCity, "city"},
                                 {PlaceKind::kPole, "pole"}}};

PlaceKind KindOf(std::string_view text) {
  const std::optional<PlaceKind> kind = kPlaceKinds.Find(text);
  ALPENGLOW_ENSURE(kind.has_value(), ==, true);
  return *kind;
}

NamedPlace PlaceOf(const std::vector<std::string_view>& fields) {
  ALPENGLOW_ENSURE(fields.size(), ==, std::size_t{9});
  NamedPlace place{};
  place.kind = KindOf(fields[0]);
  place.code = fields[1];
  place.name = fields[2];
  place.also = fields[3];
  place.place =
      CheckedPlace({ExactNumber(fields[4]), ExactNumber(fields[5]), ExactNumber(fields[6])});
  place.heading_rad = ExactNumber(fields[7]) * kRadiansPerDegree;
  place.zone = fields[8];
  return place;
}

std::vector<NamedPlace> ReadPlaces() {
  std::vector<NamedPlace> places;
  atmosphere::VisitCsvRows(
      renderer::EmbeddedText("renderer/data/places.csv"),
      [&](const atmosphere::CsvRecord& row) { places.push_back(PlaceOf(row.fields)); });
  return places;
}

/// Returns the letters without accent for a letter of Latin-1 or Latin Extended-A (two bytes of
/// UTF-8).
std::string_view WithoutAccent(int code_point) {
  struct LetterRange {
    int first, last;
    std::string_view letter;
  };
  constexpr LetterRange kRanges[] = {
      {0xC0, 0xC5, "a"},    {0xC6, 0xC6, "ae"},  {0xC7, 0xC7, "c"},   {0xC8, 0xCB, "e"},
      {0xCC, 0xCF, "i"},    {0xD0, 0xD0, "d"},   {0xD1, 0xD1, "n"},   {0xD2, 0xD6, "o"},
      {0xD8, 0xD8, "o"},    {0xD9, 0xDC, "u"},   {0xDD, 0xDD, "y"},   {0xDE, 0xDE, "th"},
      {0xDF, 0xDF, "ss"},   {0xE0, 0xE5, "a"},   {0xE6, 0xE6, "ae"},  {0xE7, 0xE7, "c"},
      {0xE8, 0xEB, "e"},    {0xEC, 0xEF, "i"},   {0xF0, 0xF0, "d"},   {0xF1, 0xF1, "n"},
      {0xF2, 0xF6, "o"},    {0xF8, 0xF8, "o"},   {0xF9, 0xFC, "u"},   {0xFD, 0xFD, "y"},
      {0xFE, 0xFE, "th"},   {0xFF, 0xFF, "y"},   {0x100, 0x105, "a"}, {0x106, 0x10D, "c"},
      {0x10E, 0x111, "d"},  {0x112, 0x11B, "e"}, {0x11C, 0x123, "g"}, {0x124, 0x127, "h"},
      {0x128, 0x131, "i"},  {0x139, 0x142, "l"}, {0x143, 0x148, "n"}, {0x14C, 0x151, "o"},
      {0x152, 0x153, "oe"}, {0x154, 0x159, "r"}, {0x15A, 0x161, "s"}, {0x162, 0x167, "t"},
      {0x168, 0x173, "u"},  {0x179, 0x17E, "z"}};
  for (const LetterRange& range : kRanges) {
    if (code_point >= range.first && code_point <= range.last) return range.letter;
  }
  return "";
}

/// Returns letters and digits in lower case without accents; other characters between them become
/// one blank.
std::string Folded(std::string_view text) {
  std::string folded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte >= 0xC2 && byte <= 0xC5 && i + 1 < text.size()) {
      folded +=
          WithoutAccent(((byte & 0x1F) << 6) | (static_cast<unsigned char>(text[++i]) & 0x3F));
    } else if ((byte >= 'a' && byte <= 'z') || (byte >= '0' && byte <= '9')) {
      folded += static_cast<char>(byte);
    } else if (byte >= 'A' && byte <= 'Z') {
      folded += static_cast<char>(byte - 'A' + 'a');
    } else if (byte != '\'' && !folded.empty() && folded.back() != ' ') {
      folded += ' ';
    }
  }
  while (!folded.empty() && folded.back() == ' ') folded.pop_back();
  return folded;
}

/// Returns 0 for the whole name, 1 for its beginning, 2 for the beginning of a word in it, 3
/// otherwise.
int RankOf(const std::string& name, const std::string& text) {
  if (name == text) return 0;
  if (name.starts_with(text)) return 1;
  return name.find(" " + text) != std::string::npos ? 2 : 3;
}

/// Returns the best rank of all names. The beginning of the alternative name ranks as the beginning
/// of a word.
int RankOf(const NamedPlace& place, const std::string& text) {
  const int of_other = RankOf(Folded(place.also), text);
  return std::min({RankOf(Folded(place.code), text), RankOf(Folded(place.name), text),
                   of_other == 1 ? 2 : of_other});
}

struct Ranked {
  int rank;
  const NamedPlace* place;
};

/// Returns the matching places, best first; places of equal rank keep the order of the list.
std::vector<Ranked> RankedPlaces(std::string_view text) {
  constexpr int kNoMatch = 3;
  const std::string folded = Folded(text);
  std::vector<Ranked> ranked;
  if (folded.empty()) return ranked;
  for (const NamedPlace& place : NamedPlaces()) {
    const int rank = RankOf(place, folded);
    if (rank < kNoMatch) ranked.push_back({rank, &place});
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const Ranked& a, const Ranked& b) { return a.rank < b.rank; });
  return ranked;
}

[[noreturn]] void FailUnknown(std::string_view text) {
  std::vector<std::string> known;
  for (const NamedPlace& place : NamedPlaces()) {
    for (const std::string& name : {place.code, place.name, place.also}) {
      if (!name.empty()) known.push_back(Folded(name));
    }
  }
  const std::optional<std::string> nearest = NearestName(Folded(text), known);
  if (!nearest) throw InputError(fmt::format("there is no place \"{}\" in the list", text));
  throw InputError(fmt::format("there is no place \"{}\" in the list; did you mean {}?", text,
                               RankedPlaces(*nearest).front().place->name));
}

double Distance(const Place& a, const Place& b) {
  const glm::dvec3 apart = (EcefFromGeodetic(kWgs84, {a.latitude_deg, a.longitude_deg, 0.0}) -
                            EcefFromGeodetic(kWgs84, {b.latitude_deg, b.longitude_deg, 0.0}))
                               .xyz;
  return std::sqrt(apart.x * apart.x + apart.y * apart.y + apart.z * apart.z);
}

}  // namespace

std::span<const NamedPlace> NamedPlaces() {
  static const std::vector<NamedPlace> places = ReadPlaces();
  return places;
}

std::vector<const NamedPlace*> FindPlaces(std::string_view text, std::size_t most) {
  std::vector<const NamedPlace*> found;
  for (const Ranked& ranked : RankedPlaces(text)) {
    if (found.size() < most) found.push_back(ranked.place);
  }
  return found;
}

std::vector<const NamedPlace*> PlacesByName(std::string_view text) {
  std::vector<Ranked> ranked = RankedPlaces(text);
  if (Folded(text).empty()) {
    for (const NamedPlace& place : NamedPlaces()) ranked.push_back({0, &place});
  }
  std::sort(ranked.begin(), ranked.end(), [](const Ranked& a, const Ranked& b) {
    return std::pair(a.rank, Folded(a.place->name)) < std::pair(b.rank, Folded(b.place->name));
  });
  std::vector<const NamedPlace*> places;
  for (const Ranked& one : ranked) places.push_back(one.place);
  return places;
}

const NamedPlace& PlaceNamed(std::string_view text) {
  const std::vector<Ranked> ranked = RankedPlaces(text);
  if (ranked.empty()) FailUnknown(text);
  const bool is_only = ranked.size() == 1 || ranked[1].rank > ranked[0].rank;
  if (is_only || ranked[0].rank == 0) return *ranked[0].place;
  std::vector<std::string> names;
  for (const NamedPlace* place : FindPlaces(text)) names.push_back(place->name);
  throw InputError(fmt::format("place \"{}\" could be {}", text, fmt::join(names, ", ")));
}

std::string ZoneNear(const Place& place, const std::optional<std::string>& scene_zone,
                     const Place& scene_place) {
  constexpr double kOfScene_m = 300e3, kOfList_m = 150e3;
  if (scene_zone && Distance(place, scene_place) < kOfScene_m) return *scene_zone;
  const auto places = NamedPlaces();
  const auto nearest =
      std::min_element(places.begin(), places.end(), [&](const NamedPlace& a, const NamedPlace& b) {
        return Distance(place, a.place) < Distance(place, b.place);
      });
  if (Distance(place, nearest->place) < kOfList_m) return nearest->zone;
  const double turns = std::remainder(place.longitude_deg, 360.0) / 360.0;
  const int ahead_h = static_cast<int>(std::lround(24.0 * turns));
  if (ahead_h == 0) return "Etc/GMT";
  return fmt::format("Etc/GMT{}{}", ahead_h > 0 ? "-" : "+", std::abs(ahead_h));
}

LocalTime LocalTimeAt(const UtcTime& instant, const std::string& zone) {
  const std::string text = FormatInZone(instant, zone);  // "2026-06-21T13:00:00+09:00"
  LocalTime local;
  local.date = text.substr(0, 10);
  local.time = text.substr(11, 8);
  local.offset = text.substr(19);
  local.zone = zone;
  constexpr std::string_view kByLongitude = "Etc/GMT";
  if (zone.starts_with(kByLongitude)) {
    local.zone = zone.substr(kByLongitude.size());
    // In POSIX zone names the sign is positive to the west.
    for (char& c : local.zone) c = c == '-' ? '+' : c == '+' ? '-' : c;
    local.zone.insert(0, "UTC");
  }
  const UtcTime midnight = ParseInstant(local.date + "T00:00:00" + local.offset);
  local.day_fraction = std::clamp(SecondsBetween(midnight, instant) / 86400.0, 0.0, 0.9999999);
  return local;
}

}  // namespace alpenglow::renderer
