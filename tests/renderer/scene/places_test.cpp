// SPDX-License-Identifier: MIT
#include "renderer/scene/places.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "atmosphere/math/constants.h"
#include "atmosphere/time_place/time_zone.h"
#include "tests/fixtures/fault_of.h"

namespace alpenglow::renderer {
namespace {

using ::testing::HasSubstr;

TEST(Places, EveryPlaceHasAZoneThatKnowsItsLongitude) {
  const UtcTime winter = ParseInstant("2026-01-15T12:00:00Z");
  std::set<std::string> names;
  for (const NamedPlace& place : NamedPlaces()) {
    EXPECT_TRUE(names.insert(place.name).second) << place.name << " is there twice";
    EXPECT_EQ(place.code.size(), place.kind == PlaceKind::kAirport ? 4U : 0U) << place.name;
    const std::string local = FormatInZone(winter, place.zone);
    if (place.kind == PlaceKind::kPole) continue;
    const double hours = std::stod(local.substr(19, 3));
    const double of_sun = place.place.longitude_deg / 15.0;
    EXPECT_LT(std::abs(std::remainder(hours - of_sun, 24.0)), 3.3)
        << place.name << ": Lhasa keeps the time of Beijing";
  }
  EXPECT_GT(names.size(), 100U);
}

TEST(Places, HeightsAreThoseOfTheEarth) {
  for (const NamedPlace& place : NamedPlaces()) {
    const double most_m = place.kind == PlaceKind::kPeak ? 8850.0 : 4100.0;
    const double least_m = place.kind == PlaceKind::kPeak ? 1000.0 : -10.0;
    EXPECT_GE(place.place.height_m, least_m) << place.name;
    EXPECT_LE(place.place.height_m, most_m) << place.name;
  }
}

TEST(Places, AnAirportIsNearTheCityThatItServes) {
  for (const auto& [airport, city] : {std::pair{"LSZH", "Zürich"},
                                      {"KJFK", "New York"},
                                      {"EGLL", "London"},
                                      {"NZQN", "Queenstown"},
                                      {"YSSY", "Sydney"},
                                      {"RJTT", "Tokyo"},
                                      {"SLLP", "La Paz"},
                                      {"FACT", "Cape Town"},
                                      {"PANC", "Anchorage"},
                                      {"SBRJ", "Rio de Janeiro"},
                                      {"ENTC", "Tromsø"},
                                      {"KDEN", "Denver"}}) {
    const Place a = PlaceNamed(airport).place, b = PlaceNamed(city).place;
    const double north_km = 6371.0 * (a.latitude_rad() - b.latitude_rad());
    const double east_km =
        6371.0 * (a.longitude_rad() - b.longitude_rad()) * std::cos(a.latitude_rad());
    EXPECT_LT(std::hypot(north_km, east_km), 35.0) << airport;
  }
}

TEST(Places, AreFoundByCodeNameOrPrefixIgnoringCaseAndAccents) {
  EXPECT_EQ(PlaceNamed("LSZH").name, "Zürich Airport");
  EXPECT_EQ(PlaceNamed("kjfk").name, "New York JFK");
  EXPECT_EQ(PlaceNamed("Mont Blanc").place.height_m, 4806.0);
  EXPECT_EQ(PlaceNamed("zurich").kind, PlaceKind::kCity) << "the whole name before a beginning";
  EXPECT_EQ(PlaceNamed("TROMSØ").name, "Tromsø");
  EXPECT_EQ(PlaceNamed("tromso").name, "Tromsø");
  EXPECT_EQ(PlaceNamed("grossglockner").name, "Großglockner");
  EXPECT_EQ(PlaceNamed("fuji").name, "Mount Fuji") << "a word in the name";
  EXPECT_EQ(PlaceNamed("chomo").name, "Mount Everest");
  EXPECT_EQ(PlaceNamed("  st helens ").name, "Mount St. Helens");
  EXPECT_EQ(PlaceNamed("ohare").name, "Chicago O'Hare");
}

TEST(Places, UnknownNamesAreRefusedWithSuggestions) {
  const auto fault = [](const char* text) {
    return tests::FaultOf([&] { return PlaceNamed(text).name; });
  };
  EXPECT_THAT(fault("Mattehorn"), HasSubstr("did you mean Matterhorn?"));
  EXPECT_THAT(fault("LSZG"), HasSubstr("did you mean"));
  EXPECT_THAT(fault("Mount"), HasSubstr("could be Mount "));
  EXPECT_THAT(fault("qqqqqqqqqq"), HasSubstr("there is no place \"qqqqqqqqqq\" in the list"));
  EXPECT_THAT(fault(""), HasSubstr("there is no place"));
  for (const char* far : {"", "x", "K", "東京", "Wuppertal", "Ürümqi", "zz", "qq"})
    EXPECT_THAT(fault(far), Not(HasSubstr("did you mean"))) << far;
  EXPECT_EQ(PlaceNamed("Köln").name, "Cologne");
  EXPECT_THAT(fault("Kölm"), HasSubstr("did you mean Cologne?")) << "one letter, of two bytes";
  EXPECT_THAT(fault("Zermatz"), HasSubstr("did you mean Zermatt?"));
}

TEST(Places, SearchesReturnTheBestFirstUpToALimit) {
  const auto found = FindPlaces("z");
  ASSERT_GE(found.size(), 2U);
  EXPECT_EQ(FindPlaces("mo", 3).size(), 3U);
  EXPECT_EQ(FindPlaces("zurich")[0]->kind, PlaceKind::kCity);
  EXPECT_EQ(FindPlaces("zurich")[1]->code, "LSZH");
  EXPECT_TRUE(FindPlaces("").empty());
}

std::vector<std::string> NamesOf(const std::vector<const NamedPlace*>& places) {
  std::vector<std::string> names;
  for (const NamedPlace* place : places) names.push_back(place->name);
  return names;
}

TEST(Places, AllAreListedByNameWithoutRegardToAccents) {
  const std::vector<std::string> names = NamesOf(PlacesByName(""));
  EXPECT_EQ(names.size(), NamedPlaces().size());
  EXPECT_EQ(names, NamesOf(PlacesByName(" ")));
  const auto at = [&](const char* name) {
    const auto found = std::find(names.begin(), names.end(), name);
    EXPECT_NE(found, names.end()) << name;
    return found;
  };
  EXPECT_LT(at("Großglockner"), at("Hvannadalshnúkur"));
  EXPECT_LT(at("Zürich"), at("Zürich Airport"));
  EXPECT_GT(at("Zürich"), at("Vienna"));
  EXPECT_EQ(names.back(), "Zürich Airport") << "not behind all that is written in ASCII";
}

TEST(Places, AListedNameLeadsToItsPlace) {
  for (const NamedPlace& place : NamedPlaces()) EXPECT_EQ(&PlaceNamed(place.name), &place);
}

TEST(Places, SearchedListsHaveTheBestFirst) {
  EXPECT_EQ(NamesOf(PlacesByName("zurich")),
            (std::vector<std::string>{"Zürich", "Zürich Airport"}));
  EXPECT_EQ(NamesOf(PlacesByName("ZÜRICH")), NamesOf(PlacesByName("zurich")));
  EXPECT_EQ(NamesOf(PlacesByName("kloten")), (std::vector<std::string>{"Zürich Airport"}));
  const std::vector<std::string> mounts = NamesOf(PlacesByName("mount"));
  EXPECT_GT(mounts.size(), 10U) << "more than FindPlaces gives";
  EXPECT_TRUE(std::is_sorted(mounts.begin(), mounts.begin() + 5));
  EXPECT_TRUE(PlacesByName("qqqqqq").empty());
}

TEST(Places, ZoneIsTheScenesOrTheNearestPlacesOrTheLongitudes) {
  const Place alps{46.5, 8.0, 0.0};
  EXPECT_EQ(ZoneNear(alps, "Europe/Rome", alps), "Europe/Rome");
  EXPECT_EQ(ZoneNear(alps, std::nullopt, alps), "Europe/Zurich");
  const Place japan{35.3, 138.8, 0.0};
  EXPECT_EQ(ZoneNear(japan, "Europe/Rome", alps), "Asia/Tokyo") << "the scene is far";
  const Place pacific{0.0, -150.0, 0.0};
  EXPECT_EQ(ZoneNear(pacific, std::nullopt, alps), "Etc/GMT+10");
  for (double longitude = -180.0; longitude <= 180.0; longitude += 5.0) {
    const std::string zone = ZoneNear(CheckedPlace({-55.0, longitude, 0.0}), std::nullopt, alps);
    EXPECT_NO_THROW(static_cast<void>(TimeZone(zone))) << zone;
  }
}

TEST(Places, LocalTimeNamesItsZoneAndTheShareOfTheDay) {
  const UtcTime now = ParseInstant("2026-06-21T04:00:00Z");
  const LocalTime tokyo = LocalTimeAt(now, "Asia/Tokyo");
  EXPECT_EQ(tokyo.date + " " + tokyo.time + tokyo.offset, "2026-06-21 13:00:00+09:00");
  EXPECT_EQ(tokyo.zone, "Asia/Tokyo");
  EXPECT_NEAR(tokyo.day_fraction, 13.0 / 24.0, 1e-12);
  const LocalTime pacific = LocalTimeAt(now, "Etc/GMT+10");
  EXPECT_EQ(pacific.date, "2026-06-20");
  EXPECT_EQ(pacific.zone, "UTC-10");
  EXPECT_NEAR(pacific.day_fraction, 18.0 / 24.0, 1e-12);
  EXPECT_EQ(LocalTimeAt(now, "Etc/GMT").zone, "UTC");
}

}  // namespace
}  // namespace alpenglow::renderer
