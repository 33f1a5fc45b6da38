// SPDX-License-Identifier: MIT
#include "lut/evaluate/lamp_cases.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <sstream>

#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/stored_cases.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::lut {
namespace {

using testing::HasSubstr;

const std::string kLampHeader =
    "id,quantity,scattering_per_m,extinction_per_m,phase,g,segment_m,light_along_m,light_across_m,"
    "profile,axis_x,axis_y,axis_z,exponent,inner_deg,outer_deg\n";

class LampCases : public TemporaryFolder {
 protected:
  [[nodiscard]] std::map<std::string, Estimate> Evaluate(const std::string& cases,
                                                         const IntegralOptions& options) const {
    WriteText(folder_ / "c.csv", cases);
    EvaluateLampFile(folder_ / "c.csv", folder_ / "r.csv", options, ProgressStyle::kQuiet);
    std::istringstream lines(ContentOf(folder_ / "r.csv"));
    std::string line;
    std::getline(lines, line);
    EXPECT_EQ(line, "id,wavelength_nm,value,error");
    std::map<std::string, Estimate> results;
    while (std::getline(lines, line)) {
      const std::vector<std::string> cells = stored::Cells(line);
      EXPECT_EQ(cells.size(), 4U);
      EXPECT_EQ(cells[1], "") << "lamps have no wavelength";
      results[cells[0]] = {std::stod(cells[2]), std::stod(cells[3])};
    }
    return results;
  }

  [[nodiscard]] std::string FaultOf(const std::string& cases) const {
    return tests::FaultOf([&] { return Evaluate(cases, {}); });
  }
};

// The stored cases in the columns of this program.
std::string StoredAsCases() {
  const std::map<std::string, std::string> phases{{"HG", "henyey-greenstein"},
                                                  {"CS", "cornette-shanks"}};
  std::string text = kLampHeader;
  for (const stored::Row& row : stored::Read("airlight.csv")) {
    const double length = stored::Number(row, "D_m");
    text += row.at("id") + ",airlight," + row.at("sigma_s") + "," + row.at("sigma_t") + "," +
            phases.at(row.at("phase")) + "," + row.at("g") + "," +
            (length < 0.0 ? "" : row.at("D_m"));
    for (const char* key :
         {"a_m", "d_m", "profile", "ax", "ay", "az", "n", "inner_deg", "outer_deg"}) {
      text += ",";
      text += row.at(key);
    }
    text += "\n";
  }
  return text;
}

void ExpectStored(const std::map<std::string, Estimate>& found, double tolerance) {
  for (const auto& [id, rows] : stored::Results("airlight_results.csv")) {
    const double truth = stored::Number(rows.front(), "radiance");
    EXPECT_NEAR(found.at(id).value, truth, tolerance * truth) << id;
  }
}

TEST_F(LampCases, StoredCasesWithinOneInAThousandBySixteenSamples) {
  if (!stored::Available()) GTEST_SKIP() << "no stored cases at " << stored::Folder();
  ExpectStored(Evaluate(StoredAsCases(), {}), 1e-3);
}

TEST_F(LampCases, StoredCasesAreAsNearAsIsAskedFor) {
  if (!stored::Available()) GTEST_SKIP() << "no stored cases at " << stored::Folder();
  for (const double error : {1e-3, 1e-4, 1e-5, 1e-8}) {
    ExpectStored(Evaluate(StoredAsCases(), {.max_error = error}), error);
  }
}

TEST_F(LampCases, AFileOfLampsIsKnownByItsHeader) {
  WriteText(folder_ / "lamps.csv", kLampHeader);
  WriteText(folder_ / "sky.csv", "id,quantity,altitude_m\n");
  EXPECT_TRUE(HoldsLampCases(folder_ / "lamps.csv"));
  EXPECT_FALSE(HoldsLampCases(folder_ / "sky.csv"));
  EXPECT_FALSE(HoldsLampCases(folder_ / "none.csv"));
}

TEST_F(LampCases, BadCasesAreRefusedByLineAndName) {
  const auto with = [&](const std::string& line) { return FaultOf(kLampHeader + line); };
  EXPECT_EQ(with("a,airlight,0.01,0.02,cornette-shanks,0.5,,10,1,iso,,,,,,\n"), "no fault");
  EXPECT_THAT(with("a,single,0.01,0.02,cornette-shanks,0.5,,10,1,iso,,,,,,\n"),
              HasSubstr(":2: quantity is \"single\"; in a file of lamps it must be airlight"));
  EXPECT_THAT(with("a,airlight,0.03,0.02,cornette-shanks,0.5,,10,1,iso,,,,,,\n"),
              HasSubstr("scattering_per_m is 0.03"));
  EXPECT_THAT(with("a,airlight,0.01,0.02,mie,0.5,,10,1,iso,,,,,,\n"),
              HasSubstr("phase is \"mie\""));
  EXPECT_THAT(with("a,airlight,0.01,0.02,cornette-shanks,1,,10,1,iso,,,,,,\n"),
              HasSubstr("g is 1; it must lie in"));
  EXPECT_THAT(with("a,airlight,0.01,0.02,cornette-shanks,0.5,,10,0,iso,,,,,,\n"),
              HasSubstr("infinitely bright"));
  EXPECT_THAT(with("a,airlight,0.01,0.02,cornette-shanks,0.5,5,10,0,iso,,,,,,\n"), "no fault")
      << "the lamp lies beyond the segment";
  EXPECT_THAT(with("a,airlight,0.01,0.02,cornette-shanks,0.5,,10,1,cone,0,0,0,,1,2\n"),
              HasSubstr("axis_x, axis_y and axis_z are all 0"));
  EXPECT_THAT(with("a,airlight,0.01,0.02,cornette-shanks,0.5,,10,1,cone,1,0,0,,3,2\n"),
              HasSubstr("inner_deg is 3"));
  EXPECT_THAT(with("a,airlight,0.01,0.02,cornette-shanks,0.5,,10,1,cosn,1,0,0,,,\n"),
              HasSubstr("exponent is \"\"; it must be a number"));
  EXPECT_THAT(with("a,airlight,nan,0.02,cornette-shanks,0.5,,10,1,iso,,,,,,\n"),
              HasSubstr("scattering_per_m is nan"));
  EXPECT_THAT(with(""), HasSubstr("has no lines"));
}

}  // namespace
}  // namespace alpenglow::lut
