// SPDX-License-Identifier: MIT
// A phase function that was measured or computed elsewhere: values at angles.
//
//   s = (theta / pi)^(1/3)
//
// The samples are joined by cubics in (theta, log p): positive, with the slopes of
// parabolas through three neighbours, level at 0 and 180 degrees where symmetry asks
// for it. That curve is taken at kNodes uniform s, which give a forward peak a
// hundredth of a degree wide as many nodes as the rest, and scaled to an integral of 1.
// From then on the function *is* the broken line in s through the nodes: values,
// moments and samples belong to the same function, here and on graphics cards.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace alpenglow::atmosphere {

/// Immutable; shared between phase functions and threads.
class PhaseTable {
 public:
  /// As many vec4 as every OpenGL has room for in one uniform block.
  static constexpr std::size_t kNodes = 1024;
  /// Samples whose integral over the sphere is further from 1 than this are refused: they were
  /// normalised to something else, or are too few to say what lies between them. (Those of OPAC
  /// are up to 1.0 % below 1.)
  static constexpr double kLargestDeviation = 0.02;

  /// @param angle_deg  scattering angles, strictly ascending from 0 to 180, at least 5.
  /// @param per_sr     values there [1/sr], > 0, integral over the sphere 1 within
  ///                   kLargestDeviation.
  /// Throws InputError that opens with "phase: " and says what is wrong.
  PhaseTable(std::vector<double> angle_deg, std::vector<double> per_sr);

  [[nodiscard]] const std::vector<double>& angle_deg() const { return angle_deg_; }
  [[nodiscard]] const std::vector<double>& per_sr() const { return per_sr_; }
  /// Integral of the samples over the sphere before they were scaled.
  [[nodiscard]] double integral() const { return integral_; }
  /// Values at s = i / (kNodes - 1) [1/sr].
  [[nodiscard]] const std::array<double, kNodes>& nodes() const { return node_; }

  /// Where a scattering angle lies among the nodes: s (kNodes - 1), in [0, kNodes - 1].
  /// @param cos_scattering  clamped to [-1, 1].
  [[nodiscard]] static double Position(double cos_scattering);
  /// Value [1/sr] at a position.
  [[nodiscard]] double At(double position) const;

  /// Mean of cos_scattering.
  [[nodiscard]] double mean_cosine() const { return mean_cosine_; }
  /// The cosine below which the share u of the light is scattered.
  [[nodiscard]] double Quantile(double u) const;

  /// Of the samples: 64 bits, FNV-1a.
  [[nodiscard]] std::uint64_t hash() const;

  bool operator==(const PhaseTable& other) const {
    return angle_deg_ == other.angle_deg_ && per_sr_ == other.per_sr_;
  }

 private:
  std::vector<double> angle_deg_, per_sr_;
  std::array<double, kNodes> node_{};
  std::array<double, kNodes> share_{};  // of light scattered by less than the node's angle
  double integral_ = 0.0;
  double mean_cosine_ = 0.0;
};

/// Phase functions at several wavelengths, all at the same angles.
struct SpectralPhase {
  std::vector<double> wavelength_nm;        // ascending
  std::vector<double> angle_deg;            // as PhaseTable wants them
  std::vector<std::vector<double>> per_sr;  // [wavelength][angle]

  /// The samples at a wavelength: linear between the two nearest, so that a mixture of two that are
  /// normalised is normalised; the end's beyond the ends.
  [[nodiscard]] PhaseTable At(double wavelength_nm) const;
};

/// From rows of a table, wavelength by wavelength, each with the same angles in the same order.
[[nodiscard]] SpectralPhase SpectralPhaseFromRows(std::span<const double> wavelength_nm,
                                                  std::span<const double> angle_deg,
                                                  std::span<const double> per_sr);

/// Reads a CSV with the columns wavelength_nm, angle_deg, phase_per_sr in any order and no others;
/// lines of '#' are passed over. Every wavelength must have the same angles. Throws InputError
/// "file:line: ..." or "file: ...".
[[nodiscard]] SpectralPhase ReadSpectralPhase(const std::filesystem::path& file);

}  // namespace alpenglow::atmosphere
