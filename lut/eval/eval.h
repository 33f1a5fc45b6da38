// SPDX-License-Identifier: MIT
// Cases to evaluate, one a line of a CSV file:
//
//   id,quantity,altitude_m,view_zenith_deg,relative_azimuth_deg,sun_zenith_deg,distance_m
//
// as CsvReader reads them. distance_m empty: the ray goes to the ground, whose light it brings, or
// out of the top. Given: the segment stops there, or at the ground or the top if nearer, and light
// that the ground reflects is left out even where the segment reaches it. relative_azimuth_deg in
// (0, 180): the sun is to the left of the view, beyond (and below 0) to its right, which is another
// sign of stokes_u. Cases of lamps have columns of their own: lamp_cases.h.
//
// Values of cases by one method, each with an estimate of its error: what `skylut eval` does.
//
//   integral  AirIntegrator in double; light of all orders from DiffuseLight. The error is the
//             difference between two numbers of nodes and what closed forms leave (bounds below).
//             For errors below what these can do, the judge. Of light of higher orders: the
//             differences to two coarser solutions (one alone can be small by luck), and what the
//             degrees of the aerosol that moments do not keep would hold (forward_peak.h; in
//             hazy air forward_peak.h gives that light itself), times 0.6, and 0.3 % of it. Of 384 values in air unseen by the calibration (clear, haze,
//             dust, molecules, thick, over snow) 98 % are within it, at least 97 % in each; it is 3
//             times the true error in the median.
//   table     look-ups in stored tables; what they leave out, integrated on their number of nodes.
//             The error is the distance to the integral.
//   path-trace  the judge of multiple scattering. The error is one standard error.
//
// Radiances are per unit solar irradiance [1/sr], irradiances per unit solar irradiance [1].
//
// Light of lamps (quantity airlight) needs other columns and no atmosphere: such cases are a file
// of their own (lamp_cases.h), and neither kind of file holds cases of the other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/air/medium.h"
#include "atmosphere/ray/ray.h"
#include "lut/layer.h"
#include "lut/program/csv_reader.h"
#include "lut/program/messages.h"
#include "lut/store/table_folder.h"

namespace alpenglow::lut {

enum class Quantity {
  kTransmittance,    // of the ray [1]
  kOpticalDepth,     // of the ray [1]
  kSingle,           // scattered once, and sunlight from the ground at the end of the ray [1/sr]
  kInscatterSingle,  // scattered once [1/sr]
  kTotal,            // all orders, and light from the ground at the end of the ray [1/sr]
  kStokesQ,          // of all orders, as PolarisedLight [1/sr]
  kStokesU,
  kIrradianceSun,  // of the direct sun on a horizontal plane [1]
  kIrradianceSky,  // of the sky on a horizontal plane [1]
};

struct Case {
  std::string id;
  std::size_t line = 0;
  Quantity quantity = Quantity::kTransmittance;
  ViewRay ray;
  double relative_azimuth_deg = 0.0;
};

class CaseReader {
 public:
  /// Throws InputError, here and in Next(), for what CsvReader refuses and an unknown quantity.
  explicit CaseReader(const std::filesystem::path& file);

  /// The next case, or nothing at the end.
  [[nodiscard]] std::optional<Case> Next();

  /// An InputError "file:line: fault".
  [[noreturn]] void Fail(std::size_t line, const std::string& fault) const {
    lines_.Fail(line, fault);
  }

  /// How far it is, for progress.
  [[nodiscard]] std::uint64_t bytes_read() const { return lines_.bytes_read(); }
  [[nodiscard]] std::uint64_t bytes() const { return lines_.bytes(); }

