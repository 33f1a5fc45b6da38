// SPDX-License-Identifier: MIT
// Evaluation of cases by one of several methods, each value with an estimate of its error: the
// implementation of `skylut eval`.
//
// Cases are lines of a CSV file, as read by CsvReader:
//
//   id,quantity,altitude_m,view_zenith_deg,relative_azimuth_deg,sun_zenith_deg,distance_m
//
// If distance_m is empty, the ray extends to the ground, whose light is included, or leaves the
// atmosphere through the top. If it is given, the segment stops there, or at the ground or the top
// if nearer, and light reflected by the ground is not included even if the segment reaches the
// ground. From below altitude 0 air continues with the density of altitude 0, and the ground ends
// only segments that lead deeper than 12 km (DeepestAir of ray.h). For relative_azimuth_deg in (0,
// 180) the sun is to the left of the view, beyond (and below 0) to its right, where stokes_u has
// the opposite sign. Cases of lamps have their own columns: lamp_cases.h.
//
// Methods:
//
//   integral  (integral_evaluator.h)
//             SingleScattering in double; light of all orders from MultipleScattering. The error is
//             the difference between two numbers of nodes plus the error of closed forms (bounds
//             below). For smaller errors than that, the reference solution is used. The error of
//             light of higher orders is 0.6 times the sum of the differences to two coarser
//             solutions (one difference alone can be small by chance) and of the light in those
//             degrees of the aerosol that the moments truncate (delta_m.h; in hazy air
//             delta_m.h computes that light itself), plus 0.3 % of the light and 1e-12 of the
//             sun's, below which light is not resolved. For narrow backward lobes the differences
//             count three times, and light that delta_m.h blurs is added. A tenth of what a forward
//             peak adds to the light from behind the end of a segment is added. At least 95 % of
//             the values are within it, by air at least 90 %: in clear air, haze, dust, thick air
//             and air with narrow lobes to either side, and of irradiances of the sky (asserted by
//             eval_test).
//   table     look-ups in stored tables; quantities that are not in them are integrated with the
//             tables' number of nodes. The error is the difference to the integral.
//   path-trace  the reference solution for multiple scattering. The error is one standard error.
//
// Radiances are per unit solar irradiance [1/sr], irradiances per unit solar irradiance [1].
//
// Light of lamps (quantity airlight) needs other columns and no atmosphere. Such cases are in a
// separate file (lamp_cases.h), and neither kind of file may contain cases of the other kind.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "atmosphere/base/csv_reader.h"
#include "atmosphere/medium/medium.h"
#include "atmosphere/ray/ray.h"
#include "atmosphere/reference/path_tracer.h"
#include "lut/cli/messages.h"
#include "lut/layer.h"
#include "lut/table_io/table_folder.h"

namespace alpenglow::lut {

enum class Quantity {
  kTransmittance,    // transmittance of the ray [1]
  kOpticalDepth,     // optical depth of the ray [1]
  kSingle,           // single scattering, and sunlight from the ground at the end of the ray [1/sr]
  kInscatterSingle,  // single scattering [1/sr]
  kTotal,            // all orders, and light from the ground at the end of the ray [1/sr]
  kStokesQ,          // of all orders, as in PolarisedLight [1/sr]
  kStokesU,
  kIrradianceSun,  // direct sun on a horizontal plane [1]
  kIrradianceSky,  // sky on a horizontal plane [1]
};

struct Case {
  std::string id;
  std::size_t line = 0;
  Quantity quantity = Quantity::kTransmittance;
  ViewRay ray;
  double relative_azimuth_deg = 0.0;
};

/// The ids of the cases that have been read, of any kind of case.
class CaseIds {
 public:
  /// Adds the id of the current line; throws InputError "file:line: fault" if it is empty or an
  /// earlier line has it.
  void Add(const std::string& id, const CsvReader& lines);

 private:
  std::unordered_map<std::string, std::size_t> line_of_;
};

class CaseReader {
 public:
  /// Throws InputError, here and in Next(), for input that CsvReader rejects, an unknown quantity
  /// and an id that an earlier case has.
  explicit CaseReader(const std::filesystem::path& file);

  /// Returns the next case; std::nullopt at the end.
  [[nodiscard]] std::optional<Case> Next();

  /// Throws an InputError "file:line: fault".
  [[noreturn]] void Fail(std::size_t line, const std::string& fault) const {
    lines_.Fail(line, fault);
  }

