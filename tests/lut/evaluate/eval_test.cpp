// SPDX-License-Identifier: MIT
#include "lut/evaluate/eval.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <sstream>
#include <tuple>

#include "atmosphere/base/error.h"
#include "atmosphere/math/constants.h"
#include "atmosphere/medium/atmosphere_file.h"
#include "lut/cli/program.h"
#include "lut/evaluate/integral_evaluator.h"
#include "lut/evaluate/lamp_cases.h"
#include "tests/fixtures/fault_of.h"
#include "tests/fixtures/media.h"
#include "tests/fixtures/report_files.h"
#include "tests/fixtures/sanitized.h"
#include "tests/fixtures/stored_cases.h"
#include "tests/fixtures/temporary_folder.h"

namespace alpenglow::lut {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr const char* kHeader =
    "id,quantity,altitude_m,view_zenith_deg,relative_azimuth_deg,sun_zenith_deg,distance_m\n";

/// Returns integration in the air of bruneton2017, whose light of all orders is solved once.
Evaluator& Integral() {
  static const auto evaluator = MakeIntegralEvaluator(MediumPreset("bruneton2017"));
  return *evaluator;
}

class Eval : public TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    cases_ = folder_ / "cases.csv";
    results_ = folder_ / "results.csv";
  }

  /// Maps id and wavelength to value and error.
  using Results = std::map<std::pair<std::string, double>, Estimate>;

  [[nodiscard]] Results Evaluate(const std::string& text, Evaluator& evaluator) const {
    WriteText(cases_, text);
    EvaluateFile(cases_, results_, evaluator, ProgressStyle::kQuiet);
    const std::vector<std::string> lines = LinesOf(ContentOf(results_));
    EXPECT_EQ(lines.at(0), "id,wavelength_nm,value,error");
    Results results;
    for (std::size_t i = 1; i < lines.size(); ++i) {
      const std::vector<std::string> cells = CellsOf(lines[i]);
      EXPECT_EQ(cells.size(), 4U);
      results[{cells[0], std::stod(cells[1])}] = {std::stod(cells[2]), std::stod(cells[3])};
    }
    return results;
  }

  void ExpectRefused(const std::string& text, const std::string& reason) const {
    WriteText(cases_, text);
    const std::string fault =
        tests::FaultOf([&] { EvaluateFile(cases_, results_, Integral(), ProgressStyle::kQuiet); });
    tests::ExpectNames(fault, cases_, reason);
    EXPECT_FALSE(fs::exists(results_)) << "no output after a refusal";
  }

  fs::path cases_, results_;
};

/// Returns one stored case as a line for eval.
std::string LineOf(const stored::Row& row, const std::string& quantity) {
  return row.at("id") + "," + quantity + "," + row.at("h_m") + "," + row.at("vza_deg") + "," +
         row.at("raz_deg") + "," + row.at("sza_deg") + "," +
         (row.at("end") == "dist" ? row.at("dist_m") : "") + "\n";
}

struct Comparison {
  int compared = 0;
  int honest = 0;  // the true error is at most the estimate
  double worst = 0.0;
  std::string worst_id;
  double squares = 0.0;

  void Add(const std::string& id, const Estimate& estimate, double truth, double truth_error) {
    const double error = std::abs(estimate.value - truth);
    const double relative = truth == 0.0 ? (error == 0.0 ? 0.0 : 1.0) : error / std::abs(truth);
    ++compared;
    squares += relative * relative;
    if (error <= estimate.error + truth_error) ++honest;
    if (relative > worst) {
      worst = relative;
      worst_id = id;
    }
  }
};

/// A cache of evaluators, because some of them take seconds to prepare.
using Evaluators = std::map<std::string, std::unique_ptr<Evaluator>>;

/// Evaluates every stored case of a file and compares one column of its results.
class StoredEval : public Eval {
 protected:
  template <typename Keep>
  [[nodiscard]] Comparison Compare(const std::string& name, const std::string& quantity,
                                   const std::string& column, const IntegralOptions& options,
                                   const Keep& keep) const {
    Evaluators evaluators;
    return CompareBy([&](const Medium& medium) { return MakeIntegralEvaluator(medium, options); },
                     evaluators, name, quantity, column, keep);
  }

  /// @param make  makes the evaluator of a medium that `evaluators` lacks.
  template <typename Make, typename Keep>
  [[nodiscard]] Comparison CompareBy(const Make& make, Evaluators& evaluators,
                                     const std::string& name, const std::string& quantity,
                                     const std::string& column, const Keep& keep) const {
    Comparison comparison;
    const std::vector<stored::Row> rows = stored::Read(name + ".csv");
    const std::vector<stored::Row> expected = stored::Read(name + "_results.csv");
    for (const auto& [set, medium] : stored::Media()) {
      std::string text = kHeader;
      std::map<std::string, bool> wanted;
      for (const stored::Row& row : rows) {
        if (row.at("set") != set || !keep(row)) continue;
        text += LineOf(row, quantity);
        wanted[row.at("id")] = true;
      }
      if (wanted.empty()) continue;
      auto& evaluator = evaluators[set];
      if (!evaluator) evaluator = make(medium);
      const Results results = Evaluate(text, *evaluator);
      for (const stored::Row& row : expected) {
        if (wanted.count(row.at("id")) == 0) continue;
        const double error = row.count("std_err") == 1 ? 2.0 * stored::Number(row, "std_err") : 0.0;
        comparison.Add(row.at("id"), results.at({row.at("id"), stored::Number(row, "lambda_nm")}),
                       stored::Number(row, column), error);
      }
    }
    return comparison;
  }
};

constexpr IntegralOptions WithMaxError(double error) { return {.samples = 16, .max_error = error}; }

TEST_F(StoredEval, TransmittanceAndOpticalDepthKeepTheirErrors) {
  for (const char* quantity : {"transmittance", "optical_depth"}) {
    const char* column = quantity[0] == 't' ? "transmittance" : "tau";
    const Comparison fast = Compare("transmittance", quantity, column, {}, stored::All);
    EXPECT_GE(fast.compared, 300);
    EXPECT_LT(fast.worst, 1e-5) << fast.worst_id << ": closed forms, 4e-7 of the optical depth";
    EXPECT_EQ(fast.honest, fast.compared);
    const Comparison reference =
        Compare("transmittance", quantity, column, WithMaxError(1e-8), stored::All);
    EXPECT_LT(reference.worst, 1e-8 * 10.0)
        << reference.worst_id << ": the reference solution, times optical depths to 10";
    EXPECT_EQ(reference.honest, reference.compared);
  }
}

