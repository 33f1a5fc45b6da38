// SPDX-License-Identifier: MIT
// The independent radiative-transfer cases that lie beside the repository (shared/cases), for the
// tests that are held against them. Without that folder those tests skip.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "atmosphere/error.h"
#include "atmosphere/medium.h"
#include "atmosphere/ray.h"

namespace alpenglow::stored {

using Row = std::map<std::string, std::string>;

inline std::filesystem::path Folder() {
  return std::filesystem::path(ALPENGLOW_SHARED_DIR) / "cases";
}
inline bool Available() { return std::filesystem::exists(Folder() / "paramsets.csv"); }

inline std::vector<std::string> Cells(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == ',') {
      cells.emplace_back();
    } else if (c != '\r') {
      cells.back() += c;
    }
  }
  return cells;
}

inline std::vector<Row> Read(const std::string& file) {
  std::ifstream in(Folder() / file);
  std::vector<Row> rows;
  std::vector<std::string> head;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    const std::vector<std::string> cells = Cells(line);
    if (head.empty()) {
      head = cells;
      continue;
    }
    Row row;
    for (std::size_t i = 0; i < head.size(); ++i) row[head[i]] = i < cells.size() ? cells[i] : "";
    rows.push_back(row);
  }
  return rows;
}

inline double Number(const Row& row, const std::string& key) { return std::stod(row.at(key)); }

/// The parameter sets by name, wavelengths ascending.
inline std::map<std::string, Medium> Media() {
  std::vector<Row> rows = Read("paramsets.csv");
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) {
    return Number(a, "lambda_nm") < Number(b, "lambda_nm");
  });
  std::map<std::string, Medium> media;
  for (const Row& row : rows) {
    Medium& medium = media[row.at("set")];
    medium.name = row.at("set");
    medium.follows_wgs84 = false;
    medium.planet_radius_m = Number(row, "Rg_m");
    medium.atmosphere_height_m = Number(row, "Rt_m") - Number(row, "Rg_m");
    medium.rayleigh_scale_height_m = Number(row, "HR_m");
    medium.mie_scale_height_m = Number(row, "HM_m");
    medium.ozone = {Number(row, "oz_lo_m"), Number(row, "oz_mid_m"), Number(row, "oz_hi_m")};
    medium.mie_phase.front() = {
        .kind = row.at("phase") == "CS" ? PhaseKind::kCornetteShanks : PhaseKind::kHenyeyGreenstein,
        .g = Number(row, "g")};
    medium.wavelengths_nm.push_back(Number(row, "lambda_nm"));
    medium.solar_irradiance.push_back(Number(row, "E0"));
    medium.ground_albedo.push_back(Number(row, "albedo"));
    medium.rayleigh_scattering_per_m.push_back(Number(row, "betaR"));
    medium.mie_scattering_per_m.push_back(Number(row, "betaMs"));
    medium.mie_extinction_per_m.push_back(Number(row, "betaMe"));
    medium.ozone_absorption_per_m.push_back(Number(row, "betaO"));
  }
  return media;
}

inline ViewRay RayOf(const Row& row) {
  ViewRay ray = RayFromAngles(Number(row, "h_m"), Number(row, "vza_deg"), Number(row, "raz_deg"),
                              Number(row, "sza_deg"));
  if (row.at("end") == "dist") ray.length_m = Number(row, "dist_m");
  return ray;
}

/// Result rows by case id.
inline std::map<std::string, std::vector<Row>> Results(const std::string& file) {
  std::map<std::string, std::vector<Row>> results;
  for (const Row& row : Read(file)) results[row.at("id")].push_back(row);
  return results;
}

/// The band of a medium that a result row belongs to.
inline std::size_t Band(const Medium& medium, const Row& row) {
  const double wavelength = Number(row, "lambda_nm");
  for (std::size_t band = 0; band < medium.wavelengths_nm.size(); ++band) {
    if (medium.wavelengths_nm[band] == wavelength) return band;
  }
  throw InternalError("stored result at a wavelength that its medium does not have");
}

}  // namespace alpenglow::stored
