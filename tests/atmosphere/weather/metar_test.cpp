// SPDX-License-Identifier: MIT
#include "atmosphere/weather/metar.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "tests/fixtures/fault_of.h"

namespace alpenglow::atmosphere {
namespace {

using testing::AnyOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

/// A report of an invented station, and what it says: see SummaryOf.
struct Shape {
  const char* report;
  const char* summary;
};

constexpr double kKnot_m_per_s = 0.514444444, kFoot_m = 0.3048;

std::string WindText(const ReportedWind& wind) {
  const double knots = wind.speed_m_per_s / kKnot_m_per_s;
  if (wind.from_deg) return fmt::format("{:.0f}/{:.0f} ", *wind.from_deg, knots);
  return knots == 0.0 ? "calm " : fmt::format("VRB/{:.0f} ", knots);
}

std::string VisibilityText(const ReportedVisibility& visibility) {
  const char* bound = visibility.bound == VisibilityBound::kAtLeast  ? ">"
                      : visibility.bound == VisibilityBound::kAtMost ? "<"
                                                                     : "=";
  return fmt::format("{}{:.0f} ", bound, visibility.distance_m);
}

std::string CloudText(const ReportedCloud& cloud) {
  const char* amounts = "FSBO";
  const char* suffix = cloud.convection == Convection::kCumulonimbus      ? "c"
                       : cloud.convection == Convection::kToweringCumulus ? "t"
                                                                          : "";
  return fmt::format("{}{:.0f}{} ", amounts[static_cast<int>(cloud.amount)],
                     cloud.height_m / kFoot_m / 100.0, suffix);
}

std::string SkyText(const MetarReport& report) {
  std::string text;
  for (const ReportedCloud& cloud : report.clouds) text += CloudText(cloud);
  if (report.obscured && !report.obscured->vertical_visibility_m) text += "V? ";
  if (report.obscured && report.obscured->vertical_visibility_m)
    text += fmt::format("V{:.0f} ", *report.obscured->vertical_visibility_m / kFoot_m / 100.0);
  return text.empty() && report.states_clouds ? "clear " : text;
}

std::string DegreesText(const std::optional<double>& degrees_c) {
  return degrees_c ? fmt::format("{:.0f}", *degrees_c + 0.0) : "?";
}

/// Returns what a report says: the wind in knots; the visibility in metres after =, > (at least) or <
/// (at most); fog; layers by amount (F, S, B, O) and hundreds of feet, c for cumulonimbus, t for
/// towering cumulus, V for a vertical visibility, or clear; temperature and dew point; hPa; the number
/// of groups that are not modelled.
std::string SummaryOf(const std::string& text) {
  const MetarReport report = ReadMetar(text);
  std::string summary;
  if (report.wind) summary += WindText(*report.wind);
  if (report.visibility) summary += VisibilityText(*report.visibility);
  if (!report.fog.empty()) summary += "fog ";
  summary += SkyText(report);
  const auto& [air_c, dew_point_c] = report.temperature;
  if (air_c || dew_point_c)
    summary += fmt::format("{}/{} ", DegreesText(air_c), DegreesText(dew_point_c));
  if (report.pressure_pa) summary += fmt::format("{:.0f} ", 0.01 * *report.pressure_pa);
  if (!report.not_modelled.empty()) summary += fmt::format("+{} ", report.not_modelled.size());
  return summary.substr(0, summary.empty() ? 0 : summary.size() - 1);
}

// Stations and values are invented. Blocks: clear days, wind, visibility in metres, in statute miles,
// weather, clouds, temperature and pressure, whole reports of the kinds that services send.
constexpr Shape kShapes[] = {
    {"XAAA 010000Z 00000KT CAVOK 15/10 Q1013", "calm >10000 clear 15/10 1013"},
    {"METAR XAAA 010030Z 27005KT CAVOK 15/10 Q1013=", "270/5 >10000 clear 15/10 1013"},
    {"SPECI XAAA 010042Z 27005KT CAVOK 15/10 Q1013", "270/5 >10000 clear 15/10 1013"},
    {"METAR COR XAAA 010030Z 27005KT CAVOK 15/10 Q1013", "270/5 >10000 clear 15/10 1013"},
    {"METAR XAAA 010030Z COR 27005KT CAVOK 15/10 Q1013", "270/5 >10000 clear 15/10 1013"},
    {"METAR XAAA 010030Z AUTO 27005KT CAVOK 15/10 Q1013", "270/5 >10000 clear 15/10 1013"},
    {"METAR XAAA 010030Z CCA 27005KT CAVOK 15/10 Q1013", "270/5 >10000 clear 15/10 1013"},
    {"xaaa 010030z auto 27005kt cavok 15/10 q1013", "270/5 >10000 clear 15/10 1013"},
    {"  XAAA\t010030Z  27005KT   CAVOK 15/10 Q1013  ", "270/5 >10000 clear 15/10 1013"},
    {"X1B2 311159Z 27005KT 9999 NSC 15/10 Q1013", "270/5 >10000 clear 15/10 1013"},
    {"XAAB 012350Z 18004KT 9999 SKC 18/11 Q1020", "180/4 >10000 clear 18/11 1020"},
    {"XAAB 012350Z AUTO 18004KT 9999 NCD 18/11 Q1020", "180/4 >10000 clear 18/11 1020"},
    {"KXAB 012353Z AUTO 18004KT 10SM CLR 18/11 A3012", "180/4 >16093 clear 18/11 1020"},
    {"KXAB 012353Z 18004KT 10SM SKC 18/11 A3012", "180/4 >16093 clear 18/11 1020"},
    {"XAAC 020000Z 36010KT CAVOK 02/M04 Q1031 NOSIG", "360/10 >10000 clear 2/-4 1031 +1"},
    {"XAAC 020000Z 01010KT CAVOK", "10/10 >10000 clear"},
    {"XAAC 020000Z", ""},
    {"XAAC 020000Z AUTO", ""},
    {"XAAC 020000Z Q1013", "1013"},
    {"XAAC 020000Z RMK NO DATA", "+1"},

    {"XBAA 030600Z 24008KT 9999 NSC 10/05 Q1015", "240/8 >10000 clear 10/5 1015"},
    {"XBAA 030600Z 24012G25KT 9999 NSC 10/05 Q1015", "240/12 >10000 clear 10/5 1015 +1"},
    {"XBAA 030600Z VRB02KT 9999 NSC 10/05 Q1015", "VRB/2 >10000 clear 10/5 1015"},
    {"XBAA 030600Z VRB05G17KT 9999 NSC 10/05 Q1015", "VRB/5 >10000 clear 10/5 1015 +1"},
    {"XBAA 030600Z 21007KT 180V250 9999 NSC 10/05 Q1015", "210/7 >10000 clear 10/5 1015 +1"},
    {"XBAA 030600Z 21007G19KT 180V250 9999 NSC 10/05 Q1015", "210/7 >10000 clear 10/5 1015 +2"},
    {"XBAA 030600Z 36000KT 9999 NSC", "360/0 >10000 clear"},
    {"XBAA 030600Z 09005MPS 9999 NSC 10/05 Q1015", "90/10 >10000 clear 10/5 1015"},
    {"XBAA 030600Z 09005G12MPS 9999 NSC 10/05 Q1015", "90/10 >10000 clear 10/5 1015 +1"},
    {"XBAA 030600Z VRB01MPS 9999 NSC", "VRB/2 >10000 clear"},
    {"XBAA 030600Z 00000MPS 9999 NSC", "calm >10000 clear"},
    {"XBAA 030600Z 30020KMH 9999 NSC", "300/11 >10000 clear"},
    {"XBAA 030600Z 300104KT 9999 NSC", "300/104 >10000 clear"},
    {"XBAA 030600Z 30087G112KT 9999 NSC", "300/87 >10000 clear +1"},
    {"XBAA 030600Z 240P99KT 9999 NSC", "240/99 >10000 clear"},
    {"XBAA 030600Z 24050GP99KT 9999 NSC", "240/50 >10000 clear +1"},
    {"XBAA 030600Z /////KT 9999 NSC", ">10000 clear"},
    {"XBAA 030600Z /////MPS 9999 NSC", ">10000 clear"},
    {"XBAA 030600Z ///08KT 9999 NSC", "VRB/8 >10000 clear"},
    {"XBAA 030600Z 240//KT 9999 NSC", ">10000 clear"},
    {"XBAA 030600Z 24008G//KT 9999 NSC", "240/8 >10000 clear"},
    {"XBAA 030600Z 24710KT 9999 NSC", "247/10 >10000 clear"},
    {"XBAA 030600Z AUTO 00000KT //// NCD 10/05 Q1015", "calm clear 10/5 1015"},
    {"XBAA 030600Z 9999 NSC 10/05 Q1015", ">10000 clear 10/5 1015"},
    {"XBAA 030600Z 19015KT", "190/15"},

    {"XCAA 040900Z 05003KT 8000 NSC 10/07 Q1018", "50/3 =8000 clear 10/7 1018"},
    {"XCAA 040900Z 05003KT 4500 HZ NSC 10/07 Q1018", "50/3 =4500 clear 10/7 1018"},
    {"XCAA 040900Z 05003KT 3000 BR NSC 10/09 Q1018", "50/3 =3000 clear 10/9 1018"},
    {"XCAA 040900Z 05003KT 1500 BR BKN004 10/09 Q1018", "50/3 =1500 B4 10/9 1018"},
    {"XCAA 040900Z 05003KT 1000 BR OVC002 10/10 Q1018", "50/3 =1000 O2 10/10 1018"},
    {"XCAA 040900Z 05003KT 0900 FG OVC001 10/10 Q1018", "50/3 =900 fog O1 10/10 1018"},
    {"XCAA 040900Z 05003KT 0350 FG VV002 10/10 Q1018", "50/3 =350 fog V2 10/10 1018"},
    {"XCAA 040900Z 05003KT 0100 FG VV/// 10/10 Q1018", "50/3 =100 fog V? 10/10 1018"},
    {"XCAA 040900Z 05003KT 0050 FG VV000 10/10 Q1018", "50/3 =50 fog V0 10/10 1018"},
    {"XCAA 040900Z 05003KT 0000 FG VV/// 10/10 Q1018", "50/3 <50 fog V? 10/10 1018"},
    {"XCAA 040900Z 00000KT 0200 FZFG VV001 M05/M05 Q1030", "calm =200 fog V1 -5/-5 1030"},
    {"XCAA 040900Z 00000KT 0200 R14/0600U FG VV001 10/10 Q1018", "calm =200 fog V1 10/10 1018 +1"},
    {"XCAA 040900Z 00000KT 0200 R14L/P1500N R32R/0450V0900D FG VV001 10/10 Q1018",
     "calm =200 fog V1 10/10 1018 +2"},
    {"XCAA 040900Z 00000KT 0200 R14/M0050N FG 10/10 Q1018", "calm =200 fog 10/10 1018 +1"},
    {"XCAA 040900Z 00000KT 9999NDV NCD 10/05 Q1018", "calm >10000 clear 10/5 1018"},
    {"XCAA 040900Z 00000KT 7000NDV NCD 10/05 Q1018", "calm =7000 clear 10/5 1018"},
    {"XCAA 040900Z 00000KT 6000 1200SW BR NSC 10/09 Q1018", "calm =6000 clear 10/9 1018 +1"},
    {"XCAA 040900Z 00000KT 9999 0800N MIFG NSC 10/10 Q1018", "calm >10000 clear 10/10 1018 +2"},
    {"XCAA 040900Z 00000KT 9999 MIFG NSC 10/10 Q1018", "calm >10000 clear 10/10 1018 +1"},
    {"XCAA 040900Z 00000KT 9999 BCFG NSC 10/10 Q1018", "calm >10000 clear 10/10 1018 +1"},
    {"XCAA 040900Z 00000KT 5000 PRFG NSC 10/10 Q1018", "calm =5000 clear 10/10 1018 +1"},
    {"XCAA 040900Z 00000KT 9999 VCFG NSC 10/10 Q1018", "calm >10000 clear 10/10 1018 +1"},
    {"XCAA 040900Z 00000KT 4000 FU NSC 28/10 Q1018", "calm =4000 clear 28/10 1018 +1"},
    {"XCAA 040900Z 00000KT 3000 DU NSC 38/02 Q1008", "calm =3000 clear 38/2 1008 +1"},
    {"XCAA 040900Z 33022KT 0800 SS NSC 38/02 Q1004", "330/22 =800 clear 38/2 1004 +1"},
    {"XCAA 040900Z 33022G34KT 2000 BLDU NSC 38/02 Q1004", "330/22 =2000 clear 38/2 1004 +2"},
    {"XCAA 040900Z 33022KT 1500 BLSA NSC 38/02 Q1004", "330/22 =1500 clear 38/2 1004 +1"},
    {"XCAA 040900Z 00000KT 2000 VA NSC 15/05 Q1012", "calm =2000 clear 15/5 1012 +1"},
    {"XCAA 040900Z 00000KT 10KM NSC 15/05 Q1012", "calm >10000 clear 15/5 1012"},
    {"XCAA 040900Z 00000KT 7KM NSC 15/05 Q1012", "calm =7000 clear 15/5 1012"},
    {"XCAA 040900Z AUTO 00000KT //// // NCD 15/05 Q1012", "calm clear 15/5 1012 +1"},
    {"XCAA 040900Z AUTO 00000KT //// FG VV/// 15/15 Q1012", "calm fog V? 15/15 1012"},

    {"KXDA 051251Z 31009KT 10SM FEW045 SCT250 21/09 A3001", "310/9 >16093 F45 S250 21/9 1016"},
    {"KXDA 051251Z 31009KT 15SM FEW045 21/09 A3001", "310/9 >24140 F45 21/9 1016"},
    {"KXDA 051251Z 31009KT 7SM FEW045 21/09 A3001", "310/9 =11265 F45 21/9 1016"},
    {"KXDA 051251Z 31009KT 5SM HZ FEW045 21/09 A3001", "310/9 =8047 F45 21/9 1016"},
    {"KXDA 051251Z 31009KT 3SM BR FEW045 21/19 A3001", "310/9 =4828 F45 21/19 1016"},
    {"KXDA 051251Z 31009KT 2 1/2SM BR OVC007 21/19 A3001", "310/9 =4023 O7 21/19 1016"},
    {"KXDA 051251Z 31009KT 1 1/2SM BR OVC007 21/19 A3001", "310/9 =2414 O7 21/19 1016"},
    {"KXDA 051251Z 31009KT 1 3/8SM BR OVC007 21/19 A3001", "310/9 =2213 O7 21/19 1016"},
    {"KXDA 051251Z 31009KT 1SM BR OVC007 21/19 A3001", "310/9 =1609 O7 21/19 1016"},
    {"KXDA 051251Z 31009KT 3/4SM BR OVC003 21/20 A3001", "310/9 =1207 O3 21/20 1016"},
    {"KXDA 051251Z 31009KT 1/2SM FG OVC002 21/21 A3001", "310/9 =805 fog O2 21/21 1016"},
    {"KXDA 051251Z 31009KT 1/4SM FG VV001 21/21 A3001", "310/9 =402 fog V1 21/21 1016"},
    {"KXDA 051251Z 31009KT M1/4SM FG VV001 21/21 A3001", "310/9 <402 fog V1 21/21 1016"},
    {"KXDA 051251Z AUTO 31009KT M1/4SM R28L/2400FT FG VV002 21/21 A3001",
     "310/9 <402 fog V2 21/21 1016 +1"},
    {"KXDA 051251Z 31009KT 1/8SM FG VV001 21/21 A3001", "310/9 =201 fog V1 21/21 1016"},
    {"KXDA 051251Z 31009KT 5/16SM FG VV001 21/21 A3001", "310/9 =503 fog V1 21/21 1016"},
    {"KXDA 051251Z 31009KT 0SM FG VV000 21/21 A3001", "310/9 <50 fog V0 21/21 1016"},
    {"KXDA 051251Z 31009KT P6SM SCT040 21/09 A3001", "310/9 >9656 S40 21/9 1016"},
    {"KXDA 051251Z AUTO 31009KT ////SM CLR 21/09 A3001", "310/9 clear 21/9 1016"},
    {"CXDB 051300Z 31009KT 3/4SM R24/3500VP6000FT/U -SN OVC009 M04/M05 A2975",
     "310/9 =1207 O9 -4/-5 1007 +2"},

    {"XEAA 060720Z 22011KT 9999 -RA SCT018 BKN035 12/09 Q1006",
     "220/11 >10000 S18 B35 12/9 1006 +1"},
    {"XEAA 060720Z 22011KT 6000 RA SCT018 BKN035 12/09 Q1006", "220/11 =6000 S18 B35 12/9 1006 +1"},
    {"XEAA 060720Z 22011KT 2500 +RA SCT018 BKN035 12/09 Q1006",
     "220/11 =2500 S18 B35 12/9 1006 +1"},
    {"XEAA 060720Z 22011KT 4000 -RA BR SCT018 BKN035 12/11 Q1006",
     "220/11 =4000 S18 B35 12/11 1006 +1"},
    {"XEAA 060720Z 22011KT 9999 -DZ OVC008 12/11 Q1006", "220/11 >10000 O8 12/11 1006 +1"},
    {"XEAA 060720Z 22011KT 3000 DZ BR OVC004 12/11 Q1006", "220/11 =3000 O4 12/11 1006 +1"},
    {"XEAA 060720Z 22011KT 9999 -SHRA FEW020TCU SCT030 12/09 Q1006",
     "220/11 >10000 F20t S30 12/9 1006 +1"},
    {"XEAA 060720Z 22011KT 5000 SHRA FEW020CB SCT030 12/09 Q1006",
     "220/11 =5000 F20c S30 12/9 1006 +1"},
    {"XEAA 060720Z 22011KT 9999 VCSH SCT030 12/09 Q1006", "220/11 >10000 S30 12/9 1006 +1"},
    {"XEAA 060720Z 22011KT 9999 TS SCT030CB 25/18 Q1006", "220/11 >10000 S30c 25/18 1006 +1"},
    {"XEAA 060720Z 22011KT 9999 VCTS SCT030CB 25/18 Q1006", "220/11 >10000 S30c 25/18 1006 +1"},
    {"XEAA 060720Z 22011KT 3000 TSRA BKN030CB 25/18 Q1006", "220/11 =3000 B30c 25/18 1006 +1"},
    {"XEAA 060720Z 22025G48KT 1500 +TSRAGR BKN030CB 19/18 Q1006",
     "220/25 =1500 B30c 19/18 1006 +2"},
    {"XEAA 060720Z 22011KT 9999 -TSRA FEW012 SCT030CB BKN060 25/18 Q1006",
     "220/11 >10000 F12 S30c B60 25/18 1006 +1"},
    {"XEAA 060720Z 22011KT 1200 SN OVC006 M01/M02 Q0998", "220/11 =1200 O6 -1/-2 998 +1"},
    {"XEAA 060720Z 22011KT 0600 +SN VV004 M01/M02 Q0998", "220/11 =600 V4 -1/-2 998 +1"},
    {"XEAA 060720Z 22011KT 3000 -SNRA BKN008 01/00 Q0998", "220/11 =3000 B8 1/0 998 +1"},
    {"XEAA 060720Z 22011KT 3000 -SHSN BKN018CB M03/M05 Q0998", "220/11 =3000 B18c -3/-5 998 +1"},
    {"XEAA 060720Z 22011KT 3000 SHSNRA BKN018 01/M01 Q0998", "220/11 =3000 B18 1/-1 998 +1"},
    {"XEAA 060720Z 22031KT 1500 BLSN BKN018 M11/M13 Q0998", "220/31 =1500 B18 -11/-13 998 +1"},
    {"XEAA 060720Z 22021KT 9000 DRSN BKN018 M11/M13 Q0998", "220/21 =9000 B18 -11/-13 998 +1"},
    {"XEAA 060720Z 22011KT 3000 FZRA OVC010 M01/M02 Q0998", "220/11 =3000 O10 -1/-2 998 +1"},
    {"XEAA 060720Z 22011KT 3000 -FZDZ BR OVC003 M01/M02 Q0998", "220/11 =3000 O3 -1/-2 998 +1"},
    {"XEAA 060720Z 22011KT 3000 PL OVC010 M01/M02 Q0998", "220/11 =3000 O10 -1/-2 998 +1"},
    {"XEAA 060720Z 22011KT 3000 -SG OVC010 M01/M02 Q0998", "220/11 =3000 O10 -1/-2 998 +1"},
    {"XEAA 060720Z 22003KT 3000 IC SKC M41/M45 Q1038", "220/3 =3000 clear -41/-45 1038 +1"},
    {"XEAA 060720Z 22011KT 3000 SHGS BKN020CB 05/02 Q0998", "220/11 =3000 B20c 5/2 998 +1"},
    {"XEAA 060720Z AUTO 22011KT 3000 UP OVC010 M01/M02 Q0998", "220/11 =3000 O10 -1/-2 998 +1"},
    {"XEAA 060720Z AUTO 22011KT 9999 -UP OVC010 M01/M02 Q0998", "220/11 >10000 O10 -1/-2 998 +1"},
    {"XEAA 060720Z 22011KT 9999 SQ SCT030 25/18 Q1006", "220/11 >10000 S30 25/18 1006 +1"},
    {"XEAA 060720Z 22011KT 9999 +FC SCT030CB 25/18 Q1006", "220/11 >10000 S30c 25/18 1006 +1"},
    {"XEAA 060720Z 22011KT 9999 PO SKC 35/04 Q1006", "220/11 >10000 clear 35/4 1006 +1"},
    {"XEAA 060720Z 22011KT 2000 -RA FG BKN003 10/10 Q1006", "220/11 =2000 fog B3 10/10 1006 +1"},
    {"XEAA 060720Z 22011KT 9999 NSC 10/05 Q1006 RERA", "220/11 >10000 clear 10/5 1006 +1"},
    {"XEAA 060720Z 22011KT 9999 NSC 10/05 Q1006 RETS RESHRA", "220/11 >10000 clear 10/5 1006 +2"},
    {"XEAA 060720Z AUTO 22011KT 9999 NCD 10/05 Q1006 RE//", "220/11 >10000 clear 10/5 1006 +1"},
    {"XEAA 060720Z 22011KT 9999 NSC 10/05 Q1006 WS R14", "220/11 >10000 clear 10/5 1006 +1"},
    {"XEAA 060720Z 22011KT 9999 NSC 10/05 Q1006 WS ALL RWY", "220/11 >10000 clear 10/5 1006 +1"},
    {"XEAA 060720Z 22011KT 9999 NSC 10/05 Q1006 WS RWY14L NOSIG",
     "220/11 >10000 clear 10/5 1006 +2"},
    {"XEAA 060720Z 22011KT 9999 NSC 10/05 Q1006 W12/S4", "220/11 >10000 clear 10/5 1006 +1"},

    {"XFAA 071530Z 26006KT 9999 FEW035 20/12 Q1014", "260/6 >10000 F35 20/12 1014"},
    {"XFAA 071530Z 26006KT 9999 SCT035 20/12 Q1014", "260/6 >10000 S35 20/12 1014"},
    {"XFAA 071530Z 26006KT 9999 BKN035 20/12 Q1014", "260/6 >10000 B35 20/12 1014"},
    {"XFAA 071530Z 26006KT 9999 OVC035 20/12 Q1014", "260/6 >10000 O35 20/12 1014"},
    {"XFAA 071530Z 26006KT 9999 FEW035 SCT110 20/12 Q1014", "260/6 >10000 F35 S110 20/12 1014"},
    {"XFAA 071530Z 26006KT 9999 FEW010 SCT035 BKN110 OVC250 20/12 Q1014",
     "260/6 >10000 F10 S35 B110 O250 20/12 1014"},
    {"XFAA 071530Z 26006KT 9999 FEW030CB SCT035 20/12 Q1014", "260/6 >10000 F30c S35 20/12 1014"},
    {"XFAA 071530Z 26006KT 9999 SCT030TCU BKN080 20/12 Q1014", "260/6 >10000 S30t B80 20/12 1014"},
    {"XFAA 071530Z 26006KT 9999 FEW025TCU FEW030CB SCT035 20/12 Q1014",
     "260/6 >10000 F25t F30c S35 20/12 1014"},
    {"XFAA 071530Z 26006KT 9999 OVC300 20/12 Q1014", "260/6 >10000 O300 20/12 1014"},
    {"XFAA 071530Z 26006KT 9999 FEW000 20/12 Q1014", "260/6 >10000 F0 20/12 1014"},
    {"XFAA 071530Z AUTO 26006KT 9999 BKN012/// OVC020/// 20/12 Q1014",
     "260/6 >10000 B12 O20 20/12 1014"},
    {"XFAA 071530Z AUTO 26006KT 9999 ///015 20/12 Q1014", "260/6 >10000 20/12 1014 +1"},
    {"XFAA 071530Z AUTO 26006KT 9999 ///015/// 20/12 Q1014", "260/6 >10000 20/12 1014 +1"},
    {"XFAA 071530Z AUTO 26006KT 9999 ////// 20/12 Q1014", "260/6 >10000 20/12 1014 +1"},
    {"XFAA 071530Z AUTO 26006KT 9999 //////CB 20/12 Q1014", "260/6 >10000 20/12 1014 +1"},
    {"XFAA 071530Z AUTO 26006KT 9999 ///////// 20/12 Q1014", "260/6 >10000 20/12 1014 +1"},
    {"XFAA 071530Z AUTO 26006KT 9999 FEW020/// //////TCU 20/12 Q1014",
     "260/6 >10000 F20 20/12 1014 +1"},
    {"XFAA 071530Z 26006KT 9999 BKN/// 20/12 Q1014", "260/6 >10000 20/12 1014 +1"},
    {"XFAA 071530Z 26006KT 9999 SCT///CB 20/12 Q1014", "260/6 >10000 20/12 1014 +1"},
    {"XFAA 071530Z 26006KT 0700 FG FEW001 VV002 12/12 Q1014", "260/6 =700 fog F1 V2 12/12 1014"},

    {"XGAA 082200Z 15004KT 9999 FEW040 00/M01 Q1014", "150/4 >10000 F40 0/-1 1014"},
    {"XGAA 082200Z 15004KT 9999 FEW040 M00/M01 Q1014", "150/4 >10000 F40 0/-1 1014"},
    {"XGAA 082200Z 15004KT 9999 FEW040 M18/M22 Q1044", "150/4 >10000 F40 -18/-22 1044"},
    {"XGAA 082200Z 15004KT 9999 FEW040 47/M02 Q0999", "150/4 >10000 F40 47/-2 999"},
    {"XGAA 082200Z 15004KT 9999 FEW040 12/// Q1014", "150/4 >10000 F40 12/? 1014"},
    {"XGAA 082200Z 15004KT 9999 FEW040 12/ Q1014", "150/4 >10000 F40 12/? 1014"},
    {"XGAA 082200Z 15004KT 9999 FEW040 M12/ A2992", "150/4 >10000 F40 -12/? 1013"},
    {"XGAA 082200Z 15004KT 9999 FEW040 ///08 Q1014", "150/4 >10000 F40 ?/8 1014"},
    {"XGAA 082200Z 15004KT 9999 FEW040 ///// Q1014", "150/4 >10000 F40 1014"},
    {"XGAA 082200Z 15004KT 9999 FEW040 12/08 Q////", "150/4 >10000 F40 12/8"},
    {"XGAA 082200Z 15004KT 9999 FEW040 12/08 A////", "150/4 >10000 F40 12/8"},
    {"XGAA 082200Z 15004KT 9999 FEW040 12/08", "150/4 >10000 F40 12/8"},
    {"XGAA 082200Z 15004KT 9999 FEW040 12/08 Q0871", "150/4 >10000 F40 12/8 871"},
    {"XGAA 082200Z 15004KT 9999 FEW040 12/08 A2850", "150/4 >10000 F40 12/8 965"},
    {"XGAA 082200Z 15004KT 9999 FEW040 12/08 Q1013 A2992", "150/4 >10000 F40 12/8 1013"},
    {"XGAA 082200Z 15004KT 9999 FEW040 12/08 A2992 Q1013", "150/4 >10000 F40 12/8 1013"},
    {"XGAA 082200Z 15004KT 9999 FEW040 12/12 Q1014", "150/4 >10000 F40 12/12 1014"},

    {"METAR XHAA 091220Z 24008KT 200V280 9999 FEW040 SCT120 22/12 Q1018 NOSIG=",
     "240/8 >10000 F40 S120 22/12 1018 +2"},
    {"METAR XHAA 091250Z AUTO 33004KT 290V010 9999NDV FEW036/// SCT041/// 21/11 Q1016 TEMPO 3000 "
     "TSRA",
     "330/4 >10000 F36 S41 21/11 1016 +2"},
    {"METAR XHAA 090550Z 00000KT 0250 R10/0400N R28/0350D FZFG VV001 M06/M06 Q1027 BECMG 0800",
     "calm =250 fog V1 -6/-6 1027 +3"},
    {"METAR XHAA 091820Z 10009KT 9999 BKN030 TEMPO BKN014 RMK QFE", "100/9 >10000 B30 +2"},
    {"METAR KXHB 091753Z 21012G20KT 10SM FEW050 SCT250 31/18 A2998 RMK AO2 SLP148 T03110183 $",
     "210/12 >16093 F50 S250 31/18 1015 +2"},
    {"KXHB 091753Z AUTO 35003KT 2SM -RA BR OVC009 14/13 A2987 RMK AO2 P0003 T01390128",
     "350/3 =3219 O9 14/13 1012 +2"},
    {"SPECI KXHB 092217Z 29018G31KT 1/2SM R30L/2200V4000FT +TSRA SQ FEW015 BKN035CB OVC080 19/17 "
     "A2983 RMK FRQ LTGICCG",
     "290/18 =805 F15 B35c O80 19/17 1010 +5"},
    {"METAR CXHC 091800Z 25015G25KT 15SM FEW030 BKN070 08/M01 A2958 RMK CU1AC5 SLP021",
     "250/15 >24140 F30 B70 8/-1 1002 +2"},
    {"METAR UXHD 091500Z 02004MPS 340V060 6000 -SHSN SCT015CB OVC043 M02/M03 Q1009 R20/490250 "
     "NOSIG "
     "RMK QFE746",
     "20/8 =6000 S15c O43 -2/-3 1009 +5"},
    {"METAR ZXHE 090300Z 04003MPS 2400 HZ NSC 18/09 Q1022 NOSIG", "40/6 =2400 clear 18/9 1022 +1"},
    {"METAR RXHF 090400Z 16007KT 9999 FEW020 SCT120 27/22 Q1009 NOSIG RMK 1CU020 3AC120 A2980",
     "160/7 >10000 F20 S120 27/22 1009 +2"},
    {"METAR YXHG 090530Z AUTO 12009KT 9999 // NCD 33/05 Q1011", "120/9 >10000 clear 33/5 1011 +1"},
    {"METAR EXHH 090150Z 23014KT 5000 -DZ BR SCT004 BKN009 OVC015 12/11 Q1001 AMB",
     "230/14 =5000 S4 B9 O15 12/11 1001 +2"},
    {"METAR EXHH 090150Z 23014KT 9999 FEW035 12/06 Q1011 BLU NOSIG",
     "230/14 >10000 F35 12/6 1011 +2"},
    {"METAR VXHJ 091000Z 25012KT 3500 RA SCT014 FEW025CB BKN080 27/26 Q1003 TEMPO 1500 +TSRA",
     "250/12 =3500 S14 F25c B80 27/26 1003 +2"},
    {"METAR OXHK 091200Z 34026G38KT 0600 R33/0700N +DS VV003 36/03 Q1002 NOSIG",
     "340/26 =600 V3 36/3 1002 +4"},
    {"METAR SXHL 091400Z 10006KT CAVOK 24/17 Q1019 PROB30 FM1600 20010KT",
     "100/6 >10000 clear 24/17 1019 +1"},
    {"METAR NXHM 090000Z 27031G45KT 1200 BLSN OVC015 M21/M24 Q0969 RMK DRIFTS",
     "270/31 =1200 O15 -21/-24 969 +3"},
    {"METAR BXHN 091100Z 08022KT 9999 -SHRA FEW012 BKN020 09/06 A2955 Q1000",
     "80/22 >10000 F12 B20 9/6 1001 +1"},
    {"METAR LXHP 092020Z VRB01KT 9999 FEW030TCU BKN045 18/16 Q1012 RESHRA NOSIG",
     "VRB/1 >10000 F30t B45 18/16 1012 +2"},
    {"METAR XJAA 101000Z 24008KT 9999 R14/CLRD70 FEW040 22/12 Q1018",
     "240/8 >10000 F40 22/12 1018 +1"},
    {"METAR XJAA 101000Z 24008KT 9999 R88/CLRD// FEW040 22/12 Q1018",
     "240/8 >10000 F40 22/12 1018 +1"},
    {"METAR XJAA 101000Z 24008KT 9999 FEW040 M02/M07 Q1018 R/SNOCLO",
     "240/8 >10000 F40 -2/-7 1018 +1"},
    {"METAR XJAA 101000Z 24008KT 9999 FEW040 M02/M07 Q1018 SNOCLO",
     "240/8 >10000 F40 -2/-7 1018 +1"},
    {"METAR XJAA 101000Z 24008KT 9999 FEW040 22/12 Q1018 GRN", "240/8 >10000 F40 22/12 1018 +1"},
    {"METAR XJAA 101000Z 24008KT 9999 FEW040 22/12 Q1018 YLO1 TEMPO AMB",
     "240/8 >10000 F40 22/12 1018 +2"},
    {"METAR XJAA 101000Z 24008KT 9999 FEW040 22/12 Q1018 INTER 4000 SHRA",
     "240/8 >10000 F40 22/12 1018 +1"},
    {"METAR XJAA 101000Z 24008KT 9999 NSW FEW040 22/12 Q1018", "240/8 >10000 F40 22/12 1018 +1"},
    {"METAR XJAA 101000Z 24008KT 9999 VCBLDU SKC 32/02 Q1008", "240/8 >10000 clear 32/2 1008 +1"},
    {"METAR XJAA 101000Z 24008KT 9999 VCVA SKC 32/02 Q1008", "240/8 >10000 clear 32/2 1008 +1"},
    {"METAR XJAA 101000Z 24008KT 8000 DS SKC 32/02 Q1008", "240/8 =8000 clear 32/2 1008 +1"},
    {"METAR XJAA 101000Z 24008KT 9999 -RA -SN OVC030 01/M01 Q1008",
     "240/8 >10000 O30 1/-1 1008 +2"},
    {"METAR XJAA 101000Z 24008KT CAVOK 22/12 Q1018 W///S3", "240/8 >10000 clear 22/12 1018 +1"},
    {"METAR XJAA 101000Z RTD 24008KT CAVOK 22/12 Q1018", "240/8 >10000 clear 22/12 1018"},
    {"METAR XJAA 101000Z AUTO COR 24008KT CAVOK 22/12 Q1018", "240/8 >10000 clear 22/12 1018"},
};

TEST(Metar, ReportsOfTwoHundredShapesAreRead) {
  EXPECT_GE(std::size(kShapes), 200U);
  for (const Shape& shape : kShapes) {
    EXPECT_EQ(tests::FaultOf([&] { (void)SummaryOf(shape.report); }), "no fault") << shape.report;
    EXPECT_EQ(SummaryOf(shape.report), shape.summary) << shape.report;
  }
}

TEST(Metar, StationAndTimeAreThoseOfTheReport) {
  const MetarReport report = ReadMetar("METAR LSZH 211350Z 24008KT CAVOK");
  EXPECT_EQ(report.station, "LSZH");
  EXPECT_EQ(report.time, (ReportTime{21, 13, 50}));
}

TEST(Metar, TheTextOfAReportHasOneFormWhateverWasTyped) {
  EXPECT_EQ(ReadMetar(" metar lszh  211350z 24008kt 1 1/2sm=").text,
            "METAR LSZH 211350Z 24008KT 1 1/2SM");
}

TEST(Metar, GroupsWithoutEffectAreNamedWithTheirMeaning) {
  EXPECT_THAT(
      ReadMetar("XAAA 010030Z 27005G17KT 9999 0900W R14/0600U -SHRA VCTS ///012 10/05 Q1013 "
                "RETS WS R14 W12/S4 BLU TEMPO 3000 TSRA RMK ANY THING")
          .not_modelled,
      ElementsAre("G17KT (gusts)", "0900W (visibility in one direction)", "R14/0600U (runway)",
                  "-SHRA (light: showers, rain)", "VCTS (in the vicinity: thunderstorm)",
                  "///012 (clouds of unknown amount or height)", "RETS (recent: thunderstorm)",
                  "WS R14 (wind shear)", "W12/S4 (sea)", "BLU (colour state)",
                  "TEMPO 3000 TSRA (trend)", "RMK (remarks)"));
}

TEST(Metar, MalformedReportsAreRefusedWithGroupAndReason) {
  const std::string head = "XAAA 010030Z ";
  for (const auto& [report, message] : std::vector<std::pair<std::string, std::string>>{
           {"", "the report has no station"},
           {"METAR", "the report has no station"},
           {"METAR XAAA", "the report has no time"},
           {"24008KT 9999",
            "group \"24008KT\": a report begins with the four letters of a station"},
           {"XAAA 24008KT", "group \"24008KT\": the time is day, hour and minute"},
           {"XAAA 0100Z", "group \"0100Z\": the time is day"},
           {"XAAA 010030", "group \"010030\": the time is day"},
           {"XAAA 320030Z", "group \"320030Z\": there is no day 32 with 00:30"},
           {"XAAA 000030Z", "group \"000030Z\": there is no day 0"},
           {"XAAA 012400Z", "group \"012400Z\": there is no day 1 with 24:00"},
           {"XAAA 010060Z", "group \"010060Z\": there is no day 1 with 00:60"},
           {"TAF XAAA 010030Z", "group \"TAF\": this is a forecast"},
           {"XAAA NIL", "group \"NIL\": the report is missing"},
           {"XAAA 010030Z NIL", "group \"NIL\": the report is missing"},
           {head + "24O08KT", "group \"24O08KT\": a wind is a direction of three digits"},
           {head + "2408KT", "group \"2408KT\": a wind is"},
           {head + "240085KMT", "group \"240085KMT\": no group of a METAR has this form"},
           {head + "24008", "group \"24008\": a visibility is four digits"},
           {head + "37008KT",
            "group \"37008KT\": the wind is from 370 degrees; it must be from 0 "
            "to 360"},
           {head + "00008KT", "group \"00008KT\": direction 000 is that of calm air"},
           {head + "24012G10KT", "group \"24012G10KT\": gusts of 10 are not above the wind of 12"},
           {head + "24012GKT", "group \"24012GKT\": a wind is"},
           {head + "240200KT", "group \"240200KT\": the wind has 103 m/s; it must have at most 83"},
           {head + "VRBKT", "group \"VRBKT\": a wind is"},
           {head + "KT", "group \"KT\": a wind is"},
           {head + "24008KT 23010KT", "group \"23010KT\": 24008KT already gives this"},
           {head + "999", "group \"999\": a visibility is four digits"},
           {head + "99999", "group \"99999\": a visibility is four digits"},
           {head + "9999 8000", "group \"8000\": 9999 already gives this"},
           {head + "CAVOK 9999", "group \"9999\": CAVOK already gives this"},
           {head + "1/0SM", "group \"1/0SM\": a visibility in statute miles"},
           {head + "3/2SM", "group \"3/2SM\": a visibility in statute miles"},
           {head + "SM", "group \"SM\": a visibility in statute miles"},
           {head + "1 /2SM", "group \"1 /2SM\": a visibility in statute miles"},
           {head + "X6SM", "group \"X6SM\": a visibility in statute miles"},
           {head + "0KM", "group \"0KM\": a visibility in kilometres"},
           {head + "RAXX", "group \"RAXX\": no group of a METAR has this form"},
           {head + "-XX", "group \"-XX\": weather is a sign"},
           {head + "-", "group \"-\": weather is a sign"},
           {head + "FEW", "group \"FEW\": a height is three digits"},
           {head + "FEW40", "group \"FEW40\": a height is three digits"},
           {head + "FEW04O", "group \"FEW04O\": a height is three digits"},
           {head + "SCT040CU", "group \"SCT040CU\": after the height"},
           {head + "BKN0400", "group \"BKN0400\": after the height"},
           {head + "FEW200CB",
            "group \"FEW200CB\": the base is at 6096 m; that of CB and TCU is at "
            "most at 6000 m"},
           {head + "VV", "group \"VV\": a height is three digits"},
           {head + "VV01", "group \"VV01\": a height is three digits"},
           {head + "VV0010", "group \"VV0010\": a vertical visibility is VV"},
           {head + "VV001 VV002", "group \"VV002\": the vertical visibility is given twice"},
           {head + "CAVOK FEW040", "group \"FEW040\": CAVOK says that there are no such clouds"},
           {head + "NSC FEW040", "group \"FEW040\": NSC says that there are no such clouds"},
           {head + "FEW040 SKC", "group \"SKC\": it says that there are no clouds, and"},
           {head + "22/1", "group \"22/1\": temperature and dew point are two digits"},
           {head + "222/12", "group \"222/12\": temperature and dew point are two digits"},
           {head + "M/12", "group \"M/12\": temperature and dew point are two digits"},
           {head + "12/22",
            "group \"12/22\": the dew point, 22 degrees, is above the temperature, "
            "12 degrees"},
           {head + "12/08 11/08", "group \"11/08\": 12/08 already gives this"},
           {head + "Q101", "group \"Q101\": a pressure is Q or A and four digits"},
           {head + "Q10130", "group \"Q10130\": a pressure is Q or A and four digits"},
           {head + "Q0500", "group \"Q0500\": the pressure is 500 hPa; it must lie in [850, 1100]"},
           {head + "A1013", "group \"A1013\": the pressure is 343 hPa; it must lie in [850, 1100]"},
           {head + "Q1013 A3050",
            "group \"A3050\": it is 1032.8 hPa, and the group before it "
            "1013.0 hPa"},
           {head + "Q1013 22/12",
            "group \"22/12\": a temperature in this form stands before Q1013"},
           {head + "FEW040 9999", "group \"9999\": a visibility in this form stands before FEW040"},
           {head + "9999 24008KT", "group \"24008KT\": a wind in this form stands before 9999"},
           {head + "QNH1013", "group \"QNH1013\": no group of a METAR has this form"},
           {head + "HELLO", "group \"HELLO\": no group of a METAR has this form"},
           {head + "9999 CLOUDY", "group \"CLOUDY\": no group of a METAR has this form"},
           {head + "\x1b[2J", "group \"\\x1b[2J\": no group of a METAR has this form"}}) {
    EXPECT_THAT(tests::FaultOf([&] { (void)ReadMetar(report); }), HasSubstr(message)) << report;
  }
}

/// Expects values in the ranges of the code, or a message that names a group or the missing part.
void ExpectReadOrRefused(const std::string& text) {
  try {
    const MetarReport report = ReadMetar(text);
    EXPECT_EQ(report.station.size(), 4U) << text;
    EXPECT_GE(report.visibility.value_or(ReportedVisibility{1e4}).distance_m, kLeastVisibility_m)
        << text;
    EXPECT_LE(report.wind.value_or(ReportedWind{}).speed_m_per_s, kFastestWind_m_per_s) << text;
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), AnyOf(StartsWith("group \""), StartsWith("the report has no ")))
        << text;
  }
}

// Every prefix of a report and every report with one letter changed is read or refused, and neither
// crashes nor accepts values out of range.
TEST(Metar, DamagedReportsAreReadWithinRangesOrRefused) {
  for (const Shape& shape : kShapes) {
    std::string text = shape.report;
    for (std::size_t at = 0; at < text.size(); ++at) {
      for (const char letter : {'/', '9', 'Q', ' '}) {
        std::string damaged = text;
        damaged[at] = letter;
        ExpectReadOrRefused(damaged);
      }
      ExpectReadOrRefused(text.substr(0, at));
    }
  }
}

}  // namespace
}  // namespace alpenglow::atmosphere