TEST_F(StoredEval, SingleScatteringKeepsItsErrors) {
  const Comparison standard = Compare("single", "single", "total", {}, stored::All);
  EXPECT_GE(standard.compared, 450);
  EXPECT_LT(standard.worst, 1e-4) << standard.worst_id;
  EXPECT_LT(std::sqrt(standard.squares / standard.compared), 2e-6);
  EXPECT_GE(standard.honest, 0.99 * standard.compared)
      << "a difference of two rules can be small by luck";
  const Comparison few =
      Compare("single", "single", "total", {.samples = 6, .max_error = {}}, stored::All);
  EXPECT_GE(few.honest, 0.97 * few.compared);
  EXPECT_GT(few.worst, standard.worst) << "fewer samples cost accuracy";
  const Comparison air = Compare("single", "inscatter_single", "inscatter", {}, stored::All);
  EXPECT_LT(air.worst, 1e-4) << air.worst_id;
}

TEST_F(StoredEval, RequestedErrorIsKept) {
  for (const double wanted : {1e-2, 1e-4, 1e-5}) {
    const Comparison comparison =
        Compare("single", "single", "total", WithMaxError(wanted), stored::All);
    EXPECT_LT(comparison.worst, wanted) << comparison.worst_id;
  }
  // The reference solution takes a tenth of a second for some; a handful is enough here.
  const Comparison reference =
      Compare("single", "single", "total", WithMaxError(1e-7),
              [](const stored::Row& row) { return row.at("tag") == "near the horizon"; });
  EXPECT_GE(reference.compared, 30);
  EXPECT_LT(reference.worst, 1e-7) << reference.worst_id;
}

TEST_F(StoredEval, ErrorsOfAllOrdersAreTrueInAllStoredAir) {
  const Comparison total = Compare("multiple", "total", "total", {}, [](const stored::Row& row) {
    return !tests::kSanitized || row.at("set") == "earth" || row.at("set") == "small";
  });
  EXPECT_GE(total.compared, tests::ScaledDown(120, 40));
  EXPECT_GE(total.honest, 0.95 * total.compared) << "the paths' two standard errors aside";
}

TEST_F(StoredEval, ErrorsOfSkyIrradianceAreTrueInStoredAir) {
  const Comparison sky =
      Compare("irradiance", "irradiance_sky", "irradiance", {}, [](const stored::Row& row) {
        return row.at("tag") == "ground" && (!tests::kSanitized || row.at("set") == "earth");
      });
  EXPECT_GE(sky.compared, 6);
  EXPECT_GE(sky.honest, 0.95 * sky.compared) << "the paths' two standard errors aside";
}

/// A kind of air that light does not leave easily, or only just beside the sun.
struct HardAir {
  const char* name;
  Medium medium;
  /// Radiances of kHardViews in every band, by paths, and their standard errors (skylut eval
  /// --method path-trace, 60000 paths).
  std::vector<std::vector<Estimate>> traced;
};

const std::array<ViewRay, 5> kHardViews{
    RayFromAngles(2.0, 30.0, 60.0, 50.0), RayFromAngles(2.0, 80.0, 150.0, 60.0),
    RayFromAngles(3000.0, 120.0, 20.0, 40.0), RayFromAngles(10e3, 85.0, 90.0, 70.0),
    RayFromAngles(2.0, 60.0, 10.0, 65.0)};

Medium WithAerosol(const std::vector<double>& depths, double scale_height_m, double albedo,
                   double g) {
  Medium medium = MediumPreset("earth", {450.0, 500.0, 550.0, 650.0});
  medium.mie_scale_height_m = scale_height_m;
  medium.mie_phase = {tests::LobeOf(g)};
  for (std::size_t band = 0; band < depths.size(); ++band) {
    medium.mie_extinction_per_m[band] = depths[band] / scale_height_m;
    medium.mie_scattering_per_m[band] = albedo * medium.mie_extinction_per_m[band];
  }
  return medium;
}

std::vector<HardAir> HardAirs() {
  Medium molecules = MediumPreset("bruneton2017");
  for (std::size_t band = 0; band < 3; ++band) {
    molecules.rayleigh_scattering_per_m[band] =
        std::array{5.0, 2.0, 0.5}[band] / molecules.rayleigh_scale_height_m;
    molecules.mie_scattering_per_m[band] = molecules.mie_extinction_per_m[band] = 0.0;
  }
  return {
      {"haze",
       WithAerosol({5.0, 3.0, 0.8, 0.5}, 1200.0, 0.95, 0.8),
       {{{0.0789539, 0.00069}, {0.106456, 0.00049}, {0.0698606, 0.00013}, {0.0494575, 7.9e-05}},
        {{0.0199114, 0.00043}, {0.0272168, 0.00045}, {0.0326819, 0.00028}, {0.0292122, 0.00032}},
        {{0.0917973, 0.00082}, {0.08784, 0.00061}, {0.0543703, 0.00035}, {0.0483371, 0.00034}},
        {{0.0417931, 0.00013}, {0.0281019, 8.1e-05}, {0.0175598, 6.1e-05}, {0.00930862, 4.4e-05}},
        {{0.0374573, 0.00046}, {0.113874, 0.00068}, {0.568526, 0.00056}, {0.637439, 0.00037}}}},
      {"molecules",
       molecules,
       {{{0.0518765, 0.00036}, {0.0758721, 0.0002}, {0.0479628, 7.6e-05}},
        {{0.0201159, 0.00023}, {0.0373392, 0.00019}, {0.0813628, 0.00015}},
        {{0.0765147, 0.00045}, {0.0612113, 0.00021}, {0.0370391, 7.3e-05}},
        {{0.0594757, 0.00026}, {0.0688681, 0.00015}, {0.0641444, 0.00011}},
        {{0.0221363, 0.0002}, {0.0424998, 0.00017}, {0.0652499, 0.0001}}}},
      {"dust",
       MediumPreset("mars", {450.0, 650.0}),
       {{{0.0220467, 3.8e-05}, {0.0415077, 0.00012}},
        {{0.022544, 8.2e-05}, {0.0509989, 0.00025}},
        {{0.0172254, 0.00012}, {0.0589924, 0.00029}},
        {{0.0244633, 5.5e-05}, {0.0497159, 0.0002}},
        {{0.323481, 0.00096}, {0.472953, 0.0011}}}}};
}

// Two standard errors of the paths, 0.3 to 4 %, are added to the estimate.
TEST_F(Eval, ErrorsOfAllOrdersAreTrueInHazeDustAndThickAir) {
  Comparison all;
  std::vector<double> shares;
  for (const HardAir& air : HardAirs()) {
    if (tests::kSanitized && air.name != std::string("molecules")) continue;
    Comparison here;
    // Light leaves the molecules' first band only after hundreds of orders.
    constexpr std::size_t kFirst = tests::ScaledDown(0, 1);
    const Medium medium = tests::WithBands(air.medium, kFirst, air.medium.wavelengths_nm.size());
    const auto evaluator = MakeIntegralEvaluator(medium);
    const Case prepared{"", 0, Quantity::kTotal, {}};
    evaluator->Prepare({&prepared, 1});
    for (std::size_t view = 0; view < kHardViews.size(); ++view) {
      const Estimates found = evaluator->Evaluate({"", 0, Quantity::kTotal, kHardViews[view]});
      for (std::size_t band = 0; band < found.size(); ++band) {
        const Estimate& truth = air.traced[view][kFirst + band];
        here.Add(air.name, found[band], truth.value, 2.0 * truth.error);
        shares.push_back(found[band].error / found[band].value);
      }
    }
    EXPECT_GE(here.honest, 0.9 * here.compared) << air.name;
    all.compared += here.compared;
    all.honest += here.honest;
  }
  EXPECT_GE(all.honest, 0.95 * all.compared);
  std::nth_element(shares.begin(), shares.begin() + shares.size() / 2, shares.end());
  EXPECT_LT(shares[shares.size() / 2], 0.15) << "and are of use: the true errors are 4 % (rms)";
}

