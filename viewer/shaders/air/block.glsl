// SPDX-License-Identifier: MIT
// Optical properties of the medium: AirBlock of pass_setup.h. Vectors of four hold one value
// per band. Lengths are in kilometres.
layout(std140) uniform Air {
  vec4 rayleigh_scattering;  // per km at altitude 0
  vec4 mie_scattering;
  vec4 mie_extinction;
  vec4 ozone_absorption;  // per km at the peak of the layer
  vec4 ground_albedo;
  vec4 red_from_bands;  // rows of the matrix to linear sRGB [cd m^-2 per W m^-2 sr^-1 nm^-1]
  vec4 green_from_bands;
  vec4 blue_from_bands;
  vec4 shell;        // radius of the planet, top of the air, scale heights of molecules and aerosol
  vec4 ozone_layer;  // bottom, peak, top; fourth: 1 for the smooth shape, 0 for the tent
  vec4 deficit;      // deficit of molecules near the ground: fraction, scale height
  vec4 wavelengths;  // [um]
};

#define RADIUS shell.x
#define TOP shell.y
#define RAYLEIGH_HEIGHT shell.z
#define MIE_HEIGHT shell.w

float OzoneColumnUp(float h, float mu) {
  if (ozone_layer.w > 0.5) return SmoothOzoneColumnUp(h, mu, ozone_layer.z, RADIUS);
  return TentColumnUp(h, mu, ozone_layer.x, ozone_layer.y, ozone_layer.z, RADIUS);
}

// Returns the columns of molecules, aerosol and ozone [km] from altitude h along mu >= 0 to space.
vec3 ColumnsUp(float h, float mu) {
  float molecules = (1.0 + deficit.x) * ExponentialColumnUp(h, mu, RAYLEIGH_HEIGHT, TOP, RADIUS);
  if (deficit.x > 0.0) molecules -= DeficitColumnUp(h, mu, deficit.x, deficit.y, RADIUS);
  return vec3(molecules, ExponentialColumnUp(h, mu, MIE_HEIGHT, TOP, RADIUS), OzoneColumnUp(h, mu));
}

// Returns the columns from the lowest point of the line to space. Below the ground they are not
// used and only have to be finite.
vec3 ColumnsFromPerigee(float h, float mu) {
  return ColumnsUp(max(PerigeeAltitude(h, mu, RADIUS), -1.0), 0.0);
}

// Returns the columns towards a sun that the ground does not hide.
vec3 ColumnsToSun(float h, float mu_s) {
  vec3 up = ColumnsUp(h, abs(mu_s));
  if (mu_s >= 0.0) return up;
  return max(2.0 * ColumnsFromPerigee(h, mu_s) - up, vec3(0.0));
}

vec4 OpticalDepth(vec3 columns) {
  return rayleigh_scattering * columns.x + mie_extinction * columns.y +
         ozone_absorption * columns.z;
}

vec3 LinearSrgb(vec4 radiance) {
  return vec3(dot(red_from_bands, radiance), dot(green_from_bands, radiance),
              dot(blue_from_bands, radiance));
}
