// SPDX-License-Identifier: MIT
// Tabulated phase functions: measured or computed values at angles.
//
//   s = (theta / pi)^(1/3)
//
// The samples are joined by cubics in (theta, log p): positive, with the slopes of parabolas
// through three neighbours, and with slope 0 at 0 and 180 degrees, where symmetry requires it. This
// curve is evaluated at kNodes uniform s, so that a forward peak a hundredth of a degree wide has
// as many nodes as the rest, and scaled to an integral of 1. From then on the phase function is the
// piecewise linear function of s through the nodes: values, moments and samples belong to the same
// function, on the CPU and on the GPU.
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
  /// Number of nodes: as many vec4 as every OpenGL implementation allows in one uniform block.
  static constexpr std::size_t kNodes = 1024;
  /// Samples whose integral over the sphere deviates from 1 by more than this are rejected: they
  /// have another normalisation, or are too few to interpolate. (Those of OPAC are up to 1.0 %
  /// below 1.)
  static constexpr double kLargestDeviation = 0.02;

  /// Throws InputError that starts with "phase: " and describes the fault.
  /// @param angle_deg  scattering angles, strictly ascending from 0 to 180, at least 5.
  /// @param per_sr  values there [1/sr], > 0, integral over the sphere 1 within kLargestDeviation.
  PhaseTable(std::vector<double> angle_deg, std::vector<double> per_sr);

  [[nodiscard]] const std::vector<double>& angle_deg() const { return angle_deg_; }
  [[nodiscard]] const std::vector<double>& per_sr() const { return per_sr_; }
  /// Returns the integral of the samples over the sphere before they were scaled.
  [[nodiscard]] double integral() const { return integral_; }
  /// Returns the values at s = i / (kNodes - 1) [1/sr].
  [[nodiscard]] const std::array<double, kNodes>& nodes() const { return node_; }

  /// Returns the position of a scattering angle among the nodes: s (kNodes - 1), in
  /// [0, kNodes - 1].
  /// @param cos_scattering  clamped to [-1, 1].
  [[nodiscard]] static double Position(double cos_scattering);
  /// Returns the value [1/sr] at a position.
  [[nodiscard]] double At(double position) const;

  /// Returns the mean of cos_scattering.
  [[nodiscard]] double mean_cosine() const { return mean_cosine_; }
  /// Returns the cosine below which the fraction u of the light is scattered.
  [[nodiscard]] double Quantile(double u) const;

  /// Returns the hash of the samples: 64 bits, FNV-1a.
  [[nodiscard]] std::uint64_t hash() const;

  bool operator==(const PhaseTable& other) const {
    return angle_deg_ == other.angle_deg_ && per_sr_ == other.per_sr_;
  }

 private:
  std::vector<double> angle_deg_, per_sr_;
  std::array<double, kNodes> node_{};
  std::array<double, kNodes> share_{};  // fraction of light scattered by less than the node's angle
  double integral_ = 0.0;
  double mean_cosine_ = 0.0;
};

/// Phase functions at several wavelengths, all at the same angles.
struct SpectralPhase {
  std::vector<double> wavelength_nm;        // ascending
  std::vector<double> angle_deg;            // as PhaseTable requires
  std::vector<std::vector<double>> per_sr;  // [wavelength][angle]

  /// Returns the samples at a wavelength: linear between the two nearest, so that the mixture of
  /// two normalised functions is normalised; constant beyond the ends.
  [[nodiscard]] PhaseTable At(double wavelength_nm) const;
};

/// Builds the phase functions from rows of a table, wavelength by wavelength, each with the same
/// angles in the same order.
[[nodiscard]] SpectralPhase SpectralPhaseFromRows(std::span<const double> wavelength_nm,
                                                  std::span<const double> angle_deg,
                                                  std::span<const double> per_sr);

/// Reads a CSV with the columns wavelength_nm, angle_deg, phase_per_sr in any order and no others;
/// lines that start with '#' are skipped. Every wavelength must have the same angles. Throws
/// InputError "file:line: ..." or "file: ...".
[[nodiscard]] SpectralPhase ReadSpectralPhase(const std::filesystem::path& file);

}  // namespace alpenglow::atmosphere
