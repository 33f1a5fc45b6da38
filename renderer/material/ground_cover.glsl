// Materials of mountain ground, and relief finer than the mesh (surface.h). Lengths are in metres,
// to suit the fine details of the ground.

// Families of noise: two make the lines between materials ragged, one is relief, one the grain of
// crowns and rocks, one the waves of water. Each is a sum of octaves; each octave has half the
// wavelength of the one before, and its amplitude is divided by the family's fall. Relief ends at
// waves of 7 m and grain at 1.5 m, parts of a crown: no terrain model is finer, and invented detail
// looks like felt from eye level.
SHARED_CONSTANT int kBroadWave_m = 900;  // of the longest octave
SHARED_CONSTANT int kBroadOctaves = 5;
SHARED_CONSTANT int kBroadFall = 2;
SHARED_CONSTANT Bits kBroadSeed = 11u;
SHARED_CONSTANT int kFineWave_m = 70;
SHARED_CONSTANT int kFineOctaves = 4;
SHARED_CONSTANT int kFineFall = 2;
SHARED_CONSTANT Bits kFineSeed = 29u;
SHARED_CONSTANT int kReliefWave_m = 220;
SHARED_CONSTANT int kReliefOctaves = 6;
SHARED_CONSTANT int kReliefFall = 2;
SHARED_CONSTANT Bits kReliefSeed = 47u;
SHARED_CONSTANT int kReliefHeight_m = 14;
SHARED_CONSTANT int kGrainWave_m = 12;  // size of crowns
SHARED_CONSTANT int kGrainOctaves = 4;
SHARED_CONSTANT int kGrainFall = 1;
SHARED_CONSTANT Bits kGrainSeed = 83u;

SHARED_CONSTANT int kWaveWave_m = 128;  // waves of a gale
SHARED_CONSTANT int kWaveOctaves = 14;
SHARED_CONSTANT int kWaveFall = 2;
SHARED_CONSTANT Bits kWaveSeed = 131u;

// Octaves of the noise on land lean (NoiseOctave of surface.h): their lattice shifts with height. Each
// lean is that of the next longer octave, turned by the golden angle, so that no two lean alike. The
// first is to the east.
SHARED_CONSTANT int kLean_percent = 60;  // shift per height
SHARED Number NextLeanEast(Number east, Number north) {
  return Number(-0.7373688780783197) * east - Number(0.6754902942615238) * north;
}
SHARED Number NextLeanNorth(Number east, Number north) {
  return Number(0.6754902942615238) * east - Number(0.7373688780783197) * north;
}

// Fraction of an octave that is kept if a camera ray is `footprint` wide: octaves shorter than two
// footprints fade out, so that distant ground does not alias.
SHARED Number OctaveShare(Length wavelength, Length footprint) {
  return min(max(wavelength / (Number(2.0) * footprint) - Number(1.0), Number(0.0)), Number(1.0));
}

// Footprint on water of a ray of a width that meets it at a cosine with the normal: the geometric
// mean of the footprint's width and depth.
SHARED Length SeenFootprint(Length across, Number cosine) {
  return across / sqrt(max(cosine, Number(0.04)));
}

// Footprint on land of such a ray: the depth of its width on the ground, plus the ground that
// plants and stones of 0.7 m hide behind them from a slanting ray. Without the second term, a flat
// pattern would be smeared into streaks at grazing angles.
SHARED Length LandFootprint(Length across, Number cosine) {
  Number mu = min(max(cosine, Number(0.1)), Number(1.0));
  return (across + Length(0.7) * sqrt(Number(1.0) - mu * mu)) / mu;
}

// Smooth step: 0 up to `low`, 1 from `high` on.
SHARED Number SmoothRise(Number low, Number high, Number x) {
  Number t = min(max((x - low) / (high - low), Number(0.0)), Number(1.0));
  return t * t * (Number(3.0) - Number(2.0) * t);
}

// Altitude with noise, used for the lines between materials.
SHARED Length WaveringAltitude(Length altitude, Number broad, Number fine) {
  return altitude + Length(260.0) * broad + Length(60.0) * fine;
}