// The radiances are those of skylut eval --method path-trace --max-error 0.7%, along the horizon and
// 5 degrees above it.
TEST_F(Eval, DustAtTheHorizonAgreesWithPathsWithinItsError) {
  const auto evaluator = MakeIntegralEvaluator(MediumPreset("mars", {445.0}));
  const Case prepared{"", 0, Quantity::kTotal, {}};
  evaluator->Prepare({&prepared, 1});
  for (const auto& [zenith_deg, traced, bound] :
       {std::tuple{90.0, 0.03685, 0.08}, {85.0, 0.04212, 0.02}}) {
    const ViewRay ray = RayFromAngles(2.0, zenith_deg, 60.0, 40.0);
    const Estimate found = evaluator->Evaluate({"", 0, Quantity::kTotal, ray}).front();
    EXPECT_LE(std::abs(found.value - traced), found.error + 0.014 * traced) << zenith_deg;
    EXPECT_NEAR(found.value / traced, 1.0, bound) << zenith_deg << ": measured, 7 % and 0.1 %";
  }
}

/// Views [degrees] near and far from a sun 50 degrees from the zenith.
struct NearTheSun {
  double altitude_m, zenith_deg, azimuth_deg;
};
constexpr std::array<NearTheSun, 8> kViewsByAngle{{{2.0, 52.0, 0.0},
                                                   {2.0, 57.0, 0.0},
                                                   {2.0, 63.0, 0.0},
                                                   {2.0, 50.0, 30.0},
                                                   {2.0, 50.0, 45.0},
                                                   {2.0, 50.0, 90.0},
                                                   {2.0, 50.0, 180.0},
                                                   {3000.0, 130.0, 180.0}}};

/// Aerosol with a narrow lobe, its radiances by reference::TraceRadiance with their standard
/// errors, and the largest error of the sky.
struct NarrowLobe {
  const char* name;
  PhaseFunction phase;
  double optical_depth, bound;
  std::array<Estimate, 8> traced;
};

std::vector<NarrowLobe> NarrowLobesOfPaths() {
  return {{"droplets of 4 um",
           DropletPhase(4.0),
           0.5,
           0.02,
           {{{8.3205, 0.0047},
             {0.99107, 0.0019},
             {0.38488, 0.00093},
             {0.1479, 0.00029},
             {0.08897, 0.00022},
             {0.026058, 0.00016},
             {0.017497, 9.5e-05},
             {0.035276, 0.00019}}}},
          {"droplets of 20 um",
           DropletPhase(20.0),
           0.1,
           0.02,
           {{{1.2635, 0.00097},
             {0.13519, 6.8e-05},
             {0.10986, 7e-05},
             {0.05215, 4.3e-05},
             {0.032946, 5.1e-05},
             {0.013857, 4.6e-05},
             {0.011701, 4e-05},
             {0.02881, 3.7e-05}}}},
          {"droplets of 50 um",
           DropletPhase(50.0),
           0.5,
           0.02,
           {{{1.9804, 0.0052},
             {0.42389, 0.00074},
             {0.36419, 0.00064},
             {0.16403, 0.00032},
             {0.087691, 0.00026},
             {0.021084, 0.00012},
             {0.014658, 8.3e-05},
             {0.032079, 0.00018}}}},
          {"g = 0.999",
           tests::LobeOf(0.999),
           0.5,
           0.02,
           {{{2.3728, 0.006},
             {0.082549, 0.00023},
             {0.035401, 0.0002},
             {0.017973, 0.0001},
             {0.01578, 9.2e-05},
             {0.011623, 5.8e-05},
             {0.010649, 6.1e-05},
             {0.026603, 0.00016}}}},
          {"g = 0.999, thin",
           tests::LobeOf(0.999),
           0.03,
           0.02,
           {{{0.1642, 8.1e-05},
             {0.024887, 3.9e-05},
             {0.025129, 3.9e-05},
             {0.017149, 4.1e-05},
             {0.015855, 3.3e-05},
             {0.011891, 3.6e-05},
             {0.010897, 3.5e-05},
             {0.027696, 2.5e-05}}}},
          {"g = -0.9",
           tests::LobeOf(-0.9),
           0.5,
           0.06,
           {{{0.3046, 0.0012},
             {0.23913, 0.0012},
             {0.15372, 0.00086},
             {0.054372, 0.00029},
             {0.03401, 0.00019},
             {0.020646, 0.0001},
             {0.0206, 0.00011},
             {4.3712, 0.00093}}}},
          {"g = -0.99",
           tests::LobeOf(-0.99),
           0.05,
           0.25,
           {{{0.12394, 0.00071},
             {0.026405, 5.4e-05},
             {0.026374, 4.7e-05},
             {0.018349, 6.8e-05},
             {0.017014, 4e-05},
             {0.013104, 3.7e-05},
             {0.012136, 4e-05},
             {82.648, 0.0012}}}}};
}

// Two standard errors of the paths are added to the estimates and to the bounds of the sky.
TEST_F(Eval, LightAndErrorsOfNarrowLobesAgreeWithPaths) {
  Comparison all;
  const std::vector<NarrowLobe> lobes = NarrowLobesOfPaths();
  for (std::size_t i = 0; i < lobes.size(); i += tests::ScaledDown<std::size_t>(1, 4)) {
    Medium medium = InScalarLight(MediumPreset("earth", {550.0}));
    medium.mie_phase = {lobes[i].phase};
    medium.mie_extinction_per_m = {lobes[i].optical_depth / 1200.0};
    medium.mie_scattering_per_m = {0.97 * lobes[i].optical_depth / 1200.0};
    const auto evaluator = MakeIntegralEvaluator(medium);
    const Case prepared{"", 0, Quantity::kTotal, {}};
    evaluator->Prepare({&prepared, 1});
    for (std::size_t k = 0; k < kViewsByAngle.size(); ++k) {
      const NearTheSun& view = kViewsByAngle[k];
      const ViewRay ray = RayFromAngles(view.altitude_m, view.zenith_deg, view.azimuth_deg, 50.0);
      const Estimate found = evaluator->Evaluate({"", 0, Quantity::kTotal, ray}).front();
      const Estimate& truth = lobes[i].traced[k];
      all.Add(lobes[i].name, found, truth.value, 2.0 * truth.error);
      EXPECT_NEAR(found.value, truth.value, lobes[i].bound * truth.value + 2.0 * truth.error)
          << lobes[i].name << ", view " << k;
    }
  }
  EXPECT_GE(all.honest, 0.95 * all.compared);
}

