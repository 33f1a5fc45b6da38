// SPDX-License-Identifier: MIT
// Albedo of the ground around the eye, and relief finer than the mesh: GroundBlock of
// pass_setup.h, with the functions of ground_cover.glsl and lattice_noise.glsl.
//
// Positions are in metres from the eye along the axes of the pattern (ground_pattern.h). The eye's
// position is given as a cell of a lattice and a fraction of it, so that floats suffice for places
// thousands of kilometres from the origin of the pattern.
#define BROAD 0
#define FINE 1
#define RELIEF 2
#define GRAIN 3
#define WAVES 4

layout(std140) uniform Ground {
  vec4 conifers;
  vec4 leaves;
  vec4 yellow_leaves;
  vec4 bare_trees;
  vec4 meadow;
  vec4 dry_meadow;
  vec4 rock;
  vec4 snow;
  vec4 cover_lines;      // tree line, snow line [m]; number of finest octaves that are omitted
                         // to save time; extent to which the sun is in the south
  vec4 green_lines;      // lines of leaves, bare trees, grass and broad-leaved woods [m]
  ivec4 noise_cell[4];   // of the eye in the longest octave (NoiseOctave) of BROAD to GRAIN: cell to
                         // the east and north, without the shift by the lean
  vec4 noise_place[4];   // fraction of the cell; height of the eye over the pattern's plane [cells]
  ivec4 wave_cell[14];   // of the eye in the octaves of WAVES, east and north
  vec4 wave_place[14];   // fraction of the cell
  vec4 pattern_east;     // axes of the pattern in the frame of the eye
  vec4 pattern_north;
  vec4 pattern_up;
  vec4 pole;             // direction of the north pole in the frame of the eye
};

ivec4 NoiseOf(int family) {  // longest wave [m], octaves, seed, fall
  if (family == BROAD) return ivec4(kBroadWave_m, kBroadOctaves, kBroadSeed, kBroadFall);
  if (family == FINE) return ivec4(kFineWave_m, kFineOctaves, kFineSeed, kFineFall);
  if (family == GRAIN) return ivec4(kGrainWave_m, kGrainOctaves, kGrainSeed, kGrainFall);
  if (family == WAVES) return ivec4(kWaveWave_m, kWaveOctaves, kWaveSeed, kWaveFall);
  return ivec4(kReliefWave_m, kReliefOctaves, kReliefSeed, kReliefFall);
}

// A position in a cell of the lattice, and the hashes of the cell's corners.
struct NoiseCell {
  vec2 place;
  uint sw, se, nw, ne;
};

// @param place  relative to `cell`, in cells; may lie beyond it.
NoiseCell NoiseCellAt(ivec2 cell, vec2 place, uint seed) {
  vec2 whole = floor(place);
  uvec2 at = uvec2(cell + ivec2(whole));
  return NoiseCell(place - whole, LatticePoint(at.x, at.y, seed),
                   LatticePoint(at.x + 1u, at.y, seed), LatticePoint(at.x, at.y + 1u, seed),
                   LatticePoint(at.x + 1u, at.y + 1u, seed));
}

// A point in an octave that leans. Every value follows from that of the next longer octave: software
// drivers load an element of a uniform array, selected by a loop, for each pixel on its own.
struct Octave {
  ivec2 cell;  // of the eye
  vec2 place;  // from that cell, without the shift by the lean [cells]
  float rise;  // over the plane of the pattern [cells]
  vec2 lean;   // shift to the east and north per height
  float wavelength;
};

Octave LongestOctave(vec3 offset, int family) {
  float wavelength = float(NoiseOf(family).x);
  vec4 eye_at = noise_place[family];
  return Octave(noise_cell[family].xy, eye_at.xy + offset.xy / wavelength,
                eye_at.z + offset.z / wavelength, vec2(0.01 * float(kLean_percent), 0.0), wavelength);
}

// Returns the octave with half the wavelength.
Octave NextOctave(Octave o) {
  return Octave(2 * o.cell, 2.0 * o.place, 2.0 * o.rise,
                vec2(NextLeanEast(o.lean.x, o.lean.y), NextLeanNorth(o.lean.x, o.lean.y)),
                0.5 * o.wavelength);
}

NoiseCell CellIn(Octave o, uint seed) {
  return NoiseCellAt(o.cell, o.place + o.rise * o.lean, seed);
}

vec2 SlopeOf(NoiseCell c) {
  return vec2(SlopeOfHashesEast(c.sw, c.se, c.nw, c.ne, c.place.x, c.place.y),
              SlopeOfHashesNorth(c.sw, c.se, c.nw, c.ne, c.place.x, c.place.y));
}

// Returns the number of octaves to sum. For waves of two footprints and shorter, OctaveShare is 0.
int OctavesKept(ivec4 of, float footprint) {
  float kept = ceil(log2(max(float(of.x) / (2.0 * footprint), 1.0)));
  return min(of.y, int(kept));
}

// Returns the footprint for the finest detail, upscaled for the omitted octaves.
float DetailFootprint(float footprint) { return footprint * exp2(cover_lines.z); }