  /// Number of bytes read and to read, for progress.
  [[nodiscard]] std::uint64_t bytes_read() const { return lines_.bytes_read(); }
  [[nodiscard]] std::uint64_t bytes() const { return lines_.bytes(); }

 private:
  CsvReader lines_;
  CaseIds ids_;
};

/// A value and the method's own estimate of its error, in the same unit.
struct Estimate {
  double value = 0.0;
  double error = 0.0;
};

/// One estimate per wavelength.
using Estimates = std::vector<Estimate>;

/// Default maximum of paths per case; larger errors remain after it.
inline constexpr std::size_t kMostPathsOfCase = std::size_t{1} << 22U;

/// The smallest error that may be requested: the accuracy of the reference solution.
inline constexpr double kSmallestMaxError = 1e-8;

/// Reads "0.2%" or "0.002"; std::nullopt for another text and outside of [kSmallestMaxError, 1].
[[nodiscard]] std::optional<double> RelativeErrorFromText(std::string_view text);
/// Describes the fault of such a text, for the command line; empty if there is none.
[[nodiscard]] std::string FaultOfRelativeError(const std::string& text);

/// Relative error of closed-form optical depths (worst: rays that graze the top from outside), if
/// the planet's radius is more than 120 times the scale heights; see medium.h.
inline constexpr double kClosedFormError = 2e-5;

/// Returns this relative error for any planet.
[[nodiscard]] double ClosedFormError(const Medium& medium);

[[nodiscard]] constexpr bool NeedsLightOfAllOrders(Quantity quantity) {
  return quantity == Quantity::kTotal || quantity == Quantity::kIrradianceSky ||
         quantity == Quantity::kStokesQ || quantity == Quantity::kStokesU;
}
[[nodiscard]] constexpr bool NeedsPolarisedLight(Quantity quantity) {
  return quantity == Quantity::kStokesQ || quantity == Quantity::kStokesU;
}

/// Returns why a medium has no Stokes parameters; std::nullopt if it has.
[[nodiscard]] std::optional<std::string> RefusalOfScalarLight(const Medium& medium);

/// Returns the estimates of a case of stokes_q or stokes_u, from Q and U as defined in
/// PolarisedLight (the sun not to the right). For vertical views the azimuth is that of the
/// picture's upper edge: Q and U rotate with it.
[[nodiscard]] Estimates StokesOf(const Case& work, const Estimates& q, const Estimates& u);

/// Returns the sun's zenith cosine at the point where a ray hits the ground; std::nullopt if it
/// does not, and for rays of a given length, which do not include light of the ground
/// (BringsLightOfGround).
[[nodiscard]] std::optional<double> SunOnGround(const Medium& medium, const ViewRay& ray);

/// Evaluates cases by one method. Thread-safe once prepared.
class Evaluator {
 public:
  virtual ~Evaluator() = default;

  [[nodiscard]] virtual const Medium& medium() const = 0;
  /// Returns why this method cannot compute a quantity; std::nullopt if it can.
  [[nodiscard]] virtual std::optional<std::string> Refusal(Quantity quantity) const = 0;
  /// Prepares the data for these cases (light of all orders takes seconds).
  virtual void Prepare(std::span<const Case> cases) = 0;
  [[nodiscard]] virtual Estimates Evaluate(const Case& work) const = 0;
};

/// Makes an evaluator that rejects light of all orders if the tables hold single scattering only.
/// Throws InputError for tables of different media.
[[nodiscard]] std::unique_ptr<Evaluator> MakeTableEvaluator(TableFolder tables);

/// Makes an evaluator for single or multiple scattering and the sky's irradiance; it rejects the
/// other quantities. Throws InputError for a relative error out of range.
/// @param options  of each case: its value does not depend on other cases. `stopped` is replaced: an
///   interrupt stops the tracer.
[[nodiscard]] std::unique_ptr<Evaluator> MakePathTraceEvaluator(
    const Medium& medium, const reference::PathOptions& options = {.max_paths = kMostPathsOfCase});

/// Evaluates every case of a file in parallel and writes "id,wavelength_nm,value,error" in the
/// order of the cases, atomically. It never holds more than a few thousand cases, and the ids of
/// all. Throws InputError naming file and line.
void EvaluateFile(const std::filesystem::path& cases, const std::filesystem::path& results,
                  Evaluator& evaluator, ProgressStyle style);

}  // namespace alpenglow::lut
