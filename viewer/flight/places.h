// SPDX-License-Identifier: MIT
// Airports, peaks and cities that one can fly to by name, and what clocks show there. The list is
// viewer/data/places.csv, which names its sources: aeronautical publications, national surveys,
// atlases.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/sun/time.h"
#include "viewer/flight/flight.h"

namespace alpenglow::viewer {

enum class PlaceKind { kAirport, kPeak, kCity, kPole };

struct NamedPlace {
  PlaceKind kind;
  std::string code;        // ICAO's, of airports: "LSZH"; else empty
  std::string name, also;  // "Dufourspitze" is also "Monte Rosa"; UTF-8
  GeodeticPosition place;  // its height is over the sea
  double heading_rad;      // of the runway
  std::string zone;        // IANA
};

/// All of them, airports first.
[[nodiscard]] std::span<const NamedPlace> NamedPlaces();

/// Those whose code or names begin with the text, or have a word that does, whole names first; at
/// most `most`. Case and accents do not count, nor ø and ß: "zurich", "tromso", "grossglockner".
[[nodiscard]] std::vector<const NamedPlace*> FindPlaces(std::string_view text,
                                                        std::size_t most = 10);

/// Those that FindPlaces finds, by name among equals; all by name for a text without letters. Names
/// are in alphabetical order without their accents.
[[nodiscard]] std::vector<const NamedPlace*> PlacesByName(std::string_view text);

/// The one that is meant: by its code, its whole name, or a beginning that only one has. Throws
/// InputError otherwise, with the names that could be meant.
[[nodiscard]] const NamedPlace& PlaceNamed(std::string_view text);

/// An eye there: at the runway's middle, looking along it, 2 m over the ground; 100 m over a peak;
/// 600 m over a city or a pole, whatever height is published.
[[nodiscard]] Eye EyeAt(const NamedPlace& there, const Eye& before, const GroundHeight& ground);

/// The zone of clocks at a place: the scene's within 300 km of the scene, that of the nearest place
/// in the list within 150 km, else the hour of the longitude ("Etc/GMT-9" is nine hours ahead).
[[nodiscard]] std::string ZoneNear(const GeodeticPosition& place,
                                   const std::optional<std::string>& scene_zone,
                                   const GeodeticPosition& scene_place);

/// What clocks show somewhere.
struct LocalTime {
  std::string date, time, offset;  // "2026-06-21", "13:00:00", "+09:00"
  std::string zone;                // "Asia/Tokyo"; "UTC+9" where the longitude says it
  double day_fraction;             // of the day that has gone by, [0, 1)
};
/// Throws InputError when there is no such zone.
[[nodiscard]] LocalTime LocalTimeAt(const UtcInstant& instant, const std::string& zone);

}  // namespace alpenglow::viewer
