// SPDX-License-Identifier: MIT
// Classes of maps of land cover: those of ESA WorldCover (Zanaga et al. 2022, WorldCover 10 m 2021
// v200, doi 10.5281/zenodo.7254221, product user manual, table 3).
#pragma once

#include <array>
#include <optional>

namespace alpenglow::renderer {

/// What a class is made of, as ground_cover.glsl takes it: shares of wood, stone and lasting snow,
/// or the corners for water and for nothing known. Built-up land is half stone: gardens are between
/// the houses. Nothing for a number that is no class.
[[nodiscard]] std::optional<std::array<double, 3>> CoverOfClass(int number);

}  // namespace alpenglow::renderer