 private:
  CsvReader lines_;
};

/// A value and the method's own estimate of its error, in the same unit.
struct Estimate {
  double value = 0.0;
  double error = 0.0;
};

/// One a wavelength.
using Estimates = std::vector<Estimate>;

struct IntegralOptions {
  int samples = 16;  // Gauss nodes a panel, in [2, 32]
  /// Relative: chooses the samples of every case, and the judge where they do not suffice. Light of
  /// higher orders has the error it has.
  std::optional<double> max_error;
};

struct PathTraceOptions {
  double max_error = 0.005;  // relative: paths are added until one standard error is below it
  std::size_t max_paths = std::size_t{1} << 22U;  // of a case; errors stay larger then
  std::uint64_t seed = 1;                         // a case's value does not depend on others
};

inline constexpr int kFewestSamples = 2;
inline constexpr int kMostSamples = 32;

/// The smallest error that can be asked for: what the judge keeps.
inline constexpr double kSmallestMaxError = 1e-8;

/// "0.2%" or "0.002"; nothing for another text and outside of
/// [kSmallestMaxError, 1].
[[nodiscard]] std::optional<double> RelativeErrorFromText(std::string_view text);
/// What is wrong with such a text, for the command line; empty when nothing is.
[[nodiscard]] std::string FaultOfRelativeError(const std::string& text);

/// Relative error of closed-form optical depths (worst: rays that graze the top from outside),
/// where the planet's radius is more than 120 times the scale heights; see medium.h.
inline constexpr double kClosedFormError = 2e-5;

/// The same over any planet.
[[nodiscard]] double ClosedFormError(const Medium& medium);

[[nodiscard]] constexpr bool NeedsLightOfAllOrders(Quantity quantity) {
  return quantity == Quantity::kTotal || quantity == Quantity::kIrradianceSky ||
         quantity == Quantity::kStokesQ || quantity == Quantity::kStokesU;
}
[[nodiscard]] constexpr bool NeedsPolarisedLight(Quantity quantity) {
  return quantity == Quantity::kStokesQ || quantity == Quantity::kStokesU;
}

/// Why a medium has neither; nothing when it has.
[[nodiscard]] std::optional<std::string> RefusalOfScalarLight(const Medium& medium);

/// Of a case of either, from Q and U as PolarisedLight has them (the sun not to the right). Straight
/// up and down the azimuth is that of the picture's upper edge: Q and U turn with it.
[[nodiscard]] Estimates StokesOf(const Case& work, const Estimates& q, const Estimates& u);

/// The sun's zenith cosine where a ray meets the ground; nothing when it does not, and for rays of
/// a given length, which bring no light of the ground (BringsLightOfGround).
[[nodiscard]] std::optional<double> SunOnGround(const Medium& medium, const ViewRay& ray);

/// Thread-safe once prepared.
class Evaluator {
 public:
  virtual ~Evaluator() = default;

  [[nodiscard]] virtual const Medium& medium() const = 0;
  /// Why this method cannot give a quantity; nothing when it can.
  [[nodiscard]] virtual std::optional<std::string> Refusal(Quantity quantity) const = 0;
  /// Makes ready what these cases need (light of all orders takes seconds).
  virtual void Prepare(std::span<const Case> cases) = 0;
  [[nodiscard]] virtual Estimates Evaluate(const Case& work) const = 0;
};

/// Throws InputError for more than kMaxBands wavelengths, and options out of range.
[[nodiscard]] std::unique_ptr<Evaluator> MakeIntegralEvaluator(const Medium& medium,
                                                               const IntegralOptions& options = {});
/// Refuses light of all orders where the tables hold single scattering only. Throws InputError for
/// tables of different media.
[[nodiscard]] std::unique_ptr<Evaluator> MakeTableEvaluator(TableFolder tables);

/// Light scattered once or by all orders, and the sky's irradiance; refuses the other quantities.
/// Throws InputError for options out of range.
[[nodiscard]] std::unique_ptr<Evaluator> MakePathTraceEvaluator(
    const Medium& medium, const PathTraceOptions& options = {});

/// Evaluates every case of a file in parallel and writes "id,wavelength_nm,value,error" in the
/// order of the cases, whole or not at all. Never holds more than a few thousand cases. Throws
/// InputError naming file and line.
void EvaluateFile(const std::filesystem::path& cases, const std::filesystem::path& results,
                  Evaluator& evaluator, ProgressStyle style);

}  // namespace alpenglow::lut
