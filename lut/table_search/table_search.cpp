// SPDX-License-Identifier: MIT
#include "lut/table_search/table_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <system_error>

#include "atmosphere/base/error.h"
#include "lut/cli/output_file.h"
#include "lut/cli/program.h"

namespace alpenglow::lut {
namespace {

namespace fs = std::filesystem;

constexpr std::array kRayNodes{4, 6, 8, 10, 12, 16, 20, 24, 28, 32};
constexpr std::array kAltitudes{4, 5, 6, 7, 8, 10, 12, 14, 17, 20, 24, 28, 34, 40};
constexpr std::array kSunAngles{8, 10, 12, 14, 17, 20, 24, 28, 34, 40, 48, 56, 68, 80};

// Sizes of the tables that are tried if all tables are wanted, by bytes.
constexpr std::array kTransmittanceSizes{
    TransmittanceTableSize{32, 8},    TransmittanceTableSize{64, 16},
    TransmittanceTableSize{128, 32},  TransmittanceTableSize{128, 64},
    TransmittanceTableSize{256, 64},  TransmittanceTableSize{256, 128},
    TransmittanceTableSize{512, 256}, TransmittanceTableSize{1024, 512}};
constexpr std::array kSingleScatteringSizes{
    ScatteringTableSize{4, 12, 16, 16},   ScatteringTableSize{5, 16, 32, 24},
    ScatteringTableSize{6, 20, 32, 32},   ScatteringTableSize{6, 24, 48, 48},
    ScatteringTableSize{8, 32, 64, 64},   ScatteringTableSize{8, 32, 64, 96},
    ScatteringTableSize{10, 48, 64, 128}, ScatteringTableSize{10, 48, 96, 160}};

// Smallest standard error of path-traced views; a quarter of it takes sixteen times as long.
constexpr double kLeastNoise = 1e-3;
// Fractions of the bound that the nodes along a ray may take, and the nodes together with the other
// tables.
constexpr double kShareOfNodes = 0.5;
constexpr double kShareOfTables = 0.75;

/// Largest error of look-ups relative to the bounds, and the kind of view that has it.
struct Verdict {
  double excess = 0.0;  // largest error over its bound
  ViewKind worst = ViewKind::kSky;
  double error = 0.0;  // error of the kind `worst`
};

/// Upper bounds of the rms, by kind.
using Bounds = std::array<double, kViewKinds.size()>;

Verdict Assess(const ReferenceViews& views, const TableLookup& tables, const Bounds& bounds,
               double enough) {
  Verdict verdict;
  // Start with the last kind: irradiance is cheap to look up and rules out most tables.
  for (std::size_t k = kViewKinds.size(); k-- > 0;) {
    // A sample of views may miss the few with large errors, and the bound applies to these, too.
    const double error = views.ErrorsOf(tables, kViewKinds[k]).RmsAtMost();
    if (error / bounds[k] > verdict.excess) verdict = {error / bounds[k], kViewKinds[k], error};
    if (verdict.excess > enough) return verdict;
  }
  return verdict;
}

struct Grid {
  int altitudes, sun_angles, degree;
  [[nodiscard]] std::size_t Values() const {
    return static_cast<std::size_t>(altitudes) * static_cast<std::size_t>(sun_angles) *
           (MomentCount(degree) + 1);
  }
};

/// Returns the grids to try, by size, with degrees up to that of the finest solution.
std::vector<Grid> GridsBySize(int finest_degree) {
  std::vector<Grid> grids;
  for (const int degree : kDegrees) {
    if (degree > finest_degree) continue;
    for (const int altitudes : kAltitudes) {
      for (const int sun_angles : kSunAngles) grids.push_back({altitudes, sun_angles, degree});
    }
  }
  std::stable_sort(grids.begin(), grids.end(),
                   [](const Grid& a, const Grid& b) { return a.Values() < b.Values(); });
  return grids;
}

TableFolder Folder(const Medium& medium, MultipleScattering light, int ray_nodes) {
  return {.medium = medium,
          .transmittance = {},
          .single_scattering = {},
          .multiple_scattering = std::move(light),
          .ray_nodes = ray_nodes};
}

[[noreturn]] void RefuseBound(double max_error, const std::string& best) {
  throw InputError(
      fmt::format("max-error {:g} %: no tables reach it: {}", 100.0 * max_error, best));
}

/// Returns the part of the bound that remains after the error of the truth. Throws if nothing
/// remains.
Bounds BoundsOf(double max_error, const std::vector<TableChoice::Measured>& measured) {
  Bounds bounds{};
  for (std::size_t k = 0; k < measured.size(); ++k) {
    const double missing = measured[k].paths.Unexplained();
    const double rest = max_error * max_error - missing * missing;
    if (rest <= 0.0) {
      RefuseBound(max_error,
                  fmt::format("the finest light of all orders is {:.2g} % from path tracing "
                              "({})",
                              100.0 * missing, NameOf(measured[k].kind)));
    }
    bounds[k] = std::sqrt(rest);
  }
  return bounds;
}

int FewestNodes(const ReferenceViews& views, const MultipleScattering& finest, const Bounds& bounds,
                double max_error) {
  Verdict best;
  for (const double share : {kShareOfNodes, 1.0}) {
    for (const int nodes : kRayNodes) {
      ThrowIfInterrupted();
      const TableLookup tables(Folder(finest.medium(), finest, nodes));
      best = Assess(views, tables, bounds, share);
      if (best.excess <= share) return nodes;
    }
  }
  RefuseBound(max_error, fmt::format("{} nodes along a ray leave {:.2g} % ({})", kRayNodes.back(),
                                     100.0 * best.error, NameOf(best.worst)));
}

/// Returns `tables` with the first of these sizes whose error lies below the allowed fraction of
/// the bounds.
template <typename Sizes, typename Put>
TableFolder WithSmallest(std::string_view name, const ReferenceViews& views, const Bounds& bounds,
                         double max_error, const Sizes& sizes, const TableFolder& tables,
                         const Put& put) {
  Verdict best;
  for (const auto& size : sizes) {
    ThrowIfInterrupted();
    TableFolder with = tables;
    put(with, size);
    const TableLookup lookup(std::move(with));
    best = Assess(views, lookup, bounds, kShareOfTables);
    if (best.excess <= kShareOfTables) return lookup.tables();
  }
  RefuseBound(max_error, fmt::format("the largest table of {} leaves {:.2g} % ({})", name,
                                     100.0 * best.error, NameOf(best.worst)));
}

TableFolder WithAllTables(const ReferenceViews& views, const Bounds& bounds, double max_error,
                          const TableFolder& tables) {
  const TableFolder with_transmittance =
      WithSmallest("transmittance", views, bounds, max_error, kTransmittanceSizes, tables,
                   [](TableFolder& folder, const TransmittanceTableSize& size) {
                     folder.transmittance.emplace(folder.medium, size);
                   });
  return WithSmallest("single scattering", views, bounds, max_error, kSingleScatteringSizes,
                      with_transmittance, [](TableFolder& folder, const ScatteringTableSize& size) {
                        folder.single_scattering.emplace(
                            folder.medium,
                            ScatteringTableOptions{
                                .size = size, .lowest_mu_s = {}, .axes = ScatteringAxes::kAzimuth});
                      });
}

/// Replaces the finest light by the smallest table within the bounds.
TableFolder WithSmallestLight(const ReferenceViews& views, const Bounds& bounds, double max_error,
                              TableFolder tables) {
  const MultipleScattering finest = *tables.multiple_scattering;
  TableLookup lookup(std::move(tables));
  Verdict best;
  for (const Grid& grid : GridsBySize(finest.options().degree)) {
    ThrowIfInterrupted();
    lookup.ReplaceMultipleScattering(
        Resampled(finest, grid.altitudes, grid.sun_angles, grid.degree));
    best = Assess(views, lookup, bounds, 1.0);
    if (best.excess <= 1.0) return lookup.tables();
  }
  RefuseBound(max_error, fmt::format("the finest moments leave {:.2g} % ({})", 100.0 * best.error,
                                     NameOf(best.worst)));
}

std::uint64_t BytesOf(const TableFolder& tables) {
  std::uint64_t bytes = tables.multiple_scattering->values().size() * sizeof(float);
  if (tables.transmittance) bytes += tables.transmittance->bytes();
  if (tables.single_scattering) bytes += tables.single_scattering->bytes();
  return bytes;
}

std::string MeasuredText(const TableChoice& choice) {
  std::string text;
  for (const auto& [kind, errors, paths] : choice.measured) {
    text += fmt::format(
        "  {:<22} rms {:6.3f} % (at most {:.3f} %), 99th percentile {:6.3f} %; truth against paths "
        "{:.3f} % (noise {:.3f} %)\n",
        NameOf(kind), 100.0 * errors.Rms(), 100.0 * errors.RmsAtMost(),
        100.0 * errors.Quantile(0.99), 100.0 * paths.rms, 100.0 * paths.noise);
  }
  return text;
}

void RemoveOld(const fs::path& file) {
  std::error_code error;
  fs::remove(file, error);
  if (error)
    throw OutputError(fmt::format("{}: cannot be removed: {}", file.string(), error.message()));
}

}  // namespace

MultipleScattering Resampled(const MultipleScattering& light, int altitudes, int sun_angles,
                             int degree) {
  ALPENGLOW_ENSURE(degree, <=, light.options().degree);
  const std::size_t moments = MomentCount(degree);
  const auto share = [](int i, int n) { return static_cast<double>(i) / (n - 1); };
  SolvedOrders solved{{}, light.orders(), light.converged()};
  for (int a = 0; a < altitudes; ++a) {
    for (int s = 0; s < sun_angles; ++s) {
      const std::vector<float> all = light.ValuesAt(share(a, altitudes), share(s, sun_angles));
      const auto bands = static_cast<std::ptrdiff_t>(light.bands());
      const auto kept = static_cast<std::ptrdiff_t>(moments) * bands;
      const auto rest =
          static_cast<std::ptrdiff_t>(light.channels() - MomentCount(light.options().degree)) *
          bands;
      solved.values.insert(solved.values.end(), all.begin(), all.begin() + kept);
      solved.values.insert(solved.values.end(), all.end() - rest, all.end());
    }
  }
  MultipleScatteringOptions options = light.options();
  options.altitudes = altitudes;
  options.sun_angles = sun_angles;
  options.degree = degree;
  return MultipleScattering(light.medium(), options, std::move(solved));
}

TableChoice ChooseTables(const Medium& medium, const TableSearch& search) {
  RequireInRange(search.max_error, 1e-8, 1.0, "max-error");
  return ChooseTables(FinestMultipleScattering(medium), search);
}

TableChoice ChooseTables(const MultipleScattering& finest, const TableSearch& search) {
  RequireInRange(search.max_error, 1e-8, 1.0, "max-error");
  const Medium& medium = finest.medium();
  const ReferenceViews views(medium, finest, search.views_of_a_kind, 0);
  TableChoice choice;
  for (const ViewKind kind : kViewKinds) {
    choice.measured.push_back(
        {kind,
         {},
         views.HeldAgainstPaths(medium, kind, search.path_traced_views_of_a_kind,
                                std::max(search.max_error / 4.0, kLeastNoise))});
  }
  const Bounds bounds = BoundsOf(search.max_error, choice.measured);
  const int ray_nodes = FewestNodes(views, finest, bounds, search.max_error);
  TableFolder tables = Folder(medium, finest, ray_nodes);
  if (search.wanted == TablesWanted::kAll) {
    tables = WithAllTables(views, bounds, search.max_error, tables);
  }
  choice.tables = WithSmallestLight(views, bounds, search.max_error, std::move(tables));
  choice.bytes = BytesOf(choice.tables);
  const TableLookup chosen(choice.tables);
  for (TableChoice::Measured& measured : choice.measured) {
    measured.errors = views.ErrorsOf(chosen, measured.kind);
  }
  return choice;
}

std::string ChoiceText(const TableChoice& choice, double max_error) {
  const TableFolder& tables = choice.tables;
  const MultipleScatteringOptions& grid = tables.multiple_scattering->options();
  std::string text =
      fmt::format("for errors below {:g} %: {} bytes\n", 100.0 * max_error, choice.bytes);
  text += "  transmittance          ";
  if (tables.transmittance) {
    const TransmittanceTableSize& size = tables.transmittance->size();
    text += fmt::format("{} view angles x {} altitudes\n", size.mu, size.altitudes);
  } else {
    text += "no table: closed form\n";
  }
  text += "  single scattering      ";
  if (tables.single_scattering) {
    const ScatteringTableSize& size = tables.single_scattering->size();
    text += fmt::format("{} azimuths x {} sun angles x {} view angles x {} altitudes; segments: ",
                        size.nu, size.mu_s, size.mu, size.altitudes);
  } else {
    text += "no table: ";
  }
  text += fmt::format(
      "{} Gauss nodes on each smooth piece of a ray\n"
      "  multiple scattering    {} sun angles x {} altitudes, moments to degree {}\n"
      "measured, total light of all orders:\n",
      tables.ray_nodes, grid.sun_angles, grid.altitudes, grid.degree);
  return text + MeasuredText(choice);
}

void WriteTables(const TableChoice& choice, const fs::path& folder) {
  MakeFolder(folder);
  for (const char* file :
       {kMultipleScatteringFileName, kTransmittanceFileName, kSingleScatteringFileName}) {
    RemoveOld(folder / file);
  }
  const TableFolder& tables = choice.tables;
  if (tables.transmittance) WriteTable(folder / kTransmittanceFileName, *tables.transmittance);
  if (tables.single_scattering) {
    WriteTable(folder / kSingleScatteringFileName, *tables.single_scattering);
  }
  WriteTable(folder / kMultipleScatteringFileName, *tables.multiple_scattering,
             {.ray_nodes = tables.ray_nodes,
              .transmittance = tables.transmittance.has_value(),
              .single_scattering = tables.single_scattering.has_value()});
}

}  // namespace alpenglow::lut