// Altitude with noise for the snow line. It is smoother, so that snow fades in by height and not in
// spots.
SHARED Length SnowAltitude(Length altitude, Number broad) {
  return altitude + Length(260.0) * broad;
}

// Smooth steps from 0 to 1 with the noisy altitude: no trees; no grass; cold enough for snow, which
// gentle ground keeps 150 m below its line.
SHARED Number TreelessRise(Length altitude, Length tree_line) {
  return SmoothRise(tree_line - Length(250.0), tree_line - Length(50.0), altitude);
}

SHARED Number BareRise(Length altitude, Length tree_line) {
  return SmoothRise(tree_line - Length(50.0), tree_line + Length(450.0), altitude);
}

SHARED Number ColdRise(Length altitude, Length snow_line) {
  return SmoothRise(snow_line - Length(150.0), snow_line + Length(250.0), altitude);
}

// Smooth steps by the slope of the mesh alone. SoilRise: flat enough for soil, which woods hold up
// to about 50 degrees; steeper ground is rock. SnowHoldRise: flat enough to hold snow, up to about
// 45 degrees.
SHARED Number SoilRise(Number normal_up) {
  return SmoothRise(Number(0.59), Number(0.70), normal_up);
}

SHARED Number SnowHoldRise(Number normal_up) {
  return SmoothRise(Number(0.60), Number(0.76), normal_up);
}

// Land that is flat to 4 degrees is a meadow rather than a wood; up to 15 degrees some of it is.
SHARED Number FlatRise(Number normal_up) {
  return SmoothRise(Number(0.965), Number(0.998), normal_up);
}

// Fraction of wood in vegetation. Groves grow on flat ground and glades open in woods, with edges
// made ragged by the fine noise.
SHARED Number ForestShare(Number treeless, Number flat_ground, Number broad, Number fine) {
  Number density =
      Number(1.0) - Number(0.7) * flat_ground + Number(0.5) * broad + Number(0.4) * fine;
  return (Number(1.0) - treeless) * SmoothRise(Number(0.05), Number(0.75), density);
}

// Land cover of a map: shares of wood, stone and lasting snow; the rest is grass. Two impossible
// mixtures are codes: all wood and all stone means water, all stone and all snow means unknown.
// The functions return 1 for yes, 0 for no.
SHARED Number IsMappedWater(Number wood, Number stone) {
  return select(wood + stone > Number(1.5), Number(1.0), Number(0.0));
}

SHARED Number IsMapped(Number stone, Number snow) {
  return select(stone + snow < Number(1.5), Number(1.0), Number(0.0));
}

// Fraction of rock and scree in ground without snow: all of bare ground, and half of the ground
// below the tree line that is too steep for soil, because trees grow in its cracks.
SHARED Number RockShare(Number bare, Number soil) {
  return max(bare, (Number(1.0) - soil) * (Number(0.5) + Number(0.5) * bare));
}

// Relative change of the albedo in patches and grain: crowns and rocks differ from the gaps between
// them, while blades of grass are too fine to be visible.
SHARED Number GroundTone(Number broad, Number fine, Number grain, Number forest,
                         Number rock_share) {
  Number contrast = Number(0.6) * (forest + rock_share * (Number(1.0) - forest));
  Number tone = Number(0.2) * fine + Number(0.12) * broad + contrast * grain;
  return min(max(tone, Number(-0.6)), Number(0.8));
}

SHARED Number PartlyCovered(Number below, Number cover, Number share) {
  return below + share * (cover - below);
}

// Fraction of broad-leaved trees in a wood: all up to some 1000 m below a line, mixed stands up to
// the line, and conifers above.
SHARED Number BroadleafShare(Length altitude, Length line, Number broad, Number fine) {
  return Number(1.0) - SmoothRise(line - Length(1000.0), line + Length(300.0),
                                  altitude + Length(900.0) * broad + Length(500.0) * fine);
}

// Fraction in leaf, or green: below a line that climbs in spring and descends in autumn.
SHARED Number LeafShare(Length altitude, Length line) {
  return Number(1.0) - SmoothRise(line - Length(250.0), line + Length(250.0), altitude);
}

