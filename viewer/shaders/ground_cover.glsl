// SPDX-License-Identifier: MIT
// What the ground is made of, and relief finer than the mesh: the twin of MountainSurface
// (surface.h) and of GradientNoise (lattice_noise.h), on the same lattice.
//
// Places are metres from the eye along the east and north axes of the mesh. Of every family of
// noise the eye's own place comes as lattice cell and fraction of the longest octave, so that float
// holds places thousands of kilometres from the origin of the pattern.
#define BROAD 0   // 900 m and shorter
#define FINE 1    // 70 m and shorter
#define RELIEF 2  // 220 m and shorter

layout(std140) uniform Ground {
  vec4 forest;
  vec4 meadow;
  vec4 rock;
  vec4 snow;
  vec4 cover_lines;     // tree line, snow line [m]; 1 with relief finer than the mesh, else 0
  vec4 noise_cell[3];   // of the eye, east and north; wavelength [m]: by family
  vec4 noise_place[3];  // fraction of the cell, east and north
  vec4 mesh_east;       // axes of the mesh in the frame of the eye
  vec4 mesh_north;
  vec4 mesh_up;
};

uint Mixed(uint bits) {
  bits ^= bits >> 16;
  bits *= 0x85ebca6bu;
  bits ^= bits >> 13;
  bits *= 0xc2b2ae35u;
  bits ^= bits >> 16;
  return bits;
}

vec2 GradientAt(ivec2 cell, uint seed) {
  uint hash = Mixed(uint(cell.x) + Mixed(uint(cell.y) + Mixed(seed + 0x9e3779b9u)));
  return vec2(float(hash & 0xffffu), float(hash >> 16)) / 32768.0 - 1.0;
}

// Noise and its derivatives to the east and north, per cell.
// @param place  within and beyond `cell`, in cells.
vec3 GradientNoiseSlope(ivec2 cell, vec2 place, uint seed) {
  vec2 whole = floor(place);
  vec2 d = place - whole;
  ivec2 at = cell + ivec2(whole);
  vec2 fade = d * d * d * (d * (d * 6.0 - 15.0) + 10.0);
  vec2 fade_slope = 30.0 * d * d * (d - 1.0) * (d - 1.0);
  vec2 sw = GradientAt(at, seed);
  vec2 se = GradientAt(at + ivec2(1, 0), seed);
  vec2 nw = GradientAt(at + ivec2(0, 1), seed);
  vec2 ne = GradientAt(at + ivec2(1, 1), seed);
  float from_sw = dot(sw, d);
  float from_se = dot(se, d - vec2(1.0, 0.0));
  float from_nw = dot(nw, d - vec2(0.0, 1.0));
  float from_ne = dot(ne, d - vec2(1.0, 1.0));
  float south = mix(from_sw, from_se, fade.x);
  float north = mix(from_nw, from_ne, fade.x);
  vec2 slope = mix(mix(sw, se, fade.x), mix(nw, ne, fade.x), fade.y) +
               fade_slope * vec2(mix(from_se - from_sw, from_ne - from_nw, fade.y), north - south);
  return vec3(mix(south, north, fade.y), slope);
}

// Sum of octaves, each half as long and half as high; those shorter than two footprints fade out.
// With its derivatives to the east and north [1/m].
vec3 DetailNoiseSlope(vec2 offset, int family, int octaves, uint seed, float footprint) {
  vec3 sum = vec3(0.0);
  float amplitude = 1.0;
  float wavelength = noise_cell[family].z;
  int cells = 1;
  for (int octave = 0; octave < octaves; ++octave) {
    float kept = clamp(wavelength / (2.0 * footprint) - 1.0, 0.0, 1.0);
    if (kept == 0.0) break;
    vec2 place = noise_place[family].xy * float(cells) + offset / wavelength;
    vec3 noise =
        GradientNoiseSlope(ivec2(noise_cell[family].xy) * cells, place, seed + uint(octave));
    sum += kept * amplitude * vec3(noise.x, noise.yz / wavelength);
    amplitude *= 0.5;
    wavelength *= 0.5;
    cells *= 2;
  }
  return sum;
}

float DetailNoise(vec2 offset, int family, int octaves, uint seed, float footprint) {
  return DetailNoiseSlope(offset, family, octaves, seed, footprint).x;
}

// @param altitude [m]; normal_up of the mesh's normal.
vec4 GroundAlbedo(vec2 offset, float altitude, float normal_up, float footprint) {
  float broad = DetailNoise(offset, BROAD, 5, 11u, footprint);
  float fine = DetailNoise(offset, FINE, 4, 29u, footprint);
  float wavering = altitude + 260.0 * broad + 60.0 * fine;
  float level = normal_up + 0.05 * broad + 0.05 * fine;
  float bare = smoothstep(cover_lines.x - 50.0, cover_lines.x + 450.0, wavering);
  float steep = 1.0 - smoothstep(0.66, 0.78, level);
  float wooded = 1.0 - smoothstep(cover_lines.x - 250.0, cover_lines.x - 50.0, wavering);
  float sloping = 1.0 - smoothstep(0.95, 0.985, level);
  vec4 green = mix(meadow, forest, wooded * (0.35 + 0.65 * sloping));
  vec4 ground = mix(green, rock, max(bare, steep));
  float cold = smoothstep(cover_lines.y - 200.0, cover_lines.y + 350.0, wavering);
  float holds = smoothstep(0.60, 0.76, level);
  vec4 albedo = mix(ground, snow, cold * holds);
  float tone = clamp(0.3 * fine + 0.15 * broad, -0.5, 0.5);
  return min(albedo * (1.0 + (1.0 - cold * holds) * tone), vec4(1.0));
}

// The normal with the relief that the mesh does not have.
vec3 DetailedNormal(vec2 offset, vec3 normal, float footprint) {
  if (cover_lines.z == 0.0) return normal;
  vec2 slope = 14.0 * DetailNoiseSlope(offset, RELIEF, 5, 47u, footprint).yz;
  vec3 tilt = -slope.x * mesh_east.xyz - slope.y * mesh_north.xyz;
  return normalize(normal + tilt * max(dot(normal, mesh_up.xyz), 0.0));
}
