// SPDX-License-Identifier: MIT
// Provides the list of named places (airports, peaks and cities) and the time zones there. The list
// is renderer/data/places.csv, which names its sources: aeronautical publications, national
// surveys, atlases.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/time_place/geodesy.h"
#include "atmosphere/time_place/time.h"
#include "renderer/layer.h"

namespace alpenglow::renderer {

enum class PlaceKind { kAirport, kPeak, kCity, kPole };

struct NamedPlace {
  PlaceKind kind;
  std::string code;        // ICAO code of airports: "LSZH"; otherwise empty
  std::string name, also;  // "Dufourspitze" and "Monte Rosa"; UTF-8
  Place place;             // the height is above the sea
  double heading_rad;      // heading of the runway
  std::string zone;        // IANA name
};

/// Returns all places, airports first.
[[nodiscard]] std::span<const NamedPlace> NamedPlaces();

/// Returns at most `most` places whose code or name, or a word of it, begins with the text; whole
/// names come first. Case and accents are ignored, and ø and ß match o and ss: "zurich", "tromso",
/// "grossglockner".
[[nodiscard]] std::vector<const NamedPlace*> FindPlaces(std::string_view text,
                                                        std::size_t most = 10);

/// Returns the places that FindPlaces finds, those of equal rank by name; for a text without
/// letters, all places by name. The order of names is alphabetical without accents.
[[nodiscard]] std::vector<const NamedPlace*> PlacesByName(std::string_view text);

/// Returns the place with this code or whole name, or the only one that begins with the text.
/// Throws InputError otherwise, with the candidates.
[[nodiscard]] const NamedPlace& PlaceNamed(std::string_view text);

/// Returns the time zone at a place: that of the scene within 300 km of the scene, that of the
/// nearest place of the list within 150 km, otherwise the whole hour of the longitude ("Etc/GMT-9"
/// is nine hours ahead).
[[nodiscard]] std::string ZoneNear(const Place& place, const std::optional<std::string>& scene_zone,
                                   const Place& scene_place);

/// Local time at a place.
struct LocalTime {
  std::string date, time, offset;  // "2026-06-21", "13:00:00", "+09:00"
  std::string zone;                // "Asia/Tokyo"; "UTC+9" for a zone by longitude
  double day_fraction;             // elapsed fraction of the day, [0, 1)
};
/// Throws InputError if the zone does not exist.
[[nodiscard]] LocalTime LocalTimeAt(const UtcTime& instant, const std::string& zone);

}  // namespace alpenglow::renderer
