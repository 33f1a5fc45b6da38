// What mountain ground is made of, and relief finer than the mesh (surface.h). Lengths in metres:
// details of the ground are as fine as that.

// Three families of noise: two make the lines between materials waver, one is relief. Each is a sum
// of octaves, half as long and half as high from one to the next.
SHARED_CONSTANT int kBroadWave_m = 900;  // of the longest octave
SHARED_CONSTANT int kBroadOctaves = 5;
SHARED_CONSTANT Bits kBroadSeed = 11u;
SHARED_CONSTANT int kFineWave_m = 70;
SHARED_CONSTANT int kFineOctaves = 4;
SHARED_CONSTANT Bits kFineSeed = 29u;
SHARED_CONSTANT int kReliefWave_m = 220;
SHARED_CONSTANT int kReliefOctaves = 5;
SHARED_CONSTANT Bits kReliefSeed = 47u;
SHARED_CONSTANT int kReliefHeight_m = 14;

// What is kept of an octave where one ray of the picture is `footprint` wide: octaves shorter than
// two footprints fade out, so that distant ground does not glitter.
SHARED Number OctaveShare(Length wavelength, Length footprint) {
  return min(max(wavelength / (Number(2.0) * footprint) - Number(1.0), Number(0.0)), Number(1.0));
}

// 0 up to `low`, 1 from `high` on, smooth between.
SHARED Number SmoothRise(Number low, Number high, Number x) {
  Number t = min(max((x - low) / (high - low), Number(0.0)), Number(1.0));
  return t * t * (Number(3.0) - Number(2.0) * t);
}

// Altitude and vertical component of the normal, as the lines between materials take them.
SHARED Length WaveringAltitude(Length altitude, Number broad, Number fine) {
  return altitude + Length(260.0) * broad + Length(60.0) * fine;
}

SHARED Number WaveringLevel(Number normal_up, Number broad, Number fine) {
  return normal_up + Number(0.05) * broad + Number(0.05) * fine;
}

// Rises of 0 to 1 with the wavering altitude: no trees left; bare of grass; cold enough for snow,
// which gentle ground keeps 150 m below its line.
SHARED Number TreelessRise(Length altitude, Length tree_line) {
  return SmoothRise(tree_line - Length(250.0), tree_line - Length(50.0), altitude);
}

SHARED Number BareRise(Length altitude, Length tree_line) {
  return SmoothRise(tree_line - Length(50.0), tree_line + Length(450.0), altitude);
}

SHARED Number ColdRise(Length altitude, Length snow_line) {
  return SmoothRise(snow_line - Length(150.0), snow_line + Length(250.0), altitude);
}

// With the wavering level: not too steep for soil; flat, a meadow rather than a wood; and not so
// steep, over about 45 degrees, that it sheds its snow.
SHARED Number SoilRise(Number level) { return SmoothRise(Number(0.66), Number(0.78), level); }

SHARED Number FlatRise(Number level) { return SmoothRise(Number(0.95), Number(0.985), level); }

SHARED Number SnowHoldRise(Number level) { return SmoothRise(Number(0.60), Number(0.76), level); }

// Share of wood in what is green.
SHARED Number ForestShare(Number treeless, Number flat_ground) {
  return (Number(1.0) - treeless) * (Number(0.35) + Number(0.65) * (Number(1.0) - flat_ground));
}

// Share of rock and scree in ground without snow.
SHARED Number RockShare(Number bare, Number soil) { return max(bare, Number(1.0) - soil); }

// Lightness of patches of the ground, as a share of its albedo.
SHARED Number GroundTone(Number broad, Number fine) {
  return min(max(Number(0.3) * fine + Number(0.15) * broad, Number(-0.5)), Number(0.5));
}

SHARED Number PartlyCovered(Number below, Number cover, Number share) {
  return below + share * (cover - below);
}

// What is seen of the snow on the ground: a closed wood of conifers hides most of it (Betts, Ball
// 1997, J. Geophys. Res. 102, 28901: albedo 0.13 of such a wood over snow, 0.75 of grass under it).
SHARED Number SnowSeen(Number snow_share, Number forest, Number rock_share) {
  return snow_share * (Number(1.0) - Number(0.88) * forest * (Number(1.0) - rock_share));
}

// Albedo in a band, from those of the materials. Fresh snow is even, ground is not.
SHARED Number CoverAlbedo(Number green, Number rock, Number snow, Number rock_share,
                          Number snow_share, Number tone) {
  Number albedo = PartlyCovered(PartlyCovered(green, rock, rock_share), snow, snow_share);
  return min(albedo * (Number(1.0) + (Number(1.0) - snow_share) * tone), Number(1.0));
}