// Height of the snow line of a slope above that of level ground: 400 m times the component of the
// normal towards the sun's side, because shaded slopes keep snow for weeks longer.
SHARED Length SunnySide(Number normal_sunward) { return Length(400.0) * normal_sunward; }

// Fraction of the ground that is visible between the crowns of a wood: 0.12 for conifers and 0.2
// for broad-leaved trees without leaves. These give albedos of 0.13 and 0.21 over snow, where grass
// under it has 0.75 (Betts, Ball 1997, J. Geophys. Res. 102, 28901). The density of stands varies.
SHARED Number CanopyGap(Number leafless, Number broad, Number fine, Number grain) {
  Number gap = Number(0.12) + Number(0.08) * leafless;
  Number thinner = Number(0.5) * broad + Number(0.3) * fine + Number(0.2) * grain;
  return gap * min(max(Number(1.0) + thinner, Number(0.5)), Number(1.5));
}

// Fraction of the snow on the ground that is visible. Trees hide it like layers, by a power of
// their share (Monsi, Saeki 1953, Jap. J. Bot. 14, 22), so that a thin wood is nearly as dark as a
// dense one.
SHARED Number SnowSeen(Number snow_share, Number forest, Number rock_share, Number gap) {
  return snow_share * exp(log(gap) * forest * (Number(1.0) - rock_share));
}

// Albedo of vegetation, in a band. Trees pass through autumn yellow between green leaves and bare
// branches.
SHARED Number BroadleafAlbedo(Number bare, Number yellow, Number leaves, Number not_bare,
                              Number in_leaf) {
  return PartlyCovered(PartlyCovered(bare, yellow, not_bare), leaves, in_leaf);
}

SHARED Number GreenAlbedo(Number meadow, Number conifers, Number broadleaf, Number forest,
                          Number broadleaf_share) {
  return PartlyCovered(meadow, PartlyCovered(conifers, broadleaf, broadleaf_share), forest);
}

// Albedo in a band, mixed from those of the materials. Fresh snow is uniform; other ground varies
// by `tone`.
SHARED Number CoverAlbedo(Number green, Number rock, Number snow, Number rock_share,
                          Number snow_share, Number tone) {
  Number albedo = PartlyCovered(PartlyCovered(green, rock, rock_share), snow, snow_share);
  return min(albedo * (Number(1.0) + (Number(1.0) - snow_share) * tone), Number(1.0));
}

// Length of the longest waves that the wind raises, from the slope variance of Cox and Munk
// (reflectance.h): 0.83 s^2/m times the square of the wind speed, where the spectrum of Pierson,
// Moskowitz (1964), J. Geophys. Res. 69, 5181, has its peak.
SHARED Length LongestWave(Number variance) {
  Number wind = max(variance - Number(0.003), Number(0.0)) / Number(0.00512);
  return Length(0.83) * wind * wind;
}

// Slope variance of an octave: equal for all octaves from the longest wave to 1 mm, as in the
// saturated range of the spectrum (Phillips 1958, J. Fluid Mech. 4, 426).
SHARED Number WaveOctaveVariance(Number variance, Length longest) {
  return variance * Number(0.6931471805599453) /
         max(log(max(longest, Length(0.002)) / Length(0.001)), Number(0.6931471805599453));
}

// Fraction of an octave that the wind raises.
SHARED Number WaveRaised(Length wavelength, Length longest) {
  return min(max(Number(2.0) - wavelength / max(longest, Length(1e-6)), Number(0.0)), Number(1.0));
}

// Fraction of the slopes that is drawn for an eye at a cosine with the vertical. At grazing angles,
// where crests hide the water behind them, the statistical model of the glitter represents the
// waves, because it includes hiding.
SHARED Number WaveShown(Number cosine, Number variance) {
  return SmoothRise(Number(0.0), Number(0.7) * sqrt(variance), cosine);
}

// Slope of one octave. The gradient noise has a slope of 0.72 rms per cell.
SHARED Number WaveSlope(Number octave_variance) { return sqrt(octave_variance) / Number(0.72); }
