// SPDX-License-Identifier: MIT
// Layers of pictures and panoramas that say how their light is polarised.
//
// Q is what vibrates along the picture's vertical more than across it, U what vibrates from the
// lower left to the upper right more than across that.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace alpenglow::lut {

enum class StokesLayer {
  kQ,             // stokes_q.R, .G, .B: linear sRGB [cd/m^2], of either sign
  kU,             // stokes_u.R, .G, .B
  kPolarisation,  // polarisation.degree and .angle, of luminance: DegreeAndAngle
};
inline constexpr std::array<StokesLayer, 3> kStokesLayers{StokesLayer::kQ, StokesLayer::kU,
                                                          StokesLayer::kPolarisation};

/// "stokes_q", "stokes_u", "polarisation"; throws InputError for another name.
[[nodiscard]] std::string NameOf(StokesLayer layer);
[[nodiscard]] StokesLayer StokesLayerFromName(const std::string& name);
/// Names of its channels, as in the EXR file.
[[nodiscard]] std::vector<std::string> ChannelsOf(StokesLayer layer);

/// Degree of linear polarisation in [0, 1], and the direction of vibration [degrees] clockwise from
/// the picture's vertical, in [-90, 90]; both 0 without light.
/// @param luminance, q, u  in one unit.
[[nodiscard]] std::array<float, 2> DegreeAndAngle(double luminance, double q, double u);

}  // namespace alpenglow::lut
