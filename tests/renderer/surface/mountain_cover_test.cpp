// SPDX-License-Identifier: MIT
// Where mountains of the earth are green, grey and white, against what is known of them.
#include "renderer/material/land_cover.h"

#include <gtest/gtest.h>

#include <cmath>

#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/time_place/time.h"
#include "renderer/surface/surface.h"

namespace alpenglow::renderer {
namespace {

MountainCover On(const char* day, double latitude, double longitude) {
  return CoverInSeason(PlaceFromDegrees(latitude, longitude, 0.0),
                       ParseInstant(std::string(day) + "T12:00:00Z").modified_julian_day);
}

/// Albedo of gentle ground in the green, over the wavering of its lines.
double GentleAlbedo(const MountainCover& cover, double altitude_m) {
  const MountainSurface surface(WavelengthSet(4), cover);
  double sum = 0.0;
  constexpr int kPlaces = 400;
  for (int i = 0; i < kPlaces; ++i) {
    const GroundPoint at{1e5 + 713.0 * i, 5e6 - 419.0 * i, altitude_m, 1.0};
    sum += static_cast<double>(surface.Albedo(at, 0.95)[1]);
  }
  return sum / kPlaces;
}

TEST(MountainCover, RainierInJulyIsWhiteFromTwoAndAHalfKilometresAndNotBelowTwo) {
  const MountainCover cover = On("2026-07-15", 46.85, -121.76);
  EXPECT_NEAR(cover.snow_line_m, 2150.0, 150.0) << "its glaciers are white from 2100 to 2500 m";
  EXPECT_GT(GentleAlbedo(cover, 2600.0), 0.7) << "snow is 0.84";
  EXPECT_LT(GentleAlbedo(cover, 1800.0), 0.25) << "meadow and rock";
}

TEST(MountainCover, FujiIsWhiteInMidNovemberAndBareInAugust) {
  const MountainCover november = On("2026-11-15", 35.36, 138.73);
  EXPECT_NEAR(november.snow_line_m, 2500.0, 300.0);
  EXPECT_GT(GentleAlbedo(november, 3300.0), 0.75);
  EXPECT_LT(GentleAlbedo(november, 2000.0), 0.2);
  EXPECT_GT(On("2026-08-15", 35.36, 138.73).snow_line_m, 3776.0 + 200.0) << "of its summit";
  EXPECT_LT(On("2026-10-04", 35.36, 138.73).snow_line_m, 3776.0)
      << "its first snow is seen from Kofu about 2 October in the mean";
}

TEST(MountainCover, GlaciersOfTheOetztalAreWhiteInSeptember) {
  const MountainCover cover = On("2026-09-15", 46.9, 10.9);
  EXPECT_NEAR(cover.snow_line_m, 3000.0, 100.0);
  EXPECT_GT(GentleAlbedo(cover, 3500.0), 0.75);
  EXPECT_LT(GentleAlbedo(cover, 2500.0), 0.25);
}

TEST(MountainCover, TreesEndWhereTheyDo) {
  EXPECT_NEAR(On("2026-06-15", 35.36, 138.73).tree_line_m, 2500.0, 60.0) << "Fuji";
  EXPECT_NEAR(On("2026-06-15", 46.9, 10.9).tree_line_m, 2100.0, 100.0) << "Alps, 2000 to 2200 m";
  EXPECT_NEAR(On("2026-06-15", 40.0, -105.7).tree_line_m, 3450.0, 100.0) << "Front Range";
  EXPECT_NEAR(On("2026-06-15", -44.0, 169.5).tree_line_m, 1250.0, 100.0) << "New Zealand";
  EXPECT_LT(On("2026-06-15", 79.0, 12.0).tree_line_m, -500.0) << "none on Svalbard";
}

// Koerner (1998), Oecologia 115, 445: from 70 to 50 degrees north tree lines rise by 75 m a degree,
// and from 30 north to 20 south they lie between 3500 and 4000 m. Where no massif is near.
TEST(MountainCover, TreeLinesRiseTowardsTheTropicsAsKoernerFoundThem) {
  const auto tree_line_m = [](double latitude, double longitude) {
    return MountainClimateAt(PlaceFromDegrees(latitude, longitude, 0.0)).tree_line_m;
  };
  EXPECT_NEAR((tree_line_m(50.0, 115.0) - tree_line_m(70.0, 115.0)) / 20.0, 75.0, 10.0);
  for (const double latitude : {29.0, 20.0, 10.0, 0.0, -10.0, -20.0})
    EXPECT_NEAR(tree_line_m(latitude, -140.0), 3750.0, 300.0) << latitude;
}

// As collected in the article on the tree line of Wikipedia, of single mountains.
TEST(MountainCover, TreeLinesAreThoseOfTheLands) {
  struct Land {
    const char* name;
    double latitude, longitude, line_m;
  };
  for (const Land& land : {Land{"Sweden", 68.0, 18.5, 800.0},
                           {"Norway", 61.0, 8.5, 1100.0},
                           {"Swiss Alps", 46.5, 8.0, 2100.0},
                           {"Alps of Piedmont", 45.0, 7.0, 2100.0}}) {
    EXPECT_NEAR(MountainClimateAt(PlaceFromDegrees(land.latitude, land.longitude, 0.0)).tree_line_m,
                land.line_m, 200.0)
        << land.name << ": outer and inner valleys of the Alps differ by as much";
  }
}

// Glaciers of long series (World Glacier Monitoring Service), rounded to 50 m; none is a massif of
// the table, and all lie in valleys that are moister or drier than the massif.
TEST(MountainCover, SnowOutlastsTheSummerAboutTheEquilibriumLinesOfGlaciers) {
  struct Glacier {
    const char* name;
    double latitude, longitude, line_m;
  };
  for (const Glacier& glacier : {Glacier{"Hintereisferner", 46.80, 10.77, 3000.0},
                                 {"Gries", 46.43, 8.33, 2900.0},
                                 {"Saint-Sorlin", 45.16, 6.16, 2900.0},
                                 {"Storglaciaeren", 67.90, 18.57, 1450.0},
                                 {"Nigardsbreen", 61.72, 7.13, 1550.0},
                                 {"South Cascade", 48.36, -121.06, 1950.0},
                                 {"Peyto", 51.67, -116.55, 2650.0},
                                 {"Gulkana", 63.28, -145.42, 1750.0},
                                 {"Tuyuksu", 43.05, 77.08, 3800.0},
                                 {"Djankuat", 43.20, 42.77, 3200.0},
                                 {"White", 79.45, -90.70, 950.0}}) {
    const GeodeticPosition place = PlaceFromDegrees(glacier.latitude, glacier.longitude, 0.0);
    EXPECT_NEAR(MountainClimateAt(place).ice_line_m, glacier.line_m, 400.0) << glacier.name;
  }
}

TEST(MountainCover, AMassifThatWasObservedIsAsItWasObserved) {
  const MountainClimate alps = MountainClimateAt(PlaceFromDegrees(46.9, 10.9, 0.0));
  EXPECT_NEAR(alps.winter_line_m, 641.0, 60.0) << "Hantel, Maurer (2011); the bound of the header";
  EXPECT_NEAR(alps.ice_line_m, 3000.0, 60.0);
}

TEST(MountainCover, SnowComesDownFasterThanItGoes) {
  EXPECT_NEAR(On("2026-11-15", 46.9, 10.9).snow_line_m, 1700.0, 100.0);
  EXPECT_NEAR(On("2026-02-15", 46.9, 10.9).snow_line_m, 641.0, 100.0);
  EXPECT_NEAR(On("2026-04-15", 46.9, 10.9).snow_line_m, 1500.0, 100.0);
  EXPECT_NEAR(On("2026-06-15", 46.9, 10.9).snow_line_m, 2600.0, 100.0);
}

TEST(MountainCover, TheSouthHasItsWinterHalfAYearLater) {
  for (int day = 61000; day < 61366; day += 15) {
    EXPECT_NEAR(WinterShare(-0.7, day), WinterShare(0.7, day + 183), 0.02)
        << "half a year is 182.6 days, and a day is at most 0.012";
  }
}

TEST(MountainCover, TheTropicsHaveNoWinter) {
  const MountainClimate kenya = MountainClimateAt(PlaceFromDegrees(-0.15, 37.3, 0.0));
  EXPECT_LT(kenya.ice_line_m - kenya.winter_line_m, 200.0);
}

TEST(MountainCover, AntarcticaIsWhiteDownToTheSeaInItsSummer) {
  EXPECT_LT(On("2026-01-31", -80.0, 30.0).snow_line_m, -600.0) << "the line wavers by 400 m";
}

TEST(MountainCover, LinesDoNotJumpOnTheWayRoundTheWorld) {
  for (const double latitude : {-80.0, -43.0, 0.0, 35.4, 46.9, 67.0}) {
    MountainClimate before = MountainClimateAt(PlaceFromDegrees(latitude, -180.0, 0.0));
    for (double longitude = -179.5; longitude <= 180.0; longitude += 0.5) {
      const MountainClimate here = MountainClimateAt(PlaceFromDegrees(latitude, longitude, 0.0));
      EXPECT_NEAR(here.ice_line_m, before.ice_line_m, 250.0)
          << latitude << " " << longitude << ": half a degree is at most a seventh of a reach";
      before = here;
    }
  }
}

TEST(MountainCover, BeechesOfTheAlpsAreInLeafFromTheEndOfAprilAndBareInNovember) {
  EXPECT_LT(On("2026-04-10", 46.5, 8.0).leaf_line_m, 500.0);
  EXPECT_NEAR(On("2026-04-25", 46.5, 8.0).leaf_line_m, 500.0, 50.0) << "a day is 30 m";
  EXPECT_GT(On("2026-05-15", 46.5, 8.0).leaf_line_m, 1000.0);
  EXPECT_GT(On("2026-10-20", 46.5, 8.0).bare_line_m, 500.0);
  EXPECT_LT(On("2026-10-20", 46.5, 8.0).leaf_line_m, 500.0) << "yellow between both";
  EXPECT_LT(On("2026-11-10", 46.5, 8.0).bare_line_m, 500.0);
  EXPECT_LT(On("2026-02-10", 46.5, 8.0).grass_line_m, -300.0) << "grass sleeps";
}

TEST(MountainCover, SpringTakesFourDaysFor122MetresAndForADegree) {
  const double here = On("2026-04-20", 46.5, 8.0).leaf_line_m;
  EXPECT_NEAR(On("2026-04-24", 46.5, 8.0).leaf_line_m - here, 122.0, 0.1);
  EXPECT_NEAR(On("2026-04-24", 47.5, 8.0).leaf_line_m - here, 0.0, 0.1);
}

TEST(MountainCover, TheTropicsAreGreenAllTheYear) {
  for (int day = 61000; day < 61366; day += 10) {
    for (const double latitude : {-20.0, 0.0, 20.0}) {
      const MountainCover cover = CoverInSeason(PlaceFromDegrees(latitude, 30.0, 0.0), day);
      EXPECT_GT(cover.leaf_line_m, 500.0) << latitude << " " << day;
      EXPECT_GT(cover.grass_line_m, 500.0) << latitude << " " << day;
    }
  }
}

TEST(MountainCover, SnowLiesLowerOnSlopesThatTheSunDoesNotSee) {
  for (const double latitude : {46.5, -43.6}) {
    MountainCover cover = On("2026-01-15", latitude, 10.0);
    cover.tree_line_m = -1000.0;
    cover.snow_line_m = 2000.0;
    const MountainSurface surface(WavelengthSet(4), cover);
    GroundPoint polewards{0.0, 0.0, 2050.0, 1e4};
    polewards.normal_north = latitude > 0.0 ? 0.4 : -0.4;
    GroundPoint sunwards = polewards;
    sunwards.normal_north = -polewards.normal_north;
    EXPECT_GT(surface.Albedo(polewards, 0.9)[1], 0.6F) << latitude;
    EXPECT_LT(surface.Albedo(sunwards, 0.9)[1], 0.4F) << latitude;
  }
}

TEST(MountainCover, MoreSnowIsSeenInALeaflessWoodThanUnderConifers) {
  MountainCover winter{2150.0, 650.0, -2000.0, -2000.0, -2000.0};
  const GroundPoint at{0.0, 0.0, 1000.0, 1e4};
  const float conifers = MountainSurface(WavelengthSet(4), winter).Albedo(at, 0.88)[1];
  winter.broadleaf_line_m = 2000.0;
  const float leafless = MountainSurface(WavelengthSet(4), winter).Albedo(at, 0.88)[1];
  EXPECT_NEAR(conifers, 0.14F, 0.03F) << "Betts, Ball (1997): 0.13";
  EXPECT_NEAR(leafless, 0.21F, 0.03F) << "Betts, Ball (1997): 0.21 of aspen";
}

TEST(MountainCover, SnowUnderAWoodIsMostlyHidden) {
  MountainCover winter;
  winter.tree_line_m = 2150.0;
  winter.snow_line_m = 650.0;
  const MountainSurface surface(WavelengthSet(4), winter);
  const GroundPoint at{0.0, 0.0, 1300.0, 1e4};
  EXPECT_NEAR(static_cast<double>(surface.Albedo(at, 0.88)[1]), 0.14, 0.05)
      << "a slope of wood; Betts, Ball (1997) measured 0.13";
  EXPECT_GT(surface.Albedo({0.0, 0.0, 2900.0, 1e4}, 0.88)[1], 0.8F) << "over the trees";
}

}  // namespace
}  // namespace alpenglow::renderer
