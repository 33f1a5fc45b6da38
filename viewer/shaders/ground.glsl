// SPDX-License-Identifier: MIT
// What the ground is made of, and relief finer than the mesh, around the eye: what GroundBlock of
// uniform_blocks.h says of it, put into ground_cover.glsl and lattice_noise.glsl.
//
// Places are metres from the eye along the east and north axes of the mesh. Of every family of
// noise the eye's own place comes as lattice cell and fraction of the longest octave, so that float
// holds places thousands of kilometres from the origin of the pattern.
#define BROAD 0
#define FINE 1
#define RELIEF 2

layout(std140) uniform Ground {
  vec4 forest;
  vec4 meadow;
  vec4 rock;
  vec4 snow;
  vec4 cover_lines;     // tree line, snow line [m]; 1 with relief finer than the mesh, else 0
  vec4 noise_cell[3];   // of the eye, east and north: by family
  vec4 noise_place[3];  // fraction of the cell, east and north
  vec4 mesh_east;       // axes of the mesh in the frame of the eye
  vec4 mesh_north;
  vec4 mesh_up;
};

ivec4 NoiseOf(int family) {  // longest wave [m], octaves, seed
  if (family == BROAD) return ivec4(kBroadWave_m, kBroadOctaves, kBroadSeed, 0);
  if (family == FINE) return ivec4(kFineWave_m, kFineOctaves, kFineSeed, 0);
  return ivec4(kReliefWave_m, kReliefOctaves, kReliefSeed, 0);
}

// Noise and its derivatives to the east and north, per cell.
// @param place  within and beyond `cell`, in cells.
vec3 GradientNoiseSlope(ivec2 cell, vec2 place, uint seed) {
  vec2 whole = floor(place);
  vec2 d = place - whole;
  uvec2 at = uvec2(cell + ivec2(whole));
  uint sw = LatticePoint(at.x, at.y, seed);
  uint se = LatticePoint(at.x + 1u, at.y, seed);
  uint nw = LatticePoint(at.x, at.y + 1u, seed);
  uint ne = LatticePoint(at.x + 1u, at.y + 1u, seed);
  return vec3(NoiseInCell(sw, se, nw, ne, d.x, d.y), NoiseSlopeEast(sw, se, nw, ne, d.x, d.y),
              NoiseSlopeNorth(sw, se, nw, ne, d.x, d.y));
}

// The octaves that a footprint keeps, with their derivatives to the east and north [1/m].
vec3 DetailNoiseSlope(vec2 offset, int family, float footprint) {
  vec3 sum = vec3(0.0);
  ivec4 of = NoiseOf(family);
  float amplitude = 1.0;
  float wavelength = float(of.x);
  int cells = 1;
  for (int octave = 0; octave < of.y; ++octave) {
    float kept = OctaveShare(wavelength, footprint);
    if (kept == 0.0) break;
    vec2 place = noise_place[family].xy * float(cells) + offset / wavelength;
    vec3 noise =
        GradientNoiseSlope(ivec2(noise_cell[family].xy) * cells, place, uint(of.z + octave));
    sum += kept * amplitude * vec3(noise.x, noise.yz / wavelength);
    amplitude *= 0.5;
    wavelength *= 0.5;
    cells *= 2;
  }
  return sum;
}

// @param altitude [m]; normal_up of the mesh's normal.
vec4 GroundAlbedo(vec2 offset, float altitude, float normal_up, float footprint) {
  float broad = DetailNoiseSlope(offset, BROAD, footprint).x;
  float fine = DetailNoiseSlope(offset, FINE, footprint).x;
  float wavering = WaveringAltitude(altitude, broad, fine);
  float level = WaveringLevel(normal_up, broad, fine);
  float wood = ForestShare(TreelessRise(wavering, cover_lines.x), FlatRise(level));
  float stone = RockShare(BareRise(wavering, cover_lines.x), SoilRise(level));
  float white = ColdRise(wavering, cover_lines.y) * SnowHoldRise(level);
  float tone = GroundTone(broad, fine);
  vec4 albedo;
  for (int band = 0; band < 4; ++band) {
    float green = PartlyCovered(meadow[band], forest[band], wood);
    albedo[band] = CoverAlbedo(green, rock[band], snow[band], stone, white, tone);
  }
  return albedo;
}

// The normal with the relief that the mesh does not have.
vec3 DetailedNormal(vec2 offset, vec3 normal, float footprint) {
  if (cover_lines.z == 0.0) return normal;
  vec2 slope = float(kReliefHeight_m) * DetailNoiseSlope(offset, RELIEF, footprint).yz;
  vec3 tilt = -slope.x * mesh_east.xyz - slope.y * mesh_north.xyz;
  return normalize(normal + tilt * max(dot(normal, mesh_up.xyz), 0.0));
}