// The folder has air with lobes of |g| from 0.9 to 0.999 on either side and droplets of 4 to 50 um,
// of optical depths 0.05, 0.15 and 0.5 in the three bands; the views are near the sun, beside it
// and opposite it, from the ground and from 3 km, three of them along segments, and there are
// irradiances of the sky. Two standard errors of the paths are added to the estimates.
TEST_F(Eval, LightOfLobesUnderManySunsAgreesWithPaths) {
  const std::string folder = "narrow_lobes/";
  const std::string cases = ContentOf(stored::DataFile(folder + "cases.csv"));
  // The bounds are those of lut/ACCURACY.md; the largest error is that of 3 km of mist opposite a
  // sun at 10 degrees. Narrower backward lobes have no bound.
  std::map<std::string, double> lobes{
      {"forward-0.9", 0.1},        {"forward-0.99", 0.1},       {"forward-0.999", 0.1},
      {"droplets-4", 0.1},         {"droplets-20", 0.1},        {"droplets-50", 0.1},
      {"backward-0.9", 0.25},      {"double-0.9", 0.45},        {"double-0.99", 0.4},
      {"backward-0.99", HUGE_VAL}, {"backward-0.999", HUGE_VAL}};
  if (tests::kSanitized) lobes = {{"double-0.9", lobes.at("double-0.9")}};
  Comparison all;
  for (const auto& [lobe, bound] : lobes) {
    Medium medium =
        MediumFromToml(ContentOf(stored::DataFile(folder + lobe + ".toml")), lobe + ".toml");
    if (tests::kSanitized) medium = tests::WithBands(medium, 2, 3);
    const auto evaluator = MakeIntegralEvaluator(medium);
    const Results found = Evaluate(cases, *evaluator);
    Comparison here;
    for (const stored::Row& row : stored::ReadData(folder + lobe + ".csv")) {
      const auto estimate = found.find({row.at("id"), stored::Number(row, "wavelength_nm")});
      if (estimate == found.end()) continue;
      const double truth = stored::Number(row, "value");
      const double of_paths = 2.0 * stored::Number(row, "error");
      here.Add(row.at("id"), estimate->second, truth, of_paths);
      EXPECT_LE(std::abs(estimate->second.value - truth), bound * truth + of_paths)
          << lobe << ' ' << row.at("id");
    }
    EXPECT_GE(here.compared, tests::ScaledDown(42, 14)) << lobe;
    EXPECT_GE(here.honest, 0.9 * here.compared) << lobe;
    all.compared += here.compared;
    all.honest += here.honest;
  }
  EXPECT_GE(all.honest, 0.95 * all.compared);
}

// Air of the largest planet, and thin air close to the ground; the air beyond the horizon brings
// the light of this sky. Paths find 5.4e-14 in the thin air, with a standard error of 5e-15 (skylut
// eval
// --method path-trace --max-error 10%), and 5e-13 on the largest planet.
TEST_F(Eval, UnresolvedLightHasAnError) {
  const std::string green =
      "preset = \"bruneton2017\"\n[spectrum]\nwavelengths_nm = [550]\nsolar_irradiance = [1.85]\n"
      "[planet]\nground_albedo = 0.1\n";
  struct DarkAir {
    const char* text;
    double traced;
  };
  for (const auto& [text, traced] :
       {DarkAir{"radius_m = 1e8\n[rayleigh]\nscattering_per_m = [1.3e-5]\n[mie]\n"
                "scattering_per_m = [4e-6]\nextinction_per_m = [4.4e-6]\n[ozone]\n"
                "absorption_per_m = [0]\n",
                5e-13},
        DarkAir{"[rayleigh]\nscattering_per_m = [1.3e-5]\nscale_height_m = 400\n[mie]\n"
                "scattering_per_m = [4e-5]\nextinction_per_m = [4.4e-5]\nscale_height_m = 100\n"
                "[ozone]\nabsorption_per_m = [1.9e-6]\n",
                5.44e-14}}) {
    const auto evaluator = MakeIntegralEvaluator(MediumFromToml(green + text, "dark air"));
    const Case work{"", 0, Quantity::kTotal, RayFromAngles(2.0, 50.0, 90.0, 95.0)};
    evaluator->Prepare({&work, 1});
    for (const Estimate& found : evaluator->Evaluate(work))
      EXPECT_LE(std::abs(found.value - traced), found.error);
    for (const Estimate& found : evaluator->Evaluate({"", 0, Quantity::kIrradianceSky, work.ray}))
      EXPECT_GE(found.error, 1e-12);
  }
}

TEST_F(Eval, ThickAirTransmitsNothingWithAFiniteError) {
  Medium medium = MediumPreset("bruneton2017");
  medium.mie_extinction_per_m.assign(medium.wavelengths_nm.size(), 1000.0);
  const auto evaluator = MakeIntegralEvaluator(medium);
  for (const Quantity quantity :
       {Quantity::kTransmittance, Quantity::kSingle, Quantity::kIrradianceSun}) {
    const Case work{"", 0, quantity, RayFromAngles(2.0, 50.0, 90.0, 50.0)};
    evaluator->Prepare({&work, 1});
    for (const Estimate& found : evaluator->Evaluate(work)) {
      EXPECT_LT(found.value, 1e-3);
      EXPECT_LE(found.error, 1.0);
    }
  }
}

/// An evaluator whose results are not finite, or which refuses its second case.
class FaultyEvaluator final : public Evaluator {
 public:
  explicit FaultyEvaluator(double value) : value_(value) {}
  [[nodiscard]] const Medium& medium() const override { return medium_; }
  [[nodiscard]] std::optional<std::string> Refusal(Quantity) const override { return std::nullopt; }
  void Prepare(std::span<const Case>) override {}
  [[nodiscard]] Estimates Evaluate(const Case& work) const override {
    if (work.id == "refused") throw InputError("it cannot be");
    return {{value_, 0.0}};
  }

 private:
  Medium medium_ = MediumPreset("bruneton2017");
  double value_;
};

TEST_F(Eval, NonFiniteResultsAreNotWritten) {
  WriteText(cases_, std::string(kHeader) + "a,total,0,60,0,30,\n");
  for (const double value : {std::nan(""), HUGE_VAL}) {
    FaultyEvaluator evaluator(value);
    EXPECT_THAT(tests::FaultOf<InternalError>(
                    [&] { EvaluateFile(cases_, results_, evaluator, ProgressStyle::kQuiet); }),
                HasSubstr("case a at "));
    EXPECT_FALSE(fs::exists(results_));
  }
}

