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

float GradientDot(ivec2 cell, vec2 offset, uint seed) {
  uint hash = Mixed(uint(cell.x) + Mixed(uint(cell.y) + Mixed(seed + 0x9e3779b9u)));
  vec2 gradient = vec2(float(hash & 0xffffu), float(hash >> 16)) / 32768.0 - 1.0;
  return dot(gradient, offset);
}

// @param place  within and beyond `cell`, in cells.
float GradientNoise(ivec2 cell, vec2 place, uint seed) {
  vec2 whole = floor(place);
  vec2 d = place - whole;
  ivec2 at = cell + ivec2(whole);
  vec2 fade = d * d * d * (d * (d * 6.0 - 15.0) + 10.0);
  float south = mix(GradientDot(at, d, seed),
                    GradientDot(at + ivec2(1, 0), d - vec2(1.0, 0.0), seed), fade.x);
  float north = mix(GradientDot(at + ivec2(0, 1), d - vec2(0.0, 1.0), seed),
                    GradientDot(at + ivec2(1, 1), d - vec2(1.0, 1.0), seed), fade.x);
  return mix(south, north, fade.y);
}

// Sum of octaves, each half as long and half as high; those shorter than two footprints fade out.
float DetailNoise(vec2 offset, int family, int octaves, uint seed, float footprint) {
  float sum = 0.0;
  float amplitude = 1.0;
  float wavelength = noise_cell[family].z;
  int cells = 1;
  for (int octave = 0; octave < octaves; ++octave) {
    float kept = clamp(wavelength / (2.0 * footprint) - 1.0, 0.0, 1.0);
    if (kept == 0.0) break;
    vec2 place = noise_place[family].xy * float(cells) + offset / wavelength;
    sum += kept * amplitude *
           GradientNoise(ivec2(noise_cell[family].xy) * cells, place, seed + uint(octave));
    amplitude *= 0.5;
    wavelength *= 0.5;
    cells *= 2;
  }
  return sum;
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

float ReliefHeight(vec2 offset, float footprint) {
  return 14.0 * DetailNoise(offset, RELIEF, 5, 47u, footprint);
}

// The normal with the relief that the mesh does not have.
vec3 DetailedNormal(vec2 offset, vec3 normal, float footprint) {
  if (cover_lines.z == 0.0) return normal;
  float reach = max(1.0, 0.25 * footprint);
  float here = ReliefHeight(offset, footprint);
  float east = (here - ReliefHeight(offset + vec2(reach, 0.0), footprint)) / reach;
  float north = (here - ReliefHeight(offset + vec2(0.0, reach), footprint)) / reach;
  vec3 tilt = east * mesh_east.xyz + north * mesh_north.xyz;
  return normalize(normal + tilt * max(dot(normal, mesh_up.xyz), 0.0));
}
