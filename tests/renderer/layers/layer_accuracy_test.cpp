// SPDX-License-Identifier: MIT
// Light in plane-parallel layers agrees with doubling and adding, and with published tables.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "atmosphere/math/constants.h"
#include "renderer/layers/layer_field.h"
#include "tests/fixtures/places.h"
#include "tests/fixtures/quantile.h"
#include "tests/fixtures/report_files.h"
#include "tests/fixtures/sanitized.h"
#include "tests/renderer/layers/doubling_reference.h"
#include "tests/renderer/layers/layer_moments.h"

namespace alpenglow::renderer {
namespace {

namespace fs = std::filesystem;

double Lobe(double g, double nu) {
  return (1.0 - g * g) / (4.0 * kPi) * std::pow(1.0 + g * g - 2.0 * g * nu, -1.5);
}
double Molecules(double nu) { return 3.0 / (16.0 * kPi) * (1.0 + nu * nu); }

/// A cloud in air above ground, for both methods.
struct CloudyAir {
  double depth, albedo, g, ground;

  [[nodiscard]] LayerStack Fast(int streams) const {
    return LayerStack({{0.17, 1.0, kMoleculeMoments},
                       {depth, albedo, LobeMoments(g)},
                       {0.05, 1.0, kMoleculeMoments}},
                      ground, streams);
  }
  [[nodiscard]] doubling::Stack Reference(const doubling::Options& options) const {
    return doubling::Stack({{0.17, 1.0, Molecules},
                            {depth, albedo, [g = g](double nu) { return Lobe(g, nu); }},
                            {0.05, 1.0, Molecules}},
                           ground, options);
  }
};

/// Errors of radiances, relative, ascending, and the largest of fluxes relative to the incident flux.
struct LayerErrors {
  std::vector<double> radiance;
  double flux = 0.0;

  [[nodiscard]] double rms() const {
    double squares = 0.0;
    for (const double error : radiance) squares += error * error;
    return std::sqrt(squares / static_cast<double>(radiance.size()));
  }
};

const std::vector<double> kCosines{0.3, 0.6, 0.95, 0.08};

void AddErrors(const LayerStack& stack, const doubling::Stack& truth, LayerErrors& errors) {
  for (std::size_t sun = 0; sun < 3; ++sun) {
    const LayerField field = LayerField::UnderSun(stack, kCosines[sun]);
    for (std::size_t n = 0; n <= stack.size(); ++n) {
      const double depth = stack.DepthAbove(n);
      const LayerFluxes fluxes = field.Fluxes(depth);
      errors.flux =
          std::max({errors.flux, std::abs(fluxes.up - truth.Flux(n, true, sun)) / kCosines[sun],
                    std::abs(fluxes.down - truth.Flux(n, false, sun)) / kCosines[sun]});
      for (std::size_t view = 0; view < kCosines.size(); ++view) {
        for (const double azimuth : {0.2, 1.0, 2.0, 3.0}) {
          for (const bool up : {true, false}) {
            if (!up && n == 0) continue;
            const double expected = truth.Radiance(n, up, view, sun, azimuth);
            const double mu = up ? kCosines[view] : -kCosines[view];
            errors.radiance.push_back(
                std::abs(field.Radiance(depth, {mu, azimuth}) / expected - 1.0));
          }
        }
      }
    }
  }
}

/// Returns the errors for every number of streams.
std::vector<LayerErrors> ErrorsBy(const std::vector<int>& streams) {
  const auto airs = tests::ScaledDown<std::vector<CloudyAir>>(
      {{0.3, 1.0, 0.75, 0.1}, {5.0, 0.99, 0.75, 0.8}, {20.0, 0.95, 0.75, 0.1}},
      {{0.3, 1.0, 0.6, 0.1}});
  std::vector<LayerErrors> errors(streams.size());
  for (const CloudyAir& air : airs) {
    const doubling::Stack truth =
        air.Reference({tests::ScaledDown(16, 10), tests::ScaledDown(32, 20), kCosines});
    for (std::size_t i = 0; i < streams.size(); ++i) {
      AddErrors(air.Fast(streams[i]), truth, errors[i]);
    }
  }
  for (LayerErrors& one : errors) std::sort(one.radiance.begin(), one.radiance.end());
  return errors;
}

TEST(LayerAccuracy, EightStreamsAreWithinOnePercentOfDoubling) {
  const LayerErrors errors = ErrorsBy({8}).front();
  EXPECT_LT(errors.rms(), 0.01);
  EXPECT_LT(tests::Quantile(errors.radiance, 0.99), 0.04);
  EXPECT_LT(errors.flux, 0.0015);
}

TEST(LayerAccuracy, ManyStreamsApproachDoubling) {
  const std::vector<LayerErrors> errors = ErrorsBy({4, 8, 32});
  EXPECT_LT(errors[1].rms(), 0.4 * errors[0].rms());
  EXPECT_LT(errors[2].rms(), 2e-4) << "Gauss's rule of the reference";
  EXPECT_LT(errors[2].flux, 1e-4);
}

TEST(LayerAccuracy, TheAureoleIsThatOfManyStreams) {
  // With 48 streams the forward peak is 0.0004 of the light that is scattered.
  const int many = tests::ScaledDown(48, 16);
  const double zenith = 40.0 * kPi / 180.0;
  for (const double albedo : {1.0, 0.8}) {
    for (const double depth : {1.0, 5.0}) {
      const CloudyAir air{depth, albedo, 0.85, 0.1};
      const LayerStack few = air.Fast(8), truth = air.Fast(many);
      const double bottom = few.DepthAbove(few.size());
      const LayerField seen = LayerField::UnderSun(few, std::cos(zenith));
      const LayerField expected = LayerField::UnderSun(truth, std::cos(zenith));
      for (const double angle_deg : {0.1, 0.5, 1.5, 3.0, 8.0}) {
        const LightWay way{-std::cos(zenith - angle_deg * kPi / 180.0), 0.0};
        EXPECT_NEAR(seen.Radiance(bottom, way) / expected.Radiance(bottom, way), 1.0, 0.01)
            << albedo << " " << depth << " " << angle_deg;
      }
    }
  }
}

/// Rows of a published table: cells by the names of the columns.
using TableRow = std::map<std::string, std::string>;

std::vector<TableRow> TableRows(const fs::path& file) {
  std::ifstream in(file);
  std::vector<TableRow> rows;
  std::vector<std::string> head;
  for (std::string line; std::getline(in, line);) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty() || line[0] == '#') continue;
    const std::vector<std::string> cells = CellsOf(line);
    if (head.empty()) {
      head = cells;
      continue;
    }
    TableRow row;
    for (std::size_t i = 0; i < head.size(); ++i) row[head[i]] = i < cells.size() ? cells[i] : "";
    rows.push_back(row);
  }
  return rows;
}

