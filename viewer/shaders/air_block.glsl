// SPDX-License-Identifier: MIT
// What the air is made of, and the sun above it: AirBlock of uniform_blocks.h. Vectors of four hold
// one value a band; lengths are kilometres.
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
  vec4 ozone_layer;  // bottom, peak, top; 1 where it is smooth, 0 where it is a tent
  vec4 mie_options;  // kind of the phase function; largest extinction at altitude 0, per km;
                     // number of different phase functions: 1, or one a band
  vec4 deficit;      // of molecules near the ground: share, scale height
  vec4 mie_phase[4];  // of each band: g, g of the second lobe, its weight, alpha
};

// Of an aerosol that is tabulated: the bands at (theta / pi)^(1/3) = i / 1023 (phase_table.h).
layout(std140) uniform PhaseTable { vec4 phase_table[1024]; };

#define RADIUS shell.x
#define TOP shell.y
#define RAYLEIGH_HEIGHT shell.z
#define MIE_HEIGHT shell.w

float PhaseOfParameters(float cosine, vec4 phase) {
  int kind = int(mie_options.x + 0.5);  // PhaseKind of phase.h
  if (kind == 0) return PhaseRayleigh(cosine);
  if (kind == 1) return PhaseHenyeyGreenstein(cosine, phase.x);
  if (kind == 2) return PhaseDoubleHenyeyGreenstein(cosine, phase.x, phase.y, phase.z);
  if (kind == 3) return PhaseCornetteShanks(cosine, phase.x);
  if (kind == 4) return PhaseSchlick(cosine, phase.x);
  if (kind == 5) return PhaseDraine(cosine, phase.x, phase.w);
  return PhaseHenyeyGreensteinDraine(cosine, phase.x, phase.y, phase.z, phase.w);
}

vec4 PhaseOfTable(float cosine) {
  float c = PhaseClampedCosine(cosine);
  float angle = atan(sqrt((1.0 - c) * (1.0 + c)), c);  // acos() of some drivers is good to 1e-3
  float position = 1023.0 * pow(max(angle, 1e-12) * 0.318309886, 0.333333333);
  int cell = min(int(position), 1022);
  return mix(phase_table[cell], phase_table[cell + 1], position - float(cell));
}

// The aerosol's phase function in every band.
vec4 PhaseMie(float cosine) {
  if (mie_options.x > 6.5) return PhaseOfTable(cosine);
  vec4 value = vec4(PhaseOfParameters(cosine, mie_phase[0]));
  if (mie_options.z < 1.5) return value;
  value.y = PhaseOfParameters(cosine, mie_phase[1]);
  value.z = PhaseOfParameters(cosine, mie_phase[2]);
  value.w = PhaseOfParameters(cosine, mie_phase[3]);
  return value;
}

float OzoneColumnUp(float h, float mu) {
  if (ozone_layer.w > 0.5) return SmoothOzoneColumnUp(h, mu, ozone_layer.z, RADIUS);
  return TentColumnUp(h, mu, ozone_layer.x, ozone_layer.y, ozone_layer.z, RADIUS);
}

// Columns of molecules, aerosol and ozone [km] from altitude h upwards along mu >= 0 to space.
vec3 ColumnsUp(float h, float mu) {
  float molecules = (1.0 + deficit.x) * ExponentialColumnUp(h, mu, RAYLEIGH_HEIGHT, TOP, RADIUS);
  if (deficit.x > 0.0) molecules -= DeficitColumnUp(h, mu, deficit.x, deficit.y, RADIUS);
  return vec3(molecules, ExponentialColumnUp(h, mu, MIE_HEIGHT, TOP, RADIUS), OzoneColumnUp(h, mu));
}

// Columns of the whole line through its lowest point. Below the ground nobody uses them: they only
// have to be finite.
vec3 ColumnsFromPerigee(float h, float mu) {
  return ColumnsUp(max(PerigeeAltitude(h, mu, RADIUS), -1.0), 0.0);
}

// Columns towards a sun that the ground does not hide.
vec3 ColumnsToSun(float h, float mu_s) {
  vec3 up = ColumnsUp(h, abs(mu_s));
  if (mu_s >= 0.0) return up;
  return max(2.0 * ColumnsFromPerigee(h, mu_s) - up, vec3(0.0));
}

// Columns between the origin of a ray and a point on it,
// from the upward columns at both and at the perigee.
vec3 ColumnsBetween(float mu_origin, float mu_point, vec3 origin, vec3 point, vec3 perigee) {
  return vec3(ColumnBetween(mu_origin, mu_point, origin.x, point.x, perigee.x),
              ColumnBetween(mu_origin, mu_point, origin.y, point.y, perigee.y),
              ColumnBetween(mu_origin, mu_point, origin.z, point.z, perigee.z));
}

vec4 OpticalDepth(vec3 columns) {
  return rayleigh_scattering * columns.x + mie_extinction * columns.y +
         ozone_absorption * columns.z;
}

vec3 LinearSrgb(vec4 radiance) {
  return vec3(dot(red_from_bands, radiance), dot(green_from_bands, radiance),
              dot(blue_from_bands, radiance));
}