TEST_F(Eval, CasesRefusedDuringEvaluationAreNamedByLine) {
  WriteText(cases_, std::string(kHeader) + "a,total,0,60,0,30,\nrefused,total,0,60,0,30,\n");
  FaultyEvaluator evaluator(1.0);
  EXPECT_EQ(
      tests::FaultOf([&] { EvaluateFile(cases_, results_, evaluator, ProgressStyle::kQuiet); }),
      cases_.string() + ":3: it cannot be");
}

// The radiances are those of reference::TraceRadiance, to 0.15 %.
TEST_F(Eval, AllOrdersAgreeWithPathsOnTheSmallestAndLargestPlanet) {
  struct Traced {
    ViewRay ray;
    std::array<double, 3> smallest, largest;
  };
  const std::array<Traced, 3> views{{{RayFromAngles(2.0, 40.0, 60.0, 30.0),
                                      {0.0350311, 0.0152402, 0.00730541},
                                      {0.0373267, 0.0161602, 0.0077111}},
                                     {RayFromAngles(2.0, 85.0, 100.0, 80.0),
                                      {0.036418, 0.0220918, 0.011912},
                                      {0.038644, 0.034112, 0.0242642}},
                                     {RayFromAngles(2000.0, 110.0, 30.0, 60.0),
                                      {0.0248072, 0.0193851, 0.0180324},
                                      {0.0238387, 0.018547, 0.0173395}}}};
  for (const double radius_m : {25.0 * 8000.0, 1e8}) {
    Medium medium = MediumPreset("bruneton2017");
    medium.planet_radius_m = radius_m;
    const auto evaluator = MakeIntegralEvaluator(medium);
    const Case prepared{"", 0, Quantity::kTotal, {}};
    evaluator->Prepare({&prepared, 1});
    for (const Traced& view : views) {
      const auto& truth = radius_m < 1e6 ? view.smallest : view.largest;
      const Estimates found = evaluator->Evaluate({"", 0, Quantity::kTotal, view.ray});
      for (std::size_t band = 0; band < found.size(); ++band) {
        EXPECT_NEAR(found[band].value / truth[band], 1.0, 0.011)
            << radius_m << ": four standard errors and twice the rms error over the earth";
      }
    }
  }
}

/// Returns light of all orders in standard quality, which is solved once for every medium.
const MultipleScattering& StandardMoments(const Medium& medium) {
  static std::map<std::uint64_t, MultipleScattering> solved;
  const std::uint64_t hash = MediumHash(medium);
  const auto found = solved.find(hash);
  if (found != solved.end()) return found->second;
  const TableSizes quality = SizesOf(BakeQuality::kStandard);
  return solved.try_emplace(hash, medium, quality.multiple_scattering).first->second;
}

std::unique_ptr<Evaluator> StandardTables(const Medium& medium) {
  const TableSizes quality = SizesOf(BakeQuality::kStandard);
  return MakeTableEvaluator({.medium = medium,
                             .transmittance = TransmittanceTable(medium, quality.transmittance),
                             .single_scattering = ScatteringTable(
                                 medium, {.size = quality.single_scattering, .lowest_mu_s = {}}),
                             .multiple_scattering = StandardMoments(medium),
                             .ray_nodes = quality.ray_nodes});
}

// Makes what skylut build --max-error makes of a percent: moments, and rays that are integrated
// where they are asked for.
std::unique_ptr<Evaluator> MomentsAlone(const Medium& medium) {
  const TableSizes quality = SizesOf(BakeQuality::kStandard);
  return MakeTableEvaluator({.medium = medium,
                             .transmittance = {},
                             .single_scattering = {},
                             .multiple_scattering = StandardMoments(medium),
                             .ray_nodes = quality.ray_nodes});
}

struct StoredKind {
  const char *name, *quantity, *column, *tag;
  double rms;
};

TEST_F(StoredEval, TablesAgreeWithEveryKindOfCaseWithinTheirErrors) {
  constexpr StoredKind kKinds[] = {
      {"transmittance", "transmittance", "transmittance", "", 5e-3},  // to optical depths of 20
      {"single", "single", "total", "day", 5e-4},
      {"multiple", "total", "total", "day", 1e-3},
      {"irradiance", "irradiance_sky", "irradiance", "ground", 6e-3},
      // Far from the glow the stored single scattering is coarse: a tenth.
      {"multiple", "total", "total", "twilight", 7e-2}};
  Evaluators evaluators;
  for (const StoredKind& kind : kKinds) {
    SCOPED_TRACE(fmt::format("{} {}", kind.quantity, kind.tag));
    const auto keep = [&](const stored::Row& row) {
      return row.at("set") == "earth" && (kind.tag[0] == '\0' || row.at("tag") == kind.tag);
    };
    const Comparison tables =
        CompareBy(StandardTables, evaluators, kind.name, kind.quantity, kind.column, keep);
    EXPECT_GE(tables.compared, 6);
    EXPECT_LT(std::sqrt(tables.squares / tables.compared), kind.rms) << tables.worst_id;
    EXPECT_EQ(tables.honest, tables.compared) << "estimates of the error hold";
  }
}

TEST_F(StoredEval, MomentsAndRaysAgreeWithPathsInTwilight) {
  constexpr StoredKind kKinds[] = {{"single", "single", "total", "twilight", 1e-3},
                                   {"multiple", "total", "total", "day", 1e-3},
                                   {"multiple", "total", "total", "twilight", 3e-3}};
  Evaluators evaluators;
  for (const StoredKind& kind : kKinds) {
    const Comparison tables =
        CompareBy(MomentsAlone, evaluators, kind.name, kind.quantity, kind.column,
                  [&](const stored::Row& row) {
                    return row.at("set") == "earth" && row.at("tag") == kind.tag;
                  });
    EXPECT_GE(tables.compared, 9);
    EXPECT_LT(std::sqrt(tables.squares / tables.compared), kind.rms)
        << kind.quantity << ' ' << kind.tag << ' ' << tables.worst_id;
  }
}

