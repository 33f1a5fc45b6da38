// SPDX-License-Identifier: MIT
// Instruments: scales, texts and the strip of the day.
#include "viewer/hud/instruments.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>

#include "atmosphere/astronomy/sun.h"
#include "atmosphere/colour/spectrum.h"
#include "atmosphere/math/constants.h"
#include "lut/image/development.h"
#include "lut/image/image.h"
#include "lut/image/look.h"
#include "lut/image/tone_mapping.h"
#include "lut/sky/sky_view.h"
#include "tests/fixtures/solved_media.h"
#include "tests/viewer/hud/hud_picture.h"
#include "viewer/hud/day_strip.h"
#include "viewer/hud/hud_model.h"
#include "viewer/hud/panel_controls.h"
#include "viewer/hud/scales.h"
#include "viewer/layer.h"

namespace alpenglow::viewer {
namespace {

constexpr int kPanelWidth = 1280, kPanelHeight = 720;

using Instruments = tests::HudPicture;

/// A value of the model and the part of the picture, in shares, that alone may tell of it.
struct Told {
  const char* name;
  std::function<void(HudModel&)> change;
  double left, top, right, bottom;
};

TEST_F(Instruments, EachValueChangesOnlyItsOwnInstrument) {
  const std::vector<Told> cases{
      {"heading", [](HudModel& m) { m.flight.heading_rad += 0.1; }, 0.3, 0.0, 0.7, 0.1},
      {"sun", [](HudModel& m) { m.sky.sun_azimuth_rad = 0.9; }, 0.35, 0.0, 1.0, 0.12},
      {"air speed", [](HudModel& m) { *m.flight.air_speed_m_per_s += 5.0; }, 0.1, 0.3, 0.25, 0.7},
      {"height held", [](HudModel& m) { m.autopilot.height_m = 3300.0; }, 0.0, 0.0, 0.9, 0.7},
      {"climb", [](HudModel& m) { m.flight.climb_m_per_s = 4.0; }, 0.75, 0.6, 0.9, 0.8},
      {"path",
       [](HudModel& m) {
         m.flight.path = Course{0.85, -0.02};
       },
       0.45, 0.4, 0.65, 0.6},
      {"throttle", [](HudModel& m) { m.flight.throttle = 0.9; }, 0.0, 0.0, 0.2, 0.2},
      {"local time", [](HudModel& m) { m.time.local = "19:00:00"; }, 0.8, 0.0, 1.0, 0.2},
      {"latitude", [](HudModel& m) { m.latitude_deg = 17.2; }, 0.0, 0.8, 0.2, 1.0},
      {"exposure", [](HudModel& m) { m.exposure.ev100 = 12.0; }, 0.8, 0.75, 1.0, 1.0},
      {"message",
       [](HudModel& m) {
         m.messages = {{"the terrain is made up", false}};
       },
       0.3, 0.75, 0.7, 0.9},
      {"stall", [](HudModel& m) { m.flight.stall = true; }, 0.4, 0.3, 0.6, 0.45},
      {"progress",
       [](HudModel& m) {
         m.progress = HudProgress{"loading", 0.5};
       },
       0.3, 0.75, 0.7, 0.9}};
  Hud hud;
  const HdrImage before = Drawn(hud, tests::Flying(), kPanelWidth, kPanelHeight);
  for (const Told& told : cases) {
    SCOPED_TRACE(told.name);
    HudModel model = tests::Flying();
    told.change(model);
    const Box box = Difference(before, Drawn(hud, model, kPanelWidth, kPanelHeight));
    EXPECT_FALSE(box.empty());
    EXPECT_GE(box.left, told.left * kPanelWidth);
    EXPECT_GE(box.top, told.top * kPanelHeight);
    EXPECT_LE(box.right, told.right * kPanelWidth);
    EXPECT_LE(box.bottom, told.bottom * kPanelHeight);
  }
}

// Written apart from cameras: rotations about the axes of the aircraft, one after the other.
glm::dvec3 ThroughPixel(const HudFlight& flight, double x, double y) {
  const double focal = 0.5 * kPanelWidth / std::tan(0.5 * flight.fov_rad);
  const glm::dvec3 seen{x - 0.5 * kPanelWidth, 0.5 * kPanelHeight - y, focal};  // right, up, ahead
  const double cr = std::cos(flight.roll_rad), sr = std::sin(flight.roll_rad);
  const glm::dvec3 level{seen.x * cr + seen.y * sr, seen.y * cr - seen.x * sr, seen.z};
  const double cp = std::cos(flight.pitch_rad), sp = std::sin(flight.pitch_rad);
  const glm::dvec3 flat{level.x, level.y * cp + level.z * sp, level.z * cp - level.y * sp};
  const double ch = std::cos(flight.heading_rad), sh = std::sin(flight.heading_rad);
  return glm::normalize(glm::dvec3(flat.x * ch + flat.z * sh, flat.z * ch - flat.x * sh, flat.y));
}

bool IsGreen(const std::array<float, 3>& pixel) {
  return pixel[1] > 0.75F && pixel[0] < 0.6F && pixel[2] < 0.7F;
}

/// Elevation [rad] of the middle of the green line that a column crosses near `near_y`.
std::optional<double> ElevationOfLine(const HdrImage& image, const HudFlight& flight, int x,
                                      int near_y) {
  constexpr int kReach = 12;
  double sum = 0.0;
  int count = 0;
  for (int y = std::max(near_y - kReach, 0); y <= std::min(near_y + kReach, kPanelHeight - 1);
       ++y) {
    if (!IsGreen(image.at(x, y))) continue;
    sum += y + 0.5;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return std::asin(ThroughPixel(flight, x + 0.5, sum / count).z);
}

TEST_F(Instruments, PitchLadderLiesOnTheHorizonOfThePicture) {
  struct Attitude {
    double pitch_deg, roll_deg, fov_deg;
  };
  Hud hud;
  for (const Attitude& attitude :
       {Attitude{0.0, 0.0, 60.0}, Attitude{5.0, 0.0, 60.0}, Attitude{-4.0, 20.0, 60.0},
        Attitude{2.0, -35.0, 90.0}, Attitude{1.0, 10.0, 20.0}, Attitude{-8.0, 5.0, 110.0}}) {
    HudModel model = tests::Flying();
    model.flight.pitch_rad = attitude.pitch_deg * kRadiansPerDegree;
    model.flight.roll_rad = attitude.roll_deg * kRadiansPerDegree;
    model.flight.fov_rad = attitude.fov_deg * kRadiansPerDegree;
    SCOPED_TRACE(fmt::format("pitch {} roll {} view {}", attitude.pitch_deg, attitude.roll_deg,
                             attitude.fov_deg));
    const HdrImage image = Drawn(hud, model, kPanelWidth, kPanelHeight);
    const double pixel_rad = 2.0 * std::tan(0.5 * model.flight.fov_rad) / kPanelWidth;
    int found = 0;
    for (const double aside : {-0.15, -0.11, 0.11, 0.15}) {
      // The reference solution finds where the column meets the horizontal plane.
      const int x = static_cast<int>((0.5 + aside) * kPanelWidth);
      int y = 0;
      while (y < kPanelHeight && ThroughPixel(model.flight, x + 0.5, y + 0.5).z > 0.0) ++y;
      const auto elevation = ElevationOfLine(image, model.flight, x, y);
      ASSERT_TRUE(elevation.has_value()) << "column " << x << ", row " << y;
      EXPECT_NEAR(*elevation, 0.0, 1.0 * pixel_rad)
          << "a line two pixels wide, its middle counted in whole ones";
      ++found;
    }
    EXPECT_EQ(found, 4);
  }
}

TEST_F(Instruments, DoubleScaleOnDoubleResolutionLooksTheSame) {
  Hud once({.scale = 1.0}), twice({.scale = 2.0});
  HudModel model = tests::Flying(), changed = model;
  changed.time.local = "07:03:51";
  const Box small = Difference(Drawn(once, model, kPanelWidth, kPanelHeight),
                               Drawn(once, changed, kPanelWidth, kPanelHeight));
  const Box large = Difference(Drawn(twice, model, 2 * kPanelWidth, 2 * kPanelHeight),
                               Drawn(twice, changed, 2 * kPanelWidth, 2 * kPanelHeight));
  constexpr double kSlack = 8.0;  // pixels: letters are hinted at their size
  EXPECT_NEAR(large.left, 2.0 * small.left, kSlack);
  EXPECT_NEAR(large.right, 2.0 * small.right, kSlack);
  EXPECT_NEAR(large.top, 2.0 * small.top, kSlack);
  EXPECT_NEAR(large.bottom, 2.0 * small.bottom, kSlack);
}

TEST_F(Instruments, SmallestPictureHasNumbersInsteadOfTapes) {
  Hud hud;
  const HdrImage full = Drawn(hud, tests::Flying(), 320, 240);
  HudModel faster = tests::Flying();
  *faster.flight.air_speed_m_per_s = 99.0;
  const Box box = Difference(full, Drawn(hud, faster, 320, 240));
  EXPECT_FALSE(box.empty());
  EXPECT_LE(box.bottom - box.top, 20) << "one line of text";
  EXPECT_LE(box.right, 100);
}

TEST_F(Instruments, LongMessagesWrapInTheSmallestPicture) {
  Hud hud;
  HudModel model = tests::Flying();
  const HdrImage before = Drawn(hud, model, 320, 240);
  model.messages = {
      {"N46E008.hgt has 1201 rows of 3601 samples; the missing ones are taken from "
       "the neighbours of the file",
       true}};
  const Box box = Difference(before, Drawn(hud, model, 320, 240));
  EXPECT_GT(box.left, 0);
  EXPECT_LT(box.right, 320);
  EXPECT_GT(box.bottom - box.top, 40) << "three lines";
}

TEST_F(Instruments, AreDrawnForEveryAttitudeAndView) {
  Hud hud;
  for (const double pitch_deg : {-90.0, -89.9, -45.0, 89.0, 90.0}) {
    for (const double roll_deg : {-180.0, 0.0, 97.0}) {
      for (const double fov_deg : {1.0, 60.0, 120.0}) {
        HudModel model = tests::Flying();
        model.flight.pitch_rad = pitch_deg * kRadiansPerDegree;
        model.flight.roll_rad = roll_deg * kRadiansPerDegree;
        model.flight.fov_rad = fov_deg * kRadiansPerDegree;
        model.flight.path = Course{2.0, 0.1};
        const HdrImage image = Drawn(hud, model, 160, 120);
        EXPECT_FALSE(FaultyValue(image)) << pitch_deg << " " << roll_deg << " " << fov_deg;
      }
    }
  }
}

TEST(PitchLadder, RungsDoNotOverlap) {
  EXPECT_EQ(RungStep_deg(21.3), 5.0) << "60 degrees on 1280 pixels";
  EXPECT_EQ(RungStep_deg(128.0), 1.0);
  EXPECT_EQ(RungStep_deg(4.0), 30.0);
}

TEST(Tapes, MarksAreRoundNumbers) {
  EXPECT_EQ(MarkStep(0.0, 10.0), 10.0);
  EXPECT_EQ(MarkStep(3200.0, 10.0), 100.0);
  EXPECT_EQ(MarkStep(-90000.0, 10.0), 5000.0);
  EXPECT_EQ(MarkStep(245.0, 5.0), 10.0);
}

// --- texts ---

double Radians(double degrees) { return degrees * kRadiansPerDegree; }

TEST(HudText, PlacesHaveLettersForTheHemisphere) {
  EXPECT_EQ(LatitudeText(46.5), "46.5000° N");
  EXPECT_EQ(LatitudeText(-33.0), "33.0000° S");
  EXPECT_EQ(LongitudeText(-8.25), "8.2500° W");
  EXPECT_EQ(LongitudeText(179.9), "179.9000° E");
  EXPECT_EQ(LatitudeText(-90.0), "90.0000° S");
  for (const double longitude : {180.0, -180.0, 179.99999, -179.99999})
    EXPECT_EQ(LongitudeText(longitude), "180.0000° E") << "one meridian has one name";
  EXPECT_EQ(LongitudeText(-0.00001), "0.0000° E");
}

TEST(HudText, HeadingsHaveThreeDigitsBelow360) {
  EXPECT_EQ(HeadingText(Radians(7.2)), "007");
  EXPECT_EQ(HeadingText(Radians(-90.0)), "270");
  EXPECT_EQ(HeadingText(Radians(359.7)), "000") << "not 360";
  EXPECT_EQ(HeadingText(Radians(725.0)), "005");
}

TEST(HudText, ZeroHasNoMinusSign) {
  EXPECT_EQ(DegreesText(Radians(-0.04)), "+0.0°");
  EXPECT_EQ(HeightText(-0.3, HudUnits::kMetric).number, "0");
  EXPECT_EQ(ClimbText(-0.01, HudUnits::kMetric).number, "+0.0");
  EXPECT_EQ(ClimbText(-0.001, HudUnits::kAviation).number, "+0");
}

TEST(HudText, HeightsAndSpeedsFromTheGroundToOrbit) {
  EXPECT_EQ(Joined(HeightText(3241.7, HudUnits::kMetric)), "3242 m");
  EXPECT_EQ(Joined(HeightText(408e3, HudUnits::kMetric)), "408.0 km");
  EXPECT_EQ(Joined(HeightText(304.8, HudUnits::kAviation)), "1000 ft");
  EXPECT_EQ(Joined(SpeedText(10.0, HudUnits::kMetric)), "36 km/h");
  EXPECT_EQ(Joined(SpeedText(7660.0, HudUnits::kMetric)), "7.7 km/s");
  EXPECT_EQ(Joined(SpeedText(51.4444, HudUnits::kAviation)), "100 kt");
  EXPECT_EQ(Joined(ClimbText(5.08, HudUnits::kAviation)), "+1000 ft/min");
}

TEST(HudText, UnitsConvertFromSi) {
  for (const HudUnits units : {HudUnits::kMetric, HudUnits::kAviation}) {
    for (const double value : {120.0, 3e5}) {
      const Quantity height = HeightText(value, units), speed = SpeedText(value, units);
      EXPECT_NEAR(std::stod(height.number), value * height.per_si, 0.5) << "rounded to whole ones";
      EXPECT_NEAR(std::stod(speed.number), value * speed.per_si, 0.5);
    }
  }
}

TEST(HudText, LuminancesHaveThreeSignificantDigits) {
  EXPECT_EQ(LuminanceText(8213.0), "8210 cd/m²");
  EXPECT_EQ(LuminanceText(0.0123456), "0.0123 cd/m²");
  EXPECT_EQ(LuminanceText(1.0), "1.00 cd/m²");
  EXPECT_EQ(LuminanceText(0.0), "0.00e+00 cd/m²");
  EXPECT_EQ(LuminanceText(1.6e9), "1.60e+09 cd/m²") << "the sun's disk";
}

TEST(HudText, RatesOfTimeAreFactors) {
  EXPECT_EQ(RateText(1.0, false), "x1");
  EXPECT_EQ(RateText(-3600.0, false), "x-3600");
  EXPECT_EQ(RateText(0.5, false), "x0.5");
  EXPECT_EQ(RateText(60.0, true), "paused");
}

TEST(HudTheme, NightColoursAreDimWithoutBlue) {
  const HudColours &day = ColoursOf(HudTheme::kDay), &night = ColoursOf(HudTheme::kNight);
  for (const HudColour& colour : {night.text, night.quiet, night.accent, night.warning, night.panel,
                                  night.control, night.active}) {
    EXPECT_LT(colour[2], 0.1F);
    EXPECT_LT(colour[1], 0.5F * day.text[1]);
    EXPECT_GE(colour[0], colour[1]);
  }
}

double LuminanceOf(const HudColour& colour) {
  return shared::Luminance<double>(shared::SrgbLight(double{colour[0]}),
                                   shared::SrgbLight(double{colour[1]}),
                                   shared::SrgbLight(double{colour[2]}));
}

HudColour Over(const HudColour& behind, const HudColour& plate) {
  HudColour seen = behind;
  for (std::size_t c = 0; c < 3; ++c) seen[c] += plate[3] * (plate[c] - behind[c]);
  return seen;
}

double ContrastOf(const HudColour& text, const HudColour& behind) {
  return (LuminanceOf(text) + 0.05) / (LuminanceOf(behind) + 0.05);
}

constexpr HudColour kWhite{1.0F, 1.0F, 1.0F, 1.0F};

TEST(HudTheme, TextOnPanelsIsReadableOverWhite) {
  for (const HudTheme theme : {HudTheme::kDay, HudTheme::kNight}) {
    const HudColours& colours = ColoursOf(theme);
    for (const HudColour& colour : {colours.text, colours.quiet, colours.accent, colours.warning}) {
      EXPECT_GE(ContrastOf(colour, Over(kWhite, colours.panel)), 4.5)
          << colour[0] << " " << colour[1];
    }
  }
}

TEST(HudTheme, TextOnControlsIsReadableOverWhite) {
  for (const HudTheme theme : {HudTheme::kDay, HudTheme::kNight}) {
    const HudColours& colours = ColoursOf(theme);
    const HudColour control = Over(Over(kWhite, colours.panel), colours.control);
    for (const HudColour& behind : {control, Over(control, colours.active)})
      EXPECT_GE(ContrastOf(colours.text, behind), 4.5) << behind[0] << " " << behind[1];
    EXPECT_GE(ContrastOf(colours.quiet, control), 4.5) << "hints in fields";
  }
}

TEST(HudTheme, DoesNotFlickerAtDusk) {
  const auto follow = [](std::initializer_list<double> exposures) {
    HudTheme theme = HudTheme::kDay;
    int changes = 0;
    for (const double ev100 : exposures) {
      const HudTheme next = ThemeFor(HudThemeChoice::kAuto, ev100, theme);
      changes += next == theme ? 0 : 1;
      theme = next;
    }
    return changes;
  };
  EXPECT_EQ(follow({15.0, 5.0, 0.9, 1.4, 0.8, 2.5, -4.0}), 1);
  EXPECT_EQ(follow({15.0, 0.0, 2.0, 3.1, 2.0, 1.1}), 2) << "down and up again";
  EXPECT_EQ(ThemeFor(HudThemeChoice::kNight, 15.0, HudTheme::kDay), HudTheme::kNight);
  EXPECT_EQ(ThemeFor(HudThemeChoice::kDay, -6.0, HudTheme::kNight), HudTheme::kDay);
}

// --- the strip of the day ---

DayStripRequest Alps() {
  // The light is not the request's own: it lasts as long as the tests.
  const std::shared_ptr<const MultipleScattering> light(std::shared_ptr<void>(),
                                                        &tests::Earth().multiple_scattering());
  DayStripRequest request{light, Place{46.0, 8.0, 500.0}, {}, 24};
  request.begin = ParseInstant("2026-03-19T23:28:00Z");  // midnight of the mean sun
  return request;
}

TEST(DayStrip, IsBlueAtNoonBlackAtMidnightAndRedBelowAtDusk) {
  const DayStrip strip = MakeDayStrip(Alps());
  const auto& noon = strip.at(11, 0);
  EXPECT_GT(noon[2], noon[0]) << "the zenith at noon";
  EXPECT_GT(noon[2], 0.3F);
  for (int row = 0; row < strip.rows; ++row) {
    for (const float channel : strip.at(0, row)) EXPECT_LT(channel, 0.02F) << "midnight";
  }
  const auto& dusk = strip.at(18, strip.rows - 1);  // half past six of solar time, at an equinox
  EXPECT_GT(dusk[0], 1.3F * dusk[2]) << "the horizon under which the sun has gone";
}

// The reference solution: the table of the sky, and a day's exposure from its definition.
TEST(DayStrip, ColoursEqualThoseOfTheSky) {
  const DayStripRequest request = Alps();
  const DayStrip strip = MakeDayStrip(request);
  const Medium& medium = tests::Earth().medium();
  for (const int column : {7, 12, 18}) {
    const SunInSky sun =
        ApparentSunAt(request.place, AddSeconds(request.begin, 3600.0 * (column + 0.5)));
    const SkyView view(tests::Earth().single_scattering(), *request.multiple_scattering,
                       request.place.height_m, std::sin(sun.elevation_rad()));
    const double dip =
        std::acos(medium.planet_radius_m / (medium.planet_radius_m + request.place.height_m));
    HdrImage sky(1, strip.rows);
    double mean = 0.0;
    constexpr std::array<double, 6> kElevations_deg{80.0, 50.0, 28.0, 14.0, 6.0, 1.5};
    for (int row = 0; row < strip.rows; ++row) {
      const double elevation = kElevations_deg[static_cast<std::size_t>(row)] * kRadiansPerDegree;
      const Spectrum seen = view.Radiance(0.5 * kPi - elevation + dip, 0.0);
      std::vector<double> radiance;
      for (std::size_t band = 0; band < seen.size(); ++band) {
        radiance.push_back(static_cast<double>(seen[band]) * medium.solar_irradiance[band] /
                           (sun.distance_au * sun.distance_au));
      }
      const auto rgb = BandColour(medium.wavelengths_nm).LinearSrgb(radiance);
      mean += (0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]) / strip.rows;
      sky.at(0, row) = {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]),
                        static_cast<float>(rgb[2])};
    }
    const double ev100 = 0.8 * std::log2(mean * 100.0 / 12.5) + 0.2 * 14.0;
    const DisplayImage developed = Develop(sky, ev100, {.curve = ToneCurve::kAgx});
    for (int row = 0; row < strip.rows; ++row) {
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t at = static_cast<std::size_t>(row) * 3 + c;
        EXPECT_NEAR(strip.at(column, row)[c], developed.rgb[at] / 255.0, 2.5 / 255.0)
            << "column " << column << " row " << row
            << ": pictures are dithered by up to a code, and rounded; the table has 0.3 %";
      }
    }
  }
}

TEST(DayStrip, IsMadeAgainOnlyWhenItWouldChange) {
  const DayStripRequest shown = Alps();
  DayStripRequest request = shown;
  request.place.latitude_deg += 0.1;
  request.place.height_m += 50.0;
  request.begin = AddSeconds(request.begin, 1e-5);
  EXPECT_TRUE(LooksTheSame(shown, request)) << "a tenth of a degree is not seen";
  request.begin = AddSeconds(request.begin, 86400.0);
  EXPECT_FALSE(LooksTheSame(shown, request)) << "another day is";
}

}  // namespace
}  // namespace alpenglow::viewer