/// Published values of DISORT for its own test problems, and the same layers here.
class PublishedLayers : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(tests::kSharedFolder) / "tables";
    if (!fs::exists(folder_ / "disort_layers_flux.csv")) {
      GTEST_SKIP() << "no published layers in ../shared/tables";
    }
  }

  /// Returns the layer of a row.
  [[nodiscard]] LayerOptics LayerOf(const TableRow& row) const {
    const std::string& albedo = row.at("omega");
    LayerOptics layer{
        std::stod(row.at("tau_total")), albedo == "1 - 1e-6" ? 1.0 : std::stod(albedo), {1.0}};
    switch (row.at("test")[0]) {
      case '2':
        layer.chi = kMoleculeMoments;
        break;
      case '3':
        layer.chi = LobeMoments(0.75);
        break;
      case '4':
        layer.chi = HazeMoments();
        break;
      default:
        break;
    }
    return layer;
  }
  /// Returns the irradiance of the beam.
  [[nodiscard]] static double BeamOf(const TableRow& row) {
    return row.at("I0") == "pi" ? kPi : kPi / std::stod(row.at("mu0"));
  }

  fs::path folder_;

 private:
  [[nodiscard]] std::vector<double> HazeMoments() const {
    std::vector<double> chi;
    for (const TableRow& row : TableRows(folder_ / "disort_phase_moments.csv")) {
      if (row.at("haze_l").empty()) break;
      chi.push_back(std::stod(row.at("haze_l")) / (2.0 * static_cast<double>(chi.size()) + 1.0));
    }
    return chi;
  }
};

TEST_F(PublishedLayers, HaveTheFluxesOfDisort) {
  for (const TableRow& row : TableRows(folder_ / "disort_layers_flux.csv")) {
    const LayerStack stack({LayerOf(row)}, 0.0, 16);  // the streams of the tables
    const double mu_s = std::stod(row.at("mu0")), beam = BeamOf(row);
    const LayerFluxes fluxes = LayerField::UnderSun(stack, mu_s).Fluxes(std::stod(row.at("tau")));
    const double limit = 1e-4 * beam * mu_s;
    EXPECT_NEAR(beam * fluxes.up, std::stod(row.at("flux_up_diffuse")), limit) << row.at("test");
    EXPECT_NEAR(beam * fluxes.down, std::stod(row.at("flux_down_diffuse")), limit)
        << row.at("test");
    EXPECT_NEAR(beam * fluxes.direct, std::stod(row.at("flux_down_direct")), limit)
        << row.at("test");
  }
}

TEST_F(PublishedLayers, HaveTheRadiancesOfDisort) {
  int compared = 0;
  for (const TableRow& row : TableRows(folder_ / "disort_layers_intensity.csv")) {
    const double mu_s = std::stod(row.at("mu0")), mu = std::stod(row.at("mu"));
    const double azimuth = std::stod(row.at("azimuth_rad")) - kPi;
    const double nu =
        std::sqrt((1.0 - mu * mu) * (1.0 - mu_s * mu_s)) * std::cos(azimuth) - mu * mu_s;
    if (nu > std::cos(10.0 * kPi / 180.0)) continue;  // the table's own limit
    const LayerStack stack({LayerOf(row)}, 0.0, 16);
    const double expected = std::stod(row.at("intensity"));
    const double found =
        BeamOf(row) *
        LayerField::UnderSun(stack, mu_s).Radiance(std::stod(row.at("tau")), {mu, azimuth});
    EXPECT_NEAR(found, expected, 0.01 * expected + 1e-9) << row.at("test") << " " << mu;
    ++compared;
  }
  EXPECT_GT(compared, 300);
}

}  // namespace
}  // namespace alpenglow::renderer