TEST_F(Eval, StokesParametersAgreeWithPathsOnBothSidesOfTheSun) {
  const Medium medium = InPolarisedLight(MediumPreset("bruneton2017"), "bruneton2017");
  const auto integral = MakeIntegralEvaluator(medium);
  const auto paths =
      MakePathTraceEvaluator(medium, {.max_paths = 1U << 13U, .relative_error = 0.005});
  std::string text = kHeader;
  for (const char* quantity : {"stokes_q", "stokes_u", "total"}) {
    text += fmt::format("{0}left,{0},0,60,70,50,\n{0}right,{0},0,60,-70,50,\n", quantity);
    text += fmt::format("{0}up,{0},0,0,30,50,\n", quantity);
  }
  Results fast = Evaluate(text, *integral), slow = Evaluate(text, *paths);
  for (const double band : {440.0, 550.0, 680.0}) {
    for (const char* place : {"left", "right", "up"}) {
      const double total = fast.at({fmt::format("total{}", place), band}).value;
      for (const char* quantity : {"stokes_q", "stokes_u", "total"}) {
        const std::string id = fmt::format("{}{}", quantity, place);
        // The tolerance is four standard errors and 0.3 %, the bound of polarised light by day.
        EXPECT_NEAR(fast.at({id, band}).value, slow.at({id, band}).value,
                    4.0 * slow.at({id, band}).error + 0.003 * total)
            << id << " " << band;
      }
    }
    const double left = fast.at({"stokes_uleft", band}).value;
    EXPECT_EQ(fast.at({"stokes_uright", band}).value, -left);
    EXPECT_GT(std::abs(left), 0.05 * fast.at({"totalleft", band}).value);
    const double q = fast.at({"stokes_qup", band}).value, u = fast.at({"stokes_uup", band}).value;
    EXPECT_NEAR(u / q, std::tan(60.0 * kRadiansPerDegree), 1e-6)
        << "the picture's upper edge has turned by 30 degrees";
  }
}

TEST_F(Eval, IrradianceOfTheSunIsCosineTimesTransmittance) {
  Evaluator& evaluator = Integral();
  const Results results = Evaluate(std::string(kHeader) +
                                       "E,irradiance_sun,0,0,0,60,\n"
                                       "T,transmittance,0,60,0,60,\n"
                                       "N,irradiance_sun,0,0,0,91,\n",
                                   evaluator);
  EXPECT_NEAR(results.at({"E", 550.0}).value, 0.5 * results.at({"T", 550.0}).value, 1e-12);
  EXPECT_EQ(results.at({"N", 550.0}).value, 0.0) << "the sun is below the plane";
}

TEST_F(Eval, LimitingCasesFollowTheDefinitions) {
  Evaluator& evaluator = Integral();
  const Results results = Evaluate(std::string(kHeader) +
                                       "along,single,0,90,0,45,\n"
                                       "feet,single,0,91,0,45,\n"
                                       "short,single,100,120,0,45,50\n"
                                       "zero,transmittance,100,120,0,45,0\n"
                                       "space,inscatter_single,4e5,20,0,45,\n"
                                       "dark,inscatter_single,0,20,0,150,\n",
                                   evaluator);
  EXPECT_GT(results.at({"along", 550.0}).value, 0.05) << "horizontal at altitude 0: sky";
  EXPECT_NEAR(results.at({"feet", 550.0}).value, 0.0203, 0.002)
      << "below the horizontal: only the ground, albedo 0.1 / pi times the sun";
  EXPECT_LT(results.at({"short", 550.0}).value, 0.002) << "a segment leaves out the ground";
  EXPECT_EQ(results.at({"zero", 550.0}).value, 1.0);
  EXPECT_EQ(results.at({"space", 550.0}).value, 0.0);
  EXPECT_EQ(results.at({"dark", 550.0}).value, 0.0);
}

/// Returns tables of single scattering only.
TableFolder SmallTables(const Medium& medium) {
  return {.medium = medium,
          .transmittance = TransmittanceTable(medium, {.mu = 128, .altitudes = 32}),
          .single_scattering = ScatteringTable(
              medium, {.size = {.nu = 4, .mu_s = 8, .mu = 16, .altitudes = 8}, .lowest_mu_s = {}}),
          .multiple_scattering = {}};
}

constexpr MultipleScatteringOptions kSmallLight{.altitudes = 12, .sun_angles = 24, .degree = 2};

TEST_F(Eval, GivenDistancesExcludeLightFromTheGround) {
  const Medium medium = MediumPreset("bruneton2017");
  constexpr std::array<const char*, 3> kQuantities{"single", "inscatter_single", "total"};
  const auto expect = [&](Evaluator& evaluator, double tolerance,
                          std::span<const char* const> quantities) {
    std::string text = kHeader;
    for (const char* quantity : quantities) {
      for (const char* distance : {"", "999.999", "1000", "1001", "1e9"}) {
        text += fmt::format("{}-{},{},1000,180,0,40,{}\n", quantity, distance, quantity, distance);
      }
    }
    const Results results = Evaluate(text, evaluator);
    for (const std::string quantity : quantities) {
      const double air = results.at({quantity + "-999.999", 550.0}).value;
      for (const char* distance : {"-1000", "-1001", "-1e9"}) {
        EXPECT_NEAR(results.at({quantity + distance, 550.0}).value, air, tolerance * air)
            << quantity << distance;
      }
      if (quantity == "inscatter_single") continue;
      EXPECT_GT(results.at({quantity + "-", 550.0}).value, 2.0 * air)
          << quantity << ": without a distance, the ground's light (0.02) is most of it";
    }
  };
  // A millimetre of the kilometre is a relative 1e-6, and the nodes' rounding ten times that.
  expect(Integral(), 1e-5, kQuantities);
  const auto reference = MakeIntegralEvaluator(medium, WithMaxError(1e-7));
  // For the total, light of all orders would be solved another time.
  expect(*reference, 1e-5, std::span(kQuantities).first(tests::ScaledDown<std::size_t>(3, 2)));
  // A look-up in stored tables takes the difference of two whole rays, some percent of the first
  // kilometre. The ground's light would be several times the value.
  TableFolder folder = SmallTables(medium);
  folder.multiple_scattering.emplace(medium, kSmallLight);
  const auto tables = MakeTableEvaluator(std::move(folder));
  expect(*tables, 0.05, kQuantities);
  // The tolerance is four standard errors of two values.
  constexpr double kError = tests::ScaledDown(0.008, 0.02);
  const auto paths =
      MakePathTraceEvaluator(medium, {.max_paths = kMostPathsOfCase, .relative_error = kError});
  expect(*paths, 4.0 * kError * std::sqrt(2.0), kQuantities);
}

TEST_F(Eval, TablesReportTheirErrorAgainstTheIntegral) {
  const Medium medium = MediumPreset("bruneton2017");
  TableFolder folder = SmallTables(medium);
  folder.multiple_scattering.emplace(medium, kSmallLight);
  const auto tables = MakeTableEvaluator(std::move(folder));

  std::string text = kHeader;
  for (const char* quantity : {"transmittance", "optical_depth", "single", "inscatter_single",
                               "total", "irradiance_sun", "irradiance_sky"}) {
    text += fmt::format("{}-sky,{},1500,70,30,50,\n", quantity, quantity);
    text += fmt::format("{}-ground,{},1500,110,30,50,\n", quantity, quantity);
    text += fmt::format("{}-segment,{},1500,80,30,50,30000\n", quantity, quantity);
  }
  const Results looked_up = Evaluate(text, *tables);
  const Results integrated = Evaluate(text, Integral());
  ASSERT_EQ(looked_up.size(), integrated.size());
  for (const auto& [key, truth] : integrated) {
    const Estimate& estimate = looked_up.at(key);
    EXPECT_LE(std::abs(estimate.value - truth.value), estimate.error + 1e-15) << key.first;
    EXPECT_LT(estimate.error, 0.3 * truth.value + 1e-15) << key.first << ": a coarse table";
  }
}

