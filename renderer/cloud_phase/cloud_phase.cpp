// SPDX-License-Identifier: MIT
#include "renderer/cloud_phase/cloud_phase.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "atmosphere/base/csv.h"
#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"
#include "renderer/embedded_text.h"

namespace alpenglow::renderer {

CloudPhases::CloudPhases(PhaseFunction phase)
    : CloudPhases(std::vector<double>{1.0}, std::vector<PhaseFunction>{std::move(phase)}) {}

CloudPhases::CloudPhases(std::vector<double> radius_um, std::vector<PhaseFunction> phase)
    : log_radius_(std::move(radius_um)), phase_(std::move(phase)) {
  if (phase_.empty() || phase_.size() != log_radius_.size()) {
    throw InputError("phase functions of clouds: there must be one for each effective radius");
  }
  for (std::size_t i = 0; i < log_radius_.size(); ++i) {
    if (!(log_radius_[i] > (i == 0 ? 0.0 : std::exp(log_radius_[i - 1])))) {
      throw InputError("phase functions of clouds: effective radii must be positive and ascending");
    }
    log_radius_[i] = std::log(log_radius_[i]);
  }
  for (const PhaseFunction& each : phase_) Validate(each, "clouds.phase");
}

CloudPhases::Neighbours CloudPhases::Around(double radius_um) const {
  if (!depends_on_radius()) return {0, 0, 0.0};
  const double at = std::log(radius_um);
  const auto above = std::upper_bound(log_radius_.begin() + 1, log_radius_.end() - 1, at);
  const auto second = static_cast<std::size_t>(above - log_radius_.begin());
  const double weight =
      (at - log_radius_[second - 1]) / (log_radius_[second] - log_radius_[second - 1]);
  return {second - 1, second, std::clamp(weight, 0.0, 1.0)};
}

const PhaseFunction& CloudPhases::Drawn(double radius_um, double u) const {
  const Neighbours around = Around(radius_um);
  return phase_[u < around.weight ? around.second : around.first];
}

double CloudPhases::Value(double radius_um, double cos_scattering) const {
  const Neighbours around = Around(radius_um);
  return std::lerp(Phase(phase_[around.first], cos_scattering),
                   Phase(phase_[around.second], cos_scattering), around.weight);
}

std::vector<std::vector<double>> PhaseColumns(std::string_view file, std::size_t columns) {
  std::vector<std::vector<double>> read(columns);
  atmosphere::VisitCsvRows(renderer::EmbeddedText(file), [&](const atmosphere::CsvRecord& row) {
    for (std::size_t i = 0; i < columns; ++i) {
      const std::optional<double> number = ParseNumber(row.fields.at(i));
      if (!number) throw InternalError(std::string(file) + " is not a table of numbers");
      read[i].push_back(*number);
    }
  });
  return read;
}

}  // namespace alpenglow::renderer