// Returns the sum of the octaves that a footprint resolves.
float DetailNoise(vec3 offset, int family, float footprint) {
  ivec4 of = NoiseOf(family);
  int octaves = OctavesKept(of, footprint);
  float sum = 0.0;
  float amplitude = 1.0;
  Octave at = LongestOctave(offset, family);
  for (int octave = 0; octave < octaves; ++octave) {
    NoiseCell c = CellIn(at, uint(of.z + octave));
    sum += OctaveShare(at.wavelength, footprint) * amplitude *
           NoiseOfHashes(c.sw, c.se, c.nw, c.ne, c.place.x, c.place.y);
    amplitude /= float(of.w);
    at = NextOctave(at);
  }
  return sum;
}

// Returns the derivatives of DetailNoise to the east, north and upwards [1/m].
vec3 DetailSlope(vec3 offset, int family, float footprint) {
  ivec4 of = NoiseOf(family);
  int octaves = OctavesKept(of, footprint);
  vec3 sum = vec3(0.0);
  float amplitude = 1.0;
  Octave at = LongestOctave(offset, family);
  for (int octave = 0; octave < octaves; ++octave) {
    vec2 slope = SlopeOf(CellIn(at, uint(of.z + octave)));
    sum += OctaveShare(at.wavelength, footprint) * (amplitude / at.wavelength) *
           vec3(slope, dot(slope, at.lean));
    amplitude /= float(of.w);
    at = NextOctave(at);
  }
  return sum;
}

// Returns the albedo of the ground.
// @param altitude  [m].
// @param tilt  components of the mesh's normal upwards and to the north.
// @param mapped  fractions of a land-cover map; fourth: 1 if there is a map, else 0.
vec4 GroundAlbedo(vec3 offset, float altitude, vec2 tilt, float footprint, vec4 mapped) {
  float width = DetailFootprint(footprint);
  float broad = DetailNoise(offset, BROAD, width);
  float fine = DetailNoise(offset, FINE, width);
  float grain = DetailNoise(offset, GRAIN, width);
  float wavering = WaveringAltitude(altitude, broad, fine);
  float wood = ForestShare(TreelessRise(wavering, cover_lines.x), FlatRise(tilt.x), broad, fine);
  wood = PartlyCovered(wood, mapped.x, mapped.w);
  float bare = PartlyCovered(BareRise(wavering, cover_lines.x), mapped.y, mapped.w);
  float stone = RockShare(bare, PartlyCovered(SoilRise(tilt.x), 1.0, mapped.w));
  float broadleaf = BroadleafShare(wavering, green_lines.w, broad, fine);
  float in_leaf = LeafShare(wavering, green_lines.x);
  float not_bare = LeafShare(wavering, green_lines.y);
  float grass = LeafShare(wavering, green_lines.z);
  float gap = CanopyGap(broadleaf * (1.0 - not_bare), broad, fine, grain);
  float snow_line = cover_lines.y + SunnySide(-cover_lines.w * tilt.y);
  float lying = ColdRise(SnowAltitude(altitude, broad), snow_line) * SnowHoldRise(tilt.x);
  float white = max(SnowSeen(lying, wood, stone, gap), mapped.z * mapped.w);
  float tone = GroundTone(broad, fine, grain, wood, stone);
  vec4 albedo;
  for (int band = 0; band < 4; ++band) {
    float trees = BroadleafAlbedo(bare_trees[band], yellow_leaves[band], leaves[band], not_bare,
                                  in_leaf);
    float green = GreenAlbedo(PartlyCovered(dry_meadow[band], meadow[band], grass), conifers[band],
                              trees, wood, broadleaf);
    albedo[band] = CoverAlbedo(green, rock[band], snow[band], stone, white, tone);
  }
  return albedo;
}

// Returns the normal including the relief that the mesh does not have.
vec3 DetailedNormal(vec3 offset, vec3 normal, float footprint) {
  vec3 slope = float(kReliefHeight_m) * DetailSlope(offset, RELIEF, DetailFootprint(footprint));
  vec3 tilt =
      -slope.x * pattern_east.xyz - slope.y * pattern_north.xyz - slope.z * pattern_up.xyz;
  return normalize(normal + tilt - dot(tilt, normal) * normal);
}

// Returns the slopes to the east and north of the waves that a footprint resolves, and the slope
// variance of the other waves: WavesAt of surface.h.
// @param variance  of all waves.
// @param cosine  of the angle between the vertical and the eye.
vec3 WavesAt(vec3 offset, float footprint, float variance, float cosine) {
  float width = DetailFootprint(footprint);
  ivec4 of = NoiseOf(WAVES);
  int octaves = OctavesKept(of, width);
  float longest = LongestWave(variance);
  float each = WaveOctaveVariance(variance, longest);
  float shown = WaveShown(max(cosine, 0.0), variance);
  vec3 waves = vec3(0.0, 0.0, variance);
  float wavelength = float(of.x);
  for (int octave = 0; octave < octaves; ++octave) {
    float kept = shown * OctaveShare(wavelength, width) * WaveRaised(wavelength, longest);
    if (kept > 0.0) {
      NoiseCell c = NoiseCellAt(wave_cell[octave].xy, wave_place[octave].xy + offset.xy / wavelength,
                                uint(of.z + octave));
      waves.xy += kept * WaveSlope(each) * SlopeOf(c);
      waves.z -= kept * kept * each;
    }
    wavelength *= 0.5;
  }
  return waves;
}