TEST_F(Eval, QuantitiesWithoutATableAreRefusedWithTheirLine) {
  const Medium medium = MediumPreset("bruneton2017");
  const auto tables = MakeTableEvaluator(SmallTables(medium));
  WriteText(cases_, std::string(kHeader) + "a,single,0,10,0,10,\nb,total,0,10,0,10,\n");
  EXPECT_THAT(
      tests::FaultOf([&] { EvaluateFile(cases_, results_, *tables, ProgressStyle::kQuiet); }),
      HasSubstr("cases.csv:3: "));
  TableFolder mixed = SmallTables(medium);
  mixed.multiple_scattering.emplace(MediumPreset("earth"), kSmallLight);
  EXPECT_THROW(static_cast<void>(MakeTableEvaluator(std::move(mixed))), InputError);
}

TEST_F(Eval, QuantitiesMissingInAFolderAreIntegrated) {
  const Medium medium = MediumPreset("bruneton2017");
  const auto tables = MakeTableEvaluator({.medium = medium,
                                          .transmittance = {},
                                          .single_scattering = {},
                                          .multiple_scattering = MultipleScattering(medium),
                                          .ray_nodes = 12});

  std::string text = kHeader;
  for (const char* quantity : {"transmittance", "optical_depth", "single", "inscatter_single",
                               "total", "irradiance_sun", "irradiance_sky"}) {
    text += fmt::format("{0}-sky,{0},1500,70,30,50,\n{0}-ground,{0},1500,110,30,50,\n", quantity);
  }
  const Results looked_up = Evaluate(text, *tables);
  for (const auto& [key, truth] : Evaluate(text, Integral())) {
    EXPECT_NEAR(looked_up.at(key).value, truth.value, 1e-3 * truth.value)
        << key.first << ": twelve nodes on air whose ozone bends";
  }
}

TEST_F(Eval, ColumnOrderAndLineEndsAreFree) {
  Evaluator& evaluator = Integral();
  const Results results = Evaluate(
      "\xEF\xBB\xBF"
      "sun_zenith_deg,distance_m,quantity,id,view_zenith_deg,altitude_m,relative_azimuth_deg\r\n"
      "50, ,transmittance, a b ,60,100,0\r\n"
      "50,,transmittance,c,60,100,0",
      evaluator);
  EXPECT_EQ(results.size(), 6U);
  EXPECT_EQ(results.at({"a b", 440.0}).value, results.at({"c", 440.0}).value);
}

// Hard case 43.
TEST_F(Eval, ResultsAreInOrderForAnyNumberOfThreads) {
  std::string text = kHeader;
  for (int i = 0; i < 9000; ++i) {
    text += fmt::format("{},transmittance,{},{},0,30,\n", i, i % 1000, i % 90);
  }
  WriteText(cases_, text);
  Evaluator& evaluator = Integral();
  std::vector<std::string> contents;
  for (const int threads : {1, 2, 8}) {
    const ThreadLimit limit(threads);
    EvaluateFile(cases_, results_, evaluator, ProgressStyle::kQuiet);
    contents.push_back(ContentOf(results_));
  }
  EXPECT_EQ(contents[1], contents[0]);
  EXPECT_EQ(contents[2], contents[0]);
  const std::vector<std::string> lines = LinesOf(contents[0]);
  ASSERT_EQ(lines.size(), 1U + 3U * 9000U);
  EXPECT_THAT(lines[1 + 3 * 5000], testing::StartsWith("5000,440,"));
}

TEST_F(Eval, BadCaseFilesAreRefusedWithTheirLine) {
  const std::string columns =
      "id,quantity,altitude_m,view_zenith_deg,relative_azimuth_deg,sun_zenith_deg";
  const std::string header = kHeader, good = header + "a,transmittance,0,60,0,30,\n";
  const std::pair<std::string, const char*> files[] = {
      {"", "is empty"},
      {header, "has no lines"},
      {columns + "\n", ":1: column distance_m is missing"},
      {columns + ",distance_m,tag\n", ":1: column \"tag\" is unknown"},
      {"id," + columns + ",distance_m\n", ":1: column id twice"},
      {good + "b,transmittance,0,60,0,30\n", ":3: has 6 fields"},
      {good + "b,transmittance,0,60,0,30,,\n", ":3: has 8 fields"},
      {good + "\n", ":3: has 1 fields"},
      {good + ",transmittance,0,60,0,30,\n", ":3: id is empty"},
      {good + "a,total,0,60,0,30,\n", ":3: id is \"a\", as in line 2"},
      {header + "b,airlight,0,60,0,30,\n", "quantity airlight has columns of its own"},
      {header + "b,luminance,0,60,0,30,\n", "quantity is \"luminance\""},
      {header + "b,transmittance,-6371000,60,0,30,\n", ":2: altitude_m"},
      {header + "b,transmittance,0,180.5,0,30,\n", ":2: view_zenith_deg"},
      {header + "b,transmittance,0,60,720,30,\n", ":2: relative_azimuth_deg"},
      {header + "b,transmittance,0,60,0,-1,\n", ":2: sun_zenith_deg"},
      {header + "b,transmittance,0,60,0,30,-5\n", ":2: distance_m"},
      {std::string(100000, 'x'), ":1: is longer than"},
      {header + "a,stokes_q,0,60,70,50,\n", "needs polarised light"},
      {header + "a,stokes_u,0,60,70,50,\n", "needs polarised light"}};
  for (const auto& [text, reason] : files) ExpectRefused(text, reason);
  for (const char* number : {"abc", "", "1,5", "1e999", "nan", "inf", "0x10", "5m", "--3", "1e"})
    ExpectRefused(good + "b,transmittance," + number + ",60,0,30,\n", ":3: ");
}

TEST_F(Eval, AMissingFileIsAnInputErrorAndAMissingFolderAnOutputError) {
  Evaluator& evaluator = Integral();
  EXPECT_THROW(EvaluateFile(cases_, results_, evaluator, ProgressStyle::kQuiet), InputError);
  EXPECT_THROW(EvaluateFile(folder_, results_, evaluator, ProgressStyle::kQuiet), InputError);
  WriteText(cases_, std::string(kHeader) + "a,transmittance,0,60,0,30,\n");
  EXPECT_THROW(EvaluateFile(cases_, folder_ / "none" / "r.csv", evaluator, ProgressStyle::kQuiet),
               OutputError);
}

