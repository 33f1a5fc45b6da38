// SPDX-License-Identifier: MIT
// An example of README.md: bakes the tables of an atmosphere, reads them back and looks values up.
#include <alpenglow/tables.h>

#include <cstdio>

int main(int argc, char** argv) {
  const std::filesystem::path folder = argc > 1 ? argv[1] : "tables";
  const alpenglow::Atmosphere earth;
  alpenglow::BakeTables(earth, folder, alpenglow::BakeQuality::kPreview);
  const alpenglow::Sky sky = alpenglow::ReadTables(folder, earth);  // refuses other atmospheres
  const alpenglow::Direction sun = alpenglow::DirectionFromAngles(10.0, 180.0);
  const alpenglow::LinearRgb south =
      earth.ColourOf(sky.Radiance({.up_m = 2.0}, {.north = -1.0, .up = 0.5}, sun));
  std::printf("luminance %.0f cd/m^2\n%s", alpenglow::Luminance(south),
              alpenglow::DescribeTables(folder).c_str());
  return alpenglow::Luminance(south) > 1000.0 ? 0 : 1;
}