TEST(IntegralEvaluator, OptionsOutOfRangeAreRefused) {
  const Medium medium = MediumPreset("bruneton2017");
  for (const IntegralOptions& options : {IntegralOptions{.samples = 1, .max_error = {}},
                                         {.samples = 33, .max_error = {}},
                                         {.samples = 16, .max_error = 1e-12}})
    EXPECT_THROW(static_cast<void>(MakeIntegralEvaluator(medium, options)), InputError);
  std::vector<double> wavelengths;
  for (int i = 0; i < 41; ++i) wavelengths.push_back(400.0 + 5.0 * i);
  EXPECT_THROW(static_cast<void>(MakeIntegralEvaluator(MediumPreset("earth", wavelengths))),
               InputError);
  EXPECT_DOUBLE_EQ(RelativeErrorFromText("0.2%").value_or(0.0), 0.002);
  EXPECT_DOUBLE_EQ(RelativeErrorFromText("1e-6").value_or(0.0), 1e-6);
  for (const char* text : {"", "%", "0", "2", "101%", "nan", "-1%", "0.1%%", "1e-9", "half"})
    EXPECT_FALSE(RelativeErrorFromText(text).has_value()) << text;
}

TEST_F(Eval, PathsEvaluateOnlyScatteredLight) {
  const Medium medium = MediumPreset("bruneton2017");
  constexpr double kError = tests::ScaledDown(0.005, 0.02);
  const auto paths =
      MakePathTraceEvaluator(medium, {.max_paths = kMostPathsOfCase, .relative_error = kError});
  const auto integral = MakeIntegralEvaluator(medium, WithMaxError(1e-6));
  const std::string cases = std::string(kHeader) +
                            "sky,single,2,80,40,70,\nground,single,1000,130,40,70,\n"
                            "air,inscatter_single,1000,130,40,70,\n"
                            "dusk,single,2,80,40,95,\nspace,single,400000,100,40,70,\n";
  const Results traced = Evaluate(cases, *paths);
  const Results reference = Evaluate(cases, *integral);
  ASSERT_EQ(traced.size(), 15U);
  for (const auto& [key, estimate] : traced) {
    const double truth = reference.at(key).value;
    EXPECT_NEAR(estimate.value, truth, 4.0 * estimate.error + 1e-5 * truth)
        << key.first << ": four standard errors; six digits are written";
    EXPECT_LE(estimate.error, 1.03 * kError * truth) << key.first;
  }
  const Results alone = Evaluate(std::string(kHeader) + "dusk,total,2,80,40,95,\n", *paths);
  const Results among = Evaluate(
      std::string(kHeader) + "noon,irradiance_sky,2,0,0,20,\ndusk,total,2,80,40,95,\n", *paths);
  EXPECT_EQ(alone.at({"dusk", 550.0}).value, among.at({"dusk", 550.0}).value)
      << "a value does not depend on the other cases";
  for (const Quantity quantity :
       {Quantity::kTransmittance, Quantity::kOpticalDepth, Quantity::kIrradianceSun}) {
    EXPECT_TRUE(paths->Refusal(quantity).has_value());
  }
}

const std::string kLampHeader =
    "id,quantity,scattering_per_m,extinction_per_m,phase,g,segment_m,light_along_m,light_across_m,"
    "profile,axis_x,axis_y,axis_z,exponent,inner_deg,outer_deg\n";

class LampCases : public TemporaryFolder {
 protected:
  [[nodiscard]] std::map<std::string, Estimate> Evaluate(const std::string& cases,
                                                         const IntegralOptions& options) const {
    WriteText(folder_ / "c.csv", cases);
    EvaluateLampFile(folder_ / "c.csv", folder_ / "r.csv", options, ProgressStyle::kQuiet);
    const std::vector<std::string> lines = LinesOf(ContentOf(folder_ / "r.csv"));
    EXPECT_EQ(lines.at(0), "id,wavelength_nm,value,error");
    std::map<std::string, Estimate> results;
    for (std::size_t i = 1; i < lines.size(); ++i) {
      const std::vector<std::string> cells = CellsOf(lines[i]);
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

// Returns the stored cases in the columns of this program.
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

TEST_F(LampCases, StoredCasesKeepTheRequestedError) {
  ExpectStored(Evaluate(StoredAsCases(), {}), 1e-3);
  for (const double error : {1e-4, 1e-8})
    ExpectStored(Evaluate(StoredAsCases(), {.max_error = error}), error);
}

TEST_F(LampCases, AFileOfLampsIsRecognisedByItsHeader) {
  WriteText(folder_ / "lamps.csv", kLampHeader);
  WriteText(folder_ / "sky.csv", "id,quantity,altitude_m\n");
  EXPECT_TRUE(HoldsLampCases(folder_ / "lamps.csv"));
  EXPECT_FALSE(HoldsLampCases(folder_ / "sky.csv"));
  EXPECT_FALSE(HoldsLampCases(folder_ / "none.csv"));
}

TEST_F(LampCases, BadCasesAreRefusedWithLineAndName) {
  const std::pair<const char*, const char*> lines[] = {
      {"a,airlight,0.01,0.02,cornette-shanks,0.5,,10,1,iso,,,,,,\n", "no fault"},
      {"a,single,0.01,0.02,cornette-shanks,0.5,,10,1,iso,,,,,,\n",
       ":2: quantity is \"single\"; in a file of lamps it must be airlight"},
      {"a,airlight,0.03,0.02,cornette-shanks,0.5,,10,1,iso,,,,,,\n", "scattering_per_m is 0.03"},
      {"a,airlight,0.01,0.02,mie,0.5,,10,1,iso,,,,,,\n", "phase is \"mie\""},
      {"a,airlight,0.01,0.02,cornette-shanks,1,,10,1,iso,,,,,,\n", "g is 1; it must lie in"},
      {"a,airlight,0.01,0.02,cornette-shanks,0.5,,10,0,iso,,,,,,\n", "infinitely bright"},
      // This lamp lies beyond the segment.
      {"a,airlight,0.01,0.02,cornette-shanks,0.5,5,10,0,iso,,,,,,\n", "no fault"},
      {"a,airlight,0.01,0.02,cornette-shanks,0.5,,10,1,cone,0,0,0,,1,2\n",
       "axis_x, axis_y and axis_z are all 0"},
      {"a,airlight,0.01,0.02,cornette-shanks,0.5,,10,1,cone,1,0,0,,3,2\n", "inner_deg is 3"},
      {"a,airlight,0.01,0.02,cornette-shanks,0.5,,10,1,cosn,1,0,0,,,\n",
       "exponent is \"\"; it must be a number"},
      {"a,airlight,nan,0.02,cornette-shanks,0.5,,10,1,iso,,,,,,\n", "scattering_per_m is nan"},
      {"", "has no lines"}};
  for (const auto& [line, fault] : lines)
    EXPECT_THAT(FaultOf(kLampHeader + line), HasSubstr(fault)) << line;
}

}  // namespace
}  // namespace alpenglow::lut
